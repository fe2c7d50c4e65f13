//! Quick variants of the hard cases that hold with `default`, with the same pass numbers.

use super::{ALL, Answer, Extent, SCHEMES, stated};

/// Runs the quick variant of a case; says what fails.
fn quick(id: &str) {
    let case = ALL.iter().find(|case| case.id == id).expect("a case of the list");
    let record = case.measure(SCHEMES[0], Extent::Quick).expect("a case that is run");
    let failed: Vec<_> = record.readings.iter().filter(|reading| !reading.pass).collect();
    assert!(record.passes(), "{failed:#?}");
}

macro_rules! quick {
    ($($name:ident $id:literal),* $(,)?) => {
        $(#[test]
        fn $name() {
            quick($id);
        })*
    };
}

quick! {
    h03_a_pull_breaks_nothing "H03",
    h10_gaps_close_on_time "H10",
    h16_large_rotations_strain_nothing "H16",
    h17_waves_run_along_every_axis_of_flat_cells "H17",
    h19_what_is_symmetric_stays_so "H19",
    h21_restarts_have_the_same_bits "H21",
    h22_unequal_sizes_lose_no_momentum "H22",
    h23_corners_do_not_invert_cells "H23",
    h27_euler_parameters_keep_their_norm "H27",
    h29_lists_hold_all_neighbours "H29",
    h30_conduction_keeps_the_energy "H30",
}

#[test]
fn every_case_of_the_list_is_run_or_has_its_reason() {
    let listed: Vec<String> = stated().iter().map(|s| s.id.clone()).collect();
    assert_eq!(listed, ALL.map(|case| case.id));
    let reasoned = |answer: &Answer| match answer {
        Answer::Run(_) => true,
        Answer::Not(reason) => reason.len() > 20,
    };
    assert!(ALL.iter().all(|case| reasoned(&case.answer)));
}
