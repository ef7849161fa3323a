//! Presets that build on another one.

use effects::Registry;
use stage::{Files, Preset, Stage};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const BASE: &str = r#"(
    version: 1,
    seed: 7,
    hair: (file: "hair.strands.ron", guides: 0),
    camera: (yaw: 20, pitch: 5),
    clump: (color: "A58D78", size: 12),
    layers: [
        (effect: "hair.base"),
        (effect: "hair.silhouette", depth_offset: 0.03, params: (width: 2.2, color: "3C2E28")),
        (effect: "hair.cel", params: (color: "7B6657")),
        (name: "second shadow", effect: "hair.cel"),
    ],
)"#;

const STRANDS: &str = r#"(
    version: 1,
    strands: [(size: 14, points: [(0.02, 1.619, 0.0), (0.058, 1.601, 0.0), (0.083, 1.55, 0.01), (0.088, 1.45, 0.03)])],
)"#;

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    registry
}

/// A folder with `looks/base.ron`, its hair, and these files beside `looks`.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let all = [
        ("looks/base.ron", BASE),
        ("looks/hair.strands.ron", STRANDS),
    ];
    for (name, text) in all.iter().chain(files) {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn parse<'r>(folder: &Path, text: &str, registry: &'r Registry) -> Result<Preset<'r>, String> {
    Preset::parse_in(folder, "look.ron", text, registry).map_err(|errors| errors.to_string())
}

/// The mistakes of a preset beside `looks`.
fn mistakes(files: &[(&str, &str)], text: &str) -> String {
    let (folder, registry) = (folder(files), registry());
    let parsed = parse(folder.path(), text, &registry);
    let errors = parsed
        .err()
        .unwrap_or_else(|| panic!("this should be refused:\n{text}"));
    errors.replace(&format!("{}/", folder.path().display()), "")
}

fn names(preset: &Preset) -> Vec<String> {
    preset
        .layers
        .iter()
        .map(|layer| layer.name.clone())
        .collect()
}

#[test]
fn the_picture_of_a_brush_is_where_the_base_says() {
    let text = r#"(version: 1, hair: (file: "hair.strands.ron", guides: 0),
        layers: [(effect: "hair.base", brush: (texture: "bristles.png"))])"#;
    let (folder, registry) = (folder(&[("looks/brushed.ron", text)]), registry());
    let path = folder.path().join("looks/bristles.png");
    image::GrayImage::from_pixel(4, 4, image::Luma([200]))
        .save(path)
        .unwrap();
    let text = r#"(version: 1, base: "looks/brushed.ron")"#;
    let preset = parse(folder.path(), text, &registry).unwrap();
    let brush = &preset.layers[0].brush;
    assert_eq!(brush.texture.as_deref(), Some("looks/bristles.png"));
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap();
}

#[test]
fn what_a_preset_does_not_say_its_base_says() {
    let (folder, registry) = (folder(&[]), registry());
    let text =
        r#"(version: 1, base: "looks/base.ron", camera: (yaw: -30), clump: (color: "C8453A"))"#;
    let preset = parse(folder.path(), text, &registry).unwrap();
    assert_eq!(preset.seed, 7);
    assert_eq!(preset.sections.camera.yaw, -30.0);
    assert_eq!(preset.sections.camera.pitch, 5.0);
    assert_eq!(preset.sections.clump.0.number("size"), 12.0);
    assert_eq!(
        names(&preset),
        ["hair.base", "hair.silhouette", "hair.cel", "second shadow"]
    );
    assert_eq!(preset.bases(), [folder.path().join("looks/base.ron")]);
    let base = Preset::parse_in(folder.path(), "", BASE, &registry).unwrap();
    assert_ne!(preset.sections.clump, base.sections.clump);
}

#[test]
fn layers_are_changed_by_name_and_others_come_after_them() {
    let (folder, registry) = (folder(&[]), registry());
    let text = r#"(
        version: 1,
        seed: 3,
        base: "looks/base.ron",
        without: "second shadow",
        layers: [
            (name: "hair.silhouette", params: (width: 4)),
            (effect: "hair.cel", rank: 7),
            (effect: "hair.fine"),
        ],
    )"#;
    let preset = parse(folder.path(), text, &registry).unwrap();
    assert_eq!(preset.seed, 3);
    assert_eq!(
        names(&preset),
        ["hair.base", "hair.silhouette", "hair.cel", "hair.fine"]
    );
    let [_, lines, cel, _] = &preset.layers[..] else {
        panic!()
    };
    assert_eq!(lines.values.number("width"), 4.0);
    assert_eq!(lines.depth_offset, 0.03);
    let base = Preset::parse_in(folder.path(), "", BASE, &registry).unwrap();
    assert_eq!(
        lines.values.value("color"),
        base.layers[1].values.value("color")
    );
    assert_eq!((cel.rank, cel.effect.id()), (7, "hair.cel"));
    assert_eq!(cel.values, base.layers[2].values);
}

#[test]
fn another_effect_takes_the_place_of_a_layer() {
    let (folder, registry) = (folder(&[]), registry());
    let text = r#"(version: 1, base: "looks/base.ron", layers: [(name: "hair.cel", effect: "hair.toon")])"#;
    let preset = parse(folder.path(), text, &registry).unwrap();
    assert_eq!(preset.layers[2].effect.id(), "hair.toon");
    assert_eq!(preset.layers.len(), 4);
}

#[test]
fn files_of_a_base_are_found_from_where_it_is() {
    let chained = r#"(version: 1, base: "../looks/base.ron", light: (yaw: 10))"#;
    let (folder, registry) = (folder(&[("mine/one.ron", chained)]), registry());
    let preset = parse(
        folder.path(),
        r#"(version: 1, base: "mine/one.ron")"#,
        &registry,
    )
    .unwrap();
    assert_eq!(preset.sections.light.yaw, 10.0);
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    preset.check_files(&files).unwrap();
    let stage = Stage::new(&preset, &files).unwrap();
    assert_eq!(stage.scene.objects().len(), 1);
    // Whoever watches the preset watches its bases too.
    let watched: Vec<_> = preset
        .files(&files)
        .iter()
        .map(|path| fs::canonicalize(path).unwrap())
        .collect();
    for name in ["mine/one.ron", "looks/base.ron", "looks/hair.strands.ron"] {
        let path = fs::canonicalize(folder.path().join(name)).unwrap();
        assert!(watched.contains(&path), "{name}");
    }
}

#[test]
fn a_file_that_is_said_anew_is_found_beside_the_preset() {
    let (folder, registry) = (folder(&[("own.strands.ron", STRANDS)]), registry());
    let text = r#"(version: 1, base: "looks/base.ron", hair: (file: "own.strands.ron"))"#;
    let preset = parse(folder.path(), text, &registry).unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    preset.check_files(&files).unwrap();
    let wrong = text.replace("own", "owl");
    let preset = parse(folder.path(), &wrong, &registry).unwrap();
    let errors = preset.check_files(&files).unwrap_err().to_string();
    assert!(
        errors.starts_with("look.ron:1:51: file: there is no"),
        "{errors}"
    );
    assert!(
        errors.contains("did you mean `own.strands.ron`?"),
        "{errors}"
    );
}

#[test]
fn mistakes_are_told_of_the_file_that_holds_them() {
    let mistaken = BASE.replace("pitch", "pich");
    let text = r#"(version: 1, base: "looks/other.ron")"#;
    let errors = mistakes(&[("looks/other.ron", &mistaken)], text);
    assert!(
        errors.starts_with("looks/other.ron:5:23: camera has no `pich`"),
        "{errors}"
    );

    // What only the scene shows.
    let (folder, registry) = (folder(&[]), registry());
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    fs::write(
        folder.path().join("looks/hair.strands.ron"),
        "(version: 1, strands: [(points: [])])",
    )
    .unwrap();
    let checked = Preset::check(
        "look.ron",
        &text.replace("other", "base"),
        &registry,
        &files,
    );
    let errors = checked.unwrap_err().to_string();
    assert!(errors.contains("looks/base.ron:4:18: file: "), "{errors}");
}

#[test]
fn bases_that_cannot_be() {
    for (text, expected) in [
        (
            r#"(version: 1, base: "looks/bose.ron")"#,
            "look.ron:1:20: base: there is no `looks/bose.ron`, did you mean `base.ron`?",
        ),
        (
            r#"(version: 1, base: "looks")"#,
            "look.ron:1:20: base: `looks` is a folder, not a file",
        ),
        (r#"(version: 1, base: 3)"#, "look.ron:1:20: base: expected"),
        (
            r#"(version: 1, base: "looks/hair.strands.ron")"#,
            "looks/hair.strands.ron:3:5: a preset has no `strands`",
        ),
        (
            r#"(version: 1, base: "look.ron")"#,
            "look.ron:1:20: base: `look.ron` builds on this preset itself",
        ),
        (
            r#"(version: 1, base: "a.ron")"#,
            "b.ron:1:20: base: `a.ron` builds on this preset itself",
        ),
        (
            r#"(version: 1, base: "0.ron")"#,
            "14.ron:1:20: base: more than 16 presets build on each other",
        ),
        (
            r#"(version: 1, base: "looks/base.ron", layers: [(name: "hair.sil", params: ())])"#,
            "look.ron:1:47: a new layer needs `effect`, and the base has no layer `hair.sil`, did you mean `hair.silhouette`?",
        ),
        (
            r#"(version: 1, base: "looks/base.ron", without: "hair.cell")"#,
            "look.ron:1:47: without: the base has no layer `hair.cell`, did you mean `hair.cel`?",
        ),
        (
            r#"(version: 1, without: "hair.cel", layers: [])"#,
            "look.ron:1:23: without: it leaves out layers of a `base`, and there is none",
        ),
        (
            r#"(version: 1, base: "looks/base.ron", objects: [(preset: "looks/base.ron")])"#,
            "look.ron:1:38: this preset's base describes hair itself",
        ),
        (
            r#"(version: 1, base: "pair.ron", clump: (size: 3))"#,
            "look.ron:1:32: this preset names objects, and `clump` is said in their presets",
        ),
    ] {
        let mut files = vec![
            ("look.ron".to_owned(), SELF.to_owned()),
            (
                "a.ron".to_owned(),
                r#"(version: 1, base: "b.ron")"#.to_owned(),
            ),
            (
                "b.ron".to_owned(),
                r#"(version: 1, base: "a.ron")"#.to_owned(),
            ),
            (
                "pair.ron".to_owned(),
                r#"(version: 1, objects: [(preset: "looks/base.ron")])"#.to_owned(),
            ),
        ];
        files.extend((0..20).map(|i| {
            (
                format!("{i}.ron"),
                format!(r#"(version: 1, base: "{}.ron")"#, i + 1),
            )
        }));
        let files: Vec<(&str, &str)> = files
            .iter()
            .map(|(name, text)| (&name[..], &text[..]))
            .collect();
        let found = mistakes(&files, text);
        assert!(
            found.lines().any(|line| line.starts_with(expected)),
            "{text}\n{found}"
        );
    }
}

const SELF: &str = r#"(version: 1, base: "look.ron")"#;

#[test]
fn a_base_of_objects_gives_its_objects() {
    let pair = r#"(version: 1, camera: (yaw: 3, pitch: 9), objects: [(preset: "base.ron"), (preset: "base.ron", turn: 90)])"#;
    let (folder, registry) = (folder(&[("looks/pair.ron", pair)]), registry());
    let text = r#"(version: 1, base: "looks/pair.ron", camera: (yaw: 4))"#;
    let preset = parse(folder.path(), text, &registry).unwrap();
    assert_eq!(
        (preset.sections.camera.yaw, preset.sections.camera.pitch),
        (4.0, 9.0)
    );
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    assert_eq!(
        Stage::new(&preset, &files).unwrap().scene.objects().len(),
        2
    );
}
