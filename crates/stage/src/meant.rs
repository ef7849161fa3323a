//! Which triangles of a file names mean: those of meshes and materials, or else those that hang on bones.

use crate::files::StageError;
use crate::mesh_hair::groups;
use crate::names::{Names, is_meant, meant_name};
use crate::painted::names_of;
use mesh_io::{Mesh, Model, Rig};
use std::path::Path;

/// Of each mesh of a model and each of its triangles whether it is meant. A name that neither a mesh nor a material has is one of bones, and means all that
/// these and the bones below them move for the most part.
///
/// # Errors
///
/// When nothing has a name.
pub(crate) fn meant(
    names: Names,
    model: &Model,
    path: &Path,
) -> Result<Vec<Vec<bool>>, StageError> {
    let none = |mesh: &Mesh| vec![false; mesh.triangles.len()];
    let mut meant: Vec<Vec<bool>> = model.meshes.iter().map(none).collect();
    for name in names.iter() {
        let is_named = |mesh: &Mesh| names_of(model, mesh).any(|own| is_meant(name, own));
        if model.meshes.iter().any(is_named) {
            let named = model.meshes.iter().zip(&mut meant);
            for (_, meant) in named.filter(|(mesh, _)| is_named(mesh)) {
                meant.fill(true);
            }
            continue;
        }
        let chains = (model.rig.as_ref())
            .and_then(|rig| below(rig, name))
            .ok_or_else(|| StageError::NoMesh {
                path: path.to_owned(),
                hint: match all_names(model).next() {
                    None => ", nothing in it has a name".to_owned(),
                    Some(_) => meant_name(name, all_names(model)),
                },
                name: name.to_owned(),
            })?;
        for (index, meant) in meant.iter_mut().enumerate() {
            for (meant, group) in meant.iter_mut().zip(groups(&chains, model, index)) {
                *meant |= group.is_some();
            }
        }
    }
    Ok(meant)
}

/// Of each node whether it is called so, or is below one that is; nothing where none is.
fn below(rig: &Rig, name: &str) -> Option<Vec<Option<u32>>> {
    let mut chains = vec![None; rig.nodes.len()];
    for &node in rig.parents_first() {
        let own = rig.nodes[node].name.as_deref();
        let is_it = own.is_some_and(|own| is_meant(name, own));
        let above = rig.nodes[node].parent.and_then(|parent| chains[parent]);
        chains[node] = if is_it { Some(0) } else { above };
    }
    chains.iter().any(Option::is_some).then_some(chains)
}

/// All names that may be said.
fn all_names(model: &Model) -> impl Iterator<Item = &str> {
    let of_meshes = model.meshes.iter().flat_map(|mesh| names_of(model, mesh));
    let nodes = model.rig.iter().flat_map(|rig| &rig.nodes);
    of_meshes.chain(nodes.filter_map(|node| node.name.as_deref()))
}
