//! What `render` and `simulate` share: a preset, changed by options, as a scene.

use super::{mistakes, preset_folder, read_text};
use crate::Failure;
use crate::cli::SceneOptions;
use crate::say::say;
use effects::Registry;
use effects::preset::PresetErrors;
use stage::{Files, HairFrom, HeadColors, Preset, Stage};
use std::path::Path;

/// A preset's text, and what messages call it.
pub(super) struct Source {
    name: String,
    text: String,
}

impl Source {
    pub fn read(path: &Path) -> Result<Self, Failure> {
        Ok(Self {
            name: path.display().to_string(),
            text: read_text(path).map_err(Failure::Failed)?,
        })
    }

    pub fn parse<'r>(&self, registry: &'r Registry) -> Result<Preset<'r>, Failure> {
        Preset::parse(&self.name, &self.text, registry).map_err(failure)
    }

    /// The scene of the preset, which options may have changed; what was guessed about its files is said unless `quiet`.
    pub fn open(&self, preset: &Preset, files: &Files, quiet: bool) -> Result<Stage, Failure> {
        let stage = match Stage::new(preset, files) {
            Ok(stage) => stage,
            // In the words of `inkstrand check`, which knows the places.
            Err(error) => {
                let checked = preset.check_scene(&self.name, &self.text, files);
                return Err(checked.err().map_or_else(|| error.into(), failure));
            }
        };
        if !quiet {
            for note in stage.notes() {
                say(note);
            }
        }
        Ok(stage)
    }
}

fn failure(errors: PresetErrors) -> Failure {
    Failure::Mistakes(mistakes(&errors).collect())
}

impl SceneOptions {
    /// The files that are given in place of the preset's.
    pub fn files(&self, preset: &Path) -> Files {
        Files {
            preset_folder: preset_folder(preset),
            hair: self.hair.clone(),
            head: self.character.clone().or_else(|| self.head.clone()),
            motion: self.motion.clone(),
            bake: None,
            ..Files::default()
        }
    }

    /// Sets what is given in place of the preset's numbers.
    pub fn apply(&self, preset: &mut Preset) -> Result<(), String> {
        let hair = &mut preset.sections.hair;
        hair.guides = self.guides.unwrap_or(hair.guides);
        if self.character.is_some() {
            preset.sections.head.colors = HeadColors::File;
            // Where it has hair of its own; else the preset's.
            preset.sections.hair.from = HairFrom::Character;
        }
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
