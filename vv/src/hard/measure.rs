//! What hard cases read off simulations.

use whipple_solver::space::{Scene, Simulation};

use super::sheet::{Sheet, Trouble};

/// What is read of the balance of elements and springs.
pub(super) const RESIDUAL: &str = "residual of the elements";

/// Largest size of some numbers; what is no number is larger than any.
pub(super) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |worst: f64, value| {
        let size = value.abs();
        if size <= worst {
            worst
        } else if size.is_nan() {
            f64::INFINITY
        } else {
            size
        }
    })
}

/// Mean of some numbers.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Length of a vector.
pub(super) fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// One vector less another.
pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|d| a[d] - b[d])
}

/// Enters what a run has lost: energy, to 1e-12 with the residual of the elements booked, and that
/// residual, to 0.1 %.
pub(super) fn energy(sheet: &mut Sheet, simulation: &Simulation) {
    let balance = simulation.balance();
    sheet.at_most("error of the energy balance", balance.energy_drift(), 1e-12);
    sheet.at_most(RESIDUAL, balance.relative_residual().abs(), 1e-3);
}

/// Runs a scene once more in a quarter of its steps, and shows the residual of the elements: how much of it is an error of
/// the integration over time. Only at the stated size.
pub(super) fn in_short_steps(sheet: &mut Sheet, scene: &Scene, end: f64) -> Result<(), Trouble> {
    if sheet.size(true, false) {
        let mut scene = scene.clone();
        scene.method.cfl *= 0.25;
        let mut simulation = Simulation::new(&scene)?;
        simulation.advance_to(end)?;
        sheet.shown(
            "residual of the elements in steps a quarter as long",
            simulation.balance().relative_residual().abs(),
        );
    }
    Ok(())
}

/// Runs a scene to its end, and enters how short its steps got: a thousandth of the first at least. The last, which
/// lands on the end, does not count.
pub(super) fn to_the_end(sheet: &mut Sheet, scene: &Scene) -> Result<Simulation, Trouble> {
    let end = scene.stop_time;
    let mut simulation = Simulation::new(scene)?;
    let first = simulation.step(end).map(|()| simulation.last_step())?;
    let mut shortest = first;
    while simulation.time() < end {
        simulation.step(end)?;
        if simulation.time() < end {
            shortest = shortest.min(simulation.last_step());
        }
    }
    sheet.at_least("shortest step over the first", shortest / first, 1e-3);
    Ok(simulation)
}

/// The times of so many steps that are a fifth shorter than they could be: a run that stops at each of
/// them takes one step to each, whatever round-off does to its own votes.
pub(super) fn pace(scene: &Scene, steps: usize) -> Result<Vec<f64>, Trouble> {
    let mut slower = scene.clone();
    slower.method.cfl *= 0.8;
    let mut simulation = Simulation::new(&slower)?;
    (0..steps)
        .map(|_| {
            simulation.step(f64::INFINITY)?;
            Ok(simulation.time())
        })
        .collect()
}

/// Steps to each of some times in turn.
pub(super) fn at_pace(simulation: &mut Simulation, times: &[f64]) -> Result<(), Trouble> {
    for &time in times {
        simulation.advance_to(time)?;
    }
    Ok(())
}

/// Largest difference of a quantity of two simulations of the same particles, over the largest of it.
pub(super) fn apart(
    [a, b]: [&Simulation; 2],
    quantity: impl Fn(&whipple_solver::space::output::Particle) -> f64,
) -> f64 {
    let of = |simulation: &Simulation| -> Vec<f64> {
        simulation.all_particles().map(|p| quantity(&p)).collect()
    };
    let (a, b) = (of(a), of(b));
    let scale = largest(a.iter().copied());
    largest(a.iter().zip(&b).map(|(a, b)| a - b)) / scale.max(f64::MIN_POSITIVE)
}

/// Planes of particles of a body across x at the start, with the particles of each.
pub(super) struct Planes(Vec<(f64, Vec<u32>)>);

impl Planes {
    /// Those of a new simulation; `half` is half the edge of a cell along x.
    pub(super) fn new(simulation: &Simulation, body: usize, half: f64) -> Self {
        let mut own: Vec<(f64, u32)> = simulation
            .all_particles()
            .filter(|p| p.body == body)
            .map(|p| (p.position[0], p.id))
            .collect();
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut planes: Vec<(f64, Vec<u32>)> = Vec::new();
        for (x, id) in own {
            match planes.last_mut() {
                Some((place, ids)) if x - *place < 0.5 * half => ids.push(id),
                _ => planes.push((x, vec![id])),
            }
        }
        Self(planes)
    }

    /// Mean of a quantity over each plane, with the place of the plane at the start.
    pub(super) fn means(
        &self,
        simulation: &Simulation,
        quantity: impl Fn(&whipple_solver::space::output::Particle) -> f64,
    ) -> Vec<(f64, f64)> {
        let of = |ids: &[u32]| {
            let all: Vec<f64> = ids.iter().map(|&id| quantity(&simulation.particle(id))).collect();
            mean(&all)
        };
        self.0.iter().map(|(place, ids)| (*place, of(ids))).collect()
    }
}

/// The farthest place at which a curve still has a level, between its points.
pub(super) fn front(curve: &[(f64, f64)], level: f64) -> Option<f64> {
    let pairs = curve.windows(2).map(|w| (w[0], w[1]));
    let (a, b) = pairs.into_iter().rfind(|(a, b)| a.1 >= level && b.1 < level)?;
    Some(a.0 + (a.1 - level) / (a.1 - b.1) * (b.0 - a.0))
}

#[cfg(test)]
mod tests {
    use super::super::scenes::{COPPER, block, scene};
    use super::*;
    use whipple_solver::method::Preset;
    use whipple_solver::space::scene::Body;

    #[test]
    fn steps_of_a_pace_are_taken_one_by_one() {
        let body = Body { noise: 1e-4, ..block("copper", [3, 3, 3], 0.1) };
        let scene = scene(Preset::Default.space(), vec![COPPER.elastic()], vec![body]);
        let times = pace(&scene, 20).expect("a pace");
        let mut simulation = Simulation::new(&scene).expect("a scene");
        at_pace(&mut simulation, &times).expect("it runs");
        assert_eq!(simulation.counters().steps, 20);
    }

    #[test]
    fn the_largest_of_what_is_no_number_is_beyond_any_bound() {
        assert_eq!(largest([1.0, -2.0]), 2.0);
        assert_eq!(largest([1.0, f64::NAN]), f64::INFINITY);
    }

    #[test]
    fn fronts_are_found_between_planes() {
        assert_eq!(front(&[(0.0, 1.0), (1.0, 1.0), (2.0, 0.0)], 0.5), Some(1.5));
        assert_eq!(front(&[(0.0, 0.0), (1.0, 0.0)], 0.5), None);
    }
}
