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
    let baked = &file.strands;
    if baked.len() != own.len() {
        return Err(other(format!(
            "{} strands in place of {}",
            baked.len(),
            own.len()
        )));
    }
    for i in 0..own.len() {
        let (id, points) = (own.id(i), own.strand(i).len());
        if baked.id(i) != id || baked.strand(i).len() != points {
            return Err(other(format!("no strand {id} of {points} points")));
        }
    }
    file.motion
        .ok_or_else(|| other("no motion in it".to_owned()))
}
