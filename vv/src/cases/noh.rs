//! Noh's wall shock: the paper's first problem, with the parameters of its Table 1.

mod claims;
mod errors;
mod figures;
mod tables;
mod variants;

use whipple_solver::method::Preset;
use whipple_solver::output::Snapshot;
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};
use whipple_solver::units::Units;

use self::errors::{Errors, Phases, at_stop, exact, plateau_density, profile, state};
use self::variants::{SUPPORTS, VARIANTS, variants_of, varied};
use super::gas::eulerian_drift;
use super::{Case, Claim, Eulerian, Level, both_presets, kernel_default, run_of};
use crate::exact::Gas;
use crate::godunov::{self, Domain, Godunov};
use crate::plots::Figure;
use crate::record::{Records, RunKey, Scheme};
use crate::report::Table;
use crate::run::{Driver, Findings, RunError};
use crate::scene::AnyScene;

/// The case.
pub(super) struct Noh;

const ID: &str = "noh";
/// Table 1.
const GAMMA: f64 = 5.0 / 3.0;
const U_0: f64 = 1.0;
const THETA_0: f64 = 1.0;
/// Text of the paper: fluid in 0 < x < 0.5, speed 1 to the wall, stopped at 0.3.
const LENGTH: f64 = 0.5;
const STOP: f64 = 0.3;
const SIZES: &[usize] = &[100, 200, 400, 800];
/// Size of the paper's Figures 1 to 4.
const DRAWN: usize = 200;
/// Stop times over which a norm is averaged: the shock crosses one particle meanwhile.
const PHASES: u32 = 64;

/// Schemes of the comparison figures.
fn schemes() -> [Scheme; 4] {
    [
        Scheme::preset(Preset::Paper),
        Scheme::preset(Preset::Default),
        kernel_default(),
        Scheme::Godunov,
    ]
}

impl Case for Noh {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Noh's wall shock"
    }

    fn about(&self) -> &'static str {
        "Cold gas (γ = 5/3) runs into a rigid wall at speed 1; a shock of density 4 returns at speed \
         1/3. The paper's first problem, with its Table 1. Every method that captures shocks is \
         wrong over a fixed number of particles here, so that RMS norms fall as n^-1/2 and L1 norms \
         as 1/n; n·rms² counts the wrong particles. The norms of a sharp method swing with the place \
         of the shock between two particles: they are given at t = 0.3, where the paper has them, and \
         averaged over the 64 phases of one crossing."
    }

    fn source(&self) -> &'static str {
        "paper, Table 1 and text; Noh, J. Comput. Phys. 72 (1987) 78; exact solution"
    }

    fn variants(&self) -> &'static [&'static str] {
        VARIANTS
    }

    fn default_size(&self) -> usize {
        DRAWN
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let eos =
            EosData::IdealGas { adiabatic_index: GAMMA, c_v: 1.0, u_0: U_0, theta_0: THETA_0 };
        Scene {
            name: ID.into(),
            units: Units::None,
            stop_time: STOP,
            method: varied(preset.method(), variant),
            boundaries: Boundaries { left: Boundary::Mirror(0.0), right: Boundary::Free },
            materials: vec![Material { name: "gas".into(), density: 1.0, eos }],
            bodies: vec![Body {
                material: "gas".into(),
                from: 0.0,
                to: LENGTH,
                particles: n,
                layout: Layout::Centres,
                compression: 1.0,
                interface: Interface::Joined,
                velocity: Profile::Uniform(-1.0),
                energy: Profile::Uniform(U_0),
            }],
        }
        .into()
    }

    fn measure(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut Driver<'_>,
    ) -> Result<Findings, RunError> {
        let exact = exact()?;
        let errors = |s: &Snapshot| {
            let theta: Vec<f64> = s.theta.iter().map(|t| t - THETA_0).collect();
            Errors::new(&s.x, &s.v, &theta, |x| state(&exact, x, s.time))
        };
        driver.advance_to(scene.stop_time)?;
        driver.stop_clock();

        let s = driver.solver().snapshot();
        let mut findings = at_stop(&errors(&s), &s.m)?;
        findings.enter("plateau_density", plateau_density(&s.x, &s.rho));
        let mut phases = Phases::default();
        phases.add(&s.x, (&s.lengths(), &s.m), &errors(&s))?;
        // The shock passes particles at 1/3 + 1 times their initial spacing.
        let crossing = LENGTH / key.n as f64 / (4.0 / 3.0);
        for phase in 1..PHASES {
            let time = scene.stop_time + crossing * f64::from(phase) / f64::from(PHASES);
            let s = driver.sample_at(time)?;
            phases.add(&s.x, (&s.lengths(), &s.m), &errors(&s))?;
        }
        phases.enter(&mut findings)?;
        let columns = [
            ("velocity", s.v),
            ("density", s.rho),
            ("pressure", s.pressure),
            ("temperature", s.theta),
        ];
        findings.profile = Some(profile(columns, s.x, &exact));
        Ok(findings)
    }

    fn eulerian(&self, _: &str, n: usize) -> Result<Eulerian, RunError> {
        let exact = exact()?;
        let far = Gas { pressure: super::gas::COLD_PRESSURE, ..exact.ahead() };
        let domain = Domain {
            start: 0.0,
            end: LENGTH,
            left: godunov::Boundary::Wall,
            right: godunov::Boundary::Inflow(far),
            cfl: 0.5,
        };
        let mut code = Godunov::new(domain, &vec![far; n])?;
        let before = code.totals();
        let x: Vec<f64> = code.centres().collect();
        let width = vec![code.width(); n];
        let column = |code: &Godunov, of: fn(&Gas) -> f64| -> Vec<f64> {
            code.cells().map(|g| of(&g)).collect()
        };
        let errors = |code: &Godunov, t: f64| {
            let (v, theta) = (column(code, |g| g.velocity), column(code, Gas::energy));
            Errors::new(&x, &v, &theta, |x| state(&exact, x, t))
        };
        let start = cpu_time::ProcessTime::now();
        code.advance_to(STOP)?;
        let cpu = Some(start.elapsed());
        let (work, energy_drift) = (code.work(), eulerian_drift(&code, before));

        let mass = |code: &Godunov| -> Vec<f64> {
            code.cells().map(|g| g.density * code.width()).collect()
        };
        let mut findings = at_stop(&errors(&code, STOP), &mass(&code))?;
        let density = plateau_density(&x, &column(&code, |g| g.density));
        findings.enter("plateau_density", density);
        let columns = [
            ("velocity", column(&code, |g| g.velocity)),
            ("density", column(&code, |g| g.density)),
            ("pressure", column(&code, |g| g.pressure)),
            ("temperature", code.cells().map(|g| THETA_0 + g.energy()).collect()),
        ];
        findings.profile = Some(profile(columns, x.clone(), &exact));
        let mut phases = Phases::default();
        phases.add(&x, (&width, &mass(&code)), &errors(&code, STOP))?;
        // The shock passes cells at 1/3 of their size.
        let crossing = code.width() / exact.shock_speed();
        for phase in 1..PHASES {
            let time = STOP + crossing * f64::from(phase) / f64::from(PHASES);
            code.advance_to(time)?;
            phases.add(&x, (&width, &mass(&code)), &errors(&code, time))?;
        }
        phases.enter(&mut findings)?;
        Ok(Eulerian { findings, steps: work.steps, cell_steps: work.cell_steps, energy_drift, cpu })
    }

    fn draws(&self, key: &RunKey) -> bool {
        key.n == DRAWN && key.variant.is_empty()
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let sizes = if level == Level::Quick { &SIZES[..2] } else { SIZES };
        let mut keys = both_presets(ID, sizes);
        for scheme in [kernel_default(), Scheme::Godunov] {
            keys.extend(sizes.iter().map(|&n| RunKey::new(ID, scheme, n)));
        }
        for preset in Preset::ALL {
            let key = |v: &&str| run_of(ID, preset, DRAWN).variant(v);
            keys.extend(variants_of(preset).iter().map(key));
        }
        let kernel = |(v, _): &(&str, f64)| RunKey::new(ID, kernel_default(), DRAWN).variant(v);
        keys.extend(SUPPORTS.iter().map(kernel));
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        claims::all()
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("velocity_rms", "rms v"),
            ("temperature_rms", "rms θ"),
            ("velocity_rms_phase", "rms v, phases"),
            ("temperature_rms_phase", "rms θ, phases"),
            ("velocity_l1", "L1 v"),
            ("temperature_l1", "L1 θ"),
            ("velocity_l1_phase", "L1 v, phases"),
            ("temperature_l1_phase", "L1 θ, phases"),
            ("velocity_l1_window", "window L1 v"),
            ("wall_heating", "wall heating, first"),
            ("wall_heating_linf", "worst of five"),
        ]
    }

    fn errors(&self) -> &'static [&'static str] {
        &[
            "velocity_rms",
            "temperature_rms",
            "velocity_rms_phase",
            "temperature_rms_phase",
            "velocity_l1",
            "temperature_l1",
            "velocity_l1_phase",
            "temperature_l1_phase",
            "velocity_l1_window",
            "wall_heating",
            "wall_heating_linf",
        ]
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("plateau_density", "density of the shocked gas")]
    }

    fn extra_tables(&self, records: &Records) -> Vec<Table> {
        vec![tables::table_2_beside(records), tables::choices(records)]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let mut figures = Vec::from_iter(figures::profiles(records));
        figures.push(figures::convergence(records));
        figures.push(figures::speed_against_error(records));
        figures
    }
}
