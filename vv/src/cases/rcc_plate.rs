//! The paper's fourth problem: an aluminium sphere through a plate of carbon-carbon.

mod claims;
mod figures;
mod photos;
mod problem;
mod tables;

use whipple_solver::method::{Density, Preset};
use whipple_solver::space::scene::Scene;

use self::problem::{CHOICES, ID, SIZES};
use super::parts::perforation;
use super::parts::photos::take;
use super::parts::shapes::Shapes;
use super::{Case, Choice, Claim, Level, default_run};
use crate::plots::Figure;
use crate::record::{Records, RunKey, Scheme};
use crate::report::Table;
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct RccPlate;

/// Which shape of its cells is cheaper.
const SHAPES: Shapes = Shapes {
    case: ID,
    sizes: SIZES,
    answers: &[
        ("hole_diameter_cm", "hole", "cm"),
        ("debris_front_km_s", "front of the cloud", "km/s"),
    ],
    which: "edges in the plane of the plate",
};

/// A run of a variant in `default`, at the smallest size.
fn varied(variant: &str) -> RunKey {
    default_run(ID, SIZES[0]).variant(variant)
}

/// The run of a preset with the density of a kernel, at the smallest size.
fn kernel(preset: Preset) -> RunKey {
    RunKey::new(ID, Scheme::Particles { preset, density: Density::Kernel }, SIZES[0])
}

impl Case for RccPlate {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Aluminium sphere on a plate of carbon-carbon"
    }

    fn about(&self) -> &'static str {
        "The paper's fourth problem: an aluminium sphere, 0.618 cm wide, hits a plate of reinforced \
         carbon-carbon of 0.47 cm with 7 km/s; 10 µs are run. The paper gives neither the angle nor \
         the edge of the plate nor equations of state, and no result but the cost: 45 degrees from the \
         normal and a square of 5.4 cm are taken, with `--angle` 0, 30 and 60 besides, and what is not \
         known of carbon-carbon under shock is a range, `--eos`. n counts the cells through the plate; \
         4, 6 and 8 come near the paper's particle counts. Strength is that of Table 6 as printed, \
         thermal softening of the plate -1 included; the sphere has the spall strength of 6061 in \
         `references/materials.toml`, off in `paper`; none of carbon-carbon was found. The hole is the \
         disc with the area that live elements of the plate leave open of its middle plane: of the \
         largest opening of their largest connected set, so that debris within it and gaps elsewhere \
         do not count. Behind is what is farther beyond the rear face than a quarter of the thickness. \
         The plate is perforated when the hole is 0.1 sphere wide and 0.001 of the sphere's mass is \
         behind, which is seen to 0.1 µs. The front of the cloud is the velocity along the normal than which 1 % of the mass \
         behind is faster; its cone, about the mean velocity, holds 90 % of that mass. `wide` has a \
         plate of 7 cm, `late` runs to 30 µs; `spall-none` takes the spall strength away, `spall-yield` gives the plate its \
         yield stress as one; `strain-0.25` and `strain-1` are other failure strains of the plate, \
         `compression-0.2` and `compression-0.4` other volumes at which elements fail, `softening-0` a \
         plate that heat does not harden, `step-0.8` a shorter step, `cells-2` and `cells-4` cells of the plate twice and four times as long in its \
         plane. No constant was fitted to this \
         case."
    }

    fn source(&self) -> &'static str {
        "paper, Tables 6 and 7; gaps G7, G21, G26, G27; hole by NASA/TM-2009-214785, Eq. 5-34"
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
            let wishes = if shown { &photos::WISHES[..] } else { &[] };
            take(wishes, driver, scene, time)
        })
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &perforation::UNITS
    }

    fn draws(&self, key: &RunKey) -> bool {
        claims::angles().contains(key) || SIZES.iter().any(|&n| *key == default_run(ID, n))
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        claims::runs(level)
    }

    fn claims(&self) -> Vec<Claim> {
        claims::all()
    }

    fn references(&self, key: &RunKey, norm: &str) -> Vec<(&'static str, f64)> {
        if norm == claims::HOLE {
            vec![(claims::EQUATION, claims::nasa(&key.variant))]
        } else {
            Vec::new()
        }
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &perforation::TABULATED
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &perforation::QUANTITIES
    }

    fn extra_tables(&self, records: &Records) -> Vec<Table> {
        tables::all(records)
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let mut figures = figures::all(records);
        figures.extend(SHAPES.figure(records));
        figures
    }
}
