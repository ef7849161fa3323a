//! Where strands are on the screen, to be found again in another picture, whose joints may be others.

use glam::Vec2;
use stroke_path::Paths;

/// Places along strands on the screen, in pixels.
pub struct Places {
    /// The strand's piece and how far along the strand it is, as [`Paths`] has them; in that order.
    along: Vec<(usize, f32)>,
    centers: Vec<Vec2>,
}

impl Places {
    /// Those of a frame's joints, which have these centres.
    pub fn new(paths: &Paths, centers: Vec<Vec2>) -> Self {
        let of_run = |run: &stroke_path::PathRun| {
            let piece = run.piece;
            run.joints.clone().map(move |joint| (piece, joint))
        };
        let joints = paths.runs.iter().flat_map(of_run);
        Self {
            along: joints
                .map(|(piece, joint)| (piece, paths.u[joint]))
                .collect(),
            centers,
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.along.len()
    }

    /// How far the joint of that number has come since `before`, in pixels; nothing where the strand wasn't seen there.
    pub fn moved_since(&self, before: &Self, joint: usize) -> Option<Vec2> {
        Some(self.centers[joint] - before.at(self.along[joint])?)
    }

    /// Where a place along a strand is.
    fn at(&self, (piece, u): (usize, f32)) -> Option<Vec2> {
        let after = self.along.partition_point(|other| *other < (piece, u));
        let (to, to_u) = self.along.get(after).copied()?;
        if (to, to_u) == (piece, u) {
            return Some(self.centers[after]);
        }
        let (from, from_u) = self.along[after.checked_sub(1)?];
        let way = (u - from_u) / (to_u - from_u);
        let is_between = from == piece && to == piece;
        is_between.then(|| self.centers[after - 1].lerp(self.centers[after], way))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strand_is_found_again_by_other_joints() {
        let places = |along: &[(usize, f32)], shift: f32| Places {
            along: along.to_vec(),
            centers: along
                .iter()
                .map(|(piece, u)| Vec2::new(10.0 * u + shift, *piece as f32))
                .collect(),
        };
        let before = places(&[(3, 0.0), (3, 0.5), (3, 1.0), (5, 0.0), (5, 1.0)], 0.0);
        let after = places(&[(3, 0.0), (3, 0.25), (3, 1.0), (4, 0.5), (5, 0.5)], 2.0);
        for joint in [0, 1, 2, 4] {
            assert_eq!(after.moved_since(&before, joint), Some(Vec2::new(2.0, 0.0)));
        }
        assert_eq!(
            after.moved_since(&before, 3),
            None,
            "a strand that wasn't seen"
        );
    }
}
