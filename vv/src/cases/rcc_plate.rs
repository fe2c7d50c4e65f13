//! The paper's fourth problem: an aluminium sphere through a plate of carbon-carbon.

mod photos;
mod problem;

use whipple_solver::method::Preset;
use whipple_solver::space::scene::Scene;

use self::problem::{CHOICES, ID, SIZES};
use super::parts::perforation;
use super::{Case, Choice, Claim, Level, default_run};
use crate::plots::Figure;
use crate::record::{Records, RunKey};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct RccPlate;

/// A run of a variant in `default`, at the smallest size.
fn varied(variant: &str) -> RunKey {
    default_run(ID, SIZES[0]).variant(variant)
}

impl Case for RccPlate {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Aluminium sphere on a plate of carbon-carbon"
    }

    fn about(&self) -> &'static str {
        "x"
    }

    fn source(&self) -> &'static str {
        "paper"
    }

    fn variants(&self) -> &'static [&'static str] {
        &problem::VARIANTS
    }

    fn choices(&self) -> &'static [Choice] {
        &CHOICES
    }

    fn default_size(&self) -> usize {
        SIZES[0]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        problem::scene(preset, variant, n).into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let shown = *key == varied("");
        perforation::measure(driver, scene, |driver, time| {
            if shown { photos::take(driver, scene, time) } else { Ok(()) }
        })
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &perforation::UNITS
    }

    fn runs(&self, _level: Level) -> Vec<RunKey> {
        vec![varied("")]
    }

    fn claims(&self) -> Vec<Claim> {
        vec![]
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &perforation::TABULATED
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &perforation::QUANTITIES
    }

    fn figures(&self, _records: &Records) -> Vec<Figure> {
        Vec::new()
    }
}
