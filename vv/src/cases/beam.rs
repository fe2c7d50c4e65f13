//! Bending vibration of a free beam.

use whipple_solver::method::Preset;
use whipple_solver::space::scene::{
    Body, EosData, Failure, GammaLaw, Material, Scene, Shape, Side, Strength,
};
use whipple_solver::units::Units;

use super::figures::{curves, figure, histories, over};
use super::parts::fit::oscillation;
use super::parts::{control, history, mirror, modes, resting, times};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run, paper_run};
use crate::exact::beam::{Beam as Exact, Support};
use crate::plots::{Axis, Figure, Layer, Panel};
use crate::record::{Records, RunKey};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct Beam;

const ID: &str = "beam";
/// Length of the whole beam and side of its section in cm.
const LENGTH: f64 = 5.0;
const SIDE: f64 = 0.5;
/// Steel of `references/beam_frequencies.csv`: Young's modulus in Mbar, Poisson's ratio, density.
const ELASTIC: [f64; 2] = [2.07, 0.29];
const DENSITY: f64 = 7.83;
/// Initial angular velocity of the half beam, 1/us: 1 m/s at its ends.
const SPIN: f64 = 8e-5;
/// Entries of the history in a period, and periods.
const PER_PERIOD: usize = 60;
/// Every so many of them are fitted.
const FITTED: usize = 3;
const PERIODS: f64 = 1.5;
const VARIANTS: [&str; 3] = ["", control::HOURGLASS, control::CENTRING];
/// Cells through the height.
const SIZES: [usize; 3] = [2, 4, 8];

fn exact() -> Result<Exact, RunError> {
    Ok(Exact::new([LENGTH, SIDE], ELASTIC, DENSITY)?)
}

impl Case for Beam {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Bending vibration of a free beam"
    }

    fn about(&self) -> &'static str {
        "A steel beam of 5 cm by 0.5 cm by 0.5 cm with free ends. One half stands on a mirror across \
         its middle and starts to turn about its own centre, 1 m/s at the ends: with its image, that \
         bends the beam in its symmetric modes, without translation. The deflection, projected on the \
         shape of the first mode, is fitted by a damped oscillation over one and a half periods. Decay \
         is in nepers a period. Hourglass is the largest kinetic energy of the hourglass modes over \
         the initial one. `hourglass-on` has the drag against hourglass modes that solids without \
         strength have, `centring-on` the motion of centroids against their corners, with 0.05 of the \
         stiffness of a cell. n counts the cells through the height."
    }

    fn source(&self) -> &'static str {
        "Timoshenko frequency of the free beam, mode 1; `references/beam_frequencies.csv`"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        SIZES[1]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let [young, poisson] = ELASTIC;
        let bulk: f64 = young / (3.0 * (1.0 - 2.0 * poisson));
        let law = GammaLaw::ConstantProduct;
        let (c0, shear_modulus) = ((bulk / DENSITY).sqrt(), young / (2.0 * (1.0 + poisson)));
        let metal = Material {
            name: "steel".into(),
            density: DENSITY,
            eos: EosData::MieGruneisen {
                c0,
                s: 1.33,
                gamma_0: 1.67,
                law,
                c_v: 0.448e-5,
                theta_0: 300.0,
            },
            strength: Some(Strength { shear_modulus, flow: None }),
            failure: Failure::default(),
        };
        let half = 0.5 * LENGTH;
        let along = (half / SIDE * n as f64).round() as usize;
        let shape = Shape::Box { size: [half, SIDE, SIDE] };
        let beam = Body {
            spin: [0.0, 0.0, SPIN],
            ..resting("steel", shape, [along, n, n], [0.5 * half, 0.0, 0.0])
        };
        // Only constants of this file come here; a test builds every scene.
        let frequency = exact().and_then(|beam| Ok(beam.timoshenko_free(1)?)).unwrap_or(1.0);
        Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: PERIODS / frequency,
            method: control::controlled(preset.space(), variant),
            walls: vec![mirror(0, 0.0, Side::Above)],
            materials: vec![metal],
            bodies: vec![beam],
        }
        .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        _: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let beam = exact()?;
        let weights = driver
            .solver()
            .all_particles()
            .map(|p| {
                let place = (0.5 + p.position[0] / LENGTH).min(1.0);
                let shape = Support::FreeFree.shape(1, place)?;
                Ok((p.id, p.mass * shape, p.position[1]))
            })
            .collect::<Result<Vec<(u32, f64, f64)>, RunError>>()?;
        let entries = (PER_PERIOD as f64 * PERIODS) as usize;
        let mass = driver.balance().initial.mass;
        let names = ["time", "deflection", "hourglass", "held", "heat"];
        let times = times(scene.stop_time, entries);
        let history = history(driver, times, names, |solver, balance| {
            let deflection: f64 =
                weights.iter().map(|(i, w, y)| w * (solver.particle(*i).position[1] - y)).sum();
            [
                solver.time(),
                deflection / mass,
                modes::energies(solver).hourglass / balance.initial.kinetic,
                balance.now.energy() / balance.initial.energy(),
                balance.now.internal / balance.initial.kinetic,
            ]
        })?;
        let step = FITTED as f64 * scene.stop_time / entries as f64;
        let fitted: Vec<f64> =
            history.column("deflection").iter().copied().step_by(FITTED).collect();
        let (frequency, decay) = oscillation(&fitted, step);
        let wanted = beam.timoshenko_free(1)?;
        let mut findings = Findings::default();
        // Cycles a microsecond in thousands a second.
        findings.enter("frequency_khz", 1e3 * frequency);
        findings.enter("frequency_error", frequency / wanted - 1.0);
        findings.enter(
            "over_euler_bernoulli",
            frequency / beam.euler_bernoulli(Support::FreeFree, 1)? - 1.0,
        );
        findings.enter("decay", decay / wanted);
        findings
            .enter("hourglass", history.column("hourglass").iter().copied().fold(0.0, f64::max));
        findings.history = Some(history.series());
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[("time", "µs"), ("deflection", "cm"), ("hourglass", ""), ("held", ""), ("heat", "")]
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let mut keys = vec![default_run(ID, SIZES[0]), default_run(ID, SIZES[1])];
        if level >= Level::Standard {
            keys.push(paper_run(ID, SIZES[1]));
            keys.extend(control::runs(&default_run(ID, SIZES[1])));
        }
        if level == Level::Full {
            keys.push(default_run(ID, SIZES[2]));
            keys.extend(control::runs(&default_run(ID, SIZES[2])));
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "Timoshenko; 5 % at 4 cells by `references/verification_problems.toml`";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let aim = Claims { weight: Weight::Aim, ..must };
        let error = |n| Quantity::Norm(default_run(ID, n), "frequency_error");
        let mut out = vec![
            must.claim("frequency, 4 cells, error", error(SIZES[1]), Wanted::WithinZero(0.05)),
            aim.claim("frequency, 8 cells, error", error(SIZES[2]), Wanted::WithinZero(0.01)),
        ];
        for n in [SIZES[1], SIZES[2]] {
            let answers = [("frequency_khz", "frequency")];
            out.extend(control::claims(ID, &default_run(ID, n), &answers));
        }
        out.extend(super::conservation_in_space(ID, &default_run(ID, SIZES[1])));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("frequency_khz", "frequency, kHz"),
            ("frequency_error", "error"),
            ("over_euler_bernoulli", "over Euler-Bernoulli"),
            ("decay", "decay a period"),
            ("hourglass", "hourglass energy"),
        ]
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("frequency_khz", "frequency, kHz")]
    }

    fn errors(&self) -> &'static [&'static str] {
        &["frequency_error"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let Ok(frequency) = exact().and_then(|beam| Ok(beam.timoshenko_free(1)?)) else {
            return Vec::new();
        };
        let defaults = SIZES.map(|n| (format!("default, n = {n}"), default_run(ID, n)));
        let paper = [("paper, n = 4".to_owned(), paper_run(ID, SIZES[1]))];
        let runs = histories(records, defaults.into_iter().chain(paper));
        let scaled = over(&runs, "time", "deflection").map(|(name, points)| {
            (name, points.into_iter().map(|p| (p.0 * frequency, 1e4 * p.1)).collect())
        });
        let axes = (Axis::linear("time × exact frequency"), Axis::linear("deflection, µm"));
        let panel = curves(Panel::new("", axes.0, axes.1), scaled);
        let panel = panel.map(|panel| {
            let rules = [(0.5, "exact half period"), (1.0, "exact period")];
            rules.into_iter().fold(panel, |panel, (at, name)| panel.with(Layer::vertical(at, name)))
        });
        let caption = "Deflection of the beam, projected on the shape of its first mode; it should \
                       vanish at the upright lines.";
        figure("beam-deflection", caption, panel)
    }
}
