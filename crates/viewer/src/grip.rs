//! The pointer's hold of the head, and the wind of the dial, as a hand that moves the scene.

use glam::{Vec2, Vec3};
use stage::Hand;

/// Degrees that the head turns for each point of a drag.
const DEGREES_PER_POINT: f32 = 0.5;
/// Farthest that the head is turned to its sides, and up and down, degrees.
const MOST_DEGREES: Vec2 = Vec2::new(100.0, 50.0);
/// How fast the head follows the pointer, 1/s: a head has mass, and hair that is pulled by jumps of a pointer would fly apart.
const STIFFNESS: f32 = 14.0;
/// A turn (degrees) and its speed (degrees/s) below which the head is at rest.
const REST: f32 = 0.05;
/// The strongest wind of the dial, m/s.
pub const STRONGEST_WIND: f32 = 20.0;

/// What holds head and wind.
#[derive(Clone, Debug, Default)]
pub struct Grip {
    /// Where the pointer wants the head: turned towards its left, and up, degrees.
    wanted: Vec2,
    /// Where it is, and how fast it turns.
    turn: Vec2,
    speed: Vec2,
    is_held: bool,
    /// Where wind blows to, seen from above: towards the character's left, and forwards; m/s.
    pub wind: Vec2,
    /// The scene's time up to which the hand has said what it does.
    until_s: Option<f64>,
    hand: Hand,
}

impl Grip {
    /// The head is dragged by so many points to the right and down.
    pub fn drag(&mut self, points: Vec2) {
        self.is_held = true;
        let wanted = self.wanted + DEGREES_PER_POINT * points * Vec2::new(1.0, -1.0);
        self.wanted = wanted.clamp(-MOST_DEGREES, MOST_DEGREES);
    }

    /// The head is let go of, and turns back.
    pub fn let_go(&mut self) {
        self.is_held = false;
        self.wanted = Vec2::ZERO;
    }

    /// Whether head or wind move hair.
    #[must_use]
    pub fn is_at_work(&self) -> bool {
        self.is_held
            || self.wind != Vec2::ZERO
            || self.turn.abs().max_element() > REST
            || self.speed.abs().max_element() > REST
    }

    /// What it has done, for the scene.
    #[must_use]
    pub fn hand(&self) -> &Hand {
        &self.hand
    }

    /// Says what it does up to `time_s`, in frames of `step_s` seconds. A time before what was said begins anew.
    pub fn advance_to(&mut self, time_s: f32, step_s: f32) {
        let time = f64::from(time_s);
        let step = f64::from(step_s.max(1e-4));
        let until = match self.until_s {
            Some(until) if time >= until => until,
            _ => {
                if !self.is_at_work() && self.hand.is_idle() {
                    return;
                }
                if self.until_s.is_some() {
                    self.hand = Hand::new();
                }
                self.hold(time_s);
                return;
            }
        };
        // After a jump forward, the last second alone is worth its steps.
        let mut at = until.max(time - 1.0);
        while at + 0.5 * step < time {
            at = (at + step).min(time);
            self.swing(step as f32);
            self.hold(at as f32);
        }
    }

    /// Forgets all: head and wind are the script's alone.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    fn hold(&mut self, time_s: f32) {
        let turn = Vec3::new(self.turn.x, self.turn.y, 0.0);
        let wind = Vec3::new(self.wind.x, 0.0, self.wind.y);
        self.hand.hold(time_s, turn, Vec3::ZERO, wind);
        self.until_s = Some(f64::from(time_s));
    }

    /// A spring without overshoot, by its exact solution: any step is stable.
    fn swing(&mut self, dt: f32) {
        let away = self.turn - self.wanted;
        let decay = (-STIFFNESS * dt).exp();
        let slope = self.speed + STIFFNESS * away;
        self.turn = self.wanted + (away + slope * dt) * decay;
        self.speed = (self.speed - STIFFNESS * slope * dt) * decay;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f32 = 1.0 / 24.0;

    #[test]
    fn the_head_follows_and_comes_back() {
        let mut grip = Grip::default();
        assert!(!grip.is_at_work());
        grip.advance_to(1.0, STEP);
        assert!(grip.hand().is_idle(), "a hand that does nothing is none");
        grip.drag(Vec2::new(80.0, 0.0));
        grip.advance_to(1.0, STEP);
        grip.advance_to(2.0, STEP);
        assert!((grip.turn.x - 40.0).abs() < 0.2, "{}", grip.turn.x);
        grip.let_go();
        grip.advance_to(4.0, STEP);
        assert!(!grip.is_at_work() && !grip.hand().is_idle());
    }

    #[test]
    fn any_drag_is_one_that_a_neck_can_do() {
        let mut grip = Grip::default();
        for step in 0..500 {
            let way = if step % 7 < 3 { 1e4 } else { -1e4 };
            grip.drag(Vec2::splat(way));
            grip.advance_to(step as f32 * STEP, STEP);
            assert!(
                grip.turn.abs().cmple(1.3 * MOST_DEGREES).all(),
                "{}",
                grip.turn
            );
        }
    }

    #[test]
    fn going_back_in_time_begins_anew() {
        let mut grip = Grip {
            wind: Vec2::new(5.0, 0.0),
            ..Grip::default()
        };
        grip.advance_to(3.0, STEP);
        grip.advance_to(3.5, STEP);
        grip.advance_to(0.0, STEP);
        let mut fresh = Hand::new();
        fresh.hold(0.0, Vec3::ZERO, Vec3::ZERO, Vec3::new(5.0, 0.0, 0.0));
        assert_eq!(*grip.hand(), fresh);
    }
}
