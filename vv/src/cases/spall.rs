//! Spall of a plate by the flight of another.

use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Failure, Material, Scene};
use whipple_solver::units::Units;

use super::figures::{beside_exact, figure, histories};
use super::parts::column::{Column, Face};
use super::parts::metals::COPPER;
use super::parts::{Columns, moments, motion, times};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run};
use crate::exact::spall::PlateImpact;
use crate::plots::{Axis, Figure, Layer, Panel};
use crate::record::{Records, RunKey};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct Spall;

const ID: &str = "spall";
/// Thickness of flyer and target in cm.
const FLYER: f64 = 1.0;
const TARGET: f64 = 2.0;
/// Speed of the flyer in cm/us: weak, for a theory of sound.
const SPEED: f64 = 0.01;
/// Tensile strength in Mbar: chosen, half of the tension that the pulse would reach. That measured for
/// annealed copper is 0.0133 (`spall_copper` of `references/materials.toml`).
const STRENGTH: f64 = 0.0088;
/// Cells across the column.
const ACROSS: usize = 2;
/// End of the run over the time at which the spall opens.
const AFTER: f64 = 1.8;
/// Entries of the history.
const ENTRIES: usize = 400;
/// Cells through the flyer.
const SIZES: [usize; 3] = [20, 40, 80];
const HOLDS: &str = "holds";
const VARIANTS: [&str; 2] = ["", HOLDS];

fn exact() -> Result<PlateImpact, RunError> {
    let material = [COPPER.density(), COPPER.sound()];
    Ok(PlateImpact::new(material, [FLYER, TARGET], SPEED)?)
}

/// The flyer moves, and the nodes where it meets the target move half as fast.
fn thrown(particle: &Particle) -> [f64; 3] {
    let place = particle.position[0];
    let share = if place.abs() < 1e-6 * FLYER { 0.5 } else { f64::from(u8::from(place < 0.0)) };
    [share * SPEED, 0.0, 0.0]
}

/// Depths below the rear face, before the run, of elements that have failed: the least and the most.
fn opened(simulation: &Simulation, depths: &[f64]) -> Option<[f64; 2]> {
    let failed = simulation.all_elements().zip(depths).filter(|(e, _)| e.failed);
    failed.map(|(_, &depth)| depth).fold(None, |range, depth| {
        let [low, high] = range.unwrap_or([depth; 2]);
        Some([depth.min(low), depth.max(high)])
    })
}

impl Case for Spall {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Spall in plate impact"
    }

    fn about(&self) -> &'static str {
        "A copper plate of 1 cm hits one of 2 cm, without strength in shear, at 100 m/s: releases from \
         both rear faces meet 1 cm below the rear of the target, in tension. As in the acoustic theory, \
         the plates are one bar from the impact on, whose one part moves at the start; that velocity is \
         set in the state, as no scene states it. The tensile strength of 0.88 GPa is chosen, half \
         of the tension that the pulse would reach; measured for annealed copper are 1.33 GPa, three \
         quarters of it, which a front of some cells reaches later. Depth and time are those of \
         the first element that fails. The velocity of the rear face falls from its plateau until the \
         signal of the spall arrives; rho c du / 2 is the strength that a measurement would indicate. All \
         tension of a square pulse comes at once, so that the fall is a spike as wide as the front, which \
         the way to the rear face wears down. The variant `holds` has no limit. n counts the cells \
         through the flyer, two across between mirrors."
    }

    fn source(&self) -> &'static str {
        "acoustic theory of plate impact; the strength is chosen"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        SIZES[1]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let spall = (variant != HOLDS).then_some(STRENGTH);
        let metal =
            Material { failure: Failure { spall, ..Failure::default() }, ..COPPER.material() };
        let length = FLYER + TARGET;
        let cells = (length / FLYER * n as f64).round() as usize;
        let plates = Column { length, cells, across: ACROSS };
        Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: AFTER * length / COPPER.sound(),
            method: preset.space(),
            walls: plates.sides(),
            materials: vec![metal],
            bodies: vec![plates.body(COPPER.name, 0.5 * length - FLYER, 0.0)],
        }
        .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let exact = exact()?;
        driver.prepare(|simulation| motion::start(simulation, thrown))?;
        let solver = driver.solver();
        let depths: Vec<f64> =
            solver.all_elements().map(|e| TARGET - solver.particle(e.centre).position[0]).collect();
        let face = Face::at(solver, TARGET);
        let mut history = Columns::default();
        let mut first = None;
        for time in times(scene.stop_time, ENTRIES) {
            driver.advance_to(time)?;
            let now = driver.look(|solver, _| {
                let [least, most] = opened(solver, &depths).unwrap_or([f64::NAN; 2]);
                let failed = solver.failed().0 as f64;
                vec![solver.time(), face.velocity(solver, 0.0), failed, least, most]
            })?;
            let (time, open) = (now[0], [now[3], now[4]]);
            history.row([
                ("time", time),
                ("velocity", now[1] / SPEED),
                ("holds", exact.sample(TARGET, time)?.velocity / SPEED),
                ("failed", now[2]),
            ]);
            // Not a number while nothing has opened.
            if first.is_none() && open[0].is_finite() {
                first = Some((time, open));
            }
        }
        let (times, velocities) = (history.column("time"), history.column("velocity"));
        let window = |from: f64, to: f64| {
            let all = times.iter().zip(velocities);
            all.filter(move |(t, _)| **t > from && **t < to).map(|(_, v)| *v)
        };
        let (breakout, pulse) = (exact.breakout_time(), exact.pulse_duration());
        let highest = window(breakout, breakout + 0.8 * pulse).fold(0.0, f64::max);
        let plateau: Vec<f64> = window(breakout + 0.3 * pulse, breakout + 0.8 * pulse).collect();
        let (plateau, _) = moments(&plateau);
        let lowest = window(breakout + 0.8 * pulse, breakout + 1.5 * pulse);
        let fall = SPEED * (plateau - lowest.fold(f64::INFINITY, f64::min));
        let [least, most] = first.map_or([f64::NAN; 2], |(_, range)| range);
        let last = opened(driver.solver(), &depths).unwrap_or([f64::NAN; 2]);
        let edge = FLYER / key.n as f64;
        let mut findings = Findings::default();
        findings.enter("plateau", plateau);
        findings.enter("highest", highest);
        findings.enter("pull_back", fall / SPEED);
        findings.enter("failed_elements", driver.solver().failed().0 as f64);
        // A plate that holds opens nowhere.
        if key.variant != HOLDS {
            // Not a number if the run was cut short.
            let indicated = 0.5 * exact.impedance() * fall;
            findings.enter("indicated_over_strength", indicated / STRENGTH);
            // Centroids lie in the middle of cells: halves, to the bit.
            let depth = 0.5 * ((least + most) / edge).round();
            findings.enter("depth_error_cells", depth - exact.spall_depth() / edge);
            findings.enter("opened_cells", (last[1] - last[0]) / edge + 1.0);
            let time = first.map_or(f64::NAN, |(time, _)| time);
            findings.enter("time_error", time / exact.spall_time() - 1.0);
        }
        findings.history = Some(history.series());
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[("time", "µs"), ("velocity", ""), ("holds", ""), ("failed", "")]
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let mut keys: Vec<RunKey> = VARIANTS.map(|v| default_run(ID, SIZES[1]).variant(v)).into();
        keys.push(default_run(ID, SIZES[0]));
        if level >= Level::Standard {
            keys.push(default_run(ID, SIZES[2]));
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "acoustic theory; tolerances of `references/verification_problems.toml`";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let mut out = Vec::new();
        let aim = Claims { weight: Weight::Aim, ..must };
        for n in SIZES {
            let norm = |name| Quantity::Norm(default_run(ID, n), name);
            out.push(must.claim(
                format!("spall plane off that of the theory, in cells, n = {n}"),
                norm("depth_error_cells"),
                Wanted::WithinZero(1.0),
            ));
            out.push(must.claim(
                format!("time at which it opens, error, n = {n}"),
                norm("time_error"),
                Wanted::WithinZero(0.02),
            ));
            out.push(aim.claim(
                format!("strength indicated by the pull-back over that put in, n = {n}"),
                norm("indicated_over_strength"),
                Wanted::Near(1.0, 0.05),
            ));
        }
        let holds = default_run(ID, SIZES[1]).variant(HOLDS);
        out.push(must.claim(
            "fall of the rear face over the speed of the flyer if the plate holds",
            Quantity::Norm(holds, "pull_back"),
            Wanted::Near(1.0, 0.1),
        ));
        out.extend(super::conservation_in_space(ID, &default_run(ID, SIZES[1])));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("plateau", "rear face / speed"),
            ("highest", "highest / speed"),
            ("pull_back", "fall / speed"),
            ("indicated_over_strength", "strength indicated / put in"),
            ("depth_error_cells", "plane off, cells"),
            ("opened_cells", "opened, cells"),
            ("time_error", "error of the time"),
            ("failed_elements", "failed elements"),
        ]
    }

    fn errors(&self) -> &'static [&'static str] {
        &["time_error"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let axes = (Axis::linear("time, µs"), Axis::linear("rear face / speed of the flyer"));
        let runs = SIZES.map(|n| (format!("n = {n}"), default_run(ID, n)));
        let holds = default_run(ID, SIZES[1]).variant(HOLDS);
        let holds = [(format!("holds, n = {}", SIZES[1]), holds)];
        let runs = histories(records, runs.into_iter().chain(holds));
        let Ok(exact) = exact() else { return Vec::new() };
        let field = |t: f64| exact.sample(TARGET, t).map(|state| state.velocity / SPEED);
        let panel = Panel::new("", axes.0, axes.1);
        let name = "acoustic, if it holds";
        let panel = beside_exact(panel, &runs, ["time", "velocity"], name, field);
        let panel = panel.zip(exact.pull_back(STRENGTH).ok()).map(|(panel, fall)| {
            panel.with(Layer::horizontal(1.0 - fall / SPEED, "pull-back of the strength"))
        });
        figure("spall-rear-face", "Velocity of the rear face of the target.", panel)
    }
}
