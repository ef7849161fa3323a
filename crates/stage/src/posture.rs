//! Where a head, its shoulders and the whole figure are at a time.

use crate::neck::rigid;
use crate::script::{HeadPose, MotionScript};
use crate::skeleton::{Bones, after};
use glam::{DQuat, Vec3};
use hair_sim::Pose;
use render::Head;

/// Where a head, its shoulders and the whole figure are. The shoulders follow the head's shift and the whole figure's turn, not the
/// head's.
pub(crate) struct Posture<'s> {
    pub head: Pose,
    pub shoulders: Pose,
    pub figure: Pose,
    /// Of the skeleton that moves it, where one does.
    pub bones: Option<Bones<'s>>,
}

impl<'s> Posture<'s> {
    /// Of a figure whose head, which turns about a point, is in this pose, moved by this script at its own `time` (seconds).
    pub fn of(
        pose: HeadPose,
        (head, pivot): (Head, Vec3),
        script: &'s MotionScript,
        time: f64,
    ) -> Self {
        let bones = script.skeleton().map(|skeleton| skeleton.at(time));
        let figure = figure_in(pose, head, pivot, bones.as_ref());
        let (rotation, translation) = rigid(pose, head, pivot);
        Self {
            head: Pose {
                rotation,
                translation,
            },
            shoulders: match &bones {
                Some(bones) => after(bones.shoulders(), figure),
                None => figure,
            },
            figure,
            bones,
        }
    }
}

/// How the whole figure is moved by what its skeleton knows nothing of, where it has one.
fn figure_in(pose: HeadPose, head: Head, pivot: Vec3, bones: Option<&Bones>) -> Pose {
    let mut shift = pose.shift * f64::from(head.height_m);
    if let Some(bones) = bones {
        shift -= bones.head(head).1;
    }
    if pose.spin == 0.0 {
        return Pose {
            rotation: DQuat::IDENTITY,
            translation: shift,
        };
    }
    let (rotation, pivot) = (pose.spun(), pivot.as_dvec3());
    Pose {
        rotation,
        translation: pivot + shift - rotation * pivot,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::neck::PosedHead;
    use crate::{Files, Preset, Scene};
    use effects::Registry;
    use glam::DVec3;

    #[test]
    fn what_is_on_things_moves_as_they_do() {
        let registry = Registry::new();
        let text = "(version: 1, head: (shape: none), meshes: [(shape: cube, at: (0.3, 0.2, 0))], layers: [])";
        let preset = Preset::parse("look.ron", text, &registry).unwrap();
        let scene = Scene::load(&preset, &Files::default()).unwrap();
        let object = &scene.objects()[0];
        let pose = HeadPose {
            turn: DVec3::new(70.0, -20.0, 10.0),
            spin: 30.0,
            shift: DVec3::new(0.0, 0.5, 0.0),
            ..HeadPose::REST
        };
        let neck = object.neck().unwrap();
        let mut posed = PosedHead::new(neck);
        let moved = &posed.in_pose(neck, pose).painted[0].positions;
        let head = (object.hair().head, object.pivot());
        let Pose {
            rotation,
            translation,
        } = Posture::of(pose, head, object.script(), 0.0).head;
        for (from, to) in neck.rest().painted[0].positions.iter().zip(moved) {
            let there = (rotation * from.as_dvec3() + translation).as_vec3();
            assert!(
                to.distance(there) < 1e-6 * head.0.height_m.max(1.0),
                "{to} {there}"
            );
        }
    }
}
