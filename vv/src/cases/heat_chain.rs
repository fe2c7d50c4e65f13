//! Heat diffusion along a chain: Eqs. (56)-(57) and nothing else.

use whipple_solver::method::{Conduction, Preset};
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};
use whipple_solver::units::Units;

use super::figures::{over, profiles};
use super::{
    Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, both_presets, conservation,
    default_run, run_of,
};
use crate::exact::heat::CosineMode;
use crate::plots::{Axis, Figure, Layer, Panel, Series as Curve};
use crate::record::{Records, RunKey, Series};
use crate::run::{Driver, Findings, RunError};
use crate::scene::AnyScene;

/// The case.
pub(super) struct HeatChain;

const ID: &str = "heat-chain";
/// `k_o` of Table 1.
const HEAT: f64 = 0.1;
/// Half waves along the chain.
const MODE: u32 = 4;
/// Initial density over the reference density: pairs conduct while `zeta < 1`.
const COMPRESSION: f64 = 1.05;
const AMPLITUDE: f64 = 0.5;
const SIZES: &[usize] = &[16, 32, 64];

/// The mode of a chain of `n` particles: rates are in units of `c / l` with `l` the contact length.
fn mode(n: usize) -> Result<CosineMode, RunError> {
    let exchange = HEAT * n as f64 / COMPRESSION;
    let n = u32::try_from(n).map_err(|e| RunError::Reference(e.to_string()))?;
    Ok(CosineMode::new(n, MODE, exchange)?)
}

impl Case for HeatChain {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Heat along a chain"
    }

    fn about(&self) -> &'static str {
        "A chain of particles at rest, slightly compressed between walls, with a cosine of \
         temperature along it. The artificial conduction of Eqs. (56)-(57) alone acts; on the chain \
         it makes the mode decay at a rate that is known exactly."
    }

    fn source(&self) -> &'static str {
        "eigenvalues of the second difference; references/heat_chain_decay.csv"
    }

    fn default_size(&self) -> usize {
        32
    }

    fn scene(&self, preset: Preset, _: &str, n: usize) -> AnyScene {
        let mut method = preset.method();
        method.conduction = Conduction::Linear;
        method.heat_coeff = HEAT;
        Scene {
            name: ID.into(),
            units: Units::None,
            stop_time: 1.0,
            method,
            boundaries: Boundaries { left: Boundary::Mirror(0.0), right: Boundary::Mirror(1.0) },
            materials: vec![Material {
                name: "solid".into(),
                density: 1.0,
                eos: EosData::Linear { bulk: 1.0, c_v: 1.0, theta_0: 0.0 },
            }],
            bodies: vec![Body {
                material: "solid".into(),
                from: 0.0,
                to: 1.0,
                particles: n,
                layout: Layout::Centres,
                compression: COMPRESSION,
                interface: Interface::Joined,
                velocity: Profile::Uniform(0.0),
                energy: Profile::Cosine { mean: 1.0, amplitude: AMPLITUDE, mode: f64::from(MODE) },
            }],
        }
        .into()
    }

    fn measure(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut Driver<'_>,
    ) -> Result<Findings, RunError> {
        driver.advance_to(scene.stop_time)?;
        let s = driver.solver().snapshot();
        let mode = mode(key.n)?;
        let shape: Vec<f64> = (0u32..).take(key.n).map(|i| mode.shape(i)).collect();
        // Projection on the mode gives its amplitude, and so its rate of decay.
        let norm: f64 = shape.iter().map(|s| s * s).sum();
        let amplitude = s.theta.iter().zip(&shape).map(|(t, s)| t * s).sum::<f64>() / norm;
        let rate = -(amplitude / AMPLITUDE).ln() / s.time;
        let exact = |i: usize| 1.0 + AMPLITUDE * shape[i] * (-mode.discrete_rate() * s.time).exp();
        let worst = (0..key.n).map(|i| (s.theta[i] - exact(i)).abs()).fold(0.0, f64::max);
        let fastest = s.v.iter().fold(0.0_f64, |top, v| top.max(v.abs()));

        let mut findings = Findings::default();
        findings.enter("rate_error", (rate / mode.discrete_rate() - 1.0).abs());
        findings.enter("temperature_linf", worst / AMPLITUDE);
        findings.enter("speed_linf", fastest);
        let mut series = Series::default();
        series.0.insert("x".into(), s.x.clone());
        series.0.insert("temperature".into(), s.theta.clone());
        series.0.insert("temperature_exact".into(), (0..key.n).map(exact).collect());
        findings.profile = Some(series);
        Ok(findings)
    }

    fn runs(&self, _: Level) -> Vec<RunKey> {
        both_presets(ID, SIZES)
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "exact eigenvalue of the chain; what remains is the integrator's O(dt^2)";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let mut out = Vec::new();
        for preset in Preset::ALL {
            out.push(must.claim(
                format!(
                    "rate of decay of mode {MODE}, relative error, n = 32, `{}`",
                    preset.name()
                ),
                Quantity::Norm(run_of(ID, preset, 32), "rate_error"),
                Wanted::AtMost(1e-4),
            ));
        }
        let key = default_run(ID, 32);
        out.extend(conservation(ID, &key).into_iter().take(1));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("rate_error", "error of the rate"),
            ("temperature_linf", "L∞ θ"),
            ("speed_linf", "largest speed"),
        ]
    }

    fn errors(&self) -> &'static [&'static str] {
        &["rate_error", "temperature_linf"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let mut panel = Panel::new("", Axis::linear("x"), Axis::linear("temperature"));
        let runs = Preset::ALL.map(|p| (p.name(), run_of(ID, p, self.default_size())));
        let runs = profiles(records, runs);
        if let Some((_, profile)) = runs.first() {
            let exact = profile.points("x", "temperature_exact");
            panel = panel.with(Layer::exact("exact, chain", exact));
        }
        for (name, points) in over(&runs, "x", "temperature") {
            panel = panel.with(Curve::scatter(name, points));
        }
        let caption = "Fourth mode of an insulated chain of 32 particles at t = 1.";
        vec![Figure::new(ID, caption, vec![panel])]
    }
}
