//! Holds the workspace to its layers: who may depend on whom, and who may use the libraries that
//! would carry a subject into crates that must not know of it.

use serde_json::Value;

use crate::{Outcome, program};

/// What the crates of the workspace may use, the lowest layer first. An arrow may only point down, or within a layer to a row before.
const TABLE: &[Row] = &[
    Row(0, "hair-sim", Only(&[]), &[]),
    Row(0, "portable-math", Only(&[]), &[]),
    Row(0, "stroke-path", Only(&["portable-math"]), &[]),
    Row(0, "mesh-io", Only(&["portable-math"]), &[]),
    Row(0, "mesh-lines", Only(&[]), &[]),
    Row(0, BUILD_TOOL, Only(&[]), &[]),
    Row(
        1,
        "hair-io",
        Only(&["hair-sim", "mesh-io", "portable-math"]),
        &[],
    ),
    Row(1, "groom", Only(&["hair-sim", "portable-math"]), &[]),
    Row(
        1,
        "effects",
        Only(&["stroke-path", "portable-math"]),
        &[BUILD_TOOL],
    ),
    Row(2, "document", Only(&["hair-io"]), &[]),
    Row(2, "effects-builtin", Only(&["effects"]), &[BUILD_TOOL]),
    Row(2, "effects-cartoon", Only(&["effects"]), &[BUILD_TOOL]),
    Row(2, "effects-surface", Only(&["effects"]), &[BUILD_TOOL]),
    Row(2, "effects-testkit", Only(&["effects"]), &[BUILD_TOOL]),
    Row(
        2,
        "render",
        Only(&["effects", "stroke-path", "portable-math"]),
        &[],
    ),
    Row(3, "reference", Only(&["render"]), &[]),
    Row(3, "stage", AllBelow, &[]),
    Row(4, "inkstrand", AllBelow, &[]),
    Row(5, "viewer", AllBelow, &[]),
    Row(4, "bench", AllBelow, &[]),
    // A third party's effects, under `examples/`: its code has the boundary for effects alone, the
    // program that shows it is behind a feature, with all of inkstrand.
    Row(5, "effect-*", Only(&["effects"]), &[BUILD_TOOL]),
    // Somebody's program with hair in it: all that a library is for, but not the program.
    Row(4, "embed-*", AllBelow, &[]),
    // It runs the programs in place of using the crates, so that it builds in seconds.
    Row(5, "xtask", Nothing, &[]),
];

/// Used by build scripts alone, never by the code of a program.
const BUILD_TOOL: &str = "effects-build";

/// What the tests of a crate may use although it stands above.
const FOR_TESTS: &[&str] = &["effects-testkit", "reference"];

/// What a crate of effects may use behind a feature.
const FOR_PROGRAMS: &[&str] = &["inkstrand", "viewer"];

/// Families of libraries, and the only crates that may depend on one of them, tests included.
const GUARDED: &[Guard] = &[
    Guard(&["wgpu"], &["render", "viewer", "embed-wgpu"]),
    Guard(&["winit"], &["viewer", "embed-wgpu"]),
    // The kit works an effect's WGSL out by itself, to hold the translation against it.
    Guard(&["naga"], &[BUILD_TOOL, "effects", "effects-testkit"]),
    Guard(&["egui", "eframe"], &["viewer"]),
];

/// Layer, crate (or the start of several names before a `*`), what its code and tests are held
/// to, and what else its build script may use.
struct Row(u8, &'static str, Uses, &'static [&'static str]);

use Uses::{AllBelow, Nothing, Only};

enum Uses {
    /// These crates; the tests any crate of the same or a lower layer.
    Only(&'static [&'static str]),
    /// Every crate of a lower layer; the tests those of the same layer too.
    AllBelow,
    /// No crate, not even in tests.
    Nothing,
}

/// The first words of the names of a family (`wgpu`, `wgpu-core`, not `wgpufoo`), and its users.
struct Guard(&'static [&'static str], &'static [&'static str]);

/// Which part of a crate depends.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Code,
    /// Code behind a feature.
    Optional,
    Build,
    Tests,
}

impl Row {
    fn of(package: &str) -> Option<&'static Self> {
        TABLE
            .iter()
            .find(|Row(_, name, ..)| match name.strip_suffix('*') {
                Some(start) => package.starts_with(start),
                None => package == *name,
            })
    }

    /// True if a crate of this row may depend on one of row `to`.
    fn allows(&self, to: &Self, kind: Kind) -> bool {
        let Row(layer, _, uses, build) = self;
        let Row(to_layer, to_name, ..) = to;
        match (kind, uses) {
            (_, Nothing) => false,
            (Kind::Build, _) => build.contains(to_name),
            (Kind::Tests, _) => to_layer <= layer || FOR_TESTS.contains(to_name),
            (Kind::Optional, Only(_)) if *layer == 5 && FOR_PROGRAMS.contains(to_name) => true,
            (Kind::Code | Kind::Optional, Only(names)) => names.contains(to_name),
            (Kind::Code | Kind::Optional, AllBelow) => to_layer < layer && *to_name != BUILD_TOOL,
        }
    }

    /// What the row allows, for the maintainer who reads of an edge that it doesn't.
    fn rule(&self, kind: Kind) -> String {
        let Row(layer, _, uses, build) = self;
        let list = |names: &[&str]| match names {
            [] => "no crate of the workspace".to_owned(),
            names => names.join(", "),
        };
        match (kind, uses) {
            (_, Nothing) => list(&[]),
            (Kind::Build, _) => list(build),
            (Kind::Tests, _) => format!("layers 0 to {layer}, {}", FOR_TESTS.join(", ")),
            (Kind::Code | Kind::Optional, Only(names)) => list(names),
            (Kind::Code | Kind::Optional, AllBelow) => {
                format!("the layers below {layer}, without {BUILD_TOOL}")
            }
        }
    }
}

impl Guard {
    fn covers(&self, library: &str) -> bool {
        self.0.iter().any(|family| {
            library
                .strip_prefix(family)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with(['-', '_']))
        })
    }
}

/// Reads the workspace's crates with cargo and holds them to the table.
///
/// # Errors
/// All violations, one a line, or what cargo says of a broken manifest.
pub fn check() -> Outcome {
    let output = program::cargo(&["metadata", "--format-version=1", "--no-deps"]).output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().into());
    }
    let violations = violations(&serde_json::from_slice(&output.stdout)?)?;
    if violations.is_empty() {
        return Ok(());
    }
    Err(violations.join("\n").into())
}

/// Everything in `metadata` (of `cargo metadata --no-deps`) that the table doesn't allow.
fn violations(metadata: &Value) -> Outcome<Vec<String>> {
    let packages = array(metadata, "packages")?;
    if packages.is_empty() {
        return Err("cargo metadata names no package".into());
    }
    let mut members = Vec::new();
    for package in packages {
        members.push(text(package, "name")?);
    }

    let mut found = Vec::new();
    for (package, &name) in packages.iter().zip(&members) {
        let Some(row) = Row::of(name) else {
            found.push(format!(
                "{name} has no layer: add it to the table in xtask/src/layers.rs"
            ));
            continue;
        };
        for dependency in array(package, "dependencies")? {
            let library = text(dependency, "name")?;
            let kind = match dependency["kind"].as_str() {
                Some("dev") => Kind::Tests,
                Some("build") => Kind::Build,
                _ if dependency["optional"] == true => Kind::Optional,
                _ => Kind::Code,
            };
            if members.contains(&library) {
                // A member without a row is reported on its own.
                if Row::of(library).is_some_and(|to| !row.allows(to, kind)) {
                    found.push(format!(
                        "{name} -> {library} ({}): it may use {}",
                        place(kind),
                        row.rule(kind)
                    ));
                }
                continue;
            }
            for Guard(families, users) in GUARDED.iter().filter(|guard| guard.covers(library)) {
                if !users.contains(&name) {
                    found.push(format!(
                        "{name} -> {library} ({}): {} is for {} alone",
                        place(kind),
                        families[0],
                        users.join(", ")
                    ));
                }
            }
        }
    }
    Ok(found)
}

fn place(kind: Kind) -> &'static str {
    match kind {
        Kind::Code | Kind::Optional => "dependencies",
        Kind::Build => "build-dependencies",
        Kind::Tests => "dev-dependencies",
    }
}

fn array<'a>(value: &'a Value, key: &str) -> Outcome<&'a Vec<Value>> {
    let array = value[key].as_array();
    array.ok_or_else(|| format!("cargo metadata: no list `{key}`").into())
}

fn text<'a>(value: &'a Value, key: &str) -> Outcome<&'a str> {
    let text = value[key].as_str();
    text.ok_or_else(|| format!("cargo metadata: no text `{key}`").into())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// The violations of a workspace of `members` in which `from` depends on `to`.
    /// `kind` is as in cargo's metadata, where "" is null: a plain dependency; or "optional".
    fn edge(members: &[&str], from: &str, to: &str, kind: &str) -> Vec<String> {
        let optional = kind == "optional";
        let kind = (!kind.is_empty() && !optional).then_some(kind);
        let packages: Vec<Value> = members
            .iter()
            .map(|&name| {
                let dependency = json!({"name": to, "kind": kind, "optional": optional});
                let dependencies = if name == from {
                    vec![dependency]
                } else {
                    vec![]
                };
                json!({"name": name, "dependencies": dependencies})
            })
            .collect();
        violations(&json!({ "packages": packages })).unwrap()
    }

    fn between(from: &str, to: &str, kind: &str) -> Vec<String> {
        edge(&[from, to], from, to, kind)
    }

    #[test]
    fn edges_of_the_table_are_allowed() {
        for (from, to, kind) in [
            ("hair-io", "hair-sim", ""),
            ("hair-io", "mesh-io", ""),
            ("mesh-io", "portable-math", ""),
            ("effects", "stroke-path", ""),
            ("effects", "effects-build", "build"),
            ("effects-builtin", "effects", ""),
            ("effects-builtin", "effects-build", "build"),
            ("effect-vendor", "effects", ""),
            ("effect-vendor", "effects-testkit", "dev"),
            ("effect-vendor", "inkstrand", "dev"),
            ("effect-vendor", "inkstrand", "optional"),
            ("render", "effects", ""),
            ("render", "portable-math", ""),
            ("render", "effects-builtin", "dev"),
            ("render", "reference", "dev"),
            ("reference", "render", ""),
            ("stage", "hair-sim", ""),
            ("stage", "render", ""),
            ("inkstrand", "stage", ""),
            ("embed-wgpu", "stage", ""),
            ("bench", "stroke-path", ""),
        ] {
            assert_eq!(between(from, to, kind), [""; 0], "{from} -> {to} ({kind})");
        }
    }

    #[test]
    fn forbidden_edges_are_found() {
        for (from, to, kind) in [
            ("hair-sim", "stroke-path", ""),
            ("stroke-path", "hair-sim", ""),
            ("stroke-path", "effects", "dev"),
            ("hair-io", "stroke-path", ""),
            ("mesh-io", "hair-io", ""),
            ("effects", "render", ""),
            ("effects", "render", "dev"),
            ("effects", "effects-build", ""),
            ("render", "hair-sim", ""),
            ("render", "stage", ""),
            ("render", "effects-builtin", ""),
            ("render", "effects-build", "build"),
            ("effect-vendor", "stroke-path", ""),
            ("effect-vendor", "inkstrand", ""),
            ("effect-vendor", "stage", "optional"),
            ("render", "hair-sim", "optional"),
            ("inkstrand", "effect-vendor", ""),
            ("embed-wgpu", "inkstrand", ""),
            ("render", "bench", "dev"),
            ("reference", "stage", ""),
            ("stage", "reference", ""),
            ("stage", "inkstrand", "dev"),
            ("stage", "effects-build", ""),
            ("bench", "inkstrand", ""),
            ("bench", "xtask", "dev"),
            ("xtask", "hair-sim", ""),
            ("xtask", "hair-sim", "dev"),
            ("xtask", "effects-build", "build"),
        ] {
            let found = between(from, to, kind);
            assert_eq!(found.len(), 1, "{from} -> {to} ({kind}): {found:?}");
            assert!(found[0].starts_with(&format!("{from} -> {to} (")));
        }
    }

    #[test]
    fn a_violation_says_what_is_allowed() {
        assert_eq!(
            between("render", "hair-sim", ""),
            ["render -> hair-sim (dependencies): it may use effects, stroke-path, portable-math"]
        );
    }

    #[test]
    fn a_crate_without_a_row_is_an_error() {
        let found = between("hair-magic", "hair-sim", "");
        assert_eq!(
            found,
            ["hair-magic has no layer: add it to the table in xtask/src/layers.rs"]
        );
    }

    #[test]
    fn families_of_libraries_are_guarded() {
        for (from, library, kind) in [
            ("stage", "wgpu", ""),
            ("inkstrand", "wgpu-core", "dev"),
            ("effects-builtin", "naga", "build"),
            ("effects-builtin", "naga-rust-rt", ""),
            ("inkstrand", "eframe", ""),
            ("render", "winit", ""),
            ("render", "egui_kittest", "dev"),
        ] {
            let found = edge(&[from], from, library, kind);
            assert_eq!(found.len(), 1, "{from} -> {library} ({kind}): {found:?}");
        }
        for (from, library) in [
            ("render", "wgpu"),
            ("embed-wgpu", "wgpu"),
            ("embed-wgpu", "winit"),
            ("effects", "naga-rust-rt"),
            ("effects-build", "naga"),
            ("viewer", "eframe"),
            ("stage", "nagare"),
            ("stage", "glam"),
        ] {
            assert_eq!(edge(&[from], from, library, ""), [""; 0]);
        }
    }

    #[test]
    fn metadata_that_cannot_be_read_is_an_error() {
        for metadata in [
            json!({}),
            json!({"packages": []}),
            json!({"packages": [{"name": "stage"}]}),
        ] {
            assert!(violations(&metadata).is_err(), "{metadata}");
        }
    }

    #[test]
    fn rows_name_crates_of_rows_before_them() {
        for (place, Row(_, name, uses, build)) in TABLE.iter().enumerate() {
            let Only(names) = uses else { continue };
            for to in names.iter().chain(*build) {
                let Row(_, to_row, ..) = Row::of(to).unwrap();
                let is_before = TABLE[..place].iter().any(|Row(_, row, ..)| row == to_row);
                assert!(is_before, "{name} -> {to}");
            }
        }
    }
}
