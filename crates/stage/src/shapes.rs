//! Key shapes: hair in the shapes that a motion script wants of it.

use crate::bake::difference;
use crate::files::{Files, StageError};
use crate::hair::HairModel;
use crate::head::HeadModel;
use crate::load;
use crate::preset::{Preset, missing};
use crate::script::{KeyShape, MotionScript};
use effects::preset::{PresetError, PresetErrors};
use glam::Vec3;
use hair_sim::{PointCache, Strands};
use std::path::Path;

/// The most points that all shapes of a script have together: 0.75 GiB of them.
const MOST_POINTS: usize = 1 << 26;

/// The shapes that `script`, a file in `folder`, wants of all strands of the hair; none where it wants none.
///
/// What a style holds on the head stays there: from it on each strand has the key's shape.
///
/// # Errors
///
/// When a file cannot be read, or is not of the same strands.
pub(crate) fn load(
    preset: &Preset,
    files: &Files,
    script: &MotionScript,
    folder: &Path,
    hair: &HairModel,
    head: Option<&HeadModel>,
) -> Result<Option<PointCache>, StageError> {
    let points = hair.file.strands.points().len().max(1);
    if let Some(key) = script.shapes.get(MOST_POINTS / points) {
        let message = format!(
            "shapes: of this hair, which has {points} points, at most {} shapes fit into memory, {} were found",
            MOST_POINTS / points,
            script.shapes.len()
        );
        let place = key.place.clone();
        return Err(PresetErrors(vec![PresetError { place, message }]).into());
    }
    let mut samples = Vec::with_capacity(script.shapes.len());
    let mut mistakes = Vec::new();
    for key in &script.shapes {
        let shape = match &key.file {
            None => Ok(hair.file.strands.points().to_vec()),
            Some(name) => read(preset, files, key, name, folder, hair, head)?,
        };
        match shape {
            Ok(points) => samples.push((key.time as f32, hung(hair, points))),
            Err(message) => mistakes.push(PresetError {
                place: key.place.clone(),
                message,
            }),
        }
    }
    if !mistakes.is_empty() {
        return Err(PresetErrors(mistakes).into());
    }
    if samples.is_empty() {
        return Ok(None);
    }
    Ok(Some(PointCache::new(samples).map_err(StageError::Shapes)?))
}

/// The points of one shape, or what is wrong with its file's name or strands.
fn read(
    preset: &Preset,
    files: &Files,
    key: &KeyShape,
    name: &str,
    folder: &Path,
    hair: &HairModel,
    head: Option<&HeadModel>,
) -> Result<Result<Vec<Vec3>, String>, StageError> {
    if let Some(message) = missing(folder, "hair", name) {
        return Ok(Err(message));
    }
    let other = load::strands(preset, files, &folder.join(name), head, &mut Vec::new())?.file;
    if let Some(what) = difference(&hair.file.strands, &other.strands) {
        return Ok(Err(format!(
            "hair: `{name}` is not of the same strands: {what}"
        )));
    }
    let mut points = other.strands.points().to_vec();
    match (&other.motion, key.at) {
        (Some(motion), at) => motion.sample(at.unwrap_or(0.0), &mut points),
        (None, Some(at)) => {
            return Ok(Err(format!(
                "hair: `{name}` has no motion, so no moment {at} s"
            )));
        }
        (None, None) => {}
    }
    Ok(Ok(points))
}

/// The shape of `points` hung from what the head holds of the hair.
fn hung(hair: &HairModel, mut points: Vec<Vec3>) -> Vec<Vec3> {
    let own: &Strands = &hair.file.strands;
    for strand in 0..own.len() {
        let range = own.point_range(strand);
        let last_held = range.start + hair.held(strand) - 1;
        let shift = own.points()[last_held] - points[last_held];
        points[range.start..=last_held].copy_from_slice(&own.points()[range.start..=last_held]);
        for point in &mut points[last_held + 1..range.end] {
            *point += shift;
        }
    }
    points
}
