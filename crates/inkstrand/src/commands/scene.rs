//! What `render` and `simulate` share: a preset, changed by options, as a scene.

use super::{mistakes, preset_folder};
use crate::Failure;
use crate::cli::SceneOptions;
use effects::Registry;
use stage::{Files, Preset, Stage};
use std::path::Path;

/// Reads a preset's text.
pub(super) fn parse<'r>(
    path: &Path,
    text: &str,
    registry: &'r Registry,
) -> Result<Preset<'r>, Failure> {
    Preset::parse(&path.display().to_string(), text, registry)
        .map_err(|errors| Failure::Mistakes(mistakes(&errors).collect()))
}

/// The scene of a preset; what was guessed about its files is said unless `quiet`.
pub(super) fn open(preset: &Preset, files: &Files, quiet: bool) -> Result<Stage, Failure> {
    preset
        .check_files(files)
        .map_err(|errors| Failure::Mistakes(mistakes(&errors).collect()))?;
    let stage = Stage::new(preset, files)?;
    if !quiet {
        for note in stage.notes() {
            eprintln!("{note}");
        }
    }
    Ok(stage)
}

impl SceneOptions {
    /// The files that are given in place of the preset's.
    pub fn files(&self, preset: &Path) -> Files {
        Files {
            preset_folder: preset_folder(preset),
            hair: self.hair.clone(),
            head: self.head.clone(),
            motion: self.motion.clone(),
            bake: None,
        }
    }

    /// Sets what is given in place of the preset's numbers.
    pub fn apply(&self, preset: &mut Preset) -> Result<(), String> {
        let hair = &mut preset.sections.hair;
        hair.guides = self.guides.unwrap_or(hair.guides);
        check(preset)?;
        for assignment in &self.set {
            let (name, value) = assignment.split_once('=').ok_or_else(|| {
                format!("--set {assignment}: it takes LAYER.PARAM=VALUE or seed=VALUE")
            })?;
            preset
                .set(name.trim(), value.trim())
                .map_err(|e| format!("--set {assignment}: {e}"))?;
        }
        Ok(())
    }
}

/// Whether the options' numbers are ones that a preset could say.
pub(super) fn check(preset: &Preset) -> Result<(), String> {
    preset
        .sections
        .check()
        .map_err(|(section, error)| format!("{section}.{error}"))
}
