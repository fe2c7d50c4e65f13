//! Planar impact in three dimensions: order, Hugoniot, and what a run in space prints.

use serde_json::Value;
use whipple_solver::method::Preset;
use whipple_vv::claims::order;

use crate::common::{completed, key, said};

/// The front keeps its number of cells, so its L1 error falls with the cell; the state behind it is
/// the Hugoniot's.
#[test]
fn shocks_converge_with_first_order() {
    let runs = [20, 40, 80].map(|n| completed(&key("planar-impact", Preset::Default, n)));
    let fit = order(&runs.each_ref(), "pressure_l1").expect("three sizes");
    assert!((fit.order - 1.0).abs() < 0.25, "{}", fit.order);
    let finest = &runs[2];
    for (name, bound) in [("pressure_error", 0.01), ("shock_speed_error", 0.01), ("noise", 0.01)] {
        assert!(finest.norms[name].abs() < bound, "{name}: {}", finest.norms[name]);
    }
    assert!(finest.energy_drift < 1e-12 && finest.momentum_drift < 1e-12);
    let space = finest.space.expect("what runs in space have");
    assert!(space.angular_momentum_drift < 1e-12 && space.geometry_mass_error < 1e-12);
}

/// `--json` gives the numbers that only runs in space have, beside the common ones; `--stop` ends
/// the run.
#[test]
fn runs_in_space_print_their_balance() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["run", "planar-impact", "--n", "16", "--stop", "0.1", "--json"];
    let said = said(folder.path(), &arguments);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let value: Value = serde_json::from_str(&said.out).expect("JSON");
    for name in [
        "particles",
        "elements",
        "mass_error",
        "geometry_mass_error",
        "angular_momentum_drift",
        "ledger_residual",
        "failed_elements",
        "updates_per_cpu_second",
        "bytes_per_particle",
        "energy_drift",
        "steps",
    ] {
        assert!(value[name].is_number(), "{name}");
    }
    assert!(value.get("residual_length_cm").is_none(), "only a rod has one");
    let command = value["provenance"]["command"].as_str();
    assert!(command.is_some_and(|c| c.ends_with("--stop 0.1")), "{command:?}");
}
