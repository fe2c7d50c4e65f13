//! Phases of a step in three dimensions: the long rod in the middle of its impact. `whipple bench rod`
//! measures the same over a run.

use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use whipple_benches::{rod, rods};
use whipple_solver::space::Simulation;
use whipple_solver::space::phase::Phase;

/// Time that so many steps spend in a phase, or in all; each sample begins with the same state.
fn time_in(wanted: Option<Phase>, from: &Simulation, steps: u64) -> Duration {
    let mut simulation = from.clone();
    let mut spent = Duration::ZERO;
    for _ in 0..steps {
        let (mut at, mut since) = (None, Instant::now());
        let mut turn_to = |phase: Option<Phase>| {
            let now = Instant::now();
            if at.is_some() && (wanted.is_none() || at == wanted) {
                spent += now - since;
            }
            (at, since) = (phase, now);
        };
        let stepped = simulation.step_by_phases(f64::INFINITY, &mut |phase| turn_to(Some(phase)));
        turn_to(None);
        if let Err(error) = stepped {
            panic!("the rod goes on: {error}");
        }
    }
    spent
}

fn phases(c: &mut Criterion) {
    for (name, scheme, particles) in rods() {
        let simulation = rod(scheme, particles);
        let mut group = c.benchmark_group(format!("long rod, {name}"));
        group.throughput(Throughput::Elements(simulation.moving() as u64));
        group.sample_size(10);
        let all = Phase::ALL.into_iter().map(|phase| (phase.name(), Some(phase)));
        for (phase, wanted) in std::iter::once(("step", None)).chain(all) {
            // What a scene lacks takes no time.
            if wanted.is_some() && time_in(wanted, &simulation, 1).is_zero() {
                continue;
            }
            group.bench_function(phase, |b| {
                b.iter_custom(|steps| time_in(wanted, &simulation, steps));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, phases);
criterion_main!(benches);
