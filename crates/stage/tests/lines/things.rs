//! Lines of things alone, without a file, hair or a head; and of files that hardly have any.

use super::*;

#[test]
fn things_need_neither_file_nor_hair_nor_head() {
    let lines = "(name: \"rim\", of: \"*\", kind: \"contour, crease, border\")";
    for shape in ["cup", "cube", "gear", "wings"] {
        let mesh = format!("(shape: {shape}, color: \"FFFFFF\", shade: 1)");
        let mut stage = things(&mesh, lines, INK).unwrap();
        assert_eq!(stage.strand_count(), 0);
        stage.advance_to(0.5).unwrap();
        let frame = stage.frame().unwrap();
        assert!(strands(&frame).len() > 2, "{shape}");
        let ink = ink(&drawn(&frame));
        assert!(ink > 100.0 && ink < 12_000.0, "{shape}: {ink}");
    }
    let error =
        |meshes: &str, layers: &str| things(meshes, lines, layers).err().unwrap_or_default();
    let checks = [
        (
            "(color: \"FFFFFF\")",
            INK,
            "look.ron:1:44: a mesh needs `file:",
        ),
        ("(file: \"a.obj\", shape: cup)", INK, "not of both"),
        (
            "(shape: cup, texture: \"a.png\")",
            INK,
            "no places for a picture",
        ),
        ("(shape: cupp)", INK, "cup"),
        ("(shape: cup)", "(effect: \"hair.base\")", "names no hair"),
        (
            "(shape: cup)",
            "(effect: \"mesh.flat\", on: \"skin\")",
            "skin",
        ),
    ];
    for (meshes, layers, expected) in checks {
        let message = error(meshes, layers);
        assert!(message.contains(expected), "{message}\n  lacks {expected}");
    }
    assert!(error("(shape: cup, name: \"mine\")", INK).is_empty());
}

/// What effects and lamps are told of things is of their middle, about which they turn, and not of a neck.
#[test]
fn things_that_spin_stay_where_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("spin.motion.ron");
    let text = "(version: 1, moves: [(move: spin, length: 1, angle: 90), (move: lean, length: 1, angle: 40)])";
    fs::write(&script, text).unwrap();
    let files = Files {
        motion: Some(script),
        ..Files::default()
    };
    let mut stage = things_of("(shape: cup, at: (0.3, 0.2, 0))", "", "", &files).unwrap();
    let at_rest = stage.head();
    for time in [0.5, 1.0, 2.0] {
        stage.advance_to(time).unwrap();
        let head = stage.frame().unwrap().objects[0].head;
        let off = head.center.distance(at_rest.center);
        assert!(off < 1e-6 * at_rest.height_m, "{time}: {off}");
    }
}

#[test]
fn straight_edges_taper() {
    let lines = "(name: \"rim\", kind: \"crease\")";
    let ink_of = |taper: f32| {
        let layer = format!(
            "(effect: \"line.ink\", on: \"rim\", params: (width: 6, taper: {taper}, wobble: 0, light_width: 1, color: \"000000\"))"
        );
        let mut stage =
            things("(shape: cube, color: \"FFFFFF\", shade: 1)", lines, &layer).unwrap();
        ink(&drawn(&stage.frame().unwrap()))
    };
    let (blunt, pointed) = (ink_of(0.0), ink_of(300.0));
    // Half an ellipse at each end covers pi/4 of what it tapers.
    let share = pointed / blunt;
    assert!((share - 0.785).abs() < 0.06, "{share}");
}

#[test]
fn a_halo_is_as_wide_as_it_says() {
    // A small cube before a large one: its outline cuts the large one's top edge in two.
    let meshes = "(shape: cube, name: \"far\", color: \"FFFFFF\", shade: 1), \
                  (shape: cube, name: \"near\", size: 0.3, at: (0, 0.4, 0.8), color: \"FFFFFF\", shade: 1)";
    let ends = |halo: f32| -> f32 {
        let lines =
            format!("(name: \"rim\", of: \"far\", kind: \"crease\", halo: {halo}, shortest: 0)");
        let mut stage = things(meshes, &lines, INK).unwrap();
        let frame = stage.frame().unwrap();
        let unit_px = frame.objects[0].head.unit_m();
        let lengths = strands(&frame).into_iter().map(|joints| {
            let path = &frame.paths.center[joints.clone()];
            let px: f32 = path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            px / (frame.paths.px_per_metre[joints.start] * unit_px)
        });
        lengths.sum()
    };
    let (whole, cut) = (ends(0.0), ends(10.0));
    // Two ends are hidden by the near cube's top edge or its sides, and each is shorter by the halo.
    let gaps = (whole - cut) / 10.0;
    assert!(
        (gaps - gaps.round()).abs() < 0.1 && gaps.round() >= 2.0,
        "{gaps}"
    );
}

#[test]
fn eyes_in_things_and_beside_them_draw_what_there_is() {
    let lines = "(name: \"rim\", kind: \"contour, crease, border\", halo: 4)";
    for shape in ["cup", "cube", "gear", "wings"] {
        let layers = format!("{CHALK}, {}", INK.replace("on:", "name: \"ink\", on:"));
        let mut stage = things(&format!("(shape: {shape})"), lines, &layers).unwrap();
        let target = stage.head().center;
        // In the middle, within a wall, at a corner, beside it where the near plane cuts it.
        for distance_m in [1e-4, 0.06, 0.12, 0.1205, 0.15, 1e4] {
            let view = OrbitView {
                target,
                yaw_degrees: 45.0,
                pitch_degrees: 35.0,
                distance_m,
                vertical_fov_degrees: 30.0,
            };
            let camera = Camera::orbit(view, [120, 90], stage.near_m()).unwrap();
            let frame = stage.frame_seen_by(camera).unwrap();
            assert!(frame.marks.iter().all(|mark| mark.is_finite()));
            let picture = drawn(&frame);
            let is_color = |pixel: &[f32; 4]| pixel.iter().all(|channel| channel.is_finite());
            assert!(picture.pixels.iter().all(is_color), "{shape} {distance_m}");
        }
    }
}

#[test]
fn empty_and_flat_files_of_things_are_told_or_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("empty.obj", "v 0 0 0\n");
    write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
    write(
        "sheet.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 1\nf 1 2 3\nf 3 2 1\nf 1 2 4\n",
    );
    let registry = registry();
    for (file, is_drawn) in [
        ("empty.obj", false),
        ("point.obj", false),
        ("sheet.obj", true),
    ] {
        let text = format!(
            "(version: 1, head: (shape: none), meshes: [(file: \"{file}\")], scene: (size: (60, 40), samples: 1),\n \
             lines: [(name: \"rim\")], layers: [{CHALK}])"
        );
        let preset = Preset::parse("look.ron", &text, &registry).unwrap();
        let files = Files {
            preset_folder: folder.path().to_owned(),
            ..Files::default()
        };
        let stage = Stage::new(&preset, &files);
        match stage {
            Ok(mut stage) => drop(drawn(&stage.frame().unwrap())),
            Err(error) => assert!(!is_drawn, "{file}: {error}"),
        }
    }
}
