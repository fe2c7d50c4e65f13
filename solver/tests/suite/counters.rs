//! Work and memory, counted: sweeps, pairs, kernel evaluations, allocations, bytes.

use allocation_counter::measure;
use proptest::prelude::*;
use whipple_solver::method::{Density, Integrator, Method, Preset};
use whipple_solver::scene::{Body, Boundaries, Boundary, Scene};

use crate::common::{
    FREE, Mixture, WARM, any_chain, body, box_walls, cases, ends, scene, standing_wave, start,
    wall_shock, with_density,
};

/// Images kept behind a wall where only nearest neighbours act, and where more do.
const NEAR_IMAGES: usize = 2;
const FAR_IMAGES: usize = 16;

/// Warm gas whose neighbours beyond the nearest are in range.
const DENSE: Mixture = Mixture { speed: 1e-3, ..WARM };

/// A particle as a search by force sees it: position, contact length, initial compression.
#[derive(Clone, Copy)]
struct Seen {
    x: f64,
    l: f64,
    chi: f64,
}

/// The particles of a scene and their images: as many as there are particles behind one wall alone;
/// of two walls each shows the images of the other as well.
fn with_images(scene: &Scene, images: usize) -> Vec<Seen> {
    let of = |b: &Body, k: usize| {
        let l = b.compression * b.cell();
        Seen { x: b.particle(k).0, l, chi: b.compression }
    };
    let bodies = scene.bodies.iter();
    let mut chain: Vec<Seen> =
        bodies.flat_map(|b| (0..b.particles).map(move |k| of(b, k))).collect();
    let Boundaries { left, right } = scene.boundaries;
    let seen = |wall: f64, p: Seen| Seen { x: 2.0 * wall - p.x, ..p };
    let alone = chain.len();
    for k in 0..images {
        match (left, right) {
            (Boundary::Mirror(low), Boundary::Mirror(high)) => {
                // One image more on either side: the k-th particle from the wall lies 2 k further on.
                chain.insert(0, seen(low, chain[2 * k]));
                chain.push(seen(high, chain[chain.len() - 1 - 2 * k]));
            }
            (Boundary::Mirror(low), _) if k < alone => chain.insert(0, seen(low, chain[2 * k])),
            (_, Boundary::Mirror(high)) if k < alone => {
                chain.push(seen(high, chain[chain.len() - 1 - 2 * k]));
            }
            _ => {}
        }
    }
    chain
}

/// All pairs of `n`, the left one first.
fn all_pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |a| (a + 1..n).map(move |b| (a, b)))
}

/// Contact coordinate of a pair.
fn zeta(chain: &[Seen], a: usize, b: usize) -> f64 {
    (chain[b].x - chain[a].x).abs() / (0.5 * (chain[a].l + chain[b].l))
}

/// Pairs that a sweep visits: neighbours, and others closer than `support` contact lengths.
fn pairs_by_hand(chain: &[Seen], support: f64) -> u64 {
    let close = |&(a, b): &(usize, usize)| b == a + 1 || zeta(chain, a, b) < support;
    all_pairs(chain.len()).filter(close).count() as u64
}

/// Neighbours in reach of the kernel of every particle: one evaluation each, since the densities of
/// the start meet the constraint.
fn evaluations_by_hand(chain: &[Seen], support: f64) -> u64 {
    let within = |a: usize, b: usize| u64::from(chain[a].chi * zeta(chain, a, b) < support);
    all_pairs(chain.len()).map(|(a, b)| within(a, b) + within(b, a)).sum()
}

/// One sweep a stage for the paper's scheme and the hybrid, two with a kernel; two stages a step;
/// images are not counted as particles.
#[test]
fn sweeps_per_stage() {
    for density in Density::ALL {
        for integrator in [Integrator::SinglePass, Integrator::Compatible] {
            let method = Method { integrator, ..with_density(Preset::Default, density) };
            let mut solver = start(&standing_wave(method, 100, 0.1));
            let steps = 7;
            for _ in 0..steps {
                solver.step(f64::INFINITY).expect("a wave in a box runs");
            }
            let c = solver.counters();
            let sweeps = if density == Density::Kernel { 2 } else { 1 };
            let work = if integrator == Integrator::Compatible { steps } else { 0 };
            assert_eq!(c.steps, steps);
            assert_eq!(c.particle_steps, 100 * steps);
            assert_eq!(c.stages, 2 * steps);
            assert_eq!(c.sweeps, sweeps * c.stages, "{density:?} {integrator:?}");
            assert_eq!(c.work_sweeps, work);
            assert_eq!(c.kernel_evaluations > 0, density == Density::Kernel);
            // A chain with two images behind either wall has one pair less than members.
            if density != Density::Kernel {
                assert_eq!(c.pairs, c.stages * (100 + 2 * NEAR_IMAGES as u64 - 1));
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(64))]

    /// Pairs and kernel evaluations are those of a search through all pairs, on random chains with
    /// no, one or two walls, where one, three or no neighbours beyond the nearest are in range. The
    /// longest contact length is 7.4 and the shortest spacing 0.5, so that 16 images always reach.
    #[test]
    fn pairs_equal_those_found_by_force(
        chain in any_chain(DENSE, Preset::Paper.method()),
        density in prop::sample::select(Density::ALL.to_vec()),
        preset in prop::sample::select(Preset::ALL.to_vec()),
        squeeze in 0.5..3.5_f64,
        walls in any::<[bool; 2]>(),
    ) {
        let mut scene = chain;
        scene.method = with_density(preset, density);
        // Not 2, at which the next but one particle of a body is exactly at the edge.
        scene.method.kernel_support = 2.3;
        for b in &mut scene.bodies {
            b.compression *= squeeze;
        }
        let outermost = [scene.bodies[0].from, scene.bodies[scene.bodies.len() - 1].to];
        let [left, right] = [0, 1].map(|side| {
            if walls[side] { Boundary::Mirror(outermost[side]) } else { Boundary::Free }
        });
        scene.boundaries = ends(left, right);
        let support: f64 = if preset == Preset::Paper { 1.0 } else { 0.0 };
        let kernel = density == Density::Kernel;
        let images = if support > 0.0 || kernel { FAR_IMAGES } else { NEAR_IMAGES };
        let chain = with_images(&scene, images);

        let mut solver = start(&scene);
        // So short that nothing moves: both stages see the chain of the start.
        solver.step(1e-13).expect("a short step");
        let c = solver.counters();
        prop_assert_eq!(c.stages, 2);
        if kernel {
            let evaluations = evaluations_by_hand(&chain, scene.method.kernel_support);
            prop_assert_eq!(c.kernel_evaluations, 2 * evaluations);
            prop_assert!(c.pairs >= 2 * pairs_by_hand(&chain, support));
        } else {
            prop_assert_eq!(c.kernel_evaluations, 0);
            prop_assert_eq!(c.pairs, 2 * pairs_by_hand(&chain, support));
        }
    }
}

/// Scenes of every composition.
fn compositions(n: usize) -> Vec<Scene> {
    let mut scenes = Vec::new();
    for density in Density::ALL {
        for integrator in [Integrator::SinglePass, Integrator::Compatible] {
            for preset in Preset::ALL {
                let method = Method { integrator, ..with_density(preset, density) };
                scenes.push(wall_shock(method, n));
                let bar = body(0.0, 1.0, n);
                scenes.push(scene(method, crate::common::SOLID, box_walls(), vec![bar.clone()]));
                let loaded = ends(Boundary::Fixed, Boundary::Pressure(-1e-3));
                scenes.push(scene(method, crate::common::SOLID, loaded, vec![bar]));
            }
        }
    }
    scenes
}

/// No step allocates, whatever the composition: on one chunk, and on several of one thread.
#[test]
fn steps_allocate_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for (n, steps) in [(100, 50), (2500, 5)] {
        for scene in compositions(n) {
            let counted = pool.install(|| {
                let mut solver = start(&scene);
                measure(|| {
                    for _ in 0..steps {
                        solver.step(f64::INFINITY).expect("the scene runs");
                    }
                })
            });
            assert_eq!(counted.count_total, 0, "{:?} n = {n}", scene.method);
        }
    }
}

/// A million particles of the default gas take at most 120 bytes each, while it is built too.
#[test]
fn bytes_per_particle() {
    let n = 1_000_000_usize;
    let gas =
        scene(Preset::Default.method(), crate::common::IDEAL_GAS, FREE, vec![body(0.0, 1.0, n)]);
    let mut solver = None;
    let counted = measure(|| solver = Some(start(&gas)));
    let held = counted.bytes_current as f64 / n as f64;
    let peak = counted.bytes_max as f64 / n as f64;
    println!("bytes per particle: {held:.2} held, {peak:.2} at most");
    assert!(held > 48.0, "positions, velocities and energies, twice, are counted: {held}");
    assert!(peak <= 120.0, "{peak}");
    assert_eq!(solver.map(|s| s.particles()), Some(n));
}
