//! Saltzman's piston: a plane shock through a skewed lattice.

use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::mapping::Mapping;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Body, Scene, Shape, Side};

use super::figures::{curves, exact_line, extent, figure, histories, over, profiles};
use super::parts::{Columns, gas_scene, last_fall, mirror, moments, resting, zonal};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run, named};
use crate::exact::Gas;
use crate::exact::saltzman::{Passage, Saltzman as Exact};
use crate::plots::{Axis, Figure, Layer, Panel};
use crate::record::{Records, RunKey};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;
use crate::space::picture::{Shot, Shown, onto_the_section, shoot};

/// The case.
pub(super) struct Saltzman;

const ID: &str = "saltzman";
const GAMMA: f64 = 5.0 / 3.0;
/// Specific heat.
const HEAT: f64 = 1.0;
const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.1;
/// Speed of the piston.
const SPEED: f64 = 1.0;
/// Cells through the box.
const ACROSS: usize = 2;
/// Internal energy of the cold gas, over that behind the shock.
const COLD: f64 = 1e-6;
/// Time of the measurement; the shock meets the far wall at 0.75.
const STOP: f64 = 0.6;
/// First stop of the run, over its end: the first step knows of no wave yet.
const FIRST: f64 = 1e-4;
/// Entries of the history.
const ENTRIES: usize = 24;
/// Part of the way of the shock over which the state behind it is averaged.
const INSIDE: [f64; 2] = [0.2, 0.8];
/// Strips across the box in each of which the shock is located.
const STRIPS: usize = 5;
/// Velocity along the shock wanted at most, over the piston's.
const STILL: f64 = 0.05;
const SKEWED: &str = "skewed";
const REGULAR: &str = "regular";
const VARIANTS: [&str; 2] = ["", REGULAR];
/// Caption of the picture.
const PICTURE: &str = "Elements at t = 0.6, coloured by temperature, n = 10. The piston is the left edge, the exact \
                       shock an upright line at 0.2 of length from it, and all cells behind that should be \
                       equal bricks. Here the shock leans as the lattice does that it runs into, farthest along the \
                       lower wall; gas runs along it, so that rows of cells beside both walls are \
                       drawn out into slivers, and the temperature behind is uneven.";
/// Cells along the box over those across it: as their edges are.
const ALONG: usize = 10;
/// Cells across the box.
const SIZES: [usize; 3] = [5, 10, 20];

fn default_key(variant: &str, n: usize) -> RunKey {
    default_run(ID, n).variant(variant)
}

/// The first passage of the shock.
fn passage() -> Result<Passage, RunError> {
    let pressure = 0.5 * COLD * (GAMMA - 1.0);
    let cold = Gas { density: 1.0, velocity: 0.0, pressure, gamma: GAMMA };
    Ok(Exact::new(cold, LENGTH, SPEED)?.first())
}

/// Way of the exact shock from the piston.
fn way(passage: &Passage, time: f64) -> f64 {
    passage.position(time) - SPEED * time
}

/// The particles of a thin slice across the box.
#[derive(Clone, Copy)]
struct Slice {
    mass: f64,
    /// Means by mass.
    place: f64,
    density: f64,
    /// Lowest and highest density.
    range: [f64; 2],
}

/// Slices of a width that hold particles, the nearest to the piston first; of the particles that are
/// chosen, by their heights in the box.
fn slices(simulation: &Simulation, width: f64, chosen: impl Fn(f64) -> bool) -> Vec<Slice> {
    let range = [f64::INFINITY, f64::NEG_INFINITY];
    let nothing = Slice { mass: 0.0, place: 0.0, density: 0.0, range };
    let mut slices = vec![nothing; (LENGTH / width).ceil() as usize];
    for p in simulation.all_particles().filter(|p| chosen(p.position[1])) {
        let Some(slice) = slices.get_mut((p.position[0] / width) as usize) else { continue };
        slice.mass += p.mass;
        slice.place += p.mass * p.position[0];
        slice.density += p.mass * p.rho;
        slice.range = [slice.range[0].min(p.rho), slice.range[1].max(p.rho)];
    }
    slices.retain(|slice| slice.mass > 0.0);
    for Slice { mass, place, density, .. } in &mut slices {
        *place /= *mass;
        *density /= *mass;
    }
    slices
}

/// Where the mean density of slices falls below a level, the farthest from the piston.
fn front(slices: &[Slice], level: f64) -> f64 {
    last_fall(slices.iter().map(|s| (s.place, s.density)), level).unwrap_or(f64::NAN)
}

/// What is measured at a time: shock over the exact one, less one; farthest places of it in strips
/// apart; mean density and pressure behind over the exact ones, less one; scatter of the density; largest
/// velocity along the shock.
const MEASURED: [&str; 6] =
    ["shock_error", "shock_bend", "density_error", "pressure_error", "scatter", "transverse"];

fn measure(simulation: &Simulation, passage: &Passage, cell: f64) -> [f64; MEASURED.len()] {
    let exact = way(passage, simulation.time());
    let level = 0.5 * (passage.ahead.density + passage.behind.density);
    let place = |chosen: &dyn Fn(f64) -> bool| front(&slices(simulation, cell, chosen), level);
    let strips = (0..STRIPS).map(|k| place(&|y| (y / HEIGHT * STRIPS as f64) as usize == k));
    // No number in a strip is none for the whole: minima and maxima would pass over it.
    let [low, high] = strips.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        if x.is_nan() { [x; 2] } else { [low.min(x), high.max(x)] }
    });
    let inside = |p: &Particle| {
        let x = p.position[0] / exact;
        x > INSIDE[0] && x < INSIDE[1]
    };
    let all = |value: fn(&Particle) -> f64| -> Vec<f64> {
        simulation.all_particles().filter(inside).map(|p| value(&p)).collect()
    };
    let (density, scatter) = moments(&all(|p| p.rho));
    let (pressure, _) = moments(&all(|p| p.pressure));
    let transverse =
        simulation.all_particles().map(|p| p.velocity[1].hypot(p.velocity[2])).fold(0.0, f64::max);
    [
        place(&|_| true) / exact - 1.0,
        high - low,
        density / passage.behind.density - 1.0,
        pressure / passage.behind.pressure - 1.0,
        scatter / passage.behind.density,
        transverse / SPEED,
    ]
}

impl Case for Saltzman {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Saltzman's piston"
    }

    fn about(&self) -> &'static str {
        "A piston drives a plane shock through cold gas, gamma 5/3, in a box of 1 by 0.1 whose lattice is \
         skewed, x + (0.1 - y) sin(pi x): the shock must stay plane although it crosses no cell straight. \
         The variant `regular` has equal cells. The piston is at rest here and the gas comes at speed \
         1, with a free end instead of the far wall, which the shock of the first passage does not know: it \
         would meet it at t = 0.75, and all is measured at 0.6. Pyramids have the stiffness of the gas against being denser \
         than their cell (`hourglass` 1, decision 0017). The shock is where the mean density of slices a cell wide falls below \
         half of its jump; its bend is how far its places in five strips across the box lie apart; density, \
         pressure and scatter go from 0.2 to 0.8 of the way of the exact shock. The transverse velocity is \
         the largest of all particles. n counts the cells across the box, ten times as many along and two through \
         it, between mirrors."
    }

    fn source(&self) -> &'static str {
        "Dukowicz and Meltz (1992); `saltzman_piston` in `references/verification_problems.toml`"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        SIZES[1]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let depth = ACROSS as f64 * LENGTH / (ALONG * n) as f64;
        let size = [LENGTH, HEIGHT, depth];
        let skew = Mapping::Skew { along: 0, across: 1, zero: HEIGHT, length: LENGTH, slope: 1.0 };
        let ends = [(0, LENGTH), (1, HEIGHT), (2, depth)];
        let mut walls: Vec<_> = ends.map(|(axis, _)| mirror(axis, 0.0, Side::Above)).into();
        walls.extend(ends[1..].iter().map(|&(axis, end)| mirror(axis, end, Side::Below)));
        let shape = Shape::Box { size };
        let body = Body {
            energy: 0.5 * COLD,
            velocity: [-SPEED, 0.0, 0.0],
            mapping: (variant != REGULAR).then_some(skew),
            ..resting("gas", shape, [ALONG * n, n, ACROSS], size.map(|edge| 0.5 * edge))
        };
        gas_scene(ID, STOP, zonal(preset), walls, [GAMMA, HEAT], body).into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let passage = passage()?;
        let cell = LENGTH / (ALONG * key.n) as f64;
        driver.advance_to(FIRST * scene.stop_time)?;
        let mut history = Columns::default();
        for k in 1..=ENTRIES {
            let time = scene.stop_time * k as f64 / ENTRIES as f64;
            driver.advance_to(time)?;
            let now = driver.look(|solver, _| measure(solver, &passage, cell).into())?;
            history.row([("time", time)]);
            history.read(&MEASURED, &now);
        }
        let mut findings = Findings::default();
        let mut enter = |name: &str, value: f64| findings.norms.insert(name.into(), value);
        for name in MEASURED {
            enter(name, history.column(name).last().copied().unwrap_or(f64::NAN));
        }
        let largest = |name: &str| history.column(name).iter().copied().fold(0.0, f64::max);
        enter("largest_transverse", largest("transverse"));
        if *key == default_key("", SIZES[1]) {
            driver.photograph("saltzman-lattice", PICTURE, |simulation| {
                let (title, camera) =
                    ("Saltzman's piston: the skewed lattice".into(), onto_the_section());
                let shot = Shot {
                    title,
                    camera,
                    section: None,
                    shown: Shown::Temperature(None),
                    loose: true,
                };
                shoot(simulation, scene, &shot)
            })?;
        }
        let solver = driver.solver();
        enter("dead_elements", solver.failed().1 as f64);
        let time = solver.time();
        let shock = way(&passage, time);
        let mut profile = Columns::default();
        let [mut misfit, mut volume] = [0.0; 2];
        for p in solver.all_particles() {
            let wanted = if p.position[0] <= shock { passage.behind } else { passage.ahead };
            let own = p.mass / wanted.density;
            misfit += own * (p.rho - wanted.density).abs();
            volume += own;
        }
        for Slice { place, density, range: [lowest, highest], .. } in slices(solver, cell, |_| true)
        {
            let exact = if place <= shock { passage.behind } else { passage.ahead };
            profile.row([
                ("place", place),
                ("density", density),
                ("lowest", lowest),
                ("highest", highest),
                ("exact", exact.density),
            ]);
        }
        findings.norms.insert("density_l1".into(), misfit / volume);
        findings.history = Some(history.series());
        findings.profile = Some(profile.series());
        Ok(findings)
    }

    fn draws(&self, key: &RunKey) -> bool {
        key.n >= SIZES[1]
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let sizes = level.first(&SIZES).iter();
        sizes.flat_map(|&n| VARIANTS.map(|variant| default_key(variant, n))).collect()
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "exact solution; tolerances of `saltzman_piston` in \
                      `references/verification_problems.toml`";
        let aim = Claims::new(ID, Kind::Verification, Weight::Aim, source);
        let mut out = Vec::new();
        for (variant, n) in VARIANTS.into_iter().flat_map(|v| [(v, SIZES[1]), (v, SIZES[2])]) {
            let name = named(variant, SKEWED);
            for (norm, text, wanted) in [
                ("dead_elements", "elements that cease to be volumes", Wanted::AtMost(0.0)),
                (
                    "largest_transverse",
                    "largest velocity along the shock, over the piston's",
                    Wanted::AtMost(STILL),
                ),
                ("density_error", "density behind the shock, error", Wanted::WithinZero(0.03)),
                ("pressure_error", "pressure behind the shock, error", Wanted::WithinZero(0.03)),
            ] {
                let quantity = Quantity::Norm(default_key(variant, n), norm);
                out.push(aim.claim(format!("{name}, n = {n}: {text}"), quantity, wanted));
            }
        }
        for variant in VARIANTS {
            out.extend(super::conservation_in_space(ID, &default_key(variant, SIZES[0])));
        }
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("shock_error", "error of the shock's place"),
            ("shock_bend", "bend of the shock"),
            ("density_error", "error of the density behind"),
            ("pressure_error", "error of P behind"),
            ("scatter", "scatter"),
            ("density_l1", "L1 of density"),
            ("largest_transverse", "transverse velocity"),
            ("dead_elements", "dead elements"),
        ]
    }

    fn errors(&self) -> &'static [&'static str] {
        &["density_l1"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let Ok(passage) = passage() else { return Vec::new() };
        let runs = VARIANTS.into_iter().flat_map(|v| [(v, SIZES[1]), (v, SIZES[2])]);
        let runs: Vec<(String, RunKey)> = runs
            .map(|(v, n)| (format!("{}, n = {n}", named(v, SKEWED)), default_key(v, n)))
            .collect();
        let drawn = profiles(records, runs.clone());
        let shock = way(&passage, STOP);
        let exact = |x: f64| if x <= shock { passage.behind } else { passage.ahead }.density;
        let panels = drawn.iter().filter_map(|(title, profile)| {
            let place = Axis::linear("distance from the piston");
            let density = Axis::log("density").range(0.8, 1.1 * extent(&drawn, "highest").1);
            let columns = [("density", "mean"), ("lowest", "lowest"), ("highest", "highest")];
            let lines =
                columns.map(|(column, name)| (name.into(), profile.points("place", column)));
            let panel = curves(Panel::new(title, place, density), lines)?;
            let (from, to) = extent(&drawn, "place");
            Some(panel.with(exact_line("exact", (from, to), |x| Ok::<_, RunError>(exact(x)))))
        });
        let caption = "Density over the distance from the piston at t = 0.6 in slices a cell wide: mean by mass, and \
                       the lowest and highest particle.";
        let mut figures = figure("saltzman-density", caption, panels);
        let runs = histories(records, runs);
        let [time, speed, bend] =
            ["time", "largest velocity along the shock / piston's", "bend of the shock"];
        let panel = |y| Panel::new("", Axis::linear(time).range(0.0, STOP), y);
        // At first there is none, and no logarithm of that.
        let speeds = over(&runs, "time", "transverse")
            .map(|(name, points)| (name, points.into_iter().filter(|p| p.1 > 0.0).collect()));
        let speeds = curves(panel(Axis::log(speed)), speeds)
            .map(|panel| panel.with(Layer::horizontal(STILL, "wanted at most")));
        let bends = curves(panel(Axis::linear(bend)), over(&runs, "time", "shock_bend"));
        let caption = "What a plane shock has none of, over time: velocity along it, and how \
                       far its places in five strips lie apart.";
        figures.extend(figure("saltzman-plane", caption, speeds.into_iter().chain(bends)));
        figures
    }
}
