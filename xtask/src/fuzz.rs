//! Damaged files, which readers must refuse with a message: without a panic, in bounded memory and time.
//!
//! Files of the repository, and of the folder that `INKSTRAND_DATA` names, are damaged by numbers from a seed. A program that
//! reads one file after the other (`crates/stage/examples/fuzz_target.rs`) runs beside, with a limit on its memory.

mod mutate;
mod random;
mod target;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use std::{env, fs};

use clap::{Arg, ArgMatches, Command, value_parser};
use indicatif::{ProgressBar, ProgressStyle};

use crate::Outcome;
use crate::program::{fuzz_target, root};
use random::Random;
use target::Target;

/// The kinds of files, and how their names end; the first that fits is a file's.
const KINDS: &[(&str, &[&str])] = &[
    ("style", &[".style.ron"]),
    ("motion", &[".motion.ron"]),
    ("strands", &[".strands.ron"]),
    ("preset", &[".ron"]),
    ("tfx", &[".tfx"]),
    ("obj", &[".obj"]),
    ("ply", &[".ply"]),
    ("gltf", &[".gltf", ".glb", ".vrm"]),
];

/// Folders of the repository with files to damage.
const FOLDERS: &[&str] = &["crates", "examples", "presets", "tests"];
/// Larger files take too long to read, in bytes.
const LARGEST_SEED: u64 = 1 << 17;
/// After so many failures it stops: they are of few causes.
const MOST_FAILURES: usize = 10;

/// How long, and from which seed on.
struct Plan {
    seconds: Option<u64>,
    cases: Option<u64>,
    seed: u64,
}

/// The task's part of the command line.
pub fn command() -> Command {
    let number = |name: &'static str, value: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name(value).help(help)
    };
    let some = || value_parser!(u64).range(1..); // of none all would hold
    Command::new("fuzz")
        .about("Damages files of all kinds, which readers must refuse without a panic, in bounded memory and time")
        .arg(
            Arg::new("hours")
                .long("hours")
                .value_name("N")
                .help("For how many hours, such as 0.5")
                .value_parser(hours)
                .conflicts_with_all(["seconds", "cases"]),
        )
        .arg(number("seconds", "N", "For how long [default: 60]").value_parser(some()).conflicts_with("cases"))
        .arg(number("cases", "N", "How many files").value_parser(some()))
        .arg(number("seed", "S", "The seed of the first file, 1 more for each other [default: by the clock]").value_parser(value_parser!(u64)))
        .arg(
            Arg::new("kind")
                .help("Only these kinds of files [default: all]")
                .value_name("KIND")
                .value_parser(KINDS.iter().map(|(name, _)| *name).collect::<Vec<_>>())
                .num_args(0..),
        )
}

/// Hours as seconds.
fn hours(text: &str) -> Result<u64, String> {
    match text.parse::<f64>() {
        Ok(hours) if hours > 0.0 && hours <= 10_000.0 => Ok((hours * 3600.0).ceil() as u64),
        _ => Err("expected hours above 0, up to 10000".to_owned()),
    }
}

/// Damages files as the command line says.
///
/// # Errors
/// Files that readers don't stand; which, and how to make them again, is printed.
pub fn run(args: &ArgMatches) -> Outcome {
    let number = |name| args.get_one::<u64>(name).copied();
    let now = SystemTime::now().duration_since(UNIX_EPOCH)?.as_secs();
    let plan = Plan {
        seconds: (number("hours").or(number("seconds")))
            .or(number("cases").is_none().then_some(60)),
        cases: number("cases"),
        seed: number("seed").unwrap_or(now),
    };
    let only: Vec<&String> = args.get_many("kind").unwrap_or_default().collect();
    let is_chosen = |kind: &&str| only.is_empty() || only.iter().any(|name| name == kind);
    let kinds = KINDS.iter().map(|(name, _)| *name);
    fuzz(&plan, &kinds.filter(is_chosen).collect::<Vec<_>>())
}

/// What everything that must hold does of it: some seconds, with the same seed each time.
///
/// # Errors
/// As of [`run`].
pub fn briefly() -> Outcome {
    let plan = Plan {
        seconds: Some(20),
        cases: None,
        seed: 1,
    };
    let kinds: Vec<&str> = KINDS.iter().map(|(name, _)| *name).collect();
    fuzz(&plan, &kinds)
}

fn fuzz(plan: &Plan, kinds: &[&str]) -> Outcome {
    let program = fuzz_target()?;
    let seeds = seeds()?;
    for kind in kinds {
        one_is_read(&program, kind, seeds.get(kind).map_or(&[], Vec::as_slice))?;
    }
    let folder = root().join("target/fuzz");
    fs::create_dir_all(&folder)?;
    let run = Run {
        plan,
        kinds,
        program: &program,
        seeds: &seeds,
        folder: &folder,
        start: Instant::now(),
        next: AtomicU64::new(0),
        read: AtomicU64::new(0),
        failures: Mutex::default(),
        slowest: Mutex::default(),
        bar: progress(plan),
    };
    let workers = thread::available_parallelism().map_or(1, |n| n.get());
    let stopped: Vec<String> = thread::scope(|scope| {
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(|| run.work())).collect();
        let ends = workers.into_iter().map(|worker| worker.join());
        ends.filter_map(|end| match end {
            Ok(Ok(())) => None,
            Ok(Err(error)) => Some(error),
            Err(_) => Some("a worker panicked".to_owned()),
        })
        .collect()
    });
    run.bar.finish_and_clear();
    if let Some(error) = stopped.first() {
        return Err(error.clone().into());
    }
    let cases = run.bar.position();
    println!(
        "{cases} files from seed {}, of which {} could be read nevertheless, in {:.0} s",
        plan.seed,
        run.read.load(Ordering::Relaxed),
        run.start.elapsed().as_secs_f32()
    );
    if let Ok(slowest) = run.slowest.lock() {
        let seconds = slowest.0.as_secs_f32();
        println!("the slowest took {seconds:.1} s: {}", slowest.1);
    }
    let failures = run.failures.lock().map_or(0, |failures| *failures);
    match failures {
        0 => Ok(()),
        count => Err(format!("{count} of {cases} files broke their reader").into()),
    }
}

/// Reads files of a kind as they are, until one can be: where none can, damaged ones are refused for that, and nothing is tried.
///
/// # Errors
/// None can be read, or one breaks its reader.
fn one_is_read(program: &Path, kind: &str, seeds: &[Vec<u8>]) -> Outcome {
    let scratch = tempfile::tempdir()?;
    let path = scratch.path().join(file_name("whole", kind));
    let mut target = Target::start(program)?;
    for seed in seeds {
        fs::write(&path, seed)?;
        if target.read(kind, &path)? {
            return Ok(());
        }
    }
    let count = seeds.len();
    Err(format!("of {count} whole files of the kind {kind} none can be read").into())
}

fn progress(plan: &Plan) -> ProgressBar {
    let bar = match plan.cases {
        Some(cases) => ProgressBar::new(cases),
        None => ProgressBar::new_spinner(),
    };
    let template = match plan.cases {
        Some(_) => "{bar:40} {pos}/{len} files, {eta} left",
        None => "{spinner} {pos} files, {per_sec}, {elapsed}",
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// The files to damage by their kinds.
type Seeds = BTreeMap<&'static str, Vec<Vec<u8>>>;

/// All that there are, in the order of their names, so that a seed makes the same file again.
fn seeds() -> Outcome<Seeds> {
    let data = env::var_os("INKSTRAND_DATA").map(PathBuf::from);
    if data.is_none() {
        println!("INKSTRAND_DATA is not set: files of the repository alone are damaged");
    }
    let folders = FOLDERS.iter().map(|folder| root().join(folder));
    let mut seeds = Seeds::new();
    for folder in folders.chain(data) {
        collect(&folder, &mut seeds)?;
    }
    Ok(seeds)
}

fn collect(folder: &Path, seeds: &mut Seeds) -> Outcome {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut entries = entries.collect::<Result<Vec<_>, _>>()?;
    entries.sort_by_key(|entry| entry.file_name());
    for entry in entries {
        let path = entry.path();
        let file = fs::metadata(&path)?;
        if file.is_dir() {
            collect(&path, seeds)?;
        } else if let Some(kind) = kind_of(&path).filter(|_| file.len() <= LARGEST_SEED) {
            seeds.entry(kind).or_default().push(fs::read(&path)?);
        }
    }
    Ok(())
}

fn kind_of(path: &Path) -> Option<&'static str> {
    let name = path.to_string_lossy();
    let is_it = |(_, endings): &&(_, &[&str])| endings.iter().any(|ending| name.ends_with(ending));
    KINDS.iter().find(is_it).map(|(kind, _)| *kind)
}

/// What workers share.
struct Run<'a> {
    plan: &'a Plan,
    kinds: &'a [&'a str],
    program: &'a Path,
    seeds: &'a Seeds,
    /// Where files stay that broke their reader.
    folder: &'a Path,
    start: Instant,
    next: AtomicU64,
    read: AtomicU64,
    failures: Mutex<usize>,
    /// The longest time that a file took, and the arguments that make it again.
    slowest: Mutex<(Duration, String)>,
    bar: ProgressBar,
}

impl Run<'_> {
    /// Makes files and lets them be read until the plan is done.
    fn work(&self) -> Result<(), String> {
        let said = |error: &dyn std::fmt::Display| error.to_string();
        let scratch = tempfile::tempdir().map_err(|e| said(&e))?;
        let start = || Target::start(self.program).map_err(|e| said(&e));
        let mut target = start()?;
        while let Some(case) = self.next_case() {
            let seed = self.plan.seed.wrapping_add(case);
            let kind = self.kinds[(case % self.kinds.len() as u64) as usize];
            let file = mutate::damaged(&mut Random::new(seed), &self.seeds[kind]);
            let path = scratch.path().join(file_name("input", kind));
            fs::write(&path, &file).map_err(|e| said(&e))?;
            let start_of_case = Instant::now();
            let done = target.read(kind, &path);
            self.note_time(start_of_case.elapsed(), kind, seed);
            match done {
                Ok(true) => drop(self.read.fetch_add(1, Ordering::Relaxed)),
                Ok(false) => {}
                Err(what) => {
                    self.fail(kind, seed, &file, &what).map_err(|e| said(&e))?;
                    target = start()?;
                }
            }
            self.bar.inc(1);
        }
        Ok(())
    }

    fn note_time(&self, time: Duration, kind: &str, seed: u64) {
        if let Ok(mut slowest) = self.slowest.lock()
            && time > slowest.0
        {
            *slowest = (time, format!("--seed {seed} --cases 1 {kind}"));
        }
    }

    /// The number of the next file, if there is to be one.
    fn next_case(&self) -> Option<u64> {
        let time = self.plan.seconds.map(Duration::from_secs);
        let in_time = time.is_none_or(|time| self.start.elapsed() < time);
        let is_whole = (self.failures.lock()).is_ok_and(|failures| *failures < MOST_FAILURES);
        let case = self.next.fetch_add(1, Ordering::Relaxed);
        let is_planned = self.plan.cases.is_none_or(|cases| case < cases);
        (in_time && is_whole && is_planned).then_some(case)
    }

    /// Tells of a file that broke its reader, and keeps it.
    fn fail(&self, kind: &str, seed: u64, file: &[u8], what: &str) -> Outcome {
        let path = self.folder.join(file_name(&format!("seed-{seed}"), kind));
        fs::write(&path, file)?;
        let shown = path.strip_prefix(root()).unwrap_or(&path).display();
        let what: String = what.chars().take(2000).collect();
        self.bar.suspend(|| {
            println!("FAILED {shown}: {what}");
            println!("  again: cargo xtask fuzz --seed {seed} --cases 1 {kind}");
        });
        if let Ok(mut failures) = self.failures.lock() {
            *failures += 1;
        }
        Ok(())
    }
}

/// A file's name with an ending of its kind.
fn file_name(stem: &str, kind: &str) -> String {
    let endings = KINDS.iter().find(|(name, _)| *name == kind);
    format!("{stem}{}", endings.map_or("", |(_, endings)| endings[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_that_failures_name_is_one() {
        let line = ["fuzz", "--seed", "17", "--cases", "1", "gltf"];
        let matches = command().try_get_matches_from(line).unwrap();
        assert_eq!(matches.get_one::<u64>("seed"), Some(&17));
        for both in [["--cases", "--seconds"], ["--hours", "--seconds"]] {
            let both = ["fuzz", both[0], "1", both[1], "1"];
            assert!(command().try_get_matches_from(both).is_err());
        }
        let long = command().try_get_matches_from(["fuzz", "--hours", "0.5"]);
        assert_eq!(long.unwrap().get_one::<u64>("hours"), Some(&1800));
        for wrong in [
            "--hours=nan",
            "--hours=-1",
            "--hours=1h",
            "--hours=1e9",
            "--hours=0",
            "--cases=0",
            "--seconds=0",
        ] {
            assert!(
                command().try_get_matches_from(["fuzz", wrong]).is_err(),
                "{wrong}"
            );
        }
        assert!(command().try_get_matches_from(["fuzz", "png"]).is_err());
    }

    #[test]
    fn the_repository_has_files_of_all_kinds() {
        let mut seeds = Seeds::new();
        for folder in FOLDERS {
            collect(&root().join(folder), &mut seeds).unwrap();
        }
        for (kind, _) in KINDS {
            assert!(seeds.contains_key(kind), "{kind}");
        }
        let meshes = b"\"meshes\"";
        let has_meshes = |file: &&Vec<u8>| file.windows(meshes.len()).any(|bytes| bytes == meshes);
        assert!(seeds["gltf"].iter().filter(has_meshes).count() > 1);
        assert_eq!(kind_of(Path::new("a.style.ron")), Some("style"));
        assert_eq!(kind_of(Path::new("a.png")), None);
    }
}
