//! What cases in space share: metals, walls, bodies, averages over planes, initial motions.

pub(super) mod column;
pub(super) mod control;
pub(super) mod discs;
pub(super) mod fit;
pub(super) mod metals;
pub(super) mod modes;
pub(super) mod motion;
pub(super) mod planes;
pub(super) mod shells;

use std::collections::BTreeMap;

use whipple_solver::space::Simulation;
use whipple_solver::space::ledger::Balance;
use whipple_solver::space::scene::{
    Body, EosData, Failure, Hold, Material, Shape, Side, Turn, Wall,
};

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

/// Mean and root mean square about it.
pub(super) fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n).sqrt())
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
