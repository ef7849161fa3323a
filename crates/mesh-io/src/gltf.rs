//! glTF 2.0 (.glb, .gltf) and what is built on it (.vrm).

mod bone;
mod document;
mod error;
mod humanoid;
mod materials;
mod meshes;
mod nodes;
mod numbers;
mod springs;

pub use bone::BoneMotion;
pub use error::{GltfError, PartError};

use std::path::Path;

use crate::beside::file_of_uri;
use crate::file::NamedFiles;
use crate::model::Model;
use crate::read::shown;
use document::Document;
use error::MOST_M;
use glam::Vec3;
use materials::Materials;
use numbers::Buffers;

/// What files require and this reader knows, or what changes nothing that it reads.
const KNOWN: &[&str] = &[
    "KHR_animation_pointer",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "VRM",
    "VRMC_materials_mtoon",
    "VRMC_springBone",
    "VRMC_vrm",
];

/// The most sentences that tell what was left out.
const MOST_NOTES: usize = 20;

/// Reads the meshes of a file's bytes: metres, Y up, a humanoid faces +Z. Files that the file names are in `folder` or below; a texture
/// that can't be had is told in the model's notes, as are extensions that the file requires and this build doesn't know.
///
/// # Errors
///
/// When the bytes are not glTF, or a mesh, skin, node or animation has mistakes.
pub fn from_bytes(bytes: &[u8], folder: &Path) -> Result<Model, GltfError> {
    let (document, binary) = Document::read(bytes)?;
    let mut notes = Vec::new();
    let unknown = |name: &&String| !KNOWN.contains(&name.as_str());
    for name in document
        .extensions_required
        .iter()
        .filter(unknown)
        .take(MOST_NOTES)
    {
        let name = shown(name);
        notes.push(format!("the file requires `{name}`, which this build doesn't know: what needs it may look otherwise"));
    }

    let mut buffers = Buffers::new(&document, binary, folder);
    let mut rig = nodes::read(&document, &mut buffers)?;
    let mut materials = Materials::default();
    materials.read(&document, &mut buffers, folder);
    let (meshes, deforms) = meshes::read(&document, &rig, &materials, &mut buffers, &mut notes)?;
    rig.deforms = deforms;
    rig.springs = springs::read(&document, &rig, &mut notes);
    notes.extend(nodes::missing_bones(&document).take(MOST_NOTES));
    notes.extend(nodes::unmoved(&document).take(MOST_NOTES));

    notes.append(&mut materials.notes);
    notes.truncate(MOST_NOTES);
    let mut model = Model {
        meshes,
        materials: materials.materials,
        images: materials.images,
        rig: Some(rig),
        is_metric: true,
        notes,
    };
    model.put_to_rest();
    let is_near = |place: &Vec3| place.abs().cmple(Vec3::splat(MOST_M)).all();
    match model
        .meshes
        .iter()
        .find(|mesh| !mesh.positions.iter().all(is_near))
    {
        Some(mesh) => Err(GltfError::Far(shown(&mesh.name))),
        None => Ok(model),
    }
}

/// The files, in `folder` or below, that a file's bytes name.
pub(crate) fn named_files(bytes: &[u8], folder: &Path) -> Result<NamedFiles, GltfError> {
    let (document, _) = Document::read(bytes)?;
    let file = |uri: &Option<String>| file_of_uri(folder, uri.as_deref()?);
    Ok(NamedFiles {
        buffers: (document.buffers.iter())
            .filter_map(|buffer| file(&buffer.uri))
            .collect(),
        paint: (document.images.iter())
            .filter_map(|image| file(&image.uri))
            .collect(),
    })
}

impl Model {
    /// Puts the meshes where their nodes have them at rest.
    fn put_to_rest(&mut self) {
        let Some(rig) = &self.rig else { return };
        let rest = rig.rest();
        let shapes = self.shapes(&rest);
        let world = rig.world(&rest);
        for ((mesh, shape), deform) in self.meshes.iter_mut().zip(shapes).zip(&rig.deforms) {
            mesh.positions = shape.positions;
            mesh.normals = shape.normals;
            let mirrors = rig.mirrors(deform, &world);
            for triangle in &mut mesh.triangles {
                let corners = triangle.iter().filter(|corner| mirrors(**corner as usize));
                if corners.count() >= 2 {
                    triangle.swap(1, 2);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
