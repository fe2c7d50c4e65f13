//! Putting a state together and writing it as a whole.

use std::path::Path;

use super::element::{Element, ElementType};
use super::error::CheckpointError;
use super::header::{Meta, SectionInfo, encode};
use super::shuffle::pack;
use crate::files::write_atomic;
use crate::words::counted;

/// A checkpoint in the making. Sections are compressed as they are added; the arrays need not
/// outlive the call.
#[derive(Debug, Clone)]
pub struct Writer {
    meta: Meta,
    sections: Vec<SectionInfo>,
    body: Vec<u8>,
}

impl Writer {
    /// A checkpoint without sections.
    #[must_use]
    pub const fn new(meta: Meta) -> Self {
        Self { meta, sections: Vec::new(), body: Vec::new() }
    }

    /// Adds the array `values`.
    ///
    /// # Errors
    /// [`CheckpointError::Section`] if there is a section of this name already.
    pub fn section<T: Element>(&mut self, name: &str, values: &[T]) -> Result<(), CheckpointError> {
        self.shaped(name, &[values.len()], values)
    }

    /// Adds the array `values` of the extents `shape`, the outermost first: `&[n, 3]` for vectors.
    ///
    /// # Errors
    /// [`CheckpointError::Section`] if the extents are not those of `values`, or there is a section
    /// of this name already.
    pub fn shaped<T: Element>(
        &mut self,
        name: &str,
        shape: &[usize],
        values: &[T],
    ) -> Result<(), CheckpointError> {
        self.add(name, T::TYPE, shape, values)
    }

    /// Adds bytes of a form and length that only their owner knows.
    ///
    /// # Errors
    /// [`CheckpointError::Section`] if there is a section of this name already.
    pub fn bytes(&mut self, name: &str, bytes: &[u8]) -> Result<(), CheckpointError> {
        self.add(name, ElementType::Bytes, &[bytes.len()], bytes)
    }

    /// The file as it will be written.
    ///
    /// # Errors
    /// [`CheckpointError::Header`] if the time is not finite.
    pub fn to_bytes(&self) -> Result<Vec<u8>, CheckpointError> {
        let mut file = encode(&self.meta, &self.sections)?;
        file.extend_from_slice(&self.body);
        Ok(file)
    }

    /// Writes the file, so that `path` holds the earlier file or the new one, also after a power
    /// cut.
    ///
    /// # Errors
    /// [`CheckpointError::Header`] if the time is not finite, [`CheckpointError::Write`] if the file
    /// cannot be replaced.
    pub fn write(&self, path: &Path) -> Result<(), CheckpointError> {
        Ok(write_atomic(path, &self.to_bytes()?)?)
    }

    /// Compresses `values` and lists them.
    fn add<T: Element>(
        &mut self,
        name: &str,
        element: ElementType,
        shape: &[usize],
        values: &[T],
    ) -> Result<(), CheckpointError> {
        let wrong = |found: String, wanted: String| CheckpointError::section(name, found, wanted);
        if self.sections.iter().any(|section| section.name == name) {
            return Err(wrong("given twice".to_owned(), "each name once".to_owned()));
        }
        let count = shape.iter().try_fold(1_usize, |count, &extent| count.checked_mul(extent));
        if count != Some(values.len()) {
            let wanted = format!("as many as the shape {shape:?} has");
            return Err(wrong(counted(values.len(), ["value", "values"]), wanted));
        }
        let stored =
            pack(values).map_err(|error| wrong(error.to_string(), "a zlib stream".to_owned()))?;
        self.sections.push(SectionInfo {
            name: name.to_owned(),
            element,
            shape: shape.iter().map(|&extent| extent as u64).collect(),
            offset: self.body.len() as u64,
            length: stored.len() as u64,
            blake3: blake3::hash(&stored).to_hex().to_string(),
        });
        self.body.extend(stored);
        Ok(())
    }
}
