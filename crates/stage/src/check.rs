//! All that is wrong with a preset and with the motion script, style and bake that it names, without a picture.

use crate::files::{Files, StageError};
use crate::load;
use crate::preset::{Preset, missing};
use crate::script;
use crate::style;
use effects::Registry;
use effects::preset::{Place, PresetError, PresetErrors, Reader};
use std::path::Path;

impl<'r> Preset<'r> {
    /// Looks for all that is wrong with the preset `text`, also with the files that it names: whether they are there, what is
    /// wrong in a motion script and in a style, and whether a bake is one of the preset's hair.
    ///
    /// # Errors
    ///
    /// All mistakes, each with its file, line and column: those of the preset first.
    pub fn check(
        file: &str,
        text: &str,
        registry: &'r Registry,
        files: &Files,
    ) -> Result<(), PresetErrors> {
        let mut reader = Reader::new(file, text);
        let preset = Self::read(&mut reader, registry)?;
        let mut found = Found::default();
        found.add(reader.report());
        found.add(preset.check_files(files));
        found.add(preset.check_script(files));
        found.add(preset.check_style(files));
        found.add(preset.check_bake(files));
        (found.0).sort_by_cached_key(|e| {
            let place = &e.place;
            (
                place.file != file,
                place.file.clone(),
                place.line,
                place.column,
            )
        });
        found.report()
    }

    fn check_script(&self, files: &Files) -> Result<(), PresetErrors> {
        let own = self.sections.motion.file.as_ref();
        let path = load::chosen(files.motion.as_ref(), own, &files.preset_folder);
        match path.filter(|path| path.is_file()) {
            Some(path) => self.check_text(&path, ("motion", "file"), check_motion),
            None => Ok(()),
        }
    }

    fn check_style(&self, files: &Files) -> Result<(), PresetErrors> {
        let own = self.sections.hair.file.as_ref();
        let path = load::chosen(files.hair.as_ref(), own, &files.preset_folder);
        match path.filter(|path| path.is_file() && load::is_style(path)) {
            Some(path) => self.check_text(&path, ("hair", "file"), check_style),
            None => Ok(()),
        }
    }

    /// Checks a file's text; one that cannot be read is a mistake where the preset names it.
    fn check_text(
        &self,
        path: &Path,
        (section, param): (&str, &str),
        check: impl Fn(&Path, &str) -> Result<(), PresetErrors>,
    ) -> Result<(), PresetErrors> {
        match std::fs::read_to_string(path) {
            Ok(text) => check(path, &text),
            Err(error) => {
                let message = format!("{param}: `{}` cannot be read: {error}", path.display());
                self.mistake(section, param, path, message)
            }
        }
    }

    /// A bake needs the hair that it was made of; where that cannot be read, its own mistakes are named first.
    fn check_bake(&self, files: &Files) -> Result<(), PresetErrors> {
        let own = self.sections.hair.bake.as_ref();
        let path = load::chosen(files.bake.as_ref(), own, &files.preset_folder);
        let Some(path) = path.filter(|path| path.is_file()) else {
            return Ok(());
        };
        let read = || {
            let notes = &mut Vec::new();
            let model = load::head(self, files, notes)?;
            let mesh = model.as_ref().map(|model| &model.mesh);
            let mut hair = load::hair(self, files, mesh, notes)?;
            hair.choose_guides(&self.sections.hair);
            load::bake(self, files, &mut hair)
        };
        match read() {
            // Hair may be given later, and a style's mistakes are its own.
            Ok(()) | Err(StageError::NoHair | StageError::Mistakes(_)) => Ok(()),
            Err(error) => self.mistake("hair", "bake", &path, format!("bake: {error}")),
        }
    }

    /// A mistake of the file at `path`, where the preset names it; in the file itself where the caller does.
    fn mistake(
        &self,
        section: &str,
        param: &str,
        path: &Path,
        message: String,
    ) -> Result<(), PresetErrors> {
        let in_file = || Place {
            file: path.display().to_string(),
            line: 1,
            column: 1,
            source_line: String::new(),
        };
        let place = self.place_of(section, param).cloned();
        let place = place.unwrap_or_else(in_file);
        Err(PresetErrors(vec![PresetError { place, message }]))
    }
}

/// Looks for all that is wrong with a motion script and with the names of the shapes in it.
///
/// # Errors
///
/// All mistakes, each with its line and column.
pub fn check_motion(path: &Path, text: &str) -> Result<(), PresetErrors> {
    let script = script::parse(&path.display().to_string(), text)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mistakes = script.shapes.iter().filter_map(|key| {
        let message = missing(folder, "hair", key.file.as_ref()?)?;
        let place = key.place.clone();
        Some(PresetError { place, message })
    });
    Found(mistakes.collect()).report()
}

/// Looks for all that is wrong with a style.
///
/// # Errors
///
/// All mistakes, each with its line and column.
pub fn check_style(path: &Path, text: &str) -> Result<(), PresetErrors> {
    style::parse(&path.display().to_string(), text).map(|_| ())
}

/// Mistakes from several places.
#[derive(Default)]
struct Found(Vec<PresetError>);

impl Found {
    fn add(&mut self, result: Result<(), PresetErrors>) {
        self.0
            .extend(result.err().into_iter().flat_map(|errors| errors.0));
    }

    fn report(self) -> Result<(), PresetErrors> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(PresetErrors(self.0))
        }
    }
}
