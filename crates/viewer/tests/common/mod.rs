//! A viewer without a window, driven by what is on it.

#![allow(dead_code, reason = "each test uses some of it")]

use document::Recovery;
use eframe::egui::Vec2;
use egui_kittest::Harness;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use viewer::app::App;
use viewer::engine::Backend;

/// A small look that draws quickly, with a comment of its author's.
pub const LOOK: &str = r#"// A bob for tests.
(
    version: 1,
    hair: (file: "bob.style.ron"),
    head: (shape: bust),
    scene: (size: (160, 120), samples: 4),
    camera: (yaw: 20), // from the right
    light: (yaw: 40, pitch: 45),
    motion: (file: "turn.motion.ron"),
    layers: [
        // Thin lines.
        (effect: "hair.silhouette", params: (width: 1.5)),
        (effect: "hair.base"),
    ],
)
"#;

/// A script in which the head turns for half a second.
pub const SCRIPT: &str =
    "(version: 1, moves: [(move: turn, start: 0.1, length: 0.5, angle: 40)])\n";

/// How long anything may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// A folder with the look, its style and its script.
pub struct Looks {
    folder: TempDir,
}

impl Looks {
    pub fn new() -> Self {
        let looks = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        let styles = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/yardsticks/styles");
        std::fs::copy(styles.join("bob.style.ron"), looks.path("bob.style.ron")).unwrap();
        std::fs::write(looks.path("look.ron"), LOOK).unwrap();
        std::fs::write(looks.path("turn.motion.ron"), SCRIPT).unwrap();
        looks
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }
}

/// A viewer with the look open.
pub fn viewer(looks: &Looks) -> Harness<'static, App> {
    viewer_of(Some(looks.path("look.ron")))
}

/// A viewer with a preset open, or none.
pub fn viewer_of(preset: Option<PathBuf>) -> Harness<'static, App> {
    sized(preset, Vec2::new(1280.0, 800.0))
}

/// The same in a window of another size, points.
pub fn sized(preset: Option<PathBuf>, size: Vec2) -> Harness<'static, App> {
    recovering(preset, size, Recovery::none())
}

/// The same, with copies that outlive a crash.
pub fn recovering(
    preset: Option<PathBuf>,
    size: Vec2,
    recovery: Recovery,
) -> Harness<'static, App> {
    Harness::builder()
        .with_size(size)
        .with_step_dt(1.0 / 60.0)
        .build_eframe(move |creation| {
            App::new(
                &creation.egui_ctx,
                inkstrand::builtin_effects(),
                preset.as_deref(),
                Backend::Cpu,
                recovery,
            )
        })
}

/// Lets the window go on until it is so.
///
/// # Panics
///
/// When it isn't within a minute.
#[track_caller]
pub fn wait_for(harness: &mut Harness<App>, what: &str, is_so: impl Fn(&App) -> bool) {
    let started = Instant::now();
    while !is_so(harness.state()) {
        assert!(started.elapsed() < PATIENCE, "waited in vain for {what}");
        std::thread::sleep(Duration::from_millis(5));
        harness.step();
    }
    harness.step();
}

/// Waits for a sharp picture.
#[track_caller]
pub fn wait_for_picture(harness: &mut Harness<App>) {
    harness.run_steps(3);
    wait_for(harness, "a picture", |app| {
        app.studio.shown[0].is_some() && app.studio.is_sharp
    });
}

/// The preset's text as it is edited.
pub fn text(harness: &Harness<App>) -> String {
    harness
        .state()
        .studio
        .documents
        .as_ref()
        .unwrap()
        .preset()
        .text()
        .to_string()
}
