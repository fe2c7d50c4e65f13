//! Noh's wall shock: the paper's first problem, with the parameters of its Table 1.

use whipple_solver::method::{
    Conduction, Density, Heating, Integrator, Method, Preset, SoundSpeed,
};
use whipple_solver::output::Snapshot;
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};
use whipple_solver::units::Units;

use super::gas::{curve, eulerian_drift};
use super::{
    Case, Claim, Claims, Eulerian, Kind, Level, Quantity, Wanted, Weight, both_presets,
    conservation, kernel_default,
};
use crate::exact::noh::Noh as Exact;
use crate::exact::{Gas, Geometry};
use crate::godunov::{self, Domain, Godunov};
use crate::norms::{self, Norm};
use crate::plots::{Axis, Figure, Layer, Panel, Series as Curve};
use crate::record::{Records, RunKey, Scheme, Series};
use crate::report::{Cell, Column, Table};
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
/// Where the window norm looks: both sides of the shock, away from the wall.
const WINDOW: (f64, f64) = (0.025, 0.175);
/// Where the density of the shocked gas is averaged.
const PLATEAU: (f64, f64) = (0.02, 0.08);
/// Stop times over which a norm is averaged: the shock crosses one particle meanwhile.
const PHASES: u32 = 64;

/// Table 2: particles, velocity norm, temperature norm.
const TABLE_2: [(usize, f64, f64); 4] = [
    (100, 0.17116, 0.08594),
    (200, 0.12141, 0.06075),
    (400, 0.08635, 0.04325),
    (800, 0.06081, 0.03032),
];

/// 1D study, section 2, reading A converged in the time step.
const STUDY: [(usize, f64, f64); 4] = [
    (100, 0.16986, 0.08694),
    (200, 0.11999, 0.06117),
    (400, 0.08485, 0.04311),
    (800, 0.06000, 0.03038),
];

/// Choices changed one at a time, at the drawn size: what is each worth?
const VARIANTS: &[&str] = &[
    "",
    "half-step",
    "heating-printed",
    "heating-pair",
    "conduction-none",
    "single-pass",
    "viscosity-pairwise",
    "reference-sound",
    "nonholonomic",
    "support-1.5",
    "support-1.75",
    "support-2.25",
    "support-2.5",
];

/// Supports of the kernel beside its own, by variant.
const SUPPORTS: [(&str, f64); 4] =
    [("support-1.5", 1.5), ("support-1.75", 1.75), ("support-2.25", 2.25), ("support-2.5", 2.5)];

/// A method with one choice changed.
fn varied(method: Method, variant: &str) -> Method {
    let mut m = method;
    match variant {
        "half-step" => m.cfl *= 0.5,
        "heating-printed" => m.heating = Heating::Printed,
        "heating-pair" => m.heating = Heating::Pair,
        "conduction-none" => m.conduction = Conduction::None,
        "single-pass" => m.integrator = Integrator::SinglePass,
        "viscosity-pairwise" => {
            let paper = Preset::Paper.method();
            m.viscosity = paper.viscosity;
            m.visc_linear = paper.visc_linear;
            m.visc_quad = paper.visc_quad;
            m.sound_speed = paper.sound_speed;
        }
        "reference-sound" => m.sound_speed = SoundSpeed::Reference,
        "nonholonomic" => m.density = Density::Nonholonomic,
        _ => {}
    }
    if let Some((_, support)) = SUPPORTS.iter().find(|(name, _)| *name == variant) {
        m.kernel_support = *support;
    }
    m
}

/// The variants that change something in a preset.
fn variants_of(preset: Preset) -> &'static [&'static str] {
    match preset {
        Preset::Paper => &["half-step", "heating-pair", "conduction-none", "reference-sound"],
        Preset::Default => &[
            "half-step",
            "heating-printed",
            "conduction-none",
            "single-pass",
            "viscosity-pairwise",
            "nonholonomic",
        ],
    }
}

/// Norms at one time.
struct Errors {
    velocity: Vec<f64>,
    temperature: Vec<f64>,
}

impl Errors {
    fn new(x: &[f64], v: &[f64], theta: &[f64], exact: impl Fn(f64) -> Gas) -> Self {
        let minus = |found: &[f64], of: fn(&Gas) -> f64| {
            found.iter().zip(x).map(|(f, &x)| f - of(&exact(x))).collect()
        };
        // c_v = 1: temperature above that of the cold gas is the exact energy.
        Self { velocity: minus(v, |g| g.velocity), temperature: minus(theta, Gas::energy) }
    }
}

/// Norms at several phases of the shock within a particle spacing.
#[derive(Default)]
struct Phases {
    velocity: Vec<f64>,
    temperature: Vec<f64>,
    velocity_l1: Vec<f64>,
    temperature_l1: Vec<f64>,
    velocity_window: Vec<f64>,
    temperature_window: Vec<f64>,
}

impl Phases {
    fn add(
        &mut self,
        x: &[f64],
        (lengths, mass): (&[f64], &[f64]),
        errors: &Errors,
    ) -> Result<(), RunError> {
        self.velocity.push(norms::rms(&errors.velocity)?);
        self.temperature.push(norms::rms(&errors.temperature)?);
        self.velocity_l1.push(norms::l1_weighted(&errors.velocity, mass)?);
        self.temperature_l1.push(norms::l1_weighted(&errors.temperature, mass)?);
        self.velocity_window.push(norms::window_l1(x, &errors.velocity, lengths, WINDOW)?);
        self.temperature_window.push(norms::window_l1(x, &errors.temperature, lengths, WINDOW)?);
        Ok(())
    }

    fn enter(&self, findings: &mut Findings) -> Result<(), RunError> {
        let averages = [
            ("velocity_rms_phase", Norm::Rms, &self.velocity),
            ("temperature_rms_phase", Norm::Rms, &self.temperature),
            ("velocity_l1_phase", Norm::L1, &self.velocity_l1),
            ("temperature_l1_phase", Norm::L1, &self.temperature_l1),
            ("velocity_l1_window", Norm::L1, &self.velocity_window),
            ("temperature_l1_window", Norm::L1, &self.temperature_window),
        ];
        for (name, norm, values) in averages {
            findings.norms.insert(name.into(), norm.phase_average(values)?);
        }
        Ok(())
    }
}

fn exact() -> Result<Exact, RunError> {
    Ok(Exact::new(Geometry::Planar, GAMMA, 1.0, 1.0)?)
}

/// Exact state at `x`; positions behind the wall do not occur.
fn state(exact: &Exact, x: f64, t: f64) -> Gas {
    if x < exact.shock_position(t) { exact.behind() } else { exact.ahead() }
}

/// Mean density of the shocked gas, away from wall and front.
fn plateau_density(x: &[f64], density: &[f64]) -> f64 {
    let inside = x.iter().zip(density).filter(|(x, _)| PLATEAU.0 < **x && **x < PLATEAU.1);
    let (sum, count) = inside.fold((0.0, 0.0), |(sum, count), (_, rho)| (sum + rho, count + 1.0));
    sum / count
}

/// Norms that need one time only.
fn at_stop(errors: &Errors, mass: &[f64]) -> Result<Findings, RunError> {
    let mut findings = Findings::default();
    let mut enter = |name: &str, value| findings.norms.insert(name.into(), value);
    enter("velocity_rms", norms::rms(&errors.velocity)?);
    enter("temperature_rms", norms::rms(&errors.temperature)?);
    enter("velocity_l1", norms::l1_weighted(&errors.velocity, mass)?);
    enter("temperature_l1", norms::l1_weighted(&errors.temperature, mass)?);
    enter("wall_heating", errors.temperature[0] / 0.5);
    let near = errors.temperature.iter().take(5).fold(0.0_f64, |top, e| top.max(e.abs()));
    enter("wall_heating_linf", near / 0.5);
    Ok(findings)
}

/// Fields beside the exact ones, as in the paper's Figures 1 to 4.
fn profile(columns: [(&str, Vec<f64>); 4], x: Vec<f64>, exact: &Exact) -> Series {
    let mut profile = Series::default();
    let of: [fn(&Gas) -> f64; 4] =
        [|g| g.velocity, |g| g.density, |g| g.pressure, |g| THETA_0 + g.energy()];
    for ((name, values), of) in columns.into_iter().zip(of) {
        let wanted = x.iter().map(|&x| of(&state(exact, x, STOP))).collect();
        profile.0.insert(format!("{name}_exact"), wanted);
        profile.0.insert(name.into(), values);
    }
    profile.0.insert("x".into(), x);
    profile
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
        findings.norms.insert("plateau_density".into(), plateau_density(&s.x, &s.rho));
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
        findings.norms.insert("plateau_density".into(), density);
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
            let key = |v: &&str| RunKey::new(ID, Scheme::preset(preset), DRAWN).variant(v);
            keys.extend(variants_of(preset).iter().map(key));
        }
        let kernel = |(v, _): &(&str, f64)| RunKey::new(ID, kernel_default(), DRAWN).variant(v);
        keys.extend(SUPPORTS.iter().map(kernel));
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let mut out = table_2();
        out.extend(accuracy());
        out.extend(orders());
        let default = |n| RunKey::new(ID, Scheme::preset(Preset::Default), n);
        for n in [100, 800] {
            out.extend(conservation(ID, &default(n)));
        }
        let cost =
            Claims::new(ID, Kind::Cost, Weight::Must, "issue: one core, CPU time of stepping");
        out.push(cost.claim(
            "particle-steps per CPU second, n = 800, `default`",
            Quantity::Speed(default(800)),
            Wanted::AtLeast(1e7),
        ));
        out.push(cost.claim(
            "CPU seconds, n = 800, `paper`",
            Quantity::CpuSeconds(RunKey::new(ID, Scheme::preset(Preset::Paper), 800)),
            Wanted::AtMost(5.0),
        ));
        out
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

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("plateau_density", "density of the shocked gas")]
    }

    fn extra_tables(&self, records: &Records) -> Vec<Table> {
        vec![table_2_beside(records), choices(records)]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let mut figures = Vec::from_iter(profiles(records));
        figures.push(convergence(records));
        figures.push(speed_against_error(records));
        figures
    }
}

/// The eight norms of Table 2, against the paper and against the study.
fn table_2() -> Vec<Claim> {
    let paper = Claims::new(ID, Kind::Replication, Weight::Must, "paper, Table 2").in_sample();
    let study = Claims {
        kind: Kind::Comparison,
        source: "1D study: reading A converged in the time step, within 0.5 %",
        ..paper
    };
    let mut out = Vec::new();
    for (claims, rows, share, whose) in
        [(paper, TABLE_2, 0.02, "Table 2"), (study, STUDY, 0.005, "study")]
    {
        for (n, velocity, temperature) in rows {
            let key = RunKey::new(ID, Scheme::preset(Preset::Paper), n);
            for (name, symbol, value) in
                [("velocity_rms", "v", velocity), ("temperature_rms", "θ", temperature)]
            {
                out.push(claims.claim(
                    format!("rms {symbol}, n = {n}, `paper`, {whose}"),
                    Quantity::Norm(key.clone(), name),
                    Wanted::Near(value, share),
                ));
            }
        }
    }
    out
}

/// What the default preset reaches.
fn accuracy() -> Vec<Claim> {
    let source = "issue: the prototype reached 0.19, 0.102, 4.7 % and 0.011";
    let must = Claims::new(ID, Kind::Verification, Weight::Must, source).in_sample();
    let aim = Claims { weight: Weight::Aim, source: "issue: goal beyond the prototype", ..must };
    let mut out = Vec::new();
    for n in [100, 400] {
        let key = RunKey::new(ID, Scheme::preset(Preset::Default), n);
        let wrong = |name| Quantity::WrongParticles(key.clone(), name);
        let rows = [
            ("n·rms² of v", wrong("velocity_rms_phase"), 0.20, 0.15),
            ("n·rms² of θ", wrong("temperature_rms_phase"), 0.105, 0.06),
        ];
        for (what, quantity, bound, goal) in rows {
            let what = format!("{what}, phase average, n = {n}, `default`");
            out.push(must.claim(what.clone(), quantity.clone(), Wanted::AtMost(bound)));
            out.push(aim.claim(what, quantity, Wanted::AtMost(goal)));
        }
        let heating = Quantity::Norm(key.clone(), "wall_heating");
        let what = format!("wall heating, first particle, n = {n}, `default`");
        out.push(must.claim(what.clone(), heating.clone(), Wanted::WithinZero(0.05)));
        out.push(aim.claim(what, heating, Wanted::WithinZero(0.01)));
    }
    let key = RunKey::new(ID, Scheme::preset(Preset::Default), 100);
    let window = Quantity::Norm(key, "velocity_l1_window");
    let what = "window L1 of v, mean over phases, n = 100, `default`";
    out.push(must.claim(what, window.clone(), Wanted::AtMost(0.012)));
    let stored = Claims { source: "best value stored by another code, for one phase", ..aim };
    out.push(stored.claim(what, window, Wanted::AtMost(0.0077)));
    out
}

/// Orders of both presets.
fn orders() -> Vec<Claim> {
    let source = "a shock of fixed width in particles: RMS 1/2, L1 1";
    let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
    let mut out = Vec::new();
    for preset in Preset::ALL {
        let runs = |n: &usize| RunKey::new(ID, Scheme::preset(preset), *n);
        let keys: Vec<RunKey> = SIZES.iter().map(runs).collect();
        let rows = [
            ("velocity_rms_phase", "rms v", 0.50, 0.03),
            ("temperature_rms_phase", "rms θ", 0.50, 0.03),
            ("velocity_l1_phase", "L1 v", 1.0, 0.05),
            ("temperature_l1_phase", "L1 θ", 1.0, 0.05),
        ];
        for (name, symbol, order, band) in rows {
            out.push(must.claim(
                format!("order of {symbol}, phase average, `{}`", preset.name()),
                Quantity::Order(keys.clone(), name),
                Wanted::Around(order, band),
            ));
        }
    }
    out
}

/// The paper's Table 2 with ours beside it.
fn table_2_beside(records: &Records) -> Table {
    let mut columns = vec![Column::number("n", "")];
    for symbol in ["v", "θ"] {
        let head = |whose: &str| Column::number(format!("{symbol}: {whose}"), "");
        columns.push(head("paper's table"));
        columns.push(head("`paper`"));
        columns.push(Column::number("off", "%"));
        columns.push(head("`default`"));
        columns.push(head("with kernel"));
        columns.push(head("Godunov"));
    }
    let row = |&(n, velocity, temperature): &(usize, f64, f64)| {
        let norm = |scheme, name: &str| {
            records.get(&RunKey::new(ID, scheme, n)).and_then(|r| r.norms.get(name).copied())
        };
        let number = |value: Option<f64>, digits| {
            value.map_or_else(|| "–".into(), |value| Cell::number(value, digits))
        };
        let mut row = vec![Cell::count(n as u64)];
        for (name, printed) in [("velocity_rms", velocity), ("temperature_rms", temperature)] {
            let [paper, default, kernel, godunov] = schemes().map(|scheme| norm(scheme, name));
            row.push(Cell::number(printed, 5));
            row.push(number(paper, 5));
            row.push(number(paper.map(|p| 100.0 * (p / printed - 1.0)), 2));
            row.extend([default, kernel, godunov].map(|value| number(value, 4)));
        }
        row
    };
    Table {
        id: "noh-table-2".into(),
        caption: "Table 2 of the paper: RMS norms of velocity and temperature at t = 0.3, with ours \
                  beside them. The `paper` column replicates; the others say what else is possible at \
                  this one phase of the shock. Godunov counts cells, of which a fifth is shocked \
                  where four fifths of the particles are."
            .into(),
        columns,
        rows: TABLE_2.iter().map(row).collect(),
    }
}

/// What each choice is worth: both presets with one choice changed.
fn choices(records: &Records) -> Table {
    let norms: [(&str, &str); 5] = [
        ("velocity_rms_phase", "n·rms² of v"),
        ("temperature_rms_phase", "n·rms² of θ"),
        ("wall_heating", "wall heating, %"),
        ("velocity_l1_window", "window L1 of v"),
        ("energy", "energy drift"),
    ];
    let mut columns = vec![Column::text("preset"), Column::text("one choice changed")];
    columns.extend(norms.iter().map(|(_, title)| Column::number(*title, "")));
    columns.push(Column::number("steps", ""));
    let mut rows = Vec::new();
    let changed = Preset::ALL.into_iter().flat_map(|preset| {
        let names = std::iter::once("").chain(variants_of(preset).iter().copied());
        names.map(move |name| (Scheme::preset(preset), name))
    });
    let kernels = std::iter::once("").chain(SUPPORTS.iter().map(|(name, _)| *name));
    for (scheme, variant) in changed.chain(kernels.map(|name| (kernel_default(), name))) {
        let key = RunKey::new(ID, scheme, DRAWN).variant(variant);
        let Some(record) = records.get(&key) else {
            continue;
        };
        let name = if variant.is_empty() { "–" } else { variant };
        let mut row: Vec<Cell> = vec![scheme.label().into(), name.into()];
        for (norm, _) in norms {
            let value = record.norms.get(norm).copied();
            row.push(match (norm, value) {
                ("energy", _) => Cell::number(record.energy_drift, 2),
                (_, None) => "run failed".into(),
                ("wall_heating", Some(value)) => Cell::number(100.0 * value, 3),
                ("velocity_l1_window", Some(value)) => Cell::number(value, 4),
                (_, Some(value)) => Cell::number(DRAWN as f64 * value * value, 4),
            });
        }
        row.push(Cell::count(record.steps));
        rows.push(row);
    }
    Table {
        id: "noh-choices".into(),
        caption: format!(
            "What each choice is worth on the wall shock, n = {DRAWN}: both presets with one choice \
             changed, `half-step` for the time step, and the kernel density over its support. RMS \
             norms are phase averages."
        ),
        columns,
        rows,
    }
}

/// Schemes of the comparison figures.
fn schemes() -> [Scheme; 4] {
    [
        Scheme::preset(Preset::Paper),
        Scheme::preset(Preset::Default),
        kernel_default(),
        Scheme::Godunov,
    ]
}

/// The exact field as the corners of its step.
fn step(exact: &Exact, field: &str) -> Vec<(f64, f64)> {
    let of = |gas: Gas| match field {
        "velocity" => gas.velocity,
        "density" => gas.density,
        "pressure" => gas.pressure,
        _ => THETA_0 + gas.energy(),
    };
    let (behind, ahead) = (of(exact.behind()), of(exact.ahead()));
    let shock = exact.shock_position(STOP);
    vec![(0.0, behind), (shock, behind), (shock, ahead), (LENGTH - STOP, ahead)]
}

/// Figures 1 to 4 of the paper.
fn profiles(records: &Records) -> Option<Figure> {
    let drawn: Vec<(Scheme, &Series)> = schemes()
        .into_iter()
        .filter(|s| *s != kernel_default())
        .filter_map(|s| Some((s, records.get(&RunKey::new(ID, s, DRAWN))?.profile.as_ref()?)))
        .collect();
    let exact = exact().ok()?;
    let fields = [
        ("velocity", "velocity", "Figure 1"),
        ("density", "density", "Figure 2"),
        ("pressure", "pressure", "Figure 3"),
        ("temperature", "temperature", "Figure 4"),
    ];
    let panels = fields
        .map(|(name, label, title)| {
            let x = Axis::linear("x").range(0.0, 0.2);
            let mut panel = Panel::new(title, x, Axis::linear(label));
            panel = panel.with(Layer::exact("exact", step(&exact, name)));
            for (scheme, series) in &drawn {
                panel = panel.with(curve(*scheme, series.points("x", name)));
            }
            panel
        })
        .into();
    let caption = format!(
        "Wall shock at t = 0.3, {DRAWN} particles: Figures 1 to 4 of the paper, with both presets, \
         the Godunov code ({DRAWN} cells over the initial length) and the exact solution."
    );
    Some(Figure::new("noh-profiles", caption, panels))
}

/// Points of a norm over something, one per size.
fn points(
    records: &Records,
    scheme: Scheme,
    x: impl Fn(&crate::record::RunRecord) -> f64,
    name: &str,
) -> Vec<(f64, f64)> {
    let record = |n: &usize| records.get(&RunKey::new(ID, scheme, *n));
    let point = |r: &crate::record::RunRecord| Some((x(r), *r.norms.get(name)?));
    SIZES.iter().filter_map(record).filter_map(point).collect()
}

fn convergence(records: &Records) -> Figure {
    let rows = [
        ("velocity_rms_phase", "rms error of v, phase average", 0.5),
        ("velocity_l1_phase", "L1 error of v, phase average", 1.0),
    ];
    let panels = rows
        .map(|(name, label, order)| {
            let mut panel = Panel::new("", Axis::log("spacing 1/n"), Axis::log(label))
                .with(Layer::slope(order));
            for scheme in schemes() {
                let spacing = |r: &crate::record::RunRecord| 1.0 / r.key.n as f64;
                let points = points(records, scheme, spacing, name);
                panel = panel.with(Curve::marked(scheme.label(), points));
            }
            panel
        })
        .into();
    let caption = "Convergence on the wall shock: RMS with order 1/2, L1 with order 1.";
    Figure::new("noh-convergence", caption, panels)
}

fn speed_against_error(records: &Records) -> Figure {
    type Cost = fn(&crate::record::RunRecord) -> f64;
    let costs: [(&str, Cost); 2] = [
        ("CPU seconds", |r| r.cpu_seconds),
        ("particle-steps or cell-steps", |r| r.particle_steps as f64),
    ];
    let panels = costs
        .map(|(label, cost)| {
            let y = Axis::log("rms error of v, phase average");
            let mut panel = Panel::new("", Axis::log(label), y);
            for scheme in schemes() {
                let points = points(records, scheme, cost, "velocity_rms_phase");
                panel = panel.with(Curve::marked(scheme.label(), points));
            }
            panel
        })
        .into();
    let caption = "Speed against error on the wall shock, n = 100 to 800: lower and further left is \
                   better. CPU time is that of the machine named under provenance.";
    Figure::new("noh-speed-against-error", caption, panels)
}
