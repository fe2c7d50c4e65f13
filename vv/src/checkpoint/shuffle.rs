//! The stored form of an array: bytes regrouped by significance, then zlib.
//!
//! Neighbouring values of a smooth field share sign, exponent and leading digits; side by side
//! these bytes compress, between the noise of the last digits they do not.

use std::io::{self, Read, Write};

use flate2::Compression;
use flate2::bufread::ZlibDecoder;
use flate2::write::ZlibEncoder;

use super::element::LittleEndian;

/// Most bytes that one byte of a deflate stream can stand for, by the definition of the format.
pub(super) const LARGEST_RATIO: u64 = 1032;

/// The stored form of `values`.
///
/// # Errors
/// None in practice: the stream is in memory.
pub(super) fn pack<T: LittleEndian>(values: &[T]) -> io::Result<Vec<u8>> {
    let count = values.len();
    let mut regrouped = vec![0; size_of_val(values)];
    for (i, value) in values.iter().enumerate() {
        for (k, byte) in value.to_bytes().as_ref().iter().enumerate() {
            regrouped[k * count + i] = *byte;
        }
    }
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(&regrouped)?;
    encoder.finish()
}

/// The `count` values whose stored form is `stored`, or what is wrong with it. The caller has
/// compared `count` with [`LARGEST_RATIO`], so that memory for it is justified.
pub(super) fn unpack<T: LittleEndian>(stored: &[u8], count: usize) -> Result<Vec<T>, String> {
    let mut regrouped = vec![0; count * size_of::<T>()];
    let mut decoder = ZlibDecoder::new(stored);
    decoder.read_exact(&mut regrouped).map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => "the zlib stream is too short".to_owned(),
        _ => format!("not a zlib stream ({error})"),
    })?;
    // Reading on to the end also compares the checksum of the stream.
    match decoder.read(&mut [0]) {
        Ok(0) if decoder.total_in() == stored.len() as u64 => {}
        Ok(0) => return Err("bytes follow the zlib stream".to_owned()),
        Ok(_) => return Err("the zlib stream is too long".to_owned()),
        Err(error) => return Err(format!("not a zlib stream ({error})")),
    }
    let value = |i: usize| {
        let mut bytes = T::Bytes::default();
        for (k, byte) in bytes.as_mut().iter_mut().enumerate() {
            *byte = regrouped[k * count + i];
        }
        T::from_bytes(bytes)
    };
    Ok((0..count).map(value).collect())
}
