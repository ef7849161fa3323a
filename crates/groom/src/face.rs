//! The drawn face: flat shapes and strokes that lie on the bust's skin.

use crate::ribbon::{Flat, curve, ellipse, fill, stroke};
use crate::shape::{EAR, EAR_BACK, EAR_UP, EYE_HEIGHT, distance};
use glam::{Vec2, Vec3};

/// What a patch is painted with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// The line colour of the look.
    Line,
    /// The white of the eye, and lights in it.
    White,
    /// The iris.
    Iris,
    /// The upper part of the iris, in the lid's shadow, and the pupil.
    IrisShadow,
    /// The lower part of the iris, which light comes through.
    IrisLight,
    /// The white of the eye in the lid's shadow.
    WhiteShadow,
    /// The skin in shadow.
    SkinShadow,
    /// Blush on the cheeks.
    Blush,
    /// The inside of the mouth.
    Mouth,
}

/// What of a drawn face a patch is a piece of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FacePart {
    /// An eye with its lids and lashes.
    Eyes,
    /// A brow.
    Brows,
    /// The mouth.
    Mouth,
    /// Blush on a cheek.
    Blush,
    /// What else is drawn on the skin: nose, ears, neck.
    #[default]
    Lines,
}

/// A shape on the skin.
#[derive(Clone, Debug)]
pub struct Patch {
    /// What it is a piece of.
    pub part: FacePart,
    /// Its colour.
    pub ink: Ink,
    /// Drawn where light is away from this direction, a unit vector that turns with the head; none is always drawn.
    pub away_from: Option<Vec3>,
    /// Positions in metres, a little outside the skin.
    pub positions: Vec<Vec3>,
    /// Indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
}

/// How far above the skin the lowest patches lie, metres: the skin's triangles cut its hollows short.
const LOWEST: f32 = 0.0003;

/// Between one patch and the next over it, metres: nearer patches hide the others by depth alone.
const LAYER: f32 = 0.00014;

/// Middle of the eyes.
const EYE: Vec2 = Vec2::new(0.0355, EYE_HEIGHT - 0.0015);

/// A plane that is drawn on, to be laid onto the skin in front of it.
pub(crate) struct Sheet {
    pub origin: Vec3,
    pub right: Vec3,
    pub up: Vec3,
}

pub(crate) const FRONT: Sheet = Sheet {
    origin: Vec3::ZERO,
    right: Vec3::X,
    up: Vec3::Y,
};

/// Says of the patches from the `first` on what they are pieces of.
pub(crate) fn mark(patches: &mut [Patch], first: usize, part: FacePart) {
    for patch in &mut patches[first..] {
        patch.part = part;
    }
}

/// All patches, lowest first.
pub(crate) fn patches() -> Vec<Patch> {
    let mut patches = Vec::new();
    for side in [1.0, -1.0] {
        let lay = |ink, flat: Flat, layer| FRONT.lay(ink, &mirrored(flat, side), layer);
        let first = patches.len();
        eye(
            &mut |ink, flat, layer| patches.push(lay(ink, flat, layer)),
            side,
        );
        mark(&mut patches, first, FacePart::Eyes);
        patches.push(Patch {
            part: FacePart::Brows,
            ..lay(Ink::Line, brow(), 1.0)
        });
        patches.extend([collarbone(), neck()].map(|line| lay(Ink::Line, line, 1.0)));
        // The right ear is drawn in a mirror, so that its sheet too faces outwards.
        let ear = Sheet {
            origin: EAR * Vec3::new(side, 1.0, 1.0),
            right: EAR_BACK * Vec3::new(1.0, side, side),
            up: EAR_UP * Vec3::new(side, 1.0, 1.0),
        };
        for line in ear_lines() {
            patches.push(ear.lay(Ink::Line, &mirrored(line, side), 1.0));
        }
    }
    // The skin's triangles are coarse where lips meet.
    patches.push(FRONT.lay(Ink::Line, &nose(), 1.0));
    let first = patches.len();
    for (line, layer) in [(mouth(), 4.0), (lower_lip(), 1.0)] {
        patches.push(FRONT.lay(Ink::Line, &line, layer));
    }
    mark(&mut patches, first, FacePart::Mouth);
    patches
}

/// One eye, drawn for the viewer's right; `side` is -1 where it will be mirrored.
fn eye(add: &mut impl FnMut(Ink, Flat, f32), side: f32) {
    let at = |x: f32, y: f32| EYE + Vec2::new(x, y) * 1.16e-3;
    // From the inner corner over the upper lid to the outer corner, and back below.
    let upper = curve(&[
        at(-16.5, -4.5),
        at(-11.5, 8.0),
        at(0.0, 14.0),
        at(11.5, 11.0),
        at(17.5, 1.5),
    ]);
    let lower = curve(&[
        at(17.5, 1.5),
        at(13.5, -10.0),
        at(2.0, -15.0),
        at(-10.0, -13.0),
        at(-16.5, -4.5),
    ]);
    let outline: Vec<Vec2> = upper
        .iter()
        .chain(&lower[1..lower.len() - 1])
        .copied()
        .collect();
    add(Ink::White, fill(at(0.0, 0.0), &outline), 0.0);

    let inside = |points: Vec<Vec2>| -> Vec<Vec2> {
        points
            .into_iter()
            .map(|p| keep_inside(p, at(0.0, 0.0), &outline))
            .collect()
    };
    let iris = inside(ellipse(at(0.3, -0.6), Vec2::new(13.9e-3, 17.4e-3)));
    add(Ink::Iris, fill(at(0.0, 0.0), &iris), 1.0);
    // The lid's shadow ends in an arc.
    let in_shadow = |p: &Vec2| {
        let across = (p.x - EYE.x) / 1.16e-3;
        p.max(at(-99.0, 4.0 - 0.035 * across * across))
    };
    let shadow: Vec<Vec2> = iris.iter().map(in_shadow).collect();
    add(Ink::IrisShadow, fill(at(0.0, 6.0), &shadow), 2.0);
    let pupil = inside(ellipse(at(0.3, -0.6), Vec2::new(6.0e-3, 8.6e-3)));
    add(Ink::IrisShadow, fill(at(0.3, -0.6), &pupil), 2.0);
    // Lights are where the light is, in both eyes on the same side.
    let light = |x: f32, y: f32, rx: f32, ry: f32| {
        fill(
            at(x * side, y),
            &ellipse(at(x * side, y), Vec2::new(rx, ry) * 1.16e-3),
        )
    };
    add(Ink::White, light(5.0, 5.4, 3.1, 4.0), 3.0);
    add(Ink::White, light(-4.4, -8.4, 1.7, 2.0), 3.0);

    // The upper lashes: thick over the outer half, with a wing past the corner and one above it.
    let lashes = [
        (at(-17.5, -6.0), 0.3e-3),
        (at(-12.2, 8.2), 2.2e-3),
        (at(0.0, 14.6), 3.6e-3),
        (at(12.2, 11.8), 4.6e-3),
        (at(18.2, 3.0), 3.6e-3),
        (at(22.0, 3.4), 0.2e-3),
    ];
    add(Ink::Line, stroke(&lashes), 4.0);
    let wing = [
        (at(14.5, 9.0), 3.4e-3),
        (at(19.0, 8.2), 2.0e-3),
        (at(22.5, 9.6), 0.1e-3),
    ];
    add(Ink::Line, stroke(&wing), 4.0);
    let below = [
        (at(18.0, 1.5), 1.8e-3),
        (at(13.8, -10.2), 1.4e-3),
        (at(3.0, -15.2), 0.2e-3),
    ];
    add(Ink::Line, stroke(&below), 4.0);
    let fold = [
        (at(-11.0, 15.0), 0.1e-3),
        (at(1.0, 19.6), 1.1e-3),
        (at(15.0, 15.5), 0.1e-3),
    ];
    add(Ink::Line, stroke(&fold), 1.0);
}

/// A stroke through points in millimetres, y from `base` in metres; widths in millimetres.
pub(crate) fn line(base: f32, points: &[([f32; 2], f32)]) -> Flat {
    let points = points.iter().map(|([x, y], width)| {
        let at = Vec2::new(x * 1e-3, base + y * 1e-3);
        (at, width * 1e-3)
    });
    stroke(&points.collect::<Vec<_>>())
}

fn brow() -> Flat {
    line(
        EYE.y,
        &[
            ([13.5, 29.5], 0.8),
            ([26.0, 33.5], 3.0),
            ([41.0, 33.0], 2.2),
            ([55.0, 26.0], 0.1),
        ],
    )
}

/// A small mark under the tip, at the side away from the light.
fn nose() -> Flat {
    line(
        1.45,
        &[([0.8, -1.8], 0.2), ([-1.8, -3.6], 1.3), ([-4.2, -2.6], 0.2)],
    )
}

fn mouth() -> Flat {
    line(
        1.424,
        &[
            ([-15.0, 2.0], 0.2),
            ([-13.0, 1.0], 1.5),
            ([-7.0, -0.8], 1.0),
            ([0.0, -0.2], 0.8),
            ([7.0, -0.8], 1.0),
            ([13.0, 1.0], 1.5),
            ([15.0, 2.0], 0.2),
        ],
    )
}

fn lower_lip() -> Flat {
    line(
        1.412,
        &[([-4.5, 0.6], 0.1), ([0.0, -0.4], 1.0), ([4.5, 0.6], 0.1)],
    )
}

/// From the pit of the neck outwards.
pub(crate) fn collarbone() -> Flat {
    line(
        1.28,
        &[
            ([9.0, 1.0], 0.2),
            ([20.0, 6.5], 1.3),
            ([42.0, 8.0], 0.9),
            ([66.0, 14.0], 0.1),
        ],
    )
}

/// The strap of muscle that ends at the collarbone.
pub(crate) fn neck() -> Flat {
    line(
        1.28,
        &[([9.5, 10.0], 0.9), ([13.5, 24.0], 0.7), ([20.0, 42.0], 0.1)],
    )
}

/// The rim's inner edge, and the bowl's, in the sheet of the left ear.
pub(crate) fn ear_lines() -> [Flat; 2] {
    let rim = [
        ([-12.0, 8.0], 0.2),
        ([-8.0, 21.0], 1.0),
        ([4.0, 25.5], 1.2),
        ([13.5, 17.0], 1.2),
        ([13.5, 3.0], 1.0),
        ([6.0, -11.0], 0.1),
    ];
    let bowl = [
        ([-1.0, 15.0], 0.1),
        ([6.0, 9.0], 1.0),
        ([6.0, -1.0], 1.0),
        ([-2.0, -8.5], 0.9),
        ([-8.0, -5.0], 0.1),
    ];
    [line(0.0, &rim), line(0.0, &bowl)]
}

pub(crate) fn mirrored(mut flat: Flat, side: f32) -> Flat {
    for point in &mut flat.points {
        point.x *= side;
    }
    flat
}

/// `p`, or where the way to it from `center` leaves the outline.
pub(crate) fn keep_inside(p: Vec2, center: Vec2, outline: &[Vec2]) -> Vec2 {
    let way = p - center;
    let mut share = 1.0_f32;
    for (i, a) in outline.iter().enumerate() {
        let edge = outline[(i + 1) % outline.len()] - *a;
        let cross = way.perp_dot(edge);
        if cross.abs() > 1e-12 {
            let (t, s) = (
                (*a - center).perp_dot(edge) / cross,
                (*a - center).perp_dot(way) / cross,
            );
            if t > 0.0 && (0.0..=1.0).contains(&s) {
                share = share.min(t);
            }
        }
    }
    center + way * share
}

impl Sheet {
    /// Lays a flat shape onto the skin, straight back from this sheet.
    fn lay(&self, ink: Ink, flat: &Flat, layer: f32) -> Patch {
        self.lay_on(&distance, ink, flat, layer)
    }

    /// The same on another surface than the bust's.
    pub(crate) fn lay_on(
        &self,
        distance: &impl Fn(Vec3) -> f32,
        ink: Ink,
        flat: &Flat,
        layer: f32,
    ) -> Patch {
        let front = self.right.cross(self.up);
        let positions = flat.points.iter().map(|p| {
            // Walk in from the front until the skin is reached.
            let mut depth = -0.15;
            let place = |depth: f32| self.origin + self.right * p.x + self.up * p.y - front * depth;
            for _ in 0..60 {
                let left = distance(place(depth));
                depth += left * 0.9;
                if left < 1e-6 {
                    break;
                }
            }
            place(depth - LOWEST - layer * LAYER)
        });
        // Counter-clockwise from the front, also of mirrored shapes.
        let triangles = flat.triangles.iter().map(|&[a, b, c]| {
            let [at, to_b, to_c] = [a, b, c].map(|i| flat.points[i as usize]);
            if (to_b - at).perp_dot(to_c - at) < 0.0 {
                [a, c, b]
            } else {
                [a, b, c]
            }
        });
        Patch {
            part: FacePart::default(),
            ink,
            away_from: None,
            positions: positions.collect(),
            triangles: triangles.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::gradient;

    #[test]
    fn every_patch_lies_on_the_skin() {
        for patch in patches() {
            assert!(!patch.triangles.is_empty());
            for p in &patch.positions {
                let gap = distance(*p);
                assert!((0.0..0.001).contains(&gap), "{:?} at {p}: {gap}", patch.ink);
            }
        }
    }

    #[test]
    fn patches_face_away_from_the_head() {
        let mut looked_at = 0;
        for patch in patches() {
            for triangle in &patch.triangles {
                let [a, b, c] = triangle.map(|i| patch.positions[i as usize]);
                let facing = (b - a).cross(c - a);
                let out = gradient(distance, a, 1e-3);
                // Slivers turn with the last bits of their corners.
                if facing.length() > 1e-7 {
                    assert!(facing.dot(out) > 0.0, "{:?} at {a}", patch.ink);
                    looked_at += 1;
                }
            }
        }
        assert!(looked_at > 2000, "{looked_at}");
    }

    #[test]
    fn both_ears_are_drawn_alike() {
        let lines = |side: f32| -> Vec<Vec3> {
            let patches = patches();
            let all = patches.iter().flat_map(|patch| patch.positions.clone());
            let on_ear = all.filter(|p| p.x * side > 0.07 && p.z < 0.02);
            on_ear.map(|p| p.with_x(p.x.abs())).collect()
        };
        let (left, right) = (lines(1.0), lines(-1.0));
        assert!(left.len() > 100, "{}", left.len());
        assert_eq!(left.len(), right.len());
        for p in &left {
            let nearest = right.iter().map(|q| p.distance(*q)).fold(1.0, f32::min);
            assert!(nearest < 1e-5, "{p}: {nearest}");
        }
    }

    #[test]
    fn the_iris_stays_in_the_eye() {
        let square = [
            Vec2::new(-1.0, -1.0),
            Vec2::new(1.0, -1.0),
            Vec2::ONE,
            Vec2::new(-1.0, 1.0),
        ];
        assert_eq!(
            keep_inside(Vec2::new(0.5, 0.5), Vec2::ZERO, &square),
            Vec2::new(0.5, 0.5)
        );
        assert!(
            (keep_inside(Vec2::new(4.0, 2.0), Vec2::ZERO, &square) - Vec2::new(1.0, 0.5)).length()
                < 1e-6
        );
    }
}
