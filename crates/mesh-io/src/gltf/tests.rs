use std::path::Path;

use base64::Engine as _;
use glam::{DQuat, DVec3, Vec2, Vec3};
use proptest::prelude::*;
use serde_json::{Value, json};

use super::*;
use crate::{Alpha, Mesh};

mod exporters;

/// A file that is put together part by part.
struct File {
    bytes: Vec<u8>,
    json: Value,
}

impl File {
    fn new() -> Self {
        Self {
            bytes: Vec::new(),
            json: json!({"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [], "meshes": [{"primitives": [{"attributes": {}}]}],
                "nodes": [{"name": "body", "mesh": 0}], "scenes": [{"nodes": [0]}]}),
        }
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        views.len() - 1
    }

    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(
            json!({"bufferView": view, "componentType": component, "count": count, "type": kind}),
        );
        accessors.len() - 1
    }

    fn floats(&mut self, kind: &str, count: usize, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(kind, 5126, count, &bytes)
    }

    fn attribute(&mut self, name: &str, accessor: usize) {
        self.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
    }

    /// A file of a triangle in the plane of x and y.
    fn triangle() -> Self {
        let mut file = Self::new();
        let places = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        file.attribute("POSITION", places);
        file
    }

    fn text(&self) -> Vec<u8> {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": format!("data:application/octet-stream;base64,{data}")}]);
        json.to_string().into_bytes()
    }

    fn read(&self) -> Result<Model, GltfError> {
        from_bytes(&self.text(), Path::new(""))
    }

    #[track_caller]
    fn mesh(&self) -> Mesh {
        self.read().unwrap().meshes.remove(0)
    }

    #[track_caller]
    fn refused(&self, expected: &str) {
        let message = self.read().unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn attributes_are_of_any_kind_of_number() {
    let mut file = File::triangle();
    let uvs = file.accessor("VEC2", 5121, 3, &[0, 255, 51, 0, 255, 255]);
    file.json["accessors"][uvs]["normalized"] = json!(true);
    file.attribute("TEXCOORD_0", uvs);
    let speed = file.accessor("VEC3", 5120, 3, &[127, 0, 0x81, 0, 0, 0, 0, 127, 0]);
    file.json["accessors"][speed]["normalized"] = json!(true);
    file.attribute("_VELOCITY", speed);
    file.json["meshes"][0]["primitives"][0]["extras"] = json!({"velocity_scale": 2.5});
    let indices = file.accessor("SCALAR", 5125, 3, &[1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0]);
    file.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    let mesh = file.mesh();
    // In the order of their first use.
    assert_eq!(mesh.positions, [Vec3::X, Vec3::Y, Vec3::ZERO]);
    assert_eq!(
        (mesh.triangles, mesh.normals),
        (vec![[0, 1, 2]], vec![Vec3::Z; 3])
    );
    assert_eq!(mesh.uvs, [Vec2::new(0.2, 0.0), Vec2::ONE, Vec2::Y]);
    assert_eq!(mesh.attributes[0].name, "velocity");
    assert_eq!(mesh.attributes[0].of(2), [2.5, 0.0, -2.5]);
}

#[test]
fn accessors_without_a_view_are_zeros_and_sparse_ones_differ_in_places() {
    let mut file = File::triangle();
    let indices = file.view(&[0, 0, 2, 0]);
    let values = file.view(
        &[1.0f32, 2.0, 3.0, 4.0, 5.0, 6.0]
            .map(f32::to_le_bytes)
            .concat(),
    );
    file.json["accessors"][0] = json!({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {
        "count": 2, "indices": {"bufferView": indices, "componentType": 5123}, "values": {"bufferView": values}}});
    let mesh = file.mesh();
    assert_eq!(
        mesh.positions,
        [
            Vec3::new(1.0, 2.0, 3.0),
            Vec3::ZERO,
            Vec3::new(4.0, 5.0, 6.0)
        ]
    );
    file.bytes[2 + 36] = 3;
    file.refused("accessor 0 is sparse, and has no element 3");
    // All at one place: there is no triangle, and that is no mistake.
    file.json["accessors"][0] = json!({"componentType": 5126, "count": 3, "type": "VEC3"});
    let model = file.read().unwrap();
    assert!(
        model.meshes.is_empty() && model.notes[0].starts_with("1 primitives"),
        "{model:?}"
    );
    for count in [1usize << 40, usize::MAX] {
        file.json["accessors"][0]["count"] = json!(count);
        file.refused("accessor 0 is one too many");
    }
}

#[test]
fn strips_and_fans_wind_as_lists_do() {
    for (mode, corners, expected) in [
        (5, [0, 1, 2, 3], [[0, 1, 2], [1, 3, 2]]),
        (6, [0, 1, 3, 2], [[1, 3, 0], [3, 2, 0]]),
    ] {
        let mut file = File::new();
        let places = file.floats(
            "VEC3",
            4,
            &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0],
        );
        file.attribute("POSITION", places);
        let indices = file.accessor("SCALAR", 5121, 4, &corners);
        file.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
        file.json["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        let mesh = file.mesh();
        assert_eq!(mesh.normals, [Vec3::Z; 4], "{mode}");
        let places: Vec<Vec<Vec3>> = mesh.corners().map(|own| own.to_vec()).collect();
        let all = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
        assert_eq!(
            places,
            expected.map(|own| own.map(|i: usize| all[i]).to_vec()),
            "{mode}"
        );
    }
}

#[test]
fn meshes_lie_where_their_nodes_are() {
    let mut file = File::triangle();
    file.json["nodes"] = json!([
        {"translation": [0.0, 2.0, 0.0], "children": [1, 2]},
        {"mesh": 0, "scale": [2.0, 1.0, 1.0]},
        {"name": "mirrored", "mesh": 0, "scale": [-1.0, 1.0, 1.0]},
        {"name": "of another scene", "mesh": 0},
    ]);
    let model = file.read().unwrap();
    assert_eq!(model.meshes.len(), 2);
    assert_eq!(model.meshes[0].positions[1], Vec3::new(2.0, 2.0, 0.0));
    let mirrored = &model.meshes[1];
    // Outside stays outside.
    assert_eq!(
        (mirrored.name.as_str(), mirrored.normals[0]),
        ("mirrored", Vec3::Z)
    );
    let [a, b, c] = mirrored.corners().next().unwrap();
    assert!((b - a).cross(c - a).z > 0.0);
    // The characters of VRM 0.x face -Z.
    file.json["extensions"] = json!({"VRM": {"humanoid": {"humanBones": [{"bone": "head", "node": 1}, {"bone": "jaw", "node": -1}]}}});
    let model = file.read().unwrap();
    assert_eq!(model.meshes[0].positions[1], Vec3::new(-2.0, 2.0, 0.0));
    assert_eq!(model.meshes[0].normals[0], -Vec3::Z);
    assert_eq!(model.rig.unwrap().node("head"), Some(1));
    // A bone that isn't there is told.
    file.json["extensions"] =
        json!({"VRM": {"humanoid": {"humanBones": [{"bone": "head", "node": 99}]}}});
    let model = file.read().unwrap();
    assert!(
        model
            .notes
            .iter()
            .any(|note| note.contains("`head` is node 99")),
        "{:?}",
        model.notes
    );
}

#[test]
fn materials_have_colours_textures_and_cut_outs() {
    let mut file = File::triangle();
    let uvs = file.floats("VEC2", 3, &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    file.attribute("TEXCOORD_1", uvs);
    let picture = file.view(b"PNG");
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    file.json["materials"] = json!([
        {"name": "lash", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1.0, 0.75], "baseColorTexture": {
            "index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.0], "rotation": std::f64::consts::FRAC_PI_2, "scale": [2.0, 1.0]}}}},
            "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true},
        {"name": "skin", "alphaMode": "BLEND", "extensions": {"VRMC_materials_mtoon": {"shadeColorFactor": [0.1, 0.2, 0.3], "shadeMultiplyTexture": {"index": 1}}}},
        {"name": "gone", "pbrMetallicRoughness": {"baseColorTexture": {"index": 2}}},
    ]);
    file.json["textures"] = json!([{"source": 0, "sampler": 0}, {"source": 0}, {"source": 1}]);
    file.json["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648}]);
    file.json["images"] = json!([{"bufferView": picture, "name": "skin"}, {"uri": "../gone.png"}]);
    file.json["extensionsRequired"] = json!(["KHR_texture_transform", "ACME_glow"]);
    let model = file.read().unwrap();
    let [lash, skin, gone] = &model.materials[..] else {
        panic!()
    };
    assert_eq!(
        (lash.base_color, lash.alpha, lash.double_sided),
        ([0.5, 0.25, 1.0, 0.75], Alpha::Cutout(0.25), true)
    );
    assert_eq!(
        lash.texture.unwrap().wrap,
        [crate::Wrap::Clamp, crate::Wrap::Mirror]
    );
    assert_eq!(
        (skin.alpha, skin.shade_color, skin.shade_texture.is_some()),
        (Alpha::Blend, Some([0.1, 0.2, 0.3]), true)
    );
    assert_eq!(gone.texture, None);
    assert_eq!(
        (model.images.len(), &*model.images[0].bytes().unwrap()),
        (1, &b"PNG"[..])
    );
    // Scaled, then turned, then moved, of the set that the texture names.
    let expected = [
        Vec2::new(0.5, 0.0),
        Vec2::new(0.5, -2.0),
        Vec2::new(1.5, 0.0),
    ];
    for (uv, expected) in model.meshes[0].uvs.iter().zip(expected) {
        assert!(uv.distance(expected) < 1e-6, "{uv} {expected}");
    }
    let notes = model.notes.join("; ");
    assert!(
        notes.contains("requires `ACME_glow`")
            && notes.contains("material 2 `gone`: image 1: there is no file `../gone.png`"),
        "{notes}"
    );
    // Colours of Unity's materials are as screens show them.
    file.json["extensions"] = json!({"VRM": {"materialProperties": [{"shader": "VRM/MToon", "vectorProperties": {"_ShadeColor": [0.5, 1.0, 0.0, 1.0]},
        "textureProperties": {"_ShadeTexture": 1}}]}});
    let shade = file.read().unwrap().materials[0].shade_color.unwrap();
    assert!(
        (shade[0] - 0.214_041).abs() < 1e-5 && shade[1..] == [1.0, 0.0],
        "{shade:?}"
    );
}

/// A strip of two triangles with two joints, the second 1 above the first; each of the four vertices goes with the second by its weight.
fn skinned(weights: [f32; 4], animation: Value, more: impl FnOnce(&mut File) -> Value) -> File {
    let mut file = File::new();
    let places = file.floats(
        "VEC3",
        4,
        &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 1.0, 2.0, 0.0],
    );
    file.attribute("POSITION", places);
    let joints = file.accessor("VEC4", 5121, 4, &[0, 1, 9, 9].repeat(4));
    file.attribute("JOINTS_0", joints);
    let rows: Vec<f32> = weights
        .iter()
        .flat_map(|w| [2.0 - 2.0 * w, 2.0 * w, 0.0, 0.0])
        .collect();
    let weights = file.floats("VEC4", 4, &rows);
    file.attribute("WEIGHTS_0", weights);
    file.json["meshes"][0]["primitives"][0]["mode"] = json!(5);
    let matrix = |y: f32| {
        [
            1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -y, 0.0, 1.0,
        ]
    };
    let inverse = file.floats("MAT4", 2, &[matrix(0.0), matrix(1.0)].concat());
    // A skinned mesh doesn't go with its node.
    file.json["nodes"] = json!([
        {"mesh": 0, "skin": 0, "translation": [7.0, 7.0, 7.0]}, {"children": [2]}, {"name": "upper", "translation": [0.0, 1.0, 0.0]},
    ]);
    file.json["scenes"] = json!([{"nodes": [0, 1]}]);
    file.json["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": inverse}]);
    file.json["animations"] = json!([animation]);
    let samplers = more(&mut file);
    file.json["animations"][0]["samplers"] = samplers;
    file
}

#[test]
fn vertices_without_weights_are_told() {
    let mut file = skinned([0.5; 4], json!({"channels": []}), |_| json!([]));
    assert_eq!(file.read().unwrap().notes, [""; 0]);
    let weights = file.floats("VEC4", 4, &[0.0; 16]);
    file.attribute("WEIGHTS_0", weights);
    let told = "mesh 0, primitive 0: 4 vertices have no weight, and go with the skin's first joint";
    assert_eq!(file.read().unwrap().notes, [told]);
}

#[test]
fn meshes_out_of_the_world_are_refused() {
    let mut file = File::triangle();
    file.json["nodes"][0]["translation"] = json!([0.0, 1e7, 0.0]);
    file.read().unwrap();
    file.json["meshes"][0]["name"] = json!("hat");
    file.json["nodes"][0]["translation"] = json!([0.0, 1e30, 0.0]);
    file.refused("mesh `hat` lies farther than 100000000 m away");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn vertices_are_the_mean_of_where_joints_take_them(
        weights in prop::array::uniform4(0.0f32..=1.0), axis in prop::array::uniform3(-1.0f32..1.0), angle in 0.0f64..3.0, share in 0.0f64..=1.0,
    ) {
        let axis = DVec3::from(axis.map(f64::from)).normalize_or(DVec3::Y);
        let turn = DQuat::from_axis_angle(axis, angle);
        let channel = json!({"name": "bend", "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]});
        let file = skinned(weights, channel, |file| {
            let times = file.floats("SCALAR", 2, &[0.5, 2.5]);
            let turn = turn.as_quat().to_array();
            let values = file.floats("VEC4", 2, &[[0.0, 0.0, 0.0, 1.0], turn].concat());
            json!([{"input": times, "output": values}])
        });
        let model = file.read().unwrap();
        let rest = [Vec3::ZERO, Vec3::X, Vec3::Y * 2.0, Vec3::new(1.0, 2.0, 0.0)];
        for (place, rest) in model.meshes[0].positions.iter().zip(rest) {
            prop_assert!(place.distance(rest) < 1e-6);
        }
        let number = model.rig.as_ref().unwrap().animation("bend");
        let pose = model.pose(number, 0.5 + 2.0 * share).unwrap();
        let shape = &model.shapes(&pose)[0];
        let now = DQuat::from_axis_angle(axis, angle * share);
        for (vertex, rest) in rest.iter().enumerate() {
            let weight = f64::from(weights[vertex]);
            let bent = now * (rest.as_dvec3() - DVec3::Y) + DVec3::Y;
            let expected = rest.as_dvec3() * (1.0 - weight) + bent * weight;
            prop_assert!((shape.positions[vertex].as_dvec3() - expected).length() < 1e-5);
        }
        // A whole turn of all turns the normals.
        let all_turn = weights.iter().all(|weight| *weight == 1.0);
        if all_turn {
            prop_assert!((shape.normals[0].as_dvec3() - now * DVec3::Z).length() < 1e-5);
        }
        // Whatever somebody makes of a pose, vertices are somewhere.
        let mut broken = pose.clone();
        broken.nodes[2].rotation = DQuat::from_xyzw(f64::NAN, 0.0, f64::INFINITY, 1.0);
        broken.nodes[1].translation.x = f64::NAN;
        let shape = &model.shapes(&broken)[0];
        prop_assert!(shape.positions.iter().all(|p| p.is_finite()));
        prop_assert!(shape.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
    }
}

#[test]
fn morphs_are_added_by_weights_that_animations_move() {
    let mut file = File::triangle();
    let up = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    let aside = file.floats("VEC3", 3, &[2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    file.json["meshes"][0]["primitives"][0]["targets"] =
        json!([{"POSITION": up}, {"POSITION": aside}]);
    file.json["meshes"][0]["extras"] = json!({"targetNames": ["blink"]});
    file.json["meshes"][0]["weights"] = json!([0.5, 0.0]);
    let times = file.floats("SCALAR", 2, &[1.0, 3.0]);
    let values = file.floats("SCALAR", 4, &[0.0, 1.0, 1.0, 0.0]);
    file.json["animations"] = json!([{"samplers": [{"input": times, "output": values}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]);
    let model = file.read().unwrap();
    assert_eq!(model.morphs(0), ["blink", "1"]);
    assert_eq!(
        model.meshes[0].positions[..2],
        [Vec3::ZERO, Vec3::new(1.0, 0.5, 0.0)]
    );
    let at = |time: f64| {
        model
            .shapes(&model.pose(Some(0), time).unwrap())
            .remove(0)
            .positions
    };
    assert_eq!(at(0.0)[..2], [Vec3::X * 2.0, Vec3::X]);
    assert_eq!(at(2.5)[..2], [Vec3::X * 0.5, Vec3::new(1.0, 0.75, 0.0)]);
    assert_eq!(at(9.0)[..2], [Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)]);
    assert_eq!(model.pose(Some(1), 0.0), None);
    file.json["accessors"][values]["count"] = json!(3);
    file.refused("animation 0, channel 0: it has 2 keys and 3 values");
}

#[test]
fn mistakes_name_their_place() {
    let whole = || {
        skinned(
            [0.0, 0.25, 0.5, 1.0],
            json!({"channels": []}),
            |_| json!([]),
        )
    };
    assert!(whole().read().is_ok());
    for (path, value, expected) in [
        ("/skins/0/joints", json!([]), "skin 0: it has no joints"),
        (
            "/skins/0/joints",
            json!([1, 7]),
            "skin 0: it needs node 7, and there are 3",
        ),
        (
            "/skins/0/joints",
            json!([1]),
            "mesh 0 `face`, primitive 0: vertex 1 is moved by joint 1, and its skin has 1",
        ),
        (
            "/accessors/3/count",
            json!(1),
            "skin 0: it has 2 joints and 1 inverse bind matrices",
        ),
        ("/nodes/0/skin", json!(1), "node 0: it needs skin 1"),
        ("/nodes/0/mesh", json!(1), "node 0: it needs mesh 1"),
        (
            "/nodes/2/children",
            json!([1]),
            "node 1 is below two nodes, or below itself",
        ),
        (
            "/nodes/2/children",
            json!([2]),
            "node 2 is below two nodes, or below itself",
        ),
        (
            "/nodes/0/children",
            json!([2]),
            "node 2 is below two nodes, or below itself",
        ),
        ("/scenes/0/nodes", json!([5]), "scene 0: it needs node 5"),
        ("/scene", json!(5), "scene 5: it needs scene 5"),
        (
            "/accessors/1/count",
            json!(3),
            "its JOINTS_0 has 3 elements, and there are 4 vertices",
        ),
        (
            "/accessors/1/componentType",
            json!(5126),
            "accessor 1 is not of whole numbers",
        ),
        (
            "/accessors/0/type",
            json!("VEC2"),
            "primitive 0: accessor 0 is not of 3 numbers",
        ),
        (
            "/accessors/0/count",
            json!(99),
            "primitive 0: accessor 0 reaches beyond its buffer",
        ),
        (
            "/meshes/0/primitives/0/material",
            json!(0),
            "it needs material 0, and there are 0",
        ),
        (
            "/meshes/0/primitives/0/indices",
            json!(1),
            "accessor 1 is not of 1 numbers",
        ),
        (
            "/meshes/0/primitives/0/attributes",
            json!({}),
            "primitive 0: it has no positions",
        ),
        (
            "/meshes/0/primitives/0/extensions",
            json!({"KHR_draco_mesh_compression": {}}),
            "it is packed by KHR_draco_mesh_compression",
        ),
        (
            "/bufferViews/0/extensions",
            json!({"EXT_meshopt_compression": {}}),
            "it is packed by EXT_meshopt_compression",
        ),
    ] {
        let mut file = whole();
        file.json["meshes"][0]["name"] = json!("face");
        file.json["extensionsRequired"] =
            json!(["KHR_draco_mesh_compression", "EXT_meshopt_compression"]);
        let (parent, key) = path.rsplit_once('/').unwrap();
        file.json.pointer_mut(parent).unwrap()[key] = value;
        file.refused(expected);
    }
    let mut file = whole();
    file.json["nodes"][2]["translation"] = json!([1e39, 0.0, 0.0]);
    file.refused("number out of range");

    let mut file = File::triangle();
    // Who has the numbers a second time as they are needs no unpacking.
    file.json["bufferViews"][0]["extensions"] = json!({"EXT_meshopt_compression": {}});
    file.json["meshes"][0]["primitives"][0]["extensions"] =
        json!({"KHR_draco_mesh_compression": {}});
    assert!(file.read().is_ok());
    file.json["accessors"][0]["bufferView"] = Value::Null;
    file.refused("it is packed by KHR_draco_mesh_compression");

    let mut file = File::triangle();
    let indices = file.accessor("SCALAR", 5121, 3, &[0, 1, 3]);
    file.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    file.refused("mesh 0 `body`, primitive 0: triangle 0 has vertex 3, and there are 3, 0 first");
    for value in [f32::NAN, f32::INFINITY] {
        let mut file = File::triangle();
        file.bytes[4..8].copy_from_slice(&value.to_le_bytes());
        file.refused("accessor 0 has numbers that are not finite");
    }
}

#[test]
fn a_small_file_takes_little_memory() {
    // A hundred thousand nodes with one large mesh of zeros, and one that reads one place again and again.
    let mut file = File::triangle();
    file.json["nodes"] = vec![json!({"mesh": 0}); 100_000].into();
    file.json["scenes"] = json!([]);
    file.json["accessors"][0] =
        json!({"componentType": 5126, "count": 100_000, "type": "VEC3", "bufferView": 0});
    file.json["bufferViews"][0]["byteStride"] = json!(0);
    file.refused("accessor 0 is one too many");
}

#[test]
fn files_that_end_early_and_bytes_that_differ_never_panic() {
    let whole = skinned(
        [0.0, 0.25, 0.5, 1.0],
        json!({"channels": []}),
        |_| json!([]),
    )
    .text();
    for end in 0..whole.len() {
        assert!(from_bytes(&whole[..end], Path::new("")).is_err(), "{end}");
    }
    for at in 0..whole.len() {
        for byte in *b"9-}" {
            let mut altered = whole.clone();
            altered[at] = byte;
            if let Ok(model) = from_bytes(&altered, Path::new("")) {
                let pose = model.pose(None, 0.0).unwrap();
                assert_eq!(model.shapes(&pose).len(), model.meshes.len());
            }
        }
    }
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_not_followed() {
    let [folder, other] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let mut file = File::triangle();
    let bytes = std::mem::take(&mut file.bytes);
    std::fs::write(other.path().join("far.bin"), &bytes).unwrap();
    std::fs::write(folder.path().join("near.bin"), &bytes).unwrap();
    std::os::unix::fs::symlink(other.path().join("far.bin"), folder.path().join("link.bin"))
        .unwrap();
    std::os::unix::fs::symlink("near.bin", folder.path().join("inside.bin")).unwrap();
    let mut read = |uri: &str| {
        file.json["buffers"] = json!([{"byteLength": bytes.len(), "uri": uri}]);
        from_bytes(file.json.to_string().as_bytes(), folder.path())
    };
    assert_eq!(read("near.bin").unwrap(), read("inside.bin").unwrap());
    let message = read("link.bin").unwrap_err().to_string();
    assert!(
        message.contains("`link.bin` is not in the folder"),
        "{message}"
    );
}
