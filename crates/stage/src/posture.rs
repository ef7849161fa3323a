//! Where a head, its shoulders and the whole figure are at a time.

use crate::neck::{pivot, rigid};
use crate::script::{HeadPose, MotionScript};
use crate::skeleton::{Bones, after};
use glam::DQuat;
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
    /// Of a figure whose head is in this pose, moved by this script at its own `time` (seconds).
    pub fn of(pose: HeadPose, head: Head, script: &'s MotionScript, time: f64) -> Self {
        let bones = script.skeleton().map(|skeleton| skeleton.at(time));
        let figure = figure_in(pose, head, bones.as_ref());
        let (rotation, translation) = rigid(pose, head);
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
fn figure_in(pose: HeadPose, head: Head, bones: Option<&Bones>) -> Pose {
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
    let (rotation, pivot) = (pose.spun(), pivot(head).as_dvec3());
    Pose {
        rotation,
        translation: pivot + shift - rotation * pivot,
    }
}
