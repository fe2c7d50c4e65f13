//! The section of one case.

use crate::cases::{Case, Level as Extent};
use crate::claims::{Verdict, order};
use crate::convergence::{self, Behaviour, Level};
use crate::plots::Figure;
use crate::record::{Outcome, Records, RunKey, RunRecord, Scheme};
use crate::report::{Block, Cell, Column, Section, Status, Table, sig};
use crate::suite::command_of;
use crate::words::{counted, either};

use super::front::{claims_table, escaped, recorded, tally};

/// Section and figures of a case.
pub(super) fn section(
    case: &dyn Case,
    records: &Records,
    verdicts: &[Verdict],
) -> (Section, Vec<Figure>) {
    let mut blocks = vec![
        Block::Paragraph(case.about().into()),
        Block::Paragraph(format!("*Source:* {}.", case.source())),
    ];
    let claims: Vec<&Verdict> = verdicts.iter().filter(|v| v.claim.case == case.id()).collect();
    if !claims.is_empty() {
        let id = format!("{}-claims", case.id());
        blocks.push(Block::Table(claims_table(
            &id,
            &format!("Claims: {}.", case.title()),
            &claims,
            false,
        )));
    }
    blocks.extend(case.extra_tables(records).into_iter().map(Block::Table));
    let runs: Vec<&RunRecord> = records.of_case(case.id()).collect();
    blocks.push(Block::Table(norms_table(case, &runs)));
    blocks.extend(missing(case, records));
    let failures: Vec<String> = runs.iter().filter_map(|r| failure(r)).collect();
    if !failures.is_empty() {
        blocks.push(Block::Paragraph("Runs that ended in a numerical failure:".into()));
        blocks.push(Block::List(failures));
    }
    blocks.extend(orders_table(case, &runs).map(Block::Table));
    blocks.extend(grid_table(case, &runs).map(Block::Table));

    let figures = case.figures(records);
    for figure in &figures {
        blocks.push(Block::Figure { id: figure.id.clone(), caption: figure.caption.clone() });
    }
    for picture in runs.iter().flat_map(|run| &run.pictures) {
        let caption = picture.caption.clone();
        blocks.push(Block::Picture { id: picture.id.clone(), caption });
    }
    let tally = Some(tally(claims)).filter(|tally| tally.all() > 0);
    (Section { tally, ..Section::new(case.id(), case.title(), blocks) }, figures)
}

/// The runs of the case that have no record, with the commands that make them.
fn missing(case: &dyn Case, records: &Records) -> Vec<Block> {
    let runs = case.runs(Extent::Full);
    let unmade = |key: &&RunKey| records.get(key).is_none();
    let missing: Vec<String> =
        runs.iter().filter(unmade).map(|key| format!("`{}`", command_of(key))).collect();
    if missing.is_empty() {
        return Vec::new();
    }
    let text = format!(
        "Of the {} that `whipple vv {} --level full` makes {} no record here, and whatever needs {} is \
         missing above:",
        counted(runs.len(), ["run", "runs"]),
        case.id(),
        counted(missing.len(), ["has", "have"]),
        either(missing.len(), ["it", "them"])
    );
    vec![Block::Callout { kind: Status::Warn, text }, Block::List(missing)]
}

/// A run that failed, in words.
fn failure(record: &RunRecord) -> Option<String> {
    let Outcome::Failed { message, .. } = &record.outcome else {
        return None;
    };
    let (scheme, n) = (record.key.scheme.label(), record.key.n);
    let variant = match record.key.variant.as_str() {
        "" => String::new(),
        other => format!(", {other}"),
    };
    Some(escaped(&format!("{scheme}{variant}, n = {n}: {message}")))
}

/// Every run and its norms.
fn norms_table(case: &dyn Case, runs: &[&RunRecord]) -> Table {
    let mut columns =
        vec![Column::text("scheme"), Column::text("variant"), Column::number("n", "")];
    columns.extend(case.tabulated().iter().map(|(_, title)| Column::number(*title, "")));
    let mut runs = runs.to_vec();
    runs.sort_by_key(|r| (r.key.variant.clone(), r.key.scheme, r.key.n));
    let rows = runs.into_iter().map(|r| {
        let mut row = vec![
            r.key.scheme.label().into(),
            r.key.variant.clone().into(),
            Cell { text: recorded(&r.key.n.to_string(), &r.key), ..Cell::count(r.key.n as u64) },
        ];
        let failed = matches!(r.outcome, Outcome::Failed { .. });
        for (k, (name, _)) in case.tabulated().iter().enumerate() {
            row.push(match (r.norms.get(*name), &r.outcome) {
                (Some(&value), _) if !value.is_nan() => case.decimals(name).map_or_else(
                    || Cell::number(value, 4),
                    |decimals| Cell::fixed(value, decimals),
                ),
                (None, Outcome::Failed { kind, .. }) if k == 0 => format!("failed: {kind}").into(),
                _ if failed => "".into(),
                _ => "–".into(),
            });
        }
        row
    });
    let error = |(name, _): &(&str, &str)| case.errors().contains(name);
    let what = if case.tabulated().iter().all(error) { "Errors" } else { "Results" };
    Table {
        id: format!("{}-norms", case.id()),
        caption: format!("{what}: {}. Each n leads to the record of its run.", case.title()),
        columns,
        rows: rows.collect(),
    }
}

/// Completed runs by scheme and variant, the coarsest first.
fn groups<'a>(runs: &[&'a RunRecord]) -> Vec<(Scheme, &'a str, Vec<&'a RunRecord>)> {
    let mut groups: Vec<(Scheme, &str, Vec<&RunRecord>)> = Vec::new();
    for run in runs.iter().copied().filter(|r| r.outcome == Outcome::Completed) {
        let key = (run.key.scheme, run.key.variant.as_str());
        match groups.iter_mut().find(|(s, v, _)| (*s, *v) == key) {
            Some((_, _, members)) => members.push(run),
            None => groups.push((key.0, key.1, vec![run])),
        }
    }
    for (_, _, members) in &mut groups {
        members.sort_by_key(|r| r.key.n);
    }
    groups
}

/// A quantity at all sizes of a group.
fn levels(members: &[&RunRecord], name: &str) -> Vec<Level> {
    let level =
        |r: &&RunRecord| Some(Level { spacing: 1.0 / r.key.n as f64, value: *r.norms.get(name)? });
    members.iter().filter_map(level).collect()
}

/// Solution verification: order, limit and band of quantities that need no exact solution.
fn grid_table(case: &dyn Case, runs: &[&RunRecord]) -> Option<Table> {
    let mut rows = Vec::new();
    for (scheme, variant, members) in groups(runs) {
        for (name, title) in case.quantities() {
            let levels = levels(&members, name);
            if levels.len() < 3 {
                continue;
            }
            let Ok(study) = convergence::grid_study(&levels[levels.len() - 3..], 1.0) else {
                continue;
            };
            let number =
                |x: Option<f64>, digits| x.map_or_else(|| "–".into(), |x| Cell::number(x, digits));
            let behaviour = format!("{:?}", study.behaviour).to_lowercase();
            // What does not converge has no limit to go to.
            let limit = match (study.behaviour, &study.quoted) {
                (Behaviour::Monotone, Some(quoted)) => Cell::number(quoted.extrapolated, 6),
                _ => format!("– ({behaviour})").into(),
            };
            let mut row: Vec<Cell> = vec![scheme.label().into(), variant.into(), (*title).into()];
            row.extend(study.levels.iter().map(|l| Cell::number(l.value, 6)));
            row.push(number(study.observed_order, 3));
            row.push(limit);
            row.push(Cell::number(study.band(), 2));
            row.push(behaviour.into());
            row.push(if study.is_asymptotic() { "yes" } else { "no" }.into());
            rows.push(row);
        }
    }
    let columns = vec![
        Column::text("scheme"),
        Column::text("variant"),
        Column::text("quantity"),
        Column::number("finest", ""),
        Column::number("middle", ""),
        Column::number("coarsest", ""),
        Column::number("observed order", ""),
        Column::number("extrapolated", ""),
        Column::number("band ±", ""),
        Column::text("behaviour"),
        Column::text("asymptotic"),
    ];
    (!rows.is_empty()).then(|| Table {
        id: format!("{}-grid", case.id()),
        caption: format!(
            "Solution verification: {}. The three finest sizes; Richardson extrapolation and grid \
             convergence index with formal order 1. Values that do not converge monotonically have no limit; oscillating ones quote their \
             range.",
            case.title()
        ),
        columns,
        rows,
    })
}

/// Errors below this are round-off, which has no order.
const ROUND_OFF: f64 = 1e-10;

/// Orders of every error above round-off, for schemes that have three sizes or more.
fn orders_table(case: &dyn Case, runs: &[&RunRecord]) -> Option<Table> {
    let mut rows = Vec::new();
    for (scheme, variant, members) in groups(runs) {
        for (name, title) in
            case.tabulated().iter().filter(|(name, _)| case.errors().contains(name))
        {
            let levels = levels(&members, name);
            if levels.iter().all(|level| level.value.abs() < ROUND_OFF) {
                continue;
            }
            let Some(fit) = order(&members, name) else {
                continue;
            };
            let pairwise = convergence::pairwise_orders(&levels).unwrap_or_default();
            let pairwise: Vec<String> = pairwise.into_iter().map(|p| sig(p, 3)).collect();
            let (low, high) = fit.interval;
            rows.push(vec![
                scheme.label().into(),
                variant.into(),
                (*title).into(),
                pairwise.join(", ").into(),
                match Cell::number(fit.order, 4) {
                    order if fit.is_order() => order,
                    none => Cell { text: "no order".into(), ..none },
                },
                Cell::number(fit.standard_error, 2),
                format!("{} to {}", sig(low, 3), sig(high, 3)).into(),
            ]);
        }
    }
    let columns = vec![
        Column::text("scheme"),
        Column::text("variant"),
        Column::text("norm"),
        Column::number("between sizes", ""),
        Column::number("fitted", ""),
        Column::number("standard error", ""),
        Column::number("95 %", ""),
    ];
    (!rows.is_empty()).then(|| Table {
        id: format!("{}-orders", case.id()),
        caption: format!("Observed orders of convergence: {}.", case.title()),
        columns,
        rows,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::blank;

    /// What is said of a case where so many of its runs have no record.
    fn said(unmade: usize) -> Option<String> {
        let case = crate::cases::find("heat-chain").expect("the case");
        let mut records = Records::default();
        for key in case.runs(Extent::Full).into_iter().skip(unmade) {
            records.insert(blank(key, 1, String::new()));
        }
        missing(case, &records).into_iter().find_map(|block| match block {
            Block::Callout { text, .. } => Some(text),
            _ => None,
        })
    }

    /// The limit and the behaviour in the row of the hole, of holes at the three sizes of `rcc-plate`.
    fn limit(holes: [f64; 3]) -> [String; 2] {
        let case = crate::cases::find("rcc-plate").expect("the case");
        let runs: Vec<RunRecord> = [4, 6, 8]
            .into_iter()
            .zip(holes)
            .map(|(n, hole)| {
                let scheme = Scheme::preset(whipple_solver::method::Preset::Default);
                let mut record = blank(RunKey::new("rcc-plate", scheme, n), 1, String::new());
                record.norms.insert("hole_diameter_cm".into(), hole);
                record
            })
            .collect();
        let table = grid_table(case, &runs.iter().collect::<Vec<_>>()).expect("a table");
        [7, 9].map(|column| table.rows[0][column].text.clone())
    }

    #[test]
    fn what_does_not_converge_has_no_limit() {
        assert_eq!(limit([2.0, 2.2, 2.3]), ["2.60000", "monotone"]);
        assert_eq!(limit([2.0, 2.2, 2.5]), ["– (diverging)", "diverging"]);
        assert_eq!(limit([2.0, 2.2, 2.1]), ["– (oscillatory)", "oscillatory"]);
    }

    #[test]
    fn missing_runs_are_counted() {
        assert_eq!(said(0), None);
        let [one, two] = [1, 2].map(|unmade| said(unmade).expect("a remark"));
        assert!(
            one.ends_with(" makes 1 has no record here, and whatever needs it is missing above:")
        );
        assert!(
            two.ends_with(
                " makes 2 have no record here, and whatever needs them is missing above:"
            )
        );
    }
}
