//! The scheme beyond the paper: density of the segments between neighbours.

use super::{DensityScheme, Row};
use crate::chain::{Chain, Contact, Side};
use crate::columns::NoRate;
use crate::counters::Counters;

/// Every segment between nearest neighbours has its own density, `rho_o / zeta` for the particle at
/// either end, and half of either particle lies in it. No density is stored or integrated, and no
/// kernel is evaluated (decision 0003).
///
/// A density per particle, as in Eq. (32), averages its two segments; a zigzag of the spacing then
/// leaves it unchanged and meets no resistance. A density per segment has no such mode.
#[derive(Debug, Clone, Copy, Default)]
pub struct Hybrid;

impl DensityScheme<1> for Hybrid {
    const SWEEPS: u64 = 1;
    type Column = ();
    type Rate = NoRate;

    #[inline(always)]
    fn extent(&self, _: usize) -> usize {
        0
    }

    #[inline(always)]
    fn row(&self, side: &Side, contact: &Contact) -> Row {
        if !contact.nearest {
            return Row { rho: side.rho_0, ..Row::default() };
        }
        Row {
            rho: side.rho_0 * contact.length / contact.r,
            lever: 0.5 * side.l / contact.length,
            slope: 0.0,
        }
    }

    fn start(&mut self, _: &Chain, _: &[f64], _: &mut ()) {}

    fn resum(&mut self, _: &Chain, _: &[f64], _: &mut (), _: &mut Counters) {}

    /// Mass over the mean length of the particle's segments.
    fn report(&self, chain: &Chain, x: &[f64], _: &(), i: usize) -> f64 {
        let side = chain.side(i, 0.0, 0.0);
        let (sum, count) =
            chain.touching(x, i).fold((0.0, 0.0), |(s, n), zeta| (s + zeta, n + 1.0));
        if count == 0.0 { side.rho_0 } else { side.rho_0 * count / sum }
    }
}
