//! How far hair can be from the head, and whether a camera can see that far.

use hair_sim::Strands;
use render::{Head, StrandInfo};
use stroke_path::Camera;

/// Of the ball around all hair: for what layers draw beyond it, and for solvers that stretch it a little.
const MARGIN: f32 = 1.1;

/// The radius in metres of the ball around the head's middle that hair of these sizes stays in, however it moves: strands
/// are no longer than they are, and their roots stay on the head.
pub(crate) fn reach_m(strands: &Strands, infos: &[StrandInfo], head: Head) -> f32 {
    let reach = |(points, info): (&[glam::Vec3], &StrandInfo)| {
        let length: f32 = points
            .windows(2)
            .map(|link| link[0].distance(link[1]))
            .sum();
        points[0].distance(head.center) + length + info.size * head.unit_m()
    };
    let farthest = strands.iter().zip(infos).map(reach).fold(0.0, f32::max);
    MARGIN * farthest
}

/// Whether any of a ball (metres) may be in the camera's picture.
pub(crate) fn may_see(camera: &Camera, center: glam::Vec3, radius: f32) -> bool {
    let center = camera.view_from_world(center);
    let [half_width, half_height] = camera.size_px().map(|side| 0.5 * side as f32);
    // The distance beyond the plane through the eye and an edge of the picture.
    let beyond = |across: f32, half_px: f32| {
        let focal = camera.focal_px();
        (across.abs() * focal - center.z * half_px) / focal.hypot(half_px)
    };
    center.z + radius >= camera.near_m()
        && beyond(center.x, half_width) <= radius
        && beyond(center.y, half_height) <= radius
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use stroke_path::OrbitView;

    #[test]
    fn a_ball_is_seen_until_it_is_wholly_off_the_picture() {
        let view = OrbitView {
            target: Vec3::ZERO,
            yaw_degrees: 0.0,
            pitch_degrees: 0.0,
            distance_m: 10.0,
            vertical_fov_degrees: 90.0,
        };
        // As wide as high: at the target the picture reaches 10 m to each side.
        let camera = Camera::orbit(view, [100, 100], 0.1).unwrap();
        let seen = |x: f32, z: f32| may_see(&camera, Vec3::new(x, 0.0, z), 1.0);
        assert!(seen(0.0, 0.0) && seen(10.0, 0.0) && seen(-11.3, 0.0));
        assert!(!seen(11.5, 0.0) && !seen(-11.5, 0.0));
        // Around the eye, and behind it.
        assert!(seen(0.0, 10.5) && !seen(0.0, 11.0) && !seen(0.0, 30.0));
    }
}
