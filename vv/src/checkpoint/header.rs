//! The first bytes of a checkpoint: what the file is, and the table of its sections.

use serde::{Deserialize, Serialize};

use super::element::ElementType;
use super::error::CheckpointError;
use super::shuffle::LARGEST_RATIO;
use crate::words::counted;

/// First bytes of every checkpoint.
const MAGIC: [u8; 8] = *b"\x89WHP\r\n\x1a\n";

/// The format version of this program.
const VERSION: u32 = 1;

/// Bytes before the header: magic, version, length, CRC-32.
const PREAMBLE: usize = 20;

/// What a checkpoint says of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Meta {
    /// Program and version that wrote it.
    pub program: String,
    /// Hash of the scene, without what only concerns output.
    pub scene: String,
    /// Steps done.
    pub step: u64,
    /// Simulated time; finite.
    pub time: f64,
}

/// A section, as the table lists it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SectionInfo {
    /// Name, unique in the file.
    pub name: String,
    /// Type of the values.
    pub element: ElementType,
    /// Extents, the outermost first.
    pub shape: Vec<u64>,
    /// First byte, from the end of the header.
    pub offset: u64,
    /// Stored bytes.
    pub length: u64,
    /// BLAKE3 of the stored bytes, in hexadecimal.
    pub blake3: String,
}

/// The JSON of the header.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    program: String,
    scene: String,
    step: u64,
    // Text, because JSON readers differ in the last bit of a number.
    time: String,
    sections: Vec<SectionInfo>,
}

/// Everything before the sections.
pub(super) fn encode(meta: &Meta, sections: &[SectionInfo]) -> Result<Vec<u8>, CheckpointError> {
    if !meta.time.is_finite() {
        return Err(not_a_time(&format!("{:?}", meta.time)));
    }
    let header = Header {
        program: meta.program.clone(),
        scene: meta.scene.clone(),
        step: meta.step,
        time: format!("{:?}", meta.time),
        sections: sections.to_vec(),
    };
    let json = serde_json::to_vec(&header)
        .map_err(|error| CheckpointError::header(error.to_string(), "what JSON can carry"))?;
    let length = u32::try_from(json.len())
        .map_err(|_| CheckpointError::header("too many sections", "less than 4 GiB of header"))?;
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(length.to_le_bytes());
    bytes.extend(checksum(&bytes[8..16], &json).to_le_bytes());
    bytes.extend(json);
    Ok(bytes)
}

/// Splits a file into what it says of itself, its table and its sections, having checked all but
/// the content of the sections.
pub(super) fn decode(file: &[u8]) -> Result<(Meta, Vec<SectionInfo>, &[u8]), CheckpointError> {
    let header = header_of(file)?;
    let body = &file[PREAMBLE + header.len()..];
    let header: Header = serde_json::from_slice(header)
        .map_err(|error| CheckpointError::header(error.to_string(), "the fields of version 1"))?;
    let time = header.time.parse().ok().filter(|time: &f64| time.is_finite());
    let time = time.ok_or_else(|| not_a_time(&header.time))?;
    check_table(&header.sections, body.len() as u64)?;
    let Header { program, scene, step, sections, .. } = header;
    Ok((Meta { program, scene, step, time }, sections, body))
}

/// The JSON of the header, with its checksum compared.
fn header_of(file: &[u8]) -> Result<&[u8], CheckpointError> {
    if !file.starts_with(&MAGIC) {
        return Err(CheckpointError::header("other first bytes", "those of a checkpoint"));
    }
    let cut = || {
        let found = format!("the file ends after {}", bytes_of(file.len() as u64));
        CheckpointError::header(found, "a whole header")
    };
    let word = |at: usize| {
        let bytes = file.get(at..at + 4)?.try_into().ok()?;
        Some(u32::from_le_bytes(bytes))
    };
    // The version comes first: a later one may have another header.
    match word(8).ok_or_else(cut)? {
        VERSION => {}
        found if found > VERSION => {
            return Err(CheckpointError::Newer { found, known: VERSION });
        }
        found => {
            let found = format!("format version {found}");
            return Err(CheckpointError::header(found, format!("version {VERSION}")));
        }
    }
    let length = word(12).ok_or_else(cut)? as usize;
    let wanted = word(16).ok_or_else(cut)?;
    let end = PREAMBLE.checked_add(length).ok_or_else(cut)?;
    let json = file.get(PREAMBLE..end).ok_or_else(cut)?;
    let found = checksum(&file[8..16], json);
    if found == wanted {
        Ok(json)
    } else {
        let found = format!("CRC-32 is {found:08x}");
        Err(CheckpointError::header(found, format!("{wanted:08x}")))
    }
}

/// CRC-32 of the two parts in a row.
fn checksum(start: &[u8], rest: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(start);
    hasher.update(rest);
    hasher.finalize()
}

/// Refuses a table that does not describe `bytes` bytes of sections, each exactly once.
fn check_table(sections: &[SectionInfo], bytes: u64) -> Result<(), CheckpointError> {
    let mut names = std::collections::HashSet::new();
    let mut end = 0_u64;
    for section in sections {
        let name = &section.name;
        let wrong = |found: &str, wanted: String| CheckpointError::section(name, found, wanted);
        if !names.insert(name) {
            return Err(wrong("listed twice", "each name once".to_owned()));
        }
        if section.offset != end {
            let found = format!("begins at byte {}", section.offset);
            return Err(wrong(&found, format!("byte {end}, where the one before ends")));
        }
        let whole = || wrong("the file ends before it does", bytes_of(section.length));
        end = end.checked_add(section.length).filter(|&end| end <= bytes).ok_or_else(whole)?;
        let most = section.length.saturating_mul(LARGEST_RATIO);
        if section.bytes().is_none_or(|bytes| bytes > most) {
            let found = format!("shape {:?}", section.shape);
            return Err(wrong(&found, format!("at most {} for its stored length", bytes_of(most))));
        }
    }
    if end == bytes {
        return Ok(());
    }
    let follow = counted((bytes - end) as usize, ["byte follows", "bytes follow"]);
    let found = format!("{follow} the last section");
    Err(CheckpointError::header(found, "the end of the file"))
}

/// A number of bytes in words.
fn bytes_of(bytes: u64) -> String {
    counted(bytes as usize, ["byte", "bytes"])
}

impl SectionInfo {
    /// Number of values, if it can be counted.
    pub(super) fn count(&self) -> Option<u64> {
        self.shape.iter().try_fold(1_u64, |count, &extent| count.checked_mul(extent))
    }

    /// Bytes of the array, if they can be counted.
    fn bytes(&self) -> Option<u64> {
        self.count()?.checked_mul(self.element.size() as u64)
    }
}

/// A time that is none.
fn not_a_time(found: &str) -> CheckpointError {
    CheckpointError::header(format!("time is {found}"), "a finite number")
}
