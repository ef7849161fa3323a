//! Presets: one RON file that says what is drawn and how.

use effects::preset::{Field, LayerSpec, PresetErrors, Reader};
use effects::{Param, ParamKind, Parameters, Registry, Values, clump};

/// The newest version of presets that this build reads.
pub const VERSION: i32 = 1;

const fn number(
    name: &'static str,
    doc: &'static str,
    unit: &'static str,
    range: std::ops::RangeInclusive<f32>,
    default: f32,
) -> Param {
    let kind = ParamKind::Number {
        min: *range.start(),
        max: *range.end(),
        default,
    };
    Param {
        name,
        doc,
        unit,
        kind,
    }
}

const fn param(name: &'static str, doc: &'static str, kind: ParamKind) -> Param {
    Param {
        name,
        doc,
        unit: "",
        kind,
    }
}

const fn color(name: &'static str, doc: &'static str, default: &'static str) -> Param {
    param(name, doc, ParamKind::Color { default })
}

const fn choice(
    name: &'static str,
    doc: &'static str,
    names: &'static [&'static str],
    default: usize,
) -> Param {
    param(name, doc, ParamKind::Choice { names, default })
}

/// The section `hair`.
pub const HAIR: &[Param] = &[
    param(
        "file",
        "Strands to draw, relative to the preset: .tfx or .strands.ron.",
        ParamKind::Text,
    ),
    param(
        "guides",
        "How many strands to keep, spread evenly over the scalp; 0 keeps all.",
        ParamKind::Integer {
            min: 0,
            max: 1_000_000,
            default: 0,
        },
    ),
    choice("up", "The file's upward axis.", &["guess", "y", "z"], 0),
    number(
        "scale",
        "Metres in one unit of the file; 0 guesses.",
        "m",
        0.0..=1e4,
        0.0,
    ),
    number(
        "size",
        "Clump size of strands that bring none; 0 takes it from the spacing of the roots.",
        "1/300 head height",
        0.0..=300.0,
        0.0,
    ),
];

/// The section `head`.
pub const HEAD: &[Param] = &[
    param(
        "file",
        "The head, relative to the preset: .obj.",
        ParamKind::Text,
    ),
    choice("up", "The file's upward axis.", &["guess", "y", "z"], 0),
    number(
        "scale",
        "Metres in one unit of the file; 0 guesses.",
        "m",
        0.0..=1e4,
        0.0,
    ),
    color("light", "Colour of the lit side.", "F8DCC8"),
    color(
        "shadow",
        "Colour of the side away from the light.",
        "E3B49C",
    ),
    color("line", "Colour of the outline.", "6B4438"),
    number(
        "width",
        "Width of the outline; 0 is none.",
        "1/300 head height",
        0.0..=50.0,
        1.6,
    ),
    number(
        "threshold",
        "Where light turns to shadow: the cosine to the light.",
        "",
        -1.0..=1.0,
        0.1,
    ),
];

/// The section `scene`.
pub const SCENE: &[Param] = &[
    param(
        "size",
        "Width and height of the picture.",
        ParamKind::Size {
            min: 1,
            max: 16_384,
            default: [960, 720],
        },
    ),
    param(
        "samples",
        "Samples a pixel.",
        ParamKind::Integer {
            min: 1,
            max: 256,
            default: 16,
        },
    ),
    param(
        "background",
        "Colour behind everything, or none for a transparent picture.",
        ParamKind::OptionalColor {
            default: Some("FFFFFF"),
        },
    ),
    number("fps", "Frames a second.", "1/s", 1.0..=1000.0, 24.0),
    choice(
        "order",
        "Within a strand by rank, then by depth; or every stroke by its shifted depth.",
        &["strand_first", "shifted"],
        0,
    ),
];

/// The section `camera`.
pub const CAMERA: &[Param] = &[
    number(
        "yaw",
        "0 looks at the face; positive moves to the viewer's right.",
        "degrees",
        -360.0..=360.0,
        0.0,
    ),
    number(
        "pitch",
        "Positive looks from above.",
        "degrees",
        -90.0..=90.0,
        0.0,
    ),
    number(
        "distance",
        "From the target to the eye.",
        "head heights",
        0.01..=1000.0,
        4.48,
    ),
    number(
        "fov",
        "Vertical field of view.",
        "degrees",
        1.0..=150.0,
        30.0,
    ),
    Param {
        name: "target",
        doc: "What the camera looks at, from the head's centre.",
        unit: "head heights",
        kind: ParamKind::Triple {
            min: -1000.0,
            max: 1000.0,
            default: [0.0; 3],
        },
    },
];

/// The section `light`.
pub const LIGHT: &[Param] = &[
    choice(
        "kind",
        "A light from far away, or one at a place.",
        &["direction", "point"],
        0,
    ),
    choice(
        "fixed_to",
        "What the light turns with.",
        &["world", "camera"],
        0,
    ),
    number(
        "yaw",
        "0 shines at the face; positive comes from the viewer's right.",
        "degrees",
        -360.0..=360.0,
        35.0,
    ),
    number(
        "pitch",
        "Positive shines from above.",
        "degrees",
        -90.0..=90.0,
        40.0,
    ),
    number(
        "distance",
        "A point light's distance from the head's centre.",
        "head heights",
        0.01..=1000.0,
        3.0,
    ),
];

/// The section `path`.
pub const PATH: &[Param] = &[
    choice(
        "kind",
        "How particles are joined.",
        &["linear", "catmull_rom"],
        1,
    ),
    param(
        "subdivision",
        "Joints from one particle to the next.",
        ParamKind::Integer {
            min: 1,
            max: 64,
            default: 4,
        },
    ),
];

/// A preset's sections by name, with what each is about. `clump` and `layers` come from effects.
pub const SECTIONS: &[(&str, &str, &[Param])] = &[
    ("hair", "Which strands are drawn.", HAIR),
    ("head", "The head under the hair.", HEAD),
    ("scene", "The picture.", SCENE),
    ("camera", "The eye.", CAMERA),
    ("light", "The light.", LIGHT),
    ("path", "How a strand becomes a stroke's path.", PATH),
    (
        "clump",
        "What all layers share of a strand: size, normal, basic colour.",
        clump::Program::PARAMS,
    ),
];

const TOP: &[Param] = &[
    param(
        "version",
        "Version of the preset's format.",
        ParamKind::Integer {
            min: 1,
            max: VERSION,
            default: VERSION,
        },
    ),
    param(
        "seed",
        "Seed of all variations.",
        ParamKind::Integer {
            min: 0,
            max: i32::MAX,
            default: 1,
        },
    ),
];

/// A preset, read and checked.
pub struct Preset<'r> {
    /// Seed of all variations.
    pub seed: u32,
    /// Values of [`HAIR`].
    pub hair: Values,
    /// Values of [`HEAD`].
    pub head: Values,
    /// Values of [`SCENE`].
    pub scene: Values,
    /// Values of [`CAMERA`].
    pub camera: Values,
    /// Values of [`LIGHT`].
    pub light: Values,
    /// Values of [`PATH`].
    pub path: Values,
    /// Values of the clump's parameters.
    pub clump: Values,
    /// The layers, in the order of the file.
    pub layers: Vec<LayerSpec<'r>>,
}

impl<'r> Preset<'r> {
    /// Reads the preset `text`, which messages call `file`.
    ///
    /// # Errors
    ///
    /// All mistakes of the file, each with its line and column.
    pub fn parse(file: &str, text: &str, registry: &'r Registry) -> Result<Self, PresetErrors> {
        let mut reader = Reader::new(file, text);
        let fields = reader.fields(text, "the preset");
        reader.report()?;
        // Nothing else in a file of another version means what it seems to mean.
        check_version(&mut reader, &fields);
        reader.report()?;
        let sections = SECTIONS.iter().map(|(name, ..)| *name).chain(["layers"]);
        let known: Vec<&str> = TOP.iter().map(|p| p.name).chain(sections).collect();
        let (plain, other): (Vec<Field>, Vec<Field>) = fields
            .iter()
            .partition(|field| TOP.iter().any(|p| p.name == field.name));
        let top = reader.values(&plain, TOP, "the preset");
        for field in &other {
            if !known.contains(&field.name) {
                let hint = match effects::preset::nearest(field.name, known.iter().copied()) {
                    Some(name) => format!(", did you mean `{name}`?"),
                    None => format!("; there are: {}", known.join(", ")),
                };
                reader.error(
                    field.name,
                    format!("a preset has no `{}`{hint}", field.name),
                );
            }
        }

        let mut section = |name: &str| {
            let (_, _, table) = SECTIONS
                .iter()
                .find(|(known, ..)| *known == name)
                .unwrap_or_else(|| panic!("no section `{name}`"));
            match other.iter().find(|field| field.name == name) {
                Some(field) => reader.section(field.value, table, name),
                None => Values::defaults(table),
            }
        };
        let (hair, head, scene) = (section("hair"), section("head"), section("scene"));
        let (camera, light, path) = (section("camera"), section("light"), section("path"));
        let clump = section("clump");
        let layers = match other.iter().find(|field| field.name == "layers") {
            Some(field) => reader.layers(field.value, registry),
            None => {
                reader.error(text, "the preset has no `layers`, so it would draw nothing");
                Vec::new()
            }
        };
        reader.report()?;
        let seed = top.integer("seed").unsigned_abs();
        Ok(Self {
            seed,
            hair,
            head,
            scene,
            camera,
            light,
            path,
            clump,
            layers,
        })
    }

    /// Sets a layer's parameter, or one of a section, from its text: `hair.silhouette.width`, `3`.
    ///
    /// # Errors
    ///
    /// When there is no such layer, section or parameter, or the text is not one of its values.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), String> {
        let Some((owner, param)) = name.rsplit_once('.') else {
            return Err(format!("`{name}` is not LAYER.PARAM"));
        };
        if let Some(layer) = self.layers.iter_mut().find(|layer| layer.name == owner) {
            return layer.set(param, text);
        }
        let section = match owner {
            "hair" => &mut self.hair,
            "head" => &mut self.head,
            "scene" => &mut self.scene,
            "camera" => &mut self.camera,
            "light" => &mut self.light,
            "path" => &mut self.path,
            "clump" => &mut self.clump,
            _ => return Err(self.unknown_layer(owner)),
        };
        section.set_text(owner, param, text)
    }

    /// Keeps only the layers of these names.
    ///
    /// # Errors
    ///
    /// When there is no layer of one of the names.
    pub fn keep_only(&mut self, names: &[String]) -> Result<(), String> {
        for name in names {
            if self.layers.iter().all(|layer| layer.name != *name) {
                return Err(self.unknown_layer(name));
            }
        }
        self.layers.retain(|layer| names.contains(&layer.name));
        Ok(())
    }

    fn unknown_layer(&self, name: &str) -> String {
        let layers: Vec<&str> = self
            .layers
            .iter()
            .map(|layer| layer.name.as_str())
            .collect();
        match effects::preset::nearest(name, layers.iter().copied()) {
            Some(near) => format!("there is no layer `{name}`, did you mean `{near}`?"),
            None => format!(
                "there is no layer `{name}`; there are: {}",
                layers.join(", ")
            ),
        }
    }
}

/// Notes where the file is not of a version that this build reads.
fn check_version<'a>(reader: &mut Reader<'a>, fields: &[Field<'a>]) {
    let Some(field) = fields.iter().find(|field| field.name == "version") else {
        let message = format!("the preset needs `version: {VERSION}`, the version of its format");
        reader.error(reader.text(), message);
        return;
    };
    if let Ok(version) = field.value.parse::<i64>()
        && version > i64::from(VERSION)
    {
        let message = format!(
            "this preset is of version {version}, this build reads up to {VERSION}: update inkstrand"
        );
        reader.error(field.value, message);
    }
}
