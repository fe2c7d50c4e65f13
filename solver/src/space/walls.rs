//! Rigid, frictionless walls: they give back whatever would cross them, and their impulse is booked.

use super::columns::{State, Sums};
use super::contacts::Contacts;
use super::mesh::{Body, Mesh};
use super::scene::{Hold, Scene, Side};
use super::sweep::DENSEST_STEP;

/// A wall and the nodes that slide on it.
#[derive(Debug, Clone)]
pub struct Wall {
    axis: usize,
    position: f64,
    /// 1 if the material is above.
    side: f64,
    /// Nodes on a plane of symmetry.
    held: Vec<u32>,
}

/// What walls have given.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Given {
    /// Impulse.
    pub impulse: [f64; 3],
    /// Its moment about the origin.
    pub moment: [f64; 3],
    /// Work.
    pub work: f64,
}

impl Wall {
    /// The walls of a scene.
    #[must_use]
    pub fn all(scene: &Scene, mesh: &Mesh) -> Vec<Self> {
        let one = |wall: &super::scene::Wall| {
            let mut held = Vec::new();
            for body in mesh.bodies.iter().filter(|_| wall.hold == Hold::Mirror) {
                for (k, &at) in body.lattice.nodes.iter().enumerate() {
                    let x = body.lattice.position(at)[wall.axis];
                    if (x - wall.position).abs() < 1e-6 * body.length {
                        held.push((body.nodes.start + k) as u32);
                    }
                }
            }
            let side = if wall.material == Side::Above { 1.0 } else { -1.0 };
            Self { axis: wall.axis, position: wall.position, side, held }
        };
        scene.walls.iter().map(one).collect()
    }

    /// Tells contacts which particles lie on it, if it is a plane of symmetry.
    pub fn mirror(&self, mesh: &Mesh, contacts: &mut Contacts) {
        if !self.held.is_empty() {
            contacts.mirror(mesh, self.axis, &self.held);
        }
    }

    /// Longest step of a particle at a gap from it, with this speed away from it: the wall may take from the volume of its
    /// cell as much as a step may change a density.
    #[inline(always)]
    fn allows(body: &Body, gap: f64, speed: f64) -> f64 {
        if speed < 0.0 {
            (gap.max(0.0) + DENSEST_STEP * body.edge()) / -speed
        } else {
            f64::INFINITY
        }
    }

    /// Longest step by the speeds of held particles that near it.
    #[must_use]
    pub fn arrival(&self, (mesh, contacts): (&Mesh, &Contacts), state: &State) -> f64 {
        let axis = self.axis;
        let free = contacts.along(axis).map(|(i, body, x)| {
            let own = &mesh.bodies[body];
            let speed = self.side * (velocity(state)[axis][i] + own.velocity[axis]);
            let gap = self.side * (x - self.position);
            if mesh.held(i) { Self::allows(own, gap, speed) } else { f64::INFINITY }
        });
        let held = self.held.iter().map(|&i| {
            let body = &mesh.bodies[mesh.place(i as usize).0];
            let speed = velocity(state)[axis][i as usize] + body.velocity[axis];
            Self::allows(body, 0.0, -speed.abs())
        });
        free.chain(held).fold(f64::INFINITY, f64::min)
    }

    /// Keeps particles on their side over a kick and a drift of these lengths; they stop at the wall
    /// at most. `seen` is told of every particle that is pushed, and whether it was stopped. Returns the longest next step
    /// by held ones that near it, as far as that is shorter than the last of the lengths.
    pub fn keep(
        &self,
        (mesh, contacts): (&Mesh, &Contacts),
        (state, sums): (&State, &mut Sums),
        [kick, dt, next]: [f64; 3],
        given: &mut Given,
        mut seen: impl FnMut(usize, bool),
    ) -> f64 {
        let axis = self.axis;
        let mut arrival = f64::INFINITY;
        for (i, body, x) in contacts.along(axis) {
            let whole = mesh.bodies[body].velocity[axis];
            let v = velocity(state)[axis][i] + kick / mesh.mass(i) * force(sums, axis)[i];
            let gap = self.side * (x - self.position);
            let speed = self.side * (v + whole);
            if gap + dt * speed < 0.0 {
                // To the wall and no further; what is beyond it already stops.
                let wanted = self.side * (-gap / dt).min(0.0) - whole;
                self.push((i, body), wanted, mesh, (state, sums), (kick, given));
                seen(i, true);
            } else if gap + (dt + next) * speed < 0.0 && mesh.held(i) {
                let allowed = Self::allows(&mesh.bodies[body], gap + dt * speed, speed);
                arrival = arrival.min(allowed);
            }
        }
        for &i in &self.held {
            let i = i as usize;
            let body = mesh.place(i).0;
            let wanted = -mesh.bodies[body].velocity[axis];
            if velocity(state)[axis][i] != wanted || force(sums, axis)[i] != 0.0 {
                seen(i, false);
            }
            self.push((i, body), wanted, mesh, (state, sums), (kick, given));
        }
        arrival
    }

    /// Adds the force by which a particle has the wanted velocity normal to the wall after the kick,
    /// and books it.
    fn push(
        &self,
        (i, body): (usize, usize),
        wanted: f64,
        mesh: &Mesh,
        (state, sums): (&State, &mut Sums),
        (kick, given): (f64, &mut Given),
    ) {
        let axis = self.axis;
        let place = mesh.bodies[body].lattice.position(mesh.place(i).1);
        let own = [state.dx[i], state.dy[i], state.dz[i]];
        let way = mesh.bodies[body].way;
        let x: [f64; 3] = std::array::from_fn(|d| place[d] + (way[d] + own[d]));
        let v = velocity(state)[axis][i];
        let total = mesh.mass(i) * (wanted - v) / kick;
        let force = force(sums, axis);
        let impulse = (total - force[i]) * kick;
        force[i] = total;
        given.impulse[axis] += impulse;
        given.work += impulse * (0.5 * (v + wanted) + mesh.bodies[body].velocity[axis]);
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        given.moment[next] += x[last] * impulse;
        given.moment[last] -= x[next] * impulse;
    }
}

fn force(sums: &mut Sums, axis: usize) -> &mut [f64] {
    match axis {
        0 => &mut sums.fx,
        1 => &mut sums.fy,
        _ => &mut sums.fz,
    }
}

fn velocity(state: &State) -> [&[f64]; 3] {
    [&state.vx, &state.vy, &state.vz]
}
