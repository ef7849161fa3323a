//! Hair styles as text, `*.style.ron`: zones of clumps that grow on any head.

use crate::preset::{number, param};
use effects::preset::{Field, PresetErrors, Reader};
use effects::{Param, ParamKind, Values};
use groom::{MOST_CLUMPS, Place, Style, Zone};

/// The newest version of styles that this build reads.
const VERSION: i32 = 1;

/// What a zone may say, beside `roots` and `tips`: lists of places (longitude, latitude) in degrees;
/// longitude 0 is the face, 90 the character's left ear, 180 the back; latitude 90 the top.
pub const ZONE: &[Param] = &[
    param(
        "name",
        "A name, unique in the style; the zone's variations hang on it.",
        ParamKind::Text,
    ),
    param(
        "count",
        "Clumps, on each side where it is mirrored.",
        ParamKind::Integer {
            min: 1,
            max: MOST_CLUMPS as i32,
            default: 8,
        },
    ),
    param(
        "mirror",
        "Whether the zone stands on both sides, each with variations of its own.",
        ParamKind::Choice {
            names: &["false", "true"],
            default: 0,
        },
    ),
    number(
        "root_lift",
        "Height above the skin at the roots.",
        "head heights",
        0.0..=1.0,
        0.01,
    ),
    number(
        "lift",
        "Height above the skin in the middle of the way to the tips.",
        "head heights",
        0.0..=1.0,
        0.06,
    ),
    number(
        "hang",
        "Length that hangs from the tips, or from the roots.",
        "head heights",
        0.0..=20.0,
        0.0,
    ),
    number(
        "weight",
        "How soon hanging hair turns down: 0 never, 1 at once.",
        "",
        0.0..=1.0,
        0.35,
    ),
    number(
        "spread",
        "Lean away from the head while it hangs.",
        "",
        -2.0..=2.0,
        0.0,
    ),
    number(
        "flick",
        "Turn of the tips away from the head; below 0 towards it.",
        "",
        -4.0..=4.0,
        0.0,
    ),
    number(
        "fullness",
        "Radius of a tail where it is fullest; 0 is a row.",
        "head heights",
        0.0..=2.0,
        0.0,
    ),
    number(
        "size",
        "Radius of a clump at its full size.",
        "1/300 head height",
        0.0..=200.0,
        14.0,
    ),
    number(
        "mixed_sizes",
        "Share of clumps that are of a middle or small size.",
        "",
        0.0..=1.0,
        0.5,
    ),
    number(
        "scatter",
        "How much places differ.",
        "degrees",
        0.0..=45.0,
        2.0,
    ),
    number(
        "length_variation",
        "How much hanging lengths differ.",
        "",
        0.0..=1.0,
        0.15,
    ),
];

const TOP: &[Param] = &[
    param(
        "version",
        "Version of the style's format.",
        ParamKind::Integer {
            min: 1,
            max: VERSION,
            default: VERSION,
        },
    ),
    param(
        "seed",
        "Seed of all variations.",
        ParamKind::Integer {
            min: 0,
            max: i32::MAX,
            default: 1,
        },
    ),
];

/// Reads the style `text`, which messages call `file`.
///
/// # Errors
///
/// All mistakes of the file, each with its line and column.
pub(crate) fn parse(file: &str, text: &str) -> Result<Style, PresetErrors> {
    let mut reader = Reader::new(file, text);
    let fields = reader.fields(text, "the style");
    reader.report()?;
    let (zones, plain): (Vec<Field>, Vec<Field>) =
        fields.into_iter().partition(|field| field.name == "zones");
    if plain.iter().all(|field| field.name != "version") {
        reader.error(
            text,
            format!("the style needs `version: {VERSION}`, the version of its format"),
        );
    }
    let top = reader.values(&plain, TOP, "the style");
    let mut style = Style {
        seed: top.integer("seed").unsigned_abs(),
        zones: Vec::new(),
    };
    match zones.first() {
        Some(list) => {
            if list.value.trim_start_matches('[').trim_start() == "]" {
                reader.error(
                    list.value,
                    "there are no zones in it, so no hair would grow",
                );
            }
            for item in reader.list(list.value, "zones") {
                let zone = zone(&mut reader, item);
                if style.zones.iter().any(|other| other.name == zone.name) {
                    reader.error(item, format!("there is already a zone `{}`", zone.name));
                }
                style.zones.push(zone);
            }
        }
        None => reader.error(text, "the style has no `zones`, so no hair would grow"),
    }
    reader.report()?;
    Ok(style)
}

fn zone<'a>(reader: &mut Reader<'a>, item: &'a str) -> Zone {
    let fields = reader.fields(item, "a zone");
    let (places, plain): (Vec<Field>, Vec<Field>) = fields
        .into_iter()
        .partition(|field| ["roots", "tips"].contains(&field.name));
    let values = reader.values(&plain, ZONE, "a zone");
    let mut line = |name: &str| match places.iter().find(|field| field.name == name) {
        Some(field) => line_of_places(reader, field),
        None => Vec::new(),
    };
    let (roots, tips) = (line("roots"), line("tips"));
    if places.iter().all(|field| field.name != "roots") {
        reader.error(
            item,
            "a zone needs `roots`, such as roots: [(-40, 50), (40, 50)]",
        );
    }
    if tips.is_empty() && values.number("hang") <= 0.0 {
        reader.error(
            item,
            "a zone needs `tips` to lead to, or a length to `hang`",
        );
    }
    from_values(&values, roots, tips)
}

fn from_values(values: &Values, roots: Vec<Place>, tips: Vec<Place>) -> Zone {
    Zone {
        name: values.text("name").unwrap_or_default().to_owned(),
        count: values.integer("count").unsigned_abs(),
        roots,
        tips,
        mirror: values.choice("mirror") == 1,
        lift: values.number("lift"),
        root_lift: values.number("root_lift"),
        hang: values.number("hang"),
        weight: values.number("weight"),
        spread: values.number("spread"),
        flick: values.number("flick"),
        fullness: values.number("fullness"),
        size: values.number("size"),
        mixed_sizes: values.number("mixed_sizes"),
        scatter: values.number("scatter"),
        length_variation: values.number("length_variation"),
    }
}

/// A list of places `[(longitude, latitude), ...]`, one or more.
fn line_of_places<'a>(reader: &mut Reader<'a>, field: &Field<'a>) -> Vec<Place> {
    let mut places = Vec::new();
    for item in reader.list(field.value, field.name) {
        match ron::from_str::<(f32, f32)>(item) {
            Ok((longitude, latitude))
                if (-360.0..=360.0).contains(&longitude) && (-90.0..=90.0).contains(&latitude) =>
            {
                places.push(Place { longitude, latitude });
            }
            _ => reader.error(
                item,
                format!(
                    "{}: expected (longitude from -360 to 360, latitude from -90 to 90) in degrees, \
                     found `{item:.40}`",
                    field.name
                ),
            ),
        }
    }
    if places.is_empty() {
        reader.error(
            field.value,
            format!("{} needs at least one place", field.name),
        );
    }
    places
}
