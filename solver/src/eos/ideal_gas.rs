//! The ideal gas, Eq. (80).

use super::Eos;
use crate::method::SoundSpeed;
use crate::scene::EosData;

/// Eq. (80): `P = (gamma - 1) rho (u - u_o)`, `theta = theta_o + (u - u_o) / c_v`.
///
/// The offset `theta_o` of Table 1 is added, which the printed equation lacks (gap G18).
#[derive(Debug, Clone, Copy)]
pub struct IdealGas {
    adiabatic_index: f64,
    c_v: f64,
    u_0: f64,
    theta_0: f64,
    /// Internal energy at which the sound speed vanishes.
    u_still: f64,
    /// Internal energy of a constant sound speed, in place of the current one.
    u_constant: Option<f64>,
}

impl Eos for IdealGas {
    fn new(_rho_0: f64, data: &EosData, sound_speed: SoundSpeed) -> Option<Self> {
        let &EosData::IdealGas { adiabatic_index, c_v, u_0, theta_0 } = data else {
            return None;
        };
        let u_still = match sound_speed {
            SoundSpeed::Total => 0.0,
            SoundSpeed::Thermodynamic | SoundSpeed::Reference => u_0,
        };
        let u_constant = (sound_speed == SoundSpeed::Reference).then_some(u_0);
        Some(Self { adiabatic_index, c_v, u_0, theta_0, u_still, u_constant })
    }

    #[inline(always)]
    fn pressure(&self, rho: f64, u: f64) -> f64 {
        (self.adiabatic_index - 1.0) * rho * (u - self.u_0)
    }

    #[inline(always)]
    fn temperature(&self, u: f64) -> f64 {
        self.theta_0 + (u - self.u_0) / self.c_v
    }

    /// `sqrt(gamma (gamma - 1) (u - u_still))`. Round-off in cold gas may put `u` below by its last
    /// digit; anything larger is caught by the audit.
    #[inline(always)]
    fn sound_speed(&self, u: f64) -> f64 {
        let thermal = self.u_constant.unwrap_or((u - self.u_still).max(0.0));
        (self.adiabatic_index * (self.adiabatic_index - 1.0) * thermal).sqrt()
    }

    #[inline(always)]
    fn wave_speed_squared(&self, u: f64) -> f64 {
        self.adiabatic_index * (self.adiabatic_index - 1.0) * (u - self.u_0).max(0.0)
    }

    #[inline(always)]
    fn c_v(&self) -> f64 {
        self.c_v
    }

    /// `(gamma + 1) / 4`: from the strong-shock limit of the Hugoniot.
    #[inline(always)]
    fn shock_slope(&self) -> f64 {
        0.25 * (self.adiabatic_index + 1.0)
    }

    fn bulk(&self) -> f64 {
        0.0
    }

    fn floor(&self) -> f64 {
        self.u_0
    }
}
