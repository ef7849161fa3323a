//! What lies on the hair, as styles write it.

use super::lines::places;
use effects::preset::{Field, Reader};
use effects::{choices, section};
use groom::{Accessory, AccessoryKind};

choices! {
    /// What lies on the hair.
    pub(super) enum AccessoryChoice {
        /// A bar that holds hair.
        Clip = "clip",
        /// A bow.
        Bow = "bow",
        /// A band over the head.
        Hairband = "hairband",
    }
}

section! {
    /// What an accessory may say, beside `at`.
    pub(super) struct AccessoryFields {
        /// What it is.
        kind: AccessoryChoice = AccessoryChoice::Clip.or_another(),
        /// Height above the skin.
        lift: f32 = number(0.09, 0.0..=2.0).unit("head heights"),
        /// Half its length; half the width of a hairband.
        size: f32 = number(0.06, 0.001..=2.0).unit("head heights"),
        /// How far it is turned on the hair; 0 lies level.
        turn: f32 = number(0.0, -360.0..=360.0).unit("degrees"),
        /// Whether it is also on the other side.
        mirror: bool = flag(false),
    }
}

/// Reads an accessory.
pub(super) fn accessory<'a>(reader: &mut Reader<'a>, item: &'a str) -> Option<Accessory> {
    let fields = reader.fields(item, "an accessory");
    let (at, plain): (Vec<Field>, Vec<Field>) =
        fields.into_iter().partition(|field| field.name == "at");
    let fields: AccessoryFields = reader.section_of(&plain, "an accessory");
    let Some(at) = at.first() else {
        reader.error(
            item,
            "an accessory needs `at`, its place: at: [(longitude, latitude)]",
        );
        return None;
    };
    let at = places(reader, at);
    if at.is_empty() {
        return None;
    }
    let kind = match fields.kind {
        AccessoryChoice::Clip => AccessoryKind::Clip,
        AccessoryChoice::Bow => AccessoryKind::Bow,
        AccessoryChoice::Hairband => AccessoryKind::Hairband,
    };
    if kind == AccessoryKind::Hairband && at.len() < 2 {
        reader.error(
            item,
            "a hairband needs two places or more to run through: at: [(-95, 0), (0, 80), (95, 0)]",
        );
        return None;
    }
    if kind != AccessoryKind::Hairband && at.len() > 1 {
        reader.error(item, "a clip or a bow lies at one place: at: [(40, 30)]");
        return None;
    }
    Some(Accessory {
        kind,
        at,
        lift: fields.lift,
        size: fields.size,
        turn: fields.turn,
        mirror: fields.mirror,
    })
}
