//! Kolsky's bar: the paper's second problem, with the parameters of its Table 3.

use whipple_solver::method::{Conduction, Preset};
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};
use whipple_solver::units::Units;

use super::figures::{beside_exact, figure, histories};
use super::{
    Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, both_presets, conservation,
    default_run, paper_run, run_of,
};
use crate::exact::waves::{Bar, End, StepLoad};
use crate::norms;
use crate::plots::{Axis, Figure, Panel, Series as Curve};
use crate::record::{Records, RunKey, RunRecord, Series};
use crate::run::{Driver, Findings, RunError};
use crate::scene::AnyScene;

/// The case.
pub(super) struct Kolsky;

const ID: &str = "kolsky";
/// Table 3, in inches, pounds-force and seconds; "pci" is a mass density (gap G31).
const LENGTH: f64 = 100.0;
const BULK: f64 = 30.0e6;
const TENSION: f64 = 50.0e3;
const DENSITY: f64 = 0.73e-3;
/// Text of the paper.
const STOP: f64 = 1.0e-3;
const SIZES: &[usize] = &[51, 101, 201, 401];
/// Sizes of the paper's Figures 5 and 6.
const DRAWN: [usize; 2] = [51, 101];
/// When the plateau is averaged, and when the overshoot is sought (design page, section 3).
const PLATEAU: (f64, f64) = (0.32e-3, 0.68e-3);
const CREST: (f64, f64) = (0.25e-3, 0.74e-3);
/// The long run.
const TRANSITS: f64 = 20.0;

const FIXED: &str = "";
const FREE: &str = "free";
const LONG: &str = "20-transits";

fn exact(variant: &str) -> Result<StepLoad, RunError> {
    let end = if variant == FREE { End::Free } else { End::Fixed };
    let bar = Bar::new(LENGTH, (BULK / DENSITY).sqrt(), DENSITY, end)?;
    Ok(StepLoad::new(bar, TENSION)?)
}

/// Time-weighted mean of a history between two times.
fn mean(history: &[(f64, f64)], (from, to): (f64, f64)) -> f64 {
    let (mut area, mut length) = (0.0, 0.0);
    for pair in history.windows(2) {
        let (a, b) = (pair[0].0.max(from), pair[1].0.min(to));
        if b > a {
            area += (b - a) * 0.5 * (pair[0].1 + pair[1].1);
            length += b - a;
        }
    }
    area / length
}

/// Root of the time mean of the squared error, over the plateau velocity.
fn history_rms(history: &[(f64, f64)], load: &StepLoad, stop: f64) -> Result<f64, RunError> {
    let squares = history
        .iter()
        .map(|&(t, v)| Ok((t, (v - load.sample(0.5 * LENGTH, t)?.velocity).powi(2))))
        .collect::<Result<Vec<_>, RunError>>()?;
    Ok(mean(&squares, (0.0, stop)).sqrt() / load.front_velocity())
}

impl Case for Kolsky {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Kolsky's bar"
    }

    fn about(&self) -> &'static str {
        "A steel bar of 100 in is pulled at its end by 50 000 psi from t = 0. The front passes the \
         midpoint at 0.247 ms with 337.87 in/s and comes back at 0.740 ms. The paper does not say \
         what stands at x = 0: both a fixed and a free end are run. Twenty transits show whether \
         the lattice keeps its order in tension, where a density per particle is unstable."
    }

    fn source(&self) -> &'static str {
        "paper, Table 3 and text; Kolsky, Stress Waves in Solids; d'Alembert's solution"
    }

    fn variants(&self) -> &'static [&'static str] {
        &[FIXED, FREE, LONG]
    }

    fn default_size(&self) -> usize {
        DRAWN[1]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let mut method = preset.method();
        // Table 3 lists no conduction, and the linear solid does not feel its temperature.
        method.conduction = Conduction::None;
        let left = if variant == FREE { Boundary::Free } else { Boundary::Fixed };
        let transit = LENGTH / (BULK / DENSITY).sqrt();
        Scene {
            name: ID.into(),
            units: Units::InLbfS,
            stop_time: if variant == LONG { TRANSITS * transit } else { STOP },
            method,
            boundaries: Boundaries { left, right: Boundary::Pressure(-TENSION) },
            materials: vec![Material {
                name: "steel".into(),
                density: DENSITY,
                eos: EosData::Linear { bulk: BULK, c_v: 1.0, theta_0: 0.0 },
            }],
            bodies: vec![Body {
                material: "steel".into(),
                from: 0.0,
                to: LENGTH,
                particles: n,
                layout: Layout::Nodes,
                compression: 1.0,
                interface: Interface::Joined,
                velocity: Profile::Uniform(0.0),
                energy: Profile::Uniform(0.0),
            }],
        }
        .into()
    }

    fn measure(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut Driver<'_>,
    ) -> Result<Findings, RunError> {
        let load = exact(&key.variant)?;
        let middle = (key.n - 1) / 2;
        let mut history = vec![(0.0, 0.0)];
        driver.observe_to(scene.stop_time, |s| {
            history.push((s.time(), s.velocity(middle)));
        })?;

        let plateau = load.front_velocity();
        let mut findings = Findings::default();
        findings.enter("plateau", mean(&history, PLATEAU));
        let crest = history.iter().filter(|(t, _)| (CREST.0..CREST.1).contains(t));
        // At a free end the foot of the returning front lies in the window.
        if key.variant != FREE {
            findings
                .enter("overshoot", crest.fold(0.0_f64, |top, (_, v)| top.max(v / plateau - 1.0)));
        }
        findings.enter("velocity_rms", history_rms(&history, &load, scene.stop_time)?);
        let late = (0.80e-3, 0.95e-3);
        findings.enter("late_level", mean(&history, late) / plateau);
        let arrival = history.iter().find(|(_, v)| *v >= 0.5 * plateau).map_or(f64::NAN, |p| p.0);
        let spacing = LENGTH / (key.n - 1) as f64;
        let early = 0.5 * load_transit() - arrival;
        findings.enter("arrival_spacings", early * (BULK / DENSITY).sqrt() / spacing);

        let s = driver.solver().snapshot();
        let x: Vec<f64> = s.x.iter().map(|x| x / spacing).collect();
        findings.enter("roughness", norms::roughness(&x)?);
        let strain = driver.solver().strain_energy();
        let integrated = driver.solver().ledger().strain;
        findings.enter(
            "strain_residual",
            ((integrated - strain) / strain.max(f64::MIN_POSITIVE)).abs(),
        );
        findings.norms.retain(|_, value| value.is_finite());

        let exact = history.iter().map(|&(t, _)| Ok(load.sample(0.5 * LENGTH, t)?.velocity));
        let exact = exact.collect::<Result<Vec<f64>, RunError>>()?;
        let mut series = Series::default();
        series.0.insert("time_ms".into(), history.iter().map(|p| 1e3 * p.0).collect());
        series.0.insert("velocity".into(), history.iter().map(|p| p.1).collect());
        series.0.insert("velocity_exact".into(), exact);
        findings.history = Some(series);
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[("time_ms", ""), ("velocity", "in/s"), ("velocity_exact", "in/s")]
    }

    fn draws(&self, key: &RunKey) -> bool {
        DRAWN.contains(&key.n) && key.variant != LONG
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let sizes = if level == Level::Quick { &SIZES[..2] } else { SIZES };
        let mut keys = both_presets(ID, sizes);
        for variant in [FREE, LONG] {
            keys.extend(both_presets(ID, &DRAWN).into_iter().map(|k| k.variant(variant)));
        }
        keys.extend(DRAWN.map(|n| RunKey::new(ID, super::kernel_default(), n)));
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let default = |variant: &str| default_run(ID, DRAWN[1]).variant(variant);
        let norm = |variant: &str, name| Quantity::Norm(default(variant), name);
        let must = Claims::new(ID, Kind::Verification, Weight::Must, wanted!("exact solution"));
        let aim = Claims { weight: Weight::Aim, ..must };
        let speed = exact(FIXED).map_or(f64::NAN, |load| load.front_velocity());
        let mut out = vec![
            must.claim(
                "plateau velocity in in/s, n = 101, `default`",
                norm(FIXED, "plateau"),
                Wanted::Near(speed, 0.005),
            ),
            must.claim(
                "overshoot, n = 101, `default`",
                norm(FIXED, "overshoot"),
                Wanted::AtMost(0.12),
            ),
            aim.claim(
                "overshoot, n = 101, `default`",
                norm(FIXED, "overshoot"),
                Wanted::AtMost(0.03),
            ),
            must.claim(
                "odd-even roughness after 20 transits over the spacing, n = 101, `default`",
                norm(LONG, "roughness"),
                Wanted::AtMost(1e-3),
            ),
            must.claim(
                "level after the reflection at a free end over the plateau, n = 101, `default`",
                norm(FREE, "late_level"),
                Wanted::Near(2.0, 0.01),
            ),
            must.claim(
                "arrival before the exact front, in spacings, n = 101, `default`",
                norm(FIXED, "arrival_spacings"),
                Wanted::WithinZero(1.0),
            ),
        ];
        let paper = |n| paper_run(ID, n);
        let verified = Claims { source: "exact solution, which Figures 5 and 6 follow", ..must };
        for n in DRAWN {
            out.push(verified.claim(
                format!("plateau velocity in in/s, n = {n}, `paper`"),
                Quantity::Norm(paper(n), "plateau"),
                Wanted::Near(speed, 0.02),
            ));
        }
        let states = Claims {
            source: "the ledger integrates the work on the segments; their strain energy by the \
                     positions, Eq. (25), must be the same but for the integrator's O(dt^2)",
            ..must
        };
        for variant in [FIXED, LONG] {
            let length = if variant == LONG { ", 20 transits" } else { "" };
            out.push(states.claim(
                format!("strain energy by positions against work, n = 101{length}, `default`"),
                norm(variant, "strain_residual"),
                Wanted::AtMost(1e-4),
            ));
            out.extend(conservation(ID, &default(variant)));
        }
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("plateau", "plateau, in/s"),
            ("overshoot", "overshoot"),
            ("velocity_rms", "rms v / plateau"),
            ("late_level", "late level"),
            ("arrival_spacings", "arrival, dx"),
            ("roughness", "roughness / dx"),
            ("strain_residual", "strain residual"),
        ]
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("plateau", "plateau velocity, in/s"), ("overshoot", "overshoot")]
    }

    fn errors(&self) -> &'static [&'static str] {
        &["velocity_rms"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let mut figures = Vec::new();
        for variant in [FIXED, FREE] {
            figures.extend(midpoint(records, variant));
        }
        figures.push(speed_against_error(records));
        figures
    }
}

/// Time of a wave over the bar.
fn load_transit() -> f64 {
    LENGTH / (BULK / DENSITY).sqrt()
}

/// The histories that Figures 5 and 6 of the paper show, for one end.
fn midpoint(records: &Records, variant: &str) -> Vec<Figure> {
    let panels = DRAWN.iter().zip(["Figure 5", "Figure 6"]).filter_map(|(&n, number)| {
        let title = format!("{n} particles: as the paper's {number}");
        let (time, velocity) = (Axis::linear("time, ms"), Axis::linear("midpoint velocity, in/s"));
        let runs = Preset::ALL.map(|p| (p.name(), run_of(ID, p, n).variant(variant)));
        let runs = histories(records, runs);
        let load = exact(variant).ok()?;
        let field = |ms: f64| load.sample(0.5 * LENGTH, 1e-3 * ms).map(|state| state.velocity);
        let panel = Panel::new(title, time, velocity);
        beside_exact(panel, &runs, ["time_ms", "velocity"], "exact", field)
    });
    let end = if variant == FREE { "free" } else { "fixed" };
    let caption = format!(
        "Velocity of the midpoint of the bar with a {end} end at x = 0, by both presets. Figures 5 and 6 of \
         the paper show this history for 51 and 101 particles; it does not say which end they have."
    );
    figure(format!("kolsky-{end}"), &caption, panels)
}

fn speed_against_error(records: &Records) -> Figure {
    let y = || Axis::log("rms error of midpoint velocity / plateau");
    type Cost = (&'static str, fn(&RunRecord) -> f64);
    let axes: [Cost; 2] =
        [("spacing, in", |r| LENGTH / (r.key.n - 1) as f64), ("CPU seconds", |r| r.cpu_seconds)];
    let panels = axes
        .map(|(label, of)| {
            let mut panel = Panel::new("", Axis::log(label), y());
            for preset in Preset::ALL {
                let record = |n: &usize| records.get(&run_of(ID, preset, *n));
                let point = |r: &RunRecord| Some((of(r), *r.norms.get("velocity_rms")?));
                let points = SIZES.iter().filter_map(record).filter_map(point).collect();
                panel = panel.with(Curve::marked(preset.name(), points));
            }
            panel
        })
        .into();
    let caption = "Error of the midpoint velocity over 0 to 1 ms, fixed end: against spacing and \
                   against CPU time.";
    Figure::new("kolsky-speed-against-error", caption, panels)
}
