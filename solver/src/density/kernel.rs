//! The rival: density summed over a kernel.

use rayon::prelude::*;

use super::{DensityScheme, Hybrid, Row};
use crate::chain::{Chain, Contact, Side};
use crate::columns::{CHUNK, NoRate};
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

/// Density by an evolving kernel (decision 0003): the compression `chi = rho / rho_o` of particle i
/// is that for which the weights of its neighbours sum up to what they are on the reference lattice,
///
/// `sum_j w(chi_i zeta_ij) = S_i`, the particle itself included,
///
/// with `S_i` the sum over the particle's own body at the start: the density is `rho_o` on the
/// reference lattice, at free surfaces too, and the number of neighbours stays the same whatever the
/// compression. A kernel of fixed reach lets neighbours pair up under a strong shock. Another body
/// does not count: it pushes as in the hybrid scheme, from `zeta = 1` on and not before. The force
/// follows from the same virtual work as Eq. (78). One sweep over all neighbours more than the
/// paper's scheme: what Table 7 measures.
#[derive(Debug)]
pub struct Kernel {
    spline: Spline,
    /// `S_i`, of images too.
    reference: Vec<f64>,
    /// `-sum_j zeta_ij w'(chi_i zeta_ij)`: how the constraint answers to `chi`.
    stiffness: Vec<f64>,
    /// First and last particle in reach of each.
    reach: Vec<[u32; 2]>,
    /// Last particle in reach of each, or that reaches it.
    extent: Vec<u32>,
}

/// Where the constraint of a particle is met, and by whom.
#[derive(Debug, Clone, Copy)]
struct Solved {
    chi: f64,
    stiffness: f64,
    reach: [u32; 2],
    evaluations: u64,
}

impl Kernel {
    /// A kernel that reaches to `chi zeta = support`.
    #[must_use]
    pub fn new(support: f64) -> Self {
        let (reference, stiffness) = (Vec::new(), Vec::new());
        let (reach, extent) = (Vec::new(), Vec::new());
        Self { spline: Spline { support }, reference, stiffness, reach, extent }
    }

    /// Calls `visit` with the contact coordinates of particle `i` in reach at compression `chi`,
    /// and returns the range of those particles.
    #[inline(always)]
    fn neighbours(
        &self,
        chain: &Chain,
        x: &[f64],
        (i, chi): (usize, f64),
        mut visit: impl FnMut(f64),
    ) -> [u32; 2] {
        let limit = self.spline.support / chi;
        // No pair beyond this distance is in reach; nearer ones may be out of it, where sizes differ.
        let range = 0.5 * limit * (chain.length(i) + chain.longest());
        let (mut first, mut last) = (i, i);
        let mut look = |j: usize| {
            let r = (x[j] - x[i]).abs();
            let zeta = 2.0 * r / (chain.length(i) + chain.length(j));
            if zeta < limit {
                visit(zeta);
            }
            r < range
        };
        while last + 1 < x.len() && chain.joined(i, last + 1) && look(last + 1) {
            last += 1;
        }
        while first > 0 && chain.joined(i, first - 1) && look(first - 1) {
            first -= 1;
        }
        [first as u32, last as u32]
    }

    /// Newton's method on the constraint, which falls monotonically with `chi`.
    fn solve(&self, chain: &Chain, x: &[f64], i: usize, guess: f64) -> Solved {
        let wanted = self.reference[i];
        let mut at = Solved { chi: guess, stiffness: 0.0, reach: [i as u32; 2], evaluations: 0 };
        for _ in 0..MOST_ITERATIONS {
            let (chi, mut sum, mut stiffness) = (at.chi, 1.0, 0.0);
            let mut evaluations = 0;
            at.reach = self.neighbours(chain, x, (i, chi), |zeta| {
                sum += self.spline.weight(chi * zeta);
                stiffness -= zeta * self.spline.gradient(chi * zeta);
                evaluations += 1;
            });
            at.stiffness = stiffness;
            at.evaluations += evaluations;
            let excess = sum - wanted;
            if excess.abs() <= TOLERANCE * wanted {
                return at;
            }
            // Far from the answer the step is held to a factor of two.
            at.chi = (chi + excess / stiffness).clamp(0.5 * chi, 2.0 * chi);
        }
        // Not a density: the audit names the particle.
        Solved { chi: f64::NAN, ..at }
    }
}

/// Error of the constraint that is accepted, relative. The energy balance does not depend on it.
const TOLERANCE: f64 = 1e-8;

/// Iterations after which there is no density.
const MOST_ITERATIONS: usize = 60;

impl DensityScheme<1> for Kernel {
    const SWEEPS: u64 = 2;
    type Column = Vec<f64>;
    type Rate = NoRate;

    #[inline(always)]
    fn extent(&self, i: usize) -> usize {
        self.extent[i] as usize
    }

    #[inline(always)]
    fn row(&self, side: &Side, contact: &Contact) -> Row {
        if !contact.joined {
            return Hybrid.row(side, contact);
        }
        let chi = side.rho / side.rho_0;
        let pull = -self.spline.gradient(chi * contact.zeta) / self.stiffness[side.index];
        let slope = side.rho * pull / contact.length;
        Row { rho: side.rho, lever: side.m / (side.rho * side.rho) * slope, slope }
    }

    fn start(&mut self, chain: &Chain, x: &[f64], column: &mut Vec<f64>) {
        let n = x.len();
        self.reference = (0..n)
            .map(|i| {
                let (chi, mut sum) = (chain.compression(i), 1.0);
                self.neighbours(chain, x, (i, chi), |zeta| sum += self.spline.weight(chi * zeta));
                sum
            })
            .collect();
        self.stiffness = vec![0.0; n];
        self.reach = vec![[0; 2]; n];
        self.extent = vec![0; n];
        for (i, rho) in column.iter_mut().enumerate() {
            *rho = chain.compression(i) * chain.rho_0(i);
        }
        self.resum(chain, x, column, &mut Counters::default());
    }

    /// The sweep that the paper's scheme removes.
    fn resum(&mut self, chain: &Chain, x: &[f64], column: &mut Vec<f64>, counters: &mut Counters) {
        let (mut stiffness, mut reach) =
            (std::mem::take(&mut self.stiffness), std::mem::take(&mut self.reach));
        let solve =
            |start: usize, rho: &mut [f64], stiffness: &mut [f64], reach: &mut [[u32; 2]]| {
                let mut evaluations = 0;
                for (k, rho) in rho.iter_mut().enumerate() {
                    let i = start + k;
                    let found = self.solve(chain, x, i, *rho / chain.rho_0(i));
                    *rho = found.chi * chain.rho_0(i);
                    stiffness[k] = found.stiffness;
                    reach[k] = found.reach;
                    evaluations += found.evaluations;
                }
                evaluations
            };
        let evaluations: u64 = if column.len() <= CHUNK {
            solve(0, column, &mut stiffness, &mut reach)
        } else {
            // Whole numbers: their sum is the same in any order.
            column
                .par_chunks_mut(CHUNK)
                .zip(stiffness.par_chunks_mut(CHUNK))
                .zip(reach.par_chunks_mut(CHUNK))
                .enumerate()
                .map(|(c, ((rho, stiffness), reach))| solve(c * CHUNK, rho, stiffness, reach))
                .sum()
        };
        (self.stiffness, self.reach) = (stiffness, reach);

        // A pair acts if either is in the other's reach.
        self.extent.fill(0);
        for (j, &[first, _]) in self.reach.iter().enumerate() {
            let extent = &mut self.extent[first as usize];
            *extent = (*extent).max(j as u32);
        }
        let mut furthest = 0;
        for (extent, &[_, last]) in self.extent.iter_mut().zip(&self.reach) {
            furthest = furthest.max(*extent);
            *extent = furthest.max(last);
        }
        counters.sweeps += 1;
        counters.kernel_evaluations += evaluations;
    }

    /// At the present positions; the column is that of the last sweep.
    fn report(&self, chain: &Chain, x: &[f64], column: &Vec<f64>, i: usize) -> f64 {
        let rho_0 = chain.rho_0(i);
        self.solve(chain, x, i, column[i] / rho_0).chi * rho_0
    }
}
