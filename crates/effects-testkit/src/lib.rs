//! What every stroke effect must hold to, as tests that an effect crate runs on its own effects:
//!
//! ```
//! use effects_builtin::Silhouette; // yours
//!
//! // #[test]
//! fn it_conforms() {
//!     effects_testkit::assert_conforms::<Silhouette>();
//! }
//!
//! // #[test]
//! fn nothing_pops() {
//!     effects_testkit::assert_steady::<Silhouette>(&[("width", "4")]);
//! }
//! # it_conforms();
//! # nothing_pops();
//! ```
//!
//! [`assert_conforms`] is for all effects that draw strokes, [`assert_mesh_conforms`] for those that paint meshes. [`assert_steady`] is for those whose strokes change little
//! where their inputs do; with a hard step they can't, so it takes the parameters to hold it for.

mod constants;
mod descriptor;
mod hair;
mod joint;
mod motion;
mod paint;
mod paths;
mod repeat;
mod sample;
mod strokes;
mod undeclared;
mod unread;
mod values;
mod wgsl;

use effects::{AnyEffect, MeshEffect, Registry, RegistryError, StrokeEffect};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What is checked, in the order of the checks, and how.
const CHECKS: &[(&str, Check)] = &[
    ("it says what it is", descriptor::words),
    ("its rank and depth offset are a layer's", descriptor::order),
    (
        "its parameters are documented and their defaults allowed",
        descriptor::parameters,
    ),
    (READS, undeclared::check),
    (READS_OF_SAMPLES, paint::reads_what_it_declares),
    (
        "its strokes are finite and not negative, whatever the joint",
        strokes::on_any_joint,
    ),
    (
        "its strokes are finite and not negative, whatever the parameters",
        strokes::with_any_parameters,
    ),
    ("its strokes stay near their strands", strokes::near),
    ("it draws something", strokes::something),
    ("where it draws nothing the radius is 0", strokes::nothing),
    ("its strokes lie where it says", strokes::in_extent),
    (
        "it is the clump, and no nearer, where it says so",
        strokes::clump,
    ),
    (
        "the same joint has the same stroke, bit for bit",
        repeat::check,
    ),
    (
        "what it paints is a colour, whatever the sample and the parameters",
        paint::is_a_color,
    ),
    (
        "the same sample has the same colour, bit for bit",
        paint::is_the_same,
    ),
    (
        "its paths are finite, and the same ones in every frame, and none jumps",
        paths::check,
    ),
    (
        "what its Rust reads doesn't vary along a strand",
        constants::check,
    ),
    ("it declares what it reads, and no more", unread::check),
    ("its Rust is its WGSL", wgsl::check),
    (
        "what it paints in Rust is what its WGSL says",
        wgsl::check_paint,
    ),
];

/// The same of effects for meshes.
const MESH_CHECKS: &[(&str, Check)] = &[
    ("it says what it is", descriptor::words),
    (
        "its parameters are documented and their defaults allowed",
        descriptor::parameters,
    ),
    (READS_OF_SAMPLES, paint::reads_what_it_declares),
    (
        "what it paints is a colour, whatever the sample and the parameters",
        paint::is_a_color,
    ),
    (
        "the same sample has the same colour, bit for bit",
        paint::is_the_same,
    ),
    ("it declares what it reads, and no more", unread::check),
    (
        "what it paints in Rust is what its WGSL says",
        wgsl::check_paint,
    ),
];

/// Where this fails the other checks would say nothing but the same.
const READS: &str = "it reads what it declares, and nothing else";

const READS_OF_SAMPLES: &str = "it reads of a sample what it declares, and nothing else";

type Check = fn(&dyn AnyEffect) -> Result<(), String>;

/// A check that an effect did not pass.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Failure {
    /// What should hold.
    pub check: &'static str,
    /// What does not, and what to do about it.
    pub message: String,
}

/// All checks that an effect did not pass.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Failures {
    /// The effect's id.
    pub effect: &'static str,
    /// At least one.
    pub failures: Vec<Failure>,
}

impl fmt::Display for Failures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.failures.len();
        let noun = if count == 1 { "check" } else { "checks" };
        write!(f, "effect `{}` fails {count} {noun}", self.effect)?;
        for Failure { check, message } in &self.failures {
            write!(f, "\n- {check}:\n  {}", message.replace('\n', "\n  "))?;
        }
        Ok(())
    }
}

impl std::error::Error for Failures {}

/// Panics with all that is wrong with an effect ([`conforms`]).
///
/// # Panics
///
/// When a check fails.
#[track_caller]
pub fn assert_conforms<E: StrokeEffect>() {
    if let Err(failures) = conforms::<E>() {
        panic!("{failures}");
    }
}

/// Holds an effect to what every effect must hold to.
///
/// # Errors
///
/// With all checks that fail, and what is wrong.
pub fn conforms<E: StrokeEffect>() -> Result<(), Failures> {
    with_effect(E::ID, Registry::register::<E>, |effect| {
        all_failures(CHECKS, effect)
    })
}

/// Panics with all that is wrong with an effect for meshes ([`mesh_conforms`]).
///
/// # Panics
///
/// When a check fails.
#[track_caller]
pub fn assert_mesh_conforms<E: MeshEffect>() {
    if let Err(failures) = mesh_conforms::<E>() {
        panic!("{failures}");
    }
}

/// Holds an effect for meshes to what every such effect must hold to.
///
/// # Errors
///
/// With all checks that fail, and what is wrong.
pub fn mesh_conforms<E: MeshEffect>() -> Result<(), Failures> {
    with_effect(E::ID, Registry::register_mesh::<E>, |effect| {
        all_failures(MESH_CHECKS, effect)
    })
}

/// What is wrong with an effect, up to what makes the rest say nothing new.
fn all_failures(checks: &[(&'static str, Check)], effect: &dyn AnyEffect) -> Vec<Failure> {
    let mut failures = Vec::new();
    for (check, run) in checks {
        failures.extend(failure(check, || run(effect)));
        if failures
            .last()
            .is_some_and(|last| [READS, READS_OF_SAMPLES].contains(&last.check))
        {
            break;
        }
    }
    failures
}

/// Panics where strokes jump ([`steady`]).
///
/// # Panics
///
/// When they do.
#[track_caller]
pub fn assert_steady<E: StrokeEffect>(parameters: &[(&str, &str)]) {
    if let Err(failures) = steady::<E>(parameters) {
        panic!("{failures}");
    }
}

/// Holds an effect, with these parameters as `--set` takes them, to strokes that change little where an
/// input does: as the eye, the light or the hair moves, nothing pops.
///
/// Each input in turn runs through its range while the others rest. Where the strokes of two moments
/// differ much, the time between them is halved again and again: a steep slope gets flat, a jump stays.
///
/// # Errors
///
/// With the input that makes the strokes jump and where.
pub fn steady<E: StrokeEffect>(parameters: &[(&str, &str)]) -> Result<(), Failures> {
    with_effect(E::ID, Registry::register::<E>, |effect| {
        let check = "small changes of its inputs change its strokes little";
        failure(check, || motion::check(effect, parameters))
            .into_iter()
            .collect()
    })
}

/// Runs checks on a registered effect.
fn with_effect(
    id: &'static str,
    register: impl FnOnce(&mut Registry) -> Result<(), RegistryError>,
    check: impl FnOnce(&dyn AnyEffect) -> Vec<Failure>,
) -> Result<(), Failures> {
    let mut registry = Registry::new();
    let failures = match register(&mut registry) {
        Ok(()) => registry.get(id).map(check).unwrap_or_default(),
        Err(error) => vec![Failure {
            check: "its id is well formed",
            message: error.to_string(),
        }],
    };
    if failures.is_empty() {
        return Ok(());
    }
    Err(Failures {
        effect: id,
        failures,
    })
}

/// What a check finds wrong; a panic is wrong too.
fn failure(check: &'static str, run: impl FnOnce() -> Result<(), String>) -> Option<Failure> {
    let result = catch_unwind(AssertUnwindSafe(run));
    let message = match result {
        Ok(Ok(())) => return None,
        Ok(Err(message)) => message,
        Err(panic) => format!("it panics: {}", panic_text(panic.as_ref())),
    };
    Some(Failure { check, message })
}

/// What a panic says.
fn panic_text(panic: &dyn std::any::Any) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("without a message")
}
