//! Heads from Wavefront OBJ files.

use std::borrow::Cow;

use glam::Vec3;

use crate::mesh::Mesh;
use crate::read::shown;

/// Why a text is not an OBJ file with a head.
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
    /// A vertex without three numbers.
    #[error("a vertex is written `v X Y Z`, found `{0}`")]
    Vertex(
        /// The line, or the beginning of it.
        String,
    ),
    /// A face without corners.
    #[error("a face is written `f A B C ...`, found no corner")]
    NoCorners,
    /// A corner that is no number.
    #[error("corner {corner} of the face: the number of a vertex was expected, found `{found}`")]
    Corner {
        /// Which corner, 1 first.
        corner: usize,
        /// The word in its place, or the beginning of it.
        found: String,
    },
    /// A corner at a vertex that is not there.
    #[error("corner {corner} of the face: there is no vertex {index}, there are {count}")]
    NoVertex {
        /// Which corner, 1 first.
        corner: usize,
        /// The number as the file gives it: 1 first, or below 0 from the last before the face.
        index: i64,
        /// How many vertices there are; before the face where the number is below 0.
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

/// Reads the triangles of an OBJ text, in the file's own axes and units, and a note where groups were
/// left out: beside a group named `body`, those named `helper...` and `joint...` are no skin (the
/// scaffolding of MakeHuman's base mesh). Polygons become fans. The file's normals, texture
/// coordinates, lines and materials are not read.
///
/// # Errors
///
/// When a vertex or face cannot be read, a face's vertex is missing or not finite, or there is no
/// triangle.
pub fn from_text(text: &str) -> Result<(Mesh, Option<String>), ObjError> {
    let Shape {
        vertices,
        mut groups,
    } = Shape::read(text)?;

    let mut note = None;
    groups.retain(|group| !group.faces.is_empty());
    if groups.iter().any(|group| group.name == "body") {
        let before = groups.len();
        groups.retain(|g| !g.name.starts_with("helper") && !g.name.starts_with("joint"));
        let left_out = before - groups.len();
        let text = format!("{left_out} helper and joint groups beside \"body\" are not drawn");
        note = (left_out > 0).then_some(text);
    }

    let mut triangles = Vec::new();
    for face in groups.iter().flat_map(|group| &group.faces) {
        let corners = face.positions(&vertices)?;
        for pair in corners[1..].windows(2) {
            triangles.push([corners[0], pair[0], pair[1]]);
        }
    }
    let mesh = Mesh::from_corners(triangles);
    if mesh.triangles.is_empty() {
        return Err(ObjError::NoTriangles);
    }
    Ok((mesh, note))
}

/// What of a file makes its shape.
#[derive(Default)]
struct Shape {
    vertices: Vec<Vec3>,
    groups: Vec<Group>,
}

/// Faces under one name.
#[derive(Default)]
struct Group {
    name: String,
    faces: Vec<Face>,
}

struct Face {
    line: usize,
    /// Vertices as the file numbers them: 1 first, or below 0 from the last.
    corners: Vec<i64>,
    /// How many vertices come before it.
    vertices_before: usize,
}

impl Shape {
    fn read(text: &str) -> Result<Self, ObjError> {
        let mut shape = Self {
            groups: vec![Group::default()],
            ..Self::default()
        };
        for (line, text) in logical_lines(text) {
            let at = |problem| ObjError::At { line, problem };
            let mut words = text.split_whitespace();
            match words.next() {
                Some("v") => shape
                    .vertices
                    .push(vertex(words).ok_or_else(|| at(ObjProblem::Vertex(shown(text.trim()))))?),
                Some("f") => {
                    let face = Face {
                        line,
                        corners: corners(words).map_err(at)?,
                        vertices_before: shape.vertices.len(),
                    };
                    let group = shape.groups.last_mut();
                    group.expect("there is one from the start").faces.push(face);
                }
                Some("g" | "o") => shape.groups.push(Group {
                    name: words.collect::<Vec<_>>().join(" "),
                    faces: Vec::new(),
                }),
                _ => {}
            }
        }
        Ok(shape)
    }
}

impl Face {
    fn positions(&self, vertices: &[Vec3]) -> Result<Vec<Vec3>, ObjError> {
        let position = |(corner, &index): (usize, &i64)| {
            let (from, count) = match index {
                ..0 => (self.vertices_before as i64, self.vertices_before),
                _ => (-1, vertices.len()),
            };
            let found = usize::try_from(from.saturating_add(index)).ok();
            let corner = corner + 1;
            match found.and_then(|found| vertices.get(found)) {
                None => Err(ObjProblem::NoVertex {
                    corner,
                    index,
                    count,
                }),
                Some(&position) if !position.is_finite() => {
                    Err(ObjProblem::NotFinite { corner, position })
                }
                Some(&position) => Ok(position),
            }
        };
        let positions = self.corners.iter().enumerate().map(position);
        positions
            .collect::<Result<_, _>>()
            .map_err(|problem| ObjError::At {
                line: self.line,
                problem,
            })
    }
}

/// The first three numbers.
fn vertex<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<Vec3> {
    let mut number = || words.next()?.parse().ok();
    Some(Vec3::new(number()?, number()?, number()?))
}

/// The vertices of a face: of `1/2/3` the first number.
fn corners<'a>(words: impl Iterator<Item = &'a str>) -> Result<Vec<i64>, ObjProblem> {
    let corner = |(corner, word): (usize, &'a str)| {
        let index = word.split('/').next().unwrap_or_default();
        index.parse().map_err(|_| ObjProblem::Corner {
            corner: corner + 1,
            found: shown(word),
        })
    };
    let corners: Vec<i64> = words.enumerate().map(corner).collect::<Result<_, _>>()?;
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
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TETRAHEDRON: &str = "o head\nv 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\n\
        usemtl skin\nf 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\nf 1 4 3\nf -3 -2 \\\n -1\n";

    #[test]
    fn faces_of_all_kinds_become_triangles() {
        let (mesh, note) = from_text(TETRAHEDRON).unwrap();
        assert_eq!(
            (mesh.positions.len(), mesh.triangles.len(), note),
            (4, 4, None)
        );
        let outward = Vec3::splat(-1.0).normalize();
        assert!(mesh.normals[0].distance(outward) < 1e-6);
        let (square, _) =
            from_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nl 1 2\nf 1 2\nf 3\n")
                .unwrap();
        assert_eq!(square.triangles.len(), 2);
    }

    #[test]
    fn scaffolding_beside_a_body_is_left_out() {
        let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\n";
        let groups = "g body\nf 1 2 3\ng helper-hair\nf 1 2 4\ng joint-neck\nf 2 3 4\n";
        let (mesh, note) = from_text(&format!("{vertices}{groups}")).unwrap();
        assert_eq!(mesh.triangles.len(), 1);
        assert_eq!(
            note.unwrap(),
            "2 helper and joint groups beside \"body\" are not drawn"
        );
        let (mesh, note) =
            from_text(&format!("{vertices}{}", groups.replace("body", "skin"))).unwrap();
        assert_eq!((mesh.triangles.len(), note), (3, None));
    }

    #[test]
    fn a_line_of_a_million_lines_takes_no_time() {
        let long = "\\\n".repeat(1_000_000) + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n\\\n3\n";
        let (mesh, _) = from_text(&long).unwrap();
        assert_eq!(mesh.triangles.len(), 1);
    }

    #[test]
    fn mistakes_name_their_line_and_corner() {
        let refused = |lines: &str| {
            let vertices = "v 0 0 0\nv 1 0 0\nv 0 nan 0\nv 0 1 0\n";
            from_text(&format!("{vertices}{lines}\n"))
                .unwrap_err()
                .to_string()
        };
        let no_vertex = |corner: usize, index: &str| {
            format!("line 5: corner {corner} of the face: there is no vertex {index}, there are 4")
        };
        assert_eq!(refused("f 1 2 5"), no_vertex(3, "5"));
        assert_eq!(refused("f 0 1 2"), no_vertex(1, "0"));
        assert_eq!(refused("f -5 1 2"), no_vertex(1, "-5"));
        for index in ["9223372036854775807", "-9223372036854775808"] {
            assert_eq!(refused(&format!("f 1 2 {index}")), no_vertex(3, index));
        }
        assert_eq!(
            refused("# joined \\\n\nf 1 \\\n x/1/2 2"),
            "line 7: corner 2 of the face: the number of a vertex was expected, found `x/1/2`"
        );
        assert!(refused("f 1 2 99999999999999999999").contains("found `99999999999999999999`"));
        assert!(refused("f").ends_with("found no corner"));
        assert_eq!(
            refused("\nf 1 2 3"),
            "line 6: corner 3 of the face is at [0, NaN, 0], which is not finite"
        );
        assert_eq!(
            refused("v 1 2\nf 1 2 4"),
            "line 5: a vertex is written `v X Y Z`, found `v 1 2`"
        );
        assert!(refused(&format!("v {}", "x".repeat(9999))).len() < 300);
        assert_eq!(refused("f 1 2 2"), ObjError::NoTriangles.to_string());
        assert_eq!(from_text(""), Err(ObjError::NoTriangles));
        // Texture coordinates and normals are not looked at.
        let far = "f 1/9223372036854775807 2/-9223372036854775808/7 3\n";
        assert!(from_text(&format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{far}")).is_ok());
    }

    proptest! {
        #[test]
        fn truncated_and_altered_files_never_panic(end in 0usize..200, at in 0usize..200, byte in "[- .0-9/vfgo#e\n\\\\]") {
            let mut text = TETRAHEDRON.to_string();
            text.truncate(end);
            if at < text.len() {
                text.replace_range(at..=at, &byte);
            }
            let _ = from_text(&text);
        }

        #[test]
        fn random_lines_never_panic(lines in prop::collection::vec("[vfgo#] ?[-0-9./e naif]{0,20}", 0..12)) {
            let _ = from_text(&lines.join("\n"));
        }
    }
}
