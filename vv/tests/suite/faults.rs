//! Disks that fill up or turn read-only, and two programs in one folder: what was there stays whole, what fails is
//! named, and the run goes on from what is left.
#![cfg(target_os = "linux")]
#![allow(clippy::print_stdout)]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use whipple_vv::checkpoint::Reader;
use whipple_vv::record::RunRecord;

use crate::common::{Said, said, whipple};
use crate::long_runs::{PLAIN, assert_same_run, assert_well, names, short_rod};

/// Says that the system lets nobody mount a file system, for which there is nothing to test.
const NO_MOUNT: i32 = 77;

/// Sizes of the disk in kB; `WHIPPLE_DISKS=1` tries every 16 kB up to what the run needs.
const SIZES: [usize; 8] = [16, 64, 128, 256, 512, 768, 1024, 1536];

/// Size at which the run fits.
const ENOUGH: usize = 16_384;

/// A run that writes the ledger, frames, checkpoints, the record and what goes with it.
fn arguments() -> Vec<&'static str> {
    let writes = ["--stop", "1", "--vtu", "0.3us", "--checkpoint", "50ms", "--out", "out"];
    [&short_rod()[..], &PLAIN, &writes].concat()
}

/// Runs a shell script in which `disk` is an empty file system of its own and `"$@"` the program with arguments. What is
/// on the disk is in `kept` afterwards. Nothing where mounting is not allowed.
fn with_disk(folder: &Path, options: &str, script: &str, args: &[&str]) -> Option<Said> {
    for name in ["disk", "kept"] {
        fs::create_dir_all(folder.join(name)).expect("a folder");
    }
    let script = format!(
        "mount -t tmpfs -o {options} none disk 2>/dev/null || exit {NO_MOUNT}; cd disk\n{script}\ncode=$?; cd ..; \
         cp -a disk/. kept/; exit $code"
    );
    let mut command = Command::new("unshare");
    command.args(["-rm", "sh", "-c", &script, "sh", env!("CARGO_BIN_EXE_whipple")]).args(args);
    command.current_dir(folder).env("NO_COLOR", "1").env("COLUMNS", "100");
    let said: Said = command.output().ok()?.into();
    if said.code == Some(NO_MOUNT) || said.err.contains("unshare") {
        println!("no file system can be mounted here: not tested");
        return None;
    }
    Some(said)
}

/// Everything in the folder of a run is whole: checkpoints, record, and the lines of the ledger.
fn assert_whole(out: &Path) {
    for name in names(out) {
        let path = out.join(&name);
        if name.ends_with(".whp") {
            assert!(Reader::open_any(&path).is_ok(), "{name} is damaged");
        } else if name == "record.json" {
            assert!(RunRecord::read(&path).is_ok(), "{name} is damaged");
        } else if name == "ledger.csv" {
            let text = fs::read_to_string(&path).expect("text");
            let columns = |line: &str| line.split(',').count();
            let first = text.lines().next().map_or(0, columns);
            assert!(
                text.ends_with('\n') && text.lines().all(|line| columns(line) == first),
                "{name}"
            );
        }
    }
}

/// The newest checkpoint of a folder.
fn newest(out: &Path) -> Option<String> {
    names(out).into_iter().rfind(|name| name.ends_with(".whp"))
}

/// The run in a folder goes on where it can, or begins anew, and is that which was never disturbed.
fn assert_goes_on(at: &Path, whole: &Path) {
    let out = at.join("out");
    let from = out.exists().then(|| newest(&out)).flatten().map(|name| format!("out/{name}"));
    let resume = from.iter().flat_map(|path| ["--resume", path]);
    let args: Vec<&str> = arguments().into_iter().chain(resume).collect();
    assert_well(&said(at, &args));
    assert_same_run(whole, &out);
    let hidden = names(&out).into_iter().find(|name| name.starts_with('.'));
    assert_eq!(hidden, None, "what is left of a write");
}

#[test]
fn full_disks_lose_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    assert_well(&said(folder.path(), &arguments()));
    let whole = folder.path().join("out");
    let all = std::env::var("WHIPPLE_DISKS").is_ok();
    let sizes: Vec<usize> =
        if all { (1..ENOUGH / 16).map(|k| 16 * k).collect() } else { SIZES.to_vec() };
    let (mut full, mut files) = (0, BTreeSet::new());
    for size in sizes {
        let folder = tempfile::tempdir().expect("a folder");
        let at = folder.path();
        let options = format!("size={size}k");
        let Some(said) = with_disk(at, &options, "\"$@\"", &arguments()) else { return };
        let kept = at.join("kept");
        if said.code == Some(0) {
            assert_same_run(&whole, &kept.join("out"));
            break;
        }
        assert_eq!(said.code, Some(2), "{size} kB: {}", said.err);
        let said = said.err.lines().find(|line| line.contains("the disk is full"));
        let said = said.expect("why it ended");
        let (_, file) = said.split_once("out/").unwrap_or(("", "the folder"));
        files.insert(file.split(':').next().unwrap_or_default().to_owned());
        full += 1;
        if kept.join("out").exists() {
            assert_whole(&kept.join("out"));
        }
        assert_goes_on(&kept, &whole);
    }
    println!("{full} disks were full: {files:?}");
    assert!(full > 3);
}

#[test]
fn reports_on_full_disks_keep_their_records() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = ["vv", "noh", "--level", "quick", "--out", "out"];
    for size in [16, 200] {
        let Some(said) = with_disk(folder.path(), &format!("size={size}k"), "\"$@\"", &args) else {
            return;
        };
        assert_eq!(said.code, Some(2), "{size} kB: {}", said.err);
        assert!(said.err.contains("the disk is full"), "{}", said.err);
        let records = folder.path().join("kept/out/records");
        for name in if records.exists() { names(&records) } else { Vec::new() } {
            assert!(RunRecord::read(&records.join(&name)).is_ok(), "{name}");
        }
    }
}

#[test]
fn read_only_folders_are_refused_and_lose_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let Some(refused) = with_disk(at, "ro", "\"$@\"", &arguments()) else { return };
    assert_eq!(refused.code, Some(2));
    assert!(refused.err.contains("cannot make the folder out: it is read-only"), "{}", refused.err);
    // It turns read-only as soon as there is a checkpoint.
    let script = "\"$@\" & run=$!; while [ ! -e out/checkpoint-000001.whp ]; do sleep 0.01; done; \
                  while ! mount -o remount,ro \"$PWD\" 2>/dev/null; do sleep 0.001; done; wait $run";
    let args = arguments();
    let long = args.iter().map(|arg| if *arg == "1" { "3" } else { arg });
    let long: Vec<&str> = long.collect();
    let Some(ended) = with_disk(at, "size=64m", script, &long) else { return };
    assert_eq!(ended.code, Some(2), "{}", ended.err);
    assert!(ended.err.contains("it is read-only"), "{}", ended.err);
    let kept = at.join("kept");
    assert_whole(&kept.join("out"));
    let whole = tempfile::tempdir().expect("a folder");
    assert_well(&said(whole.path(), &arguments()));
    let from = format!("out/{}", newest(&kept.join("out")).expect("a checkpoint"));
    assert_well(&said(&kept, &[&long[..], &["--resume", &from]].concat()));
    let from = format!("out/{}", newest(&whole.path().join("out")).expect("a checkpoint"));
    assert_well(&said(whole.path(), &[&long[..], &["--resume", &from]].concat()));
}

#[test]
fn two_programs_do_not_write_in_one_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let args = [&short_rod()[..], &PLAIN, &["--stop", "20", "--out", "out"]].concat();
    let mut first = whipple(&args)
        .current_dir(at)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let start = Instant::now();
    while !at.join("out/unfinished.txt").exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "it does not begin");
        std::thread::sleep(Duration::from_millis(5));
    }
    let others: [&[&str]; 3] = [
        &args,
        &["run", "noh", "--n", "20", "--out", "out"],
        &["vv", "noh", "--level", "quick", "--out", "out"],
    ];
    for other in others {
        let refused = said(at, other);
        assert_eq!(refused.code, Some(2), "{}", refused.err);
        assert!(refused.err.contains("another whipple writes in out"), "{}", refused.err);
    }
    first.kill().expect("it is there");
    first.wait().expect("it ends");
    // It has left no state: another run is refused, the same begins anew.
    let refused = said(at, &["run", "noh", "--n", "20", "--out", "out"]);
    assert_eq!(refused.code, Some(2));
    let why = "error: out holds another run, `whipple run long-rod ";
    assert!(
        refused.err.starts_with(why) && refused.err.contains("no state to go on from"),
        "{}",
        refused.err
    );
}
