//! Bodies that are meshes: worn ones, and what their files and animations make of them.

use super::*;

/// A mesh that goes by more than its thickness from form to form takes hair along as one that `body_keys` move.
#[test]
fn a_mesh_that_its_files_move_takes_hair_along() {
    let given = Given::new(TAIL, "(version: 1)", "");
    let (center, height_m) = {
        let scene = given.scene().unwrap();
        (scene.head().center, scene.head().height_m)
    };
    // 26 forms in a second, from the right through the tail.
    let half = 0.12 * height_m;
    let place = |x: f32| (center + Vec3::new(x, -0.7, -0.6) * height_m).to_array();
    let place_of_form = |form: u32| place(1.5 - 3.0 * form as f32 / 25.0);
    for form in 0..26 {
        let text = cube([half; 3], place_of_form(form));
        fs::write(given.folder.path().join(format!("box.{form:04}.obj")), text).unwrap();
    }
    let alone = cube([half; 3], place(1.5));
    fs::write(given.folder.path().join("alone.obj"), alone).unwrap();
    let by_files =
        "(version: 1, bodies: [(shape: mesh, file: \"box.####.obj\", rate: 25)])".to_owned();
    let by_keys = "(version: 1, bodies: [(name: \"box\", shape: mesh, file: \"alone.obj\")], \
                   body_keys: [(body: \"box\", time: 0), (body: \"box\", time: 1, at: (-3, 0, 0))])"
        .to_owned();
    let [by_files, by_keys] = [by_files, by_keys].map(|script| {
        fs::write(given.folder.path().join("a.motion.ron"), script).unwrap();
        let scene = given.scene().unwrap();
        let mut motion = Motion::new();
        let rest = points(&scene, &mut motion, 0.0);
        let far = (1..=24).map(|frame| {
            let now = points(&scene, &mut motion, frame as f32 / 24.0);
            let ways = rest.iter().zip(&now).map(|(a, b)| a.distance(*b));
            ways.fold(0.0, f32::max)
        });
        far.fold(0.0, f32::max)
    });
    println!(
        "hair goes by {by_files:.3} m before a mesh of files, by {by_keys:.3} before one with keys"
    );
    assert!(by_keys > 0.1, "{by_keys}");
    assert!(by_files > 0.9 * by_keys, "{by_files}, {by_keys}");
}

/// A box about 0, m, and the same in another form.
pub(super) fn cube(half: [f32; 3], at: [f32; 3]) -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let side = |axis: usize| {
            if corner >> axis & 1 == 1 {
                half[axis]
            } else {
                -half[axis]
            }
        };
        let [x, y, z] = [0, 1, 2].map(|axis| side(axis) + at[axis]);
        text += &format!("v {x} {y} {z}\n");
    }
    for quad in [
        [1, 3, 4, 2],
        [5, 6, 8, 7],
        [1, 2, 6, 5],
        [3, 7, 8, 4],
        [1, 5, 7, 3],
        [2, 4, 8, 6],
    ] {
        text += &format!("f {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
    }
    text
}

/// A closed hat, in which roots lie, isn't pushed through by what grows under it: after a nod that hangs out below as it does without a hat.
#[test]
fn hair_under_a_hat_stays_there() {
    let style = "(version: 1, zones: [(name: \"cap\", roots: whorl, tips: hairline(-180, 180), count: 16, hang: 0.3), \
                 (name: \"tail\", form: tail, roots: [(180, 30)], hang: 1.5, count: 6)])";
    let nod = "moves: [(move: nod, start: 0.2, length: 1, angle: 20)]";
    let bare = Given::new(style, &format!("(version: 1, {nod})"), "");
    let bare = bare.scene().unwrap();
    let script =
        format!("(version: 1, {nod}, bodies: [(on: head, shape: mesh, file: \"hat.obj\")])");
    let given = Given::new(style, &script, "");
    let (center, height_m) = (bare.head().center, bare.head().height_m);
    let half = [0.6, 0.25, 0.6].map(|side| side * height_m);
    let middle = center + Vec3::Y * (0.4 * height_m);
    fs::write(
        given.folder.path().join("hat.obj"),
        cube(half, middle.to_array()),
    )
    .unwrap();
    let hat = given.scene().unwrap();
    let [mut with, mut without] = [Motion::new(), Motion::new()];
    let (mut swing, mut at_rest) = (0.0_f32, 0.0_f32);
    let mut last = points(&bare, &mut without, 0.0);
    for frame in 0..=96 {
        let time = frame as f32 / 24.0;
        let with = points(&hat, &mut with, time);
        let now = points(&bare, &mut without, time);
        let farthest = |from: &[Vec3]| {
            let apart = now.iter().zip(from).map(|(a, b)| a.distance(*b));
            apart.fold(0.0, f32::max)
        };
        // In a frame, head and all.
        swing = swing.max(farthest(&last));
        at_rest = farthest(&with);
        last = now;
    }
    println!(
        "hair that goes by up to {swing:.3} m a frame without a hat comes to rest under one within {at_rest:.4} m of where it does without"
    );
    assert!(swing > 0.01, "{swing}");
    // Where it leaves the hat it keeps a little from it.
    assert!(at_rest < 0.01, "{at_rest}");
}

#[test]
fn meshes_move_and_change_their_form() {
    let scene = Given::new(TAIL, "(version: 1)", "").scene().unwrap();
    let styled = points(&scene, &mut Motion::new(), 0.0);
    let middle = styled.iter().sum::<Vec3>() / styled.len() as f32;
    // A wall behind the tail that grows towards it, by files.
    let (thin, thick) = (0.01, 0.12);
    let behind = middle - Vec3::Z * 0.12;
    let given = Given::new(
        TAIL,
        "(version: 1, bodies: [(shape: mesh, file: \"wall.####.obj\", rate: 4)])",
        "",
    );
    let wall = |half: f32| cube([0.15, 0.15, half], behind.to_array());
    let write = |name: &str, text: &str| fs::write(given.folder.path().join(name), text).unwrap();
    for (number, half) in [(1, thin), (2, 0.05), (3, 0.09), (4, thick)] {
        write(&format!("wall.{number:04}.obj"), &wall(half));
    }
    assert_eq!(given.checked(), "");
    let scene = given.scene().unwrap();
    let mut motion = Motion::new();
    let rest = points(&scene, &mut motion, 0.0);
    assert_eq!(rest, styled);
    let mut last = rest.clone();
    for frame in 1..48 {
        last = points(&scene, &mut motion, frame as f32 / 24.0);
    }
    let front = behind.z + thick;
    let is_beside = |point: &&Vec3| {
        let way = **point - behind;
        way.x.abs() < 0.13 && way.y.abs() < 0.13
    };
    let deepest = last.iter().filter(is_beside).map(|point| front - point.z);
    let deepest = deepest.fold(0.0, f32::max);
    let before = rest.iter().filter(is_beside).map(|point| front - point.z);
    let before = before.fold(0.0, f32::max);
    println!(
        "a wall that grows by {:.2} m: {deepest:.4} m in it, {before:.4} m before it grew",
        thick - thin
    );
    assert!(before > 0.02 && deepest < 2e-3, "{before} {deepest}");
    // A later form that lacks a side is noted.
    let side = |text: &str| text.trim_end().rsplit_once('\n').unwrap().0.to_owned();
    assert_eq!(
        given
            .scene()
            .unwrap()
            .notes()
            .join("\n")
            .matches("open")
            .count(),
        0
    );
    write("wall.0003.obj", &side(&wall(0.09)));
    let notes = given.scene().unwrap().notes().join("\n");
    assert!(
        notes.contains("bodies: the mesh of `wall.####.obj` is open in its form 3, and hair"),
        "{notes}"
    );
    // One that is none is told by its file.
    write("wall.0003.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let message = given.scene().err().unwrap();
    assert!(
        message.contains("wall.0003.obj: no triangle with an area was found"),
        "{message}"
    );
    // A mesh stands where its file has it, turned about its middle and as large as is said.
    let turned = Given::new(
        TAIL,
        "(version: 1)",
        "bodies: [(shape: mesh, file: \"wall.0004.obj\", at: (0, 0, 0.1), size: 0.5, turn: (90, 0, 0), on: shoulders)],",
    );
    fs::write(turned.folder.path().join("wall.0004.obj"), wall(thick)).unwrap();
    assert_eq!(turned.checked(), "");
    let notes = turned.scene().unwrap().notes().join("\n");
    assert!(!notes.contains("open"), "{notes}");
    // Without a side nothing is within it, which is noted.
    fs::write(
        turned.folder.path().join("wall.0004.obj"),
        side(&wall(thick)),
    )
    .unwrap();
    let notes = turned.scene().unwrap().notes().join("\n");
    assert!(
        notes.contains("bodies: the mesh of `wall.0004.obj` is open, and hair"),
        "{notes}"
    );
}

#[test]
fn files_that_are_missing_between_others_are_told() {
    let numbered = "[(file: \"wall.####.obj\")], bodies: [(shape: mesh, file: \"wall.####.obj\")]";
    let given = Given::new(TAIL, "(version: 1)", &format!("meshes: {numbered},"));
    let path = |number: u32| given.folder.path().join(format!("wall.{number:04}.obj"));
    for number in 1..=4 {
        fs::write(path(number), cube([0.1; 3], [0.0, 0.0, 3.0])).unwrap();
    }
    let missing = || {
        let notes = given.scene().unwrap().notes().to_vec();
        let missing = notes.into_iter().filter(|note| note.contains("missing"));
        missing.collect::<Vec<_>>()
    };
    assert_eq!(missing(), [""; 0]);
    fs::remove_file(path(3)).unwrap();
    let said = "files are missing between `wall.0002.obj` and `wall.0004.obj`, and all that come after them come earlier";
    let mut expected = ["bodies", "meshes"].map(|section| format!("{section}: {said}"));
    expected.sort();
    let mut found = missing();
    found.sort();
    assert_eq!(found, expected);
}

/// Writes a glTF file of an octahedron, m, with its numbers beside it, where a byte more lies, and a picture.
fn octahedron(folder: &Path, name: &str, radius: f32) {
    let side = |axis: usize, bit: usize| {
        let sign = if bit >> axis & 1 == 1 {
            -radius
        } else {
            radius
        };
        Vec3::AXES[axis] * sign
    };
    let faces = (0..8).flat_map(|bit: usize| {
        let [x, y, z] = [0, 1, 2].map(|axis| side(axis, bit));
        // Counter-clockwise seen from outside.
        match bit.count_ones() % 2 {
            0 => [x, y, z],
            _ => [x, z, y],
        }
    });
    let numbers = faces.flat_map(|corner| corner.to_array());
    let mut bytes: Vec<u8> = numbers.flat_map(f32::to_le_bytes).collect();
    bytes.push(0);
    fs::write(folder.join(format!("{name}.bin")), &bytes).unwrap();
    fs::write(folder.join(format!("{name}.png")), "a picture").unwrap();
    let text = format!(
        r#"{{
            "asset": {{"version": "2.0"}},
            "nodes": [{{"mesh": 0}}],
            "buffers": [{{"byteLength": 289, "uri": "{name}.bin"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 288}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 24, "type": "VEC3"}}],
            "images": [{{"uri": "{name}.png"}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}]
        }}"#
    );
    fs::write(folder.join(format!("{name}.gltf")), text).unwrap();
}

#[test]
fn a_bake_knows_the_numbers_beside_bodies_and_heads() {
    let body =
        |file: &str| format!("bodies: [(shape: mesh, file: \"{file}.gltf\", at: (0, 9, 0))]");
    let script = format!("(version: 1, {})", body("own"));
    let given = Given::new(TAIL, &script, &format!("{},", body("preset")));
    let path = |name: &str| given.folder.path().join(name);
    for (name, radius) in [("own", 0.1), ("preset", 0.1), ("head", 0.12)] {
        octahedron(given.folder.path(), name, radius);
    }
    let registry = registry();
    let preset = Preset::parse("look.ron", &given.preset, &registry).unwrap();
    let files = Files {
        head: Some(path("head.gltf")),
        ..given.files()
    };
    let mut stage = Stage::new(&preset, &files).unwrap();
    let mut bake = Bake::new(&preset, &files, &stage.scene).unwrap();
    stage.advance_to(0.0).unwrap();
    stage.record(0.0, &mut bake);
    fs::write(path("bake.strands.ron"), stage.bake_text(bake).unwrap()).unwrap();

    let files = Files {
        bake: Some(path("bake.strands.ron")),
        ..files
    };
    let with = |name: &str| {
        let before = fs::read(path(name)).unwrap();
        let mut bytes = before.clone();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(path(name), bytes).unwrap();
        let refused = Stage::new(&preset, &files).err();
        fs::write(path(name), before).unwrap();
        refused.map(|error| error.to_string())
    };
    for (name, said) in [
        ("head.bin", "head.buffers (head.bin) has changed since"),
        (
            "preset.bin",
            "bodies.buffers (preset.bin, own.bin) has changed since",
        ),
        (
            "own.bin",
            "bodies.buffers (preset.bin, own.bin) has changed since",
        ),
    ] {
        let refused = with(name).unwrap_or_default();
        assert!(refused.contains(&format!(": {said};")), "{name}: {refused}");
    }
    for picture in ["head.png", "preset.png", "own.png"] {
        assert_eq!(with(picture), None, "{picture}");
    }
}
