//! The sections of a preset: hair, head, picture, camera, light, motion, dynamics, path and clump, and the objects of a
//! preset that has some.

use super::fold::fold;
use super::items::{Change, List};
use super::parts::{Asked, Parts, items_of, value_of};
use crate::controls::{Form, Search};
use crate::edit::{Edit, Place};
use crate::inherited::Inherited;
use effects::preset::edit;
use effects::{Param, ParamKind, Value};
use eframe::egui::{RichText, Ui};
use stage::{BODIES, FilePart, LINES, MESHES, ObjectSection, PASSES, Preset, Sections};

/// The name of what stands in a preset beside its sections: its version and seed.
pub const PRESET: &str = "preset";

/// What the preset's own fields are about.
const PRESET_DOC: &str = "What stands in a preset beside its sections and layers.";

/// The sections that a preset of objects says itself; the others are said by its objects' presets.
const OF_THE_SCENE: [&str; 3] = ["scene", "camera", "light"];

/// All of a preset's text but its layers, each section as a part to open; where it says nothing, what its base says.
pub fn look(ui: &mut Ui, text: &str, inherited: &Inherited, search: &str, edits: &mut Vec<Edit>) {
    let names = Sections::ALL.iter().map(|(name, ..)| *name);
    for name in std::iter::once(PRESET).chain(names) {
        section(ui, text, name, inherited, search, edits);
    }
    meshes(ui, text, search, edits);
    lines(ui, text, search, edits);
    bodies(ui, text, search, edits);
    passes(ui, text, search, edits);
    objects(ui, text, search, edits);
}

/// The passes of the preset `text`, each with what lines it draws.
fn passes(ui: &mut Ui, text: &str, search: &str, edits: &mut Vec<Edit>) {
    let kind = PASSES.table.iter().find(|param| param.name == "edges");
    let names = match kind.map(|param| param.kind) {
        Some(ParamKind::Choice { names, .. }) => names,
        _ => &[],
    };
    let title = |(index, item): (usize, &&str)| {
        let between = match value_of(item, PASSES.table, "edges") {
            Some(Value::Choice(choice)) => names.get(choice as usize).copied(),
            _ => None,
        };
        format!("{}: {}", index + 1, between.unwrap_or_default())
    };
    let shown = Shown {
        noun: "pass",
        needed: &[],
        new: "(edges: strand)",
        title: &title,
    };
    list(ui, text, &PASSES, &shown, search, edits);
}

/// The meshes of the preset `text`, each with its file or shape.
fn meshes(ui: &mut Ui, text: &str, search: &str, edits: &mut Vec<Edit>) {
    let title = |(index, item): (usize, &&str)| {
        let field = |name: &str| edit::get(item, &[edit::Step::Field(name)]);
        let of = field("file").or_else(|| field("shape")).unwrap_or("?");
        format!("{}: {}", index + 1, of.trim_matches('"'))
    };
    let shown = Shown {
        noun: "mesh",
        needed: &["file", "shape"],
        new: "(file: \"mesh.obj\")",
        title: &title,
    };
    let before = edits.len();
    list(ui, text, &MESHES, &shown, search, edits);
    let others = other_kind(text, &edits[before..]);
    edits.extend(others);
}

/// What a mesh can't have any more once `edits` have made it one of a file, or a thing of a shape.
fn other_kind(text: &str, edits: &[Edit]) -> Vec<Edit> {
    let meshes = Place::top().field(MESHES.name);
    let mut others = Vec::new();
    for index in 0..edit::items(text, &meshes.steps()).len() {
        let item = meshes.item(index);
        let gets = |name: &str| {
            let set = |edit: &Edit| match edit {
                Edit::Set(place, text) => *place == item.field(name) && text != "none",
                _ => false,
            };
            edits.iter().any(set)
        };
        let goes: &[&str] = match (gets("file"), gets("shape")) {
            (true, _) => &["shape"],
            (_, true) => &["file", "texture"],
            _ => &[],
        };
        let there = goes.iter().map(|name| item.field(name));
        let there = there.filter(|place| edit::get(text, &place.steps()).is_some());
        others.extend(there.map(Edit::Remove));
    }
    others
}

/// The lines of meshes of the preset `text`, each list with its name.
fn lines(ui: &mut Ui, text: &str, search: &str, edits: &mut Vec<Edit>) {
    let title = |(index, item): (usize, &&str)| {
        let name = edit::get(item, &[edit::Step::Field("name")]).unwrap_or("?");
        format!("{}: {}", index + 1, name.trim_matches('"'))
    };
    let shown = Shown {
        noun: "lines",
        needed: &["name"],
        new: "(name: \"rim\")",
        title: &title,
    };
    list(ui, text, &LINES, &shown, search, edits);
}

/// The bodies of the preset or motion script `text`, each with its name or shape.
pub(super) fn bodies(ui: &mut Ui, text: &str, search: &str, edits: &mut Vec<Edit>) {
    let title = |(index, item): (usize, &&str)| {
        let field = |name: &str| edit::get(item, &[edit::Step::Field(name)]);
        let name = field("name").or_else(|| field("shape")).unwrap_or("sphere");
        format!("{}: {}", index + 1, name.trim_matches('"'))
    };
    let shown = Shown {
        noun: "body",
        needed: &[],
        new: "(shape: sphere, at: (0, 0, 1))",
        title: &title,
    };
    list(ui, text, &BODIES, &shown, search, edits);
}

/// How a list is shown.
struct Shown<'a> {
    noun: &'a str,
    /// Fields that an item must have.
    needed: &'a [&'a str],
    /// The text of a new item.
    new: &'a str,
    /// The title of an item, which comes with its index.
    title: &'a dyn Fn((usize, &&str)) -> String,
}

/// A list of the preset `text`, whose items may come, go and move.
fn list(
    ui: &mut Ui,
    text: &str,
    part: &FilePart,
    shown: &Shown,
    search: &str,
    edits: &mut Vec<Edit>,
) {
    let search = Search::new(search);
    let items = items_of(text, part.name);
    let parts = Parts {
        part,
        noun: shown.noun,
        titles: items.iter().enumerate().map(shown.title).collect(),
        fields: &[],
        needed: shown.needed,
        refusal: &|_, _, _| None,
        is_movable: true,
        may_remove: true,
        may_add: true,
    };
    let place = parts.place();
    let asked = parts.show(ui, text, &search, |_| part.table.to_vec(), edits);
    edits.extend(asked.map(|asked| match asked {
        Asked::Add => parts.add(text, shown.new),
        Asked::Of(Change::Remove(index)) => Edit::Remove(place.item(index)),
        Asked::Of(Change::Move(from, to)) => Edit::Move(place, from, to),
        Asked::Of(Change::Duplicate(index)) => {
            Edit::Insert(place, index + 1, items[index].to_owned())
        }
    }));
}

/// A section of the preset `text`, one of [`Sections::ALL`] or [`PRESET`], as a part to open; nothing where a search finds
/// nothing in it, or there is none of that name.
pub fn section(
    ui: &mut Ui,
    text: &str,
    name: &str,
    inherited: &Inherited,
    search: &str,
    edits: &mut Vec<Edit>,
) {
    let Some((doc, table)) = schema(name) else {
        return;
    };
    let search = Search::new(search);
    let (section, place) = match name {
        PRESET => (edit::get(text, &[]), Place::top()),
        _ => {
            let place = Place::top().field(name);
            (edit::get(text, &place.steps()), place)
        }
    };
    let mut form = Form::new(name, table, section, place).about(doc);
    form = form.over(inherited.section(name));
    if name == PRESET {
        let sections = Sections::ALL.iter().map(|(name, ..)| *name);
        let others: Vec<&str> = sections
            .chain(["layers", "meshes", "lines", "bodies", "passes", "objects"])
            .collect();
        form = form.without(&others).needed(&["version"]);
    }
    if search.is_active() && !form.matches(&search) {
        return;
    }
    let has_objects = edit::get(text, &Place::top().field("objects").steps()).is_some();
    let is_elsewhere = has_objects && name != PRESET && !OF_THE_SCENE.contains(&name);
    fold(ui, name, false, &search, |ui| {
        about(ui, doc);
        if is_elsewhere && section.is_none() {
            ui.weak("This preset names objects, whose own presets say this.");
        } else {
            form.show(ui, &search, edits);
        }
    });
}

/// What a part is about, at its beginning.
pub(super) fn about(ui: &mut Ui, doc: &str) {
    ui.label(RichText::new(doc).small());
}

fn schema(name: &str) -> Option<(&'static str, &'static [Param])> {
    if name == PRESET {
        return Some((PRESET_DOC, Preset::TOP));
    }
    let mut sections = Sections::ALL.iter();
    let section = sections.find(|(section, ..)| *section == name);
    section.map(|(_, doc, table)| (*doc, *table))
}

/// The objects of a preset that names some; nothing of one that describes its own.
pub fn objects(ui: &mut Ui, text: &str, search: &str, edits: &mut Vec<Edit>) {
    let place = Place::top().field("objects");
    if edit::get(text, &place.steps()).is_none() {
        return;
    }
    let search = Search::new(search);
    let items = edit::items(text, &place.steps());
    let form = |index: usize, owner| {
        let place = place.item(index);
        Form::new(owner, ObjectSection::TABLE, Some(items[index]), place)
            .about(ObjectSection::DOC)
            .needed(&["preset"])
    };
    let owners: Vec<String> = (1..=items.len())
        .map(|number| format!("object {number}"))
        .collect();
    let title = |item: &&str| {
        let preset = edit::get(item, &[edit::Step::Field("preset")]);
        preset.unwrap_or("?").trim_matches('"').to_owned()
    };
    let list = List {
        noun: "object",
        titles: items.iter().map(title).collect(),
        found: (0..items.len())
            .map(|index| form(index, &owners[index]).matches(&search))
            .collect(),
        is_movable: true,
        // A picture of none would be empty.
        may_remove: items.len() > 1,
    };
    if !list.found.contains(&true) {
        return;
    }
    fold(ui, "objects", true, &search, |ui| {
        about(ui, ObjectSection::DOC);
        let change = list.show(
            ui,
            &search,
            |_, _| {},
            |ui, index| form(index, &owners[index]).show(ui, &search, edits),
        );
        edits.extend(change.map(|change| match change {
            Change::Remove(index) => Edit::Remove(place.item(index)),
            Change::Move(from, to) => Edit::Move(place.clone(), from, to),
            Change::Duplicate(index) => {
                Edit::Insert(place.clone(), index + 1, items[index].to_owned())
            }
        }));
    });
}
