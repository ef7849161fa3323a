//! Reading sections of a preset from its text.

use super::brackets::check_brackets;
use super::error::{MOST_ERRORS, Place, PresetError, PresetErrors, suggestion};
use super::set::unknown;
use super::syntax::{self, Kind, Piece, pieces};
use super::value::{parse_value, shown};
use crate::param::{Param, Value};
use crate::section::Section;
use std::cell::Cell;
use std::collections::HashSet;

/// A preset's text, and the mistakes found in it so far.
pub struct Reader<'a> {
    file: String,
    text: &'a str,
    errors: Vec<PresetError>,
    /// The first mistake that is one too many to be told, and how many are.
    untold: Option<(Place, usize)>,
    /// Where the last place was: most are asked for in the order of the text, and counted from there.
    last: Cell<Walked>,
    /// Whether brackets match, so that the text has parts.
    whole: bool,
}

/// How far the text was walked through.
#[derive(Clone, Copy)]
struct Walked {
    /// Bytes of the text.
    offset: usize,
    /// Where its line begins.
    line_start: usize,
    line: usize,
    column: usize,
}

const START: Walked = Walked {
    offset: 0,
    line_start: 0,
    line: 1,
    column: 1,
};

/// One `name: value` of a section.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    /// The name, a slice of the text.
    pub name: &'a str,
    /// The value's text, a slice of the text without space around it.
    pub value: &'a str,
}

impl<'a> Reader<'a> {
    /// A reader of a preset's `text`, which messages call `file`. Brackets, texts and comments that have no end
    /// are noted as mistakes; then the text has no sections and no lists.
    #[must_use]
    pub fn new(file: &str, text: &'a str) -> Self {
        Self::of("preset", file, text)
    }

    /// As [`Self::new`], of a text that is no preset but `what`, such as "motion script".
    #[must_use]
    pub fn of(what: &str, file: &str, text: &'a str) -> Self {
        let mut reader = Self {
            file: file.to_owned(),
            text,
            errors: Vec::new(),
            untold: None,
            last: Cell::new(START),
            whole: true,
        };
        if let Err(mistake) = check_brackets(what, text) {
            reader.error(mistake.at, mistake.message);
            reader.whole = false;
        }
        reader
    }

    /// The text from its first bracket on, without the comments before it.
    #[must_use]
    pub fn text(&self) -> &'a str {
        syntax::skip_blank(self.text).unwrap_or(self.text)
    }

    /// Reports the mistakes that were found, if there are any.
    ///
    /// # Errors
    ///
    /// All of them, in the order of the file; of more than a hundred the first that were found, and how many there are.
    pub fn report(&mut self) -> Result<(), PresetErrors> {
        if self.errors.is_empty() {
            return Ok(());
        }
        let mut errors = std::mem::take(&mut self.errors);
        errors.sort_by_key(|e| (e.place.line, e.place.column));
        if let Some((place, untold)) = self.untold.take() {
            let all = errors.len() + untold;
            errors.push(PresetError::untold(place, errors.len(), all));
        }
        Err(PresetErrors(errors))
    }

    /// Notes a mistake at the place where `slice`, a part of the text, begins.
    pub fn error(&mut self, slice: &str, message: impl Into<String>) {
        if self.errors.len() < MOST_ERRORS {
            let place = self.place(slice);
            let message = message.into();
            self.errors.push(PresetError { place, message });
        } else if let Some((_, count)) = &mut self.untold {
            *count += 1;
        } else {
            self.untold = Some((self.place(slice), 1));
        }
    }

    /// The place where `slice`, a part of the text, begins.
    #[must_use]
    pub fn place(&self, slice: &str) -> Place {
        let offset = self.offset(slice);
        let mut walked = self.last.get();
        if offset < walked.offset {
            walked = START;
        }
        let passed = &self.text[walked.offset..offset];
        let mut in_line = passed;
        if let Some(end) = passed.rfind('\n') {
            in_line = &passed[end + 1..];
            walked.line += passed.matches('\n').count();
            walked.line_start = offset - in_line.len();
            walked.column = 1;
        }
        walked.column += in_line.chars().count();
        walked.offset = offset;
        self.last.set(walked);
        let position = [walked.line, walked.column];
        Place::new(&self.file, self.text, offset, walked.line_start, position)
    }

    /// Where in the text `slice` begins: a pointer difference, 0 for a slice of something else.
    fn offset(&self, slice: &str) -> usize {
        let offset = (slice.as_ptr() as usize).wrapping_sub(self.text.as_ptr() as usize);
        if offset <= self.text.len() && self.text.is_char_boundary(offset) {
            offset
        } else {
            0
        }
    }

    /// The fields of a section `(name: value, ...)`. `what` names the section in messages.
    pub fn fields(&mut self, section: &'a str, what: &str) -> Vec<Field<'a>> {
        if !self.whole {
            return Vec::new();
        }
        let Some(inside) = inside(section, '(') else {
            self.not_a_section(section, what);
            return Vec::new();
        };
        let mut fields: Vec<Field<'a>> = Vec::new();
        for item in self.items(inside) {
            let mut rest = Some(&item[..]);
            while let Some(item) = rest {
                rest = self.field(item, &mut fields);
            }
        }
        let mut names = HashSet::new();
        for field in &fields {
            if !names.insert(field.name) {
                self.error(
                    field.name,
                    format!("{what} has `{}` twice", shown(field.name)),
                );
            }
        }
        fields
    }

    fn not_a_section(&mut self, text: &'a str, what: &str) {
        let message = match pieces(text)[..] {
            [] => format!("{what} is empty: it is written ( ... )"),
            [name, group] if name.kind == Kind::Word && group.text.starts_with('(') => {
                format!(
                    "{what} begins with `(`, without `{}` before it",
                    shown(name.text)
                )
            }
            [
                Piece {
                    kind: Kind::Group,
                    text,
                },
            ] => {
                format!(
                    "{what} is written (name: value, ...), not in `{}`",
                    &text[..1]
                )
            }
            _ => format!(
                "{what} is written (name: value, ...), found `{}`",
                shown(text)
            ),
        };
        self.error(text, message);
    }

    /// What stands between the commas. The last comma may be left out.
    fn items(&mut self, inside: &'a str) -> Vec<Vec<Piece<'a>>> {
        let mut items = Vec::new();
        let mut item = Vec::new();
        for piece in pieces(inside) {
            if piece.kind != Kind::Comma {
                item.push(piece);
            } else if item.is_empty() {
                self.error(piece.text, "there is a comma too many");
            } else {
                items.push(std::mem::take(&mut item));
            }
        }
        if !item.is_empty() {
            items.push(item);
        }
        items
    }

    /// Reads `name: value`. Returns what follows where its comma is missing.
    fn field<'p>(
        &mut self,
        item: &'p [Piece<'a>],
        fields: &mut Vec<Field<'a>>,
    ) -> Option<&'p [Piece<'a>]> {
        let name = item[0];
        if name.kind != Kind::Word {
            let message = match (name.kind, item.get(1)) {
                (Kind::Text, Some(colon)) if colon.kind == Kind::Colon => {
                    format!(
                        "a name has no quotes: {}",
                        shown(name.text.trim_matches(['"', '\'']))
                    )
                }
                _ => format!("expected `name: value`, found `{}`", shown(name.text)),
            };
            self.error(name.text, message);
            return None;
        }
        let rest = match item.get(1) {
            Some(colon) if colon.kind == Kind::Colon => &item[2..],
            Some(stray) if stray.text == "=" => {
                let name = shown(name.text);
                let message = format!("write `{name}: value`, with `:` in place of `=`");
                self.error(stray.text, message);
                &item[2..]
            }
            Some(_) => {
                self.error(
                    name.text,
                    format!("a `:` is missing after `{}`", shown(name.text)),
                );
                &item[1..]
            }
            None => {
                let after_a_number = fields.last().is_some_and(|last| is_number(last.value));
                let message = if after_a_number && is_number(name.text) {
                    "expected `name: value`; numbers have a point, not a comma: 0.5".to_owned()
                } else {
                    format!(
                        "`{}` has no value; expected `name: value`",
                        shown(name.text)
                    )
                };
                self.error(name.text, message);
                return None;
            }
        };
        let (value, rest) = match rest {
            [] => {
                self.error(name.text, format!("`{}` has no value", shown(name.text)));
                return None;
            }
            // `Some(1)` and `rgb(1, 2, 3)` are one value, and wrong as one.
            [word, group, rest @ ..] if word.kind == Kind::Word && group.kind == Kind::Group => {
                (between(word.text, group.text, self.text), rest)
            }
            [value, rest @ ..] => (value.text, rest),
        };
        fields.push(Field {
            name: name.text,
            value,
        });
        match rest {
            [] => None,
            [next, after, ..]
                if matches!(next.kind, Kind::Word | Kind::Text) && is_assigned(after) =>
            {
                self.error(
                    next.text,
                    format!("a comma is missing before `{}`", shown(next.text)),
                );
                Some(rest)
            }
            [stray, after @ ..] if stray.text == ";" => {
                self.error(stray.text, "write `,` in place of `;`");
                Some(after).filter(|after| !after.is_empty())
            }
            [next, ..] => {
                let message = format!(
                    "`{}` has one value, `{}`: found `{}` after it",
                    shown(name.text),
                    shown(value),
                    shown(next.text)
                );
                self.error(next.text, message);
                None
            }
        }
    }

    /// The items of a list `[a, b]`, as slices of the text.
    pub fn list(&mut self, list: &'a str, what: &str) -> Vec<&'a str> {
        if !self.whole {
            return Vec::new();
        }
        let Some(inside) = inside(list, '[') else {
            let found = shown(list.get(..1).unwrap_or_default());
            let message = if list.starts_with(['(', '{']) {
                format!("{what} is a list, written [..., ...], not in `{found}`")
            } else {
                format!(
                    "{what} is a list, written [..., ...], found `{}`",
                    shown(list)
                )
            };
            self.error(list, message);
            return Vec::new();
        };
        let mut items = Vec::new();
        for item in self.items(inside) {
            if item.iter().all(|piece| piece.kind == Kind::Group) {
                for piece in &item[1..] {
                    self.error(piece.text, "a comma is missing before this");
                }
                items.extend(item.iter().map(|piece| piece.text));
            } else {
                let last = item[item.len() - 1];
                items.push(between(item[0].text, last.text, self.text));
            }
        }
        items
    }

    /// A section of its own type, such as those that [`section!`](crate::section!) makes.
    pub fn section<S: Section + Default>(&mut self, section: &'a str, what: &str) -> S {
        let fields = self.fields(section, what);
        self.section_of(&fields, what)
    }

    /// A section of these fields. One that its table lacks is a mistake.
    pub fn section_of<S: Section + Default>(&mut self, fields: &[Field<'a>], what: &str) -> S {
        let mut section = S::default();
        self.fill(fields, &mut section, what);
        section
    }

    /// As [`Self::section_of`], of what has `lists` beside its table, which are read by others: a wrong name may mean one of them.
    pub fn section_beside<S: Section + Default>(
        &mut self,
        fields: &[Field<'a>],
        what: &str,
        lists: &[&str],
    ) -> S {
        let mut section = S::default();
        let mut names: Vec<&str> = section.table().iter().map(|p| p.name).collect();
        names.extend(lists.iter().copied());
        self.fill_or(fields, &mut section, |field| {
            let hint = suggestion(field.name, names.iter().copied());
            format!("{what} has no `{}`{hint}", shown(field.name))
        });
        section
    }

    /// Sets what these fields say of a section. One that its table lacks is a mistake.
    pub fn fill(&mut self, fields: &[Field<'a>], section: &mut dyn Section, what: &str) {
        let table = section.table();
        self.fill_or(fields, section, |field| unknown(field.name, table, what));
    }

    /// Sets what these fields say of a section; what is said of a field that its table lacks.
    pub(super) fn fill_or(
        &mut self,
        fields: &[Field<'a>],
        section: &mut dyn Section,
        unknown: impl Fn(&Field) -> String,
    ) {
        let table = section.table();
        for field in fields {
            match table.iter().position(|p| p.name == field.name) {
                Some(index) => {
                    if let Some(value) = self.value(field, &table[index]) {
                        section.set(index, value);
                    }
                }
                None => self.error(field.name, unknown(field)),
            }
        }
    }

    /// One value, or `None` after noting what is wrong with it.
    pub fn value(&mut self, field: &Field<'a>, param: &Param) -> Option<Value> {
        match parse_value(field.value, &param.kind) {
            Ok(value) => Some(value),
            Err(message) => {
                self.error(field.value, format!("{}: {message}", param.name));
                None
            }
        }
    }
}

/// What stands between the brackets of the one group that `text` is.
fn inside(text: &str, open: char) -> Option<&str> {
    match pieces(text)[..] {
        [
            Piece {
                kind: Kind::Group,
                text,
            },
        ] if text.starts_with(open) => Some(&text[1..text.len() - 1]),
        _ => None,
    }
}

/// The part of `text` from the beginning of its slice `first` to the end of its slice `last`.
fn between<'a>(first: &str, last: &str, text: &'a str) -> &'a str {
    let start = (first.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize);
    let end = (last.as_ptr() as usize + last.len()).wrapping_sub(text.as_ptr() as usize);
    text.get(start..end).unwrap_or_default()
}

fn is_assigned(piece: &Piece) -> bool {
    piece.kind == Kind::Colon || piece.text == "="
}

fn is_number(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}
