//! The head as hair sees it: a skin around a centre, by direction.

use crate::nearest::Nearest;
use crate::trig::sin_cos_degrees;
use glam::{Vec2, Vec3};

/// Columns and rows of the table of radii: 3 degrees each.
const COLUMNS: usize = 120;
const ROWS: usize = 61;

/// How far behind the skin a point may be to be pushed out of the body, head heights.
const DEEPEST: f32 = 0.25;

/// A place on the head: longitude from the face (0) to the character's left ear (90) and the back of
/// the head (180), latitude from the chin side (-90) to the top (90), in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Longitude in degrees.
    pub longitude: f32,
    /// Latitude in degrees.
    pub latitude: f32,
}

/// The distance of a head's skin from a point inside it, for every direction.
///
/// Made from any mesh: each direction's outermost triangle counts, up to 0.75 head heights away (so
/// that shoulders do not). Neck and shoulders are kept as points of the skin, to hang hair over.
#[derive(Clone, Debug)]
pub struct Shell {
    center: Vec3,
    height: f32,
    radii: Vec<f32>,
    /// Points of neck and shoulders, in the mesh's order, and what finds the nearest of them.
    body: Vec<Skin>,
    nearest: Nearest<3>,
}

/// A point of the skin.
#[derive(Clone, Copy, Debug)]
struct Skin {
    point: Vec3,
    /// Unit.
    normal: Vec3,
}

impl Shell {
    /// The shell of a mesh (one unit normal a position) around the middle of its head. `height` is the
    /// head's, in metres.
    #[must_use]
    pub fn new(
        positions: &[Vec3],
        normals: &[Vec3],
        triangles: &[[u32; 3]],
        center: Vec3,
        height: f32,
    ) -> Self {
        // The middle of the skull lies a little above and behind the middle of the head.
        let center = center + Vec3::new(0.0, 0.10, -0.08) * height;
        let reach = 0.75 * height;
        let mut radii = vec![0.0_f32; COLUMNS * ROWS];
        for triangle in triangles {
            let corners = triangle.map(|i| positions[i as usize] - center);
            if corners.iter().all(|corner| corner.length() < reach) {
                enter(&mut radii, corners);
            }
        }
        let skin = positions.iter().zip(normals);
        let skin = skin.map(|(&point, &normal)| Skin { point, normal });
        let is_body =
            |skin: &Skin| skin.point.y < center.y - 0.35 * height && skin.point.is_finite();
        let body: Vec<Skin> = skin.filter(is_body).collect();
        let nearest = Nearest::new(body.iter().map(|skin| coordinates(skin.point)));
        let mut shell = Self {
            center,
            height,
            radii,
            body,
            nearest,
        };
        shell.close_gaps();
        shell
    }

    /// The head's height in metres.
    #[must_use]
    pub fn height(&self) -> f32 {
        self.height
    }

    /// The point that directions are seen from: the middle of the skull.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// The point `lift` head heights above the skin in a direction from the centre.
    #[must_use]
    pub fn above(&self, direction: Vec3, lift: f32) -> Vec3 {
        let direction = direction.normalize_or(Vec3::Y);
        self.center + direction * (self.radius(direction) + lift * self.height)
    }

    /// `point`, or the nearest place at least `gap` head heights above the skin.
    #[must_use]
    pub fn keep_out(&self, point: Vec3, gap: f32) -> Vec3 {
        let (lift, direction) = self.lift_of(point);
        if (point - self.center).y > -0.35 * self.height {
            return if lift < gap {
                self.above(direction, gap)
            } else {
                point
            };
        }
        let Some(skin) = self.nearest_of_body(point) else {
            return point;
        };
        // In front of the skin's plane there is nothing to keep out of; far behind it is another side.
        let push = gap * self.height - (point - skin.point).dot(skin.normal);
        if (0.0..DEEPEST * self.height).contains(&push) {
            point + skin.normal * push
        } else {
            point
        }
    }

    /// The point of neck and shoulders that is nearest to `point`: of several, the mesh's first.
    fn nearest_of_body(&self, point: Vec3) -> Option<&Skin> {
        let mut found = Vec::with_capacity(2);
        self.nearest.find(&coordinates(point), 1, &mut found);
        found.first().map(|(_, index)| &self.body[*index])
    }

    /// How far a point lies above the skin, head heights, and the direction away from the centre.
    #[must_use]
    pub fn lift_of(&self, point: Vec3) -> (f32, Vec3) {
        let way = point - self.center;
        let direction = way.normalize_or(Vec3::Y);
        (
            (way.length() - self.radius(direction)) / self.height,
            direction,
        )
    }

    /// The place that a point lies above.
    #[must_use]
    pub fn place(&self, point: Vec3) -> Place {
        let at = cell((point - self.center).normalize_or(Vec3::Y));
        Place {
            longitude: at.x * 360.0 / COLUMNS as f32,
            latitude: at.y * 180.0 / (ROWS - 1) as f32 - 90.0,
        }
    }

    /// The skin's distance in a direction (unit), metres.
    fn radius(&self, direction: Vec3) -> f32 {
        let at = cell(direction);
        let (column, row) = (at.x.floor(), at.y.floor().min(ROWS as f32 - 2.0));
        let (s, t) = (at.x - column, at.y - row);
        let value = |c: f32, r: f32| self.radii[index((c as usize) % COLUMNS, r as usize)];
        let low = value(column, row) * (1.0 - s) + value(column + 1.0, row) * s;
        let high = value(column, row + 1.0) * (1.0 - s) + value(column + 1.0, row + 1.0) * s;
        low * (1.0 - t) + high * t
    }

    /// Gives directions that no triangle lies in the mean of their neighbours', and evens out what
    /// a comb would not follow.
    fn close_gaps(&mut self) {
        for _ in 0..ROWS {
            let old = self.radii.clone();
            for row in 0..ROWS {
                for column in 0..COLUMNS {
                    if old[index(column, row)] > 0.0 {
                        continue;
                    }
                    let around = neighbours(column, row).map(|(c, r)| old[index(c, r)]);
                    let known: Vec<f32> = around.into_iter().filter(|r| *r > 0.0).collect();
                    if !known.is_empty() {
                        let mean = known.iter().sum::<f32>() / known.len() as f32;
                        self.radii[index(column, row)] = mean;
                    }
                }
            }
        }
        for radius in &mut self.radii {
            if *radius <= 0.0 {
                *radius = 0.4 * self.height; // a mesh without triangles near the head
            }
        }
        for _ in 0..2 {
            let old = self.radii.clone();
            for row in 0..ROWS {
                for column in 0..COLUMNS {
                    let sum: f32 = neighbours(column, row)
                        .map(|(c, r)| old[index(c, r)])
                        .iter()
                        .sum();
                    self.radii[index(column, row)] = 0.5 * old[index(column, row)] + 0.125 * sum;
                }
            }
        }
    }
}

fn coordinates(point: Vec3) -> [f64; 3] {
    point.to_array().map(f64::from)
}

/// The direction of a place.
#[must_use]
pub fn direction(place: Place) -> Vec3 {
    let (sin_lon, cos_lon) = sin_cos_degrees(place.longitude);
    let (sin_lat, cos_lat) = sin_cos_degrees(place.latitude);
    Vec3::new(sin_lon * cos_lat, sin_lat, cos_lon * cos_lat)
}

/// The direction at share `t` of the great circle from one direction to another, evenly (within 1 %).
pub(crate) fn between(mut from: Vec3, mut to: Vec3, mut t: f32) -> Vec3 {
    // A chord runs evenly enough over short arcs: halve the arc three times.
    for _ in 0..3 {
        let middle = (from + to).normalize_or(from);
        if t < 0.5 {
            (to, t) = (middle, 2.0 * t);
        } else {
            (from, t) = (middle, 2.0 * t - 1.0);
        }
    }
    from.lerp(to, t).normalize_or(from)
}

/// Where in the table a direction lies, in cells. Angles only choose cells here, so a short
/// approximation of the arc tangent (within 0.3 degrees) does.
fn cell(direction: Vec3) -> Vec2 {
    let flat = Vec2::new(direction.z, direction.x).length();
    let longitude = turn(direction.x, direction.z);
    let latitude = turn(direction.y, flat);
    Vec2::new(
        longitude.rem_euclid(1.0) * COLUMNS as f32,
        ((latitude + 0.25) * 2.0 * (ROWS - 1) as f32).clamp(0.0, (ROWS - 1) as f32),
    )
}

/// The angle of (x, y) as a share of a turn, -1/2 to 1/2.
fn turn(y: f32, x: f32) -> f32 {
    let (small, large) = (x.abs().min(y.abs()), x.abs().max(y.abs()));
    if large <= 0.0 {
        return 0.0;
    }
    let a = small / large;
    let z = a * a;
    let eighth = a * (0.159_142_7 + z * (-0.051_768_6 + z * (0.024_2 - z * 0.006_574_1)));
    let quarter = if y.abs() > x.abs() {
        0.25 - eighth
    } else {
        eighth
    };
    let half = if x < 0.0 { 0.5 - quarter } else { quarter };
    if y < 0.0 { -half } else { half }
}

fn index(column: usize, row: usize) -> usize {
    row * COLUMNS + column
}

fn neighbours(column: usize, row: usize) -> [(usize, usize); 4] {
    [
        ((column + 1) % COLUMNS, row),
        ((column + COLUMNS - 1) % COLUMNS, row),
        (column, (row + 1).min(ROWS - 1)),
        (column, row.saturating_sub(1)),
    ]
}

/// Raises the table to a triangle, by points all over it that are closer than a cell.
fn enter(radii: &mut [f32], [a, b, c]: [Vec3; 3]) {
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let nearest = a.length().min(b.length()).min(c.length()).max(1e-6);
    let steps = ((longest / nearest / 0.04).ceil() as usize).clamp(1, 40);
    for i in 0..=steps {
        for j in 0..=steps - i {
            let (s, t) = (i as f32 / steps as f32, j as f32 / steps as f32);
            let point = a + (b - a) * s + (c - a) * t;
            let at = cell(point.normalize_or(Vec3::Y)).round();
            let radius = &mut radii[index(at.x as usize % COLUMNS, (at.y as usize).min(ROWS - 1))];
            *radius = radius.max(point.length());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bust::bust;
    use crate::shape::distance;

    #[test]
    fn directions_and_cells_agree() {
        for longitude in (-180..180).step_by(7) {
            for latitude in (-84..=84).step_by(7) {
                let place = Place {
                    longitude: longitude as f32,
                    latitude: latitude as f32,
                };
                let unit = direction(place);
                assert!((unit.length() - 1.0).abs() < 1e-6);
                let at = cell(unit);
                let found = (at.x * 3.0, at.y * 3.0 - 90.0);
                let wrap = (found.0 - place.longitude).rem_euclid(360.0);
                assert!(wrap.min(360.0 - wrap) < 0.4, "{place:?} {found:?}");
                assert!(
                    (found.1 - place.latitude).abs() < 0.4,
                    "{place:?} {found:?}"
                );
            }
        }
        assert!(
            (direction(Place {
                longitude: 90.0,
                latitude: 0.0
            }) - Vec3::X)
                .length()
                < 1e-6
        );
        assert!(
            (direction(Place {
                longitude: 0.0,
                latitude: 0.0
            }) - Vec3::Z)
                .length()
                < 1e-6
        );
    }

    #[test]
    fn the_shell_is_the_skin_of_the_skull() {
        let bust = bust();
        let center = Vec3::new(0.0, 1.5, 0.0);
        let shell = Shell::new(
            &bust.positions,
            &bust.normals,
            &bust.triangles,
            center,
            0.24,
        );
        for longitude in (-180..180).step_by(15) {
            for latitude in (20..=90).step_by(10) {
                let place = Place {
                    longitude: longitude as f32,
                    latitude: latitude as f32,
                };
                let on_skin = shell.above(direction(place), 0.0);
                let gap = distance(on_skin);
                assert!(gap.abs() < 0.004, "{place:?}: {gap} m off the skin");
                let (lift, _) = shell.lift_of(shell.above(direction(place), 0.05));
                assert!((lift - 0.05).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn great_circles_run_evenly() {
        let (from, to) = (Vec3::X, Vec3::new(-0.9, 0.1, 0.3).normalize());
        let angle = from.dot(to).acos();
        for step in 0..=20 {
            let t = step as f32 / 20.0;
            let found = from.dot(between(from, to, t)).clamp(-1.0, 1.0).acos();
            assert!((found - t * angle).abs() < 0.012 * angle, "{t}: {found}");
        }
    }

    #[test]
    fn the_nearest_of_the_body_is_found() {
        let bust = bust();
        let center = Vec3::new(0.0, 1.5, 0.0);
        let shell = Shell::new(
            &bust.positions,
            &bust.normals,
            &bust.triangles,
            center,
            0.24,
        );
        // In the middle two points across x = 0 are as near as each other.
        for (i, x) in (0..300).zip([0.0, 0.03, -0.11, 0.4].into_iter().cycle()) {
            let (y, z) = (1.0 + 0.003 * i as f32, (i * 37 % 100) as f32 * 0.006 - 0.3);
            let point = Vec3::new(x, y, z);
            // Of several the first.
            let nearest = shell.body.iter().min_by(|a, b| {
                let key = |skin: &Skin| skin.point.as_dvec3().distance_squared(point.as_dvec3());
                key(a).total_cmp(&key(b))
            });
            let found = shell.nearest_of_body(point).map(|skin| skin.point);
            assert_eq!(found, nearest.map(|skin| skin.point), "{point}");
        }
    }

    #[test]
    fn an_empty_mesh_is_a_ball() {
        let shell = Shell::new(&[], &[], &[], Vec3::ZERO, 0.24);
        let (lift, _) = shell.lift_of(shell.above(Vec3::X, 0.0));
        assert!(lift.abs() < 1e-6);
    }
}
