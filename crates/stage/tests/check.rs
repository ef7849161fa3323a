//! What is said of the scripts, styles and bakes that presets name.

use effects::Registry;
use stage::{Files, Preset, check_motion, check_style};
use std::fs;
use std::path::Path;

const STRANDS: &str = "(version: 1, strands: [(points: [(0, 0.1, 0), (0, 0.2, 0)])])";
const OTHER: &str = "(version: 1, strands: [(points: [(0, 0.1, 0), (0, 0.2, 0), (0, 0.3, 0)])])";
const BROKEN: &str = "(\n    version: 1,\n    moves: [(move: nodd, start: 0)],\n)";

/// What is wrong with a preset of this hair and script in `folder`; file names without it.
fn mistakes(folder: &Path, hair: &str, script: &str) -> String {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = format!("(version: 1,\nhair: ({hair}),\nmotion: (file: \"{script}\"),\nlayers: [])");
    let files = Files {
        preset_folder: folder.to_owned(),
        ..Files::default()
    };
    let found = Preset::check("look.ron", &text, &registry, &files);
    let found = found.err().map(|errors| errors.to_string());
    let own = format!("{}/", folder.display());
    found.unwrap_or_default().replace(&own, "")
}

#[test]
fn scripts_styles_and_bakes_are_opened() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    write("hair.strands.ron", STRANDS);
    write("other.strands.ron", OTHER);
    write("good.motion.ron", "(version: 1, moves: [(move: nod)])");
    write("nod.motion.ron", BROKEN);
    write(
        "shape.motion.ron",
        "(version: 1,\nshapes: [(time: 0, hair: \"hiar.strands.ron\")])",
    );
    write("bob.style.ron", "(\n    version: 1,\n    fringe: [],\n)");
    write("hair.fbx", "Kaydara");
    fs::write(folder.join("latin.motion.ron"), b"(version: 1) // \xe9").unwrap();

    let hair = "file: \"hair.strands.ron\"";
    let bake = |name: &str| format!("{hair}, bake: \"{name}\"");
    for (hair, script, expected) in [
        (hair, "good.motion.ron", ""),
        (
            hair,
            "nod.motion.ron",
            "nod.motion.ron:3:20: move: there is no `nodd`, did you mean `nod`?",
        ),
        (
            hair,
            "shape.motion.ron",
            "shape.motion.ron:2:26: hair: there is no `hiar.strands.ron`, did you mean `hair.strands.ron`?",
        ),
        (
            hair,
            "latin.motion.ron",
            "look.ron:3:16: file: latin.motion.ron:1:",
        ),
        (
            "file: \"hair.fbx\"",
            "good.motion.ron",
            "look.ron:2:14: file: hair.fbx: \".fbx\" is not a format that this build reads; it reads TressFX (.tfx), own strands (.strands.ron) and hair styles (.style.ron)",
        ),
        (
            "file: \"bob.style.ron\"",
            "good.motion.ron",
            "bob.style.ron:1:1: the style has no `zones`",
        ),
        (
            &bake("hiar.strands.ron"),
            "good.motion.ron",
            "look.ron:2:40: bake: there is no `hiar.strands.ron`, did you mean `hair.strands.ron`?",
        ),
        (
            &bake("other.strands.ron"),
            "good.motion.ron",
            "look.ron:2:40: bake: other.strands.ron: it is not a bake of this hair: strand 0 has 3 points in place of 2",
        ),
        (
            &bake("hair.strands.ron"),
            "good.motion.ron",
            "look.ron:2:40: bake: hair.strands.ron: it is not a bake of this hair: no motion in it",
        ),
        (
            &bake("nod.motion.ron"),
            "good.motion.ron",
            "look.ron:2:40: bake: nod.motion.ron:",
        ),
    ] {
        let found = mistakes(folder, hair, script);
        let is_so = found.starts_with(expected) && found.is_empty() == expected.is_empty();
        assert!(is_so, "{found}\nin place of\n{expected}");
    }

    let script = check_motion(&folder.join("nod.motion.ron"), BROKEN);
    assert!(
        script
            .unwrap_err()
            .to_string()
            .contains("did you mean `nod`?")
    );
    // Files are called what they are.
    for (text, script, style) in [
        (
            "3",
            "a motion script begins with `(`",
            "a hair style begins with `(`",
        ),
        (
            "(version: 1)\n3",
            "this comes after the end of the motion script, the bracket of line 1",
            "this comes after the end of the hair style, the bracket of line 1",
        ),
    ] {
        let found = check_motion(Path::new("a.motion.ron"), text).unwrap_err();
        assert!(found.to_string().contains(script), "{found}");
        let found = check_style(Path::new("a.style.ron"), text).unwrap_err();
        assert!(found.to_string().contains(style), "{found}");
    }
    let style = check_style(Path::new("bob.style.ron"), "(version: 1, fringe: [])");
    assert!(
        style
            .unwrap_err()
            .to_string()
            .contains("the style has no `fringe`")
    );
}

#[test]
fn of_files_that_are_not_there_a_hundred_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("hair.strands.ron"), STRANDS).unwrap();
    let list = |item: &dyn Fn(usize) -> String| (0..300).map(item).collect::<String>();
    let shape = |i: usize| format!("    (time: {i}, hair: \"none{i}.strands.ron\"),\n");
    let script = format!("(version: 1, shapes: [\n{}])", list(&shape));
    fs::write(folder.join("many.motion.ron"), script).unwrap();
    let of_script = mistakes(folder, "file: \"hair.strands.ron\"", "many.motion.ron");

    let object = |i: usize| format!("    (preset: \"none{i}.ron\"),\n");
    let text = format!("(version: 1, objects: [\n{}])", list(&object));
    let registry = Registry::new();
    let preset = Preset::parse("look.ron", &text, &registry).unwrap();
    let found = preset.check_files(&Files::default()).unwrap_err();
    for (found, file) in [
        (of_script, "many.motion.ron"),
        (found.to_string(), "look.ron"),
    ] {
        let told = found.matches("there is no").count();
        assert_eq!(told, 100, "{file}");
        assert!(found.contains(&format!("{file}:101:")), "{file}");
        let rest = found.split(&format!("{file}:102:")).nth(1).unwrap();
        assert!(
            rest.contains(": 100 of 300 mistakes are shown, not this one"),
            "{rest}"
        );
    }
}
