//! Clumps changed or drawn one by one, as styles write them.

use super::lines::point;
use crate::table::{choice, number, param};
use effects::preset::{Field, Reader, suggestion};
use effects::{Param, ParamKind};
use groom::{Drawn, Edit, MOST_CLUMPS, Zone};

/// What an edit of one clump may say.
pub(super) const EDIT: &[Param] = &[
    param("zone", "The zone's name.", ParamKind::Text),
    param(
        "clump",
        "The clump's number in the zone, 0 first.",
        ParamKind::Integer {
            min: 0,
            max: MOST_CLUMPS as i32 - 1,
            default: 0,
        },
    ),
    choice(
        "mirrored",
        "Whether the clump of the mirrored half is meant.",
        &["false", "true"],
        0,
    ),
    choice("remove", "Takes the clump away.", &["false", "true"], 0),
    number("size", "Its size, as a factor.", "", 0.0..=10.0, 1.0),
    number(
        "length",
        "Its hanging length, as a factor.",
        "",
        0.0..=10.0,
        1.0,
    ),
    number(
        "around",
        "How far it is turned around the head, towards the character's left.",
        "degrees",
        -180.0..=180.0,
        0.0,
    ),
    number(
        "up",
        "How far it is turned up.",
        "degrees",
        -90.0..=90.0,
        0.0,
    ),
    number(
        "raise",
        "How much higher its tip stands above the skin.",
        "head heights",
        -1.0..=5.0,
        0.0,
    ),
];

/// What a hand-drawn clump may say, beside `points`.
pub(super) const DRAWN: &[Param] = &[
    number(
        "size",
        "Radius of the clump at its full size.",
        "1/300 head height",
        0.0..=200.0,
        12.0,
    ),
    choice(
        "mirror",
        "Whether it is also drawn on the other side.",
        &["false", "true"],
        0,
    ),
];

/// Reads an edit of a clump of one of these zones.
pub(super) fn edit<'a>(reader: &mut Reader<'a>, item: &'a str, zones: &[Zone]) -> Option<Edit> {
    let fields = reader.fields(item, "an edit");
    let values = reader.values(&fields, EDIT, "an edit");
    let name = values.text("zone").unwrap_or_default();
    let Some(zone) = zones.iter().find(|zone| zone.name == name) else {
        let hint = suggestion(name, zones.iter().map(|zone| zone.name.as_str()));
        reader.error(item, format!("there is no zone `{name}` to edit{hint}"));
        return None;
    };
    let clump = values.integer("clump").unsigned_abs();
    let clumps = zone.count * zone.rows.max(1);
    if clump >= clumps {
        reader.error(
            item,
            format!(
                "the zone `{name}` has clumps 0 to {}, no {clump}",
                clumps - 1
            ),
        );
    }
    let mirrored = values.choice("mirrored") == 1;
    if mirrored && !zone.mirror {
        reader.error(item, format!("the zone `{name}` has no mirrored half"));
    }
    Some(Edit {
        zone: name.to_owned(),
        clump,
        mirrored,
        remove: values.choice("remove") == 1,
        size: values.number("size"),
        length: values.number("length"),
        turn: [values.number("around"), values.number("up")],
        raise: values.number("raise"),
    })
}

/// Reads a hand-drawn clump.
pub(super) fn drawn<'a>(reader: &mut Reader<'a>, item: &'a str) -> Drawn {
    let fields = reader.fields(item, "a strand");
    let (points, plain): (Vec<Field>, Vec<Field>) =
        fields.into_iter().partition(|field| field.name == "points");
    let values = reader.values(&plain, DRAWN, "a strand");
    let items = match points.first() {
        Some(field) => reader.list(field.value, "points"),
        None => Vec::new(),
    };
    if items.len() < 2 {
        reader.error(
            item,
            "a strand needs `points`, two or more: [(longitude, latitude, height above the skin), ...]",
        );
    }
    Drawn {
        points: items
            .iter()
            .filter_map(|item| point(reader, item))
            .collect(),
        size: values.number("size"),
        mirror: values.choice("mirror") == 1,
    }
}
