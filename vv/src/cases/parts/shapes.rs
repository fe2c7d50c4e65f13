//! Which shape of cells is cheaper: runs with cells two and four times as long, their error against the finest run over
//! their CPU time.

use whipple_solver::method::Preset;

use super::studies::{number, percent};
use crate::cases::run_of;
use crate::plots::{Axis, Figure, Panel, Series as Curve};
use crate::record::{Records, RunKey, RunRecord};
use crate::report::{Cell, Column, Table};

/// Variants with cells twice and four times as long; the plain one has cubes.
pub(in crate::cases) const LONG: [&str; 2] = ["cells-2", "cells-4"];

/// How long the cells of a variant are over their shortest edge.
pub(in crate::cases) fn aspect(variant: &str) -> usize {
    LONG.iter().position(|long| *long == variant).map_or(1, |k| 2 << k)
}

/// The study of a case.
pub(in crate::cases) struct Shapes {
    pub(in crate::cases) case: &'static str,
    pub(in crate::cases) sizes: [usize; 3],
    /// Norms with their names and units.
    pub(in crate::cases) answers: &'static [(&'static str, &'static str, &'static str)],
    /// Which edges are long.
    pub(in crate::cases) which: &'static str,
}

impl Shapes {
    fn key(&self, variant: &str, n: usize) -> RunKey {
        run_of(self.case, Preset::Default, n).variant(variant)
    }

    /// The runs besides those with cubes.
    pub(in crate::cases) fn runs(&self) -> Vec<RunKey> {
        let all = LONG.iter().flat_map(|v| self.sizes.iter().map(move |&n| self.key(v, n)));
        all.collect()
    }

    /// Runs of a shape that there are, coarse to fine.
    fn of<'a>(&self, variant: &str, records: &'a Records) -> Vec<&'a RunRecord> {
        self.sizes.iter().filter_map(|&n| records.get(&self.key(variant, n))).collect()
    }

    /// The finest run of cubes, and the norm that is asked for.
    fn finest(&self, records: &Records, norm: &str) -> Option<f64> {
        records.get(&self.key("", self.sizes[2]))?.norms.get(norm).copied()
    }

    /// Cost and answers by shape and size.
    pub(in crate::cases) fn table(&self, records: &Records) -> Option<Table> {
        let mut columns = vec![
            Column::text("cells"),
            Column::number("n", ""),
            Column::number("particles", ""),
            Column::number("steps", ""),
            Column::number("CPU", "s"),
        ];
        for (_, name, unit) in self.answers {
            columns.push(Column::number(*name, *unit));
            columns.push(Column::number("off the finest", "%"));
        }
        let shapes = std::iter::once("").chain(LONG);
        let rows: Vec<Vec<Cell>> = shapes
            .flat_map(|variant| {
                self.of(variant, records).into_iter().map(move |run| (variant, run))
            })
            .map(|(variant, run)| {
                let particles = run.space.map(|space| space.particles as f64);
                let mut row = vec![
                    format!("{}:1", aspect(variant)).into(),
                    Cell::count(run.key.n as u64),
                    number(particles, 6),
                    Cell::count(run.steps),
                    Cell::number(run.cpu_seconds, 3),
                ];
                for (norm, ..) in self.answers {
                    let value = run.norms.get(*norm).copied();
                    row.push(number(value, 4));
                    row.push(percent(value, self.finest(records, norm)));
                }
                row
            })
            .collect();
        let caption = format!(
            "Shape of cells, `default`: {} are one, two and four times as long as the others, which n counts. Off the \
             finest: of the cubes with n = {}.",
            self.which, self.sizes[2]
        );
        let id = format!("{}-shapes", self.case);
        (rows.len() > 3).then_some(Table { id, caption, columns, rows })
    }

    /// Error over CPU time.
    pub(in crate::cases) fn figure(&self, records: &Records) -> Option<Figure> {
        let panels: Vec<Panel> = self
            .answers
            .iter()
            .map(|(norm, name, _)| {
                let label = format!("{name}, off the finest");
                let mut panel = Panel::new("", Axis::log("CPU seconds"), Axis::log(label));
                for variant in std::iter::once("").chain(LONG) {
                    let finest = self.finest(records, norm);
                    let error = |run: &&RunRecord| {
                        let off = (run.norms.get(*norm)? / finest? - 1.0).abs();
                        (off > 0.0).then_some((run.cpu_seconds, off))
                    };
                    let points = self.of(variant, records).iter().filter_map(error).collect();
                    panel = panel.with(Curve::marked(format!("{}:1", aspect(variant)), points));
                }
                panel
            })
            .collect();
        let some = LONG.iter().any(|variant| !self.of(variant, records).is_empty());
        let caption = format!(
            "Distance from the run with cubes and n = {} over CPU time, by the shape of cells: {} are longer.",
            self.sizes[2], self.which
        );
        some.then(|| Figure::new(format!("{}-shapes", self.case), &caption, panels))
    }
}
