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

mod bonds;
mod drag;
mod kinematics;
mod particles;
mod pressure;
mod pyramid;
mod resistance;
mod skew;
mod symmetric;

pub use self::pyramid::{corner_volumes, pyramid_volumes};
pub use self::skew::factors as skew_factors;

use self::bonds::{Loads, Seen};
use self::drag::Warp;
use self::kinematics::{Kinematics, shear_power};
use self::pyramid::{Extent, Pyramid, shares, tension, tension_energy};
use self::skew::{Skew, half_powers};
use self::symmetric::Symmetric;
use super::cells::Cells;
use super::columns::{AllSlices, SumsSlices};
use super::hourglass::Hourglass;
use super::lanes::{F8, Lanes, each};
use super::mesh::Group;
use super::method::Method;
use crate::method::Viscosity;

/// Corners A, B, C, D of the pyramids' outer faces, seen from outside against the clock.
pub const FACES: [[usize; 4]; 6] =
    [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];

/// Slot of the centroid.
const CENTRE: usize = 8;

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
    /// Whether the damage of an element has grown.
    pub tearing: bool,
    /// Heat of plastic flow and damage, Eq. (61).
    pub heat: f64,
}

impl Demand {
    /// Of nothing.
    pub const NONE: Self = Self { rate: 0.0, dying: false, tearing: false, heat: 0.0 };

    /// The stricter.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            rate: self.rate.max(other.rate),
            dying: self.dying || other.dying,
            tearing: self.tearing || other.tearing,
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

/// Positions of the slots about the cell's centre at the start.
#[inline(always)]
fn shape<F: Lanes, const MAPPED: bool>(u: &[V3<F>; 9], cells: &Cells<'_, MAPPED>) -> [V3<F>; 9] {
    let mut y = *u;
    for slot in 0..8 {
        for d in 0..3 {
            y[slot][d] = u[slot][d] + cells.corner::<F>(slot, d);
        }
    }
    y
}

impl Group {
    /// First pass: forces, conduction (62) and the heat of flow and damage (61), half of it to the centroid
    /// and a sixteenth to each corner: `phi` of (60). A rate below that `so_far` is not made out.
    #[inline(always)]
    pub fn load_particles<F: Lanes, const MAPPED: bool>(
        &mut self,
        cells: &Cells<'_, MAPPED>,
        laws: &Laws,
        read: &Read<'_>,
        (sink, so_far): (&mut Sink<SumsSlices<'_>>, f64),
    ) -> Demand {
        let (live, body) = (self.live, cells.body);
        let u: [V3<F>; 9] = self.gather_vector(read.displacement);
        let y = shape(&u, cells);
        let theta: [F; 9] = self.gather(read.theta);
        let motion = Kinematics::new(&u, cells);
        let pyramids = each!(k in 6 => Pyramid::new(&y, FACES[k], cells.pyramid(k)));
        let opening: [F; 6] = each!(k in 6 => pyramids[k].growth * cells.per_pyramid::<F>(k));
        let corners = ((theta[0] + theta[1]) + (theta[2] + theta[3]))
            + ((theta[4] + theta[5]) + (theta[6] + theta[7]));
        let mean = theta[CENTRE] * 0.5 + corners * 0.0625;

        let extent = Extent::new(&pyramids, cells.volume());
        self.fail(cells, &motion, (&opening, &extent), mean);
        let glass = Hourglass::of(&laws.method, cells);
        let held = match &glass {
            Some(glass) => glass.energy(&u),
            None => F::zero(),
        };
        let mut freed = self.damage(cells, (&opening, held), laws.dt);
        let intact = F::splat(1.0) - F::of(self.damage);
        // Over the sum of the faces; with the squares of shear the stiffness.
        let mut volume_squared = F::zero();
        let (mut force, mut stiffness) = if body.solid.mu > 0.0 {
            freed += self.shear(cells, &motion, (mean, intact, laws.dt));
            let stress = each!(k in 6 => F::of(self.stress[k]));
            // Of planes of nodes, which have half of the mass and move against each other in turns.
            let planes: F =
                cells.edge_as(|edge| 32.0 / 3.0 * body.solid.mu / (body.rho_0 * edge * edge));
            volume_squared =
                extent.by_speed(intact * (body.solid.mu / body.rho_0) * motion.shear_bulk());
            (motion.forces(&stress, cells, live), motion.shear_squared(planes * intact))
        } else {
            ([[F::zero(); 3]; 9], Symmetric::zero())
        };
        let mut rate_squared = F::zero();
        if let Some(glass) = &glass {
            glass.push(&u, intact.keep(live), &mut force);
            rate_squared += glass.rate_squared(cells);
        }
        let freed = freed.keep(live);
        let (corner, centre) = (freed * 0.0625, freed * 0.5);
        let heat = each!(slot in 9 => if slot == CENTRE { centre } else { corner });
        let mut loads = Loads { force, heat };

        let mut push = each!(k in 6 => -tension(opening[k], intact, body.solid.bulk).keep(live));
        volume_squared += extent.tension_squared(&opening, intact, cells);
        let mut damping = Symmetric::zero();
        if laws.volumes {
            self.carry((laws, read), &mut push);
            let v: [V3<F>; 9] = self.gather_vector(read.velocity);
            let sound: [F; 9] = self.gather(read.sound);
            let pressure = extent.pressure_squared(&sound);
            volume_squared += pressure;
            stiffness.widen((extent.faces.trace() * pressure).keep(self.bare));
            let seen = Seen { y: &y, v: &v, sound: &sound, theta: &theta };
            let of = (cells, laws, read);
            damping = match (laws.method.viscosity, body.skew) {
                (Viscosity::Pairwise, _) => self.pairwise(&seen, (cells, laws), &mut loads),
                (Viscosity::Limited, None) => self.limited((&seen, ()), of, &mut loads),
                (Viscosity::Limited, Some(factors)) => {
                    let skew = Skew::new(factors, (&u, &v), cells);
                    self.limited((&seen, skew), of, &mut loads)
                }
            };
            let own = (&*self, cells);
            if let Some(coefficient) = drag::coefficient(&laws.method, own, || sound[CENTRE]) {
                let warp = Warp::new(&u, &y, cells);
                warp.push(&warp.rates(&v, cells), (cells, coefficient), &mut loads.force);
                damping.widen(drag::rate(coefficient, cells));
            }
            if self.stiff.is_some() {
                let of = (&seen, cells, &laws.method);
                rate_squared += self.stiffen(&pyramids, (extent.volume, &opening), of, &mut push);
            }
        }
        for k in 0..6 {
            pyramids[k].push(FACES[k], push[k], &mut loads.force);
        }
        self.scatter_vector(&loads.force, sink);
        self.scatter(&loads.heat, sink.nodes.heat, sink.first_node);
        self.scatter_centre(loads.heat[CENTRE], sink.centres.heat, sink.first_centre);
        stiffness = stiffness.plus(&extent.faces.times(volume_squared));
        stiffness.widen(rate_squared);
        if let Some(lightest) = cells.lightest::<F>() {
            let heavier = F::splat(1.0) / lightest;
            (stiffness, damping) = (stiffness.times(heavier), damping.times(heavier));
        }
        let rate = symmetric::rate((&stiffness, &damping), (live, so_far));
        Demand { rate, dying: self.dying != 0, tearing: self.tearing != 0, heat: freed.sum() }
    }

    /// Second pass: volumes and, all over the mean velocity of the step, their rates, which take the place
    /// of Eq. (36) in the pressure work (59), the viscous heat of Eq. (60), half to either particle, and the
    /// power of the elements' own forces. Returns that power.
    #[inline(always)]
    pub fn work<F: Lanes, const MAPPED: bool>(
        &self,
        cells: &Cells<'_, MAPPED>,
        laws: &Laws,
        sink: &mut Sink<AllSlices<'_>>,
    ) -> f64 {
        let body = cells.body;
        let first = [sink.first_node, sink.first_centre];
        let (nodes, centres) = (&mut sink.nodes, &mut sink.centres);
        let u: [V3<F>; 9] =
            self.gather_own(nodes.0.displacement(), centres.0.displacement(), first);
        let y = shape(&u, cells);
        let v: [V3<F>; 9] = self.gather_own(nodes.2.mean(), centres.2.mean(), first);
        let intact = F::splat(1.0) - F::of(self.damage);
        let mut power = F::zero();
        let (mut growths, mut rates) = ([F::zero(); 6], [F::zero(); 6]);
        for (k, face) in FACES.into_iter().enumerate() {
            let pyramid = Pyramid::new(&y, face, cells.pyramid::<F>(k));
            let opening = pyramid.growth * cells.per_pyramid::<F>(k);
            growths[k] = pyramid.growth.keep(self.live);
            let rate = pyramid.rate(&v, face).keep(self.live);
            power += tension(opening, intact, body.solid.bulk) * rate;
            rates[k] = rate;
        }
        if let Some(glass) = Hourglass::of(&laws.method, cells) {
            power += (glass.power(&u, &v) * intact).keep(self.live);
        }
        if body.solid.mu > 0.0 {
            let stress = each!(k in 6 => F::of(self.stress[k]));
            let shear = shear_power((&u, &v), &stress, cells);
            power += (shear * cells.volume::<F>()).keep(self.live);
        }
        if laws.volumes {
            // The particles have the same shares in the volumes as in the pressure on them.
            let share = shares(&growths, laws.method.balance);
            self.scatter(&share, nodes.2.volume, first[0]);
            self.scatter_centre(share[CENTRE], centres.2.volume, first[1]);
            let share = shares(&rates, laws.method.balance);
            self.scatter(&share, nodes.2.volume_rate, first[0]);
            self.scatter_centre(share[CENTRE], centres.2.volume_rate, first[1]);
            let taken = (&self.bonds, -laws.dt);
            let mut heat = match (laws.method.viscosity, body.skew) {
                (Viscosity::Limited, Some(factors)) => {
                    half_powers(&Skew::new(factors, (&u, &v), cells), (&y, &v), taken)
                }
                _ => half_powers(&(), (&y, &v), taken),
            };
            let sound = || F::load_some(centres.1.sound, self.centre as usize - first[1]);
            if let Some(coefficient) = drag::coefficient(&laws.method, (self, cells), sound) {
                let made: [V3<F>; 9] =
                    self.gather_own(nodes.0.velocity(), centres.0.velocity(), first);
                let warp = Warp::new(&u, &y, cells);
                let (made, mean) = (warp.rates(&made, cells), warp.rates(&v, cells));
                let warmth = warp.power(&made, &mean, coefficient) * laws.dt;
                heat[CENTRE] += warmth * 0.5;
                for heat in &mut heat[..CENTRE] {
                    *heat += warmth * 0.0625;
                }
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

    /// Displacements a time `dt` ago, at these velocities, and the velocities.
    fn ago(
        &self,
        (displacement, velocity): ([&[f64]; 3], [&[f64]; 3]),
        dt: f64,
    ) -> [[V3<F8>; 9]; 2] {
        let mut u: [V3<F8>; 9] = self.gather_vector(displacement);
        let v: [V3<F8>; 9] = self.gather_vector(velocity);
        for (u, v) in u.iter_mut().zip(&v) {
            *u = sub(u, &v.map(|v| v * dt));
        }
        [u, v]
    }

    /// Shares of the nine particles in the change of the volume of each live element, at the positions before a drift
    /// of length `dt`, and in its rate there.
    #[must_use]
    pub fn volumes<const MAPPED: bool>(
        &self,
        cells: &Cells<'_, MAPPED>,
        columns: ([&[f64]; 3], [&[f64]; 3]),
        (method, dt): (&Method, f64),
    ) -> [[F8; 9]; 2] {
        let [u, v] = self.ago(columns, dt);
        let y = shape(&u, cells);
        let pyramids = each!(k in 6 => Pyramid::new(&y, FACES[k], cells.pyramid(k)));
        let growths = each!(k in 6 => pyramids[k].growth.keep(self.live));
        let rates = each!(k in 6 => pyramids[k].rate(&v, FACES[k]).keep(self.live));
        [growths, rates].map(|pyramids| shares(&pyramids, method.balance))
    }

    /// Energy stored by lane: in shear (24), from the stress of the last step, in tension (25) and in
    /// hourglass modes, at the positions before the last drift, which was of length `dt`.
    #[must_use]
    pub fn stored<const MAPPED: bool>(
        &self,
        cells: &Cells<'_, MAPPED>,
        columns: ([&[f64]; 3], [&[f64]; 3]),
        (method, dt): (&Method, f64),
    ) -> [F8; 3] {
        let [u, _] = self.ago(columns, dt);
        let y = shape(&u, cells);
        let opening = each!(k in 6 => Pyramid::new(&y, FACES[k], cells.pyramid::<F8>(k)).growth * cells.per_pyramid::<F8>(k));
        let intact = F8::splat(1.0) - self.damage;
        let (shear, tension) =
            (self.shear_energy::<F8, MAPPED>(cells), tension_energy(cells, &opening));
        let glass = Hourglass::of(method, cells).map_or(F8::ZERO, |glass| glass.energy(&u));
        [shear, tension, glass].map(|energy| (energy * intact).keep(self.live))
    }
}
