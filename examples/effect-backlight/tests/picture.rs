//! The program with the effect draws its preset.

use std::process::{Command, Output};

/// Runs the program in the crate's folder.
fn backlight(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_backlight"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

#[test]
fn the_preset_is_right() {
    let output = backlight(&["check", "contre-jour.ron"]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn the_effect_is_listed_with_its_parameters() {
    let output = backlight(&["effects", "example.backlight"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("one_sided") && text.contains("grazing to 1 facing"),
        "{text}"
    );
}

#[test]
fn it_changes_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |name: &str, set: &[&str]| {
        let path = folder.path().join(name);
        let picture = path.to_str().unwrap();
        let base = [
            "render",
            "contre-jour.ron",
            "--size",
            "120x90",
            "--samples",
            "4",
            "-o",
            picture,
        ];
        let output = backlight(&[&base, set].concat());
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        std::fs::read(path).unwrap()
    };
    let with = draw("with.png", &[]);
    let without = draw("without.png", &["--set", "rim.fullness=0"]);
    assert_ne!(with, without);
}
