//! The command line of inkstrand, as a library: a third party's program is its own effects plus one
//! line. `examples/effect-backlight` is one.
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     let mut registry = inkstrand::builtin_effects();
//!     // registry.register::<my_effects::Mine>().expect("no other effect has its id");
//!     inkstrand::run(&registry)
//! }
//! ```
//!
//! # Features
//!
//! Both are on by default; what a program is built without is refused with a sentence that says so.
//!
//! - `gpu`: `--backend gpu`, and `auto` draws on graphics cards.
//! - `gltf`: `motion: (gltf: ..)` of a preset moves the head by a character's animation.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "this is what a program talks with"
)]

mod cli;
mod commands;
mod output;
mod painter;
mod stats;
mod whole_file;

use clap::{CommandFactory as _, Parser as _};
use effects::Registry;
use std::process::ExitCode;

/// Why a command did not do its work.
pub(crate) enum Failure {
    /// The command line asks for something that cannot be: exit 2.
    Usage(String),
    /// Presets with mistakes, each as a text that names its place: exit 1.
    Mistakes(Vec<String>),
    /// Anything else: exit 1.
    Failed(String),
}

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Failed(error.to_string())
    }
}

/// The command line's definition: for completions of a shell, manuals and tests.
#[must_use]
pub fn command() -> clap::Command {
    cli::Arguments::command()
}

/// The effects that inkstrand ships, to register others beside them.
#[must_use]
pub fn builtin_effects() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).expect("no two of them have one id");
    registry
}

/// Runs the program with these effects on the process's arguments: 0 done, 1 failed, 2 wrong usage.
/// Interrupted (Ctrl-C, or asked to end) it removes what is half written and exits with 130.
#[must_use]
pub fn run(registry: &Registry) -> ExitCode {
    let arguments = cli::Arguments::parse();
    whole_file::leave_no_parts();
    let done = match &arguments.command {
        cli::Command::Render(options) => commands::render(options, registry),
        cli::Command::Check { presets } => commands::check(presets, registry),
        cli::Command::Effects { name, json } => commands::effects(name.as_deref(), *json, registry),
        cli::Command::New { file } => commands::new(file),
        cli::Command::Simulate(options) => commands::simulate(options, registry),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Mistakes(mistakes)) => {
            for mistake in &mistakes {
                eprintln!("{mistake}\n");
            }
            let noun = if mistakes.len() == 1 {
                "mistake"
            } else {
                "mistakes"
            };
            fail(&format!("{} {noun}", mistakes.len()));
            ExitCode::FAILURE
        }
        Err(Failure::Failed(message)) => {
            fail(&message);
            ExitCode::FAILURE
        }
        Err(Failure::Usage(message)) => {
            fail(&message);
            ExitCode::from(2)
        }
    }
}

/// Prints a failure's message on the standard error.
pub fn fail(message: &dyn std::fmt::Display) {
    eprintln!("inkstrand: {message}");
}
