//! A case's way from start to end, and what must hold in every step.

use super::case::{Body, Broken, Case, Frame};
use crate::BenchError;
use glam::{DVec3, Vec3};
use hair_sim::{
    Collider, DynamicsError, GRAVITY, Params, Pose, Reason, Roots, Shape, SignedDistance, Solver,
    State, Stats, Strands, Surroundings, Wind,
};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// A link is as long as at rest, but for this part of it.
const STRETCH: f64 = 1e-4;
/// Energy that may appear where nothing drives, over what the strand has and what lifting it by its length takes.
const GAIN: f64 = 1e-3;

/// How a case is run.
pub struct How<'a> {
    /// The strands' order in the solver's list.
    pub order: &'a [usize],
    /// Whether the state is saved and restored on the way, into another solver.
    pub is_saved: bool,
    /// Whether what is broken of the case is broken here.
    pub has_faults: bool,
    /// Shared by all cases.
    pub mesh: &'a SignedDistance,
}

/// What became of a case.
pub struct Trace {
    /// A hash of each strand's points and frames, by its place in the case, after each frame.
    pub bits: Vec<Vec<u64>>,
    /// Sums over all steps.
    pub steps: usize,
    /// Steps of strands that took the safe integrator.
    pub fallbacks: usize,
    /// Particles that had a plane before another lock, step by step.
    pub meetings: usize,
    /// Strands that are set aside at the end.
    pub set_aside: usize,
}

struct Run<'a> {
    case: &'a Case,
    how: &'a How<'a>,
    /// The strands as the solver has them, in its order; what is broken is broken.
    rest: Strands,
    solver: Solver,
    state: State,
    /// By place in the solver: the strands that must be set aside.
    aside: Vec<bool>,
    /// Energy of each strand when it was driven last, and what that is measured by.
    ceiling: Vec<(f64, f64)>,
}

/// Runs a case, and checks every step.
///
/// # Errors
///
/// What doesn't hold.
pub fn simulate(case: &Case, how: &How) -> Result<Trace, BenchError> {
    let mut run = Run::new(case, how)?;
    let mut trace = Trace {
        bits: Vec::with_capacity(case.frames.len()),
        steps: 0,
        fallbacks: 0,
        meetings: 0,
        set_aside: 0,
    };
    for (index, frame) in case.frames.iter().enumerate() {
        let at = |error: BenchError| format!("frame {index}: {error}");
        if how.is_saved && index == case.saved {
            run.save_and_restore().map_err(at)?;
        }
        let stats = run.step(index, frame).map_err(at)?;
        run.check(index, frame).map_err(at)?;
        trace.steps += stats.strands;
        trace.fallbacks += stats.fallbacks;
        trace.meetings += stats.meetings;
        trace.bits.push(run.bits());
    }
    trace.set_aside = run.aside.iter().filter(|aside| **aside).count();
    Ok(trace)
}

impl<'a> Run<'a> {
    fn new(case: &'a Case, how: &'a How) -> Result<Self, BenchError> {
        let mut rest = case.rest.select(how.order);
        if how.has_faults {
            break_rest(&mut rest, case, how.order);
        }
        let (mut solver, mut state) = make(&rest, case, how)?;
        let mut aside = vec![false; rest.len()];
        for fault in solver.faults(&state) {
            let place = (0..rest.len()).find(|s| rest.id(*s) == fault.id);
            let place = place.ok_or_else(|| format!("{fault}: there is no such strand"))?;
            if !is_deserved(rest.strand(place), fault.reason) {
                return Err(format!("at the start: {fault}").into());
            }
            aside[place] = true;
        }
        if let Some(mutual) = &case.mutual {
            let done = solver.interact(&mut state, mutual);
            done.map_err(|error| error.to_string())?;
        }
        for (place, &strand) in how.order.iter().enumerate() {
            let broken =
                |what| matches!(what, Broken::Rest(..) | Broken::Folds(_) | Broken::IsPoint);
            let faults = case
                .faults
                .iter()
                .filter(|f| how.has_faults && f.strand == strand);
            if faults.clone().any(|f| broken(f.what)) && !aside[place] {
                return Err(
                    format!("strand {} is broken and nobody says so", rest.id(place)).into(),
                );
            }
        }
        Ok(Self {
            ceiling: vec![(f64::INFINITY, 0.0); rest.len()],
            case,
            how,
            rest,
            solver,
            state,
            aside,
        })
    }

    /// Goes on with another solver and a state that was text in between.
    fn save_and_restore(&mut self) -> Result<(), BenchError> {
        let saved = serde_json::to_string(&self.state).map_err(|error| error.to_string())?;
        let restored = serde_json::from_str(&saved);
        self.state = restored.map_err(|error| format!("the saved state can't be read: {error}"))?;
        let (mut solver, mut start) = make(&self.rest, self.case, self.how)?;
        if let Some(mutual) = &self.case.mutual {
            let done = solver.interact(&mut start, mutual);
            done.map_err(|error| error.to_string())?;
        }
        self.solver = solver;
        Ok(())
    }

    fn step(&mut self, index: usize, frame: &Frame) -> Result<Stats, BenchError> {
        let mut each = frame.each.as_ref().map(|poses| {
            let of = |&strand: &usize| poses[strand];
            self.how.order.iter().map(of).collect::<Vec<Pose>>()
        });
        let mut goal = frame.goal.as_ref().map(|goal| {
            let of = |&strand: &usize| goal[self.case.rest.point_range(strand)].iter().copied();
            self.how.order.iter().flat_map(of).collect::<Vec<Vec3>>()
        });
        self.break_frame(index, each.as_deref_mut(), goal.as_deref_mut());
        let colliders: Vec<Collider> = (frame.bodies.iter())
            .map(|&(body, before, now)| Collider {
                shape: match body {
                    Body::Plain(shape) => shape,
                    Body::Mesh => Shape::Grid(self.how.mesh),
                },
                before,
                now,
                was: None,
            })
            .collect();
        let scene = Surroundings {
            roots: each.as_deref().map_or(Roots::Head(frame.head), Roots::Each),
            acceleration: self.case.acceleration(index),
            gravity: frame.gravity,
            wind: frame.wind,
            wind_before: None,
            streams: &[],
            colliders: &colliders,
            of_one_figure: 0,
            goal: goal.as_deref(),
            anchors: &[],
        };
        if index.is_multiple_of(8) {
            self.refuse(index, &scene, frame.dt)?;
        }
        if frame.teleports {
            let done = self.solver.teleport(&mut self.state, scene.roots);
            done.map_err(|error| error.to_string())?;
        }
        let stats = self.solver.step(&mut self.state, &scene, frame.dt);
        stats.map_err(|error| error.to_string().into())
    }

    /// Breaks the numbers of this frame that are to be broken.
    fn break_frame(&mut self, index: usize, each: Option<&mut [Pose]>, goal: Option<&mut [Vec3]>) {
        let (mut each, mut goal) = (each, goal);
        for fault in self.case.faults.iter().filter(|_| self.how.has_faults) {
            let place = self.how.order.iter().position(|s| *s == fault.strand);
            let place = place.unwrap_or_default();
            match (fault.what, &mut each, &mut goal) {
                (Broken::Root(frame, not_finite), Some(each), _) if frame == index => {
                    each[place].translation.y = not_finite;
                    self.aside[place] = true;
                }
                (Broken::Goal(frame, point, not_finite), _, Some(goal)) if frame == index => {
                    goal[self.rest.point_range(place).start + point].x = not_finite;
                    self.aside[place] = true;
                }
                _ => {}
            }
        }
    }

    /// A scene that can't be is refused and changes nothing.
    fn refuse(&mut self, index: usize, scene: &Surroundings, dt: f64) -> Result<(), BenchError> {
        let nan = DVec3::new(0.0, f64::NAN, 0.0);
        let (mut bad, mut bad_dt) = (*scene, dt);
        let body = [Collider::fixed(
            Shape::Sphere {
                center: nan,
                radius: 0.1,
            },
            Pose::IDENTITY,
        )];
        match index / 8 % 6 {
            0 => bad.gravity = nan,
            1 => {
                bad.wind = Wind {
                    steady: nan,
                    ..bad.wind
                }
            }
            2 => bad.colliders = &body,
            3 => {
                bad.goal = Some(&[Vec3::ZERO; 3][..usize::from(self.rest.points().len() != 1) * 3])
            }
            4 => bad_dt = [0.0, -1.0, f64::NAN, f64::INFINITY, 11.0][index % 5],
            _ => bad.roots = Roots::Each(&[]),
        }
        let before = self.state.clone();
        let points = self.rest.points().len();
        let fits = index / 8 % 6 == 3 && points == bad.goal.map_or(points, <[Vec3]>::len);
        if fits {
            return Ok(());
        }
        match self.solver.step(&mut self.state, &bad, bad_dt) {
            Err(
                DynamicsError::Surroundings(_)
                | DynamicsError::Step(_)
                | DynamicsError::Goal { .. }
                | DynamicsError::Poses { .. },
            ) if self.state == before => Ok(()),
            other => Err(format!("a broken scene was not refused as it must be: {other:?}").into()),
        }
    }

    /// What must hold after every step.
    fn check(&mut self, index: usize, frame: &Frame) -> Result<(), BenchError> {
        let faults = self.solver.faults(&self.state);
        for place in 0..self.rest.len() {
            let id = self.rest.id(place);
            let fault = faults.iter().find(|f| f.id == id);
            match (fault, self.aside[place]) {
                (Some(fault), false) => return Err(fault.to_string().into()),
                (None, true) => {
                    return Err(format!("strand {id} is broken and nobody says so").into());
                }
                _ => {}
            }
            self.check_shape(place, frame)
                .map_err(|error| format!("strand {id} {error}"))?;
            if !self.aside[place] {
                self.check_energy(place, index)
                    .map_err(|error| format!("strand {id} {error}"))?;
            }
        }
        Ok(())
    }

    fn check_shape(&self, place: usize, frame: &Frame) -> Result<(), BenchError> {
        let points: Vec<DVec3> = self.solver.points(&self.state, place).collect();
        if !points.iter().all(|p| p.is_finite()) {
            return Err("is not finite".into());
        }
        if !self
            .solver
            .velocities(&self.state, place)
            .all(|v| v.is_finite())
        {
            return Err("has no finite velocity".into());
        }
        let mut frames = self.solver.frames(&self.state, place);
        if !frames.all(|f| (f.length() - 1.0).abs() < 1e-9) {
            return Err("has a frame that is not a rotation".into());
        }
        if self.aside[place] {
            return Ok(());
        }
        let styled: Vec<DVec3> = self
            .rest
            .strand(place)
            .iter()
            .map(|p| p.as_dvec3())
            .collect();
        let head = match &frame.each {
            Some(each) => each[self.how.order[place]],
            None => frame.head,
        };
        let root = head.rotation * styled[0] + head.translation;
        if (points[0] - root).length() > 1e-12 * (1.0 + root.length()) {
            return Err(format!("left its root at {root}: it is at {}", points[0]).into());
        }
        let total: f64 = styled.windows(2).map(|w| w[0].distance(w[1])).sum();
        for (now, styled) in points.windows(2).zip(styled.windows(2)) {
            let length = styled[0].distance(styled[1]);
            let error = (now[0].distance(now[1]) - length).abs();
            if error > STRETCH * length + 1e-13 * (total + points[0].length()) {
                return Err(format!("stretches: a link of {length:e} m by {error:e} m").into());
            }
        }
        Ok(())
    }

    /// Where nothing drives a strand its energy doesn't rise.
    fn check_energy(&mut self, place: usize, index: usize) -> Result<(), BenchError> {
        let frame = &self.case.frames[index];
        let strand = self.how.order[place];
        let params = &self.case.params[strand];
        let energy = self.solver.energy(&self.state, place, frame.gravity);
        // Two frames back: a root that stops is braked in the step after.
        let before = index.checked_sub(2).map(|i| &self.case.frames[i..index]);
        // Where the head's acceleration is known, one that starts in the next frame acts at the end of this one.
        let next = self
            .case
            .frames
            .get(index + 1)
            .filter(|n| n.head != frame.head);
        let driven = next.is_some()
            || before.is_none_or(|before| {
                before
                    .iter()
                    .any(|b| drives(self.case, params, b, frame, strand))
            });
        if driven {
            let length: f64 = (self.rest.strand(place).windows(2))
                .map(|w| f64::from(w[0].distance(w[1])))
                .sum();
            let own = self.solver.energy(&self.state, place, DVec3::ZERO);
            let pull = frame.gravity.length().max(GRAVITY);
            self.ceiling[place] = (energy, own + pull * length * length);
        }
        let (ceiling, scale) = self.ceiling[place];
        if energy <= ceiling + GAIN * scale {
            return Ok(());
        }
        let gain = (energy - ceiling) / scale;
        Err(format!("gains energy that nothing gives it: {gain:.1e} of its own").into())
    }

    /// A hash a strand, by its place in the case.
    fn bits(&self) -> Vec<u64> {
        let mut bits = vec![0; self.rest.len()];
        for (place, &strand) in self.how.order.iter().enumerate() {
            let mut hasher = DefaultHasher::new();
            for v in (self.solver.points(&self.state, place))
                .chain(self.solver.velocities(&self.state, place))
            {
                v.to_array().map(f64::to_bits).hash(&mut hasher);
            }
            for f in self.solver.frames(&self.state, place) {
                f.to_array().map(f64::to_bits).hash(&mut hasher);
            }
            bits[strand] = hasher.finish();
        }
        bits
    }
}

/// Whether something gives energy to a strand from `before` to `now`.
fn drives(case: &Case, params: &Params, before: &Frame, now: &Frame, strand: usize) -> bool {
    let root = |f: &Frame| f.each.as_ref().map_or(f.head, |each| each[strand]);
    let blows = |f: &Frame| f.wind.gust != 0.0 || f.wind.steady != DVec3::ZERO;
    let goal = params.goal;
    case.is_mutual()
        || goal.root + goal.middle + goal.tip + params.recall > 0.0
        || root(before) != root(now)
        || before.gravity != now.gravity
        || params.drag > 0.0 && (blows(before) || blows(now))
        || !(before.bodies.is_empty() && now.bodies.is_empty())
        || before.teleports
        || now.teleports
}

fn make(rest: &Strands, case: &Case, how: &How) -> Result<(Solver, State), BenchError> {
    let made = Solver::with(rest, |place| case.params[how.order[place]]);
    made.map_err(|error| error.to_string().into())
}

/// Breaks the shapes at rest that are to be broken.
fn break_rest(rest: &mut Strands, case: &Case, order: &[usize]) {
    for fault in &case.faults {
        let place = order.iter().position(|s| *s == fault.strand);
        let range = rest.point_range(place.unwrap_or_default());
        let points = &mut rest.points_mut()[range];
        match fault.what {
            Broken::Rest(point, not_finite) => points[point].z = not_finite,
            Broken::Folds(point) => points[point + 1] = points[point - 1],
            Broken::IsPoint => points.fill(points[0]),
            Broken::Root(..) | Broken::Goal(..) => {}
        }
    }
}

/// Whether a strand's shape at rest is really what it is set aside for.
fn is_deserved(points: &[Vec3], reason: Reason) -> bool {
    let length = |w: &[Vec3]| w[0].as_dvec3().distance(w[1].as_dvec3());
    match reason {
        Reason::Rest(point) => !points[point].is_finite(),
        Reason::NoLength => points.windows(2).map(length).sum::<f64>() < 1e-8,
        Reason::Folded(point) => {
            let after = points[point + 1].as_dvec3() - points[point].as_dvec3();
            let before = points[..=point].windows(2).rev().find(|w| length(w) > 1e-9);
            before.is_some_and(|w| {
                let before = w[1].as_dvec3() - w[0].as_dvec3();
                before.angle_between(after) > 169.0_f64.to_radians()
            })
        }
        // The pose of a root, a goal, the motion: not at the start.
        _ => false,
    }
}
