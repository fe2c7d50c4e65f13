//! Initial motions that a scene cannot state: a velocity and an energy for every particle.
//!
//! The state of a new simulation is taken as its sections, velocities and energies are set, what
//! follows from them is made consistent, and the simulation is restored from that.

use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;
use whipple_solver::space::restart::{RestartError, Section, Values};

use crate::run::RunError;

impl From<RestartError> for RunError {
    fn from(error: RestartError) -> Self {
        Self::Reference(error.to_string())
    }
}

/// The column of numbers of a name; nothing is done where there is none.
fn with(sections: &mut [Section], name: &str, change: impl FnOnce(&mut [f64])) {
    let found = sections.iter_mut().find(|section| section.name == name);
    if let Some(Values::F64(values)) = found.map(|section| &mut section.values) {
        change(values);
    }
}

/// Sets every particle of a new simulation moving, with `velocity` of its state at rest.
///
/// # Errors
/// Sections that the simulation refuses.
pub(in crate::cases) fn start(
    simulation: &mut Simulation,
    velocity: impl Fn(&Particle) -> [f64; 3],
) -> Result<(), RunError> {
    let moving: Vec<(usize, [f64; 3])> = simulation
        .all_particles()
        .map(|p| {
            let wanted = velocity(&p);
            // Stored relative to the translation of the body.
            (p.id as usize, std::array::from_fn(|d| wanted[d] - p.velocity[d]))
        })
        .collect();
    let mut sections = simulation.sections();
    for (axis, name) in ["state.vx", "state.vy", "state.vz"].into_iter().enumerate() {
        with(&mut sections, name, |column| {
            moving.iter().for_each(|(i, change)| column[*i] += change[axis]);
        });
    }
    settle(simulation, sections)
}

/// Gives particles of a new simulation of one ideal gas the energies per mass that `energy` says.
///
/// # Errors
/// Sections that the simulation refuses.
pub(in crate::cases) fn heat(
    simulation: &mut Simulation,
    [adiabatic_index, c_v]: [f64; 2],
    energy: impl Fn(&Particle) -> f64,
) -> Result<(), RunError> {
    let hot: Vec<(Particle, f64)> = simulation.all_particles().map(|p| (p, energy(&p))).collect();
    let mut sections = simulation.sections();
    let mut set = |name: &str, value: &dyn Fn(&Particle, f64) -> f64| {
        with(&mut sections, name, |column| {
            hot.iter().for_each(|(p, u)| column[p.id as usize] = value(p, *u));
        });
    };
    let pressure = |p: &Particle, u: f64| (adiabatic_index - 1.0) * p.rho * u;
    set("state.u", &|_, u| u);
    set("derived.pressure", &pressure);
    // At the start particles fill their shares of the elements.
    set("derived.grip", &pressure);
    set("derived.theta", &|_, u| u / c_v);
    set("derived.sound", &|_, u| (adiabatic_index * (adiabatic_index - 1.0) * u).sqrt());
    settle(simulation, sections)
}

/// Restores the sections with everything awake, and books what is there now as the initial holdings.
fn settle(simulation: &mut Simulation, mut sections: Vec<Section>) -> Result<(), RunError> {
    for section in &mut sections {
        if let ("group.awake" | "piece.active", Values::U8(flags)) =
            (section.name.as_str(), &mut section.values)
        {
            flags.fill(1);
        }
    }
    simulation.restore(&sections)?;
    simulation.start_books();
    Ok(())
}
