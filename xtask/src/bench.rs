//! Builds the `bench` program in release and runs one of its suites; or counts instructions.

use clap::{Arg, ArgAction, ArgMatches, Command};

use crate::program::{cargo, succeed};
use crate::{Outcome, count};

/// Suites of the program, and our own.
const SUITES: [&str; 12] = [
    "all",
    "strokes",
    "dynamics",
    "coherence",
    "frame",
    "looks",
    "scale",
    "cartoon",
    "lines",
    "skip",
    "rest",
    COUNT,
];
const COUNT: &str = "count";
/// Suites that run other programs.
const WITH_PEERS: [&str; 2] = ["dynamics", "lines"];
/// Flags of the program's suites.
const FLAGS: [&str; 3] = ["quick", "check", "peers"];

/// The task's part of the command line.
pub fn command() -> Command {
    let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    Command::new("bench")
        .about("Measures time against error: target/bench/SUITE.csv and a plot, of `all` a page too; or counts instructions")
        .arg(
            Arg::new("suite")
                .help("What is measured")
                .value_name("SUITE")
                .value_parser(SUITES)
                .required(true),
        )
        .arg(flag("quick").help("Some two minutes a suite on two cores; all runs ten suites"))
        .arg(flag("check").help("Fails if a target is missed"))
        .arg(
            flag("peers")
                .help("Other programs too, by the Python that INKSTRAND_PYTHON names: dynamics, lines"),
        )
        .arg(flag("release").help("Counts the program that users run, in place of the tests' build: count"))
        .arg(flag("bless").help("Stores the counts as those that later ones are held to: count"))
}

/// Runs the suite of `args`, its table going where ours goes.
///
/// # Errors
/// Its program fails: with `--check` also for a missed target.
pub fn run(args: &ArgMatches) -> Outcome {
    let name = args.get_one::<String>("suite").map_or("", String::as_str);
    let bless = args.get_flag("bless");
    let is_release = args.get_flag("release");
    if name == COUNT {
        let knows = |flag: &str| is_release && flag == "check";
        let mut flags = FLAGS.iter().filter(|flag| args.get_flag(flag));
        return match flags.find(|flag| !knows(flag)) {
            Some(flag) => Err(format!("bench count has no --{flag}").into()),
            None if is_release && bless => Err("counts of --release aren't stored".into()),
            None if is_release => count::run_release(args.get_flag("check")),
            None => count::run(bless),
        };
    }
    if is_release {
        return Err(format!("bench {name} is always of a release build").into());
    }
    if bless {
        return Err(format!("bench {name} stores nothing: --bless is for count alone").into());
    }
    if args.get_flag("peers") && !WITH_PEERS.contains(&name) {
        let with_peers = WITH_PEERS.join(" and ");
        return Err(format!("bench {name} has no peers to run: {with_peers} have").into());
    }
    let mut command = cargo(&[
        "run",
        "--quiet",
        "--release",
        "--package=bench",
        "--bin=bench",
    ]);
    command.args(["--", name]);
    for flag in FLAGS {
        if args.get_flag(flag) {
            command.arg(format!("--{flag}"));
        }
    }
    succeed(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_of_other_suites_are_refused() {
        for (suite, flag, complaint) in [
            ("strokes", "--peers", "has no peers"),
            ("frame", "--bless", "stores nothing"),
            ("count", "--quick", "bench count has no --quick"),
            ("count", "--check", "bench count has no --check"),
            ("strokes", "--release", "is always of a release build"),
        ] {
            let matches = command().try_get_matches_from(["bench", suite, flag]);
            let error = run(&matches.unwrap()).unwrap_err().to_string();
            assert!(error.contains(complaint), "{error}");
        }
    }

    #[test]
    fn an_unknown_suite_is_wrong_usage() {
        let error = command().try_get_matches_from(["bench", "stroke"]);
        assert_eq!(error.unwrap_err().exit_code(), 2);
    }
}
