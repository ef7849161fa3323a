//! One number, or one decision, for each strand of a batch.

use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// The number of strands that are worked on together.
pub(crate) const LANES: usize = 4;

/// One number for each strand of a batch.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[repr(C, align(32))]
pub(crate) struct Lane(pub [f64; LANES]);

/// One decision for each strand of a batch: all bits or none, as vector instructions want it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(32))]
pub(crate) struct Mask(pub(super) [u64; LANES]);

impl Lane {
    pub(crate) const ZERO: Self = Self([0.0; LANES]);
    pub(crate) const ONE: Self = Self([1.0; LANES]);

    #[inline(always)]
    pub(crate) const fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    pub(crate) fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut out = [0.0; LANES];
        for i in 0..LANES {
            out[i] = f(self.0[i]);
        }
        Self(out)
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = [0.0; LANES];
        for i in 0..LANES {
            out[i] = f(self.0[i], other.0[i]);
        }
        Self(out)
    }

    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    #[inline(always)]
    pub(crate) fn recip(self) -> Self {
        self.map(|v| 1.0 / v)
    }

    /// The larger; `self` where `other` is NaN.
    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if b > a { b } else { a })
    }

    /// The smaller; `self` where `other` is NaN.
    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if b < a { b } else { a })
    }

    #[inline(always)]
    fn compare(self, other: Self, f: impl Fn(f64, f64) -> bool) -> Mask {
        let mut out = [0; LANES];
        for i in 0..LANES {
            out[i] = if f(self.0[i], other.0[i]) {
                u64::MAX
            } else {
                0
            };
        }
        Mask(out)
    }

    #[inline(always)]
    pub(crate) fn lt(self, other: Self) -> Mask {
        self.compare(other, |a, b| a < b)
    }

    #[inline(always)]
    pub(crate) fn gt(self, other: Self) -> Mask {
        self.compare(other, |a, b| a > b)
    }

    /// Neither infinite nor NaN.
    #[inline(always)]
    pub(crate) fn is_finite(self) -> Mask {
        self.compare(self, |a, b| a - b == 0.0)
    }
}

impl Mask {
    pub(crate) const NONE: Self = Self([0; LANES]);

    #[inline(always)]
    pub(crate) fn new(set: [bool; LANES]) -> Self {
        let mut out = [0; LANES];
        for i in 0..LANES {
            out[i] = if set[i] { u64::MAX } else { 0 };
        }
        Self(out)
    }

    pub(crate) fn set(&mut self, lane: usize, value: bool) {
        self.0[lane] = if value { u64::MAX } else { 0 };
    }

    #[inline(always)]
    pub(crate) fn get(self, lane: usize) -> bool {
        self.0[lane] != 0
    }

    #[inline(always)]
    pub(crate) fn bools(self) -> [bool; LANES] {
        let mut out = [false; LANES];
        for i in 0..LANES {
            out[i] = self.0[i] != 0;
        }
        out
    }

    #[inline(always)]
    pub(crate) fn any(self) -> bool {
        self.0.iter().fold(0, |a, b| a | b) != 0
    }

    #[inline(always)]
    pub(crate) fn count(self) -> usize {
        self.0.iter().map(|b| b & 1).sum::<u64>() as usize
    }

    /// `yes` where set, else `no`.
    #[inline(always)]
    pub(crate) fn pick(self, yes: Lane, no: Lane) -> Lane {
        let mut out = [0.0; LANES];
        for i in 0..LANES {
            let bits = (yes.0[i].to_bits() & self.0[i]) | (no.0[i].to_bits() & !self.0[i]);
            out[i] = f64::from_bits(bits);
        }
        Lane(out)
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(u64, u64) -> u64) -> Self {
        let mut out = [0; LANES];
        for i in 0..LANES {
            out[i] = f(self.0[i], other.0[i]);
        }
        Self(out)
    }

    #[inline(always)]
    pub(crate) fn and(self, other: Self) -> Self {
        self.zip(other, |a, b| a & b)
    }

    #[inline(always)]
    pub(crate) fn or(self, other: Self) -> Self {
        self.zip(other, |a, b| a | b)
    }

    #[inline(always)]
    pub(crate) fn not(self) -> Self {
        self.zip(self, |a, _| !a)
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Lane {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $op b)
            }
        }
        impl $trait<f64> for Lane {
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

impl Neg for Lane {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

impl AddAssign for Lane {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lane {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Index<usize> for Lane {
    type Output = f64;
    #[inline(always)]
    fn index(&self, lane: usize) -> &f64 {
        &self.0[lane]
    }
}

impl IndexMut<usize> for Lane {
    #[inline(always)]
    fn index_mut(&mut self, lane: usize) -> &mut f64 {
        &mut self.0[lane]
    }
}
