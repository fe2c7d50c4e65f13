//! The problem: bodies, materials in the readings of Table 4, and what the variants change.

use whipple_solver::method::Preset;
use whipple_solver::space::method::{Method, YieldNorm};
use whipple_solver::space::scene::{Body, Material, Scene, Shape, Turn};
use whipple_solver::units::Units;

use crate::cases::parts::control;
use crate::cases::parts::metals::{Ductile, Metal, STEEL, TUNGSTEN};
use crate::cases::parts::shapes::{LONG, aspect};

pub(super) const ID: &str = "long-rod";
/// Diameter and length of the rod, thickness of the plate, in cm: the paper's problem.
const DIAMETER: f64 = 0.5;
const LENGTH: f64 = 7.5;
const THICKNESS: f64 = 0.5;
/// Edges of the plate along the slope and across it (gap G25), and twice its area.
const PLATE: [f64; 2] = [7.0, 4.0];
const WIDE_PLATE: [f64; 2] = [10.0, 5.6];
/// Speed in cm/us, along the axis of the rod.
const SPEED: f64 = 0.15;
/// Angle of the axis from the normal of the plate.
const OBLIQUITY: f64 = 60.0;
/// First gap between rod and plate, in cells.
const GAP: f64 = 0.9;
const STOP: f64 = 100.0;
/// Cells across rod and plate that give the particle counts of Table 5 (gap G25).
pub(super) const SIZES: [usize; 3] = [5, 7, 9];
/// Readings of the strength in Table 4 (gaps G1, G2): as it is printed; with the columns exchanged that
/// stand under the wrong metal; the plain variant converts their hardening to Eq. (44) besides.
pub(super) const AS_PRINTED: &str = "as-printed";
pub(super) const EXCHANGED: &str = "exchanged";
/// All three, that of the plain variant first.
pub(super) const READINGS: [&str; 3] = ["", AS_PRINTED, EXCHANGED];
/// Twice the plate.
pub(super) const WIDE: &str = "wide";
/// Other linear coefficients of the viscosity than 0.7.
const VISCOSITY_03: &str = "viscosity-0.3";
const VISCOSITY_1: &str = "viscosity-1";
const VISCOSITY_2: &str = "viscosity-2";
/// Other safeties of the time step than 0.9. Debris is chaotic: what a shorter step changes is the scatter
/// of the answer, not an order.
const STEP_08: &str = "step-0.8";
const STEP_07: &str = "step-0.7";
pub(super) const STEPS: [&str; 2] = [STEP_08, STEP_07];
/// The yield function as printed: uniaxial yield at 2.12 Y (gap G3).
const YIELD_AS_PRINTED: &str = "yield-as-printed";

/// Names of the variants, the plain one first.
pub(super) const VARIANTS: [&str; 14] = [
    "",
    AS_PRINTED,
    EXCHANGED,
    WIDE,
    VISCOSITY_03,
    VISCOSITY_1,
    VISCOSITY_2,
    STEP_08,
    STEP_07,
    YIELD_AS_PRINTED,
    control::HOURGLASS,
    control::CENTRING,
    LONG[0],
    LONG[1],
];

/// What a variant is, in words.
pub(super) fn words(variant: &str) -> &'static str {
    match variant {
        AS_PRINTED => "Table 4 as printed",
        EXCHANGED => "Table 4 exchanged, not converted",
        WIDE => "twice the plate",
        VISCOSITY_03 => "linear viscosity 0.3",
        VISCOSITY_1 => "linear viscosity 1",
        VISCOSITY_2 => "linear viscosity 2",
        STEP_08 => "safety of the time step 0.8",
        STEP_07 => "safety of the time step 0.7",
        YIELD_AS_PRINTED => "yield function as printed",
        "cells-2" => "cells twice as long",
        "cells-4" => "cells four times as long",
        control::HOURGLASS => "drag on hourglass modes",
        control::CENTRING => "motion of centroids resisted",
        _ => "Table 4 exchanged and converted",
    }
}

/// `Y_o`, `kappa`, `alpha` and melt temperature of Eq. (44).
type Hardening = [f64; 4];

/// Strength of rod and plate in a reading of Table 4 (gaps G1, G2).
fn strength(variant: &str) -> [Hardening; 2] {
    match variant {
        AS_PRINTED => [[0.0075, 1.15, 0.49, 1700.0], [0.0105, 0.177, 0.12, 1723.0]],
        EXCHANGED => [[0.0105, 0.177, 0.12, 1723.0], [0.0075, 1.15, 0.49, 1700.0]],
        _ => [[0.0105, 2.66, 0.12, 1723.0], [0.0075, 5.67, 0.49, 1700.0]],
    }
}

/// A metal of Table 4 with the equation of state of gap G23. No spall strength is known for the steel, and
/// that of another tungsten alloy (`references/materials.toml`) is not carried over.
fn metal(metal: Metal, shear_modulus: f64, hardening: Hardening) -> Material {
    let [y_0, kappa, alpha, melt] = hardening;
    let hardening = [y_0, kappa, alpha, 1.0, melt];
    Ductile { metal, shear_modulus, hardening, strain: 1.0, spall: None }.material()
}

/// Choices of a variant.
fn varied(method: Method, variant: &str) -> Method {
    match variant {
        VISCOSITY_03 => Method { visc_linear: 0.3, ..method },
        VISCOSITY_1 => Method { visc_linear: 1.0, ..method },
        VISCOSITY_2 => Method { visc_linear: 2.0, ..method },
        STEP_08 => Method { cfl: 0.8, ..method },
        STEP_07 => Method { cfl: 0.7, ..method },
        YIELD_AS_PRINTED => Method { yield_norm: YieldNorm::AsPrinted, ..method },
        _ => control::controlled(method, variant),
    }
}

/// Rod and plate with `n` cells across, which are so many times as long along the rod and in the plane of the plate: the plate fills 0 < y < 0.5 cm about x = z = 0, and the axis
/// of the rod runs through its middle.
fn bodies(n: usize, plate: [f64; 2], aspect: usize) -> Vec<Body> {
    let edge = DIAMETER / n as f64;
    let across = |length: f64| (length / (edge * aspect as f64)).round() as usize;
    let (sine, cosine) = OBLIQUITY.to_radians().sin_cos();
    // The lowest point of the rim is a little under the plate.
    let tip = -(GAP * edge + 0.5 * DIAMETER * sine);
    let middle = 0.5 * THICKNESS;
    let ahead = (middle - tip) / cosine;
    let centre = [-(ahead + 0.5 * LENGTH) * sine, middle - (ahead + 0.5 * LENGTH) * cosine, 0.0];
    let rod = Body {
        name: "rod".into(),
        material: "tungsten alloy".into(),
        shape: Shape::Cylinder { diameter: DIAMETER, length: LENGTH },
        cells: [n, n, across(LENGTH)],
        centre,
        // From the z axis to the direction of flight.
        turn: Turn { axis: [-cosine, sine, 0.0], degrees: 90.0 },
        velocity: [SPEED * sine, SPEED * cosine, 0.0],
        spin: [0.0; 3],
        energy: 0.0,
        noise: 0.0,
        mapping: None,
    };
    let plate = Body {
        name: "plate".into(),
        material: "steel".into(),
        shape: Shape::Box { size: [plate[0], THICKNESS, plate[1]] },
        cells: [across(plate[0]), n, across(plate[1])],
        centre: [0.0, middle, 0.0],
        turn: Turn::default(),
        velocity: [0.0; 3],
        spin: [0.0; 3],
        energy: 0.0,
        noise: 0.0,
        mapping: None,
    };
    vec![rod, plate]
}

/// The scene of a preset and a variant with `n` cells across.
pub(super) fn scene(preset: Preset, variant: &str, n: usize) -> Scene {
    let [rod, plate] = strength(variant);
    Scene {
        name: ID.into(),
        units: Units::CmGUsMbar,
        stop_time: STOP,
        method: varied(preset.space(), variant),
        walls: Vec::new(),
        materials: vec![metal(TUNGSTEN, 1.45, rod), metal(STEEL, 0.801, plate)],
        bodies: bodies(n, if variant == WIDE { WIDE_PLATE } else { PLATE }, aspect(variant)),
    }
}
