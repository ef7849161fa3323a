//! Runs the tests of the workspace: as many programs of them at once as there are cores. By itself cargo runs one after
//! the other, and most end with one long test, beside which the other cores do nothing.

use std::io::{self, Read as _, Seek as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use serde_json::Value;

use crate::Outcome;
use crate::program::{self, Inkstrand, WORKSPACE, cargo, succeed, sum_up};
use crate::work;

/// What takes longest, as it builds crates: it begins first.
const LONGEST: &str = "tutorial";

/// A program of tests.
#[derive(Debug, PartialEq)]
struct Tests {
    /// What it tests: package and target.
    name: String,
    file: PathBuf,
    /// The folder of its package, where it runs.
    folder: PathBuf,
}

/// Builds all tests, runs them, then the examples in docs.
///
/// # Errors
/// Tests fail or don't compile. What each program says is printed when it has ended.
pub fn run() -> Outcome {
    Inkstrand::take_from_tests();
    let mut programs = tests_of(&program::built_with_tests()?);
    if programs.is_empty() {
        return Err("cargo tells of no program of tests".into());
    }
    programs.sort_by_key(|tests| !tests.name.ends_with(LONGEST));
    let ends = work::on_all_cores(&programs, "programs of tests", |tests| {
        let start = Instant::now();
        let (said, is_good) = tests.run().unwrap_or_else(|error| {
            let said = format!("cannot start {}: {error}", tests.file.display());
            (said, false)
        });
        let time = start.elapsed().as_secs_f32();
        println!("-- {}, {time:.1} s: {}\n", tests.name, said.trim());
        is_good
    });
    let failures = programs.iter().zip(&ends).filter(|(_, is_good)| !**is_good);
    let mut failures: Vec<String> = failures.map(|(tests, _)| tests.name.clone()).collect();
    let docs = [&["test", "--doc", "--no-fail-fast"][..], &WORKSPACE].concat();
    if let Err(error) = succeed(cargo(&docs)) {
        failures.push(error.to_string());
    }
    sum_up(programs.len() + 1, &failures)
}

/// The programs of tests that cargo tells of in its messages, one JSON object a line.
fn tests_of(messages: &str) -> Vec<Tests> {
    messages
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok())
        .filter(|message| message["profile"]["test"] == true)
        .filter_map(|message| {
            let folder = Path::new(message["manifest_path"].as_str()?).parent()?;
            let package = folder.file_name()?.to_string_lossy();
            let [kind, target] = ["kind", "name"].map(|key| message["target"][key].clone());
            let name = match kind[0].as_str()? {
                "test" => format!("{package}, {}", target.as_str()?),
                kind => format!("{package}, unit tests of {kind}"),
            };
            Some(Tests {
                name,
                file: message["executable"].as_str()?.into(),
                folder: folder.to_owned(),
            })
        })
        .collect()
}

impl Tests {
    /// Runs them to their end, as cargo does. Returns how they ended and what they said, and whether that is a good end.
    fn run(&self) -> io::Result<(String, bool)> {
        // Not a pipe, which would stay open as long as a program does that they have left running.
        let mut said = tempfile::tempfile()?;
        let status = Command::new(&self.file)
            .current_dir(&self.folder)
            .env("CARGO_MANIFEST_DIR", &self.folder)
            .stdin(Stdio::null())
            .stdout(said.try_clone()?)
            .stderr(said.try_clone()?)
            .status()?;
        said.rewind()?;
        let mut bytes = Vec::new();
        said.read_to_end(&mut bytes)?;
        let text = format!("{status}\n{}", String::from_utf8_lossy(&bytes));
        Ok((text, status.success()))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn programs_of_tests_are_found_among_what_is_built() {
        let message = |kind: &str, name: &str, is_test: bool| {
            serde_json::json!({
                "manifest_path": "/a/crates/groom/Cargo.toml",
                "target": {"name": name, "kind": [kind]},
                "profile": {"test": is_test},
                "executable": format!("/a/target/{name}-0123"),
            })
        };
        let messages = [
            message("lib", "groom", false),
            message("lib", "groom", true),
            message("test", "grow", true),
            serde_json::json!({"reason": "build-finished", "success": true}),
        ];
        let lines = messages.map(|message| format!("{message}\n")).concat();
        let found = tests_of(&lines);
        let names: Vec<&str> = found.iter().map(|tests| tests.name.as_str()).collect();
        assert_eq!(names, ["groom, unit tests of lib", "groom, grow"]);
        assert_eq!(found[1].file, Path::new("/a/target/grow-0123"));
        assert_eq!(found[1].folder, Path::new("/a/crates/groom"));
    }

    #[test]
    fn a_program_says_how_it_ends_and_what_it_says() {
        // rustc stands in for them: where it is given nothing it says what it takes.
        let tests = |file: &str| Tests {
            name: "made".to_owned(),
            file: file.into(),
            folder: ".".into(),
        };
        let (said, is_good) = tests("rustc").run().unwrap();
        assert!(is_good && said.lines().count() > 1, "{said}");
        assert!(said.contains("Usage: rustc"), "{said}");
        assert!(tests("no-such-program").run().is_err());
    }

    /// What `test = false` in a manifest would leave out silently.
    #[test]
    fn what_is_built_without_tests_has_none() {
        let metadata = cargo(&["metadata", "--format-version=1", "--no-deps"]).output();
        let metadata: Value = serde_json::from_slice(&metadata.unwrap().stdout).unwrap();
        let packages = metadata["packages"].as_array().unwrap();
        let targets = packages
            .iter()
            .flat_map(|package| package["targets"].as_array().unwrap());
        let mut count = 0;
        for target in targets {
            let kind = target["kind"][0].as_str().unwrap();
            if target["test"] == true || !["bin", "lib"].contains(&kind) {
                continue;
            }
            let root = Path::new(target["src_path"].as_str().unwrap());
            let files = match kind {
                "lib" => files_below(root.parent().unwrap()),
                _ => vec![root.to_owned()],
            };
            for file in files {
                let text = fs::read_to_string(&file).unwrap_or_default();
                assert!(!text.contains("#[test]"), "{}", file.display());
                count += 1;
            }
        }
        assert!(count > 5, "{count}");
    }

    fn files_below(folder: &Path) -> Vec<PathBuf> {
        let paths = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path());
        paths
            .flat_map(|path| match path.is_dir() {
                true => files_below(&path),
                false => vec![path],
            })
            .collect()
    }
}
