//! Lists of strokes' discs, and blocks of them, which vector instructions work out.

use crate::joints::LANES;
use crate::wgsl::{Stroke, Vec2, Vec3, vec2, vec3};

/// A stroke's discs at joints: one list for each field of [`Stroke`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strokes {
    /// Shifts of the discs' centres on the screen, 1/300 of the head's height.
    pub offset: Vec<Vec2<f32>>,
    /// Radii, 1/300 of the head's height.
    pub radius: Vec<f32>,
    /// What is added to the layer's own depth offset, head heights.
    pub depth_offset: Vec<f32>,
    /// Linear colours.
    pub color: Vec<Vec3<f32>>,
}

impl Strokes {
    /// How many discs there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.radius.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.radius.is_empty()
    }

    /// Empties all lists, and keeps their memory.
    pub fn clear(&mut self) {
        self.resize(0);
    }

    /// Gives the lists a length: what is added has no size.
    pub fn resize(&mut self, count: usize) {
        self.offset.resize(count, vec2([0.0; 2]));
        self.radius.resize(count, 0.0);
        self.depth_offset.resize(count, 0.0);
        self.color.resize(count, vec3([0.0; 3]));
    }

    /// All of them.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = Stroke> {
        (0..self.len()).map(|index| Stroke {
            offset: self.offset[index],
            radius: self.radius[index],
            depth_offset: self.depth_offset[index],
            color: self.color[index],
        })
    }
}

/// Lists of what is taken of strokes: no more is worked out.
pub(crate) trait Taken {
    /// What is taken of [`LANES`] strokes.
    type Block;
    /// All 0.
    const NOTHING: Self::Block;
    /// Sets what is taken of one.
    fn put(block: &mut Self::Block, lane: usize, stroke: Stroke);
    /// Appends that of the first `count` ones.
    fn append(&mut self, block: &Self::Block, count: usize);
}

/// Radii alone.
impl Taken for Vec<f32> {
    type Block = [f32; LANES];
    const NOTHING: Self::Block = [0.0; LANES];

    #[inline(always)] // into loops that are compiled for other instructions than their crate
    fn put(block: &mut Self::Block, lane: usize, stroke: Stroke) {
        block[lane] = stroke.radius;
    }

    fn append(&mut self, block: &Self::Block, count: usize) {
        self.extend_from_slice(&block[..count]);
    }
}

/// The numbers of [`LANES`] discs: each has a row, so that vector instructions store them.
impl Taken for Strokes {
    type Block = [[f32; LANES]; 7];
    const NOTHING: Self::Block = [[0.0; LANES]; 7];

    #[inline(always)]
    fn put(block: &mut Self::Block, lane: usize, stroke: Stroke) {
        block[0][lane] = stroke.offset.x;
        block[1][lane] = stroke.offset.y;
        block[2][lane] = stroke.radius;
        block[3][lane] = stroke.depth_offset;
        block[4][lane] = stroke.color.x;
        block[5][lane] = stroke.color.y;
        block[6][lane] = stroke.color.z;
    }

    fn append(&mut self, block: &Self::Block, count: usize) {
        let [x, y, radius, depth_offset, red, green, blue] = block;
        let lanes = 0..count;
        self.offset
            .extend(lanes.clone().map(|lane| vec2([x[lane], y[lane]])));
        self.radius.extend_from_slice(&radius[..count]);
        self.depth_offset.extend_from_slice(&depth_offset[..count]);
        self.color
            .extend(lanes.map(|lane| vec3([red[lane], green[lane], blue[lane]])));
    }
}
