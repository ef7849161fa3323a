//! Every command and option that the program's own definition has works.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

use assert_cmd::Command;
use std::collections::BTreeSet;
use std::fs;
use tempfile::TempDir;

const STRANDS: &str = "(version: 1, strands: [
    (size: 30.0, mirror: true, points: [(0.03, 0.1, 0.0), (0.1, 0.1, 0.02), (0.13, -0.1, 0.03)]),
])";
const BAKE: &str = "(version: 1, strands: [
    (size: 30.0, mirror: true, points: [(0.03, 0.1, 0.0), (0.1, 0.1, 0.02), (0.13, -0.1, 0.03)]),
], motion: [(time: 0, strands: [[(0.03, 0.1, 0.0), (0.1, 0.1, 0.02), (0.13, -0.1, 0.03)]])])";
const PRESET: &str = "(
    version: 1,
    hair: (file: \"small.strands.ron\"),
    scene: (size: (40, 30), samples: 1),
    layers: [(effect: \"hair.silhouette\"), (effect: \"hair.base\")],
)";
const HEAD: &str = "v -0.1 -0.1 0\nv 0.1 -0.1 0\nv 0 0.1 0.05\nv 0 0 -0.1\n\
    f 1 2 3\nf 2 1 4\nf 3 2 4\nf 1 3 4\n";

/// All of them, each with a command line that uses it.
const LINES: &[(&str, &[&str])] = &[
    ("check FILE", &["check", "small.ron"]),
    ("completions SHELL bash", &["completions", "bash"]),
    ("completions SHELL elvish", &["completions", "elvish"]),
    ("completions SHELL fish", &["completions", "fish"]),
    (
        "completions SHELL powershell",
        &["completions", "powershell"],
    ),
    ("completions SHELL zsh", &["completions", "zsh"]),
    ("effects NAME", &["effects", "hair.base"]),
    ("effects --json", &["effects", "--json"]),
    ("new NAME.ron", &["new", "fresh.ron"]),
    (
        "simulate PRESET",
        &["simulate", "small.ron", "-o", "bake.strands.ron"],
    ),
    (
        "simulate --output",
        &["simulate", "small.ron", "--output", "bake.strands.ron"],
    ),
    (
        "simulate --frames",
        &[
            "simulate",
            "small.ron",
            "-o",
            "bake.strands.ron",
            "--frames",
            "0-3",
        ],
    ),
    (
        "simulate --hair",
        &[
            "simulate",
            "small.ron",
            "-o",
            "bake.strands.ron",
            "--hair",
            "small.strands.ron",
        ],
    ),
    (
        "simulate --head",
        &[
            "simulate",
            "small.ron",
            "-o",
            "bake.strands.ron",
            "--head",
            "head.obj",
        ],
    ),
    (
        "simulate --character",
        &[
            "simulate",
            "small.ron",
            "-o",
            "bake.strands.ron",
            "--character",
            "head.obj",
        ],
    ),
    (
        "simulate --motion",
        &[
            "simulate",
            "small.ron",
            "-o",
            "bake.strands.ron",
            "--motion",
            "turn.motion.ron",
        ],
    ),
    (
        "simulate --guides",
        &[
            "simulate",
            "small.ron",
            "-o",
            "bake.strands.ron",
            "--guides",
            "1",
        ],
    ),
    (
        "simulate --set",
        &[
            "simulate",
            "small.ron",
            "-o",
            "bake.strands.ron",
            "--set",
            "clump.size=2",
        ],
    ),
    (
        "simulate --quiet",
        &["simulate", "small.ron", "-o", "bake.strands.ron", "--quiet"],
    ),
    (
        "render --bake",
        &["render", "small.ron", "--bake", "still.strands.ron"],
    ),
    ("render PRESET", &["render", "small.ron"]),
    (
        "render --output",
        &["render", "small.ron", "--output", "a.png"],
    ),
    (
        "render --hair",
        &["render", "small.ron", "--hair", "small.strands.ron"],
    ),
    (
        "render --head",
        &["render", "small.ron", "--head", "head.obj"],
    ),
    (
        "render --character",
        &["render", "small.ron", "--character", "head.obj"],
    ),
    (
        "render --motion",
        &["render", "small.ron", "--motion", "turn.motion.ron"],
    ),
    ("render --guides", &["render", "small.ron", "--guides", "1"]),
    (
        "render --frames",
        &["render", "small.ron", "--frames", "0-1"],
    ),
    ("render --time", &["render", "small.ron", "--time", "0.5"]),
    ("render --size", &["render", "small.ron", "--size", "8x6"]),
    (
        "render --samples",
        &["render", "small.ron", "--samples", "2"],
    ),
    (
        "render --backend auto",
        &["render", "small.ron", "--backend", "auto"],
    ),
    (
        "render --backend gpu",
        &["render", "small.ron", "--backend", "gpu"],
    ),
    (
        "render --backend cpu",
        &["render", "small.ron", "--backend", "cpu"],
    ),
    (
        "render --camera",
        &["render", "small.ron", "--camera", "-10,5,6"],
    ),
    (
        "render --light",
        &["render", "small.ron", "--light", "-10,5"],
    ),
    (
        "render --background",
        &["render", "small.ron", "--background", "102030"],
    ),
    (
        "render --set",
        &["render", "small.ron", "--set", "clump.size=2"],
    ),
    (
        "render --only",
        &["render", "small.ron", "--only", "hair.base"],
    ),
    (
        "render --threads",
        &["render", "small.ron", "--threads", "2"],
    ),
    (
        "render --stats",
        &["render", "small.ron", "--stats", "stats.jsonl"],
    ),
    ("render --quiet", &["render", "small.ron", "--quiet"]),
    (
        "render --pass depth",
        &["render", "small.ron", "--pass", "depth"],
    ),
    (
        "render --pass normal",
        &["render", "small.ron", "--pass", "normal"],
    ),
    (
        "render --pass object",
        &["render", "small.ron", "--pass", "object"],
    ),
    (
        "render --pass strand",
        &["render", "small.ron", "--pass", "strand"],
    ),
    (
        "render --pass piece",
        &["render", "small.ron", "--pass", "piece"],
    ),
    (
        "render --pass layer",
        &["render", "small.ron", "--pass", "layer"],
    ),
    (
        "render --pass level",
        &["render", "small.ron", "--pass", "level"],
    ),
    ("render --pass u", &["render", "small.ron", "--pass", "u"]),
    ("render --pass s", &["render", "small.ron", "--pass", "s"]),
    (
        "render --pass pixels",
        &["render", "small.ron", "--pass", "pixels"],
    ),
    ("render --pass v", &["render", "small.ron", "--pass", "v"]),
    ("render --pass w", &["render", "small.ron", "--pass", "w"]),
];

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("small.strands.ron", STRANDS),
        ("small.ron", PRESET),
        ("still.strands.ron", BAKE),
        ("head.obj", HEAD),
        ("turn.motion.ron", "(version: 1, moves: [(move: turn)])"),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn inkstrand(folder: &TempDir, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    command.current_dir(folder.path()).args(arguments);
    command
}

/// What the program's definition has: `render --size`, `render PRESET`, `render --backend gpu`.
fn defined() -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let program = inkstrand::command();
    assert_eq!(
        program.get_arguments().count(),
        0,
        "no options before the command"
    );
    for command in program.get_subcommands() {
        assert_eq!(command.get_subcommands().count(), 0);
        for argument in command.get_arguments() {
            let name = match argument.get_long() {
                Some(long) => format!("--{long}"),
                None => match argument.get_value_names() {
                    Some([name]) => name.to_string(),
                    _ => argument.get_id().as_str().to_uppercase(),
                },
            };
            let name = format!("{} {name}", command.get_name());
            let choices = argument.get_possible_values();
            if choices.is_empty() || !argument.get_action().takes_values() {
                names.insert(name);
            } else {
                names.extend(
                    choices
                        .iter()
                        .map(|choice| format!("{name} {}", choice.get_name())),
                );
            }
        }
    }
    names
}

#[test]
fn nothing_of_the_definition_is_forgotten() {
    let listed: Vec<&str> = LINES.iter().map(|(name, _)| *name).collect();
    let unique: BTreeSet<String> = listed.iter().map(|name| (*name).to_owned()).collect();
    assert_eq!(unique.len(), listed.len(), "one list, once each");
    assert_eq!(defined(), unique);
    for (name, line) in LINES {
        let option = name.split(' ').nth(1).unwrap();
        assert!(
            !option.starts_with("--") || line.contains(&option),
            "{name}: {line:?}"
        );
    }
}

#[test]
fn all_of_it_works() {
    let folder = folder();
    for (name, line) in LINES {
        if name.ends_with("gpu") && cfg!(not(feature = "gpu")) {
            continue;
        }
        let output = inkstrand(&folder, line).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        let has_driver = !told.contains("there is no graphics card to draw on");
        if name.ends_with("gpu")
            && !has_driver
            && std::env::var_os("CI").is_none_or(|ci| ci != "true")
        {
            eprintln!("SKIPPED: {name}: no driver for a graphics card");
            continue;
        }
        assert_eq!(output.status.code(), Some(0), "{name}: {told}");
    }
}

#[test]
fn help_has_examples_that_parse() {
    let folder = folder();
    let output = inkstrand(&folder, &["help", "render"]).output().unwrap();
    let help = String::from_utf8(output.stdout).unwrap();
    for word in [
        "Examples:",
        "degrees",
        "head heights",
        "1/300",
        "[default: ",
    ] {
        assert!(help.contains(word), "`{word}` in:\n{help}");
    }
    let mut program = inkstrand::command();
    let examples: Vec<&str> = help
        .lines()
        .map(str::trim)
        .filter(|line| line.starts_with("inkstrand render "))
        .collect();
    assert!(examples.len() >= 5, "{help}");
    for example in examples {
        let parsed = program.try_get_matches_from_mut(example.split(' '));
        assert!(parsed.is_ok(), "{example}: {}", parsed.unwrap_err());
    }
}
