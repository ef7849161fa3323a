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
    /// A closed mesh on its way from one form to another, `size` times as large: its distances are the mean of theirs.
    Form {
        /// The form that it leaves.
        from: &'a SignedDistance,
        /// The form that it comes to.
        to: &'a SignedDistance,
        /// How much of the way it has gone, 0 to 1.
        share: f64,
        /// Above 0.
        size: f64,
    },
    /// A closed mesh that deforms, by its distances when the step starts and when it ends; in between they change evenly.
    ///
    /// ```
    /// use glam::{DVec3, Vec3};
    /// use hair_sim::{Collider, Params, Pose, Shape, SignedDistance, Solver, Strands, Surroundings};
    ///
    /// // A box that bulges upwards, and a strand over it.
    /// let bulged = |by: f32| {
    ///     let corner = |i: u32| {
    ///         let side = |bit: u32| if i & bit == 0 { -0.1_f32 } else { 0.1 };
    ///         Vec3::new(side(1), if i & 2 == 0 { -0.1 } else { 0.1 + by }, side(4))
    ///     };
    ///     let points: Vec<Vec3> = (0..8).map(corner).collect();
    ///     let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ///     let triangles: Vec<[u32; 3]> = (faces.iter())
    ///         .flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]])
    ///         .collect();
    ///     SignedDistance::new(&points, &triangles, 0.02).expect("a closed mesh")
    /// };
    /// let mut rest = Strands::new();
    /// let points: Vec<Vec3> = (0..=10).map(|i| Vec3::new(-0.05 + 0.01 * i as f32, 0.12, 0.0)).collect();
    /// rest.push(0, &points, None).expect("finite points");
    /// let (mut solver, mut state) = Solver::new(&rest, &Params::default())?;
    /// let mut before = bulged(0.0);
    /// for step in 1..=10 {
    ///     let now = bulged(0.005 * step as f32);
    ///     let shape = Shape::Deforming { before: &before, now: &now };
    ///     let bodies = [Collider::fixed(shape, Pose::IDENTITY)];
    ///     let surroundings = Surroundings { colliders: &bodies, ..Surroundings::default() };
    ///     solver.step(&mut state, &surroundings, 1.0 / 60.0)?;
    ///     before = now;
    /// }
    /// // It is lifted by the box, which is 0.15 m high now.
    /// assert!(solver.points(&state, 0).skip(2).all(|point: DVec3| point.y > 0.15));
    /// # Ok::<(), hair_sim::DynamicsError>(())
    /// ```
    Deforming {
        /// When the step starts.
        before: &'a SignedDistance,
        /// When it ends.
        now: &'a SignedDistance,
    },
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

    /// The distance of a place in the world from its surface when the step ends, in m, negative inside; never more than the true one by
    /// more than a grid's error.
    #[must_use]
    pub fn distance(&self, at: DVec3) -> f64 {
        self.shape.distance(self.now.to_local(at))
    }

    /// The way out of it at a place in the world when the step ends, a unit vector.
    #[must_use]
    pub fn outwards(&self, at: DVec3) -> DVec3 {
        self.now.rotation * self.shape.normal(self.now.to_local(at))
    }

    /// Whether it moves in the step, as a whole or by its shape.
    pub(crate) fn moves(&self) -> bool {
        let deforms = match self.shape {
            Shape::Deforming { before, now } => before.numbers() != now.numbers(),
            _ => false,
        };
        deforms || self.before != self.now
    }

    pub(crate) fn is_finite(&self) -> bool {
        let shape = match self.shape {
            Shape::Sphere { center, radius } => {
                center.is_finite() && radius.is_finite() && radius >= 0.0
            }
            Shape::Capsule { from, to, radius } => {
                from.is_finite() && to.is_finite() && radius.is_finite() && radius >= 0.0
            }
            Shape::Grid(_) | Shape::Deforming { .. } => true,
            Shape::Form { share, size, .. } => {
                (0.0..=1.0).contains(&share) && size.is_finite() && size > 0.0
            }
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
            Self::Form {
                from,
                to,
                share,
                size,
            } => {
                let at = at / *size;
                size * mix(|form| form.distance(at), [from, to], *share)
            }
            Self::Grid(grid) | Self::Deforming { now: grid, .. } => grid.distance(at),
        }
    }

    /// The same when the step starts.
    #[inline]
    pub(crate) fn distance_before(&self, at: DVec3) -> f64 {
        match self {
            Self::Deforming { before, .. } => before.distance(at),
            _ => self.distance(at),
        }
    }

    /// The same at a share of the step.
    #[inline]
    pub(crate) fn distance_at(&self, at: DVec3, share: f64) -> f64 {
        match self {
            Self::Deforming { before, now } => {
                let (before, now) = (before.distance(at), now.distance(at));
                before + (now - before) * share
            }
            _ => self.distance(at),
        }
    }

    /// How much the distance of a place changes in the step.
    #[inline]
    pub(crate) fn change(&self, at: DVec3) -> f64 {
        match self {
            Self::Deforming { before, now } => now.distance(at) - before.distance(at),
            _ => 0.0,
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
            Self::Form { from, to, size, .. } => {
                let [(center, radius), (other, other_radius)] = [from, to].map(|grid| grid.ball());
                let radius = radius.max(center.distance(other) + other_radius);
                (center * *size, radius * size)
            }
            Self::Deforming { before, now } => {
                let ((from, one), (to, other)) = (before.ball(), now.ball());
                (
                    (from + to) * 0.5,
                    one.max(other) + 0.5 * (to - from).length(),
                )
            }
        }
    }

    /// Numbers that tell it from other shapes.
    pub(crate) fn numbers(&self) -> [DVec3; 3] {
        match self {
            Self::Sphere { center, radius } => [*center, DVec3::splat(*radius), DVec3::ZERO],
            Self::Capsule { from, to, radius } => [*from, *to, DVec3::splat(*radius)],
            Self::Form {
                from,
                to,
                share,
                size,
            } => {
                let [from, to] = [from, to].map(|grid| grid.numbers());
                [
                    from[0] + to[0] * 3.0,
                    from[2] + to[2] * 3.0,
                    DVec3::new(*share, *size, 2.0),
                ]
            }
            Self::Grid(grid) | Self::Deforming { now: grid, .. } => grid.numbers(),
        }
    }

    /// The direction away from the surface when the step starts.
    pub(crate) fn normal_before(&self, at: DVec3) -> DVec3 {
        match self {
            Self::Deforming { before, .. } => Shape::Grid(before).normal(at),
            _ => self.normal(at),
        }
    }

    /// The direction away from the surface, a unit vector.
    pub(crate) fn normal(&self, at: DVec3) -> DVec3 {
        let away = match self {
            Self::Sphere { center, .. } => at - *center,
            Self::Capsule { from, to, .. } => at - nearest_on_line(*from, *to, at),
            Self::Form {
                from,
                to,
                share,
                size,
            } => {
                let at = at / *size;
                mix(|form| form.gradient(at), [from, to], *share)
            }
            Self::Grid(grid) | Self::Deforming { now: grid, .. } => grid.gradient(at),
        };
        away.normalize_or(DVec3::Y)
    }
}

/// What `of` says of two forms, mixed.
fn mix<T>(of: impl Fn(&SignedDistance) -> T, forms: [&SignedDistance; 2], share: f64) -> T
where
    T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    match share {
        0.0 => of(forms[0]),
        1.0 => of(forms[1]),
        _ => of(forms[0]) * (1.0 - share) + of(forms[1]) * share,
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
