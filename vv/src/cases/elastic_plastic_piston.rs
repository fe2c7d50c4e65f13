//! A column with strength against a wall: elastic precursor and plastic wave.

use whipple_solver::method::Preset;
use whipple_solver::space::method::{Method, YieldNorm};
use whipple_solver::space::scene::{EosData, Failure, Flow, GammaLaw, Material, Scene, Strength};
use whipple_solver::units::Units;

use super::figures::{beside_exact, figure, profiles};
use super::parts::column::Column;
use super::parts::fit::slope;
use super::parts::planes::{Plane, Planes, front, mean};
use super::parts::{Columns, late_times};
use super::{
    Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, default_run, named, paper_run,
    run_of,
};
use crate::exact::gruneisen::MieGruneisen;
use crate::exact::hugoniot::Hugoniot;
use crate::exact::piston::{Piston, PistonState, Structure};
use crate::exact::strength::{Elasticity, Strength as Law, YieldReading};
use crate::plots::{Axis, Figure, Panel};
use crate::record::{Records, RunKey};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct ElasticPlasticPiston;

const ID: &str = "elastic-plastic-piston";
/// Length of the column in cm.
const LENGTH: f64 = 8.0;
/// Cells across the column.
const ACROSS: usize = 2;
/// Speed of the column in cm/us.
const SPEED: f64 = 0.01;
/// Aluminium of the reference: density, `c0`, `s`, constant Grueneisen coefficient.
const SOLID: [f64; 4] = [2.79, 0.533, 1.34, 2.0];
/// Its shear modulus and yield stress in Mbar.
const SHEAR: f64 = 0.286;
const YIELD: f64 = 0.0026;
/// Part of the column that the precursor runs through.
const RUN: f64 = 0.75;
/// Times at which the waves are located.
const LOOKS: usize = 20;
const SIZES: [usize; 4] = [40, 80, 160, 320];
const J2: &str = "j2";
const AS_PRINTED: &str = "as-printed";
const VARIANTS: [&str; 3] = ["", J2, AS_PRINTED];
/// Millimetres per microsecond, that is km/s, of a cm/us.
const KM_S: f64 = 10.0;

/// The reading of the yield stress of a variant, in both vocabularies.
fn reading(variant: &str) -> (YieldNorm, YieldReading) {
    match variant {
        J2 => (YieldNorm::J2, YieldReading::Shear),
        AS_PRINTED => (YieldNorm::AsPrinted, YieldReading::AsPrinted),
        _ => (YieldNorm::Mises, YieldReading::Mises),
    }
}

/// The two waves, seen from the undeformed column.
struct Exact {
    at_yield: PistonState,
    driven: PistonState,
    /// Speeds of precursor and plastic wave in the undeformed column.
    speeds: [f64; 2],
}

impl Exact {
    fn of(variant: &str) -> Result<Self, RunError> {
        let [density, c0, s, gamma] = SOLID;
        let eos = MieGruneisen::constant_gamma(Hugoniot::new(density, c0, s)?, gamma)?;
        let law = Law::new(Elasticity::IsochoricGreen(reading(variant).1), SHEAR, YIELD)?;
        let piston = Piston::new(&eos, &law, SPEED)?;
        let Structure::TwoWave { elastic, plastic } = piston.structure() else {
            return Err(RunError::Reference("the piston drives no two waves".into()));
        };
        let at_yield = *piston.at_yield();
        let plastic = at_yield.density / density * (plastic - at_yield.velocity);
        Ok(Self { at_yield, driven: *piston.driven(), speeds: [elastic, plastic] })
    }

    /// Velocity that the column has lost at a place of the undeformed column.
    fn lost(&self, place: f64, time: f64) -> f64 {
        let [elastic, plastic] = self.speeds.map(|speed| speed * time);
        match place {
            x if x <= plastic => self.driven.velocity,
            x if x <= elastic => self.at_yield.velocity,
            _ => 0.0,
        }
    }
}

/// Velocity that a plane has lost.
fn lost(plane: &Plane) -> f64 {
    plane.velocity + SPEED
}

impl Case for ElasticPlasticPiston {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Elastic-plastic piston"
    }

    fn about(&self) -> &'static str {
        "A column of elastic, perfectly plastic aluminium of 8 cm hits a wall at 100 m/s: an elastic \
         precursor runs ahead of the plastic wave. Waves are located where half of their rise in \
         velocity is reached, and their speeds are slopes over the second half of the run, in the \
         undeformed column. The level of the precursor is the mean velocity over the middle two \
         fifths between the waves; behind the plastic wave, means go from 0.2 to 0.8 of its way; the \
         stress at the wall is its impulse over the second half of the run. The plain variant reads the \
         yield stress as von Mises, `j2` as shear and `as-printed` as Eqs. (39)-(43) stand: the \
         precursor tells them apart, and each is judged by its own exact solution. n counts the cells \
         along the column, two across between mirrors."
    }

    fn source(&self) -> &'static str {
        "two-wave solution with the isochoric Green law; constants of `lieberman_al` in \
         `references/elastic_plastic_piston.csv`"
    }

    fn variants(&self) -> &'static [&'static str] {
        &VARIANTS
    }

    fn default_size(&self) -> usize {
        SIZES[2]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let column = Column { length: LENGTH, cells: n, across: ACROSS };
        let [density, c0, s, gamma_0] = SOLID;
        let law = GammaLaw::Steinberg(gamma_0);
        // Neither hardens nor softens.
        let flow = Flow::Hardening {
            y_0: YIELD,
            kappa: 0.0,
            alpha: 0.0,
            eta: 0.0,
            reference: 300.0,
            melt: 1220.0,
        };
        let metal = Material {
            name: "aluminium".into(),
            density,
            eos: EosData::MieGruneisen { c0, s, gamma_0, law, c_v: 0.884e-5, theta_0: 300.0 },
            strength: Some(Strength { shear_modulus: SHEAR, flow: Some(flow) }),
            failure: Failure::default(),
        };
        // Only constants of this file come here; a test builds every scene.
        let fastest = Exact::of(variant).map_or(1.0, |exact| exact.speeds[0]);
        Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: RUN * LENGTH / fastest,
            method: Method { yield_norm: reading(variant).0, ..preset.space() },
            walls: column.walls(),
            bodies: vec![column.body(&metal.name, 0.5 * LENGTH, -SPEED)],
            materials: vec![metal],
        }
        .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let exact = Exact::of(&key.variant)?;
        let planes = Planes::new(driver.solver(), 0, 0.0);
        let (first, second) = (exact.at_yield.velocity, exact.driven.velocity);
        let levels = [0.5 * first, 0.5 * (first + second)];
        let mut seen = [Vec::new(), Vec::new()];
        let mut pushed = Vec::new();
        for time in late_times(scene.stop_time, LOOKS) {
            driver.advance_to(time)?;
            let now = driver.look(|solver, balance| {
                let layers = planes.look(solver);
                let places = levels.map(|level| front(&layers, lost, level).unwrap_or(f64::NAN));
                vec![solver.time(), balance.wall_impulse[0], places[0], places[1]]
            })?;
            pushed.push((now[0], now[1]));
            for (seen, &place) in seen.iter_mut().zip(&now[2..]) {
                // Not a number before the front is there.
                if place.is_finite() {
                    seen.push((now[0], place));
                }
            }
        }
        let layers = planes.look(driver.solver());
        let time = driver.solver().time();
        let [ahead, behind] = seen.each_ref().map(|s| s.last().map_or(f64::NAN, |p| p.1));
        let gap = ahead - behind;
        let level = mean(&layers, lost, [behind + 0.3 * gap, behind + 0.7 * gap]);
        let plateau = [0.2 * behind, 0.8 * behind];
        let width = Column { length: LENGTH, cells: key.n, across: ACROSS }.width();
        let stress = slope(&pushed) / (width * width);

        let mut findings = Findings::default();
        let [elastic, plastic] = seen.each_ref().map(|s| slope(s));
        findings.enter("precursor_speed", KM_S * elastic);
        findings.enter("precursor_speed_error", elastic / exact.speeds[0] - 1.0);
        findings.enter("plastic_speed", KM_S * plastic);
        findings.enter("plastic_speed_error", plastic / exact.speeds[1] - 1.0);
        // 10 000 m/s are a cm/us.
        findings.enter("precursor_m_s", 1e4 * level);
        findings.enter("precursor_error", level / first - 1.0);
        let density = mean(&layers, |l| l.density, plateau);
        findings.enter("density_error", density / exact.driven.density - 1.0);
        let pressure = mean(&layers, |l| l.pressure, plateau);
        findings.enter("pressure_error", pressure / exact.driven.pressure - 1.0);
        findings.enter("stress_error", stress / exact.driven.stress - 1.0);
        let misfit = |l: &Plane| (lost(l) - exact.lost(l.place, time)).abs() / SPEED;
        findings.enter("velocity_l1", layers.iter().map(misfit).sum::<f64>() / layers.len() as f64);
        let mut profile = Columns::default();
        for l in &layers {
            profile.row([
                ("place", l.place),
                ("velocity", 1e4 * lost(l)),
                ("exact", 1e4 * exact.lost(l.place, time)),
            ]);
        }
        findings.profile = Some(profile.series());
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[("place", "cm"), ("velocity", "m/s"), ("exact", "m/s")]
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let mut keys = vec![default_run(ID, SIZES[0]), default_run(ID, SIZES[1])];
        keys.extend(VARIANTS.map(|v| default_run(ID, SIZES[2]).variant(v)));
        if level >= Level::Standard {
            keys.push(default_run(ID, SIZES[3]));
            keys.push(paper_run(ID, SIZES[2]));
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let source = "two-wave solution; tolerance of `references/verification_problems.toml`";
        let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
        let mut out = Vec::new();
        for variant in VARIANTS {
            let name = named(variant, "mises");
            let key = default_run(ID, SIZES[2]).variant(variant);
            for (norm, text) in [
                ("precursor_speed_error", "speed of the precursor, error"),
                ("precursor_error", "velocity behind the precursor, error"),
                ("plastic_speed_error", "speed of the plastic wave, error"),
                ("stress_error", "stress at the wall, error"),
                ("pressure_error", "pressure behind the plastic wave, error"),
            ] {
                out.push(must.claim(
                    format!("{name}: {text}"),
                    Quantity::Norm(key.clone(), norm),
                    Wanted::WithinZero(0.02),
                ));
            }
        }
        // Precursor and weak plastic wave hardly steepen: they spread as linear waves do.
        let source =
            "a linear wave under a viscosity of first order: width goes with the root of the cell";
        let order = Claims { source, ..must };
        let keys = SIZES.map(|n| default_run(ID, n));
        out.push(order.claim(
            "order of the L1 error of the velocity, mises",
            Quantity::Order(keys.to_vec(), "velocity_l1"),
            Wanted::Around(0.5, 0.25),
        ));
        out.extend(super::conservation_in_space(ID, &default_run(ID, SIZES[2])));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("precursor_m_s", "precursor, m/s"),
            ("precursor_error", "its error"),
            ("precursor_speed_error", "error of its speed"),
            ("plastic_speed_error", "error of the plastic speed"),
            ("stress_error", "error of the stress"),
            ("pressure_error", "error of P"),
            ("velocity_l1", "L1 of velocity"),
        ]
    }

    fn errors(&self) -> &'static [&'static str] {
        &[
            "precursor_error",
            "precursor_speed_error",
            "plastic_speed_error",
            "stress_error",
            "pressure_error",
            "velocity_l1",
        ]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let panels = VARIANTS.iter().filter_map(|variant| {
            let [place, lost] =
                ["place in the undeformed column, cm", "velocity lost, m/s"].map(Axis::linear);
            let runs = [Preset::Default, Preset::Paper]
                .map(|preset| (preset.name(), run_of(ID, preset, SIZES[2]).variant(variant)));
            let runs = profiles(records, runs);
            let panel = Panel::new(named(variant, "mises"), place, lost);
            let exact = Exact::of(variant).ok()?;
            // The time at which the run stops.
            let time = RUN * LENGTH / exact.speeds[0];
            let field = |place: f64| Ok::<_, RunError>(1e4 * exact.lost(place, time));
            beside_exact(panel, &runs, ["place", "velocity"], "exact", field)
        });
        let caption = "Velocity that the column has lost, with the yield stress read in three ways, at \
                       the end of the run, 160 cells.";
        figure("elastic-plastic-piston-profiles", caption, panels)
    }
}
