//! The pictures on the triangles of a tile. Those that cover all of their triangles are looked up once everything is drawn: what is hidden, by hair or
//! by other triangles, costs nothing.

use super::set_up::SetUp;
use super::tile::{
    Cell, IdPlane, LANES, LaneMask, NOTHING, Stack, StoreMask, Target, any, greater, lesser,
    number, select,
};
use crate::drawing::{Coverage, SurfaceTexture, scatter};
use effects::Blurred;
use std::hint::black_box;

/// Across and down the picture, inverse depth, and a fourth number without meaning: a vector.
type Place = [f32; 4];

/// A picture as a triangle shows it.
pub(super) struct Texels<'a> {
    texture: &'a SurfaceTexture,
    /// Places times inverse depth, which run linearly on the screen, and inverse depth: as [`Slope`](super::tile::Slope) has them.
    corner: Place,
    per_x: Place,
    per_y: Place,
    /// The least and the greatest of the corners: the middle of some samples may lie outside of the triangle.
    least: Place,
    greatest: Place,
    /// Blurred over what a pixel covers of it, in the mean over the triangle.
    image: Blurred<'a>,
}

impl<'a> Texels<'a> {
    /// That of a triangle which is set up.
    #[inline(always)]
    pub(super) fn new(texture: &'a SurfaceTexture, (set_up, own): (&SetUp, usize)) -> Self {
        // Texels are square, the picture need not be.
        let [width, height] = texture.image.size().map(|side| side as f32);
        let twice_area = set_up.twice_area_of_picture(own).abs() * (height / width);
        let twice_area_px = set_up.twice_area[own].abs() as f32;
        let [(across, across_ends), (down, down_ends)] = set_up.places(own);
        let depths = set_up.depths(own);
        let depth = depths.slope;
        Self {
            texture,
            corner: [across.corner, down.corner, depth.corner, 0.0],
            per_x: [across.per_x, down.per_x, depth.per_x, 0.0],
            per_y: [across.per_y, down.per_y, depth.per_y, 0.0],
            least: [across_ends[0], down_ends[0], depths.least, 0.0],
            greatest: [across_ends[1], down_ends[1], depths.greatest, 0.0],
            image: texture.image.blurred((twice_area / twice_area_px).sqrt()),
        }
    }

    /// Colour and coverage in the middle of the samples of a cell that look pictures up together with a lane, and no farther than the triangle's corners.
    #[inline(always)]
    fn at(&self, cell: Cell, stack: &Stack, lane: usize) -> [f32; 4] {
        let [x, y] = [stack.middle[0][lane], stack.middle[1][lane]];
        let (column, row) = (number(cell.column), number(cell.row));
        let height = number(stack.height);
        let mut place = self.corner;
        for i in 0..4 {
            place[i] += x * self.per_x[i] + y * self.per_y[i];
            place[i] += column * self.per_x[i] + row * (self.per_y[i] * height);
        }
        // By way of memory: compilers would work out two numbers at once, and then another, in place of all.
        let mut place = black_box(place);
        let depth_m = 1.0 / lesser(greater(place[2], self.least[2]), self.greatest[2]);
        for i in 0..4 {
            place[i] = lesser(greater(place[i] * depth_m, self.least[i]), self.greatest[i]);
        }
        let [across, down, ..] = place;
        self.image.at([across, down], self.texture.repeats)
    }

    /// The picture's colours at some samples of a cell; takes those away that it leaves free, of the surface of that number.
    #[inline(always)]
    pub(super) fn cut(
        &self,
        cell: Cell,
        stack: &Stack,
        surface: u32,
        samples: &mut LaneMask,
    ) -> [[f32; LANES]; 3] {
        let mut colors = [[0.0; LANES]; 3];
        let (of_pixel, together) = (stack.of_pixel, stack.together());
        for first in (0..LANES).step_by(together) {
            let lanes = first..first + together;
            if samples[lanes.clone()].iter().all(|sample| *sample == 0) {
                continue;
            }
            let [red, green, blue, coverage] = self.at(cell, stack, first);
            for k in lanes {
                let is_there = match self.texture.coverage {
                    Coverage::Ignored => true,
                    Coverage::Cut(share) => coverage >= share,
                    Coverage::Share if of_pixel == 1 => coverage > 0.5,
                    Coverage::Share => {
                        coverage > scatter(surface, (stack.first + k % of_pixel) as u32)
                    }
                };
                samples[k] &= select(is_there, u32::MAX, 0);
                for (color, texel) in colors.iter_mut().zip([red, green, blue]) {
                    color[k] = texel;
                }
            }
        }
        colors
    }
}

/// What of the samples of a tile shows which picture.
pub(super) struct Pictures<'a, 'b> {
    /// Of each sample the number of its triangle in `texels`, counted from 1; 0 where it shows no picture. Anything while there are none.
    numbers: &'b mut IdPlane,
    texels: Vec<Texels<'a>>,
}

impl<'a, 'b> Pictures<'a, 'b> {
    /// None yet. `numbers` is working memory.
    #[inline(always)]
    pub(super) fn new(numbers: &'b mut IdPlane) -> Self {
        Self {
            numbers,
            texels: Vec::new(),
        }
    }

    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.texels.is_empty()
    }

    /// Adds a triangle's, and gives its number.
    #[inline(always)]
    pub(super) fn push(&mut self, texels: Texels<'a>) -> u32 {
        if self.is_empty() {
            self.numbers.fill([0; LANES]);
        }
        self.texels.push(texels);
        self.texels.len() as u32
    }

    /// Some samples of a cell show the picture of that number.
    #[inline(always)]
    pub(super) fn put(&mut self, cell: usize, number: u32, samples: &StoreMask) {
        samples.store_ids(&[number; LANES], &mut self.numbers[cell]);
    }

    /// Looks up those that show, which till then have the colour that their triangles have.
    #[inline(always)]
    pub(super) fn look_up(&self, stack: &Stack, target: &mut Target) {
        if self.is_empty() {
            return;
        }
        let pixels = pixels(stack.together());
        for (index, numbers) in self.numbers.iter().enumerate() {
            let strand = &target.strand[index];
            let mut left = [0; LANES];
            for k in 0..LANES {
                left[k] = select(strand[k] == NOTHING, numbers[k], 0);
            }
            if !any(&left) {
                continue;
            }
            let cell = Cell::of_index(index);
            for lane in 0..LANES {
                let number = left[lane];
                if number == 0 {
                    continue;
                }
                let mut own = pixels[lane];
                for k in 0..LANES {
                    own[k] &= select(left[k] == number, u32::MAX, 0);
                }
                for k in 0..LANES {
                    left[k] &= !own[k];
                }
                let texel = self.texels[number as usize - 1].at(cell, stack, lane);
                for (channel, plane) in target.color.iter_mut().enumerate() {
                    let mut color = plane[index];
                    for k in 0..LANES {
                        let shown = color[k] * texel[channel];
                        color[k] = select(own[k] != 0, shown, color[k]);
                    }
                    plane[index] = color;
                }
            }
        }
    }
}

/// For each lane those that look pictures up together with it, a power of 2.
#[inline(always)]
fn pixels(together: usize) -> [LaneMask; LANES] {
    let mut pixels = [[0; LANES]; LANES];
    for (lane, pixel) in pixels.iter_mut().enumerate() {
        for k in 0..LANES {
            pixel[k] = select(k ^ lane < together, u32::MAX, 0);
        }
    }
    pixels
}
