//! Winds of a script that have a place or a shape, as the solver's streams.

use crate::hand::Driver;
use crate::placement::Placement;
use crate::script::{MotionScript, Wind, WindKind};
use glam::DVec3;
use hair_sim::{Flow, Stream, Turbulence};
use render::Head;

/// The radius of the ball that keeps the wind from what is behind a head, head heights.
const HEAD_RADIUS: f64 = 0.42;

/// Seconds after which gusts come again; 0 never.
pub(super) fn period(script: &MotionScript) -> f64 {
    script.period.filter(|_| script.closes).unwrap_or(0.0)
}

/// The streams of a driver between two times (seconds), about a head that stands there at rest, in its own axes.
pub(super) fn streams(
    driver: Driver,
    placement: &Placement,
    head: Head,
    times: [f64; 2],
) -> Vec<Stream> {
    let script = driver.script;
    let has_place = |wind: &&Wind| wind.kind != WindKind::Direction;
    let streams = script.winds.iter().filter(has_place).map(|wind| {
        let strengths = times.map(|time| script.strength_of(wind, script.within(time)));
        stream(wind, strengths, placement, head, period(script))
    });
    let mut streams: Vec<Stream> = streams.collect();
    streams.extend(
        script
            .has_wake
            .then(|| wake(driver, placement, head, times)),
    );
    streams
}

fn stream(
    wind: &Wind,
    strengths: [f64; 2],
    placement: &Placement,
    head: Head,
    period: f64,
) -> Stream {
    let height_m = f64::from(head.height_m);
    let radius = wind.radius * height_m;
    let axis = placement.own_direction(wind.direction);
    let flow = match wind.kind {
        // A direction has no place: it is the solver's wind.
        WindKind::Direction | WindKind::Point => Flow::Source { radius },
        WindKind::Vortex => Flow::Vortex { radius },
        WindKind::Turbulence => Flow::Turbulence(Box::new(Turbulence::new(
            wind.size * height_m,
            axis * wind.drift,
            wind.speed,
            period,
            u64::from(wind.seed),
        ))),
    };
    let place = placement.own_direction(wind.place) * height_m;
    Stream {
        flow,
        speed: strengths.map(|strength| wind.speed * strength),
        center: [head.center.as_dvec3() + place; 2],
        axis,
    }
}

/// What the head keeps off.
fn wake(driver: Driver, placement: &Placement, head: Head, times: [f64; 2]) -> Stream {
    let height_m = f64::from(head.height_m);
    let winds = times.map(|time| placement.own_direction(driver.wind_at(time).0));
    let shifts = times.map(|time| driver.head_at(time).shift * height_m);
    Stream {
        flow: Flow::Wake {
            radius: HEAD_RADIUS * height_m,
        },
        speed: winds.map(DVec3::length),
        center: shifts.map(|shift| head.center.as_dvec3() + shift),
        axis: winds[1].try_normalize().unwrap_or(DVec3::X),
    }
}
