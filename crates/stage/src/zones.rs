//! Layers that draw on the hair of some zones of its style alone.

use crate::files::StageError;
use crate::hair::HairModel;
use crate::look::Look;
use crate::names::{Names, is_meant};
use effects::preset::{LayerSpec, PresetError, PresetErrors, suggestion};

/// How many of a look's layers, the first ones, may say their zones: `StrandInfo::left_out_by` has a bit for each.
const MOST_LAYERS: usize = u32::BITS as usize;

/// For each strand of the hair the layers that leave it out; nothing where none does. Hair without zones is drawn whole.
pub(crate) fn left_out_by(hair: &HairModel, look: &Look) -> Vec<u32> {
    let said = look.layers.iter().take(MOST_LAYERS).enumerate();
    let said = said.filter_map(|(layer, of)| Some((layer, Names(of.zones.as_deref()?))));
    let said: Vec<(usize, Names)> = said.filter(|(_, names)| !names.is_empty()).collect();
    if said.is_empty() || hair.zone_names.is_empty() {
        return Vec::new();
    }
    let of_strand = |id: u32| {
        let zone = hair.zone_name(id);
        let draws = |names: &Names| zone.is_some_and(|zone| names.have(zone));
        let left_out = said.iter().filter(|(_, names)| !draws(names));
        left_out.fold(0, |bits, (layer, _)| bits | 1 << layer)
    };
    hair.infos.iter().map(|info| of_strand(info.id)).collect()
}

/// That the zones which layers name are there. Hair that the caller gave or set in place of the preset's may lack them, and hair without
/// a style has none: that is noted.
///
/// # Errors
///
/// Names of which the preset's own style has no zone, and zones of layers behind the 32nd of those that draw strokes.
pub(crate) fn check(
    layers: &[LayerSpec],
    (hair, look): (&HairModel, &Look),
    is_given: bool,
    notes: &mut Vec<String>,
) -> Result<(), StageError> {
    let mut mistakes = Vec::new();
    let strokes = layers.iter().filter(|layer| !layer.effect.is_for_meshes());
    for layer in strokes {
        // Those of lines and those that draw nothing aren't counted.
        let number = look.layers.iter().position(|of| of.name == layer.name);
        for message in faults(number, layer, hair) {
            match &layer.zones_place {
                _ if is_given || hair.zone_names.is_empty() => {
                    notes.push(format!("{}.zones: {message}", layer.name));
                }
                Some(place) => mistakes.push(PresetError {
                    place: place.clone(),
                    message,
                }),
                None => {
                    let layer = layer.name.clone();
                    return Err(StageError::Zones { layer, message });
                }
            }
        }
    }
    Ok(PresetErrors::report(mistakes)?)
}

/// What is wrong with the zones of one layer, which has that number among those that draw strokes.
fn faults(number: Option<usize>, layer: &LayerSpec, hair: &HairModel) -> Vec<String> {
    let names = Names(layer.zones.as_deref().unwrap_or_default());
    if names.is_empty() {
        return Vec::new();
    }
    if number.is_some_and(|number| number >= MOST_LAYERS) {
        return vec![format!(
            "only the first {MOST_LAYERS} layers may say their zones: this one draws on all hair"
        )];
    }
    if hair.zone_names.is_empty() {
        return vec!["this hair has none, so that the layer draws on all of it".to_owned()];
    }
    let zones = || hair.zone_names.iter().map(String::as_str);
    let unknown = |name: &&str| !zones().any(|zone| is_meant(name, zone));
    let fault = |name: &str| {
        let hint = suggestion(name, zones());
        format!("the hair's style has no zone `{name:.40}`{hint}")
    };
    names.iter().filter(unknown).map(fault).collect()
}
