//! Wind: a steady stream, and gusts that ride on it.

use glam::DVec3;

use super::stream::{Stream, in_turns};
use crate::{
    lanes::{Number, Vec3},
    math::{cos, sin},
};

/// Number of waves that gusts are made of.
const WAVES: usize = 5;

/// The motion of the air, in world axes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wind {
    /// The mean velocity in m/s.
    pub steady: DVec3,
    /// The speed of gusts in m/s, as root mean square over space and time.
    pub gust: f64,
    /// The size of gusts in m: their mean wavelength. At least 1e-3.
    pub size: f64,
    /// Another seed, other gusts.
    pub seed: u64,
    /// Seconds after which gusts come again; 0 never.
    pub period: f64,
}

impl Default for Wind {
    fn default() -> Self {
        Self {
            steady: DVec3::ZERO,
            gust: 0.0,
            size: 0.5,
            seed: 0,
            period: 0.0,
        }
    }
}

/// How long the wind has blown, and how far it has carried gusts and they have gone by themselves until then. Their phases hang on these ways: on time and
/// the wind's speed of the moment they would race while that changes, the more the later it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Blown {
    /// In s.
    pub time: f64,
    /// In m.
    pub way: DVec3,
    /// In m.
    pub own_way: f64,
}

impl Blown {
    /// After `seconds` more of a wind of this mean.
    #[inline(always)]
    pub fn after(self, seconds: f64, mean: &Wind) -> Self {
        Self {
            time: self.time + seconds,
            way: self.way + mean.steady * seconds,
            own_way: self.own_way + mean.gust.abs() * seconds,
        }
    }
}

/// The gusts at one time: waves across their own direction (so that air is neither made nor lost), which the steady
/// wind carries along (Taylor's frozen turbulence) and which change by themselves. Continuous with all their derivatives in
/// space and time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gusts<'a> {
    steady: DVec3,
    waves: [Wave; WAVES],
    /// Whether there is any wind; any gust.
    pub blows: bool,
    gusts: bool,
    streams: &'a [Stream],
    share: f64,
    time: f64,
}

#[derive(Clone, Copy, Debug)]
struct Wave {
    /// Turns per metre.
    number: DVec3,
    /// In turns.
    phase: f64,
    /// In m/s.
    amplitude: DVec3,
}

impl Wind {
    pub(crate) fn is_finite(&self) -> bool {
        self.steady.is_finite()
            && self.gust.is_finite()
            && self.size.is_finite()
            && self.size >= 1e-3
            && self.period.is_finite()
    }

    /// The air with these streams, at `share` of the step.
    #[inline(always)] // made where it is kept: it is large
    pub(crate) fn air<'a>(&self, blown: &Blown, streams: &'a [Stream], share: f64) -> Gusts<'a> {
        let blows = |stream: &Stream| stream.speed != [0.0; 2];
        let mut waves = [Wave {
            number: DVec3::ZERO,
            phase: 0.0,
            amplitude: DVec3::ZERO,
        }; WAVES];
        let gusts = self.gust != 0.0;
        if gusts {
            for (j, wave) in waves.iter_mut().enumerate() {
                let random = |k: u64| unit(self.seed, j as u64 * 8 + k);
                let along = sphere(random(0), random(1));
                let other = sphere(random(2), random(3));
                let across = along
                    .cross(other)
                    .normalize_or(along.any_orthonormal_vector());
                // Wavelengths from 0.6 to 1.6 of the size.
                let number = along / (self.size * (0.6 + (j as f64 + random(4)) / WAVES as f64));
                let turns =
                    |way: DVec3, own_way: f64| number.dot(way) + 0.5 * number.length() * own_way;
                let gone = if self.period > 0.0 {
                    blown.time * in_turns(turns(self.steady, self.gust.abs()), self.period)
                } else {
                    turns(blown.way, blown.own_way)
                };
                let phase = random(5) - gone;
                // A sine's mean square is a half.
                let speed = self.gust * (2.0 / WAVES as f64).sqrt();
                *wave = Wave {
                    number,
                    phase: phase - phase.floor(),
                    amplitude: across * speed,
                };
            }
        }
        Gusts {
            steady: self.steady,
            waves,
            blows: gusts || self.steady != DVec3::ZERO || streams.iter().any(blows),
            gusts,
            streams,
            share,
            time: blown.time,
        }
    }
}

impl Gusts<'_> {
    /// The air's velocity at a place in the world.
    #[inline(always)]
    pub(crate) fn velocity<T: Number>(&self, at: Vec3<T>) -> Vec3<T> {
        let mut sum = Vec3::all(self.steady);
        if self.gusts {
            for wave in &self.waves {
                let turns = Vec3::all(wave.number).dot(at) + T::splat(wave.phase);
                sum += Vec3::all(wave.amplitude).scale(sine_of_turns(turns));
            }
        }
        for stream in self.streams {
            sum += stream.velocity(at, self.share, self.time);
        }
        sum
    }
}

/// sin(2 pi x) within 0.1 %, continuous: a gust needs no more.
#[inline(always)]
pub(super) fn sine_of_turns<T: Number>(x: T) -> T {
    // Adding this leaves no fraction: rounding to the nearest whole number, on every processor.
    let round = T::splat(6_755_399_441_055_744.0);
    let r = x - ((x + round) - round);
    // sin(2 pi r) = 8 r - 16 r |r|, a parabola, and a second one of it: odd, exact at the quarters.
    let p = r * T::splat(8.0) - r * r.abs() * T::splat(16.0);
    let q = p * p.abs();
    p * T::splat(0.775_160_7) + q * T::splat(0.224_839_3)
}

/// A hash of (seed, index) in 0 to 1 (SplitMix64, Steele et al. 2014).
pub(super) fn unit(seed: u64, index: u64) -> f64 {
    let mut z = seed.wrapping_add((index + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (z ^ (z >> 31)) as f64 / u64::MAX as f64
}

/// A direction, uniform on the sphere, from two numbers in 0 to 1.
pub(super) fn sphere(u: f64, v: f64) -> DVec3 {
    let z = 2.0 * u - 1.0;
    let level = (1.0 - z * z).max(0.0).sqrt();
    let angle = std::f64::consts::TAU * v;
    DVec3::new(level * cos(angle), z, level * sin(angle))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wind() -> Wind {
        Wind {
            steady: DVec3::new(3.0, 0.0, 1.0),
            gust: 2.0,
            seed: 7,
            ..Wind::default()
        }
    }

    /// The air after so many seconds of a wind.
    fn air(wind: &Wind, seconds: f64) -> Gusts<'static> {
        wind.air(&Blown::default().after(seconds, wind), &[], 1.0)
    }

    #[test]
    fn gusts_are_continuous_in_space_and_time() {
        let wind = wind();
        for i in 0..2000 {
            let t = f64::from(i) * 0.37;
            let at = DVec3::new(t, -0.2 * t, 0.6 * t) * 0.1;
            let velocity = |t: f64, at: DVec3| air(&wind, t).velocity(Vec3::splat(at)).get(0);
            let now = velocity(t, at);
            assert!((velocity(t + 1e-5, at) - now).length() < 1e-2);
            assert!((velocity(t, at + DVec3::splat(1e-5)) - now).length() < 1e-2);
        }
    }

    #[test]
    fn gusts_have_their_speed_and_no_mean() {
        let wind = wind();
        let (mut mean, mut square) = (DVec3::ZERO, 0.0);
        let count = 20_000;
        for i in 0..count {
            let at = DVec3::new(unit(1, i) * 50.0, unit(2, i) * 50.0, unit(3, i) * 50.0);
            let gust = air(&wind, unit(4, i) * 1000.0)
                .velocity(Vec3::splat(at))
                .get(3)
                - wind.steady;
            mean += gust;
            square += gust.length_squared();
        }
        let rms = (square / count as f64).sqrt();
        assert!((rms - 2.0).abs() < 0.1, "{rms}");
        assert!((mean / count as f64).length() < 0.1);
    }

    #[test]
    fn the_same_seed_blows_the_same() {
        let a = air(&wind(), 5.0).velocity(Vec3::splat(DVec3::ONE));
        assert_eq!(a, air(&wind(), 5.0).velocity(Vec3::splat(DVec3::ONE)));
        let other = Wind { seed: 8, ..wind() };
        assert_ne!(a, air(&other, 5.0).velocity(Vec3::splat(DVec3::ONE)));
    }

    #[test]
    fn gusts_are_no_quicker_while_the_wind_rises_late() {
        // The quickest change of the gusts at a place, in m/s^2, while the wind rises by so much in two seconds after so many of an even one.
        let quickest = |from: f64, rises: f64| {
            let at = |seconds: f64| Wind {
                steady: DVec3::X * (2.0 + rises * seconds / 2.0),
                gust: 2.0,
                ..Wind::default()
            };
            let dt = 1e-3;
            let mut blown = Blown::default().after(from, &at(0.0));
            let mut last = None;
            let mut quickest = 0.0_f64;
            for step in 0..2000 {
                let now = at(f64::from(step) * dt);
                blown = blown.after(dt, &now);
                let air = now.air(&blown, &[], 1.0);
                let gust = air.velocity(Vec3::splat(DVec3::ZERO)).get(0) - now.steady;
                if let Some(last) = last.replace(gust) {
                    quickest = quickest.max((gust - last).length() / dt);
                }
            }
            quickest
        };
        for from in [0.0, 2.0, 100.0] {
            let [even, rising] = [0.0, 4.0].map(|rises| quickest(from, rises));
            assert!(rising < 3.0 * even, "{from} s: {rising} of {even}");
        }
    }
}
