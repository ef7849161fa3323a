//! Surfaces that layers paint on the CPU: what they are told, what hair they are seen through, and what is refused.

use effects::preset::Reader;
use effects::{Layer, Registry};
use glam::{Vec2, Vec3};
use render::cpu::Rasterizer;
use render::{
    Disc, DrawError, Drawing, Feature, Features, Head, LayerStrokes, Light, MeshLayer,
    MeshPainting, PaintedMeshes, Run, RunInfo, SamplePlanes, Seen, Stretches, Surface,
    SurfacePaint, SurfaceVertex,
};
use stroke_path::{Camera, OrbitView};

const SIZE: [u32; 2] = [40, 40];
const HEAD: Head = Head {
    center: Vec3::ZERO,
    height_m: 0.5,
};

fn layer(text: &str) -> Layer {
    let mut registry = Registry::new();
    effects_cartoon::register(&mut registry).unwrap();
    let list = format!("[{text}]");
    let mut reader = Reader::new("test", &list);
    let specs = reader.layers(&list, &registry, &[]);
    reader.report().unwrap();
    specs[0].build()
}

fn camera() -> Camera {
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 2.0,
        vertical_fov_degrees: 30.0,
    };
    Camera::orbit(view, SIZE, 0.01).unwrap()
}

/// A wall behind one strand of red hair from the left to the right, 10 pixels wide.
fn drawing(text: &str, light: Light) -> Drawing {
    let (layer, camera) = (layer(text), camera());
    let mesh = MeshLayer {
        layer: &layer,
        head: HEAD,
        seed: 1,
    };
    let corner = |x: f32, y: f32| SurfaceVertex {
        position: Vec2::new(x, y),
        inv_depth: 0.5,
        tone: -1.0,
    };
    let disc = |x: f32| Disc {
        center: Vec2::new(x, 20.0),
        radius: 5.0,
        inv_depth: 0.6,
        inv_depth_biased: 0.6,
    };
    let discs = vec![disc(-20.0), disc(60.0)];
    Drawing {
        size: SIZE,
        runs: vec![Run {
            strand: 0,
            joints: 0..2,
        }],
        clump: discs.clone(),
        layers: vec![LayerStrokes {
            name: "hair".to_owned(),
            joints: 0..2,
            rank: 0,
            instances: 1,
            stretches: Stretches::Everywhere,
            discs,
            colors: vec![[1.0, 0.0, 0.0]; 2],
        }],
        surfaces: vec![Surface {
            vertices: vec![
                corner(-10.0, -10.0),
                corner(90.0, -10.0),
                corner(-10.0, 90.0),
            ],
            triangles: vec![[0, 1, 2]],
            light: [0.0, 0.5, 1.0],
            shadow: [0.0, 0.25, 0.25],
            paint: Some(SurfacePaint {
                layer: 0,
                normals: vec![Vec3::Z; 3],
                occlusion: Vec::new(),
            }),
            ..Surface::default()
        }],
        mesh_painting: MeshPainting {
            layers: vec![PaintedMeshes::new(&mesh, &camera)],
            seen: Some(Seen {
                camera,
                light,
                time_s: 0.0,
            }),
        },
        ..Drawing::default()
    }
}

const FRONT: Light = Light::Direction(Vec3::Z);
const BEHIND: Light = Light::Direction(Vec3::NEG_Z);

fn at(drawing: &Drawing, samples: u32, x: usize, y: usize) -> [f32; 3] {
    let picture = Rasterizer::new(samples, Some(2)).unwrap().draw(drawing);
    let [red, green, blue, alpha] = picture.unwrap().pixels[y * 40 + x];
    assert_eq!(alpha, 1.0);
    [red, green, blue]
}

#[test]
fn light_chooses_between_the_meshs_own_colours() {
    let flat = "(effect: \"mesh.flat\", on: \"wall\")";
    for samples in [1, 2, 4, 8] {
        assert_eq!(at(&drawing(flat, FRONT), samples, 20, 5), [0.0, 0.5, 1.0]);
        let shade = at(&drawing(flat, BEHIND), samples, 20, 5);
        assert_eq!(shade, [0.0, 0.25, 0.25]);
        // Hair before it is as it was.
        let hair = at(&drawing(flat, FRONT), samples, 20, 20);
        assert_eq!(hair, [1.0, 0.0, 0.0]);
    }
    let mut hidden = drawing(flat, FRONT);
    hidden.surfaces[0].paint.as_mut().unwrap().occlusion = vec![1.0; 3];
    assert_eq!(at(&hidden, 4, 20, 5), [0.0, 0.25, 0.25]);
}

#[test]
fn hair_is_mixed_with_what_is_seen_through_it_in_linear_light() {
    for (through, expected) in [
        (0.25, [0.75, 0.125, 0.25]),
        (1.0, [0.0, 0.5, 1.0]),
        (0.0, [1.0, 0.0, 0.0]),
    ] {
        let text = format!("(effect: \"mesh.flat\", on: \"wall\", through_hair: {through})");
        for samples in [1, 2, 4, 8, 16] {
            let found = at(&drawing(&text, FRONT), samples, 20, 20);
            let error = (0..3).map(|i| (found[i] - expected[i]).abs());
            assert!(error.fold(0.0, f32::max) < 1e-6, "{through}: {found:?}");
        }
    }
}

#[test]
fn depth_and_object_stay_the_hairs() {
    let text = "(effect: \"mesh.flat\", on: \"wall\", through_hair: 0.5)";
    let mut drawing = drawing(text, FRONT);
    drawing.features.declared = Features::of(&[Feature::Object, Feature::Color]);
    drawing.features.runs = vec![RunInfo {
        object: 0,
        strand: 0,
        level: 0,
    }];
    let mut planes = SamplePlanes::default();
    let mut rasterizer = Rasterizer::new(4, Some(1)).unwrap();
    let mut told = Vec::new();
    rasterizer
        .draw_samples(&drawing, &mut planes, |planes| {
            told.push(planes.sample(0, 20, 20));
        })
        .unwrap();
    assert_eq!(told[0].object, render::object_of_hair(0));
    assert!((told[0].inv_depth - 0.6).abs() < 1e-6);
    assert_eq!(told[0].color, [0.5, 0.25, 0.5, 1.0]);
}

/// Light from a place and nearness hang on where a sample is.
#[test]
fn samples_know_where_they_are() {
    let text = "(effect: \"mesh.toon\", on: \"wall\", params: (mode: replace, tones: [(0, \"000000\"), (1, \"FFFFFF\")]))";
    let camera = camera();
    // Before the middle of the wall at the world's z = 0.
    let place = Vec3::new(0.1, 0.05, 0.3);
    let drawing = drawing(text, Light::Point(place));
    for (x, y) in [(3, 30), (20, 5), (36, 33)] {
        let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let scale = 2.0 / f64::from(camera.focal_px());
        let seen = glam::DVec3::new((px - 20.0) * scale, (20.0 - py) * scale, 0.0);
        let to_light = place.as_dvec3() - seen;
        let cosine = to_light.z / to_light.length();
        let [red, ..] = at(&drawing, 1, x as usize, y as usize);
        assert!((f64::from(red) - cosine).abs() < 1e-4, "{red} {cosine}");
    }
}

#[test]
fn what_cannot_be_painted_is_refused() {
    let flat = "(effect: \"mesh.flat\", on: \"wall\")";
    let error = |spoil: &dyn Fn(&mut Drawing)| {
        let mut drawing = drawing(flat, FRONT);
        spoil(&mut drawing);
        Rasterizer::new(1, Some(1))
            .unwrap()
            .draw(&drawing)
            .unwrap_err()
    };
    let paint = |drawing: &mut Drawing, normals: Vec<Vec3>| {
        drawing.surfaces[0].paint.as_mut().unwrap().normals = normals;
    };
    let wrong = |error: DrawError| matches!(error, DrawError::SurfacePaint { surface: 0, .. });
    assert!(wrong(error(&|d| paint(d, vec![Vec3::Z; 2]))));
    assert!(wrong(error(&|d| paint(d, vec![Vec3::NAN; 3]))));
    assert!(wrong(error(&|d| paint(d, vec![9.0 * Vec3::Z; 3]))));
    assert!(wrong(error(&|d| {
        d.surfaces[0].paint.as_mut().unwrap().occlusion = vec![2.0; 3];
    })));
    let missing = error(&|d| d.surfaces[0].paint.as_mut().unwrap().layer = 3);
    assert!(matches!(
        missing,
        DrawError::SurfaceLayer {
            layer: 3,
            layers: 1,
            ..
        }
    ));
    for spoil in [
        |layer: &mut PaintedMeshes| layer.through_hair = 1.5,
        |layer: &mut PaintedMeshes| layer.head_height_m = 0.0,
        |layer: &mut PaintedMeshes| layer.head_depth = f32::NAN,
    ] {
        let error = error(&|d| spoil(&mut d.mesh_painting.layers[0]));
        assert!(matches!(error, DrawError::MeshLayer(0)));
    }
    assert!(matches!(
        error(&|d| d.mesh_painting.seen = None),
        DrawError::MeshLayer(0)
    ));
}

/// Normals that cancel out, needles, and surfaces at the eye make no pixel that isn't finite.
#[test]
fn hostile_surfaces_stay_finite() {
    let text = "(effect: \"mesh.toon\", on: \"wall\", through_hair: 0.5, params: (detail: blinn, rim: \"FFFFFF\"))";
    let mut drawing = drawing(text, Light::Point(Vec3::ZERO));
    let surface = &mut drawing.surfaces[0];
    let corner = |x: f32, y: f32, inv_depth| SurfaceVertex {
        position: Vec2::new(x, y),
        inv_depth,
        tone: 0.0,
    };
    surface.vertices = vec![
        corner(0.0, 0.0, 1e30),
        corner(40.0, 1e-4, 1e-30),
        corner(40.0, 40.0, 100.0),
        corner(1e6, 39.0, 0.5),
    ];
    surface.triangles = vec![[0, 1, 2], [0, 2, 3], [1, 1, 3]];
    surface.paint.as_mut().unwrap().normals = vec![Vec3::Z, Vec3::NEG_Z, Vec3::ZERO, Vec3::X];
    for samples in [1, 4] {
        let picture = Rasterizer::new(samples, Some(1)).unwrap().draw(&drawing);
        let pixels = picture.unwrap().pixels;
        assert!(pixels.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
    }
}
