//! Where along a path strokes are needed: not where no picture can show them, and not behind a head.

use crate::drawing::Order;
use crate::frame::{Ball, CLUMP_REACH, Frame, Object, reach_of};
use effects::{Joints, Units};
use glam::{Vec2, Vec3};

/// A pixel more than the picture makes up for rounding.
const MARGIN_PX: f32 = 1.0;

/// Sides on which a disc lies wholly: beyond an edge of the picture, or behind a head. What is between two discs of one side, as all
/// discs of a segment are, is there too, since each is convex.
const LEFT: u8 = 1;
const RIGHT: u8 = 2;
const ABOVE: u8 = 4;
const BELOW: u8 = 8;
const HIDDEN: u8 = 16;

/// For each joint of the frame whether a stroke's disc there makes any difference. Nothing where all do.
///
/// Of a joint that makes none both segments are unseen, with any size of its own, so that with a radius of 0 it makes the same picture.
pub(super) fn fill_needed(frame: &Frame, joints: &Joints, needed: &mut Vec<bool>) {
    needed.clear();
    let mut sides = Vec::with_capacity(frame.paths.len());
    for object in &frame.objects {
        let reach = Room::of(frame, object);
        sides.extend(object.joints.clone().map(|i| reach.sides(frame, joints, i)));
    }
    if sides.iter().all(|side| *side == 0) {
        return;
    }
    needed.resize(frame.paths.len(), false);
    for run in &frame.paths.runs {
        if let [one] = sides[run.joints.clone()] {
            needed[run.joints.start] = one == 0;
        }
        for i in run.joints.start..run.joints.end - 1 {
            let is_seen = sides[i] & sides[i + 1] == 0;
            needed[i] |= is_seen;
            needed[i + 1] |= is_seen;
        }
    }
}

/// What an object's strokes take of the screen around their clumps, and what hides them.
struct Room {
    clumps: f32,
    units: f32,
    pixels_px: f32,
    unit_m: f32,
    shadow: Option<Shadow>,
}

impl Room {
    fn of(frame: &Frame, object: &Object) -> Self {
        let (mut clumps, mut units, mut pixels) = (CLUMP_REACH.clumps, CLUMP_REACH.units, 0.0_f32);
        for layer in object.layers {
            // Clumps clip what lies on them; made paths have none but their strokes.
            let is_clipped = layer.rank >= 0 && frame.order != Order::Shifted;
            if is_clipped && !layer.program.has_own_paths() {
                continue;
            }
            let reach = reach_of(layer, frame.brush);
            clumps = clumps.max(reach.clumps);
            match layer.units {
                Units::Pixels => pixels = pixels.max(reach.units),
                Units::World => units = units.max(reach.units),
            }
        }
        Self {
            clumps,
            units,
            pixels_px: pixels * frame.camera.size_px()[1] as f32 / 720.0,
            unit_m: object.head.unit_m(),
            shadow: object.solid.and_then(|ball| Shadow::new(frame, ball)),
        }
    }

    /// The sides on which all discs of joint `i` lie.
    fn sides(&self, frame: &Frame, joints: &Joints, i: usize) -> u8 {
        let paths = frame.paths;
        let unit_px = self.unit_m * paths.px_per_metre[i];
        let (radius, shift) = (joints.clump_radius[i], joints.clump_shift[i]);
        let reach = shift.length().0 + self.clumps * radius + self.units;
        let reach_px = reach * unit_px + self.pixels_px + MARGIN_PX;
        let (center, size) = (
            paths.center[i],
            frame.camera.size_px().map(|side| side as f32),
        );
        let side = |is_there: bool, side: u8| if is_there { side } else { 0 };
        let nearest_m = paths.depth[i] - radius * self.unit_m;
        let is_hidden = |shadow: &Shadow| shadow.holds(center, reach_px, nearest_m);
        side(center.x < -reach_px, LEFT)
            | side(center.x > size[0] + reach_px, RIGHT)
            | side(center.y < -reach_px, ABOVE)
            | side(center.y > size[1] + reach_px, BELOW)
            | side(self.shadow.as_ref().is_some_and(is_hidden), HIDDEN)
    }
}

/// What lies behind a ball, seen from the eye.
struct Shadow {
    middle_px: Vec2,
    focal_px: f32,
    /// Towards the ball's middle, and the cosine and sine of the angle at which the ball is seen around it.
    axis: Vec3,
    cos: f32,
    sin: f32,
    /// Depth of the ball's middle, metres.
    depth_m: f32,
}

impl Shadow {
    /// None of a ball that is behind the eye or around it.
    fn new(frame: &Frame, ball: Ball) -> Option<Self> {
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
    fn holds(&self, center: Vec2, radius_px: f32, nearest_m: f32) -> bool {
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
