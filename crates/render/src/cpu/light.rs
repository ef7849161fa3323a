//! The colours of a picture's samples as they were drawn, tile by tile, for lines that are drawn over them.

use super::DrawError;
use super::tile::{
    self, CELL_WIDTH, CELLS, CELLS_ACROSS, LANES, Lanes, Plane, STACK, Shows, Stack, Target, WIDTH,
};
use crate::drawing::Drawing;
use crate::edges::Covered;
use crate::picture::Picture;
use rayon::prelude::*;

/// The light of all samples of a picture.
#[derive(Default)]
pub(super) struct Light {
    tiles: Vec<TileLight>,
    /// Tiles of a band.
    across: usize,
    /// Pixels of a stack.
    height: usize,
}

/// That of a tile's samples.
#[derive(Default)]
pub(super) struct TileLight {
    /// None where nothing has been drawn yet.
    color: Option<[Plane; 3]>,
    /// The samples of each cell that show something, where a picture has no background.
    shows: Shows,
    /// Whether there is anything in the tile; else `color` is anything.
    is_drawn: bool,
}

/// Samples that get a colour: the pixels of each.
pub(super) struct Lines {
    pub(super) set: Vec<Covered>,
    pub(super) color: [f32; 3],
}

impl TileLight {
    /// Keeps the light of a tile whose samples are summed up; the target goes on with planes that were kept before, whatever they have.
    pub(super) fn keep(&mut self, target: &mut Target, is_opaque: bool) {
        let spare = self.color.take();
        let spare = spare.unwrap_or_else(|| [tile::plane(), tile::plane(), tile::plane()]);
        self.color = Some(std::mem::replace(&mut target.color, spare));
        if !is_opaque {
            target.copy_shows(&mut self.shows);
        }
        self.is_drawn = true;
    }
}

impl Light {
    /// Makes room for a picture's, and forgets what was there.
    pub(super) fn make_room(&mut self, drawing: &Drawing, stack: &Stack) -> Result<(), DrawError> {
        let [width, height] = drawing.size;
        self.height = stack.height;
        self.across = (width as usize).div_ceil(WIDTH);
        let bands = (height as usize).div_ceil(tile::ROWS * stack.height);
        let tiles = self.across * bands;
        self.tiles.truncate(tiles);
        self.tiles.iter_mut().for_each(|tile| tile.is_drawn = false);
        let more = tiles - self.tiles.len();
        let room = self.tiles.try_reserve_exact(more).and_then(|()| {
            // Planes are made as tiles are drawn; but nobody is to draw half of a picture that has no room.
            Vec::<[Lanes; CELLS]>::new().try_reserve_exact(3 * more)
        });
        room.map_err(|_| DrawError::Memory(width, height))?;
        self.tiles.resize_with(tiles, TileLight::default);
        Ok(())
    }

    /// The tiles of each band.
    pub(super) fn bands(&mut self) -> impl IndexedParallelIterator<Item = &mut [TileLight]> {
        self.tiles.par_chunks_mut(self.across)
    }

    /// Draws lines, one after the other, over a picture's samples, so many a pixel, and puts the means of those pixels that they are on into the picture.
    pub(super) fn draw_lines(
        &self,
        lines: &[Lines],
        samples: usize,
        background: Option<[f32; 3]>,
        picture: &mut Picture,
    ) {
        let width = picture.width as usize;
        let rows = picture.pixels.par_chunks_mut(width).enumerate();
        let colors = lines.iter().map(|lines| {
            let [red, green, blue] = lines.color;
            mean((0..samples).map(|_| [red, green, blue, 1.0]), samples)
        });
        let colors: Vec<[f32; 4]> = colors.collect();
        rows.for_each(|(y, pixels)| {
            for (word, pixels) in pixels.chunks_mut(64).enumerate() {
                // Pixels whose samples have to be mixed: where a line covers all of them, as most of a wide one do, its colour is put in at once.
                let mut left = 0;
                for (lines, color) in lines.iter().zip(&colors) {
                    let (mut some, mut all) = (0, u64::MAX);
                    for covered in &lines.set {
                        let own = covered.row(y)[word];
                        (some, all) = (some | own, all & own);
                    }
                    left = (left | some) & !all;
                    for bit in ones(all) {
                        if let Some(pixel) = pixels.get_mut(bit) {
                            *pixel = *color;
                        }
                    }
                }
                for bit in ones(left) {
                    let Some(pixel) = pixels.get_mut(bit) else {
                        continue; // beyond the picture
                    };
                    let drawn = self.pixel(word * 64 + bit, y, background);
                    let values = (0..samples).map(|sample| {
                        let is_on = |lines: &&Lines| lines.set[sample].row(y)[word] >> bit & 1 != 0;
                        match lines.iter().rev().find(is_on) {
                            Some(Lines {
                                color: [red, green, blue],
                                ..
                            }) => [*red, *green, *blue, 1.0],
                            None => drawn.sample(sample),
                        }
                    });
                    *pixel = mean(values, samples);
                }
            }
        });
    }

    /// What is drawn in a pixel.
    fn pixel(&self, x: usize, y: usize, background: Option<[f32; 3]>) -> DrawnPixel<'_> {
        let (row, below) = (y / self.height, y % self.height);
        let tile = &self.tiles[row / tile::ROWS * self.across + x / WIDTH];
        let (row, column) = (row % tile::ROWS, x % WIDTH);
        DrawnPixel {
            color: tile.color.as_ref().filter(|_| tile.is_drawn),
            shows: &tile.shows,
            cell: row * CELLS_ACROSS + column / CELL_WIDTH,
            first_lane: column % CELL_WIDTH * STACK + below * (STACK / self.height),
            background,
        }
    }
}

/// The places of a word's bits that are set.
fn ones(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros() as usize;
        word &= word.wrapping_sub(1);
        (bit < 64).then_some(bit)
    })
}

/// The mean of so many samples, added up in their order.
fn mean(values: impl Iterator<Item = [f32; 4]>, samples: usize) -> [f32; 4] {
    let mut sums = [0.0; 4];
    for value in values {
        for (sum, value) in sums.iter_mut().zip(value) {
            *sum += value;
        }
    }
    sums.map(|sum| sum / samples as f32)
}

/// The samples of a pixel as they were drawn.
struct DrawnPixel<'a> {
    /// Those of its tile; none where there is nothing.
    color: Option<&'a [Plane; 3]>,
    shows: &'a Shows,
    cell: usize,
    first_lane: usize,
    background: Option<[f32; 3]>,
}

impl DrawnPixel<'_> {
    /// The light of a sample, and its alpha.
    fn sample(&self, sample: usize) -> [f32; 4] {
        match self.color {
            Some(planes) => {
                let lane = (self.first_lane + sample) % LANES;
                let [red, green, blue] = planes.each_ref().map(|plane| plane[self.cell][lane]);
                let is_there = self.background.is_some() || self.shows.has(self.cell, lane);
                [red, green, blue, f32::from(u8::from(is_there))]
            }
            None => match self.background {
                Some(light) => {
                    let [red, green, blue] = light.map(|light| light.clamp(0.0, 1.0));
                    [red, green, blue, 1.0]
                }
                None => [0.0; 4],
            },
        }
    }
}
