//! Files that a look is read from, such as hair and heads: whether one of them changed on the disk.

use hair_io::WholeFile;
use notify::event::ModifyKind;
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher as _};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The folders of some files, watched.
pub struct WatchedFiles {
    /// Those that are to be watched, and those of them that are: others may not be there yet.
    folders: BTreeSet<PathBuf>,
    watched: BTreeSet<PathBuf>,
    /// What was deleted or renamed since it was last looked at: a folder that is made again is another one.
    gone: Arc<Mutex<Vec<PathBuf>>>,
    /// Names of the files, in small letters: of pictures in their folders no others are news, such as those that we export.
    names: Arc<Mutex<BTreeSet<String>>>,
    watcher: Option<RecommendedWatcher>,
    has_changed: Arc<AtomicBool>,
}

impl WatchedFiles {
    /// Watches nothing yet. `wake` is called, from another thread, when something changes.
    #[must_use]
    pub fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        let has_changed = Arc::new(AtomicBool::new(false));
        let told = has_changed.clone();
        let gone = Arc::<Mutex<Vec<PathBuf>>>::default();
        let lost = gone.clone();
        let names = Arc::<Mutex<BTreeSet<String>>>::default();
        let ours = names.clone();
        let watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            let Ok(event) = event else { return };
            // That a file was read is no news: we do so ourselves.
            if event.kind.is_access() {
                return;
            }
            let ours = ours.lock().unwrap_or_else(PoisonError::into_inner);
            let mut names = event.paths.iter().filter_map(|path| name_of(path));
            // Where the system lost count, it may be any.
            let is_ours =
                event.need_rescan() || names.any(|name| ours.contains(&name) || !is_output(&name));
            drop(ours);
            if !is_ours {
                return;
            }
            if may_lose(event.kind) {
                let mut lost = lost.lock().unwrap_or_else(PoisonError::into_inner);
                lost.extend(event.paths);
            }
            told.store(true, Ordering::Relaxed);
            wake();
        });
        Self {
            folders: BTreeSet::new(),
            watched: BTreeSet::new(),
            gone,
            names,
            watcher: watcher.ok(),
            has_changed,
        }
    }

    /// From now on watches the folders of these files.
    pub fn watch(&mut self, files: &[PathBuf]) {
        let folder = |file: &PathBuf| match file.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
            _ => Path::new(".").to_owned(),
        };
        self.folders = files.iter().map(folder).collect();
        // Also what links lead to.
        let real: Vec<PathBuf> = (files.iter())
            .filter_map(|file| file.canonicalize().ok())
            .collect();
        let names = files.iter().chain(&real).filter_map(|file| name_of(file));
        *self.names.lock().unwrap_or_else(PoisonError::into_inner) = names.collect();
        let others: Vec<PathBuf> = self.watched.difference(&self.folders).cloned().collect();
        others.iter().for_each(|folder| self.unwatch(folder));
        self.watch_missing();
    }

    /// Whether something changed since it was last asked.
    pub fn has_changed(&mut self) -> bool {
        let gone = std::mem::take(&mut *self.gone.lock().unwrap_or_else(PoisonError::into_inner));
        gone.iter().for_each(|path| self.unwatch(path));
        // What came with a folder that wasn't there, nobody has told.
        let has_more = self.watch_missing();
        self.has_changed.swap(false, Ordering::Relaxed) || has_more
    }

    /// Whether a folder isn't watched yet, so that [`Self::has_changed`] is to be asked in a while without anybody's doing.
    #[must_use]
    pub fn wants_care(&self) -> bool {
        self.watcher.is_some() && self.watched != self.folders
    }

    fn unwatch(&mut self, folder: &Path) {
        if self.watched.remove(folder)
            && let Some(watcher) = &mut self.watcher
        {
            // It may be no more there.
            let _ = watcher.unwatch(folder);
        }
    }

    /// Watches the folders that are not watched yet, as far as they can be. Whether there were such.
    fn watch_missing(&mut self) -> bool {
        let Some(watcher) = &mut self.watcher else {
            return false;
        };
        let before = self.watched.len();
        for folder in &self.folders {
            if !self.watched.contains(folder)
                && watcher.watch(folder, RecursiveMode::NonRecursive).is_ok()
            {
                self.watched.insert(folder.clone());
            }
        }
        self.watched.len() > before
    }
}

/// A file's name, in small letters: some systems don't tell them from large ones.
fn name_of(file: &Path) -> Option<String> {
    let name = file.file_name()?;
    Some(name.to_string_lossy().to_lowercase())
}

/// Whether a file of this name is a picture, or a part of a file that isn't whole yet.
fn is_output(name: &str) -> bool {
    [".png", ".apng"]
        .iter()
        .any(|ending| name.ends_with(ending))
        || WholeFile::is_part(name)
}

/// Whether what an event tells of may be there no more.
fn may_lose(kind: EventKind) -> bool {
    matches!(
        kind,
        EventKind::Remove(_) | EventKind::Modify(ModifyKind::Name(_))
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::time::{Duration, Instant};

    #[test]
    fn folders_come_and_go() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("hair");
        let file = folder.join("a.tfx");
        let mut files = WatchedFiles::new(Arc::new(|| {}));
        files.watch(std::slice::from_ref(&file));
        assert!(files.wants_care() && !files.has_changed());
        for _ in 0..2 {
            fs::create_dir(&folder).unwrap();
            assert!(files.has_changed() && !files.wants_care());
            fs::write(&file, "").unwrap();
            wait_until(|| files.has_changed());
            fs::remove_dir_all(&folder).unwrap();
            wait_until(|| {
                files.has_changed();
                files.wants_care()
            });
        }
        // One that is replaced at once is another one, too.
        fs::create_dir(&folder).unwrap();
        assert!(files.has_changed());
        fs::rename(&folder, place.path().join("old")).unwrap();
        fs::create_dir(&folder).unwrap();
        wait_until(|| files.has_changed());
        wait_until(|| {
            fs::write(&file, "").unwrap();
            files.has_changed()
        });
    }

    #[test]
    fn what_else_lies_beside_is_no_news() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("a.tfx");
        let woken = Arc::new(AtomicBool::new(false));
        let wakes = woken.clone();
        let mut files = WatchedFiles::new(Arc::new(move || wakes.store(true, Ordering::Relaxed)));
        files.watch(std::slice::from_ref(&file));
        assert!(!files.has_changed());
        // As we export it: written beside, and renamed.
        let picture = WholeFile::create(&place.path().join("frame_0001.png")).unwrap();
        picture.finish().unwrap();
        std::thread::sleep(Duration::from_millis(200));
        assert!(!files.has_changed() && !woken.load(Ordering::Relaxed));
        fs::write(place.path().join("b.tfx"), "").unwrap();
        wait_until(|| files.has_changed() && woken.load(Ordering::Relaxed));
    }

    #[track_caller]
    fn wait_until(mut is_so: impl FnMut() -> bool) {
        let started = Instant::now();
        while !is_so() {
            assert!(started.elapsed() < Duration::from_secs(20));
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}
