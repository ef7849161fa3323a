//! Which layers are looked at: a state of the viewer, not of the preset.

use std::collections::BTreeSet;

/// Layers that are switched off, and those that are looked at alone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LayersShown {
    /// Names of those that are off.
    pub hidden: BTreeSet<String>,
    /// Names of those that are looked at alone; where there are none, all that are on are shown.
    pub solo: BTreeSet<String>,
}

impl LayersShown {
    /// Forgets the layers that a preset with these no more has.
    pub fn forget_others(&mut self, names: &BTreeSet<&str>) {
        for known in [&mut self.hidden, &mut self.solo] {
            known.retain(|name| names.contains(name.as_str()));
        }
    }

    /// Whether the layer of that name is drawn.
    #[must_use]
    pub fn is_shown(&self, layer: &str) -> bool {
        match self.solo.is_empty() {
            true => !self.hidden.contains(layer),
            false => self.solo.contains(layer),
        }
    }
}
