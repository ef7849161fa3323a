//! The passes of a preset: what is done with the whole picture's samples, one after the other.

use crate::part::FilePart;
use effects::preset::Reader;
use effects::{Variation, choices, section};

/// The most passes of a picture: each goes over all its samples.
const MOST_PASSES: usize = 64;

/// How the list is written, for those who write something else.
const WRITTEN: &str = "passes: [(edges: strand, width: 1.5, color: \"1A1A1A\"), ...]";

choices! {
    /// What lines of the whole picture are drawn between.
    pub enum EdgesChoice {
        /// Nothing: there are no lines.
        None = "none",
        /// The clump's levels.
        Level = "level",
        /// Strands.
        Strand = "strand",
        /// Hair, heads, clothes and ornaments.
        Object = "object",
        /// Normals.
        Normal = "normal",
        /// Depths.
        Depth = "depth",
        /// Colours.
        Color = "color",
    }
}

section! {
    /// Lines of the whole picture, drawn when it is known what its samples show. A list: later ones lie on top.
    pub struct PassSection {
        /// What lines are drawn between: what is of different levels of the clump, strands or things, or differs in normal, depth or colour. They lie
        /// on what is in front.
        edges: EdgesChoice = EdgesChoice::Strand.or_another(),
        /// Width of the lines; along the strand that they are on where it varies, and its largest on what is no hair.
        width: Variation = varying(1.5, 0.0..=64.0).unit("pixels of 720 lines"),
        /// Between normals or colours: how much they differ, by Sobel's filter; small draws more lines.
        threshold: f32 = number(0.5, 0.0..=10.0),
        /// Between depths: how much farther what is behind lies.
        depth: f32 = number(0.05, 0.0..=100.0).unit("head heights"),
        /// How far along the strand lines grow, as half a cosine, from nothing to their width; 0 has them full from the root on.
        fade: f32 = number(0.0, 0.0..=1.0).unit("0 root to 1 tip"),
        /// Colour of the lines.
        color: [f32; 3] = color("1A1A1A"),
    }
}

/// The list of passes, as `inkstrand effects` and the viewer show it.
pub const PASSES: FilePart = FilePart {
    name: "passes",
    doc: PassSection::DOC,
    example: WRITTEN,
    table: PassSection::TABLE,
    places: &[],
};

impl PassSection {
    /// Reads the list `passes` of a preset.
    pub(super) fn read_list<'a>(reader: &mut Reader<'a>, list: &'a str) -> Vec<Self> {
        if list.starts_with('(') {
            let message = format!("passes is a list, of one set of lines too: {WRITTEN}");
            reader.error(list, message);
            return Vec::new();
        }
        let items = reader.list(list, "passes");
        if items.len() > MOST_PASSES {
            let count = items.len();
            let message = format!("passes: there are {count}, and at most {MOST_PASSES} are drawn");
            reader.error(list, message);
            return Vec::new();
        }
        let read = |item: &&'a str| reader.section(item, "a pass");
        items.iter().map(read).collect()
    }
}
