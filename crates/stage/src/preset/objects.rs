//! The objects that a preset names: heads of hair that other presets describe, put into one picture.

use super::{Preset, Sections, missing};
use crate::files::{Files, StageError};
use crate::look::Look;
use crate::object::Object;
use effects::preset::{Place, PresetError, PresetErrors, Reader};
use effects::section;
use glam::Vec3;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The most objects of a picture: more are a mistake, or somebody's attack.
const MOST_OBJECTS: usize = 1000;

/// The sections that a preset of objects says itself; the others are said by the objects' own presets.
const OF_THE_SCENE: [&str; 3] = ["scene", "camera", "light"];

section! {
    /// A head of hair in the picture, as another preset describes it.
    pub struct ObjectSection {
        /// Its preset, relative to this one. Hair, head, motion, dynamics, path, clump and layers are taken from it, not its scene,
        /// camera, light and passes.
        preset: Option<String> = text(),
        /// Where it stands: how far its 0 is shifted.
        at: [f32; 3] = triple([0.0; 3], -1000.0..=1000.0).unit("m"),
        /// How far it is turned to its left, before it is shifted.
        turn: f32 = number(0.0, -360.0..=360.0).unit("degrees"),
        /// Seed of its variations; 0 takes its preset's.
        seed: u32 = whole(0, 0..=i32::MAX as u32),
    }
}

/// An object as a preset names it.
#[derive(Clone, Debug)]
pub struct NamedObject {
    /// What is said of it.
    pub section: ObjectSection,
    /// Where its preset's name stands.
    place: Place,
}

impl NamedObject {
    /// Reads the list `objects` of a preset.
    pub(super) fn read_list<'a>(reader: &mut Reader<'a>, list: &'a str) -> Vec<Self> {
        let items = reader.list(list, "objects");
        if items.len() > MOST_OBJECTS {
            let message = format!(
                "objects: there are {}, and at most {MOST_OBJECTS} are drawn",
                items.len()
            );
            reader.error(list, message);
            return Vec::new();
        }
        if items.is_empty() && list.starts_with('[') {
            reader.error(
                list,
                "objects: the list is empty, so nothing would be drawn",
            );
        }
        let read = |item: &&'a str| {
            let fields = reader.fields(item, "an object");
            let section: ObjectSection = reader.section_of(&fields, "an object");
            let name = fields.iter().find(|field| field.name == "preset");
            if name.is_none() {
                reader.error(
                    item,
                    "an object needs `preset: \"...\"`, which describes it",
                );
            }
            let place = reader.place(name.map_or(item, |name| name.value));
            Self { section, place }
        };
        items.iter().map(read).collect()
    }

    /// What is wrong with the name of its preset.
    pub(super) fn missing(&self, folder: &Path) -> Option<PresetError> {
        let message = missing(folder, "preset", self.section.preset.as_ref()?)?;
        let place = self.place.clone();
        Some(PresetError { place, message })
    }

    fn path(&self, folder: &Path) -> PathBuf {
        folder.join(self.section.preset.as_deref().unwrap_or_default())
    }
}

/// A preset that objects name, read once.
struct Loaded<'r> {
    path: PathBuf,
    preset: Preset<'r>,
    object: Object,
}

impl Loaded<'_> {
    /// The same with variations of another seed. A bake that it has is of its own.
    fn with_seed(&mut self, seed: u32) -> Result<Object, StageError> {
        let own = std::mem::replace(&mut self.preset.seed, seed);
        let look = Look::new(&self.preset, &beside(&self.path));
        self.preset.seed = own;
        self.object.with_look(look?)
    }
}

/// The files that a preset itself names.
fn beside(preset: &Path) -> Files {
    Files {
        preset_folder: preset.parent().unwrap_or(Path::new("")).to_owned(),
        ..Files::default()
    }
}

/// Whether a preset of objects leaves a section to their presets.
pub(super) fn is_of_objects(section: &str) -> bool {
    !OF_THE_SCENE.contains(&section)
}

/// What is wrong with a section that a preset of objects doesn't have.
pub(super) fn said_elsewhere(section: &str) -> String {
    format!("this preset names objects, and `{section}` is said in their presets")
}

impl<'r> Preset<'r> {
    /// The objects, each of its own preset and files. Presets that are named twice are read once.
    pub(crate) fn load_objects(
        &self,
        files: &Files,
        notes: &mut Vec<String>,
    ) -> Result<Vec<Object>, StageError> {
        self.check_is_left_to_objects(files)?;
        let mut loaded: Vec<Loaded> = Vec::new();
        let mut objects = Vec::new();
        for named in &self.objects {
            let path = named.path(&files.preset_folder);
            let known = loaded.iter().position(|loaded| loaded.path == path);
            let index = match known {
                Some(index) => index,
                None => {
                    loaded.push(self.load_object(path, named, files, notes)?);
                    loaded.len() - 1
                }
            };
            let ObjectSection { at, turn, seed, .. } = named.section;
            let object = match seed {
                0 => loaded[index].object.clone(),
                seed => loaded[index].with_seed(seed)?,
            };
            objects.push(object.placed(turn, Vec3::from(at)));
        }
        Ok(objects)
    }

    fn load_object(
        &self,
        path: PathBuf,
        named: &NamedObject,
        files: &Files,
        notes: &mut Vec<String>,
    ) -> Result<Loaded<'r>, StageError> {
        let preset = self.read_object(&path, named)?;
        let files = Files {
            textures: files.textures.clone(),
            heads: files.heads.clone(),
            ..beside(&path)
        };
        preset.check_files(&files)?;
        let first = notes.len();
        let look = Arc::new(Look::new(&preset, &files)?);
        let object = Object::load(&preset, &files, look, notes)?;
        for note in &mut notes[first..] {
            *note = format!("{}: {note}", path.display());
        }
        Ok(Loaded {
            path,
            preset,
            object,
        })
    }

    /// The presets of the objects, and the files that they name.
    pub(crate) fn files_of_objects(&self, files: &Files) -> Vec<PathBuf> {
        let mut paths = Vec::new();
        for named in &self.objects {
            let path = named.path(&files.preset_folder);
            if paths.contains(&path) {
                continue;
            }
            if let Ok(preset) = self.read_object(&path, named) {
                paths.extend(preset.files(&beside(&path)));
            }
            paths.push(path);
        }
        paths
    }

    /// Reads the preset of an object.
    fn read_object(&self, path: &Path, named: &NamedObject) -> Result<Preset<'r>, StageError> {
        let text = hair_io::read_text(path, hair_io::MOST_OF_TEXT)?;
        let preset = match self.registry {
            Some(registry) => Preset::parse(&path.display().to_string(), &text, registry)?,
            None => return Err(StageError::NoObject),
        };
        if !preset.objects.is_empty() {
            let message = format!("preset: `{}` names objects itself", path.display());
            let place = named.place.clone();
            return Err(PresetErrors(vec![PresetError { place, message }]).into());
        }
        Ok(preset)
    }

    /// Options may have said what the file cannot.
    fn check_is_left_to_objects(&self, files: &Files) -> Result<(), StageError> {
        let own = Sections {
            scene: self.sections.scene.clone(),
            camera: self.sections.camera.clone(),
            light: self.sections.light.clone(),
            ..Sections::default()
        };
        let given = [&files.hair, &files.head, &files.bake, &files.motion];
        if own != self.sections || given.iter().any(|file| file.is_some()) {
            return Err(StageError::OfObjects);
        }
        Ok(())
    }
}
