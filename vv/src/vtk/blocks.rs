//! The array encoding of VTK: zlib blocks behind a table of their sizes, both in base64.

use std::io::{self, Write};

use base64::display::Base64Display;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;

/// Bytes compressed as one block; a multiple of every value size. Larger blocks gain no size.
const BLOCK: usize = 1 << 18;

/// Higher levels take several times as long and save a few per cent on floating-point fields.
const LEVEL: Compression = Compression::fast();

/// Writes little-endian `values` as one array: base64 of the block table (number of blocks, size of
/// a block, size of the last block if it is shorter, compressed sizes), then base64 of the blocks.
pub(super) fn write_blocks<const N: usize>(
    out: &mut impl Write,
    mut values: impl ExactSizeIterator<Item = [u8; N]>,
) -> io::Result<()> {
    const { assert!(BLOCK.is_multiple_of(N)) };
    let bytes = values.len() * N;
    let last = (bytes % BLOCK) as u64;
    let mut table = vec![bytes.div_ceil(BLOCK) as u64, BLOCK as u64, last];
    let mut packed = Vec::new();
    let mut block = Vec::with_capacity(bytes.min(BLOCK));
    while values.len() > 0 {
        block.clear();
        for value in values.by_ref().take(BLOCK / N) {
            block.extend_from_slice(&value);
        }
        let start = packed.len();
        let mut encoder = ZlibEncoder::new(packed, LEVEL);
        encoder.write_all(&block)?;
        packed = encoder.finish()?;
        table.push((packed.len() - start) as u64);
    }
    let table: Vec<u8> = table.into_iter().flat_map(u64::to_le_bytes).collect();
    write!(out, "{}", Base64Display::new(&table, &STANDARD))?;
    write!(out, "{}", Base64Display::new(&packed, &STANDARD))
}
