//! The hair: all that this program has to do with inkstrand.

use crate::Outcome;
use crate::view::View;
use effects::{Registry, RegistryError};
use render::gpu::{PassFormat, Renderer};
use stage::{Files, Preset, Stage};
use std::path::{Path, PathBuf};

/// Samples that the hair is drawn with in each pixel. A pass must have as many, or 1: then they make the edges' alpha.
pub const SAMPLES: u32 = 4;

/// Steps of the simulation in a second of the scene.
const STEPS_PER_SECOND: f32 = 60.0;

/// Hair and head of a preset, on the program's device.
pub struct Hair {
    /// The scene: simulates the hair, and gives frames.
    stage: Stage,
    /// Draws frames. Keeps its buffers and pipelines from frame to frame.
    renderer: Renderer,
}

/// The effects that presets may name: all that come with inkstrand. A program's own come beside them, and a program that knows its looks
/// may leave out the crates that they don't use.
///
/// # Errors
///
/// When two effects have one id.
pub fn registry() -> Result<Registry, RegistryError> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry)?; // strokes of hair
    effects_cartoon::register(&mut registry)?; // what paints hair and meshes
    effects_surface::register(&mut registry)?; // lines of meshes
    Ok(registry)
}

impl Hair {
    /// Reads a preset and its files, and a script of motion in place of the preset's. Objects of a preset move as their own presets say.
    ///
    /// # Errors
    ///
    /// Says every mistake in the files with its place, and what the device lacks.
    pub fn open(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        preset: &Path,
        motion: Option<PathBuf>,
    ) -> Outcome<Self> {
        let name = preset.display().to_string();
        let text = std::fs::read_to_string(preset).map_err(|error| format!("{name}: {error}"))?;
        let registry = registry()?;
        let mut files = Files {
            preset_folder: preset.parent().unwrap_or(Path::new("")).to_owned(),
            ..Files::default()
        };
        let mut preset = Preset::parse(&name, &text, &registry)?;
        // A script is for one head.
        files.motion = motion.filter(|_| preset.objects.is_empty());
        // Presets are made for the frame rates of film.
        preset.sections.scene.fps = STEPS_PER_SECOND;
        Ok(Self {
            stage: Stage::new(&preset, &files)?,
            renderer: Renderer::new(device, queue)?,
        })
    }

    /// Where the head is while nothing moves, and its height, in metres.
    #[must_use]
    pub fn head(&self) -> render::Head {
        self.stage.head()
    }

    /// Moves the hair to `time` (seconds) and records what draws it, as `view` sees it. That has to happen before the
    /// render pass begins, as it takes compute passes of its own. Gives the light that the preset asks for.
    ///
    /// # Errors
    ///
    /// When the camera is none, the frame is larger than the device allows, or the driver refuses a shader.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        time: f32,
        view: &View,
        pass: PassFormat,
    ) -> Outcome<render::Light> {
        // Hair stands where its nearest step has it, and so must the head.
        let time = (time * STEPS_PER_SECOND).round() / STEPS_PER_SECOND;
        let camera = view.as_inkstrand_sees_it()?;
        self.stage.advance_to_seen_by(time, &camera)?;
        let frame = self.stage.frame_seen_by(camera)?;
        self.renderer.prepare(encoder, &frame, SAMPLES, pass)?;
        Ok(frame.light)
    }

    /// Puts the prepared hair and head into the program's render pass.
    pub fn render(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.renderer.render(pass);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_that_comes_with_inkstrand_is_read() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
        let registry = registry().unwrap();
        let mut read = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|ending| ending != "ron") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            if let Err(mistakes) = Preset::parse(&path.to_string_lossy(), &text, &registry) {
                panic!("{mistakes}");
            }
            read += 1;
        }
        assert!(read > 40, "{read} presets");
    }
}
