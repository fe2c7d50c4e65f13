//! What is known of the residual rod: Table 5 of the paper, the experiment, and what the paper says of
//! another code.

use whipple_solver::method::Preset;

use super::problem::{READINGS, SIZES};
use crate::claims::Wanted;
use crate::record::{RunKey, Scheme};

/// Particles of the rows of Table 5, coarse to fine.
pub(super) const PARTICLES: [u64; 3] = [35_992, 92_498, 187_826];

/// A quantity of the residual rod.
pub(super) struct Known {
    /// Norm of our records.
    pub(super) norm: &'static str,
    /// Name.
    pub(super) name: &'static str,
    /// Unit.
    pub(super) unit: &'static str,
    /// The experiment, as the paper quotes it.
    pub(super) measured: f64,
    /// Its standard uncertainty: none is given, a working value was chosen
    /// (`references/experiments.toml`).
    pub(super) uncertainty: f64,
    /// Table 5, coarse to fine.
    pub(super) table_5: [f64; 3],
    /// Distance from the experiment that is wanted of `default`, and from Table 5 of `paper`.
    pub(super) share: f64,
    /// Largest change with twice the plate that is wanted.
    pub(super) edge: f64,
}

pub(super) const LENGTH: Known = Known {
    norm: "residual_length_cm",
    name: "length",
    unit: "cm",
    measured: 6.38,
    uncertainty: 0.10,
    table_5: [6.08, 6.47, 6.59],
    share: 0.05,
    edge: 0.01,
};

pub(super) const VELOCITY: Known = Known {
    norm: "residual_velocity_km_s",
    name: "velocity",
    unit: "km/s",
    measured: 1.46,
    uncertainty: 0.015,
    table_5: [1.42, 1.42, 1.42],
    share: 0.02,
    edge: 0.005,
};

/// What is compared.
pub(super) const KNOWN: [Known; 2] = [LENGTH, VELOCITY];

/// "Differ by less than three percent" from Lee and Yoo, says the paper of Table 5.
const APART: f64 = 0.03;

impl Known {
    /// What the two finer rows imply for the other code: each differs from it by less than three percent
    /// of it. No number can do so for all three lengths (gap G28).
    pub(super) fn other_code(&self) -> [f64; 2] {
        let [_, finer @ ..] = self.table_5;
        let low = finer.map(|value| value / (1.0 + APART)).into_iter().fold(0.0, f64::max);
        let high = finer.map(|value| value / (1.0 - APART)).into_iter().fold(f64::MAX, f64::min);
        [low, high]
    }

    /// What is wanted of `default`.
    pub(super) fn near_experiment(&self) -> Wanted {
        Wanted::Near(self.measured, self.share)
    }

    /// What is wanted of `paper` at one of the three sizes.
    pub(super) fn near_table_5(&self, size: usize) -> Wanted {
        Wanted::Near(self.table_5[size], self.share)
    }
}

/// What a norm of a run is held against: the experiment, and Table 5 where `paper` has a row of its cells.
pub(super) fn references(key: &RunKey, norm: &str) -> Vec<(&'static str, f64)> {
    let Some(known) = KNOWN.iter().find(|known| known.norm == norm) else { return Vec::new() };
    let replicates =
        key.scheme == Scheme::preset(Preset::Paper) && READINGS.contains(&key.variant.as_str());
    let size = SIZES.iter().position(|n| *n == key.n).filter(|_| replicates);
    let row = size.map(|size| ("paper, Table 5:", known.table_5[size]));
    [("experiment", known.measured)].into_iter().chain(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::references::Table;
    use approx::assert_relative_eq;

    #[test]
    fn table_5_is_that_of_the_references() {
        let text = include_str!("../../../../references/paper_table5_rod_results.csv");
        let table = Table::parse("paper_table5_rod_results.csv", text).unwrap();
        assert_eq!(table.column("n_particles").unwrap(), PARTICLES.map(|n| n as f64));
        assert_eq!(table.column(LENGTH.norm).unwrap(), LENGTH.table_5);
        assert_eq!(table.column(VELOCITY.norm).unwrap(), VELOCITY.table_5);
        for (known, column) in KNOWN
            .iter()
            .zip(["length_error_vs_experiment_percent", "velocity_error_vs_experiment_percent"])
        {
            for (value, error) in known.table_5.iter().zip(table.column(column).unwrap()) {
                // Printed to three decimals.
                assert_relative_eq!(100.0 * (value / known.measured - 1.0), error, epsilon = 5e-4);
            }
        }
    }

    #[test]
    fn the_experiment_is_that_of_the_references() {
        let text = include_str!("../../../../references/experiments.toml");
        let all: toml::Value = toml::from_str(text).unwrap();
        let rod = all["experiment"].as_array().unwrap().iter();
        let rod = rod.clone().find(|e| e["id"].as_str() == Some("long_rod_plate")).unwrap();
        for known in &KNOWN {
            let entry = &rod[known.norm];
            assert_eq!(entry["value"].as_float(), Some(known.measured));
            assert_eq!(entry["standard_uncertainty"].as_float(), Some(known.uncertainty));
        }
    }

    /// The bounds of gap G28, to the two decimals given there.
    #[test]
    fn three_percent_bound_the_other_code() {
        for (known, bounds) in [(LENGTH, [6.40, 6.67]), (VELOCITY, [1.38, 1.46])] {
            for (found, wanted) in known.other_code().into_iter().zip(bounds) {
                assert_relative_eq!(found, wanted, epsilon = 5e-3);
            }
        }
        let [coarse, .., fine] = LENGTH.table_5;
        assert!(fine / (1.0 + APART) > coarse / (1.0 - APART), "not all three rows");
    }
}
