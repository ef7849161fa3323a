//! Pictures of what changes most: the place before, after, and their difference, enlarged.

use super::search::Worst;
use super::tiles::{TILE, corner};
use render::Picture;
use std::path::Path;

/// Pixels around the tile that are shown too.
const AROUND: usize = 2 * TILE;
/// Sides of a pixel.
const ENLARGED: usize = 6;
/// Pixels between the three parts, before they are enlarged.
const GAP: usize = 2;

/// Writes the place as a PNG.
///
/// # Errors
///
/// When the file can't be written.
pub fn write(path: &Path, worst: &Worst) -> Result<(), String> {
    let picture = enlarged(&side_by_side(worst));
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| failed(&error))?;
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header().map_err(|error| failed(&error))?;
    let written = writer.write_image_data(&picture.to_srgb8());
    written.map_err(|error| failed(&error))?;
    writer.finish().map_err(|error| failed(&error))?;
    std::fs::write(path, bytes).map_err(|error| failed(&error))
}

/// Before, after, and how far each channel is apart; the tile in a frame.
fn side_by_side(worst: &Worst) -> Picture {
    let [before, after] = &worst.pictures;
    let [left, top] = corner(worst.tile, before.width as usize);
    let side = TILE + 2 * AROUND;
    let width = 3 * side + 2 * GAP;
    let mut pixels = vec![[0.0; 4]; width * side];
    for y in 0..side {
        for x in 0..side {
            let at = [x + left, y + top].map(|place| place.checked_sub(AROUND));
            let [Some(from_left), Some(from_top)] = at else {
                continue;
            };
            if from_left >= before.width as usize || from_top >= before.height as usize {
                continue;
            }
            let i = from_top * before.width as usize + from_left;
            let (a, b) = (before.pixels[i], after.pixels[i]);
            let mut apart: [f32; 4] = std::array::from_fn(|c| (a[c] - b[c]).abs());
            apart[3] = 1.0;
            for (part, color) in [a, b, apart].into_iter().enumerate() {
                pixels[y * width + part * (side + GAP) + x] = color;
            }
        }
    }
    for part in 0..3 {
        let start = part * (side + GAP) + AROUND - 1;
        for i in 0..TILE + 2 {
            let (near, far) = (AROUND - 1, AROUND + TILE);
            for (x, y) in [(i, near), (i, far)] {
                pixels[y * width + start + x] = FRAME;
            }
            for x in [0, TILE + 1] {
                pixels[(near + i) * width + start + x] = FRAME;
            }
        }
    }
    Picture {
        width: width as u32,
        height: side as u32,
        pixels,
    }
}

const FRAME: [f32; 4] = [1.0, 0.0, 0.0, 1.0];

fn enlarged(picture: &Picture) -> Picture {
    let [width, height] = [picture.width, picture.height].map(|side| side as usize);
    let pixels = (0..width * height * ENLARGED * ENLARGED).map(|i| {
        let (x, y) = (i % (width * ENLARGED), i / (width * ENLARGED));
        picture.pixels[y / ENLARGED * width + x / ENLARGED]
    });
    Picture {
        width: (width * ENLARGED) as u32,
        height: (height * ENLARGED) as u32,
        pixels: pixels.collect(),
    }
}
