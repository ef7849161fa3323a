//! Places and lines on the head, as styles write them.

use effects::preset::{Field, Reader};
use groom::{Line, Place};

/// How a line may be written, for messages.
const EXPECTED: &str = "expected a list of places such as [(-40, 50), (40, 50)], or whorl, parting \
                        or hairline(FROM, TO)";

/// A line: through places, or one that the style has a name for.
pub(super) fn line<'a>(reader: &mut Reader<'a>, field: &Field<'a>) -> Line {
    if field.value.starts_with('[') {
        return Line::Through(places(reader, field));
    }
    let word = field.value.split('(').next().unwrap_or_default().trim();
    match word {
        "whorl" if word == field.value => Line::Whorl,
        "parting" if word == field.value => Line::Parting,
        "hairline" => match ron::from_str::<(f32, f32)>(&field.value[word.len()..]) {
            Ok((from, to)) if is_longitude(from) && is_longitude(to) => Line::Hairline { from, to },
            _ => {
                reader.error(
                    field.value,
                    format!(
                        "{}: expected hairline(FROM, TO), longitudes from -360 to 360 degrees, \
                         found `{:.40}`",
                        field.name, field.value
                    ),
                );
                Line::Whorl
            }
        },
        _ => {
            reader.error(
                field.value,
                format!("{}: {EXPECTED}, found `{:.40}`", field.name, field.value),
            );
            Line::Whorl
        }
    }
}

/// A list of places `[(longitude, latitude), ...]`, one or more.
pub(super) fn places<'a>(reader: &mut Reader<'a>, field: &Field<'a>) -> Vec<Place> {
    let items = reader.list(field.value, field.name);
    let found: Vec<Place> = items
        .iter()
        .filter_map(|item| place(reader, field.name, item))
        .collect();
    if items.is_empty() {
        reader.error(
            field.value,
            format!("{} needs at least one place", field.name),
        );
    }
    found
}

/// A place `(longitude, latitude)`.
pub(super) fn place<'a>(reader: &mut Reader<'a>, name: &str, item: &'a str) -> Option<Place> {
    match ron::from_str::<(f32, f32)>(item) {
        Ok((longitude, latitude)) if is_longitude(longitude) && is_latitude(latitude) => {
            Some(Place {
                longitude,
                latitude,
            })
        }
        _ => {
            reader.error(
                item,
                format!(
                    "{name}: expected (longitude from -360 to 360, latitude from -90 to 90) in \
                     degrees, found `{item:.40}`"
                ),
            );
            None
        }
    }
}

/// A point of a hand-drawn clump: `(longitude, latitude, height above the skin)`.
pub(super) fn point<'a>(reader: &mut Reader<'a>, item: &'a str) -> Option<(Place, f32)> {
    match ron::from_str::<(f32, f32, f32)>(item) {
        Ok((longitude, latitude, lift))
            if is_longitude(longitude)
                && is_latitude(latitude)
                && (-0.5..=20.0).contains(&lift) =>
        {
            let place = Place {
                longitude,
                latitude,
            };
            Some((place, lift))
        }
        _ => {
            reader.error(
                item,
                format!(
                    "points: expected (longitude from -360 to 360, latitude from -90 to 90, height \
                     above the skin from -0.5 to 20 head heights), found `{item:.40}`"
                ),
            );
            None
        }
    }
}

fn is_longitude(degrees: f32) -> bool {
    (-360.0..=360.0).contains(&degrees)
}

fn is_latitude(degrees: f32) -> bool {
    (-90.0..=90.0).contains(&degrees)
}
