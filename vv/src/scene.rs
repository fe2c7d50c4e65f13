//! A scene of either solver.

use serde::{Deserialize, Serialize};
use whipple_solver::error::SceneError;
use whipple_solver::method::Density;
use whipple_solver::units::Units;
use whipple_solver::{scene, space};

/// A scene in one dimension or in three. Written down it is the scene itself: the two have no form
/// in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum AnyScene {
    /// Along a line.
    Line(scene::Scene),
    /// In space.
    Space(space::Scene),
}

impl AnyScene {
    /// Checks everything that a simulation takes for granted.
    ///
    /// # Errors
    /// The first value that cannot be used.
    pub fn validate(&self) -> Result<(), SceneError> {
        match self {
            Self::Line(scene) => scene.validate(),
            Self::Space(scene) => scene.validate(),
        }
    }

    /// The scene, if it is along a line.
    #[must_use]
    pub fn line(&self) -> Option<&scene::Scene> {
        match self {
            Self::Line(scene) => Some(scene),
            Self::Space(_) => None,
        }
    }

    /// The scene, if it is in space.
    #[must_use]
    pub fn space(&self) -> Option<&space::Scene> {
        match self {
            Self::Line(_) => None,
            Self::Space(scene) => Some(scene),
        }
    }

    /// Time at which the run ends.
    #[must_use]
    pub fn stop_time(&self) -> f64 {
        match self {
            Self::Line(scene) => scene.stop_time,
            Self::Space(scene) => scene.stop_time,
        }
    }

    /// The units that it is stated in.
    #[must_use]
    pub fn units(&self) -> Units {
        match self {
            Self::Line(scene) => scene.units,
            Self::Space(scene) => scene.units,
        }
    }

    /// Another time at which the run ends.
    pub fn set_stop_time(&mut self, time: f64) {
        match self {
            Self::Line(scene) => scene.stop_time = time,
            Self::Space(scene) => scene.stop_time = time,
        }
    }

    /// Its density scheme.
    #[must_use]
    pub fn density(&self) -> Density {
        match self {
            Self::Line(scene) => scene.method.density,
            Self::Space(scene) => scene.method.density,
        }
    }

    /// Another density scheme.
    pub fn set_density(&mut self, density: Density) {
        match self {
            Self::Line(scene) => scene.method.density = density,
            Self::Space(scene) => scene.method.density = density,
        }
    }

    /// Whether two scenes state the same problem, numerical choices apart.
    #[must_use]
    pub fn same_problem(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Line(a), Self::Line(b)) => {
                (&a.materials, &a.bodies, a.boundaries, a.stop_time)
                    == (&b.materials, &b.bodies, b.boundaries, b.stop_time)
            }
            (Self::Space(a), Self::Space(b)) => {
                (&a.materials, &a.bodies, &a.walls, a.stop_time)
                    == (&b.materials, &b.bodies, &b.walls, b.stop_time)
            }
            _ => false,
        }
    }
}

impl From<scene::Scene> for AnyScene {
    fn from(scene: scene::Scene) -> Self {
        Self::Line(scene)
    }
}

impl From<space::Scene> for AnyScene {
    fn from(scene: space::Scene) -> Self {
        Self::Space(scene)
    }
}
