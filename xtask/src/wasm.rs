//! Everything below the programs compiles for the web as well.

use std::process::Command;

use crate::Outcome;
use crate::program::{cargo, on_ci, succeed};

/// The web's target.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// The tops of the layers below the programs: they pull in all the others, but for `document`, which watches files, and `effects-testkit`, which tests use alone.
const TOPS: &[&str] = &[
    "stage",
    "reference",
    "effects-builtin",
    "effects-cartoon",
    "effects-surface",
];

/// Checks them, where the target is installed: nothing is linked there that code would be made for.
///
/// # Errors
/// One doesn't compile, or the target is missing where `CI=true`.
pub fn check() -> Outcome {
    if !is_installed() {
        let message = format!("{TARGET} is not installed: `cargo xtask setup` installs it");
        if on_ci() {
            return Err(message.into());
        }
        println!("SKIPPED: {message}");
        return Ok(());
    }
    let mut check = cargo(&["check", "--target", TARGET]);
    for top in TOPS {
        check.args(["--package", top]);
    }
    succeed(check)
}

/// True if the toolchain that runs this task can build for the web.
pub fn is_installed() -> bool {
    let folder = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", TARGET])
        .output();
    folder.is_ok_and(|output| {
        let path = String::from_utf8_lossy(&output.stdout);
        std::path::Path::new(path.trim()).is_dir()
    })
}
