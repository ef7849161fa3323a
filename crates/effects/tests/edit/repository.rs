//! Changes of the repository's own presets, styles and scripts.

use crate::{Way, reads, steps};
use effects::preset::edit::{self, Step, Step::Field, Step::Item};
use std::fs;
use std::path::Path;

/// The text of each preset, style and script of the repository.
fn repository() -> Vec<(String, String)> {
    let presets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
    let mut found = Vec::new();
    for folder in [
        presets.clone(),
        presets.join("styles"),
        presets.join("motions"),
    ] {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "ron") {
                found.push((
                    path.display().to_string(),
                    fs::read_to_string(&path).unwrap(),
                ));
            }
        }
    }
    assert!(found.len() > 10);
    found
}

/// All values in the text.
fn ways(text: &str, way: &mut Vec<Way>, found: &mut Vec<Vec<Way>>) {
    let names: Vec<Way> = edit::fields(text, &steps(way))
        .into_iter()
        .map(|(name, _)| Way::Name(name.to_owned()))
        .collect();
    let items = (0..edit::items(text, &steps(way)).len()).map(Way::Index);
    for step in names.into_iter().chain(items) {
        way.push(step);
        found.push(way.clone());
        ways(text, way, found);
        way.pop();
    }
}

#[test]
fn presets_of_the_repository() {
    for (name, text) in repository() {
        let mut found = Vec::new();
        ways(&text, &mut Vec::new(), &mut found);
        assert!(found.len() > 3, "{name}");
        for way in found.iter().filter(|way| way.len() <= 3) {
            let path = steps(way);
            let value = edit::get(&text, &path).unwrap();
            assert_eq!(
                edit::set(&text, &path, value).unwrap(),
                text,
                "{name}: {path:?}"
            );
            let changed = edit::set(&text, &path, "\"other\"").unwrap();
            assert_eq!(changed.len() + value.len(), text.len() + "\"other\"".len());
            assert_eq!(
                edit::set(&changed, &path, value).unwrap(),
                text,
                "{name}: {path:?}"
            );
            if way.len() == 3 {
                continue;
            }
            reads(&edit::remove(&text, &path).unwrap()).unwrap();
            // What is added in one's own layout goes without a trace.
            let field: Vec<Step> = path.iter().copied().chain([Field("added")]).collect();
            if !edit::fields(&text, &path).is_empty() {
                let added = edit::set(&text, &field, "1").unwrap();
                // On a line of its own at most, and only where values stand on several lines.
                let lines = added.lines().count() - text.lines().count();
                assert!(
                    lines <= usize::from(value.contains('\n')),
                    "{name}: {path:?}"
                );
                assert_eq!(
                    edit::remove(&added, &field).unwrap(),
                    text,
                    "{name}: {path:?}"
                );
            }
            let count = edit::items(&text, &path).len();
            for at in 0..count {
                let item: Vec<Step> = path.iter().copied().chain([Item(at)]).collect();
                let inserted = edit::insert(&text, &path, at, "(added: 1)").unwrap();
                assert_eq!(edit::get(&inserted, &item), Some("(added: 1)"));
                assert_eq!(
                    edit::remove(&inserted, &item).unwrap(),
                    text,
                    "{name}: {path:?}"
                );
                let moved = edit::move_item(&text, &path, at, count - 1).unwrap();
                assert_eq!(
                    edit::move_item(&moved, &path, count - 1, at).unwrap(),
                    text,
                    "{name}: {path:?}"
                );
            }
        }
    }
}
