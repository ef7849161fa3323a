//! A zone of a style: what it may say, and what it means.

use super::lines::line;
use crate::dynamics::{FeelChoice, ZoneDynamics};
use effects::preset::{Field, Reader};
use effects::{Variation, choices, section};
use glam::Vec3;
use groom::{Form, Line, MOST_CLUMPS, Taper, TieKind, Zone};
use render::NO_COLOR;

/// Most rows of a zone.
const MOST_ROWS: u32 = 32;

choices! {
    /// What the hair of a zone is made into.
    pub(super) enum FormChoice {
        /// Rows over the head.
        Rows = "rows",
        /// A tail.
        Tail = "tail",
        /// A bun.
        Bun = "bun",
        /// A braid.
        Braid = "braid",
    }
}

choices! {
    /// What gathers hair.
    pub(super) enum TieChoice {
        /// A thick ring.
        Ring = "ring",
        /// A flat band that fits the hair.
        Band = "band",
        /// A folded ring of cloth.
        Scrunchie = "scrunchie",
        /// A band with a bow on it.
        Bow = "bow",
        /// A bar across the hair, as a pin.
        Clip = "clip",
    }
}

choices! {
    /// What the hair of a zone is like.
    pub(super) enum ZoneFeelChoice {
        /// As the look says.
        Look = "look",
        /// It hangs.
        Limp = "limp",
        /// It swings, and comes to rest.
        Soft = "soft",
        /// It swings long.
        Springy = "springy",
        /// It keeps its style.
        Stiff = "stiff",
        /// It all but stands.
        Gel = "gel",
    }
}

impl ZoneFeelChoice {
    fn feel(self) -> Option<FeelChoice> {
        match self {
            Self::Look => None,
            Self::Limp => Some(FeelChoice::Limp),
            Self::Soft => Some(FeelChoice::Soft),
            Self::Springy => Some(FeelChoice::Springy),
            Self::Stiff => Some(FeelChoice::Stiff),
            Self::Gel => Some(FeelChoice::Gel),
        }
    }
}

section! {
    /// What a zone may say, beside `roots` and `tips`.
    pub(super) struct ZoneFields {
        /// A name, unique in the style; the zone's variations hang on it.
        name: Option<String> = text(),
        /// What the hair is made into: rows over the head; a tail, a bun or a braid from its roots.
        form: FormChoice = FormChoice::Rows.or_another(),
        /// Whether the zone stands on both sides, each with variations of its own.
        mirror: bool = flag(false),
        /// Clumps of a row, or of gathered hair; on each side where it is mirrored.
        count: u32 = whole(8, 1..=MOST_CLUMPS),
        /// Rows: the first starts at the roots, the others on the way to the tips, under those above.
        rows: u32 = whole(1, 1..=MOST_ROWS),
        /// How far clumps start behind the line of roots; below 0 before it.
        across: f32 = number(0.0, -90.0..=90.0).unit("degrees"),
        /// Sideways bow of the way over the head; above 0 towards the back, on both sides.
        bow: f32 = number(0.0, -60.0..=60.0).unit("degrees"),
        /// Height above the skin at the roots; below 0 their outlines sink into the hair under them.
        root_lift: f32 = number(0.02, -0.2..=1.0).unit("head heights"),
        /// Height above the skin half-way to the tips.
        lift: f32 = number(0.06, 0.0..=1.0).unit("head heights"),
        /// Height above the skin at the tips, where hair begins to hang.
        tip_lift: f32 = number(0.03, 0.0..=1.0).unit("head heights"),
        /// How much heights differ, as a share.
        lift_variation: f32 = number(0.1, 0.0..=1.0),
        /// Share of the way over the head that stays with the head when it moves; all of it where the way leads to one place, as to a tie.
        held: f32 = number(0.5, 0.0..=1.0),
        /// Length that hangs from the tips, from the roots or from the tie.
        hang: f32 = number(0.0, 0.0..=20.0).unit("head heights"),
        /// How much hanging lengths differ, as a share.
        length_variation: f32 = number(0.15, 0.0..=1.0),
        /// How soon hanging hair turns down: 0 never, 1 at once.
        weight: f32 = number(0.5, 0.0..=1.0),
        /// Lean away from the head while it hangs.
        spread: f32 = number(0.0, -2.0..=2.0),
        /// Lean sideways that grows to the tips, the same for all clumps: above 0 towards the back on both sides.
        sweep: f32 = number(0.0, -3.0..=3.0),
        /// How far hanging hair swings to one side and back in an S; below 0 the other way.
        s_curve: f32 = number(0.0, -3.0..=3.0),
        /// How much hanging clumps lean sideways, each its own way.
        sway: f32 = number(0.12, 0.0..=2.0),
        /// Turn of the tips away from the head; below 0 towards it.
        flick: f32 = number(0.0, -4.0..=4.0),
        /// Radius of the curls of hanging hair; 0 is straight.
        curl: f32 = number(0.0, 0.0..=1.0).unit("head heights"),
        /// Length of one turn of a curl, or of a braid's pattern.
        curl_length: f32 = number(0.5, 0.02..=10.0).unit("head heights"),
        /// 0: round curls; 1: flat waves that neighbours share.
        curl_flatness: f32 = number(0.0, 0.0..=1.0),
        /// Radius of gathered hair where it is fullest.
        fullness: f32 = number(0.15, 0.0..=2.0).unit("head heights"),
        /// Share of its length at which gathered hair is fullest.
        swell: f32 = number(0.3, 0.02..=1.0),
        /// Radius of the tie that gathers the hair; 0 draws none.
        tie: f32 = number(0.0, 0.0..=1.0).unit("head heights"),
        /// What the tie is.
        tie_kind: TieChoice = TieChoice::Ring.or_another(),
        /// Where along its hanging length the zone's hair is tied once more, 0 root to 1 tip, and held together there as it moves; 0: nowhere.
        low_tie: f32 = number(0.0, 0.0..=1.0),
        /// Radius of that tie, which moves with the hair.
        low_tie_size: f32 = number(0.05, 0.001..=1.0).unit("head heights"),
        /// Radius of a clump at its full size; 0 takes it from `overlap`.
        size: f32 = number(0.0, 0.0..=200.0).unit("1/300 head height"),
        /// How many times the widths of a row's clumps cover its length.
        overlap: f32 = number(1.5, 0.1..=10.0),
        /// Share of clumps that are of a middle or small size.
        mixed_sizes: f32 = number(0.5, 0.0..=1.0),
        /// How much places differ.
        scatter: f32 = number(1.5, 0.0..=45.0).unit("degrees"),
        /// Groups that the clumps of a row, or of a tail, come together in towards their tips; 0: each goes its own way.
        groups: u32 = whole(0, 0..=MOST_CLUMPS),
        /// How far the tips of a group come together.
        gather: f32 = number(0.7, 0.0..=1.0),
        /// How much shorter the outer clumps of a group are than its middle one.
        peak: f32 = number(0.3, 0.0..=1.0),
        /// Whether all tips end at one height, at `cut_height`.
        cut: bool = flag(false),
        /// The height at which tips end where they are cut, from the middle of the skull.
        cut_height: f32 = number(-0.5, -20.0..=2.0).unit("head heights"),
        /// Size of clumps at their roots, as a share of their full size, in place of the look's; below 0 the look's.
        root_size: f32 = number(-1.0, -1.0..=1.0),
        /// Where along the clumps they begin to shrink to a point, in place of the look's; below 0 the look's.
        shrink_start: f32 = number(-1.0, -1.0..=1.0).unit("0 root to 1 tip"),
        /// Colour of its hair in place of the look's, or none.
        color: Option<[f32; 3]> = optional_color(None),
        /// Colour of its tips in place of the look's, or none.
        tip_color: Option<[f32; 3]> = optional_color(None),
        /// What its hair is like when it moves: as the look's `dynamics` says, or in place of that.
        feel: ZoneFeelChoice = ZoneFeelChoice::Look.or_another(),
        /// Factor on the stiffness of the look's `dynamics`, as those below on what they are called there.
        stiffness: Variation = varying(1.0, 0.001..=1000.0),
        /// Factor on the damping.
        damping: f32 = number(1.0, 0.0..=100.0),
        /// Factor on the drag of the air.
        drag: Variation = varying(1.0, 0.0..=100.0),
        /// Factor on the pull back to the style.
        hold: Variation = varying(1.0, 0.0..=100.0),
        /// Factor on the pull on hair that has come to lie far from its style; 0 leaves it there.
        recall: f32 = number(1.0, 0.0..=100.0),
        /// Factor on the share of the wind that reaches it.
        wind: Variation = varying(1.0, 0.0..=10.0),
        /// Factor on how far its clumps keep from others; 0: they pass through them, as others do through them, which costs less.
        locks: f32 = number(1.0, 0.0..=2.0),
    }
}

/// A zone as its file has it.
pub(super) struct ReadZone {
    /// What grows.
    pub zone: Zone,
    /// How its hair moves, where it says so.
    pub dynamics: Option<ZoneDynamics>,
    /// The colours of its hair at root and tip: see [`render::StrandInfo`].
    pub colors: [Vec3; 2],
}

/// Reads one zone of a style whose hanging hair has so many points.
pub(super) fn zone<'a>(reader: &mut Reader<'a>, item: &'a str, points: u32) -> ReadZone {
    let fields = reader.fields(item, "a zone");
    let (places, plain): (Vec<Field>, Vec<Field>) = fields
        .into_iter()
        .partition(|field| ["roots", "tips"].contains(&field.name));
    let fields: ZoneFields = reader.section_of(&plain, "a zone");
    let mut named = |name: &str| {
        let field = places.iter().find(|field| field.name == name)?;
        Some(line(reader, field))
    };
    let (roots, tips) = (named("roots"), named("tips"));
    let is_rows = fields.form == FormChoice::Rows;
    if roots.is_none() {
        reader.error(
            item,
            "a zone needs `roots`, such as roots: [(-40, 50), (40, 50)], roots: parting or \
             roots: whorl",
        );
    }
    if is_rows && tips.is_none() && fields.hang <= 0.0 {
        reader.error(
            item,
            "a zone needs `tips` to lead to, or a length to `hang`",
        );
    }
    if is_rows && fields.count * fields.rows > MOST_CLUMPS {
        let message = format!(
            "`count` {} in {} rows are {} clumps, a zone has at most {MOST_CLUMPS}",
            fields.count,
            fields.rows,
            fields.count * fields.rows
        );
        reader.error(item, message);
    }
    let dynamics = ZoneDynamics {
        feel: fields.feel.feel(),
        stiffness: fields.stiffness.clone(),
        damping: fields.damping,
        drag: fields.drag.clone(),
        hold: fields.hold.clone(),
        recall: fields.recall,
        wind: fields.wind.clone(),
        locks: fields.locks,
    };
    let or_none = |color: Option<[f32; 3]>| color.map_or(NO_COLOR, Vec3::from);
    ReadZone {
        dynamics: (dynamics != ZoneDynamics::default()).then_some(dynamics),
        colors: [fields.color, fields.tip_color].map(or_none),
        zone: as_grown(fields, roots.unwrap_or(Line::Whorl), tips, points),
    }
}

/// The zone as it is grown.
fn as_grown(fields: ZoneFields, roots: Line, tips: Option<Line>, points: u32) -> Zone {
    Zone {
        name: fields.name.unwrap_or_default(),
        form: match fields.form {
            FormChoice::Rows => Form::Rows,
            FormChoice::Tail => Form::Tail,
            FormChoice::Bun => Form::Bun,
            FormChoice::Braid => Form::Braid,
        },
        count: fields.count,
        rows: fields.rows,
        roots,
        tips,
        mirror: fields.mirror,
        across: fields.across,
        bow: fields.bow,
        root_lift: fields.root_lift,
        lift: fields.lift,
        tip_lift: fields.tip_lift,
        lift_variation: fields.lift_variation,
        held: fields.held,
        hang: fields.hang,
        points,
        length_variation: fields.length_variation,
        weight: fields.weight,
        spread: fields.spread,
        sway: fields.sway,
        flick: fields.flick,
        curl: fields.curl,
        curl_length: fields.curl_length,
        curl_flatness: fields.curl_flatness,
        fullness: fields.fullness,
        tie: fields.tie,
        tie_kind: match fields.tie_kind {
            TieChoice::Ring => TieKind::Ring,
            TieChoice::Band => TieKind::Band,
            TieChoice::Scrunchie => TieKind::Scrunchie,
            TieChoice::Bow => TieKind::Bow,
            TieChoice::Clip => TieKind::Clip,
        },
        low_tie: fields.low_tie,
        low_tie_size: fields.low_tie_size,
        size: Some(fields.size).filter(|size| *size > 0.0),
        overlap: fields.overlap,
        mixed_sizes: fields.mixed_sizes,
        scatter: fields.scatter,
        sweep: fields.sweep,
        s_curve: fields.s_curve,
        swell: fields.swell,
        groups: fields.groups,
        gather: fields.gather,
        peak: fields.peak,
        cut: fields.cut.then_some(fields.cut_height),
        taper: Taper {
            root_size: Some(fields.root_size).filter(|size| *size >= 0.0),
            shrink_start: Some(fields.shrink_start).filter(|start| *start >= 0.0),
        },
    }
}
