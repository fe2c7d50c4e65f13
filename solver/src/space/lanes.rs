//! Eight numbers side by side: the unit of all inner loops in three dimensions.
//!
//! Plain arrays and plain operators. The compiler turns them into the widest vectors of the function
//! that they are inlined into (see [`crate::space::dispatch`]); no multiplication is ever fused with
//! an addition, so that every processor gives the same bits.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Lanes of an [`F8`].
pub const LANES: usize = 8;

/// Eight numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct F8(pub [f64; LANES]);

/// Eight truth values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct M8(pub [bool; LANES]);

impl Default for F8 {
    fn default() -> Self {
        Self::ZERO
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for F8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let mut out = [0.0; LANES];
                for k in 0..LANES {
                    out[k] = self.0[k] $op other.0[k];
                }
                Self(out)
            }
        }
        impl $trait<f64> for F8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                let mut out = [0.0; LANES];
                for k in 0..LANES {
                    out[k] = self.0[k] $op other;
                }
                Self(out)
            }
        }
        impl $trait<F8> for f64 {
            type Output = F8;
            #[inline(always)]
            fn $method(self, other: F8) -> F8 {
                let mut out = [0.0; LANES];
                for k in 0..LANES {
                    out[k] = self $op other.0[k];
                }
                F8(out)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl AddAssign for F8 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for F8 {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for F8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut out = [0.0; LANES];
        for k in 0..LANES {
            out[k] = -self.0[k];
        }
        Self(out)
    }
}

impl F8 {
    /// Eight zeros.
    pub const ZERO: Self = Self([0.0; LANES]);

    /// Eight times the same number.
    #[inline(always)]
    #[must_use]
    pub fn splat(x: f64) -> Self {
        Self([x; LANES])
    }

    /// The numbers from `at` on.
    ///
    /// # Panics
    /// Where fewer than eight are left.
    #[inline(always)]
    #[must_use]
    pub fn load(from: &[f64], at: usize) -> Self {
        let mut out = [0.0; LANES];
        out.copy_from_slice(&from[at..at + LANES]);
        Self(out)
    }

    /// Writes the numbers from `at` on.
    ///
    /// # Panics
    /// Where fewer than eight have room.
    #[inline(always)]
    pub fn store(self, to: &mut [f64], at: usize) {
        to[at..at + LANES].copy_from_slice(&self.0);
    }

    /// Lane by lane.
    #[inline(always)]
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut out = [0.0; LANES];
        for k in 0..LANES {
            out[k] = f(self.0[k]);
        }
        Self(out)
    }

    /// The larger of each two; the second where the first is not a number.
    #[inline(always)]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self::select(self.gt(other), self, other)
    }

    /// The smaller of each two; the second where the first is not a number.
    #[inline(always)]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// Square roots.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    /// Where a lane is below the other's.
    #[inline(always)]
    #[must_use]
    pub fn lt(self, other: Self) -> M8 {
        let mut out = [false; LANES];
        for k in 0..LANES {
            out[k] = self.0[k] < other.0[k];
        }
        M8(out)
    }

    /// Where a lane is above the other's.
    #[inline(always)]
    #[must_use]
    pub fn gt(self, other: Self) -> M8 {
        other.lt(self)
    }

    /// `yes` where the mask says so, `no` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn select(mask: M8, yes: Self, no: Self) -> Self {
        let mut out = [0.0; LANES];
        for k in 0..LANES {
            out[k] = if mask.0[k] { yes.0[k] } else { no.0[k] };
        }
        Self(out)
    }

    /// Sum in the order of the lanes, in pairs.
    #[inline(always)]
    #[must_use]
    pub fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + b) + (c + d)) + ((e + f) + (g + h))
    }

    /// Smallest lane.
    #[inline(always)]
    #[must_use]
    pub fn least(self) -> f64 {
        self.0.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// `x^(-1/3)` of positive lanes to a relative error of 4e-16; exactly 1 at 1.
    ///
    /// A bit trick gives 4 % accuracy, and each correction by the third-order series of
    /// `(1 - e)^(-1/3)` raises the error to the fourth power.
    #[inline(always)]
    #[must_use]
    pub fn inverse_cube_root(self) -> Self {
        let mut seed = [0.0; LANES];
        for k in 0..LANES {
            // A third of the upper half of the bits, as a multiplication.
            let third = (self.0[k].to_bits() >> 32) * 0x5555_5556 >> 32;
            seed[k] = f64::from_bits(0x553e_f0ff_u64.wrapping_sub(third) << 32);
        }
        let mut y = Self(seed);
        for _ in 0..3 {
            let e = 1.0 - self * y * y * y;
            y += y * e * (1.0 / 3.0 + e * (2.0 / 9.0 + e * (14.0 / 81.0)));
        }
        let one = Self::splat(1.0);
        let mut exact = [false; LANES];
        for k in 0..LANES {
            exact[k] = self.0[k] == 1.0;
        }
        Self::select(M8(exact), one, y)
    }
}

impl M8 {
    /// From the bits of a mask, lane 0 lowest.
    #[inline(always)]
    #[must_use]
    pub fn from_bits(bits: u8) -> Self {
        let mut out = [false; LANES];
        for k in 0..LANES {
            out[k] = bits & (1 << k) != 0;
        }
        Self(out)
    }

    /// The bits of the mask, lane 0 lowest.
    #[inline(always)]
    #[must_use]
    pub fn bits(self) -> u8 {
        let mut out = 0;
        for k in 0..LANES {
            out |= u8::from(self.0[k]) << k;
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_cube_roots_are_right_to_round_off_and_exact_at_one() {
        for k in 0..2000 {
            let x = 10f64.powf(-3.0 + 6.0 * f64::from(k) / 2000.0);
            let y = F8::splat(x).inverse_cube_root().0[3];
            assert!((y * y * y * x - 1.0).abs() < 2e-15, "{x}: {y}");
        }
        assert_eq!(F8::splat(1.0).inverse_cube_root(), F8::splat(1.0));
    }

    #[test]
    fn masks_survive_their_bits() {
        for bits in 0..=255 {
            assert_eq!(M8::from_bits(bits).bits(), bits);
        }
    }
}
