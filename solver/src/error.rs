//! What can go wrong, with the numbers that an engineer needs to find out why.

use thiserror::Error;

/// A scene that cannot be simulated as it stands.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("`{key}` is {value}, but {wanted}")]
pub struct SceneError {
    /// Dotted key of the offending value, as `--set` addresses it.
    pub key: String,
    /// The value as given.
    pub value: String,
    /// What would be accepted.
    pub wanted: String,
}

impl SceneError {
    pub(crate) fn new(key: impl Into<String>, value: impl std::fmt::Display, wanted: &str) -> Self {
        Self { key: key.into(), value: value.to_string(), wanted: wanted.to_owned() }
    }

    /// A body whose material is none of a scene with these.
    pub(crate) fn no_material<'a>(
        body: &str,
        wanted: &str,
        names: impl Iterator<Item = &'a str>,
    ) -> Self {
        let names: Vec<String> = names.map(|name| format!("`{name}`")).collect();
        let known = format!("no material has that name; the scene has {}", names.join(", "));
        Self::new(format!("{body}.material"), format!("`{wanted}`"), &known)
    }

    /// Checks a coefficient that may be zero but not negative, and has a largest value for a reason.
    pub(crate) fn coefficient(key: &str, value: f64, (most, why): (f64, &str)) -> Result<(), Self> {
        if (0.0..=most).contains(&value) {
            return Ok(());
        }
        Err(Self::new(key, value, &format!("it must be from 0 to {most}: beyond, {why}")))
    }
}

/// A numerical failure, found in the step that makes it.
///
/// Along a line the state of the simulation is then the one *before* that step, so that it can be saved. In
/// space it is that within the step: whoever wants the last good one keeps it, as `Simulation::sections`.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StepError {
    /// A state variable is not a finite number.
    #[error("{quantity} of particle {particle} is {value} at t = {time:.6e}")]
    NotFinite {
        /// Name of the variable.
        quantity: &'static str,
        /// Index of the particle, counted along the chain from 0.
        particle: usize,
        /// Time at which it was found.
        time: f64,
        /// The value.
        value: f64,
    },
    /// The density left the positive numbers.
    #[error("density of particle {particle} is {value:.3e} at t = {time:.6e}: must be positive")]
    Density {
        /// Index of the particle.
        particle: usize,
        /// Time at which it was found.
        time: f64,
        /// The density.
        value: f64,
    },
    /// The internal energy fell below what the equation of state can represent.
    #[error(
        "internal energy of particle {particle} is {} at t = {time:.6e}, below the floor {} of its \
         equation of state",
        told_apart(*value, *floor),
        told_apart(*floor, *value)
    )]
    Energy {
        /// Index of the particle.
        particle: usize,
        /// Time at which it was found.
        time: f64,
        /// Internal energy per unit mass.
        value: f64,
        /// Smallest value that the equation of state accepts.
        floor: f64,
    },
    /// Two particles passed through each other.
    #[error("particles {particle} and {next} crossed at t = {time:.6e}: separation {value:.3e}")]
    Crossed {
        /// Index of the left particle.
        particle: usize,
        /// Index of the right particle.
        next: usize,
        /// Time at which it was found.
        time: f64,
        /// Their separation, negative or zero.
        value: f64,
    },
    /// The time step became too small to go on.
    #[error(
        "time step {} at t = {time:.6e} is below {}: limited by {limiter} at particle {particle}",
        told_apart(*value, *floor),
        told_apart(*floor, *value)
    )]
    TimeStep {
        /// Index of the particle that voted for the step.
        particle: usize,
        /// Time at which it was found.
        time: f64,
        /// The step.
        value: f64,
        /// Smallest step accepted.
        floor: f64,
        /// Name of the limiter.
        limiter: &'static str,
    },
    /// More neighbours in range than there is room for.
    #[error(
        "particle {particle} has more neighbours in range than there is room for at t = {time:.6e} \
         ({room} on a side, or the images of a wall): the compression is too strong for pairs in \
         contact range"
    )]
    Neighbours {
        /// Index of the particle.
        particle: usize,
        /// Time at which it was found.
        time: f64,
        /// Neighbours that can be held on one side.
        room: usize,
    },
}

/// A number with as many digits as tell it from another.
fn told_apart(value: f64, other: f64) -> String {
    let text = |x: f64, digits: usize| format!("{x:.digits$e}");
    let digits = (3..17).find(|&digits| text(value, digits) != text(other, digits));
    text(value, digits.unwrap_or(17))
}

impl StepError {
    /// Short name of the kind of failure, for records.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NotFinite { .. } => "not finite",
            Self::Density { .. } => "density",
            Self::Energy { .. } => "internal energy",
            Self::Crossed { .. } => "particles crossed",
            Self::TimeStep { .. } => "time step collapsed",
            Self::Neighbours { .. } => "too many neighbours",
        }
    }
}
