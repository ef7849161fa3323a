//! The text that naga sees: the author's source first, so that lines and columns are the author's own,
//! then the declared inputs, then the prelude. WGSL does not care about order.

use crate::error::BuildError;
use crate::inputs::{INPUTS, Input, Offered};
use naga::Span;
use std::fmt::Write as _;

/// The WGSL that every effect is composed with.
pub(crate) const PRELUDE: &str = include_str!("../../../shaders/prelude.wgsl");

/// What the source is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Entry {
    /// `fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke`
    Effect,
    /// `fn clump(joint: Inputs, params: Params) -> Clump`
    Clump,
}

impl Entry {
    fn offers(self, input: &Input) -> bool {
        match self {
            Self::Effect => true,
            Self::Clump => input.offered == Offered::Both,
        }
    }
}

/// A composed source.
pub(crate) struct Source {
    /// The author's file, for messages.
    pub path: String,
    /// The author's text, then ours.
    pub text: String,
    /// Bytes of the author's.
    pub author_length: usize,
    /// The declared inputs, in the order of [`INPUTS`].
    pub inputs: Vec<&'static Input>,
}

impl Source {
    /// An error at a place of the text.
    pub fn error(&self, span: Span, message: impl std::fmt::Display) -> BuildError {
        let place = span.location(&self.text);
        BuildError(format!(
            "{}:{}:{}: {message}",
            self.path, place.line_number, place.line_position
        ))
    }
}

pub(crate) fn compose(author: &str, path: &str, entry: Entry) -> Result<Source, BuildError> {
    let inputs = declared_inputs(author, path, entry)?;
    let mut text = String::from(author);
    text.push_str("\nstruct Inputs {\n");
    for input in &inputs {
        let _ = writeln!(text, "    {}: {},", input.name, input.ty.in_wgsl());
    }
    text.push_str("}\n");
    text.push_str(PRELUDE);
    Ok(Source {
        path: path.to_owned(),
        text,
        author_length: author.len(),
        inputs,
    })
}

/// The inputs named by the author's line `//! inputs: a, b`.
fn declared_inputs(
    author: &str,
    path: &str,
    entry: Entry,
) -> Result<Vec<&'static Input>, BuildError> {
    let declaration = author.lines().enumerate().find_map(|(number, line)| {
        let names = line
            .trim_start()
            .strip_prefix("//!")?
            .trim_start()
            .strip_prefix("inputs:")?;
        Some((number + 1, line, names))
    });
    let offered = || INPUTS.iter().filter(|input| entry.offers(input));
    let all_names = || {
        offered()
            .map(|input| input.name)
            .collect::<Vec<_>>()
            .join(", ")
    };
    let Some((line_number, line, names)) = declaration else {
        return Err(BuildError(format!(
            "{path}:1:1: the first line must declare what is read of a joint, such as \
             `//! inputs: clump_radius, clump_color`; there are: {}",
            all_names()
        )));
    };
    let names: Vec<&str> = names.split(',').map(str::trim).collect();
    for name in &names {
        if !offered().any(|input| input.name == *name) {
            let column = line.find(name).unwrap_or(0) + 1;
            return Err(BuildError(format!(
                "{path}:{line_number}:{column}: there is no input `{name}`; there are: {}",
                all_names()
            )));
        }
    }
    Ok(offered()
        .filter(|input| names.contains(&input.name))
        .collect())
}
