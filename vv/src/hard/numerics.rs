//! Threads, restarts and neighbour lists.

use rayon::ThreadPoolBuilder;
use whipple_solver::space::near::{DEBRIS, EXPOSED, PairList, Points, Reach};
use whipple_solver::space::scene::Scene;
use whipple_solver::space::{Simulation, restart::Section};

use super::measure::{apart, at_pace, largest, pace};
use super::scenes::{march, rod};
use super::sheet::{Sheet, Trouble};
use crate::space::checkpoint::{load, save};
use crate::space::measured::Measured;

fn impact(sheet: &Sheet) -> Scene {
    let method = sheet.space();
    sheet.size(rod(method, 5, 30, [24, 6, 15]), rod(method, 3, 12, [12, 3, 8]))
}

/// Runs with so many threads.
fn with_threads<T: Send>(
    threads: usize,
    work: impl FnOnce() -> Result<T, Trouble> + Send,
) -> Result<T, Trouble> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Trouble::Other(error.to_string()))?;
    pool.install(work)
}

/// H20: the same bits on any number of threads, and bodies in another order.
pub(super) fn threads(sheet: &mut Sheet) {
    let steps = sheet.size(1000, 200);
    sheet.part(format!("rod impact, {steps} steps"), |sheet| {
        let scene = impact(sheet);
        let run = |threads: usize| -> Result<Vec<Section>, Trouble> {
            with_threads(threads, || {
                let mut simulation = Simulation::new(&scene)?;
                march(&mut simulation, steps)?;
                Ok(simulation.sections())
            })
        };
        let alone = run(1)?;
        for threads in [2, 3, 8, 16] {
            let differing = differing(&alone, &run(threads)?);
            sheet.at_most(&format!("sections that differ with {threads} threads"), differing, 0.0);
        }
        Ok(())
    });
    sheet.part("Sod along a line, 4000 particles, 200 steps", |sheet| {
        let scene = super::gas::of_case(sheet, "sod", 4000)?;
        let run = |threads: usize| {
            with_threads(threads, || {
                let mut solver = whipple_solver::build(&scene)?;
                for _ in 0..200 {
                    solver.step(f64::INFINITY)?;
                }
                Ok(solver.snapshot())
            })
        };
        let alone = run(1)?;
        for threads in [2, 3, 8, 16] {
            let differs = f64::from(u8::from(run(threads)? != alone));
            sheet.at_most(&format!("states that differ with {threads} threads"), differs, 0.0);
        }
        Ok(())
    });
    sheet.part("bodies in the other order, 100 steps", |sheet| {
        let scene = impact(sheet);
        let mut other = scene.clone();
        other.bodies.reverse();
        let times = pace(&scene, 100)?;
        let [mut a, mut b] = [Simulation::new(&scene)?, Simulation::new(&other)?];
        at_pace(&mut a, &times)?;
        at_pace(&mut b, &times)?;
        let holdings = [a.holdings(), b.holdings()];
        for (k, own) in holdings[0].iter().enumerate() {
            let other = holdings[1][holdings[1].len() - 1 - k];
            let change = (other.energy() / own.energy() - 1.0).abs();
            sheet.at_most(&format!("energy of body {} changes", k + 1), change, 1e-10);
        }
        let strain = |simulation: &Simulation| largest(simulation.all_elements().map(|e| e.strain));
        let change = strain(&b) / strain(&a) - 1.0;
        sheet.at_most("largest strain changes", change.abs(), 1e-10);
        Ok(())
    });
}

/// Sections of two states that have other bits.
fn differing(a: &[Section], b: &[Section]) -> f64 {
    let pairs = a.iter().zip(b).filter(|(a, b)| a != b).count();
    (pairs + a.len().abs_diff(b.len())) as f64
}

/// H21: a run that is stopped and goes on from its checkpoint.
pub(super) fn restart(sheet: &mut Sheet) {
    let (first, more) = sheet.size((373, 400), (73, 60));
    sheet.part(format!("rod impact, checkpoint at step {first}, {more} more"), |sheet| {
        let scene = impact(sheet);
        let mut whole = Simulation::new(&scene)?;
        march(&mut whole, first)?;
        let folder = tempfile::tempdir().map_err(|error| Trouble::Other(error.to_string()))?;
        let path = save(folder.path(), (&scene, ""), &whole, &Measured::default())?;
        let mut again = load(&path, &scene)?.simulation;
        march(&mut whole, more)?;
        march(&mut again, more)?;
        sheet.at_most("sections that differ", differing(&whole.sections(), &again.sections()), 0.0);
        let fields = [
            apart([&whole, &again], |p| p.position[0]),
            apart([&whole, &again], |p| p.velocity[1]),
            apart([&whole, &again], |p| p.rho),
            apart([&whole, &again], |p| p.pressure),
            apart([&whole, &again], |p| p.theta),
        ];
        sheet.at_most("fields apart", largest(fields), 0.0);
        let same = whole.balance() == again.balance() && whole.counters() == again.counters();
        sheet.at_most("balances or counters that differ", f64::from(u8::from(!same)), 0.0);
        Ok(())
    });
}

/// H29: the list of neighbours against brute force, with members on the faces of cells.
pub(super) fn neighbours(sheet: &mut Sheet) {
    for (name, origin) in [("0", 0.0), ("-0.0", -0.0), ("1e6 dx", 1e6)] {
        sheet.part(format!("a lattice that crosses cells at {name}"), |sheet| {
            let (mut missing, mut foreign, mut rebuilt) = (0usize, 0usize, 0u64);
            let mut list = PairList::new();
            let n = 6usize;
            let count = n * n * n;
            let length = vec![1.0f32; count];
            let flags = vec![EXPOSED | DEBRIS; count];
            let body: Vec<u16> = (0..count).map(|k| (k % 2) as u16).collect();
            let reach = Reach { factor: 1.12, skin: 0.3 };
            for step in 0..200usize {
                // Half of the members rest on the faces of cells, the others go past them.
                let place = |k: usize, axis: usize| {
                    let at = [k % n, k / n % n, k / (n * n)][axis] as f64;
                    let moves = k % 2 == 1 && axis == 0;
                    let way = if moves { 0.0625 * step as f64 } else { 0.0 };
                    // Zero keeps its sign where there is no way.
                    if at == 0.0 && way == 0.0 { origin } else { origin + at + way }
                };
                let [x, y, z] = [0, 1, 2]
                    .map(|axis| -> Vec<f64> { (0..count).map(|k| place(k, axis)).collect() });
                let points = Points {
                    x: &x,
                    y: &y,
                    z: &z,
                    length: &length,
                    flags: &flags,
                    body: &body,
                    lattice: None,
                };
                if list.is_stale(&points) {
                    list.rebuild(&points, reach, |_, _| true);
                    rebuilt += 1;
                }
                let (lost, double) = compare(&list, [&x, &y, &z], 1.12);
                missing += lost;
                foreign += double;
            }
            sheet.at_most("pairs in contact that are not listed", missing as f64, 0.0);
            sheet.at_most("pairs listed twice or of no two members", foreign as f64, 0.0);
            sheet.at_least("lists made", rebuilt as f64, 2.0);
            Ok(())
        });
    }
}

/// Pairs closer than `far` that a list lacks, and pairs that it holds twice or that are none.
fn compare(list: &PairList, [x, y, z]: [&[f64]; 3], far: f64) -> (usize, usize) {
    let pairs = list.pairs();
    let order = pairs.windows(2).filter(|w| w[0] >= w[1]).count();
    let foreign = pairs.iter().filter(|[i, j]| i >= j || *j as usize >= x.len()).count();
    let close = |i: usize, j: usize| {
        (x[i] - x[j]).powi(2) + (y[i] - y[j]).powi(2) + (z[i] - z[j]).powi(2) < far * far
    };
    let mut missing = 0;
    for i in 0..x.len() {
        for j in i + 1..x.len() {
            if close(i, j) && pairs.binary_search(&[i as u32, j as u32]).is_err() {
                missing += 1;
            }
        }
    }
    (missing, order + foreign)
}
