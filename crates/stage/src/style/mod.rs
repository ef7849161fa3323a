//! Hair styles as text, `*.style.ron`: zones of clumps that grow on any head.
//!
//! Places are (longitude, latitude) in degrees: longitude 0 is the face, 90 the character's left ear,
//! 180 the back; latitude 90 the top.

mod clumps;
mod lines;
mod zone;

pub use clumps::{DRAWN, EDIT};
pub use zone::ZONE;

use crate::preset::{choice, param};
use effects::preset::{Field, PresetErrors, Reader};
use effects::{Param, ParamKind};
use groom::{Scalp, Style};

/// The newest version of styles that this build reads.
const VERSION: i32 = 1;

/// What a style may say, beside its places and lists.
pub const STYLE: &[Param] = &[
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
    choice(
        "undercoat",
        "Whether flat clumps cover the scalp below all zones, so that none of it shows.",
        &["false", "true"],
        1,
    ),
];

/// Fields of a style that hold places, zones or clumps.
const LISTS: [&str; 6] = ["whorl", "parting", "hairline", "zones", "edits", "strands"];

/// Reads the style `text`, which messages call `file`.
///
/// # Errors
///
/// All mistakes of the file, each with its line and column.
pub(crate) fn parse(file: &str, text: &str) -> Result<Style, PresetErrors> {
    let mut reader = Reader::new(file, text);
    let fields = reader.fields(text, "the style");
    reader.report()?;
    let (lists, plain): (Vec<Field>, Vec<Field>) = fields
        .into_iter()
        .partition(|field| LISTS.contains(&field.name));
    if plain.iter().all(|field| field.name != "version") {
        reader.error(
            text,
            format!("the style needs `version: {VERSION}`, the version of its format"),
        );
    }
    let top = reader.values(&plain, STYLE, "the style");
    let mut style = Style {
        seed: top.integer("seed").unsigned_abs(),
        scalp: scalp(&mut reader, &lists),
        undercoat: top.choice("undercoat") == 1,
        zones: Vec::new(),
        edits: Vec::new(),
        drawn: Vec::new(),
    };
    for item in items(&mut reader, &lists, "zones") {
        let zone = zone::zone(&mut reader, item);
        if style.zones.iter().any(|other| other.name == zone.name) {
            reader.error(item, format!("there is already a zone `{}`", zone.name));
        }
        style.zones.push(zone);
    }
    for item in items(&mut reader, &lists, "strands") {
        style.drawn.push(clumps::drawn(&mut reader, item));
    }
    if style.zones.is_empty() && style.drawn.is_empty() {
        let list = lists.iter().find(|field| field.name == "zones");
        reader.error(
            list.map_or(text, |field| field.value),
            "the style has no `zones` and no `strands`, so no hair would grow",
        );
    }
    for item in items(&mut reader, &lists, "edits") {
        style
            .edits
            .extend(clumps::edit(&mut reader, item, &style.zones));
    }
    reader.report()?;
    Ok(style)
}

/// The items of one of the style's lists.
fn items<'a>(reader: &mut Reader<'a>, lists: &[Field<'a>], name: &str) -> Vec<&'a str> {
    match lists.iter().find(|field| field.name == name) {
        Some(field) => reader.list(field.value, field.name),
        None => Vec::new(),
    }
}

/// The scalp, with what the style leaves out from a drawn character's.
fn scalp<'a>(reader: &mut Reader<'a>, lists: &[Field<'a>]) -> Scalp {
    let mut scalp = Scalp::default();
    for field in lists {
        match field.name {
            "whorl" => {
                if let Some(place) = lines::place(reader, "whorl", field.value) {
                    scalp.whorl = place;
                }
            }
            "parting" => {
                let places = lines::places(reader, field);
                if !places.is_empty() {
                    scalp.parting = places;
                }
            }
            "hairline" => {
                let places = lines::places(reader, field);
                let ascends = places.is_sorted_by(|a, b| a.longitude < b.longitude);
                let is_half = places.iter().all(|p| (0.0..=180.0).contains(&p.longitude));
                if !(ascends && is_half) {
                    reader.error(
                        field.value,
                        "hairline: longitudes must ascend from 0 (forehead) to 180 (nape)",
                    );
                } else if !places.is_empty() {
                    scalp.hairline = places;
                }
            }
            _ => {}
        }
    }
    scalp
}
