//! Runs cargo, and the inkstrand program that it builds.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};

use serde_json::Value;

use crate::Outcome;

/// The root of the project.
pub fn root() -> &'static Path {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask)
}

/// The cargo that runs this task, in the project's root.
pub fn cargo(args: &[&str]) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(args).current_dir(root());
    command
}

/// Every crate, and the programs of the example effects.
pub const WORKSPACE: [&str; 2] = [
    "--workspace",
    "--features=effect-backlight/viewer,effect-engraving/program",
];

/// True on the machines that test the project by themselves: `CI=true`.
pub fn on_ci() -> bool {
    env::var_os("CI").is_some_and(|value| value == "true")
}

/// Runs a command to its end, its output going where ours goes.
pub fn succeed(mut command: Command) -> Outcome {
    let status = command
        .status()
        .map_err(|error| format!("cannot start {}: {error}", line_of(&command)))?;
    if status.success() {
        return Ok(());
    }
    Err(format!("{}: {status}", line_of(&command)).into())
}

/// A command as one would type it.
pub fn line_of(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_stem().unwrap_or(program.as_os_str());
    let mut line = name.to_string_lossy().into_owned();
    for arg in command.get_args() {
        line.push(' ');
        line.push_str(&arg.to_string_lossy());
    }
    line
}

/// The inkstrand program, as the developers' profile builds it: its hot crates are optimised
/// there too, and the tests use the same build.
#[derive(Debug)]
pub struct Inkstrand(PathBuf);

/// Whether the program is the one that was built with the tests.
static IS_FROM_TESTS: AtomicBool = AtomicBool::new(false);

impl Inkstrand {
    /// From now on takes the program that the tests of the workspace are built with. By itself it would be built with
    /// fewer features of its libraries, all of them once more.
    pub fn take_from_tests() {
        IS_FROM_TESTS.store(true, Ordering::Relaxed);
    }

    /// Builds the program. Compiler messages go to our stderr.
    ///
    /// # Errors
    /// The program doesn't compile, or cargo doesn't say where it put it.
    pub fn build() -> Outcome<Self> {
        let alone = ["build", "--package=inkstrand", "--bin=inkstrand"];
        build("inkstrand", "bin", &alone).map(Self)
    }

    /// Builds the program as its users do, in release.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub fn build_release() -> Outcome<Self> {
        let release = [
            "build",
            "--release",
            "--package=inkstrand",
            "--bin=inkstrand",
        ];
        let messages = messages_of(cargo(&release))?;
        let program = program_of(&messages, "inkstrand", "bin");
        program
            .map(Self)
            .ok_or_else(|| "cargo built inkstrand and named no program".into())
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// What presets may say: `inkstrand effects --json`.
    ///
    /// # Errors
    /// The program fails, or writes no JSON.
    pub fn schema(&self) -> Outcome<Value> {
        let output = Command::new(&self.0).args(["effects", "--json"]).output()?;
        finished(&output)?;
        Ok(serde_json::from_slice(&output.stdout)?)
    }

    /// `inkstrand render ARGS -o picture --quiet`, run in the project's root.
    ///
    /// # Errors
    /// The program fails, with its own message, or writes no file at `picture`.
    pub fn render<S: AsRef<str>>(&self, args: &[S], picture: &Path) -> Outcome {
        let mut command = Command::new(&self.0);
        command
            .arg("render")
            .args(args.iter().map(AsRef::as_ref))
            .arg("-o")
            .arg(picture)
            .arg("--quiet")
            .current_dir(root());
        let output = command
            .output()
            .map_err(|error| format!("cannot start {}: {error}", self.0.display()))?;
        finished(&output)?;
        if picture.is_file() {
            return Ok(());
        }
        Err(format!("{}: success, but no picture", line_of(&command)).into())
    }
}

/// Builds the program that `cargo xtask fuzz` lets read files, and says where it is.
///
/// # Errors
/// It doesn't compile, or cargo doesn't say where it put it.
pub fn fuzz_target() -> Outcome<PathBuf> {
    let alone = ["build", "--package=stage", "--example=fuzz_target"];
    build("fuzz_target", "example", &alone)
}

/// Builds a program, with the tests of the workspace or by the arguments for it `alone`. Compiler messages go to our stderr.
fn build(name: &str, kind: &str, alone: &[&str]) -> Outcome<PathBuf> {
    let messages = if IS_FROM_TESTS.load(Ordering::Relaxed) {
        built_with_tests()?
    } else {
        messages_of(cargo(alone))?
    };
    program_of(&messages, name, kind)
        .ok_or_else(|| format!("cargo built {name} and named no program").into())
}

/// Builds all tests of the workspace, and the programs that they run.
///
/// Returns cargo's messages, one JSON object a line. Those of compilers go to our stderr.
///
/// # Errors
/// Something doesn't compile.
pub fn built_with_tests() -> Outcome<String> {
    messages_of(cargo(&[&["test", "--no-run"][..], &WORKSPACE].concat()))
}

/// Builds, and returns cargo's messages.
fn messages_of(mut command: Command) -> Outcome<String> {
    command.arg("--message-format=json-render-diagnostics");
    let output = command.stderr(Stdio::inherit()).output()?;
    if !output.status.success() {
        return Err(format!("{}: {}", line_of(&command), output.status).into());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Where cargo put a program, by its messages: one JSON object a line. Tests of the program are programs too.
fn program_of(messages: &str, name: &str, kind: &str) -> Option<PathBuf> {
    messages
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok())
        .filter(|message| message["target"]["name"] == name)
        .filter(|message| message["target"]["kind"][0] == kind)
        .filter(|message| message["profile"]["test"] == false)
        .find_map(|message| message["executable"].as_str().map(PathBuf::from))
}

/// Ends a run over `total` things by naming those that failed.
///
/// # Errors
/// Some did.
pub fn sum_up(total: usize, failures: &[String]) -> Outcome {
    if failures.is_empty() {
        return Ok(());
    }
    Err(format!(
        "{} of {total} failed: {}",
        failures.len(),
        failures.join(", ")
    )
    .into())
}

/// Whether a command that has ended went well.
///
/// # Errors
/// It failed: what it said.
pub fn finished(output: &Output) -> Outcome {
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    match said.trim() {
        "" => Err(format!("{}, without a message", output.status).into()),
        said => Err(said.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_the_workspace() {
        let manifest = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
        assert!(manifest.contains("[workspace]"));
    }

    #[test]
    fn the_program_is_found_among_what_is_built_for_tests() {
        let message = |kind: &str, is_test: bool, file: &str| {
            let target = serde_json::json!({"name": "inkstrand", "kind": [kind]});
            let profile = serde_json::json!({"test": is_test});
            serde_json::json!({"target": target, "profile": profile, "executable": file})
        };
        let messages = [
            message("lib", true, "tests-of-library"),
            message("bin", true, "tests-of-program"),
            message("bin", false, "program"),
            serde_json::json!({"reason": "build-finished", "success": true}),
        ];
        let lines = messages.map(|message| format!("{message}\n")).concat();
        assert_eq!(
            program_of(&lines, "inkstrand", "bin"),
            Some("program".into())
        );
        assert_eq!(program_of("no JSON", "inkstrand", "bin"), None);
    }

    #[test]
    fn a_command_that_fails_is_named() {
        let error = succeed(cargo(&["no-such-task"])).unwrap_err().to_string();
        assert!(error.starts_with("cargo no-such-task: "), "{error}");
    }

    #[test]
    fn a_failing_render_gives_the_programs_message() {
        // rustc stands in for the program: it knows no option `-o` of ours either.
        let program = Inkstrand("rustc".into());
        let picture = tempfile::tempdir().unwrap().path().join("picture.png");
        let error = program.render(&["no-such.ron"], &picture).unwrap_err();
        assert!(error.to_string().contains("error"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn success_without_a_picture_is_a_failure() {
        let program = Inkstrand("true".into());
        let picture = tempfile::tempdir().unwrap().path().join("picture.png");
        let error = program.render(&["made.ron"], &picture).unwrap_err();
        assert!(error.to_string().contains("no picture"), "{error}");
    }
}
