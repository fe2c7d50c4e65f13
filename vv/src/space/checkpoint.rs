//! Checkpoints of a run in three dimensions: it continues from them bit for bit.

use std::path::{Path, PathBuf};

use whipple_solver::error::SceneError;
use whipple_solver::space::restart::{RestartError, Values};
use whipple_solver::space::{Scene, Simulation};

use super::measured::Measured;
use crate::checkpoint::{CheckpointError, Meta, Reader, Writer, save_next};

/// Why a run does not continue.
#[derive(Debug, thiserror::Error)]
pub enum ResumeError {
    /// The file is damaged, of another scene, or of another form.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The file is whole, but no run has this state.
    #[error(transparent)]
    State(#[from] RestartError),
    /// The run looked at other times than this one does.
    #[error("section `measured.times`: {found}, wanted {wanted}")]
    Looks {
        /// What stands there.
        found: String,
        /// What should stand there.
        wanted: String,
    },
    /// The scene itself is not valid.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// Hash of a scene: BLAKE3 of its JSON, in hexadecimal. The time at which the run ends is left out,
/// because a state does not depend on it: a finished run may go on for longer.
#[must_use]
pub fn scene_hash(scene: &Scene) -> String {
    let endless = Scene { stop_time: 1.0, ..scene.clone() };
    // A scene is plain data: JSON can carry all of it.
    let json = serde_json::to_vec(&endless).unwrap_or_default();
    blake3::hash(&json).to_hex().to_string()
}

/// A run as it is left: its state, and what its case has found so far.
#[derive(Debug)]
pub struct Halted {
    /// The state.
    pub simulation: Simulation,
    /// What the case has found.
    pub measured: Measured,
}

/// Section of the command that makes the run, for messages; files of earlier programs have none.
const COMMAND: &str = "run.command";

/// A run as a checkpoint, to be written: its scene and the command that makes it, its state, and what
/// its case has found.
///
/// # Errors
/// [`CheckpointError::Header`] if its time is not finite.
pub fn pack(
    (scene, command): (&Scene, &str),
    simulation: &Simulation,
    measured: &Measured,
) -> Result<Writer, CheckpointError> {
    let mut writer = Writer::new(Meta {
        program: concat!("whipple ", env!("CARGO_PKG_VERSION")).to_owned(),
        scene: scene_hash(scene),
        step: simulation.counters().steps,
        time: simulation.time(),
    });
    for section in simulation.sections() {
        let name = &section.name;
        match &section.values {
            Values::F64(values) => writer.section(name, values)?,
            Values::U64(values) => writer.section(name, values)?,
            Values::U32(values) => writer.section(name, values)?,
            Values::U8(values) => writer.section(name, values)?,
        }
    }
    writer.bytes(COMMAND, command.as_bytes())?;
    measured.write(&mut writer)?;
    Ok(writer)
}

/// Writes a run to `folder`, in which the last two checkpoints are kept.
///
/// # Errors
/// As [`save_next`]; the earlier checkpoints are then still there.
pub fn save(
    folder: &Path,
    of: (&Scene, &str),
    simulation: &Simulation,
    measured: &Measured,
) -> Result<PathBuf, CheckpointError> {
    save_next(folder, &pack(of, simulation, measured)?)
}

/// The run of a scene as it was when the checkpoint `path` was written.
///
/// # Errors
/// [`ResumeError`], with the section that is damaged or does not fit.
pub fn load(path: &Path, scene: &Scene) -> Result<Halted, ResumeError> {
    unpack(Reader::open(path, &scene_hash(scene))?, scene)
}

/// The command that makes the run of a checkpoint, if it says so.
///
/// # Errors
/// [`CheckpointError`] if the section is there and is not what is written.
pub fn command_in(reader: &mut Reader) -> Result<Option<String>, CheckpointError> {
    if !reader.sections().iter().any(|section| section.name == COMMAND) {
        return Ok(None);
    }
    let text = String::from_utf8_lossy(&reader.bytes(COMMAND)?).into_owned();
    Ok(Some(text).filter(|text| !text.is_empty()))
}

/// The run of a scene from an opened checkpoint of it.
///
/// # Errors
/// As [`load`].
pub fn unpack(mut reader: Reader, scene: &Scene) -> Result<Halted, ResumeError> {
    let mut simulation = Simulation::new(scene)?;
    // A new run has the same sections, of the same types and lengths.
    let mut sections = simulation.sections();
    for section in &mut sections {
        let name = &section.name;
        match &mut section.values {
            Values::F64(values) => *values = reader.array(name, &[values.len()])?,
            Values::U64(values) => *values = reader.array(name, &[values.len()])?,
            Values::U32(values) => *values = reader.array(name, &[values.len()])?,
            Values::U8(values) => *values = reader.array(name, &[values.len()])?,
        }
    }
    command_in(&mut reader)?;
    let measured = Measured::read(&mut reader)?;
    reader.finish()?;
    simulation.restore(&sections)?;
    Ok(Halted { simulation, measured })
}
