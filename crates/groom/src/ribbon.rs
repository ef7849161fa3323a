//! Flat shapes in the plane of the face, as triangles: filled outlines and tapering strokes.

use glam::Vec2;

/// Triangles in the plane of the face, metres, x to the viewer's right, y up.
#[derive(Clone, Debug, Default)]
pub(crate) struct Flat {
    pub points: Vec<Vec2>,
    pub triangles: Vec<[u32; 3]>,
}

/// Points from one drawn point to the next.
const STEPS: usize = 10;

/// A smooth curve through the points: uniform Catmull-Rom.
pub(crate) fn curve(points: &[Vec2]) -> Vec<Vec2> {
    let last = points.len() - 1;
    let at = |i: isize| points[i.clamp(0, last as isize) as usize];
    let mut smooth = Vec::with_capacity(last * STEPS + 1);
    for i in 0..last as isize {
        let (a, b, c, d) = (at(i - 1), at(i), at(i + 1), at(i + 2));
        for step in 0..STEPS {
            let t = step as f32 / STEPS as f32;
            let (t2, t3) = (t * t, t * t * t);
            let sum = b * 2.0
                + (c - a) * t
                + (a * 2.0 - b * 5.0 + c * 4.0 - d) * t2
                + (b * 3.0 - a - c * 3.0 + d) * t3;
            smooth.push(sum * 0.5);
        }
    }
    smooth.push(points[last]);
    smooth
}

/// A stroke along a curve through `points`; `width` is its whole width at each of them.
pub(crate) fn stroke(points: &[(Vec2, f32)]) -> Flat {
    let path = curve(&points.iter().map(|(p, _)| *p).collect::<Vec<_>>());
    let widths = curve(
        &points
            .iter()
            .map(|(_, w)| Vec2::new(*w, 0.0))
            .collect::<Vec<_>>(),
    );
    let mut flat = Flat::default();
    for i in 0..path.len() {
        let along = path[(i + 1).min(path.len() - 1)] - path[i.saturating_sub(1)];
        let across = along.normalize_or_zero().perp() * widths[i].x.max(0.0) / 2.0;
        flat.points.extend([path[i] + across, path[i] - across]);
    }
    for i in 0..path.len() as u32 - 1 {
        let first = 2 * i;
        flat.triangles.extend([
            [first, first + 1, first + 2],
            [first + 1, first + 3, first + 2],
        ]);
    }
    flat
}

/// The inside of a closed outline that is seen whole from `center`, in rings, so that it can follow
/// a curved face.
pub(crate) fn fill(center: Vec2, outline: &[Vec2]) -> Flat {
    const RINGS: usize = 4;
    let count = outline.len() as u32;
    let mut flat = Flat::default();
    for ring in 0..=RINGS {
        let share = ring as f32 / RINGS as f32;
        flat.points
            .extend(outline.iter().map(|p| center.lerp(*p, share)));
    }
    for ring in 0..RINGS as u32 {
        for i in 0..count {
            let (a, b) = (ring * count + i, ring * count + (i + 1) % count);
            flat.triangles
                .extend([[a, a + count, b], [b, a + count, b + count]]);
        }
    }
    flat
}

/// The points of an ellipse. (Rational, as a platform's sine would give each its own last bits.)
pub(crate) fn ellipse(center: Vec2, half_axes: Vec2) -> Vec<Vec2> {
    let quarter = (0..STEPS).map(|i| {
        let t = i as f32 / STEPS as f32;
        Vec2::new(1.0 - t * t, 2.0 * t) / (1.0 + t * t)
    });
    let quarter: Vec<Vec2> = quarter.collect();
    let turns = [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y];
    let circle = turns
        .iter()
        .flat_map(|turn| quarter.iter().map(|p| turn.rotate(*p)));
    circle.map(|p| center + half_axes * p).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(flat: &Flat) -> f32 {
        let twice = flat.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| flat.points[i as usize]);
            (b - a).perp_dot(c - a).abs()
        });
        twice.sum::<f32>() / 2.0
    }

    #[test]
    fn areas() {
        let straight = [(Vec2::ZERO, 0.2), (Vec2::X, 0.2), (Vec2::X * 2.0, 0.2)];
        assert!((area(&stroke(&straight)) - 0.4).abs() < 1e-4);
        let round = fill(Vec2::ZERO, &ellipse(Vec2::ZERO, Vec2::new(2.0, 1.0)));
        assert!((area(&round) - 2.0 * std::f32::consts::PI).abs() < 0.06);
    }

    #[test]
    fn curves_pass_through_their_points() {
        let points = [Vec2::ZERO, Vec2::new(1.0, 2.0), Vec2::new(3.0, 1.0)];
        let smooth = curve(&points);
        for (i, point) in points.iter().enumerate() {
            assert_eq!(smooth[i * STEPS], *point);
        }
    }
}
