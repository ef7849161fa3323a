//! Sizes along a strand without speckle: no stretch of a stroke, and no gap in one, shorter than a
//! length.
//!
//! Closing and opening of grayscale morphology (Serra, *Image Analysis and Mathematical Morphology*,
//! 1982) with an interval for structuring element. Both change by no more than their input does, so that
//! nothing pops in animation, as it would if short pieces were looked for and left out.

use std::ops::Range;

/// Smooths lists of sizes, in a time that grows as the lists do, and hardly with how long stretches may be. Keeps its memory.
#[derive(Clone, Debug, Default)]
pub struct Smoother {
    /// For each place the window that begins there, and the one that ends there, as the places that they hold.
    from: Vec<Window>,
    to: Vec<Window>,
    /// The least sizes in them.
    after: Vec<f32>,
    before: Vec<f32>,
    /// Working memory.
    extremes: Extremes,
    found: Vec<f32>,
}

/// Places that follow each other, one or more.
#[derive(Clone, Debug)]
struct Window {
    places: Range<usize>,
    /// The two stretches that cover it, of [`Extremes::stretches`].
    stretches: [usize; 2],
}

impl Window {
    /// Of as many places.
    fn new(places: Range<usize>, count: usize) -> Self {
        let doublings = places.len().ilog2() as usize;
        let of_length = doublings * count;
        Self {
            stretches: [
                of_length + places.start,
                of_length + places.end - (1 << doublings),
            ],
            places,
        }
    }
}

/// Whether windows may reach beyond the strand, where nothing counts.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ends {
    Open,
    Closed,
}

impl Smoother {
    /// Fills gaps of `values` that are shorter than `length`, but for those at an end of the strand; then
    /// removes peaks that are shorter.
    ///
    /// `places` never decrease, in the unit of `length`; between them values are linear. All is finite.
    /// Of a short strand no more than a third counts as short.
    ///
    /// # Panics
    ///
    /// When the lists differ in length.
    pub fn smooth(&mut self, places: &[f32], values: &mut [f32], length: f32) {
        assert_eq!(places.len(), values.len(), "a value for each place");
        let (Some(first), Some(last)) = (places.first(), places.last()) else {
            return;
        };
        let length = length.min((last - first) / 3.0);
        let is_some = |value: &f32| *value != 0.0;
        let (Some(start), Some(end)) = (
            values.iter().position(is_some),
            values.iter().rposition(is_some),
        ) else {
            return;
        };
        if length <= 0.0 {
            return;
        }
        // Beyond the next 0 on each side nothing changes.
        let part = start.saturating_sub(1)..(end + 2).min(values.len());
        let (places, values) = (&places[part.clone()], &mut values[part]);
        self.find_windows(places, length);
        // Where there is no gap none is filled.
        if has_gap(values) {
            values.iter_mut().for_each(|value| *value = -*value);
            self.open(places, values, length, Ends::Open);
            values.iter_mut().for_each(|value| *value = -*value);
        }
        self.open(places, values, length, Ends::Closed);
    }

    /// For each place the places from it to `length` after it, and those from `length` before it to it.
    fn find_windows(&mut self, places: &[f32], length: f32) {
        let (mut start, mut end) = (0, 0);
        let (mut longest, count) = (1, places.len());
        self.to.clear();
        self.to.extend(places.iter().enumerate().map(|(i, place)| {
            let before = places[start..i].iter();
            start += before.take_while(|other| **other < place - length).count();
            longest = longest.max(i + 1 - start);
            Window::new(start..i + 1, count)
        }));
        self.from.clear();
        self.from
            .extend(places.iter().enumerate().map(|(i, place)| {
                let after = places[end..].iter();
                end += after.take_while(|other| **other <= place + length).count();
                longest = longest.max(end - i);
                Window::new(i..end, count)
            }));
        self.extremes.doublings = longest.ilog2() as usize;
    }

    /// At each place the greatest, over all windows of `length` that hold it, of the least value in the
    /// window. Of the windows only those are looked at that begin or end at a place, [`Self::find_windows`]'.
    fn open(&mut self, places: &[f32], values: &mut [f32], length: f32, ends: Ends) {
        let Self {
            from,
            to,
            after,
            before,
            extremes,
            found,
        } = self;
        let count = places.len();
        let is_less = |a: f32, b: f32| a < b;
        extremes.find(values, from, is_less, after);
        extremes.find(values, to, is_less, before);
        // A window ends between places; one beyond the strand's end ends there, or is the last one.
        for (i, (least, window)) in after.iter_mut().zip(&*from).enumerate() {
            let next = window.places.end;
            if next < count {
                let end = places[i] + length;
                *least = least.min(between(places, values, next - 1, end));
            }
        }
        for (i, (least, window)) in before.iter_mut().zip(&*to).enumerate() {
            let first = window.places.start;
            if first > 0 {
                let start = places[i] - length;
                *least = least.min(between(places, values, first - 1, start));
            }
        }
        if ends == Ends::Closed {
            let (first, last) = (after[0], before[count - 1]);
            let beyond = after.iter_mut().zip(&*from);
            let beyond = beyond.filter(|(_, window)| window.places.end == count);
            beyond.for_each(|(least, _)| *least = last);
            let beyond = before.iter_mut().zip(&*to);
            let beyond = beyond.filter(|(_, window)| window.places.start == 0);
            beyond.for_each(|(least, _)| *least = first);
        }
        // The windows that hold a place end up to a length after it, or begin up to a length before.
        let is_more = |a: f32, b: f32| a > b;
        extremes.find(before, from, is_more, found);
        values.copy_from_slice(found);
        extremes.find(after, to, is_more, found);
        for (value, greatest) in values.iter_mut().zip(&*found) {
            *value = value.max(*greatest);
        }
    }
}

/// The places from which values reach those `within` when sizes at `places` are smoothed over `length`: whatever the sizes are elsewhere, those
/// within come out the same, bit for bit.
///
/// `places` never decrease, and `within` holds some of them.
#[must_use]
pub fn seen_from(places: &[f32], within: Range<usize>, length: f32) -> Range<usize> {
    // A value is filled by windows that hold it, and so by values up to a length away and the next one beyond; then it is removed by such.
    let before = |i: usize| {
        let reached = places[..i].partition_point(|place| *place < places[i] - length);
        reached.saturating_sub(1)
    };
    let after = |i: usize| {
        let reached = places[i..].partition_point(|place| *place <= places[i] + length);
        (i + reached).min(places.len() - 1)
    };
    before(before(within.start))..after(after(within.end - 1)) + 1
}

/// Whether values rise again after they fell.
fn has_gap(values: &[f32]) -> bool {
    let mut pairs = values.windows(2);
    let falls = pairs.by_ref().any(|pair| pair[1] < pair[0]);
    falls && pairs.any(|pair| pair[1] > pair[0])
}

/// Finds extremes of windows: each is the more extreme of two stretches that cover it, of one, two, four or more values each, whose own are worked out first
/// (the sparse table of Bender and Farach-Colton, "The LCA Problem Revisited", 2000).
#[derive(Clone, Debug, Default)]
struct Extremes {
    /// Those of the stretches that begin at each place: of one value each, then of two, and so on.
    stretches: Vec<f32>,
    /// How often one value is doubled to the longest of them.
    doublings: usize,
}

impl Extremes {
    /// The extreme of each window, of which `is_more(a, b)` says whether `a` is the more extreme of two.
    #[inline]
    fn find(
        &mut self,
        values: &[f32],
        windows: &[Window],
        is_more: impl Fn(f32, f32) -> bool,
        extremes: &mut Vec<f32>,
    ) {
        let count = values.len();
        let extreme = |a: f32, b: f32| if is_more(b, a) { b } else { a };
        self.stretches.resize((self.doublings + 1) * count, 0.0);
        self.stretches[..count].copy_from_slice(values);
        for doubling in 0..self.doublings {
            let (done, longer) = self.stretches.split_at_mut((doubling + 1) * count);
            let halves = &done[doubling * count..];
            let halves = halves.iter().zip(&halves[1 << doubling..]);
            for (longer, (a, b)) in longer.iter_mut().zip(halves) {
                *longer = extreme(*a, *b);
            }
        }
        extremes.clear();
        let stretches = &self.stretches[..];
        extremes.extend(windows.iter().map(|window| {
            let [a, b] = window.stretches;
            extreme(stretches[a], stretches[b])
        }));
    }
}

/// The value at `place`, between the places `i` and `i + 1`, which differ.
#[inline]
fn between(places: &[f32], values: &[f32], i: usize, place: f32) -> f32 {
    let way = (place - places[i]) / (places[i + 1] - places[i]);
    let (a, b) = (values[i], values[i + 1]);
    // Rounding may reach beyond.
    (a + way * (b - a)).clamp(a.min(b), a.max(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn smoothed(values: &[f32], length: f32) -> Vec<f32> {
        let places: Vec<f32> = (0..values.len()).map(|i| i as f32).collect();
        let mut values = values.to_vec();
        Smoother::default().smooth(&places, &mut values, length);
        values
    }

    #[test]
    fn specks_and_short_gaps_go() {
        let speck = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        assert_eq!(smoothed(&speck, 2.0), [0.0; 6]);
        let hole = speck.map(|value| 1.0 - value);
        assert_eq!(smoothed(&hole, 2.0), [1.0; 6]);
    }

    #[test]
    fn long_strokes_and_long_gaps_stay() {
        let long = [
            0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0,
        ];
        assert_eq!(smoothed(&long, 2.0), long);
        let gap = [1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        assert_eq!(smoothed(&gap, 2.2), [1.0; 8]);
    }

    #[test]
    fn short_pieces_at_the_ends_go_and_short_gaps_there_stay() {
        let tips = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0];
        assert_eq!(smoothed(&tips, 2.0), [0.0; 10]);
        let bare = tips.map(|value| 1.0 - value);
        assert_eq!(smoothed(&bare, 2.0), bare);
    }

    #[test]
    fn a_short_strand_keeps_its_strokes() {
        let short = [1.0, 1.0, 0.5, 0.0];
        assert_eq!(smoothed(&short, 100.0), short);
        assert_eq!(smoothed(&[1.0], 1.0), [1.0]);
        assert_eq!(smoothed(&[], 1.0), [0.0; 0]);
    }

    #[test]
    fn zeros_around_make_no_difference() {
        let stroke = [0.0, 0.7, 0.2, 0.9, 0.0, 0.4, 0.0];
        let padded: Vec<f32> = [&[0.0; 9][..], &stroke, &[0.0; 5]].concat();
        let expected = [&[0.0; 9][..], &smoothed_within(&stroke), &[0.0; 5]].concat();
        assert_eq!(smoothed(&padded, 1.5), expected);
    }

    /// The same far from the ends of a strand, by the definition.
    fn smoothed_within(values: &[f32]) -> Vec<f32> {
        let places: Vec<f32> = (0..values.len()).map(|i| i as f32).collect();
        let mut values = values.to_vec();
        let mut smoother = Smoother::default();
        smoother.find_windows(&places, 1.5);
        values.iter_mut().for_each(|value| *value = -*value);
        smoother.open(&places, &mut values, 1.5, Ends::Open);
        values.iter_mut().for_each(|value| *value = -*value);
        smoother.open(&places, &mut values, 1.5, Ends::Closed);
        values
    }

    #[test]
    fn what_only_rises_or_falls_stays() {
        let taper = [5.0, 5.0, 5.0, 3.5, 1.0, 0.5, 0.0];
        assert_eq!(smoothed(&taper, 2.0), taper);
    }

    /// Places with steps of some tenths, and a value for each.
    fn line() -> impl Strategy<Value = (Vec<f32>, Vec<f32>)> {
        prop::collection::vec((0.0..0.5f32, 0.0..1.0f32), 1..40).prop_map(|joints| {
            let places = joints.iter().scan(0.0, |place, (step, _)| {
                *place += step;
                Some(*place)
            });
            let values = joints.iter().map(|(_, value)| (value - 0.5).max(0.0));
            (places.collect(), values.collect())
        })
    }

    /// [`Smoother::open`] by its definition, window by window.
    fn opened(places: &[f32], values: &[f32], length: f32, ends: Ends) -> Vec<f32> {
        let indices = 0..places.len();
        let after: Vec<f32> = (indices.clone())
            .map(|i| least_after(places, values, i, length, ends))
            .collect();
        let before: Vec<f32> = (indices.clone())
            .map(|i| least_before(places, values, i, length, ends))
            .collect();
        let greatest = |i: usize| {
            let place = places[i];
            let ending = (i..places.len()).take_while(|&j| places[j] <= place + length);
            let beginning = (0..=i).rev().take_while(|&j| places[j] >= place - length);
            let ending = ending.map(|j| before[j]);
            let beginning = beginning.map(|j| after[j]);
            ending.chain(beginning).fold(f32::NEG_INFINITY, f32::max)
        };
        indices.map(greatest).collect()
    }

    /// The least value from place `i` to `length` after it; where the strand ends before, up to there, or in
    /// the last window.
    fn least_after(places: &[f32], values: &[f32], i: usize, length: f32, ends: Ends) -> f32 {
        let end = places[i] + length;
        let mut least = values[i];
        for j in i + 1..places.len() {
            if places[j] > end {
                return least.min(between(places, values, j - 1, end));
            }
            least = least.min(values[j]);
        }
        match ends {
            Ends::Open => least,
            Ends::Closed => least_before(places, values, places.len() - 1, length, Ends::Open),
        }
    }

    /// The least value from `length` before place `i` to it; where the strand begins after, from there, or in
    /// the first window.
    fn least_before(places: &[f32], values: &[f32], i: usize, length: f32, ends: Ends) -> f32 {
        let start = places[i] - length;
        let mut least = values[i];
        for j in (0..i).rev() {
            if places[j] < start {
                return least.min(between(places, values, j, start));
            }
            least = least.min(values[j]);
        }
        match ends {
            Ends::Open => least,
            Ends::Closed => least_after(places, values, 0, length, Ends::Open),
        }
    }

    proptest! {
        #[test]
        fn windows_are_those_of_the_definition(
            (places, values) in line(),
            length in prop_oneof![0.0..3.0f32, Just(1e-4f32)],
            is_closed in any::<bool>(),
        ) {
            let ends = if is_closed { Ends::Closed } else { Ends::Open };
            // Twice, with the memory of the first time.
            let mut smoother = Smoother::default();
            smoother.find_windows(&places, length);
            for values in [values.clone(), values.iter().map(|value| -value).collect()] {
                let mut fast = values.clone();
                smoother.open(&places, &mut fast, length, ends);
                prop_assert_eq!(fast, opened(&places, &values, length, ends));
            }
        }

        #[test]
        fn what_is_far_away_makes_no_difference(
            (places, values) in line(),
            length in prop_oneof![0.0..3.0f32, 0.0..0.5f32],
            ends in (0.0..1.0f32, 0.0..1.0f32),
        ) {
            let count = values.len();
            let [a, b] = [ends.0, ends.1].map(|end| (end * count as f32) as usize);
            let within = a.min(b)..a.max(b) + 1;
            let seen = seen_from(&places, within.clone(), length);
            prop_assert!(seen.start <= within.start && within.end <= seen.end);
            let mut all = values.clone();
            let mut some = values;
            some[..seen.start].fill(0.0);
            some[seen.end..].fill(0.0);
            let mut smoother = Smoother::default();
            smoother.smooth(&places, &mut all, length);
            smoother.smooth(&places, &mut some, length);
            prop_assert_eq!(&all[within.clone()], &some[within]);
        }

        #[test]
        fn what_is_left_out_makes_no_difference(
            (places, mut values) in line(),
            length in 0.0..3.0f32,
            has_gaps in any::<bool>(),
        ) {
            if !has_gaps {
                let (rise, fall) = values.split_at_mut(places.len() / 2);
                rise.sort_by(f32::total_cmp);
                fall.sort_by(|a, b| b.total_cmp(a));
            }
            let mut smooth = values.clone();
            Smoother::default().smooth(&places, &mut smooth, length);
            let length = length.min((places[places.len() - 1] - places[0]) / 3.0);
            let negative: Vec<f32> = values.iter().map(|value| -value).collect();
            let closed: Vec<f32> = opened(&places, &negative, length, Ends::Open)
                .iter()
                .map(|value| -value)
                .collect();
            if length > 0.0 {
                prop_assert_eq!(smooth, opened(&places, &closed, length, Ends::Closed));
            }
        }

        #[test]
        fn a_small_change_stays_small(
            (places, values) in line(),
            length in 0.0..3.0f32,
            changes in prop::collection::vec(-0.01..0.01f32, 40),
        ) {
            let mut first = values.clone();
            let mut second: Vec<f32> = values.iter().zip(&changes).map(|(v, c)| v + c).collect();
            let mut smoother = Smoother::default();
            smoother.smooth(&places, &mut first, length);
            smoother.smooth(&places, &mut second, length);
            for (a, b) in first.iter().zip(&second) {
                prop_assert!((a - b).abs() <= 0.010_001, "{a} {b}");
            }
        }

        #[test]
        fn sizes_stay_between_their_least_and_greatest((places, values) in line(), length in 0.0..3.0f32) {
            let mut smooth = values.clone();
            Smoother::default().smooth(&places, &mut smooth, length);
            let least = values.iter().copied().fold(f32::INFINITY, f32::min);
            let greatest = values.iter().copied().fold(0.0, f32::max);
            for value in smooth {
                prop_assert!((least..=greatest).contains(&value));
            }
        }

        #[test]
        fn no_piece_inside_is_shorter((places, mut values) in line(), length in 0.1..2.0f32) {
            Smoother::default().smooth(&places, &mut values, length);
            let last = places.len() - 1;
            let length = length.min((places[last] - places[0]) / 3.0) * 0.9999;
            for stroke in values.chunk_by(|a, b| (*a > 0.0) == (*b > 0.0)) {
                let start = (stroke.as_ptr() as usize - values.as_ptr() as usize) / 4;
                let end = start + stroke.len() - 1;
                // From the joint before to the joint after, as the stroke tapers to there.
                if stroke[0] > 0.0 && start > 0 && end < last {
                    prop_assert!(places[end + 1] - places[start - 1] >= length);
                }
            }
        }
    }
}
