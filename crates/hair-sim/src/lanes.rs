//! Arithmetic on [`LANES`] strands at once.
//!
//! What is kept of a batch is an array of numbers in place of one, a [`Lane`]. The loops that take the time are generic in the
//! [`Number`] that they work with: they load lanes, work in registers of the machine's instruction set, and store
//! lanes. For a machine without one of these the number is the array itself.
//!
//! Every operation works lane by lane, so that a strand's numbers never depend on its neighbours in
//! a batch, and there is no fused multiply-add, so that they are the same on every processor.

#[cfg(target_arch = "x86_64")]
pub(crate) mod avx2;
mod linear;
pub(crate) mod plane;

pub(crate) use linear::{Mat3, Quat, Sym3, Vec3};

use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// The number of strands that are worked on together.
pub(crate) const LANES: usize = 4;

/// One number for each strand of a batch.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[repr(C, align(32))]
pub(crate) struct Lane(pub [f64; LANES]);

/// What the loops that take the time work with: [`LANES`] numbers, of one strand each.
pub(crate) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A decision for each.
    type Condition: Copy;

    fn load(lane: &Lane) -> Self;
    fn store(self) -> Lane;
    fn splat(value: f64) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn less(self, than: Self) -> Self::Condition;
    fn condition(mask: &Mask) -> Self::Condition;
    /// Whether it holds for each.
    fn all(condition: Self::Condition) -> bool;
    /// `yes` where the condition holds, else `no`.
    fn choose(condition: Self::Condition, yes: Self, no: Self) -> Self;
}

impl Number for Lane {
    type Condition = Mask;

    #[inline(always)]
    fn load(lane: &Lane) -> Self {
        *lane
    }
    #[inline(always)]
    fn store(self) -> Lane {
        self
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn less(self, than: Self) -> Mask {
        self.lt(than)
    }
    #[inline(always)]
    fn condition(mask: &Mask) -> Mask {
        *mask
    }
    #[inline(always)]
    fn all(condition: Mask) -> bool {
        !condition.not().any()
    }
    #[inline(always)]
    fn choose(condition: Mask, yes: Self, no: Self) -> Self {
        condition.pick(yes, no)
    }
}

impl Lane {
    #[inline(always)]
    pub(crate) fn load<T: Number>(&self) -> T {
        T::load(self)
    }
}

/// Loading and storing of structs of numbers.
macro_rules! stored {
    ($type:ident { $($field:tt),+ }) => {
        impl $type<$crate::lanes::Lane> {
            #[inline(always)]
            #[allow(dead_code, reason = "made for every struct")]
            pub(crate) fn load<T: $crate::lanes::Number>(&self) -> $type<T> {
                $type { $($field: self.$field.load()),+ }
            }
        }
        impl<T: $crate::lanes::Number> $type<T> {
            #[inline(always)]
            #[allow(dead_code, reason = "made for every struct")]
            pub(crate) fn store(self) -> $type<$crate::lanes::Lane> {
                $type { $($field: self.$field.store()),+ }
            }
        }
    };
}
pub(crate) use stored;

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

    /// The larger; `self` where `other` is not a number.
    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if b > a { b } else { a })
    }

    /// The smaller; `self` where `other` is not a number.
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

#[cfg(test)]
mod properties;
