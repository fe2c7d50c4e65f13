//! What a hard case measures: numbers with their bounds, and failures where there is no number.

use serde::{Deserialize, Serialize};
use whipple_solver::error::{SceneError, StepError};
use whipple_solver::method::{Density, Method, Preset};
use whipple_solver::space::method::Method as SpaceMethod;
use whipple_solver::space::restart::RestartError;

use crate::checkpoint::CheckpointError;
use crate::exact::InputError;
use crate::record::Scheme;
use crate::run::RunError;
use crate::space::checkpoint::ResumeError;

/// Why a part of a case has no number.
#[derive(Debug, thiserror::Error)]
pub(super) enum Trouble {
    /// A scene that is refused.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A numerical failure.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A state that is refused.
    #[error(transparent)]
    State(#[from] RestartError),
    /// A checkpoint that cannot be written.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// A checkpoint that cannot be read.
    #[error(transparent)]
    Resume(#[from] ResumeError),
    /// An exact solution that cannot be evaluated.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A case of the harness that does not run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Anything else, such as a run that is given up.
    #[error("{0}")]
    Other(String),
}

/// How large a case is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Extent {
    /// As the list states it.
    Stated,
    /// Smaller or shorter, with the same pass number.
    Quick,
}

/// What a number must keep to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// At most this.
    AtMost(f64),
    /// At least this.
    AtLeast(f64),
    /// Nothing: it is shown.
    Shown,
}

impl Bound {
    /// Whether a number keeps to it; one that is none keeps to nothing.
    #[must_use]
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::AtMost(most) => value <= most,
            Self::AtLeast(least) => value >= least,
            Self::Shown => !value.is_nan(),
        }
    }

    /// How near a number is to its bound: above 1 where it does not hold.
    #[must_use]
    pub fn nearness(self, value: f64) -> f64 {
        let part = match self {
            Self::AtMost(most) if most > 0.0 => value / most,
            Self::AtLeast(least) if value > 0.0 && least > 0.0 => least / value,
            _ if self.holds(value) => 0.0,
            _ => f64::INFINITY,
        };
        if part.is_nan() { f64::INFINITY } else { part }
    }
}

/// A number that was measured, or why there is none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// Of what run of the case.
    pub part: String,
    /// What was measured.
    pub what: String,
    /// Its unit; empty for ratios and counts.
    pub unit: String,
    /// The number, if it is one.
    pub value: Option<f64>,
    /// What it must keep to.
    pub bound: Bound,
    /// Whether it does.
    pub pass: bool,
    /// What the solver said where it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub said: Option<String>,
}

impl Reading {
    /// Whether it decides anything: what is only shown does where there is no number.
    #[must_use]
    pub fn decides(&self) -> bool {
        self.bound != Bound::Shown || !self.pass
    }
}

/// What a case writes its numbers to, and what it runs with.
#[derive(Debug)]
pub struct Sheet {
    preset: Preset,
    density: Density,
    extent: Extent,
    part: String,
    /// The numbers so far.
    pub(super) readings: Vec<Reading>,
}

impl Sheet {
    /// An empty one for a scheme of particles; nothing for another.
    #[must_use]
    pub(super) fn new(scheme: Scheme, extent: Extent) -> Option<Self> {
        let Scheme::Particles { preset, density } = scheme else { return None };
        Some(Self { preset, density, extent, part: String::new(), readings: Vec::new() })
    }

    /// The preset that is run.
    pub(super) fn preset(&self) -> Preset {
        self.preset
    }

    /// What is run.
    pub(super) fn scheme(&self) -> Scheme {
        Scheme::Particles { preset: self.preset, density: self.density }
    }

    /// Numerical choices in three dimensions.
    pub(super) fn space(&self) -> SpaceMethod {
        SpaceMethod { density: self.density, ..self.preset.space() }
    }

    /// Numerical choices along a line.
    pub(super) fn line(&self) -> Method {
        Method { density: self.density, ..self.preset.method() }
    }

    /// One of two sizes: that of the list, or a smaller one.
    pub(super) fn size<T>(&self, stated: T, quick: T) -> T {
        match self.extent {
            Extent::Stated => stated,
            Extent::Quick => quick,
        }
    }

    /// Measures a part of the case; its failure is a failed reading, and the other parts go on.
    pub(super) fn part(
        &mut self,
        name: impl Into<String>,
        measure: impl FnOnce(&mut Self) -> Result<(), Trouble>,
    ) {
        self.part = name.into();
        if let Err(error) = measure(self) {
            self.enter("the run comes to its end", "", f64::NAN, Bound::Shown);
            if let Some(reading) = self.readings.last_mut() {
                reading.said = Some(error.to_string());
            }
        }
    }

    /// Enters a number.
    pub(super) fn enter(&mut self, what: &str, unit: &str, value: f64, bound: Bound) {
        self.readings.push(Reading {
            part: self.part.clone(),
            what: what.into(),
            unit: unit.into(),
            value: Some(value).filter(|value| value.is_finite()),
            bound,
            pass: bound.holds(value),
            said: None,
        });
    }

    /// Enters a ratio or count that may be so large.
    pub(super) fn at_most(&mut self, what: &str, value: f64, most: f64) {
        self.enter(what, "", value, Bound::AtMost(most));
    }

    /// Enters a ratio or count that may not be smaller.
    pub(super) fn at_least(&mut self, what: &str, value: f64, least: f64) {
        self.enter(what, "", value, Bound::AtLeast(least));
    }

    /// Enters a ratio or count that decides nothing.
    pub(super) fn shown(&mut self, what: &str, value: f64) {
        self.enter(what, "", value, Bound::Shown);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_decide_and_what_is_no_number_fails() {
        assert!(Bound::AtMost(1.0).holds(1.0) && !Bound::AtMost(1.0).holds(1.1));
        assert!(Bound::AtLeast(1.0).holds(1.0) && !Bound::AtLeast(1.0).holds(0.9));
        for bound in [Bound::AtMost(1.0), Bound::AtLeast(0.0), Bound::Shown] {
            assert!(!bound.holds(f64::NAN) && bound.nearness(f64::NAN) > 1.0, "{bound:?}");
        }
        assert!(Bound::AtMost(2.0).nearness(1.0) < 1.0 && Bound::AtMost(0.0).nearness(1.0) > 1.0);
    }

    #[test]
    fn a_failed_part_is_a_failed_reading_and_the_next_goes_on() {
        let scheme = Scheme::preset(Preset::Default);
        let mut sheet = Sheet::new(scheme, Extent::Quick).expect("particles");
        sheet.part("first", |_| Err(Trouble::Other("nothing there".into())));
        sheet.part("second", |sheet| {
            sheet.at_most("error", 0.5, 1.0);
            Ok(())
        });
        let passed: Vec<bool> = sheet.readings.iter().map(|reading| reading.pass).collect();
        assert_eq!(passed, [false, true]);
        sheet.shown("a number", 2.0);
        let decides: Vec<bool> = sheet.readings.iter().map(Reading::decides).collect();
        assert_eq!(decides, [true, true, false]);
        let said = sheet.readings[0].said.as_deref();
        assert!(said.is_some_and(|said| said.contains("nothing there")), "{said:?}");
    }
}
