//! Our figures as they were, so that worse ones are seen: errors, and times over those of a yardstick.

use super::names::{self, CANTILEVER, OWN, XPBD_STEPS};
use crate::BenchError;
use crate::results::{Row, table};
use crate::targets::{Found, Limit, Target};

/// The figures, as `bench dynamics --store` wrote them.
const STORED: &str = include_str!("../../stored/dynamics.csv");
/// Their columns.
const COLUMNS: &str = "scene,method,knob,time,error";
/// An error is no worse up to this factor. Errors are the same on every machine.
const WORSE: f64 = 1.05;
/// Errors of falls may differ by this: that of the reference by refinement, where the other is not at hand.
const REFERENCES: f64 = 1.5e-4;
/// A time is no worse up to this factor: machines differ in more than speed, and are never quiet.
const SLOWER: f64 = 2.5;

/// The time that others are measured by, in s: plain arithmetic on one thread, nothing of ours.
fn yardstick(rows: &[Row]) -> Option<f64> {
    let is_it = |row: &&Row| row.scene == "drop-10" && row.method == XPBD_STEPS && row.knob == 64;
    rows.iter().find(is_it).map(|row| row.seconds)
}

/// The file to store of a run.
///
/// # Errors
///
/// When the run has no yardstick.
pub fn file(rows: &[Row]) -> Result<String, BenchError> {
    let yardstick = yardstick(rows).ok_or("there is nothing to measure times by")?;
    let lines = rows
        .iter()
        .filter(|row| row.method.starts_with(OWN.trim_end_matches('-')))
        .map(|row| {
            let error = row
                .error
                .map_or(String::new(), |error| format!("{error:.4e}"));
            // What is run only once has no time to hold it to.
            let time = if row.scene.starts_with(CANTILEVER) {
                String::new()
            } else {
                format!("{:.4e}", row.seconds / yardstick)
            };
            format!("{},{},{},{time},{error}", row.scene, row.method, row.knob)
        });
    let comments = [
        "our figures of suite dynamics: written by `bench dynamics --store`, held by `--check`",
        "time: over that of drop-10, xpbd-steps, 64",
    ];
    Ok(table(&comments.map(str::to_owned), COLUMNS, lines))
}

/// How a run stands to the stored figures.
pub struct Against {
    /// A target for each error and time that is stored. One that was not measured is missed but in a quick run, which leaves some out.
    pub targets: Vec<Target>,
    /// Rows of other numbers of threads than the run had, in words: they are of another machine, and not compared.
    pub not_compared: Vec<String>,
}

/// A run against what is stored.
///
/// # Errors
///
/// When the stored file is broken or the run has no yardstick.
pub fn against(rows: &[Row], quick: bool) -> Result<Against, BenchError> {
    compare(rows, quick, STORED)
}

/// Figures of the stored file, none where a row has no time or no error.
struct Line<'a> {
    scene: &'a str,
    method: &'a str,
    knob: usize,
    time: Option<f64>,
    error: Option<f64>,
}

fn lines(stored: &str) -> Result<Vec<Line<'_>>, BenchError> {
    let lines = stored.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines
        .map(|line| {
            let broken = || format!("broken line of stored figures: {line}");
            let parts: Vec<&str> = line.split(',').collect();
            let [scene, method, knob, time, error] = parts[..] else {
                return Err(broken().into());
            };
            let figure = |text: &str| match text {
                "" => Ok(None),
                text => text.parse().map(Some).map_err(|_| broken()),
            };
            Ok(Line {
                scene,
                method,
                knob: knob.parse().map_err(|_| broken())?,
                time: figure(time)?,
                error: figure(error)?,
            })
        })
        .collect()
}

fn compare(rows: &[Row], quick: bool, stored: &str) -> Result<Against, BenchError> {
    let yardstick = yardstick(rows).ok_or("there is nothing to measure times by")?;
    let mut against = Against {
        targets: Vec::new(),
        not_compared: Vec::new(),
    };
    for line in lines(stored)? {
        let of_method = |row: &&Row| row.scene == line.scene && row.method == line.method;
        let mut own = rows.iter().filter(of_method);
        match own.clone().find(|row| row.knob == line.knob) {
            Some(row) => against.targets.extend(line.targets(Some(row), yardstick)),
            None if own.next().is_some() && has_threads(line.scene) => {
                let text = format!("{}: {}, {} threads", line.scene, line.method, line.knob);
                against.not_compared.push(text);
            }
            None if quick => {}
            None => against.targets.extend(line.targets(None, yardstick)),
        }
    }
    Ok(against)
}

/// True of scenes whose knob is threads.
fn has_threads(scene: &str) -> bool {
    let kinds = [names::MOTION, names::FULL, names::REST, names::SHOWN];
    kinds.iter().any(|kind| scene.starts_with(kind))
}

impl Line<'_> {
    /// What its row is held to, which may not have been measured.
    fn targets(&self, row: Option<&Row>, yardstick: f64) -> Vec<Target> {
        let target = |figure: &str, found: Option<f64>, worse: f64| Target {
            text: format!(
                "{}: {}, {}: {figure} over the stored one",
                self.scene, self.method, self.knob
            ),
            found: found.map(Found::Is),
            limit: Limit::AtMost(worse),
        };
        let time = self.time.map(|time| {
            let now = row.map(|row| row.seconds / yardstick / time);
            target("time", now, SLOWER)
        });
        let apart = match self.scene.starts_with(CANTILEVER) {
            true => 0.0,
            false => REFERENCES,
        };
        let error = self.error.map(|error| {
            let now = row.and_then(|row| row.error);
            target("error", now.map(|now| now / (error + apart)), WORSE)
        });
        time.into_iter().chain(error).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<Row> {
        let row = |scene: &str, method: &str, knob, seconds, error| Row {
            scene: scene.to_owned(),
            method: method.to_owned(),
            knob,
            seconds,
            error,
        };
        vec![
            row("drop-10", "inkstrand-20", 1, 1e-4, Some(0.035)),
            row("drop-10", XPBD_STEPS, 64, 2e-3, Some(0.7)),
            row("full-72x20", "inkstrand", 2, 1e-4, None),
            row("cantilever-1", "inkstrand", 20, 1e-3, Some(3e-4)),
        ]
    }

    #[test]
    fn what_is_as_stored_is_met() {
        let file = file(&rows()).unwrap();
        let mut faster_machine = rows();
        for row in &mut faster_machine {
            row.seconds *= 0.3;
        }
        let targets = compare(&faster_machine, false, &file).unwrap().targets;
        assert_eq!(targets.len(), 4);
        assert!(targets.iter().all(Target::is_met), "{targets:?}");
    }

    #[test]
    fn what_is_worse_is_missed() {
        let file = file(&rows()).unwrap();
        for (place, slower, worse) in [(0, 2.6, 1.0), (0, 1.0, 1.06), (2, 2.6, 1.0), (3, 9.0, 1.06)]
        {
            let mut rows = rows();
            rows[place].seconds *= slower;
            rows[place].error = rows[place].error.map(|error| error * worse);
            let targets = compare(&rows, false, &file).unwrap().targets;
            let missed = targets.iter().filter(|target| !target.is_met()).count();
            assert_eq!(missed, 1, "{targets:?}");
        }
    }

    #[test]
    fn what_is_stored_and_measured_no_more_is_missed() {
        let stored = file(&rows()).unwrap();
        let mut now = rows();
        now[3].scene = "cantilever-2".to_owned();
        let against = compare(&now, false, &stored).unwrap();
        let missed: Vec<&Target> = (against.targets.iter())
            .filter(|target| !target.is_met())
            .collect();
        assert_eq!(missed.len(), 1);
        assert!(missed[0].found.is_none() && missed[0].text.starts_with("cantilever-1: "));
        assert!(against.not_compared.is_empty());
        // A quick run leaves some out.
        let quick = compare(&now, true, &stored).unwrap();
        assert!(quick.targets.iter().all(Target::is_met));
    }

    #[test]
    fn other_numbers_of_threads_are_not_compared() {
        let stored = file(&rows()).unwrap();
        let mut now = rows();
        now[2].knob = 16;
        let against = compare(&now, false, &stored).unwrap();
        assert_eq!(against.not_compared, ["full-72x20: inkstrand, 2 threads"]);
        assert!(against.targets.iter().all(Target::is_met));
        // A scene that is gone is another matter, and so is another knob.
        now.remove(2);
        now[0].knob = 2;
        let against = compare(&now, false, &stored).unwrap();
        let missed = against.targets.iter().filter(|target| !target.is_met());
        assert_eq!(missed.count(), 3);
    }

    #[test]
    fn broken_figures_are_refused() {
        assert!(compare(&rows(), false, "columns\ndrop-10,inkstrand-20,1").is_err());
        assert!(compare(&rows(), false, "columns\na,b,one,1.0,2.0").is_err());
        assert!(compare(&rows(), false, "columns\ndrop-10,inkstrand-20,1,soon,2.0").is_err());
        assert!(compare(&rows()[..1], false, "columns").is_err());
    }

    #[test]
    fn the_stored_figures_are_whole() {
        let lines = STORED.lines().filter(|line| !line.starts_with('#'));
        assert!(lines.clone().count() > 30);
        assert_eq!(lines.clone().next(), Some(COLUMNS));
        assert!(compare(&rows(), true, STORED).is_ok());
    }
}
