//! Ratios of times, and of counts, as they were, so that worse ones are seen: those of suites `strokes` and `skip`, a line each.

use crate::BenchError;
use crate::targets::{Found, Limit, Target};

/// Where they are, from the project's folder: `bench SUITE --store` writes them.
pub const PATH: &str = "crates/bench/stored/ratios.csv";
/// The ratios.
const STORED: &str = include_str!("../stored/ratios.csv");
/// Their columns.
const COLUMNS: &str = "suite,scene,name,ratio";
/// A ratio of times is no worse up to this factor: its two times are of one run, but machines differ in more than speed.
pub const TIMES: f64 = 1.5;
/// The same of errors, which are nearly the same on every machine.
pub const ERRORS: f64 = 1.05;
/// The same of counts, which no machine can blur.
pub const COUNTS: f64 = 1.01;

/// A ratio of a run, and what it is found again by.
#[derive(Clone, Debug)]
pub struct Ratio {
    /// What it was measured on.
    pub scene: String,
    /// What was measured there. It has no limit in it, and stays when the target's sentence changes.
    pub name: String,
    /// It is no worse than the stored one up to this factor.
    pub worse: f64,
    /// What it is held to by itself.
    pub target: Target,
}

/// A line of the stored file.
#[derive(Clone, Debug)]
struct Line<'a> {
    suite: &'a str,
    scene: &'a str,
    name: &'a str,
    ratio: f64,
}

fn lines(stored: &str) -> Result<Vec<Line<'_>>, BenchError> {
    let lines = stored.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines
        .map(|line| {
            let broken = || format!("broken line of stored ratios: {line}");
            let parts: Vec<&str> = line.split(',').collect();
            let [suite, scene, name, ratio] = parts[..] else {
                return Err(broken().into());
            };
            Ok(Line {
                suite,
                scene,
                name,
                ratio: ratio.parse().map_err(|_| broken())?,
            })
        })
        .collect()
}

/// What of a ratio can be stored. What is nothing has no ratio to what it was; its own target holds it.
fn storable(target: &Target) -> Option<f64> {
    match target.found {
        Some(Found::Is(found)) if found.is_finite() && found > 0.0 => Some(found),
        _ => None,
    }
}

/// The file with the ratios of this suite in place of those that it has.
///
/// # Errors
///
/// When the file is broken.
pub fn renewed(stored: &str, suite: &str, ratios: &[Ratio]) -> Result<String, BenchError> {
    let others = lines(stored)?;
    let others = others.into_iter().filter(|line| line.suite != suite);
    let own = ratios.iter().filter_map(|ratio| {
        Some(Line {
            suite,
            scene: &ratio.scene,
            name: &ratio.name,
            ratio: storable(&ratio.target)?,
        })
    });
    let mut all: Vec<Line> = others.chain(own).collect();
    all.sort_by(|a, b| a.suite.cmp(b.suite));
    let lines = all.into_iter().map(|line| {
        let Line {
            suite,
            scene,
            name,
            ratio,
        } = line;
        format!("{suite},{scene},{name},{ratio:.4e}")
    });
    let comment = "ratios of times: written by `bench SUITE --store`, held by `--check`".to_owned();
    Ok(crate::results::table(&[comment], COLUMNS, lines))
}

/// A target for each ratio that is stored of a suite. One that was not measured is missed but in a quick run, which leaves some out; and so
/// is a target that says so where none is stored at all.
///
/// # Errors
///
/// When the stored file is broken.
pub fn against(suite: &str, ratios: &[Ratio], quick: bool) -> Result<Vec<Target>, BenchError> {
    compare(suite, ratios, quick, STORED)
}

fn compare(
    suite: &str,
    ratios: &[Ratio],
    quick: bool,
    stored: &str,
) -> Result<Vec<Target>, BenchError> {
    let mut stored = lines(stored)?;
    stored.retain(|line| line.suite == suite);
    if stored.is_empty() {
        return Ok(vec![Target {
            text: format!(
                "no ratios of suite {suite} are stored: run `cargo run --release -p bench -- {suite} --store`"
            ),
            found: None,
            limit: Limit::AtMost(TIMES),
        }]);
    }
    let targets = stored.iter().filter_map(|line| {
        let is_it = |ratio: &&Ratio| ratio.scene == line.scene && ratio.name == line.name;
        match ratios.iter().find(is_it) {
            Some(ratio) => Some(over_stored(ratio, line.ratio)),
            None if quick => None,
            None => Some(Target {
                text: format!("{}: {}, which is stored", line.scene, line.name),
                found: None,
                limit: Limit::AtMost(TIMES),
            }),
        }
    });
    Ok(targets.collect())
}

fn over_stored(ratio: &Ratio, before: f64) -> Target {
    let found = ratio.target.found.map(|found| match found {
        Found::Is(now) => Found::Is(now / before),
        Found::Below(now) => Found::Below(now / before),
    });
    Target {
        text: format!("{}, over that stored", ratio.target.text),
        found,
        limit: Limit::AtMost(ratio.worse),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ratio(scene: &str, name: &str, worse: f64, found: Option<Found>) -> Ratio {
        Ratio {
            scene: scene.to_owned(),
            name: name.to_owned(),
            worse,
            target: Target {
                text: format!("{scene}: {name}, in a sentence (0.1 was asked)"),
                found,
                limit: Limit::AtMost(0.25),
            },
        }
    }

    fn time(scene: &str, found: f64) -> Ratio {
        ratio(scene, "time", TIMES, Some(Found::Is(found)))
    }

    /// A file with the times of two cases of suite skip.
    fn stored() -> String {
        let both = [time("far", 0.2), time("near", 0.4)];
        renewed("# none\nsuite,scene,name,ratio\n", "skip", &both).unwrap()
    }

    #[test]
    fn what_is_stored_is_found_again() {
        // Another suite leaves it alone; what never came, or is nothing, isn't stored.
        let ours = [time("a", 0.5), time("never", f64::INFINITY), time("b", 0.0)];
        let stored = renewed(&stored(), "strokes", &ours).unwrap();
        assert_eq!(lines(&stored).unwrap().len(), 3);
        let mut now = [time("far", 0.29), time("near", 0.4), time("new", 1.0)];
        // Its sentence may change.
        now[0].target.text = "far, as it is now (0.2 was asked)".to_owned();
        let against = compare("skip", &now, false, &stored).unwrap();
        assert_eq!(against.len(), 2);
        assert!(against.iter().all(Target::is_met), "{against:?}");
        assert!(compare("skip", &now, false, "columns\nskip,far,time,soon\n").is_err());
        assert!(compare("skip", &now, false, "columns\nskip,far,0.2\n").is_err());
    }

    #[test]
    fn what_is_worse_or_never_comes_is_missed() {
        for (found, is_met) in [
            (Some(Found::Is(0.0)), true),
            (Some(Found::Is(0.31)), false),
            (Some(Found::Is(f64::INFINITY)), false),
            (Some(Found::Below(0.1)), true),
            (None, false),
        ] {
            let now = [ratio("far", "time", TIMES, found)];
            let against = compare("skip", &now, true, &stored()).unwrap();
            assert_eq!(against[0].is_met(), is_met, "{found:?}");
        }
        // A count is as it was.
        let now = [ratio("far", "time", COUNTS, Some(Found::Is(0.21)))];
        assert!(!compare("skip", &now, true, &stored()).unwrap()[0].is_met());
    }

    #[test]
    fn what_is_stored_and_measured_no_more_is_missed() {
        let now = [time("far", 0.2)];
        let against = compare("skip", &now, false, &stored()).unwrap();
        assert_eq!(against.len(), 2);
        assert!(against[1].text.starts_with("near: time") && !against[1].is_met());
        // A quick run leaves some out.
        assert_eq!(compare("skip", &now, true, &stored()).unwrap().len(), 1);
    }

    #[test]
    fn a_suite_of_which_nothing_is_stored_says_so() {
        for quick in [false, true] {
            let against = compare("strokes", &[], quick, &stored()).unwrap();
            assert_eq!(against.len(), 1);
            assert!(
                against[0].text.contains("-- strokes --store") && !against[0].is_met(),
                "{against:?}"
            );
        }
    }

    #[test]
    fn the_stored_ratios_are_read() {
        assert!(!lines(STORED).unwrap().is_empty());
        assert!(STORED.contains(COLUMNS));
    }
}
