//! `whipple score`: results of other programs on cases with an exact profile.

use std::fs;
use std::path::Path;

use whipple_solver::method::Preset;
use whipple_vv::cases::ALL;
use whipple_vv::score::answer::{Answer, known};
use whipple_vv::score::columns::Named;
use whipple_vv::score::judge::{Profile, norms, orders};
use whipple_vv::score::table::Table;

use crate::common::{case, key, record, said};

/// The commands of the guide, on its example.
#[test]
fn the_example_of_another_program_is_scored() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let files = [100, 200, 400].map(|n| format!("references/examples/sod_first_order_{n}.dat"));
    let folder = tempfile::tempdir().expect("a folder");
    // Without records: theirs would move the text whenever a result of ours does.
    let args = ["--column", "x=zone_centre", "--records", "none"];
    let all: Vec<&str> =
        ["score", "sod"].into_iter().chain(files.iter().map(String::as_str)).chain(args).collect();
    let scored = said(&root, &all);
    assert_eq!(scored.code, Some(0), "{}", scored.err);
    insta::assert_snapshot!("score_example", scored.out);

    let figure = folder.path().join("score.svg").display().to_string();
    let table = folder.path().join("score.csv").display().to_string();
    let more = ["--ours", "100", "--plot", &figure, "--csv", &table, "--json"];
    let args: Vec<&str> = all.iter().copied().chain(more).collect();
    let scored = said(&root, &args);
    assert_eq!(scored.code, Some(0), "{}", scored.err);
    let json: serde_json::Value = serde_json::from_str(&scored.out).expect("JSON");
    let order = json["orders"]["density"]["fitted"][0].as_f64().expect("an order");
    assert!((0.4..0.9).contains(&order), "a first-order method at a contact: {order}");
    assert_eq!(json["ours"][0]["n"], 100);
    assert_eq!(fs::read_to_string(&table).expect("a table").lines().count(), 1 + 4 * 4);
    assert!(folder.path().join("score-dark.svg").exists());
}

/// A table of the columns of a profile, with masses.
fn table(columns: &[(&str, &[f64])]) -> Table {
    let head: Vec<&str> = columns.iter().map(|column| column.0).collect();
    let mut text = head.join(",") + "\n";
    for k in 0..columns[0].1.len() {
        let cells: Vec<String> = columns.iter().map(|c| format!("{:e}", c.1[k])).collect();
        text += &(cells.join(",") + "\n");
    }
    Table::parse(Path::new("table"), text).expect("a table")
}

/// What our own run gives, written as a table and scored, has the norms of its record.
#[test]
fn our_own_run_is_scored_as_its_record_says() {
    for (id, density) in [("sod", Some([1.0, 0.125])), ("uniform-collapse", None)] {
        let run = record(&key(id, Preset::Default, 200));
        let profile = run.profile.expect("a profile").0;
        let width = 1.0 / 200.0;
        let of = |k: usize| density.map_or(1.0, |sides| sides[usize::from(k >= 100)]) * width;
        let mass: Vec<f64> = (0..200).map(of).collect();
        let mut columns: Vec<(&str, &[f64])> = vec![("mass", &mass)];
        for name in ["x", "density", "velocity", "pressure", "energy"] {
            columns.push((name, &profile[name]));
        }
        let answer = Answer::of(case(id), "").expect("an answer").expect("an exact profile");
        let judged = Profile::of(&table(&columns), &Named::default(), &answer, answer.end());
        let found = norms(&judged.expect("a profile")).expect("norms");
        assert_eq!(found.len(), 4, "{id}");
        for (field, norms) in found {
            let wanted = run.norms[&format!("{field}_l1")];
            let apart = (norms.l1 - wanted).abs();
            assert!(apart <= 1e-9 * wanted + 1e-15, "{id} {field}: {} {wanted}", norms.l1);
        }
    }
}

/// The exact density, which falls all along Sod's tube, moved by a cell: errors of cells of equal weight add up to its
/// range, so that L1 over that range is 1/n and its order 1.
#[test]
fn the_exact_solution_moved_by_a_cell_is_wrong_with_first_order() {
    let answer = Answer::of(case("sod"), "").expect("an answer").expect("an exact profile");
    let sizes = [50, 100, 200];
    let all = sizes.map(|n| {
        let place = |k: usize| (k as f64 + 0.5) / n as f64;
        let x: Vec<f64> = (0..=n).map(place).collect();
        let exact = &answer.at(&x, answer.end()).expect("fields")["density"];
        let (mass, moved) = (vec![1.0; n], &exact[1..]);
        let table = table(&[("x", &x[..n]), ("rho", moved), ("mass", &mass)]);
        let profile = Profile::of(&table, &Named::default(), &answer, answer.end());
        let found = norms(&profile.expect("a profile")).expect("norms");
        assert!((found["density"].l1 * n as f64 - 1.0).abs() < 1e-12, "{found:?}");
        found
    });
    let fitted = orders(&sizes, &all)["density"].fitted.expect("three sizes").0;
    assert!((fitted - 1.0).abs() < 1e-10, "{fitted}");
}

#[test]
fn cases_with_an_exact_profile_are_those_of_gases() {
    insta::assert_snapshot!(known().join(" "), @"noh uniform-collapse sod einfeldt-123 leblanc strong-shock-tube vacuum-release two-stream-noh unequal-masses woodward-colella");
    let refused = ALL.iter().filter(|case| !known().contains(&case.id())).count();
    assert!(refused > 0);
}

#[test]
fn what_cannot_be_scored_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("good.csv"), "x,rho [kg/m^3],p\n0.1,1000,1\n0.9,125,0.1\n").expect("written");
    fs::write(at.join("back.csv"), "x,rho\n0.9,1\n0.1,1\n").expect("written");
    fs::write(at.join("strange.csv"), "x,foo\n0.1,1\n0.9,1\n").expect("written");
    fs::write(at.join("wrong.csv"), "x,rho [km]\n0.1,1\n0.9,1\n").expect("written");
    let mut all = Vec::new();
    for args in [
        &["score", "sodd", "good.csv"][..],
        &["score", "kolsky", "good.csv"],
        &["score", "sod", "none.csv"],
        &["score", "sod", "back.csv"],
        &["score", "sod", "strange.csv"],
        &["score", "sod", "wrong.csv"],
        &["score", "sod", "good.csv", "--column", "desnity=rho"],
        &["score", "sod", "good.csv", "--column", "density=rh"],
        &["score", "sod", "good.csv", "--time", "0.3"],
        &["score", "woodward-colella", "good.csv", "--time", "0.02"],
        &["score", "sod", "good.csv", "--plot", "good.jpg"],
    ] {
        let refused = said(at, args);
        assert_eq!(refused.code, Some(2), "{args:?}: {}", refused.err);
        all.push(format!("{}\n{}", args.join(" "), refused.err));
    }
    insta::assert_snapshot!(all.join("\n"));
    let scored = said(at, &["score", "sod", "good.csv"]);
    assert_eq!(scored.code, Some(0), "{}", scored.err);
}
