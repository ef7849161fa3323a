//! `inkstrand simulate`, and drawing what it baked.

use assert_cmd::Command;
use predicates::prelude::*;
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
fn what_is_left_of_a_loop_is_told() {
    let folder = folder();
    let script = "(version: 1, period: 0.5, loop: true, winds: [(speed: 6)])";
    fs::write(folder.path().join("walk.motion.ron"), script).unwrap();
    let draw = ["render", "-o", "s.png", "--size", "12x9", "--samples", "1"];
    let bake = ["simulate", "-o", "b.strands.ron", "--frames", "0-11"];
    let told = [&draw[..], &bake[..]].map(|line| {
        let assert = inkstrand(&folder, line).assert().success();
        let said = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        let told = said
            .lines()
            .find(|line| line.starts_with("loop: 12 frames; after"));
        told.map(str::to_owned)
    });
    assert!(told[0].is_some() && told[0] == told[1], "{told:?}");
}

#[test]
fn a_bake_that_could_not_be_read_is_refused_before_the_work() {
    let folder = folder();
    let line = ["simulate", "-o", "b.strands.ron", "--frames", "0-999999"];
    inkstrand(&folder, &line).assert().code(1).stderr(
        contains("`render` reads up to 4 GiB of one: make several, each of a part of --frames")
            .and(contains("frames of this hair fit")),
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_preset_without_hair_has_no_bake() {
    let folder = tempfile::tempdir().unwrap();
    Command::cargo_bin("inkstrand")
        .unwrap()
        .current_dir(folder.path())
        .arg("simulate")
        .arg(presets().join("cup-ink.ron"))
        .args(["-o", "b.strands.ron", "--frames", "0-3"])
        .assert()
        .code(1)
        .stderr(contains("cup-ink.ron: it has no hair to simulate"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
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

#[test]
fn a_bake_that_something_else_moved_is_refused_and_says_what() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    inkstrand(
        &folder,
        &["simulate", "-o", "b.strands.ron", "--frames", "0-2"],
    )
    .assert()
    .success();
    let text = fs::read_to_string(path("b.strands.ron")).unwrap();
    for said in [
        " strands of bob.style.ron\n",
        " walk.motion.ron\n",
        "// dynamics.feel: ",
        "// scene.fps: 24\n",
    ] {
        assert!(text.contains(said), "`{said}`");
    }
    let draw = [
        "render",
        "--bake",
        "b.strands.ron",
        "--size",
        "20x20",
        "-o",
        "a.png",
    ];
    let draw_with = |more: &[&str]| inkstrand(&folder, &[&draw[..], more].concat());

    // What draws is free, and the script's name.
    for more in [
        &[][..],
        &["--camera", "90,0", "--light", "0,0"],
        &["--set", "contour.width=9", "--samples", "1"],
    ] {
        draw_with(more).assert().success();
    }
    let renamed = text.replace("walk.motion", "old.motion");
    fs::write(path("b.strands.ron"), renamed).unwrap();
    draw_with(&[]).assert().success();
    fs::write(path("b.strands.ron"), &text).unwrap();

    for (setting, said) in [
        ("dynamics.stiffness=2", "dynamics.stiffness was 1 and is 2"),
        ("dynamics.feel=gel", "and is gel"),
        ("scene.fps=12", "scene.fps was 24 and is 12"),
        ("seed=99", " and is 99"),
    ] {
        draw_with(&["--set", setting])
            .assert()
            .code(1)
            .stderr(contains("it is not a bake of this motion: ").and(contains(said)));
    }
    fs::write(path("walk.motion.ron"), WALK.replace("30", "31")).unwrap();
    draw_with(&[])
        .assert()
        .code(1)
        .stderr(contains("motion (walk.motion.ron) has changed since"));
    fs::write(path("walk.motion.ron"), WALK).unwrap();

    // As if the style had been changed, with as many points.
    fs::write(
        path("b.strands.ron"),
        text.replace("// hair: ", "// hair: 0"),
    )
    .unwrap();
    draw_with(&[])
        .assert()
        .code(1)
        .stderr(contains("hair (").and(contains(" strands of bob.style.ron) has changed since")));

    // Bakes of older builds say nothing.
    let start = text.find("(version").unwrap();
    fs::write(path("b.strands.ron"), &text[start..]).unwrap();
    draw_with(&[]).assert().success().stderr(contains(
        "b.strands.ron: the bake does not say what moved its hair",
    ));
}

#[test]
fn a_bake_has_no_more_frames_than_it_has() {
    let folder = folder();
    inkstrand(
        &folder,
        &["simulate", "-o", "b.strands.ron", "--frames", "2-4"],
    )
    .assert()
    .success();
    for (option, value, asked) in [
        ("--frames", "3-5", "frame 5 (0.20833333 s)"),
        ("--frames", "1-3", "frame 1 (0.041666668 s)"),
        ("--time", "7", "frame 168 (7 s)"),
    ] {
        let line = ["render", "--size", "20x20", "--bake", "b.strands.ron"];
        let line = [&line[..], &["-o", "a.png", option, value]].concat();
        inkstrand(&folder, &line).assert().code(1).stderr(
            contains(
                "b.strands.ron: the bake goes from frame 2 (0.083333336 s) to 4 (0.16666667 s)",
            )
            .and(contains(asked)),
        );
    }
    let line = ["render", "--size", "20x20", "--bake", "b.strands.ron"];
    let line = [&line[..], &["-o", "a.png", "--frames", "2-4"]].concat();
    inkstrand(&folder, &line).assert().success();
}

/// Where poses are held for some frames, the bake must have the frames that are held.
#[test]
fn a_bake_has_the_poses_that_are_held() {
    let folder = folder();
    let bake = ["simulate", "-o", "b.strands.ron", "--frames", "5-9"];
    inkstrand(&folder, &bake).assert().success();
    let draw = |frames: &str| {
        let line = ["render", "--size", "20x20", "--bake", "b.strands.ron"];
        let more = ["-o", "a.png", "--set", "motion.on=4", "--frames", frames];
        inkstrand(&folder, &[&line[..], &more].concat()).assert()
    };
    draw("5-9").code(1).stderr(contains(
        "the bake goes from frame 5 (0.20833333 s) to 9 (0.375 s), \
         and frame 4 (0.16666667 s), which is held until frame 5 (0.20833333 s), is asked for",
    ));
    draw("8-9").success();
}

#[test]
fn a_bake_is_made_anew_in_the_place_of_the_one_that_the_preset_names() {
    let folder = folder();
    let preset = fs::read_to_string(presets().join("short-ash.ron")).unwrap();
    let style = presets().join("styles/bob.style.ron");
    let hair = format!(
        "file: {:?}, bake: \"b.strands.ron\"",
        style.to_str().unwrap()
    );
    let preset = preset.replace("file: \"styles/bob.style.ron\"", &hair);
    let line = 1 + preset
        .lines()
        .position(|line| line.contains(&hair))
        .unwrap();
    fs::write(folder.path().join("look.ron"), preset).unwrap();
    let run = |line: &[&str]| {
        let mut command = Command::cargo_bin("inkstrand").unwrap();
        command.current_dir(folder.path()).args(line).assert()
    };
    let simulate = [
        "simulate",
        "look.ron",
        "-o",
        "b.strands.ron",
        "--frames",
        "0-1",
    ];
    let moving = ["--motion", "walk.motion.ron"];
    run(&simulate).success();
    let still = fs::read(folder.path().join("b.strands.ron")).unwrap();
    run(&[&simulate[..], &moving].concat()).success();
    assert_ne!(
        fs::read(folder.path().join("b.strands.ron")).unwrap(),
        still
    );
    run(&["check", "look.ron"])
        .code(1)
        .stderr(contains(format!("look.ron:{line}:")))
        .stderr(contains("motion was walk.motion.ron and is none"));
}
