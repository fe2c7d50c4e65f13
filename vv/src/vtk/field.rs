//! Named values at points or cells.

use std::io::{self, Write};

use super::blocks::write_blocks;
use super::error::GridError;
use crate::xml::is_plain;

/// Values of a field and the type they are written as.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Values<'a> {
    /// Double precision, bit for bit.
    Float64(&'a [f64]),
    /// Rounded to single precision: half the size, enough for pictures.
    Float32(&'a [f64]),
    /// Flags and small labels.
    UInt8(&'a [u8]),
    /// Identities and counts.
    UInt32(&'a [u32]),
    /// Signed labels.
    Int32(&'a [i32]),
}

/// A field over the points or the cells of a grid.
///
/// Not-a-number is allowed and means "not defined here", such as a strain on a particle; readers
/// leave such entries out of colour ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field<'a> {
    /// Name, as the viewer shows it.
    pub name: &'a str,
    /// Values an entry: 1 for scalars, 3 for vectors, 6 for symmetric tensors (`ParaView` reads them
    /// as XX, YY, ZZ, XY, YZ, XZ), 9 for others.
    pub components: usize,
    /// The values, those of one entry side by side.
    pub values: Values<'a>,
}

impl<'a> Field<'a> {
    /// Field of `components` values an entry.
    #[must_use]
    pub const fn new(name: &'a str, components: usize, values: Values<'a>) -> Self {
        Self { name, components, values }
    }

    /// Field of one value an entry.
    #[must_use]
    pub const fn scalar(name: &'a str, values: Values<'a>) -> Self {
        Self::new(name, 1, values)
    }

    /// Refuses what cannot be a field over `entries` points or cells (`place` says which).
    pub(super) fn check(&self, place: &'static str, entries: usize) -> Result<(), GridError> {
        if !is_plain(self.name) {
            return Err(GridError::FieldName(self.name.to_owned()));
        }
        let name = || self.name.to_owned();
        if self.components == 0 {
            return Err(GridError::NoComponents { place, name: name() });
        }
        let found = self.values.len();
        if entries.checked_mul(self.components) != Some(found) {
            let components = self.components;
            return Err(GridError::Length { place, name: name(), found, components, entries });
        }
        match self.values.too_large() {
            Some((index, value)) => Err(GridError::TooLarge { place, name: name(), index, value }),
            None => Ok(()),
        }
    }
}

impl Values<'_> {
    /// Number of values.
    const fn len(&self) -> usize {
        match self {
            Self::Float64(v) | Self::Float32(v) => v.len(),
            Self::UInt8(v) => v.len(),
            Self::UInt32(v) => v.len(),
            Self::Int32(v) => v.len(),
        }
    }

    /// First finite value that single precision cannot hold.
    fn too_large(&self) -> Option<(usize, f64)> {
        let Self::Float32(values) = self else { return None };
        let lost = |v: f64| v.is_finite() && !(v as f32).is_finite();
        values.iter().position(|&v| lost(v)).map(|index| (index, values[index]))
    }

    /// Name of the type in the file.
    pub(super) const fn type_name(&self) -> &'static str {
        match self {
            Self::Float64(_) => "Float64",
            Self::Float32(_) => "Float32",
            Self::UInt8(_) => "UInt8",
            Self::UInt32(_) => "UInt32",
            Self::Int32(_) => "Int32",
        }
    }

    /// Writes the values as compressed text.
    pub(super) fn write(&self, out: &mut impl Write) -> io::Result<()> {
        match self {
            Self::Float64(v) => write_blocks(out, v.iter().map(|x| x.to_le_bytes())),
            Self::Float32(v) => write_blocks(out, v.iter().map(|&x| (x as f32).to_le_bytes())),
            Self::UInt8(v) => write_blocks(out, v.iter().map(|x| x.to_le_bytes())),
            Self::UInt32(v) => write_blocks(out, v.iter().map(|x| x.to_le_bytes())),
            Self::Int32(v) => write_blocks(out, v.iter().map(|x| x.to_le_bytes())),
        }
    }
}
