//! Norms of a state, over the phases of the shock, and fields beside the exact ones.

use super::{GAMMA, STOP, THETA_0};
use crate::exact::noh::Noh as Exact;
use crate::exact::{Gas, Geometry};
use crate::norms::{self, Norm};
use crate::record::Series;
use crate::run::{Findings, RunError};

/// Where the window norm looks: both sides of the shock, away from the wall.
const WINDOW: (f64, f64) = (0.025, 0.175);
/// Where the density of the shocked gas is averaged.
const PLATEAU: (f64, f64) = (0.02, 0.08);
/// Norms at one time.
pub(super) struct Errors {
    velocity: Vec<f64>,
    temperature: Vec<f64>,
}

impl Errors {
    pub(super) fn new(x: &[f64], v: &[f64], theta: &[f64], exact: impl Fn(f64) -> Gas) -> Self {
        let minus = |found: &[f64], of: fn(&Gas) -> f64| {
            found.iter().zip(x).map(|(f, &x)| f - of(&exact(x))).collect()
        };
        // c_v = 1: temperature above that of the cold gas is the exact energy.
        Self { velocity: minus(v, |g| g.velocity), temperature: minus(theta, Gas::energy) }
    }
}

/// Norms at several phases of the shock within a particle spacing.
#[derive(Default)]
pub(super) struct Phases {
    velocity: Vec<f64>,
    temperature: Vec<f64>,
    velocity_l1: Vec<f64>,
    temperature_l1: Vec<f64>,
    velocity_window: Vec<f64>,
    temperature_window: Vec<f64>,
}

impl Phases {
    pub(super) fn add(
        &mut self,
        x: &[f64],
        (lengths, mass): (&[f64], &[f64]),
        errors: &Errors,
    ) -> Result<(), RunError> {
        self.velocity.push(norms::rms(&errors.velocity)?);
        self.temperature.push(norms::rms(&errors.temperature)?);
        self.velocity_l1.push(norms::l1_weighted(&errors.velocity, mass)?);
        self.temperature_l1.push(norms::l1_weighted(&errors.temperature, mass)?);
        self.velocity_window.push(norms::window_l1(x, &errors.velocity, lengths, WINDOW)?);
        self.temperature_window.push(norms::window_l1(x, &errors.temperature, lengths, WINDOW)?);
        Ok(())
    }

    pub(super) fn enter(&self, findings: &mut Findings) -> Result<(), RunError> {
        let averages = [
            ("velocity_rms_phase", Norm::Rms, &self.velocity),
            ("temperature_rms_phase", Norm::Rms, &self.temperature),
            ("velocity_l1_phase", Norm::L1, &self.velocity_l1),
            ("temperature_l1_phase", Norm::L1, &self.temperature_l1),
            ("velocity_l1_window", Norm::L1, &self.velocity_window),
            ("temperature_l1_window", Norm::L1, &self.temperature_window),
        ];
        for (name, norm, values) in averages {
            findings.enter(name, norm.phase_average(values)?);
        }
        Ok(())
    }
}

pub(super) fn exact() -> Result<Exact, RunError> {
    Ok(Exact::new(Geometry::Planar, GAMMA, 1.0, 1.0)?)
}

/// Exact state at `x`; positions behind the wall do not occur.
pub(super) fn state(exact: &Exact, x: f64, t: f64) -> Gas {
    if x < exact.shock_position(t) { exact.behind() } else { exact.ahead() }
}

/// Mean density of the shocked gas, away from wall and front.
pub(super) fn plateau_density(x: &[f64], density: &[f64]) -> f64 {
    let inside = x.iter().zip(density).filter(|(x, _)| PLATEAU.0 < **x && **x < PLATEAU.1);
    let (sum, count) = inside.fold((0.0, 0.0), |(sum, count), (_, rho)| (sum + rho, count + 1.0));
    sum / count
}

/// Norms that need one time only.
pub(super) fn at_stop(errors: &Errors, mass: &[f64]) -> Result<Findings, RunError> {
    let mut findings = Findings::default();
    findings.enter("velocity_rms", norms::rms(&errors.velocity)?);
    findings.enter("temperature_rms", norms::rms(&errors.temperature)?);
    findings.enter("velocity_l1", norms::l1_weighted(&errors.velocity, mass)?);
    findings.enter("temperature_l1", norms::l1_weighted(&errors.temperature, mass)?);
    findings.enter("wall_heating", errors.temperature[0] / 0.5);
    let near = errors.temperature.iter().take(5).fold(0.0_f64, |top, e| top.max(e.abs()));
    findings.enter("wall_heating_linf", near / 0.5);
    Ok(findings)
}

/// Fields beside the exact ones, as in the paper's Figures 1 to 4.
pub(super) fn profile(columns: [(&str, Vec<f64>); 4], x: Vec<f64>, exact: &Exact) -> Series {
    let mut profile = Series::default();
    let of: [fn(&Gas) -> f64; 4] =
        [|g| g.velocity, |g| g.density, |g| g.pressure, |g| THETA_0 + g.energy()];
    for ((name, values), of) in columns.into_iter().zip(of) {
        let wanted = x.iter().map(|&x| of(&state(exact, x, STOP))).collect();
        profile.0.insert(format!("{name}_exact"), wanted);
        profile.0.insert(name.into(), values);
    }
    profile.0.insert("x".into(), x);
    profile
}
