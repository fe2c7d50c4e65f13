//! The folder of `--out`: results of one run do not go among those of another.

use std::path::Path;

use super::Failure;
use crate::checkpoint::{Reader, list};
use crate::record::RunRecord;
use crate::run::Request;
use crate::scene::AnyScene;
use crate::space::checkpoint::{command_in, scene_hash};

/// Name of the record in the folder of a run.
pub(super) const RECORD: &str = "record.json";

/// Refuses a folder that holds the record or a checkpoint of another run. The same run made again may
/// replace its own; one that goes on may also end at another time.
pub(super) fn refuse_another_run(
    out: &Path,
    request: &Request,
    goes_on: bool,
) -> Result<(), Failure> {
    let record = out.join(RECORD);
    let of_record =
        if record.exists() { record_of_another(&record, request, goes_on)? } else { None };
    let Some(other) = of_record.or_else(|| checkpoint_of_another(out, request)) else {
        return Ok(());
    };
    Err(Failure::usage(format!(
        "{} holds another run, {other}: name another folder with --out, or move that one away",
        out.display()
    )))
}

/// The run of a record, if it is not the one that is asked for.
fn record_of_another(
    path: &Path,
    request: &Request,
    goes_on: bool,
) -> Result<Option<String>, Failure> {
    let record = RunRecord::read(path)?;
    let wanted = request.scene.as_ref().map(as_read);
    let mut scene = record.scene;
    if let (Some(scene), Some(wanted), true) = (&mut scene, &wanted, goes_on) {
        scene.set_stop_time(wanted.stop_time());
    }
    let same = record.provenance.command == request.command
        || (record.key == request.key && scene == wanted);
    Ok((!same).then(|| format!("`{}`", record.provenance.command)))
}

/// A scene as a record of it is read: a number may differ in its last bit.
fn as_read(scene: &AnyScene) -> AnyScene {
    let text = serde_json::to_string(scene).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_else(|_| scene.clone())
}

/// The run of the newest whole checkpoint of another scene. Damaged ones cannot say what they are of.
fn checkpoint_of_another(out: &Path, request: &Request) -> Option<String> {
    let own = request.scene.as_ref().and_then(AnyScene::space).map(scene_hash);
    let whole = |path| Reader::open_any(path).ok();
    let paths = list(out).unwrap_or_default();
    paths.iter().rev().filter_map(|path| whole(path.as_path())).find_map(|mut reader| {
        let command = command_in(&mut reader).ok().flatten();
        let same = own.as_ref() == Some(&reader.meta().scene)
            || command.as_ref() == Some(&request.command);
        let of = || command.map_or("of another scene".to_owned(), |command| format!("`{command}`"));
        (!same).then(of)
    })
}
