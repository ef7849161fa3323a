//! Michell's ring: a straight rod that is bent to a closed ring leaves its plane when its ends are twisted against each other
//! by 2 pi sqrt 3 EI / GJ (Michell 1889; Goriely 2006, *Twisted elastic rings and the rediscoveries of Michell's
//! instability*).
//!
//! Our strands are clamped at the root alone. The other clamp is made of goals, nothing else: the strand goes on
//! beyond the end of the ring, first by a very short link along the ring, then by a tail at right angles to it. Goals act
//! from the middle of the strand on, which is just before the ring's end: they hold the tangent there, and the tail, a
//! lever, holds the twist. The joint before the short link is half an element long, as the root's is.

use std::f64::consts::TAU;

use super::rods::TWIST_RATIO;
use super::targets;
use crate::results::Row;
use glam::{DQuat, DVec3, Vec3};
use hair_sim::{Material, Natural, Params, Profile, Scene, Solver, State, Strands};
use std::time::Instant;

/// The scene's name.
pub const SCENE: &str = "ring";
/// The rod's length in m.
const LENGTH: f64 = 0.3;
/// Weight against stiffness: no weight acts, and the rest only sets the unit of time.
const GAMMA: f64 = 1e4;
/// The stiffness of the goals at the tip of the tail, in the rod's own units, EI / (rho S `LENGTH`^4): at the ring's end it is a
/// hundredth of that, and still far more than the ring's own.
const HOLD: f64 = 1e11;
/// The length of the short links over that of an element: what the lever itself gives way is this share of an element's
/// twist.
const SHORT: f64 = 0.05;
/// Steps in the rod's own time, `LENGTH`^2 / sqrt(EI / (rho S)).
const STEPS: f64 = 2000.0;
/// Drag in the rod's own time: a ring that leaves its plane creeps out of it, one that returns creeps back.
const DRAG: f64 = 100.0;
/// The most that the end turns in a step, in radians.
const TURN: f64 = 0.02;
/// The threshold is searched between these parts of the one of theory, by halving so often.
const RANGE: [f64; 2] = [0.8, 1.2];
const HALVINGS: usize = 10;

/// The twist in radians at which theory has the ring leave its plane, for a ratio GJ / EI.
#[must_use]
pub fn theory(twist_ratio: f64) -> f64 {
    TAU * 3.0_f64.sqrt() / twist_ratio
}

/// A row each number of elements (the knob): the error is that of the threshold over theory's; seconds are those of finding
/// it.
///
/// # Errors
///
/// When our solver refuses the strand or a step.
pub fn rows() -> Result<Vec<Row>, String> {
    let row = |elements| {
        let start = Instant::now();
        let ratio = threshold(elements, TWIST_RATIO)? / theory(TWIST_RATIO);
        Ok(Row {
            scene: SCENE.to_owned(),
            method: targets::OWN.trim_end_matches('-').to_owned(),
            knob: elements,
            seconds: start.elapsed().as_secs_f64(),
            error: Some((ratio - 1.0).abs()),
        })
    };
    [10, 20, 40].into_iter().map(row).collect()
}

/// The twist in radians at which a ring of `elements` leaves its plane, for a ratio GJ / EI.
///
/// # Errors
///
/// When our solver refuses the strand or a step.
pub fn threshold(elements: usize, twist_ratio: f64) -> Result<f64, String> {
    let mut ring = Ring::new(elements, twist_ratio)?;
    ring.close()?;
    let [mut low, mut high] = RANGE.map(|part| part * theory(twist_ratio));
    // Of the highest twist that is known to be held, so that no search begins beyond its threshold.
    ring.twist_to(low)?;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let mut tried = ring.clone();
        tried.twist_to(middle)?;
        if tried.leaves_its_plane()? {
            high = middle;
        } else {
            low = middle;
            ring.twist_to(low)?;
        }
    }
    ring.twist_to(0.5 * (low + high))?;
    Ok(ring.measured_twist())
}

/// A rod whose far end goals hold.
#[derive(Clone)]
struct Ring {
    solver: Solver,
    state: State,
    /// Of the whole strand: those before the ring's end act on nothing.
    goals: Vec<Vec3>,
    elements: usize,
    /// Lengths in m of the short links, and of the tail beyond them.
    short: f64,
    tail: f64,
    /// The frame of the root's end.
    base: DQuat,
    /// What the end is bent and twisted by, in radians.
    bend: f64,
    twist: f64,
    /// In s.
    dt: f64,
}

impl Ring {
    /// The rod at rest, straight along X, its tail along Z.
    fn new(elements: usize, twist_ratio: f64) -> Result<Self, String> {
        let n = elements as f64;
        let short = SHORT * LENGTH / n;
        // So long that the middle of the strand is between the ring's end and the joint before it.
        let tail = LENGTH / (0.5 + 0.25 / n) - LENGTH - 11.0 * short;
        let straight = (0..=elements).map(|i| DVec3::X * (LENGTH * i as f64 / n));
        let mut points: Vec<DVec3> = straight.collect();
        points.extend(beyond(points[elements], DVec3::X, DVec3::Z, short, tail));
        let points: Vec<Vec3> = points.iter().map(|p| p.as_vec3()).collect();
        let mut strands = Strands::new();
        let pushed = strands.push(0, &points, None);
        pushed.map_err(|error| error.to_string())?;

        let material = Material {
            twist_ratio,
            ..Material::from_gamma(GAMMA, LENGTH)
        };
        let own_time = LENGTH * LENGTH / material.bending().sqrt();
        let params = Params {
            material,
            natural: Natural::Styled,
            damping: 0.0,
            drag: DRAG / own_time,
            drag_along: 1.0,
            // Nothing up to the middle of the strand.
            goal: Profile {
                root: 0.0,
                middle: 0.0,
                tip: HOLD / (own_time * own_time),
            },
            ..Params::default()
        };
        let (solver, state) = Solver::new(&strands, &params).map_err(|error| error.to_string())?;
        let base = solver.frames(&state, 0).next().unwrap_or_default();
        Ok(Self {
            solver,
            state,
            goals: points,
            elements,
            short,
            tail,
            base,
            bend: 0.0,
            twist: 0.0,
            dt: own_time / STEPS,
        })
    }

    /// Bends the rod to a ring in the plane of X and Y.
    fn close(&mut self) -> Result<(), String> {
        let steps = (TAU / TURN).ceil() as usize;
        for step in 1..=steps {
            self.bend = TAU * step as f64 / steps as f64;
            self.step(0.0)?;
        }
        Ok(())
    }

    /// Turns the end about its own tangent, and lets the twist settle.
    fn twist_to(&mut self, twist: f64) -> Result<(), String> {
        let from = self.twist;
        let steps = ((twist - from).abs() / TURN).ceil() as usize;
        for step in 1..=steps {
            self.twist = from + (twist - from) * step as f64 / steps as f64;
            self.step(0.0)?;
        }
        Ok(())
    }

    /// Pushes the ring out of its plane, a little; after a while, in which all but the slowest motion dies out,
    /// it must be on its way back.
    fn leaves_its_plane(&mut self) -> Result<bool, String> {
        self.step(1e-3 * LENGTH / (self.dt * self.dt))?;
        let mut pause = |times: f64| {
            for _ in 0..(times * STEPS) as usize {
                self.step(0.0)?;
            }
            Ok::<f64, String>(self.out_of_plane())
        };
        let (before, after) = (pause(1.0)?, pause(0.5)?);
        Ok(after > before)
    }

    /// The largest distance of the ring from its plane, in m.
    fn out_of_plane(&self) -> f64 {
        let ring = self.solver.points(&self.state, 0).take(self.elements + 1);
        ring.map(|p| p.z.abs()).fold(0.0, f64::max)
    }

    /// A step under a pull along Z, in m/s^2.
    fn step(&mut self, pull: f64) -> Result<(), String> {
        let end = if self.bend == 0.0 {
            DVec3::X * LENGTH
        } else {
            let radius = LENGTH / self.bend;
            DVec3::new(self.bend.sin(), 1.0 - self.bend.cos(), 0.0) * radius
        };
        let along = DQuat::from_rotation_z(self.bend) * DVec3::X;
        let lever = DQuat::from_axis_angle(along, self.twist) * DVec3::Z;
        self.goals[self.elements] = end.as_vec3();
        let beyond = beyond(end, along, lever, self.short, self.tail);
        for (goal, at) in self.goals[self.elements + 1..].iter_mut().zip(beyond) {
            *goal = at.as_vec3();
        }
        let scene = Scene {
            gravity: DVec3::Z * pull,
            goal: Some(&self.goals),
            ..Scene::default()
        };
        let stats = self.solver.step(&mut self.state, &scene, self.dt);
        let stats = stats.map_err(|error| error.to_string())?;
        if stats.fallbacks > 0 { eprintln!("bend {} twist {} pull {pull} {stats:?}", self.bend, self.twist); }
        if stats.set_aside + stats.asleep > 0 {
            return Err(format!("the ring doesn't do what it is made to: {stats:?}"));
        }
        Ok(())
    }

    /// The angle between the frames of the two ends about the tangent that they share, near the twist that was asked for:
    /// the lever gives way a little.
    fn measured_twist(&self) -> f64 {
        let end = self.solver.frames(&self.state, 0).nth(self.elements);
        let turn = self.base.conjugate() * end.unwrap_or(DQuat::NAN);
        let angle = 2.0 * turn.z.atan2(turn.w);
        angle + TAU * ((self.twist - angle) / TAU).round()
    }
}

/// The points of the strand beyond the ring's end: a short link on, another one along the lever, and its tail.
fn beyond(end: DVec3, along: DVec3, lever: DVec3, short: f64, tail: f64) -> [DVec3; 3] {
    let on = end + along * short;
    [on, on + lever * (10.0 * short), on + lever * (10.0 * short + tail)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_stays_closed_and_plane_while_it_is_twisted() {
        let mut ring = Ring::new(20, 1.0).unwrap();
        ring.close().unwrap();
        ring.twist_to(0.5 * theory(1.0)).unwrap();
        assert!(
            ring.out_of_plane() < 1e-6 * LENGTH,
            "{}",
            ring.out_of_plane()
        );
        let points: Vec<DVec3> = ring.solver.points(&ring.state, 0).collect();
        assert!(points[20].length() < 1e-4 * LENGTH, "{}", points[20]);
        let across = (points[10] - points[0]).length();
        assert!((across * std::f64::consts::PI / LENGTH - 1.0).abs() < 0.01);
        let lost = ring.measured_twist() / ring.twist - 1.0;
        assert!(lost.abs() < 0.01, "{lost}");
    }

    #[test]
    fn rings_leave_their_plane_where_theory_says() {
        for (elements, twist_ratio, most) in
            [(20, TWIST_RATIO, 0.03), (20, 1.0, 0.03), (40, 1.0, 0.01)]
        {
            let found = threshold(elements, twist_ratio).unwrap() / theory(twist_ratio);
            assert!(
                (found - 1.0).abs() < most,
                "{elements}, {twist_ratio}: {found}"
            );
        }
    }
}
pub fn debug(n: usize, r: f64) {
    let mut ring = Ring::new(n, r).unwrap();
    ring.close().unwrap();
    println!("closed: z {:.2e} end {:?}", ring.out_of_plane(), ring.solver.points(&ring.state, 0).nth(n));
    for _ in 0..2000 { ring.step(0.0).unwrap(); } println!("settled {:.2e}", ring.out_of_plane());
    for part in [0.8, 0.95, 1.0, 1.05, 1.1] {
        ring.twist_to(part * theory(r)).unwrap();
        let mut t = ring.clone();
        print!("{part}: measured {:.4} z {:.2e} ", ring.measured_twist() / theory(r), ring.out_of_plane());
        t.step(1e-3 * LENGTH / (t.dt * t.dt)).unwrap();
        for _ in 0..8 { for _ in 0..(0.2 * STEPS) as usize { t.step(0.0).unwrap(); } print!(" {:.3e}", t.out_of_plane()); }
        println!();
    }
}
