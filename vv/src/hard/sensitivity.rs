//! How far the numbers of impacts move with choices that no experiment decides: the step, where and how the lattice
//! lies, viscosity, and constants of failure.

use std::path::{Path, PathBuf};

use nalgebra::{Unit, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};
use whipple_solver::method::Preset;
use whipple_solver::space::method::Release;
use whipple_solver::space::scene::{Body, Material, Scene, Shape, Turn};

use super::record::HardError;
use crate::cases::find;
use crate::files::{FileError, write_atomic};
use crate::record::{Outcome, RunKey, Scheme};
use crate::run::{Request, RunError, Silent, run};
use crate::scene::AnyScene;

/// Version of the format.
const SCHEMA: u32 = 1;

/// A number of a case that is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Headline {
    /// Its name among the norms of the case.
    pub norm: &'static str,
    /// Its title in tables.
    pub title: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Added to it: 1 where the norm is a relative error.
    offset: f64,
}

/// A case, its size, and the numbers that are looked at.
#[derive(Debug, Clone, Copy)]
pub struct Study {
    /// The case.
    pub case: &'static str,
    /// The variant.
    variant: &'static str,
    /// The size.
    n: usize,
    /// The numbers.
    pub headlines: &'static [Headline],
}

const fn headline(norm: &'static str, title: &'static str, unit: &'static str) -> Headline {
    Headline { norm, title, unit, offset: 0.0 }
}

/// Numbers of a plate that is perforated.
const HOLE: [Headline; 3] = [
    headline("hole_diameter_cm", "hole", "cm"),
    headline("debris_front_km_s", "front of the cloud", "km/s"),
    headline("perforation_time_us", "perforated", "µs"),
];

/// All studies.
pub const STUDIES: [Study; 5] = [
    Study {
        case: "planar-impact",
        variant: "cu-4",
        n: 80,
        headlines: &[
            Headline {
                offset: 1.0,
                ..headline("pressure_error", "pressure over the exact one", "")
            },
            headline("shock_speed", "speed of the shock", "km/s"),
        ],
    },
    Study {
        case: "taylor-copper",
        variant: "",
        n: 8,
        headlines: &[
            headline("length_mm", "length", "mm"),
            headline("foot_radius_mm", "radius of the foot", "mm"),
        ],
    },
    Study {
        case: "long-rod",
        variant: "",
        n: 5,
        headlines: &[
            headline("residual_length_cm", "length", "cm"),
            headline("residual_velocity_km_s", "velocity", "km/s"),
        ],
    },
    Study { case: "al-sphere-plate", variant: "", n: 6, headlines: &HOLE },
    Study { case: "rcc-plate", variant: "", n: 4, headlines: &HOLE },
];

/// What is changed, and how; false where the scene has nothing of it.
struct Change {
    kind: &'static str,
    name: &'static str,
    make: fn(&mut Scene) -> bool,
}

const fn change(kind: &'static str, name: &'static str, make: fn(&mut Scene) -> bool) -> Change {
    Change { kind, name, make }
}

/// Kinds of changes.
const STEP: &str = "time step";
const PLACE: &str = "place of the lattice";
const TURNED: &str = "lattice turned";
const VISCOSITY: &str = "viscosity";
const FAILURE: &str = "failure";

/// All changes; ranges of constants of failure are those of `references/gaps.toml`, or a fifth to either side.
const CHANGES: [Change; 22] = [
    change(STEP, "half", |scene| scaled(&mut scene.method.cfl, 0.5)),
    change(STEP, "0.9 of it", |scene| scaled(&mut scene.method.cfl, 0.9)),
    change(PLACE, "half a cell across", |scene| shifted(scene, [0.5, 0.0])),
    change(PLACE, "half a cell across and along", |scene| shifted(scene, [0.5, 0.5])),
    change(PLACE, "a quarter and a third", |scene| shifted(scene, [0.25, 1.0 / 3.0])),
    change(TURNED, "15 degrees", |scene| turned(scene, 15.0)),
    change(TURNED, "30 degrees", |scene| turned(scene, 30.0)),
    change(TURNED, "45 degrees", |scene| turned(scene, 45.0)),
    change(VISCOSITY, "linear, half", |scene| scaled(&mut scene.method.visc_linear, 0.5)),
    change(VISCOSITY, "linear, twice", |scene| scaled(&mut scene.method.visc_linear, 2.0)),
    change(VISCOSITY, "quadratic, half", |scene| scaled(&mut scene.method.visc_quad, 0.5)),
    change(VISCOSITY, "quadratic, twice", |scene| scaled(&mut scene.method.visc_quad, 2.0)),
    change(VISCOSITY, "on expansion, none", |scene| scaled(&mut scene.method.visc_expansion, 0.0)),
    change(VISCOSITY, "on expansion, twice", |scene| scaled(&mut scene.method.visc_expansion, 2.0)),
    change(FAILURE, "volume 0.2", |scene| compressed(scene, 0.2)),
    change(FAILURE, "volume 0.4", |scene| compressed(scene, 0.4)),
    change(FAILURE, "plastic strain, 0.8 of it", |scene| strained(scene, 0.8)),
    change(FAILURE, "plastic strain, 1.2 of it", |scene| strained(scene, 1.2)),
    change(FAILURE, "spall strength, 0.8 of it", |scene| spalled(scene, 0.8)),
    change(FAILURE, "spall strength, 1.2 of it", |scene| spalled(scene, 1.2)),
    change(FAILURE, "strength lost in 2 crossings", |scene| released(scene, 2.0)),
    change(FAILURE, "strength lost in 20 crossings", |scene| released(scene, 20.0)),
];

fn scaled(value: &mut f64, factor: f64) -> bool {
    let there = *value > 0.0;
    *value *= factor;
    there
}

/// Moves the first body by parts of the cell of the second along and across that.
fn shifted(scene: &mut Scene, parts: [f64; 2]) -> bool {
    let [first, second] = &mut scene.bodies[..] else { return false };
    if !matches!(first.shape, Shape::Sphere { .. } | Shape::Cylinder { .. }) {
        return false;
    }
    let edge = |axis: usize| second.shape.extent()[axis] / second.cells[axis] as f64;
    // In the plane of the plate, whose thinnest extent is its normal.
    let extent = second.shape.extent();
    let normal = (0..3).min_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(2);
    let axes: Vec<usize> = (0..3).filter(|&axis| axis != normal).collect();
    for (axis, part) in axes.into_iter().zip(parts) {
        first.centre[axis] += part * edge(axis);
    }
    true
}

/// Turns the lattice of a sphere about a skew axis, of a cylinder about its own.
fn turned(scene: &mut Scene, degrees: f64) -> bool {
    let Some(Body { shape, turn, .. }) = scene.bodies.first_mut() else { return false };
    let about = match shape {
        Shape::Sphere { .. } => Vector3::new(0.3, -0.5, 0.8),
        Shape::Cylinder { .. } => Vector3::z(),
        _ => return false,
    };
    let rotation = |axis: Vector3<f64>, degrees: f64| {
        UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), degrees.to_radians())
    };
    let whole = rotation(Vector3::from(turn.axis), turn.degrees) * rotation(about, degrees);
    let (axis, angle) = whole.axis_angle().unwrap_or((Vector3::z_axis(), 0.0));
    *turn = Turn { axis: [axis.x, axis.y, axis.z], degrees: angle.to_degrees() };
    true
}

/// Changes all materials; whether any has what is changed.
fn each(scene: &mut Scene, mut change: impl FnMut(&mut Material) -> bool) -> bool {
    scene.materials.iter_mut().fold(false, |any, material| change(material) | any)
}

fn compressed(scene: &mut Scene, volume: f64) -> bool {
    // Fluid columns are not pressed so far.
    each(scene, |material| {
        material.failure.compression = volume;
        material.failure.plastic_strain.is_some()
    })
}

fn strained(scene: &mut Scene, factor: f64) -> bool {
    each(scene, |material| {
        material.failure.plastic_strain = material.failure.plastic_strain.map(|s| s * factor);
        material.failure.plastic_strain.is_some()
    })
}

fn spalled(scene: &mut Scene, factor: f64) -> bool {
    each(scene, |material| {
        material.failure.spall = material.failure.spall.map(|s| s * factor);
        material.failure.spall.is_some()
    })
}

fn released(scene: &mut Scene, crossings: f64) -> bool {
    scene.method.release = Release::Crossings(crossings);
    scene.materials.iter().any(|material| material.failure.plastic_strain.is_some())
}

/// What a change does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// What is changed; empty for the case as it stands.
    pub kind: String,
    /// How.
    pub change: String,
    /// The numbers, in the order of the study; none where one is no number.
    pub values: Vec<Option<f64>>,
    /// Why the run has no numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
}

/// What was found for a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensitivityRecord {
    /// Version of the format.
    pub schema: u32,
    /// The case.
    pub case: String,
    /// Its size.
    pub n: usize,
    /// Fingerprint of the sources of the solver that ran.
    pub fingerprint: String,
    /// The case as it stands first, then all changes that it has anything of.
    pub rows: Vec<Row>,
}

impl Study {
    /// Runs the case as it stands and with every change, and tells of each.
    ///
    /// # Errors
    /// A run that fails by other than its numbers.
    pub fn run(&self, mut tell: impl FnMut(&Row)) -> Result<SensitivityRecord, RunError> {
        let mut rows = Vec::new();
        let none = change("", "as it stands", |_| true);
        for change in std::iter::once(&none).chain(&CHANGES) {
            if let Some(row) = self.row(change)? {
                tell(&row);
                rows.push(row);
            }
        }
        let fingerprint = crate::record::FINGERPRINT.to_owned();
        Ok(SensitivityRecord {
            schema: SCHEMA,
            case: self.case.into(),
            n: self.n,
            fingerprint,
            rows,
        })
    }

    fn row(&self, change: &Change) -> Result<Option<Row>, RunError> {
        let Some(case) = find(self.case) else { return Ok(None) };
        let key =
            RunKey::new(self.case, Scheme::preset(Preset::Default), self.n).variant(self.variant);
        let AnyScene::Space(mut scene) = case.scene(Preset::Default, self.variant, self.n) else {
            return Ok(None);
        };
        if !(change.make)(&mut scene) {
            return Ok(None);
        }
        let request = Request {
            key,
            scene: Some(AnyScene::Space(scene)),
            threads: 1,
            command: String::new(),
        };
        let record = run(case, request, &Silent)?.record;
        let value = |headline: &Headline| {
            let value = record.norms.get(headline.norm)? + headline.offset;
            value.is_finite().then_some(value)
        };
        let failed = match &record.outcome {
            Outcome::Completed => None,
            Outcome::Failed { message, .. } => Some(message.clone()),
        };
        Ok(Some(Row {
            kind: change.kind.into(),
            change: change.name.into(),
            values: self.headlines.iter().map(value).collect(),
            failed,
        }))
    }
}

impl SensitivityRecord {
    /// The folder of these records in that of the hard cases.
    #[must_use]
    pub fn folder(hard: &Path) -> PathBuf {
        hard.join("sensitivity")
    }

    /// Whether the solver has changed since.
    #[must_use]
    pub fn is_stale(&self) -> bool {
        self.fingerprint != crate::record::FINGERPRINT
    }

    /// A number of the case as it stands.
    #[must_use]
    pub fn base(&self, headline: usize) -> Option<f64> {
        *self.rows.first()?.values.get(headline)?
    }

    /// Change of a number in a row over that of the case as it stands.
    #[must_use]
    pub fn moved(&self, row: &Row, headline: usize) -> Option<f64> {
        Some(row.values.get(headline).copied().flatten()? / self.base(headline)? - 1.0)
    }

    /// Smallest and largest change of a number over rows of a kind, or over all.
    #[must_use]
    pub fn spread(&self, kind: Option<&str>, headline: usize) -> Option<[f64; 2]> {
        let rows = self.rows.iter().skip(1).filter(|row| kind.is_none_or(|kind| row.kind == kind));
        let moved = rows.filter_map(|row| self.moved(row, headline));
        moved.fold(None, |range: Option<[f64; 2]>, x| {
            let [low, high] = range.unwrap_or([0.0; 2]);
            Some([low.min(x), high.max(x)])
        })
    }

    /// Kinds of changes, in their order.
    #[must_use]
    pub fn kinds(&self) -> Vec<&str> {
        let mut kinds: Vec<&str> = self.rows.iter().skip(1).map(|row| row.kind.as_str()).collect();
        kinds.dedup();
        kinds
    }

    /// Writes it to a folder, which must exist.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn write(&self, folder: &Path) -> Result<(), FileError> {
        // Plain data: JSON can carry all of it.
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        write_atomic(&folder.join(format!("{}.json", self.case)), text.as_bytes())
    }

    /// Reads those of all studies that a folder has.
    ///
    /// # Errors
    /// The first file that cannot be read, or is no such record.
    pub fn read_all(folder: &Path) -> Result<Vec<(Study, Self)>, HardError> {
        let mut all = Vec::new();
        for study in STUDIES {
            let path = folder.join(format!("{}.json", study.case));
            if !path.exists() {
                continue;
            }
            let text = std::fs::read_to_string(&path)
                .map_err(|source| HardError::Unreadable { path: path.clone(), source })?;
            let not_one = |why: String| HardError::NotOne { path: path.clone(), why };
            let record: Self =
                serde_json::from_str(&text).map_err(|error| not_one(error.to_string()))?;
            let whole = record.rows.iter().all(|row| row.values.len() == study.headlines.len());
            if record.schema != SCHEMA || record.case != study.case || !whole {
                return Err(not_one("it is of another study".into()));
            }
            all.push((study, record));
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene_of(study: &Study) -> Scene {
        let case = find(study.case).expect("the case");
        let AnyScene::Space(scene) = case.scene(Preset::Default, study.variant, study.n) else {
            panic!("in space");
        };
        scene
    }

    #[test]
    fn changes_give_scenes_that_run_and_differ() {
        for study in &STUDIES {
            let own = scene_of(study);
            let mut made = 0;
            for change in &CHANGES {
                let mut scene = own.clone();
                if (change.make)(&mut scene) {
                    assert_ne!(scene, own, "{}: {} {}", study.case, change.kind, change.name);
                    scene.validate().expect("a scene");
                    made += 1;
                }
            }
            assert!(made >= 8, "{}: {made}", study.case);
        }
    }

    #[test]
    fn a_cylinder_turns_about_its_own_axis() {
        let study = STUDIES.iter().find(|study| study.case == "long-rod").expect("the study");
        let mut scene = scene_of(study);
        let axis = |turn: Turn| {
            let axes =
                whipple_solver::space::lattice::rotation(turn.axis, turn.degrees.to_radians());
            axes[2]
        };
        let before = axis(scene.bodies[0].turn);
        assert!(turned(&mut scene, 30.0));
        let after = axis(scene.bodies[0].turn);
        let apart = (0..3).map(|d| (after[d] - before[d]).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-12, "{before:?} {after:?}");
    }

    #[test]
    fn spreads_are_those_of_the_rows() {
        let row = |kind: &str, value: Option<f64>| Row {
            kind: kind.into(),
            change: String::new(),
            values: vec![value],
            failed: None,
        };
        let record = SensitivityRecord {
            schema: SCHEMA,
            case: "rod".into(),
            n: 1,
            fingerprint: String::new(),
            rows: vec![
                row("", Some(2.0)),
                row("a", Some(3.0)),
                row("a", Some(1.5)),
                row("b", None),
            ],
        };
        assert_eq!(record.spread(Some("a"), 0), Some([-0.25, 0.5]));
        assert_eq!(
            (record.spread(None, 0), record.spread(Some("b"), 0)),
            (Some([-0.25, 0.5]), None)
        );
        assert_eq!(record.kinds(), ["a", "b"]);
    }
}
