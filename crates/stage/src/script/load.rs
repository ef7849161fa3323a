//! The preset's script of motion, with what it names.

use super::{Below, Bone, MotionScript, parse};
use crate::files::{Files, StageError};
use crate::hair::HairModel;
use crate::head::HeadModel;
use crate::load::chosen;
use crate::preset::Preset;
use crate::shapes;
use hair_io::BoneMotion;
use std::path::Path;

/// What moves head, wind and hair; the hair is given its key shapes.
pub(crate) fn load(
    preset: &Preset,
    files: &Files,
    hair: &mut HairModel,
    head: Option<&HeadModel>,
) -> Result<MotionScript, StageError> {
    let own = preset.sections.motion.file.as_ref();
    let mut script = MotionScript::default();
    if let Some(path) = chosen(files.motion.as_ref(), own, &files.preset_folder) {
        let text = files.read_text(&path)?;
        script = parse(&path.display().to_string(), &text)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        hair.shapes = shapes::load(preset, files, &script, folder, hair, head)?;
    }
    let section = &preset.sections.motion;
    if let Some(name) = &section.gltf {
        script.below = Some(Below::Bone(Bone {
            motion: BoneMotion::read(
                &files.preset_folder.join(name),
                section.bone.as_deref().unwrap_or("head"),
                section.animation.as_deref(),
            )?,
            repeats: section.repeat,
            head_height_m: f64::from(hair.head.height_m),
        }));
    }
    if let Some(skeleton) = head.and_then(|head| head.skeleton.as_deref()) {
        script.below = Some(Below::skeleton(skeleton, hair));
    }
    Ok(script)
}
