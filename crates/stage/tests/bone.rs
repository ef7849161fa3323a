//! Heads that follow a bone of a character's animation.

use effects::Registry;
use glam::Vec3;
use stage::{Bake, Files, Preset, Stage};
use std::fs;
use std::path::Path;

/// Writes a character whose neck turns to the left by a quarter in the first second, and whose hips rise by 0.12 m
/// in the same time.
fn character(folder: &Path) {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let numbers = [
        [0.0, 1.0].as_slice(),
        &[0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half],
        &[0.0, 1.0, 0.0, 0.0, 1.12, 0.0],
    ];
    let bytes: Vec<u8> = numbers
        .concat()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    fs::write(folder.join("walker.bin"), bytes).unwrap();
    let text = r#"{
        "asset": {"version": "2.0"},
        "nodes": [
            {"name": "hips", "translation": [0, 1, 0], "children": [1]},
            {"name": "neck", "translation": [0, 0.4, 0], "children": [2]},
            {"name": "head", "translation": [0, 0.1, 0]}
        ],
        "buffers": [{"byteLength": 64, "uri": "walker.bin"}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 8},
            {"buffer": 0, "byteOffset": 8, "byteLength": 32},
            {"buffer": 0, "byteOffset": 40, "byteLength": 24}
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"},
            {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}
        ],
        "animations": [{
            "name": "look",
            "samplers": [{"input": 0, "output": 1}, {"input": 0, "output": 2}],
            "channels": [
                {"sampler": 0, "target": {"node": 1, "path": "rotation"}},
                {"sampler": 1, "target": {"node": 0, "path": "translation"}}
            ]
        }]
    }"#;
    fs::write(folder.join("walker.gltf"), text).unwrap();
}

fn scene(motion: &str) -> Result<Stage, String> {
    let folder = tempfile::tempdir().unwrap();
    character(folder.path());
    scene_in(folder.path(), motion, |_, _, stage| stage)
}

/// A scene of the files in a folder, and what is made of it, its preset and its files.
fn scene_in<T>(
    folder: &Path,
    motion: &str,
    make: impl FnOnce(&Preset, &Files, Stage) -> T,
) -> Result<T, String> {
    let bob = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets/styles/bob.style.ron");
    fs::copy(bob, folder.join("bob.style.ron")).unwrap();
    let text = format!(
        "(version: 1, hair: (file: \"bob.style.ron\"), head: (shape: bust),\n motion: ({motion}),
        dynamics: (solver: none), layers: [(effect: \"hair.base\")])"
    );
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let preset = Preset::parse("look.ron", &text, &registry).map_err(|e| e.to_string())?;
    let files = Files {
        preset_folder: folder.to_owned(),
        bake: (folder.join("bake.strands.ron").exists()).then(|| folder.join("bake.strands.ron")),
        ..Files::default()
    };
    preset.check_files(&files).map_err(|e| e.to_string())?;
    let stage = Stage::new(&preset, &files).map_err(|e| e.to_string())?;
    Ok(make(&preset, &files, stage))
}

/// Middle of the head, height, and means of the strands.
fn moment(stage: &mut Stage, time: f32) -> (Vec3, f32, Vec<Vec3>) {
    stage.advance_to(time).unwrap();
    let frame = stage.frame().unwrap();
    let means = frame.strands.iter().map(|strand| strand.mean).collect();
    (
        frame.objects[0].head.center,
        frame.objects[0].head.height_m,
        means,
    )
}

#[test]
fn head_and_hair_follow_the_bone() {
    let mut stage = scene("gltf: \"walker.gltf\"").unwrap();
    let (center, height_m, before) = moment(&mut stage, 0.0);
    let pivot = center - Vec3::new(0.0, 0.0, 0.12 * height_m);
    for (time, angle, rise) in [(0.5, 45.0_f32, 0.06), (1.0, 90.0, 0.12), (7.0, 90.0, 0.12)] {
        let (_, _, after) = moment(&mut stage, time);
        let turn = glam::Quat::from_rotation_y(angle.to_radians());
        for (from, to) in before.iter().zip(&after) {
            let expected = pivot + turn * (*from - pivot) + Vec3::Y * rise;
            assert!(expected.distance(*to) < 2e-4, "{time}: {expected} {to}");
        }
    }
}

#[test]
fn the_animation_may_repeat() {
    let mut stage = scene("gltf: \"walker.gltf\", animation: \"look\", repeat: true").unwrap();
    let half = moment(&mut stage, 0.5);
    assert!(moment(&mut stage, 0.0) != half);
    assert!(moment(&mut stage, 3.5).2[0].distance(half.2[0]) < 1e-6);
    // Its end is not its start, and that is told where it matters.
    let jump = |stage: &Stage| {
        stage
            .notes()
            .iter()
            .filter(|note| note.contains("jumps by"))
            .cloned()
            .collect::<Vec<_>>()
    };
    let notes = jump(&stage);
    assert!(
        notes.len() == 1 && notes[0].contains("90 degrees"),
        "{notes:?}"
    );
    assert_eq!(jump(&scene("gltf: \"walker.gltf\"").unwrap()), [""; 0]);
}

#[test]
fn what_is_not_there_is_named() {
    let fails = |motion: &str, expected: &str| {
        let message = scene(motion).err().unwrap();
        assert!(
            message.contains(expected),
            "`{expected}` is missing in:\n{message}"
        );
    };
    fails("gltf: \"walkr.gltf\"", "look.ron:2:17: gltf: there is no");
    fails("gltf: \"walkr.gltf\"", "did you mean `walker.gltf`?");
    fails(
        "gltf: \"walker.gltf\", bone: \"hed\"",
        "walker.gltf: there is no bone `hed`; the nearest names are: head, ",
    );
    fails(
        "gltf: \"walker.gltf\", animation: \"lok\"",
        "no animation `lok`; the nearest names are: look",
    );
    fails(
        "gltf: \"walker.gltf\", bone: head",
        "bone: expected a text in double quotes",
    );
    fails("gltf: \"bob.style.ron\"", "bob.style.ron: it is not glTF");
    fails(
        "gltf: \"walker.gltf\", animation: 0",
        "animation: expected a text in double quotes",
    );
}

#[test]
fn a_bake_knows_the_files_of_the_characters_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    character(folder);
    let motion = "gltf: \"walker.gltf\"";
    let (files, bake) = scene_in(folder, motion, |preset, files, mut stage| {
        let mut bake = Bake::new(preset, files, &stage.scene).unwrap();
        for time in [0.0, 1.0] {
            stage.advance_to(time).unwrap();
            stage.record(time, &mut bake);
        }
        (preset.files(files), stage.bake_text(bake).unwrap())
    })
    .unwrap();
    assert!(files.contains(&folder.join("walker.bin")), "{files:?}");
    fs::write(folder.join("bake.strands.ron"), &bake).unwrap();
    scene_in(folder, motion, |_, _, _| ()).unwrap();

    let mut numbers = fs::read(folder.join("walker.bin")).unwrap();
    numbers[3] ^= 1;
    fs::write(folder.join("walker.bin"), &numbers).unwrap();
    let refused = scene_in(folder, motion, |_, _, _| ()).unwrap_err();
    let said = "gltf.buffers (walker.bin) has changed since";
    assert!(refused.contains(said), "{refused}");

    // Bakes of older builds don't know them.
    let older = bake.lines().filter(|line| !line.contains("gltf.buffers"));
    fs::write(
        folder.join("bake.strands.ron"),
        older.collect::<Vec<_>>().join("\n"),
    )
    .unwrap();
    scene_in(folder, motion, |_, _, _| ()).unwrap();
}

/// A script that goes round is held against the animation below it.
#[test]
fn a_loop_is_as_long_as_the_animation() {
    let folder = tempfile::tempdir().unwrap();
    character(folder.path());
    let refusal = |period: &str| {
        let script = format!("(version: 1,\n period: {period},\n loop: true)");
        fs::write(folder.path().join("loop.motion.ron"), script).unwrap();
        let motion = "gltf: \"walker.gltf\", repeat: true, file: \"loop.motion.ron\"";
        scene_in(folder.path(), motion, |_, _, _| ()).err()
    };
    assert_eq!(refusal("1"), None);
    assert_eq!(refusal("3"), None);
    let message = refusal("1.5").unwrap();
    let expected =
        "loop.motion.ron:3:2: loop: the animation that moves the head is elsewhere after 1.5 s";
    assert!(message.contains(expected), "{message}");
}
