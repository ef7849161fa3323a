//! `inkstrand check` judges files of every kind, and never other than `render`.
#![expect(clippy::print_stdout, reason = "skipped tests say so")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use std::fs;
use tempfile::TempDir;

const STRANDS: &str = "(version: 1, strands: [
    (size: 30.0, mirror: true, points: [(0.03, 0.1, 0.0), (0.1, 0.1, 0.02), (0.13, -0.1, 0.03)]),
])";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("small.strands.ron", STRANDS),
        (
            "cut.strands.ron",
            "(version: 1, strands: [\n(points: [(0, 0)])])",
        ),
        ("cut.tfx", "TFX"),
        ("cut.obj", "v 0 0 zero\n"),
        ("cut.glb", "glTF"),
        ("tones.png", "not a PNG file"),
        ("nodd.motion.ron", "(version: 1, moves: [(move: nodd)])"),
        (
            "shape.motion.ron",
            "(version: 1, shapes: [(time: 0, hair: \"cut.strands.ron\")])",
        ),
        ("bad.style.ron", "(version: 1, zones: 3)"),
        (
            "good.style.ron",
            include_str!("../../../presets/styles/bob.style.ron"),
        ),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn inkstrand(folder: &TempDir, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    command.current_dir(folder.path()).args(arguments);
    command
}

/// What a command says of a preset, without what was guessed about its files.
fn told(folder: &TempDir, command: &str) -> (Option<i32>, String) {
    let line = match command {
        "check" => vec!["check", "look.ron"],
        _ => vec!["render", "look.ron", "-o", "a.png"],
    };
    let output = inkstrand(folder, &line).output().unwrap();
    (
        output.status.code(),
        String::from_utf8(output.stderr).unwrap(),
    )
}

#[test]
fn check_and_render_say_the_same() {
    let folder = folder();
    let hair = "hair: (file: \"small.strands.ron\"),";
    let base = "(effect: \"hair.base\")";
    let missing = "(effect: \"hair.toon\", params: (tones: \"tone.png\"))";
    let broken = "(effect: \"hair.toon\", params: (tones: \"tones.png\"))";
    let distance = "(effect: \"hair.highlight\", params: (kind: distance))";
    for (sections, layer, found) in [
        (
            "hair: (file: \"cut.tfx\"),",
            base,
            "look.ron:2:14: file: cut.tfx: ",
        ),
        (
            "hair: (file: \"cut.strands.ron\"),",
            base,
            "look.ron:2:14: file: cut.strands.ron:2:16: ",
        ),
        (
            "hair: (file: \"bad.style.ron\"),",
            base,
            "bad.style.ron:1:21: ",
        ),
        (
            "hair: (file: \"good.style.ron\"),",
            base,
            "look.ron:2:14: file: good.style.ron: a style needs a head to grow on",
        ),
        (
            "head: (file: \"cut.obj\"), hair: (file: \"cut.tfx\"),",
            base,
            "look.ron:2:14: file: cut.obj:1: a vertex",
        ),
        (
            "hair: (file: \"small.strands.ron\", bake: \"small.strands.ron\"),",
            base,
            "look.ron:2:41: bake: small.strands.ron: it is not a bake of this hair: no motion in it",
        ),
        (
            "hair: (file: \"small.strands.ron\"), motion: (file: \"nodd.motion.ron\"),",
            base,
            "nodd.motion.ron:1:29: move: there is no `nodd`",
        ),
        (
            "hair: (file: \"small.strands.ron\"), motion: (file: \"shape.motion.ron\"),",
            base,
            "look.ron:2:51: file: cut.strands.ron:2:16: ",
        ),
        #[cfg(feature = "gltf")]
        (
            "hair: (file: \"small.strands.ron\"), motion: (gltf: \"cut.glb\"),",
            base,
            "look.ron:2:51: gltf: cut.glb: ",
        ),
        (
            "hair: (file: \"small.strands.ron\"), light: (yaw: 3),",
            distance,
            "look.ron:2:36: layer `hair.highlight` goes by the distance to the light",
        ),
        // Where nothing is said of the light, it is the layer that asks for one.
        (
            hair,
            "(effect: \"hair.base\"),\n(effect: \"hair.highlight\",\nparams: (kind: distance))",
            "look.ron:4:1: layer `hair.highlight` goes by the distance to the light",
        ),
        (
            "hair: (file: \"small.strands.ron\"), dynamics: (step: 0.000001),",
            base,
            "look.ron:2:47: step: expected 0, which is a frame's, or a number from 0.00001 to 0.1",
        ),
        (
            hair,
            missing,
            "look.ron:3:48: tones: there is no `tone.png`, did you mean `tones.png`?",
        ),
        (
            hair,
            broken,
            "look.ron:3:48: tones: tones.png: it is no PNG file, or a broken one",
        ),
        (
            hair,
            "(effect: \"hair.base\", brush: (texture: \"tone.png\"))",
            "look.ron:3:49: texture: there is no `tone.png`, did you mean `tones.png`?",
        ),
        (
            hair,
            "(effect: \"hair.base\", brush: (texture: \"tones.png\"))",
            "look.ron:3:49: texture: tones.png: it is no PNG file, or a broken one",
        ),
        (
            hair,
            "(effect: \"hair.base\", brush: (kind: crayon, length: NaN))",
            "look.ron:3:62: length: expected a number from 0.01 to 100, found `NaN`",
        ),
        (
            hair,
            "(effect: \"hair.base\", brush: (kind: crayon, length: -0.2))",
            "look.ron:3:62: length: expected a number from 0.01 to 100, found `-0.2`",
        ),
        (
            hair,
            "(effect: \"hair.base\", brush: (kind: crayons))",
            "look.ron:3:46: kind: there is no `crayons`, did you mean `crayon`?",
        ),
    ] {
        let text = format!("(version: 1,\n{sections}\nlayers: [{layer}])");
        fs::write(folder.path().join("look.ron"), text).unwrap();
        let (code, checked) = told(&folder, "check");
        assert!(checked.contains(found), "{checked}\nin place of\n{found}");
        assert_eq!((code, checked), told(&folder, "render"));
    }
    // Both mistakes of the one with two.
    let text = "(version: 1, head: (file: \"cut.obj\"), hair: (file: \"cut.tfx\"), layers: [])";
    fs::write(folder.path().join("look.ron"), text).unwrap();
    let (_, checked) = told(&folder, "check");
    assert!(
        checked.contains("cut.obj:1: ")
            && checked.contains("cut.tfx: ")
            && checked.contains("2 mistakes"),
        "{checked}"
    );

    // As short a step as is said is taken.
    let text =
        format!("(version: 1,\n{hair} dynamics: (step: 0.00001, gravity: 2),\nlayers: [{base}])");
    fs::write(folder.path().join("look.ron"), text).unwrap();
    assert_eq!(told(&folder, "check"), (Some(0), String::new()));
    assert_eq!(told(&folder, "render").0, Some(0));
}

#[test]
fn a_mistake_is_told_once() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let script = "(version: 1, bodies: [(shape: mesh, file: \"none.obj\")])";
    let preset = |more: &str| {
        format!(
            "(version: 1, hair: (file: \"small.strands.ron\"), {more}, layers: [(effect: \"hair.base\")])"
        )
    };
    write("none.motion.ron", script);
    write("one.ron", &preset("motion: (file: \"none.motion.ron\")"));
    write("other.ron", &preset("motion: (file: \"none.motion.ron\")"));
    // A ball needs no file, and so misses none.
    write("ball.ron", &preset("bodies: [(file: \"none.obj\")]"));
    for (files, mistakes) in [
        (
            &["one.ron", "other.ron", "none.motion.ron"][..],
            "none.motion.ron:1:43: file: there is no `none.obj`",
        ),
        (&["ball.ron"], "file: a sphere has none, only mesh"),
    ] {
        let arguments = [&["check"], files].concat();
        let told = inkstrand(&folder, &arguments).assert().code(1);
        told.stderr(contains(mistakes).and(contains("inkstrand: 1 mistake\n")));
    }
    let arguments = ["check", "one.ron", "other.ron", "none.motion.ron"];
    inkstrand(&folder, &arguments)
        .assert()
        .stderr(contains("3 files, 3 of them with mistakes"));
}

/// A script's bodies are told where the script names them, whoever names the script.
#[test]
fn mistakes_of_a_given_script_have_their_places_in_it() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write(
        "look.ron",
        "(version: 1, hair: (file: \"small.strands.ron\"), layers: [(effect: \"hair.base\")])",
    );
    fs::create_dir(folder.path().join("moves")).unwrap();
    let script = "(version: 1, bodies: [\n    (shape: mesh, file: \"ball.obj\"),\n    (shape: mesh, file: \"cut.obj\"),\n    (shape: mesh, file: \"cape.##.obj\"),\n])";
    write("moves/a.motion.ron", script);
    write("moves/bal.obj", "");
    write("moves/cut.obj", "v 0 0 zero\n");
    let arguments = [
        "render",
        "look.ron",
        "--motion",
        "moves/a.motion.ron",
        "-o",
        "a.png",
    ];
    let rendered = inkstrand(&folder, &arguments).assert().code(1);
    let checked = inkstrand(&folder, &["check", "moves/a.motion.ron"])
        .assert()
        .code(1);
    let [rendered, checked] = [rendered, checked]
        .map(|told| String::from_utf8(told.get_output().stderr.clone()).unwrap());
    for expected in [
        "moves/a.motion.ron:2:25: file: there is no `moves/ball.obj`, did you mean `bal.obj`?",
        "moves/a.motion.ron:3:25: file: moves/cut.obj:1: a vertex",
        "moves/a.motion.ron:4:25: file: moves/cape.##.obj: there is no file",
        "inkstrand: 3 mistakes",
    ] {
        assert!(rendered.contains(expected), "{rendered}");
    }
    assert_eq!(rendered, checked);
}

#[test]
fn files_are_judged_by_their_kind() {
    let folder = folder();
    for name in ["small.strands.ron", "good.style.ron"] {
        inkstrand(&folder, &["check", name])
            .assert()
            .success()
            .stdout("")
            .stderr("");
    }
    inkstrand(
        &folder,
        &[
            "check",
            "cut.strands.ron",
            "bad.style.ron",
            "nodd.motion.ron",
        ],
    )
    .assert()
    .code(1)
    .stderr(
        contains("cut.strands.ron:2:16: ")
            .and(contains("bad.style.ron:1:21: "))
            .and(contains("nodd.motion.ron:1:29: "))
            .and(contains("3 files, 3 of them with mistakes"))
            .and(contains("inkstrand: 4 mistakes")),
    );
    // Heads and characters, as `render` reads them.
    inkstrand(&folder, &["check", "cut.obj", "cut.glb"])
        .assert()
        .code(1)
        .stderr(
            contains("cut.obj:1: a vertex")
                .and(contains("cut.glb: "))
                .and(contains("a preset begins").not()),
        );
}

/// Files of other programs are told by their format, where they would be no text.
#[test]
fn hair_that_is_not_read_is_judged_as_render_does() {
    let folder = folder();
    fs::write(folder.path().join("groom.abc"), b"Ogawa\xff\0").unwrap();
    let look = "(version: 1, layers: [(effect: \"hair.base\")])";
    fs::write(folder.path().join("look.ron"), look).unwrap();
    let verdict = "groom.abc: Alembic is not a format that this build reads; it reads TressFX (.tfx), own strands (.strands.ron) and hair styles (.style.ron)";
    for arguments in [
        &["check", "groom.abc"][..],
        &["render", "look.ron", "--hair", "groom.abc", "-o", "a.png"],
    ] {
        inkstrand(&folder, arguments)
            .assert()
            .code(1)
            .stderr(contains(verdict));
    }
}

#[test]
fn folders_are_checked_whole() {
    let folder = folder();
    inkstrand(&folder, &["check", "."])
        .assert()
        .code(1)
        .stderr(contains("6 files, 3 of them with mistakes"));
    // Files and folders that are hidden are not looks.
    let inner = folder.path().join("inner/looks");
    fs::create_dir_all(&inner).unwrap();
    fs::create_dir(folder.path().join("inner/.git")).unwrap();
    fs::write(folder.path().join("inner/.git/a.ron"), "(").unwrap();
    inkstrand(&folder, &["check", "inner"])
        .assert()
        .code(1)
        .stderr(contains("inner: there is no .ron file in this folder"));
    fs::write(inner.join("a.ron"), "(version: 1, layers: [])").unwrap();
    inkstrand(&folder, &["check", "inner"])
        .assert()
        .success()
        .stderr("");
}

#[test]
#[cfg(unix)]
fn a_folder_that_cannot_be_read_is_named_and_the_others_are_checked() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir_all(path("looks/closed")).unwrap();
    fs::create_dir(path("empty")).unwrap();
    fs::write(path("looks/a.ron"), "(version: 1, layers: [])").unwrap();
    fs::write(path("looks/b.ron"), "(version: 1, layers: [])").unwrap();
    let arguments = ["check", "looks", "empty"];
    let told = inkstrand(&folder, &arguments).assert().code(1);
    told.stderr(
        contains("empty: there is no .ron file in this folder")
            .and(contains(
                "2 files, 0 of them with mistakes; mistakes in 1 folder\n",
            ))
            .and(contains("inkstrand: 1 mistake\n")),
    );

    let allow = |mode| {
        let permissions = fs::Permissions::from_mode(mode);
        fs::set_permissions(path("looks/closed"), permissions).unwrap();
    };
    allow(0o000);
    // Who is root may read everywhere.
    let is_closed = fs::read_dir(path("looks/closed")).is_err();
    if !is_closed {
        println!("SKIPPED a part of a test: nothing is closed to root");
    } else {
        fs::write(path("looks/b.ron"), "(").unwrap();
        let told = inkstrand(&folder, &["check", "looks"]).assert().code(1);
        told.stderr(
            contains("looks/closed: ")
                .and(contains("looks/b.ron:1:"))
                .and(contains(
                    "2 files, 1 of them with mistakes; mistakes in 1 folder\n",
                )),
        );
    }
    allow(0o755);
}
