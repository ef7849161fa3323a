//! Four numbers and vectors in single precision.

use glam::Vec4;

use crate::lanes::{Lane, Number, Vec3};

/// A factor on a length in single precision that makes up for it.
pub(super) const ROUNDED: f32 = 1.0 + 1e-6;

/// Four vectors, of the links of a piece or of strands side by side, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vectors(pub [Vec4; 3]);

impl Vectors {
    pub(super) const ZERO: Self = Self([Vec4::ZERO; 3]);

    /// Of strands side by side.
    #[inline(always)]
    pub(super) fn single<T: Number>(v: Vec3<T>) -> Self {
        Self([single(v.x), single(v.y), single(v.z)])
    }

    /// That of one link, four times.
    #[inline(always)]
    pub(super) fn of(&self, link: usize) -> Self {
        let [x, y, z] = &self.0;
        Self([all(x, link), all(y, link), all(z, link)])
    }

    #[inline(always)]
    pub(super) fn plus(&self, other: &Self) -> Self {
        let ([x, y, z], [ox, oy, oz]) = (self.0, other.0);
        Self([x + ox, y + oy, z + oz])
    }

    #[inline(always)]
    pub(super) fn minus(&self, other: &Self) -> Self {
        let ([x, y, z], [ox, oy, oz]) = (self.0, other.0);
        Self([x - ox, y - oy, z - oz])
    }

    #[inline(always)]
    pub(super) fn times(&self, by: Vec4) -> Self {
        Self(self.0.map(|axis| axis * by))
    }

    #[inline(always)]
    pub(super) fn dot(&self, other: &Self) -> Vec4 {
        let ([x, y, z], [ox, oy, oz]) = (self.0, other.0);
        x * ox + y * oy + z * oz
    }

    #[inline(always)]
    pub(super) fn length_squared(&self) -> Vec4 {
        self.dot(self)
    }

    #[inline(always)]
    pub(super) fn least(&self, other: &Self) -> Self {
        let ([x, y, z], [ox, oy, oz]) = (self.0, other.0);
        Self([x.min(ox), y.min(oy), z.min(oz)])
    }

    #[inline(always)]
    pub(super) fn most(&self, other: &Self) -> Self {
        let ([x, y, z], [ox, oy, oz]) = (self.0, other.0);
        Self([x.max(ox), y.max(oy), z.max(oz)])
    }

    #[inline(always)]
    pub(super) fn abs(&self) -> Self {
        Self(self.0.map(Vec4::abs))
    }

    /// The largest coordinate of each.
    #[inline(always)]
    pub(super) fn largest(&self) -> Vec4 {
        let [x, y, z] = self.0;
        x.max(y).max(z)
    }
}

/// One of four numbers.
#[inline(always)]
pub(super) fn one(four: &Vec4, i: usize) -> f32 {
    let four: &[f32; 4] = four.as_ref();
    four[i % 4]
}

/// One of four numbers, four times.
#[inline(always)]
pub(super) fn all(four: &Vec4, i: usize) -> Vec4 {
    Vec4::splat(one(four, i))
}

/// Numbers of strands side by side in single precision.
#[inline(always)]
pub(super) fn single<T: Number>(numbers: T) -> Vec4 {
    let Lane([a, b, c, d]) = numbers.store();
    Vec4::new(a as f32, b as f32, c as f32, d as f32)
}
