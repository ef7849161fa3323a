//! Presets: one RON file that says what is drawn and how.

mod base;
mod lines;
mod meshes;
mod objects;
mod passes;
mod sections;

pub(crate) use base::Origin;
pub(crate) use lines::LineKinds;
pub use lines::{LINES, LineSection, NamedLines};
pub(crate) use meshes::is_sequence;
pub use meshes::{AlphaChoice, MESHES, MeshSection, NamedMesh, ThingChoice};
pub use objects::{NamedObject, ObjectSection};
pub use passes::{EdgesChoice, PASSES, PassSection};
pub use sections::*;

use crate::bodies::NamedBody;
use crate::files::{Files, no_file};
use crate::textures::textures_of;
use effects::preset::{
    Field, LayerSpec, Place, PresetError, PresetErrors, Reader, SetError, nearest, set_text,
    suggestion,
};
use effects::{Param, Registry};
use std::path::{Path, PathBuf};

/// The newest version of presets that this build reads.
pub const VERSION: u32 = 1;

/// A preset, read and checked, or made by a program.
pub struct Preset<'r> {
    /// Seed of all variations.
    pub seed: u32,
    /// What its sections say.
    pub sections: Sections,
    /// The layers, in the order of the file.
    pub layers: Vec<LayerSpec<'r>>,
    /// The objects that it names. Without any it describes one itself.
    pub objects: Vec<NamedObject>,
    /// Meshes beside the head, in the order of the file.
    pub meshes: Vec<NamedMesh>,
    /// Lines of meshes, in the order of the file.
    pub lines: Vec<NamedLines>,
    /// Bodies that hair is kept out of, in the order of the file.
    pub bodies: Vec<NamedBody>,
    /// What is done with the whole picture's samples, in the order of the file.
    pub passes: Vec<PassSection>,
    /// The effects that it was read with, and that its objects' presets are read with.
    registry: Option<&'r Registry>,
    /// Where the file names other files.
    named: Vec<Named>,
    /// The presets that it builds on: its base, that one's base and so on.
    bases: Vec<PathBuf>,
    /// Where its sections and lists stand, in the file or in a base.
    parts: Vec<(String, Place)>,
    /// Whether [`Self::set`] gave it other hair than the file's.
    has_other_hair: bool,
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
    pub const TOP: &'static [Param] = TopSection::TABLE;

    /// A preset that was not read: what a program says itself.
    #[must_use]
    pub fn new(seed: u32, sections: Sections, layers: Vec<LayerSpec<'r>>) -> Self {
        Self {
            seed,
            sections,
            layers,
            objects: Vec::new(),
            meshes: Vec::new(),
            lines: Vec::new(),
            bodies: Vec::new(),
            passes: Vec::new(),
            registry: None,
            named: Vec::new(),
            bases: Vec::new(),
            parts: Vec::new(),
            has_other_hair: false,
        }
    }

    /// Reads the preset `text` of the file `file`. Where it builds on another preset, that one is looked for beside it.
    ///
    /// # Errors
    ///
    /// All mistakes of the file, or of the preset that it builds on, each with its file, line and column.
    pub fn parse(file: &str, text: &str, registry: &'r Registry) -> Result<Self, PresetErrors> {
        let folder = Path::new(file).parent().unwrap_or(Path::new(""));
        Self::parse_in(folder, file, text, registry)
    }

    /// As [`Self::parse`], of a preset in `folder`, whatever messages call it.
    ///
    /// # Errors
    ///
    /// As those of [`Self::parse`].
    pub fn parse_in(
        folder: &Path,
        file: &str,
        text: &str,
        registry: &'r Registry,
    ) -> Result<Self, PresetErrors> {
        let mut reader = Reader::new(file, text);
        let preset = Self::read(&mut reader, registry, &Origin::of(folder, file))?;
        reader.report()?;
        Ok(preset)
    }

    /// Reads what can be read, and notes mistakes; those after which nothing can be read are returned.
    pub(crate) fn read(
        reader: &mut Reader,
        registry: &'r Registry,
        origin: &Origin,
    ) -> Result<Self, PresetErrors> {
        let fields = reader.fields(reader.text(), "the preset");
        if fields.is_empty() {
            reader.report()?;
        }
        if let Some(newer) = newer_version(reader, &fields) {
            return Err(PresetErrors(vec![newer]));
        }
        let names = Sections::ALL.iter().map(|(name, ..)| *name);
        let known: Vec<&str> = (Self::TOP.iter().map(|param| param.name))
            .chain(names)
            .chain(["layers", "meshes", "lines", "bodies", "passes", "objects"])
            .collect();
        let is_plain = |field: &&Field| Self::TOP.iter().any(|param| param.name == field.name);
        let plain: Vec<Field> = fields.iter().filter(is_plain).copied().collect();
        let top: TopSection = reader.section_of(&plain, "the preset");
        let mut preset = Self::on_base(reader, &plain, &top, registry, origin)?;
        let has_seed = plain.iter().any(|field| field.name == "seed");
        if preset.bases.is_empty() || has_seed {
            preset.seed = top.seed;
        }
        let mut layers = None;
        let objects = fields.iter().find(|field| field.name == "objects");
        let has_objects = objects.is_some() || !preset.objects.is_empty();
        for field in &fields {
            preset.parts.retain(|(name, _)| name != field.name);
            let place = reader.place(field.name);
            preset.parts.push((field.name.to_owned(), place));
            let is_section = Sections::ALL.iter().any(|(name, ..)| *name == field.name);
            if field.name == "objects" {
                if !preset.layers.is_empty() {
                    let message =
                        "this preset's base describes hair itself, so it can't name objects";
                    reader.error(field.name, message);
                }
                preset.objects = NamedObject::read_list(reader, field.value);
            } else if field.name == "passes" {
                preset.passes = PassSection::read_list(reader, field.value);
            } else if has_objects
                && (["layers", "meshes", "lines", "bodies"].contains(&field.name)
                    || is_section && objects::is_of_objects(field.name))
            {
                reader.error(field.name, objects::said_elsewhere(field.name));
            } else if field.name == "meshes" {
                preset.meshes = NamedMesh::read_list(reader, field.value);
            } else if field.name == "lines" {
                preset.lines = NamedLines::read_list(reader, field.value);
            } else if field.name == "bodies" {
                preset.bodies = NamedBody::read_list(reader, field.value);
            } else if field.name == "layers" {
                layers = Some(field);
            } else if preset.sections.by_name(field.name).is_some() {
                preset.read_section(reader, field);
            } else if !is_plain(&field) {
                let hint = suggestion(field.name, known.iter().copied());
                let message = format!("a preset has no `{}`{hint}", field.name);
                reader.error(field.name, message);
            }
        }
        if plain.iter().all(|field| field.name != "version") {
            let message =
                format!("the preset needs `version: {VERSION}`, the version of its format");
            reader.error(reader.text(), message);
        }
        match layers {
            Some(field) => {
                let of_base = std::mem::take(&mut preset.layers);
                preset.layers = reader.layers_on(field.value, registry, &known, of_base);
            }
            None if has_objects || !preset.layers.is_empty() => {}
            None => {
                let message = "the preset has no `layers`, so it would draw nothing";
                reader.error(reader.text(), message);
            }
        }
        Ok(preset)
    }

    /// Reads the section `field`, and notes where it names files.
    fn read_section<'a>(&mut self, reader: &mut Reader<'a>, field: &Field<'a>) {
        let name = field.name;
        let fields = reader.fields(field.value, name);
        for (section, param) in FILES.into_iter().filter(|(section, _)| *section == name) {
            let Some(file) = fields.iter().find(|field| field.name == param) else {
                continue;
            };
            self.forget_named(section, param);
            self.named.push(Named {
                section,
                param,
                place: reader.place(file.value),
            });
        }
        if let Some(section) = self.sections.by_name(name) {
            reader.fill(&fields, section, name);
        }
        if let Some((param, message)) = self.unsupported_of(name) {
            let field = fields.iter().find(|field| field.name == param);
            reader.error(field.map_or(name, |field| field.name), message);
        }
    }

    /// What the sections ask for that cannot be, as values that go with no others may: the section, its parameter, and why. A preset that was read has
    /// none, until something is [set](Self::set).
    pub fn unsupported(&self) -> Option<(&'static str, &'static str, String)> {
        ["dynamics", "motion"].into_iter().find_map(|section| {
            let (param, message) = self.unsupported_of(section)?;
            Some((section, param, message))
        })
    }

    fn unsupported_of(&self, section: &str) -> Option<(&'static str, String)> {
        match section {
            "dynamics" => self.sections.dynamics.unsupported(),
            "motion" => self.sections.motion.unsupported(),
            _ => None,
        }
    }

    /// Looks for the files that the preset names and the caller gives no others for.
    ///
    /// # Errors
    ///
    /// For each that is not there, at its place in the preset, with the nearest name in its folder.
    pub fn check_files(&self, files: &Files) -> Result<(), PresetErrors> {
        let missing_file = |named: &Named| {
            let sections = &self.sections;
            let (name, given) = match (named.section, named.param) {
                ("hair", "file") => (&sections.hair.file, &files.hair),
                ("hair", _) => (&sections.hair.bake, &files.bake),
                ("head", _) => (&sections.head.file, &files.head),
                (_, "file") => (&sections.motion.file, &files.motion),
                _ => (&sections.motion.gltf, &None),
            };
            if given.is_some() {
                return None;
            }
            let name = name.as_ref()?;
            let message = missing(&files.preset_folder, named.param, name)?;
            let place = named.place.clone();
            Some(PresetError { place, message })
        };
        let mut errors: Vec<PresetError> = self.named.iter().filter_map(missing_file).collect();
        for layer in &self.layers {
            for (param, place, name) in textures_of(layer) {
                if let Some(place) = place
                    && let Some(message) = missing(&files.preset_folder, param, name)
                {
                    let place = place.clone();
                    errors.push(PresetError { place, message });
                }
            }
        }
        let objects = self.objects.iter();
        errors.extend(objects.filter_map(|object| object.missing(&files.preset_folder)));
        let meshes = self.meshes.iter();
        errors.extend(meshes.flat_map(|mesh| mesh.missing(&files.preset_folder)));
        let bodies = self.bodies.iter();
        errors.extend(bodies.filter_map(|body| body.missing(&files.preset_folder)));
        PresetErrors::report(errors)
    }

    /// What is wrong with the file that a parameter names, written as [`Self::set`] takes it, where there is no such file and `files`
    /// has no other.
    #[must_use]
    pub fn missing_file(&self, name: &str, files: &Files) -> Option<String> {
        let (owner, param) = name.rsplit_once('.')?;
        let sections = &self.sections;
        let (file, given) = match (owner, param) {
            ("hair", "file") => (sections.hair.file.as_deref(), &files.hair),
            ("hair", "bake") => (sections.hair.bake.as_deref(), &files.bake),
            ("head", "file") => (sections.head.file.as_deref(), &files.head),
            ("motion", "file") => (sections.motion.file.as_deref(), &files.motion),
            ("motion", "gltf") => (sections.motion.gltf.as_deref(), &None),
            _ => {
                let layer_name = owner.strip_suffix(".brush").unwrap_or(owner);
                let is_it = |layer: &&LayerSpec| layer.name == owner || layer.name == layer_name;
                let file = match self.layers.iter().find(is_it) {
                    Some(layer) => {
                        let mut textures = textures_of(layer);
                        let texture = textures.find(|(own, ..)| *own == param);
                        texture.map(|(.., file)| file)
                    }
                    None => self.listed_file(owner, param),
                };
                (file, &None)
            }
        };
        if given.is_some() {
            return None;
        }
        let hint = "; it is relative to the preset's folder";
        no_file(&files.preset_folder.join(file?), hint)
    }

    /// The file that a parameter of a mesh or body names; of numbered files those that are there are found when they are read.
    fn listed_file(&self, owner: &str, param: &str) -> Option<&str> {
        let (list, number) = owner.split_once('.')?;
        let index = number.parse::<usize>().ok()?.checked_sub(1)?;
        let file = match (list, param) {
            ("meshes", "file") => &self.meshes.get(index)?.section.file,
            ("meshes", "texture") => &self.meshes.get(index)?.section.texture,
            ("bodies", "file") => &self.bodies.get(index)?.section.file,
            _ => return None,
        };
        file.as_deref().filter(|file| !is_sequence(file))
    }

    /// Where a section or list stands, in the file or in a base.
    pub(crate) fn place_of_part(&self, name: &str) -> Option<&Place> {
        let part = self.parts.iter().find(|(part, _)| part == name);
        part.map(|(_, place)| place)
    }

    /// The presets that this one builds on: its base, that one's base and so on.
    #[must_use]
    pub fn bases(&self) -> &[PathBuf] {
        &self.bases
    }

    /// Where the file names the file of this section and parameter.
    pub(crate) fn place_of(&self, section: &str, param: &str) -> Option<&Place> {
        let is_it = |named: &&Named| (named.section, named.param) == (section, param);
        self.named.iter().find(is_it).map(|named| &named.place)
    }

    /// Sets a layer's parameter, one of a section, of a pass, mesh, lines or body by its number from 1 on, or the seed, from its text:
    /// `hair.silhouette.width`, `3`; `passes.1.width`, `2`.
    ///
    /// # Errors
    ///
    /// When there is no such layer, section or parameter, or the text is not one of its values.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), SetError> {
        let Some((owner, param)) = name.rsplit_once('.') else {
            return self.set_top(name, text);
        };
        if let Some(layer) = self.layers.iter_mut().find(|layer| layer.name == owner) {
            return layer.set(param, text);
        }
        if let Some(name) = owner.strip_suffix(".brush")
            && let Some(layer) = self.layers.iter_mut().find(|layer| layer.name == name)
        {
            return layer.set_brush(param, text);
        }
        if let Some(number) = owner.strip_prefix("passes.") {
            return set_text(
                numbered(&mut self.passes, number, ["pass", "passes"])?,
                owner,
                param,
                text,
            );
        }
        if let Some(number) = owner.strip_prefix("meshes.") {
            let words = ["mesh", "meshes"];
            let mesh = numbered(&mut self.meshes, number, words)?;
            return mesh.set(owner, param, text);
        }
        if let Some(number) = owner.strip_prefix("lines.") {
            let words = ["list of lines", "lines"];
            let lines = numbered(&mut self.lines, number, words)?;
            let mut section = lines.section.clone();
            set_text(&mut section, owner, param, text)?;
            section.kinds().map_err(SetError::Unknown)?;
            lines.section = section;
            return Ok(());
        }
        if let Some(number) = owner.strip_prefix("bodies.") {
            let words = ["body", "bodies"];
            let body = numbered(&mut self.bodies, number, words)?;
            return body.set(owner, param, text);
        }
        let Some(section) = self.sections.by_name(owner) else {
            let message = of_a_list(owner, param).unwrap_or_else(|| self.no_owner(owner));
            return Err(SetError::Unknown(message));
        };
        if !self.objects.is_empty() && objects::is_of_objects(owner) {
            return Err(SetError::Unknown(objects::said_elsewhere(owner)));
        }
        set_text(section, owner, param, text)?;
        // What the file says is no longer what is meant.
        self.forget_named(owner, param);
        self.has_other_hair |= (owner, param) == ("hair", "file");
        Ok(())
    }

    /// Whether its hair is not that which the file was made for: the caller gives another file, or has set one.
    pub(crate) fn is_on_other_hair(&self, files: &Files) -> bool {
        files.hair.is_some() || self.has_other_hair
    }

    fn forget_named(&mut self, section: &str, param: &str) {
        self.named
            .retain(|named| (named.section, named.param) != (section, param));
    }

    /// Sets what stands beside the sections: the seed, as the version is the file's.
    fn set_top(&mut self, name: &str, text: &str) -> Result<(), SetError> {
        if name != "seed" {
            return Err(SetError::Unknown(format!(
                "`{name}` is neither seed nor LAYER.PARAM, such as hair.base.brightness or clump.size"
            )));
        }
        let mut top = TopSection::default();
        set_text(&mut top, "preset", name, text)?;
        self.seed = top.seed;
        Ok(())
    }

    /// Keeps only the layers of these names.
    ///
    /// # Errors
    ///
    /// When there is no layer of one of the names.
    pub fn keep_only(&mut self, names: &[String]) -> Result<(), SetError> {
        for name in names {
            if self.layers.iter().all(|layer| layer.name != *name) {
                return Err(SetError::Unknown(self.no_layer(name)));
            }
        }
        self.layers.retain(|layer| names.contains(&layer.name));
        Ok(())
    }

    /// Of a name that is to be a layer's or a section's.
    fn no_owner(&self, name: &str) -> String {
        let sections = || Sections::ALL.iter().map(|(name, ..)| *name);
        let layers = self.layers.iter().map(|layer| layer.name.as_str());
        match nearest(name, layers.chain(sections())) {
            Some(near) if sections().any(|section| section == near) => {
                format!("there is no layer or section `{name}`, did you mean `{near}`?")
            }
            _ => self.no_layer(name),
        }
    }

    fn no_layer(&self, name: &str) -> String {
        if let Some(object) = self.objects.first() {
            let own = object.section.preset.as_deref().unwrap_or("its own.ron");
            return format!(
                "there is no layer `{name}`: this preset draws objects, and their layers are in presets of their own, such as {own}"
            );
        }
        let layers: Vec<&str> = self
            .layers
            .iter()
            .map(|layer| layer.name.as_str())
            .collect();
        let hint = suggestion(name, layers.iter().copied());
        format!("there is no layer `{name}`{hint}")
    }
}

/// What is wrong with a parameter of a list as a whole, or of one that stands in another file.
fn of_a_list(owner: &str, param: &str) -> Option<String> {
    let list = owner.split('.').next()?;
    match list {
        "passes" | "meshes" | "lines" | "bodies" => Some(format!(
            "`{list}` is a list, and its items are set by their numbers, such as {list}.1.{param}"
        )),
        "layers" => Some(
            "`layers` is a list, and layers are set by their names, such as hair.base.brightness"
                .to_owned(),
        ),
        "objects" => Some(
            "`objects` is a list, which can't be set: what it says stands in the preset".to_owned(),
        ),
        "zones" | "edits" | "strands" | "accessories" => Some(format!(
            "`{list}` is a list of a hair style, which can't be set: it is changed in its file"
        )),
        "moves" | "keys" | "winds" | "shapes" | "body_keys" => Some(format!(
            "`{list}` is a list of a motion script, which can't be set: it is changed in its file"
        )),
        _ => None,
    }
}

/// The item of that number, from 1 on, of a list; the words are for one and for all.
fn numbered<'l, T>(
    list: &'l mut [T],
    number: &str,
    [one, all]: [&str; 2],
) -> Result<&'l mut T, SetError> {
    let count = list.len();
    let index = number.parse::<usize>().ok().and_then(|n| n.checked_sub(1));
    index.and_then(|index| list.get_mut(index)).ok_or_else(|| {
        SetError::Unknown(match count {
            0 => format!("the preset has no {all}"),
            1 => format!("there is no {one} `{number}`: the preset has one, {all}.1"),
            _ => format!("there is no {one} `{number}`: they are {all}.1 to {all}.{count}"),
        })
    })
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
    let hint = "; file names are relative to the file that they stand in";
    Some(format!("{param}: {}", no_file(&folder.join(name), hint)?))
}
