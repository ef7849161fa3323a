//! The text that naga sees: the author's source first, so that lines and columns are the author's own,
//! then the declared inputs, of joints and of samples, then what the crate's effects share, then the prelude. WGSL does not care about
//! order.

use crate::error::BuildError;
use crate::inputs::{INPUTS, Input, Offered, SAMPLE_INPUTS};
use naga::Span;
use std::fmt::Write as _;
use std::ops::Range;

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

/// WGSL that several effects of a crate share.
#[derive(Clone, Copy)]
pub(crate) struct Shared<'a> {
    /// Its file, for messages.
    pub path: &'a str,
    pub text: &'a str,
}

/// A composed source.
pub(crate) struct Source {
    /// The author's file, for messages.
    pub path: String,
    /// The author's text, then ours.
    pub text: String,
    /// Bytes of the author's.
    pub author_length: usize,
    /// The file that is shared with other effects, and where its bytes are.
    pub shared: Option<(String, Range<usize>)>,
    /// The declared inputs, in the order of [`INPUTS`].
    pub inputs: Vec<&'static Input>,
    /// What is declared of a sample, in the order of [`SAMPLE_INPUTS`]; nothing where the effect doesn't paint.
    pub sample_inputs: Option<Vec<&'static Input>>,
    /// Whether it paints meshes and has no strokes.
    pub is_for_meshes: bool,
}

impl Source {
    /// An error at a place of the text.
    pub fn error(&self, span: Span, message: impl std::fmt::Display) -> BuildError {
        let (path, text, span) = match &self.shared {
            Some((path, bytes)) if self.is_shared(span) => {
                let own = span.to_range().unwrap_or_default();
                let [start, end] = [own.start, own.end.min(bytes.end)];
                let span = Span::new((start - bytes.start) as u32, (end - bytes.start) as u32);
                (path, &self.text[bytes.clone()], span)
            }
            _ => (&self.path, &self.text[..], span),
        };
        let place = span.location(text);
        BuildError(format!(
            "{path}:{}:{}: {message}",
            place.line_number, place.line_position
        ))
    }

    /// Whether a place is in the file that is shared.
    pub fn is_shared(&self, span: Span) -> bool {
        let bytes = self.shared.as_ref().map(|(_, bytes)| bytes);
        let start = span.to_range().map(|own| own.start);
        bytes.is_some_and(|bytes| start.is_some_and(|start| bytes.contains(&start)))
    }

    /// Appends what is shared, and the prelude.
    fn finish(mut self, shared: Option<Shared>) -> Self {
        if let Some(Shared { path, text }) = shared {
            let start = self.text.len();
            self.text.push_str(text);
            self.shared = Some((path.to_owned(), start..self.text.len()));
            self.text.push('\n');
        }
        self.text.push_str(PRELUDE);
        self
    }
}

pub(crate) fn compose(
    author: &str,
    path: &str,
    shared: Option<Shared>,
    entry: Entry,
) -> Result<Source, BuildError> {
    let samples_of = |others: Offered| {
        let offered = SAMPLE_INPUTS.iter();
        offered.filter(move |input| input.offered != others)
    };
    if entry == Entry::Effect
        && let Some(inputs) = declared(author, path, "mesh", samples_of(Offered::ToHair).collect())?
    {
        if let Some(line) = (author.lines()).position(|line| key_of(line) == Some("inputs")) {
            return Err(BuildError(format!(
                "{path}:{}:1: an effect draws strokes (`//! inputs:`) or paints meshes (`//! mesh:`), not both",
                line + 1
            )));
        }
        let mut text = String::from(author);
        structure(&mut text, "Sample", &inputs);
        let source = Source {
            path: path.to_owned(),
            text,
            author_length: author.len(),
            shared: None,
            inputs: Vec::new(),
            sample_inputs: Some(inputs),
            is_for_meshes: true,
        };
        return Ok(source.finish(shared));
    }
    let offered = INPUTS.iter().filter(|input| entry.offers(input)).collect();
    let Some(inputs) = declared(author, path, "inputs", offered)? else {
        return Err(BuildError(format!(
            "{path}:1:1: the first line must declare what is read of a joint, such as \
             `//! inputs: clump_radius, clump_color`, or of a mesh, such as `//! mesh: color, normal`; of joints there are: {}",
            names(INPUTS.iter().filter(|input| entry.offers(input)))
        )));
    };
    let sample_inputs = match entry {
        Entry::Effect => {
            let offered = samples_of(Offered::ToMeshes).collect();
            declared(author, path, "sample", offered)?
        }
        Entry::Clump => None,
    };
    let mut text = String::from(author);
    structure(&mut text, "Inputs", &inputs);
    if let Some(inputs) = &sample_inputs {
        structure(&mut text, "Sample", inputs);
    }
    let source = Source {
        path: path.to_owned(),
        text,
        author_length: author.len(),
        shared: None,
        inputs,
        sample_inputs,
        is_for_meshes: false,
    };
    Ok(source.finish(shared))
}

/// What a line `//! KEY: a, b` declares.
fn key_of(line: &str) -> Option<&str> {
    let words = line.trim_start().strip_prefix("//!")?;
    Some(words.split_once(':')?.0.trim())
}

fn structure(text: &mut String, name: &str, inputs: &[&Input]) {
    let _ = writeln!(text, "\nstruct {name} {{");
    for input in inputs {
        let _ = writeln!(text, "    {}: {},", input.name, input.ty.in_wgsl());
    }
    text.push_str("}\n");
}

/// The inputs named by the author's line `//! inputs: a, b`, `//! sample: a, b` or `//! mesh: a, b`, in the order of those offered.
fn declared(
    author: &str,
    path: &str,
    key: &str,
    offered: Vec<&'static Input>,
) -> Result<Option<Vec<&'static Input>>, BuildError> {
    let declaration = author.lines().enumerate().find_map(|(number, line)| {
        let words = line.trim_start().strip_prefix("//!")?.trim_start();
        let names = words.strip_prefix(key)?.strip_prefix(':')?;
        Some((number + 1, line, names))
    });
    let Some((line_number, line, listed)) = declaration else {
        return Ok(None);
    };
    let listed: Vec<&str> = listed.split(',').map(str::trim).collect();
    for name in &listed {
        if !offered.iter().any(|input| input.name == *name) {
            let column = line.find(name).unwrap_or(0) + 1;
            let what = match key {
                "inputs" => "input",
                "mesh" => "input of meshes",
                _ => "sample input",
            };
            return Err(BuildError(format!(
                "{path}:{line_number}:{column}: there is no {what} `{name}`; there are: {}",
                names(offered.into_iter())
            )));
        }
    }
    let is_listed = |input: &&'static Input| listed.contains(&input.name);
    Ok(Some(offered.into_iter().filter(is_listed).collect()))
}

fn names(inputs: impl Iterator<Item = &'static Input>) -> String {
    inputs
        .map(|input| input.name)
        .collect::<Vec<_>>()
        .join(", ")
}
