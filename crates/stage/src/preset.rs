//! Presets: one RON file that says what is drawn and how.

mod sections;

pub use sections::{CAMERA, HAIR, HEAD, LIGHT, MOTION, PATH, SCENE, SECTIONS};

use crate::dynamics::feel;
use crate::files::Files;
use effects::preset::{
    Field, LayerSpec, Place, PresetError, PresetErrors, Reader, nearest, suggestion,
};
use effects::{Param, Registry, Values};
use sections::TOP;
use std::path::Path;

/// The newest version of presets that this build reads.
pub const VERSION: i32 = 1;

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
    /// Values of [`MOTION`].
    pub motion: Values,
    /// Values of [`DYNAMICS`](crate::DYNAMICS).
    pub dynamics: Values,
    /// Values of [`PATH`].
    pub path: Values,
    /// Values of the clump's parameters.
    pub clump: Values,
    /// The layers, in the order of the file.
    pub layers: Vec<LayerSpec<'r>>,
    /// Where the file names other files.
    named: Vec<Named>,
}

/// A place where a preset names a file.
struct Named {
    /// The section and its parameter.
    section: &'static str,
    param: &'static str,
    place: Place,
}

/// What names a file: sections and their parameters.
const FILES: [(&str, &str); 5] = [
    ("hair", "file"),
    ("hair", "bake"),
    ("head", "file"),
    ("motion", "file"),
    ("motion", "gltf"),
];

impl<'r> Preset<'r> {
    /// What stands in a preset beside its sections and layers.
    pub const TOP: &'static [Param] = TOP;

    /// Reads the preset `text`, which messages call `file`.
    ///
    /// # Errors
    ///
    /// All mistakes of the file, each with its line and column.
    pub fn parse(file: &str, text: &str, registry: &'r Registry) -> Result<Self, PresetErrors> {
        let mut reader = Reader::new(file, text);
        let preset = Self::read(&mut reader, registry)?;
        reader.report()?;
        Ok(preset)
    }

    /// Reads what can be read, and notes mistakes; those after which nothing can be read are returned.
    pub(crate) fn read(reader: &mut Reader, registry: &'r Registry) -> Result<Self, PresetErrors> {
        let fields = reader.fields(reader.text(), "the preset");
        if fields.is_empty() {
            reader.report()?;
        }
        if let Some(newer) = newer_version(reader, &fields) {
            return Err(PresetErrors(vec![newer]));
        }
        let sections = SECTIONS.iter().map(|(name, ..)| *name).chain(["layers"]);
        let known: Vec<&str> = TOP.iter().map(|p| p.name).chain(sections).collect();
        for field in fields.iter().filter(|f| !known.contains(&f.name)) {
            let hint = suggestion(field.name, known.iter().copied());
            reader.error(
                field.name,
                format!("a preset has no `{}`{hint}", field.name),
            );
        }
        let field = |name: &str| fields.iter().find(|field| field.name == name);
        let plain: Vec<Field> = TOP.iter().filter_map(|p| field(p.name)).copied().collect();
        let top = reader.values(&plain, TOP, "the preset");
        if !top.is_given("version") && field("version").is_none() {
            let message =
                format!("the preset needs `version: {VERSION}`, the version of its format");
            reader.error(reader.text(), message);
        }

        let mut named = Vec::new();
        let mut section = |name: &str| {
            let (_, _, table) = SECTIONS
                .iter()
                .find(|(known, ..)| *known == name)
                .unwrap_or_else(|| panic!("no section `{name}`"));
            let Some(field) = field(name) else {
                return Values::defaults(table);
            };
            let fields = reader.fields(field.value, name);
            for (section, param) in FILES.into_iter().filter(|(section, _)| *section == name) {
                let file = fields.iter().find(|field| field.name == param);
                named.extend(file.map(|file| Named {
                    section,
                    param,
                    place: reader.place(file.value),
                }));
            }
            let values = reader.values(&fields, table, name);
            if let Some((param, message)) = unsupported(name, &values) {
                let field = fields.iter().find(|field| field.name == param);
                reader.error(field.map_or(name, |field| field.name), message);
            }
            values
        };
        let (hair, head) = (section("hair"), section("head"));
        let (scene, camera, light) = (section("scene"), section("camera"), section("light"));
        let (path, clump) = (section("path"), section("clump"));
        let (motion, dynamics) = (section("motion"), section("dynamics"));
        let layers = match field("layers") {
            Some(field) => reader.layers(field.value, registry, &known),
            None => {
                let message = "the preset has no `layers`, so it would draw nothing";
                reader.error(reader.text(), message);
                Vec::new()
            }
        };
        let seed = top.integer("seed").unsigned_abs();
        Ok(Self {
            seed,
            hair,
            head,
            scene,
            camera,
            light,
            motion,
            dynamics,
            path,
            clump,
            layers,
            named,
        })
    }

    /// Looks for the files that the preset names and the caller gives no others for.
    ///
    /// # Errors
    ///
    /// For each that is not there, at its place in the preset, with the nearest name in its folder.
    pub fn check_files(&self, files: &Files) -> Result<(), PresetErrors> {
        let missing_file = |named: &Named| {
            let (values, given) = match (named.section, named.param) {
                ("hair", "file") => (&self.hair, &files.hair),
                ("hair", _) => (&self.hair, &files.bake),
                ("head", _) => (&self.head, &files.head),
                (_, "file") => (&self.motion, &files.motion),
                _ => (&self.motion, &None),
            };
            if given.is_some() {
                return None;
            }
            let name = values.text(named.param)?;
            let message = missing(&files.preset_folder, named.param, name)?;
            let place = named.place.clone();
            Some(PresetError { place, message })
        };
        let mut errors: Vec<PresetError> = self.named.iter().filter_map(missing_file).collect();
        errors.sort_by_key(|e| (e.place.line, e.place.column));
        if errors.is_empty() {
            Ok(())
        } else {
            Err(PresetErrors(errors))
        }
    }

    /// Where the file names the file of this section and parameter.
    pub(crate) fn place_of(&self, section: &str, param: &str) -> Option<&Place> {
        let is_it = |named: &&Named| (named.section, named.param) == (section, param);
        self.named.iter().find(is_it).map(|named| &named.place)
    }

    /// Sets a layer's parameter, or one of a section, from its text: `hair.silhouette.width`, `3`.
    ///
    /// # Errors
    ///
    /// When there is no such layer, section or parameter, or the text is not one of its values.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), String> {
        let Some((owner, param)) = name.rsplit_once('.') else {
            return Err(format!(
                "`{name}` is not LAYER.PARAM, such as hair.base.brightness or clump.size"
            ));
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
            "motion" => &mut self.motion,
            "dynamics" => &mut self.dynamics,
            "path" => &mut self.path,
            "clump" => &mut self.clump,
            _ => return Err(self.unknown_layer(owner)),
        };
        section.set_text(owner, param, text)?;
        // What the file says is no longer what is meant.
        self.named
            .retain(|named| (named.section, named.param) != (owner, param));
        Ok(())
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
        let hint = suggestion(name, layers.iter().copied());
        format!("there is no layer `{name}`{hint}")
    }
}

/// What a section asks for that cannot be: a parameter, and why.
fn unsupported(section: &str, values: &Values) -> Option<(&'static str, String)> {
    (section == "dynamics").then(|| feel::unsupported(values))?
}

/// The error of a file of a version that this build doesn't read: nothing else in it means what it
/// seems to mean.
fn newer_version(reader: &Reader, fields: &[Field]) -> Option<PresetError> {
    let version = fields.iter().find(|field| field.name == "version")?.value;
    (version.parse::<f64>().ok()? > f64::from(VERSION)).then(|| PresetError {
        place: reader.place(version),
        message: format!(
            "this preset is of version {version}, this build reads up to {VERSION}: update inkstrand"
        ),
    })
}

/// What is wrong with the file name that `param` gives, where there is no such file.
pub(crate) fn missing(folder: &Path, param: &str, name: &str) -> Option<String> {
    let path = folder.join(name);
    if path.is_file() {
        return None;
    }
    let shown = path.display();
    if path.is_dir() {
        return Some(format!("{param}: `{shown}` is a folder, not a file"));
    }
    let parent = path.parent().unwrap_or(Path::new(""));
    let parent = if parent.as_os_str().is_empty() {
        Path::new(".")
    } else {
        parent
    };
    let Ok(entries) = std::fs::read_dir(parent) else {
        return Some(format!(
            "{param}: there is no `{shown}`, nor a folder `{}`; file names are relative to the file that they stand in",
            parent.display()
        ));
    };
    let mut names: Vec<String> = entries
        .flatten()
        .filter(|entry| entry.path().is_file())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let wrong = path.file_name().unwrap_or_default().to_string_lossy();
    Some(match nearest(&wrong, names.iter().map(String::as_str)) {
        Some(near) => format!("{param}: there is no `{shown}`, did you mean `{near}`?"),
        None => format!(
            "{param}: there is no `{shown}`; file names are relative to the file that they stand in"
        ),
    })
}
