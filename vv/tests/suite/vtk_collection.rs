//! The collection: readable after every frame, and continued after a restart.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use whipple_vv::vtk::{Cells, Collection, CollectionError, Grid, VtkError};

use crate::vtk_reader::{Document, attribute};

const POINT: [[f64; 3]; 1] = [[0.0; 3]];

fn state() -> Grid<'static> {
    Grid {
        points: &POINT,
        cells: Cells::particles(),
        point_data: Vec::new(),
        cell_data: Vec::new(),
    }
}

/// Time, part number, part name and file of every entry of the index; every file is read.
fn listed(path: &Path) -> Vec<(f64, usize, String, String)> {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.ends_with("</Collection>\n</VTKFile>\n"));
    let lines = text.lines().filter(|line| line.starts_with("<DataSet"));
    lines
        .map(|line| {
            let file = attribute(line, "file");
            let read = Document::read(&fs::read(path.with_file_name(&file)).unwrap());
            let time: f64 = attribute(line, "timestep").parse().unwrap();
            assert_eq!(read.array("FieldData", "TimeValue").values(f64::from_le_bytes), [time]);
            (time, attribute(line, "part").parse().unwrap(), attribute(line, "name"), file)
        })
        .collect()
}

#[test]
fn the_index_is_whole_after_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run & <3>.pvd");
    let mut collection = Collection::new(&path).unwrap();
    assert!(!path.exists());
    for (frame, time) in [0.0, 1.0 / 3.0].into_iter().enumerate() {
        collection.record(time, "particles", &state()).unwrap();
        assert_eq!(listed(&path).len(), 2 * frame + 1);
        let file = collection.record(time, "elements", &state()).unwrap();
        assert_eq!(file, folder.path().join(format!("run & <3>-elements-00000{frame}.vtu")));
        let last = listed(&path).pop().unwrap();
        assert_eq!((last.0, last.1, last.2.as_str()), (time, 1, "elements"));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 5);
}

#[test]
fn a_restart_drops_what_it_writes_anew() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a\"b&lt;.pvd");
    let mut whole = Collection::new(&path).unwrap();
    for step in 0..4_u32 {
        whole.record(0.1 * f64::from(step), "particles", &state()).unwrap();
    }
    let bytes = fs::read(&path).unwrap();
    let mut resumed = Collection::resume(&path, 0.2).unwrap();
    assert_eq!(resumed.entries(), &whole.entries()[..2]);
    for step in 2..4_u32 {
        resumed.record(0.1 * f64::from(step), "particles", &state()).unwrap();
    }
    assert_eq!(resumed, whole);
    assert_eq!(fs::read(&path).unwrap(), bytes);
}

#[test]
fn frames_out_of_order_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.pvd");
    let mut collection = Collection::new(&path).unwrap();
    collection.record(1.0, "particles", &state()).unwrap();
    let before = fs::read(&path).unwrap();
    for (time, part, wanted) in [
        (
            0.5,
            "particles",
            "part `particles` at time 0.5 comes after time 1.0, wanted a later time",
        ),
        (
            1.0,
            "particles",
            "part `particles` at time 1.0 comes after time 1.0, wanted a later time",
        ),
        (2.0, "../x", "part name \"../x\" is not usable, wanted letters, digits, `-` or `_`"),
        (2.0, "", "part name \"\" is not usable, wanted letters, digits, `-` or `_`"),
        (f64::NAN, "particles", "time is NaN, wanted a finite number"),
    ] {
        assert_eq!(collection.record(time, part, &state()).unwrap_err().to_string(), wanted);
    }
    assert_eq!(fs::read(&path).unwrap(), before);
    assert_eq!(collection.entries().len(), 1);
}

#[test]
fn a_frame_that_cannot_be_listed_is_not_remembered() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.pvd");
    fs::create_dir(&path).unwrap();
    let mut collection = Collection::new(&path).unwrap();
    let error = collection.record(0.0, "particles", &state()).unwrap_err();
    assert!(matches!(error, VtkError::File(_)), "{error}");
    assert!(collection.entries().is_empty());
}

#[test]
fn only_an_index_of_this_program_is_continued() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.pvd");
    let why = || Collection::resume(&path, 1.0).unwrap_err();
    assert!(matches!(why(), CollectionError::Read { .. }));
    Collection::new(&path).unwrap().record(0.0, "particles", &state()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let line = |error| match error {
        CollectionError::Format { line, .. } => line,
        other => panic!("{other}"),
    };
    for (damaged, wanted) in [
        (text.replace("timestep=\"0.0\"", "timestep=\"NaN\""), 4),
        (text.replace(" name=", " nam="), 4),
        (text.replace("name=\"particles\"", "name=\"../x\""), 4),
        (text.replace("/>", ">"), 4),
        (text[..text.len() - 1].to_owned(), 6),
        (text[1..].to_owned(), 1),
        (String::new(), 1),
    ] {
        fs::write(&path, damaged).unwrap();
        assert_eq!(line(why()), wanted);
    }
    assert_eq!(
        Collection::new(Path::new("..")).unwrap_err().to_string(),
        ".. cannot be a collection, wanted a path like `out/run.pvd`"
    );
}
