//! The folder of `--out`: results of one run do not go among those of another, nor over files of the user.

use std::fs;
use std::path::{Path, PathBuf};

use super::Failure;
use crate::checkpoint::{Reader, list};
use crate::files::write_atomic;
use crate::pictures::PICTURES;
use crate::record::{RunRecord, files_in};
use crate::report::{self, Drawing};
use crate::run::Request;
use crate::scene::AnyScene;
use crate::space::checkpoint::{command_in, scene_hash};
use crate::space::diagnosis::FAILURE;
use crate::space::recorder::{FRAMES, LEDGER};
use crate::suite::records_folder;
use crate::vtk::Collection;

/// Name of the record in the folder of a run.
pub(super) const RECORD: &str = "record.json";
/// Name of the scene as it was run.
pub(super) const SCENE: &str = "scene.toml";
/// Names of the fields and of the histories.
pub(super) const PROFILE: &str = "profile.csv";
pub(super) const HISTORY: &str = "history.csv";
/// Name of the file with the command of the run that fills the folder, until it has ended.
const UNFINISHED: &str = "unfinished.txt";

/// What a folder holds that a run may not start anew in.
enum Other {
    /// Another run, with its command.
    Run(String),
    /// A checkpoint of a run that is not finished, and the command of that run if it is another.
    Unfinished(PathBuf, Option<String>),
}

/// A whole checkpoint of the folder.
struct Kept {
    path: PathBuf,
    command: Option<String>,
    /// Whether it is of the scene that is asked for, whenever that ends.
    same_scene: bool,
}

/// Refuses a folder that holds the record or a checkpoint of another run, or of this one if it is not
/// finished and does not go on, or files that only have the names of results. A finished run made again
/// replaces its own results; one that goes on may also end at another time. `again` is the command that
/// goes on with the run that is asked for, up to its folder.
pub(super) fn refuse_another_run(
    out: &Path,
    request: &Request,
    goes_on: bool,
    again: &str,
) -> Result<(), Failure> {
    let path = out.join(RECORD);
    let record = path.exists().then(|| RunRecord::read(&path)).transpose()?;
    let kept = kept(out, request);
    let known = record.is_some() || !kept.is_empty();
    let folder = out.display();
    match in_the_way(record.as_ref(), kept, request, goes_on) {
        Some(Other::Run(command)) => Err(Failure::usage(format!(
            "{folder} holds another run, {command}: name another folder with --out, or move that one away"
        ))),
        Some(Other::Unfinished(checkpoint, other)) => {
            let which = if other.is_some() { "another run" } else { "a run" };
            let again = other.as_deref().unwrap_or(again);
            let checkpoint = checkpoint.display();
            Err(Failure::usage(format!(
                "{folder} holds {which} that is not finished; continue it with\n  {again} --out {folder} \
                 --resume {checkpoint}\nor start anew: name another folder with --out, or delete that one"
            )))
        }
        None => Ok(()),
    }?;
    if known {
        return Ok(());
    }
    match begun(out) {
        // It was killed before its first checkpoint, and is made anew.
        Some(command) if command == request.command => return Ok(()),
        Some(command) => {
            return Err(Failure::usage(format!(
                "{folder} holds another run, `{command}`, which has left no state to go on from: that command makes it anew; \
                 for this one name another folder with --out, or delete that one"
            )));
        }
        None => {}
    }
    // A run that goes on reads ledger and frames, and refuses what is none of its own.
    let [frames, index] = FRAMES;
    let anew = [out.join(LEDGER), out.join(frames).join(index)];
    let names = [SCENE, PROFILE, HISTORY].map(|name| out.join(name));
    refuse_files(names.into_iter().chain(anew.into_iter().filter(|_| !goes_on)))
}

/// Refuses the folder of a report that holds files with its names, and no record.
pub(super) fn refuse_no_report(out: &Path, pages: &[&str]) -> Result<(), Failure> {
    let read = |path: PathBuf| RunRecord::read(&path).is_ok();
    if files_in(&records_folder(out)).is_ok_and(|paths| paths.into_iter().any(read)) {
        return Ok(());
    }
    let own = [report::INDEX, report::TEXT];
    refuse_files(own.iter().chain(pages).map(|name| out.join(name)))
}

/// Refuses to write over files that no record explains.
fn refuse_files(paths: impl Iterator<Item = PathBuf>) -> Result<(), Failure> {
    match { paths }.find(|path| path.exists()) {
        None => Ok(()),
        Some(path) => Err(Failure::usage(format!(
            "{} is there already, with no record beside it that says what it is: name another folder with \
             --out, or move that file away",
            path.display()
        ))),
    }
}

/// The command of a run that has begun in a folder and left no state to go on from.
fn begun(out: &Path) -> Option<String> {
    let none = list(out).is_ok_and(|checkpoints| checkpoints.is_empty());
    let text = fs::read_to_string(out.join(UNFINISHED)).ok().filter(|_| none)?;
    Some(text.trim_end().to_owned())
}

/// Says in the folder which run fills it from now on.
pub(super) fn begin(out: &Path, command: &str) -> Result<(), Failure> {
    Ok(write_atomic(&out.join(UNFINISHED), format!("{command}\n").as_bytes())?)
}

/// The run that fills the folder has ended.
pub(super) fn end(out: &Path) -> Result<(), Failure> {
    remove(&out.join(UNFINISHED))
}

/// Takes away what an earlier run of the same left, before it starts anew: a checkpoint of it is none of
/// the run that now fills the ledger.
pub(super) fn clear(out: &Path) -> Result<(), Failure> {
    let old = list(out).unwrap_or_default();
    let own = [RECORD, LEDGER].map(|name| out.join(name));
    let frames =
        [FRAMES, FAILURE].map(|[sub, index]| Collection::files(&out.join(sub).join(index)));
    let record = RunRecord::read(&out.join(RECORD)).ok();
    let drawn = record.iter().flat_map(|record| &record.pictures);
    let pictures: Vec<PathBuf> = drawn
        .flat_map(|picture| Drawing::picture_files(&picture.id))
        .map(|name| out.join(PICTURES).join(name))
        .collect();
    let all = old.iter().chain(&own).chain(frames.iter().flatten()).chain(&pictures);
    all.into_iter().try_for_each(|path| remove(path))
}

fn remove(path: &Path) -> Result<(), Failure> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(Failure::usage(format!("cannot remove {}: {error}", path.display())))
        }
        _ => Ok(()),
    }
}

/// What keeps a run from a folder with this record and these checkpoints, the newest first.
fn in_the_way(
    record: Option<&RunRecord>,
    kept: Vec<Kept>,
    request: &Request,
    goes_on: bool,
) -> Option<Other> {
    if let Some(record) = record.filter(|record| !is_of(record, request, goes_on)) {
        return Some(Other::Run(format!("`{}`", record.provenance.command)));
    }
    let finished = record.map(|record| &record.provenance.command);
    let own = |kept: &Kept| {
        let command = kept.command.as_ref();
        command == Some(&request.command) || command.is_some() && command == finished
    };
    for (age, kept) in kept.into_iter().enumerate() {
        // Earlier ones may be of a run that was to end sooner.
        let same = own(&kept) || kept.same_scene && (goes_on || age > 0);
        let named = kept.command.as_ref().map(|command| format!("`{command}`"));
        match (same, record) {
            (true, Some(_)) => {}
            (true, None) if goes_on => {}
            (true, None) => return Some(Other::Unfinished(kept.path, None)),
            (false, None) if !goes_on && kept.command.is_some() => {
                return Some(Other::Unfinished(kept.path, kept.command));
            }
            (false, _) => return Some(Other::Run(named.unwrap_or("of another scene".to_owned()))),
        }
    }
    None
}

/// Whether a record is of the run that is asked for.
fn is_of(record: &RunRecord, request: &Request, goes_on: bool) -> bool {
    let wanted = request.scene.as_ref().map(as_read);
    let mut scene = record.scene.clone();
    if let (Some(scene), Some(wanted), true) = (&mut scene, &wanted, goes_on) {
        scene.set_stop_time(wanted.stop_time());
    }
    record.provenance.command == request.command || (record.key == request.key && scene == wanted)
}

/// A scene as a record of it is read: a number may differ in its last bit.
fn as_read(scene: &AnyScene) -> AnyScene {
    let text = serde_json::to_string(scene).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_else(|_| scene.clone())
}

/// The whole checkpoints of a folder, the newest first. Damaged ones cannot say what they are of.
fn kept(out: &Path, request: &Request) -> Vec<Kept> {
    let own = request.scene.as_ref().and_then(AnyScene::space).map(scene_hash);
    let said = |path: PathBuf| {
        let mut reader = Reader::open_any(&path).ok()?;
        let same_scene = own.as_ref() == Some(&reader.meta().scene);
        Some(Kept { path, same_scene, command: command_in(&mut reader).ok().flatten() })
    };
    list(out).unwrap_or_default().into_iter().rev().filter_map(said).collect()
}
