//! A tie that gathers hair again, somewhere on its way down, and moves with it.

use super::description::Zone;
use super::ornament::{OrnamentMesh, Tie};
use crate::shell::Shell;
use glam::Vec3;
use hair_sim::Strands;
use std::ops::Range;

/// How far from the tie hair is drawn together, in parts of its hanging length.
const DRAWN: f32 = 0.4;
/// How far from the tie's middle clumps lie at most, in its radii.
const INSIDE: f32 = 0.5;
/// How near the skin hair may come, head heights.
const CLEAR: f32 = 0.002;

/// What gathers hair on its way down.
#[derive(Clone, Debug, PartialEq)]
pub struct LowTie {
    /// The clumps that it gathers: each one's id, and which of its points is in the tie, root first.
    pub members: Vec<(u32, usize)>,
    /// Its middle at rest, metres.
    pub center: Vec3,
    /// The way of the hair through it at rest, a unit vector.
    pub axis: Vec3,
    /// Radius of the hair in it, metres.
    pub radius_m: f32,
    /// Its surface at rest.
    pub mesh: OrnamentMesh,
}

/// A point of a clump that comes into the tie.
struct Member {
    strand: usize,
    range: Range<usize>,
    /// In the list of all points.
    tied: usize,
    /// Length from the last point that the head holds to it, and to the tip.
    from_held: f32,
    length: f32,
}

/// Gathers the clumps from number `first` on, of one side of a zone, where that says so. `held` are the points of each that the head holds.
pub(super) fn gather(
    zone: &Zone,
    shell: &Shell,
    strands: &mut Strands,
    held: &[u32],
    first: usize,
) -> Option<LowTie> {
    if zone.low_tie <= 0.0 {
        return None;
    }
    let members: Vec<Member> = (first..strands.len())
        .filter_map(|strand| member(zone, strands, strand, held[strand] as usize))
        .collect();
    if members.is_empty() {
        return None;
    }
    let points = strands.points();
    let count = members.len() as f32;
    let tied = || members.iter().map(|member| points[member.tied]);
    let center = tied().sum::<Vec3>() / count;
    let tangent = |member: &Member| {
        let after = (member.tied + 1).min(member.range.end - 1);
        (points[after] - points[member.tied - 1]).normalize_or_zero()
    };
    let axis = members.iter().map(tangent).sum::<Vec3>();
    let axis = axis.normalize_or(Vec3::NEG_Y);
    let across = |point: Vec3| {
        let way = point - center;
        way - axis * way.dot(axis)
    };
    let radius_m = zone.low_tie_size * shell.height();
    let widest = tied()
        .map(|point| across(point).length())
        .fold(0.0, f32::max);
    let share = (INSIDE * radius_m / widest.max(1e-6)).min(1.0);
    let moves: Vec<Vec3> = tied()
        .map(|point| center + across(point) * share - point)
        .collect();
    for (member, by) in members.iter().zip(moves) {
        draw(member, by, shell, strands.points_mut());
    }
    let tie = Tie {
        kind: zone.tie_kind,
        center,
        axis,
        radius_m,
    };
    let named = |member: &Member| (strands.id(member.strand), member.tied - member.range.start);
    Some(LowTie {
        members: members.iter().map(named).collect(),
        center,
        axis,
        radius_m,
        mesh: tie.mesh(),
    })
}

/// Where a clump comes into the tie; nowhere where the head holds all of it.
fn member(zone: &Zone, strands: &Strands, strand: usize, held: usize) -> Option<Member> {
    let range = strands.point_range(strand);
    let points = strands.strand(strand);
    let last_held = held.clamp(1, points.len()) - 1;
    let free = &points[last_held..];
    if free.len() < 2 {
        return None;
    }
    let mut along = vec![0.0];
    for link in free.windows(2) {
        along.push(along[along.len() - 1] + link[0].distance(link[1]));
    }
    let length = along[along.len() - 1];
    let wanted = zone.low_tie * length;
    let apart = |i: &usize| (along[*i] - wanted).abs();
    let nearest = (1..free.len()).min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    Some(Member {
        strand,
        tied: range.start + last_held + nearest,
        from_held: along[nearest],
        length,
        range,
    })
}

/// Moves a clump's tied point, and less and less what is before and behind it.
fn draw(member: &Member, by: Vec3, shell: &Shell, points: &mut [Vec3]) {
    let reach = DRAWN * member.length;
    let points = &mut points[member.range.clone()];
    let (before, tied) = (points.to_vec(), member.tied - member.range.start);
    let mut move_on = |order: &mut dyn Iterator<Item = usize>, reach: f32| {
        let (mut last, mut way) = (tied, 0.0);
        for i in order {
            way += before[i].distance(before[last]);
            last = i;
            let left = 1.0 - (way / reach.max(1e-6)).powi(2);
            if left <= 0.0 {
                break;
            }
            points[i] = shell.keep_out(before[i] + by * (left * left), CLEAR);
        }
    };
    move_on(&mut (tied..before.len()), reach);
    // What the head holds stays.
    move_on(&mut (0..tied).rev(), reach.min(member.from_held));
}
