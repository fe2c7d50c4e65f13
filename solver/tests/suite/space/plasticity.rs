//! The return map lands on the yield surface, in all three readings of the printed norm.

use whipple_solver::space::lanes::F8;
use whipple_solver::space::lattice::rotation;
use whipple_solver::space::method::{Method, YieldNorm};
use whipple_solver::space::scene::Flow;
use whipple_solver::space::strength::{Flowing, Load, Solid};

use super::scenes::{copper, default, strong};

const MU: f64 = 0.46;
const THETA: f64 = 700.0;
const SIX: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

type M = [[f64; 3]; 3];

fn solid(flow: Flow, yield_norm: YieldNorm) -> Solid {
    let method = Method { yield_norm, ..default() };
    Solid::new(&strong(copper(), MU, Some(flow)), &method, 0.1)
}

fn matrix(f: impl Fn(usize, usize) -> f64) -> M {
    std::array::from_fn(|i| std::array::from_fn(|j| f(i, j)))
}

fn full(t: &[F8; 6], lane: usize) -> M {
    let mut out = [[0.0; 3]; 3];
    for (k, (i, j)) in SIX.into_iter().enumerate() {
        out[i][j] = t[k].0[lane];
        out[j][i] = t[k].0[lane];
    }
    out
}

/// The norm (40).
fn norm(t: &M) -> f64 {
    (0.5 * t.iter().flatten().map(|t| t * t).sum::<f64>()).sqrt()
}

/// The effective stress (39), by (41) and (42), and its norm in a reading, over the yield stress.
fn effective(plastic: &M, stress: &M, reading: YieldNorm) -> f64 {
    let mut c = plastic.map(|row| row.map(|e| 2.0 * e));
    for (d, row) in c.iter_mut().enumerate() {
        row[d] += 1.0;
    }
    let mut t = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            t[i][j] = (0..3).map(|k| 0.5 * (c[i][k] * stress[k][j] + stress[i][k] * c[k][j])).sum();
        }
    }
    let mean = (t[0][0] + t[1][1] + t[2][2]) / 3.0;
    for (d, row) in t.iter_mut().enumerate() {
        row[d] -= mean;
    }
    match reading {
        YieldNorm::Mises => 3f64.sqrt() * norm(&t),
        YieldNorm::J2 => 1.5f64.sqrt() * norm(&t) / norm(&c),
        YieldNorm::AsPrinted => norm(&t) / norm(&c),
    }
}

struct Eight {
    plastic: [F8; 6],
    strain: F8,
    flow: F8,
    rate: F8,
}

impl Eight {
    fn new(solid: &Solid) -> Self {
        let zero = F8::ZERO;
        Self { plastic: [zero; 6], strain: zero, flow: F8([solid.first_flow(); 8]), rate: zero }
    }

    fn flow(&mut self, solid: &Solid, total: &[F8; 6], intact: f64, live: u8) -> [F8; 6] {
        let mut own =
            Flowing { strain: &mut self.strain, flow: &mut self.flow, rate: &mut self.rate };
        let load = Load {
            modulus: F8([2.0 * intact * MU; 8]),
            intact: F8([intact; 8]),
            theta: F8([THETA; 8]),
            live,
            dt: 0.01,
        };
        solid.flow(total, &mut self.plastic, &mut own, &load)
    }
}

/// A number from -1 to 1.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / 2f64.powi(52) - 1.0
}

#[test]
fn the_return_map_lands() {
    let hardening = Flow::Hardening {
        y_0: 0.0075,
        kappa: 5.67,
        alpha: 0.49,
        eta: 1.0,
        reference: 300.0,
        melt: 1700.0,
    };
    let johnson_cook = Flow::JohnsonCook {
        a: 0.0079,
        b: 0.0051,
        n: 0.26,
        c: 0.014,
        rate_0: 1e-6,
        m: 1.03,
        reference: 300.0,
        melt: 1793.0,
    };
    let h: f64 = (THETA - 300.0) / 1493.0;
    for (flow, soft) in [(hardening, 1.0 - 400.0 / 1400.0), (johnson_cook, 1.0 - h.powf(1.03))] {
        for reading in [YieldNorm::Mises, YieldNorm::J2, YieldNorm::AsPrinted] {
            let solid = solid(flow, reading);
            let mut eight = Eight::new(&solid);
            let mut total = [F8::ZERO; 6];
            let (mut seed, mut yielded) = (7, 0);
            let (mut worst, mut farthest) = (0.0_f64, 0.0_f64);
            let drift: [f64; 48] = std::array::from_fn(|_| random(&mut seed));
            for step in 0..300 {
                let intact = if step < 200 { 1.0 } else { 0.4 };
                for (k, t) in total.iter_mut().enumerate() {
                    for lane in 0..8 {
                        // Now straight on, now back.
                        let way = if step % 60 < 45 { drift[8 * k + lane] } else { -0.3 };
                        t.0[lane] += 1e-3 * (way + random(&mut seed));
                    }
                }
                let before = eight.strain;
                let stress = eight.flow(&solid, &total, intact, 0b0111_1111);
                for lane in 0..7 {
                    let y = eight.flow.0[lane] * soft * intact;
                    let size =
                        effective(&full(&eight.plastic, lane), &full(&stress, lane), reading);
                    assert!(size <= y * (1.0 + 1e-8), "{reading:?} {step}: {size} {y}");
                    if eight.strain.0[lane] > before.0[lane] {
                        yielded += 1;
                        worst = worst.max((size / y - 1.0).abs());
                        farthest = farthest.max(eight.strain.0[lane]);
                    }
                }
                assert_eq!(eight.strain.0[7], 0.0, "a dead lane does not flow");
            }
            println!(
                "{reading:?}: {worst:.1e} of Y over {yielded} yielding states to {farthest:.2}"
            );
            assert!(yielded > 1000 && worst <= 1e-8);
            if let Flow::Hardening { y_0, kappa, alpha, .. } = flow {
                for lane in 0..7 {
                    let y = y_0 * (1.0 + kappa * eight.strain.0[lane]).powf(alpha);
                    assert!((eight.flow.0[lane] / y - 1.0).abs() < 1e-9);
                }
            }
        }
    }
}

/// Uniaxial stress yields at `Y`, `sqrt 3 Y` and `3 / sqrt 2 Y`.
#[test]
fn uniaxial_yield() {
    let y = 1e-5;
    let flow = Flow::Hardening {
        y_0: y,
        kappa: 0.0,
        alpha: 0.0,
        eta: 0.0,
        reference: 300.0,
        melt: 1700.0,
    };
    for (reading, factor) in [
        (YieldNorm::Mises, 1.0),
        (YieldNorm::J2, 3f64.sqrt()),
        (YieldNorm::AsPrinted, 4.5f64.sqrt()),
    ] {
        let solid = solid(flow, reading);
        let at = |stress: f64| {
            let mut eight = Eight::new(&solid);
            let e = stress / (2.0 * MU);
            let parts = [2.0 / 3.0, -1.0 / 3.0, -1.0 / 3.0, 0.0, 0.0, 0.0];
            let total = parts.map(|part| F8([part * e; 8]));
            let stress = eight.flow(&solid, &total, 1.0, u8::MAX);
            (eight.strain.0[0], stress[0].0[0] - stress[1].0[0])
        };
        assert_eq!(at(0.999 * factor * y).0, 0.0, "{reading:?}");
        let (strain, stress) = at(1.5 * factor * y);
        assert!(strain > 0.0 && (stress / (factor * y) - 1.0).abs() < 1e-3, "{reading:?} {stress}");
    }
}

/// The symmetric tensor with these principal values, turned about a skew axis by an angle in degrees.
fn turned(principal: [f64; 3], degrees: f64) -> [f64; 6] {
    let axes = rotation([1.0, 2.0, 3.0], degrees.to_radians());
    SIX.map(|(i, j)| (0..3).map(|k| principal[k] * axes[k][i] * axes[k][j]).sum())
}

fn determinant(t: &M) -> f64 {
    let minor = |j: usize, k: usize| t[1][j] * t[2][k] - t[1][k] * t[2][j];
    t[0][0] * minor(1, 2) - t[0][1] * minor(0, 2) + t[0][2] * minor(0, 1)
}

/// A cell that is pressed to 0.3, drawn out to 3.3, pressed again and let back lands at every step, its
/// plastic deformation keeps its volume, Eq. (17), and the plastic strain is the way of the
/// logarithmic strain but for the elastic part, in steps small and large, straight and turned.
#[test]
fn large_reversed_strain() {
    let flow = Flow::Hardening {
        y_0: 0.0075,
        kappa: 5.67,
        alpha: 0.49,
        eta: 0.0,
        reference: 300.0,
        melt: 1700.0,
    };
    for reading in [YieldNorm::Mises, YieldNorm::J2, YieldNorm::AsPrinted] {
        let solid = solid(flow, reading);
        for step in [0.02, 0.1, 0.3] {
            let mut eight = Eight::new(&solid);
            let (mut log, mut off, mut swollen) = (0.0_f64, 0.0_f64, 0.0_f64);
            for (way, until) in [(-1.0, -1.2), (1.0, 1.2), (-1.0, -1.2), (1.0, 0.0)] {
                while way * (until - log) > 1e-9 {
                    log += way * step;
                    let square = log.exp().powi(2);
                    let across = 0.5 / square.sqrt() - 0.5;
                    let principal = [0.5 * square - 0.5, across, across];
                    let lanes: [[f64; 6]; 8] =
                        std::array::from_fn(|lane| turned(principal, 10.0 * lane as f64));
                    let total = std::array::from_fn(|k| F8(lanes.map(|t| t[k])));
                    let stress = eight.flow(&solid, &total, 1.0, u8::MAX);
                    for lane in 0..8 {
                        let plastic = full(&eight.plastic, lane);
                        let size = effective(&plastic, &full(&stress, lane), reading);
                        off = off.max(size / eight.flow.0[lane] - 1.0);
                        let c = matrix(|i, j| 2.0 * plastic[i][j] + f64::from(u8::from(i == j)));
                        swollen = swollen.max((determinant(&c) - 1.0).abs());
                    }
                }
            }
            let strain = eight.strain.0;
            println!("{reading:?} {step}: {off:.1e} of Y, det C^p {swollen:.1e}, {:.3}", strain[0]);
            assert!(off < 1e-8 && swollen < 1e-12, "{reading:?} {step}: {off:e} {swollen:e}");
            assert!(strain.iter().all(|s| (s / strain[0] - 1.0).abs() < 1e-9), "{strain:?}");
            // 7.2 less the elastic strains of four ways; the largest steps are longer than these.
            if reading == YieldNorm::Mises && step < 0.2 {
                assert!((7.05..7.2).contains(&strain[0]), "{step}: {}", strain[0]);
            }
        }
    }
}
