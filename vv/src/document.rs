//! The report: what the records and verdicts say, in the order in which a reader asks.
//!
//! A pure function of the records: nothing is run here, and no clock is read.

mod case;
mod deviations;
mod front;

use crate::cases::{self, Case};
use crate::claims::Verdict;
use crate::plots::Figure;
use crate::record::Records;
use crate::report::{Report, Section};
use crate::suite::has_run;

/// Composes the report and its figures.
#[must_use]
pub fn compose(records: &Records, verdicts: &[Verdict]) -> (Report, Vec<Figure>) {
    let mut figures = Vec::new();
    let (ran, not_run): (Vec<&dyn Case>, Vec<&dyn Case>) =
        cases::ALL.iter().partition(|case| has_run(**case, records));
    let mut sections = vec![front::reading(), front::summary(verdicts, &not_run)];
    for case in ran {
        let (section, drawn) = case::section(case, records, verdicts);
        sections.push(section);
        figures.extend(drawn);
    }
    sections.extend([
        front::conservation(records),
        front::cost(records),
        deviations::section(),
        front::provenance(records),
    ]);
    let report = Report {
        title: "Whipple: verification report".into(),
        subtitle:
            "The kernel-free hybrid particle-finite-element method in one and three dimensions, \
                   judged against exact solutions and the paper"
                .into(),
        summary: front::verdict(verdicts, &not_run),
        sections: sections.into_iter().filter(has_content).collect(),
    };
    (report, figures)
}

fn has_content(section: &Section) -> bool {
    !section.blocks.is_empty() || !section.subsections.is_empty()
}
