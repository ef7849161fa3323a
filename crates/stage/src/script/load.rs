//! The preset's script of motion, with what it names.

use super::{Below, Bone, MotionScript, parse};
use crate::bodies::{self, NamedBody};
use crate::files::{Files, StageError};
use crate::hair::HairModel;
use crate::head::HeadModel;
use crate::load::chosen;
use crate::preset::Preset;
use crate::shapes;
use effects::preset::{PresetError, PresetErrors};
use hair_io::BoneMotion;
use hair_io::orient::Orientation;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What moves head, wind, bodies and hair; the hair is given its key shapes. Meshes of bodies lie as `orientation` has it.
pub(crate) fn load(
    preset: &Preset,
    files: &Files,
    hair: &mut HairModel,
    head: Option<&HeadModel>,
    orientation: &Orientation,
) -> Result<MotionScript, StageError> {
    let own = preset.sections.motion.file.as_ref();
    let mut script = MotionScript::default();
    let mut folder = PathBuf::new();
    if let Some(path) = chosen(files.motion.as_ref(), own, &files.preset_folder) {
        let text = files.read_text(&path)?;
        script = parse(&path.display().to_string(), &text)?;
        path.parent()
            .unwrap_or(Path::new(""))
            .clone_into(&mut folder);
        hair.shapes = shapes::load(preset, files, &script, &folder, hair, head)?;
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
    script.moves_meshes = head.is_some_and(HeadModel::moves);
    if let Some(skeleton) = head.and_then(|head| head.skeleton.as_deref()) {
        script.below = Some(Below::skeleton(skeleton, hair));
    }
    let in_preset = preset
        .bodies
        .iter()
        .map(|body| (body, files.preset_folder.as_path()));
    let in_script = script
        .named_bodies
        .iter()
        .map(|body| (body, folder.as_path()));
    let all: Vec<(&NamedBody, &Path)> = in_preset.chain(in_script).collect();
    let bodies = bodies::load(&all, &script.body_keys, hair.head, orientation)?;
    script.bodies = bodies.into_iter().map(Arc::new).collect();
    check_loop(&script)?;
    Ok(script)
}

/// What animations move in a script that goes round must, too, and bodies.
fn check_loop(script: &MotionScript) -> Result<(), PresetErrors> {
    let Some(period) = script.period.filter(|_| script.closes) else {
        return Ok(());
    };
    let at_loop = |what: String| {
        let place = script.loop_place.clone()?;
        let message = format!(
            "loop: {what} is elsewhere after {} s than at its start: let `period` be a whole number of times its length",
            period as f32,
        );
        Some(PresetError { place, message })
    };
    let mistake = |body: &Arc<bodies::Body>| -> Option<PresetError> {
        let name = body.section.name.as_deref();
        if !body.is_alike(0.0, period) {
            let mut keys = script.body_keys.iter().rev();
            return Some(keys.find(|key| name == Some(key.body()))?.open(period));
        }
        let comes_round = body.has_one_form(0.0, period);
        let name = name.unwrap_or_default();
        (!comes_round).then(|| at_loop(format!("the mesh of body `{name:.40}`")))?
    };
    let mut mistakes: Vec<PresetError> = script.bodies.iter().filter_map(mistake).collect();
    if script
        .below
        .as_ref()
        .is_some_and(|below| !below.is_alike(0.0, period))
    {
        mistakes.extend(at_loop("the animation that moves the head".to_owned()));
    }
    PresetErrors::report(mistakes)
}
