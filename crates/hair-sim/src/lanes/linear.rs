//! Vectors, matrices and rotations of lanes.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

use glam::{DQuat, DVec3};

use super::{Lane, Mask};

/// Three coordinates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Vec3 {
    pub x: Lane,
    pub y: Lane,
    pub z: Lane,
}

/// A symmetric 3 x 3 matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sym3 {
    pub xx: Lane,
    pub yy: Lane,
    pub zz: Lane,
    pub xy: Lane,
    pub xz: Lane,
    pub yz: Lane,
}

/// A 3 x 3 matrix, by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mat3(pub Vec3, pub Vec3, pub Vec3);

/// A rotation as a unit quaternion.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Quat {
    pub v: Vec3,
    pub w: Lane,
}

impl Vec3 {
    pub(crate) const ZERO: Self = Self::new(Lane::ZERO, Lane::ZERO, Lane::ZERO);

    #[inline(always)]
    pub(crate) const fn new(x: Lane, y: Lane, z: Lane) -> Self {
        Self { x, y, z }
    }

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
    pub(crate) fn dot(self, o: Self) -> Lane {
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
    pub(crate) fn length_squared(self) -> Lane {
        self.dot(self)
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

impl Add for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl Sub for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl Neg for Vec3 {
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
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}

impl Mul<f64> for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}

impl AddAssign for Vec3 {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Sym3 {
    pub(crate) const ZERO: Self = Self::diagonal(Lane::ZERO);

    #[inline(always)]
    pub(crate) const fn diagonal(d: Lane) -> Self {
        Self {
            xx: d,
            yy: d,
            zz: d,
            xy: Lane::ZERO,
            xz: Lane::ZERO,
            yz: Lane::ZERO,
        }
    }

    /// `s` v v^T.
    #[inline(always)]
    pub(crate) fn outer(v: Vec3, s: Lane) -> Self {
        let (sx, sy, sz) = (v.x * s, v.y * s, v.z * s);
        Self {
            xx: sx * v.x,
            yy: sy * v.y,
            zz: sz * v.z,
            xy: sx * v.y,
            xz: sx * v.z,
            yz: sy * v.z,
        }
    }

    /// Only the part above the diagonal of a product that is symmetric.
    #[inline(always)]
    pub(crate) fn upper_of_product(a: Mat3, b: Mat3) -> Self {
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
    pub(crate) fn rows(self) -> Mat3 {
        Mat3(
            Vec3::new(self.xx, self.xy, self.xz),
            Vec3::new(self.xy, self.yy, self.yz),
            Vec3::new(self.xz, self.yz, self.zz),
        )
    }

    #[inline(always)]
    pub(crate) fn apply(self, v: Vec3) -> Vec3 {
        self.rows().apply(v)
    }

    /// The inverse of a positive definite matrix, by its factors L D L^T.
    #[inline(always)]
    pub(crate) fn inverse(self) -> Self {
        let i0 = self.xx.recip();
        let (l1, l2) = (self.xy * i0, self.xz * i0);
        let d1 = self.yy - l1 * self.xy;
        let i1 = d1.recip();
        let e = self.yz - l1 * self.xz;
        let l3 = e * i1;
        let i2 = (self.zz - l2 * self.xz - l3 * e).recip();
        // Rows of L^-1: (1), (-l1, 1), (m, -l3, 1).
        let m = l1 * l3 - l2;
        let (m2, l3_2) = (m * i2, l3 * i2);
        Self {
            xx: i0 + l1 * l1 * i1 + m * m2,
            yy: i1 + l3 * l3_2,
            zz: i2,
            xy: -(l1 * i1) - m2 * l3,
            xz: m2,
            yz: -l3_2,
        }
    }
}

impl Add for Sym3 {
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

impl Sub for Sym3 {
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

impl AddAssign for Sym3 {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Mat3 {
    pub(crate) const ZERO: Self = Self(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);

    #[inline(always)]
    pub(crate) fn columns(self) -> [Vec3; 3] {
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
    pub(crate) fn apply(self, v: Vec3) -> Vec3 {
        Vec3::new(self.0.dot(v), self.1.dot(v), self.2.dot(v))
    }

    #[inline(always)]
    pub(crate) fn times(self, o: Self) -> Self {
        let to = o.transpose();
        Self(to.apply(self.0), to.apply(self.1), to.apply(self.2))
    }

    /// The same, of the transpose.
    #[inline(always)]
    pub(crate) fn combine(self, v: Vec3) -> Vec3 {
        self.0 * v.x + self.1 * v.y + self.2 * v.z
    }

    /// The matrix times (r x): the rows crossed with r.
    #[inline(always)]
    pub(crate) fn times_cross(self, r: Vec3) -> Self {
        Self(self.0.cross(r), self.1.cross(r), self.2.cross(r))
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

    /// First `o`, then `self`.
    #[inline(always)]
    pub(crate) fn times(self, o: Self) -> Self {
        Self {
            v: o.v * self.w + self.v * o.w + self.v.cross(o.v),
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
        let s = (self.v.length_squared() + self.w * self.w).sqrt().recip();
        Self {
            v: self.v * s,
            w: self.w * s,
        }
    }

    /// The three axes of the frame: columns of the rotation matrix.
    #[inline(always)]
    pub(crate) fn axes(self) -> [Vec3; 3] {
        let (v, w) = (self.v, self.w);
        let (x2, y2, z2) = (v.x + v.x, v.y + v.y, v.z + v.z);
        let (xx, yy, zz) = (v.x * x2, v.y * y2, v.z * z2);
        let (xy, xz, yz) = (v.x * y2, v.x * z2, v.y * z2);
        let (wx, wy, wz) = (w * x2, w * y2, w * z2);
        let one = Lane::ONE;
        [
            Vec3::new(one - (yy + zz), xy + wz, xz - wy),
            Vec3::new(xy - wz, one - (xx + zz), yz + wx),
            Vec3::new(xz + wy, yz - wx, one - (xx + yy)),
        ]
    }

    /// The third axis: the tangent of a link.
    #[inline(always)]
    pub(crate) fn tangent(self) -> Vec3 {
        let (v, w) = (self.v, self.w);
        let (x2, y2) = (v.x + v.x, v.y + v.y);
        Vec3::new(
            x2 * v.z + w * y2,
            y2 * v.z - w * x2,
            Lane::ONE - (x2 * v.x + y2 * v.y),
        )
    }

    /// The least rotation of this frame that points its third axis along the unit vector `to`. Where the two
    /// are nearly opposite the frame stays.
    #[inline(always)]
    pub(crate) fn pointed(self, to: Vec3) -> Self {
        let from = self.tangent();
        let w = from.dot(to) + 1.0;
        let turned = Self {
            v: from.cross(to),
            w,
        };
        Self::pick(
            w.gt(Lane::splat(0.05)),
            turned.times(self).normalize(),
            self,
        )
    }

    /// Turned by the rotation whose Rodrigues vector (tan of the half angle along its axis) is half of `turn`.
    #[inline(always)]
    pub(crate) fn turned(self, turn: Vec3) -> Self {
        let by = Self {
            v: turn * 0.5,
            w: Lane::ONE,
        };
        by.times(self).normalize()
    }

    #[inline(always)]
    pub(crate) fn pick(mask: Mask, yes: Self, no: Self) -> Self {
        Self {
            v: Vec3::pick(mask, yes.v, no.v),
            w: mask.pick(yes.w, no.w),
        }
    }
}
