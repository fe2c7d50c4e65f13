//! A shock that meets a free surface.

use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::scene::{Body, Scene, Shape, Side};
use whipple_solver::units::Units;

use super::parts::metals::{ALUMINIUM, COPPER, Metal};
use super::parts::planes::{Planes, mean};
use super::parts::{Columns, mirror, moments, resting, sleeve};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight};
use crate::exact::hugoniot::ShockState;
use crate::exact::release::Released;
use crate::plots::{Axis, Figure, Layer, Panel, Series as Curve};
use crate::record::{Records, RunKey, Scheme};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct FreeSurface;

const ID: &str = "free-surface";
/// Length of the column in cm.
const LENGTH: f64 = 4.0;
/// Cells across the column.
const ACROSS: usize = 2;
/// End of the run over the time at which the shock breaks out.
const AFTER: f64 = 1.5;
/// Entries of the history.
const ENTRIES: usize = 300;
/// Beginning of the average of the surface's velocity, and end, over the time of breakout.
const WINDOW: [f64; 2] = [1.2, 1.5];
const SIZES: [usize; 3] = [40, 80, 160];
/// Impact speeds in km/s of metals on themselves; copper at 1 km/s has no name.
const VARIANTS: [&str; 6] = ["", "cu-0.5", "cu-2", "cu-4", "al-1", "al-4"];

/// A metal and half its impact speed in cm/us.
fn shot(variant: &str) -> (&'static Metal, f64) {
    let (metal, speed) = variant.rsplit_once('-').unwrap_or(("cu", "1"));
    let metal = if metal == "al" { &ALUMINIUM } else { &COPPER };
    (metal, 0.05 * speed.parse().unwrap_or(1.0))
}

/// The shock and what it is released to.
fn exact(variant: &str) -> Result<(ShockState, Released), RunError> {
    let (metal, speed) = shot(variant);
    let state = metal.hugoniot()?.at_particle_speed(speed)?;
    Ok((state, metal.gruneisen()?.release(speed, 0.0)?))
}

fn title(variant: &str) -> String {
    let (metal, speed) = shot(variant);
    format!("{}, {} km/s", metal.name, 20.0 * speed)
}

fn default_key(variant: &str, n: usize) -> RunKey {
    RunKey::new(ID, Scheme::preset(Preset::Default), n).variant(variant)
}

/// The nodes of the free end.
fn surface(simulation: &Simulation) -> Vec<u32> {
    let end = simulation.all_particles().map(|p| p.position[0]).fold(f64::NEG_INFINITY, f64::max);
    let on = |x: f64| (x - end).abs() < 1e-6 * LENGTH;
    simulation.all_particles().filter(|p| on(p.position[0])).map(|p| p.id).collect()
}

impl Case for FreeSurface {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Shock at a free surface"
    }

    fn about(&self) -> &'static str {
        "A column of 4 cm without strength hits its mirror image; the shock runs to its free end, which \
         jumps to nearly twice the velocity of the particles, and the release runs back. Velocities are \
         seen from the unshocked column. The surface's is averaged from 1.2 to 1.5 times the time of \
         breakout; the peak is the largest before that. Released density is that of the planes within a \
         quarter of the way of the release, 8 cells off the surface. n counts the cells along the column, \
         two across between mirrors."
    }

    fn source(&self) -> &'static str {
        "release isentrope from the Hugoniot state; constants of `references/materials.toml`"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        SIZES[1]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let (metal, speed) = shot(variant);
        let width = ACROSS as f64 * LENGTH / n as f64;
        let mut walls = sleeve(width);
        walls.push(mirror(0, 0.0, Side::Above));
        let shape = Shape::Box { size: [LENGTH, width, width] };
        let column = Body {
            velocity: [-speed, 0.0, 0.0],
            ..resting(metal.name, shape, [n, ACROSS, ACROSS], [0.5 * LENGTH, 0.0, 0.0])
        };
        // Only constants of this file come here; a test builds every scene.
        let shock = exact(variant).map_or(1.0, |(state, _)| state.shock_speed);
        Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: AFTER * LENGTH / shock,
            method: preset.space(),
            walls,
            materials: vec![metal.material()],
            bodies: vec![column],
        }
        .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let (_, speed) = shot(&key.variant);
        let (state, released) = exact(&key.variant)?;
        let end = surface(driver.solver());
        let planes = Planes::new(driver.solver(), 0, LENGTH);
        let breakout = LENGTH / state.shock_speed;
        let mut history = Columns::default();
        for k in 0..=ENTRIES {
            driver.advance_to(scene.stop_time * k as f64 / ENTRIES as f64)?;
            let now = driver.look(|solver, _| {
                let velocities: Vec<f64> =
                    end.iter().map(|&i| solver.particle(i).velocity[0] + speed).collect();
                let exact = if solver.time() < breakout { 0.0 } else { 1.0 };
                vec![solver.time() / breakout, moments(&velocities).0 / released.velocity, exact]
            })?;
            history.read(&["time", "velocity", "exact"], &now);
        }
        let (times, velocities) = (history.column("time"), history.column("velocity"));
        let all = || times.iter().zip(velocities);
        let late: Vec<f64> =
            all().filter(|(t, _)| **t >= WINDOW[0] && **t <= WINDOW[1]).map(|(_, v)| *v).collect();
        let (level, ringing) = moments(&late);
        let peak = all().filter(|(t, _)| **t < WINDOW[0]).map(|(_, v)| *v).fold(0.0, f64::max);
        let arrival = all().find(|(_, v)| **v >= 0.5).map_or(f64::NAN, |(t, _)| *t);
        let layers = planes.look(driver.solver());
        let margin = 16.0 * planes.spacing;
        // The release has run about as far as the shock would have in the same time.
        let reached = 0.25 * (AFTER - 1.0) * LENGTH;
        let density = mean(&layers, |l| l.density, [margin.min(0.5 * reached), reached]);
        let mut findings = Findings::default();
        let mut enter = |name: &str, value: f64| findings.norms.insert(name.into(), value);
        enter("velocity_error", level - 1.0);
        enter("over_up", level * released.velocity / speed);
        enter("exact_over_up", released.velocity / speed);
        enter("ringing", ringing);
        enter("peak", peak);
        enter("breakout_error", arrival - 1.0);
        enter("density_error", density / released.density - 1.0);
        findings.history = Some(history.series());
        Ok(findings)
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let mut keys: Vec<RunKey> = VARIANTS.map(|v| default_key(v, SIZES[1])).into();
        if level >= Level::Standard {
            keys.extend([SIZES[0], SIZES[2]].map(|n| default_key("", n)));
            keys.push(RunKey::new(ID, Scheme::preset(Preset::Paper), SIZES[1]));
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "release isentrope; tolerance of the study in three dimensions, 0.97 to 1.03";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let aim = Claims { weight: Weight::Aim, source: "issue", ..must };
        let mut out = Vec::new();
        for variant in VARIANTS {
            let norm = |name| Quantity::Norm(default_key(variant, SIZES[1]), name);
            let name = title(variant);
            out.push(must.claim(
                format!("{name}: velocity of the free surface, error"),
                norm("velocity_error"),
                Wanted::WithinZero(0.03),
            ));
            out.push(aim.claim(
                format!("{name}: velocity of the free surface, error"),
                norm("velocity_error"),
                Wanted::WithinZero(0.01),
            ));
            out.push(aim.claim(
                format!("{name}: largest velocity at breakout over the exact one"),
                norm("peak"),
                Wanted::AtMost(1.05),
            ));
        }
        out.extend(super::conservation_in_space(ID, &default_key("", SIZES[1])));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("over_up", "surface / up"),
            ("exact_over_up", "exact / up"),
            ("velocity_error", "error"),
            ("ringing", "ringing, rms"),
            ("peak", "peak / exact"),
            ("breakout_error", "error of the breakout"),
            ("density_error", "error of the density"),
        ]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let axes =
            || (Axis::linear("time / breakout").range(0.9, 1.5), Axis::linear("velocity / exact"));
        let mut by_speed = Panel::new("", axes().0, axes().1);
        let mut by_size = Panel::new("", axes().0, axes().1);
        let mut any = false;
        let points = |key: &RunKey| {
            let history = records.get(key)?.history.as_ref()?;
            Some(history.points("time", "velocity"))
        };
        for variant in VARIANTS {
            if let Some(points) = points(&default_key(variant, SIZES[1])) {
                any = true;
                by_speed = by_speed.with(Curve::line(title(variant), points));
            }
        }
        for n in SIZES {
            if let Some(points) = points(&default_key("", n)) {
                by_size = by_size.with(Curve::line(format!("{n} cells"), points));
            }
        }
        let paper = RunKey::new(ID, Scheme::preset(Preset::Paper), SIZES[1]);
        if let Some(points) = points(&paper) {
            by_size = by_size.with(Curve::line("paper, 80 cells", points));
        }
        if !any {
            return Vec::new();
        }
        let line = || Layer::horizontal(1.0, "release isentrope");
        let figure = |id: &str, caption: &str, panel: Panel| {
            Figure::new(format!("free-surface-{id}"), caption, vec![panel.with(line())])
        };
        let speeds = "Velocity of the free surface over that of the release isentrope, 80 cells.";
        let sizes = "The same for copper at 1 km/s, by the number of cells.";
        vec![figure("speeds", speeds, by_speed), figure("sizes", sizes, by_size)]
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }
}
