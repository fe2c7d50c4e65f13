//! `whipple vv hard --sensitivity`: how far the numbers of impacts move with choices that no experiment decides.

use super::folder::refuse_no_report;
use super::hard::GROUP;
use super::reports::draw_anew;
use super::{Failure, VvArgs, print, say};
use crate::files::ensure_writable_dir;
use crate::hard::folder;
use crate::hard::sensitivity::{Row, STUDIES, SensitivityRecord, Study};
use crate::lock::FolderLock;

/// Runs all studies, writes their records, and draws the report anew.
pub(super) fn sensitivity(args: &VvArgs) -> Result<u8, Failure> {
    let chosen: Vec<Study> = match &args.cases[..] {
        [group] if group == GROUP => STUDIES.to_vec(),
        [group, names @ ..] if group == GROUP => {
            names.iter().map(|name| find(name)).collect::<Result<_, _>>()?
        }
        _ => {
            let message = "--sensitivity goes with the group `hard`: whipple vv hard --sensitivity";
            return Err(Failure::usage(message));
        }
    };
    refuse_no_report(&args.out, &[])?;
    let _lock = FolderLock::take(&args.out)?;
    let records = SensitivityRecord::folder(&folder(&args.out));
    ensure_writable_dir(&records)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|e| Failure::usage(format!("cannot start a thread: {e}")))?;
    let mut text = String::new();
    for study in chosen {
        let record = pool.install(|| study.run(|row| say(&line(&study, row))))?;
        record.write(&records)?;
        text += &told(&study, &record);
    }
    let page = draw_anew(&args.out)?;
    print(&format!("{text}report: {}\n", page.display()))?;
    Ok(0)
}

fn find(name: &str) -> Result<Study, Failure> {
    STUDIES.into_iter().find(|study| study.case == name).ok_or_else(|| {
        let known = STUDIES.map(|study| study.case).join(", ");
        Failure::usage(format!("no study of `{name}`; there are {known}"))
    })
}

/// A row as it is made.
fn line(study: &Study, row: &Row) -> String {
    let values: Vec<String> = study
        .headlines
        .iter()
        .zip(&row.values)
        .map(|(headline, value)| match value {
            Some(value) => format!("{} {value:.4} {}", headline.title, headline.unit),
            None => format!("{} none", headline.title),
        })
        .collect();
    let what = format!("{} {}", row.kind, row.change);
    format!("{:<16} {:<44} {}", study.case, what.trim(), values.join(", "))
}

/// The spread of every number by kind of change, in per cent.
fn told(study: &Study, record: &SensitivityRecord) -> String {
    let mut text = String::new();
    for (k, headline) in study.headlines.iter().enumerate() {
        let kinds = record.kinds().into_iter().map(Some).chain([None]);
        let spreads: Vec<String> = kinds
            .filter_map(|kind| {
                let [low, high] = record.spread(kind, k)?;
                let kind = kind.unwrap_or("all");
                Some(format!("{kind} {:+.2} to {:+.2} %", 100.0 * low, 100.0 * high))
            })
            .collect();
        text += &format!("{}, {}: {}\n", study.case, headline.title, spreads.join("; "));
    }
    text
}
