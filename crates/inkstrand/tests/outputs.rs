//! What is written where: nothing is lost, and what cannot be is said before the work.
#![expect(clippy::print_stdout, reason = "skipped tests say so")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const STRANDS: &str = "(version: 1, strands: [
    (size: 30.0, mirror: true, points: [(0.03, 0.1, 0.0), (0.1, 0.1, 0.02), (0.13, -0.1, 0.03)]),
])";
const PRESET: &str = "(
    version: 1,
    hair: (file: \"small.strands.ron\"),
    scene: (size: (40, 30), samples: 1),
    layers: [(effect: \"hair.base\")],
)";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.strands.ron"), STRANDS).unwrap();
    fs::write(folder.path().join("small.ron"), PRESET).unwrap();
    fs::write(
        folder.path().join("nod.motion.ron"),
        "(version: 1, moves: [(move: nod)])",
    )
    .unwrap();
    folder
}

fn inkstrand(folder: &TempDir, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    command.current_dir(folder.path()).args(arguments);
    command
}

/// Names and bytes of all files of a folder.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    let mut files: Vec<(String, Vec<u8>)> = entries
        .filter(|entry| entry.path().is_file())
        .map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, fs::read(entry.path()).unwrap())
        })
        .collect();
    files.sort();
    files
}

/// Runs the program with these streams, by a shell.
#[cfg(target_os = "linux")]
fn with_streams(folder: &TempDir, arguments: &str, streams: &str) -> Option<i32> {
    let program = env!("CARGO_BIN_EXE_inkstrand");
    let status = std::process::Command::new("sh")
        .current_dir(folder.path())
        .args(["-c", &format!("'{program}' {arguments} {streams}")])
        .status();
    status.unwrap().code()
}

#[test]
#[cfg(target_os = "linux")]
fn nobody_has_to_listen() {
    let folder = folder();
    let lines = [
        ("render small.ron", 0),
        ("render small.ron --frames 0-1", 0),
        ("render gone.ron", 1),
        ("render small.ron --size x", 2),
        ("check small.ron", 0),
        ("check gone.ron", 1),
        ("effects", 0),
        ("simulate small.ron -o a.strands.ron --frames 0-1", 0),
        ("completions bash", 0),
        ("--help", 0),
        ("", 2),
    ];
    for (arguments, code) in lines {
        for streams in [
            "2>&-",
            "2>/dev/full",
            ">/dev/null 2>/dev/full",
            "<&- >&- 2>&-",
        ] {
            let found = with_streams(&folder, arguments, streams);
            assert_eq!(found, Some(code), "{arguments} {streams}");
        }
    }
    for (number, streams) in ["2>&-", "2>/dev/full"].iter().enumerate() {
        let line = format!("new fresh{number}.ron");
        assert_eq!(with_streams(&folder, &line, streams), Some(0), "{streams}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn what_a_program_reads_must_arrive() {
    let folder = folder();
    for arguments in [
        "effects",
        "effects --json",
        "completions zsh",
        "--help",
        "--version",
        "render --help",
        "render small.ron --stats -",
    ] {
        let full = with_streams(&folder, arguments, ">/dev/full 2>/dev/null");
        assert_eq!(full, Some(1), "{arguments}");
        // Who has seen enough closes the pipe.
        let line = format!("{arguments} 2>&1");
        let closed = with_streams(&folder, &line, "| true");
        assert_eq!(closed, Some(0), "{arguments}");
    }
    inkstrand(&folder, &["effects"])
        .assert()
        .success()
        .stderr("");
}

#[test]
fn two_files_of_one_path_are_refused() {
    let folder = folder();
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("look.png"), "(version: 1)").unwrap();
    #[cfg(unix)]
    fs::hard_link(folder.path().join("small.ron"), folder.path().join("name")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("small.strands.ron", folder.path().join("shot.0003.png")).unwrap();
    let before = contents(folder.path());
    let twice = "is a picture of -o";
    let lines: &[(&[&str], &str)] = &[
        (
            &["render", "small.ron", "-o", "a.png", "--stats", "a.png"],
            twice,
        ),
        (
            &[
                "render",
                "small.ron",
                "-o",
                "a.png",
                "--stats",
                "./sub/../a.png",
            ],
            twice,
        ),
        (&["render", "small.ron", "--stats", "small.png"], twice),
        (
            &[
                "render",
                "small.ron",
                "--frames",
                "0-9",
                "--stats",
                "small.0009.png",
            ],
            twice,
        ),
        #[cfg(unix)]
        (
            &["render", "small.ron", "-o", "shot.png", "--frames", "0-9"],
            "written over small.strands.ron, which is read",
        ),
        (
            &["render", "small.ron", "--stats", "sub/../small.ron"],
            "is read",
        ),
        #[cfg(unix)]
        (&["render", "small.ron", "--stats", "name"], "is read"),
        (
            &["render", "small.ron", "--stats", "small.strands.ron"],
            "is read",
        ),
        (
            &[
                "render",
                "small.ron",
                "--motion",
                "nod.motion.ron",
                "--stats",
                "nod.motion.ron",
            ],
            "is read",
        ),
        (
            &[
                "render",
                "small.ron",
                "--hair",
                "look.png",
                "-o",
                "look.png",
            ],
            "is read",
        ),
        (
            &["simulate", "small.ron", "-o", "small.strands.ron"],
            "is read",
        ),
        (
            &["simulate", "small.ron", "-o", "a.png"],
            "must end in .strands.ron",
        ),
        (
            &["simulate", "small.ron", "-o", "small.ron"],
            "must end in .strands.ron",
        ),
        (&["render", "small.ron", "-o", "a.jpg"], "must end in .png"),
    ];
    for (line, message) in lines {
        inkstrand(&folder, line)
            .assert()
            .code(2)
            .stderr(contains(*message).and(contains("grown").not()));
        assert_eq!(contents(folder.path()), before, "{line:?}");
    }
    // The frame after the last is another file's.
    let line = [
        "render",
        "small.ron",
        "--frames",
        "0-1",
        "--stats",
        "small.0002.png",
    ];
    inkstrand(&folder, &line).assert().success();
}

#[test]
#[cfg(unix)]
fn a_picture_goes_where_a_link_points() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("sub")).unwrap();
    std::os::unix::fs::symlink("sub/real.png", path("a.png")).unwrap();
    // What is to be there is one file, by whichever name.
    let line = ["render", "small.ron", "-o", "a.png", "--stats"];
    inkstrand(&folder, &[&line[..], &["sub/real.png"]].concat())
        .assert()
        .code(2)
        .stderr(contains("is a picture of -o"));
    inkstrand(&folder, &line[..4]).assert().success();
    assert!(fs::symlink_metadata(path("a.png")).unwrap().is_symlink());
    assert!(path("sub/real.png").is_file());
}

#[test]
fn a_protected_file_is_not_written_over() {
    let folder = folder();
    let path = folder.path().join("a.png");
    fs::write(&path, "mine").unwrap();
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();
    // Who is root may write everywhere.
    if fs::OpenOptions::new().write(true).open(&path).is_ok() {
        return println!("SKIPPED 1 test: nothing is protected from root");
    }
    inkstrand(&folder, &["render", "small.ron", "-o", "a.png"])
        .assert()
        .code(1)
        .stderr(contains("a.png: "));
    assert_eq!(fs::read(&path).unwrap(), b"mine");
}

/// Materials, pictures and buffers that meshes name are read, too, whoever names the meshes.
#[test]
fn what_meshes_are_read_from_is_not_written_over() {
    const OBJ: &str =
        "mtllib h.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
    const GLTF: &str = r#"{
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
        "buffers": [{"byteLength": 36, "uri": "buf_0003.png"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]
    }"#;
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("h.obj", OBJ);
    write("h.mtl", "newmtl skin\nmap_Kd skin.png\n");
    write("skin.png", "a picture");
    write("body.gltf", GLTF);
    write("buf_0003.png", "36 bytes");
    write(
        "body.motion.ron",
        "(version: 1, bodies: [(name: \"b\", shape: mesh, file: \"body.gltf\")])",
    );
    let with = |more: &str| PRESET.replace("version: 1,", &format!("version: 1, {more},"));
    write("head.ron", &with("head: (file: \"h.obj\")"));
    write("meshes.ron", &with("meshes: [(file: \"h.obj\")]"));
    write(
        "both.ron",
        "(version: 1, objects: [(preset: \"meshes.ron\")], scene: (size: (40, 30), samples: 1))",
    );
    let before = contents(folder.path());
    let frames = "render small.ron --motion body.motion.ron --frames 0-4 -o buf_####.png";
    for (line, file) in [
        ("render head.ron -o skin.png", "skin.png"),
        ("render meshes.ron -o skin.png", "skin.png"),
        ("render both.ron -o skin.png", "skin.png"),
        ("render small.ron --head h.obj -o skin.png", "skin.png"),
        ("render head.ron --stats h.mtl", "h.mtl"),
        (frames, "buf_0003.png"),
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let said = contains(file).and(contains("is read"));
        inkstrand(&folder, &arguments).assert().code(2).stderr(said);
        assert!(contents(folder.path()) == before, "{line}");
    }
}

#[test]
fn what_cannot_be_written_is_said_before_the_work() {
    let folder = folder();
    fs::create_dir(folder.path().join("taken.png")).unwrap();
    fs::create_dir(folder.path().join("taken.strands.ron")).unwrap();
    // Broken hair would be found later.
    fs::write(folder.path().join("small.strands.ron"), "(").unwrap();
    // Of 256 bytes, one more than file systems have.
    let long = format!("{}.png", "a".repeat(252));
    let before = contents(folder.path());
    for line in [
        ["render", "small.ron", "-o", "no/where/a.png"],
        ["render", "small.ron", "-o", "taken.png"],
        #[cfg(target_os = "linux")]
        ["render", "small.ron", "-o", &long],
        ["render", "small.ron", "--stats", "no/where/s.json"],
        ["render", "small.ron", "--stats", "taken.png"],
        ["simulate", "small.ron", "-o", "no/where/a.strands.ron"],
        ["simulate", "small.ron", "-o", "taken.strands.ron"],
        #[cfg(target_os = "linux")]
        ["render", "small.ron", "-o", "/proc/a.png"],
    ] {
        inkstrand(&folder, &line)
            .assert()
            .code(1)
            .stderr(contains(line[3]).and(contains("small.strands.ron").not()));
        assert_eq!(contents(folder.path()), before, "{line:?}");
    }
}

#[test]
fn pictures_are_named_after_the_whole_name() {
    let folder = folder();
    fs::write(folder.path().join("look.v2.ron"), PRESET).unwrap();
    inkstrand(&folder, &["render", "look.v2.ron"])
        .assert()
        .success()
        .stderr(contains("wrote look.v2.png"));
    assert!(folder.path().join("look.v2.png").exists());
}

#[test]
fn a_sequence_is_one_file_that_moves() {
    let folder = folder();
    let moving = [
        "--motion",
        "nod.motion.ron",
        "--frames",
        "3-6",
        "-o",
        "nod.apng",
    ];
    inkstrand(&folder, &[&["render", "small.ron"][..], &moving].concat())
        .assert()
        .success()
        .stderr(contains("wrote nod.apng"));
    let file = fs::File::open(folder.path().join("nod.apng")).unwrap();
    let decoder = png::Decoder::new(std::io::BufReader::new(file));
    let mut reader = decoder.read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (4, 0));
    let mut first = vec![0; 40 * 30 * 3];
    reader.next_frame(&mut first).unwrap();
    let delay = *reader.info().frame_control().unwrap();
    assert_eq!(delay.delay_den / delay.delay_num, 24);

    // The first frame is the picture of that frame alone.
    let still = [
        "--motion",
        "nod.motion.ron",
        "--frames",
        "3-3",
        "-o",
        "a_#.png",
    ];
    inkstrand(&folder, &[&["render", "small.ron"][..], &still].concat())
        .assert()
        .success();
    let file = fs::File::open(folder.path().join("a_3.png")).unwrap();
    let decoder = png::Decoder::new(std::io::BufReader::new(file));
    let mut alone = vec![0; first.len()];
    decoder.read_info().unwrap().next_frame(&mut alone).unwrap();
    assert_eq!(first, alone);
}

#[test]
#[cfg(target_os = "linux")]
fn names_may_be_as_long_as_the_file_system_allows() {
    let folder = folder();
    let picture = format!("{}.png", "p".repeat(251));
    let bake = format!("{}.strands.ron", "b".repeat(243));
    inkstrand(&folder, &["render", "small.ron", "-o", &picture])
        .assert()
        .success();
    inkstrand(
        &folder,
        &["simulate", "small.ron", "-o", &bake, "--frames", "0-1"],
    )
    .assert()
    .success();
    assert!(folder.path().join(picture).is_file() && folder.path().join(bake).is_file());
}

#[test]
fn stats_go_to_the_standard_output_too() {
    let folder = folder();
    let output = inkstrand(
        &folder,
        &[
            "render",
            "small.ron",
            "--frames",
            "0-2",
            "--stats",
            "-",
            "--quiet",
        ],
    )
    .output()
    .unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let frames = text.lines().map(|line| {
        let value: serde_json::Value = serde_json::from_str(line).unwrap();
        value["frame"].as_u64().unwrap()
    });
    assert_eq!(frames.collect::<Vec<_>>(), [0, 1, 2]);
    assert!(!folder.path().join("-").exists());
}

#[test]
fn a_bake_takes_the_place_of_a_bake_alone() {
    let folder = folder();
    let line = [
        "simulate",
        "small.ron",
        "-o",
        "b.strands.ron",
        "--frames",
        "0-1",
    ];
    inkstrand(&folder, &line).assert().success();
    inkstrand(&folder, &line).assert().success();
    // Somebody's own strands.
    fs::write(folder.path().join("b.strands.ron"), STRANDS).unwrap();
    inkstrand(&folder, &line)
        .assert()
        .code(1)
        .stderr(contains("b.strands.ron is there already"));
    assert_eq!(
        fs::read_to_string(folder.path().join("b.strands.ron")).unwrap(),
        STRANDS
    );
}

#[test]
#[cfg(all(feature = "gpu", target_os = "linux"))]
fn drivers_say_nothing_where_there_is_no_desktop() {
    let folder = folder();
    for value in [None, Some(""), Some("relative/folder")] {
        let mut command = inkstrand(&folder, &["render", "small.ron", "--quiet"]);
        match value {
            Some(value) => command.env("XDG_RUNTIME_DIR", value),
            None => command.env_remove("XDG_RUNTIME_DIR"),
        };
        command.assert().success().stdout("").stderr("");
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = folder();
    for (option, value, message) in [
        ("--size", "-1x5", "a size is WxH, such as 960x720"),
        ("--time", "-1", "a time is from 0 to 100000 seconds"),
        ("--time", "1e9", "a time is from 0 to 100000 seconds"),
        ("--time", "-x", "not a number"),
        ("--frames", "0-4294967295", "frames go up to 999999"),
        ("--frames", "-3-5", "frames are A-B, such as 0-23"),
        ("--samples", "-1", "1..=256"),
        ("--guides", "-1", "0..=1000000"),
    ] {
        inkstrand(&folder, &["render", "small.ron", option, value])
            .assert()
            .code(2)
            .stderr(contains(message));
    }
}

#[test]
fn a_misspelt_name_is_told_with_the_nearest() {
    let folder = folder();
    for (arguments, message) in [
        (
            "render smal.ron",
            "there is no `smal.ron`, did you mean `small.ron`?",
        ),
        (
            "check smal.ron",
            "there is no `smal.ron`, did you mean `small.ron`?",
        ),
        (
            "render small.ron --motion nods.motion.ron",
            "--motion: there is no `nods.motion.ron`, did you mean `nod.motion.ron`?",
        ),
        (
            "simulate small.ron --hair smal.strands.ron -o bake.strands.ron --frames 0-1",
            "--hair: there is no `smal.strands.ron`, did you mean `small.strands.ron`?",
        ),
        (
            "render small.ron --bake there/bake.strands.ron",
            "nor a folder `there`",
        ),
        (
            "render small.ron --head .",
            "--head: `.` is a folder, not a file",
        ),
        (
            "render small.ron --set clmp.size=1",
            "there is no layer or section `clmp`, did you mean `clump`?",
        ),
    ] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let run = inkstrand(&folder, &arguments).assert().failure();
        run.stderr(contains(message));
    }
}
