//! The planes of a drawn face: which way light takes each part of it to face. Front, sides and the
//! halves of the front are each flat but for soft edges, so that a shadow ends where an artist would
//! end it: down the side of the face, or down its middle. An eye lies within one plane, so that no
//! light cuts it.

use crate::shape::EYE_HEIGHT;
use glam::Vec3;

/// Half the front's width by height over the eyes, millimetres, from the brow's top to the chin.
const FRONT: [(f32, f32); 9] = [
    (62.0, 60.0),
    (40.0, 66.0),
    (26.0, 76.0),
    (-15.0, 76.0),
    (-25.0, 70.0),
    (-41.0, 53.0),
    (-62.0, 37.0),
    (-84.0, 27.0),
    (-104.0, 20.0),
];

/// How much lower than at the nose the front begins to turn down at this distance from it, both millimetres: light that leaves the front ends in a round cheek there,
/// and not in a line from side to side.
const CHEEK: (f32, f32) = (24.0, 50.0);

/// How wide the edges between planes are, millimetres.
const EDGE: f32 = 9.0;

/// Which way the skin at `p` is taken to face; `normal` where it is no part of the face.
pub(crate) fn facing(p: Vec3, normal: Vec3) -> Vec3 {
    let (x, y) = (p.x * 1e3, (p.y - EYE_HEIGHT) * 1e3);
    let within = smooth((x.abs() - half_width(y)) / -EDGE)
        * smooth((62.0 - y) / 24.0)
        * smooth((y + 104.0) / 14.0)
        * smooth((p.z - 0.015) * 1e3 / 10.0);
    let half = 2.0 * smooth(x / 12.0 + 0.5) - 1.0;
    // Below the eyes the front turns down a little.
    let cheek = CHEEK.0 * (x / CHEEK.1).powi(2);
    let down = 0.08 - 0.12 * smooth((-28.0 - cheek - y) / 50.0);
    let front = Vec3::new(0.30 * half, down, 1.0);
    normal.lerp(front.normalize(), within).normalize_or(normal)
}

fn half_width(y: f32) -> f32 {
    let below = FRONT.iter().position(|(at, _)| *at < y);
    match below {
        Some(0) => FRONT[0].1,
        None => FRONT[FRONT.len() - 1].1,
        Some(i) => {
            let ((y0, x0), (y1, x1)) = (FRONT[i - 1], FRONT[i]);
            x0 + (x1 - x0) * (y - y0) / (y1 - y0)
        }
    }
}

/// From 0 at 0 to 1 at 1, smoothly.
pub(crate) fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
