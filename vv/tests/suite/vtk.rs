//! One state as VTU: what is written is read back, and what cannot be written is refused.

#![allow(clippy::unwrap_used)]

use std::io::{self, Write};

use proptest::prelude::*;
use whipple_vv::vtk::{Cells, Field, Grid, GridError, Values, Vertices, VtkError, write_vtu};

use crate::vtk_reader::Document;

const CUBE: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];
const ELEMENT: [[u32; 8]; 1] = [[0, 1, 2, 3, 4, 5, 6, 7]];

fn bare<'a>(points: &'a [[f64; 3]], cells: Cells<'a>) -> Grid<'a> {
    Grid { points, cells, point_data: Vec::new(), cell_data: Vec::new() }
}

fn written(grid: &Grid<'_>, time: f64) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_vtu(&mut bytes, grid, time).unwrap();
    bytes
}

fn refusal(grid: &Grid<'_>) -> String {
    let mut bytes = Vec::new();
    let error = write_vtu(&mut bytes, grid, 0.0).unwrap_err();
    assert!(bytes.is_empty(), "bytes before the refusal");
    error.to_string()
}

#[test]
fn particles_and_elements_share_one_file() {
    let strain =
        [f64::NAN, f64::NAN, f64::NAN, f64::NAN, f64::NAN, f64::NAN, f64::NAN, f64::NAN, 0.5];
    let grid = Grid {
        cell_data: vec![Field::scalar("strain", Values::Float64(&strain))],
        ..bare(&CUBE, Cells::hybrid(&ELEMENT))
    };
    let read = Document::read(&written(&grid, 2.5e-6));
    assert_eq!((read.points, read.cells), (8, 9));
    assert_eq!(read.cells("types"), [1, 1, 1, 1, 1, 1, 1, 1, 12]);
    assert_eq!(read.cells("offsets"), [1, 2, 3, 4, 5, 6, 7, 8, 16]);
    assert_eq!(read.cells("connectivity"), [0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7]);
    let time = read.array("FieldData", "TimeValue");
    assert_eq!((time.kind.as_str(), time.values(f64::from_le_bytes)), ("Float64", vec![2.5e-6]));
    let back = read.array("CellData", "strain").values(f64::from_le_bytes);
    assert!(back.iter().zip(strain).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert_eq!(read.array("Points", "Points").values(f64::from_le_bytes), CUBE.as_flattened());
}

#[test]
fn chosen_vertices_come_before_elements() {
    let cells = Cells { vertices: Vertices::Of(&[6, 2]), hexahedra: &ELEMENT };
    let read = Document::read(&written(&bare(&CUBE, cells), 0.0));
    assert_eq!(read.cells("types"), [1, 1, 12]);
    assert_eq!(read.cells("offsets"), [1, 2, 10]);
    assert_eq!(read.cells("connectivity"), [6, 2, 0, 1, 2, 3, 4, 5, 6, 7]);
    let read = Document::read(&written(&bare(&CUBE, Cells::elements(&ELEMENT)), 0.0));
    assert_eq!((read.cells("types"), read.cells("offsets")), (vec![12], vec![8]));
}

#[test]
fn every_type_is_written_as_itself() {
    let (flags, ids, labels) = ([0, 255], [0, u32::MAX], [i32::MIN, 7]);
    let values = [1.0 / 3.0, f64::INFINITY];
    let fields = [
        ("Float64", Values::Float64(&values)),
        ("Float32", Values::Float32(&values)),
        ("UInt8", Values::UInt8(&flags)),
        ("UInt32", Values::UInt32(&ids)),
        ("Int32", Values::Int32(&labels)),
    ];
    let point_data = fields.map(|(name, values)| Field::scalar(name, values)).to_vec();
    let grid = Grid { point_data, ..bare(&CUBE[..2], Cells::particles()) };
    let read = Document::read(&written(&grid, 0.0));
    for (name, _) in fields {
        assert_eq!(read.array("PointData", name).kind, name);
    }
    let field = |name: &str| read.array("PointData", name);
    assert_eq!(field("Float64").values(f64::from_le_bytes), values);
    assert_eq!(field("Float32").values(f32::from_le_bytes), [1.0 / 3.0, f32::INFINITY]);
    assert_eq!(field("UInt8").bytes, flags);
    assert_eq!(field("UInt32").values(u32::from_le_bytes), ids);
    assert_eq!(field("Int32").values(i32::from_le_bytes), labels);
}

#[test]
fn names_survive_xml() {
    let name = "σ<\"a\" & b>&amp;";
    let grid = Grid {
        point_data: vec![Field::new(name, 3, Values::Float64(CUBE.as_flattened()))],
        ..bare(&CUBE, Cells::particles())
    };
    let read = Document::read(&written(&grid, 0.0));
    assert_eq!(read.array("PointData", name).components, 3);
}

#[test]
fn a_state_without_points_is_a_file() {
    let grid = Grid {
        point_data: vec![Field::scalar("mass", Values::Float64(&[]))],
        ..bare(&[], Cells::hybrid(&[]))
    };
    let read = Document::read(&written(&grid, 0.0));
    assert_eq!((read.points, read.cells), (0, 0));
    assert!(read.array("PointData", "mass").bytes.is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(32) })]

    /// Sizes on both sides of the block size, where the table of blocks changes form.
    #[test]
    fn arrays_of_any_length_come_back(extra in -3_i64..3, blocks in 0_i64..3, seed: u64) {
        let count = (blocks * (1 << 15) + extra).max(0) as usize;
        let value = |k: usize| f64::from_bits(seed.wrapping_mul(2 * k as u64 + 1));
        let values: Vec<f64> = (0..count).map(value).collect();
        let points = vec![[0.0; 3]; count];
        let grid = Grid {
            point_data: vec![Field::scalar("noise", Values::Float64(&values))],
            ..bare(&points, Cells::particles())
        };
        let bytes = written(&grid, 1.0);
        prop_assert_eq!(&bytes, &written(&grid.clone(), 1.0), "not the same bytes");
        let read = Document::read(&bytes);
        let back = read.array("PointData", "noise").values(u64::from_le_bytes);
        prop_assert!(back.iter().eq(values.iter().map(|v| v.to_bits()).collect::<Vec<_>>().iter()));
        prop_assert_eq!(read.cells("offsets").len(), count);
    }
}

#[test]
fn what_does_not_fit_is_refused_with_its_place() {
    let mut points = CUBE;
    points[3][1] = f64::NAN;
    let wanted = "coordinate y of point 3 is NaN, wanted a finite number";
    assert_eq!(refusal(&bare(&points, Cells::particles())), wanted);
    let seven = bare(&CUBE[..7], Cells::elements(&ELEMENT));
    let wanted = "hexahedron 0 uses point 7, wanted less than 7, the number of points";
    assert_eq!(refusal(&seven), wanted);
    let outside = Cells { vertices: Vertices::Of(&[0, 8]), hexahedra: &[] };
    let wanted = "vertex 1 uses point 8, wanted less than 8, the number of points";
    assert_eq!(refusal(&bare(&CUBE, outside)), wanted);
    let with = |field| Grid { point_data: vec![field], ..bare(&CUBE, Cells::hybrid(&ELEMENT)) };
    let values = [0.0; 8];
    let short = with(Field::new("v", 3, Values::Float64(&values)));
    let wanted = "point field `v` has 8 values, wanted 3 for each of the 8 points";
    assert_eq!(refusal(&short), wanted);
    let cells = Grid { point_data: Vec::new(), cell_data: short.point_data.clone(), ..short };
    let wanted = "cell field `v` has 8 values, wanted 3 for each of the 9 cells";
    assert_eq!(refusal(&cells), wanted);
    let none = with(Field::new("v", 0, Values::Float64(&[])));
    assert_eq!(refusal(&none), "point field `v` has 0 components, wanted at least 1");
    let wide = with(Field::new("v", usize::MAX, Values::Float64(&values)));
    assert!(refusal(&wide).starts_with("point field `v` has 8 values"));
    for name in ["", "a\nb", "a\u{0}"] {
        let unnamed = with(Field::scalar(name, Values::Float64(&values)));
        assert!(refusal(&unnamed).starts_with("field name"));
    }
    let field = Field::scalar("v", Values::Float64(&values));
    let twice = Grid { point_data: vec![field, field], ..bare(&CUBE, Cells::particles()) };
    assert_eq!(refusal(&twice), "point field `v` is given twice, wanted each name once");
    let large = [0.0, 0.0, -1e300, 0.0, 0.0, 0.0, 0.0, 0.0];
    let large = with(Field::scalar("v", Values::Float32(&large)));
    assert_eq!(refusal(&large), "point field `v` holds -1e300 at index 2, too large for Float32");
}

#[test]
fn time_must_be_finite() {
    let error = write_vtu(&mut io::sink(), &bare(&CUBE, Cells::particles()), f64::NAN).unwrap_err();
    assert!(matches!(error, VtkError::Grid(GridError::Time(time)) if time.is_nan()));
}

#[test]
fn a_failing_stream_is_reported() {
    struct Full;
    impl Write for Full {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::StorageFull.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let error = write_vtu(&mut Full, &bare(&CUBE, Cells::particles()), 0.0).unwrap_err();
    assert!(matches!(error, VtkError::Stream(_)), "{error}");
}

#[test]
fn smooth_states_are_small() {
    let points: Vec<[f64; 3]> =
        (0..20_000_u32).map(|i| [i % 100, i / 100 % 20, i / 2000].map(f64::from)).collect();
    let heat: Vec<f64> = (0..20_000).map(|i| 300.0 + f64::from(i).sqrt()).collect();
    let size = |values| {
        let point_data = vec![Field::scalar("temperature", values)];
        written(&Grid { point_data, ..bare(&points, Cells::particles()) }, 0.0).len()
    };
    // 24 + 8 bytes of state and 17 bytes of cells for each particle.
    assert!(size(Values::Float64(&heat)) < 20_000 * 49 / 3);
    assert!(size(Values::Float32(&heat)) < size(Values::Float64(&heat)));
}
