//! The density rules: what is integrated equals what is defined, and uniform compression is exact.

use whipple_solver::method::{Density, Integrator, Method, Preset};
use whipple_solver::output::Snapshot;
use whipple_solver::scene::{Body, Boundary, Profile};

use crate::common::{
    IDEAL_GAS, at_time, body, box_walls, ends, ideal, scene, standing_wave, start, with_density,
};

/// Largest distance of the integrated density from Eq. (32), for a box of unit length with walls.
fn defect(s: &Snapshot) -> f64 {
    let n = s.x.len();
    let length = 1.0 / n as f64;
    let gap = |i: usize| match i {
        0 => 2.0 * s.x[0],
        i if i == n => 2.0 * (1.0 - s.x[n - 1]),
        i => s.x[i] - s.x[i - 1],
    };
    let defined = |i: usize| 0.5 * (length / gap(i) + length / gap(i + 1));
    (0..n).map(|i| (s.rho[i] / defined(i) - 1.0).abs()).fold(0.0, f64::max)
}

/// Eq. (32) holds after cycles of compression and expansion although only its rate, Eq. (34), is
/// integrated; what is missed is the integrator's, of second order in the time step.
#[test]
fn integrated_density_returns_with_the_particles() {
    for integrator in [Integrator::SinglePass, Integrator::Compatible] {
        let missed = |cfl| {
            let method =
                Method { cfl, integrator, ..with_density(Preset::Default, Density::Nonholonomic) };
            // The wave passes the box of length 1 at speed near 1: two cycles in 4.
            let scene = standing_wave(method, 32, 0.2);
            let mut solver = start(&scene);
            let mut worst = (0.0_f64, 0.0_f64);
            for k in 1..=40 {
                solver.advance_to(0.1 * f64::from(k)).expect("a wave in a box runs");
                let s = solver.snapshot();
                let spread = s.rho.iter().fold(0.0_f64, |top, rho| top.max((rho - 1.0).abs()));
                worst = (worst.0.max(defect(&s)), worst.1.max(spread));
            }
            assert!(worst.1 > 0.05, "the gas is really compressed: {}", worst.1);
            worst.0
        };
        let (coarse, fine) = (missed(0.3), missed(0.15));
        assert!(coarse < 2e-4, "{integrator:?}: {coarse:e}");
        assert!((3.0..5.5).contains(&(coarse / fine)), "{integrator:?}: {coarse:e} {fine:e}");
    }
}

/// Cold gas with velocity -x falls together: 1 / (1 - t) everywhere, by every rule.
#[test]
fn uniform_collapse_is_exact() {
    for (density, tolerance) in [
        // A segment's density is that of its length.
        (Density::Hybrid, 1e-12),
        // Integrated: second order in the time step.
        (Density::Nonholonomic, 1e-4),
    ] {
        for time in [0.1, 0.5, 0.8] {
            let gas = Body {
                velocity: Profile::Linear { at_origin: 0.0, slope: -1.0 },
                ..body(0.0, 1.0, 50)
            };
            let method = Method { cfl: 0.03, ..with_density(Preset::Default, density) };
            let walls = ends(Boundary::Mirror(0.0), Boundary::Free);
            let s = at_time(&scene(method, IDEAL_GAS, walls, vec![gas]), time);
            let exact = 1.0 / (1.0 - time);
            let worst =
                s.rho.iter().take(49).map(|rho| (rho / exact - 1.0).abs()).fold(0.0, f64::max);
            assert!(worst < tolerance, "{density:?} at {time}: {worst:e}");
            assert!(s.u.iter().all(|u| u.abs() < 1e-12), "a uniform compression is no shock");
        }
    }
}

/// At the start every scheme gives the density that the scene asks for, at walls and free ends too.
#[test]
fn initial_density_is_the_scene_s() {
    for density in Density::ALL {
        for preset in Preset::ALL {
            for boundaries in [box_walls(), crate::common::FREE] {
                let reference = body(0.0, 1.0, 40);
                let scene =
                    scene(with_density(preset, density), IDEAL_GAS, boundaries, vec![reference]);
                let s = start(&scene).snapshot();
                assert!(
                    s.rho.iter().all(|rho| (rho - 1.0).abs() < 1e-12),
                    "{density:?} {preset:?}"
                );
            }
        }
    }
}

/// A body that is compressed at the start has its density and its mass; the kernel, which sums over
/// a lattice closer than its support resolves, within 2 % inside.
#[test]
fn compressed_body_has_its_density_and_mass() {
    for (density, tolerance) in
        [(Density::Hybrid, 1e-12), (Density::Nonholonomic, 1e-12), (Density::Kernel, 0.02)]
    {
        let gas = Body { compression: 1.2, energy: Profile::Uniform(1.0), ..body(0.0, 1.0, 40) };
        let s = start(&scene(ideal(density), IDEAL_GAS, box_walls(), vec![gas])).snapshot();
        assert!((s.m.iter().sum::<f64>() - 1.2).abs() < 1e-12);
        for rho in &s.rho[4..36] {
            assert!((rho / 1.2 - 1.0).abs() < tolerance, "{density:?}: {rho}");
        }
    }
}
