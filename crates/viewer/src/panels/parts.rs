//! Lists of the parts of a hair style or a motion script: zones, edits, strands; moves, keys, winds, shapes.

use super::fold::fold;
use super::items::{Change, List};
use super::look::about;
use super::places::{self, PlaceField};
use crate::controls::{Form, Search};
use crate::edit::{Edit, Place};
use effects::preset::edit::{self, Step};
use effects::preset::read_value;
use effects::{Param, ParamKind, Value};
use eframe::egui::Ui;
use stage::FilePart;
use std::cell::OnceCell;

/// A list of parts as a pane shows it.
pub(super) struct Parts<'a> {
    /// The part's table and words.
    pub part: &'a FilePart,
    /// What one of them is called: `zone`.
    pub noun: &'a str,
    /// Titles of the items.
    pub titles: Vec<String>,
    /// Fields that are places on the head.
    pub fields: &'a [PlaceField],
    /// Fields that an item must have.
    pub needed: &'a [&'a str],
    /// Why a field of an item, by its number and name, can't have a text.
    pub refusal: &'a dyn Fn(usize, &str, &str) -> Option<String>,
    /// Whether the items' order is its user's to choose.
    pub is_movable: bool,
    /// Whether items may go.
    pub may_remove: bool,
    /// Whether there may be more.
    pub may_add: bool,
}

/// What is to be done with the list.
pub(super) enum Asked {
    /// With one of its items.
    Of(Change),
    /// A new one.
    Add,
}

impl Parts<'_> {
    /// The list in the document.
    pub fn place(&self) -> Place {
        Place::top().field(self.part.name)
    }

    /// Shows the list of the document `text` as a part to open. `table` gives an item's parameters. Gives what is to be done
    /// with the list, once the `edits` of its items are done.
    pub fn show(
        &self,
        ui: &mut Ui,
        text: &str,
        search: &Search,
        table: impl Fn(usize) -> Vec<Param>,
        edits: &mut Vec<Edit>,
    ) -> Option<Asked> {
        let place = self.place();
        let items = edit::items(text, &place.steps());
        let owners: Vec<String> = (self.titles.iter())
            .map(|title| format!("{} {title}", self.noun))
            .collect();
        // Of items that are shown, or searched.
        let tables: Vec<OnceCell<Vec<Param>>> = vec![OnceCell::new(); items.len()];
        let names: Vec<&str> = self.fields.iter().map(|field| field.name).collect();
        let form = |index: usize| {
            let place = place.item(index);
            let table = tables[index].get_or_init(|| table(index));
            Form::new(&owners[index], table, Some(items[index]), place)
                .about(self.part.doc)
                .without(&names)
                .needed(self.needed)
                .refusing(move |field, text| (self.refusal)(index, field, text))
        };
        let finds = |index: usize| {
            !search.is_active()
                || form(index).matches(search)
                || places::matches(self.fields, &owners[index], search)
        };
        let list = List {
            noun: self.noun,
            titles: self.titles.clone(),
            found: (0..items.len()).map(finds).collect(),
            is_movable: self.is_movable,
            may_remove: self.may_remove,
        };
        let words = [self.part.name, self.part.doc];
        if search.is_active() && !list.found.contains(&true) && !search.matches(&words) {
            return None;
        }
        let mut asked = None;
        fold(ui, self.part.name, true, search, |ui| {
            about(ui, self.part.doc);
            let contents = |ui: &mut Ui, index: usize| {
                let (owner, item) = (&owners[index], items[index]);
                let form = form(index);
                form.show(ui, search, edits);
                let place = place.item(index);
                places::places(ui, owner, self.fields, item, &place, search, edits);
            };
            let change = list.show(ui, search, |_, _| {}, contents);
            asked = change.map(Asked::Of);
            let name = format!("add {}", self.noun);
            let button = ui.add_enabled_ui(self.may_add, |ui| {
                let button = ui.button(format!("+ {}", self.noun));
                button.accessible_name(name).clicked()
            });
            if button.inner {
                asked = Some(Asked::Add);
            }
        });
        asked
    }

    /// The edit that puts a new item at the end of the list.
    pub fn add(&self, text: &str, item: &str) -> Edit {
        let place = self.place();
        match edit::get(text, &place.steps()) {
            Some(_) => {
                let count = edit::items(text, &place.steps()).len();
                Edit::Insert(place, count, item.to_owned())
            }
            None => Edit::Set(place, format!("[{item}]")),
        }
    }
}

/// The items of a list of the document.
pub(super) fn items_of<'t>(text: &'t str, list: &str) -> Vec<&'t str> {
    edit::items(text, &[Step::Field(list)])
}

/// The value that an item gives a parameter of a table, or its default.
pub(super) fn value_of(item: &str, table: &[Param], name: &str) -> Option<Value> {
    let kind = table.iter().find(|param| param.name == name)?.kind;
    let written = edit::get(item, &[Step::Field(name)]);
    let value = written.and_then(|text| read_value(text, &kind).ok());
    Some(value.unwrap_or_else(|| kind.default_value()))
}

/// The number that an item gives a parameter of a table, or its default.
pub(super) fn number_of(item: &str, table: &[Param], name: &str) -> f32 {
    match value_of(item, table, name) {
        Some(Value::Number(number)) => number,
        Some(Value::Integer(number)) => number as f32,
        _ => 0.0,
    }
}

/// The text that an item gives a field.
pub(super) fn text_of(item: &str, name: &str) -> Option<String> {
    let written = edit::get(item, &[Step::Field(name)])?;
    match read_value(written, &ParamKind::Text) {
        Ok(Value::Text(text)) => text,
        _ => None,
    }
}

/// A text as a document writes it.
pub(super) fn quoted(text: &str) -> String {
    edit::written(&Value::Text(Some(text.to_owned())), &ParamKind::Text)
}

/// An item with another value at a place in it; as it was where it can't have that.
pub(super) fn with(item: &str, path: &[Step], value: &str) -> String {
    edit::set(item, path, value).unwrap_or_else(|_| item.to_owned())
}
