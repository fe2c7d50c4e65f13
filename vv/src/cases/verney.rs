//! Verney's shell: a tube of metal that flies inwards until its plastic work is done.

use std::f64::consts::FRAC_PI_2;

use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::mapping::Mapping;
use whipple_solver::space::scene::{
    Body, EosData, Failure, Flow, GammaLaw, Material, Scene, Shape, Side, Strength,
};
use whipple_solver::units::Units;

use super::figures::{curves, exact_line, extent, figure, histories, over};
use super::parts::shells::radius;
use super::parts::{Columns, control, mirror, moments, motion, resting};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run};
use crate::exact::Geometry;
use crate::exact::verney::{Collapse, Shell};
use crate::plots::{Axis, Figure, Panel};
use crate::record::{Records, RunKey};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;
use crate::space::picture::{Shot, Shown, onto_the_section, shoot};

/// The case.
pub(super) struct Verney;

const ID: &str = "verney";
const GEOMETRY: Geometry = Geometry::Cylindrical;
/// Inner and outer radius in cm.
const RADII: [f64; 2] = [8.0, 10.0];
/// Inner radius at rest, and half of the way to it.
const REST: f64 = 4.0;
const HALF: f64 = 6.0;
/// Density of beryllium, yield stress and shear modulus in Mbar.
const DENSITY: f64 = 1.845;
const YIELD: f64 = 0.0033;
const SHEAR: f64 = 1.510;
/// `c0`, `s`, Grueneisen's coefficient and specific heat of beryllium, recalled and not looked up: the exact
/// shell is incompressible and knows none of them.
const SOLID: [f64; 4] = [0.8, 1.124, 1.11, 1.82e-5];
/// Cells along the axis of the tube.
const ALONG: usize = 2;
/// End of the run over the exact time of rest.
const LATE: f64 = 1.2;
/// Entries of the history.
const ENTRIES: usize = 120;
/// Caption of the picture.
const PICTURE: &str = "Elements of the quarter of the tube at the end of the run, seen along its axis and \
                       coloured by temperature; n = 8. The inner surface should be a circle: it has \
                       buckled, and waves of it reach into the wall, which is hotter where they are.";
/// Cells through the wall of the tube.
const SIZES: [usize; 3] = [4, 8, 16];
const VARIANTS: [&str; 3] = ["", control::HOURGLASS, control::CENTRING];

/// Names of the columns of the history that are read off the state.
const COLUMNS: [&str; 6] = ["inner", "outer", "roundness", "kinetic", "plastic", "elastic"];

fn exact() -> Result<Collapse, RunError> {
    let [inner, outer] = RADII;
    Ok(Shell::new(GEOMETRY, inner, outer, [DENSITY, YIELD])?.stopping_at(REST)?)
}

/// Elastic, perfectly plastic beryllium that never fails.
fn beryllium() -> Material {
    let [c0, s, gamma_0, c_v] = SOLID;
    let flow = Flow::Hardening {
        y_0: YIELD,
        kappa: 0.0,
        alpha: 1.0,
        eta: 0.0,
        reference: 300.0,
        melt: 1560.0,
    };
    Material {
        name: "beryllium".into(),
        density: DENSITY,
        eos: EosData::MieGruneisen {
            c0,
            s,
            gamma_0,
            law: GammaLaw::ConstantProduct,
            c_v,
            theta_0: 300.0,
        },
        strength: Some(Strength { shear_modulus: SHEAR, flow: Some(flow) }),
        failure: Failure::default(),
    }
}

/// Particles of a surface.
struct Surface(Vec<u32>);

impl Surface {
    /// Those of a new simulation at this radius.
    fn new(simulation: &Simulation, at: f64) -> Self {
        let on = simulation
            .all_particles()
            .filter(|p| (radius(GEOMETRY, p.position) / at - 1.0).abs() < 1e-9);
        Self(on.map(|p| p.id).collect())
    }

    /// Their mean distance from the axis, and the root mean square about it.
    fn look(&self, simulation: &Simulation) -> (f64, f64) {
        let radii = self.0.iter().map(|&id| radius(GEOMETRY, simulation.particle(id).position));
        moments(&radii.collect::<Vec<f64>>())
    }
}

impl Case for Verney {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Verney's shell, as a tube"
    }

    fn about(&self) -> &'static str {
        "A tube of elastic, perfectly plastic beryllium, 8 to 10 cm in radius, flies inwards with the \
         field of velocity of an incompressible shell, -v a/r, whose inner surface starts at 490 m/s: \
         the speed for which the work of rigid-plastic flow stops it at 4 cm. A quarter of the tube, bent from a box, \
         between mirrors, in plane strain. The velocity is set in the state: no scene states it. The radii are means \
         over the particles of the surfaces; that at rest is the smallest of 120 in 1.2 times the exact time of \
         rest, half way is where the exact one is 6 cm; roundness is the largest root mean square of the inner radius about its mean. The \
         plastic work is the heat of the flow at the end over the kinetic energy of the start; what it lacks of one \
         is elastic energy, pressure work and viscous heat. n counts the cells \
         through the wall, two along the axis."
    }

    fn source(&self) -> &'static str {
        "LA-14379 (2008), Howell and Ball (2002); `verney` in `references/verification_problems.toml`, \
         the cylindrical form of `references/materials.toml`'s `beryllium_verney`"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        SIZES[1]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let [inner, outer] = RADII;
        let (wall, middle) = (outer - inner, 0.5 * (inner + outer));
        let arc = FRAC_PI_2 * middle;
        let round = (arc / wall * n as f64).round() as usize;
        let depth = ALONG as f64 * wall / n as f64;
        let shape = Shape::Box { size: [wall, arc, depth] };
        let centre = [middle, 0.5 * arc, 0.5 * depth];
        let body = Body {
            mapping: Some(Mapping::Wrap { radius: middle }),
            ..resting("beryllium", shape, [n, round, ALONG], centre)
        };
        let mut walls: Vec<_> = (0..3).map(|axis| mirror(axis, 0.0, Side::Above)).collect();
        walls.push(mirror(2, depth, Side::Below));
        Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: LATE * exact().map_or(0.0, |exact| exact.stop_time()),
            method: control::controlled(preset.space(), variant),
            walls,
            materials: vec![beryllium()],
            bodies: vec![body],
        }
        .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let exact = exact()?;
        let [inner, outer] = RADII.map(|at| Surface::new(driver.solver(), at));
        let moment = exact.initial_speed() * RADII[0];
        driver.prepare(|simulation| {
            motion::start(simulation, |p| {
                let [x, y, _] = p.position;
                let square = x * x + y * y;
                [-moment * x / square, -moment * y / square, 0.0]
            })
        })?;
        let mut history = Columns::default();
        for k in 1..=ENTRIES {
            let time = scene.stop_time * k as f64 / ENTRIES as f64;
            driver.advance_to(time)?;
            let now = driver.look(|solver, balance| {
                let (at, uneven) = inner.look(solver);
                let initial = balance.initial.kinetic;
                vec![
                    at,
                    outer.look(solver).0,
                    uneven / at,
                    balance.now.kinetic / initial,
                    balance.element_heat / initial,
                    (balance.now.shear + balance.now.tension) / initial,
                ]
            })?;
            history.row([("time", time), ("exact", exact.inner_radius(time)?)]);
            history.read(&COLUMNS, &now);
        }
        if *key == default_run(ID, SIZES[1]) {
            driver.photograph("verney-end", PICTURE, |simulation| {
                let (title, camera) = ("The tube after its collapse".into(), onto_the_section());
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
        let last = |name: &str| history.column(name).last().copied().unwrap_or(f64::NAN);
        let (at, rest) = history
            .column("inner")
            .iter()
            .copied()
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((0, f64::NAN));
        let way = history.column("inner").iter().zip(history.column("exact"));
        let away = way.map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max);
        let roundness = history.column("roundness").iter().copied().fold(0.0, f64::max);
        let half = history.column("exact").iter().position(|&exact| exact <= HALF);
        let half =
            half.map_or(f64::NAN, |at| history.column("inner")[at] - history.column("exact")[at]);
        let full = Shell::new(GEOMETRY, RADII[0], RADII[1], [DENSITY, YIELD])?;
        let mut findings = Findings::default();
        let mut enter = |name: &str, value: f64| findings.norms.insert(name.into(), value);
        enter("rest_cm", rest);
        enter("rest_error_cm", rest - REST);
        enter("outer_error_cm", history.column("outer")[at] - full.outer_radius(REST)?);
        enter("rest_time_error", history.column("time")[at] / exact.stop_time() - 1.0);
        enter("half_way_error_cm", half);
        enter("way_error_cm", away);
        enter("roundness", roundness);
        for name in ["plastic", "kinetic", "elastic"] {
            enter(&format!("{name}_share"), last(name));
        }
        enter("failed_elements", driver.solver().failed().0 as f64);
        findings.history = Some(history.series());
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("time", "µs"),
            ("exact", "cm"),
            ("inner", "cm"),
            ("outer", "cm"),
            ("roundness", ""),
            ("kinetic", ""),
            ("plastic", ""),
            ("elastic", ""),
        ]
    }

    fn draws(&self, key: &RunKey) -> bool {
        key.variant.is_empty()
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let mut keys: Vec<RunKey> =
            level.first(&SIZES).iter().map(|&n| default_run(ID, n)).collect();
        if level >= Level::Standard {
            keys.extend(control::runs(&default_run(ID, SIZES[1])));
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let source =
            "exact solution; tolerance of `verney` in `references/verification_problems.toml`";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let mut out = vec![must.claim(
            "inner radius at rest, error in cm",
            Quantity::Norm(default_run(ID, SIZES[2]), "rest_error_cm"),
            Wanted::WithinZero(0.1),
        )];
        let answers = [("rest_cm", "inner radius at rest")];
        out.extend(control::claims(ID, &default_run(ID, SIZES[1]), &answers));
        out.extend(super::conservation_in_space(ID, &default_run(ID, SIZES[0])));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("rest_error_cm", "error of the inner radius at rest, cm"),
            ("outer_error_cm", "of the outer radius, cm"),
            ("rest_time_error", "error of the time of rest, to 0.01"),
            ("half_way_error_cm", "error half way, cm"),
            ("way_error_cm", "largest error on the way, cm"),
            ("roundness", "roundness"),
            ("plastic_share", "plastic work / kinetic energy"),
            ("kinetic_share", "kinetic energy left"),
            ("elastic_share", "elastic energy"),
        ]
    }

    fn decimals(&self, norm: &str) -> Option<usize> {
        // The time of rest is that of an entry of the history: they are a hundredth of the exact one apart.
        (norm == "rest_time_error").then_some(2)
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let runs = histories(records, SIZES.map(|n| (format!("n = {n}"), default_run(ID, n))));
        let panel = |label: &str| Panel::new("", Axis::linear("time, µs"), Axis::linear(label));
        let apart = runs.iter().map(|(name, history)| {
            let [found, wanted] = ["inner", "exact"].map(|column| history.points("time", column));
            let apart = found.iter().zip(&wanted).map(|(a, b)| (a.0, a.1 - b.1)).collect();
            (name.clone(), apart)
        });
        let error = curves(panel("less the exact one, cm"), apart);
        let way = curves(panel("inner radius, cm"), over(&runs, "time", "inner"));
        let exact = exact().ok().map(|exact| {
            exact_line("exact", extent(&runs, "time"), |time| exact.inner_radius(time))
        });
        let way = way.zip(exact).map(|(way, exact)| way.with(exact));
        let caption = "Mean inner radius of the tube over time, and its difference from the exact one, that of \
                       a rigid, perfectly plastic shell.";
        figure("verney-radius", caption, way.into_iter().chain(error))
    }
}
