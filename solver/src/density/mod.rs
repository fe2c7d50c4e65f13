//! The density schemes: all that may differ between a method and its rival.
//!
//! A scheme answers one question: for a contact of particle i with j, at which density does the
//! pressure of i act, and how does that density respond to the separation? Density rate (36) and
//! force (78) both follow from that answer, so that the work done by the force is the work stored
//! by the density: they cannot drift apart.

mod hybrid;
mod kernel;
mod nonholonomic;

pub use hybrid::Hybrid;
pub use kernel::Kernel;
pub use nonholonomic::Nonholonomic;

use crate::chain::{Chain, Contact, Side};
use crate::columns::{Column, Rate};
use crate::counters::Counters;

/// Response of particle i to one contact.
#[derive(Debug, Clone, Copy, Default)]
pub struct Row {
    /// Density at which the pressure of the particle acts in this contact.
    pub rho: f64,
    /// Pair force per unit of the particle's pressure, repulsive: `(m / rho^2) * slope`, with the
    /// multiplier `m P / rho^2` of Eqs. (29), (65), (69).
    pub lever: f64,
    /// `-d rho / d r`: the coefficient of the closing speed in the density rate, Eq. (36).
    pub slope: f64,
}

/// How a particle's density answers to its neighbours. Nothing else may differ between schemes.
pub trait DensityScheme<const D: usize>: Sized + Send + Sync + 'static {
    /// Sweeps over the neighbours that one stage takes: more than one where densities are summed
    /// before the forces, over all neighbours in reach.
    const SWEEPS: u64;
    /// Density per particle: a column, or nothing.
    type Column: Column;
    /// Density rate per particle: a number where the density is integrated, or nothing.
    type Rate: Rate;

    /// Index of the last particle whose density or force particle `i` takes part in; only the
    /// nearest on each side does where this is 0.
    fn extent(&self, i: usize) -> usize;

    /// Response of the particle `side` to a contact, on either side of it.
    fn row(&self, side: &Side, contact: &Contact) -> Row;

    /// Prepares the scheme and the density column for the initial positions.
    fn start(&mut self, chain: &Chain, x: &[f64], column: &mut Self::Column);

    /// Recomputes the densities from the positions, where the scheme works that way.
    fn resum(
        &mut self,
        chain: &Chain,
        x: &[f64],
        column: &mut Self::Column,
        counters: &mut Counters,
    );

    /// Density of particle `i` for output.
    fn report(&self, chain: &Chain, x: &[f64], column: &Self::Column, i: usize) -> f64;
}
