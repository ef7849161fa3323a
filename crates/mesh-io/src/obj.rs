//! Wavefront OBJ files, with their materials (MTL).

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;

use glam::{Vec2, Vec3};

use crate::file::NamedFiles;
use crate::model::{ImageSource, Mesh, Model};
use crate::mtl::Library;
use crate::polygon;
use crate::read::shown;

/// Why a text is not an OBJ file with meshes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// A line is wrong.
    #[error("line {line}: {problem}")]
    At {
        /// The line, 1 first.
        line: usize,
        /// What is wrong there.
        problem: ObjProblem,
    },
    /// Nothing to draw.
    #[error("no triangle with an area was found")]
    NoTriangles,
}

/// What can be wrong in a line of an OBJ file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjProblem {
    /// A vertex, normal or place in a texture without its numbers.
    #[error("{what} is written `{written}`, found `{found}`")]
    Numbers {
        /// What the line gives.
        what: &'static str,
        /// How it is written.
        written: &'static str,
        /// The line, or the beginning of it.
        found: String,
    },
    /// A face without corners.
    #[error("a face is written `f A B C ...`, found no corner")]
    NoCorners,
    /// A corner that is no number.
    #[error("corner {corner} of the face: the number of {part} was expected, found `{found}`")]
    Corner {
        /// Which corner, 1 first.
        corner: usize,
        /// What the number is of.
        part: &'static str,
        /// The word in its place, or the beginning of it.
        found: String,
    },
    /// A corner at a vertex, normal or place in a texture that is not there.
    #[error("corner {corner} of the face: there is no {part} {index}, there are {count}")]
    Missing {
        /// Which corner, 1 first.
        corner: usize,
        /// What is not there.
        part: &'static str,
        /// The number as the file gives it: 1 first, or below 0 from the last before the face.
        index: i64,
        /// How many there are; before the face where the number is below 0.
        count: usize,
    },
    /// A face has a corner that is not finite.
    #[error("corner {corner} of the face is at {position}, which is not finite")]
    NotFinite {
        /// Which corner, 1 first.
        corner: usize,
        /// Where the file has it.
        position: Vec3,
    },
}

/// Reads the meshes of an OBJ text, in the file's own axes and units: one for each name (of `o` or `g`) and material. Polygons are cut
/// into triangles, concave ones too; triangles without an area are left out. Materials are read of the libraries that it names, in
/// `folder` or below; those that can't be had are told in the model's notes. Beside a group named `body`, those named `helper...` and
/// `joint...` are no skin (the scaffolding of MakeHuman's base mesh), and are left out with a note. Lines, curves and smoothing groups
/// are not read.
///
/// # Errors
///
/// When a vertex or face cannot be read, something that a face names is missing or not finite, or there is no triangle.
pub fn from_text(text: &str, folder: &Path) -> Result<Model, ObjError> {
    let mut shape = Shape::read(text)?;
    let mut model = Model::default();
    if shape.groups.iter().any(|group| group.name == "body") {
        let is_scaffolding = |group: &Group| {
            ["helper", "joint"]
                .iter()
                .any(|begin| group.name.starts_with(begin))
        };
        let before = shape.groups.len();
        shape.groups.retain(|group| !is_scaffolding(group));
        let left_out = before - shape.groups.len();
        if left_out > 0 {
            let text = format!("{left_out} helper and joint groups beside \"body\" are not drawn");
            model.notes.push(text);
        }
    }

    let mut library = Library::read(folder, &shape.libraries);
    for group in &shape.groups {
        let mut mesh = shape.mesh(group)?;
        if !mesh.triangles.is_empty() {
            mesh.material = group
                .material
                .as_ref()
                .and_then(|name| library.index_of(name));
            model.meshes.push(mesh);
        }
    }
    if model.meshes.is_empty() {
        return Err(ObjError::NoTriangles);
    }
    model.materials = library.materials;
    model.images = library.images;
    model.notes.extend(library.notes);
    Ok(model)
}

/// The libraries of materials, in `folder` or below, that an OBJ text names, and their pictures.
pub(crate) fn named_files(text: &str, folder: &Path) -> NamedFiles {
    let lines = logical_lines(text);
    let names = lines.filter_map(|(_, line)| {
        let (key, name) = line.trim_start().split_once(char::is_whitespace)?;
        (key == "mtllib").then(|| name.trim().to_owned())
    });
    let library = Library::read(folder, &names.collect::<Vec<_>>());
    let pictures = library.images.into_iter();
    let pictures = pictures.filter_map(|image| match image.source {
        ImageSource::File(path) => Some(path),
        ImageSource::Bytes(_) => None,
    });
    NamedFiles {
        paint: library.files.into_iter().chain(pictures).collect(),
        ..NamedFiles::default()
    }
}

/// What of a file makes its shape.
#[derive(Default)]
struct Shape {
    vertices: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    groups: Vec<Group>,
    libraries: Vec<String>,
}

/// Faces under one name, of one material.
struct Group {
    name: String,
    material: Option<String>,
    faces: Vec<Face>,
}

struct Face {
    line: usize,
    corners: Vec<Corner>,
    /// How many vertices, places and normals come before it.
    before: [usize; 3],
}

/// Vertex, place in the texture and normal as the file numbers them: 1 first, or below 0 from the last.
type Corner = [Option<i64>; 3];

/// What a corner names, as messages say it.
const PARTS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

impl Shape {
    fn read(text: &str) -> Result<Self, ObjError> {
        let mut shape = Self::default();
        let mut groups: HashMap<(String, Option<String>), usize> = HashMap::new();
        let (mut name, mut material) = (String::new(), None);
        // The group of these two, once there is a face in it.
        let mut current = None;
        for (line, text) in logical_lines(text) {
            let at = |problem| ObjError::At { line, problem };
            let numbers = |what, written| {
                let found = shown(text.trim());
                at(ObjProblem::Numbers {
                    what,
                    written,
                    found,
                })
            };
            let mut words = text.split_whitespace();
            let key = words.next();
            let rest = || key.map_or("", |key| text.trim_start()[key.len()..].trim());
            match key {
                Some("v") => {
                    let vertex = three(words).ok_or_else(|| numbers("a vertex", "v X Y Z"))?;
                    shape.vertices.push(vertex);
                }
                Some("vn") => {
                    let normal = three(words).ok_or_else(|| numbers("a normal", "vn X Y Z"))?;
                    shape.normals.push(normal);
                }
                Some("vt") => {
                    let uv =
                        place(words).ok_or_else(|| numbers("a texture coordinate", "vt U V"))?;
                    shape.uvs.push(uv);
                }
                Some("f") => {
                    let face = Face {
                        line,
                        corners: corners(words).map_err(at)?,
                        before: [shape.vertices.len(), shape.uvs.len(), shape.normals.len()],
                    };
                    let group = *current.get_or_insert_with(|| {
                        let key = (name.clone(), material.clone());
                        *groups.entry(key).or_insert_with(|| {
                            shape.groups.push(Group {
                                name: name.clone(),
                                material: material.clone(),
                                faces: Vec::new(),
                            });
                            shape.groups.len() - 1
                        })
                    });
                    shape.groups[group].faces.push(face);
                }
                Some("g" | "o") => {
                    name = words.collect::<Vec<_>>().join(" ");
                    current = None;
                }
                Some("usemtl") => {
                    material = Some(rest().to_owned());
                    current = None;
                }
                Some("mtllib") => shape.libraries.push(rest().to_owned()),
                _ => {}
            }
        }
        Ok(shape)
    }

    fn mesh(&self, group: &Group) -> Result<Mesh, ObjError> {
        let mut mesh = Mesh {
            name: group.name.clone(),
            ..Mesh::default()
        };
        let mut known = HashMap::new();
        let mut has_uvs = false;
        for face in &group.faces {
            let corners = self.indices(face).map_err(|problem| ObjError::At {
                line: face.line,
                problem,
            })?;
            let place = |[vertex, ..]: &[usize; 3]| self.vertices[*vertex].as_dvec3();
            let places: Vec<_> = corners.iter().map(place).collect();
            for triangle in polygon::triangles(&places) {
                let indices = triangle.map(|corner| {
                    *known.entry(corners[corner]).or_insert_with(|| {
                        let [vertex, uv, normal] = corners[corner];
                        has_uvs |= uv < self.uvs.len();
                        mesh.positions.push(self.vertices[vertex]);
                        mesh.uvs.push(self.uvs.get(uv).copied().unwrap_or_default());
                        mesh.normals
                            .push(self.normals.get(normal).copied().unwrap_or_default());
                        mesh.positions.len() as u32 - 1
                    })
                });
                mesh.triangles.push(indices);
            }
        }
        if !has_uvs {
            mesh.uvs.clear();
        }
        mesh.mend_normals();
        Ok(mesh)
    }

    /// Which vertex, place and normal each corner of a face has, 0 first; beyond the last one where it has none.
    fn indices(&self, face: &Face) -> Result<Vec<[usize; 3]>, ObjProblem> {
        let all = [self.vertices.len(), self.uvs.len(), self.normals.len()];
        let mut corners = Vec::with_capacity(face.corners.len());
        for (number, corner) in face.corners.iter().enumerate() {
            let mut indices = all;
            for part in 0..3 {
                let Some(index) = corner[part] else { continue };
                let (from, count) = match index {
                    ..0 => (face.before[part] as i64, face.before[part]),
                    _ => (-1, all[part]),
                };
                let found = usize::try_from(from.saturating_add(index)).ok();
                indices[part] =
                    found
                        .filter(|found| *found < all[part])
                        .ok_or(ObjProblem::Missing {
                            corner: number + 1,
                            part: PARTS[part],
                            index,
                            count,
                        })?;
            }
            let position = self.vertices[indices[0]];
            if !position.is_finite() {
                return Err(ObjProblem::NotFinite {
                    corner: number + 1,
                    position,
                });
            }
            corners.push(indices);
        }
        Ok(corners)
    }
}

/// The first three numbers.
fn three<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<Vec3> {
    let mut number = || words.next()?.parse().ok();
    Some(Vec3::new(number()?, number()?, number()?))
}

/// One number or two, from the lower left corner; (0, 0) where they are not finite.
fn place<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<Vec2> {
    let u: f32 = words.next()?.parse().ok()?;
    let v: f32 = words.next().map_or(Some(0.0), |word| word.parse().ok())?;
    let uv = Vec2::new(u, 1.0 - v);
    Some(if uv.is_finite() { uv } else { Vec2::ZERO })
}

/// The corners of a face: `1`, `1/2`, `1//3` or `1/2/3`.
fn corners<'a>(words: impl Iterator<Item = &'a str>) -> Result<Vec<Corner>, ObjProblem> {
    let corner = |(corner, word): (usize, &'a str)| {
        let mut parts = word.split('/');
        let mut indices = [None; 3];
        for (part, index) in indices.iter_mut().enumerate() {
            let text = parts.next().unwrap_or_default();
            if text.is_empty() && part > 0 {
                continue;
            }
            *index = Some(text.parse().map_err(|_| ObjProblem::Corner {
                corner: corner + 1,
                part: ["a vertex", "a texture coordinate", "a normal"][part],
                found: shown(word),
            })?);
        }
        Ok(indices)
    };
    let corners: Vec<Corner> = words.enumerate().map(corner).collect::<Result<_, _>>()?;
    if corners.is_empty() {
        return Err(ObjProblem::NoCorners);
    }
    Ok(corners)
}

/// The lines with their numbers, 1 first, those joined to one that end with a backslash.
fn logical_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text.lines().zip(1..);
    std::iter::from_fn(move || {
        let (first, number) = lines.next()?;
        let Some(begin) = first.strip_suffix('\\') else {
            return Some((number, Cow::Borrowed(first)));
        };
        let mut joined = begin.to_owned();
        for (next, _) in lines.by_ref() {
            joined.push(' ');
            let begin = next.strip_suffix('\\');
            joined.push_str(begin.unwrap_or(next));
            if begin.is_none() {
                break;
            }
        }
        Some((number, Cow::Owned(joined)))
    })
}

#[cfg(test)]
#[path = "obj_tests.rs"]
mod tests;
