//! What is seen of heads.

use super::layers::{Clips, MeshLayers};
use super::*;
use render::{Light, Surface};
use stroke_path::{Camera, OrbitView};

fn camera(yaw_degrees: f32) -> Camera {
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees,
        pitch_degrees: 0.0,
        distance_m: 2.0,
        vertical_fov_degrees: 30.0,
    };
    Camera::orbit(view, [100, 100], 0.01).unwrap()
}

/// One triangle that faces +Z, counter-clockwise from there.
fn plate() -> Mesh {
    Mesh {
        positions: vec![
            Vec3::new(-1.0, -1.0, 0.0),
            Vec3::new(1.0, -1.0, 0.0),
            Vec3::Y,
        ],
        normals: vec![Vec3::Z; 3],
        triangles: vec![[0, 1, 2]],
    }
}

const PAINT: HeadPaint = HeadPaint {
    unit_m: 0.001,
    light: [1.0; 3],
    shadow: [0.5; 3],
    line: [0.0; 3],
    iris: [0.2; 3],
    iris_shadow: [0.1; 3],
    iris_light: [0.3; 3],
    blush: [0.9; 3],
    mouth: [0.3; 3],
    dress: [0.8; 3],
    dress_shadow: [0.6; 3],
    dress_line: [0.05; 3],
    accent: [0.7; 3],
    accent_shadow: [0.3; 3],
    tie: [0.2, 0.4, 0.6],
    tie_shadow: [0.1, 0.2, 0.3],
    scalp: [0.4, 0.2, 0.1],
    width_m: 0.01,
    inside_margin_m: 0.05,
    outline_margin_m: 0.01,
    threshold: 0.1,
};

#[test]
fn the_outside_is_lit_and_the_inside_is_in_shadow() {
    let light = Light::Direction(Vec3::Z);
    let front = surfaces(
        &plate().into(),
        &PAINT,
        &[],
        &MeshLayers::new(&[], 0, &Clips::default()),
        &camera(0.0),
        &light,
    );
    assert_eq!(front[0].triangles.len(), 1);
    assert_eq!(front[1].triangles.len(), 0);
    assert_eq!(
        front[2].triangles.len(),
        0,
        "the hull shows its inside only"
    );
    assert!(front[0].vertices.iter().all(|v| v.tone > 0.0));

    let behind = surfaces(
        &plate().into(),
        &PAINT,
        &[],
        &MeshLayers::new(&[], 0, &Clips::default()),
        &camera(180.0),
        &light,
    );
    assert_eq!(behind[0].triangles.len(), 0);
    assert_eq!(behind[1].triangles.len(), 1);
    assert_eq!(behind[1].light, PAINT.shadow);
    assert_eq!(behind[2].triangles.len(), 1);
}

#[test]
fn shade_is_dark_in_full_light() {
    let mut model = HeadModel::from(plate());
    model.shade = vec![0.0, 0.0, 1.0];
    let seen = surfaces(
        &model,
        &PAINT,
        &[],
        &MeshLayers::new(&[], 0, &Clips::default()),
        &camera(0.0),
        &Light::Direction(Vec3::Z),
    );
    let tones = seen[0].vertices.iter().map(|vertex| vertex.tone > 0.0);
    assert_eq!(tones.collect::<Vec<_>>(), [true, true, false]);
}

#[test]
fn hair_is_of_one_size_on_the_bust_and_on_figures() {
    let found = HeadModel::bust().frame(&[]);
    let figure = HeadModel::figure(&Figure::default()).frame(&[]);
    assert!(
        found.center.distance(figure.center) < 1e-3,
        "{found:?} {figure:?}"
    );
    assert!((found.height_m - figure.height_m).abs() < 1e-3);
}

#[test]
fn clothes_have_colours_of_their_own() {
    let sailor = HeadModel::figure(&Figure {
        dress: groom::Dress::Sailor,
        ..Figure::default()
    });
    let seen = surfaces(
        &sailor,
        &PAINT,
        &[],
        &MeshLayers::new(&[], 0, &Clips::default()),
        &bust_camera(),
        &Light::Direction(Vec3::Z),
    );
    let drawn = |color: [f32; 3]| -> usize {
        let own = seen.iter().filter(|surface| surface.light == color);
        own.map(|surface| surface.triangles.len()).sum()
    };
    assert!(drawn(PAINT.dress) > 500 && drawn(PAINT.accent) > 100);
    assert!(drawn(PAINT.light) > 1000 && drawn(PAINT.dress_line) > 100);
    let all: usize = sailor.clothes.iter().map(|(_, own)| own.len()).sum();
    assert_eq!(all + sailor.skin.len(), sailor.mesh.triangles.len());
    // Lines end at the cut.
    let low = sailor.mesh.positions.iter().zip(&sailor.outline);
    let (at_the_cut, above): (Vec<_>, Vec<_>) = low.partition(|(p, _)| p.y < 1.1301);
    assert!(at_the_cut.len() > 50 && at_the_cut.iter().all(|(_, width)| **width < 0.01));
    assert!(above.iter().all(|(p, width)| p.y < 1.19 || **width == 1.0));
}

#[test]
fn the_side_of_the_nose_is_dark_where_light_is_away() {
    let figure = HeadModel::figure(&Figure::default());
    let dark = |light: Vec3| {
        let light = Light::Direction(light.normalize());
        let seen = surfaces(
            &figure,
            &PAINT,
            &[],
            &MeshLayers::new(&[], 0, &Clips::default()),
            &bust_camera(),
            &light,
        );
        // Patches are flat in one tone; the skin has two.
        let flat = |surface: &&Surface| surface.light == surface.shadow;
        let own = seen.iter().filter(|surface| surface.light == PAINT.shadow);
        own.filter(flat)
            .filter(|surface| surface.triangles.len() < 1000 && !surface.triangles.is_empty())
            .count()
    };
    assert_eq!(dark(Vec3::new(0.0, 0.0, 1.0)), 0);
    assert_eq!(dark(Vec3::new(1.0, 0.0, 1.0)), 1, "the other side");
    assert_eq!(dark(Vec3::new(-1.0, 0.0, 1.0)), 1);
    assert_eq!(dark(Vec3::new(0.0, 1.2, 1.0)), 1, "under the lip");
}

/// Looks at the face of the bust or a figure.
fn bust_camera() -> Camera {
    let view = OrbitView {
        target: Vec3::new(0.0, 1.4, 0.0),
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 2.0,
        vertical_fov_degrees: 30.0,
    };
    Camera::orbit(view, [100, 100], 0.01).unwrap()
}

#[test]
fn triangles_are_cut_at_the_near_plane() {
    let mut mesh = plate();
    mesh.positions[2].z = 5.0; // behind the eye
    let cut = &surfaces(
        &mesh.into(),
        &PAINT,
        &[],
        &MeshLayers::new(&[], 0, &Clips::default()),
        &camera(0.0),
        &Light::Direction(Vec3::Z),
    );
    let all: usize = cut[..2].iter().map(|s| s.triangles.len()).sum();
    assert_eq!(all, 2, "two corners in front leave a quadrilateral");
    for surface in cut {
        for index in surface.triangles.iter().flatten() {
            let vertex = surface.vertices[*index as usize];
            assert!(vertex.position.is_finite() && vertex.inv_depth <= 1.0 / 0.01 + 1e-3);
        }
    }
}
