//! The smallest honest program: Noh's wall shock with both presets.
#![allow(clippy::print_stdout)]

use whipple_solver::method::Preset;
use whipple_solver::scene::{Body, Boundaries, Boundary, EosData, Interface, Layout, Material};
use whipple_solver::scene::{Profile, Scene};
use whipple_solver::units::Units;

fn scene(preset: Preset, n: usize) -> Scene {
    Scene {
        name: "noh".into(),
        units: Units::None,
        stop_time: 0.3,
        method: preset.method(),
        boundaries: Boundaries { left: Boundary::Mirror(0.0), right: Boundary::Free },
        materials: vec![Material {
            name: "gas".into(),
            density: 1.0,
            eos: EosData::IdealGas { adiabatic_index: 5.0 / 3.0, c_v: 1.0, u_0: 1.0, theta_0: 1.0 },
        }],
        bodies: vec![Body {
            material: "gas".into(),
            from: 0.0,
            to: 0.5,
            particles: n,
            layout: Layout::Centres,
            compression: 1.0,
            interface: Interface::Joined,
            velocity: Profile::Uniform(-1.0),
            energy: Profile::Uniform(1.0),
        }],
    }
}

fn main() {
    for preset in [Preset::Paper, Preset::Default] {
        for n in [100, 200, 400, 800] {
            let mut s = match whipple_solver::build(&scene(preset, n)) {
                Ok(s) => s,
                Err(e) => return println!("{e}"),
            };
            let start = std::time::Instant::now();
            if let Err(e) = s.advance_to(0.3) {
                println!("{e}");
            }
            let secs = start.elapsed().as_secs_f64();
            let p = s.snapshot();
            let (mut ev, mut et) = (0.0, 0.0);
            for i in 0..n {
                let (v, t) = if p.x[i] < 0.1 { (0.0, 1.5) } else { (-1.0, 1.0) };
                ev += (p.v[i] - v).powi(2);
                et += (p.theta[i] - t).powi(2);
            }
            println!(
                "{preset:?} n={n} v {:.5} T {:.5} wall {:+.3} drift {:.1e} {:.1e} steps {} {:.1} Mps/s {:.2}s {:?}",
                (ev / n as f64).sqrt(),
                (et / n as f64).sqrt(),
                (p.theta[0] - 1.5) / 0.5,
                s.ledger().energy_drift(),
                s.ledger().momentum_drift(),
                s.counters().steps,
                s.counters().particle_steps as f64 / secs / 1e6,
                secs,
                s.decided(),
            );
        }
    }
}
