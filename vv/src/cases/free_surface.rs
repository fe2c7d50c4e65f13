//! A shock that meets a free surface.

use whipple_solver::method::Preset;
use whipple_solver::space::scene::Scene;
use whipple_solver::units::Units;

use super::figures::{curves, figure, histories, over};
use super::parts::column::{Column, Face};
use super::parts::metals::{ALUMINIUM, COPPER, Metal};
use super::parts::planes::{Planes, mean};
use super::parts::{history, moments, times};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run, paper_run};
use crate::exact::hugoniot::ShockState;
use crate::exact::release::Released;
use crate::plots::{Axis, Figure, Layer, Panel};
use crate::record::{Records, RunKey, Series};
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
        let column = Column { length: LENGTH, cells: n, across: ACROSS };
        // Only constants of this file come here; a test builds every scene.
        let shock = exact(variant).map_or(1.0, |(state, _)| state.shock_speed);
        Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: AFTER * LENGTH / shock,
            method: preset.space(),
            walls: column.walls(),
            materials: vec![metal.material()],
            bodies: vec![column.body(metal.name, 0.5 * LENGTH, -speed)],
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
        let end = Face::at(driver.solver(), LENGTH);
        let planes = Planes::new(driver.solver(), 0, LENGTH);
        let breakout = LENGTH / state.shock_speed;
        let names = ["time", "velocity", "exact"];
        let history = history(driver, times(scene.stop_time, ENTRIES), names, |solver, _| {
            let exact = if solver.time() < breakout { 0.0 } else { 1.0 };
            [solver.time() / breakout, end.velocity(solver, speed) / released.velocity, exact]
        })?;
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
        findings.enter("velocity_error", level - 1.0);
        findings.enter("over_up", level * released.velocity / speed);
        findings.enter("exact_over_up", released.velocity / speed);
        findings.enter("ringing", ringing);
        findings.enter("peak", peak);
        findings.enter("breakout_error", arrival - 1.0);
        findings.enter("density_error", density / released.density - 1.0);
        findings.history = Some(history.series());
        Ok(findings)
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let mut keys: Vec<RunKey> = VARIANTS.map(|v| default_run(ID, SIZES[1]).variant(v)).into();
        if level >= Level::Standard {
            keys.extend([SIZES[0], SIZES[2]].map(|n| default_run(ID, n)));
            keys.push(paper_run(ID, SIZES[1]));
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "release isentrope; tolerance of the study in three dimensions, 0.97 to 1.03";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let aim = Claims { weight: Weight::Aim, source: wanted!(), ..must };
        let mut out = Vec::new();
        for variant in VARIANTS {
            let norm = |name| Quantity::Norm(default_run(ID, SIZES[1]).variant(variant), name);
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
        out.extend(super::conservation_in_space(ID, &default_run(ID, SIZES[1])));
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

    fn errors(&self) -> &'static [&'static str] {
        &["velocity_error", "density_error"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let panel = |runs: &[(String, &Series)]| {
            let axes = ["time / breakout", "velocity / exact"].map(Axis::linear);
            let [time, velocity] = axes;
            let panel = Panel::new("", time.range(0.9, 1.5), velocity);
            let panel = curves(panel, over(runs, "time", "velocity"))?;
            Some(panel.with(Layer::horizontal(1.0, "release isentrope")))
        };
        let speeds = VARIANTS.map(|v| (title(v), default_run(ID, SIZES[1]).variant(v)));
        let sizes = SIZES.map(|n| (format!("{n} cells"), default_run(ID, n)));
        let paper = ("paper, 80 cells".to_owned(), paper_run(ID, SIZES[1]));
        let speeds = panel(&histories(records, speeds));
        let sizes = panel(&histories(records, sizes.into_iter().chain([paper])));
        let caption = "Velocity of the free surface over that of the release isentrope, 80 cells.";
        let mut figures = figure("free-surface-speeds", caption, speeds);
        let caption = "The same for copper at 1 km/s, by the number of cells.";
        figures.extend(figure("free-surface-sizes", caption, sizes));
        figures
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[("time", ""), ("velocity", ""), ("exact", "")]
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }
}
