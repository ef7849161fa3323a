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
//! They are on by default; what a program is built without is refused with a sentence that says so.
//!
//! - `gpu`: `--backend gpu`, and `auto` draws on graphics cards.
//! - `gltf`: `motion: (gltf: ..)` of a preset moves the head by a character's animation.

mod animation;
mod cli;
mod commands;
mod embed;
mod output;
mod painter;
mod pass;
mod paths;
mod quiet_drivers;
mod say;
mod stats;

pub use commands::Progress;
pub use embed::{render_with, shell_word, write_new_look};
pub use quiet_drivers::start_without_noise;
pub use say::own_up_to_bugs;

use clap::{CommandFactory as _, Parser as _};
use cli::{Arguments, Backend, Command};
use effects::Registry;
use say::{heard, say};
use std::io::Write as _;
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
    Arguments::command()
}

/// The effects that inkstrand ships, to register others beside them.
#[must_use]
pub fn builtin_effects() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).expect("no two of them have one id");
    effects_cartoon::register(&mut registry).expect("nor have these");
    effects_surface::register(&mut registry).expect("nor these");
    registry
}

/// Runs the program with these effects on the process's arguments: 0 done, 1 failed, 2 wrong usage, 101 a mistake in
/// the program itself, which it owns up to. Interrupted (Ctrl-C, or asked to end) it removes what is half written and
/// exits with 130. To be called first: before it draws, the program may start anew in its own process.
#[must_use]
pub fn run(registry: &Registry) -> ExitCode {
    own_up_to_bugs();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(answer) => return give(&answer),
    };
    outlive_the_limit_of_files();
    leave_no_parts_when_interrupted();
    let done = match &arguments.command {
        Command::Render(options) => {
            if options.backend != Backend::Cpu {
                start_without_noise();
            }
            commands::render(options, registry, None).map(drop)
        }
        Command::Check { files } => commands::check(files, registry),
        Command::Effects { name, json } => commands::effects(name.as_deref(), *json, registry),
        Command::New { file } => commands::new(file),
        Command::Simulate(options) => commands::simulate(options, registry),
        Command::Completions { shell } => commands::completions(*shell),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Mistakes(mistakes)) => {
            for mistake in &mistakes {
                say(format_args!("{mistake}\n"));
            }
            // Of a file with more, 100 are told, and one thing more: how many there are.
            let count = match mistakes.len() {
                0..=100 => counted(mistakes.len(), "mistake"),
                _ => "more than 100 mistakes".to_owned(),
            };
            fail(&count);
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

/// From now on an interrupt removes what is unfinished and ends the process with 130.
fn leave_no_parts_when_interrupted() {
    let set = ctrlc::try_set_handler(|| {
        // Held until the end of the process.
        let _no_parts = hair_io::remove_parts();
        std::process::exit(130);
    });
    // It fails, and changes nothing, where one of the signals isn't as a process has them at first: the program that calls us has a handler of
    // its own, which is then in charge, or who started it has it live on (`nohup`). What is ended nevertheless then leaves a part, which the
    // next run in its folder removes.
    drop(set);
}

/// From now on a file that grows beyond what a shell allows (`ulimit -f`) can't be written, as on a full disk, where the signal of it would
/// end the process in the middle. Threads that are begun later are as this one.
fn outlive_the_limit_of_files() {
    #[cfg(unix)]
    {
        use std::ops::BitOr as _;
        // A set of it alone: two signals make one.
        let too_large = ctrlc::Signal::SIGXFSZ.bitor(ctrlc::Signal::SIGXFSZ);
        let _ = too_large.thread_block(); // else all is as it was
    }
}

/// Gives the answer to a command line that starts no work: help, the version, or what is wrong with it.
fn give(answer: &clap::Error) -> ExitCode {
    let given = answer.print();
    if answer.use_stderr() {
        return ExitCode::from(2);
    }
    match heard(given.and_then(|()| std::io::stdout().flush())) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            fail(&error);
            ExitCode::FAILURE
        }
    }
}

/// A number of things in words: `1 mistake`, `2 mistakes`.
fn counted(number: usize, thing: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{ending}")
}

/// Prints a failure's message on the standard error.
pub fn fail(message: &dyn std::fmt::Display) {
    say(format_args!("inkstrand: {message}"));
}
