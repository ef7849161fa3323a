//! Streams of air that have a place or a shape of their own, beside the even [`Wind`](super::wind::Wind).

use glam::DVec3;

use crate::{
    forces::wind::{sine_of_turns, sphere, unit},
    lanes::{Number, Vec3},
};

/// Number of waves of turbulence.
const WAVES: usize = 16;
/// From each to the next their length shrinks by this, to a quarter in all, and their speed by its cube root.
const SHRINKS: f64 = 0.9117224885582168;
const SLOWS: f64 = 0.969663144646718;
/// What a body takes from the wind behind it, of the wind's speed and the square of its radius, and how its wake widens: nine tenths
/// of the wind are missing one radius behind its middle, a third ten behind.
const DEFICIT: f64 = 0.7;
const SPREAD: f64 = 0.15;

/// A stream of air, which adds to the wind and to other streams. Speeds are in m/s, places in m in world axes.
///
/// All are free of divergence, so that they make no air and lose none; a source is so outside of its radius.
#[derive(Clone, Debug, PartialEq)]
pub struct Stream {
    /// Its shape.
    pub flow: Flow,
    /// Its speed when a step starts and when it ends; it changes evenly in between.
    pub speed: [f64; 2],
    /// Its middle when a step starts and when it ends. Turbulence has none.
    pub center: [DVec3; 2],
    /// A unit vector: what a vortex turns about, counter-clockwise seen against it, and where the wind blows to that a wake is in.
    pub axis: DVec3,
}

/// The shape of a [`Stream`]. Radii are 1e-3 m or more.
#[derive(Clone, Debug, PartialEq)]
pub enum Flow {
    /// Away from its middle: fastest at its radius, less with the square of the distance beyond, less towards the middle within. A speed
    /// below 0 draws in.
    Source {
        /// In m.
        radius: f64,
    },
    /// Around its axis: fastest at its radius (Kaufmann's and Scully's vortex).
    Vortex {
        /// In m.
        radius: f64,
    },
    /// Every way, another one at every place and time; the speed is the root mean square over space and time.
    Turbulence(Box<Turbulence>),
    /// What a round body with this radius takes from a wind of this speed: the wind is slower behind the body, slowest close behind it, and
    /// goes around it. The momentum that is missing stays the same along the wake.
    Wake {
        /// In m.
        radius: f64,
    },
}

/// Turbulence of speed 1: waves across their own direction with lengths between its size and a quarter of that, whose energy falls with the
/// two thirds' power of their number, as Kolmogorov's does.
#[derive(Clone, Debug, PartialEq)]
pub struct Turbulence {
    waves: [Wave; WAVES],
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Wave {
    /// Turns per metre, and a second.
    number: DVec3,
    rate: f64,
    /// In turns.
    phase: f64,
    amplitude: DVec3,
}

impl Turbulence {
    /// Turbulence of the given size (the longest wave, in m, 1e-3 or more) that `drift` carries along (m/s) and whose eddies turn as they do where
    /// it has `speed` (m/s). It comes again after `period` seconds, where that is above 0. Another seed, another turbulence.
    #[must_use]
    pub fn new(size: f64, drift: DVec3, speed: f64, period: f64, seed: u64) -> Self {
        // Length and speed of each, as shares of the longest one's.
        let mut shares = [(1.0, 1.0); WAVES];
        for j in 1..WAVES {
            let (length, slower) = shares[j - 1];
            shares[j] = (length * SHRINKS, slower * SLOWS);
        }
        // A sine's mean square is a half.
        let energy: f64 = shares.iter().map(|(_, slower)| 0.5 * slower * slower).sum();
        let waves = std::array::from_fn(|j| {
            let (length, slower) = shares[j];
            let random = |k: u64| unit(seed, j as u64 * 8 + k + 0x5EED);
            let along = sphere(random(0), random(1));
            let across = along
                .cross(sphere(random(2), random(3)))
                .normalize_or(along.any_orthonormal_vector());
            let number = along / (size * length);
            // An eddy turns once while the air in it goes twice its length.
            let rate = number.dot(drift) + 0.5 * speed * slower * number.length();
            Wave {
                number,
                rate: in_turns(rate, period),
                phase: random(5),
                amplitude: across * (slower / energy.sqrt()),
            }
        });
        Self { waves }
    }

    #[inline(always)]
    fn velocity<T: Number>(&self, at: Vec3<T>, time: f64) -> Vec3<T> {
        let mut sum = Vec3::zero();
        for wave in &self.waves {
            let turns = Vec3::all(wave.number).dot(at) + T::splat(wave.phase - wave.rate * time);
            sum += Vec3::all(wave.amplitude).scale(sine_of_turns(turns));
        }
        sum
    }
}

/// The rate (1/s) that is nearest and has a whole number of turns in `period` seconds, where that is above 0.
pub(crate) fn in_turns(rate: f64, period: f64) -> f64 {
    if period > 0.0 {
        (rate * period).round() / period
    } else {
        rate
    }
}

impl Stream {
    /// Whether its numbers are finite and in their ranges.
    pub(crate) fn is_valid(&self) -> bool {
        let has_shape = match &self.flow {
            Flow::Source { radius } | Flow::Vortex { radius } | Flow::Wake { radius } => {
                radius.is_finite() && *radius >= 1e-3
            }
            Flow::Turbulence(turbulence) => {
                let is_finite = |wave: &Wave| wave.number.is_finite() && wave.rate.is_finite();
                turbulence.waves.iter().all(is_finite)
            }
        };
        has_shape
            && self.speed.iter().all(|speed| speed.is_finite())
            && self.center.iter().all(|center| center.is_finite())
            && (self.axis.length_squared() - 1.0).abs() <= 1e-3
    }

    /// Whether it stays the same from the start of the step to its end, and in the next one where its numbers do.
    pub(crate) fn is_steady(&self) -> bool {
        let blows = self.speed != [0.0; 2];
        self.speed[0] == self.speed[1]
            && self.center[0] == self.center[1]
            && !(blows && matches!(self.flow, Flow::Turbulence(_)))
    }

    /// Numbers that tell it from another, at the step's end.
    pub(crate) fn numbers(&self) -> [f64; 8] {
        let radius = match &self.flow {
            Flow::Source { radius } => *radius,
            Flow::Vortex { radius } => 1e3 + radius,
            Flow::Wake { radius } => 1e6 + radius,
            Flow::Turbulence(turbulence) => turbulence.waves[0].number.x,
        };
        let (center, axis) = (self.center[1], self.axis);
        [
            radius,
            self.speed[1],
            center.x,
            center.y,
            center.z,
            axis.x,
            axis.y,
            axis.z,
        ]
    }

    /// The air's velocity in it at a place in the world, at `share` of a step and at `time` seconds.
    #[inline(always)]
    pub(crate) fn velocity<T: Number>(&self, at: Vec3<T>, share: f64, time: f64) -> Vec3<T> {
        let speed = self.speed[0] + (self.speed[1] - self.speed[0]) * share;
        if speed == 0.0 {
            return Vec3::zero();
        }
        let center = self.center[0] + (self.center[1] - self.center[0]) * share;
        let (away, axis) = (at - Vec3::all(center), Vec3::all(self.axis));
        let along = axis.dot(away);
        match &self.flow {
            Flow::Source { radius } => {
                let distance = away.length_squared().sqrt();
                let least = T::splat(*radius);
                let reach = T::choose(distance.less(least), least, distance);
                away.scale(T::splat(speed * radius * radius) / (reach * reach * reach))
            }
            Flow::Vortex { radius } => {
                let aside = away - axis.scale(along);
                let square = aside.length_squared() + T::splat(radius * radius);
                axis.cross(aside)
                    .scale(T::splat(2.0 * speed * radius) / square)
            }
            Flow::Turbulence(turbulence) => turbulence.velocity(at, time).scale(T::splat(speed)),
            Flow::Wake { radius } => {
                // Stokes' stream function K(x) r^2 / (r^2 + w(x)^2), where K rises to DEFICIT from before the body to behind it.
                let aside = away - axis.scale(along);
                let (r2, radius2) = (aside.length_squared(), T::splat(radius * radius));
                let reach = (along * along + radius2).sqrt();
                let behind = T::splat(1.0) + along / reach;
                let full = T::splat(0.5 * DEFICIT * speed * radius * radius);
                let missing = full * behind;
                let rises = full * radius2 / (reach * reach * reach);
                let width2 = radius2 + T::splat(SPREAD * radius) * (along + reach);
                let widens = T::splat(SPREAD * radius) * behind;
                let sum = r2 + width2;
                let inwards = missing * widens / (sum * sum) - rises / sum;
                let slower = T::splat(2.0) * missing * width2 / (sum * sum);
                -(axis.scale(slower) + aside.scale(inwards))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn stream(flow: Flow) -> Stream {
        Stream {
            flow,
            speed: [3.0; 2],
            center: [DVec3::new(0.1, -0.2, 0.3); 2],
            axis: DVec3::new(0.6, 0.0, 0.8),
        }
    }

    fn all() -> [Stream; 4] {
        let turbulence = Turbulence::new(0.4, DVec3::X, 3.0, 0.0, 5);
        [
            stream(Flow::Source { radius: 0.2 }),
            stream(Flow::Vortex { radius: 0.2 }),
            stream(Flow::Turbulence(Box::new(turbulence))),
            stream(Flow::Wake { radius: 0.2 }),
        ]
    }

    fn at(stream: &Stream, place: DVec3, time: f64) -> DVec3 {
        stream.velocity(Vec3::splat(place), 1.0, time).get(2)
    }

    fn divergence(stream: &Stream, place: DVec3, time: f64) -> f64 {
        let h = 1e-4;
        let slope = |axis: DVec3| {
            let [ahead, back] = [h, -h].map(|by| at(stream, place + axis * by, time));
            (ahead - back).dot(axis) / (2.0 * h)
        };
        slope(DVec3::X) + slope(DVec3::Y) + slope(DVec3::Z)
    }

    proptest! {
        #[test]
        fn no_stream_makes_air_or_loses_it(
            place in prop::array::uniform3(-2.0..2.0_f64),
            time in 0.0..1000.0_f64,
        ) {
            let place = DVec3::from(place);
            for stream in all() {
                let from_middle = place.distance(stream.center[0]);
                if matches!(stream.flow, Flow::Source { .. }) && from_middle < 0.21 {
                    continue;
                }
                // Slopes are up to speed over size, 15 / s; waves are parabolas within 0.1 %, whose corners the difference rounds off.
                let found = divergence(&stream, place, time);
                prop_assert!(found.abs() < 2e-3, "{stream:?} at {place}: {found}");
            }
        }

        #[test]
        fn a_stream_is_continuous(
            place in prop::array::uniform3(-1.0..1.0_f64),
            time in 0.0..1000.0_f64,
        ) {
            let place = DVec3::from(place);
            for stream in all() {
                let now = at(&stream, place, time);
                prop_assert!(now.is_finite());
                prop_assert!((at(&stream, place + DVec3::splat(1e-6), time) - now).length() < 1e-3);
                prop_assert!((at(&stream, place, time + 1e-6) - now).length() < 1e-3);
            }
        }
    }

    #[test]
    fn speeds_are_where_they_are_said_to_be() {
        let [source, vortex, _, wake] = all();
        let (center, axis) = (source.center[0], source.axis);
        let aside = DVec3::Y;
        assert!((at(&source, center + aside * 0.2, 0.0) - aside * 3.0).length() < 1e-12);
        assert!((at(&source, center + aside * 0.4, 0.0) - aside * 0.75).length() < 1e-12);
        let turned = at(&vortex, center + aside * 0.2 + axis, 0.0);
        assert!((turned - axis.cross(aside) * 3.0).length() < 1e-12);
        // Behind the body little wind is left, before it and far aside all of it.
        let left = |place: DVec3| 3.0 + at(&wake, center + place, 0.0).dot(axis);
        assert!(
            (0.2..0.6).contains(&left(axis * 0.2)),
            "{}",
            left(axis * 0.2)
        );
        assert!(
            (1.8..2.1).contains(&left(axis * 2.0)),
            "{}",
            left(axis * 2.0)
        );
        assert!(left(axis * -0.6) > 2.6 && left(aside * 1.0 + axis * 0.2) > 2.9);
    }

    #[test]
    fn a_wake_keeps_the_momentum_that_is_missing() {
        let wake = stream(Flow::Wake { radius: 0.1 });
        let aside = wake.axis.any_orthonormal_vector();
        // The flow that is missing through a plane, by rings.
        let missing = |behind: f64| -> f64 {
            let rings = (0..20_000).map(|i| (f64::from(i) + 0.5) * 1e-3);
            let ring = |r: f64| {
                let place = wake.center[0] + wake.axis * behind + aside * r;
                -at(&wake, place, 0.0).dot(wake.axis) * std::f64::consts::TAU * r * 1e-3
            };
            rings.map(ring).sum()
        };
        let (near, far) = (missing(1.0), missing(3.0));
        assert!((near / far - 1.0).abs() < 0.01, "{near} {far}");
    }

    #[test]
    fn turbulence_has_the_speed_asked_for_and_no_mean() {
        for seed in 0..5 {
            let turbulence = Turbulence::new(0.4, DVec3::X * 2.0, 3.0, 0.0, seed);
            let stream = stream(Flow::Turbulence(Box::new(turbulence)));
            let (mut mean, mut square, count) = (DVec3::ZERO, 0.0, 20_000);
            for i in 0..count {
                let place = DVec3::new(unit(1, i), unit(2, i), unit(3, i)) * 60.0;
                let velocity = at(&stream, place, unit(4, i) * 1000.0);
                mean += velocity / count as f64;
                square += velocity.length_squared() / count as f64;
            }
            assert!((square.sqrt() - 3.0).abs() < 0.06, "{}", square.sqrt());
            assert!(mean.length() < 0.06, "{mean}");
        }
    }

    #[test]
    fn turbulence_comes_again_after_its_period() {
        let turbulence = Turbulence::new(0.3, DVec3::new(1.0, 0.2, 0.0), 2.0, 1.5, 9);
        let stream = stream(Flow::Turbulence(Box::new(turbulence)));
        for i in 0..50 {
            let place = DVec3::new(unit(1, i), unit(2, i), unit(3, i));
            let time = unit(4, i) * 10.0;
            let (now, later) = (at(&stream, place, time), at(&stream, place, time + 1.5));
            assert!((now - later).length() < 1e-9);
            assert!((now - at(&stream, place, time + 0.7)).length() > 1e-3);
        }
    }

    #[test]
    fn the_order_of_times_is_nothing_to_it() {
        let turbulence = || Turbulence::new(0.3, DVec3::X, 2.0, 0.0, 9);
        let times: Vec<f64> = (0..40).map(|i| f64::from(i) * 0.11).collect();
        let blow = |times: &mut dyn Iterator<Item = &f64>| -> Vec<DVec3> {
            let stream = stream(Flow::Turbulence(Box::new(turbulence())));
            times.map(|time| at(&stream, DVec3::ONE, *time)).collect()
        };
        let mut backwards = blow(&mut times.iter().rev());
        backwards.reverse();
        assert_eq!(blow(&mut times.iter()), backwards);
    }
}
