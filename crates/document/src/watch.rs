//! Who tells of changes of a file: its folder is watched, for editors put a new file in its place.

use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher as _};
use std::collections::HashSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How long nothing must have happened to the file before it is read: who empties it first and writes then is done.
const QUIET: Duration = Duration::from_millis(40);
/// How long somebody may write without a pause until it is read anyway.
const LONGEST: Duration = Duration::from_millis(400);
/// How often time and size are looked at where nobody watches.
const LOOK_UNWATCHED: Duration = Duration::from_secs(1);
/// How often where somebody does: file systems of a network tell nothing, and a folder may be replaced.
const LOOK_WATCHED: Duration = Duration::from_secs(5);

type Callback = Arc<Mutex<Option<Box<dyn Fn() + Send>>>>;

pub(crate) struct Watch {
    /// Dropped it stops, and so does the thread that waits for its events.
    watcher: Option<RecommendedWatcher>,
    told: Receiver<()>,
    callback: Callback,
    looked: Instant,
}

impl Watch {
    pub fn new(path: &Path) -> Self {
        let callback = Callback::default();
        let (watcher, told) = start(path, &callback);
        Self {
            watcher,
            told,
            callback,
            looked: Instant::now(),
        }
    }

    /// Watches another file from now on.
    pub fn watch(&mut self, path: &Path) {
        (self.watcher, self.told) = start(path, &self.callback);
    }

    pub fn on_change(&self, callback: Option<Box<dyn Fn() + Send>>) {
        *self.callback.lock().unwrap_or_else(PoisonError::into_inner) = callback;
    }

    pub fn is_on(&self) -> bool {
        self.watcher.is_some()
    }

    /// Whether a change was told since the last call, or, looked at now and then, the file is another one.
    pub fn was_told(&mut self, is_outdated: impl Fn() -> bool) -> bool {
        let every = if self.is_on() {
            LOOK_WATCHED
        } else {
            LOOK_UNWATCHED
        };
        let told = self.told.try_iter().count() > 0;
        if !told && self.looked.elapsed() < every {
            return false;
        }
        self.looked = Instant::now();
        told || is_outdated()
    }
}

/// A watcher of the file's folder, if one can be had, and where it tells.
fn start(path: &Path, callback: &Callback) -> (Option<RecommendedWatcher>, Receiver<()>) {
    let (tell, told) = mpsc::channel();
    let (event, events) = mpsc::channel();
    let watcher = watcher(path, event).ok().filter(|_| {
        let callback = callback.clone();
        let thread = thread::Builder::new().name("document-watch".to_owned());
        thread
            .spawn(move || pass_on(&events, &tell, &callback))
            .is_ok()
    });
    (watcher, told)
}

fn watcher(path: &Path, event: Sender<()>) -> notify::Result<RecommendedWatcher> {
    // Where a link points, and the link.
    let places = [Some(path.to_owned()), fs::canonicalize(path).ok()];
    let places: Vec<PathBuf> = places.into_iter().flatten().collect();
    let names: HashSet<OsString> = places
        .iter()
        .filter_map(|place| place.file_name())
        .map(OsString::from)
        .collect();
    let mut watcher = notify::recommended_watcher(move |told: notify::Result<Event>| {
        if told.map_or(true, |told| may_change(&told, &names)) {
            // Nobody listens any more once the document is gone.
            let _ = event.send(());
        }
    })?;
    let folders: HashSet<&Path> = places.iter().map(|p| hair_io::folder_of(p)).collect();
    for folder in folders {
        watcher.watch(folder, RecursiveMode::NonRecursive)?;
    }
    Ok(watcher)
}

/// Whether a file of these names may have changed. Reading is none.
fn may_change(event: &Event, names: &HashSet<OsString>) -> bool {
    let is_reading = matches!(
        event.kind,
        EventKind::Access(access)
            if !matches!(access, notify::event::AccessKind::Close(notify::event::AccessMode::Write))
    );
    let is_named = |path: &PathBuf| path.file_name().is_some_and(|name| names.contains(name));
    event.need_rescan()
        || (!is_reading && (event.paths.is_empty() || event.paths.iter().any(is_named)))
}

/// Tells of events once no more come, until there is nobody to tell.
fn pass_on(events: &Receiver<()>, tell: &Sender<()>, callback: &Callback) {
    while events.recv().is_ok() {
        let first = Instant::now();
        while first.elapsed() < LONGEST {
            match events.recv_timeout(QUIET) {
                Ok(()) => {}
                Err(RecvTimeoutError::Timeout) => break,
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
        if tell.send(()).is_err() {
            return;
        }
        if let Some(call) = &*callback.lock().unwrap_or_else(PoisonError::into_inner) {
            call();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn where_nobody_watches_it_is_looked_at_every_second() {
        let mut watch = Watch {
            watcher: None,
            told: mpsc::channel().1,
            callback: Callback::default(),
            looked: Instant::now(),
        };
        let looks = Cell::new(0);
        let is_outdated = || {
            looks.set(looks.get() + 1);
            looks.get() > 1
        };
        assert!(!watch.was_told(is_outdated));
        assert_eq!(looks.get(), 0);
        for (count, is_told) in [(1, false), (2, true)] {
            watch.looked -= LOOK_UNWATCHED;
            assert_eq!(watch.was_told(is_outdated), is_told);
            assert_eq!(looks.get(), count);
        }
        assert!(!watch.was_told(is_outdated));
    }

    #[test]
    fn a_folder_that_is_not_there_is_not_watched() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Watch::new(&folder.path().join("a.ron")).is_on());
        assert!(!Watch::new(&folder.path().join("none/a.ron")).is_on());
    }
}
