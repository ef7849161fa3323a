//! Builds the `bench` program in release and runs one of its suites.

use clap::{Arg, ArgAction, ArgMatches, Command};

use crate::Outcome;
use crate::program::{cargo, succeed};

/// Suites that have a name; the flag is true if the program has it.
const SUITES: &[(&str, bool)] = &[
    ("strokes", true),
    ("dynamics", true),
    ("coherence", true),
    ("skip", false),
    ("scale", true),
    ("frame", true),
    ("all", false),
];

/// The task's part of the command line.
pub fn command() -> Command {
    let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    Command::new("bench")
        .about("Measures time against error: target/bench/SUITE.csv and a plot")
        .arg(
            Arg::new("suite")
                .help("Built so far: strokes, dynamics, coherence, frame, scale")
                .value_name("SUITE")
                .value_parser(SUITES.iter().map(|suite| suite.0).collect::<Vec<_>>())
                .required(true),
        )
        .arg(flag("quick").help("Within two minutes on two cores"))
        .arg(flag("check").help("Fails if a target is missed"))
        .arg(
            Arg::new("peers")
                .long("peers")
                .help("Other programs too, by the scripts in DIR or in the folder that INKSTRAND_PEERS names: dynamics")
                .value_name("DIR")
                .num_args(0..=1)
                .require_equals(true)
                .default_missing_value(""),
        )
}

/// Runs the suite of `args`, its table going where ours goes.
///
/// # Errors
/// The suite isn't built yet, or its program fails: with `--check` also for a missed target.
pub fn run(args: &ArgMatches) -> Outcome {
    let name = args.get_one::<String>("suite").map_or("", String::as_str);
    if !SUITES.contains(&(name, true)) {
        return Err(format!("bench {name} isn't built yet").into());
    }
    let peers = args.get_one::<String>("peers");
    if peers.is_some() && name != "dynamics" {
        return Err(format!("bench {name} has no peers to run: those of dynamics alone").into());
    }
    let mut command = cargo(&[
        "run",
        "--quiet",
        "--release",
        "--package=bench",
        "--bin=bench",
    ]);
    command.args(["--", name]);
    for flag in ["quick", "check"] {
        if args.get_flag(flag) {
            command.arg(format!("--{flag}"));
        }
    }
    match peers.map(String::as_str) {
        None => {}
        Some("") => _ = command.arg("--peers"),
        Some(folder) => _ = command.arg(format!("--peers={folder}")),
    }
    succeed(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_built_says_so() {
        let error = |line: &[&str]| {
            let matches = command().try_get_matches_from(line).unwrap();
            run(&matches).unwrap_err().to_string()
        };
        assert_eq!(
            error(&["bench", "skip", "--quick"]),
            "bench skip isn't built yet"
        );
        assert_eq!(
            error(&["bench", "strokes", "--peers"]),
            "bench strokes has no peers to run: those of dynamics alone"
        );
    }

    #[test]
    fn an_unknown_suite_is_wrong_usage() {
        let error = command().try_get_matches_from(["bench", "stroke"]);
        assert_eq!(error.unwrap_err().exit_code(), 2);
    }
}
