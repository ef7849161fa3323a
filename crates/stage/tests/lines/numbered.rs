//! Lines of meshes of numbered files.

use super::*;

/// Numbered files of a ball that gets other triangles, becomes a box, and is a ball again.
fn numbered() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let forms = [
        ball(24, 48),
        ball(12, 24),
        cube(),
        ball(24, 48),
        ball(24, 48),
    ];
    for (number, form) in (7..).zip(forms) {
        fs::write(folder.path().join(format!("form.{number:04}.obj")), form).unwrap();
    }
    folder
}

fn of_folder(meshes: &str, lines: &str, layers: &str, folder: &TempDir) -> Result<Stage, String> {
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    things_of(meshes, lines, layers, &files)
}

#[test]
fn numbered_files_have_lines_whatever_their_triangles() {
    let folder = numbered();
    let lines = "(name: \"rim\", of: \"form\", kind: \"contour, crease, border\")";
    let numbered = "(file: \"form.####.obj\", rate: 24)";
    let at = |stage: &mut Stage, frame: u32| {
        stage.advance_to(frame as f32 / 24.0).unwrap();
        drawn(&stage.frame().unwrap()).pixels
    };
    for layer in [
        CHALK,
        INK,
        "(effect: \"line.ink\", on: \"rim\", params: (wobble: 1))",
    ] {
        let make = || of_folder(numbered, lines, layer, &folder).unwrap();
        let mut stage = make();
        let sequence: Vec<_> = (0..6).map(|frame| at(&mut stage, frame)).collect();
        for (frame, pixels) in sequence.iter().enumerate() {
            let ink: f32 = pixels.iter().map(|[red, ..]| 1.0 - red).sum();
            // The box lies elsewhere, off the picture.
            assert!(ink > 100.0 || frame == 2, "{layer} {frame}: {ink}");
        }
        assert!(at(&mut make(), 3) == sequence[3], "{layer}: alone");
        assert!(at(&mut stage, 1) == sequence[1], "{layer}: back");
        assert!(sequence[5] == sequence[4], "{layer}: the last one stays");
        assert!(sequence[0] != sequence[1], "{layer}");
    }
    // As plain files have them.
    let mut one = of_folder(numbered, lines, INK, &folder).unwrap();
    at(&mut one, 1);
    let of_plain = lines.replace("form", "form.0007");
    let mut plain = of_folder("(file: \"form.0007.obj\")", &of_plain, INK, &folder).unwrap();
    assert!(at(&mut one, 0) == at(&mut plain, 0));
}

#[test]
fn numbered_files_of_the_same_triangles_are_mixed_between() {
    let folder = tempfile::tempdir().unwrap();
    let square = |x: f32| {
        format!(
            "v {x} 0 0\nv {} 0 0\nv {} 1 0\nv {x} 1 0\nf 1 2 3 4\n",
            x + 1.0,
            x + 1.0
        )
    };
    for (name, x) in [("a1.obj", 0.0), ("a2.obj", 0.4)] {
        fs::write(folder.path().join(name), square(x)).unwrap();
    }
    let lines = "(name: \"rim\", kind: \"border\")";
    // Where lines begin and end, metres, after so many seconds.
    let extent = |repeat: bool, seconds: f32| {
        let meshes = format!("(file: \"a#.obj\", rate: 1, repeat: {repeat})");
        let mut stage = of_folder(&meshes, lines, INK, &folder).unwrap();
        stage.advance_to(seconds).unwrap();
        let frame = stage.frame().unwrap();
        let xs = frame.paths.position.iter().map(|place| place.x);
        [f32::min, f32::max].map(|of| xs.clone().reduce(of).unwrap())
    };
    for (repeat, seconds, expected) in [
        (false, 0.0, [0.0, 1.0]),
        (false, 0.5, [0.2, 1.2]),
        (false, 9.0, [0.4, 1.4]),
        (true, 1.5, [0.2, 1.2]),
        (true, 2.0, [0.0, 1.0]),
    ] {
        let found = extent(repeat, seconds);
        let is_near = |i: usize| (found[i] - expected[i]).abs() < 0.02;
        assert!(is_near(0) && is_near(1), "{repeat} {seconds}: {found:?}");
    }
}

#[test]
fn mistakes_of_numbered_files_are_told_at_their_place() {
    let folder = numbered();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let one = "g a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let two = "g b\nv 2 0 0\nv 3 0 0\nv 2 1 0\nf 4 5 6\n";
    write("two.1.obj", one);
    write("two.2.obj", &format!("{one}{two}"));
    write("bad.1.obj", one);
    write("bad.2.obj", "v 0 0 0\nf 1 2 9\n");
    for (file, expected) in [
        (
            "none.##.obj",
            "there is no file of this name with a number in place of `#`",
        ),
        ("two.#.obj", "file 2 has 2 meshes, and the first one has 1"),
        ("bad.#.obj", "bad.2.obj"),
    ] {
        let meshes = format!("(file: \"{file}\")");
        let told = of_folder(&meshes, "(name: \"rim\")", INK, &folder);
        let told = told.err().expect("a mistake");
        assert!(told.contains(expected), "{file}: {told}");
        assert!(told.starts_with("look.ron:1:"), "{file}: {told}");
    }
}
