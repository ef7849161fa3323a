//! Which layers for meshes paint what of a head, and which strokes are drawn on it, by names.

use super::HeadModel;
use crate::files::StageError;
use crate::names::{Names, meant_name};
use effects::Layer;
use effects::preset::{LayerSpec, PresetError, PresetErrors};
use groom::FacePart;
use render::Decal;

/// What of heads has a name without a file: the skin in the preset's colours, the clothes of figures, what hair wears.
pub(crate) const SKIN: &str = "skin";
pub(crate) const DRESS: &str = "dress";
pub(crate) const TIES: &str = "ties";

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

/// What a layer's `clip` calls hair, and all that isn't hair.
const HAIR: &str = "hair";
const HEAD: &str = "head";

/// How many different texts the layers of a scene may have as their `clip`: a mark each.
const MOST_CLIPS: usize = u32::BITS as usize;

/// What layers of a scene with `clip` are drawn on, each text once: a decal has the mark of its own, and a surface those that mean it.
#[derive(Default)]
pub(crate) struct Clips<'a>(Vec<&'a str>);

impl<'a> Clips<'a> {
    /// Those of a scene.
    ///
    /// # Errors
    ///
    /// When there are too many.
    pub fn of(layers: impl Iterator<Item = &'a Layer>) -> Result<Self, StageError> {
        let mut texts: Vec<&str> = Vec::new();
        for text in layers.filter_map(|layer| layer.clip.as_deref()) {
            if !texts.contains(&text) {
                texts.push(text);
            }
        }
        match texts.len() > MOST_CLIPS {
            true => Err(StageError::Clips(texts.len(), MOST_CLIPS)),
            false => Ok(Self(texts)),
        }
    }

    /// What a layer is as a decal, of an object whose head is as high; `index` is its place among the frame's layers.
    pub fn decal(&self, layer: &Layer, index: usize, head_height_m: f32) -> Option<Decal> {
        let clip = layer.clip.as_deref()?;
        let mark = self.0.iter().position(|text| *text == clip)?;
        Some(Decal {
            layer: index,
            on_hair: Names(clip).have(HAIR),
            marks: 1 << mark,
            reach_m: layer.reach * head_height_m,
            is_shadow: layer.program.casts(),
        })
    }

    /// The marks of what has one of these names.
    fn marks(&self, names: &[impl AsRef<str>]) -> u32 {
        let is_meant = |clip: &str| {
            let clip = Names(clip);
            clip.have(HEAD) || names.iter().any(|name| clip.have(name.as_ref()))
        };
        let texts = self.0.iter().enumerate();
        let meant = texts.filter(|(_, text)| is_meant(text));
        meant.fold(0, |marks, (mark, _)| marks | 1 << mark)
    }
}

/// A look's layers for meshes, and what is drawn on them.
pub(crate) struct MeshLayers<'a> {
    layers: &'a [Layer],
    /// How many there are before these in the frame.
    first: u32,
    clips: &'a Clips<'a>,
}

impl<'a> MeshLayers<'a> {
    pub fn new(layers: &'a [Layer], first: usize, clips: &'a Clips<'a>) -> Self {
        Self {
            layers,
            first: first as u32,
            clips,
        }
    }

    /// The marks of what has one of these names: what decals are drawn on.
    pub(super) fn marks(&self, names: &[impl AsRef<str>]) -> u32 {
        self.clips.marks(names)
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
        if !self.is_painted() && !self.is_things {
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

/// That the meshes which layers name are there, to be painted or drawn on. A head that the caller gave in place of the preset's may lack them: that is noted.
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
    for layer in layers {
        let mut known = head.map_or(Vec::new(), HeadModel::paintable);
        if wears_ties {
            known.push(TIES);
        }
        let is_for_meshes = layer.effect.is_for_meshes();
        let (said, place) = match is_for_meshes {
            true => (
                Some(layer.on.as_deref().unwrap_or_default()),
                &layer.on_place,
            ),
            false => (layer.clip.as_deref(), &layer.clip_place),
        };
        let Some(said) = said else {
            continue;
        };
        if !is_for_meshes {
            known.extend([HAIR, HEAD]);
        }
        let names = Names(said);
        // Hair and faces that may be others by the style and the preset's own words.
        let may_lack = ["eyes", "brows", "mouth", "blush", "lines", TIES, DRESS];
        let all = || known.iter().copied().chain(may_lack);
        let (field, use_of_it) = match is_for_meshes {
            true => ("on", "painted"),
            false => ("clip", "drawn on"),
        };
        let message = match names.unknown(all) {
            _ if names.is_empty() => format!("{field}: it names no mesh"),
            None => continue,
            Some(name) => {
                let hint = meant_name(name, known.iter().copied());
                format!("{field}: there is no mesh `{name:.40}` to be {use_of_it}{hint}")
            }
        };
        match place {
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
