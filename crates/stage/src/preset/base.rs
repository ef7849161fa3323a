//! Presets that build on another one, their base: what they say is in place of what it says.

use super::{Preset, Sections, TopSection, missing};
use effects::preset::{Field, PresetError, PresetErrors, Reader, suggestion};
use effects::section::Section;
use effects::{Registry, Texture, Value};
use std::path::{Path, PathBuf};

/// The most presets of a chain, each the base of the one before.
const MOST_BASES: usize = 16;

/// Where a preset stands.
pub(crate) struct Origin {
    /// The folder in which its base is looked for.
    folder: PathBuf,
    /// Itself and the presets that build on it, by their real paths.
    chain: Vec<PathBuf>,
}

impl Origin {
    /// The file that messages call `file`, in `folder`.
    pub(crate) fn of(folder: &Path, file: &str) -> Self {
        let name = Path::new(file).file_name().unwrap_or_default();
        Self {
            folder: folder.to_owned(),
            chain: vec![real(&folder.join(name))],
        }
    }
}

/// The same path for all names of a file.
fn real(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

impl<'r> Preset<'r> {
    /// What a preset begins with: its base without the layers that it leaves out, or nothing.
    ///
    /// # Errors
    ///
    /// When there is no such base, it has mistakes, or it builds on this preset itself.
    pub(super) fn on_base(
        reader: &mut Reader,
        fields: &[Field],
        top: &TopSection,
        registry: &'r Registry,
        origin: &Origin,
    ) -> Result<Self, PresetErrors> {
        let slice = |name| fields.iter().find(|field| field.name == name);
        let mut preset = match (&top.base, slice("base")) {
            (Some(name), Some(field)) => {
                let place = reader.place(field.value);
                let mistake = |message| {
                    let place = place.clone();
                    PresetErrors(vec![PresetError { place, message }])
                };
                Self::read_base(name, registry, origin, mistake)?
            }
            (_, field) => {
                // A base that is no text: what it would have said isn't missing.
                if field.is_some() {
                    reader.report()?;
                }
                Self {
                    registry: Some(registry),
                    ..Self::new(0, Sections::default(), Vec::new())
                }
            }
        };
        if let (Some(names), Some(field)) = (&top.without, slice("without")) {
            for message in preset.leave_out(names) {
                reader.error(field.value, message);
            }
        }
        Ok(preset)
    }

    fn read_base(
        name: &str,
        registry: &'r Registry,
        origin: &Origin,
        mistake: impl Fn(String) -> PresetErrors,
    ) -> Result<Self, PresetErrors> {
        if let Some(message) = missing(&origin.folder, "base", name) {
            return Err(mistake(message));
        }
        let path = origin.folder.join(name);
        let itself = real(&path);
        if origin.chain.contains(&itself) {
            let message = format!("base: `{}` builds on this preset itself", path.display());
            return Err(mistake(message));
        }
        if origin.chain.len() >= MOST_BASES {
            let message = format!("base: more than {MOST_BASES} presets build on each other");
            return Err(mistake(message));
        }
        let text = hair_io::read_text(&path, hair_io::MOST_OF_TEXT)
            .map_err(|error| mistake(format!("base: {error}")))?;
        let origin = Origin {
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
            chain: [&origin.chain[..], &[itself]].concat(),
        };
        let mut reader = Reader::new(&path.display().to_string(), &text);
        let mut base = Self::read(&mut reader, registry, &origin)?;
        reader.report()?;
        base.bases.insert(0, path);
        if let Some(folder) = Path::new(name).parent() {
            base.move_files(folder);
        }
        Ok(base)
    }

    /// Takes layers away; what is wrong with their names.
    fn leave_out(&mut self, names: &str) -> Vec<String> {
        if self.bases.is_empty() {
            return vec!["without: it leaves out layers of a `base`, and there is none".to_owned()];
        }
        let mut mistakes = Vec::new();
        for name in names.split(',').map(str::trim) {
            let before = self.layers.len();
            self.layers.retain(|layer| layer.name != name);
            if self.layers.len() == before {
                let layers = self.layers.iter().map(|layer| layer.name.as_str());
                let hint = suggestion(name, layers);
                mistakes.push(format!(
                    "without: the base has no layer `{name:.100}`{hint}"
                ));
            }
        }
        mistakes
    }

    /// Names the files that the preset names as they are called one folder up, from where `folder` leads to them.
    fn move_files(&mut self, folder: &Path) {
        if folder.as_os_str().is_empty() {
            return;
        }
        let moved = |name: &mut String| *name = folder.join(&*name).display().to_string();
        let sections = &mut self.sections;
        let files = [
            &mut sections.hair.file,
            &mut sections.hair.bake,
            &mut sections.head.file,
            &mut sections.motion.file,
            &mut sections.motion.gltf,
        ];
        files.into_iter().flatten().for_each(moved);
        for mesh in &mut self.meshes {
            let files = [&mut mesh.section.file, &mut mesh.section.texture];
            files.into_iter().flatten().for_each(moved);
        }
        for body in &mut self.bodies {
            body.section.file.iter_mut().for_each(moved);
        }
        for object in &mut self.objects {
            object.section.preset.as_mut().map(moved);
        }
        for layer in &mut self.layers {
            layer.brush.texture.iter_mut().for_each(moved);
            for (index, param) in layer.effect.params().iter().enumerate() {
                if let Value::Texture(Texture::File(name)) = layer.values.value(param.name) {
                    let mut name = name.clone();
                    moved(&mut name);
                    layer.values.set(index, Value::Texture(Texture::File(name)));
                }
            }
        }
    }
}
