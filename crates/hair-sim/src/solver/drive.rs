//! What drives a batch in a step: roots, air, bodies and goals, made ready for the stages.

use glam::{DVec3, Vec3 as Point};

use crate::{
    collision::contact::{self, Course},
    forces::{springs::Spring, wind::Gusts},
    lanes::{LANES, Lane, Mask, Quat, Vec3},
};

use super::{
    Roots, Scene,
    batch::{Batch, BatchState, Scratch},
    integrate::{BatchStats, GAMMA},
};

/// What drives a batch in a step.
pub(crate) struct Drive<'a> {
    pub dt: f64,
    pub scene: &'a Scene<'a>,
    pub gusts: &'a Gusts,
    /// The index of every strand's first point in the list of all.
    pub first_points: &'a [usize],
    /// Root and frame of the skin in the world at the end of the step.
    pub root: Vec3,
    pub base: Quat,
}

/// The motion of the roots within a step, and what it does to the strands.
pub(crate) struct RootMotion {
    /// The frame of the skin at the stages.
    pub mid: Quat,
    pub end: Quat,
    /// From its start.
    pub turn_mid: Quat,
    pub turn_end: Quat,
    /// Gravity less the acceleration of the root.
    pub pull: Vec3,
    pub velocity: Vec3,
}

impl RootMotion {
    #[inline(always)]
    pub(crate) fn new(state: &BatchState, drive: &Drive) -> Self {
        let velocity = (drive.root - state.root) * (1.0 / drive.dt);
        let acceleration = (velocity - state.root_velocity) * (1.0 / drive.dt);
        let turn_end = drive.base.times(state.base.conjugate());
        let sign = (turn_end.w.lt(Lane::ZERO)).pick(Lane::splat(-1.0), Lane::ONE);
        // Along the chord: second order in the angle, and no sine.
        let turn_mid = Quat {
            v: turn_end.v * (sign * GAMMA),
            w: turn_end.w * sign * GAMMA + (1.0 - GAMMA),
        }
        .normalize();
        Self {
            mid: turn_mid.times(state.base),
            end: drive.base,
            turn_mid,
            turn_end,
            pull: Vec3::splat(drive.scene.gravity) - acceleration,
            velocity,
        }
    }
}

/// Finds contacts, and fills in the air's motion and the springs of the step.
#[inline(always)]
pub(crate) fn prepare(
    batch: &Batch,
    state: &mut BatchState,
    scratch: &mut Scratch,
    drive: &Drive,
    root: &RootMotion,
    active: Mask,
    stats: &mut BatchStats,
) {
    if batch.has_drag {
        for k in 0..batch.count() {
            let air = drive.gusts.velocity(state.root + state.y[k]);
            scratch.wind[k] = air - root.velocity;
        }
        if drive.gusts.blows {
            stats.wind = active.count() * batch.count();
        }
    }
    scratch.has_contacts = false;
    if !drive.scene.colliders.is_empty() {
        if !state.skin_known {
            contact::settle_in(batch, state, drive.scene.colliders);
            state.skin_known = true;
        }
        let course = Course {
            root: drive.root,
            dt: drive.dt,
            gamma: GAMMA,
        };
        let colliders = drive.scene.colliders;
        let contacts = &mut scratch.contacts;
        stats.contacts = contact::detect(batch, state, colliders, &course, active, contacts);
        scratch.has_contacts = stats.contacts > 0;
    }
    scratch.has_springs = batch.has_goal;
    if batch.has_goal {
        pull_to_goals(batch, state, scratch, drive);
    }
}

fn pull_to_goals(batch: &Batch, state: &mut BatchState, scratch: &mut Scratch, drive: &Drive) {
    let known = !state.goal.is_empty();
    if !known {
        state.goal.resize(batch.count(), Vec3::ZERO);
    }
    for k in 0..batch.count() {
        let mut now = batch.styled[k];
        for lane in 0..LANES {
            let Some(strand) = batch.strands[lane] else {
                continue;
            };
            let pose = match drive.scene.roots {
                Roots::Head(pose) => pose,
                Roots::Each(poses) => poses[strand],
            };
            let goal = match drive.scene.goal {
                Some(goal) if k < batch.counts[lane] => {
                    let at: Point = goal[drive.first_points[strand] + k + 1];
                    at.as_dvec3() - batch.root.get(lane)
                }
                _ => now.get(lane),
            };
            let goal: DVec3 = pose.rotation * goal;
            now.set(lane, goal);
        }
        let before = if known { state.goal[k] } else { now };
        let mut spring = Spring::NONE;
        spring.pull(batch.particles[k].goal, before, now, GAMMA, drive.dt);
        scratch.springs[k] = spring;
        state.goal[k] = now;
    }
}
