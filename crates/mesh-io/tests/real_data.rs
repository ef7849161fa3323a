//! Files that this project did not make, in the folder that `INKSTRAND_DATA` names.
#![cfg(feature = "gltf")]
#![expect(clippy::print_stderr, reason = "skipped tests say so")]

use std::path::{Path, PathBuf};

use glam::Vec3;
use mesh_io::{Alpha, Model, Sequence, read_model};

fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("INKSTRAND_DATA").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("SKIPPED 1 test: INKSTRAND_DATA is not set");
    }
    folder
}

#[track_caller]
fn read(data: &Path, name: &str) -> Model {
    let model = read_model(&data.join(name)).unwrap();
    check(&model);
    model
}

/// What every model holds to, whatever it is of.
#[track_caller]
fn check(model: &Model) {
    for mesh in &model.meshes {
        let count = mesh.positions.len();
        assert!(mesh.positions.iter().all(|place| place.is_finite()));
        assert_eq!(mesh.normals.len(), count);
        assert!(
            mesh.normals
                .iter()
                .all(|normal| (normal.length() - 1.0).abs() < 1e-3)
        );
        assert!(mesh.uvs.is_empty() || mesh.uvs.len() == count);
        assert!(
            mesh.triangles
                .iter()
                .flatten()
                .all(|index| (*index as usize) < count)
        );
        assert!(
            mesh.material
                .is_none_or(|material| material < model.materials.len())
        );
        for own in &mesh.attributes {
            assert_eq!(own.values.len(), own.width * count);
        }
    }
}

#[test]
fn sintel_has_a_head_eyes_lashes_and_a_collider() {
    let Some(data) = data() else { return };
    for (file, name, triangles, has_uvs) in [
        ("sintel.obj", "GEO-body.unity", 5952, true),
        ("sintel-eyes.obj", "GEO-eyeballs", 1408, true),
        ("sintel-eyelashes.obj", "eyelashes", 192, true),
        (
            "sintel-collider.obj",
            "Hair_collider_watertight",
            678,
            false,
        ),
    ] {
        let model = read(&data, &format!("sintel/{file}"));
        let [mesh] = &model.meshes[..] else {
            panic!("{file}")
        };
        assert_eq!(
            (
                mesh.name.as_str(),
                mesh.triangles.len(),
                !mesh.uvs.is_empty()
            ),
            (name, triangles, has_uvs)
        );
    }
    assert_eq!(
        read(&data, "sintel/sintel.obj").welded().positions.len(),
        3046
    );
}

#[test]
fn the_human_is_skin_without_scaffolding() {
    let Some(data) = data() else { return };
    let model = read(&data, "makehuman/makehuman_base.obj");
    assert!(model.meshes.iter().any(|mesh| mesh.name == "body"));
    assert!(
        model
            .meshes
            .iter()
            .all(|mesh| !mesh.name.starts_with("joint"))
    );
    assert!(
        model.notes[0].contains("helper and joint groups"),
        "{:?}",
        model.notes
    );
}

#[test]
fn godette_has_meshes_textures_morphs_and_a_skeleton() {
    let Some(data) = data() else { return };
    let model = read(&data, "vrm/Godette_vrm_v4.vrm");
    let names: Vec<_> = model
        .meshes
        .iter()
        .map(|mesh| (mesh.name.as_str(), mesh.material.unwrap()))
        .collect();
    assert_eq!(
        names,
        [
            ("FaceMesh", 0),
            ("BodyMesh", 1),
            ("BodyMesh", 2),
            ("BodyMesh", 3)
        ]
    );
    assert_eq!(model.morphs(0).len(), 15);
    assert_eq!(model.morphs(0)[3], "blink_left");
    let [face, body, logo, backpack] = &model.materials[..] else {
        panic!()
    };
    assert_eq!(
        (face.alpha, logo.alpha, logo.double_sided),
        (Alpha::Opaque, Alpha::Blend, true)
    );
    assert!(face.shade_color.unwrap()[0] < 0.83 && body.shade_color.unwrap()[2] == 1.0);
    assert_eq!(backpack.shade_color, None);
    for material in &model.materials {
        let image = &model.images[material.texture.unwrap().image];
        let bytes = image.bytes().unwrap();
        assert!(
            bytes.starts_with(b"\x89PNG") || bytes.starts_with(b"\xff\xd8"),
            "{}",
            image.name
        );
    }

    // She stands on the ground and faces +Z: her nose is before her head's bone.
    let rig = model.rig.as_ref().unwrap();
    let head = rig.node("head").unwrap();
    let place = rig.world(&rig.rest())[head].translation.as_vec3();
    assert!((0.9..1.5).contains(&place.y), "{place}");
    let face = &model.meshes[0];
    let weight = |want: f32| {
        face.positions
            .iter()
            .filter(|p| (p.y - place.y) * want > 0.0)
            .count()
    };
    assert!(weight(1.0) > 100);
    let middle = face.positions.iter().sum::<Vec3>() / face.positions.len() as f32;
    let front = face
        .normals
        .iter()
        .zip(&face.positions)
        .filter(|(_, p)| p.z > middle.z);
    assert!(front.map(|(normal, _)| normal.z).sum::<f32>() > 0.0);

    // A blink moves the face and nothing else.
    let mut pose = rig.rest();
    pose.weights[model.node_of(0).unwrap()] = vec![0.0, 0.0, 0.0, 1.0];
    let shapes = model.shapes(&pose);
    let moved = |mesh: usize| {
        shapes[mesh]
            .positions
            .iter()
            .zip(&model.meshes[mesh].positions)
            .filter(|(a, b)| a.distance(**b) > 1e-4)
            .count()
    };
    assert!(
        moved(0) > 4 && moved(0) < face.positions.len() / 2,
        "{}",
        moved(0)
    );
    assert_eq!(moved(1), 0);
    // A turn of the head's bone turns the face, and not the feet.
    let mut pose = rig.rest();
    pose.nodes[head].rotation = glam::DQuat::from_rotation_y(0.5) * pose.nodes[head].rotation;
    let shapes = model.shapes(&pose);
    let far = |mesh: usize| {
        let pairs = shapes[mesh]
            .positions
            .iter()
            .zip(&model.meshes[mesh].positions);
        pairs
            .map(|(a, b)| a.distance(*b))
            .fold((f32::MAX, 0.0f32), |(least, most), far| {
                (least.min(far), most.max(far))
            })
    };
    assert!(far(0).1 > 0.05, "{:?}", far(0));
    assert!(far(1).0 < 1e-5, "{:?}", far(1));
}

#[test]
fn every_other_character_opens() {
    let Some(data) = data() else { return };
    for (name, meshes) in [
        ("vrm/vrm1_springbone_fixture.vrm", 1),
        ("vrm/threevrm_springbone_inside-collider.gltf", 1),
        ("vrm/threevrm_springbone_plane-collider.gltf", 2),
        ("vrm/threevrm_springbone_sphere-collider.gltf", 1),
        // Hair as lines: a skeleton of strands, and no mesh.
        ("blender/hair_lines_morph.glb", 0),
    ] {
        let model = read(&data, name);
        assert!(
            model.meshes.len() >= meshes,
            "{name}: {}",
            model.meshes.len()
        );
        assert!(
            meshes > 0 || model.notes[0].contains("points, lines"),
            "{name}"
        );
    }
}

#[test]
fn surfaces_of_water_open_with_their_velocities() {
    let Some(data) = data() else { return };
    for name in ["splash", "wake"] {
        let sequence = Sequence::find(&data.join(format!("water/{name}.####.glb"))).unwrap();
        assert_eq!(sequence.files().len(), 48);
        assert_eq!(sequence.frame_at(47.0 / 24.0, 24.0), 47);
        for &frame in sequence.files().keys() {
            let model = sequence.read(frame).unwrap();
            check(&model);
            let [water] = &model.meshes[..] else { panic!() };
            assert!((10_000..18_000).contains(&water.triangles.len()));
            let velocity = water.attribute("velocity").unwrap();
            assert_eq!(velocity.width, 3);
            let fastest = velocity
                .values
                .iter()
                .fold(0.0f32, |most, v| most.max(v.abs()));
            assert!(
                // It is at rest when it begins.
                frame < 2 || (0.1..20.0).contains(&fastest),
                "{name} {frame}: {fastest} m/s"
            );
            // The surface looks up.
            let up: f32 = water.normals.iter().map(|normal| normal.y).sum();
            assert!(up > 0.5 * water.normals.len() as f32);
        }
    }
    // What velocities say is what the surface does: the ball's fall opens a cavity.
    let read = |frame: &str| {
        read(&data, &format!("water/splash.{frame}.glb"))
            .meshes
            .remove(0)
    };
    let (before, after) = (read("0003"), read("0004"));
    let speed = |mesh: &mesh_io::Mesh, vertex: usize| {
        Vec3::from_slice(mesh.attribute("velocity").unwrap().of(vertex))
    };
    let lowest = |mesh: &mesh_io::Mesh| {
        let places = mesh.positions.iter().enumerate();
        places
            .min_by(|a, b| a.1.y.total_cmp(&b.1.y))
            .map(|(vertex, place)| (vertex, *place))
            .unwrap()
    };
    let ((vertex, low), (_, next)) = (lowest(&before), lowest(&after));
    assert!(
        next.y < low.y && speed(&before, vertex).y < 0.0,
        "{low} {next} {}",
        speed(&before, vertex)
    );
}
