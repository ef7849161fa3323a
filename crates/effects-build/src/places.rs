//! Where a mistake is in the author's own text, where naga says nothing of it or names a place behind its end.

use crate::compose::Source;
use crate::error::BuildError;
use naga::Span;

/// Operators by their names in naga's messages.
const OPERATORS: &[(&str, &str)] = &[
    ("LogicalOr", "||"),
    ("LogicalAnd", "&&"),
    ("ShiftLeft", "<<"),
    ("ShiftRight", ">>"),
    ("LessEqual", "<="),
    ("GreaterEqual", ">="),
    ("NotEqual", "!="),
    ("Equal", "=="),
    ("InclusiveOr", "|"),
    ("ExclusiveOr", "^"),
    ("And", "&"),
    ("Less", "<"),
    ("Greater", ">"),
    ("Modulo", "%"),
    ("Divide", "/"),
    ("Multiply", "*"),
    ("Subtract", "-"),
    ("Add", "+"),
];

/// An error with naga's words (`message`, and `text` with the lines that it is about) at its place.
pub(crate) fn error(source: &Source, span: Option<Span>, message: &str, text: &str) -> BuildError {
    let author = &source.text[..source.author_length];
    let start = span.and_then(|span| Some(span.to_range()?.start));
    // Whatever else is found is found behind it.
    if let Some(open) = unclosed(author) {
        let bracket = &author[open..=open];
        let place = Span::new(open as u32, open as u32 + 1);
        return source.error(place, format!("this `{bracket}` is never closed"));
    }
    match start {
        Some(start) if start < author.len() => source.error(span.unwrap_or_default(), text),
        Some(_) if source.is_shared(span.unwrap_or_default()) => {
            source.error(span.unwrap_or_default(), message)
        }
        Some(_) => {
            let last = author.trim_end().char_indices().next_back();
            let at = last.map_or(0, |(at, _)| at as u32);
            source.error(Span::new(at, at), message)
        }
        None => without_place(source, author, message),
    }
}

/// By the operator that the message names; the lines of all of them where there are several.
fn without_place(source: &Source, author: &str, message: &str) -> BuildError {
    let code = without_comments(author);
    let named = OPERATORS.iter().find(|(name, _)| message.contains(name));
    let places: Vec<usize> = named.map_or(Vec::new(), |(_, operator)| {
        code.match_indices(operator).map(|(at, _)| at).collect()
    });
    match (&places[..], named) {
        ([only], Some((_, operator))) => {
            let end = only + operator.len();
            source.error(Span::new(*only as u32, end as u32), message)
        }
        ([first, ..], Some((_, operator))) => {
            let line = |at: &usize| 1 + author[..*at].matches('\n').count();
            let mut lines: Vec<String> = places.iter().map(|at| line(at).to_string()).collect();
            lines.dedup();
            let place = Span::new(*first as u32, (first + operator.len()) as u32);
            let lines = lines.join(", ");
            source.error(
                place,
                format!("{message} (a `{operator}` of the lines {lines})"),
            )
        }
        _ => BuildError(format!("{}: {message}", source.path)),
    }
}

/// A bracket that is opened and never closed, the innermost at its place. One that is closed without being opened is naga's to tell.
fn unclosed(author: &str) -> Option<usize> {
    let mut open: Vec<(usize, char)> = Vec::new();
    for (at, character) in without_comments(author).char_indices() {
        match character {
            '(' => open.push((at, ')')),
            '[' => open.push((at, ']')),
            '{' => open.push((at, '}')),
            ')' | ']' | '}' => match open.pop() {
                Some((at, closing)) if closing != character => return Some(at),
                Some(_) => {}
                None => return None,
            },
            _ => {}
        }
    }
    open.pop().map(|(at, _)| at)
}

/// The same text with blanks in place of comments, byte for byte.
fn without_comments(author: &str) -> String {
    let mut code = String::with_capacity(author.len());
    let (mut rest, mut depth) = (author, 0);
    while let Some(character) = rest.chars().next() {
        let length = if depth == 0 && rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            depth += 1;
            2
        } else if depth > 0 && rest.starts_with("*/") {
            depth -= 1;
            2
        } else if depth > 0 {
            character.len_utf8()
        } else {
            code.push(character);
            rest = &rest[character.len_utf8()..];
            continue;
        };
        let (comment, behind) = rest.split_at(length);
        code.extend(
            comment
                .bytes()
                .map(|byte| if byte == b'\n' { '\n' } else { ' ' }),
        );
        rest = behind;
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_blank_and_places_stay() {
        let text = "a { // } é\n/* { /* ( */ */ b }\n";
        let code = without_comments(text);
        assert_eq!(code.len(), text.len());
        assert_eq!(code.find('b'), text.find("b }"));
        assert_eq!(unclosed(text), None);
        assert_eq!(unclosed("f() { if (x) { }"), Some(4));
        assert_eq!(unclosed("f() { a[1; }"), Some(7));
        assert_eq!(unclosed("f() } {"), None);
    }
}
