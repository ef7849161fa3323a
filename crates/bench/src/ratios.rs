//! Ratios of times, and of counts, as they were, so that worse ones are seen: those of suites `strokes` and `skip`, a line each.

use crate::BenchError;
use crate::targets::{Found, Limit, Target};

/// Where they are, from the project's folder: `bench SUITE --store` writes them.
pub const PATH: &str = "crates/bench/stored/ratios.csv";
/// The ratios.
const STORED: &str = include_str!("../stored/ratios.csv");
/// A ratio is no worse up to this factor: its two times are of one run, but machines differ in more than speed.
const WORSE: f64 = 1.5;

/// Of a line: its suite, its ratio, its text.
type Line<'a> = (&'a str, f64, &'a str);

fn lines(stored: &str) -> Result<Vec<Line<'_>>, BenchError> {
    let lines = stored.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines
        .map(|line| {
            let broken = || format!("broken line of stored ratios: {line}");
            let mut parts = line.splitn(3, ',');
            let mut part = || parts.next().ok_or_else(broken);
            let (suite, ratio, text) = (part()?, part()?, part()?);
            Ok((suite, ratio.parse().map_err(|_| broken())?, text))
        })
        .collect()
}

/// What of a suite can be stored. What is nothing has no ratio to what it was; its own target holds it.
fn ratio(target: &Target) -> Option<f64> {
    match (target.found, target.limit) {
        (Some(Found::Is(found)), Limit::AtMost(_)) if found.is_finite() && found > 0.0 => {
            Some(found)
        }
        _ => None,
    }
}

/// The file with the ratios of this suite in place of those that it has.
///
/// # Errors
///
/// When the file is broken.
pub fn renewed(stored: &str, suite: &str, targets: &[Target]) -> Result<String, BenchError> {
    let others = lines(stored)?;
    let others = others.into_iter().filter(|(of, ..)| *of != suite);
    let own = targets
        .iter()
        .filter_map(|target| Some((suite, ratio(target)?, &*target.text)));
    let mut all: Vec<Line> = others.chain(own).collect();
    all.sort_by(|a, b| a.0.cmp(b.0));
    let lines = all
        .into_iter()
        .map(|(suite, ratio, text)| format!("{suite},{ratio:.4e},{text}"));
    let comment = "ratios of times: written by `bench SUITE --store`, held by `--check`".to_owned();
    Ok(crate::results::table(&[comment], "suite,ratio,text", lines))
}

/// A target for each ratio of a run that is stored.
///
/// # Errors
///
/// When the stored file is broken.
pub fn against(suite: &str, targets: &[Target]) -> Result<Vec<Target>, BenchError> {
    compare(suite, targets, STORED)
}

fn compare(suite: &str, targets: &[Target], stored: &str) -> Result<Vec<Target>, BenchError> {
    let of_suite = lines(stored)?.into_iter().filter(|(of, ..)| *of == suite);
    let found = |text: &str| targets.iter().find(|target| target.text == text);
    let as_stored = |(_, before, text): Line| {
        Some(Target {
            text: format!("{text}, over that stored"),
            found: Some(Found::Is(ratio(found(text)?)? / before)),
            limit: Limit::AtMost(WORSE),
        })
    };
    Ok(of_suite.filter_map(as_stored).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target(text: &str, ratio: f64) -> Target {
        Target {
            text: text.to_owned(),
            found: Some(Found::Is(ratio)),
            limit: Limit::AtMost(0.25),
        }
    }

    #[test]
    fn what_is_stored_is_found_again() {
        let before = renewed(
            "# none\nsuite,ratio,text\n",
            "skip",
            &[target("far, time", 0.2)],
        )
        .unwrap();
        // Another suite leaves it alone; what never came isn't stored.
        let ours = [
            target("a, b", 0.5),
            target("never", f64::INFINITY),
            target("nothing", 0.0),
        ];
        let stored = renewed(&before, "strokes", &ours).unwrap();
        assert_eq!(lines(&stored).unwrap().len(), 2);
        let now = [target("far, time", 0.29), target("new", 1.0)];
        let against = compare("skip", &now, &stored).unwrap();
        assert_eq!(against.len(), 1);
        assert!(against[0].is_met());
        let worse = compare("skip", &[target("far, time", 0.31)], &stored).unwrap();
        assert!(!worse[0].is_met());
        assert!(compare("skip", &now, "suite,ratio,text\nskip,soon,far\n").is_err());
    }

    #[test]
    fn the_stored_ratios_are_read() {
        lines(STORED).unwrap();
    }
}
