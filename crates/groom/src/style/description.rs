//! What a style says.

use super::edit::{Drawn, Edit};
use super::line::Line;
use super::ornament::{Accessory, TieKind};
use super::scalp::Scalp;

/// A hair style. Lengths are in head heights, angles in degrees, radii of clumps (`size`) in 1/300 head height, where nothing else is said.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Seed of all variations.
    pub seed: u32,
    /// Where hair grows, and where it parts.
    pub scalp: Scalp,
    /// Whether a coat of flat clumps covers the scalp below all zones.
    pub undercoat: bool,
    /// How high the undercoat stands above the skin at the whorl, head heights.
    pub cap: f32,
    /// How many broad clumps the undercoat is made of; 0: rows of narrow ones, as first styles have it.
    pub coat: u32,
    /// The zones.
    pub zones: Vec<Zone>,
    /// Changes of single clumps of the zones.
    pub edits: Vec<Edit>,
    /// Clumps drawn by hand, at most [`MOST_CLUMPS`](crate::MOST_CLUMPS): more would have ids of others.
    pub drawn: Vec<Drawn>,
    /// What lies on the hair.
    pub accessories: Vec<Accessory>,
}

/// Rows of clumps, or hair gathered in a tie. Lengths are in head heights, angles in degrees, radii of clumps (`size`) in 1/300 head height, where
/// nothing else is said.
///
/// A clump of a row starts on the way from the line of roots to the line of tips, runs over the head to
/// the line of tips and hangs from there. Gathered hair starts at one place, its tie.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    /// Its name; variations hang on it.
    pub name: String,
    /// What its hair is made into.
    pub form: Form,
    /// Clumps of a row on each side, or of gathered hair. Of all rows at most [`MOST_CLUMPS`](crate::MOST_CLUMPS) grow.
    pub count: u32,
    /// Rows: the first starts at the line of roots, the others evenly on the way to the tips.
    pub rows: u32,
    /// The line of roots; the place of the tie where hair is gathered.
    pub roots: Line,
    /// The line that the clumps lead to; nothing to hang from the roots at once.
    pub tips: Option<Line>,
    /// Also on the head's other side, with variations of its own.
    pub mirror: bool,
    /// How far the clumps start behind the line of roots, degrees; below 0 before it.
    pub across: f32,
    /// Sideways bow of the way over the head, degrees: above 0 towards the back on both sides.
    pub bow: f32,
    /// Height above the skin at the roots.
    pub root_lift: f32,
    /// Height above the skin half-way.
    pub lift: f32,
    /// Height above the skin at the tips.
    pub tip_lift: f32,
    /// How much heights differ, 0 to 1.
    pub lift_variation: f32,
    /// Share of the way over the head that stays with the head when it moves, 0 to 1; all of it where
    /// the way leads to one place.
    pub held: f32,
    /// Length that hangs.
    pub hang: f32,
    /// Points of hair that hangs without curls, 10 at least.
    pub points: u32,
    /// How much hanging lengths differ, 0 to 1.
    pub length_variation: f32,
    /// How soon hanging hair turns down: 0 keeps its way, 1 at once.
    pub weight: f32,
    /// Lean away from the head while it hangs; below 0 towards it.
    pub spread: f32,
    /// Lean sideways that grows to the tip, the same for all: above 0 towards the back on both sides.
    pub sweep: f32,
    /// Lean to one side, then to the other: how far hanging hair swings in an S.
    pub s_curve: f32,
    /// How much hanging clumps lean sideways, each its own way.
    pub sway: f32,
    /// Turn of the tip away from the head; below 0 towards it.
    pub flick: f32,
    /// Radius of the curls of hanging hair.
    pub curl: f32,
    /// Length of hair in one turn of a curl, or between the crossings of a braid.
    pub curl_length: f32,
    /// 0: round curls; 1: flat waves.
    pub curl_flatness: f32,
    /// Radius of gathered hair where it is fullest.
    pub fullness: f32,
    /// Share of its length at which gathered hair is fullest, above 0.
    pub swell: f32,
    /// Radius of the tie that gathers the hair; 0 draws none.
    pub tie: f32,
    /// What the tie is.
    pub tie_kind: TieKind,
    /// Where along its hanging length hair is tied again, 0 to 1; 0: nowhere.
    pub low_tie: f32,
    /// Radius of that tie.
    pub low_tie_size: f32,
    /// Radius of a clump at its full size; nothing to take it from the row's length and `overlap`.
    pub size: Option<f32>,
    /// How many times the widths of a row's clumps cover its length.
    pub overlap: f32,
    /// How many clumps are of a middle or small size, 0 to 1.
    pub mixed_sizes: f32,
    /// How much places differ, degrees.
    pub scatter: f32,
    /// Groups that the clumps come together in towards their tips; 0: each goes its own way.
    pub groups: u32,
    /// How far the tips of a group come together, 0 to 1.
    pub gather: f32,
    /// How much shorter the outer clumps of a group are than its middle one, 0 to 1.
    pub peak: f32,
    /// Height above the middle of the skull at which all tips end, head heights; nothing to leave them as they fall.
    pub cut: Option<f32>,
    /// How its clumps begin and end.
    pub taper: Taper,
}

/// How a clump begins and ends, where the look is not to say so.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Taper {
    /// Size at the root, as a share of the full size.
    pub root_size: Option<f32>,
    /// Where along the clump it begins to shrink, 0 root to 1 tip.
    pub shrink_start: Option<f32>,
}

/// What the hair of a zone is made into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Rows over the head, hanging from its rim.
    Rows,
    /// A tail that hangs from a tie.
    Tail,
    /// A bun wound around a tie.
    Bun,
    /// A braid of three plaits that hangs from a tie.
    Braid,
}
