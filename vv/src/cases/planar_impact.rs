//! Planar impact of metals in three dimensions, against their shock Hugoniots.

use whipple_solver::method::Preset;
use whipple_solver::space::scene::{Body, Scene};
use whipple_solver::units::Units;

use super::figures::{curves, figure};
use super::parts::column::Column;
use super::parts::fit::slope;
use super::parts::metals::{ALUMINIUM, COPPER, Metal, STEEL, TUNGSTEN};
use super::parts::planes::{Plane, Planes, Ringing, front};
use super::parts::schemes::{Error, Schemes};
use super::parts::supports::{self, Supports};
use super::parts::{Columns, last_fall, late_times, moments};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run, paper_run};
use crate::exact::hugoniot::PlanarImpact as Exact;
use crate::plots::{Axis, Figure, Layer, Panel, Point};
use crate::record::{Records, RunKey};
use crate::report::Table;
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct PlanarImpact;

const ID: &str = "planar-impact";
/// Length of the column in cm.
const LENGTH: f64 = 8.0;
/// Cells across the column.
const ACROSS: usize = 4;
/// Random part of the velocities over the velocity: a test of stability.
const NOISE: f64 = 0.005;
/// Cells left out beside the wall and behind the front.
const MARGIN: f64 = 8.0;
/// Cells that the front itself may take.
const FRONT: f64 = 2.0;
/// Part of the pressure within which it counts as settled.
const SETTLED: f64 = 0.05;
/// Overshoot and undershoot wanted at most.
const RINGING: f64 = 0.12;
/// Top of the figures, over the exact pressure.
const HIGHEST: f64 = 1.4;
/// Cells behind the front that a figure shows.
const ZOOM: f64 = 14.0;
/// Cells behind the front in which a figure shows the noise, and how far off the exact pressure in per cent.
const NOISY: f64 = 24.0;
const NEAR: f64 = 5.0;
/// Part of the column that the faster shock runs through.
const RUN: f64 = 0.75;
/// Times at which the front is located.
const LOOKS: usize = 20;
/// Cells along the column.
const SIZES: [usize; 3] = [40, 80, 160];
/// Which density is cheaper at equal error.
const SCHEMES: Schemes = Schemes {
    case: ID,
    sizes: &SIZES,
    error: Error::Norm("pressure_l1"),
    name: "the pressure, L1",
};
/// Which support serves the kernel best.
const SUPPORTS: Supports = Supports {
    case: ID,
    n: SIZES[1],
    errors: &[
        ("pressure_l1", "pressure, L1"),
        ("pressure_error", "mean pressure behind the shock"),
        ("noise", "noise behind the front"),
    ],
};
/// Closing speeds in km/s.
const SPEEDS: [&str; 5] = ["0.5", "1", "2", "4", "7"];
/// Metals and speeds; the first runs when none is named: copper at 1 km/s.
const SHOTS: [&str; 15] = [
    "",
    "cu-0.5",
    "cu-2",
    "cu-4",
    "cu-7",
    "al-0.5",
    "al-1",
    "al-2",
    "al-4",
    "al-7",
    "w-steel-0.5",
    "w-steel-1",
    "w-steel-2",
    "w-steel-4",
    "w-steel-7",
];
/// All variants: the shots, and the supports of the first.
const VARIANTS: [&str; 20] = supports::after(SHOTS);
/// Variants whose claims were looked at when the viscosity was chosen (decision 0012).
const IN_SAMPLE: &str = "cu";

/// What hits what.
struct Shot {
    impactor: &'static Metal,
    target: &'static Metal,
    /// Closing speed in cm/us.
    speed: f64,
}

impl Shot {
    /// Of a variant; the plain one for a name of none.
    fn of(variant: &str) -> Self {
        let shot = SHOTS.iter().find(|shot| **shot == variant).unwrap_or(&"");
        let (metals, speed) = shot.rsplit_once('-').unwrap_or(("cu", "1"));
        let (impactor, target) = match metals {
            "al" => (&ALUMINIUM, &ALUMINIUM),
            "w-steel" => (&TUNGSTEN, &STEEL),
            _ => (&COPPER, &COPPER),
        };
        Self { impactor, target, speed: 0.1 * speed.parse().unwrap_or(1.0) }
    }

    /// Alike, they meet at a mirror.
    fn symmetric(&self) -> bool {
        self.impactor.name == self.target.name
    }

    fn exact(&self) -> Result<Exact, RunError> {
        let (impactor, target) = (self.impactor.hugoniot()?, self.target.hugoniot()?);
        Ok(Exact::new(&impactor, &target, self.speed)?)
    }
}

impl Case for PlanarImpact {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Planar impact in three dimensions"
    }

    fn about(&self) -> &'static str {
        "A column of 8 cm, four cells across between mirrors, hits its mirror image: the shock must \
         have the pressure and the speed of the Hugoniot, and be quiet behind the front although the \
         initial velocities carry 0.5 % noise. Copper, aluminium, and tungsten alloy on steel as two \
         bodies in contact, at closing speeds from 0.5 to 7 km/s, without strength. Pressure is \
         averaged from 8 cells off the impact plane to 8 cells behind the front; the speed is the \
         slope of the place of half the pressure over the second half of the run, in the undeformed \
         column. Fronts may ring, so that noise is also taken from 2 cells behind them. Overshoot, \
         undershoot and the distance behind which the pressure stays within 5 % are of the means of \
         planes off the impact plane, the largest at 21 times in the second half of the run. The error at the impact is the largest \
         of the planes within 8 cells of its plane at the end, on either side. n counts \
         the cells along the column. Mirrors hold the pairs alike; tungsten on steel meets as two \
         lattices face to face, node on node, which is the test of contact between bodies."
    }

    fn source(&self) -> &'static str {
        "jump conditions with Us = c0 + s up; constants of `references/materials.toml`"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        SIZES[1]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let shot = Shot::of(variant);
        let column = Column { length: LENGTH, cells: n, across: ACROSS };
        let body = |metal: &Metal, centre: f64, velocity: f64| Body {
            noise: NOISE * 0.5 * shot.speed,
            ..column.body(metal.name, centre, velocity)
        };
        let (walls, materials, bodies) = if shot.symmetric() {
            let body = body(shot.impactor, 0.5 * LENGTH, -0.5 * shot.speed);
            (column.walls(), vec![shot.impactor.material()], vec![body])
        } else {
            let materials = vec![shot.impactor.material(), shot.target.material()];
            // Contacts begin at about a cell's edge.
            let from = -0.5 * LENGTH - column.edge();
            let bodies =
                vec![body(shot.impactor, from, shot.speed), body(shot.target, 0.5 * LENGTH, 0.0)];
            (column.sides(), materials, bodies)
        };
        // Only constants of this file come here; a test builds every scene.
        let fastest = shot
            .exact()
            .map_or(1.0, |exact| exact.impactor.shock_speed.max(exact.target.shock_speed));
        Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: RUN * LENGTH / fastest,
            method: supports::apply(preset.space(), variant),
            walls,
            materials,
            bodies,
        }
        .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let shot = Shot::of(&key.variant);
        let exact = shot.exact()?;
        let last = scene.bodies.len() - 1;
        let target = Planes::new(driver.solver(), last, 0.0);
        let edge = LENGTH / key.n as f64;
        let impactor = (last > 0).then(|| Planes::new(driver.solver(), 0, -edge));
        let state = exact.target;
        let cell = 2.0 * target.spacing;
        let margin = MARGIN * cell;

        let mut seen = Vec::new();
        let mut ringing = [f64::NAN; 3];
        for time in late_times(scene.stop_time, LOOKS) {
            driver.advance_to(time)?;
            let now = driver.look(|solver, _| {
                let layers = target.look(solver);
                let Some(place) = front(&layers, |l| l.pressure, 0.5 * state.pressure) else {
                    return Vec::new();
                };
                let Ringing { over, under, settling } =
                    Ringing::behind(&layers, [margin, place], state.pressure, SETTLED);
                vec![solver.time(), place, over, under, settling / cell]
            })?;
            if let [time, place, ref now @ ..] = now[..] {
                seen.push((time, place));
                ringing.iter_mut().zip(now).for_each(|(most, now)| *most = most.max(*now));
            }
        }
        let layers = target.look(driver.solver());
        let reached = seen.last().map_or(f64::NAN, |p| p.1);

        let mut findings = Findings::default();
        let shock = slope(&seen);
        findings.enter("shock_speed", 10.0 * shock);
        findings.enter("shock_speed_error", shock / state.shock_speed - 1.0);
        let behind = |cells: f64| {
            moments(&target.pressures(driver.solver(), [margin, reached - cells * cell]))
        };
        let (mean, rms) = behind(MARGIN);
        findings.enter("pressure_error", mean / state.pressure - 1.0);
        findings.enter("noise", rms / state.pressure);
        findings.enter("noise_near_front", behind(FRONT).1 / state.pressure);
        for (name, most) in ["overshoot", "undershoot", "settling_cells"].into_iter().zip(ringing) {
            findings.enter(name, most);
        }
        let misfit = |l: &Plane| {
            let exact = if l.place < reached { state.pressure } else { 0.0 };
            (l.pressure - exact).abs() / state.pressure
        };
        // Between the plane of impact and the cells from which the pressure is averaged.
        let off = |l: &Plane| (l.pressure / state.pressure - 1.0).abs();
        let near_impact = |layers: &[Plane]| {
            let near = layers.iter().filter(|l| l.place < margin);
            near.map(off).fold(0.0, f64::max)
        };
        let mut impact = near_impact(&layers);
        findings.enter("density_at_impact", layers[0].density / state.density - 1.0);
        let l1 = layers.iter().map(misfit).sum::<f64>() / layers.len() as f64;
        findings.enter("pressure_l1", l1);
        if let Some(planes) = impactor {
            let layers = planes.look(driver.solver());
            let place = front(&layers, |l| l.pressure, 0.5 * state.pressure).unwrap_or(f64::NAN);
            let shocked = planes.pressures(driver.solver(), [margin, place - margin]);
            let (mean, rms) = moments(&shocked);
            findings.enter("pressure_error_impactor", mean / state.pressure - 1.0);
            findings.enter("noise_impactor", rms / state.pressure);
            impact = impact.max(near_impact(&layers));
        }
        findings.enter("pressure_at_impact", impact);
        let mut profile = Columns::default();
        for l in &layers {
            profile.row([("place", l.place), ("pressure", l.pressure), ("density", l.density)]);
        }
        findings.profile = Some(profile.series());
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[("place", "cm"), ("pressure", "Mbar"), ("density", "g/cm³")]
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let default = |n| default_run(ID, n);
        let mut keys: Vec<RunKey> = SHOTS.iter().map(|v| default(SIZES[1]).variant(v)).collect();
        keys.extend([SIZES[0], SIZES[2]].map(default));
        if level >= Level::Standard {
            let paper = paper_run(ID, SIZES[1]);
            keys.extend(SHOTS[..5].iter().map(|v| paper.clone().variant(v)));
        }
        if level == Level::Full {
            keys.extend([SCHEMES.runs(), SUPPORTS.runs()].concat());
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let must = Claims::new(
            ID,
            Kind::Verification,
            Weight::Must,
            wanted!("jump conditions; one set of viscosity constants for all"),
        );
        let mut out = Vec::new();
        let key = |v: &str| default_run(ID, SIZES[1]).variant(v);
        for variant in SHOTS {
            let (metals, speed) = variant.rsplit_once('-').unwrap_or(("cu", "1"));
            let claims = if metals == IN_SAMPLE { must.in_sample() } else { must };
            let aims = Claims { weight: Weight::Aim, ..claims };
            let (wide, noise) = bounds(speed);
            let norm = |name| Quantity::Norm(key(variant), name);
            let what = |text: &str| format!("{metals}, {speed} km/s: {text}");
            let quantities = [
                ("pressure_error", "pressure, error"),
                ("shock_speed_error", "shock speed, error"),
            ];
            for (name, text) in quantities {
                out.push(claims.claim(what(text), norm(name), Wanted::WithinZero(wide)));
                if wide > 0.01 {
                    out.push(aims.claim(what(text), norm(name), Wanted::WithinZero(0.01)));
                }
            }
            let near = Claims {
                source: wanted!("noise behind the front; the front itself may take 2 cells"),
                ..claims
            };
            let quantities = [
                (claims, "noise", "noise from 8 cells behind the front, rms over the pressure"),
                (near, "noise_near_front", "noise from 2 cells behind it, rms over the pressure"),
            ];
            for (claims, name, text) in quantities {
                out.push(claims.claim(what(text), norm(name), Wanted::AtMost(noise)));
                if noise > 0.01 {
                    let aims = Claims { weight: Weight::Aim, ..claims };
                    out.push(aims.claim(what(text), norm(name), Wanted::AtMost(0.01)));
                }
            }
            let ringing = Claims { source: "what the front of the Kolsky bar is allowed", ..aims };
            let quantities = [
                ("overshoot", "overshoot of the front"),
                ("undershoot", "trough behind the front"),
            ];
            for (name, text) in quantities {
                out.push(ringing.claim(what(text), norm(name), Wanted::AtMost(RINGING)));
            }
            let even = Claims {
                source: "wall heating leaves density and temperature off at the plane of impact, but no \
                         pressure: the tolerance farther in",
                ..aims
            };
            out.push(even.claim(
                what("pressure within 8 cells of the plane of impact, largest error of a plane"),
                norm("pressure_at_impact"),
                Wanted::AtMost(wide),
            ));
            let settled = Claims { source: "where the required noise begins", ..aims };
            out.push(settled.claim(
                what("cells behind the front from which the pressure is within 5 %"),
                norm("settling_cells"),
                Wanted::AtMost(MARGIN),
            ));
            out.extend(super::conservation_in_space(ID, &key(variant)));
        }
        let keys = SIZES.map(|n| default_run(ID, n));
        let order = Claims { source: "the front keeps its number of cells", ..must };
        out.push(order.claim(
            "order of the L1 error of the pressure, copper at 1 km/s",
            Quantity::Order(keys.to_vec(), "pressure_l1"),
            Wanted::Around(1.0, 0.25),
        ));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("pressure_error", "error of P"),
            ("shock_speed_error", "error of Us"),
            ("noise", "noise / P"),
            ("noise_near_front", "noise / P, from 2 cells"),
            ("overshoot", "overshoot"),
            ("undershoot", "undershoot"),
            ("settling_cells", "settled behind, cells"),
            ("pressure_at_impact", "largest error of P, 8 cells at the impact"),
            ("density_at_impact", "error of the density at the impact"),
            ("pressure_l1", "L1 of P"),
        ]
    }

    fn errors(&self) -> &'static [&'static str] {
        &["pressure_error", "shock_speed_error", "pressure_l1"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let of_metals = |[x, y]: [Axis; 2], pressures: fn(&Records, &str) -> Vec<Curve>| {
            let metals =
                [("copper", "cu"), ("aluminium", "al"), ("tungsten alloy on steel", "w-steel")];
            let panels = metals.into_iter().filter_map(|(title, metals)| {
                curves(Panel::new(title, x.clone(), y.clone()), pressures(records, metals))
            });
            panels.collect::<Vec<Panel>>()
        };
        let beside = |panels: Vec<Panel>, exact: &[Point]| {
            let exact = |panel: Panel| panel.with(Layer::exact("Hugoniot", exact.into()));
            panels.into_iter().map(exact).collect::<Vec<Panel>>()
        };
        let whole = Axis::linear("P / exact").range(-0.05, HIGHEST);
        let place = Axis::linear("place in the undeformed column, cm");
        let caption = "Mean pressure of the planes of the column over the exact pressure, at the end of \
                       the run, 80 cells. Tungsten alloy and steel start a cell apart, so that they meet the \
                       later the slower they close.";
        let level = [(0.0, 1.0), (RUN * LENGTH, 1.0)];
        let profiles = of_metals([place, whole.clone()], pressures);
        let mut figures = figure("planar-impact-profiles", caption, beside(profiles, &level));
        let cells = Axis::linear("cells from where P is half").range(-ZOOM, 0.4 * ZOOM);
        let caption = "The same at the front, over the distance from where the pressure is half of the \
                       exact one: how it overshoots, and how far back it rings.";
        let step = [(-ZOOM, 1.0), (0.0, 1.0), (0.0, 0.0), (ZOOM, 0.0)];
        let fronts = of_metals([cells, whole], pressures_at_the_front);
        figures.extend(figure("planar-impact-front", caption, beside(fronts, &step)));
        let cells = Axis::linear("cells from where P is half").range(-NOISY, -FRONT);
        let caption = "The same, enlarged, from 2 cells behind the front on: how far the mean pressure of planes is \
                       off the exact one. Dashed lines across are what is wanted of the noise, the rms over the \
                       single particles from there, or from 8 cells (the upright line), to 8 cells off the impact.";
        let near = Axis::linear("P / exact less one, per cent").range(-NEAR, NEAR);
        let noise = of_metals([cells, near], noise_behind_the_front).into_iter().map(with_bounds);
        figures.extend(figure("planar-impact-noise", caption, noise));
        figures.extend([SUPPORTS.figure(records), SCHEMES.figure(records)].into_iter().flatten());
        figures
    }

    fn extra_tables(&self, records: &Records) -> Vec<Table> {
        [SUPPORTS.table(records), SCHEMES.table(records)].into_iter().flatten().collect()
    }
}

/// What is wanted at a closing speed in km/s: error of pressure and shock speed, and noise.
fn bounds(speed: &str) -> (f64, f64) {
    match speed {
        "7" => (0.03, 0.03),
        "4" => (0.01, 0.04),
        _ => (0.01, 0.01),
    }
}

/// A panel in per cent with the noise that is wanted at every speed.
fn with_bounds(panel: Panel) -> Panel {
    let wanted = [("2", "to 2 km/s"), ("7", "at 7 km/s"), ("4", "at 4 km/s")];
    let panel = panel.with(Layer::vertical(-MARGIN, ""));
    wanted.into_iter().fold(panel, |panel, (speed, text)| {
        let bound = 100.0 * bounds(speed).1;
        panel
            .with(Layer::horizontal(bound, format!("wanted {text}")))
            .with(Layer::horizontal(-bound, ""))
    })
}

/// A name and the points of a line.
type Curve = (String, Vec<Point>);

/// Pressures over the exact one by place, at all speeds.
fn pressures(records: &Records, metals: &str) -> Vec<Curve> {
    let runs = SPEEDS.iter().filter_map(|speed| {
        // The plain variant has no name.
        let variant = if (metals, *speed) == ("cu", "1") {
            String::new()
        } else {
            format!("{metals}-{speed}")
        };
        let record = records.get(&default_run(ID, SIZES[1]).variant(&variant))?;
        let exact = Shot::of(&variant).exact().ok()?.target.pressure;
        let points = record.profile.as_ref()?.points("place", "pressure");
        Some((format!("{speed} km/s"), points.into_iter().map(|p| (p.0, p.1 / exact)).collect()))
    });
    runs.collect()
}

/// The same by the number of cells from where they are a half.
fn pressures_at_the_front(records: &Records, metals: &str) -> Vec<Curve> {
    let cell = LENGTH / SIZES[1] as f64;
    let runs = pressures(records, metals).into_iter().filter_map(|(name, points)| {
        let front = last_fall(points.iter().copied(), 0.5)?;
        Some((name, points.into_iter().map(|p| ((p.0 - front) / cell, p.1)).collect()))
    });
    runs.collect()
}

/// How far the same are off the exact one, in per cent.
fn noise_behind_the_front(records: &Records, metals: &str) -> Vec<Curve> {
    let off = |points: Vec<Point>| points.into_iter().map(|p| (p.0, 100.0 * (p.1 - 1.0))).collect();
    let runs = pressures_at_the_front(records, metals).into_iter();
    runs.map(|(name, points)| (name, off(points))).collect()
}
