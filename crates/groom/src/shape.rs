//! The shape of the bust's skin. Everything is mirrored across x = 0.

use crate::solid::{bump, common, cone, ellipsoid, gradient, melt};
use glam::{Vec2, Vec3};

/// The signed distance to the skin, metres.
pub(crate) fn distance(p: Vec3) -> f32 {
    with_relief(p, 1.0)
}

/// The signed distance to the skin, metres, with a share of the face's relief.
fn with_relief(p: Vec3, share: f32) -> f32 {
    let side = p.with_x(p.x.abs());
    let whole = melt(head(side, share), body(side), 0.026);
    if p.y > 1.33 {
        return whole;
    }
    // A round cut below, from arm to arm.
    let cut = ellipsoid(
        side.with_y(side.y.min(1.31)),
        Vec3::new(0.0, 1.31, -0.034),
        Vec3::new(0.185, 0.175, 0.16),
    );
    common(whole, cut, 0.010)
}

/// The skin's unit normal, without what is smaller than 16 mm but for the ears: so light ends in
/// clean curves.
pub(crate) fn shading_normal(p: Vec3) -> Vec3 {
    let step = (0.002 + distance_to_ear(p).max(0.0)).min(0.016);
    gradient(|p| with_relief(p, 0.0), p, step).normalize_or(Vec3::Y)
}

/// The signed distance to the nearer ear, metres.
pub(crate) fn distance_to_ear(p: Vec3) -> f32 {
    ear(p.with_x(p.x.abs()))
}

/// The signed distance to the head without its neck, metres, with a share of the face's relief. From here
/// on x is 0 or above.
fn head(p: Vec3, share: f32) -> f32 {
    if p.y < 1.34 {
        return 1.41 - p.y; // far below all of it
    }
    melt(skull(p, share), ear(p), 0.007)
}

/// The round of the skull, on which hair grows.
pub(crate) fn cranium(p: Vec3) -> f32 {
    ellipsoid(
        p,
        Vec3::new(0.0, 1.530, -0.012),
        Vec3::new(0.083, 0.090, 0.100),
    )
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
    let mouth = ellipsoid(face, v(0.0, 1.426, 0.042), v(0.034, 0.036, 0.041));
    let jaw = cone(
        face,
        v(0.005, 1.3995, 0.059),
        v(0.038, 1.447, 0.006),
        0.0150,
        0.0145,
    );
    let chin = ellipsoid(face, v(0.0, 1.3975, 0.064), v(0.0155, 0.016, 0.0165));
    let below = melt(melt(mouth, jaw, 0.028), chin, 0.018);
    let whole = melt(melt(cranium, cheeks, 0.028), below, 0.038);
    melt(whole, nose(p), 0.009)
}

/// How far the skin of the face stands out of its round shape towards the front, metres.
fn relief(p: Vec3) -> f32 {
    // Middle, half axes of the ellipse where it ends, height; all in millimetres, y from the eyes.
    const BUMPS: [([f32; 2], [f32; 2], f32); 8] = [
        ([36.0, 0.0], [34.0, 26.0], -4.0),  // sockets
        ([0.0, 2.0], [24.0, 28.0], -5.5),   // the dent under the brow
        ([40.0, -36.0], [28.0, 26.0], 3.0), // cheekbones
        ([0.0, -54.0], [18.0, 9.0], -1.5),  // under the nose
        ([0.0, -63.5], [15.0, 8.0], 2.2),   // upper lip
        ([0.0, -69.5], [20.0, 5.0], -0.8),  // between the lips
        ([0.0, -75.5], [14.0, 7.0], 1.8),   // lower lip
        ([0.0, -84.5], [20.0, 8.0], -2.4),  // over the chin
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

/// Height of the middle of the eyes: half the head's.
pub(crate) const EYE_HEIGHT: f32 = 1.4935;

fn nose(p: Vec3) -> f32 {
    let v = Vec3::new;
    let tip = v(0.0, 1.4555, 0.0935);
    let bridge = cone(p, v(0.0, 1.484, 0.0755), tip, 0.005, 0.0025);
    let wing = cone(p, tip, v(0.004, 1.4475, 0.081), 0.0025, 0.005);
    melt(bridge, wing, 0.004)
}

/// A plate that leans back and opens to the front, and its lobe; what is in it is drawn.
pub(crate) fn ear(p: Vec3) -> f32 {
    let v = Vec3::new;
    let from_middle = p - EAR;
    if from_middle.length_squared() > 0.05 * 0.05 {
        return from_middle.length() - 0.03;
    }
    // Backward, upward, outward.
    let at = v(
        from_middle.dot(EAR_BACK),
        from_middle.dot(EAR_UP),
        from_middle.dot(EAR_OUT),
    );
    let upper = ellipsoid(at, v(0.002, 0.008, 0.0), v(0.018, 0.023, 0.0085));
    let lobe = ellipsoid(at, v(-0.006, -0.017, 0.0), v(0.011, 0.015, 0.008));
    melt(upper, lobe, 0.014)
}

/// Middle of the ear.
pub(crate) const EAR: Vec3 = Vec3::new(0.0800, 1.487, -0.013);
/// The ear's axes, unit vectors: from its front edge to the back, to its top, out of its bowl.
pub(crate) const EAR_BACK: Vec3 = Vec3::new(0.390_1, -0.139_2, -0.910_2);
pub(crate) const EAR_UP: Vec3 = Vec3::new(0.054_8, 0.990_3, -0.127_9);
const EAR_OUT: Vec3 = Vec3::new(0.919_1, 0.0, 0.393_9);

/// The shadow that the jaw casts on the neck: where a place above and in front is inside the head.
/// 0 outside, growing to 1 over 35 mm: so it joins the shadow of the neck itself in a curve.
pub(crate) fn jaw_shade(p: Vec3) -> f32 {
    if !(1.25..1.48).contains(&p.y) {
        return 0.0;
    }
    let side = p.with_x(p.x.abs());
    let covered = -skull(side + Vec3::new(0.0, 0.045, 0.022), 0.0);
    // The jaw itself is shaded by its normals.
    let is_neck = skull(side, 0.0) - body(side);
    ((covered.min(is_neck) + 0.01) / 0.035).clamp(0.0, 1.0)
}

fn body(p: Vec3) -> f32 {
    let v = Vec3::new;
    if p.y > 1.50 {
        return p.y - 1.46; // far above all of it
    }
    let neck = cone(p, v(0.0, 1.45, -0.016), v(0.0, 1.27, -0.040), 0.0295, 0.036);
    // From behind the ear to the pit between the collarbones.
    let strap = cone(
        p,
        v(0.034, 1.44, -0.018),
        v(0.011, 1.290, -0.007),
        0.006,
        0.004,
    );
    let slope = cone(
        p,
        v(0.010, 1.352, -0.050),
        v(0.090, 1.288, -0.042),
        0.018,
        0.022,
    );
    let shoulder = ellipsoid(p, v(0.112, 1.262, -0.038), v(0.036, 0.044, 0.036));
    let arm = cone(
        p,
        v(0.116, 1.25, -0.038),
        v(0.124, 1.12, -0.038),
        0.031,
        0.028,
    );
    let chest = ellipsoid(p, v(0.0, 1.205, -0.030), v(0.112, 0.115, 0.070));
    let neck = melt(neck, strap, 0.016);
    let torso = melt(melt(chest, shoulder, 0.045), arm, 0.05);
    melt(melt(torso, slope, 0.045), neck, 0.034)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the skin is at this height in the middle of the face.
    fn profile(y: f32) -> f32 {
        let depths = (0..4000).map(|i| 0.13 - i as f32 * 5e-5);
        let on_skin = |z: &f32| distance(Vec3::new(0.0, y, *z)) < 0.0;
        depths.into_iter().find(on_skin).unwrap()
    }

    #[test]
    fn the_profile_is_a_face() {
        let [forehead, dent, tip, under_nose] = [1.535, 1.495, 1.4555, 1.439].map(profile);
        let [upper_lip, lips, lower_lip, over_chin, chin] =
            [1.4305, 1.4245, 1.4185, 1.4085, 1.395].map(profile);
        let throat = profile(1.36);
        assert!(
            forehead > dent + 0.001 && tip > dent + 0.008,
            "{forehead} {dent} {tip}"
        );
        assert!(tip > upper_lip + 0.006, "{tip} {upper_lip}");
        assert!(
            upper_lip > under_nose && upper_lip > lips,
            "{under_nose} {upper_lip} {lips}"
        );
        assert!(lower_lip > over_chin, "{lower_lip} {over_chin}");
        assert!(chin > throat + 0.06, "{chin} {throat}");
        assert!(
            (chin - lower_lip).abs() < 0.008,
            "a firm chin: {chin} {lower_lip}"
        );
    }

    #[test]
    fn everything_is_mirrored() {
        for i in 0..4000 {
            let at = |step: i32, low: f32, high: f32| {
                low + (high - low) * (i * step % 1009) as f32 / 1009.0
            };
            let p = Vec3::new(at(7, 0.0, 0.2), at(31, 1.1, 1.65), at(113, -0.15, 0.13));
            let image = p.with_x(-p.x);
            assert_eq!(distance(p), distance(image));
            assert_eq!(jaw_shade(p), jaw_shade(image));
        }
    }

    #[test]
    fn the_jaw_shades_the_neck_only() {
        let under_the_chin = jaw_shade(Vec3::new(0.0, 1.365, profile(1.365)));
        assert!(under_the_chin > 0.8, "{under_the_chin}");
        for y in [1.28, 1.395, 1.42, 1.45, 1.5] {
            assert_eq!(jaw_shade(Vec3::new(0.0, y, profile(y))), 0.0, "at {y}");
        }
    }

    #[test]
    fn shortcuts_change_nothing() {
        // Where a part is left out, what is left is the same as with it to less than can be seen.
        for y in [1.33, 1.34, 1.5, 1.58] {
            for i in 0..400 {
                let (x, z) = ((i % 20) as f32 * 0.01, (i / 20) as f32 * 0.0125 - 0.14);
                let [below, over] = [y - 1e-5, y + 1e-5].map(|y| distance(Vec3::new(x, y, z)));
                if below.abs() < 0.01 {
                    assert!(
                        (over - below).abs() < 1e-4,
                        "at {x} {y} {z}: {below} {over}"
                    );
                }
            }
        }
    }
}
