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

impl MeshError {
    fn format(path: &Path) -> Self {
        Self::Format {
            path: path.into(),
            found: ending(path),
        }
    }

    fn ply(path: &Path, source: PlyError) -> Self {
        Self::Ply {
            path: path.into(),
            source,
        }
    }

    #[cfg(feature = "gltf")]
    fn gltf(path: &Path, source: GltfError) -> Self {
        Self::Gltf {
            path: path.into(),
            source: Box::new(source),
        }
    }
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

/// The files that a file of meshes names, in its folder or below. They need not be there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedFiles {
    /// Those that hold the numbers of meshes and animations: buffers of glTF.
    pub buffers: Vec<PathBuf>,
    /// Those of materials and pictures.
    pub paint: Vec<PathBuf>,
}

/// What else is read where a file of meshes is, without reading its meshes.
///
/// # Errors
///
/// When the file cannot be read, is of another format, or does not even begin as one of its own.
pub fn named_files(path: &Path) -> Result<NamedFiles, MeshError> {
    let bytes = read_bytes(path, MOST_OF_DATA)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    match Format::of(path, &bytes) {
        Some(Format::Obj) => Ok(obj::named_files(&String::from_utf8_lossy(&bytes), folder)),
        Some(Format::Ply) => ply::named_files(&bytes, folder).map_err(|e| MeshError::ply(path, e)),
        #[cfg(feature = "gltf")]
        Some(Format::Gltf) => {
            crate::gltf::named_files(&bytes, folder).map_err(|e| MeshError::gltf(path, e))
        }
        #[cfg(not(feature = "gltf"))]
        Some(Format::Gltf) => Err(MeshError::WithoutGltf(path.into())),
        None => Err(MeshError::format(path)),
    }
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
        Some(Format::Ply) => ply::from_bytes(bytes, folder).map_err(|e| MeshError::ply(path, e)),
        #[cfg(feature = "gltf")]
        Some(Format::Gltf) => {
            crate::gltf::from_bytes(bytes, folder).map_err(|e| MeshError::gltf(path, e))
        }
        #[cfg(not(feature = "gltf"))]
        Some(Format::Gltf) => Err(MeshError::WithoutGltf(path.into())),
        None => Err(MeshError::format(path)),
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
        read(&bytes, folder).map_err(|e| MeshError::gltf(path, e))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_a_file_of_meshes_names_is_told_without_its_meshes() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("sub")).unwrap();
        for name in ["sub/skin.png", "up.png"] {
            fs::write(path(name), "").unwrap();
        }
        fs::write(path("sub/a.mtl"), "newmtl skin\nmap_Kd skin.png\n").unwrap();
        let named = |name: &str, text: &str| {
            fs::write(path(name), text).unwrap();
            named_files(&path(name))
        };
        let paint = |names: &[&str]| NamedFiles {
            paint: names.iter().map(|name| path(name)).collect(),
            ..NamedFiles::default()
        };

        // One library isn't there, and one is out of the folder.
        let obj = "v 0 0 0\n  mtllib sub/a.mtl\nmtllib gone.mtl\nmtllib ../b.mtl\nusemtl skin\n";
        let files = paint(&["sub/a.mtl", "gone.mtl", "sub/skin.png"]);
        assert_eq!(named("a.obj", obj).unwrap(), files);

        let ply = "ply\nformat ascii 1.0\ncomment TextureFile up.png\nend_header\n";
        assert_eq!(named("a.ply", ply).unwrap(), paint(&["up.png"]));
        assert!(named("b.ply", "no ply").is_err());

        let gltf = r#"{
            "asset": {"version": "2.0"},
            "buffers": [{"uri": "my%20a.bin"}, {"uri": "data:,"}, {"uri": "../b.bin"}, {}],
            "images": [{"uri": "sub/skin.png"}, {"bufferView": 0}]
        }"#;
        let found = named("a.gltf", gltf);
        #[cfg(feature = "gltf")]
        assert_eq!(
            found.unwrap(),
            NamedFiles {
                buffers: vec![path("my a.bin")],
                ..paint(&["sub/skin.png"])
            }
        );
        #[cfg(not(feature = "gltf"))]
        assert!(matches!(found, Err(MeshError::WithoutGltf(_))));
        assert!(matches!(
            named("a.stl", "solid"),
            Err(MeshError::Format { .. })
        ));
    }
}
