//! What hair cannot enter: the head, which turns, and the shoulders, which don't.

use glam::{DVec3, Vec3};
use hair_io::Mesh;
use hair_sim::{Collider, Pose, Shape, SignedDistance};
use render::Head;

/// Heights from the head's middle, in head heights: the head's body ends at the one below, the
/// shoulders' at the other, inside the neck.
const HEAD_ENDS: f32 = -0.55;
const SHOULDERS_END: f32 = -0.45;
/// Cells of the distances, in head heights: ears show, arms need not.
const HEAD_CELL: f64 = 1.0 / 40.0;
const BODY_CELL: f64 = 1.0 / 16.0;
/// How far from the skin carried hair is kept, in head heights.
const GAP: f64 = 0.005;

/// Distances from head and shoulders.
pub(crate) struct Bodies {
    head: Option<SignedDistance>,
    shoulders: Option<SignedDistance>,
    height_m: f64,
}

impl Bodies {
    /// The bodies of a head's mesh; none without one.
    pub fn new(mesh: Option<&Mesh>, head: Head) -> Self {
        let height_m = f64::from(head.height_m);
        let half = |below: f32, keeps_above: bool, cell: f64| {
            let mesh = mesh?;
            let level = head.center.y + below * head.height_m;
            let end = Vec3::new(head.center.x, level, head.center.z - 0.12 * head.height_m);
            let (points, triangles) = cut(mesh, |p| (p.y > level) == keeps_above, end);
            // A mesh without a part there, or too large for a grid, has no body there.
            SignedDistance::new(&points, &triangles, cell * height_m).ok()
        };
        Self {
            head: half(HEAD_ENDS, true, HEAD_CELL),
            shoulders: half(SHOULDERS_END, false, BODY_CELL),
            height_m,
        }
    }

    /// The bodies in a step in which the head and the shoulders move from one pose to another.
    pub fn colliders(&self, head: [Pose; 2], shoulders: [Pose; 2]) -> Vec<Collider<'_>> {
        let bodies = [(&self.head, head), (&self.shoulders, shoulders)];
        let mut colliders = Vec::with_capacity(bodies.len());
        for (body, [before, now]) in bodies {
            colliders.extend(body.as_ref().map(|grid| Collider {
                shape: Shape::Grid(grid),
                before,
                now,
            }));
        }
        colliders
    }

    /// Puts points that are in the head on its skin.
    pub fn keep_out(&self, pose: Pose, points: &mut [Vec3]) {
        let Some(grid) = &self.head else { return };
        let gap = GAP * self.height_m;
        for point in points {
            let place = pose.rotation.inverse() * (point.as_dvec3() - pose.translation);
            let distance = grid.distance(place);
            if distance < gap {
                let out = outwards(grid, place, HEAD_CELL * self.height_m);
                let place = place + out * (gap - distance);
                *point = (pose.rotation * place + pose.translation).as_vec3();
            }
        }
    }
}

/// The way in which the distance grows, a unit vector.
fn outwards(grid: &SignedDistance, at: DVec3, step: f64) -> DVec3 {
    let slope = |axis: DVec3| grid.distance(at + axis * step) - grid.distance(at - axis * step);
    DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z)).normalize_or(DVec3::Y)
}

/// The part of a mesh that is kept, closed by a cone to `end`.
fn cut(mesh: &Mesh, keeps: impl Fn(Vec3) -> bool, end: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let points: Vec<Vec3> = mesh
        .positions
        .iter()
        .map(|p| if keeps(*p) { *p } else { end })
        .collect();
    let has_area = |triangle: &&[u32; 3]| {
        let kept = triangle
            .iter()
            .filter(|i| keeps(mesh.positions[**i as usize]));
        kept.count() >= 2
    };
    let triangles = mesh.triangles.iter().filter(has_area).copied().collect();
    (points, triangles)
}
