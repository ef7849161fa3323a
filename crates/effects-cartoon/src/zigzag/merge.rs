//! What shines on strands near each other lies on one line.
//!
//! Where hair is dense, strands of one lock shine at different heights, as they turn away at different places. The source averages what is near
//! (Shin, Haller, Mukundan, section 3.4.2); here each strand's highlight moves to where the highlights around it lie on average, in each frame anew,
//! with weights that come and go without a jump. The line lies across the hair: of hair that is swept to one side it runs upright. A strand that can't reach
//! it, as it is too short, is left out, the more the farther it is from it.

use super::{FAINT, Highlight, PLACES, smooth};
use effects::{Grid, HairStrand};
use glam::Vec3;
use rayon::prelude::*;

/// How often highlights move to the middle of those around them: each time they draw nearer to one line.
const ROUNDS: usize = 3;

/// Places of a strand that are farther from the middle than its nearest place hardly count from here on, in parts of the distance of `merge`.
const SHARP: f32 = 0.2;

/// What is farther than this from the line, along the hair, is left out, in parts of the distance of `merge`.
const OFF_LINE: f32 = 0.35;

/// Moves highlights of strands, as many, nearer than `within_m` to one another along their strands onto one line across them, and leaves out those
/// that stay away from it.
pub(super) fn onto_one_line(strands: &[HairStrand], shining: &mut [Highlight], within_m: f32) {
    for _ in 0..ROUNDS {
        let around = Around::of(strands, shining, within_m);
        let places: Vec<f32> = (strands.par_iter().zip(&*shining).enumerate())
            .map(|(i, (strand, highlight))| {
                place_near(strand, around.middle(i), highlight.place, within_m)
            })
            .collect();
        for (highlight, place) in shining.iter_mut().zip(places) {
            highlight.place = place;
        }
    }
    let around = Around::of(strands, shining, within_m);
    let shares: Vec<f32> = (strands.par_iter().enumerate())
        .map(|(i, strand)| 1.0 - smooth(around.off_line_m(i, strand) / (OFF_LINE * within_m)))
        .collect();
    for (highlight, share) in shining.iter_mut().zip(shares) {
        highlight.amount *= share;
    }
}

/// Where highlights lie, and what shines around each.
struct Around<'a> {
    shining: &'a [Highlight],
    points: Vec<Vec3>,
    grid: Grid,
    within_m: f32,
}

impl<'a> Around<'a> {
    fn of(strands: &[HairStrand], shining: &'a [Highlight], within_m: f32) -> Self {
        let points: Vec<Vec3> = (strands.iter().zip(shining))
            .map(|(strand, highlight)| strand.point(highlight.place))
            .collect();
        let those = (0..shining.len()).filter(|i| shining[*i].amount > 0.0);
        let grid = Grid::new(those.map(|i| (i, points[i])), within_m);
        Self {
            shining,
            points,
            grid,
            within_m,
        }
    }

    /// The middle of what shines around highlight `i`; where nothing does, that is where it is itself.
    fn middle(&self, i: usize) -> Vec3 {
        let own = self.points[i];
        let (mut sum, mut weights) = (FAINT * own, FAINT);
        for other in self.grid.around(own) {
            let squared_m = self.points[other].distance_squared(own);
            let weight = self.shining[other].amount * near(squared_m, self.within_m);
            sum += weight * self.points[other];
            weights += weight;
        }
        sum / weights
    }

    /// How far highlight `i` of a strand is from the line of those around it, along the strand, metres.
    fn off_line_m(&self, i: usize, strand: &HairStrand) -> f32 {
        let along = super::along(strand, self.shining[i].place);
        (self.points[i] - self.middle(i)).dot(along).abs()
    }
}

/// How much there is of a link between highlights of two lines, of which one runs farther along the hair than the other: the less the farther they are
/// apart.
pub(super) fn on_one_line(way: Vec3, along: Vec3, within_m: f32) -> f32 {
    1.0 - smooth(way.dot(along).abs() / (2.0 * OFF_LINE * within_m))
}

/// 1 for what is nearer than half of `within_m`, 0 from `within_m` on, without corners.
fn near(squared_m: f32, within_m: f32) -> f32 {
    smooth(2.0 - 2.0 * squared_m.sqrt() / within_m)
}

/// Where a strand passes a point, in the mean over its places near it, as the nearest place would jump where a strand bends back; or its own place,
/// the more the farther it passes.
fn place_near(strand: &HairStrand, point: Vec3, own: f32, within_m: f32) -> f32 {
    let u = |k: usize| k as f32 / PLACES as f32;
    let squared_m: [f32; PLACES + 1] =
        std::array::from_fn(|k| strand.point(u(k)).distance_squared(point));
    let nearest = squared_m.iter().copied().fold(f32::INFINITY, f32::min);
    let sharp_m = SHARP * within_m;
    let (mut sum, mut weights) = (0.0, 0.0);
    for (k, squared_m) in squared_m.into_iter().enumerate() {
        let farther = (squared_m - nearest) / (sharp_m * sharp_m);
        let weight = (1.0 / (1.0 + farther)).powi(4);
        sum += weight * u(k);
        weights += weight;
    }
    own + near(nearest, within_m) * (sum / weights - own)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is left of the highlights of strands that all shine in their middle.
    fn left_of(points: &[Vec<Vec3>], within_m: f32) -> Vec<f32> {
        let strands = strands_of(points);
        let whole = Highlight {
            place: 0.5,
            amount: 1.0,
        };
        let mut shining = vec![whole; strands.len()];
        onto_one_line(&strands, &mut shining, within_m);
        shining.iter().map(|highlight| highlight.amount).collect()
    }

    /// Strands of so many metres along the front of a head, each so much farther along it than the one before and above it, from 0.1 m to one side of its
    /// middle to 0.1 m to the other.
    fn sideways(long_m: f32, farther_m: Vec3) -> Vec<Vec<Vec3>> {
        let strand = |i: i32| {
            let middle = (i - 20) as f32 * farther_m + 0.12 * Vec3::Z;
            let point = |k: i32| middle + 0.1 * (k - 5) as f32 * long_m * Vec3::X;
            (0..=10).map(point).collect()
        };
        (0..=40).map(strand).collect()
    }

    /// Short ones behind each other can't come together, so that those near their middle are the strip, and the others fade away from it.
    #[test]
    fn what_cannot_reach_the_line_shines_near_it_alone() {
        let left = left_of(&sideways(0.01, 0.005 * Vec3::X), 0.2);
        assert!(left[20] > 0.99, "{left:?}");
        assert!((left[10] - left[30]).abs() < 1e-3);
        assert!(
            left[..4]
                .iter()
                .chain(&left[37..])
                .all(|amount| *amount < 0.1),
            "{left:?}"
        );
        assert!(
            left[..21].is_sorted() && left[20..].is_sorted_by(|a, b| a >= b),
            "{left:?}"
        );
        let largest_step = left
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).abs())
            .fold(0.0, f32::max);
        assert!(largest_step < 0.2, "a hard edge: {largest_step}");
    }

    /// A strip lies across the hair: of hair swept to one side it runs upright, and nothing of it is lost.
    #[test]
    fn swept_hair_has_a_strip_across_it() {
        let left = left_of(&sideways(0.1, 0.005 * Vec3::Y), 0.2);
        assert!(left.iter().all(|amount| *amount > 0.99), "{left:?}");
    }

    #[test]
    fn what_lies_farther_along_the_hair_is_another_line() {
        let share = |x: f32, y: f32| on_one_line(Vec3::new(x, y, 0.0), Vec3::NEG_Y, 0.1);
        assert_eq!(share(0.0, 0.0), 1.0);
        assert!(share(0.06, 0.0) > 0.999);
        assert!(share(0.01, 0.08) == 0.0 && share(0.01, -0.08) == 0.0);
        let half = share(0.0, 0.035);
        assert!((0.4..0.6).contains(&half), "{half}");
    }

    fn strands_of(points: &[Vec<Vec3>]) -> Vec<HairStrand<'_>> {
        let strand = |(id, particles)| HairStrand {
            id,
            particles,
            at_rest: particles,
            size: 12.0,
            is_drawn: true,
        };
        (0..)
            .zip(points.iter().map(Vec::as_slice))
            .map(strand)
            .collect()
    }

    /// Upright strands of 0.2 m side by side, with highlights at these places and of these amounts: the places once merged.
    fn merged(highlights: &[(f32, f32)], apart_m: f32, within_m: f32) -> Vec<f32> {
        let points: Vec<Vec<Vec3>> = (0..highlights.len())
            .map(|i| {
                let point = |k: usize| Vec3::new(i as f32 * apart_m, -0.02 * k as f32, 0.0);
                (0..=10).map(point).collect()
            })
            .collect();
        let strands = strands_of(&points);
        let mut shining: Vec<Highlight> = (highlights.iter())
            .map(|&(place, amount)| Highlight { place, amount })
            .collect();
        onto_one_line(&strands, &mut shining, within_m);
        shining.iter().map(|highlight| highlight.place).collect()
    }

    fn spread(places: &[f32]) -> f32 {
        let least = places.iter().copied().fold(f32::INFINITY, f32::min);
        places.iter().copied().fold(0.0, f32::max) - least
    }

    #[test]
    fn neighbours_shine_on_one_line() {
        let uneven: Vec<(f32, f32)> = (0..20).map(|i| (0.4 + 0.1 * (i % 3) as f32, 1.0)).collect();
        let places = merged(&uneven, 0.005, 0.08);
        assert!(spread(&places) < 0.04, "{places:?}");
        assert!(
            places.iter().all(|place| (place - 0.5).abs() < 0.06),
            "{places:?}"
        );
    }

    #[test]
    fn what_is_far_or_dark_moves_nothing() {
        // Two groups, farther from each other than highlights merge.
        let two: Vec<(f32, f32)> = (0..10)
            .map(|i| (if i % 2 == 0 { 0.2 } else { 0.8 }, 1.0))
            .collect();
        for (place, (own, _)) in merged(&two, 0.005, 0.08).into_iter().zip(two) {
            assert!((place - own).abs() < 0.02, "{place}, {own}");
        }
        // One alone, beside others without light.
        let dark = [(0.5, 1.0), (0.6, 0.0), (0.6, 0.0)];
        assert!((merged(&dark, 0.005, 0.08)[0] - 0.5).abs() < 0.01);
    }
}
