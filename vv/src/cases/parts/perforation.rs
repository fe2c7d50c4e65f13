//! The measurement of a plate that a sphere perforates.

use whipple_solver::space::Simulation;
use whipple_solver::space::ledger::Balance;
use whipple_solver::space::scene::Scene;

use super::cloud::Cloud;
use super::impact::{DIAMETER, PLATE, SPHERE, STOP};
use super::pieces::Pieces;
use super::{Columns, fit, hole, kilojoules};
use crate::cases::{Claim, Claims, Kind, Quantity, Wanted, Weight, in_words};
use crate::record::RunKey;
use crate::run::{Findings, RunError, SpaceDriver};

/// Times between two entries of the histories in us, and when the first of them gives way to the second:
/// the run lands on every entry, which shortens steps.
const OFTEN: f64 = 0.1;
const SELDOM: f64 = 0.5;
const EARLY: f64 = 2.0;

/// Over the last so many us the growth of the hole is fitted.
const LATE: f64 = 1.0;

/// A plate is perforated when the hole through its middle plane is this part of the sphere wide, and this
/// share of the sphere's mass is behind it: one open pixel, or one fast fragment, is no perforation.
const OPEN: f64 = 0.1;
const BEHIND: f64 = 1e-3;

/// What is read off a state, in this order.
const HISTORY: [&str; 20] = [
    "time",
    "hole",
    "hole_sound",
    "sphere_behind",
    "plate_behind",
    "sphere_momentum",
    "plate_momentum",
    "in_front",
    "in_plate",
    "front",
    "cone",
    "mass",
    "kinetic",
    "internal",
    "shear",
    "tension",
    "residual",
    "failed",
    "dead",
    "dt",
];

/// Units of the histories and of the distribution of fragments.
pub(in crate::cases) const UNITS: [(&str, &str); 23] = [
    ("time", "µs"),
    ("hole", "cm"),
    ("hole_sound", "cm"),
    ("sphere_behind", "g"),
    ("plate_behind", "g"),
    ("sphere_momentum", "g·cm/µs"),
    ("plate_momentum", "g·cm/µs"),
    ("in_front", "g"),
    ("in_plate", "g"),
    ("front", "km/s"),
    ("cone", "°"),
    ("mass", "g"),
    ("kinetic", "kJ"),
    ("internal", "kJ"),
    ("shear", "kJ"),
    ("tension", "kJ"),
    ("residual", "kJ"),
    ("failed", ""),
    ("dead", ""),
    ("dt", "µs"),
    ("fragment", "g"),
    ("sphere_fragments", ""),
    ("plate_fragments", ""),
];

/// What the report tabulates.
pub(in crate::cases) const TABULATED: [(&str, &str); 17] = [
    ("perforation_time_us", "perforated, µs"),
    ("hole_diameter_cm", "hole, cm"),
    ("hole_growth_cm_us", "its growth, cm/µs"),
    ("hole_sound_cm", "hole in what has not failed, cm"),
    ("mass_behind_g", "mass behind, g"),
    ("sphere_mass_behind_g", "of the sphere, g"),
    ("plate_mass_behind_g", "of the plate, g"),
    ("momentum_behind_g_cm_us", "momentum behind, g·cm/µs"),
    ("sphere_momentum_behind_g_cm_us", "of the sphere, g·cm/µs"),
    ("plate_momentum_behind_g_cm_us", "of the plate, g·cm/µs"),
    ("mass_in_front_g", "mass in front, g"),
    ("debris_front_km_s", "front of the cloud, km/s"),
    ("cone_angle_deg", "cone of the cloud, °"),
    ("fragments", "fragments"),
    ("loose_mass_g", "mass in no sound element, g"),
    ("particles", "particles"),
    ("failed_elements", "failed elements"),
];

/// Quantities whose convergence is studied.
pub(in crate::cases) const QUANTITIES: [(&str, &str); 3] = [
    ("hole_diameter_cm", "hole, cm"),
    ("debris_front_km_s", "front of the cloud, km/s"),
    ("perforation_time_us", "perforated, µs"),
];

/// What every run must do: perforate, lose nothing of the work on elements, keep all mass in sight.
pub(in crate::cases) fn claims(id: &'static str, key: &RunKey) -> Vec<Claim> {
    let run = in_words(key);
    let must = Claims::new(id, Kind::Verification, Weight::Must, wanted!());
    let norm = |name| Quantity::Norm(key.clone(), name);
    vec![
        Claims { kind: Kind::Stability, source: "it perforates by far, by every estimate", ..must }
            .claim(
                format!("time of perforation in µs, {run}"),
                norm("perforation_time_us"),
                Wanted::AtMost(STOP),
            ),
        must.claim(
            format!("residual of the elements over the initial kinetic energy, {run}"),
            Quantity::Residual(key.clone()),
            Wanted::WithinZero(1e-3),
        ),
        Claims { source: "round-off of sums", ..must }.claim(
            format!("masses behind, in front and in the plate over all mass, error, {run}"),
            norm("mass_partition_error"),
            Wanted::AtMost(1e-12),
        ),
    ]
}

/// The numbers of [`HISTORY`] of a state.
fn look(scene: &Scene, solver: &Simulation, balance: &Balance) -> Vec<f64> {
    let cloud = Cloud::of(solver);
    let (failed, dead) = solver.failed();
    let mut row = vec![
        solver.time(),
        hole::diameter(solver, scene, |_| true),
        hole::diameter(solver, scene, |element| !element.failed),
    ];
    row.extend(cloud.mass);
    row.extend(cloud.momentum);
    row.extend([cloud.in_front, cloud.in_plate, 10.0 * cloud.front, cloud.cone, cloud.whole()]);
    row.extend(kilojoules(balance));
    row.extend([failed as f64, dead as f64, solver.last_step()]);
    row
}

/// When a quantity first reaches a level, between the entries of its history.
fn reached(times: &[f64], values: &[f64], level: f64) -> Option<f64> {
    let k = values.iter().position(|value| *value >= level)?;
    let Some(before) = k.checked_sub(1) else { return times.first().copied() };
    let share = (level - values[before]) / (values[k] - values[before]);
    Some(times[before] + share * (times[k] - times[before]))
}

/// Times of the entries up to the end of a run.
fn times(stop: f64) -> Vec<f64> {
    let early = (EARLY / OFTEN).round() as usize;
    let at = |k: usize| match k.checked_sub(early) {
        Some(after) => EARLY + SELDOM * after as f64,
        None => OFTEN * k as f64,
    };
    (0..).map(at).take_while(|time| *time < stop).chain([stop]).collect()
}

/// Runs to the end, measures, and tells `passing` every time that it stops at.
pub(in crate::cases) fn measure(
    driver: &mut SpaceDriver<'_>,
    scene: &Scene,
    mut passing: impl FnMut(&mut SpaceDriver<'_>, f64) -> Result<(), RunError>,
) -> Result<Findings, RunError> {
    let mut history = Columns::default();
    for time in times(scene.stop_time) {
        driver.advance_to(time)?;
        let row = driver.look(|solver, balance| look(scene, solver, balance))?;
        history.read(&HISTORY, &row);
        passing(driver, time)?;
    }
    let mut findings = Findings::default();
    from_history(&history, &mut findings);
    let fragments = fragments(driver.solver(), &mut findings);
    findings.enter("particles", driver.solver().particles() as f64);
    findings.history = Some(history.series());
    findings.profile = Some(fragments.series());
    Ok(findings)
}

/// Enters what the histories give.
fn from_history(history: &Columns, findings: &mut Findings) {
    let column = |name: &str| history.column(name);
    let last = |name: &str| column(name).last().copied().unwrap_or(f64::NAN);
    let times = column("time");
    let both = |a: &str, b: &str| -> Vec<f64> {
        column(a).iter().zip(column(b)).map(|(a, b)| a + b).collect()
    };
    let behind = both("sphere_behind", "plate_behind");
    findings.enter("mass_behind_g", behind.last().copied().unwrap_or(f64::NAN));
    // All of the sphere is in front of the plate at the start.
    let whole_sphere = column("in_front").first().copied().unwrap_or(f64::NAN);
    let open = reached(times, column("hole"), OPEN * DIAMETER);
    let out = reached(times, &behind, BEHIND * whole_sphere);
    let perforated = open.zip(out).map_or(f64::NAN, |(open, out)| open.max(out));
    findings.enter("perforation_time_us", perforated);
    let end = last("time");
    let late: Vec<(f64, f64)> = times.iter().copied().zip(column("hole").iter().copied()).collect();
    let late: Vec<(f64, f64)> =
        late.into_iter().filter(|(time, _)| *time > end - LATE - 0.5 * SELDOM).collect();
    findings.enter("hole_growth_cm_us", fit::slope(&late));
    findings.enter("momentum_behind_g_cm_us", last("sphere_momentum") + last("plate_momentum"));
    for (name, of) in [
        ("hole_diameter_cm", "hole"),
        ("hole_sound_cm", "hole_sound"),
        ("sphere_mass_behind_g", "sphere_behind"),
        ("plate_mass_behind_g", "plate_behind"),
        ("sphere_momentum_behind_g_cm_us", "sphere_momentum"),
        ("plate_momentum_behind_g_cm_us", "plate_momentum"),
        ("mass_in_front_g", "in_front"),
        ("mass_in_plate_g", "in_plate"),
        ("debris_front_km_s", "front"),
        ("cone_angle_deg", "cone"),
        ("failed_elements", "failed"),
    ] {
        findings.enter(name, last(of));
    }
    let first = column("mass").first().copied().unwrap_or(f64::NAN);
    findings.enter("mass_partition_error", (last("mass") / first - 1.0).abs());
}

/// Fragments of sphere and plate in what has not failed: how many are at least so heavy, from one cell of
/// the plate in doublings. What is left of the plate in one piece is none.
fn fragments(solver: &Simulation, findings: &mut Findings) -> Columns {
    let [mut sphere, mut plate] = [SPHERE, PLATE].map(|body| Pieces::of(solver, body).masses());
    let held: f64 = sphere.iter().chain(&plate).sum();
    let whole: f64 = solver.all_particles().map(|p| p.mass).sum();
    findings.enter("loose_mass_g", whole - held);
    if !plate.is_empty() {
        findings.enter("plate_left_g", plate.remove(0));
    }
    findings.enter("fragments", (sphere.len() + plate.len()) as f64);
    let heaviest = sphere.iter().chain(&plate).copied().fold(0.0, f64::max);
    findings.enter("heaviest_fragment_g", heaviest);
    let mut columns = Columns::default();
    // Half of a cell's mass is at its centroid, so that no fragment is lighter.
    let cell = solver.all_elements().find(|element| element.body == PLATE);
    let mut mass = cell.map_or(f64::INFINITY, |element| solver.particle(element.centre).mass);
    while mass <= heaviest {
        let at_least = |masses: &mut Vec<f64>| {
            masses.retain(|m| *m >= mass);
            masses.len() as f64
        };
        columns.row([
            ("fragment", mass),
            ("sphere_fragments", at_least(&mut sphere)),
            ("plate_fragments", at_least(&mut plate)),
        ]);
        mass *= 2.0;
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn entries_end_with_the_run() {
        let all = times(10.0);
        assert_eq!((all.len(), all[1], all[20], all[21], all[36]), (37, 0.1, 2.0, 2.5, 10.0));
        assert_eq!(times(0.25), [0.0, 0.1, 0.2, 0.25]);
    }

    #[test]
    fn levels_are_reached_between_entries() {
        let times = [0.0, 0.1, 0.2, 0.3];
        let found = reached(&times, &[0.0, 0.0, 0.4, 0.2], 0.1).expect("a time");
        assert_relative_eq!(found, 0.125, max_relative = 1e-12);
        assert_eq!(reached(&times, &[0.0; 4], 0.1), None);
        assert_eq!(reached(&times, &[1.0; 4], 0.1), Some(0.0));
    }
}
