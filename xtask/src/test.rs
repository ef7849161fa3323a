//! Everything that must hold, step by step. A step that fails doesn't keep the others from
//! running, so that one run tells all there is to mend.

use std::time::{Duration, Instant};

use crate::program::{WORKSPACE, cargo, succeed};
use crate::regress::Backend;
use crate::{Outcome, count, figures, fuzz, layers, regress, test_programs, wasm};

/// A step's name, and what it does; its output goes to the terminal.
type Step = (&'static str, fn() -> Outcome);

const STEPS: &[Step] = &[
    ("format", || succeed(cargo(&["fmt", "--all", "--check"]))),
    ("layers", layers::check),
    ("lints", || {
        let (lint, deny) = (["clippy", "--all-targets"], ["--", "--deny=warnings"]);
        succeed(cargo(&[&lint[..], &WORKSPACE, &deny].concat()))
    }),
    ("docs", || {
        let mut doc = cargo(&[&["doc", "--no-deps"], &DOCUMENTED[..], &WORKSPACE].concat());
        doc.env("RUSTDOCFLAGS", "--deny=warnings");
        succeed(doc)
    }),
    ("features", || {
        WITHOUT_DEFAULTS.iter().try_for_each(|package| {
            let check = ["clippy", "--no-default-features", "--package", package];
            succeed(cargo(&[&check[..], &["--", "--deny=warnings"]].concat()))
        })
    }),
    // Unit, property, conformance and command-line tests.
    ("tests", test_programs::run),
    ("fuzz", fuzz::briefly),
    ("wasm", wasm::check),
    ("figures", figures::run),
    ("regressions", || regress::run("", Backend::Cpu, false)),
    ("backends", || regress::run("", Backend::Gpu, false)),
    ("counts", || count::run(false)),
];

/// What has docs: all libraries, and the programs that are none. An example is there because the crates that examples and
/// tests use count with it, and their features: so dependencies are as the lints have checked them.
const DOCUMENTED: [&str; 5] = [
    "--lib",
    "--bin=xtask",
    "--bin=backlight",
    "--bin=backlight-viewer",
    "--example=fuzz_target",
];

/// The crates that must compile with all of their features off: those whose own they are, and the program, which
/// turns them off for all.
const WITHOUT_DEFAULTS: &[&str] = &["hair-sim", "mesh-io", "hair-io", "render", "inkstrand"];

/// The names of all steps, in the order in which they run.
pub fn step_names() -> Vec<&'static str> {
    STEPS.iter().map(|(name, _)| *name).collect()
}

/// Runs the steps named in `only`, or all of them.
///
/// # Errors
/// The number of steps that failed; which and why is printed.
pub fn run(only: &[&String]) -> Outcome {
    let chosen = |step: &&Step| only.is_empty() || only.iter().any(|name| *name == step.0);
    run_steps(STEPS.iter().filter(chosen))
}

fn run_steps<'a>(steps: impl Iterator<Item = &'a Step>) -> Outcome {
    let start = Instant::now();
    let mut lines = Vec::new();
    let mut failed = 0;
    for (name, step) in steps {
        println!("\n== {name}");
        let start = Instant::now();
        let result = step();
        let time = seconds(start.elapsed());
        match result {
            Ok(()) => {
                println!("== {name}: passed in {time}");
                lines.push(format!("  passed  {name} ({time})"));
            }
            Err(error) => {
                println!("{error}\n== {name}: FAILED in {time}");
                // The whole text stands above; here its first line is enough.
                let text = error.to_string();
                let reason = text.lines().next().unwrap_or_default();
                let more = if text.lines().count() > 1 { " ..." } else { "" };
                lines.push(format!("  FAILED  {name} ({time}): {reason}{more}"));
                failed += 1;
            }
        }
    }
    println!("\n== summary, {}", seconds(start.elapsed()));
    for line in &lines {
        println!("{line}");
    }
    println!("{} passed, {failed} failed", lines.len() - failed);
    match failed {
        0 => Ok(()),
        _ => Err("not everything holds".into()),
    }
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f32())
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;

    #[test]
    fn a_failing_step_fails_the_run_and_stops_no_other() {
        static RUNS: AtomicU32 = AtomicU32::new(0);
        let passes: Step = ("passes", || {
            RUNS.fetch_add(1, Ordering::Relaxed);
            Ok(())
        });
        let fails: Step = ("fails", || Err("broken\nin two lines".into()));
        assert!(run_steps([passes, fails, passes].iter()).is_err());
        assert_eq!(RUNS.load(Ordering::Relaxed), 2);
        assert!(run_steps([passes].iter()).is_ok());
    }
}
