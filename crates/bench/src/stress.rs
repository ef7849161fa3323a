//! Random scenes with hostile numbers, as many as there is time for: `bench stress`.
//!
//! Each is made of one seed: strands, what they are made of, how the head moves, wind, gravity, bodies, goals, what is broken.
//! In every step all must be finite and unstretched, roots in their places, and no strand may gain energy that nothing
//! gives it; what is broken must be named, and nothing else. A scene is run several times: on more threads, saved and
//! restored on the way, with its strands in another order, and without what is broken of it. The bits must be the
//! same.

pub mod case;
pub mod simulate;

use crate::BenchError;
use case::Case;
use glam::Vec3;
use hair_sim::SignedDistance;
use indicatif::ProgressBar;
use rayon::{ThreadPool, ThreadPoolBuilder};
use simulate::{How, Trace, simulate};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// What the user asks for.
#[derive(Clone, Copy, Debug)]
pub enum Which {
    /// One scene.
    One(u64),
    /// Those from a seed on, for as long as this.
    From(u64, Duration),
}

/// What came of it.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Scenes that were run.
    pub scenes: u64,
    /// Steps of strands, and those by the safe integrator.
    pub steps: usize,
    /// Of these the safe integrator's.
    pub fallbacks: usize,
    /// Particles that had a plane before another lock, step by step.
    pub meetings: usize,
    /// Strands that were set aside, as they had to be.
    pub set_aside: usize,
    /// Seeds of scenes in which something doesn't hold, and what.
    pub failures: Vec<(u64, String)>,
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let share = 100.0 * self.fallbacks as f64 / self.steps.max(1) as f64;
        write!(
            f,
            "{} scenes, {} failed; {} steps of strands, {share:.2} % by the safe integrator; locks met {} times; {} strands set aside, as they had to be",
            self.scenes,
            self.failures.len(),
            self.steps,
            self.meetings,
            self.set_aside
        )
    }
}

/// Runs scenes; after one that fails only where `goes_on`. `failed` is told of each failure at once.
///
/// # Errors
///
/// When there are no threads.
pub fn run(
    which: Which,
    goes_on: bool,
    progress: &ProgressBar,
    mut failed: impl FnMut(u64, &str),
) -> Result<Summary, BenchError> {
    let bench = Bench::new()?;
    let start = Instant::now();
    let (first, time) = match which {
        Which::One(seed) => (seed, Duration::ZERO),
        Which::From(seed, time) => (seed, time),
    };
    progress.set_length(time.as_secs().max(1));
    let mut summary = Summary::default();
    let mut seed = first;
    loop {
        progress.set_message(format!("seed {seed}"));
        match bench.scene(seed) {
            Ok(trace) => {
                summary.steps += trace.steps;
                summary.fallbacks += trace.fallbacks;
                summary.meetings += trace.meetings;
                summary.set_aside += trace.set_aside;
            }
            Err(error) => {
                let error = error.to_string();
                failed(seed, &error);
                summary.failures.push((seed, error));
            }
        }
        summary.scenes += 1;
        seed = seed.wrapping_add(1);
        progress.set_position(start.elapsed().as_secs().min(time.as_secs()));
        if start.elapsed() >= time || (!goes_on && !summary.failures.is_empty()) {
            return Ok(summary);
        }
    }
}

/// What all scenes share.
struct Bench {
    mesh: SignedDistance,
    /// By number of threads less one.
    pools: Vec<ThreadPool>,
}

impl Bench {
    fn new() -> Result<Self, BenchError> {
        let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build();
        let pools: Result<_, _> = (1..=8).map(pool).collect();
        Ok(Self {
            mesh: mesh()?,
            pools: pools.map_err(|error| error.to_string())?,
        })
    }

    /// Runs the scene of a seed in all its ways.
    fn scene(&self, seed: u64) -> Result<Trace, BenchError> {
        self.all_ways(&catch(|| Ok(Case::new(seed)))?)
    }

    /// Runs a scene in all its ways.
    fn all_ways(&self, case: &Case) -> Result<Trace, BenchError> {
        let in_order: Vec<usize> = (0..case.rest.len()).collect();
        let run = |what: &str, threads: usize, is_saved, order: &[usize], has_faults| {
            let how = How {
                order,
                is_saved,
                has_faults,
                mesh: &self.mesh,
            };
            let trace = self.pools[threads - 1].install(|| catch(|| simulate(case, &how)));
            trace.map_err(|error| format!("{what}: {error}"))
        };
        let plain = run("one thread", 1, false, &in_order, true)?;
        let what = format!(
            "{} threads, saved before frame {}",
            case.threads, case.saved
        );
        let other = run(&what, case.threads, true, &in_order, true)?;
        compare(case, &what, &plain, &other, |_| true)?;
        let what = "strands in another order";
        let other = run(what, 1, false, &case.order, true)?;
        compare(case, what, &plain, &other, |_| true)?;
        // Strands that act on each other do feel it when one is set aside.
        if !case.faults.is_empty() && !case.is_mutual() {
            let what = "without what is broken";
            let other = run(what, 1, false, &in_order, false)?;
            let is_whole = |strand| case.faults.iter().all(|f| f.strand != strand);
            compare(case, what, &plain, &other, is_whole)?;
        }
        Ok(plain)
    }
}

/// The same bits in the strands that are asked for.
fn compare(
    case: &Case,
    what: &str,
    one: &Trace,
    other: &Trace,
    asked: impl Fn(usize) -> bool,
) -> Result<(), BenchError> {
    for (frame, (one, other)) in one.bits.iter().zip(&other.bits).enumerate() {
        let differs = (0..one.len()).find(|&s| asked(s) && one[s] != other[s]);
        if let Some(strand) = differs {
            let id = case.rest.id(strand);
            return Err(format!("{what}: strand {id} differs from frame {frame} on").into());
        }
    }
    Ok(())
}

/// A panic is a failure as any other.
fn catch<T>(run: impl FnOnce() -> Result<T, BenchError>) -> Result<T, BenchError> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(format!("a panic: {}", text.unwrap_or("without a word")).into())
    })
}

/// A box with a dent, of triangles.
fn mesh() -> Result<SignedDistance, BenchError> {
    let mut points: Vec<Vec3> = Vec::new();
    for i in 0..8 {
        let side = |bit: u32| if i & bit == 0 { -0.08 } else { 0.08 };
        points.push(Vec3::new(side(1), side(2), side(4)));
    }
    points.push(Vec3::new(0.0, 0.02, 0.0));
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut wall = |[a, b, c, d]: [u32; 4]| triangles.extend([[a, b, c], [a, c, d]]);
    wall([0, 4, 6, 2]);
    wall([1, 3, 7, 5]);
    wall([0, 1, 5, 4]);
    wall([0, 2, 3, 1]);
    wall([4, 5, 7, 6]);
    triangles.extend([[2, 6, 8], [6, 7, 8], [7, 3, 8], [3, 2, 8]]);
    SignedDistance::new(&points, &triangles, 0.01).map_err(|error| error.to_string().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_is_a_scene() {
        let bench = Bench::new().unwrap();
        let [a, b, c] = [7, 7, 8].map(|seed| bench.scene(seed).unwrap().bits);
        assert_eq!(a, b);
        assert_ne!(a, c);
    }

    /// In some scenes locks do keep out of each other, in most they don't.
    #[test]
    fn locks_meet_in_some_scenes() {
        let bench = Bench::new().unwrap();
        let meetings = (0..40).map(|seed| bench.scene(seed).unwrap().meetings);
        let meet = meetings.filter(|meetings| *meetings > 0).count();
        assert!((2..20).contains(&meet), "{meet}");
    }

    /// Scenes of which one thing or another did not hold once: a pressure that stayed where nothing touched (10, 11); links
    /// that only fill a batch and yet failed (85); joints near half a turn where Newton stopped too soon (46, 75, 104, 116,
    /// 120); energy that steps brought (12, 36, 88, 461, 464); strands that slept beside others that were awake, and lost what they had (982, 1057).
    /// They are as they were then: without locks, beside which less can be asked, and nothing is recalled.
    #[test]
    fn what_failed_once_holds() {
        let bench = Bench::new().unwrap();
        for seed in [
            10, 11, 85, 46, 75, 104, 116, 120, 12, 36, 88, 461, 464, 982, 1057,
        ] {
            let mut case = Case::new(seed);
            for params in &mut case.params {
                (params.lock_radius, params.recall) = (0.0, 0.0);
            }
            let done = bench.all_ways(&case);
            assert!(done.is_ok(), "seed {seed}: {:?}", done.err());
        }
    }

    #[test]
    fn a_panic_is_a_failure() {
        let failed = catch(|| -> Result<(), BenchError> { panic!("of {}", "ours") });
        assert_eq!(failed.unwrap_err().to_string(), "a panic: of ours");
    }

    #[test]
    fn what_differs_is_named() {
        let case = Case::new(3);
        let trace = |last| Trace {
            bits: vec![vec![1; case.rest.len()], vec![last; case.rest.len()]],
            steps: 0,
            fallbacks: 0,
            meetings: 0,
            set_aside: 0,
        };
        compare(&case, "again", &trace(5), &trace(5), |_| true).unwrap();
        let error = compare(&case, "again", &trace(5), &trace(6), |_| true).unwrap_err();
        let id = case.rest.id(0);
        let expected = format!("again: strand {id} differs from frame 1 on");
        assert_eq!(error.to_string(), expected);
        compare(&case, "again", &trace(5), &trace(6), |_| false).unwrap();
    }
}
