//! The layers of a preset: added from a list of all effects, named, switched off, looked at alone, put in order.

use super::items::{Change, List, new_name};
use super::look::about;
use super::parts::{quoted, text_of, with};
use crate::controls::{Cells, Form, Icon, Row, Search, cell_text, icon_button, text_line};
use crate::edit::{Edit, Place};
use crate::inherited::{Inherited, InheritedLayer};
use crate::layers_shown::LayersShown;
use effects::preset::edit::{self, Step};
use effects::preset::{LAYER, may_say, suggestion};
use effects::{AnyEffect, BrushSection, Param, ParamKind, Registry};
use eframe::egui::{ComboBox, RichText, ScrollArea, Ui};
use stage::{Preset, Sections};
use std::collections::BTreeSet;

/// A layer as the text has it.
struct Found<'a> {
    item: &'a str,
    /// What its `effect` says.
    id: String,
    effect: Option<&'a dyn AnyEffect>,
    /// What its `name` says, or the effect's id.
    name: String,
    /// What its brush's rows are called.
    brush_name: String,
    place: Place,
    /// The layer's own fields, with the effect's defaults.
    own: Vec<Param>,
    /// The layer of the base that it changes.
    below: Option<&'a InheritedLayer>,
}

/// Shows the layers of the preset `text`, and those of its base. Which of them are drawn is the viewer's to know, not the
/// preset's: `shown`.
pub fn layers(
    ui: &mut Ui,
    text: &str,
    inherited: &Inherited,
    registry: &Registry,
    shown: &mut LayersShown,
    search: &str,
    edits: &mut Vec<Edit>,
) {
    let search = Search::new(search);
    let place = Place::top().field("layers");
    let is_there = edit::get(text, &place.steps()).is_some();
    if !is_there && edit::get(text, &Place::top().field("objects").steps()).is_some() {
        ui.weak("This preset names objects, whose own presets have layers.");
        return;
    }
    let items = edit::items(text, &place.steps());
    let layers: Vec<Found> = items
        .iter()
        .enumerate()
        .map(|(index, item)| Found::read(item, index, place.item(index), inherited, registry))
        .collect();
    let is_changed = |of_base: &&InheritedLayer| layers.iter().any(|own| own.name == of_base.name);
    let of_base: Vec<&InheritedLayer> = inherited
        .layers
        .iter()
        .filter(|layer| !is_changed(layer))
        .collect();
    let all = layers.iter().map(|layer| &layer.name);
    forget_gone(
        shown,
        &all.chain(of_base.iter().map(|layer| &layer.name)).collect(),
    );
    let mut changed = None;
    for layer in &of_base {
        if search.matches(&[&layer.name, layer.effect]) && of_base_row(ui, layer, shown) {
            changed = Some(format!("(name: {})", quoted(&layer.name)));
        }
    }

    let list = List {
        noun: "layer",
        titles: layers.iter().map(|layer| layer.name.clone()).collect(),
        found: layers.iter().map(|layer| layer.matches(&search)).collect(),
        is_movable: true,
        may_remove: true,
    };
    let mut names: BTreeSet<String> = list.titles.iter().cloned().collect();
    names.extend(of_base.iter().map(|layer| layer.name.clone()));
    let mut renamed = None;
    let seen = std::cell::RefCell::new(&mut *shown);
    let change = list.show(
        ui,
        &search,
        |ui, index| switches(ui, &layers[index].name, &mut seen.borrow_mut()),
        |ui, index| {
            let layer = &layers[index];
            if let Some(new) = layer.show(ui, registry, &names, &search, edits) {
                renamed = Some((layer.name.clone(), new));
            }
        },
    );
    if let Some((old, new)) = renamed {
        rename(&mut shown.hidden, &old, &new);
        rename(&mut shown.solo, &old, &new);
    }
    edits.extend(change.map(|change| match change {
        Change::Remove(index) => Edit::Remove(place.item(index)),
        Change::Move(from, to) => Edit::Move(place.clone(), from, to),
        Change::Duplicate(index) => {
            let copy = layers[index].copy(&names);
            Edit::Insert(place.clone(), index + 1, copy)
        }
    }));
    if let Some(layer) = add_layer(ui, registry, &names).or(changed) {
        edits.push(match is_there {
            true => Edit::Insert(place, items.len(), layer),
            false => Edit::Set(place, format!("[{layer}]")),
        });
    }
}

/// Forgets layers that are not there any more: one that is looked at alone and gone would hide all others.
fn forget_gone(shown: &mut LayersShown, layers: &BTreeSet<&String>) {
    if layers.is_empty() {
        return;
    }
    let is_there = |name: &String| layers.contains(name);
    shown.hidden.retain(is_there);
    shown.solo.retain(is_there);
}

/// A layer of the base of which the preset says nothing. Gives whether its user wants to say something.
fn of_base_row(ui: &mut Ui, layer: &InheritedLayer, shown: &mut LayersShown) -> bool {
    ui.horizontal(|ui| {
        switches(ui, &layer.name, shown);
        ui.label(&layer.name)
            .on_hover_text(format!("The base's: {}", layer.effect));
        let help = "The base has this layer. Say here what of it is otherwise.";
        let button = ui.small_button("change").on_hover_text(help);
        button
            .accessible_name(format!("change layer {}", layer.name))
            .clicked()
    })
    .inner
}

fn rename(names: &mut BTreeSet<String>, old: &str, new: &str) {
    if names.remove(old) {
        names.insert(new.to_owned());
    }
}

/// The buttons that switch a layer off and that show it alone.
fn switches(ui: &mut Ui, name: &str, shown: &mut LayersShown) {
    let weak = ui.visuals().text_color();
    let strong = ui.visuals().strong_text_color();
    let is_hidden = shown.hidden.contains(name);
    let is_alone = shown.solo.contains(name);
    let (eye, verb, help) = match is_hidden {
        true => (Icon::ClosedEye, "show", "Switched off: switch it on"),
        false => (
            Icon::Eye,
            "hide",
            "Switch it off. The preset is not changed.",
        ),
    };
    if icon_button(ui, eye, &format!("{verb} layer {name}"), help).clicked() {
        toggle(&mut shown.hidden, name);
    }
    let solo = RichText::new("S").color(if is_alone { strong } else { weak });
    let help = match is_alone {
        true => "Looked at alone: show the others too",
        false => "Look at it alone",
    };
    if sign(ui, solo, is_alone, &format!("solo layer {name}"), help) {
        toggle(&mut shown.solo, name);
    }
}

fn sign(ui: &mut Ui, sign: RichText, is_on: bool, name: &str, help: &str) -> bool {
    let button = eframe::egui::Button::selectable(is_on, sign).min_size([18.0, 0.0].into());
    let response = ui.add(button).on_hover_text(help);
    response.accessible_name(name).clicked()
}

fn toggle(names: &mut BTreeSet<String>, name: &str) {
    if !names.remove(name) {
        names.insert(name.to_owned());
    }
}

impl<'a> Found<'a> {
    fn read(
        item: &'a str,
        index: usize,
        place: Place,
        inherited: &'a Inherited,
        registry: &'a Registry,
    ) -> Self {
        let own_name = text_of(item, "name");
        let of_name = own_name.as_deref().and_then(|name| inherited.layer(name));
        let own_id = text_of(item, "effect");
        let id = own_id.or_else(|| of_name.map(|layer| layer.effect.to_owned()));
        let id = id.unwrap_or_default();
        let effect = registry.get(&id);
        let name = own_name.unwrap_or_else(|| id.clone());
        let below = inherited.layer(&name).filter(|layer| layer.effect == id);
        let name = match name.is_empty() {
            true => format!("number {}", index + 1),
            false => name,
        };
        Self {
            item,
            brush_name: format!("{name} brush"),
            name,
            own: effect.map_or_else(|| LAYER.to_vec(), own_fields),
            id,
            effect,
            place,
            below,
        }
    }

    /// Whether it says its effect. Without one it is the base's layer of its name: by another it would be none.
    fn has_effect(&self) -> bool {
        edit::get(self.item, &[Step::Field("effect")]).is_some()
    }

    fn own_form(&self) -> Form<'_> {
        Form::new(&self.name, &self.own, Some(self.item), self.place.clone())
            .about("layer")
            .over(self.below.map_or(&[], |below| &below.own))
            .without(&["effect", "name", "params", "brush"])
    }

    fn effect_form(&self) -> Option<Form<'_>> {
        let effect = self.effect?;
        let params = edit::get(self.item, &[Step::Field("params")]);
        let place = self.place.field("params");
        let form = Form::new(&self.name, effect.params(), params, place).about(effect.id());
        Some(form.over(self.below.map_or(&[], |below| &below.params)))
    }

    /// What its strokes are drawn with, of an effect that draws some.
    fn brush_form(&self) -> Option<Form<'_>> {
        self.effect.filter(|effect| may_say(*effect, "brush"))?;
        let brush = edit::get(self.item, &[Step::Field("brush")]);
        let place = self.place.field("brush");
        let form = Form::new(&self.brush_name, BrushSection::TABLE, brush, place).about("brush");
        Some(form.over(self.below.map_or(&[], |below| &below.brush)))
    }

    fn matches(&self, search: &Search) -> bool {
        let doc = self.effect.map_or("", |effect| effect.doc());
        let effect = self.effect_form();
        search.matches(&[&self.name, &self.id, doc])
            || self.own_form().matches(search)
            || effect.is_some_and(|form| form.matches(search))
            || self.brush_form().is_some_and(|form| form.matches(search))
    }

    /// Shows what the layer says. Gives its new name, where it has one from now on.
    fn show(
        &self,
        ui: &mut Ui,
        registry: &Registry,
        names: &BTreeSet<String>,
        search: &Search,
        edits: &mut Vec<Edit>,
    ) -> Option<String> {
        match self.effect {
            Some(effect) => about(ui, &format!("{}: {}", effect.id(), effect.doc())),
            None => self.other_effect(ui, registry, edits),
        }
        let own = self.own_form();
        let params = self.effect_form();
        let brush = self.brush_form();
        // What matches as a whole is shown as a whole.
        let all = Search::default();
        let has_rows = |form: &Form| form.matches(search);
        let mut others = params.iter().chain(&brush);
        let search = match has_rows(&own) || others.any(has_rows) {
            true => search,
            false => &all,
        };
        let renamed = match self.has_effect() && search.matches(&["name", "rename", &self.name]) {
            true => self.name_row(ui, names, edits),
            false => None,
        };
        if let Some(form) = params {
            form.show(ui, search, edits);
        }
        if own.matches(search) {
            ui.add_space(2.0);
            own.show(ui, search, edits);
        }
        if let Some(brush) = brush.filter(|brush| brush.matches(search)) {
            ui.add_space(2.0);
            about(ui, "Brush");
            // Its rows may be called as some of the effect's are.
            ui.push_id("brush", |ui| brush.show(ui, search, edits));
        }
        renamed
    }

    /// What is shown of an effect that this program doesn't have.
    fn other_effect(&self, ui: &mut Ui, registry: &Registry, edits: &mut Vec<Edit>) {
        let ids = || registry.iter().map(AnyEffect::id);
        let message = match self.id.as_str() {
            "" => "a layer needs `effect`, such as effect: \"hair.base\"".to_owned(),
            id => format!("there is no effect `{id:.60}`{}", suggestion(id, ids())),
        };
        let wrong = ui.visuals().error_fg_color;
        ui.label(RichText::new(message).small().color(wrong));
        let list = ComboBox::from_id_salt("effect").selected_text("another effect");
        let response = list.show_ui(ui, |ui| {
            for id in ids() {
                if ui.selectable_label(false, id).clicked() {
                    edits.push(Edit::Set(self.place.field("effect"), quoted(id)));
                }
            }
        });
        response
            .response
            .accessible_name(format!("{} effect", self.name));
    }

    fn name_row(
        &self,
        ui: &mut Ui,
        names: &BTreeSet<String>,
        edits: &mut Vec<Edit>,
    ) -> Option<String> {
        let row = Row::new(ui, &self.name, "name");
        let place = self.place.field("name");
        row.show(ui, |ui| {
            let cells = Cells::of(ui);
            let has_own = edit::get(self.item, &[Step::Field("name")]).is_some();
            let typed = ui.horizontal(|ui| {
                let color = match has_own {
                    true => ui.visuals().strong_text_color(),
                    false => ui.visuals().text_color(),
                };
                cell_text(ui, "name", cells.name, color).on_hover_text(
                    "A name of its own, unique in the preset; the effect's id by default.",
                );
                let typed = text_line(ui, &row, "", &self.name, cells.control, None);
                let reset = format!("reset {}", row.name);
                if has_own
                    && icon_button(ui, Icon::Reset, &reset, "Back to the effect's id").clicked()
                {
                    return Some(String::new());
                }
                typed
            });
            let typed = typed.inner?.trim().to_owned();
            let new = if typed.is_empty() {
                self.id.clone()
            } else {
                typed
            };
            if new == self.name && !has_own {
                return None;
            }
            if new != self.name && is_taken(&new, names) {
                row.note(ui, format!("`{new:.60}` is another's name"));
                return None;
            }
            edits.push(match new == self.id {
                true if has_own => Edit::Remove(place),
                true => return None,
                false => Edit::Set(place, quoted(&new)),
            });
            Some(new)
        })
    }

    /// The layer's text under a new name. What it has by its name of a layer of the base is written in it.
    fn copy(&self, names: &BTreeSet<String>) -> String {
        let name = new_name(&self.name, |name| is_taken(name, names));
        let mut copy = with(self.item, &[Step::Field("name")], &quoted(&name));
        let Some(below) = self.below else {
            return copy;
        };
        let mut add = |path: &[Step], value: &str| {
            if edit::get(&copy, path).is_none() {
                copy = with(&copy, path, value);
            }
        };
        add(&[Step::Field("effect")], &quoted(below.effect));
        for (name, value) in &below.own {
            if self.own.iter().any(|param| param.name == *name) {
                add(&[Step::Field(name)], value);
            }
        }
        for (section, texts) in [("brush", &below.brush), ("params", &below.params)] {
            let says = self.effect.is_some_and(|effect| may_say(effect, section));
            for (name, value) in texts.iter().filter(|_| says) {
                add(&[Step::Field(section), Step::Field(name)], value);
            }
        }
        copy
    }
}

/// Whether a new layer can't have a name: it is another layer's, or a section's.
fn is_taken(name: &str, names: &BTreeSet<String>) -> bool {
    names.contains(name)
        || ["layers", "meshes", "lines", "bodies", "passes", "objects"].contains(&name)
        || Preset::TOP.iter().any(|param| param.name == name)
        || Sections::ALL.iter().any(|(section, ..)| *section == name)
}

/// A layer's own fields, with the defaults that they have of this effect.
fn own_fields(effect: &dyn AnyEffect) -> Vec<Param> {
    let of_effect = |param: &Param| {
        let mut param = *param;
        match (&mut param.kind, param.name) {
            (ParamKind::Integer { default, .. }, "rank") => *default = effect.rank(),
            (ParamKind::Number { default, .. }, "depth_offset") => *default = effect.depth_offset(),
            (ParamKind::Number { default, .. }, "reach") => *default = effect.clip_reach(),
            _ => {}
        }
        param
    };
    let own = LAYER.iter().filter(|param| may_say(effect, param.name));
    own.map(of_effect).collect()
}

/// A button with a list of all effects. Gives the text of the layer that was chosen.
fn add_layer(ui: &mut Ui, registry: &Registry, names: &BTreeSet<String>) -> Option<String> {
    ui.add_space(4.0);
    let menu = ui.menu_button("+ layer", |ui| {
        let mut chosen = None;
        ui.set_max_width(280.0);
        ScrollArea::vertical().max_height(400.0).show(ui, |ui| {
            for effect in registry.iter() {
                let button = ui.button(effect.id());
                let name = format!("add {}", effect.id());
                if button.accessible_name(name).clicked() {
                    chosen = Some(new_layer(effect, names));
                }
                about(ui, effect.doc());
            }
        });
        chosen
    });
    let response = menu.response.accessible_name("add layer");
    response.on_hover_text("Add a layer with one of the effects");
    menu.inner.flatten()
}

/// The text of a layer of that effect.
fn new_layer(effect: &dyn AnyEffect, names: &BTreeSet<String>) -> String {
    let id = effect.id();
    let mut text = format!("(effect: {}", quoted(id));
    let name = new_name(id, |name| is_taken(name, names));
    if name != id {
        text += &format!(", name: {}", quoted(&name));
    }
    if effect.is_for_meshes() {
        text += ", on: \"*\"";
    } else if effect.is_for_lines() {
        text += ", on: \"rim\"";
    }
    text + ")"
}
