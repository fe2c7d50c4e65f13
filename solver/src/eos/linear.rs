//! The linear isothermal solid, Eq. (83).

use super::Eos;
use crate::method::SoundSpeed;
use crate::scene::EosData;

/// Eq. (83): `P = K (rho / rho_o - 1)`, whatever the temperature `theta_o + u / c_v`.
#[derive(Debug, Clone, Copy)]
pub struct Linear {
    bulk: f64,
    rho_0: f64,
    c_v: f64,
    theta_0: f64,
    sound_speed: f64,
}

impl Eos for Linear {
    fn new(rho_0: f64, data: &EosData, _sound_speed: SoundSpeed) -> Option<Self> {
        let &EosData::Linear { bulk, c_v, theta_0 } = data else {
            return None;
        };
        Some(Self { bulk, rho_0, c_v, theta_0, sound_speed: (bulk / rho_0).sqrt() })
    }

    #[inline(always)]
    fn pressure(&self, rho: f64, _u: f64) -> f64 {
        self.bulk * (rho / self.rho_0 - 1.0)
    }

    #[inline(always)]
    fn temperature(&self, u: f64) -> f64 {
        self.theta_0 + u / self.c_v
    }

    #[inline(always)]
    fn sound_speed(&self, _u: f64) -> f64 {
        self.sound_speed
    }

    #[inline(always)]
    fn wave_speed_squared(&self, _u: f64) -> f64 {
        self.sound_speed * self.sound_speed
    }

    #[inline(always)]
    fn c_v(&self) -> f64 {
        self.c_v
    }

    /// 1/2: half the fundamental derivative, which is 1 for `P` linear in the density.
    #[inline(always)]
    fn shock_slope(&self) -> f64 {
        0.5
    }

    fn bulk(&self) -> f64 {
        self.bulk
    }

    fn floor(&self) -> f64 {
        f64::NEG_INFINITY
    }
}
