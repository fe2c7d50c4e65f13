//! The numbers in the sentences of README.md, as the table's, are those of the records.

use whipple_solver::method::Preset;
use whipple_vv::record::Outcome;
use whipple_vv::report::sig;

use super::Found;
use crate::common::key;

/// Metals of planar impact.
const METALS: [&str; 3] = ["cu", "al", "w-steel"];

/// The least and the greatest of some numbers as a range, or the one if they read the same.
fn range(values: &[f64], decimals: usize) -> String {
    let pick =
        |better: fn(f64, f64) -> f64| values.iter().copied().reduce(better).expect("numbers");
    let [least, most] = [f64::min, f64::max].map(|better| format!("{:.decimals$}", pick(better)));
    if least == most { most } else { format!("{least} to {most}") }
}

/// Words in a row: `a, b and c`.
fn listed(words: &[String]) -> String {
    match words {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        words => words.concat(),
    }
}

/// Numbers in a row.
fn numbers(values: &[f64], decimals: usize) -> String {
    listed(&values.iter().map(|value| format!("{value:.decimals$}")).collect::<Vec<_>>())
}

fn percent(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| 100.0 * value).collect()
}

/// What a control changes in the answer of a case, in per cent.
fn change(found: &Found, id: &str, (control, n): (&str, usize), name: &str) -> f64 {
    let [plain, changed] = ["", control]
        .map(|variant| found.norm(&key(id, Preset::Default, n).variant(variant), name));
    100.0 * (changed / plain - 1.0).abs()
}

/// Shocks in planar impact.
fn planar(found: &Found) -> Vec<String> {
    let at =
        |speed: &str, name| percent(&METALS.map(|metal| found.planar(&[metal], &[speed], name)));
    let [four, seven] = ["4", "7"].map(|speed| range(&at(speed, "overshoot"), 0));
    let settling = ["4", "7"]
        .map(|speed| METALS.map(|metal| found.planar(&[metal], &[speed], "settling_cells")));
    let low = ["cu-0.5", "", "cu-2", "cu-4", "cu-7"].map(|variant| {
        let key = key("planar-impact", Preset::Paper, 80).variant(variant);
        -100.0 * found.norm(&key, "pressure_error")
    });
    vec![
        format!("in planar impact by {four} % at 4 km/s and by {seven} % at 7"),
        format!("they swing for {} cells", range(&settling.concat(), 0)),
        format!("pressures {} % low", range(&low, 0)),
    ]
}

/// What solids depend on.
fn solids(found: &Found) -> Vec<String> {
    let (hourglass, centring) = ("hourglass-on", "centring-on");
    let rod = |variant| change(found, "long-rod", (variant, 5), "residual_length_cm");
    let block = |variant| change(found, "spinning-block", (variant, 10), "stored");
    let foot = change(found, "taylor-copper", (centring, 8), "foot_radius_mm");
    let tube = change(found, "verney", (centring, 8), "rest_cm");
    let growth = {
        let key = key("spinning-block", Preset::Default, 10).variant(hourglass);
        100.0 * (found.norm(&key, "hourglass_growth") - 1.0)
    };
    let steps = ["step-0.8", "step-0.7"].map(rod);
    let steps = [f64::min, f64::max].map(|pick| sig(pick(steps[0], steps[1]), 1)).join(" to ");
    let live = ["taylor-copper", "taylor-42crmo4"].map(|id| {
        let [live, all] =
            ["foot_left_mm", "foot_radius_mm"].map(|name| found.at(id, [8, 12], name));
        [0, 1].map(|k| 100.0 * (1.0 - live[k] / all[k]))
    });
    let spall = [20, 40, 80];
    let indicated = found.at("spall", spall, "indicated_over_strength");
    let depth = found.at("spall", [80], "depth_error_cells")[0].abs();
    vec![
        format!("plate spalls lies {depth} cells from that of the theory with 80 cells"),
        format!(
            "moves the elastic energy of the spinning block by {:.0} % and the length of the rod of 5 cells by \
             {:.1} %",
            block(hourglass),
            rod(hourglass)
        ),
        format!("lets the energy of these modes grow by {growth:.0} % over a turn"),
        format!(
            "The length of the long rod ({:.1} %), the foot of the Taylor rod ({foot:.1} %)",
            rod(centring)
        ),
        format!("the spinning block ({:.0} %)", block(centring)),
        format!("Verney's collapsing tube ({tube:.1} %)"),
        format!(
            "moves the energy by {:.0} %, the length of the rod of 5 cells by {:.1} %, and lets the energy of \
             the modes themselves grow by {growth:.0} % over a turn",
            block(hourglass),
            rod(hourglass)
        ),
        format!("moves the length of the rod of 5 cells by {steps} %"),
        format!("that of live elements alone is {} % smaller", range(&live.concat(), 0)),
        format!(
            "would indicate is {} of that put in with {} cells",
            numbers(&indicated, 2),
            listed(&spall.map(|n| n.to_string()))
        ),
    ]
}

/// Gas in three dimensions.
fn gas(found: &Found) -> Vec<String> {
    let centre = {
        let key = key("noh-space", Preset::Default, 24).variant("spherical");
        found.norm(&key, "density")
    };
    let swing = percent(&found.at("noh-space", [16, 24], "scatter"));
    let shells = percent(&found.at("sedov", [16, 24, 32], "pressure_of_shells"));
    let peak = found.at("sedov", [32], "peak_over_exact")[0];
    let regular = {
        let key = key("saltzman", Preset::Default, 20).variant("regular");
        found.norm(&key, "largest_transverse")
    };
    let tube = found.at("verney", [4, 8, 16], "rest_error_cm").map(|error| -error);
    vec![
        format!("far below 64 ({centre:.0} at 24 cells"),
        format!("is {peak:.2} of the exact one at 32"),
        format!("swings by {} % about its mean with 16 and 24 cells", numbers(&swing, 1)),
        format!("is off by {} % rms at 16, 24 and 32 cells", numbers(&shells, 0)),
        skewed(found),
        format!("gas runs along it too, at {regular:.2} of that speed"),
        format!("stops {} cm too far in (of 4 cm) with 4, 8 and 16 cells", numbers(&tube, 2)),
    ]
}

/// Saltzman's skewed piston at those of its sizes that run to their end, and those that fail.
fn skewed(found: &Found) -> String {
    let of = |n: usize| key("saltzman", Preset::Default, n);
    let ends = |n: &usize| found.record(&of(*n)).outcome == Outcome::Completed;
    let (end, fail): (Vec<usize>, Vec<usize>) = [5, 10, 20].into_iter().partition(ends);
    let cells =
        |sizes: &[usize]| listed(&sizes.iter().map(ToString::to_string).collect::<Vec<_>>());
    let all = |name: &str| end.iter().map(|&n| found.norm(&of(n), name)).collect::<Vec<f64>>();
    let means = [all("density_error"), all("pressure_error")].concat();
    let worst = percent(&means).into_iter().map(f64::abs).fold(0.0, f64::max);
    let fails = if fail.is_empty() {
        String::new()
    } else {
        format!("; with {} the run fails", cells(&fail))
    };
    format!(
        "with {} cells across it the means are right to {worst:.1} %, but the front is {} % too far on, and gas \
         runs along it at {} times the piston's speed{fails}",
        cells(&end),
        range(&percent(&all("shock_error")), 0),
        range(&all("largest_transverse"), 1)
    )
}

/// Goals of Noh that are missed.
fn noh(found: &Found) -> Vec<String> {
    let window = found.at("noh", [100], "velocity_l1_window")[0];
    vec![format!("window L1 of Noh ({window:.5} for 0.0077)")]
}

/// Sentences of README.md have the numbers of the records in `reports/`. When records change, those that this
/// test asks for take the place of those that stand there.
#[test]
fn the_sentences_are_those_of_the_records() {
    let words: Vec<&str> = include_str!("../../../../README.md").split_whitespace().collect();
    let readme = words.join(" ");
    let found = Found::read();
    let wanted = [planar(&found), solids(&found), gas(&found), noh(&found)].concat();
    let lacking: Vec<String> = wanted.into_iter().filter(|text| !readme.contains(text)).collect();
    assert!(
        lacking.is_empty(),
        "README.md lacks what the records say:\n\n{}\n",
        lacking.join("\n")
    );
}

#[test]
fn ranges_and_rows_read_well() {
    assert_eq!(range(&[35.6, 24.3], 0), "24 to 36");
    assert_eq!(range(&[0.71], 1), "0.7");
    assert_eq!(numbers(&[0.351, 0.114, 0.036], 2), "0.35, 0.11 and 0.04");
    assert_eq!((listed(&["5".into()]), listed(&[])), ("5".to_owned(), String::new()));
}
