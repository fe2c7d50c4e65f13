//! Volumes of the particles' shares before a drift: what velocities before a kick do to volumes is what the drift
//! before it has done (decision 0020).

use super::cells::Cells;
use super::columns::{Column, State};
use super::lanes::F8;
use super::mesh::{Group, Mesh};
use super::method::Method;

/// Before the first step: adds the volumes that there would have been a drift of length `dt` ago, by their rates.
pub fn look_back(
    (mesh, groups): (&Mesh, &[Group]),
    state: &State,
    (method, dt): (&Method, f64),
    volume: &mut Column,
) {
    for group in groups {
        let [growth, rate] = shares((mesh, group), state, (method, 0.0));
        for lane in 0..u32::from(group.lanes) {
            for (slot, i) in group.particles(lane).enumerate() {
                volume[i] += growth[slot].0[lane as usize] - dt * rate[slot].0[lane as usize];
            }
        }
    }
}

/// Takes the elements of a group that die out of the volumes before the last drift, which was of length `dt`.
pub fn forget(
    (mesh, group): (&Mesh, &Group),
    state: &State,
    (method, dt): (&Method, f64),
    volume: &mut Column,
) {
    let [growth, _] = shares((mesh, group), state, (method, dt));
    for lane in group.dying_lanes() {
        for (slot, i) in group.particles(lane).enumerate() {
            volume[i] -= growth[slot].0[lane as usize];
        }
    }
}

fn shares((mesh, group): (&Mesh, &Group), state: &State, step: (&Method, f64)) -> [[F8; 9]; 2] {
    let body = &mesh.bodies[usize::from(group.body)];
    if body.mapped.is_empty() {
        group.volumes(&Cells::<false>::new(body, group.centre), state.motion(), step)
    } else {
        group.volumes(&Cells::<true>::new(body, group.centre), state.motion(), step)
    }
}
