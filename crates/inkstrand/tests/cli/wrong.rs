//! What is wrong with presets, files and options: what the program says of it, and how it ends.

use super::*;

#[test]
fn mistakes_in_presets_are_named_with_file_line_and_column() {
    let folder = folder();
    let broken = PRESET
        .replace("hair.base", "hair.bass")
        .replace("samples: 4", "samples: 400");
    fs::write(folder.path().join("broken.ron"), broken).unwrap();
    inkstrand(folder.path(), &["render", "broken.ron"])
        .assert()
        .code(1)
        .stdout("")
        .stderr(contains(
            "broken.ron:4:38: samples: expected a whole number from 1 to 256, found `400`",
        ))
        .stderr(contains(
            "broken.ron:7:18: there is no effect `hair.bass`, did you mean `hair.base`?",
        ))
        .stderr(contains(" 7 |         (effect: \"hair.bass\"),"));
    assert_eq!(
        files(folder.path()),
        ["broken.ron", "small.ron", "small.strands.ron"]
    );

    inkstrand(folder.path(), &["check", "small.ron"])
        .assert()
        .success()
        .stderr("");
    inkstrand(
        folder.path(),
        &["check", "small.ron", "broken.ron", "gone.ron"],
    )
    .assert()
    .code(1)
    .stderr(
        contains("broken.ron:7:18")
            .and(contains("gone.ron"))
            .and(contains("3 mistakes")),
    );
}

#[test]
fn wrong_usage_exits_2() {
    let folder = folder();
    let wrong: [(&[&str], &str); 11] = [
        (&["render"], "PRESET"),
        (&["render", "small.ron", "--size", "80"], "WxH"),
        (
            &["render", "small.ron", "--size", "0x60"],
            "sides are 1 to 16384 pixels long",
        ),
        (&["render", "small.ron", "--camera", "1"], "YAW,PITCH"),
        (
            &["render", "small.ron", "--camera", "NaN,0"],
            "not a number",
        ),
        (&["render", "small.ron", "--frames", "5-1"], "comes after"),
        (
            &["render", "small.ron", "--set", "hair.bse.x=1"],
            "did you mean `hair.base`?",
        ),
        (
            &["render", "small.ron", "--set", "hair.base.brightness=9"],
            "a number from 0 to 4",
        ),
        (
            &["render", "small.ron", "--set", "dynamics.step=1e-6"],
            "--set dynamics.step=1e-6: dynamics.step: expected 0",
        ),
        (
            &[
                "render",
                "small.ron",
                "--set",
                "dynamics.recall=2",
                "--set",
                "dynamics.solver=xpbd",
                "--set",
                "dynamics.friction=0.5",
            ],
            "--set dynamics.solver=xpbd: dynamics.recall: solver: xpbd has none",
        ),
        (
            &["render", "small.ron", "--only", "hair.cel"],
            "there is no layer `hair.cel`",
        ),
    ];
    for (arguments, message) in wrong {
        inkstrand(folder.path(), arguments)
            .assert()
            .code(2)
            .stderr(contains(message));
    }
}

#[test]
fn failures_exit_1_with_one_message_and_no_file() {
    let folder = folder();
    let fails: [(&[&str], &str); 9] = [
        (
            &["render", "small.ron", "--set", "hair.file=smal.strands.ron"],
            "--set hair.file=smal.strands.ron: there is no `smal.strands.ron`, did you mean `small.strands.ron`?",
        ),
        (
            &["render", "small.ron", "--motion", "small.ron"],
            "--motion: small.ron: this is a preset, and no motion script",
        ),
        (
            &["render", "small.ron", "--hair", "small.ron"],
            "--hair: small.ron: this is a preset, and no hair",
        ),
        (
            &["render", "small.ron", "--bake", "small.ron"],
            "--bake: small.ron: this is a preset, and no bake",
        ),
        (
            &[
                "render",
                "small.ron",
                "--set",
                "motion.file=gone.motion.ron",
            ],
            "--set motion.file=gone.motion.ron: there is no `gone.motion.ron`",
        ),
        (&["render", "gone.ron"], "gone.ron"),
        (&["render", "small.ron", "--hair", "gone.tfx"], "gone.tfx"),
        (&["render", "small.ron", "--head", "small.ron"], "small.ron"),
        (
            &["render", "small.ron", "-o", "no/such/folder/a.png"],
            "no/such/folder/a.png",
        ),
    ];
    for (arguments, message) in fails {
        inkstrand(folder.path(), arguments)
            .assert()
            .code(1)
            .stderr(contains(message).and(contains("panicked").not()));
    }
    assert_eq!(files(folder.path()), ["small.ron", "small.strands.ron"]);
}

#[test]
fn files_that_a_preset_names_are_looked_for() {
    let folder = folder();
    let wrong = PRESET.replace("small.strands.ron", "smal.strands.ron");
    fs::write(folder.path().join("wrong.ron"), wrong).unwrap();
    let message =
        "wrong.ron:3:18: file: there is no `smal.strands.ron`, did you mean `small.strands.ron`?";
    for command in ["check", "render"] {
        inkstrand(folder.path(), &[command, "wrong.ron"])
            .assert()
            .code(1)
            .stderr(contains(message).and(contains("1 mistake")));
    }
    // Other hair in its place, by option or by `--set`.
    for option in [
        ["--hair", "small.strands.ron"],
        ["--set", "hair.file=small.strands.ron"],
    ] {
        inkstrand(
            folder.path(),
            &["render", "wrong.ron", "-o", "a.png", option[0], option[1]],
        )
        .assert()
        .success();
    }
}

/// What the preset names in their place isn't wrong, and neither is its script.
#[test]
fn files_of_lists_that_set_names_are_not_told_where_the_preset_names_others() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write(
        "good.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n",
    );
    write("bad.obj", "v 0 0 0\n");
    write("still.motion.ron", "(version: 1)");
    write(
        "lists.ron",
        "(version: 1, hair: (file: \"small.strands.ron\"), head: (shape: bust), \
         motion: (file: \"still.motion.ron\"), meshes: [(file: \"good.obj\")], bodies: [(shape: mesh, file: \"good.obj\")], \
         layers: [(effect: \"hair.base\")])",
    );
    for (set, message) in [
        (
            "bodies.1.file=none.obj",
            "--set bodies.1.file=none.obj: there is no `none.obj`",
        ),
        (
            "meshes.1.file=none.obj",
            "--set meshes.1.file=none.obj: there is no `none.obj`",
        ),
        (
            "meshes.1.texture=no.png",
            "--set meshes.1.texture=no.png: there is no `no.png`",
        ),
        ("bodies.1.file=bad.obj", "bad.obj: no triangle"),
        ("meshes.1.file=bad.obj", "bad.obj: no triangle"),
        (
            "meshes.1.texture=bad.obj",
            "bad.obj is neither PNG nor JPEG",
        ),
        ("bodies.1.file=none.##.obj", "none.##.obj: there is no file"),
    ] {
        inkstrand(folder.path(), &["render", "lists.ron", "--set", set])
            .assert()
            .code(1)
            .stderr(contains(format!("inkstrand: {message}")));
    }
}

#[test]
fn a_picture_that_set_names_is_told_with_the_option() {
    let folder = folder();
    let presets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
    let preset = presets.join("cel-1980s.ron");
    let set = ["--set", "hair.toon.tones=nix.png"];
    inkstrand(
        folder.path(),
        &["render", preset.to_str().unwrap(), set[0], set[1]],
    )
    .assert()
    .code(1)
    .stderr(contains("--set hair.toon.tones=nix.png: there is no `"));
}

#[test]
#[cfg(target_os = "linux")]
fn a_device_that_set_names_is_there_and_no_file() {
    let folder = folder();
    let set = "hair.file=/dev/zero";
    inkstrand(folder.path(), &["render", "small.ron", "--set", set])
        .assert()
        .code(1)
        .stderr(contains(
            "--set hair.file=/dev/zero: `/dev/zero` is a pipe or a device, not a file",
        ));
}

#[test]
fn scripts_that_a_preset_names_are_checked_too() {
    let folder = folder();
    let broken = "(\n    version: 1,\n    moves: [(move: nodd)],\n)";
    fs::write(folder.path().join("nod.motion.ron"), broken).unwrap();
    let hair = "hair: (file: \"small.strands.ron\"),";
    let moving = PRESET.replace(hair, &format!("{hair} motion: (file: \"nod.motion.ron\"),"));
    fs::write(folder.path().join("moving.ron"), moving).unwrap();
    for file in ["moving.ron", "nod.motion.ron"] {
        inkstrand(folder.path(), &["check", file])
            .assert()
            .code(1)
            .stderr(contains(
                "nod.motion.ron:3:20: move: there is no `nodd`, did you mean `nod`?",
            ));
    }
}

#[test]
fn presets_from_any_editor_are_read() {
    let folder = folder();
    let marked = format!(
        "\u{feff}{}",
        PRESET.replace('\n', "\r\n").replace("    ", "\t")
    );
    fs::write(folder.path().join("marked.ron"), marked).unwrap();
    inkstrand(folder.path(), &["check", "marked.ron"])
        .assert()
        .success();

    fs::write(
        folder.path().join("latin.ron"),
        b"(\n// caf\xe9\nversion: 1)",
    )
    .unwrap();
    inkstrand(folder.path(), &["check", "latin.ron"])
        .assert()
        .code(1)
        .stderr(contains("latin.ron:2:7: this is not UTF-8 text"));
}
