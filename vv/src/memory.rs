//! Memory that a run will need, estimated before anything is allocated, and what the machine has.
//!
//! Bytes per particle were measured on the resident memory of runs: Noh with 10⁶ particles along a line
//! (234 to 276 with the three densities), and the long rod at 9 and 15 cells in three dimensions. They
//! are rounded up, since contacts of debris come later.

use std::fs;

use whipple_solver::method::Density;
use whipple_solver::space::Scene;
use whipple_solver::space::scene::Body;

use crate::scene::AnyScene;

/// Bytes per particle along a line.
const LINE: u64 = 300;

/// Bytes per particle of a checkpoint in the making, in three dimensions.
const CHECKPOINT: u64 = 600;

/// What a run keeps of its state in three dimensions, beside the one that moves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Keeps {
    /// The last good state and checkpoints, for a run with a folder.
    pub folder: bool,
    /// The state that it goes on from.
    pub resumed: bool,
}

/// What a run will need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Need {
    /// Particles, to a few per cent.
    pub particles: u64,
    /// Bytes of memory, to some ten per cent.
    pub bytes: u64,
}

impl Need {
    /// What the run of a scene will need.
    #[must_use]
    pub fn of(scene: &AnyScene, keeps: Keeps) -> Self {
        let (particles, each) = match scene {
            AnyScene::Line(scene) => (scene.particles() as u64, LINE),
            AnyScene::Space(scene) => (particles(scene), bytes_in_space(scene, keeps)),
        };
        Self { particles, bytes: particles.saturating_mul(each) }
    }
}

fn bytes_in_space(scene: &Scene, keeps: Keeps) -> u64 {
    let state = match scene.method.density {
        Density::Hybrid => 500,
        Density::Nonholonomic => 1500,
        Density::Kernel => 3350,
    };
    let copies = 1 + u64::from(keeps.folder) + u64::from(keeps.resumed);
    state * copies + CHECKPOINT * u64::from(keeps.folder)
}

/// Particles of a scene in three dimensions: nodes and centroids of the cells within the shapes.
fn particles(scene: &Scene) -> u64 {
    scene.bodies.iter().map(in_body).fold(0, u64::saturating_add)
}

fn in_body(body: &Body) -> u64 {
    let filled = body.shape.volume() / body.shape.extent().iter().product::<f64>();
    let [nodes, cells] =
        [1, 0].map(|more| body.cells.map(|n| (n + more) as f64).iter().product::<f64>());
    (filled * (nodes + cells)) as u64
}

/// Bytes that the machine has for new work, where it says so: `MemAvailable` of Linux.
#[must_use]
pub fn available() -> Option<u64> {
    available_of(&fs::read_to_string("/proc/meminfo").ok()?)
}

/// Most bytes that this program has had so far, where the machine says so: `VmHWM` of Linux.
#[must_use]
pub fn peak() -> Option<u64> {
    kilobytes(&fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

fn available_of(meminfo: &str) -> Option<u64> {
    kilobytes(meminfo, "MemAvailable:")
}

/// Bytes of an entry that is stated in kibibytes.
fn kilobytes(text: &str, entry: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(entry))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim_end().parse().ok()?;
    kibibytes.checked_mul(1024)
}

/// What is to be said of a need before a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fit {
    /// Nothing.
    Well,
    /// It takes more than half of what there is.
    Tightly,
    /// It does not fit.
    Not,
}

/// Whether a need fits; well, where nothing is known of the machine.
#[must_use]
pub fn fit(need: Need, available: Option<u64>) -> Fit {
    match available {
        Some(room) if need.bytes > room => Fit::Not,
        Some(room) if need.bytes > room / 2 => Fit::Tightly,
        _ => Fit::Well,
    }
}

/// Bytes in words: `840 MB`, `1.2 GB`.
#[must_use]
pub fn bytes_text(bytes: u64) -> String {
    let bytes = bytes as f64;
    if bytes < 1e6 {
        "less than 1 MB".into()
    } else if bytes < 999.5e6 {
        format!("{:.0} MB", bytes / 1e6)
    } else {
        format!("{:.1} GB", bytes / 1e9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use whipple_solver::method::Preset;
    use whipple_solver::space::Simulation;

    fn scene(case: &str, variant: &str, n: usize) -> AnyScene {
        crate::cases::find(case).expect("a case").scene(Preset::Default, variant, n)
    }

    /// The estimate knows the particles of real scenes, and covers the memory of their solvers.
    #[test]
    fn estimates_hold_for_real_scenes() {
        for (case, variant, n) in [
            ("long-rod", "", 5),
            ("taylor-copper", "", 8),
            ("sedov", "", 16),
            ("noh-space", "spherical", 16),
            ("planar-impact", "", 80),
        ] {
            let scene = scene(case, variant, n);
            let solver = Simulation::new(scene.space().expect("in space")).expect("a valid scene");
            let need = Need::of(&scene, Keeps::default());
            let error = need.particles as f64 / solver.particles() as f64 - 1.0;
            assert!(error.abs() < 0.1, "{case}: {need:?}, {}", solver.particles());
            assert!(
                need.bytes as f64 > 0.9 * solver.bytes() as f64,
                "{case}: {need:?}, {}",
                solver.bytes()
            );
        }
        assert_eq!(Need::of(&scene("noh", "", 1000), Keeps::default()).particles, 1000);
    }

    #[test]
    fn what_a_run_keeps_costs_memory() {
        let scene = scene("long-rod", "", 5);
        let bytes = |folder, resumed| Need::of(&scene, Keeps { folder, resumed }).bytes;
        assert!(bytes(true, false) > 2 * bytes(false, false));
        assert!(bytes(true, true) > bytes(true, false));
        let mut kernel = scene.clone();
        kernel.set_density(Density::Kernel);
        assert!(Need::of(&kernel, Keeps::default()).bytes > 6 * bytes(false, false));
    }

    #[test]
    fn needs_are_held_against_what_there_is() {
        let need = Need { particles: 1, bytes: 1000 };
        for (room, wanted) in [
            (Some(999), Fit::Not),
            (Some(1000), Fit::Tightly),
            (Some(1999), Fit::Tightly),
            (Some(2000), Fit::Well),
            (None, Fit::Well),
        ] {
            assert_eq!(fit(need, room), wanted, "{room:?}");
        }
        // More than can be counted is more than there is.
        let endless = Need { particles: u64::MAX, bytes: u64::MAX };
        assert_eq!(fit(endless, Some(u64::MAX - 1)), Fit::Not);
    }

    #[test]
    fn memory_is_read_as_linux_writes_it() {
        let text =
            "MemTotal:       24676548 kB\nMemFree:         1 kB\nMemAvailable:   22000000 kB\n";
        assert_eq!(available_of(text), Some(22_000_000 * 1024));
        for text in ["", "MemFree: 1 kB", "MemAvailable: much kB", "MemAvailable: 5 MB"] {
            assert_eq!(available_of(text), None, "{text}");
        }
        let words = [10, 840_000_000, 999_900_000, 12_340_000_000].map(bytes_text);
        assert_eq!(words, ["less than 1 MB", "840 MB", "1.0 GB", "12.3 GB"]);
    }
}
