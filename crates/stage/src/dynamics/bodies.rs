//! What hair cannot enter: the head, which turns, the shoulders, which don't, and the bodies of a preset and its script.

use crate::bodies::Body;
use crate::posture::Posture;
use crate::script::MotionScript;
use glam::{DVec3, Vec3};
use hair_io::Mesh;
use hair_sim::{Collider, Shape, SignedDistance};
use render::Head;
use std::sync::Arc;

/// Heights from the head's middle, in head heights: the head's body ends at the one below, the
/// shoulders' at the other, inside the neck and below the chin, which is at a half.
pub(super) const HEAD_ENDS: f32 = -0.62;
pub(super) const SHOULDERS_END: f32 = -0.54;
/// Cells of the distances, in head heights: ears show, and where a neck goes over into shoulders.
const HEAD_CELL: f64 = 1.0 / 40.0;
const BODY_CELL: f64 = 1.0 / 42.0;
/// How far from bodies hair is drawn, m, but where it starts nearer: paths bulge between their points.
pub(super) const GAP_M: f32 = 1.4e-3;

/// The shape of a head and what is below.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct BodyMesh<'m> {
    pub mesh: &'m Mesh,
    /// Whether it may be of several pieces, as a character's is: hair, skin and clothes.
    pub has_pieces: bool,
}

/// How far hair comes from a place of its head, the room that it keeps from bodies and all.
#[derive(Clone, Copy)]
pub(crate) struct Reach {
    /// The place, on a head at rest.
    pub around: DVec3,
    pub radius_m: f64,
}

impl Reach {
    /// Of strands by their points, root first: none comes farther from its root than it is long, but for the little by which links stretch.
    pub fn of<'s>(strands: impl Iterator<Item = &'s [Vec3]>, head: Head) -> Self {
        let reach = |points: &[Vec3]| {
            let from_root = points.first()?.distance(head.center);
            let links = points.windows(2).map(|link| link[0].distance(link[1]));
            Some(from_root + links.sum::<f32>())
        };
        let farthest = strands.filter_map(reach).fold(0.0, f32::max);
        Self {
            around: head.center.as_dvec3(),
            radius_m: 1.1 * f64::from(farthest) + 0.25 * f64::from(head.height_m),
        }
    }
}

/// Distances from head and shoulders.
pub(crate) struct Bodies {
    head: Option<SignedDistance>,
    shoulders: Option<SignedDistance>,
}

impl Bodies {
    /// The bodies of a head's mesh, which may be one of pieces; none without one.
    pub fn new(mesh: Option<BodyMesh>, head: Head) -> Self {
        let height_m = f64::from(head.height_m);
        let half = |below: f32, keeps_above: bool, cell: f64| {
            let BodyMesh { mesh, has_pieces } = mesh?;
            let level = head.center.y + below * head.height_m;
            let end = Vec3::new(head.center.x, level, head.center.z - 0.12 * head.height_m);
            let (points, triangles) = cut(mesh, |p| (p.y > level) == keeps_above, end);
            // A mesh without a part there, or too large for a grid, has no body there.
            let distances = match has_pieces {
                true => SignedDistance::of_pieces,
                false => SignedDistance::new,
            };
            distances(&points, &triangles, cell * height_m).ok()
        };
        let (head, shoulders) = rayon::join(
            || half(HEAD_ENDS, true, HEAD_CELL),
            || half(SHOULDERS_END, false, BODY_CELL),
        );
        Self { head, shoulders }
    }

    /// How many of [`colliders`](Self::colliders), the first ones, are head and shoulders.
    pub fn of_figure(&self) -> usize {
        usize::from(self.head.is_some()) + usize::from(self.shoulders.is_some())
    }

    /// All bodies in a step of this script between two times (seconds), at which the figure stands so, but for a scene's own that are out of `reach`, if
    /// one is given: hair that never meets them needs no distances of theirs, and sleeps as they move.
    pub fn colliders<'a>(
        &'a self,
        script: &'a MotionScript,
        times: [f64; 2],
        [before, now]: [&Posture<'a>; 2],
        reach: Option<Reach>,
    ) -> Vec<Collider<'a>> {
        let grids = [
            (&self.head, [before.head, now.head]),
            (&self.shoulders, [before.shoulders, now.shoulders]),
        ];
        let mut colliders = Vec::with_capacity(grids.len() + script.bodies.len());
        for (body, [before, now]) in grids {
            colliders.extend(body.as_ref().map(|grid| Collider {
                shape: Shape::Grid(grid),
                before,
                now,
                was: None,
            }));
        }
        if let (Some(skeleton), [Some(from), Some(to)]) = (
            script.skeleton(),
            [before, now].map(|posture| posture.bones.as_ref()),
        ) {
            colliders.extend(skeleton.colliders([from, to], [before.figure, now.figure]));
        }
        let times = times.map(|time| script.within(time));
        let postures = [before, now];
        let is_near =
            |body: &&Arc<Body>| reach.is_none_or(|reach| body.comes_within(reach, times, postures));
        let own = script.bodies.iter().filter(is_near);
        colliders.extend(own.map(|body| body.collider(times, postures)));
        colliders
    }
}

/// The part of a mesh that is kept, closed by a cone to `end`.
pub(super) fn cut(
    mesh: &Mesh,
    keeps: impl Fn(Vec3) -> bool,
    end: Vec3,
) -> (Vec<Vec3>, Vec<[u32; 3]>) {
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
