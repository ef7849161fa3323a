//! Where an object stands in the world of its scene.

use glam::{DVec3, Quat, Vec3};
use render::{Ball, Head, Light};
use std::ops::Range;
use stroke_path::{Camera, Paths, sin_cos_degrees};

/// A turn about the world's upward axis, and then a shift. An object is loaded, moved and simulated where its files have it, its
/// face towards +Z, and placed when it is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Placement {
    rotation: Quat,
    shift_m: Vec3,
}

impl Placement {
    /// Turned by degrees to its left, and shifted in metres.
    pub fn new(turn_degrees: f32, shift_m: Vec3) -> Self {
        let (sin, cos) = sin_cos_degrees(0.5 * f64::from(turn_degrees));
        Self {
            rotation: Quat::from_xyzw(0.0, sin as f32, 0.0, cos as f32),
            shift_m,
        }
    }

    /// Whether nothing is placed anywhere else, so that every number keeps its bits.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    pub fn point(&self, point: Vec3) -> Vec3 {
        match self.is_none() {
            true => point,
            false => self.rotation * point + self.shift_m,
        }
    }

    pub fn head(&self, head: Head) -> Head {
        Head {
            center: self.point(head.center),
            ..head
        }
    }

    pub fn ball(&self, ball: Ball) -> Ball {
        Ball {
            center: self.point(ball.center),
            ..ball
        }
    }

    /// A direction of the world, as the object has it.
    pub fn own_direction(&self, direction: DVec3) -> DVec3 {
        match self.is_none() {
            true => direction,
            false => self.rotation.as_dquat().inverse() * direction,
        }
    }

    /// The camera, as the object has it.
    pub fn own_camera(&self, camera: &Camera) -> Camera {
        match self.is_none() {
            true => *camera,
            false => camera.seen_from(self.rotation, self.shift_m),
        }
    }

    /// The light, as the object has it.
    pub fn own_light(&self, light: Light) -> Light {
        if self.is_none() {
            return light;
        }
        let back = self.rotation.inverse();
        match light {
            Light::Direction(direction) => Light::Direction(back * direction),
            Light::Point(place) => Light::Point(back * (place - self.shift_m)),
        }
    }

    /// Turns directions of the object's own.
    pub fn turn(&self, directions: &mut [Vec3]) {
        if !self.is_none() {
            for direction in directions {
                *direction = self.rotation * *direction;
            }
        }
    }

    /// Places joints that a camera of the object's own has seen, and their normals.
    pub fn joints(&self, paths: &mut Paths, joints: Range<usize>, normals: &mut [Vec3]) {
        if self.is_none() {
            return;
        }
        paths.place(joints, self.rotation, self.shift_m);
        for normal in normals {
            *normal = self.rotation * *normal;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stroke_path::{OrbitView, PathKind};

    #[test]
    fn a_turn_to_the_left_faces_the_characters_left() {
        let placement = Placement::new(90.0, Vec3::new(0.0, 0.0, 2.0));
        let place = placement.point(Vec3::Z);
        assert!(place.distance(Vec3::new(1.0, 0.0, 2.0)) < 1e-6, "{place}");
        assert!(placement.own_direction(DVec3::X).distance(DVec3::Z) < 1e-6);
        assert!(Placement::new(0.0, Vec3::ZERO).is_none());
    }

    /// What an own camera sees of an object is what the camera sees of the object in its place.
    #[test]
    fn placed_joints_are_seen_as_they_were() {
        let view = OrbitView {
            target: Vec3::new(0.1, 1.5, 0.0),
            yaw_degrees: 30.0,
            pitch_degrees: -20.0,
            distance_m: 1.3,
            vertical_fov_degrees: 40.0,
        };
        let camera = Camera::orbit(view, [320, 240], 0.01).unwrap();
        let placement = Placement::new(-70.0, Vec3::new(0.3, 0.1, -0.2));
        let points = [[0.0, 1.6, 0.1], [0.05, 1.5, 0.12], [0.2, 1.4, 0.1]].map(Vec3::from);
        let kind = PathKind::CatmullRom { subdivision: 3 };
        let (mut own, mut world) = (Paths::new(), Paths::new());
        let seen = placement.own_camera(&camera);
        own.push_strand(0, &points, kind, &seen).unwrap();
        placement.joints(&mut own, 0..7, &mut []);
        let placed = points.map(|point| placement.point(point));
        world.push_strand(0, &placed, kind, &camera).unwrap();
        for i in 0..7 {
            assert!(own.center[i].distance(world.center[i]) < 1e-3);
            assert!((own.depth[i] - world.depth[i]).abs() < 1e-5);
            assert!(own.position[i].distance(world.position[i]) < 1e-6);
            assert!(own.forward[i].distance(world.forward[i]) < 1e-5);
            assert!(own.backward[i].distance(world.backward[i]) < 1e-5);
        }
    }
}
