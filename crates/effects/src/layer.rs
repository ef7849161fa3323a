//! A layer: one effect in a preset, with its parameters.

use crate::choices;
use crate::effect::LayerProgram;
use crate::wgsl::hash;

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

/// One effect of a preset.
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
    /// The effect with its parameters.
    pub program: Box<dyn LayerProgram>,
}

/// The seed of a layer's variations: a hash of the style's seed and the layer's name, so that layers
/// vary apart from each other and none changes when another comes or goes.
#[must_use]
pub fn layer_seed(style_seed: u32, name: &str) -> u32 {
    name.bytes()
        .fold(hash(style_seed), |seed, byte| hash(seed ^ u32::from(byte)))
}
