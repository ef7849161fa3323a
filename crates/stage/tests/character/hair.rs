//! A character's own hair as strands.

use crate::made::{folder, points, scene, scene_of};
use glam::Vec3;
use serde_json::{Value, json};
use stage::{Files, FrameMaker, Motion, Scene};
use std::fs;
use std::path::Path;

fn triangles(scene: &Scene) -> usize {
    let mut frames = FrameMaker::new();
    let motion = Motion::new();
    let frame = frames.frame(scene, &motion).unwrap();
    frame
        .surfaces
        .iter()
        .map(|surface| surface.triangles.len())
        .sum()
}

#[test]
fn what_is_called_hair_becomes_strands_and_is_hidden() {
    let folder = folder(|_| {});
    let own = scene(folder.path(), "from: character").unwrap();
    // The bone HairFront is called hair, the bow is not: one lock of a strand.
    let found = points(&own);
    let (root, tip) = (found[0], found[found.len() - 1]);
    assert!(root.distance(Vec3::new(0.03, 1.69, 0.11)) < 2e-3, "{root}");
    assert!(tip.distance(Vec3::new(0.03, 1.55, 0.11)) < 2e-3, "{tip}");
    assert_eq!(own.strand_count(), 1);
    let notes = own.notes().join("\n");
    assert!(
        notes.contains("hair: 1 strands in 1 locks of the character's own"),
        "{notes}"
    );
    // Of the three boxes two are drawn as meshes, and their lines.
    let with_bow = triangles(&own);
    let both = scene(folder.path(), "from: character, meshes: \"Bangs, Bow\"").unwrap();
    assert_eq!(both.strand_count(), 2);
    assert!(triangles(&both) < with_bow);
    let kept = scene(
        folder.path(),
        "from: character, meshes: \"B*\", keep: \"bow\"",
    )
    .unwrap();
    assert_eq!(triangles(&kept), with_bow);
    // It reaches over the head, which is as high as without it.
    assert_eq!(kept.head(), both.head());
    assert!(own.head().height_m > both.head().height_m);
    // By its material, and by its bone.
    assert_eq!(
        scene(folder.path(), "from: character, meshes: \"Threads\"")
            .unwrap()
            .strand_count(),
        2
    );
    assert_eq!(
        scene(folder.path(), "from: character, meshes: \"Bow\"")
            .unwrap()
            .strand_count(),
        1
    );
}

/// Hair of a file's own that becomes no strands is told: other hair would grow on it as on skin.
#[test]
fn hair_that_stays_a_part_of_the_head_is_told() {
    let folder = folder(|gltf| gltf["meshes"][1]["name"] = json!("Front_Hair"));
    let style =
        "(version: 1, zones: [(name: \"top\", count: 3, roots: [(0, 80), (60, 80)], hang: 0.2)])";
    fs::write(folder.path().join("top.style.ron"), style).unwrap();
    let told = "`Front_Hair` is a part of the head's shape";
    let notes = |hair: &str| scene(folder.path(), hair).unwrap().notes().join("\n");
    let other = notes("file: \"top.style.ron\"");
    assert!(other.contains(told), "{other}");
    let own = notes("from: character");
    assert!(!own.contains(told), "{own}");
}

#[test]
fn strands_have_the_colours_and_the_size_of_the_mesh() {
    let folder = folder(|_| {});
    let own = scene(folder.path(), "from: character").unwrap();
    let (mut frames, motion) = (FrameMaker::new(), Motion::new());
    let frame = frames.frame(&own, &motion).unwrap();
    let strand = &frame.strands[0];
    assert!(
        strand.colors[0].distance(Vec3::new(0.1, 0.2, 0.8)) < 1e-3,
        "{:?}",
        strand.colors
    );
    let half_width_m = strand.size * own.head().height_m / 300.0;
    // Between half a side and half a diagonal of the box.
    assert!((0.0079..0.0115).contains(&half_width_m), "{half_width_m}");
}

/// A lock that is red in its upper half and green below.
#[test]
fn strands_have_the_colours_of_the_meshs_picture() {
    let places = (0..27).flat_map(|row| [[0.5, (row % 9) as f32 / 8.0]; 4]);
    let bytes: Vec<u8> = places.flatten().flat_map(f32::to_le_bytes).collect();
    let folder = folder(|file| {
        let list = |file: &mut Value, name: &str, value: Value| {
            let list = file[name].as_array_mut().unwrap();
            list.push(value);
            list.len() - 1
        };
        let view = json!({"buffer": 1, "byteLength": bytes.len()});
        let buffer = json!({"byteLength": bytes.len(), "uri": "places.bin"});
        list(file, "buffers", buffer);
        let view = list(file, "bufferViews", view);
        let places = list(
            file,
            "accessors",
            json!({"bufferView": view, "componentType": 5126, "count": 108, "type": "VEC2"}),
        );
        for mesh in 0..3 {
            file["meshes"][mesh]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(places);
        }
        file["images"] = json!([{"uri": "lock.png"}]);
        file["textures"] = json!([{"source": 0}]);
        file["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
    });
    fs::write(folder.path().join("places.bin"), bytes).unwrap();
    let picture = fs::File::create(folder.path().join("lock.png")).unwrap();
    let mut encoder = png::Encoder::new(picture, 1, 8);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    let halves = [[[255, 0, 0]; 4], [[0, 255, 0]; 4]];
    writer
        .write_image_data(halves.as_flattened().as_flattened())
        .unwrap();
    writer.finish().unwrap();
    let own = scene(folder.path(), "from: character").unwrap();
    let (mut frames, motion) = (FrameMaker::new(), Motion::new());
    let [root, tip] = frames.frame(&own, &motion).unwrap().strands[0].colors;
    // The picture's times the material's.
    assert!(root.distance(Vec3::new(0.1, 0.0, 0.0)) < 1e-3, "{root}");
    assert!(tip.distance(Vec3::new(0.0, 0.2, 0.0)) < 1e-3, "{tip}");
}

#[test]
fn what_is_kept_is_not_looked_for() {
    // Only the clip is called hair, and bones move the hair.
    let clip = folder(|file| file["meshes"][2]["name"] = json!("HairClip"));
    let kept = scene(clip.path(), "from: character, keep: \"HairClip\"").unwrap();
    assert_eq!(kept.strand_count(), 1);
    assert!(points(&kept)[0].distance(Vec3::new(0.03, 1.69, 0.11)) < 2e-3);
    // The same of bones.
    let clip = folder(|file| {
        file["nodes"][2]["name"] = json!("Front");
        file["nodes"][3]["name"] = json!("HairClip");
    });
    let kept = scene(clip.path(), "from: character, keep: \"HairClip\"").unwrap();
    assert_eq!(kept.strand_count(), 1);
    assert!(points(&kept)[0].distance(Vec3::new(0.03, 1.69, 0.11)) < 2e-3);
}

/// One mesh is called hair, and a ribbon that a bone of its own moves is in it.
#[test]
fn a_bone_may_keep_a_part_of_a_mesh() {
    let folder = folder(|file| {
        file["nodes"][3]["name"] = json!("Ribbon");
        for mesh in [1, 2] {
            file["meshes"][mesh]["name"] = json!("Hair");
        }
    });
    let all = scene(folder.path(), "from: character").unwrap();
    assert_eq!(all.strand_count(), 2);
    let kept = scene(folder.path(), "from: character, keep: \"Ribbon\"").unwrap();
    assert_eq!(kept.strand_count(), 1);
    assert!(points(&kept)[0].distance(Vec3::new(0.03, 1.69, 0.11)) < 2e-3);
    assert!(triangles(&kept) > triangles(&all));
}

/// A bone far down a chain is hair by the one that the chain begins with.
#[test]
fn chains_may_be_long() {
    const LINKS: usize = 20_000;
    let folder = folder(|file| {
        let nodes = file["nodes"].as_array_mut().unwrap();
        let first = nodes.len();
        nodes[1]["children"] = json!([2, 3, first]);
        let last = first + LINKS - 1;
        nodes.extend((first..last).map(|node| json!({"children": [node + 1]})));
        nodes.push(json!({"translation": [0.0, 0.22, 0.0]}));
        nodes[first]["name"] = json!("HairBack");
        file["skins"][0]["joints"][2] = json!(last);
        let joints: Vec<Value> = (first..=last).map(|node| json!({"node": node})).collect();
        file["extensions"]["VRMC_springBone"]["springs"] =
            json!([{"joints": [{"node": 2}]}, {"joints": joints}]);
    });
    let own = scene(folder.path(), "from: character").unwrap();
    assert_eq!(own.strand_count(), 2);
}

#[test]
fn mistakes_name_their_place() {
    let folder = folder(|_| {});
    let told = |hair: &str| scene(folder.path(), hair).err().unwrap();
    let message = told("from: character, meshes: \"Bang\"");
    assert!(message.contains("look.ron:1:"), "{message}");
    assert!(
        message
            .contains("no mesh, material or spring bone is called `Bang`, did you mean `Bangs`?"),
        "{message}"
    );
    let message = told("from: character, keep: \"Bows\"");
    assert!(message.contains("did you mean `Bow`?"), "{message}");
    let message = told("from: characters");
    assert!(message.contains("did you mean `character`?"), "{message}");
    // A character without hair has that of the file, or none.
    let bald = crate::made::folder(|file| {
        file["extensions"] = json!({});
    });
    let message = scene(bald.path(), "from: character").err().unwrap();
    assert!(
        message.contains("girl.gltf: no mesh or material is called hair"),
        "{message}"
    );
    fs::write(
        bald.path().join("a.strands.ron"),
        "(version: 1, strands: [(points: [(0, 1.72, 0), (0, 1.8, 0)])])",
    )
    .unwrap();
    let stage = scene(bald.path(), "from: character, file: \"a.strands.ron\"").unwrap();
    assert!(
        stage
            .notes()
            .iter()
            .any(|note| note.contains("the character has none of its own"))
    );
}

/// Her fringe hangs before a head of skin and cap that it was cut off: after a turn it comes back, and sleeps.
#[test]
fn godettes_fringe_rests_after_a_turn() {
    let Some(data) = std::env::var_os("INKSTRAND_DATA") else {
        return eprintln!("SKIPPED 1 test: INKSTRAND_DATA is not set");
    };
    let path = Path::new(&data).join("vrm/Godette_vrm_v4.vrm");
    let text = format!(
        "(version: 1, hair: (from: character), head: (file: {:?}, colors: file), motion: (file: \"head-turn.motion.ron\"), \
         layers: [(effect: \"hair.base\")])",
        path.display().to_string()
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets/motions");
    let stage = scene_of(&folder, &text, &Files::default()).unwrap();
    let mut motion = Motion::new();
    let mut at = |time: f32| {
        motion.advance_to(&stage, time).unwrap();
        (motion.points(&stage, 0).to_vec(), motion.simulated())
    };
    let (rest, _) = at(0.0);
    let (turned, _) = at(1.0);
    let (found, _) = at(19.5);
    let (later, stats) = at(20.0);
    let farthest = |a: &[Vec3], b: &[Vec3]| {
        let moves = a.iter().zip(b).map(|(a, b)| a.distance(*b));
        moves.fold(0.0, f32::max)
    };
    assert!(farthest(&turned, &rest) > 0.05);
    assert!(found == later, "{}", farthest(&found, &later));
    assert!(stats.asleep > 0 && stats.strands == 0, "{stats:?}");
    assert!(
        farthest(&later, &rest) < 0.01,
        "{}",
        farthest(&later, &rest)
    );
}

/// What no mesh is called may be what hangs on a bone.
#[test]
fn what_hangs_on_bones_may_be_hidden() {
    let folder = folder(|_| {});
    let with = |hide: &str| {
        let text = format!(
            "(version: 1, hair: (from: character), head: (file: \"girl.gltf\", colors: file, hide: \"{hide}\"), layers: [(effect: \"hair.base\")])"
        );
        scene_of(folder.path(), &text, &Files::default())
    };
    let whole = triangles(&scene(folder.path(), "from: character").unwrap());
    assert!(triangles(&with("Bow").unwrap()) < whole);
    // Of the bone's lock nothing is left that could be hair.
    let message = with("hairfront").err().unwrap();
    assert!(
        message.contains("girl.gltf: no mesh or material is called hair"),
        "{message}"
    );
    let message = with("HairFrnt").err().unwrap();
    assert!(
        message
            .contains("no mesh, material or bone is called `HairFrnt`, did you mean `HairFront`?"),
        "{message}"
    );
    // Below the neck hangs all.
    let message = with("neck").err().unwrap();
    assert!(message.contains("hides all of its meshes"), "{message}");
}

/// Godette's backpack is no mesh of its own.
#[test]
fn godettes_backpack_hangs_on_a_bone() {
    let Some(data) = std::env::var_os("INKSTRAND_DATA") else {
        return eprintln!("SKIPPED 1 test: INKSTRAND_DATA is not set");
    };
    let path = Path::new(&data).join("vrm/Godette_vrm_v4.vrm");
    let with = |hide: &str| {
        let text = format!(
            "(version: 1, hair: (from: character), head: (file: {:?}, colors: file, width: 0 {hide}), layers: [(effect: \"hair.base\")])",
            path.display().to_string()
        );
        scene_of(Path::new(""), &text, &Files::default()).unwrap()
    };
    let without = |hide: &str| with(&format!(", hide: \"{hide}\""));
    let whole = with("");
    // Her material of that name is the backpack, but for its logo and straps.
    let [material, bone] = ["Backpack", "backpack_Armature"].map(without);
    assert!(triangles(&bone) < triangles(&whole) && triangles(&material) < triangles(&whole));
    // Her hair stays, but for what her size makes of it: that is told from what is left of her.
    assert!(bone.strand_count().abs_diff(whole.strand_count()) <= 2);
    assert!(without("HairBall*").strand_count() < whole.strand_count());
}

#[test]
fn hair_of_a_head_needs_the_heads_file() {
    let folder = folder(|_| {});
    let with = |hair: &str, head: &str| {
        let text = format!(
            "(version: 1, hair: (from: character, {hair}), head: ({head}), layers: [(effect: \"hair.base\")])"
        );
        scene_of(folder.path(), &text, &Files::default())
    };
    let message = with("", "shape: bust").err().unwrap();
    assert!(
        message.contains("look.ron:1:14: `hair.from: character` takes the hair of the head's file"),
        "{message}"
    );
    fs::write(
        folder.path().join("a.strands.ron"),
        "(version: 1, strands: [(points: [(0, 1.72, 0), (0, 1.8, 0)])])",
    )
    .unwrap();
    let own = with("file: \"a.strands.ron\"", "shape: bust").unwrap();
    let notes = own.notes().join("\n");
    assert!(notes.contains("there is no head's file"), "{notes}");
    // Nor is there a head where all of it is hair.
    let message = with("meshes: \"*\"", "file: \"girl.gltf\", hide: \"Skull\"")
        .err()
        .unwrap();
    assert!(
        message.contains("look.ron:1:")
            && message.contains("girl.gltf: all that is not hidden became hair"),
        "{message}"
    );
}

#[test]
fn hair_that_the_caller_gives_comes_first() {
    let folder = folder(|_| {});
    let hair = folder.path().join("two.strands.ron");
    fs::write(&hair, "(version: 1, strands: [(points: [(0, 1.72, 0), (0, 1.8, 0)]), (points: [(0.05, 1.72, 0), (0.05, 1.8, 0)])])").unwrap();
    let text = "(version: 1, hair: (from: character), head: (file: \"girl.gltf\"), layers: [(effect: \"hair.base\")])";
    let files = Files {
        hair: Some(hair),
        ..Files::default()
    };
    assert_eq!(
        scene_of(folder.path(), text, &files)
            .unwrap()
            .strand_count(),
        2
    );
}

/// Godette's three balls and her fringe; the cap is a mesh.
#[test]
fn godettes_hair_stays_where_her_mesh_has_it() {
    let Some(data) = std::env::var_os("INKSTRAND_DATA") else {
        return eprintln!("SKIPPED 1 test: INKSTRAND_DATA is not set");
    };
    let path = Path::new(&data).join("vrm/Godette_vrm_v4.vrm");
    let text = format!(
        "(version: 1, hair: (from: character), head: (file: {:?}, colors: file), clump: (mix: 1, shrink_start: 1, size_variation: 0), \
         layers: [(effect: \"hair.base\")])",
        path.display().to_string()
    );
    let stage = scene_of(Path::new(""), &text, &Files::default()).unwrap();
    let height_m = stage.head().height_m;
    let all = points(&stage);
    let (mut frames, motion) = (FrameMaker::new(), Motion::new());
    let frame = frames.frame(&stage, &motion).unwrap();
    let strand = |size: f32| frame.strands.iter().any(|s| (s.size - size).abs() < 1e-3);
    assert!(
        strand(14.0),
        "those of the balls are as wide as strands may be"
    );
    // The ball on her left, in m; in the file she faces the other way.
    let (center, radius) = (Vec3::new(0.181, 1.266, -0.195), 0.107);
    let own = all.iter().filter(|p| p.distance(center) < 1.05 * radius);
    let own: Vec<Vec3> = own.copied().collect();
    let half_width_m = 14.0 / 300.0 * height_m;
    let low = own.iter().copied().reduce(Vec3::min).unwrap() - half_width_m;
    let high = own.iter().copied().reduce(Vec3::max).unwrap() + half_width_m;
    assert!(
        (low - (center - radius)).abs().max_element() < 0.006,
        "{low}"
    );
    // But for its front, where roots begin under the cap.
    let off = (high - (center + radius)).abs();
    assert!(off.x < 0.006 && off.y < 0.006, "{high}");
    // The fringe hangs in front of her forehead, between the brows and the cap.
    let fringe: Vec<&Vec3> = all.iter().filter(|p| p.z > 0.13).collect();
    assert!(fringe.len() > 20);
    assert!(fringe.iter().all(|p| (1.2..1.36).contains(&p.y)));
}
