//! `inkstrand new`: a preset that renders from an empty folder.

use assert_cmd::Command;
use predicates::str::contains;
use std::fs;
use std::path::Path;

fn inkstrand(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    command.current_dir(folder).args(arguments).assert()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn the_starter_renders_from_an_empty_folder() {
    let folder = tempfile::tempdir().unwrap();
    inkstrand(folder.path(), &["new", "bob.ron"])
        .success()
        .stdout("")
        .stderr(contains("inkstrand render bob.ron"));
    assert_eq!(names(folder.path()), ["bob.ron", "bob.style.ron"]);
    inkstrand(folder.path(), &["check", "bob.ron"])
        .success()
        .stderr("");
    // From another folder, too.
    let here = tempfile::tempdir().unwrap();
    let preset = folder.path().join("bob.ron");
    let options = ["render", preset.to_str().unwrap()];
    inkstrand(here.path(), &options)
        .success()
        .stderr(contains("grown from the style"));

    let file = fs::File::open(here.path().join("bob.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    let share = |color: [u8; 3]| {
        let hits = bytes.chunks(3).filter(|pixel| *pixel == color).count();
        hits as f64 / (960.0 * 720.0)
    };
    // Lit and in shadow.
    let hair = share([0x3F, 0xC1, 0xC0]) + share([0x2A, 0x8F, 0x9D]);
    let outline = share([0x12, 0x4A, 0x57]);
    assert!((0.05..0.5).contains(&hair), "{hair} of the picture is hair");
    assert!(
        (0.002..0.1).contains(&outline),
        "{outline} of the picture is outline"
    );
}

#[test]
fn the_starter_shows_every_section() {
    let folder = tempfile::tempdir().unwrap();
    inkstrand(folder.path(), &["new", "look.ron"]).success();
    let text = fs::read_to_string(folder.path().join("look.ron")).unwrap();
    for (section, ..) in stage::Sections::ALL {
        let opening = text.find(&format!("\n    {section}: (\n"));
        let opening = opening.unwrap_or_else(|| panic!("{section} is not in the starter"));
        let before = text[..opening].lines().last().unwrap();
        assert!(
            before.trim().starts_with("//"),
            "a comment before {section}"
        );
    }
    for param in stage::Preset::TOP {
        // What builds on another preset is there to be tried.
        let said = ["    ", "    // "].map(|start| format!("\n{start}{}: ", param.name));
        assert!(
            said.iter().any(|said| text.contains(said)),
            "{}",
            param.name
        );
    }
}

#[test]
fn files_are_never_overwritten() {
    for taken in ["look.ron", "look.style.ron"] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(taken), "mine").unwrap();
        inkstrand(folder.path(), &["new", "look.ron"])
            .code(1)
            .stderr(contains(format!("{taken} is already there")));
        assert_eq!(names(folder.path()), [taken]);
        assert_eq!(
            fs::read_to_string(folder.path().join(taken)).unwrap(),
            "mine"
        );
    }
}

#[test]
fn names_that_are_no_presets() {
    let folder = tempfile::tempdir().unwrap();
    for name in [
        "look",
        "look.png",
        ".ron",
        "a.strands.ron",
        "a.style.ron",
        "..",
    ] {
        inkstrand(folder.path(), &["new", name])
            .code(2)
            .stderr(contains(".ron"));
    }
    #[cfg(unix)]
    for name in ["a\nb.ron", "a\tb.ron", "\u{1b}[2J.ron"] {
        inkstrand(folder.path(), &["new", name])
            .code(2)
            .stderr(contains("control characters"));
    }
    inkstrand(folder.path(), &["new", "no/such/look.ron"])
        .code(1)
        .stderr(contains("no/such/look.style.ron"));
    assert!(names(folder.path()).is_empty());
}

#[test]
fn names_of_any_kind_are_drawn_by_the_hint_that_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    for (name, word) in [
        ("my look.ron", "'my look.ron'"),
        ("look.v2.ron", "look.v2.ron"),
        #[cfg(unix)]
        ("say \"a\\b\".ron", "'say \"a\\b\".ron'"),
    ] {
        inkstrand(folder.path(), &["new", name])
            .success()
            .stderr(contains(format!("inkstrand render {word}\n")));
        inkstrand(folder.path(), &["check", name])
            .success()
            .stderr("");
    }
}

#[test]
fn a_style_is_not_a_preset() {
    let folder = tempfile::tempdir().unwrap();
    inkstrand(folder.path(), &["new", "x.style.ron"])
        .code(2)
        .stderr(contains(
            "x.style.ron: .style.ron is the name of a hair style; `inkstrand new x.ron` writes a preset",
        ));
    assert!(names(folder.path()).is_empty());
}
