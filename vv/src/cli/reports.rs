//! `whipple vv`, `whipple report` and `whipple reference`.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use super::progress::{Outlook, Progress};
use super::run::find_all;
use super::{CLAIM_FAILED, Failure, ReferenceArgs, ReportArgs, VvArgs, print, say};
use crate::cases::woodward_colella;
use crate::claims::{Status, Verdict, Weight};
use crate::document;
use crate::files::{ensure_writable_dir, write_atomic};
use crate::pictures::read_pictures;
use crate::plots;
use crate::record::{Outcome, Records};
use crate::report::{self, Drawing};
use crate::suite::{Forecast, forecast, records_folder, run_suite, verdicts};

/// Runs, judges, reports.
pub(super) fn vv(args: &VvArgs) -> Result<u8, Failure> {
    let cases = find_all(&args.cases)?;
    ensure_writable_dir(&args.out)?;
    // Records that cannot be read tell nothing, and may be replaced by this very run.
    let records = Records::read(&records_folder(&args.out)).unwrap_or_default();
    say(&expected(&forecast(&cases, args.level, &records)));
    let progress = Progress::new(Outlook::default());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|e| Failure::usage(format!("cannot start a thread: {e}")))?;
    let ended = pool.install(|| {
        run_suite(&cases, args.level, &args.out, &progress, |key, record| match record {
            None => progress.start(&key.file_name()),
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
    let verdicts = draw(&args.out)?;
    let ran = |v: &&Verdict| cases.iter().any(|c| c.id() == v.claim.case);
    conclude(verdicts.iter().filter(ran), &args.out)
}

/// What to expect, in words.
fn expected(forecast: &Forecast) -> String {
    let Forecast { runs, measured, scaled, unknown } = *forecast;
    let time =
        |seconds: f64| humantime::format_duration(Duration::from_secs(seconds.ceil() as u64));
    let mut text = format!("{runs} runs");
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
        text += &format!("; no record tells the time of {unknown}");
    }
    text
}

/// Redraws the report, or compares it with what a redraw would give.
pub(super) fn report(args: &ReportArgs) -> Result<u8, Failure> {
    if args.check {
        return check(&args.out);
    }
    let verdicts = draw(&args.out)?;
    conclude(verdicts.iter(), &args.out)
}

/// Compares the report with a fresh one.
fn check(folder: &Path) -> Result<u8, Failure> {
    let fresh =
        tempfile::tempdir().map_err(|e| Failure::usage(format!("no temporary folder: {e}")))?;
    let (page, figures, _) = made(folder)?;
    report::write(&page, &figures, fresh.path()).map_err(Failure::usage)?;
    let mut differing = Vec::new();
    compare(fresh.path(), folder, Path::new(""), &mut differing)?;
    if differing.is_empty() {
        print("the report is what its records give\n")?;
        return Ok(0);
    }
    let list = differing.join(", ");
    Err(Failure { code: CLAIM_FAILED, message: format!("not what the records give: {list}") })
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

type Made = (report::Report, BTreeMap<String, Drawing>, Vec<Verdict>);

/// The report of a folder of records, in memory.
fn made(folder: &Path) -> Result<Made, Failure> {
    let there = records_folder(folder);
    let records = Records::read(&there)?;
    // Pictures are not drawn again: they must be those of the records.
    let mut drawings = read_pictures(&there, &records).map_err(Failure::usage)?;
    let verdicts = verdicts(&records);
    let (page, figures) = document::compose(&records, &verdicts);
    for figure in &figures {
        let svg = plots::render_svg(figure).map_err(Failure::usage)?;
        drawings.insert(figure.id.clone(), Drawing::Chart(svg));
    }
    Ok((page, drawings, verdicts))
}

fn draw(folder: &Path) -> Result<Vec<Verdict>, Failure> {
    let (page, figures, verdicts) = made(folder)?;
    report::write(&page, &figures, folder).map_err(Failure::usage)?;
    Ok(verdicts)
}

/// Prints the failed claims and the counts; fails if a must claim did.
fn conclude<'a>(verdicts: impl Iterator<Item = &'a Verdict>, out: &Path) -> Result<u8, Failure> {
    let (mut passed, mut failed, mut missing) = (0, 0, 0);
    let mut text = String::new();
    for verdict in verdicts.filter(|v| v.claim.weight == Weight::Must) {
        match verdict.status {
            Status::Pass => passed += 1,
            Status::Missing => missing += 1,
            Status::Fail => {
                failed += 1;
                let value = verdict.value.map_or(verdict.note.clone(), |v| report::sig(v, 4));
                let (case, what) = (verdict.claim.case, &verdict.claim.what);
                let wanted = verdict.claim.wanted.text();
                text += &format!("FAILED  {case}: {what}: {value}, wanted {wanted}\n");
            }
        }
    }
    text += &format!("must claims: {passed} passed, {failed} failed, {missing} without a record\n");
    text += &format!("report: {}\n", out.join("index.html").display());
    print(&text)?;
    Ok(if failed > 0 { CLAIM_FAILED } else { 0 })
}

/// Makes the Woodward-Colella reference.
pub(super) fn reference(args: &ReferenceArgs) -> Result<u8, Failure> {
    let text = woodward_colella::make_reference()?;
    write_atomic(&args.out, text.as_bytes())?;
    print(&format!("wrote {}\n", args.out.display()))?;
    Ok(0)
}
