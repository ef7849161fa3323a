//! The figure: the bust's skull with a face, a body and a dress that a preset chooses.

mod body;
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
        let cut_height = body::CHIN - self.crop_m;
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
        let mut scalp: Vec<f32> = positions.iter().map(|p| above_hairline(&shell, *p)).collect();

        for piece in self.pieces() {
            let first = positions.len() as u32;
            let own = normals_of(&piece);
            shade.extend(own.iter().map(|_| 0.0));
            scalp.extend(own.iter().map(|_| -90.0));
            positions.extend(piece.positions);
            facing.extend(&own);
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
            let top = layers.iter().enumerate().filter(covers).last();
            top.map_or(Cloth::Skin, |(_, layer)| layer.cloth)
        };
        let cloth = net.triangles.iter().map(cloth_of).collect();
        (net, cloth)
    }

    /// What is sewn on, on both sides.
    fn pieces(&self) -> Vec<Piece> {
        let halves = self.dress.pieces().into_iter().map(|piece| {
            let net = with_image(Net {
                positions: piece.positions,
                triangles: piece.triangles,
            });
            Piece {
                positions: net.positions,
                triangles: net.triangles,
                cloth: [piece.cloth.as_slice(), &piece.cloth].concat(),
            }
        });
        halves.chain(self.dress.middle_pieces()).collect()
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
    sums.into_iter().map(|sum| sum.normalize_or(Vec3::Y)).collect()
}
