//! Files: choosing the reader, and the errors that name the file.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use glam::Vec3;
use hair_sim::{Motion, Strands};

use crate::mesh::Mesh;
use crate::obj::{self, ObjError};
use crate::orient::{self, Axes, Given, Orientation};
use crate::skeleton::SkeletonError;
use crate::strands_ron::{self, StrandsRonError};
use crate::tfx::{self, TfxError};

/// The hair formats that this build reads, for messages.
const HAIR_FORMATS: &str = "TressFX (.tfx) and own strands (.strands.ron)";
/// The head formats that this build reads, for messages.
const HEAD_FORMATS: &str = "Wavefront OBJ (.obj)";

/// Why a hair or head file could not be read or written. Every message names the file.
#[derive(Debug, thiserror::Error)]
pub enum HairError {
    /// The file system refused.
    #[error("{}: {source}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A format that is not read.
    #[error("{}: {found} is not a format that this build reads; it reads {reads}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What the file seems to be.
        found: String,
        /// What can be read.
        reads: &'static str,
    },
    /// A TressFX file with errors.
    #[error("{}: {source}", path.display())]
    Tfx {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        source: TfxError,
    },
    /// A strands file with errors.
    #[error("{}: {source}", path.display())]
    StrandsRon {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        source: StrandsRonError,
    },
    /// A text that is not UTF-8.
    #[error("{}: byte {at}: the text is not UTF-8", path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// The first byte that is not.
        at: usize,
    },
    /// An OBJ file with errors.
    #[error("{}: {source}", path.display())]
    Obj {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        source: ObjError,
    },
    /// A character that gives no motion.
    #[error("{}: {source}", path.display())]
    Skeleton {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        source: Box<SkeletonError>,
    },
    /// A scale that is no number above 0, or that makes positions too large for numbers.
    #[error(
        "{}: the scale {scale} m a unit is not above 0, or too large for the positions",
        path.display()
    )]
    Scale {
        /// The file.
        path: PathBuf,
        /// Metres a unit.
        scale: f32,
    },
}

/// How to read a hair file.
#[derive(Clone, Copy, Debug, Default)]
pub struct HairOptions<'a> {
    /// What is known of the file's axes and units.
    pub given: Given,
    /// The head that the hair belongs to, as [`read_head`] gives it, to guess the rest from.
    pub head: Option<&'a Mesh>,
}

/// What a hair file holds: Y up, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct HairFile {
    /// The strands.
    pub strands: Strands,
    /// Their played-back motion, of the same points, where the file has one.
    pub motion: Option<Motion>,
    /// Sentences to print: what was guessed or left out.
    pub notes: Vec<String>,
}

impl HairFile {
    /// Keeps the strands at these indices, in this order, with their motion.
    ///
    /// # Panics
    ///
    /// When an index is not below the number of strands.
    pub fn keep(&mut self, indices: &[usize]) {
        if let Some(motion) = &self.motion {
            let points: Vec<_> = indices
                .iter()
                .flat_map(|&i| self.strands.point_range(i))
                .collect();
            self.motion = Some(motion.select(&points));
        }
        self.strands = self.strands.select(indices);
    }
}

/// What a head file holds: Y up, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadFile {
    /// The head, bust or body.
    pub mesh: Mesh,
    /// Sentences to print: what was guessed or left out.
    pub notes: Vec<String>,
}

/// Reads a hair file. The reader is chosen by the name's ending, else by the file's first bytes.
///
/// # Errors
///
/// When the file cannot be read, is of another format, or has errors.
pub fn read_hair(path: &Path, options: &HairOptions) -> Result<HairFile, HairError> {
    let (mut strands, mut motion, unspecified) = match hair_format(path)? {
        Format::Tfx => (tfx::from_path(path)?, None, true),
        Format::StrandsRon => {
            let text = String::from_utf8(read_bytes(path)?).map_err(|e| HairError::Text {
                path: path.into(),
                at: e.utf8_error().valid_up_to(),
            })?;
            let (strands, motion) =
                strands_ron::from_text(&text).map_err(|source| HairError::StrandsRon {
                    path: path.into(),
                    source,
                })?;
            (strands, motion, false)
        }
    };
    let (orientation, note) = if unspecified {
        orient::hair(&strands, options.head, &options.given)
    } else {
        orient::known_hair(&strands, &options.given)
    };

    strands
        .points_mut()
        .iter_mut()
        .for_each(|p| *p = orientation.apply(*p));
    check_finite(path, &orientation, strands.points())?;
    if let Some(motion) = &mut motion {
        motion.map_points(|p| orientation.apply(p));
        let mut positions = vec![Vec3::ZERO; strands.points().len()];
        for &time in motion.times() {
            motion.sample(time, &mut positions);
            check_finite(path, &orientation, &positions)?;
        }
    }
    Ok(HairFile {
        strands,
        motion,
        notes: vec![note],
    })
}

/// Reads a head, bust or body. `up` and `scale` (metres a unit) override what would be guessed.
///
/// # Errors
///
/// When the file cannot be read, is of another format, or has errors.
pub fn read_head(path: &Path, up: Option<Axes>, scale: Option<f32>) -> Result<HeadFile, HairError> {
    let ending = ending(path);
    if ending != "obj" {
        let bytes = read_bytes(path)?;
        let found = known_format(&ending, &bytes);
        return Err(HairError::Format {
            path: path.into(),
            found,
            reads: HEAD_FORMATS,
        });
    }
    let (mut mesh, left_out) = obj::from_path(path)?;
    let (orientation, note) = orient::head(
        &mesh,
        &Given {
            up,
            scale,
            offset: None,
        },
    );
    mesh.positions
        .iter_mut()
        .for_each(|p| *p = orientation.apply(*p));
    mesh.normals
        .iter_mut()
        .for_each(|n| *n = orientation.up.to_y_up(*n));
    check_finite(path, &orientation, &mesh.positions)?;
    Ok(HeadFile {
        mesh,
        notes: left_out.into_iter().chain([note]).collect(),
    })
}

/// Writes strands and their motion as a strands file (see [`strands_ron`]): beside its place first,
/// then renamed, so that no half-written file is left.
///
/// # Errors
///
/// When the file cannot be written.
///
/// # Panics
///
/// When the motion is not of these strands' number of points.
pub fn write_strands(
    path: &Path,
    strands: &Strands,
    motion: Option<&Motion>,
) -> Result<(), HairError> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.part", std::process::id()));
    let part = path.with_file_name(name);
    let text = strands_ron::to_text(strands, motion);
    fs::write(&part, text)
        .and_then(|()| fs::rename(&part, path))
        .map_err(|source| {
            let _ = fs::remove_file(&part); // the first error is the one to tell
            HairError::Open {
                path: path.into(),
                source,
            }
        })
}

pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, HairError> {
    fs::read(path).map_err(|source| HairError::Open {
        path: path.into(),
        source,
    })
}

fn check_finite(path: &Path, orientation: &Orientation, points: &[Vec3]) -> Result<(), HairError> {
    if orientation.scale > 0.0 && points.iter().all(|p| p.is_finite()) {
        return Ok(());
    }
    Err(HairError::Scale {
        path: path.into(),
        scale: orientation.scale,
    })
}

enum Format {
    Tfx,
    StrandsRon,
}

fn hair_format(path: &Path) -> Result<Format, HairError> {
    let ending = ending(path);
    match ending.as_str() {
        "tfx" => return Ok(Format::Tfx),
        "ron" => return Ok(Format::StrandsRon),
        _ => {}
    }
    let bytes = read_bytes(path)?;
    if bytes.starts_with(&4.0f32.to_le_bytes()) {
        return Ok(Format::Tfx);
    }
    let found = known_format(&ending, &bytes);
    Err(HairError::Format {
        path: path.into(),
        found,
        reads: HAIR_FORMATS,
    })
}

fn ending(path: &Path) -> String {
    path.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase()
}

/// What a file that is not read seems to be, by its first bytes, else by its name's ending.
fn known_format(ending: &str, bytes: &[u8]) -> String {
    let magic: [(&[u8], &str); 8] = [
        (b"PXR-USDC", "USD"),
        (b"#usda", "USD"),
        (b"Ogawa", "Alembic"),
        (b"\x89HDF", "Alembic (HDF5)"),
        (b"glTF", "glTF"),
        (b"HAIR", "Cem Yuksel's .hair"),
        (b"ply\n", "PLY"),
        (b"ply\r", "PLY"),
    ];
    if let Some((_, name)) = magic.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return (*name).to_string();
    }
    let name = match ending {
        "usd" | "usda" | "usdc" | "usdz" => "USD",
        "abc" => "Alembic",
        "gltf" | "glb" => "glTF",
        "vrm" => "VRM",
        "hair" => "Cem Yuksel's .hair",
        "data" => "USC-HairSalon's .data",
        "ply" => "PLY",
        "obj" => "Wavefront OBJ",
        "tfx" => "TressFX",
        "" => "a file without an ending",
        other => return format!("\".{other}\""),
    };
    name.to_string()
}
