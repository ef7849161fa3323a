//! All that a preset may say, as data: the tables that the parser reads by.

use effects::preset::{LAYER, OF_THE_EFFECT};
use effects::{AnyEffect, BrushSection, Param, ParamKind, Registry};
use serde_json::{Value, json};
use stage::{
    BODIES, FilePart, LineSection, MOTION_PARTS, MeshSection, ObjectSection, PassSection, Preset,
    STYLE_PARTS, Sections,
};

/// A section of a preset as `inkstrand effects` shows it.
pub(super) struct Section {
    pub name: &'static str,
    pub doc: &'static str,
    pub table: &'static [Param],
}

/// The sections in their order: what stands beside them, their own, and the fields of layers and their brushes, meshes, lines, bodies, passes and objects.
pub(super) fn sections() -> Vec<Section> {
    let top = ("preset", "What stands beside the sections.", Preset::TOP);
    let layers = ("layers", "What is drawn: effects, in a list.", LAYER);
    let brush = ("brush", BrushSection::DOC, BrushSection::TABLE);
    let meshes = ("meshes", MeshSection::DOC, MeshSection::TABLE);
    let lines = ("lines", LineSection::DOC, LineSection::TABLE);
    let bodies = ("bodies", BODIES.doc, BODIES.table);
    let passes = ("passes", PassSection::DOC, PassSection::TABLE);
    let objects = (
        "objects",
        "Heads of hair of other presets in one picture, a list in place of all sections but scene, camera, light and passes.",
        ObjectSection::TABLE,
    );
    [top]
        .iter()
        .chain(Sections::ALL)
        .chain(&[layers, brush, meshes, lines, bodies, passes, objects])
        .map(|&(name, doc, table)| Section { name, doc, table })
        .collect()
}

/// The whole schema.
pub(super) fn all(registry: &Registry) -> Value {
    json!({
        "version": stage::VERSION,
        "sections": sections().iter().map(section).collect::<Vec<_>>(),
        "effects": registry.iter().map(effect).collect::<Vec<_>>(),
        "style": STYLE_PARTS.iter().map(file_part).collect::<Vec<_>>(),
        "motion": MOTION_PARTS.iter().map(file_part).collect::<Vec<_>>(),
    })
}

/// The schema of a part of hair styles or motion scripts.
pub(super) fn file_part(part: &FilePart) -> Value {
    let places = part.places.iter().map(|(name, meaning)| {
        json!({ "name": name, "meaning": meaning, "type": "places", "default": null })
    });
    json!({
        "id": part.name,
        "meaning": part.doc,
        "parameters": part.table.iter().map(parameter).chain(places).collect::<Vec<_>>(),
    })
}

/// A section's schema.
pub(super) fn section(section: &Section) -> Value {
    let own = |param: &Param| match section.name {
        "layers" => OF_THE_EFFECT.contains(&param.name),
        "brush" => BrushSection::OF_THE_TOOL.contains(&param.name),
        _ => false,
    };
    let parameters = section.table.iter().map(|param| {
        let mut value = parameter(param);
        if own(param) {
            value["default"] = Value::Null;
        }
        value
    });
    json!({
        "id": section.name,
        "meaning": section.doc,
        "parameters": parameters.collect::<Vec<_>>(),
    })
}

/// An effect's schema.
pub(super) fn effect(effect: &dyn AnyEffect) -> Value {
    json!({
        "id": effect.id(),
        "meaning": effect.doc(),
        "paints_meshes": effect.is_for_meshes(),
        "draws_lines": effect.is_for_lines(),
        "rank": effect.rank(),
        "depth_offset": number(effect.depth_offset()),
        "parameters": effect.params().iter().map(parameter).collect::<Vec<_>>(),
    })
}

fn parameter(param: &Param) -> Value {
    let mut value = json!({ "name": param.name, "meaning": param.doc });
    if !param.unit.is_empty() {
        value["unit"] = json!(param.unit);
    }
    let mut range = |min: Value, max: Value| {
        value["min"] = min;
        value["max"] = max;
    };
    let (kind, default) = match param.kind {
        ParamKind::Number {
            min,
            max,
            default,
            varies,
        } => {
            range(number(min), number(max));
            value["varies"] = json!(varies);
            ("number", number(default))
        }
        ParamKind::Integer { min, max, default } => {
            range(json!(min), json!(max));
            ("integer", json!(default))
        }
        ParamKind::Flag { default } => ("true or false", json!(default)),
        ParamKind::Choice { names, default } => {
            value["choices"] = json!(names);
            ("choice", json!(names[default]))
        }
        ParamKind::Color { default } => ("color", json!(default)),
        ParamKind::OptionalColor { default } => ("color or none", json!(default.unwrap_or("none"))),
        ParamKind::Texture { default, repeats } => {
            value["repeats"] = json!(repeats);
            ("texture", json!(default))
        }
        ParamKind::Text => ("text", Value::Null),
        ParamKind::Triple { min, max, default } => {
            range(number(min), number(max));
            ("three numbers", json!(default.map(number)))
        }
        ParamKind::Pair { min, max, default } => {
            range(number(min), number(max));
            ("two numbers", json!(default.map(number)))
        }
        ParamKind::Size { min, max, default } => {
            range(json!(min), json!(max));
            ("size", json!(default))
        }
    };
    value["type"] = json!(kind);
    value["default"] = default;
    value
}

/// A number with the digits that a preset would give it: 0.1, not 0.10000000149.
fn number(number: f32) -> Value {
    number
        .to_string()
        .parse::<f64>()
        .map_or(Value::Null, |n| json!(n))
}
