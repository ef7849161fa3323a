//! What a step works with is in the solver's own scratch: once everything has happened that will, it allocates nothing.
#![allow(clippy::print_stdout, reason = "tests show the figures that they hold")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    Anchor, Collider, Mutual, Params, Pose, Profile, Roots, Shape, Solver, State, Strands,
    Surroundings, Wind,
};

/// The system's allocator, counting.
struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call goes on to the system's allocator as it came.
#[allow(
    unsafe_code,
    reason = "an allocator can be written in no other way; this one is in no program, only in this test"
)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Relaxed);
        // SAFETY: the caller's promises are those that it asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Relaxed);
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Strands of different lengths on a ball.
fn style(count: u32) -> Strands {
    let mut strands = Strands::new();
    for s in 0..count {
        let angle = s as f32 * 2.399_963;
        let up = 1.0 - 1.2 * (s as f32 + 0.5) / count as f32;
        let level = (1.0 - up * up).sqrt();
        let out = Vec3::new(level * angle.cos(), up, level * angle.sin());
        let links = 10 + s % 12;
        let points: Vec<Vec3> = (0..=links)
            .map(|i| {
                let u = i as f32 / links as f32;
                out * (0.102 + 0.1 * u) + Vec3::NEG_Y * (0.2 * u * u)
            })
            .collect();
        strands.push(s, &points, None).unwrap();
    }
    strands
}

/// What happened in some steps.
#[derive(Default)]
struct Happened {
    contacts: usize,
    wind: usize,
    links: usize,
    repulsions: usize,
    meetings: usize,
    fallbacks: usize,
}

/// A head that shakes, and now and then turns so fast that strands need the safe integrator.
fn head(step: usize) -> Pose {
    let angle = if step % 50 < 4 {
        2.0 * (step % 50) as f64
    } else {
        0.6 * (0.3 * step as f64).sin()
    };
    Pose {
        rotation: DQuat::from_rotation_y(angle),
        translation: DVec3::ZERO,
    }
}

fn run(
    solver: &mut Solver,
    state: &mut State,
    (goal, holds): (&[Vec3], bool),
    steps: std::ops::Range<usize>,
) -> Happened {
    let mut happened = Happened::default();
    for step in steps {
        let ball = |center: DVec3, radius: f64| Collider {
            shape: Shape::Sphere { center, radius },
            before: head(step),
            now: head(step + 1),
            was: None,
        };
        // The second one presses hair against the first.
        let colliders = [
            ball(DVec3::ZERO, 0.1),
            ball(DVec3::new(0.13, 0.0, 0.0), 0.03),
        ];
        // Many, as a sort of a few needs no memory.
        let anchors: [Anchor; 32] = std::array::from_fn(|i| Anchor {
            strand: 31 - i,
            point: 9,
            stiffness: 2000.0,
            places: [DVec3::new(0.0, -0.1, 0.2); 2],
            follows: false,
        });
        let surroundings = Surroundings {
            roots: Roots::Head(head(step + 1)),
            wind: Wind {
                steady: DVec3::new(2.0, 0.0, -3.0),
                gust: 3.0,
                ..Wind::default()
            },
            colliders: &colliders,
            goal: Some(goal),
            anchors: if holds { &anchors } else { &[] },
            ..Surroundings::default()
        };
        let stats = solver.step(state, &surroundings, 1.0 / 24.0).unwrap();
        happened.contacts += stats.contacts;
        happened.wind += stats.wind;
        happened.links += stats.links;
        happened.repulsions += stats.repulsions;
        happened.meetings += stats.meetings;
        happened.fallbacks += stats.fallbacks;
    }
    happened
}

/// The allocations in [`STEPS`] steps, after a warm-up of 60.
fn allocations(strands: u32, threads: usize, lock_radius: f64) -> usize {
    let rest = style(strands);
    let goal = rest.points().to_vec();
    let params = Params {
        goal: Profile::constant(5.0),
        lock_radius,
        ..Params::default()
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    // From inside: handing work to a pool from outside allocates in the pool's own queue, about once in 30 steps.
    pool.build().unwrap().install(|| {
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let mutual = Mutual {
            reach: 0.05,
            distance: 0.05,
            ..Mutual::default()
        };
        solver.interact(&mut state, &mutual).unwrap();
        let goal = (&goal[..], lock_radius == 0.0);
        run(&mut solver, &mut state, goal, 0..60);
        let before = ALLOCATIONS.load(Relaxed);
        let happened = run(&mut solver, &mut state, goal, 60..60 + STEPS);
        let count = ALLOCATIONS.load(Relaxed) - before;
        // The count means nothing unless all was there.
        assert!(happened.contacts > 1000 && happened.wind > 1000);
        assert!(happened.links > 1000 && happened.repulsions > 1000);
        assert!((lock_radius == 0.0 || happened.meetings > 1000) && happened.fallbacks > 0);
        count
    })
}

const STEPS: usize = 100;

// One test: the count is that of the whole process.
#[test]
fn a_warm_step_allocates_nothing() {
    // More than 64 batches are followed by several tasks.
    let free = [(40, 1), (160, 1), (40, 2), (160, 4), (600, 4)].map(|(s, t)| (s, t, 0.0));
    let locks = [(40, 1, 0.004), (40, 2, 0.004)];
    for (strands, threads, lock_radius) in free.into_iter().chain(locks) {
        let count = allocations(strands, threads, lock_radius);
        println!(
            "{strands} strands, {threads} threads, locks of {lock_radius} m: {count} allocations in {STEPS} steps"
        );
        assert_eq!(count, 0, "{strands} strands, {threads} threads");
    }
}
