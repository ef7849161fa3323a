//! The shape of the bust's skin.

use crate::solid::{cone, ellipsoid, melt};
use glam::Vec3;

/// The signed distance to the skin, metres. Mirrored across x = 0.
pub(crate) fn distance(p: Vec3) -> f32 {
    let side = p.with_x(p.x.abs());
    let cut = 1.125 - p.y; // the shoulders end in a plane
    melt(head(p, side), shoulders(p, side), 0.035).max(cut)
}

fn head(p: Vec3, side: Vec3) -> f32 {
    let v = Vec3::new;
    let cranium = ellipsoid(p, v(0.0, 1.530, -0.012), v(0.083, 0.090, 0.100));
    let face = ellipsoid(p, v(0.0, 1.482, 0.022), v(0.068, 0.090, 0.072));
    let jaw = ellipsoid(p, v(0.0, 1.431, 0.042), v(0.037, 0.046, 0.046));
    let chin = ellipsoid(p, v(0.0, 1.402, 0.060), v(0.016, 0.016, 0.018));
    let nose = cone(
        side,
        v(0.0, 1.480, 0.090),
        v(0.0, 1.452, 0.1015),
        0.002,
        0.0035,
    );
    let ear = ellipsoid(side, v(0.085, 1.487, -0.014), v(0.008, 0.027, 0.016));
    let skull = melt(cranium, face, 0.03);
    let jawed = melt(melt(skull, jaw, 0.045), chin, 0.03);
    melt(melt(jawed, nose, 0.014), ear, 0.008)
}

fn shoulders(p: Vec3, side: Vec3) -> f32 {
    let v = Vec3::new;
    let neck = cone(p, v(0.0, 1.43, -0.018), v(0.0, 1.28, -0.028), 0.031, 0.038);
    let shoulder = cone(
        side,
        v(0.02, 1.282, -0.03),
        v(0.105, 1.262, -0.035),
        0.043,
        0.038,
    );
    let chest = ellipsoid(p, v(0.0, 1.20, -0.03), v(0.122, 0.125, 0.070));
    melt(melt(shoulder, chest, 0.05), neck, 0.035)
}
