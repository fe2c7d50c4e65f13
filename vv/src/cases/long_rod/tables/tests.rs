//! The tables over records that were made up.

use approx::assert_relative_eq;

use super::*;
use crate::cases::Level as Extent;
use crate::cases::long_rod::claims;
use crate::run::blank;

/// A record of these residuals: length and velocity.
fn record(key: RunKey, residuals: [f64; 2]) -> RunRecord {
    let mut record = blank(key, 1, String::new());
    for (known, value) in KNOWN.iter().zip(residuals) {
        record.norms.insert(known.norm.into(), value);
    }
    record
}

/// Records of `default` with these lengths, coarse to fine, at the speed of the experiment.
fn sizes(lengths: &[f64]) -> Records {
    let mut records = Records::default();
    for (n, length) in SIZES.into_iter().zip(lengths) {
        records.insert(record(key(Preset::Default, n), [*length, 1.46]));
    }
    records
}

/// The row of `default` on the length of a table.
fn length_of_default(table: &Table, who: usize) -> &[Cell] {
    let rows = table.rows.iter();
    let mut own =
        rows.filter(|row| row[0].text.starts_with("length") && row[who].text == "`default`");
    own.next().expect("a row")
}

/// Lengths with an error of first order in the cell have that order, their limit, and an index with the
/// small factor.
#[test]
fn first_order_is_observed() {
    let lengths = SIZES.map(|n| 6.5 - 2.0 / n as f64);
    let table = convergence(&sizes(&lengths)).expect("a table");
    let row = length_of_default(&table, 1);
    assert_relative_eq!(row[3].value.expect("an order"), 1.0, max_relative = 1e-6);
    assert_relative_eq!(row[4].value.expect("a limit"), 6.5, max_relative = 1e-6);
    // The error of the finest is known: 2/9.
    let index = 100.0 * 1.25 * (2.0 / 9.0) / lengths[2];
    assert_relative_eq!(row[5].value.expect("an index"), index, max_relative = 1e-6);
    assert_relative_eq!(row[7].value.expect("an index"), index, max_relative = 1e-6);
    assert_eq!(
        (row[6].text.as_str(), row[9].text.as_str()),
        ("1.00, 1.25", "monotone, near the formal order")
    );
}

/// Where values do not go one way no order is shown, and two sizes show none.
#[test]
fn no_order_is_invented() {
    for (lengths, verdict) in [
        (&[6.16, 6.33, 6.30][..], "not monotone: no order, the range quoted"),
        (&[6.16, 6.18, 6.30], "changes do not shrink: no order"),
        (&[6.16, 6.33], "two sizes: no order, the formal one assumed"),
    ] {
        let table = convergence(&sizes(lengths)).expect("a table");
        let row = length_of_default(&table, 1);
        for cell in &row[3..6] {
            assert_eq!((cell.text.as_str(), cell.value), ("–", None), "{verdict}");
        }
        assert_eq!(row[9].text, verdict);
    }
    let table = convergence(&sizes(&[6.16, 6.33, 6.30])).expect("a table");
    let row = length_of_default(&table, 1);
    assert_relative_eq!(row[8].value.expect("a band"), 6.33 - 6.16, max_relative = 1e-12);
    // One size has no row; those of the paper do.
    let table = convergence(&sizes(&[6.16])).expect("a table");
    assert!(table.rows.iter().all(|row| row[1].text == "paper, Table 5"));
}

/// The numbers of gap G29 for the paper's own lengths.
#[test]
fn table_5_is_not_asymptotic() {
    let table = convergence(&Records::default()).expect("a table");
    let row = &table.rows[0];
    assert_eq!(row[1].text, "paper, Table 5");
    for (cell, wanted) in [(3, 3.17), (4, 6.70), (5, 2.04), (7, 20.5)] {
        assert_relative_eq!(row[cell].value.expect("a number"), wanted, max_relative = 5e-3);
    }
    assert_eq!(row[9].text, "monotone, faster than the method can: not asymptotic");
}

/// The velocities of Table 5 are equal as they are printed: that is no uncertainty of zero.
#[test]
fn equal_numbers_have_no_band() {
    let tables =
        [convergence(&Records::default()).expect("a table"), validation(&Records::default())];
    for (table, cell) in tables.iter().zip([8, 5]) {
        let mut rows = table.rows.iter().filter(|row| row[1].text == "paper, Table 5");
        let velocity = rows.rfind(|row| row[0].text.starts_with("velocity")).expect("a row");
        assert_eq!((velocity[cell].text.as_str(), velocity[cell].value), ("–", None));
    }
}

/// E, its parts and their sum by hand; a part that is not known leaves no sum and no judgement.
#[test]
fn validation_by_hand() {
    let mut records = sizes(&[6.1, 6.2, 6.25]);
    let shown = |records: &Records| {
        let table = validation(records);
        let row = length_of_default(&table, 1);
        let says = row[10].text.clone();
        (row[2..9].iter().map(|cell| cell.value).collect::<Vec<_>>(), says)
    };
    let (values, says) = shown(&records);
    assert_eq!((values[4], values[6]), (None, None));
    assert_eq!(says, "not to be judged: u_input is not known");
    for (variant, length) in [(AS_PRINTED, 5.8), (EXCHANGED, 6.4), (WIDE, 6.13)] {
        records.insert(record(varied_key(Preset::Default, variant), [length, 1.46]));
    }
    let (values, says) = shown(&records);
    let band =
        grid_study(&Who::Ours(Preset::Default).levels(&KNOWN[0], &records), 1.0).unwrap().band();
    let inputs = ((0.6_f64.powi(2) / 12.0) + (0.03_f64.powi(2) / 3.0)).sqrt();
    let whole = ((0.5 * band).powi(2) + inputs.powi(2) + 0.1_f64.powi(2)).sqrt();
    let wanted = [6.25, 6.38, -0.13, 0.5 * band, inputs, 0.10, whole];
    for (found, wanted) in values.into_iter().zip(wanted) {
        assert_relative_eq!(found.expect("a number"), wanted, max_relative = 1e-9);
    }
    assert_eq!(says, "no error of the model is resolved");
    // Answers over other steps add their scatter.
    for (variant, length) in STEPS.into_iter().zip([6.16, 6.04]) {
        records.insert(record(varied_key(Preset::Default, variant), [length, 1.46]));
    }
    let (values, _) = shown(&records);
    let numerical = (0.5 * band).hypot(0.12 / 12.0_f64.sqrt());
    assert_relative_eq!(values[3].expect("a number"), numerical, max_relative = 1e-9);
}

/// The runs of the full level fill every table, and nothing is said to be missing.
#[test]
fn the_full_level_fills_the_tables() {
    let mut records = Records::default();
    for (k, key) in claims::runs(Extent::Full).into_iter().enumerate() {
        // Different numbers, far enough apart to be told by.
        records.insert(record(key, [6.0 + 0.01 * k as f64, 1.4 + 0.001 * k as f64]));
    }
    let [table_5, convergence, validation, inputs, shapes, schemes] =
        all(&records).try_into().expect("six tables");
    assert_eq!(schemes.rows.len(), 3, "three densities");
    assert_eq!(shapes.rows.len(), 9, "three shapes at three sizes");
    for row in &table_5.rows[..9] {
        assert!(row[3].value.is_some() && row[6].value.is_some(), "{row:?}");
    }
    assert_eq!(convergence.rows.len(), 6);
    let judged = validation.rows.iter().filter(|row| row[8].value.is_some()).count();
    assert_eq!(judged, 4, "all but the two of the paper, whose inputs nobody varied");
    let [default, paper] = [VARIANTS.len() + 1, 5];
    assert_eq!(inputs.rows.len(), default + paper);
    let none = all(&Records::default());
    assert!(none.iter().flat_map(|t| &t.rows).flatten().all(|cell| cell.text != "NaN"));
}

#[test]
fn bounds_are_told() {
    assert_eq!(
        [6.39, 6.5, 6.68].map(|x| against(KNOWN[0].other_code(), x)),
        ["below", "within", "above"]
    );
}
