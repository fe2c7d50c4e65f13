//! The program as a user meets it: output, messages, exit codes, files.

use std::collections::{BTreeMap, BTreeSet};
use std::process::{Command, Stdio};

use serde_json::Value;
use whipple_vv::record::Records;

use crate::common::{Said, said, whipple};

/// A temporary folder to run in.
fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Wrong use: exit code 2, a message, and nothing on standard output.
fn refusal(args: &[&str]) -> String {
    let Said { code, out, err } = said(folder().path(), args);
    assert_eq!(code, Some(2), "{args:?}: {out}{err}");
    assert_eq!(out, "", "{args:?}");
    assert_eq!(err.matches("error:").count(), 1, "one message: {err}");
    assert!(!err.contains('\u{1b}') && !err.contains("panicked"), "{err}");
    format!("$ whipple {}\n{}\n", args.join(" "), err.trim_end())
}

/// `list` names all cases.
#[test]
fn list_names_the_cases() {
    let said = said(folder().path(), &["list"]);
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
    insta::assert_snapshot!(said.out);
}

/// `run --json` prints one object with everything that a script needs.
#[test]
fn run_prints_json() {
    for (args, preset) in [(&["--preset", "paper"][..], "paper"), (&[][..], "default")] {
        let mut all = vec!["run", "noh", "--n", "20", "--json"];
        all.extend(args);
        let said = said(folder().path(), &all);
        assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
        let value: Value = serde_json::from_str(&said.out).expect("JSON");
        let text = |name: &str| value[name].as_str().unwrap_or_default().to_owned();
        assert_eq!((text("case"), text("preset")), ("noh".into(), preset.into()));
        assert_eq!(text("density"), if preset == "paper" { "nonholonomic" } else { "hybrid" });
        assert_eq!((value["n"].as_u64(), value["threads"].as_u64()), (Some(20), Some(1)));
        let (steps, particle_steps) = (value["steps"].as_u64(), value["particle_steps"].as_u64());
        assert_eq!(steps.map(|s| 20 * s), particle_steps);
        for name in ["cpu_seconds", "energy_drift", "momentum_drift"] {
            assert!(value[name].is_f64(), "{name}");
        }
        for name in [
            "velocity_rms",
            "temperature_rms",
            "velocity_l1",
            "temperature_l1",
            "velocity_l1_window",
            "velocity_rms_phase",
            "temperature_rms_phase",
            "wall_heating",
        ] {
            assert!(value["norms"][name].is_f64(), "{name}");
        }
        let command = value["provenance"]["command"].as_str().expect("a command").to_owned();
        assert!(command.starts_with("whipple run noh"), "{command}");
    }
}

/// An override reaches the run and stands in its command.
#[test]
fn overrides_reach_the_run() {
    let args = ["run", "noh", "--n", "20", "--json", "--set", "cfl=0.15", "--threads", "2"];
    let (coarse, fine) = (said(folder().path(), &args[..5]), said(folder().path(), &args));
    let [coarse, fine] =
        [coarse, fine].map(|s| serde_json::from_str::<Value>(&s.out).expect("JSON"));
    assert!(fine["steps"].as_u64() > coarse["steps"].as_u64().map(|s| s * 3 / 2));
    assert_eq!(fine["threads"].as_u64(), Some(2));
    assert!(fine["provenance"]["command"].as_str().expect("a command").contains("--set cfl=0.15"));
}

/// A key that the scene has no use for is told, one that it has is not.
#[test]
fn overrides_that_change_nothing_are_told() {
    let args = ["run", "kolsky", "--n", "21", "--set", "sound_speed=total", "--set", "cfl=0.2"];
    let said = said(folder().path(), &args);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_eq!(
        said.err,
        "note: `--set sound_speed=total` changes nothing in this run: an elastic solid has one speed of \
         sound\n"
    );
}

/// A value that the scene has already is told in a line, and what is wanted of the run is judged.
#[test]
fn overrides_with_the_value_of_the_scene_are_told() {
    let run = |sets: &[&str]| said(folder().path(), &[&["run", "noh", "--n", "20"], sets].concat());
    let plain = run(&["--set", "density=hybrid"]);
    assert_eq!(plain.code, Some(0), "{}", plain.err);
    assert_eq!(
        plain.err,
        "note: `--set density=hybrid` changes nothing: the scene has this value already\n"
    );
    assert!(!plain.out.contains("changed by"), "{}", plain.out);
    let two = run(&["--set", "heating=pair", "--set", "cfl=0.123"]);
    assert_eq!(
        two.err,
        "note: `--set heating=pair` changes nothing: the scene has this value already\n"
    );
    assert!(two.out.contains(", changed by --set cfl=0.123\n"), "{}", two.out);
}

/// Options of a case choose its variant, and the plain one where they say what that has.
#[test]
fn options_of_a_case_choose_its_variant() {
    for (options, variant) in [
        (&["--angle", "45", "--eos", "rcc_baseline"][..], ""),
        (&["--angle", "0"], "angle-0"),
        (&["--eos", "rcc_stiff", "--angle", "60"], "angle-60_eos-rcc_stiff"),
    ] {
        let run = ["run", "rcc-plate", "--n", "2", "--stop", "0.01us", "--json"];
        let said = said(folder().path(), &[&run[..], options].concat());
        let value: Value = serde_json::from_str(&said.out).expect("JSON");
        assert_eq!(value["variant"], variant);
        let command = value["provenance"]["command"].as_str().expect("a command");
        let named = format!(" --variant {variant} ");
        assert_eq!(command.contains(&named), !variant.is_empty(), "{command}");
        assert!(value["norms"]["perforation_time_us"].is_null(), "{}", said.out);
    }
}

/// More threads than the machine has processors are told, and run all the same.
#[test]
fn threads_beyond_the_machine_are_told() {
    let said = said(folder().path(), &["run", "noh", "--n", "20", "--threads", "1000"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.err.starts_with("note: --threads 1000 are more than the "), "{}", said.err);
}

/// Bodies that begin too near are named, with units and what to do; so are materials that there are.
#[test]
fn scenes_that_cannot_be_are_refused_with_names() {
    let near =
        refusal(&["run", "rcc-plate", "--n", "2", "--set", "bodies.0.centre=[0.0,-0.25,0.0]"]);
    let [begin, end] = [
        "error: `bodies.0.centre` is that of `sphere`, ",
        ": move one of them away, or take smaller cells\n",
    ];
    assert!(near.contains(begin) && near.ends_with(end), "{near}");
    assert!(near.contains(" cm from `plate`, but bodies must be at least "), "{near}");
    let rod = |set: &str| refusal(&["run", "long-rod", "--set", set]);
    let other = rod("bodies.0.material=tungsten");
    let names =
        "is `tungsten`, but no material has that name; the scene has `tungsten alloy`, `steel`\n";
    assert!(other.ends_with(names), "{other}");
    let flat = rod("bodies.1.shape.box.size.1=0.0");
    assert!(
        flat.ends_with("`bodies.1.shape.box.size.1` is 0, but it must be positive\n"),
        "{flat}"
    );
}

/// The record says which density ran, whichever option chose it, and a case named twice runs once.
#[test]
fn records_say_what_ran() {
    let folder = folder();
    let args = ["run", "noh", "--n", "20", "--json", "--set", "density=kernel"];
    let value: Value = serde_json::from_str(&said(folder.path(), &args).out).expect("JSON");
    assert_eq!(value["density"], "kernel");
    let twice = ["vv", "heat-chain", "heat-chain", "--level", "quick", "--out", "r"];
    let said = said(folder.path(), &twice);
    assert!(said.err.contains(" runs of heat-chain;"), "{}", said.err);
}

/// Input that is quoted in a message does nothing to the terminal.
#[test]
fn codes_for_the_terminal_are_shown() {
    let said = refusal(&["run", "noh", "--set", "b\u{202e}o\u{1b}[31m=1"]);
    assert!(said.contains("`--set b\\u{202e}o\\u{1b}[31m=1`: there is no "), "{said}");
}

/// What is said to wrong input.
#[test]
fn wrong_input_is_refused() {
    let refused = [
        refusal(&["run", "nho"]),
        refusal(&["run", "quux"]),
        refusal(&["vv", "kolski"]),
        refusal(&["run", "noh", "--n", "0"]),
        refusal(&["run", "noh", "--n", "1"]),
        refusal(&["run", "noh", "--n", "-5"]),
        refusal(&["run", "noh", "--n", "1e12"]),
        refusal(&["run", "noh", "--n", "1000000000000"]),
        refusal(&["run", "noh", "--n", "abc"]),
        refusal(&["run", "noh", "--n"]),
        refusal(&["run", "sod", "--n", "3"]),
        refusal(&["run", "noh-space", "--variant", "spherical", "--n", "4000"]),
        refusal(&["run", "noh", "--stop", "-1"]),
        refusal(&["run", "long-rod", "--stop", "-1us"]),
        refusal(&["run", "long-rod", "--out", "new", "--vtu", "-5us"]),
        refusal(&["run", "long-rod", "--out", "new", "--max-wall", "0s"]),
        refusal(&["run", "long-rod", "--out", "new", "--max-wall", "-3"]),
        refusal(&["run", "long-rod", "--out", "new", "--checkpoint", "0s"]),
        refusal(&["run", "noh", "--set", "=3"]),
        refusal(&["run", "noh", "--set", "cfl="]),
        refusal(&["run", "noh", "--set", "cfl=-1"]),
        refusal(&["run", "long-rod", "--set", "integrator=single_pass"]),
        refusal(&["run", "long-rod", "--set", "heating=printed"]),
        refusal(&["run", "noh", "--set", "materials.0.density=-1"]),
        refusal(&["run", "noh", "--set", "cfl=nan"]),
        refusal(&["run", "noh", "--set", "cfl"]),
        refusal(&["run", "noh", "--set", "clf=0.1"]),
        refusal(&["run", "noh", "--set", "cfl=0.1", "--set", "method.cfl=0.2"]),
        refusal(&["run", "noh", "--density", "hybrid", "--set", "density=kernel"]),
        refusal(&["run", "noh", "--stop", "5", "--set", "stop_time=7"]),
        refusal(&["run", "noh", "--stop", "0.1", "--set", "cfl=-1"]),
        refusal(&["run", "saltzman", "--n", "8", "--preset", "paper"]),
        refusal(&["run", "verney", "--density", "kernel"]),
        refusal(&["run", "noh", "--set", "visc_hourglass=0.1"]),
        refusal(&["run", "noh", "--set", "visc_linear=1e9"]),
        refusal(&["run", "planar-impact", "--set", "visc_linear=1e9"]),
        refusal(&["run", "planar-impact", "--set", "visc_hourglass=5"]),
        refusal(&["run", "planar-impact", "--set", "bodies=3"]),
        refusal(&["run", "planar-impact", "--set", "bodies.0.cells=5"]),
        refusal(&["run", "planar-impact", "--set", "materials.0.eos=5"]),
        refusal(&["run", "noh", "--set", "heating=sideways"]),
        refusal(&["run", "noh", "--set", "bodies.7.particles=3"]),
        refusal(&["run", "noh", "--preset", "papr"]),
        refusal(&["run", "noh", "--density", "sph"]),
        refusal(&["run", "noh", "--variant", "sideways"]),
        refusal(&["run", "noh", "--variant", "suport-1.5"]),
        refusal(&["run", "long-rod", "--variant", "widde"]),
        refusal(&["run", "sedov", "--variant", "-1"]),
        refusal(&["run", "long-rod", "--angle", "30"]),
        refusal(&["run", "noh", "--eos", "rcc_soft"]),
        refusal(&["run", "rcc-plate", "--angle", "20"]),
        refusal(&["run", "rcc-plate", "--angle", "-30"]),
        refusal(&["run", "rcc-plate", "--eos", "rcc_sotf"]),
        refusal(&["run", "rcc-plate", "--angle", "30", "--variant", "wide"]),
        refusal(&["run", "noh", "--threads", "0"]),
        refusal(&["run", "noh", "--threads", "-1"]),
        refusal(&["run", "noh", "--threads", "99999"]),
        refusal(&["run", "heat-chain", "--godunov"]),
        refusal(&["run", "noh", "--godunov", "--preset", "paper"]),
        refusal(&["vv", "noh", "--level", "slow"]),
        refusal(&["report", "--out", "nowhere"]),
        refusal(&["report", "--check", "--out", "nowhere"]),
        refusal(&["list", "nho"]),
        refusal(&["bench", "--rounds", "0"]),
        refusal(&["bench", "rod", "--cells", "-5"]),
        refusal(&["bench", "rod", "--steps", "0"]),
        refusal(&["fly"]),
    ];
    insta::assert_snapshot!(refused.join("\n"));
}

/// A scene that needs more memory than there is, refused before anything is allocated.
#[test]
fn scenes_beyond_the_memory_are_refused() {
    // 31 million particles with a kernel and a folder: 230 GB.
    if whipple_vv::memory::available().is_none_or(|room| room > 200_000_000_000) {
        return;
    }
    let case = ["run", "noh-space", "--variant", "spherical", "--n", "250", "--density", "kernel"];
    let refused = refusal(&[&case[..], &["--out", "new"]].concat());
    let (what, room) = refused.trim_end().split_once(", and ").expect("what there is");
    assert!(
        what.ends_with(
            "error: `noh-space` with --n 250 has about 31 438 251 particles and needs about 229.5 GB of \
             memory"
        ),
        "{refused}"
    );
    assert!(room.ends_with(" are available; take a smaller --n"), "{refused}");
}

/// No folder can be made in `/proc`, which is said before anything runs.
#[cfg(target_os = "linux")]
#[test]
fn folders_that_cannot_be_are_refused() {
    for args in [&["run", "noh"][..], &["vv", "noh"], &["run", "long-rod"]] {
        let refused = refusal(&[args, &["--out", "/proc/x"]].concat());
        let said = "error: cannot make the folder /proc/x: no folder can be made there\n";
        assert!(refused.ends_with(said), "{refused}");
    }
}

/// `list CASE` shows a case whole, `--keys` what `--set` takes.
#[test]
fn list_shows_a_case_and_the_keys() {
    let list = |args: &[&str]| {
        let said = said(folder().path(), &[&["list"], args].concat());
        assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
        said.out
    };
    insta::assert_snapshot!("case", list(&["sod"]));
    // The line of a key, and that below it.
    let key = |text: &str, name: &str| {
        let mut lines =
            text.lines().skip_while(|line| line.split_whitespace().next() != Some(name));
        let [values, meaning] =
            [lines.next(), lines.next()].map(|line| line.expect("a line").trim());
        (values.split_whitespace().map(str::to_owned).collect::<Vec<_>>(), meaning.to_owned())
    };
    let keys = list(&["--keys"]);
    let (values, meaning) = key(&keys, "visc_linear");
    assert_eq!(values, ["visc_linear", "1", "0.25", "–"]);
    assert_eq!(meaning, "Linear viscosity coefficient, `c_o` of Eq. (53).");
    let (values, meaning) = key(&keys, "heating");
    assert_eq!(values, ["heating", "printed", "pair", "–"]);
    assert_eq!(meaning, "Split of the viscous heat. One of: printed, pair.");
    assert!(keys.contains("\nAlong a line:\n") && keys.contains("\nIn three dimensions:\n"));
    let keys = list(&["spall", "--keys"]);
    let (values, _) = key(&keys, "materials.0.failure.spall");
    assert_eq!(values, ["materials.0.failure.spall", "0.0088", "0.0088", "Mbar"]);
    assert!(key(&keys, "release").1.ends_with("One of: steps, crossings."));
    let flat = keys.split_whitespace().collect::<Vec<_>>().join(" ");
    let idle = "collapsing pyramids; zero for none. Changes nothing under `paper`: it acts where";
    assert!(flat.contains(idle), "{keys}");
}

/// `run` shows what is wanted beside its numbers, and judges only what is claimed.
#[test]
fn run_shows_what_is_wanted() {
    let row = |args: &[&str], name: &str| {
        let said = said(folder().path(), &[&["run"], args].concat());
        assert_eq!(said.code, Some(0), "{}", said.err);
        let row = said.out.lines().find(|line| line.trim_start().starts_with(name));
        row.unwrap_or_else(|| panic!("{name}: {}", said.out)).to_owned()
    };
    let kolsky = ["kolsky", "--n", "101"];
    let plateau = row(&kolsky, "plateau");
    assert!(
        plateau.contains(" in/s ")
            && plateau.contains("exact 337.87 ± ")
            && plateau.ends_with(": pass"),
        "{plateau}"
    );
    let drift = row(&kolsky, "energy drift");
    assert!(drift.ends_with("wanted ≤ 1.000×10⁻¹²: pass"), "{drift}");
    let changed = [&kolsky[..], &["--set", "cfl=0.1"]].concat();
    let drift = row(&changed, "energy drift");
    assert!(drift.ends_with("wanted ≤ 1.000×10⁻¹²"), "{drift}");
    let note = row(&changed, "What is wanted");
    assert!(note.contains("is of the case as it stands, and not judged here"), "{note}");
    let alone = row(&["noh", "--n", "37"], "No claim");
    assert_eq!(alone, "No claim is made of this run alone; `whipple list noh` has all claims.");
    // What variants and sizes without a claim are held against is known to their case.
    let soft = ["rcc-plate", "--n", "2", "--stop", "0.01us", "--angle", "30", "--eos", "rcc_soft"];
    let hole = row(&soft, "hole_diameter_cm");
    assert!(hole.contains(" cm ") && hole.contains(" NASA's equation 3."), "{hole}");
    let printed = ["long-rod", "--n", "7", "--preset", "paper", "--stop", "0.01us"];
    let length = row(&printed, "residual_length_cm");
    assert!(
        length.contains(" cm ") && length.ends_with(" experiment 6.3800; paper, Table 5: 6.4700"),
        "{length}"
    );
    let claimed = row(&["rcc-plate", "--n", "4", "--stop", "0.01us"], "hole_diameter_cm");
    assert!(
        claimed.contains(" NASA's equation 2.8") && claimed.ends_with(" ± 15.0 %"),
        "{claimed}"
    );
    // The value is that of any size.
    let plateau = row(&["kolsky", "--n", "61"], "plateau");
    assert!(plateau.ends_with(" exact 337.87"), "{plateau}");
}

/// A file where the folder of the results should be, found before anything runs.
#[test]
fn unwritable_folder_is_refused() {
    let folder = folder();
    std::fs::write(folder.path().join("taken"), "mine").expect("a file");
    let mut text = String::new();
    for args in
        [&["run", "noh", "--n", "20", "--out", "taken"][..], &["vv", "noh", "--out", "taken/x"]]
    {
        let said = said(folder.path(), args);
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""));
        text += &said.err;
    }
    assert_eq!(std::fs::read_to_string(folder.path().join("taken")).expect("the file"), "mine");
    insta::assert_snapshot!(text, @r"
    error: cannot make the folder taken: a file stands where a folder should be
    error: cannot make the folder taken/x: a file stands where a folder should be
    ");
}

/// A numerical failure: exit code 3, and who, what and when on standard error.
#[test]
fn numerical_failure_has_its_own_code() {
    let folder = folder();
    let args = ["run", "galilean-boost", "--preset", "paper", "--json", "--out", "out"];
    let said = said(folder.path(), &args);
    assert_eq!(said.code, Some(3));
    assert!(said.err.starts_with("error: internal energy of particle "), "{}", said.err);
    assert_eq!(said.err.lines().count(), 1);
    let value: Value = serde_json::from_str(&said.out).expect("the record is printed all the same");
    assert_eq!(value["outcome"]["failed"]["kind"], "internal energy");
    assert!(folder.path().join("out/record.json").exists(), "and written");
}

/// `--out` writes the record, the scene, which can be read again, and the fields.
#[test]
fn results_are_written() {
    let folder = folder();
    let said = said(folder.path(), &["run", "noh", "--n", "20", "--out", "deep/out"]);
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
    let read = |name: &str| {
        std::fs::read_to_string(folder.path().join("deep/out").join(name))
            .expect("a file that was written")
    };
    let record: whipple_vv::record::RunRecord =
        serde_json::from_str(&read("record.json")).expect("a record");
    let scene: whipple_vv::scene::AnyScene = toml::from_str(&read("scene.toml")).expect("a scene");
    assert_eq!(Some(scene), record.scene);
    let fields = read("profile.csv");
    let head = fields.lines().next().expect("a head").to_owned();
    assert!(head.contains("velocity") && head.contains("velocity_exact"), "{head}");
    assert_eq!(fields.lines().count(), 21);
    let entries = std::fs::read_dir(folder.path().join("deep/out")).expect("the folder").count();
    assert_eq!(entries, 3, "no temporary file is left");
}

/// Heads of columns name units where the scene has them.
#[test]
fn columns_have_units() {
    let folder = folder();
    assert_eq!(said(folder.path(), &["run", "kolsky", "--n", "21", "--out", "out"]).code, Some(0));
    let text = std::fs::read_to_string(folder.path().join("out/history.csv")).expect("a history");
    assert_eq!(text.lines().next(), Some("time_ms,velocity (in/s),velocity_exact (in/s)"));

    let records = concat!(env!("CARGO_MANIFEST_DIR"), "/../reports/records");
    let records = Records::read(records.as_ref()).expect("the records of the report");
    let mut found: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for record in records.iter() {
        let scene = record.scene.as_ref();
        if scene.is_none_or(|scene| scene.units() == whipple_solver::units::Units::None) {
            continue;
        }
        let columns = [&record.profile, &record.history].into_iter().flatten();
        let columns = columns.flat_map(|series| series.0.keys().map(String::as_str));
        found.entry(&record.key.case).or_default().extend(columns);
    }
    // Records of runs that no figure shows leave theirs out.
    found.retain(|_, columns| !columns.is_empty());
    assert!(found.len() > 10, "{found:?}");
    for (id, columns) in found {
        let units = crate::common::case(id).units();
        assert_eq!(
            units.iter().map(|(column, _)| *column).collect::<BTreeSet<_>>(),
            columns,
            "{id}"
        );
    }
}

/// A folder is for one run: that made again replaces its own, another is refused before it starts.
#[test]
fn folder_of_another_run_is_refused() {
    let folder = folder();
    let run = |args: &[&str]| {
        let said = said(folder.path(), &[&["run"], args, &["--out", "x"]].concat());
        (said.code, said.err)
    };
    let record = || std::fs::read(folder.path().join("x/record.json")).expect("a record");
    let own = ["noh", "--n", "20"];
    for _ in 0..2 {
        assert_eq!(run(&own), (Some(0), String::new()));
    }
    // Otherwise said, the same.
    assert_eq!(run(&["noh", "--n", "20", "--density", "hybrid"]), (Some(0), String::new()));
    let kept = record();
    let wanted = "error: x holds another run, `whipple run noh --n 20`: name another folder with --out, or \
                  move that one away\n";
    for other in [
        &["sod", "--n", "20"][..],
        &["noh", "--n", "21"],
        &["noh", "--n", "20", "--preset", "paper"],
        &["noh", "--n", "20", "--set", "cfl=0.1"],
        &["noh", "--n", "20", "--stop", "0.1"],
        &["noh", "--n", "20", "--godunov"],
        &["planar-impact", "--n", "16"],
    ] {
        let (code, err) = run(other);
        let last = err.split_inclusive('\n').next_back();
        assert_eq!((code, last), (Some(2), Some(wanted)), "{other:?}");
        assert_eq!(err.matches("error:").count(), 1, "{err}");
    }
    assert!(record() == kept, "nothing is overwritten");
    std::fs::write(folder.path().join("x/record.json"), "{}").expect("a file");
    let (code, err) = run(&own);
    assert_eq!(code, Some(2));
    assert!(err.starts_with("error: x/record.json is not a record of format "), "{err}");
}

/// Files that have the names of results are the user's where no record says what they are.
#[test]
fn files_of_the_user_are_left_alone() {
    let folder = folder();
    let at = folder.path();
    for (name, args) in [
        ("scene.toml", &["run", "noh", "--n", "20"][..]),
        ("profile.csv", &["run", "noh", "--n", "20"]),
        ("history.csv", &["run", "kolsky", "--n", "21"]),
        ("ledger.csv", &["run", "planar-impact", "--n", "16"]),
        ("index.html", &["vv", "heat-chain", "--level", "quick"]),
        ("report.md", &["vv", "heat-chain", "--level", "quick"]),
        ("single-file.html", &["vv", "heat-chain", "--level", "quick", "--single-file"]),
    ] {
        let own = format!("of-{name}");
        std::fs::create_dir(at.join(&own)).expect("a folder");
        std::fs::write(at.join(&own).join(name), "mine").expect("a file");
        let said = said(at, &[args, &["--out", &own]].concat());
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{name}");
        let begin = format!("error: {own}/{name} is there already, with no record beside it ");
        assert!(said.err.starts_with(&begin), "{}", said.err);
        assert_eq!(std::fs::read_to_string(at.join(&own).join(name)).expect("it"), "mine");
        assert_eq!(std::fs::read_dir(at.join(&own)).expect("it").count(), 1, "nothing is written");
    }
}

/// Readers in Python say in a line what they need.
#[test]
fn scripts_name_what_they_need() {
    for (script, need) in [("read_checkpoint.py", "numpy"), ("read_vtu.py", "PyVista")] {
        let path = format!("{}/scripts/{script}", env!("CARGO_MANIFEST_DIR"));
        // Without its packages.
        let Ok(output) = Command::new("python3").args(["-I", "-S", &path]).output() else { return };
        let said = Said::from(output);
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{}", said.err);
        assert!(said.err.starts_with(&format!("{script} needs {need}")), "{}", said.err);
        assert_eq!(said.err.lines().count(), 1, "{}", said.err);
    }
}

/// A full disk is said to be one, whether results go to a device or to standard output.
#[cfg(target_os = "linux")]
#[test]
fn full_disk_is_reported() {
    let full =
        || std::fs::OpenOptions::new().write(true).open("/dev/full").expect("the full device");
    let output = whipple(&["list"]).stdout(full()).output().expect("the program starts");
    let said = Said::from(output);
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("No space left"), "{}", said.err);
    assert!(!said.err.contains("panicked"));
}

/// A reader that goes away is no error, and nobody is there to be told.
#[test]
fn closed_pipe_is_no_error() {
    for args in [
        &["list"][..],
        &["run", "noh", "--n", "20", "--json"],
        &["completions", "bash"],
        &["--help"],
    ] {
        let mut child = whipple(args)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        drop(child.stdout.take());
        let said = Said::from(child.wait_with_output().expect("it ends"));
        assert_eq!((said.code, said.err.as_str()), (Some(0), ""), "{args:?}");
    }
}

/// Colours only where a terminal asks for them: never into a pipe.
#[test]
fn pipes_get_no_colours() {
    for colour in [None, Some("1")] {
        for args in
            [&["--help"][..], &["run", "noh", "--preset", "papr"], &["run", "noh", "--n", "20"]]
        {
            let mut command = Command::new(env!("CARGO_BIN_EXE_whipple"));
            command.args(args).env_remove("NO_COLOR");
            if let Some(value) = colour {
                command.env("NO_COLOR", value);
            }
            let said = Said::from(command.output().expect("the program starts"));
            assert!(!said.out.contains('\u{1b}') && !said.err.contains('\u{1b}'), "{args:?}");
        }
    }
}

/// Completion scripts exist for the usual shells.
#[test]
fn completions_are_printed() {
    for shell in ["bash", "zsh", "fish"] {
        let said = said(folder().path(), &["completions", shell]);
        assert_eq!(said.code, Some(0));
        assert!(said.out.contains("whipple"), "{shell}");
    }
}

/// `bench density` runs at a usual size, prints its table and leaves it. No time is asserted.
#[test]
fn bench_measures_the_density() {
    let folder = folder();
    let said = said(folder.path(), &["bench", "density", "--rounds", "1", "--out", "out"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let table = std::fs::read_to_string(folder.path().join("out/density.csv")).expect("a table");
    assert_eq!(table.lines().count(), 1 + 6, "{table}");
    for rival in ["kernel, equal contact list", "kernel, natural support", "hybrid"] {
        assert_eq!(said.out.matches(rival).count(), 2, "{}", said.out);
    }
}

/// `bench rod` prints its tables and leaves them with the figure. No time is asserted.
#[test]
fn bench_measures_the_rod() {
    let folder = tempfile::tempdir().expect("a folder");
    let said = said(folder.path(), &["bench", "rod", "--steps", "3", "--out", "out"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for scheme in ["default", "paper", "paper + kernel"] {
        let rows = said.out.lines().filter(|line| line.trim_start().starts_with(scheme));
        assert!(rows.count() >= 2, "{scheme}: {}", said.out);
    }
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name));
    let work = read("long-rod-pace-work.csv").expect("a table");
    let head = work.lines().next().expect("a head");
    assert!(head.contains("1e6 updates/s") && head.contains("pairs acting"), "{head}");
    assert_eq!(work.lines().count(), 1 + 3, "{work}");
    for name in ["phases.csv", "machine.csv"].map(|name| format!("long-rod-pace-{name}")) {
        assert!(!read(&name).expect("a file").is_empty(), "{name}");
    }
    assert!(!read("long-rod-pace.svg").expect("a figure").is_empty());
}
