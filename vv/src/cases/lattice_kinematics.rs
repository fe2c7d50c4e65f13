//! Density rules on affinely deformed lattices, against the exact volume.

use whipple_solver::method::{Density, Preset};
use whipple_solver::space::Simulation;
use whipple_solver::space::method::Method;
use whipple_solver::space::scene::{EosData, Failure, GammaLaw, Material, Scene, Shape};
use whipple_solver::units::Units;

use super::figures::{beside_exact, figure, histories};
use super::parts::{Columns, moments, motion, resting, times};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight};
use crate::exact::lattice::{Gate, Path, integrate};
use crate::plots::{Axis, Figure, Panel};
use crate::record::{Records, RunKey, Scheme};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct LatticeKinematics;

const ID: &str = "lattice-kinematics";
/// Steps of a whole path at least.
const STEPS: usize = 400;
/// Half of the part of the block, of edge 1, whose particles are looked at: its surface is left out.
const INSIDE: f64 = 0.26;
/// Sound speed over the speeds of the path: so soft that no force bends it.
const SOUND: f64 = 1e-4;
/// Steps of the rule on an infinite lattice.
const RULE_STEPS: u32 = 20_000;
const UNIFORM: &str = "uniform";
const SHEAR: &str = "shear";
const UPSET: &str = "upset";
const STRICT: &str = "strict";
const VARIANTS: [&str; 5] = ["", UNIFORM, SHEAR, UPSET, STRICT];
const NAMES: [&str; 5] = [
    "uniaxial, to 0.6",
    "uniform, to 0.8",
    "simple shear, to 0.4",
    "upset, to 0.75",
    "uniaxial, to 0.6, no tolerance of contacts",
];

/// The path of a variant.
fn path(variant: &str) -> Path {
    match variant {
        UNIFORM => Path::Uniform(0.8),
        SHEAR => Path::SimpleShear(0.4),
        UPSET => Path::Upset(0.75),
        _ => Path::Uniaxial(0.6),
    }
}

/// Deformation gradient at the end of the path, less the identity: the velocity gradient of the
/// undeformed block, over a time of 1.
fn change(variant: &str) -> [[f64; 3]; 3] {
    let diagonal = |x: f64, y: f64| [[x - 1.0, 0.0, 0.0], [0.0, y - 1.0, 0.0], [0.0, 0.0, y - 1.0]];
    match path(variant) {
        Path::Uniform(x) => diagonal(x, x),
        Path::Uniaxial(x) => diagonal(x, 1.0),
        Path::Upset(x) => diagonal(x, x.sqrt().recip()),
        Path::SimpleShear(g) => [[0.0, g, 0.0], [0.0; 3], [0.0; 3]],
    }
}

/// Volume over that at the start, at a time.
fn jacobian(variant: &str, time: f64) -> f64 {
    let change = change(variant);
    // All gradients are triangular.
    (0..3).map(|k| 1.0 + time * change[k][k]).product()
}

/// A row of a matrix times a vector.
fn product(m: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
}

/// Schemes that are looked at.
fn schemes() -> [Scheme; 3] {
    [Scheme::preset(Preset::Paper), Scheme::preset(Preset::Default), super::kernel_default()]
}

/// Density of a scheme's particles for tables.
fn name_of(scheme: Scheme) -> &'static str {
    match scheme {
        Scheme::Particles { density: Density::Nonholonomic, .. } => "contacts (paper)",
        Scheme::Particles { density: Density::Kernel, .. } => "kernel",
        _ => "pyramids (default)",
    }
}

fn key(scheme: Scheme, variant: &str) -> RunKey {
    RunKey::new(ID, scheme, LatticeKinematics.default_size()).variant(variant)
}

impl Case for LatticeKinematics {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Density rules on a deformed lattice"
    }

    fn about(&self) -> &'static str {
        "A free block gets a linear field of velocities and no resistance worth the name (its sound is \
         1e-4 of their speed, no viscosity), so that x = (I + t L) X: what remains is the rule that makes \
         densities of particles out of their places. Squeezed along one cube axis, uniformly, sheared, \
         upset (all stretches linear in time, the volume the same at the end), for contacts \
         (Eqs. (33)-(36), with the tolerance of 0.06, and without in the variant `strict`), for the \
         pyramids of the elements, and for the kernel. Densities are means over the particles in the \
         middle of the block; error is against 1/J, and beside it against what the contact rule gives on \
         an infinite lattice. Initial velocities are set in the state: no scene states them. n counts \
         the cells along an edge."
    }

    fn source(&self) -> &'static str {
        "1/J of the path; `references/bcc_uniaxial_density.csv`, Eqs. (33)-(36) on a bcc lattice"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        8
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let law = GammaLaw::ConstantProduct;
        let material = Material {
            name: "soft".into(),
            density: 1.0,
            eos: EosData::MieGruneisen {
                c0: SOUND,
                s: 1.5,
                gamma_0: 0.0,
                law,
                c_v: 1.0,
                theta_0: 0.0,
            },
            strength: None,
            failure: Failure::default(),
        };
        let plain = preset.space();
        let method = Method {
            visc_linear: 0.0,
            visc_quad: 0.0,
            visc_expansion: 0.0,
            heat_coeff: 0.0,
            contact_tolerance: if variant == STRICT { 0.0 } else { plain.contact_tolerance },
            ..plain
        };
        Scene {
            name: ID.into(),
            units: Units::None,
            stop_time: 1.0,
            method,
            walls: Vec::new(),
            materials: vec![material],
            bodies: vec![resting("soft", Shape::Box { size: [1.0; 3] }, [n; 3], [0.0; 3])],
        }
        .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let change = change(&key.variant);
        driver.prepare(|simulation| motion::start(simulation, |p| product(&change, p.position)))?;
        let starts: Vec<(u32, [f64; 3])> = driver
            .solver()
            .all_particles()
            .filter(|p| p.position.iter().all(|x| x.abs() < INSIDE))
            .map(|p| (p.id, p.position))
            .collect();
        let mut history = Columns::default();
        let mut worst = 0.0_f64;
        // A run that is cut short takes no shorter steps.
        let steps = (STEPS as f64 * scene.stop_time).ceil() as usize;
        for time in times(scene.stop_time, steps) {
            driver.advance_to(time)?;
            let exact = jacobian(&key.variant, time).recip();
            let (mean, _) = moments(&densities(driver.solver(), &starts));
            worst = worst.max((mean / exact - 1.0).abs());
            history.row([("time", time), ("exact", exact), ("ratio", mean)]);
        }
        driver.balance();
        let solver = driver.solver();
        let time = solver.time();
        let strayed = starts.iter().map(|&(id, start)| {
            let (x, way) = (solver.particle(id).position, product(&change, start));
            (0..3).map(|d| (x[d] - start[d] - time * way[d]).abs()).fold(0.0, f64::max)
        });
        let (mean, spread) = moments(&densities(solver, &starts));
        let gate = Gate::closed(scene.method.contact_tolerance)?;
        let rule = integrate(path(&key.variant), gate, RULE_STEPS)?;
        let exact = jacobian(&key.variant, time).recip();
        let mut findings = Findings::default();
        findings.enter("ratio", mean);
        findings.enter("error", mean / exact - 1.0);
        findings.enter("largest_error", worst);
        findings.enter("spread", spread / mean);
        findings.enter("rule_error", mean / rule.ratio - 1.0);
        findings.enter("strayed", strayed.fold(0.0, f64::max));
        findings.history = Some(history.series());
        Ok(findings)
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }

    fn runs(&self, _: Level) -> Vec<RunKey> {
        let contacts = key(Scheme::preset(Preset::Paper), STRICT);
        let all = schemes().into_iter().flat_map(|s| VARIANTS[..4].iter().map(move |v| key(s, v)));
        all.chain([contacts]).collect()
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "1/J: pyramids fill the cell, whatever its affine deformation";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let mut out = Vec::new();
        for (variant, name) in VARIANTS[..4].iter().zip(NAMES) {
            out.push(must.claim(
                format!("{name}, `default`: largest error of the density"),
                Quantity::Norm(key(Scheme::preset(Preset::Default), variant), "largest_error"),
                Wanted::AtMost(1e-4),
            ));
            out.push(must.claim(
                format!("{name}, `default`: particles off the path, over the edge of the block"),
                Quantity::Norm(key(Scheme::preset(Preset::Default), variant), "strayed"),
                Wanted::AtMost(1e-6),
            ));
        }
        let source = "Eqs. (33)-(36) on an infinite lattice, integrated apart";
        let rule = Claims { source, ..must };
        for (variant, name) in VARIANTS.iter().zip(NAMES).filter(|(v, _)| **v != UPSET) {
            out.push(rule.claim(
                format!("{name}, `paper`: density over that of the rule, error"),
                Quantity::Norm(key(Scheme::preset(Preset::Paper), variant), "rule_error"),
                Wanted::WithinZero(1e-2),
            ));
        }
        let shown = Claims { weight: Weight::Shown, source: "1/J", ..must };
        // What the paper's rule does not reach is a limit of its method; the kernel is not that.
        let aim = Claims { weight: Weight::Aim, ..shown };
        let rules = [(Scheme::preset(Preset::Paper), shown), (super::kernel_default(), aim)];
        for (scheme, claims) in rules {
            for (variant, name) in VARIANTS[..4].iter().zip(NAMES) {
                out.push(claims.claim(
                    format!("{name}, {}: error of the density", name_of(scheme)),
                    Quantity::Norm(key(scheme, variant), "error"),
                    Wanted::WithinZero(0.01),
                ));
            }
        }
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("ratio", "density / initial"),
            ("error", "error against 1/J"),
            ("largest_error", "largest on the path"),
            ("rule_error", "against the contact rule"),
            ("spread", "spread over particles"),
            ("strayed", "off the path"),
        ]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let panels = VARIANTS[..4].iter().zip(NAMES).filter_map(|(variant, name)| {
            let [time, density] = ["time", "density / initial"].map(Axis::linear);
            let runs = schemes().map(|scheme| (name_of(scheme), key(scheme, variant)));
            let panel = Panel::new(name, time, density);
            let field = |time: f64| Ok::<_, RunError>(jacobian(variant, time).recip());
            let columns = ["time", "ratio"];
            beside_exact(panel, &histories(records, runs), columns, "1/J", field)
        });
        let caption = "Density in the middle of a deformed block, by rule, beside the exact 1/J.";
        figure("lattice-kinematics-density", caption, panels)
    }
}

/// Densities of some particles.
fn densities(simulation: &Simulation, of: &[(u32, [f64; 3])]) -> Vec<f64> {
    of.iter().map(|(id, _)| simulation.particle(*id).rho).collect()
}
