//! Bodies of presets and scripts, which hair is kept out of beside head and shoulders: where they are at a time, and what is drawn of them.

mod clear;
mod drawn;
pub(crate) mod forms;
mod load;
mod pieces;
mod section;

pub(crate) use clear::{Followed, Gap, clear, followed, gaps};
pub(crate) use load::{check, load};
pub(crate) use section::NamedKey;
pub use section::{BODIES, BodyKeySection, BodyOn, BodySection, BodyShape, NamedBody};

use crate::dynamics::Reach;
use crate::painted::PaintedMesh;
use crate::posture::Posture;
use crate::script::turned;
use crate::skeleton::after;
use forms::Forms;
use glam::{DVec3, Vec3};
use hair_sim::{Collider, Pose, Shape, key_weights};

/// A body, and how it moves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Body {
    pub section: BodySection,
    /// Where its middle is while nothing moves, m.
    middle: DVec3,
    /// About its middle.
    own: Own,
    /// Times ascending.
    keys: Vec<Key>,
    /// That files of its sequence are missing.
    gap_note: Option<String>,
}

#[derive(Clone, Debug, PartialEq)]
enum Own {
    Sphere { radius: f64 },
    Capsule { half: DVec3, radius: f64 },
    Mesh(Forms),
}

/// Where a body is at a time, from where it is at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    /// Seconds.
    time: f64,
    /// m.
    shift: DVec3,
    /// Degrees: to its left, up, towards its left shoulder.
    turn: DVec3,
    size: f64,
}

impl Key {
    /// Whether the body stands at both alike.
    fn is_alike(&self, other: &Self) -> bool {
        Self {
            time: other.time,
            ..*self
        } == *other
    }
}

/// Where a body's own space has come to, and how many times as large it is.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    pose: Pose,
    size: f64,
}

impl Body {
    /// Whether it moves or changes by itself.
    pub fn moves(&self) -> bool {
        !self.keys.is_empty() || self.deforms()
    }

    fn deforms(&self) -> bool {
        matches!(&self.own, Own::Mesh(forms) if forms.deforms())
    }

    /// What is odd about it, for those who listed it.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        self.gap_note.iter().cloned().chain(self.open_note())
    }

    /// That its mesh has no inside, at least in one of its forms.
    fn open_note(&self) -> Option<String> {
        let Own::Mesh(forms) = &self.own else {
            return None;
        };
        let file = self.section.file.as_deref().unwrap_or_default();
        let open = forms.first_open()?;
        let form = match forms.deforms() {
            true => format!(" in its form {}", open + 1),
            false => String::new(),
        };
        Some(format!(
            "bodies: the mesh of `{file}` is open{form}, and hair is kept out of what a mesh closes in: close it, or give it a thickness"
        ))
    }

    /// Whether it is, at one of the script's own times (seconds), where it is at the other; what changes by itself, nearly so.
    pub fn is_alike(&self, one: f64, other: f64) -> bool {
        let [one, other] = [one, other].map(|time| self.key_at(time));
        let turn = (one.turn - other.turn).to_array();
        let whole = |degrees: f64| {
            let rest = degrees.rem_euclid(360.0);
            rest.min(360.0 - rest) < 0.01
        };
        one.shift.abs_diff_eq(other.shift, 1e-5)
            && turn.into_iter().all(whole)
            && (one.size - other.size).abs() < 1e-4
    }

    /// Whether its mesh has, at one of the script's own times (seconds), the form that it has at the other.
    pub fn has_one_form(&self, one: f64, other: f64) -> bool {
        match &self.own {
            Own::Mesh(forms) => forms.are_alike(one, other),
            _ => true,
        }
    }

    /// What the keys' spline says of a time.
    fn key_at(&self, time: f64) -> Key {
        let mut key = Key {
            time,
            shift: DVec3::ZERO,
            turn: DVec3::ZERO,
            size: if self.keys.is_empty() { 1.0 } else { 0.0 },
        };
        if self.keys.is_empty() {
            return key;
        }
        let time_of = |key: usize| self.keys[key].time;
        let is_held = |key: usize| self.keys[key].is_alike(&self.keys[key + 1]);
        for (index, weight) in key_weights(self.keys.len(), time_of, is_held, time) {
            let own = &self.keys[index];
            key.shift += own.shift * weight;
            key.turn += own.turn * weight;
            key.size += own.size * weight;
        }
        // A spline may go beyond its keys.
        key.size = key.size.max(1e-3);
        key
    }

    /// At the script's own `time` (seconds), of a figure that stands so.
    fn at(&self, time: f64, posture: &Posture) -> Placed {
        let key = self.key_at(time);
        let own = Pose {
            rotation: turned(key.turn),
            translation: self.middle + key.shift,
        };
        let under = match self.section.on {
            BodyOn::World => {
                return Placed {
                    pose: own,
                    size: key.size,
                };
            }
            BodyOn::Head => posture.head,
            BodyOn::Shoulders => posture.shoulders,
        };
        Placed {
            pose: after(own, under),
            size: key.size,
        }
    }

    /// The body in a step between two of the script's own times (seconds), at which the figure stands so.
    pub fn collider(&self, times: [f64; 2], postures: [&Posture; 2]) -> Collider<'_> {
        let placed = [0, 1].map(|i| self.at(times[i], postures[i]));
        let [was, shape] = [0, 1].map(|i| self.shape(times[i], placed[i].size));
        let [before, now] = [0, 1].map(|i| {
            let Placed { pose, size } = placed[i];
            let translation = match &self.own {
                // Its shape is about the middle of its form.
                Own::Mesh(forms) => {
                    pose.rotation * (forms.middle(times[i]) * size) + pose.translation
                }
                _ => pose.translation,
            };
            Pose {
                translation,
                ..pose
            }
        });
        let changes = placed[0].size != placed[1].size || self.deforms();
        Collider {
            shape,
            before,
            now,
            was: changes.then_some(was),
        }
    }

    /// Whether any of it may be within reach of hair in such a step; rather too often than too seldom.
    pub fn comes_within(&self, reach: Reach, times: [f64; 2], postures: [&Posture; 2]) -> bool {
        let (mut radius, mut from_hair) = (0.0_f64, [DVec3::ZERO; 2]);
        for (from_hair, (time, posture)) in
            from_hair.iter_mut().zip(times.into_iter().zip(postures))
        {
            let (middle, own) = self.ball(time, posture);
            let head = posture.head;
            radius = radius.max(own);
            *from_hair = middle - (head.rotation * reach.around + head.translation);
        }
        let [start, end] = from_hair;
        // On the way between two places nothing is nearer than this, however it goes there straight.
        let nearest = 0.5 * (start.length() + end.length() - start.distance(end));
        // What is no number is for the solver to tell.
        let is_beyond = nearest > reach.radius_m + radius;
        !is_beyond
    }

    /// A ball that all of it is in at the script's own `time` (seconds), of a figure that stands so: its middle and its radius, m.
    pub fn ball(&self, time: f64, posture: &Posture) -> (DVec3, f64) {
        let Placed { pose, size } = self.at(time, posture);
        let (middle, radius) = match &self.own {
            Own::Sphere { radius } => (DVec3::ZERO, *radius),
            Own::Capsule { half, radius } => (DVec3::ZERO, half.length() + radius),
            Own::Mesh(forms) => forms.ball(time),
        };
        (
            pose.rotation * (middle * size) + pose.translation,
            radius * size,
        )
    }

    /// Its shape at the script's own `time` (seconds), so many times as large.
    fn shape(&self, time: f64, size: f64) -> Shape<'_> {
        match &self.own {
            Own::Sphere { radius } => Shape::Sphere {
                center: DVec3::ZERO,
                radius: radius * size,
            },
            Own::Capsule { half, radius } => Shape::Capsule {
                from: -*half * size,
                to: *half * size,
                radius: radius * size,
            },
            Own::Mesh(forms) => {
                let (from, to, share) = forms.between(time);
                let [from, to] = [from, to].map(|form| forms.grid(form));
                Shape::Form {
                    from,
                    to,
                    share,
                    size,
                }
            }
        }
    }

    /// What is drawn of it at the script's own `time` (seconds); nothing where it has no colour.
    pub fn drawn(&self, time: f64, posture: &Posture) -> Option<PaintedMesh> {
        let color = self.section.color?;
        let Placed { pose, size } = self.at(time, posture);
        let (positions, normals, triangles) = match &self.own {
            Own::Sphere { radius } => drawn::capsule(DVec3::ZERO, *radius),
            Own::Capsule { half, radius } => drawn::capsule(*half, *radius),
            Own::Mesh(forms) => forms.shape(time),
        };
        let placed =
            |p: &Vec3| (pose.rotation * (p.as_dvec3() * size) + pose.translation).as_vec3();
        let normals = normals.iter().map(|n| pose.rotation.as_quat() * *n);
        Some(drawn::painted(
            positions.iter().map(placed).collect(),
            normals.collect(),
            triangles,
            color,
        ))
    }
}
