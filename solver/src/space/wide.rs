//! Registers that hold two, four or eight numbers, and eight lanes made of them. Used by
//! [`super::dispatch`] alone, after it has found the instructions.

#![allow(unsafe_code)]

use core::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::lanes::{F8, LANES, Lanes, Mask, SEED, THIRD};

/// Eight numbers in one register of 512 bits.
pub type W8 = Wide<__m512d>;

/// Eight numbers in two registers of 256 bits.
pub type W4 = Wide<Pair<__m256d>>;

/// Eight numbers in four registers of 128 bits, which every processor of the target has.
pub type W2 = Wide<Pair<Pair<__m128d>>>;

// SAFETY, of every block below: `dispatch` alone instantiates kernels with these types, inside
// functions compiled for their instructions and after the processor was found to have them. Loads and
// stores are of as many numbers as there are lanes, which `Wide` alone asks for.

/// Numbers side by side, and what their instructions do with them.
pub trait Register: Copy + Send + Sync {
    /// How many.
    const WIDTH: usize;
    fn splat(x: f64) -> Self;
    unsafe fn load(from: *const f64) -> Self;
    unsafe fn store(self, to: *mut f64);
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    fn lt(self, other: Self) -> Mask;
    fn select(mask: Mask, yes: Self, no: Self) -> Self;
    /// Every lane moved one up; the last of `below` in lane 0.
    fn shifted(self, below: Self) -> Self;
    fn root_seed(self) -> Self;
}

/// Declares a register: what differs by name alone, then what differs by more.
macro_rules! register {
    ($type:ident of $width:literal, $($method:ident = $instruction:ident),*;
     load $load:ident, store $store:ident, sqrt $sqrt:ident, splat $splat:ident;
     $cast:ident, $uncast:ident, $up:ident, $down:ident, $product:ident, $minus:ident, $same:ident;
     $($own:item)*) => {
        impl Register for $type {
            const WIDTH: usize = $width;
            $(
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    unsafe { $instruction(self, other) }
                }
            )*
            #[inline(always)]
            fn splat(x: f64) -> Self {
                unsafe { $splat(x) }
            }
            #[inline(always)]
            unsafe fn load(from: *const f64) -> Self {
                unsafe { $load(from) }
            }
            #[inline(always)]
            unsafe fn store(self, to: *mut f64) {
                unsafe { $store(to, self) }
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                unsafe { $sqrt(self) }
            }
            #[inline(always)]
            fn root_seed(self) -> Self {
                unsafe {
                    let third = $product($down::<32>($cast(self)), $same(THIRD as i64));
                    $uncast($up::<32>($minus($same(SEED as i64), $down::<32>(third))))
                }
            }
            $($own)*
        }
    };
}

register! {
    __m128d of 2, add = _mm_add_pd, sub = _mm_sub_pd, mul = _mm_mul_pd, div = _mm_div_pd,
    max = _mm_max_pd, min = _mm_min_pd;
    load _mm_loadu_pd, store _mm_storeu_pd, sqrt _mm_sqrt_pd, splat _mm_set1_pd;
    _mm_castpd_si128, _mm_castsi128_pd, _mm_slli_epi64, _mm_srli_epi64, _mm_mul_epu32,
    _mm_sub_epi64, _mm_set1_epi64x;

    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        unsafe { _mm_movemask_pd(_mm_cmplt_pd(self, other)) as Mask }
    }
    #[inline(always)]
    fn select(mask: Mask, yes: Self, no: Self) -> Self {
        unsafe {
            let lane = _mm_set_epi32(2, 2, 1, 1);
            let set = _mm_and_si128(_mm_set1_epi32(i32::from(mask)), lane);
            let set = _mm_castsi128_pd(_mm_cmpeq_epi32(set, lane));
            _mm_or_pd(_mm_and_pd(set, yes), _mm_andnot_pd(set, no))
        }
    }
    #[inline(always)]
    fn shifted(self, below: Self) -> Self {
        unsafe { _mm_shuffle_pd::<0b01>(below, self) }
    }
}

register! {
    __m256d of 4, add = _mm256_add_pd, sub = _mm256_sub_pd, mul = _mm256_mul_pd,
    div = _mm256_div_pd, max = _mm256_max_pd, min = _mm256_min_pd;
    load _mm256_loadu_pd, store _mm256_storeu_pd, sqrt _mm256_sqrt_pd, splat _mm256_set1_pd;
    _mm256_castpd_si256, _mm256_castsi256_pd, _mm256_slli_epi64, _mm256_srli_epi64,
    _mm256_mul_epu32, _mm256_sub_epi64, _mm256_set1_epi64x;

    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self, other)) as Mask }
    }
    #[inline(always)]
    fn select(mask: Mask, yes: Self, no: Self) -> Self {
        unsafe {
            let lane = _mm256_set_epi64x(8, 4, 2, 1);
            let set = _mm256_and_si256(_mm256_set1_epi64x(i64::from(mask)), lane);
            _mm256_blendv_pd(no, yes, _mm256_castsi256_pd(_mm256_cmpeq_epi64(set, lane)))
        }
    }
    #[inline(always)]
    fn shifted(self, below: Self) -> Self {
        unsafe {
            let halves = _mm256_permute2f128_pd::<0x21>(below, self);
            _mm256_shuffle_pd::<0b0101>(halves, self)
        }
    }
}

register! {
    __m512d of 8, add = _mm512_add_pd, sub = _mm512_sub_pd, mul = _mm512_mul_pd,
    div = _mm512_div_pd, max = _mm512_max_pd, min = _mm512_min_pd;
    load _mm512_loadu_pd, store _mm512_storeu_pd, sqrt _mm512_sqrt_pd, splat _mm512_set1_pd;
    _mm512_castpd_si512, _mm512_castsi512_pd, _mm512_slli_epi64, _mm512_srli_epi64,
    _mm512_mul_epu32, _mm512_sub_epi64, _mm512_set1_epi64;

    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self, other) }
    }
    #[inline(always)]
    fn select(mask: Mask, yes: Self, no: Self) -> Self {
        unsafe { _mm512_mask_blend_pd(mask, no, yes) }
    }
    #[inline(always)]
    fn shifted(self, below: Self) -> Self {
        unsafe {
            let (own, below) = (_mm512_castpd_si512(self), _mm512_castpd_si512(below));
            _mm512_castsi512_pd(_mm512_alignr_epi64::<7>(own, below))
        }
    }
}

/// Two registers: the lower lanes and the upper ones.
#[derive(Debug, Clone, Copy)]
pub struct Pair<R>(R, R);

macro_rules! both {
    ($($method:ident),*) => {$(
        #[inline(always)]
        fn $method(self, other: Self) -> Self {
            Self(self.0.$method(other.0), self.1.$method(other.1))
        }
    )*};
}

impl<R: Register> Register for Pair<R> {
    const WIDTH: usize = 2 * R::WIDTH;
    both!(add, sub, mul, div, max, min);
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self(R::splat(x), R::splat(x))
    }
    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        unsafe { Self(R::load(from), R::load(from.add(R::WIDTH))) }
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        unsafe {
            self.0.store(to);
            self.1.store(to.add(R::WIDTH));
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        self.0.lt(other.0) | self.1.lt(other.1) << R::WIDTH
    }
    #[inline(always)]
    fn select(mask: Mask, yes: Self, no: Self) -> Self {
        Self(R::select(mask, yes.0, no.0), R::select(mask >> R::WIDTH, yes.1, no.1))
    }
    #[inline(always)]
    fn shifted(self, below: Self) -> Self {
        Self(self.0.shifted(below.1), self.1.shifted(self.0))
    }
    #[inline(always)]
    fn root_seed(self) -> Self {
        Self(self.0.root_seed(), self.1.root_seed())
    }
}

/// Eight numbers in registers.
#[derive(Debug, Clone, Copy)]
pub struct Wide<R>(R);

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<R: Register> $trait for Wide<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
        impl<R: Register> $trait<f64> for Wide<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self(self.0.$method(R::splat(other)))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<R: Register> AddAssign for Wide<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<R: Register> SubAssign for Wide<R> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<R: Register> Neg for Wide<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(R::splat(-0.0).sub(self.0))
    }
}

impl<R: Register> Lanes for Wide<R> {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        const { assert!(R::WIDTH == LANES) };
        Self(R::splat(x))
    }

    #[inline(always)]
    fn of(x: F8) -> Self {
        Self::load(&x.0, 0)
    }

    #[inline(always)]
    fn pack(self) -> F8 {
        let mut out = F8([0.0; LANES]);
        self.store(&mut out.0, 0);
        out
    }

    #[inline(always)]
    fn load(from: &[f64], at: usize) -> Self {
        const { assert!(R::WIDTH == LANES) };
        let from = &from[at..at + LANES];
        Self(unsafe { R::load(from.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [f64], at: usize) {
        const { assert!(R::WIDTH == LANES) };
        let to = &mut to[at..at + LANES];
        unsafe { self.0.store(to.as_mut_ptr()) };
    }

    #[inline(always)]
    fn fetch<T>(from: &[T]) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(from.as_ptr().cast()) };
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        self.0.lt(other.0)
    }

    #[inline(always)]
    fn select(mask: Mask, yes: Self, no: Self) -> Self {
        Self(R::select(mask, yes.0, no.0))
    }

    #[inline(always)]
    fn shifted(self) -> Self {
        Self(self.0.shifted(R::splat(0.0)))
    }

    #[inline(always)]
    fn root_seed(self) -> Self {
        Self(self.0.root_seed())
    }
}

#[cfg(test)]
mod tests {
    use super::super::dispatch::{Instructions, Kernel};
    use super::*;

    /// Everything that lanes can do, to be compared between processors' instructions.
    #[derive(Clone, Copy)]
    struct Everything(F8, F8);

    impl Kernel for Everything {
        type Output = Vec<F8>;

        fn run<F: Lanes>(self) -> Vec<F8> {
            let (a, b) = (F::of(self.0), F::of(self.1));
            let mask = |bits: Mask| F::splat(f64::from(bits));
            let memory: Vec<f64> = self.0.0.into_iter().chain(self.1.0).collect();
            let mut stored = memory.clone();
            (a + b).store(&mut stored, 3);
            let all = [
                a + b,
                a - b,
                a * b,
                a / b,
                -a,
                a + 3.0,
                a - 3.0,
                a * 3.0,
                a.max(b),
                a.min(b),
                a.abs(),
                a.abs().sqrt(),
                mask(a.lt(b)),
                mask(a.gt(b)),
                F::select(a.lt(b), a, b),
                F::select(0b1010_0110, a, b),
                a.keep(0b0101_1011),
                a.shifted(),
                a.root_seed(),
                (a.abs() + 0.1).inverse_cube_root(),
                F::splat(a.sum()),
                F::splat(a.least()),
                F::splat(a.largest()),
                F::load(&memory, 5),
                F::load(&stored, 0),
                F::load(&stored, 8),
            ];
            all.into_iter().map(Lanes::pack).collect()
        }
    }

    /// Bits, all that is no number alike: processors do not agree on the sign of what they make.
    fn bits(x: f64) -> u64 {
        if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() }
    }

    #[test]
    fn all_instructions_give_the_same_bits() {
        let special = [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 5e-324, -1e308, 1.0];
        let common = F8([1.5, -2.25, 0.0, 1e-300, 7.1, 1e300, 0.3, -0.0]);
        let mut pairs = vec![(common, F8([0.5, 3.0, 1.0, 2e-300, 7.1, -1e10, 0.7, 1.0]))];
        // Every value beside every other, zeros of both signs among them.
        for turn in 0..LANES {
            let mut other = special;
            other.rotate_left(turn);
            pairs.push((F8(special), F8(other)));
        }
        for k in 0..100 {
            let x = |lane: usize| f64::from(8 * k + lane as i32).sin() * 10f64.powi(k - 50);
            pairs.push((F8(std::array::from_fn(x)), F8(std::array::from_fn(|lane| x(lane + 3)))));
        }
        for (a, b) in pairs {
            let everything = Everything(a, b);
            let plain = everything.run::<F8>();
            for instructions in Instructions::available() {
                let own = instructions.run(everything);
                for (k, (plain, own)) in plain.iter().zip(&own).enumerate() {
                    let (plain, own) = (plain.0.map(bits), own.0.map(bits));
                    assert_eq!(plain, own, "{instructions:?}: {k} of {a:?}, {b:?}");
                }
            }
        }
    }
}
