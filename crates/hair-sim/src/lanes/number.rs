//! Numbers that loops over particles are generic in.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::lane::{LANES, Lane, Mask};

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
    /// Whether it holds for any.
    fn any(condition: Self::Condition) -> bool;
    /// `yes` where the condition holds, else `no`.
    fn choose(condition: Self::Condition, yes: Self, no: Self) -> Self;
    /// Calls `work`, compiled for the instructions of these numbers, as a function of its own: one phase of a step. All that it
    /// calls must be `#[inline(always)]`: what is not inlined is compiled for the program's own instructions.
    fn run<R>(work: impl FnOnce() -> R) -> R;
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
    fn any(condition: Mask) -> bool {
        condition.any()
    }
    #[inline(always)]
    fn choose(condition: Mask, yes: Self, no: Self) -> Self {
        condition.pick(yes, no)
    }
    #[inline(never)]
    fn run<R>(work: impl FnOnce() -> R) -> R {
        work()
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
        impl $type<$crate::lanes::lane::Lane> {
            #[inline(always)]
            #[allow(dead_code, reason = "made for every struct")]
            pub(crate) fn load<T: $crate::lanes::number::Number>(&self) -> $type<T> {
                $type { $($field: self.$field.load()),+ }
            }
        }
        impl<T: $crate::lanes::number::Number> $type<T> {
            #[inline(always)]
            #[allow(dead_code, reason = "made for every struct")]
            pub(crate) fn store(self) -> $type<$crate::lanes::lane::Lane> {
                $type { $($field: self.$field.store()),+ }
            }
        }
    };
}
pub(crate) use stored;
