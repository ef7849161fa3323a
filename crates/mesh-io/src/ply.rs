//! PLY files: text, and binary in both orders of bytes.
//!
//! A reader of our own: those that there are take memory for as many elements as a header claims, and a map for each vertex.

use std::collections::HashMap;
use std::path::Path;

use glam::{DVec3, Vec2, Vec3};

mod header;
mod numbers;

use self::header::{Element, Header};
use self::numbers::Numbers;
use crate::beside::file_in;
use crate::file::NamedFiles;
use crate::model::{Attribute, Image, ImageSource, Material, Mesh, Model, Texture, Wrap};
use crate::polygon;
use crate::read::shown;

/// Why bytes are not a PLY file with a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlyError {
    /// A line of the header, or of a text's numbers, is wrong.
    #[error("line {line}: {what}")]
    Line {
        /// The line, 1 first.
        line: usize,
        /// What is wrong there.
        what: String,
    },
    /// The header doesn't end.
    #[error("the header has no `end_header`")]
    NoEnd,
    /// An element that is not whole.
    #[error("{element} {index}: {what}")]
    Element {
        /// The element's name, such as `vertex`.
        element: String,
        /// Its number, 0 first.
        index: usize,
        /// What is wrong with it.
        what: String,
    },
    /// Vertices without a place.
    #[error("its vertices have no `{0}`")]
    NoPlace(&'static str),
    /// Nothing to draw.
    #[error("no triangle with an area was found")]
    NoTriangles,
}

/// Reads the mesh of a PLY file's bytes, in the file's own axes and units. Polygons are cut into triangles, concave ones too; triangles
/// without an area are left out. Places in a texture may be of vertices (`u v`, `s t`, `texture_u texture_v`) or of faces' corners
/// (`texcoord`); other numbers of vertices become attributes. A texture that a comment names (`TextureFile`) is in `folder` or below.
///
/// # Errors
///
/// When the header or an element cannot be read, a face's vertex is missing or not finite, or there is no triangle.
pub fn from_bytes(bytes: &[u8], folder: &Path) -> Result<Model, PlyError> {
    let header = Header::read(bytes)?;
    let mut numbers = Numbers {
        format: header.format,
        rest: &bytes[header.length..],
        line: header.lines,
    };
    let mut vertices = Vertices::default();
    let mut faces = Vec::new();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => vertices = Vertices::read(element, &mut numbers)?,
            "face" => faces = read_faces(element, &mut numbers)?,
            _ => numbers.each(element, |_, _| {})?,
        }
    }
    let mut mesh = vertices.mesh(&faces)?;
    mesh.mend_normals();

    let mut model = Model::default();
    if let Some(name) = &header.texture {
        match file_in(folder, name).filter(|path| path.is_file()) {
            Some(path) => {
                model.images.push(Image {
                    name: name.clone(),
                    source: ImageSource::File(path),
                });
                mesh.material = Some(0);
                let wrap = [Wrap::Repeat; 2];
                model.materials.push(Material {
                    name: name.clone(),
                    texture: Some(Texture { image: 0, wrap }),
                    ..Material::default()
                });
            }
            None => model.notes.push(format!(
                "the texture `{}` is not in the file's folder, or below",
                shown(name)
            )),
        }
    }
    model.meshes.push(mesh);
    Ok(model)
}

/// The picture, in `folder` or below, that a file's header names.
pub(crate) fn named_files(bytes: &[u8], folder: &Path) -> Result<NamedFiles, PlyError> {
    let texture = Header::read(bytes)?.texture;
    let file = texture.and_then(|name| file_in(folder, &name));
    Ok(NamedFiles {
        paint: file.into_iter().collect(),
        ..NamedFiles::default()
    })
}

#[derive(Default)]
struct Vertices {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    attributes: Vec<Attribute>,
}

/// What names places in a texture have, by the programs that write them.
const UVS: [[&str; 2]; 3] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]];

impl Vertices {
    fn read(element: &Element, numbers: &mut Numbers) -> Result<Self, PlyError> {
        let properties = &element.properties;
        let is_single = |name: &str| {
            properties
                .iter()
                .position(|p| p.name == name && p.list.is_none())
        };
        for name in ["x", "y", "z"] {
            is_single(name).ok_or(PlyError::NoPlace(name))?;
        }
        let mut columns: Vec<Vec<f64>> = properties.iter().map(|_| Vec::new()).collect();
        numbers.each(element, |property, values| {
            if properties[property].list.is_none() {
                columns[property].extend(values);
            }
        })?;
        let column = |name: &str| is_single(name).map(|property| &columns[property]);
        let vectors = |names: [&str; 3]| -> Vec<Vec3> {
            let [Some(x), Some(y), Some(z)] = names.map(column) else {
                return Vec::new();
            };
            let triples = x.iter().zip(y).zip(z);
            triples
                .map(|((x, y), z)| DVec3::new(*x, *y, *z).as_vec3())
                .collect()
        };
        let finite = |value: f64| {
            if (value as f32).is_finite() {
                value as f32
            } else {
                0.0
            }
        };
        let pair = UVS
            .into_iter()
            .find(|names| names.iter().all(|name| is_single(name).is_some()));
        let uvs = pair.map_or(Vec::new(), |names| {
            let [Some(u), Some(v)] = names.map(column) else {
                return Vec::new();
            };
            u.iter()
                .zip(v)
                .map(|(u, v)| Vec2::new(finite(*u), finite(1.0 - *v)))
                .collect()
        });
        let has_normals = ["nx", "ny", "nz"]
            .iter()
            .all(|name| is_single(name).is_some());
        let is_taken = |name: &str| {
            ["x", "y", "z"].contains(&name)
                || (has_normals && ["nx", "ny", "nz"].contains(&name))
                || pair.is_some_and(|pair| pair.contains(&name))
        };
        let others = properties
            .iter()
            .zip(&columns)
            .filter(|(property, _)| property.list.is_none() && !is_taken(&property.name));
        let attributes = others.map(|(property, values)| {
            let is_color = ["red", "green", "blue", "alpha"].contains(&property.name.as_str());
            let most = if is_color { property.kind.most() } else { 1.0 };
            Attribute {
                name: property.name.clone(),
                width: 1,
                values: values.iter().map(|value| finite(value / most)).collect(),
            }
        });
        Ok(Self {
            positions: vectors(["x", "y", "z"]),
            normals: if has_normals {
                vectors(["nx", "ny", "nz"])
            } else {
                Vec::new()
            },
            uvs,
            attributes: attributes.collect(),
        })
    }

    fn mesh(&self, faces: &[Face]) -> Result<Mesh, PlyError> {
        let mut mesh = Mesh {
            attributes: self
                .attributes
                .iter()
                .map(|own| Attribute {
                    values: Vec::new(),
                    ..own.clone()
                })
                .collect(),
            ..Mesh::default()
        };
        let has_uvs = !self.uvs.is_empty() || faces.iter().any(|face| !face.uvs.is_empty());
        let mut known = HashMap::new();
        for face in faces {
            let wrong = |what| PlyError::Element {
                element: "face".to_owned(),
                index: face.number,
                what,
            };
            let mut corners = Vec::with_capacity(face.corners.len());
            for &corner in &face.corners {
                let found = (corner >= 0.0 && corner < self.positions.len() as f64)
                    .then_some(corner as usize);
                let vertex = found.ok_or_else(|| {
                    wrong(format!(
                        "there is no vertex {corner}, there are {}",
                        self.positions.len()
                    ))
                })?;
                if !self.positions[vertex].is_finite() {
                    return Err(wrong(format!(
                        "vertex {vertex} is at {}, which is not finite",
                        self.positions[vertex]
                    )));
                }
                corners.push(vertex);
            }
            let place = |vertex: &usize| self.positions[*vertex].as_dvec3();
            let places: Vec<_> = corners.iter().map(place).collect();
            for triangle in polygon::triangles(&places) {
                let indices = triangle.map(|corner| {
                    let vertex = corners[corner];
                    let own = face.uvs.get(corner).copied();
                    let key = (vertex, own.map(|uv| uv.to_array().map(f32::to_bits)));
                    *known.entry(key).or_insert_with(|| {
                        mesh.positions.push(self.positions[vertex]);
                        if has_uvs {
                            let uv = own.or(self.uvs.get(vertex).copied());
                            mesh.uvs.push(uv.unwrap_or_default());
                        }
                        mesh.normals.extend(self.normals.get(vertex));
                        for (to, from) in mesh.attributes.iter_mut().zip(&self.attributes) {
                            to.values.push(from.values[vertex]);
                        }
                        mesh.positions.len() as u32 - 1
                    })
                });
                mesh.triangles.push(indices);
            }
        }
        if mesh.triangles.is_empty() {
            return Err(PlyError::NoTriangles);
        }
        Ok(mesh)
    }
}

#[derive(Default)]
struct Face {
    /// Its number, 0 first.
    number: usize,
    corners: Vec<f64>,
    /// One a corner, or none.
    uvs: Vec<Vec2>,
}

fn read_faces(element: &Element, numbers: &mut Numbers) -> Result<Vec<Face>, PlyError> {
    let is_list = |names: &[&str]| {
        element
            .properties
            .iter()
            .position(|p| p.list.is_some() && names.contains(&p.name.as_str()))
    };
    let corners = is_list(&["vertex_indices", "vertex_index"]);
    let uvs = is_list(&["texcoord"]);
    let mut faces = Vec::new();
    let mut face = Face::default();
    let last = element.properties.len().saturating_sub(1);
    numbers.each(element, |property, values| {
        if Some(property) == corners {
            face.corners = values.to_vec();
        } else if Some(property) == uvs {
            let uv = |pair: &[f64]| Vec2::new(pair[0] as f32, 1.0 - pair[1] as f32);
            let finite = |uv: Vec2| if uv.is_finite() { uv } else { Vec2::ZERO };
            face.uvs = values.chunks_exact(2).map(uv).map(finite).collect();
        }
        if property == last {
            let next = face.number + 1;
            let whole = std::mem::take(&mut face);
            if whole.corners.len() >= 3 {
                faces.push(whole);
            }
            face.number = next;
        }
    })?;
    Ok(faces)
}

#[cfg(test)]
mod tests;
