//! Hair styles as text, `*.style.ron`: zones of clumps that grow on any head.
//!
//! Places are (longitude, latitude) in degrees: longitude 0 is the face, 90 the character's left ear,
//! 180 the back; latitude 90 the top.

mod accessories;
mod clumps;
mod lines;
mod zone;

use crate::dynamics::ZoneDynamics;
use crate::part::FilePart;
use accessories::AccessoryFields;
use clumps::{DrawnFields, EditFields};
use effects::preset::{Field, PresetErrors, Reader};
use effects::section;
use glam::Vec3;
use groom::{MOST_CLUMPS, Scalp, Style};
use zone::{ReadZone, ZoneFields};

/// The newest version of styles that this build reads.
const VERSION: u32 = 1;

section! {
    /// What a style may say, beside its places and lists.
    struct StyleFields {
        /// Version of the style's format.
        version: u32 = whole(VERSION, 1..=VERSION),
        /// Seed of all variations.
        seed: u32 = whole(1, 0..=i32::MAX as u32),
        /// Whether flat clumps cover the scalp below all zones, so that none of it shows.
        undercoat: bool = flag(true),
        /// How high the undercoat stands above the skin at the whorl: roots sink into it, so that the crown is no valley.
        cap: f32 = number(0.05, 0.0..=0.3).unit("head heights"),
        /// Points of hair that hangs without curls: more bend in smaller bows, lie closer on shoulders and other bodies, and take the simulation longer.
        points: u32 = whole(10, 10..=160),
        /// How many broad clumps the undercoat is made of, 6 at least; 0: rings of narrow ones, 72 in all.
        coat: u32 = whole(0, 0..=200),
    }
}

/// The parts of a hair style.
pub const STYLE_PARTS: &[FilePart] = &[
    FilePart {
        name: "style",
        doc: "A hair style, a file of its own: NAME.style.ron.",
        example: "(version: 1, zones: [...], edits: [...], strands: [...])",
        table: StyleFields::TABLE,
        places: &[
            (
                "whorl",
                "The place that hair turns around: (longitude, latitude) in degrees; longitude 0 is the \
                 face, 90 the character's left ear, 180 the back; latitude 90 the top.",
            ),
            (
                "parting",
                "The parting's places from front to back: [(0, 46), (0, 68), ...].",
            ),
            (
                "hairline",
                "The hairline's places from the forehead (longitude 0) to the nape (180); the other side \
                 is its image.",
            ),
        ],
    },
    FilePart {
        name: "zones",
        doc: "Rows of clumps, tails, buns and braids.",
        example: "zones: [(name: \"fringe\", roots: [...], tips: [...], name: value, ...), ...]",
        table: ZoneFields::TABLE,
        places: &[
            (
                "roots",
                "The line where clumps start: a list of places, whorl, parting or hairline(FROM, TO); \
                 the tie of a tail, bun or braid.",
            ),
            (
                "tips",
                "The line that they lead to over the head, and hang from; without it they hang from \
                 their roots.",
            ),
        ],
    },
    FilePart {
        name: "edits",
        doc: "Changes of single clumps.",
        example: "edits: [(zone: \"fringe\", clump: 3, name: value, ...), ...]",
        table: EditFields::TABLE,
        places: &[],
    },
    FilePart {
        name: "strands",
        doc: "Clumps drawn by hand.",
        example: "strands: [(points: [(0, 60, 0), ...], name: value, ...), ...]",
        table: DrawnFields::TABLE,
        places: &[(
            "points",
            "From root to tip: (longitude, latitude, height above the skin in head heights), two or more.",
        )],
    },
    FilePart {
        name: "accessories",
        doc: "What lies on the hair, in the colours of ties.",
        example: "accessories: [(kind: clip, at: [(40, 30)], name: value, ...), ...]",
        table: AccessoryFields::TABLE,
        places: &[(
            "at",
            "Its place, [(longitude, latitude)]; for a hairband the places that it runs through, from one end to the other.",
        )],
    },
];

/// Most accessories of a style.
const MOST_ACCESSORIES: usize = 1000;

/// Fields of a style that hold places, zones or clumps.
const LISTS: [&str; 7] = [
    "whorl",
    "parting",
    "hairline",
    "zones",
    "edits",
    "strands",
    "accessories",
];

/// A style as its file has it.
pub(crate) struct Written {
    /// What grows.
    pub style: Style,
    /// How the hair of each zone moves, where it says so.
    pub dynamics: Vec<Option<ZoneDynamics>>,
    /// The colours of the hair of each zone at root and tip: see [`render::StrandInfo`].
    pub colors: Vec<[Vec3; 2]>,
}

/// Reads the style `text`, which messages call `file`.
///
/// # Errors
///
/// All mistakes of the file, each with its line and column.
pub(crate) fn parse(file: &str, text: &str) -> Result<Written, PresetErrors> {
    let mut reader = Reader::of("hair style", file, text);
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
    let top: StyleFields = reader.section_beside(&plain, "the style", &LISTS);
    let mut style = Style {
        seed: top.seed,
        scalp: scalp(&mut reader, &lists),
        undercoat: top.undercoat,
        cap: top.cap,
        coat: top.coat,
        zones: Vec::new(),
        edits: Vec::new(),
        drawn: Vec::new(),
        accessories: Vec::new(),
    };
    let (mut dynamics, mut colors) = (Vec::new(), Vec::new());
    for item in items(&mut reader, &lists, "zones") {
        let ReadZone {
            zone,
            dynamics: moved,
            colors: own,
        } = zone::zone(&mut reader, item, top.points);
        dynamics.push(moved);
        colors.push(own);
        if style.zones.iter().any(|other| other.name == zone.name) {
            reader.error(item, format!("there is already a zone `{:.40}`", zone.name));
        }
        style.zones.push(zone);
    }
    let drawn = items(&mut reader, &lists, "strands");
    if let Some(first) = drawn.get(MOST_CLUMPS as usize) {
        reader.error(
            first,
            format!("a style has at most {MOST_CLUMPS} `strands` of its own"),
        );
    }
    for item in drawn.into_iter().take(MOST_CLUMPS as usize) {
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
    let worn = items(&mut reader, &lists, "accessories");
    if let Some(first) = worn.get(MOST_ACCESSORIES) {
        reader.error(
            first,
            format!("a style has at most {MOST_ACCESSORIES} accessories"),
        );
    }
    for item in worn.into_iter().take(MOST_ACCESSORIES) {
        style
            .accessories
            .extend(accessories::accessory(&mut reader, item));
    }
    reader.report()?;
    Ok(Written {
        style,
        dynamics,
        colors,
    })
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
