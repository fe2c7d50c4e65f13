//! Who votes on the length of a step in three dimensions, and who decided those so far.

/// What can limit a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Voter {
    /// Sound may not cross more than a part of a particle.
    Sound,
    /// Densities may not change by much.
    Density,
    /// Stiffness and viscosity of elements.
    Elements,
    /// Viscosity of contacts between loose particles.
    Contacts,
    /// Approach, stiffness and viscosity of springs between surfaces.
    Springs,
    /// Bodies may not leap through each other.
    Leap,
    /// No step is much longer than the one before.
    Growth,
    /// The kick of a short step after a long one.
    Kick,
    /// The run lands on a time.
    Landing,
}

/// Number of voters.
pub const VOTERS: usize = 9;

impl Voter {
    /// All voters; the first seven vote on every step, the others shorten what these allow.
    pub const ALL: [Self; VOTERS] = [
        Self::Sound,
        Self::Density,
        Self::Elements,
        Self::Contacts,
        Self::Springs,
        Self::Leap,
        Self::Growth,
        Self::Kick,
        Self::Landing,
    ];

    /// Name for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sound => "sound",
            Self::Density => "density",
            Self::Elements => "elements",
            Self::Contacts => "contacts",
            Self::Springs => "springs",
            Self::Leap => "leap",
            Self::Growth => "growth",
            Self::Kick => "kick",
            Self::Landing => "landing",
        }
    }

    /// What a message that names a particle says of it. Elements, contacts and springs do not say which of them it
    /// was: the particle that sound crosses soonest is near.
    #[must_use]
    pub(super) fn cause(self) -> &'static str {
        match self {
            Self::Density => "the change of density",
            Self::Elements => "stiffness and viscosity of elements; sound crosses soonest",
            Self::Contacts => "the viscosity of contacts; sound crosses soonest",
            Self::Springs => "springs between surfaces; sound crosses soonest",
            _ => self.name(),
        }
    }
}

/// Votes on the last step, and how often each voter decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Votes {
    /// Length that each voter allowed, its safety included.
    pub allowed: [f64; VOTERS],
    /// Steps that each has decided.
    pub decided: [u64; VOTERS],
    /// Who decided the last step; nobody before the first.
    pub last: Option<Voter>,
}

impl Default for Votes {
    fn default() -> Self {
        Self { allowed: [f64::INFINITY; VOTERS], decided: [0; VOTERS], last: None }
    }
}

impl Votes {
    /// Steps that each voter has decided, by name.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, u64)> + '_ {
        Voter::ALL.into_iter().map(Voter::name).zip(self.decided)
    }

    /// Length that a voter allowed the last step.
    #[must_use]
    pub fn of(&self, voter: Voter) -> f64 {
        self.allowed[voter as usize]
    }

    /// Casts the votes on a step, and returns the shortest.
    pub(super) fn cast(&mut self, votes: [(Voter, f64); 7]) -> f64 {
        *self = Self { decided: self.decided, ..Self::default() };
        let mut least = f64::INFINITY;
        for (voter, length) in votes {
            self.allowed[voter as usize] = length;
            // What is no number decides, and is refused.
            if length < least || length.is_nan() {
                (least, self.last) = (length, Some(voter));
            }
        }
        least
    }

    /// Shortens a step, if `length` is the less.
    pub(super) fn shorten(&mut self, step: f64, voter: Voter, length: f64) -> f64 {
        if length < step {
            self.allowed[voter as usize] = length;
            self.last = Some(voter);
        }
        step.min(length)
    }

    /// Counts the step as decided.
    pub(super) fn count(&mut self) {
        if let Some(voter) = self.last {
            self.decided[voter as usize] += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOBODY: [(Voter, f64); 7] = [
        (Voter::Sound, f64::INFINITY),
        (Voter::Density, f64::INFINITY),
        (Voter::Elements, f64::INFINITY),
        (Voter::Contacts, f64::INFINITY),
        (Voter::Springs, f64::INFINITY),
        (Voter::Leap, f64::INFINITY),
        (Voter::Growth, f64::INFINITY),
    ];

    #[test]
    fn the_shortest_vote_decides_and_what_is_no_number_too() {
        let mut votes = Votes::default();
        let mut cast = NOBODY;
        (cast[2].1, cast[4].1) = (3.0, 2.0);
        assert_eq!(votes.cast(cast), 2.0);
        assert_eq!(votes.last, Some(Voter::Springs));
        assert_eq!(votes.shorten(2.0, Voter::Kick, 5.0), 2.0);
        assert_eq!(votes.shorten(2.0, Voter::Landing, 1.5), 1.5);
        votes.count();
        assert_eq!(votes.last, Some(Voter::Landing));
        assert_eq!(votes.named().find(|(_, steps)| *steps > 0), Some(("landing", 1)));
        assert_eq!(votes.of(Voter::Kick), f64::INFINITY);
        cast[0].1 = f64::NAN;
        assert!(votes.cast(cast).is_nan());
        assert_eq!(votes.last, Some(Voter::Sound));
        assert_eq!(votes.cast(NOBODY), f64::INFINITY);
        assert_eq!((votes.last, votes.decided.iter().sum::<u64>()), (None, 1));
    }
}
