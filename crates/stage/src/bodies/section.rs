//! Bodies as presets and motion scripts write them.

use crate::files::StageError;
use crate::numbered::all_files;
use crate::part::FilePart;
use crate::preset::{is_sequence, missing};
use effects::preset::{Field, Place, PresetError, Reader, SetError, set_text, suggestion};
use effects::section::Section as _;
use effects::{choices, section};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// The most bodies of a preset or a script: each is held against every point of the hair.
const MOST_BODIES: usize = 64;
/// Longer than any sequence.
const FOREVER: f32 = 1e6;

/// How the list is written, for those who write something else.
const WRITTEN: &str = "bodies: [(name: \"ball\", shape: sphere, at: (0, 0, 1), radius: 0.2), ...]";

choices! {
    /// What a body is.
    pub enum BodyShape {
        /// A ball.
        Sphere = "sphere",
        /// All that is near a line.
        Capsule = "capsule",
        /// The closed mesh of a file.
        Mesh = "mesh",
    }
}

choices! {
    /// What a body moves with.
    pub enum BodyOn {
        /// Nothing.
        World = "world",
        /// The head.
        Head = "head",
        /// The shoulders.
        Shoulders = "shoulders",
    }
}

section! {
    /// Bodies that hair is kept out of, beside head and shoulders: a hand, a ball, headphones, a cushion. A list.
    pub struct BodySection {
        /// Its name, by which `body_keys` of a motion script move it.
        name: Option<String> = text(),
        /// sphere: all within `radius` of `at`; capsule: all within `radius` of the line from `at` to `to`; mesh: what the surface of `file` closes in.
        shape: BodyShape = BodyShape::Sphere.or_another(),
        /// What it moves with: world stays where it is, head is worn on the head, shoulders lies on them.
        on: BodyOn = BodyOn::World.or_another(),
        /// Middle of a sphere, or one end of a capsule, from the middle of the head at rest: left, up, forwards. How far a mesh is shifted from where its
        /// file has it.
        at: [f32; 3] = triple([0.0; 3], -1000.0..=1000.0).unit("head heights"),
        /// Other end of a capsule.
        to: [f32; 3] = triple([0.0, 0.5, 0.0], -1000.0..=1000.0).unit("head heights"),
        /// Radius of a sphere or capsule.
        radius: f32 = number(0.2, 0.0..=1000.0).unit("head heights"),
        /// A mesh, relative to what names it: .obj, .ply, .gltf, .glb or .vrm. It lies as the head's file does, as `meshes` do. Of numbered
        /// files, `cape.####.obj`, it takes one form after the other.
        file: Option<String> = text(),
        /// Which animation of its file moves and deforms it; without it none.
        animation: Option<String> = text(),
        /// Numbered files a second.
        rate: f32 = number(24.0, 0.01..=1000.0).unit("1/s"),
        /// Whether numbered files or an animation start again at their end.
        repeat: bool = flag(false),
        /// How far a mesh is turned about its middle: to its left, up, towards its left shoulder.
        turn: [f32; 3] = triple([0.0; 3], -3600.0..=3600.0).unit("degrees"),
        /// How many times as large a mesh is as its file has it.
        size: f32 = number(1.0, 0.001..=1000.0),
        /// Colour in which it is drawn; none: it isn't.
        color: Option<[f32; 3]> = optional_color(None),
    }
}

section! {
    /// A keyframe of a body.
    pub struct BodyKeySection {
        /// The body's name.
        body: Option<String> = text(),
        /// When it is there.
        time: f32 = number(0.0, 0.0..=FOREVER).unit("s"),
        /// How far it is moved from its place: left, up, forwards.
        at: [f32; 3] = triple([0.0; 3], -1000.0..=1000.0).unit("head heights"),
        /// How far it is turned about its middle.
        turn: [f32; 3] = triple([0.0; 3], -3600.0..=3600.0).unit("degrees"),
        /// How many times as large it is.
        size: f32 = number(1.0, 0.001..=1000.0),
    }
}

/// The list of bodies, as `inkstrand effects` and the viewer show it.
pub const BODIES: FilePart = FilePart {
    name: "bodies",
    doc: BodySection::DOC,
    example: WRITTEN,
    table: BodySection::TABLE,
    places: &[],
};

/// What not every shape has, and which have it.
const OF_SHAPES: [(&str, &[BodyShape]); 8] = [
    ("to", &[BodyShape::Capsule]),
    ("radius", &[BodyShape::Sphere, BodyShape::Capsule]),
    ("file", &[BodyShape::Mesh]),
    ("animation", &[BodyShape::Mesh]),
    ("rate", &[BodyShape::Mesh]),
    ("repeat", &[BodyShape::Mesh]),
    ("turn", &[BodyShape::Mesh]),
    ("size", &[BodyShape::Mesh]),
];

/// A body as a preset or a script lists it.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedBody {
    /// What is said of it.
    pub section: BodySection,
    /// Where that stands, and its file's name; nowhere where a program says it, or has set another file.
    place: Option<Place>,
}

impl From<BodySection> for NamedBody {
    /// One that a program says.
    fn from(section: BodySection) -> Self {
        Self {
            section,
            place: None,
        }
    }
}

impl NamedBody {
    /// Reads the list `bodies`.
    pub(crate) fn read_list<'a>(reader: &mut Reader<'a>, list: &'a str) -> Vec<Self> {
        if list.starts_with('(') {
            reader.error(
                list,
                format!("bodies is a list, of one body too: {WRITTEN}"),
            );
            return Vec::new();
        }
        let items = reader.list(list, "bodies");
        if items.len() > MOST_BODIES {
            let count = items.len();
            let message =
                format!("bodies: there are {count}, and hair is kept out of {MOST_BODIES} at most");
            reader.error(list, message);
            return Vec::new();
        }
        let mut names = HashSet::new();
        let mut read = |item: &'a str| {
            let fields = reader.fields(item, "a body");
            let section: BodySection = reader.section_of(&fields, "a body");
            check_shape(reader, item, &fields, &section);
            let name = fields.iter().find(|field| field.name == "name");
            if let (Some(field), Some(name)) = (name, &section.name)
                && !names.insert(name.clone())
            {
                reader.error(field.value, format!("name: two bodies are called `{name}`"));
            }
            let file = fields.iter().find(|field| field.name == "file");
            Self {
                place: Some(reader.place(file.map_or(item, |file| file.value))),
                section,
            }
        };
        items.iter().map(|item| read(item)).collect()
    }

    /// What is wrong with the name of its file.
    pub(crate) fn missing(&self, folder: &Path) -> Option<PresetError> {
        let is_mesh = self.section.shape == BodyShape::Mesh;
        if !is_mesh || self.section.is_sequence() {
            return None;
        }
        let message = missing(folder, "file", self.section.file.as_ref()?)?;
        self.mistake(message)
    }

    /// What is wrong with its file, which can't be read because of `error`.
    pub(crate) fn unread(&self, folder: &Path, error: &StageError) -> Option<PresetError> {
        let missing = self.missing(folder);
        missing.or_else(|| self.mistake(format!("file: {error}")))
    }

    /// Sets a parameter of what `owner` calls it from its text.
    pub(crate) fn set(&mut self, owner: &str, param: &str, text: &str) -> Result<(), SetError> {
        set_text(&mut self.section, owner, param, text)?;
        if param == "file" {
            self.place = None;
        }
        Ok(())
    }

    /// The files that the caller has set, which preset and script don't name.
    pub(crate) fn files_set(&self, folder: &Path) -> Vec<PathBuf> {
        match self.place {
            Some(_) => Vec::new(),
            None => self.section.files(folder),
        }
    }

    /// A mistake where its file is named; none where a program says it.
    pub(crate) fn mistake(&self, message: String) -> Option<PresetError> {
        let place = self.place.clone()?;
        Some(PresetError { place, message })
    }
}

impl BodySection {
    /// Its file, of a preset or script in `folder`.
    pub(crate) fn path(&self, folder: &Path) -> Option<PathBuf> {
        let is_mesh = self.shape == BodyShape::Mesh;
        Some(folder.join(self.file.as_deref()?)).filter(|_| is_mesh)
    }

    /// All files that it is read from.
    pub(crate) fn files(&self, folder: &Path) -> Vec<PathBuf> {
        let path = self.path(folder);
        path.map_or_else(Vec::new, |path| all_files(path, self.is_sequence()))
    }

    /// Whether it has numbered files.
    pub(crate) fn is_sequence(&self) -> bool {
        self.file.as_deref().is_some_and(is_sequence)
    }
}

/// Reports what a body of this shape lacks or hasn't.
fn check_shape<'a>(
    reader: &mut Reader<'a>,
    item: &'a str,
    fields: &[Field<'a>],
    section: &BodySection,
) {
    // What stays as it would be without a word says nothing.
    let says = |name: &str| {
        let index = BodySection::TABLE
            .iter()
            .position(|param| param.name == name);
        index.is_some_and(|index| section.get(index) != BodySection::default().get(index))
    };
    for field in fields.iter().filter(|field| says(field.name)) {
        let of = OF_SHAPES.iter().find(|(name, _)| *name == field.name);
        if let Some((name, shapes)) = of.filter(|(_, shapes)| !shapes.contains(&section.shape)) {
            let shapes: Vec<&str> = shapes.iter().map(|shape| shape.name()).collect();
            let shape = section.shape.name();
            let message = format!("{name}: a {shape} has none, only {}", shapes.join(" and "));
            reader.error(field.name, message);
        }
    }
    if section.shape == BodyShape::Mesh && section.file.is_none() {
        reader.error(
            item,
            "a body of shape mesh needs `file: \"...\"`, which holds it",
        );
    }
    let has = |name: &str| fields.iter().find(|field| field.name == name);
    if let (Some(animation), true) = (has("animation"), section.is_sequence()) {
        reader.error(
            animation.name,
            "animation: numbered files are forms already: one of them",
        );
    }
}

/// A key of a body as a script writes it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NamedKey {
    pub section: BodyKeySection,
    /// Where the body is named.
    place: Place,
}

impl NamedKey {
    /// Reads one of `body_keys`.
    pub fn read<'a>(reader: &mut Reader<'a>, item: &'a str) -> Self {
        let fields = reader.fields(item, "a key of a body");
        let section: BodyKeySection = reader.section_of(&fields, "a key of a body");
        let body = fields.iter().find(|field| field.name == "body");
        if body.is_none() {
            reader.error(
                item,
                "a key of a body needs `body: \"...\"`, the body's name",
            );
        }
        Self {
            place: reader.place(body.map_or(item, |body| body.value)),
            section,
        }
    }

    /// The name of its body.
    pub fn body(&self) -> &str {
        self.section.body.as_deref().unwrap_or_default()
    }

    /// That its body is not among these.
    pub fn unknown<'n>(&self, names: impl Iterator<Item = &'n str> + Clone) -> PresetError {
        let hint = suggestion(self.body(), names.clone());
        let body = self.body();
        let message = match names.count() {
            0 => format!(
                "body: neither the script nor the preset has a body `{body:.40}`, as they have none with a name"
            ),
            _ => format!("body: neither the script nor the preset has a body `{body:.40}`{hint}"),
        };
        let place = self.place.clone();
        PresetError { place, message }
    }

    /// That its body does not come round in a loop of so many seconds.
    pub fn open(&self, period: f64) -> PresetError {
        let message = format!(
            "body: `{:.40}` ends elsewhere than it begins, and the script goes round: its keys at 0 s and at {period} s must be alike",
            self.body()
        );
        let place = self.place.clone();
        PresetError { place, message }
    }

    /// That its time is not after the one before it.
    pub fn late(&self) -> PresetError {
        PresetError {
            place: self.place.clone(),
            message: format!(
                "time: the keys of the body `{:.40}` must ascend",
                self.body()
            ),
        }
    }
}
