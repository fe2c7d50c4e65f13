//! What the speeds of the start allow: steps before any rate of density is known, and leaps of whole bodies.

use super::columns::State;
use super::contacts::Contacts;
use super::lattice::dot;
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
        let corner = |slot: usize| {
            let i = group.node(slot) + lane;
            (lattice.position(mesh.place(i).1), [state.vx[i], state.vy[i], state.vz[i]])
        };
        let stretch = |a: usize, b: usize| {
            let ((x, v), (y, w)) = (corner(a), corner(b));
            let edge = [y[0] - x[0], y[1] - x[1], y[2] - x[2]];
            dot(edge, [w[0] - v[0], w[1] - v[1], w[2] - v[2]]).abs() / dot(edge, edge)
        };
        let along = |axis: usize| {
            let edges = (0..8).filter(|slot| slot >> axis & 1 == 0);
            edges.map(|slot| stretch(slot, slot | 1 << axis)).fold(0.0, f64::max)
        };
        most = most.max(along(0) + along(1) + along(2));
    }
    most
}

/// Longest first step: that in which neither the velocities within a body, nor those of two bodies, as if they touched, nor
/// walls change a density by more than a later step may. Rates that forces find are not known then.
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
