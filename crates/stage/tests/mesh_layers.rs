//! Layers that paint meshes: of figures, of files beside a head; names, mistakes, and eyes seen through hair.

use effects::Registry;
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Picture, Surface};
use stage::{Files, Preset, Stage};
use std::fs;
use tempfile::TempDir;

/// A curtain of hair before the face, and a pair of plates as glasses.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let strands: Vec<String> = (-6..=6)
        .map(|i| {
            let x = 0.012 * f64::from(i);
            format!("(points: [({x}, 1.63, 0.06), ({x}, 1.6, 0.13), ({x}, 1.4, 0.14)])")
        })
        .collect();
    let text = format!("(version: 1, strands: [{}])", strands.join(", "));
    fs::write(folder.path().join("a.strands.ron"), text).unwrap();
    let glasses =
        "v 0.02 1.48 0.2\nv 0.06 1.48 0.2\nv 0.06 1.52 0.2\nv 0.02 1.52 0.2\nf 1 2 3\nf 1 3 4\n";
    fs::write(folder.path().join("glasses.obj"), glasses).unwrap();
    folder
}

fn text(head: &str, more: &str, layers: &str) -> String {
    format!(
        "(version: 1, hair: (file: \"a.strands.ron\"),\n head: (width: 0, {head}), scene: (size: (120, 120), samples: 4),\n\
         clump: (size: 0.5, color: \"C04020\"), camera: (distance: 3), light: (yaw: 0, pitch: 10), {more}\n layers: [(effect: \"hair.base\"),\n  {layers}])"
    )
}

fn scene(head: &str, more: &str, layers: &str) -> Result<Stage, String> {
    let (folder, text) = (folder(), text(head, more, layers));
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    let preset = Preset::parse("look.ron", &text, &registry).map_err(|error| error.to_string())?;
    let files = Files {
        preset_folder: folder.path().to_owned(),
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

fn painted(surfaces: &[Surface]) -> usize {
    surfaces
        .iter()
        .filter(|surface| surface.paint.is_some())
        .count()
}

const FIGURE: &str = "shape: figure, dress: collar, blush: flat,";

#[test]
fn what_a_layer_names_is_painted_and_nothing_else() {
    let count = |layers: &str| {
        let mut stage = scene(FIGURE, "", layers).unwrap();
        let (surfaces, _) = seen(&mut stage);
        painted(&surfaces)
    };
    assert_eq!(count(""), 0);
    assert_eq!(count("(effect: \"mesh.flat\", on: \"skin\")"), 1);
    assert_eq!(count("(effect: \"mesh.flat\", on: \"brows\")"), 2);
    assert_eq!(count("(effect: \"mesh.flat\", on: \"blush\")"), 2);
    // Eyes of many pieces; the dress with its accents and lines.
    assert!(count("(effect: \"mesh.toon\", on: \"Eyes\")") > 10);
    assert!(count("(effect: \"mesh.toon\", on: \"dress\")") >= 2);
    let all = count("(effect: \"mesh.toon\", on: \"*\")");
    let both = "(effect: \"mesh.toon\", on: \"*\"), (effect: \"mesh.flat\", on: \"eyes\")";
    assert_eq!(count(both), all, "one layer paints each");
}

#[test]
fn the_last_layer_that_means_a_mesh_paints_it() {
    let layers = "(effect: \"mesh.flat\", on: \"*\", params: (light: \"FF0000\", shade: \"FF0000\")),
        (effect: \"mesh.flat\", name: \"b\", on: \"skin\", params: (light: \"00FF00\", shade: \"00FF00\"))";
    let mut stage = scene(FIGURE, "", layers).unwrap();
    let (_, picture) = seen(&mut stage);
    let is = |pixel: &[f32; 4], color: [f32; 3]| (0..3).all(|i| (pixel[i] - color[i]).abs() < 1e-5);
    let count = |color| {
        picture
            .pixels
            .iter()
            .filter(|pixel| is(pixel, color))
            .count()
    };
    assert!(count([0.0, 1.0, 0.0]) > 200, "skin");
    assert!(count([1.0, 0.0, 0.0]) > 200, "dress");
}

#[test]
fn meshes_of_files_are_named_by_their_file_too() {
    let meshes = "meshes: [(file: \"glasses.obj\")],";
    let layers =
        "(effect: \"mesh.flat\", on: \"Glasses\", params: (light: \"0000FF\", shade: \"0000FF\"))";
    let mut stage = scene("shape: bust", meshes, layers).unwrap();
    let (surfaces, picture) = seen(&mut stage);
    assert_eq!(painted(&surfaces), 1);
    let blue = picture
        .pixels
        .iter()
        .filter(|[r, g, b, _]| *r < 0.01 && *g < 0.01 && *b > 0.99);
    assert!(blue.count() > 20);
}

#[test]
fn eyes_show_through_the_hair_before_them() {
    let picture = |layers: &str| seen(&mut scene(FIGURE, "", layers).unwrap()).1;
    let hidden = picture("");
    let white = "(effect: \"mesh.flat\", on: \"eyes\", through_hair: 0.5, params: (light: \"FFFFFF\", shade: \"FFFFFF\"))";
    let shown = picture(white);
    // Of pixels that are all hair, those before an eye become half white.
    let hair = hidden.pixels.iter().zip(&shown.pixels);
    let hair = hair.filter(|(before, _)| {
        let linear = [0xC0, 0x40, 0x20].map(|x| effects::linear_from_srgb(f64::from(x) / 255.0));
        (0..3).all(|i| (f64::from(before[i]) - linear[i]).abs() < 1e-5)
    });
    let is_half = |(before, after): &(&[f32; 4], &[f32; 4])| {
        (0..3).all(|i| (after[i] - 0.5 * (before[i] + 1.0)).abs() < 1e-5)
    };
    let (through, others): (Vec<_>, Vec<_>) = hair.partition(is_half);
    assert!(through.len() > 20, "{} pixels", through.len());
    let same = others.iter().filter(|(before, after)| before == after);
    assert!(same.count() > 200);
}

#[test]
fn mistakes_are_told_at_their_places() {
    let error = |layers: &str| scene(FIGURE, "", layers).err().unwrap_or_default();
    let unknown = error("(effect: \"mesh.toon\", on: \"skn\")");
    assert!(
        unknown.starts_with("look.ron:5:29: on: there is no mesh `skn`"),
        "{unknown}"
    );
    assert!(unknown.contains("did you mean `skin`"), "{unknown}");
    let nowhere = error("(effect: \"mesh.toon\")");
    assert!(
        nowhere.contains("look.ron:5:3: `mesh.toon` paints meshes"),
        "{nowhere}"
    );
    let strokes = error("(effect: \"mesh.flat\", on: \"skin\", rank: 3)");
    assert!(strokes.contains("`rank` is of strokes"), "{strokes}");
    let hair = error("(effect: \"hair.cel\", on: \"skin\")");
    assert!(hair.contains("`on` is of effects for meshes"), "{hair}");
    let far = error("(effect: \"mesh.flat\", on: \"skin\", through_hair: 2)");
    assert!(
        far.contains("through_hair") && far.contains("0 to 1"),
        "{far}"
    );
    let empty = error("(effect: \"mesh.flat\", on: \" , \")");
    assert!(empty.contains("it names no mesh"), "{empty}");
}

#[test]
fn they_are_set_by_name() {
    let registry = {
        let mut registry = Registry::new();
        effects_cartoon::register(&mut registry).unwrap();
        effects_builtin::register(&mut registry).unwrap();
        registry
    };
    let text = text(FIGURE, "", "(effect: \"mesh.flat\", on: \"skin\")");
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    preset.set("mesh.flat.on", "skin, eyes").unwrap();
    preset.set("mesh.flat.through_hair", "0.4").unwrap();
    preset.set("mesh.flat.softness", "0.1").unwrap();
    let layer = &preset.layers[1];
    assert_eq!(layer.on.as_deref(), Some("skin, eyes"));
    assert_eq!(layer.through_hair, 0.4);
    for (name, value) in [
        ("mesh.flat.rank", "1"),
        ("mesh.flat.zones", "fringe"),
        ("hair.base.on", "skin"),
        ("hair.base.through_hair", "0.5"),
        ("mesh.flat.through_hair", "NaN"),
    ] {
        assert!(preset.set(name, value).is_err(), "{name}");
    }
}
