use glam::{DQuat, DVec3, Vec3};
use hair_sim::{Material, Natural, Params, Pose, Roots, Solver, State, Strands, Surroundings};

/// Of every strand, in m.
const RADIUS: f64 = 0.006;
const LINKS: usize = 20;
const LENGTH: f64 = 0.3;

fn params(gamma: f64, lock_radius: f64) -> Params {
    Params {
        material: Material::from_gamma(gamma, LENGTH),
        damping: 0.02,
        lock_radius,
        ..Params::default()
    }
}

/// Strands side by side in a row along the first axis, that hang from `root`.
fn row(strands: &mut Strands, count: usize, root: DVec3, along: DVec3, direction: DVec3) {
    for i in 0..count {
        let root = root + along * i as f64;
        let points: Vec<Vec3> = (0..=LINKS)
            .map(|k| (root + direction * (LENGTH * k as f64 / LINKS as f64)).as_vec3())
            .collect();
        strands.push(strands.len() as u32, &points, None).unwrap();
    }
}

/// What two links are at least apart.
fn least_apart([one, other]: [&[DVec3]; 2]) -> f64 {
    let apart = (one[0] + one[1]).distance(other[0] + other[1]);
    0.5 * (apart - one[0].distance(one[1]) - other[0].distance(other[1]))
}

/// How far two strands are apart, nearest.
fn apart_of(solver: &Solver, state: &State, one: usize, other: usize) -> f64 {
    let points = |strand| -> Vec<DVec3> { solver.points(state, strand).collect() };
    let (one, other) = (points(one), points(other));
    let mut least = f64::INFINITY;
    for link in one.windows(2) {
        for facing in other.windows(2) {
            if least_apart([link, facing]) > least {
                continue;
            }
            for i in 0..=20 {
                let at = link[0].lerp(link[1], f64::from(i) / 20.0);
                let way = facing[1] - facing[0];
                let share = ((at - facing[0]).dot(way) / way.length_squared()).clamp(0.0, 1.0);
                least = least.min((at - facing[0] - way * share).length());
            }
        }
    }
    least
}

/// How often the links of two strands have passed through each other between two states: pairs that were on one side and are on the other.
fn crossings(before: &[Vec<DVec3>], after: &[Vec<DVec3>], pairs: &[(usize, usize)]) -> usize {
    let mut count = 0;
    for &(a, b) in pairs {
        for i in 0..LINKS {
            for j in 0..LINKS {
                count += usize::from(crosses(
                    [&before[a][i..i + 2], &before[b][j..j + 2]],
                    [&after[a][i..i + 2], &after[b][j..j + 2]],
                ));
            }
        }
    }
    count
}

/// Whether two links that move evenly meet on the way.
fn crosses(before: [&[DVec3]; 2], after: [&[DVec3]; 2]) -> bool {
    let ways = (before.iter().zip(after)).map(|(before, after)| {
        let ends = before.iter().zip(after);
        let ways = ends.map(|(before, after)| before.distance(*after));
        ways.fold(0.0, f64::max)
    });
    if least_apart(before) > ways.sum() {
        return false;
    }
    let steps = 16;
    let volume = |t: f64| {
        let at = |which: usize, end: usize| before[which][end].lerp(after[which][end], t);
        let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 0), at(1, 1)];
        let normal = (b - a).cross(d - c);
        let side = normal.dot(c - a);
        // Where the lines meet as seen along the normal.
        let n2 = normal.length_squared().max(1e-30);
        let s = (c - a).cross(d - c).dot(normal) / n2;
        let u = (c - a).cross(b - a).dot(normal) / n2;
        let inside = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&u);
        (side, inside)
    };
    let mut last = volume(0.0);
    for step in 1..=steps {
        let now = volume(f64::from(step) / f64::from(steps));
        if last.0 * now.0 < 0.0 && last.1 && now.1 {
            return true;
        }
        last = now;
    }
    false
}

/// What came of driving one lock through another.
#[derive(Debug, Default)]
struct Passed {
    /// How often links passed through each other, and how near strands of both locks came, in m.
    links: usize,
    nearest: f64,
    meetings: usize,
    fallbacks: usize,
    iterations: usize,
}

/// A lock of five strands hangs, another lies in the direction `turn` (radians) across it, `ahead` of it, and is driven through its middle by
/// its roots at `speed` m/s in steps of `dt` s.
fn driven_through(speed: f64, dt: f64, (gamma, radius): (f64, f64), turn: f64) -> Passed {
    const EACH: usize = 5;
    let mut strands = Strands::new();
    row(
        &mut strands,
        EACH,
        DVec3::ZERO,
        DVec3::X * 0.008,
        DVec3::NEG_Y,
    );
    let along = DVec3::new(turn.cos(), turn.sin(), 0.0);
    let start = DVec3::new(0.016, -0.15, 0.15) - along * 0.15;
    let across = DVec3::new(-turn.sin(), turn.cos(), 0.0);
    row(&mut strands, EACH, start, across * 0.008, along);
    let (mut solver, mut state) = Solver::new(&strands, &params(gamma, radius)).unwrap();
    let pairs: Vec<(usize, usize)> = (0..EACH)
        .flat_map(|a| (EACH..2 * EACH).map(move |b| (a, b)))
        .collect();
    let mut before = shapes(&solver, &state);
    let mut passed = Passed {
        nearest: f64::INFINITY,
        ..Passed::default()
    };
    let steps = (0.35 / (speed * dt)).ceil() as usize;
    for step in 1..=steps {
        let mut poses = [Pose::IDENTITY; 2 * EACH];
        for pose in &mut poses[EACH..] {
            pose.translation.z = -speed * dt * step as f64;
        }
        let surroundings = Surroundings {
            roots: Roots::Each(&poses),
            ..Surroundings::default()
        };
        let stats = solver.step(&mut state, &surroundings, dt).unwrap();
        let after = shapes(&solver, &state);
        passed.links += crossings(&before, &after, &pairs);
        let apart = pairs.iter().map(|&(a, b)| apart_of(&solver, &state, a, b));
        passed.nearest = apart.fold(passed.nearest, f64::min);
        passed.meetings += stats.meetings;
        passed.fallbacks += stats.fallbacks;
        passed.iterations += stats.iterations;
        before = after;
    }
    passed
}

fn shapes(solver: &Solver, state: &State) -> Vec<Vec<DVec3>> {
    (0..solver.len())
        .map(|strand| solver.points(state, strand).collect())
        .collect()
}

/// In steps of 1/60 s and finer none passes; in coarser ones fewer do, and are shown.
#[test]
fn locks_do_not_pass_through_each_other() {
    for (steps, most) in [(24.0, usize::MAX), (60.0, 0), (120.0, 0)] {
        let (mut through, mut free, mut fallbacks) = (0, 0, 0);
        for gamma in [1.0, 5.0, 25.0] {
            for speed in [0.25, 0.5, 2.0] {
                for turn in [0.0, 0.4, -0.8, -1.2] {
                    let drive = |radius| driven_through(speed, 1.0 / steps, (gamma, radius), turn);
                    free += drive(0.0).links;
                    let passed = drive(RADIUS);
                    through += passed.links;
                    fallbacks += passed.fallbacks;
                    assert!(
                        passed.links <= most,
                        "Gamma {gamma}, {speed} m/s, {turn}: {passed:?}"
                    );
                }
            }
        }
        println!(
            "steps of 1/{steps} s: {through} links pass through each other where {free} do without contact; {fallbacks} steps by the safe integrator"
        );
        assert!(free > 100 && through < free / 3);
    }
}

/// So many locks side by side that hang, as many that lean towards them, and gravity that lays these on those.
fn leaning(count: usize) -> (Solver, State, Surroundings<'static>) {
    let mut strands = Strands::new();
    let beside = DVec3::Z * 0.008;
    row(&mut strands, count, DVec3::ZERO, beside, DVec3::NEG_Y);
    let lean = DVec3::new(-0.5, -1.0, 0.1).normalize();
    row(&mut strands, count, DVec3::X * 0.06, beside, lean);
    let params = Params {
        natural: Natural::Styled,
        ..params(10.0, RADIUS)
    };
    let (solver, state) = Solver::new(&strands, &params).unwrap();
    let surroundings = Surroundings {
        gravity: DVec3::new(-3.0, -9.0, 0.0),
        ..Surroundings::default()
    };
    (solver, state, surroundings)
}

/// Two locks that gravity has laid against each other sleep, and sleep on.
#[test]
fn locks_that_lean_on_each_other_sleep() {
    let (mut solver, mut state, surroundings) = leaning(1);
    let (mut slept, mut meetings) = (None, 0);
    for step in 0..60 * 60 {
        let stats = solver.step(&mut state, &surroundings, 1.0 / 60.0).unwrap();
        if stats.asleep == 2 {
            slept = Some(step);
            break;
        }
        meetings = stats.meetings;
    }
    let nearest = apart_of(&solver, &state, 0, 1);
    println!(
        "asleep after {slept:?} steps, {meetings} particles meet others, nearest {nearest:.5} m"
    );
    assert!(slept.is_some() && meetings > 0);
    assert!((nearest - 2.0 * RADIUS).abs() < 2e-5, "{nearest}");
    let before = shapes(&solver, &state);
    for _ in 0..100 {
        solver.step(&mut state, &surroundings, 1.0 / 60.0).unwrap();
    }
    assert_eq!(before, shapes(&solver, &state));
}

/// Locks that are thrown into a heap by a swing, and lie on each other, come to rest, though several press on one particle, which has one plane.
#[test]
fn a_heap_of_locks_sleeps() {
    let (mut solver, mut state, surroundings) = leaning(3);
    let mut fastest = 0.0_f64;
    let asleep = (0..30 * 60).find(|&step| {
        let stats = solver.step(&mut state, &surroundings, 1.0 / 60.0).unwrap();
        let is_asleep = stats.asleep == 6;
        assert!(step < 60 || stats.meetings > 0 || is_asleep);
        if step >= 5 * 60 {
            for speed in (0..6).flat_map(|strand| solver.velocities(&state, strand)) {
                fastest = fastest.max(speed.length());
            }
        }
        is_asleep
    });
    println!(
        "a heap of locks: asleep after {asleep:?} steps, from 5 s on {fastest:.1e} m/s at most"
    );
    assert!(asleep.is_some_and(|step| step < 20 * 60), "{asleep:?}");
    assert!(fastest < 0.03, "{fastest}");
}

/// Roots that creep, each by a pose of its own, keep awake what sleeps or has hardly moved for long, and what leans on it; then all sleep again.
#[test]
fn roots_that_creep_keep_locks_awake() {
    const DT: f64 = 1.0 / 60.0;
    const SPEED: f64 = 0.001;
    let (mut solver, mut state, scene) = leaning(3);
    let mut step = |state: &mut State, poses: &[Pose]| {
        let roots = Roots::Each(poses);
        let scene = Surroundings { roots, ..scene };
        solver.step(state, &scene, DT).unwrap().asleep
    };
    let mut poses = [Pose::IDENTITY; 6];
    let first = (0..30 * 60).find(|_| step(&mut state, &poses) == 6);
    for _ in 0..5 * 60 {
        for pose in &mut poses[..3] {
            pose.translation.x -= SPEED * DT;
        }
        assert_eq!(step(&mut state, &poses), 0);
    }
    let again = (0..30 * 60).find(|_| step(&mut state, &poses) == 6);
    println!("asleep after {first:?} steps, and {again:?} after roots have crept");
    assert!(first > Some(60) && again > Some(60), "{first:?}, {again:?}");
}

/// A lock whose root has gone round a curtain's end, and then straight back through its roots, hangs across the curtain, on its wrong side. It gets back to its own,
/// and nowhere does it pass before.
#[test]
fn neighbours_on_the_wrong_side_of_each_other_get_back() {
    for angle in [0.0, 2.0] {
        let [before, back, last] = led_around_a_curtain(DQuat::from_rotation_y(angle));
        println!(
            "turned by {angle}: the tip is {before:.4} m before the curtain, held {back:.4} m back, and {last:.4} m off at last"
        );
        assert!(before > 0.005 && back < 0.03 && last.abs() < 1e-3);
    }
}

/// How far the tip of such a lock is at the least before the curtain that it is pressed against from its own side, at the most behind its root when that goes back,
/// and from its place at last, in m; all of it turned.
fn led_around_a_curtain(turn: DQuat) -> [f64; 3] {
    const DT: f64 = 1.0 / 60.0;
    let (beside, behind) = (DVec3::X * 0.02, DVec3::Z * 0.012);
    let mut strands = Strands::new();
    row(&mut strands, 1, DVec3::ZERO, beside, DVec3::NEG_Y);
    let first = beside - behind * 6.0;
    row(&mut strands, 13, first, behind, DVec3::NEG_Y);
    let (mut solver, mut state) = Solver::new(&strands, &params(10.0, RADIUS)).unwrap();
    let mut roots = [Pose {
        rotation: turn,
        ..Pose::IDENTITY
    }; 14];
    solver.teleport(&mut state, Roots::Each(&roots)).unwrap();
    let (end, over) = (behind * 12.0, beside * 2.0);
    let way = [
        DVec3::ZERO,
        beside * 0.9, // against the curtain
        DVec3::ZERO,
        end,
        end + over,
        over,
        DVec3::ZERO,
        DVec3::ZERO,
    ];
    let (mut before, mut back) = (f64::INFINITY, 0.0_f64);
    let tip = |solver: &Solver, state: &State| {
        (turn.inverse() * solver.points(state, 0).last().unwrap()).x
    };
    for (part, ends) in way.windows(2).enumerate() {
        for step in 1..=120 {
            let place = ends[0].lerp(ends[1], f64::from(step) / 120.0);
            roots[0].translation = turn * place;
            let surroundings = Surroundings {
                roots: Roots::Each(&roots),
                ..Surroundings::default()
            };
            solver.step(&mut state, &surroundings, DT).unwrap();
            let tip = tip(&solver, &state);
            match part {
                0 => before = before.min(beside.x - tip),
                5 => back = back.max(tip - place.x),
                _ => {}
            }
        }
    }
    [before, back, tip(&solver, &state)]
}
