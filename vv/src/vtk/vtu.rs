//! One state as VTU: an XML unstructured grid.

use std::io::{self, Write};
use std::path::Path;

use super::blocks::write_blocks;
use super::error::{GridError, VtkError};
use super::field::{Field, Values};
use super::grid::{Grid, Vertices};
use crate::files::write_atomic;
use crate::xml::escape;

/// Cell types of VTK.
const VERTEX: u8 = 1;
const HEXAHEDRON: u8 = 12;

/// Writes `grid` at `time` to a stream. `out` gets many small pieces: buffer it if they are dear.
///
/// # Errors
/// [`VtkError::Grid`] before the first byte if the grid is refused, [`VtkError::Stream`] if the
/// stream fails.
pub fn write_vtu(out: &mut impl Write, grid: &Grid<'_>, time: f64) -> Result<(), VtkError> {
    if !time.is_finite() {
        return Err(GridError::Time(time).into());
    }
    grid.check()?;
    Ok(write_checked(out, grid, time)?)
}

/// Writes `grid` at `time` to a file, which is replaced as a whole or not at all.
///
/// # Errors
/// [`VtkError::Grid`] if the grid is refused, [`VtkError::File`] if the file cannot be replaced.
pub fn save_vtu(path: &Path, grid: &Grid<'_>, time: f64) -> Result<(), VtkError> {
    let mut bytes = Vec::new();
    write_vtu(&mut bytes, grid, time)?;
    Ok(write_atomic(path, &bytes)?)
}

/// The document of a grid that has passed its check.
fn write_checked(out: &mut impl Write, grid: &Grid<'_>, time: f64) -> io::Result<()> {
    out.write_all(b"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n")?;
    out.write_all(b"<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"")?;
    out.write_all(b" byte_order=\"LittleEndian\" header_type=\"UInt64\"")?;
    out.write_all(b" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<FieldData>\n")?;
    let tuples = Some(1);
    array(out, "Float64", "TimeValue", 1, tuples, |out| Values::Float64(&[time]).write(out))?;
    out.write_all(b"</FieldData>\n")?;
    let (points, cells) = (grid.points.len(), grid.cell_count());
    writeln!(out, "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">")?;
    fields(out, "PointData", &grid.point_data)?;
    fields(out, "CellData", &grid.cell_data)?;
    out.write_all(b"<Points>\n")?;
    let positions = Values::Float64(grid.points.as_flattened());
    array(out, "Float64", "Points", 3, None, |out| positions.write(out))?;
    out.write_all(b"</Points>\n<Cells>\n")?;
    write_cells(out, grid)?;
    out.write_all(b"</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")
}

/// The element `kind` with its fields.
fn fields(out: &mut impl Write, kind: &str, fields: &[Field<'_>]) -> io::Result<()> {
    writeln!(out, "<{kind}>")?;
    for field in fields {
        let (name, values) = (field.name, field.values);
        let write = |out: &mut _| values.write(out);
        array(out, values.type_name(), name, field.components, None, write)?;
    }
    writeln!(out, "</{kind}>")
}

/// Points of the cells, where each cell ends among them, and what each cell is. Indices have the
/// width that VTK uses inside, so that it need not convert them.
fn write_cells(out: &mut impl Write, grid: &Grid<'_>) -> io::Result<()> {
    let singles = grid.vertex_count();
    let elements = grid.cells.hexahedra;
    let nodes = elements.as_flattened();
    let node = |k: usize| -> i64 {
        match k.checked_sub(singles) {
            Some(k) => nodes[k].into(),
            None => match grid.cells.vertices {
                Vertices::Of(points) => points[k].into(),
                Vertices::None | Vertices::All => k as i64,
            },
        }
    };
    let end = |cell: usize| match (cell + 1).checked_sub(singles) {
        Some(elements) => (singles + 8 * elements) as i64,
        None => (cell + 1) as i64,
    };
    let kind = |cell: usize| [if cell < singles { VERTEX } else { HEXAHEDRON }];
    let uses = singles + nodes.len();
    let cells = grid.cell_count();
    array(out, "Int64", "connectivity", 1, None, |out| {
        write_blocks(out, (0..uses).map(|k| node(k).to_le_bytes()))
    })?;
    array(out, "Int64", "offsets", 1, None, |out| {
        write_blocks(out, (0..cells).map(|cell| end(cell).to_le_bytes()))
    })?;
    array(out, "UInt8", "types", 1, None, |out| write_blocks(out, (0..cells).map(kind)))
}

/// One array; `tuples` is given where the reader cannot know it from the piece.
fn array<W: Write>(
    out: &mut W,
    kind: &str,
    name: &str,
    components: usize,
    tuples: Option<usize>,
    values: impl FnOnce(&mut W) -> io::Result<()>,
) -> io::Result<()> {
    let name = escape(name);
    write!(out, "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"")?;
    if let Some(tuples) = tuples {
        write!(out, " NumberOfTuples=\"{tuples}\"")?;
    }
    out.write_all(b" format=\"binary\">")?;
    values(out)?;
    out.write_all(b"</DataArray>\n")
}
