//! A hair style: where it grows from, its zones, changes of single clumps, clumps drawn by hand, and what the hair wears.

use super::fold::fold;
use super::items::{Change, new_name};
use super::look::about;
use super::parts::{Asked, Parts, items_of, number_of, quoted, text_of, with};
use super::places::{self, PlaceField, Written};
use crate::controls::{Form, Search};
use crate::edit::{Edit, Place};
use effects::Param;
use effects::preset::edit::{Step, get};
use effects::preset::suggestion;
use eframe::egui::Ui;
use stage::{FilePart, STYLE_PARTS};

/// Fields of places, how they are written, and what they are at first: the whorl, parting and hairline of a drawn character.
const PLACES: [(&str, Written, &str); 7] = [
    ("whorl", Written::Place, "(180, 74)"),
    ("parting", Written::List, "[(0, 46), (0, 68), (180, 82)]"),
    (
        "hairline",
        Written::Hairline,
        "[(0, 42), (42, 33), (74, 12), (106, -8), (150, -40), (180, -45)]",
    ),
    ("roots", Written::Line, "[(-40, 60), (40, 60)]"),
    ("tips", Written::Line, "[(-40, 20), (40, 20)]"),
    ("points", Written::Heights, "[(0, 60, 0.05), (0, 20, 0.1)]"),
    ("at", Written::List, "[(40, 30)]"),
];

/// Shows the hair style `text`.
pub fn style(ui: &mut Ui, text: &str, search: &str, edits: &mut Vec<Edit>) {
    let search = Search::new(search);
    let [top, zones, clumps, strands, accessories] = STYLE_PARTS else {
        return;
    };
    top_fields(ui, text, top, &search, edits);
    // Changes of clumps that go with their zone go last: what is typed into others in this frame is for their numbers of now.
    let mut gone = Vec::new();
    zone_list(ui, text, zones, &search, edits, &mut gone);
    edit_list(ui, text, [zones, clumps], &search, edits);
    edits.extend(gone);
    strand_list(ui, text, strands, &search, edits);
    accessory_list(ui, text, accessories, &search, edits);
}

/// The fields of a part that are places.
fn places_of(part: &FilePart) -> Vec<PlaceField> {
    let field = |(name, doc): &(&'static str, &'static str)| {
        let (_, form, template) = PLACES.into_iter().find(|(known, ..)| known == name)?;
        Some(PlaceField {
            name,
            doc,
            form,
            template,
            is_needed: ["roots", "points", "at"].contains(name),
        })
    };
    part.places.iter().filter_map(field).collect()
}

fn top_fields(ui: &mut Ui, text: &str, part: &FilePart, search: &Search, edits: &mut Vec<Edit>) {
    let fields = places_of(part);
    let lists = STYLE_PARTS.iter().map(|part| part.name);
    let others: Vec<&str> = lists.chain(fields.iter().map(|field| field.name)).collect();
    let section = get(text, &[]);
    let form = Form::new(part.name, part.table, section, Place::top())
        .about(part.doc)
        .without(&others)
        .needed(&["version"]);
    let has_places = places::matches(&fields, part.name, search);
    if search.is_active() && !form.matches(search) && !has_places {
        return;
    }
    fold(ui, part.name, true, search, |ui| {
        about(ui, part.doc);
        form.show(ui, search, edits);
        let section = section.unwrap_or("()");
        places::places(
            ui,
            part.name,
            &fields,
            section,
            &Place::top(),
            search,
            edits,
        );
    });
}

fn zone_list(
    ui: &mut Ui,
    text: &str,
    part: &FilePart,
    search: &Search,
    edits: &mut Vec<Edit>,
    gone: &mut Vec<Edit>,
) {
    let items = items_of(text, part.name);
    let names: Vec<String> = items.iter().map(|item| name_of(item)).collect();
    let is_taken = |index: usize, field: &str, text: &str| {
        let mut others = names
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index);
        let is_it = field == "name" && others.any(|(_, name)| quoted(name) == text);
        is_it.then(|| format!("there is already a zone {text:.60}"))
    };
    let parts = Parts {
        part,
        noun: "zone",
        titles: (names.iter().enumerate())
            .map(|(index, name)| match name.is_empty() {
                true => format!("number {}", index + 1),
                false => name.clone(),
            })
            .collect(),
        fields: &places_of(part),
        needed: &["name"],
        refusal: &is_taken,
        is_movable: true,
        // A style must have some hair.
        may_remove: items.len() > 1 || !items_of(text, "strands").is_empty(),
        may_add: true,
    };
    let mut asked_of_items = Vec::new();
    let table = |_| part.table.to_vec();
    let asked = parts.show(ui, text, search, table, &mut asked_of_items);
    for asked in asked_of_items {
        follow_name(text, &names, &asked, edits);
        edits.push(asked);
    }
    let taken = |name: &str| names.iter().any(|taken| taken == name);
    let place = parts.place();
    match asked {
        None => {}
        Some(Asked::Add) => {
            let name = quoted(&new_name("zone", taken));
            let places = "roots: [(-40, 60), (40, 60)], tips: [(-40, 20), (40, 20)]";
            edits.push(parts.add(text, &format!("(name: {name}, {places})")));
        }
        Some(Asked::Of(Change::Duplicate(index))) => {
            let name = quoted(&new_name(&names[index], taken));
            let copy = with(items[index], &[Step::Field("name")], &name);
            edits.push(Edit::Insert(place, index + 1, copy));
        }
        Some(Asked::Of(Change::Move(from, to))) => edits.push(Edit::Move(place, from, to)),
        Some(Asked::Of(Change::Remove(index))) => {
            // What changes its clumps goes with it, the last first: others keep their numbers.
            for (number, clump) in items_of(text, "edits").iter().enumerate().rev() {
                if text_of(clump, "zone").as_ref() == Some(&names[index]) {
                    gone.push(Edit::Remove(Place::top().field("edits").item(number)));
                }
            }
            edits.push(Edit::Remove(place.item(index)));
        }
    }
}

fn name_of(item: &str) -> String {
    text_of(item, "name").unwrap_or_default()
}

/// Where a zone is renamed, changes of its clumps name it anew.
fn follow_name(text: &str, names: &[String], asked: &Edit, edits: &mut Vec<Edit>) {
    let Edit::Set(place, new) = asked else {
        return;
    };
    let zones = Place::top().field("zones");
    let is_it = |index: &usize| *place == zones.item(*index).field("name");
    let Some(zone) = (0..names.len()).find(is_it) else {
        return;
    };
    for (number, clump) in items_of(text, "edits").iter().enumerate() {
        if text_of(clump, "zone").as_ref() == Some(&names[zone]) {
            let place = Place::top().field("edits").item(number).field("zone");
            edits.push(Edit::Set(place, new.clone()));
        }
    }
}

fn edit_list(
    ui: &mut Ui,
    text: &str,
    [zones, part]: [&FilePart; 2],
    search: &Search,
    edits: &mut Vec<Edit>,
) {
    let items = items_of(text, part.name);
    let title = |(index, item): (usize, &&str)| {
        let zone = text_of(item, "zone").unwrap_or_default();
        let clump = number_of(item, part.table, "clump");
        format!("{}: {zone} {clump}", index + 1)
    };
    let zones_there = items_of(text, zones.name);
    let is_no_zone = |_: usize, field: &str, text: &str| {
        let names: Vec<String> = zones_there.iter().map(|zone| name_of(zone)).collect();
        let is_known = field != "zone" || names.iter().any(|name| quoted(name) == text);
        let hint = || suggestion(text.trim_matches('"'), names.iter().map(String::as_str));
        (!is_known).then(|| format!("there is no zone {text:.60}{}", hint()))
    };
    let parts = Parts {
        part,
        noun: "edit",
        titles: items.iter().enumerate().map(title).collect(),
        fields: &[],
        needed: &["zone"],
        refusal: &is_no_zone,
        is_movable: true,
        may_remove: true,
        may_add: !zones_there.is_empty(),
    };
    // A clump that its zone has.
    let table = |index: usize| {
        let zone = text_of(items[index], "zone");
        let zone = zones_there
            .iter()
            .find(|item| text_of(item, "name") == zone);
        let most = zone.map_or(0.0, |zone| {
            let number = |name: &str| number_of(zone, zones.table, name);
            let form = get(zone, &[Step::Field("form")]);
            let rows = match form.is_none_or(|form| form == "rows") {
                true => number("rows"),
                false => 1.0,
            };
            number("count") * rows - 1.0
        });
        let mut table = part.table.to_vec();
        limit(&mut table, "clump", most as i32);
        table
    };
    let asked = parts.show(ui, text, search, table, edits);
    edits.extend(asked.map(|asked| match asked {
        Asked::Add => {
            let zone = zones_there
                .first()
                .map(|zone| name_of(zone))
                .unwrap_or_default();
            parts.add(text, &format!("(zone: {}, clump: 0)", quoted(&zone)))
        }
        Asked::Of(change) => plain(change, parts.place(), &items),
    }));
}

/// Gives a whole number of a table another largest value.
fn limit(table: &mut [Param], name: &str, most: i32) {
    for param in table.iter_mut().filter(|param| param.name == name) {
        if let effects::ParamKind::Integer { min, max, .. } = &mut param.kind {
            *max = (*max).min(most).max(*min);
        }
    }
}

/// What is done with an item that may be repeated.
fn plain(change: Change, place: Place, items: &[&str]) -> Edit {
    match change {
        Change::Remove(index) => Edit::Remove(place.item(index)),
        Change::Move(from, to) => Edit::Move(place, from, to),
        Change::Duplicate(index) => Edit::Insert(place, index + 1, items[index].to_owned()),
    }
}

fn strand_list(ui: &mut Ui, text: &str, part: &FilePart, search: &Search, edits: &mut Vec<Edit>) {
    let items = items_of(text, part.name);
    let fields = places_of(part);
    let parts = Parts {
        part,
        noun: "strand",
        titles: (1..=items.len()).map(|number| number.to_string()).collect(),
        fields: &fields,
        needed: &[],
        refusal: &|_, _, _| None,
        is_movable: true,
        may_remove: items.len() > 1 || !items_of(text, "zones").is_empty(),
        may_add: true,
    };
    let asked = parts.show(ui, text, search, |_| part.table.to_vec(), edits);
    edits.extend(asked.map(|asked| match asked {
        Asked::Add => parts.add(text, "(points: [(0, 60, 0.05), (0, 20, 0.1)])"),
        Asked::Of(change) => plain(change, parts.place(), &items),
    }));
}

fn accessory_list(
    ui: &mut Ui,
    text: &str,
    part: &FilePart,
    search: &Search,
    edits: &mut Vec<Edit>,
) {
    let items = items_of(text, part.name);
    let fields = places_of(part);
    let parts = Parts {
        part,
        noun: "accessory",
        titles: (1..=items.len()).map(|number| number.to_string()).collect(),
        fields: &fields,
        needed: &[],
        refusal: &|_, _, _| None,
        is_movable: true,
        may_remove: true,
        may_add: true,
    };
    let asked = parts.show(ui, text, search, |_| part.table.to_vec(), edits);
    edits.extend(asked.map(|asked| match asked {
        Asked::Add => parts.add(text, "(kind: clip, at: [(40, 30)])"),
        Asked::Of(change) => plain(change, parts.place(), &items),
    }));
}
