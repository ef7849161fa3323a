//! Fours of pieces that come near each other, by boxes around what they sweep: along one axis in order, four at once.

use glam::Vec4;

use super::boxes::{Bounds, Boxes, FOUR};

/// Places that one moves in the order along the axis, on average, before the order is found from nothing.
const MOST_MOVES: usize = 16;

/// Pairs of fours of different strands whose boxes meet in a step.
#[derive(Clone, Debug)]
pub(super) struct Pairs {
    /// In order along the first axis, and where they are on it.
    order: Vec<(u32, f32)>,
    /// Their boxes in this order.
    boxes: Vec<Boxes>,
    /// The strand of each.
    strands: Vec<u32>,
    pairs: Vec<[u32; 2]>,
}

impl Pairs {
    /// For fours of these strands.
    pub(super) fn new(strands: Vec<u32>) -> Self {
        let count = strands.len();
        Self {
            order: (0..count as u32).map(|four| (four, 0.0)).collect(),
            boxes: vec![Boxes::NONE; count.div_ceil(FOUR)],
            strands,
            pairs: Vec::new(),
        }
    }

    /// Finds them.
    pub(super) fn find(&mut self, fours: &[Bounds]) {
        self.sort(fours);
        for (place, &(four, _)) in self.order.iter().enumerate() {
            let bounds = &fours[four as usize];
            let boxes = &mut self.boxes[place / FOUR];
            for axis in 0..3 {
                boxes.low[axis][place % FOUR] = bounds.low[axis];
                boxes.high[axis][place % FOUR] = bounds.high[axis];
            }
        }
        self.pairs.clear();
        for (place, &(one, _)) in self.order.iter().enumerate() {
            let Bounds { low, high } = &fours[one as usize];
            let strand = self.strands[one as usize];
            let (low, high) = (
                [low.y, low.z].map(Vec4::splat),
                [high.x, high.y, high.z].map(Vec4::splat),
            );
            // Those behind it alone.
            let mut behind = 0b1110 << (place % FOUR) & 0b1111;
            for (number, boxes) in self.boxes.iter().enumerate().skip(place / FOUR) {
                let is_before = boxes.low[0].cmple(high[0]);
                if !is_before.any() {
                    break;
                }
                let meet = is_before
                    & boxes.low[1].cmple(high[1])
                    & boxes.low[2].cmple(high[2])
                    & boxes.high[1].cmpge(low[0])
                    & boxes.high[2].cmpge(low[1]);
                for other in ones(meet.bitmask() & behind) {
                    let (other, _) = self.order[number * FOUR + other];
                    if self.strands[other as usize] != strand {
                        self.pairs.push([one.min(other), one.max(other)]);
                    }
                }
                behind = 0b1111;
            }
        }
    }

    /// Brings them in order, which is nearly that of the step before.
    fn sort(&mut self, fours: &[Bounds]) {
        for (four, at) in &mut self.order {
            *at = fours[*four as usize].low.x;
        }
        let mut moves = MOST_MOVES * self.order.len();
        for place in 1..self.order.len() {
            let own = self.order[place];
            let mut to = place;
            while to > 0 && self.order[to - 1].1 > own.1 {
                self.order[to] = self.order[to - 1];
                to -= 1;
            }
            self.order[to] = own;
            moves = moves.saturating_sub(place - to);
            if moves == 0 {
                self.order
                    .sort_unstable_by(|one, other| one.1.total_cmp(&other.1));
                return;
            }
        }
    }

    /// The pairs, each once, the earlier first.
    pub(super) fn all(&self) -> &[[u32; 2]] {
        &self.pairs
    }
}

/// The numbers of bits.
#[inline(always)]
pub(super) fn ones(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let next = (bits != 0).then(|| bits.trailing_zeros() as usize);
        bits &= bits.wrapping_sub(1);
        next
    })
}
