//! What acts on strands in a step.

use glam::{DMat3, DVec3, Vec3};

use crate::{
    collision::shape::Collider,
    error::DynamicsError,
    forces::stream::Stream,
    forces::wind::{Blown, Gusts, Wind},
    hash::Hash,
    params::GRAVITY,
    pose::Pose,
};

/// In s. Velocities are differences of places over the step: below it they would be those of rounding.
const SHORTEST_STEP: f64 = 1e-6;

/// Where the roots are at the end of a step.
#[derive(Clone, Copy, Debug)]
pub enum Roots<'a> {
    /// All on one head.
    Head(Pose),
    /// One pose per strand.
    Each(&'a [Pose]),
}

impl Roots<'_> {
    /// The pose of a strand's root, by the strand's index.
    pub(crate) fn of(&self, strand: usize) -> Pose {
        match self {
            Self::Head(pose) => *pose,
            Self::Each(poses) => poses[strand],
        }
    }
}

/// How the motion of a head changes: what is at `p` in style space is accelerated by `turn * p + shift`, the second
/// derivatives of its pose's rotation, as a matrix, and translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Acceleration {
    /// In 1/s^2.
    pub turn: DMat3,
    /// In m/s^2.
    pub shift: DVec3,
}

impl Acceleration {
    /// Of a head that is at the middle one of three poses, `dt` seconds apart: their second difference.
    #[must_use]
    pub fn between(poses: [Pose; 3], dt: f64) -> Self {
        let [before, now, after] = poses;
        let rate = 1.0 / (dt * dt);
        let turn = |pose: Pose| DMat3::from_quat(pose.rotation);
        Self {
            turn: (turn(before) - turn(now) * 2.0 + turn(after)) * rate,
            shift: (before.translation - now.translation * 2.0 + after.translation) * rate,
        }
    }

    pub(crate) fn of(&self, root: DVec3) -> DVec3 {
        self.turn * root + self.shift
    }
}

/// Of an anchor, 1/s^2.
const MOST_STIFFNESS: f64 = 1e9;

/// A place in the world that one point of a strand is pulled to, damped critically. A strand that lies on a body and goes to and fro for 2 s while
/// its anchors and all else rest begins to stick to the head. Solvers of `compare` know none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// The strand, by its index.
    pub strand: usize,
    /// The point, root first; the root itself is where its pose has it.
    pub point: usize,
    /// In 1/s^2, 0 to 1e9: acceleration per metre.
    pub stiffness: f64,
    /// Where the place is when the step starts and when it ends, in m.
    pub places: [DVec3; 2],
    /// Whether it goes where hair takes it, as a tie that gathers strands: that it moves is hair's own motion, which what jams goes on with, and nothing that acts.
    pub follows: bool,
}

/// What acts on the strands in a step.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// Where the roots are at the end of the step.
    pub roots: Roots<'a>,
    /// The head's acceleration when the step starts and when it ends. Where it is not given, it is the change of the
    /// roots' mean velocity from the middle of the step before to that of this one: what acts then lags by half a step.
    pub acceleration: Option<[Acceleration; 2]>,
    /// In m/s^2.
    pub gravity: DVec3,
    /// The motion of the air when the step ends.
    pub wind: Wind,
    /// And when it starts, where it is another: steady wind and gusts change evenly in between.
    pub wind_before: Option<Wind>,
    /// Streams of air beside the wind.
    pub streams: &'a [Stream],
    /// What hair cannot enter.
    pub colliders: &'a [Collider<'a>],
    /// How many of these, the first ones, are parts of one figure that leave hair room between them, as a head and its shoulders. What lies between one of them
    /// and any other is kept out of the figure, and of the other as far as that leaves room; between two others, of both. That takes longer, and what is found in a body is put out more slowly. Of meshes after these hair that grows under one, as its root is in it, isn't kept
    /// out until it leaves it, as under a hat. 0 where nothing is known of them: then the first is taken for the figure's.
    pub of_one_figure: usize,
    /// Places in style space for the points of all strands, in their order, to which [`Params::goal`](crate::Params::goal) pulls; `None`
    /// is the style itself.
    pub goal: Option<&'a [Vec3]>,
    /// What single points are pulled to. Those of a strand or point that is not there pull at nothing.
    pub anchors: &'a [Anchor],
}

impl Default for Surroundings<'_> {
    fn default() -> Self {
        Self {
            roots: Roots::Head(Pose::IDENTITY),
            acceleration: None,
            gravity: DVec3::new(0.0, -GRAVITY, 0.0),
            wind: Wind::default(),
            wind_before: None,
            streams: &[],
            colliders: &[],
            of_one_figure: 0,
            goal: None,
            anchors: &[],
        }
    }
}

impl Surroundings<'_> {
    /// Whether a step of `dt` seconds of so many strands, with so many points in all, can be made in it.
    pub(crate) fn check(
        &self,
        dt: f64,
        strands: usize,
        points: usize,
    ) -> Result<(), DynamicsError> {
        if !(SHORTEST_STEP..=10.0).contains(&dt) {
            return Err(DynamicsError::Step(dt));
        }
        if !self.gravity.is_finite() {
            return Err(DynamicsError::Surroundings("gravity"));
        }
        let finite = |a: &Acceleration| a.turn.is_finite() && a.shift.is_finite();
        if !self.acceleration.iter().flatten().all(finite) {
            return Err(DynamicsError::Surroundings("acceleration"));
        }
        if !(self.wind.is_finite() && self.wind_before.is_none_or(|wind| wind.is_finite())) {
            return Err(DynamicsError::Surroundings("wind"));
        }
        if !self.streams.iter().all(Stream::is_valid) {
            return Err(DynamicsError::Surroundings("stream"));
        }
        if !self.colliders.iter().all(Collider::is_valid) {
            return Err(DynamicsError::Surroundings("collider"));
        }
        for (index, anchor) in self.anchors.iter().enumerate() {
            if !anchor.places.iter().all(|place| place.is_finite()) {
                return Err(DynamicsError::Surroundings("anchor"));
            }
            if !(0.0..=MOST_STIFFNESS).contains(&anchor.stiffness) {
                return Err(DynamicsError::Anchor {
                    anchor: index,
                    stiffness: anchor.stiffness,
                });
            }
        }
        if let Some(found) = self.goal.map(<[Vec3]>::len).filter(|&n| n != points) {
            return Err(DynamicsError::Goal {
                found,
                expected: points,
            });
        }
        match self.roots {
            Roots::Head(pose) if !pose.is_rigid() => Err(DynamicsError::Surroundings("head")),
            Roots::Each(poses) if poses.len() != strands => Err(DynamicsError::Poses {
                found: poses.len(),
                expected: strands,
            }),
            _ => Ok(()),
        }
    }

    /// Whether nothing in it moves within the step: no body, no air that changes, no anchor. Roots aren't asked: a head moves where its poses of two steps
    /// differ.
    #[must_use]
    pub fn is_calm(&self) -> bool {
        let still = |c: &Collider| !c.moves();
        let is_even = self.wind_before.is_none_or(|wind| wind == self.wind);
        let steady = self.streams.iter().all(Stream::is_steady);
        let holds_still = |anchor: &Anchor| anchor.places[0] == anchor.places[1];
        let anchored = self.anchors.iter().all(holds_still);
        self.wind.gust == 0.0 && is_even && steady && anchored && self.colliders.iter().all(still)
    }

    /// The motion of the air at `share` of a step of `dt` seconds, 0 to 1, after what has blown before the step.
    #[inline(always)]
    pub(crate) fn air_at(&self, share: f64, before: Blown, dt: f64) -> Gusts<'_> {
        let blown = self.blown(share, before, dt);
        self.wind_at(share).air(&blown, self.streams, share)
    }

    /// What has blown until `share` of a step of `dt` seconds, 0 to 1.
    #[inline(always)]
    pub(crate) fn blown(&self, share: f64, before: Blown, dt: f64) -> Blown {
        // Of what changes evenly the mean is that of half the way.
        before.after(share * dt, &self.wind_at(0.5 * share))
    }

    #[inline(always)]
    fn wind_at(&self, share: f64) -> Wind {
        let now = self.wind;
        let Some(before) = self.wind_before else {
            return now;
        };
        Wind {
            steady: before.steady * (1.0 - share) + now.steady * share,
            gust: before.gust * (1.0 - share) + now.gust * share,
            ..now
        }
    }

    /// A hash of what acts on strands at rest.
    pub(crate) fn fingerprint(&self) -> u64 {
        let mut hash = Hash::new();
        if let Roots::Head(pose) = self.roots {
            hash.add(pose.translation);
            hash.add_turn(pose.rotation);
        }
        hash.add(self.gravity);
        hash.add(self.wind.steady);
        for end in self.acceleration.iter().flatten() {
            hash.add(end.shift);
            let turn = end.turn;
            for axis in [turn.x_axis, turn.y_axis, turn.z_axis] {
                hash.add(axis);
            }
        }
        for number in self.streams.iter().flat_map(Stream::numbers) {
            hash.add_number(number);
        }
        for collider in self.colliders {
            hash.add(collider.now.translation);
            hash.add_turn(collider.now.rotation);
            for v in collider.shape.numbers() {
                hash.add(v);
            }
        }
        if let Some(goal) = self.goal {
            hash.add_all(goal);
        }
        for anchor in self.anchors {
            hash.add(anchor.places[1]);
            for number in [anchor.strand as f64, anchor.point as f64, anchor.stiffness] {
                hash.add_number(number);
            }
        }
        hash.sum()
    }
}
