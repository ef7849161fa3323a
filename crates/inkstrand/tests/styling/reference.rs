//! Every word that a preset, a style or a script may say is explained.

use super::page::Page;
use assert_cmd::Command;
use serde_json::Value;
use std::collections::BTreeSet;

/// What the program knows: a section, an effect, or a part of a style or script, with its parameters.
fn known() -> Vec<(String, Vec<Value>)> {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    let output = command.args(["effects", "--json"]).output().unwrap();
    let schema: Value = serde_json::from_slice(&output.stdout).unwrap();
    let kinds = ["sections", "effects", "style", "motion"];
    let parts = kinds.map(|kind| schema[kind].as_array().unwrap());
    let part = |part: &Value| {
        let id = part["id"].as_str().unwrap().to_owned();
        (id, part["parameters"].as_array().unwrap().clone())
    };
    parts.into_iter().flatten().map(part).collect()
}

/// The rows of a part's table: the words in its first cell, and the whole row.
fn rows(part: &str) -> Vec<(&str, &str)> {
    let rows = part.lines().filter_map(|line| {
        let name = line.strip_prefix("| `")?.split('`').next()?;
        Some((name, line))
    });
    rows.collect()
}

#[test]
fn every_parameter_is_explained_and_no_other() {
    let page = Page::read("styling.md");
    for (id, parameters) in known() {
        let rows = rows(page.part(&format!("### `{id}`")));
        let explained: Vec<&str> = rows.iter().map(|(name, _)| *name).collect();
        let names: BTreeSet<&str> = parameters
            .iter()
            .map(|p| p["name"].as_str().unwrap())
            .collect();
        assert_eq!(explained.len(), names.len(), "{id}: {explained:?}");
        assert_eq!(
            explained.into_iter().collect::<BTreeSet<_>>(),
            names,
            "{id}"
        );
        for parameter in parameters {
            let name = parameter["name"].as_str().unwrap();
            let (_, row) = rows.iter().find(|(row, _)| *row == name).unwrap();
            let cells: Vec<&str> = row.split('|').map(str::trim).collect();
            assert!(
                cells.len() == 5 && cells[2].len() > 4,
                "{id}, {name}: {row}"
            );
            let choices = parameter["choices"].as_array().into_iter().flatten();
            for choice in choices.map(|choice| choice.as_str().unwrap()) {
                assert!(
                    row.contains(&format!("`{choice}`")),
                    "{id}, {name}: {choice}"
                );
            }
        }
    }
}

/// A section that is no more is not explained either.
#[test]
fn every_part_that_is_explained_is_known() {
    let page = Page::read("styling.md");
    let known: BTreeSet<String> = known().into_iter().map(|(id, _)| id).collect();
    let headings = page
        .headings()
        .filter_map(|line| line.strip_prefix("### `"));
    let explained: BTreeSet<String> = headings
        .map(|id| id.trim_end_matches('`').to_owned())
        .collect();
    assert_eq!(explained, known);
}

#[test]
fn readme_links_the_pages_first() {
    let readme = std::fs::read_to_string(super::root().join("README.md")).unwrap();
    let links = readme
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next());
    let pages: Vec<&str> = links.filter(|link| link.ends_with(".md")).take(2).collect();
    assert_eq!(pages, ["docs/styling.md", "docs/gallery.md"]);
}
