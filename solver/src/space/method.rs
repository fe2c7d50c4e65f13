//! The numerical choices of a run in three dimensions, as plain data, and the presets.

use serde::{Deserialize, Serialize};

use crate::method::{Density, Heating, Integrator, Preset, Viscosity};

/// Smallest sound speed over the velocity of approach.
const COLDEST: f64 = 1e-9;

/// Reading of the printed yield function, Eqs. (39)-(46).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum YieldNorm {
    /// The uniaxial yield stress is `Y` at any stretch: von Mises.
    Mises,
    /// `Y` is the yield stress in shear, with `N^p` the identity at rest.
    J2,
    /// Eqs. (39)-(43) as printed: uniaxial yield at 2.12 `Y`.
    AsPrinted,
}

/// Which particles are ellipsoids.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Particles {
    /// Those of cells with unequal edges; where edges are equal, particles are spheres, which do not rotate.
    #[default]
    Fitting,
    /// All of cells that no mapping has moved.
    Ellipsoids,
}

/// Pressure of the particles of a solid that is less dense than at rest (decision 0025).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Expansion {
    /// That of the whole equation of state, not below zero; elements pull beside it.
    Whole,
    /// Of intact material its thermal part alone: the cold tension is that of the elements.
    Thermal,
}

/// How fast a failed element loses its strength, Eq. (47).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Release {
    /// Over this number of steps, `n_hat`.
    Steps(f64),
    /// Over the time in which sound crosses this number of elements.
    Crossings(f64),
}

/// Every numerical choice of a run. Each can be overridden alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Method {
    /// Density scheme.
    pub density: Density,
    /// Time integration: compatible, or, where contacts carry the pressure, a single pass.
    pub integrator: Integrator,
    /// Split of the viscous heat of (60): between the pair, or the scene is refused.
    pub heating: Heating,
    /// Which particles are ellipsoids.
    #[serde(default)]
    pub particles: Particles,
    /// Pressure of the particles of an expanded solid.
    pub expansion: Expansion,
    /// Reading of the yield function.
    pub yield_norm: YieldNorm,
    /// Form of the viscosity and of the conduction.
    pub viscosity: Viscosity,
    /// Linear viscosity coefficient, `c_o` of Eq. (53).
    pub visc_linear: f64,
    /// Quadratic viscosity coefficient, `c_1` of Eq. (53).
    pub visc_quad: f64,
    /// Coefficient of the limited viscosity on receding bonds, over the sound speed.
    pub visc_expansion: f64,
    /// Coefficient of the viscous pressure of collapsing pyramids; zero for none.
    pub visc_volume: f64,
    /// Coefficient of the drag against hourglass modes of solids without strength; zero for none
    /// (decision 0019).
    pub visc_hourglass: f64,
    /// The same of solids with strength.
    pub visc_hourglass_strong: f64,
    /// Steepness of the limiter: how small a neighbouring jump still explains a bond's own.
    pub limiter: f64,
    /// Heat diffusion coefficient: `k_o` of Eq. (57), or of the flux in shocks; zero for none.
    pub heat_coeff: f64,
    /// Part of the opposite corners in the pressure of a pyramid (decision 0013): 1 moves nodes and
    /// centroids alike in a smooth field, 0 is the plain mean.
    pub balance: f64,
    /// Stiffness of the hourglass modes of elements, over that of a cell; zero for none. In gas, of
    /// pyramids that are denser than their cell.
    pub hourglass: f64,
    /// Stiffness of the motion of centroids against corners, over that of a cell; zero for none.
    pub centring: f64,
    /// Tolerance of the contact condition (35): contact while
    /// `zeta (rho/rho_o)^(1/3) < 1 + tolerance`.
    pub contact_tolerance: f64,
    /// Largest `zeta` of a contact.
    pub contact_reach: f64,
    /// `zeta` at which the kernel ends; used by the kernel scheme alone.
    pub kernel_support: f64,
    /// Loss of strength of failed elements.
    pub release: Release,
    /// Whether a tensile strength of a material fails its elements.
    pub spall: bool,
    /// Time step over the limiters' own.
    pub cfl: f64,
}

impl Method {
    /// Distance, in contact lengths, up to which particles act on each other.
    #[must_use]
    pub fn reach(&self) -> f64 {
        match self.density {
            Density::Kernel => self.kernel_support,
            Density::Nonholonomic | Density::Hybrid => self.contact_reach,
        }
    }

    /// Coefficient of the viscous force of a contact over its impedance, Eq. (53), or that of the limited
    /// viscosity: a contact has no neighbours that could explain its jump. `slope` is that of the shock
    /// speed.
    pub(super) fn steepness(&self, approach: f64, sound: f64, slope: f64) -> f64 {
        // Of cold gas, whose impedance is nothing, the coefficient must still be a number.
        let sound = sound.max(COLDEST * approach);
        match self.viscosity {
            Viscosity::Pairwise => self.visc_linear * (1.0 + self.visc_quad * approach / sound),
            Viscosity::Limited => {
                let steep = self.visc_quad * slope * approach / sound;
                steep + (steep * steep + self.visc_linear * self.visc_linear).sqrt()
            }
        }
    }
}

impl Preset {
    /// The choices of the preset in three dimensions.
    #[must_use]
    pub fn space(self) -> Method {
        let default = Method {
            density: Density::Hybrid,
            integrator: Integrator::Compatible,
            heating: Heating::Pair,
            particles: Particles::Fitting,
            expansion: Expansion::Thermal,
            yield_norm: YieldNorm::Mises,
            viscosity: Viscosity::Limited,
            visc_linear: 0.7,
            visc_quad: 1.0,
            visc_expansion: 0.5,
            visc_volume: 0.0,
            visc_hourglass: 0.1,
            visc_hourglass_strong: 0.0,
            limiter: 2.0,
            heat_coeff: 1.0,
            balance: 1.0,
            hourglass: 0.0,
            centring: 0.0,
            contact_tolerance: 0.06,
            contact_reach: 1.12,
            kernel_support: 1.7,
            release: Release::Crossings(5.0),
            spall: true,
            cfl: 0.9,
        };
        match self {
            Self::Paper => Method {
                density: Density::Nonholonomic,
                expansion: Expansion::Whole,
                viscosity: Viscosity::Pairwise,
                visc_linear: 0.3,
                visc_quad: 0.0,
                visc_expansion: 0.0,
                visc_hourglass: 0.0,
                heat_coeff: 0.1,
                release: Release::Steps(20.0),
                spall: false,
                ..default
            },
            Self::Default => default,
        }
    }
}
