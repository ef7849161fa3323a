//! A head that turns on its neck: the head follows its pose whole, the shoulders not at all.

use crate::head::HeadModel;
use crate::painted::{Moving, PaintedMesh};
use crate::script::HeadPose;
use crate::skeleton::Skeleton;
use crate::solid::{Solid, corners};
use glam::{DQuat, DVec3, Quat, Vec3};
use rayon::prelude::*;
use render::{Ball, Coverage, Head};

/// Where the head turns about, from its middle, in head heights: the top of the neck.
const PIVOT: Vec3 = Vec3::new(0.0, -0.38, -0.12);
/// Heights from the head's middle, in head heights, below which nothing turns and above which all does.
const SHOULDERS: f32 = -0.95;
const JAW: f32 = -0.42;
/// Corners of one share turn alike: as many turns as there are steps are enough for the eye.
const STEPS: usize = 256;
/// How much farther from the neck than at rest bones may take hands and feet, and beats a wing.
const STRETCH: f32 = 2.0;
/// Corners that a thread poses at a time, at least.
const SOME_CORNERS: usize = 2048;

/// A head as its file has it, and how much of it follows a pose.
pub(crate) struct Neck {
    rest: HeadModel,
    /// How much each corner of the mesh follows the head, in [`STEPS`].
    shares: Vec<u16>,
    /// The same for each corner of each patch.
    patch_shares: Vec<Vec<u16>>,
    /// The same for each corner of each painted mesh.
    painted_shares: Vec<Vec<u16>>,
    pivot: Vec3,
    head: Head,
    height_m: f32,
    /// How far from the pivot the farthest corner is, metres: of meshes and patches.
    reach_m: f32,
    solid: Option<Solid>,
}

/// A head in a pose.
pub(crate) struct PosedHead {
    pose: HeadPose,
    model: HeadModel,
}

impl Neck {
    /// The neck under a head of this middle and height.
    pub fn new(model: HeadModel, head: Head) -> Self {
        let is_things = model.is_things;
        let pivot = |head: Head| match is_things {
            true => head.center,
            false => pivot(head),
        };
        let shares_at = |positions: &[Vec3]| shares_of(is_things, head, positions);
        let patches = model.patches.iter().map(|patch| &patch.positions);
        let meshes = [&model.mesh.positions, &model.ornaments.positions];
        let painted = model.painted.iter().map(|mesh| &mesh.positions);
        let numbered = model.painted.iter().filter_map(|mesh| match &mesh.moving {
            Some(Moving::Numbered(numbered)) => Some(numbered.all_positions()),
            _ => None,
        });
        let corners = meshes.into_iter().chain(patches).chain(painted).flatten();
        let corners = corners.chain(numbered.flatten());
        let from_pivot = corners.map(|p| p.distance(pivot(head)));
        Self {
            // A little more, for lines that are drawn around it.
            reach_m: from_pivot.fold(0.0, f32::max) + 0.02 * head.height_m,
            solid: Solid::within(&model.mesh, opaque(&model), head),
            shares: shares_at(&model.mesh.positions),
            patch_shares: model
                .patches
                .iter()
                .map(|patch| shares_at(&patch.positions))
                .collect(),
            painted_shares: model
                .painted
                .iter()
                .map(|mesh| shares_at(&mesh.positions))
                .collect(),
            pivot: pivot(head),
            head,
            height_m: head.height_m,
            rest: model,
        }
    }
}

/// Triangles of a head that are drawn and that nothing is seen through, where its pictures leave nothing free.
fn opaque(model: &HeadModel) -> Vec<[Vec3; 3]> {
    if !model.is_painted() {
        return corners(&model.mesh.positions, &model.mesh.triangles).collect();
    }
    let is_whole = |mesh: &&PaintedMesh| {
        let picture = mesh.paint.picture.as_ref();
        let has_gaps = picture.is_some_and(|picture| picture.coverage != Coverage::Ignored);
        mesh.section.is_none() && !mesh.is_shell && !has_gaps
    };
    let whole = model.painted.iter().filter(is_whole);
    whole
        .flat_map(|mesh| corners(&mesh.positions, &mesh.triangles))
        .collect()
}

impl Neck {
    /// The head at rest.
    pub fn rest(&self) -> &HeadModel {
        &self.rest
    }

    /// What it turns about: the top of the neck, or the middle of things that stand in a head's place.
    pub fn pivot(&self) -> Vec3 {
        self.pivot
    }

    /// The ball that all of the head stays in, in this pose: its middle and its radius, metres.
    pub fn ball(&self, pose: HeadPose) -> (Vec3, f32) {
        let shift_m = pose.shift.length() as f32 * self.height_m;
        let reach_m = match pose.animated_s.or(pose.beaten_s) {
            Some(_) => STRETCH * self.reach_m,
            None => self.reach_m,
        };
        (self.pivot, reach_m + shift_m)
    }
}

impl Neck {
    /// A ball within the head in this pose that an eye at this place, which sees nothing nearer than `near_m` metres, sees nothing through.
    pub fn solid(&self, pose: HeadPose, head: Head, eye: Vec3, near_m: f32) -> Option<Ball> {
        let (rotation, translation) = rigid(pose, head, self.pivot);
        let eye = rotation.inverse() * (eye.as_dvec3() - translation);
        let ball = self.solid.as_ref()?.seen_from(eye.as_vec3(), near_m)?;
        let center = rotation * ball.center.as_dvec3() + translation;
        Some(Ball {
            center: center.as_vec3(),
            ..ball
        })
    }
}

impl PosedHead {
    /// The head as its file has it.
    pub fn new(neck: &Neck) -> Self {
        Self {
            pose: HeadPose::default(),
            model: neck.rest.clone(),
        }
    }

    /// The head in the pose that it was last taken to.
    pub fn model(&self) -> &HeadModel {
        &self.model
    }

    /// The head of the same neck in this pose.
    pub fn in_pose(&mut self, neck: &Neck, pose: HeadPose) -> &HeadModel {
        if pose != self.pose {
            self.pose = pose;
            self.turn(neck);
        }
        &self.model
    }

    fn turn(&mut self, neck: &Neck) {
        if self.pose == HeadPose::default() {
            self.model.clone_from(&neck.rest);
            return;
        }
        let motion = Turns {
            turns: (0..=STEPS)
                .map(|step| self.pose.rotation(step as f64 / STEPS as f64).as_quat())
                .collect(),
            pivot: neck.pivot,
            shift: (self.pose.shift * f64::from(neck.height_m)).as_vec3(),
        };
        self.model.frame = neck.rest.frame.map(|head| Head {
            center: motion.moved(head.center, STEPS as u16),
            ..head
        });
        if neck.rest.shows_mesh() {
            let (rest, posed) = (&neck.rest.mesh, &mut self.model.mesh);
            motion.pose(
                &neck.shares,
                [&rest.positions, &rest.normals],
                [&mut posed.positions, &mut posed.normals],
            );
            let (rest, posed) = (&neck.rest.facing, &mut self.model.facing);
            for ((posed, rest), share) in posed.iter_mut().zip(rest).zip(&neck.shares) {
                *posed = motion.turn(*share) * *rest;
            }
        }
        let (rest, posed) = (&neck.rest.ornaments, &mut self.model.ornaments);
        motion.pose(
            &vec![STEPS as u16; rest.positions.len()],
            [&rest.positions, &rest.normals],
            [&mut posed.positions, &mut posed.normals],
        );
        if let (Some(skeleton), Some(time)) = (&neck.rest.skeleton, self.pose.animated_s) {
            skeleton.put(time, &mut self.model.painted);
            self.turn_on_top(neck, skeleton, time);
        }
        let is_own = |mesh: &PaintedMesh| neck.rest.skeleton.is_some() && mesh.section.is_none();
        for (index, shares) in neck.painted_shares.iter().enumerate() {
            if is_own(&neck.rest.painted[index]) {
                continue;
            }
            let (rest, posed) = (&neck.rest.painted[index], &mut self.model.painted[index]);
            let moved = match (&rest.moving, self.pose.beaten_s) {
                (Some(Moving::Beating(beating)), Some(time)) => Some(beating.at(time)),
                (Some(Moving::Numbered(numbered)), time) => {
                    let formed = numbered.at(time.unwrap_or(0.0));
                    let shares = shares_of(neck.rest.is_things, neck.head, &formed.positions);
                    let rest = [&formed.positions[..], &formed.normals[..]];
                    posed.take_form(&formed);
                    motion.pose(&shares, rest, [&mut posed.positions, &mut posed.normals]);
                    continue;
                }
                _ => None,
            };
            let rest = match &moved {
                Some([places, normals]) => [&places[..], &normals[..]],
                None => [&rest.positions[..], &rest.normals[..]],
            };
            motion.pose(shares, rest, [&mut posed.positions, &mut posed.normals]);
        }
        for (index, shares) in neck.patch_shares.iter().enumerate() {
            let (rest, posed) = (&neck.rest.patches[index], &mut self.model.patches[index]);
            for (i, share) in shares.iter().enumerate() {
                posed.positions[i] = motion.moved(rest.positions[i], *share);
            }
            posed.away_from = rest.away_from.map(|away| motion.turn(STEPS as u16) * away);
        }
    }
}

/// How much corners follow a head of this middle and height, in [`STEPS`]; things that stand in its place do so whole.
fn shares_of(is_things: bool, head: Head, positions: &[Vec3]) -> Vec<u16> {
    let share = |p: &Vec3| {
        if is_things {
            return STEPS as u16;
        }
        let y = (p.y - head.center.y) / head.height_m;
        let t = ((y - SHOULDERS) / (JAW - SHOULDERS)).clamp(0.0, 1.0);
        let share = t * t * (3.0 - 2.0 * t);
        (share * STEPS as f32).round() as u16
    };
    positions.iter().map(share).collect()
}

/// How corners move that follow the head by so many of [`STEPS`].
struct Turns {
    turns: Vec<Quat>,
    pivot: Vec3,
    shift: Vec3,
}

impl Turns {
    fn turn(&self, share: u16) -> Quat {
        self.turns[usize::from(share)]
    }

    fn moved(&self, p: Vec3, share: u16) -> Vec3 {
        self.turn(share) * (p - self.pivot) + self.pivot + self.shift
    }

    /// Poses corners' places and normals, from those at rest, some in each thread.
    fn pose(&self, shares: &[u16], rest: [&[Vec3]; 2], posed: [&mut [Vec3]; 2]) {
        let ([places, normals], [posed, posed_normals]) = (rest, posed);
        let corners = (shares, places, normals, posed, posed_normals).into_par_iter();
        let corners = corners.with_min_len(SOME_CORNERS);
        corners.for_each(|(share, place, normal, posed, posed_normal)| {
            *posed = self.moved(*place, *share);
            *posed_normal = self.turn(*share) * *normal;
        });
    }
}

impl PosedHead {
    /// Turns what a skeleton has put somewhere by what the script says beside it, about where the neck has come to.
    fn turn_on_top(&mut self, neck: &Neck, skeleton: &Skeleton, time: f64) {
        let height_m = f64::from(neck.height_m);
        let (base, moved_m) = skeleton.head_at(time, neck.head);
        let shift_m = self.pose.shift * height_m - moved_m;
        let is_still = self.pose.turn == DVec3::ZERO && self.pose.spin == 0.0;
        if is_still && shift_m.length() < 1e-9 * height_m {
            return;
        }
        let own = HeadPose {
            base: DQuat::IDENTITY,
            spin: 0.0,
            ..self.pose
        };
        let spun = self.pose.spun();
        let turns = Turns {
            turns: (0..=STEPS)
                .map(|step| own.rotation(step as f64 / STEPS as f64))
                .map(|turn| (spun * base * turn * base.conjugate()).as_quat())
                .collect(),
            pivot: (neck.pivot.as_dvec3() + moved_m).as_vec3(),
            shift: shift_m.as_vec3(),
        };
        let own_file = self.model.painted.iter_mut().zip(&neck.painted_shares);
        for (mesh, shares) in own_file.filter(|(mesh, _)| mesh.section.is_none()) {
            for ((place, normal), share) in
                mesh.positions.iter_mut().zip(&mut mesh.normals).zip(shares)
            {
                *place = turns.moved(*place, *share);
                *normal = turns.turn(*share) * *normal;
            }
        }
    }
}

/// The point that a head turns about.
pub(crate) fn pivot(head: Head) -> Vec3 {
    head.center + PIVOT * head.height_m
}

/// The rigid motion of what is fixed to a head that turns about a point: `rotation * p + translation`.
pub(crate) fn rigid(pose: HeadPose, head: Head, pivot: Vec3) -> (DQuat, DVec3) {
    let rotation = pose.rotation(1.0);
    let pivot = pivot.as_dvec3();
    let shift = pose.shift * f64::from(head.height_m);
    (rotation, pivot + shift - rotation * pivot)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_turns_whole_and_the_shoulders_stay() {
        let model = HeadModel::bust();
        let head = Head {
            center: Vec3::new(0.0, 1.5, 0.0),
            height_m: 0.24,
        };
        let rest = model.clone();
        let neck = Neck::new(model, head);
        let mut posed = PosedHead::new(&neck);
        assert_eq!(posed.in_pose(&neck, HeadPose::default()).mesh, rest.mesh);
        let pose = HeadPose {
            turn: DVec3::new(70.0, -20.0, 10.0),
            shift: DVec3::new(0.0, 0.5, 0.0),
            base: DQuat::from_rotation_y(0.3),
            spin: 0.0,
            animated_s: None,
            beaten_s: None,
        };
        let (rotation, translation) = rigid(pose, head, pivot(head));
        let turned_head = posed.in_pose(&neck, pose).clone();
        let up = Vec3::new(0.0, 0.12, 0.0);
        let (mut turned, mut still) = (0, 0);
        for (from, to) in rest.mesh.positions.iter().zip(&turned_head.mesh.positions) {
            let rigid = (rotation * from.as_dvec3() + translation).as_vec3();
            if from.y > 1.5 - 0.42 * 0.24 {
                assert!(to.distance(rigid) < 1e-6);
                turned += 1;
            }
            if from.y < 1.5 - 0.95 * 0.24 {
                assert!(to.distance(*from + up) < 1e-6);
                still += 1;
            }
        }
        assert!(turned > 1000 && still > 500, "{turned} {still}");
        // Light and drawn shadows turn with a figure's face.
        let figure = HeadModel::figure(&groom::Figure::default());
        let (facing, away) = (figure.facing.clone(), figure.patches[0].away_from.unwrap());
        let neck_of_figure = Neck::new(figure, head);
        let mut posed_figure = PosedHead::new(&neck_of_figure);
        let turned_figure = posed_figure.in_pose(&neck_of_figure, pose);
        let turned_away = turned_figure.patches[0].away_from.unwrap();
        assert!(turned_away.distance((rotation * away.as_dvec3()).as_vec3()) < 1e-6);
        for ((from, to), p) in facing
            .iter()
            .zip(&turned_figure.facing)
            .zip(&neck_of_figure.rest.mesh.positions)
        {
            if p.y > 1.5 - 0.42 * 0.24 {
                assert!(to.distance((rotation * from.as_dvec3()).as_vec3()) < 1e-6);
            }
        }
        for normal in &turned_head.mesh.normals {
            assert!((normal.length() - 1.0).abs() < 1e-4);
        }
        // Drawn strokes stay on the skin.
        assert_eq!(posed.in_pose(&neck, HeadPose::default()).mesh, rest.mesh);
    }
}
