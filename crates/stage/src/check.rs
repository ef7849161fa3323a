//! All that is wrong with a preset and with the files that it names, without a picture.

use crate::bodies::{self, NamedBody};
use crate::files::{Files, StageError};
use crate::load;
use crate::painted;
use crate::preset::{Origin, Preset, missing};
use crate::script;
use crate::stage::Stage;
use crate::style;
use crate::textures;
use effects::Registry;
use effects::preset::{PresetError, PresetErrors, Reader};
use hair_io::{BoneMotion, HairOptions};
use std::path::{Path, PathBuf};

/// A file that a preset names.
struct NamedFile {
    section: &'static str,
    param: &'static str,
    path: PathBuf,
    /// Whether the caller names it, in place of the preset.
    is_given: bool,
}

impl<'r> Preset<'r> {
    /// Looks for all that is wrong with the preset `text`, also with the files that it names, which are opened, and with the scene
    /// that they make.
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
        let origin = Origin::of(&files.preset_folder, file);
        let preset = Self::read(&mut reader, registry, &origin)?;
        let mut found = Found::default();
        let own = reader.report();
        let is_whole = own.is_ok();
        found.add(own);
        found.add(preset.check_opened(files));
        if is_whole && found.0.is_empty() {
            found.add(preset.check_made(file, text, files));
        }
        found.report(file)
    }

    /// Looks for all that is wrong with the files of a preset that was read, and maybe changed since, and with the scene that they
    /// make. `text` is the preset's own, of the file that messages call `file`. Without hair there is no scene, and nothing wrong
    /// with it: some may be given later.
    ///
    /// # Errors
    ///
    /// All mistakes, each with its file, line and column: those of the preset first.
    pub fn check_scene(&self, file: &str, text: &str, files: &Files) -> Result<(), PresetErrors> {
        let mut found = Found::default();
        found.add(self.check_opened(files));
        if found.0.is_empty() {
            found.add(self.check_made(file, text, files));
        }
        found.report(file)
    }

    /// The files that a scene is read from: those of the preset, but where the caller gives others, and those that its script
    /// and its character name.
    #[must_use]
    pub fn files(&self, files: &Files) -> Vec<PathBuf> {
        let mut paths: Vec<PathBuf> = self.named(files).into_iter().map(|f| f.path).collect();
        if let Some(script) = &self.script_path(files)
            && let Ok(text) = files.read_text(script)
            && let Ok(parsed) = script::parse("", &text)
        {
            let shapes = parsed.shapes.into_iter().filter_map(|key| key.file);
            paths.extend(shapes.map(|name| script.with_file_name(name)));
            let folder = script.parent().unwrap_or(Path::new(""));
            let bodies = parsed.named_bodies.iter();
            paths.extend(bodies.flat_map(|body| body.section.files(folder)));
        }
        if let Some(character) = self.character_path(files) {
            paths.extend(BoneMotion::files(&character).into_iter().flatten());
        }
        for layer in &self.layers {
            paths.extend(textures::named(layer, files).map(|(_, _, path)| path));
        }
        let meshes = self.meshes.iter();
        paths.extend(meshes.flat_map(|mesh| {
            let texture = mesh.section.texture_path(&files.preset_folder);
            let named = mesh.section.files(&files.preset_folder);
            named.into_iter().chain(texture)
        }));
        let bodies = self.bodies.iter();
        paths.extend(bodies.flat_map(|body| body.section.files(&files.preset_folder)));
        paths.extend(self.files_of_objects(files));
        paths.extend(self.bases().iter().cloned());
        paths
    }

    /// As [`Self::files`], with those that the meshes among them name: buffers, materials and pictures. These meshes are opened
    /// for that.
    #[must_use]
    pub fn all_files(&self, files: &Files) -> Vec<PathBuf> {
        let mut paths = self.files(files);
        let meshes = paths.iter().filter(|path| is_mesh_file(path));
        // Who reads the meshes tells what is wrong with them.
        let named = meshes.filter_map(|path| mesh_io::named_files(path).ok());
        let named = named.flat_map(|named| named.buffers.into_iter().chain(named.paint));
        let named: Vec<PathBuf> = named.collect();
        paths.extend(named);
        paths
    }

    /// The character whose animation moves the head.
    pub(crate) fn character_path(&self, files: &Files) -> Option<PathBuf> {
        let section = &self.sections.motion;
        if section.character {
            let own = self.sections.head.file.as_ref();
            return load::chosen(files.head.as_ref(), own, &files.preset_folder);
        }
        Some(files.preset_folder.join(section.gltf.as_ref()?))
    }

    fn script_path(&self, files: &Files) -> Option<PathBuf> {
        let own = self.sections.motion.file.as_ref();
        load::chosen(files.motion.as_ref(), own, &files.preset_folder)
    }

    fn named(&self, files: &Files) -> Vec<NamedFile> {
        let sections = &self.sections;
        let all = [
            ("hair", "file", &sections.hair.file, &files.hair),
            ("hair", "bake", &sections.hair.bake, &files.bake),
            ("head", "file", &sections.head.file, &files.head),
            ("motion", "file", &sections.motion.file, &files.motion),
            ("motion", "gltf", &sections.motion.gltf, &None),
        ];
        let named = all.into_iter().filter_map(|(section, param, own, given)| {
            Some(NamedFile {
                section,
                param,
                path: load::chosen(given.as_ref(), own.as_ref(), &files.preset_folder)?,
                is_given: given.is_some(),
            })
        });
        named.collect()
    }

    /// Opens each file that the preset names by itself. What is wrong with those that the caller names has no place in it.
    fn check_opened(&self, files: &Files) -> Result<(), PresetErrors> {
        let mut found = Found::default();
        found.add(self.check_files(files));
        for file in self.named(files) {
            if !file.is_given && file.path.is_file() {
                found.add(self.check_file(files, &file));
            }
        }
        for mesh in &self.meshes {
            if let Err(error) = painted::check(&mesh.section, &files.preset_folder) {
                found.0.extend(mesh.mistake(error.to_string()));
            }
            let texture = mesh.section.texture_path(&files.preset_folder);
            let texture = texture.filter(|path| path.is_file());
            if let Some(Err(error)) = texture.map(|path| painted::check_picture(&path)) {
                let message = format!("texture: {error}");
                found.0.extend(mesh.mistake_of_texture(message));
            }
        }
        found
            .0
            .extend(mistakes_of_bodies(&self.bodies, &files.preset_folder));
        for layer in &self.layers {
            for (param, place, path) in textures::named(layer, files) {
                if let (Some(place), true) = (place, path.is_file())
                    && let Some(fault) = textures::fault(&path, files)
                {
                    found.add(Err(PresetErrors(vec![PresetError {
                        place: place.clone(),
                        message: format!("{param}: {fault}"),
                    }])));
                }
            }
        }
        found.all()
    }

    fn check_file(&self, files: &Files, file: &NamedFile) -> Result<(), PresetErrors> {
        let path = &file.path;
        let opened: Result<(), StageError> = match (file.section, file.param) {
            ("motion", "file") => return self.check_text(files, file, check_motion),
            ("hair", "file") if load::is_style(path) => {
                return self.check_text(files, file, check_style);
            }
            ("hair", "file") => check_hair(path),
            ("hair", _) => hair_io::read_hair(path, &HairOptions::default())
                .map(drop)
                .map_err(StageError::from),
            ("head", _) => hair_io::read_head(path, None, None)
                .map(drop)
                .map_err(StageError::from),
            _ => {
                let section = &self.sections.motion;
                let bone = section.bone.as_deref().unwrap_or("head");
                BoneMotion::read(path, bone, section.animation.as_deref())
                    .map(drop)
                    .map_err(StageError::from)
            }
        };
        opened.or_else(|error| self.mistake(file, error.to_string()))
    }

    /// Checks a file's text; one that cannot be read is a mistake where the preset names it.
    fn check_text(
        &self,
        files: &Files,
        file: &NamedFile,
        check: impl Fn(&Path, &str) -> Result<(), PresetErrors>,
    ) -> Result<(), PresetErrors> {
        match files.read_text(&file.path) {
            Ok(text) => check(&file.path, &text),
            Err(error) => self.mistake(file, error.to_string()),
        }
    }

    /// Makes the scene, and its hair where the motion begins.
    fn check_made(&self, file: &str, text: &str, files: &Files) -> Result<(), PresetErrors> {
        let begin = -self.sections.dynamics.warm_up;
        let made = Stage::new(self, files).and_then(|mut stage| stage.advance_to(begin));
        let error = match made {
            Ok(()) | Err(StageError::NoHair) => return Ok(()),
            Err(StageError::Mistakes(errors)) => return Err(errors),
            Err(error) => error,
        };
        // Messages about a file begin with its name; a bake may be another's file too.
        let message = error.to_string();
        let is_of_bake = matches!(
            error,
            StageError::OtherHair { .. } | StageError::OtherMotion { .. }
        );
        let is_of = |file: &&NamedFile| {
            let begins = message.starts_with(&format!("{}: ", file.path.display()));
            begins && (file.param == "bake" || !is_of_bake)
        };
        let named = self.named(files);
        if let Some(file) = named.iter().find(is_of) {
            return self.mistake(file, message);
        }
        // What the caller has set in a list stands nowhere.
        let folder = &files.preset_folder;
        let of_meshes = self.meshes.iter().flat_map(|mesh| mesh.files_set(folder));
        let of_bodies = self.bodies.iter().flat_map(|body| body.files_set(folder));
        let begins = |path: PathBuf| message.starts_with(&path.display().to_string());
        if of_meshes.chain(of_bodies).any(begins) {
            return Ok(());
        }
        // Of files that the preset does not name, its script does.
        let is_of_file = matches!(
            error,
            StageError::File(_) | StageError::Character(_) | StageError::Read { .. }
        );
        if is_of_file && self.objects.is_empty() {
            let is_script = |file: &&NamedFile| (file.section, file.param) == ("motion", "file");
            let script = named.iter().find(is_script);
            return script.map_or(Ok(()), |script| self.mistake(script, message));
        }
        let section = match &error {
            _ if !self.objects.is_empty() => "objects",
            StageError::NoPointLight(_) | StageError::Camera(_) => "light",
            StageError::Shapes(_) | StageError::Loop { .. } | StageError::NoCharacter => "motion",
            StageError::Texture { .. }
            | StageError::Zones { .. }
            | StageError::MeshLayer { .. }
            | StageError::Clips(..) => "layers",
            StageError::Path(_) => "path",
            StageError::NoHeadsHair => "hair",
            StageError::Body { .. } | StageError::Sequence(_) => "bodies",
            StageError::Unsupported { section, .. } => section,
            _ => "dynamics",
        };
        let of_layer = match &error {
            StageError::NoPointLight(name) => self.layers.iter().find(|layer| layer.name == *name),
            _ => None,
        };
        let place = (self.place_of_part(section)).or_else(|| Some(&of_layer?.place));
        let place = place.cloned().unwrap_or_else(|| {
            let reader = Reader::new(file, text);
            reader.place(reader.text())
        });
        Err(PresetErrors(vec![PresetError { place, message }]))
    }

    /// A mistake of a file, where the preset names it; none where it does not.
    fn mistake(&self, file: &NamedFile, message: String) -> Result<(), PresetErrors> {
        let place = self.place_of(file.section, file.param);
        match place.filter(|_| !file.is_given) {
            Some(place) => Err(PresetErrors(vec![PresetError {
                place: place.clone(),
                message: format!("{}: {message}", file.param),
            }])),
            None => Ok(()),
        }
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
    let mut mistakes: Vec<PresetError> = mistakes.collect();
    let bodies = &script.named_bodies;
    mistakes.extend(bodies.iter().filter_map(|body| body.missing(folder)));
    mistakes.extend(mistakes_of_bodies(bodies, folder));
    PresetErrors::report(mistakes)
}

/// What is wrong with the meshes of bodies, where they are there.
fn mistakes_of_bodies(bodies: &[NamedBody], folder: &Path) -> Vec<PresetError> {
    let mistake = |body: &NamedBody| {
        if body.missing(folder).is_some() {
            return None;
        }
        let error = bodies::check(&body.section, folder).err()?;
        body.mistake(format!("file: {error}"))
    };
    bodies.iter().filter_map(mistake).collect()
}

/// Looks for all that is wrong with a style.
///
/// # Errors
///
/// All mistakes, each with its line and column.
pub fn check_style(path: &Path, text: &str) -> Result<(), PresetErrors> {
    style::parse(&path.display().to_string(), text).map(|_| ())
}

/// Looks for what is wrong with strands of a file, or a bake.
///
/// # Errors
///
/// The first mistake, with the file's name.
pub fn check_hair(path: &Path) -> Result<(), StageError> {
    hair_io::read_hair(path, &HairOptions::default()).map_err(load::with_styles)?;
    Ok(())
}

/// Whether a file is hair by its name's ending, also of a format that this build doesn't read, which [`check_hair`] then says.
#[must_use]
pub fn is_hair_file(path: &Path) -> bool {
    hair_io::is_hair_file(path)
}

/// Whether a file is one of meshes, a head or a character, by its name's ending.
#[must_use]
pub fn is_mesh_file(path: &Path) -> bool {
    mesh_io::is_model(path, b"")
}

/// Looks for what is wrong with a file of meshes.
///
/// # Errors
///
/// The first mistake, with the file's name.
pub fn check_mesh(path: &Path) -> Result<(), StageError> {
    mesh_io::read_model(path)?;
    Ok(())
}

/// Mistakes from several places.
#[derive(Default)]
struct Found(Vec<PresetError>);

impl Found {
    fn add(&mut self, result: Result<(), PresetErrors>) {
        self.0
            .extend(result.err().into_iter().flat_map(|errors| errors.0));
    }

    fn all(self) -> Result<(), PresetErrors> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(PresetErrors(self.0))
        }
    }

    /// All of them, those of `file` first.
    fn report(mut self, file: &str) -> Result<(), PresetErrors> {
        (self.0).sort_by_cached_key(|e| {
            let place = &e.place;
            (
                place.file != file,
                place.file.clone(),
                place.line,
                place.column,
            )
        });
        self.all()
    }
}
