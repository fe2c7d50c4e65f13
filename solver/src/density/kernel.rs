//! The rival: density summed over a kernel.

use super::{DensityScheme, Row};
use crate::chain::{Chain, Contact, Side};
use crate::columns::{NoRate, REACH, Scratch};
use crate::counters::Counters;

/// The cubic spline in the contact coordinate, one at the origin and zero from the support on.
#[derive(Debug, Clone, Copy)]
pub struct Spline {
    /// Contact coordinate from which it is zero.
    pub support: f64,
}

impl Spline {
    /// `w(zeta)`.
    #[inline(always)]
    #[must_use]
    pub fn weight(&self, zeta: f64) -> f64 {
        let q = 2.0 * zeta / self.support;
        if q < 1.0 {
            1.0 - 1.5 * q * q * (1.0 - 0.5 * q)
        } else if q < 2.0 {
            let rest = 2.0 - q;
            0.25 * rest * rest * rest
        } else {
            0.0
        }
    }

    /// `dw / d zeta`.
    #[inline(always)]
    #[must_use]
    pub fn gradient(&self, zeta: f64) -> f64 {
        let scale = 2.0 / self.support;
        let q = scale * zeta;
        if q < 1.0 {
            -scale * q * (3.0 - 2.25 * q)
        } else if q < 2.0 {
            let rest = 2.0 - q;
            -scale * 0.75 * rest * rest
        } else {
            0.0
        }
    }
}

/// Summation density with a cubic spline,
///
/// `rho_i = rho_o sum_j w(zeta_ij) / S_i`, the particle itself included,
///
/// where `S_i` is the same sum over the particle's own body at the start: the density is `rho_o` on
/// the reference lattice, at free surfaces too. The force follows from the same virtual work as
/// Eq. (78). One sweep over all neighbours more than the paper's scheme: what Table 7 measures.
#[derive(Debug)]
pub struct Kernel {
    spline: Spline,
    /// `S_i`, of images too.
    reference: Vec<f64>,
    scratch: Scratch<f64, u64>,
}

impl Kernel {
    /// A kernel that reaches to `zeta = support`.
    #[must_use]
    pub fn new(support: f64) -> Self {
        Self { spline: Spline { support }, reference: Vec::new(), scratch: Scratch::new(0) }
    }
}

impl DensityScheme<1> for Kernel {
    const SWEEPS: u64 = 2;
    type Column = Vec<f64>;
    type Rate = NoRate;

    fn support(&self) -> f64 {
        self.spline.support
    }

    #[inline(always)]
    fn row(&self, side: &Side, contact: &Contact) -> Row {
        let zeta = contact.zeta;
        let slope =
            -side.rho_0 * self.spline.gradient(zeta) / (contact.length * self.reference[side.index]);
        Row { rho: side.rho, lever: side.m / (side.rho * side.rho) * slope, slope }
    }

    fn start(&mut self, chain: &Chain, x: &[f64], column: &mut Vec<f64>) {
        self.reference = (0..x.len())
            .map(|i| {
                let own = |j: &usize| chain.joined(i, *j);
                let left = (0..i).rev().take_while(own);
                let right = (i + 1..x.len()).take_while(own);
                let sum = |j: usize| self.spline.weight(chain.contact_at(x, i.min(j), i.max(j)).zeta);
                let near = |w: &f64| *w > 0.0;
                1.0 + left.map(sum).take_while(near).sum::<f64>()
                    + right.map(sum).take_while(near).sum::<f64>()
            })
            .collect();
        self.scratch = Scratch::new(x.len());
        self.resum(chain, x, column, &mut Counters::default());
    }

    /// The sweep that the paper's scheme removes.
    fn resum(&mut self, chain: &Chain, x: &[f64], column: &mut Vec<f64>, counters: &mut Counters) {
        let Self { scratch, reference, spline } = self;
        let reach = spline.support * chain.longest();
        let evaluations = scratch.over_pairs(column, |bins| {
            let mut evaluations = 0;
            for i in bins.start()..bins.end() {
                bins.add(i, chain.rho_0(i) / reference[i]);
                for j in i + 1..x.len().min(i + REACH) {
                    let r = x[j] - x[i];
                    if r >= reach {
                        break;
                    }
                    let w = spline.weight(2.0 * r / (chain.length(i) + chain.length(j)));
                    bins.add(i, w * chain.rho_0(i) / reference[i]);
                    bins.add(j, w * chain.rho_0(j) / reference[j]);
                    evaluations += 1;
                }
            }
            evaluations
        });
        counters.sweeps += 1;
        counters.kernel_evaluations += evaluations.iter().sum::<u64>();
    }

    fn report(&self, _: &Chain, _: &[f64], column: &Vec<f64>, i: usize) -> f64 {
        column[i]
    }
}
