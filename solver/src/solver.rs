//! From a scene to the types that it needs, once per run.

use crate::audit::Ledger;
use crate::counters::Counters;
use crate::density::{DensityScheme, Hybrid, Kernel, Nonholonomic};
use crate::error::{SceneError, StepError};
use crate::heat::{Adiabatic, ArtificialConduction, Heat};
use crate::method::Density;
use crate::output::Snapshot;
use crate::physics::{Bar, Gas, Physics};
use crate::scene::{EosData, Scene};
use crate::simulation::Simulation;
use crate::timestep::{Decided, Vote};

/// A simulation of any composition. Dispatch is dynamic here, per call, and nowhere inside.
pub trait Solver: Send {
    /// Takes one step, at most to the time `until`; none at that time or later.
    ///
    /// # Errors
    /// A numerical failure; the state is the one before the step.
    fn step(&mut self, until: f64) -> Result<(), StepError>;
    /// Steps until `time`, which is reached exactly.
    ///
    /// # Errors
    /// The first numerical failure.
    fn advance_to(&mut self, time: f64) -> Result<(), StepError>;
    /// Present time.
    fn time(&self) -> f64;
    /// Number of particles.
    fn particles(&self) -> usize;
    /// Work done so far.
    fn counters(&self) -> Counters;
    /// Balance of the conserved quantities.
    fn ledger(&self) -> &Ledger;
    /// How often each limiter decided the time step.
    fn decided(&self) -> Decided;
    /// The vote that decided the last step.
    fn vote(&self) -> Vote;
    /// Velocity of particle `i`.
    fn velocity(&self, i: usize) -> f64;
    /// Strain energy of the elements, from the positions.
    fn strain_energy(&self) -> f64;
    /// All fields of all particles.
    fn snapshot(&self) -> Snapshot;
}

impl<P: Physics<1>> Solver for Simulation<P> {
    fn step(&mut self, until: f64) -> Result<(), StepError> {
        self.step(until)
    }
    fn advance_to(&mut self, time: f64) -> Result<(), StepError> {
        self.advance_to(time)
    }
    fn time(&self) -> f64 {
        self.time()
    }
    fn particles(&self) -> usize {
        self.particles()
    }
    fn counters(&self) -> Counters {
        self.counters()
    }
    fn ledger(&self) -> &Ledger {
        self.ledger()
    }
    fn decided(&self) -> Decided {
        self.decided()
    }
    fn vote(&self) -> Vote {
        self.vote()
    }
    fn velocity(&self, i: usize) -> f64 {
        self.velocity(i)
    }
    fn strain_energy(&self) -> f64 {
        self.strain_energy()
    }
    fn snapshot(&self) -> Snapshot {
        self.snapshot()
    }
}

/// Builds the simulation that a scene asks for: what the scene lacks is not in its types.
///
/// # Errors
/// What [`Scene::validate`] finds.
pub fn build(scene: &Scene) -> Result<Box<dyn Solver>, SceneError> {
    scene.validate()?;
    match scene.method.density {
        Density::Nonholonomic => with_density(scene, Nonholonomic),
        Density::Kernel => with_density(scene, Kernel::new(scene.method.kernel_support)),
        Density::Hybrid => with_density(scene, Hybrid),
    }
}

fn with_density<S: DensityScheme<1>>(scene: &Scene, s: S) -> Result<Box<dyn Solver>, SceneError> {
    if scene.method.conducts() {
        with_heat::<S, ArtificialConduction>(scene, s)
    } else {
        with_heat::<S, Adiabatic>(scene, s)
    }
}

fn with_heat<S: DensityScheme<1>, H: Heat>(
    scene: &Scene,
    density: S,
) -> Result<Box<dyn Solver>, SceneError> {
    Ok(match scene.materials[0].eos {
        EosData::IdealGas { .. } => Box::new(Simulation::<Gas<S, H>>::new(scene, density)?),
        EosData::Linear { .. } => Box::new(Simulation::<Bar<S, H>>::new(scene, density)?),
    })
}
