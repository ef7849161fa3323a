//! `--backend`: a graphics card where there is one, the CPU everywhere else.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

use assert_cmd::Command;
use predicates::str::contains;
use std::fs;
use tempfile::TempDir;

const PRESET: &str = "(
    version: 1,
    hair: (file: \"small.strands.ron\"),
    scene: (size: (80, 60), samples: 4),
    layers: [(effect: \"hair.silhouette\"), (effect: \"hair.base\")],
)";
const STRANDS: &str = "(version: 1, strands: [
    (size: 30.0, points: [(0.03, 0.1, 0.0), (0.1, 0.1, 0.02), (0.13, -0.1, 0.03)]),
])";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.strands.ron"), STRANDS).unwrap();
    fs::write(folder.path().join("small.ron"), PRESET).unwrap();
    folder
}

/// `inkstrand render small.ron --backend BACKEND -o BACKEND.png --stats stats.json`.
fn render(folder: &TempDir, backend: &str) -> Command {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    let picture = format!("{backend}.png");
    command.current_dir(folder.path()).args([
        "render",
        "small.ron",
        "--backend",
        backend,
        "-o",
        &picture,
        "--stats",
        "stats.json",
    ]);
    command
}

fn stats(folder: &TempDir) -> serde_json::Value {
    let text = fs::read_to_string(folder.path().join("stats.json")).unwrap();
    serde_json::from_str(text.lines().next().unwrap()).unwrap()
}

/// The loader finds drivers by this list alone, which names none.
#[cfg(all(feature = "gpu", target_os = "linux"))]
const NO_DRIVERS: (&str, &str) = ("VK_DRIVER_FILES", "/no-such-driver.json");

#[test]
#[cfg(all(feature = "gpu", target_os = "linux"))] // elsewhere drivers are part of the system
fn without_a_driver_gpu_fails_and_says_what_to_do() {
    let folder = folder();
    render(&folder, "gpu")
        .env(NO_DRIVERS.0, NO_DRIVERS.1)
        .assert()
        .code(1)
        .stderr(contains("there is no graphics card to draw on"))
        .stderr(contains("--backend cpu"));
    assert!(!folder.path().join("gpu.png").exists());
}

#[test]
#[cfg(all(feature = "gpu", target_os = "linux"))]
fn without_a_driver_auto_is_the_cpu_and_says_nothing_of_it() {
    let folder = folder();
    let output = render(&folder, "auto")
        .env(NO_DRIVERS.0, NO_DRIVERS.1)
        .output()
        .unwrap();
    assert!(output.status.success());
    assert!(!String::from_utf8_lossy(&output.stderr).contains("CPU"));
    assert_eq!(stats(&folder)["backend"], "cpu");
}

#[test]
#[cfg(feature = "gpu")]
fn a_driver_draws_what_the_cpu_draws() {
    let folder = folder();
    let output = render(&folder, "gpu").output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    if told.contains("there is no graphics card to draw on")
        && std::env::var_os("CI").is_none_or(|ci| ci != "true")
    {
        eprintln!("SKIPPED: no driver for a graphics card");
        return;
    }
    assert!(output.status.success(), "{told}");
    // A driver in software is told.
    let driver = ::render::gpu::Gpu::open(::render::gpu::AdapterKind::Hardware);
    assert_eq!(
        told.contains("runs its programs on the CPU"),
        driver.is_err(),
        "{told}"
    );
    let by_card = stats(&folder);
    assert_eq!(by_card["backend"], "gpu");
    assert_eq!(by_card["size"], serde_json::json!([80, 60]));
    render(&folder, "cpu").assert().success();
    let by_cpu = stats(&folder);
    assert_eq!(by_cpu["backend"], "cpu");
    assert_eq!(by_card["layers"], by_cpu["layers"]);
    let picture = |name| fs::read(folder.path().join(name)).unwrap();
    let (card, cpu) = (picture("gpu.png"), picture("cpu.png"));
    assert!(card == cpu || close(&card, &cpu));
}

/// Whether two PNG files differ in a few pixels at most: samples that rounding decides.
#[cfg(feature = "gpu")]
fn close(a: &[u8], b: &[u8]) -> bool {
    let pixels = |file: &[u8]| {
        let mut reader = png::Decoder::new(std::io::Cursor::new(file.to_vec()))
            .read_info()
            .unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        bytes
    };
    let (a, b) = (pixels(a), pixels(b));
    let far = a
        .iter()
        .zip(&b)
        .filter(|(a, b)| a.abs_diff(**b) > 2)
        .count();
    a.len() == b.len() && far * 1000 <= 3 * a.len()
}
