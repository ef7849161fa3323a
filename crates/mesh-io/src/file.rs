//! Files: choosing the reader.

use std::path::{Path, PathBuf};

use crate::model::Model;
use crate::obj::{self, ObjError};
use crate::ply::{self, PlyError};
use crate::read::{MOST_OF_DATA, ReadError, read_bytes, shown};
#[cfg(feature = "gltf")]
use crate::{BoneMotion, GltfError};

/// The formats that are read, for messages.
pub const FORMATS: &str = "Wavefront OBJ (.obj), PLY (.ply), glTF 2.0 (.gltf, .glb) and VRM (.vrm)";

/// Why a file of meshes could not be read. Every message names the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// It cannot be read at all.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A format that is not read.
    #[error("{}: \".{found}\" is no format of meshes that is read: {FORMATS}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Its name's ending.
        found: String,
    },
    /// An OBJ file with errors.
    #[error("{}", in_obj(path, source))]
    Obj {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        source: ObjError,
    },
    /// A PLY file with errors.
    #[error("{}", in_ply(path, source))]
    Ply {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        source: PlyError,
    },
    /// A glTF file with errors.
    #[cfg(feature = "gltf")]
    #[error("{}: {source}", path.display())]
    Gltf {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        source: Box<GltfError>,
    },
    /// Reading glTF is left out of this build.
    #[error("{}: this program was built without glTF, which is the feature `gltf`", .0.display())]
    WithoutGltf(
        /// The file.
        PathBuf,
    ),
}

/// `file:line: what`, which editors jump to.
fn in_obj(path: &Path, error: &ObjError) -> String {
    let path = path.display();
    match error {
        ObjError::At { line, problem } => format!("{path}:{line}: {problem}"),
        other @ ObjError::NoTriangles => format!("{path}: {other}"),
    }
}

fn in_ply(path: &Path, error: &PlyError) -> String {
    let path = path.display();
    match error {
        PlyError::Line { line, what } => format!("{path}:{line}: {what}"),
        other => format!("{path}: {other}"),
    }
}

/// How meshes are written.
#[derive(Clone, Copy, PartialEq)]
enum Format {
    Obj,
    Ply,
    Gltf,
}

impl Format {
    fn of(path: &Path, bytes: &[u8]) -> Option<Self> {
        match ending(path).as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "gltf" | "glb" | "vrm" => Some(Self::Gltf),
            _ if bytes.starts_with(b"glTF") => Some(Self::Gltf),
            _ if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") => Some(Self::Ply),
            _ => None,
        }
    }
}

/// A name's ending in small letters, without its point.
fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    shown(&ending.to_lowercase())
}

/// Whether a file is of a format that [`read_model`] reads, by its name's ending, else by its first bytes.
#[must_use]
pub fn is_model(path: &Path, bytes: &[u8]) -> bool {
    Format::of(path, bytes).is_some()
}

/// Reads a file of meshes. The reader is chosen by the name's ending, else by the file's first bytes.
///
/// # Errors
///
/// When the file cannot be read, is of another format, or has errors.
pub fn read_model(path: &Path) -> Result<Model, MeshError> {
    model_of_bytes(path, &read_bytes(path, MOST_OF_DATA)?)
}

/// The meshes of the bytes of the file `path`; other files that they name are read beside it.
///
/// # Errors
///
/// As of [`read_model`].
pub fn model_of_bytes(path: &Path, bytes: &[u8]) -> Result<Model, MeshError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    match Format::of(path, bytes) {
        // Names in the file may be in any encoding; its numbers are ASCII.
        Some(Format::Obj) => {
            obj::from_text(&String::from_utf8_lossy(bytes), folder).map_err(|source| {
                MeshError::Obj {
                    path: path.into(),
                    source,
                }
            })
        }
        Some(Format::Ply) => ply::from_bytes(bytes, folder).map_err(|source| MeshError::Ply {
            path: path.into(),
            source,
        }),
        #[cfg(feature = "gltf")]
        Some(Format::Gltf) => {
            crate::gltf::from_bytes(bytes, folder).map_err(|source| MeshError::Gltf {
                path: path.into(),
                source: Box::new(source),
            })
        }
        #[cfg(not(feature = "gltf"))]
        Some(Format::Gltf) => Err(MeshError::WithoutGltf(path.into())),
        None => Err(MeshError::Format {
            path: path.into(),
            found: ending(path),
        }),
    }
}

#[cfg(feature = "gltf")]
impl BoneMotion {
    /// Reads the bone named `bone` of a glTF 2.0 file (.glb, .gltf, .vrm), in the animation of this name or number (0
    /// first), or else in the first. The case of letters counts only where it tells bones apart.
    ///
    /// # Errors
    ///
    /// When the file cannot be read, or has no such bone or animation; always, where this crate is built without
    /// its feature `gltf`.
    pub fn read(path: &Path, bone: &str, animation: Option<&str>) -> Result<Self, MeshError> {
        Self::of_file(path, |bytes, folder| {
            Self::from_bytes(bytes, folder, bone, animation)
        })
    }

    /// The files beside a glTF 2.0 file that hold the numbers of its animations, each once; they need not be there.
    ///
    /// # Errors
    ///
    /// When the file cannot be read; always, where this crate is built without its feature `gltf`.
    pub fn files(path: &Path) -> Result<Vec<PathBuf>, MeshError> {
        Self::of_file(path, Self::files_of_bytes)
    }

    /// What is read of a file's bytes and of its folder.
    fn of_file<T>(
        path: &Path,
        read: impl FnOnce(&[u8], &Path) -> Result<T, GltfError>,
    ) -> Result<T, MeshError> {
        let bytes = read_bytes(path, MOST_OF_DATA)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        read(&bytes, folder).map_err(|source| MeshError::Gltf {
            path: path.into(),
            source: Box::new(source),
        })
    }
}
