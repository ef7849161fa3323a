//! What a scene says of its files: guides, hair that doesn't fit, formats, and files that cannot be read.
#![expect(clippy::print_stderr, reason = "skipped tests say so")]

use effects::Registry;
use stage::{Files, Preset, Stage};
use std::fs;
use std::path::Path;

/// A scene of this hair on the bust.
fn scene(section: &str, hair: &Path) -> Result<Stage, String> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = format!(
        "(version: 1, hair: ({section}), head: (shape: bust), layers: [(effect: \"hair.base\")])"
    );
    let preset = Preset::parse("look.ron", &text, &registry).unwrap();
    let files = Files {
        hair: Some(hair.to_owned()),
        ..Files::default()
    };
    Stage::new(&preset, &files).map_err(|error| error.to_string())
}

fn notes(section: &str, hair: &Path) -> Vec<String> {
    scene(section, hair).unwrap().notes().to_vec()
}

/// Strands on top of the bust, in units of `unit` metres.
fn strands(unit: f32) -> String {
    let strand = |i: i32| {
        let (x, y, z) = (0.01 * i as f32 / unit, 1.7 / unit, 0.0);
        let tip = y - 0.3 / unit;
        format!("(points: [({x}, {y}, {z}), ({x}, {tip}, {z})])")
    };
    let all: Vec<String> = (-8..8).map(strand).collect();
    format!("(version: 1, strands: [{}])", all.join(", "))
}

#[test]
fn a_note_says_how_many_strands_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.strands.ron");
    fs::write(&path, strands(1.0)).unwrap();
    let expected = "hair: 5 of the 16 strands are drawn, as guides (hair.guides, --guides)";
    assert_eq!(notes("guides: 5", &path)[1], expected);
    for section in ["", "guides: 16", "guides: 99"] {
        assert_eq!(notes(section, &path).len(), 1, "{section}");
    }
}

#[test]
fn motion_of_one_time_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.strands.ron");
    let strand = "[(0, 1.7, 0), (0, 1.4, 0)]";
    let told = |times: &[f32], section: &str| {
        let sample = |time: &f32| format!("(time: {time}, strands: [{strand}])");
        let samples: Vec<String> = times.iter().map(sample).collect();
        let text = format!(
            "(version: 1, strands: [(points: {strand})], motion: [{}])",
            samples.join(", ")
        );
        fs::write(&path, text).unwrap();
        notes(section, &path)
            .join("\n")
            .contains("has one time, 0.5 s, so that it stands still")
    };
    assert!(told(&[0.5], ""));
    assert!(!told(&[], ""));
    assert!(!told(&[0.5, 1.0], ""));
    // A bake of one frame is one of that frame.
    let bake = format!("bake: {:?}", path.display().to_string());
    assert!(!told(&[0.5], &bake));
}

#[test]
fn hair_that_does_not_fit_its_head_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.strands.ron");
    for (unit, fits) in [(1.0, true), (0.01, false), (100.0, false)] {
        fs::write(&path, strands(unit)).unwrap();
        let notes = notes("", &path);
        let warning = notes.iter().find(|note| note.contains("WARNING"));
        assert_eq!(warning.is_none(), fits, "{notes:?}");
        assert!(warning.is_none_or(|warning| warning.contains("hair.scale")));
    }
    // Who says the unit means it.
    fs::write(&path, strands(0.01)).unwrap();
    assert_eq!(notes("scale: 1", &path).len(), 1);
}

#[test]
fn strands_without_a_length_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.strands.ron");
    let point = "(points: [(0, 1.7, 0.05), (0, 1.7, 0.05), (0, 1.7, 0.05)])";
    let mut text = strands(1.0);
    let end = text.rfind("])").unwrap();
    text.insert_str(end, &format!(", {point}, {point}"));
    fs::write(&path, text).unwrap();
    let notes = notes("", &path);
    let warning = "hair: WARNING: 2 of 18 strands have no length, all points in one place: nothing is drawn of them";
    assert!(notes.iter().any(|note| note == warning), "{notes:?}");
}

#[test]
fn the_mohawk_is_told_to_be_small() {
    let Some(data) = std::env::var_os("INKSTRAND_DATA") else {
        return eprintln!("SKIPPED 1 test: INKSTRAND_DATA is not set");
    };
    let data = Path::new(&data);
    let notes_of = |name: &str| notes("", &data.join(name));
    let told = notes_of("ratboy/Ratboy_mohawk.tfx");
    assert!(told.iter().any(|note| note.contains("WARNING")), "{told:?}");
    let told = notes_of("sintel/sintel_lite_hair.tfx");
    assert!(
        told.iter().all(|note| !note.contains("WARNING")),
        "{told:?}"
    );
}

#[test]
fn styles_are_among_the_formats_that_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.abc");
    fs::write(&path, "Ogawa").unwrap();
    let message = scene("", &path).err().unwrap();
    assert!(message.ends_with("hair styles (.style.ron)"), "{message}");
}

#[test]
fn styles_that_are_no_text_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.style.ron");
    fs::write(&path, b"(version: 1,\n \xff)").unwrap();
    let message = scene("", &path).err().unwrap();
    assert!(message.contains("a.style.ron:2:2: this is not UTF-8"));
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    let message = scene("", &path).err().unwrap();
    assert!(message.ends_with("this is a folder"), "{message}");
}
