//! Pictures on surfaces.

use super::*;
use crate::check::MAX_PLACE;
use crate::drawing::{Coverage, SurfaceTexture};
use effects::Image;
use std::sync::Arc;

const WHITE: [u16; 4] = [65535; 4];
const CLEAR: [u16; 4] = [0; 4];

/// A picture of two texels beside each other.
pub(super) fn two_texels(left: [u16; 4], right: [u16; 4]) -> Arc<Image> {
    Arc::new(Image::from_srgb([2, 1], [left, right].as_flattened()).unwrap())
}

/// Stripes of black and white from left to right.
fn stripes() -> Arc<Image> {
    let black = [0, 0, 0, 65535];
    let texels: Vec<_> = (0..8).map(|i| [WHITE, black][i % 2]).collect();
    Arc::new(Image::from_srgb([8, 1], texels.as_flattened()).unwrap())
}

/// The square of two triangles, wholly lit, with a picture on all of it.
fn textured(image: Arc<Image>, coverage: Coverage) -> Surface {
    let mut surface = square(1.0);
    for vertex in &mut surface.vertices {
        vertex.tone = 1.0;
    }
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    surface.texture = Some(SurfaceTexture {
        image,
        repeats: false,
        places: corners.map(Vec2::from).to_vec(),
        coverage,
    });
    surface
}

fn error(drawing: &Drawing) -> DrawError {
    Rasterizer::new(1, Some(1))
        .unwrap()
        .draw(drawing)
        .unwrap_err()
}

fn drawing(surfaces: Vec<Surface>) -> Drawing {
    Drawing {
        size: [20, 20],
        surfaces,
        ..Drawing::default()
    }
}

#[test]
fn a_picture_is_multiplied_by_both_tones() {
    let mut surface = textured(stripes(), Coverage::Ignored);
    for (vertex, tone) in surface.vertices.iter_mut().zip([1.0, 1.0, -1.0, -1.0]) {
        vertex.tone = tone;
    }
    surface.light = [1.0, 0.5, 0.0];
    surface.shadow = [0.25, 0.25, 1.0];
    let image = stripes();
    let picture = draw(&drawing(vec![surface.clone()]), 1);
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let [x, y] = [i % 20, i / 20].map(|side| (side as f32 + 0.5) / 20.0);
        let [light, ..] = image.at([x, y], 1.0 / 20.0, false);
        let tone = if y <= 0.5 {
            surface.light
        } else {
            surface.shadow
        };
        for (channel, tone) in pixel.iter().zip(tone) {
            assert!(
                (channel - light * tone).abs() < 2e-4,
                "{i}: {pixel:?} {light}"
            );
        }
        assert_eq!(pixel[3], 1.0);
    }
}

/// As far away on the right as it is wide: half of the picture lies before a third of the screen.
#[test]
fn places_run_linearly_in_the_world() {
    let mut surface = textured(two_texels([0, 0, 0, 65535], WHITE), Coverage::Ignored);
    surface.light = [1.0; 3];
    for (vertex, inv_depth) in surface.vertices.iter_mut().zip([1.0, 0.5, 0.5, 1.0]) {
        vertex.inv_depth = inv_depth;
    }
    let texture = surface.texture.clone().unwrap();
    let picture = draw(&drawing(vec![surface]), 1);
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let [x, y] = [i % 20, i / 20].map(|side| (side as f64 + 0.5) / 20.0);
        let inv_depth = 1.0 - 0.5 * x;
        let place = [0.5 * x / inv_depth, y].map(|place| place as f32);
        let [light, ..] = texture.image.at(place, 0.0, false);
        assert!((pixel[0] - light).abs() < 2e-3, "{i}: {} {light}", pixel[0]);
    }
}

#[test]
fn where_a_picture_is_cut_something_else_shows() {
    let mut behind = square(0.5);
    behind.light = BLUE;
    let cut = textured(two_texels(CLEAR, WHITE), Coverage::Cut(0.5));
    for surfaces in [vec![behind.clone(), cut.clone()], vec![cut, behind]] {
        for samples in [1, 2, 4, 16] {
            let picture = draw(&drawing(surfaces.clone()), samples);
            for (i, pixel) in picture.pixels.iter().enumerate() {
                let expected = if i % 20 < 10 { BLUE } else { GREEN };
                assert_eq!(*pixel, opaque(expected), "pixel {i}, {samples} samples");
            }
        }
    }
}

#[test]
fn coverage_is_the_share_of_the_samples() {
    for (alpha, share) in [
        (0, 0.0),
        (16384, 0.25),
        (32768, 0.5),
        (49152, 0.75),
        (65535, 1.0),
    ] {
        let texel = [65535, 65535, 65535, alpha];
        let surface = textured(two_texels(texel, texel), Coverage::Share);
        let picture = draw(&drawing(vec![surface]), 16);
        for pixel in &picture.pixels {
            assert!(
                (pixel[3] - share).abs() <= 1.0 / 16.0,
                "{alpha}: {}",
                pixel[3]
            );
        }
    }
    // With one sample there is half of nothing.
    let thin = textured(
        two_texels([65535, 0, 0, 30000], [65535, 0, 0, 30000]),
        Coverage::Share,
    );
    let picture = draw(&drawing(vec![thin]), 1);
    assert_eq!(picture.pixels[0], NONE);
}

#[test]
fn what_no_texture_can_be_is_told() {
    let after = |change: fn(&mut SurfaceTexture)| {
        let mut surface = textured(stripes(), Coverage::Ignored);
        change(surface.texture.as_mut().unwrap());
        error(&drawing(vec![surface]))
    };
    assert_eq!(
        after(|texture| texture.places.truncate(3)),
        DrawError::TexturePlaces {
            surface: 0,
            found: 3,
            vertices: 4
        }
    );
    for bad in [f32::NAN, f32::INFINITY, -2.0 * MAX_PLACE] {
        let mut surface = textured(stripes(), Coverage::Ignored);
        surface.texture.as_mut().unwrap().places[2].y = bad;
        let expected = DrawError::TexturePlace {
            surface: 0,
            vertex: 2,
        };
        assert_eq!(error(&drawing(vec![surface])), expected);
    }
    assert_eq!(
        after(|texture| texture.coverage = Coverage::Cut(1.5)),
        DrawError::Cut {
            surface: 0,
            share: 1.5
        }
    );
}
