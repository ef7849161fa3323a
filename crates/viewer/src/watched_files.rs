//! Files that a look is read from, such as hair and heads: whether one of them changed on the disk.

use notify::{RecommendedWatcher, RecursiveMode, Watcher as _};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The folders of some files, watched.
pub struct WatchedFiles {
    folders: BTreeSet<PathBuf>,
    watcher: Option<RecommendedWatcher>,
    has_changed: Arc<AtomicBool>,
}

impl WatchedFiles {
    /// Watches nothing yet. `wake` is called, from another thread, when something changes.
    #[must_use]
    pub fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        let has_changed = Arc::new(AtomicBool::new(false));
        let told = has_changed.clone();
        let watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            // That a file was read is no news: we do so ourselves.
            if event.is_ok_and(|event| !event.kind.is_access()) {
                told.store(true, Ordering::Relaxed);
                wake();
            }
        });
        Self {
            folders: BTreeSet::new(),
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
        let folders: BTreeSet<PathBuf> = files.iter().map(folder).collect();
        let Some(watcher) = &mut self.watcher else {
            return;
        };
        for gone in self.folders.difference(&folders) {
            // It may be no more there.
            let _ = watcher.unwatch(gone);
        }
        for new in folders.difference(&self.folders) {
            // What cannot be watched is read anew with the next edit.
            let _ = watcher.watch(new, RecursiveMode::NonRecursive);
        }
        self.folders = folders;
    }

    /// Whether something changed since it was last asked.
    pub fn has_changed(&self) -> bool {
        self.has_changed.swap(false, Ordering::Relaxed)
    }
}
