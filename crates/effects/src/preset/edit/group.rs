//! What stands in a pair of brackets, with the comments that belong to each part of it.

use super::super::syntax::{Kind, Piece, pieces, skip_block};
use super::super::value::shown;
use super::Step;
use std::ops::Range;

/// A pair of brackets `( )` or `[ ]`. All places are bytes of the text.
pub(super) struct Group {
    /// Where the first bracket is.
    pub open: usize,
    /// Where the second one is.
    pub close: usize,
    pub entries: Vec<Entry>,
    /// The first mistake between its commas: until it is mended, entries can be read, not moved.
    pub mistake: Option<(usize, String)>,
}

/// A field of a section, or an item of a list.
pub(super) struct Entry {
    pub name: Option<Range<usize>>,
    pub value: Range<usize>,
    /// Where the comma after it is.
    pub comma: Option<usize>,
    /// Where the comments before it begin that belong to it; its own start if there are none.
    pub lead: usize,
    /// The end of what belongs to it: its comma, and the comments after it on its line.
    pub end: usize,
}

pub(super) struct Comment {
    /// Without the end of its line.
    pub span: Range<usize>,
    /// Whether it begins with `//`, so that a line must end after it.
    pub is_line: bool,
}

impl Entry {
    /// Where its name begins, or its value.
    pub fn start(&self) -> usize {
        self.name.as_ref().unwrap_or(&self.value).start
    }

    /// The end of its comma, or of its value.
    pub fn after_comma(&self) -> usize {
        self.comma.map_or(self.value.end, |comma| comma + 1)
    }
}

impl Group {
    /// The group that a step leads into, or `None` where there is none of that sort.
    pub fn of(text: &str, span: Range<usize>, step: Step) -> Option<Self> {
        match step {
            Step::Field(_) => Self::section(text, span),
            Step::Item(_) => Self::list(text, span),
        }
    }

    /// A section `(name: value, ...)`; also an empty one.
    pub fn section(text: &str, span: Range<usize>) -> Option<Self> {
        let is_round = text[span.clone()].starts_with('(');
        let group = Self::new(text, span).filter(|_| is_round)?;
        let has_names = |group: &Self| group.entries.iter().any(|entry| entry.name.is_some());
        (group.entries.is_empty() || has_names(&group)).then_some(group)
    }

    /// A list `[a, b]`, or values `(a, b)`.
    pub fn list(text: &str, span: Range<usize>) -> Option<Self> {
        let is_round = text[span.clone()].starts_with('(');
        let group = Self::new(text, span)?;
        let has_names = group.entries.iter().any(|entry| entry.name.is_some());
        let may_be_section = has_names || (is_round && group.entries.is_empty());
        (!may_be_section).then_some(group)
    }

    /// The entry that a step leads to.
    pub fn index(&self, text: &str, step: Step) -> Option<usize> {
        match step {
            Step::Item(index) => (index < self.entries.len()).then_some(index),
            Step::Field(name) => {
                let is_named =
                    |entry: &Entry| entry.name.clone().is_some_and(|span| text[span] == *name);
                self.entries.iter().position(is_named)
            }
        }
    }

    /// The one pair of brackets that `span` is.
    pub fn new(text: &str, span: Range<usize>) -> Option<Self> {
        let is_group = matches!(
            pieces(&text[span.clone()])[..],
            [Piece {
                kind: Kind::Group,
                text
            }] if text.starts_with(['(', '['])
        );
        if !is_group {
            return None;
        }
        let mut group = Self {
            open: span.start,
            close: span.end - 1,
            entries: Vec::new(),
            mistake: None,
        };
        group.read(text);
        group.attach_comments(text);
        Some(group)
    }

    /// Finds the entries, as [`Reader`](crate::preset::Reader) does: also where a comma is missing.
    fn read(&mut self, text: &str) {
        let parts = pieces(&text[self.open + 1..self.close]);
        let is_name = |i: usize| {
            let is_colon = |piece: &Piece| piece.kind == Kind::Colon;
            parts[i].kind == Kind::Word && parts.get(i + 1).is_some_and(is_colon)
        };
        let mut i = 0;
        while i < parts.len() {
            if parts[i].kind == Kind::Comma {
                self.note(text, &parts[i], "there is a comma too many".to_owned());
                i += 1;
                continue;
            }
            let name = is_name(i).then(|| range(text, parts[i].text));
            let from = if name.is_some() { i + 2 } else { i };
            let ends = |&to: &usize| parts[to].kind == Kind::Comma || is_name(to);
            let mut to = (from..parts.len()).find(ends).unwrap_or(parts.len());
            let value = &parts[from..to];
            if let Some(stray) = value
                .iter()
                .find(|piece| matches!(piece.kind, Kind::Stray | Kind::Colon))
            {
                let message = format!("there is a `{}` too many", stray.text);
                self.note(text, stray, message);
            }
            if name.is_none() && value.len() > 1 && value.iter().all(|p| p.kind == Kind::Group) {
                to = from + 1;
            }
            if let (Some(first), Some(last)) = (parts[from..to].first(), parts[from..to].last()) {
                self.entries.push(Entry {
                    name,
                    value: range(text, first.text).start..range(text, last.text).end,
                    comma: None,
                    lead: 0,
                    end: 0,
                });
            } else {
                let message = format!("`{}` has no value", shown(parts[i].text));
                self.note(text, &parts[i], message);
            }
            i = to;
            match parts.get(i) {
                Some(comma) if comma.kind == Kind::Comma => {
                    if let Some(entry) = self.entries.last_mut() {
                        entry.comma = Some(offset(text, comma.text));
                    }
                    i += 1;
                }
                Some(next) => {
                    let message = format!("a comma is missing before `{}`", shown(next.text));
                    self.note(text, next, message);
                }
                None => {}
            }
        }
        let has_names = self.entries.iter().any(|entry| entry.name.is_some());
        let nameless = self.entries.iter().find(|entry| entry.name.is_none());
        if let Some(entry) = nameless.filter(|_| has_names) {
            let found = shown(&text[entry.value.clone()]);
            let message = format!("expected `name: value`, found `{found}`");
            let at = entry.value.start;
            self.mistake.get_or_insert((at, message));
        }
    }

    fn note(&mut self, text: &str, piece: &Piece, message: String) {
        let at = offset(text, piece.text);
        self.mistake.get_or_insert((at, message));
    }

    /// Gives each comment to the entry that it belongs to.
    fn attach_comments(&mut self, text: &str) {
        let first = self.entries.first().map_or(self.close, Entry::start);
        // A comment after the opening bracket, on its line, is of the whole.
        let inside = self.open + 1;
        let mut end = comments_on_line(text, inside..first, true).unwrap_or(inside);
        for i in 0..self.entries.len() {
            let lead = lead_before(text, end, self.entries[i].start());
            let next = self.entries.get(i + 1).map(Entry::start);
            let entry = &mut self.entries[i];
            let after = entry.after_comma();
            // Before another entry it may be of that one, and after the last comma of nobody.
            let must_end_line = next.is_some() || entry.comma.is_some();
            let gap = after..next.unwrap_or(self.close);
            end = comments_on_line(text, gap, must_end_line).unwrap_or(after);
            entry.lead = lead;
            entry.end = end;
        }
    }
}

/// Where the comments end that begin on the line on which `gap` begins, if there are any, or a line ends at once. `None`
/// where no line ends after them and one must.
pub(super) fn comments_on_line(
    text: &str,
    gap: Range<usize>,
    must_end_line: bool,
) -> Option<usize> {
    let mut end = gap.start;
    for comment in comments_of(text, gap.clone()) {
        if text[end..comment.span.start].contains('\n') {
            return Some(end);
        }
        end = comment.span.end;
    }
    let ends_line = text[end..gap.end].contains('\n');
    (ends_line || !must_end_line).then_some(end)
}

/// Where the comments begin that stand directly above or before an entry at `start`, not before `from`.
fn lead_before(text: &str, from: usize, start: usize) -> usize {
    let mut lead = start;
    for comment in comments_of(text, from..start).iter().rev() {
        if text[comment.span.end..lead].matches('\n').count() > 1 {
            break;
        }
        lead = comment.span.start;
    }
    lead
}

/// The comments of a part of the text that has only comments and space in it, up to two values with a comma between them.
pub(super) fn comments_of(text: &str, gap: Range<usize>) -> Vec<Comment> {
    let mut comments = Vec::new();
    let mut rest = &text[gap];
    loop {
        rest = rest.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
        let is_line = rest.starts_with("//");
        let length = if is_line {
            let line = rest.split('\n').next().unwrap_or_default();
            line.trim_end_matches('\r').len()
        } else if let Some(length) = block_length(rest) {
            length
        } else {
            return comments;
        };
        let span = range(text, &rest[..length]);
        comments.push(Comment { span, is_line });
        rest = &rest[length..];
    }
}

fn block_length(text: &str) -> Option<usize> {
    let after = text.starts_with("/*").then(|| skip_block(text).ok())??;
    Some(text.len() - after.len())
}

/// Whether nothing but spaces and tabs comes before a byte on its line.
pub(super) fn is_first_on_line(text: &str, at: usize) -> bool {
    let before = text[..at].trim_end_matches([' ', '\t']);
    before.is_empty() || before.ends_with('\n')
}

/// Whether nothing but spaces and tabs comes after it.
pub(super) fn ends_line(text: &str, at: usize) -> bool {
    let after = text[at..].trim_start_matches([' ', '\t']);
    after.is_empty() || after.starts_with('\n') || after.starts_with("\r\n")
}

/// The spaces and tabs that the line of a byte begins with.
pub(super) fn indentation_at(text: &str, at: usize) -> &str {
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    let line = &text[start..];
    &line[..line.len() - line.trim_start_matches([' ', '\t']).len()]
}

/// Where a slice of the text begins.
pub(super) fn offset(text: &str, slice: &str) -> usize {
    slice.as_ptr() as usize - text.as_ptr() as usize
}

/// The bytes of a slice of the text.
pub(super) fn range(text: &str, slice: &str) -> Range<usize> {
    let start = offset(text, slice);
    start..start + slice.len()
}
