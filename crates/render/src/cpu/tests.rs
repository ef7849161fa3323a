//! Pictures as a whole: areas, depths, surfaces, threads, errors.

mod hostile;
mod order;
mod reference;
mod texture;

use super::*;
use crate::drawing::{
    Brush, Disc, LayerStrokes, Order, Run, Stretch, Stretches, Surface, SurfaceVertex,
};
use glam::Vec2;
use std::f64::consts::PI;

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];
const NONE: [f32; 4] = [0.0; 4];

fn disc(x: f32, y: f32, radius: f32, inv_depth: f32) -> Disc {
    Disc {
        center: Vec2::new(x, y),
        radius,
        inv_depth,
        inv_depth_biased: inv_depth,
    }
}

fn opaque([red, green, blue]: [f32; 3]) -> [f32; 4] {
    [red, green, blue, 1.0]
}

/// A layer of one instance in one colour.
fn layer(name: &str, rank: i32, color: [f32; 3], discs: &[Disc]) -> LayerStrokes {
    LayerStrokes {
        name: name.to_owned(),
        joints: 0..discs.len(),
        rank,
        instances: 1,
        stretches: Stretches::Everywhere,
        discs: discs.to_vec(),
        colors: vec![color; discs.len()],
    }
}

/// One strand of one run whose clump is drawn in red.
fn one_strand(size: [u32; 2], discs: &[Disc]) -> Drawing {
    Drawing {
        size,
        runs: vec![Run {
            strand: 0,
            joints: 0..discs.len(),
        }],
        clump: discs.to_vec(),
        layers: vec![layer("base", 0, RED, discs)],
        ..Drawing::default()
    }
}

/// Several strands of one run each, whose clumps are drawn in the given colours.
fn strands(size: [u32; 2], strands: &[(u32, [f32; 3], &[Disc])]) -> Drawing {
    let mut drawing = one_strand(size, &[]);
    drawing.runs.clear();
    for (strand, color, discs) in strands {
        let start = drawing.clump.len();
        drawing.clump.extend_from_slice(discs);
        drawing.layers[0].discs.extend_from_slice(discs);
        drawing.layers[0].colors.extend(vec![*color; discs.len()]);
        drawing.layers[0].joints = 0..drawing.clump.len();
        drawing.runs.push(Run {
            strand: *strand,
            joints: start..drawing.clump.len(),
        });
    }
    drawing
}

fn draw(drawing: &Drawing, samples: u32) -> Picture {
    Rasterizer::new(samples, Some(1))
        .unwrap()
        .draw(drawing)
        .unwrap()
}

/// The middle of the picture with one sample a pixel.
fn middle(drawing: &Drawing) -> [f32; 4] {
    let [width, height] = drawing.size;
    draw(drawing, 1).pixels[(height / 2 * width + width / 2) as usize]
}

fn area(drawing: &Drawing) -> f64 {
    draw(drawing, 256)
        .pixels
        .iter()
        .map(|p| f64::from(p[3]))
        .sum()
}

/// Asserts an area in pixels within a thousandth of a pixel for each pixel of outline.
fn assert_area(drawing: &Drawing, expected: f64, outline: f64) {
    let area = area(drawing);
    assert!(
        (area - expected).abs() < 0.003 * outline,
        "{area} is not {expected}"
    );
}

#[test]
fn disc_has_its_area() {
    let drawing = one_strand([64, 64], &[disc(31.3, 30.8, 20.0, 1.0)]);
    assert_area(&drawing, PI * 400.0, 2.0 * PI * 20.0);
}

#[test]
fn half_discs_have_their_areas() {
    let (large, small) = (disc(20.2, 25.1, 12.0, 1.0), disc(60.2, 55.1, 6.0, 1.0));
    let half = |discs: [Disc; 2]| Drawing {
        brush: Brush::Semicircle,
        ..one_strand([96, 96], &discs)
    };
    assert_area(&half([large, small]), PI * 72.0 + 50.0 * 18.0, 180.0);
    // The whole discs' hull less the half of the larger that lies ahead.
    let angle = (6.0_f64 / 50.0).acos();
    let whole = 144.0 * (PI - angle) + 36.0 * angle + 18.0 * 50.0 * angle.sin();
    assert_area(&half([small, large]), whole - PI * 72.0, 180.0);
}

#[test]
fn capsule_has_its_area() {
    let discs = [disc(20.2, 15.1, 6.0, 1.0), disc(70.3, 53.4, 6.0, 1.0)];
    let length = f64::from((discs[1].center - discs[0].center).length());
    let expected = PI * 36.0 + 12.0 * length;
    assert_area(&one_strand([96, 64], &discs), expected, 160.0);
}

/// Two discs and their outer tangents: not the trapezium that interpolation by projection draws.
#[test]
fn uneven_capsule_has_its_area() {
    for (r0, r1) in [(14.0, 3.0), (3.0, 14.0), (14.0, 0.0)] {
        let discs = [disc(20.0, 20.0, r0, 1.0), disc(50.0, 40.0, r1, 1.0)];
        let length = f64::from((discs[1].center - discs[0].center).length());
        let (r0, r1) = (f64::from(r0), f64::from(r1));
        let side = (length * length - (r0 - r1) * (r0 - r1)).sqrt();
        let tilt = ((r0 - r1) / length).asin();
        let expected = (r0 + r1) * side + r0 * r0 * (PI / 2.0 + tilt) + r1 * r1 * (PI / 2.0 - tilt);
        assert_area(&one_strand([64, 64], &discs), expected, 120.0);
    }
}

#[test]
fn nested_discs_are_the_larger_one() {
    let discs = [disc(30.0, 30.0, 5.0, 1.0), disc(33.0, 31.0, 20.0, 1.0)];
    assert_area(&one_strand([64, 64], &discs), PI * 400.0, 2.0 * PI * 20.0);
}

#[test]
fn radius_zero_covers_nothing() {
    let line = [disc(2.5, 2.5, 0.0, 1.0), disc(9.5, 2.5, 0.0, 1.0)];
    assert_eq!(area(&one_strand([12, 6], &line)), 0.0);
    assert_eq!(area(&one_strand([12, 6], &line[..1])), 0.0);
}

#[test]
fn strokes_cross_tiles_without_seams() {
    let discs = [
        disc(-5000.0, -2478.0, 40.0, 1.0),
        disc(5200.0, 2622.0, 40.0, 1.0),
    ];
    let wide = draw(&one_strand([200, 144], &discs), 4);
    // The line passes (100, 72) and rises by half: what is nearer than 39 pixels is covered.
    for (i, pixel) in wide.pixels.iter().enumerate() {
        let (x, y) = ((i % 200) as f32 + 0.5, (i / 200) as f32 + 0.5);
        let slope = 5100.0 / 10200.0_f32;
        let across = ((y - 72.0) - slope * (x - 100.0)).abs() / (1.0 + slope * slope).sqrt();
        if across < 39.0 {
            assert_eq!(*pixel, opaque(RED), "at {x}, {y}");
        } else if across > 41.0 {
            assert_eq!(*pixel, NONE, "at {x}, {y}");
        }
    }
}

#[test]
fn nearer_strand_wins() {
    let (near, far) = ([disc(5.0, 5.0, 3.0, 2.0)], [disc(5.0, 5.0, 3.0, 1.0)]);
    assert_eq!(
        middle(&strands([10, 10], &[(0, RED, &near), (1, BLUE, &far)])),
        opaque(RED)
    );
    assert_eq!(
        middle(&strands([10, 10], &[(0, RED, &far), (1, BLUE, &near)])),
        opaque(BLUE)
    );
}

#[test]
fn lower_id_wins_among_equals() {
    let discs = [disc(5.0, 5.0, 3.0, 1.0)];
    let mut drawing = strands([10, 10], &[(3, RED, &discs), (9, BLUE, &discs)]);
    assert_eq!(middle(&drawing), opaque(RED));
    drawing.order = Order::Shifted;
    assert_eq!(middle(&drawing), opaque(RED));
}

/// A strand that points at the viewer: its near end is the small disc inside the large one.
#[test]
fn nested_disc_shows_its_own_depth() {
    let tip = [disc(10.0, 10.0, 8.0, 1.0), disc(10.0, 10.0, 2.0, 4.0)];
    let between = [disc(10.0, 10.0, 9.0, 2.5)];
    let picture = draw(
        &strands([20, 20], &[(0, RED, &tip), (1, BLUE, &between)]),
        1,
    );
    let at = |x: usize| picture.pixels[10 * 20 + x];
    // The radius is 5 where the inverse depth passes 2.5.
    assert_eq!(at(10), opaque(RED));
    assert_eq!(at(14), opaque(RED));
    assert_eq!(at(15), opaque(BLUE));
}

/// The nearest of all discs over a sample counts, not that of the nearest axis point.
#[test]
fn depth_is_the_least_over_the_interval() {
    // Inverse depth rises along x; at x = 10 the farthest disc that covers is at x = 15.
    let rising = [disc(0.0, 10.5, 5.0, 1.0), disc(40.0, 10.5, 5.0, 5.0)];
    let at = |inv_depth| [disc(10.5, 10.5, 1.0, inv_depth)];
    let front = |inv_depth| {
        let picture = draw(
            &strands([40, 20], &[(0, RED, &rising), (1, BLUE, &at(inv_depth))]),
            1,
        );
        picture.pixels[10 * 40 + 10]
    };
    assert_eq!(front(2.54), opaque(RED));
    assert_eq!(front(2.56), opaque(BLUE));
}

#[test]
fn color_is_that_of_the_nearest_axis_point() {
    let mut drawing = one_strand(
        [40, 20],
        &[disc(5.0, 10.5, 4.0, 1.0), disc(35.0, 10.5, 4.0, 9.0)],
    );
    drawing.layers[0].colors = vec![[0.0; 3], [1.0; 3]];
    let picture = draw(&drawing, 1);
    for (x, y, expected) in [
        (20, 10, 0.5 + 0.5 / 30.0),
        (20, 13, 0.5 + 0.5 / 30.0),
        (2, 10, 0.0),
    ] {
        let gray = picture.pixels[y * 40 + x][0];
        assert!((gray - expected).abs() < 1e-5, "{gray} at {x}, {y}");
    }
}

/// Two runs of a strand are one stroke: the least ratio colours, whichever run it is of.
#[test]
fn runs_of_a_strand_are_one_stroke() {
    let discs = [
        disc(8.0, 10.5, 6.0, 1.0),
        disc(8.0, 10.5, 6.0, 1.0),
        disc(12.0, 10.5, 6.0, 1.0),
    ];
    let mut drawing = one_strand([20, 20], &discs);
    drawing.runs = vec![
        Run {
            strand: 4,
            joints: 0..1,
        },
        Run {
            strand: 4,
            joints: 2..3,
        },
    ];
    drawing.layers[0].colors = vec![RED, RED, BLUE];
    let picture = draw(&drawing, 1);
    assert_eq!(picture.pixels[10 * 20 + 9], opaque(RED));
    assert_eq!(picture.pixels[10 * 20 + 10], opaque(BLUE));
}

fn vertex(x: f32, y: f32, inv_depth: f32, tone: f32) -> SurfaceVertex {
    SurfaceVertex {
        position: Vec2::new(x, y),
        inv_depth,
        tone,
    }
}

/// A square of two triangles from (0, 0) to (20, 20), lit on the left and dark on the right.
fn square(inv_depth: f32) -> Surface {
    Surface {
        texture: None,
        margin_m: 0.0,
        mesh: 0,
        paint: None,
        marks: 0,
        vertices: vec![
            vertex(0.0, 0.0, inv_depth, 1.0),
            vertex(20.0, 0.0, inv_depth, -1.0),
            vertex(20.0, 20.0, inv_depth, -1.0),
            vertex(0.0, 20.0, inv_depth, 1.0),
        ],
        triangles: vec![[0, 1, 2], [0, 3, 2]],
        light: GREEN,
        shadow: BLUE,
    }
}

#[test]
fn surface_has_two_tones_on_both_sides_and_no_seam() {
    let mut drawing = one_strand([24, 24], &[]);
    drawing.runs.clear();
    drawing.surfaces = vec![square(1.0)];
    for samples in [1, 4] {
        let picture = draw(&drawing, samples);
        for (i, pixel) in picture.pixels.iter().enumerate() {
            let expected = match (i % 24, i / 24) {
                (20.., _) | (_, 20..) => NONE,
                (0..10, _) => opaque(GREEN),
                _ => opaque(BLUE),
            };
            assert_eq!(*pixel, expected, "pixel {i}");
        }
    }
}

#[test]
fn a_sample_on_an_edge_is_inside_and_a_flat_triangle_is_nothing() {
    let mut drawing = one_strand([9, 9], &[]);
    drawing.runs.clear();
    let surface = |a, b, c| Surface {
        texture: None,
        margin_m: 0.0,
        mesh: 0,
        paint: None,
        marks: 0,
        vertices: vec![a, b, c],
        triangles: vec![[0, 1, 2]],
        light: GREEN,
        shadow: BLUE,
    };
    drawing.surfaces = vec![surface(
        vertex(4.5, 4.5, 1.0, 1.0),
        vertex(8.5, 4.5, 1.0, 1.0),
        vertex(4.5, 8.5, 1.0, 1.0),
    )];
    let picture = draw(&drawing, 1);
    for (x, y, expected) in [(4, 4, GREEN), (6, 6, GREEN), (8, 4, GREEN), (4, 8, GREEN)] {
        assert_eq!(picture.pixels[y * 9 + x], opaque(expected));
    }
    assert_eq!(picture.pixels[3 * 9 + 4], NONE);
    assert_eq!(picture.pixels[7 * 9 + 7], NONE);
    drawing.surfaces = vec![surface(
        vertex(0.5, 0.5, 1.0, 1.0),
        vertex(4.5, 4.5, 1.0, 1.0),
        vertex(8.5, 8.5, 1.0, 1.0),
    )];
    assert!(draw(&drawing, 1).pixels.iter().all(|p| *p == NONE));
}

#[test]
fn nearer_surface_wins_and_the_earlier_among_equals() {
    let mut drawing = one_strand([10, 10], &[]);
    drawing.runs.clear();
    let surface = |inv_depth, light| Surface {
        texture: None,
        margin_m: 0.0,
        light,
        shadow: light,
        ..square(inv_depth)
    };
    for (first, second, expected) in [(1.0, 2.0, BLUE), (2.0, 1.0, RED), (1.0, 1.0, RED)] {
        drawing.surfaces = vec![surface(first, RED), surface(second, BLUE)];
        assert_eq!(middle(&drawing), opaque(expected));
    }
}

/// Hair lies in front of the scalp by its biased depth, though its own depth is behind.
#[test]
fn biased_depth_decides_against_surfaces() {
    let mut discs = [disc(5.0, 5.0, 3.0, 1.0)];
    for (biased, surface, expected) in [
        (1.2, 1.1, RED),
        (1.2, 1.2, RED), // only a nearer surface hides
        (1.2, 1.3, GREEN),
        (0.8, 0.9, GREEN), // the own depth doesn't matter
    ] {
        discs[0].inv_depth_biased = biased;
        let mut drawing = one_strand([10, 10], &discs);
        drawing.surfaces = vec![Surface {
            texture: None,
            margin_m: 0.0,
            shadow: GREEN,
            ..square(surface)
        }];
        for order in Order::ALL {
            drawing.order = order;
            assert_eq!(
                middle(&drawing),
                opaque(expected),
                "{biased} on {surface}, {order:?}"
            );
        }
    }
}

/// Such a surface's margin counts in place of the bias.
#[test]
fn before_a_surface_with_a_margin_strokes_must_be_nearer() {
    let mut discs = [disc(5.0, 5.0, 3.0, 1.0)];
    discs[0].inv_depth_biased = 9.0;
    for (wall_m, margin_m, expected) in [
        (1.26, 0.25, RED),
        (1.24, 0.25, GREEN),
        (0.76, -0.25, RED),
        (0.74, -0.25, GREEN),
    ] {
        let mut drawing = one_strand([10, 10], &discs);
        drawing.surfaces = vec![Surface {
            texture: None,
            margin_m,
            shadow: GREEN,
            ..square(1.0 / wall_m)
        }];
        for order in Order::ALL {
            drawing.order = order;
            assert_eq!(middle(&drawing), opaque(expected), "{wall_m} m, {order:?}");
        }
        // A nearer outside takes its place, with the bias.
        drawing.surfaces.push(square(2.0));
        assert_eq!(middle(&drawing), opaque(RED));
    }
}

#[test]
fn picture_is_the_mean_of_samples_over_the_background() {
    let mut drawing = one_strand(
        [3, 3],
        &[disc(1.0, 1.5, 0.5, 1.0), disc(1.0, -9.0, 0.5, 1.0)],
    );
    drawing.layers[0].colors = vec![[0.5, 0.25, 0.0]; 2];
    // Two of the pixel's four samples lie left of x = 1.5.
    assert_eq!(draw(&drawing, 4).pixels[1], [0.25, 0.125, 0.0, 0.5]);
    drawing.background = Some(BLUE);
    let picture = draw(&drawing, 4);
    assert_eq!(picture.pixels[1], [0.25, 0.125, 0.5, 1.0]);
    assert_eq!(picture.pixels[8], opaque(BLUE));
    assert_eq!((picture.width, picture.height), (3, 3));
}

#[test]
fn light_beyond_white_is_clamped() {
    let mut drawing = one_strand([10, 10], &[disc(5.0, 5.0, 3.0, 1.0)]);
    drawing.layers[0].colors = vec![[7.0, -1.0, 0.5]];
    assert_eq!(middle(&drawing), [1.0, 0.0, 0.5, 1.0]);
}

#[test]
fn a_rasterizer_needs_samples_and_threads() {
    assert!(matches!(
        Rasterizer::new(0, None),
        Err(RasterizerError::Samples(_))
    ));
    assert!(matches!(
        Rasterizer::new(4, Some(0)),
        Err(RasterizerError::Threads(0))
    ));
    assert!(matches!(
        Rasterizer::new(4, Some(9999)),
        Err(RasterizerError::Threads(9999))
    ));
}
