//! Strands that come near each other, by boxes around what they sweep: along one axis in order, four at once.

use glam::Vec4;

use super::boxes::{Bounds, Boxes, FOUR, Four};

/// Places that a strand moves in the order along the axis, on average, before the order is found from nothing.
const MOST_MOVES: usize = 16;

/// Pairs of strands whose boxes meet in a step.
#[derive(Clone, Debug)]
pub(super) struct Pairs {
    /// The strands in order along the first axis, and where they are on it.
    order: Vec<(u32, f32)>,
    /// Their boxes in this order.
    boxes: Vec<Boxes>,
    /// Where the pieces of every strand begin among all fours; one more at the end.
    first: Vec<usize>,
    pairs: Vec<[u32; 2]>,
}

impl Pairs {
    /// For strands, of which `strands` are the first pieces; one more at the end.
    pub(super) fn new(strands: &[usize]) -> Self {
        let mut first = vec![0];
        for ends in strands.windows(2) {
            first.push(first[first.len() - 1] + (ends[1] - ends[0]).div_ceil(FOUR));
        }
        let count = strands.len() - 1;
        Self {
            order: (0..count as u32).map(|strand| (strand, 0.0)).collect(),
            boxes: vec![Boxes::NONE; count.div_ceil(FOUR)],
            first,
            pairs: Vec::new(),
        }
    }

    /// Finds them.
    pub(super) fn find(&mut self, strands: &[Bounds]) {
        self.sort(strands);
        for (place, &(strand, _)) in self.order.iter().enumerate() {
            let bounds = &strands[strand as usize];
            let boxes = &mut self.boxes[place / FOUR];
            for axis in 0..3 {
                boxes.low[axis][place % FOUR] = bounds.low[axis];
                boxes.high[axis][place % FOUR] = bounds.high[axis];
            }
        }
        self.pairs.clear();
        for (place, &(one, _)) in self.order.iter().enumerate() {
            let Bounds { low, high } = &strands[one as usize];
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
                    self.pairs.push([one.min(other), one.max(other)]);
                }
                behind = 0b1111;
            }
        }
    }

    /// Brings the strands in order, which is nearly that of the step before.
    fn sort(&mut self, strands: &[Bounds]) {
        for (strand, at) in &mut self.order {
            *at = strands[*strand as usize].low.x;
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

    /// The pairs, each once, the earlier strand first.
    pub(super) fn all(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// Tells of all pieces of a pair of strands whose boxes meet: of four of the second's, and of a piece of the first, which is one of four. `strands`
    /// are the first pieces of each; `among` says of a piece of the first by its number there, and of four of the second's by theirs, which of these
    /// it may be about, as bits.
    #[inline(always)]
    pub(super) fn pieces(
        &self,
        pair: &[u32; 2],
        fours: &[Four],
        strands: &[usize],
        among: impl Fn(usize, usize) -> u32,
        mut tell: impl FnMut(&MeetFour),
    ) {
        let [one, other] = pair.map(|strand| strand as usize);
        let (from, its_from) = (strands[one], strands[other]);
        let count = strands[one + 1] - from;
        let own_fours = &fours[self.first[one]..self.first[one + 1]];
        let its_fours = &fours[self.first[other]..self.first[other + 1]];
        for (number, four) in its_fours.iter().enumerate() {
            for i in 0..count {
                let among = among(i, number);
                if among == 0 {
                    continue;
                }
                let (own, one) = (&own_fours[i / FOUR], i % FOUR);
                let bits = four.meet(own, one) & among;
                if bits != 0 {
                    tell(&MeetFour {
                        own,
                        one,
                        piece: from + i,
                        four,
                        first: its_from + number * FOUR,
                        place: (i, number),
                        bits,
                    });
                }
            }
        }
    }
}

/// A piece, and four of another strand of which some boxes meet its.
pub(super) struct MeetFour<'a> {
    /// The piece, its four, and which of those it is.
    pub piece: usize,
    pub own: &'a Four,
    pub one: usize,
    /// The four of the other strand, and the first of these pieces.
    pub four: &'a Four,
    pub first: usize,
    /// The number of the piece on its strand, and that of the four on the other.
    pub place: (usize, usize),
    /// Of the four those whose boxes meet.
    pub bits: u32,
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
