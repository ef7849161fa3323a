//! `docs/effects.md` says what there is.

use std::fs;
use std::path::Path;

fn document(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    fs::read_to_string(root.join(path)).unwrap()
}

/// The rows of the table under a heading: name, type, meaning.
fn rows(text: &str, heading: &str) -> Vec<[String; 3]> {
    let part = text.split(heading).nth(1).unwrap();
    let part = part.split("\n## ").next().unwrap();
    let rows = part.lines().filter(|line| line.starts_with("| `"));
    rows.map(|row| {
        let mut cells = row.trim_matches('|').split(" | ").map(str::trim);
        [(); 3].map(|()| {
            cells
                .next()
                .unwrap_or_default()
                .trim_matches('`')
                .to_owned()
        })
    })
    .collect()
}

/// What a message says of an input that there isn't: all that there are.
fn message(first_line: &str) -> String {
    let source = format!("{first_line}\nfn stroke() {{}}");
    let error = effects_build::translate_effect(&source, "a.wgsl").unwrap_err();
    error.to_string()
}

#[test]
fn each_input_is_documented_as_it_is() {
    let text = document("docs/effects.md");
    let source = document("crates/effects-build/src/inputs.rs");
    let (joints, samples) = source.split_once("SAMPLE_INPUTS: &[Input]").unwrap();
    for (heading, table, message) in [
        ("## Inputs", joints, message("//! inputs: nonsense")),
        (
            "## Paint",
            samples,
            message("//! inputs: u\n//! sample: nonsense") + &message("//! mesh: nonsense"),
        ),
    ] {
        let rows = rows(&text, heading);
        for [name, ty, meaning] in &rows {
            let mut words = message.split(|c: char| !c.is_alphanumeric() && c != '_');
            assert!(words.any(|word| word == name), "{name}: {message}");
            let start = format!("input(\"{name}\", ");
            let row = table.lines().find(|line| line.contains(&start)).unwrap();
            assert!(row.contains(&format!("\"{meaning}\"")), "{name}: {meaning}");
            let kind = row.split(", ").nth(1).unwrap().to_lowercase();
            assert!(ty.starts_with(&kind), "{name}: {ty} for {kind}");
        }
        assert_eq!(
            rows.len(),
            table.matches("    input(\"").count(),
            "{heading}"
        );
    }
}

#[test]
fn functions_of_the_prelude_are_all_named() {
    let text = document("docs/effects.md");
    let prelude = document("shaders/prelude.wgsl");
    for line in prelude.lines().filter_map(|line| line.strip_prefix("fn ")) {
        let name = line.split('(').next().unwrap();
        assert!(text.contains(&format!("`{name}`")), "{name}");
    }
}

#[test]
fn effects_that_are_shown_whole_are_translated() {
    let text = document("docs/effects.md");
    let shown = text.split("```wgsl\n").skip(1);
    let shown: Vec<&str> = shown
        .map(|rest| rest.split("```").next().unwrap())
        .collect();
    assert_eq!(shown.len(), 4);
    for source in shown {
        if let Err(error) = effects_build::translate_effect(source, "a.wgsl") {
            panic!("{error}\n{source}");
        }
    }
}
