//! Claims: a quantity, what is wanted of it, of which kind, by which source. Verdicts judge them.
//!
//! The kinds are never mixed (design page "Kinds of claim"): agreement with the paper is not
//! accuracy, and accuracy is not validation.

use serde::Serialize;

use crate::convergence::{self, Level, OrderFit};
use crate::record::{Outcome, Records, RunKey, RunRecord};
use crate::report::sig;

/// Against what a claim is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// An exact solution.
    Verification,
    /// A number printed in the paper.
    Replication,
    /// An experiment.
    Validation,
    /// Another code, an own converged reference, or an equation fitted to tests.
    Comparison,
    /// Work and time.
    Cost,
    /// A hard case and its pass number.
    Stability,
}

impl Kind {
    /// Name for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Verification => "verification",
            Self::Replication => "replication",
            Self::Validation => "validation",
            Self::Comparison => "comparison",
            Self::Cost => "cost",
            Self::Stability => "stability",
        }
    }
}

/// How much depends on a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Weight {
    /// Its failure fails the run.
    Must,
    /// A goal beyond what is required.
    Aim,
    /// A known limit of the preset that it names, shown as such.
    Shown,
}

impl Weight {
    /// Name for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Must => "required",
            Self::Aim => "goal",
            Self::Shown => "shown",
        }
    }
}

/// A number that records give.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// A norm of a run.
    Norm(RunKey, &'static str),
    /// Number of particles times a norm squared: "wrong particles".
    WrongParticles(RunKey, &'static str),
    /// Fitted order of a norm over several runs.
    Order(Vec<RunKey>, &'static str),
    /// Largest error of the energy balance.
    EnergyDrift(RunKey),
    /// Largest error of the momentum balance.
    MomentumDrift(RunKey),
    /// Largest error of the angular momentum balance, in space.
    AngularDrift(RunKey),
    /// Residual of the elements over the initial kinetic energy, in space.
    Residual(RunKey),
    /// Error of the mass of the bodies as they are meshed, in space.
    GeometryMass(RunKey),
    /// A norm of the first run over that of the second, less one.
    Change(RunKey, RunKey, &'static str),
    /// Particle-steps per CPU second.
    Speed(RunKey),
    /// CPU seconds.
    CpuSeconds(RunKey),
}

/// What is wanted of a number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Wanted {
    /// No more than this.
    AtMost(f64),
    /// No less than this.
    AtLeast(f64),
    /// No further from zero than this.
    WithinZero(f64),
    /// A value, and how far from it, relative to it.
    Near(f64, f64),
    /// A value, and how far from it.
    Around(f64, f64),
}

impl Wanted {
    /// Whether a number is what is wanted. NaN never is.
    #[must_use]
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::AtMost(bound) => value <= bound,
            Self::AtLeast(bound) => value >= bound,
            Self::WithinZero(bound) => value.abs() <= bound,
            Self::Near(target, share) => (value - target).abs() <= share * target.abs(),
            Self::Around(target, band) => (value - target).abs() <= band,
        }
    }

    /// The value itself, where there is one and not a bound alone.
    #[must_use]
    pub fn target(self) -> Option<f64> {
        match self {
            Self::Near(target, _) | Self::Around(target, _) => Some(target),
            Self::AtMost(_) | Self::AtLeast(_) | Self::WithinZero(_) => None,
        }
    }

    /// The least and the greatest value that hold; infinite where there is no such bound.
    #[must_use]
    pub fn range(self) -> [f64; 2] {
        let about = |target: f64, band: f64| [target - band, target + band];
        match self {
            Self::AtMost(bound) => [f64::NEG_INFINITY, bound],
            Self::AtLeast(bound) => [bound, f64::INFINITY],
            Self::WithinZero(bound) => [-bound, bound],
            Self::Near(target, share) => about(target, share * target.abs()),
            Self::Around(target, band) => about(target, band),
        }
    }

    /// In words.
    #[must_use]
    pub fn text(self) -> String {
        match self {
            Self::AtMost(bound) => format!("≤ {}", sig(bound, 4)),
            Self::AtLeast(bound) => format!("≥ {}", sig(bound, 4)),
            Self::WithinZero(bound) => format!("|·| ≤ {}", sig(bound, 4)),
            Self::Near(target, share) => {
                format!("{} ± {} %", sig(target, 5), sig(100.0 * share, 3))
            }
            Self::Around(target, band) => format!("{} ± {}", sig(target, 4), sig(band, 3)),
        }
    }
}

/// A claim.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Claim {
    /// Case that makes it.
    pub case: &'static str,
    /// Kind.
    pub kind: Kind,
    /// Weight.
    pub weight: Weight,
    /// What is claimed, in words.
    pub what: String,
    /// The number.
    pub quantity: Quantity,
    /// What is wanted of it.
    pub wanted: Wanted,
    /// Where the wanted value and its tolerance come from.
    pub source: &'static str,
    /// Whether a constant of the method was chosen by looking at this number.
    pub in_sample: bool,
}

/// The judgement on a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The number is what is wanted.
    Pass,
    /// It is not, or the run failed.
    Fail,
    /// There is no record.
    Missing,
}

/// A judged claim.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// The claim.
    pub claim: Claim,
    /// The number, if the records give one.
    pub value: Option<f64>,
    /// The fit behind an order.
    #[serde(skip)]
    pub fit: Option<OrderFit>,
    /// The judgement.
    pub status: Status,
    /// Whether a record is older than the solver.
    pub stale: bool,
    /// Why there is no number.
    pub note: String,
}

impl Verdict {
    /// The judgement in words.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match (self.status, self.claim.weight) {
            (Status::Pass, _) => "pass",
            (Status::Missing, _) => "no record",
            (Status::Fail, weight) if self.note.starts_with(RUN_FAILED) => match weight {
                Weight::Must => "run failed",
                Weight::Aim => "run failed, goal missed",
                Weight::Shown => "run failed, as known",
            },
            (Status::Fail, Weight::Must) => "fail",
            (Status::Fail, Weight::Aim) => "goal missed",
            (Status::Fail, Weight::Shown) => "fails, as known",
        }
    }

    /// The number to `digits` digits, one that fails to as many as tell it from the bounds; why there is
    /// none, where there is none.
    #[must_use]
    pub fn found(&self, digits: usize) -> String {
        self.value.map_or(self.note.clone(), |value| sig(value, self.telling(value, digits)))
    }

    /// What is wanted, in words; beside a number that fails to be near a value with the range.
    #[must_use]
    pub fn wanted(&self) -> String {
        let wanted = self.claim.wanted;
        let text = wanted.text();
        match (self.value, wanted.target()) {
            (Some(value), Some(_)) if self.status == Status::Fail => {
                let [low, high] = wanted.range().map(|bound| sig(bound, self.telling(value, 4)));
                format!("{text} ({low} to {high})")
            }
            _ => text,
        }
    }

    /// Digits, from so many on, that tell a number that fails from its bounds.
    fn telling(&self, value: f64, digits: usize) -> usize {
        let bounds = self.claim.wanted.range();
        let same = |digits: usize| {
            bounds
                .iter()
                .any(|bound| bound.is_finite() && sig(*bound, digits) == sig(value, digits))
        };
        let fails = self.status == Status::Fail;
        (digits..MOST_DIGITS).find(|&digits| !(fails && same(digits))).unwrap_or(MOST_DIGITS)
    }
}

/// Why there is no number where a run did not come to its end.
const RUN_FAILED: &str = "run failed";

/// Digits that tell any two numbers apart.
const MOST_DIGITS: usize = 17;

/// Judges claims by records.
#[must_use]
pub fn judge(claims: Vec<Claim>, records: &Records) -> Vec<Verdict> {
    claims.into_iter().map(|claim| verdict(claim, records)).collect()
}

fn verdict(claim: Claim, records: &Records) -> Verdict {
    let keys = claim.quantity.runs();
    let found: Vec<&RunRecord> = keys.iter().filter_map(|k| records.get(k)).collect();
    let stale = found.iter().any(|r| r.provenance.is_stale());
    let failed = found.iter().find_map(|r| match &r.outcome {
        Outcome::Failed { kind, .. } => Some(format!("{RUN_FAILED}: {kind}")),
        Outcome::Completed => None,
    });
    let mut out = Verdict {
        claim,
        value: None,
        fit: None,
        status: Status::Missing,
        stale,
        note: String::new(),
    };
    if found.len() < keys.len() {
        return out;
    }
    if let Some(kind) = failed {
        return Verdict { status: Status::Fail, note: kind, ..out };
    }
    (out.value, out.fit) = out.claim.quantity.evaluate(&found);
    out.status = match out.value {
        Some(value) if out.claim.wanted.holds(value) => Status::Pass,
        Some(_) => Status::Fail,
        None => {
            out.note = "the record lacks this number".into();
            Status::Fail
        }
    };
    out
}

impl Quantity {
    /// The runs that it needs.
    #[must_use]
    pub fn runs(&self) -> Vec<RunKey> {
        match self {
            Self::Order(keys, _) => keys.clone(),
            Self::Change(a, b, _) => vec![a.clone(), b.clone()],
            Self::Norm(key, _)
            | Self::WrongParticles(key, _)
            | Self::EnergyDrift(key)
            | Self::MomentumDrift(key)
            | Self::AngularDrift(key)
            | Self::Residual(key)
            | Self::GeometryMass(key)
            | Self::Speed(key)
            | Self::CpuSeconds(key) => vec![key.clone()],
        }
    }

    /// Whether it is the error of a balance: of energy, momentum or angular momentum over a run.
    #[must_use]
    pub fn is_balance(&self) -> bool {
        matches!(self, Self::EnergyDrift(_) | Self::MomentumDrift(_) | Self::AngularDrift(_))
    }

    fn evaluate(&self, runs: &[&RunRecord]) -> (Option<f64>, Option<OrderFit>) {
        let first = runs[0];
        let norm = |run: &RunRecord, name: &str| run.norms.get(name).copied();
        let value = match self {
            Self::Norm(_, name) => norm(first, name),
            Self::WrongParticles(key, name) => norm(first, name).map(|e| key.n as f64 * e * e),
            Self::Order(_, name) => {
                let fit = order(runs, name);
                return (fit.as_ref().map(|f| f.order), fit);
            }
            Self::EnergyDrift(_) => Some(first.energy_drift),
            Self::MomentumDrift(_) => Some(first.momentum_drift),
            Self::AngularDrift(_) => first.space.map(|s| s.angular_momentum_drift),
            Self::Residual(_) => first.space.map(|s| s.ledger_residual),
            Self::GeometryMass(_) => first.space.map(|s| s.geometry_mass_error),
            Self::Change(_, _, name) => norm(first, name)
                .zip(norm(runs[1], name))
                .map(|(changed, plain)| changed / plain - 1.0),
            Self::Speed(_) => Some(first.particle_steps as f64 / first.cpu_seconds),
            Self::CpuSeconds(_) => Some(first.cpu_seconds),
        };
        (value, None)
    }
}

/// Fitted order of a norm over runs of different sizes.
#[must_use]
pub fn order(runs: &[&RunRecord], name: &str) -> Option<OrderFit> {
    let levels: Option<Vec<Level>> = runs
        .iter()
        .map(|r| Some(Level { spacing: 1.0 / r.key.n as f64, value: *r.norms.get(name)? }))
        .collect();
    convergence::fitted_order(&levels?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use whipple_solver::method::Preset;

    use crate::record::Scheme;

    /// The verdict on a number.
    fn judged(wanted: Wanted, value: f64) -> Verdict {
        let key = RunKey::new("noh", Scheme::preset(Preset::Default), 10);
        let claim = Claim {
            case: "noh",
            kind: Kind::Validation,
            weight: Weight::Must,
            what: String::new(),
            quantity: Quantity::EnergyDrift(key),
            wanted,
            source: "",
            in_sample: false,
        };
        let status = if wanted.holds(value) { Status::Pass } else { Status::Fail };
        Verdict { claim, value: Some(value), fit: None, status, stale: false, note: String::new() }
    }

    #[test]
    fn failing_numbers_differ_from_their_bounds_in_print() {
        let said = |wanted, value| {
            let verdict = judged(wanted, value);
            (verdict.found(4), verdict.wanted())
        };
        let pair = |found: &str, wanted: &str| (found.to_owned(), wanted.to_owned());
        let near = Wanted::Near(6.38, 0.05);
        assert_eq!(said(near, 6.0609), pair("6.0609", "6.3800 ± 5.00 % (6.0610 to 6.6990)"));
        assert_eq!(said(near, 5.5), pair("5.500", "6.3800 ± 5.00 % (6.061 to 6.699)"));
        assert_eq!(said(near, 6.0611), pair("6.061", "6.3800 ± 5.00 %"));
        assert_eq!(said(Wanted::AtMost(0.012), 0.012_000_01), pair("0.01200001", "≤ 0.01200"));
        assert_eq!(said(Wanted::WithinZero(0.05), -0.050_001), pair("−0.050001", "|·| ≤ 0.05000"));
        assert_eq!(said(Wanted::AtLeast(1.0), 1.0f64.next_down()).0, "0.9999999999999999");
    }
}
