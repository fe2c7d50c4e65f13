//! Cost of the density schemes, measured fairly: same scene, same step count, A B B A in one run.

use cpu_time::ProcessTime;
use whipple_solver::Solver;
use whipple_solver::error::{SceneError, StepError};
use whipple_solver::method::{Conduction, Density, Integrator, Preset};
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};
use whipple_solver::units::Units;

/// Support with which the kernel sees the same two neighbours as the paper's scheme.
pub const EQUAL_LIST: f64 = 1.5;

/// Particle-steps that one turn of a comparison takes.
const PARTICLE_STEPS_PER_TURN: usize = 2_000_000;

/// Why a cost cannot be measured.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// The scene cannot be simulated.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A numerical failure.
    #[error(transparent)]
    Step(#[from] StepError),
}

/// One side of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contender {
    /// Density scheme.
    pub density: Density,
    /// Support of the kernel, where there is one.
    pub support: f64,
}

/// Cost of one side, per unit of work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// CPU nanoseconds per particle and step.
    pub per_particle_step: f64,
    /// CPU nanoseconds per pair visited by a force sweep.
    pub per_pair: f64,
    /// Pairs per particle and force sweep.
    pub pairs: f64,
    /// Kernel evaluations per particle and step.
    pub kernel_evaluations: f64,
}

/// Two schemes on the same scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Cost of the first.
    pub a: Cost,
    /// Cost of the second.
    pub b: Cost,
    /// Ratios of CPU time B / A, one a round, ascending.
    pub ratios: Vec<f64>,
}

impl Comparison {
    /// Median ratio.
    #[must_use]
    pub fn median(&self) -> f64 {
        median(&self.ratios)
    }

    /// Smallest and largest ratio.
    #[must_use]
    pub fn spread(&self) -> (f64, f64) {
        (self.ratios[0], self.ratios[self.ratios.len() - 1])
    }
}

/// A box of gas with a standing wave: every pair works, nothing breaks.
#[must_use]
pub fn scene(contender: Contender, integrator: Integrator, n: usize) -> Scene {
    let mut method = Preset::Default.method();
    method.density = contender.density;
    method.kernel_support = contender.support;
    method.integrator = integrator;
    method.conduction = Conduction::None;
    let eos = EosData::IdealGas { adiabatic_index: 1.4, c_v: 1.0, u_0: 0.0, theta_0: 0.0 };
    Scene {
        name: "standing wave".into(),
        units: Units::None,
        // About the time in which sound crosses the box: a step below a billionth of it is refused.
        stop_time: 1.0,
        method,
        boundaries: Boundaries { left: Boundary::Mirror(0.0), right: Boundary::Mirror(1.0) },
        materials: vec![Material { name: "gas".into(), density: 1.0, eos }],
        bodies: vec![Body {
            material: "gas".into(),
            from: 0.0,
            to: 1.0,
            particles: n,
            layout: Layout::Centres,
            compression: 1.0,
            interface: Interface::Joined,
            velocity: Profile::Cosine { mean: 0.0, amplitude: 0.01, mode: 1.0 },
            energy: Profile::Uniform(2.5),
        }],
    }
}

/// Compares two schemes over A B B A rounds of equal step counts.
///
/// # Errors
/// A scene that cannot be simulated, or a numerical failure.
pub fn compare(
    contenders: [Contender; 2],
    integrator: Integrator,
    n: usize,
    rounds: usize,
) -> Result<Comparison, CostError> {
    let build = |c: Contender| whipple_solver::build(&scene(c, integrator, n));
    let mut sides = [build(contenders[0])?, build(contenders[1])?];
    let steps = (PARTICLE_STEPS_PER_TURN / n).max(1);
    for side in &mut sides {
        turn(side.as_mut(), steps)?;
    }
    let mut spent = [Vec::new(), Vec::new()];
    let mut ratios = Vec::new();
    for _ in 0..rounds.max(1) {
        let mut seconds = [0.0; 2];
        for which in [0, 1, 1, 0] {
            seconds[which] += turn(sides[which].as_mut(), steps)?;
        }
        ratios.push(seconds[1] / seconds[0]);
        for (spent, seconds) in spent.iter_mut().zip(seconds) {
            spent.push(0.5 * seconds);
        }
    }
    ratios.sort_by(f64::total_cmp);
    let cost = |which: usize| {
        let counters = sides[which].counters();
        let per_step = counters.particle_steps as f64;
        let seconds = median(&spent[which]);
        let pairs_a_step = counters.pairs as f64 / counters.steps as f64;
        Cost {
            per_particle_step: 1e9 * seconds / (steps * n) as f64,
            per_pair: 1e9 * seconds / (steps as f64 * pairs_a_step),
            pairs: counters.pairs as f64 / counters.stages as f64 / n as f64,
            kernel_evaluations: counters.kernel_evaluations as f64 / per_step,
        }
    };
    Ok(Comparison { a: cost(0), b: cost(1), ratios })
}

/// CPU seconds of some steps.
fn turn(solver: &mut dyn Solver, steps: usize) -> Result<f64, StepError> {
    let start = ProcessTime::now();
    for _ in 0..steps {
        solver.step(f64::INFINITY)?;
    }
    Ok(start.elapsed().as_secs_f64())
}

/// Median of some values.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) }
}
