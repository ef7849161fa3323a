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
    build(path, None, compose::Entry::Effect);
}

/// As [`effect`], with the functions and constants of the file `shared` (relative to the crate), which several effects of a crate
/// have in common. It has no parameters and declares no inputs.
///
/// ```no_run
/// // build.rs of an effect crate
/// effects_build::effect_with("src/pen.wgsl", "src/hand.wgsl");
/// effects_build::effect_with("src/chalk.wgsl", "src/hand.wgsl");
/// ```
pub fn effect_with(path: &str, shared: &str) {
    build(path, Some(shared), compose::Entry::Effect);
}

/// Translates the clump's source at `path` into `$OUT_DIR/NAME.rs`. For the crate `effects` alone.
pub fn clump(path: &str) {
    build(path, None, compose::Entry::Clump);
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

fn build(path: &str, shared: Option<&str>, entry: compose::Entry) {
    let name = Path::new(path).file_stem().unwrap_or_default();
    let translated = || {
        let author = read(path)?;
        match shared {
            Some(shared) => {
                let text = &read(shared)?;
                let shared = compose::Shared { path: shared, text };
                translate(&author, path, Some(shared), entry)
            }
            None => translate(&author, path, None, entry),
        }
    };
    write(&name.to_string_lossy(), translated());
}

/// A file of the crate's, which is translated anew where it changes.
fn read(path: &str) -> Result<String, BuildError> {
    let file = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default()).join(path);
    println!("cargo::rerun-if-changed={}", file.display());
    std::fs::read_to_string(&file).map_err(|error| BuildError(format!("{path}: {error}")))
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
    translate(author, path, None, compose::Entry::Effect)
}

fn translate(
    author: &str,
    path: &str,
    shared: Option<compose::Shared>,
    entry: compose::Entry,
) -> Result<String, BuildError> {
    let source = compose::compose(author, path, shared, entry)?;
    let (module, info) = check::parse(&source)?;
    let paints = check::entry_points(&module, &source, entry)?;
    check::builtins(&module, &info, &source)?;
    let params = params::read(&module, &source)?;
    generate::effect(module, &source, &params, entry, paints)
}

#[cfg(test)]
mod tests {
    use super::*;
    use compose::{Entry, Shared};

    const PEN: &str = "//! inputs: u\nstruct Params {\n    /// A width.\n    /// @range 0..1 @default 0.5\n    width: f32,\n}\n\
        fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {\n    \
        return Stroke(vec2<f32>(0.0), params.width * press(joint.u), 0.0, vec3<f32>(1.0));\n}\n";

    fn with(shared: &str) -> Result<String, BuildError> {
        let shared = Shared {
            path: "src/hand.wgsl",
            text: shared,
        };
        translate(PEN, "src/pen.wgsl", Some(shared), Entry::Effect)
    }

    #[test]
    fn what_is_shared_is_there_and_its_mistakes_are_told_at_their_place() {
        let right = "// A hand.\n\nfn press(u: f32) -> f32 {\n    return u * random(1u, 2u);\n}";
        let rust = with(right).unwrap();
        assert!(
            rust.contains("fn press(") && rust.contains("random("),
            "{rust}"
        );
        let places = [
            ("u * random(1u, 2u)", "u * heavily", "src/hand.wgsl:4:16: "),
            ("u * random(1u, 2u)", "true", "src/hand.wgsl:4:"),
            (
                "u * random(1u, 2u)",
                "sin(u)",
                "src/hand.wgsl:4:12: `sin` is not available",
            ),
            ("fn press(u: f32)", "fn press(u f32)", "src/hand.wgsl:3:"),
        ];
        for (from, to, place) in places {
            let error = with(&right.replace(from, to)).unwrap_err().to_string();
            assert!(error.starts_with(place), "{error}\nin place of\n{place}");
        }
        // Those of the effect itself stay at theirs.
        let error = with("// Nothing.").unwrap_err().to_string();
        assert!(error.starts_with("src/pen.wgsl:8:50: "), "{error}");
    }
}
