//! Checkpoints, frames, histories and pictures of a small run in three dimensions.

#![allow(clippy::unwrap_used)]

use std::fs;

use whipple_solver::method::Preset;
use whipple_solver::space::scene::{
    Body, EosData, Failure, GammaLaw, Material, Scene, Shape, Strength, Turn,
};
use whipple_solver::space::{Simulation, restart::Values};
use whipple_solver::units::Units;
use whipple_vv::space::checkpoint::{load, pack, save, scene_hash};
use whipple_vv::space::frames::Frames;
use whipple_vv::space::history::{History, HistoryError};
use whipple_vv::space::measured::{Look, Measured, Photo, Worst};
use whipple_vv::space::picture::{
    Shot, Shown, frame, from_the_side, model, onto_the_section, shoot, symmetry_plane,
};

use crate::vtk_reader::Document;

/// Two cubes of copper that meet.
fn cubes() -> Scene {
    let law = GammaLaw::ConstantProduct;
    let copper = Material {
        name: "copper".into(),
        density: 8.93,
        eos: EosData::MieGruneisen {
            c0: 0.394,
            s: 1.49,
            gamma_0: 2.0,
            law,
            c_v: 4e-6,
            theta_0: 300.0,
        },
        strength: Some(Strength { shear_modulus: 0.45, flow: None }),
        failure: Failure { compression: 0.6, ..Failure::default() },
    };
    let cube = |name: &str, x: f64, v: f64| Body {
        name: name.into(),
        material: "copper".into(),
        shape: Shape::Box { size: [0.3; 3] },
        cells: [3; 3],
        centre: [x, 0.0, 0.0],
        turn: Turn::default(),
        velocity: [v, 0.0, 0.0],
        spin: [0.0; 3],
        energy: 0.0,
        noise: 0.0,
        mapping: None,
    };
    Scene {
        name: "cubes".into(),
        units: Units::CmGUsMbar,
        stop_time: 1.0,
        method: Preset::Default.space(),
        walls: Vec::new(),
        materials: vec![copper],
        bodies: vec![cube("left, one", -0.2, 0.3), cube("right", 0.2, -0.3)],
    }
}

fn after(scene: &Scene, steps: usize) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    (0..steps).for_each(|_| simulation.step(f64::INFINITY).unwrap());
    simulation
}

/// Bits of all doubles of the state.
fn bits(simulation: &Simulation) -> Vec<u64> {
    let sections = simulation.sections().into_iter();
    let doubles = sections.filter_map(|section| match section.values {
        Values::F64(values) => Some(values),
        _ => None,
    });
    doubles.flatten().map(f64::to_bits).collect()
}

#[test]
fn a_run_continues_from_its_file_bit_for_bit() {
    let (scene, folder) = (cubes(), tempfile::tempdir().unwrap());
    let looks = [0.0, 0.1].map(|time| Look { time, values: vec![time, f64::NAN, -0.0] });
    let worst = Worst { energy: 1e-15, momentum: 2e-15, angular: 3e-15 };
    let photo = |id: &str| Photo {
        id: id.to_owned(),
        caption: "Ein Würfel".to_owned(),
        light: vec![1, 2],
        dark: Vec::new(),
    };
    let photos = vec![photo("first"), photo("second")];
    let measured = Measured { looks: looks.to_vec(), worst, cpu_seconds: 1.5, photos };
    let path = save(folder.path(), (&scene, "whipple run"), &after(&scene, 30), &measured).unwrap();
    // A later end is the same scene.
    let longer = Scene { stop_time: 2.0, ..scene.clone() };
    let halted = load(&path, &longer).unwrap();
    // Not a number is not equal to itself, but it is written alike.
    assert_eq!(format!("{:?}", halted.measured), format!("{measured:?}"));
    let mut rest = halted.simulation;
    (0..30).for_each(|_| rest.step(f64::INFINITY).unwrap());
    let whole = after(&scene, 60);
    assert!(bits(&rest) == bits(&whole));
    assert_eq!(rest.balance(), whole.balance());
    assert_eq!(rest.counters(), whole.counters());
}

#[test]
fn damaged_and_foreign_files_are_refused_with_the_section() {
    let (scene, folder) = (cubes(), tempfile::tempdir().unwrap());
    let path = folder.path().join("state.whp");
    let measured = Measured::default();
    let file =
        pack((&scene, "whipple run"), &after(&scene, 5), &measured).unwrap().to_bytes().unwrap();
    let said = |file: &[u8], scene: &Scene| {
        fs::write(&path, file).unwrap();
        load(&path, scene).unwrap_err().to_string()
    };
    let text = said(&file[..file.len() - 10], &scene);
    assert!(
        text.starts_with("section `measured.cpu_seconds`: the file ends before it does"),
        "{text}"
    );
    let mut altered = file.clone();
    *altered.last_mut().unwrap() ^= 1;
    let text = said(&altered, &scene);
    assert!(text.starts_with("section `measured.cpu_seconds`: BLAKE3 is"), "{text}");
    let mut other = scene.clone();
    other.method.cfl *= 0.5;
    assert_ne!(scene_hash(&scene), scene_hash(&other));
    let text = said(&file, &other);
    assert!(text.starts_with("header: the state is of scene"), "{text}");
}

#[test]
fn frames_hold_all_particles_and_elements() {
    let (scene, folder) = (cubes(), tempfile::tempdir().unwrap());
    let path = folder.path().join("run.pvd");
    let mut frames = Frames::new(&path).unwrap();
    let mut simulation = after(&scene, 0);
    frames.record(&simulation).unwrap();
    simulation.advance_to(0.3).unwrap();
    frames.record(&simulation).unwrap();
    let part = |name: &str| Document::read(&fs::read(folder.path().join(name)).unwrap());
    let mass =
        part("run-particles-000001.vtu").array("PointData", "mass").values(f64::from_le_bytes);
    assert_eq!(mass.len(), simulation.particles());
    assert!((mass.iter().sum::<f64>() - simulation.balance().now.mass).abs() < 1e-12);
    let live = part("run-elements-000001.vtu").array("CellData", "live").values(u8::from_le_bytes);
    assert_eq!(live.len(), simulation.elements());
    let dead = live.iter().filter(|&&live| live == 0).count();
    assert_eq!(dead, simulation.failed().1);
    // A run that goes on from an earlier time writes its later frames anew.
    let mut frames = Frames::resume(&path, 0.3).unwrap();
    frames.record(&simulation).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap().matches("<DataSet").count(), 4);
}

#[test]
fn histories_continue_where_the_run_does() {
    let (scene, folder) = (cubes(), tempfile::tempdir().unwrap());
    let path = folder.path().join("history.csv");
    let mut history = History::new(&path, &scene);
    assert!(history.is_empty());
    let mut simulation = after(&scene, 0);
    for time in [0.0, 0.1, 0.2] {
        simulation.advance_to(time).unwrap();
        history.record(&simulation);
        history.record(&simulation);
    }
    history.save().unwrap();
    assert_eq!(History::resume(&path, &scene, 0.2).unwrap(), history);
    assert_eq!(History::resume(&path, &scene, 0.1).unwrap().len(), 2);
    // It would lack what was between its last row and the checkpoint.
    assert!(History::resume(&path, &scene, 0.15).is_err());
    let mut rows = csv::Reader::from_path(&path).unwrap();
    let heads = rows.headers().unwrap().clone();
    let column = |name: &str| heads.iter().position(|head| head == name).unwrap();
    let last = rows.records().last().unwrap().unwrap();
    let value = |name: &str| last[column(name)].parse::<f64>().unwrap();
    let now = simulation.balance().now;
    assert_eq!(value("total.kinetic").to_bits(), now.kinetic.to_bits());
    let parts = value("left_ one.kinetic") + value("right.kinetic");
    assert!((parts - now.kinetic).abs() < 1e-12 * now.kinetic);
    assert!(value("energy_drift") < 1e-12);
    let mut other = scene.clone();
    other.bodies[0].name = "left".into();
    let refused = History::resume(&path, &other, 0.2).unwrap_err();
    assert!(matches!(refused, HistoryError::Format { line: 1, .. }), "{refused}");
}

#[test]
fn pictures_show_elements_and_debris() {
    let scene = cubes();
    let mut simulation = after(&scene, 0);
    assert_eq!(model(&simulation, Shown::Body).hexahedra.len(), 54);
    simulation.advance_to(0.4).unwrap();
    let (dead, shown) = (simulation.failed().1, model(&simulation, Shown::Body));
    assert_eq!(shown.hexahedra.len(), 54 - dead);
    let loose = simulation.all_particles().filter(|p| p.held == 0.0).count();
    assert!(shown.spheres.len() == loose && loose >= dead);
    let [low, high] = frame(&simulation, 0.01);
    assert!((0..3).all(|d| low[d] < high[d]));
    let by_body = Shot {
        title: "two cubes".into(),
        camera: from_the_side(),
        section: None,
        shown: Shown::Body,
        loose: true,
    };
    let cut = Shot {
        camera: onto_the_section(),
        section: Some(symmetry_plane(&simulation)),
        shown: Shown::Temperature(None),
        ..by_body.clone()
    };
    let strained = Shot { shown: Shown::PlasticStrain(None), loose: false, ..cut.clone() };
    for shot in [by_body, cut, strained] {
        let files = shoot(&simulation, &scene, &shot).unwrap();
        assert_ne!(files[0], files[1]);
        for file in files {
            assert!(file.starts_with(b"\x89PNG") && file.len() < 300_000);
        }
    }
}
