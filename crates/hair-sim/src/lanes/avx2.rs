//! Four numbers in a register of AVX2.
//!
//! The `unsafe` here calls single instructions, and functions that are compiled for them. A test of the processor is behind each:
//! [`Instructions::best`](super::instructions::Instructions::best) alone chooses this type, where it has found AVX2, and
//! what works with it is inlined into what [`Number::run`] calls. What it is worth is measured there.
#![allow(unsafe_code, reason = "it saves time, see `lanes::instructions`")]

use std::arch::x86_64::{
    __m256d, _CMP_LT_OQ, _mm256_add_pd, _mm256_andnot_pd, _mm256_blendv_pd, _mm256_cmp_pd,
    _mm256_div_pd, _mm256_load_pd, _mm256_movemask_pd, _mm256_mul_pd, _mm256_set1_pd,
    _mm256_sqrt_pd, _mm256_store_pd, _mm256_sub_pd, _mm256_xor_pd,
};
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{
    lane::{LANES, Lane, Mask},
    number::Number,
};

/// A [`Lane`] in a register.
#[derive(Clone, Copy)]
pub(crate) struct Avx2(__m256d);

macro_rules! operator {
    ($trait:ident, $method:ident, $instruction:ident) => {
        impl $trait for Avx2 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see the module.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
    };
}
operator!(Add, add, _mm256_add_pd);
operator!(Sub, sub, _mm256_sub_pd);
operator!(Mul, mul, _mm256_mul_pd);
operator!(Div, div, _mm256_div_pd);

impl Neg for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: see the module.
        Self(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)) })
    }
}

impl Number for Avx2 {
    type Condition = Self;

    #[inline(always)]
    fn load(lane: &Lane) -> Self {
        // SAFETY: see the module; a lane is four numbers at a multiple of 32 bytes.
        Self(unsafe { _mm256_load_pd(lane.0.as_ptr()) })
    }
    #[inline(always)]
    fn store(self) -> Lane {
        let mut lane = Lane::ZERO;
        // SAFETY: as `load`.
        unsafe { _mm256_store_pd(lane.0.as_mut_ptr(), self.0) };
        lane
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: see the module.
        Self(unsafe { _mm256_set1_pd(value) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see the module.
        Self(unsafe { _mm256_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see the module.
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
    }
    #[inline(always)]
    fn less(self, than: Self) -> Self {
        // SAFETY: see the module.
        Self(unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, than.0) })
    }
    #[inline(always)]
    fn condition(mask: &Mask) -> Self {
        Self::load(&Lane(mask.0.map(f64::from_bits)))
    }
    #[inline(always)]
    fn all(condition: Self) -> bool {
        // SAFETY: see the module.
        unsafe { _mm256_movemask_pd(condition.0) == (1 << LANES) - 1 }
    }
    #[inline(always)]
    fn any(condition: Self) -> bool {
        // SAFETY: see the module.
        unsafe { _mm256_movemask_pd(condition.0) != 0 }
    }
    #[inline(always)]
    fn choose(condition: Self, yes: Self, no: Self) -> Self {
        // SAFETY: see the module.
        Self(unsafe { _mm256_blendv_pd(no.0, yes.0, condition.0) })
    }
    #[inline(always)]
    fn run<R>(work: impl FnOnce() -> R) -> R {
        #[target_feature(enable = "avx2")]
        #[inline(never)]
        fn compiled<R>(work: impl FnOnce() -> R) -> R {
            work()
        }
        // SAFETY: see the module.
        unsafe { compiled(work) }
    }
}
