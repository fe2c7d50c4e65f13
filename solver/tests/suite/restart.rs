//! A run in space that stops, is written down and continues gives the bits of one that never stopped.

use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::restart::{Section, Values};
use whipple_solver::space::scene::{
    Body, EosData, Failure, Flow, GammaLaw, Hold, Material, Scene, Shape, Side, Strength, Turn,
    Wall,
};
use whipple_solver::space::votes::Voter;
use whipple_solver::units::Units;

fn metal(name: &str, density: f64, c0: f64, shear_modulus: f64) -> Material {
    let law = GammaLaw::ConstantProduct;
    let hardening = Flow::Hardening {
        y_0: 0.0105,
        kappa: 2.0,
        alpha: 0.2,
        eta: 1.0,
        reference: 300.0,
        melt: 1700.0,
    };
    Material {
        name: name.into(),
        density,
        eos: EosData::MieGruneisen { c0, s: 1.3, gamma_0: 1.67, law, c_v: 0.3e-5, theta_0: 300.0 },
        strength: Some(Strength { shear_modulus, flow: Some(hardening) }),
        failure: Failure {
            plastic_strain: Some(0.3),
            melt: Some(1700.0),
            compression: 0.3,
            spall: None,
        },
    }
}

/// A short rod of 3 cells across that hits a plate, whose far half no wave reaches soon, and which
/// lies close to an anvil.
fn rod_on_plate(preset: Preset) -> Scene {
    let body = |name: &str, material: &str, shape, cells, centre, velocity| Body {
        name: name.into(),
        material: material.into(),
        shape,
        cells,
        centre,
        turn: Turn::default(),
        velocity,
        spin: [0.0; 3],
        energy: 0.0,
        noise: 0.0,
        mapping: None,
    };
    let rod = Shape::Cylinder { diameter: 0.3, length: 0.6 };
    let plate = Shape::Box { size: [3.0, 3.2, 0.2] };
    Scene {
        name: "rod on plate".into(),
        units: Units::CmGUsMbar,
        stop_time: 10.0,
        method: preset.space(),
        walls: vec![Wall { axis: 2, position: -0.201, material: Side::Above, hold: Hold::Rest }],
        materials: vec![metal("tungsten", 17.6, 0.403, 1.45), metal("steel", 7.87, 0.458, 0.801)],
        bodies: vec![
            body("rod", "tungsten", rod, [3, 3, 7], [-1.2, -0.8, 0.32], [0.0, 0.1, -0.4]),
            body("plate", "steel", plate, [30, 32, 2], [0.0, 0.0, -0.1], [0.0; 3]),
        ],
    }
}

fn new(scene: &Scene) -> Simulation {
    Simulation::new(scene).expect("the scene of a test is valid")
}

fn go(simulation: &mut Simulation, steps: usize) {
    for _ in 0..steps {
        simulation.step(f64::INFINITY).expect("the scene of a test runs");
    }
}

/// All sections, as bits.
fn bits(simulation: &Simulation) -> Vec<(String, Vec<u64>)> {
    let whole = |values: &Values| match values {
        Values::F64(v) => v.iter().map(|x| x.to_bits()).collect(),
        Values::U64(v) => v.clone(),
        Values::U32(v) => v.iter().map(|&x| u64::from(x)).collect(),
        Values::U8(v) => v.iter().map(|&x| u64::from(x)).collect(),
    };
    simulation.sections().into_iter().map(|s| (s.name, whole(&s.values))).collect()
}

fn assert_equal(one: &Simulation, other: &Simulation, when: &str) {
    for ((name, one), (_, other)) in bits(one).into_iter().zip(bits(other)) {
        let at = one.iter().zip(&other).position(|(a, b)| a != b);
        assert_eq!(at, None, "{when}: section `{name}`");
    }
    assert_eq!(one.balance(), other.balance(), "{when}");
    assert_eq!(one.votes(), other.votes(), "{when}");
    assert_eq!(one.counters(), other.counters(), "{when}");
    assert!(one.all_particles().eq(other.all_particles()), "{when}");
    assert!(one.all_elements().eq(other.all_elements()), "{when}");
}

fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(work)
}

/// run(2N) equals run(N), export, import, run(N), with every step between compared as well, and
/// with elements that die on both sides of the restart.
#[test]
fn a_restart_changes_no_bit() {
    for preset in Preset::ALL {
        let scene = rod_on_plate(preset);
        for threads in [1, 2] {
            on(threads, || {
                let mut whole = new(&scene);
                go(&mut whole, 60);
                let mut rest = new(&scene);
                rest.restore(&whole.sections()).expect("sections of the same scene");
                let dead = whole.failed().1;
                for step in 60..120 {
                    assert_equal(&whole, &rest, &format!("{preset:?}, {threads}, step {step}"));
                    go(&mut whole, 1);
                    go(&mut rest, 1);
                }
                assert_equal(&whole, &rest, "end");
                assert!(dead > 0 && whole.failed().1 > dead, "{dead}, {:?}", whole.failed());
                let awake = whole.counters().particle_steps / whole.counters().steps;
                assert!(awake < whole.particles() as u64, "some material is still at rest");
            });
        }
    }
}

/// A restart at any step, be the list of pairs stale or not.
#[test]
fn a_restart_at_any_step_changes_no_bit() {
    let scene = rod_on_plate(Preset::Default);
    let mut whole = new(&scene);
    let mut followers: Vec<Simulation> = Vec::new();
    for step in 0..60 {
        if step % 6 == 0 {
            let mut follower = new(&scene);
            follower.restore(&whole.sections()).expect("sections of the same scene");
            followers.push(follower);
        }
        go(&mut whole, 1);
        followers.iter_mut().for_each(|follower| go(follower, 1));
    }
    for (k, follower) in followers.iter().enumerate() {
        assert_equal(&whole, follower, &format!("from step {}", 6 * k));
    }
}

/// What does not fit is refused by name, and changes nothing.
#[test]
fn sections_that_do_not_fit_are_refused() {
    let scene = rod_on_plate(Preset::Default);
    let mut simulation = new(&scene);
    go(&mut simulation, 10);
    let good = simulation.sections();
    let mut fresh = new(&scene);
    let before = bits(&fresh);
    let mut refusal = |change: &dyn Fn(&mut Vec<Section>)| {
        let mut sections = good.clone();
        change(&mut sections);
        let error = fresh.restore(&sections).expect_err("sections that do not fit");
        assert_eq!(bits(&fresh), before, "a refusal changes nothing");
        error.to_string()
    };
    let at = |name: &str| good.iter().position(|s| s.name == name).expect("a section");
    let said = refusal(&|s| s.truncate(3));
    assert!(said.starts_with("section `state.vx` holds nothing"), "{said}");
    let said = refusal(&|s| s[0].values = Values::U8(vec![1]));
    assert!(said.starts_with("section `state.dx` holds 1 of u8, wanted"), "{said}");
    let said = refusal(&|s| s.swap(0, 1));
    assert!(said.starts_with("section `state.dx` holds state.dy"), "{said}");
    let said = refusal(&|s| s.push(Section { name: "more".into(), values: Values::U8(vec![]) }));
    assert!(said.starts_with("section `more` holds 0 of u8, wanted no such"), "{said}");
    let said = refusal(&|s| {
        if let Values::U32(index) = &mut s[at("contact.member")].values {
            let members: Vec<usize> = (0..index.len()).filter(|&i| index[i] != u32::MAX).collect();
            index[members[3]] = index[members[5]];
        }
    });
    assert!(said.starts_with("section `contact.member` holds"), "{said}");
    for name in ["group.live", "group.awake", "contact.flags", "piece.active"] {
        let said = refusal(&|s| {
            if let Values::U8(flags) = &mut s[at(name)].values {
                flags.fill(u8::MAX);
            }
        });
        assert!(said.starts_with(&format!("section `{name}` holds 255")), "{said}");
    }
    for (which, wanted) in [(10, "the number of a particle"), (11, "the number of a voter")] {
        let said = refusal(&|s| {
            if let Values::U64(counts) = &mut s[at("run.counts")].values {
                counts[which] = 1 << 40;
            }
        });
        assert!(said.starts_with("section `run.counts` holds 1099511627776"), "{said}");
        assert!(said.contains(wanted), "{said}");
    }
}

/// A run that has landed more often than it has particles.
#[test]
fn many_landings_are_no_particle() {
    let mut scene = rod_on_plate(Preset::Default);
    scene.bodies.truncate(1);
    let mut simulation = new(&scene);
    let many = simulation.particles() + 100;
    for landing in 1..=many {
        simulation.advance_to(1e-4 * landing as f64).expect("the scene of a test runs");
    }
    assert!(simulation.votes().decided[Voter::Landing as usize] > simulation.particles() as u64);
    let mut other = new(&scene);
    other.restore(&simulation.sections()).expect("sections of its own");
    assert_equal(&simulation, &other, "after many landings");
}
