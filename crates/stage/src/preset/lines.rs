//! The lines of a preset: of which meshes which lines are drawn.

use crate::names::Names;
use crate::part::FilePart;
use effects::preset::{Place, PresetError, Reader, suggestion};
use effects::section;
use mesh_lines::Kind;

/// The most lists of lines of a preset.
const MOST_LINES: usize = 64;

/// How the list is written, for those who write something else.
const WRITTEN: &str = "lines: [(name: \"rim\", of: \"skin, dress\", kind: \"contour\"), ...]";

/// What the kinds are called.
const CONTOUR: &str = "contour";
const CREASE: &str = "crease";
const BORDER: &str = "border";

section! {
    /// Lines of meshes, which layers `on:` them draw as strokes: tapered, in the order of hair. A list.
    pub struct LineSection {
        /// What layers call them: `on: "rim"`.
        name: Option<String> = text(),
        /// Of which meshes, as layers for meshes name them: skin, dress, ties, names of a file's meshes, with commas between them, `*` for any end. Without
        /// it all.
        of: Option<String> = text(),
        /// Which lines, with commas between them: contour, where a surface turns away from the eye; crease, where it has an edge; border, where it
        /// ends. Without it contour and border.
        kind: Option<String> = text(),
        /// From what angle between the two sides of an edge on it is a crease.
        crease: f32 = number(40.0, 1.0..=179.0).unit("degrees"),
        /// How much is left out of a line where something nearer hides the rest of it.
        halo: f32 = number(0.0, 0.0..=50.0).unit("1/300 head height"),
        /// Lines that are shorter, as they are seen, are left out.
        shortest: f32 = number(8.0, 0.0..=300.0).unit("1/300 head height"),
    }
}

/// The list of lines, as `inkstrand effects` and the viewer show it.
pub const LINES: FilePart = FilePart {
    name: "lines",
    doc: LineSection::DOC,
    example: WRITTEN,
    table: LineSection::TABLE,
    places: &[],
};

/// Lines as a preset lists them.
#[derive(Clone, Debug)]
pub struct NamedLines {
    /// What is said of them.
    pub section: LineSection,
    /// Where they stand, and where their meshes are named.
    place: Place,
    of: Option<Place>,
}

/// Which lines are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LineKinds {
    pub contour: bool,
    pub crease: bool,
    pub border: bool,
}

impl LineKinds {
    /// Whether lines of a kind are among them.
    pub(crate) fn have(self, kind: Kind) -> bool {
        match kind {
            Kind::Contour => self.contour,
            Kind::Crease => self.crease,
            Kind::Border => self.border,
        }
    }
}

impl NamedLines {
    /// Reads the list `lines` of a preset.
    pub(super) fn read_list<'a>(reader: &mut Reader<'a>, list: &'a str) -> Vec<Self> {
        if list.starts_with('(') {
            let message = format!("lines is a list, of one item too: {WRITTEN}");
            reader.error(list, message);
            return Vec::new();
        }
        let items = reader.list(list, "lines");
        if items.len() > MOST_LINES {
            let count = items.len();
            let message = format!("lines: there are {count}, and at most {MOST_LINES} are drawn");
            reader.error(list, message);
            return Vec::new();
        }
        let mut all: Vec<Self> = Vec::new();
        for item in items {
            let fields = reader.fields(item, "lines");
            let section: LineSection = reader.section_of(&fields, "lines");
            let field = |name| fields.iter().find(|field| field.name == name);
            if let Some(kind) = field("kind")
                && let Err(message) = section.kinds()
            {
                reader.error(kind.value, message);
            }
            match (&section.name, field("name")) {
                (Some(name), Some(field))
                    if name.trim().is_empty() || name.contains([',', '*']) =>
                {
                    let message = "name: one word, by which layers call the lines: name: \"rim\"";
                    reader.error(field.value, message);
                }
                (Some(name), Some(field)) if all.iter().any(|other| other.is_called(name)) => {
                    let message = format!("there are already lines called `{name:.100}`");
                    reader.error(field.value, message);
                }
                (_, None) => {
                    let message = "lines need `name: \"...\"`, by which layers call them";
                    reader.error(item, message);
                }
                _ => {}
            }
            all.push(Self {
                place: reader.place(item),
                of: field("of").map(|of| reader.place(of.value)),
                section,
            });
        }
        all
    }

    /// Whether a layer that says that name means these.
    pub(crate) fn is_called(&self, name: &str) -> bool {
        self.section
            .name
            .as_deref()
            .is_some_and(|own| own.eq_ignore_ascii_case(name))
    }

    /// A mistake where its meshes are named.
    pub(crate) fn mistake(&self, message: String) -> PresetError {
        let place = self.of.clone().unwrap_or_else(|| self.place.clone());
        PresetError { place, message }
    }
}

impl LineSection {
    /// The names of their meshes.
    pub(crate) fn meshes(&self) -> Names<'_> {
        Names(self.of.as_deref().unwrap_or("*"))
    }

    /// Which lines are meant.
    ///
    /// # Errors
    ///
    /// What is no kind of line, and what it may mean.
    pub(crate) fn kinds(&self) -> Result<LineKinds, String> {
        let Some(text) = &self.kind else {
            return Ok(LineKinds {
                contour: true,
                crease: false,
                border: true,
            });
        };
        let names = Names(text);
        let all = [CONTOUR, CREASE, BORDER];
        if let Some(unknown) = names.iter().find(|name| !all.contains(name)) {
            let hint = suggestion(unknown, all);
            return Err(format!(
                "kind: there are no lines of the kind `{unknown:.40}`{hint}"
            ));
        }
        if names.is_empty() {
            return Err("kind: it names no lines; there are contour, crease and border".to_owned());
        }
        let has = |kind| names.iter().any(|name| name == kind);
        Ok(LineKinds {
            contour: has(CONTOUR),
            crease: has(CREASE),
            border: has(BORDER),
        })
    }
}
