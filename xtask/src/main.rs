//! The project's own tasks, run as `cargo xtask TASK`.
//!
//! Plain Rust that imports no crate of the workspace: it runs the programs instead, so that it
//! builds in seconds and says what is wrong even when a crate doesn't compile.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program for the terminal"
)]

mod bench;
mod count;
mod figures;
mod flip;
mod fuzz;
mod gallery;
mod html;
mod layers;
mod looks;
mod picture;
mod pictures;
mod program;
mod regress;
mod setup;
mod stress;
mod test;
mod test_programs;
mod wasm;
mod work;

use std::process::ExitCode;

use clap::{Arg, ArgAction, ArgMatches, Command};
use regress::Backend;

/// What a task returns; the text of the error is all that the maintainer gets to see.
type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

fn command() -> Command {
    Command::new("xtask")
        .bin_name("cargo xtask")
        .about("The project's own tasks")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(
            Command::new("test")
                .about("Checks everything that must hold")
                .arg(
                    Arg::new("step")
                        .help("Only these steps [default: all]")
                        .value_name("STEP")
                        .value_parser(test::step_names())
                        .num_args(0..),
                ),
        )
        .subcommand(
            Command::new("regress")
                .about("Compares pictures with the golden ones in tests/golden")
                .arg(
                    Arg::new("filter")
                        .help("Only cases whose name contains this")
                        .long("filter")
                        .value_name("S"),
                )
                .arg(
                    Arg::new("backend")
                        .help("The backend that draws: cpu, bit for bit; gpu, but for rounding")
                        .long("backend")
                        .value_parser(["cpu", "gpu"])
                        .default_value("cpu"),
                )
                .arg(
                    Arg::new("bless")
                        .help("Makes the pictures of now the golden ones; never where CI=true")
                        .long("bless")
                        .action(ArgAction::SetTrue),
                ),
        )
        .subcommand(
            Command::new("setup").about("Installs what the tests need and this machine lacks"),
        )
        .subcommand(
            Command::new("figures").about(
                "Draws the source's explanatory figures, and measures on them what they claim",
            ),
        )
        .subcommand(
            Command::new("gallery")
                .about("Draws a contact sheet of each look into target/gallery")
                .arg(
                    Arg::new("filter")
                        .help("Only looks whose name contains this")
                        .long("filter")
                        .value_name("S"),
                ),
        )
        .subcommand(Command::new("pictures").about(
            "Draws the pictures of docs/styling.md, docs/gallery.md and docs/motion.md again, by the pages' own commands",
        ))
        .subcommand(bench::command())
        .subcommand(stress::command())
        .subcommand(fuzz::command())
}

fn run(matches: &ArgMatches) -> Outcome {
    match matches.subcommand() {
        Some(("test", args)) => {
            let only: Vec<&String> = args.get_many("step").unwrap_or_default().collect();
            test::run(&only)
        }
        Some(("regress", args)) => {
            let filter = args.get_one::<String>("filter").map_or("", String::as_str);
            let backend = match args.get_one::<String>("backend").map(String::as_str) {
                Some("gpu") => Backend::Gpu,
                _ => Backend::Cpu,
            };
            regress::run(filter, backend, args.get_flag("bless"))
        }
        Some(("bench", args)) => bench::run(args),
        Some(("figures", _)) => figures::run(),
        Some(("gallery", args)) => {
            gallery::run(args.get_one::<String>("filter").map_or("", String::as_str))
        }
        Some(("pictures", _)) => pictures::run(),
        Some(("setup", _)) => setup::run(),
        Some(("stress", args)) => stress::run(args),
        Some(("fuzz", args)) => fuzz::run(args),
        _ => Err("no task given".into()),
    }
}

fn main() -> ExitCode {
    match run(&command().get_matches()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        command().debug_assert();
    }

    #[test]
    fn an_unknown_task_is_wrong_usage() {
        let error = command()
            .try_get_matches_from(["xtask", "tset"])
            .unwrap_err();
        assert_eq!(error.exit_code(), 2);
    }
}
