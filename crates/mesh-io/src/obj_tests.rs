use super::*;
use proptest::prelude::*;

/// The one mesh of a text, as a shape, and what was noted.
fn read(text: &str) -> Result<(crate::Welded, Vec<String>), ObjError> {
    from_text(text, Path::new("")).map(|model| (model.welded(), model.notes))
}

const TETRAHEDRON: &str = "o head\nv 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\n\
    usemtl skin\nf 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\nf 1 4 3\nf -3 -2 \\\n -1\n";

#[test]
fn faces_of_all_kinds_become_triangles() {
    let (mesh, note) = read(TETRAHEDRON).unwrap();
    assert_eq!(
        (mesh.positions.len(), mesh.triangles.len(), note.len()),
        (4, 4, 0)
    );
    let outward = Vec3::splat(-1.0).normalize();
    assert!(mesh.normals[0].distance(outward) < 1e-6);
    let (square, _) =
        read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nl 1 2\nf 1 2\nf 3\n").unwrap();
    assert_eq!(square.triangles.len(), 2);
}

#[test]
fn scaffolding_beside_a_body_is_left_out() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\n";
    let groups = "g body\nf 1 2 3\ng helper-hair\nf 1 2 4\ng joint-neck\nf 2 3 4\n";
    let (mesh, note) = read(&format!("{vertices}{groups}")).unwrap();
    assert_eq!(mesh.triangles.len(), 1);
    assert_eq!(
        note[0],
        "2 helper and joint groups beside \"body\" are not drawn"
    );
    let (mesh, note) = read(&format!("{vertices}{}", groups.replace("body", "skin"))).unwrap();
    assert_eq!((mesh.triangles.len(), note.len()), (3, 0));
}

#[test]
fn a_line_of_a_million_lines_takes_no_time() {
    let long = "\\\n".repeat(1_000_000) + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n\\\n3\n";
    let (mesh, _) = read(&long).unwrap();
    assert_eq!(mesh.triangles.len(), 1);
}

#[test]
fn mistakes_name_their_line_and_corner() {
    let refused = |lines: &str| {
        let vertices = "v 0 0 0\nv 1 0 0\nv 0 nan 0\nv 0 1 0\n";
        read(&format!("{vertices}{lines}\n"))
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
    assert_eq!(read("").unwrap_err(), ObjError::NoTriangles);
    for (corner, part) in [
        ("1/9223372036854775807", "texture coordinate"),
        ("1//-1", "normal"),
    ] {
        let expected = format!("line 5: corner 1 of the face: there is no {part}");
        assert!(refused(&format!("f {corner} 2 4")).starts_with(&expected));
    }
    assert_eq!(
        refused("vt 0 x"),
        "line 5: a texture coordinate is written `vt U V`, found `vt 0 x`"
    );
}

proptest! {
    #[test]
    fn truncated_and_altered_files_never_panic(end in 0usize..200, at in 0usize..200, byte in "[- .0-9/vfgo#e\n\\\\]") {
        let mut text = TETRAHEDRON.to_string();
        text.truncate(end);
        if at < text.len() {
            text.replace_range(at..=at, &byte);
        }
        let _ = read(&text);
    }

    #[test]
    fn random_lines_never_panic(lines in prop::collection::vec("[vfgo#] ?[-0-9./e naif]{0,20}", 0..12)) {
        let _ = read(&lines.join("\n"));
    }
}

#[test]
fn corners_keep_their_normals_and_places() {
    let text = "o cube\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0.25\nvn 0 0 2\nvn 0 1 0\n\
        f 1/1/1 2/2/1 3/1/1\nf 2/2/2 4/1/2 3/1/2\n";
    let model = from_text(text, Path::new("")).unwrap();
    let mesh = &model.meshes[0];
    // The shared corners have two normals each, and none is there twice.
    assert_eq!((mesh.positions.len(), mesh.name.as_str()), (6, "cube"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(mesh.normals[..3], [Vec3::Z; 3]);
    assert_eq!(mesh.normals[3..], [Vec3::Y; 3]);
    // The upper left corner of a picture is (0, 0).
    assert_eq!(mesh.uvs[..2], [Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.75)]);
    assert_eq!(model.welded().positions.len(), 4);
}

/// An arrowhead whose hollow corner, the third, has the place (0.25, 0.5) in its texture.
#[test]
fn concave_faces_are_cut_within_themselves_and_corners_keep_what_is_theirs() {
    let text = "v 0 0 5\nv 2 -1 5\nv 0.5 0 5\nv 2 1 5\nvt 0 0\nvt 1 0\nvt 0.25 0.5\nvt 1 1\nvn 0 0 1\nvn 0 1 0\n";
    for [first, second, third, fourth] in [[1, 2, 3, 4], [2, 3, 4, 1], [3, 4, 1, 2]] {
        let corner = |vertex: i32| format!("{vertex}/{vertex}/{}", 1 + i32::from(vertex == 3));
        let face = [first, second, third, fourth].map(corner).join(" ");
        let model = from_text(&format!("{text}f {face}\n"), Path::new("")).unwrap();
        let mesh = &model.meshes[0];
        assert_eq!(
            (mesh.positions.len(), mesh.triangles.len()),
            (4, 2),
            "{face}"
        );
        for corners in mesh.corners() {
            let [a, b, c] = corners;
            assert!(
                (b - a).cross(c - a).z > 0.0 && corners.contains(&Vec3::new(0.5, 0.0, 5.0)),
                "{face}"
            );
        }
        let hollow = mesh
            .positions
            .iter()
            .position(|place| place.x == 0.5)
            .unwrap();
        assert_eq!(
            (mesh.uvs[hollow], mesh.normals[hollow]),
            (Vec2::new(0.25, 0.5), Vec3::Y)
        );
    }
}

#[test]
fn normals_that_are_none_are_those_of_the_triangles() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn nan 0 0\nvn 1 0 0\nf 1//1 2//2 3\n";
    let model = from_text(text, Path::new("")).unwrap();
    assert_eq!(model.meshes[0].normals, [Vec3::Z, Vec3::X, Vec3::Z]);
    assert!(model.meshes[0].uvs.is_empty());
}

#[test]
fn materials_make_meshes_and_come_from_their_libraries() {
    let folder = tempfile::tempdir().unwrap();
    let mtl = "newmtl red paint\nKd 0.5 0.25 1\nd 0.5\nmap_Kd -s 1 1 1 wood.png\n\nnewmtl lash\nmap_Kd ../out.png\nmap_d lash.png\n";
    std::fs::write(folder.path().join("a.mtl"), mtl).unwrap();
    std::fs::write(folder.path().join("wood.png"), "picture").unwrap();
    let text = "mtllib a.mtl\nmtllib gone.mtl\no a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red paint\nf 1 2 3\nusemtl lash\nf 3 2 1\n\
        usemtl red paint\nf 2 3 1\nusemtl none\nf 1 3 2\n";
    let model = from_text(text, folder.path()).unwrap();
    let of: Vec<_> = model
        .meshes
        .iter()
        .map(|mesh| (mesh.triangles.len(), mesh.material))
        .collect();
    assert_eq!(of, [(2, Some(0)), (1, Some(1)), (1, None)]);
    let red = &model.materials[0];
    assert_eq!(red.name, "red paint");
    assert_eq!(
        (red.base_color, red.alpha),
        ([0.5, 0.25, 1.0, 0.5], crate::Alpha::Blend)
    );
    assert_eq!(
        &*model.images[red.texture.unwrap().image].bytes().unwrap(),
        b"picture"
    );
    assert_eq!(model.materials[1].texture, None);
    let notes = model.notes.join("; ");
    assert!(
        notes.contains("gone.mtl") && notes.contains("`../out.png`"),
        "{notes}"
    );
    assert!(notes.contains("there is no material `none`"), "{notes}");
}

#[test]
fn numbers_of_materials_that_cannot_be_are_told_at_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let library =
        "newmtl a\nKd 0.5\nd -halo 0.25\nnewmtl b\nKd 0.1 nan 0.3\n Kd spectral a.rfl\nd\nTr 7\n";
    std::fs::write(folder.path().join("a.mtl"), library).unwrap();
    let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    let model = from_text(text, folder.path()).unwrap();
    let colors: Vec<_> = model.materials.iter().map(|it| it.base_color).collect();
    assert_eq!(colors, [[0.5, 0.5, 0.5, 0.25], [1.0, 1.0, 1.0, 0.0]]);
    assert_eq!(
        model.notes,
        [
            "a.mtl:5: `Kd 0.1 nan 0.3` is left out: one or three numbers from 0 to 1 can be read",
            "a.mtl:6: `Kd spectral a.rfl` is left out: one or three numbers from 0 to 1 can be read",
            "a.mtl:7: `d` is left out: a number from 0 to 1 can be read",
        ]
    );
}
