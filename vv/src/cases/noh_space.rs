//! The Noh implosion in three dimensions: onto a plane, an axis and a centre.

use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::scene::{Body, Scene, Shape, Side};

use super::figures::{beside_exact, figure, profiles};
use super::parts::schemes::{Error, Schemes};
use super::parts::shells::{edge, outward, radius, shells};
use super::parts::supports::{self, Supports};
use super::parts::{Columns, gas_scene, mirror, moments, motion, resting, zonal};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run, named};
use crate::exact::Geometry;
use crate::exact::noh::Noh as Exact;
use crate::plots::{Axis, Figure, Panel};
use crate::record::{Records, RunKey};
use crate::report::Table;
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct NohSpace;

const ID: &str = "noh-space";
const GAMMA: f64 = 5.0 / 3.0;
/// Specific heat.
const HEAT: f64 = 1.0;
/// Time at which the shock has come to 0.2.
const STOP: f64 = 0.6;
/// Internal energy of the cold gas, over that behind the shock.
const COLD: f64 = 1e-6;
/// Cells along what is left of a direction without flow.
const ACROSS: usize = 2;
/// Radius up to which errors are measured.
const REACH: f64 = 0.35;
/// Part of the radius of the shock over which the state behind it is averaged.
const INSIDE: [f64; 2] = [0.3, 0.8];
/// Order of the L1 error wanted at least, as along a line.
const ORDER: f64 = 0.8;
/// First entry of the run, over its end: the first step knows of no wave yet.
const FIRST: f64 = 1e-4;
const PLANAR: &str = "planar";
const CYLINDRICAL: &str = "cylindrical";
const SPHERICAL: &str = "spherical";
/// The geometries by their variants.
const GEOMETRIES: [&str; 3] = ["", CYLINDRICAL, SPHERICAL];
/// Cells along the unit of length.
const SIZES: [usize; 3] = [8, 16, 24];
/// All variants: the geometries, and the supports.
const VARIANTS: [&str; 8] = supports::after(GEOMETRIES);
/// Which density is cheaper at equal error, in the planar shock.
const SCHEMES: Schemes =
    Schemes { case: ID, sizes: &SIZES, error: Error::Norm("density_l1"), name: "the density, L1" };
/// Which support serves the kernel best, there.
const SUPPORTS: Supports = Supports {
    case: ID,
    n: SIZES[1],
    errors: &[
        ("density_l1", "density, L1"),
        ("density_error", "mean density behind the shock"),
        ("scatter", "scatter of the density"),
    ],
};

fn geometry(variant: &str) -> Geometry {
    match variant {
        CYLINDRICAL => Geometry::Cylindrical,
        SPHERICAL => Geometry::Spherical,
        _ => Geometry::Planar,
    }
}

fn exact(geometry: Geometry) -> Result<Exact, RunError> {
    Ok(Exact::new(geometry, GAMMA, 1.0, 1.0)?)
}

/// Densities behind the shock of particles away from the centre.
fn behind(simulation: &Simulation, geometry: Geometry, shock: f64) -> Vec<f64> {
    let [from, to] = INSIDE.map(|part| part * shock);
    let inside = |r: f64| r > from && r < to;
    let all = simulation.all_particles();
    all.filter(|p| inside(radius(geometry, p.position))).map(|p| p.rho).collect()
}

impl Case for NohSpace {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Noh implosion in three dimensions"
    }

    fn about(&self) -> &'static str {
        "Cold gas runs at speed 1 onto a plane, an axis or a centre, where a shock stands off at a third \
         of that speed: a column, a quarter of a slab and an octant of a cube between mirrors, of edge 1, \
         to t = 0.6. Compression behind the shock is 4, 16 and 64. Velocities are set in the state: no \
         scene states them. Pyramids have the stiffness of the gas against being denser than their \
         cell (`hourglass` 1, decision 0017). Cells on the axis and in the centre end as slivers: the \
         few that die are counted, and their particles have the density of contacts. Density is \
         averaged from 0.3 to 0.8 of the radius of the exact shock, scatter is the root mean square \
         about that mean over the exact density, L1 is by exact volume to r = 0.35; the shock is where the \
         mean density of shells falls below half of its jump, and has no place where it nowhere comes up to that. n counts the cells along the unit of length."
    }

    fn source(&self) -> &'static str {
        "Noh (1987); `references/noh_exact.csv`"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        SIZES[2]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let flows = geometry(variant).dimension() as usize;
        let thin = ACROSS as f64 / n as f64;
        let size: [f64; 3] = std::array::from_fn(|d| if d < flows { 1.0 } else { thin });
        let cells: [usize; 3] = std::array::from_fn(|d| if d < flows { n } else { ACROSS });
        let mut walls: Vec<_> = (0..3).map(|axis| mirror(axis, 0.0, Side::Above)).collect();
        walls.extend((flows..3).map(|axis| mirror(axis, thin, Side::Below)));
        let body = Body {
            energy: 0.5 * COLD,
            ..resting("gas", Shape::Box { size }, cells, size.map(|edge| 0.5 * edge))
        };
        gas_scene(ID, STOP, supports::apply(zonal(preset), variant), walls, [GAMMA, HEAT], body)
            .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let geometry = geometry(&key.variant);
        let exact = exact(geometry)?;
        let flows = geometry.dimension() as usize;
        driver.prepare(|simulation| {
            motion::start(simulation, |p| {
                let r = radius(geometry, p.position);
                let inwards =
                    |d: usize| if d < flows && r > 0.0 { -p.position[d] / r } else { 0.0 };
                std::array::from_fn(inwards)
            })
        })?;
        driver.advance_to(FIRST * scene.stop_time)?;
        driver.advance_to(scene.stop_time)?;
        driver.balance();
        let solver = driver.solver();
        let time = solver.time();
        let shock = exact.shock_position(time);
        let state = exact.behind();
        let (density, scatter) = moments(&behind(solver, geometry, shock));
        let shells = shells(solver, geometry, [1.0 / key.n as f64 / 8.0, REACH]);
        let level = 0.5 * (exact.ahead().density + state.density);
        let [mut misfit, mut speed, mut volume] = [0.0; 3];
        for p in solver.all_particles() {
            let r = radius(geometry, p.position);
            if r < REACH {
                let wanted = exact.sample(r, time)?;
                let own = p.mass / wanted.density;
                volume += own;
                misfit += own * (p.rho - wanted.density).abs() / state.density;
                speed += own * (outward(geometry, &p) - wanted.velocity).abs();
            }
        }
        let mut findings = Findings::default();
        findings.enter("density", density);
        findings.enter("density_error", density / state.density - 1.0);
        findings.enter("scatter", scatter / state.density);
        // A density that never comes to half of its jump has no shock to be placed.
        let found = edge(&shells, |s| s.density, level).unwrap_or(f64::NAN);
        findings.enter("shock_error", found / shock - 1.0);
        findings.enter("density_l1", misfit / volume);
        findings.enter("velocity_l1", speed / volume);
        findings.enter("dead_elements", solver.failed().1 as f64);
        let mut profile = Columns::default();
        for s in &shells {
            let wanted = exact.sample(s.radius, time)?;
            profile.row([("radius", s.radius), ("density", s.density), ("exact", wanted.density)]);
        }
        findings.profile = Some(profile.series());
        Ok(findings)
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let sizes = level.first(&SIZES).iter();
        let all = sizes.flat_map(|&n| GEOMETRIES.map(|v| default_run(ID, n).variant(v)));
        let rivals = [SCHEMES.runs(), SUPPORTS.runs()].concat();
        all.chain(rivals.into_iter().filter(|_| level == Level::Full)).collect()
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "exact solution; tolerances of `references/verification_problems.toml`";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let aim = Claims { weight: Weight::Aim, ..must };
        let swings = Claims { source: "the tolerance of the mean, of every particle", ..aim };
        let mut out = Vec::new();
        for variant in GEOMETRIES {
            let name = named(variant, PLANAR);
            let within = Wanted::WithinZero;
            let share = if name == PLANAR { 0.01 } else { 0.1 };
            for (claims, text, norm, wanted) in [
                (aim, "density behind the shock, error", "density_error", within(share)),
                (aim, "radius of the shock, error", "shock_error", within(0.03)),
                (swings, "density behind the shock, scatter", "scatter", Wanted::AtMost(share)),
            ] {
                let found = Quantity::Norm(default_run(ID, SIZES[2]).variant(variant), norm);
                out.push(claims.claim(format!("{name}: {text}"), found, wanted));
            }
            out.push(aim.claim(
                format!("{name}: order of the L1 error of the density"),
                Quantity::Order(
                    SIZES.map(|n| default_run(ID, n).variant(variant)).into(),
                    "density_l1",
                ),
                Wanted::AtLeast(ORDER),
            ));
            out.extend(super::conservation_in_space(
                ID,
                &default_run(ID, SIZES[0]).variant(variant),
            ));
        }
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("density", "density behind"),
            ("density_error", "its error"),
            ("scatter", "scatter"),
            ("shock_error", "error of the shock's radius"),
            ("density_l1", "L1 of density"),
            ("velocity_l1", "L1 of velocity"),
            ("dead_elements", "dead elements"),
        ]
    }

    fn errors(&self) -> &'static [&'static str] {
        &["density_error", "shock_error", "density_l1", "velocity_l1"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let panels = GEOMETRIES.iter().filter_map(|variant| {
            let [radius, density] = ["radius", "density"].map(Axis::linear);
            let runs = SIZES.map(|n| (format!("n = {n}"), default_run(ID, n).variant(variant)));
            let panel = Panel::new(named(variant, PLANAR), radius, density);
            let exact = exact(geometry(variant)).ok()?;
            let field = |r: f64| exact.sample(r, STOP).map(|gas| gas.density);
            beside_exact(panel, &profiles(records, runs), ["radius", "density"], "exact", field)
        });
        let caption = "Density over the distance from plane, axis and centre at t = 0.6, means of thin \
                       shells by mass.";
        let mut figures = figure("noh-space-density", caption, panels);
        figures.extend([SUPPORTS.figure(records), SCHEMES.figure(records)].into_iter().flatten());
        figures
    }

    fn extra_tables(&self, records: &Records) -> Vec<Table> {
        [SUPPORTS.table(records), SCHEMES.table(records)].into_iter().flatten().collect()
    }
}
