//! Registers of 512 bits. Used by [`super::dispatch`] alone, after it has found the instructions.

#![allow(unsafe_code)]

use core::arch::x86_64::{
    __m512d, _CMP_LT_OQ, _MM_HINT_T0, _mm_prefetch, _mm512_add_pd, _mm512_castpd_si512,
    _mm512_castsi512_pd, _mm512_cmp_pd_mask, _mm512_div_pd, _mm512_loadu_pd, _mm512_mask_blend_pd,
    _mm512_maskz_permutexvar_pd, _mm512_max_pd, _mm512_min_pd, _mm512_mul_epu32, _mm512_mul_pd,
    _mm512_set_epi64, _mm512_set1_epi64, _mm512_set1_pd, _mm512_slli_epi64, _mm512_sqrt_pd,
    _mm512_srli_epi64, _mm512_storeu_pd, _mm512_sub_epi64, _mm512_sub_pd,
};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::lanes::{F8, LANES, Lanes, Mask, SEED, THIRD};

/// Eight numbers in a register.
#[derive(Debug, Clone, Copy)]
pub struct W8(__m512d);

// SAFETY, of every block below: `dispatch` alone instantiates kernels with `W8`, inside a function
// compiled for these instructions and after the processor was found to have them. Loads and stores
// are of arrays of eight.

macro_rules! operator {
    ($trait:ident, $method:ident, $instruction:ident) => {
        impl $trait for W8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
        impl $trait<f64> for W8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self(unsafe { $instruction(self.0, _mm512_set1_pd(other)) })
            }
        }
    };
}

operator!(Add, add, _mm512_add_pd);
operator!(Sub, sub, _mm512_sub_pd);
operator!(Mul, mul, _mm512_mul_pd);
operator!(Div, div, _mm512_div_pd);

impl AddAssign for W8 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for W8 {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for W8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::splat(-0.0) - self
    }
}

impl Lanes for W8 {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self(unsafe { _mm512_set1_pd(x) })
    }

    #[inline(always)]
    fn of(x: F8) -> Self {
        Self(unsafe { _mm512_loadu_pd(x.0.as_ptr()) })
    }

    #[inline(always)]
    fn pack(self) -> F8 {
        let mut out = [0.0; LANES];
        unsafe { _mm512_storeu_pd(out.as_mut_ptr(), self.0) };
        F8(out)
    }

    #[inline(always)]
    fn load(from: &[f64], at: usize) -> Self {
        let from = &from[at..at + LANES];
        Self(unsafe { _mm512_loadu_pd(from.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [f64], at: usize) {
        let to = &mut to[at..at + LANES];
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) };
    }

    #[inline(always)]
    fn fetch<T>(from: &[T]) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(from.as_ptr().cast()) };
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(unsafe { _mm512_max_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(unsafe { _mm512_min_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) }
    }

    #[inline(always)]
    fn select(mask: Mask, yes: Self, no: Self) -> Self {
        Self(unsafe { _mm512_mask_blend_pd(mask, no.0, yes.0) })
    }

    #[inline(always)]
    fn shifted(self) -> Self {
        Self(unsafe {
            let from = _mm512_set_epi64(6, 5, 4, 3, 2, 1, 0, 0);
            _mm512_maskz_permutexvar_pd(0b1111_1110, from, self.0)
        })
    }

    #[inline(always)]
    fn root_seed(self) -> Self {
        Self(unsafe {
            let upper = _mm512_srli_epi64::<32>(_mm512_castpd_si512(self.0));
            let third = _mm512_mul_epu32(upper, _mm512_set1_epi64(THIRD as i64));
            let third = _mm512_srli_epi64::<32>(third);
            let bits = _mm512_sub_epi64(_mm512_set1_epi64(SEED as i64), third);
            _mm512_castsi512_pd(_mm512_slli_epi64::<32>(bits))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::dispatch::{Instructions, Kernel};
    use super::*;

    /// Everything that lanes can do, to be compared between processors' instructions.
    struct Everything(F8, F8);

    impl Kernel for Everything {
        type Output = Vec<F8>;

        fn run<F: Lanes>(self) -> Vec<F8> {
            let (a, b) = (F::of(self.0), F::of(self.1));
            let below = a.lt(b);
            let all = [
                a + b,
                a - b,
                a * b,
                a / b,
                -a,
                a + 3.0,
                a.max(b),
                a.min(b),
                a.abs().sqrt(),
                F::select(below, a, b),
                a.shifted(),
                (a.abs() + 0.1).inverse_cube_root(),
                F::splat(a.sum()),
                F::splat(a.least()),
                F::splat(a.largest()),
            ];
            all.into_iter().map(Lanes::pack).collect()
        }
    }

    #[test]
    fn all_instructions_give_the_same_bits() {
        let a = F8([1.5, -2.25, 0.0, 1e-300, 7.1, 1e300, 0.3, -0.0]);
        let b = F8([0.5, 3.0, 1.0, 2e-300, 7.1, -1e10, 0.7, 1.0]);
        let plain = Instructions::Baseline.run(Everything(a, b));
        let best = Instructions::detect().run(Everything(a, b));
        for (k, (plain, best)) in plain.iter().zip(&best).enumerate() {
            assert_eq!(plain.0.map(f64::to_bits), best.0.map(f64::to_bits), "{k}");
        }
    }
}
