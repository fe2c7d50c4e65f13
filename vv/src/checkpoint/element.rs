//! The values that a section can hold.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Type of the values of a section, as the header names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ElementType {
    /// Double precision.
    F64,
    /// Unsigned, 8 bits.
    U8,
    /// Unsigned, 16 bits.
    U16,
    /// Unsigned, 32 bits.
    U32,
    /// Unsigned, 64 bits.
    U64,
    /// Signed, 16 bits.
    I16,
    /// Signed, 32 bits.
    I32,
    /// Bytes of a form and length that only their owner knows.
    Bytes,
}

impl ElementType {
    /// Bytes of one value.
    #[must_use]
    pub const fn size(self) -> usize {
        match self {
            Self::U8 | Self::Bytes => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 => 4,
            Self::F64 | Self::U64 => 8,
        }
    }
}

impl fmt::Display for ElementType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::F64 => "f64",
            Self::U8 => "u8",
            Self::U16 => "u16",
            Self::U32 => "u32",
            Self::U64 => "u64",
            Self::I16 => "i16",
            Self::I32 => "i32",
            Self::Bytes => "bytes",
        })
    }
}

mod sealed {
    /// A value with a little-endian form; the list of types is part of the file format.
    pub trait LittleEndian: Copy {
        /// An array as long as the value.
        type Bytes: AsRef<[u8]> + AsMut<[u8]> + Default;
        /// The bytes of the value, bit for bit.
        fn to_bytes(self) -> Self::Bytes;
        /// The value of the bytes, bit for bit.
        fn from_bytes(bytes: Self::Bytes) -> Self;
    }
}

pub(super) use sealed::LittleEndian;

/// A type whose arrays can be sections.
pub trait Element: LittleEndian {
    /// Its name in the header.
    const TYPE: ElementType;
}

macro_rules! elements {
    ($($value:ty: $name:ident),*) => {$(
        impl LittleEndian for $value {
            type Bytes = [u8; size_of::<$value>()];
            fn to_bytes(self) -> Self::Bytes {
                self.to_le_bytes()
            }
            fn from_bytes(bytes: Self::Bytes) -> Self {
                Self::from_le_bytes(bytes)
            }
        }
        impl Element for $value {
            const TYPE: ElementType = ElementType::$name;
        }
    )*};
}

elements!(f64: F64, u8: U8, u16: U16, u32: U32, u64: U64, i16: I16, i32: I32);
