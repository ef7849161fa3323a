//! Where strands that curl are cut into pieces.
//!
//! Within a strand no depth decides what lies on top, or its own discs would show as scales. So a winding
//! that passes before another of the same strand could not hide or outline it. A strand that curls is
//! therefore drawn in pieces, each of which is ordered as if it were a strand of its own. Where it is cut hangs on the
//! strand at rest alone: nothing pops when it moves or the eye does.

use crate::resample::{PathError, PathKind};
use glam::Vec3;
use std::ops::RangeInclusive;

/// Cosine of 3 degrees: of directions nearer to each other one is kept, so that strands of any length take few.
const COS_SAME: f32 = 0.998_629_5;

/// Cosine of the greatest angle between a direction of a piece and those kept of it, 117 degrees: no two directions
/// are farther apart than 120.
///
/// Directions no farther apart than that lie in one half of all directions (Dekster, *The Jung theorem for spherical
/// and hyperbolic spaces*, 1995): the piece always advances in some direction, and seen across it
/// never crosses itself.
const COS_MOST: f32 = -0.453_990_5;

/// A strand that is cut but once is an arch, as a ponytail's where it turns down, and stays whole.
const LEAST_CUTS: usize = 2;

/// Where two pieces of a strand meet, by numbers of the strand's joints.
///
/// They overlap, so that neither shows an end: each goes on beyond the cut, deeper and deeper under the other,
/// which looks the same there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cut {
    /// The joint up to which the piece before lies on top.
    pub at: usize,
    /// From the first joint of the piece after to the last one of the piece before.
    pub overlap: RangeInclusive<usize>,
}

/// Where a strand at rest is cut, from root to tip; nowhere unless it curls.
///
/// `rest` are its particles in metres. Pieces go on for `overlap_m` metres, but not beyond the next cut: more than
/// their strokes are wide.
///
/// # Errors
///
/// When the subdivision is not within 1 to 64.
pub fn cuts(rest: &[Vec3], kind: PathKind, overlap_m: f32) -> Result<Vec<Cut>, PathError> {
    let joints: Vec<Vec3> = kind.joints(rest)?.collect();
    let at = turns(&joints);
    if at.len() < LEAST_CUTS {
        return Ok(Vec::new());
    }
    let last = joints.len() - 1;
    let cut = |i: usize| {
        let low = if i > 0 { at[i - 1] } else { 0 };
        let high = at.get(i + 1).copied().unwrap_or(last);
        let start = reach(&joints, (low..at[i]).rev(), at[i], overlap_m);
        let end = reach(&joints, at[i] + 1..high + 1, at[i], overlap_m);
        Cut {
            at: at[i],
            overlap: start..=end,
        }
    };
    Ok((0..at.len()).map(cut).collect())
}

/// The joints at which a strand has turned so far that a new piece begins.
fn turns(joints: &[Vec3]) -> Vec<usize> {
    let mut at = Vec::new();
    let mut piece: Vec<Vec3> = Vec::new();
    for (i, link) in joints.windows(2).enumerate() {
        let Some(direction) = (link[1] - link[0]).try_normalize() else {
            continue;
        };
        let cosines = || piece.iter().map(|other: &Vec3| other.dot(direction));
        if cosines().any(|cosine| cosine < COS_MOST) {
            at.push(i);
            piece.clear();
            piece.push(direction);
        } else if cosines().all(|cosine| cosine < COS_SAME) {
            piece.push(direction);
        }
    }
    at
}

/// The first of `joints`, counted away from joint `from`, that lies `length_m` along the strand from it; else the last.
fn reach(
    joints: &[Vec3],
    numbers: impl Iterator<Item = usize>,
    from: usize,
    length_m: f32,
) -> usize {
    let (mut reached, mut length) = (from, 0.0);
    for number in numbers {
        if length >= length_m {
            break;
        }
        length += joints[number].distance(joints[reached]);
        reached = number;
    }
    reached
}

#[cfg(test)]
mod tests;
