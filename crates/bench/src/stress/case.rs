//! A random scene with hostile numbers, all of it from one seed.

use fastrand::Rng;
use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    Acceleration, GRAVITY, Material, Mutual, Natural, Params, Pose, Profile, Shape, Strands, Wind,
};
use std::f64::consts::{PI, TAU};

/// Strands, what they are made of, and what happens to them frame by frame.
pub struct Case {
    /// Whole strands, whose links all have a length.
    pub rest: Strands,
    /// Of each strand.
    pub params: Vec<Params>,
    /// How the strands act on each other, if they do.
    pub mutual: Option<Mutual>,
    /// What happens.
    pub frames: Vec<Frame>,
    /// What is broken, on purpose.
    pub faults: Vec<Fault>,
    /// The threads of the run that must give the same bits as one of a single thread.
    pub threads: usize,
    /// The frame before which that run is saved and restored.
    pub saved: usize,
    /// The order of the strands in another such run.
    pub order: Vec<usize>,
}

/// What acts in a step.
pub struct Frame {
    /// In s.
    pub dt: f64,
    /// In m/s^2.
    pub gravity: DVec3,
    /// The motion of the air.
    pub wind: Wind,
    /// Where the head is at the end.
    pub head: Pose,
    /// Where each root is at the end, if the roots move one by one.
    pub each: Option<Vec<Pose>>,
    /// Whether the roots are put there at once before the step.
    pub teleports: bool,
    /// Bodies: what they are, and where at the start and the end.
    pub bodies: Vec<(Body, Pose, Pose)>,
    /// Places for the points of all strands.
    pub goal: Option<Vec<Vec3>>,
}

/// A body's shape.
#[derive(Clone, Copy)]
pub enum Body {
    /// A ball or a capsule.
    Plain(Shape<'static>),
    /// The mesh that all cases share.
    Mesh,
}

/// Invalid input of one strand: NaN, infinity, or a shape that it cannot have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// The strand's index.
    pub strand: usize,
    /// What is broken.
    pub what: Broken,
}

/// What can be broken of a strand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Broken {
    /// This point at rest is not finite.
    Rest(usize, f32),
    /// The strand folds back at this point at rest.
    Folds(usize),
    /// All points at rest are one.
    IsPoint,
    /// The pose of the root in this frame: not finite, or not a rotation.
    Root(usize, f64),
    /// The goal of this point in this frame is not finite.
    Goal(usize, usize, f32),
}

impl Case {
    /// The acceleration of the head at both ends of a frame, in every other case and where it isn't put elsewhere.
    #[must_use]
    pub fn acceleration(&self, index: usize) -> Option<[Acceleration; 2]> {
        let around = self.frames.get(index.checked_sub(2)?..index + 2)?;
        let is_known = self.saved.is_multiple_of(2)
            && around
                .iter()
                .all(|frame| !frame.teleports && frame.each.is_none());
        let dt = self.frames[index].dt;
        let at = |i: usize| Acceleration::between([i, i + 1, i + 2].map(|i| around[i].head), dt);
        is_known.then(|| [at(0), at(1)])
    }

    /// The case of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let rng = &mut rng;
        let rest = strands(rng);
        let count = rest.len();
        let has_goals = rng.u8(..4) == 0;
        let of_one_kind = rng.bool();
        let first = params(rng, &rest, 0, has_goals);
        let params: Vec<Params> = (0..count)
            .map(|s| {
                if of_one_kind {
                    first
                } else {
                    params(rng, &rest, s, has_goals)
                }
            })
            .collect();
        let mutual = (rng.u8(..3) == 0).then(|| mutual(rng));
        let frames = frames(rng, &rest, has_goals);
        let mut order: Vec<usize> = (0..count).collect();
        rng.shuffle(&mut order);
        let faults = if rng.u8(..3) == 0 {
            (0..rng.usize(1..4))
                .filter_map(|_| fault(rng, &rest, &params, &frames))
                .collect()
        } else {
            Vec::new()
        };
        let mut case = Self {
            threads: rng.usize(2..9),
            saved: rng.usize(..frames.len()),
            rest,
            params,
            mutual,
            frames,
            faults,
            order,
        };
        // Last, so that a seed that failed once stays its scene.
        if rng.u8(..4) == 0 {
            for params in &mut case.params {
                params.recall = one_of(rng, &[0.0, 1.0, 4.0, 1000.0]) * GRAVITY;
                params.recall_from = spread(rng, 1e-6, 1.0);
            }
        }
        if rng.u8(..4) == 0 {
            let radius = spread(rng, 1e-6, 0.1);
            for params in &mut case.params {
                params.lock_radius = radius * one_of(rng, &[0.0, 0.5, 1.0]);
            }
        }
        case
    }

    /// Whether strands act on each other: as neighbours, or as locks, of which even those that keep no distance sleep with the others.
    pub fn is_mutual(&self) -> bool {
        self.mutual.is_some() || self.params.iter().any(|params| params.lock_radius > 0.0)
    }
}

/// From `least` to `most`, each power of ten as likely as another.
fn spread(rng: &mut Rng, least: f64, most: f64) -> f64 {
    10.0_f64.powf(between(rng, least.log10(), most.log10()))
}

fn between(rng: &mut Rng, least: f64, most: f64) -> f64 {
    least + (most - least) * rng.f64()
}

fn direction(rng: &mut Rng) -> DVec3 {
    let up = between(rng, -1.0, 1.0);
    let angle = between(rng, 0.0, TAU);
    let level = (1.0 - up * up).sqrt();
    DVec3::new(level * angle.cos(), up, level * angle.sin())
}

fn rotation(rng: &mut Rng) -> DQuat {
    DQuat::from_axis_angle(direction(rng), between(rng, 0.0, TAU))
}

fn one_of<T: Copy>(rng: &mut Rng, of: &[T]) -> T {
    of[rng.usize(..of.len())]
}

/// Strands on a ball of 0.1 m: straight, curled or crooked; from a micrometre to two metres; of one to 500 points.
fn strands(rng: &mut Rng) -> Strands {
    let count = one_of(rng, &[1, 2, 7, 8, 9, 24, 60]);
    let kind = rng.u8(..4);
    let most_links = one_of(rng, &[4, 12, 24, 40]);
    let like_length = rng.bool();
    let length = spread(rng, 0.01, 1.0);
    let mut strands = Strands::new();
    let mut ids: Vec<u32> = (0..1000).collect();
    rng.shuffle(&mut ids);
    let mut last: Vec<Vec3> = Vec::new();
    for id in ids.into_iter().take(count) {
        let links = match rng.u8(..40) {
            0 => rng.usize(..3),
            1 if count < 10 => 499,
            _ => rng.usize(1..=most_links),
        };
        let length = match rng.u8(..20) {
            0 => spread(rng, 1e-6, 2.0),
            _ if like_length => length,
            _ => spread(rng, 0.01, 1.0),
        };
        // Some lie where the one before lies.
        if last.is_empty() || rng.u8(..12) != 0 {
            last = points(rng, kind, links, length);
        }
        let pushed = strands.push(id, &last, None);
        debug_assert!(pushed.is_ok());
    }
    strands
}

fn points(rng: &mut Rng, kind: u8, links: usize, length: f64) -> Vec<Vec3> {
    let out = direction(rng);
    let mut along = out;
    let mut at = out * 0.1;
    let mut points = vec![at.as_vec3()];
    let (axis, step) = (direction(rng), length / links.max(1) as f64);
    let angle = between(rng, -0.5, 0.5);
    for _ in 0..links {
        let turn = match kind {
            0 => DQuat::IDENTITY,
            1 => DQuat::from_axis_angle(axis, angle),
            2 => DQuat::from_axis_angle(direction(rng), 0.3),
            _ => DQuat::from_axis_angle(direction(rng), between(rng, 0.0, 2.5)),
        };
        along = (turn * along).normalize();
        // Crooked strands have links of any length, and none.
        let part = match (kind, rng.u8(..20)) {
            (3, 0) => 0.0,
            (3, _) => between(rng, 0.02, 2.0),
            _ => 1.0,
        };
        at += along * (step * part);
        points.push(at.as_vec3());
    }
    points
}

fn params(rng: &mut Rng, rest: &Strands, strand: usize, has_goals: bool) -> Params {
    let length: f64 = rest
        .strand(strand)
        .windows(2)
        .map(|w| f64::from(w[0].distance(w[1])))
        .sum();
    let mut material = Material::from_gamma(spread(rng, 1e-4, 1e6), length.max(1e-3));
    material.young = material.young.clamp(1e-3, 1e20);
    material.twist_ratio = spread(rng, 0.1, 10.0);
    let stiffness = match rng.u8(..4) {
        0 => Profile {
            root: spread(rng, 1e-3, 1e3),
            middle: spread(rng, 1e-3, 1e3),
            tip: spread(rng, 1e-3, 1e3),
        },
        _ => Profile::constant(1.0),
    };
    let natural = match rng.u8(..4) {
        0 => Natural::Styled,
        1 => {
            let (curvature, torsion) = (spread(rng, 1.0, 1e3), between(rng, -100.0, 100.0));
            // Some of them are straight, whatever they are styled like.
            let is_straight = curvature < 5.0;
            Natural::Curl {
                curvature: if is_straight { 0.0 } else { curvature },
                torsion: if is_straight { 0.0 } else { torsion },
            }
        }
        _ => Natural::Balanced,
    };
    let goal = match rng.u8(..4) {
        0 => Profile::constant(0.0),
        1 => Profile {
            root: 0.0,
            middle: 0.0,
            tip: spread(rng, 1.0, 1e6),
        },
        _ => Profile::constant(spread(rng, 1.0, 1e8)),
    };
    Params {
        material,
        stiffness,
        natural,
        damping: one_of(rng, &[0.0, 0.005, 0.1, 2.0]),
        drag: one_of(rng, &[0.0, 0.0, 2.0, 30.0, 1e3, 1e4]),
        drag_along: one_of(rng, &[0.0, 0.5, 1.0]),
        goal: if has_goals {
            goal
        } else {
            Profile::constant(0.0)
        },
        thickness: one_of(rng, &[0.0, 1e-3, 0.02]),
        friction: one_of(rng, &[0.0, 0.3, 5.0]),
        ..Params::default()
    }
}

fn mutual(rng: &mut Rng) -> Mutual {
    Mutual {
        neighbours: rng.usize(..6),
        link: one_of(rng, &[0.0, 40.0, 1e4, 1e6]),
        reach: spread(rng, 1e-3, 1.0),
        break_at: spread(rng, 1e-4, 1.0),
        mends: rng.bool(),
        repulsion: one_of(rng, &[0.0, 400.0, 1e6]),
        distance: spread(rng, 1e-4, 0.1),
    }
}

/// How the head moves for a while.
#[derive(Clone, Copy)]
enum Motion {
    Still,
    Nods,
    Jumps,
    Flips,
    Spins,
    Dashes,
}

/// What holds for a while.
struct Act {
    motion: Motion,
    axis: DVec3,
    gravity: u8,
    wind: u8,
    bodies: usize,
    teleports: bool,
    by_strand: bool,
}

fn act(rng: &mut Rng) -> Act {
    use Motion::{Dashes, Flips, Jumps, Nods, Spins, Still};
    Act {
        motion: one_of(
            rng,
            &[Still, Still, Still, Nods, Nods, Jumps, Flips, Spins, Dashes],
        ),
        axis: direction(rng),
        gravity: rng.u8(..8),
        wind: rng.u8(..6),
        bodies: one_of(rng, &[0, 0, 1, 1, 3]),
        teleports: rng.u8(..10) == 0,
        by_strand: rng.u8(..6) == 0,
    }
}

fn frames(rng: &mut Rng, rest: &Strands, has_goals: bool) -> Vec<Frame> {
    let dt = one_of(
        rng,
        &[
            1.0 / 240.0,
            1.0 / 120.0,
            1.0 / 60.0,
            1.0 / 24.0,
            1.0 / 24.0,
            0.2,
            1.0,
        ],
    );
    let changes_step = rng.u8(..5) == 0;
    let wind_seed = rng.u64(..);
    let mut head = Pose::IDENTITY;
    let mut frames: Vec<Frame> = Vec::new();
    for _ in 0..rng.usize(1..6) {
        let act = act(rng);
        let length = one_of(rng, &[3, 12, 24, 48]);
        let mut bodies: Vec<(Body, Pose, DVec3)> = (0..act.bodies).map(|_| body(rng)).collect();
        let start = head;
        for i in 0..length {
            let dt = if changes_step {
                spread(rng, 1.0 / 240.0, 1.0)
            } else {
                dt
            };
            head = moved(start, &act, i, dt);
            let each = act.by_strand.then(|| {
                let apart = |s: usize| Pose {
                    translation: head.translation + act.axis * (0.01 * (s % 5) as f64),
                    ..head
                };
                (0..rest.len()).map(apart).collect()
            });
            let goal = (has_goals && act.gravity > 2).then(|| {
                let turn = DQuat::from_axis_angle(act.axis, 0.02 * i as f64).as_quat();
                rest.points().iter().map(|p| turn * *p).collect()
            });
            let bodies = bodies.iter_mut().map(|(shape, pose, velocity)| {
                let before = *pose;
                pose.translation += *velocity * dt;
                (*shape, before, *pose)
            });
            frames.push(Frame {
                dt,
                gravity: gravity(&act, i),
                wind: wind(&act, i, wind_seed),
                head,
                each,
                teleports: act.teleports && i == 0,
                bodies: bodies.collect(),
                goal,
            });
        }
    }
    frames
}

fn moved(start: Pose, act: &Act, frame: usize, dt: f64) -> Pose {
    let t = (frame + 1) as f64;
    let turned = |angle: f64| Pose {
        rotation: (DQuat::from_axis_angle(act.axis, angle) * start.rotation).normalize(),
        ..start
    };
    let shifted = |by: DVec3| Pose {
        translation: start.translation + by,
        ..start
    };
    match act.motion {
        Motion::Still => start,
        Motion::Nods => turned(0.5 * (0.4 * t).sin()),
        Motion::Jumps => shifted(act.axis * if frame % 8 < 4 { 100.0 } else { 0.0 }),
        Motion::Flips => turned(if frame % 6 < 3 { PI } else { 0.0 }),
        Motion::Spins => turned(50.0 * t * dt),
        Motion::Dashes => shifted(act.axis * (10.0 * dt * t.min(20.0))),
    }
}

fn gravity(act: &Act, frame: usize) -> DVec3 {
    let usual = DVec3::NEG_Y * GRAVITY;
    match act.gravity {
        0 => DVec3::ZERO,
        1 => usual * if frame.is_multiple_of(2) { 1.0 } else { -1.0 },
        2 => usual * 100.0,
        3 => act.axis * GRAVITY,
        _ => usual,
    }
}

fn wind(act: &Act, frame: usize, seed: u64) -> Wind {
    let t = 2.4 * frame as f64;
    let (steady, gust) = match act.wind {
        0 => (DVec3::new(t.cos(), (1.7 * t).sin(), t.sin()) * 100.0, 50.0),
        1 => (act.axis * 3.0, 2.0),
        2 => (act.axis * 3.0, 0.0),
        _ => (DVec3::ZERO, 0.0),
    };
    Wind {
        steady,
        gust,
        seed,
        ..Wind::default()
    }
}

/// A body, where it starts, and its velocity: around the roots, beside the strands, or on its way through them at
/// 20 m/s.
fn body(rng: &mut Rng) -> (Body, Pose, DVec3) {
    let radius = spread(rng, 0.01, 0.5);
    let shape = match rng.u8(..4) {
        0 => Body::Mesh,
        1 => Body::Plain(Shape::Capsule {
            from: direction(rng) * 0.2,
            to: direction(rng) * 0.2,
            radius: 0.2 * radius,
        }),
        _ => Body::Plain(Shape::Sphere {
            center: DVec3::ZERO,
            radius,
        }),
    };
    let way = direction(rng);
    let (translation, velocity) = match rng.u8(..4) {
        0 => (DVec3::ZERO, DVec3::ZERO),
        1 => (way * 0.2, DVec3::ZERO),
        2 => (way * -3.0, way * 20.0),
        _ => (way * 0.3, direction(rng) * 0.5),
    };
    let pose = Pose {
        rotation: rotation(rng),
        translation,
    };
    (shape, pose, velocity)
}

/// A fault on a strand that has what it breaks.
fn fault(rng: &mut Rng, rest: &Strands, params: &[Params], frames: &[Frame]) -> Option<Fault> {
    let strand = rng.usize(..rest.len());
    let count = rest.strand(strand).len();
    let point = rng.usize(..count);
    let frame = rng.usize(..frames.len());
    let not_finite = one_of(rng, &[f64::NAN, f64::INFINITY, f64::NEG_INFINITY]);
    let what = match rng.u8(..5) {
        0 => Broken::Rest(point, not_finite as f32),
        1 if count > 2 => {
            let point = rng.usize(1..count - 1);
            // A link without a length, as rounding makes some, has no direction to fold back.
            let points = rest.strand(strand);
            if points[point] == points[point - 1] {
                return None;
            }
            Broken::Folds(point)
        }
        2 if count > 1 => Broken::IsPoint,
        3 if frames[frame].goal.is_some() && point > 0 => {
            // Where nothing pulls, nothing is broken.
            let pulls = params[strand].goal == Profile::constant(params[strand].goal.root)
                && params[strand].goal.root > 0.0;
            if !pulls {
                return None;
            }
            Broken::Goal(frame, point, not_finite as f32)
        }
        _ if frames[frame].each.is_some() => Broken::Root(frame, not_finite),
        _ => return None,
    };
    Some(Fault { strand, what })
}
