//! What a rival costs in three dimensions, in one run: the density of a kernel against that of the paper, its Table 7, and
//! ellipsoids against spheres.
//!
//! Both sides take the same number of steps of one length from the same time on, in turns A B B A, each turn from the
//! same state. What differs is the rival alone: list, layout and integration are one code.

use whipple_solver::method::{Density, Integrator};
use whipple_solver::space::method::Particles;
use whipple_solver::space::phase::Phase;
use whipple_solver::space::{Scene, Simulation};

use super::{PaceError, Spent, Stopwatch};
use crate::cost::median;
use crate::plots::{Axis, Figure, Panel, Series};
use crate::report::{Cell, Column, Table};

/// Steps of a comparison over the shorter of the two that both sides would take.
const SHORTER: f64 = 0.5;

/// The paper's Table 7: particles, and wall-clock time of the kernel over that without.
pub const PUBLISHED: [(usize, f64); 3] = [(21_334, 1.394), (63_253, 1.289), (140_070, 1.320)];

/// What is compared with what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rival {
    /// The density of a kernel with the pairs that the paper's scheme lists: what differs is the sweep.
    Equal,
    /// That of a kernel with those within its own support: what a user pays.
    Natural,
    /// Ellipsoids of equal axes, by the density of the scene, with spheres.
    Ellipsoids,
}

impl Rival {
    /// Those of the paper's Table 7.
    pub const KERNELS: [Self; 2] = [Self::Equal, Self::Natural];

    /// Name for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Equal => "equal list",
            Self::Natural => "own support",
            Self::Ellipsoids => "ellipsoids",
        }
    }
}

/// What is compared, and how thoroughly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contest {
    /// Integration of both.
    pub integrator: Integrator,
    /// What is compared.
    pub rival: Rival,
    /// Time of the states that both sides start from.
    pub from: f64,
    /// Steps of a turn.
    pub steps: u64,
    /// Rounds of four turns.
    pub rounds: usize,
}

/// Cost of one side.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Side {
    /// CPU seconds of a particle and step, round by round.
    pub seconds: Vec<f64>,
    /// The same by phase, over all rounds.
    pub phases: Spent,
    /// Pairs listed of a particle and step.
    pub listed: f64,
    /// Pairs that acted.
    pub acting: f64,
    /// Evaluations of the kernel.
    pub evaluations: f64,
}

/// What a contest has given.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// What was compared.
    pub contest: Contest,
    /// Particles of the scene.
    pub particles: usize,
    /// Density of the first side.
    pub density: Density,
    /// The first side, nonholonomic or spheres, and its rival.
    pub sides: [Side; 2],
    /// CPU time of the rival over that of the first, round by round.
    pub ratios: Vec<f64>,
}

impl Outcome {
    /// Median of the ratios.
    #[must_use]
    pub fn median(&self) -> f64 {
        median(&self.ratios)
    }

    /// Half of the width of a 95 % interval about the median, `1.57 IQR / sqrt(rounds)` (R. McGill, J. W. Tukey and W. A.
    /// Larsen, *Variations of box plots*, 1978).
    #[must_use]
    pub fn spread(&self) -> f64 {
        let mut sorted = self.ratios.clone();
        sorted.sort_by(f64::total_cmp);
        let last = (sorted.len() - 1) as f64;
        let quantile = |part: f64| {
            let at = part * last;
            let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
            low + (at - at.floor()) * (high - low)
        };
        1.57 * (quantile(0.75) - quantile(0.25)) / (sorted.len() as f64).sqrt()
    }
}

/// Both scenes of a contest, that of the rival last.
fn scenes(scene: &Scene, contest: &Contest) -> [Scene; 2] {
    let mut first = scene.clone();
    first.method.integrator = contest.integrator;
    let mut rival = first.clone();
    match contest.rival {
        Rival::Ellipsoids => rival.method.particles = Particles::Ellipsoids,
        Rival::Equal | Rival::Natural => {
            first.method.density = Density::Nonholonomic;
            rival.method.density = Density::Kernel;
        }
    }
    if contest.rival == Rival::Equal {
        rival.method.kernel_support = rival.method.contact_reach;
    }
    [first, rival]
}

/// Compares the two on a scene, on one thread.
///
/// # Errors
/// A scene that cannot be simulated, or a numerical failure.
pub fn compare(scene: &Scene, contest: Contest) -> Result<Outcome, PaceError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|e| PaceError::Threads { threads: 1, reason: e.to_string() })?;
    pool.install(|| on_this_thread(scene, contest))
}

fn on_this_thread(scene: &Scene, contest: Contest) -> Result<Outcome, PaceError> {
    let mut states = Vec::new();
    let mut length = f64::INFINITY;
    let scenes = scenes(scene, &contest);
    let density = scenes[0].method.density;
    for scene in &scenes {
        let mut state = Simulation::new(scene)?;
        state.advance_to(contest.from)?;
        // A step of its own length, which none shortens to land on a time.
        let mut ahead = state.clone();
        ahead.step(f64::INFINITY)?;
        length = length.min(SHORTER * ahead.last_step());
        states.push(state);
    }
    let particles = states[0].particles();
    let (sides, ratios) = (Default::default(), Vec::new());
    let mut outcome = Outcome { contest, particles, density, sides, ratios };
    for _ in 0..contest.rounds.max(1) {
        let mut seconds = [0.0; 2];
        for which in [0, 1, 1, 0] {
            let side = &mut outcome.sides[which];
            seconds[which] += 0.5 * turn(&states[which], (contest.steps, length), side)?;
        }
        outcome.ratios.push(seconds[1] / seconds[0]);
        for (side, seconds) in outcome.sides.iter_mut().zip(seconds) {
            side.seconds.push(seconds);
        }
    }
    let turns = 2.0 * outcome.ratios.len() as f64;
    for side in &mut outcome.sides {
        side.phases.iter_mut().for_each(|spent| *spent /= turns);
        side.listed /= turns;
        side.acting /= turns;
        side.evaluations /= turns;
    }
    Ok(outcome)
}

/// CPU seconds of a particle and step, of steps of this length from a state on; phases and counts are added to a side.
fn turn(from: &Simulation, (steps, length): (u64, f64), side: &mut Side) -> Result<f64, PaceError> {
    let mut simulation = from.clone();
    let mut watch = Stopwatch::new();
    let (mut listed, mut acting) = (0, 0);
    let before = simulation.counters();
    for _ in 0..steps {
        let until = simulation.time() + length;
        simulation.step_by_phases(until, &mut |phase| watch.turn_to(Some(phase)))?;
        watch.turn_to(None);
        listed += simulation.pairs();
        acting += simulation.acting();
    }
    let after = simulation.counters();
    let updates = (after.particle_steps - before.particle_steps) as f64;
    let spent = watch.spent.map(|spent| spent.as_secs_f64() / updates);
    side.phases.iter_mut().zip(spent).for_each(|(sum, spent)| *sum += spent);
    side.listed += listed as f64 / updates;
    side.acting += acting as f64 / updates;
    side.evaluations += (after.kernel_evaluations - before.kernel_evaluations) as f64 / updates;
    Ok(spent.iter().sum())
}

/// Cost of a whole run, where each side takes the steps that it asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Free {
    /// What was compared.
    pub contest: Contest,
    /// Particles of the scene.
    pub particles: usize,
    /// CPU seconds of nonholonomic and kernel.
    pub cpu: [f64; 2],
    /// Their steps.
    pub steps: [u64; 2],
}

/// Runs both to the end of the scene, on one thread; only the integrator and the pairs of a contest count.
///
/// # Errors
/// A scene that cannot be simulated, or a numerical failure.
pub fn run_free(scene: &Scene, contest: Contest) -> Result<Free, PaceError> {
    let mut free = Free { contest, particles: 0, cpu: [0.0; 2], steps: [0; 2] };
    for (k, scene) in scenes(scene, &contest).iter().enumerate() {
        let pace = super::measure("", scene, super::Stretch::Whole, 1)?;
        free.particles = pace.particles;
        free.cpu[k] = pace.cpu;
        free.steps[k] = pace.steps;
    }
    Ok(free)
}

fn integrator(of: Integrator) -> Cell {
    match of {
        Integrator::SinglePass => "single pass".into(),
        Integrator::Compatible => "compatible".into(),
    }
}

/// Columns that tell what is compared.
fn compared(of: &str) -> Vec<Column> {
    vec![Column::number("particles", ""), Column::text("integration"), Column::text(of)]
}

/// Columns of [`measured`], of what is called so over what is called so.
fn measures([first, rival]: [&str; 2]) -> Vec<Column> {
    vec![
        Column::number(format!("{rival} / {first}"), ""),
        Column::number("± of the median", "%"),
        Column::number("least", ""),
        Column::number("most", ""),
        Column::number(first, "ns"),
        Column::number(rival, "ns"),
        Column::number("pairs listed", ""),
    ]
}

/// Ratio with its scatter, both sides, and pairs.
fn measured(outcome: &Outcome) -> Vec<Cell> {
    let [first, rival] = &outcome.sides;
    let extreme =
        |pick: fn(f64, f64) -> f64, from: f64| outcome.ratios.iter().copied().fold(from, pick);
    vec![
        Cell::number(outcome.median(), 4),
        Cell::number(100.0 * outcome.spread() / outcome.median(), 2),
        Cell::number(extreme(f64::min, f64::INFINITY), 4),
        Cell::number(extreme(f64::max, 0.0), 4),
        Cell::number(1e9 * median(&first.seconds), 3),
        Cell::number(1e9 * median(&rival.seconds), 3),
        Cell::number(first.listed, 3),
    ]
}

/// Ellipsoids over spheres at equal steps.
#[must_use]
pub fn shapes(outcomes: &[Outcome]) -> Table {
    let mut columns = compared("density");
    columns.extend(measures(["spheres", "ellipsoids"]));
    columns.push(Column::number("pairs acting", ""));
    let rows = outcomes.iter().map(|outcome| {
        let mut row = vec![
            Cell::count(outcome.particles as u64),
            integrator(outcome.contest.integrator),
            outcome.density.name().into(),
        ];
        row.extend(measured(outcome));
        row.push(Cell::number(outcome.sides[0].acting, 3));
        row
    });
    let caption = "CPU time of a particle and step of ellipsoids of equal axes over that of spheres, measured alike.";
    Table { id: "rivals-shapes".into(), caption: caption.into(), columns, rows: rows.collect() }
}

/// Kernel over nonholonomic at equal steps.
#[must_use]
pub fn ratios(outcomes: &[Outcome]) -> Table {
    let mut columns = compared("pairs of the kernel");
    columns.extend(measures(["nonholonomic", "kernel"]));
    columns.extend([Column::number("of the kernel", ""), Column::number("kernel evals", "")]);
    let rows = outcomes.iter().map(|outcome| {
        let kernel = &outcome.sides[1];
        let mut row = vec![
            Cell::count(outcome.particles as u64),
            integrator(outcome.contest.integrator),
            outcome.contest.rival.name().into(),
        ];
        row.extend(measured(outcome));
        row.extend([Cell::number(kernel.listed, 3), Cell::number(kernel.evaluations, 3)]);
        row
    });
    let published: Vec<String> =
        PUBLISHED.iter().map(|(particles, ratio)| format!("{ratio} with {particles}")).collect();
    let caption = format!(
        "CPU time of a particle and step, medians over rounds A B B A on one thread, each turn of as many steps of one \
         length from the same state. The interval is one of 95 % about the median. The paper's Table 7: {}.",
        published.join(", ")
    );
    Table { id: "rivals".into(), caption, columns, rows: rows.collect() }
}

/// Where the time goes, in nanoseconds of a particle and step.
#[must_use]
pub fn phases(outcomes: &[Outcome]) -> Table {
    let mut columns = compared("pairs of the kernel");
    columns.push(Column::text("density"));
    columns.extend(Phase::ALL.map(|phase| Column::number(phase.name(), "ns")));
    let rows = outcomes.iter().flat_map(|outcome| {
        let sides = ["nonholonomic", "kernel"].into_iter().zip(&outcome.sides);
        sides.map(|(density, side)| {
            let mut row = vec![
                Cell::count(outcome.particles as u64),
                integrator(outcome.contest.integrator),
                outcome.contest.rival.name().into(),
                density.into(),
            ];
            row.extend(side.phases.map(|seconds| Cell::number(1e9 * seconds, 3)));
            row
        })
    });
    let caption = "The same by phase: forces of elements, forces of contacts, their work in a second pass, motion with the \
                   second pass over elements, the list of pairs, the sum over the kernel.";
    Table { id: "rivals-phases".into(), caption: caption.into(), columns, rows: rows.collect() }
}

/// Whole runs.
#[must_use]
pub fn whole(runs: &[Free]) -> Table {
    let mut columns = compared("pairs of the kernel");
    columns.extend([
        Column::number("kernel / nonholonomic", ""),
        Column::number("nonholonomic", "s"),
        Column::number("kernel", "s"),
        Column::number("steps", ""),
        Column::number("of the kernel", ""),
    ]);
    let rows = runs.iter().map(|run| {
        vec![
            Cell::count(run.particles as u64),
            integrator(run.contest.integrator),
            run.contest.rival.name().into(),
            Cell::number(run.cpu[1] / run.cpu[0], 4),
            Cell::number(run.cpu[0], 3),
            Cell::number(run.cpu[1], 3),
            Cell::count(run.steps[0]),
            Cell::count(run.steps[1]),
        ]
    });
    let caption = "CPU time of whole runs on one thread, each with the steps that it asks for.";
    Table { id: "rivals-whole".into(), caption: caption.into(), columns, rows: rows.collect() }
}

/// Ratios over the size, beside the paper's.
#[must_use]
pub fn figure(outcomes: &[Outcome]) -> Figure {
    let mut panel =
        Panel::new("", Axis::log("particles"), Axis::linear("CPU time, kernel / nonholonomic"));
    for by in [Integrator::SinglePass, Integrator::Compatible] {
        for rival in Rival::KERNELS {
            let own = outcomes.iter().filter(|outcome| {
                outcome.contest.integrator == by && outcome.contest.rival == rival
            });
            let points: Vec<(f64, f64)> =
                own.map(|outcome| (outcome.particles as f64, outcome.median())).collect();
            if !points.is_empty() {
                let name = format!("{}, {}", integrator(by).text, rival.name());
                panel = panel.with(Series::line(name, points));
            }
        }
    }
    let published = PUBLISHED.iter().map(|&(particles, ratio)| (particles as f64, ratio)).collect();
    panel = panel.with(Series::line("Table 7", published));
    Figure::new("rivals", "What the density of a kernel costs.", vec![panel])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::find;
    use whipple_solver::method::Preset;

    /// Counts of a contest, and those of its kernel against every pair of particles looked at.
    #[test]
    fn counts_are_those_of_all_pairs() {
        let scene = find("planar-impact").expect("the case").scene(Preset::Paper, "", 8);
        let scene = scene.space().expect("a scene in space");
        for rival in Rival::KERNELS {
            let integrator = Integrator::SinglePass;
            let contest = Contest { integrator, rival, from: 0.0, steps: 3, rounds: 1 };
            let outcome = compare(scene, contest).expect("a run");
            let [plain, kernel] = &outcome.sides;
            assert_eq!(plain.evaluations, 0.0);
            let same = (plain.listed - kernel.listed).abs() < 1e-12;
            assert_eq!(same, rival == Rival::Equal, "{} {}", plain.listed, kernel.listed);

            let own = &scenes(scene, &contest)[1];
            let mut simulation = Simulation::new(own).expect("a scene");
            simulation.step(f64::INFINITY).expect("a step");
            let before = simulation.counters().kernel_evaluations;
            simulation.step(f64::INFINITY).expect("a step");
            let evaluations = simulation.counters().kernel_evaluations - before;
            let all: Vec<[f64; 3]> = simulation.all_particles().map(|p| p.position).collect();
            let length = simulation.sizes(0).0;
            let count = |far: f64| {
                let near = |a: &[f64; 3], b: &[f64; 3]| {
                    (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>() < (far * length).powi(2)
                };
                let pairs = all.iter().enumerate();
                let own = pairs.map(|(k, a)| all[..k].iter().filter(|b| near(a, b)).count());
                own.sum::<usize>()
            };
            let support = own.method.kernel_support;
            assert_eq!(evaluations, 2 * count(support) as u64, "{}", rival.name());
            // The list reaches further than the kernel by its margin.
            let listed = simulation.pairs();
            assert!(count(support) < listed && listed <= count(support + 0.9), "{listed}");
        }
    }
}
