//! What the caller gives a scene beside the preset, and why there is none.

use crate::heads::Heads;
use crate::textures::Textures;
use effects::preset::nearest;
use hair_io::{MOST_OF_TEXT, ReadError};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files that the caller gives in place of the preset's.
#[derive(Clone, Debug, Default)]
pub struct Files {
    /// The folder that the preset's own file names are relative to.
    pub preset_folder: PathBuf,
    /// Hair, relative to the current folder.
    pub hair: Option<PathBuf>,
    /// Head, relative to the current folder.
    pub head: Option<PathBuf>,
    /// Baked motion of the hair, relative to the current folder.
    pub bake: Option<PathBuf>,
    /// A motion script, relative to the current folder.
    pub motion: Option<PathBuf>,
    /// Texts in place of those that styles and motion scripts have on the disk: what an editor has not saved yet. Paths are as a scene
    /// reads them: the folder of what names the file, and the name.
    pub texts: BTreeMap<PathBuf, Arc<str>>,
    /// Pictures of textures that were read, for whoever makes many looks: copies share them.
    pub textures: Textures,
    /// Heads that were made, for whoever loads many scenes: copies share them.
    pub heads: Heads,
}

impl Files {
    /// The text of a style or script.
    pub(crate) fn read_text(&self, path: &Path) -> Result<Arc<str>, ReadError> {
        match self.texts.get(path) {
            Some(text) => Ok(text.clone()),
            None => Ok(hair_io::read_text(path, MOST_OF_TEXT)?.into()),
        }
    }
}

/// What is wrong with a path where no file is: with the name of its folder that is most like it, of a file of its kind, or else with
/// `hint` at the end.
pub fn no_file(path: &Path, hint: &str) -> Option<String> {
    if path.is_file() {
        return None;
    }
    let shown = path.display();
    if path.is_dir() {
        return Some(format!("`{shown}` is a folder, not a file"));
    }
    if path.exists() {
        return Some(format!("`{shown}` is a pipe or a device, not a file"));
    }
    let folder = hair_io::folder_of(path);
    let Ok(entries) = std::fs::read_dir(folder) else {
        let folder = folder.display();
        return Some(format!(
            "there is no `{shown}`, nor a folder `{folder}`{hint}"
        ));
    };
    let mut names: Vec<String> = entries
        .flatten()
        .filter(|entry| entry.path().is_file())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let wrong = path.file_name().unwrap_or_default().to_string_lossy();
    let hint = meant_file(&wrong, &names).map_or_else(
        || hint.to_owned(),
        |near| format!(", did you mean `{near}`?"),
    );
    Some(format!("there is no `{shown}`{hint}"))
}

/// The file that a wrong name may mean. It has the same ending: nobody who names a picture means a look, nor one who names a style. What
/// stands before the ending is near, since all names of a kind are alike with it.
fn meant_file<'n>(wrong: &str, names: &'n [String]) -> Option<&'n str> {
    let wrong = wrong.to_lowercase();
    let ending = ending(&wrong);
    let of_kind = names.iter().filter_map(|name| {
        let stem = name.to_lowercase().strip_suffix(ending)?.to_owned();
        Some((stem, name))
    });
    let of_kind: Vec<(String, &String)> = of_kind.collect();
    let stem = wrong.strip_suffix(ending)?;
    let near = nearest(stem, of_kind.iter().map(|(stem, _)| stem.as_str()))?;
    let meant = of_kind.iter().find(|(stem, _)| stem == near);
    meant.map(|(_, name)| name.as_str())
}

/// What of a file's name, in lower case, says its kind: `.style.ron` and the like, else what follows the last dot. Of a mere `.ron` that is
/// any file in it, as one may forget the rest.
fn ending(name: &str) -> &str {
    let kinds = [".style.ron", ".strands.ron", ".motion.ron"];
    let of_two_parts = kinds.into_iter().find(|kind| name.ends_with(kind));
    of_two_parts.unwrap_or_else(|| name.rfind('.').map_or("", |dot| &name[dot..]))
}

/// Why there is no frame.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StageError {
    /// The hair or head could not be read.
    #[error(transparent)]
    File(#[from] hair_io::HairError),
    /// The character that moves the head could not be read.
    #[error(transparent)]
    Character(#[from] hair_io::MeshError),
    /// Neither the preset nor the caller names strands.
    #[error(
        "the preset names no hair: give one with --hair FILE, or hair: (file: \"...\") in the preset"
    )]
    NoHair,
    /// A style grows on a head.
    #[error("{}: a style needs a head to grow on: --head FILE, or head: (shape: bust) in the preset", .0.display())]
    NoHead(PathBuf),
    /// A file has no mesh of a name that the preset says.
    #[error("{}: no mesh, material or bone is called `{name}`{hint}", .path.display())]
    NoMesh {
        /// The file.
        path: PathBuf,
        /// As the preset says it.
        name: String,
        /// What it may have meant.
        hint: String,
    },
    /// A layer draws on zones of the hair that aren't there.
    #[error("{layer}.zones: {message}")]
    Zones {
        /// The layer's name.
        layer: String,
        /// What is wrong.
        message: String,
    },
    /// Layers are drawn on too many kinds of things.
    #[error("the scene's layers have {0} different texts as their `clip`: {1} are possible")]
    Clips(usize, usize),
    /// A layer paints meshes that aren't there, or is drawn on them.
    #[error("{layer}.{message}")]
    MeshLayer {
        /// The layer's name.
        layer: String,
        /// What is wrong.
        message: String,
    },
    /// Lines of meshes can't be found.
    #[error("lines: {0}")]
    Lines(String),
    /// A file has no mesh and no bone of a name that the preset says of its hair.
    #[error("{}: no mesh, material or spring bone is called `{name}`{hint}", .path.display())]
    NoMeshOrBone {
        /// The file.
        path: PathBuf,
        /// As the preset says it.
        name: String,
        /// What it may have meant.
        hint: String,
    },
    /// A character does not move by itself.
    #[error("{}: {message}", .path.display())]
    Skeleton {
        /// The file.
        path: PathBuf,
        /// What is missing or broken.
        message: String,
    },
    /// A head that has no skeleton, or is not drawn by it.
    #[error(
        "`motion.character` moves the meshes of the head's own file: head: (file: \"...\", colors: file)"
    )]
    NoCharacter,
    /// A character has no hair of its own.
    #[error(
        "{}: no mesh or material is called hair and no spring bones hang on the head, or nothing of them is a lock: `hair.meshes` says what is hair", .0.display()
    )]
    NoMeshHair(PathBuf),
    /// Hair is of a head's file, and there is none.
    #[error(
        "`hair.from: character` takes the hair of the head's file: --character FILE, or head: (file: \"...\")"
    )]
    NoHeadsHair,
    /// All of a head is its hair.
    #[error("{}: all that is not hidden became hair, and no head is left: `hair.keep` says what stays", .0.display())]
    AllHair(PathBuf),
    /// Nothing is left of a head.
    #[error("{}: `head.hide` hides all of its meshes", .0.display())]
    AllHidden(PathBuf),
    /// Meshes move with a head.
    #[error(
        "the preset lists `meshes` beside hair and has no head that both are on: --head FILE, or head: (shape: bust)"
    )]
    MeshesWithoutHead,
    /// A mesh has no places for a picture.
    #[error("{}: it has no texture coordinates, by which a picture lies on it", .0.display())]
    NoPlaces(PathBuf),
    /// A picture that the preset names cannot be read.
    #[error("{} {message}", .path.display())]
    PictureFile {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// A mesh's picture cannot be read.
    #[error("{}: picture `{name}` {message}", .path.display())]
    Picture {
        /// The file of the mesh.
        path: PathBuf,
        /// The picture's name.
        name: String,
        /// What is wrong.
        message: String,
    },
    /// Numbered files are not there, or one of them cannot be read.
    #[error(transparent)]
    Sequence(#[from] mesh_io::SequenceError),
    /// Numbered files are no mesh that takes one form after the other.
    #[error("{}: {message}", .path.display())]
    Numbered {
        /// The files, as the preset names them.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// The mesh of a body is none that hair can be kept out of.
    #[error("{}: {message}", .path.display())]
    Body {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// A style or motion script cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A style or motion script has mistakes.
    #[error(transparent)]
    Mistakes(#[from] effects::preset::PresetErrors),
    /// A strand cannot be simulated.
    #[error("dynamics: {0}")]
    Strand(#[from] hair_sim::StrandError),
    /// The simulation refuses its parameters or a step.
    #[error("dynamics: {0}")]
    Dynamics(#[from] hair_sim::DynamicsError),
    /// What a section asks for cannot be: the solver has none of it, or the section contradicts itself.
    #[error("{section}: {message}")]
    Unsupported {
        /// The section.
        section: &'static str,
        /// Which parameter, and why.
        message: String,
    },
    /// A layer measures the distance to the light.
    #[error(
        "layer `{0}` goes by the distance to the light, and this light has no place: \
         light: (kind: point, distance: ...)"
    )]
    NoPointLight(String),
    /// A section has a value that it doesn't take.
    #[error("{section}.{error}")]
    Section {
        /// The section.
        section: &'static str,
        /// Which value, and what it may be.
        error: effects::section::OutOfRange,
    },
    /// A scene has one object or more, and an index is one of theirs.
    #[error("there is no such object in the scene")]
    NoObject,
    /// All strokes of a picture are made of one kind of disc.
    #[error(
        "the objects have different brushes, and a picture has one: path: (brush: ...) of their presets"
    )]
    Brushes,
    /// What objects have is said by their own presets.
    #[error(
        "the preset names objects: hair, head, motion, dynamics, path, clump and layers are given in their presets, not beside them"
    )]
    OfObjects,
    /// A bake is of one head of hair.
    #[error(
        "the preset names objects ({0}): simulate each one's own preset, which then names its bake"
    )]
    BakeOfObjects(usize),
    /// An effect made paths that are none.
    #[error("layer `{layer}`: {what}")]
    MadePaths {
        /// The layer's name.
        layer: String,
        /// What is wrong with them.
        what: String,
    },
    /// A loop of too many frames.
    #[error(
        "loop: {frames} frames of {points} points are more than are kept; a shorter `period`, fewer frames a second or fewer `guides` help"
    )]
    Loop {
        /// How many frames.
        frames: usize,
        /// Points of each.
        points: usize,
    },
    /// A picture that a layer names can't be used.
    #[error("layer `{layer}`: {message}")]
    Texture {
        /// The layer's name.
        layer: String,
        /// The file, and what is wrong with it.
        message: String,
    },
    /// Two strands of a program's own have this id.
    #[error("two strands have the id {0}")]
    SameId(u32),
    /// A file is no bake of the scene's hair.
    #[error("{}: it is not a bake of this hair: {what}", path.display())]
    OtherHair {
        /// The file.
        path: PathBuf,
        /// Where it differs.
        what: String,
    },
    /// A bake of the scene's hair that something else moved.
    #[error("{}: it is not a bake of this motion: {what}; `inkstrand simulate` makes a new one", path.display())]
    OtherMotion {
        /// The file.
        path: PathBuf,
        /// Where it differs.
        what: String,
    },
    /// A time that a bake does not have.
    #[error("{}: the bake goes from frame {first} to {last}, and frame {asked} is asked for", path.display())]
    BeyondBake {
        /// The file.
        path: PathBuf,
        /// Its first frame.
        first: String,
        /// Its last frame.
        last: String,
        /// The frame that it does not have.
        asked: String,
    },
    /// Frames that make no motion.
    #[error("bake: {0}")]
    Bake(hair_sim::PointCacheError),
    /// Key shapes that make no motion.
    #[error("shapes: {0}")]
    Shapes(hair_sim::PointCacheError),
    /// The camera cannot look like that.
    #[error(transparent)]
    Camera(#[from] stroke_path::CameraError),
    /// The paths cannot be made.
    #[error(transparent)]
    Path(#[from] stroke_path::PathError),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_offered_for_one_of_its_kind_alone() {
        let names = [
            "bob.strands.ron",
            "bob.style.ron",
            "link.ron",
            "look0.png",
            "skin.PNG",
        ]
        .map(String::from);
        for (wrong, near) in [
            ("bobb.style.ron", Some("bob.style.ron")),
            ("BOB2.Style.ron", Some("bob.style.ron")),
            ("skim.png", Some("skin.PNG")),
            ("look1.png", Some("look0.png")),
            // Who forgets the first part of the ending, or mistypes it.
            ("bob.ron", Some("bob.style.ron")),
            ("bob.stlye.ron", Some("bob.style.ron")),
            ("bob.strand.ron", Some("bob.strands.ron")),
            ("lnik.ron", Some("link.ron")),
            // The preset that names the style, and a style where a script is meant.
            ("link.style.ron", None),
            ("mine.style.ron", None),
            ("bob.motion.ron", None),
            // All that is alike is the ending.
            ("nope.png", None),
            ("mine.ron", None),
            ("look0.jpg", None),
            ("look0.obj", None),
        ] {
            assert_eq!(meant_file(wrong, &names), near, "{wrong}");
        }
    }

    #[test]
    fn a_file_that_is_not_there_is_told_with_the_nearest_or_a_hint() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["link.ron", "look0.png", "bob.style.ron"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let told = |name: &str| no_file(&folder.path().join(name), "; look there");
        assert_eq!(told("link.ron"), None);
        for (name, end) in [
            ("mine.style.ron", "mine.style.ron`; look there"),
            ("nope.png", "nope.png`; look there"),
            ("bo.style.ron", ", did you mean `bob.style.ron`?"),
        ] {
            let told = told(name).unwrap();
            assert!(told.ends_with(end), "{told}");
        }
        if cfg!(unix) {
            let told = no_file(Path::new("/dev/null"), "").unwrap();
            assert_eq!(told, "`/dev/null` is a pipe or a device, not a file");
        }
    }
}
