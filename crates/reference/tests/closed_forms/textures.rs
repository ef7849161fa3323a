//! Pictures on surfaces, of which each texel's place is known.

use effects::Image;
use glam::{DVec2, Vec2};
use reference::picture_at;
use render::{Coverage, Drawing, Surface, SurfaceTexture, SurfaceVertex};
use std::sync::Arc;

/// Red, green / blue, white, in sRGB; the white one covers a quarter.
fn four() -> Arc<Image> {
    let full = 65535;
    let texels = [
        [full, 0, 0, full],
        [0, full, 0, full],
        [0, 0, full, full],
        [full, full, full, full / 4],
    ];
    Arc::new(Image::from_srgb([2, 2], texels.as_flattened()).unwrap())
}

/// A wall of 64 x 64 pixels whose right side is `nearer` times as near as its left, with the picture `repeated` times each way.
fn wall(coverage: Coverage, repeats: bool, repeated: f32, nearer: f32) -> Drawing {
    let corner = |x: f32, y: f32, inv_depth: f32| SurfaceVertex {
        position: Vec2::new(x, y),
        inv_depth,
        tone: 1.0,
    };
    let places = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    Drawing {
        size: [64, 64],
        surfaces: vec![Surface {
            vertices: vec![
                corner(0.0, 0.0, 1.0),
                corner(64.0, 0.0, nearer),
                corner(64.0, 64.0, nearer),
                corner(0.0, 64.0, 1.0),
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            light: [1.0, 0.5, 1.0],
            texture: Some(SurfaceTexture {
                image: four(),
                repeats,
                places: places.map(|place| repeated * Vec2::from(place)).to_vec(),
                coverage,
            }),
            ..Surface::default()
        }],
        ..Drawing::default()
    }
}

fn at(drawing: &Drawing, x: u32, y: u32) -> [f32; 4] {
    let picture = picture_at(drawing, &[DVec2::splat(0.5)]);
    picture.pixels[(y * 64 + x) as usize]
}

fn is_about(found: [f32; 4], expected: [f64; 4]) -> bool {
    let mut pairs = found.iter().zip(expected);
    // Texels are kept in half precision.
    pairs.all(|(found, expected)| (f64::from(*found) - expected).abs() < 1e-3)
}

#[test]
fn texels_lie_from_left_to_right_and_from_top_to_bottom() {
    let wall = wall(Coverage::Ignored, false, 1.0, 1.0);
    // Before the first middle and behind the last there is one texel alone.
    assert!(is_about(at(&wall, 3, 3), [1.0, 0.0, 0.0, 1.0]));
    assert!(is_about(at(&wall, 60, 3), [0.0, 0.5, 0.0, 1.0]));
    assert!(is_about(at(&wall, 3, 60), [0.0, 0.0, 1.0, 1.0]));
    assert!(is_about(at(&wall, 60, 60), [1.0, 0.5, 1.0, 1.0]));
    // Half way between the upper middles, in linear light; half a pixel beyond.
    let share = (32.5 / 64.0 - 0.25) / 0.5;
    assert!(is_about(
        at(&wall, 32, 3),
        [1.0 - share, 0.5 * share, 0.0, 1.0]
    ));
}

#[test]
fn coverage_weighs_colours_and_cuts() {
    let wall = wall(Coverage::Cut(0.5), false, 1.0, 1.0);
    assert_eq!(at(&wall, 60, 60), [0.0; 4]);
    // Green and white with a quarter of its weight: here each by its place.
    let share = (y_of(33) - 0.25) / 0.5;
    let alpha = 1.0 - share + share / 4.0;
    let white = share / 4.0 / alpha;
    let expected = [white, 0.5, white, 1.0];
    assert!(
        is_about(at(&wall, 60, 33), expected),
        "{:?}",
        at(&wall, 60, 33)
    );
}

fn y_of(row: u32) -> f64 {
    (f64::from(row) + 0.5) / 64.0
}

#[test]
fn pictures_repeat_or_go_on() {
    let again = wall(Coverage::Ignored, true, 2.0, 1.0);
    // The second copy: between its last texel and the first of the next, at their border.
    assert!(is_about(
        at(&again, 8, 8),
        at(&again, 40, 40).map(f64::from)
    ));
    let on = wall(Coverage::Ignored, false, 2.0, 1.0);
    assert!(is_about(at(&on, 50, 2), [0.0, 0.5, 0.0, 1.0]));
}

#[test]
fn places_run_linearly_in_the_world() {
    let wall = wall(Coverage::Ignored, false, 1.0, 3.0);
    for x in [5, 20, 40, 60] {
        let t = (f64::from(x) + 0.5) / 64.0;
        // Inverse depth runs from 1 to 3, place times inverse depth from 0 to 3.
        let place = 3.0 * t / (1.0 + 2.0 * t);
        let share = ((place - 0.25) / 0.5).clamp(0.0, 1.0);
        assert!(
            is_about(at(&wall, x, 2), [1.0 - share, 0.5 * share, 0.0, 1.0]),
            "{x}"
        );
    }
}
