//! An Eulerian finite-volume code for one ideal gas in one plane dimension: MUSCL-Hancock.
//!
//! Second-order reconstruction of density, velocity and pressure with the monotonized-central
//! limiter, half a time step with the primitive equations, and the HLLC flux with Einfeldt's wave
//! speeds; a cell whose reconstruction is not positive falls back on first order. It serves as a
//! reference that shares nothing with the particle method. Not covered: several gammas, moving
//! boundaries. Gas that runs into vacuum needs a thin background gas, cold gas a tiny pressure.
//!
//! Sources: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, sections 10.4
//! (HLLC) and 14.4 (MUSCL-Hancock); B. van Leer, J. Comput. Phys. 23 (1977) 276 (limiter);
//! B. Einfeldt, SIAM J. Numer. Anal. 25 (1988) 294 (speeds); P. Batten et al., SIAM J. Sci. Comput.
//! 18 (1997) 1553 (positivity).

mod scheme;

use crate::exact::{Gas, InputError, above, at_least, below};
use scheme::{BLOCK, Faces, Row, Scheme, Triple};
use std::fmt;

/// Ghost cells on each side.
const GHOSTS: usize = 2;
/// The first steps, whose waves are not known beforehand, are shortened by [`STARTUP_FACTOR`].
const STARTUP_STEPS: u64 = 5;
/// See [`STARTUP_STEPS`].
const STARTUP_FACTOR: f64 = 0.2;
/// The pressure floor, relative to the lowest initial pressure.
const FLOOR_FRACTION: f64 = 1e-6;

/// Condition at an end of the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Boundary {
    /// A rigid reflecting wall.
    Wall,
    /// Vanishing gradient: waves leave.
    Outflow,
    /// Gas of the given state outside; the Riemann problem decides what enters.
    Inflow(Gas),
}

/// Extent, boundaries and time-step control of a computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Coordinate of the left end.
    pub start: f64,
    /// Coordinate of the right end.
    pub end: f64,
    /// Condition at the left end.
    pub left: Boundary,
    /// Condition at the right end.
    pub right: Boundary,
    /// Courant number, below 1; 0.5 keeps the gas behind strong shocks smooth, 0.8 is faster.
    pub cfl: f64,
}

/// Why a computation cannot start or go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GodunovError {
    /// An argument was refused.
    Input(InputError),
    /// No cells were given.
    NoCells,
    /// A cell or an inflow has another gamma than the first cell.
    MixedGamma {
        /// Gamma of the first cell.
        expected: f64,
        /// The other gamma.
        found: f64,
    },
    /// Density or energy lost its sign or became NaN.
    Breakdown {
        /// The cell, from 0.
        cell: usize,
        /// The time after the failed step.
        time: f64,
    },
    /// The stable time step is too small to change the time.
    Stalled {
        /// The present time.
        time: f64,
    },
}

impl fmt::Display for GodunovError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(error) => error.fmt(f),
            Self::NoCells => f.write_str("no cells"),
            Self::MixedGamma { expected, found } => {
                write!(f, "gamma = {found} differs from that of the first cell, {expected}")
            }
            Self::Breakdown { cell, time } => {
                write!(f, "no admissible state in cell {cell} at t = {time:.6e}")
            }
            Self::Stalled { time } => write!(f, "vanishing time step at t = {time:.6e}"),
        }
    }
}

impl std::error::Error for GodunovError {}

impl From<InputError> for GodunovError {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

/// Counts of the work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Time steps.
    pub steps: u64,
    /// Time steps times cells.
    pub cell_steps: u64,
    /// Cell updates in which the pressure had to be raised to the floor (the conserved energy is
    /// left alone).
    pub floored: u64,
}

/// A running computation.
#[derive(Clone, Debug)]
pub struct Godunov {
    domain: Domain,
    scheme: Scheme,
    width: f64,
    /// Density, velocity and pressure, with [`GHOSTS`] on each side.
    primitive: [Vec<f64>; 3],
    /// Densities of mass, momentum and total energy of the cells proper.
    conserved: [Vec<f64>; 3],
    faces: Faces,
    flux: [Row; 3],
    time: f64,
    signal_speed: f64,
    work: Work,
    inflow: Triple,
}

impl Godunov {
    /// A computation on equal cells with the given states, from time zero.
    ///
    /// # Errors
    /// No cells, an empty `domain`, `cfl` outside `(0, 1)`, inadmissible, empty or cold states
    /// (use a tiny pressure), or several gammas.
    pub fn new(domain: Domain, cells: &[Gas]) -> Result<Self, GodunovError> {
        let first = *cells.first().ok_or(GodunovError::NoCells)?;
        let length = above("end - start", domain.end - domain.start, 0.0)?;
        below("cfl", above("cfl", domain.cfl, 0.0)?, 1.0)?;
        let ends = [domain.left, domain.right].into_iter();
        let inflows = ends.filter_map(|end| match end {
            Boundary::Inflow(gas) => Some(gas),
            Boundary::Wall | Boundary::Outflow => None,
        });
        let mut lowest = f64::INFINITY;
        let mut signal_speed = 0.0_f64;
        for gas in cells.iter().copied().chain(inflows) {
            let gas = gas.validated()?;
            above("density", gas.density, 0.0)?;
            lowest = lowest.min(above("pressure", gas.pressure, 0.0)?);
            signal_speed = signal_speed.max(gas.velocity.abs() + gas.sound_speed());
            if gas.gamma != first.gamma {
                return Err(GodunovError::MixedGamma { expected: first.gamma, found: gas.gamma });
            }
        }
        let padding = [first; GHOSTS];
        let padded = [&padding, cells, &padding].concat();
        let field = |value: fn(&Gas) -> f64| padded.iter().map(value).collect();
        Ok(Self {
            domain,
            scheme: Scheme::new(first.gamma, FLOOR_FRACTION * lowest),
            width: length / cells.len() as f64,
            primitive: [field(|w| w.density), field(|w| w.velocity), field(|w| w.pressure)],
            conserved: [0, 1, 2].map(|k| cells.iter().map(|w| w.conserved()[k]).collect()),
            faces: Faces { low: [[0.0; BLOCK + 2]; 3], high: [[0.0; BLOCK + 2]; 3] },
            flux: [[0.0; BLOCK + 2]; 3],
            time: 0.0,
            signal_speed,
            work: Work::default(),
            inflow: [0.0; 3],
        })
    }

    /// Advances to exactly `time`; returns at once if it is not ahead.
    ///
    /// # Errors
    /// A non-finite `time`, one before the present, or [`GodunovError::Breakdown`] or
    /// [`GodunovError::Stalled`], after which the state is of no use.
    pub fn advance_to(&mut self, time: f64) -> Result<(), GodunovError> {
        at_least("time", time, self.time)?;
        while self.time < time {
            let startup = if self.work.steps < STARTUP_STEPS { STARTUP_FACTOR } else { 1.0 };
            let stable = startup * self.domain.cfl * self.width / self.signal_speed;
            let left = time - self.time;
            // The last two steps share what is left, so that none is tiny.
            let (step, reached) = if stable >= left {
                (left, time)
            } else if 2.0 * stable > left {
                (0.5 * left, self.time + 0.5 * left)
            } else {
                (stable, self.time + stable)
            };
            if reached <= self.time {
                return Err(GodunovError::Stalled { time: self.time });
            }
            self.step(step, reached)?;
        }
        Ok(())
    }

    /// The present time.
    #[must_use]
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Number of cells.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.conserved[0].len()
    }

    /// Always false: there is at least one cell.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.conserved[0].is_empty()
    }

    /// Width of a cell.
    #[must_use]
    pub const fn width(&self) -> f64 {
        self.width
    }

    /// Centres of the cells, from left to right.
    pub fn centres(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        (0..self.len()).map(|i| self.domain.start + (i as f64 + 0.5) * self.width)
    }

    /// States of the cells, from left to right.
    pub fn cells(&self) -> impl ExactSizeIterator<Item = Gas> + '_ {
        (GHOSTS..GHOSTS + self.len()).map(|i| {
            let [density, velocity, pressure] = self.primitive.each_ref().map(|w| w[i]);
            Gas { density, velocity, pressure, gamma: self.scheme.gamma }
        })
    }

    /// Counts of the work done so far.
    #[must_use]
    pub const fn work(&self) -> Work {
        self.work
    }

    /// Mass, momentum and energy in the domain, per cross-section.
    #[must_use]
    pub fn totals(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.width * self.conserved[k].iter().sum::<f64>())
    }

    /// Mass, momentum and energy that have entered through the two ends (the momentum includes
    /// the impulse of the pressure): the change of [`Self::totals`], but for rounding.
    #[must_use]
    pub const fn inflow(&self) -> [f64; 3] {
        self.inflow
    }

    /// Sets the ghost cells.
    fn fill_ghosts(&mut self) {
        let (last, deepest) = (self.len() + 2 * GHOSTS - 1, self.len() - 1);
        for ghost in 0..GHOSTS {
            // Index, counted from the end, of the cell as far inside as the ghost is outside.
            let mirror = GHOSTS + (GHOSTS - 1 - ghost).min(deepest);
            for field in 0..3 {
                let w = &mut self.primitive[field];
                let Domain { left, right, .. } = self.domain;
                w[ghost] = outside(left, field, w[mirror], w[GHOSTS]);
                w[last - ghost] = outside(right, field, w[last - mirror], w[last - GHOSTS]);
            }
        }
    }

    /// One step of length `dt`, ending at the time `reached`, block by block of cells.
    fn step(&mut self, dt: f64, reached: f64) -> Result<(), GodunovError> {
        self.fill_ghosts();
        let ratio = dt / self.width;
        let cells = self.len();
        self.signal_speed = 0.0;
        for start in (0..cells).step_by(BLOCK) {
            let count = BLOCK.min(cells - start);
            let stencil = self.primitive.each_ref().map(|w| &w[start..][..count + 2 * GHOSTS]);
            self.scheme.reconstruct(stencil, ratio, &mut self.faces);
            let speed = self.scheme.fluxes(&self.faces, count + 1, &mut self.flux);
            self.signal_speed = self.signal_speed.max(speed);
            for (q, flux) in self.conserved.iter_mut().zip(&self.flux) {
                for (q, pair) in q[start..][..count].iter_mut().zip(flux.windows(2)) {
                    *q += ratio * (pair[0] - pair[1]);
                }
            }
            for (k, flux) in self.flux.iter().enumerate() {
                let entered = if start == 0 { flux[0] } else { 0.0 };
                let left = if start + count == cells { flux[count] } else { 0.0 };
                self.inflow[k] += dt * (entered - left);
            }
        }
        let conserved = self.conserved.each_ref().map(Vec::as_slice);
        let primitive = self.primitive.each_mut().map(|w| &mut w[GHOSTS..]);
        let (floored, bad) = self.scheme.recover(conserved, primitive);
        self.time = reached;
        self.work.steps += 1;
        self.work.cell_steps += cells as u64;
        self.work.floored += floored;
        bad.map_or(Ok(()), |cell| Err(GodunovError::Breakdown { cell, time: reached }))
    }
}

/// Value of a primitive `field` in a ghost cell, given that of the cell as far `inside` and that of
/// the cell at the `edge`.
fn outside(boundary: Boundary, field: usize, inside: f64, edge: f64) -> f64 {
    match boundary {
        Boundary::Wall if field == 1 => -inside,
        Boundary::Wall => inside,
        Boundary::Outflow => edge,
        Boundary::Inflow(gas) => [gas.density, gas.velocity, gas.pressure][field],
    }
}

#[cfg(test)]
mod tests;
