//! Drawings that are none, and drawings that hardly are.

use super::texture::two_texels;
use super::*;
use crate::drawing::{Coverage, SurfaceTexture};
use proptest::prelude::*;

fn error(drawing: &Drawing) -> DrawError {
    Rasterizer::new(1, Some(1))
        .unwrap()
        .draw(drawing)
        .unwrap_err()
}

fn good() -> Drawing {
    let discs = [disc(5.0, 5.0, 3.0, 1.0), disc(7.0, 5.0, 3.0, 1.0)];
    let mut drawing = strands([10, 10], &[(1, RED, &discs), (4, BLUE, &discs)]);
    drawing.surfaces = vec![square(0.5)];
    drawing
}

/// The error after one change to a good drawing.
fn after(change: impl FnOnce(&mut Drawing)) -> DrawError {
    let mut drawing = good();
    change(&mut drawing);
    error(&drawing)
}

#[test]
fn sizes_out_of_range_are_errors() {
    for size in [[0, 10], [10, 0], [16385, 1], [u32::MAX, u32::MAX]] {
        assert_eq!(after(|d| d.size = size), DrawError::Size(size[0], size[1]));
    }
}

#[test]
fn runs_must_be_sorted_and_have_their_own_joints() {
    let order = after(|d| d.runs.swap(0, 1));
    assert_eq!(
        order,
        DrawError::RunOrder {
            run: 1,
            strand: 1,
            before: 4
        }
    );
    for (start, end) in [(1, 1), (3, 5), (0, usize::MAX), (usize::MAX, 0)] {
        let joints = start..end;
        let expected = DrawError::RunJoints {
            run: 1,
            start,
            end,
            joints: 4,
        };
        assert_eq!(after(|d| d.runs[1].joints = joints), expected);
    }
    let shared = after(|d| d.runs[1].joints = 1..4);
    assert_eq!(shared, DrawError::SharedJoints { runs: 5, joints: 4 });
}

#[test]
fn layers_draw_on_whole_runs() {
    let on = |joints: Range<usize>| {
        after(|d| {
            d.runs[1].joints = 1..4;
            d.runs[0].joints = 0..1;
            d.layers[0].joints = joints;
        })
    };
    for (start, end) in [(0, 2), (2, 4), (0, 5), (3, 1), (usize::MAX, usize::MAX)] {
        let joints = Range { start, end };
        assert!(matches!(
            on(joints),
            DrawError::LayerJoints { joints: 4, .. }
        ));
    }
    // Whole runs, whose lists are still as long as those of all.
    assert!(matches!(on(1..4), DrawError::LayerLength { joints: 3, .. }));
}

#[test]
fn layers_must_fit_their_joints() {
    let is_length = |error| matches!(error, DrawError::LayerLength { .. });
    assert!(is_length(after(|d| d.layers[0].instances = 2)));
    assert!(is_length(after(|d| d.layers[0].instances = usize::MAX)));
    assert!(is_length(after(|d| d.layers[0].colors.truncate(3))));
    assert!(is_length(after(|d| d.layers[0].discs.truncate(3))));
    let text = after(|d| d.layers[0].instances = 2).to_string();
    assert_eq!(
        text,
        "layer \"base\": 4 discs and 4 colours for 2 instances of 4 joints"
    );
}

#[test]
fn stretches_must_be_there() {
    let within = |stretches: &[(Range<usize>, usize)]| {
        let stretches = stretches.iter().cloned();
        let list = stretches.map(|(joints, first)| Stretch { joints, first });
        let list: Vec<Stretch> = list.collect();
        after(move |d| d.layers[0].stretches = Stretches::Within(vec![list]))
    };
    let bad: [&[(Range<usize>, usize)]; 6] = [
        &[(0..5, 0)],
        &[(1..3, 3)],
        &[(0..2, usize::MAX)],
        &[(2..2, 0)],
        &[(0..2, 0), (1..3, 2)],
        &[(2..3, 0), (0..1, 2)],
    ];
    for list in bad {
        assert!(
            matches!(within(list), DrawError::Stretch { .. }),
            "{list:?}"
        );
    }
    assert_eq!(
        within(&[(1..3, 3)]).to_string(),
        "layer \"base\", stroke 0: the joints 1..3 with discs from 3 on are no stretch of joints 0 to 4 with 4 discs, behind the one before"
    );
    let lists = after(|d| d.layers[0].stretches = Stretches::Within(Vec::new()));
    assert_eq!(
        lists.to_string(),
        "layer \"base\": there are stretches for 0 strokes, of 1"
    );
    let sides = after(|d| {
        d.sides = d.clump.clone();
        let list = vec![Stretch {
            joints: 3..5,
            first: 0,
        }];
        d.side_stretches = Stretches::Within(vec![list, Vec::new()]);
    });
    assert!(matches!(sides, DrawError::Stretch { of, .. } if of == "the clump's sides"));
    let disc = after(|d| {
        let list = vec![Stretch {
            joints: 2..4,
            first: 1,
        }];
        d.layers[0].stretches = Stretches::Within(vec![list]);
        d.layers[0].discs[2].radius = f32::NAN;
    });
    assert!(matches!(disc, DrawError::LayerDisc { joint: 3, .. }));
}

#[test]
fn sides_are_two_a_joint() {
    let text = after(|d| d.sides = d.clump.clone()).to_string();
    assert_eq!(
        text,
        "there are 4 discs at the clump's sides: there must be none, or two a joint (4 joints)"
    );
}

#[test]
fn numbers_must_be_numbers() {
    for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY] {
        let clump = |error| matches!(error, DrawError::ClumpDisc { joint: 2, .. });
        assert!(clump(after(|d| d.clump[2].center.x = bad)));
        assert!(clump(after(|d| d.clump[2].center.y = bad)));
        assert!(clump(after(|d| d.clump[2].radius = bad)));
        assert!(clump(after(|d| d.clump[2].inv_depth = bad)));
        assert!(clump(after(|d| d.clump[2].inv_depth_biased = bad)));
        assert!(clump(after(|d| {
            d.sides = [&d.clump[..], &d.clump[..]].concat();
            d.sides[4 + 2].radius = bad;
        })));
        let disc = |error| {
            matches!(
                error,
                DrawError::LayerDisc {
                    joint: 3,
                    instance: 0,
                    ..
                }
            )
        };
        assert!(disc(after(|d| d.layers[0].discs[3].radius = bad)));
        let color = |error| matches!(error, DrawError::LayerColor { joint: 1, .. });
        assert!(color(after(|d| d.layers[0].colors[1][2] = bad)));
        assert_eq!(
            after(|d| d.background = Some([0.0, bad, 0.0])),
            DrawError::Background
        );
        let vertex = DrawError::Vertex {
            surface: 0,
            vertex: 1,
        };
        assert_eq!(
            after(|d| d.surfaces[0].vertices[1].position.x = bad),
            vertex
        );
        assert_eq!(after(|d| d.surfaces[0].vertices[1].inv_depth = bad), vertex);
        assert_eq!(after(|d| d.surfaces[0].vertices[1].tone = bad), vertex);
        let surface = DrawError::SurfaceColor { surface: 0 };
        assert_eq!(after(|d| d.surfaces[0].shadow[0] = bad), surface);
    }
    assert!(matches!(
        after(|d| d.clump[0].radius = -0.1),
        DrawError::ClumpDisc { .. }
    ));
    assert!(matches!(
        after(|d| d.clump[0].center.x = 2e9),
        DrawError::ClumpDisc { .. }
    ));
    let far = after(|d| d.surfaces[0].vertices[2].position.y = 2e9);
    assert_eq!(
        far,
        DrawError::Vertex {
            surface: 0,
            vertex: 2
        }
    );
}

#[test]
fn triangles_need_their_corners() {
    let expected = DrawError::TriangleIndex {
        surface: 0,
        triangle: 1,
        vertex: 4,
        vertices: 4,
    };
    assert_eq!(after(|d| d.surfaces[0].triangles[1] = [0, 4, 1]), expected);
}

#[test]
fn nothing_makes_an_empty_picture() {
    let mut drawing = Drawing {
        size: [3, 2],
        ..Drawing::default()
    };
    assert_eq!(draw(&drawing, 4).pixels, vec![NONE; 6]);
    // Without joints any number of instances is consistent.
    drawing.layers = vec![LayerStrokes {
        instances: usize::MAX,
        stretches: Stretches::Everywhere,
        ..layer("", 0, RED, &[])
    }];
    drawing.background = Some(GREEN);
    assert_eq!(draw(&drawing, 4).pixels, vec![opaque(GREEN); 6]);
}

/// Numbers as they come, and those at the ends of the range.
fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -20.0..40.0_f32,
        1 => -1e6..1e6_f32,
        1 => prop::sample::select(vec![0.0, -0.0, 5.5, 1e9, -1e9, 1e-30, f32::MIN_POSITIVE, 1e-42]),
    ]
}

fn any_disc() -> impl Strategy<Value = Disc> {
    let depth = prop_oneof![any_number(), Just(f32::MAX), Just(f32::MIN)];
    (
        any_number(),
        any_number(),
        any_number(),
        depth,
        any_number(),
    )
        .prop_map(|(x, y, radius, inv_depth, inv_depth_biased)| Disc {
            center: Vec2::new(x, y),
            radius: radius.abs(),
            inv_depth,
            inv_depth_biased,
        })
}

fn any_surface() -> impl Strategy<Value = Surface> {
    let corner = (any_number(), any_number(), any_number(), any_number())
        .prop_map(|(x, y, inv_depth, tone)| vertex(x, y, inv_depth, tone));
    let triangles = proptest::collection::vec([0..5_u32, 0..5, 0..5], 0..4);
    let place = (-1e4..=1e4_f32, any_number()).prop_map(|(x, y)| Vec2::new(x, y.clamp(-1e4, 1e4)));
    let places = proptest::option::of(proptest::collection::vec(place, 5));
    (proptest::collection::vec(corner, 5), triangles, places).prop_map(
        |(vertices, triangles, places)| Surface {
            texture: places.map(|places| SurfaceTexture {
                image: two_texels([0, 0, 0, 0], [65535; 4]),
                repeats: triangles.len() == 2,
                places,
                coverage: if triangles.len() == 3 {
                    Coverage::Share
                } else {
                    Coverage::Cut(0.5)
                },
            }),
            margin_m: if triangles.len() == 1 { f32::MAX } else { 0.0 },
            mesh: 0,
            paint: None,
            marks: 0,
            vertices,
            triangles,
            light: RED,
            shadow: BLUE,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn extreme_drawings_make_pictures(
        clump in proptest::collection::vec(any_disc(), 6),
        discs in proptest::collection::vec(any_disc(), 12),
        colors in proptest::collection::vec([any_number(), any_number(), any_number()], 12),
        surface in any_surface(),
        rank in -1..2_i32,
        order in 0..Order::ALL.len(),
        size in [1..40_u32, 1..40],
    ) {
        let drawing = Drawing {
            size,
            runs: vec![Run { strand: 0, joints: 0..1 }, Run { strand: 7, joints: 1..6 }],
            clump,
            sides: discs.clone(),
            side_stretches: Stretches::Everywhere,
            layers: vec![LayerStrokes { name: String::new(), joints: 0..6, rank, instances: 2, stretches: Stretches::Everywhere, discs, colors }],
            surfaces: vec![surface],
            background: None,
            order: Order::ALL[order],
            edge_depth_m: 1e30,
            brush: Brush::default(),
            ..Drawing::default()
        };
        let picture = draw(&drawing, 2);
        prop_assert_eq!(picture.pixels.len(), (size[0] * size[1]) as usize);
        for channel in picture.pixels.iter().flatten() {
            prop_assert!((0.0..=1.0).contains(channel), "{channel}");
        }
        prop_assert_eq!(picture.to_srgb8().len(), 4 * picture.pixels.len());
    }
}
