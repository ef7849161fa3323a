//! A layer: one effect in a preset, with its parameters.

use crate::brush::BrushTexture;
use crate::choices;
use crate::effect::LayerProgram;
use crate::joints::Input;
use std::sync::Arc;

choices! {
    /// What a layer's widths are measured in.
    #[derive(Default)]
    pub enum Units {
        /// 1/300 of the head's height, in the world: zoom keeps the drawing.
        #[default]
        World = "world",
        /// Screen pixels at 720 lines: lines keep their width.
        Pixels = "pixels",
    }
}

/// One effect of a preset. A clone is cheap.
#[derive(Clone)]
pub struct Layer {
    /// Unique in the preset; the effect's id where the preset says nothing.
    pub name: String,
    /// The effect's id.
    pub effect: &'static str,
    /// Drawing order within a strand, low first; 0 is the base stroke's.
    pub rank: i32,
    /// How much farther from the eye the strokes are than their strand, in head heights.
    pub depth_offset: f32,
    /// What widths are measured in.
    pub units: Units,
    /// The zones of a hair style whose hair it draws: names with commas between them, `*` at the end of one for any end. All hair
    /// where it says nothing.
    pub zones: Option<String>,
    /// The meshes that it paints, of an effect for meshes, or the lines that it draws, of one for lines: names with commas between them, `*` for
    /// any end.
    pub on: Option<String>,
    /// How much of what it paints is seen through hair before it, 0 to 1.
    pub through_hair: f32,
    /// What its strokes are drawn on, if they are decals: `hair`, `head` for all meshes, or names of these, with commas between them.
    pub clip: Option<String>,
    /// How far before or behind its strokes, head heights, decals are drawn on that.
    pub reach: f32,
    /// What of its strokes is covered; all where there is none.
    pub brush: Option<Arc<BrushTexture>>,
    /// The effect with its parameters.
    pub program: Arc<dyn LayerProgram>,
}

impl Layer {
    /// Whether its strokes are decals: drawn on what is seen without them, and nowhere else.
    #[must_use]
    pub fn is_decal(&self) -> bool {
        self.clip.is_some()
    }

    /// Whether its widths are in pixels.
    #[must_use]
    pub fn is_in_pixels(&self) -> bool {
        self.units == Units::Pixels && self.program.inputs().has(Input::Unit)
    }
}
