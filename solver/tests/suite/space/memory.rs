//! Steps allocate only what grows.

use allocation_counter::measure;

use super::scenes::{after, block, march, rod, scene, start, steel};
use whipple_solver::space::scene::Body;

fn alone<T: Send>(f: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(f)
}

#[test]
fn a_body_alone_allocates_nothing() {
    let body = Body { spin: [0.0, 0.01, 0.02], ..block("steel", [24, 12, 16], 0.1) };
    let counted = alone(|| {
        let mut simulation = after(&scene(vec![steel()], vec![body]), 2);
        measure(|| march(&mut simulation, 20))
    });
    assert_eq!(counted.count_total, 0);
}

/// With contacts, a step allocates only where a list needs more room than ever, or elements die.
#[test]
fn contacts_allocate_only_room() {
    let (grew, died, idle) = alone(|| {
        let mut simulation = start(&rod(5, 20, [20, 5, 12]));
        march(&mut simulation, 10);
        let (mut grew, mut died, mut idle) = (0, 0, 0);
        for step in 0..100 {
            let (dead, bytes) = (simulation.failed().1, simulation.bytes());
            let counted = measure(|| march(&mut simulation, 1));
            let more = simulation.bytes() != bytes;
            let deaths = simulation.failed().1 > dead;
            if counted.count_total == 0 {
                idle += 1;
            } else if deaths {
                died += 1;
            } else {
                grew += 1;
                assert!(more, "step {step}: {} allocations", counted.count_total);
            }
        }
        (grew, died, idle)
    });
    println!("{idle} steps of 100 allocate nothing, {grew} for lists that grow, {died} for deaths");
    assert!(idle > 50);
}
