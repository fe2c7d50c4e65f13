//! What the speeds of the start allow: steps before any rate of density is known, and leaps of whole bodies.

use super::columns::State;
use super::contacts::Contacts;
use super::mesh::{Body, Group, Mesh};
use super::sweep::DENSEST_STEP;
use super::walls::Wall;

/// Largest speed of a particle of a body, in the frame of the body.
fn fastest(body: &Body, state: &State) -> f64 {
    let own = body.nodes.clone().chain(body.centroids.clone());
    let squares = own.map(|i| state.vx[i].powi(2) + state.vy[i].powi(2) + state.vz[i].powi(2));
    squares.fold(0.0, f64::max).sqrt()
}

/// Largest speed of two bodies against each other over the shorter edge of their cells, over all bodies.
fn nearing(mesh: &Mesh, state: &State) -> f64 {
    let speeds: Vec<f64> = mesh.bodies.iter().map(|body| fastest(body, state)).collect();
    let mut rate = 0.0f64;
    for (k, one) in mesh.bodies.iter().enumerate() {
        for (l, other) in mesh.bodies[..k].iter().enumerate() {
            let apart: [f64; 3] = std::array::from_fn(|d| one.velocity[d] - other.velocity[d]);
            let apart = apart.iter().map(|v| v * v).sum::<f64>().sqrt();
            rate = rate.max((apart + speeds[k] + speeds[l]) / one.edge().min(other.edge()));
        }
    }
    rate
}

/// Longest step in which no particles of two bodies, at the speeds of the start, come nearer by more than half of the
/// shorter edge of their cells: those farther apart than they see each other do not pass each other then.
pub(super) fn leap(mesh: &Mesh, state: &State) -> f64 {
    0.5 / nearing(mesh, state)
}

/// Largest rate at which velocities stretch the edges of a cell, summed over its axes.
fn stretching(mesh: &Mesh, group: &Group, state: &State) -> f64 {
    let lattice = &mesh.bodies[usize::from(group.body)].lattice;
    let mut most = 0.0f64;
    for lane in 0..usize::from(group.lanes) {
        let v = |slot: usize| {
            let i = group.node(slot) + lane;
            [state.vx[i], state.vy[i], state.vz[i]]
        };
        let along = |axis: usize| {
            let edges = (0..8).filter(|slot| slot >> axis & 1 == 0).map(|slot| {
                let (a, b) = (v(slot), v(slot | 1 << axis));
                let change = (0..3).map(|d| (b[d] - a[d]) * lattice.axes[axis][d]).sum::<f64>();
                change.abs()
            });
            edges.fold(0.0, f64::max) / lattice.size[axis]
        };
        most = most.max(along(0) + along(1) + along(2));
    }
    most
}

/// Longest first step: that in which neither the velocities within a body, nor those of bodies that may touch, nor walls
/// change a density by more than a later step may. Rates that forces find are not known then.
pub(super) fn first(
    (mesh, groups): (&Mesh, &[Group]),
    (state, contacts): (&State, &Contacts),
    walls: &[Wall],
) -> f64 {
    let within = groups.iter().map(|group| stretching(mesh, group, state)).fold(0.0, f64::max);
    let rate = within.max(nearing(mesh, state));
    let arrivals = walls.iter().map(|wall| wall.arrival((mesh, contacts), state));
    arrivals.fold(DENSEST_STEP / rate, f64::min)
}
