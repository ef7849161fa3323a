//! Tones on a sphere, whose edges are circles that are known exactly.

use effects::Registry;
use effects::preset::Reader;
use glam::{DVec3, Vec3};
use render::cpu::Rasterizer;
use render::{
    Drawing, Head, Light, MeshLayer, MeshPainting, PaintedMeshes, Seen, Surface, SurfacePaint,
    SurfaceVertex,
};
use stroke_path::{Camera, OrbitView};

const RINGS: u32 = 128;
const SECTORS: u32 = 192;
const RADIUS_M: f64 = 0.4;
const DISTANCE_M: f64 = 3.0;
const SIDE: u32 = 320;

fn camera() -> Camera {
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: DISTANCE_M as f32,
        vertical_fov_degrees: 18.0,
    };
    Camera::orbit(view, [SIDE; 2], 0.01).unwrap()
}

/// A sphere of triangles around the world's middle, painted in two tones, white and black.
fn sphere(light: DVec3, threshold: f64) -> Drawing {
    let text = format!(
        "[(effect: \"mesh.flat\", on: \"a\", params: (threshold: {threshold}, light: \"FFFFFF\", shade: \"000000\"))]"
    );
    let mut registry = Registry::new();
    effects_cartoon::register(&mut registry).unwrap();
    let mut reader = Reader::new("test", &text);
    let layers = reader.layers(&text, &registry, &[]);
    reader.report().unwrap();
    let (layer, camera) = (layers[0].build(), camera());
    let mesh = MeshLayer {
        layer: &layer,
        head: Head {
            center: Vec3::ZERO,
            height_m: 1.0,
        },
        seed: 0,
    };
    let (mut vertices, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for ring in 0..=RINGS {
        for sector in 0..=SECTORS {
            let polar = std::f64::consts::PI * f64::from(ring) / f64::from(RINGS);
            let angle = std::f64::consts::TAU * f64::from(sector) / f64::from(SECTORS);
            let normal = DVec3::new(
                polar.sin() * angle.cos(),
                polar.cos(),
                polar.sin() * angle.sin(),
            );
            let view = camera.view_from_world((RADIUS_M * normal).as_vec3());
            vertices.push(SurfaceVertex {
                position: camera.project(view),
                inv_depth: 1.0 / view.z,
                tone: 1.0,
            });
            normals.push(normal.as_vec3());
            if ring < RINGS && sector < SECTORS {
                let corner = ring * (SECTORS + 1) + sector;
                let below = corner + SECTORS + 1;
                triangles.push([corner, below, below + 1]);
                triangles.push([corner, below + 1, corner + 1]);
            }
        }
    }
    Drawing {
        size: [SIDE; 2],
        surfaces: vec![Surface {
            vertices,
            triangles,
            light: [1.0; 3],
            paint: Some(SurfacePaint {
                layer: 0,
                normals,
                occlusion: Vec::new(),
            }),
            ..Surface::default()
        }],
        mesh_painting: MeshPainting {
            layers: vec![PaintedMeshes::new(&mesh, &camera)],
            seen: Some(Seen {
                camera,
                light: Light::Direction(light.as_vec3()),
                time_s: 0.0,
            }),
        },
        ..Drawing::default()
    }
}

/// The unit normal of the true sphere where a place of the picture shows it.
fn normal_at(x: f64, y: f64) -> Option<DVec3> {
    let (focal, middle) = (f64::from(camera().focal_px()), f64::from(SIDE) / 2.0);
    let eye = DVec3::new(0.0, 0.0, DISTANCE_M);
    let ray = DVec3::new((x - middle) / focal, (middle - y) / focal, -1.0).normalize();
    let along = -eye.dot(ray);
    let inside = RADIUS_M * RADIUS_M - (eye + along * ray).length_squared();
    (inside > 0.0).then(|| (eye + (along - inside.sqrt()) * ray) / RADIUS_M)
}

/// The tone's edge, a circle on the sphere and an ellipse in the picture, lies within 0.1 pixels of where it should: of each row of pixels as much
/// is lit.
#[test]
fn a_tones_edge_is_an_exact_circle() {
    const GRID: u32 = 16;
    for (light, threshold) in [
        (DVec3::new(0.8, 0.1, 0.6), 0.3),
        (DVec3::new(-0.9, 0.2, 0.1), 0.1),
        (DVec3::new(0.3, 0.0, 0.95), 0.8),
    ] {
        let light = light.normalize();
        let drawing = sphere(light, threshold);
        let picture = Rasterizer::new(64, Some(2))
            .unwrap()
            .draw(&drawing)
            .unwrap();
        let mut farthest: f64 = 0.0;
        let mut rows = 0;
        for y in 100..220 {
            let mut moved = 0.0;
            let mut edge = 0.0_f64;
            for x in 0..SIDE {
                let mut lit = 0;
                let mut is_inside = true;
                for i in 0..GRID * GRID {
                    let at = |cell: u32| (f64::from(cell) + 0.5) / f64::from(GRID);
                    let (sx, sy) = (f64::from(x) + at(i % GRID), f64::from(y) + at(i / GRID));
                    match normal_at(sx, sy) {
                        // Away from the outline, which is the mesh's and no circle.
                        Some(normal) if normal.z > 0.3 => {
                            lit += u32::from(normal.dot(light) >= threshold);
                        }
                        _ => is_inside = false,
                    }
                }
                if is_inside {
                    let exact = f64::from(lit) / f64::from(GRID * GRID);
                    let [drawn, ..] = picture.pixels[(y * SIDE + x) as usize];
                    moved += (f64::from(drawn) - exact).abs();
                    edge += f64::from(u8::from(exact > 0.0 && exact < 1.0));
                }
            }
            rows += u32::from(edge > 0.0);
            // An edge that crosses a row is seen in two of its pixels at most; one that runs along it moves as much area for each pixel of its length.
            farthest = farthest.max(moved / (0.5 * edge).max(1.0));
        }
        assert!(rows > 60, "{light}: an edge in {rows} rows");
        assert!(farthest < 0.1, "{light}: {farthest:.3} pixels");
    }
}
