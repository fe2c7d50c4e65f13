//! The paper's scheme: density integrated from the contact kinematics.

use super::{DensityScheme, Row};
use crate::chain::{Chain, Contact, Side};
use crate::counters::Counters;

/// Eqs. (32)-(36) for a unit cell with `2^D` or `2 D` neighbours, here the chain with two:
///
/// `d rho_i / dt = -(D / N) rho_o W (d zeta / dt) / zeta^(D + 1)`, summed over the neighbours.
///
/// In three dimensions `D / N = 3 / 8`, in one `1 / 2` (decision 0002). Contact `W` of Eq. (35) is
/// met with equality in every uniform state and cannot decide there; along a chain the nearest
/// particle on each side is in contact, always within a body and while `zeta < 1` between bodies
/// (decision 0003). The force has the factor `rho_o^2` that Eq. (78) lacks (decision 0001).
#[derive(Debug, Clone, Copy, Default)]
pub struct Nonholonomic;

impl DensityScheme<1> for Nonholonomic {
    const SWEEPS: u64 = 1;
    type Column = Vec<f64>;
    type Rate = f64;

    #[inline(always)]
    fn extent(&self, _: usize) -> usize {
        0
    }

    #[inline(always)]
    fn row(&self, side: &Side, contact: &Contact) -> Row {
        if !contact.nearest {
            return Row { rho: side.rho, ..Row::default() };
        }
        // The share l / V_o is 1, or 2 for the half particle at the end of a body of nodes, which
        // has one neighbour where the others have two.
        let stretch = 0.5 * side.l * contact.length / (contact.r * contact.r);
        let ratio = side.rho_0 / side.rho;
        Row {
            rho: side.rho,
            lever: ratio * ratio * stretch,
            slope: side.rho_0 * side.rho_0 / side.m * stretch,
        }
    }

    /// Eq. (32) in one dimension, at the initial positions.
    fn start(&mut self, chain: &Chain, x: &[f64], column: &mut Vec<f64>) {
        for (i, rho) in column.iter_mut().enumerate() {
            let side = chain.side(i, 0.0, 0.0);
            let excess: f64 = chain.touching(x, i).map(|zeta| 1.0 / zeta - 1.0).sum();
            let share = 0.5 * side.l * side.rho_0 / side.m;
            *rho = side.rho_0 * (1.0 + share * excess);
        }
    }

    fn resum(&mut self, _: &Chain, _: &[f64], _: &mut Vec<f64>, _: &mut Counters) {}

    fn report(&self, _: &Chain, _: &[f64], column: &Vec<f64>, i: usize) -> f64 {
        column[i]
    }
}
