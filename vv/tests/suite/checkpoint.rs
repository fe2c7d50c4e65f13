//! A state goes into a checkpoint and comes back bit for bit, and only in the form asked for.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use proptest::prelude::*;
use whipple_vv::checkpoint::{CheckpointError, Element, Meta, Reader, Writer};

pub const SCENE: &str = "00ff";

pub fn meta() -> Meta {
    Meta { program: "whipple 0.1.0".to_owned(), scene: SCENE.to_owned(), step: 12, time: 1.5e-6 }
}

/// A small file with sections of all sizes of values, one of them empty.
pub fn small() -> Vec<u8> {
    let mut writer = Writer::new(meta());
    writer.section("v.x", &[1.0, -0.0, f64::NAN]).unwrap();
    writer.section::<f64>("none", &[]).unwrap();
    writer.shaped("cells", &[2, 2], &[1_u16, 2, 3, 4]).unwrap();
    writer.bytes("rng", b"state").unwrap();
    writer.to_bytes().unwrap()
}

fn refusal<T: std::fmt::Debug>(result: Result<T, CheckpointError>) -> String {
    result.unwrap_err().to_string()
}

/// Whether `values` come back; `bits` makes them comparable.
fn comes_back<T: Element, B: PartialEq>(values: &[T], bits: impl Fn(&T) -> B) -> bool {
    let mut writer = Writer::new(meta());
    writer.section("values", values).unwrap();
    let mut reader = Reader::from_bytes(writer.to_bytes().unwrap(), SCENE).unwrap();
    let back: Vec<T> = reader.array("values", &[values.len()]).unwrap();
    reader.finish().unwrap();
    back.len() == values.len() && back.iter().zip(values).all(|(a, b)| bits(a) == bits(b))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arrays_of_every_type_come_back(words in prop::collection::vec(any::<u64>(), 0..300)) {
        prop_assert!(comes_back(&words, |&v| v));
        // Every pattern of bits, so infinities, subnormals and the payloads of not-a-number too.
        let doubles: Vec<f64> = words.iter().map(|&w| f64::from_bits(w)).collect();
        prop_assert!(comes_back(&doubles, |v| v.to_bits()));
        let narrow = |shift: u32| words.iter().map(move |&w| w >> shift);
        prop_assert!(comes_back(&narrow(56).map(|w| w as u8).collect::<Vec<_>>(), |&v| v));
        prop_assert!(comes_back(&narrow(48).map(|w| w as u16).collect::<Vec<_>>(), |&v| v));
        prop_assert!(comes_back(&narrow(48).map(|w| w as i16).collect::<Vec<_>>(), |&v| v));
        prop_assert!(comes_back(&narrow(32).map(|w| w as u32).collect::<Vec<_>>(), |&v| v));
        prop_assert!(comes_back(&narrow(32).map(|w| w as i32).collect::<Vec<_>>(), |&v| v));
    }

    #[test]
    fn signalling_payloads_come_back(payload in 1_u64..1 << 51, sign: bool) {
        let bits = (u64::from(sign) << 63) | (0x7ff << 52) | payload;
        prop_assert!(comes_back(&[f64::from_bits(bits)], |v| v.to_bits()));
    }

    #[test]
    fn what_the_file_says_of_itself_comes_back(
        program: String,
        scene: String,
        step: u64,
        time in prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO,
        names in prop::collection::hash_set(any::<String>(), 0..5),
    ) {
        let meta = Meta { program, scene: scene.clone(), step, time };
        let mut writer = Writer::new(meta.clone());
        for name in &names {
            writer.bytes(name, name.as_bytes()).unwrap();
        }
        let mut reader = Reader::from_bytes(writer.to_bytes().unwrap(), &scene).unwrap();
        prop_assert_eq!(reader.meta(), &meta);
        prop_assert_eq!(reader.meta().time.to_bits(), time.to_bits());
        prop_assert_eq!(reader.sections().len(), names.len());
        for name in &names {
            prop_assert_eq!(reader.bytes(name).unwrap(), name.as_bytes());
        }
        reader.finish().unwrap();
    }
}

#[test]
fn the_same_state_gives_the_same_bytes_in_memory_and_on_disk() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.whp");
    let mut writer = Writer::new(meta());
    writer.section("v.x", &[1.0, 2.0]).unwrap();
    writer.write(&path).unwrap();
    writer.write(&path).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), writer.to_bytes().unwrap());
    assert_eq!(small(), small());
    assert_eq!(Reader::open(&path, SCENE).unwrap().f64s("v.x", 2).unwrap(), [1.0, 2.0]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn another_form_than_wanted_is_refused() {
    let mut reader = Reader::from_bytes(small(), SCENE).unwrap();
    assert_eq!(refusal(reader.f64s("v.x", 4)), "section `v.x`: holds f64 [3], wanted f64 [4]");
    assert_eq!(
        refusal(reader.array::<i16>("cells", &[2, 2])),
        "section `cells`: holds u16 [2, 2], wanted i16 [2, 2]"
    );
    assert_eq!(
        refusal(reader.array::<u16>("cells", &[4])),
        "section `cells`: holds u16 [2, 2], wanted u16 [4]"
    );
    assert_eq!(
        refusal(reader.array::<u8>("rng", &[5])),
        "section `rng`: holds bytes [5], wanted u8 [5]"
    );
    assert_eq!(refusal(reader.bytes("v.x")), "section `v.x`: holds f64 [3], wanted bytes []");
    assert_eq!(refusal(reader.f64s("v.y", 3)), "section `v.y`: missing, wanted f64 [3]");
    assert_eq!(refusal(reader.bytes("seed")), "section `seed`: missing, wanted bytes []");
}

#[test]
fn sections_nobody_asked_for_are_refused() {
    let mut reader = Reader::from_bytes(small(), SCENE).unwrap();
    reader.f64s("v.x", 3).unwrap();
    reader.f64s("none", 0).unwrap();
    reader.bytes("rng").unwrap();
    assert_eq!(
        refusal(reader.clone().finish()),
        "section `cells`: unknown to this program, wanted none of this name"
    );
    assert_eq!(reader.array::<u16>("cells", &[2, 2]).unwrap(), [1, 2, 3, 4]);
    reader.finish().unwrap();
}

#[test]
fn another_scene_is_refused_unless_any_will_do() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.whp");
    std::fs::write(&path, small()).unwrap();
    assert_eq!(
        refusal(Reader::open(&path, "00fe")),
        "header: the state is of scene 00ff, wanted scene 00fe"
    );
    assert_eq!(Reader::open_any(&path).unwrap().meta(), &meta());
}

#[test]
fn only_files_are_opened() {
    let folder = tempfile::tempdir().unwrap();
    let none = folder.path().join("none");
    for path in [folder.path(), &none, Path::new("/dev/zero")] {
        let error = Reader::open(path, SCENE).unwrap_err();
        assert!(matches!(error, CheckpointError::Read { .. }), "{error}");
    }
}

#[test]
fn a_writer_refuses_what_it_could_not_read() {
    let mut writer = Writer::new(meta());
    writer.section("v.x", &[1.0]).unwrap();
    assert_eq!(
        refusal(writer.section("v.x", &[2.0])),
        "section `v.x`: given twice, wanted each name once"
    );
    assert_eq!(
        refusal(writer.shaped("x", &[2, 3], &[1.0; 5])),
        "section `x`: 5 values, wanted as many as the shape [2, 3] has"
    );
    assert!(writer.shaped("x", &[usize::MAX, 2], &[1.0]).is_err());
    let endless = Writer::new(Meta { time: f64::INFINITY, ..meta() });
    assert_eq!(refusal(endless.to_bytes()), "header: time is inf, wanted a finite number");
}
