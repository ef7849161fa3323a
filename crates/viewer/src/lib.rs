//! The viewer: a desktop program for style authors, who see a look live while they change it. Also a library, for programs with more effects.
//!
//! A third party's viewer is its own effects and one line:
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     let mut registry = inkstrand::builtin_effects();
//!     // registry.register::<my_effects::Mine>().expect("no other effect has its id");
//!     viewer::run(registry)
//! }
//! ```
//!
//! The document is the preset's text ([`documents`]): a control reads the text at its place and asks for an [`edit::Edit`] of it. What is seen
//! is drawn in a thread of its own ([`engine`]), which keeps what an edit leaves alone. [`studio`] holds all that the window knows, [`panes`]
//! and [`panels`] show it.

pub mod actions;
pub mod app;
mod cli;
pub mod compare;
pub mod controls;
pub mod documents;
pub mod edit;
pub mod engine;
pub mod export;
pub mod grip;
pub mod inherited;
pub mod layers_shown;
pub mod light;
pub mod menu;
pub mod motion_script;
pub mod panels;
pub mod panes;
pub mod path_field;
pub mod prompt;
pub mod reference;
pub mod status;
pub mod studio;
pub mod transport;
pub mod view;
pub mod watched_files;

use app::App;
use clap::Parser as _;
use cli::Arguments;
use document::Recovery;
use effects::Registry;
use eframe::egui::ViewportBuilder;
use std::process::ExitCode;

/// The window at first, points.
const SIZE: [f32; 2] = [1280.0, 800.0];
/// The smallest that its panes are usable in.
const LEAST_SIZE: [f32; 2] = [480.0, 360.0];

/// Runs the viewer with these effects on the process's arguments, until its window is closed: 0 done, 1 there is no window, 2 wrong usage. To be called
/// first: it may start anew in its own process, so that drivers keep quiet.
#[must_use]
pub fn run(registry: Registry) -> ExitCode {
    inkstrand::own_up_to_bugs();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(answer) => answer.exit(),
    };
    inkstrand::start_without_noise();
    if let Some(preset) = &arguments.preset
        && let Err(error) = hair_io::read_text(preset, hair_io::MOST_OF_TEXT)
    {
        inkstrand::fail(&error);
        return ExitCode::FAILURE;
    }
    let options = eframe::NativeOptions {
        viewport: ViewportBuilder::default()
            .with_title("inkstrand")
            .with_app_id("inkstrand-viewer")
            .with_inner_size(SIZE)
            .with_min_inner_size(LEAST_SIZE)
            .with_drag_and_drop(true),
        // Pictures are shown as they are.
        dithering: false,
        ..eframe::NativeOptions::default()
    };
    let shown = eframe::run_native(
        "inkstrand",
        options,
        Box::new(move |creation| {
            Ok(Box::new(App::new(
                &creation.egui_ctx,
                registry,
                arguments.preset.as_deref(),
                arguments.backend.into(),
                Recovery::default(),
            )))
        }),
    );
    match shown {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            inkstrand::fail(&explained(&error));
            ExitCode::FAILURE
        }
    }
}

/// Why there is no window, in one sentence that says what helps.
fn explained(error: &eframe::Error) -> String {
    match error {
        eframe::Error::Wgpu(why) => format!(
            "no graphics driver can draw a window here ({why}): install your card's, or Debian's `mesa-vulkan-drivers`, which draws in software"
        ),
        eframe::Error::WinitEventLoop(_) | eframe::Error::Winit(_) => {
            "there is no screen to open a window on: on Linux, DISPLAY or WAYLAND_DISPLAY name one"
                .to_owned()
        }
        other => format!("there can be no window here: {other}"),
    }
}
