//! Clumps changed or drawn one by one, as styles write them.

use super::lines::point;
use effects::preset::{Field, Reader, suggestion};
use effects::section;
use groom::{Drawn, Edit, Form, MOST_CLUMPS, Zone};

section! {
    /// What an edit of one clump may say.
    pub(super) struct EditFields {
        /// The zone's name.
        zone: Option<String> = text(),
        /// The clump's number in the zone, 0 first.
        clump: u32 = whole(0, 0..=MOST_CLUMPS - 1),
        /// Whether the clump of the mirrored half is meant.
        mirrored: bool = flag(false),
        /// Takes the clump away.
        remove: bool = flag(false),
        /// Its size, as a factor.
        size: f32 = number(1.0, 0.0..=10.0),
        /// Its hanging length, as a factor.
        length: f32 = number(1.0, 0.0..=10.0),
        /// How far it is turned around the head, towards the character's left.
        around: f32 = number(0.0, -180.0..=180.0).unit("degrees"),
        /// How far it is turned up.
        up: f32 = number(0.0, -90.0..=90.0).unit("degrees"),
        /// How much higher its tip stands above the skin.
        raise: f32 = number(0.0, -1.0..=5.0).unit("head heights"),
    }
}

section! {
    /// What a hand-drawn clump may say, beside `points`.
    pub(super) struct DrawnFields {
        /// Radius of the clump at its full size.
        size: f32 = number(12.0, 0.0..=200.0).unit("1/300 head height"),
        /// Whether it is also drawn on the other side.
        mirror: bool = flag(false),
    }
}

/// Reads an edit of a clump of one of these zones.
pub(super) fn edit<'a>(reader: &mut Reader<'a>, item: &'a str, zones: &[Zone]) -> Option<Edit> {
    let edit: EditFields = reader.section(item, "an edit");
    let name = edit.zone.unwrap_or_default();
    let Some(zone) = zones.iter().find(|zone| zone.name == name) else {
        let hint = suggestion(&name, zones.iter().map(|zone| zone.name.as_str()));
        reader.error(item, format!("there is no zone `{name:.40}` to edit{hint}"));
        return None;
    };
    let clump = edit.clump;
    let clumps = match zone.form {
        Form::Rows => zone.count * zone.rows.max(1),
        Form::Tail | Form::Bun | Form::Braid => zone.count,
    };
    if clump >= clumps {
        reader.error(
            item,
            format!(
                "the zone `{name:.40}` has clumps 0 to {}, no {clump}",
                clumps - 1
            ),
        );
    }
    if edit.mirrored && !zone.mirror {
        reader.error(item, format!("the zone `{name:.40}` has no mirrored half"));
    }
    Some(Edit {
        zone: name,
        clump,
        mirrored: edit.mirrored,
        remove: edit.remove,
        size: edit.size,
        length: edit.length,
        turn: [edit.around, edit.up],
        raise: edit.raise,
    })
}

/// Reads a hand-drawn clump.
pub(super) fn drawn<'a>(reader: &mut Reader<'a>, item: &'a str) -> Drawn {
    let fields = reader.fields(item, "a strand");
    let (points, plain): (Vec<Field>, Vec<Field>) =
        fields.into_iter().partition(|field| field.name == "points");
    let fields: DrawnFields = reader.section_of(&plain, "a strand");
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
        size: fields.size,
        mirror: fields.mirror,
    }
}
