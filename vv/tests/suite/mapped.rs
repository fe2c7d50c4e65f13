//! Cases on mapped lattices.

use whipple_solver::method::Preset;

use crate::common::{completed, key, norm};

/// A tube that collapses is on its way as long as it is half open, and its cells converge to the
/// rigid-plastic shell faster than by their first order.
#[test]
fn a_collapsing_tube_is_on_its_way() {
    let [coarse, fine] =
        [4, 8].map(|n| norm(&key("verney", Preset::Default, n), "half_way_error_cm").abs());
    assert!(fine < 0.005, "{fine} cm");
    assert!(fine < 0.5 * coarse, "{coarse} and {fine} cm");
}

/// Behind the shock the means are those of the jump conditions on either lattice, and no cell is lost.
#[test]
fn a_piston_drives_its_shock_through_skewed_cells() {
    for variant in ["", "regular"] {
        let run = completed(&key("saltzman", Preset::Default, 5).variant(variant));
        for name in ["density_error", "pressure_error"] {
            assert!(run.norms[name].abs() < 0.03, "{variant} {name}: {}", run.norms[name]);
        }
        assert_eq!(run.norms["dead_elements"], 0.0);
        assert!(run.energy_drift < 1e-12 && run.momentum_drift < 1e-12);
    }
}
