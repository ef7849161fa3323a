//! Layers that are drawn on what is seen without them: where they show, what shadows do to surfaces, and what is refused. That they are the
//! reference's in any drawing is held by `rasteriser`.

use effects::preset::Reader;
use effects::{BrushSection, BrushTexture, Fit, Image, Layer, Registry};
use glam::{Vec2, Vec3};
use render::cpu::Rasterizer;
use render::{
    AlongStrand, BrushedLayer, Brushwork, Coverage, Decal, Disc, DrawError, Drawing, Head,
    LayerStrokes, Light, MeshLayer, MeshPainting, Order, PaintedLayer, PaintedMeshes, Run, Seen,
    Stretches, Surface, SurfacePaint, SurfaceTexture, SurfaceVertex,
};
use std::ops::Range;
use std::sync::Arc;
use stroke_path::{Camera, OrbitView};

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const WALL: [f32; 3] = [0.5, 0.5, 1.0];
const DARK_WALL: [f32; 3] = [0.25, 0.125, 0.5];
const BLACK: [f32; 3] = [0.0; 3];

/// The mark of the wall.
const MARK: u32 = 4;

/// A bar from the left to the right at that height, 10 pixels wide, so many metres away.
fn bar(y: f32, depth_m: f32) -> [Disc; 2] {
    [-20.0, 60.0].map(|x| Disc {
        center: Vec2::new(x, y),
        radius: 5.0,
        inv_depth: 1.0 / depth_m,
        inv_depth_biased: 1.0 / depth_m,
    })
}

fn layer(joints: Range<usize>, rank: i32, discs: &[Disc], color: [f32; 3]) -> LayerStrokes {
    LayerStrokes {
        name: "layer".to_owned(),
        rank,
        instances: 1,
        stretches: Stretches::Everywhere,
        discs: discs.to_vec(),
        colors: vec![color; joints.len()],
        joints,
    }
}

/// Red hair at y = 20, 2 m away, before half a wall at 2.5 m (x up to 20), and nothing else. A second strand, which is drawn as the green decal
/// alone, lies at `y`, so many metres away.
fn drawing(y: f32, depth_m: f32, decal: &Decal) -> Drawing {
    let corner = |x: f32, y: f32| SurfaceVertex {
        position: Vec2::new(x, y),
        inv_depth: 0.4,
        tone: 1.0,
    };
    let hair = bar(20.0, 2.0);
    let over = bar(y, depth_m);
    let runs = [0, 1].map(|strand| Run {
        strand,
        joints: 2 * strand as usize..2 * strand as usize + 2,
    });
    Drawing {
        size: [40, 40],
        runs: runs.to_vec(),
        clump: [hair, over].concat(),
        layers: vec![layer(0..2, 0, &hair, RED), layer(2..4, -3, &over, GREEN)],
        surfaces: vec![Surface {
            vertices: vec![
                corner(-10.0, -10.0),
                corner(20.0, -10.0),
                corner(20.0, 50.0),
                corner(-10.0, 50.0),
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            light: WALL,
            shadow: DARK_WALL,
            marks: MARK | 1,
            ..Surface::default()
        }],
        decals: vec![decal.clone()],
        background: Some(BLACK),
        ..Drawing::default()
    }
}

const ON_HAIR: Decal = Decal {
    layer: 1,
    on_hair: true,
    marks: 0,
    reach_m: 0.25,
    is_shadow: false,
};

const ON_WALL: Decal = Decal {
    on_hair: false,
    marks: MARK,
    ..ON_HAIR
};

const SHADOW: Decal = Decal {
    marks: MARK,
    is_shadow: true,
    ..ON_HAIR
};

/// The pixels at some places in one column over the wall, and one beside it: the same for any number of samples and threads, and in any order of
/// strokes.
fn columns(drawing: &Drawing, places: [usize; 3]) -> [[[f32; 3]; 3]; 2] {
    let mut all = Vec::new();
    for order in Order::ALL {
        for samples in [1, 2, 4, 5] {
            let drawing = Drawing {
                order,
                edge_depth_m: 0.01,
                ..drawing.clone()
            };
            let picture = |threads| {
                let mut rasterizer = Rasterizer::new(samples, Some(threads)).unwrap();
                rasterizer.draw(&drawing).unwrap()
            };
            assert_eq!(picture(1), picture(3));
            let pixel = |x: usize, y: usize| {
                let [red, green, blue, _] = picture(2).pixels[y * 40 + x];
                [red, green, blue].map(|value| (value * 1024.0).round() / 1024.0)
            };
            all.push([8, 30].map(|x| places.map(|y| pixel(x, y))));
        }
    }
    assert!(all.iter().all(|columns| *columns == all[0]), "{all:?}");
    all[0]
}

#[test]
fn a_decal_shows_on_its_target_alone() {
    // Half over the hair, half over the wall, at the hair's depth: y = 25 is its middle.
    let [wall, beside] = columns(&drawing(25.0, 2.1, &ON_HAIR), [18, 22, 28]);
    assert_eq!(wall, [RED, GREEN, WALL]);
    assert_eq!(beside, [RED, GREEN, BLACK]);
    let [wall, beside] = columns(&drawing(25.0, 2.4, &ON_WALL), [18, 22, 28]);
    assert_eq!(wall, [RED, RED, GREEN]);
    assert_eq!(beside, [RED, RED, BLACK]);
    let both = Decal {
        marks: MARK,
        reach_m: 0.5,
        ..ON_HAIR
    };
    let [wall, beside] = columns(&drawing(25.0, 2.25, &both), [18, 22, 28]);
    assert_eq!(wall, [RED, GREEN, GREEN]);
    assert_eq!(beside, [RED, GREEN, BLACK]);
    // Another's mark.
    let other = Decal {
        marks: 2,
        ..ON_WALL
    };
    let [wall, _] = columns(&drawing(25.0, 2.4, &other), [18, 22, 28]);
    assert_eq!(wall, [RED, RED, WALL]);
}

#[test]
fn a_decal_shows_as_far_before_and_behind_its_target_as_it_reaches() {
    // As far as half its reach in every sample.
    for (depth_m, expected) in [
        (1.74, RED),
        (1.88, GREEN),
        (2.0, GREEN),
        (2.12, GREEN),
        (2.26, RED),
    ] {
        let [_, [hair, ..]] = columns(&drawing(25.0, depth_m, &ON_HAIR), [22, 22, 22]);
        assert_eq!(hair, expected, "{depth_m}");
    }
    for (depth_m, expected) in [(2.24, WALL), (2.38, GREEN), (2.62, GREEN), (2.76, WALL)] {
        let [[.., wall], _] = columns(&drawing(25.0, depth_m, &ON_WALL), [18, 22, 28]);
        assert_eq!(wall, expected, "{depth_m}");
    }
}

#[test]
fn a_decal_fades_on_its_way_out_of_reach() {
    // How much of a pixel in the middle of the hair it takes: nothing jumps by more than one of 64 samples.
    let green = |depth_m: f32| {
        let mut rasterizer = Rasterizer::new(64, Some(1)).unwrap();
        let picture = rasterizer.draw(&drawing(25.0, depth_m, &ON_HAIR)).unwrap();
        picture.pixels[22 * 40 + 8][1]
    };
    let mut before = green(2.1);
    assert_eq!(before, 1.0);
    for step in 1..=80 {
        let now = green(2.1 + 0.002 * step as f32);
        assert!(
            (0.0..=0.05).contains(&(before - now)),
            "{step}: {before} {now}"
        );
        before = now;
    }
    assert_eq!(before, 0.0);
}

/// Where a stroke turns back in one joint, both its segments are as near to what lies beyond, and see it on other sides: rounding must not choose
/// between them.
#[test]
fn a_brush_beyond_a_joint_that_turns_back_is_in_one_piece() {
    let disc = |x, y| Disc {
        center: Vec2::new(x, y),
        radius: 9.0,
        inv_depth: 0.5,
        inv_depth_biased: 0.5,
    };
    let joints = [[3.3, 20.1], [22.7, 21.9], [4.9, 24.3]].map(|[x, y]| disc(x, y));
    let mut drawing = drawing(20.0, 2.0, &ON_HAIR);
    drawing.runs[1].joints = 2..5;
    drawing.clump.truncate(2);
    drawing.clump.extend(joints);
    drawing.layers[1] = layer(2..5, -3, &joints, GREEN);
    // One half of the stroke, from its axis to an edge.
    let image = Image::of_coverage([1, 2], &[1.0, 0.0]).unwrap();
    let section = BrushSection {
        fit: Some(Fit::Stretch),
        ..BrushSection::default()
    };
    let brush = Arc::new(BrushTexture::of_picture(&section, &image).unwrap());
    let along = |s| AlongStrand {
        s,
        whole: 1.0,
        pixels: 40.0,
        strand: 1,
    };
    drawing.brushwork = Brushwork {
        layers: vec![BrushedLayer {
            layer: 1,
            brush,
            seed: 1,
        }],
        joints: [0.0, 1.0, 0.0, 0.5, 1.0].map(along).to_vec(),
    };
    let picture = Rasterizer::new(1, Some(1)).unwrap().draw(&drawing).unwrap();
    // Of pixels beyond the joint how many are green on each side of the way to it, and of how many.
    let [start, joint, end] = joints.map(|disc| disc.center);
    let mut green = [(0, 0); 2];
    for y in 16..25 {
        for x in 23..32 {
            let from = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - joint;
            let is_beyond = from.dot(start - joint) < 0.0 && from.dot(end - joint) < 0.0;
            let side = (joint - start).normalize().perp_dot(from);
            if is_beyond && from.length() < 8.5 && side.abs() > 1.0 {
                let (count, all) = &mut green[usize::from(side > 0.0)];
                *count += usize::from(picture.pixels[y * 40 + x][1] > 0.5);
                *all += 1;
            }
        }
    }
    assert!(green.iter().all(|(_, all)| *all > 10), "{green:?}");
    let is_whole = |side: usize| green[side] == (green[side].1, green[side].1);
    assert!(is_whole(0) != is_whole(1), "{green:?}");
    assert!(green.iter().any(|(count, _)| *count == 0), "{green:?}");
}

#[test]
fn what_is_drawn_nowhere_leaves_no_trace() {
    let nowhere = Decal {
        on_hair: false,
        ..ON_HAIR
    };
    let with = drawing(25.0, 2.0, &nowhere);
    let mut without = with.clone();
    without.layers.truncate(1);
    without.decals.clear();
    for samples in [1, 4, 8] {
        let mut rasterizer = Rasterizer::new(samples, Some(2)).unwrap();
        let pictures = [&with, &without].map(|drawing| rasterizer.draw(drawing).unwrap());
        assert_eq!(pictures[0], pictures[1]);
    }
}

#[test]
fn the_highest_stroke_shows_then_the_lowest_strand_and_what_does_not_fit_hides_nothing() {
    let blue = [0.0, 0.0, 1.0];
    let mut drawing = drawing(25.0, 2.1, &ON_HAIR);
    let high = bar(25.0, 2.05);
    drawing.layers.push(layer(2..4, -2, &high, blue));
    let decal = |reach_m| Decal {
        layer: 2,
        reach_m,
        ..ON_HAIR
    };
    drawing.decals.push(decal(0.25));
    let [_, [_, middle, _]] = columns(&drawing, [18, 22, 28]);
    assert_eq!(middle, blue);
    // Out of its reach the lower one shows, though the higher one covers it.
    drawing.decals[1] = decal(0.01);
    let [_, [_, middle, _]] = columns(&drawing, [18, 22, 28]);
    assert_eq!(middle, GREEN);
    // The same layer on the first strand too, which lies over the other one.
    drawing.layers[2].joints = 0..4;
    drawing.layers[2].discs = [high, high].concat();
    drawing.layers[2].colors = [[WALL; 2], [blue; 2]].concat();
    drawing.decals[1] = decal(0.25);
    let [_, [_, middle, _]] = columns(&drawing, [18, 22, 28]);
    assert_eq!(middle, WALL);
}

#[test]
fn a_shadow_falls_on_what_is_behind_it_in_that_ones_own_shadow_colour() {
    // Any way behind, and before it as far as it reaches.
    for (depth_m, expected) in [(0.5, DARK_WALL), (2.74, DARK_WALL), (2.76, WALL)] {
        let [[.., wall], [.., nothing]] = columns(&drawing(25.0, depth_m, &SHADOW), [18, 22, 28]);
        assert_eq!((wall, nothing), (expected, BLACK), "{depth_m}");
    }
    // On hair only where that lies behind by more than it reaches.
    for (depth_m, expected) in [(0.5, GREEN), (1.74, GREEN), (1.76, RED), (2.3, RED)] {
        let [_, [_, hair, _]] = columns(&drawing(25.0, depth_m, &SHADOW), [18, 22, 28]);
        assert_eq!(hair, expected, "{depth_m}");
    }
}

#[test]
fn outlines_keep_their_ink_in_the_shadow() {
    let places = [18, 22, 28];
    let mut drawing = drawing(25.0, 1.6, &SHADOW);
    let filled = columns(&drawing, places);
    drawing.layers[0].rank = -4; // below the decal all the same
    let outlined = columns(&drawing, places);
    for (filled, outlined) in filled.iter().zip(&outlined) {
        assert_eq!([filled[0], filled[1]], [RED, GREEN]);
        assert_eq!([outlined[0], outlined[1]], [RED, RED]);
        assert_eq!(filled[2], outlined[2]);
    }
}

#[test]
fn no_strand_casts_a_shadow_on_itself_whatever_its_pieces() {
    let mut drawing = drawing(25.0, 1.0, &SHADOW);
    drawing.same_strands = vec![0, 1];
    let [_, [_, other, _]] = columns(&drawing, [18, 22, 28]);
    assert_eq!(other, GREEN);
    drawing.same_strands = vec![1, 1];
    let [[.., wall], [_, own, _]] = columns(&drawing, [18, 22, 28]);
    assert_eq!((wall, own), (DARK_WALL, RED));
}

#[test]
fn a_picture_on_a_surface_goes_on_in_the_shadow() {
    let mut drawing = drawing(25.0, 1.0, &SHADOW);
    let texel = [u16::MAX, u16::MAX, 0, u16::MAX];
    let image = Image::from_srgb([1, 1], &texel).unwrap();
    let surface = &mut drawing.surfaces[0];
    surface.texture = Some(SurfaceTexture {
        image: Arc::new(image),
        repeats: false,
        places: vec![Vec2::splat(0.5); 4],
        coverage: Coverage::Ignored,
    });
    // Lit on the left alone.
    for (vertex, tone) in surface.vertices.iter_mut().zip([1.0, -0.5, -0.5, 1.0]) {
        vertex.tone = tone;
    }
    let [[light, _, shaded], _] = columns(&drawing, [10, 22, 28]);
    assert_eq!((light, shaded), ([0.5, 0.5, 0.0], [0.25, 0.125, 0.0]));
    let picture = Rasterizer::new(4, Some(1)).unwrap().draw(&drawing).unwrap();
    // What is dark already stays as it is.
    assert_eq!(
        picture.pixels[28 * 40 + 18][..3],
        picture.pixels[10 * 40 + 18][..3]
    );
}

fn mesh_layer(text: &str) -> Layer {
    let mut registry = Registry::new();
    effects_cartoon::register(&mut registry).unwrap();
    let list = format!("[{text}]");
    let mut reader = Reader::new("test", &list);
    let specs = reader.layers(&list, &registry, &[]);
    reader.report().unwrap();
    specs[0].build()
}

#[test]
fn a_painted_surface_lies_in_shadow_there_and_a_decal_on_it_is_not_painted() {
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 2.0,
        vertical_fov_degrees: 30.0,
    };
    let camera = Camera::orbit(view, [40, 40], 0.01).unwrap();
    for effect in [
        "(effect: \"mesh.flat\", on: \"wall\")",
        "(effect: \"mesh.flat\", on: \"wall\", params: (threshold: -1))",
        "(effect: \"mesh.toon\", on: \"wall\")",
    ] {
        let painted = mesh_layer(effect);
        let mesh = MeshLayer {
            layer: &painted,
            head: Head {
                center: Vec3::ZERO,
                height_m: 0.5,
            },
            seed: 1,
        };
        let painting = MeshPainting {
            layers: vec![PaintedMeshes::new(&mesh, &camera)],
            seen: Some(Seen {
                camera,
                light: Light::Direction(Vec3::Z),
                time_s: 0.0,
            }),
        };
        let paint = SurfacePaint {
            layer: 0,
            normals: vec![Vec3::Z; 4],
            occlusion: Vec::new(),
        };
        for (decal, expected) in [(&SHADOW, DARK_WALL), (&ON_WALL, GREEN)] {
            let mut drawing = drawing(25.0, 2.4, decal);
            drawing.mesh_painting = painting.clone();
            drawing.surfaces[0].paint = Some(paint.clone());
            let [[light, hair, under], _] = columns(&drawing, [10, 22, 28]);
            assert_eq!((light, hair, under), (WALL, RED, expected), "{effect}");
        }
    }
}

#[test]
fn a_decal_that_cannot_be_is_refused() {
    let refused = |change: fn(&mut Drawing)| {
        let mut drawing = drawing(25.0, 2.0, &ON_HAIR);
        change(&mut drawing);
        let drawn = Rasterizer::new(4, Some(1)).unwrap().draw(&drawing);
        assert!(matches!(drawn, Err(DrawError::Decal(_))), "{drawn:?}");
    };
    refused(|drawing| drawing.decals[0].layer = 2);
    refused(|drawing| drawing.decals.push(ON_HAIR));
    refused(|drawing| drawing.decals[0].reach_m = f32::NAN);
    refused(|drawing| drawing.decals[0].reach_m = -0.1);
    refused(|drawing| {
        let program = mesh_layer("(effect: \"hair.toon\")").program;
        drawing.painting.layers = vec![PaintedLayer::new(1, program, 1)];
        drawing.painting.joints = painted_joints(drawing.clump.len());
    });
}

/// What painted layers are told of joints.
fn painted_joints(joints: usize) -> effects::Samples {
    let zero = effects::wgsl::vec3([0.0; 3]);
    effects::Samples {
        normal: vec![zero; joints],
        forward: vec![zero; joints],
        light_direction: vec![zero; joints],
        view_direction: vec![zero; joints],
        u: vec![0.0; joints],
        depth: vec![1.0; joints],
        s: vec![0.0; joints],
        strand: vec![0; joints],
        seed: vec![0; joints],
        position: vec![zero; joints],
        light_distance: vec![0.0; joints],
        time: vec![0.0; joints],
        head_depth: vec![0.0; joints],
        pixels: vec![1.0; joints],
        level: vec![0; joints],
        tube: vec![zero; joints],
        ..effects::Samples::default()
    }
}
