//! What a head hides: all behind a ball.

use crate::frame::{Ball, Frame};
use glam::{Vec2, Vec3};

/// What lies behind a ball, seen from the eye.
pub(super) struct Shadow {
    middle_px: Vec2,
    focal_px: f32,
    /// Towards the ball's middle, and the cosine and sine of the angle at which the ball is seen around it.
    axis: Vec3,
    cos: f32,
    sin: f32,
    /// Depth of the ball's middle, metres.
    pub(super) depth_m: f32,
}

impl Shadow {
    /// None of a ball that is behind the eye or around it.
    pub(super) fn new(frame: &Frame, ball: Ball) -> Option<Self> {
        let camera = frame.camera;
        let view = camera.view_from_world(ball.center);
        let distance = view.length();
        if view.z - ball.radius_m <= camera.near_m() {
            return None;
        }
        let sin = ball.radius_m / distance;
        Some(Self {
            middle_px: 0.5 * Vec2::from(camera.size_px().map(|side| side as f32)),
            focal_px: camera.focal_px(),
            axis: view / distance,
            cos: (1.0 - sin * sin).max(0.0).sqrt(),
            sin,
            depth_m: view.z,
        })
    }

    /// Whether a disc on the screen, whose nearest point has that depth (m), lies wholly in it.
    pub(super) fn holds(&self, center: Vec2, radius_px: f32, nearest_m: f32) -> bool {
        if nearest_m < self.depth_m {
            return false;
        }
        let at = (center - self.middle_px) / self.focal_px;
        let direction = Vec3::new(at.x, -at.y, 1.0).normalize(); // the screen's y points down
        // The disc is seen at this angle at most; its cosine is 1 at most.
        let angle = radius_px / self.focal_px;
        angle < self.sin && direction.dot(self.axis) >= self.cos + self.sin * angle
    }
}
