//! The paper's third problem: a tungsten rod through a steel plate at 60 degrees.

mod claims;
mod figures;
mod history;
mod photos;
mod problem;
mod published;
mod tables;

use whipple_solver::method::{Density, Preset};
use whipple_solver::space::scene::Scene;

use self::problem::{AS_PRINTED, ID, SIZES};
use super::parts::photos::take;
use super::parts::schemes::{Error, Schemes};
use super::parts::shapes::Shapes;
use super::{Case, Claim, Level, run_of};
use crate::plots::Figure;
use crate::record::{Records, RunKey, Scheme};
use crate::report::Table;
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct LongRod;

/// Which shape of its cells is cheaper.
const SHAPES: Shapes = Shapes {
    case: ID,
    sizes: SIZES,
    answers: &[
        ("residual_length_cm", "residual length", "cm"),
        ("residual_velocity_km_s", "residual velocity", "km/s"),
    ],
    which: "edges along the rod and in the plane of the plate",
};

/// Which density is cheaper at equal error, against the length in the experiment.
const SCHEMES: Schemes = Schemes {
    case: ID,
    sizes: &[SIZES[0]],
    error: Error::Off("residual_length_cm", published::LENGTH.measured),
    name: "the length, against the experiment",
};

/// Time between two entries of the histories, in us.
const EVERY: f64 = 1.0;

/// The run that stands beside a row of Table 5: the paper's method on the paper's numbers, and `default`
/// on those exchanged and converted.
fn key(preset: Preset, n: usize) -> RunKey {
    let reading = match preset {
        Preset::Paper => AS_PRINTED,
        Preset::Default => "",
    };
    run_of(ID, preset, n).variant(reading)
}

/// A run of a variant, at the smallest size.
fn varied_key(preset: Preset, variant: &str) -> RunKey {
    run_of(ID, preset, SIZES[0]).variant(variant)
}

/// The run of [`key`] with the density of a kernel, at the smallest size.
fn kernel_key(preset: Preset) -> RunKey {
    RunKey {
        scheme: Scheme::Particles { preset, density: Density::Kernel },
        ..key(preset, SIZES[0])
    }
}

impl Case for LongRod {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Tungsten long rod on an oblique steel plate"
    }

    fn about(&self) -> &'static str {
        "The paper's third problem: a rod of tungsten alloy, 0.5 cm by 7.5 cm, hits a steel plate of \
         0.5 cm at 60 degrees from the normal with 1.5 km/s and perforates it; in the experiment 6.38 \
         cm are left at 1.46 km/s. Residual is the largest set of elements of the rod that are live \
         and have not failed and that share nodes: its length is its extent along its own principal \
         axis, its velocity the mean of its particles by mass. n counts the cells across rod and \
         plate. The plain variant exchanges the columns of Table 4 that stand under the wrong metal \
         and converts their hardening to Eq. (44); `as-printed` takes the table as it is, `exchanged` \
         does not convert. No spall strength: none was found for these alloys; \
         `references/materials.toml` has 1.7 to 2.0 GPa of a 93 % tungsten alloy. `wide` has twice the \
         plate, `viscosity-0.3`, `viscosity-1` and `viscosity-2` other linear coefficients, \
         `step-0.8` and `step-0.7` shorter steps, `yield-as-printed` the yield function of Eqs. \
         (39)-(43) as it is printed; `hourglass-on` has the drag against hourglass modes that solids \
         without strength have, `centring-on` the motion of centroids against their corners, with \
         0.05 of the stiffness of a cell; `cells-2` and `cells-4` have cells twice and four times as long \
         along the rod and in the plane of the plate. No constant was fitted to this case."
    }

    fn source(&self) -> &'static str {
        "paper, Tables 4 and 5; experiment as quoted there; gaps G1, G2, G3, G23, G25, G28, G29"
    }

    fn variants(&self) -> &'static [&'static str] {
        &problem::VARIANTS
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
        let shown = *key == self::key(Preset::Default, SIZES[0]);
        let mut rows = vec![driver.look(history::look)?];
        if shown {
            take(&photos::WISHES, driver, scene, 0.0)?;
        }
        let entries = (scene.stop_time / EVERY).ceil() as usize;
        for k in 1..=entries {
            let time = (k as f64 * EVERY).min(scene.stop_time);
            driver.advance_to(time)?;
            rows.push(driver.look(history::look)?);
            if shown {
                take(&photos::WISHES, driver, scene, time)?;
            }
        }
        let history = history::columns(&rows);
        let last = |name: &str| history.0[name].last().copied().unwrap_or(f64::NAN);
        let mut findings = Findings::default();
        findings.enter("residual_length_cm", last("length"));
        findings.enter("residual_velocity_km_s", last("velocity"));
        findings.enter("residual_mass_share", last("mass") / history.0["mass"][0]);
        findings.enter("particles", driver.solver().particles() as f64);
        findings.enter("failed_elements", last("failed"));
        findings.history = Some(history);
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("time", "µs"),
            ("length", "cm"),
            ("velocity", "km/s"),
            ("mass", "g"),
            ("kinetic", "kJ"),
            ("internal", "kJ"),
            ("shear", "kJ"),
            ("tension", "kJ"),
            ("residual", "kJ"),
            ("momentum_x", "g·cm/µs"),
            ("momentum_y", "g·cm/µs"),
            ("failed", ""),
            ("dt", "µs"),
        ]
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        claims::runs(level)
    }

    fn claims(&self) -> Vec<Claim> {
        claims::all()
    }

    fn references(&self, key: &RunKey, norm: &str) -> Vec<(&'static str, f64)> {
        published::references(key, norm)
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("residual_length_cm", "length, cm"),
            ("residual_velocity_km_s", "velocity, km/s"),
            ("residual_mass_share", "mass left / mass"),
            ("particles", "particles"),
            ("failed_elements", "failed elements"),
        ]
    }

    fn extra_tables(&self, records: &Records) -> Vec<Table> {
        tables::all(records)
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let mut figures = Vec::new();
        figures.extend(figures::histories(records));
        figures.extend(figures::energies(records));
        figures.extend(SHAPES.figure(records));
        figures
    }
}
