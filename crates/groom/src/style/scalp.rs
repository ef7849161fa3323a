//! The part of the head that carries hair.

use super::line::Line;
use crate::shell::{Place, between, direction};
use glam::Vec3;

/// Where hair grows: the hairline, the whorl that it turns around, the parting.
#[derive(Clone, Debug, PartialEq)]
pub struct Scalp {
    /// The hairline's places from the forehead (longitude 0) to the nape (180), longitudes ascending;
    /// the other side is its image.
    pub hairline: Vec<Place>,
    /// The place that hair turns around.
    pub whorl: Place,
    /// The parting's places, from front to back.
    pub parting: Vec<Place>,
}

impl Default for Scalp {
    /// A drawn character's: down to the temples, above and behind the ears, to the nape; the whorl a
    /// little behind the top, the parting in the middle.
    fn default() -> Self {
        let place = |(longitude, latitude)| Place {
            longitude,
            latitude,
        };
        const HAIRLINE: [(f32, f32); 10] = [
            (0.0, 42.0),
            (22.0, 40.0),
            (42.0, 33.0),
            (58.0, 22.0),
            (74.0, 12.0),
            (92.0, 6.0),
            (106.0, -8.0),
            (124.0, -26.0),
            (150.0, -40.0),
            (180.0, -45.0),
        ];
        Self {
            hairline: HAIRLINE.map(place).to_vec(),
            whorl: place((180.0, 74.0)),
            parting: [(0.0, 46.0), (0.0, 68.0), (180.0, 82.0)]
                .map(place)
                .to_vec(),
        }
    }
}

impl Scalp {
    /// The latitude of the hairline at a longitude, both in degrees.
    #[must_use]
    pub fn hairline_at(&self, longitude: f32) -> f32 {
        let around = longitude.rem_euclid(360.0);
        let longitude = around.min(360.0 - around);
        let line = &self.hairline;
        let Some(next) = line.iter().position(|place| place.longitude >= longitude) else {
            return line.last().map_or(0.0, |place| place.latitude);
        };
        if next == 0 {
            return line[0].latitude;
        }
        let (a, b) = (line[next - 1], line[next]);
        let t = (longitude - a.longitude) / (b.longitude - a.longitude);
        a.latitude + (b.latitude - a.latitude) * t
    }

    /// Whether hair grows at a place.
    #[must_use]
    pub fn contains(&self, place: Place) -> bool {
        place.latitude >= self.hairline_at(place.longitude)
    }

    /// The direction at share `along` (0 to 1) of a line, on the character's left (`side` 1) or its
    /// right (-1). Whorl and parting are where they are on both sides. A line without places is the whorl.
    pub(super) fn direction(&self, line: &Line, along: f32, side: f32) -> Vec3 {
        let mirrored = |way: Vec3| way * Vec3::new(side, 1.0, 1.0);
        match line {
            Line::Through(places) if !places.is_empty() => mirrored(on_line(places, along)),
            Line::Parting if !self.parting.is_empty() => on_line(&self.parting, along),
            Line::Whorl | Line::Through(_) | Line::Parting => direction(self.whorl),
            Line::Hairline { from, to } => {
                let longitude = from + (to - from) * along;
                mirrored(direction(Place {
                    longitude,
                    latitude: self.hairline_at(longitude),
                }))
            }
        }
    }
}

/// The direction at share `along` (0 to 1) of a line through these places, one at least, which are evenly spaced in
/// `along`.
pub(super) fn on_line(line: &[Place], along: f32) -> Vec3 {
    let directions = |i: usize| direction(line[i.min(line.len() - 1)]);
    let at = along.clamp(0.0, 1.0) * (line.len() - 1) as f32;
    let first = (at as usize).min(line.len().saturating_sub(2));
    let t = at - first as f32;
    between(directions(first), directions(first + 1), t)
}
