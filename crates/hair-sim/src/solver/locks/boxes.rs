//! Boxes around what pieces of strands sweep in a step, of four pieces at once.

use glam::{BVec4A, Mat4, Vec3A, Vec4};

use crate::lanes::LANES;

use super::{
    meeting::SLOW,
    single::{ROUNDED, Vectors, all},
};

/// Pieces whose boxes are looked at together.
pub(super) const FOUR: usize = 4;

/// A box along the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub low: Vec3A,
    pub high: Vec3A,
}

impl Bounds {
    /// Around nothing: it meets no other.
    pub(super) const NONE: Self = Self {
        low: Vec3A::INFINITY,
        high: Vec3A::NEG_INFINITY,
    };
}

/// Four boxes, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boxes {
    pub low: [Vec4; 3],
    pub high: [Vec4; 3],
}

impl Boxes {
    pub(super) const NONE: Self = Self {
        low: [Vec4::INFINITY; 3],
        high: [Vec4::NEG_INFINITY; 3],
    };

    /// How far they are from one of others along the axis where that is most.
    #[inline(always)]
    fn gaps(&self, others: &Self, one: usize) -> Vec4 {
        let gap = |axis: usize| {
            let (low, high) = (self.low[axis], self.high[axis]);
            (low - all(&others.high[axis], one)).max(all(&others.low[axis], one) - high)
        };
        gap(0).max(gap(1)).max(gap(2))
    }
}

/// What four pieces sweep in a step: a box around all that each may meet in it, as far as it is known by itself; and for what both of two pieces do, a
/// box around it half way through the step, its mean way, how far the ways of its points are from that, and how far it goes against its root. Boxes
/// have the lock's radius. Of a strand's pieces, or of pieces of strands side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Four {
    bounds: Boxes,
    mid: Boxes,
    way: [Vec4; 3],
    spread: Vec4,
    own: Vec4,
    radius: Vec4,
}

/// Of strands side by side.
pub(super) type Row = Four;

impl Four {
    pub(super) const NONE: Self = Self {
        bounds: Boxes::NONE,
        mid: Boxes::NONE,
        way: [Vec4::ZERO; 3],
        spread: Vec4::ZERO,
        own: Vec4::ZERO,
        radius: Vec4::ZERO,
    };

    /// Of boxes half way through the step, the mean ways, how far others are from those, how far pieces go against their roots, radii, and those with
    /// what comes to them.
    #[inline(always)]
    pub(super) fn of(
        [low, high, way]: [&Vectors; 3],
        [spread, own, radius, keep]: [Vec4; 4],
    ) -> Self {
        let half = Vec4::splat(0.5);
        let around = keep + own + spread * half;
        let mut four = Self {
            way: way.0,
            spread,
            own,
            radius,
            ..Self::NONE
        };
        for axis in 0..3 {
            let (low, high) = (low.0[axis], high.0[axis]);
            let around = around + way.0[axis].abs() * half;
            four.bounds.low[axis] = low - around;
            four.bounds.high[axis] = high + around;
            four.mid.low[axis] = low - keep;
            four.mid.high[axis] = high + keep;
        }
        four
    }

    /// Of those that are there, the others meet nothing.
    #[inline(always)]
    pub(super) fn only(mut self, there: BVec4A) -> Self {
        let Boxes { low, high } = &mut self.bounds;
        *low = low.map(|low| Vec4::select(there, low, Vec4::INFINITY));
        *high = high.map(|high| Vec4::select(there, high, Vec4::NEG_INFINITY));
        self
    }

    /// Makes boxes around all that they may meet, and others may.
    #[inline(always)]
    pub(super) fn add(&mut self, other: &Self) {
        for axis in 0..3 {
            let Boxes { low, high } = &mut self.bounds;
            low[axis] = low[axis].min(other.bounds.low[axis]);
            high[axis] = high[axis].max(other.bounds.high[axis]);
        }
    }

    /// Boxes around all that each may meet.
    #[inline(always)]
    pub(super) fn bounds(&self) -> [Bounds; LANES] {
        let by_lane = |[x, y, z]: [Vec4; 3]| Mat4::from_cols(x, y, z, z).transpose();
        let (low, high) = (by_lane(self.bounds.low), by_lane(self.bounds.high));
        std::array::from_fn(|lane| Bounds {
            low: Vec3A::from_vec4(low.col(lane)),
            high: Vec3A::from_vec4(high.col(lane)),
        })
    }

    /// Of four pieces of strands side by side those of each strand.
    #[inline(always)]
    pub(super) fn store(rows: &[Self; FOUR], mut to: [&mut Self; LANES]) {
        for axis in 0..3 {
            hand_out(
                rows,
                &mut to,
                |four| four.bounds.low[axis],
                |four| &mut four.bounds.low[axis],
            );
            hand_out(
                rows,
                &mut to,
                |four| four.bounds.high[axis],
                |four| &mut four.bounds.high[axis],
            );
            hand_out(
                rows,
                &mut to,
                |four| four.mid.low[axis],
                |four| &mut four.mid.low[axis],
            );
            hand_out(
                rows,
                &mut to,
                |four| four.mid.high[axis],
                |four| &mut four.mid.high[axis],
            );
            hand_out(
                rows,
                &mut to,
                |four| four.way[axis],
                |four| &mut four.way[axis],
            );
        }
        hand_out(rows, &mut to, |four| four.spread, |four| &mut four.spread);
        hand_out(rows, &mut to, |four| four.own, |four| &mut four.own);
        hand_out(rows, &mut to, |four| four.radius, |four| &mut four.radius);
    }

    /// Which of them others may meet, as far as it is known of each by itself, as bits, those of every one of the others behind those of the one before.
    #[inline(always)]
    pub(super) fn meet(&self, others: &Self) -> u32 {
        let of = |one: usize| {
            let gaps = self.bounds.gaps(&others.bounds, one);
            gaps.cmple(Vec4::ZERO).bitmask() << (FOUR * one)
        };
        of(0) | of(1) | of(2) | of(3)
    }

    /// Which of them one of others may meet, as bits, where it keeps `keep` metres from each, or as many as both radii; and, besides their radii,
    /// how far it keeps; by how much going against each other is slow; and how much farther than half way through the step they may meet, besides their
    /// radii.
    #[inline(always)]
    pub(super) fn near(&self, others: &Self, one: usize, keep: Vec4) -> (u32, [Vec4; 3]) {
        let square = |axis: usize| {
            let against = self.way[axis] - all(&others.way[axis], one);
            against * against
        };
        let against = (square(0) + square(1) + square(2)).sqrt() * ROUNDED;
        let against = against + self.spread + all(&others.spread, one);
        let radii = self.radius + all(&others.radius, one);
        let keep = keep.min(radii);
        let (more, slow) = (keep - radii, keep * SLOW as f32);
        let acts = against.min(self.own + all(&others.own, one));
        let acts = Vec4::select(acts.cmpgt(slow), acts, Vec4::ZERO);
        let farther = more + against * 0.5 + acts;
        let near = self.mid.gaps(&others.mid, one).cmple(farther);
        (near.bitmask(), [more, slow, farther])
    }
}

/// Hands out four vectors, of four strands each, to those strands.
#[inline(always)]
fn hand_out(
    rows: &[Four; FOUR],
    to: &mut [&mut Four; LANES],
    from: impl Fn(&Four) -> Vec4,
    field: impl Fn(&mut Four) -> &mut Vec4,
) {
    let [a, b, c, d] = rows;
    let by_lane = Mat4::from_cols(from(a), from(b), from(c), from(d)).transpose();
    *field(to[0]) = by_lane.x_axis;
    *field(to[1]) = by_lane.y_axis;
    *field(to[2]) = by_lane.z_axis;
    *field(to[3]) = by_lane.w_axis;
}
