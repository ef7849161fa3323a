//! Reading sections of a preset from its text.

use super::error::{PresetError, PresetErrors, suggestion};
use crate::color::parse_hex;
use crate::param::{Param, ParamKind, Value, Values};
use ron::value::RawValue;
use serde::de::{self, Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// A preset's text, and the mistakes found in it so far.
pub struct Reader<'a> {
    file: String,
    text: &'a str,
    errors: Vec<PresetError>,
}

/// One `name: value` of a section.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    /// The name, a slice of the text.
    pub name: &'a str,
    /// The value's text, a slice of the text without space around it.
    pub value: &'a str,
}

impl<'a> Reader<'a> {
    /// A reader of `text`, which messages call `file`.
    #[must_use]
    pub fn new(file: &str, text: &'a str) -> Self {
        Self {
            file: file.to_owned(),
            text,
            errors: Vec::new(),
        }
    }

    /// The whole text.
    #[must_use]
    pub fn text(&self) -> &'a str {
        self.text
    }

    /// Reports the mistakes that were found, if there are any.
    ///
    /// # Errors
    ///
    /// All of them, in the order of the file.
    pub fn report(&mut self) -> Result<(), PresetErrors> {
        if self.errors.is_empty() {
            return Ok(());
        }
        let mut errors = std::mem::take(&mut self.errors);
        errors.sort_by_key(|e| (e.line, e.column));
        Err(PresetErrors(errors))
    }

    /// Notes a mistake at the place where `slice`, a part of the text, begins.
    pub fn error(&mut self, slice: &str, message: impl Into<String>) {
        self.error_at(self.offset(slice), message.into());
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

    fn error_at(&mut self, offset: usize, message: String) {
        let before = &self.text[..offset];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        self.errors.push(PresetError {
            file: self.file.clone(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            message,
            source_line: self.text[line_start..]
                .lines()
                .next()
                .unwrap_or_default()
                .to_owned(),
        });
    }

    /// Notes a mistake that RON found in `slice`.
    fn syntax_error(&mut self, slice: &str, error: &ron::error::SpannedError) {
        let place = &error.span.start;
        let lines: usize = slice
            .split_inclusive('\n')
            .take(place.line.saturating_sub(1))
            .map(str::len)
            .sum();
        let column: usize = slice[lines..]
            .chars()
            .take(place.col.saturating_sub(1))
            .map(char::len_utf8)
            .sum();
        self.error_at(self.offset(slice) + lines + column, error.code.to_string());
    }

    /// The fields of a section `(name: value, ...)`. `what` names the section in messages.
    pub fn fields(&mut self, section: &'a str, what: &str) -> Vec<Field<'a>> {
        match ron::from_str::<Fields<'a>>(section) {
            Ok(Fields(fields)) => {
                let fields: Vec<_> = fields
                    .into_iter()
                    .map(|(name, raw)| (self.own(name), raw.trim().get_ron()))
                    .map(|(name, value)| Field { name, value })
                    .collect();
                self.report_twins(&fields, what);
                fields
            }
            Err(error) => {
                self.syntax_error(section, &error);
                Vec::new()
            }
        }
    }

    /// The slice of the text that `name` points to.
    fn own(&self, name: Name) -> &'a str {
        let offset = name.address.wrapping_sub(self.text.as_ptr() as usize);
        self.text
            .get(offset..offset.saturating_add(name.length))
            .unwrap_or_default()
    }

    fn report_twins(&mut self, fields: &[Field<'a>], what: &str) {
        for (i, field) in fields.iter().enumerate() {
            if fields[..i].iter().any(|other| other.name == field.name) {
                self.error(field.name, format!("{what} has `{}` twice", field.name));
            }
        }
    }

    /// The items of a list `[a, b]`, as slices of the text.
    pub fn list(&mut self, list: &'a str, what: &str) -> Vec<&'a str> {
        if !list.starts_with('[') {
            self.error(list, format!("{what} is a list: [..., ...]"));
            return Vec::new();
        }
        match ron::from_str::<Vec<&'a RawValue>>(list) {
            Ok(items) => items.into_iter().map(|raw| raw.trim().get_ron()).collect(),
            Err(error) => {
                self.syntax_error(list, &error);
                Vec::new()
            }
        }
    }

    /// A section whose fields are those of `table`.
    pub fn section(&mut self, section: &'a str, table: &'static [Param], what: &str) -> Values {
        let fields = self.fields(section, what);
        self.values(&fields, table, what)
    }

    /// The values of these fields by `table`. A field that the table lacks is a mistake.
    pub fn values(&mut self, fields: &[Field<'a>], table: &'static [Param], what: &str) -> Values {
        let mut values = Values::defaults(table);
        for field in fields {
            let Some(index) = table.iter().position(|p| p.name == field.name) else {
                let names = table.iter().map(|p| p.name);
                let hint = if table.is_empty() {
                    "; it has no parameters".to_owned()
                } else {
                    suggestion(field.name, names)
                };
                self.error(field.name, format!("{what} has no `{}`{hint}", field.name));
                continue;
            };
            if let Some(value) = self.value(field, &table[index]) {
                values.set(index, value);
            }
        }
        values
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

/// The value that `text` gives a parameter of this kind.
pub(crate) fn parse_value(text: &str, kind: &ParamKind) -> Result<Value, String> {
    let shown: String = text.chars().take(40).collect();
    let wrong = || format!("expected {}, found `{shown}`", kind.expected());
    match *kind {
        ParamKind::Number { min, max, .. } => {
            let value = ron::from_str::<f32>(text).map_err(|_| wrong())?;
            (value >= min && value <= max)
                .then_some(Value::Number(value))
                .ok_or_else(wrong)
        }
        ParamKind::Integer { min, max, .. } => {
            let value = ron::from_str::<i32>(text).map_err(|_| wrong())?;
            (value >= min && value <= max)
                .then_some(Value::Integer(value))
                .ok_or_else(wrong)
        }
        ParamKind::Choice { names, .. } => match names.iter().position(|name| *name == text) {
            Some(index) => Ok(Value::Choice(index as u32)),
            None => Err(format!(
                "there is no `{shown}`{}",
                suggestion(text, names.iter().copied())
            )),
        },
        ParamKind::OptionalColor { .. } if text == "none" => Ok(Value::Color(None)),
        ParamKind::Color { .. } | ParamKind::OptionalColor { .. } => {
            let hex = ron::from_str::<String>(text).map_err(|_| wrong())?;
            let color = parse_hex(&hex).ok_or_else(wrong)?;
            Ok(Value::Color(Some(color)))
        }
        ParamKind::Text => {
            let text = ron::from_str::<String>(text).map_err(|_| wrong())?;
            Ok(Value::Text(Some(text)))
        }
        ParamKind::Triple { min, max, .. } => {
            let triple = ron::from_str::<[f32; 3]>(text).map_err(|_| wrong())?;
            let legal = triple.iter().all(|x| *x >= min && *x <= max);
            legal.then_some(Value::Triple(triple)).ok_or_else(wrong)
        }
        ParamKind::Size { min, max, .. } => {
            let size = ron::from_str::<[u32; 2]>(text).map_err(|_| wrong())?;
            let legal = size.iter().all(|x| *x >= min && *x <= max);
            legal.then_some(Value::Size(size)).ok_or_else(wrong)
        }
    }
}

/// A RON struct with any fields, their values unread.
struct Fields<'a>(Vec<(Name, &'a RawValue)>);

/// Where a field's name stands.
struct Name {
    address: usize,
    length: usize,
}

impl<'de> Deserialize<'de> for Fields<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct FieldsVisitor;
        impl<'de> Visitor<'de> for FieldsVisitor {
            type Value = Fields<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a section (name: value, ...)")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut fields = Vec::new();
                while let Some(name) = map.next_key::<Name>()? {
                    fields.push((name, map.next_value::<&'de RawValue>()?));
                }
                Ok(Fields(fields))
            }

            // An empty section `()`.
            fn visit_unit<E: de::Error>(self) -> Result<Self::Value, E> {
                Ok(Fields(Vec::new()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
                match seq.next_element::<de::IgnoredAny>()? {
                    None => Ok(Fields(Vec::new())),
                    Some(_) => Err(de::Error::custom("expected `name: value` here")),
                }
            }
        }
        deserializer.deserialize_any(FieldsVisitor)
    }
}

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameVisitor;
        impl Visitor<'_> for NameVisitor {
            type Value = Name;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a field's name")
            }

            fn visit_str<E: de::Error>(self, name: &str) -> Result<Name, E> {
                Ok(Name {
                    address: name.as_ptr() as usize,
                    length: name.len(),
                })
            }
        }
        deserializer.deserialize_identifier(NameVisitor)
    }
}
