//! Stroke paths: the joints of strands as a camera sees them (thesis 4.2).

use crate::camera::Camera;
use crate::cuts::Cut;
use crate::detail::Detail;
use crate::resample::{PathError, PathKind};
use glam::{Quat, Vec2, Vec3};
use std::ops::Range;

/// Shorter segments have no direction of their own (m).
const MIN_LENGTH_M: f32 = 1e-12;
/// Joints farther from the picture's corner (px) belong to strands that no picture can mean.
const FARTHEST_PX: f32 = 1e8;
/// The least angle (rad, about) between a strand and the line of sight at which the strand has a direction
/// on the screen. Rounding turns that direction by less than 1e-2 rad there.
const MIN_ANGLE: f32 = 1e-4;

/// A connected part of one strand's path. A strand that passes through the near plane has several, and so has
/// one that is cut.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathRun {
    /// The strand's index, as it was given.
    pub strand: usize,
    /// The number of the piece: what is ordered as one strand. The strand's index, but for the pieces that strands
    /// before it, and it itself up to there, were cut into besides.
    pub piece: usize,
    /// Its joints in the lists of [`Paths`], from the root's side to the tip's. At least two, but for
    /// a strand of a single particle, which has one.
    pub joints: Range<usize>,
    /// How many of the first joints are also the last ones of the run before: of the piece before, which it overlaps.
    pub overlap: usize,
}

/// The visible joints of many strands' paths, as parallel lists.
///
/// Kept from frame to frame: [`Self::clear`] and [`Self::push_strand`] reuse the memory.
#[derive(Clone, Debug, Default)]
pub struct Paths {
    /// Which joints belong together, by strand in the order given, from root to tip.
    pub runs: Vec<PathRun>,
    /// In the world, in metres.
    pub position: Vec<Vec3>,
    /// Position along the strand by particles, i / num, from 0 at the root to 1 at the tip (thesis
    /// 5.1). 0 for a strand of one particle.
    pub u: Vec<f32>,
    /// Length of the path from the root to the joint, in metres.
    pub arc_length: Vec<f32>,
    /// F: the world's unit vector towards the next joint; at the tip that of the joint before.
    ///
    /// Joints that coincide count as one here. A strand without any length hangs down: -Y.
    pub forward: Vec<Vec3>,
    /// B: the world's unit vector towards the previous joint; at the root that of the next joint. A
    /// strand without any length has +Y.
    pub backward: Vec<Vec3>,
    /// On the screen, in pixels.
    pub center: Vec<Vec2>,
    /// View depth in metres, at least the camera's near distance. Where a piece goes on beyond its [`Cut`],
    /// deeper by the way along the strand from there.
    pub depth: Vec<f32>,
    /// Pixels that a metre takes there ([`Camera::px_per_metre`]). From twice the near distance to once it falls to
    /// next to nothing: strokes are thin when they are cut, or hair along the near plane would vanish at once.
    pub px_per_metre: Vec<f32>,
    /// The screen's unit vector across the path (thesis 5.3, Fig 5.9): the projection of F turned by
    /// +90 degrees, from x to y; as y points down, that is the right-hand side of who walks from root
    /// to tip. For hair that hangs down it is -x.
    ///
    /// Where the strand runs along the line of sight it is that of the run's joint before, or +x.
    pub across: Vec<Vec2>,
    /// Whether directions are those of tangents.
    along_tangents: bool,
    dropped: usize,
    /// Pieces so far, less one for each strand.
    cut: usize,
    /// The strand in work, before clipping.
    whole: Vec<WorldJoint>,
    /// Which joints of it there are, by number, and how much of each; and where they are.
    kept: Vec<(usize, f32)>,
    places: Vec<Vec3>,
}

/// What is known of a joint before it is projected.
#[derive(Clone, Copy, Debug)]
struct WorldJoint {
    position: Vec3,
    view: Vec3,
    u: f32,
    arc_length: f32,
    forward: Vec3,
    backward: Vec3,
    /// How much deeper than there it is ordered, metres.
    sink: f32,
}

impl Paths {
    /// No paths.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets all paths, but keeps their memory.
    pub fn clear(&mut self) {
        self.runs.clear();
        self.dropped = 0;
        self.cut = 0;
        self.truncate(0);
    }

    /// Whether, of strands from now on, F and -B are one: the mean of both, the strand's own direction at the joint. A link's direction is that of
    /// the strand in the link's middle: light that goes by B is half a link too near the tip.
    pub fn set_along_tangents(&mut self, along_tangents: bool) {
        self.along_tangents = along_tangents;
    }

    /// The number of joints of all runs.
    #[must_use]
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether no joint is visible.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// How many strands were left out since [`Self::clear`], because their points are so far away
    /// that lengths exceed what an `f32` can hold, or screen positions 1e8 pixels.
    #[must_use]
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Turns and then moves (m) the places and directions in the world of some joints; where they are on the screen stays. For
    /// strands that a camera [in their own coordinates](Camera::seen_from) has seen.
    ///
    /// # Panics
    ///
    /// When there are no such joints.
    pub fn place(&mut self, joints: Range<usize>, rotation: Quat, translation: Vec3) {
        for position in &mut self.position[joints.clone()] {
            *position = rotation * *position + translation;
        }
        let directions = self.forward[joints.clone()].iter_mut();
        for direction in directions.chain(&mut self.backward[joints]) {
            *direction = rotation * *direction;
        }
    }

    /// Appends what the camera sees of a strand: its particles from root to tip, in metres.
    ///
    /// What is nearer than the camera's near distance, or behind the eye, is cut off: where the path
    /// crosses the near plane it gains a joint, with everything interpolated. What the joints hold
    /// is worked out on the whole strand first, so cutting changes none of it. A strand that isn't
    /// seen, or has no particle, adds no run.
    ///
    /// # Errors
    ///
    /// When the subdivision is not within 1 to 64. Nothing is appended then.
    pub fn push_strand(
        &mut self,
        strand: usize,
        particles: &[Vec3],
        kind: PathKind,
        camera: &Camera,
    ) -> Result<(), PathError> {
        self.push_pieces(strand, particles, &[], None, kind, camera)
    }

    /// As [`Self::push_strand`], for a strand that is cut into pieces; [`cuts`](crate::cuts()) says where, from the strand
    /// at rest. Joints of an overlap are in both pieces. With a `detail`, which is of the same strand, path and cuts, there are
    /// the joints that a picture needs, else all.
    ///
    /// # Errors
    ///
    /// When the subdivision is not within 1 to 64, or a cut is beyond the strand's end, or the detail is of another number of joints. Nothing
    /// is appended then.
    pub fn push_pieces(
        &mut self,
        strand: usize,
        particles: &[Vec3],
        cuts: &[Cut],
        detail: Option<&Detail>,
        kind: PathKind,
        camera: &Camera,
    ) -> Result<(), PathError> {
        let count = kind.count(particles)?;
        if (cuts.iter()).any(|cut| *cut.overlap.end() >= count) {
            return Err(PathError::Cut);
        }
        if detail.is_some_and(|detail| detail.len() != count) {
            return Err(PathError::Detail);
        }
        self.place_joints(particles, detail, kind, camera)?;
        self.find_directions();
        if self.along_tangents {
            for joint in &mut self.whole {
                joint.forward = (joint.forward - joint.backward).normalize_or(joint.forward);
                joint.backward = -joint.forward;
            }
        }
        let (runs, joints) = (self.runs.len(), self.len());
        let mut finite = self.whole.iter().all(WorldJoint::is_finite);
        if finite {
            for number in 0..=cuts.len() {
                let before = number.checked_sub(1).map(|i| &cuts[i]);
                let part = self.piece([before, cuts.get(number)]);
                self.clip(strand, strand + self.cut + number, part, camera);
            }
            finite = self.center[joints..]
                .iter()
                .all(|c| c.abs().max_element() <= FARTHEST_PX);
        }
        if !finite {
            self.runs.truncate(runs);
            self.truncate(joints);
            self.dropped += 1;
        }
        self.cut += cuts.len();
        Ok(())
    }

    /// Leaves out a strand that nobody sees and that is cut there, so that the pieces after it have the numbers that they would have.
    pub fn leave_out(&mut self, cuts: &[Cut]) {
        self.cut += cuts.len();
    }

    /// Appends all paths of `other`, of strands behind those so far: the same, bit for bit, as if they had been appended here. So
    /// that parts of many strands can be made beside each other.
    pub fn append(&mut self, other: &Self) {
        let joints = self.len();
        self.runs.extend(other.runs.iter().map(|run| PathRun {
            piece: run.piece + self.cut,
            joints: run.joints.start + joints..run.joints.end + joints,
            ..run.clone()
        }));
        self.position.extend_from_slice(&other.position);
        self.u.extend_from_slice(&other.u);
        self.arc_length.extend_from_slice(&other.arc_length);
        self.forward.extend_from_slice(&other.forward);
        self.backward.extend_from_slice(&other.backward);
        self.center.extend_from_slice(&other.center);
        self.depth.extend_from_slice(&other.depth);
        self.px_per_metre.extend_from_slice(&other.px_per_metre);
        self.across.extend_from_slice(&other.across);
        self.dropped += other.dropped;
        self.cut += other.cut;
    }

    /// Fills `whole` with the strand's joints, but for their directions.
    fn place_joints(
        &mut self,
        particles: &[Vec3],
        detail: Option<&Detail>,
        kind: PathKind,
        camera: &Camera,
    ) -> Result<(), PathError> {
        let count = kind.count(particles)?;
        let depths = particles.iter().map(|particle| camera.depth(*particle));
        match detail {
            Some(detail) => {
                let nearest = depths.fold(f32::INFINITY, f32::min);
                detail.keep(camera.px_per_metre(nearest), &mut self.kept);
            }
            None => {
                self.kept.clear();
                self.kept.extend((0..count).map(|joint| (joint, 1.0)));
            }
        }
        let mut joint_at = kind.joint_at(particles)?;
        self.places.clear();
        self.places
            .extend(self.kept.iter().map(|(joint, _)| joint_at(*joint)));
        if let Some(detail) = detail {
            detail.blend(&self.kept, &mut self.places);
        }
        let last = count.saturating_sub(1).max(1) as f64;
        self.whole.clear();
        for ((joint, _), position) in self.kept.iter().zip(&self.places) {
            let before = self.whole.last();
            let arc_length = before.map_or(0.0, |b| b.arc_length + b.position.distance(*position));
            self.whole.push(WorldJoint {
                position: *position,
                view: camera.view_from_world(*position),
                u: (*joint as f64 / last) as f32,
                arc_length,
                forward: Vec3::NEG_Y,
                backward: Vec3::Y,
                sink: 0.0,
            });
        }
        Ok(())
    }

    /// Forward and backward of every joint: the direction of the next segment towards that end that
    /// has a length, else of the nearest one towards the other end.
    fn find_directions(&mut self) {
        let joints = &mut self.whole;
        let segments = joints.len().saturating_sub(1);
        let mut before = None;
        for i in 0..segments {
            let step = joints[i].position - joints[i + 1].position;
            if step.length() > MIN_LENGTH_M {
                let backward = step.normalize();
                // No segment was before: this is the nearest one of all joints so far.
                if before.is_none() {
                    joints[..=i].iter_mut().for_each(|j| j.backward = backward);
                }
                before = Some(backward);
            }
            if let Some(backward) = before {
                joints[i + 1].backward = backward;
            }
        }
        let mut after = None;
        for i in (0..segments).rev() {
            let step = joints[i + 1].position - joints[i].position;
            if step.length() > MIN_LENGTH_M {
                let forward = step.normalize();
                if after.is_none() {
                    joints[i + 1..].iter_mut().for_each(|j| j.forward = forward);
                }
                after = Some(forward);
            }
            if let Some(forward) = after {
                joints[i].forward = forward;
            }
        }
    }

    /// Lets the joints of `whole` between two cuts sink where they go on beyond them, and returns which they are.
    fn piece(&mut self, [before, after]: [Option<&Cut>; 2]) -> Range<usize> {
        let (joints, kept) = (&mut self.whole, &self.kept);
        let place = |joint: usize| kept.partition_point(|(other, _)| *other < joint);
        let start = before.map_or(0, |cut| place(*cut.overlap.start()));
        let end = after.map_or(joints.len(), |cut| place(*cut.overlap.end()) + 1);
        if before.or(after).is_some() {
            let from = before.map_or(0.0, |cut| joints[place(cut.at)].arc_length);
            let to = after.map_or(f32::INFINITY, |cut| joints[place(cut.at)].arc_length);
            for joint in &mut joints[start..end] {
                let beyond = (from - joint.arc_length).max(joint.arc_length - to);
                joint.sink = beyond.max(0.0);
            }
        }
        start..end
    }

    /// Appends the runs of a part of `whole` that are in front of the near plane.
    fn clip(&mut self, strand: usize, piece: usize, part: Range<usize>, camera: &Camera) {
        let whole = std::mem::take(&mut self.whole);
        let joints = &whole[part];
        let near = camera.near_m();
        let mut start = self.len();
        let mut seen_before = false;
        for (i, joint) in joints.iter().enumerate() {
            let seen = joint.view.z > near;
            if seen && !seen_before {
                start = self.len();
            }
            if i > 0 && seen != seen_before {
                self.push_joint(&joints[i - 1].crossing(joint, near), start, camera);
            }
            if seen {
                self.push_joint(joint, start, camera);
            }
            let ends = if seen {
                i + 1 == joints.len()
            } else {
                seen_before
            };
            if ends {
                let joints = start..self.len();
                self.runs.push(PathRun {
                    strand,
                    piece,
                    overlap: self.overlap(strand, piece, &joints),
                    joints,
                });
            }
            seen_before = seen;
        }
        self.whole = whole;
    }

    /// How many of the first joints of a run are also in the last run, if that is of the piece before.
    fn overlap(&self, strand: usize, piece: usize, joints: &Range<usize>) -> usize {
        let is_before = |run: &&PathRun| run.strand == strand && run.piece + 1 == piece;
        let Some(before) = self.runs.last().filter(is_before) else {
            return 0;
        };
        let end = before.joints.end;
        let is_shared = |i: &usize| self.u[*i] <= self.u[end - 1];
        let shared = joints.clone().take_while(is_shared).count();
        // Where the near plane cuts too, the last run may be another.
        let begins = end - shared.min(end);
        match self.u[begins..end] == self.u[joints.start..joints.start + shared] {
            true => shared,
            false => 0,
        }
    }

    /// Projects a joint of the run from joint `start` on, and appends it.
    fn push_joint(&mut self, joint: &WorldJoint, start: usize, camera: &Camera) {
        let across = joint.across(camera);
        let previous = self.across[start..].last().copied().unwrap_or(Vec2::X);
        self.across.push(across.unwrap_or(previous));
        self.position.push(joint.position);
        self.u.push(joint.u);
        self.arc_length.push(joint.arc_length);
        self.forward.push(joint.forward);
        self.backward.push(joint.backward);
        self.center.push(camera.project(joint.view));
        self.depth.push(joint.view.z + joint.sink);
        let thinned = thinned(joint.view.z / camera.near_m());
        self.px_per_metre
            .push(camera.px_per_metre(joint.view.z) * thinned);
    }

    /// Keeps the first `len` joints.
    fn truncate(&mut self, len: usize) {
        self.position.truncate(len);
        self.u.truncate(len);
        self.arc_length.truncate(len);
        self.forward.truncate(len);
        self.backward.truncate(len);
        self.center.truncate(len);
        self.depth.truncate(len);
        self.px_per_metre.truncate(len);
        self.across.truncate(len);
    }
}

/// What is left of sizes at so many near distances from the eye, never 0.
fn thinned(near_distances: f32) -> f32 {
    let t = (near_distances - 1.0).clamp(0.0, 1.0);
    (t * t * (3.0 - 2.0 * t)).max(1e-3)
}

impl WorldJoint {
    fn is_finite(&self) -> bool {
        self.position.is_finite() && self.view.is_finite() && self.arc_length.is_finite()
    }

    /// The joint of the segment from here to `next` on the plane at view depth `near`, which the
    /// segment crosses.
    fn crossing(&self, next: &Self, near: f32) -> Self {
        let t = (near - self.view.z) / (next.view.z - self.view.z);
        // Rounding must not pass the end: what rises along the path keeps rising.
        let between = |a: f32, b: f32| (a + (b - a) * t).min(b);
        let direction = |a: Vec3, b: Vec3| a.lerp(b, t).normalize_or(a);
        Self {
            position: self.position.lerp(next.position, t),
            view: self.view.lerp(next.view, t).with_z(near),
            u: between(self.u, next.u),
            arc_length: between(self.arc_length, next.arc_length),
            sink: self.sink + (next.sink - self.sink) * t,
            forward: direction(self.forward, next.forward),
            backward: direction(self.backward, next.backward),
        }
    }

    /// The screen's unit vector across the path, where the path has a direction on the screen.
    fn across(&self, camera: &Camera) -> Option<Vec2> {
        // The derivative of the projection (x / z, -y / z) along the path, but for its scale. It is
        // also two components of a cross product: the sine of the angle to the line of sight, if
        // that is the view axis.
        let sight = self.view.normalize_or(Vec3::Z);
        let forward = camera.view_from_world_direction(self.forward);
        let along = Vec2::new(
            forward.x * sight.z - sight.x * forward.z,
            sight.y * forward.z - forward.y * sight.z,
        );
        let length = along.length();
        (length > MIN_ANGLE).then(|| along.perp() / length)
    }
}

#[cfg(test)]
mod tests;
