//! One WGSL source per effect: this crate runs in an effect crate's `build.rs`, validates the effect
//! with naga and translates it to Rust, so that the same text draws on the GPU and on the CPU.
//!
//! ```no_run
//! // build.rs of an effect crate
//! effects_build::effect("src/backlight.wgsl");
//! ```
//!
//! The effect's `.rs` then begins with `effects::effect!("backlight");`. What a source looks like:
//!
//! ```
//! let source = r#"
//! //! inputs: clump_radius, clump_color
//! struct Params {
//!     /// Width of the line.
//!     /// @unit 1/300 head height @range 0..100 @default 2.2
//!     width: f32,
//! }
//! fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
//!     return Stroke(vec2<f32>(0.0), joint.clump_radius + params.width, 0.0, joint.clump_color);
//! }
//! "#;
//! let rust = effects_build::translate_effect(source, "src/line.wgsl")?;
//! assert!(rust.contains("impl ::effects::Program for Program"));
//!
//! // Mistakes are told at their place in the author's own file.
//! let mistaken = source.replace("params.width", "params.with");
//! let error = effects_build::translate_effect(&mistaken, "src/line.wgsl").unwrap_err();
//! assert!(error.to_string().starts_with("src/line.wgsl:9:"));
//! # Ok::<(), effects_build::BuildError>(())
//! ```
//!
//! What joints offer is one table: `inputs.rs`.

#![allow(clippy::print_stdout, reason = "cargo reads what build scripts print")]

mod check;
mod choices;
mod compose;
mod depth;
mod error;
mod generate;
mod inputs;
mod params;
mod places;
mod repair;

use std::path::{Path, PathBuf};

pub use error::BuildError;

/// Translates the effect at `path` (relative to the crate) into `$OUT_DIR/NAME.rs`.
///
/// Ends the build with naga's message at the author's own file, line and column when the source is
/// not a valid effect. For use in `build.rs` only.
pub fn effect(path: &str) {
    build(path, compose::Entry::Effect);
}

/// Translates the clump's source at `path` into `$OUT_DIR/NAME.rs`. For the crate `effects` alone.
pub fn clump(path: &str) {
    build(path, compose::Entry::Clump);
}

/// Translates the prelude into `$OUT_DIR/prelude.rs`. For the crate `effects` alone.
pub fn prelude() {
    let path = Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../shaders/prelude.wgsl"
    ));
    println!("cargo::rerun-if-changed={}", path.display());
    write("prelude", generate::prelude());
}

/// Writes `$OUT_DIR/inputs.rs`, the table of what a joint offers as a macro. For the crate `effects` alone.
pub fn inputs() {
    write("inputs", Ok(inputs::for_each_input().to_string()));
}

fn build(path: &str, entry: compose::Entry) {
    let file = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default()).join(path);
    println!("cargo::rerun-if-changed={}", file.display());
    let name = file
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let translated = std::fs::read_to_string(&file)
        .map_err(|error| BuildError(format!("{path}: {error}")))
        .and_then(|author| translate(&author, path, entry));
    write(&name, translated);
}

fn write(name: &str, translated: Result<String, BuildError>) {
    let out = PathBuf::from(std::env::var_os("OUT_DIR").unwrap_or_default());
    let written = translated.and_then(|rust| {
        let file = out.join(format!("{name}.rs"));
        std::fs::write(&file, rust)
            .map_err(|error| BuildError(format!("{}: {error}", file.display())))
    });
    if let Err(error) = written {
        for line in error.to_string().lines() {
            println!("cargo::error={line}");
        }
        std::process::exit(1);
    }
}

/// The effect `author` (named `path` in messages) as Rust source.
///
/// # Errors
///
/// When naga refuses it, it uses what the CPU cannot answer alike, or its parameters lack a default.
pub fn translate_effect(author: &str, path: &str) -> Result<String, BuildError> {
    translate(author, path, compose::Entry::Effect)
}

fn translate(author: &str, path: &str, entry: compose::Entry) -> Result<String, BuildError> {
    let source = compose::compose(author, path, entry)?;
    let (module, info) = check::parse(&source)?;
    let paints = check::entry_points(&module, &source, entry)?;
    check::builtins(&module, &info, &source)?;
    let params = params::read(&module, &source)?;
    generate::effect(module, &source, &params, entry, paints)
}
