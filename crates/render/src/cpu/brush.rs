//! What brushes leave of the strokes of a strand in a tile: the samples that they keep bare are taken away before anything is drawn.

use super::context::TileContext;
use super::segment::Stroke;
use super::spots::Spots;
use super::stroke::Placed;
use super::tile::{LANES, LaneMask, Lanes, Mask, OneByOne, STACK, Stack, bits, select};
use crate::brushwork::BrushedLayer;
use crate::drawing::scatter;
use effects::{BrushPlaces, StrandBrush};

/// Samples of a tile at which a stroke's brush is looked up, in the order of rows and columns.
#[derive(Default)]
pub(super) struct LookUps {
    /// The word of a mask that each is in, and its column.
    words: Vec<u8>,
    columns: Vec<u8>,
}

impl LookUps {
    /// Finds those of some wanted samples in place of what was there: of so many that are looked up together the first one that the stroke reaches,
    /// where any of them is wanted.
    #[inline(always)]
    fn find(&mut self, wanted: &Mask, reached: &Mask, together: usize) {
        self.words.clear();
        self.columns.clear();
        for group in (0..wanted.len()).step_by(together) {
            let words = group..group + together;
            let mut left = 0;
            for &word in &wanted[words.clone()] {
                left |= word;
            }
            for word in words {
                let first = left & reached[word];
                left &= !first;
                for column in OneByOne::of_bits(first) {
                    self.words.push(word as u8);
                    self.columns.push(column as u8);
                }
            }
        }
    }

    /// As many of them as a cell has lanes, from that one on; behind the last one that one again.
    #[inline(always)]
    fn spots_from(&self, first: usize) -> Spots {
        let (mut word, mut column) = ([0; LANES], [0; LANES]);
        let count = (self.words.len() - first).min(LANES);
        for k in 0..LANES {
            let place = first + k.min(count - 1);
            word[k] = u32::from(self.words[place]);
            column[k] = u32::from(self.columns[place]);
        }
        Spots::new(word, column, count)
    }
}

/// Where samples lie beside a stroke.
struct Beside {
    places: BrushPlaces<LANES>,
    /// Radius of the clump there, where it matters.
    clump_px: Lanes,
}

/// A stroke's brush.
pub(super) struct StrokeBrush<'a> {
    scene: &'a TileContext<'a>,
    brush: StrandBrush<'a>,
    /// Whether it shows outside of its clump alone.
    is_outline: bool,
    /// What coverage must exceed in each lane.
    parts: Lanes,
}

impl<'a> StrokeBrush<'a> {
    /// That of a layer's stroke, on the strand of a segment.
    #[inline(always)]
    pub(super) fn new(
        scene: &'a TileContext<'a>,
        layer: &'a BrushedLayer,
        stroke: &Stroke,
        segment: u32,
    ) -> Self {
        let [joint, _] = scene.segments[segment as usize].joints();
        let strand = scene.drawing.brushwork.joints[joint].strand;
        let seed = layer.stroke_seed(stroke.instance, strand);
        Self {
            scene,
            brush: layer.of_stroke(seed),
            is_outline: stroke.rank < 0 && scene.drawing.decal(stroke.layer).is_none(),
            parts: parts(seed, scene.stack),
        }
    }

    /// Takes from the samples those that it leaves bare. They are some of those that the segments of the stroke cover: of each pixel's the
    /// first one is looked up.
    #[inline(always)]
    pub(super) fn thin(
        &self,
        placed: &[Placed],
        look_ups: &mut LookUps,
        covered: &Mask,
        samples: &mut Mask,
    ) {
        let together = self.scene.stack.together();
        look_ups.find(samples, covered, together);
        let mut nearest = 0;
        for first in (0..look_ups.words.len()).step_by(LANES) {
            let spots = look_ups.spots_from(first);
            let places = spots.places(placed, &mut nearest);
            let across = places.across();
            let places = self.places(&[u32::MAX; LANES], &places.index, &places.way, &across);
            let coverage = self.coverage(&places);
            for k in 0..spots.count {
                let word = spots.words[k] as usize / together * together;
                for word in word..word + together {
                    let is_bare = coverage[k] <= self.parts[word % STACK];
                    samples[word] &= !(u32::from(is_bare) << spots.columns[k]);
                }
            }
        }
    }

    /// Those of some samples of a cell that it leaves bare, by their places: segments, the way from their first joints to the next, and across.
    #[inline(always)]
    pub(super) fn bare(
        &self,
        samples: &LaneMask,
        segments: &[u32; LANES],
        way: &Lanes,
        across: &Lanes,
    ) -> LaneMask {
        let coverage = self.coverage(&self.places(samples, segments, way, across));
        let together = self.scene.stack.together();
        let mut of_first = coverage;
        for lane in OneByOne::of_bits(first_of_groups(bits(samples), together)) {
            let group = lane / together * together;
            of_first[group..group + together].fill(coverage[lane]);
        }
        let mut bare = *samples;
        for k in 0..LANES {
            bare[k] &= select(of_first[k] <= self.parts[k], u32::MAX, 0);
        }
        bare
    }

    #[inline(always)]
    fn coverage(&self, beside: &Beside) -> Lanes {
        match self.is_outline {
            true => self
                .brush
                .coverages(&beside.places.on_outline(&beside.clump_px)),
            false => self.brush.coverages(&beside.places),
        }
    }

    /// Where some samples of a cell lie, segment by segment: most are of one.
    #[inline(always)]
    fn places(
        &self,
        samples: &LaneMask,
        segments: &[u32; LANES],
        way: &Lanes,
        across: &Lanes,
    ) -> Beside {
        let mut beside = Beside {
            places: BrushPlaces::ZERO,
            clump_px: [0.0; LANES],
        };
        let mut left = *samples;
        while let Some(lane) = OneByOne::of_bits(bits(&left)).next() {
            let segment = segments[lane];
            let mut own = left;
            for k in 0..LANES {
                own[k] &= select(segments[k] == segment, u32::MAX, 0);
                left[k] &= !own[k];
            }
            let segment = &self.scene.segments[segment as usize];
            let radii_px = segment.radii(self.scene.drawing, self.scene.strokes);
            let [from, to] = segment.joints();
            let joints = &self.scene.drawing.brushwork.joints;
            let [along, along_next] = [&joints[from], &joints[to]];
            let places = &mut beside.places;
            mix(&mut places.s, &own, way, [along.s, along_next.s]);
            mix(
                &mut places.whole,
                &own,
                way,
                [along.whole, along_next.whole],
            );
            mix(
                &mut places.pixels,
                &own,
                way,
                [along.pixels, along_next.pixels],
            );
            mix(&mut places.radius_px, &own, way, radii_px);
            if self.is_outline {
                let clump = &self.scene.drawing.clump;
                let clump_px = [clump[from].radius, clump[to].radius];
                mix(&mut beside.clump_px, &own, way, clump_px);
            }
        }
        beside.places.v = *across;
        beside
    }
}

/// What some samples have that lie so far on the way from one end of a segment to the other.
#[inline(always)]
fn mix(lanes: &mut Lanes, own: &LaneMask, way: &Lanes, [from, to]: [f32; 2]) {
    let rise = to - from;
    let mut mixed = *lanes;
    for k in 0..LANES {
        mixed[k] = select(own[k] != 0, from + way[k] * rise, lanes[k]);
    }
    *lanes = mixed;
}

/// The first lanes of groups of so many, 1, 2 or 4: those of a pixel that are looked up together.
#[inline(always)]
fn starts(together: usize) -> u32 {
    u32::MAX / ((1 << together) - 1)
}

/// The first lane of each group among some lanes.
#[inline(always)]
fn first_of_groups(lanes: u32, together: usize) -> u32 {
    let mut behind = 0;
    for _ in 1..together {
        behind = ((behind | lanes) << 1) & !starts(together);
    }
    lanes & !behind
}

/// The part that a stroke of that seed has in each sample of a cell.
#[inline(always)]
fn parts(seed: u32, stack: &Stack) -> Lanes {
    let together = stack.of_pixel;
    let mut parts = [0.5; LANES];
    if together > 1 {
        for (k, part) in parts.iter_mut().enumerate() {
            *part = scatter(seed, (stack.first + k % together) as u32);
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::tile::NO_SAMPLES;
    use proptest::prelude::*;

    #[test]
    fn the_first_lane_of_each_group_is_found() {
        for together in [1, 2, 4] {
            for lanes in 0..1_u32 << LANES {
                let is_set = |lane: &usize| lanes >> lane & 1 != 0;
                let groups = (0..LANES).step_by(together);
                let firsts = groups.filter_map(|first| (first..first + together).find(is_set));
                let expected = firsts.fold(0, |firsts, lane| firsts | 1 << lane);
                assert_eq!(
                    first_of_groups(lanes, together),
                    expected,
                    "{lanes:b}, {together}"
                );
            }
        }
    }

    proptest! {
        /// Of the samples of a group in a column the first that the stroke reaches is looked up, wherever any is wanted.
        #[test]
        fn each_group_is_looked_up_once(
            reached in prop::collection::vec(any::<u32>(), NO_SAMPLES.len()),
            some in prop::collection::vec(any::<u32>(), NO_SAMPLES.len()),
            together in prop::sample::select(vec![1_usize, 2, 4]),
        ) {
            let (mut wanted, mut all) = (NO_SAMPLES, NO_SAMPLES);
            for word in 0..all.len() {
                (all[word], wanted[word]) = (reached[word], reached[word] & some[word]);
            }
            let mut look_ups = LookUps::default();
            look_ups.find(&wanted, &all, together);
            let mut expected = Vec::new();
            for group in (0..all.len()).step_by(together) {
                for column in 0..u32::BITS {
                    let of = |mask: &Mask| (group..group + together).find(|word| mask[*word] >> column & 1 != 0);
                    expected.extend(of(&wanted).and(of(&all)).map(|word| (word as u8, column as u8)));
                }
            }
            expected.sort_unstable();
            let mut found: Vec<(u8, u8)> = look_ups.words.iter().copied().zip(look_ups.columns.iter().copied()).collect();
            found.sort_unstable();
            prop_assert_eq!(&found, &expected);
            // Those of the last one are filled up with it.
            if let Some(last) = look_ups.words.len().checked_sub(1) {
                let spots = look_ups.spots_from(last / LANES * LANES);
                prop_assert_eq!(spots.count, last % LANES + 1);
                prop_assert_eq!(spots.words[LANES - 1], u32::from(look_ups.words[last]));
            }
        }
    }
}
