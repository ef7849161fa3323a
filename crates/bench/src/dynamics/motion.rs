//! Throughput: how long a step of many strands takes on a head that moves.

use super::mass_spring::Truss;
use super::names;
use super::own::Own;
use super::rods::{Apart, NEARLY_STRAIGHT, Rods, Simulation};
use super::shown::Shown;
use super::xpbd::Rod;
use crate::BenchError;
use crate::results::Row;
use crate::timing::{Effort, shortest};
use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    Collider, Mutual, Natural, Params, Pose, Profile, Roots, Shape, Solver, State, Stats, Strands,
    Surroundings, Wind,
};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::path::Path;
use std::rc::Rc;

/// In s.
const DT: f64 = 1.0 / 60.0;
/// Steps in a timed run, one right after the other: a quarter second of motion.
const STEPS: usize = 16;
/// The radius in m of the head, a ball at the origin.
const HEAD: f64 = 0.1;

/// Where the head is after `step` steps: it shakes once a second.
fn head(step: usize) -> Pose {
    let angle = 0.6 * (std::f64::consts::TAU * DT * step as f64).sin();
    Pose {
        rotation: DQuat::from_rotation_y(angle),
        translation: DVec3::ZERO,
    }
}

/// Directions from the middle of the head, evenly over its upper two thirds.
fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |i| {
        // The golden angle.
        let angle = i as f64 * 2.399_963_229_728_653;
        let up = 1.0 - 1.2 * (i as f64 + 0.5) / count as f64;
        let level = (1.0 - up * up).sqrt();
        DVec3::new(level * angle.cos(), up, level * angle.sin())
    })
}

/// Hair that is straight by nature, and soft enough to lie on the head.
fn straight() -> Params {
    Params {
        natural: Natural::Curl {
            curvature: 0.0,
            torsion: 0.0,
        },
        stiffness: Profile::constant(0.3),
        ..Params::default()
    }
}

/// Something whose steps can be timed.
pub(super) trait Moving {
    /// # Errors
    ///
    /// When the solver refuses a step, or a counter isn't what it must be.
    fn step(&mut self) -> Result<(), BenchError>;

    /// The share of strands' steps until now that needed the safe integrator, where there is one.
    fn fallback_share(&self) -> Option<f64> {
        None
    }
}

/// Strands with nothing around them.
struct Bare<S> {
    simulation: S,
    steps: usize,
}

impl<S: Simulation + Send + 'static> Bare<S> {
    fn boxed(simulation: S) -> Box<dyn Moving + Send> {
        Box::new(Self {
            simulation,
            steps: 0,
        })
    }
}

impl<S: Simulation> Moving for Bare<S> {
    fn step(&mut self) -> Result<(), BenchError> {
        self.steps += 1;
        self.simulation.step(DT, head(self.steps))
    }
}

/// Our strands in the style of hair, with the head in their way, wind, and each other.
struct Full {
    solver: Solver,
    state: State,
    steps: usize,
    strands: usize,
    links: usize,
    fallbacks: usize,
}

impl Full {
    fn new(strands: usize, links: usize, params: &Params) -> Result<Self, BenchError> {
        let mut rest = Strands::new();
        for (id, out) in directions(strands).enumerate() {
            let points: Vec<Vec3> = (0..=links)
                .map(|i| {
                    let u = i as f64 / links as f64;
                    let fall = DVec3::NEG_Y * (0.2 * u * u);
                    (out * (HEAD + 0.002 + 0.1 * u) + fall).as_vec3()
                })
                .collect();
            rest.push(id as u32, &points, None)
                .map_err(|error| error.to_string())?;
        }
        let (mut solver, mut state) =
            Solver::new(&rest, params).map_err(|error| error.to_string())?;
        // The mean distance of roots, over three fifths of a ball.
        let apart = (0.6 * 4.0 * std::f64::consts::PI * HEAD * HEAD / strands as f64).sqrt();
        let mutual = Mutual {
            reach: 2.0 * apart,
            break_at: apart,
            distance: 0.5 * apart,
            ..Mutual::default()
        };
        solver
            .interact(&mut state, &mutual)
            .map_err(|error| error.to_string())?;
        Ok(Self {
            solver,
            state,
            steps: 0,
            strands,
            links,
            fallbacks: 0,
        })
    }

    /// A step of a head that goes from one pose to another in this wind.
    fn take(&mut self, [before, now]: [Pose; 2], wind: Wind) -> Result<Stats, BenchError> {
        let ball = Shape::Sphere {
            center: DVec3::ZERO,
            radius: HEAD,
        };
        let colliders = [Collider {
            shape: ball,
            before,
            now,
            was: None,
        }];
        let scene = Surroundings {
            roots: Roots::Head(now),
            wind,
            colliders: &colliders,
            ..Surroundings::default()
        };
        let stats = self.solver.step(&mut self.state, &scene, DT);
        Ok(stats.map_err(|error| error.to_string())?)
    }

    /// What was asked for must have happened.
    fn check(&self, stats: &Stats) -> Result<(), BenchError> {
        let is_all = stats.strands == self.strands
            && stats.set_aside + stats.asleep == 0
            && stats.wind >= self.strands * self.links
            && stats.contacts > 0
            && stats.links > 0;
        if is_all {
            return Ok(());
        }
        Err(format!(
            "{} x {}, step {}: strands, wind, contacts or links are missing: {stats:?}",
            self.strands, self.links, self.steps
        )
        .into())
    }
}

impl Moving for Full {
    fn step(&mut self) -> Result<(), BenchError> {
        let (before, now) = (head(self.steps), head(self.steps + 1));
        self.steps += 1;
        let wind = Wind {
            steady: DVec3::new(0.0, 0.0, -3.0),
            gust: 2.0,
            ..Wind::default()
        };
        let stats = self.take([before, now], wind)?;
        self.fallbacks += stats.fallbacks;
        self.check(&stats)
    }

    fn fallback_share(&self) -> Option<f64> {
        Some(self.fallbacks as f64 / (self.strands * self.steps) as f64)
    }
}

/// The same strands when all has come to rest.
struct Resting(Full);

impl Resting {
    /// The most steps that it takes them.
    const PATIENCE: usize = 3600;

    fn new(strands: usize, links: usize, params: &Params) -> Result<Self, BenchError> {
        let mut resting = Self(Full::new(strands, links, params)?);
        // From a blow of wind on.
        for step in 0..Self::PATIENCE {
            let speed = if step < 10 { 3.0 } else { 0.0 };
            if resting.take(speed)?.asleep == strands {
                return Ok(resting);
            }
        }
        Err(format!("{strands} x {links} don't come to rest").into())
    }

    fn take(&mut self, speed: f64) -> Result<Stats, BenchError> {
        let wind = Wind {
            steady: DVec3::new(0.0, 0.0, -speed),
            ..Wind::default()
        };
        self.0.take([head(0); 2], wind)
    }
}

impl Moving for Resting {
    fn step(&mut self) -> Result<(), BenchError> {
        let stats = self.take(0.0)?;
        if stats.asleep == self.0.strands && stats.strands == 0 {
            return Ok(());
        }
        Err(format!("strands at rest woke up: {stats:?}").into())
    }
}

/// What was measured of strands in motion.
pub struct Measured {
    /// A row each scene, method and number of threads (the knob): seconds are those of a step of all strands.
    pub rows: Vec<Row>,
    /// Scenes with everything, and the largest share of strands' steps that needed the safe integrator.
    pub fallbacks: Vec<(String, f64)>,
}

/// Strands that move, and the threads that they move on.
struct Entry {
    scene: String,
    method: &'static str,
    pool: Rc<ThreadPool>,
    moving: Box<dyn Moving + Send>,
}

impl Entry {
    fn steps(&mut self, count: usize) -> Result<(), BenchError> {
        let moving = &mut self.moving;
        self.pool
            .install(|| (0..count).try_for_each(|_| moving.step()))
    }
}

/// Times steps: 16 of them in a row, as in a program that simulates, so that neither caches nor threads start cold in
/// each. Our strands' scenes with head, wind and other hair fail unless the counters of each timed step say that
/// there were contacts, wind and links. `root` is the project's folder, for its yardsticks.
///
/// # Errors
///
/// When a step is refused, a counter is not what it must be, or a yardstick can't be read.
pub fn measure(
    root: &Path,
    threads: usize,
    quick: bool,
    effort: Effort,
) -> Result<Measured, BenchError> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut counts = vec![1, threads];
    counts.dedup();
    for threads in counts {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = Rc::new(pool.map_err(|error| error.to_string())?);
        let mut add = |scene: &str, method, moving| {
            entries.push(Entry {
                scene: scene.to_owned(),
                method,
                pool: pool.clone(),
                moving,
            });
        };
        let own = names::OWN.trim_end_matches('-');
        for (strands, links) in [(72, 20), (10_000, 16)] {
            let rods = Rods {
                roots: directions(strands).map(|out| (out * HEAD, out)).collect(),
                drag: 2.0,
                ..Rods::level(strands, links, 10.0)
            };
            let scene = format!("{}{strands}x{links}", names::MOTION);
            add(&scene, own, Bare::boxed(Own::new(&rods)?));
            let twisting = Rods {
                curvature: NEARLY_STRAIGHT,
                ..rods.clone()
            };
            add(&scene, names::WITH_TWIST, Bare::boxed(Own::new(&twisting)?));
            if strands == 72 {
                let truss = |index| Truss::new(&rods, index);
                let trusses = Apart((0..strands).map(truss).collect::<Vec<_>>());
                add(&scene, names::MASS_SPRING, Bare::boxed(trusses));
                let rod = |index| Rod::new(&rods, index, 20);
                let rods = Apart((0..strands).map(rod).collect::<Vec<_>>());
                add(&scene, names::XPBD_SWEEPS, Bare::boxed(rods));
            }
            for (kind, params) in [("", Params::default()), (names::STRAIGHT, straight())] {
                let scene = format!("{}{kind}{strands}x{links}", names::FULL);
                add(&scene, own, Box::new(Full::new(strands, links, &params)?));
            }
            if strands == 72 {
                let scene = format!("{}{strands}x{links}", names::REST);
                let resting = Resting::new(strands, links, &Params::default())?;
                add(&scene, own, Box::new(resting));
            }
        }
        add(names::SHOWN, own, Box::new(Shown::new(root)?));
    }
    // On their way before they are timed.
    for entry in &mut entries {
        entry.steps(if quick { 10 } else { 60 })?;
    }
    let mut runs: Vec<_> = (entries.iter_mut())
        .map(|entry| || entry.steps(STEPS))
        .collect();
    let seconds = shortest(&mut runs, effort, || ())?;
    drop(runs);
    let mut measured = Measured {
        rows: Vec::new(),
        fallbacks: Vec::new(),
    };
    for (entry, seconds) in entries.into_iter().zip(seconds) {
        let scene = entry.scene;
        if let Some(share) = entry.moving.fallback_share() {
            match measured.fallbacks.iter_mut().find(|of| of.0 == scene) {
                Some(of) => of.1 = of.1.max(share),
                None => measured.fallbacks.push((scene.clone(), share)),
            }
        }
        measured.rows.push(Row {
            scene,
            method: entry.method.to_owned(),
            knob: entry.pool.current_num_threads(),
            seconds: seconds / STEPS as f64,
            error: None,
        });
    }
    Ok(measured)
}

/// What a step does in a second, beside what the arithmetic allows: sentences for a reader of the rows.
///
/// An iteration of Newton takes some 850 operations a link in double precision. At the most that AVX2 does without fused
/// multiply-add, two cores would take 9 million particle-steps a second of curved hair, 12 of straight hair.
#[must_use]
pub fn particle_steps(rows: &[Row]) -> Vec<String> {
    let of_scene = |(kind, limit): (&str, f64)| {
        let scene = format!("{}{kind}72x20", names::FULL);
        let times = rows.iter().filter(|row| row.scene == scene);
        let fastest = times.min_by(|a, b| a.seconds.total_cmp(&b.seconds))?;
        let millions = 72.0 * 20.0 * 1e-6 / fastest.seconds;
        Some(format!(
            "{scene}: {millions:.1} million particle-steps a second with {} threads; the arithmetic's limit is about {limit} with 2",
            fastest.knob
        ))
    };
    let scenes = [("", 9.0), (names::STRAIGHT, 12.0)];
    scenes.into_iter().filter_map(of_scene).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_without_contacts_is_refused() {
        let full = Full::new(8, 10, &Params::default()).unwrap();
        let good = Stats {
            strands: 8,
            wind: 80,
            contacts: 1,
            links: 1,
            ..Stats::default()
        };
        full.check(&good).unwrap();
        for bad in [
            Stats { strands: 7, ..good },
            Stats { wind: 79, ..good },
            Stats {
                contacts: 0,
                ..good
            },
            Stats {
                set_aside: 1,
                ..good
            },
        ] {
            assert!(full.check(&bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn particle_steps_are_those_of_the_fastest_row() {
        let row = |knob, seconds| Row {
            scene: "full-72x20".to_owned(),
            method: "inkstrand".to_owned(),
            knob,
            seconds,
            error: None,
        };
        let said = particle_steps(&[row(1, 1e-3), row(2, 5e-4)]);
        let expected = "full-72x20: 2.9 million particle-steps a second with 2 threads; the arithmetic's limit is about 9 with 2";
        assert_eq!(said, [expected]);
    }

    #[test]
    fn every_scene_moves() {
        let effort = Effort {
            rounds: 1,
            each: std::time::Duration::ZERO,
        };
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let Measured { rows, fallbacks } = measure(&root, 2, true, effort).unwrap();
        assert_eq!((rows.len(), fallbacks.len()), (24, 4));
        assert!(rows.iter().all(|row| row.seconds > 0.0));
        assert!(fallbacks.iter().all(|(_, share)| *share <= 1.0));
    }
}
