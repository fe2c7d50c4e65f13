//! Properties of every scene: balances, invariances and the second law, on random chains.

use proptest::prelude::*;
use whipple_solver::Solver;
use whipple_solver::method::{Conduction, Density, Integrator, Method, Preset};
use whipple_solver::output::Snapshot;
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Profile, Scene,
};
use whipple_solver::viscosity::unexplained;

use crate::common::{
    BLOCKS, FREE, GAMMA, IDEAL_GAS, Mixture, WARM, after_steps, any_chain, any_method, apart,
    at_time, body, cases, ends, ideal, scene, standing_wave, start, wall_shock, with_density,
};

/// Error of the energy balance over all the energy that there is.
fn energy_error(solver: &dyn Solver) -> f64 {
    let ledger = solver.ledger();
    let scale = ledger.initial.kinetic + ledger.initial.internal.abs() + ledger.largest_work;
    ledger.worst_energy / scale
}

/// A random chain with random laws.
fn any_scene(mixture: Mixture) -> impl Strategy<Value = Scene> {
    any_method().prop_flat_map(move |method| any_chain(mixture, method))
}

/// A random chain of gas or of blocks.
fn gas_or_blocks() -> impl Strategy<Value = Scene> {
    prop_oneof![any_scene(WARM), any_scene(BLOCKS)]
}

/// A free, held or loaded end.
fn any_end() -> impl Strategy<Value = Boundary> {
    prop_oneof![
        Just(Boundary::Free),
        Just(Boundary::Fixed),
        (-0.02..1.0_f64).prop_map(Boundary::Pressure),
    ]
}

proptest! {
    #![proptest_config(cases(96))]

    /// The work of every pair force is the energy that the pair stores: total energy, boundary
    /// work and strain included, is kept to round-off for every density scheme and every law.
    #[test]
    fn work_of_the_forces_is_what_the_densities_store(
        scene in gas_or_blocks(), left in any_end(), right in any_end(),
    ) {
        let mut scene = scene;
        scene.boundaries = ends(left, right);
        if matches!(left, Boundary::Fixed) || matches!(right, Boundary::Fixed) {
            for b in &mut scene.bodies {
                b.velocity = Profile::Uniform(0.0);
            }
        }
        let mut solver = start(&scene);
        for _ in 0..24 {
            // A scene may be too violent for its laws, and ends the test then.
            if solver.step(f64::INFINITY).is_err() {
                break;
            }
        }
        // Each of 24 steps rounds a sum of at most 25 particles.
        prop_assert!(energy_error(solver.as_ref()) < 1e-13, "{:e}", energy_error(solver.as_ref()));
    }

    /// The same for one evaluation of the rates, without the compatible integrator's help: what
    /// one step of the midpoint rule misses falls at least with the square of the step. A contact or a
    /// limiter that switches within the first step that is long enough spoils that comparison, and no
    /// shorter one.
    #[test]
    fn powers_balance_at_every_instant(scene in gas_or_blocks()) {
        let mut scene = scene;
        scene.method.integrator = Integrator::SinglePass;
        let missed = |dt: f64| {
            let mut solver = start(&scene);
            solver.step(dt).map(|()| (solver.time(), energy_error(solver.as_ref())))
        };
        let (Ok((t, coarse)), Ok((_, fine)), Ok((_, finest))) =
            (missed(1e-2), missed(1e-3), missed(1e-4))
        else {
            return Ok(());
        };
        prop_assume!(t == 1e-2);
        let falls = |from: f64, to: f64| to < from / 30.0 + 1e-14;
        prop_assert!(falls(coarse, fine) || falls(fine, finest), "{coarse:e} {fine:e} {finest:e}");
    }

    /// Pair forces are opposite and equal: momentum of a free chain is kept to round-off.
    #[test]
    fn momentum_of_a_free_chain_is_kept(
        scene in gas_or_blocks(), single in any::<bool>(),
    ) {
        let mut scene = scene;
        if single {
            scene.method.integrator = Integrator::SinglePass;
        }
        let mut solver = start(&scene);
        while solver.counters().steps < 24 && solver.step(f64::INFINITY).is_ok() {}
        prop_assert!(solver.ledger().momentum_drift() < 1e-13, "{:e}", solver.ledger().momentum_drift());
    }

    /// An observer who moves sees the same: the default choices know nothing of the frame.
    #[test]
    fn default_is_galilean_invariant(
        scene in prop_oneof![
            any_chain(WARM, Preset::Default.method()),
            any_chain(BLOCKS, Preset::Default.method()),
        ],
        boost in -100.0..100.0_f64,
        steps in prop::sample::select(vec![1_u32, 30]),
    ) {
        let mut moving = scene.clone();
        for b in &mut moving.bodies {
            if let Profile::Cosine { mean, .. } = &mut b.velocity {
                *mean += boost;
            }
        }
        let [still, moving] = in_step(&[scene, moving], steps);
        let time = still.time;
        let still_x: Vec<f64> = still.x.iter().map(|x| x + boost * time).collect();
        let still_v: Vec<f64> = still.v.iter().map(|v| v + boost).collect();
        // Positions up to 1e3 are rounded at 1e-13, forces feel that over a spacing.
        prop_assert!(apart(&moving.x, &still_x) < 1e-9);
        prop_assert!(apart(&moving.v, &still_v) < 1e-9);
        prop_assert!(apart(&moving.u, &still.u) < 1e-9);
        prop_assert!(apart(&moving.rho, &still.rho) < 1e-9);
    }

    /// A scene seen in a mirror gives the answer seen in a mirror, for every law.
    #[test]
    fn left_and_right_are_alike(scene in gas_or_blocks(), left in any_end(), right in any_end()) {
        let mut scene = scene;
        scene.boundaries = ends(left, right);
        let mirrored = reflected(&scene);
        let [seen, mirrored] = in_step(&[scene, mirrored], 12);
        let turned = |column: &[f64], sign: f64| -> Vec<f64> {
            column.iter().rev().map(|value| sign * value).collect()
        };
        // Sums are taken in the other order: round-off.
        prop_assert!(apart(&mirrored.x, &turned(&seen.x, -1.0)) < 1e-10);
        prop_assert!(apart(&mirrored.v, &turned(&seen.v, -1.0)) < 1e-10);
        prop_assert!(apart(&mirrored.u, &turned(&seen.u, 1.0)) < 1e-10);
        prop_assert!(apart(&mirrored.rho, &turned(&seen.rho, 1.0)) < 1e-10);
    }

    /// Without viscosity and conduction a gas keeps the entropy of every particle, so that the
    /// force is the derivative of the density: for the kernel, its gradient that of its weight.
    #[test]
    fn ideal_motion_keeps_entropy(
        density in prop::sample::select(Density::ALL.to_vec()),
        chain in any_chain(WARM, ideal(Density::Hybrid)),
    ) {
        let mut scene = chain;
        let mut worst = |cfl, steps| {
            scene.method = Method { cfl, ..ideal(density) };
            let (before, after) = (start(&scene), after_steps(&scene, steps));
            let (before, after) = (entropies(before.as_ref(), density), entropies(after.as_ref(), density));
            before.iter().zip(&after).map(|(a, b)| (b / a - 1.0).abs()).fold(0.0, f64::max)
        };
        // What the integrator misses is of second order in the time step.
        let (coarse, fine) = (worst(0.02, 40), worst(0.01, 80));
        prop_assert!(coarse < 2e-3 && fine < coarse / 3.0 + 1e-9, "{density:?}: {coarse:e} {fine:e}");
    }

    /// Viscosity heats and never cools: the entropy of no particle falls, and at first it rises by half
    /// of what the viscous forces of its pairs take from motion,
    /// `d ln(u / rho^(gamma - 1)) = sum nu j d dt / (2 m u)`. That may be nothing: a jump `d` that its
    /// neighbours explain leaves no `j`.
    #[test]
    fn viscosity_produces_entropy(chain in any_chain(WARM, Preset::Default.method())) {
        let mut scene = chain;
        scene.method.conduction = Conduction::None;
        scene.method.cfl = 1e-4;
        let mut solver = start(&scene);
        let first = entropies(solver.as_ref(), Density::Hybrid);
        let rates = entropy_rates(&scene, &solver.snapshot());
        solver.step(f64::INFINITY).expect("warm gas runs");
        let dt = solver.time();
        let most = rates.iter().fold(0.0, |most: f64, rate| most.max(rate * dt));
        for ((now, then), rate) in
            entropies(solver.as_ref(), Density::Hybrid).iter().zip(&first).zip(&rates)
        {
            let (gain, wanted) = (now / then - 1.0, rate * dt);
            // What the step itself changes is of second order.
            prop_assert!((gain - wanted).abs() < 1e-3 * most + 1e-8, "{gain:e} {wanted:e} {most:e}");
        }

        scene.method.cfl = 0.005;
        let mut solver = start(&scene);
        let mut before = first;
        for _ in 0..120 {
            solver.step(f64::INFINITY).expect("warm gas runs");
            let now = entropies(solver.as_ref(), Density::Hybrid);
            for (a, b) in before.iter().zip(&now) {
                prop_assert!(b / a > 1.0 - 2e-6, "{a:e} {b:e}");
            }
            before = now;
        }
    }
}

/// Closing jumps of 0.6, 0.62 and 0.16, as a random chain once had them, explain each other: all pairs
/// close and no entropy is produced.
#[test]
fn jumps_that_explain_each_other_produce_nothing() {
    let streams = [(-1.0, 0.0, 0.9954, -0.423), (0.0, 1.0, 0.0, -0.112)];
    let bodies = streams.map(|(from, to, mean, amplitude)| Body {
        velocity: Profile::Cosine { mean, amplitude, mode: 3.0 },
        energy: Profile::Uniform(0.5),
        ..body(from, to, 2)
    });
    let method = Method { conduction: Conduction::None, cfl: 0.005, ..Preset::Default.method() };
    let mut solver = start(&scene(method, IDEAL_GAS, FREE, bodies.to_vec()));
    let first = solver.snapshot();
    assert!(first.v.windows(2).all(|v| v[0] - v[1] > 0.1), "{:?}", first.v);
    let before = entropies(solver.as_ref(), Density::Hybrid);
    for _ in 0..60 {
        solver.step(f64::INFINITY).expect("warm gas runs");
    }
    let worst = apart(&entropies(solver.as_ref(), Density::Hybrid), &before);
    assert!(worst < 1e-5 * before[0], "{worst:e}");
}

/// Rates of the logarithm of the entropy of every particle by the viscosity of decision 0006, for a
/// chain of joined bodies of gas.
fn entropy_rates(scene: &Scene, s: &Snapshot) -> Vec<f64> {
    let of = |b: &Body| {
        let material = scene.materials.iter().find(|m| m.name == b.material).expect("a material");
        std::iter::repeat_n((b.compression * b.cell(), material.density), b.particles)
    };
    let kinds: Vec<(f64, f64)> = scene.bodies.iter().flat_map(of).collect();
    let n = kinds.len();
    let jump = |k: usize| s.v[k] - s.v[k + 1];
    let sound = |k: usize| (GAMMA * (GAMMA - 1.0) * s.u[k]).sqrt();
    let method = &scene.method;
    let mut rates = vec![0.0; n];
    for k in 0..n - 1 {
        let own = jump(k);
        // Beyond an end the velocity goes on as before it.
        let before = if k > 0 { jump(k - 1) } else { own };
        let after = if k + 2 < n { jump(k + 1) } else { own };
        let seen = unexplained([before, own, after], method.limiter);
        let zeta = (s.x[k + 1] - s.x[k]) / (0.5 * (kinds[k].0 + kinds[k + 1].0));
        let rho = 0.5 * (kinds[k].1 + kinds[k + 1].1) / zeta;
        let c = sound(k).min(sound(k + 1));
        let b = method.visc_quad * 0.25 * (GAMMA + 1.0) * seen;
        let nu = rho
            * if seen > 0.0 {
                b + b.hypot(method.visc_linear * c)
            } else {
                method.visc_expansion * c
            };
        for i in [k, k + 1] {
            rates[i] += 0.5 * nu * seen * own / (s.m[i] * s.u[i]);
        }
    }
    rates
}

/// States of scenes after steps of one and the same size, half of what the first may take: which
/// step a scene would take by itself is decided by the last digit.
fn in_step(scenes: &[Scene; 2], steps: u32) -> [Snapshot; 2] {
    let dt = 0.5 * after_steps(&scenes[0], 1).time();
    scenes.each_ref().map(|scene| {
        let mut solver = start(scene);
        for k in 1..=steps {
            // A scene too violent for its laws ends at the same step in both.
            if solver.advance_to(dt * f64::from(k)).is_err() {
                break;
            }
        }
        solver.snapshot()
    })
}

/// The scene seen in a mirror at x = 0.
fn reflected(scene: &Scene) -> Scene {
    let mut out = scene.clone();
    let Boundaries { left, right } = scene.boundaries;
    out.boundaries = ends(right, left);
    out.bodies.reverse();
    let interfaces: Vec<Interface> =
        scene.bodies.iter().skip(1).rev().map(|b| b.interface).collect();
    for (k, b) in out.bodies.iter_mut().enumerate() {
        (b.from, b.to) = (-b.to, -b.from);
        b.interface = if k == 0 { Interface::Joined } else { interfaces[k - 1] };
        // An odd number of half waves is odd about the middle.
        if let Profile::Cosine { mean, .. } = &mut b.velocity {
            *mean = -*mean;
        }
    }
    out
}

/// `u / rho^(gamma - 1)` of every particle, with the density that its scheme gives it: the product
/// of two half segments for the hybrid, whose segments have one each.
fn entropies(solver: &dyn Solver, density: Density) -> Vec<f64> {
    let s = solver.snapshot();
    let length = |i: usize| (s.x[i + 1] - s.x[i]).powf(0.5 * (GAMMA - 1.0));
    (0..s.x.len())
        .map(|i| match density {
            Density::Hybrid => {
                let left = if i > 0 { length(i - 1) } else { 1.0 };
                let right = if i + 1 < s.x.len() { length(i) } else { 1.0 };
                s.u[i] * left * right
            }
            _ => s.u[i] / s.rho[i].powf(GAMMA - 1.0),
        })
        .collect()
}

/// A scene at another velocity scale: velocities times `scale`, energies times its square.
fn rescaled(scene: &Scene, scale: f64) -> Scene {
    let by = |profile: Profile, factor: f64| match profile {
        Profile::Uniform(value) => Profile::Uniform(factor * value),
        Profile::Linear { at_origin, slope } => {
            Profile::Linear { at_origin: factor * at_origin, slope: factor * slope }
        }
        Profile::Cosine { mean, amplitude, mode } => {
            Profile::Cosine { mean: factor * mean, amplitude: factor * amplitude, mode }
        }
    };
    let mut out = scene.clone();
    out.stop_time /= scale;
    for b in &mut out.bodies {
        b.velocity = by(b.velocity, scale);
        b.energy = by(b.energy, scale * scale);
    }
    out
}

/// A shock off a wall and a shock tube of cold and warm gas.
fn scale_free() -> [Scene; 2] {
    let cold = |from, to, n, u| Body { energy: Profile::Uniform(u), ..body(from, to, n) };
    let streaming = Body { velocity: Profile::Uniform(-1.0), ..cold(0.0, 0.5, 60, 0.0) };
    let shock = scene(
        Preset::Default.method(),
        IDEAL_GAS,
        ends(Boundary::Mirror(0.0), Boundary::Free),
        vec![streaming],
    );
    let tube = vec![cold(0.0, 0.5, 30, 2.5), cold(0.5, 1.0, 30, 0.1)];
    [shock, scene(Preset::Default.method(), IDEAL_GAS, FREE, tube)]
}

/// A gas without `u_o` has no velocity scale: neither has the default preset. Factors of 2 change
/// no bit of the answer, other factors nothing but its round-off.
#[test]
fn default_has_no_velocity_scale() {
    for scene in scale_free() {
        let base = at_time(&scene, 0.2);
        for power in [-20, 20] {
            let scale = 2.0_f64.powi(power);
            let other = at_time(&rescaled(&scene, scale), 0.2 / scale);
            let back: Vec<u64> = other.v.iter().map(|v| (v / scale).to_bits()).collect();
            assert_eq!(back, base.v.iter().map(|v| v.to_bits()).collect::<Vec<_>>());
        }
        for scale in [1e-6, 1e-3, 1e3, 1e6] {
            let other = at_time(&rescaled(&scene, scale), 0.2 / scale);
            let v: Vec<f64> = other.v.iter().map(|v| v / scale).collect();
            let u: Vec<f64> = other.u.iter().map(|u| u / (scale * scale)).collect();
            assert!(apart(&v, &base.v) < 1e-8, "{scale:e}: {:e}", apart(&v, &base.v));
            assert!(apart(&u, &base.u) < 1e-8, "{scale:e}: {:e}", apart(&u, &base.u));
            assert!(apart(&other.rho, &base.rho) < 1e-8);
        }
    }
}

/// Heat flows from hot to cold: over a chain at rest, extremes of the temperature draw together
/// and the sum of the heat stays.
#[test]
fn heat_flows_from_hot_to_cold() {
    let method =
        Method { conduction: Conduction::Linear, heat_coeff: 0.2, ..Preset::Default.method() };
    let eos = EosData::Linear { bulk: 1.0, c_v: 2.0, theta_0: 1.0 };
    let bar = Body {
        compression: 1.05,
        energy: Profile::Cosine { mean: 1.0, amplitude: 0.7, mode: 3.0 },
        ..body(0.0, 1.0, 40)
    };
    let boundaries = ends(Boundary::Mirror(0.0), Boundary::Mirror(1.0));
    let mut solver = start(&scene(method, eos, boundaries, vec![bar]));
    let extremes = |solver: &dyn Solver| {
        let theta = solver.snapshot().theta;
        theta.iter().fold((f64::MAX, f64::MIN), |(l, h), &t| (l.min(t), h.max(t)))
    };
    let mut before = extremes(solver.as_ref());
    let initial = before;
    for _ in 0..200 {
        solver.step(f64::INFINITY).expect("heat spreads without trouble");
        let now = extremes(solver.as_ref());
        assert!(now.0 >= before.0 && now.1 <= before.1, "{before:?} {now:?}");
        before = now;
    }
    assert!(before.1 - before.0 < 0.9 * (initial.1 - initial.0), "{before:?}");
    assert!(energy_error(solver.as_ref()) < 1e-13);
}

/// Both integrators are of second order: half the step, a quarter of the error.
#[test]
fn time_integration_has_second_order() {
    for integrator in [Integrator::SinglePass, Integrator::Compatible] {
        for density in Density::ALL {
            let at = |cfl| {
                let method = Method { cfl, integrator, ..ideal(density) };
                at_time(&standing_wave(method, 20, 0.1), 0.3)
            };
            let (coarse, middle, fine) = (at(0.2), at(0.1), at(0.05));
            let ratio = apart(&coarse.x, &middle.x) / apart(&middle.x, &fine.x);
            assert!((3.4..4.7).contains(&ratio), "{integrator:?} {density:?}: {ratio}");
        }
    }
}

/// A uniform gas between walls under its own pressure stays at rest for every scheme.
#[test]
fn uniform_gas_stays_at_rest() {
    for preset in Preset::ALL {
        for density in Density::ALL {
            for compression in [0.8, 1.0, 1.3] {
                let gas = Body { compression, energy: Profile::Uniform(2.0), ..body(0.0, 1.0, 40) };
                let walls = ends(Boundary::Mirror(0.0), Boundary::Mirror(1.0));
                let scene = scene(with_density(preset, density), IDEAL_GAS, walls, vec![gas]);
                let s = after_steps(&scene, 50).snapshot();
                assert!(
                    s.v.iter().all(|v| v.abs() < 1e-12),
                    "{preset:?} {density:?} {compression}"
                );
            }
        }
    }
}

/// A mirror wall is the symmetry plane of two equal streams.
#[test]
fn mirror_is_a_plane_of_symmetry() {
    // Pairs of the paper's preset switch at zeta = 1: the gas starts a little closer than that, and
    // stops before a fourth neighbour comes so close.
    for (preset, time) in [(Preset::Paper, 0.02), (Preset::Default, 0.2)] {
        let mut half = wall_shock(preset.method(), 40);
        half.bodies[0].compression = 1.05;
        let mut whole = half.clone();
        whole.boundaries = FREE;
        let right = half.bodies[0].clone();
        let left = Body {
            from: -0.5,
            to: 0.0,
            velocity: Profile::Uniform(1.0),
            layout: Layout::Centres,
            ..right.clone()
        };
        whole.bodies = vec![left, right];
        let (half, whole) = (at_time(&half, time), at_time(&whole, time));
        let worst = apart(&half.v, &whole.v[40..]);
        assert!(worst < 1e-9, "{preset:?}: {worst:e}");
        assert!(apart(&half.theta, &whole.theta[40..]) < 1e-9, "{preset:?}");
    }
}

/// Three particles between walls, squeezed so that contacts reach beyond the images of all of them, move
/// as they do among their images written out as particles.
#[test]
fn two_walls_mirror_each_other() {
    // Each body grows about its middle: so does its image.
    let growing = |k: u8| Body {
        compression: 4.0,
        energy: Profile::Uniform(1.0),
        velocity: Profile::Linear { at_origin: -0.2 * (f64::from(k) + 0.5), slope: 0.2 },
        ..body(f64::from(k), f64::from(k) + 1.0, 3)
    };
    let few = vec![growing(0)];
    let many: Vec<Body> = (0..4).map(growing).collect();
    let between = |high, bodies| {
        let walls = ends(Boundary::Mirror(0.0), Boundary::Mirror(high));
        scene(Preset::Paper.method(), IDEAL_GAS, walls, bodies)
    };
    let [few, many] = in_step(&[between(1.0, few), between(4.0, many)], 10);
    assert!(few.time > 0.0);
    assert!(apart(&few.x, &many.x[..3]) < 1e-12 && apart(&few.v, &many.v[..3]) < 1e-12);
    assert!(apart(&few.rho, &many.rho[..3]) < 1e-12 && apart(&few.u, &many.u[..3]) < 1e-12);
}
