//! The layers of a preset.

use super::error::suggestion;
use super::reader::{Field, Reader};
use super::value::{parse_value, shown};
use crate::effect::AnyEffect;
use crate::layer::{Layer, Units};
use crate::param::{Param, ParamKind, Values};
use crate::registry::Registry;

/// What a layer may say, beside the effect's own parameters.
pub const LAYER: &[Param] = &[
    Param {
        name: "effect",
        doc: "The effect's id, such as \"hair.base\"; every layer has one.",
        unit: "",
        kind: ParamKind::Text,
    },
    Param {
        name: "name",
        doc: "A name for `--set` and `--only`, unique in the preset; the effect's id by default.",
        unit: "",
        kind: ParamKind::Text,
    },
    Param {
        name: "rank",
        doc: "Drawing order within a strand, low first; the base stroke is 0. The effect's own by default.",
        unit: "",
        kind: ParamKind::Integer {
            min: -10_000,
            max: 10_000,
            default: 0,
        },
    },
    Param {
        name: "depth_offset",
        doc: "How much farther from the eye the strokes are than their strand. The effect's own by default.",
        unit: "head heights",
        kind: ParamKind::Number {
            min: -10.0,
            max: 10.0,
            default: 0.0,
        },
    },
    Param {
        name: "units",
        doc: "What widths are measured in: 1/300 of the head's height in the world, or pixels at 720 lines.",
        unit: "",
        kind: ParamKind::Choice {
            names: &["world", "pixels"],
            default: 0,
        },
    },
];

/// What of [`LAYER`] is the effect's own where the layer says nothing, in place of the table's default.
pub const OF_THE_EFFECT: &[&str] = &["name", "rank", "depth_offset"];

/// A layer as the preset describes it.
pub struct LayerSpec<'r> {
    /// Unique in the preset.
    pub name: String,
    /// The effect.
    pub effect: &'r dyn AnyEffect,
    /// Drawing order within a strand.
    pub rank: i32,
    /// Depth offset in head heights.
    pub depth_offset: f32,
    /// What widths are measured in.
    pub units: Units,
    /// The effect's parameters.
    pub values: Values,
}

impl LayerSpec<'_> {
    /// Sets one parameter from its text, as `--set` gives it.
    ///
    /// # Errors
    ///
    /// When there is no such parameter, or the text is not one of its values.
    pub fn set(&mut self, param: &str, text: &str) -> Result<(), String> {
        set_value(&mut self.values, &self.name, param, text)
    }

    /// The layer, ready to be evaluated.
    #[must_use]
    pub fn build(&self) -> Layer {
        Layer {
            name: self.name.clone(),
            effect: self.effect.id(),
            rank: self.rank,
            depth_offset: self.depth_offset,
            units: self.units,
            program: self.effect.program(&self.values),
        }
    }
}

/// Sets parameter `param` of a section called `what` from its text. A colour may lack its quotes.
///
/// # Errors
///
/// When there is no such parameter, or the text is not one of its values.
pub(crate) fn set_value(
    values: &mut Values,
    what: &str,
    param: &str,
    text: &str,
) -> Result<(), String> {
    let table = values.table();
    let Some(index) = table.iter().position(|p| p.name == param) else {
        let hint = suggestion(param, table.iter().map(|p| p.name));
        return Err(format!("{what} has no `{param}`{hint}"));
    };
    let kind = &table[index].kind;
    let value = parse_value(text, kind)
        .or_else(|message| parse_value(&format!("\"{text}\""), kind).map_err(|_| message))
        .map_err(|message| format!("{what}.{param}: {message}"))?;
    values.set(index, value);
    Ok(())
}

impl Values {
    /// Sets a parameter from its text, as `--set` gives it. `what` names the section in messages.
    ///
    /// # Errors
    ///
    /// When there is no such parameter, or the text is not one of its values.
    pub fn set_text(&mut self, what: &str, param: &str, text: &str) -> Result<(), String> {
        set_value(self, what, param, text)
    }
}

impl<'a> Reader<'a> {
    /// Reads the list of layers, each by the effect that owns it. Mistakes are noted.
    pub fn layers<'r>(&mut self, list: &'a str, registry: &'r Registry) -> Vec<LayerSpec<'r>> {
        let mut layers: Vec<LayerSpec<'r>> = Vec::new();
        for item in self.list(list, "layers") {
            let Some(layer) = self.layer(item, registry) else {
                continue;
            };
            if layers.iter().any(|other| other.name == layer.name) {
                self.error(
                    item,
                    format!(
                        "there is already a layer `{}`; give this one a `name`",
                        layer.name
                    ),
                );
            } else {
                layers.push(layer);
            }
        }
        layers
    }

    fn layer<'r>(&mut self, item: &'a str, registry: &'r Registry) -> Option<LayerSpec<'r>> {
        if !item.starts_with('(') {
            let found = shown(item);
            let message =
                format!("a layer is written (effect: \"hair.base\", ...), found `{found}`");
            self.error(item, message);
            return None;
        }
        let fields = self.fields(item, "a layer");
        let (params, mut own): (Vec<Field>, Vec<Field>) =
            fields.into_iter().partition(|field| field.name == "params");
        let effect = own.iter().find(|field| field.name == "effect");
        let table = effect
            .and_then(|field| ron::from_str::<String>(field.value).ok())
            .and_then(|id| registry.get(&id))
            .map_or(&[][..], AnyEffect::params);
        own.retain(|field| {
            let known = LAYER.iter().any(|param| param.name == field.name);
            if !known {
                self.unknown_field(field, table);
            }
            known
        });
        let layer = self.values(&own, LAYER, "a layer");
        let Some(id) = layer.text("effect") else {
            if own.iter().all(|field| field.name != "effect") {
                self.error(
                    item,
                    "a layer needs `effect`, such as effect: \"hair.base\"",
                );
            }
            return None;
        };
        let Some(effect) = registry.get(id) else {
            let value = own
                .iter()
                .find(|f| f.name == "effect")
                .map_or(item, |f| f.value);
            let hint = suggestion(id, registry.iter().map(AnyEffect::id));
            self.error(value, format!("there is no effect `{id}`{hint}"));
            return None;
        };
        let values = match params.first() {
            Some(field) => {
                let mut fields = self.fields(field.value, id);
                fields.retain(|field| {
                    let owned = effect.params().iter().any(|param| param.name == field.name);
                    let misplaced = !owned && LAYER.iter().any(|param| param.name == field.name);
                    if misplaced {
                        let name = field.name;
                        let message = format!("`{name}` belongs to the layer, outside of `params`");
                        self.error(name, message);
                    }
                    !misplaced
                });
                self.values(&fields, effect.params(), id)
            }
            None => Values::defaults(effect.params()),
        };
        Some(LayerSpec {
            name: layer.text("name").unwrap_or(id).to_owned(),
            effect,
            rank: if layer.is_given("rank") {
                layer.integer("rank")
            } else {
                effect.rank()
            },
            depth_offset: if layer.is_given("depth_offset") {
                layer.number("depth_offset")
            } else {
                effect.depth_offset()
            },
            units: [Units::World, Units::Pixels][layer.choice("units") as usize],
            values,
        })
    }

    /// A field that no layer has: perhaps one of the effect's parameters, whose table this is.
    fn unknown_field(&mut self, field: &Field, table: &[Param]) {
        let name = field.name;
        let message = if table.iter().any(|param| param.name == name) {
            format!(
                "`{name}` belongs to the effect: params: ({name}: {})",
                shown(field.value)
            )
        } else {
            let names = LAYER.iter().map(|param| param.name).chain(["params"]);
            format!("a layer has no `{name}`{}", suggestion(name, names))
        };
        self.error(name, message);
    }
}
