//! Builds the `bench` program and lets it run random scenes.

use clap::{Arg, ArgAction, ArgMatches, Command};

use crate::Outcome;
use crate::program::{cargo, succeed};

/// Options that have a value: name, value, help. The program checks the values.
const VALUES: &[(&str, &str, &str)] = &[
    ("hours", "N", "For how long [default: a minute]"),
    ("seed", "S", "One scene alone, that of this seed"),
    (
        "from",
        "S",
        "The first seed of many [default: by the clock]",
    ),
];

/// The task's part of the command line.
pub fn command() -> Command {
    let value = |&(name, value, help): &(&'static str, &'static str, &'static str)| {
        Arg::new(name).long(name).value_name(value).help(help)
    };
    Command::new("stress")
        .about("Runs random scenes with hostile numbers, in which strands must hold")
        .args(VALUES.iter().map(value))
        .arg(
            Arg::new("keep-going")
                .long("keep-going")
                .help("Goes on after a scene that fails")
                .action(ArgAction::SetTrue),
        )
}

/// Runs the scenes, as developers build the program: hot crates are optimised there too, and sums that overflow are
/// caught.
///
/// # Errors
/// A scene fails; which one, and how to run it again, is printed.
pub fn run(args: &ArgMatches) -> Outcome {
    let mut command = cargo(&["run", "--quiet", "--package=bench", "--bin=bench"]);
    command.args(["--", "stress"]);
    for (name, ..) in VALUES {
        if let Some(value) = args.get_one::<String>(name) {
            command.arg(format!("--{name}={value}"));
        }
    }
    if args.get_flag("keep-going") {
        command.arg("--keep-going");
    }
    succeed(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_that_failures_name_is_one() {
        let line = ["stress", "--seed", "17"];
        let matches = command().try_get_matches_from(line).unwrap();
        assert_eq!(matches.get_one::<String>("seed").unwrap(), "17");
        assert!(command().try_get_matches_from(["stress", "17"]).is_err());
    }
}
