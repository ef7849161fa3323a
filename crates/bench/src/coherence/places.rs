//! Where strands are on the screen, to be found again in another picture, whose joints may be others.

use glam::Vec2;
use render::Frame;

/// Places along strands on the screen, in pixels.
pub struct Places {
    /// The strand's piece and how far along the strand it is, as [`stroke_path::Paths`] has them; in that order.
    along: Vec<(usize, f32)>,
    /// The strand's id. Lines of meshes have none: they come and go, and another has a line's number then.
    ids: Vec<Option<u32>>,
    centers: Vec<Vec2>,
}

impl Places {
    /// Those of a frame's joints, which have these centres.
    pub fn new(frame: &Frame, centers: Vec<Vec2>) -> Self {
        let lies_on_mesh = |joint: &usize| {
            let mut objects = frame.objects.iter();
            let of = objects.find(|object| object.joints.contains(joint));
            of.is_some_and(|object| object.surface_bias_m == render::ON_SURFACES)
        };
        let (mut along, mut ids) = (Vec::new(), Vec::new());
        for run in &frame.paths.runs {
            let is_line = run.joints.clone().next().as_ref().is_some_and(lies_on_mesh);
            let id = frame.strands[run.strand].id;
            for joint in run.joints.clone() {
                along.push((run.piece, frame.paths.u[joint]));
                ids.push((!is_line).then_some(id));
            }
        }
        Self {
            along,
            ids,
            centers,
        }
    }

    /// Their numbers.
    pub fn joints(&self) -> std::ops::Range<usize> {
        0..self.along.len()
    }

    /// Where the joint of that number is.
    pub fn center(&self, joint: usize) -> Vec2 {
        self.centers[joint]
    }

    /// How far the joint of that number has come since `before`, in pixels; nothing where the strand wasn't seen there.
    pub fn moved_since(&self, before: &Self, joint: usize) -> Option<Vec2> {
        let id = self.ids[joint]?;
        Some(self.centers[joint] - before.at(id, self.along[joint])?)
    }

    /// Where a place along the strand of an id is.
    fn at(&self, id: u32, (piece, u): (usize, f32)) -> Option<Vec2> {
        let after = self.along.partition_point(|other| *other < (piece, u));
        let (to, to_u) = self.along.get(after).copied()?;
        if self.ids[after] != Some(id) {
            return None;
        }
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
    use super::super::animation::Animation;
    use super::super::strands::Strands;
    use super::*;

    #[test]
    fn a_strand_is_found_again_by_other_joints() {
        let places = |along: &[(usize, f32)], shift: f32| Places {
            along: along.to_vec(),
            ids: vec![Some(7); along.len()],
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
        let mut other = before;
        other.ids.fill(Some(8));
        assert_eq!(after.moved_since(&other, 0), None, "another strand");
    }

    /// A line that another one comes before has that one's number: it must not seem to be thrown to where that was.
    #[test]
    fn lines_of_meshes_are_not_taken_for_each_other() {
        let (_, _, open) = Strands::ALL[0];
        let mut strands = open().unwrap();
        let mut frame = strands.at(0).unwrap();
        let places = |frame: &Frame| Places::new(frame, frame.paths.center.clone());
        let hair = places(&frame);
        assert!(
            hair.joints()
                .all(|i| hair.moved_since(&hair, i) == Some(Vec2::ZERO))
        );
        frame.objects[0].surface_bias_m = render::ON_SURFACES;
        let lines = places(&frame);
        assert!(!lines.joints().is_empty());
        assert!(
            lines
                .joints()
                .all(|i| lines.moved_since(&lines, i).is_none())
        );
    }
}
