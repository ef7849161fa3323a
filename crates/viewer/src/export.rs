//! Pictures and sequences into files: the command line that does it, run as it stands.

use crate::engine::Backend;
use effects::Registry;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What is to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Where the picture goes.
    pub output: String,
    /// First and last frame of a sequence; one picture where there is none.
    pub frames: Option<[u32; 2]>,
    /// Width and height, where they are not the preset's.
    pub size_px: Option<[u32; 2]>,
    /// Samples a pixel, where they are not the preset's.
    pub samples: Option<u32>,
    /// What draws.
    pub backend: Backend,
    /// Whether there is nothing behind the hair.
    pub is_transparent: bool,
}

/// What of the viewer's state a picture hangs on, beside the files.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// The preset's file.
    pub preset: PathBuf,
    /// Yaw, pitch, distance and target of a view that is not the preset's own.
    pub view: Option<stage::CameraSection>,
    /// The time of the frame that is shown, seconds.
    pub time_s: f32,
    /// Layers that are shown, where not all are.
    pub only: Vec<String>,
}

impl Settings {
    /// The arguments of `inkstrand` that draw this.
    #[must_use]
    pub fn arguments(&self, state: &State) -> Vec<String> {
        let mut words = vec!["render".to_owned(), state.preset.display().to_string()];
        let mut add = |name: &str, value: String| words.extend([name.to_owned(), value]);
        add("-o", self.output.clone());
        match self.frames {
            Some([first, last]) => add("--frames", format!("{first}-{last}")),
            None if state.time_s > 0.0 => add("--time", state.time_s.to_string()),
            None => {}
        }
        if let Some([width, height]) = self.size_px {
            add("--size", format!("{width}x{height}"));
        }
        if let Some(samples) = self.samples {
            add("--samples", samples.to_string());
        }
        if self.backend != Backend::Auto {
            add("--backend", self.backend.name().to_owned());
        }
        if self.is_transparent {
            add("--background", "none".to_owned());
        }
        if let Some(camera) = &state.view {
            let (yaw, pitch, distance) = (camera.yaw, camera.pitch, camera.distance);
            add("--camera", format!("{yaw},{pitch},{distance}"));
            let [x, y, z] = camera.target;
            add("--set", format!("camera.target=({x}, {y}, {z})"));
        }
        for layer in &state.only {
            add("--only", layer.clone());
        }
        words
    }

    /// The same as one line for a shell.
    #[must_use]
    pub fn command_line(&self, state: &State) -> String {
        let words = self.arguments(state);
        let words = words.iter().map(|word| inkstrand::shell_word(word));
        let mut line = vec!["inkstrand".to_owned()];
        line.extend(words);
        line.join(" ")
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// An export under way, or done.
pub struct Running {
    /// Frames that are done, and all there are.
    done: Arc<[AtomicU64; 2]>,
    is_cancelled: Arc<AtomicBool>,
    result: Arc<Mutex<Option<Result<String, String>>>>,
}

impl Running {
    /// Begins in a thread of its own. `wake` is called whenever there is something new to show.
    #[must_use]
    pub fn start(
        arguments: Vec<String>,
        registry: Arc<Registry>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        let running = Self {
            done: Arc::default(),
            is_cancelled: Arc::default(),
            result: Arc::default(),
        };
        let (done, is_cancelled) = (running.done.clone(), running.is_cancelled.clone());
        let result = running.result.clone();
        std::thread::spawn(move || {
            let drawn = catch_unwind(AssertUnwindSafe(|| {
                inkstrand::render_with(&arguments, &registry, &mut |progress| {
                    done[0].store(progress.done, Ordering::Relaxed);
                    done[1].store(progress.all, Ordering::Relaxed);
                    wake();
                    !is_cancelled.load(Ordering::Relaxed)
                })
            }));
            // An effect of somebody's may have a bug, which is told where the window was started.
            let found = drawn.unwrap_or_else(|_| Err("drawing failed by a bug".to_owned()));
            *result.lock().unwrap_or_else(PoisonError::into_inner) = Some(found);
            wake();
        });
        running
    }

    /// Frames that are done, and all there are; 0 of 0 before it is known.
    #[must_use]
    pub fn progress(&self) -> [u64; 2] {
        [0, 1].map(|i| self.done[i].load(Ordering::Relaxed))
    }

    /// Ends it after the frame that is drawn now.
    pub fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// What was written, or why not; nothing while it is under way.
    #[must_use]
    pub fn result(&self) -> Option<Result<String, String>> {
        self.result
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}
