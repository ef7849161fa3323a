//! What the measured times and errors are held to.

use crate::ratios::{ERRORS, Ratio, TIMES};
use crate::results::Row;
use crate::targets::{Found, Limit, Point, Target, curve, time_at};

/// The sweep in the order by strands; its knob is samples a pixel.
pub const SWEEP: &str = "sweep";
/// The sweep in the source's order; its knob is samples a pixel.
pub const SWEEP_SHIFTED: &str = "sweep-shifted";
/// Stamping with 4 samples a pixel; its knob is stamps an interval.
pub const STAMPING_4: &str = "stamping-4";
/// Starts the names of all methods of stamping.
pub const STAMPING: &str = "stamping-";
/// Starts the names of all methods of `vello_cpu`; its knob is worker threads.
pub const VELLO: &str = "vello-";
/// Ends the names of what is only a part of a method.
pub const PATHS_ALONE: &str = "-paths";

/// A scene and the source's number of stamps an interval there.
pub type SceneStamps<'a> = (&'a str, usize);

/// What a scene's ratios of times are held to.
struct Limits {
    /// Of the sweep at 4 samples to `vello_cpu` at its fastest.
    vello: f64,
    /// Of the sweep at 4 samples to stamping with the source's stamps, and to stamping at its error.
    stamping: f64,
    stamping_at_error: f64,
    /// Where samples don't come down to the error of exact coverage: of the sweep's error at [`MOST_SAMPLES`] to that of `vello_cpu`, in place of
    /// times.
    error: Option<f64>,
}

/// What was asked of all scenes.
const ASKED: Limits = Limits {
    vello: 1.0 / 3.0,
    stamping: 0.25,
    stamping_at_error: 0.05,
    error: None,
};

/// Samples a pixel at which errors are compared.
const MOST_SAMPLES: usize = 16;

/// What a scene is held to. Where it isn't what was asked, `docs/performance.md` has the reason in numbers.
fn limits(scene: &str) -> Limits {
    match scene {
        "ponytails" => Limits {
            stamping: 1.0,
            stamping_at_error: 0.2,
            ..ASKED
        },
        "twin-tails" => Limits {
            stamping: 1.0,
            stamping_at_error: 0.1,
            ..ASKED
        },
        "curtain" => Limits {
            vello: 2.0,
            stamping: 1.0,
            stamping_at_error: 0.3,
            error: Some(1.5),
        },
        "fine-hairs" => Limits {
            vello: 1.5,
            stamping: 1.5,
            stamping_at_error: 0.4,
            error: Some(1.0),
        },
        _ => ASKED,
    }
}

/// All ratios of all scenes, and what they are held to.
#[must_use]
pub fn ratios(rows: &[Row], scenes: &[SceneStamps]) -> Vec<Ratio> {
    scenes
        .iter()
        .flat_map(|&(scene, source_stamps)| {
            let rows: Vec<&Row> = rows.iter().filter(|row| row.scene == scene).collect();
            of_scene(&rows, scene, source_stamps)
        })
        .collect()
}

fn of_scene(rows: &[&Row], scene: &str, source_stamps: usize) -> Vec<Ratio> {
    let seconds = |method: &str, knob: usize| {
        let row = rows.iter().find(|r| r.method == method && r.knob == knob);
        row.map(|row| row.seconds)
    };
    let over = |ours: Option<f64>, theirs: Option<f64>| Some(Found::Is(ours? / theirs?));
    let limits = limits(scene);
    let ratio = |name: String, text: String, found, limit: f64, asked: f64| Ratio {
        scene: scene.to_owned(),
        name,
        worse: TIMES,
        target: Target {
            text: match limit > asked {
                true => format!("{scene}: {text} ({asked:.3} was asked)"),
                false => format!("{scene}: {text}"),
            },
            found,
            limit: Limit::AtMost(limit),
        },
    };

    let vello = fastest_vello(rows);
    let best = vello.iter().map(|row| row.seconds).reduce(f64::min);
    let mut ratios = vec![ratio(
        "fastest-vello".to_owned(),
        "sweep at 4 samples / vello_cpu at its fastest".to_owned(),
        over(seconds(SWEEP, 4), best),
        limits.vello,
        ASKED.vello,
    )];
    let sweep = curve(rows, SWEEP);
    for row in vello {
        if let Some(limit) = limits.error {
            let own = rows
                .iter()
                .find(|r| r.method == SWEEP && r.knob == MOST_SAMPLES);
            let text = format!(
                "sweep at {MOST_SAMPLES} samples / {}, errors (no more time at its error was asked)",
                row.method
            );
            let name = format!("{}-errors", row.method);
            let found = over(own.and_then(|row| row.error), row.error);
            ratios.push(Ratio {
                worse: ERRORS,
                ..ratio(name, text, found, limit, limit)
            });
            continue;
        }
        let at_its_error = row.error.and_then(|error| time_at(&sweep, error));
        // Never as good as that: no time is short enough.
        let at_its_error = at_its_error.unwrap_or(f64::INFINITY);
        ratios.push(ratio(
            format!("{}-at-its-error", row.method),
            format!("sweep / {}, at its error", row.method),
            over(Some(at_its_error), Some(row.seconds)),
            1.0,
            1.0,
        ));
    }
    let ours = seconds(SWEEP_SHIFTED, 4);
    ratios.push(ratio(
        "stamping".to_owned(),
        format!("sweep at 4 samples / {source_stamps} stamps an interval at 4 samples"),
        over(ours, seconds(STAMPING_4, source_stamps)),
        limits.stamping,
        ASKED.stamping,
    ));
    ratios.push(ratio(
        "stamping-at-its-error".to_owned(),
        "sweep at 4 samples / stamping at its error".to_owned(),
        against_stamping(rows),
        limits.stamping_at_error,
        ASKED.stamping_at_error,
    ));
    ratios
}

/// For each way to use `vello_cpu` its fastest row.
fn fastest_vello<'a>(rows: &[&'a Row]) -> Vec<&'a Row> {
    let mut fastest: Vec<&Row> = Vec::new();
    for row in rows {
        if !row.method.starts_with(VELLO) || row.method.ends_with(PATHS_ALONE) {
            continue;
        }
        match fastest.iter_mut().find(|best| best.method == row.method) {
            Some(best) if row.seconds < best.seconds => *best = row,
            Some(_) => {}
            None => fastest.push(row),
        }
    }
    fastest
}

/// The sweep at 4 samples against the fastest stamping, at any number of samples from 4, whose error
/// is as small.
fn against_stamping(rows: &[&Row]) -> Option<Found> {
    let sweep = rows
        .iter()
        .find(|row| row.method == SWEEP_SHIFTED && row.knob == 4)?;
    let mut methods: Vec<&str> = rows.iter().map(|row| row.method.as_str()).collect();
    methods.retain(|method| method.starts_with(STAMPING));
    methods.sort_unstable();
    methods.dedup();
    let curves: Vec<Vec<Point>> = methods.iter().map(|method| curve(rows, method)).collect();
    let error = sweep.error?;
    let reached = curves.iter().filter_map(|curve| time_at(curve, error));
    if let Some(seconds) = reached.reduce(f64::min) {
        return Some(Found::Is(sweep.seconds / seconds));
    }
    // Each would have to go on beyond its last point.
    let last = curves.iter().filter_map(|curve| curve.last());
    let least = last.map(|point| point.seconds).reduce(f64::min)?;
    Some(Found::Below(sweep.seconds / least))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::targets::report;

    fn row(method: &str, knob: usize, seconds: f64, error: f64) -> Row {
        Row {
            scene: "s".to_owned(),
            method: method.to_owned(),
            knob,
            seconds,
            error: Some(error),
        }
    }

    /// Numbers that reach everything.
    fn good() -> Vec<Row> {
        vec![
            row("sweep", 1, 1.0, 0.16),
            row("sweep", 4, 2.0, 0.04),
            row("sweep-shifted", 4, 2.0, 0.04),
            row("vello-segments", 0, 9.0, 0.08),
            row("vello-segments", 2, 6.0, 0.08),
            row("stamping-4", 1, 4.0, 0.4),
            row("stamping-4", 10, 8.0, 0.1),
            row("stamping-4", 64, 400.0, 0.05),
            row("stamping-16", 64, 100.0, 0.05),
            row("stamping-16", 256, 400.0, 0.0125),
        ]
    }

    fn targets(rows: &[Row], scenes: &[SceneStamps]) -> Vec<Target> {
        let ratios = ratios(rows, scenes).into_iter();
        ratios.map(|ratio| ratio.target).collect()
    }

    fn found(rows: &[Row]) -> Vec<Option<Found>> {
        let targets = targets(rows, &[("s", 10)]);
        targets.iter().map(|target| target.found).collect()
    }

    fn is_close(ratio: Option<Found>, expected: f64) {
        let Some(Found::Is(ratio)) = ratio else {
            panic!("{ratio:?} is no measured ratio");
        };
        assert!((ratio - expected).abs() < 1e-9, "{ratio}, not {expected}");
    }

    #[test]
    fn ratios_of_known_numbers() {
        let found = found(&good());
        assert_eq!(found.len(), 4);
        is_close(found[0], 2.0 / 6.0);
        // Half way between 1 and 4 samples, in logarithms.
        is_close(found[1], 2f64.sqrt() / 6.0);
        is_close(found[2], 2.0 / 8.0);
        // From 0.05 to 0.0125 in 300 s of logarithms: to 0.04 it is the share ln 0.8 / ln 0.25.
        let way = 0.8f64.ln() / 0.25f64.ln();
        is_close(found[3], 2.0 / (100.0 * 4f64.powf(way)));
    }

    #[test]
    fn good_numbers_are_met() {
        let targets = targets(&good(), &[("s", 10)]);
        assert!(targets.iter().all(Target::is_met), "{}", report(&targets));
        assert!(!report(&targets).contains("MISSED"));
    }

    #[test]
    fn each_bad_number_is_missed() {
        // Which row becomes bad, by which factors of time and error, and the targets that it costs.
        let cases: [(usize, f64, f64, &[usize]); 4] = [
            (1, 1.1, 1.0, &[0]),
            (4, 0.2, 1.0, &[0, 1]),
            (2, 1.1, 1.0, &[2]),
            (8, 0.1, 0.5, &[3]),
        ];
        for (place, slower, worse, expected) in cases {
            let mut rows = good();
            rows[place].seconds *= slower;
            rows[place].error = rows[place].error.map(|error| error * worse);
            let targets = targets(&rows, &[("s", 10)]);
            let missed: Vec<usize> = (0..targets.len())
                .filter(|&target| !targets[target].is_met())
                .collect();
            assert_eq!(missed, expected, "{}", report(&targets));
            assert!(report(&targets).contains("MISSED"));
        }
    }

    #[test]
    fn where_samples_are_coarser_than_coverage_errors_are_compared() {
        let mut rows = good();
        rows.push(row("sweep", 16, 5.0, 0.12));
        for row in &mut rows {
            row.scene = "fine-hairs".to_owned();
        }
        let targets = targets(&rows, &[("fine-hairs", 10)]);
        assert_eq!(targets.len(), 4);
        is_close(targets[1].found, 0.12 / 0.08);
        assert!(!targets[1].is_met() && targets[1].text.contains("was asked"));
        assert_eq!(targets[0].limit, Limit::AtMost(1.5));
        assert!(targets[0].text.contains("(0.333 was asked)"));
    }

    #[test]
    fn an_error_that_is_never_reached() {
        let mut rows = good();
        rows[4].error = Some(1e-6);
        rows[3].error = Some(1e-6);
        assert_eq!(found(&rows)[1], Some(Found::Is(f64::INFINITY)));
        // Stamping that never gets there is slower than its last point.
        rows.retain(|row| row.knob < 256);
        assert_eq!(found(&rows)[3], Some(Found::Below(2.0 / 100.0)));
    }

    #[test]
    fn what_was_not_measured_is_missed() {
        let targets = targets(&[], &[("s", 10)]);
        assert_eq!(targets.len(), 3);
        assert!(targets.iter().all(|target| !target.is_met()));
        assert!(report(&targets).contains("not measured"));
    }

    /// What a limit is has no part in what a ratio is found again by.
    #[test]
    fn every_ratio_has_a_steady_name_of_its_own() {
        let mut rows = good();
        rows.push(row("sweep", 16, 5.0, 0.12));
        for scene in ["s", "ponytails", "twin-tails", "curtain", "fine-hairs"] {
            for row in &mut rows {
                row.scene = scene.to_owned();
            }
            let ratios = ratios(&rows, &[(scene, 10)]);
            let names: Vec<&str> = ratios.iter().map(|ratio| ratio.name.as_str()).collect();
            let of_vello = match limits(scene).error {
                Some(_) => "vello-segments-errors",
                None => "vello-segments-at-its-error",
            };
            assert_eq!(
                names,
                [
                    "fastest-vello",
                    of_vello,
                    "stamping",
                    "stamping-at-its-error"
                ]
            );
            assert!(ratios.iter().all(|ratio| ratio.scene == scene));
        }
    }
}
