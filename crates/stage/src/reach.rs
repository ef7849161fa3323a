//! How far hair can be from the head, and whether a camera can see that far.

use crate::look::Look;
use crate::object::Object;
use glam::Vec3;
use hair_sim::Strands;
use render::{CLUMP_REACH, Head, StrandInfo, reach_of};
use stroke_path::Camera;

/// Of the ball around all hair: for what layers draw beyond it, and for solvers that stretch it a little.
const MARGIN: f32 = 1.1;

/// The radius in metres of the ball around the head's middle that hair of these sizes stays in, however it moves: strands
/// are no longer than they are, and their roots stay on the head.
pub(crate) fn reach_m(strands: &Strands, infos: &[StrandInfo], head: Head) -> f32 {
    let reach = |(points, info): (&[Vec3], &StrandInfo)| {
        let length: f32 = points
            .windows(2)
            .map(|link| link[0].distance(link[1]))
            .sum();
        points[0].distance(head.center) + length + info.size * head.unit_m()
    };
    let farthest = strands.iter().zip(infos).map(reach).fold(0.0, f32::max);
    MARGIN * farthest
}

/// What a camera sees of an object, in the object's own coordinates.
pub(crate) struct Sight {
    camera: Camera,
    /// Around the picture, and what strokes of so many pixels reach into it.
    planes: Planes,
    /// How far strokes may be from their strand, metres: all of them, and by a strand's own size of 1.
    reach_m: f32,
    reach_by_size_m: f32,
    /// How many of the least widths that are drawn as they are the clump of a strand of size 1 is where a metre is a pixel.
    width_by_size: f32,
    shows_all: bool,
}

impl Sight {
    /// Of a camera as the object has it. Clumps narrower than `detail` (px) are drawn as fewer and wider ones; `shows_all` leaves no
    /// strand out because it is off the picture.
    pub fn new(camera: &Camera, object: &Object, detail: f32, shows_all: bool) -> Self {
        let (look, unit_m) = (object.look(), object.hair().head.unit_m());
        let (mut clumps, mut units, mut pixels) = (CLUMP_REACH.clumps, 0.0_f32, 0.0_f32);
        let of_lines = look.lines.iter().flat_map(|set| &set.layers);
        for layer in look.layers.iter().chain(of_lines) {
            let reach = reach_of(layer, look.brush());
            clumps = clumps.max(reach.clumps);
            match layer.is_in_pixels() {
                true => pixels = pixels.max(reach.units),
                false => units = units.max(reach.units),
            }
        }
        let pixel_px = camera.size_px()[1] as f32 / 720.0;
        Self {
            camera: *camera,
            planes: Planes::around(camera, pixels * pixel_px + 1.0),
            reach_m: units * unit_m,
            // A flat clump's middle is beside its strand.
            reach_by_size_m: (1.0 + clumps) * thickest(look) * unit_m,
            width_by_size: 2.0 * thickest(look) * unit_m / detail,
            shows_all,
        }
    }

    /// How wide the clump of a strand of that size (1/300 of the head's height) is at its widest, at that view depth (m), in parts of
    /// the least width that is drawn as it is.
    pub fn width(&self, size: f32, depth_m: f32) -> f32 {
        self.width_by_size * size * self.camera.px_per_metre(depth_m)
    }

    /// The camera, as the object has it.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Whether nothing is left out.
    pub fn shows_all(&self) -> bool {
        self.shows_all
    }

    /// Whether any of a ball (metres) may be in the picture.
    pub fn may_see_ball(&self, center: Vec3, radius: f32) -> bool {
        self.shows_all || self.planes.may_see_ball(center, radius)
    }

    /// Whether any stroke of strands up to that size (1/300 of the head's height) may be in the picture that stay in a ball (metres).
    pub fn may_see_any(&self, center: Vec3, radius: f32, size: f32) -> bool {
        self.may_see_ball(center, radius + self.reach_m + self.reach_by_size_m * size)
    }

    /// Whether any stroke of a strand of that size (1/300 of the head's height) may be in the picture.
    pub fn may_see(&self, particles: &[Vec3], size: f32) -> bool {
        let links = particles.windows(2);
        let longest = links.map(|link| link[0].distance_squared(link[1]));
        // A path between particles leaves their hull by no more than a third of a link (the control points of its Bezier form).
        let bulge = longest.fold(0.0, f32::max).sqrt() / 3.0;
        let beyond = self.reach_m + self.reach_by_size_m * size + bulge;
        self.shows_all || self.planes.may_see_hull(particles, beyond)
    }
}

/// What bounds the part of the world that a camera sees.
struct Planes {
    eye: Vec3,
    /// The near plane and the planes through the eye and the picture's edges: unit vectors out of what is seen, and how far from the
    /// eye they lie, metres.
    planes: [(Vec3, f32); 5],
}

impl Planes {
    /// Those of a picture with so many pixels more on each side.
    fn around(camera: &Camera, more_px: f32) -> Self {
        let [half_width, half_height] = (camera.size_px()).map(|side| 0.5 * side as f32 + more_px);
        let focal = camera.focal_px();
        let side = |x: f32, y: f32, half_px: f32| {
            let out = Vec3::new(x * focal, y * focal, -half_px).normalize();
            (camera.world_from_view_direction(out), 0.0)
        };
        let near = camera.world_from_view_direction(Vec3::NEG_Z);
        Self {
            eye: camera.eye(),
            planes: [
                (near, -camera.near_m()),
                side(1.0, 0.0, half_width),
                side(-1.0, 0.0, half_width),
                side(0.0, 1.0, half_height),
                side(0.0, -1.0, half_height),
            ],
        }
    }

    /// Whether any of a ball (metres) may be seen.
    fn may_see_ball(&self, center: Vec3, radius: f32) -> bool {
        (self.planes.iter()).all(|plane| self.outside(plane, center) <= radius)
    }

    /// Whether anything may be seen that is within `beyond` (metres) of the hull of some points.
    fn may_see_hull(&self, points: &[Vec3], beyond: f32) -> bool {
        // Not finite is told elsewhere.
        let is_outside = |plane: &(Vec3, f32)| {
            let mut points = points.iter();
            points.all(|point| self.outside(plane, *point) > beyond)
        };
        !self.planes.iter().any(is_outside)
    }

    /// How far a point lies outside of a plane, metres.
    fn outside(&self, (out, from_eye): &(Vec3, f32), point: Vec3) -> f32 {
        out.dot(point - self.eye) - from_eye
    }
}

/// The largest factor of the look on a strand's own size.
fn thickest(look: &Look) -> f32 {
    let clump = look.clump.greatest();
    clump.size * (1.0 + clump.size_variation) * clump.root_size.max(1.0)
}

/// Whether any of a ball (metres) may be in the camera's picture.
pub(crate) fn may_see(camera: &Camera, center: Vec3, radius: f32) -> bool {
    Planes::around(camera, 0.0).may_see_ball(center, radius)
}

#[cfg(test)]
mod tests {
    use super::*;
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
