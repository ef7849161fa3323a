//! The light on the picture: a place of the pointer's as a direction, and back.

use glam::{Vec2, Vec3};
use stage::{CameraSection, FixedTo, LightSection};
use stroke_path::direction_from_angles;

/// How far from the picture's middle light is that comes from the side, in parts of half the picture's shorter side.
const SIDE: f32 = 0.5;

/// The directions to the right, up, and to the viewer, of a camera.
fn axes(camera: &CameraSection) -> [Vec3; 3] {
    let back = direction_from_angles(camera.yaw, camera.pitch).unwrap_or(Vec3::Z);
    let (sin, cos) = camera.yaw.to_radians().sin_cos();
    let right = Vec3::new(cos, 0.0, -sin);
    [right, back.cross(right), back]
}

/// Where on the picture a light is shown, from its middle, x to the right and y down, in parts of half its shorter side. The middle is light
/// from the viewer; at 1 it comes from behind the head.
#[must_use]
pub fn place(light: &LightSection, camera: &CameraSection) -> Vec2 {
    let direction = direction_from_angles(light.yaw, light.pitch).unwrap_or(Vec3::Z);
    let seen = match light.fixed_to {
        FixedTo::Camera => direction,
        FixedTo::World => Vec3::from(axes(camera).map(|axis| axis.dot(direction))),
    };
    let angle = seen.z.clamp(-1.0, 1.0).acos();
    let side = Vec2::new(seen.x, -seen.y).normalize_or(Vec2::X);
    side * (SIDE * angle / std::f32::consts::FRAC_PI_2)
}

/// Yaw and pitch in degrees, a tenth each, of the light that is shown there: the other way round.
#[must_use]
pub fn angles(place: Vec2, fixed_to: FixedTo, camera: &CameraSection) -> [f32; 2] {
    let angle = (place.length() / SIDE).min(2.0) * std::f32::consts::FRAC_PI_2;
    let side = place.normalize_or_zero();
    let seen = Vec3::new(side.x * angle.sin(), -side.y * angle.sin(), angle.cos());
    let direction = match fixed_to {
        FixedTo::Camera => seen,
        FixedTo::World => {
            let [right, up, back] = axes(camera);
            right * seen.x + up * seen.y + back * seen.z
        }
    };
    let pitch = direction.y.clamp(-1.0, 1.0).asin().to_degrees();
    let yaw = direction.x.atan2(direction.z).to_degrees();
    [yaw, pitch].map(|degrees| (10.0 * degrees).round() / 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen_from(yaw: f32, pitch: f32) -> CameraSection {
        CameraSection {
            yaw,
            pitch,
            ..CameraSection::default()
        }
    }

    #[test]
    fn a_light_is_where_it_was_dragged_to() {
        for fixed_to in [FixedTo::World, FixedTo::Camera] {
            for (yaw, pitch) in [(0.0, 0.0), (30.0, 10.0), (180.0, -20.0), (-90.0, 80.0)] {
                let camera = seen_from(yaw, pitch);
                for pointed in [
                    (0.0, 0.0),
                    (0.3, -0.2),
                    (-0.5, 0.1),
                    (0.1, 0.8),
                    (-0.6, -0.6),
                ] {
                    let pointed = Vec2::from(pointed);
                    let [yaw, pitch] = angles(pointed, fixed_to, &camera);
                    let light = LightSection {
                        yaw,
                        pitch,
                        fixed_to,
                        ..LightSection::default()
                    };
                    effects::section::Section::check(&light).unwrap();
                    let shown = place(&light, &camera);
                    assert!(shown.distance(pointed) < 0.01, "{pointed} {shown}");
                }
            }
        }
    }

    #[test]
    fn sides_are_sides() {
        // Seen from the front, light at yaw 90 comes from the right.
        let light = |yaw, pitch| LightSection {
            yaw,
            pitch,
            ..LightSection::default()
        };
        let near = |a: Vec2, b: [f32; 2]| a.distance(b.into()) < 1e-5;
        assert!(near(
            place(&light(90.0, 0.0), &seen_from(0.0, 0.0)),
            [SIDE, 0.0]
        ));
        assert!(near(
            place(&light(0.0, 90.0), &seen_from(0.0, 0.0)),
            [0.0, -SIDE]
        ));
        assert!(near(
            place(&light(90.0, 0.0), &seen_from(180.0, 0.0)),
            [-SIDE, 0.0]
        ));
        assert!(near(
            place(&light(90.0, 0.0), &seen_from(90.0, 0.0)),
            [0.0, 0.0]
        ));
    }
}
