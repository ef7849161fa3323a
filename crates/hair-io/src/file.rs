//! Files: choosing the reader, settling axes and units, and writing.

use std::path::{Path, PathBuf};

use glam::Vec3;
use hair_sim::{PointCache, Strands};

use crate::error::HairError;
use crate::format::{self, HAIR_FORMATS, HEAD_FORMATS, HairFormat};
use crate::mesh::Mesh;
use crate::orient::{self, Axes, Given, Orientation};
use crate::read::{MOST_OF_DATA, decode_text, read_bytes};
use crate::skeleton::BoneMotion;
use crate::whole_file::write_whole;
use crate::{obj, strands_ron, tfx};

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
    pub motion: Option<PointCache>,
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
    let bytes = read_bytes(path, MOST_OF_DATA)?;
    let format = HairFormat::of(path, &bytes).ok_or_else(|| HairError::Format {
        path: path.into(),
        found: format::guess(path, &bytes),
        reads: HAIR_FORMATS,
    })?;
    let (mut strands, mut motion, unspecified) = match format {
        HairFormat::Tfx => {
            let strands = tfx::from_bytes(&bytes).map_err(|source| HairError::Tfx {
                path: path.into(),
                source,
            })?;
            (strands, None, true)
        }
        HairFormat::StrandsRon => {
            let text = decode_text(path, bytes)?;
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
    let bytes = read_bytes(path, MOST_OF_DATA)?;
    if !format::is_obj(path) {
        return Err(HairError::Format {
            path: path.into(),
            found: format::guess(path, &bytes),
            reads: HEAD_FORMATS,
        });
    }
    // Names in the file may be in any encoding; its numbers are ASCII.
    let text = String::from_utf8_lossy(&bytes);
    let (mut mesh, left_out) = obj::from_text(&text).map_err(|source| HairError::Obj {
        path: path.into(),
        source,
    })?;
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
    motion: Option<&PointCache>,
) -> Result<(), HairError> {
    let text = strands_ron::to_text(strands, motion);
    write_whole(path, text.as_bytes()).map_err(|source| HairError::Write {
        path: path.into(),
        source,
    })
}

impl BoneMotion {
    /// Reads the bone named `bone` of a glTF 2.0 file (.glb, .gltf, .vrm), in the animation of this name or number (0
    /// first), or else in the first. The case of letters counts only where it tells bones apart.
    ///
    /// # Errors
    ///
    /// When the file cannot be read, or has no such bone or animation; always, where this crate is built without
    /// its feature `gltf`.
    #[cfg_attr(not(feature = "gltf"), expect(unused_variables))]
    pub fn read(path: &Path, bone: &str, animation: Option<&str>) -> Result<Self, HairError> {
        #[cfg(not(feature = "gltf"))]
        {
            Err(HairError::WithoutGltf(path.into()))
        }
        #[cfg(feature = "gltf")]
        {
            Self::of_file(path, |bytes, folder| {
                Self::from_bytes(bytes, folder, bone, animation)
            })
        }
    }

    /// The files beside a glTF 2.0 file that hold the numbers of its animations, each once; they need not be there.
    ///
    /// # Errors
    ///
    /// When the file cannot be read; always, where this crate is built without its feature `gltf`.
    pub fn files(path: &Path) -> Result<Vec<PathBuf>, HairError> {
        #[cfg(not(feature = "gltf"))]
        {
            Err(HairError::WithoutGltf(path.into()))
        }
        #[cfg(feature = "gltf")]
        {
            Self::of_file(path, Self::files_of_bytes)
        }
    }

    /// What is read of a file's bytes and of its folder.
    #[cfg(feature = "gltf")]
    fn of_file<T>(
        path: &Path,
        read: impl FnOnce(&[u8], &Path) -> Result<T, crate::SkeletonError>,
    ) -> Result<T, HairError> {
        let bytes = read_bytes(path, MOST_OF_DATA)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        read(&bytes, folder).map_err(|source| HairError::Skeleton {
            path: path.into(),
            source: Box::new(source),
        })
    }
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
