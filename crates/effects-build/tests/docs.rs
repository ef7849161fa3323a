//! `docs/effects.md` says what there is.

use std::fs;
use std::path::Path;

fn document(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    fs::read_to_string(root.join(path)).unwrap()
}

/// The rows of the table of inputs: name, type, meaning.
fn rows(text: &str) -> Vec<[String; 3]> {
    let table = text.split("## Inputs").nth(1).unwrap();
    let table = table.split("## Parameters").next().unwrap();
    let rows = table.lines().filter(|line| line.starts_with("| `"));
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

#[test]
fn each_input_is_documented_as_it_is() {
    let rows = rows(&document("docs/effects.md"));
    // The message about an input that there isn't names all that there are.
    let source = "//! inputs: nonsense\nfn stroke() {}";
    let error = effects_build::translate_effect(source, "a.wgsl").unwrap_err();
    let error = error.to_string();
    for [name, ..] in &rows {
        let mut words = error.split(|c: char| !c.is_alphanumeric() && c != '_');
        assert!(words.any(|word| word == name), "{name}: {error}");
    }
    let table = document("crates/effects-build/src/inputs.rs");
    for [name, ty, meaning] in &rows {
        let start = format!("input(\"{name}\", ");
        let row = table.lines().find(|line| line.contains(&start)).unwrap();
        assert!(row.contains(&format!("\"{meaning}\"")), "{name}: {meaning}");
        let kind = row.split(", ").nth(1).unwrap().to_lowercase();
        assert!(ty.starts_with(&kind), "{name}: {ty} for {kind}");
    }
    assert_eq!(rows.len(), table.matches("    input(\"").count());
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
