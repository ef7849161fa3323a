//! Long sequences: interrupted they leave no half file, and their memory does not grow.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const STRANDS: &str = "(version: 1, strands: [
    (size: 30.0, mirror: true, points: [(0.03, 0.1, 0.0), (0.1, 0.1, 0.02), (0.13, -0.1, 0.03)]),
])";

/// A folder with a preset of this size of picture.
fn folder(size: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let preset = format!(
        "(version: 1, hair: (file: \"small.strands.ron\"), scene: (size: {size}, samples: 1),
        layers: [(effect: \"hair.silhouette\"), (effect: \"hair.base\")])"
    );
    fs::write(folder.path().join("small.strands.ron"), STRANDS).unwrap();
    fs::write(folder.path().join("small.ron"), preset).unwrap();
    folder
}

fn start(folder: &Path, frames: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_inkstrand"))
        .current_dir(folder)
        .args(["render", "small.ron", "--frames", frames, "-o", "a_#.png"])
        .args(["--stats", "stats.jsonl", "--threads", "1"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned());
    names.collect()
}

fn wait_for(child: &mut Child, what: impl Fn() -> bool) {
    let patience = Instant::now() + Duration::from_secs(60);
    while !what() {
        assert_eq!(child.try_wait().unwrap(), None, "it ended too early");
        assert!(Instant::now() < patience, "it takes too long");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn an_interrupt_leaves_no_half_file() {
    for (round, signal) in ["INT", "INT", "INT", "INT", "INT", "INT", "TERM"]
        .iter()
        .enumerate()
    {
        let folder = folder("(400, 300)");
        let path = folder.path();
        let mut child = start(path, "0-999999");
        wait_for(&mut child, || path.join("a_1.png").exists());
        let part = names(path)
            .iter()
            .any(|name| name.contains("stats") && name.ends_with(".part"));
        assert!(part, "the stats are under way: {:?}", names(path));
        // At another moment of a frame each time.
        std::thread::sleep(Duration::from_micros(700 * round as u64));
        let id = child.id().to_string();
        let sent = Command::new("kill")
            .args([&format!("-{signal}"), &id])
            .status();
        assert!(sent.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130), "SIG{signal}");

        for name in names(path) {
            assert!(
                !name.ends_with(".part") && !name.starts_with("stats"),
                "{name} is left"
            );
            if name.ends_with(".png") {
                let file = fs::File::open(path.join(&name)).unwrap();
                let mut reader = png::Decoder::new(std::io::BufReader::new(file))
                    .read_info()
                    .unwrap();
                let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
                reader.next_frame(&mut bytes).unwrap();
            }
        }
    }
}

#[test]
fn stats_grow_with_the_frames() {
    let folder = folder("(40, 30)");
    let path = folder.path();
    let mut child = start(path, "0-999999");
    wait_for(&mut child, || path.join("a_50.png").exists());
    let part = names(path)
        .into_iter()
        .find(|name| name.contains("stats"))
        .unwrap();
    let lines = fs::read_to_string(path.join(&part))
        .unwrap()
        .lines()
        .count();
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(lines >= 50, "{lines} lines after 51 frames");
    assert!(!path.join("stats.jsonl").exists(), "only whole");
}

#[test]
#[cfg(target_os = "linux")]
fn memory_is_flat_over_a_sequence() {
    /// The most memory that a process has had, in KiB.
    fn peak(id: u32) -> Option<u64> {
        let status = fs::read_to_string(format!("/proc/{id}/status")).ok()?;
        let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
        line.split_whitespace().nth(1)?.parse().ok()
    }
    // Each picture has 16 times 120,000 bytes before it is encoded.
    let folder = folder("(400, 300)");
    let path = folder.path();
    let mut child = start(path, "0-999999");
    wait_for(&mut child, || path.join("a_30.png").exists());
    let early = peak(child.id()).unwrap();
    wait_for(&mut child, || path.join("a_330.png").exists());
    let late = peak(child.id()).unwrap();
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(early > 1000, "{early} KiB");
    assert!(
        late < early + 4096,
        "{early} KiB after 30 frames, {late} KiB after 330"
    );
}
