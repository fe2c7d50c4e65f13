//! Which density is cheaper at equal error: the paper's, a kernel's and that of elements, error over CPU time.

use whipple_solver::method::{Density, Preset};

use super::studies::number;
use crate::plots::{Axis, Figure, Panel, Series as Curve};
use crate::record::{Records, RunKey, RunRecord, Scheme};
use crate::report::{Cell, Column, Table};

/// The density of `default`, and its rivals.
const DENSITIES: [Density; 3] = [Density::Hybrid, Density::Nonholonomic, Density::Kernel];

/// A number of a run that tells its error.
#[derive(Debug, Clone, Copy)]
pub(in crate::cases) enum Error {
    /// One that is an error.
    Norm(&'static str),
    /// One that should have a value.
    Off(&'static str, f64),
}

/// The study of a case.
pub(in crate::cases) struct Schemes {
    pub(in crate::cases) case: &'static str,
    pub(in crate::cases) sizes: &'static [usize],
    pub(in crate::cases) error: Error,
    /// What the error is of.
    pub(in crate::cases) name: &'static str,
}

impl Schemes {
    fn key(&self, density: Density, n: usize) -> RunKey {
        RunKey::new(self.case, Scheme::Particles { preset: Preset::Default, density }, n)
    }

    /// The runs of the rivals.
    pub(in crate::cases) fn runs(&self) -> Vec<RunKey> {
        let rivals = DENSITIES[1..].iter();
        rivals.flat_map(|&density| self.sizes.iter().map(move |&n| self.key(density, n))).collect()
    }

    fn error(&self, run: &RunRecord) -> Option<f64> {
        match self.error {
            Error::Norm(norm) => run.norms.get(norm).map(|error| error.abs()),
            Error::Off(norm, wanted) => run.norms.get(norm).map(|x| (x / wanted - 1.0).abs()),
        }
    }

    /// Runs by a density that there are, coarse to fine, with their errors.
    fn of<'a>(&self, density: Density, records: &'a Records) -> Vec<(&'a RunRecord, Option<f64>)> {
        let runs = self.sizes.iter().filter_map(|&n| records.get(&self.key(density, n)));
        runs.map(|run| (run, self.error(run))).collect()
    }

    fn some(&self, records: &Records) -> bool {
        DENSITIES[1..].iter().any(|&density| !self.of(density, records).is_empty())
    }

    /// Error and CPU time, and what the cheapest run of `default` costs that errs no more.
    pub(in crate::cases) fn table(&self, records: &Records) -> Option<Table> {
        if !self.some(records) {
            return None;
        }
        let columns = vec![
            Column::text("density"),
            Column::number("n", ""),
            Column::number("steps", ""),
            Column::number("CPU", "s"),
            Column::number(format!("error of {}", self.name), ""),
            Column::number("hybrid with no more error", "CPU s"),
            Column::number("it is cheaper by", ""),
        ];
        let hybrid = self.of(Density::Hybrid, records);
        let rows = DENSITIES.into_iter().flat_map(|density| {
            self.of(density, records).into_iter().map(move |(run, error)| (density, run, error))
        });
        let rows = rows.map(|(density, run, error)| {
            let as_good = hybrid.iter().filter(|(_, own)| *own <= error && own.is_some());
            let cheapest = as_good.map(|(own, _)| own.cpu_seconds).fold(f64::INFINITY, f64::min);
            let cheapest = Some(cheapest)
                .filter(|cpu| cpu.is_finite() && error.is_some() && density != Density::Hybrid);
            vec![
                density.name().into(),
                Cell::count(run.key.n as u64),
                Cell::count(run.steps),
                Cell::number(run.cpu_seconds, 3),
                number(error, 3),
                number(cheapest, 3),
                number(cheapest.map(|cpu| run.cpu_seconds / cpu), 3),
            ]
        });
        let caption = "Density schemes with everything else as in `default`: error against CPU time of one run. Last: the \
                       cheapest of the runs by `hybrid` that err no more, where there is one.";
        let id = format!("{}-schemes", self.case);
        Some(Table { id, caption: caption.into(), columns, rows: rows.collect() })
    }

    /// Error over CPU time.
    pub(in crate::cases) fn figure(&self, records: &Records) -> Option<Figure> {
        if !self.some(records) {
            return None;
        }
        let label = format!("error of {}", self.name);
        let mut panel = Panel::new("", Axis::log("CPU seconds"), Axis::log(label));
        for density in DENSITIES {
            let runs = self.of(density, records);
            let points =
                runs.into_iter().filter_map(|(run, error)| Some((run.cpu_seconds, error?)));
            panel = panel.with(Curve::marked(density.name(), points.collect()));
        }
        let caption = "Error over CPU time by the density scheme, everything else as in `default`.";
        Some(Figure::new(format!("{}-schemes", self.case), caption, vec![panel]))
    }
}
