//! Each rule of order by itself: what one sample shows.

use crate::drawings::*;
use render::{Disc, Drawing, Order, Surface, SurfaceVertex};

const X: f64 = 32.0;

fn shown(drawing: &Drawing) -> [f32; 4] {
    sample_in(Order::StrandFirst, drawing, X, X)
}

fn shown_shifted(drawing: &Drawing) -> [f32; 4] {
    sample_in(Order::Shifted, drawing, X, X)
}

/// A disc in the middle.
fn at(inv_depth: f32) -> Disc {
    disc(32.0, 32.0, 8.0, inv_depth)
}

/// A disc that does not cover the middle.
fn elsewhere() -> Disc {
    disc(5.0, 5.0, 3.0, 1.0)
}

#[test]
fn highest_rank_gives_the_colour_whatever_its_depth() {
    let mut drawing = clumps(&[&[at(1.0)]]);
    add_layer(&mut drawing, 2, RED, &[&[at(0.5)]]);
    add_layer(&mut drawing, 0, GREEN, &[&[at(3.0)]]);
    add_layer(&mut drawing, -1, BLUE, &[&[at(9.0)]]);
    assert_eq!(shown(&drawing), opaque(RED));
    assert_eq!(shown_shifted(&drawing), opaque(BLUE));
}

#[test]
fn a_rank_that_does_not_cover_the_sample_is_passed_over() {
    let mut drawing = clumps(&[&[at(1.0)]]);
    add_layer(&mut drawing, 2, RED, &[&[elsewhere()]]);
    add_layer(&mut drawing, 0, GREEN, &[&[at(1.0)]]);
    assert_eq!(shown(&drawing), opaque(GREEN));
    assert_eq!(shown_shifted(&drawing), opaque(GREEN));
}

#[test]
fn among_equal_ranks_the_later_layer_then_the_later_instance() {
    let mut drawing = clumps(&[&[at(1.0)]]);
    add_layer(&mut drawing, 1, RED, &[&[at(1.0)]]);
    add_layer(&mut drawing, 1, GREEN, &[&[at(1.0)], &[at(1.0)]]);
    drawing.layers[1].colors[1] = BLUE;
    assert_eq!(shown(&drawing), opaque(BLUE));
    assert_eq!(shown_shifted(&drawing), opaque(BLUE));
    drawing.layers[1].discs[1] = elsewhere();
    assert_eq!(shown(&drawing), opaque(GREEN));
    assert_eq!(shown_shifted(&drawing), opaque(GREEN));
    drawing.layers[1].discs[0] = elsewhere();
    assert_eq!(shown(&drawing), opaque(RED));
    drawing.layers[0].rank = 3;
    drawing.layers[1].discs[0] = at(1.0);
    assert_eq!(shown(&drawing), opaque(RED));
    assert_eq!(shown_shifted(&drawing), opaque(RED));
}

#[test]
fn a_later_layer_lies_over_every_instance_of_an_earlier_one() {
    let mut drawing = clumps(&[&[at(1.0)]]);
    add_layer(&mut drawing, 1, RED, &[&[at(1.0)], &[at(1.0)]]);
    add_layer(&mut drawing, 1, GREEN, &[&[at(1.0)]]);
    assert_eq!(shown(&drawing), opaque(GREEN));
    assert_eq!(shown_shifted(&drawing), opaque(GREEN));
}

#[test]
fn outside_the_clump_only_ranks_below_zero_show() {
    let mut drawing = clumps(&[&[elsewhere()]]);
    add_layer(&mut drawing, 0, RED, &[&[at(1.0)]]);
    add_layer(&mut drawing, 3, GREEN, &[&[at(1.0)]]);
    assert_eq!(shown(&drawing), [0.0; 4]);
    assert_eq!(shown_shifted(&drawing), opaque(GREEN));
    add_layer(&mut drawing, -2, BLUE, &[&[at(1.0)]]);
    assert_eq!(shown(&drawing), opaque(BLUE));
    add_layer(&mut drawing, -1, WHITE, &[&[at(0.1)]]);
    assert_eq!(shown(&drawing), opaque(WHITE));
    assert_eq!(shown_shifted(&drawing), opaque(GREEN));
}

#[test]
fn a_rank_below_zero_shows_in_the_clump_where_nothing_higher_does() {
    let mut drawing = clumps(&[&[at(1.0)]]);
    add_layer(&mut drawing, -1, BLUE, &[&[at(0.1)]]);
    assert_eq!(shown(&drawing), opaque(BLUE));
}

/// Strand 0 is red, strand 1 green; both have a clump, and one stroke at the given depths.
fn pair(rank: i32, clumps_at: [Disc; 2], strokes_at: [Disc; 2]) -> Drawing {
    let mut drawing = clumps(&[&[clumps_at[0]], &[clumps_at[1]]]);
    add_layer(&mut drawing, rank, RED, &[&strokes_at]);
    drawing.layers[0].colors[1] = GREEN;
    drawing
}

#[test]
fn among_strands_the_nearer_clump_decides() {
    let drawing = pair(1, [at(1.0), at(2.0)], [at(8.0), at(0.5)]);
    assert_eq!(shown(&drawing), opaque(GREEN));
    assert_eq!(shown_shifted(&drawing), opaque(RED));
}

#[test]
fn a_clump_without_a_stroke_hides_nothing() {
    let drawing = pair(1, [at(1.0), at(2.0)], [at(1.0), elsewhere()]);
    assert_eq!(shown(&drawing), opaque(RED));
    assert_eq!(shown_shifted(&drawing), opaque(RED));
}

#[test]
fn outside_its_clump_a_stroke_has_its_own_depth() {
    for (depth, color) in [(1.9, GREEN), (2.1, RED)] {
        let drawing = pair(-1, [elsewhere(), at(2.0)], [at(depth), at(9.0)]);
        assert_eq!(shown(&drawing), opaque(color));
    }
}

#[test]
fn among_equal_depths_the_lower_id() {
    let drawing = pair(0, [at(1.0), at(1.0)], [at(1.0), at(1.0)]);
    assert_eq!(shown(&drawing), opaque(RED));
    assert_eq!(shown_shifted(&drawing), opaque(RED));
}

#[test]
fn shifted_prefers_rank_and_layer_to_id_among_equal_depths() {
    let mut drawing = pair(0, [at(1.0), at(1.0)], [at(1.0), at(1.0)]);
    add_layer(&mut drawing, 0, BLUE, &[&[elsewhere(), at(1.0)]]);
    assert_eq!(shown_shifted(&drawing), opaque(BLUE));
    drawing.layers[0].rank = 1;
    assert_eq!(shown_shifted(&drawing), opaque(RED));
    assert_eq!(shown(&drawing), opaque(RED));
}

/// One strand at inverse depth 1 whose biased inverse depth is 2, before or behind a wall.
fn against_wall(wall: f32) -> Drawing {
    let biased = Disc {
        inv_depth_biased: 2.0,
        ..at(1.0)
    };
    let mut drawing = strokes(&[&[biased]]);
    add_wall(&mut drawing, wall, 1.0, [BLUE, RED]);
    drawing
}

#[test]
fn a_surface_hides_what_lies_behind_it_by_more_than_the_bias() {
    for (wall, color) in [(0.5, WHITE), (1.5, WHITE), (2.0, WHITE), (2.01, BLUE)] {
        assert_eq!(shown(&against_wall(wall)), opaque(color), "wall at {wall}");
        assert_eq!(
            shown_shifted(&against_wall(wall)),
            opaque(color),
            "wall at {wall}"
        );
    }
}

#[test]
fn bias_does_not_count_among_strands() {
    let biased = Disc {
        inv_depth_biased: 9.0,
        ..at(1.0)
    };
    let drawing = pair(0, [biased, at(2.0)], [biased, at(2.0)]);
    assert_eq!(shown(&drawing), opaque(GREEN));
    assert_eq!(shown_shifted(&drawing), opaque(GREEN));
}

#[test]
fn before_a_surface_with_a_margin_strokes_must_be_nearer() {
    let biased = Disc {
        inv_depth_biased: 9.0,
        ..at(1.0)
    };
    for (wall_m, margin_m, expected) in [
        (1.26, 0.25, WHITE),
        (1.24, 0.25, BLUE),
        (0.76, -0.25, WHITE),
        (0.74, -0.25, BLUE),
    ] {
        let mut drawing = strokes(&[&[biased]]);
        add_wall(&mut drawing, 1.0 / wall_m, 1.0, [BLUE; 2]);
        drawing.surfaces[0].margin_m = margin_m;
        assert_eq!(shown(&drawing), opaque(expected), "{wall_m} m");
        assert_eq!(shown_shifted(&drawing), opaque(expected), "{wall_m} m");
    }
}

#[test]
fn a_strand_that_a_surface_hides_does_not_hide_others() {
    // The nearer strand has the smaller bias and is dropped; the farther is left.
    let near = Disc {
        inv_depth_biased: 2.0,
        ..at(2.0)
    };
    let far = Disc {
        inv_depth_biased: 4.0,
        ..at(1.0)
    };
    let mut drawing = pair(0, [near, far], [near, far]);
    add_wall(&mut drawing, 3.0, 1.0, [BLUE; 2]);
    assert_eq!(shown(&drawing), opaque(GREEN));
    assert_eq!(shown_shifted(&drawing), opaque(GREEN));
}

#[test]
fn against_surfaces_the_clump_decides_inside_it_and_the_stroke_outside() {
    let hidden = Disc {
        inv_depth_biased: 0.1,
        ..at(1.0)
    };
    let mut inside = clumps(&[&[at(1.0)]]);
    add_layer(&mut inside, -1, RED, &[&[hidden]]);
    let mut outside = clumps(&[&[elsewhere()]]);
    add_layer(&mut outside, -1, RED, &[&[hidden]]);
    for drawing in [&mut inside, &mut outside] {
        add_wall(drawing, 0.5, 1.0, [BLUE; 2]);
    }
    assert_eq!(shown(&inside), opaque(RED));
    assert_eq!(shown(&outside), opaque(BLUE));
    assert_eq!(shown_shifted(&inside), opaque(BLUE));
}

#[test]
fn the_nearest_surface_shows_in_the_tone_of_its_sign() {
    let mut drawing = clumps(&[]);
    drawing.background = Some(WHITE);
    add_wall(&mut drawing, 1.0, 1.0, [RED, RED]);
    add_wall(&mut drawing, 2.0, -0.1, [GREEN, BLUE]);
    add_wall(&mut drawing, 0.5, 1.0, [RED, RED]);
    assert_eq!(shown(&drawing), opaque(BLUE));
    add_wall(&mut drawing, 2.0, 1.0, [RED, RED]); // as near: the first shows
    assert_eq!(shown(&drawing), opaque(BLUE));
    drawing.surfaces[1]
        .vertices
        .iter_mut()
        .for_each(|v| v.tone = 0.0);
    assert_eq!(shown(&drawing), opaque(GREEN));
}

#[test]
fn a_stroke_sinks_into_a_slanted_surface_along_its_line() {
    // The surface's inverse depth is x / 32; the strand's is 1 everywhere.
    let mut drawing = strokes(&[&[disc(2.0, 32.0, 4.0, 1.0), disc(62.0, 32.0, 4.0, 1.0)]]);
    let vertex = |x: f32, y: f32| SurfaceVertex {
        position: glam::Vec2::new(x, y),
        inv_depth: x / 32.0,
        tone: 1.0,
    };
    drawing.surfaces.push(Surface {
        texture: None,
        margin_m: 0.0,
        mesh: 0,
        paint: None,
        marks: 0,
        vertices: vec![vertex(0.0, 0.0), vertex(128.0, 0.0), vertex(0.0, 128.0)],
        triangles: vec![[0, 2, 1]],
        light: BLUE,
        shadow: RED,
    });
    assert_eq!(sample(&drawing, 31.9, 30.0), opaque(WHITE));
    assert_eq!(sample(&drawing, 32.1, 30.0), opaque(BLUE));
}

#[test]
fn the_order_of_layers_in_the_list_counts_only_among_equal_ranks() {
    let mut drawing = clumps(&[&[at(1.0)]]);
    add_layer(&mut drawing, 1, RED, &[&[at(1.0)]]);
    add_layer(&mut drawing, 0, GREEN, &[&[at(1.0)]]);
    assert_eq!(shown(&drawing), opaque(RED));
    drawing.layers.swap(0, 1);
    assert_eq!(shown(&drawing), opaque(RED));
}

#[test]
fn a_layer_of_no_instances_draws_nothing() {
    let mut drawing = clumps(&[&[at(1.0)]]);
    add_layer(&mut drawing, 0, RED, &[]);
    assert_eq!(shown(&drawing), [0.0; 4]);
}

/// Two discs of radius 8, 12 pixels apart, whose middles differ in depth: they meet where
/// `d + e (x / 8)^2 = e ((12 - x) / 8)^2`, at `x = 6 - 8 d / (3 e)`.
#[test]
fn round_strokes_meet_where_their_depths_do() {
    const EDGE_DEPTH_M: f32 = 0.5;
    let depth = |metres: f32| 1.0 / (2.0 + metres);
    for behind_m in [-0.3_f32, 0.0, 0.2, 0.6] {
        let discs = [
            disc(20.0, 32.0, 8.0, depth(behind_m)),
            disc(32.0, 32.0, 8.0, depth(0.0)),
        ];
        let mut drawing = clumps(&[&discs[..1], &discs[1..]]);
        drawing.edge_depth_m = EDGE_DEPTH_M;
        add_layer(&mut drawing, 0, RED, &[&discs]);
        drawing.layers[0].colors[1] = BLUE;
        let border = 26.0 - f64::from(8.0 * behind_m / (3.0 * EDGE_DEPTH_M));
        let border = border.clamp(24.0, 28.0);
        let at = |x| sample_in(Order::Rounded, &drawing, x, 32.0);
        assert_eq!(at(border - 0.05), opaque(RED), "{behind_m}");
        assert_eq!(at(border + 0.05), opaque(BLUE), "{behind_m}");
    }
}

/// An outline's edge lies deeper than its inside by the eighth power of its part of the radius: where
/// another clump cuts it, it becomes thinner.
#[test]
fn outlines_taper_where_they_sink_into_a_clump() {
    const EDGE_DEPTH_M: f32 = 0.5;
    let (offset_m, deeper_m) = (0.1_f32, 0.3_f32);
    let near = disc(32.0, 32.0, 8.0, 1.0);
    // So wide that it is flat here.
    let under = disc(32.0, 32.0, 1e6, 1.0 / (2.0 + offset_m + deeper_m));
    let none = disc(0.0, 0.0, 0.0, 1.0);
    let outline = disc(32.0, 32.0, 16.0, 1.0 / (2.0 + offset_m));
    let mut drawing = clumps(&[&[near], &[under]]);
    drawing.edge_depth_m = EDGE_DEPTH_M;
    add_layer(&mut drawing, -1, RED, &[&[outline, none]]);
    add_layer(&mut drawing, 0, GREEN, &[&[near, under]]);
    drawing.layers[1].colors[1] = BLUE;
    let border = 32.0 + 16.0 * (f64::from(deeper_m / EDGE_DEPTH_M)).powf(1.0 / 8.0);
    let at = |x| sample_in(Order::Rounded, &drawing, x, 32.0);
    assert_eq!(at(32.0 + 7.9), opaque(GREEN));
    assert_eq!(at(border - 0.05), opaque(RED));
    assert_eq!(at(border + 0.05), opaque(BLUE));
}

#[test]
fn round_strokes_sink_into_surfaces_at_their_edges() {
    let mut drawing = strokes(&[&[at(0.5)]]);
    drawing.edge_depth_m = 0.4;
    add_wall(&mut drawing, 1.0 / 2.1, -1.0, [RED, BLUE]);
    // 0.4 (x / 8)^2 = 0.1
    let border = 32.0 + 4.0;
    let at = |x| sample_in(Order::Rounded, &drawing, x, X);
    assert_eq!(at(border - 0.05), opaque(WHITE));
    assert_eq!(at(border + 0.05), opaque(BLUE));
}
