//! How a head moves and the wind blows: scripts, `*.motion.ron`.
//!
//! A script is a function of time alone. Its head starts from the pose of the files; moves add up.

mod bone;
mod load;
mod parse;
mod pose;

pub(crate) use bone::{Below, Bone, come_round};
pub(crate) use load::load;
pub use parse::MOTION_PARTS;
pub(crate) use parse::parse;
pub(crate) use pose::{HeadPose, turned};

use crate::bodies::{Body, NamedBody, NamedKey};
use crate::hair::HairModel;
use crate::skeleton::Skeleton;
use effects::choices;
use effects::preset::Place;
use glam::{DQuat, DVec3};
use hair_sim::key_weights;
use std::sync::Arc;
use stroke_path::sin_cos_degrees;

/// A script of motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct MotionScript {
    /// Seconds after which it starts again; nothing never does.
    pub period: Option<f64>,
    /// How an animation moves the head, below all else.
    pub below: Option<Below>,
    /// Key shapes of the hair, times ascending.
    pub shapes: Vec<KeyShape>,
    /// Pull of the hair to its key shapes at root, middle and tip, 1/s^2.
    pub hold: [f64; 3],
    /// Keyframes of the head, times ascending.
    pub keys: Vec<Key>,
    /// Moves of the head.
    pub moves: Vec<Move>,
    /// Winds; their speeds add up.
    pub winds: Vec<Wind>,
    /// Whether the head keeps the wind from what is behind it.
    pub has_wake: bool,
    /// Whether hair comes back to where it was when the script starts again; it has a period then.
    pub closes: bool,
    /// Where it says so.
    pub loop_place: Option<Place>,
    /// Bodies that the script itself lists, and the keys of those and of the preset's, as they are written.
    pub named_bodies: Vec<NamedBody>,
    pub body_keys: Vec<NamedKey>,
    /// All bodies that hair is kept out of beside head and shoulders: the preset's and the script's.
    pub bodies: Vec<Arc<Body>>,
    /// Whether meshes beside the head move by themselves, so that poses differ with time.
    pub moves_meshes: bool,
}

/// Where the head is at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Key {
    /// Seconds.
    pub time: f64,
    /// Turns in degrees: towards the character's left, up, towards the left shoulder.
    pub turn: DVec3,
    /// Head heights.
    pub shift: DVec3,
}

/// The shape that hair has at a time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KeyShape {
    /// Seconds.
    pub time: f64,
    /// The file that it is in, relative to the script; the hair's own shape without one.
    pub file: Option<String>,
    /// When it is so in a file with motion, seconds.
    pub at: Option<f32>,
    /// Where the script says so.
    pub place: Place,
}

choices! {
    /// What a move does.
    pub(crate) enum MoveKind {
        /// Turns once, and stays: towards the character's left.
        Turn = "turn",
        /// Looks up once, and stays.
        Lift = "lift",
        /// Leans towards the left shoulder once, and stays.
        Lean = "lean",
        /// Shakes from side to side.
        Shake = "shake",
        /// Nods.
        Nod = "nod",
        /// Bobs and sways as in walking.
        Walk = "walk",
        /// Turns the whole figure once, and stays: to its left.
        Spin = "spin",
    }
}

/// A move of the head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Move {
    pub kind: MoveKind,
    /// Seconds.
    pub start: f64,
    /// Seconds, more than 0.
    pub length: f64,
    /// Degrees.
    pub angle: f64,
    /// Swings or steps a second.
    pub rate: f64,
    /// Height of a step, head heights.
    pub step: f64,
}

/// Wind that blows for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wind {
    /// Seconds.
    pub start: f64,
    /// Seconds; more than 0.
    pub length: f64,
    /// A unit vector: where it blows to.
    pub direction: DVec3,
    /// m/s.
    pub speed: f64,
    /// Speed of the gusts on top, m/s.
    pub gusts: f64,
    /// Its shape.
    pub kind: WindKind,
    /// Where its middle is, from the head's at rest; head heights.
    pub place: DVec3,
    /// Where a point's or a vortex's wind is fastest; head heights.
    pub radius: f64,
    /// The longest waves of turbulence; head heights.
    pub size: f64,
    /// How fast turbulence is carried along, m/s.
    pub drift: f64,
    /// Another one, other turbulence.
    pub seed: u32,
}

choices! {
    /// The shape of a wind.
    pub(crate) enum WindKind {
        /// The same everywhere, from a direction.
        Direction = "direction",
        /// Away from a place.
        Point = "point",
        /// Around an axis.
        Vortex = "vortex",
        /// Every way, and another one at each place and time.
        Turbulence = "turbulence",
    }
}

/// Seconds in which a wind rises and falls.
const WIND_RISE: f64 = 0.4;

impl MotionScript {
    /// Whether nothing moves.
    pub fn is_still(&self) -> bool {
        let head_is = self.keys.is_empty() && self.moves.is_empty() && self.below.is_none();
        let bodies_are = self.bodies.iter().all(|body| !body.moves());
        head_is && self.winds.is_empty() && self.shapes.is_empty() && bodies_are
    }

    /// The head's pose at `time` (seconds).
    pub fn head_at(&self, time: f64) -> HeadPose {
        self.head_before(self.within(time))
    }

    /// The head's pose at the script's own `time`, which may be its end.
    pub fn head_before(&self, time: f64) -> HeadPose {
        let (mut turn, mut shift) = self.keyed(time);
        let mut base = DQuat::IDENTITY;
        let mut spin = 0.0;
        let mut animated_s = None;
        if let Some(below) = &self.below {
            let (rotation, moved, time_s) = below.at(time);
            base = rotation;
            shift += moved;
            animated_s = time_s;
        }
        for part in &self.moves {
            let (t, s) = part.at(time, self.goes_round(part.start, part.length));
            turn += t;
            shift += s;
            spin += part.spin_at(time);
        }
        HeadPose {
            base,
            spin,
            turn,
            shift,
            animated_s,
            beaten_s: self.moves_meshes.then_some(time),
        }
    }

    /// The same for other hair.
    pub fn with_hair(&self, hair: &HairModel) -> Self {
        let skeleton = self.skeleton();
        let below = skeleton.map(|skeleton| Below::skeleton(skeleton, hair));
        Self {
            below: below.or_else(|| self.below.clone()),
            ..self.clone()
        }
    }

    /// The skeleton that moves the whole character, if one does.
    pub fn skeleton(&self) -> Option<&Skeleton> {
        match &self.below {
            Some(Below::Skeleton { skeleton, .. }) => Some(skeleton),
            _ => None,
        }
    }

    /// The steady wind and the speed of gusts at `time`: m/s.
    pub fn wind_at(&self, time: f64) -> (DVec3, f64) {
        let time = self.within(time);
        let mut steady = DVec3::ZERO;
        let mut gusts = 0.0;
        let even = |wind: &&Wind| wind.kind == WindKind::Direction;
        for wind in self.winds.iter().filter(even) {
            let strength = self.strength_of(wind, time);
            steady += wind.direction * (wind.speed * strength);
            gusts += wind.gusts * strength;
        }
        (steady, gusts)
    }

    /// How much of a wind blows at the script's own `time`, 0 to 1.
    pub fn strength_of(&self, wind: &Wind, time: f64) -> f64 {
        if self.goes_round(wind.start, wind.length) {
            return 1.0;
        }
        smooth((time - wind.start) / WIND_RISE)
            * smooth((wind.start + wind.length - time) / WIND_RISE)
    }

    /// Whether what begins and lasts so goes on from the script's end to its start.
    fn goes_round(&self, start: f64, length: f64) -> bool {
        let is_over = |period: f64| length < period;
        self.closes && start <= 0.0 && !self.period.is_some_and(is_over)
    }

    /// The script's own time at `time`.
    pub fn within(&self, time: f64) -> f64 {
        self.period.map_or(time, |period| time.rem_euclid(period))
    }

    /// The keyframes' spline at `time`.
    fn keyed(&self, time: f64) -> (DVec3, DVec3) {
        let (mut turn, mut shift) = (DVec3::ZERO, DVec3::ZERO);
        if self.keys.is_empty() {
            return (turn, shift);
        }
        let time_of = |key: usize| self.keys[key].time;
        let is_held = |key: usize| {
            let [here, next] = [key, key + 1].map(|key| &self.keys[key]);
            here.turn == next.turn && here.shift == next.shift
        };
        for (key, weight) in key_weights(self.keys.len(), time_of, is_held, time) {
            turn += self.keys[key].turn * weight;
            shift += self.keys[key].shift * weight;
        }
        (turn, shift)
    }
}

impl Move {
    /// Its turn of the figure at `time`, degrees.
    fn spin_at(&self, time: f64) -> f64 {
        match self.kind {
            MoveKind::Spin => self.angle * smooth((time - self.start) / self.length),
            _ => 0.0,
        }
    }

    /// Its turn (degrees) and shift (head heights) at `time`; `goes_round` where it neither rises nor falls.
    fn at(&self, time: f64, goes_round: bool) -> (DVec3, DVec3) {
        let since = time - self.start;
        let still = (DVec3::ZERO, DVec3::ZERO);
        let once = self.angle * smooth(since / self.length);
        // Swings rise and fall within a quarter of their length, or half a swing.
        let rise = (0.25 * self.length).min(0.5 / self.rate);
        let strength = match goes_round {
            true => 1.0,
            false => smooth(since / rise) * smooth((self.length - since) / rise),
        };
        let swing = |share: f64| strength * sin_cos_degrees(360.0 * self.rate * share * since).0;
        match self.kind {
            MoveKind::Turn => (DVec3::X * once, DVec3::ZERO),
            MoveKind::Lift => (DVec3::Y * once, DVec3::ZERO),
            MoveKind::Lean => (DVec3::Z * once, DVec3::ZERO),
            MoveKind::Spin => still,
            _ if strength <= 0.0 => still,
            MoveKind::Shake => (DVec3::X * (self.angle * swing(1.0)), DVec3::ZERO),
            MoveKind::Nod => (DVec3::Y * (self.angle * swing(1.0)), DVec3::ZERO),
            // Up and down once a step, from foot to foot in two.
            MoveKind::Walk => (
                DVec3::new(0.0, 0.3, 0.5) * (self.angle * swing(0.5)),
                DVec3::new(0.6 * swing(0.5), swing(1.0), 0.0) * self.step,
            ),
        }
    }
}

/// From 0 to 1 without a jump of acceleration at either end.
pub(crate) fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn(start: f64, length: f64, angle: f64) -> Move {
        Move {
            kind: MoveKind::Turn,
            start,
            length,
            angle,
            rate: 1.0,
            step: 0.0,
        }
    }

    #[test]
    fn moves_add_up_and_stay() {
        let script = MotionScript {
            moves: vec![turn(1.0, 0.5, 90.0), turn(2.0, 0.5, -30.0)],
            ..MotionScript::default()
        };
        let at = |time| script.head_at(time).turn.x;
        assert_eq!(at(0.9), 0.0);
        assert_eq!(at(1.25), 45.0);
        assert_eq!(at(1.8), 90.0);
        assert_eq!(at(9.0), 60.0);
    }

    #[test]
    fn swings_begin_and_end_at_rest() {
        for kind in [MoveKind::Shake, MoveKind::Nod, MoveKind::Walk] {
            let script = MotionScript {
                moves: vec![Move {
                    kind,
                    start: 0.5,
                    length: 2.0,
                    angle: 20.0,
                    rate: 2.0,
                    step: 0.05,
                }],
                ..MotionScript::default()
            };
            let at = |time: f64| script.head_at(time);
            let still = HeadPose::default();
            assert_eq!((at(0.0), at(3.0)), (still, still));
            let speed = |time: f64| (at(time + 1e-4).turn - at(time).turn).length() / 1e-4;
            assert!(speed(0.5001) < 1.0 && speed(2.4998) < 1.0);
            let fastest = (0..200).map(|i| speed(0.5 + 0.01 * f64::from(i)));
            assert!(fastest.fold(0.0, f64::max) > 20.0);
        }
    }

    #[test]
    fn keyframes_are_passed_through_smoothly_and_repeat() {
        let key = |time, yaw, height| Key {
            time,
            turn: DVec3::new(yaw, 0.0, 0.0),
            shift: DVec3::new(0.0, height, 0.0),
        };
        let keys = vec![
            key(0.0, 0.0, 0.0),
            key(1.0, 40.0, 1.0),
            key(1.5, -20.0, 0.0),
            key(2.0, 0.0, 0.0),
        ];
        let script = MotionScript {
            period: Some(2.0),
            keys: keys.clone(),
            ..MotionScript::default()
        };
        for key in &keys[..3] {
            for round in [0.0, 2.0, 200.0] {
                let pose = script.head_at(key.time + round);
                assert!((pose.turn - key.turn).length() < 1e-9);
                assert!((pose.shift - key.shift).length() < 1e-9);
            }
        }
        // No corner at a key: the slopes on both sides agree.
        let at = |time| script.head_at(time).turn.x;
        for time in [1.0, 1.5] {
            let (before, after) = (at(time) - at(time - 1e-5), at(time + 1e-5) - at(time));
            assert!((before - after).abs() < 1e-6);
        }
    }

    #[test]
    fn winds_rise_and_fall() {
        let script = MotionScript {
            winds: vec![Wind {
                start: 1.0,
                length: 2.0,
                direction: DVec3::X,
                speed: 5.0,
                gusts: 2.0,
                kind: WindKind::Direction,
                place: DVec3::ZERO,
                radius: 1.0,
                size: 1.0,
                drift: 0.0,
                seed: 0,
            }],
            ..MotionScript::default()
        };
        assert_eq!(script.wind_at(0.5), (DVec3::ZERO, 0.0));
        assert_eq!(script.wind_at(2.0), (DVec3::X * 5.0, 2.0));
        let (rising, _) = script.wind_at(1.2);
        assert!(rising.x > 0.0 && rising.x < 5.0);
        assert_eq!(script.wind_at(3.5), (DVec3::ZERO, 0.0));
    }
}
