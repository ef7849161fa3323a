//! Another look, or this one as it was, beside the one that is edited.

use crate::engine::Look;
use std::path::{Path, PathBuf};

/// What is compared with, and where the line between both is.
#[derive(Clone, Debug, PartialEq)]
pub struct Compare {
    /// The other look.
    pub look: Look,
    /// The file of another preset.
    pub path: Option<PathBuf>,
    /// What it is called.
    pub name: String,
    /// Where the line is: the part of the picture's width that shows the other, 0 to 1.
    pub split: f32,
}

impl Compare {
    /// With the look as it is now.
    #[must_use]
    pub fn with_state(look: Look) -> Self {
        Self {
            look,
            path: None,
            name: "before".to_owned(),
            split: 0.5,
        }
    }

    /// With another preset.
    ///
    /// # Errors
    ///
    /// When it cannot be read.
    pub fn with_preset(path: &Path) -> Result<Self, hair_io::ReadError> {
        let text = hair_io::read_text(path, hair_io::MOST_OF_TEXT)?;
        Ok(Self {
            look: Look {
                name: path.display().to_string(),
                folder: path.parent().unwrap_or(Path::new("")).to_owned(),
                text: text.into(),
                ..Look::default()
            },
            path: Some(path.to_owned()),
            name: path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            split: 0.5,
        })
    }

    /// Reads another preset again, as it or files that it names have changed on the disk, for that many times in all. One that can't be read stays as it
    /// was; so does a state of the look that is edited.
    pub fn read_again(&mut self, files_changed: u64) {
        let Some(path) = &self.path else {
            return;
        };
        if let Ok(text) = hair_io::read_text(path, hair_io::MOST_OF_TEXT) {
            self.look.text = text.into();
        }
        self.look.files_changed = files_changed;
    }
}
