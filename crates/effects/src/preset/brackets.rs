//! Whether all brackets of a text are closed, and where one was most likely forgotten.

use super::syntax::{Kind, Mistake, mistake, token};

/// A bracket: the end of the text that begins with it, and where it stands.
#[derive(Clone, Copy)]
struct Bracket<'a> {
    at: &'a str,
    line: usize,
    /// Of its line.
    indentation: usize,
    /// Whether nothing but white space is before it on its line.
    is_first: bool,
}

impl<'a> Bracket<'a> {
    fn text(&self) -> &'a str {
        &self.at[..1]
    }

    fn closing(&self) -> &'static str {
        match self.text() {
            "(" => ")",
            "[" => "]",
            _ => "}",
        }
    }
}

/// An opening bracket and the one that closes it, or should.
type Pair<'a> = (Bracket<'a>, Bracket<'a>);

/// Checks that all brackets, texts and comments of a `text` are closed, and that nothing comes after its end: without that there are
/// no parts to look at. Messages call the whole `what`, such as "preset".
pub(super) fn check_brackets<'a>(what: &str, text: &'a str) -> Result<(), Mistake<'a>> {
    let mut open: Vec<Bracket> = Vec::new();
    // The first pairs that look wrong, to be named where the whole does not fit.
    let mut missing: Option<Pair> = None;
    let mut extra: Option<Pair> = None;
    let mut end: Option<Bracket> = None;
    let mut lines = Lines::new(text);
    let mut rest = text;
    while let Some((piece, after)) = token(rest)? {
        let here = lines.bracket(rest.len() - after.len() - piece.text.len());
        lines.pass(piece.text.len());
        rest = after;
        if let Some(end) = end {
            return match extra {
                Some(pair) => too_many(pair),
                None => mistake(
                    here.at,
                    format!(
                        "this comes after the end of the {what}, the bracket of line {}",
                        end.line
                    ),
                ),
            };
        }
        match piece.kind {
            Kind::Open => open.push(here),
            Kind::Close => {
                let Some(opened) = open.pop() else {
                    return mistake(here.at, format!("this `{}` closes nothing", piece.text));
                };
                let pair = (opened, here);
                if opened.closing() != piece.text {
                    return match (missing, extra) {
                        (Some(pair), _) => forgotten(pair),
                        (None, Some(pair)) => too_many(pair),
                        (None, None) => mismatch(pair),
                    };
                }
                if here.is_first && here.indentation < opened.indentation {
                    missing.get_or_insert(pair);
                } else if !here.is_first && opened.line < here.line {
                    extra.get_or_insert(pair);
                }
                if open.is_empty() {
                    end = Some(here);
                }
            }
            _ if open.is_empty() => {
                let found: String = piece.text.chars().take(40).collect();
                return mistake(
                    here.at,
                    format!("a {what} begins with `(`, found `{found}`"),
                );
            }
            _ => {}
        }
    }
    match (open.pop(), missing) {
        (None, _) => Ok(()),
        (Some(_), Some(pair)) => forgotten(pair),
        (Some(opened), None) => mistake(
            opened.at,
            format!(
                "this `{}` is not closed before the file ends: a `{}` is missing",
                opened.text(),
                opened.closing()
            ),
        ),
    }
}

/// Lines and indentations on a walk through the text, each character looked at once.
struct Lines<'a> {
    rest: &'a str,
    line: usize,
    indentation: usize,
    is_first: bool,
}

impl<'a> Lines<'a> {
    fn new(text: &'a str) -> Self {
        Self {
            rest: text,
            line: 1,
            indentation: indentation(text),
            is_first: true,
        }
    }

    /// Walks on by `length`.
    fn pass(&mut self, length: usize) {
        let (passed, rest) = self.rest.split_at(length);
        self.rest = rest;
        if let Some(end) = passed.rfind('\n') {
            self.line += passed.matches('\n').count();
            let line = &passed[end + 1..];
            self.is_first = line.trim().is_empty();
            self.indentation = if self.is_first {
                line.len() + indentation(rest)
            } else {
                indentation(line)
            };
        } else {
            self.is_first &= passed.trim().is_empty();
        }
    }

    /// The place `distance` from here.
    fn bracket(&mut self, distance: usize) -> Bracket<'a> {
        self.pass(distance);
        Bracket {
            at: self.rest,
            line: self.line,
            indentation: self.indentation,
            is_first: self.is_first,
        }
    }
}

fn indentation(line: &str) -> usize {
    line.len() - line.trim_start_matches([' ', '\t']).len()
}

/// A pair whose second is indented less than the line of its first: that one belongs to another.
fn forgotten((open, close): Pair<'_>) -> Result<(), Mistake<'_>> {
    mistake(
        open.at,
        format!(
            "is this `{}` not closed? By its indentation, the `{}` of line {} closes another one",
            open.text(),
            close.text(),
            close.line
        ),
    )
}

/// A pair whose second stands within a later line, where a bracket was perhaps written once too often.
fn too_many((open, close): Pair<'_>) -> Result<(), Mistake<'_>> {
    mistake(
        close.at,
        format!(
            "is this `{}` one too many? It closes the `{}` of line {}, and what comes later does \
             not fit",
            close.text(),
            open.text(),
            open.line
        ),
    )
}

/// Two brackets that don't fit. Where the second stands tells which one the author meant otherwise.
fn mismatch((open, close): Pair<'_>) -> Result<(), Mistake<'_>> {
    let (opening, closing, right) = (open.text(), close.text(), open.closing());
    let (first, second) = (open.line, close.line);
    if close.is_first && close.indentation == open.indentation {
        let message =
            format!("write `{right}`, for the `{opening}` of line {first}, not `{closing}`");
        mistake(close.at, message)
    } else if !close.is_first && first != second {
        mistake(
            close.at,
            format!(
                "this `{closing}` comes before the `{opening}` of line {first} is closed: is it one \
                 too many, or a `{right}` missing?"
            ),
        )
    } else {
        mistake(
            open.at,
            format!(
                "this `{opening}` is not closed before the `{closing}` of line {second}: is a \
                 `{right}` missing?"
            ),
        )
    }
}
