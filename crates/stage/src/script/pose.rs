//! A head's pose, and what it does to points.

use glam::{DQuat, DVec3};
use stroke_path::sin_cos_degrees;

/// How far a head is from where its file has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeadPose {
    /// The turn of an animation's bone, outside the others; a unit quaternion.
    pub base: DQuat,
    /// The turn of the whole figure to its left, outside all others; degrees.
    pub spin: f64,
    /// Turns in degrees: towards the character's left, up, towards the left shoulder; in this order from
    /// the outermost.
    pub turn: DVec3,
    /// Head heights.
    pub shift: DVec3,
    /// The time in seconds that the character's own skeleton is at, where that moves it; `base` and `shift` have the motion of the skeleton's head.
    pub animated_s: Option<f64>,
    /// The script's own time in seconds, where meshes beside the head move by themselves.
    pub beaten_s: Option<f64>,
}

impl HeadPose {
    /// Where the file has it.
    pub const REST: Self = Self {
        base: DQuat::IDENTITY,
        spin: 0.0,
        turn: DVec3::ZERO,
        shift: DVec3::ZERO,
        animated_s: None,
        beaten_s: None,
    };

    /// The turn as a unit quaternion, of which `share` (0 to 1) is done: the neck turns less than the
    /// head.
    pub fn rotation(&self, share: f64) -> DQuat {
        let about = |axis: DVec3, degrees: f64| {
            let (sin, cos) = sin_cos_degrees(0.5 * degrees * share);
            DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
        };
        // Looking up turns the face (+Z) to +Y: backwards about +X. Leaning to the left shoulder (+X) turns +Y
        // to +X: backwards about +Z.
        let turn = part_of(self.base, share)
            * about(DVec3::Y, self.turn.x)
            * about(DVec3::NEG_X, self.turn.y)
            * about(DVec3::NEG_Z, self.turn.z);
        if self.spin == 0.0 {
            return turn;
        }
        self.spun() * turn
    }

    /// The turn of the whole figure, a unit quaternion.
    pub fn spun(&self) -> DQuat {
        let (sin, cos) = sin_cos_degrees(0.5 * self.spin);
        DQuat::from_xyzw(0.0, sin, 0.0, cos)
    }
}

/// A turn in degrees: to the left, up, towards the left shoulder; in this order from the outermost. A unit quaternion.
pub(crate) fn turned(turn: DVec3) -> DQuat {
    let pose = HeadPose {
        turn,
        ..HeadPose::REST
    };
    pose.rotation(1.0)
}

/// A share of a rotation, 0 to 1: along the chord, which needs no sine.
fn part_of(rotation: DQuat, share: f64) -> DQuat {
    if rotation == DQuat::IDENTITY || share == 1.0 {
        return rotation;
    }
    let short = if rotation.w < 0.0 {
        -rotation
    } else {
        rotation
    };
    (DQuat::IDENTITY * (1.0 - share) + short * share).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_go_where_they_say() {
        let pose = |turn| HeadPose {
            turn,
            ..HeadPose::default()
        };
        let cases = [
            (DVec3::X, DVec3::Z, DVec3::X),
            (DVec3::Y, DVec3::Z, DVec3::Y),
            (DVec3::Z, DVec3::Y, DVec3::X),
        ];
        for (axis, from, to) in cases {
            let turned = pose(axis * 90.0).rotation(1.0) * from;
            assert!((turned - to).length() < 1e-12, "{axis}: {turned}");
            let half = pose(axis * 90.0).rotation(0.5) * from;
            assert!((half - (from + to).normalize()).length() < 1e-12);
        }
    }
}
