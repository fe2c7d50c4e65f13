//! Every damaged or forged file is refused, with the place, without a panic, and without more memory
//! than the file justifies.

#![allow(clippy::unwrap_used)]

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use proptest::prelude::*;
use whipple_vv::checkpoint::{CheckpointError, Reader};

use crate::checkpoint::{SCENE, small};

/// Reads everything that a file says it holds, as its table says it.
fn read_all(file: Vec<u8>) -> Result<(), CheckpointError> {
    let mut reader = Reader::from_bytes(file, SCENE)?;
    for section in reader.sections().to_vec() {
        let shape: Vec<usize> = section.shape.iter().map(|&n| n as usize).collect();
        let (name, shape) = (section.name.as_str(), shape.as_slice());
        match section.element.to_string().as_str() {
            "f64" => drop(reader.array::<f64>(name, shape)?),
            "u8" => drop(reader.array::<u8>(name, shape)?),
            "u16" => drop(reader.array::<u16>(name, shape)?),
            "u32" => drop(reader.array::<u32>(name, shape)?),
            "u64" => drop(reader.array::<u64>(name, shape)?),
            "i16" => drop(reader.array::<i16>(name, shape)?),
            "i32" => drop(reader.array::<i32>(name, shape)?),
            _ => drop(reader.bytes(name)?),
        }
    }
    reader.finish()
}

/// Why a file is refused; the message begins with the place.
fn refusal(file: Vec<u8>) -> String {
    let message = read_all(file).unwrap_err().to_string();
    assert!(message.starts_with("header: ") || message.starts_with("section `"), "{message}");
    assert!(message.contains("wanted"), "{message}");
    message
}

/// A file with this header and these sections, its checksum in order.
fn forged(version: u32, header: &str, body: &[u8]) -> Vec<u8> {
    let mut file = small()[..8].to_vec();
    file.extend(version.to_le_bytes());
    file.extend((header.len() as u32).to_le_bytes());
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&file[8..16]);
    hasher.update(header.as_bytes());
    file.extend(hasher.finalize().to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(body);
    file
}

/// A header with this table.
fn header(sections: &str) -> String {
    format!(
        "{{\"program\":\"w\",\"scene\":\"{SCENE}\",\"step\":1,\"time\":\"0.5\",\
         \"sections\":[{sections}]}}"
    )
}

/// An entry of the table for `stored`, with its true hash.
fn entry(name: &str, form: &str, offset: usize, stored: &[u8]) -> String {
    let (length, hash) = (stored.len(), blake3::hash(stored));
    format!(
        "{{\"name\":\"{name}\",{form},\"offset\":{offset},\"length\":{length},\
         \"blake3\":\"{hash}\"}}"
    )
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn every_truncation_is_refused() {
    let file = small();
    read_all(file.clone()).unwrap();
    for length in 0..file.len() {
        refusal(file[..length].to_vec());
    }
    assert!(refusal(file[..file.len() - 1].to_vec()).starts_with("section `rng`"));
    assert!(refusal(file[..100].to_vec()).starts_with("header: the file ends after 100 bytes"));
}

#[test]
fn every_flipped_bit_is_refused() {
    let file = small();
    for bit in 0..8 * file.len() {
        let mut damaged = file.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        refusal(damaged);
    }
    let mut damaged = file.clone();
    *damaged.last_mut().unwrap() ^= 1;
    assert!(refusal(damaged).starts_with("section `rng`: BLAKE3 is "));
    let mut damaged = file;
    damaged[30] ^= 1;
    assert!(refusal(damaged).starts_with("header: CRC-32 is "));
}

#[test]
fn bytes_in_excess_are_refused() {
    let mut file = small();
    file.push(0);
    let wanted = "header: 1 byte follows the last section, wanted the end of the file";
    assert_eq!(refusal(file), wanted);
}

#[test]
fn other_versions_are_refused_by_number() {
    assert_eq!(
        refusal(forged(2, "a later header", b"")),
        "header: format version 2 is newer than this program, wanted at most 1"
    );
    assert_eq!(refusal(forged(0, "", b"")), "header: format version 0, wanted version 1");
}

#[test]
fn forged_tables_are_refused() {
    let stored = zlib(&1.0_f64.to_le_bytes());
    let form = "\"element\":\"f64\",\"shape\":[1]";
    let good = entry("a", form, 0, &stored);
    let file = |table: &str| forged(1, &header(table), &stored);
    read_all(file(&good)).unwrap();
    let twice = format!("{good},{}", entry("a", form, stored.len(), b""));
    assert_eq!(refusal(file(&twice)), "section `a`: listed twice, wanted each name once");
    let apart = refusal(file(&entry("a", form, 1, &stored)));
    assert_eq!(apart, "section `a`: begins at byte 1, wanted byte 0, where the one before ends");
    let shared = format!("{good},{}", entry("b", form, 0, &stored));
    assert!(refusal(file(&shared)).starts_with("section `b`: begins at byte 0"));
    let endless =
        good.replace(&format!("\"length\":{}", stored.len()), &format!("\"length\":{}", u64::MAX));
    assert!(refusal(file(&endless)).starts_with("section `a`: the file ends before it does"));
    let other = |from: &str, to: &str| refusal(file(&good.replace(from, to)));
    assert!(other("[1]", "[2]").starts_with("section `a`: the zlib stream is too short"));
    assert!(other("[1]", "[0]").starts_with("section `a`: the zlib stream is too long"));
    assert!(other("f64", "u16").starts_with("section `a`: the zlib stream is too long"));
    assert!(other("[1]", "[1000000000000]").starts_with("section `a`: shape [1000000000000]"));
    assert!(other("[1]", "[4294967296,4294967296]").starts_with("section `a`: shape"));
    assert!(other("[1]", "[2305843009213693952]").starts_with("section `a`: shape"));
    for (from, to) in [("f64", "f16"), ("[1]", "[-1]"), ("\"shape\"", "\"form\""), ("[1]", "[1.5]")]
    {
        assert!(other(from, to).starts_with("header: "), "{from} -> {to}");
    }
    let text = header(&good);
    for (from, to) in [("0.5", "NaN"), ("0.5", ""), ("\"step\":1", "\"step\":1,\"step\":1")] {
        assert!(refusal(forged(1, &text.replace(from, to), &stored)).starts_with("header: "));
    }
    assert!(refusal(forged(1, "", b"")).starts_with("header: "));
    assert!(refusal(forged(1, &"[".repeat(100_000), b"")).starts_with("header: "));
}

#[test]
fn forged_streams_are_refused() {
    let form = "\"element\":\"u8\",\"shape\":[8]";
    let why = |stored: &[u8]| refusal(forged(1, &header(&entry("a", form, 0, stored)), stored));
    let good = zlib(b"12345678");
    assert!(why(b"garbage").starts_with("section `a`: not a zlib stream"));
    assert!(why(&[good.as_slice(), b"x"].concat()).contains("bytes follow the zlib stream"));
    let mut checksum = good.clone();
    *checksum.last_mut().unwrap() ^= 1;
    why(&checksum);
    for length in 0..good.len() {
        why(&good[..length]);
    }
    let (none, form) = (zlib(b""), "\"element\":\"u8\",\"shape\":[0,9]");
    let file = |stored: &[u8]| forged(1, &header(&entry("a", form, 0, stored)), stored);
    read_all(file(&none)).unwrap();
    for length in 0..none.len() {
        refusal(file(&none[..length]));
    }
}

#[test]
fn memory_is_bounded_by_the_form_asked_for() {
    let stored = zlib(&vec![0; 10_000_000]);
    let entry = entry("a", "\"element\":\"u8\",\"shape\":[1000]", 0, &stored);
    let file = forged(1, &header(&entry), &stored);
    let (length, mut result) = (file.len() as u64, Ok(()));
    let used = allocation_counter::measure(|| result = read_all(file));
    assert!(
        result.unwrap_err().to_string().starts_with("section `a`: the zlib stream is too long")
    );
    assert!(used.bytes_max < 100_000 + 4 * length, "{} bytes", used.bytes_max);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn garbage_is_refused(bytes in prop::collection::vec(any::<u8>(), 0..400), real in 0_usize..24) {
        // The first bytes are those of a checkpoint, so that garbage gets past the first checks.
        let file = [&small()[..real], &bytes].concat();
        let (length, mut refused) = (file.len() as u64, false);
        let used = allocation_counter::measure(|| refused = read_all(file).is_err());
        prop_assert!(refused);
        prop_assert!(used.bytes_max < 4096 + 4 * length, "{} bytes", used.bytes_max);
    }

    #[test]
    fn forged_headers_and_bodies_never_panic(
        shape in prop::collection::vec(prop_oneof![0_u64..5, any::<u64>()], 0..4),
        element in prop::sample::select(vec!["f64", "u8", "u16", "u32", "u64", "i16", "i32", "bytes"]),
        offset in prop_oneof![Just(0_u64), any::<u64>()],
        length in prop_oneof![0_u64..40, any::<u64>()],
        body in prop::collection::vec(any::<u8>(), 0..40),
        at in any::<prop::sample::Index>(),
        byte: u8,
    ) {
        let form = format!("\"element\":\"{element}\",\"shape\":{shape:?}");
        let end = (length as usize).min(body.len());
        let entry = entry("a", &form, 0, &body[..end])
            .replace("\"offset\":0", &format!("\"offset\":{offset}"))
            .replace(&format!("\"length\":{end}"), &format!("\"length\":{length}"));
        let mut text = header(&entry).into_bytes();
        refusal(forged(1, &String::from_utf8_lossy(&text), &body));
        let at = at.index(text.len());
        text[at] = byte;
        let _ = read_all(forged(1, &String::from_utf8_lossy(&text), &body));
    }

    #[test]
    fn several_errors_at_once_are_refused(
        changes in prop::collection::vec((any::<prop::sample::Index>(), 1_u8..), 1..20),
    ) {
        let file = small();
        let mut damaged = file.clone();
        for (at, change) in changes {
            let at = at.index(file.len());
            damaged[at] ^= change;
        }
        prop_assume!(damaged != file);
        refusal(damaged);
    }
}
