//! Shadows that hair casts: on the forehead under a fringe, moved as the light is, none on what is behind the light, none on a strand by itself.

use effects::Registry;
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Picture};
use stage::{Files, Preset, Stage};
use std::fs;

const SIZE: usize = 240;

/// Skin in light and in shadow, sRGB: neither is anywhere else.
const LIGHT: &str = "FFE0D0";
const SHADOW: &str = "B07090";

/// Locks over the forehead, which stand off it, so far from its middle (m).
fn locks(places: &[f32]) -> String {
    let strands = places.iter().map(|x| {
        format!(
            "(points: [({x}, 1.62, 0.03), ({x}, 1.605, 0.09), ({x}, 1.57, 0.115), ({x}, 1.545, 0.118)])"
        )
    });
    strands.collect::<Vec<_>>().join(", ")
}

fn fringe() -> String {
    locks(&[-0.05, -0.025, 0.0, 0.025, 0.05])
}

/// Seen from `yaw` (degrees), in the light that the preset says.
fn look(strands: &str, layers: &str, light: &str, yaw: f32) -> Stage {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("(version: 1, strands: [{strands}])");
    fs::write(folder.path().join("a.strands.ron"), text).unwrap();
    let text = format!(
        "(version: 1, hair: (file: \"a.strands.ron\"), scene: (size: ({SIZE}, {SIZE}), samples: 4, background: \"FFFFFF\"),
          head: (shape: bust, width: 0, light: \"{LIGHT}\", shadow: \"{SHADOW}\", threshold: -1),
          clump: (size: 0.35, color: \"804020\"), camera: (distance: 3, yaw: {yaw}), {light}
          layers: [(effect: \"hair.base\"), {layers}])"
    );
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    let preset = Preset::parse("look.ron", &text, &registry).unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}

fn drawing(stage: &mut Stage) -> Drawing {
    let frame = stage.frame().unwrap();
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
    drawing
}

fn picture(strands: &str, layers: &str, light: &str) -> Picture {
    picture_from(0.0, strands, layers, light)
}

fn picture_from(yaw: f32, strands: &str, layers: &str, light: &str) -> Picture {
    let drawing = drawing(&mut look(strands, layers, light, yaw));
    let draw = |threads| {
        let mut rasterizer = Rasterizer::new(4, Some(threads)).unwrap();
        rasterizer.draw(&drawing).unwrap()
    };
    let picture = draw(1);
    assert_eq!(
        picture,
        draw(3),
        "the same picture for any number of threads"
    );
    picture
}

fn light(yaw: f32, pitch: f32) -> String {
    format!("light: (yaw: {yaw}, pitch: {pitch}),")
}

/// How many pixels show the skin in shadow, the mean of their columns, and the lowest row that has one.
fn shadow(picture: &Picture) -> (usize, f32, usize) {
    let color = effects::parse_hex(SHADOW).unwrap();
    let is_it = |pixel: &[f32; 4]| (0..3).all(|i| (pixel[i] - color[i]).abs() < 1e-3);
    let places: Vec<usize> = (0..SIZE * SIZE)
        .filter(|i| is_it(&picture.pixels[*i]))
        .collect();
    let columns = places.iter().map(|i| (i % SIZE) as f32).sum::<f32>();
    let lowest = places.iter().map(|i| i / SIZE).max();
    (
        places.len(),
        columns / places.len().max(1) as f32,
        lowest.unwrap_or(0),
    )
}

const CAST: &str = "(effect: \"hair.cast\")";

#[test]
fn a_fringe_casts_a_shadow_on_the_forehead_that_moves_with_the_light() {
    let without = picture(&fringe(), "", &light(0.0, 45.0));
    assert_eq!(shadow(&without).0, 0);
    let (count, ..) = shadow(&picture(&fringe(), CAST, &light(0.0, 45.0)));
    assert!(count > 150, "{count}");
    let seen = |yaw, pitch| shadow(&picture(&locks(&[0.0]), CAST, &light(yaw, pitch)));
    // Under the lock: the higher the light, the lower its shadow.
    let [(_, middle, low), (_, _, lower)] = [seen(0.0, 45.0), seen(0.0, 65.0)];
    assert!(lower > low, "{low}, {lower}");
    // To the side that is away from the light.
    let [(_, right, _), (_, left, _)] = [seen(-40.0, 45.0), seen(40.0, 45.0)];
    assert!(
        left < middle - 4.0 && right > middle + 4.0,
        "{left}, {middle}, {right}"
    );
    // Nowhere else than on what is skin without it.
    let with = picture(&fringe(), CAST, &light(-40.0, 45.0));
    let other = picture(&fringe(), "", &light(-40.0, 45.0));
    let skin = effects::parse_hex(LIGHT).unwrap();
    let is_skin = |pixel: &[f32; 4]| (0..3).all(|i| (pixel[i] - skin[i]).abs() < 1e-3);
    let shade = effects::parse_hex(SHADOW).unwrap();
    for (with, without) in with.pixels.iter().zip(&other.pixels) {
        let is_shade = (0..3).all(|i| (with[i] - shade[i]).abs() < 1e-3);
        assert!(!is_shade || is_skin(without), "{with:?}, {without:?}");
    }
}

#[test]
fn light_from_behind_casts_nothing_that_is_seen() {
    for yaw in [90.0, 135.0, 180.0] {
        let light = light(yaw, 30.0);
        let with = drawing(&mut look(&fringe(), CAST, &light, 0.0));
        let strokes = &with.layers[1];
        let fixed = "light: (yaw: 0, pitch: 30, fixed_to: camera),";
        assert!(strokes.discs.iter().all(|disc| disc.radius == 0.0), "{yaw}");
        let without = picture(&fringe(), "", &light);
        assert!(picture(&fringe(), CAST, &light) == without, "{yaw}");
        assert!(picture(&fringe(), CAST, fixed) != without);
    }
    // Seen from behind, light in front of the face is behind the head.
    let world = "light: (yaw: 0, pitch: 30, fixed_to: world),";
    let [with, without] = [CAST, ""].map(|layers| picture_from(180.0, &fringe(), layers, world));
    assert!(with == without);
}

#[test]
fn a_strand_casts_nothing_on_itself_and_a_deeper_one_lies_in_its_shadow() {
    // A loop before itself, off the head: in pieces, as it curls.
    let ringlet = |x: f64, z: f64| {
        let point = |i: u32| {
            let turn = f64::from(i) * 0.5;
            let (sine, cosine) = turn.sin_cos();
            let y = 1.56 - 0.004 * f64::from(i);
            format!("({}, {y}, {})", x + 0.03 * cosine, z + 0.03 * sine)
        };
        let points: Vec<String> = (0..40).map(point).collect();
        format!("(points: [{}])", points.join(", "))
    };
    let layer = "(effect: \"hair.cast\", clip: \"hair\", reach: 0, params: (color: \"00FF00\"))";
    let light = light(20.0, 40.0);
    let one = ringlet(0.11, 0.0);
    let [with, without] = [layer, ""].map(|layers| picture(&one, layers, &light));
    assert!(with == without);
    let green = |picture: &Picture| {
        let is_green = |p: &&[f32; 4]| p[1] > 0.9 && p[0] < 0.1 && p[2] < 0.1;
        picture.pixels.iter().filter(is_green).count()
    };
    let two = [one, ringlet(0.11, -0.1)].join(", ");
    assert!(green(&picture(&two, layer, &light)) > 50);
    // Two that are as deep as each other have no shadow of each other.
    let flat = |x: f64| format!("(points: [({x}, 1.6, 0.1), ({x}, 1.5, 0.1), ({x}, 1.4, 0.1)])");
    let beside = [flat(0.11), flat(0.12)].join(", ");
    let layer = "(effect: \"hair.cast\", clip: \"hair\", params: (color: \"00FF00\"))";
    assert_eq!(green(&picture(&beside, layer, &light)), 0);
}

#[test]
fn names_and_words_that_cannot_be_are_told_at_their_place() {
    let text = |layer: &str| {
        format!(
            "(version: 1, hair: (file: \"a.strands.ron\"), head: (shape: figure),\n layers: [\n{layer}])"
        )
    };
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let strands = format!("(version: 1, strands: [{}])", fringe());
    fs::write(folder.path().join("a.strands.ron"), strands).unwrap();
    let fault = |layer: &str| {
        let text = text(layer);
        let preset = match Preset::parse("look.ron", &text, &registry) {
            Ok(preset) => preset,
            Err(errors) => return errors.to_string(),
        };
        let files = Files {
            preset_folder: folder.path().to_owned(),
            ..Files::default()
        };
        let checked = preset.check_scene("look.ron", &text, &files);
        checked
            .err()
            .map_or(String::new(), |errors| errors.to_string())
    };
    for right in [
        "(effect: \"hair.cast\")",
        "(effect: \"hair.cast\", clip: \"skin, dress, eyes\", reach: 0.1)",
        "(effect: \"hair.cel\", clip: \"Head, hair\")",
    ] {
        assert_eq!(fault(right), "");
    }
    for (wrong, expected) in [
        (
            "(effect: \"hair.cast\", clip: \"skim\")",
            "look.ron:3:29: clip: there is no mesh `skim` to be drawn on, did you mean `skin`?",
        ),
        (
            "(effect: \"hair.cel\", reach: 0.1)",
            "`reach` is of strokes that are drawn on something",
        ),
        ("(effect: \"hair.cast\", reach: -1)", "0 to 10"),
        (
            "(effect: \"hair.toon\", clip: \"head\")",
            "`clip` is of strokes in colours of their own, and `hair.toon` paints each sample",
        ),
        (
            "(effect: \"mesh.flat\", on: \"skin\", clip: \"head\")",
            "`clip` is of strokes, and `mesh.flat` paints meshes",
        ),
    ] {
        let found = fault(wrong);
        assert!(found.contains(expected), "{wrong}: {found}");
    }
}
