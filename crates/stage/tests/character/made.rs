//! A character made in code, and scenes of it.

use effects::Registry;
use glam::Vec3;
use serde_json::{Value, json};
use stage::{Files, Motion, Preset, Scene};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A character in glTF: a head (a box) with a lock in front of it, whose lower end swings, and a ribbon; nodes "head", "HairFront" and "Bow".
pub struct Character {
    positions: Vec<[f32; 3]>,
    /// Of each position its joint.
    joints: Vec<[u8; 4]>,
    /// Of each mesh its name and triangles.
    meshes: Vec<(&'static str, Vec<u16>)>,
}

impl Character {
    pub fn new() -> Self {
        let mut own = Self {
            positions: Vec::new(),
            joints: Vec::new(),
            meshes: Vec::new(),
        };
        own.add("Skull", [0.0, 1.6, 0.0], [0.08, 0.12, 0.09], 0);
        own.add("Bangs", [0.03, 1.62, 0.11], [0.008, 0.07, 0.008], 1);
        own.add("Bow", [-0.05, 1.72, 0.03], [0.03, 0.006, 0.006], 2);
        own
    }

    /// The same with an arm of skin along X, in front of it and lower.
    pub fn with_arm(mut self) -> Self {
        self.add("Arm", [0.03, 1.2, 0.3], [0.1, 0.03, 0.03], 0);
        self
    }

    /// The same with a box around its head that faces inwards.
    pub fn with_shell(mut self) -> Self {
        self.add("Shell", [0.0, 1.6, 0.0], [0.084, 0.126, 0.095], 0);
        let (_, triangles) = self.meshes.last_mut().unwrap();
        turn_around(triangles);
        self
    }

    /// The same with its outside where the inside was, as some programs write it.
    pub fn inside_out(mut self) -> Self {
        for (_, triangles) in &mut self.meshes {
            turn_around(triangles);
        }
        self
    }

    /// Adds a box in rows from top to bottom, which a joint moves.
    fn add(&mut self, name: &'static str, center: [f32; 3], half: [f32; 3], joint: u8) {
        const ROWS: u16 = 8;
        let first = self.positions.len() as u16;
        for row in 0..=ROWS {
            let y = center[1] + half[1] * (1.0 - 2.0 * f32::from(row) / f32::from(ROWS));
            for [x, z] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
                self.positions
                    .push([center[0] + x * half[0], y, center[2] + z * half[2]]);
                self.joints.push([joint, 0, 0, 0]);
            }
        }
        let mut triangles = Vec::new();
        for row in 0..ROWS {
            for side in 0..4 {
                let at = |row: u16, side: u16| first + 4 * row + side % 4;
                let [a, b, c, d] = [
                    at(row, side),
                    at(row, side + 1),
                    at(row + 1, side),
                    at(row + 1, side + 1),
                ];
                triangles.extend([a, b, c, b, d, c]);
            }
        }
        let last = first + 4 * ROWS;
        triangles.extend([first, first + 2, first + 1, first, first + 3, first + 2]);
        triangles.extend([last, last + 1, last + 2, last, last + 2, last + 3]);
        self.meshes.push((name, triangles));
    }

    pub fn write(&self, path: &Path, change: impl FnOnce(&mut Value)) {
        let mut bytes: Vec<u8> = Vec::new();
        bytes.extend(
            self.positions
                .iter()
                .flatten()
                .flat_map(|x| x.to_le_bytes()),
        );
        let joints_at = bytes.len();
        bytes.extend(self.joints.iter().flatten());
        let weights_at = bytes.len();
        let weights = self.joints.iter().flat_map(|_| [1.0_f32, 0.0, 0.0, 0.0]);
        bytes.extend(weights.flat_map(f32::to_le_bytes));
        let mut views = vec![
            json!({"buffer": 0, "byteOffset": 0, "byteLength": joints_at}),
            json!({"buffer": 0, "byteOffset": joints_at, "byteLength": weights_at - joints_at}),
            json!({"buffer": 0, "byteOffset": weights_at, "byteLength": bytes.len() - weights_at}),
        ];
        let count = self.positions.len();
        let mut accessors = vec![
            json!({"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"}),
            json!({"bufferView": 1, "componentType": 5121, "count": count, "type": "VEC4"}),
            json!({"bufferView": 2, "componentType": 5126, "count": count, "type": "VEC4"}),
        ];
        let mut meshes = Vec::new();
        for (name, triangles) in &self.meshes {
            let at = bytes.len();
            bytes.extend(triangles.iter().flat_map(|i| i.to_le_bytes()));
            views.push(json!({"buffer": 0, "byteOffset": at, "byteLength": bytes.len() - at}));
            let view = views.len() - 1;
            accessors.push(json!({"bufferView": view, "componentType": 5123, "count": triangles.len(), "type": "SCALAR"}));
            let attributes = json!({"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2});
            let material = usize::from(*name != "Skull");
            meshes.push(json!({"name": name, "primitives": [{"attributes": attributes, "indices": accessors.len() - 1, "material": material}]}));
        }
        let place = |y: f32, z: f32| json!([0.0, y, z]);
        let mut nodes = vec![
            json!({"name": "neck", "children": [1]}),
            json!({"name": "head", "children": [2, 3], "translation": place(1.5, 0.0)}),
            json!({"name": "HairFront", "translation": place(0.2, 0.1)}),
            json!({"name": "Bow", "translation": place(0.22, 0.0)}),
        ];
        nodes.extend((0..meshes.len()).map(|mesh| json!({"mesh": mesh, "skin": 0})));
        let mut file = json!({
            "asset": {"version": "2.0"}, "nodes": nodes, "meshes": meshes, "accessors": accessors, "bufferViews": views,
            "buffers": [{"byteLength": bytes.len(), "uri": "a.bin"}],
            "materials": [{"name": "Skin"}, {"name": "Threads", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.8, 1.0]}}],
            "skins": [{"joints": [1, 2, 3], "inverseBindMatrices": null}],
            "extensions": {"VRMC_springBone": {"springs": [{"joints": [{"node": 2}]}, {"joints": [{"node": 3}]}]}},
        });
        // Bound where they lie: joints move nothing at rest.
        let inverse: Vec<u8> = [[0.0, -1.5, 0.0], [0.0, -1.7, -0.1], [0.0, -1.72, 0.0]]
            .iter()
            .flat_map(|[x, y, z]| {
                [
                    1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, *x, *y, *z, 1.0,
                ]
            })
            .flat_map(f32::to_le_bytes)
            .collect();
        let at = bytes.len();
        bytes.extend(&inverse);
        let views = file["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": at, "byteLength": inverse.len()}));
        let view = views.len() - 1;
        let accessors = file["accessors"].as_array_mut().unwrap();
        accessors
            .push(json!({"bufferView": view, "componentType": 5126, "count": 3, "type": "MAT4"}));
        file["skins"][0]["inverseBindMatrices"] = json!(accessors.len() - 1);
        file["buffers"][0]["byteLength"] = json!(bytes.len());
        change(&mut file);
        fs::write(path, file.to_string()).unwrap();
        fs::write(path.with_file_name("a.bin"), bytes).unwrap();
    }
}

fn turn_around(triangles: &mut [u16]) {
    let triangles = triangles.chunks_exact_mut(3);
    triangles.for_each(|corners| corners.swap(1, 2));
}

pub fn folder(change: impl FnOnce(&mut Value)) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    Character::new().write(&folder.path().join("girl.gltf"), change);
    folder
}

pub fn scene_of(folder: &Path, text: &str, files: &Files) -> Result<Scene, String> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let preset = Preset::parse("look.ron", text, &registry).map_err(|error| error.to_string())?;
    let files = Files {
        preset_folder: folder.to_owned(),
        ..files.clone()
    };
    preset
        .check_scene("look.ron", text, &files)
        .map_err(|error| error.to_string())?;
    Scene::load(&preset, &files).map_err(|error| error.to_string())
}

pub fn scene(folder: &Path, hair: &str) -> Result<Scene, String> {
    let text = format!(
        "(version: 1, hair: ({hair}), head: (file: \"girl.gltf\", colors: file), scene: (size: (90, 90), samples: 4), \
         layers: [(effect: \"hair.base\")])"
    );
    scene_of(folder, &text, &Files::default())
}

/// The points of all strands at rest.
pub fn points(scene: &Scene) -> Vec<Vec3> {
    Motion::new().points(scene, 0).to_vec()
}
