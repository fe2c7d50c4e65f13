//! What acts on the particles: the laws of a scene, and the sums over the contacts.

use std::ops::AddAssign;

use crate::density::DensityScheme;
use crate::method;
use crate::physics::Physics;
use crate::timestep::{Limiter, Vote};
use crate::viscosity::ViscousLaw;

/// The laws of a scene: constant during a run.
pub struct Laws<P: Physics<1>> {
    /// Density scheme.
    pub density: P::Density,
    /// Equations of state, one a material.
    pub eos: Vec<P::Eos>,
    /// Viscosity.
    pub viscosity: ViscousLaw,
    /// Conduction.
    pub heat: P::Heat,
    /// Split of the viscous heat.
    pub heating: Heating,
    /// Largest zeta at which viscosity and conduction act beyond the nearest; zero when they do not.
    pub support: f64,
}

impl<P: Physics<1>> Laws<P> {
    /// Whether pairs beyond the nearest act at all.
    pub fn reach_far(&self) -> bool {
        self.support > 0.0 || P::Density::SWEEPS > 1
    }
}

/// Shares of a particle in the heat of its viscous forces: with the closing speed `a` of the pair
/// and its own velocity `v`, it is heated by `q (common a + own v)`.
#[derive(Debug, Clone, Copy)]
pub struct Heating {
    /// Share in the dissipation of the pair.
    pub common: f64,
    /// Share in the power of the force on itself, Eq. (60) as printed.
    pub own: f64,
}

impl Heating {
    pub(crate) fn new(method: method::Heating) -> Self {
        match method {
            method::Heating::Pair => Self { common: 0.5, own: 0.0 },
            method::Heating::Printed => Self { common: 0.0, own: 1.0 },
        }
    }
}

/// Sums over the contacts of one particle.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tally<R> {
    /// Force `dp/dt`, Eq. (74).
    pub force: f64,
    /// Power `dU/dt`, Eq. (58): work (59), viscous heat (60) and conduction (62). Its multiplier in
    /// the Lagrange equations is 1, Eq. (70), so that all of it comes out of the motion.
    pub power: f64,
    /// Coefficients of viscosity and conduction, for the time step.
    pub damping: f64,
    /// Density rate, Eq. (36), where the scheme integrates one.
    pub rho_rate: R,
}

impl<R: AddAssign> AddAssign for Tally<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.force += other.force;
        self.power += other.power;
        self.damping += other.damping;
        self.rho_rate += other.rho_rate;
    }
}

/// What a chunk of pairs adds up to beside the particles.
#[derive(Debug, Clone, Copy)]
pub struct PairSums {
    /// Pairs visited.
    pub pairs: u64,
    /// Power that goes into the strain energy of the segments.
    pub strain_power: f64,
    /// Votes of the pairs on the time step.
    pub votes: [Vote; 2],
    /// A particle with more neighbours in range than there is room for.
    pub overflow: Option<usize>,
}

impl Default for PairSums {
    fn default() -> Self {
        let votes = [Vote::none(Limiter::Sound), Vote::none(Limiter::Closing)];
        Self { pairs: 0, strain_power: 0.0, votes, overflow: None }
    }
}

/// What one sweep is for. What it is not for, it does not compute.
pub trait Pass: Send + Sync {
    /// Whether forces are wanted.
    const FORCE: bool;
    /// Whether powers and density rates are wanted.
    const RATES: bool;
    /// Whether the pairs vote on the time step.
    const VOTES: bool;
}

/// The sweep at the start of a step.
pub struct Opening;
/// The sweep at its middle, where the rates use the velocities there.
pub struct Middle;
/// The sweep at its middle for the forces alone.
pub struct Forces;
/// The sweep that turns the forces at the middle into work, with the mean velocities of the step.
pub struct Work;

impl Pass for Opening {
    const FORCE: bool = true;
    const RATES: bool = true;
    const VOTES: bool = true;
}
impl Pass for Middle {
    const FORCE: bool = true;
    const RATES: bool = true;
    const VOTES: bool = false;
}
impl Pass for Forces {
    const FORCE: bool = true;
    const RATES: bool = false;
    const VOTES: bool = false;
}
impl Pass for Work {
    const FORCE: bool = false;
    const RATES: bool = true;
    const VOTES: bool = false;
}

/// The state that a sweep sees.
pub struct View<'a, C> {
    /// Positions.
    pub x: &'a [f64],
    /// Velocities that the viscosity sees.
    pub v: &'a [f64],
    /// Velocities over which the forces do work.
    pub drift: &'a [f64],
    /// Internal energies per mass.
    pub u: &'a [f64],
    /// Densities, where stored.
    pub rho: &'a C,
}
