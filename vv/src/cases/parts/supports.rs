//! Which support serves the density of a kernel best: its error over the reach, before any ratio of costs.

use whipple_solver::method::{Density, Preset};
use whipple_solver::space::method::Method;

use super::studies::number;
use crate::plots::{Axis, Figure, Panel, Series as Curve};
use crate::record::{Records, RunKey, RunRecord, Scheme};
use crate::report::{Cell, Column, Table};

/// Variants that change the reach of the kernel, beside the plain one.
pub(in crate::cases) const VARIANTS: [&str; 5] =
    ["support-1.15", "support-1.3", "support-1.5", "support-1.85", "support-2"];
const PREFIX: &str = "support-";

/// The variants of a case with these after them.
///
/// # Panics
/// If `N` is not the number of both; where the list is a constant, that is an error of the build.
pub(in crate::cases) const fn after<const A: usize, const N: usize>(
    own: [&'static str; A],
) -> [&'static str; N] {
    assert!(N == A + VARIANTS.len(), "own variants, and those of the supports");
    let mut all = [""; N];
    let mut k = 0;
    while k < N {
        all[k] = if k < A { own[k] } else { VARIANTS[k - A] };
        k += 1;
    }
    all
}

/// The reach that a variant asks for.
pub(in crate::cases) fn of(variant: &str) -> Option<f64> {
    variant.strip_prefix(PREFIX)?.parse().ok()
}

/// A method with the reach of a variant; unchanged by other variants.
pub(in crate::cases) fn apply(method: Method, variant: &str) -> Method {
    Method { kernel_support: of(variant).unwrap_or(method.kernel_support), ..method }
}

/// The study of a case at one size.
pub(in crate::cases) struct Supports {
    pub(in crate::cases) case: &'static str,
    pub(in crate::cases) n: usize,
    /// Norms, what they are of.
    pub(in crate::cases) errors: &'static [(&'static str, &'static str)],
}

impl Supports {
    fn key(&self) -> RunKey {
        let scheme = Scheme::Particles { preset: Preset::Default, density: Density::Kernel };
        RunKey::new(self.case, scheme, self.n)
    }

    /// The runs beside that of the plain variant.
    pub(in crate::cases) fn runs(&self) -> Vec<RunKey> {
        VARIANTS.map(|variant| self.key().variant(variant)).into()
    }

    /// Reaches with their runs, short to long; none without those of [`Supports::runs`].
    fn found<'a>(&self, records: &'a Records) -> Vec<(f64, &'a RunRecord)> {
        let reach = |variant: &str| of(variant).unwrap_or(Preset::Default.space().kernel_support);
        let keys = [""].into_iter().chain(VARIANTS);
        let runs = keys.filter_map(|v| Some((reach(v), records.get(&self.key().variant(v))?)));
        let mut runs: Vec<_> = runs.collect();
        runs.sort_by(|a, b| a.0.total_cmp(&b.0));
        if runs.len() > 1 { runs } else { Vec::new() }
    }

    /// Errors, work and CPU time by the reach.
    pub(in crate::cases) fn table(&self, records: &Records) -> Option<Table> {
        let runs = self.found(records);
        let first = self.errors.first().filter(|_| !runs.is_empty())?;
        let error = |run: &RunRecord, norm| run.norms.get(norm).copied().map(f64::abs);
        let best = runs.iter().filter_map(|(reach, run)| Some((*reach, error(run, first.0)?)));
        let best = best.min_by(|a, b| a.1.total_cmp(&b.1));
        let mut columns = vec![
            Column::number("support", "contact distances"),
            Column::number("evaluations per particle-step", ""),
            Column::number("steps", ""),
            Column::number("CPU", "s"),
        ];
        columns.extend(self.errors.iter().map(|(_, name)| Column::number(*name, "")));
        let rows = runs.iter().map(|(reach, run)| {
            let work = run.counters.map(|c| c.kernel_evaluations as f64 / c.particle_steps as f64);
            let mut row = vec![
                Cell::number(*reach, 3),
                number(work, 3),
                Cell::count(run.steps),
                Cell::number(run.cpu_seconds, 3),
            ];
            row.extend(self.errors.iter().map(|(norm, _)| number(error(run, norm), 3)));
            row
        });
        let best = best.map_or_else(String::new, |(reach, _)| {
            format!(" The error of {} is least at {reach}.", first.1)
        });
        let caption = format!(
            "The density of a kernel over its support, n = {}, everything else as in `default`; {} is what \
             `default` has.{best}",
            self.n,
            Preset::Default.space().kernel_support,
        );
        let id = format!("{}-supports", self.case);
        Some(Table { id, caption, columns, rows: rows.collect() })
    }

    /// Errors over the reach.
    pub(in crate::cases) fn figure(&self, records: &Records) -> Option<Figure> {
        let runs = self.found(records);
        if runs.is_empty() {
            return None;
        }
        let axis = Axis::linear("support of the kernel, contact distances");
        let mut panel = Panel::new("", axis, Axis::log("error"));
        for (norm, name) in self.errors {
            let points =
                runs.iter().filter_map(|(reach, run)| Some((*reach, run.norms.get(*norm)?.abs())));
            panel = panel.with(Curve::marked(*name, points.collect()));
        }
        let caption = "Errors of the density of a kernel over its support.";
        Some(Figure::new(format!("{}-supports", self.case), caption, vec![panel]))
    }
}
