//! What cases in space share: metals, walls, bodies, averages over planes, initial motions.

pub(super) mod cloud;
pub(super) mod column;
pub(super) mod control;
pub(super) mod discs;
pub(super) mod fit;
pub(super) mod hole;
pub(super) mod impact;
pub(super) mod metals;
pub(super) mod modes;
pub(super) mod motion;
pub(super) mod perforation;
pub(super) mod photos;
pub(super) mod pieces;
pub(super) mod planes;
pub(super) mod schemes;
pub(super) mod shapes;
pub(super) mod shells;
pub(super) mod studies;
pub(super) mod supports;

use std::collections::BTreeMap;

use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::ledger::Balance;
use whipple_solver::space::method::Method;
use whipple_solver::space::scene::{
    Body, EosData, Failure, Hold, Material, Scene, Shape, Side, Turn, Wall,
};
use whipple_solver::units::Units;

use crate::plots::Point;
use crate::record::Series;
use crate::run::{RunError, SpaceDriver};

/// A plane of symmetry.
pub(super) fn mirror(axis: usize, position: f64, material: Side) -> Wall {
    Wall { axis, position, material, hold: Hold::Mirror }
}

/// Mirrors that hold a column along x at `-width/2` and `width/2` in y and z.
pub(super) fn sleeve(width: f64) -> Vec<Wall> {
    let sides = [(-0.5 * width, Side::Above), (0.5 * width, Side::Below)];
    let both = |axis| sides.map(|(position, side)| mirror(axis, position, side));
    (1..3).flat_map(both).collect()
}

/// A body at rest, named like its material.
pub(super) fn resting(material: &str, shape: Shape, cells: [usize; 3], centre: [f64; 3]) -> Body {
    Body {
        name: material.into(),
        material: material.into(),
        shape,
        cells,
        centre,
        turn: Turn::default(),
        velocity: [0.0; 3],
        spin: [0.0; 3],
        energy: 0.0,
        noise: 0.0,
        mapping: None,
    }
}

/// An ideal gas of density 1: none of its elements fails, however far it is compressed.
pub(super) fn gas(adiabatic_index: f64, c_v: f64) -> Material {
    Material {
        name: "gas".into(),
        density: 1.0,
        eos: EosData::IdealGas { adiabatic_index, c_v },
        strength: None,
        failure: Failure { compression: 0.0, ..Failure::default() },
    }
}

/// The choices of a preset for gas: its pyramids have the stiffness of the gas against being denser than
/// their cell (decision 0017).
pub(super) fn zonal(preset: Preset) -> Method {
    Method { hourglass: 1.0, ..preset.space() }
}

/// A body of an ideal gas, given by its adiabatic index and specific heat, in no units.
pub(super) fn gas_scene(
    name: &str,
    stop_time: f64,
    method: Method,
    walls: Vec<Wall>,
    [adiabatic_index, c_v]: [f64; 2],
    body: Body,
) -> Scene {
    Scene {
        name: name.into(),
        units: Units::None,
        stop_time,
        method,
        walls,
        materials: vec![gas(adiabatic_index, c_v)],
        bodies: vec![body],
    }
}

/// Kilojoules of a Mbar cm^3.
const KILOJOULES: f64 = 100.0;

/// Energies of a balance in g, cm, us as kJ: kinetic, internal, of shear, of tension, and the residual of
/// the elements.
pub(super) fn kilojoules(balance: &Balance) -> [f64; 5] {
    let now = &balance.now;
    [now.kinetic, now.internal, now.shear, now.tension, balance.residual()].map(|e| KILOJOULES * e)
}

/// Mean and root mean square about it.
pub(super) fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n).sqrt())
}

/// Where a curve falls below a level for the last time, between its points.
pub(super) fn last_fall(curve: impl Iterator<Item = Point>, level: f64) -> Option<f64> {
    let points: Vec<Point> = curve.collect();
    let (a, b) =
        points.windows(2).map(|w| (w[0], w[1])).rfind(|(a, b)| a.1 >= level && b.1 < level)?;
    let share = (a.1 - level) / (a.1 - b.1);
    Some(a.0 + share * (b.0 - a.0))
}

/// Equally spaced times from 0 to the end of a run.
pub(super) fn times(stop: f64, entries: usize) -> impl Iterator<Item = f64> {
    (0..=entries).map(move |k| stop * k as f64 / entries as f64)
}

/// Equally spaced times over the second half of a run.
pub(super) fn late_times(stop: f64, entries: usize) -> impl Iterator<Item = f64> {
    (0..=entries).map(move |k| stop * (0.5 + 0.5 * k as f64 / entries as f64))
}

/// What is read off the states at some times, one column a name.
pub(super) fn history<const N: usize>(
    driver: &mut SpaceDriver<'_>,
    times: impl Iterator<Item = f64>,
    names: [&str; N],
    read: impl Fn(&Simulation, &Balance) -> [f64; N],
) -> Result<Columns, RunError> {
    let mut history = Columns::default();
    for time in times {
        driver.advance_to(time)?;
        let now = driver.look(|solver, balance| read(solver, balance).into())?;
        history.read(&names, &now);
    }
    Ok(history)
}

/// Columns of a history or profile that grow row by row.
#[derive(Default)]
pub(super) struct Columns(BTreeMap<String, Vec<f64>>);

impl Columns {
    /// Adds a row.
    pub(super) fn row<const N: usize>(&mut self, entries: [(&str, f64); N]) {
        for (name, value) in entries {
            self.0.entry(name.into()).or_default().push(value);
        }
    }

    /// Adds a row of what was read off a state, one number a name.
    pub(super) fn read(&mut self, names: &[&str], values: &[f64]) {
        debug_assert_eq!(names.len(), values.len());
        for (name, value) in names.iter().zip(values) {
            self.0.entry((*name).into()).or_default().push(*value);
        }
    }

    /// A column so far.
    pub(super) fn column(&self, name: &str) -> &[f64] {
        self.0.get(name).map_or(&[], Vec::as_slice)
    }

    /// All of them.
    pub(super) fn series(self) -> Series {
        Series(self.0)
    }
}
