//! A small reader of our own VTU dialect, written from the format and not from the writer.

#![allow(clippy::unwrap_used)]

use std::io::Read;

use flate2::read::ZlibDecoder;

/// One array of a file.
#[derive(Debug, PartialEq)]
pub struct Array {
    /// The element that holds it, such as `PointData`.
    pub place: String,
    pub name: String,
    pub kind: String,
    pub components: usize,
    pub bytes: Vec<u8>,
}

/// A file: what it says of itself, and its arrays.
#[derive(Debug)]
pub struct Document {
    pub points: usize,
    pub cells: usize,
    pub arrays: Vec<Array>,
}

impl Document {
    /// Reads a file; panics with the place if it is not in the dialect.
    pub fn read(bytes: &[u8]) -> Self {
        let text = std::str::from_utf8(bytes).unwrap();
        let head = text.lines().nth(1).unwrap();
        for (name, wanted) in [
            ("type", "UnstructuredGrid"),
            ("byte_order", "LittleEndian"),
            ("header_type", "UInt64"),
            ("compressor", "vtkZLibDataCompressor"),
        ] {
            assert_eq!(attribute(head, name), wanted);
        }
        let (mut open, mut arrays) = (Vec::new(), Vec::new());
        let mut document = Self { points: 0, cells: 0, arrays: Vec::new() };
        for line in text.lines().skip(1) {
            if let Some(closed) = line.strip_prefix("</") {
                assert_eq!(open.pop(), Some(closed.trim_end_matches('>')));
            } else if line.starts_with("<DataArray ") {
                arrays.push(array(line, open.last().unwrap()));
            } else {
                let name = line[1..].split([' ', '>']).next().unwrap();
                open.push(name);
                if name == "Piece" {
                    document.points = attribute(line, "NumberOfPoints").parse().unwrap();
                    document.cells = attribute(line, "NumberOfCells").parse().unwrap();
                }
            }
        }
        assert!(open.is_empty(), "not closed: {open:?}");
        Self { arrays, ..document }
    }

    /// The array `name` in `place`.
    pub fn array(&self, place: &str, name: &str) -> &Array {
        self.arrays.iter().find(|a| a.place == place && a.name == name).unwrap()
    }

    /// The array `name` of the cells, as integers.
    pub fn cells(&self, name: &str) -> Vec<i64> {
        let array = self.array("Cells", name);
        match array.kind.as_str() {
            "UInt8" => array.bytes.iter().map(|&b| b.into()).collect(),
            kind => {
                assert_eq!(kind, "Int64");
                array.values(i64::from_le_bytes)
            }
        }
    }
}

impl Array {
    /// The values, by the width of `from`.
    pub fn values<const N: usize, T>(&self, from: impl Fn([u8; N]) -> T) -> Vec<T> {
        let (values, rest) = self.bytes.as_chunks::<N>();
        assert!(rest.is_empty());
        values.iter().map(|&v| from(v)).collect()
    }
}

/// The value of an attribute, with its entities undone.
pub fn attribute(line: &str, name: &str) -> String {
    let start = line.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
    let value = line[start..].split('"').next().unwrap();
    value.replace("&quot;", "\"").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
}

/// Reads the line of one array.
fn array(line: &str, place: &str) -> Array {
    assert_eq!(attribute(line, "format"), "binary");
    let text = line.split_once('>').unwrap().1.strip_suffix("</DataArray>").unwrap();
    // Table and blocks are coded one by one; the padding tells nothing, the count of blocks does.
    let blocks = u64_at(&decode(&text[..12]), 0) as usize;
    let coded = (24 + 8 * blocks).div_ceil(3) * 4;
    let (table, blocks_text) = (decode(&text[..coded]), decode(&text[coded..]));
    let (size, last) = (u64_at(&table, 1) as usize, u64_at(&table, 2) as usize);
    let (mut bytes, mut at) = (Vec::new(), 0);
    for k in 0..blocks {
        let packed = u64_at(&table, 3 + k) as usize;
        let mut block = Vec::new();
        ZlibDecoder::new(&blocks_text[at..at + packed]).read_to_end(&mut block).unwrap();
        let shorter = k + 1 == blocks && last > 0;
        assert_eq!(block.len(), if shorter { last } else { size });
        bytes.extend(block);
        at += packed;
    }
    assert_eq!(at, blocks_text.len());
    Array {
        place: place.to_owned(),
        name: attribute(line, "Name"),
        kind: attribute(line, "type"),
        components: attribute(line, "NumberOfComponents").parse().unwrap(),
        bytes,
    }
}

/// Number `k` of a table; the last one needed may lack bytes that are not its own.
fn u64_at(bytes: &[u8], k: usize) -> u64 {
    u64::from_le_bytes(bytes[8 * k..8 * k + 8].try_into().unwrap())
}

/// Base64 by its definition, so that the crate under test is not tested by itself.
fn decode(text: &str) -> Vec<u8> {
    const ALPHABET: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut bytes = Vec::new();
    for group in text.as_bytes().chunks(4) {
        let digits = group.iter().filter(|&&c| c != b'=').count();
        let digit = |c: &u8| ALPHABET.iter().position(|a| a == c).unwrap_or(0);
        let word = group.iter().fold(0, |word, c| (word << 6) | digit(c));
        bytes.extend(&(word as u32).to_be_bytes()[1..digits]);
    }
    bytes
}
