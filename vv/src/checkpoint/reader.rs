//! Reading a checkpoint: all of it is checked before any of it is used.

use std::fs;
use std::io;
use std::ops::Range;
use std::path::Path;

use super::element::{Element, ElementType};
use super::error::{CheckpointError, short};
use super::header::{Meta, SectionInfo, decode};
use super::shuffle::unpack;

/// A checkpoint whose every byte has been checked.
#[derive(Debug, Clone)]
pub struct Reader {
    meta: Meta,
    sections: Vec<SectionInfo>,
    asked: Vec<bool>,
    file: Vec<u8>,
    body: usize,
}

impl Reader {
    /// Opens the checkpoint at `path`, which must be of the scene with the hash `scene`.
    ///
    /// # Errors
    /// [`CheckpointError`] that says what is damaged or different.
    pub fn open(path: &Path, scene: &str) -> Result<Self, CheckpointError> {
        Self::open_any(path)?.of_scene(scene)
    }

    /// Opens the checkpoint at `path` whatever its scene, to show it or by the user's own wish.
    ///
    /// # Errors
    /// As [`Reader::open`], but for the scene.
    pub fn open_any(path: &Path) -> Result<Self, CheckpointError> {
        let read = |source| CheckpointError::Read { path: path.to_owned(), source };
        // A device could be read without end.
        if !fs::metadata(path).map_err(read)?.is_file() {
            return Err(read(io::Error::new(io::ErrorKind::InvalidInput, "not a file")));
        }
        Self::check(fs::read(path).map_err(read)?)
    }

    /// Reads a checkpoint from memory, which must be of the scene with the hash `scene`.
    ///
    /// # Errors
    /// As [`Reader::open`].
    pub fn from_bytes(file: Vec<u8>, scene: &str) -> Result<Self, CheckpointError> {
        Self::check(file)?.of_scene(scene)
    }

    /// What the checkpoint says of itself.
    #[must_use]
    pub const fn meta(&self) -> &Meta {
        &self.meta
    }

    /// The table of the sections.
    #[must_use]
    pub fn sections(&self) -> &[SectionInfo] {
        &self.sections
    }

    /// The numbers of the section `name`, which must be `len` doubles in a row.
    ///
    /// # Errors
    /// As [`Reader::array`].
    pub fn f64s(&mut self, name: &str, len: usize) -> Result<Vec<f64>, CheckpointError> {
        self.array(name, &[len])
    }

    /// The values of the section `name`, which must have this type and the extents `shape`.
    ///
    /// # Errors
    /// [`CheckpointError::Missing`] or [`CheckpointError::Form`] if there is no such section;
    /// [`CheckpointError::Section`] if it does not unpack to what the table says.
    pub fn array<T: Element>(
        &mut self,
        name: &str,
        shape: &[usize],
    ) -> Result<Vec<T>, CheckpointError> {
        let wanted_shape: Vec<u64> = shape.iter().map(|&extent| extent as u64).collect();
        let k = self.find(name, T::TYPE, Some(&wanted_shape))?;
        self.unpack(k)
    }

    /// The bytes of the section `name`, as many as there are.
    ///
    /// # Errors
    /// As [`Reader::array`].
    pub fn bytes(&mut self, name: &str) -> Result<Vec<u8>, CheckpointError> {
        let k = self.find(name, ElementType::Bytes, None)?;
        self.unpack(k)
    }

    /// Ends the reading.
    ///
    /// # Errors
    /// [`CheckpointError::Extra`] if a section was never asked for: a state that this program does
    /// not know of would be lost.
    pub fn finish(self) -> Result<(), CheckpointError> {
        match self.asked.iter().position(|asked| !asked) {
            Some(k) => Err(CheckpointError::Extra { name: self.sections[k].name.clone() }),
            None => Ok(()),
        }
    }

    /// Checks header, table and the hash of every section.
    fn check(file: Vec<u8>) -> Result<Self, CheckpointError> {
        let (meta, sections, body) = decode(&file)?;
        for section in &sections {
            let found = blake3::hash(&body[range(section)]).to_hex();
            if found.as_str() != section.blake3 {
                let (name, wanted) = (&section.name, short(&section.blake3));
                let found = format!("BLAKE3 is {}", short(&found));
                return Err(CheckpointError::section(name, found, wanted));
            }
        }
        let (asked, body) = (vec![false; sections.len()], file.len() - body.len());
        Ok(Self { meta, sections, asked, file, body })
    }

    /// Refuses another scene.
    fn of_scene(self, scene: &str) -> Result<Self, CheckpointError> {
        if self.meta.scene == scene {
            return Ok(self);
        }
        Err(CheckpointError::Scene { found: self.meta.scene, wanted: scene.to_owned() })
    }

    /// Index of the section `name` of the type and shape wanted; it counts as asked for.
    fn find(
        &mut self,
        name: &str,
        wanted: ElementType,
        shape: Option<&[u64]>,
    ) -> Result<usize, CheckpointError> {
        let (name, wanted_shape) = (name.to_owned(), || shape.unwrap_or_default().to_vec());
        let Some(k) = self.sections.iter().position(|section| section.name == name) else {
            return Err(CheckpointError::Missing { name, wanted, wanted_shape: wanted_shape() });
        };
        let section = &self.sections[k];
        if section.element != wanted || shape.is_some_and(|shape| shape != section.shape) {
            return Err(CheckpointError::Form {
                name,
                found: section.element,
                found_shape: section.shape.clone(),
                wanted,
                wanted_shape: wanted_shape(),
            });
        }
        self.asked[k] = true;
        Ok(k)
    }

    /// The values of section `k`, whose type has been compared.
    fn unpack<T: Element>(&self, k: usize) -> Result<Vec<T>, CheckpointError> {
        let section = &self.sections[k];
        let wrong = |found: String| {
            let wanted = format!("{} {:?}", section.element, section.shape);
            CheckpointError::section(&section.name, found, wanted)
        };
        let count = section.count().and_then(|count| usize::try_from(count).ok());
        let count = count.ok_or_else(|| wrong("more values than memory".to_owned()))?;
        unpack(&self.file[self.body..][range(section)], count).map_err(wrong)
    }
}

/// Place of a section among the sections; the table has been compared with the file, so it fits.
const fn range(section: &SectionInfo) -> Range<usize> {
    let start = section.offset as usize;
    start..start + section.length as usize
}
