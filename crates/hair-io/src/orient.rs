//! Axes and units of files that say nothing about them: guessed, said, and overridden by the caller.

mod axes;
mod cloud;
mod onto_head;
mod unit;

pub use axes::{Axes, Given, Orientation};

use glam::{DVec3, Vec3};
use hair_sim::Strands;

use crate::Mesh;
use crate::head::{HeadFrame, bounds};
use cloud::Cloud;
use unit::scale_to;

/// A head's height, in metres.
const HEAD_HEIGHT: f64 = 0.24;

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
    let (orientation, told) = known(given);
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
    head_by(mesh, mesh, given)
}

/// The same, guessed by a part of it, `shape`.
pub(crate) fn head_by(shape: &Mesh, mesh: &Mesh, given: &Given) -> (Orientation, String) {
    let points: Vec<DVec3> = shape.positions.iter().map(|p| p.as_dvec3()).collect();
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
        let positions = shape.positions.iter().map(|p| up.to_y_up(*p)).collect();
        let turned = Mesh {
            positions,
            ..shape.clone()
        };
        let frame = HeadFrame::find(Some(&turned), &[]);
        scale_to(f64::from(frame.height), HEAD_HEIGHT, 1.0)
    });
    let orientation = Orientation {
        up,
        scale,
        offset: given.offset.unwrap_or(Vec3::ZERO),
    };
    let told = told(&orientation, given);
    (orientation, format!("{}, {told}", size_of_head(mesh)))
}

/// Axes and units of a head of a format that says them (Y up, metres), if not overridden.
#[must_use]
pub fn known_head(mesh: &Mesh, given: &Given) -> (Orientation, String) {
    let (orientation, told) = known(given);
    (orientation, format!("{}, {told}", size_of_head(mesh)))
}

fn size_of_head(mesh: &Mesh) -> String {
    let (vertices, triangles) = (count(mesh.positions.len()), count(mesh.triangles.len()));
    format!("head: {vertices} vertices, {triangles} triangles")
}

/// Axes and units of a format that says them.
fn known(given: &Given) -> (Orientation, String) {
    let orientation = Orientation {
        up: given.up.unwrap_or(Axes::Y),
        scale: given.scale.unwrap_or(1.0),
        offset: given.offset.unwrap_or(Vec3::ZERO),
    };
    if *given == Given::default() {
        return (orientation, "Y up, metres".to_string());
    }
    let Orientation { up, scale, .. } = orientation;
    let given = Given {
        up: Some(up),
        scale: Some(scale),
        ..*given
    };
    (orientation, told(&orientation, &given))
}

/// "guessed Y up, metres", "Y up as given, guessed metres", and where the hair was moved.
fn told(orientation: &Orientation, given: &Given) -> String {
    let (up, unit) = (orientation.up.name(), unit::name(orientation.scale));
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
