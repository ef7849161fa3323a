//! What the README shows works as it stands there.

use assert_cmd::Command;
use std::fs;
use std::path::Path;

#[test]
fn the_examples_of_the_readme_are_drawn() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("styles")).unwrap();
    for style in ["bob.style.ron", "twin-tails.style.ron"] {
        let from = root.join("presets/styles").join(style);
        fs::copy(from, folder.path().join("styles").join(style)).unwrap();
    }
    let look = root.join("presets/twin-tails.ron");
    let look = look.to_str().unwrap();
    let mut drawn = Vec::new();
    for example in readme.split("```ron\n").skip(1) {
        let text = example.split("```").next().unwrap();
        let (name, line) = if text.contains("layers:") {
            ("look.ron", vec!["render", "look.ron"])
        } else if text.contains("zones:") {
            ("a.style.ron", vec!["render", look, "--hair", "a.style.ron"])
        } else if text.contains("moves:") {
            let line = ["render", look, "--motion", "a.motion.ron", "--time", "0.5"];
            ("a.motion.ron", line.to_vec())
        } else {
            (
                "a.strands.ron",
                vec!["render", look, "--hair", "a.strands.ron"],
            )
        };
        fs::write(folder.path().join(name), text).unwrap();
        let mut command = Command::cargo_bin("inkstrand").unwrap();
        command.current_dir(folder.path()).args(line);
        command.args(["--size", "60x40", "--samples", "1", "-o", "a.png"]);
        command.assert().success();
        drawn.push(name);
    }
    drawn.sort_unstable();
    assert_eq!(
        drawn,
        ["a.motion.ron", "a.strands.ron", "a.style.ron", "look.ron"]
    );
}
