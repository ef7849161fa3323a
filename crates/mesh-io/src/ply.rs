//! PLY files: text, and binary in both orders of bytes.
//!
//! A reader of our own: those that there are take memory for as many elements as a header claims, and a map for each vertex.

use std::collections::HashMap;
use std::path::Path;

use glam::{DVec3, Vec2, Vec3};

use crate::beside::file_in;
use crate::model::{Attribute, Image, ImageSource, Material, Mesh, Model, Texture, Wrap};
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

#[derive(Clone, Copy, PartialEq)]
enum Format {
    Text,
    Little,
    Big,
}

#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

struct Property {
    name: String,
    kind: Kind,
    /// How a list says its length.
    list: Option<Kind>,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

struct Header {
    format: Format,
    elements: Vec<Element>,
    texture: Option<String>,
    /// Bytes and lines up to its end.
    length: usize,
    lines: usize,
}

/// Reads the mesh of a PLY file's bytes, in the file's own axes and units. Polygons become fans; triangles without an area are left
/// out. Places in a texture may be of vertices (`u v`, `s t`, `texture_u texture_v`) or of faces' corners (`texcoord`); other numbers of
/// vertices become attributes. A texture that a comment names (`TextureFile`) is in `folder` or below.
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

impl Header {
    fn read(bytes: &[u8]) -> Result<Self, PlyError> {
        let (mut format, mut elements, mut texture) = (None, Vec::<Element>::new(), None);
        let (mut at, mut lines) = (0, 0);
        while let Some(length) = bytes[at..].iter().position(|byte| *byte == b'\n') {
            let line = String::from_utf8_lossy(&bytes[at..at + length]);
            at += length + 1;
            lines += 1;
            let wrong = |what: String| PlyError::Line { line: lines, what };
            let words: Vec<&str> = line.split_whitespace().collect();
            if lines == 1 && words != ["ply"] {
                return Err(wrong("a PLY file begins with `ply`".to_owned()));
            }
            match words.as_slice() {
                ["format", kind, "1.0"] => {
                    format = Some(match *kind {
                        "ascii" => Format::Text,
                        "binary_little_endian" => Format::Little,
                        "binary_big_endian" => Format::Big,
                        other => {
                            return Err(wrong(format!(
                                "there is no format `{}`: ascii, binary_little_endian, binary_big_endian",
                                shown(other)
                            )));
                        }
                    });
                }
                ["comment", "TextureFile", ..] => {
                    let name = line
                        .trim()
                        .split_once("TextureFile")
                        .map(|(_, name)| name.trim().to_owned());
                    texture = texture.or(name);
                }
                ["comment" | "obj_info", ..] | ["ply"] | [] => {}
                ["element", name, count] => elements.push(Element {
                    name: (*name).to_owned(),
                    count: count.parse().map_err(|_| {
                        wrong(format!(
                            "a number of elements was expected, found `{}`",
                            shown(count)
                        ))
                    })?,
                    properties: Vec::new(),
                }),
                ["property", ..] => {
                    let element = elements
                        .last_mut()
                        .ok_or_else(|| wrong("a property of no element".to_owned()))?;
                    let property = Property::read(&words[1..]);
                    element.properties.push(property.ok_or_else(|| wrong(format!("a property is written `property TYPE NAME` or `property list TYPE TYPE NAME`, found `{}`", shown(line.trim()))))?);
                }
                ["end_header"] => {
                    let format =
                        format.ok_or_else(|| wrong("the header has no `format`".to_owned()))?;
                    return Ok(Self {
                        format,
                        elements,
                        texture,
                        length: at,
                        lines,
                    });
                }
                _ => {
                    return Err(wrong(format!(
                        "no line of a header: `{}`",
                        shown(line.trim())
                    )));
                }
            }
        }
        Err(PlyError::NoEnd)
    }
}

impl Property {
    fn read(words: &[&str]) -> Option<Self> {
        let (name, kind, list) = match words {
            ["list", count, kind, name] => (name, kind, Some(Kind::of(count)?)),
            [kind, name] => (name, kind, None),
            _ => return None,
        };
        Some(Self {
            name: (*name).to_owned(),
            kind: Kind::of(kind)?,
            list,
        })
    }
}

impl Kind {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number of these bytes, the least significant first.
    fn number(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Self::I8 => f64::from(a as i8),
            Self::U8 => f64::from(a),
            Self::I16 => f64::from(i16::from_le_bytes([a, b])),
            Self::U16 => f64::from(u16::from_le_bytes([a, b])),
            Self::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::F64 => f64::from_le_bytes(bytes),
        }
    }

    /// What a colour of this kind is divided by.
    fn most(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::I32 | Self::U32 | Self::F32 | Self::F64 => 1.0,
        }
    }
}

/// The numbers after the header.
struct Numbers<'a> {
    format: Format,
    rest: &'a [u8],
    line: usize,
}

impl Numbers<'_> {
    fn next(&mut self, kind: Kind) -> Result<f64, String> {
        if self.format == Format::Text {
            return self.word();
        }
        let Some((bytes, rest)) = self.rest.split_at_checked(kind.size()) else {
            return Err("the file ends here".to_owned());
        };
        self.rest = rest;
        let mut ordered = [0; 8];
        for (i, byte) in bytes.iter().enumerate() {
            ordered[if self.format == Format::Big {
                bytes.len() - 1 - i
            } else {
                i
            }] = *byte;
        }
        Ok(kind.number(ordered))
    }

    fn word(&mut self) -> Result<f64, String> {
        while let [first, rest @ ..] = self.rest
            && first.is_ascii_whitespace()
        {
            self.line += usize::from(*first == b'\n');
            self.rest = rest;
        }
        let length = self
            .rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(length);
        self.rest = rest;
        let text = String::from_utf8_lossy(word);
        match text.parse() {
            Ok(number) => Ok(number),
            Err(_) if word.is_empty() => Err("the file ends here".to_owned()),
            Err(_) => Err(format!(
                "line {}: a number was expected, found `{}`",
                self.line + 1,
                shown(&text)
            )),
        }
    }

    /// Gives the numbers of each property of each of the elements, and takes memory only for what is there.
    fn each(
        &mut self,
        element: &Element,
        mut take: impl FnMut(usize, &[f64]),
    ) -> Result<(), PlyError> {
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut values = Vec::new();
        for index in 0..element.count {
            for (number, property) in element.properties.iter().enumerate() {
                values.clear();
                self.property(property, &mut values)
                    .map_err(|what| PlyError::Element {
                        element: shown(&element.name),
                        index,
                        what,
                    })?;
                take(number, &values);
            }
        }
        Ok(())
    }

    fn property(&mut self, property: &Property, values: &mut Vec<f64>) -> Result<(), String> {
        let count = match property.list {
            None => 1,
            Some(kind) => {
                let count = self.next(kind)?;
                // Each number has a byte or more.
                if !(count >= 0.0 && count <= self.rest.len() as f64 && count.fract() == 0.0) {
                    return Err(format!(
                        "its list `{}` is {count} long",
                        shown(&property.name)
                    ));
                }
                count as usize
            }
        };
        for _ in 0..count {
            values.push(self.next(property.kind)?);
        }
        Ok(())
    }
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
            for corner in 2..corners.len() {
                let triangle = [0, corner - 1, corner];
                let [a, b, c] = triangle.map(|corner| self.positions[corners[corner]].as_dvec3());
                if (b - a).cross(c - a) == DVec3::ZERO {
                    continue;
                }
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
mod tests {
    use super::*;
    use proptest::prelude::*;

    const HEADER: &str = "element vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\nproperty float speed\n\
        element face 2\nproperty uchar flags\nproperty list uchar int vertex_indices\nend_header\n";
    const PLACES: [[f64; 5]; 4] = [
        [0.0, 0.0, 0.0, 255.0, 1.5],
        [1.0, 0.0, 0.0, 0.0, -1.0],
        [1.0, 1.0, 0.0, 51.0, 0.0],
        [0.0, 1.0, 0.0, 1.0, 2.0],
    ];

    fn read(bytes: &[u8]) -> Result<Model, PlyError> {
        from_bytes(bytes, Path::new(""))
    }

    fn text(faces: &str) -> String {
        let rows = PLACES
            .map(|row| row.map(|x| x.to_string()).join(" "))
            .join("\n");
        format!("ply\nformat ascii 1.0\ncomment of nothing\n{HEADER}{rows}\n{faces}\n")
    }

    fn binary(is_big: bool) -> Vec<u8> {
        let name = if is_big { "big" } else { "little" };
        let mut bytes = format!("ply\nformat binary_{name}_endian 1.0\n{HEADER}").into_bytes();
        let mut push = |little: &[u8]| match is_big {
            true => bytes.extend(little.iter().rev()),
            false => bytes.extend(little),
        };
        for [x, y, z, red, speed] in PLACES {
            push(&(x as f32).to_le_bytes());
            push(&y.to_le_bytes());
            push(&(z as f32).to_le_bytes());
            push(&[red as u8]);
            push(&(speed as f32).to_le_bytes());
        }
        for face in [&[0, 1, 2][..], &[0, 2, 3]] {
            push(&[7]);
            push(&[3]);
            face.iter()
                .for_each(|corner: &i32| push(&corner.to_le_bytes()));
        }
        bytes
    }

    #[test]
    fn text_and_both_orders_of_bytes_are_one_mesh() {
        let model = read(text("7 4 0 1 2 3\n0 0").as_bytes()).unwrap();
        let mesh = &model.meshes[0];
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.normals, [Vec3::Z; 4]);
        assert_eq!(
            mesh.attribute("speed").unwrap().values,
            [1.5, -1.0, 0.0, 2.0]
        );
        assert_eq!(mesh.attribute("red").unwrap().of(2), [0.2]);
        assert_eq!(read(&binary(false)).unwrap(), model);
        assert_eq!(read(&binary(true)).unwrap(), model);
    }

    #[test]
    fn places_in_textures_are_of_vertices_or_corners() {
        let head = "ply\nformat ascii 1.0\ncomment TextureFile no skin.png\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
        let of_vertices = format!(
            "{head}property float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"
        );
        let model = read(of_vertices.as_bytes()).unwrap();
        assert_eq!(model.meshes[0].uvs, [Vec2::Y, Vec2::ONE, Vec2::ZERO]);
        assert!(
            model.notes[0].contains("`no skin.png`"),
            "{:?}",
            model.notes
        );
        let of_corners = format!(
            "{head}element face 2\nproperty list uchar int vertex_index\nproperty list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n0 1 0\n\
            3 0 1 2 6 0 0 1 0 0 1\n3 0 1 2 6 0.5 0 1 0 0 1\n"
        );
        let model = read(of_corners.as_bytes()).unwrap();
        assert_eq!(
            (
                model.meshes[0].positions.len(),
                model.meshes[0].triangles[1]
            ),
            (4, [3, 1, 2])
        );
        assert_eq!(model.meshes[0].uvs[3], Vec2::new(0.5, 1.0));
    }

    #[test]
    fn mistakes_name_their_place() {
        for (faces, expected) in [
            (
                "7 3 0 1 4\n7 0",
                "face 0: there is no vertex 4, there are 4",
            ),
            (
                "7 3 0 1 2\n7 3 0 -1 1",
                "face 1: there is no vertex -1, there are 4",
            ),
            (
                "7 3 0 1 nan\n7 0",
                "face 0: there is no vertex NaN, there are 4",
            ),
            ("7 3 0 1\n", "face 0: the file ends here"),
            (
                "7 99999 0 1\n",
                "face 0: its list `vertex_indices` is 99999 long",
            ),
            ("7 -1 0 1\n", "face 0: its list `vertex_indices` is -1 long"),
            (
                "7 3 0 1 x 7 3",
                "face 0: line 18: a number was expected, found `x`",
            ),
            ("0 0 0 0", "no triangle with an area was found"),
        ] {
            assert_eq!(
                read(text(faces).as_bytes()).unwrap_err().to_string(),
                expected
            );
        }
        let whole = text("7 4 0 1 2 3\n0 0");
        for (from, to, expected) in [
            ("ply\n", "plx\n", "line 1: a PLY file begins with `ply`"),
            ("ascii", "asci", "line 2: there is no format `asci`"),
            ("float x", "float a", "its vertices have no `x`"),
            ("float x", "real x", "line 5: a property is written"),
            (
                "element vertex 4",
                "element vertex four",
                "line 4: a number of elements was expected, found `four`",
            ),
            ("element vertex 4\n", "", "line 4: a property of no element"),
            (
                "end_header",
                "comment",
                "line 14: no line of a header: `0 0 0 255 1.5`",
            ),
            (
                "vertex 4",
                "vertex 99999999999999",
                "vertex 5: the file ends here",
            ),
            ("1 1 0 51", "1 inf 0 51", "face 0: vertex 2 is at"),
        ] {
            let message = read(whole.replacen(from, to, 1).as_bytes())
                .unwrap_err()
                .to_string();
            assert!(message.starts_with(expected), "{from}: {message}");
        }
        // No numbers, and any number of them.
        let empty = "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nend_header\n";
        assert_eq!(read(empty.as_bytes()), Err(PlyError::NoTriangles));
    }

    #[test]
    fn files_that_end_early_are_refused() {
        for whole in [binary(false), binary(true)] {
            for end in 0..whole.len() {
                assert!(read(&whole[..end]).is_err(), "{end}");
            }
        }
    }

    proptest! {
        #[test]
        fn altered_files_never_panic(is_big in any::<bool>(), at in 0usize..400, byte in any::<u8>(), also in 0usize..400) {
            for mut bytes in [binary(is_big), text("7 4 0 1 2 3\n0 0").into_bytes()] {
                for place in [at, also] {
                    let place = place % bytes.len();
                    bytes[place] = byte;
                }
                let _ = read(&bytes);
            }
        }
    }
}
