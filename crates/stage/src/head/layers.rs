//! Which layers for meshes paint what of a head, by names.

use super::HeadModel;
use crate::files::StageError;
use crate::names::Names;
use effects::Layer;
use effects::preset::{LayerSpec, PresetError, PresetErrors, suggestion};
use groom::FacePart;

/// What of heads has a name without a file: the skin in the preset's colours, the clothes of figures, what hair wears.
pub(super) const SKIN: &str = "skin";
pub(super) const DRESS: &str = "dress";
pub(super) const TIES: &str = "ties";

/// The name of a drawn face's part.
pub(super) fn name_of(part: FacePart) -> &'static str {
    match part {
        FacePart::Eyes => "eyes",
        FacePart::Brows => "brows",
        FacePart::Mouth => "mouth",
        FacePart::Blush => "blush",
        FacePart::Lines => "lines",
    }
}

/// A look's layers for meshes.
pub(crate) struct MeshLayers<'a> {
    layers: &'a [Layer],
    /// How many there are before these in the frame.
    first: u32,
}

impl<'a> MeshLayers<'a> {
    pub fn new(layers: &'a [Layer], first: usize) -> Self {
        Self {
            layers,
            first: first as u32,
        }
    }

    /// The layer that paints what has one of these names: the last that means it.
    pub(super) fn of(&self, names: &[impl AsRef<str>]) -> Option<u32> {
        let paints = |layer: &Layer| {
            let on = Names(layer.on.as_deref().unwrap_or_default());
            names.iter().any(|name| on.have(name.as_ref()))
        };
        let layer = self.layers.iter().rposition(paints)?;
        Some(self.first + layer as u32)
    }
}

impl HeadModel {
    /// The names of what can be painted.
    fn paintable(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        if !self.is_painted() {
            names.push(SKIN);
        }
        if !self.clothes.is_empty() {
            names.push(DRESS);
        }
        names.extend(self.patches.iter().map(|patch| name_of(patch.part)));
        let painted = self.painted.iter().flat_map(|mesh| &mesh.names);
        names.extend(painted.map(String::as_str));
        names.sort_unstable();
        names.dedup();
        names
    }
}

/// That the meshes which layers name are there. A head that the caller gave in place of the preset's may lack them: that is noted.
///
/// # Errors
///
/// Names of which there is no mesh.
pub(crate) fn check(
    layers: &[LayerSpec],
    head: Option<&HeadModel>,
    wears_ties: bool,
    is_given: bool,
    notes: &mut Vec<String>,
) -> Result<(), StageError> {
    let mut mistakes = Vec::new();
    for layer in layers.iter().filter(|layer| layer.effect.is_for_meshes()) {
        let mut known = head.map_or(Vec::new(), HeadModel::paintable);
        if wears_ties {
            known.push(TIES);
        }
        let names = Names(layer.on.as_deref().unwrap_or_default());
        // Hair and faces that may be others by the style and the preset's own words.
        let may_lack = ["eyes", "brows", "mouth", "blush", "lines", TIES, DRESS];
        let all = || known.iter().copied().chain(may_lack);
        let message = match names.unknown(all) {
            _ if names.is_empty() => "on: it names no mesh".to_owned(),
            None => continue,
            Some(name) => {
                let hint = suggestion(name, known.iter().copied());
                format!("on: there is no mesh `{name:.40}` to be painted{hint}")
            }
        };
        match &layer.on_place {
            _ if is_given => notes.push(format!("{}.{message}", layer.name)),
            Some(place) => mistakes.push(PresetError {
                place: place.clone(),
                message,
            }),
            None => {
                let layer = layer.name.clone();
                return Err(StageError::MeshLayer { layer, message });
            }
        }
    }
    Ok(PresetErrors::report(mistakes)?)
}
