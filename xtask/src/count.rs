//! Counts the instructions of a frame, stage by stage: `cargo xtask bench count`.
//!
//! Times lie where other programs run beside; instructions don't. valgrind's callgrind counts those of the program as
//! the tests build it, with one thread on the CPU, for a frame of each of some presets as it moves: the third one, when
//! everything has been loaded and has its memory, and the simulation, which begins in the second, goes on. `tests/yardsticks/counts.toml` holds the counts that later ones are
//! held to. With `--release` it is the program that users run, frames are held to their targets, and a character of 30,000 triangles with a
//! picture on them is counted too, beside the same frame without it: what suite `frame` measures in milliseconds.
//!
//! valgrind runs programs on a processor of its own, which has AVX2 and no AVX-512 where the machine has AVX2: so
//! every such machine counts the same.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::program::{self, Inkstrand};
use crate::{Outcome, setup, work};

/// The presets that are counted, first what takes longest: so cores are done at about one time. Of those that paint their samples, or draw
/// lines of the whole picture, there is no yardstick.
const PRESETS: [(&str, &str); 5] = [
    ("ink-sobel", "presets"),
    ("toon-blinn", "presets"),
    ("blond-fantasy", "tests/yardsticks"),
    ("short-ash", "tests/yardsticks"),
    ("twin-tails", "tests/yardsticks"),
];

/// What else `inkstrand render` gets.
const ARGS: [&str; 7] = [
    "--size=960x720",
    "--samples=4",
    "--backend=cpu",
    "--threads=1",
    "--motion=tests/yardsticks/motions/walk-in-wind.motion.ron",
    "--frames=0-2",
    "--quiet",
];

/// The stages of a frame, in order, each with the function that it is. The first one begins a frame.
const STAGES: [(&str, &str); 4] = [
    ("simulate", "stage::motion::Motion::advance_to"),
    ("paths", "stage::frame_maker::FrameMaker::frame"),
    ("effects", "render::cpu::evaluate::Evaluator::evaluate"),
    ("raster", "render::cpu::Rasterizer::draw"),
];

/// The part of a count by which a later one may differ.
const TOLERANCE: f64 = 0.03;

/// Most instructions that a whole frame of a yardstick should take in a release build: 60 frames a second on one of two
/// cores of about 20 million a millisecond.
const TARGETS: [(&str, u64); 1] = [("twin-tails", 280_000_000)];

/// Presets that `bench character` writes, with a character and without.
const CHARACTER: [&str; 2] = ["character", "no-character"];
/// Most instructions that the character should add to a frame: 3 ms on two cores.
const CHARACTER_TARGET: u64 = 60_000_000;

/// Instructions of a frame's stages, by their names.
type Counts = BTreeMap<String, u64>;

/// The counts of yardsticks, by their names.
type Table = BTreeMap<String, Counts>;

/// Counts, and compares with the stored counts or puts the new ones in their place.
///
/// # Errors
/// A count differs too much; the program doesn't build or run; `bless` where `CI=true`; where `CI=true` also when
/// nothing can be counted.
pub fn run(bless: bool) -> Outcome {
    if bless && program::on_ci() {
        return Err("--bless is for a person; not where CI=true".into());
    }
    if let Some(reason) = obstacle() {
        if program::on_ci() || bless {
            return Err(reason.into());
        }
        println!("SKIPPED: {reason}");
        return Ok(());
    }
    let counted = count_all(&Inkstrand::build()?)?;
    let path = program::root().join("tests/yardsticks/counts.toml");
    if bless {
        print(&counted, &Table::new());
        fs::write(&path, to_toml(&counted))?;
        println!("  stored in {}", path.display());
        return Ok(());
    }
    let stored = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let stored: Table = toml::from_str(&stored).map_err(|e| format!("{}: {e}", path.display()))?;
    print(&counted, &stored);
    let mut differences = differences(&counted, &stored);
    if differences.is_empty() {
        return Ok(());
    }
    differences.push("if that is meant: cargo xtask bench count --bless".to_owned());
    Err(differences.join("\n").into())
}

/// Counts the program as users build it, and tells how far its frames are from their targets.
///
/// # Errors
/// The program doesn't build or run; with `check` where a target is missed, or nothing can be counted.
pub fn run_release(check: bool) -> Outcome {
    if let Some(reason) = obstacle() {
        if check {
            return Err(reason.into());
        }
        println!("SKIPPED: {reason}");
        return Ok(());
    }
    let program = Inkstrand::build_release()?;
    let folder = tempfile::tempdir()?;
    write_character(folder.path())?;
    let mut counted = count_all(&program)?;
    for name in CHARACTER {
        let presets = folder.path().display().to_string();
        counted.insert(name.to_owned(), count(&program, name, &presets)?);
    }
    print(&counted, &Table::new());
    let in_all = |name: &str| -> u64 { counted[name].values().sum() };
    let mut found = TARGETS
        .map(|(name, most)| (name, in_all(name), most))
        .to_vec();
    let [with, without] = CHARACTER.map(in_all);
    let added = with.saturating_sub(without);
    found.push(("what the character adds", added, CHARACTER_TARGET));
    let mut missed = Vec::new();
    for (name, count, most) in found {
        let verdict = if count <= most { "met" } else { "MISSED" };
        let line = format!(
            "{name}: {:.1} million instructions a frame, at most {:.1}: {verdict}",
            count as f64 * 1e-6,
            most as f64 * 1e-6
        );
        println!("  {line}");
        if count > most {
            missed.push(line);
        }
    }
    match check && !missed.is_empty() {
        true => Err(missed.join("\n").into()),
        false => Ok(()),
    }
}

/// Has `bench` write the character and its presets.
fn write_character(folder: &Path) -> Outcome {
    let mut command = program::cargo(&[
        "run",
        "--quiet",
        "--release",
        "--package=bench",
        "--bin=bench",
        "--",
        "character",
    ]);
    command.arg(folder);
    program::succeed(command)
}

/// Counts the frames of all presets.
fn count_all(program: &Inkstrand) -> Result<Table, String> {
    let counted = work::on_all_cores(&PRESETS, "presets", |(name, folder)| {
        count(program, name, folder).map_err(|error| format!("{name}: {error}"))
    });
    let names = PRESETS.iter().map(|(name, _)| (*name).to_owned());
    let counted = names.zip(counted);
    counted.map(|(name, counts)| Ok((name, counts?))).collect()
}

/// Why nothing can be counted here.
fn obstacle() -> Option<&'static str> {
    if !has_avx2() {
        return Some("the stored counts are of x86-64 with AVX2, which this machine hasn't");
    }
    (!setup::has_valgrind()).then_some("no valgrind: `cargo xtask setup` installs it")
}

fn has_avx2() -> bool {
    #[cfg(target_arch = "x86_64")]
    return is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    return false;
}

/// Counts a frame of a preset in that folder of the project.
fn count(program: &Inkstrand, name: &str, presets: &str) -> Outcome<Counts> {
    let folder = tempfile::tempdir()?;
    let profile = folder.path().join("profile");
    let mut command = Command::new("valgrind");
    command
        .args(["--tool=callgrind", "--compress-strings=no"])
        // What comes before each frame has a profile of its own, with a number at its end: this one is the last frame's.
        .arg(format!("--dump-before={}", STAGES[0].1))
        .arg(format!("--callgrind-out-file={}", profile.display()))
        .arg(program.path())
        .args(["render", &format!("{presets}/{name}.ron")])
        .args(ARGS)
        .arg("-o")
        .arg(folder.path().join("frame_#.png"))
        .current_dir(program::root());
    program::finished(&command.output()?)?;
    stages(&fs::read_to_string(profile)?)
}

/// What each stage takes in a profile, in callgrind's format: below a line `cfn=FUNCTION` come `calls=...` and a line
/// whose last number is what the function took, with all that it called.
fn stages(profile: &str) -> Outcome<Counts> {
    let mut counts = Counts::new();
    let mut lines = profile.lines();
    let mut called = "";
    while let Some(line) = lines.next() {
        if let Some(function) = line.strip_prefix("cfn=") {
            called = function;
        }
        if !line.starts_with("calls=") {
            continue;
        }
        let cost = lines.next().and_then(|line| line.split(' ').next_back());
        let cost: u64 = cost.ok_or("a profile that ends with a call")?.parse()?;
        if let Some((stage, _)) = STAGES.iter().find(|(_, function)| *function == called) {
            *counts.entry((*stage).to_owned()).or_default() += cost;
        }
    }
    for (stage, function) in STAGES {
        if !counts.contains_key(stage) {
            let file = file!();
            return Err(
                format!("nothing calls {function}: what is stage {stage} now? ({file})").into(),
            );
        }
    }
    Ok(counts)
}

/// What is not as stored, a line each.
fn differences(counted: &Table, stored: &Table) -> Vec<String> {
    let mut differences = Vec::new();
    for (name, counts) in counted {
        for (stage, count) in counts {
            let Some(before) = stored.get(name).and_then(|counts| counts.get(stage)) else {
                differences.push(format!("{name}, {stage}: no count is stored"));
                continue;
            };
            let ratio = *count as f64 / *before as f64;
            if (ratio - 1.0).abs() > TOLERANCE {
                let percent = 100.0 * (ratio - 1.0);
                differences.push(format!(
                    "{name}, {stage}: {count} instructions a frame, {percent:+.1} % of the stored {before}"
                ));
            }
        }
    }
    differences
}

/// A table to read, in millions.
fn print(counted: &Table, stored: &Table) {
    for (name, counts) in counted {
        let before = stored.get(name);
        let line = |stage: &str, count: u64, before: Option<u64>| {
            let change = before.map(|before| {
                let percent = 100.0 * (count as f64 / before as f64 - 1.0);
                format!("{percent:+8.2} %")
            });
            let change = change.unwrap_or_default();
            println!(
                "  {name:14} {stage:9} {:9.2} million{change}",
                count as f64 * 1e-6
            );
        };
        for (stage, _) in STAGES {
            let before = before.and_then(|counts| counts.get(stage)).copied();
            line(stage, counts[stage], before);
        }
        let before = before.map(|counts| counts.values().sum());
        line("in all", counts.values().sum(), before);
    }
}

fn to_toml(table: &Table) -> String {
    let mut text = String::from(
        "# Instructions of a frame of the yardsticks and of two looks that paint, by stages: made by `cargo xtask bench count --bless`, held to within\n\
         # 3 % by `cargo xtask test counts`.\n",
    );
    for (name, counts) in table {
        text.push_str(&format!("\n[{name}]\n"));
        for (stage, _) in STAGES {
            text.push_str(&format!("{stage} = {}\n", counts[stage]));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(raster: u64) -> Table {
        let counts = STAGES.map(|(stage, _)| (stage.to_owned(), 1000));
        let mut counts = Counts::from(counts);
        counts.insert("raster".to_owned(), raster);
        Table::from([("made".to_owned(), counts)])
    }

    /// A profile in which a function of the program calls each of `called`.
    fn profile(called: &[&str]) -> String {
        let calls = called.iter().map(|function| {
            format!("cob=inkstrand\ncfi=a.rs\ncfn={function}\ncalls=1 12\n34 500\n")
        });
        let calls: String = calls.collect();
        format!("events: Ir\n\nfn=inkstrand::painter::Painter::paint\n33 7\n{calls}35 8\n")
    }

    #[test]
    fn a_stage_is_what_calls_of_its_function_take() {
        let mut called = STAGES.map(|(_, function)| function).to_vec();
        called.extend([STAGES[3].1, "render::cpu::Rasterizer::draw_other"]);
        let counts = stages(&profile(&called)).unwrap();
        assert_eq!(counts["effects"], 500);
        assert_eq!(counts["raster"], 1000);
    }

    #[test]
    fn a_stage_that_nothing_calls_is_an_error() {
        let error = stages(&profile(&[STAGES[0].1])).unwrap_err().to_string();
        assert!(error.contains("nothing calls stage::"), "{error}");
        assert!(stages("fn=a\ncfn=b\ncalls=1 2\n").is_err());
        assert!(stages("fn=a\ncfn=b\ncalls=1 2\n3 many\n").is_err());
    }

    #[test]
    fn more_and_fewer_instructions_than_stored_are_told() {
        assert_eq!(differences(&table(1029), &table(1000)), [""; 0]);
        assert_eq!(differences(&table(971), &table(1000)), [""; 0]);
        for raster in [1031, 969] {
            let found = differences(&table(raster), &table(1000));
            assert_eq!(found.len(), 1);
            assert!(found[0].starts_with("made, raster: "), "{found:?}");
        }
        let found = differences(&table(1000), &Table::new());
        assert_eq!(found.len(), STAGES.len());
    }

    #[test]
    fn what_is_stored_is_read_again() {
        let stored = to_toml(&table(1234));
        assert_eq!(toml::from_str::<Table>(&stored).unwrap(), table(1234));
    }
}
