//! Where lines cross each other in the image.

use crate::{
    Beside, Kind, Line, Surface, View,
    tree::{Box3, Tree},
};
use glam::{DVec3, Vec3A};
use std::ops::ControlFlow;

/// Rounding of a place in the image to f32, relative to its size.
const ROUNDING: f32 = 1e-6;

/// Of each line that is wanted the places along it ([`Line::position`]) where it passes behind something that may hide it, in no order: where it crosses a contour,
/// a border, or an edge of which one triangle faces the eye and the other doesn't; unless the eye sees that clearly behind it. Folds inside of what is closed neither
/// hide nor are seen.
///
/// Pieces of lines that could cross are found by a tree of their boxes in the image: near to linear in pieces and crossings.
pub(crate) fn crossings(
    surface: &Surface,
    lines: &[Line],
    wanted: &[bool],
    view: &View,
) -> Vec<Vec<f64>> {
    let mut hiding = Vec::new();
    let mut boxes = Vec::new();
    // Segments of what is shrunk to a point are all in one place, and none crosses another.
    let has_length = |line: &Line, segment: usize| {
        let [from, to] = line.ends(segment).map(|end| end.position);
        from != to
    };
    for (number, line) in lines.iter().enumerate() {
        let segments = (0..line.segments.len()).filter(|&i| has_length(line, i));
        for segment in segments.filter(|&i| hides(surface, view, line, i)) {
            let [from, to] = line.ends(segment).map(|end| end.position);
            hiding.push((number, segment));
            boxes.push(image_box(view, from, to));
        }
    }
    let tree = Tree::new(&boxes);
    let mut crossings = vec![Vec::new(); lines.len()];
    for (number, line) in lines.iter().enumerate().filter(|(n, _)| wanted[*n]) {
        let segments = (0..line.segments.len()).filter(|&i| has_length(line, i));
        for segment in segments.filter(|&i| !line.segments[i].is_inside(surface)) {
            let [from, to] = line.ends(segment).map(|end| end.position);
            let here = image_box(view, from, to);
            tree.visit(
                |there| here.overlaps(there),
                |item| {
                    let (other, other_segment) = hiding[item as usize];
                    let is_same = other == number && are_beside(line, segment, other_segment);
                    if !is_same && here.overlaps(&boxes[item as usize]) {
                        let [c, d] = lines[other].ends(other_segment).map(|end| end.position);
                        let share = crossing(view, [from, to], [c, d]);
                        crossings[number].extend(share.map(|share| segment as f64 + share));
                    }
                    ControlFlow::Continue(())
                },
            );
        }
    }
    crossings
}

/// True if something behind a segment may be seen on one side of it and hidden on the other.
fn hides(surface: &Surface, view: &View, line: &Line, segment: usize) -> bool {
    let at = line.segments[segment];
    if line.kind != Kind::Crease {
        return !at.is_inside(surface);
    }
    let topology = surface.topology();
    let [from, to] = line.ends(segment).map(|end| end.place.vertex(surface));
    let is_it = |half_edge: &u32| {
        let mut ends = topology.ends(*half_edge);
        ends.sort_unstable();
        ends == [from.min(to), from.max(to)]
    };
    let half_edge = (at.triangle * 3..at.triangle * 3 + 3).find(is_it);
    match half_edge.map(|half_edge| topology.beside(half_edge)) {
        Some(Beside::Twin(twin)) => {
            let towards = view.towards(line.points[segment].position);
            let [a, b] = [at.triangle, twin / 3].map(|t| surface.area_normal(t).dot(towards));
            (a > 0.0) != (b > 0.0)
        }
        _ => true,
    }
}

/// True if two segments of a line are the same, or have a joint in common.
fn are_beside(line: &Line, a: usize, b: usize) -> bool {
    let apart = a.abs_diff(b);
    apart <= 1 || (line.closed && apart == line.segments.len() - 1)
}

/// Where the eye sees the segment `ab` cross `cd`, as a share of the way from `a` to `b`, unless `cd` is clearly behind it.
fn crossing(view: &View, [a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> Option<f64> {
    // A point on the line counts as on its left, so that of two segments with a common joint one is crossed.
    let [side_c, side_d] = [c, d].map(|point| view.side(a, b, point));
    let [side_a, side_b] = [a, b].map(|point| view.side(c, d, point));
    if (side_a >= 0.0) == (side_b >= 0.0) || (side_c >= 0.0) == (side_d >= 0.0) {
        return None;
    }
    let share = side_a / (side_a - side_b);
    let p = a.lerp(b, share);
    let q = c.lerp(d, side_c / (side_c - side_d));
    // A line that meets another on the surface, as a crease does that goes around the horizon, has about the same distance: as far as the chords of a
    // curve are off it.
    let slack = a.distance(b) + c.distance(d);
    (view.farther(p, q)? > -slack).then_some(share)
}

/// A box around what the eye sees of a segment, of any coordinates of the image.
fn image_box(view: &View, from: DVec3, to: DVec3) -> Box3 {
    let [a, b] = [from, to].map(|end| view.image(end));
    let rises = if view.is_perspective() {
        let cosine = a.dot(b);
        if cosine < 0.5 {
            // A long arc, or a segment beside the eye: anywhere.
            return Box3 {
                low: Vec3A::splat(-2.0),
                high: Vec3A::splat(2.0),
            };
        }
        // How far an arc stands off its chord.
        (1.0 - ((1.0 + cosine) / 2.0).min(1.0).sqrt()) as f32
    } else {
        0.0
    };
    let bounds = Box3::of([a.as_vec3(), b.as_vec3()]);
    let size = bounds.low.abs().max(bounds.high.abs()).max_element();
    let margin = Vec3A::splat(rises + size * ROUNDING);
    Box3 {
        low: bounds.low - margin,
        high: bounds.high + margin,
    }
}
