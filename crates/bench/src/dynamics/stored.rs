//! Our figures as they were, so that worse ones are seen: errors, and times over those of a yardstick.

use super::names::{CANTILEVER, OWN, XPBD_STEPS};
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

/// A target for each error and time of a run that is stored.
///
/// # Errors
///
/// When the stored file is broken or the run has no yardstick.
pub fn against(rows: &[Row]) -> Result<Vec<Target>, BenchError> {
    compare(rows, STORED)
}

fn compare(rows: &[Row], stored: &str) -> Result<Vec<Target>, BenchError> {
    let yardstick = yardstick(rows).ok_or("there is nothing to measure times by")?;
    let mut targets = Vec::new();
    let lines = stored.lines().filter(|line| !line.starts_with('#'));
    for line in lines.skip(1) {
        let broken = || format!("broken line of stored figures: {line}");
        let parts: Vec<&str> = line.split(',').collect();
        let [scene, method, knob, time, error] = parts[..] else {
            return Err(broken().into());
        };
        let knob: usize = knob.parse().map_err(|_| broken())?;
        let is_it = |row: &&Row| row.scene == scene && row.method == method && row.knob == knob;
        let Some(row) = rows.iter().find(is_it) else {
            continue;
        };
        if !time.is_empty() {
            let time: f64 = time.parse().map_err(|_| broken())?;
            targets.push(Target {
                text: format!("{scene}: {method}, {knob}: time over the stored one"),
                found: Some(Found::Is(row.seconds / yardstick / time)),
                limit: Limit::AtMost(SLOWER),
            });
        }
        if !error.is_empty() {
            let error: f64 = error.parse().map_err(|_| broken())?;
            let apart = if scene.starts_with(CANTILEVER) {
                0.0
            } else {
                REFERENCES
            };
            targets.push(Target {
                text: format!("{scene}: {method}, {knob}: error over the stored one"),
                found: row.error.map(|now| Found::Is(now / (error + apart))),
                limit: Limit::AtMost(WORSE),
            });
        }
    }
    Ok(targets)
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
        let targets = compare(&faster_machine, &file).unwrap();
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
            let targets = compare(&rows, &file).unwrap();
            let missed = targets.iter().filter(|target| !target.is_met()).count();
            assert_eq!(missed, 1, "{targets:?}");
        }
    }

    #[test]
    fn broken_figures_are_refused() {
        assert!(compare(&rows(), "columns\ndrop-10,inkstrand-20,1").is_err());
        assert!(compare(&rows(), "columns\na,b,one,1.0,2.0").is_err());
        assert!(compare(&rows(), "columns\ndrop-10,inkstrand-20,1,soon,2.0").is_err());
        assert!(compare(&rows()[..1], "columns").is_err());
    }

    #[test]
    fn the_stored_figures_are_whole() {
        let lines = STORED.lines().filter(|line| !line.starts_with('#'));
        assert!(lines.clone().count() > 30);
        assert_eq!(lines.clone().next(), Some(COLUMNS));
        assert!(compare(&rows(), STORED).is_ok());
    }
}
