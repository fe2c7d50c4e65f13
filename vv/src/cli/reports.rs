//! `whipple vv`, `whipple report` and `whipple reference`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use whipple_solver::units::Dimension;

use super::folder::refuse_no_report;
use super::progress::{Outlook, Progress};
use super::run::find_all;
use super::sizes::expect;
use super::{CLAIM_FAILED, Failure, ReferenceArgs, ReportArgs, VvArgs, print, say};
use crate::cases::{ALL, Case, Level, woodward_colella};
use crate::claims::{Status, Verdict, Weight};
use crate::document;
use crate::files::{ensure_writable_dir, write_atomic};
use crate::hard::sensitivity::SensitivityRecord;
use crate::hard::{self, HardRecords};
use crate::lock::FolderLock;
use crate::memory::Keeps;
use crate::pictures::read_pictures;
use crate::plots;
use crate::record::{Outcome, Records, RunKey};
use crate::report::{self, Drawing, Pictures, Report};
use crate::suite::{Forecast, covers, forecast, records_folder, run_suite, scene_of, verdicts};
use crate::words::counted;

/// The page that needs nothing beside it, which is no part of the report's folder.
const SINGLE_FILE: &str = "single-file.html";

/// Files that are named of those that differ.
const NAMED: usize = 5;

pub(super) const VV_EXAMPLES: &str = "\
Examples:
  whipple vv                                       every case; the report in reports/
  whipple vv noh sod --level quick --out out/vv    two cases, few sizes, elsewhere
  whipple vv hard H03 --out out/hard               a case that tries to break the solver
  whipple vv hard --random 100 --out out/hard      small random impacts";

pub(super) const REPORT_EXAMPLES: &str = "\
Examples:
  whipple report                    draw reports/ anew from its records
  whipple report --check            say whether it is what its records give
  whipple report --single-file      one page with its pictures within, to send around";

pub(super) const REFERENCE_EXAMPLE: &str =
    "Example:\n  whipple reference --out out/woodward_colella.csv";

/// Runs, judges, reports.
pub(super) fn vv(args: &VvArgs) -> Result<u8, Failure> {
    let cases = find_all(&args.cases)?;
    refuse_no_report(&args.out, if args.single_file { &[SINGLE_FILE] } else { &[] })?;
    let _lock = FolderLock::take(&args.out)?;
    // Records that cannot be read tell nothing, and may be replaced by this very run.
    let records = Records::read(&records_folder(&args.out)).unwrap_or_default();
    for case in &cases {
        for key in case.runs(args.level) {
            let Some(scene) = scene_of(*case, &key) else { continue };
            expect(*case, ("--n", key.n), &scene, Keeps::default())?;
        }
    }
    say(&expected(&cases, args.level, &forecast(&cases, args.level, &records)));
    let progress = Progress::new(Outlook::default());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|e| Failure::usage(format!("cannot start a thread: {e}")))?;
    let ended = pool.install(|| {
        run_suite(&cases, args.level, &args.out, &progress, |key, record| match record {
            None => progress.start(&key.file_name(), unit_of_time(&cases, key)),
            Some(record) => {
                let how = match &record.outcome {
                    Outcome::Completed => format!("{:.2} s", record.cpu_seconds),
                    Outcome::Failed { message, .. } => format!("failed: {message}"),
                };
                say(&format!("{:<52} {how}", key.file_name()));
            }
        })
    });
    progress.done();
    ended?;
    let made = made(&args.out)?;
    let mut pages = vec![draw(&made, &args.out, false)?];
    if args.single_file {
        pages.push(draw(&made, &args.out, true)?);
    }
    let ran = |v: &&Verdict| cases.iter().any(|c| c.id() == v.claim.case);
    conclude(made.verdicts.iter().filter(ran), &pages)
}

/// Label of the unit of time in the scene of a run.
fn unit_of_time(cases: &[&'static dyn Case], key: &RunKey) -> &'static str {
    let case = cases.iter().find(|case| case.id() == key.case);
    let scene = case.and_then(|case| scene_of(*case, key));
    scene.map_or("", |scene| scene.units().label(Dimension::Time))
}

/// What is about to run, how long it takes, and what is left to other levels.
fn expected(cases: &[&'static dyn Case], level: Level, forecast: &Forecast) -> String {
    let Forecast { runs, measured, scaled, unknown } = *forecast;
    let time =
        |seconds: f64| humantime::format_duration(Duration::from_secs(seconds.ceil() as u64));
    let all = cases.len() == ALL.len();
    let what = match cases {
        _ if all => format!("all {} cases", ALL.len()),
        cases => cases.iter().map(|case| case.id()).collect::<Vec<&str>>().join(", "),
    };
    let runs_of = counted(runs, ["run of", "runs of"]);
    let mut text = format!("level {}: {runs_of} {what}", level.name());
    if unknown < runs {
        text += &format!(
            ", about {} of CPU time by the records of the folder",
            time(measured + scaled)
        );
    }
    if scaled > 0.0 {
        text += &format!(" ({} of it scaled from other sizes or schemes)", time(scaled));
    }
    if unknown > 0 {
        text += &match usual(level) {
            time if all && unknown == runs => format!(", {time} where it was measured"),
            _ => format!("; no record tells the time of {unknown}"),
        };
    }
    let left = |case: &&'static dyn Case| {
        case.claims().iter().filter(|claim| !covers(*case, level, claim)).count()
    };
    match cases.iter().map(left).sum::<usize>() {
        0 => text,
        left => {
            text + &format!(
                "\n{} on records of the folder, if it has them; `--level full` runs all",
                counted(
                    left,
                    [
                        "claim needs runs of another level, and rests",
                        "claims need runs of another level, and rest"
                    ]
                )
            )
        }
    }
}

/// What a level took with all cases on two cores.
fn usual(level: Level) -> &'static str {
    match level {
        Level::Quick => "about 1 minute",
        Level::Standard => "about 5 minutes",
        Level::Full => "about 35 minutes",
    }
}

/// The levels on the command line, each with what it runs and how long that takes.
pub(super) fn levels() -> impl TypedValueParser<Value = Level> {
    let values = Level::ALL.map(|level| {
        let what = match level {
            Level::Quick => "Few sizes of every case, not always its smallest",
            Level::Standard => "Most sizes that claims need",
            Level::Full => {
                "Every size that a claim needs, the long rod at 9 cells, it and the plate in their variants"
            }
        };
        PossibleValue::new(level.name()).help(format!("{what}: {}", usual(level)))
    });
    PossibleValuesParser::new(values).try_map(|name| Level::from_str(&name, false))
}

/// Redraws the report, or compares it with what a redraw would give.
pub(super) fn report(args: &ReportArgs) -> Result<u8, Failure> {
    let made = made(&args.out)?;
    if args.check {
        return check(&made, &args.out, args.single_file);
    }
    let _lock = FolderLock::take(&args.out)?;
    let page = draw(&made, &args.out, args.single_file)?;
    conclude(made.verdicts.iter(), &[page])
}

/// Compares the report of a folder with a fresh one.
fn check(made: &Made, folder: &Path, single_file: bool) -> Result<u8, Failure> {
    let fresh =
        tempfile::tempdir().map_err(|e| Failure::usage(format!("no temporary folder: {e}")))?;
    draw(made, fresh.path(), single_file)?;
    let mut differing = Vec::new();
    compare(fresh.path(), folder, Path::new(""), &mut differing)?;
    if differing.is_empty() {
        print("the report is what its records give\n")?;
        return Ok(0);
    }
    let stale = made.verdicts.iter().filter(|verdict| verdict.stale).count();
    Err(Failure { code: CLAIM_FAILED, message: difference(stale, differing) })
}

/// What differs from a fresh report, and why it may, where so many claims are of older records.
fn difference(stale: usize, mut differing: Vec<String>) -> String {
    differing.sort_unstable();
    let why = match stale {
        0 => String::new(),
        _ => {
            let claims = counted(stale, ["claim is", "claims are"]);
            format!("{claims} of records older than the solver; ")
        }
    };
    let named = differing.len().min(NAMED);
    let more = match differing.len() - named {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{why}not what the records give: {}{more}", differing[..named].join(", "))
}

fn compare(
    fresh: &Path,
    there: &Path,
    below: &Path,
    differing: &mut Vec<String>,
) -> Result<(), Failure> {
    let unreadable = |e: std::io::Error| Failure::usage(format!("cannot read a report: {e}"));
    for entry in std::fs::read_dir(fresh.join(below)).map_err(unreadable)? {
        let name = below.join(entry.map_err(unreadable)?.file_name());
        if fresh.join(&name).is_dir() {
            compare(fresh, there, &name, differing)?;
        } else if std::fs::read(fresh.join(&name)).map_err(unreadable)?
            != std::fs::read(there.join(&name)).unwrap_or_default()
        {
            differing.push(name.display().to_string());
        }
    }
    Ok(())
}

/// A report before it is written.
struct Made {
    report: Report,
    drawings: BTreeMap<String, Drawing>,
    verdicts: Vec<Verdict>,
}

/// The report of a folder of records, in memory.
fn made(folder: &Path) -> Result<Made, Failure> {
    let there = records_folder(folder);
    let hard = HardRecords::read(&hard::folder(folder))?;
    let studies = SensitivityRecord::read_all(&SensitivityRecord::folder(&hard::folder(folder)))?;
    let without_hard = hard.iter().next().is_none() && studies.is_empty();
    let nothing = |what: &str| {
        Failure::usage(format!(
            "no report in {}: {what}; `whipple vv --out {0}` makes one, --out names another",
            folder.display()
        ))
    };
    if !there.is_dir() && without_hard {
        return Err(nothing("it has no folder `records`"));
    }
    let records = if there.is_dir() { Records::read(&there)? } else { Records::default() };
    if records.iter().next().is_none() && without_hard {
        return Err(nothing("its folder `records` holds no record"));
    }
    // Pictures are not drawn again: they must be those of the records.
    let mut drawings = read_pictures(&there, &records).map_err(Failure::usage)?;
    let verdicts = verdicts(&records);
    let (mut report, figures) = document::compose(&records, &verdicts);
    report.sections.extend(document::hard::section(&hard, &hard::stated()));
    report.sections.extend(document::sensitivity::section(&studies));
    for figure in &figures {
        let svg = plots::render_svg(figure).map_err(Failure::usage)?;
        drawings.insert(figure.id.clone(), Drawing::Chart(svg));
    }
    Ok(Made { report, drawings, verdicts })
}

/// Draws the report of a folder from its records; returns the page.
pub(super) fn draw_anew(folder: &Path) -> Result<PathBuf, Failure> {
    draw(&made(folder)?, folder, false)
}

/// Writes a report to a folder, or only its page with the pictures within; returns the page.
fn draw(made: &Made, folder: &Path, single_file: bool) -> Result<PathBuf, Failure> {
    let Made { report, drawings, .. } = made;
    if single_file {
        let path = folder.join(SINGLE_FILE);
        let page = report::html(report, drawings, Pictures::Within).map_err(Failure::usage)?;
        write_atomic(&path, page.as_bytes())?;
        return Ok(path);
    }
    report::write(report, drawings, folder).map_err(Failure::usage)?;
    Ok(folder.join(report::INDEX))
}

/// Prints the failed claims and the counts; fails if a required claim did.
fn conclude<'a>(
    verdicts: impl Iterator<Item = &'a Verdict>,
    pages: &[PathBuf],
) -> Result<u8, Failure> {
    let (mut passed, mut failed, mut missing) = (0, 0, 0);
    let mut text = String::new();
    for verdict in verdicts.filter(|v| v.claim.weight == Weight::Must) {
        match verdict.status {
            Status::Pass => passed += 1,
            Status::Missing => missing += 1,
            Status::Fail => {
                failed += 1;
                let (case, what) = (verdict.claim.case, &verdict.claim.what);
                let (value, wanted) = (verdict.found(4), verdict.wanted());
                text += &format!("FAILED  {case}: {what}: {value}, wanted {wanted}\n");
            }
        }
    }
    text +=
        &format!("required claims: {passed} passed, {failed} failed, {missing} without a record\n");
    for page in pages {
        text += &format!("report: {}\n", page.display());
    }
    print(&text)?;
    Ok(if failed > 0 { CLAIM_FAILED } else { 0 })
}

/// Makes the Woodward-Colella reference.
pub(super) fn reference(args: &ReferenceArgs) -> Result<u8, Failure> {
    let out = args.out.display();
    if args.out.exists() && !args.force {
        return Err(Failure::usage(format!(
            "{out} is there already: --force writes over it, --out names another file"
        )));
    }
    // Before it is computed, which takes minutes.
    if let Some(folder) = args.out.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        ensure_writable_dir(folder)?;
    }
    say(&format!(
        "computing the reference of woodward-colella, which takes some minutes; it goes to {out}"
    ));
    let text = woodward_colella::make_reference()?;
    write_atomic(&args.out, text.as_bytes())?;
    print(&format!("wrote {}\n", args.out.display()))?;
    Ok(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said before a run: how much, how long, and what another level has.
    #[test]
    fn runs_are_announced() {
        let (unknown, rod) = (Forecast { runs: 7, unknown: 7, ..Forecast::default() }, "long-rod");
        let said = expected(&ALL, Level::Full, &unknown);
        assert_eq!(
            said,
            "level full: 7 runs of all 26 cases, about 35 minutes where it was measured"
                .replace("26", &ALL.len().to_string())
        );
        let rod = [crate::cases::find(rod).expect("the case")];
        let one = Forecast { runs: 1, unknown: 1, ..Forecast::default() };
        let said = expected(&rod, Level::Full, &one);
        assert_eq!(said, "level full: 1 run of long-rod; no record tells the time of 1");
        let said = expected(&rod, Level::Quick, &unknown);
        let (first, second) = said.split_once('\n').expect("two lines");
        assert_eq!(first, "level quick: 7 runs of long-rod; no record tells the time of 7");
        assert!(second.contains(" claims need runs of another level"), "{second}");
        let known = Forecast { runs: 7, measured: 50.0, scaled: 70.0, unknown: 1 };
        let said = expected(&rod, Level::Full, &known);
        assert_eq!(
            said,
            "level full: 7 runs of long-rod, about 2m of CPU time by the records of the folder (1m 10s of it \
             scaled from other sizes or schemes); no record tells the time of 1"
        );
    }

    /// Times of a suite are in the units of each of its runs.
    #[test]
    fn times_of_a_suite_have_units() {
        for (id, unit) in [("long-rod", "µs"), ("noh", "")] {
            let case = crate::cases::find(id).expect("the case");
            let key = case.runs(Level::Quick).remove(0);
            assert_eq!(unit_of_time(&ALL, &key), unit, "{id}");
        }
    }

    #[test]
    fn differences_are_named_in_order_and_counted() {
        let files = |all: &[&str]| all.iter().map(ToString::to_string).collect::<Vec<String>>();
        assert_eq!(difference(0, files(&["b", "a"])), "not what the records give: a, b");
        assert_eq!(
            difference(1, files(&["a"])),
            "1 claim is of records older than the solver; not what the records give: a"
        );
        assert_eq!(
            difference(517, files(&["g", "f", "e", "d", "c", "b", "a"])),
            "517 claims are of records older than the solver; not what the records give: a, b, c, d, e and 2 \
             more"
        );
    }

    /// Help and README say the same times, of every level.
    #[test]
    fn levels_have_one_time() {
        let readme = concat!(env!("CARGO_MANIFEST_DIR"), "/../README.md");
        let readme = std::fs::read_to_string(readme).expect("README.md");
        let parser = levels();
        let values: Vec<PossibleValue> = parser.possible_values().expect("levels").collect();
        assert_eq!(values.len(), Level::ALL.len());
        for (level, value) in Level::ALL.into_iter().zip(values) {
            assert_eq!(value.get_name(), level.name());
            let help = value.get_help().map(ToString::to_string).unwrap_or_default();
            assert!(help.ends_with(&format!(": {}", usual(level))), "{help}");
            let row = format!("| `{}`", level.name());
            let row = readme.lines().find(|line| line.starts_with(&row)).expect("its row");
            assert!(row.ends_with(&format!("| {} |", usual(level))), "{row}");
        }
    }
}
