//! Runs and processes that the tests share.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::{Arc, LazyLock, Mutex, OnceLock};

use whipple_solver::method::Preset;
use whipple_vv::cases::{Case, find};
use whipple_vv::overrides::apply;
use whipple_vv::record::{Outcome, RunKey, RunRecord, Scheme};
use whipple_vv::run::{Request, Silent, run};
use whipple_vv::scene::AnyScene;
use whipple_vv::suite::{command_of, scene_of};

type Runs = LazyLock<Mutex<BTreeMap<RunKey, Arc<OnceLock<RunRecord>>>>>;

/// Runs so far: a test that needs the run of another waits for it.
static RUNS: Runs = LazyLock::new(Mutex::default);
static BEGINNINGS: Runs = LazyLock::new(Mutex::default);

/// Overrides that cut rod and plate of `long-rod` short: some thousand elements are left.
pub const SHORT_ROD: [&str; 5] = [
    "bodies.0.shape.cylinder.length=1.5",
    "bodies.0.cells=[5,5,15]",
    "bodies.0.centre=[-1.6134,-0.6815,0.0]",
    "bodies.1.shape.box.size=[2.0,0.5,1.0]",
    "bodies.1.cells=[20,5,10]",
];

/// The case of a name that exists.
pub fn case(id: &str) -> &'static dyn Case {
    find(id).expect("a case of that name")
}

/// Key of a preset's own scheme.
pub fn key(id: &str, preset: Preset, n: usize) -> RunKey {
    RunKey::new(id, Scheme::preset(preset), n)
}

/// Record of a run, made once in all tests.
pub fn record(key: &RunKey) -> RunRecord {
    once(&RUNS, key, |scene| scene)
}

/// Cells of a scene in space that is run to its end.
const FEW: usize = 600;

/// Record of a run in space, made once in all tests: of its first tenth where it is long, less of the
/// plates with their many variants, and of a short rod instead of the long one.
pub fn beginning(key: &RunKey) -> RunRecord {
    once(&BEGINNINGS, key, |scene| {
        let mut scene = if key.case == "long-rod" { cut_short(scene) } else { scene };
        let bodies = scene.space().map_or(&[][..], |scene| &scene.bodies);
        if bodies.iter().map(|body| body.cells.iter().product::<usize>()).sum::<usize>() > FEW {
            let part = if key.case.ends_with("-plate") { 0.02 } else { 0.1 };
            scene.set_stop_time(part * scene.stop_time());
        }
        scene
    })
}

/// The scene of `long-rod` with rod and plate cut short.
pub fn cut_short(scene: AnyScene) -> AnyScene {
    apply(scene, &SHORT_ROD.map(str::to_owned)).expect("overrides that fit")
}

fn once(runs: &Runs, key: &RunKey, change: impl FnOnce(AnyScene) -> AnyScene) -> RunRecord {
    let cell = runs.lock().expect("no test panics here").entry(key.clone()).or_default().clone();
    let fresh = || {
        let case = case(&key.case);
        let scene = scene_of(case, key).map(change);
        let request = Request { key: key.clone(), scene, threads: 1, command: command_of(key) };
        run(case, request, &Silent).expect("a record").record
    };
    cell.get_or_init(fresh).clone()
}

/// Record of a run that completes.
pub fn completed(key: &RunKey) -> RunRecord {
    let record = record(key);
    assert_eq!(record.outcome, Outcome::Completed, "{key:?}");
    record
}

/// A norm of a run that completes.
pub fn norm(key: &RunKey, name: &str) -> f64 {
    let record = completed(key);
    *record.norms.get(name).unwrap_or_else(|| panic!("{key:?} has no norm {name}"))
}

/// The program with arguments.
pub fn whipple(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_whipple"));
    // Messages name the program as it was called.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::arg0(&mut command, "whipple");
    command.args(args).env("NO_COLOR", "1").env_remove("CLICOLOR_FORCE").env("COLUMNS", "100");
    command
}

/// What the program printed, and its exit code.
pub struct Said {
    /// Exit code; none after a signal.
    pub code: Option<i32>,
    /// Standard output.
    pub out: String,
    /// Standard error, but for lines of progress: how many there are is up to the machine.
    pub err: String,
}

impl From<Output> for Said {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("text is UTF-8");
        let err = text(output.stderr);
        let lines = err.split_inclusive('\n').filter(|line| !line.contains(" M particle-steps/s"));
        Self { code: output.status.code(), out: text(output.stdout), err: lines.collect() }
    }
}

/// Runs the program in a folder.
pub fn said(folder: &Path, args: &[&str]) -> Said {
    let mut command = whipple(args);
    command.current_dir(folder).output().expect("the program starts").into()
}
