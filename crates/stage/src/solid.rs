//! A ball within a head that nothing is seen through.

use glam::Vec3;
use hair_io::Mesh;
use render::{Ball, Head};

/// Cells along each edge of a cube around the ball's middle: directions in which there is skin, or a hole.
const CELLS: usize = 8;
/// Of the ball that just fits, the part that is taken: sights through it then meet the skin at directions within 72 degrees of the
/// eye's.
const PART: f32 = 0.95;
/// The least cosine of the angle between the eye's direction and those in which there must be skin.
const NEAREST: f32 = 0.15;
/// How far the middle may be from the head's, in head heights, and in how many steps it is looked for.
const FARTHEST: f32 = 0.1;
const STEPS: usize = 24;

/// The ball, in the coordinates of the head at rest.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    ball: Ball,
    /// How far from the ball's middle the nearest skin in the direction of each cell is, metres; infinite where there is none.
    skin_m: [f32; 6 * CELLS * CELLS],
}

impl Solid {
    /// The largest ball near the head's middle that holds no part of the mesh, less a margin; none of a mesh without corners. `opaque` are the triangles that are drawn and that nothing is seen through.
    pub fn within(
        mesh: &Mesh,
        opaque: impl IntoIterator<Item = [Vec3; 3]>,
        head: Head,
    ) -> Option<Self> {
        let triangles = || corners(&mesh.positions, &mesh.triangles);
        // No point of a triangle is farther from its first corner than its longer edge there; a little more, for rounding.
        let reaches: Vec<f32> = triangles()
            .map(|[a, b, c]| 1.001 * a.distance(b).max(a.distance(c)))
            .collect();
        let nearest = |center: Vec3| -> Option<Vec3> {
            let mut best: Option<(f32, Vec3)> = None;
            for (triangle, reach) in triangles().zip(&reaches) {
                let least = (0.999 * triangle[0].distance(center) - reach).max(0.0);
                if best.is_some_and(|(squared, _)| least * least > squared) {
                    continue;
                }
                let point = nearest_on(triangle, center);
                let squared = point.distance_squared(center);
                if best.is_none_or(|(best, _)| squared < best) {
                    best = Some((squared, point));
                }
            }
            best.map(|(_, point)| point)
        };
        let mut best = (head.center, nearest(head.center)?.distance(head.center));
        let mut center = head.center;
        for step in 0..STEPS {
            let skin = nearest(center)?;
            let radius = skin.distance(center);
            if radius > best.1 {
                best = (center, radius);
            }
            // Away from the nearest skin, by ever less.
            let way = 0.04 * head.height_m * (1.0 - step as f32 / STEPS as f32);
            center += way * (center - skin).normalize_or_zero();
            center =
                head.center + (center - head.center).clamp_length_max(FARTHEST * head.height_m);
        }
        let (center, radius) = best;
        let mut skin_m = [f32::INFINITY; 6 * CELLS * CELLS];
        for triangle in opaque {
            let seen = triangle.map(|corner| (corner - center).normalize_or_zero());
            let widest = (0..3).map(|i| seen[i].distance(seen[(i + 1) % 3]));
            // Places closer to each other than half a cell.
            let steps = (widest.fold(0.0, f32::max) * CELLS as f32).ceil().max(1.0) as usize;
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let [a, b] = [i, j].map(|k| k as f32 / steps as f32);
                    let point = a * triangle[0] + b * triangle[1] + (1.0 - a - b) * triangle[2];
                    let nearest = &mut skin_m[cell(point - center)];
                    *nearest = nearest.min(point.distance(center));
                }
            }
        }
        let radius_m = PART * radius;
        (radius_m > 0.0 && radius_m.is_finite()).then_some(Self {
            ball: Ball { center, radius_m },
            skin_m,
        })
    }

    /// The ball, where an eye at this place, which sees nothing nearer than `near_m` metres, sees skin before all of it.
    pub fn seen_from(&self, eye: Vec3, near_m: f32) -> Option<Ball> {
        let way = eye - self.ball.center;
        let (distance, to_eye) = (way.length(), way.normalize_or_zero());
        let mut cells = (0..).zip(&self.skin_m);
        let is_covered = |(cell, skin_m): (usize, &f32)| {
            middle(cell).dot(to_eye) <= NEAREST || *skin_m < distance - near_m
        };
        cells.all(is_covered).then_some(self.ball)
    }
}

/// The corners of triangles.
pub(crate) fn corners<'a>(
    positions: &'a [Vec3],
    triangles: &'a [[u32; 3]],
) -> impl Iterator<Item = [Vec3; 3]> + 'a {
    (triangles.iter()).map(|triangle| triangle.map(|i| positions[i as usize]))
}

/// The cell of a direction: of the cube's faces +X, -X, +Y, -Y, +Z, -Z.
fn cell(direction: Vec3) -> usize {
    let size = direction.abs();
    let axis = match size.max_element() {
        most if most == size.x => 0,
        most if most == size.y => 1,
        _ => 2,
    };
    let face = 2 * axis + usize::from(direction[axis] < 0.0);
    let place = |other: usize| {
        let along = 0.5 + 0.5 * direction[(axis + other) % 3] / size[axis].max(f32::MIN_POSITIVE);
        ((along * CELLS as f32) as usize).min(CELLS - 1)
    };
    (face * CELLS + place(1)) * CELLS + place(2)
}

/// The unit vector to a cell's middle.
fn middle(cell: usize) -> Vec3 {
    let (face, place) = (cell / (CELLS * CELLS), cell % (CELLS * CELLS));
    let axis = face / 2;
    let along = |k: usize| (k as f32 + 0.5) / (0.5 * CELLS as f32) - 1.0;
    let mut direction = Vec3::ZERO;
    direction[axis] = if face % 2 == 0 { 1.0 } else { -1.0 };
    direction[(axis + 1) % 3] = along(place / CELLS);
    direction[(axis + 2) % 3] = along(place % CELLS);
    direction.normalize()
}

/// The point of a triangle that is nearest to `point` (Ericson, *Real-Time Collision Detection*, 2005, 5.1.5).
fn nearest_on([a, b, c]: [Vec3; 3], point: Vec3) -> Vec3 {
    let on_edge = |from: Vec3, to: Vec3| {
        let edge = to - from;
        let way = (point - from).dot(edge) / edge.length_squared().max(f32::MIN_POSITIVE);
        from + way.clamp(0.0, 1.0) * edge
    };
    let normal = (b - a).cross(c - a);
    let is_inside = |from: Vec3, to: Vec3| (to - from).cross(point - from).dot(normal) >= 0.0;
    if normal != Vec3::ZERO && is_inside(a, b) && is_inside(b, c) && is_inside(c, a) {
        let unit = normal.normalize_or_zero();
        return point - (point - a).dot(unit) * unit;
    }
    let edges = [on_edge(a, b), on_edge(b, c), on_edge(c, a)];
    let distance = |p: &Vec3| p.distance_squared(point);
    edges
        .into_iter()
        .min_by(|p, q| distance(p).total_cmp(&distance(q)))
        .unwrap_or(a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HairModel, HeadModel};
    use hair_sim::Strands;

    #[test]
    fn a_cell_is_the_one_of_its_middle() {
        for i in 0..6 * CELLS * CELLS {
            assert_eq!(cell(middle(i)), i);
        }
    }

    #[test]
    fn the_nearest_point_of_a_triangle() {
        let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
        for (point, expected) in [
            ([0.2, 0.2, 3.0], [0.2, 0.2, 0.0]),
            ([-1.0, -1.0, 1.0], [0.0, 0.0, 0.0]),
            ([0.5, -2.0, 1.0], [0.5, 0.0, 0.0]),
            ([2.0, 2.0, 0.0], [0.5, 0.5, 0.0]),
        ] {
            let found = nearest_on(triangle, point.into());
            assert!(found.distance(expected.into()) < 1e-6, "{point:?}: {found}");
        }
    }

    /// A cube, whose front is open or not.
    fn cube(has_front: bool) -> Mesh {
        let corner = |i: usize| {
            let side = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
            Vec3::new(side(0), side(1), side(2))
        };
        let mut triangles = Vec::new();
        for axis in 0..3 {
            for side in 0..2 {
                if axis == 2 && side == 1 && !has_front {
                    continue;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let at = |a: usize, b: usize| (side << axis | a << u | b << v) as u32;
                triangles.push([at(0, 0), at(1, 0), at(1, 1)]);
                triangles.push([at(0, 0), at(1, 1), at(0, 1)]);
            }
        }
        Mesh {
            positions: (0..8).map(corner).collect(),
            normals: vec![Vec3::Z; 8],
            triangles,
        }
    }

    fn within(mesh: &Mesh, head: Head) -> Option<Solid> {
        Solid::within(mesh, corners(&mesh.positions, &mesh.triangles), head)
    }

    #[test]
    fn a_ball_hides_where_there_is_skin_before_it() {
        let head = Head {
            center: Vec3::new(0.05, 0.0, 0.0),
            height_m: 2.0,
        };
        let solid = within(&cube(true), head).unwrap();
        let ball = solid.seen_from(Vec3::new(0.0, 0.0, 9.0), 0.1).unwrap();
        assert!(ball.radius_m > 0.9 && ball.radius_m <= PART, "{ball:?}");
        // Of glass in front.
        let (whole, glass) = (cube(true), cube(false));
        let front = corners(&glass.positions, &glass.triangles);
        let open = Solid::within(&whole, front, head).unwrap();
        assert_eq!(open.seen_from(Vec3::new(0.0, 0.0, 9.0), 0.1), None);
        let open = within(&cube(false), head).unwrap();
        assert_eq!(open.seen_from(Vec3::new(0.0, 0.0, 9.0), 0.1), None);
        assert!(open.seen_from(Vec3::new(0.0, 0.0, -9.0), 0.1).is_some());
        // Within the cube, and so near that its front is cut.
        assert_eq!(solid.seen_from(Vec3::new(0.0, 0.0, 0.99), 0.0), None);
        assert_eq!(solid.seen_from(Vec3::new(0.0, 0.0, 1.5), 0.6), None);
    }

    #[test]
    fn the_bust_is_solid_from_all_sides() {
        let bust = HeadModel::bust();
        let mut strands = Strands::new();
        let strand = [[0.0, 1.68, 0.06], [0.0, 1.66, 0.11]].map(Vec3::from);
        strands.push(0, &strand, Some(9.0)).unwrap();
        let head = HairModel::new(strands, Some(&bust)).unwrap().head;
        let solid = within(&bust.mesh, head).unwrap();
        assert!(solid.ball.radius_m > 0.2 * head.height_m, "{solid:?}");
        for eye in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::Z, Vec3::NEG_Z] {
            assert!(
                solid.seen_from(head.center + 3.0 * eye, 0.01).is_some(),
                "{eye}"
            );
        }
    }
}
