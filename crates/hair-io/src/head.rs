//! Where the head is and how large.

use glam::{DVec3, Vec3};

use crate::Mesh;
use crate::sphere;

/// The head's height where nothing tells it, in metres.
const USUAL_HEIGHT: f64 = 0.24;
/// Head heights in radii of the scalp's sphere.
const HEIGHT_IN_RADII: f64 = 2.5;
/// How far from the middle of the roots' sphere a head may reach, in its radii: the mesh beyond is
/// neck, shoulders and arms.
const REACH: f64 = 2.3;
/// A sphere is determined by four points: fewer roots don't tell a head beside a mesh.
const ENOUGH_ROOTS: usize = 4;
/// Horizontal sections of the mesh that are looked at for its neck.
const SECTIONS: usize = 160;

/// The head's place and size, in metres: what sizes and depths are measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadFrame {
    /// The middle of the head (`c_head` of the normal that points away from it). Finite.
    pub center: Vec3,
    /// From the chin to the top. Above 0 and finite.
    pub height: f32,
}

impl HeadFrame {
    /// The head of a mesh (a head, bust or body, Y up), of some roots, or of both.
    ///
    /// A mesh's head is what lies above its chin, found where the mesh narrows to a neck (the whole
    /// mesh where it has none); with four roots or more, or with some that are elsewhere, only the mesh around them counts. Without a mesh, or
    /// where its head does not match the roots, it is the sphere through the roots, whose radius is
    /// taken as 1/2.5 of the height. Without two different roots it is 0.24 m high.
    #[must_use]
    pub fn find(mesh: Option<&Mesh>, roots: &[Vec3]) -> Self {
        let scalp = sphere::fit(roots);
        let around = scalp.map(|s| (s.center, REACH * s.radius));
        let matches_scalp =
            |height: f64| scalp.is_none_or(|s| (1.5..4.5).contains(&(height / s.radius)));
        if roots.len() < ENOUGH_ROOTS
            && let Some((center, height)) = mesh.and_then(|mesh| head_of_mesh(mesh, None))
            && roots
                .iter()
                .all(|root| root.as_dvec3().distance(center) < height)
        {
            return Self::new(center, height);
        }
        if let Some((center, height)) = mesh.and_then(|mesh| head_of_mesh(mesh, around))
            && matches_scalp(height)
        {
            return Self::new(center, height);
        }
        match scalp {
            Some(s) => Self::new(s.center, HEIGHT_IN_RADII * s.radius),
            None => Self::new(
                roots.first().map_or(DVec3::ZERO, |r| r.as_dvec3()),
                USUAL_HEIGHT,
            ),
        }
    }

    fn new(center: DVec3, height: f64) -> Self {
        let limit = f64::from(f32::MAX);
        Self {
            center: center
                .clamp(DVec3::splat(-limit), DVec3::splat(limit))
                .as_vec3(),
            height: height.clamp(f64::from(f32::MIN_POSITIVE), limit) as f32,
        }
    }
}

/// The middle and the height of the head in a mesh; `around`: no farther than this from a point.
/// `None` where the mesh has no vertical extent there.
fn head_of_mesh(mesh: &Mesh, around: Option<(DVec3, f64)>) -> Option<(DVec3, f64)> {
    let triangles: Vec<[DVec3; 3]> = mesh
        .corners()
        .map(|corners| corners.map(|c| c.as_dvec3()))
        .filter(|corners| {
            around.is_none_or(|(center, reach)| corners.iter().all(|c| c.distance(center) <= reach))
        })
        .collect();
    let (low, high) = bounds(triangles.iter().flatten())?;
    if high.y <= low.y {
        return None;
    }
    let chin = chin_height(&triangles, low.y, high.y);
    let above_chin = triangles.iter().flatten().filter(|c| c.y >= chin);
    let (low, high) = bounds(above_chin)?;
    let middle = (low + high) * 0.5;
    Some((middle.with_y((chin + high.y) * 0.5), high.y - chin))
}

/// The height of the chin; `low` without a neck.
///
/// The neck is the narrowest part below the widest, down to the shoulders. The chin is where the front
/// falls back over it; a shape without one ends where the neck reaches its width.
fn chin_height(triangles: &[[DVec3; 3]], low: f64, high: f64) -> f64 {
    let height = |section: usize| high + (low - high) * (section as f64 + 0.5) / SECTIONS as f64;
    let sections = sections(triangles, low, high);
    let (mut widest, mut narrowest, mut shoulders) = (0.0f64, f64::INFINITY, SECTIONS);
    for (index, width) in sections.iter().map(|s| s.width).enumerate() {
        if narrowest.is_infinite() && width >= 0.75 * widest {
            widest = widest.max(width);
        } else if width > 1.3 * narrowest {
            shoulders = index;
            break;
        } else if width > 0.0 {
            narrowest = narrowest.min(width);
        }
    }
    // A chin that narrows to nothing is no neck.
    if narrowest.is_infinite() || narrowest < 0.15 * widest {
        return low;
    }
    let peak = sections.iter().position(|s| s.width == widest).unwrap_or(0);
    let begins = |factor: f64| {
        let below = &sections[peak..shoulders];
        below
            .iter()
            .position(|s| s.width > 0.0 && s.width <= factor * narrowest)
            .map(|i| peak + i)
    };
    let (Some(jaw), Some(neck)) = (begins(1.3), begins(1.05)) else {
        return low;
    };
    let falls_back = |section: &usize| sections[section - 1].front - sections[section + 1].front;
    let chin = (jaw.max(1)..shoulders.min(SECTIONS - 1))
        .max_by(|a, b| falls_back(a).total_cmp(&falls_back(b)))
        .filter(|section| falls_back(section) > 0.15 * widest);
    height(chin.unwrap_or(neck))
}

/// A horizontal section of a mesh.
#[derive(Clone, Copy)]
struct Section {
    /// Its extent along x; 0 where the plane meets nothing.
    width: f64,
    /// Its largest z, where the face is; the one above's where the plane meets nothing.
    front: f64,
}

/// Sections at planes evenly from `high` down to `low`.
fn sections(triangles: &[[DVec3; 3]], low: f64, high: f64) -> Vec<Section> {
    // x from, x to, z to.
    let nothing = [f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let mut extents = vec![nothing; SECTIONS];
    let position = |y: f64| (high - y) / (high - low) * SECTIONS as f64 - 0.5;
    for [a, b, c] in triangles {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let (upper, lower) = if p.y >= q.y { (p, q) } else { (q, p) };
            let (first, last) = (position(upper.y), position(lower.y));
            // Casts of negative and huge numbers saturate.
            let end = ((last + 1.0).floor() as usize).min(SECTIONS);
            for section in first.max(0.0).ceil() as usize..end {
                let t = ((section as f64 - first) / (last - first).max(f64::MIN_POSITIVE)).min(1.0);
                let point = upper.lerp(*lower, t);
                let [from, to, front] = extents[section];
                extents[section] = [from.min(point.x), to.max(point.x), front.max(point.z)];
            }
        }
    }
    let mut front = f64::NAN;
    let section = |[from, to, z]: [f64; 3]| {
        if from <= to {
            front = z;
        }
        Section {
            width: (to - from).max(0.0),
            front,
        }
    };
    extents.into_iter().map(section).collect()
}

/// The smallest and largest coordinates of some points.
pub(crate) fn bounds<'a>(points: impl Iterator<Item = &'a DVec3>) -> Option<(DVec3, DVec3)> {
    points
        .map(|p| (*p, *p))
        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A turned shape about the y axis: rings of (height, radius), from the top.
    fn turned(rings: &[(f32, f32)]) -> Mesh {
        let point = |ring: usize, step: usize| {
            let angle = step as f32 / 24.0 * std::f32::consts::TAU;
            let (y, radius) = rings[ring];
            Vec3::new(radius * angle.cos(), y, radius * angle.sin())
        };
        let quads = (1..rings.len()).flat_map(|ring| (0..24).map(move |step| (ring, step)));
        Mesh::from_corners(quads.flat_map(|(ring, step)| {
            let next = (step + 1) % 24;
            let [a, b] = [point(ring - 1, step), point(ring - 1, next)];
            let [c, d] = [point(ring, step), point(ring, next)];
            [[a, b, c], [b, d, c]]
        }))
    }

    const HEAD: [(f32, f32); 6] = [
        (1.70, 0.0),
        (1.68, 0.05),
        (1.60, 0.09),
        (1.55, 0.085),
        (1.50, 0.07),
        (1.46, 0.045),
    ];
    const NECK_AND_BODY: [(f32, f32); 5] = [
        (1.44, 0.045),
        (1.40, 0.045),
        (1.36, 0.2),
        (0.9, 0.17),
        (0.0, 0.1),
    ];

    #[test]
    fn a_head_ends_where_the_neck_begins() {
        let body = turned(&[&HEAD[..], &NECK_AND_BODY].concat());
        let bust = turned(&[&HEAD[..], &NECK_AND_BODY[..3]].concat());
        let stump = turned(&[&HEAD[..], &NECK_AND_BODY[..2]].concat());
        for (name, mesh) in [("body", &body), ("bust", &bust), ("stump", &stump)] {
            let frame = HeadFrame::find(Some(mesh), &[]);
            assert!((frame.height - 0.24).abs() < 0.012, "{name}: {frame:?}");
            assert!(
                frame.center.distance(Vec3::new(0.0, 1.58, 0.0)) < 0.008,
                "{name}: {frame:?}"
            );
        }
        let alone = turned(&[&HEAD[..5], &[(1.46, 0.0)]].concat());
        assert!((HeadFrame::find(Some(&alone), &[]).height - 0.24).abs() < 1e-3);
    }

    #[test]
    fn roots_say_which_part_of_a_body_is_the_head() {
        let body = turned(&[&HEAD[..], &NECK_AND_BODY].concat());
        let scalp = |center: Vec3| -> Vec<Vec3> {
            let around = (0..64).map(|i| (i as f32 * 0.7, (i as f32 / 64.0 * 1.4).sin()));
            around
                .map(|(a, y)| {
                    let ring = (1.0 - y * y).sqrt();
                    center + 0.09 * Vec3::new(ring * a.cos(), y, ring * a.sin())
                })
                .collect()
        };
        let frame = HeadFrame::find(Some(&body), &scalp(Vec3::Y * 1.6));
        assert!((frame.height - 0.24).abs() < 0.012, "{frame:?}");
        // Roots elsewhere do not belong to this mesh: the head is theirs.
        let frame = HeadFrame::find(Some(&body), &scalp(Vec3::X * 5.0));
        assert!(frame.center.distance(Vec3::X * 5.0) < 1e-3 && (frame.height - 0.225).abs() < 1e-3);
    }

    #[test]
    fn a_few_roots_are_no_scalp() {
        let body = turned(&[&HEAD[..], &NECK_AND_BODY].concat());
        let pair = [Vec3::new(0.02, 1.62, 0.0), Vec3::new(-0.02, 1.62, 0.0)];
        let frame = HeadFrame::find(Some(&body), &pair);
        assert_eq!(frame, HeadFrame::find(Some(&body), &[]));
        assert!((frame.height - 0.24).abs() < 0.012, "{frame:?}");
        // But elsewhere the head is theirs.
        let frame = HeadFrame::find(Some(&body), &pair.map(|root| root + Vec3::X));
        assert!(
            frame.center.distance(Vec3::new(1.0, 1.62, 0.0)) < 1e-3,
            "{frame:?}"
        );
    }

    #[test]
    fn without_any_size_the_height_is_the_usual() {
        assert_eq!(
            HeadFrame::find(None, &[]),
            HeadFrame {
                center: Vec3::ZERO,
                height: 0.24
            }
        );
        let one = HeadFrame::find(Some(&Mesh::default()), &[Vec3::ONE; 9]);
        assert_eq!(
            one,
            HeadFrame {
                center: Vec3::ONE,
                height: 0.24
            }
        );
    }

    proptest! {
        #[test]
        fn frames_are_finite_and_above_zero(
            corners in prop::collection::vec(prop::array::uniform9(prop_oneof![-1.0f32..1.0, Just(0.0), Just(1e38), Just(-1e-40)]), 0..9),
            roots in prop::collection::vec(prop::array::uniform3(prop_oneof![-1.0f32..1.0, Just(0.0), Just(-3e38)]), 0..9),
        ) {
            let mesh = Mesh::from_corners(corners.iter().map(|c| [0, 3, 6].map(|i| Vec3::from_slice(&c[i..]))));
            let roots: Vec<Vec3> = roots.into_iter().map(Vec3::from).collect();
            for mesh in [Some(&mesh), None] {
                let frame = HeadFrame::find(mesh, &roots);
                prop_assert!(frame.center.is_finite() && frame.height > 0.0 && frame.height.is_finite());
            }
        }
    }
}
