//! Scenes that cannot be simulated, and what is said of them.

use whipple_solver::method::{Density, Preset};
use whipple_solver::scene::{
    Body, Boundary, EosData, Interface, MAX_PARTICLES, Material, Profile, Scene,
};

use crate::common::{FREE, PAPER_GAS, SOLID, body, scene};

/// A valid scene of two joined bodies of gas.
fn valid() -> Scene {
    let warm = |from, to| Body { energy: Profile::Uniform(1.0), ..body(from, to, 10) };
    scene(Preset::Default.method(), PAPER_GAS, FREE, vec![warm(0.0, 1.0), warm(1.0, 2.0)])
}

/// What validation says of the valid scene after a change.
fn refused(change: impl FnOnce(&mut Scene)) -> String {
    let mut scene = valid();
    change(&mut scene);
    let error = scene.validate().expect_err("a bad scene");
    assert_eq!(whipple_solver::build(&scene).err(), Some(error.clone()), "build refuses it alike");
    error.to_string()
}

fn gas(adiabatic_index: f64, c_v: f64, u_0: f64) -> EosData {
    EosData::IdealGas { adiabatic_index, c_v, u_0, theta_0: 1.0 }
}

fn other(name: &str, eos: EosData) -> Material {
    Material { name: name.into(), density: 1.0, eos }
}

/// The scene that the tables change is valid.
#[test]
fn unchanged_scene_is_valid() {
    assert_eq!(valid().validate(), Ok(()));
}

/// Method, materials and ends.
#[test]
fn bad_choices_are_named() {
    let nan = f64::NAN;
    let messages = [
        refused(|s| s.stop_time = 0.0),
        refused(|s| s.stop_time = f64::INFINITY),
        refused(|s| s.method.cfl = 0.0),
        refused(|s| s.method.cfl = nan),
        refused(|s| s.method.cfl = 1.5),
        refused(|s| s.method.limiter = 0.0),
        refused(|s| s.method.visc_linear = nan),
        refused(|s| s.method.visc_quad = -1.0),
        refused(|s| s.method.visc_expansion = f64::INFINITY),
        refused(|s| s.method.heat_coeff = -0.1),
        refused(|s| s.method.visc_linear = 1e9),
        refused(|s| {
            s.method.density = Density::Kernel;
            s.method.kernel_support = 5.0;
        }),
        refused(|s| s.materials[0].density = -1.0),
        refused(|s| s.materials[0].density = nan),
        refused(|s| s.materials[0].eos = gas(1.0, 1.0, 1.0)),
        refused(|s| s.materials[0].eos = gas(1.4, 0.0, 1.0)),
        refused(|s| s.materials[0].eos = gas(1.4, 1.0, -1.0)),
        refused(|s| s.materials[0].eos = EosData::Linear { bulk: 0.0, c_v: 1.0, theta_0: 0.0 }),
        refused(|s| s.materials.push(other("0", PAPER_GAS))),
        refused(|s| s.materials.push(other("steel", SOLID))),
        refused(|s| s.boundaries.left = Boundary::Mirror(0.5)),
        refused(|s| s.boundaries.right = Boundary::Mirror(nan)),
        refused(|s| s.boundaries.right = Boundary::Mirror(1.95)),
        refused(|s| s.boundaries.left = Boundary::Pressure(nan)),
    ];
    insta::assert_snapshot!(messages.join("\n"));
}

/// Bodies.
#[test]
fn bad_bodies_are_named() {
    let nan = f64::NAN;
    let messages = [
        refused(|s| s.bodies.clear()),
        refused(|s| s.bodies = vec![s.bodies[0].clone(); 65_536]),
        refused(|s| s.bodies[0].particles = 0),
        refused(|s| s.bodies[1].particles = 1),
        refused(|s| s.bodies[0].particles = MAX_PARTICLES),
        refused(|s| s.bodies[0].particles = usize::MAX),
        refused(|s| s.bodies[1].material = "unobtainium".into()),
        refused(|s| s.bodies[0].from = nan),
        refused(|s| s.bodies[1].to = f64::INFINITY),
        refused(|s| s.bodies[0].to = 0.0),
        refused(|s| s.bodies[0].compression = 0.0),
        refused(|s| s.bodies[0].velocity = Profile::Uniform(nan)),
        refused(|s| s.bodies[0].velocity = Profile::Linear { at_origin: 0.0, slope: nan }),
        refused(|s| {
            s.bodies[1].velocity = Profile::Cosine { mean: 0.0, amplitude: nan, mode: 1.0 }
        }),
        refused(|s| s.bodies[0].energy = Profile::Uniform(nan)),
        refused(|s| s.bodies[0].energy = Profile::Uniform(0.5)),
        refused(|s| s.bodies[0].energy = Profile::Linear { at_origin: 2.0, slope: -1.5 }),
        refused(|s| s.bodies[0].energy = Profile::Cosine { mean: 1.5, amplitude: 1.0, mode: 2.0 }),
        refused(|s| s.bodies[1].from = 0.9),
        refused(|s| s.bodies[1].from = 1.1),
    ];
    insta::assert_snapshot!(messages.join("\n"));
}

/// A gap is fine where bodies may part, and round-off in a computed face is forgiven.
#[test]
fn gaps_and_round_off_are_accepted() {
    let mut apart = valid();
    apart.bodies[1].from = 1.1;
    apart.bodies[1].interface = Interface::Contact;
    assert_eq!(apart.validate(), Ok(()));
    let mut rounded = valid();
    rounded.bodies[1].from = 1.0 - 1e-12;
    assert_eq!(rounded.validate(), Ok(()));
}
