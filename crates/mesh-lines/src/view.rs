//! From where a surface is seen, and what lies beside what in the image.

use crate::MeshError;
use glam::{DVec3, Vec3};

/// From where a surface is seen: an eye at a place, or infinitely far away.
///
/// There is no picture here, nor a direction in which the eye looks: what it sees is the sphere of all directions, of radius 1, and of an eye infinitely far
/// away the plane across the line of sight. Lengths *in the image* are those of chords of that sphere (near to radians where short), and lengths on that
/// plane. A pixel in the middle of a picture is `1 / focal length in pixels` long. Nothing is cut away near the eye or behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View(Eye);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Eye {
    At(DVec3),
    /// Unit vector.
    Towards(DVec3),
}

impl View {
    /// An eye at a place, in the mesh's coordinates.
    ///
    /// # Errors
    ///
    /// When a number isn't finite.
    pub fn perspective(eye: Vec3) -> Result<Self, MeshError> {
        finite(eye).map(|eye| Self(Eye::At(eye)))
    }

    /// An eye infinitely far away in a direction, of any length.
    ///
    /// # Errors
    ///
    /// When a number isn't finite, or all are 0.
    pub fn orthographic(to_eye: Vec3) -> Result<Self, MeshError> {
        let direction = finite(to_eye)?.try_normalize();
        let direction = direction.ok_or(MeshError::NoDirection)?;
        Ok(Self(Eye::Towards(direction)))
    }

    /// c: from a point towards the eye. As long as the way, or of length 1 where the eye is infinitely far away.
    #[inline]
    #[must_use]
    pub fn towards(&self, point: DVec3) -> DVec3 {
        match self.0 {
            Eye::At(eye) => eye - point,
            Eye::Towards(direction) => direction,
        }
    }

    /// Where a point is in the image: a unit vector from the eye (0 for the eye itself), or the point's place in the plane across the line of sight.
    #[must_use]
    pub fn image(&self, point: DVec3) -> DVec3 {
        match self.0 {
            Eye::At(eye) => (point - eye).normalize_or_zero(),
            Eye::Towards(direction) => point - direction * direction.dot(point),
        }
    }

    /// How far two points are from each other in the image.
    #[must_use]
    pub fn image_distance(&self, a: DVec3, b: DVec3) -> f64 {
        self.image(a).distance(self.image(b))
    }

    /// How long a short length across the line of sight is in the image, at a point. Infinite at the eye.
    #[must_use]
    pub fn image_scale(&self, point: DVec3) -> f64 {
        match self.0 {
            Eye::At(eye) => point.distance(eye).recip(),
            Eye::Towards(_) => 1.0,
        }
    }

    pub(crate) fn is_perspective(&self) -> bool {
        matches!(self.0, Eye::At(_))
    }

    /// How far it is to the eye, in lengths of [`Self::towards`].
    pub(crate) fn way(&self) -> f64 {
        match self.0 {
            Eye::At(_) => 1.0,
            Eye::Towards(_) => f64::INFINITY,
        }
    }

    /// On which side of the line from `a` to `b` the eye sees `c`: the sign is what counts, 0 for points in one plane with the eye.
    #[inline]
    pub(crate) fn side(&self, a: DVec3, b: DVec3, c: DVec3) -> f64 {
        match self.0 {
            Eye::At(eye) => (a - eye).cross(b - eye).dot(c - eye),
            Eye::Towards(direction) => (b - a).cross(c - a).dot(direction),
        }
    }

    /// How much farther from the eye `p` is than `q`, two points at one place of the image; nothing if they are at opposite places.
    pub(crate) fn farther(&self, p: DVec3, q: DVec3) -> Option<f64> {
        match self.0 {
            Eye::At(eye) => {
                let same_side = (p - eye).dot(q - eye) > 0.0;
                same_side.then(|| p.distance(eye) - q.distance(eye))
            }
            Eye::Towards(direction) => Some(direction.dot(q - p)),
        }
    }
}

fn finite(place: Vec3) -> Result<DVec3, MeshError> {
    let error = MeshError::NotFinite {
        what: "eye",
        index: 0,
    };
    if place.is_finite() {
        Ok(place.as_dvec3())
    } else {
        Err(error)
    }
}
