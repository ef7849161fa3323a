//! The shape of a preset's text: brackets, commas, colons. What values mean is for others.
//!
//! What is accepted is a part of RON: sections `(name: value, ...)`, lists `[value, ...]`, words,
//! numbers and texts on one line. A parser of our own, because it must say what an author did wrong
//! and go on from there; RON's stops at the first mistake and names what it expected.

/// A piece of the text between commas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// `(`, `[` or `{`.
    Open,
    /// `)`, `]` or `}`.
    Close,
    Comma,
    Colon,
    /// In quotes of any sort.
    Text,
    /// A name or a number: whatever stands together.
    Word,
    /// `=` or `;`, which presets don't use.
    Stray,
    /// Brackets with all that is in them.
    Group,
}

/// A token, or a group in brackets; `text` is a slice of the preset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'a> {
    pub kind: Kind,
    pub text: &'a str,
}

/// What is wrong, at the beginning of a slice of the preset.
pub(super) struct Mistake<'a> {
    pub at: &'a str,
    pub message: String,
}

pub(super) fn mistake<'a, T>(at: &'a str, message: impl Into<String>) -> Result<T, Mistake<'a>> {
    let message = message.into();
    Err(Mistake { at, message })
}

/// The next token of `text`, and what comes after it. `None` at the end.
pub(super) fn token(text: &str) -> Result<Option<(Piece<'_>, &str)>, Mistake<'_>> {
    let text = skip_blank(text)?;
    let Some(first) = text.chars().next() else {
        return Ok(None);
    };
    let (kind, length) = match first {
        '(' | '[' | '{' => (Kind::Open, 1),
        ')' | ']' | '}' => (Kind::Close, 1),
        ',' => (Kind::Comma, 1),
        ':' => (Kind::Colon, 1),
        '=' | ';' => (Kind::Stray, 1),
        '"' | '\'' => (Kind::Text, quoted(text, first)?),
        'r' if raw_hashes(text).is_some() => (Kind::Text, raw(text)?),
        _ => (Kind::Word, word(text)),
    };
    let (text, rest) = text.split_at(length);
    Ok(Some((Piece { kind, text }, rest)))
}

/// The text after white space and comments.
pub(super) fn skip_blank(mut text: &str) -> Result<&str, Mistake<'_>> {
    loop {
        text = text.trim_start();
        if text.starts_with("//") {
            text = text.split_once('\n').map_or("", |(_, rest)| rest);
        } else if text.starts_with("/*") {
            text = skip_block(text)?;
        } else {
            return Ok(text);
        }
    }
}

/// The text after a block comment, which may have others in it.
pub(super) fn skip_block(text: &str) -> Result<&str, Mistake<'_>> {
    let mut depth = 0;
    let mut rest = text;
    while let Some(i) = rest.find(['/', '*']) {
        rest = &rest[i..];
        if rest.starts_with("/*") {
            depth += 1;
        } else if rest.starts_with("*/") {
            depth -= 1;
        } else {
            rest = &rest[1..];
            continue;
        }
        rest = &rest[2..];
        if depth == 0 {
            return Ok(rest);
        }
    }
    mistake(text, "this comment has no end: `*/` is missing")
}

/// The length of a text in quotes.
fn quoted(text: &str, quote: char) -> Result<usize, Mistake<'_>> {
    let mut escaped = false;
    for (i, c) in text.char_indices().skip(1) {
        match c {
            '\n' => break,
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if c == quote => return Ok(i + 1),
            _ => {}
        }
    }
    mistake(
        text,
        format!("this text has no end: a {quote} is missing on this line"),
    )
}

/// The number of `#` of a raw text `r"..."` or `r#"..."#`.
fn raw_hashes(text: &str) -> Option<usize> {
    let hashes = text[1..].bytes().take_while(|b| *b == b'#').count();
    text[1 + hashes..].starts_with('"').then_some(hashes)
}

fn raw(text: &str) -> Result<usize, Mistake<'_>> {
    let hashes = raw_hashes(text).unwrap_or_default();
    let end = format!("\"{}", "#".repeat(hashes));
    let start = 2 + hashes;
    let line = text[start..].split('\n').next().unwrap_or_default();
    match line.find(&end) {
        Some(i) => Ok(start + i + end.len()),
        None => mistake(
            text,
            format!("this text has no end: {end} is missing on this line"),
        ),
    }
}

fn word(text: &str) -> usize {
    let ends = |c: char| c.is_whitespace() || "()[]{},:=;\"'".contains(c);
    text.char_indices()
        .find(|(i, c)| ends(*c) || text[*i..].starts_with("//") || text[*i..].starts_with("/*"))
        .map_or(text.len(), |(i, _)| i)
}

/// What stands in `text`, groups as a whole. The text's brackets are known to be closed.
pub(super) fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let mut group: Option<(&str, usize)> = None;
    let mut rest = text;
    while let Ok(Some((piece, after))) = token(rest) {
        let at = &rest[rest.len() - after.len() - piece.text.len()..];
        rest = after;
        group = match (group, piece.kind) {
            (None, Kind::Open) => Some((at, 1)),
            (None, _) => {
                pieces.push(piece);
                None
            }
            (Some((start, depth)), Kind::Open) => Some((start, depth + 1)),
            (Some((start, 1)), Kind::Close) => {
                pieces.push(Piece {
                    kind: Kind::Group,
                    text: &start[..start.len() - after.len()],
                });
                None
            }
            (Some((start, depth)), Kind::Close) => Some((start, depth - 1)),
            (open, _) => open,
        };
    }
    pieces
}
