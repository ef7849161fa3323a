//! Random drawings with everything that a drawing may hold.

use glam::Vec2;
use proptest::collection::vec;
use proptest::prelude::*;
use render::{
    Brush, Decal, Disc, Drawing, LayerStrokes, Order, Run, Stretches, Surface, SurfaceVertex,
};

fn disc_around(extent: f32) -> impl Strategy<Value = Disc> {
    let coordinate =
        move || prop_oneof![8 => -6.0..extent + 6.0, 1 => -300.0..300.0f32, 1 => -3e4..3e4f32];
    let radius =
        prop_oneof![2 => Just(0.0f32), 4 => 0.0..1.0f32, 4 => 1.0..12.0f32, 1 => 12.0..80.0f32];
    let depth = || prop_oneof![Just(1.0f32), Just(2.0f32), 0.5..3.0f32];
    (coordinate(), coordinate(), radius, depth(), depth()).prop_map(
        |(x, y, radius, inv_depth, inv_depth_biased)| Disc {
            center: Vec2::new(x, y),
            radius,
            inv_depth,
            inv_depth_biased,
        },
    )
}

/// Discs of consecutive joints: unrelated, at one place (a strand that points at the eye), or in
/// small steps.
fn path(extent: f32, joints: usize) -> impl Strategy<Value = Vec<Disc>> {
    let step = prop_oneof![
        2 => Just(f32::NAN),
        1 => Just(0.0f32),
        1 => Just(0.02f32),
        2 => Just(0.2f32),
    ];
    (vec(disc_around(extent), joints), step).prop_map(|(mut discs, step)| {
        if !step.is_nan() {
            for joint in 1..discs.len() {
                let before = discs[joint - 1].center;
                discs[joint].center = before + step * (discs[joint].center - before);
            }
        }
        discs
    })
}

fn color() -> impl Strategy<Value = [f32; 3]> {
    prop::array::uniform3(0.0..1.0f32)
}

fn surface(extent: f32) -> impl Strategy<Value = Surface> {
    let coordinate = || -10.0..extent + 10.0;
    let vertex = (coordinate(), coordinate(), 0.5..3.0f32, -1.0..1.0f32).prop_map(
        |(x, y, inv_depth, tone)| SurfaceVertex {
            position: Vec2::new(x, y),
            inv_depth,
            tone,
        },
    );
    (
        vec(vertex, 4),
        vec(prop::array::uniform3(0..4u32), 0..4),
        prop_oneof![Just(0.0), 0.01..0.5f32, -0.2..-0.01f32],
        color(),
        color(),
    )
        .prop_map(|(vertices, triangles, margin_m, light, shadow)| Surface {
            texture: None,
            margin_m,
            mesh: 1,
            paint: None,
            marks: margin_mark(margin_m),
            vertices,
            triangles,
            light,
            shadow,
        })
}

/// A mark of its own for surfaces without a margin.
fn margin_mark(margin_m: f32) -> u32 {
    if margin_m == 0.0 { 1 } else { 2 }
}

/// A layer over `clump`: its discs follow the clump's, or are anywhere.
fn layer(extent: f32, clump: Vec<Disc>) -> impl Strategy<Value = LayerStrokes> {
    (-2..3i32, 0..3usize, any::<bool>()).prop_flat_map(move |(rank, instances, follows)| {
        let clump = clump.clone();
        let number = clump.len() * instances;
        (
            path(extent, number),
            vec(color(), number),
            prop::array::uniform3(-1.0..1.0f32),
        )
            .prop_map(move |(mut discs, colors, [x, y, z])| {
                if follows {
                    for (index, disc) in discs.iter_mut().enumerate() {
                        let joint = clump[index % clump.len()];
                        disc.center = joint.center + Vec2::new(x, y);
                        disc.radius = joint.radius * (1.0 + 0.5 * z);
                        disc.inv_depth = joint.inv_depth - 0.1 * z;
                        disc.inv_depth_biased = joint.inv_depth_biased - 0.1 * z;
                    }
                }
                LayerStrokes {
                    name: String::new(),
                    joints: 0..clump.len(),
                    rank,
                    instances,
                    stretches: Stretches::Everywhere,
                    discs,
                    colors,
                }
            })
    })
}

/// A layer without its strokes before the share `from` of the runs, if that is below 1, and without those behind the share `to`.
fn on_some_runs(layer: LayerStrokes, runs: &[Run], [from, to]: [f32; 2]) -> LayerStrokes {
    let run = |share: f32| &runs[((share * runs.len() as f32) as usize).min(runs.len() - 1)];
    let all = layer.joints.len();
    let start = if from < 1.0 {
        run(from).joints.start
    } else {
        0
    };
    let end = if to < 1.0 { run(to).joints.end } else { all };
    let joints = start..end.max(start);
    let kept = (0..layer.instances * all).filter(|index| joints.contains(&(index % all)));
    LayerStrokes {
        discs: kept.clone().map(|index| layer.discs[index]).collect(),
        colors: kept.map(|index| layer.colors[index]).collect(),
        joints: joints.clone(),
        ..layer
    }
}

/// What a layer may be as a decal, and how that is mostly none.
fn decal() -> impl Strategy<Value = Option<Decal>> {
    let decal = (any::<bool>(), 0..4u32, 0.0..1.0f32, any::<bool>());
    let decal = decal.prop_map(|(on_hair, marks, reach_m, is_shadow)| Decal {
        layer: 0,
        on_hair,
        marks,
        reach_m,
        is_shadow,
    });
    prop_oneof![2 => Just(None), 1 => decal.prop_map(Some)]
}

/// Everything a drawing may hold, small.
pub fn drawing() -> impl Strategy<Value = Drawing> {
    let extent = 40.0;
    // For each strand the numbers of joints of its runs.
    let strands = vec(vec(1..5usize, 1..3), 1..5);
    let clump = strands.prop_flat_map(move |strands| {
        let joints = strands.iter().flatten().sum();
        (Just(strands), path(extent, joints))
    });
    let strokes = clump.prop_flat_map(move |(strands, clump)| {
        (
            Just(strands),
            Just(clump.clone()),
            vec((layer(extent, clump), 0.0..3.0f32, 0.0..3.0f32), 1..5),
        )
    });
    let order = prop_oneof![
        (0.0..0.5f32).prop_map(|depth_m| (Order::Rounded, depth_m)),
        Just((Order::StrandFirst, 0.0)),
        Just((Order::Shifted, 0.0)),
    ];
    let brush = prop_oneof![Just(Brush::Circle), Just(Brush::Semicircle)];
    let background = prop::option::of(color());
    (
        strokes,
        (vec(surface(extent), 0..3), vec(decal(), 5)),
        (order, brush, any::<bool>()),
        background,
        30..40u32,
        30..40u32,
    )
        .prop_map(
            |(
                (strands, mut clump, mut layers),
                (surfaces, decals),
                ((order, edge_depth_m), brush, has_sides),
                background,
                width,
                height,
            )| {
                let mut runs = Vec::new();
                let mut start = 0;
                for (index, pieces) in (0..).zip(strands) {
                    for joints in pieces {
                        runs.push(Run {
                            strand: 3 * index,
                            joints: start..start + joints,
                        });
                        start += joints;
                    }
                }
                if order == Order::Rounded {
                    // Strands of equal depth are told apart by r^8 alone, which f32 takes for 0 near
                    // their middles.
                    let joints = clump.len();
                    let strand_of = |joint: usize| {
                        let run = runs.iter().find(|run: &&Run| run.joints.contains(&joint));
                        run.map_or(0, |run| run.strand)
                    };
                    let discs = (layers.iter_mut()).flat_map(|(layer, ..)| &mut layer.discs);
                    for (index, disc) in clump.iter_mut().enumerate().chain(discs.enumerate()) {
                        disc.inv_depth += 1e-3 * strand_of(index % joints) as f32;
                    }
                }
                let some = |(layer, from, to)| on_some_runs(layer, &runs, [from, to]);
                let layers: Vec<LayerStrokes> = layers.into_iter().map(some).collect();
                let beside = |side: f32| {
                    clump.iter().map(move |disc| Disc {
                        center: disc.center + side * Vec2::new(4.0, 3.0),
                        radius: 0.6 * disc.radius,
                        ..*disc
                    })
                };
                let sides = if has_sides {
                    beside(-1.0).chain(beside(1.0)).collect()
                } else {
                    Vec::new()
                };
                let decals = decals.into_iter().take(layers.len()).enumerate();
                let decals = decals.filter_map(|(layer, decal)| Some(Decal { layer, ..decal? }));
                Drawing {
                    decals: decals.collect(),
                    // The first two strands are pieces of one.
                    same_strands: vec![0; 4],
                    size: [width, height],
                    runs,
                    clump,
                    sides,
                    side_stretches: Stretches::Everywhere,
                    layers,
                    surfaces,
                    background,
                    order,
                    edge_depth_m,
                    brush,
                    ..Drawing::default()
                }
            },
        )
}
