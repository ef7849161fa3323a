//! Baked motion: a scene's strands at the times of its frames, as a strands file.

use crate::files::StageError;
use glam::Vec3;
use hair_io::{HairOptions, orient};
use hair_sim::{Motion, Strands};
use render::StrandInfo;
use std::path::Path;

/// Strands at the times of frames, as they are baked.
#[derive(Default)]
pub struct Bake {
    samples: Vec<(f32, Vec<Vec3>)>,
}

impl Bake {
    /// Adds the strands at `time` (seconds); times increase.
    pub(crate) fn push(&mut self, time: f32, points: &[Vec3]) {
        self.samples.push((time, points.to_vec()));
    }

    /// The text of a strands file of this hair, in metres.
    pub(crate) fn text(
        self,
        strands: &Strands,
        infos: &[StrandInfo],
    ) -> Result<String, StageError> {
        let mut sized = Strands::new();
        for (i, info) in infos.iter().enumerate() {
            sized.push(info.id, strands.strand(i), Some(info.size))?;
        }
        let motion = Motion::new(self.samples).map_err(StageError::Bake)?;
        Ok(hair_io::strands_ron::to_text(&sized, Some(&motion)))
    }
}

/// Reads a bake of these strands.
///
/// # Errors
///
/// When there is no such file, or it is not a bake of these strands.
pub(crate) fn read(path: &Path, own: &Strands) -> Result<Motion, StageError> {
    let given = orient::Given {
        up: Some(orient::Axes::Y),
        scale: Some(1.0),
        offset: Some(Vec3::ZERO),
    };
    let mut file = hair_io::read_hair(path, &HairOptions { given, head: None })?;
    let mut by_id: Vec<usize> = (0..file.strands.len()).collect();
    by_id.sort_by_key(|&i| file.strands.id(i));
    file.keep(&by_id);
    let other = |what: String| StageError::OtherHair {
        path: path.to_owned(),
        what,
    };
    if let Some(what) = difference(own, &file.strands) {
        return Err(other(what));
    }
    file.motion
        .ok_or_else(|| other("no motion in it".to_owned()))
}

/// How `other` differs from `own` in its number of strands and points, both sorted by id.
pub(crate) fn difference(own: &Strands, other: &Strands) -> Option<String> {
    if other.len() != own.len() {
        return Some(format!("{} strands in place of {}", other.len(), own.len()));
    }
    (0..own.len()).find_map(|i| {
        let (id, points) = (own.id(i), own.strand(i).len());
        match other.strand(i).len() {
            _ if other.id(i) != id => Some(format!("no strand {id}")),
            found if found != points => Some(format!(
                "strand {id} has {found} points in place of {points}"
            )),
            _ => None,
        }
    })
}
