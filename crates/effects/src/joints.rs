//! The joints of all strands, as effects see them: one list per input, empty where nobody reads it.

use crate::wgsl::{Vec2, Vec3, hash, vec3};

/// Lists of what joints offer. Every list that an active effect declares has one entry per joint;
/// the others are empty. Names, types and units are those of `effects_build::INPUTS`.
#[derive(Clone, Debug, Default)]
#[allow(
    missing_docs,
    reason = "documented in effects_build::INPUTS, and held against it by a test"
)]
pub struct Joints {
    pub position: Vec<Vec3<f32>>,
    pub forward: Vec<Vec3<f32>>,
    pub backward: Vec<Vec3<f32>>,
    pub u: Vec<f32>,
    pub arc_length: Vec<f32>,
    pub strand: Vec<u32>,
    pub strand_mean: Vec<Vec3<f32>>,
    pub head_center: Vec<Vec3<f32>>,
    pub head_height: Vec<f32>,
    pub strand_size: Vec<f32>,
    pub light_direction: Vec<Vec3<f32>>,
    pub light_distance: Vec<f32>,
    pub view_direction: Vec<Vec3<f32>>,
    pub across: Vec<Vec2<f32>>,
    pub material_normal: Vec<Vec3<f32>>,
    /// A screen pixel at 720 lines in 1/300 of the head's height; empty where the layer's unit is
    /// not a pixel.
    pub pixel: Vec<f32>,
    pub normal: Vec<Vec3<f32>>,
    pub clump_radius: Vec<f32>,
    pub clump_color: Vec<Vec3<f32>>,
    pub clump_shift: Vec<Vec2<f32>>,
    pub gray: Vec<f32>,
}

impl Joints {
    /// One unit of the layer's widths at joint `index`, in 1/300 of the head's height.
    #[must_use]
    #[inline]
    pub fn unit(&self, index: usize) -> f32 {
        self.pixel.get(index).copied().unwrap_or(1.0)
    }

    /// The material normal of joint `index`; zero where the frame has none, as the clump reads it only where its
    /// parameters say so.
    #[must_use]
    #[inline]
    pub fn material_normal_or_zero(&self, index: usize) -> Vec3<f32> {
        let zero = vec3([0.0; 3]);
        self.material_normal.get(index).copied().unwrap_or(zero)
    }
}

/// The seed of one strand's variations in one layer.
#[must_use]
#[inline]
pub fn strand_seed(layer_seed: u32, strand: u32) -> u32 {
    hash(layer_seed ^ hash(strand))
}

/// A set of inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InputSet(u64);

impl InputSet {
    /// Inputs by their names.
    ///
    /// # Panics
    ///
    /// When a name is not an input's: the table is made at build time from the same list.
    #[must_use]
    pub fn of(names: &[&str]) -> Self {
        let bit = |name: &&str| match NAMES.iter().position(|n| n == name) {
            Some(index) => 1 << index,
            None => panic!("there is no input `{name}`"),
        };
        Self(names.iter().map(bit).fold(0, |set, bit| set | bit))
    }

    /// Both sets' inputs.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether the input of this name is in the set.
    #[must_use]
    pub fn has(self, name: &str) -> bool {
        NAMES
            .iter()
            .position(|n| *n == name)
            .is_some_and(|index| self.0 >> index & 1 == 1)
    }
}

/// The inputs' names, in the order of `effects_build::INPUTS`.
const NAMES: &[&str] = &[
    "position",
    "forward",
    "backward",
    "u",
    "arc_length",
    "strand",
    "seed",
    "strand_mean",
    "head_center",
    "head_height",
    "strand_size",
    "light_direction",
    "light_distance",
    "view_direction",
    "across",
    "material_normal",
    "unit",
    "normal",
    "clump_radius",
    "clump_color",
    "clump_shift",
    "gray",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_are_those_of_the_build() {
        let built: Vec<_> = effects_build::INPUTS
            .iter()
            .map(|input| input.name)
            .collect();
        assert_eq!(NAMES, built);
    }

    #[test]
    fn sets() {
        let set = InputSet::of(&["gray", "u"]).union(InputSet::of(&["strand"]));
        assert!(set.has("gray") && set.has("u") && set.has("strand"));
        assert!(!set.has("normal") && !set.has("nonsense"));
    }
}
