//! Equations of state, Eq. (22): pressure and temperature from density and internal energy.

mod ideal_gas;
mod linear;

pub use ideal_gas::IdealGas;
pub use linear::Linear;

use crate::method::SoundSpeed;
use crate::scene::EosData;

/// An equation of state `P(rho, u)`, `theta(rho, u)`, Eq. (22), with `u` the internal energy per
/// unit mass, Eq. (23).
pub trait Eos: Copy + Send + Sync + 'static {
    /// Constants of a material, if it has this form of equation of state.
    fn new(rho_0: f64, data: &EosData, sound_speed: SoundSpeed) -> Option<Self>;
    /// Pressure `P`.
    fn pressure(&self, rho: f64, u: f64) -> f64;
    /// Temperature `theta`.
    fn temperature(&self, u: f64) -> f64;
    /// Sound speed `c_s` of viscosity, conduction and time step.
    fn sound_speed(&self, u: f64) -> f64;
    /// Square of the thermodynamic sound speed, whatever [`Self::sound_speed`] reads.
    fn wave_speed_squared(&self, u: f64) -> f64;
    /// Specific heat `c_v`.
    fn c_v(&self) -> f64;
    /// Slope `s` of the shock speed `U_s = c + s [u]`.
    fn shock_slope(&self) -> f64;
    /// Bulk modulus `K` of Eq. (25): the stiffness of a segment in tension.
    fn bulk(&self) -> f64;
    /// Internal energy below which the equation of state means nothing.
    fn floor(&self) -> f64;
}
