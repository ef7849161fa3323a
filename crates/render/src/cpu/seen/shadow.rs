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
    /// From the eye to the ball's middle, metres.
    distance_m: f32,
}

impl Shadow {
    /// None of a ball that is behind the eye or around it.
    pub(super) fn new(frame: &Frame, ball: Ball) -> Option<Self> {
        let camera = frame.camera;
        let view = camera.view_from_world(ball.center);
        if view.z - ball.radius_m <= camera.near_m() {
            return None;
        }
        let middle_px = 0.5 * Vec2::from(camera.size_px().map(|side| side as f32));
        Some(Self::of(view, ball.radius_m, middle_px, camera.focal_px()))
    }

    /// That of a ball whose middle is there as the eye sees it.
    fn of(view: Vec3, radius_m: f32, middle_px: Vec2, focal_px: f32) -> Self {
        let distance_m = view.length();
        let sin = radius_m / distance_m;
        Self {
            middle_px,
            focal_px,
            axis: view / distance_m,
            cos: (1.0 - sin * sin).max(0.0).sqrt(),
            sin,
            distance_m,
        }
    }

    /// Whether all of a disc on the screen, whose nearest point has that depth (m), lies beyond the ball's middle, as seen along the way there: what is so deep is seen nowhere before the ball.
    pub(super) fn is_deep(&self, center: Vec2, radius_px: f32, nearest_m: f32) -> bool {
        // How far along that way a place is that lies a metre deep: what is beside the middle of a wide picture is deeper than it is far.
        let along = self.direction(center).dot(self.axis);
        let least = along - radius_px / self.focal_px * self.axis.truncate().length();
        nearest_m * least >= self.distance_m
    }

    /// Whether a disc on the screen, whose nearest point has that depth (m), lies wholly in it.
    pub(super) fn holds(&self, center: Vec2, radius_px: f32, nearest_m: f32) -> bool {
        if !self.is_deep(center, radius_px, nearest_m) {
            return false;
        }
        // The disc is seen at this angle at most; its cosine is 1 at most.
        let angle = radius_px / self.focal_px;
        let direction = self.direction(center).normalize();
        angle < self.sin && direction.dot(self.axis) >= self.cos + self.sin * angle
    }

    /// What is seen a metre deep at a place on the screen.
    fn direction(&self, at: Vec2) -> Vec3 {
        let at = (at - self.middle_px) / self.focal_px;
        Vec3::new(at.x, -at.y, 1.0) // the screen's y points down
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MIDDLE_PX: Vec2 = Vec2::new(480.0, 360.0);
    const FOCAL_PX: f32 = 300.0;

    proptest! {
        /// The ball lies before each place of a disc that it is said to hide, also at the edge of a wide picture.
        #[test]
        fn a_ball_lies_before_what_it_hides(
            (x, y) in (-2.0_f32..2.0, -1.5_f32..1.5),
            (depth_m, radius_m) in (0.3_f32..1.0, 0.05_f32..0.15),
            (off_x, off_y) in (-1.5_f32..1.5, -1.5_f32..1.5),
            (reach_px, behind) in (0.0_f32..10.0, 0.8_f32..1.5),
        ) {
            let ball = depth_m * Vec3::new(x, y, 1.0);
            let shadow = Shadow::of(ball, radius_m, MIDDLE_PX, FOCAL_PX);
            let at = Vec2::new(x + off_x * radius_m / depth_m, y + off_y * radius_m / depth_m);
            let center = MIDDLE_PX + FOCAL_PX * Vec2::new(at.x, -at.y);
            let nearest_m = behind * depth_m;
            prop_assume!(shadow.holds(center, reach_px, nearest_m));
            for step in 0..16 {
                let turned = Vec2::from_angle(0.4 * step as f32) * reach_px / FOCAL_PX;
                let direction = (at + turned).extend(1.0).normalize();
                // Where the sight meets the ball.
                let along = direction.dot(ball);
                let root = along * along - ball.length_squared() + radius_m * radius_m;
                prop_assert!(root > 0.0);
                let place_m = nearest_m / direction.z;
                prop_assert!(place_m > along - root.sqrt(), "{} {}", place_m, along - root.sqrt());
            }
        }
    }
}
