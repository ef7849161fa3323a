//! A path that is typed, with what is in its folder to choose from: native dialogs return nothing on some desktops.

use eframe::egui::{Key, ScrollArea, TextEdit, Ui};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How often the folder is looked at anew.
const STALE: Duration = Duration::from_secs(1);
/// The most entries of a folder that are shown.
const MOST_SHOWN: usize = 500;

/// A path that is typed.
pub struct PathField {
    text: String,
    endings: &'static [&'static str],
    /// What is wrong with the path.
    pub error: Option<String>,
    listed: Option<Listing>,
    has_focus: bool,
}

/// What was in a folder when it was last looked at.
struct Listing {
    folder: PathBuf,
    at: Instant,
    entries: Vec<Entry>,
}

/// A file or folder.
struct Entry {
    name: String,
    is_folder: bool,
}

impl PathField {
    /// A field with a name in a folder; of the folder's files those with one of the endings are offered.
    #[must_use]
    pub fn new(folder: &Path, name: &str, endings: &'static [&'static str]) -> Self {
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        Self {
            text: folder.join(name).display().to_string(),
            endings,
            error: None,
            listed: None,
            has_focus: false,
        }
    }

    /// The path as it is typed.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        PathBuf::from(self.text.trim())
    }

    /// Shows field and folder. Whether Enter was pressed in the field, or a file double clicked.
    pub fn show(&mut self, ui: &mut Ui) -> bool {
        let field = TextEdit::singleline(&mut self.text).desired_width(f32::INFINITY);
        let response = ui.add(field).accessible_name("Path");
        if !self.has_focus {
            response.request_focus();
            self.has_focus = true;
        }
        if response.changed() {
            self.error = None;
        }
        let mut is_done = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let path = self.path();
        let folder = match self.text.ends_with(['/', '\\']) || path.is_dir() {
            true => path,
            false => path.parent().unwrap_or(Path::new("")).to_owned(),
        };
        let is_known = |listing: &Listing| listing.folder == folder && listing.at.elapsed() < STALE;
        if !self.listed.as_ref().is_some_and(is_known) {
            self.listed = Some(Listing {
                entries: list(&folder, self.endings),
                folder: folder.clone(),
                at: Instant::now(),
            });
        }
        let mut chosen = None;
        let entries = self.listed.iter().flat_map(|listing| &listing.entries);
        ScrollArea::vertical()
            .max_height(220.0)
            .auto_shrink([false, true])
            .show(ui, |ui| {
                if folder.parent().is_some() && ui.selectable_label(false, "../").clicked() {
                    chosen = Some((folder.join(".."), true));
                }
                for Entry { name, is_folder } in entries {
                    let slash = if *is_folder { "/" } else { "" };
                    let entry = ui.selectable_label(false, format!("{name}{slash}"));
                    if entry.clicked() {
                        chosen = Some((folder.join(name), *is_folder));
                    }
                    is_done |= !is_folder && entry.double_clicked();
                }
            });
        if let Some((path, is_folder)) = chosen {
            self.text = path.display().to_string();
            if is_folder {
                self.text.push('/');
            }
            self.error = None;
        }
        is_done
    }
}

/// Folders and files of these endings in a folder, hidden ones left out: folders first, then by name.
fn list(folder: &Path, endings: &[&str]) -> Vec<Entry> {
    let here = Path::new(".");
    let folder = if folder.as_os_str().is_empty() {
        here
    } else {
        folder
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<Entry> = entries
        .map(|entry| Entry {
            name: entry.file_name().to_string_lossy().into_owned(),
            is_folder: entry.path().is_dir(),
        })
        .filter(|entry| {
            let ending = Path::new(&entry.name).extension();
            let ending = ending.map(|ending| ending.to_string_lossy().to_lowercase());
            let fits = ending.is_some_and(|ending| endings.contains(&ending.as_str()));
            !entry.name.starts_with('.') && (entry.is_folder || fits)
        })
        .collect();
    found.sort_by(|a, b| b.is_folder.cmp(&a.is_folder).then(a.name.cmp(&b.name)));
    found.truncate(MOST_SHOWN);
    found
}
