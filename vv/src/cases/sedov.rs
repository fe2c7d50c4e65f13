//! The Sedov blast in an octant.

use whipple_solver::method::Preset;
use whipple_solver::space::method::Method;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Body, Scene, Shape, Side};

use super::figures::{beside_exact, figure, profiles};
use super::parts::shells::{radius, shells};
use super::parts::{Columns, gas_scene, mirror, moments, motion, resting, zonal};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run};
use crate::exact::sedov::Sedov as Exact;
use crate::exact::{Gas, Geometry};
use crate::plots::{Axis, Figure, Panel};
use crate::record::{Records, RunKey};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct Sedov;

const ID: &str = "sedov";
const GAMMA: f64 = 1.4;
const GEOMETRY: Geometry = Geometry::Spherical;
/// Energy of the whole blast, whose shock is at 1 at the end of the run.
const ENERGY: f64 = 0.851_072;
const STOP: f64 = 1.0;
/// Edge of the octant of a cube.
const EDGE: f64 = 1.2;
/// Internal energy per mass of the cold gas.
const COLD: f64 = 1e-6;
/// Specific heat.
const HEAT: f64 = 1.0;
/// Coefficient of the viscous pressure of pyramids, which cold gas needs (decision 0013).
const VOLUME_VISCOSITY: f64 = 2.0;
/// First entry of the run, over its end: the first step knows of no pressure gradient yet.
const FIRST: f64 = 1e-6;
/// Radii between which the pressure of the hot inside is compared, as in Noh's problem.
const HOT: [f64; 2] = [0.3, 0.8];
/// Part of the exact pressure by which it may be off there.
const SWING: f64 = 0.1;
/// Order of errors wanted at least.
const ORDER: f64 = 0.8;
/// Cells along the edge.
const SIZES: [usize; 3] = [16, 24, 32];

fn exact() -> Result<Exact, RunError> {
    Ok(Exact::new(GEOMETRY, GAMMA, 1.0, ENERGY)?)
}

impl Case for Sedov {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Sedov blast in three dimensions"
    }

    fn about(&self) -> &'static str {
        "An octant of a cube of cold gas, gamma 1.4, between mirrors gets the energy of a point blast in \
         the particles of its innermost corner, up to a cell away; the shock is to be at radius 1 at \
         t = 1. The energy is set in the state, so that no scene states it. The viscous pressure \
         of pyramids is on (`visc_volume` 2), and they have the stiffness of the gas against being denser \
         than their cell (`hourglass` 1, decision 0017). The radius of the shock is where the mean pressure of shells \
         falls below half of that behind the exact shock, scatter the root mean square of the density \
         between 0.85 and 0.95 about the mean of its shell. In the hot inside, from 0.3 to 0.8, the \
         pressure of shells half a cell thick is compared with the exact one, and that of particles \
         with the mean of their shell, as root mean squares over the exact pressure. n counts the \
         cells along the edge of 1.2."
    }

    fn source(&self) -> &'static str {
        "Sedov (1959), Kamm and Timmes (2007); energy of the ExactPack example"
    }

    fn default_size(&self) -> usize {
        SIZES[1]
    }

    fn scene(&self, preset: Preset, _: &str, n: usize) -> AnyScene {
        let body = Body {
            energy: COLD,
            ..resting("gas", Shape::Box { size: [EDGE; 3] }, [n; 3], [0.5 * EDGE; 3])
        };
        let method = Method { visc_volume: VOLUME_VISCOSITY, ..zonal(preset) };
        let walls = (0..3).map(|axis| mirror(axis, 0.0, Side::Above)).collect();
        gas_scene(ID, STOP, method, walls, [GAMMA, HEAT], body).into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let exact = exact()?;
        let cell = EDGE / key.n as f64;
        let inside = |p: &Particle| radius(GEOMETRY, p.position) < 1.01 * cell;
        driver.prepare(|simulation| {
            let mass: f64 = simulation.all_particles().filter(inside).map(|p| p.mass).sum();
            let hot = ENERGY / 8.0 / mass;
            motion::heat(simulation, [GAMMA, HEAT], |p| if inside(p) { hot } else { COLD })
        })?;
        driver.advance_to(FIRST * scene.stop_time)?;
        driver.advance_to(scene.stop_time)?;
        let balance = driver.balance();
        let solver = driver.solver();
        let time = solver.time();
        let (place, behind) = (exact.shock_position(time)?, exact.behind(time)?);
        let means = shells(solver, GEOMETRY, [0.5 * cell, EDGE]);
        let front = super::parts::shells::edge(&means, |s| s.pressure, 0.5 * behind.pressure);
        let near: Vec<f64> = solver
            .all_particles()
            .filter_map(|p| {
                let r = radius(GEOMETRY, p.position);
                let shell = means
                    .iter()
                    .min_by(|a, b| (a.radius - r).abs().total_cmp(&(b.radius - r).abs()))?;
                (r > 0.85 && r < 0.95).then_some(p.rho - shell.density)
            })
            .collect();
        let [mut misfit, mut volume] = [0.0; 2];
        for p in solver.all_particles() {
            let r = radius(GEOMETRY, p.position);
            if r < 1.1 {
                let wanted = exact.sample(r, time)?;
                let own = p.mass / p.rho;
                volume += own;
                misfit += own * (p.rho - wanted.density).abs() / behind.density;
            }
        }
        // Squares of how far pressures are off, over the exact one: of shells, and within them.
        let [mut off, mut within, mut count] = [0.0; 3];
        for s in means.iter().filter(|s| s.radius > HOT[0] && s.radius < HOT[1]) {
            let wanted = exact.sample(s.radius, time)?.pressure;
            off += (s.pressure / wanted - 1.0).powi(2);
            within += (s.pressure_scatter / wanted).powi(2);
            count += 1.0;
        }
        let peak = means.iter().map(|s| s.density).fold(0.0, f64::max);
        let mut findings = Findings::default();
        findings.enter("shock_error", front.unwrap_or(f64::NAN) / place - 1.0);
        findings.enter("peak_density", peak);
        findings.enter("peak_over_exact", peak / behind.density);
        findings.enter("scatter", moments(&near).1 / behind.density);
        findings.enter("density_l1", misfit / volume);
        findings.enter(
            "centre_pressure_over_exact",
            means[0].pressure / exact.sample(means[0].radius, time)?.pressure,
        );
        findings.enter("pressure_of_shells", (off / count).sqrt());
        findings.enter("pressure_within_shells", (within / count).sqrt());
        findings.enter("kinetic_share", balance.now.kinetic / balance.now.energy());
        findings.enter("dead_elements", solver.failed().1 as f64);
        let mut profile = Columns::default();
        for s in &means {
            let wanted = exact.sample(s.radius, time)?;
            profile.row([
                ("radius", s.radius),
                ("density", s.density),
                ("pressure", s.pressure),
                ("exact_density", wanted.density),
                ("exact_pressure", wanted.pressure),
            ]);
        }
        findings.profile = Some(profile.series());
        Ok(findings)
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        level.first(&SIZES).iter().map(|&n| default_run(ID, n)).collect()
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "exact solution; 2 % at 64 cells by `references/verification_problems.toml`";
        let aim = Claims::new(ID, Kind::Verification, Weight::Aim, source);
        let mut out = vec![aim.claim(
            "radius of the shock, error",
            Quantity::Norm(default_run(ID, SIZES[2]), "shock_error"),
            Wanted::WithinZero(0.02),
        )];
        let swing = Claims {
            source: "10 % as on the plateaus of Noh's problem, `references/verification_problems.toml`",
            ..aim
        };
        let order = Claims {
            source: "order of the L1 error of Noh's problem, `references/verification_problems.toml`",
            ..swing
        };
        let quantities = [
            ("pressure_of_shells", "pressure of shells in the hot inside"),
            ("pressure_within_shells", "pressure within shells in the hot inside"),
        ];
        for (name, text) in quantities {
            let last = Quantity::Norm(default_run(ID, SIZES[2]), name);
            out.push(swing.claim(format!("{text}, rms"), last, Wanted::AtMost(SWING)));
            let all = Quantity::Order(SIZES.map(|n| default_run(ID, n)).into(), name);
            out.push(order.claim(format!("{text}, order"), all, Wanted::AtLeast(ORDER)));
        }
        out.extend(super::conservation_in_space(ID, &default_run(ID, SIZES[0])));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("shock_error", "error of the shock's radius"),
            ("peak_over_exact", "peak density / exact"),
            ("scatter", "scatter"),
            ("density_l1", "L1 of density"),
            ("centre_pressure_over_exact", "pressure of the centre / exact"),
            ("pressure_of_shells", "pressure of shells, rms error"),
            ("pressure_within_shells", "pressure within shells, rms"),
            ("kinetic_share", "kinetic share of energy"),
            ("dead_elements", "dead elements"),
        ]
    }

    fn errors(&self) -> &'static [&'static str] {
        &["shock_error", "density_l1", "pressure_of_shells", "pressure_within_shells"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let runs = profiles(records, SIZES.map(|n| (format!("n = {n}"), default_run(ID, n))));
        let Ok(exact) = exact() else { return Vec::new() };
        type Field = (&'static str, fn(&Gas) -> f64);
        let fields: [Field; 2] = [("density", |gas| gas.density), ("pressure", |gas| gas.pressure)];
        let panels = fields.into_iter().filter_map(|(name, of)| {
            let panel = Panel::new("", Axis::linear("radius"), Axis::linear(name));
            let field = |r: f64| exact.sample(r, STOP).map(|gas| of(&gas));
            beside_exact(panel, &runs, ["radius", name], "exact", field)
        });
        let caption =
            "Density and pressure over the radius at t = 1, means of thin shells by mass.";
        figure("sedov-profiles", caption, panels)
    }
}
