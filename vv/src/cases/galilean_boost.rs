//! The same collision at rest and in a moving frame: the answer may not know the difference.

use whipple_solver::method::Preset;
use whipple_solver::scene::Scene;

use super::two_stream_noh::streams;
use super::{
    Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, both_presets, conservation,
    default_run, paper_run,
};
use crate::plots::Figure;
use crate::record::{Records, RunKey};
use crate::run::{Driver, Findings, RunError};
use crate::scene::AnyScene;

/// The case.
pub(super) struct GalileanBoost;

const ID: &str = "galilean-boost";
const SIZE: usize = 200;

/// Speed of the frame in units of the streams' speed.
fn boost(variant: &str) -> f64 {
    match variant {
        "boost-1" => 1.0,
        "boost-10" => 10.0,
        _ => 1000.0,
    }
}

fn scene_at(boost: f64, preset: Preset, n: usize) -> Scene {
    match streams(boost) {
        Ok(setup) => setup.scene(ID, preset, n),
        // The streams are constants of this crate; a test builds them.
        Err(error) => unreachable!("{ID}: {error}"),
    }
}

impl Case for GalileanBoost {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Galilean boost"
    }

    fn about(&self) -> &'static str {
        "The two-stream collision in a frame that moves at 1, 10 or 1000 times the streams' speed, \
         compared particle by particle with the same run at rest. The printed heating (60) takes the \
         power of the viscous force in the frame of the observer, so its answer depends on who looks."
    }

    fn source(&self) -> &'static str {
        "invariance; hard case H01; 1D study, section 5"
    }

    fn variants(&self) -> &'static [&'static str] {
        &["", "boost-1", "boost-10"]
    }

    fn default_size(&self) -> usize {
        SIZE
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        scene_at(boost(variant), preset, n).into()
    }

    fn measure(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut Driver<'_>,
    ) -> Result<Findings, RunError> {
        driver.advance_to(scene.stop_time)?;
        let moving = driver.solver().snapshot();

        // The same choices, overrides included, at rest.
        let mut still = scene_at(0.0, Preset::Default, key.n);
        still.method = scene.method;
        let mut at_rest = Driver::new(&still, driver.monitor())?;
        let still = at_rest.sample_at(scene.stop_time)?;

        let boost = boost(&key.variant);
        let travelled = boost * scene.stop_time;
        let apart = |a: &[f64], b: &[f64], shift: f64| {
            a.iter().zip(b).fold(0.0_f64, |worst, (a, b)| worst.max((a - shift - b).abs()))
        };
        let mut findings = Findings::default();
        findings.enter("temperature_difference", apart(&moving.theta, &still.theta, 0.0));
        findings.enter("velocity_difference", apart(&moving.v, &still.v, boost));
        findings.enter("position_difference", apart(&moving.x, &still.x, travelled));
        Ok(findings)
    }

    fn runs(&self, _: Level) -> Vec<RunKey> {
        let of = |v: &&str| both_presets(ID, &[SIZE]).into_iter().map(|k| k.variant(v)).collect();
        self.variants().iter().flat_map(|v: &&str| -> Vec<RunKey> { of(v) }).collect()
    }

    fn claims(&self) -> Vec<Claim> {
        let source = wanted!("equal to 1e-8, which round-off of positions 300 away allows");
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let key = default_run(ID, SIZE);
        let mut out = vec![must.claim(
            "temperatures in a frame at 1000, largest difference, `default`",
            Quantity::Norm(key.clone(), "temperature_difference"),
            Wanted::AtMost(1e-8),
        )];
        let limit = "printed heating (60) depends on the frame";
        let shown = Claims::new(ID, Kind::Stability, Weight::Shown, limit);
        for variant in self.variants() {
            let key = paper_run(ID, SIZE).variant(variant);
            out.push(shown.claim(
                format!("temperatures in a frame at {}, `paper`", boost(variant)),
                Quantity::Norm(key, "temperature_difference"),
                Wanted::AtMost(1e-8),
            ));
        }
        out.extend(conservation(ID, &key));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("temperature_difference", "largest Δθ"),
            ("velocity_difference", "largest Δv"),
            ("position_difference", "largest Δx"),
        ]
    }

    fn figures(&self, _: &Records) -> Vec<Figure> {
        Vec::new()
    }
}
