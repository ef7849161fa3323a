//! Small pictures of presets, drawn one after the other in a thread of their own.

use super::painter::{Backend, Painter};
use super::slot::Slot;
use super::{Look, Wish};
use effects::Registry;
use stage::Hand;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// Width and height of thumbnails, pixels.
pub const SIZE_PX: [u32; 2] = [160, 120];
/// Samples a pixel.
const SAMPLES: u32 = 4;

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

/// Small pictures, and the thread that draws them.
pub struct Thumbnails {
    wanted: Sender<PathBuf>,
    drawn: Arc<Mutex<BTreeMap<PathBuf, Thumbnail>>>,
}

impl Thumbnails {
    /// Starts the thread. `wake` is called from it whenever there is another picture.
    #[must_use]
    pub fn start(registry: Arc<Registry>, wake: impl Fn() + Send + 'static) -> Self {
        let (wanted, received): (_, Receiver<PathBuf>) = channel();
        let drawn = Arc::new(Mutex::new(BTreeMap::new()));
        let shared = drawn.clone();
        std::thread::spawn(move || {
            let mut painter = Painter::new();
            while let Ok(path) = received.recv() {
                let thumbnail = draw(&path, &registry, &mut painter);
                let mut drawn = shared.lock().unwrap_or_else(PoisonError::into_inner);
                drawn.insert(path, thumbnail);
                drop(drawn);
                wake();
            }
        });
        Self { wanted, drawn }
    }

    /// The thumbnail of a preset, which is drawn from now on where it is not yet.
    pub fn of(&self, path: &Path) -> Thumbnail {
        let mut drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(thumbnail) = drawn.get(path) {
            return thumbnail.clone();
        }
        drawn.insert(path.to_owned(), Thumbnail::Waiting);
        // The thread ends with the window alone.
        let _ = self.wanted.send(path.to_owned());
        Thumbnail::Waiting
    }

    /// Forgets the thumbnail of a preset, so that it is drawn anew: the file has changed.
    pub fn forget(&self, path: &Path) {
        let mut drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        drawn.remove(path);
    }
}

fn draw(path: &Path, registry: &Registry, painter: &mut Painter) -> Thumbnail {
    let text = match hair_io::read_text(path, hair_io::MOST_OF_TEXT) {
        Ok(text) => text,
        Err(error) => return Thumbnail::Failed(error.to_string()),
    };
    let look = Look {
        name: path.display().to_string(),
        folder: path.parent().unwrap_or(Path::new("")).to_owned(),
        text: text.into(),
        ..Look::default()
    };
    let mut slot = Slot::new(registry);
    if let Some(problem) = slot.follow(&look).first() {
        return Thumbnail::Failed(problem.to_string());
    }
    let Some(facts) = slot.facts() else {
        return Thumbnail::Failed("it draws nothing".to_owned());
    };
    let wish = Wish {
        looks: vec![look],
        camera: None,
        size_px: SIZE_PX,
        is_moving: false,
        samples: Some(SAMPLES),
        time_s: 0.0,
        hand: Hand::new(),
        backend: Backend::Cpu,
    };
    match slot.draw(&wish, &facts.camera, SIZE_PX, SAMPLES, painter) {
        Ok(drawn) => Thumbnail::Drawn(Arc::new(drawn.pixels)),
        Err(problem) => Thumbnail::Failed(problem.to_string()),
    }
}
