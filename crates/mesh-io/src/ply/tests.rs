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
fn concave_faces_are_cut_within_themselves_and_corners_keep_what_is_theirs() {
    // An arrowhead, the second corner of which is hollow.
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
        property list uchar int vertex_index\nproperty list uchar float texcoord\nend_header\n2 -1 0\n0.5 0 0\n2 1 0\n0 0 0\n\
        4 0 1 2 3 8 1 0 0.25 0.5 1 1 0 0\n";
    let mesh = &read(text.as_bytes()).unwrap().meshes[0];
    assert_eq!(mesh.triangles.len(), 2);
    let hollow = Vec3::new(0.5, 0.0, 0.0);
    for corners in mesh.corners() {
        let [a, b, c] = corners;
        assert!((b - a).cross(c - a).z > 0.0 && corners.contains(&hollow));
    }
    let uv_of = |place| mesh.uvs[mesh.positions.iter().position(|own| *own == place).unwrap()];
    assert_eq!(uv_of(hollow), Vec2::new(0.25, 0.5));
    assert_eq!(uv_of(Vec3::new(2.0, 1.0, 0.0)), Vec2::new(1.0, 0.0));
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
