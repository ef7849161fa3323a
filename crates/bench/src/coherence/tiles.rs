//! How two pictures of an animation differ, tile by tile.

use render::Picture;

/// Pixels of a tile's side.
pub const TILE: usize = 16;

/// A pixel that changes by more has popped: of the full range, the channel that changes most.
pub const POP: f32 = 0.25;

/// Where the hair is in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct HairTiles {
    /// Tiles that hold hair, row by row.
    tiles: Vec<bool>,
    /// Pixels of hair.
    pixels: usize,
}

/// How two pictures differ where there is hair.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// For each tile that holds hair its number, row by row, and the mean absolute difference of red, green
    /// and blue over its pixels: linear light, 0 to 1.
    pub tiles: Vec<(usize, f64)>,
    /// Pixels that have popped, as a share of the hair's.
    pub popped: f64,
}

impl HairTiles {
    /// The tiles that hold a pixel of hair in either of two pictures; `masks` say of each pixel whether it does.
    /// Pixels are counted in the second.
    #[must_use]
    pub fn new(width: usize, masks: [&[bool]; 2]) -> Self {
        let columns = width.div_ceil(TILE);
        let rows = (masks[0].len() / width.max(1)).div_ceil(TILE);
        let mut tiles = vec![false; columns * rows];
        for mask in masks {
            for (i, _) in mask.iter().enumerate().filter(|(_, is_hair)| **is_hair) {
                tiles[tile_of(i, width)] = true;
            }
        }
        let pixels = masks[1].iter().filter(|is_hair| **is_hair).count();
        Self { tiles, pixels }
    }

    /// How `after` differs from `before`, two pictures of the size that the masks had.
    #[must_use]
    pub fn change(&self, before: &Picture, after: &Picture) -> Change {
        let width = before.width as usize;
        let mut sums = vec![(0_u32, 0.0_f64); self.tiles.len()];
        let mut popped = 0;
        for (i, (a, b)) in before.pixels.iter().zip(&after.pixels).enumerate() {
            let tile = tile_of(i, width);
            if !self.tiles[tile] {
                continue;
            }
            let channels: [f32; 3] = std::array::from_fn(|c| (a[c] - b[c]).abs());
            sums[tile].0 += 1;
            sums[tile].1 += f64::from(channels[0] + channels[1] + channels[2]);
            popped += usize::from(channels.iter().any(|channel| *channel > POP));
        }
        let hair = (0..self.tiles.len()).filter(|tile| self.tiles[*tile]);
        Change {
            tiles: hair
                .map(|tile| (tile, sums[tile].1 / (3.0 * f64::from(sums[tile].0))))
                .collect(),
            popped: popped as f64 / self.pixels.max(1) as f64,
        }
    }
}

/// The mean absolute difference of red, green and blue over a tile that lies `around` pixels from the upper left
/// corner of two pictures: linear light, 0 to 1. `size`: the tile's columns and rows.
#[must_use]
pub fn difference(before: &Picture, after: &Picture, around: usize, size: [usize; 2]) -> f64 {
    let [columns, rows] = size;
    let mut sum = 0.0;
    for y in around..around + rows {
        for x in around..around + columns {
            let i = y * before.width as usize + x;
            let (a, b) = (before.pixels[i], after.pixels[i]);
            sum += (0..3).map(|c| f64::from((a[c] - b[c]).abs())).sum::<f64>();
        }
    }
    sum / (3 * columns * rows) as f64
}

fn tile_of(pixel: usize, width: usize) -> usize {
    let (x, y) = (pixel % width, pixel / width);
    (y / TILE) * width.div_ceil(TILE) + x / TILE
}

/// Column and row of a tile's upper left pixel.
#[must_use]
pub fn corner(tile: usize, width: usize) -> [usize; 2] {
    let columns = width.div_ceil(TILE);
    [tile % columns * TILE, tile / columns * TILE]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 40 x 20 pixels: three tiles a row, two rows, the last ones smaller.
    fn picture(color: impl Fn(usize, usize) -> [f32; 3]) -> Picture {
        let pixels = (0..800).map(|i| {
            let [r, g, b] = color(i % 40, i / 40);
            [r, g, b, 1.0]
        });
        Picture {
            width: 40,
            height: 20,
            pixels: pixels.collect(),
        }
    }

    fn hair(is_hair: impl Fn(usize, usize) -> bool) -> Vec<bool> {
        (0..800).map(|i| is_hair(i % 40, i / 40)).collect()
    }

    #[test]
    fn differences_are_means_of_tiles_with_hair() {
        let black = picture(|_, _| [0.0; 3]);
        // A pixel of the first tile, four of the smaller last one, one where no hair is.
        let other = picture(|x, y| match (x, y) {
            (3, 3) => [1.0, 0.2, 0.0],
            (36..40, 19) => [0.25, 0.0, 0.0],
            (20, 3) => [1.0; 3],
            _ => [0.0; 3],
        });
        let one = hair(|x, y| (x, y) == (0, 15));
        let two = hair(|x, y| y == 17 && x > 35);
        let tiles = HairTiles::new(40, [&one, &two]);
        let change = tiles.change(&black, &other);
        let expected = [(0, 1.2 / 768.0), (5, 1.0 / (3.0 * 32.0))];
        assert_eq!(change.tiles.len(), 2);
        for (found, expected) in change.tiles.iter().zip(expected) {
            assert_eq!(found.0, expected.0);
            assert!((found.1 - expected.1).abs() < 1e-9, "{found:?}");
        }
        assert!((difference(&black, &other, 0, [16, 16]) - 1.2 / 768.0).abs() < 1e-9);
        assert!((difference(&black, &other, 3, [1, 2]) - 0.2).abs() < 1e-7);
        // One pixel by more than a quarter; the hair has four in the second picture.
        assert_eq!(change.popped, 0.25);
        assert_eq!(corner(5, 40), [32, 16]);
    }

    #[test]
    fn equal_pictures_do_not_change() {
        let gray = picture(|x, y| [x as f32 / 40.0, y as f32 / 20.0, 0.5]);
        let all = vec![true; 800];
        let change = HairTiles::new(40, [&all, &all]).change(&gray, &gray);
        assert_eq!(change.tiles.len(), 6);
        assert!(change.tiles.iter().all(|tile| tile.1 == 0.0));
        assert_eq!(change.popped, 0.0);
        let none = vec![false; 800];
        let change = HairTiles::new(40, [&none, &none]).change(&gray, &gray);
        assert_eq!((change.tiles.len(), change.popped), (0, 0.0));
    }
}
