//! The report: what the records and verdicts say, in the order in which a reader asks.
//!
//! A pure function of the records: nothing is run here, and no clock is read.

mod case;
mod deviations;
mod front;
pub mod hard;
pub mod sensitivity;

use whipple_solver::method::Preset;

use crate::cases::{self, Case};
use crate::claims::Verdict;
use crate::plots::Figure;
use crate::record::Records;
use crate::report::{Report, Section};
use crate::suite::has_run;

/// Groups of the contents.
const LINE: &str = "One dimension";
const SPACE: &str = "Three dimensions";
const RUNS: &str = "Conservation and cost";
const ORIGIN: &str = "Method and origin";

/// Composes the report and its figures.
#[must_use]
pub fn compose(records: &Records, verdicts: &[Verdict]) -> (Report, Vec<Figure>) {
    let mut figures = Vec::new();
    let (ran, not_run): (Vec<&dyn Case>, Vec<&dyn Case>) =
        cases::ALL.iter().partition(|case| has_run(**case, records));
    let mut sections = vec![front::summary(verdicts, &not_run), front::reading()];
    for case in ran {
        let (section, drawn) = case::section(case, records, verdicts);
        let group = if in_space(case) { SPACE } else { LINE };
        sections.push(section.within(group));
        figures.extend(drawn);
    }
    sections.extend([
        front::conservation(records).within(RUNS),
        front::cost(records).within(RUNS),
        deviations::section().within(ORIGIN),
        front::provenance(records).within(ORIGIN),
        front::commands(records).within(ORIGIN),
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

/// Whether a case is one of three dimensions.
fn in_space(case: &dyn Case) -> bool {
    case.scene(Preset::Default, "", case.default_size()).space().is_some()
}

fn has_content(section: &Section) -> bool {
    !section.blocks.is_empty() || !section.subsections.is_empty()
}
