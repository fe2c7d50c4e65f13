//! Times on the command line: on the clock, and simulated ones in the units of the scene or with one of
//! their own.

use std::fmt;
use std::str::FromStr;
use std::time::Duration;

use whipple_solver::units::{Dimension, Units};

use super::Failure;

/// What the messages ask for.
const WANTED: &str = "wanted a positive number in the units of the scene, such as `20`, or one with \
                      a unit: `20us`, `0.5 ms`, `2e-5s`";

/// Units of time by their names, as powers of ten of a second.
const UNITS: [(&str, i32); 6] =
    [("ns", -9), ("us", -6), ("µs", -6), ("μs", -6), ("ms", -3), ("s", 0)];

/// A time on the clock.
pub(super) fn wall_time(text: &str) -> Result<Duration, String> {
    let time = humantime::parse_duration(text).ok().filter(|time| !time.is_zero());
    time.ok_or_else(|| {
        "wanted a time above zero with its unit, such as 30s, 2min or 1h30min".into()
    })
}

/// A simulated time as it is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SimulatedTime {
    value: f64,
    /// Power of ten of a second; none for the unit of the scene.
    power: Option<i32>,
}

impl FromStr for SimulatedTime {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        // Of the names that fit, the longest: `s` ends all of them.
        let fits = |(name, _): &&(&str, i32)| text.ends_with(name);
        let unit = UNITS.iter().filter(fits).max_by_key(|(name, _)| name.len());
        let number = unit.map_or(text, |(name, _)| text[..text.len() - name.len()].trim_end());
        let value = number.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0);
        let value = value.ok_or(WANTED)?;
        Ok(Self { value, power: unit.map(|(_, power)| *power) })
    }
}

impl fmt::Display for SimulatedTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = UNITS.iter().find(|(_, power)| Some(*power) == self.power);
        write!(f, "{}{}", self.value, unit.map_or("", |(name, _)| name))
    }
}

impl SimulatedTime {
    /// The time in the units of a scene.
    pub(super) fn in_units(self, option: &str, units: Units) -> Result<f64, Failure> {
        let Some(power) = self.power else { return Ok(self.value) };
        let label = units.label(Dimension::Time);
        let own = UNITS.iter().find(|(name, _)| *name == label);
        let Some((_, own)) = own else {
            let message = format!(
                "{option} {self}: the scene has no unit of time, wanted a plain number, such as `{option} {}`",
                self.value
            );
            return Err(Failure::usage(message));
        };
        let value = match power - own {
            larger @ 0.. => self.value * 10f64.powi(larger),
            smaller => self.value / 10f64.powi(-smaller),
        };
        let usable = value.is_finite() && value > 0.0;
        let refused = || format!("{option} {self}: {WANTED}; the unit of this scene is {label}");
        if usable { Ok(value) } else { Err(Failure::usage(refused())) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(text: &str, units: Units) -> Result<f64, String> {
        text.parse::<SimulatedTime>()?.in_units("--stop", units).map_err(|failure| failure.message)
    }

    #[test]
    fn units_are_those_of_the_scene_or_given() {
        for (text, wanted) in [
            ("20", 20.0),
            ("20us", 20.0),
            ("20 µs", 20.0),
            ("5000ns", 5.0),
            ("0.5ms", 500.0),
            ("2e-5s", 20.0),
        ] {
            assert_eq!(time(text, Units::CmGUsMbar), Ok(wanted), "{text}");
        }
        let written =
            ["5us", "0.5ms", "20"].map(|t| t.parse::<SimulatedTime>().unwrap().to_string());
        assert_eq!(written, ["5us", "0.5ms", "20"]);
        assert_eq!(time("20us", Units::InLbfS), Ok(20e-6));
        assert_eq!(time("0.5", Units::None), Ok(0.5));
    }

    #[test]
    fn times_on_the_clock_have_a_unit_and_are_not_zero() {
        assert_eq!(wall_time("1h30min"), Ok(Duration::from_secs(5400)));
        assert_eq!(wall_time("1us"), Ok(Duration::from_micros(1)));
        for text in ["", "0s", "0", "30", "-3", "-3s", "soon", "5 parsecs"] {
            assert!(wall_time(text).is_err_and(|said| said.starts_with("wanted")), "{text}");
        }
    }

    #[test]
    fn other_times_are_refused() {
        for text in ["", "us", "0", "-1us", "nan", "inf s", "5 min", "1e999", "5u"] {
            assert_eq!(time(text, Units::CmGUsMbar), Err(WANTED.to_owned()), "{text}");
        }
        let said = time("1s", Units::None).unwrap_err();
        let wanted =
            "--stop 1s: the scene has no unit of time, wanted a plain number, such as `--stop 1`";
        assert_eq!(said, wanted);
        assert!(time("1e308s", Units::CmGUsMbar).is_err());
    }
}
