//! Seams: where an animation that repeats starts again elsewhere than it ended, so that the head jumps.
//!
//! A step over a seam is taken as if the round before had ended where the next one starts: first hair, ties and bodies are carried there, each as a
//! whole, and then the head walks on, or turns on, through all of the step. So the places, velocities and accelerations in it are those of one round, and nothing that
//! is simulated feels the jump. Where the head ends with another velocity than it starts with, that is felt, as a sudden stop is anywhere in an animation.
//!
//! This is right wherever in a step the seam lies, and so at any rate of frames. A step that were split there would have parts of any length, down to none.

use super::{Dynamics, air};
use crate::hand::Driver;
use crate::posture::Posture;
use crate::script::{Below, MotionScript, come_round};
use crate::skeleton::after;
use hair_sim::{Collider, Pose, Stream};

/// The seams of a script.
#[derive(Clone, Copy, Default)]
pub(super) struct Seams {
    /// After so many seconds its animation starts again; None where nothing jumps then.
    length_s: Option<f64>,
}

/// A seam in a step.
pub(super) struct Seam<'s> {
    /// Just before it and just after it, in seconds, and how the figure stands there.
    times: [f64; 2],
    postures: [Posture<'s>; 2],
}

impl Seams {
    pub fn of(script: &MotionScript) -> Self {
        let jump = script.below.as_ref().and_then(Below::jump);
        Self {
            length_s: jump.map(|jump| jump.length_s),
        }
    }

    /// The times (seconds) just before and just after the last seam from one time to another.
    fn between(self, script: &MotionScript, [begin, end]: [f64; 2]) -> Option<[f64; 2]> {
        let length_s = self.length_s?;
        // A script that starts again has its animation start again with it.
        let start = |time: f64| time - come_round(script.within(time), length_s);
        let last = start(end);
        // Twice as far from the seam as what counts as the next round already.
        let slack = 2.0 * f64::from(f32::EPSILON) * begin.abs().max(end.abs());
        (last - start(begin) > slack).then_some([last - slack, last + slack])
    }
}

/// The times (seconds) just before and just after a script starts again, where that is between `time` and the `start` of a simulation, before which nothing has
/// moved: what jumps there isn't felt. A loop doesn't jump.
fn starts_again(script: &MotionScript, start: f64, time: f64) -> Option<[f64; 2]> {
    if script.period.is_none() || script.closes {
        return None;
    }
    let again = start - script.within(start);
    let slack = f64::from(f32::EPSILON) * time.abs();
    (time < again).then_some([again - slack, again])
}

impl Seam<'_> {
    /// How the head jumps there.
    pub fn way(&self) -> Pose {
        let [before, next] = &self.postures;
        way([before.head, next.head])
    }
}

impl Dynamics {
    /// The seam in a step from one time to another (seconds), if there is one.
    pub(super) fn seam<'s>(&self, times: [f64; 2], driver: Driver<'s>) -> Option<Seam<'s>> {
        let times = self.seams.between(driver.script, times)?;
        Some(Seam {
            times,
            postures: times.map(|time| self.posture_at(time, driver)),
        })
    }

    /// The head's pose at `time` (seconds), carried over the seam between that and another time, if there is one, as over what jumps before the start.
    pub(super) fn pose_beside(&self, time: f64, other: f64, driver: Driver) -> Pose {
        let pose = self.pose_at(time, driver);
        let times = [time.min(other), time.max(other)];
        let seam = self.seams.between(driver.script, times);
        let Some(sides) = seam.or_else(|| starts_again(driver.script, self.time_of(0), time))
        else {
            return pose;
        };
        let [before, next] = sides.map(|time| self.pose_at(time, driver));
        match time < other {
            true => after(pose, way([before, next])),
            false => after(pose, way([next, before])),
        }
    }

    /// Carries bodies, those of the script that are `near`, and streams over a seam from where they are when its step begins.
    pub(super) fn carry_over(
        &self,
        seam: &Seam,
        driver: Driver,
        near: &[bool],
        (bodies, streams): (&mut [Collider], &mut [Stream]),
    ) {
        let [before, next] = &seam.postures;
        let jumps = (self.bodies).colliders(driver.script, seam.times, [before, next], near);
        for (body, jump) in bodies.iter_mut().zip(jumps) {
            body.before = after(body.before, way([jump.before, jump.now]));
        }
        let jumps = air::streams(driver, &self.placement, self.head, seam.times);
        for (stream, jump) in streams.iter_mut().zip(jumps) {
            stream.center[0] += jump.center[1] - jump.center[0];
        }
    }
}

/// The motion that takes one pose to another.
pub(super) fn way([from, to]: [Pose; 2]) -> Pose {
    let rotation = to.rotation * from.rotation.inverse();
    Pose {
        rotation,
        translation: to.translation - rotation * from.translation,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of frames whose times are as programs ask for them, in single precision, and of steps, whose times are exact.
    #[test]
    fn each_round_has_one_seam() {
        for (fps, length) in [
            (24.0, 1.0_f32),
            (30.0, 0.8),
            (60.0, 0.77),
            (24.0, 23.0 / 24.0),
        ] {
            let length_s = f64::from(length);
            let seams = Seams {
                length_s: Some(length_s),
            };
            let script = MotionScript::default();
            let single = |frame: i32| f64::from(frame as f32 / fps as f32);
            let double = |frame: i32| f64::from(frame) / fps;
            for time_of in [&single as &dyn Fn(i32) -> f64, &double] {
                let times = (0..5000).map(|frame| [frame, frame + 1].map(time_of));
                let mut rounds = 0;
                for [before, next] in times.filter_map(|times| seams.between(&script, times)) {
                    rounds += 1;
                    let seam = length_s * f64::from(rounds);
                    assert!((before - seam).abs() < 1e-3 && (next - seam).abs() < 1e-3);
                    let [before, next] = [before, next].map(|time| come_round(time, length_s));
                    assert!(length_s - before < 1e-3 && next < 1e-3);
                }
                assert_eq!(rounds, (time_of(5000) / length_s + 1e-4) as i32);
            }
        }
    }

    #[test]
    fn a_script_that_starts_again_has_its_animation_start_again() {
        let seams = Seams {
            length_s: Some(1.0),
        };
        let script = MotionScript {
            period: Some(1.5),
            ..MotionScript::default()
        };
        let steps = (-24..96).map(|step| [step, step + 1].map(|step| f64::from(step) / 24.0));
        let found = steps.filter_map(|times| seams.between(&script, times));
        let found: Vec<f64> = found.map(|[before, next]| 0.5 * (before + next)).collect();
        let expected = [-0.5, 0.0, 1.0, 1.5, 2.5, 3.0, 4.0];
        assert_eq!(found.len(), expected.len(), "{found:?}");
        let alike = |(found, expected): (&f64, f64)| (found - expected).abs() < 1e-5;
        assert!(found.iter().zip(expected).all(alike), "{found:?}");
    }
}
