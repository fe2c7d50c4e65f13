//! README.md says what the committed records say.

mod prose;

use whipple_solver::method::{Density, Integrator, Preset};
use whipple_vv::claims::{Claim, Kind, Quantity, Status, Wanted, Weight};
use whipple_vv::convergence::{self, Level};
use whipple_vv::record::{Outcome, Records, RunKey, RunRecord, Scheme};
use whipple_vv::report::sig;
use whipple_vv::scene::AnyScene;
use whipple_vv::suite::verdicts;

use crate::common::{case, key};

/// The records of the report, and ways to read numbers off them.
struct Found(Records);

impl Found {
    fn read() -> Self {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../reports/records");
        Self(Records::read(folder.as_ref()).expect("the records of the report"))
    }

    fn record(&self, key: &RunKey) -> &RunRecord {
        self.0.get(key).unwrap_or_else(|| panic!("no record {}", key.file_name()))
    }

    fn norm(&self, key: &RunKey, name: &str) -> f64 {
        let norms = &self.record(key).norms;
        let number = norms.get(name).copied().filter(|number| number.is_finite());
        number.unwrap_or_else(|| panic!("{} has no number for {name}", key.file_name()))
    }

    /// A norm at several sizes of the plain variant of `default`.
    fn at<const N: usize>(&self, id: &str, sizes: [usize; N], name: &str) -> [f64; N] {
        sizes.map(|n| self.norm(&key(id, Preset::Default, n), name))
    }

    /// Largest magnitude of a norm of planar impact, over metals and speeds.
    fn planar(&self, metals: &[&str], speeds: &[&str], name: &str) -> f64 {
        let of = |metal: &str, speed: &str| {
            // Copper at 1 km/s is the plain variant.
            let variant = match format!("{metal}-{speed}") {
                plain if plain == "cu-1" => String::new(),
                named => named,
            };
            self.norm(&key("planar-impact", Preset::Default, 80).variant(&variant), name).abs()
        };
        let mut largest = 0.0_f64;
        for metal in metals {
            for speed in speeds {
                largest = largest.max(of(metal, speed));
            }
        }
        largest
    }

    /// Fitted order of a norm of Noh over all its sizes.
    fn noh_order(&self, name: &str) -> f64 {
        let sizes = [100, 200, 400, 800];
        let level = |n: usize| Level {
            spacing: 1.0 / n as f64,
            value: self.norm(&key("noh", Preset::Default, n), name),
        };
        convergence::fitted_order(&sizes.map(level)).expect("an order").order
    }

    /// Largest deviation from Table 2 of the paper.
    fn table_2(&self) -> f64 {
        let deviation = |claim: Claim| match (claim.kind, claim.quantity, claim.wanted) {
            (Kind::Replication, Quantity::Norm(key, name), Wanted::Near(printed, _)) => {
                Some((self.norm(&key, name) / printed - 1.0).abs())
            }
            _ => None,
        };
        let all: Vec<f64> = case("noh").claims().into_iter().filter_map(deviation).collect();
        assert_eq!(all.len(), 8, "the norms of Table 2");
        all.into_iter().fold(0.0, f64::max)
    }

    /// Largest error of the energy balance of a completed run with the compatible integrator.
    fn drift(&self) -> f64 {
        let compatible = |record: &&RunRecord| {
            record.outcome == Outcome::Completed
                && record.scene.as_ref().is_some_and(|scene| match scene {
                    AnyScene::Line(scene) => scene.method.integrator == Integrator::Compatible,
                    AnyScene::Space(scene) => scene.method.integrator == Integrator::Compatible,
                })
        };
        self.0.iter().filter(compatible).map(|record| record.energy_drift).fold(0.0, f64::max)
    }
}

/// Numbers with so many decimals, and what stands behind them.
fn fixed<const N: usize>(values: [f64; N], decimals: usize, unit: &str) -> String {
    let texts = values.map(|value| format!("{value:.decimals$}"));
    format!("{}{unit}", texts.join(" / "))
}

/// The rows: what, preset, what the records say, what is wanted.
fn rows(found: &Found) -> Vec<[String; 4]> {
    let rod = |preset, variant: &str, name| {
        [5, 7, 9].map(|n| found.norm(&key("long-rod", preset, n).variant(variant), name))
    };
    let (length, speed) = ("residual_length_cm", "residual_velocity_km_s");
    let (default, paper) = ("`default`", "`paper`");
    let as_printed = "`paper`, `as-printed`";
    let (slow, fast) = (["0.5", "1", "2"], ["4"]);
    let metals = ["cu", "al", "w-steel"];
    let pressure = "pressure_error";
    let noise = |speeds: &[&str]| 100.0 * found.planar(&metals, speeds, "noise_near_front");
    let up_to_4 = 100.0 * found.planar(&metals, &["0.5", "1", "2", "4"], pressure);
    let at_7 = metals.map(|metal| 100.0 * found.planar(&[metal], &["7"], pressure));
    let wrong = |name| {
        let norms = found.at("noh", [100, 400], name);
        [100.0 * norms[0] * norms[0], 400.0 * norms[1] * norms[1]]
    };
    let one = |id: &str, n, name| found.at(id, [n], name)[0];
    let noh = key("noh", Preset::Default, 800);
    let pace = found.record(&noh).particle_steps as f64 / found.record(&noh).cpu_seconds;
    let percent = |value: f64, decimals| fixed([100.0 * value], decimals, " %");
    let boosted =
        found.norm(&key("galilean-boost", Preset::Default, 200), "temperature_difference");
    let printed = "as-printed";
    let row = |what: &str, preset: &str, found: String, wanted: &str| {
        [what.to_owned(), preset.to_owned(), found, wanted.to_owned()]
    };
    vec![
        row(
            "Rod, length (experiment 6.38 cm)",
            default,
            fixed(rod(Preset::Default, "", length), 2, " cm"),
            "±5 %",
        ),
        row(
            "Rod, velocity (experiment 1.46 km/s)",
            default,
            fixed(rod(Preset::Default, "", speed), 3, " km/s"),
            "±2 %",
        ),
        row(
            "Rod, length (paper: 6.08 / 6.47 / 6.59)",
            as_printed,
            fixed(rod(Preset::Paper, printed, length), 2, " cm"),
            "replication",
        ),
        row(
            "Rod, velocity (paper: 1.42)",
            as_printed,
            fixed(rod(Preset::Paper, printed, speed), 2, " km/s"),
            "replication",
        ),
        row("Planar impact, pressure, 0.5 to 4 km/s", default, fixed([up_to_4], 2, " %"), "≤ 1 %"),
        row("The same at 7 km/s: Cu / Al / W on steel", default, fixed(at_7, 2, " %"), "≤ 3 %"),
        row(
            "Noise from 2 cells behind, to 2 / 4 / 7 km/s",
            default,
            fixed([noise(&slow), noise(&fast), noise(&["7"])], 1, " %"),
            "≤ 1 / 4 / 3 %",
        ),
        row("Noh, Table 2 of the paper, eight norms", paper, percent(found.table_2(), 1), "≤ 2 %"),
        row(
            "Noh, n·rms² of velocity, n = 100 / 400",
            default,
            fixed(wrong("velocity_rms_phase"), 3, ""),
            "≤ 0.20, goal 0.15",
        ),
        row(
            "Noh, n·rms² of temperature, n = 100 / 400",
            default,
            fixed(wrong("temperature_rms_phase"), 3, ""),
            "≤ 0.105, goal 0.06",
        ),
        row(
            "Noh, wall heating, n = 100 / 400",
            default,
            fixed(found.at("noh", [100, 400], "wall_heating").map(|x| 100.0 * x), 2, " %"),
            "±5 %, goal ±1 %",
        ),
        row(
            "Noh, heating of the second particle, n = 100",
            default,
            percent(one("noh", 100, "wall_heating_linf"), 1),
            "not claimed",
        ),
        row(
            "Noh, window L1 of velocity, n = 100",
            default,
            fixed([one("noh", 100, "velocity_l1_window")], 5, ""),
            "≤ 0.012, goal 0.0077",
        ),
        row(
            "Noh, orders of rms and L1 velocity",
            default,
            fixed(
                [found.noh_order("velocity_rms_phase"), found.noh_order("velocity_l1_phase")],
                3,
                "",
            ),
            "1/2, 1",
        ),
        row(
            "Kolsky bar, plateau (exact 337.87), n = 101",
            default,
            fixed([one("kolsky", 101, "plateau")], 2, " in/s"),
            "±0.5 %",
        ),
        row(
            "Kolsky bar, overshoot, n = 101",
            default,
            percent(one("kolsky", 101, "overshoot"), 1),
            "≤ 12 %, goal 3 %",
        ),
        row("Frame moving at 1000: change of temperature", default, sig(boosted, 2), "≤ 1e-8"),
        row(
            "Strong shock tube 10⁵, L1 density, n = 200",
            default,
            fixed([one("strong-shock-tube", 200, "density_l1")], 4, ""),
            "≤ 0.010",
        ),
        row(
            "Sod, L1 density, n = 200",
            default,
            fixed([one("sod", 200, "density_l1")], 4, ""),
            "goal 0.0033",
        ),
        row(
            "Woodward-Colella, L1 density, n = 400",
            default,
            fixed([one("woodward-colella", 400, "density_l1")], 4, ""),
            "≤ 0.03",
        ),
        row(
            "Energy drift, largest of all compatible runs",
            "both",
            sig(found.drift(), 2),
            "≤ 1e-12",
        ),
        row("Particle-steps per CPU second, Noh, n = 800", default, sig(pace, 2), "≥ 1e7"),
    ]
}

/// The line that counts the claims.
fn counts(found: &Found) -> String {
    let verdicts = verdicts(&found.0);
    let count = |weight, status| {
        verdicts.iter().filter(|v| v.claim.weight == weight && v.status == status).count()
    };
    let [held, failed, missing] =
        [Status::Pass, Status::Fail, Status::Missing].map(|status| count(Weight::Must, status));
    let [reached, missed] = [Status::Pass, Status::Fail].map(|status| count(Weight::Aim, status));
    format!(
        "Required claims that hold: {held} of {}; {failed} fail, {missing} are without a record. Goals \
         reached: {reached} of {}.",
        held + failed + missing,
        reached + missed
    )
}

/// The table of results and the counts below it are those of the records in `reports/`. When records
/// change, the text that this test asks for takes the place of that in README.md.
#[test]
fn the_results_are_those_of_the_records() {
    let readme = include_str!("../../../README.md");
    let found = Found::read();
    let head = "| result | preset | found | wanted |\n| --- | --- | --- | --- |\n";
    let row = |cells: [String; 4]| format!("| {} |\n", cells.join(" | "));
    let table: String = rows(&found).into_iter().map(row).collect();
    let wanted = format!("{head}{table}\n{}\n", counts(&found));
    assert!(readme.contains(&wanted), "README.md lacks what the records say:\n\n{wanted}");
}

/// A scheme that no record has is not passed over.
#[test]
#[should_panic(expected = "no record sod_default-nonholonomic_n7.json")]
fn what_is_not_there_is_not_passed_over() {
    let scheme = Scheme::Particles { preset: Preset::Default, density: Density::Nonholonomic };
    Found(Records::default()).norm(&RunKey::new("sod", scheme, 7), "density_l1");
}
