//! What a run leaves for its reader: text or JSON on standard output, files in its folder.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::folder::{HISTORY, PROFILE, RECORD, SCENE};
use super::{Failure, program};
use crate::cases::Case;
use crate::claims::{Claim, Kind, Quantity, Status, Verdict, Weight, judge};
use crate::files::write_atomic;
use crate::pictures::{PICTURES, write_photos};
use crate::record::{Outcome, Records, RunKey, RunRecord, Scheme, Series};
use crate::report::sig;
use crate::run::Run;
use crate::suite::write_record;

/// What `--json` prints.
#[derive(Serialize)]
struct Summary<'a> {
    case: &'a str,
    variant: &'a str,
    preset: Option<&'static str>,
    density: Option<&'static str>,
    n: usize,
    threads: usize,
    outcome: &'a Outcome,
    steps: u64,
    particle_steps: u64,
    cpu_seconds: f64,
    energy_drift: f64,
    momentum_drift: f64,
    norms: &'a BTreeMap<String, f64>,
    claims: Vec<ClaimSummary>,
    counters: Option<whipple_solver::counters::Counters>,
    limiters: Option<&'a BTreeMap<String, u64>>,
    #[serde(flatten)]
    space: Option<SpaceSummary>,
    provenance: &'a crate::record::Provenance,
}

/// A claim of the run that its record alone decides.
#[derive(Serialize)]
struct ClaimSummary {
    claim: String,
    kind: &'static str,
    weight: &'static str,
    found: Option<f64>,
    wanted: String,
    /// None of a run that was changed, of which nothing is claimed.
    verdict: Option<&'static str>,
}

/// What it prints of a run in three dimensions besides.
#[derive(Serialize)]
struct SpaceSummary {
    particles: usize,
    elements: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    residual_length_cm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    residual_velocity_km_s: Option<f64>,
    mass_error: f64,
    geometry_mass_error: f64,
    angular_momentum_drift: f64,
    ledger_residual: f64,
    failed_elements: usize,
    updates_per_cpu_second: f64,
    bytes_per_particle: f64,
}

impl SpaceSummary {
    fn new(record: &RunRecord) -> Option<Self> {
        let space = record.space?;
        let norm = |name: &str| record.norms.get(name).copied();
        Some(Self {
            particles: space.particles,
            elements: space.elements,
            residual_length_cm: norm("residual_length_cm"),
            residual_velocity_km_s: norm("residual_velocity_km_s"),
            mass_error: space.mass_error,
            geometry_mass_error: space.geometry_mass_error,
            angular_momentum_drift: space.angular_momentum_drift,
            ledger_residual: space.ledger_residual,
            failed_elements: space.failed_elements,
            updates_per_cpu_second: space.updates_per_cpu_second,
            bytes_per_particle: space.bytes_per_particle,
        })
    }
}

/// One JSON object with everything that a script needs.
pub(super) fn json(bounds: &Bounds, record: &RunRecord) -> Result<String, Failure> {
    let (preset, density) = match record.key.scheme {
        Scheme::Godunov => (None, None),
        Scheme::Particles { preset, density } => (Some(preset.name()), Some(density.name())),
    };
    let summary = Summary {
        case: &record.key.case,
        variant: &record.key.variant,
        preset,
        density,
        n: record.key.n,
        threads: record.threads,
        outcome: &record.outcome,
        steps: record.steps,
        particle_steps: record.particle_steps,
        cpu_seconds: record.cpu_seconds,
        energy_drift: record.energy_drift,
        momentum_drift: record.momentum_drift,
        norms: &record.norms,
        claims: bounds.verdicts(record).iter().map(|verdict| bounds.claimed(verdict)).collect(),
        counters: record.counters,
        limiters: record.limiters.as_ref(),
        space: SpaceSummary::new(record),
        provenance: &record.provenance,
    };
    let text = serde_json::to_string_pretty(&summary).map_err(Failure::usage)?;
    Ok(text + "\n")
}

/// What is wanted of the numbers of a run.
pub(super) struct Bounds<'a> {
    case: &'a dyn Case,
    /// The run of the case as it stands.
    key: RunKey,
    /// What `--set` and `--stop` made another run of it by, of which nothing is claimed.
    changes: String,
}

impl<'a> Bounds<'a> {
    /// Those of the run `key` of a case, or of one that was changed.
    pub(super) fn new(case: &'a dyn Case, key: RunKey, changes: &[String]) -> Self {
        Self { case, key, changes: changes.join(", ") }
    }

    /// Whether the run is not of the case as it stands.
    fn is_changed(&self) -> bool {
        !self.changes.is_empty()
    }

    /// The claims of the run that its record alone decides.
    fn verdicts(&self, record: &RunRecord) -> Vec<Verdict> {
        if record.outcome != Outcome::Completed {
            return Vec::new();
        }
        let mut records = Records::default();
        records.insert(RunRecord { key: self.key.clone(), ..record.clone() });
        let own = |claim: &Claim| claim.quantity.runs().iter().all(|key| *key == self.key);
        judge(self.case.claims().into_iter().filter(own).collect(), &records)
    }

    /// A verdict for scripts.
    fn claimed(&self, verdict: &Verdict) -> ClaimSummary {
        let Claim { what, kind, weight, wanted, .. } = &verdict.claim;
        ClaimSummary {
            claim: what.clone(),
            kind: kind.name(),
            weight: weight.name(),
            found: verdict.value,
            wanted: wanted.text(),
            verdict: (!self.is_changed()).then(|| verdict.word()),
        }
    }

    /// What is wanted of a number and, in a run of the case as it stands, whether it is that.
    fn judgement(&self, verdict: &Verdict) -> String {
        let wanted = self.wanted(verdict);
        if self.is_changed() { wanted } else { format!("{wanted}: {}", verdict.word()) }
    }

    /// What a claim wants, after what it is held against; of a run that was changed nothing fails.
    fn wanted(&self, verdict: &Verdict) -> String {
        let claim = &verdict.claim;
        let wanted = if self.is_changed() { claim.wanted.text() } else { verdict.wanted() };
        match (claim.wanted.target(), claim.weight) {
            (Some(target), _) => format!("{} {wanted}", self.against(claim, target)),
            (None, Weight::Aim) => format!("goal {wanted}"),
            (None, _) => format!("wanted {wanted}"),
        }
    }

    /// What a claim is held against, as its case calls it, or by its kind.
    fn against(&self, claim: &Claim, target: f64) -> &'static str {
        let Quantity::Norm(key, norm) = &claim.quantity else { return against(claim.kind) };
        let named = self.case.references(key, norm);
        let same = |(_, value): &&(&str, f64)| *value == target;
        named.iter().find(same).map_or(against(claim.kind), |(name, _)| name)
    }

    /// What a number of which nothing is claimed is held against: what the case knows of it, or the value of
    /// other runs of the variant, if it is one for all sizes.
    fn elsewhere(&self, name: &str) -> Option<String> {
        let known = self.case.references(&self.key, name);
        if !known.is_empty() {
            let known = known.iter().map(|(by, value)| format!("{by} {}", sig(*value, 5)));
            return Some(known.collect::<Vec<_>>().join("; "));
        }
        let claims = self.case.claims();
        let mut values = claims.iter().filter_map(|claim| {
            let Quantity::Norm(key, norm) = &claim.quantity else { return None };
            let target = claim.wanted.target()?;
            let same = *norm == name && key.variant == self.key.variant;
            same.then(|| format!("{} {}", against(claim.kind), sig(target, 5)))
        });
        let first = values.next()?;
        values.all(|other| other == first).then_some(first)
    }
}

/// What a claim of a kind is held against.
fn against(kind: Kind) -> &'static str {
    match kind {
        Kind::Verification => "exact",
        Kind::Replication => "paper",
        Kind::Validation => "experiment",
        Kind::Comparison => "reference",
        Kind::Cost | Kind::Stability => "wanted",
    }
}

/// Name of the row that a quantity is printed in, if it has one.
fn row_of(quantity: &Quantity) -> Option<&str> {
    Some(match quantity {
        Quantity::Norm(_, name) => name,
        Quantity::EnergyDrift(_) => ENERGY,
        Quantity::MomentumDrift(_) => MOMENTUM,
        Quantity::AngularDrift(_) => ANGULAR,
        Quantity::Residual(_) => RESIDUAL,
        Quantity::GeometryMass(_) => GEOMETRY,
        Quantity::WrongParticles(..)
        | Quantity::Order(..)
        | Quantity::Change(..)
        | Quantity::Speed(_)
        | Quantity::CpuSeconds(_) => return None,
    })
}

/// Norms that are counts.
const COUNTS: [&str; 3] = ["particles", "failed_elements", "dead_elements"];
const ENERGY: &str = "energy drift";
const MOMENTUM: &str = "momentum drift";
const ANGULAR: &str = "angular momentum drift";
const RESIDUAL: &str = "residual of elements";
const GEOMETRY: &str = "error of the meshed mass";

/// What stands for a norm that is none.
const NO_NUMBER: &str = "no number";

/// Ends of the names of norms, and the units that they say; of those that fit the longest counts.
const UNITS: [(&str, &str); 13] = [
    ("_cm", "cm"),
    ("_mm", "mm"),
    ("_us", "µs"),
    ("_cm_us", "cm/µs"),
    ("_g_cm_us", "g·cm/µs"),
    ("_m_s", "m/s"),
    ("_km_s", "km/s"),
    // Of waves in solids, whose scenes have units.
    ("_speed", "km/s"),
    ("_g", "g"),
    ("_deg", "°"),
    ("_khz", "kHz"),
    ("_cells", "cells"),
    ("_spacings", "spacings"),
];

/// Unit of a norm, if it has one: what its name says, or what the title says that the report gives it.
fn unit_of(case: &dyn Case, norm: &str) -> Option<&'static str> {
    let fits = UNITS.iter().filter(|(end, _)| norm.ends_with(end));
    let named = fits.max_by_key(|(end, _)| end.len()).map(|(_, unit)| *unit);
    named.or_else(|| {
        let (_, title) = case.tabulated().iter().find(|(name, _)| *name == norm)?;
        // Units alone have a stroke: what else stands behind a comma is words.
        title
            .rsplit_once(", ")
            .map(|(_, end)| end)
            .filter(|end| end.contains('/') && !end.contains(' '))
    })
}

/// The numbers of a run, a line each, with what is wanted of them.
pub(super) fn text(bounds: &Bounds, record: &RunRecord) -> String {
    let case = bounds.case;
    let key = &record.key;
    let mut out = format!("{}: {}, n = {}", case.title(), key.scheme.label(), key.n);
    if !key.variant.is_empty() {
        out += &format!(", variant {}", key.variant);
    }
    if !bounds.changes.is_empty() {
        out += &format!(", changed by {}", bounds.changes);
    }
    out += "\n";
    let verdicts = bounds.verdicts(record);
    let mut row = |name: &str, value: String| {
        let own = || verdicts.iter().filter(|v| row_of(&v.claim.quantity) == Some(name));
        let mut wanted: Vec<String> = own().map(|v| bounds.judgement(v)).collect();
        // One that fails has the digits that show it.
        let failing = own().filter(|v| v.status == Status::Fail && !bounds.is_changed());
        let value = failing.map(|v| v.found(5)).max_by_key(String::len).unwrap_or(value);
        let value = match unit_of(case, name) {
            Some(unit) if value != NO_NUMBER => format!("{value} {unit}"),
            _ => value,
        };
        if wanted.is_empty() {
            wanted.extend(bounds.elsewhere(name));
        }
        let line = format!("  {name:<30} {value:<16} {}", wanted.join("; "));
        out += line.trim_end();
        out += "\n";
    };
    for (name, value) in &record.norms {
        let counted = COUNTS.contains(&name.as_str());
        row(
            name,
            match value {
                value if value.is_nan() => NO_NUMBER.into(),
                value if counted => value.to_string(),
                value => sig(*value, 5),
            },
        );
    }
    row(ENERGY, sig(record.energy_drift, 2));
    row(MOMENTUM, sig(record.momentum_drift, 2));
    if let Some(space) = &record.space {
        row(ANGULAR, sig(space.angular_momentum_drift, 2));
        row(RESIDUAL, sig(space.ledger_residual, 2));
        row(GEOMETRY, sig(space.geometry_mass_error, 2));
        let [particles, failed, _] = COUNTS;
        let mut once = |norm: &str, name: &str, count: usize| {
            if record.norms.get(norm) != Some(&(count as f64)) {
                row(name, count.to_string());
            }
        };
        once(particles, "particles of the scene", space.particles);
        once("", "elements", space.elements);
        once(failed, "failed elements", space.failed_elements);
        row("updates per CPU second", sig(space.updates_per_cpu_second, 3));
        row("bytes per particle", sig(space.bytes_per_particle, 3));
    }
    let counters = record.counters.unwrap_or_default();
    for (name, held) in [("least", counters.floored), ("greatest", counters.packed)] {
        if held > 0 {
            row(&format!("held at the {name} density"), held.to_string());
        }
    }
    row("steps", record.steps.to_string());
    row("particle-steps", record.particle_steps.to_string());
    row("CPU seconds", sig(record.cpu_seconds, 3));
    for verdict in verdicts.iter().filter(|v| row_of(&v.claim.quantity).is_none()) {
        let value = verdict.found(4);
        out += &format!("  {}: {value}, {}\n", verdict.claim.what, bounds.judgement(verdict));
    }
    // Of a scene of the user's own nothing is ever claimed.
    if record.outcome != Outcome::Completed || case.claims().is_empty() {
        return out;
    }
    let note = match (verdicts.is_empty(), bounds.is_changed()) {
        (true, _) => "No claim is made of this run alone",
        (false, true) => "What is wanted is of the case as it stands, and not judged here",
        (false, false) => "Orders and changes are claimed of several runs",
    };
    out + &format!("{note}; `{} list {}` has all claims.\n", program(), case.id())
}

/// Writes the record, the frozen scene, the fields and the pictures.
pub(super) fn write_outputs(out: &Path, case: &dyn Case, done: &Run) -> Result<(), Failure> {
    let record = &done.record;
    if let Some(scene) = &record.scene {
        let toml = toml::to_string_pretty(scene).map_err(Failure::usage)?;
        write_atomic(&out.join(SCENE), toml.as_bytes())?;
    }
    for (name, series) in [(PROFILE, &record.profile), (HISTORY, &record.history)] {
        if let Some(series) = series {
            write_atomic(&out.join(name), csv(case, series)?.as_bytes())?;
        }
    }
    if !done.photos.is_empty() {
        write_photos(&out.join(PICTURES), &done.photos)?;
    }
    // Last, so that a record always has its fields beside it.
    Ok(write_record(&out.join(RECORD), record)?)
}

/// Columns under heads with their units, as in the tables of the report.
fn csv(case: &dyn Case, series: &Series) -> Result<String, Failure> {
    let head = |name: &String| match case.units().iter().find(|(column, _)| column == name) {
        Some((_, unit)) if !unit.is_empty() => format!("{name} ({unit})"),
        _ => name.clone(),
    };
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed = |e: csv::Error| Failure::usage(format!("cannot make a CSV table: {e}"));
    writer.write_record(series.0.keys().map(head)).map_err(failed)?;
    let rows = series.0.values().map(Vec::len).max().unwrap_or(0);
    for k in 0..rows {
        let cell = |column: &Vec<f64>| column.get(k).map_or(String::new(), ToString::to_string);
        writer.write_record(series.0.values().map(cell)).map_err(failed)?;
    }
    let bytes = writer.into_inner().map_err(Failure::usage)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
