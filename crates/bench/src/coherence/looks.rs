//! Looks of `presets` on a turning camera, a shaking head and in wind; and real hair.

use super::animation::{Animation, Kind, TICKS, Tick, seconds};
use crate::{BenchError, frame};
use render::Frame;
use stage::{Files, Stage};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What moves in a look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// The camera, 30 degrees a second around the head.
    Orbit,
    /// The head, from side to side.
    Shake,
    /// The hair, in wind; and the head as in walking.
    Wind,
}

/// All motions.
pub const MOTIONS: [Motion; 3] = [Motion::Orbit, Motion::Shake, Motion::Wind];

/// Degrees a second.
const ORBIT: f64 = 30.0;

impl Motion {
    /// In the table.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Orbit => "orbit",
            Self::Shake => "shake",
            Self::Wind => "wind",
        }
    }

    /// Its script, in the project's folder.
    fn script(self) -> Option<&'static str> {
        match self {
            Self::Orbit => None,
            Self::Shake => Some("crates/bench/src/coherence/shake.motion.ron"),
            Self::Wind => Some("presets/motions/walk-in-wind.motion.ron"),
        }
    }

    /// When it is looked at: stretches of time, half a second in all, or a tenth of one.
    #[must_use]
    pub fn windows(self, quick: bool) -> Vec<Range<Tick>> {
        match self {
            // From six sides.
            Self::Orbit => {
                let length = TICKS / if quick { 64 } else { 12 };
                let starts = (0..6).map(|sixth| sixth * 2 * TICKS);
                starts.map(|start| start..start + length).collect()
            }
            // Once hair swings.
            Self::Shake | Self::Wind => {
                let start = TICKS + TICKS / 4;
                let length = if quick { TICKS / 64 * 6 } else { TICKS / 2 };
                std::iter::once(start..start + length).collect()
            }
        }
    }
}

/// Where a look comes from.
#[derive(Clone, Debug)]
pub struct Look {
    /// In the table.
    pub name: String,
    /// The project's folder.
    root: PathBuf,
    preset: PathBuf,
    hair: Option<PathBuf>,
    head: Option<PathBuf>,
    /// Strands kept; 0 keeps all.
    guides: u32,
    /// Whether what its preset does with the whole picture is done.
    passes: bool,
}

/// The project's looks, by name. A preset that puts other presets' heads into one picture is none of its own, nor is one without
/// hair.
///
/// # Errors
///
/// When the folder cannot be read.
pub fn looks(root: &Path) -> Result<Vec<Look>, BenchError> {
    let registry = frame::registry()?;
    let folder = root.join("presets");
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut looks = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(failed)? {
        let preset = entry.map_err(failed)?.path();
        if preset.extension().is_some_and(|ending| ending == "ron") {
            let read = frame::preset(&preset, &registry)?;
            if !read.objects.is_empty() || read.sections.hair.file.is_none() {
                continue;
            }
            let name = preset.file_stem().unwrap_or_default();
            looks.push(Look {
                name: name.to_string_lossy().into_owned(),
                root: root.to_owned(),
                preset,
                hair: None,
                head: None,
                guides: 0,
                passes: false,
            });
        }
    }
    looks.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(looks)
}

/// Sintel's hair on her head, 200 strands of it, with outlines.
#[must_use]
pub fn sintel(root: &Path, data: &Path) -> Look {
    Look {
        name: "sintel".to_owned(),
        root: root.to_owned(),
        preset: root.join("presets/outlined.ron"),
        hair: Some(data.join("sintel/sintel_hair_16points.tfx")),
        head: Some(data.join("sintel/sintel.obj")),
        guides: 200,
        passes: false,
    }
}

/// A look that moves.
pub struct MovingLook {
    stage: Stage,
    motion: Option<Motion>,
    /// The preset's own, in degrees.
    yaw: f64,
}

impl Look {
    /// The same look with what its preset does with the whole picture, if that is anything.
    ///
    /// # Errors
    ///
    /// When the preset cannot be read.
    pub fn with_passes(&self) -> Result<Option<Self>, BenchError> {
        let registry = frame::registry()?;
        let preset = frame::preset(&self.preset, &registry)?;
        Ok((!preset.passes.is_empty()).then(|| Self {
            name: format!("{}-lines", self.name),
            passes: true,
            ..self.clone()
        }))
    }

    /// What its figures are held to.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self.passes {
            true => Kind::Passes,
            false => Kind::Hair,
        }
    }

    /// The look in motion, or still, drawn at a part of its preset's size: 2 is half as wide and high.
    ///
    /// # Errors
    ///
    /// When a file of it cannot be read.
    pub fn open(&self, motion: Option<Motion>, part: u32) -> Result<MovingLook, BenchError> {
        let registry = frame::registry()?;
        let mut preset = frame::preset(&self.preset, &registry)?;
        if !self.passes {
            preset.passes.clear();
        }
        let sections = &mut preset.sections;
        sections.scene.size = sections.scene.size.map(|side| side.div_ceil(part));
        sections.dynamics.step = seconds(1) as f32;
        sections.scene.background.get_or_insert([1.0; 3]);
        if self.guides > 0 {
            sections.hair.guides = self.guides;
        }
        let script = motion.and_then(Motion::script);
        if script.is_none() {
            // Still, or the camera moves alone: whatever the preset's own script would do.
            sections.motion.file = None;
        }
        let files = Files {
            hair: self.hair.clone(),
            head: self.head.clone(),
            motion: script.map(|file| self.root.join(file)),
            preset_folder: self.root.join("presets"),
            ..Files::default()
        };
        Ok(MovingLook {
            stage: Stage::new(&preset, &files).map_err(|error| error.to_string())?,
            motion,
            yaw: f64::from(preset.sections.camera.yaw),
        })
    }
}

impl MovingLook {
    /// Where the camera stands at a moment, in degrees.
    #[must_use]
    pub fn yaw(&self, tick: Tick) -> f64 {
        match self.motion {
            Some(Motion::Orbit) => self.yaw + ORBIT * seconds(tick),
            _ => self.yaw,
        }
    }
}

impl Animation for MovingLook {
    fn at(&mut self, tick: Tick) -> Result<Frame<'_>, BenchError> {
        self.stage.scene.camera.yaw = self.yaw(tick) as f32;
        self.stage
            .advance_to(seconds(tick) as f32)
            .and_then(|()| self.stage.frame())
            .map_err(|error| error.to_string().into())
    }
}
