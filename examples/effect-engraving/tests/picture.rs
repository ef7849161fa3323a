//! The program with the effect draws its preset.

use std::process::{Command, Output};

/// Runs the program in the crate's folder, to a good end.
fn engraving(arguments: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_engraving"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    output
}

#[test]
fn the_preset_is_right() {
    engraving(&["check", "engraved.ron"]);
}

#[test]
fn it_paints_lines_into_the_hair() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |name: &str, set: &[&str]| {
        let path = folder.path().join(name);
        let picture = path.to_str().unwrap();
        let size = [
            "render",
            "engraved.ron",
            "--size",
            "160x120",
            "--samples",
            "4",
        ];
        engraving(&[&size[..], &["-o", picture], set].concat());
        std::fs::read(path).unwrap()
    };
    let with = draw("with.png", &[]);
    let all_lit = [
        "--set",
        "example.engraving.bright=-1",
        "--set",
        "example.engraving.cross=-1",
    ];
    let without = draw("without.png", &all_lit);
    // Flat colour is far shorter, packed, than lines.
    assert!(
        2 * without.len() < 2 * with.len() - without.len() / 5,
        "{} {}",
        without.len(),
        with.len()
    );
}
