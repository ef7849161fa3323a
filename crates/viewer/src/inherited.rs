//! What a preset's base says where the preset says nothing: controls show it, and an edit writes only what is otherwise.

use effects::preset::LayerSpec;
use effects::preset::edit::written;
use effects::section::Section;
use effects::{AnyEffect, BrushSection};
use effects::{Param, ParamKind, Value};
use stage::{Preset, Sections};

/// Parameters by name, each with its value's text.
pub type Texts = Vec<(&'static str, String)>;

/// All that a preset's base says. Nothing of a preset that has none.
#[derive(Clone, Debug, Default)]
pub struct Inherited {
    sections: Vec<(&'static str, Texts)>,
    /// The base's layers, in its order.
    pub layers: Vec<InheritedLayer>,
}

/// A layer of the base.
#[derive(Clone, Debug)]
pub struct InheritedLayer {
    /// Its name.
    pub name: String,
    /// Its effect's id.
    pub effect: &'static str,
    /// What it says beside its effect's parameters.
    pub own: Texts,
    /// What its strokes are drawn with.
    pub brush: Texts,
    /// Its effect's parameters.
    pub params: Texts,
}

impl Inherited {
    /// What is said below `preset`, read together with its base. Where the preset says something itself it is that, and nobody
    /// asks for it.
    #[must_use]
    pub fn below(preset: &Preset) -> Self {
        if preset.bases().is_empty() {
            return Self::default();
        }
        let mut sections = preset.sections.clone();
        let mut all = Vec::new();
        for (name, _, table) in Sections::ALL {
            let section = sections.by_name(name);
            all.extend(section.map(|section| (*name, texts(table, section))));
        }
        Self {
            sections: all,
            layers: preset.layers.iter().map(InheritedLayer::of).collect(),
        }
    }

    /// What it says of a section.
    #[must_use]
    pub fn section(&self, name: &str) -> &[(&'static str, String)] {
        let section = self.sections.iter().find(|(section, _)| *section == name);
        section.map_or(&[], |(_, texts)| texts)
    }

    /// Its layer of that name.
    #[must_use]
    pub fn layer(&self, name: &str) -> Option<&InheritedLayer> {
        self.layers.iter().find(|layer| layer.name == name)
    }
}

impl InheritedLayer {
    fn of(layer: &LayerSpec) -> Self {
        let text = |text: &str| written(&Value::Text(Some(text.to_owned())), &ParamKind::Text);
        let mut own = vec![
            ("rank", layer.rank.to_string()),
            ("depth_offset", layer.depth_offset.to_string()),
            ("units", layer.units.name().to_owned()),
        ];
        own.extend(layer.zones.as_deref().map(|zones| ("zones", text(zones))));
        own.extend(layer.on.as_deref().map(|on| ("on", text(on))));
        own.push(("through_hair", layer.through_hair.to_string()));
        if let Some(clip) = &layer.clip {
            own.extend([("clip", text(clip)), ("reach", layer.reach.to_string())]);
        }
        Self {
            name: layer.name.clone(),
            effect: AnyEffect::id(layer.effect),
            own,
            brush: texts(BrushSection::TABLE, &layer.brush),
            params: texts(layer.effect.params(), &layer.values),
        }
    }
}

fn texts(table: &'static [Param], section: &dyn Section) -> Texts {
    let text = |(index, param): (usize, &Param)| {
        let value = section.get(index)?;
        // An empty text is none.
        let is_said = value != Value::Text(None);
        is_said.then(|| (param.name, written(&value, &param.kind)))
    };
    table.iter().enumerate().filter_map(text).collect()
}
