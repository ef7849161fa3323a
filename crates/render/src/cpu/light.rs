//! The colours of a picture's samples as they were drawn, tile by tile, for lines that are drawn over them.

use super::DrawError;
use super::tile::{self, CELL_WIDTH, CELLS_ACROSS, Colors, LANES, STACK, Stack, Target, WIDTH};
use crate::drawing::Drawing;
use crate::edges::Bits;
use crate::features::Feature;
use crate::picture::Picture;
use crate::planes::{Sample, SamplePlanes};
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
#[derive(Clone)]
pub(super) struct TileLight {
    color: Colors,
    /// Whether there is anything in the tile; else `color` is anything.
    is_drawn: bool,
}

/// A band of a picture: its pixels and tiles.
pub(super) struct BandLight<'a> {
    pub(super) pixels: &'a mut [[f32; 4]],
    pub(super) tiles: &'a mut [TileLight],
}

/// Samples that get a colour: for each sample of a pixel rows of pixels, 64 in a word.
pub(super) struct Lines {
    pub(super) set: Vec<Vec<Bits>>,
    pub(super) color: [f32; 3],
}

impl TileLight {
    /// Keeps the light of a tile whose samples are summed up.
    pub(super) fn keep(&mut self, target: &Target) {
        target.copy_colors(&mut self.color);
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
        let room = self.tiles.try_reserve_exact(more);
        room.map_err(|_| DrawError::Memory(width, height))?;
        let nothing = TileLight {
            color: tile::no_colors(),
            is_drawn: false,
        };
        self.tiles.resize(tiles, nothing);
        Ok(())
    }

    /// The tiles of each band.
    pub(super) fn bands(&mut self) -> impl Iterator<Item = &mut [TileLight]> {
        self.tiles.chunks_mut(self.across)
    }

    /// Draws lines, one after the other, over a picture's samples, and puts the means of those pixels that they are on into the picture.
    pub(super) fn draw_lines(
        &self,
        lines: &[Lines],
        planes: &SamplePlanes,
        background: Option<[f32; 3]>,
        picture: &mut Picture,
    ) {
        let width = picture.width as usize;
        let samples = planes.samples().len();
        let empty = background.map(|light| light.map(|light| light.clamp(0.0, 1.0)));
        let rows = picture.pixels.par_chunks_mut(width).enumerate();
        rows.for_each(|(y, pixels)| {
            for (word, pixels) in pixels.chunks_mut(64).enumerate() {
                let sets = lines.iter().flat_map(|lines| &lines.set);
                let mut left = sets.fold(0, |all, rows| all | rows[y][word]);
                while left != 0 {
                    let bit = left.trailing_zeros() as usize;
                    left &= left - 1;
                    let Some(pixel) = pixels.get_mut(bit) else {
                        continue; // beyond the picture
                    };
                    let x = word * 64 + bit;
                    let mut sums = [0.0; 4];
                    for sample in 0..samples {
                        let line = lines
                            .iter()
                            .rev()
                            .find(|lines| lines.set[sample][y][word] >> bit & 1 != 0);
                        let [red, green, blue, alpha] = match line {
                            Some(Lines {
                                color: [red, green, blue],
                                ..
                            }) => [*red, *green, *blue, 1.0],
                            None => {
                                let [red, green, blue] =
                                    self.at(x, y, sample).or(empty).unwrap_or_default();
                                let objects = planes.ids(sample, Feature::Object, y);
                                let is_there =
                                    background.is_some() || objects[x] != Sample::NOTHING.object;
                                [red, green, blue, f32::from(u8::from(is_there))]
                            }
                        };
                        for (sum, value) in sums.iter_mut().zip([red, green, blue, alpha]) {
                            *sum += value;
                        }
                    }
                    *pixel = sums.map(|sum| sum / samples as f32);
                }
            }
        });
    }

    /// The colour of a pixel's sample, of that number; none where its tile is empty.
    fn at(&self, x: usize, y: usize, sample: usize) -> Option<[f32; 3]> {
        let (row, below) = (y / self.height, y % self.height);
        let tile = &self.tiles[row / tile::ROWS * self.across + x / WIDTH];
        let (row, column) = (row % tile::ROWS, x % WIDTH);
        let cell = row * CELLS_ACROSS + column / CELL_WIDTH;
        let lane = column % CELL_WIDTH * STACK + below * (STACK / self.height) + sample;
        let color = || tile.color.each_ref().map(|plane| plane[cell][lane % LANES]);
        tile.is_drawn.then(color)
    }
}
