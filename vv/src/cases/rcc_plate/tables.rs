//! The tables of the report: hole beside NASA's equation, what moves it, cost beside Table 7.

use whipple_solver::method::Preset;

use super::claims::{HOLE, SCATTER, angles, nasa, states};
use super::problem::{ID, SIZES, STEP_08, changes, degrees, words};
use super::{SHAPES, kernel, varied};
use crate::cases::parts::studies::{FORMAL_ORDER, Judged, band, number, percent};
use crate::cases::{default_run, paper_run};
use crate::convergence::{Level, grid_study};
use crate::record::{Records, RunKey, RunRecord};
use crate::references;
use crate::report::{Cell, Column, Table, sig};
use crate::validation::{EXPANSION, combined, of_band, of_range};

/// The paper's cost of this problem.
const COST: &str = include_str!("../../../../references/paper_table7_cost.csv");

/// All tables, of what the records have.
pub(super) fn all(records: &Records) -> Vec<Table> {
    [Some(beside_equation(records)), moves(records), SHAPES.table(records), cost(records)]
        .into_iter()
        .flatten()
        .collect()
}

fn norm(records: &Records, key: &RunKey, name: &str) -> Option<f64> {
    records.get(key)?.norms.get(name).copied()
}

fn hole(records: &Records, key: &RunKey) -> Option<f64> {
    norm(records, key, HOLE)
}

/// Standard uncertainty of the hole at the plain angle by the cells, as a part of it: half the band over
/// the sizes, and the change by a shorter step.
fn numerical(records: &Records) -> Option<f64> {
    let value = |n: usize| hole(records, &default_run(ID, n));
    let level = |n: usize| Some(Level { spacing: 1.0 / n as f64, value: value(n)? });
    let levels: Option<Vec<Level>> = SIZES.into_iter().map(level).collect();
    let study = grid_study(&levels?, FORMAL_ORDER).ok()?;
    let finest = study.levels.first()?.value;
    let pair = [value(SIZES[0])?, hole(records, &varied(STEP_08))?];
    Some(combined(&[of_band(band(&study)?) / finest, of_range(&pair) / pair[0]]))
}

/// The same by the equation of state.
fn input(records: &Records) -> Option<f64> {
    let holes: Option<Vec<f64>> = states().iter().map(|key| hole(records, key)).collect();
    let holes = holes?;
    Some(of_range(&holes) / holes[0])
}

/// Holes beside NASA's equation, with the uncertainties of ASME V&V 20.
fn beside_equation(records: &Records) -> Table {
    let parts = [numerical(records), input(records)];
    let finer = SIZES[1..].iter().map(|&n| default_run(ID, n));
    let keys = angles().into_iter().chain(finer);
    let rows = keys.map(|key| {
        let (simulated, measured) = (hole(records, &key), nasa(&key.variant));
        let [numerical, input] =
            parts.map(|part| part.zip(simulated).map(|(part, hole)| part * hole));
        let data = of_band(SCATTER * measured);
        let judged = Judged { simulated, measured, numerical, input, data };
        let mut row: Vec<Cell> =
            vec![sig(degrees(&key.variant), 3).into(), Cell::count(key.n as u64)];
        row.push(percent(simulated, Some(measured)));
        row.push(number(norm(records, &key, "hole_growth_cm_us"), 2));
        row.extend(judged.cells());
        row
    });
    let rows = rows.collect();
    let mut columns = vec![
        Column::number("angle", "°"),
        Column::number("n", ""),
        Column::number("off the equation", "%"),
        Column::number("growth at 10 µs", "cm/µs"),
    ];
    columns.extend(Judged::columns());
    Table {
        id: "rcc-plate-equation".into(),
        caption: format!(
            "Diameter of the hole in cm beside NASA's equation, which is fitted to tests of coated panels: a \
             comparison, no validation by a test, with the uncertainties of ASME V&V 20-2009. S at 10 µs, D the equation, \
             u_val² = u_num² + u_input² + u_D², standard uncertainties; the error of the model lies in \
             E ± {} u_val. u_num: half the band quoted over 4, 6 and 8 cells, and the range over the safeties \
             0.9 and 0.8 of the step over 2√3. u_input: the range over the three equations of state of the \
             plate over 2√3, at n = 4. Both are those of 45 degrees, as parts of the hole. u_D: half of 15 %, a \
             working value. The equation is of the hole that is left; ours still grows at 10 µs, as the growth \
             over the last µs shows.",
            sig(EXPANSION, 2)
        ),
        columns,
        rows,
    }
}

/// What equation of state, failure, plate, step, preset and density move.
fn moves(records: &Records) -> Option<Table> {
    let own = |variant: &&str| varied(variant);
    let states = states();
    let mut keys: Vec<(RunKey, &str)> =
        states.iter().map(|key| (key.clone(), words(&key.variant))).collect();
    keys.extend(changes().iter().map(|variant| (own(variant), words(variant))));
    keys.push((paper_run(ID, SIZES[0]), words("")));
    keys.extend(Preset::ALL.map(|preset| (kernel(preset), "density by a kernel")));
    let shown = [
        (HOLE, "hole", "cm"),
        ("hole_sound_cm", "hole in what has not failed", "cm"),
        ("hole_growth_cm_us", "growth of the hole", "cm/µs"),
        ("debris_front_km_s", "front of the cloud", "km/s"),
        ("perforation_time_us", "perforated", "µs"),
        ("mass_behind_g", "mass behind", "g"),
    ];
    let plain = records.get(&varied(""));
    let row = |(key, what): (RunKey, &str)| {
        let record: &RunRecord = records.get(&key)?;
        let value = |record: &RunRecord, name: &str| record.norms.get(name).copied();
        let first = shown[0].0;
        let mut row: Vec<Cell> = vec![record.key.scheme.label().into(), what.into()];
        row.push(percent(value(record, first), plain.and_then(|plain| value(plain, first))));
        row.extend(shown.iter().map(|(name, ..)| number(value(record, name), 4)));
        Some(row)
    };
    let rows: Vec<Vec<Cell>> = keys.into_iter().filter_map(row).collect();
    let mut columns = vec![
        Column::text("scheme"),
        Column::text("variant"),
        Column::number("change of the hole", "%"),
    ];
    columns.extend(shown.iter().map(|(_, title, unit)| Column::number(*title, *unit)));
    (!rows.is_empty()).then(|| Table {
        id: "rcc-plate-inputs".into(),
        caption: format!(
            "What equation of state, failure, plate, step and density move at 45 degrees, n = {}; changes \
             against the first row. No spall strength of carbon-carbon is known, and its failure strain is \
             that of Table 6.",
            SIZES[0]
        ),
        columns,
        rows,
    })
}

/// Cost beside Table 7.
fn cost(records: &Records) -> Option<Table> {
    let paper = references::Table::parse("paper_table7_cost.csv", COST).ok()?;
    let column = |name: &str| paper.column(name).unwrap_or_default();
    let (counts, hours) = (column("n_particles"), column("processor_hours"));
    let names = paper.text("density_calculation").unwrap_or_default();
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    for ((count, hours), name) in counts.iter().zip(&hours).zip(names) {
        let who = format!("paper, {name}");
        let seconds = Cell::number(3600.0 * hours, 4);
        rows.push(vec![who.into(), Cell::count(*count as u64), "–".into(), "–".into(), seconds]);
    }
    let sizes = SIZES.map(|n| default_run(ID, n)).into_iter();
    let others = [paper_run(ID, SIZES[0])].into_iter().chain(Preset::ALL.map(kernel));
    for record in sizes.chain(others).filter_map(|key| records.get(&key)) {
        let Some(space) = record.space else { continue };
        rows.push(vec![
            format!("`{}`, n = {}", record.key.scheme.label(), record.key.n).into(),
            Cell::count(space.particles as u64),
            Cell::count(record.steps),
            Cell::number(space.updates_per_cpu_second, 3),
            Cell::number(record.cpu_seconds, 3),
        ]);
    }
    Some(Table {
        id: "rcc-plate-cost".into(),
        caption:
            "Cost to 10 µs beside Table 7 of the paper, in seconds of one processor: those of the \
                  paper are of 3 GHz processors of its time, several at once."
                .into(),
        columns: vec![
            Column::text("by whom"),
            Column::number("particles", ""),
            Column::number("steps", ""),
            Column::number("updates per CPU second", ""),
            Column::number("CPU seconds", ""),
        ],
        rows,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::Level as Extent;
    use crate::cases::rcc_plate::claims;
    use crate::run::blank;
    use approx::assert_relative_eq;

    /// A record with this hole.
    fn record(key: RunKey, diameter: f64) -> RunRecord {
        let mut record = blank(key, 1, String::new());
        record.norms.insert(HOLE.into(), diameter);
        record
    }

    /// The runs of the full level fill every table of what they measure.
    #[test]
    fn the_full_level_fills_the_tables() {
        let mut records = Records::default();
        for (k, key) in claims::runs(Extent::Full).into_iter().enumerate() {
            records.insert(record(key, 2.0 + 0.01 * k as f64));
        }
        let (holes, moved) = (beside_equation(&records), moves(&records).expect("a table"));
        assert_eq!(holes.rows.len(), 6);
        for row in &holes.rows {
            // u_val is known where every part is.
            assert!(row[10].value.is_some(), "{row:?}");
        }
        assert_eq!(moved.rows.len(), states().len() + changes().len() + 3);
        let empty = all(&Records::default());
        assert!(empty.iter().flat_map(|t| &t.rows).flatten().all(|cell| cell.text != "NaN"));
    }

    /// Parts of the uncertainty by hand: an error of first order in the cells, a step and a range.
    #[test]
    fn uncertainties_by_hand() {
        let mut records = Records::default();
        for n in SIZES {
            records.insert(record(default_run(ID, n), 3.0 - 2.0 / n as f64));
        }
        assert_eq!(numerical(&records), None);
        records.insert(record(varied(STEP_08), 2.6));
        let band = 1.25 * 0.25 / 2.75;
        let scatter = 0.1 / 12.0_f64.sqrt() / 2.5;
        let found = numerical(&records).expect("a part");
        assert_relative_eq!(found, (0.5_f64 * band).hypot(scatter), max_relative = 1e-6);
        assert_eq!(input(&records), None);
        let [_, soft, stiff] = states();
        records.insert(record(soft, 2.4));
        records.insert(record(stiff, 2.7));
        let found = input(&records).expect("a part");
        assert_relative_eq!(found, 0.3 / 12.0_f64.sqrt() / 2.5, max_relative = 1e-12);
    }
}
