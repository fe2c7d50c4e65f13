//! Choices of a method changed one at a time.

use whipple_solver::method::{
    Conduction, Density, Heating, Integrator, Method, Preset, SoundSpeed,
};

/// Choices changed one at a time, at the drawn size: what is each worth?
pub(super) const VARIANTS: &[&str] = &[
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
pub(super) const SUPPORTS: [(&str, f64); 4] =
    [("support-1.5", 1.5), ("support-1.75", 1.75), ("support-2.25", 2.25), ("support-2.5", 2.5)];

/// A method with one choice changed.
pub(super) fn varied(method: Method, variant: &str) -> Method {
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
pub(super) fn variants_of(preset: Preset) -> &'static [&'static str] {
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
