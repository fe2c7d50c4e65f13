//! Sections of the report that are not about one case.

use crate::cases::Case;
use crate::claims::{Kind, Status as Judged, Verdict, Weight};
use crate::record::{Outcome, Records, RunKey, RunRecord, Scheme};
use crate::report::{Block, Cell, Column, Section, Status, Summary, Table, Tally, sig};
use crate::words::{counted, either};

/// The verdict in a sentence, with counts. Cases that were not run are named, and not counted.
pub(super) fn verdict(verdicts: &[Verdict], not_run: &[&dyn Case]) -> Summary {
    let count = |weight, status| {
        verdicts.iter().filter(|v| v.claim.weight == weight && v.status == status).count()
    };
    let required = tally(verdicts);
    let Tally { held: passed, failed, missing } = required;
    let claims = counted(required.all(), ["required claim", "required claims"]);
    let mut text = format!("{passed} of {claims} {}", either(passed, ["holds", "hold"]));
    let balances = tally(verdicts.iter().filter(|v| v.claim.quantity.is_balance()));
    if balances.all() > 0 {
        let (held, all) = (balances.held, balances.all());
        text += &format!(
            ": {held} of {all} of conservation (a run keeps energy and momentum to round-off), {} of {} of \
             everything else",
            passed - held,
            required.all() - all
        );
    }
    if missing > 0 {
        text += &format!("; {} no record", counted(missing, ["has", "have"]));
    }
    let aims = (count(Weight::Aim, Judged::Pass), count(Weight::Aim, Judged::Fail));
    text += ".";
    if aims.0 + aims.1 > 0 {
        let (all, are) = (aims.0 + aims.1, either(aims.0, ["is", "are"]));
        text += &format!(" Of the goals beyond them {} of {all} {are} reached.", aims.0);
    }
    let stale = verdicts.iter().filter(|v| v.stale).count();
    if stale > 0 {
        let claims = counted(stale, ["claim rests", "claims rest"]);
        text += &format!(" {claims} on records older than the solver.");
    }
    if !not_run.is_empty() {
        let were_not = ["case was not run, and is", "cases were not run, and are"];
        text += &format!(" {} not counted.", counted(not_run.len(), were_not));
    }
    let mut counts = vec![(Status::Pass, passed), (Status::Fail, failed)];
    if missing > 0 {
        counts.push((Status::Warn, missing));
    }
    if stale > 0 {
        counts.push((Status::Stale, stale));
    }
    Summary { text, counts }
}

/// How the required claims among some verdicts stand.
pub(super) fn tally<'a>(verdicts: impl IntoIterator<Item = &'a Verdict>) -> Tally {
    let required = verdicts.into_iter().filter(|v| v.claim.weight == Weight::Must);
    required.fold(Tally::default(), |mut tally, verdict| {
        match verdict.status {
            Judged::Pass => tally.held += 1,
            Judged::Fail => tally.failed += 1,
            Judged::Missing => tally.missing += 1,
        }
        tally
    })
}

/// What failed, how many claims of each kind there are, and what was not run.
pub(super) fn summary(verdicts: &[Verdict], not_run: &[&dyn Case]) -> Section {
    let failed = verdicts.iter().filter(|v| v.status == Judged::Fail);
    let (required, other): (Vec<&Verdict>, Vec<&Verdict>) =
        failed.partition(|v| v.claim.weight == Weight::Must);
    let mut blocks = vec![Block::Table(kinds_table(verdicts))];
    if !not_run.is_empty() {
        let names: Vec<&str> = not_run.iter().map(|case| case.id()).collect();
        let text = format!(
            "Not run, so that nothing here speaks of them: {}. `whipple vv` without a name runs all.",
            names.join(", ")
        );
        blocks.push(Block::Callout { kind: Status::Info, text });
    }
    if !required.is_empty() {
        blocks.push(Block::Table(claims_table(
            "failed",
            "Required claims that fail.",
            &required,
            true,
        )));
    }
    if !other.is_empty() {
        let caption = "Goals not reached, and known limits that are shown: of the paper's method in rows of \
                       `paper`, of this project's own in rows of `default`.";
        blocks.push(Block::Table(claims_table("not-reached", caption, &other, true)));
    }
    Section::new("summary", "Summary", blocks)
}

/// How many claims of each kind there are, by weight and judgement; balances, which most cases claim of
/// their runs, apart from the rest.
fn kinds_table(verdicts: &[Verdict]) -> Table {
    let kinds = [
        Kind::Verification,
        Kind::Replication,
        Kind::Validation,
        Kind::Comparison,
        Kind::Cost,
        Kind::Stability,
    ];
    let balance = |v: &Verdict| v.claim.quantity.is_balance();
    let mut groups: Vec<(String, Vec<&Verdict>)> =
        vec![("conservation".into(), verdicts.iter().filter(|v| balance(v)).collect())];
    groups.extend(kinds.map(|kind| {
        let own = |v: &&Verdict| v.claim.kind == kind && !balance(v);
        (kind.name().into(), verdicts.iter().filter(own).collect())
    }));
    let mut rows = Vec::new();
    for (name, verdicts) in groups {
        let of = |weight, status| {
            let matches = |v: &&&Verdict| v.claim.weight == weight && v.status == status;
            Cell::count(verdicts.iter().filter(matches).count() as u64)
        };
        rows.push(vec![
            name.into(),
            of(Weight::Must, Judged::Pass),
            of(Weight::Must, Judged::Fail),
            of(Weight::Must, Judged::Missing),
            of(Weight::Aim, Judged::Pass),
            of(Weight::Aim, Judged::Fail),
        ]);
    }
    let number = |name: &str| Column::number(name, "");
    let columns = vec![
        Column::text("kind"),
        number("required: hold"),
        number("fail"),
        number("no record"),
        number("goals: reached"),
        number("missed"),
    ];
    let caption = "Claims by kind. Conservation is the part of verification that says of a run that energy and \
                   momentum stay to round-off, and nothing of its accuracy. Validation needs an experiment: the \
                   long rod and the Taylor impacts have one; the plate of carbon-carbon has an equation fitted to tests, which is a comparison.";
    Table { id: "kinds".into(), caption: caption.into(), columns, rows }
}

/// A number that leads to the record of the run that found it.
pub(super) fn recorded(text: &str, key: &RunKey) -> String {
    format!("[{text}](records/{})", key.file_name())
}

/// A table of verdicts. `apart`: it does not stand in the section of its cases, and leads there.
pub(super) fn claims_table(id: &str, caption: &str, verdicts: &[&Verdict], apart: bool) -> Table {
    let columns = vec![
        // What a narrow screen shows comes first.
        Column::text("claim"),
        Column::text("verdict"),
        Column::number("found", ""),
        Column::number("wanted", ""),
        Column::text("kind"),
        Column::text("by what source"),
    ];
    let rows = verdicts.iter().map(|v| claim_row(v, apart)).collect();
    Table { id: id.into(), caption: caption.into(), columns, rows }
}

fn claim_row(verdict: &Verdict, apart: bool) -> Vec<Cell> {
    let claim = &verdict.claim;
    // A number of one run leads to its record, one of several to the table of all runs, and from there to theirs.
    let linked = |text: String| match claim.quantity.runs().as_slice() {
        [key] => recorded(&text, key),
        _ => format!("[{text}](#tab-{}-norms)", claim.case),
    };
    let found = match (verdict.value, &verdict.fit) {
        (Some(value), Some(fit)) => {
            let (low, high) = fit.interval;
            let none = if fit.is_order() { "" } else { "no order: " };
            let found = linked(verdict.found(4));
            let text = format!("{none}{found} [{}, {}]", sig(low, 4), sig(high, 4));
            Cell { text, value: Some(value), status: None }
        }
        (Some(value), None) => Cell { text: linked(verdict.found(5)), ..Cell::number(value, 5) },
        (None, _) if verdict.status == Judged::Fail => verdict.note.clone().into(),
        (None, _) => "–".into(),
    };
    let status = match (verdict.status, claim.weight) {
        (Judged::Pass, _) => Some(Status::Pass),
        (Judged::Missing, _) => Some(Status::Warn),
        (Judged::Fail, Weight::Must) => Some(Status::Fail),
        (Judged::Fail, _) => None,
    };
    let word = verdict.word();
    let word = if verdict.stale { format!("{word}, stale") } else { word.into() };
    let mut source = claim.source.to_owned();
    if claim.in_sample {
        source += "; in sample";
    }
    let kind = match claim.weight {
        Weight::Must => claim.kind.name().to_owned(),
        other => format!("{}, {}", claim.kind.name(), other.name()),
    };
    let case = if apart { format!("[{0}](#{0})", claim.case) } else { claim.case.to_owned() };
    let what = format!("{case}: {}", claim.what);
    vec![
        what.into(),
        Cell { status, ..Cell::text(word) },
        found,
        // A sign stays with its number.
        verdict.wanted().replace("≤ ", "≤\u{a0}").replace("≥ ", "≥\u{a0}").into(),
        kind.into(),
        source.into(),
    ]
}

/// Text without inline markup.
pub(super) fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('*', "\\*").replace('`', "\\`").replace('$', "\\$")
}

/// How to read the rest.
pub(super) fn reading() -> Section {
    let items = [
        "*Verification*: against an exact solution. *Replication*: against a number printed in the \
         paper, whatever its accuracy. *Validation*: against an experiment. *Comparison*: against \
         another code, an own converged reference or an equation fitted to tests. *Cost*: work and time. \
         *Stability*: a hard case with its pass number.",
        "`paper` is the paper's method as it stands, with the repairs without which it does not run: \
         it exists for replication and is not Galilean invariant. Claims rest on `default` unless they \
         name `paper`. `default + kernel` has an evolving kernel density in its place and all else equal. \
         *Godunov* is a second-order Eulerian code of this project that shares nothing with the \
         particle solver: a second opinion.",
        "*Required* claims decide the verdict. A *goal* goes beyond them. A *shown* claim states a known \
         limit of the preset that it names: its failure is expected and stands here with its figure.",
        "*In sample*: a constant of the method was chosen by looking at this number.",
        "A number that was found leads to the record of its run, in which the command stands that repeats it; one of \
         several runs leads to the table of all runs of its case. [All records and commands](#commands) stand in one \
         table.",
        "Orders are fitted by least squares over all sizes; the interval in brackets is 95 %; where it is \
         wider than the order itself the errors are said to have *no order*. Shocks \
         are captured over a fixed number of particles, so that RMS norms converge with order 1/2 and \
         L1 norms with order 1 at best.",
    ];
    let equations = [
        Block::Paragraph("The norms of the paper are root mean squares over the particles:".into()),
        Block::Equation {
            tex: r"\| e \|_v = \left( \frac{1}{n} \sum_{i=1}^n ( v_i - \hat{v}(x_i) )^2 \right)^{1/2}"
                .into(),
            number: Some("81".into()),
        },
        Block::Paragraph(
            "L1 norms weigh the error of a particle with its mass; those of shock tubes are divided \
             by the range of the exact field. The window norm of the wall shock is $\\sum |e| \\, l / \
             \\sum l$ over 0.025 < x < 0.175 with $l$ the length of a particle."
                .into(),
        ),
    ];
    let mut blocks = vec![Block::List(items.map(String::from).to_vec())];
    blocks.extend(equations);
    Section::new("reading", "How to read this report", blocks)
}

/// Conservation of every completed run.
pub(super) fn conservation(records: &Records) -> Section {
    let columns = vec![
        Column::text("case"),
        Column::text("scheme"),
        Column::number("n", ""),
        Column::number("energy drift", ""),
        Column::number("momentum drift", ""),
        Column::number("steps", ""),
        Column::text("time step limited by"),
    ];
    let particles = |r: &&RunRecord| matches!(r.key.scheme, Scheme::Particles { .. });
    let rows = records.iter().filter(particles).map(|r| {
        let mut row =
            vec![named(r).into(), r.key.scheme.label().into(), Cell::count(r.key.n as u64)];
        row.extend(match &r.outcome {
            Outcome::Completed => [drift(r.energy_drift), drift(r.momentum_drift)],
            Outcome::Failed { kind, .. } => [format!("failed: {kind}").into(), "–".into()],
        });
        row.push(Cell::count(r.steps));
        row.push(limited_by(r).into());
        row
    });
    let table = Table {
        id: "conservation".into(),
        caption: "Balance of energy and momentum, work and impulse of the boundaries taken off. \
                  Energy: largest error over the run relative to the initial kinetic energy, or to \
                  the work of the boundaries, or to the initial energy, whichever is first not zero. \
                  Mass is conserved exactly: particles are neither made nor deleted. What votes on the \
                  time steps of a run in three dimensions, and how, stands in the `ledger.csv` that `whipple \
                  run --out` writes."
            .into(),
        columns,
        rows: rows.collect(),
    };
    Section::new("conservation", "Conservation", vec![Block::Table(table)])
}

/// An error of a balance; one of a hundredth or more wants a look.
fn drift(value: f64) -> Cell {
    let cell = Cell::number(value, 2);
    if value < 0.01 { cell } else { cell.status(Status::Warn) }
}

fn named(record: &RunRecord) -> String {
    if record.key.variant.is_empty() {
        record.key.case.clone()
    } else {
        format!("{} ({})", record.key.case, record.key.variant)
    }
}

/// The limiters that decided at least a hundredth of the steps, with their shares, the most frequent first.
fn limited_by(record: &RunRecord) -> String {
    let Some(decided) = &record.limiters else {
        return String::new();
    };
    let total: u64 = decided.values().sum();
    let share = |n: u64| 100.0 * n as f64 / total.max(1) as f64;
    let mut often: Vec<_> = decided.iter().filter(|&(_, &n)| share(n) >= 1.0).collect();
    often.sort_by_key(|&(_, &n)| std::cmp::Reverse(n));
    let parts: Vec<String> =
        often.into_iter().map(|(name, &n)| format!("{name} {} %", sig(share(n), 2))).collect();
    parts.join(", ")
}

/// Work and time of every run.
pub(super) fn cost(records: &Records) -> Section {
    let columns = vec![
        Column::text("case"),
        Column::text("scheme"),
        Column::number("n", ""),
        Column::number("particle-steps", ""),
        Column::number("CPU", "s"),
        Column::number("rate", "10⁶/s"),
        Column::number("sweeps a stage", ""),
        Column::number("pairs a particle and sweep", ""),
        Column::number("kernel evaluations a particle-step", ""),
    ];
    let rows = records.iter().filter(|r| r.outcome == Outcome::Completed).map(|r| {
        let mut row = vec![
            named(r).into(),
            r.key.scheme.label().into(),
            Cell::count(r.key.n as u64),
            Cell::count(r.particle_steps),
            Cell::number(r.cpu_seconds, 3),
            Cell::number(1e-6 * r.particle_steps as f64 / r.cpu_seconds, 3),
        ];
        match (r.counters, r.space) {
            (Some(c), Some(space)) => {
                // Lists are kept over steps: what is counted is their length in every step.
                let listed = c.pairs as f64 / c.steps as f64 / space.particles as f64;
                row.extend(["–".into(), Cell::number(listed, 3)]);
                let steps = c.particle_steps as f64;
                row.push(Cell::number(c.kernel_evaluations as f64 / steps, 3));
            }
            (Some(c), None) if c.stages > 0 => {
                let stages = c.stages as f64;
                row.push(Cell::number(c.sweeps as f64 / stages, 3));
                row.push(Cell::number(c.pairs as f64 / stages / r.key.n as f64, 3));
                let steps = c.particle_steps as f64;
                row.push(Cell::number(c.kernel_evaluations as f64 / steps, 3));
            }
            _ => row.extend(["–", "–", "–"].map(Cell::text)),
        }
        row
    });
    let table = Table {
        id: "cost".into(),
        caption: "Work and CPU time of the stepping, one thread. Counts are exact and the same on any \
                  machine; times are those of the machine named below and are not claims unless the \
                  tables above make them one."
            .into(),
        columns,
        rows: rows.collect(),
    };
    let about = "A step has two stages. A stage sweeps once over the neighbours for the density rate \
                 and the forces together; a kernel density needs a sweep of its own before it. The \
                 compatible integrator adds a light sweep that turns forces into work. In three \
                 dimensions a list of pairs serves many steps, and holds what may touch: counted are \
                 its pairs. Between particles of live elements there are none where elements carry \
                 the pressure. `whipple bench rod` says where the time goes.";
    Section::new("cost", "Cost", vec![Block::Paragraph(about.into()), Block::Table(table)])
}

/// Where the numbers come from.
pub(super) fn provenance(records: &Records) -> Section {
    let mut seen: Vec<(&crate::record::Provenance, usize, &str, &str)> = Vec::new();
    for record in records.iter() {
        let p = &record.provenance;
        let same = |q: &crate::record::Provenance| {
            (&q.fingerprint, &q.commit, &q.rustc, &q.build, &q.cpu)
                == (&p.fingerprint, &p.commit, &p.rustc, &p.build, &p.cpu)
        };
        match seen.iter_mut().find(|(q, ..)| same(q)) {
            Some((_, count, first, last)) => {
                *count += 1;
                *first = (*first).min(p.date.as_str());
                *last = (*last).max(p.date.as_str());
            }
            None => seen.push((p, 1, &p.date, &p.date)),
        }
    }
    let mut blocks = Vec::new();
    for (p, count, first, last) in seen {
        if p.is_stale() {
            blocks.push(Block::Callout {
                kind: Status::Stale,
                text: "The records below are older than the solver of this program.".into(),
            });
        }
        let rows = [
            ("records", count.to_string()),
            ("program", format!("whipple {}", p.version)),
            ("commit", p.commit.clone()),
            ("fingerprint of the sources", p.fingerprint.clone()),
            ("compiler", p.rustc.clone()),
            ("build", p.build.clone()),
            ("processor", p.cpu.clone()),
            ("system", p.os.clone()),
            ("run between", format!("{first} and {last}")),
        ];
        blocks.push(Block::Definitions(rows.map(|(k, v)| (k.to_owned(), escaped(&v))).to_vec()));
    }
    let again = "Every record names the command that repeats it; `whipple vv` runs them all, \
                 `whipple report` redraws this page from the records.";
    blocks.push(Block::Paragraph(again.into()));
    Section::new("provenance", "Provenance", blocks)
}

/// Every run with its record and the command that repeats it.
pub(super) fn commands(records: &Records) -> Section {
    let rows = records.iter().map(|record| {
        let file = record.key.file_name();
        let name = file.trim_end_matches(".json");
        vec![recorded(name, &record.key).into(), format!("`{}`", record.provenance.command).into()]
    });
    let table = Table {
        id: "runs".into(),
        caption: "Records of all runs and the commands that repeat them, with `--out DIR` for the record, the fields \
                  and pictures."
            .into(),
        columns: vec![Column::text("record"), Column::text("command")],
        rows: rows.collect(),
    };
    Section::new("commands", "Records and commands", vec![Block::Table(table)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::find;
    use crate::claims::judge;

    /// One of what is counted has a sentence of its own.
    #[test]
    fn the_verdict_has_singulars() {
        let case = find("heat-chain").expect("the case");
        let mut claims = case.claims();
        claims.retain(|claim| claim.weight == Weight::Must && !claim.quantity.is_balance());
        claims.truncate(2);
        let text = |claims: &[crate::claims::Claim], not_run: &[&dyn Case]| {
            verdict(&judge(claims.to_vec(), &Records::default()), not_run).text
        };
        assert_eq!(
            text(&claims[..1], &[case]),
            "0 of 1 required claim hold; 1 has no record. 1 case was not run, and is not counted."
        );
        assert_eq!(
            text(&claims, &[case, case]),
            "0 of 2 required claims hold; 2 have no record. 2 cases were not run, and are not counted."
        );
    }
}
