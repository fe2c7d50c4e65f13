//! What pairs in contact do: Eqs. (34)-(36), the force (67) in the form (78), the viscosity (51)-(53) and the
//! conduction (56)-(57), (62).

use rayon::prelude::*;

use super::{BLOCK, Contacts};
use crate::method::Viscosity;
use crate::space::columns::{Derived, State, Sums};
use crate::space::kernel::Kernel;
use crate::space::mesh::Mesh;
use crate::space::method::Method;
use crate::space::near::put;

/// Overlap beyond which the force of a contact rises no more, as a share of the distance of contact.
const DEEPEST: f64 = 0.8;

/// Most of its velocity that all contacts of a particle take in a kick where volumes carry the pressure: no motion is
/// damped by more than twice that, of which leapfrog bears two.
const BEARABLE: f64 = 0.9;

/// A pair in contact in this step.
#[derive(Debug, Clone, Copy)]
pub struct Active {
    /// Particles.
    pair: [u32; 2],
    /// Their bodies.
    bodies: [u16; 2],
    /// From the second to the first.
    r: [f64; 3],
    /// `3/8 rho_o g` of each: density rate per closing rate of `r^2 / 2`.
    row: [f64; 2],
    /// Pressure force over separation, and its share of the first particle.
    push: [f64; 2],
    /// Viscous force over separation.
    drag: f64,
    /// Heat flux from the first to the second.
    flux: f64,
}

impl Active {
    /// Whether it does anything: particles at rest beside each other do not.
    fn moves(&self, mesh: &Mesh) -> bool {
        self.bodies[0] != self.bodies[1]
            && mesh.bodies[self.bodies[0] as usize].velocity
                != mesh.bodies[self.bodies[1] as usize].velocity
            || self.push != [0.0; 2]
            || self.drag != 0.0
            || self.flux != 0.0
    }
}

/// What a contact sees.
struct View<'a> {
    mesh: &'a Mesh,
    state: &'a State,
    derived: &'a Derived,
    method: &'a Method,
    kernel: Option<&'a Kernel>,
    /// Whether elements carry the pressure of the particles that they hold.
    volumes: bool,
}

impl Contacts {
    /// The sweep that the paper's scheme removes: density from the positions, if by a kernel.
    pub fn sum_density(&mut self, mesh: &Mesh, rho: &mut [f64]) -> u64 {
        let Some(kernel) = &self.kernel else { return 0 };
        let pairs = self.list.pairs();
        self.terms.resize_with(pairs.len().div_ceil(BLOCK), Vec::new);
        let (position, members, body) = (&self.position, &self.members, &self.body);
        self.terms.par_iter_mut().zip(pairs.par_chunks(BLOCK)).for_each(|(terms, pairs)| {
            terms.clear();
            terms.extend(pairs.iter().map(|&[a, b]| {
                let (a, b) = (a as usize, b as usize);
                let square = |d: usize| (position[d][a] - position[d][b]).powi(2);
                let distance = (square(0) + square(1) + square(2)).sqrt();
                let term = |other: usize| {
                    kernel.value(distance / mesh.bodies[body[other] as usize].length)
                };
                [term(b), term(a)]
            }));
        });
        for &i in members {
            rho[i as usize] = kernel.value(0.0);
        }
        for (&[a, b], term) in pairs.iter().zip(self.terms.iter().flatten()) {
            rho[members[a as usize] as usize] += term[0];
            rho[members[b as usize] as usize] += term[1];
        }
        for (&i, &body) in members.iter().zip(body) {
            rho[i as usize] *= kernel.scale(i as usize) * mesh.bodies[body as usize].rho_0;
        }
        2 * pairs.len() as u64
    }

    /// Forces, conduction over the last step, of length `dt`, and the marks of touched particles. Viscosity damps
    /// a pair at the rate `most` at most, and a particle at most at [`BEARABLE`] of it: what stops a pair in a kick
    /// needs to be no more viscous. Returns the largest rate at which a particle is damped, where no such rate is
    /// given, and how often a contact was lessened.
    pub fn push(
        &mut self,
        mesh: &Mesh,
        (state, derived): (&State, &Derived),
        (method, dt, most): (&Method, f64, f64),
        (sums, touched, active): (&mut Sums, &mut [bool], &mut [bool]),
    ) -> (f64, u64) {
        let kernel = self.kernel.as_ref();
        let view = View { mesh, state, derived, method, kernel, volumes: self.volumes };
        let widest = (method.reach() * self.longest).powi(2);
        let pairs = self.list.pairs();
        self.blocks.resize_with(pairs.len().div_ceil(BLOCK), Vec::new);
        let (position, members, body) = (&self.position, &self.members, &self.body);
        self.blocks.par_iter_mut().zip(pairs.par_chunks(BLOCK)).for_each(|(found, pairs)| {
            found.clear();
            for &[a, b] in pairs {
                let (a, b) = (a as usize, b as usize);
                let r: [f64; 3] = std::array::from_fn(|d| position[d][a] - position[d][b]);
                if r[0] * r[0] + r[1] * r[1] + r[2] * r[2] >= widest {
                    continue;
                }
                let bodies = [body[a] as usize, body[b] as usize];
                if let Some(active) = view.contact([members[a], members[b]], r, bodies) {
                    put(found, active);
                }
            }
        });
        let damped = view.damp(&mut self.blocks, most, &mut sums.rho_rate);
        for contact in self.blocks.iter().flatten() {
            let [i, j] = contact.pair.map(|k| k as usize);
            let force = contact.push[0] + contact.push[1] + contact.drag;
            let f = contact.r.map(|r| force * r);
            sums.fx[i] += f[0];
            sums.fy[i] += f[1];
            sums.fz[i] += f[2];
            sums.fx[j] -= f[0];
            sums.fy[j] -= f[1];
            sums.fz[j] -= f[2];
            sums.heat[i] -= contact.flux * dt;
            sums.heat[j] += contact.flux * dt;
            if contact.moves(mesh) {
                active[mesh.piece_of(i)] = true;
                active[mesh.piece_of(j)] = true;
            }
            touched[i] = true;
            touched[j] = true;
        }
        damped
    }

    /// Density rates (36), pressure work (59) and viscous heat, the first term of Eq. (60) given half to each,
    /// over the mean velocities of the step.
    pub fn work(
        &self,
        mesh: &Mesh,
        mean: impl Fn(usize) -> [f64; 3],
        dt: f64,
        (rho_rate, heat): (&mut [f64], &mut [f64]),
    ) {
        for active in self.blocks.iter().flatten() {
            let [i, j] = active.pair.map(|k| k as usize);
            let drift = mesh.drift_of(active.bodies[0] as usize, active.bodies[1] as usize);
            let (a, b) = (mean(i), mean(j));
            let v: [f64; 3] = std::array::from_fn(|d| a[d] - b[d] + drift[d]);
            let closing = -(active.r[0] * v[0] + active.r[1] * v[1] + active.r[2] * v[2]);
            rho_rate[i] += active.row[0] * closing;
            rho_rate[j] += active.row[1] * closing;
            let half = 0.5 * active.drag;
            heat[i] += dt * (active.push[0] + half) * closing;
            heat[j] += dt * (active.push[1] + half) * closing;
        }
    }
}

/// Contacts with a viscous force.
fn damped(blocks: &mut [Vec<Active>]) -> impl Iterator<Item = &mut Active> {
    blocks.iter_mut().flatten().filter(|contact| contact.drag > 0.0)
}

impl View<'_> {
    /// The contact of particles `pair` at distance `r`, if there is one.
    #[inline]
    fn contact(&self, pair: [u32; 2], r: [f64; 3], bodies: [usize; 2]) -> Option<Active> {
        let [i, j] = pair.map(|k| k as usize);
        if self.volumes && self.mesh.keeps_apart([i, j], bodies) {
            return None;
        }
        let square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        let body = bodies.map(|b| &self.mesh.bodies[b]);
        let widest = body[0].length.max(body[1].length) * self.method.reach();
        // Two particles that a corner of walls stops at one point have no direction to part in.
        if square >= widest * widest || square == 0.0 {
            return None;
        }
        let distance = square.sqrt();
        let ratio = [self.derived.rho[i] / body[0].rho_0, self.derived.rho[j] / body[1].rho_0];
        let thin = [0, 1].map(|k| body[k].eos.thinning(ratio[k]));
        // Of the first on the ellipsoid of the second, Eqs. (9), (35), and the other way round.
        let row = match self.kernel {
            None => [
                thin[0] * body[0].rho_0 * self.row(distance, body[1].length, ratio[1]),
                thin[1] * body[1].rho_0 * self.row(distance, body[0].length, ratio[0]),
            ],
            Some(kernel) => {
                let row = |k: usize, i: usize, length: f64| {
                    let slope = kernel.slope(distance / length) / (distance * length);
                    body[k].rho_0 * kernel.scale(i) * slope
                };
                [row(0, i, body[1].length), row(1, j, body[0].length)]
            }
        };
        let near = distance < body[0].length.max(body[1].length);
        if row[0] == 0.0 && row[1] == 0.0 && !near {
            return None;
        }
        let per = |k: usize, i: usize| {
            let rho = self.derived.rho[i];
            row[k] * self.mesh.mass(i) * self.derived.pressure[i] / (rho * rho)
        };
        let mut active = Active {
            pair,
            bodies: bodies.map(|b| b as u16),
            r,
            row,
            push: [per(0, i), per(1, j)],
            drag: 0.0,
            flux: 0.0,
        };
        if near {
            let impedance = [self.impedance(i, bodies[0]), self.impedance(j, bodies[1])];
            let approach = self.closing(&active) / distance;
            if approach > 0.0 {
                let slope = 0.5 * (body[0].slope + body[1].slope);
                let sound = 0.5 * (self.sound(i, bodies[0]) + self.sound(j, bodies[1]));
                let both = 0.5 * (impedance[0] + impedance[1]);
                active.drag =
                    both * self.method.steepness(approach, sound, slope) * approach / distance;
            }
            let [a, b] = [0, 1].map(|k| impedance[k] * body[k].eos.c_v());
            // The flux of the limited viscosity acts in shocks alone.
            let coefficient = match self.method.viscosity {
                Viscosity::Pairwise => self.method.heat_coeff,
                Viscosity::Limited => 0.0,
            };
            let transfer = 0.5 * coefficient * (a + b);
            active.flux = transfer * (self.derived.theta[i] - self.derived.theta[j]);
        }
        Some(active)
    }

    /// Lessens viscous forces to what stops a pair in a kick, of which `most` is the inverse, and takes [`BEARABLE`] of
    /// its velocity from a particle. Returns what [`Contacts::push`] does. `sums` is nothing before and after: rates of density, which are summed there, are not known
    /// yet.
    fn damp(&self, blocks: &mut [Vec<Active>], most: f64, sums: &mut [f64]) -> (f64, u64) {
        let (mut rate, mut lessened) = (0.0f64, 0);
        for contact in damped(blocks) {
            let square: f64 = contact.r.iter().map(|r| r * r).sum();
            let coefficient = contact.drag * square / self.closing(contact);
            let pair = contact.pair.map(|k| k as usize);
            let own = pair.map(|i| coefficient / self.mesh.mass(i));
            let part = (most / (own[0] + own[1])).min(1.0);
            contact.drag *= part;
            lessened += u64::from(part < 1.0);
            for (i, own) in pair.into_iter().zip(own) {
                sums[i] += own * part;
                rate = rate.max(sums[i]);
            }
        }
        let bearable = BEARABLE * most;
        if rate > bearable {
            for contact in damped(blocks) {
                let [i, j] = contact.pair.map(|k| k as usize);
                let part = (bearable / sums[i].max(sums[j])).min(1.0);
                contact.drag *= part;
                lessened += u64::from(part < 1.0);
            }
        }
        for contact in blocks.iter().flatten() {
            contact.pair.into_iter().for_each(|i| sums[i as usize] = 0.0);
        }
        (if most.is_finite() { 0.0 } else { rate }, lessened)
    }

    /// Closing rate of `r^2 / 2`.
    #[inline(always)]
    fn closing(&self, Active { pair, bodies, r, .. }: &Active) -> f64 {
        let [i, j] = pair.map(|k| k as usize);
        let drift = self.mesh.drift_of(bodies[0] as usize, bodies[1] as usize);
        let v = [
            self.state.vx[i] - self.state.vx[j] + drift[0],
            self.state.vy[i] - self.state.vy[j] + drift[1],
            self.state.vz[i] - self.state.vz[j] + drift[2],
        ];
        -(r[0] * v[0] + r[1] * v[1] + r[2] * v[2])
    }

    /// `3/8 W / (zeta^5 L^2)`, Eqs. (35)-(36), at a distance from a particle of contact length `L`.
    #[inline(always)]
    fn row(&self, distance: f64, length: f64, ratio: f64) -> f64 {
        let zeta = distance / length;
        let tolerance = 1.0 + self.method.contact_tolerance;
        let cube = zeta * zeta * zeta * ratio;
        if zeta >= self.method.contact_reach || cube >= tolerance * tolerance * tolerance {
            return 0.0;
        }
        let zeta = if cube < DEEPEST * DEEPEST * DEEPEST { DEEPEST / ratio.cbrt() } else { zeta };
        0.375 / (zeta.powi(5) * length * length)
    }

    /// `rho_o c_s V_o^(2/3)`, Eq. (53).
    #[inline(always)]
    fn impedance(&self, i: usize, body: usize) -> f64 {
        let area = self.mesh.areas[body][self.mesh.share[i] as usize];
        self.mesh.bodies[body].rho_0 * self.sound(i, body) * area
    }

    /// `c_s` of Eqs. (53), (57).
    #[inline(always)]
    fn sound(&self, i: usize, body: usize) -> f64 {
        self.mesh.bodies[body].viscous_sound(self.method.viscosity, self.derived.sound[i])
    }
}
