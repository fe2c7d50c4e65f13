//! The report as a folder that is either whole or has no `index.html`.

use super::model::{Block, Drawing, Pictures, Report};
use super::outline::{outline, valid};
use super::{ReportError, csv, html, markdown};
use crate::plots::svg_to_png;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write as _};
use std::path::Path;

/// The page of a report.
pub const INDEX: &str = "index.html";
/// The same as text.
pub const TEXT: &str = "report.md";
/// Names of the files a report consists of: only these are ever removed.
const MANIFEST: &str = ".report-files";
/// Folder inside the target where a report is made before it takes the place of the old one.
const STAGE: &str = ".report-partial";
/// Pixels of a PNG per pixel of its SVG.
const PNG_SCALE: f32 = 2.0;

/// Writes `index.html`, `report.md`, `figures/ID.svg` and `.png`, and `tables/ID.csv`;
/// a picture is `figures/ID.png` and `ID-dark.png`.
///
/// All files are made in a temporary folder first, so that a failure while making them leaves an
/// earlier report as it was. Then `index.html` is removed, the others take their places, those of
/// an earlier report that are no longer needed are removed, and `index.html` comes last: a folder
/// with an `index.html` holds a whole report. Files that no report wrote are left alone.
///
/// # Errors
/// As [`html`]; a figure is not valid SVG; or the file system refuses, with path and cause.
pub fn write(
    report: &Report,
    figures: &BTreeMap<String, Drawing>,
    dir: &Path,
) -> Result<(), ReportError> {
    let files = render(report, figures)?;
    let stage = dir.join(STAGE);
    create(&stage)?;
    let written = fill(&stage, &files).and_then(|()| place(&stage, dir, &files));
    let cleared = remove(&stage, |path| fs::remove_dir_all(path));
    written.and(cleared)
}

/// All files by their path in the folder, but the manifest.
fn render(
    report: &Report,
    figures: &BTreeMap<String, Drawing>,
) -> Result<BTreeMap<String, Vec<u8>>, ReportError> {
    let mut files = BTreeMap::new();
    files.insert(INDEX.to_owned(), html(report, figures, Pictures::Beside)?.into_bytes());
    files.insert(TEXT.to_owned(), markdown(report).into_bytes());
    for (id, drawing) in figures {
        match drawing {
            Drawing::Chart(svg) => {
                let png = svg_to_png(svg, PNG_SCALE);
                let png = png.map_err(|source| ReportError::Picture { id: id.clone(), source })?;
                files.insert(format!("figures/{id}.png"), png);
                files.insert(format!("figures/{id}.svg"), svg.clone().into_bytes());
            }
            Drawing::Picture { light, dark } => {
                for (name, file) in Drawing::picture_files(id).iter().zip([light, dark]) {
                    files.insert(format!("figures/{name}"), file.clone());
                }
            }
        }
    }
    for (_, block) in outline(report).iter().flat_map(|chapter| &chapter.blocks) {
        if let Block::Table(table) = block {
            files.insert(format!("tables/{}.csv", table.id), csv(table).into_bytes());
        }
    }
    Ok(files)
}

/// Writes all files, and the folders they need, to the stage.
fn fill(stage: &Path, files: &BTreeMap<String, Vec<u8>>) -> Result<(), ReportError> {
    // What an interrupted run left behind.
    remove(stage, |path| fs::remove_dir_all(path))?;
    for folder in ["figures", "tables"] {
        create(&stage.join(folder))?;
    }
    files.iter().try_for_each(|(name, bytes)| save(&stage.join(name), bytes))
}

/// Moves the files from the stage to their places.
fn place(stage: &Path, dir: &Path, files: &BTreeMap<String, Vec<u8>>) -> Result<(), ReportError> {
    let old = manifest(dir)?;
    let new: BTreeSet<String> = files.keys().filter(|name| *name != INDEX).cloned().collect();
    for folder in ["figures", "tables"] {
        create(&dir.join(folder))?;
    }
    remove(&dir.join(INDEX), |path| fs::remove_file(path))?;
    sync(dir)?;
    let adopt = |name: &str| {
        let target = dir.join(name);
        let moved = fs::rename(stage.join(name), &target);
        moved.map_err(io_error("move a new file to", &target))
    };
    // The list covers both reports as long as files of both may be there.
    let list = |names: &mut dyn Iterator<Item = &String>| {
        let text: String = names.flat_map(|name| [name, "\n"]).collect();
        save(&stage.join(MANIFEST), text.as_bytes())?;
        adopt(MANIFEST)
    };
    list(&mut old.union(&new))?;
    new.iter().try_for_each(|name| adopt(name))?;
    for name in old.difference(&new) {
        remove(&dir.join(name), |path| fs::remove_file(path))?;
    }
    list(&mut new.iter())?;
    for folder in [dir.join("figures"), dir.join("tables"), dir.to_owned()] {
        sync(&folder)?;
    }
    adopt(INDEX)?;
    sync(dir)
}

/// The files of an earlier report; anything else in the list is ignored.
fn manifest(dir: &Path) -> Result<BTreeSet<String>, ReportError> {
    let ours = |line: &&str| {
        let id = match line.split_once('/') {
            Some(("figures", file)) => file.strip_suffix(".svg").or(file.strip_suffix(".png")),
            Some(("tables", file)) => file.strip_suffix(".csv"),
            _ => None,
        };
        *line == TEXT || id.is_some_and(valid)
    };
    let path = dir.join(MANIFEST);
    match fs::read_to_string(&path) {
        Ok(text) => Ok(text.lines().filter(ours).map(String::from).collect()),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(BTreeSet::new()),
        Err(e) => Err(io_error("read", &path)(e)),
    }
}

fn create(dir: &Path) -> Result<(), ReportError> {
    fs::create_dir_all(dir).map_err(io_error("create the folder", dir))
}

fn save(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    let written = File::create(path).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()
    });
    written.map_err(io_error("write", path))
}

/// Removes what may not be there.
fn remove(path: &Path, by: impl Fn(&Path) -> io::Result<()>) -> Result<(), ReportError> {
    match by(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(io_error("remove", path)(e)),
        _ => Ok(()),
    }
}

/// Makes the entries of a folder durable; only Unix can, and only Unix needs to.
fn sync(dir: &Path) -> Result<(), ReportError> {
    if cfg!(unix) {
        let synced = File::open(dir).and_then(|folder| folder.sync_all());
        synced.map_err(io_error("flush the folder", dir))?;
    }
    Ok(())
}

fn io_error(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> ReportError {
    let path = path.to_owned();
    move |source| ReportError::Io { action, path, source }
}
