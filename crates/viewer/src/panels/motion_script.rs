//! A motion script: moves and keys of the head, winds, key shapes of the hair.

use super::fold::fold;
use super::items::Change;
use super::look::{about, bodies};
use super::parts::{Asked, Parts, items_of, number_of, quoted, text_of, value_of, with};
use crate::controls::{Form, Search};
use crate::edit::{Edit, Place};
use effects::preset::edit::{self, Step};
use effects::{Param, ParamKind, Value};
use eframe::egui::Ui;
use stage::{FilePart, MOTION_PARTS};

/// Least time between two keys, in seconds.
const LEAST_GAP: f32 = 0.001;

/// Shows the motion script `text`.
pub fn motion_script(ui: &mut Ui, text: &str, searched: &str, edits: &mut Vec<Edit>) {
    let search = Search::new(searched);
    let [top, moves, keys, winds, shapes, _, body_keys] = MOTION_PARTS else {
        return;
    };
    top_fields(ui, text, top, &search, edits);
    plain_list(ui, text, moves, "move", "(move: turn)", &search, edits);
    timed_list(ui, text, keys, "key", &search, edits);
    plain_list(ui, text, winds, "wind", "(speed: 4)", &search, edits);
    timed_list(ui, text, shapes, "shape", &search, edits);
    bodies(ui, text, searched, edits);
    body_key_list(ui, text, body_keys, &search, edits);
}

/// The keys of bodies: those of one body ascend, whatever lies between them.
fn body_key_list(ui: &mut Ui, text: &str, part: &FilePart, search: &Search, edits: &mut Vec<Edit>) {
    let items = items_of(text, part.name);
    let body = |item: &str| text_of(item, "body").unwrap_or_default();
    let title = |(index, item): (usize, &&str)| {
        let time = number_of(item, part.table, "time");
        format!("{}: {} at {time} s", index + 1, body(item))
    };
    let parts = Parts {
        part,
        noun: "body key",
        titles: items.iter().enumerate().map(title).collect(),
        fields: &[],
        needed: &["body"],
        refusal: &|_, _, _| None,
        is_movable: false,
        may_remove: true,
        may_add: true,
    };
    let table = |index: usize| {
        let name = body(items[index]);
        let of_body = (0..items.len()).filter(|other| body(items[*other]) == name);
        let of_body: Vec<usize> = of_body.collect();
        let times: Vec<f32> = (of_body.iter())
            .map(|other| number_of(items[*other], part.table, "time"))
            .collect();
        let own = of_body
            .iter()
            .position(|other| *other == index)
            .unwrap_or(0);
        // Where a body is moved to needs no file.
        let mut table = table_between(part.table, items[index], &times, own);
        let at = part.table.iter().filter(|param| param.name == "at");
        if table.iter().all(|param| param.name != "at") {
            table.extend(at);
        }
        table
    };
    let place = parts.place();
    let asked = parts.show(ui, text, search, table, edits);
    let later = |item: &str| {
        let name = body(item);
        let own = items.iter().filter(|other| body(other) == name);
        let times = own.map(|other| number_of(other, part.table, "time"));
        rounded(times.fold(0.0, f32::max) + 0.5)
    };
    match asked {
        None | Some(Asked::Of(Change::Move(..))) => {}
        Some(Asked::Add) => {
            let new = match items.last() {
                Some(last) => with(last, &[Step::Field("time")], &later(last).to_string()),
                None => {
                    let bodies = items_of(text, "bodies");
                    let name = bodies.iter().find_map(|body| text_of(body, "name"));
                    format!("(body: {})", quoted(&name.unwrap_or("ball".to_owned())))
                }
            };
            edits.push(parts.add(text, &new));
        }
        Some(Asked::Of(Change::Duplicate(index))) => {
            let copy = with(
                items[index],
                &[Step::Field("time")],
                &later(items[index]).to_string(),
            );
            edits.push(Edit::Insert(place, items.len(), copy));
        }
        Some(Asked::Of(Change::Remove(index))) => edits.push(Edit::Remove(place.item(index))),
    }
}

fn top_fields(ui: &mut Ui, text: &str, part: &FilePart, search: &Search, edits: &mut Vec<Edit>) {
    let lists: Vec<&str> = MOTION_PARTS.iter().map(|part| part.name).collect();
    let section = edit::get(text, &[]);
    let has_shapes = !items_of(text, "shapes").is_empty();
    let is_held = edit::get(text, &[Step::Field("hold")]).is_some();
    // A pull to shapes where there are none would be a mistake.
    let table: Vec<Param> = (part.table.iter().copied())
        .filter(|param| param.name != "hold" || has_shapes || is_held)
        .collect();
    let form = Form::new(part.name, &table, section, Place::top())
        .about(part.doc)
        .without(&lists)
        .needed(&["version"]);
    if search.is_active() && !form.matches(search) {
        return;
    }
    fold(ui, part.name, true, search, |ui| {
        about(ui, part.doc);
        form.show(ui, search, edits);
    });
}

/// A list whose items say when they begin, in any order: moves and winds.
fn plain_list(
    ui: &mut Ui,
    text: &str,
    part: &FilePart,
    noun: &str,
    template: &str,
    search: &Search,
    edits: &mut Vec<Edit>,
) {
    let items = items_of(text, part.name);
    let title = |(index, item): (usize, &&str)| {
        let start = number_of(item, part.table, "start");
        match value_of(item, part.table, "move") {
            Some(Value::Choice(kind)) => {
                let kind = name_of_choice(part.table, "move", kind);
                format!("{}: {kind} at {start} s", index + 1)
            }
            _ => format!("{}: at {start} s", index + 1),
        }
    };
    let parts = Parts {
        part,
        noun,
        titles: items.iter().enumerate().map(title).collect(),
        fields: &[],
        needed: &[],
        refusal: &|_, _, _| None,
        is_movable: true,
        may_remove: true,
        may_add: true,
    };
    let place = parts.place();
    let asked = parts.show(ui, text, search, |_| part.table.to_vec(), edits);
    edits.extend(asked.map(|asked| match asked {
        Asked::Add => parts.add(text, template),
        Asked::Of(Change::Remove(index)) => Edit::Remove(place.item(index)),
        Asked::Of(Change::Move(from, to)) => Edit::Move(place, from, to),
        Asked::Of(Change::Duplicate(index)) => {
            Edit::Insert(place, index + 1, items[index].to_owned())
        }
    }));
}

fn name_of_choice(table: &[Param], param: &str, choice: u32) -> &'static str {
    let param = table.iter().find(|known| known.name == param);
    match param.map(|param| param.kind) {
        Some(ParamKind::Choice { names, .. }) => names.get(choice as usize).copied(),
        _ => None,
    }
    .unwrap_or_default()
}

/// A list whose items' times ascend: keys and shapes. Their order is that of their times.
fn timed_list(
    ui: &mut Ui,
    text: &str,
    part: &FilePart,
    noun: &str,
    search: &Search,
    edits: &mut Vec<Edit>,
) {
    let items = items_of(text, part.name);
    let times: Vec<f32> = (items.iter())
        .map(|item| number_of(item, part.table, "time"))
        .collect();
    let title = |(index, time): (usize, &f32)| format!("{}: {time} s", index + 1);
    let parts = Parts {
        part,
        noun,
        titles: times.iter().enumerate().map(title).collect(),
        fields: &[],
        needed: &[],
        refusal: &|_, _, _| None,
        is_movable: false,
        may_remove: true,
        may_add: true,
    };
    let mut own = Vec::new();
    let table = |index: usize| table_between(part.table, items[index], &times, index);
    let asked = parts.show(ui, text, search, table, &mut own);
    for edit in own {
        edits.push(edit);
        take_moment_with_file(&parts, &items, edits);
    }
    let place = parts.place();
    match asked {
        None => {}
        Some(Asked::Add) => {
            let time = times.last().map_or(0.0, |last| rounded(last + 0.5));
            edits.push(parts.add(text, &format!("(time: {time})")));
        }
        Some(Asked::Of(Change::Duplicate(index))) => {
            edits.extend(time_after(&times, index).map(|time| {
                let copy = with(items[index], &[Step::Field("time")], &time.to_string());
                Edit::Insert(place, index + 1, copy)
            }));
        }
        Some(Asked::Of(Change::Remove(index))) => {
            edits.push(Edit::Remove(place.item(index)));
            let is_last_shape = part.name == "shapes" && items.len() == 1;
            if is_last_shape && edit::get(text, &[Step::Field("hold")]).is_some() {
                edits.push(Edit::Remove(Place::top().field("hold")));
            }
        }
        // Their order is that of their times.
        Some(Asked::Of(Change::Move(..))) => {}
    }
}

/// A time after that of an item and before that of the next one, if there is one.
fn time_after(times: &[f32], index: usize) -> Option<f32> {
    let time = times[index];
    let Some(next) = times.get(index + 1) else {
        return Some(rounded(time + 0.5));
    };
    let middle = 0.5 * (time + next);
    let is_between = |middle: &f32| *middle > time && middle < next;
    [rounded(middle), middle].into_iter().find(is_between)
}

/// Milliseconds are enough for a key.
fn rounded(time: f32) -> f32 {
    (time * 1000.0).round() / 1000.0
}

/// A table in which an item's time is between its neighbours', and a moment needs a file that it is of.
fn table_between(table: &[Param], item: &str, times: &[f32], index: usize) -> Vec<Param> {
    let before = index.checked_sub(1).map(|before| times[before] + LEAST_GAP);
    let after = times.get(index + 1).map(|after| after - LEAST_GAP);
    let has = |name: &str| edit::get(item, &[Step::Field(name)]).is_some();
    let between = |param: &Param| {
        let mut param = *param;
        if let (ParamKind::Number { min, max, .. }, "time") = (&mut param.kind, param.name) {
            let range = (
                before.map_or(*min, |before| before.max(*min)),
                after.map_or(*max, |after| after.min(*max)),
            );
            // Where neighbours leave no room, it stays where it is.
            (*min, *max) = match range.0 <= range.1 {
                true => range,
                false => (times[index], times[index]),
            };
        }
        param
    };
    let is_shown = |param: &&Param| param.name != "at" || has("hair") || has("at");
    table.iter().filter(is_shown).map(between).collect()
}

/// Where a shape's file was just taken away, the moment in it goes too.
fn take_moment_with_file(parts: &Parts, items: &[&str], edits: &mut Vec<Edit>) {
    let Some(Edit::Remove(removed)) = edits.last() else {
        return;
    };
    for (index, item) in items.iter().enumerate() {
        let place = parts.place().item(index);
        let has_moment = edit::get(item, &[Step::Field("at")]).is_some();
        if *removed == place.field("hair") && has_moment && text_of(item, "hair").is_some() {
            edits.push(Edit::Remove(place.field("at")));
            return;
        }
    }
}
