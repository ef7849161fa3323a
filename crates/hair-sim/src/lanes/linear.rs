//! Vectors, matrices and rotations, of one strand or of a batch.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

use glam::{DQuat, DVec3};

use super::{
    lane::{Lane, Mask},
    number::{Number, stored},
};

/// Three coordinates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Vec3<T = Lane> {
    pub x: T,
    pub y: T,
    pub z: T,
}
stored!(Vec3 { x, y, z });

/// A symmetric 3 x 3 matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sym3<T = Lane> {
    pub xx: T,
    pub yy: T,
    pub zz: T,
    pub xy: T,
    pub xz: T,
    pub yz: T,
}
stored!(Sym3 {
    xx,
    yy,
    zz,
    xy,
    xz,
    yz
});

/// A 3 x 3 matrix, by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mat3<T = Lane>(pub Vec3<T>, pub Vec3<T>, pub Vec3<T>);
stored!(Mat3 { 0, 1, 2 });

/// A rotation as a unit quaternion.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Quat<T = Lane> {
    pub v: Vec3<T>,
    pub w: T,
}
stored!(Quat { v, w });

impl Vec3 {
    pub(crate) const ZERO: Self = Self::new(Lane::ZERO, Lane::ZERO, Lane::ZERO);

    #[inline(always)]
    pub(crate) fn splat(v: DVec3) -> Self {
        Self::new(Lane::splat(v.x), Lane::splat(v.y), Lane::splat(v.z))
    }

    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> DVec3 {
        DVec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, v: DVec3) {
        (self.x[lane], self.y[lane], self.z[lane]) = (v.x, v.y, v.z);
    }

    #[inline(always)]
    pub(crate) fn pick(mask: Mask, yes: Self, no: Self) -> Self {
        Self::new(
            mask.pick(yes.x, no.x),
            mask.pick(yes.y, no.y),
            mask.pick(yes.z, no.z),
        )
    }
}

impl<T: Number> Vec3<T> {
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        let zero = T::splat(0.0);
        Self::new(zero, zero, zero)
    }

    /// The same for all strands.
    #[inline(always)]
    pub(crate) fn all(v: DVec3) -> Self {
        Self::new(T::splat(v.x), T::splat(v.y), T::splat(v.z))
    }

    /// As [`Number::choose`].
    #[inline(always)]
    pub(crate) fn choose(condition: T::Condition, yes: Self, no: Self) -> Self {
        Self::new(
            T::choose(condition, yes.x, no.x),
            T::choose(condition, yes.y, no.y),
            T::choose(condition, yes.z, no.z),
        )
    }

    #[inline(always)]
    pub(crate) const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub(crate) fn dot(self, o: Self) -> T {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    #[inline(always)]
    pub(crate) fn cross(self, o: Self) -> Self {
        Self::new(
            self.y * o.z - self.z * o.y,
            self.z * o.x - self.x * o.z,
            self.x * o.y - self.y * o.x,
        )
    }

    #[inline(always)]
    pub(crate) fn length_squared(self) -> T {
        self.dot(self)
    }

    /// Times a number.
    #[inline(always)]
    pub(crate) fn scale(self, s: T) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}

impl<T: Number> Add for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl<T: Number> Sub for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl<T: Number> Neg for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl Mul<Lane> for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: Lane) -> Self {
        self.scale(s)
    }
}

impl<T: Number> Mul<f64> for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        self.scale(T::splat(s))
    }
}

impl<T: Number> AddAssign for Vec3<T> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<T: Number> Sym3<T> {
    #[inline(always)]
    pub(crate) fn diagonal(d: T) -> Self {
        let zero = T::splat(0.0);
        Self {
            xx: d,
            yy: d,
            zz: d,
            xy: zero,
            xz: zero,
            yz: zero,
        }
    }

    /// `d` on the diagonal, and `s` v v^T.
    #[inline(always)]
    pub(crate) fn outer(d: T, v: Vec3<T>, s: T) -> Self {
        let (sx, sy, sz) = (v.x * s, v.y * s, v.z * s);
        Self {
            xx: d + sx * v.x,
            yy: d + sy * v.y,
            zz: d + sz * v.z,
            xy: sx * v.y,
            xz: sx * v.z,
            yz: sy * v.z,
        }
    }

    /// Only the part above the diagonal of a product that is symmetric.
    #[inline(always)]
    pub(crate) fn upper_of_product(a: Mat3<T>, b: Mat3<T>) -> Self {
        let [bx, by, bz] = b.columns();
        Self {
            xx: a.0.dot(bx),
            yy: a.1.dot(by),
            zz: a.2.dot(bz),
            xy: a.0.dot(by),
            xz: a.0.dot(bz),
            yz: a.1.dot(bz),
        }
    }

    #[inline(always)]
    pub(crate) fn rows(self) -> Mat3<T> {
        Mat3(
            Vec3::new(self.xx, self.xy, self.xz),
            Vec3::new(self.xy, self.yy, self.yz),
            Vec3::new(self.xz, self.yz, self.zz),
        )
    }

    #[inline(always)]
    pub(crate) fn apply(self, v: Vec3<T>) -> Vec3<T> {
        self.rows().apply(v)
    }

    /// The inverse of a positive definite matrix: cofactors over the determinant, that by way of the complement of the first
    /// number. It needs one quotient, elimination three after each other. Where one direction is `n` times as stiff as
    /// the others, the error is 1e-16 n^2: 1e-9 for a contact in a step of 1/24 s.
    #[inline(always)]
    pub(crate) fn inverse(self) -> Self {
        let zz = self.xx * self.yy - self.xy * self.xy;
        let yz = self.xy * self.xz - self.xx * self.yz;
        let yy = self.xx * self.zz - self.xz * self.xz;
        let s = self.xx / (zz * yy - yz * yz);
        let xx = self.yy * self.zz - self.yz * self.yz;
        let xy = self.xz * self.yz - self.xy * self.zz;
        let xz = self.xy * self.yz - self.xz * self.yy;
        Self {
            xx: xx * s,
            yy: yy * s,
            zz: zz * s,
            xy: xy * s,
            xz: xz * s,
            yz: yz * s,
        }
    }
}

impl<T: Number> Add for Sym3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self {
            xx: self.xx + o.xx,
            yy: self.yy + o.yy,
            zz: self.zz + o.zz,
            xy: self.xy + o.xy,
            xz: self.xz + o.xz,
            yz: self.yz + o.yz,
        }
    }
}

impl<T: Number> Sub for Sym3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self {
            xx: self.xx - o.xx,
            yy: self.yy - o.yy,
            zz: self.zz - o.zz,
            xy: self.xy - o.xy,
            xz: self.xz - o.xz,
            yz: self.yz - o.yz,
        }
    }
}

impl<T: Number> AddAssign for Sym3<T> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<T: Number> Mat3<T> {
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self(Vec3::zero(), Vec3::zero(), Vec3::zero())
    }

    #[inline(always)]
    pub(crate) fn columns(self) -> [Vec3<T>; 3] {
        [
            Vec3::new(self.0.x, self.1.x, self.2.x),
            Vec3::new(self.0.y, self.1.y, self.2.y),
            Vec3::new(self.0.z, self.1.z, self.2.z),
        ]
    }

    #[inline(always)]
    pub(crate) fn transpose(self) -> Self {
        let [x, y, z] = self.columns();
        Self(x, y, z)
    }

    #[inline(always)]
    pub(crate) fn apply(self, v: Vec3<T>) -> Vec3<T> {
        Vec3::new(self.0.dot(v), self.1.dot(v), self.2.dot(v))
    }

    #[inline(always)]
    pub(crate) fn times(self, o: Self) -> Self {
        let to = o.transpose();
        Self(to.apply(self.0), to.apply(self.1), to.apply(self.2))
    }

    /// The matrix times (r x): the rows crossed with r.
    #[inline(always)]
    pub(crate) fn times_cross(self, r: Vec3<T>) -> Self {
        Self(self.0.cross(r), self.1.cross(r), self.2.cross(r))
    }
}

impl<T: Number> Sub for Mat3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.0, self.1 - o.1, self.2 - o.2)
    }
}

impl Quat {
    pub(crate) const IDENTITY: Self = Self {
        v: Vec3::ZERO,
        w: Lane::ONE,
    };

    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> DQuat {
        let v = self.v.get(lane);
        DQuat::from_xyzw(v.x, v.y, v.z, self.w[lane])
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, q: DQuat) {
        self.v.set(lane, DVec3::new(q.x, q.y, q.z));
        self.w[lane] = q.w;
    }

    #[inline(always)]
    pub(crate) fn pick(mask: Mask, yes: Self, no: Self) -> Self {
        Self {
            v: Vec3::pick(mask, yes.v, no.v),
            w: mask.pick(yes.w, no.w),
        }
    }
}

impl<T: Number> Quat<T> {
    #[inline(always)]
    pub(crate) fn identity() -> Self {
        Self {
            v: Vec3::zero(),
            w: T::splat(1.0),
        }
    }

    /// As [`Number::choose`].
    #[inline(always)]
    pub(crate) fn choose(condition: T::Condition, yes: Self, no: Self) -> Self {
        Self {
            v: Vec3::choose(condition, yes.v, no.v),
            w: T::choose(condition, yes.w, no.w),
        }
    }

    /// First `o`, then `self`.
    #[inline(always)]
    pub(crate) fn times(self, o: Self) -> Self {
        Self {
            v: o.v.scale(self.w) + self.v.scale(o.w) + self.v.cross(o.v),
            w: self.w * o.w - self.v.dot(o.v),
        }
    }

    #[inline(always)]
    pub(crate) fn conjugate(self) -> Self {
        Self {
            v: -self.v,
            w: self.w,
        }
    }

    #[inline(always)]
    pub(crate) fn normalize(self) -> Self {
        let s = T::splat(1.0) / (self.v.length_squared() + self.w * self.w).sqrt();
        Self {
            v: self.v.scale(s),
            w: self.w * s,
        }
    }

    /// The three axes of the frame: columns of the rotation matrix.
    #[inline(always)]
    pub(crate) fn axes(self) -> [Vec3<T>; 3] {
        let (v, w) = (self.v, self.w);
        let (x2, y2, z2) = (v.x + v.x, v.y + v.y, v.z + v.z);
        let (xx, yy, zz) = (v.x * x2, v.y * y2, v.z * z2);
        let (xy, xz, yz) = (v.x * y2, v.x * z2, v.y * z2);
        let (wx, wy, wz) = (w * x2, w * y2, w * z2);
        let one = T::splat(1.0);
        [
            Vec3::new(one - (yy + zz), xy + wz, xz - wy),
            Vec3::new(xy - wz, one - (xx + zz), yz + wx),
            Vec3::new(xz + wy, yz - wx, one - (xx + yy)),
        ]
    }

    /// The third axis: the tangent of a link.
    #[inline(always)]
    pub(crate) fn tangent(self) -> Vec3<T> {
        let (v, w) = (self.v, self.w);
        let (x2, y2) = (v.x + v.x, v.y + v.y);
        Vec3::new(
            x2 * v.z + w * y2,
            y2 * v.z - w * x2,
            T::splat(1.0) - (x2 * v.x + y2 * v.y),
        )
    }

    /// A vector of this frame in the world.
    #[inline(always)]
    pub(crate) fn rotate(self, u: Vec3<T>) -> Vec3<T> {
        let half = self.v.cross(u);
        let whole = half + half;
        u + whole.scale(self.w) + self.v.cross(whole)
    }

    /// Turned by the rotation whose Rodrigues vector (tan of the half angle along its axis) is half of `turn`.
    #[inline(always)]
    pub(crate) fn turned(self, turn: Vec3<T>) -> Self {
        let by = Self {
            v: turn * 0.5,
            w: T::splat(1.0),
        };
        by.times(self).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_undoes_its_matrix_however_uneven() {
        let v = Vec3::splat(DVec3::new(0.3, -0.7, 0.2));
        for uneven in [1e-4, 1e-2, 1.0, 1e8] {
            let matrix = Sym3::outer(Lane::splat(uneven), v, Lane::ONE);
            let got = matrix.apply(matrix.inverse().apply(v)).get(2);
            let error = (got - v.get(2)).length();
            // One stiff direction, as a contact makes it, is the worst.
            let bound = 1e-15 * (10.0 + 10.0 / (uneven * uneven));
            assert!(error < bound, "{uneven}: {error}");
        }
    }
}
