//! The same bits, whatever the number of threads and however often.

use whipple_solver::method::{Density, Preset};
use whipple_solver::scene::Scene;

use crate::common::{after_steps, bits, standing_wave, start, wall_shock, with_density};

/// Scenes of five chunks of particles, by what could order sums differently.
fn scenes() -> Vec<Scene> {
    let (default, paper) = (Preset::Default.method(), Preset::Paper.method());
    let kernel = with_density(Preset::Default, Density::Kernel);
    vec![
        wall_shock(default, 5000),
        wall_shock(paper, 5000),
        standing_wave(default, 5000, 0.3),
        standing_wave(paper, 5000, 0.3),
        standing_wave(kernel, 5000, 0.3),
    ]
}

/// 1, 2 and 8 threads, and a second run, give equal bits: fields, ledger and counters.
#[test]
fn threads_change_no_bit() {
    for scene in scenes() {
        let with = |threads| {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| {
                let solver = after_steps(&scene, 60);
                (bits(&solver.snapshot()), *solver.ledger(), solver.counters())
            })
        };
        let one = with(1);
        for threads in [1, 2, 8] {
            assert_eq!(one, with(threads), "{threads} threads, {:?}", scene.method);
        }
    }
}

/// Stepping to a time by hand is the same as asking for it.
#[test]
fn one_call_or_many_change_no_bit() {
    for preset in Preset::ALL {
        let scene = wall_shock(preset.method(), 60);
        let (mut whole, mut stepped) = (start(&scene), start(&scene));
        whole.advance_to(0.1).expect("the wall shock runs");
        while stepped.time() < 0.1 {
            stepped.step(0.1).expect("the wall shock runs");
        }
        assert_eq!(whole.time().to_bits(), 0.1_f64.to_bits(), "the time is reached exactly");
        assert_eq!(bits(&whole.snapshot()), bits(&stepped.snapshot()));
        assert_eq!(whole.counters(), stepped.counters());
        assert_eq!(whole.decided(), stepped.decided());
    }
}

/// At a time that is reached there is no step: not of length zero, and not back.
#[test]
fn a_time_that_is_reached_is_no_step() {
    for preset in Preset::ALL {
        let mut solver = start(&wall_shock(preset.method(), 60));
        for reached in [0.0, 0.05] {
            solver.advance_to(reached).expect("the wall shock runs");
            let before = (bits(&solver.snapshot()), *solver.ledger(), solver.counters());
            for until in [reached, 0.5 * reached, -1.0, f64::NEG_INFINITY] {
                solver.step(until).expect("nothing can fail");
                assert_eq!(solver.time().to_bits(), reached.to_bits());
            }
            assert_eq!(before, (bits(&solver.snapshot()), *solver.ledger(), solver.counters()));
        }
        solver.step(1.0).expect("it goes on");
        assert!(solver.time() > 0.05 && solver.snapshot().x.iter().all(|x| x.is_finite()));
    }
}
