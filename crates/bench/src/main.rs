//! Measures time against error: `bench SUITE`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program for the terminal"
)]

use bench::dynamics::{self, peers::Peers, stored};
use bench::targets::{Target, report};
use bench::{coherence, results, strokes};
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
    /// Dynamics: our strands, springs, XPBD, and other programs
    Dynamics(DynamicsOptions),
    /// Coherence: how continuous pictures are in time, in every order of strokes
    Coherence(CoherenceOptions),
}

#[derive(clap::Args)]
struct CoherenceOptions {
    #[command(flatten)]
    common: Options,
    /// Scenes whose names hold TEXT alone, such as twin-tails-orbit
    #[arg(
        long,
        value_name = "TEXT",
        default_value = "",
        hide_default_value = true
    )]
    only: String,
}

#[derive(clap::Args)]
struct DynamicsOptions {
    #[command(flatten)]
    common: Options,
    /// Other programs too: INKSTRAND_PEERS names the folder of their scripts, INKSTRAND_PYTHON the Python that has them
    #[arg(long)]
    peers: bool,
    /// Stores our figures as those that later ones are checked against
    #[arg(long, conflicts_with = "quick")]
    store: bool,
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
    if cfg!(debug_assertions) {
        eprintln!("bench: this is no release build: its times say nothing");
    }
    let measured = match Arguments::parse().suite {
        Suite::Strokes(options) => strokes(&options),
        Suite::Dynamics(options) => dynamics(&options),
        Suite::Coherence(options) => coherence(&options),
    };
    measured.unwrap_or_else(|error| {
        eprintln!("bench: {error}");
        ExitCode::FAILURE
    })
}

/// The project's folder.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

impl Options {
    fn threads(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        self.threads.map_or_else(cores, usize::from)
    }
}

fn strokes(options: &Options) -> Result<ExitCode, String> {
    let suite = strokes::Options {
        root: root(),
        out: options.out.clone(),
        quick: options.quick,
        threads: options.threads(),
    };
    let measured = with_progress(|progress| strokes::run(&suite, progress))?;
    println!("{}", strokes::summary(&measured.rows));
    println!("{}", report(&measured.targets));
    println!("{}", strokes::NOT_MEASURED);
    for file in ["strokes.csv", "strokes-errors.csv", "strokes.svg"] {
        println!("wrote {}", options.out.join(file).display());
    }
    Ok(exit_code(&measured.targets, options.check))
}

fn dynamics(options: &DynamicsOptions) -> Result<ExitCode, String> {
    let common = &options.common;
    let suite = dynamics::Options {
        out: common.out.clone(),
        quick: common.quick,
        threads: common.threads(),
        data: std::env::var_os("INKSTRAND_DATA").map(PathBuf::from),
        peers: options.peers.then(|| Peers::from_environment(&root())),
    };
    let measured = with_progress(|progress| dynamics::run(&suite, progress))?;
    println!("{}", dynamics::summary(&measured.rows));
    println!("{}", report(&measured.targets));
    for peer in &measured.missing {
        println!("{peer}");
    }
    if options.store {
        let path = root().join("crates/bench/stored/dynamics.csv");
        let file = stored::file(&measured.rows)?;
        results::write(&path, &file).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("stored our figures");
    }
    let (held, worse): (Vec<Target>, Vec<Target>) =
        (measured.regressions.iter().cloned()).partition(Target::is_met);
    println!(
        "{} figures as good as stored, {} worse",
        held.len(),
        worse.len()
    );
    if !worse.is_empty() {
        println!("{}", report(&worse));
    }
    for file in ["dynamics.csv", "dynamics.svg"] {
        println!("wrote {}", common.out.join(file).display());
    }
    let all: Vec<Target> = measured.targets.into_iter().chain(worse).collect();
    Ok(exit_code(&all, common.check))
}

fn coherence(options: &CoherenceOptions) -> Result<ExitCode, String> {
    let common = &options.common;
    let suite = coherence::Options {
        root: root(),
        out: common.out.clone(),
        quick: common.quick,
        threads: common.threads(),
        data: std::env::var_os("INKSTRAND_DATA").map(PathBuf::from),
        only: options.only.clone(),
    };
    let measured = with_progress(|progress| coherence::run(&suite, progress))?;
    println!("{}", coherence::summary(&measured.scenes));
    println!("{}", coherence::places(&measured.scenes));
    println!("{}", report(&measured.targets));
    println!("wrote {}", common.out.join("coherence.csv").display());
    for picture in &measured.pictures {
        println!("wrote {}", picture.display());
    }
    Ok(exit_code(&measured.targets, common.check))
}

/// Runs a suite under a bar, which is gone afterwards.
fn with_progress<T>(run: impl FnOnce(&ProgressBar) -> Result<T, String>) -> Result<T, String> {
    let progress = progress();
    let result = run(&progress);
    progress.finish_and_clear();
    result
}

/// Missed targets are a failure only where asked for.
fn exit_code(targets: &[Target], check: bool) -> ExitCode {
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
    use bench::targets::{Found, Limit};
    use clap::CommandFactory as _;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
        let line = ["bench", "strokes", "--quick", "--check", "--out", "x"];
        let Suite::Strokes(options) = Arguments::try_parse_from(line).unwrap().suite else {
            panic!("another suite");
        };
        assert!(options.quick && options.check && options.out == Path::new("x"));
        let line = ["bench", "dynamics", "--peers", "--threads", "2"];
        let Suite::Dynamics(options) = Arguments::try_parse_from(line).unwrap().suite else {
            panic!("another suite");
        };
        assert!(options.peers && options.common.threads == Some(2));
        let line = [
            "bench",
            "coherence",
            "--quick",
            "--only",
            "twin-tails-orbit",
        ];
        let Suite::Coherence(options) = Arguments::try_parse_from(line).unwrap().suite else {
            panic!("another suite");
        };
        assert!(options.common.quick && options.only == "twin-tails-orbit");
        // What is stored is measured with care.
        let line = ["bench", "dynamics", "--quick", "--store"];
        assert!(Arguments::try_parse_from(line).is_err());
    }

    #[test]
    fn check_fails_on_bad_numbers_alone() {
        let target = |ratio| Target {
            text: String::new(),
            found: Some(Found::Is(ratio)),
            limit: Limit::AtMost(0.25),
        };
        assert_eq!(exit_code(&[target(0.2)], true), ExitCode::SUCCESS);
        assert_eq!(
            exit_code(&[target(0.2), target(0.3)], true),
            ExitCode::FAILURE
        );
        assert_eq!(exit_code(&[target(0.3)], false), ExitCode::SUCCESS);
    }
}
