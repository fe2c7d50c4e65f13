//! Where a run broke, and the likely cause: read off the state just before, near the particle that the
//! failure names.

use std::path::{Path, PathBuf};

use whipple_solver::error::{SceneError, StepError};
use whipple_solver::space::output::{Element, Particle};
use whipple_solver::space::{Scene, Simulation};
use whipple_solver::units::Dimension;

use super::frames::Frames;
use super::recorder::OutputError;

/// Folder of the drawn neighbourhood in that of the run, and its index.
pub const FAILURE: [&str; 2] = ["failure", "near.pvd"];

/// Steps from the last good state within which the failure is looked for: a state is kept every sixteen.
const STEPS: usize = 64;

/// Reach of the neighbourhood over the longest edge of a cell.
const REACH: f64 = 4.0;

/// Volume of an element, over that at the start, below which it is said to be pressed flat.
const PRESSED: f64 = 0.3;

/// Distance of two particles of different bodies, or of loose ones, over the contact length, below which they
/// overlap.
const OVERLAP: f64 = 0.5;

/// Speed over that of the fastest other particle, beyond which it is out of all proportion.
const FAST: f64 = 10.0;

/// Densities over the reference density beyond which an equation of state is far from what it was fitted to.
const FITTED: [f64; 2] = [0.5, 2.0];

/// What was found near the particle of a failure.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// The state just before the failing step.
    before: Simulation,
    particle: Particle,
    body: String,
    units: [&'static str; 2],
    /// What is unusual there, the likeliest cause first.
    causes: Vec<String>,
    reach: f64,
}

impl Diagnosis {
    /// Goes on from the last good state of a run to the step that breaks it, and looks round the particle that the
    /// failure names.
    ///
    /// # Errors
    /// A scene that is refused.
    pub fn new(
        scene: &Scene,
        good: &Simulation,
        error: &StepError,
    ) -> Result<Option<Self>, SceneError> {
        let before = before(good, scene.stop_time);
        let Some(id) = particle_of(error).filter(|id| before.all_particles().any(|p| p.id == *id))
        else {
            return Ok(None);
        };
        let particle = before.particle(id);
        let rest = Simulation::new(scene)?;
        let edges = |body: usize| before.sizes(body).1.into_iter().fold(0.0, f64::max);
        let longest = (0..before.bodies()).map(edges).fold(0.0, f64::max);
        let mut causes = Vec::new();
        causes.extend(too_fast(&before, &particle));
        causes.extend(pressed(&before, &rest, id));
        causes.extend(overlap(&before, &particle));
        causes.extend(beyond_fit(scene, &particle));
        if let StepError::TimeStep { limiter, .. } = error {
            causes.push(format!("the time step, which {limiter} limits"));
        }
        Ok(Some(Self {
            body: scene.bodies[particle.body].name.clone(),
            units: [Dimension::Length, Dimension::Velocity].map(|of| scene.units.label(of)),
            reach: REACH * longest,
            before,
            particle,
            causes,
        }))
    }

    /// In words: where the particle was, how it moved, and the likely cause.
    #[must_use]
    pub fn text(&self) -> String {
        let vector = |v: [f64; 3], unit: &str| {
            let text = v.map(|x| format!("{x:.4e}")).join(", ");
            format!("({text}) {unit}").trim_end().to_owned()
        };
        let Particle { id, position, velocity, .. } = self.particle;
        let at = vector(position, self.units[0]);
        let moving = vector(velocity, self.units[1]);
        let cause = match self.causes.as_slice() {
            [] => "nothing unusual beside it: a speed, energy or density that no number holds"
                .to_owned(),
            causes => causes.join("; "),
        };
        format!(
            "before that step particle {id}, of `{}`, was at {at} with velocity {moving}; likely cause: {cause}",
            self.body
        )
    }

    /// Draws particles and elements near the particle, just before the failing step, into the folder of the run;
    /// the index is named.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn draw(&self, out: &Path) -> Result<PathBuf, OutputError> {
        let [sub, index] = FAILURE;
        let folder = out.join(sub);
        crate::files::ensure_writable_dir(&folder)?;
        let path = folder.join(index);
        let middle = self.particle.position;
        let near = |p: &Particle| {
            square(p.position, middle) <= self.reach * self.reach || p.id == self.particle.id
        };
        Frames::new(&path)?.record_some(&self.before, near)?;
        Ok(path)
    }
}

/// The state before the step that fails; the last good one, if none does.
fn before(good: &Simulation, stop: f64) -> Simulation {
    let mut state = good.clone();
    for _ in 0..STEPS {
        let mut next = state.clone();
        if next.step(stop).is_err() {
            return state;
        }
        state = next;
    }
    good.clone()
}

/// The particle that a failure names.
fn particle_of(error: &StepError) -> Option<u32> {
    let (StepError::NotFinite { particle, .. }
    | StepError::Density { particle, .. }
    | StepError::Energy { particle, .. }
    | StepError::Crossed { particle, .. }
    | StepError::TimeStep { particle, .. }
    | StepError::Neighbours { particle, .. }) = error;
    u32::try_from(*particle).ok()
}

/// Whether a particle is far faster than all others.
fn too_fast(now: &Simulation, particle: &Particle) -> Option<String> {
    let speed = |p: &Particle| p.velocity.into_iter().fold(0.0, f64::hypot);
    let others = now.all_particles().filter(|p| p.id != particle.id);
    let ratio = speed(particle) / others.map(|p| speed(&p)).fold(0.0, f64::max);
    (ratio > FAST).then(|| format!("it is {ratio:.1e} times as fast as any other particle"))
}

/// The live element of a particle that is pressed most, if it is pressed flat or turned inside out.
fn pressed(now: &Simulation, rest: &Simulation, id: u32) -> Option<String> {
    let own =
        |element: &Element| element.live && (element.centre == id || element.corners.contains(&id));
    let ratio = |element: &Element| volume(now, element) / volume(rest, element);
    let least =
        now.all_elements().filter(own).map(|element| ratio(&element)).min_by(f64::total_cmp)?;
    if least <= 0.0 {
        return Some(format!("an element of it is turned inside out, at {least:.2} of its volume"));
    }
    (least < PRESSED).then(|| format!("an element of it is pressed to {least:.2} of its volume"))
}

/// The particle that overlaps it most, if one does that no element holds with it.
fn overlap(now: &Simulation, particle: &Particle) -> Option<String> {
    let mates: Vec<u32> = now
        .all_elements()
        .filter(|e| e.live && (e.centre == particle.id || e.corners.contains(&particle.id)))
        .flat_map(|e| e.corners.into_iter().chain([e.centre]))
        .collect();
    let size = |body: usize| now.sizes(body).0;
    let share = |other: &Particle| {
        let length = 0.5 * (size(particle.body) + size(other.body));
        square(other.position, particle.position).sqrt() / length
    };
    let others = now.all_particles().filter(|p| p.id != particle.id && !mates.contains(&p.id));
    let nearest = others.map(|other| (share(&other), other.id)).min_by(|a, b| a.0.total_cmp(&b.0));
    let (share, id) = nearest.filter(|(share, _)| *share < OVERLAP)?;
    Some(format!("particle {id} has come to {share:.2} of the contact length"))
}

/// Whether the density is far from what the equation of state was fitted to.
fn beyond_fit(scene: &Scene, particle: &Particle) -> Option<String> {
    let material = &scene.materials[scene.material_index(&scene.bodies[particle.body].material)?];
    let ratio = particle.rho / material.density;
    let [least, most] = FITTED;
    (!(least..=most).contains(&ratio)).then(|| {
        format!("its density is {ratio:.2} of that of `{}`, far from where its equation of state was fitted", material.name)
    })
}

/// Volume of an element between its corners: six tetrahedra round a diagonal.
fn volume(simulation: &Simulation, element: &Element) -> f64 {
    let at = element.corners.map(|id| simulation.particle(id).position);
    let edge = |k: usize| -> [f64; 3] { std::array::from_fn(|d| at[k][d] - at[0][d]) };
    let far = edge(7);
    [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]]
        .map(|[a, b]| {
            let (u, v) = (edge(a), edge(b));
            let cross =
                [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            (0..3).map(|d| cross[d] * far[d]).sum::<f64>() / 6.0
        })
        .iter()
        .sum()
}

/// Square of the distance of two points.
fn square(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|d| (a[d] - b[d]).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::find;
    use crate::scene::AnyScene;
    use whipple_solver::method::Preset;
    use whipple_solver::space::restart::Values;

    fn scene() -> Scene {
        let case = find("planar-impact").expect("the case");
        let AnyScene::Space(scene) = case.scene(Preset::Default, "w-steel-1", 16) else {
            panic!("in space");
        };
        scene
    }

    /// The scene with a particle moved, or pushed.
    fn with(scene: &Scene, id: u32, changes: &[(&str, f64)]) -> Simulation {
        let mut simulation = Simulation::new(scene).expect("a scene");
        let mut sections = simulation.sections();
        for section in &mut sections {
            let by = changes.iter().find(|(column, _)| section.name == *column);
            if let (Values::F64(values), Some((_, by))) = (&mut section.values, by) {
                values[id as usize] += by;
            }
        }
        simulation.restore(&sections).expect("its own sections");
        simulation
    }

    fn told(scene: &Scene, state: &Simulation, id: u32) -> String {
        let error = StepError::TimeStep {
            particle: id as usize,
            time: 0.0,
            value: 1e-12,
            floor: 1e-9,
            limiter: "sound",
        };
        Diagnosis::new(scene, state, &error).expect("a scene").expect("a particle").text()
    }

    #[test]
    fn causes_are_told_apart() {
        let scene = scene();
        let state = Simulation::new(&scene).expect("a scene");
        let element = state.all_elements().next().expect("an element");
        let [low, high] = [element.corners[0], element.corners[7]];
        let edge = state.sizes(element.body).1[0];
        let whole: f64 = state.sizes(element.body).1.iter().product();
        assert!((volume(&state, &element) / whole - 1.0).abs() < 1e-12);

        let quiet = told(&scene, &state, low);
        assert!(quiet.ends_with("likely cause: the time step, which sound limits"), "{quiet}");
        let body = &scene.bodies[element.body].name;
        assert!(
            quiet.starts_with(&format!("before that step particle {low}, of `{body}`, was at (")),
            "{quiet}"
        );

        let inverted = told(&scene, &with(&scene, low, &[("state.dx", 4.0 * edge)]), low);
        assert!(
            inverted.contains("likely cause: an element of it is turned inside out"),
            "{inverted}"
        );
        let fast = told(&scene, &with(&scene, high, &[("state.vx", 1e4)]), high);
        assert!(
            fast.contains("likely cause: it is ") && fast.contains(" times as fast as"),
            "{fast}"
        );
        let other = state.all_particles().find(|p| p.body != element.body).expect("two bodies");
        let [here, there] = [low, other.id].map(|id| state.particle(id).position);
        let by = |d: usize| here[d] + 0.1 * edge - there[d];
        let meeting = [("state.dx", by(0)), ("state.dy", by(1)), ("state.dz", by(2))];
        let near = told(&scene, &with(&scene, other.id, &meeting), low);
        let name = format!("likely cause: particle {} has come to 0.", other.id);
        assert!(near.contains(&name), "{near}");
    }

    #[test]
    fn what_is_near_is_drawn() {
        let scene = scene();
        let state = Simulation::new(&scene).expect("a scene");
        let error = StepError::NotFinite { quantity: "x", particle: 0, time: 0.0, value: f64::NAN };
        let found = Diagnosis::new(&scene, &state, &error).expect("a scene").expect("a particle");
        let folder = tempfile::tempdir().expect("a folder");
        let index = found.draw(folder.path()).expect("files");
        let text = std::fs::read_to_string(&index).expect("an index");
        assert!(
            text.contains("near-particles-000000.vtu") && text.contains("near-elements-000000.vtu")
        );
        let read = std::fs::metadata(folder.path().join("failure/near-particles-000000.vtu"));
        assert!(read.expect("a file").len() > 100);
        let none =
            StepError::NotFinite { quantity: "x", particle: 1 << 30, time: 0.0, value: f64::NAN };
        assert!(Diagnosis::new(&scene, &state, &none).expect("a scene").is_none());
    }
}
