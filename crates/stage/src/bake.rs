//! Baked motion: a scene's strands at the times of its frames, as a strands file that says what moved them.

mod moved_by;

use crate::files::{Files, StageError};
use crate::hair::HairModel;
use crate::load::chosen;
use crate::preset::Preset;
use crate::scene::Scene;
use glam::Vec3;
use hair_io::{HairOptions, orient};
use hair_sim::{PointCache, Strands};
use moved_by::MovedBy;
use render::StrandInfo;
use std::path::{Path, PathBuf};

/// Strands at the times of frames, as they are baked.
#[derive(Default)]
pub struct Bake {
    moved_by: Option<MovedBy>,
    samples: Vec<(f32, Vec<Vec3>)>,
}

impl Bake {
    /// A bake without frames, of the scene that `preset` and `files` make.
    ///
    /// # Errors
    ///
    /// When one of the files can no longer be read, or the scene has several objects.
    pub fn new(preset: &Preset, files: &Files, scene: &Scene) -> Result<Self, StageError> {
        let object = match scene.objects() {
            [one] if preset.objects.is_empty() => one,
            objects => return Err(StageError::BakeOfObjects(objects.len())),
        };
        Ok(Self {
            moved_by: Some(MovedBy::of(preset, files, object.hair())?),
            samples: Vec::new(),
        })
    }

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
        let motion = PointCache::new(self.samples).map_err(StageError::Bake)?;
        let header = self.moved_by.map(|moved_by| moved_by.to_string());
        let strands = hair_io::strands_ron::to_text(&sized, Some(&motion));
        Ok(header.unwrap_or_default() + &strands)
    }
}

/// Whether a file says of itself that it is a bake: those of older builds do not.
#[must_use]
pub fn is_bake(path: &Path) -> bool {
    matches!(MovedBy::read(path), Ok(Some(_)))
}

/// The bake that moves the scene's hair, if any.
fn path(preset: &Preset, files: &Files) -> Option<PathBuf> {
    let own = preset.sections.hair.bake.as_ref();
    chosen(files.bake.as_ref(), own, &files.preset_folder)
}

/// Puts the preset's bake, if it has one, in the place of the hair's own motion.
///
/// # Errors
///
/// When there is no such file, it is of other strands, or something else moved them.
pub(crate) fn load(
    preset: &Preset,
    files: &Files,
    hair: &mut HairModel,
    notes: &mut Vec<String>,
) -> Result<(), StageError> {
    let Some(path) = path(preset, files) else {
        return Ok(());
    };
    let motion = read(&path, &hair.file.strands)?;
    let own = MovedBy::of(preset, files, hair)?;
    let baked = MovedBy::read(&path).map_err(|source| hair_io::ReadError::Open {
        path: path.clone(),
        source,
    })?;
    match baked {
        None => notes.push(format!(
            "{}: the bake does not say what moved its hair; `inkstrand simulate` makes one that does",
            path.display()
        )),
        Some(baked) => {
            if let Some(what) = own.difference(&baked) {
                return Err(StageError::OtherMotion { path, what });
            }
        }
    }
    hair.file.motion = Some(motion);
    hair.bake = Some(path);
    Ok(())
}

/// Reads a bake of these strands.
fn read(path: &Path, own: &Strands) -> Result<PointCache, StageError> {
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

/// Holds `time` (seconds), at which hair is as at the time `held`, against its bake, if it has one, in a scene of so many frames a second.
///
/// # Errors
///
/// When the bake does not go as far.
pub(crate) fn check_reaches(
    hair: &HairModel,
    fps: f32,
    time: f32,
    held: f32,
) -> Result<(), StageError> {
    let (Some(path), Some(motion)) = (&hair.bake, &hair.file.motion) else {
        return Ok(());
    };
    let (Some(&first), Some(&last)) = (motion.times().first(), motion.times().last()) else {
        return Ok(());
    };
    // What is nearer than this to a frame is that frame.
    let slack = 0.01 / fps;
    let has = |time: f32| (first - slack..=last + slack).contains(&time);
    if has(time) && has(held) {
        return Ok(());
    }
    let frame = |time: f32| format!("{} ({time} s)", (time * fps).round());
    let asked = match has(time) {
        false => frame(time),
        true => format!(
            "{}, which is held until frame {},",
            frame(held),
            frame(time)
        ),
    };
    Err(StageError::BeyondBake {
        path: path.clone(),
        first: frame(first),
        last: frame(last),
        asked,
    })
}
