//! Which joints of a path a picture needs: fewer where a strand is straight, or small in the picture.
//!
//! Of a strand at rest each joint but the ends lies between two others, and a path without it would be wrong there by some length.
//! A joint is there where that length is more than [`TOLERANCE_PX`] in the picture, and as it goes it moves to the straight line between
//! the two, so that nothing pops. What a joint is between, and how wrong a path would be, hangs on the strand at rest alone;
//! how large it is in the picture on where it is: so a picture is the same whatever was drawn before.

use crate::cuts::Cut;
use crate::resample::{PathError, PathKind};
use glam::Vec3;

/// Joints whose place makes less of a difference than this are left out, px.
const TOLERANCE_PX: f32 = 0.05;

/// No two neighbours are so many tolerances apart, but where the strand has no joint between them: what varies along a strand besides its
/// place, as its strokes' radii do, is not known here. 8 px, or more of strands that hardly anybody sees by themselves.
const WIDEST: f32 = 160.0;

/// A strand is divided where it is farthest from a line so many times, and twice for each doubling of its joints; then in its middle, or there are
/// shapes that would be taken apart joint by joint.
const LEVELS: u32 = 8;

/// How much each joint of a strand's path matters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Detail {
    joints: Vec<JointDetail>,
}

/// A joint between two others.
#[derive(Clone, Copy, Debug, PartialEq)]
struct JointDetail {
    /// How wrong the path would be without it, metres, in parts of how wrong it may be. That of no joint between it and the two is more.
    error_m: f32,
    /// The two, and how far it is on the way from the first to the second, 0 to 1.
    between: [u32; 2],
    way: f32,
}

impl Detail {
    /// That of a strand that is cut there ([`cuts`](crate::cuts())), by its particles at rest, in metres. Of dense hair no strand is looked at by
    /// itself: its joints may be farther apart, and less exact.
    ///
    /// # Errors
    ///
    /// When the subdivision is not within 1 to 64.
    pub fn of(
        rest: &[Vec3],
        kind: PathKind,
        cuts: &[Cut],
        coarseness: Coarseness,
    ) -> Result<Self, PathError> {
        let places: Vec<Vec3> = kind.joints(rest)?.collect();
        let always = JointDetail {
            error_m: f32::INFINITY,
            between: [0; 2],
            way: 0.0,
        };
        let mut joints = vec![always; places.len()];
        let of_cuts = cuts
            .iter()
            .flat_map(|cut| [*cut.overlap.start(), cut.at, *cut.overlap.end()]);
        let mut ends: Vec<usize> = of_cuts.chain([0, places.len().saturating_sub(1)]).collect();
        ends.sort_unstable();
        let lengths = places.windows(2).map(|link| link[0].distance(link[1]));
        let lengths: Vec<f32> = lengths.collect();
        let divided = Divided {
            places: &places,
            lengths: &lengths,
            coarseness,
        };
        for pair in ends.windows(2) {
            let levels = 2 * (pair[1] - pair[0]).max(1).ilog2() + LEVELS;
            divided.divide(&mut joints, [pair[0], pair[1]], levels);
        }
        Ok(Self { joints })
    }

    /// Replaces `kept` by the joints that are there where a metre is so many pixels, and how much of each, more than 0 to 1.
    pub(crate) fn keep(&self, px_per_metre: f32, kept: &mut Vec<(usize, f32)>) {
        let least_m = TOLERANCE_PX / px_per_metre;
        kept.clear();
        if !least_m.is_finite() {
            kept.extend((0..self.joints.len()).map(|i| (i, 1.0))); // somebody else tells what is wrong
            return;
        }
        let there = |(i, joint): (usize, &JointDetail)| {
            let share = joint.error_m / least_m - 1.0;
            (share > 0.0).then_some((i, share.min(1.0)))
        };
        kept.extend(self.joints.iter().enumerate().filter_map(there));
    }

    /// How many joints the whole path has.
    pub(crate) fn len(&self) -> usize {
        self.joints.len()
    }

    /// Moves those of the joints `kept`, which are at `places`, that are there in part.
    pub(crate) fn blend(&self, kept: &[(usize, f32)], places: &mut [Vec3]) {
        let mut parts: Vec<usize> = (0..kept.len()).filter(|&k| kept[k].1 < 1.0).collect();
        // Those that others lie between first: they are between joints farther apart.
        let joint = |k: usize| &self.joints[kept[k].0];
        parts.sort_by_key(|&k| std::cmp::Reverse(joint(k).between[1] - joint(k).between[0]));
        let place_of = |joint: u32| kept.partition_point(|(i, _)| *i < joint as usize);
        for k in parts {
            let JointDetail { between, way, .. } = *joint(k);
            let [from, to] = between.map(|joint| places[place_of(joint)]);
            places[k] = from.lerp(to, way).lerp(places[k], kept[k].1);
        }
    }
}

/// How much coarser than else paths may be, each 1 or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coarseness {
    /// How many times as far apart neighbouring joints may be.
    pub apart: f32,
    /// How many times as wrong paths may be.
    pub error: f32,
}

impl Coarseness {
    /// As paths are that are looked at one by one.
    pub const FINE: Self = Self {
        apart: 1.0,
        error: 1.0,
    };
}

/// A path as it is divided.
struct Divided<'a> {
    places: &'a [Vec3],
    /// From each joint to the next one, metres.
    lengths: &'a [f32],
    coarseness: Coarseness,
}

impl Divided<'_> {
    /// Finds what the joints between two lie between, and returns the greatest error of any.
    fn divide(&self, joints: &mut [JointDetail], [start, end]: [usize; 2], levels: u32) -> f32 {
        if end - start < 2 {
            return 0.0;
        }
        let (farthest, own) = self.farthest([start, end]);
        let i = match levels {
            0 => start.midpoint(end),
            _ => farthest,
        };
        let length_m: f32 = self.lengths[start..end].iter().sum();
        let too_wide = length_m / (WIDEST * self.coarseness.apart);
        let levels = levels.saturating_sub(1);
        let [before, after] = [[start, i], [i, end]].map(|part| self.divide(joints, part, levels));
        let own = own / self.coarseness.error;
        let error_m = own.max(too_wide).max(before).max(after);
        joints[i] = JointDetail {
            error_m,
            between: [start as u32, end as u32],
            way: self.way(i, [start, end]),
        };
        error_m
    }

    /// The joint that is farthest from the line between two that have some between them, of those as far the one nearest to the middle, and how far that is,
    /// metres.
    fn farthest(&self, [start, end]: [usize; 2]) -> (usize, f32) {
        let error_m = |i: usize| {
            let (from, to) = (self.places[start], self.places[end]);
            let on_line = from.lerp(to, self.way(i, [start, end]));
            self.places[i].distance(on_line)
        };
        let from_middle = |i: usize| (2 * i).abs_diff(start + end);
        let mut farthest = (start + 1, error_m(start + 1));
        for i in start + 2..end {
            let own = error_m(i);
            let by_error = own.total_cmp(&farthest.1);
            if by_error
                .then_with(|| from_middle(farthest.0).cmp(&from_middle(i)))
                .is_ge()
            {
                farthest = (i, own);
            }
        }
        farthest
    }

    /// How far a joint is on the way from one to another, 0 to 1.
    #[inline]
    fn way(&self, i: usize, [start, end]: [usize; 2]) -> f32 {
        let (from, to) = (self.places[start], self.places[end]);
        let length_squared = from.distance_squared(to).max(f32::MIN_POSITIVE);
        ((self.places[i] - from).dot(to - from) / length_squared).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPLINE: PathKind = PathKind::CatmullRom { subdivision: 8 };

    /// A quarter of a circle of a metre's radius.
    fn arc() -> Vec<Vec3> {
        let at = |i: usize| (i as f32 / 8.0 * std::f32::consts::FRAC_PI_2).sin_cos();
        (0..9).map(at).map(|(y, x)| Vec3::new(x, y, 0.0)).collect()
    }

    fn kept(detail: &Detail, px_per_metre: f32) -> Vec<(usize, f32)> {
        let mut kept = Vec::new();
        detail.keep(px_per_metre, &mut kept);
        kept
    }

    /// The joints that are there, where they are.
    fn path(px_per_metre: f32) -> Vec<(usize, Vec3)> {
        let all: Vec<Vec3> = SPLINE.joints(&arc()).unwrap().collect();
        let detail = Detail::of(&arc(), SPLINE, &[], Coarseness::FINE).unwrap();
        let kept = kept(&detail, px_per_metre);
        let mut places: Vec<Vec3> = kept.iter().map(|(i, _)| all[*i]).collect();
        detail.blend(&kept, &mut places);
        kept.iter().map(|(i, _)| *i).zip(places).collect()
    }

    /// How far all joints of the whole path are from a path, metres.
    fn error_m(path: &[(usize, Vec3)]) -> f32 {
        let all: Vec<Vec3> = SPLINE.joints(&arc()).unwrap().collect();
        let of = |(i, place): (usize, &Vec3)| {
            let after = path.partition_point(|(joint, _)| *joint < i).max(1);
            let (from, to) = (path[after - 1].1, path[after].1);
            let way = (*place - from).dot(to - from) / from.distance_squared(to);
            place.distance(from.lerp(to, way.clamp(0.0, 1.0)))
        };
        all.iter().enumerate().map(of).fold(0.0, f32::max)
    }

    #[test]
    fn a_path_is_as_exact_as_its_picture_needs() {
        let mut before = 0;
        for px_per_metre in [1.0, 3.0, 10.0, 30.0, 100.0, 300.0] {
            let path = path(px_per_metre);
            assert!(error_m(&path) * px_per_metre < 1.2 * TOLERANCE_PX);
            assert!(path.len() >= before && path.len() >= 2);
            before = path.len();
            for pair in path.windows(2) {
                let far = pair[0].1.distance(pair[1].1) * px_per_metre;
                assert!(far <= WIDEST * TOLERANCE_PX || pair[1].0 == pair[0].0 + 1);
            }
        }
        assert_eq!(before, 65, "from near there are all");
        assert!(path(30.0).len() < 30);
    }

    #[test]
    fn of_joints_as_far_the_one_nearest_to_the_middle_divides() {
        for (heights, middle) in [
            (vec![0, 1, 1, 1, 0], 2),
            (vec![0, 1, 1, 0], 2),
            (vec![0, 2, 1, 1, 0], 1),
        ] {
            let point = |(x, y): (usize, &i32)| Vec3::new(x as f32, *y as f32, 0.0);
            let strand: Vec<Vec3> = heights.iter().enumerate().map(point).collect();
            let linear = PathKind::Linear { subdivision: 1 };
            let detail = Detail::of(&strand, linear, &[], Coarseness::FINE).unwrap();
            let last = strand.len() as u32 - 1;
            let divides = |joint: &JointDetail| joint.between == [0, last];
            assert_eq!(
                detail.joints.iter().position(divides),
                Some(middle),
                "{heights:?}"
            );
        }
    }

    #[test]
    fn joints_come_and_go_without_a_jump() {
        let (mut px_per_metre, mut before, mut changes) = (10.0_f32, path(10.0), 0);
        while px_per_metre < 300.0 {
            px_per_metre *= 1.001;
            let now = path(px_per_metre);
            changes += usize::from(now.len() != before.len());
            for (joint, place) in &now {
                // Where it was, or where the path was that it wasn't a joint of.
                let i = before.partition_point(|(other, _)| other < joint).max(1);
                let (from, to) = (before[i - 1].1, before[i].1);
                let way = (*place - from).dot(to - from) / from.distance_squared(to);
                let moved = place.distance(from.lerp(to, way.clamp(0.0, 1.0)));
                assert!(moved * px_per_metre < 2e-3, "{joint} at {px_per_metre}");
            }
            before = now;
        }
        assert!(changes > 10);
    }

    #[test]
    fn no_shape_is_taken_apart_joint_by_joint() {
        // To and fro by ever less: the farthest joint is always the next one.
        const COUNT: usize = 200_000;
        let to_and_fro = |i: usize| {
            let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            Vec3::new(side * (COUNT - i) as f32, 0.0, 0.0)
        };
        let strand: Vec<Vec3> = (0..COUNT).map(to_and_fro).collect();
        let detail = Detail::of(
            &strand,
            PathKind::Linear { subdivision: 1 },
            &[],
            Coarseness::FINE,
        )
        .unwrap();
        assert!(kept(&detail, 1.0).len() > COUNT / 2);
    }

    #[test]
    fn joints_of_dense_hair_are_farther_apart() {
        let longest = |apart: f32| {
            let straight = [Vec3::ZERO, Vec3::X];
            let kind = PathKind::Linear { subdivision: 64 };
            let coarseness = Coarseness { apart, error: 1.0 };
            let detail = Detail::of(&straight, kind, &[], coarseness).unwrap();
            let kept = kept(&detail, 200.0);
            let steps = kept.windows(2).map(|pair| pair[1].0 - pair[0].0);
            steps.max().unwrap() as f32 * 200.0 / 64.0
        };
        assert!(
            longest(1.0) > 4.0 && longest(1.0) <= 8.0,
            "{}",
            longest(1.0)
        );
        assert!(
            longest(2.0) > 8.0 && longest(2.0) <= 16.0,
            "{}",
            longest(2.0)
        );
    }

    #[test]
    fn coarser_paths_are_as_wrong_as_they_may_be() {
        let coarse = Coarseness {
            apart: 100.0,
            error: 2.0,
        };
        let places: Vec<Vec3> = SPLINE.joints(&arc()).unwrap().collect();
        let error_px = |coarseness: Coarseness| {
            let detail = Detail::of(&arc(), SPLINE, &[], coarseness).unwrap();
            let kept = kept(&detail, 100.0);
            let mut path: Vec<Vec3> = kept.iter().map(|(i, _)| places[*i]).collect();
            detail.blend(&kept, &mut path);
            let path: Vec<(usize, Vec3)> = kept.iter().map(|(i, _)| *i).zip(path).collect();
            (100.0 * error_m(&path), path.len())
        };
        let fine = error_px(Coarseness {
            error: 1.0,
            ..coarse
        });
        let coarse = error_px(coarse);
        assert!(coarse.1 < fine.1, "{} joints of {}", coarse.1, fine.1);
        assert!(fine.0 < 1.2 * TOLERANCE_PX, "{}", fine.0);
        assert!(
            coarse.0 > TOLERANCE_PX && coarse.0 < 2.4 * TOLERANCE_PX,
            "{}",
            coarse.0
        );
    }

    #[test]
    fn ends_and_cuts_stay() {
        let cut = Cut {
            at: 20,
            overlap: 17..=23,
        };
        let detail = Detail::of(&arc(), SPLINE, &[cut], Coarseness::FINE).unwrap();
        let joints: Vec<usize> = kept(&detail, 1e-6).iter().map(|(i, _)| *i).collect();
        assert_eq!(joints, [0, 17, 20, 23, 64]);
        for count in 0..3 {
            let detail = Detail::of(
                &arc()[..count],
                PathKind::Linear { subdivision: 1 },
                &[],
                Coarseness::FINE,
            );
            assert_eq!(kept(&detail.unwrap(), 1.0).len(), count);
        }
    }
}
