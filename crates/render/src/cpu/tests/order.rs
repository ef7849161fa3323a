//! Which stroke a sample shows.

use super::*;
use crate::brushwork::{AlongStrand, BrushedLayer, Brushwork};
use effects::{BrushSection, BrushTexture, Tool};
use proptest::prelude::*;
use std::sync::Arc;

/// A clump of radius 4 around (10, 10) in 20 by 20 pixels, and layers of one disc each.
fn clump_with(layers: Vec<LayerStrokes>) -> Drawing {
    Drawing {
        layers,
        ..one_strand([20, 20], &[disc(10.0, 10.0, 4.0, 2.0)])
    }
}

fn at(drawing: &Drawing, x: usize, y: usize) -> [f32; 4] {
    draw(drawing, 1).pixels[y * 20 + x]
}

/// Inside and outside of the clump on the disc of radius 8.
const INSIDE: (usize, usize) = (10, 10);
const OUTSIDE: (usize, usize) = (10, 15);

fn wide(inv_depth: f32) -> [Disc; 1] {
    [disc(10.0, 10.0, 8.0, inv_depth)]
}

fn check(drawing: &Drawing, inside: [f32; 4], outside: [f32; 4]) {
    assert_eq!(at(drawing, INSIDE.0, INSIDE.1), inside, "inside");
    assert_eq!(at(drawing, OUTSIDE.0, OUTSIDE.1), outside, "outside");
}

#[test]
fn the_highest_rank_wins_whatever_its_depth() {
    let drawing = clump_with(vec![
        layer("highlight", 2, GREEN, &wide(0.1)),
        layer("base", 0, RED, &wide(9.0)),
        layer("cel", 1, BLUE, &wide(9.0)),
    ]);
    check(&drawing, opaque(GREEN), NONE);
}

#[test]
fn ranks_from_0_are_clipped_to_the_clump_and_those_below_are_not() {
    check(
        &clump_with(vec![layer("base", 0, RED, &wide(2.0))]),
        opaque(RED),
        NONE,
    );
    check(
        &clump_with(vec![layer("silhouette", -1, BLUE, &wide(2.0))]),
        opaque(BLUE),
        opaque(BLUE),
    );
    let mut drawing = clump_with(vec![layer("base", 0, RED, &wide(2.0))]);
    drawing.clump[0].radius = 0.0;
    check(&drawing, NONE, NONE);
}

#[test]
fn among_equal_ranks_the_later_layer_then_the_later_instance_wins() {
    let later_layer = vec![
        layer("a", 1, RED, &wide(2.0)),
        layer("b", 1, BLUE, &wide(1.0)),
    ];
    check(&clump_with(later_layer), opaque(BLUE), NONE);
    let mut feathers = layer("feathers", -1, RED, &wide(2.0));
    feathers.instances = 2;
    feathers.discs = [wide(2.0), wide(1.0)].concat();
    feathers.colors = vec![RED, BLUE];
    check(&clump_with(vec![feathers]), opaque(BLUE), opaque(BLUE));
}

/// Outside the clump too, rank decides within the strand, and the winner's own depth counts after.
#[test]
fn outside_the_clump_the_highest_rank_shows_at_its_own_depth() {
    let other = wide(1.5);
    for (lower, upper, expected) in [
        (9.0, 1.0, GREEN), // the upper one is behind the other strand, so the lower doesn't help
        (1.0, 1.6, BLUE),
    ] {
        let clump = [disc(10.0, 10.0, 4.0, 2.0)];
        let mut drawing = strands([20, 20], &[(0, RED, &clump), (1, GREEN, &other)]);
        let two = |rank, color, discs: [Disc; 1]| {
            layer("", rank, color, &[discs[0], disc(0.0, 0.0, 0.0, 1.0)])
        };
        drawing.layers.push(two(-2, RED, wide(lower)));
        drawing.layers.push(two(-1, BLUE, wide(upper)));
        assert_eq!(at(&drawing, OUTSIDE.0, OUTSIDE.1), opaque(expected));
    }
}

/// Two strands over each other: a base stroke and, behind it, its silhouette.
fn crossing() -> Drawing {
    let base = [disc(10.0, 10.0, 4.0, 2.0)];
    let other = [disc(10.0, 14.0, 4.0, 1.5)];
    let mut drawing = strands([20, 20], &[(0, RED, &base), (1, GREEN, &other)]);
    let lines = [disc(10.0, 10.0, 6.0, 1.0), disc(10.0, 14.0, 6.0, 0.5)];
    drawing.layers.push(layer("silhouette", -1, BLUE, &lines));
    drawing
}

#[test]
fn a_silhouette_merges_with_strands_nearer_than_its_offset() {
    let mut drawing = crossing();
    // (10, 15) is in the nearer strand's silhouette and in the farther one's clump.
    assert_eq!(at(&drawing, 10, 15), opaque(GREEN));
    // In its own clump the silhouette takes the clump's depth: (10, 11) is in both clumps.
    assert_eq!(at(&drawing, 10, 11), opaque(RED));
    // With less offset the line is drawn over the other strand.
    drawing.layers[1].discs[0].inv_depth = 1.6;
    assert_eq!(at(&drawing, 10, 15), opaque(BLUE));
}

/// In the clump the depth is the clump's, for the strand's every stroke.
#[test]
fn inside_the_clump_depth_is_the_clumps() {
    let base = [disc(10.0, 10.0, 4.0, 2.0)];
    let mut drawing = strands(
        [20, 20],
        &[(0, RED, &base), (1, GREEN, &[disc(10.0, 10.0, 4.0, 3.0)])],
    );
    drawing.layers[0].discs[0].inv_depth = 9.0;
    assert_eq!(at(&drawing, 10, 10), opaque(GREEN));
    drawing.order = Order::Shifted;
    assert_eq!(at(&drawing, 10, 10), opaque(RED));
}

#[test]
fn a_sample_of_the_clump_without_a_stroke_is_empty_and_hides_nothing() {
    let near = [disc(10.0, 10.0, 8.0, 9.0)];
    let far = [disc(10.0, 10.0, 8.0, 1.0)];
    let mut drawing = strands([20, 20], &[(0, RED, &near), (1, GREEN, &far)]);
    drawing.layers[0].discs[0].radius = 2.0;
    assert_eq!(at(&drawing, 10, 10), opaque(RED));
    assert_eq!(at(&drawing, 10, 15), opaque(GREEN));
}

/// The strand's order comes first, then its one fragment is tested: no lower stroke steps in.
#[test]
fn a_surface_drops_the_strand_not_the_stroke() {
    let mut drawing = clump_with(vec![
        layer("outer", -2, RED, &wide(9.0)),
        layer("inner", -1, BLUE, &wide(1.0)),
    ]);
    drawing.surfaces = vec![Surface {
        texture: None,
        margin_m: 0.0,
        shadow: GREEN,
        ..square(3.0)
    }];
    check(&drawing, opaque(GREEN), opaque(GREEN));
    drawing.clump[0].inv_depth_biased = 4.0;
    check(&drawing, opaque(BLUE), opaque(GREEN));
    drawing.order = Order::Shifted;
    check(&drawing, opaque(RED), opaque(RED));
}

/// A strand that a surface hides doesn't hide others: they are compared after.
#[test]
fn a_dropped_strand_hides_nothing() {
    let mut near = [disc(10.0, 10.0, 4.0, 5.0)];
    near[0].inv_depth_biased = 1.0;
    let mut far = [disc(10.0, 10.0, 4.0, 4.0)];
    far[0].inv_depth_biased = 9.0;
    let mut drawing = strands([20, 20], &[(0, RED, &near), (1, BLUE, &far)]);
    drawing.surfaces = vec![Surface {
        texture: None,
        margin_m: 0.0,
        shadow: GREEN,
        ..square(2.0)
    }];
    for order in Order::ALL {
        drawing.order = order;
        assert_eq!(at(&drawing, 10, 10), opaque(BLUE));
    }
}

#[test]
fn shifted_compares_every_stroke_by_depth() {
    let mut drawing = clump_with(vec![
        layer("highlight", 2, GREEN, &wide(1.0)),
        layer("base", 0, RED, &wide(3.0)),
    ]);
    drawing.order = Order::Shifted;
    // The clump is not used.
    check(&drawing, opaque(RED), opaque(RED));
}

#[test]
fn shifted_breaks_ties_by_rank_layer_instance_before_the_strand() {
    let discs = [disc(10.0, 10.0, 4.0, 1.0)];
    let none = disc(0.0, 0.0, 0.0, 1.0);
    let mut drawing = strands([20, 20], &[(0, RED, &discs), (1, RED, &discs)]);
    drawing.order = Order::Shifted;
    // The second strand's higher layer lies over the first strand.
    drawing
        .layers
        .push(layer("cel", 0, BLUE, &[none, discs[0]]));
    assert_eq!(at(&drawing, 10, 10), opaque(BLUE));
    // A higher rank of the first strand lies over both, though its layer comes first.
    drawing
        .layers
        .insert(0, layer("highlight", 1, GREEN, &[discs[0], none]));
    assert_eq!(at(&drawing, 10, 10), opaque(GREEN));
}

fn any_disc() -> impl Strategy<Value = Disc> {
    (-8.0..40.0_f32, -8.0..32.0_f32, 0.0..6.0_f32, 0.5..2.0_f32)
        .prop_map(|(x, y, radius, inv_depth)| disc(x, y, (radius - 0.5).max(0.0), inv_depth))
}

fn any_layer(joints: usize) -> impl Strategy<Value = LayerStrokes> {
    (-2..3_i32, 1..3_usize, any::<bool>()).prop_flat_map(move |(rank, instances, is_flat)| {
        let count = joints * instances;
        let discs = proptest::collection::vec(any_disc(), count);
        let colors = proptest::collection::vec([0.0..1.0_f32, 0.0..1.0, 0.0..1.0], count);
        (discs, colors).prop_map(move |(discs, mut colors)| {
            if is_flat {
                colors.fill([0.5, 0.25, 0.125]);
            }
            LayerStrokes {
                name: String::new(),
                joints: 0..joints,
                rank,
                instances,
                stretches: Stretches::Everywhere,
                discs,
                colors,
            }
        })
    })
}

/// Three strands, the second of two runs, with up to five layers. Half of the drawings have clumps with sides; in half a layer draws
/// just what the clumps cover.
fn any_drawing() -> impl Strategy<Value = Drawing> {
    const JOINTS: usize = 12;
    let clump = proptest::collection::vec(any_disc(), JOINTS);
    let layers = proptest::collection::vec(any_layer(JOINTS), 1..4);
    let sides = proptest::collection::vec(any_disc(), 2 * JOINTS);
    let colors = proptest::collection::vec([0.0..1.0_f32, 0.0..1.0, 0.0..1.0], 3 * JOINTS);
    let options = (0..Order::ALL.len(), any::<[bool; 3]>());
    let parts = (clump, sides, colors, layers, options);
    parts.prop_map(
        |(clump, mut sides, mut colors, mut layers, (order, options))| {
            let [is_half, has_sides, has_base] = options;
            if !has_sides {
                sides.clear();
            }
            if has_base {
                let discs = [&clump[..], &sides].concat();
                colors.truncate(discs.len());
                layers.push(LayerStrokes {
                    name: String::new(),
                    joints: 0..JOINTS,
                    rank: 0,
                    instances: discs.len() / JOINTS,
                    stretches: Stretches::Everywhere,
                    discs,
                    colors,
                });
            }
            Drawing {
                size: [35, 27],
                runs: [(2, 0..4), (3, 4..7), (3, 7..8), (9, 8..12)]
                    .map(|(strand, joints)| Run { strand, joints })
                    .to_vec(),
                clump,
                sides,
                layers,
                order: Order::ALL[order],
                edge_depth_m: 0.3,
                brush: if is_half {
                    Brush::Semicircle
                } else {
                    Brush::Circle
                },
                ..Drawing::default()
            }
        },
    )
}

/// The lists without what has no size, but for the joints beside what has.
fn sparse(drawing: &Drawing) -> Drawing {
    let mut sparse = drawing.clone();
    let all = 0..drawing.clump.len();
    sparse.sides.clear();
    sparse.side_stretches = within(drawing, 2, &drawing.sides, |place| {
        sparse.sides.push(drawing.sides[place]);
    });
    for (layer, dense) in sparse.layers.iter_mut().zip(&drawing.layers) {
        assert_eq!(dense.joints, all);
        layer.discs.clear();
        layer.colors.clear();
        layer.stretches = within(drawing, dense.instances, &dense.discs, |place| {
            layer.discs.push(dense.discs[place]);
            layer.colors.push(dense.colors[place]);
        });
    }
    sparse
}

/// The stretches of strokes on all joints; `keep` is told the places of what they hold, one after the other.
fn within(
    drawing: &Drawing,
    strokes: usize,
    discs: &[Disc],
    mut keep: impl FnMut(usize),
) -> Stretches {
    let mut kept = 0;
    let mut lists = vec![Vec::new(); strokes];
    let of_strokes = discs.chunks(drawing.clump.len());
    for (stroke, (list, discs)) in lists.iter_mut().zip(of_strokes).enumerate() {
        for run in &drawing.runs {
            let has_size = |joint: usize| run.joints.contains(&joint) && discs[joint].radius > 0.0;
            for joint in run.joints.clone() {
                let is_kept = [joint.wrapping_sub(1), joint, joint + 1]
                    .map(has_size)
                    .contains(&true);
                if !is_kept {
                    continue;
                }
                keep(stroke * discs.len() + joint);
                match list.last_mut() {
                    Some(Stretch { joints, .. }) if joints.end == joint => joints.end += 1,
                    _ => list.push(Stretch {
                        joints: joint..joint + 1,
                        first: kept,
                    }),
                }
                kept += 1;
            }
        }
    }
    Stretches::Within(lists)
}

/// Strokes of the first layer by a crayon.
fn crayon(drawing: &Drawing) -> Brushwork {
    let section = BrushSection {
        kind: Tool::Crayon,
        ..BrushSection::default()
    };
    let along = |joint: usize| AlongStrand {
        s: 0.1 * joint as f32,
        whole: 0.1 * drawing.clump.len() as f32,
        pixels: 40.0,
        strand: 1,
    };
    Brushwork {
        layers: vec![BrushedLayer {
            layer: 0,
            brush: Arc::new(BrushTexture::of_tool(&section).unwrap()),
            seed: 7,
        }],
        joints: (0..drawing.clump.len()).map(along).collect(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn what_has_no_size_need_not_be_listed(drawing in any_drawing()) {
        prop_assert_eq!(draw(&sparse(&drawing), 4), draw(&drawing, 4));
    }

    /// But for samples on an edge, and where two depths are closer than rounding.
    #[test]
    fn agrees_with_the_rules_written_down_sample_by_sample(drawing in any_drawing()) {
        let (tiled, plain) = (draw(&drawing, 4), reference::draw(&drawing, 4));
        let differing = tiled
            .pixels
            .iter()
            .zip(&plain.pixels)
            .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 1e-3))
            .count();
        prop_assert!(differing <= 3, "{differing} pixels differ");
    }

    #[test]
    fn instructions_change_no_bit(mut drawing in any_drawing(), has_brush: bool) {
        drawing.surfaces = vec![square(1.0)];
        if has_brush {
            drawing.brushwork = crayon(&drawing);
        }
        let mut rasterizer = Rasterizer::new(5, Some(1)).unwrap();
        let mut pictures = Instructions::available().into_iter().map(|instructions| {
            rasterizer.frames.instructions = instructions;
            rasterizer.draw(&drawing).unwrap()
        });
        let first = pictures.next().unwrap();
        for picture in pictures {
            prop_assert!(picture == first);
        }
    }

    #[test]
    fn threads_change_no_bit(drawing in any_drawing()) {
        let with = |threads| Rasterizer::new(3, Some(threads)).unwrap().draw(&drawing).unwrap();
        let one = with(1);
        prop_assert_eq!(&one, &with(2));
        prop_assert_eq!(&one, &with(8));
    }

    /// The order of the joints' list and the memory of earlier pictures don't matter either.
    #[test]
    fn neither_the_joints_place_nor_earlier_pictures_change_a_bit(
        drawing in any_drawing(),
        earlier in any_drawing(),
    ) {
        let mut moved = drawing.clone();
        let joints = moved.clump.len();
        moved.clump.rotate_right(4);
        for side in moved.sides.chunks_mut(joints) {
            side.rotate_right(4);
        }
        for layer in &mut moved.layers {
            for instance in layer.discs.chunks_mut(joints) {
                instance.rotate_right(4);
            }
            for instance in layer.colors.chunks_mut(joints) {
                instance.rotate_right(4);
            }
        }
        moved.runs = [(2, 4..8), (3, 8..11), (3, 11..12), (9, 0..4)]
            .map(|(strand, joints)| Run { strand, joints })
            .to_vec();
        let mut rasterizer = Rasterizer::new(4, Some(2)).unwrap();
        rasterizer.draw(&earlier).unwrap();
        prop_assert_eq!(rasterizer.draw(&moved).unwrap(), draw(&drawing, 4));
    }
}
