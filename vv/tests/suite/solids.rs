//! Solids in three dimensions: the waves of a column with strength, and the density of a lattice.

use whipple_solver::method::Preset;
use whipple_vv::claims::order;

use crate::common::{completed, key, norm};

/// Weak waves spread as linear ones do, so that the L1 error falls with the root of the cell; precursor
/// and plastic wave are those of the exact solution.
#[test]
fn elastic_plastic_waves_converge() {
    let runs = [40, 80, 160].map(|n| completed(&key("elastic-plastic-piston", Preset::Default, n)));
    let fit = order(&runs.each_ref(), "velocity_l1").expect("three sizes");
    assert!((fit.order - 0.5).abs() < 0.25, "{}", fit.order);
    let finest = &runs[2];
    for name in ["precursor_error", "precursor_speed_error", "plastic_speed_error", "stress_error"]
    {
        assert!(finest.norms[name].abs() < 0.01, "{name}: {}", finest.norms[name]);
    }
    assert!(finest.energy_drift < 1e-12 && finest.momentum_drift < 1e-12);
}

/// The precursor tells the readings of the yield stress apart, each by its own exact solution.
#[test]
fn the_precursor_shows_the_reading_of_the_yield_stress() {
    let levels = ["", "j2", "as-printed"].map(|variant| {
        let key = key("elastic-plastic-piston", Preset::Default, 80).variant(variant);
        assert!(norm(&key, "precursor_error").abs() < 0.03, "{variant}");
        norm(&key, "precursor_m_s")
    });
    assert!(levels[1] > 1.6 * levels[0] && levels[2] > 1.15 * levels[1], "{levels:?}");
}

/// Pyramids give 1/J on every path, contacts what the rule gives on an infinite lattice.
#[test]
fn densities_of_a_deformed_lattice_are_those_of_their_rule() {
    for variant in ["", "uniform", "shear", "upset"] {
        let key = |preset| key("lattice-kinematics", preset, 8).variant(variant);
        assert!(norm(&key(Preset::Default), "largest_error") < 1e-5, "{variant}");
        assert!(norm(&key(Preset::Paper), "rule_error").abs() < 3e-3, "{variant}");
    }
}
