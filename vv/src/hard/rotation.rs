//! Large rotations: of elements, of beams, and of ellipsoids on their own.

use std::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};
use whipple_solver::space::scene::Body;
use whipple_solver::space::spin::Rigid;
use whipple_solver::space::{Simulation, lattice};

use super::measure::{largest, minus};
use super::scenes::{DISPLACEMENT, STEEL, advance, begin, bricks, march, scene};
use super::sheet::{Bound, Sheet, Trouble};

/// H16: elements turned as far as they may be, and a beam that spins.
pub(super) fn large(sheet: &mut Sheet) {
    let [density, c0, ..] = STEEL.constants;
    let bulk = density * c0 * c0;
    sheet.part("elements turned by eight angles up to 10 000 turns", |sheet| {
        let mut worst = 0.0f64;
        for k in 0..8 {
            // Elements know where their particles are, not how often they have been round.
            let angle = (10_000.0 * TAU) * f64::from(k + 1) / 8.0 + 0.7 * f64::from(k);
            worst = worst.max(turned(sheet, angle)? / bulk);
        }
        sheet.at_most("stress over the bulk modulus", worst, 1e-8);
        Ok(())
    });
    for (name, edges) in [("cubes", [0.1, 0.1, 0.1]), ("bricks", [0.2, 0.1, 0.07])] {
        sheet.part(format!("elastic beam of {name}, 10 turns"), |sheet| {
            let spin = 0.02;
            let turns = sheet.size(10.0, 1.0);
            let body = Body { spin: [0.0, 0.0, spin], ..bricks("steel", [10, 2, 2], edges) };
            let mut scene = scene(sheet.space(), vec![STEEL.elastic()], vec![body]);
            scene.stop_time = turns * TAU / spin;
            let mut simulation = Simulation::new(&scene)?;
            advance(&mut simulation, scene.stop_time)?;
            let balance = simulation.balance();
            sheet.at_most("error of the angular momentum", balance.angular_drift(), 1e-10);
            let change = balance.now.energy() / balance.initial.energy() - 1.0;
            sheet.shown("change of the energy, residual included", change);
            let stress = largest(simulation.all_elements().map(|e| e.equivalent_stress));
            let reach = 5.0 * edges[0];
            let centrifugal = density * (spin * reach).powi(2);
            sheet.enter(
                "stress over that of the centrifugal force",
                "",
                stress / centrifugal,
                Bound::Shown,
            );
            Ok(())
        });
    }
}

/// Largest stress or pressure of a block whose particles are moved as a whole by a rotation, after a step.
fn turned(sheet: &Sheet, angle: f64) -> Result<f64, Trouble> {
    let body = bricks("steel", [3, 3, 3], [0.1; 3]);
    let scene = scene(sheet.space(), vec![STEEL.elastic()], vec![body]);
    let axes = lattice::rotation([0.3, -0.5, 0.8], angle);
    let mut simulation = begin(&scene, DISPLACEMENT, |p| {
        let new = std::array::from_fn(|d| (0..3).map(|k| p.position[k] * axes[k][d]).sum());
        minus(new, p.position)
    })?;
    march(&mut simulation, 2)?;
    let stress = largest(simulation.all_elements().map(|e| e.equivalent_stress));
    Ok(stress.max(largest(simulation.all_particles().map(|p| p.pressure))))
}

/// H27: ellipsoids that spin long, and fast.
pub(super) fn spinning(sheet: &mut Sheet) {
    let turns = sheet.size(100_000.0, 10_000.0);
    for angle in [0.1, 1.0] {
        sheet.part(format!("3:2:1 ellipsoid, {turns} turns, {angle} rad a step"), |sheet| {
            let inertia = Vector3::new(1.0, 2.0, 2.6);
            let spin = Vector3::new(0.02, 1.0, 0.01);
            let turn = UnitQuaternion::from_euler_angles(0.3, 1.0, -2.0);
            let mut rigid = Rigid::spinning(turn, spin, &inertia);
            let energy = rigid.energy(&inertia);
            let steps = (turns * TAU / angle) as u64;
            let (mut norm, mut off) = (0.0f64, 0.0f64);
            for step in 0..steps {
                rigid.rotate(&inertia, angle);
                if step % 1000 == 0 || step + 1 == steps {
                    norm = norm.max((rigid.turn.into_inner().norm() - 1.0).abs());
                    off = off.max(skewness(rigid.axes()));
                }
            }
            sheet.at_most("norm of the Euler parameters off 1", norm, 1e-12);
            sheet.at_most("rotation off an orthogonal one", off, 1e-12);
            sheet.shown("change of the energy", rigid.energy(&inertia) / energy - 1.0);
            Ok(())
        });
    }
}

/// Largest component by which the products of axes differ from those of orthogonal unit vectors.
fn skewness(axes: [[f64; 3]; 3]) -> f64 {
    let product = |a: usize, b: usize| {
        let dot: f64 = (0..3).map(|d| axes[a][d] * axes[b][d]).sum();
        if a == b { dot - 1.0 } else { dot }
    };
    largest((0..9).map(|k| product(k / 3, k % 3)))
}
