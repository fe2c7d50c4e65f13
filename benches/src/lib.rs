//! What the benchmarks share: the contenders and their scenes.

use whipple_solver::Solver;
use whipple_solver::method::{Density, Integrator, Preset};
use whipple_vv::cost::{Contender, EQUAL_LIST, scene};

/// Particles of every benchmark.
pub const PARTICLES: usize = 10_000;

/// The schemes that are compared, with their names.
#[must_use]
pub fn contenders() -> [(&'static str, Contender); 4] {
    let natural = Preset::Default.method().kernel_support;
    let with = |density, support| Contender { density, support };
    [
        ("nonholonomic", with(Density::Nonholonomic, natural)),
        ("kernel, equal list", with(Density::Kernel, EQUAL_LIST)),
        ("kernel, natural support", with(Density::Kernel, natural)),
        ("hybrid", with(Density::Hybrid, natural)),
    ]
}

/// A solver at work on the standing wave.
///
/// # Panics
/// If the scene were invalid, which a test of the harness excludes.
#[must_use]
pub fn solver(contender: Contender, integrator: Integrator) -> Box<dyn Solver> {
    match whipple_solver::build(&scene(contender, integrator, PARTICLES)) {
        Ok(solver) => solver,
        Err(error) => panic!("the standing wave is a valid scene: {error}"),
    }
}
