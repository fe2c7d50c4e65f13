//! The numerical choices of a run, as plain data, and the presets that fill them in.

use serde::{Deserialize, Serialize};

/// How the density follows from the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Density {
    /// Integrated from the contact kinematics, Eqs. (34)-(36): the paper's scheme.
    Nonholonomic,
    /// Summed over a kernel: the rival of the paper's Table 7.
    Kernel,
    /// Taken from the segments between neighbours (decision 0003).
    Hybrid,
}

/// Who receives the heat of the viscous force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Heating {
    /// Eq. (60) as printed, with the sign of Eq. (51) mended: `f . v` of each particle. Depends on
    /// the frame (decision 0005).
    Printed,
    /// The dissipation of a pair, half to each. Independent of the frame.
    Pair,
}

/// Form of the artificial viscosity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Viscosity {
    /// Eqs. (51)-(53), between all converging pairs with zeta < 1.
    Pairwise,
    /// On the part of the velocity jump of nearest neighbours that the jumps around it do not
    /// explain, in both directions (decision 0006).
    Limited,
}

/// Form of the artificial heat diffusion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Conduction {
    /// None: the scene carries no code and no memory for it.
    None,
    /// Eqs. (56)-(57), between all pairs with zeta < 1.
    Linear,
    /// In proportion to the limited velocity jump, so in shocks only (decision 0006).
    Shock,
}

/// Which sound speed the viscosity and the conduction see.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SoundSpeed {
    /// From the total internal energy, `u_o` included: the reading that gives Table 2
    /// (decision 0004).
    Total,
    /// From the equation of state.
    Thermodynamic,
    /// Constant, from the reference energy `u_o`: a sensitivity run for the paper's tables.
    Reference,
}

/// How the equations are advanced in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Explicit midpoint rule: second order, one pass over the pairs a stage.
    SinglePass,
    /// Midpoint rule whose work is done by the force over the step's own mean velocity: total
    /// energy is conserved to round-off (decision 0007).
    Compatible,
}

/// Every numerical choice of a run. Each can be overridden alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Method {
    /// Density scheme.
    pub density: Density,
    /// Split of the viscous heat.
    pub heating: Heating,
    /// Form of the viscosity.
    pub viscosity: Viscosity,
    /// Linear viscosity coefficient, `c_o` of Eq. (53).
    pub visc_linear: f64,
    /// Quadratic viscosity coefficient, `c_1` of Eq. (53).
    pub visc_quad: f64,
    /// Coefficient of the limited viscosity on receding pairs, over the sound speed.
    pub visc_expansion: f64,
    /// Steepness of the limiter: how small a neighbouring jump still explains a pair's own.
    pub limiter: f64,
    /// Form of the heat diffusion.
    pub conduction: Conduction,
    /// Heat diffusion coefficient, `k_o` of Eq. (57).
    pub heat_coeff: f64,
    /// Sound speed of viscosity and conduction.
    pub sound_speed: SoundSpeed,
    /// Time integration.
    pub integrator: Integrator,
    /// Time step over the harmonic sum of the limiters' own.
    pub cfl: f64,
    /// Support of the kernel in units of the particle spacing; used by the kernel scheme alone.
    pub kernel_support: f64,
}

/// Steepness of the limiter (decision 0006).
const LIMITER: f64 = 12.0;

/// Largest coefficient of a viscosity or a conduction. At 1 it stops what closes within about the time
/// in which sound crosses a cell; fronts spread over about so many cells, and steps shrink by as much.
pub(crate) const STRONGEST: f64 = 100.0;

/// Why there is a largest one.
pub(crate) const STRONGEST_WHY: &str =
    "fronts spread over so many cells, and time steps shrink by as much";

/// A named set of choices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Reproduces the paper's tables. Not Galilean invariant; for replication only.
    Paper,
    /// What every other claim rests on.
    Default,
}

impl Preset {
    /// The choices of the preset; constants of Table 1 for the paper's.
    #[must_use]
    pub fn method(self) -> Method {
        match self {
            Self::Paper => Method {
                density: Density::Nonholonomic,
                heating: Heating::Printed,
                viscosity: Viscosity::Pairwise,
                visc_linear: 1.0,
                visc_quad: 0.0,
                visc_expansion: 0.0,
                limiter: LIMITER,
                conduction: Conduction::Linear,
                heat_coeff: 0.1,
                sound_speed: SoundSpeed::Total,
                integrator: Integrator::SinglePass,
                cfl: 0.14,
                kernel_support: 2.0,
            },
            Self::Default => Method {
                density: Density::Hybrid,
                heating: Heating::Pair,
                viscosity: Viscosity::Limited,
                visc_linear: 0.25,
                visc_quad: 0.25,
                visc_expansion: 1.5,
                limiter: LIMITER,
                conduction: Conduction::Shock,
                heat_coeff: 1.75,
                sound_speed: SoundSpeed::Thermodynamic,
                integrator: Integrator::Compatible,
                cfl: 0.3,
                kernel_support: 2.0,
            },
        }
    }
}

impl Preset {
    /// Both presets.
    pub const ALL: [Self; 2] = [Self::Paper, Self::Default];

    /// Name, as on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Default => "default",
        }
    }
}

impl Heating {
    /// Name, as `--set` takes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Printed => "printed",
            Self::Pair => "pair",
        }
    }
}

impl Integrator {
    /// Name, as `--set` takes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::SinglePass => "single_pass",
            Self::Compatible => "compatible",
        }
    }
}

impl Density {
    /// All schemes.
    pub const ALL: [Self; 3] = [Self::Nonholonomic, Self::Kernel, Self::Hybrid];

    /// Name, as on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nonholonomic => "nonholonomic",
            Self::Kernel => "kernel",
            Self::Hybrid => "hybrid",
        }
    }
}
