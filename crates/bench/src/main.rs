//! Measures time against error: `bench SUITE`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program for the terminal"
)]

use bench::strokes::{self, targets};
use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Measures time against error. Build it in release.
#[derive(Parser)]
#[command(name = "bench")]
struct Arguments {
    #[command(subcommand)]
    suite: Suite,
}

#[derive(Subcommand)]
enum Suite {
    /// Strokes: the exact sweep, stamping, and libraries that fill outlines
    Strokes(Options),
}

#[derive(clap::Args)]
struct Options {
    /// Fewer scenes, knobs and rounds: within two minutes on two cores
    #[arg(long)]
    quick: bool,
    /// Exits 1 if a target is missed
    #[arg(long)]
    check: bool,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Folder of the files it writes
    #[arg(long, value_name = "DIR", default_value = "target/bench")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let Suite::Strokes(options) = Arguments::parse().suite;
    if cfg!(debug_assertions) {
        eprintln!("bench: this is no release build: its times say nothing");
    }
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let suite = strokes::Options {
        root: Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."),
        out: options.out.clone(),
        quick: options.quick,
        threads: options.threads.map_or_else(cores, usize::from),
    };
    let progress = progress();
    let measured = match strokes::run(&suite, &progress) {
        Ok(measured) => measured,
        Err(error) => {
            progress.abandon();
            eprintln!("bench: {error}");
            return ExitCode::FAILURE;
        }
    };
    progress.finish_and_clear();
    println!("{}", strokes::summary(&measured.rows));
    println!("{}", targets::report(&measured.targets));
    println!("{}", strokes::NOT_MEASURED);
    for file in ["strokes.csv", "strokes-errors.csv", "strokes.svg"] {
        println!("wrote {}", options.out.join(file).display());
    }
    exit_code(&measured.targets, options.check)
}

/// Missed targets are a failure only where asked for.
fn exit_code(targets: &[targets::Target], check: bool) -> ExitCode {
    let missed = targets.iter().filter(|target| !target.is_met()).count();
    if missed == 0 {
        return ExitCode::SUCCESS;
    }
    eprintln!("bench: {missed} of {} targets MISSED", targets.len());
    if check {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    }
}

/// A bar on a terminal, nothing on a pipe.
fn progress() -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent} % {msg}, {eta} left") {
        bar.set_style(style);
    }
    bar
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory as _;
    use targets::{Ratio, Target};

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
        let line = ["bench", "strokes", "--quick", "--check", "--out", "x"];
        let Suite::Strokes(options) = Arguments::try_parse_from(line).unwrap().suite;
        assert!(options.quick && options.check && options.out == Path::new("x"));
    }

    #[test]
    fn check_fails_on_bad_numbers_alone() {
        let target = |ratio| Target {
            text: String::new(),
            ratio: Some(Ratio::Is(ratio)),
            limit: 0.25,
        };
        assert_eq!(exit_code(&[target(0.2)], true), ExitCode::SUCCESS);
        assert_eq!(
            exit_code(&[target(0.2), target(0.3)], true),
            ExitCode::FAILURE
        );
        assert_eq!(exit_code(&[target(0.3)], false), ExitCode::SUCCESS);
    }
}
