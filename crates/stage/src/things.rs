//! Things that the program makes by itself, for pictures without any file: a cup, a cube, a gear, a bird's wings.

use crate::preset::ThingChoice;
use glam::{DQuat, Quat, Vec3};
use render::Head;
use std::collections::HashMap;
use std::sync::Arc;
use stroke_path::sin_cos_degrees;

/// Faces around a corner that differ by less look like one smooth surface: the cosine of 40 degrees.
const SMOOTH_COSINE: f32 = 0.766;
/// How round what turns is: so many corners.
const AROUND: usize = 96;

/// A thing's shape, its largest side 1 and its middle at 0: +Y up, +Z to the eye.
#[derive(Debug)]
pub(crate) struct Thing {
    shape: ThingChoice,
    /// Points, of which each is once.
    points: Vec<Vec3>,
    /// Triangles of points, seen from outside counter-clockwise.
    faces: Vec<[u32; 3]>,
    /// The corners that are drawn: more than one at a point that lies on an edge. Each has its point, and the faces whose normals are its own.
    corners: Vec<(u32, Vec<u32>)>,
    pub triangles: Vec<[u32; 3]>,
}

/// Where a thing is, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placed {
    /// In metres.
    pub middle: Vec3,
    pub turn: Quat,
    /// Metres of one that is 1 high.
    pub size_m: f32,
}

/// A thing that moves by itself.
#[derive(Clone, Debug)]
pub(crate) struct Beating {
    pub thing: Arc<Thing>,
    pub placed: Placed,
    /// How often it beats in a second.
    pub beat: f32,
}

impl Placed {
    /// By the words of a preset: head heights from the middle of a head, turns in degrees, a size in head heights.
    pub fn new(head: Head, at: [f32; 3], turn: [f32; 3], size: f32) -> Self {
        let about = |axis: Vec3, degrees: f32| {
            let (sin, cos) = sin_cos_degrees(0.5 * f64::from(degrees));
            let axis = axis.as_dvec3() * sin;
            DQuat::from_xyzw(axis.x, axis.y, axis.z, cos)
        };
        // To its left, up, towards its left shoulder, as bodies turn.
        let turn =
            about(Vec3::Y, turn[0]) * about(Vec3::NEG_X, turn[1]) * about(Vec3::NEG_Z, turn[2]);
        Self {
            middle: head.center + Vec3::from(at) * head.height_m,
            turn: turn.as_quat(),
            size_m: size * head.height_m,
        }
    }

    pub fn point(&self, p: Vec3) -> Vec3 {
        self.middle + self.turn * (self.size_m * p)
    }
}

impl Beating {
    /// Where its corners are at a time (seconds), and their normals.
    pub fn at(&self, time: f64) -> [Vec<Vec3>; 2] {
        let beats = time * f64::from(self.beat);
        let points = match self.thing.shape {
            ThingChoice::Wings => wings(beats - beats.floor()).points,
            _ => return self.thing.placed(&self.thing.points, &self.placed),
        };
        self.thing.placed(&points, &self.placed)
    }
}

impl Thing {
    /// The thing of that name, if it is one.
    pub fn new(shape: ThingChoice) -> Option<Self> {
        let solid = match shape {
            ThingChoice::None => return None,
            ThingChoice::Cup => cup(),
            ThingChoice::Cube => cube(),
            ThingChoice::Gear => gear(),
            ThingChoice::Wings => wings(0.0),
        };
        Some(Self::of(shape, solid))
    }

    /// Whether its shape changes in time.
    pub fn moves(&self) -> bool {
        self.shape == ThingChoice::Wings
    }

    fn of(shape: ThingChoice, Solid { points, faces }: Solid) -> Self {
        let normals: Vec<Vec3> = faces
            .iter()
            .map(|face| area_normal(&points, face))
            .collect();
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); points.len()];
        for (number, face) in (0..).zip(&faces) {
            for point in face {
                around[*point as usize].push(number);
            }
        }
        let mut known: HashMap<(u32, Vec<u32>), u32> = HashMap::new();
        let mut corners = Vec::new();
        let triangles = (0..).zip(&faces).map(|(number, face): (u32, &[u32; 3])| {
            let own = normals[number as usize].normalize_or_zero();
            face.map(|point| {
                let is_smooth = |other: &u32| {
                    normals[*other as usize].normalize_or_zero().dot(own) > SMOOTH_COSINE
                };
                let all = around[point as usize].iter().copied();
                let corner = (point, all.filter(is_smooth).collect::<Vec<u32>>());
                *known.entry(corner.clone()).or_insert_with(|| {
                    corners.push(corner);
                    corners.len() as u32 - 1
                })
            })
        });
        let triangles = triangles.collect();
        Self {
            shape,
            points,
            faces,
            corners,
            triangles,
        }
    }

    /// Its corners and their normals in a place.
    pub fn in_place(&self, placed: &Placed) -> [Vec<Vec3>; 2] {
        self.placed(&self.points, placed)
    }

    fn placed(&self, points: &[Vec3], placed: &Placed) -> [Vec<Vec3>; 2] {
        let places: Vec<Vec3> = points.iter().map(|p| placed.point(*p)).collect();
        let faces: Vec<Vec3> = self
            .faces
            .iter()
            .map(|face| area_normal(points, face))
            .collect();
        let normal = |(_, own): &(u32, Vec<u32>)| {
            let sum: Vec3 = own.iter().map(|face| faces[*face as usize]).sum();
            placed.turn * sum.normalize_or(Vec3::Y)
        };
        [
            self.corners
                .iter()
                .map(|(point, _)| places[*point as usize])
                .collect(),
            self.corners.iter().map(normal).collect(),
        ]
    }
}

/// The points and triangles of a thing, its largest side 1 and its middle at 0: +Y up, +Z to the eye; of what moves by itself at a share of a
/// beat, 0 to 1. Nothing of [`ThingChoice::None`].
#[must_use]
pub fn thing_mesh(shape: ThingChoice, beat: f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    match (shape, Thing::new(shape)) {
        (ThingChoice::Wings, Some(thing)) => (wings(beat).points, thing.faces),
        (_, Some(thing)) => (thing.points, thing.faces),
        (_, None) => (Vec::new(), Vec::new()),
    }
}

/// The normal of a face, of twice its area: in thousandths, so that its square is no underflow.
fn area_normal(points: &[Vec3], face: &[u32; 3]) -> Vec3 {
    let [a, b, c] = face.map(|point| 1000.0 * points[point as usize]);
    (b - a).cross(c - a)
}

/// Points and faces of a closed surface, or of several.
#[derive(Default)]
struct Solid {
    points: Vec<Vec3>,
    faces: Vec<[u32; 3]>,
}

impl Solid {
    /// A surface through rings of as many points each, from one to the next; each ring goes round to the left of the way. Ends are closed by a point each
    /// where they have one.
    fn through(&mut self, rings: &[Vec<Vec3>], ends: [Option<Vec3>; 2]) {
        let first = self.points.len() as u32;
        let count = rings[0].len() as u32;
        self.points.extend(rings.iter().flatten());
        let at = |ring: usize, place: u32| first + ring as u32 * count + place % count;
        for ring in 1..rings.len() {
            for place in 0..count {
                let [a, b] = [at(ring - 1, place), at(ring - 1, place + 1)];
                let [d, c] = [at(ring, place), at(ring, place + 1)];
                self.faces.extend([[a, b, c], [a, c, d]]);
            }
        }
        let last = rings.len() - 1;
        for (end, point) in ends.into_iter().enumerate() {
            let Some(point) = point else {
                continue;
            };
            let top = self.points.len() as u32;
            self.points.push(point);
            for place in 0..count {
                self.faces.push(match end {
                    0 => [top, at(0, place + 1), at(0, place)],
                    _ => [top, at(last, place), at(last, place + 1)],
                });
            }
        }
    }

    /// The same rings, of which the last is followed by the first.
    fn around(&mut self, rings: &[Vec<Vec3>]) {
        let first = self.points.len() as u32;
        let (turns, count) = (rings.len() as u32, rings[0].len() as u32);
        self.points.extend(rings.iter().flatten());
        let at = |ring: u32, place: u32| first + ring % turns * count + place % count;
        for ring in 0..turns {
            for place in 0..count {
                let [a, b] = [at(ring, place), at(ring, place + 1)];
                let [d, c] = [at(ring + 1, place), at(ring + 1, place + 1)];
                self.faces.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    /// With its middle at 0 and its largest side 1.
    fn fitted(mut self) -> Self {
        let of = |f: fn(Vec3, Vec3) -> Vec3| self.points.iter().copied().reduce(f);
        if let (Some(low), Some(high)) = (of(Vec3::min), of(Vec3::max)) {
            let (middle, scale) = (0.5 * (low + high), (high - low).max_element().recip());
            for point in &mut self.points {
                *point = scale * (*point - middle);
            }
        }
        self
    }
}

fn sin_cos(degrees: f32) -> (f32, f32) {
    let (sin, cos) = sin_cos_degrees(f64::from(degrees));
    (sin as f32, cos as f32)
}

/// The directions of so many points around the Y axis, to the left seen from above: x and z.
fn circle(count: usize) -> Vec<[f32; 2]> {
    let at = |i: usize| sin_cos(360.0 * i as f32 / count as f32);
    (0..count).map(at).map(|(sin, cos)| [sin, cos]).collect()
}

/// A smooth curve through points (Catmull and Rom), so many steps between two.
fn curve(points: &[[f32; 2]], steps: usize) -> Vec<[f32; 2]> {
    let at = |i: isize| points[i.clamp(0, points.len() as isize - 1) as usize];
    let mut all = vec![points[0]];
    for i in 0..points.len() as isize - 1 {
        let [before, from, to, after] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
        all.extend((1..=steps).map(|step| {
            let t = step as f32 / steps as f32;
            [0, 1].map(|axis| {
                let [p, q, r, s] = [before[axis], from[axis], to[axis], after[axis]];
                let cubic = 3.0 * (q - r) + s - p;
                q + 0.5 * t * (r - p + t * (2.0 * p - 5.0 * q + 4.0 * r - s + t * cubic))
            })
        }));
    }
    all
}

/// A tea cup with a handle to the right.
fn cup() -> Solid {
    // Radius and height: under the foot, up the outside, over the lip, down the inside.
    let outside = [
        [0.22, 0.0],
        [0.243, 0.012],
        [0.275, 0.05],
        [0.325, 0.14],
        [0.375, 0.28],
        [0.408, 0.45],
        [0.428, 0.66],
        [0.438, 0.84],
    ];
    let lip = [[0.438, 0.882], [0.43, 0.892], [0.42, 0.886]];
    let inside = [
        [0.41, 0.68],
        [0.389, 0.45],
        [0.345, 0.25],
        [0.27, 0.13],
        [0.14, 0.085],
    ];
    let profile = [&outside[..], &lip[..], &inside[..]].concat();
    let mut solid = Solid::default();
    let ring = |[radius, y]: &[f32; 2]| -> Vec<Vec3> {
        let point = |[x, z]: [f32; 2]| Vec3::new(radius * x, *y, radius * z);
        circle(AROUND).into_iter().map(point).collect()
    };
    let foot = ring(&[0.2, 0.0]);
    let hollow = ring(&[0.19, 0.025]);
    let mut rings = vec![hollow, foot];
    rings.extend(curve(&profile, 4).iter().map(ring));
    solid.through(&rings, [Some(0.025 * Vec3::Y), Some(0.08 * Vec3::Y)]);
    // The handle's ends lie within the wall.
    let ear = [
        [0.418, 0.70],
        [0.50, 0.725],
        [0.62, 0.715],
        [0.70, 0.62],
        [0.69, 0.47],
        [0.60, 0.33],
        [0.48, 0.255],
        [0.372, 0.245],
    ];
    let way = curve(&ear, 8);
    let across = circle(20);
    let rings: Vec<Vec<Vec3>> = (0..way.len())
        .map(|i| {
            let [x, y] = way[i];
            let [before, after] = [way[i.saturating_sub(1)], way[(i + 1).min(way.len() - 1)]];
            let ahead = Vec3::new(after[0] - before[0], after[1] - before[1], 0.0).normalize();
            let out = Vec3::Z.cross(ahead);
            let point =
                |[s, c]: &[f32; 2]| Vec3::new(x, y, 0.0) + 0.03 * c * out + 0.045 * s * Vec3::Z;
            across.iter().map(point).collect()
        })
        .collect();
    let ends = [ear[0], ear[ear.len() - 1]].map(|[x, y]| Some(Vec3::new(x, y, 0.0)));
    solid.through(&rings, ends);
    solid.fitted()
}

fn cube() -> Solid {
    let ring = |y: f32| -> Vec<Vec3> {
        let corners = [[0.5, 0.5], [0.5, -0.5], [-0.5, -0.5], [-0.5, 0.5]];
        corners.map(|[x, z]| Vec3::new(x, y, z)).into()
    };
    let mut solid = Solid::default();
    let rings = [ring(-0.5), ring(0.5)];
    solid.through(&rings, [None; 2]);
    solid
        .faces
        .extend([[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]]);
    solid
}

/// A gear of twelve teeth with a rim, a web and a hub, its axis to the eye.
fn gear() -> Solid {
    const TEETH: usize = 12;
    /// Where corners of a tooth are, of its pitch, and whether they are on its tip.
    const TOOTH: [(f32, bool); 8] = [
        (0.0, false),
        (0.12, false),
        (0.24, false),
        (0.36, true),
        (0.5, true),
        (0.64, true),
        (0.76, false),
        (0.88, false),
    ];
    let directions: Vec<([f32; 2], bool)> = (0..TEETH * TOOTH.len())
        .map(|i| {
            let (place, is_tip) = TOOTH[i % TOOTH.len()];
            let tooth = (i / TOOTH.len()) as f32;
            let (sin, cos) = sin_cos(360.0 * (tooth + place) / TEETH as f32);
            ([cos, sin], is_tip)
        })
        .collect();
    let ring = |root: f32, tip: f32, z: f32| -> Vec<Vec3> {
        let point = |([x, y], is_tip): &([f32; 2], bool)| {
            let radius = if *is_tip { tip } else { root };
            Vec3::new(radius * x, radius * y, z)
        };
        directions.iter().map(point).collect()
    };
    let round = |radius: f32, z: f32| ring(radius, radius, z);
    let mut solid = Solid::default();
    // From the bore along the back to the teeth, over them, and along the front.
    solid.around(&[
        round(0.075, -0.13),
        round(0.15, -0.13),
        round(0.15, -0.04),
        round(0.33, -0.04),
        round(0.33, -0.1),
        ring(0.405, 0.5, -0.1),
        ring(0.405, 0.5, 0.1),
        round(0.33, 0.1),
        round(0.33, 0.04),
        round(0.15, 0.04),
        round(0.15, 0.13),
        round(0.075, 0.13),
    ]);
    solid.fitted()
}

/// A bird that beats its wings, at a share of a beat. It flies to the eye.
fn wings(beat: f64) -> Solid {
    const FEATHERS: usize = 8;
    const PER_FEATHER: usize = 8;
    const COLUMNS: usize = FEATHERS * PER_FEATHER;
    const ROWS: usize = 14;
    let degrees = 360.0 * beat as f32;
    let (bob, _) = sin_cos(degrees);
    let mut solid = Solid::default();
    // The wing goes on from a root within the body; its outer part follows its inner part later.
    let mut line = vec![([0.015, 0.02], 0.0)];
    for column in 1..=COLUMNS {
        let s = column as f32 / COLUMNS as f32;
        let (up, _) = sin_cos(degrees - 80.0 * s);
        let angle = 10.0 + 36.0 * up - 16.0 * s;
        let (sin, cos) = sin_cos(angle);
        let ([x, y], _) = line[column - 1];
        let step = 0.5 / COLUMNS as f32;
        line.push(([x + step * cos, y + step * sin], angle));
    }
    line[0].1 = line[1].1;
    let section = |column: usize, side: f32| -> Vec<Vec3> {
        let s = column as f32 / COLUMNS as f32;
        let ([x, y], angle) = line[column];
        let (sin, cos) = sin_cos(angle);
        // A feather's end is round, with a notch to the next one.
        let (notch, _) = sin_cos(180.0 * (column % PER_FEATHER) as f32 / PER_FEATHER as f32);
        let front = 0.10 + 0.10 * sin_cos(140.0 * s).0 - 0.17 * s * s;
        let back = -0.15 - 0.10 * sin_cos(130.0 * s).0 + 0.06 * s * s - (0.015 + 0.05 * s) * notch;
        let at = |v: f32, is_above: bool| {
            let z = front + v * (back - front);
            let thick = 0.045 * (1.0 - 0.7 * s) * (v.sqrt() - v) + 0.0022 * (1.0 - v);
            // Feathers lie as tiles do, each with a back of its own.
            let tile = 0.012 * notch * v * v * (1.0 - v).sqrt();
            let camber = 0.035 * (1.0 - 0.6 * s) * 4.0 * v * (1.0 - v);
            let height = camber + if is_above { thick + tile } else { -0.4 * thick };
            Vec3::new(side * (x - sin * height), y + cos * height, z)
        };
        // Closer to each other in front, where the wing is round.
        let way = |row: usize| (row as f32 / ROWS as f32).powi(2);
        let above = (0..=ROWS).map(|row| at(way(row), true));
        let below = (1..ROWS).rev().map(|row| at(way(row), false));
        let ring: Vec<Vec3> = above.chain(below).collect();
        ring
    };
    for side in [1.0, -1.0] {
        let mut rings: Vec<Vec<Vec3>> = (0..=COLUMNS).map(|column| section(column, side)).collect();
        if side > 0.0 {
            rings.iter_mut().for_each(|ring| ring.reverse());
        }
        let ends = [&rings[0], &rings[COLUMNS]]
            .map(|ring| Some(ring.iter().sum::<Vec3>() / ring.len() as f32));
        solid.through(&rings, ends);
    }
    // From the tail to the beak: how wide, how high, and where its middle is.
    let body: [([f32; 2], [f32; 2]); 12] = [
        ([0.105, 0.006], [-0.36, 0.0]),
        ([0.09, 0.009], [-0.32, 0.0]),
        ([0.045, 0.018], [-0.23, 0.0]),
        ([0.04, 0.034], [-0.16, -0.002]),
        ([0.056, 0.056], [-0.07, -0.01]),
        ([0.066, 0.066], [0.03, -0.014]),
        ([0.056, 0.058], [0.12, -0.004]),
        ([0.045, 0.048], [0.175, 0.008]),
        ([0.046, 0.048], [0.215, 0.016]),
        ([0.034, 0.035], [0.25, 0.016]),
        ([0.012, 0.012], [0.27, 0.008]),
        ([0.007, 0.007], [0.295, 0.0]),
    ];
    let [sizes, places] = [0, 1].map(|part| {
        let points = body.map(|(size, place)| if part == 0 { size } else { place });
        curve(&points, 6)
    });
    let across = circle(32);
    let bobbed = |p: Vec3| p - Vec3::new(0.0, 0.022 * bob, 0.0);
    let ring = |([width, height], [z, y]): (&[f32; 2], &[f32; 2])| -> Vec<Vec3> {
        let point = |[sin, cos]: &[f32; 2]| bobbed(Vec3::new(-width * sin, y + height * cos, *z));
        across.iter().map(point).collect()
    };
    let rings: Vec<Vec<Vec3>> = sizes.iter().zip(&places).map(ring).collect();
    let ends = [Vec3::new(0.0, 0.0, -0.366), Vec3::new(0.0, -0.002, 0.32)].map(bobbed);
    solid.through(&rings, ends.map(Some));
    solid
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [ThingChoice; 4] = [
        ThingChoice::Cup,
        ThingChoice::Cube,
        ThingChoice::Gear,
        ThingChoice::Wings,
    ];

    fn thing(shape: ThingChoice) -> Thing {
        Thing::new(shape).unwrap()
    }

    #[test]
    fn they_are_closed_and_turned_outwards() {
        for shape in ALL {
            let thing = thing(shape);
            let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
            for [a, b, c] in &thing.faces {
                for [from, to] in [[a, b], [b, c], [c, a]] {
                    assert!(from != to, "{shape:?}");
                    *edges.entry([*from, *to]).or_default() += 1;
                    *edges.entry([*to, *from]).or_default() -= 1;
                }
            }
            assert!(edges.values().all(|count| *count == 0), "{shape:?} is open");
            let volume: f32 = thing
                .faces
                .iter()
                .map(|face| {
                    let [a, b, c] = face.map(|point| thing.points[point as usize]);
                    a.dot(b.cross(c)) / 6.0
                })
                .sum();
            assert!(volume > 0.001, "{shape:?}: {volume}");
        }
    }

    #[test]
    fn they_are_one_high_or_wide() {
        for shape in ALL {
            let thing = thing(shape);
            let size = thing.points.iter().copied().reduce(Vec3::max).unwrap()
                - thing.points.iter().copied().reduce(Vec3::min).unwrap();
            let largest = size.max_element();
            let off = if shape == ThingChoice::Wings {
                0.1
            } else {
                1e-5
            };
            assert!((largest - 1.0).abs() < off, "{shape:?}: {size}");
            assert!(thing.faces.len() < 16_000);
        }
    }

    #[test]
    fn edges_have_a_corner_for_each_side() {
        let cube = thing(ThingChoice::Cube);
        assert_eq!((cube.points.len(), cube.corners.len()), (8, 24));
        let whole = Placed {
            middle: Vec3::ZERO,
            turn: Quat::IDENTITY,
            size_m: 1.0,
        };
        let [_, normals] = cube.in_place(&whole);
        assert!(
            normals
                .iter()
                .all(|n| (n.abs().max_element() - 1.0).abs() < 1e-6)
        );
    }

    #[test]
    fn wings_beat_and_come_back() {
        let moving = Beating {
            thing: Arc::new(thing(ThingChoice::Wings)),
            placed: Placed {
                middle: Vec3::Y,
                turn: Quat::IDENTITY,
                size_m: 2.0,
            },
            beat: 2.0,
        };
        let [rest, normals] = moving.at(0.0);
        assert_eq!(rest, moving.thing.in_place(&moving.placed)[0]);
        assert_eq!(moving.at(1.5)[0], rest);
        let [half, _] = moving.at(0.125);
        let most = rest
            .iter()
            .zip(&half)
            .map(|(a, b)| a.distance(*b))
            .fold(0.0, f32::max);
        assert!(most > 0.2 && most < 2.0, "{most}");
        assert!(normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
    }
}
