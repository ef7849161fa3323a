//! What `render` and `simulate` share: a preset, changed by options, as a scene.

use super::progress::Wait;
use super::{check_there, mistakes, preset_folder, read_text};
use crate::Failure;
use crate::cli::SceneOptions;
use crate::paths::file_name;
use crate::say::say;
use effects::Registry;
use effects::preset::{PresetErrors, Reader};
use stage::{Files, HairFrom, HeadColors, Preset, Stage, is_mesh_file};
use std::path::Path;

/// A preset's text, and what messages call it.
pub(super) struct Source {
    name: String,
    text: String,
}

impl Source {
    pub fn read(path: &Path) -> Result<Self, Failure> {
        if let Some(hint) = is_no_preset(path) {
            return Err(Failure::Failed(hint));
        }
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
        let wait = Wait::begin(quiet, format!("loading {}", self.name));
        let stage = match Stage::new(preset, files) {
            Ok(stage) => stage,
            // In the words of `inkstrand check`, which knows the places.
            Err(error) => {
                let checked = preset.check_scene(&self.name, &self.text, files);
                return Err(checked.err().map_or_else(|| error.into(), failure));
            }
        };
        drop(wait);
        if !quiet {
            for note in stage.notes() {
                say(note);
            }
        }
        Ok(stage)
    }
}

/// What a file is instead of a preset, by its name, and how it is drawn.
fn is_no_preset(path: &Path) -> Option<String> {
    let name = file_name(path);
    let (what, option) = if name.ends_with(".style.ron") {
        ("a hair style", "--hair")
    } else if name.ends_with(".strands.ron") || name.ends_with(".tfx") {
        ("hair", "--hair")
    } else if name.ends_with(".motion.ron") {
        ("a motion script", "--motion")
    } else if name.ends_with(".vrm") {
        ("a character", "--character")
    } else if is_mesh_file(path) {
        ("a mesh", "--head")
    } else {
        return None;
    };
    let path = path.display();
    Some(format!(
        "{path}: this is {what}, and no preset, which says how to draw it: `inkstrand render PRESET.ron {option} {path}`"
    ))
}

fn failure(errors: PresetErrors) -> Failure {
    Failure::Mistakes(mistakes(&errors).collect())
}

/// Refuses the file that an option names, where it isn't there.
pub(super) fn check_named(option: &str, path: Option<&Path>) -> Result<(), Failure> {
    let checked = path.map_or(Ok(()), check_there);
    checked.map_err(|message| Failure::Failed(format!("{option}: {message}")))
}

/// Refuses a preset, or a hair style, where an option takes something else: `wanted`.
pub(super) fn check_kind(option: &str, wanted: &str, path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else {
        return Ok(());
    };
    let name = file_name(path);
    let what = if name.ends_with(".style.ron") && wanted != "hair" {
        "a hair style"
    } else if name.ends_with(".motion.ron") && wanted != "motion script" {
        "a motion script"
    } else if is_preset(path) {
        "a preset"
    } else {
        return Ok(());
    };
    let path = path.display();
    Err(Failure::Failed(format!(
        "{option}: {path}: this is {what}, and no {wanted}"
    )))
}

/// Whether a file has what presets alone have.
fn is_preset(path: &Path) -> bool {
    let name = file_name(path);
    let others = [".style.ron", ".strands.ron", ".motion.ron"];
    if !name.ends_with(".ron") || others.iter().any(|ending| name.ends_with(ending)) {
        return false;
    }
    // What is no text is told of by who reads it.
    let Ok(text) = read_text(path) else {
        return false;
    };
    let mut reader = Reader::new("", &text);
    let whole = reader.text();
    let fields = reader.fields(whole, "the file");
    fields
        .iter()
        .any(|field| ["layers", "objects", "base"].contains(&field.name))
}

impl SceneOptions {
    /// The files that are given in place of the preset's. Those that are named must be there.
    pub fn files(&self, path: &Path, preset: &Preset) -> Result<Files, Failure> {
        let named = [
            ("--hair", &self.hair),
            ("--head", &self.head),
            ("--character", &self.character),
            ("--motion", &self.motion),
        ];
        for (option, path) in named {
            check_named(option, path.as_deref())?;
        }
        check_kind("--hair", "hair", self.hair.as_deref())?;
        check_kind("--motion", "motion script", self.motion.as_deref())?;
        let files = Files {
            preset_folder: preset_folder(path),
            hair: self.hair.clone(),
            head: self.character.clone().or_else(|| self.head.clone()),
            motion: self.motion.clone(),
            bake: None,
            ..Files::default()
        };
        for assignment in &self.set {
            let name = assignment.split_once('=').map_or("", |(name, _)| name);
            if let Some(message) = preset.missing_file(name.trim(), &files) {
                return Err(Failure::Failed(format!("--set {assignment}: {message}")));
            }
        }
        Ok(files)
    }

    /// Sets what is given in place of the preset's numbers.
    pub fn apply(&self, preset: &mut Preset) -> Result<(), String> {
        self.check_objects(preset)?;
        let hair = &mut preset.sections.hair;
        hair.guides = self.guides.unwrap_or(hair.guides);
        if self.character.is_some() {
            preset.sections.head.colors = HeadColors::File;
            // Where it has hair of its own; else the preset's.
            preset.sections.hair.from = HairFrom::Character;
        }
        check(preset)?;
        let mut to_blame = None;
        for assignment in &self.set {
            let (name, value) = assignment.split_once('=').ok_or_else(|| {
                format!("--set {assignment}: it takes LAYER.PARAM=VALUE or seed=VALUE")
            })?;
            preset
                .set(name.trim(), value.trim())
                .map_err(|e| format!("--set {assignment}: {e}"))?;
            // The preset had been read without a mistake. What one sets the next may put right.
            let unsupported = preset.unsupported();
            to_blame = unsupported.and(to_blame.or(Some(assignment)));
        }
        match (preset.unsupported(), to_blame) {
            (Some((section, _, message)), Some(assignment)) => {
                Err(format!("--set {assignment}: {section}.{message}"))
            }
            _ => Ok(()),
        }
    }

    /// Objects have what these options give in presets of their own.
    fn check_objects(&self, preset: &Preset) -> Result<(), String> {
        let Some(object) = preset.objects.first() else {
            return Ok(());
        };
        let given = [
            ("--hair", self.hair.is_some()),
            ("--head", self.head.is_some()),
            ("--character", self.character.is_some()),
            ("--motion", self.motion.is_some()),
            ("--guides", self.guides.is_some()),
        ];
        let given = given.iter().find(|(_, is_given)| *is_given);
        let own = object.section.preset.as_deref().unwrap_or("its own.ron");
        given.map_or(Ok(()), |(option, _)| {
            Err(format!(
                "{option}: this preset draws objects, and each has that in a preset of its own, such as {own}"
            ))
        })
    }
}

/// Blended over a loop, more than this, in head heights, is seen.
const SEEN_IN_LOOPS: f32 = 0.5;

/// How well hair came back to where it was, where it goes round.
pub(super) fn say_returns(stage: &Stage) {
    for returned in stage.returns() {
        let [left, mean] =
            [returned.left_m, returned.mean_left_m].map(|left_m| left_m / stage.head().height_m);
        let advice = match left > SEEN_IN_LOOPS {
            true => {
                ", which is seen: more damping, drag or hold leave less, and so does a longer period"
            }
            false => "",
        };
        say(format_args!(
            "loop: {} frames; after {} rounds hair is within {left:.4} head heights of the round before, {mean:.4} on average, and the rest is blended{advice}",
            returned.frames, returned.rounds
        ));
    }
}

/// Whether the options' numbers are ones that a preset could say.
pub(super) fn check(preset: &Preset) -> Result<(), String> {
    preset
        .sections
        .check()
        .map_err(|(section, error)| format!("{section}.{error}"))
}
