//! The shape of a figure's skin: the bust's skull over a drawn face, a body with sloped shoulders and
//! arms. Everything is mirrored across x = 0.

use crate::shape::{EYE_HEIGHT, cranium, ear};
use crate::solid::{bump, cone, ellipsoid, melt};
use glam::{Vec2, Vec3};

/// Height of the chin, metres.
pub(crate) const CHIN: f32 = 1.38;

/// The signed distance to the skin, metres, with a share of the face's relief.
pub(crate) fn skin(p: Vec3, share: f32) -> f32 {
    let side = p.with_x(p.x.abs());
    melt(head(side, share), body(side), 0.024)
}

/// The signed distance to the head without its neck, metres. From here on x is 0 or above.
fn head(p: Vec3, share: f32) -> f32 {
    if p.y < 1.34 {
        return 1.41 - p.y; // far below all of it
    }
    melt(skull(p, share), ear(p), 0.007)
}

fn skull(p: Vec3, share: f32) -> f32 {
    let v = Vec3::new;
    let cranium = cranium(p);
    if p.y > 1.58 {
        return cranium; // nothing else reaches up here
    }
    // The relief raises the skin towards the face's front.
    let face = p - Vec3::Z * (share * relief(p));
    let cheeks = ellipsoid(face, v(0.0, 1.478, 0.014), v(0.067, 0.083, 0.070));
    let mouth = ellipsoid(face, v(0.0, 1.426, 0.042), v(0.0285, 0.036, 0.0405));
    let jaw = cone(
        face,
        v(0.003, 1.3985, 0.060),
        v(0.0360, 1.447, 0.006),
        0.0122,
        0.0145,
    );
    let chin = ellipsoid(face, v(0.0, 1.3965, 0.064), v(0.0125, 0.0155, 0.0160));
    let below = melt(melt(mouth, jaw, 0.028), chin, 0.018);
    let whole = melt(melt(cranium, cheeks, 0.028), below, 0.038);
    melt(whole, nose(p), 0.009)
}

/// How far the skin of the face stands out of its round shape towards the front, metres.
fn relief(p: Vec3) -> f32 {
    // Middle, half axes of the ellipse where it ends, height; all in millimetres, y from the eyes.
    const BUMPS: [([f32; 2], [f32; 2], f32); 8] = [
        ([36.0, 0.0], [34.0, 26.0], -4.0),  // sockets
        ([0.0, 2.0], [24.0, 30.0], -6.0),   // the dent under the brow
        ([40.0, -34.0], [28.0, 26.0], 2.6), // cheeks
        ([0.0, -54.0], [18.0, 10.0], -1.8), // under the nose
        ([0.0, -64.5], [13.0, 7.0], 1.3),   // upper lip
        ([0.0, -70.0], [17.0, 4.5], -1.0),  // the mouth
        ([0.0, -75.5], [12.0, 6.0], 0.9),   // lower lip
        ([0.0, -85.0], [18.0, 9.0], -2.6),  // over the chin
    ];
    if p.z < 0.02 || (p.y - 1.462).abs() > 0.065 {
        return 0.0;
    }
    let at = Vec2::new(p.x, p.y - EYE_HEIGHT) * 1e3;
    let heights = BUMPS.iter().map(|(middle, half_axes, height)| {
        let from_middle = (at - Vec2::from(*middle)) / Vec2::from(*half_axes);
        height * bump(from_middle.length_squared())
    });
    heights.sum::<f32>() * 1e-3
}

/// Small and turned up.
fn nose(p: Vec3) -> f32 {
    let v = Vec3::new;
    let tip = v(0.0, 1.4575, 0.0925);
    let bridge = cone(p, v(0.0, 1.484, 0.0740), tip, 0.0045, 0.0020);
    let wing = cone(p, tip, v(0.003, 1.4495, 0.080), 0.0020, 0.0045);
    melt(bridge, wing, 0.004)
}

/// The shadow that the jaw casts on the neck: where a place above and in front is inside the head.
/// 0 outside, growing to 1 over 25 mm.
pub(crate) fn jaw_shade(p: Vec3) -> f32 {
    if !(1.25..1.48).contains(&p.y) {
        return 0.0;
    }
    let side = p.with_x(p.x.abs());
    let covered = -skull(side + Vec3::new(0.0, 0.050, 0.022), 0.0);
    // The jaw itself is shaded by its normals.
    let is_neck = skull(side, 0.0) - body(side);
    ((covered.min(is_neck) + 0.008) / 0.025).clamp(0.0, 1.0)
}

/// The axis of the neck at a height: its z.
pub(crate) fn neck_axis(y: f32) -> f32 {
    -0.016 + (y - 1.45) * 0.145
}

fn body(p: Vec3) -> f32 {
    let v = Vec3::new;
    if p.y > 1.50 {
        return p.y - 1.46; // far above all of it
    }
    let neck = cone(
        p,
        v(0.0, 1.45, -0.016),
        v(0.0, 1.28, -0.0407),
        0.0280,
        0.0335,
    );
    // From behind the ear to the pit between the collarbones.
    let strap = cone(
        p,
        v(0.032, 1.44, -0.018),
        v(0.010, 1.290, -0.008),
        0.006,
        0.004,
    );
    let slope = cone(
        p,
        v(0.008, 1.342, -0.054),
        v(0.116, 1.276, -0.046),
        0.010,
        0.019,
    );
    let chest = ellipsoid(p, v(0.0, 1.190, -0.028), v(0.106, 0.130, 0.068));
    let waist = ellipsoid(p, v(0.0, 1.030, -0.032), v(0.086, 0.170, 0.060));
    let hips = ellipsoid(p, v(0.0, 0.840, -0.034), v(0.130, 0.130, 0.084));
    let shoulder = ellipsoid(p, v(0.127, 1.248, -0.044), v(0.031, 0.050, 0.034));
    let upper_arm = cone(
        p,
        v(0.133, 1.240, -0.044),
        v(0.158, 1.030, -0.054),
        0.0270,
        0.0240,
    );
    let forearm = cone(
        p,
        v(0.158, 1.030, -0.054),
        v(0.180, 0.770, -0.026),
        0.0240,
        0.0180,
    );
    let arm = melt(melt(shoulder, upper_arm, 0.03), forearm, 0.01);
    let torso = melt(melt(chest, waist, 0.05), hips, 0.05);
    let trunk = melt(torso, arm, 0.024);
    let neck = melt(neck, strap, 0.016);
    melt(melt(trunk, slope, 0.040), neck, 0.032)
}
