//! Files: choosing the reader, settling axes and units, and writing.

use std::path::Path;

use glam::Vec3;
use hair_sim::{PointCache, Strands};

use crate::Mesh;
use crate::error::HairError;
use crate::format::{self, HAIR_FORMATS, HairFormat};
use crate::orient::{self, Axes, Given, Orientation};
use crate::whole_file::write_whole;
use crate::{strands_ron, tfx};
use mesh_io::{MOST_OF_DATA, Model, decode_text, model_of_bytes, read_bytes};

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
    /// All that the file holds, as it lies there.
    pub model: Model,
    /// From there to where `mesh` lies.
    pub orientation: Orientation,
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

/// Reads a head, bust or body. `up` and `scale` (metres a unit) override what would be guessed: by all of it but meshes that are called hair
/// ([`is_called_hair`]), as these may hide a neck.
///
/// # Errors
///
/// When the file cannot be read, is of another format, or has errors.
pub fn read_head(path: &Path, up: Option<Axes>, scale: Option<f32>) -> Result<HeadFile, HairError> {
    let bytes = read_bytes(path, MOST_OF_DATA)?;
    if !mesh_io::is_model(path, &bytes) {
        return Err(HairError::Format {
            path: path.into(),
            found: format::guess(path, &bytes),
            reads: mesh_io::FORMATS,
        });
    }
    let model = model_of_bytes(path, &bytes)?;
    let mut mesh = model.welded();
    if mesh.triangles.is_empty() {
        return Err(HairError::NoTriangles(path.into()));
    }
    let given = Given {
        up,
        scale,
        offset: None,
    };
    let (orientation, note) = match model.is_metric {
        true => orient::known_head(&mesh, &given),
        false => orient::head_by(&without_hair(&model), &mesh, &given),
    };
    mesh.positions
        .iter_mut()
        .for_each(|p| *p = orientation.apply(*p));
    mesh.normals
        .iter_mut()
        .for_each(|n| *n = orientation.up.to_y_up(*n));
    check_finite(path, &orientation, &mesh.positions)?;
    let of_file = |note: &String| format!("{}: {note}", path.display());
    let mut notes: Vec<String> = model.notes.iter().map(of_file).collect();
    notes.push(note);
    Ok(HeadFile {
        mesh,
        model,
        orientation,
        notes,
    })
}

/// Whether `hair` is a part of the name of a mesh or of its material.
#[must_use]
pub fn is_called_hair(model: &Model, mesh: &mesh_io::Mesh) -> bool {
    let material = mesh.material.and_then(|index| model.materials.get(index));
    let names = [Some(&mesh.name), material.map(|material| &material.name)];
    let says_hair = |name: &String| name.to_ascii_lowercase().contains("hair");
    names.into_iter().flatten().any(says_hair)
}

/// The shape of a model without its hair, or whole where nothing else is in it.
fn without_hair(model: &Model) -> Mesh {
    let others = (model.meshes.iter()).filter(|mesh| !is_called_hair(model, mesh));
    let shape = Mesh::from_corners(others.flat_map(mesh_io::Mesh::corners));
    match shape.triangles.is_empty() {
        true => model.welded(),
        false => shape,
    }
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

fn check_finite(path: &Path, orientation: &Orientation, points: &[Vec3]) -> Result<(), HairError> {
    if orientation.scale > 0.0 && points.iter().all(|p| p.is_finite()) {
        return Ok(());
    }
    Err(HairError::Scale {
        path: path.into(),
        scale: orientation.scale,
    })
}
