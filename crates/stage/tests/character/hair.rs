//! A character's own hair as strands.

use crate::made::{folder, points, scene, scene_of};
use glam::Vec3;
use serde_json::json;
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
