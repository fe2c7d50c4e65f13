//! What was measured, as tables and a figure.

use whipple_solver::space::phase::Phase;

use super::bandwidth::triad;
use super::{Pace, Spent};
use crate::plots::{Axis, Figure, Panel, Series};
use crate::report::{Cell, Column, Table};

/// Nanoseconds of a second.
const NS: f64 = 1e9;
/// Bytes of a gigabyte.
const GB: f64 = 1e9;
/// Bytes that no cache of a processor holds.
const BEYOND_CACHES: usize = 256_000_000;

fn table(id: &str, caption: &str, columns: Vec<Column>, rows: Vec<Vec<Cell>>) -> Table {
    Table { id: id.into(), caption: caption.into(), columns, rows }
}

/// Speed, and the work that was done: counts for each particle and step.
#[must_use]
pub fn work(paces: &[Pace]) -> Table {
    let number = |name: &str| Column::number(name, "");
    let columns = vec![
        Column::text("scheme"),
        number("particles"),
        number("steps"),
        number("CPU s"),
        number("1e6 updates/s"),
        number("bytes/particle"),
        number("elements"),
        number("pairs listed"),
        number("pairs acting"),
        number("kernel evals"),
        number("steps/list"),
        number("tests/list"),
    ];
    let rows = paces.iter().map(|pace| {
        let renewals = pace.renewals as f64;
        vec![
            pace.name.clone().into(),
            Cell::count(pace.particles as u64),
            Cell::count(pace.steps),
            Cell::number(pace.cpu, 3),
            Cell::number(1e-6 * pace.rate(), 3),
            Cell::number(pace.bytes as f64 / pace.particles as f64, 3),
            Cell::number(pace.per_update(pace.elements), 3),
            Cell::number(pace.per_update(pace.listed), 3),
            Cell::number(pace.per_update(pace.acting), 3),
            Cell::number(pace.per_update(pace.kernel_evaluations), 3),
            Cell::number(pace.steps as f64 / renewals, 3),
            Cell::number(pace.tests as f64 / renewals / pace.particles as f64, 3),
        ]
    });
    let caption = "Speed on one thread, and work: elements, pairs listed, pairs that acted and \
                   evaluations of the kernel per particle-update; steps that a list of pairs serves, and \
                   distances compared for one, per particle of the scene.";
    table("pace-work", caption, columns, rows.collect())
}

/// Nanoseconds of an update by phase.
fn nanoseconds(spent: Spent, updates: u64) -> Spent {
    spent.map(|seconds| NS * seconds / updates as f64)
}

/// Where the time goes: nanoseconds of an update by phase.
#[must_use]
pub fn phases(paces: &[Pace]) -> Table {
    let mut columns = vec![Column::text("scheme"), Column::number("ns/update", "")];
    columns.extend(Phase::ALL.map(|phase| Column::number(phase.name(), "%")));
    columns.push(Column::number("balance, steps", ""));
    let rows = paces.iter().map(|pace| {
        let mut row = vec![pace.name.clone().into(), Cell::number(NS / pace.rate(), 3)];
        row.extend(pace.spent().map(|spent| Cell::number(100.0 * spent / pace.cpu, 3)));
        row.push(Cell::number(pace.balance * pace.steps as f64 / pace.cpu, 3));
        row
    });
    let caption = "CPU time by phase. Last: what one balance of mass, momentum and energy takes, in \
                   steps; runs look at it at times of their own, off the clock.";
    table("pace-phases", caption, columns, rows.collect())
}

/// What more threads gain, and what the memory of this machine gives one of them.
#[must_use]
pub fn machine(one: &Pace, more: &Pace) -> Table {
    let [held, beyond] = [one.bytes, BEYOND_CACHES].map(|bytes| triad(bytes) / GB);
    let rows: [(String, Cell); 10] = [
        ("threads".into(), Cell::count(more.threads as u64)),
        ("wall of one thread, s".into(), Cell::number(one.wall, 3)),
        (format!("wall of {}, s", more.threads), Cell::number(more.wall, 3)),
        ("gain".into(), Cell::number(one.wall / more.wall, 3)),
        (format!("CPU of {} over CPU of one", more.threads), Cell::number(more.cpu / one.cpu, 3)),
        ("CPU of one over its wall".into(), Cell::number(one.cpu / one.wall, 3)),
        ("memory held, MB".into(), Cell::number(1e-6 * one.bytes as f64, 3)),
        ("triad over as much, GB/s".into(), Cell::number(held, 3)),
        (format!("triad over {} MB, GB/s", BEYOND_CACHES / 1_000_000), Cell::number(beyond, 3)),
        ("one update, ns".into(), Cell::number(NS / one.rate(), 3)),
    ];
    let rows = rows.map(|(name, cell)| vec![name.into(), cell]).to_vec();
    let caption = "Threads by time on the wall, and memory by one thread. Where the CPU time of one \
                   thread is well below its wall the machine was busy, and the gain says little.";
    let columns = vec![Column::text("what"), Column::number("measured", "")];
    table("pace-machine", caption, columns, rows)
}

/// Where the time goes over the run.
#[must_use]
pub fn figure(paces: &[Pace]) -> Figure {
    let panels = paces.iter().take(4).map(|pace| {
        let mut panel =
            Panel::new(pace.name.clone(), Axis::linear("time, µs"), Axis::linear("ns per update"));
        for phase in Phase::ALL {
            let points: Vec<(f64, f64)> = pace
                .parts
                .iter()
                .map(|part| (part.time, nanoseconds(part.spent, part.updates)[phase as usize]))
                .collect();
            if points.iter().any(|(_, y)| *y > 0.0) {
                panel = panel.with(Series::line(phase.name(), points));
            }
        }
        panel
    });
    Figure::new("pace", "CPU time of a particle-update by phase.", panels.collect())
}
