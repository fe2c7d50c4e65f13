//! What particles do by themselves, eight at a time: the kick, and the response at the end of a step.

use super::columns::{AllSlices, DerivedSlices, Work};
use super::dispatch::{Instructions, Kernel};
use super::lanes::{LANES, Lanes, Mask};
use super::mesh::{Body, Mesh};
use super::simulation::CROSSING;

/// Largest relative change of the density in a step, under pressure.
pub(super) const DENSEST_STEP: f64 = 0.08;

/// Smallest volume of a particle's elements over that of elements that are crushed.
const SMALLEST: f64 = 0.5;

/// Rate at which a free fragment loses its compression, in sound crossings of its contact length.
const RELAXATION: f64 = 0.07;

/// Density over the reference density at which a free fragment stops expanding.
const RELAXED: f64 = 0.8;

/// Particles between those that are kicked and those that are asked for.
const AHEAD: usize = 8 * LANES;

/// The time step that a particle allows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Allowed {
    /// By sound.
    pub sound: f64,
    /// First of the eight particles that decide.
    pub first: usize,
    /// By the change of density.
    pub density: f64,
    /// Whether everything is a number.
    pub sane: bool,
    /// Particles that the lowest density of their equation of state stopped from getting thinner.
    pub floored: u32,
    /// Particles that stopped getting denser since their volume was all but nothing.
    pub packed: u32,
}

impl Allowed {
    /// By nothing.
    pub const ANYTHING: Self = Self {
        sound: f64::INFINITY,
        first: 0,
        density: f64::INFINITY,
        sane: true,
        floored: 0,
        packed: 0,
    };

    /// The stricter.
    #[must_use]
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        let first = self.sound.min(self.density) <= other.sound.min(other.density);
        Self {
            sound: self.sound.min(other.sound),
            density: self.density.min(other.density),
            first: if first { self.first } else { other.first },
            sane: self.sane && other.sane,
            floored: self.floored + other.floored,
            packed: self.packed + other.packed,
        }
    }
}

/// What is done with particles.
#[derive(Clone, Copy)]
pub struct Particles<'a> {
    /// Mesh.
    pub mesh: &'a Mesh,
    /// Pieces to be worked on.
    pub active: &'a [bool],
    /// Particles that touched others.
    pub touched: &'a [bool],
    /// Whether elements carry the pressure, and ask for the time step that it needs.
    pub volumes: bool,
    /// What is to be done.
    pub stage: Stage,
}

/// A part of the response.
#[derive(Debug, Clone, Copy)]
pub enum Stage {
    /// The end of a step, and the equation of state.
    Whole(Lengths),
    /// The same, but rates of density and energy stay in the sums, for [`Stage::State`].
    Moved(Lengths),
    /// The equation of state alone, half of this long after the last kick, at densities known.
    State(f64),
}

/// Lengths of the parts of a step.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// Of the drift before it, if that says what velocities did to volumes, or zero.
    pub before: f64,
    /// Of its kick.
    pub kick: f64,
    /// Of its drift.
    pub drift: f64,
}

/// The response of all particles, piece by piece, with these instructions.
pub struct Respond<'a>(pub Particles<'a>, pub Instructions);

impl<'c> Work<AllSlices<'c>> for Respond<'_> {
    type Output = Allowed;

    fn start(&self, piece: usize) -> usize {
        self.0.mesh.pieces[piece].range.start
    }

    fn run(&self, piece: usize, columns: AllSlices<'c>) -> Allowed {
        self.1.run(RespondPiece { particles: self.0, piece, columns })
    }

    fn join(&self, low: Allowed, high: Allowed) -> Allowed {
        low.and(high)
    }
}

struct RespondPiece<'a, 'c> {
    particles: Particles<'a>,
    piece: usize,
    columns: AllSlices<'c>,
}

impl Kernel for RespondPiece<'_, '_> {
    type Output = Allowed;

    #[inline(always)]
    fn run<F: Lanes>(mut self) -> Allowed {
        let range = self.particles.mesh.pieces[self.piece].range.clone();
        let mut allowed = Allowed::ANYTHING;
        for i in range.clone().step_by(LANES) {
            let own = self.particles.respond::<F>(&mut self.columns, i - range.start, i);
            allowed = allowed.and(own);
        }
        allowed
    }
}

impl Particles<'_> {
    /// Turns the forces on the particles from `i` on, at `at` in the columns, into their mean
    /// velocities over the step, Eqs. (63), (74).
    #[inline(always)]
    pub fn kick<F: Lanes>(&self, columns: &mut AllSlices<'_>, at: usize, i: usize) {
        let (Stage::Whole(Lengths { kick, .. }) | Stage::Moved(Lengths { kick, .. })) = self.stage
        else {
            return;
        };
        let piece = self.mesh.piece_of(i);
        if !self.active[piece] {
            return;
        }
        let (state, derived, sums) = columns;
        state.fetch::<F>(at + AHEAD);
        derived.fetch::<F>(at + AHEAD);
        sums.fetch::<F>(at + AHEAD);
        let per_mass = F::splat(0.5 * kick) / self.mass::<F>(piece, i);
        for (v, force) in
            [(&*state.vx, &mut *sums.fx), (&*state.vy, &mut *sums.fy), (&*state.vz, &mut *sums.fz)]
        {
            (F::load(v, at) + per_mass * F::load(force, at)).store(force, at);
        }
    }

    /// Masses of the particles from `i` on, of a piece.
    #[inline(always)]
    fn mass<F: Lanes>(&self, piece: usize, i: usize) -> F {
        if !self.mesh.masses.is_empty() {
            return F::load(&self.mesh.masses, i);
        }
        let body = &self.mesh.bodies[self.mesh.pieces[piece].body];
        F::whole(&self.mesh.share, i) * body.sixteenth
    }

    /// Ends the step of the particles from `i` on, at `at` in the columns.
    #[inline(always)]
    pub fn respond<F: Lanes>(&self, columns: &mut AllSlices<'_>, at: usize, i: usize) -> Allowed {
        let piece = self.mesh.piece_of(i);
        if !self.active[piece] {
            return Allowed::ANYTHING;
        }
        let own = Eight {
            body: &self.mesh.bodies[self.mesh.pieces[piece].body],
            mass: self.mass(piece, i),
            ratio: F::load(&self.mesh.ratio, i),
            mesh: self.mesh,
            first: i,
            touched: mask(&self.touched[i..]),
            at,
        };
        let (now, volume, ended) = match self.stage {
            Stage::Whole(lengths) => own.end_step(columns, lengths, false),
            Stage::Moved(lengths) => own.end_step(columns, lengths, true),
            Stage::State(dt) => (own.state(columns, dt), F::zero(), Allowed::ANYTHING),
        };
        let Allowed { sound, density, .. } = own.evaluate(columns, &now, (volume, self.volumes));
        Allowed { sound, density, first: i, ..ended }
    }
}

/// Eight particles of a body.
struct Eight<'a, F> {
    mesh: &'a Mesh,
    body: &'a Body,
    first: usize,
    mass: F,
    ratio: F,
    touched: Mask,
    at: usize,
}

/// Density, internal energy and density rate at the time of the positions.
struct Now<F> {
    rho: F,
    u: F,
    rho_rate: F,
}

impl<F: Lanes> Eight<'_, F> {
    /// Ends the last step, Eqs. (36), (58)-(59), (74) and (76); the density of held particles follows their
    /// volumes instead of (36). Returns what is known at the time of the positions, the change of the
    /// volume, and whether all is finite and within the least and the greatest density.
    #[inline(always)]
    fn end_step(
        &self,
        (state, derived, sums): &mut AllSlices<'_>,
        Lengths { before, kick, drift: dt }: Lengths,
        keep_rates: bool,
    ) -> (Now<F>, F, Allowed) {
        let at = self.at;
        let least = F::splat(self.body.eos.rarest() * self.body.rho_0);
        let most = F::splat(self.body.rho_0 / (SMALLEST * self.body.solid.least));
        let volume_rate = F::load(sums.volume_rate, at);
        let mut rho_rate = F::load(sums.rho_rate, at) - F::load(derived.dilate, at) * volume_rate;
        let alone = self.ratio.lt(F::splat(1e-9)) & !self.touched;
        if alone != 0 {
            rho_rate = F::select(self.free(derived, alone), self.free_rate(derived), rho_rate);
        }
        // The drift is over the velocity after the kick, and so is what it does to volumes: with the mean velocity,
        // pressures would lag behind the positions and feed the fastest waves. What the velocity before the kick does to
        // them is what the drift before has done.
        let volume = F::load(sums.volume, at);
        let ahead = if before > 0.0 {
            volume_rate - (volume - F::load(derived.volume, at)) * (1.0 / before)
        } else {
            F::zero()
        };
        volume.store(derived.volume, at);
        let grip = F::load(derived.grip, at);
        let per_mass = F::splat(1.0) / self.mass;
        let gain = (F::load(sums.heat, at) - grip * volume_rate * kick) * per_mass;
        // Half of a kick belongs to the drift before it and half to that after it: where they differ in length
        // as in velocity, the mean of both is not what the volume does.
        let uneven = F::load(derived.dilate, at) * ahead * (dt - kick);
        let rho = F::load(state.rho, at) + (rho_rate * kick - uneven);
        let (floored, packed) = (rho.lt(least).count_ones(), rho.gt(most).count_ones());
        // What is no number, or has no end, stays so and is told: a bound would make a density of it.
        let rho = rho.max(least).min(most) + rho * 0.0;
        let u = F::load(state.u, at) + gain;
        let u_rate = if kick > 0.0 { gain * (1.0 / kick) } else { F::zero() };
        rho.store(state.rho, at);
        u.store(state.u, at);
        let volume = volume + (volume_rate + ahead) * dt;
        let mut finite = u + rho;
        for (x, v, mean) in [
            (&mut *state.dx, &mut *state.vx, &mut *sums.fx),
            (&mut *state.dy, &mut *state.vy, &mut *sums.fy),
            (&mut *state.dz, &mut *state.vz, &mut *sums.fz),
        ] {
            let middle = F::load(mean, at);
            let after =
                if kick > 0.0 { middle + (middle - F::load(v, at)) } else { F::load(v, at) };
            let moved = F::load(x, at) + after * dt;
            after.store(v, at);
            moved.store(x, at);
            F::zero().store(mean, at);
            finite += moved;
        }
        for column in [&mut *sums.volume, &mut *sums.volume_rate] {
            F::zero().store(column, at);
        }
        let rho_rate = rho_rate - F::load(derived.dilate, at) * ahead;
        let u_rate = u_rate - grip * ahead * per_mass;
        let left = if keep_rates { [u_rate, rho_rate] } else { [F::zero(); 2] };
        left[0].store(sums.heat, at);
        left[1].store(sums.rho_rate, at);
        // Zero times whatever is no number is none either.
        let sane = (finite * 0.0).sum() == 0.0;
        // Volumes, not densities, change evenly in a step: what expands does not end at zero.
        let change = (rho_rate * (0.5 * dt) / rho).min(F::splat(0.5));
        let rho = (rho / (F::splat(1.0) - change)).max(least).min(most);
        let now = Now { rho, u: u + u_rate * (0.5 * dt), rho_rate };
        (now, volume, Allowed { sane, floored, packed, ..Allowed::ANYTHING })
    }

    /// The same at a density known, with the rates that [`Stage::Moved`] has left.
    #[inline(always)]
    fn state(&self, (state, derived, sums): &mut AllSlices<'_>, dt: f64) -> Now<F> {
        let at = self.at;
        let now = Now {
            rho: F::load(derived.rho, at),
            u: F::load(state.u, at) + F::load(sums.heat, at) * (0.5 * dt),
            rho_rate: F::load(sums.rho_rate, at),
        };
        F::zero().store(sums.heat, at);
        F::zero().store(sums.rho_rate, at);
        now
    }

    /// Pressure and what follows from it, Eq. (22), and what that allows. `m P / rho^2` of (29) is the
    /// multiplier of the density, (65) and (69); that of the energy is one, (70).
    #[inline(always)]
    fn evaluate(
        &self,
        (_, derived, _): &mut AllSlices<'_>,
        now: &Now<F>,
        (volume, volumes): (F, bool),
    ) -> Allowed {
        let zero = F::zero();
        let (at, rho) = (self.at, now.rho);
        let inverse = F::splat(1.0) / rho;
        let response = self.body.eos.respond((rho, inverse), now.u, || self.mesh.loose(self.first));
        let reference = self.mass * (1.0 / self.body.rho_0);
        let least = reference * (SMALLEST * self.body.solid.least);
        let whole = (reference + self.ratio * volume).max(least);
        let dilate = (rho / whole).keep(self.ratio.gt(zero));
        let per_density = response.pressure * self.mass * (inverse * inverse);
        let sound = response.sound_squared.sqrt();
        rho.store(derived.rho, at);
        response.pressure.store(derived.pressure, at);
        (per_density * dilate).store(derived.grip, at);
        dilate.store(derived.dilate, at);
        response.theta.store(derived.theta, at);
        sound.store(derived.sound, at);

        // Elements ask for what their own particles need.
        let loose = if volumes {
            let held = self.ratio.gt(F::splat(0.999)) & self.ratio.lt(F::splat(1.001));
            !held | self.touched
        } else {
            Mask::MAX
        };
        let crossing = (rho * (1.0 / self.body.rho_0)).max(F::splat(1.0)) * sound;
        let change = now.rho_rate.abs() * inverse;
        // Nothing may be minus nothing.
        let fastest = |rate: F| rate.largest().abs();
        Allowed {
            sound: CROSSING * self.body.edge() / fastest(crossing.keep(loose)),
            density: DENSEST_STEP / fastest(change.keep(response.pressure.gt(zero))),
            ..Allowed::ANYTHING
        }
    }

    /// Those of lanes without elements, contacts and wall that are under pressure.
    #[inline(always)]
    fn free(&self, derived: &DerivedSlices<'_>, alone: Mask) -> Mask {
        let dense = F::load(derived.rho, self.at).gt(F::splat(RELAXED * self.body.rho_0));
        alone & dense & F::load(derived.pressure, self.at).gt(F::zero())
    }

    /// Rate of a fragment that nothing holds together.
    #[inline(always)]
    fn free_rate(&self, derived: &DerivedSlices<'_>) -> F {
        let crossing = F::load(derived.sound, self.at) * (1.0 / self.body.length);
        -(crossing * F::load(derived.rho, self.at) * RELAXATION)
    }
}

/// Lanes that are true.
#[inline(always)]
fn mask(lanes: &[bool]) -> Mask {
    let mut bits = 0;
    for (k, &lane) in lanes[..LANES].iter().enumerate() {
        bits |= u8::from(lane) << k;
    }
    bits
}
