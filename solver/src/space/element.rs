//! Hexahedra, eight at a time: shear (24), tension (25), pressure of the volumes, and the viscosity
//! and conduction of their bonds.
//!
//! A cell has nine particles: slot `b1 + 2 b2 + 4 b3` for the corner with these bits along the fast,
//! mid and slow axes, and the centroid. Everything is computed from displacements relative to the
//! translation of the body, so that a body at rest in its own frame is exactly free of force.

use super::columns::SumsSlices;
use super::lanes::{F8, LANES, M8};
use super::mesh::{Body, Group};
use super::strength::{Load, Plastic, Sym, contract};

/// Corners A, B, C, D of the pyramids' outer faces, seen from outside against the clock.
pub const FACES: [[usize; 4]; 6] =
    [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];

/// Slot of the centroid.
const CENTRE: usize = 8;

/// Largest stretch of an element that counts as a volume.
const TORN: f64 = 4.0;

/// Smallest pyramid, over its reference volume, of an element that counts as a volume.
const CRUSHED: f64 = 0.2;

/// Expansion at which a failed element ceases to count as a volume.
const OPEN: f64 = 1.2;

type V3 = [F8; 3];

/// What elements read of the particles.
#[derive(Debug, Clone, Copy)]
pub struct Read<'a> {
    /// Displacements.
    pub displacement: [&'a [f64]; 3],
    /// Velocities.
    pub velocity: [&'a [f64]; 3],
    /// Pressures on the volumes.
    pub grip: &'a [f64],
    /// Temperatures.
    pub theta: &'a [f64],
    /// Sound speeds.
    pub sound: &'a [f64],
}

/// Where elements of a chunk add to the sums of its particles.
#[derive(Debug)]
pub struct Sink<'a> {
    /// Sums of its nodes.
    pub nodes: SumsSlices<'a>,
    /// Sums of its centroids.
    pub centres: SumsSlices<'a>,
    /// First node.
    pub first_node: usize,
    /// First centroid.
    pub first_centre: usize,
}

/// What the elements of a scene have in common.
#[derive(Debug, Clone, Copy)]
pub struct Laws {
    /// `c_o` of Eq. (53).
    pub visc_linear: f64,
    /// `c_1` of Eq. (53).
    pub visc_quad: f64,
    /// `k_o` of Eq. (57).
    pub heat_coeff: f64,
    /// Length of the last step.
    pub dt: f64,
}

/// What elements ask of the time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Largest rate at which longitudinal waves cross an element.
    pub rate: f64,
    /// Largest closing speed of a bond over the sound speed.
    pub closing: f64,
    /// Whether an element is to die after the step.
    pub dying: bool,
    /// Heat of plastic flow and damage.
    pub heat: f64,
}

impl Demand {
    /// Of nothing.
    pub const NONE: Self = Self { rate: 0.0, closing: 0.0, dying: false, heat: 0.0 };

    /// The stricter.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            rate: self.rate.max(other.rate),
            closing: self.closing.max(other.closing),
            dying: self.dying || other.dying,
            heat: self.heat + other.heat,
        }
    }
}

#[inline(always)]
fn sub(a: &V3, b: &V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot(a: &V3, b: &V3) -> F8 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross(a: &V3, b: &V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn add_to(to: &mut V3, what: &V3, factor: F8) {
    for d in 0..3 {
        to[d] += factor * what[d];
    }
}

/// Edges of a pyramid: from the centroid to the middle of the face, and the face's diagonals.
#[inline(always)]
fn pyramid(y: &[V3; 9], [a, b, c, d]: [usize; 4]) -> (V3, V3, V3) {
    let mut w = [F8::ZERO; 3];
    for (k, w) in w.iter_mut().enumerate() {
        *w = 0.25 * ((y[a][k] + y[b][k]) + (y[c][k] + y[d][k])) - y[CENTRE][k];
    }
    (w, sub(&y[c], &y[a]), sub(&y[d], &y[b]))
}

/// Volumes of the pyramids of a cell with these corners about its centre.
#[must_use]
pub fn pyramid_volumes(corners: &[[f64; 3]; 8]) -> [f64; 6] {
    let mut y = [[F8::ZERO; 3]; 9];
    for (slot, corner) in corners.iter().enumerate() {
        y[slot] = corner.map(F8::splat);
    }
    FACES.map(|face| {
        let (w, e, g) = pyramid(&y, face);
        (dot(&w, &cross(&e, &g)) * (1.0 / 6.0)).0[0]
    })
}

impl Group {
    /// A column at the nine slots.
    #[inline(always)]
    fn gather(&self, column: &[f64]) -> [F8; 9] {
        std::array::from_fn(|slot| {
            let at = if slot == CENTRE { self.centre as usize } else { self.node(slot) };
            F8::load(column, at)
        })
    }

    /// A vector column at the nine slots.
    #[inline(always)]
    fn gather_vector(&self, columns: [&[f64]; 3]) -> [V3; 9] {
        let [x, y, z] = columns.map(|column| self.gather(column));
        std::array::from_fn(|slot| [x[slot], y[slot], z[slot]])
    }

    /// Adds the corners' values to a column of nodes whose first is `first`.
    #[inline(always)]
    fn scatter(&self, values: &[F8; 8], to: &mut [f64], first: usize) {
        for row in 0..4 {
            let at = self.rows[row] as usize - first;
            let (low, high) = (values[2 * row], values[2 * row + 1]);
            if self.lanes as usize == LANES {
                let mut shifted = [0.0; LANES];
                shifted[1..].copy_from_slice(&high.0[..LANES - 1]);
                (F8::load(to, at) + (low + F8(shifted))).store(to, at);
                to[at + LANES] += high.0[LANES - 1];
            } else {
                for k in 0..self.lanes as usize {
                    to[at + k] += low.0[k];
                    to[at + k + 1] += high.0[k];
                }
            }
        }
    }

    /// Adds the centroids' values to a column of centroids whose first is `first`.
    #[inline(always)]
    fn scatter_centre(&self, value: F8, to: &mut [f64], first: usize) {
        let at = self.centre as usize - first;
        for (to, value) in to[at..].iter_mut().zip(value.0).take(self.lanes as usize) {
            *to += value;
        }
    }

    #[inline(always)]
    fn scatter_vector(&self, values: &[V3; 9], sink: &mut Sink<'_>) {
        let (nodes, centres) = (&mut sink.nodes, &mut sink.centres);
        let columns = [
            (&mut *nodes.fx, &mut *centres.fx),
            (&mut *nodes.fy, &mut *centres.fy),
            (&mut *nodes.fz, &mut *centres.fz),
        ];
        for (d, (node, centre)) in columns.into_iter().enumerate() {
            let own: [F8; 8] = std::array::from_fn(|slot| values[slot][d]);
            self.scatter(&own, node, sink.first_node);
            self.scatter_centre(values[CENTRE][d], centre, sink.first_centre);
        }
    }

    /// Positions of the slots about the cell's centre at the start.
    #[inline(always)]
    fn shape(&self, u: &[V3; 9], body: &Body) -> [V3; 9] {
        let mut y = *u;
        for (slot, corner) in body.corners.iter().enumerate() {
            for d in 0..3 {
                y[slot][d] = u[slot][d] + corner[d];
            }
        }
        y
    }

    /// First pass: forces, volumes, conduction and the heat of flow and damage.
    #[inline(always)]
    pub fn load_particles<const VOLUMES: bool>(
        &mut self,
        body: &Body,
        laws: &Laws,
        read: &Read<'_>,
        sink: &mut Sink<'_>,
    ) -> Demand {
        let live = M8::from_bits(self.live);
        let keep = |x: F8| F8::select(live, x, F8::ZERO);
        let u = self.gather_vector(read.displacement);
        let y = self.shape(&u, body);
        let theta = self.gather(read.theta);
        let mut force = [[F8::ZERO; 3]; 9];
        let mut heat = [F8::ZERO; 9];
        let mut demand = Demand::NONE;

        let motion = Kinematics::new(&u, body);
        let pyramids = FACES.map(|face| pyramid(&y, face));
        let areas: [V3; 6] = std::array::from_fn(|k| cross(&pyramids[k].1, &pyramids[k].2));
        let volumes: [F8; 6] =
            std::array::from_fn(|k| dot(&pyramids[k].0, &areas[k]) * (1.0 / 6.0));
        let opening: [F8; 6] =
            std::array::from_fn(|k| (volumes[k] - body.pyramids[k]) * (1.0 / body.pyramids[k]));
        let tallest =
            0.5 * theta[CENTRE] + 0.0625 * ((0..8).fold(F8::ZERO, |sum, slot| sum + theta[slot]));

        self.fail(body, &motion, &opening, tallest);
        let released = self.damage(body, &opening, laws.dt);
        let intact = 1.0 - self.damage;
        let mut freed = released;
        if body.solid.mu > 0.0 {
            freed += self.shear(body, &motion, (tallest, intact, laws.dt));
            motion.forces(&self.piola, body, live, &mut force);
            let stretch = -keep(-motion.stretch_squared()).least();
            demand.rate = stretch.sqrt() * body.solid.sound / body.solid.edge;
        }
        let freed = keep(freed);
        demand.heat = freed.sum();
        for (slot, heat) in heat.iter_mut().enumerate() {
            *heat = if slot == CENTRE { 0.5 } else { 0.0625 } * freed;
        }

        let mut push = [F8::ZERO; 6];
        for k in 0..6 {
            self.tension[k] = keep(body.solid.bulk * intact * opening[k].max(F8::ZERO));
            push[k] = -self.tension[k];
        }
        if VOLUMES {
            let grip = self.gather(read.grip);
            let mut share = [F8::ZERO; 9];
            for (k, face) in FACES.into_iter().enumerate() {
                let corners = (grip[face[0]] + grip[face[1]]) + (grip[face[2]] + grip[face[3]]);
                push[k] += keep(0.5 * grip[CENTRE] + 0.125 * corners);
                // Relative to the reference volume: nothing where nothing has moved.
                let volume = keep(volumes[k] - body.pyramids[k]);
                share[CENTRE] += 0.5 * volume;
                for slot in face {
                    share[slot] += 0.125 * volume;
                }
            }
            let own: [F8; 8] = std::array::from_fn(|slot| share[slot]);
            self.scatter(&own, sink.nodes.volume, sink.first_node);
            self.scatter_centre(share[CENTRE], sink.centres.volume, sink.first_centre);
            demand.closing =
                self.bond(&y, (body, laws, read), (&theta, live), (&mut force, &mut heat));
        }
        for (k, face) in FACES.into_iter().enumerate() {
            let (w, e, g) = &pyramids[k];
            let sixth = push[k] * (1.0 / 6.0);
            let twenty_fourth = push[k] * (1.0 / 24.0);
            let (gw, we) = (cross(g, w), cross(w, e));
            add_to(&mut force[CENTRE], &areas[k], -sixth);
            for (slot, side, turn) in [
                (face[0], &gw, -sixth),
                (face[2], &gw, sixth),
                (face[3], &we, sixth),
                (face[1], &we, -sixth),
            ] {
                add_to(&mut force[slot], &areas[k], twenty_fourth);
                add_to(&mut force[slot], side, turn);
            }
        }
        self.scatter_vector(&force, sink);
        let own: [F8; 8] = std::array::from_fn(|slot| heat[slot]);
        self.scatter(&own, sink.nodes.heat, sink.first_node);
        self.scatter_centre(heat[CENTRE], sink.centres.heat, sink.first_centre);
        demand.dying = self.dying != 0;
        demand
    }

    /// Marks lanes that fail, and those that cease to be volumes after this step.
    #[inline(always)]
    fn fail(&mut self, body: &Body, motion: &Kinematics, opening: &[F8; 6], theta: F8) {
        let solid = &body.solid;
        let mut smallest = opening[0];
        let mut widest = opening[0];
        for o in &opening[1..] {
            smallest = smallest.min(*o);
            widest = widest.max(*o);
        }
        let crushed = smallest.lt(F8::splat(CRUSHED - 1.0)).bits()
            | motion.jacobian.lt(F8::splat(solid.compression)).bits();
        let tension = solid.bulk * (1.0 - self.damage) * widest;
        let pulled = tension.gt(F8::splat(solid.spall)).bits();
        let failing = solid.spent(self.strain, theta) | crushed | pulled;
        self.failed |= failing & self.live;
        let stretched = motion.stretch_squared().gt(F8::splat(TORN * TORN)).bits();
        let open = motion.jacobian.gt(F8::splat(OPEN)).bits() & self.failed;
        self.dying = (crushed | stretched | open) & self.live;
        self.failed |= self.dying;
    }

    /// Damage of failed lanes, Eq. (47), and the energy that it sets free. A dying element loses all
    /// of its strength at once, so that no stored energy is left in it.
    #[inline(always)]
    fn damage(&mut self, body: &Body, opening: &[F8; 6], dt: f64) -> F8 {
        if self.failed & self.live == 0 {
            return F8::ZERO;
        }
        let step = F8::splat(body.solid.damage_step(dt));
        let step = F8::select(M8::from_bits(self.dying), F8::splat(1.0), step);
        let grown = (self.damage + step).min(F8::splat(1.0));
        let grown = F8::select(M8::from_bits(self.failed & self.live), grown, self.damage);
        let stored = self.shear_energy(body) + tension_energy(body, opening);
        let released = stored * (grown - self.damage);
        let left = (1.0 - grown) / (1.0 - self.damage).max(F8::splat(1e-300));
        for stress in &mut self.stress {
            *stress = *stress * left;
        }
        self.damage = grown;
        released
    }

    /// Shear energy per damage, from the stress of the last step.
    #[inline(always)]
    fn shear_energy(&self, body: &Body) -> F8 {
        let intact = 1.0 - self.damage;
        let stiffness = 4.0 * body.solid.mu * intact * intact;
        let some = stiffness.gt(F8::ZERO);
        let energy =
            contract(&self.stress, &self.stress) / F8::select(some, stiffness, F8::splat(1.0));
        F8::select(some, body.cell_volume * energy, F8::ZERO)
    }

    /// Shear stress and plastic flow; the heat of the flow.
    #[inline(always)]
    fn shear(
        &mut self,
        body: &Body,
        motion: &Kinematics,
        (theta, intact, dt): (F8, F8, f64),
    ) -> F8 {
        let total = motion.shear_strain();
        let before = self.plastic;
        let old_stress = self.stress;
        let load =
            Load { modulus: 2.0 * body.solid.mu * intact, intact, theta, live: self.live, dt };
        let mut plastic = Plastic {
            plastic: &mut self.plastic,
            strain: &mut self.strain,
            flow: &mut self.flow,
            rate: &mut self.rate,
        };
        self.stress = body.solid.flow(&total, &mut plastic, &load);
        self.piola = motion.piola(&self.stress, body);
        let step: Sym = std::array::from_fn(|k| self.plastic[k] - before[k]);
        let mean: Sym = std::array::from_fn(|k| 0.5 * (self.stress[k] + old_stress[k]));
        body.cell_volume * contract(&mean, &step)
    }

    /// Viscosity (51)-(53) and conduction (56)-(57) between the centroid and the corners. Returns the
    /// largest closing speed over the sound speed.
    #[inline(always)]
    fn bond(
        &mut self,
        y: &[V3; 9],
        (body, laws, read): (&Body, &Laws, &Read<'_>),
        (theta, live): (&[F8; 9], M8),
        (force, heat): (&mut [V3; 9], &mut [F8; 9]),
    ) -> f64 {
        let v = self.gather_vector(read.velocity);
        let sound = self.gather(read.sound);
        let area = (0.5 * body.cell_volume).powf(2.0 / 3.0);
        let half = 0.5 * laws.visc_linear * body.rho_0 * area;
        let conduct = 0.5 * laws.heat_coeff * body.rho_0 * area * body.eos.c_v() * laws.dt;
        let reach = body.length * body.length;
        let mut closing = F8::ZERO;
        for slot in 0..8 {
            let r = sub(&y[slot], &y[CENTRE]);
            let w = sub(&v[slot], &v[CENTRE]);
            let square = dot(&r, &r);
            let approach = (-dot(&r, &w)).max(F8::ZERO);
            let inverse = 1.0 / square;
            let near = F8::select(square.lt(F8::splat(reach)), F8::splat(1.0), F8::ZERO);
            let near = F8::select(live, near, F8::ZERO);
            let pair = sound[slot] + sound[CENTRE];
            let speed = approach * inverse.sqrt();
            let nu = half * near * (pair + (2.0 * laws.visc_quad) * speed);
            let bond = nu * approach * inverse;
            self.bonds[slot] = bond;
            closing = closing.max(near * speed / pair.max(F8::splat(1e-300)));
            for d in 0..3 {
                let f = bond * r[d];
                force[slot][d] += f;
                force[CENTRE][d] -= f;
            }
            if laws.heat_coeff > 0.0 {
                let flux = conduct * near * pair * (theta[slot] - theta[CENTRE]);
                heat[slot] -= flux;
                heat[CENTRE] += flux;
            }
        }
        -(-closing).least()
    }

    /// Second pass: volume rates, the viscous heat of the bonds, and the power of the elements' own
    /// forces, all over the mean velocity of the step. Returns that power.
    #[inline(always)]
    pub fn work<const VOLUMES: bool>(
        &self,
        body: &Body,
        (displacement, mean, dt): ([&[f64]; 3], [&[f64]; 3], f64),
        sink: &mut Sink<'_>,
    ) -> F8 {
        let live = M8::from_bits(self.live);
        let y = self.shape(&self.gather_vector(displacement), body);
        let v = self.gather_vector(mean);
        let mut power = F8::ZERO;
        let mut rate = [F8::ZERO; 9];
        for (k, face) in FACES.into_iter().enumerate() {
            let (w, e, g) = pyramid(&y, face);
            let (dw, de, dg) = pyramid(&v, face);
            let sum =
                dot(&dw, &cross(&e, &g)) + dot(&de, &cross(&g, &w)) + dot(&dg, &cross(&w, &e));
            let sum = F8::select(live, sum * (1.0 / 6.0), F8::ZERO);
            power += self.tension[k] * sum;
            if VOLUMES {
                rate[CENTRE] += 0.5 * sum;
                for slot in face {
                    rate[slot] += 0.125 * sum;
                }
            }
        }
        if body.solid.mu > 0.0 {
            let gradient = gradient(&v, body);
            let mut shear = F8::ZERO;
            for row in 0..3 {
                for axis in 0..3 {
                    shear += self.piola[3 * row + axis] * gradient[axis][row];
                }
            }
            power += F8::select(live, body.cell_volume * shear, F8::ZERO);
        }
        if VOLUMES {
            let own: [F8; 8] = std::array::from_fn(|slot| rate[slot]);
            self.scatter(&own, sink.nodes.volume_rate, sink.first_node);
            self.scatter_centre(rate[CENTRE], sink.centres.volume_rate, sink.first_centre);
            let mut heat = [F8::ZERO; 9];
            for slot in 0..8 {
                let r = sub(&y[slot], &y[CENTRE]);
                let w = sub(&v[slot], &v[CENTRE]);
                let half = -0.5 * dt * self.bonds[slot] * dot(&r, &w);
                heat[slot] = half;
                heat[CENTRE] += half;
            }
            let own: [F8; 8] = std::array::from_fn(|slot| heat[slot]);
            self.scatter(&own, sink.nodes.heat, sink.first_node);
            self.scatter_centre(heat[CENTRE], sink.centres.heat, sink.first_centre);
        }
        power
    }

    /// Energy stored by lane: in shear (24), from the stress of the last step, and in tension (25).
    #[must_use]
    pub fn stored(&self, body: &Body) -> (F8, F8) {
        let intact = 1.0 - self.damage;
        let mut tension = F8::ZERO;
        let stiffness = F8::splat(body.solid.bulk) * intact;
        for k in 0..6 {
            let some = stiffness.gt(F8::ZERO);
            let energy =
                self.tension[k] * self.tension[k] / F8::select(some, stiffness, F8::splat(1.0));
            tension += F8::select(some, 0.5 * body.pyramids[k] * energy, F8::ZERO);
        }
        let live = M8::from_bits(self.live);
        let keep = |x: F8| F8::select(live, x, F8::ZERO);
        (keep(self.shear_energy(body) * intact), keep(tension))
    }
}

/// Energy of the pyramids in tension, damage apart.
#[inline(always)]
fn tension_energy(body: &Body, opening: &[F8; 6]) -> F8 {
    let mut energy = F8::ZERO;
    for (k, o) in opening.iter().enumerate() {
        let open = o.max(F8::ZERO);
        energy += 0.5 * body.solid.bulk * body.pyramids[k] * open * open;
    }
    energy
}

/// Gradient of a corner field along the lattice axes, one vector an axis: one-point integration.
#[inline(always)]
fn gradient(u: &[V3; 9], body: &Body) -> [V3; 3] {
    let mut out = [[F8::ZERO; 3]; 3];
    for d in 0..3 {
        let s = |slot: usize| u[slot][d];
        // Sums and differences along the fast axis serve all three.
        let plus = [s(1) + s(0), s(3) + s(2), s(5) + s(4), s(7) + s(6)];
        let minus = [s(1) - s(0), s(3) - s(2), s(5) - s(4), s(7) - s(6)];
        let size = body.lattice.size;
        out[0][d] = ((minus[0] + minus[1]) + (minus[2] + minus[3])) * (0.25 / size[0]);
        out[1][d] = ((plus[1] - plus[0]) + (plus[3] - plus[2])) * (0.25 / size[1]);
        out[2][d] = ((plus[2] - plus[0]) + (plus[3] - plus[1])) * (0.25 / size[2]);
    }
    out
}

/// Deformation of up to eight elements, Eqs. (14)-(15), in lattice axes.
struct Kinematics {
    /// `F`, row by row.
    f: [F8; 9],
    /// Cofactors of `F`, row by row.
    cofactor: [F8; 9],
    /// `F^T F`.
    c: Sym,
    /// `J = det F`.
    jacobian: F8,
    /// `J^(-1/3)`.
    root: F8,
}

impl Kinematics {
    #[inline(always)]
    fn new(u: &[V3; 9], body: &Body) -> Self {
        let along = gradient(u, body);
        let axes = &body.lattice.axes;
        let mut f = [F8::ZERO; 9];
        for (row, axis) in axes.iter().enumerate() {
            for column in 0..3 {
                let g = &along[column];
                let b = axis[0] * g[0] + axis[1] * g[1] + axis[2] * g[2];
                f[3 * row + column] = b + if row == column { 1.0 } else { 0.0 };
            }
        }
        let row = |k: usize| [f[3 * k], f[3 * k + 1], f[3 * k + 2]];
        let (a, b, c) = (row(0), row(1), row(2));
        let (bc, ca, ab) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
        let jacobian = dot(&a, &bc);
        let column = |i: usize, j: usize| f[i] * f[j] + f[3 + i] * f[3 + j] + f[6 + i] * f[6 + j];
        Self {
            cofactor: [bc[0], bc[1], bc[2], ca[0], ca[1], ca[2], ab[0], ab[1], ab[2]],
            c: [column(0, 0), column(1, 1), column(2, 2), column(0, 1), column(0, 2), column(1, 2)],
            f,
            jacobian,
            // An inverted element has no root; it is dying, and its shear is not used.
            root: jacobian.max(F8::splat(1e-3)).inverse_cube_root(),
        }
    }

    /// `(J^(-2/3) C - I) / 2`, Eqs. (14)-(15).
    #[inline(always)]
    fn shear_strain(&self) -> Sym {
        let q = 0.5 * self.root * self.root;
        std::array::from_fn(|k| q * self.c[k] - if k < 3 { 0.5 } else { 0.0 })
    }

    /// Mean squared stretch without the volume, times the compression's.
    #[inline(always)]
    fn stretch_squared(&self) -> F8 {
        let q = self.root * self.root;
        let mean = q * (self.c[0] + self.c[1] + self.c[2]) * (1.0 / 3.0);
        mean * q.max(F8::splat(1.0))
    }

    /// First Piola-Kirchhoff stress of the shear energy, rows turned to global axes.
    #[inline(always)]
    fn piola(&self, s: &Sym, body: &Body) -> [F8; 9] {
        let q = self.root * self.root;
        let third = contract(s, &self.c) * (1.0 / 3.0) / self.jacobian;
        let full = [s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2]];
        let mut own = [F8::ZERO; 9];
        for row in 0..3 {
            for column in 0..3 {
                let f = &self.f[3 * row..3 * row + 3];
                let fs = f[0] * full[column] + f[1] * full[3 + column] + f[2] * full[6 + column];
                own[3 * row + column] = q * (fs - third * self.cofactor[3 * row + column]);
            }
        }
        let axes = &body.lattice.axes;
        std::array::from_fn(|k| {
            let (row, column) = (k / 3, k % 3);
            axes[0][row] * own[column]
                + axes[1][row] * own[3 + column]
                + axes[2][row] * own[6 + column]
        })
    }

    /// Adds the corner forces of the shear stress, `-V_o P grad N`.
    #[inline(always)]
    fn forces(&self, piola: &[F8; 9], body: &Body, live: M8, force: &mut [V3; 9]) {
        let size = body.lattice.size;
        for d in 0..3 {
            let along: [F8; 3] = std::array::from_fn(|axis| {
                let scale = -0.25 * body.cell_volume / size[axis];
                F8::select(live, scale * piola[3 * d + axis], F8::ZERO)
            });
            let (plus, minus) = (along[1] + along[0], along[1] - along[0]);
            let (up, down) = (along[2], -along[2]);
            force[0][d] += down - plus;
            force[1][d] += down - minus;
            force[2][d] += down + minus;
            force[3][d] += down + plus;
            force[4][d] += up - plus;
            force[5][d] += up - minus;
            force[6][d] += up + minus;
            force[7][d] += up + plus;
        }
    }
}
