//! What a studio does with files: opens, takes on, saves and compares them.

use super::Studio;
use crate::compare::Compare;
use crate::documents::Documents;
use crate::inherited::Inherited;
use crate::layers_shown::LayersShown;
use crate::prompt::Prompt;
use crate::reference::Reference;
use crate::transport::Transport;
use effects::{ParamKind, Value};
use std::path::Path;

impl Studio {
    /// Opens a preset in place of the one that is open, whose changes are gone. Whether it could.
    pub fn open(&mut self, path: &Path) -> bool {
        // A bare name is of this folder, which can be listed and be a part of other paths.
        let path = match path.parent() {
            Some(folder) if folder.as_os_str().is_empty() => &Path::new(".").join(path),
            _ => path,
        };
        match Documents::open(path, self.recovery.clone(), self.wake.clone()) {
            Ok(documents) => {
                self.tell(format!("opened {}", path.display()));
                if let Some(before) = self.documents.take() {
                    before.close();
                }
                self.shown = [None, None];
                self.problems.clear();
                self.is_outdated = false;
                self.sections = stage::Sections::default();
                self.inherited = Inherited::default();
                self.opened += 1;
                if let Some(folder) = path.parent() {
                    folder.clone_into(&mut self.folder);
                }
                self.documents = Some(documents);
                self.layers = LayersShown::default();
                self.view.follow_preset();
                self.transport = Transport::default();
                self.grip.reset();
                self.compare = None;
                self.read = None;
                true
            }
            Err(error) => {
                self.tell(error.to_string());
                false
            }
        }
    }

    /// Opens a preset at once, or asks first what becomes of changes.
    pub fn ask_to_open(&mut self, path: &Path) {
        if self.documents.as_ref().is_some_and(Documents::is_changed) {
            self.prompt = Some(Prompt::Unsaved(Some(path.to_owned())));
        } else {
            self.open(path);
        }
    }

    /// Takes on a file that was dropped on the window: a preset is opened, hair, head or motion become those of the preset.
    pub fn take_file(&mut self, path: &Path) {
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        let ends = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
        let section = if ends(&[".style.ron", ".strands.ron", ".tfx"]) {
            "hair"
        } else if ends(&[".obj", ".ply", ".gltf", ".glb", ".vrm"]) {
            "head"
        } else if ends(&[".motion.ron"]) {
            "motion"
        } else if ends(&[".png", ".jpg", ".jpeg"]) {
            let shown = self.show_reference(path);
            return shown.unwrap_or_else(|error| self.tell(error));
        } else if ends(&[".ron"]) {
            return self.ask_to_open(path);
        } else {
            return self.tell(format!(
                "{}: presets (.ron), hair (.style.ron, .strands.ron, .tfx), heads (.obj, .ply, .gltf, .glb, .vrm), motion \
                 (.motion.ron) and pictures to draw after (.png, .jpg, .jpeg) can be dropped here",
                path.display()
            ));
        };
        let Some(documents) = &self.documents else {
            return self
                .tell("open a preset first: files of hair, heads and motion become a part of it");
        };
        let file = relative_to(path, &documents.folder());
        if self.set(section, "file", &Value::Text(Some(file)), &ParamKind::Text) {
            self.tell(format!("{section}.file is {} now", path.display()));
        }
    }

    /// Writes all that is changed.
    pub fn save(&mut self) {
        let Some(documents) = &mut self.documents else {
            return;
        };
        let errors: Vec<String> = (documents.save().iter()).map(ToString::to_string).collect();
        self.tell(match errors.is_empty() {
            true => "saved".to_owned(),
            false => errors.join("\n"),
        });
    }

    /// Shows a picture to draw after.
    ///
    /// # Errors
    ///
    /// Why it cannot be read.
    pub fn show_reference(&mut self, path: &Path) -> Result<(), String> {
        self.reference = Some(Reference::open(path, &self.ctx)?);
        Ok(())
    }

    /// Compares with another preset.
    ///
    /// # Errors
    ///
    /// Why it cannot be read.
    pub fn compare_with(&mut self, path: &Path) -> Result<(), String> {
        let compare = Compare::with_preset(path).map_err(|error| error.to_string())?;
        self.start_compare(compare);
        Ok(())
    }

    /// What an export hangs on beside the files; nothing where no preset is open.
    #[must_use]
    pub fn export_state(&self) -> Option<crate::export::State> {
        let documents = self.documents.as_ref()?;
        let all = self.shown[0]
            .as_ref()
            .map(|shown| &shown.drawn.facts.layers);
        let all = all.map_or(&[][..], Vec::as_slice);
        let shown: Vec<String> = (all.iter())
            .filter(|layer| self.layers.is_shown(layer))
            .cloned()
            .collect();
        if shown.is_empty() && !all.is_empty() {
            return None;
        }
        Some(crate::export::State {
            preset: documents.preset().path().to_owned(),
            view: self.view.own().cloned(),
            time_s: self.transport.shown_s(),
            only: if shown.len() == all.len() {
                Vec::new()
            } else {
                shown
            },
        })
    }
}

/// A path as a preset in `folder` names it: relative where both are in one tree, with `/` on every system.
fn relative_to(path: &Path, folder: &Path) -> String {
    let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let named = whole(path);
    // Without `..`, which leads elsewhere where a folder is a link: both folders as the system has them, where it has both.
    let own = named.parent().and_then(|own| own.canonicalize().ok());
    let (path, folder) = match (own, named.file_name(), folder.canonicalize()) {
        (Some(own), Some(name), Ok(folder)) => (own.join(name), folder),
        _ => (named.clone(), whole(folder)),
    };
    let common = path
        .components()
        .zip(folder.components())
        .take_while(|(a, b)| a == b)
        .count();
    if common <= 1 {
        return named.display().to_string().replace('\\', "/");
    }
    let up = folder.components().skip(common).map(|_| "..".to_owned());
    let down = path.components().skip(common);
    let down = down.map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_relative_to_the_preset() {
        let named = |path: &str| relative_to(Path::new(path), Path::new("/a/looks"));
        assert_eq!(named("/a/looks/bob.style.ron"), "bob.style.ron");
        assert_eq!(named("/a/hair/x.tfx"), "../hair/x.tfx");
        assert_eq!(named("/b/x.tfx"), "/b/x.tfx");
    }

    #[test]
    fn a_folder_may_be_named_by_a_way_that_goes_up() {
        let root = tempfile::tempdir().unwrap();
        for folder in ["looks", "hair"] {
            std::fs::create_dir(root.path().join(folder)).unwrap();
            std::fs::write(root.path().join(folder).join("x.tfx"), "").unwrap();
        }
        let folder = root.path().join("looks/../hair");
        let named = |path: &str| relative_to(&root.path().join(path), &folder);
        assert_eq!(named("hair/x.tfx"), "x.tfx");
        assert_eq!(named("looks/x.tfx"), "../looks/x.tfx");
        assert_eq!(named("hair/../looks/x.tfx"), "../looks/x.tfx");
    }
}
