//! Nonholonomic against kernel density: one step of the same scene, on the same contact list and on
//! the kernel's natural support. `whipple bench` measures the same as A/B pairs in one run.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use whipple_benches::{PARTICLES, contenders, solver};
use whipple_solver::method::Integrator;
use whipple_vv::cost::{Comparison, compare};

/// Rounds of the paired comparison.
const ROUNDS: usize = 10;

/// Criterion's view: time of a step, per particle.
fn step(c: &mut Criterion) {
    for (name, integrator) in
        [("single pass", Integrator::SinglePass), ("compatible", Integrator::Compatible)]
    {
        let mut group = c.benchmark_group(format!("step, {name}"));
        group.throughput(Throughput::Elements(PARTICLES as u64));
        group.sample_size(20);
        for (scheme, contender) in contenders() {
            let mut solver = solver(contender, integrator);
            group.bench_function(scheme, |b| {
                // The time of a step that is refused is none.
                b.iter(|| {
                    if let Err(error) = solver.step(f64::INFINITY) {
                        panic!("{scheme}: {error}");
                    }
                });
            });
        }
        group.finish();
    }
}

/// The paired view: ratios within one run, which a noisy machine cannot tilt.
#[allow(clippy::print_stdout)]
fn pairs(_: &mut Criterion) {
    let [(_, paper), rivals @ ..] = contenders();
    for (name, rival) in rivals {
        let found = compare([paper, rival], Integrator::SinglePass, PARTICLES, ROUNDS);
        match found {
            Ok(found) => println!("{}", line(name, &found)),
            Err(error) => println!("{name}: {error}"),
        }
    }
}

fn line(name: &str, found: &Comparison) -> String {
    let (low, high) = found.spread();
    format!(
        "A/B pairs: {name} / nonholonomic = {:.3} ({low:.3} .. {high:.3}); {:.1} against {:.1} ns per \
         particle-step, {:.1} against {:.1} ns per pair",
        found.median(),
        found.b.per_particle_step,
        found.a.per_particle_step,
        found.b.per_pair,
        found.a.per_pair,
    )
}

criterion_group!(benches, step, pairs);
criterion_main!(benches);
