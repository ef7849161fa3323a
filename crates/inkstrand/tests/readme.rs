//! What the README shows works as it stands there.

use assert_cmd::Command;
use std::fs;
use std::ops::Range;
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
    let small = ["--size", "120x80", "--samples", "1", "-o", "a.png"];
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
        let name = [
            "base:", "layers:", "objects:", "zones:", "moves:", "strands:",
        ]
        .into_iter()
        .find(|word| text.contains(&format!("\n    {word} ")))
        .unwrap();
        let write = |name: &str| fs::write(folder.path().join(name), text).unwrap();
        match name {
            "layers:" => {
                write("look.ron");
                drawn(&folder, &["look.ron"]);
            }
            "base:" => {
                write("red.ron");
                assert_ne!(drawn(&folder, &["red.ron"]), drawn(&folder, &["look.ron"]));
            }
            "objects:" => {
                write("two.ron");
                drawn(&folder, &["two.ron"]);
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
    assert_eq!(
        seen,
        [
            "base:", "layers:", "moves:", "objects:", "strands:", "zones:"
        ]
    );
    inkstrand(&folder, &["check", "."]).success();
}

/// How many pixels of the last picture have the hair's own colour, in these columns from either side.
fn hair_pixels(folder: &TempDir, columns: Range<usize>) -> usize {
    let file = fs::File::open(folder.path().join("a.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    let is_hair = |pixel: &&[u8]| **pixel == [0x3F, 0xC1, 0xC0];
    let width = reader.info().width as usize;
    let is_there = |i: usize| columns.contains(&(i % width).min(width - 1 - i % width));
    let pixels = bytes.chunks(3).enumerate();
    pixels
        .filter(|(i, pixel)| is_there(*i) && is_hair(pixel))
        .count()
}

/// A few millimetres lower they are in the head: so they lie on it.
#[test]
fn the_strands_of_the_readme_lie_on_the_bust() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let mut lines = readme.lines();
    let line = lines.find(|line| line.contains("(size: 14, mirror: true"));
    let strand = line.unwrap().trim();
    let (on_top, lower) = (["1.619", "1.601"], ["1.611", "1.593"]);
    assert!(on_top.iter().all(|height| strand.contains(height)));

    let folder = tempfile::tempdir().unwrap();
    let preset = "(version: 1, hair: (file: \"a.strands.ron\"), head: (shape: bust),
        camera: (pitch: 90, distance: 0.93, target: (0, 0.49, 0)), clump: (size: 0.2075), layers: [(effect: \"hair.base\")])";
    fs::write(folder.path().join("look.ron"), preset).unwrap();
    // Where hair is seen from above, it is above the skin: thin hair, which nothing but its place lifts.
    let seen = |heights: [&str; 2]| {
        let strand = (strand.replace(on_top[0], heights[0])).replace(on_top[1], heights[1]);
        let text = format!("(version: 1, strands: [{strand}])");
        fs::write(folder.path().join("a.strands.ron"), text).unwrap();
        drawn(&folder, &["look.ron"]);
        // Between the ends, which show at the root, and outside of the head, in both.
        hair_pixels(&folder, 28..39)
    };
    let (own, sunk) = (seen(on_top), seen(lower));
    assert!(
        own > 20 && 2 * sunk < own,
        "{own} pixels, {sunk} when lower"
    );
}
