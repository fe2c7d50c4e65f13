//! An elastic block in free rotation: objectivity, and modes that nothing resists.

use std::f64::consts::TAU;

use whipple_solver::method::Preset;
use whipple_solver::space::scene::{Body, Material, Scene, Shape, Strength};
use whipple_solver::units::Units;

use super::figures::{curves, envelope, figure, histories, over};
use super::parts::metals::COPPER;
use super::parts::{control, history, modes, resting, times};
use super::{
    Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run, named, paper_run,
};
use crate::plots::{Axis, Figure, Panel, Point};
use crate::record::{Records, RunKey};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct SpinningBlock;

const ID: &str = "spinning-block";
/// Edges in cm; it spins about the axis of the shortest.
const SIZE: [f64; 3] = [1.0, 0.8, 0.6];
/// Angular velocity, 1/us: 128 m/s at the corners.
const SPIN: f64 = 0.02;
/// Largest random velocity of the variant, in cm/us.
const NOISE: f64 = 1e-4;
/// Entries of the history: a turn.
const ENTRIES: usize = 64;
const NOISY: &str = "noise";
const VARIANTS: [&str; 4] = ["", NOISY, control::HOURGLASS, control::CENTRING];
const SIZES: [usize; 2] = [10, 20];

/// Largest of the last quarter of values over the largest of the first.
fn growth(values: &[f64]) -> f64 {
    let quarter = values.len() / 4;
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    largest(&values[values.len() - quarter..]) / largest(&values[..quarter])
}

impl Case for SpinningBlock {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Spinning elastic block"
    }

    fn about(&self) -> &'static str {
        "An elastic copper block of 1 by 0.8 by 0.6 cm spins freely about its shortest axis for a \
         turn, 0.02 rad/us. It starts without the strain of its rotation and so breathes. Energy is \
         the change of all that is held, over the initial kinetic energy, the residual of the elements \
         included. Hourglass is the kinetic energy of the four hourglass modes of the corners of every \
         element, checkerboard that of centroids against the mean of their corners, over the initial \
         kinetic energy: both vanish in rotation. Growth is the largest of the last quarter of the \
         turn over the largest of the first. The variant `noise` starts with random velocities of 1 \
         m/s, `hourglass-on` has the drag against hourglass modes that solids without strength have \
         and `centring-on` the motion of centroids against their corners, with 0.05 of the stiffness \
         of a cell. n counts the cells along the longest edge."
    }

    fn source(&self) -> &'static str {
        "invariance; energy by the study in three dimensions"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        SIZES[0]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let metal = Material {
            strength: Some(Strength { shear_modulus: 0.477, flow: None }),
            ..COPPER.material()
        };
        let cells = SIZE.map(|edge| (edge * n as f64).round() as usize);
        let block = Body {
            spin: [0.0, 0.0, SPIN],
            noise: if variant == NOISY { NOISE } else { 0.0 },
            ..resting(COPPER.name, Shape::Box { size: SIZE }, cells, [0.0; 3])
        };
        Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: TAU / SPIN,
            method: control::controlled(preset.space(), variant),
            walls: Vec::new(),
            materials: vec![metal],
            bodies: vec![block],
        }
        .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        _: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let names = ["turn", "energy", "hourglass", "checkerboard", "stored"];
        let times = times(scene.stop_time, ENTRIES).skip(1);
        let history = history(driver, times, names, |solver, balance| {
            let modes = modes::energies(solver);
            let initial = balance.initial.kinetic;
            [
                solver.time() * SPIN / TAU,
                (balance.now.energy() - balance.initial.energy()) / initial,
                modes.hourglass / initial,
                modes.checkerboard / initial,
                (balance.now.shear + balance.now.tension) / initial,
            ]
        })?;
        let largest = |name: &str| history.column(name).iter().map(|v| v.abs()).fold(0.0, f64::max);
        let mut findings = Findings::default();
        findings.enter("energy_error", largest("energy"));
        for name in ["hourglass", "checkerboard"] {
            findings.enter(name, largest(name));
            findings.enter(&format!("{name}_growth"), growth(history.column(name)));
        }
        findings.enter("stored", largest("stored"));
        findings.history = Some(history.series());
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[("turn", ""), ("energy", ""), ("hourglass", ""), ("checkerboard", ""), ("stored", "")]
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let mut keys: Vec<RunKey> = VARIANTS.map(|v| default_run(ID, SIZES[0]).variant(v)).into();
        if level >= Level::Standard {
            keys.push(paper_run(ID, SIZES[0]));
            keys.push(default_run(ID, SIZES[1]));
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let must = Claims::new(ID, Kind::Verification, Weight::Must, wanted!("invariance"));
        let mut out = Vec::new();
        for variant in VARIANTS {
            let name = named(variant, "plain");
            let key = default_run(ID, SIZES[0]).variant(variant);
            out.push(must.claim(
                format!("{name}: change of the energy over the initial kinetic energy"),
                Quantity::Norm(key.clone(), "energy_error"),
                Wanted::AtMost(1e-4),
            ));
            for (norm, text) in
                [("hourglass_growth", "hourglass"), ("checkerboard_growth", "checkerboard")]
            {
                out.push(must.claim(
                    format!("{name}: growth of the {text} energy over a turn"),
                    Quantity::Norm(key.clone(), norm),
                    Wanted::AtMost(1.0),
                ));
            }
            out.extend(super::conservation_in_space(ID, &key));
        }
        let answers = [("stored", "largest elastic energy")];
        out.extend(control::claims(ID, &default_run(ID, SIZES[0]), &answers));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("energy_error", "change of energy"),
            ("hourglass", "hourglass energy"),
            ("hourglass_growth", "its growth"),
            ("checkerboard", "checkerboard energy"),
            ("checkerboard_growth", "its growth"),
            ("stored", "elastic energy"),
        ]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let runs = [
            ("default", default_run(ID, SIZES[0])),
            ("default, n = 20", default_run(ID, SIZES[1])),
            ("default, noise", default_run(ID, SIZES[0]).variant(NOISY)),
            ("paper", paper_run(ID, SIZES[0])),
        ];
        let names = [
            ("energy", "change of energy / initial"),
            ("hourglass", "hourglass energy / initial"),
            ("checkerboard", "checkerboard energy / initial"),
        ];
        let runs = histories(records, runs);
        let title = "largest within ±0.1 turn";
        let panels = names.into_iter().filter_map(|(column, label)| {
            let crests = over(&runs, "turn", column).map(|(name, points)| {
                let sizes: Vec<Point> = points.into_iter().map(|p| (p.0, p.1.abs())).collect();
                (name, envelope(&sizes, ENTRIES / 10))
            });
            curves(Panel::new(title, Axis::linear("turn"), Axis::log(label)), crests)
        });
        let caption = "A turn of the block: size of the change of the energy, and energy in modes that no \
                       strain resists. All swing, so that each line is a running maximum, the largest within a \
                       tenth of a turn to either side: a crest stands as a step a fifth of a turn wide. n = 10 \
                       where none is named.";
        figure("spinning-block-energy", caption, panels)
    }
}
