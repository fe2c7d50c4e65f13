//! Relations of one wave family, written for waves that move to the right; equation numbers as in
//! the parent module.

use super::Wave;
use crate::exact::Gas;

/// A right-going wave that runs into `gas`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RightWave {
    pub(super) gas: Gas,
    sound_speed: f64,
}

impl RightWave {
    pub(super) fn new(gas: Gas) -> Self {
        Self { gas, sound_speed: gas.sound_speed() }
    }

    fn is_shock(&self, p: f64) -> bool {
        p > self.gas.pressure
    }

    /// `ln(p / p_gas)`, accurate for weak and for strong waves.
    fn log_ratio(&self, p: f64) -> f64 {
        let change = (p - self.gas.pressure) / self.gas.pressure;
        if change.abs() < 0.5 { change.ln_1p() } else { (p / self.gas.pressure).ln() }
    }

    /// Mass flux through a shock with pressure `p` behind it, `rho (D - u)` (Toro 4.20).
    fn mass_flux(&self, p: f64) -> f64 {
        let Gas { density, pressure, gamma, .. } = self.gas;
        (0.5 * density * ((gamma + 1.0) * p + (gamma - 1.0) * pressure)).sqrt()
    }

    /// Velocity behind the wave minus velocity ahead of it, if the pressure behind it is `p`, and
    /// the derivative with respect to `p` (Toro 4.6, 4.7 and 4.37).
    pub(super) fn velocity_change(&self, p: f64) -> (f64, f64) {
        let Gas { density, pressure, gamma, .. } = self.gas;
        if self.is_shock(p) {
            let flux = self.mass_flux(p);
            let change = (p - pressure) / flux;
            (change, (1.0 - 0.25 * (gamma + 1.0) * density * change / flux) / flux)
        } else {
            let exponent = 0.5 * (gamma - 1.0) / gamma;
            let growth = (exponent * self.log_ratio(p)).exp_m1();
            let change = 2.0 * self.sound_speed / (gamma - 1.0) * growth;
            (change, self.sound_speed * (growth + 1.0) / (gamma * p))
        }
    }

    /// State behind the wave, but for its velocity (Toro 4.50 and 4.53).
    pub(super) fn star(&self, p: f64) -> Gas {
        let Gas { density, pressure, gamma, .. } = self.gas;
        let density = if self.is_shock(p) {
            let (strong, weak) = (gamma + 1.0, gamma - 1.0);
            density * (strong * p + weak * pressure) / (weak * p + strong * pressure)
        } else {
            density * (self.log_ratio(p) / gamma).exp()
        };
        Gas { density, pressure: p, ..self.gas }
    }

    /// Velocity `u - 2 c/(gamma - 1)` of the edge of gas that expands into vacuum (Toro 4.76);
    /// `inf` if there is no gas.
    pub(super) fn escape_velocity(&self) -> f64 {
        if self.gas.is_vacuum() {
            f64::INFINITY
        } else {
            self.gas.velocity - 2.0 * self.sound_speed / (self.gas.gamma - 1.0)
        }
    }

    /// The wave behind which the pressure is `p` (zero for vacuum); `None` if there is no gas.
    pub(super) fn wave(&self, p: f64) -> Option<Wave> {
        if self.gas.is_vacuum() {
            return None;
        }
        let Gas { density, velocity, .. } = self.gas;
        Some(if self.is_shock(p) {
            Wave::Shock { speed: velocity + self.mass_flux(p) / density }
        } else if p > 0.0 {
            let star = self.star(p);
            let tail = velocity + self.velocity_change(p).0 + star.sound_speed();
            Wave::Rarefaction { head: velocity + self.sound_speed, tail }
        } else {
            Wave::Rarefaction { head: velocity + self.sound_speed, tail: self.escape_velocity() }
        })
    }

    /// State at `xi`, at or right of the `edge` (velocity of contact or vacuum) where the
    /// pressure is `p`.
    pub(super) fn sample(&self, xi: f64, edge: f64, p: f64) -> Gas {
        match self.wave(p) {
            Some(wave) if xi <= wave.head() => {
                if p > 0.0 && xi <= wave.tail() {
                    Gas { velocity: edge, ..self.star(p) }
                } else {
                    let ahead = self.gas.velocity + self.sound_speed - xi;
                    self.fan(
                        1.0 - (self.gas.gamma - 1.0) / (self.gas.gamma + 1.0) * ahead
                            / self.sound_speed,
                    )
                }
            }
            _ => self.gas,
        }
    }

    /// State inside the rarefaction where the sound speed is `ratio` times that ahead of it, by
    /// the isentropic relations and the invariant `u - 2c/(gamma - 1)` (Toro 4.56 and 4.63).
    fn fan(&self, ratio: f64) -> Gas {
        let Gas { density, velocity, pressure, gamma } = self.gas;
        let ratio = if ratio > 0.0 { ratio } else { 0.0 };
        let power = 2.0 / (gamma - 1.0);
        Gas {
            density: density * ratio.powf(power),
            velocity: velocity - power * self.sound_speed * (1.0 - ratio),
            pressure: pressure * ratio.powf(power * gamma),
            gamma,
        }
    }

    /// `x/t` of the particle with `label/t` given, if the contact has the `star` pressure and
    /// velocity (`None`: vacuum).
    ///
    /// The mass between the contact and the ray `xi` is `rho (xi - u) t`, which for the particle
    /// equals `rho_gas label`. In the fan `xi - u = c`, so `rho c` fixes the sound speed.
    pub(super) fn particle(&self, label: f64, star: Option<(f64, f64)>) -> f64 {
        let Gas { density, velocity, gamma, .. } = self.gas;
        let shock = |p: f64| self.mass_flux(p) / density;
        let front = match star {
            Some((p, _)) if self.is_shock(p) => shock(p),
            _ => self.sound_speed,
        };
        if self.gas.is_vacuum() || label >= front {
            return label + velocity;
        }
        if let Some((p, contact)) = star {
            let behind = self.star(p);
            let limit = if self.is_shock(p) {
                front
            } else {
                behind.density * behind.sound_speed() / density
            };
            if label <= limit {
                return contact + label * density / behind.density;
            }
        }
        let ratio = (label / self.sound_speed).powf((gamma - 1.0) / (gamma + 1.0));
        self.fan(ratio).velocity + ratio * self.sound_speed
    }
}
