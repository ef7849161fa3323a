//! Pictures of what changes most: the place before, after, and their difference, enlarged.

use super::search::{AROUND, Worst};
use super::tiles::TILE;
use crate::BenchError;
use render::Picture;
use std::path::Path;

/// Sides of a pixel.
const ENLARGED: usize = 8;
/// Pixels between the three parts, before they are enlarged.
const GAP: usize = 2;
/// Around the tile.
const FRAME: [f32; 4] = [1.0, 0.0, 0.0, 1.0];

/// Writes the place as a PNG.
///
/// # Errors
///
/// When the file can't be written.
pub fn write(path: &Path, worst: &Worst) -> Result<(), BenchError> {
    let failed =
        |error: &dyn std::fmt::Display| BenchError::from(format!("{}: {error}", path.display()));
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| failed(&error))?;
    }
    let picture = enlarged(&side_by_side(worst));
    let bytes = png(&picture).map_err(|error| failed(&error))?;
    std::fs::write(path, bytes).map_err(|error| failed(&error))
}

fn png(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&picture.to_srgb8())?;
    writer.finish()?;
    Ok(bytes)
}

/// Before, after, and how far each channel is apart; the tile in a frame.
fn side_by_side(worst: &Worst) -> Picture {
    let [before, after] = &worst.pictures;
    let pairs = before.pixels.iter().zip(&after.pixels);
    let apart = pairs.map(|(a, b)| [0, 1, 2].map(|c| (a[c] - b[c]).abs()));
    let apart = Picture {
        pixels: apart.map(|[r, g, b]| [r, g, b, 1.0]).collect(),
        ..*before
    };
    let side = before.width as usize;
    let width = 3 * side + 2 * GAP;
    let mut pixels = vec![[0.0; 4]; width * side];
    for (i, part) in [before, after, &apart].into_iter().enumerate() {
        for (y, row) in part.pixels.chunks(side).enumerate() {
            let start = y * width + i * (side + GAP);
            pixels[start..start + side].copy_from_slice(row);
        }
        let mut mark = |x: usize, y: usize| pixels[y * width + i * (side + GAP) + x] = FRAME;
        let (near, far) = (AROUND - 1, AROUND + TILE);
        for along in near..=far {
            mark(along, near);
            mark(along, far);
            mark(near, along);
            mark(far, along);
        }
    }
    Picture {
        width: width as u32,
        height: side as u32,
        pixels,
    }
}

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
