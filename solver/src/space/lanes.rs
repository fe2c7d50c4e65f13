//! Eight numbers side by side: the unit of all inner loops in three dimensions.
//!
//! Kernels are written once, over [`Lanes`]. [`F8`] are plain arrays, for memory and for any
//! processor; [`super::wide`] has the registers of those whose registers are known. No multiplication
//! is ever fused with an addition and sums have one order, so that all give the same bits.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Number of lanes.
pub const LANES: usize = 8;

/// Eight truth values, lane 0 lowest.
pub type Mask = u8;

/// Eight numbers in memory.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct F8(pub [f64; LANES]);

/// Eight numbers at work.
pub trait Lanes:
    Copy
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// Eight times the same number.
    fn splat(x: f64) -> Self;
    /// From memory.
    fn of(x: F8) -> Self;
    /// To memory.
    fn pack(self) -> F8;
    /// The larger of each two; the second where either is not a number.
    fn max(self, other: Self) -> Self;
    /// The smaller of each two; the second where either is not a number.
    fn min(self, other: Self) -> Self;
    /// Square roots.
    fn sqrt(self) -> Self;
    /// Where a lane is below the other's.
    fn lt(self, other: Self) -> Mask;
    /// `yes` where the mask says so, `no` elsewhere.
    fn select(mask: Mask, yes: Self, no: Self) -> Self;
    /// Every lane moved one up; zero in lane 0.
    fn shifted(self) -> Self;
    /// Bits of an estimate of `x^(-1/3)`, good to 4 %.
    fn root_seed(self) -> Self;

    /// Eight zeros.
    #[inline(always)]
    #[must_use]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    /// The numbers from `at` on.
    #[inline(always)]
    #[must_use]
    fn load(from: &[f64], at: usize) -> Self {
        let mut out = [0.0; LANES];
        out.copy_from_slice(&from[at..at + LANES]);
        Self::of(F8(out))
    }

    /// The whole numbers from `at` on.
    #[inline(always)]
    #[must_use]
    fn whole<T: Copy + Into<f64>>(from: &[T], at: usize) -> Self {
        let mut out = [0.0; LANES];
        for (out, &n) in out.iter_mut().zip(&from[at..at + LANES]) {
            *out = n.into();
        }
        Self::of(F8(out))
    }

    /// The numbers from `at` on, zeros beyond the last.
    #[inline(always)]
    #[must_use]
    fn load_some(from: &[f64], at: usize) -> Self {
        if at + LANES <= from.len() { Self::load(from, at) } else { Self::of(last_of(from, at)) }
    }

    /// Adds to the numbers from `at` on, as far as there are any.
    #[inline(always)]
    fn add_some(self, to: &mut [f64], at: usize) {
        if at + LANES <= to.len() {
            (Self::load(to, at) + self).store(to, at);
        } else {
            add_last(&self.pack(), to, at);
        }
    }

    /// Writes the numbers from `at` on.
    #[inline(always)]
    fn store(self, to: &mut [f64], at: usize) {
        to[at..at + LANES].copy_from_slice(&self.pack().0);
    }

    /// Asks for memory that will be needed soon: whatever stands at the start of a slice.
    #[inline(always)]
    fn fetch<T>(_: &[T]) {}

    /// Where a lane is above the other's.
    #[inline(always)]
    #[must_use]
    fn gt(self, other: Self) -> Mask {
        other.lt(self)
    }

    /// Sizes.
    #[inline(always)]
    #[must_use]
    fn abs(self) -> Self {
        self.max(-self)
    }

    /// The lanes of the mask, zero elsewhere.
    #[inline(always)]
    #[must_use]
    fn keep(self, mask: Mask) -> Self {
        Self::select(mask, self, Self::zero())
    }

    /// Sum in the order of the lanes, in pairs.
    #[inline(always)]
    #[must_use]
    fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.pack().0;
        ((a + b) + (c + d)) + ((e + f) + (g + h))
    }

    /// Smallest lane.
    #[inline(always)]
    #[must_use]
    fn least(self) -> f64 {
        self.pack().0.into_iter().fold(f64::INFINITY, |a, b| if b < a { b } else { a })
    }

    /// Largest lane.
    #[inline(always)]
    #[must_use]
    fn largest(self) -> f64 {
        -(-self).least()
    }

    /// `x^(-1/3)` of positive lanes to a relative error of 4e-16; exactly 1 at 1.
    ///
    /// Each correction by the third-order series of `(1 - e)^(-1/3)` raises the error of the estimate
    /// to the fourth power.
    #[inline(always)]
    #[must_use]
    fn inverse_cube_root(self) -> Self {
        let one = Self::splat(1.0);
        let mut y = self.root_seed();
        for _ in 0..3 {
            let e = one - self * y * y * y;
            y += y * e * (e * (e * (14.0 / 81.0) + 2.0 / 9.0) + 1.0 / 3.0);
        }
        let exact = !(self.lt(one) | self.gt(one));
        Self::select(exact, one, y)
    }
}

/// The numbers from `at` on, fewer than eight, and zeros.
#[cold]
#[inline(never)]
fn last_of(from: &[f64], at: usize) -> F8 {
    let mut out = F8::ZERO;
    let left = from.get(at..).unwrap_or_default();
    out.0[..left.len()].copy_from_slice(left);
    out
}

/// Adds to the numbers from `at` on, fewer than eight.
#[cold]
#[inline(never)]
fn add_last(values: &F8, to: &mut [f64], at: usize) {
    for (to, value) in to.iter_mut().skip(at).zip(values.0) {
        *to += value;
    }
}

/// An array of so many values by the index, written out: no memory is cleared first. (Closures are not
/// always inlined into wide functions, and then call every instruction.)
macro_rules! each {
    ($k:ident in 3 => $value:expr) => { each!($k of [0, 1, 2] => $value) };
    ($k:ident in 4 => $value:expr) => { each!($k of [0, 1, 2, 3] => $value) };
    ($k:ident in 6 => $value:expr) => { each!($k of [0, 1, 2, 3, 4, 5] => $value) };
    ($k:ident in 9 => $value:expr) => { each!($k of [0, 1, 2, 3, 4, 5, 6, 7, 8] => $value) };
    ($k:ident of [$($index:literal),*] => $value:expr) => {
        [$({
            let $k: usize = $index;
            $value
        }),*]
    };
}
pub(super) use each;

/// Bits of the estimate of [`Lanes::root_seed`]: minus a third of the upper half, as a multiplication.
pub(super) const SEED: u64 = 0x553e_f0ff;
/// A third in units of `2^-32`.
pub(super) const THIRD: u64 = 0x5555_5556;

impl Default for F8 {
    fn default() -> Self {
        Self::ZERO
    }
}

impl F8 {
    /// Eight zeros.
    pub const ZERO: Self = Self([0.0; LANES]);

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = [0.0; LANES];
        for (out, (a, b)) in out.iter_mut().zip(self.0.into_iter().zip(other.0)) {
            *out = f(a, b);
        }
        Self(out)
    }

    /// Lane by lane.
    #[inline(always)]
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        self.zip(self, |x, _| f(x))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for F8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $op b)
            }
        }
        impl $trait<f64> for F8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.map(|a| a $op other)
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
        self.map(|x| -x)
    }
}

impl Lanes for F8 {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; LANES])
    }

    #[inline(always)]
    fn of(x: F8) -> Self {
        x
    }

    #[inline(always)]
    fn pack(self) -> F8 {
        self
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        let mut mask = 0;
        for k in 0..LANES {
            mask |= u8::from(self.0[k] < other.0[k]) << k;
        }
        mask
    }

    #[inline(always)]
    fn select(mask: Mask, yes: Self, no: Self) -> Self {
        let mut out = no.0;
        for (k, out) in out.iter_mut().enumerate() {
            if mask >> k & 1 == 1 {
                *out = yes.0[k];
            }
        }
        Self(out)
    }

    #[inline(always)]
    fn shifted(self) -> Self {
        let mut out = [0.0; LANES];
        out[1..].copy_from_slice(&self.0[..LANES - 1]);
        Self(out)
    }

    #[inline(always)]
    fn root_seed(self) -> Self {
        self.map(|x| {
            let third = ((x.to_bits() >> 32) * THIRD) >> 32;
            f64::from_bits(SEED.wrapping_sub(third) << 32)
        })
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
    fn masks_name_lanes_from_the_lowest_bit() {
        let a = F8([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        assert_eq!(a.lt(F8::splat(2.5)), 0b0000_0111);
        assert_eq!(a.keep(0b1000_0001).0, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 7.0]);
        assert_eq!(a.shifted().0, [0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }
}
