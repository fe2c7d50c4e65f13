//! `whipple show`: what a run has left in its folder, its last state as a picture and in fragments.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::Serialize;
use whipple_solver::space::Simulation;
use whipple_solver::space::output::{Element, Particle};
use whipple_solver::units::{Dimension, Units};

use super::folder::{RECORD, SCENE};
use super::{Failure, ShowArgs, print};
use crate::after::fragments::{Debris, Fragment};
use crate::after::ledger::Ledger;
use crate::checkpoint::list;
use crate::files::{ensure_writable_dir, write_atomic};
use crate::record::{Outcome, RunRecord};
use crate::report::sig;
use crate::scene::AnyScene;
use crate::scenes::case::state_shot;
use crate::space::checkpoint::load;
use crate::space::picture::shoot;
use crate::space::recorder::LEDGER;
use crate::words::counted;

pub(super) const EXAMPLES: &str = "\
Examples:
  whipple show out/shield
  whipple show out/shield --section y=0 --colour pressure --out out/shield-end
  whipple show out/shield --json";

/// Fragments that the text lists; `fragments.csv` and `--json` have all.
const LISTED: usize = 8;

/// What `--json` prints.
#[derive(Serialize)]
struct Summary<'a> {
    scene: &'a str,
    preset: String,
    outcome: &'a Outcome,
    end: Option<f64>,
    time_unit: &'static str,
    findings: &'a std::collections::BTreeMap<String, f64>,
    energies: Vec<Energies>,
    residual: Option<f64>,
    state: Option<State<'a>>,
}

/// Energies of a body, or of all, in the units of the scene.
#[derive(Serialize)]
struct Energies {
    of: String,
    kinetic: f64,
    internal: f64,
    shear: f64,
    tension: f64,
}

/// The state of a checkpoint.
#[derive(Serialize)]
struct State<'a> {
    checkpoint: String,
    time: f64,
    bodies: Vec<&'a str>,
    #[serde(flatten)]
    debris: &'a Debris,
}

/// The record and the ledger of a run's folder; none of a run along a line has a ledger.
pub(super) fn read(folder: &Path) -> Result<(RunRecord, Option<Ledger>), Failure> {
    let path = folder.join(RECORD);
    if !path.is_file() {
        let message = format!(
            "{} holds no {RECORD}: wanted the --out folder of a run that has ended",
            folder.display()
        );
        return Err(Failure::usage(message));
    }
    let record = RunRecord::read(&path)?;
    let ledger = folder.join(LEDGER);
    let ledger = ledger.exists().then(|| Ledger::read(&ledger)).transpose();
    Ok((record, ledger.map_err(Failure::usage)?))
}

/// Shows a run.
pub(super) fn show(args: &ShowArgs) -> Result<u8, Failure> {
    let (record, ledger) = read(&args.run)?;
    let state = state(args)?;
    let debris = state.as_ref().map(|(simulation, ..)| {
        let particles: Vec<Particle> = simulation.all_particles().collect();
        let elements: Vec<Element> = simulation.all_elements().collect();
        Debris::of(&particles, &elements, simulation.bodies())
    });
    let mut written = Vec::new();
    if let Some(out) = &args.out {
        let (Some((simulation, scene, _)), Some(debris)) = (&state, &debris) else {
            let message = format!("--out needs a checkpoint, {} holds none", args.run.display());
            return Err(Failure::usage(message));
        };
        let shot = state_shot(simulation, scene, args.section.as_ref(), args.colour.shown());
        let [light, dark] =
            shoot(simulation, scene, &shot.map_err(Failure::usage)?).map_err(Failure::usage)?;
        let names: Vec<String> = scene.bodies.iter().map(|body| body.name.clone()).collect();
        let cut = args.section.as_ref().map_or(String::new(), |cut| format!("-{}", cut.label()));
        let stem = format!("state-{}{cut}", args.colour.name());
        let table = debris.csv(&names, scene.units).into_bytes();
        let files = [
            (format!("{stem}.png"), light),
            (format!("{stem}-dark.png"), dark),
            ("fragments.csv".to_owned(), table),
        ];
        written = write_new(out, &files)?;
    } else if args.section.is_some() || args.colour != super::ColourArg::Body {
        let message =
            "--section and --colour say how to draw: add --out DIR, such as --out out/state";
        return Err(Failure::usage(message));
    }
    let text = if args.json {
        json(&record, ledger.as_ref(), state.as_ref(), debris.as_ref())?
    } else {
        let mut text = summary(&record, ledger.as_ref());
        if let (Some(state), Some(debris)) = (&state, &debris) {
            pieces(&mut text, state, debris);
        }
        written.iter().for_each(|path| text += &format!("{}\n", path.display()));
        text
    };
    print(&text)?;
    Ok(0)
}

/// Writes files that are not there yet, or are there with the same bytes: others are not replaced.
pub(super) fn write_new(out: &Path, files: &[(String, Vec<u8>)]) -> Result<Vec<PathBuf>, Failure> {
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| out.join(name)).collect();
    for (path, (_, bytes)) in paths.iter().zip(files) {
        if path.exists() && std::fs::read(path).ok().as_ref() != Some(bytes) {
            return Err(Failure::usage(format!(
                "{} is there already, and is not what this command writes: name another folder with --out, or move \
                 that file away",
                path.display()
            )));
        }
    }
    ensure_writable_dir(out)?;
    for (path, (_, bytes)) in paths.iter().zip(files) {
        write_atomic(path, bytes)?;
    }
    Ok(paths)
}

/// A state with its scene and its file.
type Shown = (Simulation, whipple_solver::space::Scene, PathBuf);

/// The state of the checkpoint that is named, or of the last one of the folder, if there is any.
fn state(args: &ShowArgs) -> Result<Option<Shown>, Failure> {
    let last = || list(&args.run).unwrap_or_default().pop();
    let Some(path) = args.checkpoint.clone().or_else(last) else { return Ok(None) };
    let file = args.run.join(SCENE);
    let read = std::fs::read_to_string(&file)
        .map_err(|error| Failure::usage(format!("cannot read {}: {error}", file.display())))?;
    let scene: AnyScene = toml::from_str(&read).map_err(|error| {
        Failure::usage(format!("{} is not the scene of a run: {}", file.display(), error.message()))
    })?;
    let AnyScene::Space(scene) = scene else { return Ok(None) };
    let halted = load(&path, &scene)
        .map_err(|error| Failure::usage(format!("--checkpoint {}: {error}", path.display())))?;
    Ok(Some((halted.simulation, scene, path)))
}

fn units(record: &RunRecord) -> Units {
    record.scene.as_ref().map_or(Units::None, AnyScene::units)
}

/// Unit of energies in the ledger.
pub(super) fn energy_unit(units: Units) -> &'static str {
    match units {
        Units::None => "",
        Units::InLbfS => "in lbf",
        Units::CmGUsMbar => "Mbar cm³",
    }
}

/// Energies by kind in the last row of a ledger: of all, then of every body.
fn energies(ledger: &Ledger) -> Vec<Energies> {
    let holders = ledger.names().iter().filter_map(|name| name.strip_suffix(".kinetic"));
    let of = |holder: &str| {
        let last = |kind: &str| ledger.last(&format!("{holder}.{kind}"));
        Energies {
            of: holder.to_owned(),
            kinetic: last("kinetic"),
            internal: last("internal"),
            shear: last("shear"),
            tension: last("tension"),
        }
    };
    holders.map(of).collect()
}

fn summary(record: &RunRecord, ledger: Option<&Ledger>) -> String {
    let (key, units) = (&record.key, units(record));
    let time = units.label(Dimension::Time);
    let mut out = format!("{}: {}, n = {}\n", key.case, key.scheme.label(), key.n);
    let end = ledger.map_or(f64::NAN, |ledger| ledger.last("time"));
    let ended = match &record.outcome {
        Outcome::Completed => "came to its end".to_owned(),
        Outcome::Failed { message, .. } => format!("failed: {message}"),
    };
    let _ = match ledger {
        Some(_) => writeln!(out, "{ended}; last state at t = {} {time}", sig(end, 5)),
        None => writeln!(out, "{ended}"),
    };
    for (name, value) in &record.norms {
        let _ = writeln!(out, "  {name:<30} {}", sig(*value, 5));
    }
    if let Some(ledger) = ledger {
        let unit = energy_unit(units);
        let _ = writeln!(out, "energy at the end, {unit}: kinetic, internal, shear, tension");
        for e in energies(ledger) {
            let all = [e.kinetic, e.internal, e.shear, e.tension].map(|x| sig(x, 4)).join(", ");
            let _ = writeln!(out, "  {:<30} {all}", e.of);
        }
        let _ =
            writeln!(out, "  {:<30} {}", "residual of elements", sig(ledger.last("residual"), 3));
    }
    out
}

fn pieces(out: &mut String, (simulation, scene, path): &Shown, debris: &Debris) {
    let [length, velocity, time] =
        [Dimension::Length, Dimension::Velocity, Dimension::Time].map(|d| scene.units.label(d));
    let name = |k: usize| scene.bodies[k].name.as_str();
    let _ = writeln!(
        out,
        "state of {} at t = {} {time}: {}",
        path.display(),
        sig(simulation.time(), 5),
        counted(debris.fragments.len(), ["fragment", "fragments"])
    );
    let line = |f: &Fragment| {
        let speed = f.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        format!(
            "  {}: mass {}, {}, {} {length}, speed {} {velocity}",
            name(f.body),
            sig(f.mass, 4),
            counted(f.particles, ["particle", "particles"]),
            f.size.map(|s| sig(s, 3)).join(" x "),
            sig(speed, 4)
        )
    };
    let mut heaviest: Vec<&Fragment> = debris.fragments.iter().collect();
    heaviest.sort_by(|a, b| b.mass.total_cmp(&a.mass));
    for f in heaviest.iter().take(LISTED) {
        *out += &(line(f) + "\n");
    }
    for (k, (count, mass)) in debris.dust.iter().enumerate().filter(|(_, dust)| dust.0 > 0) {
        let many = counted(*count, ["particle", "particles"]);
        let _ = writeln!(out, "  {}: {many} in no fragment, mass {}", name(k), sig(*mass, 4));
    }
}

fn json(
    record: &RunRecord,
    ledger: Option<&Ledger>,
    state: Option<&Shown>,
    debris: Option<&Debris>,
) -> Result<String, Failure> {
    let state = state.zip(debris).map(|((simulation, scene, path), debris)| State {
        checkpoint: path.display().to_string(),
        time: simulation.time(),
        bodies: scene.bodies.iter().map(|body| body.name.as_str()).collect(),
        debris,
    });
    let summary = Summary {
        scene: &record.key.case,
        preset: record.key.scheme.label(),
        outcome: &record.outcome,
        end: ledger.map(|ledger| ledger.last("time")),
        time_unit: units(record).label(Dimension::Time),
        findings: &record.norms,
        energies: ledger.map(energies).unwrap_or_default(),
        residual: ledger.map(|ledger| ledger.last("residual")),
        state,
    };
    Ok(serde_json::to_string_pretty(&summary).map_err(Failure::usage)? + "\n")
}
