//! Hexahedra, eight at a time: shear (24), tension (25), pressure of the volumes, and the viscosity
//! and conduction of their bonds.
//!
//! A cell has nine particles: slot `b1 + 2 b2 + 4 b3` for the corner with these bits along the fast,
//! mid and slow axes, and the centroid. Everything is computed from displacements relative to the
//! translation of the body, so that a body at rest in its own frame is exactly free of force.
//!
//! The potential depends on positions through (27), damage and plastic strain: (28). Its gradient by
//! positions is the force `g` of (29) and (63). That by damage and plastic strain, (66), is met by the
//! constraints alone: with the multiplier 1 of the energy (70) and shares that sum to one, those of
//! (71)-(73) are zero, and neither exerts a force.

use super::columns::{AllSlices, SumsSlices};
use super::hourglass::Hourglass;
use super::lanes::{F8, LANES, Lanes, Mask, each};
use super::mesh::{Body, Group};
use super::method::Method;
use super::strength::{Flowing, Load, Sym, contract};
use crate::method::Viscosity;

/// Corners A, B, C, D of the pyramids' outer faces, seen from outside against the clock.
pub const FACES: [[usize; 4]; 6] =
    [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];

/// Slot of the centroid.
const CENTRE: usize = 8;

/// Smallest pyramid, over its share of the cell, to which the elastic pressure rises.
const SLIVER: f64 = 0.25;

/// Steepness of the damping of receding bonds: it is whole from where the closing neighbours, over the
/// bond's own jump, reach half the inverse of this and of the limiter's.
const RINGING: f64 = 4.0;

/// Expansion at which a failed element ceases to count as a volume.
const OPEN: f64 = 1.2;

type V3<F> = [F; 3];

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
    /// Densities.
    pub rho: &'a [f64],
}

/// Columns of the particles of a chunk that a pass writes to.
#[derive(Debug)]
pub struct Sink<C> {
    /// Of its nodes.
    pub nodes: C,
    /// Of its centroids.
    pub centres: C,
    /// First node.
    pub first_node: usize,
    /// First centroid.
    pub first_centre: usize,
}

/// What the elements of a scene have in common.
#[derive(Debug, Clone, Copy)]
pub struct Laws {
    /// Numerical choices.
    pub method: Method,
    /// Whether elements carry the pressure of their particles.
    pub volumes: bool,
    /// Length of the last step.
    pub dt: f64,
}

/// What elements ask of the time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Largest inverse of the longest stable step.
    pub rate: f64,
    /// Whether an element is to die after the step.
    pub dying: bool,
    /// Heat of plastic flow and damage, Eq. (61).
    pub heat: f64,
}

impl Demand {
    /// Of nothing.
    pub const NONE: Self = Self { rate: 0.0, dying: false, heat: 0.0 };

    /// The stricter.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            rate: self.rate.max(other.rate),
            dying: self.dying || other.dying,
            heat: self.heat + other.heat,
        }
    }
}

#[inline(always)]
fn sub<F: Lanes>(a: &V3<F>, b: &V3<F>) -> V3<F> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot<F: Lanes>(a: &V3<F>, b: &V3<F>) -> F {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<F: Lanes>(a: &V3<F>, b: &V3<F>) -> V3<F> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A pyramid from the centroid to a face.
#[derive(Debug, Clone, Copy)]
struct Pyramid<F> {
    /// From the centroid to the middle of the face.
    w: V3<F>,
    /// Diagonals of the face.
    e: V3<F>,
    g: V3<F>,
    /// Twice the area of the face, outwards.
    area: V3<F>,
    /// Volume over the reference volume, less one, times the reference volume.
    growth: F,
}

impl<F: Lanes> Pyramid<F> {
    #[inline(always)]
    fn nothing() -> Self {
        let none = [F::zero(); 3];
        Self { w: none, e: none, g: none, area: none, growth: F::zero() }
    }

    #[inline(always)]
    fn new(y: &[V3<F>; 9], [a, b, c, d]: [usize; 4], reference: f64) -> Self {
        let mut w = [F::zero(); 3];
        for (k, w) in w.iter_mut().enumerate() {
            *w = ((y[a][k] + y[b][k]) + (y[c][k] + y[d][k])) * 0.25 - y[CENTRE][k];
        }
        let (e, g) = (sub(&y[c], &y[a]), sub(&y[d], &y[b]));
        let area = cross(&e, &g);
        // Exact for the bilinear face; nothing where nothing has moved.
        let growth = dot(&w, &area) * (1.0 / 6.0) - reference;
        Self { w, e, g, area, growth }
    }

    /// Rate of the volume.
    #[inline(always)]
    fn rate(&self, v: &[V3<F>; 9], face: [usize; 4]) -> F {
        let [a, b, c, d] = face;
        let mut w = [F::zero(); 3];
        for (k, w) in w.iter_mut().enumerate() {
            *w = ((v[a][k] + v[b][k]) + (v[c][k] + v[d][k])) * 0.25 - v[CENTRE][k];
        }
        let (e, g) = (sub(&v[c], &v[a]), sub(&v[d], &v[b]));
        let turned = dot(&e, &cross(&self.g, &self.w)) + dot(&g, &cross(&self.w, &self.e));
        (dot(&w, &self.area) + turned) * (1.0 / 6.0)
    }

    /// Square of the gradient of the volume, each particle's part over its share of the cell's mass.
    #[inline(always)]
    fn steepness(&self) -> F {
        let (gw, we) = (cross(&self.g, &self.w), cross(&self.w, &self.e));
        dot(&self.area, &self.area) * (1.0 / 6.0) + (dot(&gw, &gw) + dot(&we, &we)) * (8.0 / 9.0)
    }

    /// Adds `push` times the gradient of the volume.
    #[inline(always)]
    fn push(&self, [a, b, c, d]: [usize; 4], push: F, force: &mut [V3<F>; 9]) {
        let sixth = push * (1.0 / 6.0);
        let (gw, we) = (cross(&self.g, &self.w), cross(&self.w, &self.e));
        for k in 0..3 {
            let fourth = self.area[k] * (sixth * 0.25);
            let (gw, we) = (gw[k] * sixth, we[k] * sixth);
            force[CENTRE][k] -= self.area[k] * sixth;
            force[a][k] += fourth - gw;
            force[c][k] += fourth + gw;
            force[b][k] += fourth - we;
            force[d][k] += fourth + we;
        }
    }
}

/// Weights of a pyramid for the corners of its own face, on top of those for all corners, and for all
/// corners.
#[inline(always)]
fn corner_weights(balance: f64) -> [f64; 2] {
    [0.125 * (1.0 + 2.0 * balance), -0.125 * balance]
}

/// Shares of nine particles in six pyramids.
#[inline(always)]
fn shares<F: Lanes>(pyramids: &[F; 6], balance: f64) -> [F; 9] {
    let [own, other] = corner_weights(balance);
    let all =
        ((pyramids[0] + pyramids[1]) + (pyramids[2] + pyramids[3])) + (pyramids[4] + pyramids[5]);
    let mut share = [all * other; 9];
    share[CENTRE] = all * 0.5;
    for (k, face) in FACES.into_iter().enumerate() {
        let part = pyramids[k] * own;
        for slot in face {
            share[slot] += part;
        }
    }
    share
}

/// Volume and faces of a cell.
#[derive(Debug, Clone, Copy)]
struct Extent<F> {
    volume: F,
    /// Square of twice the largest face.
    largest: F,
    /// Sum of the squares of twice the six faces.
    faces: F,
}

impl<F: Lanes> Extent<F> {
    #[inline(always)]
    fn new(pyramids: &[Pyramid<F>; 6], body: &Body) -> Self {
        let mut extent =
            Self { volume: F::splat(body.cell_volume), largest: F::zero(), faces: F::zero() };
        for pyramid in pyramids {
            let square = dot(&pyramid.area, &pyramid.area);
            extent.largest = extent.largest.max(square);
            extent.faces += square;
            extent.volume += pyramid.growth;
        }
        extent
    }

    /// Square of the highest frequency of the cell's pressure: `4 c^2 (A_1^2 + A_2^2 + A_3^2) / V^2`,
    /// a bound for a lattice of such cells, and met where they are thin (decision 0015).
    #[inline(always)]
    fn frequency_squared(&self, sound: &[F; 9]) -> F {
        let mut fastest = sound[CENTRE];
        for sound in &sound[..8] {
            fastest = fastest.max(*sound);
        }
        // Of three pairs of faces that come doubled.
        self.faces * fastest * fastest * 0.5 / (self.volume * self.volume)
    }
}

/// Volumes of the pyramids of a cell with these corners about its centre.
#[must_use]
pub fn pyramid_volumes(corners: &[[f64; 3]; 8]) -> [f64; 6] {
    let mut y = [[F8::ZERO; 3]; 9];
    for (slot, corner) in corners.iter().enumerate() {
        y[slot] = corner.map(F8::splat);
    }
    FACES.map(|face| Pyramid::new(&y, face, 0.0).growth.0[0])
}

/// Forces and heat of nine particles.
struct Loads<F> {
    force: [V3<F>; 9],
    heat: [F; 9],
}

impl<F: Lanes> Loads<F> {
    /// A force along a bond, on the corner and against the centroid.
    #[inline(always)]
    fn pull(&mut self, slot: usize, r: &V3<F>, bond: F) {
        for (d, r) in r.iter().enumerate() {
            let f = bond * *r;
            self.force[slot][d] += f;
            self.force[CENTRE][d] -= f;
        }
    }

    /// Heat from the corner to the centroid.
    #[inline(always)]
    fn conduct(&mut self, slot: usize, flux: F) {
        self.heat[slot] -= flux;
        self.heat[CENTRE] += flux;
    }
}

/// What the bonds of up to eight elements see of their particles.
struct Seen<'a, F> {
    y: &'a [V3<F>; 9],
    v: &'a [V3<F>; 9],
    sound: &'a [F; 9],
    theta: &'a [F; 9],
}

impl<F: Lanes> Seen<'_, F> {
    /// Separation and velocity of a corner from the centroid.
    #[inline(always)]
    fn bond(&self, slot: usize) -> (V3<F>, V3<F>) {
        (sub(&self.y[slot], &self.y[CENTRE]), sub(&self.v[slot], &self.v[CENTRE]))
    }
}

impl Group {
    /// Asks for what tells where the group's particles are.
    #[inline(always)]
    pub fn fetch<F: Lanes>(&self) {
        F::fetch(&self.rows);
        F::fetch(&self.beyond);
    }

    /// Asks for what the first pass reads and writes of the group, and for those of its particles
    /// that no group before it has touched.
    #[inline(always)]
    pub fn fetch_load<F: Lanes>(&self, read: &Read<'_>, sink: &Sink<SumsSlices<'_>>) {
        self.fetch_eights::<F>(&self.plastic);
        self.fetch_work::<F>();
        for eight in [&self.strain, &self.flow, &self.rate] {
            self.fetch_eights::<F>(std::slice::from_ref(eight));
        }
        let (node, centre) = (self.rows[3] as usize + LANES, self.centre as usize + LANES);
        for column in
            read.displacement.into_iter().chain([read.grip, read.theta, read.sound, read.rho])
        {
            F::fetch(column.get(node..).unwrap_or_default());
            F::fetch(column.get(centre..).unwrap_or_default());
        }
        for column in read.velocity {
            F::fetch(column.get(node..).unwrap_or_default());
            F::fetch(column.get(self.beyond[7] as usize + LANES..).unwrap_or_default());
        }
        let (node, centre) = (node - sink.first_node, centre - sink.first_centre);
        for (sums, at) in [(&sink.nodes, node), (&sink.centres, centre)] {
            for column in [&*sums.fx, &*sums.fy, &*sums.fz, &*sums.heat] {
                F::fetch(column.get(at..).unwrap_or_default());
            }
        }
    }

    /// Asks for what the second pass reads of the group.
    #[inline(always)]
    pub fn fetch_work<F: Lanes>(&self) {
        self.fetch_eights::<F>(&self.stress);
        self.fetch_eights::<F>(&self.bonds);
        self.fetch_eights::<F>(std::slice::from_ref(&self.damage));
    }

    #[inline(always)]
    fn fetch_eights<F: Lanes>(&self, eights: &[F8]) {
        for k in 0..eights.len() {
            F::fetch(&eights[k..]);
        }
    }

    /// A column at the nine slots.
    #[inline(always)]
    fn gather<F: Lanes>(&self, column: &[f64]) -> [F; 9] {
        let mut out = [F::zero(); 9];
        for row in 0..4 {
            let at = self.rows[row] as usize;
            let nodes = &column[at..at + LANES + 1];
            (out[2 * row], out[2 * row + 1]) = (F::load(nodes, 0), F::load(nodes, 1));
        }
        out[CENTRE] = F::load(column, self.centre as usize);
        out
    }

    /// A vector column at the nine slots.
    #[inline(always)]
    fn gather_vector<F: Lanes>(&self, columns: [&[f64]; 3]) -> [V3<F>; 9] {
        let [x, y, z] = columns;
        let (x, y, z): ([F; 9], [F; 9], [F; 9]) = (self.gather(x), self.gather(y), self.gather(z));
        each!(slot => [x[slot], y[slot], z[slot]] => [F::zero(); 3])
    }

    /// A vector column at the nine slots, from those of nodes and centroids whose first are `first`.
    #[inline(always)]
    fn gather_own<F: Lanes>(
        &self,
        nodes: [&[f64]; 3],
        centres: [&[f64]; 3],
        first: [usize; 2],
    ) -> [V3<F>; 9] {
        let mut out = [[F::zero(); 3]; 9];
        for (slot, out) in out.iter_mut().enumerate() {
            let (columns, at) = if slot == CENTRE {
                (centres, self.centre as usize - first[1])
            } else {
                (nodes, self.node(slot) - first[0])
            };
            for (out, column) in out.iter_mut().zip(columns) {
                *out = F::load_some(column, at);
            }
        }
        out
    }

    /// Adds the corners' values to a column of nodes whose first is `first`.
    #[inline(always)]
    fn scatter<F: Lanes>(&self, values: &[F; 9], to: &mut [f64], first: usize) {
        let own = Mask::MAX >> (LANES - self.lanes as usize);
        for row in 0..4 {
            let at = self.rows[row] as usize - first;
            let (low, high) = (values[2 * row].keep(own), values[2 * row + 1].keep(own));
            (low + high.shifted()).add_some(to, at);
            if let Some(last) = to.get_mut(at + LANES) {
                *last += high.pack().0[LANES - 1];
            }
        }
    }

    /// Adds the centroids' values to a column of centroids whose first is `first`.
    #[inline(always)]
    fn scatter_centre<F: Lanes>(&self, value: F, to: &mut [f64], first: usize) {
        let own = Mask::MAX >> (LANES - self.lanes as usize);
        value.keep(own).add_some(to, self.centre as usize - first);
    }

    #[inline(always)]
    fn scatter_vector<F: Lanes>(&self, values: &[V3<F>; 9], sink: &mut Sink<SumsSlices<'_>>) {
        let (nodes, centres) = (&mut sink.nodes, &mut sink.centres);
        let columns = [
            (&mut *nodes.fx, &mut *centres.fx),
            (&mut *nodes.fy, &mut *centres.fy),
            (&mut *nodes.fz, &mut *centres.fz),
        ];
        for (d, (node, centre)) in columns.into_iter().enumerate() {
            let own: [F; 9] = each!(slot => values[slot][d]);
            self.scatter(&own, node, sink.first_node);
            self.scatter_centre(own[CENTRE], centre, sink.first_centre);
        }
    }

    /// Positions of the slots about the cell's centre at the start.
    #[inline(always)]
    fn shape<F: Lanes>(&self, u: &[V3<F>; 9], body: &Body) -> [V3<F>; 9] {
        let mut y = *u;
        for (slot, corner) in body.corners.iter().enumerate() {
            for d in 0..3 {
                y[slot][d] = u[slot][d] + corner[d];
            }
        }
        y
    }

    /// First pass: forces, conduction (62) and the heat of flow and damage (61), half of it to the centroid
    /// and a sixteenth to each corner: `phi` of (60).
    #[inline(always)]
    pub fn load_particles<F: Lanes>(
        &mut self,
        body: &Body,
        laws: &Laws,
        read: &Read<'_>,
        sink: &mut Sink<SumsSlices<'_>>,
    ) -> Demand {
        let live = self.live;
        let u: [V3<F>; 9] = self.gather_vector(read.displacement);
        let y = self.shape(&u, body);
        let theta: [F; 9] = self.gather(read.theta);
        let mut loads = Loads { force: [[F::zero(); 3]; 9], heat: [F::zero(); 9] };

        let motion = Kinematics::new(&u, body);
        let mut pyramids = [Pyramid::nothing(); 6];
        for k in 0..6 {
            pyramids[k] = Pyramid::new(&y, FACES[k], body.pyramids[k]);
        }
        let opening: [F; 6] = each!(k => pyramids[k].growth * body.per_pyramid[k]);
        let corners = ((theta[0] + theta[1]) + (theta[2] + theta[3]))
            + ((theta[4] + theta[5]) + (theta[6] + theta[7]));
        let mean = theta[CENTRE] * 0.5 + corners * 0.0625;

        let extent = Extent::new(&pyramids, body);
        self.fail(body, &motion, (&opening, &extent), mean);
        let glass = Hourglass::of(&laws.method, body);
        let held = match &glass {
            Some(glass) => glass.energy(&u),
            None => F::zero(),
        };
        let mut freed = self.damage(body, (&opening, held), laws.dt);
        let intact = F::splat(1.0) - F::of(self.damage);
        let mut rate_squared = F::zero();
        if body.solid.mu > 0.0 {
            freed += self.shear(body, &motion, (mean, intact, laws.dt));
            let stress = each!(k => F::of(self.stress[k]));
            motion.forces(&stress, body, live, &mut loads.force);
            // Twice the rate at which longitudinal waves cross the cell, stretched.
            let crossing = 2.0 * body.solid.sound / body.solid.edge;
            rate_squared = motion.stretch_squared() * (crossing * crossing);
        }
        if let Some(glass) = &glass {
            glass.push(&u, intact.keep(live), &mut loads.force);
            rate_squared += F::splat(glass.rate_squared(body));
        }
        let freed = freed.keep(live);
        for slot in 0..8 {
            loads.heat[slot] = freed * 0.0625;
        }
        loads.heat[CENTRE] = freed * 0.5;

        let mut push = [F::zero(); 6];
        for k in 0..6 {
            push[k] = -tension(opening[k], intact, body).keep(live);
        }
        let mut damping = F::zero();
        if laws.volumes {
            self.carry((laws, read), &mut push);
            let v: [V3<F>; 9] = self.gather_vector(read.velocity);
            let sound: [F; 9] = self.gather(read.sound);
            rate_squared += extent.frequency_squared(&sound);
            let seen = Seen { y: &y, v: &v, sound: &sound, theta: &theta };
            damping = match laws.method.viscosity {
                Viscosity::Limited => self.limited(&seen, (body, laws, read), &mut loads),
                Viscosity::Pairwise => self.pairwise(&seen, (body, laws), &mut loads),
            };
            if self.stiff.is_some() {
                let of = (&seen, body, &laws.method);
                rate_squared += self.stiffen(&pyramids, (extent.volume, &opening), of, &mut push);
            }
        }
        for k in 0..6 {
            pyramids[k].push(FACES[k], push[k], &mut loads.force);
        }
        self.scatter_vector(&loads.force, sink);
        self.scatter(&loads.heat, sink.nodes.heat, sink.first_node);
        self.scatter_centre(loads.heat[CENTRE], sink.centres.heat, sink.first_centre);
        // The longest stable step is 2 / (lambda/2 + sqrt(lambda^2/4 + omega^2)).
        let half = damping * 0.5;
        let rate = (half + (half * half + rate_squared).sqrt()) * 0.5;
        Demand { rate: rate.keep(live).largest(), dying: self.dying != 0, heat: freed.sum() }
    }

    /// Pressure of the particles on the pyramids: half of that of the centroid, the rest of the corners
    /// of its face and, by `balance`, of the opposite face (decision 0013).
    #[inline(always)]
    fn carry<F: Lanes>(&self, (laws, read): (&Laws, &Read<'_>), push: &mut [F; 6]) {
        let grip: [F; 9] = self.gather(read.grip);
        let [own, other] = corner_weights(laws.method.balance);
        let all = ((grip[0] + grip[1]) + (grip[2] + grip[3]))
            + ((grip[4] + grip[5]) + (grip[6] + grip[7]));
        let base = grip[CENTRE] * 0.5 + all * other;
        for (push, face) in push.iter_mut().zip(FACES) {
            let corners = (grip[face[0]] + grip[face[1]]) + (grip[face[2]] + grip[face[3]]);
            *push += (base + corners * own).keep(self.live);
        }
    }

    /// What pyramids press with beside the pressure of their particles. Returns the square of the
    /// frequency that it adds.
    #[inline(always)]
    fn stiffen<F: Lanes>(
        &mut self,
        pyramids: &[Pyramid<F>; 6],
        (volume, opening): (F, &[F; 6]),
        (seen, body, method): (&Seen<'_, F>, &Body, &Method),
        push: &mut [F; 6],
    ) -> F {
        let mut own = [F::zero(); 6];
        let mut rate_squared = F::zero();
        if method.visc_volume > 0.0 {
            collapse(pyramids, opening, (seen.v, body, method), &mut own);
        }
        if body.zonal(method) > 0.0 {
            rate_squared = crowd(pyramids, (volume, opening), (seen, body, method), &mut own);
        }
        for (k, own) in own.into_iter().enumerate() {
            let own = own.keep(self.live);
            push[k] += own;
            if let Some(stiff) = &mut self.stiff {
                stiff[k] = own.pack();
            }
        }
        rate_squared
    }

    /// Marks lanes that fail, and those that cease to be volumes after this step.
    #[inline(always)]
    fn fail<F: Lanes>(
        &mut self,
        body: &Body,
        motion: &Kinematics<F>,
        (opening, extent): (&[F; 6], &Extent<F>),
        theta: F,
    ) {
        let solid = &body.solid;
        let mut smallest = opening[0];
        let mut widest = opening[0];
        for o in &opening[1..] {
            smallest = smallest.min(*o);
            widest = widest.max(*o);
        }
        let crushed = smallest.lt(F::splat(solid.crushed - 1.0))
            | extent.volume.lt(F::splat(solid.least * body.cell_volume))
            | motion.jacobian.lt(F::splat(solid.compression));
        let tension = (F::splat(1.0) - F::of(self.damage)) * solid.bulk * widest;
        let pulled = tension.gt(F::splat(solid.spall));
        let failing = solid.spent(F::of(self.strain), theta) | crushed | pulled;
        self.failed |= failing & self.live;
        let stretched = motion.stretch_squared().gt(F::splat(solid.torn * solid.torn));
        let open = motion.jacobian.gt(F::splat(OPEN)) & self.failed;
        // Faces come doubled.
        let [sound, failed] = solid.flat.map(|share| (0.5 * share * solid.edge).powi(2));
        let least = F::select(self.failed, F::splat(failed), F::splat(sound));
        let flat = (extent.volume * extent.volume).lt(extent.largest * least);
        self.dying = (crushed | stretched | open | flat) & self.live;
        self.failed |= self.dying;
    }

    /// Damage of failed lanes, Eqs. (47), (49)-(50), and the energy that it sets free, (31) times the step
    /// of the damage. A dying element loses all of its strength at once, so that no stored energy is left
    /// in it.
    #[inline(always)]
    fn damage<F: Lanes>(&mut self, body: &Body, (opening, held): (&[F; 6], F), dt: f64) -> F {
        if self.failed & self.live == 0 {
            return F::zero();
        }
        let one = F::splat(1.0);
        let before = F::of(self.damage);
        let step = F::select(self.dying, one, F::splat(body.solid.damage_step(dt)));
        let after = F::select(self.failed & self.live, (before + step).min(one), before);
        let stored = self.shear_energy::<F>(body) + tension_energy(body, opening) + held;
        let released = stored * (after - before);
        let left = (one - after) / (one - before).max(F::splat(1e-300));
        for stress in &mut self.stress {
            *stress = (F::of(*stress) * left).pack();
        }
        self.damage = after.pack();
        released
    }

    /// Shear energy per damage, `Gamma^d` of Eq. (31), from the stress of the last step.
    #[inline(always)]
    fn shear_energy<F: Lanes>(&self, body: &Body) -> F {
        let intact = F::splat(1.0) - F::of(self.damage);
        let stiffness = intact * intact * (4.0 * body.solid.mu);
        let some = stiffness.gt(F::zero());
        let stress: Sym<F> = each!(k => F::of(self.stress[k]));
        let energy = contract(&stress, &stress) / F::select(some, stiffness, F::splat(1.0));
        (energy * body.cell_volume).keep(some)
    }

    /// Shear stress (30) and plastic flow (48); the heat of the flow, the last term of Eq. (61), by the mean
    /// stress of the step.
    #[inline(always)]
    fn shear<F: Lanes>(
        &mut self,
        body: &Body,
        motion: &Kinematics<F>,
        (theta, intact, dt): (F, F, f64),
    ) -> F {
        let total = motion.shear_strain();
        let before: Sym<F> = each!(k => F::of(self.plastic[k]));
        let old: Sym<F> = each!(k => F::of(self.stress[k]));
        let mut plastic = before;
        let modulus = intact * (2.0 * body.solid.mu);
        let load = Load { modulus, intact, theta, live: self.live, dt };
        let mut own =
            Flowing { strain: &mut self.strain, flow: &mut self.flow, rate: &mut self.rate };
        let stress = body.solid.flow(&total, &mut plastic, &mut own, &load);
        let step: Sym<F> = each!(k => plastic[k] - before[k]);
        let mut flowed = 0;
        for k in 0..6 {
            self.stress[k] = stress[k].pack();
            flowed |= step[k].lt(F::zero()) | step[k].gt(F::zero());
        }
        // Most elements do not flow, and what does not change need not be written.
        if flowed == 0 {
            return F::zero();
        }
        for (own, plastic) in self.plastic.iter_mut().zip(plastic) {
            *own = plastic.pack();
        }
        let mean: Sym<F> = each!(k => (stress[k] + old[k]) * 0.5);
        contract(&mean, &step) * body.cell_volume
    }

    /// Viscosity (51)-(53) and conduction (56)-(57) as printed, between the centroid and the corners.
    /// Returns the rate of damping.
    #[inline(always)]
    fn pairwise<F: Lanes>(
        &mut self,
        seen: &Seen<'_, F>,
        (body, laws): (&Body, &Laws),
        loads: &mut Loads<F>,
    ) -> F {
        let method = &laws.method;
        let impedance = body.rho_0 * body.bond_areas[1];
        let half = 0.5 * method.visc_linear * impedance;
        let conduct = 0.5 * method.heat_coeff * impedance * body.eos.c_v() * laws.dt;
        let reach = F::splat(body.length * body.length);
        let mut most = F::zero();
        for slot in 0..8 {
            let (r, w) = seen.bond(slot);
            let square = dot(&r, &r).max(F::splat(f64::MIN_POSITIVE));
            let near = square.lt(reach) & self.live;
            let approach = (-dot(&r, &w)).max(F::zero()).keep(near);
            let inverse = F::splat(1.0) / square;
            let pair = if body.solid.bulk > 0.0 {
                F::splat(2.0 * body.sound())
            } else {
                seen.sound[slot] + seen.sound[CENTRE]
            };
            let speed = approach * inverse.sqrt();
            let nu = (pair + speed * (2.0 * method.visc_quad)) * half;
            let bond = nu * approach * inverse;
            self.bonds[slot] = bond.pack();
            most = most.max(nu);
            loads.pull(slot, &r, bond);
            if conduct > 0.0 {
                let difference = seen.theta[slot] - seen.theta[CENTRE];
                loads.conduct(slot, (pair * difference).keep(near) * conduct);
            }
        }
        most * body.damping()
    }

    /// Viscosity on what neighbouring jumps along the diagonal do not explain, and the heat flux in
    /// shocks (decision 0013). Returns the rate of damping.
    #[inline(always)]
    fn limited<F: Lanes>(
        &mut self,
        seen: &Seen<'_, F>,
        (body, laws, read): (&Body, &Laws, &Read<'_>),
        loads: &mut Loads<F>,
    ) -> F {
        let method = &laws.method;
        let zero = F::zero();
        let area = body.bond_areas[0];
        let conduct = method.heat_coeff * area * body.eos.c_v() * laws.dt;
        let rho: [F; 9] = self.gather(read.rho);
        let mut most = zero;
        for slot in 0..8 {
            let (r, w) = seen.bond(slot);
            // The centroid of a dead element may lie on a corner.
            let inverse = F::splat(1.0) / dot(&r, &r).max(F::splat(f64::MIN_POSITIVE));
            // Jumps times the separation: of the bond, of the one before and of the one beyond.
            let own = -dot(&r, &w);
            let before = dot(&r, &sub(&seen.v[7 - slot], &seen.v[CENTRE]));
            let at = self.beyond[slot] as usize;
            let mut next = [
                F::load(read.velocity[0], at),
                F::load(read.velocity[1], at),
                F::load(read.velocity[2], at),
            ];
            if self.mirrored[slot] != 0 {
                for (d, next) in next.iter_mut().enumerate() {
                    *next = if self.mirrored[slot] >> d & 1 == 1 { -*next } else { *next };
                }
            }
            let beyond = dot(&r, &sub(&seen.v[slot], &next)).keep(self.has_beyond[slot]);
            let (behind, ahead) = (before * own, beyond * own);
            let mean = before * beyond * method.limiter / ((before + beyond) * own);
            let explained = mean.min(F::splat(1.0)).keep(behind.gt(zero) & ahead.gt(zero));
            // What recedes is damped only as far as both neighbours close: it rings, and does not flow.
            let rings = (mean * -RINGING).min(F::splat(1.0)).keep(behind.lt(zero) & ahead.lt(zero));
            let part = F::select(own.gt(zero), F::splat(1.0) - explained, rings);
            let jump = (own * part).keep(self.live);
            let speed = jump * inverse.sqrt();
            let closing = speed.gt(zero);
            let sound = (seen.sound[slot] + seen.sound[CENTRE]) * 0.5;
            let mass = (rho[slot] + rho[CENTRE]) * (0.5 * area);
            let steep = speed * (method.visc_quad * body.slope);
            let linear = sound * method.visc_linear;
            let shock = steep + (steep * steep + linear * linear).sqrt();
            let nu = mass * F::select(closing, shock, sound * method.visc_expansion);
            let bond = nu * jump * inverse;
            self.bonds[slot] = bond.pack();
            // A bond that pulls at nothing damps nothing: material at rest asks for no shorter step.
            most = most.max(nu.keep(closing | speed.lt(zero)));
            loads.pull(slot, &r, bond);
            if conduct > 0.0 {
                let difference = seen.theta[slot] - seen.theta[CENTRE];
                loads.conduct(slot, mass * speed.max(zero) * (difference * (conduct / area)));
            }
        }
        most * body.damping()
    }

    /// Second pass: volumes and, all over the mean velocity of the step, their rates, which take the place
    /// of Eq. (36) in the pressure work (59), the viscous heat of Eq. (60), half to either particle, and the
    /// power of the elements' own forces. Returns that power.
    #[inline(always)]
    pub fn work<F: Lanes>(&self, body: &Body, laws: &Laws, sink: &mut Sink<AllSlices<'_>>) -> f64 {
        let first = [sink.first_node, sink.first_centre];
        let (nodes, centres) = (&mut sink.nodes, &mut sink.centres);
        let u: [V3<F>; 9] =
            self.gather_own(nodes.0.displacement(), centres.0.displacement(), first);
        let y = self.shape(&u, body);
        let v: [V3<F>; 9] = self.gather_own(nodes.2.mean(), centres.2.mean(), first);
        let intact = F::splat(1.0) - F::of(self.damage);
        let mut power = F::zero();
        let (mut growths, mut rates) = ([F::zero(); 6], [F::zero(); 6]);
        for (k, face) in FACES.into_iter().enumerate() {
            let pyramid = Pyramid::new(&y, face, body.pyramids[k]);
            let opening = pyramid.growth * body.per_pyramid[k];
            growths[k] = pyramid.growth.keep(self.live);
            let rate = pyramid.rate(&v, face).keep(self.live);
            power += tension(opening, intact, body) * rate;
            rates[k] = rate;
        }
        if let Some(glass) = Hourglass::of(&laws.method, body) {
            power += (glass.power(&u, &v) * intact).keep(self.live);
        }
        if body.solid.mu > 0.0 {
            let stress = each!(k => F::of(self.stress[k]));
            let piola = Kinematics::new(&u, body).piola(&stress, body);
            let gradient = gradient(&v, body);
            let mut shear = F::zero();
            for row in 0..3 {
                for (axis, gradient) in gradient.iter().enumerate() {
                    shear += piola[3 * row + axis] * gradient[row];
                }
            }
            power += (shear * body.cell_volume).keep(self.live);
        }
        if laws.volumes {
            // The particles have the same shares in the volumes as in the pressure on them.
            let share = shares(&growths, laws.method.balance);
            self.scatter(&share, nodes.2.volume, first[0]);
            self.scatter_centre(share[CENTRE], centres.2.volume, first[1]);
            let share = shares(&rates, laws.method.balance);
            self.scatter(&share, nodes.2.volume_rate, first[0]);
            self.scatter_centre(share[CENTRE], centres.2.volume_rate, first[1]);
            let mut heat = [F::zero(); 9];
            for slot in 0..8 {
                let r = sub(&y[slot], &y[CENTRE]);
                let w = sub(&v[slot], &v[CENTRE]);
                let half = F::of(self.bonds[slot]) * dot(&r, &w) * (-0.5 * laws.dt);
                heat[slot] = half;
                heat[CENTRE] += half;
            }
            if let Some(stiff) = &self.stiff {
                for (k, face) in FACES.into_iter().enumerate() {
                    let warmth = F::of(stiff[k]) * rates[k] * -laws.dt;
                    heat[CENTRE] += warmth * 0.5;
                    for slot in face {
                        heat[slot] += warmth * 0.125;
                    }
                }
            }
            self.scatter(&heat, nodes.2.heat, first[0]);
            self.scatter_centre(heat[CENTRE], centres.2.heat, first[1]);
        }
        power.sum()
    }

    /// Energy stored by lane: in shear (24), from the stress of the last step, in tension (25) and in
    /// hourglass modes, at the positions before the last drift, which was of length `dt`.
    #[must_use]
    pub fn stored(
        &self,
        body: &Body,
        (displacement, velocity): ([&[f64]; 3], [&[f64]; 3]),
        (method, dt): (&Method, f64),
    ) -> [F8; 3] {
        let mut u: [V3<F8>; 9] = self.gather_vector(displacement);
        let v: [V3<F8>; 9] = self.gather_vector(velocity);
        for (u, v) in u.iter_mut().zip(&v) {
            *u = sub(u, &v.map(|v| v * dt));
        }
        let y = self.shape(&u, body);
        let opening =
            each!(k => Pyramid::new(&y, FACES[k], body.pyramids[k]).growth * body.per_pyramid[k]);
        let intact = F8::splat(1.0) - self.damage;
        let (shear, tension) = (self.shear_energy::<F8>(body), tension_energy(body, &opening));
        let glass = Hourglass::of(method, body).map_or(F8::ZERO, |glass| glass.energy(&u));
        [shear, tension, glass].map(|energy| (energy * intact).keep(self.live))
    }
}

/// Viscous pressure of pyramids that collapse: `rho q w^2` with the closing speed `w` over their
/// height (decision 0013).
#[inline(always)]
fn collapse<F: Lanes>(
    pyramids: &[Pyramid<F>; 6],
    opening: &[F; 6],
    (v, body, method): (&[V3<F>; 9], &Body, &Method),
    own: &mut [F; 6],
) {
    let factor = 9.0 * method.visc_volume * body.rho_0;
    for (k, face) in FACES.into_iter().enumerate() {
        let closing = (-pyramids[k].rate(v, face)).max(F::zero());
        let volume = (opening[k] + 1.0).max(F::splat(0.05));
        let area = dot(&pyramids[k].area, &pyramids[k].area).max(F::splat(f64::MIN_POSITIVE));
        own[k] += closing * closing / area * factor / (volume * volume);
    }
}

/// Elastic pressure of pyramids of gas that are denser than their cell, `rho c^2 (V_k / V - 1)` with
/// the volume `V` of a pyramid and its share `V_k` of the cell (decision 0017). Returns the square of
/// its frequency.
#[inline(always)]
fn crowd<F: Lanes>(
    pyramids: &[Pyramid<F>; 6],
    (volume, opening): (F, &[F; 6]),
    (seen, body, method): (&Seen<'_, F>, &Body, &Method),
    own: &mut [F; 6],
) -> F {
    let mass = body.rho_0 * body.cell_volume;
    let volume = volume.max(F::splat(body.solid.least * body.cell_volume));
    let corners = ((seen.sound[0] + seen.sound[1]) + (seen.sound[2] + seen.sound[3]))
        + ((seen.sound[4] + seen.sound[5]) + (seen.sound[6] + seen.sound[7]));
    let sound = seen.sound[CENTRE] * 0.5 + corners * 0.0625;
    let modulus = sound * sound * (mass * body.zonal(method)) / volume;
    let mut fastest = F::zero();
    for k in 0..6 {
        let even = volume * (body.pyramids[k] / body.cell_volume);
        let thick = ((opening[k] + 1.0) * body.pyramids[k]).max(even * SLIVER);
        own[k] += modulus * (even / thick - 1.0);
        fastest = fastest.max(pyramids[k].steepness() * modulus * even / (thick * thick));
    }
    // Two opposite pyramids act on the same particles.
    fastest * (2.0 / mass)
}

/// Tension of a pyramid, Eq. (25), with the bracket (26).
#[inline(always)]
fn tension<F: Lanes>(opening: F, intact: F, body: &Body) -> F {
    intact * body.solid.bulk * opening.max(F::zero())
}

/// Energy of the pyramids in tension, damage apart.
#[inline(always)]
fn tension_energy<F: Lanes>(body: &Body, opening: &[F; 6]) -> F {
    let mut energy = F::zero();
    for (k, o) in opening.iter().enumerate() {
        let open = o.max(F::zero());
        energy += open * open * (0.5 * body.solid.bulk * body.pyramids[k]);
    }
    energy
}

/// Gradient of a corner field along the lattice axes, one vector an axis: one-point integration.
#[inline(always)]
fn gradient<F: Lanes>(u: &[V3<F>; 9], body: &Body) -> [V3<F>; 3] {
    let mut out = [[F::zero(); 3]; 3];
    let size = body.lattice.size;
    for d in 0..3 {
        let s = |slot: usize| u[slot][d];
        // Sums and differences along the fast axis serve all three.
        let plus = [s(1) + s(0), s(3) + s(2), s(5) + s(4), s(7) + s(6)];
        let minus = [s(1) - s(0), s(3) - s(2), s(5) - s(4), s(7) - s(6)];
        out[0][d] = ((minus[0] + minus[1]) + (minus[2] + minus[3])) * (0.25 / size[0]);
        out[1][d] = ((plus[1] - plus[0]) + (plus[3] - plus[2])) * (0.25 / size[1]);
        out[2][d] = ((plus[2] - plus[0]) + (plus[3] - plus[1])) * (0.25 / size[2]);
    }
    out
}

/// Deformation of up to eight elements, Eqs. (14)-(15), in lattice axes.
struct Kinematics<F> {
    /// `F`, row by row.
    f: [F; 9],
    /// Cofactors of `F`, row by row.
    cofactor: [F; 9],
    /// `F^T F`.
    c: Sym<F>,
    /// `J = det F`.
    jacobian: F,
    /// `J^(-1/3)`.
    root: F,
}

/// `F^T F`.
#[inline(always)]
fn right_cauchy_green<F: Lanes>(f: &[F; 9]) -> Sym<F> {
    let mut c = [F::zero(); 6];
    for (c, [i, j]) in c.iter_mut().zip([[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]]) {
        *c = f[i] * f[j] + f[3 + i] * f[3 + j] + f[6 + i] * f[6 + j];
    }
    c
}

impl<F: Lanes> Kinematics<F> {
    #[inline(always)]
    fn new(u: &[V3<F>; 9], body: &Body) -> Self {
        let along = gradient(u, body);
        let mut f = [F::zero(); 9];
        for (row, axis) in body.lattice.axes.iter().enumerate() {
            for column in 0..3 {
                let g = &along[column];
                let b = g[0] * axis[0] + g[1] * axis[1] + g[2] * axis[2];
                f[3 * row + column] = b + if row == column { 1.0 } else { 0.0 };
            }
        }
        let (a, b, c) = ([f[0], f[1], f[2]], [f[3], f[4], f[5]], [f[6], f[7], f[8]]);
        let (bc, ca, ab) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
        let jacobian = dot(&a, &bc);
        Self {
            cofactor: [bc[0], bc[1], bc[2], ca[0], ca[1], ca[2], ab[0], ab[1], ab[2]],
            c: right_cauchy_green(&f),
            f,
            jacobian,
            // An inverted element has no root; it is dying, and its shear is not used.
            root: jacobian.max(F::splat(1e-3)).inverse_cube_root(),
        }
    }

    /// `(J^(-2/3) C - I) / 2`, Eqs. (14)-(15).
    #[inline(always)]
    fn shear_strain(&self) -> Sym<F> {
        let q = self.root * self.root * 0.5;
        each!(k => q * self.c[k] - if k < 3 { 0.5 } else { 0.0 })
    }

    /// Mean squared stretch without the volume, times the compression's.
    #[inline(always)]
    fn stretch_squared(&self) -> F {
        let q = self.root * self.root;
        let mean = q * (self.c[0] + self.c[1] + self.c[2]) * (1.0 / 3.0);
        mean * q.max(F::splat(1.0))
    }

    /// First Piola-Kirchhoff stress of the shear energy (24) by the strain (14)-(16), rows turned to global
    /// axes.
    #[inline(always)]
    fn piola(&self, s: &Sym<F>, body: &Body) -> [F; 9] {
        let q = self.root * self.root;
        let third = contract(s, &self.c) * (1.0 / 3.0) / self.jacobian;
        let full = [s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2]];
        let axes = &body.lattice.axes;
        let mut out = [F::zero(); 9];
        for column in 0..3 {
            let mut own = [F::zero(); 3];
            for (row, own) in own.iter_mut().enumerate() {
                let f = &self.f[3 * row..3 * row + 3];
                let fs = f[0] * full[column] + f[1] * full[3 + column] + f[2] * full[6 + column];
                *own = q * (fs - third * self.cofactor[3 * row + column]);
            }
            for row in 0..3 {
                out[3 * row + column] =
                    own[0] * axes[0][row] + own[1] * axes[1][row] + own[2] * axes[2][row];
            }
        }
        out
    }

    /// Adds the corner forces of the shear stress, `-V_o P grad N`.
    #[inline(always)]
    fn forces(&self, stress: &Sym<F>, body: &Body, live: Mask, force: &mut [V3<F>; 9]) {
        let size = body.lattice.size;
        let piola = self.piola(stress, body);
        for d in 0..3 {
            let mut along = [F::zero(); 3];
            for (axis, along) in along.iter_mut().enumerate() {
                let scale = -0.25 * body.cell_volume / size[axis];
                *along = (piola[3 * d + axis] * scale).keep(live);
            }
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
