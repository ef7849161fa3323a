//! Measures time against error: `bench SUITE`; and runs random scenes: `bench stress`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program for the terminal"
)]

mod arguments;

use arguments::{
    Arguments, CardOptions, CoherenceOptions, CompareOptions, DynamicsOptions, LineOptions,
    Options, RatioOptions, StressOptions, Suite,
};
use bench::BenchError;
use bench::dynamics::{self, peers::Peers, stored};
use bench::lines::line_art::LineArt;
use bench::page::{self, Finished};
use bench::ratios::{self, Ratio};
use bench::results::Row;
use bench::targets::{Target, report};
use bench::{
    cartoon, character, coherence, compare, frame, lines, rest, results, scale, skip, stress,
    strokes,
};
use clap::Parser as _;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, SystemTime};

fn main() -> ExitCode {
    let suite = Arguments::parse().suite;
    let measures = !matches!(suite, Suite::Stress(_) | Suite::Character(_));
    if cfg!(debug_assertions) && measures {
        eprintln!("bench: not a release build: its times say nothing");
    }
    let done = match &suite {
        Suite::Stress(options) => stress(options),
        Suite::Character(options) => character::write_presets(&root(), &options.folder)
            .map(|()| ExitCode::SUCCESS)
            .map_err(|error| format!("{}: {error}", options.folder.display()).into()),
        Suite::Compare(options) => compare(options),
        Suite::All(options) => all(options),
        Suite::Strokes(options) => strokes(options).map(|it| exit_code(&it, options.common.check)),
        Suite::Dynamics(options) => {
            dynamics(options).map(|it| exit_code(&it, options.common.check))
        }
        Suite::Coherence(options) => {
            coherence(options).map(|it| exit_code(&it, options.common.check))
        }
        Suite::Frame(options) => frame(options).map(|it| exit_code(&it, options.common.check)),
        Suite::Looks(options) => looks(options).map(|it| exit_code(&it, options.common.check)),
        Suite::Scale(options) => scale(options).map(|it| exit_code(&it, options.common.check)),
        Suite::Cartoon(options) => cartoon(options).map(|it| exit_code(&it, options.common.check)),
        Suite::Lines(options) => lines(options).map(|it| exit_code(&it, options.common.check)),
        Suite::Skip(options) => skip(options).map(|it| exit_code(&it, options.common.check)),
        Suite::Rest(options) => rest(options).map(|it| exit_code(&it, options.check)),
    };
    done.unwrap_or_else(|error| {
        eprintln!("bench: {error}");
        ExitCode::FAILURE
    })
}

/// Every suite one after the other, and a page of what they found.
fn all(options: &CardOptions) -> Result<ExitCode, BenchError> {
    let with_ratios = || RatioOptions {
        common: options.common.clone(),
        store: false,
    };
    let done = [
        strokes(&with_ratios())?,
        dynamics(&DynamicsOptions {
            common: options.common.clone(),
            peers: false,
            store: false,
        })?,
        coherence(&CoherenceOptions {
            common: options.common.clone(),
            only: String::new(),
        })?,
        frame(options)?,
        looks(options)?,
        scale(options)?,
        cartoon(options)?,
        lines(&LineOptions {
            common: Options {
                threads: None, // it has one, whatever the others have
                ..options.common.clone()
            },
            peers: false,
            store: false,
        })?,
        skip(&with_ratios())?,
        rest(&options.common)?,
    ];
    let out = &options.common.out;
    let machine = results::machine(
        options.common.threads(),
        &["vello_cpu", "tiny-skia", "wgpu"],
    );
    results::save(out, "index.html", &page::page(&done, &machine, out)?)?;
    println!("wrote {}", out.join("index.html").display());
    let missed = done
        .iter()
        .any(|suite| !suite.targets.iter().all(Target::is_met));
    Ok(match options.common.check && missed {
        true => ExitCode::FAILURE,
        false => ExitCode::SUCCESS,
    })
}

/// The project's folder.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn strokes(options: &RatioOptions) -> Result<Finished, BenchError> {
    let common = &options.common;
    let suite = strokes::Options {
        root: root(),
        out: common.out.clone(),
        quick: common.quick,
        threads: common.threads(),
    };
    let measured = with_progress(|progress| strokes::run(&suite, progress))?;
    println!("{}", results::summary(&measured.rows));
    println!("{}", report(&targets_of(&measured.ratios)));
    println!("{}", strokes::NOT_MEASURED);
    let files = ["strokes.csv", "strokes-errors.csv", "strokes.svg"];
    let targets = held_to_stored("strokes", &measured.ratios, options)?;
    Ok(finished("strokes", common, &files, measured.rows, targets))
}

/// What ratios are held to by themselves.
fn targets_of(ratios: &[Ratio]) -> Vec<Target> {
    ratios.iter().map(|ratio| ratio.target.clone()).collect()
}

/// Stores ratios, or says how they stand to those that are stored; and all that they are held to.
fn held_to_stored(
    suite: &str,
    ratios: &[Ratio],
    options: &RatioOptions,
) -> Result<Vec<Target>, BenchError> {
    let targets = targets_of(ratios);
    if options.store {
        let path = root().join(ratios::PATH);
        let text =
            std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let text = ratios::renewed(&text, suite, ratios)?;
        results::write(&path, &text).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("stored the ratios of {suite}");
        return Ok(targets);
    }
    let against = ratios::against(suite, ratios, options.common.quick)?;
    tell_regressions("ratios", &against);
    Ok([targets, against].concat())
}

/// Says how many figures are as good as stored, and which are worse.
fn tell_regressions(figures: &str, regressions: &[Target]) {
    let worse: Vec<Target> = (regressions.iter())
        .filter(|target| !target.is_met())
        .cloned()
        .collect();
    println!(
        "{} {figures} as good as stored, {} worse",
        regressions.len() - worse.len(),
        worse.len()
    );
    if !worse.is_empty() {
        println!("{}", report(&worse));
    }
}

/// What a suite found, when it has told which files it wrote.
fn finished(
    suite: &'static str,
    options: &Options,
    files: &[&str],
    rows: Vec<Row>,
    targets: Vec<Target>,
) -> Finished {
    let files: Vec<PathBuf> = files.iter().map(|file| options.out.join(file)).collect();
    for file in &files {
        println!("wrote {}", file.display());
    }
    Finished {
        suite,
        rows,
        targets,
        files,
    }
}

/// The Python that has other programs.
fn python() -> PathBuf {
    let python = std::env::var_os("INKSTRAND_PYTHON");
    python.unwrap_or_else(|| "python3".into()).into()
}

fn peers() -> Result<Peers, BenchError> {
    Peers::new(&root(), python())
}

fn dynamics(options: &DynamicsOptions) -> Result<Finished, BenchError> {
    let common = &options.common;
    let suite = dynamics::Options {
        root: root(),
        out: common.out.clone(),
        quick: common.quick,
        threads: common.threads(),
        data: std::env::var_os("INKSTRAND_DATA").map(PathBuf::from),
        peers: options.peers.then(peers).transpose()?,
    };
    let measured = with_progress(|progress| dynamics::run(&suite, progress))?;
    println!("{}", results::summary(&measured.rows));
    for sentence in dynamics::motion::particle_steps(&measured.rows) {
        println!("{sentence}");
    }
    println!();
    println!("{}", report(&measured.targets));
    if options.store {
        let path = root().join("crates/bench/stored/dynamics.csv");
        let file = stored::file(&measured.rows)?;
        results::write(&path, &file).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("stored our figures");
    }
    tell_regressions("figures", &measured.against.targets);
    for row in &measured.against.not_compared {
        println!("not compared, as this run has another number of threads: {row}");
    }
    let targets = [measured.targets, measured.against.targets].concat();
    let files = ["dynamics.csv", "dynamics.svg"];
    Ok(finished("dynamics", common, &files, measured.rows, targets))
}

fn coherence(options: &CoherenceOptions) -> Result<Finished, BenchError> {
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
    println!("{}", coherence::lines::summary(&measured.lines));
    println!("{}", report(&measured.targets));
    let mut done = finished(
        "coherence",
        common,
        &["coherence.csv"],
        Vec::new(),
        measured.targets,
    );
    for picture in measured.pictures {
        println!("wrote {}", picture.display());
        done.files.push(picture);
    }
    Ok(done)
}

fn lines(options: &LineOptions) -> Result<Finished, BenchError> {
    let common = &options.common;
    if common.threads.is_some() {
        return Err("suite lines has no --threads: lines are found by one".into());
    }
    let line_art = || LineArt::new(&root(), python());
    let suite = lines::Options {
        out: common.out.clone(),
        quick: common.quick,
        line_art: options.peers.then(line_art).transpose()?,
    };
    let measured = with_progress(|progress| lines::run(&suite, progress))?;
    println!("{}", results::summary(&measured.rows));
    println!("{}", report(&measured.targets));
    if options.store {
        let path = root().join("crates/bench/stored/line-art.csv");
        let file = lines::line_art::file(&measured.rows, &measured.machine);
        results::write(&path, &file).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("stored Line Art's rows");
    }
    let files = ["lines.csv", "lines.svg"];
    Ok(finished(
        "lines",
        common,
        &files,
        measured.rows,
        measured.targets,
    ))
}

fn frame(options: &CardOptions) -> Result<Finished, BenchError> {
    frames("frame", "frame.csv", frame::run, options)
}

fn looks(options: &CardOptions) -> Result<Finished, BenchError> {
    frames("looks", "looks.csv", frame::run_looks, options)
}

/// One of the suites of whole frames.
fn frames(
    name: &'static str,
    file: &'static str,
    run: impl FnOnce(&frame::Options, &ProgressBar) -> Result<frame::Measured, BenchError>,
    options: &CardOptions,
) -> Result<Finished, BenchError> {
    let common = &options.common;
    let suite = frame::Options {
        root: root(),
        out: common.out.clone(),
        quick: common.quick,
        threads: common.threads(),
        card: options.card(),
    };
    let measured = with_progress(|progress| run(&suite, progress))?;
    println!("{}", results::summary(&measured.rows));
    println!("{}", report(&measured.targets));
    println!(
        "graphics card: {}",
        measured.card.as_deref().unwrap_or("none")
    );
    Ok(finished(
        name,
        common,
        &[file],
        measured.rows,
        measured.targets,
    ))
}

fn scale(options: &CardOptions) -> Result<Finished, BenchError> {
    let common = &options.common;
    let suite = scale::Options {
        out: common.out.clone(),
        quick: common.quick,
        threads: common.threads(),
        card: options.card(),
    };
    let measured = with_progress(|progress| scale::run(&suite, progress))?;
    println!("{}", results::summary(&measured.rows));
    for (count, [cpu, gpu]) in &measured.bytes {
        let mib = |bytes: &u64| *bytes as f64 / f64::from(1 << 20);
        println!(
            "{count} strands: {:.1} MiB of strokes on the CPU, {:.1} MiB on the card",
            mib(cpu),
            mib(gpu)
        );
    }
    println!("{}", report(&measured.targets));
    println!(
        "graphics card: {}",
        measured.card.as_deref().unwrap_or("none")
    );
    Ok(finished(
        "scale",
        common,
        &["scale.csv"],
        measured.rows,
        measured.targets,
    ))
}

fn cartoon(options: &CardOptions) -> Result<Finished, BenchError> {
    let common = &options.common;
    let suite = cartoon::Options {
        root: root(),
        out: common.out.clone(),
        quick: common.quick,
        threads: common.threads(),
        card: options.card(),
    };
    let measured = with_progress(|progress| cartoon::run(&suite, progress))?;
    println!("{}", results::summary(&measured.rows));
    println!("{}", report(&measured.targets));
    Ok(finished(
        "cartoon",
        common,
        &["cartoon.csv"],
        measured.rows,
        measured.targets,
    ))
}

fn skip(options: &RatioOptions) -> Result<Finished, BenchError> {
    let common = &options.common;
    let suite = skip::Options {
        root: root(),
        out: common.out.clone(),
        quick: common.quick,
        threads: common.threads(),
    };
    let measured = with_progress(|progress| skip::run(&suite, progress))?;
    println!("{}", results::summary(&measured.rows));
    println!("{}", report(&targets_of(&measured.ratios)));
    let targets = held_to_stored("skip", &measured.ratios, options)?;
    Ok(finished(
        "skip",
        common,
        &["skip.csv"],
        measured.rows,
        targets,
    ))
}

fn rest(options: &Options) -> Result<Finished, BenchError> {
    let suite = rest::Options {
        root: root(),
        out: options.out.clone(),
        quick: options.quick,
        threads: options.threads(),
    };
    let measured = with_progress(|progress| rest::run(&suite, progress))?;
    println!("{}", measured.summary);
    println!("{}", report(&measured.targets));
    // A page has no use for a thousand rows of simulated seconds; the file has them.
    Ok(finished(
        "rest",
        options,
        &["rest.csv"],
        Vec::new(),
        measured.targets,
    ))
}

fn compare(options: &CompareOptions) -> Result<ExitCode, BenchError> {
    let compared = compare::Options {
        root: root(),
        programs: [options.first.clone(), options.second.clone()],
        looks: options.looks.clone(),
        rounds: options.rounds.into(),
        threads: options.threads.into(),
    };
    let table = with_progress(|progress| compare::run(&compared, progress))?;
    println!("{table}");
    Ok(ExitCode::SUCCESS)
}

/// Failures are told at once, each with the command that runs its scene again.
fn stress(options: &StressOptions) -> Result<ExitCode, BenchError> {
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    let clock = now.map_or(0, |now| now.as_secs());
    let which = match options.seed {
        Some(seed) => stress::Which::One(seed),
        None => {
            let first = options.from.unwrap_or(clock);
            let time = options.hours.unwrap_or(Duration::from_secs(60));
            stress::Which::From(first, time)
        }
    };
    let summary = with_progress(|progress| {
        let failed = |seed: u64, error: &str| {
            progress.suspend(|| {
                println!("FAILED seed {seed}: {error}");
                println!("   again: cargo xtask stress --seed {seed}");
            });
        };
        stress::run(which, options.keep_going, progress, failed)
    })?;
    println!("{summary}");
    Ok(if summary.failures.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Runs a suite under a bar, which is gone afterwards.
fn with_progress<T>(
    run: impl FnOnce(&ProgressBar) -> Result<T, BenchError>,
) -> Result<T, BenchError> {
    let progress = progress();
    let result = run(&progress);
    progress.finish_and_clear();
    result
}

/// Missed targets are a failure only where asked for.
fn exit_code(done: &Finished, check: bool) -> ExitCode {
    let targets = &done.targets;
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

    #[test]
    fn check_fails_on_bad_numbers_alone() {
        let target = |ratio| Target {
            text: String::new(),
            found: Some(Found::Is(ratio)),
            limit: Limit::AtMost(0.25),
        };
        let done = |ratios: &[f64]| Finished {
            suite: "strokes",
            rows: Vec::new(),
            targets: ratios.iter().map(|ratio| target(*ratio)).collect(),
            files: Vec::new(),
        };
        assert_eq!(exit_code(&done(&[0.2]), true), ExitCode::SUCCESS);
        assert_eq!(exit_code(&done(&[0.2, 0.3]), true), ExitCode::FAILURE);
        assert_eq!(exit_code(&done(&[0.3]), false), ExitCode::SUCCESS);
    }

    #[test]
    fn lines_are_found_by_one_thread_alone() {
        let options = ["bench", "lines", "--threads", "2"];
        let Suite::Lines(options) = Arguments::parse_from(options).suite else {
            panic!("another suite");
        };
        let error = lines(&options).err().map(|error| error.to_string());
        assert!(error.is_some_and(|error| error.contains("no --threads")));
    }
}
