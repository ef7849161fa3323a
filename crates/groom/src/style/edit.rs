//! Clumps changed or drawn one by one.

use crate::shell::{Place, Shell, direction};
use crate::trig::sin_cos_degrees;
use glam::Vec3;

/// A change of one clump of a zone.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    /// The zone's name.
    pub zone: String,
    /// The clump's number in the zone, 0 first; rows follow one another.
    pub clump: u32,
    /// Whether the clump of the mirrored half is meant.
    pub mirrored: bool,
    /// Takes the clump away.
    pub remove: bool,
    /// Its size, as a factor.
    pub size: f32,
    /// Its hanging length, as a factor.
    pub length: f32,
    /// How far it is turned around the head: towards the character's left, and up; degrees.
    pub turn: [f32; 2],
    /// How much higher its tip stands above the skin than it would, head heights.
    pub raise: f32,
}

impl Edit {
    /// Moves a clump's points.
    pub(super) fn apply(&self, points: &mut [Vec3], shell: &Shell) {
        let last = (points.len().max(2) - 1) as f32;
        for (index, point) in points.iter_mut().enumerate() {
            let way = *point - shell.center();
            // Up is a turn about the axis across the head that the point looks along.
            let flat = way.with_y(0.0).normalize_or(Vec3::Z);
            let east = Vec3::Y.cross(flat);
            let up = turned(way, -east, self.turn[1]);
            let turned = turned(up, Vec3::Y, self.turn[0]);
            let lift = self.raise * shell.height() * index as f32 / last;
            *point = shell.center() + turned + turned.normalize_or(Vec3::Y) * lift;
        }
    }
}

/// A clump drawn by hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Places and heights above the skin (head heights), from root to tip.
    pub points: Vec<(Place, f32)>,
    /// Radius at its full size, 1/300 head heights.
    pub size: f32,
    /// Also on the head's other side.
    pub mirror: bool,
}

impl Drawn {
    /// The points on a head; `side` is 1 on the character's left, -1 on its right.
    pub(super) fn points(&self, side: f32, shell: &Shell) -> Vec<Vec3> {
        let on_head = |&(place, lift): &(Place, f32)| {
            shell.above(direction(place) * Vec3::new(side, 1.0, 1.0), lift)
        };
        self.points.iter().map(on_head).collect()
    }
}

/// A vector turned about a unit axis by an angle in degrees (Rodrigues' formula).
fn turned(vector: Vec3, axis: Vec3, degrees: f32) -> Vec3 {
    let (sin, cos) = sin_cos_degrees(degrees);
    vector * cos + axis.cross(vector) * sin + axis * (axis.dot(vector) * (1.0 - cos))
}
