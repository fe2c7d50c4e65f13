//! Claims: a quantity, what is wanted of it, of which kind, by which source. Verdicts judge them.
//!
//! The kinds are never mixed (design page "Kinds of claim"): agreement with the paper is not
//! accuracy, and accuracy is not validation.

use serde::Serialize;

use crate::convergence::{self, Level, OrderFit};
use crate::record::{Outcome, Records, RunKey, RunRecord};

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
    /// Another code, or an own converged reference.
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

    /// In words.
    #[must_use]
    pub fn text(self) -> String {
        use crate::report::sig;
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
            (Status::Fail, Weight::Must) => "fail",
            (Status::Fail, Weight::Aim) => "goal missed",
            (Status::Fail, Weight::Shown) => "fails, as known",
        }
    }
}

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
        Outcome::Failed { kind, .. } => Some(format!("run failed: {kind}")),
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
