//! The layers of a preset.

use super::error::{Place, suggestion};
use super::reader::{Field, Reader};
use super::set::{SetError, set_text, unknown};
use super::value::{parse_value, shown};
use crate::brush::{BrushSection, BrushTexture};
use crate::effect::AnyEffect;
use crate::layer::{Layer, Units};
use crate::param::{Param, ParamKind, Value, Values};
use crate::registry::Registry;
use crate::section;
use crate::texture::Texture;
use std::collections::HashSet;
use std::sync::Arc;

section! {
    /// What a layer may say, beside the effect's own parameters.
    struct LayerFields {
        /// The effect's id, such as "hair.base"; every layer has one.
        effect: Option<String> = text(),
        /// A name for `--set` and `--only`, unique in the preset; the effect's id by default.
        name: Option<String> = text(),
        /// Drawing order within a strand, low first; the base stroke is 0. The effect's own by default.
        rank: Option<i32> = integer(0, -10_000..=10_000).optional(),
        /// How much farther from the eye the strokes are than their strand. The effect's own by default.
        depth_offset: Option<f32> = number(0.0, -10.0..=10.0).unit("head heights").optional(),
        /// What widths are measured in: 1/300 of the head's height in the world, or pixels at 720 lines.
        units: Units = Units::World.or_another(),
        /// The zones of the hair's style that it draws on: their names with commas between them, `*` for any end, such as "fringe, tail*".
        /// Without it all hair.
        zones: Option<String> = text(),
        /// Of effects for lines: which of the preset's `lines`, by their names. Of effects for meshes: what is painted, names of meshes or of their materials with commas between them, `*` for any end, such as "Face*,
        /// Body". Of the head that comes with inkstrand: skin, dress, eyes, brows, mouth, blush, lines; of the hair: ties.
        on: Option<String> = text(),
        /// Of effects for meshes: how much of it is seen through hair that hangs before it: 0 nothing, 1 as if there were no hair.
        through_hair: f32 = number(0.0, 0.0..=1.0),
        /// What its strokes are drawn on, and nowhere else: "hair", "head" (all that isn't hair), or names of meshes as for `on`, with commas
        /// between them. They lie on what is seen there without them. The effect's own by default, of most nothing.
        clip: Option<String> = text(),
        /// Of strokes with `clip`: how far what they are drawn on may be before or behind them. Of shadows (`hair.cast`) how far a mesh may be
        /// before them, and hair must be behind them. The effect's own by default.
        reach: Option<f32> = number(0.05, 0.0..=10.0).unit("head heights").optional(),
    }
}

impl LayerFields {
    /// What a layer of the base has said.
    fn of(layer: &LayerSpec) -> Self {
        Self {
            effect: Some(layer.effect.id().to_owned()),
            name: Some(layer.name.clone()),
            rank: Some(layer.rank),
            depth_offset: Some(layer.depth_offset),
            units: layer.units,
            zones: layer.zones.clone(),
            on: layer.on.clone(),
            through_hair: layer.through_hair,
            clip: layer.clip.clone(),
            reach: Some(layer.reach),
        }
    }
}

/// What a layer may say, beside the effect's own parameters.
pub const LAYER: &[Param] = LayerFields::TABLE;

/// What of [`LAYER`] is the effect's own where the layer says nothing, in place of the table's default.
pub const OF_THE_EFFECT: &[&str] = &["name", "rank", "depth_offset", "clip", "reach"];

/// A layer as the preset describes it.
pub struct LayerSpec<'r> {
    /// Unique in the preset.
    pub name: String,
    /// Where the file describes it, or says last what of it is otherwise.
    pub place: Place,
    /// The effect.
    pub effect: &'r dyn AnyEffect,
    /// Drawing order within a strand.
    pub rank: i32,
    /// Depth offset in head heights.
    pub depth_offset: f32,
    /// What widths are measured in.
    pub units: Units,
    /// The zones of a hair style whose hair it draws; all hair where it says nothing.
    pub zones: Option<String>,
    /// Where the file says them.
    pub zones_place: Option<Place>,
    /// The meshes that it paints, of an effect for meshes; the lines that it draws, of one for lines.
    pub on: Option<String>,
    /// Where the file says them.
    pub on_place: Option<Place>,
    /// How much of what it paints is seen through hair, 0 to 1.
    pub through_hair: f32,
    /// What its strokes are drawn on, if they are decals.
    pub clip: Option<String>,
    /// Where the file says it.
    pub clip_place: Option<Place>,
    /// How far before or behind its strokes decals are drawn on that, head heights.
    pub reach: f32,
    /// What its strokes are drawn with.
    pub brush: BrushSection,
    /// Where the file names the brush's texture.
    pub brush_place: Option<Place>,
    /// The effect's parameters.
    pub values: Values,
    /// Where the file names its textures' files: their parameters, and the place of each value.
    pub textures: Vec<(&'static str, Place)>,
}

impl LayerSpec<'_> {
    /// Sets one parameter of the effect, or one of the layer's own, such as `rank`, from its text, as `--set` gives it.
    ///
    /// # Errors
    ///
    /// When there is no such parameter, or the text is not one of its values.
    pub fn set(&mut self, param: &str, text: &str) -> Result<(), SetError> {
        let own = [
            "rank",
            "depth_offset",
            "units",
            "zones",
            "on",
            "through_hair",
            "clip",
            "reach",
        ];
        // What the file says is no longer what is meant.
        self.textures.retain(|(name, _)| *name != param);
        let is_own = own.contains(&param) && self.effect.params().iter().all(|p| p.name != param);
        if !is_own {
            return set_text(&mut self.values, &self.name, param, text);
        }
        if let Some(message) = misfit(self.effect, param) {
            return Err(SetError::Unknown(message));
        }
        let mut fields = LayerFields {
            units: self.units,
            zones: self.zones.clone(),
            on: self.on.clone(),
            through_hair: self.through_hair,
            clip: self.clip.clone(),
            ..LayerFields::default()
        };
        set_text(&mut fields, &self.name, param, text)?;
        self.rank = fields.rank.unwrap_or(self.rank);
        self.depth_offset = fields.depth_offset.unwrap_or(self.depth_offset);
        self.units = fields.units;
        if param == "zones" {
            self.zones_place = None;
        }
        self.zones = fields.zones;
        if param == "on" {
            self.on_place = None;
        }
        self.on = fields.on;
        self.through_hair = fields.through_hair;
        if param == "clip" {
            self.clip_place = None;
        }
        self.clip = clip_of(self.effect, fields.clip);
        self.reach = fields.reach.unwrap_or(self.reach);
        Ok(())
    }

    /// Sets one parameter of its brush from its text.
    ///
    /// # Errors
    ///
    /// When there is no such parameter, or the text is not one of its values; or its effect draws no strokes.
    pub fn set_brush(&mut self, param: &str, text: &str) -> Result<(), SetError> {
        if let Some(message) = misfit(self.effect, "brush") {
            return Err(SetError::Unknown(message));
        }
        if param == "texture" {
            self.brush_place = None;
        }
        set_text(
            &mut self.brush,
            &format!("{}.brush", self.name),
            param,
            text,
        )
    }

    /// The layer, ready to be evaluated; with nothing in place of textures' files.
    #[must_use]
    pub fn build(&self) -> Layer {
        let brush = BrushTexture::of_tool(&self.brush);
        self.build_with(&self.values, brush.map(Arc::new))
    }

    /// The layer with other values than its own, such as those with pictures in place of their files' names, and with this for its brush.
    #[must_use]
    pub fn build_with(&self, values: &Values, brush: Option<Arc<BrushTexture>>) -> Layer {
        Layer {
            name: self.name.clone(),
            effect: self.effect.id(),
            rank: self.rank,
            depth_offset: self.depth_offset,
            units: self.units,
            zones: self.zones.clone(),
            on: self.on.clone(),
            through_hair: self.through_hair,
            clip: self.clip.clone(),
            reach: self.reach,
            brush,
            program: self.effect.program(values).into(),
        }
    }
}

impl<'a> Reader<'a> {
    /// Reads the list of layers, each by the effect that owns it. Mistakes are noted; a layer must not
    /// have one of the `reserved` names, those of sections.
    pub fn layers<'r>(
        &mut self,
        list: &'a str,
        registry: &'r Registry,
        reserved: &[&str],
    ) -> Vec<LayerSpec<'r>> {
        self.layers_on(list, registry, reserved, Vec::new())
    }

    /// As [`Self::layers`], of a preset that builds on another one, whose layers are `base`: an item with the name of one of them says
    /// what of it is otherwise, and needs no `effect`; one that names another effect takes its place. Others come after them.
    pub fn layers_on<'r>(
        &mut self,
        list: &'a str,
        registry: &'r Registry,
        reserved: &[&str],
        base: Vec<LayerSpec<'r>>,
    ) -> Vec<LayerSpec<'r>> {
        let mut layers = base;
        let of_base = layers.len();
        let mut names = HashSet::new();
        for item in self.list(list, "layers") {
            let Some(layer) = self.layer(item, registry, &layers[..of_base]) else {
                continue;
            };
            let changed = layers[..of_base]
                .iter()
                .position(|other| other.name == layer.name);
            if reserved.contains(&layer.name.as_str()) {
                self.error(
                    item,
                    format!(
                        "`{}` is a section's name; give this layer another",
                        shown(&layer.name)
                    ),
                );
            } else if !names.insert(layer.name.clone()) {
                self.error(
                    item,
                    format!(
                        "there is already a layer `{}`; give this one a `name`",
                        shown(&layer.name)
                    ),
                );
            } else if let Some(index) = changed {
                layers[index] = layer;
            } else {
                layers.push(layer);
            }
        }
        layers
    }

    fn layer<'r>(
        &mut self,
        item: &'a str,
        registry: &'r Registry,
        base: &[LayerSpec<'r>],
    ) -> Option<LayerSpec<'r>> {
        if !item.starts_with('(') {
            let found = shown(item);
            let message =
                format!("a layer is written (effect: \"hair.base\", ...), found `{found}`");
            self.error(item, message);
            return None;
        }
        let (sections, own): (Vec<Field>, Vec<Field>) = self
            .fields(item, "a layer")
            .into_iter()
            .partition(|field| ["params", "brush"].contains(&field.name));
        let section = |name: &str| sections.iter().find(|field| field.name == name).copied();
        let effect = self.effect(item, &own, registry, base);
        let changed = effect.and_then(|effect| {
            let name = named(&own).unwrap_or_else(|| effect.id().to_owned());
            let is_it = |layer: &&LayerSpec| layer.name == name && layer.effect.id() == effect.id();
            base.iter().find(is_it)
        });
        let table = effect.map_or(&[][..], AnyEffect::params);
        let mut layer = changed.map_or_else(LayerFields::default, LayerFields::of);
        self.fill_or(&own, &mut layer, |field| {
            let name = field.name;
            if has(table, name) {
                let value = shown(field.value);
                return format!("`{name}` belongs to the effect: params: ({name}: {value})");
            }
            let names = LAYER
                .iter()
                .map(|param| param.name)
                .chain(["params", "brush"]);
            format!(
                "a layer has no `{}`{}",
                shown(name),
                suggestion(name, names)
            )
        });
        let effect = effect?;
        for field in own.iter().chain(&section("brush")) {
            if let Some(message) = misfit(effect, field.name) {
                self.error(field.name, message);
            }
        }
        let says_on = layer.on.is_some() || own.iter().any(|field| field.name == "on");
        if !says_on && let Some(message) = needs_on(effect) {
            self.error(item, message);
        }
        let clip = clip_of(effect, layer.clip);
        let reach = own.iter().find(|field| field.name == "reach");
        if let Some(field) = reach.filter(|_| clip.is_none()) {
            let message = "`reach` is of strokes that are drawn on something: clip: \"hair\", \"head\", or names of meshes";
            self.error(field.name, message.to_owned());
        }
        let on = own.iter().find(|field| field.name == "on");
        let zones = own.iter().find(|field| field.name == "zones");
        let mut values = match changed {
            Some(changed) => changed.values.clone(),
            None => Values::defaults(effect.params()),
        };
        let mut textures = changed.map_or_else(Vec::new, |changed| changed.textures.clone());
        if let Some(field) = section("params") {
            self.params(field.value, effect, &mut values, &mut textures);
        }
        let mut brush = changed.map_or_else(BrushSection::default, |changed| changed.brush.clone());
        let mut brush_place = changed.and_then(|changed| changed.brush_place.clone());
        if let Some(field) = section("brush") {
            let fields = self.fields(field.value, "brush");
            self.fill(&fields, &mut brush, "brush");
            if let Some(field) = fields.iter().find(|field| field.name == "texture") {
                brush_place = Some(self.place(field.value));
            }
        }
        let zones_of_base = changed.and_then(|changed| changed.zones_place.clone());
        let on_of_base = changed.and_then(|changed| changed.on_place.clone());
        let clip_of_base = changed.and_then(|changed| changed.clip_place.clone());
        let clip_field = own.iter().find(|field| field.name == "clip");
        Some(LayerSpec {
            name: layer.name.unwrap_or_else(|| effect.id().to_owned()),
            place: self.place(item),
            effect,
            rank: layer.rank.unwrap_or(effect.rank()),
            depth_offset: layer.depth_offset.unwrap_or(effect.depth_offset()),
            units: layer.units,
            zones: layer.zones,
            zones_place: zones.map_or(zones_of_base, |field| Some(self.place(field.value))),
            on: layer.on,
            on_place: on.map_or(on_of_base, |field| Some(self.place(field.value))),
            through_hair: layer.through_hair,
            clip,
            clip_place: clip_field.map_or(clip_of_base, |field| Some(self.place(field.value))),
            reach: layer.reach.unwrap_or(effect.clip_reach()),
            brush,
            brush_place,
            values,
            textures,
        })
    }

    /// The effect that a layer names, or that of the layer of the base which it changes. Where its `effect` is no text, that is
    /// told with the other values.
    fn effect<'r>(
        &mut self,
        item: &'a str,
        fields: &[Field<'a>],
        registry: &'r Registry,
        base: &[LayerSpec<'r>],
    ) -> Option<&'r dyn AnyEffect> {
        let Some(field) = fields.iter().find(|field| field.name == "effect") else {
            let message = match named(fields) {
                Some(name) if !base.is_empty() => {
                    if let Some(changed) = base.iter().find(|layer| layer.name == name) {
                        return Some(changed.effect);
                    }
                    let hint = suggestion(&name, base.iter().map(|layer| layer.name.as_str()));
                    let name = shown(&name);
                    format!("a new layer needs `effect`, and the base has no layer `{name}`{hint}")
                }
                _ => "a layer needs `effect`, such as effect: \"hair.base\"".to_owned(),
            };
            self.error(item, message);
            return None;
        };
        let Ok(Value::Text(Some(id))) = parse_value(field.value, &ParamKind::Text) else {
            return None;
        };
        let effect = registry.get(&id);
        if effect.is_none() {
            let hint = suggestion(&id, registry.iter().map(AnyEffect::id));
            let id = shown(&id);
            self.error(field.value, format!("there is no effect `{id}`{hint}"));
        }
        effect
    }

    /// Sets the effect's parameters, and where textures' files are named.
    fn params(
        &mut self,
        section: &'a str,
        effect: &dyn AnyEffect,
        values: &mut Values,
        textures: &mut Vec<(&'static str, Place)>,
    ) {
        let fields = self.fields(section, effect.id());
        self.fill_or(&fields, values, |field| {
            if has(LAYER, field.name) {
                format!("`{}` belongs to the layer, outside of `params`", field.name)
            } else {
                unknown(field.name, effect.params(), effect.id())
            }
        });
        textures.retain(|(name, _)| fields.iter().all(|field| field.name != *name));
        textures.extend(effect.params().iter().filter_map(|param| {
            let field = fields.iter().find(|field| field.name == param.name)?;
            let is_file = matches!(values.value(param.name), Value::Texture(Texture::File(_)));
            is_file.then(|| (param.name, self.place(field.value)))
        }));
    }
}

/// The name that a layer gives itself.
fn named(fields: &[Field]) -> Option<String> {
    let field = fields.iter().find(|field| field.name == "name")?;
    match parse_value(field.value, &ParamKind::Text) {
        Ok(Value::Text(name)) => name,
        _ => None,
    }
}

/// What strokes of a layer that says this are drawn on.
fn clip_of(effect: &dyn AnyEffect, said: Option<String>) -> Option<String> {
    let said = said.filter(|names| !names.trim().is_empty());
    said.or_else(|| effect.clip().map(str::to_owned))
}

/// Whether a layer of this effect may say this field of [`LAYER`].
#[must_use]
pub fn may_say(effect: &dyn AnyEffect, field: &str) -> bool {
    misfit(effect, field).is_none()
}

/// What is missing in a layer of this effect that doesn't say what it is on, if it must.
fn needs_on(effect: &dyn AnyEffect) -> Option<String> {
    let id = effect.id();
    if effect.is_for_meshes() {
        return Some(format!(
            "`{id}` paints meshes, and the layer doesn't say which: on: \"skin, dress\", the names of a file's meshes, or \"*\" for all"
        ));
    }
    effect.is_for_lines().then(|| {
        format!(
            "`{id}` draws lines, and the layer doesn't say which: on: \"rim\", a name of the preset's lines: [(name: \"rim\", of: \"skin, dress\")]"
        )
    })
}

/// Why a layer of this effect can't say that.
fn misfit(effect: &dyn AnyEffect, param: &str) -> Option<String> {
    let id = effect.id();
    let of_strokes = [
        "rank",
        "depth_offset",
        "units",
        "zones",
        "clip",
        "reach",
        "brush",
    ];
    let of_decals = ["clip", "reach"];
    let of_surfaces = ["on", "through_hair"];
    let not_of_lines = ["zones", "through_hair", "clip", "reach"];
    if effect.params().iter().any(|own| own.name == param) {
        return None;
    }
    if effect.is_for_lines() {
        let message = || format!("`{param}` is not of lines, which `{id}` draws");
        return not_of_lines.contains(&param).then(message);
    }
    match effect.is_for_meshes() {
        true if of_strokes.contains(&param) => {
            Some(format!("`{param}` is of strokes, and `{id}` paints meshes"))
        }
        false if of_surfaces.contains(&param) => Some(format!(
            "`{param}` is of effects for meshes, such as `mesh.toon`; `{id}` draws strokes of hair"
        )),
        false if of_decals.contains(&param) && effect.paints().is_some() => Some(format!(
            "`{param}` is of strokes in colours of their own, and `{id}` paints each sample"
        )),
        _ => None,
    }
}

fn has(table: &[Param], name: &str) -> bool {
    table.iter().any(|param| param.name == name)
}
