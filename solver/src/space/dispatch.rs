//! The widest vectors that the processor has, chosen at run time: with [`super::wide`] the only
//! `unsafe` code.
//!
//! A kernel is inlined into a function compiled for a set of instructions. Its arithmetic is the same
//! in each (see [`super::lanes`]): the choice changes the speed and no bit of the answer.

#![allow(unsafe_code)]

#[cfg(not(target_arch = "x86_64"))]
use super::lanes::F8 as Basic;
use super::lanes::Lanes;
#[cfg(target_arch = "x86_64")]
use super::wide::{W2 as Basic, W4, W8};

/// A loop over groups of eight.
pub trait Kernel {
    /// What it gives.
    type Output;
    /// Runs it; implementations are to be inlined.
    fn run<F: Lanes>(self) -> Self::Output;
}

/// Instructions that a processor has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instructions {
    /// Those that every processor of the target has.
    Baseline,
    /// 256-bit vectors.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// 512-bit vectors.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Instructions {
    /// The widest that this processor has.
    #[must_use]
    pub fn detect() -> Self {
        Self::available().last().unwrap_or(Self::Baseline)
    }

    /// Those that this processor has, from the narrowest to the widest.
    pub fn available() -> impl Iterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let wider = {
            let avx512 = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512bw");
            let avx2 = is_x86_feature_detected!("avx2");
            [avx2.then_some(Self::Avx2), avx512.then_some(Self::Avx512)]
        };
        #[cfg(not(target_arch = "x86_64"))]
        let wider = [];
        std::iter::once(Self::Baseline).chain(wider.into_iter().flatten())
    }

    /// Runs a kernel with these instructions.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            Self::Baseline => kernel.run::<Basic>(),
            // SAFETY: these variants are made by `available` alone, which has found the instructions.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { avx2(kernel) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { avx512(kernel) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<W4>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
unsafe fn avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<W8>()
}
