//! What is near a body in a step, and which roots are in it, by little work.

use glam::{DMat3, DVec3};

use crate::{
    collision::shape::{Collider, Shape},
    lanes::{Lane, Mask, Number, Vec3},
};

use super::NEAR;

/// A ball around a body, and how the body moves in a step: what lies far off is known by this alone.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    center: DVec3,
    radius: f64,
    /// From where something was, as the body carries it along: `carry` times the place, and `shift`.
    carry: DMat3,
    shift: DVec3,
    /// From the world to the body's own space when the step ends.
    back: DMat3,
    origin: DVec3,
    /// How far the fastest place of the body's surface goes in the step, in m.
    way: f64,
    /// Whether links between particles count.
    pub(super) has_links: bool,
}

impl Guard {
    pub(crate) fn new(collider: &Collider) -> Self {
        let (center, radius) = collider.shape.ball();
        let (before, now) = (collider.before, collider.now);
        let carry = DMat3::from_quat(now.rotation) * DMat3::from_quat(before.rotation).transpose();
        let shift = now.translation - carry * before.translation;
        let center = now.to_world(center);
        let moved = center.distance(carry.transpose() * (center - shift));
        Self {
            center,
            radius,
            carry,
            shift,
            way: moved + turn(carry) * radius + collider.changed(),
            back: DMat3::from_quat(now.rotation).transpose(),
            origin: now.translation,
            has_links: !collider.shape.is_sampled(),
        }
    }

    /// How far the fastest place of the body's surface goes in the step, in m, as the body moves, turns about its middle and changes its shape: no less than the
    /// truth where it keeps its shape, and about as much where it changes.
    pub(crate) fn way(&self) -> f64 {
        self.way
    }

    /// Whether particles that go from `from` to `to` and keep `keep` may come near the body. A little more than
    /// [`Path::against`](super::path::Path::against) asks for, which has the last word.
    #[inline(always)]
    pub(super) fn is_near<T: Number>(&self, from: Vec3<T>, to: Vec3<T>, keep: T) -> Mask {
        let reach = self.reach(from, to, keep) + T::splat(self.radius);
        let apart = (to - Vec3::all(self.center)).length_squared().sqrt();
        // NaN is near.
        reach.store().lt(apart.store()).not()
    }

    /// The same by the distances of a body that has them on a grid, too: `shape` is its shape when the step ends.
    #[inline(always)]
    pub(super) fn is_near_to<T: Number>(
        &self,
        shape: &Shape,
        from: Vec3<T>,
        to: Vec3<T>,
        keep: T,
    ) -> Mask {
        let near = self.is_near(from, to, keep);
        let Shape::Grid(grid) = shape else {
            return near;
        };
        if !near.any() {
            return near;
        }
        let at = turned(&self.back, to - Vec3::all(self.origin));
        let apart = grid.distances(at).store();
        near.and(self.reach(from, to, keep).store().lt(apart).not())
    }

    /// How far roots in the body are from its surface, in m, less than 0. Of those outside, and of all where links don't count for it, as most roots
    /// are in the mesh of their head: infinity.
    #[inline(always)]
    pub(super) fn depths<T: Number>(&self, roots: Vec3, shape: &Shape) -> Lane {
        let far = Lane::splat(f64::INFINITY);
        if !self.has_links {
            return far;
        }
        let roots: Vec3<T> = roots.load();
        let apart = (roots - Vec3::all(self.center)).length_squared().store();
        let inside = apart.gt(Lane::splat(self.radius * self.radius)).not();
        if !inside.any() {
            return far;
        }
        let at = turned(&self.back, roots - Vec3::all(self.origin)).store();
        let distances = Lane(std::array::from_fn(|lane| shape.distance(at.get(lane))));
        distances.lt(Lane::ZERO).pick(distances, far)
    }

    /// How far from where it ends a particle may meet the body's surface.
    #[inline(always)]
    fn reach<T: Number>(&self, from: Vec3<T>, to: Vec3<T>, keep: T) -> T {
        const MARGIN: f64 = 1e-6;
        let carried = Vec3::all(self.shift) + turned(&self.carry, from);
        let way = (to - carried).length_squared().sqrt();
        way + keep + T::splat(NEAR + MARGIN)
    }
}

#[inline(always)]
fn turned<T: Number>(by: &DMat3, v: Vec3<T>) -> Vec3<T> {
    Vec3::all(by.x_axis).scale(v.x)
        + Vec3::all(by.y_axis).scale(v.y)
        + Vec3::all(by.z_axis).scale(v.z)
}

/// How far a rotation moves what lies one metre from its axis, in m.
fn turn(rotation: DMat3) -> f64 {
    let change = rotation - DMat3::IDENTITY;
    let squares = change.to_cols_array().map(|number| number * number);
    (squares.iter().sum::<f64>() / 2.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::{PUSH_OUT, path::Path};
    use super::*;
    use crate::{SignedDistance, pose::Pose};
    use glam::DQuat;

    const NOW: Pose = Pose {
        rotation: DQuat::from_xyzw(0.0, 0.6, 0.0, 0.8),
        translation: DVec3::new(0.02, 0.25, 0.01),
    };
    const FAR: Pose = Pose {
        rotation: DQuat::from_xyzw(0.28, 0.0, 0.0, 0.96),
        translation: DVec3::new(0.0, 0.3, 0.0),
    };

    #[test]
    fn a_ball_around_a_body_hides_nothing_that_the_body_meets() {
        let capsule = Shape::Capsule {
            from: DVec3::new(-0.1, 0.0, 0.05),
            to: DVec3::new(0.2, 0.1, 0.0),
            radius: 0.05,
        };
        let (met, hidden) = met_and_hidden((capsule, FAR), |guard, [from, to], keep| {
            guard.is_near(from, to, keep).get(0)
        });
        assert!(met > 1000 && hidden > 1000, "{met} {hidden}");
    }

    #[test]
    fn a_grid_hides_nothing_that_its_body_meets() {
        // A tetrahedron.
        let points = [
            glam::Vec3::ZERO,
            glam::Vec3::X,
            glam::Vec3::Y,
            glam::Vec3::Z,
        ];
        let points = points.map(|point| point * 0.8 - 0.3);
        let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let grid = SignedDistance::new(&points, &triangles, 0.02).unwrap();
        let shape = Shape::Grid(&grid);
        let near = Pose {
            translation: NOW.translation + DVec3::new(0.005, 0.0, 0.01),
            ..NOW
        };
        let (met, hidden) = met_and_hidden((shape, near), |guard, [from, to], keep| {
            // Far away a grid says less than it could, and the ball around it more.
            let is_in_ball = guard.is_near(from, to, keep).get(0);
            !is_in_ball || guard.is_near_to(&shape, from, to, keep).get(0)
        });
        assert!(met > 500 && hidden > 1000, "{met} {hidden}");
    }

    #[test]
    fn the_way_of_a_body_is_that_of_its_fastest_place() {
        let ball = |radius| Shape::Sphere {
            center: DVec3::X * 0.3,
            radius,
        };
        let pose = |angle: f64, y: f64| Pose {
            rotation: DQuat::from_rotation_x(angle),
            translation: DVec3::Y * y,
        };
        let way = |before, was| {
            let collider = Collider {
                shape: ball(0.1),
                before,
                now: pose(0.0, 0.0),
                was,
            };
            Guard::new(&collider).way()
        };
        let still = way(pose(0.0, 0.0), None);
        let goes = way(pose(0.0, 0.02), None);
        // About an axis through its middle, by a chord of the angle.
        let turns = way(pose(0.5, 0.0), None);
        let grows = way(pose(0.0, 0.0), Some(ball(0.07)));
        let shifts = way(
            pose(0.0, 0.0),
            Some(Shape::Sphere {
                center: DVec3::X * 0.25,
                radius: 0.1,
            }),
        );
        assert_eq!(still, 0.0);
        for (way, truth) in [
            (goes, 0.02),
            (turns, 0.2 * 0.25_f64.sin()),
            (grows, 0.03),
            (shifts, 0.05),
        ] {
            assert!((way - truth).abs() < 1e-9, "{way} for {truth}");
        }
        let both = way(pose(0.5, 0.02), Some(ball(0.07)));
        assert!((both - goes - turns - grows).abs() < 1e-9, "{both}");
    }

    /// How many of some paths meet a body that comes from a pose, and how many `is_near` hides, of which none may meet it.
    fn met_and_hidden(
        (shape, before): (Shape, Pose),
        is_near: impl Fn(&Guard, [Vec3; 2], Lane) -> bool,
    ) -> (usize, usize) {
        let collider = Collider {
            shape,
            before,
            now: NOW,
            was: None,
        };
        let guard = Guard::new(&collider);
        let (mut met, mut hidden) = (0, 0);
        for i in 0..20_000 {
            let spread = |k: i32| f64::from((i * 7919 + k * 104_729) % 1009) / 1009.0 - 0.5;
            let from = DVec3::new(spread(1), spread(2) + 0.3, spread(3));
            let to = from + DVec3::new(spread(4), spread(5), spread(6)) * 0.05;
            let path = Path {
                from,
                to,
                keep: 1e-3,
                push_out: PUSH_OUT,
                lift: 0.0,
                leads_out: 0.0,
                way_out: None,
                dt: 0.01,
            };
            let keep = Lane::splat(path.keep);
            let near = is_near(&guard, [from, to].map(Vec3::splat), keep);
            let meets = path.against(&collider).is_some();
            assert!(near || !meets, "{from} {to}");
            met += usize::from(meets);
            hidden += usize::from(!near);
        }
        (met, hidden)
    }
}
