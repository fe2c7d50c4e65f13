//! Scenes that cannot be simulated, and what is said of them.

use whipple_solver::method::{Heating, Integrator};
use whipple_solver::space::Simulation;
use whipple_solver::space::method::Release;
use whipple_solver::space::scene::{Scene, Shape};

use super::scenes::{mirror, rod};
use whipple_solver::space::scene::Side;

fn refused(change: impl FnOnce(&mut Scene)) -> String {
    let mut scene = rod(4, 8, [8, 4, 8]);
    assert_eq!(scene.validate(), Ok(()));
    change(&mut scene);
    let error = scene.validate().expect_err("a bad scene");
    assert_eq!(Simulation::new(&scene).err(), Some(error.clone()), "a simulation refuses it alike");
    error.to_string()
}

#[test]
fn bad_scenes_are_named() {
    let messages = [
        refused(|s| s.stop_time = f64::NAN),
        refused(|s| s.method.integrator = Integrator::SinglePass),
        refused(|s| s.method.heating = Heating::Printed),
        refused(|s| s.method.cfl = 0.0),
        refused(|s| s.method.cfl = 1.01),
        refused(|s| s.method.visc_quad = -1.0),
        refused(|s| s.method.visc_linear = 1e9),
        refused(|s| s.method.visc_hourglass = 1.5),
        refused(|s| s.method.centring = 20.0),
        refused(|s| s.method.balance = f64::NAN),
        refused(|s| s.method.contact_tolerance = 0.5),
        refused(|s| s.method.contact_reach = 1.4),
        refused(|s| s.method.release = Release::Crossings(0.0)),
        refused(|s| {
            s.walls.push(mirror(3, 0.0, Side::Above));
        }),
        refused(|s| s.materials[0].density = 0.0),
        refused(|s| s.materials[1].name = "tungsten".into()),
        refused(|s| s.materials[1].failure.spall = Some(-0.01)),
        refused(|s| {
            if let Some(strength) = &mut s.materials[0].strength {
                strength.shear_modulus = f64::INFINITY;
            }
        }),
        refused(|s| s.bodies.clear()),
        refused(|s| s.bodies[0].material = "unobtainium".into()),
        refused(|s| s.bodies[0].cells[1] = 0),
        refused(|s| s.bodies[0].turn.axis = [0.0; 3]),
        refused(|s| s.bodies[0].energy = -1.0),
        refused(|s| s.bodies[1].shape = Shape::Sphere { diameter: -1.0 }),
        refused(|s| {
            let lattice = whipple_solver::space::scene::Turn { axis: [0.0; 3], degrees: 30.0 };
            s.bodies[1].shape = Shape::Skewed { size: [1.0; 3], lattice };
        }),
        refused(|s| {
            s.bodies[1].shape = Shape::Ring { outer: 1.0, inner: 1.5, length: 1.0 };
        }),
        refused(|s| {
            s.bodies[1].shape = Shape::Ring { outer: 1.0, inner: 0.99, length: 1.0 };
        }),
        refused(|s| {
            s.bodies[1].shape = Shape::Cone { lower: 1.0, upper: -0.1, length: 1.0 };
        }),
        refused(|s| {
            let runs = vec![[0, 9, 0, 0]];
            s.bodies[1].shape = Shape::Filled { size: [1.0; 3], volume: 1.0, runs };
        }),
        refused(|s| s.bodies[1].cells = [8, 80, 8]),
        refused(|s| {
            s.bodies[1].cells = [800; 3];
            s.bodies[1].shape = Shape::Box { size: [80.0; 3] };
        }),
    ];
    insta::assert_snapshot!(messages.join("\n"));
}

/// A step that is less than a billionth of the run has collapsed before it began.
#[test]
fn steps_without_end_have_collapsed() {
    let mut scene = rod(4, 8, [8, 4, 8]);
    scene.stop_time = 1e9;
    let mut simulation = Simulation::new(&scene).expect("a scene");
    let error = simulation.step(1e9).expect_err("a billion steps");
    assert_eq!(error.kind(), "time step collapsed", "{error}");
    assert_eq!(simulation.time(), 0.0);
}
