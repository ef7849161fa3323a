//! What presets say of brushes: read, set by name, taken over from a base, and what is wrong with them at its place.

use effects::{Fit, Registry, Tool};
use stage::{Files, Preset, Stage};
use std::fs;
use std::path::Path;

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    registry
}

fn error(layer: &str) -> String {
    let registry = registry();
    let text = format!("(version: 1,\nlayers: [{layer}])");
    match Preset::parse("look.ron", &text, &registry) {
        Ok(_) => panic!("this should be refused: {layer}"),
        Err(errors) => errors.to_string(),
    }
}

#[test]
fn brushes_are_read_and_set_by_name() {
    let registry = registry();
    let text = "(version: 1, layers: [
        (effect: \"hair.silhouette\", brush: (kind: pencil, grain: 2, seed: 3)),
        (effect: \"line.ink\", on: \"rim\", brush: (kind: crayon)),
        (effect: \"hair.base\"),
        (effect: \"mesh.flat\", on: \"skin\"),
    ])";
    let mut preset = Preset::parse("look.ron", text, &registry).unwrap();
    let brush = &preset.layers[0].brush;
    assert_eq!(
        (brush.kind, brush.grain, brush.seed),
        (Tool::Pencil, 2.0, 3)
    );
    assert_eq!(preset.layers[1].brush.kind, Tool::Crayon);
    assert!(preset.layers[2].brush.is_solid());
    assert!(preset.layers[2].build().brush.is_none());
    preset.set("hair.base.brush.kind", "dry_ink").unwrap();
    preset.set("hair.base.brush.fit", "repeat").unwrap();
    preset.set("hair.base.brush.length", "2").unwrap();
    let brush = &preset.layers[2].brush;
    assert_eq!(
        (brush.kind, brush.fit, brush.length),
        (Tool::DryInk, Some(Fit::Repeat), Some(2.0))
    );
    assert!(preset.layers[2].build().brush.is_some());
    for (name, value, message) in [
        (
            "hair.base.brush.kind",
            "pen",
            "hair.base.brush.kind: there is no `pen`",
        ),
        (
            "hair.base.brush.length",
            "NaN",
            "hair.base.brush.length: expected a number",
        ),
        (
            "hair.base.brush.tool",
            "pencil",
            "hair.base.brush has no `tool`",
        ),
        (
            "hair.bass.brush.kind",
            "pencil",
            "there is no layer `hair.bass.brush`",
        ),
        ("mesh.flat.brush.kind", "pencil", "`brush` is of strokes"),
    ] {
        let error = preset.set(name, value).unwrap_err().to_string();
        assert!(error.contains(message), "{name}: {error}");
    }
}

#[test]
fn mistakes_are_told_at_their_places() {
    for (layer, message) in [
        (
            "(effect: \"hair.base\", brush: (kind: pencl))",
            "look.ron:2:46: kind: there is no `pencl`, did you mean `pencil`?",
        ),
        (
            "(effect: \"hair.base\", brush: (length: 0))",
            "look.ron:2:48: length: expected a number from 0.01 to 100, found `0`",
        ),
        (
            "(effect: \"hair.base\", brush: (lenght: 1))",
            "look.ron:2:40: brush has no `lenght`, did you mean `length`?",
        ),
        (
            "(effect: \"hair.base\", brush: pencil)",
            "look.ron:2:39: brush is written (name: value, ...), found `pencil`",
        ),
        (
            "(effect: \"hair.base\", brushes: ())",
            "look.ron:2:32: a layer has no `brushes`, did you mean `brush`?",
        ),
        (
            "(effect: \"mesh.flat\", on: \"skin\", brush: ())",
            "look.ron:2:44: `brush` is of strokes, and `mesh.flat` paints meshes",
        ),
    ] {
        let error = error(layer);
        assert!(
            error.starts_with(message),
            "{error}\nin place of\n{message}"
        );
    }
}

#[test]
fn a_preset_takes_brushes_over_from_its_base() {
    let folder = tempfile::tempdir().unwrap();
    let base = "(version: 1, layers: [(effect: \"hair.base\", brush: (kind: crayon, dry: 0.8))])";
    fs::write(folder.path().join("base.ron"), base).unwrap();
    let registry = registry();
    let text =
        "(version: 1, base: \"base.ron\", layers: [(name: \"hair.base\", brush: (grain: 2))])";
    let preset = Preset::parse_in(folder.path(), "look.ron", text, &registry).unwrap();
    let brush = &preset.layers[0].brush;
    assert_eq!(
        (brush.kind, brush.dry, brush.grain),
        (Tool::Crayon, 0.8, 2.0)
    );
}

/// A gray PNG of that size, and so many bytes less at its end.
fn png(path: &Path, size: [u32; 2], less: usize) {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let mut writer = encoder.write_header().unwrap();
    let data = vec![0x40; 2 * (size[0] * size[1]) as usize];
    writer.write_image_data(&data).unwrap();
    writer.finish().unwrap();
    bytes.truncate(bytes.len() - less);
    fs::write(path, bytes).unwrap();
}

#[test]
fn files_of_brushes_are_read_and_their_mistakes_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(
        at("a.strands.ron"),
        "(version: 1, strands: [(points: [(0, 0, 0), (0, -0.1, 0)])])",
    )
    .unwrap();
    png(&at("good.png"), [6, 4], 0);
    png(&at("cut.png"), [6, 4], 20);
    png(&at("wide.png"), [30_000, 1], 0);
    fs::write(at("text.png"), "no picture").unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    let registry = registry();
    let text = |name: &str| {
        format!(
            "(version: 1, hair: (file: \"a.strands.ron\"),\nlayers: [(effect: \"hair.base\", brush: (texture: \"{name}\"))])"
        )
    };
    let check = |name: &str| Preset::check("look.ron", &text(name), &registry, &files);
    check("good.png").unwrap();
    for (name, message) in [
        ("god.png", "did you mean `good.png`?"),
        ("cut.png", "cut.png: the file ends too early"),
        ("text.png", "it is no PNG file, or a broken one"),
        ("wide.png", "30000 x 1 texels; a texture has 1 to 4096"),
    ] {
        let error = check(name).unwrap_err().to_string();
        assert!(
            error.starts_with("look.ron:2:49: texture: ") && error.contains(message),
            "{error}"
        );
    }
    let good = text("good.png");
    let preset = Preset::parse("look.ron", &good, &registry).unwrap();
    assert!(preset.files(&files).contains(&at("good.png")));
    Stage::new(&preset, &files).unwrap();
}
