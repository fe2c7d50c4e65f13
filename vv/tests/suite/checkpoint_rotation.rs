//! The last two checkpoints are kept, and the newest whole one is found again.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use whipple_vv::checkpoint::{CheckpointError, Meta, Writer, list, open_latest, save_next};

use crate::checkpoint::{SCENE, meta};

fn at_step(step: u64) -> Writer {
    let mut writer = Writer::new(Meta { step, ..meta() });
    writer.section("v.x", &[step as f64]).unwrap();
    writer
}

fn names(folder: &Path) -> Vec<String> {
    let name = |path: &std::path::PathBuf| path.file_name().unwrap().to_str().unwrap().to_owned();
    list(folder).unwrap().iter().map(name).collect()
}

#[test]
fn the_last_two_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let others = ["checkpoint-7.whp", "checkpoint-000001.bak", "checkpoint-0000001.whp", "notes"];
    for other in others {
        fs::write(folder.join(other), b"").unwrap();
    }
    let error = open_latest(folder, SCENE).unwrap_err();
    assert!(matches!(error, CheckpointError::None(_)), "{error}");
    for step in [100, 200, 300] {
        let path = save_next(folder, &at_step(step)).unwrap();
        assert_eq!(list(folder).unwrap().last(), Some(&path));
    }
    assert_eq!(names(folder), ["checkpoint-000002.whp", "checkpoint-000003.whp"]);
    // A run that starts again from an earlier step is newer all the same.
    save_next(folder, &at_step(150)).unwrap();
    assert_eq!(names(folder), ["checkpoint-000003.whp", "checkpoint-000004.whp"]);
    assert_eq!(open_latest(folder, SCENE).unwrap().reader.meta().step, 150);
    assert!(others.iter().all(|other| folder.join(other).exists()));
}

#[test]
fn numbers_outgrow_six_digits() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("checkpoint-999999.whp"), b"").unwrap();
    fs::write(folder.join("checkpoint-18446744073709551615.whp"), b"").unwrap();
    save_next(folder, &at_step(1)).unwrap();
    assert_eq!(names(folder), ["checkpoint-999999.whp", "checkpoint-1000000.whp"]);
}

#[test]
fn a_damaged_newest_is_passed_over_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    save_next(folder, &at_step(1)).unwrap();
    let newest = save_next(folder, &at_step(2)).unwrap();
    let mut bytes = fs::read(&newest).unwrap();
    *bytes.last_mut().unwrap() ^= 0x10;
    fs::write(&newest, &bytes).unwrap();
    let mut latest = open_latest(folder, SCENE).unwrap();
    assert_eq!(latest.reader.f64s("v.x", 1).unwrap(), [1.0]);
    assert_eq!(latest.passed_over.len(), 1);
    assert_eq!(latest.passed_over[0].0, newest);
    fs::write(&latest.path, b"").unwrap();
    let error = open_latest(folder, SCENE).unwrap_err().to_string();
    assert!(error.starts_with("section `v.x`: BLAKE3"), "{error}");
}

/// A run that goes on from the last whole one must not lose it to a damaged one.
#[test]
fn a_damaged_one_is_none_of_the_last_two() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    save_next(folder, &at_step(1)).unwrap();
    let cut = save_next(folder, &at_step(2)).unwrap();
    let bytes = fs::read(&cut).unwrap();
    fs::write(&cut, &bytes[..bytes.len() - 1]).unwrap();
    save_next(folder, &at_step(3)).unwrap();
    let kept = [1, 2, 3].map(|k| format!("checkpoint-{k:06}.whp"));
    assert_eq!(names(folder), kept);
    // With two whole ones after it, it goes, and so does the damaged one.
    save_next(folder, &at_step(4)).unwrap();
    assert_eq!(names(folder), ["checkpoint-000003.whp", "checkpoint-000004.whp"]);
}

#[test]
fn another_scene_is_not_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    save_next(folder, &at_step(1)).unwrap();
    save_next(folder, &Writer::new(Meta { scene: "other".to_owned(), ..meta() })).unwrap();
    let error = open_latest(folder, SCENE).unwrap_err();
    assert!(matches!(error, CheckpointError::Scene { .. }), "{error}");
}

#[test]
fn a_failed_write_keeps_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    save_next(folder, &at_step(1)).unwrap();
    save_next(folder, &at_step(2)).unwrap();
    let endless = Writer::new(Meta { time: f64::NAN, ..meta() });
    assert!(save_next(folder, &endless).is_err());
    assert_eq!(names(folder), ["checkpoint-000001.whp", "checkpoint-000002.whp"]);
    let error = save_next(&folder.join("none"), &at_step(3)).unwrap_err();
    assert!(matches!(error, CheckpointError::Read { .. }), "{error}");
}
