//! Scenes of the user's own: the examples, a run that is stopped and goes on, and what is said of bad files.

use std::fs;
use std::path::{Path, PathBuf};

use whipple_vv::cases::Case;
use whipple_vv::record::RunRecord;
use whipple_vv::scenes::build::Built;
use whipple_vv::scenes::case::FileCase;

use crate::common::said;

/// The examples, in the order of their names.
fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../references/scenes");
    let all =
        fs::read_dir(folder).expect("the examples").map(|entry| entry.expect("a file").path());
    let mut all: Vec<PathBuf> =
        all.filter(|p| p.extension().is_some_and(|e| e == "toml")).collect();
    all.sort();
    all
}

/// Every example is a scene that can run, of a size that a reader may wait for, and says what it is.
#[test]
fn examples_are_scenes() {
    let all = examples();
    assert!(all.len() >= 8, "{all:?}");
    for path in all {
        let case = FileCase::read(&path).unwrap_or_else(|error| panic!("{error}"));
        let scene = case.scene(whipple_solver::method::Preset::Default, "", case.default_size());
        let scene = scene.space().expect("in space");
        let simulation = whipple_solver::space::Simulation::new(scene)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let particles = simulation.particles();
        assert!((500..120_000).contains(&particles), "{}: {particles}", path.display());
        assert!(case.built().file.about.is_some(), "{}", path.display());
    }
}

/// A cube of copper on another, with probes of all kinds, which ends when most of its motion is gone.
const SMALL: &str = r#"
stop = "4 us"
until = { kinetic_below = "60 %" }
resolution = { cell = "1 mm" }

[[body]]
name = "flyer"
material = "copper"
box = { size = ["4 mm", "4 mm", "2 mm"] }
at = ["0 mm", "0 mm", "-1.6 mm"]
velocity = ["0 m/s", "0 m/s", "300 m/s"]

[[body]]
name = "target"
material = "copper"
cylinder = { diameter = "6 mm", length = "4 mm" }
at = ["0 mm", "0 mm", "2 mm"]

[[wall]]
axis = "z"
at = "4 mm"
bodies = "below"
kind = "rigid"

[[probe]]
name = "face"
point = ["0 mm", "0 mm", "-0.6 mm"]

[[probe]]
name = "middle"
plane = { axis = "z", at = "2 mm" }

[output]
every = "0.05 us"
"#;

#[test]
fn a_scene_runs_to_its_condition_and_goes_on_with_the_same_bits() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("small.toml"), SMALL).expect("written");
    let run = |args: &[&str]| said(folder.path(), args);
    let whole = run(&["run", "small.toml", "--out", "whole"]);
    assert_eq!(whole.code, Some(0), "{}", whole.err);
    let first = run(&["run", "small.toml", "--stop", "0.5us", "--out", "part"]);
    assert_eq!(first.code, Some(0), "{}", first.err);
    let read = |name: &str| {
        let text =
            fs::read_to_string(folder.path().join(name).join("record.json")).expect("a record");
        serde_json::from_str::<RunRecord>(&text).expect("a record")
    };
    let record = read("whole");
    let ended = record.norms["ended_at"];
    assert!(ended > 0.5 && ended < 4.0, "{ended}");
    assert!((0.0..=1.0 + 1e-12).contains(&record.norms["flyer.sound_part"]));
    assert!(record.norms["flyer.speed"] < 0.03);
    assert!(record.energy_drift < 1e-12);
    let history = record.history.expect("a history").0;
    let steps = history["time"].len();
    assert!((ended / 0.05).round() as usize + 1 == steps, "{steps} entries");
    assert!(history["face.pressure"].iter().any(|p| *p > 0.01));
    assert!(history["middle.momentum_beyond"].iter().any(|p| *p > 0.0));
    for name in ["pictures/start.png", "pictures/start-section.png", "history.csv", "scene.toml"] {
        assert!(folder.path().join("whole").join(name).exists(), "{name}");
    }
    // As it stood at half a microsecond, it is the same run.
    let part = read("part").history.expect("a history").0;
    for (name, column) in &part {
        assert_eq!(column[..], history[name][..column.len()], "{name}");
    }
}

/// Every rejection names file and line, points at the place, and says what is wanted.
#[test]
fn bad_scenes_are_pointed_at() {
    let body = |more: &str| {
        format!(
            "stop = \"4 us\"\nresolution = {{ cell = \"1 mm\" }}\n\n[[body]]\nname = \"ball\"\nmaterial = \"copper\"\n{more}\n"
        )
    };
    let ball = "sphere = { diameter = \"5 mm\" }";
    let bad = [
        String::new(),
        "stop = ".into(),
        "stop = \"4 us\"\n".into(),
        "stop = \"4 us\"\nresolution = { cell = \"1 mm\" }\n".into(),
        "stop = 4\nresolution = {}\n".into(),
        body(ball).replace("4 us", "four us"),
        body(ball).replace("4 us", "-4 us"),
        body(ball).replace("1 mm", "1 mmm"),
        body(ball).replace("cell = \"1 mm\"", "cell = \"1 mm\", through = 3"),
        body(ball).replace("copper", "coper"),
        body("sphere = { diamter = \"5 mm\" }"),
        body("sphere = { diameter = 5 }"),
        body("sphere = { diameter = \"5 g\" }"),
        body(""),
        body("sphere = { diameter = \"5 mm\" }\nbox = { size = [\"1 mm\", \"1 mm\", \"1 mm\"] }"),
        body("box = { size = [\"1 mm\", \"1 mm\"] }"),
        body(&format!("{ball}\nvelocity = [\"7\", \"0 m/s\", \"0 m/s\"]")),
        body(&format!("{ball}\nvelocty = [\"7 m/s\", \"0 m/s\", \"0 m/s\"]")),
        body(&format!("{ball}\ncell = \"1 nm\"")),
        body("stl = { file = \"none.stl\", unit = \"1 mm\" }"),
        format!("{}\n[[body]]\nname = \"ball\"\nmaterial = \"copper\"\n{ball}\n", body(ball)),
        format!("{}\n[[probe]]\nname = \"p\"\nbody = \"bal\"\n", body(ball)),
        format!("{}\n[[probe]]\nname = \"p\"\n", body(ball)),
        format!("until = {{ never = 1 }}\n{}", body(ball)),
        format!(
            "{}\n[[wall]]\naxis = \"w\"\nat = \"0 cm\"\nbodies = \"above\"\nkind = \"rigid\"\n",
            body(ball)
        ),
        format!("units = \"none\"\n{}", body(ball)),
        format!("{}\n[[material]]\nname = \"copper\"\ndensity = \"8.9 g/cm3\"\n", body(ball)),
        format!("{}\n[method]\nset = {{ visc_linaer = 0.5 }}\n", body(ball)),
    ];
    let mut all = Vec::new();
    for text in bad {
        let error = match Built::of(Path::new("bad.toml"), &text, None) {
            Err(error) => error.to_string(),
            Ok(_) => {
                let folder = tempfile::tempdir().expect("a folder");
                let path = folder.path().join("bad.toml");
                fs::write(&path, &text).expect("written");
                let error = FileCase::read(&path).err().expect("refused");
                error.to_string().replace(&path.display().to_string(), "bad.toml")
            }
        };
        all.push(error);
    }
    insta::assert_snapshot!("bad_scene_files", all.join("\n\n"));
}

/// A scene to begin with can be made, checked and run; a name that is none and a file that is there are refused.
#[test]
fn a_new_scene_can_be_checked() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |args: &[&str]| said(folder.path(), args);
    assert_eq!(run(&["new", "first.toml"]).code, Some(0));
    let again = run(&["new", "first.toml"]);
    assert_eq!((again.code, again.err.as_str()), (Some(2), "error: first.toml is there already\n"));
    assert_eq!(run(&["new", "first.txt"]).code, Some(2));
    let checked = run(&["check", "first.toml", "--out", "drawn"]);
    assert_eq!(checked.code, Some(0), "{}", checked.err);
    for what in
        ["sphere: al-6061-t6", "gap of", "symmetric in the plane x = 0", "memory: ", "first step"]
    {
        assert!(checked.out.contains(what), "{what}: {}", checked.out);
    }
    assert!(folder.path().join("drawn/start-section.png").exists());
}

/// The library is listed, and every material of it can be shown.
#[test]
fn materials_are_shown() {
    let list = said(Path::new("."), &["material", "list"]);
    let names: Vec<&str> = list.out.lines().filter_map(|line| line.split(' ').next()).collect();
    assert!(names.len() >= 20);
    for name in ["al-6061-t6", "air", "water", "steel-4340"] {
        assert!(names.contains(&name));
        let shown = said(Path::new("."), &["material", "show", name]);
        assert!(shown.code == Some(0) && shown.out.contains("sources"), "{name}: {}", shown.err);
    }
    let none = said(Path::new("."), &["material", "show", "al-6061"]);
    assert_eq!(none.code, Some(2));
    insta::assert_snapshot!(
        "material_copper",
        said(Path::new("."), &["material", "show", "copper"]).out
    );
}

/// Combinations of values run once each, into one table; the search for a limit halves its range.
#[test]
fn sweeps_and_limits() {
    let folder = tempfile::tempdir().expect("a folder");
    let coarse = SMALL
        .replace("cell = \"1 mm\"", "cell = \"2 mm\"")
        .replace("stop = \"4 us\"", "stop = \"0.5 us\"");
    fs::write(folder.path().join("small.toml"), &coarse).expect("written");
    let run = |args: &[&str]| said(folder.path(), args);
    let speeds = "body.flyer.velocity.2=200 m/s, 300 m/s";
    let sweep =
        ["sweep", "small.toml", "--vary", speeds, "--vary", "stop=0.2 us, 0.3 us", "--out", "s"];
    let listed = run(&[&sweep[..], &["--list"]].concat());
    assert_eq!(listed.code, Some(0), "{}", listed.err);
    assert_eq!(listed.out.lines().count(), 4);
    assert!(
        listed.out.starts_with("whipple run s/001/case.toml --out s/001/run\n"),
        "{}",
        listed.out
    );
    let done = run(&[&sweep[..], &["--jobs", "2"]].concat());
    let left = "s/sweep.csv\ns/sweep.svg\ns/sweep.png\n";
    assert_eq!((done.code, done.out.as_str()), (Some(0), left), "{}", done.err);
    let figure = fs::read_to_string(folder.path().join("s/sweep.svg")).expect("a figure");
    assert!(figure.contains("body.flyer.velocity.2, m/s") && figure.contains("stop = 0.3 us"));
    assert!(figure.contains("speed of flyer, cm/µs"));
    let table = fs::read_to_string(folder.path().join("s/sweep.csv")).expect("a table");
    assert_eq!(table.lines().count(), 5);
    assert!(table.starts_with("run,body.flyer.velocity.2,stop,outcome,cpu_seconds,"), "{table}");
    assert!(table.contains("\n004,300 m/s,0.3 us,completed,"), "{table}");
    // What has run is not run again: not a bit of the records changes, times included.
    let record = folder.path().join("s/002/run/record.json");
    let before = fs::read(&record).expect("a record");
    assert_eq!(run(&sweep).code, Some(0));
    assert_eq!(fs::read(&record).expect("a record"), before);
    let other = run(&["sweep", "small.toml", "--vary", "stop=0.1 us, 0.3 us", "--out", "s"]);
    assert_eq!(other.code, Some(2));
    assert!(other.err.contains("is of another sweep"), "{}", other.err);
    let wrong = run(&["sweep", "small.toml", "--vary", "body.flyr.velocity.2=1 m/s", "--out", "t"]);
    assert_eq!(wrong.code, Some(2));
    assert!(wrong.err.contains("did you mean `flyer`?"), "{}", wrong.err);

    let slow = coarse
        .replace("kinetic_below = \"60 %\"", "slower = { body = \"flyer\", than = \"150 m/s\" }");
    fs::write(folder.path().join("slow.toml"), slow).expect("written");
    let ends = ["--low", "100 m/s", "--high", "2100 m/s", "--runs", "2", "--out", "l"];
    let limit = run(&[&["limit", "slow.toml", "body.flyer.velocity.2"], &ends[..]].concat());
    assert_eq!(limit.code, Some(0), "{}", limit.err);
    assert!(limit.out.starts_with("body.flyer.velocity.2: met at "), "{}", limit.out);
    let runs = fs::read_dir(folder.path().join("l")).expect("a folder");
    assert_eq!(runs.filter(|run| run.as_ref().is_ok_and(|run| run.path().is_dir())).count(), 4);
    let table = fs::read_to_string(folder.path().join("l/limit.csv")).expect("a table");
    assert!(table.starts_with("value,unit,met\n100,m/s,"), "{table}");
    assert_eq!(table.lines().count(), 5);
    assert!(folder.path().join("l/limit.png").exists());
    let same = run(&[
        &["limit", "slow.toml", "body.flyer.velocity.2"],
        &["--low", "100 m/s", "--high", "110 m/s", "--out", "l"][..],
    ]
    .concat());
    assert_eq!(same.code, Some(2));
    assert!(same.err.contains("met at both ends"), "{}", same.err);
}

/// Runs of a sweep have the surfaces of their scene beside them, and surfaces from elsewhere are refused.
#[test]
fn sweeps_take_surfaces_with_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let corners = ["0 0 0", "4 0 0", "0 4 0", "0 0 4"];
    let mut surface = "solid corner\n".to_owned();
    for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] {
        surface += "facet normal 0 0 0\nouter loop\n";
        face.iter().for_each(|&k: &usize| surface += &format!("vertex {}\n", corners[k]));
        surface += "endloop\nendfacet\n";
    }
    fs::create_dir(folder.path().join("parts")).expect("a folder");
    fs::write(folder.path().join("parts/corner.stl"), surface + "endsolid corner\n")
        .expect("written");
    let scene = "stop = \"1 us\"\nresolution = { cell = \"0.5 mm\" }\n[[body]]\nname = \"a\"\nmaterial = \"copper\"\n\
                 stl = { file = \"parts/corner.stl\", unit = \"1 mm\" }\n";
    fs::write(folder.path().join("a.toml"), scene).expect("written");
    let sweep = ["sweep", "a.toml", "--vary", "stop=1 us, 2 us", "--out", "s", "--list"];
    let done = said(folder.path(), &sweep);
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(folder.path().join("s/002/parts/corner.stl").exists());
    fs::create_dir(folder.path().join("b")).expect("a folder");
    let above = scene.replace("parts/", "../parts/");
    fs::write(folder.path().join("b/b.toml"), above).expect("written");
    let done = said(
        &folder.path().join("b"),
        &["sweep", "b.toml", "--vary", "stop=1 us", "--out", "s", "--list"],
    );
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("take their surfaces with them"), "{}", done.err);
}
