//! Initial motions that a scene cannot state: a velocity and an energy for every particle.
//!
//! The state of a new simulation is taken as its sections, velocities and energies are set, what
//! follows from them is made consistent, and the simulation is restored from that.

use whipple_solver::space::Simulation;
use whipple_solver::space::ledger::Holdings;
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
    let held = simulation.holdings().iter().fold(Holdings::default(), Holdings::and);
    let [px, py, pz] = held.momentum;
    let [lx, ly, lz] = held.angular;
    let books = [
        held.mass,
        px,
        py,
        pz,
        lx,
        ly,
        lz,
        held.kinetic,
        held.internal,
        held.shear,
        held.tension,
        held.momentum_scale,
        held.angular_scale,
    ];
    // The last thirteen entries are the holdings at the start.
    with(&mut sections, "run.ledger", |ledger| {
        let at = ledger.len() - books.len();
        ledger[at..].copy_from_slice(&books);
    });
    Ok(simulation.restore(&sections)?)
}
