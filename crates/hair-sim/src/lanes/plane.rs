//! Vectors and matrices in the plane across a link.

use std::ops::{Add, Sub};

use super::{
    lane::Lane,
    number::{Number, stored},
};

/// Two coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Vec2<T = Lane> {
    pub x: T,
    pub y: T,
}
stored!(Vec2 { x, y });

/// A symmetric 2 x 2 matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sym2<T = Lane> {
    pub xx: T,
    pub yy: T,
    pub xy: T,
}
stored!(Sym2 { xx, yy, xy });

impl<T: Number> Vec2<T> {
    #[inline(always)]
    pub(crate) fn new(x: T, y: T) -> Self {
        Self { x, y }
    }

    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self::new(T::splat(0.0), T::splat(0.0))
    }

    #[inline(always)]
    pub(crate) fn scale(self, s: T) -> Self {
        Self::new(self.x * s, self.y * s)
    }
}

impl<T: Number> Add for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y)
    }
}

impl<T: Number> Sub for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y)
    }
}

impl<T: Number> Sym2<T> {
    /// `d` on the diagonal.
    #[inline(always)]
    pub(crate) fn diagonal(d: T) -> Self {
        Self {
            xx: d,
            yy: d,
            xy: T::splat(0.0),
        }
    }

    #[inline(always)]
    pub(crate) fn apply(self, v: Vec2<T>) -> Vec2<T> {
        Vec2::new(self.xx * v.x + self.xy * v.y, self.xy * v.x + self.yy * v.y)
    }

    #[inline(always)]
    pub(crate) fn scale(self, s: T) -> Self {
        Self {
            xx: self.xx * s,
            yy: self.yy * s,
            xy: self.xy * s,
        }
    }

    /// The product of two matrices that commute, which is symmetric.
    #[inline(always)]
    pub(crate) fn times(self, o: Self) -> Self {
        Self {
            xx: self.xx * o.xx + self.xy * o.xy,
            yy: self.xy * o.xy + self.yy * o.yy,
            xy: self.xx * o.xy + self.xy * o.yy,
        }
    }
}
