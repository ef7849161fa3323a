//! Axes and units of files that say nothing about them: guessed, said, and overridden by the caller.

mod onto_head;

use glam::{DVec3, Vec3};
use hair_sim::Strands;
use serde::{Deserialize, Serialize};

use crate::head::{HeadFrame, bounds};
use crate::mesh::Mesh;
use crate::sphere::{self, Sphere, without_outliers};

/// Which of a file's axes points up. The systems are right-handed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Axes {
    /// Y up, the character faces +Z: ours, glTF's, Maya's.
    Y,
    /// Z up, the character faces -Y: Blender's.
    Z,
}

impl Axes {
    /// A vector of these axes in ours.
    #[must_use]
    pub fn to_y_up(self, v: Vec3) -> Vec3 {
        match self {
            Self::Y => v,
            Self::Z => Vec3::new(v.x, v.z, -v.y),
        }
    }

    /// The likelier axes: `likes_y` is above 0 for Y up, below for Z up.
    fn liked(likes_y: f64) -> Self {
        if likes_y < 0.0 { Self::Z } else { Self::Y }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Y => "Y up",
            Self::Z => "Z up",
        }
    }
}

/// What the caller knows; the rest is guessed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Given {
    /// The axis that points up.
    pub up: Option<Axes>,
    /// Metres a unit, above 0.
    pub scale: Option<f32>,
    /// Added to the positions once they are Y up and metres. Zero leaves hair where it is, also where
    /// that is not on the head.
    pub offset: Option<Vec3>,
}

/// From a file's coordinates to ours: turn, scale, move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    /// The file's axis that points up.
    pub up: Axes,
    /// Metres a unit.
    pub scale: f32,
    /// In metres, Y up.
    pub offset: Vec3,
}

impl Orientation {
    /// A position of the file in metres, Y up.
    #[must_use]
    pub fn apply(&self, position: Vec3) -> Vec3 {
        self.up.to_y_up(position) * self.scale + self.offset
    }
}

/// The usual units: name, metres, and how unlikely it is: a factor of e^x in size weighs as much.
const UNITS: [(&str, f64, f64); 6] = [
    ("metres", 1.0, 0.0),
    ("centimetres", 0.01, 0.0),
    ("millimetres", 0.001, 0.0),
    ("decimetres", 0.1, 0.3),
    ("inches", 0.0254, 0.6),
    ("feet", 0.3048, 0.8),
];
/// The radius of a scalp, in metres.
const SCALP_RADIUS: f64 = 0.095;
/// A head's height, in metres.
const HEAD_HEIGHT: f64 = 0.24;
/// Roots that are looked at; more do not make a guess better.
const SAMPLED: usize = 400;

/// Axes, units and place of a hair file that doesn't say them, and the sentence that tells.
///
/// With a head (metres, Y up) they are those under which the roots lie on it; where no unit does that,
/// the unit is that of its size and the hair is moved onto it. Without one the roots' size tells
/// the unit: a scalp has a radius of 0.09 to 0.1 m. Up is where strands hang from, where roots lie on
/// their sphere, and where the hair is seen from the origin.
#[must_use]
pub fn hair(strands: &Strands, head: Option<&Mesh>, given: &Given) -> (Orientation, String) {
    let cloud = Cloud::new(strands);
    let likes_y = cloud.likes_y(strands);
    let head = head.filter(|mesh| !mesh.triangles.is_empty());
    let orientation = match (head, cloud.sphere) {
        (Some(head), Some(sphere)) => onto_head::place(&cloud, &sphere, head, likes_y, given),
        _ => Orientation {
            up: given.up.unwrap_or(Axes::liked(likes_y)),
            scale: given.scale.unwrap_or_else(|| cloud.scale()),
            offset: given.offset.unwrap_or(Vec3::ZERO),
        },
    };
    let note = format!(
        "hair: {} strands, {}",
        count(strands.len()),
        told(&orientation, given)
    );
    (orientation, note)
}

/// Axes and units of a hair file of a format that says them (Y up, metres), if not overridden.
#[must_use]
pub fn known_hair(strands: &Strands, given: &Given) -> (Orientation, String) {
    let orientation = Orientation {
        up: given.up.unwrap_or(Axes::Y),
        scale: given.scale.unwrap_or(1.0),
        offset: given.offset.unwrap_or(Vec3::ZERO),
    };
    let told = if *given == Given::default() {
        "Y up, metres".to_string()
    } else {
        let Orientation { up, scale, .. } = orientation;
        told(
            &orientation,
            &Given {
                up: Some(up),
                scale: Some(scale),
                ..*given
            },
        )
    };
    (
        orientation,
        format!("hair: {} strands, {told}", count(strands.len())),
    )
}

/// Axes and units of a head, bust or body that doesn't say them, and the sentence that tells.
///
/// Up is its longer axis and where it lies from the origin; the height of its head, found by its neck
/// ([`HeadFrame`]), tells the unit.
#[must_use]
pub fn head(mesh: &Mesh, given: &Given) -> (Orientation, String) {
    let points: Vec<DVec3> = mesh.positions.iter().map(|p| p.as_dvec3()).collect();
    let (low, high) = bounds(points.iter()).unwrap_or_default();
    let size = high - low;
    let place = (low + high) * 0.5;
    let place = place
        / place
            .length()
            .max(size.max_element())
            .max(f64::MIN_POSITIVE);
    let longer = (size.y - size.z) / size.max_element().max(f64::MIN_POSITIVE);
    // 0.1: a head is about as deep as high, and files of this kind are Y up more often.
    let likes_y = longer + 0.5 * (place.y - place.z) + 0.1;
    let up = given.up.unwrap_or(Axes::liked(likes_y));

    let scale = given.scale.unwrap_or_else(|| {
        let positions = mesh.positions.iter().map(|p| up.to_y_up(*p)).collect();
        let turned = Mesh {
            positions,
            ..mesh.clone()
        };
        let frame = HeadFrame::find(Some(&turned), &[]);
        scale_to(f64::from(frame.height), HEAD_HEIGHT, 1.0)
    });
    let orientation = Orientation {
        up,
        scale,
        offset: given.offset.unwrap_or(Vec3::ZERO),
    };
    let (vertices, triangles) = (count(points.len()), count(mesh.triangles.len()));
    let told = told(&orientation, given);
    (
        orientation,
        format!("head: {vertices} vertices, {triangles} triangles, {told}"),
    )
}

/// The roots of a groom, in the file's coordinates.
struct Cloud {
    roots: Vec<Vec3>,
    sphere: Option<Sphere>,
    /// The middle of the box of the roots, without outliers.
    middle: DVec3,
    /// The box's longest side.
    extent: f64,
    /// Whether the roots cover a scalp, not a parting, a mohawk or a fringe.
    is_scalp: bool,
}

impl Cloud {
    fn new(strands: &Strands) -> Self {
        let step = strands.len().div_ceil(SAMPLED).max(1);
        let roots: Vec<Vec3> = strands.roots().step_by(step).collect();
        let points: Vec<DVec3> = roots.iter().map(|r| r.as_dvec3()).collect();
        let (low, high) = bounds(without_outliers(&points).iter()).unwrap_or_default();
        let size = high - low;
        let sphere = sphere::fit(&roots);
        let extent = size.max_element();
        Self {
            sphere,
            middle: (low + high) * 0.5,
            extent,
            is_scalp: size.min_element() > 0.45 * extent,
            roots,
        }
    }

    /// Above 0 for Y up, below for Z up, within -1 to 1.
    fn likes_y(&self, strands: &Strands) -> f64 {
        let step = strands.len().div_ceil(SAMPLED).max(1);
        let spans = strands
            .iter()
            .step_by(step)
            .map(|points| points[points.len() - 1].as_dvec3() - points[0].as_dvec3());
        let (sum, lengths) = spans.fold((DVec3::ZERO, 0.0), |(sum, lengths), s| {
            (sum + s, lengths + s.length())
        });
        let hang = sum / lengths.max(f64::MIN_POSITIVE);

        let mut up = -hang;
        if let Some(sphere) = self.sphere.filter(|_| self.is_scalp) {
            let mean = self.roots.iter().map(|r| r.as_dvec3()).sum::<DVec3>();
            up += (mean / self.roots.len() as f64 - sphere.center) / sphere.radius;
        }
        // Seen from between the feet.
        up += self.middle / self.middle.length().max(self.extent).max(f64::MIN_POSITIVE);
        // 0.3: files of this kind are Y up more often.
        (up.y - up.z + 0.3).clamp(-1.0, 1.0)
    }

    /// Metres a unit, by the size of the roots alone.
    fn scale(&self) -> f32 {
        match self.sphere {
            Some(sphere) if self.is_scalp => scale_to(sphere.radius, SCALP_RADIUS, 1.0),
            // Part of a scalp, or more than that: the size says less.
            _ => scale_to(self.extent * 0.5, SCALP_RADIUS, 0.3),
        }
    }
}

/// The scale that brings `size` units near `metres`: that of the likeliest usual unit, else of none.
/// `weight`: how much a size that is e times too large or small speaks against a unit.
fn scale_to(size: f64, metres: f64, weight: f64) -> f32 {
    if size <= 0.0 {
        return 1.0;
    }
    let off = |unit: f64| (size * unit / metres).ln().abs();
    let unlikely = |unit: &(&str, f64, f64)| weight * off(unit.1) + unit.2;
    let best = UNITS
        .iter()
        .min_by(|a, b| unlikely(a).total_cmp(&unlikely(b)));
    let scale = best
        .map(|unit| unit.1)
        .filter(|unit| weight * off(*unit) < 1.1);
    as_scale(scale.unwrap_or(metres / size))
}

fn as_scale(scale: f64) -> f32 {
    scale.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32
}

/// "guessed Y up, metres", "Y up as given, guessed metres", and where the hair was moved.
fn told(orientation: &Orientation, given: &Given) -> String {
    let (up, unit) = (orientation.up.name(), unit_name(orientation.scale));
    let mut text = match (given.up, given.scale) {
        (None, None) => format!("guessed {up}, {unit}"),
        (Some(_), None) => format!("{up} as given, guessed {unit}"),
        (None, Some(_)) => format!("guessed {up}, {unit} as given"),
        (Some(_), Some(_)) => format!("{up}, {unit} as given"),
    };
    if orientation.offset != Vec3::ZERO {
        let Vec3 { x, y, z } = orientation.offset;
        let why = if given.offset.is_some() {
            "as given"
        } else {
            "onto the head"
        };
        text.push_str(&format!(", moved by ({x:.3}, {y:.3}, {z:.3}) m {why}"));
    }
    text
}

fn unit_name(scale: f32) -> String {
    let unit = UNITS.iter().find(|unit| unit.1 as f32 == scale);
    unit.map_or_else(
        || format!("{scale:.4e} m a unit"),
        |unit| unit.0.to_string(),
    )
}

/// 11400 as "11,400".
fn count(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests;
