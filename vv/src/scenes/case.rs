//! A scene file as a case: it runs, records, resumes and draws as the built-in ones do.

use std::path::Path;
use std::str::FromStr;
use std::time::{Duration, Instant};

use whipple_solver::error::StepError;
use whipple_solver::method::Preset;
use whipple_solver::space::{Scene, Simulation};
use whipple_solver::units::{Dimension, Units};

use super::build::Built;
use super::error::FileError;
use super::file::{Axis, Colour};
use super::probes::Probes;
use super::quantity::{Kind, read};
use crate::cases::{Case, Level};
use crate::claims::Claim;
use crate::overrides;
use crate::paint::{Camera, PaintError, Plane};
use crate::plots::Figure;
use crate::record::{Records, RunKey, Series};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;
use crate::space::picture::{Shot, Shown, frame, shoot};

/// Entries of the histories, where nothing is said of them.
const ENTRIES: f64 = 200.0;

/// Share of the loose particles that pictures may leave out, beyond either end of each axis.
const OUTSIDE: f64 = 0.02;

/// A picture by its name, for light and for dark pages.
pub type Drawn = (String, [Vec<u8>; 2]);

/// A scene file that runs. Names last as long as the program, which reads few files.
pub struct FileCase {
    id: &'static str,
    built: Built,
    probes: Probes,
    units: &'static [(&'static str, &'static str)],
    /// Numbers at the end, with titles that name their units.
    numbers: &'static [(&'static str, &'static str)],
    /// Time between entries, and times of pictures.
    every: f64,
    pictures: Vec<f64>,
}

/// Why a file is no case.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    /// The file.
    #[error(transparent)]
    File(#[from] FileError),
    /// What its method changes.
    #[error("{path}: `method.set`: {error}")]
    Method {
        /// The file.
        path: String,
        /// What is wrong.
        error: String,
    },
    /// The scene that it makes.
    #[error("{path}: {error}")]
    Scene {
        /// The file.
        path: String,
        /// What is wrong.
        error: String,
    },
}

impl FileCase {
    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let mut built = Built::read(path, None)?;
        let said = path.display().to_string();
        built.scene = changed(&built, Preset::Default, built.scene.clone())
            .map_err(|error| CaseError::Method { path: said.clone(), error })?;
        built
            .scene
            .validate()
            .map_err(|error| CaseError::Scene { path: said.clone(), error: error.to_string() })?;
        let probes = Probes::new(&built)?;
        let of = built.reading();
        let stop = built.scene.stop_time;
        let output = &built.file.output;
        let every = match &output.every {
            Some(every) => of.positive(every, Kind::TIME)?,
            None => stop / ENTRIES,
        };
        let mut pictures = Vec::new();
        for time in output.pictures.iter().flatten() {
            pictures.push(of.read(time, Kind::TIME)?);
        }
        if output.pictures.is_none() {
            pictures = vec![0.0, stop];
        }
        let label = |kind: Option<Kind>| kind.map_or("", |kind| label(kind, built.scene.units));
        let units: Vec<(&'static str, &'static str)> =
            probes.columns().into_iter().map(|(name, kind)| (leak(name), label(kind))).collect();
        let [speed, time] =
            [Kind::VELOCITY, Kind::TIME].map(|kind| self::label(kind, built.scene.units));
        let numbers = built.scene.bodies.iter().map(|body| {
            (leak(format!("{}.speed", body.name)), leak(format!("speed of {}, {speed}", body.name)))
        });
        let ended = (leak("ended_at".to_owned()), leak(format!("end, {time}")));
        let numbers: Vec<_> = numbers.chain([ended]).collect();
        Ok(Self {
            id: leak(said),
            units: Vec::leak(units),
            numbers: Vec::leak(numbers),
            every,
            pictures,
            probes,
            built,
        })
    }

    /// Runs a state to the end of the scene, with a look at its probes as often as a run has one; whether it came there within
    /// this time on the clock.
    ///
    /// # Errors
    /// A numerical failure.
    pub fn follow(
        &self,
        mut simulation: Simulation,
        stop: f64,
        patience: Duration,
    ) -> Result<bool, StepError> {
        let start = Instant::now();
        let found = self.probes.find(&simulation);
        for time in self.times(stop) {
            while simulation.time() < time {
                if start.elapsed() > patience {
                    return Ok(false);
                }
                simulation.step(time)?;
            }
            let row = self.probes.row(&found, (&simulation, &simulation.balance()));
            if row.last() == Some(&1.0) {
                break;
            }
        }
        Ok(true)
    }

    /// What was read.
    #[must_use]
    pub fn built(&self) -> &Built {
        &self.built
    }

    /// Times at which something is looked at or drawn, in order, the end included.
    fn times(&self, stop: f64) -> Vec<f64> {
        let entries = (stop / self.every).ceil().min(1e6) as u64;
        let looks = (0..=entries).map(|k| (k as f64 * self.every).min(stop));
        let mut all: Vec<f64> =
            looks.chain(self.pictures.iter().copied().filter(|t| *t <= stop)).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// Sections that are drawn, by what they add to the name of a picture: none, and one.
    fn sections(&self) -> [(&'static str, Option<Axis>); 2] {
        [("", None), ("-section", Some(self.built.file.output.section.unwrap_or(Axis::Y)))]
    }

    /// How a state is drawn.
    fn shot(&self, simulation: &Simulation, scene: &Scene, section: Option<Axis>) -> Shot {
        let shown = match self.built.file.output.colour.unwrap_or(Colour::Body) {
            Colour::Body => Shown::Body,
            Colour::Temperature => Shown::Temperature(None),
            Colour::PlasticStrain => Shown::PlasticStrain(None),
        };
        let (mut camera, section) = match section {
            None => (aside(scene), None),
            Some(axis) => (onto(axis, scene), Some(across(axis, simulation.sizes(0).1))),
        };
        camera.frame = (simulation.time() > 0.0).then(|| frame(simulation, OUTSIDE));
        Shot { title: scene.name.clone(), camera, section, shown, loose: true }
    }

    /// Takes the pictures of the present time, under this name.
    fn draw(
        &self,
        driver: &mut SpaceDriver<'_>,
        scene: &Scene,
        name: &str,
    ) -> Result<(), RunError> {
        for (end, section) in self.sections() {
            driver.photograph(&format!("{name}{end}"), "", |simulation| {
                shoot(simulation, scene, &self.shot(simulation, scene, section))
            })?;
        }
        Ok(())
    }

    /// How many times a run draws [`FileCase::preview`].
    #[must_use]
    pub fn pictures(&self) -> usize {
        self.pictures.len()
    }

    /// Pictures of a state by their names, for light and for dark pages.
    ///
    /// # Errors
    /// A picture that cannot be painted.
    pub fn preview(
        &self,
        simulation: &Simulation,
        scene: &Scene,
    ) -> Result<Vec<Drawn>, PaintError> {
        let drawn = self.sections().map(|(end, section)| {
            let shot = self.shot(simulation, scene, section);
            Ok((format!("start{end}"), shoot(simulation, scene, &shot)?))
        });
        drawn.into_iter().collect()
    }
}

/// A time in the name of a file: six digits after the point at most.
fn short(time: f64) -> String {
    let text = format!("{time:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A text for as long as the program runs.
fn leak(text: String) -> &'static str {
    String::leak(text)
}

/// Unit of what is measured, in results.
fn label(kind: Kind, units: Units) -> &'static str {
    let dimension = match kind {
        Kind::TIME => Dimension::Time,
        Kind::LENGTH => Dimension::Length,
        Kind::VELOCITY => Dimension::Velocity,
        Kind::DENSITY => Dimension::Density,
        Kind::PRESSURE => Dimension::Pressure,
        Kind::TEMPERATURE => Dimension::Temperature,
        // Of the system, as the ledger has them.
        _ => return "",
    };
    units.label(dimension)
}

/// Direction of flight of the first body that moves; the third axis where none does.
fn flight(scene: &Scene) -> [f64; 3] {
    let moving = scene.bodies.iter().map(|body| body.velocity).find(|v| *v != [0.0; 3]);
    let v = moving.unwrap_or([0.0, 0.0, 1.0]);
    let speed = v.iter().map(|v| v * v).sum::<f64>().sqrt();
    v.map(|v| v / speed)
}

/// Looks at what flies from before and from the side; it flies upwards.
fn aside(scene: &Scene) -> Camera {
    let up = flight(scene);
    // Two directions across the flight, the first as near to an axis as may be.
    let least = (0..3).min_by(|&a, &b| up[a].abs().total_cmp(&up[b].abs())).unwrap_or(0);
    let mut first = [0.0; 3];
    first[least] = 1.0;
    let along = up[least];
    let first: [f64; 3] = std::array::from_fn(|d| first[d] - along * up[d]);
    let second = whipple_solver::space::lattice::cross(up, first);
    let of = |[a, b, c]: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|d| a * first[d] + b * up[d] + c * second[d])
    };
    Camera::new(of([0.28, 0.42, -1.0]), of([-0.1, 1.0, 0.3]))
}

/// Looks straight at a plane across an axis, with the flight upwards where that is possible.
fn onto(axis: Axis, scene: &Scene) -> Camera {
    let mut direction = [0.0; 3];
    direction[axis.index()] = -1.0;
    let mut up = flight(scene);
    up[axis.index()] = 0.0;
    if up.iter().map(|u| u * u).sum::<f64>() < 1e-6 {
        up = [0.0; 3];
        up[(axis.index() + 1) % 3] = 1.0;
    }
    Camera::new(direction, up)
}

/// The plane through the origin across an axis, but for a quarter of a cell: a section along faces of elements would be
/// ragged.
fn across(axis: Axis, cell: [f64; 3]) -> Plane {
    let edge = cell.into_iter().fold(f64::INFINITY, f64::min);
    let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
    point[axis.index()] = 0.25 * edge;
    normal[axis.index()] = 1.0;
    Plane { point, normal }
}

/// A plane across an axis, as options name it: `y=0`, `z=2 mm`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Section {
    axis: Axis,
    place: String,
}

impl FromStr for Section {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted =
            || format!("`{text}` is no plane: wanted an axis and a place, such as y=0 or 'z=2 mm'");
        let (axis, place) = text.split_once('=').ok_or_else(wanted)?;
        let axis = match axis.trim() {
            "x" => Axis::X,
            "y" => Axis::Y,
            "z" => Axis::Z,
            _ => return Err(wanted()),
        };
        Ok(Self { axis, place: place.trim().to_owned() })
    }
}

impl Section {
    /// In names of files: what is no letter, digit, point or sign becomes a line.
    #[must_use]
    pub fn label(&self) -> String {
        let axis = ["x", "y", "z"][self.axis.index()];
        let plain = |c: char| if c.is_ascii_alphanumeric() || "+-.".contains(c) { c } else { '_' };
        format!("{axis}{}", self.place.chars().map(plain).collect::<String>())
    }
}

/// How a state is drawn that no scene file tells of: all of it, or cut at a plane, whose place is a number with a
/// unit, or a plain one in the units of the scene.
///
/// # Errors
/// A place that is no length.
pub fn state_shot(
    simulation: &Simulation,
    scene: &Scene,
    section: Option<&Section>,
    shown: Shown,
) -> Result<Shot, String> {
    let (mut camera, section) = match section {
        None => (aside(scene), None),
        Some(Section { axis, place }) => {
            let mut plane = across(*axis, simulation.sizes(0).1);
            let value = match place.parse::<f64>() {
                Ok(value) if value.is_finite() => value,
                _ => read(place, Kind::LENGTH, scene.units)?,
            };
            plane.point[axis.index()] += value;
            (onto(*axis, scene), Some(plane))
        }
    };
    camera.frame = Some(frame(simulation, OUTSIDE));
    Ok(Shot { title: scene.name.clone(), camera, section, shown, loose: true })
}

/// A scene with the method of a preset and what the file changes of it.
fn changed(built: &Built, preset: Preset, mut scene: Scene) -> Result<Scene, String> {
    scene.method = preset.space();
    let set: Vec<String> =
        built.file.method.set.iter().map(|(key, value)| format!("{key}={value}")).collect();
    match overrides::apply(scene.into(), &set) {
        Ok(AnyScene::Space(scene)) => Ok(scene),
        Ok(AnyScene::Line(_)) => Err("a scene along a line".into()),
        Err(error) => Err(error.to_string()),
    }
}

impl Case for FileCase {
    fn id(&self) -> &'static str {
        self.id
    }

    fn title(&self) -> &'static str {
        self.id
    }

    fn about(&self) -> &'static str {
        self.id
    }

    fn source(&self) -> &'static str {
        self.id
    }

    fn default_size(&self) -> usize {
        self.built.through
    }

    fn scene(&self, preset: Preset, _: &str, n: usize) -> AnyScene {
        let finer = (n != self.built.through && n > 0)
            .then(|| Built::of(&self.built.path, &self.built.text, Some(n)).ok())
            .flatten();
        let built = finer.as_ref().unwrap_or(&self.built);
        // That it can be changed so was seen when the file was read.
        let plain = built.scene.clone();
        changed(built, preset, plain.clone()).unwrap_or(plain).into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        _: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let columns = self.probes.columns();
        let mut history: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
        let mut last = f64::NAN;
        let found = self.probes.find(driver.solver());
        for time in self.times(scene.stop_time) {
            driver.advance_to(time)?;
            let row = driver.look(|solver, balance| self.probes.row(&found, (solver, balance)))?;
            for (column, value) in history.iter_mut().zip(&row) {
                column.push(*value);
            }
            let ended = row.last() == Some(&1.0);
            if ended || self.pictures.contains(&time) {
                let name = if time == 0.0 { "start".into() } else { format!("at-{}", short(time)) };
                self.draw(driver, scene, &name)?;
            }
            last = time;
            if ended {
                break;
            }
        }
        let mut findings = Findings::default();
        if last < scene.stop_time {
            findings.enter("ended_at", last);
        }
        self.summary(scene, &columns, &history, &mut findings);
        let columns = columns.into_iter().map(|(name, _)| name).zip(history);
        // The condition is told once, by the time.
        let columns = columns.filter(|(name, _)| name != "end").collect();
        findings.history = Some(Series(columns));
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        self.units
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }

    fn runs(&self, _: Level) -> Vec<RunKey> {
        Vec::new()
    }

    fn claims(&self) -> Vec<Claim> {
        Vec::new()
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        self.numbers
    }

    fn figures(&self, _: &Records) -> Vec<Figure> {
        Vec::new()
    }
}

/// End of the names of what is over the range of a material's constants.
pub const OVER: &str = "_over_its_range";

impl FileCase {
    /// The numbers at the end: of every body its speed and what of it is whole; of every material how far it left the range of
    /// its constants.
    fn summary(
        &self,
        scene: &Scene,
        columns: &[(String, Option<Kind>)],
        history: &[Vec<f64>],
        findings: &mut Findings,
    ) {
        let column = |name: &str| {
            let k = columns.iter().position(|(column, _)| column == name);
            k.map_or(&[][..], |k| &history[k])
        };
        let end = |name: &str| column(name).last().copied().unwrap_or(f64::NAN);
        for body in &scene.bodies {
            let name = &body.name;
            let speed = ["vx", "vy", "vz"].map(|axis| end(&format!("{name}.{axis}")));
            findings
                .enter(&format!("{name}.speed"), speed.iter().map(|v| v * v).sum::<f64>().sqrt());
            let whole = column(&format!("{name}.sound_mass"));
            let part =
                end(&format!("{name}.sound_mass")) / whole.first().copied().unwrap_or(f64::NAN);
            findings.enter(&format!("{name}.sound_part"), part);
        }
        for (material, range) in scene.materials.iter().zip(&self.built.ranges) {
            for (what, name, limit) in [
                ("pressure", "highest_pressure", range.pressure),
                ("temperature", "highest_sound_temperature", range.temperature),
            ] {
                let highest = column(&format!("{}.{name}", material.name));
                let most = highest.iter().copied().fold(0.0, f64::max);
                if most > limit {
                    findings.enter(&format!("{}.{what}{OVER}", material.name), most / limit);
                }
            }
        }
    }
}
