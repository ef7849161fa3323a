//! What few files have, and exporters write all the same.

use super::*;

/// What nothing needs refuses no character: it is told, and left out.
#[test]
fn attributes_that_nothing_needs_may_be_of_any_kind() {
    let mut file = File::triangle();
    let matrices = file.floats("MAT3", 3, &[0.0; 27]);
    file.attribute("_FRAME", matrices);
    let broken = file.floats("SCALAR", 3, &[0.0, f32::NAN, 1.0]);
    file.attribute("_X", broken);
    let good = file.floats("SCALAR", 3, &[1.0, 2.0, 3.0]);
    file.attribute("_Y", good);
    let model = file.read().unwrap();
    let names: Vec<&str> = (model.meshes[0].attributes.iter())
        .map(|own| own.name.as_str())
        .collect();
    assert_eq!(names, ["y"]);
    let notes = model.notes.join("; ");
    for text in [
        "primitive 0: its _FRAME is not read",
        "its _X is not read: accessor 2 has numbers that are not finite",
    ] {
        assert!(notes.contains(text), "{notes}");
    }
    // What is needed has to be right.
    let mut file = File::triangle();
    let normals = file.floats("VEC2", 3, &[0.0; 6]);
    file.attribute("NORMAL", normals);
    file.refused("accessor 1 is not of 3 numbers");
}

/// An animation moves what is known, and tells what isn't.
#[test]
fn properties_that_are_not_known_stay_as_they_are() {
    let pointer = json!({"pointer": "/nodes/2/extensions/KHR_node_visibility/visible"});
    let animation = json!({"channels": [
        {"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": pointer}}},
        {"sampler": 0, "target": {"node": 2, "path": "translation"}},
    ]});
    let file = skinned([0.0, 0.25, 0.5, 1.0], animation, |file| {
        let times = file.floats("SCALAR", 2, &[0.0, 1.0]);
        let values = file.floats("VEC3", 2, &[0.0, 1.0, 0.0, 0.0, 3.0, 0.0]);
        json!([{"input": times, "output": values}])
    });
    let model = file.read().unwrap();
    let notes = model.notes.join("; ");
    assert!(
        notes.contains("an animation moves `extensions/KHR_node_visibility/visible` of nodes"),
        "{notes}"
    );
    let pose = model.pose(Some(0), 1.0).unwrap();
    assert_eq!(pose.nodes[2].translation, DVec3::new(0.0, 3.0, 0.0));
}

/// Tears and anger marks are kept in a point until an expression wants them.
#[test]
fn triangles_that_a_morph_opens_are_kept() {
    let mut file = File::new();
    let places = file.floats("VEC3", 3, &[0.5; 9]);
    file.attribute("POSITION", places);
    let opens = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    file.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": opens}]);
    file.json["meshes"][0]["weights"] = json!([2.0]);
    let mesh = file.mesh();
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(mesh.positions[1], Vec3::new(2.5, 0.5, 0.5));
    // One that stays a line has no area ever.
    let line = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    file.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": line}]);
    assert!(file.read().unwrap().meshes.is_empty());
}

/// Mirrored joints turn triangles around, as mirrored nodes do, so that their outside stays where the normals say.
#[test]
fn skins_that_are_mirrored_keep_their_outside() {
    let outwards = |mesh: &Mesh| {
        mesh.triangles.iter().all(|triangle| {
            let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
            let normal = mesh.normals[triangle[0] as usize];
            (b - a).cross(c - a).dot(normal) > 0.0
        })
    };
    let still = json!({"channels": []});
    let mut file = skinned([0.0, 0.25, 0.75, 1.0], still, |_| json!([]));
    let whole = file.mesh();
    assert!(outwards(&whole));
    file.json["nodes"][1]["scale"] = json!([-1.0, 1.0, 1.0]);
    let mirrored = file.mesh();
    assert_eq!(mirrored.positions[1], Vec3::new(-1.0, 0.0, 0.0));
    assert!(outwards(&mirrored));
    assert_eq!(mirrored.normals, whole.normals);
    // Only what most of a triangle's corners go with counts: the second joint is mirrored back.
    file.json["nodes"][2]["scale"] = json!([-1.0, 1.0, 1.0]);
    file.json["nodes"][1]["scale"] = json!([1.0, 1.0, 1.0]);
    let upper = file.mesh();
    let turned = upper.triangles.iter().zip(&whole.triangles);
    let turned: Vec<bool> = turned.map(|(own, before)| own != before).collect();
    assert_eq!(turned, [false, true], "{:?}", upper.positions);
}

/// A matrix that makes its mesh flat has the turn and the sizes that it has.
#[test]
fn a_flat_matrix_is_a_scale_of_nothing() {
    let mut file = File::triangle();
    // A quarter turn about y, twice as wide, without depth.
    file.json["nodes"][0]["matrix"] = json!([0, 0, -2, 0, 0, 1, 0, 0, 0, 0, 0, 0, 5, 0, 0, 1]);
    let flat = file.mesh();
    assert_eq!(
        flat.positions,
        [
            Vec3::new(5.0, 0.0, 0.0),
            Vec3::new(5.0, 0.0, -2.0),
            Vec3::new(5.0, 1.0, 0.0),
        ]
    );
    // A line has no turn, and no size.
    file.json["nodes"][0]["matrix"] = json!([2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5, 0, 0, 1]);
    assert_eq!(file.mesh().positions, [Vec3::new(5.0, 0.0, 0.0); 3]);
}

#[test]
fn whole_numbers_for_parts_of_a_whole_are_told_as_such() {
    let still = json!({"channels": []});
    let mut file = skinned([0.0, 0.25, 0.5, 1.0], still, |_| json!([]));
    let weights = file.accessor("VEC4", 5121, 4, &[255, 0, 0, 0].repeat(4));
    file.attribute("WEIGHTS_0", weights);
    file.refused("is of whole numbers that are not `normalized`");
    file.json["accessors"][weights]["normalized"] = json!(true);
    assert!(file.read().is_ok());
}
