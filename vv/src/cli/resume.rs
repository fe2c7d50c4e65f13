//! `--resume`: going on from a checkpoint, or saying in plain words why not.

use std::path::{Path, PathBuf};

use whipple_solver::space;
use whipple_solver::units::{Dimension, Units};

use super::Failure;
use crate::checkpoint::{CheckpointError, Reader, list};
use crate::space::checkpoint::{Halted, ResumeError, command_in, load};
use crate::space::history::HistoryError;
use crate::space::recorder::{FRAMES, LEDGER, Recorder};
use crate::words::told_apart;

/// The run that a checkpoint was written of; `command` is that of this run.
pub(super) fn resume(path: &Path, scene: &space::Scene, command: &str) -> Result<Halted, Failure> {
    let halted = load(path, scene).map_err(|error| refusal(path, &error, command))?;
    let (time, stop) = (halted.simulation.time(), scene.stop_time);
    if stop < time {
        let [time, stop] = [[time, stop], [stop, time]].map(|pair| said(pair, scene.units));
        let why = format!(
            "its state is that of t = {time}, after --stop {stop}: wanted a later --stop, or an earlier checkpoint"
        );
        return Err(refused(path, &why));
    }
    Ok(halted)
}

/// What a run leaves in another folder than that of its checkpoint: the ledger goes on from there, if it can. Says
/// what does not.
pub(super) fn carry(
    recorder: &mut Recorder,
    (out, path): (&Path, &Path),
    (time, units): (f64, Units),
    frames: bool,
) -> Vec<String> {
    let folder = folder_of(path);
    let [sub, index] = FRAMES;
    let at = format!("t = {}", said([time, 0.0], units));
    let mut notes = Vec::new();
    if !out.join(LEDGER).exists() {
        let taken = recorder.take_ledger(folder, time);
        let from = folder.join(LEDGER);
        notes.push(match taken {
            Ok(()) => format!("the ledger up to {at} is that of {}", from.display()),
            Err(HistoryError::Read { .. }) => format!(
                "the ledger begins at {at}, the time of the checkpoint: there is no {}",
                from.display()
            ),
            Err(error) => {
                format!("the ledger begins at {at}, the time of the checkpoint: {error}")
            }
        });
    }
    let earlier = folder.join(sub).join(index);
    if frames && earlier.exists() && !out.join(sub).join(index).exists() {
        notes.push(format!("frames of before {at} stay in {}", earlier.display()));
    }
    notes
}

/// A time with its unit, told from another.
fn said([time, other]: [f64; 2], units: Units) -> String {
    let unit = units.label(Dimension::Time);
    format!("{} {unit}", told_apart(time, other)).trim_end().to_owned()
}

/// The folder that a checkpoint lies in.
fn folder_of(path: &Path) -> &Path {
    let folder = path.parent().unwrap_or(Path::new(""));
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

fn refused(path: &Path, why: &str) -> Failure {
    Failure::usage(format!("--resume {}: {why}", path.display()))
}

/// Why a checkpoint cannot be gone on from, and what to do.
pub(super) fn refusal(path: &Path, error: &ResumeError, command: &str) -> Failure {
    use CheckpointError as E;
    let why = match error {
        ResumeError::Checkpoint(E::Scene { .. }) => other_scene(path, command),
        ResumeError::Checkpoint(E::Read { .. }) => {
            format!(
                "{error}; wanted {}",
                others(path, "a checkpoint from the --out folder of a run")
            )
        }
        ResumeError::Checkpoint(E::Header { .. }) => {
            format!("no checkpoint, or a damaged one: {error}; {}", instead(path))
        }
        ResumeError::Checkpoint(E::Section { .. }) => {
            format!("the file is damaged: {error}; {}", instead(path))
        }
        ResumeError::Checkpoint(E::Newer { .. }) => {
            format!("{error}; go on with the program that wrote it")
        }
        ResumeError::Looks { .. } => format!(
            "its run measured at other times than this one: {error}; give the --stop of the run that \
             wrote it"
        ),
        other => format!(
            "{other}: whole, but not what this version of the program keeps of a state; go on with the \
             version that wrote it, or start again without --resume"
        ),
    };
    refused(path, &why)
}

/// A checkpoint of another scene: of which, if it says so.
fn other_scene(path: &Path, command: &str) -> String {
    let written =
        Reader::open_any(path).ok().and_then(|mut reader| command_in(&mut reader).ok()?);
    let advice = "go on with the scene of the checkpoint: give case, --preset, --n, --variant, \
                  --density and --set as in the run that wrote it";
    match written {
        Some(written) if written == command => format!(
            "`{command}` wrote it as well, but with another version of the program, whose scene is not \
             the same; go on with that version, or start again without --resume"
        ),
        Some(written) => format!(
            "it is of another scene\n  it was written by  `{written}`\n  and this run is    `{command}`\n  \
             {advice}"
        ),
        None => format!("it is of another scene than `{command}`; {advice}"),
    }
}

/// What to do without a checkpoint.
fn instead(path: &Path) -> String {
    format!("take {}", others(path, "another one")) + ", or start again without --resume"
}

/// The newest whole checkpoint beside a path or in it, or words for it.
fn others(path: &Path, or: &str) -> String {
    let folder = if path.is_dir() { path } else { folder_of(path) };
    let all = list(folder).unwrap_or_default();
    let whole = |other: &PathBuf| other != path && Reader::open_any(other).is_ok();
    all.into_iter().rev().find(whole).map_or_else(
        || or.to_owned(),
        |path| {
            let path = path.strip_prefix(".").unwrap_or(&path);
            format!("{}, which is whole", path.display())
        },
    )
}
