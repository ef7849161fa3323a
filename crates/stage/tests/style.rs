//! Hair styles on heads: what grows, and that no scalp shows.

use effects::Registry;
use glam::Vec3;
use render::Drawing;
use render::cpu::{Evaluator, Rasterizer};
use stage::{Files, FrameMaker, Look, Motion, Preset, Scene, Stage};
use std::fs;
use std::path::{Path, PathBuf};

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    registry
}

/// The message that a style is refused with.
fn refusal(style: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.style.ron"), style).unwrap();
    let text = "(version: 1, hair: (file: \"a.style.ron\"), head: (shape: bust), \
                layers: [(effect: \"hair.base\")])";
    let registry = registry();
    let preset = Preset::parse("look.ron", text, &registry).unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    match Stage::new(&preset, &files) {
        Ok(_) => panic!("this should be refused:\n{style}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn mistakes_in_styles_have_their_places() {
    let style = "(
    version: 1,
    zones: [
        (name: \"a\", roots: [(0, 50), (0, 95)], tips: [(0, 0)], cuont: 3),
        (name: \"b\", tips: [(0, 0)], size: -1),
        (name: \"c\", roots: [(10, 10)]),
        (name: \"c\", roots: [], hang: 1, mirror: yes),
        (name: \"d\", roots: partin, hang: 1),
        (name: \"e\", roots: hairline(0), hang: 1),
    ],
    edits: [
        (zone: \"aa\"),
        (zone: \"a\", clump: 9),
        (zone: \"b\", mirrored: true),
    ],
    strands: [(size: 3), (points: [(0, 0, 0), (0, 0, 99)])],
)";
    let message = refusal(style);
    for line in [
        "a.style.ron:4:38: roots: expected (longitude from -360 to 360",
        "a.style.ron:4:64: a zone has no `cuont`, did you mean `count`?",
        "a.style.ron:5:9: a zone needs `roots`",
        "a.style.ron:5:43: size: expected a number from 0 to 200, found `-1`",
        "a.style.ron:6:9: a zone needs `tips` to lead to, or a length to `hang`",
        "a.style.ron:7:9: there is already a zone `c`",
        "a.style.ron:7:28: roots needs at least one place",
        "a.style.ron:8:28: roots: expected a list of places",
        "a.style.ron:9:28: roots: expected hairline(FROM, TO)",
        "a.style.ron:12:9: there is no zone `aa` to edit, did you mean `a`?",
        "a.style.ron:13:9: the zone `a` has clumps 0 to 7, no 9",
        "a.style.ron:14:9: the zone `b` has no mirrored half",
        "a.style.ron:16:15: a strand needs `points`, two or more",
        "a.style.ron:16:47: points: expected (longitude",
        "there is no `yes`",
    ] {
        assert!(message.contains(line), "`{line}` is missing in:\n{message}");
    }
    assert!(refusal("(zones: [])").contains("needs `version: 1`"));
    assert!(refusal("(version: 1)").contains("has no `zones`"));
    assert!(refusal("(version: 1, zones: [])").contains("has no `zones`"));
}

#[test]
fn a_style_needs_a_head() {
    let text = "(version: 1, hair: (file: \"styles/bob.style.ron\"), \
                layers: [(effect: \"hair.base\")])";
    let registry = registry();
    let preset = Preset::parse("look.ron", text, &registry).unwrap();
    let files = Files {
        preset_folder: presets(),
        ..Files::default()
    };
    let message = Stage::new(&preset, &files).err().unwrap().to_string();
    assert!(message.contains("needs a head to grow on"), "{message}");
}

/// The styles that come with inkstrand.
fn styles() -> Vec<PathBuf> {
    let entries = fs::read_dir(presets().join("styles")).unwrap();
    let mut styles: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    styles.sort();
    assert!(styles.len() >= 8, "{styles:?}");
    styles
}

/// Views all around, as yaw and pitch.
const VIEWS: [[f32; 2]; 10] = [
    [0.0, 0.0],
    [45.0, 10.0],
    [90.0, 0.0],
    [135.0, 10.0],
    [180.0, 0.0],
    [-135.0, 10.0],
    [-90.0, 0.0],
    [-45.0, 10.0],
    [0.0, 60.0],
    [180.0, 85.0],
];

/// Pixels of bare skin where hair grows: within the hairline. One number for each view.
fn scalp_pixels(style: &Path, clump_size: &str, views: &[[f32; 2]]) -> Vec<usize> {
    let registry = registry();
    let text = fs::read_to_string(presets().join("twin-tails.ron")).unwrap();
    let mut preset = Preset::parse("twin-tails.ron", &text, &registry).unwrap();
    for (name, value) in [
        ("head.light", "FF00FF"),
        ("head.shadow", "FF00FF"),
        ("head.width", "0"),
        ("clump.color", "00FF00"),
        ("clump.size", clump_size),
        ("clump.shading", "pure"),
        ("scene.size", "(300, 300)"),
        ("camera.distance", "2.6"),
        ("camera.target", "(0, 0.1, 0)"),
    ] {
        preset.set(name, value).unwrap();
    }
    preset.keep_only(&["hair.base".to_owned()]).unwrap();
    let files = Files {
        preset_folder: presets(),
        hair: Some(style.to_owned()),
        ..Files::default()
    };
    let scene = Scene::load(&preset, &files).unwrap();
    let mut seen_from = |[yaw, pitch]: &[f32; 2]| {
        preset.set("camera.yaw", &yaw.to_string()).unwrap();
        preset.set("camera.pitch", &pitch.to_string()).unwrap();
        pixels(&scene.with_look(Look::new(&preset).unwrap()).unwrap())
    };
    views.iter().map(&mut seen_from).collect()
}

fn pixels(scene: &Scene) -> usize {
    let mut maker = FrameMaker::new();
    let frame = maker.frame(scene, &Motion::new()).unwrap();
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(&frame, &mut drawing).unwrap();

    // The bare scalp over the head, in a colour of its own: what no hair covers shows.
    let (camera, head) = (*frame.camera, frame.objects[0].head);
    let bust = groom::bust();
    let shell = groom::Shell::new(
        &bust.positions,
        &bust.normals,
        &bust.triangles,
        head.center,
        head.height_m,
    );
    let hairline = groom::Scalp::default();
    let is_scalp = |p: Vec3| hairline.contains(shell.place(p));
    let mut scalp = drawing.surfaces[0].clone();
    scalp.vertices.clear();
    scalp.triangles.clear();
    for triangle in &bust.triangles {
        let corners = triangle.map(|i| bust.positions[i as usize]);
        if corners.into_iter().all(is_scalp) {
            let first = scalp.vertices.len() as u32;
            scalp.vertices.extend(corners.map(|p| {
                let view = camera.view_from_world(p);
                render::SurfaceVertex {
                    position: camera.project(view),
                    inv_depth: 1.0001 / view.z,
                    tone: 1.0,
                }
            }));
            scalp.triangles.push([first, first + 1, first + 2]);
        }
    }
    scalp.light = [0.0, 0.0, 1.0];
    drawing.surfaces.push(scalp);
    let picture = Rasterizer::new(1, Some(1)).unwrap().draw(&drawing).unwrap();
    picture
        .pixels
        .iter()
        .filter(|p| p[..3] == [0.0, 0.0, 1.0])
        .count()
}

#[test]
fn no_scalp_shows_from_any_side() {
    for style in styles() {
        let seen = scalp_pixels(&style, "1", &VIEWS);
        assert!(
            seen.iter().all(|pixels| *pixels == 0),
            "{}: {seen:?} pixels of scalp in {VIEWS:?}",
            style.display()
        );
    }
}

#[test]
fn a_bald_head_would_be_noticed() {
    // The count is of what it says: with hair of no size the whole scalp shows.
    let seen = scalp_pixels(&styles()[0], "0", &[[180.0, 85.0]]);
    assert!(seen[0] > 10_000, "{seen:?}");
}

#[test]
fn hair_does_not_change_the_size_of_the_head_it_grows_on() {
    let registry = registry();
    let text = fs::read_to_string(presets().join("twin-tails.ron")).unwrap();
    let preset = Preset::parse("twin-tails.ron", &text, &registry).unwrap();
    let head_under = |style: PathBuf| {
        let files = Files {
            preset_folder: presets(),
            hair: Some(style),
            ..Files::default()
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        stage.frame().unwrap().objects[0].head
    };
    let heads: Vec<render::Head> = styles().into_iter().map(head_under).collect();
    assert!(heads.iter().all(|head| *head == heads[0]), "{heads:?}");
}

#[test]
fn ties_are_bands_of_their_own_colour() {
    let registry = registry();
    let text = fs::read_to_string(presets().join("twin-tails.ron")).unwrap();
    let mut preset = Preset::parse("twin-tails.ron", &text, &registry).unwrap();
    for (name, value) in [("head.tie", "00FF00"), ("head.tie_shadow", "00FF00")] {
        preset.set(name, value).unwrap();
    }
    let bands = |style: &str| {
        let files = Files {
            preset_folder: presets(),
            hair: Some(presets().join("styles").join(style)),
            ..Files::default()
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        let surfaces = stage.frame().unwrap().surfaces;
        let band = surfaces.iter().find(|s| s.light == [0.0, 1.0, 0.0]);
        band.map_or(0, |band| band.triangles.len())
    };
    assert!(bands("twin-tails.style.ron") > 100);
    assert_eq!(bands("bob.style.ron"), 0);
}

#[test]
fn the_scalp_has_the_hairs_colour_around_roots() {
    let registry = registry();
    let text = fs::read_to_string(presets().join("outlined.ron")).unwrap();
    let mut preset = Preset::parse("outlined.ron", &text, &registry).unwrap();
    preset.set("clump.color", "00FF00").unwrap();
    let style = fs::read_to_string(presets().join("styles/bob.style.ron")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut painted = |scalp: &str, undercoat: &str| {
        preset.set("head.scalp", scalp).unwrap();
        let path = folder.path().join("bald.style.ron");
        let text = style.replacen(
            "version: 1,",
            &format!("version: 1, undercoat: {undercoat},"),
            1,
        );
        fs::write(&path, text).unwrap();
        let files = Files {
            preset_folder: presets(),
            hair: Some(path),
            ..Files::default()
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        let surfaces = stage.frame().unwrap().surfaces;
        let scalp = surfaces.iter().find(|s| s.light == [0.0, 1.0, 0.0]);
        let count = |surface: &render::Surface| surface.triangles.len();
        (scalp.map_or(0, count), count(&surfaces[0]))
    };
    let (none, all) = painted("0", "false");
    assert_eq!(none, 0);
    assert_eq!(painted("0.05", "true"), (0, all), "the coat is there");
    let (some, others) = painted("0.05", "false");
    assert!(some > 10 && others > 10, "{some}, {others}");
    assert_eq!(some + others, all);
    let (more, _) = painted("0.1", "false");
    assert!(more > some, "{more}, {some}");
}
