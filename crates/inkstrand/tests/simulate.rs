//! `inkstrand simulate`, and drawing what it baked.

use assert_cmd::Command;
use predicates::str::contains;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const WALK: &str =
    "(version: 1, moves: [(move: shake, length: 2, angle: 30)], winds: [(speed: 6)])";

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

fn inkstrand(folder: &TempDir, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    let preset = presets().join("short-ash.ron");
    command
        .current_dir(folder.path())
        .arg(arguments[0])
        .arg(preset);
    command
        .args(&arguments[1..])
        .args(["--motion", "walk.motion.ron"]);
    command
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("walk.motion.ron"), WALK).unwrap();
    folder
}

#[test]
fn a_bake_draws_the_same_pictures_as_the_simulation() {
    let folder = folder();
    let draw = ["--frames", "3-5", "--size", "120x90", "--samples", "1"];
    inkstrand(
        &folder,
        &["simulate", "-o", "b.strands.ron", "--frames", "0-5"],
    )
    .assert()
    .success()
    .stderr(contains("wrote b.strands.ron"));
    let line: Vec<&str> = ["render", "-o", "s#.png"].into_iter().chain(draw).collect();
    inkstrand(&folder, &line).assert().success();
    let line = ["render", "-o", "b#.png", "--bake", "b.strands.ron"];
    let line: Vec<&str> = line.into_iter().chain(draw).collect();
    inkstrand(&folder, &line).assert().success();
    let picture = |name: String| fs::read(folder.path().join(name)).unwrap();
    for frame in 3..=5 {
        let (simulated, baked) = (
            picture(format!("s{frame}.png")),
            picture(format!("b{frame}.png")),
        );
        assert!(simulated == baked, "frame {frame}");
    }
    // They do move.
    assert!(picture("s3.png".to_owned()) != picture("s5.png".to_owned()));
}

#[test]
fn a_bake_of_other_hair_is_refused() {
    let folder = folder();
    inkstrand(
        &folder,
        &[
            "simulate",
            "-o",
            "b.strands.ron",
            "--frames",
            "0-1",
            "--guides",
            "20",
        ],
    )
    .assert()
    .success();
    inkstrand(
        &folder,
        &["render", "--size", "20x20", "--bake", "b.strands.ron"],
    )
    .assert()
    .code(1)
    .stderr(contains(
        "b.strands.ron: it is not a bake of this hair: 20 strands in place of",
    ));
    inkstrand(
        &folder,
        &[
            "render",
            "--size",
            "20x20",
            "--guides",
            "20",
            "--bake",
            "b.strands.ron",
            "-o",
            "a.png",
        ],
    )
    .assert()
    .success();
    inkstrand(
        &folder,
        &["simulate", "-o", "no/where.strands.ron", "--frames", "0-1"],
    )
    .assert()
    .code(1)
    .stderr(contains("no/where.strands.ron"));
}
