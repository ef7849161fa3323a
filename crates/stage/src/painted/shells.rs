//! Shells: meshes a little outside of others, which face inwards and are seen from there alone, as toon models have them for their outlines.

use super::shown;
use glam::{IVec3, Vec3};
use mesh_io::{Mesh, Model};
use std::collections::HashMap;

/// A shell lies no farther from what it is around than this part of the diagonal of the box around all.
const REACH: f32 = 0.04;
/// So many of its vertices are looked at.
const LOOKED_AT: usize = 400;
/// Of these so many lie outside of something that faces them.
const MOST: f32 = 0.6;
/// The cosine between the normals of two vertices that face each other is below this.
const FACING: f32 = -0.5;

/// Of each mesh of a model whether it is a shell, which is seen past the edges of what it is around: single-sided triangles aren't seen from behind
/// (glTF 2.0, 3.9.6). `is_gone` tells of each mesh and each of its triangles whether it is not drawn.
pub(crate) fn shells(model: &Model, is_gone: &[Vec<bool>]) -> Vec<bool> {
    let mut is_shell = vec![false; model.meshes.len()];
    let has_one_side = |mesh: &Mesh| {
        let material = mesh.material.and_then(|index| model.materials.get(index));
        material.is_some_and(|material| !material.double_sided)
    };
    // Other formats don't say which side is seen.
    let may_be = |mesh: &Mesh| has_one_side(mesh) && faces_inwards(mesh);
    let candidates: Vec<usize> = shown(is_gone)
        .filter(|index| model.rig.is_some() && may_be(&model.meshes[*index]))
        .collect();
    if candidates.is_empty() || shown(is_gone).count() < 2 {
        return is_shell;
    }
    let near = Near::new(shown(is_gone).map(|index| (index, &model.meshes[index])));
    for index in candidates {
        is_shell[index] = near.is_around_others(index);
    }
    is_shell
}

/// Whether triangles face the middle more than away from it: of what a shell is around, and the shell, which face each other, the shell does.
fn faces_inwards(mesh: &Mesh) -> bool {
    let middle = mesh.positions.iter().sum::<Vec3>() / mesh.positions.len().max(1) as f32;
    let volumes = mesh.corners().map(|corners| {
        let [a, b, c] = corners.map(|place| (place - middle).as_dvec3());
        a.dot(b.cross(c))
    });
    volumes.sum::<f64>() < 0.0
}

/// A vertex of a mesh, with the normal of the triangles around it, whatever normals its file has.
#[derive(Clone, Copy)]
struct Vertex {
    mesh: usize,
    place: Vec3,
    normal: Vec3,
}

/// The vertices of meshes, by where they lie.
struct Near {
    vertices: Vec<Vertex>,
    /// In cells as wide as the reach.
    cells: HashMap<IVec3, Vec<u32>>,
    reach: f32,
    /// Where cells begin.
    low: Vec3,
}

impl Near {
    fn new<'m>(meshes: impl Iterator<Item = (usize, &'m Mesh)>) -> Self {
        let vertices: Vec<Vertex> = meshes
            .flat_map(|(index, mesh)| vertices(index, mesh))
            .collect();
        let places = || vertices.iter().map(|vertex| vertex.place);
        let low = places().fold(Vec3::INFINITY, Vec3::min);
        let high = places().fold(Vec3::NEG_INFINITY, Vec3::max);
        let mut near = Self {
            reach: (REACH * (high - low).length()).max(f32::MIN_POSITIVE),
            vertices,
            cells: HashMap::new(),
            low,
        };
        for number in 0..near.vertices.len() {
            let cell = near.cell(near.vertices[number].place);
            near.cells.entry(cell).or_default().push(number as u32);
        }
        near
    }

    fn cell(&self, place: Vec3) -> IVec3 {
        ((place - self.low) / self.reach).floor().as_ivec3()
    }

    /// Whether most vertices of a mesh have, in front of them, the outside of another one.
    fn is_around_others(&self, mesh: usize) -> bool {
        let own: Vec<&Vertex> = self
            .vertices
            .iter()
            .filter(|own| own.mesh == mesh)
            .collect();
        let step = own.len().div_ceil(LOOKED_AT).max(1);
        let looked_at = || own.iter().step_by(step);
        let around = looked_at().filter(|own| {
            self.nearest_other(own).is_some_and(|other| {
                let way = other.place - own.place;
                own.normal.dot(other.normal) < FACING && way.dot(own.normal) > 0.0
            })
        });
        around.count() as f32 > MOST * looked_at().count() as f32
    }

    /// The vertex of another mesh that is nearest to one, if any is within reach.
    fn nearest_other(&self, own: &Vertex) -> Option<&Vertex> {
        let cell = self.cell(own.place);
        let around =
            (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| (x, y, z))));
        let cells = around.filter_map(|way| self.cells.get(&(cell + IVec3::from(way))));
        let others = cells
            .flatten()
            .map(|number| &self.vertices[*number as usize]);
        let distance = |other: &Vertex| other.place.distance_squared(own.place);
        others
            .filter(|other| other.mesh != own.mesh && distance(other) <= self.reach * self.reach)
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

/// The vertices of a mesh, but for those whose triangles have no area; each place once, as corners may have it several times.
fn vertices(mesh_index: usize, mesh: &Mesh) -> Vec<Vertex> {
    let mut normals: HashMap<[u32; 3], Vec3> = HashMap::new();
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| mesh.positions[i as usize]);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        for corner in corners {
            *normals
                .entry(corner.to_array().map(f32::to_bits))
                .or_default() += normal;
        }
    }
    let mut seen = HashMap::new();
    let mut vertices = Vec::new();
    for place in &mesh.positions {
        let bits = place.to_array().map(f32::to_bits);
        let normal = normals.get(&bits).and_then(|normal| normal.try_normalize());
        if let (Some(normal), None) = (normal, seen.insert(bits, ())) {
            vertices.push(Vertex {
                mesh: mesh_index,
                place: *place,
                normal,
            });
        }
    }
    vertices
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_io::{Material, Rig};

    /// A tube or cone along Y, wider by `flare` at its upper end; facing outwards, or else inwards.
    fn tube(middle: Vec3, radius: f32, flare: f32, outwards: bool) -> Mesh {
        const AROUND: u32 = 16;
        let mut mesh = Mesh {
            material: Some(0),
            ..Mesh::default()
        };
        for row in 0..5 {
            for i in 0..AROUND {
                let angle = i as f32 * std::f32::consts::TAU / AROUND as f32;
                let radius = radius + flare * row as f32 / 4.0;
                let at = Vec3::new(angle.cos() * radius, 0.1 * row as f32, angle.sin() * radius);
                mesh.positions.push(middle + at);
            }
        }
        for row in 0..4 {
            for i in 0..AROUND {
                let at = |row: u32, i: u32| row * AROUND + i % AROUND;
                let [a, b] = [at(row, i), at(row, i + 1)];
                let [c, d] = [at(row + 1, i), at(row + 1, i + 1)];
                let both = [[a, c, b], [b, c, d]];
                mesh.triangles.extend(match outwards {
                    true => both,
                    false => both.map(|[a, b, c]| [a, c, b]),
                });
            }
        }
        mesh
    }

    fn found(meshes: Vec<Mesh>, double_sided: bool, rig: Option<Rig>) -> Vec<bool> {
        let is_gone: Vec<_> = meshes
            .iter()
            .map(|mesh| vec![false; mesh.triangles.len()])
            .collect();
        let model = Model {
            materials: vec![Material {
                double_sided,
                ..Material::default()
            }],
            meshes,
            rig,
            ..Model::default()
        };
        shells(&model, &is_gone)
    }

    fn rig() -> Option<Rig> {
        Some(Rig::default())
    }

    #[test]
    fn a_shell_is_around_something_and_faces_it() {
        let arm = || tube(Vec3::ZERO, 0.05, 0.0, true);
        let around = |outwards: bool| vec![arm(), tube(Vec3::ZERO, 0.053, 0.0, outwards)];
        assert_eq!(found(around(false), false, rig()), [false, true]);
        // A sleeve, what is seen from both sides, and other formats have none.
        assert_eq!(found(around(true), false, rig()), [false, false]);
        assert_eq!(found(around(false), true, rig()), [false, false]);
        assert_eq!(found(around(false), false, None), [false, false]);
        // So it is wherever they lie.
        let far_out = around(false).into_iter().map(|mut mesh| {
            for place in &mut mesh.positions {
                *place = 100.0 * *place + 1e6;
            }
            mesh
        });
        assert_eq!(found(far_out.collect(), false, rig()), [false, true]);
        let at_one_place = around(false).into_iter().map(|mut mesh| {
            mesh.positions.fill(Vec3::splat(1e8));
            mesh
        });
        assert_eq!(found(at_one_place.collect(), false, rig()), [false, false]);
        // Nor is one far away, or alone.
        let far = vec![arm(), tube(Vec3::X, 0.053, 0.0, false)];
        assert_eq!(found(far, false, rig()), [false, false]);
        assert_eq!(
            found(vec![tube(Vec3::ZERO, 0.05, 0.0, false)], false, rig()),
            [false]
        );
        // A file that is inside out as a whole has none either.
        let inside_out = vec![
            tube(Vec3::ZERO, 0.05, 0.0, false),
            tube(Vec3::ZERO, 0.053, 0.0, false),
        ];
        assert_eq!(found(inside_out, false, rig()), [false, false]);
    }

    /// Two flared cuffs in one mesh, open, around two arms.
    #[test]
    fn cuffs_are_no_shells() {
        let pair = |radius: f32, flare: f32| {
            let [mut one, other] = [-0.3, 0.3].map(|x| tube(Vec3::X * x, radius, flare, true));
            let first = one.positions.len() as u32;
            one.positions.extend(other.positions);
            one.triangles
                .extend(other.triangles.iter().map(|t| t.map(|i| i + first)));
            one
        };
        assert_eq!(
            found(vec![pair(0.05, 0.0), pair(0.054, 0.01)], false, rig()),
            [false, false]
        );
    }
}
