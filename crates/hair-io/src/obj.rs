//! Heads from Wavefront OBJ files, by crate `tobj`.

use std::path::Path;

use glam::Vec3;
use tobj::{LoadError, LoadOptions};

use crate::mesh::Mesh;

/// Why a text is not an OBJ file with a head.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// A line that cannot be read, or a face of vertices that are not there.
    #[error("{0}")]
    Parse(LoadError),
    /// A face has a corner that is not finite.
    #[error("group \"{group}\": a face has the corner {corner}, which is not finite")]
    NotFinite {
        /// The group the face is in.
        group: String,
        /// The corner as the file gives it.
        corner: Vec3,
    },
    /// Nothing to draw.
    #[error("no triangle with an area was found")]
    NoTriangles,
}

/// Reads the triangles of an OBJ text, in the file's own axes and units, and a note where groups were
/// left out: beside a group named `body`, those named `helper...` and `joint...` are no skin (the
/// scaffolding of MakeHuman's base mesh). Polygons become fans. The file's normals, texture
/// coordinates and materials are not read.
///
/// # Errors
///
/// When a vertex or face cannot be read, a face's vertex is missing or not finite, or there is no
/// triangle.
pub fn from_text(text: &str) -> Result<(Mesh, Option<String>), ObjError> {
    let options = LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..LoadOptions::default()
    };
    let no_materials = |_: &Path| Ok(Default::default());
    let mut models = tobj::load_obj_buf(&mut geometry(text).as_bytes(), &options, no_materials)
        .map_err(ObjError::Parse)?
        .0;

    let mut note = None;
    if models.iter().any(|m| m.name == "body") {
        let before = models.len();
        models.retain(|m| !m.name.starts_with("helper") && !m.name.starts_with("joint"));
        let left_out = before - models.len();
        let text = format!("{left_out} helper and joint groups beside \"body\" are not drawn");
        note = (left_out > 0).then_some(text);
    }

    let mut corners = Vec::new();
    for model in &models {
        let positions = &model.mesh.positions;
        let corner = |&i: &u32| Vec3::from_slice(&positions[i as usize * 3..]);
        for triangle in model.mesh.indices.chunks_exact(3) {
            let triangle = [0, 1, 2].map(|i| corner(&triangle[i]));
            if let Some(&corner) = triangle.iter().find(|c| !c.is_finite()) {
                return Err(ObjError::NotFinite {
                    group: model.name.clone(),
                    corner,
                });
            }
            corners.push(triangle);
        }
    }
    let mesh = Mesh::from_corners(corners);
    if mesh.triangles.is_empty() {
        return Err(ObjError::NoTriangles);
    }
    Ok((mesh, note))
}

/// The lines that make a shape: positions, faces by their positions alone, names of groups.
///
/// What is not used cannot break the reading: `tobj` overflows (a panic in debug builds) where a
/// texture index is near 2^63, and refuses files for their materials.
fn geometry(text: &str) -> String {
    let text = text.replace("\\\r\n", " ").replace("\\\n", " ");
    let mut kept = String::with_capacity(text.len());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        let words: Vec<&str> = match keyword {
            "v" => words.take(3).collect(),
            "f" => words
                .map(|corner| corner.split('/').next().unwrap_or_default())
                .collect(),
            "g" | "o" => words.collect(),
            _ => continue,
        };
        kept.push_str(keyword);
        for word in words {
            kept.push(' ');
            kept.push_str(word);
        }
        kept.push('\n');
    }
    kept
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
    fn broken_files_are_refused() {
        let refused = |faces: &str| {
            from_text(&format!("v 0 0 0\nv 1 0 0\nv 0 nan 0\nv 0 1 0\n{faces}\n")).unwrap_err()
        };
        for faces in [
            "f 1 2 5",
            "f 0 1 2",
            "f -5 1 2",
            "f 1 2 9223372036854775807",
            "f -9223372036854775808 1 2",
        ] {
            assert_eq!(
                refused(faces),
                ObjError::Parse(LoadError::FaceVertexOutOfBounds),
                "{faces}"
            );
        }
        for faces in ["f 1 x 2", "f 1 2 99999999999999999999", "f"] {
            assert!(matches!(refused(faces), ObjError::Parse(_)), "{faces}");
        }
        assert!(matches!(refused("f 1 2 3"), ObjError::NotFinite { .. }));
        assert!(matches!(refused("v 1 2\nf 1 2 4"), ObjError::Parse(_)));
        assert_eq!(refused("f 1 2 2"), ObjError::NoTriangles);
        assert!(
            from_text(
                "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/9223372036854775807 2/-9223372036854775808/7 3\n"
            )
            .is_ok()
        );
        assert_eq!(from_text(""), Err(ObjError::NoTriangles));
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
