//! Pieces of cloth with a shape of their own: closed meshes that lie on the body.

use super::dress::Cloth;
use crate::ribbon::curve;
use crate::solid::gradient;
use glam::{Vec2, Vec3};

/// A closed mesh.
pub(crate) struct Piece {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// One a triangle.
    pub cloth: Vec<Cloth>,
    /// Whether light falls on it as on the body below, not as on a body of its own.
    pub is_lit_as_body: bool,
}

/// A smooth curve through points.
fn curve_in_space(points: &[Vec3]) -> Vec<Vec3> {
    let along = curve(&points.iter().map(|p| p.truncate()).collect::<Vec<_>>());
    let depths = curve(
        &points
            .iter()
            .map(|p| Vec2::new(p.z, 0.0))
            .collect::<Vec<_>>(),
    );
    let joints = along.iter().zip(&depths);
    joints.map(|(p, z)| p.extend(z.x)).collect()
}

/// Without the small waves of what a row lies on; its ends stay.
fn smoothed(mut row: Vec<Vec3>) -> Vec<Vec3> {
    const ROUNDS: usize = 12;
    for _ in 0..ROUNDS {
        let means = row.windows(3).map(|p| (p[0] + 2.0 * p[1] + p[2]) / 4.0);
        let means: Vec<Vec3> = means.collect();
        let last = row.len() - 1;
        row[1..last].copy_from_slice(&means);
    }
    row
}

/// How a row of a band lies to the surface below, metres.
#[derive(Clone, Copy)]
pub(crate) enum Lie {
    /// This far over it; below 0 in it.
    At(f32),
    /// This far over it or farther, where it is.
    Over(f32),
}

/// A row of a band.
pub(crate) struct Row {
    /// Where it runs, before it is laid on the surface.
    pub points: Vec<Vec3>,
    pub lie: Lie,
    /// What is between it and the next.
    pub cloth: Cloth,
    /// How many rows are put between it and the next, on the straight way from the one to the other or over what lies in it.
    pub between: usize,
}

/// How a band's rows run.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Run {
    /// Without kinks.
    Smooth,
    /// With the corners that they are given.
    Cornered,
}

/// `p`, moved to lie so on the surface of `on`.
fn laid(mut p: Vec3, lie: Lie, on: &impl Fn(Vec3) -> f32) -> Vec3 {
    for _ in 0..12 {
        let missing = match lie {
            Lie::At(gap) => gap - on(p),
            Lie::Over(gap) => (gap - on(p)).max(0.0),
        };
        if missing != 0.0 {
            let along = gradient(on, p, 0.002).normalize_or(Vec3::Y);
            // In the middle of the back it stays there.
            let along = if p.x == 0.0 { along.with_x(0.0) } else { along };
            p += along * (missing * 0.8);
        }
    }
    p
}

/// The first of two ends and so many points between them, on the straight way to the other or `gap` over what lies in it, without a kink.
fn bridge(ends: [Vec3; 2], count: usize, gap: f32, on: &impl Fn(Vec3) -> f32) -> Vec<Vec3> {
    const ROUNDS: usize = 12;
    let share = |i: usize| i as f32 / (count + 1) as f32;
    let points = (0..=count + 1).map(|i| ends[0].lerp(ends[1], share(i)));
    let mut points: Vec<Vec3> = points.collect();
    for _ in 0..ROUNDS {
        for i in 1..=count {
            let mean = (points[i - 1] + 2.0 * points[i] + points[i + 1]) / 4.0;
            points[i] = laid(mean, Lie::Over(gap), on);
        }
    }
    points.pop();
    points
}

/// A band from the middle of the back, at x = 0, to its end on one side. `rows` run along it, around its
/// section, and lie on the surface of `on`.
pub(crate) fn band(rows: &[Row], run: Run, on: impl Fn(Vec3) -> f32) -> Piece {
    let on_body = |row: &Row| -> Vec<Vec3> {
        let points = curve_in_space(&row.points).into_iter();
        let points = points.map(|p| laid(p, row.lie, &on)).collect();
        let (Lie::At(gap) | Lie::Over(gap)) = row.lie;
        // Of what lies in it nobody sees kinks.
        if run == Run::Cornered || gap <= 0.0 {
            return points;
        }
        let smooth = smoothed(points).into_iter();
        smooth.map(|p| laid(p, Lie::Over(gap), &on)).collect()
    };
    let given: Vec<Vec<Vec3>> = rows.iter().map(on_body).collect();
    // Each section of the band runs around it.
    let mut sections = vec![Vec::new(); given[0].len()];
    let mut cloth = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let next = (i + 1) % rows.len();
        let (Lie::At(gap) | Lie::Over(gap)) = rows[next].lie;
        for (k, section) in sections.iter_mut().enumerate() {
            section.extend(bridge([given[i][k], given[next][k]], row.between, gap, &on));
        }
        cloth.resize(sections[0].len(), row.cloth);
    }
    let (around, along) = (cloth.len() as u32, sections.len() as u32);
    let mut piece = Piece {
        positions: sections.concat(),
        triangles: Vec::new(),
        cloth: Vec::new(),
        is_lit_as_body: true,
    };
    for i in 0..along - 1 {
        for k in 0..around {
            let (a, b) = (i * around + k, i * around + (k + 1) % around);
            let (c, d) = (a + around, b + around);
            piece.triangles.extend([[a, b, c], [b, d, c]]);
            piece.cloth.extend([cloth[k as usize]; 2]);
        }
    }
    let end = (along - 1) * around;
    for k in 1..around - 1 {
        piece.triangles.push([end, end + k, end + k + 1]);
        piece.cloth.push(cloth[0]);
    }
    // The open end lies in a plane through 0, which adds nothing to the volume.
    let volume: f32 = piece
        .triangles
        .iter()
        .map(|t| volume(&piece.positions, *t))
        .sum();
    if volume < 0.0 {
        piece.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    piece
}

/// Six times the signed volume between a triangle and 0.
fn volume(positions: &[Vec3], triangle: [u32; 3]) -> f32 {
    let [a, b, c] = triangle.map(|i| positions[i as usize]);
    a.dot(b.cross(c))
}

/// A flat piece in front of the body: an outline in millimetres around `at`, laid `height` metres above
/// the surface of `on`.
pub(crate) fn slab(
    at: Vec2,
    outline: &[(f32, f32)],
    height: f32,
    cloth: Cloth,
    on: &impl Fn(Vec3) -> f32,
) -> Piece {
    let mut points: Vec<Vec2> = outline
        .iter()
        .map(|(x, y)| at + Vec2::new(*x, *y) * 1e-3)
        .collect();
    let area: f32 = (0..points.len())
        .map(|i| points[i].perp_dot(points[(i + 1) % points.len()]))
        .sum();
    if area < 0.0 {
        points.reverse();
    }
    // Long edges follow the body.
    let mut edge = Vec::new();
    for (i, from) in points.iter().enumerate() {
        let to = points[(i + 1) % points.len()];
        let steps = ((to - *from).length() / 0.03).ceil().max(1.0);
        edge.extend((0..steps as usize).map(|step| from.lerp(to, step as f32 / steps)));
    }
    let surface = |p: Vec2| {
        let mut z = 0.15;
        for _ in 0..60 {
            z -= on(p.extend(z)) * 0.9;
        }
        z
    };
    let count = edge.len() as u32;
    let front = edge.iter().map(|p| p.extend(surface(*p) + height));
    let back = edge.iter().map(|p| p.extend(surface(*p) - 0.003));
    let positions: Vec<Vec3> = front.chain(back).collect();
    let mut triangles = Vec::new();
    for [a, b, c] in ears(&edge) {
        triangles.extend([[a, b, c], [count + a, count + c, count + b]]);
    }
    for i in 0..count {
        let next = (i + 1) % count;
        triangles.extend([[i, count + i, next], [next, count + i, count + next]]);
    }
    Piece {
        cloth: vec![cloth; triangles.len()],
        positions,
        triangles,
        is_lit_as_body: false,
    }
}

/// A simple outline, counter-clockwise, in triangles: ears are cut off one after the other.
fn ears(outline: &[Vec2]) -> Vec<[u32; 3]> {
    let mut left: Vec<u32> = (0..outline.len() as u32).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let count = left.len();
        let corner = |i: usize| {
            [
                left[(i + count - 1) % count],
                left[i % count],
                left[(i + 1) % count],
            ]
        };
        let turn = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| outline[i as usize]);
            (b - a).perp_dot(c - b)
        };
        let is_ear = |i: &usize| {
            let [a, b, c] = corner(*i);
            let is_in = |p: &u32| {
                ![a, b, c].contains(p)
                    && [[a, b, *p], [b, c, *p], [c, a, *p]]
                        .iter()
                        .all(|t| turn(*t) > 0.0)
            };
            turn([a, b, c]) > 0.0 && !left.iter().any(is_in)
        };
        // Of the ears the one that is cut off by the shortest way, so that triangles stay compact.
        let width = |i: usize| {
            let [a, _, c] = corner(i);
            outline[a as usize].distance(outline[c as usize])
        };
        let ears = (0..count).filter(is_ear);
        let ear = ears
            .min_by(|a, b| width(*a).total_cmp(&width(*b)))
            .unwrap_or(0);
        triangles.push(corner(ear));
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}
