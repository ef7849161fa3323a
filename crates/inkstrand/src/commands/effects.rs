//! `inkstrand effects`: what there is to build a look from.

use super::schema::{self, Section, sections};
use crate::{Failure, say};
use effects::preset::{OF_THE_EFFECT, suggestion};
use effects::{AnyEffect, BrushSection, Param, ParamKind, Registry};
use stage::{BODIES, FilePart, MOTION_PARTS, STYLE_PARTS};

/// Lists effects and sections, or what one of them takes.
pub(crate) fn effects(name: Option<&str>, json: bool, registry: &Registry) -> Result<(), Failure> {
    let text = if json {
        let schema = match find(name, registry)? {
            Found::All => schema::all(registry),
            Found::Effect(effect) => schema::effect(effect),
            Found::Section(section) => schema::section(&section),
            Found::Part(part) => schema::file_part(part),
        };
        serde_json::to_string_pretty(&schema)? + "\n"
    } else {
        match find(name, registry)? {
            Found::All => list(registry),
            Found::Effect(effect) => effect_text(effect),
            Found::Section(section) => section_text(&section),
            Found::Part(part) => file_part_text(part),
        }
    };
    Ok(say::print(&text)?)
}

/// What a name means.
enum Found<'r> {
    All,
    Effect(&'r dyn AnyEffect),
    Section(Section),
    Part(&'static FilePart),
}

fn find<'r>(name: Option<&str>, registry: &'r Registry) -> Result<Found<'r>, Failure> {
    let Some(name) = name else {
        return Ok(Found::All);
    };
    if let Some(effect) = registry.get(name) {
        return Ok(Found::Effect(effect));
    }
    if let Some(section) = sections().into_iter().find(|section| section.name == name) {
        return Ok(Found::Section(section));
    }
    if let Some(part) = parts().find(|part| part.name == name) {
        return Ok(Found::Part(part));
    }
    let effects = registry.iter().map(AnyEffect::id);
    let sections = sections();
    let named = |part: &&FilePart| sections.iter().any(|section| section.name == part.name);
    let names = effects
        .chain(sections.iter().map(|section| section.name))
        .chain(parts().filter(|part| !named(part)).map(|part| part.name));
    let hint = suggestion(name, names);
    Err(Failure::Usage(format!(
        "there is no effect, section, or part of a style or motion `{name}`{hint}"
    )))
}

/// The parts of files beside presets.
fn parts() -> impl Iterator<Item = &'static FilePart> {
    STYLE_PARTS.iter().chain(MOTION_PARTS)
}

fn list(registry: &Registry) -> String {
    let mut effects: Vec<&dyn AnyEffect> = registry.iter().collect();
    effects.sort_by_key(|effect| (effect.is_for_meshes(), effect.rank(), effect.id()));
    let mut text = format!(
        "{:<20} {:>6} {:>12}  what it draws\n",
        "effect", "rank", "depth_offset"
    );
    for effect in effects {
        // Meshes have no order among strokes.
        let [rank, depth_offset] = match effect.is_for_meshes() {
            true => ["meshes".to_owned(), String::new()],
            false => [effect.rank().to_string(), effect.depth_offset().to_string()],
        };
        let (id, doc) = (effect.id(), effect.doc());
        text += &format!("{id:<20} {rank:>6} {depth_offset:>12}  {doc}\n");
    }
    text += &format!("\n{:<20} what it says\n", "section");
    for section in sections() {
        text += &format!("{:<20} {}\n", section.name, section.doc);
    }
    for (file, parts) in [("hair style", STYLE_PARTS), ("head and wind", MOTION_PARTS)] {
        text += &format!("\n{file:<20} what it says\n");
        for part in parts {
            text += &format!("{:<20} {}\n", part.name, part.doc);
        }
    }
    text + "\n`inkstrand effects NAME` lists the parameters of one of them.\n"
}

const HOW_NUMBERS_VARY: &str = "\
\nWhat may vary is a number, or
  (value: 2, vary: 0.2)                 up to 20 % smaller or larger from strand to strand
  (curve: [(0, 1), (0.5, 2), (1, 0)])   along the strand, from root (0) to tip (1)
  (curve: [(0, 1), (1, 2)], vary: 0.2)  both
";

fn effect_text(effect: &dyn AnyEffect) -> String {
    let id = effect.id();
    let mut text = format!("{id}: {}\n", effect.doc());
    if !effect.is_for_meshes() {
        let (rank, depth_offset) = (effect.rank(), effect.depth_offset());
        text += &format!("rank {rank}, depth_offset {depth_offset} head heights\n");
    }
    let on = if effect.is_for_meshes() {
        " on: \"skin, dress\","
    } else if effect.is_for_lines() {
        " on: \"rim\","
    } else {
        ""
    };
    text += &format!("In a preset's layers: (effect: \"{id}\",{on} params: (name: value, ...))\n");
    for param in effect.params() {
        text += &param_text(param, &default(param));
    }
    match effect.is_for_meshes() {
        true => text,
        false => text + HOW_NUMBERS_VARY,
    }
}

fn section_text(section: &Section) -> String {
    let is_layer = section.name == "layers";
    let example = match section.name {
        "preset" => "(name: value, ..., layers: [...])".to_owned(),
        "layers" => "layers: [(effect: \"hair.base\", name: value, ...), ...]".to_owned(),
        "brush" => {
            "layers: [(effect: \"hair.base\", brush: (kind: crayon, name: value, ...)), ...]"
                .to_owned()
        }
        "meshes" => "meshes: [(file: \"eyes.obj\", name: value, ...), ...]".to_owned(),
        "lines" => {
            "lines: [(name: \"rim\", of: \"skin, dress\", kind: \"contour\", ...), ...]".to_owned()
        }
        "bodies" => format!("{}; also in a motion script", BODIES.example),
        "passes" => "passes: [(edges: strand, name: value, ...), ...]".to_owned(),
        "objects" => "objects: [(preset: \"twin-tails.ron\", name: value, ...), ...]".to_owned(),
        name => format!("{name}: (name: value, ...)"),
    };
    let mut text = format!(
        "{}: {}\nIn a preset: {example}\n",
        section.name, section.doc
    );
    for param in section.table {
        let is_of_tool = section.name == "brush" && BrushSection::OF_THE_TOOL.contains(&param.name);
        text += &if is_layer && OF_THE_EFFECT.contains(&param.name) {
            param_text(param, "the effect's own")
        } else if is_of_tool {
            param_text(param, "the tool's own")
        } else {
            param_text(param, &default(param))
        };
    }
    if ["clump", "passes"].contains(&section.name) {
        text += HOW_NUMBERS_VARY;
    }
    if is_layer {
        text += "\n  params: (name: value, ...)\n";
        text += "      The effect's own parameters: `inkstrand effects ID`.\n";
        text += "\n  brush: (name: value, ...)\n";
        text += "      What its strokes are drawn with: `inkstrand effects brush`.\n";
    }
    text
}

fn file_part_text(part: &FilePart) -> String {
    let mut text = format!("{}: {}\n{}\n", part.name, part.doc, part.example);
    for (name, meaning) in part.places {
        text += &format!("\n  {name}: places\n      {meaning}\n");
    }
    for param in part.table {
        text += &param_text(param, &default(param));
    }
    text
}

fn param_text(param: &Param, default: &str) -> String {
    let unit = match param.unit {
        "" => String::new(),
        unit => format!("; unit: {unit}"),
    };
    let varies = match param.kind {
        ParamKind::Number { varies: true, .. } => "; may vary",
        _ => "",
    };
    format!(
        "\n  {}: {}\n      default {default}{unit}{varies}\n      {}\n",
        param.name,
        param.kind.expected(),
        param.doc
    )
}

/// A parameter's default as a preset would write it.
fn default(param: &Param) -> String {
    match param.kind {
        ParamKind::Number { default, .. } => default.to_string(),
        ParamKind::Integer { default, .. } => default.to_string(),
        ParamKind::Flag { default } => default.to_string(),
        ParamKind::Choice { names, default } => names[default].to_owned(),
        ParamKind::Color { default } => format!("\"{default}\""),
        ParamKind::OptionalColor { default: Some(hex) } => format!("\"{hex}\""),
        ParamKind::OptionalColor { default: None } => "none".to_owned(),
        ParamKind::Texture { default, .. } => default.to_owned(),
        ParamKind::Text => "nothing".to_owned(),
        ParamKind::Triple {
            default: [x, y, z], ..
        } => format!("({x}, {y}, {z})"),
        ParamKind::Pair {
            default: [x, y], ..
        } => format!("({x}, {y})"),
        ParamKind::Size {
            default: [w, h], ..
        } => format!("({w}, {h})"),
    }
}
