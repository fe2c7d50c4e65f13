//! What the benchmarks share: the contenders and their scenes.

use whipple_solver::Solver;
use whipple_solver::method::{Density, Integrator, Preset};
use whipple_solver::space::Simulation;
use whipple_solver::space::method::Particles;
use whipple_vv::cases::find;
use whipple_vv::cost::{Contender, EQUAL_LIST, scene};
use whipple_vv::record::{RunKey, Scheme};
use whipple_vv::suite::scene_of;

/// Particles of every benchmark along a line.
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

/// Cells across the rod, and steps that it has taken when it is measured.
const CELLS: usize = 5;
const STEPS: u64 = 300;

/// The schemes of the long rod, with their names and particles: with elements that carry the pressure, the paper's,
/// and the kernel that it removes; and the same of ellipsoids.
#[must_use]
pub fn rods() -> [(&'static str, Scheme, Particles); 6] {
    let kernel = Scheme::Particles { preset: Preset::Paper, density: Density::Kernel };
    let [default, paper] = [Preset::Default, Preset::Paper].map(Scheme::preset);
    [
        ("default", default, Particles::Fitting),
        ("paper", paper, Particles::Fitting),
        ("paper, kernel", kernel, Particles::Fitting),
        ("default, ellipsoids", default, Particles::Ellipsoids),
        ("paper, ellipsoids", paper, Particles::Ellipsoids),
        ("paper, kernel, ellipsoids", kernel, Particles::Ellipsoids),
    ]
}

/// The long rod in the middle of its impact.
///
/// # Panics
/// If the scene were invalid or failed so early, which tests of the harness exclude.
#[must_use]
pub fn rod(scheme: Scheme, particles: Particles) -> Simulation {
    let scene = find("long-rod").and_then(|rod| {
        let key = RunKey::new(rod.id(), scheme, CELLS);
        scene_of(rod, &key)?.space().cloned()
    });
    let Some(mut scene) = scene else { panic!("the long rod is in space") };
    scene.method.particles = particles;
    let mut simulation = match Simulation::new(&scene) {
        Ok(simulation) => simulation,
        Err(error) => panic!("the rod is a valid scene: {error}"),
    };
    for _ in 0..STEPS {
        if let Err(error) = simulation.step(scene.stop_time) {
            panic!("the rod gets so far: {error}");
        }
    }
    simulation
}
