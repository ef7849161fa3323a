//! The figure: the bust's skull with a face, a body and a dress that a preset chooses.

mod body;
mod crop;
mod dress;
mod face;
mod planes;
mod sewn;

pub use dress::{Cloth, Dress};
pub use face::{Blush, Expression, Eyes, Face};

use crate::bust::{CENTER, HEIGHT};
use crate::cut::cut;
use crate::shape::distance_to_ear;
use crate::solid::{common, gradient};
use crate::surface_nets::{Grid, Net, planes as planes_of, relax, surface_net, with_image};
use crate::{Bust, Scalp, Shell};
use glam::Vec3;
use sewn::Piece;

/// What a figure is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// How far below the chin it is cut off, in metres, 0.1 to 0.6.
    pub crop_m: f32,
    /// What it wears.
    pub dress: Dress,
    /// Its drawn face.
    pub face: Face,
}

impl Default for Figure {
    fn default() -> Self {
        Self {
            crop_m: 0.25,
            dress: Dress::None,
            face: Face::default(),
        }
    }
}

/// Lines end in this height above the cut, metres.
const FADE: f32 = 0.055;

impl Figure {
    /// Makes it. Its skull is the bust's, so that hair fits both.
    #[must_use]
    pub fn build(&self) -> Bust {
        let cut_height = body::CHIN - self.crop_m.clamp(0.1, 0.6);
        let solid = |p: Vec3| common(self.dress.distance(p), cut_height - p.y, 0.003);
        let (half, cloth) = self.half(solid, cut_height);
        let net = with_image(half);
        let mut cloth = [cloth.as_slice(), &cloth].concat();
        let Net {
            mut positions,
            mut triangles,
        } = net;

        let mut normals: Vec<Vec3> = positions.iter().map(|p| shading_normal(*p)).collect();
        let mut facing: Vec<Vec3> = positions
            .iter()
            .zip(&normals)
            .map(|(p, normal)| planes::facing(*p, *normal))
            .collect();
        let mut shade: Vec<f32> = positions.iter().map(|p| body::jaw_shade(*p)).collect();
        let shell = Shell::new(&positions, &normals, &triangles, CENTER, HEIGHT);
        let mut scalp: Vec<f32> = positions
            .iter()
            .map(|p| above_hairline(&shell, *p))
            .collect();

        for piece in self.pieces(cut_height) {
            let first = positions.len() as u32;
            let own = normals_of(&piece);
            shade.extend(own.iter().map(|_| 0.0));
            scalp.extend(own.iter().map(|_| -90.0));
            match piece.is_lit_as_body {
                true => facing.extend(piece.positions.iter().map(|p| shading_normal(*p))),
                false => facing.extend(&own),
            }
            positions.extend(piece.positions);
            normals.extend(own);
            triangles.extend(piece.triangles.iter().map(|t| t.map(|i| first + i)));
            cloth.extend(piece.cloth);
        }
        let outline = positions
            .iter()
            .map(|p| planes::smooth((p.y - cut_height) / FADE))
            .collect();
        let is_bare = matches!(self.dress, Dress::None | Dress::Choker);
        Bust {
            patches: face::patches(&self.face, &|p| body::skin(p, 1.0), is_bare),
            positions,
            normals,
            facing,
            outline,
            shade,
            scalp,
            triangles,
            cloth,
        }
    }

    /// The half where x is 0 or above, cut along its hems, with what each triangle is painted as.
    fn half(&self, solid: impl Fn(Vec3) -> f32, cut_height: f32) -> (Net, Vec<Cloth>) {
        let near = |from: f32, to: f32, growth: f32, most: f32| {
            move |at: f32| (0.0047 + growth * (from - at).max(at - to).max(0.0)).min(most)
        };
        let grid = Grid {
            // The first cells lie across x = 0.
            x: planes_of(-0.00235, 0.23, near(-0.01, 0.095, 0.12, 0.0100)),
            y: planes_of(cut_height - 0.03, 1.64, near(1.335, 1.52, 0.10, 0.0280)),
            z: planes_of(-0.15, 0.12, near(-0.02, 0.11, 0.12, 0.0100)),
        };
        let mut net = surface_net(&solid, &grid);
        relax(&mut net, &solid, 6);
        let layers = self.dress.layers();
        let mut fields: Vec<Vec<f32>> = layers
            .iter()
            .map(|layer| net.positions.iter().map(|p| (layer.field)(*p)).collect())
            .collect();
        for (i, layer) in layers.iter().enumerate() {
            for level in [layer.from, layer.to] {
                if level.is_finite() {
                    cut(&mut net, &mut fields, i, level);
                }
            }
        }
        let cloth_of = |triangle: &[u32; 3]| {
            let covers = |(i, layer): &(usize, &dress::Layer)| {
                let sum: f32 = triangle.iter().map(|k| fields[*i][*k as usize]).sum();
                (layer.from..layer.to).contains(&(sum / 3.0))
            };
            let top = layers.iter().enumerate().rfind(covers);
            top.map_or(Cloth::Skin, |(_, layer)| layer.cloth)
        };
        let cloth = net.triangles.iter().map(cloth_of).collect();
        (net, cloth)
    }

    /// What is sewn on, on both sides, above the cut.
    fn pieces(&self, cut_height: f32) -> Vec<Piece> {
        let halves = self.dress.pieces().into_iter().map(|piece| {
            let net = with_image(Net {
                positions: piece.positions,
                triangles: piece.triangles,
            });
            Piece {
                positions: net.positions,
                triangles: net.triangles,
                cloth: [piece.cloth.as_slice(), &piece.cloth].concat(),
                is_lit_as_body: piece.is_lit_as_body,
            }
        });
        let pieces = halves.chain(self.dress.middle_pieces());
        pieces.map(|piece| piece.above(cut_height)).collect()
    }
}

/// The skin's unit normal without what is smaller than 16 mm, but for the ears.
fn shading_normal(p: Vec3) -> Vec3 {
    let step = (0.002 + distance_to_ear(p).max(0.0)).min(0.016);
    let round = |p: Vec3| body::skin(p, 0.0);
    gradient(round, p, step).normalize_or(Vec3::Y)
}

/// How far above the hairline a position lies, degrees; below 0 on the ears.
pub(crate) fn above_hairline(shell: &Shell, p: Vec3) -> f32 {
    let place = shell.place(p);
    let above = place.latitude - Scalp::default().hairline_at(place.longitude);
    above.min((distance_to_ear(p) - 0.003) * 1e3)
}

/// Unit normals: means over the triangles around each position.
fn normals_of(piece: &Piece) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; piece.positions.len()];
    for triangle in &piece.triangles {
        let [a, b, c] = triangle.map(|i| piece.positions[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for i in triangle {
            sums[*i as usize] += normal;
        }
    }
    sums.into_iter()
        .map(|sum| sum.normalize_or(Vec3::Y))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape;
    use std::collections::HashMap;

    const DRESSES: [Dress; 6] = [
        Dress::None,
        Dress::Choker,
        Dress::Turtleneck,
        Dress::Collar,
        Dress::Jacket,
        Dress::Sailor,
    ];

    fn dressed(dress: Dress, crop_m: f32) -> Bust {
        let face = Face::default();
        Figure {
            crop_m,
            dress,
            face,
        }
        .build()
    }

    #[test]
    fn it_is_closed_in_every_dress() {
        for (i, dress) in DRESSES.into_iter().enumerate() {
            let figure = dressed(dress, 0.15 + 0.08 * i as f32);
            assert_eq!(figure.cloth.len(), figure.triangles.len());
            let mut edges = HashMap::new();
            for [a, b, c] in figure.triangles {
                for edge in [(a, b), (b, c), (c, a)] {
                    *edges.entry(edge).or_insert(0) += 1;
                }
            }
            for ((a, b), count) in &edges {
                let other = edges.get(&(*b, *a));
                assert_eq!(
                    (*count, other),
                    (1, Some(&1)),
                    "{dress:?}: each edge has two sides"
                );
            }
        }
    }

    #[test]
    fn nothing_hangs_below_the_cut() {
        for dress in [Dress::Collar, Dress::Jacket, Dress::Sailor] {
            let crop_m = 0.15;
            let positions = dressed(dress, crop_m).positions.into_iter();
            let lowest = positions.map(|p| p.y).fold(f32::MAX, f32::min);
            // The body's own edge lies between coarse cells.
            let cut_height = body::CHIN - crop_m;
            assert!(lowest > cut_height - 0.01, "{dress:?}: {lowest}");
            let pieces = dress.pieces().into_iter().chain(dress.middle_pieces());
            let hang = pieces.flat_map(|piece| piece.positions);
            assert!(hang.map(|p| p.y).fold(f32::MAX, f32::min) < cut_height - 0.01);
        }
    }

    #[test]
    fn both_sides_are_the_same() {
        for dress in DRESSES {
            let figure = dressed(dress, 0.25);
            let place = |p: Vec3| (p * 1e5).round().as_ivec3();
            let all: HashMap<_, _> = figure
                .positions
                .iter()
                .map(|p| place(*p))
                .zip(0..)
                .collect();
            let mut alone = 0;
            for (i, p) in figure.positions.iter().enumerate() {
                let Some(image) = all.get(&place(p.with_x(-p.x))) else {
                    alone += 1;
                    continue;
                };
                let other: usize = *image;
                let turned = figure.facing[other] * Vec3::new(-1.0, 1.0, 1.0);
                // Pieces across the middle are cut into triangles from one side.
                let is_even = figure.facing[i].distance(turned) < 2e-3;
                assert!(is_even || dress != Dress::None, "at {p}");
            }
            assert!(
                alone * 200 < figure.positions.len(),
                "{dress:?}: {alone} without an image"
            );
        }
    }

    #[test]
    fn hair_grows_on_it_as_on_the_bust() {
        let mut near = 0;
        for i in 0..40_000 {
            let at = |step: usize, low: f32, high: f32| {
                low + (high - low) * (i * step % 9973) as f32 / 9973.0
            };
            let p = Vec3::new(at(7, -0.1, 0.1), at(313, 1.53, 1.63), at(1013, -0.13, 0.11));
            let bust = shape::distance(p);
            if bust.abs() < 0.005 {
                let figure = body::skin(p, 1.0);
                assert!((figure - bust).abs() < 1e-4, "{p}: {figure} {bust}");
                near += 1;
            }
        }
        assert!(near > 1000, "{near}");
    }

    #[test]
    fn no_light_cuts_an_eye() {
        for eyes in [Eyes::Round, Eyes::Almond, Eyes::Sharp, Eyes::Sleepy] {
            let face = Face {
                eyes,
                eye_size: 1.2,
                ..Face::default()
            };
            let figure = Figure {
                face,
                ..Figure::default()
            };
            let figure = figure.build();
            let white = figure.patches.iter();
            let white = white.filter(|patch| patch.ink == crate::Ink::White);
            let white: Vec<Vec3> = white.flat_map(|patch| patch.positions.clone()).collect();
            for side in [1.0, -1.0] {
                // The triangles below the white of this eye.
                let is_below = |triangle: &&[u32; 3]| {
                    let [a, b, c] = triangle.map(|i| figure.positions[i as usize]);
                    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
                    let is_over = |p: &Vec3| {
                        let (from, to) = (low.truncate(), high.truncate());
                        p.x * side > 0.0
                            && p.truncate().cmpge(from).all()
                            && p.truncate().cmple(to).all()
                    };
                    low.z > 0.02 && white.iter().any(is_over)
                };
                let below: Vec<_> = figure.triangles.iter().filter(is_below).collect();
                assert!(below.len() > 100, "{}", below.len());
                let corners = below.iter().flat_map(|triangle| triangle.iter());
                let mut facing = corners.map(|i| figure.facing[*i as usize]);
                // One plane: whatever the light, all of it is lit or none.
                let first = facing.next().unwrap();
                for other in facing {
                    assert!(first.distance(other) < 1e-5, "{eyes:?}: {first} {other}");
                }
            }
        }
    }
}
