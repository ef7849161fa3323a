//! Times that can be compared: of runs that take turns.

use std::time::{Duration, Instant};

/// How long to measure.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Times that everything gets its turn, at most.
    pub rounds: usize,
    /// What has used up this much gets no more turns.
    pub each: Duration,
}

/// Runs in a turn: the caches belong to the others when a turn begins, so the first run of a turn is
/// not counted, unless it is so slow that this cannot matter. The first run of all never is: it makes what
/// the others find made.
const TURN: usize = 3;

/// The median time of each of `runs`, in seconds. The runs take turns.
///
/// # Errors
///
/// The first error of a run.
pub fn medians<R, E>(runs: &mut [R], effort: Effort, done: impl FnMut()) -> Result<Vec<f64>, E>
where
    R: FnMut() -> Result<(), E>,
{
    Ok(turns(runs, effort, done)?.into_iter().map(median).collect())
}

/// The shortest time of each of `runs`, in seconds. The runs take turns.
///
/// # Errors
///
/// The first error of a run.
pub fn shortest<R, E>(runs: &mut [R], effort: Effort, done: impl FnMut()) -> Result<Vec<f64>, E>
where
    R: FnMut() -> Result<(), E>,
{
    let least = |times: Vec<f64>| times.into_iter().fold(f64::INFINITY, f64::min);
    Ok(turns(runs, effort, done)?.into_iter().map(least).collect())
}

/// The times of each of `runs`, in seconds. They take turns, so that whatever else the machine
/// does meets all of them alike. `done` is called after each turn.
///
/// # Errors
///
/// The first error of a run.
fn turns<R, E>(runs: &mut [R], effort: Effort, mut done: impl FnMut()) -> Result<Vec<Vec<f64>>, E>
where
    R: FnMut() -> Result<(), E>,
{
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); runs.len()];
    for _ in 0..effort.rounds.max(1) {
        for (run, times) in runs.iter_mut().zip(&mut times) {
            if times.iter().sum::<f64>() < effort.each.as_secs_f64() {
                for turn in 0..TURN {
                    let is_first_of_all = turn == 0 && times.is_empty();
                    let start = Instant::now();
                    run()?;
                    let seconds = start.elapsed().as_secs_f64();
                    // What is this slow is not slow for its caches.
                    let is_slow = !is_first_of_all && 2.0 * seconds > effort.each.as_secs_f64();
                    if turn > 0 || is_slow {
                        times.push(seconds);
                    }
                    if is_slow {
                        break;
                    }
                }
            }
            done();
        }
    }
    Ok(times)
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    let middle = times.len() / 2;
    if times.len() % 2 == 1 {
        times[middle]
    } else {
        0.5 * (times[middle - 1] + times[middle])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_odd_and_even_numbers() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 9.0]), 3.0);
    }

    #[test]
    fn runs_take_turns_and_all_are_timed() {
        let order = std::cell::RefCell::new(String::new());
        let run = |name: char| {
            let order = &order;
            move || {
                order.borrow_mut().push(name);
                Ok::<(), ()>(())
            }
        };
        let effort = Effort {
            rounds: 2,
            each: Duration::from_secs(100),
        };
        let mut turns = 0;
        let times = medians(&mut [run('a'), run('b')], effort, || turns += 1).unwrap();
        assert_eq!(*order.borrow(), "aaabbbaaabbb");
        assert_eq!((times.len(), turns), (2, 4));
        assert!(times.iter().all(|seconds| (0.0..1.0).contains(seconds)));
    }

    #[test]
    fn what_is_slow_gets_one_run_that_counts() {
        let mut count = 0;
        let effort = Effort {
            rounds: 9,
            each: Duration::from_micros(1),
        };
        let run = || {
            count += 1;
            std::thread::sleep(Duration::from_millis(1));
            Ok::<(), ()>(())
        };
        let times = turns(&mut [run], effort, || ()).unwrap();
        assert!(times[0].len() == 1 && times[0][0] >= 1e-3, "{times:?}");
        assert_eq!(count, 2);
    }

    #[test]
    fn the_first_run_of_all_never_counts() {
        let effort = Effort {
            rounds: 1,
            each: Duration::from_millis(300),
        };
        let mut count = 0;
        let run = || {
            count += 1;
            std::thread::sleep(Duration::from_millis(if count == 1 { 200 } else { 1 }));
            Ok::<(), ()>(())
        };
        let times = turns(&mut [run], effort, || ()).unwrap();
        assert_eq!(times[0].len(), 2);
        assert!(times[0].iter().all(|seconds| *seconds < 0.2), "{times:?}");
    }

    #[test]
    fn the_shortest_is_no_longer_than_the_median() {
        let effort = Effort {
            rounds: 5,
            each: Duration::from_secs(1),
        };
        let mut turn = 0;
        let run = || {
            turn += 1;
            std::thread::sleep(Duration::from_millis(if turn % 5 == 0 { 1 } else { 20 }));
            Ok::<(), ()>(())
        };
        let least = shortest(&mut [run], effort, || ()).unwrap()[0];
        assert!((1e-3..20e-3).contains(&least), "{least}");
    }

    #[test]
    fn a_failure_ends_it() {
        let effort = Effort {
            rounds: 1,
            each: Duration::from_secs(1),
        };
        assert_eq!(
            medians(&mut [|| Err("broken")], effort, || ()),
            Err("broken")
        );
    }
}
