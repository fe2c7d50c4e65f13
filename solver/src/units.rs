//! The unit systems in which a scene may be stated. One system holds for a whole scene.

use serde::{Deserialize, Serialize};

/// A consistent unit system; the solver never converts, it only labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Units {
    /// Dimensionless, as the gas problems are.
    None,
    /// Inch, pound-force, second; mass in lbf s^2/in.
    InLbfS,
    /// Centimetre, gram, microsecond; pressure in Mbar.
    CmGUsMbar,
}

impl Units {
    /// Label of the unit of a dimension, empty where the scene is dimensionless.
    #[must_use]
    pub fn label(self, dimension: Dimension) -> &'static str {
        use Dimension as D;
        match (self, dimension) {
            (Self::None, _) => "",
            (Self::InLbfS, D::Length) => "in",
            (Self::InLbfS, D::Time) => "s",
            (Self::InLbfS, D::Velocity) => "in/s",
            (Self::InLbfS, D::Density) => "lbf s²/in⁴",
            (Self::InLbfS, D::Pressure) => "psi",
            (Self::InLbfS, D::SpecificEnergy) => "in²/s²",
            (Self::CmGUsMbar, D::Length) => "cm",
            (Self::CmGUsMbar, D::Time) => "µs",
            (Self::CmGUsMbar, D::Velocity) => "cm/µs",
            (Self::CmGUsMbar, D::Density) => "g/cm³",
            (Self::CmGUsMbar, D::Pressure) => "Mbar",
            (Self::CmGUsMbar, D::SpecificEnergy) => "Mbar cm³/g",
            (_, D::Temperature) => "K",
        }
    }
}

/// Physical dimensions that appear in results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Position, size.
    Length,
    /// Time.
    Time,
    /// Velocity.
    Velocity,
    /// Mass per volume.
    Density,
    /// Force per area.
    Pressure,
    /// Energy per mass.
    SpecificEnergy,
    /// Temperature.
    Temperature,
}
