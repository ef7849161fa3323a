//! Shells: meshes around others that face inwards and are seen from there alone, as toon models have them for their outlines.

use super::shown;
use glam::Vec3;
use mesh_io::{Mesh, Model};

/// A shell encloses at least this part of the box around it: a ball does half, cards for lashes nothing.
const ENCLOSES: f64 = 0.05;
/// In a file that is inside out what is the right way round encloses less than this of what isn't.
const INSIDE_OUT: f64 = 0.25;

/// Of each mesh of a model whether it is a shell, which is seen past the edges of what it is around: single-sided triangles aren't seen from behind
/// (glTF 2.0, 3.9.6). `is_gone` tells of each mesh and each of its triangles whether it is not drawn.
pub(crate) fn shells(model: &Model, is_gone: &[Vec<bool>]) -> Vec<bool> {
    let mut is_shell = vec![false; model.meshes.len()];
    if model.rig.is_none() {
        return is_shell; // other formats don't say which side is seen
    }
    let volumes = || shown(is_gone).map(|index| (index, volume_of(&model.meshes[index])));
    let (mut outwards, mut inwards) = (0.0, 0.0);
    for (_, volume) in volumes() {
        outwards += volume.max(0.0);
        inwards -= volume.min(0.0);
    }
    if outwards < INSIDE_OUT * inwards {
        return is_shell;
    }
    for (index, volume) in volumes() {
        let mesh = &model.meshes[index];
        let material = mesh.material.and_then(|index| model.materials.get(index));
        let has_one_side = material.is_none_or(|material| !material.double_sided);
        is_shell[index] = has_one_side && volume < -ENCLOSES * room_of(mesh);
    }
    is_shell
}

/// The volume that triangles enclose, in their unit to the third power, below 0 where they face inwards; of open ones to their middle.
pub(crate) fn volume(positions: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    let middle = positions.iter().sum::<Vec3>() / positions.len().max(1) as f32;
    let six = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|i| (positions[i as usize] - middle).as_dvec3());
        a.dot(b.cross(c))
    });
    six.sum::<f64>() / 6.0
}

fn volume_of(mesh: &Mesh) -> f64 {
    volume(&mesh.positions, &mesh.triangles)
}

/// The volume of the box around a mesh.
fn room_of(mesh: &Mesh) -> f64 {
    let places = || mesh.positions.iter().map(|place| place.as_dvec3());
    match (
        places().reduce(|a, b| a.min(b)),
        places().reduce(|a, b| a.max(b)),
    ) {
        (Some(low), Some(high)) => (high - low).element_product(),
        _ => 0.0,
    }
}
