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

/// Whether a signal that these tests send is ignored by them, as under `nohup` or behind a script's `&`, and so by what they start.
fn are_signals_ignored() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status
        .lines()
        .find_map(|line| line.strip_prefix("SigIgn:\t"));
    let ignored = ignored.and_then(|bits| u64::from_str_radix(bits, 16).ok());
    let [hup, int, term] = [1, 2, 15].map(|signal| 1 << (signal - 1));
    ignored.unwrap_or(0) & (hup | int | term) != 0
}

/// The program, with signals as they are at first.
fn inkstrand() -> Command {
    let program = env!("CARGO_BIN_EXE_inkstrand");
    if !are_signals_ignored() {
        return Command::new(program);
    }
    let mut command = Command::new("env");
    command.args(["--default-signal=INT,TERM,HUP", program]);
    command
}

fn start(folder: &Path, frames: &str) -> Child {
    inkstrand()
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
    for (round, signal) in ["INT", "INT", "INT", "INT", "INT", "HUP", "TERM"]
        .iter()
        .enumerate()
    {
        let folder = folder("(400, 300)");
        let path = folder.path();
        let mut child = start(path, "0-999999");
        wait_for(&mut child, || path.join("a_1.png").exists());
        // At another moment of a frame each time.
        std::thread::sleep(Duration::from_micros(700 * round as u64));
        let id = child.id().to_string();
        let sent = Command::new("kill")
            .args([&format!("-{signal}"), &id])
            .status();
        assert!(sent.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130), "SIG{signal}");

        for name in names(path) {
            assert!(!name.ends_with(".part"), "{name} is left");
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
    child.kill().unwrap();
    child.wait().unwrap();
    let text = fs::read_to_string(path.join("stats.jsonl")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines.len() >= 50, "{} lines after 51 frames", lines.len());
    for line in lines {
        assert!(serde_json::from_str::<serde_json::Value>(line).is_ok());
    }
}

#[test]
fn what_a_killed_run_leaves_a_later_one_removes() {
    let folder = folder("(400, 300)");
    let path = folder.path();
    let is_part = |name: &String| name.ends_with(".part");
    // Killed while a picture is being written, which takes a few tries.
    for _ in 0..50 {
        let mut child = start(path, "0-999999");
        wait_for(&mut child, || names(path).iter().any(is_part));
        child.kill().unwrap();
        child.wait().unwrap();
        if names(path).iter().any(is_part) {
            break;
        }
    }
    assert!(names(path).iter().any(is_part), "{:?}", names(path));
    assert!(start(path, "0-1").wait().unwrap().success());
    assert!(!names(path).iter().any(is_part), "{:?}", names(path));
}

#[test]
fn an_interrupt_is_heard_before_the_first_frame() {
    let folder = folder("(40, 30)");
    let path = folder.path();
    let text = fs::read_to_string(path.join("small.ron")).unwrap();
    let slow = "(version: 1, dynamics: (warm_up: 600, step: 0.00001, gravity: 2),";
    fs::write(path.join("small.ron"), text.replace("(version: 1,", slow)).unwrap();
    for arguments in [
        &["render", "small.ron", "-o", "a.png"][..],
        &["simulate", "small.ron", "-o", "a.strands.ron"],
    ] {
        let mut child = inkstrand()
            .current_dir(path)
            .args(arguments)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(500));
        assert_eq!(child.try_wait().unwrap(), None, "it is not long enough");
        let id = child.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-INT", &id])
                .status()
                .unwrap()
                .success()
        );
        let sent = Instant::now();
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert!(sent.elapsed() < Duration::from_secs(5));
        assert_eq!(names(path).len(), 2, "{:?}", names(path));
    }
}

/// As after a logout under `nohup`.
#[test]
fn a_hangup_that_is_to_be_ignored_ends_nothing() {
    let folder = folder("(40, 30)");
    let path = folder.path();
    let ignoring = "trap '' HUP; exec \"$0\" render small.ron --frames 0-400 -o a_#.png";
    let mut child = Command::new("sh")
        .current_dir(path)
        .args(["-c", ignoring, env!("CARGO_BIN_EXE_inkstrand")])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for(&mut child, || path.join("a_1.png").exists());
    let id = child.id().to_string();
    let sent = Command::new("kill").args(["-HUP", &id]).status();
    assert!(sent.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(path.join("a_400.png").exists());
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

/// A shell may limit how large files become: that is an error, as a full disk is.
#[test]
fn a_file_that_may_not_be_as_large_leaves_nothing() {
    let folder = folder("(400, 300)");
    let limited = "ulimit -f 1; exec \"$0\" render small.ron -o a.png --backend cpu";
    let output = Command::new("sh")
        .current_dir(folder.path())
        .args(["-c", limited, env!("CARGO_BIN_EXE_inkstrand")])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("a.png: "), "{told}");
    let mut left = names(folder.path());
    left.sort();
    assert_eq!(left, ["small.ron", "small.strands.ron"]);
}
