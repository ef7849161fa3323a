//! Changing a preset's text in place: a value is set, a field or an item added, removed or moved, and all that the author
//! wrote around it (comments, order, layout) stays byte for byte.
//!
//! Works on any file of the syntax of presets: sections `(name: value, ...)` and lists `[value, ...]`, in a text whose
//! brackets match. Nothing here knows what values mean.
//!
//! To a field or item belong the comments on the lines directly above it, without a blank line between, those beside it, and
//! the one after it on its line. They go where it goes; all others stay where they are.
//!
//! ```
//! use effects::preset::edit::{self, Step::{Field, Item}};
//!
//! let text = "(\n    // Thick.\n    width: 2, // pixels\n    layers: [(effect: \"hair.base\")],\n)\n";
//! let text = edit::set(text, &[Field("width")], "3")?;
//! let text = edit::set(&text, &[Field("layers"), Item(0), Field("params"), Field("color")], "\"3FC1C0\"")?;
//! assert_eq!(
//!     text,
//!     "(\n    // Thick.\n    width: 3, // pixels\n    layers: [(effect: \"hair.base\", params: (color: \"3FC1C0\"))],\n)\n"
//! );
//! let text = edit::remove(&text, &[Field("width")])?;
//! assert!(text.starts_with("(\n    layers: "));
//! # Ok::<(), edit::EditError>(())
//! ```

mod group;
mod written;

use super::brackets::check_brackets;
use super::error::suggestion;
use super::syntax::{Kind, Piece, pieces};
use super::value::shown;
use group::{Entry, Group, comments_of, ends_line, indentation_at, is_first_on_line};
use std::ops::Range;
pub use written::written;

/// One step of the way to a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step<'a> {
    /// To the value of this field of a section; the first of that name.
    Field(&'a str),
    /// To this item of a list `[a, b]` or of values in brackets `(a, b)`, 0 first.
    Item(usize),
}

/// Why a text was not changed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// The text has a mistake that leaves open where its parts begin and end.
    #[error("{line}:{column}: {message}")]
    Syntax {
        /// Line, 1 first.
        line: usize,
        /// Column in characters, 1 first.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// There is no such field or item.
    #[error("there is no `{place}`{hint}")]
    NotThere {
        /// The way to it, such as `layers[2].params`.
        place: String,
        /// The end of the sentence: what there is.
        hint: String,
    },
    /// A step asks for a field where there is no section, or for an item where there is no list.
    #[error("{line}:{column}: `{place}` is not {expected}")]
    OtherKind {
        /// The way to the value.
        place: String,
        /// Line where it begins, 1 first.
        line: usize,
        /// Column in characters, 1 first.
        column: usize,
        /// What it should be.
        expected: &'static str,
    },
    /// What is to be a field's name is not one word.
    #[error("`{0}` is no name of a field")]
    Name(String),
    /// What is to be a value is none, or several.
    #[error("`{0}` is not one value")]
    Value(String),
}

/// The text of the value at a place, such as `[Field("layers"), Item(2), Field("params"), Field("width")]`. `None` where
/// there is none, or the text's brackets don't match. The empty way leads to the outermost section.
#[must_use]
pub fn get<'t>(text: &'t str, path: &[Step]) -> Option<&'t str> {
    span(text, path).map(|span| &text[span])
}

/// The bytes of the value at a place: [`get`]'s.
#[must_use]
pub fn span(text: &str, path: &[Step]) -> Option<Range<usize>> {
    match walk(text, path) {
        Ok((span, steps)) if steps == path.len() => Some(span),
        _ => None,
    }
}

/// Names and values of the section at a place, in the order of the text. None where there is no section.
#[must_use]
pub fn fields<'t>(text: &'t str, path: &[Step]) -> Vec<(&'t str, &'t str)> {
    let group = span(text, path).and_then(|span| Group::section(text, span));
    let entries = group.into_iter().flat_map(|group| group.entries);
    entries
        .filter_map(|entry| Some((&text[entry.name?], &text[entry.value])))
        .collect()
}

/// The items of the list at a place, or of values in brackets `(x, y)`. None where there is neither.
#[must_use]
pub fn items<'t>(text: &'t str, path: &[Step]) -> Vec<&'t str> {
    let group = span(text, path).and_then(|span| Group::list(text, span));
    let entries = group.into_iter().flat_map(|group| group.entries);
    entries.map(|entry| &text[entry.value]).collect()
}

/// The text with another value at a place. A field that isn't there is added at the end of its section, in the section's
/// own layout, and with it sections on the way that aren't there.
///
/// # Errors
///
/// When brackets don't match, the way leads through what is no section or list or to an item that isn't there, or `value` is
/// not one value.
pub fn set(text: &str, path: &[Step], value: &str) -> Result<String, EditError> {
    let value = one_value(value)?;
    let (span, steps) = walk(text, path)?;
    let changed = match path[steps..] {
        [] => splice(text, &mut [(span, value.to_owned())]),
        [Step::Field(_), ..] => {
            let group = whole(text, Group::section(text, span), path, steps)?;
            append(text, &group, &nested(path, steps, value)?)
        }
        [Step::Item(_), ..] => return Err(not_there(text, path, steps)),
    };
    if get(&changed, path) == Some(value) {
        Ok(changed)
    } else {
        Err(EditError::Value(shown(value)))
    }
}

/// The text without the field or item at a place, its comma and its comments. Other comments stay.
///
/// # Errors
///
/// When there is none, or the text around it has mistakes.
pub fn remove(text: &str, path: &[Step]) -> Result<String, EditError> {
    let Some((last, way)) = path.split_last() else {
        return Err(not_there(text, path, 0));
    };
    let (span, steps) = walk(text, way)?;
    if steps < way.len() {
        return Err(not_there(text, path, steps));
    }
    let group = whole(text, Group::of(text, span, *last), path, steps)?;
    let index = group
        .index(text, *last)
        .ok_or_else(|| not_there(text, path, steps))?;

    let entry = &group.entries[index];
    let before = index.checked_sub(1).map(|i| &group.entries[i]);
    let is_last = index + 1 == group.entries.len();
    let mut edits = vec![(removed(text, &group, before, entry, is_last), String::new())];
    // Where the last one has no comma, the one before it has none from now on.
    if let Some(comma) = before.and_then(|entry| entry.comma)
        && is_last
        && entry.comma.is_none()
    {
        edits.push((comma..comma + 1, String::new()));
    }
    Ok(splice(text, &mut edits))
}

/// The text with another item before item `at` of a list, or at its end.
///
/// # Errors
///
/// When there is no such list, it has mistakes, or `item` is not one value.
pub fn insert(text: &str, list: &[Step], at: usize, item: &str) -> Result<String, EditError> {
    let item = one_value(item)?;
    let group = whole_list(text, list)?;
    let changed = match group.entries.get(at) {
        None => append(text, &group, item),
        Some(next) if is_first_on_line(text, next.lead) => {
            let indentation = indentation_at(text, next.lead);
            let line = format!("{item},{}{indentation}", line_end(text));
            splice(text, &mut [(next.lead..next.lead, line)])
        }
        Some(next) => splice(text, &mut [(next.lead..next.lead, format!("{item}, "))]),
    };
    let at = at.min(group.entries.len());
    if items(&changed, list).get(at) == Some(&item) {
        Ok(changed)
    } else {
        Err(EditError::Value(shown(item)))
    }
}

/// The text with item `from` of a list, and its comments, as number `to`. Blank lines, and comments that belong to no item,
/// stay where they are.
///
/// # Errors
///
/// When there is no such list or item, or it has mistakes.
pub fn move_item(text: &str, list: &[Step], from: usize, to: usize) -> Result<String, EditError> {
    let group = whole_list(text, list)?;
    let count = group.entries.len();
    if let Some(index) = [from, to].into_iter().find(|index| *index >= count) {
        let path: Vec<Step> = list.iter().copied().chain([Step::Item(index)]).collect();
        return Err(not_there(text, &path, list.len()));
    }
    let mut order: Vec<usize> = (0..count).collect();
    let moved = order.remove(from);
    order.insert(to, moved);
    let slots = group.entries.iter().zip(order);
    let mut edits: Vec<Edit> = slots
        .enumerate()
        .filter(|(slot, (_, index))| slot != index)
        .map(|(_, (slot, index))| {
            let entry = in_place_of(text, &group.entries[index], slot);
            (slot.lead..slot.end, entry)
        })
        .collect();
    Ok(splice(text, &mut edits))
}

/// What comes in place of some bytes.
type Edit = (Range<usize>, String);

/// The text with these changes, which don't overlap.
fn splice(text: &str, edits: &mut [Edit]) -> String {
    edits.sort_by_key(|(span, _)| (span.start, span.end));
    let mut changed = String::with_capacity(text.len());
    let mut from = 0;
    for (span, new) in edits {
        changed.push_str(&text[from..span.start]);
        changed.push_str(new);
        from = span.end;
    }
    changed.push_str(&text[from..]);
    changed
}

/// The span of the value as far as the way is there, and the number of its steps.
fn walk(text: &str, path: &[Step]) -> Result<(Range<usize>, usize), EditError> {
    if let Err(mistake) = check_brackets("text", text) {
        let at = group::offset(text, mistake.at);
        return Err(syntax(text, at, mistake.message));
    }
    let mut span = match pieces(text)[..] {
        [
            Piece {
                kind: Kind::Group,
                text: root,
            },
        ] => group::range(text, root),
        _ => {
            return Err(syntax(
                text,
                text.len(),
                "there is nothing in it".to_owned(),
            ));
        }
    };
    for (steps, step) in path.iter().enumerate() {
        let group = Group::of(text, span.clone(), *step)
            .ok_or_else(|| other_kind(text, &span, path, steps))?;
        let Some(index) = group.index(text, *step) else {
            return Ok((span, steps));
        };
        span = group.entries[index].value.clone();
    }
    Ok((span, path.len()))
}

/// The group that the first `steps` of `path` lead to, if its entries can be told apart.
fn whole(
    text: &str,
    group: Option<Group>,
    path: &[Step],
    steps: usize,
) -> Result<Group, EditError> {
    let group = group.ok_or_else(|| match walk(text, &path[..steps]) {
        Ok((span, _)) => other_kind(text, &span, path, steps),
        Err(error) => error,
    })?;
    match group.mistake {
        Some((at, message)) => Err(syntax(text, at, message)),
        None => Ok(group),
    }
}

fn whole_list(text: &str, list: &[Step]) -> Result<Group, EditError> {
    let (span, steps) = walk(text, list)?;
    if steps < list.len() {
        return Err(not_there(text, list, steps));
    }
    let path: Vec<Step> = list.iter().copied().chain([Step::Item(0)]).collect();
    whole(text, Group::list(text, span), &path, steps)
}

fn syntax(text: &str, at: usize, message: String) -> EditError {
    let (line, column) = line_and_column(text, at);
    EditError::Syntax {
        line,
        column,
        message,
    }
}

fn other_kind(text: &str, span: &Range<usize>, path: &[Step], steps: usize) -> EditError {
    let (line, column) = line_and_column(text, span.start);
    EditError::OtherKind {
        place: written_path(&path[..steps]),
        line,
        column,
        expected: match path[steps] {
            Step::Field(_) => "a section (name: value, ...)",
            Step::Item(_) => "a list [..., ...]",
        },
    }
}

/// The error for step `steps` of the way, which leads nowhere.
fn not_there(text: &str, path: &[Step], steps: usize) -> EditError {
    let (way, missing) = path.split_at(steps.min(path.len()));
    let hint = match missing.first() {
        Some(Step::Field(name)) => {
            let names = fields(text, way).into_iter().map(|(name, _)| name);
            suggestion(name, names)
        }
        Some(Step::Item(_)) => format!("; there are {} items", items(text, way).len()),
        None => "; it is the whole text".to_owned(),
    };
    let missing = missing.first().map_or(steps, |_| steps + 1);
    EditError::NotThere {
        place: written_path(&path[..missing]),
        hint,
    }
}

/// A way as people write it: `layers[2].params`.
fn written_path(path: &[Step]) -> String {
    let mut written = String::new();
    for step in path {
        match step {
            Step::Field(name) if written.is_empty() => written += &shown(name),
            Step::Field(name) => written += &format!(".{}", shown(name)),
            Step::Item(index) => written += &format!("[{index}]"),
        }
    }
    written
}

/// Line and column of a byte, both 1 first, the column in characters.
fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..at];
    let line_start = before.rfind('\n').map_or(0, |end| end + 1);
    let line = before.matches('\n').count() + 1;
    (line, before[line_start..].chars().count() + 1)
}

/// The text without space around it, if it is one value that can stand between commas.
fn one_value(value: &str) -> Result<&str, EditError> {
    let value = value.trim();
    let in_brackets = format!("({value})");
    let parts = pieces(value);
    let is_one = check_brackets("text", &in_brackets).is_ok()
        && parts
            .iter()
            .all(|piece| matches!(piece.kind, Kind::Group | Kind::Word | Kind::Text))
        // What begins or ends with a comment would give it away to its neighbour.
        && parts.first().is_some_and(|first| value.starts_with(first.text))
        && parts
            .last()
            .is_some_and(|last| group::range(value, last.text).end == value.len());
    if is_one {
        Ok(value)
    } else {
        Err(EditError::Value(shown(value)))
    }
}

/// `name: value` for the first step of the way that isn't there, with the sections after it.
fn nested(path: &[Step], steps: usize, value: &str) -> Result<String, EditError> {
    let mut nested = value.to_owned();
    for (i, step) in path.iter().enumerate().skip(steps).rev() {
        let Step::Field(name) = step else {
            return Err(EditError::NotThere {
                place: written_path(&path[..=i]),
                hint: "; there are 0 items".to_owned(),
            });
        };
        if !matches!(pieces(name)[..], [Piece { kind: Kind::Word, text }] if text == *name) {
            return Err(EditError::Name(shown(name)));
        }
        nested = if i == steps {
            format!("{name}: {nested}")
        } else {
            format!("({name}: {nested})")
        };
    }
    Ok(nested)
}

/// The text with `entry` at the end of the group.
fn append(text: &str, group: &Group, entry: &str) -> String {
    let Some(last) = group.entries.last() else {
        return append_first(text, group, entry);
    };
    let comma = if last.comma.is_some() { "," } else { "" };
    let is_first = is_first_on_line(text, last.lead);
    // A comment that ends the last one's line would be the new one's on the same line.
    let has_comment = last.end > last.after_comma() && ends_line(text, last.end);
    if is_first || has_comment {
        let mut indentation = indentation_at(text, last.lead).to_owned();
        if !is_first && line_start(text, last.lead) <= group.open {
            indentation += unit(text);
        }
        let line = format!("{}{indentation}{entry}{comma}", line_end(text));
        let mut edits = vec![(last.end..last.end, line)];
        if last.comma.is_none() {
            let at = last.value.end;
            edits.insert(0, (at..at, ",".to_owned()));
        }
        return splice(text, &mut edits);
    }
    let (at, new) = match last.comma {
        Some(comma) => (comma + 1, format!(" {entry},")),
        None => (last.end, format!(", {entry}")),
    };
    splice(text, &mut [(at..at, new)])
}

/// The text with `entry` in a group that has none. Comments in it stay nobody's.
fn append_first(text: &str, group: &Group, entry: &str) -> String {
    let inside = group.open + 1..group.close;
    let comments = comments_of(text, inside.clone());
    let header = group::comments_on_line(text, inside.clone(), true);
    let in_lines = header.is_some() || ends_line(text, inside.start);
    if !in_lines {
        let new = match (comments.is_empty(), text[inside.clone()].starts_with(' ')) {
            (true, _) => return splice(text, &mut [(inside, entry.to_owned())]),
            (false, true) => format!("{entry},"),
            (false, false) => format!("{entry}, "),
        };
        return splice(text, &mut [(inside.start..inside.start, new)]);
    }
    let outer = if is_first_on_line(text, group.close) {
        group.close
    } else {
        group.open
    };
    let (outer, unit, line_end) = (indentation_at(text, outer), unit(text), line_end(text));
    let line = format!("{line_end}{outer}{unit}{entry},");
    if comments.is_empty() {
        let line = format!("{line}{line_end}{outer}");
        return splice(text, &mut [(inside, line)]);
    }
    let at = header.unwrap_or(inside.start);
    splice(text, &mut [(at..at, line)])
}

/// What goes away with an entry: it and its comments, with its lines or with the space beside it.
fn removed(
    text: &str,
    group: &Group,
    before: Option<&Entry>,
    entry: &Entry,
    is_last: bool,
) -> Range<usize> {
    let blank_before = blank_before(text, entry.lead);
    let blank_after = blank_after(text, entry.end);
    let is_first_on_line = is_first_on_line(text, entry.lead);
    if ends_line(text, entry.end) {
        return if is_first_on_line {
            let end = text[blank_after..].find('\n').map_or(0, |i| i + 1);
            blank_before..blank_after + end
        } else {
            blank_before..entry.end
        };
    }
    if !is_last {
        return entry.lead..blank_after;
    }
    // The closing bracket is on the same line.
    let end_before = before.map_or(group.open + 1, |before| before.end);
    let all_blank = text[end_before..entry.lead].trim().is_empty();
    let after_line_comment = before.is_some_and(|before| {
        let comments = comments_of(text, before.value.end..before.end);
        comments.last().is_some_and(|comment| comment.is_line)
    });
    let start = match is_first_on_line {
        true if all_blank && !after_line_comment => end_before,
        true => entry.lead,
        false => blank_before,
    };
    let end = if before.is_none() && all_blank {
        blank_after
    } else {
        entry.end
    };
    start..end
}

/// An entry as it is written in place of another one of its list: with a comma where that has one, and on a line of its own
/// where its comments need that.
fn in_place_of(text: &str, entry: &Entry, slot: &Entry) -> String {
    let break_line = format!("{}{}", line_end(text), indentation_at(text, slot.lead));
    let mut new = String::new();
    let has_lines_above = text[entry.lead..entry.start()].contains('\n');
    if has_lines_above && !is_first_on_line(text, slot.lead) {
        new += &break_line;
    }
    new += &text[entry.lead..entry.value.end];

    let slot_ends_line = ends_line(text, slot.end);
    let is_alike = entry.comma.is_some() == slot.comma.is_some()
        && ends_line(text, entry.end) == slot_ends_line;
    if is_alike {
        return new + &text[entry.value.end..entry.end];
    }
    let comma = if slot.comma.is_some() { "," } else { "" };
    let comments = comments_of(text, entry.value.end..entry.end);
    let has_line_comment = comments.iter().any(|comment| comment.is_line);
    // A comment after the comma is this entry's where its line ends there.
    let comma_first = slot_ends_line || has_line_comment;
    if comma_first {
        new += comma;
    }
    for (i, comment) in comments.iter().enumerate() {
        let after_line = i > 0 && comments[i - 1].is_line;
        new += if after_line { &break_line } else { " " };
        new += &text[comment.span.clone()];
    }
    if !comma_first {
        new += comma;
    }
    if has_line_comment && !slot_ends_line {
        new += &break_line;
    }
    new
}

/// How lines of this text end.
fn line_end(text: &str) -> &'static str {
    match text.find('\n') {
        Some(end) if text[..end].ends_with('\r') => "\r\n",
        _ => "\n",
    }
}

/// What this text's sections are indented by: the space before its first entry, where that has a line of its own.
fn unit(text: &str) -> &str {
    let root = pieces(text)
        .first()
        .map(|root| group::range(text, root.text));
    let group = root.and_then(|root| Group::new(text, root));
    let first = group.as_ref().and_then(|group| group.entries.first());
    match first {
        Some(first) if is_first_on_line(text, first.lead) => {
            let unit = indentation_at(text, first.lead);
            if unit.is_empty() { "    " } else { unit }
        }
        _ => "    ",
    }
}

fn line_start(text: &str, at: usize) -> usize {
    text[..at].rfind('\n').map_or(0, |end| end + 1)
}

/// Where the spaces and tabs before a byte begin.
fn blank_before(text: &str, at: usize) -> usize {
    text[..at].trim_end_matches([' ', '\t']).len()
}

/// Where those after it end.
fn blank_after(text: &str, at: usize) -> usize {
    text.len() - text[at..].trim_start_matches([' ', '\t']).len()
}
