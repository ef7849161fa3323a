//! What our strands are held to, by themselves and against others.

use super::names::{CANTILEVER, GAMMAS, MUJOCO_CHAIN, OWN, REST, SHOWN};
use crate::results::Row;
use crate::targets::{Found, Limit, Point, Target, curve, time_at};

/// Beyond this root mean square, in lengths, a fall is no fall any more, and its time says nothing.
const USELESS: f64 = 0.5;

/// All targets of what was measured; `slopes`: of scenes of falling strands, the slope of the error in the step;
/// `fallbacks`: of scenes with everything, the share of steps that needed the safe integrator.
#[must_use]
pub fn targets(rows: &[Row], slopes: &[(String, f64)], fallbacks: &[(String, f64)]) -> Vec<Target> {
    let mut targets = at_rest(rows);
    targets.extend(falling(rows, slopes));
    let mut scenes: Vec<&str> = rows.iter().map(|row| row.scene.as_str()).collect();
    scenes.retain(|scene| scene.starts_with("drop-"));
    scenes.dedup();
    for scene in scenes {
        targets.extend(against_others(rows, scene));
    }
    targets.extend(throughput(rows));
    targets.extend(fallbacks.iter().map(|(scene, share)| Target {
        text: format!("{scene}: share of steps by the safe integrator"),
        found: Some(Found::Is(*share)),
        limit: Limit::AtMost(0.01),
    }));
    targets
}

fn find<'a>(rows: &'a [Row], scene: &str, method: &str, knob: usize) -> Option<&'a Row> {
    let is_it = |row: &&Row| row.scene == scene && row.method == method && row.knob == knob;
    rows.iter().find(is_it)
}

fn at_rest(rows: &[Row]) -> Vec<Target> {
    let method = OWN.trim_end_matches('-');
    let mut targets = Vec::new();
    for gamma in GAMMAS {
        let scene = format!("{}{gamma}", CANTILEVER);
        let error = |elements| find(rows, &scene, method, elements)?.error;
        if gamma <= 100.0 {
            targets.push(Target {
                text: format!("{scene}: error of 20 elements, of the length"),
                found: error(20).map(Found::Is),
                limit: Limit::AtMost(if gamma <= 10.0 { 0.001 } else { 0.005 }),
            });
        }
        if gamma <= 10.0 {
            let slope = error(10).zip(error(40));
            targets.push(Target {
                text: format!("{scene}: slope in elements, 10 to 40"),
                found: slope.map(|(coarse, fine)| Found::Is((coarse / fine).log2() / 2.0)),
                limit: Limit::AtLeast(1.7),
            });
        }
    }
    targets
}

fn falling(rows: &[Row], slopes: &[(String, f64)]) -> Vec<Target> {
    let method = format!("{OWN}20");
    let mut targets = Vec::new();
    for (scene, knob, step, most) in [
        ("drop-10", 1, "1/24", 0.04),
        ("drop-10", 2, "1/48", 0.009),
        ("drop-100", 1, "1/24", 0.15),
        ("drop-100", 2, "1/48", 0.08),
    ] {
        let error = find(rows, scene, &method, knob).and_then(|row| row.error);
        targets.push(Target {
            text: format!("{scene}: error in steps of {step} s, of the length"),
            found: error.map(Found::Is),
            limit: Limit::AtMost(most),
        });
    }
    for (scene, slope) in slopes {
        targets.push(Target {
            text: format!("{scene}: slope in the step, 1/24 to 1/96 s"),
            found: Some(Found::Is(*slope)),
            limit: Limit::AtLeast(1.8),
        });
    }
    for (scene, strands) in [("drop-10-x72", "72 strands"), ("drop-10", "one strand")] {
        let row = find(rows, scene, &method, 1);
        targets.push(Target {
            text: format!("{scene}: ms a second and strand, steps of 1/24 s, {strands}"),
            found: row.map(|row| Found::Is(1e3 * row.seconds)),
            limit: Limit::AtMost(0.1),
        });
    }
    targets
}

/// Our time over that of every other method at its own error: the worst of its knobs. Theirs have 20 elements, ours no
/// fewer.
fn against_others(rows: &[Row], scene: &str) -> Vec<Target> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.scene == scene).collect();
    let mut methods: Vec<&str> = Vec::new();
    for row in &rows {
        if !methods.contains(&row.method.as_str()) {
            methods.push(&row.method);
        }
    }
    let (own, others): (Vec<&str>, Vec<&str>) =
        methods.iter().partition(|method| method.starts_with(OWN));
    let coarse = format!("{OWN}10");
    let own = own.iter().filter(|method| **method != coarse);
    let own: Vec<Vec<Point>> = own.map(|method| curve(&rows, method)).collect();
    let of_method = |method: &&str| Target {
        text: format!("{scene}: time / {method}, at its error"),
        found: worst(&own, &curve(&rows, method)),
        limit: Limit::AtMost(if method.starts_with(MUJOCO_CHAIN) {
            0.1
        } else {
            1.0
        }),
    };
    others.iter().map(of_method).collect()
}

/// The largest ratio of our time to theirs where they are good for something and we are as good.
fn worst(own: &[Vec<Point>], others: &[Point]) -> Option<Found> {
    let ratios = others
        .iter()
        .filter(|point| point.error <= USELESS)
        .filter_map(|point| {
            let times = own.iter().filter_map(|curve| time_at(curve, point.error));
            Some(times.reduce(f64::min)? / point.seconds)
        });
    ratios.reduce(f64::max).map(Found::Is)
}

fn throughput(rows: &[Row]) -> Vec<Target> {
    let method = OWN.trim_end_matches('-');
    let best = |scene: &str| {
        let rows = rows
            .iter()
            .filter(|r| r.scene == scene && r.method == method);
        rows.map(|row| row.seconds).reduce(f64::min)
    };
    let shown = Target {
        found: best(SHOWN).map(|s| Found::Is(1.0 / s)),
        text: format!("{SHOWN}: steps a second"),
        limit: Limit::AtLeast(120.0),
    };
    let rest = format!("{REST}72x20");
    let at_rest = Target {
        found: best(&rest).map(|s| Found::Is(1e6 * s)),
        text: format!("{rest}: microseconds a step"),
        limit: Limit::AtMost(5.0),
    };
    vec![shown, at_rest]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::targets::report;

    fn row(scene: &str, method: &str, knob: usize, seconds: f64, error: f64) -> Row {
        Row {
            scene: scene.to_owned(),
            method: method.to_owned(),
            knob,
            seconds,
            error: Some(error),
        }
    }

    /// Numbers that reach everything.
    fn good() -> Vec<Row> {
        let mut rows = Vec::new();
        for (gamma, error) in [("1", 4e-4), ("10", 8e-4), ("100", 4e-3), ("1000", 0.1)] {
            for (elements, factor) in [(10, 4.0), (20, 1.0), (40, 0.25)] {
                let scene = format!("cantilever-{gamma}");
                rows.push(row(&scene, "inkstrand", elements, 1.0, factor * error));
            }
        }
        for (scene, seconds) in [("drop-10", 1e-4), ("drop-10-x72", 4e-5)] {
            rows.push(row(scene, "inkstrand-10", 1, 0.5 * seconds, 0.036));
            rows.push(row(scene, "inkstrand-20", 1, seconds, 0.036));
            rows.push(row(scene, "inkstrand-20", 2, 2.0 * seconds, 0.008));
            rows.push(row(scene, "inkstrand-20", 4, 4.0 * seconds, 0.004));
            rows.push(row(scene, "xpbd-steps", 64, 20.0 * seconds, 0.9));
            rows.push(row(scene, "xpbd-steps", 256, 80.0 * seconds, 0.036));
            rows.push(row(scene, "mujoco-chain", 1, 10.0 * seconds, 0.25));
            rows.push(row(scene, "mujoco-chain", 256, 900.0 * seconds, 0.001));
        }
        rows.push(row("drop-100", "inkstrand-20", 1, 1e-4, 0.11));
        rows.push(row("drop-100", "inkstrand-20", 2, 2e-4, 0.05));
        rows.push(row("shown-10000x16", "inkstrand", 2, 8e-3, 0.0));
        rows.push(row("rest-72x20", "inkstrand", 1, 4e-6, 0.0));
        rows
    }

    fn all(rows: &[Row]) -> Vec<Target> {
        let named = |scene: &str, value| [(scene.to_owned(), value)];
        targets(rows, &named("drop-10", 1.9), &named("full-72x20", 0.004))
    }

    #[test]
    fn good_numbers_are_met() {
        let targets = all(&good());
        assert_eq!(
            targets.len(),
            5 + 4 + 1 + 2 + 4 + 2 + 1,
            "{}",
            report(&targets)
        );
        assert!(targets.iter().all(Target::is_met), "{}", report(&targets));
    }

    #[test]
    fn each_bad_number_is_missed() {
        // Scene, method and knob of the row that becomes bad, by which factors of time and error.
        for (scene, method, knob, slower, worse, missed) in [
            ("cantilever-10", "inkstrand", 20, 1.0, 1.3, 1),
            ("cantilever-1", "inkstrand", 40, 1.0, 2.0, 1),
            ("drop-10", "inkstrand-20", 1, 1.01, 1.0, 2),
            ("drop-10", "inkstrand-20", 2, 1.0, 1.2, 1),
            ("drop-10-x72", "xpbd-steps", 256, 0.01, 1.0, 1),
            ("drop-10-x72", "mujoco-chain", 1, 0.9, 1.0, 1),
            ("shown-10000x16", "inkstrand", 2, 1.1, 1.0, 1),
            ("rest-72x20", "inkstrand", 1, 1.3, 1.0, 1),
        ] {
            let mut rows = good();
            let is_it =
                |row: &&mut Row| row.scene == scene && row.method == method && row.knob == knob;
            let row = rows.iter_mut().find(is_it).unwrap();
            row.seconds *= slower;
            row.error = row.error.map(|error| error * worse);
            let targets = all(&rows);
            let found = targets.iter().filter(|target| !target.is_met()).count();
            assert_eq!(
                found,
                missed,
                "{scene} {method} {knob}\n{}",
                report(&targets)
            );
        }
    }

    #[test]
    fn ratios_are_those_of_useful_errors_that_both_reach() {
        let targets = all(&good());
        let found = |text: &str| {
            let target = targets.iter().find(|target| target.text.contains(text));
            target.unwrap().found
        };
        // Not its row of error 0.9, whose time is shorter.
        assert_eq!(
            found("drop-10: time / xpbd-steps"),
            Some(Found::Is(1.0 / 80.0))
        );
        // Not its row of error 0.001, which we don't reach.
        assert_eq!(found("drop-10: time / mujoco-chain"), Some(Found::Is(0.1)));
    }

    #[test]
    fn what_was_not_measured_is_missed() {
        let targets = targets(&[], &[], &[]);
        assert!(targets.iter().all(|target| !target.is_met()));
    }
}
