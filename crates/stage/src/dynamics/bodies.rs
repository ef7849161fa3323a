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

/// No strand keeps farther from a body, m.
const MOST_ROOM_M: f64 = 0.1;

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
            radius_m: 1.1 * f64::from(farthest) + 0.25 * f64::from(head.height_m) + MOST_ROOM_M,
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

    /// Which of the script's bodies may come within reach of hair in such a step as [`Self::colliders`] are of: what never meets others needs no distances of theirs, and sleeps as they move.
    /// All, where there is no figure: the first is taken for it.
    pub fn near(
        &self,
        reach: Reach,
        script: &MotionScript,
        times: [f64; 2],
        postures: [&Posture; 2],
    ) -> Vec<bool> {
        let has_figure = self.of_figure() > 0;
        let times = times.map(|time| script.within(time));
        let is_near = |body: &Arc<Body>| !has_figure || body.comes_within(reach, times, postures);
        script.bodies.iter().map(is_near).collect()
    }

    /// [`Self::colliders`] of what is [`near`](Self::near).
    pub fn within<'a>(
        &'a self,
        reach: Reach,
        script: &'a MotionScript,
        times: [f64; 2],
        postures: [&Posture<'a>; 2],
    ) -> Vec<Collider<'a>> {
        let near = self.near(reach, script, times, postures);
        self.colliders(script, times, postures, &near)
    }

    /// The bodies in a step of this script between two times (seconds), at which the figure stands so; of the script's own those that are `near`.
    pub fn colliders<'a>(
        &'a self,
        script: &'a MotionScript,
        times: [f64; 2],
        [before, now]: [&Posture<'a>; 2],
        near: &[bool],
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
        let own = script.bodies.iter().zip(near).filter(|(_, near)| **near);
        colliders.extend(own.map(|(body, _)| body.collider(times, [before, now])));
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
