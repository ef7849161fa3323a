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

/// Pictures are looked up when all is drawn: nothing that is drawn over one takes its colours.
#[test]
fn of_pictures_surfaces_and_hair_the_nearest_shows() {
    let plain = |rgb: [u16; 3]| {
        let [r, g, b] = rgb.map(|on| on * 65535);
        two_texels([r, g, b, 65535], [r, g, b, 65535])
    };
    let at = |image, coverage, inv_depth: f32| {
        let mut surface = textured(image, coverage);
        (surface.light, surface.shadow) = ([1.0; 3], [1.0; 3]);
        for vertex in &mut surface.vertices {
            vertex.inv_depth = inv_depth;
        }
        surface
    };
    // To the left and above of pixels' edges, on which samples may lie.
    let mut near = at(plain([1, 0, 1]), Coverage::Ignored, 2.0);
    for vertex in &mut near.vertices {
        vertex.position *= Vec2::new(0.499, 0.749);
    }
    let mut flat = square(1.5);
    (flat.light, flat.shadow) = (BLUE, BLUE);
    for vertex in &mut flat.vertices {
        vertex.position.y *= 0.499;
    }
    let cut = at(two_texels(CLEAR, WHITE), Coverage::Cut(0.5), 1.2);
    let far = at(plain([0, 1, 0]), Coverage::Ignored, 1.0);
    let expected = |x: usize, y: usize| match (x < 10, y < 10, y < 15) {
        (true, _, true) => [1.0, 0.0, 1.0],
        (true, _, false) => [0.0, 1.0, 0.0],
        (false, true, _) => BLUE,
        (false, false, _) => [1.0; 3],
    };
    let hair_color = [0.25, 0.5, 0.75];
    let center = Vec2::new(10.0, 10.0);
    let discs = [disc(10.0, 9.0, 4.0, 3.0), disc(10.0, 11.0, 4.0, 3.0)];
    let mut surfaces = vec![near, flat, cut, far];
    for _ in 0..2 {
        for _ in 0..4 {
            surfaces.rotate_left(1);
            let mut drawing = strands([20, 20], &[(0, hair_color, &discs)]);
            drawing.surfaces = surfaces.clone();
            for samples in [1, 2, 4, 16] {
                let picture = draw(&drawing, samples);
                for (i, pixel) in picture.pixels.iter().enumerate() {
                    let (x, y) = (i % 20, i / 20);
                    let middle = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                    let color = match middle.distance(center) {
                        inside if inside < 3.0 => hair_color,
                        outside if outside > 6.0 => expected(x, y),
                        _ => continue,
                    };
                    assert_eq!(*pixel, opaque(color), "pixel {i}, {samples} samples");
                }
            }
        }
        surfaces.reverse();
    }
}
