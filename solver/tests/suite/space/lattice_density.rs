//! The density rule of contacts on affine paths of a block of the lattice.

use whipple_solver::method::Density;
use whipple_solver::space::columns::{Derived, State, Sums};
use whipple_solver::space::contacts::Contacts;
use whipple_solver::space::mesh::Mesh;
use whipple_solver::space::method::Method;

use super::scenes::{block, copper, default, scene};

/// Deformation gradient.
type F = [[f64; 3]; 3];

const STEPS: usize = 400;

/// Density over the reference one of the particle in the middle, after a path through deformations.
fn along(path: impl Fn(f64) -> F) -> f64 {
    let method = Method { density: Density::Nonholonomic, ..default() };
    let scene = whipple_solver::space::Scene {
        method,
        ..scene(vec![copper()], vec![block("copper", [8; 3], 0.1)])
    };
    let (mesh, _) = Mesh::new(&scene);
    let mut contacts = Contacts::new(&mesh, &method);
    let (mut state, mut derived) = (State::zeros(mesh.len), Derived::zeros(mesh.len));
    let mut sums = Sums::zeros(mesh.len);
    let mut rho = vec![8.93; mesh.len];
    let (mut touched, mut active) = (vec![false; mesh.len], vec![true; mesh.pieces.len()]);
    let start: Vec<(usize, [f64; 3])> =
        mesh.real().map(|i| (i, mesh.bodies[0].lattice.position(mesh.place(i).1))).collect();
    let dt = 1.0 / STEPS as f64;
    let mut rate = vec![0.0; mesh.len];
    let mut mean = vec![[0.0; 3]; mesh.len];
    for step in 0..STEPS {
        let times = [0.0, 0.5, 1.0].map(|part| (step as f64 + part) * dt);
        let [from, middle, to] = times.map(&path);
        for &(i, x) in &start {
            let at = |f: &F, d: usize| (0..3).map(|k| f[d][k] * x[k]).sum::<f64>();
            let [dx, dy, dz] = [0, 1, 2].map(|d| at(&middle, d) - x[d]);
            mean[i] = [0, 1, 2].map(|d| (at(&to, d) - at(&from, d)) / dt);
            (state.dx[i], state.dy[i], state.dz[i]) = (dx, dy, dz);
            derived.rho[i] = rho[i] + 0.5 * dt * rate[i];
            derived.sound[i] = 0.394;
        }
        contacts.refresh(&mesh, &state, &method);
        sums.rho_rate.fill(0.0);
        let marks = (&mut sums, &mut touched[..], &mut active[..]);
        contacts.push(&mesh, (&state, &derived), (&method, dt, f64::INFINITY), marks);
        contacts.work(&mesh, |i| mean[i], dt, (&mut sums.rho_rate, &mut sums.heat));
        for &(i, _) in &start {
            rate[i] = sums.rho_rate[i];
            rho[i] += dt * rate[i];
        }
    }
    let size = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>();
    let (middle, _) = start
        .iter()
        .min_by(|a, b| size(&a.1).total_cmp(&size(&b.1)))
        .expect("a block has particles");
    rho[*middle] / 8.93
}

fn diagonal(a: f64, b: f64, c: f64) -> F {
    [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]
}

/// The numbers of the lattice that `whipple vv` integrates, with the tolerance of the default.
#[test]
fn densities_of_affine_paths() {
    let uniaxial = |end: f64| along(move |t| diagonal(1.0 + t * (end - 1.0), 1.0, 1.0));
    let shear = |end: f64| along(move |t| [[1.0, end * t, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let uniform = along(|t| diagonal(1.0 - 0.2 * t, 1.0 - 0.2 * t, 1.0 - 0.2 * t));
    let upset = along(|t| {
        let s = (-0.28 * t).exp();
        diagonal(s, 1.0 / s.sqrt(), 1.0 / s.sqrt())
    });
    let found = [
        ("uniform 0.8", uniform, 1.953),
        ("uniaxial 0.95", uniaxial(0.95), 1.051),
        ("uniaxial 0.85", uniaxial(0.85), 1.186),
        ("uniaxial 0.80", uniaxial(0.80), 1.293),
        ("uniaxial 0.70", uniaxial(0.70), 1.561),
        ("shear 0.05", shear(0.05), 1.001),
        ("shear 0.2", shear(0.2), 1.029),
        ("shear 0.4", shear(0.4), 1.140),
        ("upset 0.28", upset, 1.069),
    ];
    for (path, rho, wanted) in found {
        println!("{path}: {rho:.4}, {wanted}");
    }
    for (path, rho, wanted) in found {
        assert!((rho / wanted - 1.0).abs() < 4e-3, "{path}: {rho} {wanted}");
    }
}

/// There and back again.
#[test]
fn cycles_close() {
    let bow = |t: f64| 1.0 - (2.0 * t - 1.0).abs();
    let cycles = [
        along(|t| diagonal(1.0 - 0.2 * bow(t), 1.0 - 0.2 * bow(t), 1.0 - 0.2 * bow(t))),
        along(|t| diagonal(1.0 - 0.2 * bow(t), 1.0, 1.0)),
        along(|t| [[1.0, 0.3 * bow(t), 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    ];
    println!("{cycles:?}");
    assert!(cycles.iter().all(|rho| (rho - 1.0).abs() < 1e-3), "{cycles:?}");
}
