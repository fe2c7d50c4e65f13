//! Runs in three dimensions that are stopped and go on, and what they leave in their folders.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;
use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::restart::Values;
use whipple_vv::checkpoint::{CheckpointError, ElementType, Reader};
use whipple_vv::record::RunRecord;
use whipple_vv::run::{Monitor, Request, RunError, Silent, SpaceOptions, run_with};
use whipple_vv::space::checkpoint::{Halted, load, save};
use whipple_vv::space::measured::{Look, Measured};
use whipple_vv::space::recorder::Recorder;
use whipple_vv::suite::scene_of;

use crate::common::{SHORT_ROD, Said, case, cut_short, key, said, whipple};

/// Arguments of a run of the short rod, some sixty steps in a microsecond.
pub fn short_rod() -> Vec<&'static str> {
    let sets = SHORT_ROD.into_iter().flat_map(|set| ["--set", set]);
    ["run", "long-rod"].into_iter().chain(sets).collect()
}

/// A variant that takes no pictures, which take longer than a short run.
pub const PLAIN: [&str; 2] = ["--variant", "viscosity-1"];

/// Runs the short rod in a folder, without pictures.
fn rod(folder: &Path, args: &[&str]) -> Said {
    said(folder, &[&short_rod()[..], &PLAIN, args].concat())
}

/// A run must end well.
pub fn assert_well(said: &Said) {
    assert_eq!((said.code, errors(said).as_str()), (Some(0), ""));
}

/// What was said beside the note that the problem is another.
fn errors(said: &Said) -> String {
    let lines = said.err.lines().filter(|line| !line.starts_with("note: "));
    lines.collect::<Vec<&str>>().join("\n")
}

/// The record in a folder, without what clock and memory say.
fn record(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("record.json")).expect("a record");
    let mut record: Value = serde_json::from_str(&text).expect("JSON");
    for name in ["cpu_seconds", "threads"] {
        record.as_object_mut().expect("an object").remove(name).expect(name);
    }
    record["provenance"]["date"].take();
    for name in ["updates_per_cpu_second", "bytes_per_particle"] {
        record["space"][name].take();
    }
    record
}

/// Two records must say the same, to the bit.
fn assert_same_record(a: &Path, b: &Path) {
    let (a, b) = (record(a), record(b));
    for (name, value) in a.as_object().expect("an object") {
        assert!(*value == b[name], "{name}: {value} and {}", b[name]);
    }
}

/// All values of a checkpoint as bytes by section, without what the clock says.
fn sections(path: &Path) -> BTreeMap<String, Vec<u8>> {
    fn bytes<T: whipple_vv::checkpoint::Element, const N: usize>(
        (reader, name, shape): (&mut Reader, &str, &[usize]),
        to_bytes: fn(T) -> [u8; N],
    ) -> Result<Vec<u8>, CheckpointError> {
        Ok(reader.array::<T>(name, shape)?.into_iter().flat_map(to_bytes).collect())
    }
    let mut reader = Reader::open_any(path).expect("a checkpoint");
    let mut all = BTreeMap::new();
    for section in reader.sections().to_vec() {
        let shape: Vec<usize> = section.shape.iter().map(|&extent| extent as usize).collect();
        let from = (&mut reader, section.name.as_str(), shape.as_slice());
        let values = match section.element {
            ElementType::F64 => bytes(from, f64::to_le_bytes),
            ElementType::U64 => bytes(from, u64::to_le_bytes),
            ElementType::U32 => bytes(from, u32::to_le_bytes),
            ElementType::U8 => bytes(from, u8::to_le_bytes),
            _ => reader.bytes(&section.name),
        };
        all.insert(section.name, values.expect("a whole section"));
    }
    all.remove("measured.cpu_seconds").expect("the CPU time");
    all
}

/// Names of the files below a folder.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
    let mut names: Vec<String> =
        entries.map(|entry| name(entry).to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Two folders of the same run: record, ledger, frames and the last state have the same bits.
pub fn assert_same_run(a: &Path, b: &Path) {
    assert_same_record(a, b);
    let read = |folder: &Path, name: &str| fs::read(folder.join(name)).expect("a file");
    for name in ["ledger.csv", "history.csv"] {
        assert!(read(a, name) == read(b, name), "{name}");
    }
    let last = |folder: &Path| {
        let mut all = names(folder).into_iter();
        folder.join(all.rfind(|name| name.ends_with(".whp")).expect("a checkpoint"))
    };
    assert!(sections(&last(a)) == sections(&last(b)), "the last states");
    if a.join("vtu").exists() {
        let frames = names(&a.join("vtu"));
        assert_eq!(frames, names(&b.join("vtu")));
        for name in frames {
            let name = format!("vtu/{name}");
            assert!(read(a, &name) == read(b, &name), "{name}");
        }
    }
}

/// The command that a run names when it is stopped, without the program: it runs to the end.
fn next_command(said: &Said) -> Vec<String> {
    let (_, command) = said.err.split_once("continue with\n  whipple ").expect("a command");
    assert!(!command.contains("--max-wall"), "{command}");
    command.split_whitespace().map(str::to_owned).collect()
}

/// Runs the command that a stopped run names.
fn go_on(folder: &Path, stopped: &Said) {
    let command = next_command(stopped);
    let words: Vec<&str> = command.iter().map(String::as_str).collect();
    assert_well(&said(folder, &words));
}

/// run(2N) = run(N) + resume + run(N), also on another number of threads.
#[test]
fn run_that_goes_on_is_the_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let run = |args: &[&str]| assert_well(&said(at, &[&short_rod()[..], args].concat()));
    run(&["--stop", "6us", "--vtu", "1.7us", "--out", "whole"]);
    run(&["--stop", "3", "--vtu", "1700ns", "--out", "parts"]);
    let rest = ["--vtu", "1.7us", "--threads", "2", "--resume", "parts/checkpoint-000001.whp"];
    run(&[&["--stop", "6", "--out", "parts"][..], &rest].concat());
    assert_same_run(&at.join("whole"), &at.join("parts"));
    let frames = names(&at.join("parts/vtu"));
    assert_eq!(frames.len(), 2 * 4 + 1, "0, 1.7, 3.4 and 5.1 us: {frames:?}");
    let [whole, parts] = ["whole", "parts"].map(|name| at.join(name).join("pictures"));
    assert_eq!(names(&whole), ["long-rod-start-dark.png", "long-rod-start.png"]);
    for name in names(&whole) {
        assert_eq!(fs::read(whole.join(&name)).ok(), fs::read(parts.join(&name)).ok(), "{name}");
    }
    let kept = names(&at.join("parts")).into_iter().filter(|name| name.ends_with(".whp"));
    assert_eq!(kept.count(), 2, "the last two");
}

/// Output moves no bit of the run.
#[test]
fn frames_do_not_move_the_run() {
    let folder = tempfile::tempdir().expect("a folder");
    assert_well(&rod(folder.path(), &["--stop", "1", "--out", "plain"]));
    assert_well(&rod(folder.path(), &["--stop", "1", "--vtu", "0.07us", "--out", "frames"]));
    let [plain, frames] = ["plain", "frames"].map(|name| folder.path().join(name));
    assert_same_record(&plain, &frames);
}

/// `--max-wall` stops with 130 and a command that gives the rest, to the bit.
#[test]
fn time_on_the_clock_ends_a_run_that_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let case = [&short_rod()[..], &PLAIN].concat();
    for case in [case.as_slice(), &["run", "planar-impact", "--n", "16"]] {
        let run = |more: &[&str]| said(at, &[case, &["--stop", "2"], more].concat());
        assert_well(&run(&["--out", "whole"]));
        let stopped = run(&["--vtu", "1us", "--max-wall", "1us", "--out", "stopped"]);
        assert_eq!((stopped.code, stopped.out.as_str()), (Some(130), ""));
        assert!(!stopped.err.contains("error:"), "it was planned: {}", stopped.err);
        let kept = "note: --max-wall is over; the state is kept in stopped/checkpoint-000001.whp; \
                    continue with\n  whipple run ";
        assert!(stopped.err.contains(kept), "{}", stopped.err);
        assert!(!at.join("stopped/record.json").exists(), "no record of half a run");
        assert!(next_command(&stopped).contains(&"--vtu".to_owned()), "{}", stopped.err);
        go_on(at, &stopped);
        let [whole, stopped] = ["whole", "stopped"].map(|name| at.join(name));
        assert_same_record(&whole, &stopped);
        assert_eq!(
            fs::read(whole.join("ledger.csv")).ok(),
            fs::read(stopped.join("ledger.csv")).ok()
        );
        for folder in [whole, stopped] {
            fs::remove_dir_all(folder).expect("it goes away");
        }
    }
}

/// What lies in a folder, to the byte.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let read = |name: String| (name.clone(), fs::read(folder.join(name)).expect("a file"));
    names(folder).into_iter().map(read).collect()
}

/// A run that is not finished is not begun anew over what it has done: the refusal names the command that goes
/// on, and nothing is lost. That holds for the same run and for one that only ends at another time.
#[test]
fn unfinished_run_is_not_begun_anew() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let [whole, parts] = ["whole", "parts"].map(|name| at.join(name));
    assert_well(&rod(at, &["--stop", "2", "--out", "whole"]));
    let stopped = rod(at, &["--stop", "2", "--max-wall", "1us", "--out", "parts"]);
    assert_eq!(stopped.code, Some(130), "{}", stopped.err);
    let before = contents(&parts);
    let [same, other] = ["2", "3"].map(|stop| rod(at, &["--stop", stop, "--out", "parts"]));
    for (refused, which) in [(&same, "a run"), (&other, "another run")] {
        assert_eq!((refused.code, refused.out.as_str()), (Some(2), ""));
        // Notes are for runs that start.
        let begin = format!(
            "error: parts holds {which} that is not finished; continue it with\n  whipple run long-rod "
        );
        assert!(refused.err.starts_with(&begin), "{}", refused.err);
        let end = "--stop 2 --set bodies.0.shape.cylinder.length=1.5";
        assert!(refused.err.contains(end), "{}", refused.err);
        let end = "\nor start anew: name another folder with --out, or delete that one\n";
        assert!(refused.err.ends_with(end), "{}", refused.err);
    }
    assert!(contents(&parts) == before, "nothing is lost");
    let named = same.err.lines().nth(1).expect("a command");
    let words: Vec<&str> = named.split_whitespace().skip(1).collect();
    // A ledger that has not come so far is of another run.
    let ledger = fs::read_to_string(parts.join("ledger.csv")).expect("a ledger");
    let short: Vec<&str> = ledger.split_inclusive('\n').take(2).collect();
    fs::write(parts.join("ledger.csv"), short.concat()).expect("a file");
    let refused = said(at, &words);
    assert_eq!(refused.code, Some(2), "{}", refused.err);
    assert!(errors(&refused).starts_with("error: parts/ledger.csv ends at time 0, before that of"));
    fs::write(parts.join("ledger.csv"), ledger).expect("a file");
    assert_well(&said(at, &words));
    assert_same_run(&whole, &parts);
    // Finished, it may be made again, and is then alone in its folder.
    assert_eq!(names(&parts).iter().filter(|name| name.ends_with(".whp")).count(), 2);
    assert_well(&rod(at, &["--stop", "2", "--out", "parts"]));
    assert_eq!(names(&parts), names(&whole));
    assert_same_run(&whole, &parts);
    // A checkpoint tells other ends as a record does, though its scene is the same.
    assert_well(&rod(
        at,
        &["--stop", "3", "--out", "parts", "--resume", "parts/checkpoint-000001.whp"],
    ));
    fs::copy(whole.join("record.json"), parts.join("record.json")).expect("a copy");
    let refused = rod(at, &["--stop", "2", "--out", "parts"]);
    assert!(
        refused.err.starts_with("error: parts holds another run, `whipple run"),
        "{}",
        refused.err
    );
    assert!(refused.err.contains(" --stop 3 "), "{}", refused.err);
}

/// Stops a run before its end, when every case has looked.
struct Late;

impl Monitor for Late {
    fn tick(&self, time: f64, stop: f64, _: u64) -> bool {
        time < 0.75 * stop
    }
}

/// Every case that looks along the way finds the same after a stop on it.
#[test]
fn cases_go_on_from_where_they_are() {
    for (id, variant, n) in [
        ("planar-impact", "", 16),
        ("elastic-plastic-piston", "", 40),
        ("spall", "", 20),
        ("taylor-copper", "", 4),
        ("taylor-42crmo4", "", 4),
        ("free-surface", "", 20),
        ("spinning-block", "", 10),
        ("beam", "", 2),
    ] {
        let key = key(id, Preset::Default, n).variant(variant);
        let scene = scene_of(case(id), &key).expect("a scene");
        let folder = tempfile::tempdir().expect("a folder");
        let solid = scene.space().expect("a scene in space").clone();
        let run = |from: Option<Halted>, monitor: &dyn Monitor| {
            let recorder = Recorder::new(folder.path(), &solid, None, from.as_ref());
            let recorder = Some(recorder.expect("a recorder"));
            let options = SpaceOptions { from, recorder, pictures: false };
            let (key, scene, command) = (key.clone(), Some(scene.clone()), String::new());
            run_with(case(id), Request { key, scene, threads: 1, command }, options, monitor)
        };
        let whole = run(None, &Silent).expect("a run").record;
        let Err(RunError::Interrupted { checkpoint: Some(path) }) = run(None, &Late) else {
            panic!("{id}: no checkpoint on the way");
        };
        let halted = load(&path, &solid).expect("a checkpoint");
        assert!(halted.measured.looks.len() > 1, "{id}: it had looked");
        let parts = run(Some(halted), &Silent).expect("the rest").record;
        // As text, where what is no number equals itself.
        let found = |r: &RunRecord| {
            let RunRecord { norms, history, profile, steps, energy_drift, .. } = r;
            format!("{norms:?} {history:?} {profile:?} {steps} {energy_drift:?}")
        };
        assert_eq!(found(&parts), found(&whole), "{id}");
    }
}

/// Checkpoints while the run goes on: the last two are left, and the run is the same.
#[test]
fn checkpoints_are_written_along_the_way() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    assert_well(&rod(at, &["--stop", "2", "--out", "plain"]));
    assert_well(&rod(at, &["--stop", "2", "--checkpoint", "1us", "--out", "often"]));
    let [plain, often] = ["plain", "often"].map(|name| at.join(name));
    let kept = |folder: &Path| {
        let all = names(folder).into_iter();
        all.filter(|name| name.ends_with(".whp")).collect::<Vec<String>>()
    };
    assert_eq!(kept(&plain), ["checkpoint-000001.whp"]);
    // A checkpoint alone says whose folder it is.
    fs::rename(plain.join("record.json"), at.join("aside.json")).expect("it moves");
    for args in [&["run", "sod", "--n", "20"][..], &["run", "planar-impact", "--n", "16"]] {
        let refused = said(at, &[args, &["--out", "plain"]].concat());
        assert_eq!(refused.code, Some(2));
        let begin = "error: plain holds another run that is not finished; continue it with\n  whipple run \
                     long-rod --variant viscosity-1 ";
        assert!(errors(&refused).starts_with(begin), "{}", refused.err);
    }
    fs::rename(at.join("aside.json"), plain.join("record.json")).expect("it moves");
    let [earlier, _] = kept(&often).try_into().expect("the last two");
    assert_same_run(&plain, &often);
    fs::remove_dir_all(&plain).expect("it goes away");
    let from = format!("often/{earlier}");
    assert!(Reader::open_any(&at.join(&from)).expect("a checkpoint").meta().time < 2.0);
    // In another folder the ledger goes along with the run.
    let resumed = rod(at, &["--stop", "2", "--out", "plain", "--resume", &from]);
    assert_well(&resumed);
    assert!(resumed.err.contains("is that of often/ledger.csv\n"), "{}", resumed.err);
    assert_same_run(&plain, &often);
    // Without one beside the checkpoint it begins with that, which is said.
    fs::create_dir(at.join("alone")).expect("a folder");
    fs::copy(at.join(&from), at.join("alone/kept.whp")).expect("a copy");
    let resumed = rod(at, &["--stop", "2", "--out", "bare", "--resume", "alone/kept.whp"]);
    assert_well(&resumed);
    assert!(resumed.err.contains("note: the ledger begins at t = "), "{}", resumed.err);
    assert!(resumed.err.contains("there is no alone/ledger.csv\n"), "{}", resumed.err);
    let ledgers = [&plain, &at.join("bare")]
        .map(|folder| fs::read_to_string(folder.join("ledger.csv")).expect("a ledger"));
    assert!(ledgers[1].lines().count() < ledgers[0].lines().count());
}

/// Ctrl-C does the same; a second one is not needed.
#[cfg(unix)]
#[test]
fn interrupt_leaves_a_run_that_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let args = [&short_rod()[..], &PLAIN, &["--out", "out"]].concat();
    let mut child = whipple(&args)
        .current_dir(at)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the program starts");
    // The ledger appears with the first state.
    while !at.join("out/ledger.csv").exists() && child.try_wait().expect("a child").is_none() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let id = child.id().to_string();
    let sent = std::process::Command::new("kill").args(["-INT", &id]).status().expect("kill");
    assert!(sent.success());
    let stopped = Said::from(child.wait_with_output().expect("it ends"));
    assert_eq!(stopped.code, Some(130), "{}", stopped.err);
    let kept = "note: interrupted; the state is kept in out/checkpoint-000001.whp; continue with\n";
    assert!(stopped.err.contains(kept) && !stopped.err.contains("error"), "{}", stopped.err);
    let checkpoint = at.join("out/checkpoint-000001.whp");
    let time = Reader::open_any(&checkpoint).expect("a checkpoint").meta().time;
    assert!(0.0 < time && time < 100.0, "{time}");
    // The rest is left out: a few microseconds after the checkpoint are enough.
    let stop = (time + 2.0).ceil().to_string();
    let run = |more: &[&str]| {
        assert_well(&rod(at, &[&["--stop", &stop][..], more].concat()));
    };
    run(&["--out", "out", "--resume", "out/checkpoint-000001.whp"]);
    run(&["--out", "whole"]);
    assert_same_run(&at.join("whole"), &at.join("out"));
}

/// After a numerical failure the last good state is there, and named.
#[test]
fn failure_leaves_the_last_good_state() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    assert_well(&rod(at, &["--stop", "2", "--out", "out"]));
    // A particle so fast that the square of its speed is no number.
    let of = key("long-rod", Preset::Default, 5).variant(PLAIN[1]);
    let scene = cut_short(scene_of(case("long-rod"), &of).expect("a scene"));
    let scene = scene.space().expect("a scene in space");
    let halted = load(&at.join("out/checkpoint-000001.whp"), scene).expect("a checkpoint");
    let Halted { mut simulation, measured } = halted;
    let mut sections = simulation.sections();
    for section in sections.iter_mut().filter(|section| section.name == "state.vx") {
        let Values::F64(column) = &mut section.values else { panic!("numbers") };
        column[0] = 1e200;
    }
    simulation.restore(&sections).expect("sections of its own");
    fs::create_dir(at.join("bad")).expect("a folder");
    save(&at.join("bad"), (scene, ""), &simulation, &measured).expect("a checkpoint");
    let args = ["--stop", "20", "--out", "bad"];
    let failed = rod(at, &[&args[..], &["--resume", "bad/checkpoint-000001.whp"]].concat());
    assert_eq!(failed.code, Some(3), "{}", failed.err);
    let (_, path) =
        failed.err.trim_end().split_once("last good state is kept in ").expect("a name");
    let reader = Reader::open_any(&at.join(path)).expect("a checkpoint");
    assert!(reader.meta().step > 0);
    let told = "before that step particle 0, of `rod`, was at (";
    assert!(failed.err.contains(told), "{}", failed.err);
    assert!(failed.err.contains("likely cause: it is "), "{}", failed.err);
    let near = names(&at.join("bad/failure"));
    assert_eq!(near, ["near-elements-000000.vtu", "near-particles-000000.vtu", "near.pvd"]);
    // The run goes on from there, to the same end.
    let again = rod(at, &[&args[..], &["--resume", path]].concat());
    assert_eq!(again.code, Some(3));
    let first = |said: &Said| errors(said).split(';').next().map(str::to_owned);
    assert_eq!(first(&again), first(&failed));
}

/// A run that ended between two looks goes on to a later end, without its last look.
#[test]
fn finished_run_goes_on_from_any_end() {
    let folder = tempfile::tempdir().expect("a folder");
    assert_well(&rod(folder.path(), &["--stop", "1.5", "--out", "out"]));
    let rest = ["--stop", "3", "--out", "out", "--resume", "out/checkpoint-000001.whp"];
    assert_well(&rod(folder.path(), &rest));
    let times = &record(&folder.path().join("out"))["history"]["time"];
    assert_eq!(*times, serde_json::json!([0.0, 1.0, 2.0, 3.0]));
}

/// A checkpoint whose looks are not those that the case takes is refused.
#[test]
fn other_looks_are_refused() {
    let key = key("long-rod", Preset::Default, 5).variant(PLAIN[1]);
    let case = case("long-rod");
    let scene = cut_short(scene_of(case, &key).expect("a scene"));
    let solid = scene.space().expect("a scene in space");
    for (times, wanted) in [
        (&[0.0, 0.7][..], "a look at 0.7, wanted a look at 1.0"),
        (&[0.0], "no more looks, wanted a look at 1.0"),
        (&[0.0, 1.0, 1.2], "a look at 1.2, wanted no look at this time"),
    ] {
        let mut simulation = Simulation::new(solid).expect("a valid scene");
        simulation.advance_to(1.5).expect("it runs");
        let look = |&time: &f64| Look { time, values: vec![0.0; 13] };
        let looks = times.iter().map(look).collect();
        let measured = Measured { looks, ..Measured::default() };
        let options =
            SpaceOptions { from: Some(Halted { simulation, measured }), ..SpaceOptions::default() };
        let (scene, command) = (Some(scene.clone()), String::new());
        let request = Request { key: key.clone(), scene, threads: 1, command };
        let refused = run_with(case, request, options, &Silent).err().expect("other looks");
        assert_eq!(refused.to_string(), format!("section `measured.times`: {wanted}"));
    }
}

/// A case that looks at parts of its whole time cannot go on to another end, which is said as such.
#[test]
fn another_end_has_other_looks() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |args: &[&str]| {
        said(folder.path(), &[&["run", "taylor-copper", "--out", "out"], args].concat())
    };
    assert_well(&run(&["--stop", "0.5"]));
    let refused = run(&["--stop", "1", "--resume", "out/checkpoint-000001.whp"]);
    let err = errors(&refused);
    assert_eq!(refused.code, Some(2), "{err}");
    let begin =
        "error: --resume out/checkpoint-000001.whp: its run measured at other times than this one";
    assert!(err.starts_with(begin), "{err}");
    assert!(err.ends_with("give the --stop of the run that wrote it"), "{err}");
}

/// What is said to checkpoints and options that a run cannot use; nothing is written then.
#[test]
fn runs_that_cannot_go_on_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    assert_well(&rod(at, &["--stop", "2", "--out", "out"]));
    let file = fs::read(at.join("out/checkpoint-000001.whp")).expect("a checkpoint");
    let mut altered = file.clone();
    altered[file.len() - 1] ^= 4;
    for folder in [".", "out"] {
        fs::write(at.join(folder).join("altered.whp"), &altered).expect("a file");
    }
    fs::write(at.join("cut.whp"), &file[..file.len() - 1]).expect("a file");
    fs::write(at.join("text.whp"), "state").expect("a file");
    fs::write(at.join("whole.whp"), file).expect("a file");
    let mut text = String::new();
    let short = [&short_rod()[..], &PLAIN].concat();
    for (case, args) in [
        (short.as_slice(), &["--out", "new", "--resume", "cut.whp"][..]),
        (&short, &["--out", "new", "--resume", "altered.whp"]),
        (&short, &["--out", "new", "--resume", "text.whp"]),
        (&short, &["--out", "new", "--resume", "none.whp"]),
        (&short, &["--out", "new", "--resume", "out"]),
        (&short, &["--out", "new", "--resume", "out/altered.whp"]),
        (&short, &["--out", "new", "--resume", "whole.whp", "--stop", "1"]),
        (&["run", "long-rod"], &["--out", "new", "--resume", "whole.whp"]),
        (&["run", "planar-impact"], &["--out", "new", "--resume", "whole.whp"]),
        (&["run", "noh"], &["--out", "new", "--resume", "whole.whp"]),
        (&["run", "noh"], &["--out", "new", "--vtu", "0.1"]),
        (&["run", "noh"], &["--out", "new", "--max-wall", "1min"]),
        (&["run", "noh"], &["--out", "new", "--stop", "1us"]),
        (&["run", "long-rod"], &["--out", "new", "--vtu", "0us"]),
        (&["run", "long-rod"], &["--out", "new", "--vtu", "5 parsecs"]),
        (&["run", "long-rod"], &["--out", "new", "--max-wall", "30"]),
        (&["run", "long-rod"], &["--out", "new", "--max-wall", "0s"]),
        (&["run", "long-rod"], &["--vtu", "5us"]),
        (&["run", "long-rod"], &["--max-wall", "1min"]),
        (&["run", "long-rod"], &["--checkpoint", "1min"]),
        (&["run", "long-rod"], &["--godunov", "--resume", "whole.whp"]),
    ] {
        let said = said(at, &[case, args].concat());
        let err = errors(&said);
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{args:?}: {err}");
        assert_eq!(err.matches("error:").count(), 1, "{err}");
        // Hashes are those of scenes and times, which may change; so may the size of a time.
        let plain = |word: &str| {
            let bare = word.trim_end_matches([',', ';']);
            let hash = bare.len() == 12 && bare.chars().all(|c| c.is_ascii_hexdigit());
            if hash { word.replace(bare, "HASH") } else { word.to_owned() }
        };
        let line = |line: &str| line.split(' ').map(plain).collect::<Vec<_>>().join(" ");
        let mut lines: Vec<String> = err.lines().map(line).collect();
        if let Some((head, tail)) = lines[0].split_once(" bytes; ") {
            let (head, _) = head.rsplit_once(' ').expect("a number of bytes");
            lines[0] = format!("{head} SOME bytes; {tail}");
        }
        let case = if case == short { "run SHORT-ROD".into() } else { case.join(" ") };
        text += &format!("$ whipple {case} {}\n{}\n\n", args.join(" "), lines.join("\n"));
    }
    assert!(!at.join("new").exists(), "nothing is written");
    insta::assert_snapshot!(text);
}
