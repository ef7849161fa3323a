//! Hair styles on heads: what grows, and that no scalp shows.

use effects::Registry;
use glam::Vec3;
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Surface, SurfaceVertex};
use stage::{Files, Preset, Stage};
use std::fs;
use std::path::{Path, PathBuf};
use stroke_path::{Camera, OrbitView};

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
    accessories: [
        (kind: clip),
        (kind: bow, at: [(0, 10), (20, 30)]),
        (kind: hairband, at: [(0, 10)]),
        (kind: cilp, at: [(0, 99)]),
    ],
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
        "a.style.ron:18:9: an accessory needs `at`",
        "a.style.ron:19:9: a clip or a bow lies at one place",
        "a.style.ron:20:9: a hairband needs two places or more",
        "a.style.ron:21:16: kind: ",
        "a.style.ron:21:27: at: expected (longitude from -360 to 360",
    ] {
        assert!(message.contains(line), "`{line}` is missing in:\n{message}");
    }
    // A tail has no rows, whatever it says of them.
    let message = refusal(
        "(version: 1, zones: [
            (name: \"a\", count: 200, rows: 32, roots: parting, hang: 1),
            (name: \"b\", form: tail, count: 8, rows: 2, roots: [(0, 20)], hang: 1)],
        edits: [(zone: \"b\", clump: 8)])",
    );
    assert!(
        message.contains(
            "a.style.ron:2:13: `count` 200 in 32 rows are 6400 clumps, a zone has at most 5000"
        ),
        "{message}"
    );
    assert!(
        message.contains("the zone `b` has clumps 0 to 7, no 8"),
        "{message}"
    );
    let many = "(points: [(0, 60, 0.05), (0, 20, 0.1)]),\n".repeat(5001);
    let message = refusal(&format!("(version: 1, strands: [\n{many}])"));
    assert!(
        message.contains("a.style.ron:5002:1: a style has at most 5000 `strands`"),
        "{message}"
    );
    assert!(refusal("(zones: [])").contains("needs `version: 1`"));
    assert!(refusal("(version: 1, zonse: [])").contains("no `zonse`, did you mean `zones`?"));
    assert!(
        refusal("(version: 1, qqq: 1)").contains("hairline, zones, edits, strands, accessories")
    );
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

/// Pixels of bare skin where hair grows, within the hairline, in each view.
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
    ] {
        preset.set(name, value).unwrap();
    }
    preset.keep_only(&["hair.base".to_owned()]).unwrap();
    let files = Files {
        preset_folder: presets(),
        hair: Some(style.to_owned()),
        ..Files::default()
    };
    let mut stage = Stage::new(&preset, &files).unwrap();
    let mut rasterizer = Rasterizer::new(1, Some(1)).unwrap();
    let scalp = Scalp::new();
    let pixels = |[yaw_degrees, pitch_degrees]: &[f32; 2]| {
        let head = stage.head();
        let view = OrbitView {
            target: head.center + Vec3::Y * (0.1 * head.height_m),
            yaw_degrees: *yaw_degrees,
            pitch_degrees: *pitch_degrees,
            distance_m: 2.6 * head.height_m,
            vertical_fov_degrees: 30.0,
        };
        let camera = Camera::orbit(view, [300, 300], 0.01).unwrap();
        let frame = stage.frame_seen_by(camera).unwrap();
        let mut drawing = Drawing::default();
        Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
        let surface = scalp.surface(&camera, drawing.surfaces[0].clone());
        drawing.surfaces.push(surface);
        let picture = rasterizer.draw(&drawing).unwrap();
        let is_scalp = |pixel: &&[f32; 4]| pixel[..3] == [0.0, 0.0, 1.0];
        picture.pixels.iter().filter(is_scalp).count()
    };
    views.iter().map(pixels).collect()
}

/// The bare scalp over the head, in a colour of its own: what no hair covers shows.
struct Scalp {
    corners: Vec<Vec3>,
}

impl Scalp {
    fn new() -> Self {
        let bust = groom::bust();
        let (middle, height_m) = (Vec3::new(0.0, 1.5, 0.0), 0.24);
        let shell = groom::Shell::new(
            &bust.positions,
            &bust.normals,
            &bust.triangles,
            middle,
            height_m,
        );
        let hairline = groom::Scalp::default();
        let is_scalp = |p: &Vec3| hairline.contains(shell.place(*p));
        let triangles = bust.triangles.iter();
        let corners = triangles
            .map(|triangle| triangle.map(|i| bust.positions[i as usize]))
            .filter(|corners| corners.iter().all(is_scalp));
        Self {
            corners: corners.flatten().collect(),
        }
    }

    fn surface(&self, camera: &Camera, like: Surface) -> Surface {
        let vertex = |p: &Vec3| {
            let view = camera.view_from_world(*p);
            SurfaceVertex {
                position: camera.project(view),
                inv_depth: 1.0001 / view.z,
                tone: 1.0,
            }
        };
        let triangles = (0..self.corners.len() as u32).step_by(3);
        Surface {
            vertices: self.corners.iter().map(vertex).collect(),
            triangles: triangles.map(|i| [i, i + 1, i + 2]).collect(),
            light: [0.0, 0.0, 1.0],
            ..like
        }
    }
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
    let bare = scalp_pixels(&styles()[0], "0", &[[180.0, 85.0]]);
    assert!(bare[0] > 10_000, "{bare:?}");
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
fn what_hair_wears_is_drawn_in_the_colours_of_ties() {
    let registry = registry();
    let text = fs::read_to_string(presets().join("short-ash.ron")).unwrap();
    let mut preset = Preset::parse("short-ash.ron", &text, &registry).unwrap();
    for (name, value) in [("head.tie", "00FF00"), ("head.tie_shadow", "00FF00")] {
        preset.set(name, value).unwrap();
    }
    let style = fs::read_to_string(presets().join("styles/bob.style.ron")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let triangles = |accessories: &str| {
        let path = folder.path().join("worn.style.ron");
        let text = format!("version: 1, accessories: [{accessories}],");
        fs::write(&path, style.replacen("version: 1,", &text, 1)).unwrap();
        let files = Files {
            preset_folder: presets(),
            hair: Some(path),
            ..Files::default()
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        let surfaces = stage.frame().unwrap().surfaces;
        let worn = surfaces.iter().find(|s| s.light == [0.0, 1.0, 0.0]);
        worn.map_or(0, |surface| surface.triangles.len())
    };
    assert_eq!(triangles(""), 0);
    let one = triangles("(at: [(30, 40)], lift: 0.2)");
    let two = triangles("(at: [(30, 40)], lift: 0.2, mirror: true)");
    assert!(one > 50 && two > one, "{one} {two}");
    assert!(triangles("(kind: bow, at: [(0, 60)], lift: 0.2)") > one);
    assert!(triangles("(kind: hairband, at: [(-90, 0), (0, 80), (90, 0)], lift: 0.2)") > one);
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
        let count = |surface: &Surface| surface.triangles.len();
        (scalp.map_or(0, count), count(&surfaces[0]))
    };
    let (none, all) = painted("0", "false");
    assert_eq!(none, 0);
    assert_eq!(painted("0.05", "true"), (0, all), "the coat is there");
    let (some, others) = painted("0.05", "false");
    assert!(some > 10 && others > 10, "{some}, {others}");
    assert!(
        some + others >= all,
        "triangles are cut along the hairline: {some}, {others}, {all}"
    );
    let (more, _) = painted("0.1", "false");
    assert!(more > some, "{more}, {some}");
}
