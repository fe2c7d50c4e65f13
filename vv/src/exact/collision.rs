//! Longitudinal collision of two elastic blocks, with separation.
//!
//! Linear waves in each block: at the interface the incoming invariant of a block is
//! `a = p + z w`, with the pressure `p`, the velocity `w` towards the other block and the
//! impedance `z = rho c`; the outgoing one, `p - z w = 2 p - a`, returns with its sign reversed
//! from the free far end after `2 L/c`. In contact `w_1 = -w_2`, so
//! `p = (z_2 a_1 + z_1 a_2)/(z_1 + z_2)`; where that is negative the blocks part and `p = 0`.
//! All signals are piecewise constant, so the motion is followed from event to event, exactly.
//! Sources: J. Barré de Saint-Venant (1867); W. Goldsmith, *Impact* (1960), ch. 3.

use super::{InputError, above, finite};
use std::collections::VecDeque;
use std::fmt;

/// Relative size below which signals and time differences are taken for rounding.
const ROUNDING: f64 = 1e-12;
/// Number of events after which a collision is given up.
const MAX_EVENTS: usize = 200_000;

/// An elastic block of unit cross-section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Length `L`.
    pub length: f64,
    /// Density `rho`.
    pub density: f64,
    /// Longitudinal wave speed `c`.
    pub wave_speed: f64,
    /// Initial velocity along `x`.
    pub velocity: f64,
}

impl Block {
    /// Impedance `rho c`.
    #[must_use]
    pub fn impedance(&self) -> f64 {
        self.density * self.wave_speed
    }

    /// Mass per cross-section, `rho L`.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.density * self.length
    }

    fn validated(self) -> Result<Self, InputError> {
        above("length", self.length, 0.0)?;
        above("density", self.density, 0.0)?;
        above("wave speed", self.wave_speed, 0.0)?;
        finite("velocity", self.velocity)?;
        Ok(self)
    }
}

/// Outcome of a collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// Final velocity of the centre of mass of the left block.
    pub left_velocity: f64,
    /// Final velocity of the centre of mass of the right block.
    pub right_velocity: f64,
    /// Momentum per cross-section given to the right block.
    pub impulse: f64,
    /// Greatest contact pressure.
    pub peak_pressure: f64,
    /// Time from the first touch until the pressure vanishes for good.
    pub contact_time: f64,
}

/// Why a collision has no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CollisionError {
    /// An argument was refused.
    Input(InputError),
    /// The blocks do not approach each other.
    NoApproach,
    /// The blocks have not clearly parted after very many wave reflections.
    Unfinished,
}

impl fmt::Display for CollisionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(error) => error.fmt(f),
            Self::NoApproach => f.write_str("the blocks do not approach each other"),
            Self::Unfinished => f.write_str("the blocks have not parted"),
        }
    }
}

impl std::error::Error for CollisionError {}

impl From<InputError> for CollisionError {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

/// Collision of `left` with `right`, which touch and are free of stress at `t = 0`.
///
/// # Errors
/// Inadmissible blocks, blocks that do not approach each other, or no separation.
pub fn collide(left: Block, right: Block) -> Result<Collision, CollisionError> {
    let (left, right) = (left.validated()?, right.validated()?);
    let approach = left.velocity - right.velocity;
    if approach <= 0.0 {
        return Err(CollisionError::NoApproach);
    }
    // In the frame of the right block, so that rounding does not depend on the frame.
    let mut rods = [Rod::new(&left, approach), Rod::new(&right, 0.0)];
    let coupling = left.impedance() * right.impedance() / (left.impedance() + right.impedance());
    let (mut time, mut gap) = (0.0_f64, 0.0_f64);
    let (mut impulse, mut peak_pressure, mut contact_time) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..MAX_EVENTS {
        let closing = rods[0].free_velocity() + rods[1].free_velocity();
        let contact = gap <= 0.0 && closing > ROUNDING * approach;
        let pressure = if contact { coupling * closing } else { 0.0 };
        let opening = if contact || gap <= 0.0 { (-closing).max(0.0) } else { -closing };
        for rod in &mut rods {
            rod.reflect(time, pressure, ROUNDING * approach);
        }
        let arrival = rods[0].next_arrival().min(rods[1].next_arrival());
        let touch = if opening < 0.0 { time - gap / opening } else { f64::INFINITY };
        let next = arrival.min(touch);
        let recoil = approach - impulse / left.mass();
        let advance = impulse / right.mass();
        let excursion = rods[0].excursion(recoil) + rods[1].excursion(-advance);
        let parted = !contact && advance > recoil && gap > excursion;
        if parted || next.is_infinite() {
            return Ok(Collision {
                left_velocity: right.velocity + recoil,
                right_velocity: right.velocity + advance,
                impulse,
                peak_pressure,
                contact_time,
            });
        }
        impulse += pressure * (next - time);
        peak_pressure = peak_pressure.max(pressure);
        gap = if touch <= arrival { 0.0 } else { gap + opening * (next - time) };
        time = next;
        if contact {
            contact_time = time;
        }
        for rod in &mut rods {
            rod.receive(time);
        }
    }
    Err(CollisionError::Unfinished)
}

/// A block seen from the interface, velocities counted towards the other block.
struct Rod {
    impedance: f64,
    round_trip: f64,
    /// Incoming invariant `p + z w`.
    incoming: f64,
    /// Incoming values still under way, with their times of arrival.
    pending: VecDeque<(f64, f64)>,
}

impl Rod {
    fn new(block: &Block, velocity: f64) -> Self {
        Self {
            impedance: block.impedance(),
            round_trip: 2.0 * block.length / block.wave_speed,
            incoming: block.impedance() * velocity,
            pending: VecDeque::new(),
        }
    }

    /// Velocity that the end takes when free.
    fn free_velocity(&self) -> f64 {
        self.incoming / self.impedance
    }

    /// Sends out the wave that results from the interface pressure from `time` on, unless it is
    /// the same, to within the velocity `tolerance`, as the last one.
    fn reflect(&mut self, time: f64, pressure: f64, tolerance: f64) {
        let returning = self.incoming - 2.0 * pressure;
        let last = self.pending.back().map_or(self.incoming, |&(_, value)| value);
        if (returning - last).abs() > tolerance * self.impedance {
            self.pending.push_back((time + self.round_trip, returning));
        }
    }

    fn next_arrival(&self) -> f64 {
        self.pending.front().map_or(f64::INFINITY, |&(arrival, _)| arrival)
    }

    /// Takes in what has arrived by `time`.
    fn receive(&mut self, time: f64) {
        while self.next_arrival() <= time + ROUNDING * self.round_trip {
            if let Some((_, value)) = self.pending.pop_front() {
                self.incoming = value;
            }
        }
    }

    /// Bound on how far the free end can swing towards the other block, if the centre of mass
    /// moves at `velocity`: the end's velocity has the period of a round trip and that mean.
    fn excursion(&self, velocity: f64) -> f64 {
        let values = self.pending.iter().map(|&(_, value)| value).chain([self.incoming]);
        let swing = values.map(|a| (a / self.impedance - velocity).abs()).fold(0.0, f64::max);
        0.5 * swing * self.round_trip
    }
}

#[cfg(test)]
mod tests;
