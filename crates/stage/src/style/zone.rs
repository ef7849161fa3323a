//! A zone of a style: what it may say, and what it means.

use super::lines::line;
use crate::table::{choice, number, param};
use effects::preset::{Field, Reader};
use effects::{Param, ParamKind, Values};
use groom::{Form, Line, MOST_CLUMPS, Zone};

/// Most rows of a zone.
const MOST_ROWS: i32 = 32;

/// What a zone may say, beside `roots` and `tips`.
pub(super) const ZONE: &[Param] = &[
    param(
        "name",
        "A name, unique in the style; the zone's variations hang on it.",
        ParamKind::Text,
    ),
    choice(
        "form",
        "What the hair is made into: rows over the head; a tail, a bun or a braid from its roots.",
        &["rows", "tail", "bun", "braid"],
        0,
    ),
    choice(
        "mirror",
        "Whether the zone stands on both sides, each with variations of its own.",
        &["false", "true"],
        0,
    ),
    param(
        "count",
        "Clumps of a row, or of gathered hair; on each side where it is mirrored.",
        ParamKind::Integer {
            min: 1,
            max: MOST_CLUMPS as i32,
            default: 8,
        },
    ),
    param(
        "rows",
        "Rows: the first starts at the roots, the others on the way to the tips, under those above.",
        ParamKind::Integer {
            min: 1,
            max: MOST_ROWS,
            default: 1,
        },
    ),
    number(
        "across",
        "How far clumps start behind the line of roots; below 0 before it.",
        "degrees",
        -90.0..=90.0,
        0.0,
    ),
    number(
        "bow",
        "Sideways bow of the way over the head; above 0 towards the back, on both sides.",
        "degrees",
        -60.0..=60.0,
        0.0,
    ),
    number(
        "root_lift",
        "Height above the skin at the roots; below 0 their outlines sink into the hair under them.",
        "head heights",
        -0.2..=1.0,
        0.02,
    ),
    number(
        "lift",
        "Height above the skin half-way to the tips.",
        "head heights",
        0.0..=1.0,
        0.06,
    ),
    number(
        "tip_lift",
        "Height above the skin at the tips, where hair begins to hang.",
        "head heights",
        0.0..=1.0,
        0.03,
    ),
    number(
        "lift_variation",
        "How much heights differ, as a share.",
        "",
        0.0..=1.0,
        0.1,
    ),
    number(
        "held",
        "Share of the way over the head that stays with the head when it moves; all of it where the way \
         leads to one place, as to a tie.",
        "",
        0.0..=1.0,
        0.5,
    ),
    number(
        "hang",
        "Length that hangs from the tips, from the roots or from the tie.",
        "head heights",
        0.0..=20.0,
        0.0,
    ),
    number(
        "length_variation",
        "How much hanging lengths differ, as a share.",
        "",
        0.0..=1.0,
        0.15,
    ),
    number(
        "weight",
        "How soon hanging hair turns down: 0 never, 1 at once.",
        "",
        0.0..=1.0,
        0.5,
    ),
    number(
        "spread",
        "Lean away from the head while it hangs.",
        "",
        -2.0..=2.0,
        0.0,
    ),
    number(
        "sway",
        "How much hanging clumps lean sideways, each its own way.",
        "",
        0.0..=2.0,
        0.12,
    ),
    number(
        "flick",
        "Turn of the tips away from the head; below 0 towards it.",
        "",
        -4.0..=4.0,
        0.0,
    ),
    number(
        "curl",
        "Radius of the curls of hanging hair; 0 is straight.",
        "head heights",
        0.0..=1.0,
        0.0,
    ),
    number(
        "curl_length",
        "Length of one turn of a curl, or of a braid's pattern.",
        "head heights",
        0.02..=10.0,
        0.5,
    ),
    number(
        "curl_flatness",
        "0: round curls; 1: flat waves that neighbours share.",
        "",
        0.0..=1.0,
        0.0,
    ),
    number(
        "fullness",
        "Radius of gathered hair where it is fullest.",
        "head heights",
        0.0..=2.0,
        0.15,
    ),
    number(
        "tie",
        "Radius of the tie that gathers the hair; 0 draws none.",
        "head heights",
        0.0..=1.0,
        0.0,
    ),
    number(
        "size",
        "Radius of a clump at its full size; 0 takes it from `overlap`.",
        "1/300 head height",
        0.0..=200.0,
        0.0,
    ),
    number(
        "overlap",
        "How many times the widths of a row's clumps cover its length.",
        "",
        0.1..=10.0,
        1.5,
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
        1.5,
    ),
];

/// Reads one zone.
pub(super) fn zone<'a>(reader: &mut Reader<'a>, item: &'a str) -> Zone {
    let fields = reader.fields(item, "a zone");
    let (places, plain): (Vec<Field>, Vec<Field>) = fields
        .into_iter()
        .partition(|field| ["roots", "tips"].contains(&field.name));
    let values = reader.values(&plain, ZONE, "a zone");
    let mut named = |name: &str| {
        let field = places.iter().find(|field| field.name == name)?;
        Some(line(reader, field))
    };
    let (roots, tips) = (named("roots"), named("tips"));
    let is_rows = values.choice("form") == 0;
    if roots.is_none() {
        reader.error(
            item,
            "a zone needs `roots`, such as roots: [(-40, 50), (40, 50)], roots: parting or \
             roots: whorl",
        );
    }
    if is_rows && tips.is_none() && values.number("hang") <= 0.0 {
        reader.error(
            item,
            "a zone needs `tips` to lead to, or a length to `hang`",
        );
    }
    from_values(&values, roots.unwrap_or(Line::Whorl), tips)
}

fn from_values(values: &Values, roots: Line, tips: Option<Line>) -> Zone {
    let number = |name| values.number(name);
    let forms = [Form::Rows, Form::Tail, Form::Bun, Form::Braid];
    Zone {
        name: values.text("name").unwrap_or_default().to_owned(),
        form: forms[values.choice("form") as usize],
        count: values.integer("count").unsigned_abs(),
        rows: values.integer("rows").unsigned_abs(),
        roots,
        tips,
        mirror: values.choice("mirror") == 1,
        across: number("across"),
        bow: number("bow"),
        root_lift: number("root_lift"),
        lift: number("lift"),
        tip_lift: number("tip_lift"),
        lift_variation: number("lift_variation"),
        held: number("held"),
        hang: number("hang"),
        length_variation: number("length_variation"),
        weight: number("weight"),
        spread: number("spread"),
        sway: number("sway"),
        flick: number("flick"),
        curl: number("curl"),
        curl_length: number("curl_length"),
        curl_flatness: number("curl_flatness"),
        fullness: number("fullness"),
        tie: number("tie"),
        size: Some(number("size")).filter(|size| *size > 0.0),
        overlap: number("overlap"),
        mixed_sizes: number("mixed_sizes"),
        scatter: number("scatter"),
    }
}
