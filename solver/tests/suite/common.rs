//! Scenes, random chains and comparisons that the tests share.

use proptest::prelude::*;
use proptest::test_runner::Config;
use whipple_solver::Solver;
use whipple_solver::method::{Conduction, Density, Heating, Integrator, Method, Preset, Viscosity};
use whipple_solver::output::Snapshot;
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};
use whipple_solver::units::Units;

/// Ratio of specific heats of [`IDEAL_GAS`].
pub const GAMMA: f64 = 5.0 / 3.0;

/// The gas of the paper's Table 1, without its offset `u_o`.
pub const IDEAL_GAS: EosData =
    EosData::IdealGas { adiabatic_index: GAMMA, c_v: 1.0, u_0: 0.0, theta_0: 0.0 };

/// The gas of the paper's Table 1.
pub const PAPER_GAS: EosData =
    EosData::IdealGas { adiabatic_index: GAMMA, c_v: 1.0, u_0: 1.0, theta_0: 1.0 };

/// An elastic solid with unit wave speed at unit density.
pub const SOLID: EosData = EosData::Linear { bulk: 1.0, c_v: 1.0, theta_0: 0.0 };

/// Ends without anything.
pub const FREE: Boundaries = ends(Boundary::Free, Boundary::Free);

/// Both ends of a chain.
pub const fn ends(left: Boundary, right: Boundary) -> Boundaries {
    Boundaries { left, right }
}

/// Mirrors at 0 and 1.
pub fn box_walls() -> Boundaries {
    ends(Boundary::Mirror(0.0), Boundary::Mirror(1.0))
}

/// A body of unit density from `from` to `to`, at rest and cold, of the first material.
pub fn body(from: f64, to: f64, particles: usize) -> Body {
    Body {
        material: "0".into(),
        from,
        to,
        particles,
        layout: Layout::Centres,
        compression: 1.0,
        interface: Interface::Joined,
        velocity: Profile::Uniform(0.0),
        energy: Profile::Uniform(0.0),
    }
}

/// A scene of bodies of one material of unit density.
pub fn scene(method: Method, eos: EosData, boundaries: Boundaries, bodies: Vec<Body>) -> Scene {
    Scene {
        name: "test".into(),
        units: Units::None,
        stop_time: 1.0,
        method,
        boundaries,
        materials: vec![Material { name: "0".into(), density: 1.0, eos }],
        bodies,
    }
}

/// A box of gas from 0 to 1 with sound speed 1, whose velocity rises with the slope `amplitude` to
/// the middle and falls to the other wall.
pub fn standing_wave(method: Method, n: usize, amplitude: f64) -> Scene {
    let wave =
        Body { energy: Profile::Uniform(1.0 / (GAMMA * (GAMMA - 1.0))), ..body(0.0, 1.0, n) };
    // A roof: zero at both walls, `amplitude / 2` in the middle.
    let halves = |from: f64, to: f64, particles, at_origin, slope| Body {
        velocity: Profile::Linear { at_origin, slope },
        ..Body { from, to, particles, ..wave.clone() }
    };
    let bodies = vec![
        halves(0.0, 0.5, n / 2, 0.0, amplitude),
        halves(0.5, 1.0, n - n / 2, amplitude, -amplitude),
    ];
    scene(method, IDEAL_GAS, box_walls(), bodies)
}

/// Noh's wall shock with the gas of Table 1, fluid from 0 to 0.5.
pub fn wall_shock(method: Method, n: usize) -> Scene {
    let fluid = Body {
        velocity: Profile::Uniform(-1.0),
        energy: Profile::Uniform(1.0),
        ..body(0.0, 0.5, n)
    };
    scene(method, PAPER_GAS, ends(Boundary::Mirror(0.0), Boundary::Free), vec![fluid])
}

/// A preset with another density scheme.
pub fn with_density(preset: Preset, density: Density) -> Method {
    Method { density, ..preset.method() }
}

/// No viscosity and no conduction: motion without any production of entropy.
pub fn ideal(density: Density) -> Method {
    Method {
        density,
        visc_linear: 0.0,
        visc_quad: 0.0,
        visc_expansion: 0.0,
        conduction: Conduction::None,
        ..Preset::Default.method()
    }
}

/// The simulation of a scene that must be valid.
pub fn start(scene: &Scene) -> Box<dyn Solver> {
    whipple_solver::build(scene).expect("the scene of a test is valid")
}

/// The state of a scene after some steps, and the time that they took.
pub fn after_steps(scene: &Scene, steps: usize) -> Box<dyn Solver> {
    let mut solver = start(scene);
    for _ in 0..steps {
        solver.step(f64::INFINITY).expect("the scene of a test runs");
    }
    solver
}

/// The state of a scene at a time.
pub fn at_time(scene: &Scene, time: f64) -> Snapshot {
    let mut solver = start(scene);
    solver.advance_to(time).expect("the scene of a test runs");
    solver.snapshot()
}

/// All numbers of a snapshot, as bits.
pub fn bits(s: &Snapshot) -> Vec<u64> {
    [&s.x, &s.v, &s.rho, &s.pressure, &s.theta, &s.u, &s.m]
        .into_iter()
        .flatten()
        .chain([&s.time])
        .map(|value| value.to_bits())
        .collect()
}

/// Largest difference of two columns.
pub fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "columns of one length");
    // `max` would drop a NaN.
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, |worst, d| if d <= worst { worst } else { d })
}

/// Settings of a property test: so many cases, or as many as `PROPTEST_CASES` says; no file of old
/// failures, which the sources do not name.
pub fn cases(cases: u32) -> Config {
    let default = Config { failure_persistence: None, ..Config::default() };
    let asked = std::env::var_os("PROPTEST_CASES").is_some();
    if asked { default } else { Config { cases, ..default } }
}

/// Any choice of laws, with the compatible integrator.
pub fn any_method() -> impl Strategy<Value = Method> {
    let density = prop::sample::select(Density::ALL.to_vec());
    let heating = prop::sample::select(vec![Heating::Pair, Heating::Printed]);
    let viscosity = prop::sample::select(vec![Viscosity::Limited, Viscosity::Pairwise]);
    let conduction =
        prop::sample::select(vec![Conduction::None, Conduction::Linear, Conduction::Shock]);
    (density, heating, viscosity, conduction).prop_map(
        |(density, heating, viscosity, conduction)| Method {
            density,
            heating,
            viscosity,
            conduction,
            integrator: Integrator::Compatible,
            ..Preset::Default.method()
        },
    )
}

/// What a random chain may contain.
#[derive(Debug, Clone, Copy)]
pub struct Mixture {
    /// Equation of state of all its materials.
    pub eos: EosData,
    /// Largest speed.
    pub speed: f64,
    /// Range of the internal energy.
    pub energy: (f64, f64),
    /// Whether bodies may have gaps between them.
    pub gaps: bool,
}

/// Warm gas.
pub const WARM: Mixture = Mixture { eos: IDEAL_GAS, speed: 1.0, energy: (0.5, 2.0), gaps: false };

/// Elastic blocks, strained by some per cent.
pub const BLOCKS: Mixture = Mixture { eos: SOLID, speed: 0.05, energy: (0.0, 1.0), gaps: true };

/// Random bodies from left to right, each of its own density, spacing, speed and energy.
pub fn any_chain(mixture: Mixture, method: Method) -> impl Strategy<Value = Scene> {
    let Mixture { eos, speed, energy, gaps } = mixture;
    let strained = if gaps { 0.97..1.03 } else { 0.7..1.4 };
    let one = (
        (2_usize..6, 0.5..1.5_f64, 0.3..3.0_f64, strained),
        (-speed..speed, -speed..speed, energy.0..energy.1),
        (0.0..0.4_f64, any::<bool>()),
    );
    prop::collection::vec(one, 2..6).prop_map(move |rows| {
        let mut scene = scene(method, eos, FREE, Vec::new());
        scene.materials.clear();
        let mut from = -1.0;
        for (k, ((particles, spacing, density, compression), (v, dv, u), (gap, nodes))) in
            rows.into_iter().enumerate()
        {
            // A gap of less than a bit of a position would be an overlap.
            let gap = if gaps && k > 0 && gap > 1e-6 { gap * spacing } else { 0.0 };
            let to = from + gap + spacing * particles as f64;
            scene.materials.push(Material { name: k.to_string(), density, eos });
            scene.bodies.push(Body {
                material: k.to_string(),
                layout: if nodes && gaps { Layout::Nodes } else { Layout::Centres },
                compression,
                interface: if gap > 0.0 { Interface::Contact } else { Interface::Joined },
                velocity: Profile::Cosine { mean: v, amplitude: dv, mode: 3.0 },
                energy: Profile::Uniform(u),
                ..body(from + gap, to, particles)
            });
            from = to;
        }
        scene
    })
}
