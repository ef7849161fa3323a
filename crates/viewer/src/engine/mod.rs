//! What draws, in a thread of its own: the newest wish is drawn, and the window never waits.

mod painter;
mod quality;
mod slot;
mod thumbnail;

pub use painter::Backend;
pub use thumbnail::{SIZE_PX as THUMBNAIL_SIZE_PX, Thumbnail, Thumbnails};

use crate::layers_shown::LayersShown;
use effects::Registry;
use effects::preset::PresetError;
use painter::Painter;
use quality::Quality;
use slot::Slot;
use stage::{CameraSection, Hand};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long hair is moved towards where it is wished, once there is a newer wish: then it is drawn as far as it came. Without that, wishes
/// that come one after the other, as those of a drag do, would never be seen.
const LONGEST_WHILE_NEWER: Duration = Duration::from_millis(150);

/// A preset's text, and what belongs to it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Look {
    /// What messages call the file.
    pub name: String,
    /// The folder that the names of its files are relative to.
    pub folder: PathBuf,
    /// The preset.
    pub text: Arc<str>,
    /// Styles and scripts that are edited, in place of those on the disk.
    pub texts: BTreeMap<PathBuf, Arc<str>>,
    /// Another number whenever files that it names may have changed on the disk.
    pub files_changed: u64,
    /// Which of its layers are drawn.
    pub layers: LayersShown,
}

/// What is to be seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// The look; where there are two, the second is to be compared with it, in the same view.
    pub looks: Vec<Look>,
    /// Another number for each preset that is opened or compared with: what was drawn of another one is not shown in its place.
    pub opened: u64,
    /// From where it is seen; the first look's own camera where there is none.
    pub camera: Option<CameraSection>,
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Whether something goes on moving, so that speed comes before sharpness.
    pub is_moving: bool,
    /// Samples a pixel at rest; the preset's where there are none.
    pub samples: Option<u32>,
    /// Seconds in the scene.
    pub time_s: f32,
    /// What moves head and wind beside the script.
    pub hand: Hand,
    /// What draws.
    pub backend: Backend,
}

/// Where the time of a frame went, milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Reading the preset, and loading what it names.
    pub load: f64,
    /// Moving head and hair.
    pub simulate: f64,
    /// Projecting strands.
    pub paths: f64,
    /// Making strokes.
    pub effects: f64,
    /// Colouring pixels.
    pub raster: f64,
}

impl Times {
    /// Of a frame of a scene that is loaded.
    #[must_use]
    pub fn frame(&self) -> f64 {
        self.simulate + self.paths + self.effects + self.raster
    }
}

/// What the window has to know of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// Width and height that the preset asks for, pixels.
    pub size_px: [u32; 2],
    /// Steps of its time a second.
    pub fps: f32,
    /// Samples a pixel that the preset asks for.
    pub samples: u32,
    /// The preset's own view.
    pub camera: CameraSection,
    /// The length of the longest animation that moves a head, seconds; 0 without any.
    pub animation_s: f32,
    /// Strands in all.
    pub strands: usize,
    /// Sentences about what was guessed of its files.
    pub notes: Vec<String>,
    /// Names of its layers, in the preset's order.
    pub layers: Vec<String>,
}

/// A picture of one look.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Rows from above: red, green, blue, alpha, sRGB, straight.
    pub pixels: Vec<u8>,
    /// Width and height.
    pub size_px: [u32; 2],
    /// Samples a pixel.
    pub samples: u32,
    /// Where the time went.
    pub times: Times,
    /// Segments of all strokes.
    pub segments: usize,
    /// Strands that are drawn.
    pub strands: usize,
    /// What drew, in words.
    pub backend: String,
    /// About the scene.
    pub facts: Arc<Facts>,
}

/// What became of a wish.
#[derive(Clone, Debug, Default)]
pub struct Answer {
    /// [`Wish::opened`] of the wish.
    pub opened: u64,
    /// A picture of each look; none of one that could not be drawn yet.
    pub pictures: Vec<Option<Drawn>>,
    /// What is wrong with the looks. A look with mistakes goes on showing its last good state.
    pub problems: Vec<Problem>,
    /// Whether that is so of the first look.
    pub is_outdated: bool,
    /// The files that the looks are read from, as far as their texts can be read.
    pub files: Vec<PathBuf>,
    /// Whether it is as sharp as it gets.
    pub is_final: bool,
}

/// Something wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Problem {
    /// A mistake of a file at its place.
    Mistake(PresetError),
    /// Anything else, in a sentence.
    Failed(String),
}

/// The thread's end that the window has.
pub struct Engine {
    wishes: Sender<(u64, Wish)>,
    answers: Arc<Mutex<Option<(u64, Answer)>>>,
    last: Option<Wish>,
    /// How many wishes there were.
    number: u64,
    /// The number of the wish that was answered last.
    answered: u64,
}

impl Engine {
    /// Starts the thread. `wake` is called from it whenever there is an answer.
    #[must_use]
    pub fn start(registry: Arc<Registry>, wake: impl Fn() + Send + 'static) -> Self {
        let (wishes, received) = channel();
        let answers = Arc::new(Mutex::new(None));
        let shared = answers.clone();
        std::thread::spawn(move || {
            let answer = |number: u64, answer: Answer| {
                *shared.lock().unwrap_or_else(PoisonError::into_inner) = Some((number, answer));
                wake();
            };
            let wishes = Wishes {
                received,
                newer: None,
            };
            Drawer::new(&registry).serve(wishes, answer);
        });
        Self {
            wishes,
            answers,
            last: None,
            number: 0,
            answered: 0,
        }
    }

    /// Wishes for something to be seen; the same wish again is none. Whether it is another one.
    pub fn wish(&mut self, wish: Wish) -> bool {
        let is_new = self.last.as_ref() != Some(&wish);
        if is_new {
            // The thread ends with the window alone.
            let _ = self.wishes.send((self.number + 1, wish.clone()));
            self.number += 1;
            self.last = Some(wish);
        }
        is_new
    }

    /// What was wished for last.
    #[must_use]
    pub fn last(&self) -> Option<&Wish> {
        self.last.as_ref()
    }

    /// Whether the newest wish has no answer yet; there will be one, and the window is woken.
    #[must_use]
    pub fn is_drawing(&self) -> bool {
        self.answered != self.number
    }

    /// The newest answer, if it was not taken yet. What is no answer to the newest wish is not final.
    pub fn answer(&mut self) -> Option<Answer> {
        let mut answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
        let (number, mut answer) = answers.take()?;
        self.answered = number;
        answer.is_final &= number == self.number;
        Some(answer)
    }
}

/// The thread's own.
struct Drawer<'r> {
    slots: Vec<Slot<'r>>,
    registry: &'r Registry,
    painter: Painter,
    quality: Quality,
    /// [`Wish::opened`] of what the slots hold.
    opened: u64,
}

impl<'r> Drawer<'r> {
    fn new(registry: &'r Registry) -> Self {
        Self {
            slots: Vec::new(),
            registry,
            painter: Painter::new(),
            quality: Quality::new(),
            opened: 0,
        }
    }

    /// Draws the newest of the wishes until nobody wishes any more. At rest a picture is drawn roughly first, then sharp, unless
    /// another wish comes between.
    fn serve(&mut self, mut wishes: Wishes, answer: impl Fn(u64, Answer)) {
        while let Some((number, wish)) = wishes.next() {
            let Some(mut first) = self.draw(&wish, true, &mut wishes) else {
                continue;
            };
            first.is_final &= !wish.is_moving;
            let is_final = first.is_final || wish.is_moving;
            answer(number, first);
            if !is_final && !wishes.has_newer_within(self.quality.patience(wish.size_px)) {
                let sharp = self.draw(&wish, false, &mut wishes);
                sharp.into_iter().for_each(|sharp| answer(number, sharp));
            }
        }
    }

    /// Draws what is wished for; nothing where a newer wish came before it was sharp. Where an effect has a bug, that is told, and all is
    /// made anew for the next wish.
    fn draw(&mut self, wish: &Wish, is_rough: bool, wishes: &mut Wishes) -> Option<Answer> {
        let drawn = catch_unwind(AssertUnwindSafe(|| self.draw_looks(wish, is_rough, wishes)));
        drawn.unwrap_or_else(|_| {
            let files = self.slots.iter().flat_map(Slot::files).collect();
            *self = Self::new(self.registry);
            let message = "drawing failed by a bug, which is told where the viewer was started";
            Some(Answer {
                opened: wish.opened,
                pictures: Vec::new(),
                problems: vec![Problem::Failed(message.to_owned())],
                is_outdated: true,
                files,
                is_final: true,
            })
        })
    }

    fn draw_looks(&mut self, wish: &Wish, is_rough: bool, wishes: &mut Wishes) -> Option<Answer> {
        let mut answer = Answer {
            opened: wish.opened,
            is_final: true,
            ..Answer::default()
        };
        if self.opened != wish.opened {
            self.opened = wish.opened;
            self.slots.clear();
        }
        self.slots
            .resize_with(wish.looks.len(), || Slot::new(self.registry));
        let mut camera = wish.camera.clone();
        let begun = Instant::now();
        for (index, (look, slot)) in wish.looks.iter().zip(&mut self.slots).enumerate() {
            if !is_rough && wishes.has_newer() {
                return None;
            }
            let started = Instant::now();
            let problems = slot.follow(look);
            if index == 0 {
                answer.is_outdated = !problems.is_empty();
            }
            answer.files.extend(slot.files());
            answer.problems.extend(problems);
            let load = started.elapsed().as_secs_f64() * 1e3;
            let Some(facts) = slot.facts() else {
                answer.pictures.push(None);
                continue;
            };
            // Both looks are seen alike.
            let camera = camera.get_or_insert_with(|| facts.camera.clone());
            let wanted = wish.samples.unwrap_or(facts.samples);
            let (size_px, samples) = if is_rough {
                self.quality
                    .choose(wish.size_px, wanted, wish.is_moving, wish.looks.len())
            } else {
                (wish.size_px, wanted)
            };
            answer.is_final &= (size_px, samples) == (wish.size_px, wanted);
            let started = Instant::now();
            let advanced = slot.advance(wish, || {
                begun.elapsed() < LONGEST_WHILE_NEWER || !wishes.has_newer()
            });
            let simulate = started.elapsed().as_secs_f64() * 1e3;
            let drawn = advanced.and_then(|is_there| {
                answer.is_final &= is_there;
                slot.draw(wish, camera, size_px, samples, &mut self.painter)
            });
            match drawn {
                Ok(mut drawn) => {
                    drawn.times.simulate = simulate;
                    self.quality.learn(size_px, samples, &drawn.times);
                    drawn.times.load = load;
                    answer.pictures.push(Some(drawn));
                }
                Err(problem) => {
                    answer.problems.push(problem);
                    answer.is_outdated |= index == 0;
                    answer.pictures.push(None);
                }
            }
        }
        answer.problems.extend(self.painter.problem());
        Some(answer)
    }
}

/// What is wished for, as the thread gets it.
struct Wishes {
    received: Receiver<(u64, Wish)>,
    /// The newest of those that came while one was drawn.
    newer: Option<(u64, Wish)>,
}

impl Wishes {
    /// The newest wish; waits for one. Nothing where nobody wishes any more.
    fn next(&mut self) -> Option<(u64, Wish)> {
        if !self.has_newer() {
            self.newer = self.received.recv().ok();
            // One may be newer still.
            self.has_newer();
        }
        self.newer.take()
    }

    /// Whether there is another wish than the one that is drawn, or nobody wishes any more.
    fn has_newer(&mut self) -> bool {
        loop {
            match self.received.try_recv() {
                Ok(newer) => self.newer = Some(newer),
                Err(TryRecvError::Empty) => return self.newer.is_some(),
                Err(TryRecvError::Disconnected) => return true,
            }
        }
    }

    /// The same, before so much time has passed.
    fn has_newer_within(&mut self, patience: Duration) -> bool {
        if !self.has_newer() {
            match self.received.recv_timeout(patience) {
                Ok(newer) => self.newer = Some(newer),
                Err(RecvTimeoutError::Timeout) => return false,
                Err(RecvTimeoutError::Disconnected) => return true,
            }
        }
        true
    }
}

impl std::fmt::Display for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Mistake(mistake) => mistake.fmt(f),
            Self::Failed(message) => f.write_str(message),
        }
    }
}
