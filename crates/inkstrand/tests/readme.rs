//! What the README shows works as it stands there.

use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn inkstrand(folder: &TempDir, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    command.current_dir(folder.path()).args(arguments);
    command.assert()
}

/// Draws, small, and gives the picture's bytes.
fn drawn(folder: &TempDir, arguments: &[&str]) -> Vec<u8> {
    let small = ["--size", "60x40", "--samples", "1", "-o", "a.png"];
    inkstrand(folder, &[&["render"], arguments, &small].concat()).success();
    fs::read(folder.path().join("a.png")).unwrap()
}

/// In an empty folder, one example after the other.
#[test]
fn the_examples_of_the_readme_are_drawn() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let twin_tails = root().join("presets/twin-tails.ron");
    let twin_tails = twin_tails.to_str().unwrap();
    inkstrand(&folder, &["new", "mine.ron"]).success();
    let mut seen = Vec::new();
    for example in readme.split("```ron\n").skip(1) {
        let text = example.split("```").next().unwrap();
        let name = ["layers:", "zones:", "moves:", "strands:"]
            .into_iter()
            .find(|word| text.contains(&format!("\n    {word} [")))
            .unwrap();
        let write = |name: &str| fs::write(folder.path().join(name), text).unwrap();
        match name {
            "layers:" => {
                write("look.ron");
                drawn(&folder, &["look.ron"]);
            }
            "zones:" => {
                write("a.style.ron");
                drawn(&folder, &[twin_tails, "--hair", "a.style.ron"]);
            }
            "moves:" => {
                write("a.motion.ron");
                let moving = [twin_tails, "--motion", "a.motion.ron", "--time", "0.5"];
                assert_ne!(drawn(&folder, &moving), drawn(&folder, &[twin_tails]));
            }
            _ => {
                write("a.strands.ron");
                let line = [twin_tails, "--hair", "a.strands.ron", "--time"];
                let at = |time| drawn(&folder, &[&line[..], &[time]].concat());
                assert_ne!(at("0"), at("0.5"), "they move");
            }
        }
        seen.push(name);
    }
    seen.sort_unstable();
    assert_eq!(seen, ["layers:", "moves:", "strands:", "zones:"]);
    inkstrand(&folder, &["check", "."]).success();
}

/// Strands that float above the head, or hide in it, are no example.
#[test]
fn the_strands_of_the_readme_lie_on_the_bust() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let line = readme
        .lines()
        .find(|line| line.contains("(size: 14, mirror: true"))
        .unwrap();
    let folder = tempfile::tempdir().unwrap();
    let text = |down: &str| {
        format!(
            "(version: 1, strands: [{}])",
            line.trim().replace("1.625", down)
        )
    };
    assert!(line.contains("1.625"));
    let style = root().join("presets/styles/bob.style.ron");
    let preset = format!(
        "(version: 1, hair: (file: {:?}), head: (shape: bust), layers: [(effect: \"hair.base\")])",
        style.to_str().unwrap()
    );
    fs::write(folder.path().join("look.ron"), preset).unwrap();
    // From above, the root shows where it is above the skin, and not where it is deep below it.
    let seen = |height: &str| {
        fs::write(folder.path().join("a.strands.ron"), text(height)).unwrap();
        drawn(
            &folder,
            &["look.ron", "--hair", "a.strands.ron", "--camera", "0,90"],
        )
    };
    assert_ne!(seen("1.625"), seen("1.5"));
}
