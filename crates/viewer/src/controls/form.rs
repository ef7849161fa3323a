//! All parameters of a table, each on a row: its name, a control, a button that takes it back to its default.

use super::color::{Chosen, color, optional_color};
use super::icon::{Icon, icon_button};
use super::number::{NumberField, exact, number};
use super::row::{Cells, Row, cell_text, reset_button};
use super::search::Search;
use super::text::{is_one_value, text_line};
use super::{Asked, choice, curve, help, tuple};
use crate::edit::{Edit, Place};
use effects::preset::{edit, read_value, suggestion};
use effects::{Param, ParamKind, Value, Variation};
use eframe::egui::{Button, Response, RichText, Ui};

/// The parameters of a table, as a section of a document says them.
pub struct Form<'a> {
    owner: &'a str,
    doc: &'a str,
    table: &'a [Param],
    section: Option<&'a str>,
    place: Place,
    below: &'a [(&'static str, String)],
    elsewhere: Vec<&'a str>,
    needed: &'a [&'a str],
    refusal: Option<Refusal<'a>>,
}

/// Why a parameter, by its name, can't have a text.
type Refusal<'a> = Box<dyn Fn(&str, &str) -> Option<String> + 'a>;

/// A parameter, and what the text says of it.
struct Shown<'a> {
    param: &'a Param,
    written: Option<&'a str>,
    /// What is said where the text says nothing, if it isn't the default.
    below: Option<&'a str>,
}

impl<'a> Shown<'a> {
    fn said(&self) -> Option<&'a str> {
        self.written.or(self.below)
    }
}

impl<'a> Form<'a> {
    /// The parameters of `table` in the `section` of a document's text, which is at `place`, or nowhere yet. The `owner` is
    /// named before each parameter: `hair.silhouette width`.
    #[must_use]
    pub fn new(owner: &'a str, table: &'a [Param], section: Option<&'a str>, place: Place) -> Self {
        Self {
            owner,
            doc: "",
            table,
            section,
            place,
            below: &[],
            elsewhere: Vec::new(),
            needed: &[],
            refusal: None,
        }
    }

    /// What the owner is about, where a search looks too.
    #[must_use]
    pub fn about(self, doc: &'a str) -> Self {
        Self { doc, ..self }
    }

    /// What a base says of the parameters, by their names: it stands where the text says nothing.
    #[must_use]
    pub fn over(self, below: &'a [(&'static str, String)]) -> Self {
        Self { below, ..self }
    }

    /// Fields that have controls of their own elsewhere: they are no mistakes of the text, and have no rows.
    #[must_use]
    pub fn without(mut self, fields: &[&'a str]) -> Self {
        self.elsewhere.extend_from_slice(fields);
        self
    }

    /// Fields that the section must have, which can't be taken back.
    #[must_use]
    pub fn needed(self, needed: &'a [&'a str]) -> Self {
        Self { needed, ..self }
    }

    /// Asks `refusal`, with a parameter's name and the text that it is to have, why it can't have that: what its schema
    /// doesn't know, such as that names are unique.
    #[must_use]
    pub fn refusing(self, refusal: impl Fn(&str, &str) -> Option<String> + 'a) -> Self {
        Self {
            refusal: Some(Box::new(refusal)),
            ..self
        }
    }

    /// Whether a search finds one of its parameters.
    #[must_use]
    pub fn matches(&self, search: &Search) -> bool {
        self.table.iter().any(|param| self.finds(search, param))
    }

    fn finds(&self, search: &Search, param: &Param) -> bool {
        let is_here = !self.elsewhere.contains(&param.name);
        is_here && search.matches(&[param.name, param.doc, self.owner, self.doc])
    }

    /// Shows the rows that a search finds, all without one. What their user asks for is added to `edits`.
    pub fn show(&self, ui: &mut Ui, search: &Search, edits: &mut Vec<Edit>) {
        let section = self.section.unwrap_or("()");
        if !section.starts_with('(') {
            raw_row(
                ui,
                self.owner,
                "",
                section,
                "expected (name: value, ...)",
                &self.place,
                edits,
            );
            return;
        }
        let fields = edit::fields(section, &[]);
        for param in self.table.iter().filter(|param| self.finds(search, param)) {
            let field = fields.iter().find(|(name, _)| *name == param.name);
            let below = self.below.iter().find(|(name, _)| *name == param.name);
            let shown = Shown {
                param,
                written: field.map(|(_, value)| *value),
                below: below.map(|(_, text)| &text[..]),
            };
            self.row(ui, &shown, edits);
        }
        for (i, (name, value)) in fields.iter().enumerate() {
            let is_known =
                self.elsewhere.contains(name) || self.table.iter().any(|param| param.name == *name);
            // A place leads to the first of that name.
            let is_again = fields[..i].iter().any(|(before, _)| before == name);
            if !is_known && !is_again && search.matches(&[name, self.owner]) {
                let names = self.table.iter().map(|param| param.name);
                let message = format!("there is no `{name:.40}` here{}", suggestion(name, names));
                let place = self.place.field(name);
                raw_row(ui, self.owner, name, value, &message, &place, edits);
            }
        }
    }

    fn row(&self, ui: &mut Ui, shown: &Shown, edits: &mut Vec<Edit>) {
        let Shown { param, written, .. } = *shown;
        let value = match shown.said().map(|text| read_value(text, &param.kind)) {
            None => param.kind.default_value(),
            Some(Err(_)) if written.is_none() => param.kind.default_value(),
            Some(Ok(value)) => value,
            Some(Err(message)) => {
                let text = written.unwrap_or_default();
                let place = self.place.field(param.name);
                raw_row(ui, self.owner, param.name, text, &message, &place, edits);
                return;
            }
        };
        let row = Row::new(ui, self.owner, param.name);
        let asked = row.show(ui, |ui| {
            let cells = Cells::of(ui);
            let line = ui.horizontal(|ui| {
                let visuals = ui.visuals();
                let color = match written {
                    Some(_) => visuals.strong_text_color(),
                    None => visuals.text_color(),
                };
                cell_text(ui, param.name, cells.name, color)
                    .on_hover_ui(|ui| drop(ui.label(help::help(param))));
                let asked = in_cell(ui, cells.control, |ui| {
                    control(ui, &row, shown, &value, cells.control)
                });
                let may_go = written.is_some() && !self.needed.contains(&param.name);
                match reset_button(ui, &row, may_go) {
                    true => Some(Asked::Default),
                    false => asked,
                }
            });
            let below = variation_below(ui, &row, param, &value);
            let asked = line.inner.or(below)?;
            match self.why_not(param.name, &asked) {
                Some(message) => {
                    row.note(ui, message);
                    None
                }
                None => Some(asked),
            }
        });
        let place = self.place.field(param.name);
        match asked {
            Some(Asked::Text(text)) => edits.push(Edit::Set(place, text)),
            Some(Asked::Default) if written.is_some() => edits.push(Edit::Remove(place)),
            _ => {}
        }
    }

    fn why_not(&self, name: &str, asked: &Asked) -> Option<String> {
        match asked {
            Asked::Default if self.needed.contains(&name) => {
                Some("it can't be left out".to_owned())
            }
            Asked::Default => None,
            Asked::Text(text) => self
                .refusal
                .as_ref()
                .and_then(|refusal| refusal(name, text)),
        }
    }
}

/// Shows what takes a part of a row, and leaves the rest of that part free.
fn in_cell<R>(ui: &mut Ui, width: f32, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let size = eframe::egui::vec2(width, ui.spacing().interact_size.y);
    let layout = *ui.layout();
    let shown = ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_width(width);
        contents(ui)
    });
    shown.inner
}

/// The control of one parameter.
fn control(ui: &mut Ui, row: &Row, shown: &Shown, value: &Value, width: f32) -> Option<Asked> {
    let param = shown.param;
    let said = shown.said();
    let kind = &param.kind;
    let (response, asked) = match (kind, value) {
        (ParamKind::Number { varies: true, .. }, _) => {
            let asked = varying(ui, row, param, value, width);
            return asked.map(|value| Asked::value(&value, kind));
        }
        (ParamKind::Number { .. }, Value::Number(old)) => {
            let (response, new) = number(ui, row, &field_of(param), exact(*old), width);
            let new = new.map(|new| Value::Number(new as f32));
            (Some(response), new.map(|new| Asked::value(&new, kind)))
        }
        (ParamKind::Integer { min, max, .. }, Value::Integer(old)) => {
            let enabled = min < max;
            let shown = ui.add_enabled_ui(enabled, |ui| {
                number(ui, row, &field_of(param), f64::from(*old), width)
            });
            let (response, new) = shown.inner;
            let new = new.map(|new| Value::Integer(new as i32));
            (Some(response), new.map(|new| Asked::value(&new, kind)))
        }
        (ParamKind::Flag { .. }, Value::Flag(old)) => {
            let (response, new) = choice::flag(ui, row, *old);
            let new = new.map(Value::Flag);
            (Some(response), new.map(|new| Asked::value(&new, kind)))
        }
        (ParamKind::Choice { names, .. }, Value::Choice(old)) => {
            let (response, new) = choice::choice(ui, row, names, *old as usize, width);
            let new = new.map(|new| Value::Choice(new as u32));
            (Some(response), new.map(|new| Asked::value(&new, kind)))
        }
        (ParamKind::Color { default }, _) => {
            let hex = said.and_then(digits_of);
            let (response, new) = color(ui, row, hex.as_deref().unwrap_or(default));
            (Some(response), new.map(|new| written_text(&new)))
        }
        (ParamKind::OptionalColor { default }, Value::Color(now)) => {
            let hex = match now {
                Some(_) => said.and_then(digits_of).or(default.map(str::to_owned)),
                None => None,
            };
            let otherwise = default.unwrap_or("808080");
            let (response, new) = optional_color(ui, row, hex.as_deref(), otherwise, width);
            let new = new.map(|new| match new {
                Chosen::None => Asked::Text("none".to_owned()),
                Chosen::Color(hex) => written_text(&hex),
            });
            (Some(response), new)
        }
        (ParamKind::Texture { default, .. }, Value::Texture(_)) => {
            let new = text_line(ui, row, "", said.unwrap_or(default), width, None);
            let new = new.map(|new| match new.trim() {
                "" => Asked::Default,
                // A gradient, none, or a name in quotes; else a file's name without them.
                text if read_value(text, kind).is_ok() => Asked::Text(text.to_owned()),
                text => written_text(text),
            });
            (None, new)
        }
        (ParamKind::Text, Value::Text(old)) => {
            let old = old.as_deref().unwrap_or_default();
            let new = text_line(ui, row, "", old, width, None);
            let new = new.map(|new| match new.trim() {
                "" => Asked::Default,
                text => written_text(text),
            });
            (None, new)
        }
        (ParamKind::Triple { .. }, Value::Triple(old)) => {
            let field = field_of(param);
            let old = old.map(exact);
            let (response, new) = tuple::tuple(ui, row, &field, ["x", "y", "z"], old, width);
            let new = new.map(|new| Value::Triple(new.map(|n| n as f32)));
            (response, new.map(|new| Asked::value(&new, kind)))
        }
        (ParamKind::Pair { .. }, Value::Pair(old)) => {
            let field = field_of(param);
            let old = old.map(exact);
            let (response, new) = tuple::tuple(ui, row, &field, ["x", "y"], old, width);
            let new = new.map(|new| Value::Pair(new.map(|n| n as f32)));
            (response, new.map(|new| Asked::value(&new, kind)))
        }
        (ParamKind::Size { .. }, Value::Size(old)) => {
            let field = field_of(param);
            let old = old.map(f64::from);
            let names = ["width", "height"];
            let (response, new) = tuple::tuple(ui, row, &field, names, old, width);
            let new = new.map(|new| Value::Size(new.map(|n| n as u32)));
            (response, new.map(|new| Asked::value(&new, kind)))
        }
        _ => (None, None),
    };
    describe(response, param);
    asked
}

fn describe(response: Option<Response>, param: &Param) {
    if let Some(response) = response {
        Row::describe(&response, param);
    }
}

/// A text as a document writes it.
fn written_text(text: &str) -> Asked {
    Asked::value(&Value::Text(Some(text.to_owned())), &ParamKind::Text)
}

/// The digits of a colour as they stand in the text.
fn digits_of(written: &str) -> Option<String> {
    match read_value(written, &ParamKind::Text) {
        Ok(Value::Text(digits)) => digits,
        _ => None,
    }
}

/// The range of a parameter's numbers.
fn field_of(param: &Param) -> NumberField<'_> {
    let (range, default, is_whole) = match param.kind {
        ParamKind::Number {
            min, max, default, ..
        } => ([exact(min), exact(max)], exact(default), false),
        ParamKind::Integer { min, max, default } => {
            ([f64::from(min), f64::from(max)], f64::from(default), true)
        }
        ParamKind::Triple { min, max, .. } | ParamKind::Pair { min, max, .. } => {
            ([exact(min), exact(max)], 0.0, false)
        }
        ParamKind::Size { min, max, .. } => ([f64::from(min), f64::from(max)], 0.0, true),
        _ => ([0.0, 1.0], 0.0, false),
    };
    NumberField {
        range,
        default,
        unit: param.unit,
        is_whole,
    }
}

/// A number that may vary: the number, or its curve in little, and a button that opens how it varies.
fn varying(ui: &mut Ui, row: &Row, param: &Param, value: &Value, width: f32) -> Option<Value> {
    let variation = curve::variation_of(value)?;
    let button = 20.0;
    ui.spacing_mut().item_spacing.x = 4.0;
    let room = width - button - 4.0;
    let mut is_open = is_variation_open(ui, row);
    let mut chosen = None;
    if curve::is_constant(&variation) {
        let old = exact(variation.at(0.0));
        let (response, new) = number(ui, row, &field_of(param), old, room);
        Row::describe(&response, param);
        chosen = new.map(|new| {
            curve::value_of(Variation {
                curve: vec![(0.0, new as f32)],
                ..variation
            })
        });
    } else if curve::sketch(ui, row, &variation, room) {
        is_open = !is_open;
    }
    ui.spacing_mut().button_padding.x = 4.0;
    let varies = matches!(value, Value::Varying(_));
    let tilde = RichText::new("~").strong();
    let toggle = Button::selectable(is_open || varies, tilde).min_size([button, 0.0].into());
    let toggle = ui.add(toggle).on_hover_text("How it varies");
    if toggle.accessible_name(row.part("variation")).clicked() {
        is_open = !is_open;
    }
    ui.data_mut(|data| data.insert_temp(row.id.with("variation"), is_open));
    chosen
}

fn is_variation_open(ui: &Ui, row: &Row) -> bool {
    let id = row.id.with("variation");
    ui.data(|data| data.get_temp(id)).unwrap_or_default()
}

/// What is below the row of a number whose variation is open.
fn variation_below(ui: &mut Ui, row: &Row, param: &Param, value: &Value) -> Option<Asked> {
    let ParamKind::Number { varies: true, .. } = param.kind else {
        return None;
    };
    if !is_variation_open(ui, row) {
        return None;
    }
    let variation = curve::variation_of(value)?;
    let shown = ui.indent("variation", |ui| {
        curve::editor(ui, row, &field_of(param), &variation)
    });
    let new = curve::value_of(shown.inner?);
    Some(Asked::value(&new, &param.kind))
}

/// A row for what can't be read: the text as it is, and what is wrong with it.
fn raw_row(
    ui: &mut Ui,
    owner: &str,
    name: &str,
    text: &str,
    message: &str,
    place: &Place,
    edits: &mut Vec<Edit>,
) {
    let row = Row::new(ui, owner, name);
    row.show(ui, |ui| {
        let cells = Cells::of(ui);
        let wrong = ui.visuals().error_fg_color;
        ui.horizontal(|ui| {
            cell_text(ui, name, cells.name, wrong);
            if let Some(typed) = text_line(ui, &row, "", text, cells.control, Some(wrong)) {
                if is_one_value(&typed) {
                    edits.push(Edit::Set(place.clone(), typed));
                } else {
                    row.note(ui, format!("`{typed:.40}` is not one value"));
                }
            }
            let remove = format!("reset {}", row.name);
            if icon_button(ui, Icon::Reset, &remove, "Take it out of the text").clicked() {
                edits.push(Edit::Remove(place.clone()));
            }
        });
        ui.label(RichText::new(message).small().color(wrong));
    });
}
