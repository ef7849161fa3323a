//! Small pictures of presets, drawn one after the other in a thread of their own.

use super::painter::{Backend, Painter};
use super::slot::Slot;
use super::{Look, Wish};
use crate::documents::bases;
use effects::Registry;
use stage::Hand;
use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

/// Width and height of thumbnails, pixels.
pub const SIZE_PX: [u32; 2] = [160, 120];
/// Samples a pixel.
const SAMPLES: u32 = 4;

/// How often the files of a picture that is shown are looked at.
const LOOK: Duration = Duration::from_secs(1);

/// A small picture of a preset.
#[derive(Clone, Debug)]
pub enum Thumbnail {
    /// It is not drawn yet.
    Waiting,
    /// Rows from above: red, green, blue, alpha, sRGB, straight; of [`SIZE_PX`].
    Drawn(Arc<Vec<u8>>),
    /// Why there is none.
    Failed(String),
}

/// Size and time of a file: where they are others, so is the picture.
type Stamp = Option<(u64, SystemTime)>;

/// A small picture, and of what.
struct Kept {
    /// The preset, and the files that its look was read from.
    stamps: Vec<(PathBuf, Stamp)>,
    /// When these were looked at last, if ever.
    looked: Option<Instant>,
    thumbnail: Thumbnail,
}

/// Small pictures, and the thread that draws them.
pub struct Thumbnails {
    wanted: Sender<PathBuf>,
    drawn: Arc<Mutex<BTreeMap<PathBuf, Kept>>>,
}

impl Thumbnails {
    /// Starts the thread. `wake` is called from it whenever there is another picture.
    #[must_use]
    pub fn start(registry: Arc<Registry>, wake: impl Fn() + Send + 'static) -> Self {
        let (wanted, received): (_, Receiver<PathBuf>) = channel();
        let drawn = Arc::<Mutex<BTreeMap<PathBuf, Kept>>>::default();
        let shared = drawn.clone();
        std::thread::spawn(move || {
            let mut painter = Painter::new();
            while let Ok(path) = received.recv() {
                let mut slot = Slot::new(&registry);
                let before = stamp(&path);
                let drawn = catch_unwind(AssertUnwindSafe(|| draw(&path, &mut slot, &mut painter)));
                let thumbnail = drawn.unwrap_or_else(|_| {
                    painter = Painter::new();
                    Thumbnail::Failed("drawing it failed by a bug".to_owned())
                });
                let mut others: Vec<PathBuf> = slot.files().collect();
                if matches!(thumbnail, Thumbnail::Failed(_)) {
                    others.extend(bases_of(&path)); // one of them may be what is to be mended
                    others.sort();
                    others.dedup();
                }
                let others = others.into_iter().filter(|file| *file != path);
                let others = others.map(|file| (stamp(&file), file));
                let mut stamps = vec![(path.clone(), before)];
                stamps.extend(others.map(|(stamp, file)| (file, stamp)));
                let mut drawn = shared.lock().unwrap_or_else(PoisonError::into_inner);
                // What has mistakes may not say all that it is read from: what it was read from counts still.
                let before = drawn.remove(&path);
                let failed = before.filter(|_| matches!(thumbnail, Thumbnail::Failed(_)));
                for file in failed.into_iter().flat_map(|before| before.stamps) {
                    if stamps.iter().all(|(known, _)| *known != file.0) {
                        stamps.push(file);
                    }
                }
                let looked = Some(Instant::now());
                drawn.insert(
                    path,
                    Kept {
                        stamps,
                        looked,
                        thumbnail,
                    },
                );
                drop(drawn);
                wake();
            }
        });
        Self { wanted, drawn }
    }

    /// The thumbnail of a preset, which is drawn from now on where it is not yet, or the preset or a file that it names has changed since.
    pub fn of(&self, path: &Path) -> Thumbnail {
        let mut drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = drawn.entry(path.to_owned()).or_insert_with(|| Kept {
            // Not drawn yet: of another file than there is.
            stamps: vec![(path.to_owned(), Some((0, SystemTime::UNIX_EPOCH)))],
            looked: None,
            thumbnail: Thumbnail::Waiting,
        });
        if kept.looked.is_some_and(|looked| looked.elapsed() < LOOK) {
            return kept.thumbnail.clone();
        }
        kept.looked = Some(Instant::now());
        let mut is_other = false;
        for (file, of) in &mut kept.stamps {
            let now = stamp(file);
            is_other |= *of != now;
            *of = now;
        }
        if is_other {
            // The old picture is shown until there is the new one. The thread ends with the window alone.
            let _ = self.wanted.send(path.to_owned());
        }
        kept.thumbnail.clone()
    }
}

fn stamp(path: &Path) -> Stamp {
    let about = fs::metadata(path).ok()?;
    Some((about.len(), about.modified().ok()?))
}

/// The files that a preset builds on, where it can be read.
fn bases_of(path: &Path) -> Vec<PathBuf> {
    let text = hair_io::read_text(path, hair_io::MOST_OF_TEXT);
    text.map_or_else(|_| Vec::new(), |text| bases(folder_of(path), text.into()))
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).to_owned()
}

fn draw(path: &Path, slot: &mut Slot, painter: &mut Painter) -> Thumbnail {
    let text = match hair_io::read_text(path, hair_io::MOST_OF_TEXT) {
        Ok(text) => text,
        Err(error) => return Thumbnail::Failed(error.to_string()),
    };
    let look = Look {
        name: path.display().to_string(),
        folder: folder_of(path),
        text: text.into(),
        ..Look::default()
    };
    if let Some(problem) = slot.follow(&look).first() {
        return Thumbnail::Failed(problem.to_string());
    }
    let Some(facts) = slot.facts() else {
        return Thumbnail::Failed("it draws nothing".to_owned());
    };
    let wish = Wish {
        looks: vec![look],
        opened: 0,
        camera: None,
        size_px: SIZE_PX,
        is_moving: false,
        samples: Some(SAMPLES),
        time_s: 0.0,
        hand: Hand::new(),
        backend: Backend::Cpu,
    };
    let drawn = (slot.advance(&wish, || true))
        .and_then(|_| slot.draw(&wish, &facts.camera, SIZE_PX, SAMPLES, painter));
    match drawn {
        Ok(drawn) => Thumbnail::Drawn(Arc::new(drawn.pixels)),
        Err(problem) => Thumbnail::Failed(problem.to_string()),
    }
}
