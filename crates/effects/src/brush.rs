//! Brushes: what a tool leaves of a stroke on paper. Coverage along the stroke and across it, in place of a whole stroke.

mod mark;
mod noise;
#[cfg(test)]
mod tests;
mod tools;

use crate::choices;
use crate::param::{ParamKind, Value};
use crate::section;
use crate::section::ParamType;
use crate::texture::{Image, ImageError, choose, least, most};
use crate::wgsl::hash;
use mark::Mark;
use std::sync::Arc;

choices! {
    /// What a stroke is drawn with.
    pub enum Tool {
        /// What leaves nothing bare.
        Solid = "solid",
        /// A pencil: grain of the paper in a soft line.
        Pencil = "pencil",
        /// Charcoal: coarse grain, edges that crumble.
        Charcoal = "charcoal",
        /// A brush that runs dry: streaks along the stroke, which open up.
        DryInk = "dry_ink",
        /// A wash with dark edges.
        Watercolour = "watercolour",
        /// Wax on rough paper: hard grain, clots.
        Crayon = "crayon",
        /// Whole teeth at both edges, as a highlight in drawn hair has them.
        Zigzag = "zigzag",
    }
}

choices! {
    /// How a brush's texture lies along a stroke.
    pub enum Fit {
        /// One copy behind the other.
        Repeat = "repeat",
        /// One copy from root to tip.
        Stretch = "stretch",
        /// As many whole marks as come nearest to their length; at least one.
        Whole = "whole",
    }
}

impl ParamType for Option<Fit> {
    fn from_value(value: Value) -> Self {
        Some(Fit::from_value(value))
    }

    fn to_value(&self) -> Option<Value> {
        self.as_ref().and_then(Fit::to_value)
    }

    fn unset(_: &ParamKind) -> Self {
        None
    }
}

section! {
    /// What a layer's strokes are drawn with. Where the tool leaves the paper bare, one sees what lies beneath, as if the stroke weren't there. Its marks
    /// stay where they are on the strand, and no two strands have the same.
    pub struct BrushSection {
        /// The tool: `pencil`, `charcoal`, `dry_ink`, `watercolour`, `crayon`, or `zigzag` for teeth at both edges; `solid` leaves nothing bare.
        kind: Tool = Tool::Solid.or_another(),
        /// A PNG file in place of a tool: from left to right along the stroke, from top to bottom across it. It covers where it is opaque; of one that
        /// is opaque all over, where it is dark.
        texture: Option<String> = text(),
        /// How much of a stroke the texture covers before it is repeated; of whole marks, a mark: a tooth. The tool's own by default.
        length: Option<f32> = number(0.4, 0.01..=100.0).unit("head heights").optional(),
        /// Whether the texture is repeated along the stroke, stretched once from root to tip, or lies there in whole marks, as many as come nearest to
        /// `length`. The tool's own by default: `stretch` of `dry_ink`, `whole` of `zigzag`.
        fit: Option<Fit> = Fit::Repeat.or_another().optional(),
        /// How coarse the tool's marks are: 2 is twice as coarse.
        grain: f32 = number(1.0, 0.25..=4.0),
        /// How little the tool leaves: 0 nearly covers the stroke, at 1 most of it is bare.
        dry: f32 = number(0.5, 0.0..=1.0),
        /// Other numbers are other marks of the same tool.
        seed: u32 = whole(1, 0..=i32::MAX as u32),
    }
}

impl BrushSection {
    /// What is the tool's own where the section says nothing, in place of the table's default.
    pub const OF_THE_TOOL: &'static [&'static str] = &["length", "fit"];

    /// Whether it leaves anything bare.
    #[must_use]
    pub fn is_solid(&self) -> bool {
        self.kind == Tool::Solid && self.texture.is_none()
    }

    fn fit(&self) -> Fit {
        let own = match (&self.texture, self.kind) {
            (None, Tool::DryInk) => Fit::Stretch,
            (None, Tool::Zigzag) => Fit::Whole,
            _ => Fit::Repeat,
        };
        self.fit.unwrap_or(own)
    }

    /// How many whole marks a copy is made of.
    fn parts(&self) -> u32 {
        match self.texture {
            Some(_) => 1,
            None => self.kind.parts(),
        }
    }

    fn lie(&self) -> Lie {
        let own = match self.texture {
            Some(_) => 0.4,
            None => self.kind.length() * self.grain_of_marks(),
        };
        let parts = self.parts();
        match self.fit() {
            Fit::Stretch => Lie::Stretched,
            Fit::Repeat => Lie::Repeated {
                length: self.length.unwrap_or(own * parts as f32),
            },
            Fit::Whole => Lie::Whole {
                length: self.length.unwrap_or(own),
                parts,
            },
        }
    }

    /// Coarser teeth are longer ones: of other tools grain is finer than a copy.
    fn grain_of_marks(&self) -> f32 {
        match self.kind {
            Tool::Zigzag => self.grain,
            _ => 1.0,
        }
    }
}

/// How copies of a texture lie along a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lie {
    /// One behind the other, each that many head heights long.
    Repeated { length: f32 },
    /// One from root to tip.
    Stretched,
    /// So many of a copy's parts that each is about that long (head heights), from one of them on that is the strand's own.
    Whole { length: f32, parts: u32 },
}

impl Lie {
    /// Whether a copy follows another.
    fn repeats(self) -> bool {
        self != Self::Stretched
    }
}

/// The coverage of strokes that a tool draws. Each strand has it from another place on, on one side or the other.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushTexture {
    /// All of one size: a strand has one of them.
    marks: Vec<Mark>,
    lie: Lie,
    /// Whether they tell how far within a shape a place lies, in place of coverage: see [`Self::is_shape`].
    is_shape: bool,
}

impl BrushTexture {
    /// What the section's tool leaves; nothing of one that leaves nothing bare, or of a file.
    #[must_use]
    pub fn of_tool(section: &BrushSection) -> Option<Self> {
        if section.is_solid() || section.texture.is_some() {
            return None;
        }
        let lie = section.lie();
        let marks = tools::marks(section).map(|image| Mark::new(image, lie.repeats()));
        Some(Self {
            marks: marks.collect(),
            lie,
            is_shape: section.kind == Tool::Zigzag,
        })
    }

    /// What a picture leaves, as the section says.
    ///
    /// # Errors
    ///
    /// Never for a picture that could be read.
    pub fn of_picture(section: &BrushSection, picture: &Image) -> Result<Self, ImageError> {
        let (size, texels) = picture.level(0);
        let alpha = |texel: &[half::f16; 4]| texel[3].to_f32();
        let is_opaque = texels.iter().all(|texel| alpha(texel) >= 1.0);
        let coverage = texels.iter().map(|texel| match is_opaque {
            true => {
                let [red, green, blue, _] = texel.map(half::f16::to_f32);
                // What black covers of white paper lacks of its light.
                1.0 - (0.2126 * red + 0.7152 * green + 0.0722 * blue)
            }
            false => alpha(texel),
        });
        let image = Image::of_coverage(size, &coverage.collect::<Vec<_>>())?;
        let lie = section.lie();
        Ok(Self {
            marks: vec![Mark::new(image, lie.repeats())],
            lie,
            is_shape: false,
        })
    }

    /// The pictures whose coverage it is, all of one size.
    pub fn marks(&self) -> impl ExactSizeIterator<Item = &Arc<Image>> {
        self.marks.iter().map(|mark| &mark.image)
    }

    /// How many head heights along a strand a copy is, or a whole mark; nothing where a copy is as long as the strand.
    #[must_use]
    pub fn length(&self) -> Option<f32> {
        match self.lie {
            Lie::Repeated { length } | Lie::Whole { length, .. } => Some(length),
            Lie::Stretched => None,
        }
    }

    /// How many whole marks a copy is made of, where strokes show whole ones alone.
    #[must_use]
    pub fn parts(&self) -> Option<u32> {
        match self.lie {
            Lie::Whole { parts, .. } => Some(parts),
            _ => None,
        }
    }

    /// Whether the pictures tell how far within a shape a place lies, in widths of the stroke and from 0.5 at the shape's edge on, so that the edge
    /// is sharp however large it is drawn, and one shape goes over into another without showing both.
    #[must_use]
    pub fn is_shape(&self) -> bool {
        self.is_shape
    }

    /// What of it a strand of that seed has.
    #[must_use]
    pub fn of_strand(&self, seed: u32) -> StrandBrush<'_> {
        let mixed = hash(seed);
        StrandBrush {
            mark: &self.marks[mixed as usize % self.marks.len()],
            lie: self.lie,
            is_shape: self.is_shape,
            side: if mixed & 0x100 == 0 { 1.0 } else { -1.0 },
            start: (mixed >> 9) as f32 / (1 << 23) as f32,
        }
    }
}

/// What of a brush one strand has.
#[derive(Clone, Copy, Debug)]
pub struct StrandBrush<'a> {
    mark: &'a Mark,
    lie: Lie,
    is_shape: bool,
    /// 1, or -1 where it is turned over.
    side: f32,
    /// The part of a copy at which it begins.
    start: f32,
}

/// A place beside a stroke.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BrushPlace {
    /// Length of the strand up to there, head heights.
    pub s: f32,
    /// Length of the whole strand, head heights.
    pub whole: f32,
    /// Place across the stroke, -1 to 1.
    pub v: f32,
    /// Pixels that a head's height takes there.
    pub pixels: f32,
    /// Radius of the stroke there, pixels.
    pub radius_px: f32,
}

/// `N` places beside strokes of a strand, number by number as [`BrushPlace`] has them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrushPlaces<const N: usize> {
    /// Length of the strand up to there, head heights.
    pub s: [f32; N],
    /// Length of the whole strand, head heights.
    pub whole: [f32; N],
    /// Place across the stroke, -1 to 1.
    pub v: [f32; N],
    /// Pixels that a head's height takes there.
    pub pixels: [f32; N],
    /// Radius of the stroke there, pixels.
    pub radius_px: [f32; N],
}

impl<const N: usize> BrushPlaces<N> {
    /// Numbers that are all 0.
    pub const ZERO: Self = Self {
        s: [0.0; N],
        whole: [0.0; N],
        v: [0.0; N],
        pixels: [0.0; N],
        radius_px: [0.0; N],
    };

    /// The same places across outlines, whose strokes show outside of clumps of these radii (px) alone: between the clump's edge and their own.
    #[inline(always)] // into loops that are compiled for other instructions than their crate
    #[must_use]
    pub fn on_outline(mut self, clump_px: &[f32; N]) -> Self {
        for k in 0..N {
            let (v, radius, clump) = (self.v[k], self.radius_px[k], clump_px[k]);
            let width = radius - clump;
            let side = choose(v < 0.0, -1.0, 1.0);
            let from_middle = 2.0 * (v.abs() * radius - clump) / width - 1.0;
            // Where there is no clump all of the stroke shows.
            let is_beside = (clump > 0.0) & (width > 0.0);
            self.v[k] = choose(is_beside, side * least(most(from_middle, -1.0), 1.0), v);
            self.radius_px[k] = choose(is_beside, 0.5 * width, radius);
        }
        self
    }
}

impl From<BrushPlace> for BrushPlaces<1> {
    fn from(place: BrushPlace) -> Self {
        Self {
            s: [place.s],
            whole: [place.whole],
            v: [place.v],
            pixels: [place.pixels],
            radius_px: [place.radius_px],
        }
    }
}

/// The shortest stroke that a texture is laid on, head heights.
const TINY: f32 = 1e-6;

/// How many whole marks there are where that many would fit, and how much of one more: the one number goes over into the other where both are as near.
#[inline(always)]
fn whole_marks(fitting: f32) -> (f32, f32) {
    // No more than can be told apart.
    let fitting = least(most(fitting, 1.0), 1e6);
    let count = fitting.floor();
    let more = least(most((fitting - count - 0.4) / 0.2, 0.0), 1.0);
    (count, more * more * (3.0 - 2.0 * more))
}

/// How many places of a picture are looked up at most where a pixel covers more texels one way than the other.
const MOST_LOOKUPS: f32 = 4.0;

impl StrandBrush<'_> {
    /// How much of a pixel at a place is covered, 0 to 1. `shaders/gpu/brushed.wgsl` does the same.
    #[must_use]
    pub fn coverage(&self, at: &BrushPlace) -> f32 {
        let [coverage] = self.coverages(&BrushPlaces::from(*at));
        coverage
    }

    /// The same at `N` places, by loops that compile to vector instructions.
    #[inline(always)] // into loops that are compiled for other instructions than their crate
    #[must_use]
    pub fn coverages<const N: usize>(&self, at: &BrushPlaces<N>) -> [f32; N] {
        let mut coverage = self.marked(at);
        if self.is_shape {
            for k in 0..N {
                // The edge is a pixel broad.
                let within_px = (coverage[k] - 0.5) * 2.0 * at.radius_px[k];
                coverage[k] = least(most(0.5 + within_px, 0.0), 1.0);
            }
        }
        coverage
    }

    /// What the marks tell of the places.
    #[inline(always)]
    fn marked<const N: usize>(&self, at: &BrushPlaces<N>) -> [f32; N] {
        let (mut x, mut length) = ([0.0; N], [0.0; N]);
        match self.lie {
            Lie::Repeated { length: copy } => {
                for k in 0..N {
                    length[k] = copy;
                    x[k] = at.s[k] / copy + self.start;
                }
                self.laid(at, &x, &length)
            }
            Lie::Stretched => {
                for k in 0..N {
                    length[k] = most(at.whole[k], TINY);
                    x[k] = at.s[k] / length[k];
                }
                self.laid(at, &x, &length)
            }
            Lie::Whole {
                length: own,
                parts: own_parts,
            } => {
                let parts = own_parts as f32;
                let first = (self.start * parts).floor();
                let (mut count, mut more) = ([0.0; N], [0.0; N]);
                let mut is_mixed = false;
                for k in 0..N {
                    (count[k], more[k]) = whole_marks(at.whole[k] / own);
                    is_mixed |= more[k] > 0.0;
                }
                let (mut coverage, mut one_more) = ([0.0; N], [0.0; N]);
                for coverage in [&mut coverage, &mut one_more] {
                    for k in 0..N {
                        let mark = most(at.whole[k], TINY) / count[k];
                        length[k] = mark * parts;
                        x[k] = (first + at.s[k] / mark) / parts;
                    }
                    *coverage = self.laid(at, &x, &length);
                    if !is_mixed {
                        return *coverage;
                    }
                    for count in &mut count {
                        *count += 1.0;
                    }
                }
                for k in 0..N {
                    coverage[k] = coverage[k] * (1.0 - more[k]) + one_more[k] * more[k];
                }
                coverage
            }
        }
    }

    /// How much of a pixel is covered where the texture lies so that the places are at `x` of it, and a copy is `length` long (head heights).
    ///
    /// A pixel covers a box of the picture, which is long and thin where the stroke is: it is looked up at several places along its longer side,
    /// in copies whose texels are as large as the shorter one.
    #[inline(always)]
    fn laid<const N: usize>(
        &self,
        at: &BrushPlaces<N>,
        x: &[f32; N],
        length: &[f32; N],
    ) -> [f32; N] {
        let [width, height] = self.mark.size();
        let (mut y, mut texels, mut parts) = ([0.0; N], [0.0; N], [0.0; N]);
        // Texels of the side of the picture along which the box is longer, and 1 for that one.
        let (mut side, mut is_longer) = ([0.0; N], [[0.0; N]; 2]);
        let mut lookups = 0.0;
        for k in 0..N {
            y[k] = 0.5 + 0.5 * self.side * at.v[k];
            // Texels of a pixel along the stroke and across it.
            let along = least(width / most(at.pixels[k] * length[k], TINY), width);
            let across = least(height / most(2.0 * at.radius_px[k], TINY), height);
            let longer = most(along, across);
            texels[k] = most(most(least(along, across), longer / MOST_LOOKUPS), 1.0);
            // Not a whole number, as the last lookup counts for its part of the box alone: their number changes without a jump.
            parts[k] = least(most(longer / texels[k], 1.0), MOST_LOOKUPS);
            lookups = most(parts[k], lookups);
            side[k] = choose(along > across, width, height);
            is_longer[0][k] = choose(along > across, 1.0, 0.0);
            is_longer[1][k] = 1.0 - is_longer[0][k];
        }
        let blurred = self.mark.blurred(&texels);
        let (mut sum, mut from) = ([0.0; N], 0.0);
        while from < lookups {
            let (mut part, mut place) = ([0.0; N], [*x, y]);
            for k in 0..N {
                // Nothing of what has had all its lookups.
                part[k] = most(least(parts[k] - from, 1.0), 0.0);
                let shift = (from + 0.5 * part[k] - 0.5 * parts[k]) * texels[k];
                place[0][k] += shift / side[k] * is_longer[0][k];
                place[1][k] += shift / side[k] * is_longer[1][k];
            }
            let coverage = blurred.at([&place[0], &place[1]]);
            for k in 0..N {
                sum[k] += part[k] * coverage[k];
            }
            from += 1.0;
        }
        for k in 0..N {
            sum[k] /= parts[k];
        }
        sum
    }
}
