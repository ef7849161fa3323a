//! The motion of hair closed into a loop, for scripts that go round.
//!
//! Head and wind are the same in every period, so hair that is simulated comes to repeat itself, but for what still swings, and for what
//! sticks and slips. It is simulated until it does, or for [`MOST_ROUNDS`]. What is left is blended: at the loop's start it is where the
//! last round began, at its end where that ended, which is where the loop starts; in between it goes over from the one
//! round to the other without a jump of speed or acceleration; and hair that came into bodies by that is moved out of them.

use crate::dynamics::{Dynamics, Seen};
use crate::files::StageError;
use crate::hand::Driver;
use crate::object::Object;
use crate::script::{HeadPose, smooth};
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;

/// Points that are worth a task of their own.
const WORTH_A_TASK: usize = 4096;
/// Rounds that are simulated at most.
const MOST_ROUNDS: usize = 12;
/// A round that is no farther from the one before, in head heights, repeats it: a twentieth of a pixel of a head 1000 high.
const ALIKE: f32 = 5e-5;

/// Points of all frames of a loop at most: both rounds that are kept take 960 MB then.
const MOST_POINTS: usize = 40_000_000;

/// Loops of more frames than this take long enough that it is said beforehand.
const MANY_FRAMES: usize = 480;

/// How far a period may be from a whole number of frames, in frames: it is written in few digits.
const WHOLE: f64 = 0.02;

/// What to say of a loop of so many seconds before it is drawn, with so many frames a second: that it takes long, and that a sequence of it has a seam.
pub(crate) fn notes(period: f64, fps: f32) -> impl Iterator<Item = String> {
    let frames = frames_of(period, fps);
    let long = (frames > MANY_FRAMES).then(|| {
        format!(
            "loop: all of its {frames} frames are simulated, two to {MOST_ROUNDS} times, before the first one is drawn; a shorter \
             `period` takes less"
        )
    });
    let of_frames = period * f64::from(fps);
    let uneven = ((of_frames - of_frames.round()).abs() > WHOLE).then(|| {
        let digits = |number: f64, digit: f64| (number / digit).round() * digit;
        format!(
            "loop: its `period` of {} s is {} frames at {fps} a second, so that a sequence of its pictures has a seam; {} s are {frames} frames",
            period as f32,
            digits(of_frames, 0.01) as f32,
            digits(frames as f64 / f64::from(fps), 1e-5) as f32,
        )
    });
    long.into_iter().chain(uneven)
}

fn frames_of(period: f64, fps: f32) -> usize {
    (period * f64::from(fps)).round().max(2.0) as usize
}

/// How well hair came back to where it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Return {
    /// Frames of the loop.
    pub frames: usize,
    /// Rounds that were simulated.
    pub rounds: usize,
    /// The farthest that a point was, in any frame of the last round, from where it was in the round before; metres. So much is
    /// blended over the loop.
    pub left_m: f32,
    /// The root mean square of that over points and frames; metres.
    pub mean_left_m: f32,
}

/// The loop of an object's hair, or as much of it as has been simulated.
pub(crate) struct Closed {
    /// Seconds.
    period: f64,
    frames: usize,
    strands: Vec<Range<usize>>,
    /// What simulates until the loop is closed, and then keeps hair that is held out of bodies.
    dynamics: Dynamics,
    is_closed: bool,
    /// Shapes on the head at rest: of the frames of the last two rounds while it is simulated, then of the loop.
    shapes: Vec<Vec<Vec3>>,
    rounds: usize,
    left_m: f32,
    mean_left_m: f32,
}

impl Closed {
    /// The loop of an object whose hair `dynamics` moves, in so many frames a second; `period` is in seconds.
    ///
    /// # Errors
    ///
    /// When that is more than is kept.
    pub fn new(
        object: &Object,
        dynamics: Dynamics,
        period: f64,
        fps: f32,
    ) -> Result<Self, StageError> {
        let strands = &object.hair().file.strands;
        let frames = frames_of(period, fps);
        let points = strands.points().len();
        if frames.saturating_mul(points) > MOST_POINTS {
            return Err(StageError::Loop { frames, points });
        }
        Ok(Self {
            period,
            frames,
            strands: (0..strands.len()).map(|i| strands.point_range(i)).collect(),
            dynamics,
            is_closed: false,
            shapes: Vec::new(),
            rounds: 0,
            left_m: 0.0,
            mean_left_m: 0.0,
        })
    }

    /// How well hair came back; nothing while that isn't known.
    pub fn came_back(&self) -> Option<Return> {
        self.is_closed.then_some(Return {
            frames: self.frames,
            rounds: self.rounds,
            left_m: self.left_m,
            mean_left_m: self.mean_left_m,
        })
    }

    /// What knows the bodies.
    pub fn dynamics(&self) -> &Dynamics {
        &self.dynamics
    }

    /// Simulates for as long as `goes_on` says so, which is asked before each step. Whether the loop is closed.
    ///
    /// # Errors
    ///
    /// When the solver refuses the scene.
    pub fn close(
        &mut self,
        object: &Object,
        driver: Driver,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<bool, StageError> {
        let height_m = object.hair().head.height_m;
        while !self.is_closed {
            let dynamics = &mut self.dynamics;
            let frame = self.rounds * self.frames + self.shapes.len() % self.frames;
            let time = self.period * frame as f64 / self.frames as f64;
            if dynamics.advance_to(time, driver, Seen::Well, goes_on)? != time {
                return Ok(false);
            }
            let mut points = on_head(object, driver.head_at(time));
            dynamics.write(driver, time, &mut points);
            off_head(object, driver.head_at(time), &mut points);
            self.shapes.push(points);
            if !self.shapes.len().is_multiple_of(self.frames) {
                continue;
            }
            self.rounds += 1;
            if self.shapes.len() < 2 * self.frames {
                continue;
            }
            let (before, now) = self.shapes.split_at(self.frames);
            let apart = before.iter().zip(now).flat_map(|(a, b)| a.iter().zip(b));
            let (mut most, mut sum, mut count) = (0.0_f32, 0.0_f64, 0_u32);
            for (a, b) in apart {
                let square = a.distance_squared(*b);
                most = most.max(square);
                sum += f64::from(square);
                count += 1;
            }
            self.left_m = most.sqrt();
            self.mean_left_m = (sum / f64::from(count.max(1))).sqrt() as f32;
            if self.left_m <= ALIKE * height_m || self.rounds == MOST_ROUNDS {
                self.blend();
                self.keep_out(object, driver);
                self.is_closed = true;
            } else {
                self.shapes.drain(..self.frames);
            }
        }
        Ok(true)
    }

    /// The loop from the last two rounds: it begins as the last one and ends as the one before that, and so where the last one begins.
    fn blend(&mut self) {
        let last = self.shapes.split_off(self.frames);
        let frames = self.frames as f64;
        for (frame, (shape, last)) in self.shapes.iter_mut().zip(&last).enumerate() {
            let share = smooth(frame as f64 / frames) as f32;
            for strand in &self.strands {
                blend_strand(&last[strand.clone()], &mut shape[strand.clone()], share);
            }
        }
    }

    /// Moves hair of the loop out of bodies, into which it may have been blended. What is out of them keeps its bits.
    fn keep_out(&mut self, object: &Object, driver: Driver) {
        for (frame, shape) in self.shapes.iter_mut().enumerate() {
            let time = self.period * frame as f64 / self.frames as f64;
            let pose = driver.head_at(time);
            let mut points = shape.clone();
            move_by(object, pose, &mut points);
            for moved in self.dynamics.keep_out(driver, time, &mut points) {
                let points = &mut points[moved.clone()];
                off_head(object, pose, points);
                shape[moved].copy_from_slice(points);
            }
        }
    }

    /// Writes the points at `time` (seconds) of a head in this pose: between frames on a spline.
    pub fn sample(&self, object: &Object, pose: HeadPose, time: f64, points: &mut [Vec3]) {
        let place = time.rem_euclid(self.period) / self.period * self.frames as f64;
        // What a time in single precision can tell from a frame's is no other one.
        let nearest = place.round();
        let slack = time.abs() * f64::from(f32::EPSILON) / self.period * self.frames as f64 + 1e-6;
        let (first, u) = match (place - nearest).abs() <= slack {
            true => (nearest as usize, 0.0),
            false => (place as usize, (place - place.floor()) as f32),
        };
        let [a, b, c, d] =
            [self.frames - 1, 0, 1, 2].map(|by| &self.shapes[(first + by) % self.frames]);
        for (i, point) in points.iter_mut().enumerate() {
            *point = b[i];
            if u > 0.0 {
                let (from, to) = ((c[i] - a[i]) * 0.5, (d[i] - b[i]) * 0.5);
                let way = c[i] - b[i];
                *point +=
                    (from + (way * 3.0 - from * 2.0 - to + (from + to - way * 2.0) * u) * u) * u;
            }
        }
        move_by(object, pose, points);
    }
}

/// Puts `shape`, a strand's points, at `share` of the way from `start` to where it is; each link is as long as between the two.
fn blend_strand(start: &[Vec3], shape: &mut [Vec3], share: f32) {
    let length = |a: &[Vec3], i: usize| a[i].distance(a[i - 1]);
    let lengths: Vec<f32> = (1..shape.len())
        .map(|i| length(start, i) + (length(shape, i) - length(start, i)) * share)
        .collect();
    for (point, from) in shape.iter_mut().zip(start) {
        *point = from.lerp(*point, share);
    }
    let mut before = shape[0];
    for i in 1..shape.len() {
        let link = shape[i] - before;
        before = shape[i];
        shape[i] = shape[i - 1] + link.normalize_or_zero() * lengths[i - 1];
    }
}

/// The hair's points at rest on a head in this pose.
fn on_head(object: &Object, pose: HeadPose) -> Vec<Vec3> {
    let mut points = object.hair().file.strands.points().to_vec();
    move_by(object, pose, &mut points);
    points
}

/// Moves points with the head, from rest to this pose.
pub(crate) fn move_by(object: &Object, pose: HeadPose, points: &mut [Vec3]) {
    let (rotation, translation) = object.rigid(pose);
    let points = points.par_iter_mut().with_min_len(WORTH_A_TASK);
    points.for_each(|point| *point = (rotation * point.as_dvec3() + translation).as_vec3());
}

/// Puts those points where a head in this pose has them.
pub(crate) fn put_on_head(object: &Object, pose: HeadPose, which: &[usize], points: &mut [Vec3]) {
    let (rotation, translation) = object.rigid(pose);
    let rest = object.hair().file.strands.points();
    for &i in which {
        points[i] = (rotation * rest[i].as_dvec3() + translation).as_vec3();
    }
}

/// Moves points with the head, from this pose to rest.
pub(crate) fn off_head(object: &Object, pose: HeadPose, points: &mut [Vec3]) {
    let (rotation, translation) = object.rigid(pose);
    let back = rotation.inverse();
    for point in points {
        *point = (back * (point.as_dvec3() - translation)).as_vec3();
    }
}
