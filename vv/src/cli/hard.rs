//! `whipple vv hard`: the cases that try to break the solver.

use super::folder::refuse_no_report;
use super::reports::draw_anew;
use super::{CLAIM_FAILED, Failure, VvArgs, print, say};
use crate::cases::Level;
use crate::files::ensure_writable_dir;
use crate::hard::{ALL, Extent, HardCase, HardRecord, HardRecords, SCHEMES, folder, holds, stated};
use crate::lock::FolderLock;
use crate::suggest::did_you_mean;
use crate::words::counted;

/// The name of the group, which no case has.
pub(super) const GROUP: &str = "hard";

/// Runs hard cases, all where none is named after the group, and draws the report anew.
pub(super) fn hard(args: &VvArgs) -> Result<u8, Failure> {
    let cases = chosen(&args.cases)?;
    let records = folder(&args.out);
    if HardRecords::read(&records)?.iter().next().is_none() {
        refuse_no_report(&args.out, &[])?;
    }
    let _lock = FolderLock::take(&args.out)?;
    ensure_writable_dir(&records)?;
    let extent = if args.level == Level::Quick { Extent::Quick } else { Extent::Stated };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|e| Failure::usage(format!("cannot start a thread: {e}")))?;
    for case in cases {
        for scheme in SCHEMES.into_iter().take(if args.default_only { 1 } else { SCHEMES.len() }) {
            let start = cpu_time::ProcessTime::now();
            let Some(record) = pool.install(|| case.measure(scheme, extent)) else { continue };
            record.write(&records)?;
            say(&format!("{}, {:.2} s", line(&record), start.elapsed().as_secs_f64()));
        }
    }
    let all = HardRecords::read(&records)?;
    let page = draw_anew(&args.out)?;
    let held = holds(&all, &stated());
    print(&format!("{}{}report: {}\n", told(&all), counted_for(held), page.display()))?;
    Ok(if held { 0 } else { CLAIM_FAILED })
}

/// What to name after `vv` for a name that is that of the group or of one of its cases.
pub(super) fn named(name: &str) -> Option<String> {
    if name.eq_ignore_ascii_case(GROUP) {
        return Some(GROUP.to_owned());
    }
    let case = ALL.iter().find(|case| case.id.eq_ignore_ascii_case(name))?;
    Some(format!("{GROUP} {}", case.id))
}

/// The cases that are named after the group.
fn chosen(names: &[String]) -> Result<Vec<HardCase>, Failure> {
    let Some((GROUP, ids)) = names.split_first().map(|(first, ids)| (first.as_str(), ids)) else {
        let message =
            "`hard` is a group of its own: name it first, with hard cases after it or none";
        return Err(Failure::usage(message));
    };
    if ids.is_empty() {
        return Ok(ALL.to_vec());
    }
    let find = |id: &String| {
        let same = |case: &&HardCase| case.id.eq_ignore_ascii_case(id);
        ALL.iter().find(same).copied().ok_or_else(|| {
            let hint = did_you_mean(id, ALL.iter().map(|case| case.id));
            Failure::usage(format!(
                "no hard case `{id}`{hint} (they are H01 to H30 and W01 to W10)"
            ))
        })
    };
    ids.iter().map(find).collect()
}

/// A record in a line.
fn line(record: &HardRecord) -> String {
    let failed = record.readings.iter().filter(|reading| !reading.pass).count();
    let how = match failed {
        0 => "holds".to_owned(),
        failed => format!(
            "{} of {}",
            counted(failed, ["number fails", "numbers fail"]),
            record.readings.len()
        ),
    };
    format!("{} {:<22} {how}", record.id, record.scheme.label())
}

/// What fails with `default`, and the counts of each scheme.
fn told(records: &HardRecords) -> String {
    let mut text = String::new();
    for record in records.iter().filter(|record| record.scheme == SCHEMES[0]) {
        for reading in record.readings.iter().filter(|reading| !reading.pass) {
            let value = match (&reading.said, reading.value) {
                (Some(said), _) => said.clone(),
                (None, Some(value)) => format!("{value:.3e}"),
                (None, None) => "no number".into(),
            };
            let (part, what) = (&reading.part, &reading.what);
            text += &format!("FAILED  {}: {part}: {what}: {value}\n", record.id);
        }
    }
    for scheme in SCHEMES {
        let own: Vec<&HardRecord> = records.iter().filter(|r| r.scheme == scheme).collect();
        let held = own.iter().filter(|record| record.passes()).count();
        text += &format!(
            "{:<22} {held} of {} hold\n",
            scheme.label(),
            counted(own.len(), ["case", "cases"])
        );
    }
    text
}

/// What the exit code is about.
fn counted_for(held: bool) -> String {
    let how = if held { "all hold (0)" } else { "not all hold (1)" };
    format!(
        "exit code: the required cases with {}: {how}; other schemes do not count\n",
        SCHEMES[0].label()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_group_is_no_case_and_its_cases_are_named_after_it() {
        assert!(crate::cases::find(GROUP).is_none());
        let chosen = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(ToString::to_string).collect();
            chosen(&names).map(|cases| cases.iter().map(|case| case.id).collect::<Vec<&str>>())
        };
        assert_eq!(chosen(&["hard", "h03", "H01"]).expect("both are there"), ["H03", "H01"]);
        assert_eq!(chosen(&["hard"]).expect("all").len(), ALL.len());
        assert!(chosen(&["noh", "hard"]).is_err() && chosen(&["hard", "H31"]).is_err());
        assert_eq!(named("h03").as_deref(), Some("hard H03"));
        assert!(named("noh").is_none() && named("hard").is_some());
        assert!(counted_for(true).contains("with default: all hold (0)"));
    }
}
