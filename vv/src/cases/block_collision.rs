//! Two elastic blocks collide and part: contact, and nothing that sticks.

use whipple_solver::method::{Conduction, Preset};
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};
use whipple_solver::units::Units;

use super::figures::histories;
use super::{
    Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, both_presets, conservation,
    default_run, run_of,
};
use crate::exact::collision::{Block, collide};
use crate::plots::{Axis, Figure, Layer, Panel, Series as Curve};
use crate::record::{Records, RunKey, Series};
use crate::run::{Driver, Findings, RunError};
use crate::scene::AnyScene;

/// The case.
pub(super) struct BlockCollision;

const ID: &str = "block-collision";
/// Steel of the dossier's gap G24, in cm, g, us, Mbar.
const BULK: f64 = 1.649;
const DENSITY: f64 = 7.87;
const LENGTH: f64 = 1.0;
/// Impact speed over the wave speed.
const MACH: f64 = 1e-3;
/// Gap over the particle spacing at n = 200, and so a fixed length.
const GAP: f64 = 0.005;
/// Stop, in transits of a block after the touch: contact lasts two.
const TRANSITS: f64 = 6.0;
const SIZES: &[usize] = &[100, 200, 400];

fn wave_speed() -> f64 {
    (BULK / DENSITY).sqrt()
}

fn block(velocity: f64) -> Block {
    Block { length: LENGTH, density: DENSITY, wave_speed: wave_speed(), velocity }
}

impl Case for BlockCollision {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Collision of two elastic blocks"
    }

    fn about(&self) -> &'static str {
        "A steel block of 1 cm hits an equal one at rest, at a thousandth of the wave speed, across a \
         small gap. Exactly, the first stops and the second leaves with its speed: bodies touch, \
         push, and part again. What is left as vibration and heat is error."
    }

    fn source(&self) -> &'static str {
        "wave reflections in two rods; 1D study, section 5"
    }

    fn default_size(&self) -> usize {
        200
    }

    fn scene(&self, preset: Preset, _: &str, n: usize) -> AnyScene {
        let mut method = preset.method();
        method.conduction = Conduction::None;
        let speed = MACH * wave_speed();
        let body = |from: f64, particles, velocity| Body {
            material: "steel".into(),
            from,
            to: from + LENGTH,
            particles,
            layout: Layout::Centres,
            compression: 1.0,
            interface: Interface::Contact,
            velocity: Profile::Uniform(velocity),
            energy: Profile::Uniform(0.0),
        };
        Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: GAP / speed + TRANSITS * LENGTH / wave_speed(),
            method,
            boundaries: Boundaries { left: Boundary::Free, right: Boundary::Free },
            materials: vec![Material {
                name: "steel".into(),
                density: DENSITY,
                eos: EosData::Linear { bulk: BULK, c_v: 0.448e-5, theta_0: 300.0 },
            }],
            bodies: vec![body(0.0, n / 2, speed), body(LENGTH + GAP, n - n / 2, 0.0)],
        }
        .into()
    }

    fn measure(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut Driver<'_>,
    ) -> Result<Findings, RunError> {
        let speed = MACH * wave_speed();
        let exact =
            collide(block(speed), block(0.0)).map_err(|e| RunError::Reference(e.to_string()))?;
        let first = key.n / 2;
        let mean = |v: &dyn Fn(usize) -> f64, range: std::ops::Range<usize>| {
            let count = range.len() as f64;
            range.map(v).sum::<f64>() / count / speed
        };
        let (mut time, mut left, mut right) = (Vec::new(), Vec::new(), Vec::new());
        let mut steps = 0_u64;
        driver.observe_to(scene.stop_time, |s| {
            if steps.is_multiple_of(16) {
                time.push(s.time());
                left.push(mean(&|i| s.velocity(i), 0..first));
                right.push(mean(&|i| s.velocity(i), first..key.n));
            }
            steps += 1;
        })?;
        let s = driver.solver().snapshot();
        let (a, b) = (mean(&|i| s.v[i], 0..first), mean(&|i| s.v[i], first..key.n));
        let mut findings = Findings::default();
        findings.enter("left_velocity_error", (a - exact.left_velocity / speed).abs());
        findings.enter("right_velocity_error", (b - exact.right_velocity / speed).abs());
        findings.enter("left_as_vibration_and_heat", 1.0 - a * a - b * b);
        findings.enter("separation", (s.x[first] - s.x[first - 1]) / (LENGTH / first as f64) - 1.0);
        let mut series = Series::default();
        series.0.insert("time".into(), time);
        series.0.insert("left".into(), left);
        series.0.insert("right".into(), right);
        findings.history = Some(series);
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[("time", "µs"), ("left", ""), ("right", "")]
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let sizes = if level == Level::Quick { &SIZES[1..2] } else { SIZES };
        let mut keys = both_presets(ID, sizes);
        keys.push(RunKey::new(ID, super::kernel_default(), self.default_size()));
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let study =
            "1D study, section 5: at most 5.7 % with c_o = 1, 1.8 % with the limited viscosity";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, study);
        let key = default_run(ID, 200);
        let norm = |name| Quantity::Norm(key.clone(), name);
        let mut out = vec![
            must.claim(
                "velocity of the hit block, error over V, n = 200, `default`",
                norm("right_velocity_error"),
                Wanted::AtMost(0.0113),
            ),
            must.claim(
                "kinetic energy left as vibration and heat, n = 200, `default`",
                norm("left_as_vibration_and_heat"),
                Wanted::AtMost(0.018),
            ),
            must.claim(
                "the blocks part: gap at the end over the spacing, n = 200, `default`",
                norm("separation"),
                Wanted::AtLeast(0.0),
            ),
        ];
        out.extend(conservation(ID, &key));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("left_velocity_error", "error of left v / V"),
            ("right_velocity_error", "error of right v / V"),
            ("left_as_vibration_and_heat", "energy lost to vibration"),
            ("separation", "gap / dx"),
        ]
    }

    fn errors(&self) -> &'static [&'static str] {
        &["left_velocity_error", "right_velocity_error", "left_as_vibration_and_heat"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let axes = (Axis::linear("time, µs"), Axis::linear("mean velocity of a block / V"));
        let mut panel = Panel::new("", axes.0, axes.1);
        let runs = Preset::ALL.map(|p| (p.name(), run_of(ID, p, self.default_size())));
        for (preset, history) in histories(records, runs) {
            for (column, which) in [("left", "first"), ("right", "second")] {
                let name = format!("{which}, {preset}");
                panel = panel.with(Curve::line(name, history.points("time", column)));
            }
        }
        panel = panel.with(Layer::horizontal(1.0, "exact, second"));
        panel = panel.with(Layer::horizontal(0.0, "exact, first"));
        let caption = "Two elastic blocks, 100 particles each: mean velocities.";
        vec![Figure::new(ID, caption, vec![panel])]
    }
}
