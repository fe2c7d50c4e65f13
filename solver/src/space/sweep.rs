//! The two sweeps over particles: the response to the last step, and the kick.

use super::columns::{DerivedSlices, StateSlices, SumsSlices, Work};
use super::dispatch::{Instructions, Kernel};
use super::lanes::{LANES, Lanes, Mask};
use super::mesh::{Body, Mesh, Piece};
use super::simulation::CROSSING;

/// Lowest density over the reference density.
const THINNEST: f64 = 0.3;

/// Largest relative change of the density in a step, under pressure.
const DENSEST_STEP: f64 = 0.08;

/// Smallest volume of a particle's elements over its reference volume.
const SMALLEST: f64 = 0.1;

/// Rate at which a free fragment loses its compression, in sound crossings of its contact length.
const RELAXATION: f64 = 0.07;

/// Density over the reference density at which a free fragment stops expanding.
const RELAXED: f64 = 0.8;

/// The time step that a particle allows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Allowed {
    /// By sound.
    pub sound: f64,
    /// Piece that decides.
    pub piece: usize,
    /// By the change of density.
    pub density: f64,
    /// Whether everything is a number.
    pub sane: bool,
}

impl Allowed {
    /// By nothing.
    pub const ANYTHING: Self =
        Self { sound: f64::INFINITY, piece: 0, density: f64::INFINITY, sane: true };

    fn and(self, other: Self) -> Self {
        let first = self.sound.min(self.density) <= other.sound.min(other.density);
        Self {
            sound: self.sound.min(other.sound),
            density: self.density.min(other.density),
            piece: if first { self.piece } else { other.piece },
            sane: self.sane && other.sane,
        }
    }
}

/// Ends the last step and evaluates the equation of state.
pub struct Respond<'a> {
    /// Mesh.
    pub mesh: &'a Mesh,
    /// Pieces to be worked on.
    pub active: &'a [bool],
    /// Particles that touched others.
    pub touched: &'a [bool],
    /// Instructions.
    pub instructions: Instructions,
    /// Whether elements carry the pressure, and ask for the time step that it needs.
    pub volumes: bool,
    /// What is to be done.
    pub stage: Stage,
}

/// A part of the response.
#[derive(Debug, Clone, Copy)]
pub enum Stage {
    /// The end of a step after a kick and a drift of these lengths, and the equation of state.
    Whole(f64, f64),
    /// The equation of state alone, half of this long after the last kick, at densities known.
    State(f64),
}

type Columns<'a> = (StateSlices<'a>, DerivedSlices<'a>, SumsSlices<'a>);

impl<'c> Work<Columns<'c>> for Respond<'_> {
    type Output = Allowed;

    fn start(&self, piece: usize) -> usize {
        self.mesh.pieces[piece].range.start
    }

    fn run(&self, piece: usize, columns: Columns<'c>) -> Allowed {
        if !self.active[piece] {
            return Allowed { piece, ..Allowed::ANYTHING };
        }
        let (state, derived, sums) = columns;
        let own = &self.mesh.pieces[piece];
        let body = &self.mesh.bodies[own.body];
        let range = own.range.clone();
        let kernel = RespondPiece {
            piece: own,
            body,
            mass: &self.mesh.mass[range.clone()],
            ratio: &self.mesh.ratio[range.clone()],
            touched: &self.touched[range],
            columns: (state, derived, sums),
            volumes: self.volumes,
            stage: self.stage,
        };
        Allowed { piece, ..self.instructions.run(kernel) }
    }

    fn join(&self, low: Allowed, high: Allowed) -> Allowed {
        low.and(high)
    }
}

struct RespondPiece<'a> {
    piece: &'a Piece,
    body: &'a Body,
    mass: &'a [f64],
    ratio: &'a [f64],
    touched: &'a [bool],
    columns: Columns<'a>,
    volumes: bool,
    stage: Stage,
}

impl Kernel for RespondPiece<'_> {
    type Output = Allowed;

    #[inline(always)]
    fn run<F: Lanes>(mut self) -> Allowed {
        let mut allowed = Allowed::ANYTHING;
        for at in (0..self.piece.range.len()).step_by(LANES) {
            let lane = self.eight::<F>(at);
            allowed = allowed.and(lane);
        }
        allowed
    }
}

impl RespondPiece<'_> {
    #[inline(always)]
    fn eight<F: Lanes>(&mut self, at: usize) -> Allowed {
        let (rho, u, sane) = match self.stage {
            Stage::Whole(kick, dt) => self.end_step::<F>(at, kick, dt),
            Stage::State(dt) => {
                let (state, derived, _) = &self.columns;
                let u = F::load(state.u, at) + F::load(state.u_rate, at) * (0.5 * dt);
                (F::load(derived.rho, at), u, true)
            }
        };
        Allowed { sane, ..self.evaluate(at, rho, u) }
    }

    /// Ends the last step, Eqs. (36), (58) and (76). Returns density and internal energy at the time
    /// of the positions, and whether all is finite.
    #[inline(always)]
    fn end_step<F: Lanes>(&mut self, at: usize, kick: f64, dt: f64) -> (F, F, bool) {
        let (state, derived, sums) = &mut self.columns;
        let least = F::splat(THINNEST * self.body.rho_0);
        let volume_rate = F::load(sums.volume_rate, at);
        let mut rho_rate = F::load(sums.rho_rate, at) - F::load(derived.dilate, at) * volume_rate;
        let alone = F::load(self.ratio, at).lt(F::splat(1e-9));
        if alone != 0 {
            let free = free_lanes(self.body, (&self.touched[at..], alone), derived, at);
            rho_rate = F::select(free, free_rate(self.body, derived, at), rho_rate);
        }
        let work = F::load(sums.heat, at) - F::load(derived.grip, at) * volume_rate * kick;
        let gain = work / F::load(self.mass, at);
        let rho = (F::load(state.rho, at) + rho_rate * kick).max(least);
        let u = F::load(state.u, at) + gain;
        let u_rate = if kick > 0.0 { gain * (1.0 / kick) } else { F::zero() };
        rho.store(state.rho, at);
        u.store(state.u, at);
        rho_rate.store(state.rho_rate, at);
        u_rate.store(state.u_rate, at);
        let volume = F::load(sums.volume, at) + volume_rate * dt;
        volume.store(state.volume, at);
        let mut finite = u + rho;
        for (x, v) in [
            (&mut *state.dx, &*state.vx),
            (&mut *state.dy, &*state.vy),
            (&mut *state.dz, &*state.vz),
        ] {
            let moved = F::load(x, at) + F::load(v, at) * dt;
            moved.store(x, at);
            finite += moved;
        }
        for column in [
            &mut *sums.fx,
            &mut *sums.fy,
            &mut *sums.fz,
            &mut *sums.volume,
            &mut *sums.volume_rate,
            &mut *sums.heat,
            &mut *sums.rho_rate,
        ] {
            F::zero().store(column, at);
        }
        // Zero times whatever is no number is none either.
        let sane = (finite * 0.0).sum() == 0.0;
        ((rho + rho_rate * (0.5 * dt)).max(least), u + u_rate * (0.5 * dt), sane)
    }

    /// Pressure and what follows from it, Eq. (22), and what that allows.
    #[inline(always)]
    fn evaluate<F: Lanes>(&mut self, at: usize, rho: F, u: F) -> Allowed {
        let (state, derived, _) = &mut self.columns;
        let (zero, forever) = (F::zero(), F::splat(f64::INFINITY));
        let (mass, ratio) = (F::load(self.mass, at), F::load(self.ratio, at));
        let response = self.body.eos.respond(rho, u);
        let reference = mass * (1.0 / self.body.rho_0);
        let whole = (reference + ratio * F::load(state.volume, at)).max(reference * SMALLEST);
        let dilate = (rho / whole).keep(ratio.gt(zero));
        let per_density = response.pressure * mass / (rho * rho);
        let sound = response.sound_squared.sqrt();
        rho.store(derived.rho, at);
        response.pressure.store(derived.pressure, at);
        (per_density * dilate).store(derived.grip, at);
        dilate.store(derived.dilate, at);
        response.theta.store(derived.theta, at);
        sound.store(derived.sound, at);

        // Elements ask for what their own particles need.
        let loose = if self.volumes {
            let held = ratio.gt(F::splat(0.999)) & ratio.lt(F::splat(1.001));
            !held | mask(&self.touched[at..])
        } else {
            Mask::MAX
        };
        let spacing = (F::splat(self.body.rho_0) / rho).min(F::splat(1.0));
        let crossing = F::select(loose, spacing / sound.max(F::splat(1e-300)), forever);
        let rate = F::load(state.rho_rate, at).abs();
        let change = rho / rate.max(F::splat(1e-300));
        let change = F::select(response.pressure.gt(zero), change, forever);
        Allowed {
            sound: CROSSING * self.body.edge() * crossing.least(),
            density: DENSEST_STEP * change.least(),
            ..Allowed::ANYTHING
        }
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

/// Lanes without elements, contacts and wall that are under pressure.
#[inline(always)]
fn free_lanes(
    body: &Body,
    (touched, alone): (&[bool], u8),
    derived: &DerivedSlices<'_>,
    at: usize,
) -> Mask {
    let mut bits = 0;
    for (k, &touched) in touched[..LANES].iter().enumerate() {
        let dense = derived.rho[at + k] > RELAXED * body.rho_0;
        let pressed = derived.pressure[at + k] > 0.0;
        let free = alone >> k & 1 == 1 && !touched && pressed && dense;
        bits |= u8::from(free) << k;
    }
    bits
}

/// Rate of a fragment that nothing holds together.
#[inline(always)]
fn free_rate<F: Lanes>(body: &Body, derived: &DerivedSlices<'_>, at: usize) -> F {
    let crossing = F::load(derived.sound, at) * (1.0 / body.length);
    -(crossing * F::load(derived.rho, at) * RELAXATION)
}

/// New velocities, Eq. (74), and the mean velocities of the step.
pub struct Kick<'a> {
    /// Mesh.
    pub mesh: &'a Mesh,
    /// Pieces to be worked on.
    pub active: &'a [bool],
    /// Length of the kick.
    pub kick: f64,
    /// Instructions.
    pub instructions: Instructions,
}

impl<'c> Work<Columns<'c>> for Kick<'_> {
    type Output = ();

    fn start(&self, piece: usize) -> usize {
        self.mesh.pieces[piece].range.start
    }

    fn run(&self, piece: usize, (state, derived, sums): Columns<'c>) {
        if self.active[piece] {
            let range = self.mesh.pieces[piece].range.clone();
            let len = range.len();
            let mass = &self.mesh.mass[range];
            self.instructions.run(KickPiece {
                mass,
                len,
                kick: self.kick,
                columns: (state, derived, sums),
            });
        }
    }

    fn join(&self, (): (), (): ()) {}
}

struct KickPiece<'a> {
    mass: &'a [f64],
    len: usize,
    kick: f64,
    columns: Columns<'a>,
}

impl Kernel for KickPiece<'_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Lanes>(self) {
        let (state, derived, sums) = self.columns;
        let half = 0.5 * self.kick;
        for at in (0..self.len).step_by(LANES) {
            let per_mass = F::splat(half) / F::load(self.mass, at);
            for (v, mean, force) in [
                (&mut *state.vx, &mut *derived.mx, &*sums.fx),
                (&mut *state.vy, &mut *derived.my, &*sums.fy),
                (&mut *state.vz, &mut *derived.mz, &*sums.fz),
            ] {
                let gain = per_mass * F::load(force, at);
                let middle = F::load(v, at) + gain;
                middle.store(mean, at);
                (middle + gain).store(v, at);
            }
        }
    }
}
