//! Where light comes from.

use glam::Vec3;

/// The light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// The unit vector towards it, in the world.
    Direction(Vec3),
    /// Its place in the world, metres.
    Point(Vec3),
}

impl Light {
    /// The unit vector from `point` to the light, and the distance in metres.
    #[inline]
    #[must_use]
    pub fn seen_from(&self, point: Vec3) -> (Vec3, Option<f32>) {
        match *self {
            Self::Direction(direction) => (direction, None),
            Self::Point(place) => {
                let to_light = place - point;
                let distance = to_light.length();
                let direction = if distance > 0.0 {
                    to_light / distance
                } else {
                    Vec3::Y
                };
                (direction, Some(distance))
            }
        }
    }
}
