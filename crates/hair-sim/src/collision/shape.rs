//! Bodies that hair cannot enter.

use glam::DVec3;

use crate::pose::Pose;

use super::grid::SignedDistance;

/// A body in its own space.
#[derive(Clone, Copy, Debug)]
pub enum Shape<'a> {
    /// A ball.
    Sphere {
        /// In m.
        center: DVec3,
        /// In m, 0 or more.
        radius: f64,
    },
    /// All that is within `radius` of the line from one end to the other.
    Capsule {
        /// One end, in m.
        from: DVec3,
        /// The other end.
        to: DVec3,
        /// In m, 0 or more.
        radius: f64,
    },
    /// A closed mesh, by its distances on a grid.
    Grid(&'a SignedDistance),
}

/// A body and how it moves in a step.
#[derive(Clone, Copy, Debug)]
pub struct Collider<'a> {
    /// In its own space.
    pub shape: Shape<'a>,
    /// Where it is in the world when the step starts.
    pub before: Pose,
    /// And when it ends.
    pub now: Pose,
}

impl<'a> Collider<'a> {
    /// A body that stays where it is.
    #[must_use]
    pub fn fixed(shape: Shape<'a>, pose: Pose) -> Self {
        Self {
            shape,
            before: pose,
            now: pose,
        }
    }

    pub(crate) fn is_finite(&self) -> bool {
        let shape = match self.shape {
            Shape::Sphere { center, radius } => {
                center.is_finite() && radius.is_finite() && radius >= 0.0
            }
            Shape::Capsule { from, to, radius } => {
                from.is_finite() && to.is_finite() && radius.is_finite() && radius >= 0.0
            }
            Shape::Grid(_) => true,
        };
        shape && self.before.is_finite() && self.now.is_finite()
    }
}

impl Shape<'_> {
    /// Distance from the surface in m, negative inside; never more than the true one by more than a grid's error.
    #[inline]
    pub(crate) fn distance(&self, at: DVec3) -> f64 {
        match self {
            Self::Sphere { center, radius } => (at - *center).length() - radius,
            Self::Capsule { from, to, radius } => {
                (at - nearest_on_line(*from, *to, at)).length() - radius
            }
            Self::Grid(grid) => grid.distance(at),
        }
    }

    /// Centre and radius of a ball around it.
    pub(crate) fn ball(&self) -> (DVec3, f64) {
        match self {
            Self::Sphere { center, radius } => (*center, *radius),
            Self::Capsule { from, to, radius } => {
                ((*from + *to) * 0.5, radius + 0.5 * (*to - *from).length())
            }
            Self::Grid(grid) => grid.ball(),
        }
    }

    /// Numbers that tell it from other shapes.
    pub(crate) fn numbers(&self) -> [DVec3; 3] {
        match self {
            Self::Sphere { center, radius } => [*center, DVec3::splat(*radius), DVec3::ZERO],
            Self::Capsule { from, to, radius } => [*from, *to, DVec3::splat(*radius)],
            Self::Grid(grid) => grid.numbers(),
        }
    }

    /// The direction away from the surface, a unit vector.
    pub(crate) fn normal(&self, at: DVec3) -> DVec3 {
        let away = match self {
            Self::Sphere { center, .. } => at - *center,
            Self::Capsule { from, to, .. } => at - nearest_on_line(*from, *to, at),
            Self::Grid(grid) => grid.gradient(at),
        };
        away.normalize_or(DVec3::Y)
    }
}

fn nearest_on_line(from: DVec3, to: DVec3, at: DVec3) -> DVec3 {
    let along = to - from;
    let squared = along.length_squared();
    if squared == 0.0 {
        return from;
    }
    from + along * ((at - from).dot(along) / squared).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_balls_and_capsules() {
        let ball = Shape::Sphere {
            center: DVec3::X,
            radius: 0.5,
        };
        assert!((ball.distance(DVec3::X * 3.0) - 1.5).abs() < 1e-15);
        assert!((ball.distance(DVec3::X) + 0.5).abs() < 1e-15);
        assert_eq!(ball.normal(DVec3::X * 3.0), DVec3::X);
        assert!(ball.normal(DVec3::X).is_normalized());
        let capsule = Shape::Capsule {
            from: DVec3::ZERO,
            to: DVec3::Y,
            radius: 0.1,
        };
        assert!((capsule.distance(DVec3::new(0.3, 0.5, 0.0)) - 0.2).abs() < 1e-15);
        assert!((capsule.distance(DVec3::new(0.0, 1.5, 0.0)) - 0.4).abs() < 1e-15);
    }
}
