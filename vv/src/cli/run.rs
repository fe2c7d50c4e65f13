//! `whipple run`: one case, once.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use whipple_solver::method::Preset;
use whipple_solver::space;
use whipple_solver::units::{Dimension, Units};

use super::progress::{Outlook, Progress};
use super::{Failure, INTERRUPTED, NUMERICAL_FAILURE, RunArgs, print, say};
use crate::cases::{self, Case};
use crate::checkpoint::CheckpointError;
use crate::files::{ensure_writable_dir, write_atomic};
use crate::overrides;
use crate::pictures::{PICTURES, write_photos};
use crate::record::{Outcome, RunKey, RunRecord, Scheme, Series};
use crate::report::sig;
use crate::run::{Request, Run, RunError, SpaceOptions, run_with};
use crate::scene::AnyScene;
use crate::space::checkpoint::{Halted, ResumeError, load};
use crate::space::recorder::Recorder;
use crate::suggest::did_you_mean;
use crate::suite::{command_of, scene_of, write_record};

/// Most threads that a run may ask for.
pub(super) const MAX_THREADS: usize = 1024;

/// What `--json` prints.
#[derive(Serialize)]
struct Summary<'a> {
    case: &'a str,
    variant: &'a str,
    preset: Option<&'static str>,
    density: Option<&'static str>,
    n: usize,
    threads: usize,
    outcome: &'a Outcome,
    steps: u64,
    particle_steps: u64,
    cpu_seconds: f64,
    energy_drift: f64,
    momentum_drift: f64,
    norms: &'a BTreeMap<String, f64>,
    counters: Option<whipple_solver::counters::Counters>,
    limiters: Option<whipple_solver::timestep::Decided>,
    #[serde(flatten)]
    space: Option<SpaceSummary>,
    provenance: &'a crate::record::Provenance,
}

/// What it prints of a run in three dimensions besides.
#[derive(Serialize)]
struct SpaceSummary {
    particles: usize,
    elements: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    residual_length_cm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    residual_velocity_km_s: Option<f64>,
    mass_error: f64,
    geometry_mass_error: f64,
    angular_momentum_drift: f64,
    ledger_residual: f64,
    failed_elements: usize,
    updates_per_cpu_second: f64,
    bytes_per_particle: f64,
}

impl SpaceSummary {
    fn new(record: &RunRecord) -> Option<Self> {
        let space = record.space?;
        let norm = |name: &str| record.norms.get(name).copied();
        Some(Self {
            particles: space.particles,
            elements: space.elements,
            residual_length_cm: norm("residual_length_cm"),
            residual_velocity_km_s: norm("residual_velocity_km_s"),
            mass_error: space.mass_error,
            geometry_mass_error: space.geometry_mass_error,
            angular_momentum_drift: space.angular_momentum_drift,
            ledger_residual: space.ledger_residual,
            failed_elements: space.failed_elements,
            updates_per_cpu_second: space.updates_per_cpu_second,
            bytes_per_particle: space.bytes_per_particle,
        })
    }
}

/// Runs a case as the arguments say.
pub(super) fn run(args: &RunArgs) -> Result<u8, Failure> {
    let case = find(&args.case)?;
    if !case.variants().contains(&args.variant.as_str()) {
        let known: Vec<&str> = case.variants().iter().copied().filter(|v| !v.is_empty()).collect();
        let known = if known.is_empty() { "none".into() } else { known.join(", ") };
        let message = format!("`{}` has no variant `{}`; known: {known}", args.case, args.variant);
        return Err(Failure::usage(message));
    }
    if args.threads == 0 || args.threads > MAX_THREADS {
        let message = format!("--threads {} must be from 1 to {MAX_THREADS}", args.threads);
        return Err(Failure::usage(message));
    }
    let request = request(case, args)?;
    let scene = request.scene.clone();
    let (options, outlook) = match &scene {
        Some(AnyScene::Space(scene)) => options(scene, args)?,
        _ => (only_in_space(args)?, Outlook::default()),
    };
    let unit = scene.as_ref().map_or("", |scene| scene.units().label(Dimension::Time));

    let progress = Progress::new(Outlook { unit, ..outlook });
    progress.start(case.id());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build();
    let pool = pool.map_err(|e| Failure::usage(format!("cannot start threads: {e}")))?;
    let command = request.command.clone();
    let done = pool.install(|| run_with(case, request, options, &progress));
    progress.done();
    let done = match done {
        Err(RunError::Interrupted { checkpoint }) => {
            let why = if progress.is_late() { "--max-wall is over" } else { "interrupted" };
            let space = matches!(scene, Some(AnyScene::Space(_)));
            let next = space.then(|| how_to_go_on(args, &command, checkpoint.as_deref()));
            let message = format!("{why}{}", next.unwrap_or_default());
            return Err(Failure { code: INTERRUPTED, message });
        }
        other => other?,
    };

    if let Some(out) = &args.out {
        write_outputs(out, &done)?;
    }
    print(&if args.json { json(&done.record)? } else { text(case, &done.record) })?;
    match done.failure {
        Some(error) => {
            let kept = done
                .checkpoint
                .map(|path| format!("; the last good state is kept in {}", path.display()));
            let message = format!("{error}{}", kept.unwrap_or_default());
            Err(Failure { code: NUMERICAL_FAILURE, message })
        }
        None => Ok(0),
    }
}

/// Makes the folder for the results of a run along a line; options that such a run has no use for are
/// refused.
fn only_in_space(args: &RunArgs) -> Result<SpaceOptions, Failure> {
    let given = [
        ("--vtu", args.vtu.is_some()),
        ("--resume", args.resume.is_some()),
        ("--max-wall", args.max_wall.is_some()),
        ("--checkpoint", args.checkpoint.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
        let message = format!("{option} needs a case in three dimensions, `{}` is none", args.case);
        return Err(Failure::usage(message));
    }
    if let Some(out) = &args.out {
        ensure_writable_dir(out)?;
    }
    Ok(SpaceOptions::default())
}

/// What a run in three dimensions goes on from and leaves, and what to expect of it. Nothing is written
/// before the checkpoint has been read.
fn options(scene: &space::Scene, args: &RunArgs) -> Result<(SpaceOptions, Outlook), Failure> {
    let every = args.vtu.map(|every| every.in_units("--vtu", scene.units)).transpose()?;
    let from = args.resume.as_deref().map(|path| resume(path, scene)).transpose()?;
    let recorder = match &args.out {
        Some(out) => {
            ensure_writable_dir(out)?;
            let recorder = Recorder::new(out, scene, every, from.as_ref());
            let recorder = recorder.map_err(Failure::usage)?;
            Some(match args.checkpoint {
                Some(every) => recorder.keeping(every),
                None => recorder,
            })
        }
        None => None,
    };
    let done = from.as_ref().map(|halted| &halted.simulation);
    let outlook = Outlook {
        from: done.map_or((0.0, 0), |s| (s.time(), s.counters().particle_steps)),
        max_wall: args.max_wall,
        unit: "",
    };
    let pictures = recorder.is_some();
    Ok((SpaceOptions { from, recorder, pictures }, outlook))
}

/// The run that a checkpoint was written of.
fn resume(path: &Path, scene: &space::Scene) -> Result<Halted, Failure> {
    let refused = |why: String| Failure::usage(format!("--resume {}: {why}", path.display()));
    let halted = load(path, scene).map_err(|error| match error {
        ResumeError::Checkpoint(CheckpointError::Scene { .. }) => refused(format!(
            "{error}; give case, preset, variant, --n, --density and --set as in the run that wrote it"
        )),
        error => refused(error.to_string()),
    })?;
    let (time, stop) = (halted.simulation.time(), scene.stop_time);
    if stop < time {
        return Err(refused(format!(
            "it is of time {time}, wanted --stop {time} or later, not {stop}"
        )));
    }
    Ok(halted)
}

/// Where a run that was stopped stands, and the command that continues it.
fn how_to_go_on(args: &RunArgs, command: &str, checkpoint: Option<&Path>) -> String {
    let (Some(out), Some(checkpoint)) = (&args.out, checkpoint) else {
        return if args.out.is_some() {
            "; no checkpoint: this case reads states that a checkpoint does not keep".into()
        } else {
            "; nothing is kept without --out".into()
        };
    };
    let mut again = command.to_owned();
    if let Some(every) = args.vtu {
        again += &format!(" --vtu {every}");
    }
    if args.threads != 1 {
        again += &format!(" --threads {}", args.threads);
    }
    for (option, time) in [("--max-wall", args.max_wall), ("--checkpoint", args.checkpoint)] {
        if let Some(time) = time {
            let time = humantime::format_duration(time).to_string().replace(' ', "");
            again += &format!(" {option} {time}");
        }
    }
    let [out, checkpoint] = [out, checkpoint].map(|path| path.display());
    format!("; continue with\n  {again} --out {out} --resume {checkpoint}")
}

pub(super) fn find(name: &str) -> Result<&'static dyn Case, Failure> {
    cases::find(name).ok_or_else(|| {
        let known: Vec<&str> = cases::ALL.iter().map(|c| c.id()).collect();
        let hint = did_you_mean(name, known);
        Failure::usage(format!("there is no case `{name}`{hint} (`whipple list` names them all)"))
    })
}

/// Cases by name; all when none is named.
pub(super) fn find_all(names: &[String]) -> Result<Vec<&'static dyn Case>, Failure> {
    if names.is_empty() {
        return Ok(cases::ALL.to_vec());
    }
    names.iter().map(|name| find(name)).collect()
}

fn request(case: &dyn Case, args: &RunArgs) -> Result<Request, Failure> {
    let n = args.n.unwrap_or_else(|| case.default_size());
    let preset = Preset::from(args.preset);
    let scheme = if args.godunov {
        Scheme::Godunov
    } else {
        let density = args.density.map_or(preset.method().density, Into::into);
        Scheme::Particles { preset, density }
    };
    let mut key = RunKey::new(case.id(), scheme, n).variant(&args.variant);
    let plain = scene_of(case, &key);
    let units = plain.as_ref().map_or(Units::None, AnyScene::units);
    let stop = args.stop.map(|time| time.in_units("--stop", units)).transpose()?;
    let scene = plain
        .clone()
        .map(|scene| overrides::apply(scene, &args.sets))
        .transpose()
        .map_err(Failure::usage)?;
    let scene = scene.map(|mut scene| {
        if let Some(time) = stop {
            scene.set_stop_time(time);
        }
        scene
    });
    if let (Some(scene), Some(plain)) = (&scene, &plain) {
        if let AnyScene::Line(scene) = scene {
            key.n = scene.particles();
        }
        if !scene.same_problem(plain) {
            say(
                "note: the problem was changed, the norms still compare with the answer to the case",
            );
        }
        scene.validate().map_err(|error| {
            if error.key.ends_with(".particles") {
                Failure::usage(format!("--n {n} is too small for `{}`: {error}", case.id()))
            } else {
                Failure::usage(error)
            }
        })?;
    }
    let mut command = command_of(&key);
    if let Some(time) = stop {
        command += &format!(" --stop {time}");
    }
    for set in &args.sets {
        command += &format!(" --set {set}");
    }
    Ok(Request { key, scene, threads: args.threads, command })
}

fn json(record: &RunRecord) -> Result<String, Failure> {
    let (preset, density) = match record.key.scheme {
        Scheme::Godunov => (None, None),
        Scheme::Particles { preset, density } => (Some(preset.name()), Some(density.name())),
    };
    let summary = Summary {
        case: &record.key.case,
        variant: &record.key.variant,
        preset,
        density,
        n: record.key.n,
        threads: record.threads,
        outcome: &record.outcome,
        steps: record.steps,
        particle_steps: record.particle_steps,
        cpu_seconds: record.cpu_seconds,
        energy_drift: record.energy_drift,
        momentum_drift: record.momentum_drift,
        norms: &record.norms,
        counters: record.counters,
        limiters: record.limiters,
        space: SpaceSummary::new(record),
        provenance: &record.provenance,
    };
    let text = serde_json::to_string_pretty(&summary).map_err(Failure::usage)?;
    Ok(text + "\n")
}

fn text(case: &dyn Case, record: &RunRecord) -> String {
    let mut out =
        format!("{}: {}, n = {}\n", case.title(), record.key.scheme.label(), record.key.n);
    let mut row = |name: &str, value: String| out += &format!("  {name:<28} {value}\n");
    for (name, value) in &record.norms {
        row(name, sig(*value, 5));
    }
    row("energy drift", sig(record.energy_drift, 2));
    row("momentum drift", sig(record.momentum_drift, 2));
    if let Some(space) = &record.space {
        row("angular momentum drift", sig(space.angular_momentum_drift, 2));
        row("residual of elements", sig(space.ledger_residual, 2));
        row("error of the meshed mass", sig(space.geometry_mass_error, 2));
        row("particles", space.particles.to_string());
        row("elements", space.elements.to_string());
        row("failed elements", space.failed_elements.to_string());
        row("updates per CPU second", sig(space.updates_per_cpu_second, 3));
        row("bytes per particle", sig(space.bytes_per_particle, 3));
    }
    if let Some(floored) = record.counters.map(|c| c.floored).filter(|&floored| floored > 0) {
        row("held at the least density", floored.to_string());
    }
    row("steps", record.steps.to_string());
    row("particle-steps", record.particle_steps.to_string());
    row("CPU seconds", sig(record.cpu_seconds, 3));
    out
}

/// The record, the frozen scene, the fields and the pictures.
fn write_outputs(out: &Path, done: &Run) -> Result<(), Failure> {
    let record = &done.record;
    if let Some(scene) = &record.scene {
        let toml = toml::to_string_pretty(scene).map_err(Failure::usage)?;
        write_atomic(&out.join("scene.toml"), toml.as_bytes())?;
    }
    for (name, series) in [("profile.csv", &record.profile), ("history.csv", &record.history)] {
        if let Some(series) = series {
            write_atomic(&out.join(name), csv(series)?.as_bytes())?;
        }
    }
    if !done.photos.is_empty() {
        write_photos(&out.join(PICTURES), &done.photos)?;
    }
    // Last, so that a record always has its fields beside it.
    Ok(write_record(&out.join("record.json"), record)?)
}

fn csv(series: &Series) -> Result<String, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed = |e: csv::Error| Failure::usage(format!("cannot make a CSV table: {e}"));
    writer.write_record(series.0.keys()).map_err(failed)?;
    let rows = series.0.values().map(Vec::len).max().unwrap_or(0);
    for k in 0..rows {
        let cell = |column: &Vec<f64>| column.get(k).map_or(String::new(), ToString::to_string);
        writer.write_record(series.0.values().map(cell)).map_err(failed)?;
    }
    let bytes = writer.into_inner().map_err(Failure::usage)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
