//! Writes a sample collection and the table that `read_vtu.py` checks it against:
//! 100 000 particles, of which 49 011 are also the nodes of 45 000 hexahedra, in two frames.
//!
//! `cargo run --release -p whipple-vv --example vtk_sample -- FOLDER`

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use whipple_vv::files::{ensure_writable_dir, write_atomic};
use whipple_vv::vtk::{Cells, Collection, Field, Grid, Values};

/// Elements along each edge of the block.
const EDGES: [usize; 3] = [30, 30, 50];
const PARTICLES: usize = 100_000;
const SPACING: f64 = 1.0e-4;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("wanted the folder to write to")?;
    let folder = Path::new(&folder);
    ensure_writable_dir(folder)?;
    let mut collection = Collection::new(&folder.join("sample.pvd"))?;
    let mut table = "time,part,kind,name,count,minimum,maximum,total\n".to_owned();
    let hexahedra = block();
    for time in [0.0, 2.0e-5] {
        let points: Vec<[f64; 3]> = (0..PARTICLES).map(|i| position(i, time)).collect();
        let speed: Vec<f64> = points.iter().map(|x| 2.0e3 * (x[2] / SPACING).sin()).collect();
        let velocity: Vec<f64> = speed.iter().flat_map(|&v| [0.0, 0.1 * v, v]).collect();
        let mass: Vec<f64> = (0..PARTICLES).map(|i| 2.7e-9 * (1.0 + 1.0e-3 * wave(i))).collect();
        let material: Vec<u8> = (0..PARTICLES).map(|i| u8::from(i >= nodes())).collect();
        let identity: Vec<u32> = (0..PARTICLES as u32).collect();
        let strain: Vec<f64> = (0..hexahedra.len()).map(|k| time * 1.0e4 * wave(k)).collect();
        // Cells come as vertices, then hexahedra; a particle has no plastic strain.
        let all_strain = [vec![f64::NAN; PARTICLES], strain.clone()].concat();
        let particle_data = vec![
            Field::scalar("mass", Values::Float64(&mass)),
            Field::new("velocity", 3, Values::Float32(&velocity)),
            Field::scalar("material", Values::UInt8(&material)),
            Field::scalar("identity", Values::UInt32(&identity)),
        ];
        let grid =
            |cells, cell_data, point_data| Grid { points: &points, cells, point_data, cell_data };
        let strains = |values| vec![Field::scalar("plastic strain", Values::Float64(values))];
        let parts = [
            ("particles", grid(Cells::particles(), Vec::new(), particle_data.clone())),
            ("elements", grid(Cells::elements(&hexahedra), strains(&strain), Vec::new())),
            ("hybrid", grid(Cells::hybrid(&hexahedra), strains(&all_strain), particle_data)),
        ];
        for (part, grid) in parts {
            collection.record(time, part, &grid)?;
            let place = format!("{time:?},{part}");
            let (vertices, elements) = (grid.vertex_count(), grid.cells.hexahedra.len());
            writeln!(table, "{place},cells,vertices,{vertices},,,")?;
            writeln!(table, "{place},cells,hexahedra,{elements},,,")?;
            for field in &grid.point_data {
                writeln!(table, "{place},point,{}", summary(field, grid.points.len()))?;
            }
            for field in &grid.cell_data {
                writeln!(table, "{place},cell,{}", summary(field, grid.cell_count()))?;
            }
        }
    }
    write_atomic(&folder.join("sample.csv"), table.as_bytes())?;
    Ok(())
}

/// Number of nodes of the block.
fn nodes() -> usize {
    EDGES.iter().map(|n| n + 1).product()
}

/// A repeatable value between -1 and 1.
fn wave(i: usize) -> f64 {
    (12.9898 * i as f64).sin()
}

/// Place of particle `i`: the nodes of the block first, then a cloud below it.
fn position(i: usize, time: f64) -> [f64; 3] {
    let (nx, ny) = (EDGES[0] + 1, EDGES[1] + 1);
    if i < nodes() {
        let node = [i % nx, i / nx % ny, i / (nx * ny)];
        return node.map(|k| k as f64 * SPACING);
    }
    let spread = 1.0 + 1.0e4 * time;
    [0.3, 0.7, 1.1].map(|a| 20.0 * SPACING * spread * (a * i as f64).sin() - 5.0e-3)
}

/// The hexahedra of the block.
fn block() -> Vec<[u32; 8]> {
    let (nx, ny) = (EDGES[0] + 1, EDGES[1] + 1);
    let node = |i: usize, j: usize, k: usize| ((k * ny + j) * nx + i) as u32;
    let mut elements = Vec::with_capacity(EDGES.iter().product());
    for k in 0..EDGES[2] {
        for j in 0..EDGES[1] {
            for i in 0..EDGES[0] {
                let floor = |k| [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k)];
                let ([a, b, c], [e, f, g]) = (floor(k), floor(k + 1));
                elements.push([a, b, c, node(i, j + 1, k), e, f, g, node(i, j + 1, k + 1)]);
            }
        }
    }
    elements
}

/// Name, entries, smallest and largest value and sum of a field, leaving out undefined values.
fn summary(field: &Field<'_>, entries: usize) -> String {
    let values: Vec<f64> = match field.values {
        Values::Float64(v) => v.to_vec(),
        Values::Float32(v) => v.iter().map(|&x| f64::from(x as f32)).collect(),
        Values::UInt8(v) => v.iter().map(|&x| x.into()).collect(),
        Values::UInt32(v) => v.iter().map(|&x| x.into()).collect(),
        Values::Int32(v) => v.iter().map(|&x| x.into()).collect(),
    };
    let defined = || values.iter().copied().filter(|x| !x.is_nan());
    let least = defined().fold(f64::INFINITY, f64::min);
    let most = defined().fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = defined().sum();
    format!("{},{entries},{least:?},{most:?},{total:?}", field.name)
}
