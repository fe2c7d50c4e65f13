//! `whipple check`: what a scene file makes, without running it; `whipple new`: a scene file to begin with; `whipple schema`:
//! what a scene file may hold, for editors.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use whipple_solver::space::Simulation;
use whipple_solver::space::scene::Scene;
use whipple_solver::units::Dimension;

use super::sizes::expect;
use super::{CheckArgs, Failure, NewArgs, print, say};
use crate::cases::Case;
use crate::files::{ensure_writable_dir, write_atomic};
use crate::memory::{Keeps, Need, bytes_text, peak};
use crate::report::sig;
use crate::scenes::case::FileCase;
use crate::scenes::forecast::{Basis, Forecast};
use crate::scenes::foresight::{FEW, gaps, symmetric, through};
use crate::words::counted;

/// A scene to begin with.
const TEMPLATE: &str = include_str!("template.toml");

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Prints the schema of scene files.
pub(super) fn schema() -> Result<u8, Failure> {
    print(&crate::scenes::schema::text())?;
    Ok(0)
}

/// Says what a scene is.
pub(super) fn check(args: &CheckArgs) -> Result<u8, Failure> {
    let case = FileCase::read(&args.scene).map_err(Failure::usage)?;
    let n = args.n.unwrap_or_else(|| case.default_size());
    let any = case.scene(whipple_solver::method::Preset::Default, "", n);
    any.validate().map_err(Failure::usage)?;
    case.built().notes.iter().for_each(|note| say(&format!("note: {note}")));
    expect(&case, ("--n", n), &any, Keeps::default())?;
    let Some(scene) = any.space() else { return Ok(0) };
    let simulation = Simulation::new(scene).map_err(Failure::usage)?;
    let mut out = String::new();
    if let Some(about) = &case.built().file.about {
        let _ = writeln!(out, "{about}");
    }
    bodies(&mut out, scene, &simulation);
    whole(&mut out, scene, &simulation);
    advice(&mut out, scene, &simulation);
    // A run draws the same: what that takes belongs to its time and its memory.
    let begun = Instant::now();
    let drawn = if case.pictures() > 0 || args.out.is_some() {
        case.preview(&simulation, scene).map_err(Failure::usage)?
    } else {
        Vec::new()
    };
    let drawing = begun.elapsed().as_secs_f64() * case.pictures() as f64;
    if let Some(folder) = &args.out {
        ensure_writable_dir(folder)?;
        for (name, [light, dark]) in drawn {
            write_atomic(&folder.join(format!("{name}.png")), &light)?;
            write_atomic(&folder.join(format!("{name}-dark.png")), &dark)?;
        }
        let _ = writeln!(out, "pictures: {}", folder.display());
    }
    let own = Need::of(&any, Keeps::default()).bytes;
    let kept = Need::of(&any, Keeps { folder: true, ..Keeps::default() }).bytes.saturating_sub(own);
    let program = peak().map_or(own, |peak| peak.max(own)) + kept;
    let [own, program] = [own, program].map(bytes_text);
    let _ = writeln!(out, "memory: {program}, of which the state is {own}");
    pace(&mut out, (&case, n), (scene, drawing), &simulation);
    print(&out)?;
    Ok(0)
}

fn bodies(out: &mut String, scene: &Scene, simulation: &Simulation) {
    let length = scene.units.label(Dimension::Length);
    let holdings = simulation.holdings();
    for (k, body) in scene.bodies.iter().enumerate() {
        let size = simulation.sizes(k).1.map(|edge| sig(edge, 3));
        let particles = simulation.all_particles().filter(|p| p.body == k).count();
        let [a, b, c] = body.cells;
        let _ = writeln!(
            out,
            "{}: {}, {a} x {b} x {c} cells of {} x {} x {} {length}, {particles} particles, mass {} g",
            body.name,
            body.material,
            size[0],
            size[1],
            size[2],
            sig(holdings[k].mass, 4)
        );
    }
}

fn whole(out: &mut String, scene: &Scene, simulation: &Simulation) {
    let now = simulation.balance().initial;
    let units = match scene.units.label(Dimension::Pressure) {
        "Mbar" => ["g", "g cm/µs", "kJ"],
        "psi" => ["lbf s²/in", "lbf s", "in lbf"],
        _ => [""; 3],
    };
    // A gram times (cm/us)^2 is 100 kJ.
    let energy = if units[2] == "kJ" { 100.0 } else { 1.0 };
    let momentum = now.momentum.map(|p| sig(p, 4)).join(", ");
    let [mass_unit, momentum_unit, energy_unit] = units;
    let _ = writeln!(
        out,
        "all: {} particles, {} elements, mass {} {mass_unit}, momentum ({momentum}) {momentum_unit}, kinetic energy {} \
         {energy_unit}, heat {} {energy_unit}",
        simulation.particles(),
        simulation.elements(),
        sig(now.mass, 4),
        sig(energy * now.kinetic, 4),
        sig(energy * now.internal, 4)
    );
}

fn advice(out: &mut String, scene: &Scene, simulation: &Simulation) {
    let length = scene.units.label(Dimension::Length);
    let name = |k: usize| &scene.bodies[k].name;
    let mut near = gaps(simulation, scene.bodies.len());
    near.sort_by(|a, b| a.2.total_cmp(&b.2));
    for &([a, b], axis, gap) in near.iter().take(5) {
        let cell = [a, b].map(|k| simulation.sizes(k).1[0]).into_iter().fold(0.0, f64::max);
        let word = if gap < 0.0 { "overlap by" } else { "gap of" };
        let _ = writeln!(
            out,
            "`{}` and `{}`: {word} {} {length} along {}, {} of a cell",
            name(a),
            name(b),
            sig(gap.abs(), 3),
            AXES[axis],
            sig(gap.abs() / cell, 2)
        );
    }
    for body in &scene.bodies {
        let cells = through(body);
        if cells < FEW {
            let _ = writeln!(
                out,
                "`{}` has {} through its thinnest part: {FEW} are the least that bend, and runs of two sizes show what \
                 that costs",
                body.name,
                counted(cells, ["cell", "cells"])
            );
        }
    }
    let walls: Vec<usize> = scene.walls.iter().map(|wall| wall.axis).collect();
    for axis in symmetric(scene).into_iter().filter(|axis| !walls.contains(axis)) {
        let _ = writeln!(
            out,
            "symmetric in the plane {} = 0: half of it and a mirror there would do",
            AXES[axis]
        );
    }
}

fn pace(
    out: &mut String,
    (case, n): (&FileCase, usize),
    (scene, drawing): (&Scene, f64),
    start: &Simulation,
) {
    let unit = scene.units.label(Dimension::Time);
    let stop = scene.stop_time;
    match Forecast::of(case, n, start, stop) {
        Ok(Forecast { pace, seconds, basis }) => {
            let by = match basis {
                Basis::Itself => "it was run for this".to_owned(),
                Basis::Copy(m, share) => format!(
                    "a copy with {m} through the thinnest part took {} times what its first steps told, and so will this",
                    sig(share, 2)
                ),
                Basis::FirstSteps => "as far as its first steps tell".to_owned(),
            };
            let _ = writeln!(
                out,
                "first step {} {unit}; about {} steps of {} {unit}, {} on one thread of this machine: {by}; {} of that for pictures",
                sig(pace.first, 3),
                sig(stop / pace.step, 2),
                sig(pace.step, 3),
                clock(seconds + drawing),
                clock(drawing)
            );
        }
        Err(error) => {
            let _ = writeln!(out, "its first steps fail: {error}");
        }
    }
}

/// Seconds in words.
fn clock(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{} s", sig(s, 2)),
        s if s < 5400.0 => format!("{} min", sig(s / 60.0, 2)),
        s => format!("{} h", sig(s / 3600.0, 2)),
    }
}

/// Writes a scene to begin with.
pub(super) fn new(args: &NewArgs) -> Result<u8, Failure> {
    let path: &Path = &args.file;
    if path.extension().is_none_or(|end| end != "toml") {
        let message = format!("{} does not end in .toml, as scene files do", path.display());
        return Err(Failure::usage(message));
    }
    if path.exists() {
        return Err(Failure::usage(format!("{} is there already", path.display())));
    }
    write_atomic(path, TEMPLATE.as_bytes())?;
    let path = path.display();
    print(&format!("{path}\nwhipple check {path}\nwhipple run {path} --out out/first\n"))?;
    Ok(0)
}
