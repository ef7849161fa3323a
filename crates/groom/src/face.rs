//! The drawn face: flat shapes and strokes that lie on the bust's skin.

use crate::ribbon::{Flat, curve, ellipse, fill, stroke};
use crate::shape::distance;
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
}

/// A shape on the skin.
#[derive(Clone, Debug)]
pub struct Patch {
    /// Its colour.
    pub ink: Ink,
    /// Positions in metres, a little outside the skin.
    pub positions: Vec<Vec3>,
    /// Indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
}

/// Between one patch and the next over it, metres: nearer patches hide the others by depth alone.
const LAYER: f32 = 0.0003;

/// Middle of the eyes: at half the head's height.
const EYE: Vec2 = Vec2::new(0.0335, 1.4935);

/// All patches, lowest first.
pub(crate) fn patches() -> Vec<Patch> {
    let mut drawn: Vec<(Ink, Flat, f32)> = Vec::new();
    for side in [1.0, -1.0] {
        let mut add = |ink, flat: Flat, layer| drawn.push((ink, mirrored(flat, side), layer));
        eye(&mut add, side);
        add(Ink::Line, brow(), 1.0);
    }
    drawn.push((Ink::Line, nose(), 1.0));
    drawn.push((Ink::Line, mouth(), 1.0));
    drawn.push((Ink::Line, lower_lip(), 1.0));
    drawn
        .into_iter()
        .map(|(ink, flat, layer)| on_skin(ink, &flat, layer))
        .collect()
}

/// One eye, drawn for the viewer's right; `side` is -1 where it will be mirrored.
fn eye(add: &mut impl FnMut(Ink, Flat, f32), side: f32) {
    let at = |x: f32, y: f32| EYE + Vec2::new(x, y) * 1e-3;
    // From the inner corner over the upper lid to the outer corner, and back below.
    let upper = curve(&[
        at(-15.5, -2.0),
        at(-10.0, 8.5),
        at(0.0, 13.0),
        at(10.0, 9.5),
        at(15.5, 1.0),
    ]);
    let lower = curve(&[
        at(15.5, 1.0),
        at(11.5, -9.5),
        at(1.0, -13.0),
        at(-9.5, -10.5),
        at(-15.5, -2.0),
    ]);
    let outline: Vec<Vec2> = upper
        .iter()
        .chain(&lower[1..lower.len() - 1])
        .copied()
        .collect();
    add(Ink::White, fill(at(0.0, 0.0), &outline), 1.0);

    let inside = |points: Vec<Vec2>| -> Vec<Vec2> {
        points
            .into_iter()
            .map(|p| keep_inside(p, at(0.0, 0.0), &outline))
            .collect()
    };
    let iris = inside(ellipse(at(0.5, -0.5), Vec2::new(9.6e-3, 13.2e-3)));
    add(Ink::Iris, fill(at(0.0, 0.0), &iris), 2.0);
    let shadow: Vec<Vec2> = iris.iter().map(|p| p.max(at(-99.0, 1.8))).collect();
    add(Ink::IrisShadow, fill(at(0.0, 4.0), &shadow), 3.0);
    let pupil = inside(ellipse(at(0.5, -0.5), Vec2::new(4.2e-3, 6.2e-3)));
    add(Ink::IrisShadow, fill(at(0.5, -0.5), &pupil), 3.0);
    // Lights are where the light is, in both eyes on the same side.
    let light = |x: f32, y: f32, rx: f32, ry: f32| {
        fill(
            at(x * side, y),
            &ellipse(at(x * side, y), Vec2::new(rx, ry) * 1e-3),
        )
    };
    add(Ink::White, light(4.4, 5.2, 2.6, 3.4), 4.0);
    add(Ink::White, light(-3.6, -7.6, 1.5, 1.8), 4.0);

    // The upper lashes: thick over the outer half, with a wing past the corner.
    let lashes = [
        (at(-16.5, -3.0), 0.4e-3),
        (at(-10.6, 8.6), 2.2e-3),
        (at(0.0, 13.4), 3.2e-3),
        (at(10.6, 10.2), 4.2e-3),
        (at(16.0, 2.2), 3.4e-3),
        (at(19.6, 2.8), 0.2e-3),
    ];
    add(Ink::Line, stroke(&lashes), 5.0);
    let below = [
        (at(15.8, 0.4), 1.6e-3),
        (at(11.8, -9.6), 1.3e-3),
        (at(2.5, -13.2), 0.2e-3),
    ];
    add(Ink::Line, stroke(&below), 5.0);
    let fold = [
        (at(-9.5, 14.0), 0.1e-3),
        (at(1.0, 17.6), 1.1e-3),
        (at(13.0, 13.5), 0.1e-3),
    ];
    add(Ink::Line, stroke(&fold), 1.0);
}

fn brow() -> Flat {
    let at = |x: f32, y: f32| Vec2::new(x, y) * 1e-3 + Vec2::new(0.0, EYE.y);
    stroke(&[
        (at(14.5, 26.0), 0.6e-3),
        (at(26.0, 29.5), 2.7e-3),
        (at(39.0, 29.0), 2.0e-3),
        (at(52.0, 23.0), 0.1e-3),
    ])
}

/// A small mark under the tip, at the side away from the light.
fn nose() -> Flat {
    let at = |x: f32, y: f32| Vec2::new(x * 1e-3, y);
    stroke(&[
        (at(-0.5, 1.4475), 0.2e-3),
        (at(-2.4, 1.4452), 1.4e-3),
        (at(-4.4, 1.4462), 0.2e-3),
    ])
}

fn mouth() -> Flat {
    let at = |x: f32, y: f32| Vec2::new(x * 1e-3, y);
    stroke(&[
        (at(-13.0, 1.4240), 1.6e-3),
        (at(-7.0, 1.4212), 1.0e-3),
        (at(0.0, 1.4216), 0.9e-3),
        (at(7.0, 1.4212), 1.0e-3),
        (at(13.0, 1.4240), 1.6e-3),
    ])
}

fn lower_lip() -> Flat {
    let at = |x: f32, y: f32| Vec2::new(x * 1e-3, y);
    stroke(&[
        (at(-4.5, 1.4118), 0.1e-3),
        (at(0.0, 1.4108), 1.0e-3),
        (at(4.5, 1.4118), 0.1e-3),
    ])
}

fn mirrored(mut flat: Flat, side: f32) -> Flat {
    for point in &mut flat.points {
        point.x *= side;
    }
    flat
}

/// `p`, or where the way to it from `center` leaves the outline.
fn keep_inside(p: Vec2, center: Vec2, outline: &[Vec2]) -> Vec2 {
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

/// Lays a flat shape onto the skin, straight from the front.
fn on_skin(ink: Ink, flat: &Flat, layer: f32) -> Patch {
    let positions = flat.points.iter().map(|p| {
        // Walk in from the front until the skin is reached.
        let mut place = Vec3::new(p.x, p.y, 0.2);
        for _ in 0..60 {
            place.z -= distance(place) * 0.9;
        }
        place.z += layer * LAYER;
        place
    });
    Patch {
        ink,
        positions: positions.collect(),
        triangles: flat.triangles.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_patch_lies_on_the_skin_of_the_face() {
        for patch in patches() {
            assert!(!patch.triangles.is_empty());
            for p in &patch.positions {
                let gap = distance(*p);
                assert!(
                    (-1e-4..0.002).contains(&gap),
                    "{:?} at {p}: {gap}",
                    patch.ink
                );
                assert!(p.z > 0.03, "{p} is on the face");
            }
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
