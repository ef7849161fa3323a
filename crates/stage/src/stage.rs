//! A scene with its motion and its frames.

use crate::bake::Bake;
use crate::closed::Return;
use crate::files::{Files, StageError};
use crate::frame_maker::FrameMaker;
use crate::motion::Motion;
use crate::preset::Preset;
use crate::scene::Scene;
use render::{Frame, Head};
use stroke_path::Camera;

/// A [`Scene`], its [`Motion`] and a [`FrameMaker`] together, for a program that shows one scene at one time.
pub struct Stage {
    /// What is shown. Another one with the same parts may take its place at any time.
    pub scene: Scene,
    motion: Motion,
    frames: FrameMaker,
}

impl From<Scene> for Stage {
    fn from(scene: Scene) -> Self {
        Self {
            scene,
            motion: Motion::new(),
            frames: FrameMaker::new(),
        }
    }
}

impl Stage {
    /// Reads the preset's files: [`Scene::load`].
    ///
    /// # Errors
    ///
    /// As [`Scene::load`].
    pub fn new(preset: &Preset, files: &Files) -> Result<Self, StageError> {
        Ok(Scene::load(preset, files)?.into())
    }

    /// Sentences for the user: what was guessed about the files.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        self.scene.notes()
    }

    /// The number of strands.
    #[must_use]
    pub fn strand_count(&self) -> usize {
        self.scene.strand_count()
    }

    /// The number of points of all strands, as a bake has them in each frame.
    #[must_use]
    pub fn point_count(&self) -> usize {
        self.scene.point_count()
    }

    /// [`FrameMaker::culled`].
    #[must_use]
    pub fn culled(&self) -> usize {
        self.frames.culled()
    }

    /// [`FrameMaker::left_out`].
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.frames.left_out()
    }

    /// [`Motion::advance_to`].
    ///
    /// # Errors
    ///
    /// When the simulation refuses the preset's numbers.
    pub fn advance_to(&mut self, time: f32) -> Result<(), StageError> {
        self.motion.advance_to(&self.scene, time)
    }

    /// [`Motion::advance_to_seen_by`].
    ///
    /// # Errors
    ///
    /// As [`Self::advance_to`].
    pub fn advance_to_seen_by(&mut self, time: f32, camera: &Camera) -> Result<(), StageError> {
        self.motion.advance_to_seen_by(&self.scene, time, camera)
    }

    /// Adds the strands as they stand to a bake, at `time` (seconds).
    pub fn record(&self, time: f32, bake: &mut Bake) {
        self.motion.record(time, bake);
    }

    /// A bake of this scene as the text of a strands file.
    ///
    /// # Errors
    ///
    /// When it has no frames, or their times do not increase; or when the scene has several objects.
    pub fn bake_text(&self, bake: Bake) -> Result<String, StageError> {
        match self.scene.objects() {
            [one] => bake.text(&one.hair().file.strands, &one.hair().infos),
            objects => Err(StageError::BakeOfObjects(objects.len())),
        }
    }

    /// [`Motion::simulated`].
    #[must_use]
    pub fn simulated(&self) -> hair_sim::Stats {
        self.motion.simulated()
    }

    /// [`Motion::returns`].
    pub fn returns(&self) -> impl Iterator<Item = Return> {
        self.motion.returns()
    }

    /// [`Motion::steps_taken`].
    #[must_use]
    pub fn steps_taken(&self) -> u64 {
        self.motion.steps_taken()
    }

    /// [`Scene::near_m`].
    #[must_use]
    pub fn near_m(&self) -> f32 {
        self.scene.near_m()
    }

    /// [`Scene::head`].
    #[must_use]
    pub fn head(&self) -> Head {
        self.scene.head()
    }

    /// [`FrameMaker::is_as_before`], seen by the scene's own camera.
    ///
    /// # Errors
    ///
    /// When there is no such camera.
    pub fn is_as_before(&self) -> Result<bool, StageError> {
        Ok(self.is_as_before_seen_by(&self.scene.own_camera()?))
    }

    /// [`FrameMaker::is_as_before`].
    #[must_use]
    pub fn is_as_before_seen_by(&self, camera: &Camera) -> bool {
        self.frames.is_as_before(&self.scene, &self.motion, camera)
    }

    /// [`FrameMaker::frame`].
    ///
    /// # Errors
    ///
    /// When camera or paths cannot be made.
    pub fn frame(&mut self) -> Result<Frame<'_>, StageError> {
        self.frames.frame(&self.scene, &self.motion)
    }

    /// [`FrameMaker::frame_seen_by`].
    ///
    /// # Errors
    ///
    /// When paths cannot be made.
    pub fn frame_seen_by(&mut self, camera: Camera) -> Result<Frame<'_>, StageError> {
        self.frames.frame_seen_by(&self.scene, &self.motion, camera)
    }
}
