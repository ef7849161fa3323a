//! Presets of several heads, as the command line takes them.

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder with two presets of one head each, and one of both.
fn folder(objects: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let styles = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets/styles");
    fs::copy(
        styles.join("bob.style.ron"),
        folder.path().join("bob.style.ron"),
    )
    .unwrap();
    for (name, color) in [("a.ron", "FF0000"), ("b.ron", "0000FF")] {
        let text = format!(
            "(version: 1, hair: (file: \"bob.style.ron\"), head: (shape: bust), clump: (color: \"{color}\"),\n \
             dynamics: (solver: none), layers: [(effect: \"hair.base\")])"
        );
        fs::write(folder.path().join(name), text).unwrap();
    }
    let pair = format!(
        "(\n    version: 1,\n    scene: (size: (80, 60), samples: 1),\n    camera: (distance: 7),\n    objects: [{objects}],\n)"
    );
    fs::write(folder.path().join("pair.ron"), pair).unwrap();
    folder
}

const BOTH: &str = "(preset: \"a.ron\", at: (-0.2, 0, 0)), (preset: \"b.ron\", at: (0.2, 0, 0))";

fn inkstrand(folder: &TempDir, arguments: &[&str]) -> Assert {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    command.current_dir(folder.path()).args(arguments).assert()
}

fn error(assert: Assert) -> String {
    String::from_utf8(assert.failure().get_output().stderr.clone()).unwrap()
}

#[test]
fn both_are_drawn_and_counted() {
    let folder = folder(BOTH);
    let done = inkstrand(
        &folder,
        &["render", "pair.ron", "--stats", "-", "--backend", "cpu"],
    );
    let lines = done.success().get_output().stdout.clone();
    let stats: serde_json::Value = serde_json::from_slice(&lines).unwrap();
    let alone = inkstrand(
        &folder,
        &[
            "render",
            "a.ron",
            "--stats",
            "-",
            "--backend",
            "cpu",
            "--samples",
            "1",
            // As large as in the pair's picture, which takes the joints that it needs.
            "--size",
            "80x60",
            "--set",
            "camera.distance=7",
        ],
    );
    let lines = alone.success().get_output().stdout.clone();
    let of_one: serde_json::Value = serde_json::from_slice(&lines).unwrap();
    for field in ["/strands/total", "/layers/hair.base/joints"] {
        let [two, one] = [&stats, &of_one].map(|s| s.pointer(field).unwrap().as_u64().unwrap());
        assert_eq!(two, 2 * one, "{field}");
    }
    inkstrand(&folder, &["check", "pair.ron"]).success();
}

#[test]
fn mistakes_of_their_presets_have_their_places() {
    let folder = folder("(preset: \"a.ron\"), (preset: \"c.ron\")");
    for command in ["check", "render"] {
        let text = error(inkstrand(&folder, &[command, "pair.ron"]));
        assert!(
            text.contains("pair.ron:5:43: preset: there is no `c.ron`"),
            "{text}"
        );
    }
    fs::write(
        folder.path().join("c.ron"),
        "(version: 1, hair: (file: \"bob.style.ron\"), head: (shape: bust),\n clumps: (size: 2), layers: [])",
    )
    .unwrap();
    for command in ["check", "render"] {
        let text = error(inkstrand(&folder, &[command, "pair.ron"]));
        assert!(
            text.contains("c.ron:2:2: a preset has no `clumps`, did you mean `clump`?"),
            "{text}"
        );
    }
    // Hair that is none, which its own preset names.
    fs::write(folder.path().join("cut.tfx"), "cut").unwrap();
    fs::write(
        folder.path().join("c.ron"),
        "(version: 1, hair: (file: \"cut.tfx\"), layers: [])",
    )
    .unwrap();
    for command in ["check", "render"] {
        let text = error(inkstrand(&folder, &[command, "pair.ron"]));
        assert!(
            text.contains("pair.ron:5:5: ") && text.contains("cut.tfx: "),
            "{text}"
        );
    }
    // One that names objects itself.
    fs::copy(folder.path().join("pair.ron"), folder.path().join("c.ron")).unwrap();
    for command in ["check", "render"] {
        let text = error(inkstrand(&folder, &[command, "pair.ron"]));
        assert!(
            text.contains("pair.ron:5:43: preset: `c.ron` names objects itself"),
            "{text}"
        );
    }
}

#[test]
fn what_is_for_one_head_is_refused() {
    let folder = folder(BOTH);
    for (option, value) in [
        ("--hair", "bob.style.ron"),
        ("--head", "x.obj"),
        ("--character", "x.vrm"),
        ("--motion", "x.motion.ron"),
        ("--guides", "9"),
    ] {
        let text = error(inkstrand(&folder, &["render", "pair.ron", option, value]));
        let names = format!("{option}: this preset draws objects");
        assert!(text.contains(&names) && text.contains("a.ron"), "{text}");
    }
    let text = error(inkstrand(
        &folder,
        &["render", "pair.ron", "--set", "clump.size=2"],
    ));
    assert!(text.contains("`clump` is said in their presets"), "{text}");
    let text = error(inkstrand(
        &folder,
        &["render", "pair.ron", "--only", "hair.base"],
    ));
    let message = "there is no layer `hair.base`: this preset draws objects";
    assert!(text.contains(message) && text.contains("a.ron"), "{text}");
    let line = [
        "simulate",
        "pair.ron",
        "--frames",
        "0-3",
        "-o",
        "x.strands.ron",
    ];
    let text = error(inkstrand(&folder, &line));
    assert!(text.contains("simulate each one's own preset"), "{text}");
    assert!(!folder.path().join("x.strands.ron").exists());
    // What is read isn't written over.
    let text = error(inkstrand(
        &folder,
        &["render", "pair.ron", "--stats", "a.ron"],
    ));
    assert!(text.contains("a.ron"), "{text}");
    assert!(
        fs::read_to_string(folder.path().join("a.ron"))
            .unwrap()
            .contains("clump")
    );
}
