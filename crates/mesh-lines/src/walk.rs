//! Ways along a surface, up or down a function on it.

use crate::{Beside, Place, Surface, View};
use glam::DVec3;

/// Through no more triangles than this goes one way.
const MOST_TRIANGLES: usize = 256;

/// Goes from a place along the gradient of a function that is linear within triangles and given at the smooth vertices, up where it is negative and down where
/// it is positive, to where it is 0.
///
/// Nothing if that is farther than `reach` in the image, or the way ends before: at a border or a sharp edge, or where the function is even.
///
/// # Panics
///
/// When there is no value for a corner of a triangle on the way.
#[must_use]
pub fn walk_to_zero(
    surface: &Surface,
    values: &[f64],
    view: &View,
    from: Place,
    reach: f64,
) -> Option<Place> {
    let topology = surface.topology();
    let mut place = from;
    let mut left = reach;
    // Down to 0 from above, up from below.
    let mut uphill = None;
    for _ in 0..MOST_TRIANGLES {
        let triangle = place.triangle;
        let smooth = topology.smooth_corners()[triangle as usize];
        let at_corners = smooth.map(|vertex| values[vertex as usize]);
        let value = DVec3::from(at_corners).dot(place.weights);
        if value == 0.0 {
            return Some(place);
        }
        let up = *uphill.get_or_insert(value < 0.0);
        let gradient = surface.gradient(triangle, at_corners);
        let steepness = gradient.length_squared();
        if steepness == 0.0 || up != (value < 0.0) {
            return None;
        }
        // From here to 0, were the triangle large enough.
        let step = gradient * (-value / steepness);
        let change = weights_of(surface, triangle, step)?;
        let (share, out) = leave(place.weights, change);
        let next = Place {
            triangle,
            weights: (place.weights + change * share).max(DVec3::ZERO),
        };
        left -= view.image_distance(surface.point(place), surface.point(next));
        if left < 0.0 {
            return None;
        }
        let Some(corner) = out else {
            return Some(next);
        };
        // Out through the edge opposite of the corner.
        let side = triangle * 3 + (corner as u32 + 1) % 3;
        let Beside::Twin(twin) = topology.beside(side) else {
            return None;
        };
        if topology.is_sharp(side) {
            return None;
        }
        place = across(surface, next, twin / 3);
    }
    None
}

/// How the weights of a place change by a step within a triangle: their sum stays.
fn weights_of(surface: &Surface, triangle: u32, step: DVec3) -> Option<DVec3> {
    let change = [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|corner| surface.gradient(triangle, corner.to_array()).dot(step));
    let change = DVec3::from(change);
    change.is_finite().then_some(change)
}

/// How much of a change keeps all weights from 0 up, and the corner whose weight stops it; all of it where nothing does.
fn leave(weights: DVec3, change: DVec3) -> (f64, Option<usize>) {
    let mut first = (1.0, None);
    for corner in 0..3 {
        if change[corner] < 0.0 {
            let share = weights[corner] / -change[corner];
            if share < first.0 {
                first = (share.max(0.0), Some(corner));
            }
        }
    }
    first
}

/// A place on an edge, said of another triangle with that edge.
fn across(surface: &Surface, place: Place, triangle: u32) -> Place {
    let triangles = surface.topology().triangles();
    let from = triangles[place.triangle as usize];
    let to = triangles[triangle as usize];
    let weight = |vertex: u32| {
        from.iter()
            .position(|v| *v == vertex)
            .map_or(0.0, |i| place.weights[i])
    };
    let weights = DVec3::from(to.map(weight));
    Place {
        triangle,
        weights: weights / weights.element_sum(),
    }
}
