//! Seeds of variations: each hangs on the style, the layer and the strand alone, never on a place in a list or on a frame.

use crate::wgsl::hash;

/// The seed of a layer's variations: a hash of the style's seed and the layer's name, so that layers
/// vary apart from each other and none changes when another comes or goes.
#[must_use]
pub fn layer_seed(style_seed: u32, name: &str) -> u32 {
    name.bytes()
        .fold(hash(style_seed), |seed, byte| hash(seed ^ u32::from(byte)))
}

/// The seed of one strand's variations in one layer.
#[must_use]
#[inline]
pub fn strand_seed(layer_seed: u32, strand: u32) -> u32 {
    hash(layer_seed ^ hash(strand))
}
