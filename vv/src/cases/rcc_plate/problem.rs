//! The problem: bodies, materials of Table 6, and what the variants change.

use whipple_solver::method::Preset;
use whipple_solver::space::method::Method;
use whipple_solver::space::scene::{Material, Scene};
use whipple_solver::units::Units;

use crate::cases::Choice;
use crate::cases::parts::impact::{Impact, PLATE, SPHERE_METAL, STOP};
use crate::cases::parts::metals::{Ductile, Metal};
use crate::cases::parts::shapes::{LONG, aspect};

pub(super) const ID: &str = "rcc-plate";
/// Edges of the plate in cm: gap G27, and a plate whose edge no wave reaches and comes back from.
const EDGE: f64 = 5.4;
const WIDE_EDGE: f64 = 7.0;
/// Cells through the plate that come near the particle counts of Table 7 (gap G27).
pub(super) const SIZES: [usize; 3] = [4, 6, 8];
/// Angles from the normal in degrees (gap G26), the plain one first.
pub(super) const ANGLES: [&str; 4] = ["45", "0", "30", "60"];
/// Equations of state of the plate in `references/materials.toml`, the plain one first.
pub(super) const EOS: [&str; 3] = ["rcc_baseline", "rcc_soft", "rcc_stiff"];
/// What has an option of its own.
pub(super) const CHOICES: [Choice; 2] =
    [Choice { name: "angle", values: &ANGLES }, Choice { name: "eos", values: &EOS }];

/// A larger plate.
pub(super) const WIDE: &str = "wide";
/// Three times as long.
const LATE: &str = "late";
/// No spall strength of the sphere.
const SPALL_NONE: &str = "spall-none";
/// The plate tears at a tension of its yield stress: no spall strength of it is known.
const SPALL_YIELD: &str = "spall-yield";
/// Half and twice the plastic strain at which the plate fails.
const STRAIN_HALF: &str = "strain-0.25";
const STRAIN_TWICE: &str = "strain-1";
/// The plate neither softens nor hardens with heat (gap G7).
const SOFTENING_0: &str = "softening-0";
/// Other volumes at which elements fail (gap G21).
const COMPRESSION_02: &str = "compression-0.2";
const COMPRESSION_04: &str = "compression-0.4";
/// Another safety of the time step than 0.9: what it changes is the scatter of the answer.
pub(super) const STEP_08: &str = "step-0.8";

/// Names of the variants: those of the choices, the plain one first, and those of one change each.
pub(super) const VARIANTS: [&str; 24] = [
    "",
    "eos-rcc_soft",
    "eos-rcc_stiff",
    "angle-0",
    "angle-0_eos-rcc_soft",
    "angle-0_eos-rcc_stiff",
    "angle-30",
    "angle-30_eos-rcc_soft",
    "angle-30_eos-rcc_stiff",
    "angle-60",
    "angle-60_eos-rcc_soft",
    "angle-60_eos-rcc_stiff",
    WIDE,
    LATE,
    SPALL_NONE,
    SPALL_YIELD,
    STRAIN_HALF,
    STRAIN_TWICE,
    SOFTENING_0,
    COMPRESSION_02,
    COMPRESSION_04,
    STEP_08,
    LONG[0],
    LONG[1],
];

/// Variants that change one thing of the plain one which no option does.
pub(super) fn changes() -> &'static [&'static str] {
    &VARIANTS[ANGLES.len() * EOS.len()..]
}

/// What a change is, in words.
pub(super) fn words(variant: &str) -> &'static str {
    match variant {
        WIDE => "plate of 7 cm",
        LATE => "to 30 µs",
        SPALL_NONE => "no spall strength of the sphere",
        SPALL_YIELD => "plate tears at its yield stress",
        STRAIN_HALF => "plate fails at a strain of 0.25",
        STRAIN_TWICE => "plate fails at a strain of 1",
        SOFTENING_0 => "thermal softening of the plate 0, not -1",
        COMPRESSION_02 => "elements fail at 0.2 of their volume",
        COMPRESSION_04 => "elements fail at 0.4 of their volume",
        "cells-2" => "cells of the plate twice as long in its plane",
        "cells-4" => "cells of the plate four times as long in its plane",
        STEP_08 => "safety of the time step 0.8",
        "eos-rcc_soft" => "softer equation of state",
        "eos-rcc_stiff" => "stiffer equation of state",
        _ => "as the paper has it",
    }
}

/// The value of a choice that a variant names, or the plain one.
fn chosen(variant: &str, choice: &Choice) -> &'static str {
    let named = |value: &&&str| {
        let part = choice.part(value);
        let (first, last) = (format!("{part}_"), format!("_{part}"));
        variant == part || variant.starts_with(&first) || variant.ends_with(&last)
    };
    choice.values.iter().find(named).copied().unwrap_or(choice.values[0])
}

/// The angle of a variant from the normal, in degrees.
pub(super) fn degrees(variant: &str) -> f64 {
    chosen(variant, &CHOICES[0]).parse().unwrap_or(f64::NAN)
}

/// `c0` and `s` of an equation of state of the plate.
fn hugoniot(eos: &str) -> [f64; 2] {
    match eos {
        "rcc_soft" => [0.200, 1.40],
        "rcc_stiff" => [0.390, 1.50],
        _ => [0.246, 1.60],
    }
}

/// Reinforced carbon-carbon with the strength of Table 6, its thermal softening of -1 kept (gap G7). No
/// spall strength of it was found.
fn rcc(variant: &str) -> Material {
    let [c0, s] = hugoniot(chosen(variant, &CHOICES[1]));
    let y_0 = 0.000_771;
    let eta = if variant == SOFTENING_0 { 0.0 } else { -1.0 };
    let strain = match variant {
        STRAIN_HALF => 0.25,
        STRAIN_TWICE => 1.0,
        _ => 0.5,
    };
    let metal = Metal { name: "carbon-carbon", constants: [1.58, c0, s, 0.24, 0.712e-5] };
    let spall = (variant == SPALL_YIELD).then_some(y_0);
    let hardening = [y_0, 2.0, 1.0, eta, 3840.0];
    Ductile { metal, shear_modulus: 0.0718, hardening, strain, spall }.material()
}

/// The scene of a preset and a variant with `n` cells through the plate.
pub(super) fn scene(preset: Preset, variant: &str, n: usize) -> Scene {
    let mut materials = vec![SPHERE_METAL.material(), rcc(variant)];
    for material in &mut materials {
        material.failure.compression = match variant {
            COMPRESSION_02 => 0.2,
            COMPRESSION_04 => 0.4,
            _ => material.failure.compression,
        };
    }
    if variant == SPALL_NONE {
        materials[0].failure.spall = None;
    }
    let impact = Impact {
        edge: if variant == WIDE { WIDE_EDGE } else { EDGE },
        through: n,
        aspect: aspect(variant),
        degrees: degrees(variant),
        materials: [&materials[0].name, &materials[PLATE].name],
    };
    let bodies = impact.bodies();
    let method = preset.space();
    let cfl = if variant == STEP_08 { 0.8 } else { method.cfl };
    Scene {
        name: ID.into(),
        units: Units::CmGUsMbar,
        stop_time: if variant == LATE { 3.0 * STOP } else { STOP },
        method: Method { cfl, ..method },
        walls: Vec::new(),
        materials,
        bodies,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::references::Table;
    use whipple_solver::space::scene::{EosData, Flow};

    /// Every combination of the options is a variant, and tells its values.
    #[test]
    fn options_are_variants() {
        for angle in ANGLES {
            for eos in EOS {
                let parts = CHOICES.iter().zip([angle, eos]);
                let named: Vec<String> =
                    parts.filter_map(|(choice, value)| choice.named(value)).collect();
                let variant = named.join("_");
                assert!(VARIANTS.contains(&variant.as_str()), "{variant}");
                assert_eq!(CHOICES.each_ref().map(|c| chosen(&variant, c)), [angle, eos]);
            }
        }
        assert!(changes().contains(&WIDE) && changes().iter().all(|v| degrees(v) == 45.0));
    }

    /// Constants are those of Table 6 and of `materials.toml`.
    #[test]
    fn constants_are_those_of_the_references() {
        let text = include_str!("../../../../references/paper_table6_plate_materials.csv");
        let table = Table::parse("paper_table6_plate_materials.csv", text).unwrap();
        let text = include_str!("../../../../references/materials.toml");
        let entries: toml::Table = text.parse().unwrap();
        let found = |id: &str, name: &str| entries[id][name].as_float().unwrap();
        for (body, column) in [(0, "projectile"), (1, "target")] {
            let printed = table.column(column).unwrap();
            for eos in EOS {
                let material = &scene(Preset::Default, &format!("eos-{eos}"), 4).materials[body];
                let strength = material.strength.unwrap();
                let Some(Flow::Hardening { y_0, kappa, alpha, eta, melt, .. }) = strength.flow
                else {
                    panic!("no hardening")
                };
                let EosData::MieGruneisen { c0, s, gamma_0, c_v, .. } = material.eos else {
                    panic!("no solid")
                };
                let strain = material.failure.plastic_strain.unwrap();
                assert_eq!(
                    [material.density, strength.shear_modulus, y_0, kappa, alpha, eta, melt],
                    printed[..7]
                );
                assert_eq!([c_v, strain], printed[7..]);
                let id = if body == 0 { "al_paper_2_70" } else { eos };
                let constants = ["c0", "s1", "gamma0"].map(|name| found(id, name));
                assert_eq!([c0, s, gamma_0], constants, "{id}");
            }
        }
        let spall = SPHERE_METAL.spall.unwrap();
        assert_eq!(spall, found("spall_al_6061", "spall_strength"));
    }
}
