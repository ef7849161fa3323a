//! How a character's materials paint its meshes.

use crate::made::{Character, scene};
use glam::{Vec2, Vec3};
use render::{Coverage, Surface};
use serde_json::{Value, json};
use stage::{FrameMaker, Motion, Scene};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Adds to a list of the file, and gives its number there.
fn add(file: &mut Value, list: &str, value: Value) -> usize {
    if file[list].is_null() {
        file[list] = json!([]);
    }
    let list = file[list].as_array_mut().unwrap();
    list.push(value);
    list.len() - 1
}

/// Adds numbers of each of the character's 108 vertices, as an attribute of all its meshes.
fn attribute(file: &mut Value, folder: &Path, name: &str, kind: &str, numbers: &[f32]) {
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(folder.join(format!("{name}.bin")), &bytes).unwrap();
    let buffer = json!({"byteLength": bytes.len(), "uri": format!("{name}.bin")});
    let buffer = add(file, "buffers", buffer);
    let view = json!({"buffer": buffer, "byteLength": bytes.len()});
    let view = add(file, "bufferViews", view);
    let accessor =
        json!({"bufferView": view, "componentType": 5126, "count": VERTICES, "type": kind});
    let accessor = add(file, "accessors", accessor);
    for mesh in file["meshes"].as_array_mut().unwrap() {
        mesh["primitives"][0]["attributes"][name] = json!(accessor);
    }
}

const VERTICES: usize = 108;
/// The material of bangs and bow.
const THREADS: &str = "/materials/1";

/// A character whose bangs and bow have a picture of one texel.
fn painted(texel: [u8; 4], change: impl FnOnce(&mut Value)) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    Character::new().write(&folder.path().join("girl.gltf"), |file| {
        with_picture(file, folder.path());
        change(file);
    });
    write_picture(folder.path(), texel);
    folder
}

/// Gives bangs and bow a picture.
fn with_picture(file: &mut Value, folder: &Path) {
    attribute(file, folder, "TEXCOORD_0", "VEC2", &[0.5; 2 * VERTICES]);
    add(file, "images", json!({"uri": "a.png"}));
    add(file, "textures", json!({"source": 0}));
    let threads = file.pointer_mut(THREADS).unwrap();
    threads["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 0}});
}

/// Writes that picture, of one texel.
fn write_picture(folder: &Path, texel: [u8; 4]) {
    let picture = fs::File::create(folder.join("a.png")).unwrap();
    let mut encoder = png::Encoder::new(picture, 1, 1);
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&texel).unwrap();
    writer.finish().unwrap();
}

fn surfaces(scene: &Scene) -> Vec<Surface> {
    let (mut frames, motion) = (FrameMaker::new(), Motion::new());
    frames.frame(scene, &motion).unwrap().surfaces.to_vec()
}

/// Colour and coverage of the pictures that are drawn, and what is clear in them.
fn pictures(folder: &Path, hair: &str) -> Vec<([f32; 4], Coverage)> {
    let textures = surfaces(&scene(folder, hair).unwrap())
        .into_iter()
        .filter_map(|surface| surface.texture);
    textures
        .map(|texture| (texture.image.at([0.5; 2], 0.0, false), texture.coverage))
        .collect()
}

/// Hair of another file, so that all of the character's meshes are drawn.
fn hair(folder: &TempDir) -> &'static str {
    let strands = "(version: 1, strands: [(points: [(0, 1.7, 0.1), (0, 1.6, 0.12)])])";
    fs::write(folder.path().join("a.strands.ron"), strands).unwrap();
    "file: \"a.strands.ron\""
}

/// An opaque material doesn't look at its picture's alpha (glTF 2.0, 3.9.4): what is clear there has its colour.
#[test]
fn what_is_opaque_shows_its_picture_where_that_is_clear() {
    let folder = painted([255, 0, 0, 0], |_| {});
    let found = pictures(folder.path(), hair(&folder));
    assert!(!found.is_empty());
    for (texel, coverage) in found {
        assert_eq!((texel, coverage), ([1.0, 0.0, 0.0, 1.0], Coverage::Ignored));
    }
}

/// The alpha of a material's colour is multiplied by its picture's (3.9.2), and what is left of it blends, or cuts.
#[test]
fn a_colours_alpha_counts_with_its_pictures() {
    let with = |mode: &str, alpha: f32| {
        let folder = painted([255, 0, 0, 255], |file| {
            let threads = file.pointer_mut(THREADS).unwrap();
            threads["alphaMode"] = json!(mode);
            threads["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 1.0, 1.0, alpha]);
        });
        let hair = hair(&folder);
        let notes = scene(folder.path(), hair).unwrap().notes().join("\n");
        (pictures(folder.path(), hair), notes)
    };
    let (half, _) = with("BLEND", 0.5);
    assert!(!half.is_empty());
    for (texel, coverage) in half {
        assert!(
            (texel[3] - 0.5).abs() < 1e-3 && texel[0] == 1.0,
            "{texel:?}"
        );
        assert_eq!(coverage, Coverage::Share);
    }
    let (cut, notes) = with("MASK", 0.8);
    assert_eq!(
        cut[0].1,
        Coverage::Cut(0.625),
        "half of the cutoff's 0.5 by 0.8"
    );
    assert!(!notes.contains("not drawn"), "{notes}");
    for (mode, alpha) in [("BLEND", 0.0), ("MASK", 0.4)] {
        let (none, notes) = with(mode, alpha);
        assert!(none.is_empty(), "{mode} {alpha}");
        let told = "girl.gltf: not drawn, as its alpha is less than what shows: `Threads`";
        assert!(notes.contains(told), "{notes}");
    }
}

/// Where all would be gone, by a fault of what wrote it, all is drawn.
#[test]
fn a_character_is_not_clear_as_a_whole() {
    let folder = painted([255, 0, 0, 255], |file| {
        for material in file["materials"].as_array_mut().unwrap() {
            material["alphaMode"] = json!("BLEND");
            material["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 1.0, 1.0, 0.0]);
        }
    });
    let hair = hair(&folder);
    let notes = scene(folder.path(), hair).unwrap().notes().join("\n");
    assert!(
        notes.contains("girl.gltf: all of its materials are clear"),
        "{notes}"
    );
    for (texel, _) in pictures(folder.path(), hair) {
        assert_eq!(texel, [1.0, 0.0, 0.0, 1.0]);
    }
}

/// Colours of vertices are multiplied by the material's (3.9.2).
#[test]
fn colours_of_vertices_are_multiplied_in() {
    let with = |colors: &[f32], change: &dyn Fn(&mut Value)| {
        let folder = tempfile::tempdir().unwrap();
        Character::new().write(&folder.path().join("girl.gltf"), |file| {
            attribute(file, folder.path(), "COLOR_0", "VEC3", colors);
            change(file);
        });
        let own = scene(folder.path(), hair(&folder)).unwrap();
        let lights = surfaces(&own).into_iter().map(|surface| surface.light);
        (lights.collect::<Vec<_>>(), own.notes().join("\n"))
    };
    let some_are = |lights: &[[f32; 3]], expected: [f32; 3]| {
        let mut lights = lights.iter().map(|light| Vec3::from(*light));
        lights.any(|light| light.distance(expected.into()) < 1e-3)
    };
    let (lights, notes) = with(&[1.0, 0.5, 0.25].repeat(VERTICES), &|_| {});
    assert!(some_are(&lights, [0.1, 0.1, 0.2]), "{lights:?}");
    assert!(!notes.contains("colours of its vertices"), "{notes}");
    // Toon materials have their own colours.
    let (lights, _) = with(&[1.0, 0.5, 0.25].repeat(VERTICES), &|file| {
        let toon = json!({"VRMC_materials_mtoon": {"shadeColorFactor": [0.1, 0.1, 0.1]}});
        file.pointer_mut(THREADS).unwrap()["extensions"] = toon;
    });
    assert!(some_are(&lights, [0.1, 0.2, 0.8]), "{lights:?}");
}

/// Where they differ they run from corner to corner.
#[test]
fn triangles_have_the_colours_of_their_corners() {
    // Rows of a box are red, green and blue in turn.
    let row = |row: usize| [0, 1, 2].map(|i| if i == row % 3 { 1.0 } else { 0.0 });
    let colors: Vec<f32> = (0..VERTICES).flat_map(|vertex| row(vertex / 4)).collect();
    let write = |change: &dyn Fn(&mut Value)| {
        let folder = tempfile::tempdir().unwrap();
        Character::new().write(&folder.path().join("girl.gltf"), |file| {
            attribute(file, folder.path(), "COLOR_0", "VEC3", &colors);
            change(file);
        });
        folder
    };
    let folder = write(&|_| {});
    let own = scene(folder.path(), hair(&folder)).unwrap();
    let mut seen = 0;
    for surface in surfaces(&own) {
        let Some(texture) = surface.texture else {
            continue;
        };
        assert_eq!(texture.places.len(), surface.vertices.len());
        let at = |place: Vec2| {
            // However small it is on the screen.
            let [sharp, blurred] =
                [0.0, 0.5].map(|size| texture.image.at(place.into(), size, texture.repeats));
            assert_eq!(sharp, blurred);
            Vec3::new(sharp[0], sharp[1], sharp[2])
        };
        for triangle in &surface.triangles {
            let places = triangle.map(|corner| texture.places[corner as usize]);
            let corners = places.map(at);
            let pure = |color: &Vec3| {
                (color.max_element() - 1.0).abs() < 1e-3 && color.element_sum() < 1.001
            };
            assert!(corners.iter().all(pure), "{corners:?}");
            // In the middle, and between two corners, there is as much of each.
            let [a, b, c] = places;
            let mean = corners.iter().sum::<Vec3>() / 3.0;
            let middle = at((a + b + c) / 3.0);
            assert!(middle.distance(mean) < 1e-3, "{middle} {mean}");
            for (from, to) in [(0, 1), (0, 2), (1, 2)] {
                let middle = at((places[from] + places[to]) / 2.0);
                assert!(middle.distance((corners[from] + corners[to]) / 2.0) < 1e-3);
            }
            seen += 1;
        }
    }
    assert!(seen > 20, "{seen}");
    // With a picture beside them they are their mean, and that is told.
    let folder = tempfile::tempdir().unwrap();
    Character::new().write(&folder.path().join("girl.gltf"), |file| {
        attribute(file, folder.path(), "COLOR_0", "VEC3", &colors);
        with_picture(file, folder.path());
    });
    write_picture(folder.path(), [255; 4]);
    let own = scene(folder.path(), hair(&folder)).unwrap();
    let notes = own.notes().join("\n");
    let told =
        "mesh `Bow` has a picture and colours of its vertices, and is drawn in the mean of these";
    assert!(notes.contains(told), "{notes}");
    let third = [1.0 / 3.0; 3];
    let lights = surfaces(&own).into_iter().map(|surface| surface.light);
    let mut lights = lights.map(Vec3::from);
    assert!(lights.any(|light| light.distance(third.into()) < 1e-3));
}

/// A shell around the head that faces inwards is an outline, as toon models have it: seen past the head's edges, and no part of its shape.
#[test]
fn a_shell_is_seen_past_the_edges_alone() {
    let with = |double_sided: bool| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("girl.gltf");
        Character::new().with_shell().write(&path, |file| {
            let shell = json!({"name": "Ink", "doubleSided": double_sided,
                "pbrMetallicRoughness": {"baseColorFactor": [0.0, 0.0, 0.0, 1.0]}});
            let shell = add(file, "materials", shell);
            let meshes = file["meshes"].as_array_mut().unwrap();
            meshes.last_mut().unwrap()["primitives"][0]["material"] = json!(shell);
        });
        let own = scene(folder.path(), hair(&folder)).unwrap();
        (surfaces(&own), own.head(), own.notes().join("\n"))
    };
    let bare = {
        let folder = tempfile::tempdir().unwrap();
        Character::new().write(&folder.path().join("girl.gltf"), |_| {});
        scene(folder.path(), hair(&folder)).unwrap().head()
    };
    let (surfaces, head, notes) = with(false);
    assert_eq!(head, bare);
    let told = "girl.gltf: mesh `Shell` faces inwards around others: an outline of the file's own";
    assert!(notes.contains(told), "{notes}");
    assert!(!notes.contains("turned around"), "{notes}");
    let black = |surfaces: &[Surface]| {
        let black = surfaces.iter().filter(|surface| surface.light == [0.0; 3]);
        black
            .map(|surface| surface.triangles.len())
            .collect::<Vec<_>>()
    };
    // What faces the eye of it is the far half's inside; from behind, nothing of it is.
    let [seen] = black(&surfaces)[..] else {
        panic!("{:?}", black(&surfaces));
    };
    assert!(seen > 0);
    // Seen from both sides it is no shell, but a box that the head is in.
    let (surfaces, _, _) = with(true);
    assert!(black(&surfaces).iter().sum::<usize>() > seen);
}
