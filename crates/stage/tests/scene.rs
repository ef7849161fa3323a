//! Scenes: files and presets to frames.

use effects::Registry;
use glam::Vec3;
use render::{Light, Order};
use stage::{Files, Preset, Stage, StageError};
use std::fs;
use std::path::Path;

const STRANDS: &str = "(version: 1, strands: [
    (size: 30.0, points: [(0.0, 0.1, 0.0), (0.0, 0.15, 0.05), (0.0, 0.05, 0.12)]),
    (mirror: true, points: [(0.05, 0.09, 0.0), (0.1, 0.1, 0.0), (0.14, 0.0, 0.0)]),
])";

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    registry
}

/// A scene with these strands and these sections beside the layers.
fn stage(folder: &Path, strands: &str, sections: &str) -> Result<Stage, StageError> {
    fs::write(folder.join("a.strands.ron"), strands).unwrap();
    let text = format!(
        "(version: 1, hair: (file: \"a.strands.ron\"), {sections} layers: [(effect: \"hair.base\")])"
    );
    let registry = registry();
    let preset = Preset::parse("look.ron", &text, &registry).unwrap();
    let files = Files {
        preset_folder: folder.to_owned(),
        ..Files::default()
    };
    Stage::new(&preset, &files)
}

#[test]
fn strands_come_sorted_by_id_with_their_sizes() {
    let folder = tempfile::tempdir().unwrap();
    let mut stage = stage(
        folder.path(),
        STRANDS,
        "path: (kind: linear, subdivision: 1),",
    )
    .unwrap();
    assert_eq!(stage.strand_count(), 3);
    let frame = stage.frame().unwrap();
    assert!(frame.strands.is_sorted_by_key(|s| s.id));
    assert_eq!(frame.strands[0].size, 30.0);
    assert!(frame.strands[1].size > 0.0 && frame.strands[1].size == frame.strands[2].size);
    assert_eq!(
        frame.paths.len(),
        9,
        "linear paths of one subdivision are the particles"
    );
    let mean = Vec3::new(0.0, 0.1, 0.17 / 3.0);
    assert!((frame.strands[0].mean - mean).length() < 1e-6);
}

#[test]
fn an_order_of_earlier_presets_is_drawn_as_rounded() {
    let folder = tempfile::tempdir().unwrap();
    for (name, order, notes) in [
        ("rounded", Order::Rounded, 0),
        ("strand_first", Order::StrandFirst, 0),
        ("shifted", Order::Shifted, 0),
        ("scattered", Order::Rounded, 1),
    ] {
        let sections = format!("scene: (order: {name}),");
        let mut stage = stage(folder.path(), STRANDS, &sections).unwrap();
        assert_eq!(stage.frame().unwrap().order, order, "{name}");
        let told = stage
            .notes()
            .iter()
            .filter(|note| note.contains("scattered"));
        assert_eq!(told.count(), notes, "{name}");
    }
}

#[test]
fn motion_is_played_back() {
    let folder = tempfile::tempdir().unwrap();
    let moving = "(version: 1, strands: [(points: [(0.0, 0.0, 0.0), (0.0, -0.1, 0.0)])], motion: [
        (time: 0.0, strands: [[(0.0, 0.0, 0.0), (0.0, -0.1, 0.0)]]),
        (time: 1.0, strands: [[(0.0, 0.0, 0.0), (0.1, 0.0, 0.0)]]),
    ])";
    let mut stage = stage(
        folder.path(),
        moving,
        "path: (kind: linear, subdivision: 1),",
    )
    .unwrap();
    stage.advance_to(0.5).unwrap();
    let tip = stage.frame().unwrap().paths.position[1];
    assert!((tip - Vec3::new(0.05, -0.05, 0.0)).length() < 1e-6, "{tip}");
    stage.advance_to(0.0).unwrap();
    assert_eq!(
        stage.frame().unwrap().paths.position[1],
        Vec3::new(0.0, -0.1, 0.0)
    );
}

#[test]
fn a_light_fixed_to_the_camera_turns_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let direction = |sections: &str| {
        let mut stage = stage(folder.path(), STRANDS, sections).unwrap();
        match stage.frame().unwrap().light {
            Light::Direction(direction) => direction,
            Light::Point(_) => panic!("the preset asks for a direction"),
        }
    };
    let at_camera = direction("camera: (yaw: 90), light: (fixed_to: camera, yaw: 0, pitch: 0),");
    assert!((at_camera - Vec3::X).length() < 1e-5, "{at_camera}");
    let in_world = direction("camera: (yaw: 90), light: (yaw: 0, pitch: 0),");
    assert!((in_world - Vec3::Z).length() < 1e-5, "{in_world}");
    let above = direction("camera: (yaw: 90), light: (fixed_to: camera, yaw: 0, pitch: 90),");
    assert!((above - Vec3::Y).length() < 1e-5, "{above}");
}

#[test]
fn a_point_light_stands_in_head_heights() {
    let folder = tempfile::tempdir().unwrap();
    let sections = "light: (kind: point, yaw: 0, pitch: 0, distance: 2),";
    let mut stage = stage(folder.path(), STRANDS, sections).unwrap();
    let frame = stage.frame().unwrap();
    let Light::Point(place) = frame.light else {
        panic!("the preset asks for a point")
    };
    let expected = frame.objects[0].head.center + Vec3::Z * 2.0 * frame.objects[0].head.height_m;
    assert!((place - expected).length() < 1e-5);
}

#[test]
fn strands_behind_the_eye_are_culled() {
    let folder = tempfile::tempdir().unwrap();
    let far = STRANDS.replace(
        "
])",
        "
(points: [(0.0, 0.0, 50.0), (0.0, -0.1, 50.0)]),
])",
    );
    let mut stage = stage(folder.path(), &far, "").unwrap();
    stage.frame().unwrap();
    assert_eq!(stage.culled(), 1);
}

#[test]
fn missing_and_empty_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let empty = stage(folder.path(), "(version: 1, strands: [])", "");
    let message = empty.err().unwrap().to_string();
    assert!(message.contains("a.strands.ron"), "{message}");
    assert!(message.contains("at least one strand"), "{message}");

    let registry = registry();
    let text = "(version: 1, hair: (file: \"gone.tfx\"), layers: [(effect: \"hair.base\")])";
    let preset = Preset::parse("look.ron", text, &registry).unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    assert!(
        Stage::new(&preset, &files)
            .err()
            .unwrap()
            .to_string()
            .contains("gone.tfx")
    );

    let text = "(version: 1, layers: [(effect: \"hair.base\")])";
    let preset = Preset::parse("look.ron", text, &registry).unwrap();
    assert!(matches!(
        Stage::new(&preset, &files),
        Err(StageError::NoHair)
    ));
}

#[test]
fn how_many_strands_are_kept_moves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let ball: String = (0..60)
        .map(|i| {
            let turn = i as f32 * 2.4;
            let height = 1.0 - i as f32 / 30.0;
            let flat = (1.0 - height * height).max(0.0).sqrt();
            let (x, y, z) = (
                0.1 * flat * turn.cos(),
                0.1 * height,
                0.1 * flat * turn.sin(),
            );
            format!(
                "(points: [({x}, {y}, {z}), ({}, {}, {})]),",
                x * 3.0,
                y * 3.0,
                z * 3.0
            )
        })
        .collect();
    let strands = format!("(version: 1, strands: [{ball}])");
    let view = |guides: u32| {
        fs::write(folder.path().join("a.strands.ron"), &strands).unwrap();
        let text = format!(
            "(version: 1, hair: (file: \"a.strands.ron\", guides: {guides}), \
             layers: [(effect: \"hair.base\")])"
        );
        let registry = registry();
        let preset = Preset::parse("look.ron", &text, &registry).unwrap();
        let files = Files {
            preset_folder: folder.path().to_owned(),
            ..Files::default()
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        let frame = stage.frame().unwrap();
        (
            frame.objects[0].head,
            frame.camera.eye(),
            frame.strands.to_vec(),
        )
    };
    let (head, eye, all) = view(0);
    for guides in [1, 7, 30] {
        let (kept_head, kept_eye, kept) = view(guides);
        assert_eq!((kept_head, kept_eye), (head, eye));
        assert_eq!(kept.len(), guides as usize);
        // Fewer strands stand for more hair each, but none is a ball the size of the head.
        assert!(
            kept.iter().all(|s| s.size >= all[0].size && s.size <= 40.0),
            "{kept:?}"
        );
    }
}

#[test]
fn strands_that_no_picture_can_mean_are_left_out_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let far = STRANDS.replace(
        "\n])",
        "\n(points: [(0.0, 0.0, 0.0), (1e20, -0.1, 0.0)]),\n])",
    );
    let mut stage = stage(folder.path(), &far, "").unwrap();
    let frame = stage.frame().unwrap();
    assert_eq!(frame.strands.len(), 4);
    assert!(frame.paths.center.iter().all(|center| center.is_finite()));
    assert_eq!(stage.left_out(), 1);
}

#[test]
fn a_head_that_faces_inwards_is_turned_around() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.strands.ron"), STRANDS).unwrap();
    let corners = "v 0 0.1 0\nv -0.1 -0.1 0.1\nv 0.1 -0.1 0.1\nv 0 -0.1 -0.1\n";
    let surfaces = |faces: &str| {
        fs::write(folder.path().join("head.obj"), format!("{corners}{faces}")).unwrap();
        let text = "(version: 1, hair: (file: \"a.strands.ron\"), \
                    head: (file: \"head.obj\", up: y, scale: 1), layers: [(effect: \"hair.base\")])";
        let registry = registry();
        let preset = Preset::parse("look.ron", text, &registry).unwrap();
        let files = Files {
            preset_folder: folder.path().to_owned(),
            ..Files::default()
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        let turned = stage
            .notes()
            .iter()
            .any(|note| note.contains("face inwards"));
        let outside = stage.frame().unwrap().surfaces[0].triangles.len();
        (turned, outside)
    };
    let outwards = surfaces("f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n");
    let inwards = surfaces("f 1 3 2\nf 1 4 3\nf 1 2 4\nf 2 3 4\n");
    assert!(!outwards.0 && inwards.0);
    assert_eq!(outwards.1, inwards.1);
    assert!(outwards.1 > 0);
}
