//! What a run in three dimensions leaves in its folder while it goes on: the ledger, frames and
//! checkpoints. Nothing here moves a bit of the run: a frame shows the first state at or after its
//! time.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use whipple_solver::space::{Scene, Simulation};

use super::checkpoint::{self, Halted};
use super::frames::Frames;
use super::history::{History, HistoryError};
use super::measured::Measured;
use crate::checkpoint::CheckpointError;
use crate::files::{FileError, ensure_writable_dir};
use crate::vtk::{CollectionError, VtkError};

/// File of the ledger in the folder of a run.
pub const LEDGER: &str = "ledger.csv";
/// Folder of the frames, and their index in it.
pub const FRAMES: [&str; 2] = ["vtu", "run.pvd"];
/// Time between two writings of the ledger: the whole of it is written each time.
const PATIENCE: Duration = Duration::from_secs(5);

/// Output that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// A file or folder.
    #[error(transparent)]
    File(#[from] FileError),
    /// The earlier ledger cannot be continued.
    #[error(transparent)]
    History(#[from] HistoryError),
    /// The earlier index of the frames cannot be continued.
    #[error(transparent)]
    Collection(#[from] CollectionError),
    /// A frame.
    #[error(transparent)]
    Frame(#[from] VtkError),
    /// A checkpoint.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// Writes what a run leaves in its folder.
#[derive(Debug)]
pub struct Recorder {
    folder: PathBuf,
    scene: Scene,
    /// The command that makes the run.
    command: String,
    ledger: History,
    saved: Option<Instant>,
    film: Option<Film>,
    /// Time on the clock between two checkpoints of a run that goes on, and when the last was due.
    keeping: Option<(Duration, Instant)>,
    /// The last state that was seen.
    good: Option<Simulation>,
}

/// Frames, and when the next one is due.
#[derive(Debug)]
struct Film {
    frames: Frames,
    every: f64,
    due: f64,
}

impl Recorder {
    /// What is left in `folder`, which must be there, with a frame every so often. A run that goes on
    /// from a state continues the ledger and the frames that the folder has of it.
    ///
    /// # Errors
    /// [`OutputError`] if the earlier ledger or index is not one of this scene.
    pub fn new(
        folder: &Path,
        scene: &Scene,
        every: Option<f64>,
        from: Option<&Halted>,
    ) -> Result<Self, OutputError> {
        let time = from.map(|halted| halted.simulation.time());
        let path = folder.join(LEDGER);
        let ledger = match time {
            Some(time) if path.exists() => History::resume(&path, scene, time)?,
            _ => History::new(&path, scene),
        };
        let film = every.map(|every| Film::new(folder, every, time)).transpose()?;
        Ok(Self {
            folder: folder.to_owned(),
            scene: scene.clone(),
            command: String::new(),
            ledger,
            saved: None,
            film,
            keeping: None,
            good: None,
        })
    }

    /// Takes over the ledger of a run, up to a time, from the folder in which it was made.
    ///
    /// # Errors
    /// If there is none of this scene that comes so far; this run's own ledger is then as it was.
    pub fn take_ledger(&mut self, folder: &Path, time: f64) -> Result<(), HistoryError> {
        let earlier = History::resume(&folder.join(LEDGER), &self.scene, time)?;
        self.ledger = earlier.at(&self.folder.join(LEDGER));
        Ok(())
    }

    /// Says in checkpoints which command makes the run.
    #[must_use]
    pub fn of(self, command: &str) -> Self {
        Self { command: command.to_owned(), ..self }
    }

    /// Wants a checkpoint this often on the clock, beside the one at the end.
    #[must_use]
    pub fn keeping(self, every: Duration) -> Self {
        Self { keeping: Some((every, Instant::now())), ..self }
    }

    /// Whether it is time for a checkpoint; the next is then due so much later.
    pub fn is_time_to_keep(&mut self) -> bool {
        match &mut self.keeping {
            Some((every, last)) if last.elapsed() >= *every => {
                *last = Instant::now();
                true
            }
            _ => false,
        }
    }

    /// Time at which the next frame is due.
    #[must_use]
    pub fn due(&self) -> f64 {
        self.film.as_ref().map_or(f64::INFINITY, |film| film.due)
    }

    /// Takes down the present state.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn follow(&mut self, simulation: &Simulation) -> Result<(), OutputError> {
        self.ledger.record(simulation);
        if let Some(film) = &mut self.film {
            film.follow(simulation)?;
        }
        self.good = Some(simulation.clone());
        if self.saved.is_none_or(|at| at.elapsed() > PATIENCE) {
            self.ledger.save()?;
            self.saved = Some(Instant::now());
        }
        Ok(())
    }

    /// Brings the ledger to the disk.
    ///
    /// # Errors
    /// What the file system says.
    pub fn close(&self) -> Result<(), OutputError> {
        Ok(self.ledger.save()?)
    }

    /// Writes the present state as a checkpoint, and the ledger so far: a run that goes on from the one
    /// continues the other.
    ///
    /// # Errors
    /// What the file system says.
    pub fn keep(
        &self,
        simulation: &Simulation,
        measured: &Measured,
    ) -> Result<PathBuf, OutputError> {
        self.ledger.save()?;
        Ok(checkpoint::save(&self.folder, (&self.scene, &self.command), simulation, measured)?)
    }

    /// Writes the last state that was seen as a checkpoint, after a failure.
    ///
    /// # Errors
    /// What the file system says.
    pub fn keep_last_good(&self, measured: &Measured) -> Result<Option<PathBuf>, OutputError> {
        let Some(simulation) = &self.good else { return Ok(None) };
        let mut measured = measured.clone();
        measured.forget_after(simulation.time());
        self.keep(simulation, &measured).map(Some)
    }
}

impl Film {
    fn new(folder: &Path, every: f64, from: Option<f64>) -> Result<Self, OutputError> {
        let [sub, index] = FRAMES;
        let folder = folder.join(sub);
        ensure_writable_dir(&folder)?;
        let path = folder.join(index);
        Ok(match from {
            // Frames of the checkpoint's own time were written before it.
            Some(time) if path.exists() => Self {
                frames: Frames::resume(&path, time.next_up())?,
                every,
                due: after(time, every),
            },
            _ => Self { frames: Frames::new(&path)?, every, due: 0.0 },
        })
    }

    fn follow(&mut self, simulation: &Simulation) -> Result<(), OutputError> {
        let time = simulation.time();
        if time >= self.due {
            self.frames.record(simulation)?;
            self.due = after(time, self.every);
        }
        Ok(())
    }
}

/// The first multiple of `every` after `time`.
fn after(time: f64, every: f64) -> f64 {
    // The quotient may have been rounded up or down to a whole number.
    let whole = (time / every).floor();
    let next = [whole, whole + 1.0].map(|k| k * every).into_iter().find(|next| *next > time);
    next.unwrap_or((whole + 2.0) * every)
}

#[cfg(test)]
mod tests {
    use super::after;

    #[test]
    fn frames_are_due_at_every_multiple() {
        for every in [0.1, 0.3, 1.7, 5.0] {
            for k in 0..1000 {
                let (due, next) = (f64::from(k) * every, f64::from(k + 1) * every);
                assert_eq!(after(due, every), next, "{k} {every}");
                assert_eq!(after(next.next_down(), every), next, "{k} {every}");
            }
        }
    }
}
