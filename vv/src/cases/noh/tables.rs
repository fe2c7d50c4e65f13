//! Tables of the report: Table 2 of the paper, and what each choice is worth.

use whipple_solver::method::Preset;

use super::schemes;
use super::variants::{SUPPORTS, variants_of};
use super::{DRAWN, ID};
use crate::cases::kernel_default;
use crate::record::{Records, RunKey, Scheme};
use crate::report::{Cell, Column, Table};

/// Table 2: particles, velocity norm, temperature norm.
pub(super) const TABLE_2: [(usize, f64, f64); 4] = [
    (100, 0.17116, 0.08594),
    (200, 0.12141, 0.06075),
    (400, 0.08635, 0.04325),
    (800, 0.06081, 0.03032),
];

/// The paper's Table 2 with ours beside it.
pub(super) fn table_2_beside(records: &Records) -> Table {
    let mut columns = vec![Column::number("n", "")];
    for symbol in ["v", "θ"] {
        let head = |whose: &str| Column::number(format!("{symbol}: {whose}"), "");
        columns.push(head("paper's table"));
        columns.push(head("`paper`"));
        columns.push(Column::number("off", "%"));
        columns.push(head("`default`"));
        columns.push(head("with kernel"));
        columns.push(head("Godunov"));
    }
    let row = |&(n, velocity, temperature): &(usize, f64, f64)| {
        let norm = |scheme, name: &str| {
            records.get(&RunKey::new(ID, scheme, n)).and_then(|r| r.norms.get(name).copied())
        };
        let number = |value: Option<f64>, digits| {
            value.map_or_else(|| "–".into(), |value| Cell::number(value, digits))
        };
        let mut row = vec![Cell::count(n as u64)];
        for (name, printed) in [("velocity_rms", velocity), ("temperature_rms", temperature)] {
            let [paper, default, kernel, godunov] = schemes().map(|scheme| norm(scheme, name));
            row.push(Cell::number(printed, 5));
            row.push(number(paper, 5));
            row.push(number(paper.map(|p| 100.0 * (p / printed - 1.0)), 2));
            row.extend([default, kernel, godunov].map(|value| number(value, 4)));
        }
        row
    };
    Table {
        id: "noh-table-2".into(),
        caption: "Table 2 of the paper: RMS norms of velocity and temperature at t = 0.3, with ours \
                  beside them. The `paper` column replicates; the others say what else is possible at \
                  this one phase of the shock. Godunov counts cells, of which a fifth is shocked \
                  where four fifths of the particles are."
            .into(),
        columns,
        rows: TABLE_2.iter().map(row).collect(),
    }
}

/// What each choice is worth: both presets with one choice changed.
pub(super) fn choices(records: &Records) -> Table {
    let norms: [(&str, &str); 5] = [
        ("velocity_rms_phase", "n·rms² of v"),
        ("temperature_rms_phase", "n·rms² of θ"),
        ("wall_heating", "wall heating, %"),
        ("velocity_l1_window", "window L1 of v"),
        ("energy", "energy drift"),
    ];
    let mut columns = vec![Column::text("preset"), Column::text("one choice changed")];
    columns.extend(norms.iter().map(|(_, title)| Column::number(*title, "")));
    columns.push(Column::number("steps", ""));
    let mut rows = Vec::new();
    let changed = Preset::ALL.into_iter().flat_map(|preset| {
        let names = std::iter::once("").chain(variants_of(preset).iter().copied());
        names.map(move |name| (Scheme::preset(preset), name))
    });
    let kernels = std::iter::once("").chain(SUPPORTS.iter().map(|(name, _)| *name));
    for (scheme, variant) in changed.chain(kernels.map(|name| (kernel_default(), name))) {
        let key = RunKey::new(ID, scheme, DRAWN).variant(variant);
        let Some(record) = records.get(&key) else {
            continue;
        };
        let name = if variant.is_empty() { "–" } else { variant };
        let mut row: Vec<Cell> = vec![scheme.label().into(), name.into()];
        for (norm, _) in norms {
            let value = record.norms.get(norm).copied();
            row.push(match (norm, value) {
                ("energy", _) => Cell::number(record.energy_drift, 2),
                (_, None) => "run failed".into(),
                ("wall_heating", Some(value)) => Cell::number(100.0 * value, 3),
                ("velocity_l1_window", Some(value)) => Cell::number(value, 4),
                (_, Some(value)) => Cell::number(DRAWN as f64 * value * value, 4),
            });
        }
        row.push(Cell::count(record.steps));
        rows.push(row);
    }
    Table {
        id: "noh-choices".into(),
        caption: format!(
            "What each choice is worth on the wall shock, n = {DRAWN}: both presets with one choice \
             changed, `half-step` for the time step, and the kernel density over its support. RMS \
             norms are phase averages."
        ),
        columns,
        rows,
    }
}
