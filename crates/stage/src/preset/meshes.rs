//! The meshes of a preset: what is seen beside head and hair.

use super::missing;
use crate::numbered::all_files;
use crate::part::FilePart;
use effects::preset::{Place, PresetError, Reader, SetError, set_text};
use effects::{choices, section};
use std::path::{Path, PathBuf};

/// The most meshes that a preset lists.
const MOST_MESHES: usize = 64;

/// How the list is written, for those who write something else.
const WRITTEN: &str = "meshes: [(file: \"eyes.obj\", color: \"FFFFFF\"), ...]";

choices! {
    /// A thing that needs no file.
    pub enum ThingChoice {
        /// None: a file's meshes.
        None = "none",
        /// A tea cup.
        Cup = "cup",
        /// A cube.
        Cube = "cube",
        /// A gear of twelve teeth, its axis to the eye.
        Gear = "gear",
        /// A bird that flies to the eye and beats its wings.
        Wings = "wings",
    }
}

choices! {
    /// What the coverage of a mesh's picture means.
    pub enum AlphaChoice {
        /// What the file says; of a picture that the preset names: `cut`.
        File = "file",
        /// Nothing: the mesh is whole.
        Whole = "whole",
        /// There is nothing where it is below a half.
        Cut = "cut",
        /// How much of what lies behind is hidden.
        Blend = "blend",
    }
}

section! {
    /// Meshes of files, in their own colours: eyes, lashes, clothes, glasses; and things that need no file. They lie as the head's file does, and move
    /// with the head. A list.
    pub struct MeshSection {
        /// The meshes, relative to the preset: .obj, .ply, .gltf, .glb or .vrm. Of numbered files, `splash.####.ply`, they take one form after the other.
        file: Option<String> = text(),
        /// Numbered files a second.
        rate: f32 = number(24.0, 0.01..=1000.0).unit("1/s"),
        /// Whether numbered files start again at their end.
        repeat: bool = flag(false),
        /// A thing in place of a file, one head height large; its file's name is then `cup`, `cube`, `gear` or `wings`.
        shape: ThingChoice = ThingChoice::None.or_another(),
        /// Another name by which layers and lines mean it.
        name: Option<String> = text(),
        /// How far it is moved: to its left, up, forwards. A thing is moved from the middle of the head.
        at: [f32; 3] = triple([0.0; 3], -1000.0..=1000.0).unit("head heights"),
        /// How far it is turned: to its left, up, towards its left shoulder. A thing about its own middle, a file about that of the head.
        turn: [f32; 3] = triple([0.0; 3], -3600.0..=3600.0).unit("degrees"),
        /// How many times as large it is.
        size: f32 = number(1.0, 0.001..=1000.0),
        /// How often wings beat.
        beat: f32 = number(1.0, 0.0..=100.0).unit("1/s"),
        /// What of it: names of meshes or materials, or of bones for all that hangs on them, with commas between them, `*` for any end; without it all.
        only: Option<String> = text(),
        /// What of it not.
        hide: Option<String> = text(),
        /// A picture in place of the file's, relative to the preset: .png or .jpg. It lies on the mesh as the file's texture places say.
        texture: Option<String> = text(),
        /// What the picture's coverage means.
        alpha: AlphaChoice = AlphaChoice::File.or_another(),
        /// What their own colours are multiplied by; their colour where the file has none.
        color: [f32; 3] = color("FFFFFF"),
        /// How bright the side away from the light is; what the file says of that comes first.
        shade: f32 = number(0.8, 0.0..=1.0),
        /// Colour of the outline.
        line: [f32; 3] = color("6B4438"),
        /// Width of the outline; 0 is none.
        width: f32 = number(0.0, 0.0..=50.0).unit("1/300 head height"),
    }
}

/// The list of meshes, as `inkstrand effects` and the viewer show it.
pub const MESHES: FilePart = FilePart {
    name: "meshes",
    doc: MeshSection::DOC,
    example: WRITTEN,
    table: MeshSection::TABLE,
    places: &[],
};

/// Meshes as a preset lists them.
#[derive(Clone, Debug)]
pub struct NamedMesh {
    /// What is said of them.
    pub section: MeshSection,
    /// Where their file's name stands, and their picture's; nowhere where another was set.
    place: Option<Place>,
    texture: Option<Place>,
}

impl NamedMesh {
    /// Reads the list `meshes` of a preset.
    pub(super) fn read_list<'a>(reader: &mut Reader<'a>, list: &'a str) -> Vec<Self> {
        if list.starts_with('(') {
            let message = format!("meshes is a list, of one file too: {WRITTEN}");
            reader.error(list, message);
            return Vec::new();
        }
        let items = reader.list(list, "meshes");
        if items.len() > MOST_MESHES {
            let count = items.len();
            let message = format!("meshes: there are {count}, and at most {MOST_MESHES} are drawn");
            reader.error(list, message);
            return Vec::new();
        }
        let read = |item: &&'a str| {
            let fields = reader.fields(item, "a mesh");
            let section: MeshSection = reader.section_of(&fields, "a mesh");
            let name = fields.iter().find(|field| field.name == "file");
            let shape = fields.iter().find(|field| field.name == "shape");
            let is_thing = section.shape != ThingChoice::None;
            match (name, shape) {
                (None, _) if !is_thing => {
                    let message = "a mesh needs `file: \"...\"`, which holds it, or `shape:`, such as shape: cup";
                    reader.error(item, message);
                }
                (Some(_), Some(shape)) if is_thing => {
                    let message = "shape: a mesh is of a file or of a shape, not of both";
                    reader.error(shape.value, message);
                }
                _ => {}
            }
            if let (true, Some(texture)) = (
                is_thing,
                fields.iter().find(|field| field.name == "texture"),
            ) {
                let message = "texture: things of a `shape` have no places for a picture";
                reader.error(texture.value, message);
            }
            let texture = fields.iter().find(|field| field.name == "texture");
            Self {
                place: Some(reader.place(name.map_or(item, |name| name.value))),
                texture: texture.map(|texture| reader.place(texture.value)),
                section,
            }
        };
        items.iter().map(read).collect()
    }

    /// What is wrong with the names of its files.
    pub(super) fn missing(&self, folder: &Path) -> Vec<PresetError> {
        let MeshSection { file, texture, .. } = &self.section;
        let wrong = |name: &Option<String>, param| missing(folder, param, name.as_ref()?);
        // Of numbered files those that are there are found when they are read.
        let file = wrong(file, "file").filter(|_| !self.section.is_sequence());
        let file = file.and_then(|message| self.mistake(message));
        let texture = wrong(texture, "texture");
        let texture = texture.and_then(|message| self.mistake_of_texture(message));
        file.into_iter().chain(texture).collect()
    }

    /// Sets a parameter of what `owner` calls it from its text.
    pub(super) fn set(&mut self, owner: &str, param: &str, text: &str) -> Result<(), SetError> {
        set_text(&mut self.section, owner, param, text)?;
        match param {
            "file" => self.place = None,
            "texture" => self.texture = None,
            _ => {}
        }
        Ok(())
    }

    /// The files that the caller has set, which the preset doesn't name.
    pub(crate) fn files_set(&self, folder: &Path) -> Vec<PathBuf> {
        let files = match self.place {
            Some(_) => Vec::new(),
            None => self.section.files(folder),
        };
        let texture = self.section.texture_path(folder);
        let texture = texture.filter(|_| self.texture.is_none());
        files.into_iter().chain(texture).collect()
    }

    /// A mistake where its picture is named; none where the caller has set it.
    pub(crate) fn mistake_of_texture(&self, message: String) -> Option<PresetError> {
        let place = self.texture.clone()?;
        Some(PresetError { place, message })
    }

    /// A mistake where its file is named; none where the caller has set it.
    pub(crate) fn mistake(&self, message: String) -> Option<PresetError> {
        let place = self.place.clone()?;
        Some(PresetError { place, message })
    }
}

/// Whether a file's name is that of numbered files.
pub(crate) fn is_sequence(file: &str) -> bool {
    let name = Path::new(file).file_name();
    name.is_some_and(|name| name.to_string_lossy().contains('#'))
}

impl MeshSection {
    /// Its file, of a preset in `folder`, if it has one.
    pub(crate) fn path(&self, folder: &Path) -> Option<PathBuf> {
        Some(folder.join(self.file.as_deref()?))
    }

    /// All files that it is read from, but its picture.
    pub(crate) fn files(&self, folder: &Path) -> Vec<PathBuf> {
        let path = self.path(folder);
        path.map_or_else(Vec::new, |path| all_files(path, self.is_sequence()))
    }

    /// Whether it has numbered files.
    pub(crate) fn is_sequence(&self) -> bool {
        self.file.as_deref().is_some_and(is_sequence)
    }

    /// Its picture, of a preset in `folder`.
    pub(crate) fn texture_path(&self, folder: &Path) -> Option<PathBuf> {
        Some(folder.join(self.texture.as_deref()?))
    }
}
