//! Whether all brackets of a preset are closed, and where one was most likely forgotten.

use super::syntax::{Kind, Mistake, mistake, token};

/// Two brackets that fit, as the ends of the preset that begin with them.
#[derive(Clone, Copy)]
struct Pair<'a> {
    open: &'a str,
    close: &'a str,
}

/// Checks that all brackets, texts and comments of the preset are closed, and that nothing comes
/// after its end: without that there are no parts to look at.
pub(super) fn check_brackets(preset: &str) -> Result<(), Mistake<'_>> {
    let mut open: Vec<&str> = Vec::new();
    // The first pairs that look wrong, to be named where the whole does not fit.
    let mut missing = None;
    let mut extra = None;
    let mut end = None;
    let mut rest = preset;
    while let Some((piece, after)) = token(rest)? {
        let at = &rest[rest.len() - after.len() - piece.text.len()..];
        rest = after;
        if let Some(end) = end {
            if let Some(pair) = extra {
                return too_many(preset, pair);
            }
            let last = line(preset, end);
            return mistake(
                at,
                format!("this comes after the end of the preset, the bracket of line {last}"),
            );
        }
        match piece.kind {
            Kind::Open => open.push(at),
            Kind::Close => {
                let Some(opened) = open.pop() else {
                    return mistake(at, format!("this `{}` closes nothing", piece.text));
                };
                let pair = Pair {
                    open: opened,
                    close: at,
                };
                if closing(opened) != piece.text {
                    return match (missing, extra) {
                        (Some(pair), _) => forgotten(preset, pair),
                        (None, Some(pair)) => too_many(preset, pair),
                        (None, None) => mismatch(preset, pair),
                    };
                }
                match indentation(preset, at) {
                    Some(here) if here < indentation_of_line(preset, opened) => {
                        missing.get_or_insert(pair);
                    }
                    None if opened[..opened.len() - at.len()].contains('\n') => {
                        extra.get_or_insert(pair);
                    }
                    _ => {}
                }
                if open.is_empty() {
                    end = Some(at);
                }
            }
            _ if open.is_empty() => {
                let found: String = piece.text.chars().take(40).collect();
                return mistake(at, format!("a preset begins with `(`, found `{found}`"));
            }
            _ => {}
        }
    }
    match (open.pop(), missing) {
        (None, _) => Ok(()),
        (Some(_), Some(pair)) => forgotten(preset, pair),
        (Some(opened), None) => mistake(
            opened,
            format!(
                "this `{}` is not closed before the file ends: a `{}` is missing",
                &opened[..1],
                closing(opened)
            ),
        ),
    }
}

/// A pair whose second is indented less than the line of its first: that one belongs to another.
fn forgotten<'a>(preset: &str, pair: Pair<'a>) -> Result<(), Mistake<'a>> {
    let (open, close) = (&pair.open[..1], &pair.close[..1]);
    let second = line(preset, pair.close);
    mistake(
        pair.open,
        format!(
            "is this `{open}` not closed? By its indentation, the `{close}` of line {second} closes \
             another one"
        ),
    )
}

/// Two brackets that don't fit. Where the second stands tells which one the author meant otherwise.
fn mismatch<'a>(preset: &str, pair: Pair<'a>) -> Result<(), Mistake<'a>> {
    let Pair {
        open: opened,
        close: at,
    } = pair;
    let (open, close, right) = (&opened[..1], &at[..1], closing(opened));
    let (first, second) = (line(preset, opened), line(preset, at));
    let here = indentation(preset, at);
    if here == Some(indentation_of_line(preset, opened)) {
        let message = format!("write `{right}`, for the `{open}` of line {first}, not `{close}`");
        mistake(at, message)
    } else if here.is_none() && first != second {
        mistake(
            at,
            format!(
                "this `{close}` comes before the `{open}` of line {first} is closed: is it one too \
                 many, or a `{right}` missing?"
            ),
        )
    } else {
        mistake(
            opened,
            format!(
                "this `{open}` is not closed before the `{close}` of line {second}: is a `{right}` \
                 missing?"
            ),
        )
    }
}

/// A pair whose second stands within a later line, where a bracket was perhaps written once too often.
fn too_many<'a>(preset: &str, pair: Pair<'a>) -> Result<(), Mistake<'a>> {
    let (open, close) = (&pair.open[..1], &pair.close[..1]);
    let first = line(preset, pair.open);
    mistake(
        pair.close,
        format!(
            "is this `{close}` one too many? It closes the `{open}` of line {first}, and what comes \
             later does not fit"
        ),
    )
}

/// The line that `at`, an end of the preset, begins in.
fn line(preset: &str, at: &str) -> usize {
    1 + preset[..preset.len() - at.len()].matches('\n').count()
}

fn closing(opened: &str) -> &'static str {
    match opened.as_bytes().first() {
        Some(b'(') => ")",
        Some(b'[') => "]",
        _ => "}",
    }
}

/// The white space before `at`, where nothing else is before it on its line.
fn indentation(preset: &str, at: &str) -> Option<usize> {
    let before = &preset[..preset.len() - at.len()];
    let spaces = before.len() - before.trim_end_matches([' ', '\t']).len();
    let line = &before[..before.len() - spaces];
    (line.is_empty() || line.ends_with('\n')).then_some(spaces)
}

fn indentation_of_line(preset: &str, at: &str) -> usize {
    let before = &preset[..preset.len() - at.len()];
    let line = &preset[before.rfind('\n').map_or(0, |i| i + 1)..];
    line.len() - line.trim_start_matches([' ', '\t']).len()
}
