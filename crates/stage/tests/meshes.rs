//! Meshes in colours of their own: characters as their files paint them, and what is beside a head.
#![expect(clippy::print_stderr, reason = "skipped tests say so")]

use effects::Registry;
use glam::Vec3;
use render::cpu::{Evaluator, Rasterizer};
use render::{Coverage, Drawing, Picture, Surface};
use stage::{Files, Preset, Stage};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A head that is a cube with a picture in front, and two eyes of other materials; a plate of which half is cut out.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let corners: Vec<Vec3> = (0..8)
        .map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 0.24 - 0.12)
        .collect();
    let mut cube =
        "mtllib a.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\no Skull\nusemtl Skin\n".to_owned();
    for Vec3 { x, y, z } in corners {
        cube += &format!("v {x} {} {z}\n", y + 1.5);
    }
    // Outwards; the face is at +z.
    cube += "f 5/1 6/2 8/3 7/4\nf 2/1 1/2 3/3 4/4\nf 6/1 2/2 4/3 8/4\nf 1/1 5/2 7/3 3/4\nf 7/1 8/2 4/3 3/4\nf 1/1 2/2 6/3 5/4\n";
    write("head.obj", &cube);
    write(
        "a.mtl",
        "newmtl Skin\nKd 1 1 1\nmap_Kd skin.png\nnewmtl Iris\nKd 0 0 1\n",
    );
    let eye = |x: f32| format!("v {x} 1.5 0.13\nv {} 1.5 0.13\nv {x} 1.56 0.13\n", x + 0.05);
    let eyes = format!(
        "mtllib a.mtl\n{}{}o EyeLeft\nusemtl Iris\nf 1 2 3\no EyeRight\nf 4 5 6\n",
        eye(0.02),
        eye(-0.07)
    );
    write("eyes.obj", &eyes);
    let red_and_green: Vec<u8> = [[255, 0, 0], [0, 255, 0]].concat();
    let bytes = fs::File::create(folder.path().join("skin.png")).unwrap();
    let mut encoder = png::Encoder::new(bytes, 2, 1);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&red_and_green).unwrap();
    writer.finish().unwrap();
    write(
        "a.strands.ron",
        "(version: 1, strands: [
            (points: [(0, 1.62, 0), (0, 1.7, 0)]), (points: [(0.06, 1.6, 0), (0.06, 1.7, 0)]), (points: [(-0.06, 1.6, 0), (-0.06, 1.7, 0)]),
            (points: [(0, 1.6, 0.06), (0, 1.7, 0.06)]), (points: [(0, 1.6, -0.06), (0, 1.7, -0.06)]), (points: [(0, 1.52, -0.1), (0, 1.4, -0.16)]),
        ])",
    );
    folder
}

fn scene(folder: &Path, head: &str, more: &str) -> Result<Stage, String> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = format!(
        "(version: 1, hair: (file: \"a.strands.ron\"), head: (file: \"head.obj\", scale: 1, up: y, width: 0, {head}), \
         scene: (size: (90, 90), samples: 4), camera: (distance: 4), {more} layers: [(effect: \"hair.base\")])"
    );
    let preset = Preset::parse("look.ron", &text, &registry).map_err(|error| error.to_string())?;
    let files = Files {
        preset_folder: folder.to_owned(),
        ..Files::default()
    };
    preset
        .check_scene("look.ron", &text, &files)
        .map_err(|error| error.to_string())?;
    Stage::new(&preset, &files).map_err(|error| error.to_string())
}

fn seen(stage: &mut Stage) -> (Vec<Surface>, Picture) {
    let frame = stage.frame().unwrap();
    let surfaces = frame.surfaces.clone();
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
    let picture = Rasterizer::new(4, Some(1)).unwrap().draw(&drawing).unwrap();
    (surfaces, picture)
}

/// The colour of a pixel, each channel as much or nothing.
fn hue(picture: &Picture, x: usize, y: usize) -> [bool; 3] {
    let [red, green, blue, _] = picture.pixels[y * 90 + x];
    [red, green, blue].map(|channel| channel > 0.2)
}

#[test]
fn a_head_in_its_files_colours() {
    let folder = folder();
    let mut flat = scene(folder.path(), "", "").unwrap();
    let (surfaces, _) = seen(&mut flat);
    assert!(surfaces.iter().all(|surface| surface.texture.is_none()));
    let mut own = scene(folder.path(), "colors: file", "light: (yaw: 0, pitch: 0),").unwrap();
    let (surfaces, picture) = seen(&mut own);
    assert!(surfaces.iter().all(|surface| surface.texture.is_some()));
    // The picture is red on the left of who looks at the face.
    assert_eq!(hue(&picture, 36, 50), [true, false, false]);
    assert_eq!(hue(&picture, 54, 50), [false, true, false]);
}

/// A file without materials has the colours of the preset.
#[test]
fn what_has_no_colour_is_skin() {
    let folder = folder();
    let bare = fs::read_to_string(folder.path().join("head.obj")).unwrap();
    let bare = bare
        .replace("mtllib a.mtl\n", "")
        .replace("usemtl Skin\n", "");
    fs::write(folder.path().join("head.obj"), bare).unwrap();
    let head = "colors: file, light: \"FF0000\", shadow: \"800000\"";
    let (surfaces, _) = seen(&mut scene(folder.path(), head, "").unwrap());
    assert_eq!(surfaces[0].light, [1.0, 0.0, 0.0]);
    let [red, ..] = surfaces[0].shadow;
    assert!(red > 0.2 && red < 0.23, "{red}");
}

#[test]
fn what_is_beside_a_head_moves_with_it() {
    let folder = folder();
    let eyes = "meshes: [(file: \"eyes.obj\", width: 1)], light: (yaw: 0, pitch: 0),";
    let mut still = scene(folder.path(), "", eyes).unwrap();
    let (surfaces, picture) = seen(&mut still);
    // Two eyes and their lines, in the material's colour.
    let blue = |surface: &&Surface| surface.light == [0.0, 0.0, 1.0];
    assert_eq!(surfaces.iter().filter(blue).count(), 2);
    assert_eq!(hue(&picture, 50, 42), [false, false, true]);
    fs::write(
        folder.path().join("a.motion.ron"),
        "(version: 1, moves: [(move: turn, angle: 40)])",
    )
    .unwrap();
    let moved = format!("{eyes} motion: (file: \"a.motion.ron\"),");
    let mut turned = scene(folder.path(), "", &moved).unwrap();
    turned.advance_to(0.5).unwrap();
    let (later, _) = seen(&mut turned);
    let first = |surfaces: &[Surface]| {
        let eye = surfaces.iter().find(|surface| blue(surface)).unwrap();
        eye.vertices[0].position
    };
    assert!(first(&surfaces).distance(first(&later)) > 3.0);
}

#[test]
fn a_meshs_colours_are_said_in_the_preset() {
    let folder = folder();
    let with = |section: &str| {
        let meshes = format!("meshes: [(file: \"eyes.obj\", {section})],");
        let (surfaces, _) = seen(&mut scene(folder.path(), "", &meshes).unwrap());
        surfaces
    };
    let count = |section: &str| with(section).len();
    let all = count("");
    assert_eq!(count("only: \"EyeLeft\""), all - 1);
    assert_eq!(count("hide: \"eye*\""), all - 2);
    assert_eq!(count("hide: \"Iris\""), all - 2, "by the material");
    assert_eq!(count("width: 2"), all + 2);
    let tinted = with("color: \"FFFF00\", shade: 0.5");
    let tints: Vec<_> = tinted.iter().map(|s| (s.light, s.shadow)).collect();
    assert!(tints.contains(&([0.0; 3], [0.0; 3])), "blue times yellow");
}

#[test]
fn a_picture_of_the_presets_own() {
    let folder = folder();
    let scene_with = |section: &str| scene(folder.path(), "", &format!("meshes: [({section})],"));
    let coverage = |section: &str| -> Vec<Coverage> {
        let (surfaces, _) = seen(&mut scene_with(section).unwrap());
        let textures = surfaces.into_iter().filter_map(|surface| surface.texture);
        textures.map(|texture| texture.coverage).collect()
    };
    let cube = "file: \"head.obj\", texture: \"skin.png\"";
    assert_eq!(coverage(cube), [Coverage::Cut(0.5)]);
    assert_eq!(
        coverage(&format!("{cube}, alpha: blend")),
        [Coverage::Share]
    );
    assert_eq!(
        coverage("file: \"head.obj\""),
        [Coverage::Ignored],
        "the file's own"
    );
    let told = |section: &str| scene_with(section).err().unwrap();
    let message = told("file: \"eyes.obj\", texture: \"skin.png\"");
    assert!(
        message.contains("eyes.obj: it has no texture coordinates"),
        "{message}"
    );
    let message = told("file: \"head.obj\", texture: \"skim.png\"");
    assert!(
        message.contains("look.ron:1:") && message.contains("did you mean `skin.png`?"),
        "{message}"
    );
    fs::write(folder.path().join("skin.png"), b"GIF89a").unwrap();
    let message = told(cube);
    assert!(
        message.contains("look.ron:1:") && message.contains("neither PNG nor JPEG"),
        "{message}"
    );
}

#[test]
fn the_heads_own_meshes_may_be_hidden() {
    let folder = folder();
    fs::copy(
        folder.path().join("eyes.obj"),
        folder.path().join("beside.obj"),
    )
    .unwrap();
    let text = fs::read_to_string(folder.path().join("head.obj")).unwrap();
    fs::write(
        folder.path().join("head.obj"),
        format!("{text}o Hat\nv 0 1.62 0\nv 0.1 1.62 0\nv 0 1.7 0\nf -3 -2 -1\n"),
    )
    .unwrap();
    let triangles = |head: &str| {
        let stage = scene(folder.path(), head, "").unwrap();
        (stage.head().height_m, stage.notes().to_vec())
    };
    let (with_hat, _) = triangles("colors: file");
    let (without, _) = triangles("colors: file, hide: \"Hat\"");
    assert!(with_hat > without, "{with_hat} {without}");
}

#[test]
fn mistakes_are_told() {
    let folder = folder();
    let told = |head: &str, more: &str| match scene(folder.path(), head, more) {
        Ok(_) => panic!("{head} {more} is taken"),
        Err(message) => message,
    };
    let message = told("hide: \"Skul\"", "");
    assert!(
        message.contains("no mesh, material or bone is called `Skul`"),
        "{message}"
    );
    assert!(message.contains("did you mean `Skull`?"), "{message}");
    assert!(told("hide: \"Sk*\"", "").contains("hides all of its meshes"));
    let message = told("", "meshes: [(color: \"FFFFFF\")],");
    assert!(message.contains("a mesh needs `file: "), "{message}");
    let message = told("", "meshes: [(file: \"eyse.obj\")],");
    assert!(
        message.contains("look.ron:1:") && message.contains("did you mean `eyes.obj`?"),
        "{message}"
    );
    let message = told("", "meshes: (file: \"eyes.obj\"),");
    assert!(message.contains("meshes is a list"), "{message}");
    fs::write(folder.path().join("broken.obj"), "v 0 0\nf 1 2 3\n").unwrap();
    let message = told("", "meshes: [(file: \"broken.obj\")],");
    assert!(
        message.contains("look.ron:1:") && message.contains("broken.obj:1"),
        "{message}"
    );
    fs::write(folder.path().join("skin.png"), b"\x89PNG\r\n\x1a\nnothing").unwrap();
    let message = told("colors: file", "");
    assert!(
        message.contains("head.obj: picture") && message.contains("skin.png"),
        "{message}"
    );
}

/// Sintel with her eyes and lashes; Godette in the colours of her file.
#[test]
fn characters_are_drawn_in_their_colours() {
    let Some(data) = std::env::var_os("INKSTRAND_DATA") else {
        return eprintln!("SKIPPED 1 test: INKSTRAND_DATA is not set");
    };
    let data = Path::new(&data);
    let folder = folder();
    let draw = |head: &str, more: &str| {
        let mut registry = Registry::new();
        effects_builtin::register(&mut registry).unwrap();
        let text = format!(
            "(version: 1, hair: (file: \"a.strands.ron\"), head: ({head}), scene: (size: (90, 90), samples: 4), {more} \
             layers: [(effect: \"hair.base\")])"
        );
        let preset = Preset::parse("look.ron", &text, &registry).unwrap();
        let files = Files {
            preset_folder: folder.path().to_owned(),
            ..Files::default()
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        seen(&mut stage)
    };
    let path = |name: &str| format!("{:?}", data.join(name).display().to_string());
    let (surfaces, picture) = draw(
        &format!("file: {}, colors: file", path("vrm/Godette_vrm_v4.vrm")),
        "camera: (distance: 12, target: (0, -2, 0)),",
    );
    assert!(surfaces.iter().filter(|s| s.texture.is_some()).count() >= 4);
    let blend = |s: &&Surface| {
        s.texture
            .as_ref()
            .is_some_and(|t| t.coverage == Coverage::Share)
    };
    assert_eq!(
        surfaces.iter().filter(blend).count(),
        2,
        "a logo, from both sides"
    );
    let drawn = picture.pixels.iter().filter(|pixel| pixel[3] > 0.0);
    let colors: std::collections::BTreeSet<_> = drawn
        .map(|pixel| [0, 1, 2].map(|i| (pixel[i] * 8.0) as u32))
        .collect();
    assert!(colors.len() > 20, "{}", colors.len());
    let (with_eyes, _) = draw(
        &format!("file: {}", path("sintel/sintel.obj")),
        &format!(
            "meshes: [(file: {}, color: \"FFFFFF\"), (file: {}, color: \"201010\")],",
            path("sintel/sintel-eyes.obj"),
            path("sintel/sintel-eyelashes.obj")
        ),
    );
    let (without, _) = draw(&format!("file: {}", path("sintel/sintel.obj")), "");
    assert!(with_eyes.len() >= without.len() + 2);
}
