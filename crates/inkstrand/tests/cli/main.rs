//! The program as its user has it: files in, pictures and messages out.

#![allow(clippy::print_stdout, reason = "what is skipped is said")]

mod wrong;

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const STRANDS: &str = "(version: 1, strands: [
    (size: 30.0, mirror: true, points: [(0.03, 0.1, 0.0), (0.1, 0.1, 0.02), (0.13, -0.1, 0.03)]),
    (size: 25.0, points: [(0.0, 0.1, 0.0), (0.0, 0.12, 0.06), (0.02, 0.0, 0.1)]),
], motion: [
    (time: 0.0, strands: [[(0.03, 0.1, 0.0), (0.1, 0.1, 0.02), (0.13, -0.1, 0.03)], [(0.0, 0.1, 0.0), (0.0, 0.12, 0.06), (0.02, 0.0, 0.1)]]),
    (time: 1.0, strands: [[(0.03, 0.1, 0.0), (0.1, 0.15, 0.02), (0.2, 0.1, 0.03)], [(0.0, 0.1, 0.0), (0.0, 0.12, 0.06), (0.06, 0.05, 0.1)]]),
])";

const PRESET: &str = "(
    version: 1,
    hair: (file: \"small.strands.ron\"),
    scene: (size: (80, 60), samples: 4),
    layers: [
        (effect: \"hair.silhouette\"),
        (effect: \"hair.base\"),
    ],
)";

/// A folder with a small preset of its own.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.strands.ron"), STRANDS).unwrap();
    fs::write(folder.path().join("small.ron"), PRESET).unwrap();
    folder
}

fn inkstrand(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    command.current_dir(folder).args(arguments);
    command
}

/// Width, height and RGB or RGBA bytes of a PNG file.
fn pixels(path: &Path) -> (u32, u32, Vec<u8>) {
    let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    bytes.truncate(info.buffer_size());
    (info.width, info.height, bytes)
}

fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn files_of_other_kinds_are_no_presets_and_say_how_they_are_drawn() {
    let folder = folder();
    for (file, option) in [
        ("bob.style.ron", "--hair"),
        ("small.strands.ron", "--hair"),
        ("hair.tfx", "--hair"),
        ("turn.motion.ron", "--motion"),
        ("me.vrm", "--character"),
        ("bust.obj", "--head"),
    ] {
        inkstrand(folder.path(), &["render", file])
            .assert()
            .failure()
            .stderr(contains(format!("{option} {file}")).and(contains("no preset")));
    }
}

#[test]
fn a_preset_becomes_a_picture_named_after_it_in_the_current_folder() {
    let folder = folder();
    let here = tempfile::tempdir().unwrap();
    let preset = folder.path().join("small.ron");
    inkstrand(here.path(), &["render", preset.to_str().unwrap()])
        .assert()
        .success()
        .stdout("")
        .stderr(contains("wrote small.png"));
    let (width, height, bytes) = pixels(&here.path().join("small.png"));
    assert_eq!((width, height), (80, 60));
    assert_eq!(
        bytes.len(),
        80 * 60 * 3,
        "an opaque background needs no alpha"
    );
    let turquoise = bytes.chunks(3).filter(|p| *p == [0x3F, 0xC1, 0xC0]).count();
    assert!(turquoise > 100, "{turquoise} pixels of the base colour");
    assert_eq!(files(here.path()), ["small.png"], "nothing else is left");
}

/// A character in glTF that is a body alone, a pyramid on a bone of this name.
#[cfg(feature = "gltf")]
fn write_body(folder: &Path, bone: &str) {
    let corners: [[f32; 3]; 4] = [
        [0.0, 0.2, 0.0],
        [-0.1, 0.0, 0.1],
        [0.1, 0.0, 0.1],
        [0.0, 0.0, -0.1],
    ];
    let triangles: [u16; 12] = [0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2];
    let mut bytes: Vec<u8> = corners
        .iter()
        .flatten()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    bytes.extend(triangles.iter().flat_map(|i| i.to_le_bytes()));
    fs::write(folder.join("body.bin"), &bytes).unwrap();
    let text = r#"{"asset": {"version": "2.0"}, "buffers": [{"uri": "body.bin", "byteLength": 72}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-0.1, 0, -0.1], "max": [0.1, 0.2, 0.1]},
                      {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
        "meshes": [{"name": "Body", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"name": "BONE", "mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0}"#;
    fs::write(folder.join("body.gltf"), text.replace("BONE", bone)).unwrap();
}

/// Shadows on her own hair are darker shades of it, unless the look's are asked for; on hair of the look they have the look's colour.
#[cfg(feature = "gltf")]
#[test]
fn shadows_on_a_characters_hair_are_hers() {
    let Some(data) = std::env::var_os("INKSTRAND_DATA") else {
        return println!("SKIPPED 1 test: INKSTRAND_DATA is not set");
    };
    let folder = tempfile::tempdir().unwrap();
    let preset = concat!(env!("CARGO_MANIFEST_DIR"), "/../../presets/windy-bob.ron");
    let character = Path::new(&data).join("vrm/Godette_vrm_v4.vrm");
    let drawn = |more: &[&str]| {
        let character = character.to_str().unwrap();
        let start = [
            "render",
            preset,
            "--character",
            character,
            "--size",
            "160x160",
        ];
        let end = ["--backend", "cpu", "--quiet", "-o", "her.png"];
        let arguments = [&start[..], more, &end].concat();
        inkstrand(folder.path(), &arguments).assert().success();
        pixels(&folder.path().join("her.png"))
    };
    let colors =
        |color: &str| ["hair.cel", "hair.cast"].map(|layer| format!("{layer}.color={color}"));
    let with = |color: &str| {
        let [cel, cast] = colors(color);
        drawn(&["--set", &cel, "--set", &cast])
    };
    let own = drawn(&[]);
    assert!(own == with("none"));
    let looks = drawn(&["--set", "hair.shadows=look"]);
    assert!(own != looks);
    // Of her hair no colour of the look's is asked, so another makes no difference.
    assert!(own == with("FF0000"));
    let look = [
        "--hair",
        concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../presets/styles/windy-bob.style.ron"
        ),
    ];
    let [cel, cast] = colors("8B74C9");
    assert!(drawn(&look) == drawn(&[&look[..], &["--set", &cel, "--set", &cast]].concat()));
}

#[cfg(feature = "gltf")]
#[test]
fn a_character_without_hair_and_head_is_told() {
    let folder = folder();
    let render = |character: &str, quiet: bool| {
        let mut arguments = vec!["render", "small.ron", "--character", character];
        arguments.extend(quiet.then_some("--quiet"));
        inkstrand(folder.path(), &arguments).assert().success()
    };
    write_body(folder.path(), "spine");
    render("body.gltf", false).stderr(
        contains("head: WARNING: body.gltf has neither hair nor a bone called `head`")
            .and(contains("--set 'head.hide="))
            .and(contains("the preset's file is drawn")),
    );
    render("body.gltf", true).stderr("");
    write_body(folder.path(), "mixamorig:Head");
    render("body.gltf", false).stderr(contains("WARNING").not());
    let Some(data) = std::env::var_os("INKSTRAND_DATA") else {
        return println!("SKIPPED characters that are there: INKSTRAND_DATA is not set");
    };
    for (file, has_none) in [
        ("threevrm_springbone_sphere-collider.gltf", true),
        ("threevrm_springbone_plane-collider.gltf", true),
        ("threevrm_springbone_inside-collider.gltf", true),
        ("vrm1_springbone_fixture.vrm", true),
        ("Godette_vrm_v4.vrm", false),
    ] {
        let path = Path::new(&data).join("vrm").join(file);
        let told = render(path.to_str().unwrap(), false);
        let stderr = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
        let is_told = stderr.contains("has neither hair nor a bone called `head`");
        assert_eq!(is_told, has_none, "{file}: {stderr}");
    }
}

#[test]
fn options_take_the_place_of_the_presets() {
    let folder = folder();
    let options = [
        "render",
        "small.ron",
        "-o",
        "out.png",
        "--size",
        "40x30",
        "--samples",
        "1",
        "--camera",
        "-30,10,5",
        "--light",
        "0,-90",
        "--background",
        "none",
        "--set",
        "hair.silhouette.color=FF0000",
        "--set",
        "clump.size=1.5",
        "--only",
        "hair.silhouette",
        "--guides",
        "2",
        "--threads",
        "1",
        "--quiet",
        "--backend",
        "cpu",
    ];
    inkstrand(folder.path(), &options)
        .assert()
        .success()
        .stdout("")
        .stderr("");
    let (width, height, bytes) = pixels(&folder.path().join("out.png"));
    assert_eq!((width, height), (40, 30));
    assert_eq!(bytes.len(), 40 * 30 * 4);
    for pixel in bytes.chunks(4) {
        assert!(
            pixel == [255, 0, 0, 255] || pixel[3] == 0,
            "{pixel:?}: red or nothing"
        );
    }
    assert!(bytes.chunks(4).any(|p| p[3] == 255));
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let folder = folder();
    let mut pictures = Vec::new();
    for threads in ["1", "2", "8"] {
        inkstrand(
            folder.path(),
            &["render", "small.ron", "--threads", threads, "-o", "t.png"],
        )
        .assert()
        .success();
        pictures.push(fs::read(folder.path().join("t.png")).unwrap());
    }
    assert!(pictures.iter().all(|picture| *picture == pictures[0]));
}

#[test]
fn sequences_have_numbers_and_move() {
    let folder = folder();
    let options = [
        "render",
        "small.ron",
        "--frames",
        "9-11",
        "--stats",
        "stats.jsonl",
        "-o",
        "a_##.png",
    ];
    inkstrand(folder.path(), &options).assert().success();
    let names = ["a_09.png", "a_10.png", "a_11.png"];
    let frames = names.map(|name| fs::read(folder.path().join(name)).unwrap());
    assert!(frames[0] != frames[1] && frames[1] != frames[2]);

    // A frame of a sequence is the picture at its time, and the picture at a time has its number.
    inkstrand(
        folder.path(),
        &[
            "render",
            "small.ron",
            "--time",
            "0.375",
            "-o",
            "one_###.png",
        ],
    )
    .assert()
    .success();
    assert!(
        fs::read(folder.path().join("one_009.png")).unwrap() == frames[0],
        "9 / 24 s"
    );

    let stats = fs::read_to_string(folder.path().join("stats.jsonl")).unwrap();
    let lines: Vec<serde_json::Value> = stats
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[1]["frame"], 10);
    assert_eq!(lines[1]["backend"], "cpu");
    assert_eq!(lines[1]["size"], serde_json::json!([80, 60]));
    assert_eq!(lines[1]["samples"], 4);
    assert_eq!(lines[1]["strands"]["total"], 3);
    assert_eq!(lines[1]["layers"]["hair.base"]["joints"], 3 * 3 * 9);
    assert_eq!(lines[1]["layers"]["hair.base"]["segments"], 3 * 3 * 8);
    assert_eq!(lines[1]["reused"], false);
    for stage in ["simulate", "paths", "effects", "raster", "total"] {
        assert!(
            lines[1]["milliseconds"][stage].as_f64().unwrap() >= 0.0,
            "{stage}"
        );
    }
    assert!(lines[1]["bytes"]["buffers"].as_u64().unwrap() > 0);
}

#[test]
fn what_does_not_change_is_drawn_once() {
    let folder = folder();
    // Beyond its last key hair stands still: the second from then on is the one before once more.
    let options = ["render", "small.ron", "--frames", "23-27", "-o", "a_##.png"];
    let options = [&options[..], &["--stats", "stats.jsonl"]].concat();
    inkstrand(folder.path(), &options).assert().success();
    let stats = fs::read_to_string(folder.path().join("stats.jsonl")).unwrap();
    let lines = stats.lines();
    let lines: Vec<serde_json::Value> = lines
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let reused: Vec<_> = lines.iter().map(|line| &line["reused"]).collect();
    assert_eq!(reused, [false, false, true, true, true]);
    for line in &lines {
        let is_drawn = line["layers"]["hair.base"]["joints"].as_u64().is_some();
        assert_eq!(is_drawn, line["reused"] == false);
        assert_eq!(line["size"], serde_json::json!([80, 60]));
        assert_eq!(line["backend"], "cpu");
    }
    let frame = |number: u32| fs::read(folder.path().join(format!("a_{number}.png"))).unwrap();
    assert!(frame(23) != frame(24));
    assert!((25..28).all(|number| frame(number) == frame(24)));
    // As it is drawn for itself.
    inkstrand(
        folder.path(),
        &["render", "small.ron", "--frames", "27-27", "-o", "b_##.png"],
    )
    .assert()
    .success();
    let alone = fs::read(folder.path().join("b_27.png")).unwrap();
    assert!(alone == frame(27));
}

/// The folder of real hair, where there is one.
fn real_data() -> Option<PathBuf> {
    let folder = std::env::var_os("INKSTRAND_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("SKIPPED 1 test of real hair: INKSTRAND_DATA is not set");
    }
    folder
}

#[test]
fn real_hair_on_its_head() {
    let Some(data) = real_data() else { return };
    let folder = tempfile::tempdir().unwrap();
    let preset = concat!(env!("CARGO_MANIFEST_DIR"), "/../../presets/outlined.ron");
    let hair = data.join("sintel/sintel_hair_16points.tfx");
    let head = data.join("sintel/sintel.obj");
    let (hair, head) = (hair.to_str().unwrap(), head.to_str().unwrap());
    let options = [
        "render",
        preset,
        "--hair",
        hair,
        "--head",
        head,
        "--guides",
        "150",
        "--size",
        "240x180",
        "--samples",
        "4",
        "-o",
        "sintel.png",
    ];
    inkstrand(folder.path(), &options)
        .assert()
        .success()
        .stderr(contains("11,400 strands, guessed Y up, metres"));
    let (_, _, bytes) = pixels(&folder.path().join("sintel.png"));
    // The base colour is above the chin line, skin below and between: right way up.
    let rows = |color: [u8; 3]| {
        let hits = bytes
            .chunks(3)
            .enumerate()
            .filter(move |(_, p)| *p == color);
        let rows: Vec<usize> = hits.map(|(i, _)| i / 240).collect();
        (
            rows.len(),
            rows.iter().sum::<usize>() as f64 / rows.len() as f64,
        )
    };
    let (hair_pixels, hair_row) = rows([0xC9, 0x80, 0x4B]);
    let (skin_pixels, skin_row) = rows([0xF8, 0xDC, 0xC8]);
    assert!(
        hair_pixels > 1500 && skin_pixels > 2000,
        "{hair_pixels} {skin_pixels}"
    );
    assert!(
        hair_row < skin_row,
        "hair at row {hair_row}, skin at {skin_row}"
    );

    // Whole and cut in half.
    let bytes = fs::read(hair).unwrap();
    fs::write(folder.path().join("half.tfx"), &bytes[..bytes.len() / 2]).unwrap();
    inkstrand(folder.path(), &["render", preset, "--hair", "half.tfx"])
        .assert()
        .code(1)
        .stderr(contains("half.tfx"));
}

#[test]
#[cfg(target_os = "linux")]
fn threads_are_those_that_were_asked_for() {
    let folder = folder();
    let most_threads = |threads: &str| {
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_inkstrand"))
            .current_dir(folder.path())
            .args([
                "render",
                "small.ron",
                "--frames",
                "0-40",
                "--quiet",
                "--threads",
                threads,
            ])
            .spawn()
            .unwrap();
        let tasks = format!("/proc/{}/task", program.id());
        let mut most = 0;
        while program.try_wait().unwrap().is_none() {
            most = fs::read_dir(&tasks).map_or(most, |tasks| most.max(tasks.count()));
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        assert!(program.wait().unwrap().success());
        most
    };
    // Beside those that draw there are the first, which waits, and one that listens for interrupts, but where these are to be ignored.
    let with_one = most_threads("1");
    assert!([2, 3].contains(&with_one), "{with_one}");
    assert_eq!(most_threads("3"), with_one + 2);
}
