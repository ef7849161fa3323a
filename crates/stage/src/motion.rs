//! The motion of a scene: where its head is, and its hair.

use crate::bake::Bake;
use crate::dynamics::Dynamics;
use crate::files::StageError;
use crate::neck::{Neck, rigid};
use crate::reach::may_see;
use crate::scene::Scene;
use crate::script::HeadPose;
use glam::Vec3;
use render::Head;
use stroke_path::Camera;

/// Where the head of a scene is, and its hair: simulated, baked, or in its key shapes.
#[derive(Default)]
pub struct Motion {
    pose: HeadPose,
    points: Vec<Vec3>,
    dynamics: Option<Dynamics>,
    /// The scene that this is the motion of.
    of: Option<Scene>,
}

impl Motion {
    /// A motion that has not begun.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Moves head and hair to `time` (seconds): hair that moves is simulated, in steps from the start. A scene that
    /// moves in another way than the last one begins anew.
    ///
    /// # Errors
    ///
    /// When the simulation refuses the scene's numbers.
    pub fn advance_to(&mut self, scene: &Scene, time: f32) -> Result<(), StageError> {
        self.advance(scene, f64::from(time), None)
    }

    /// As [`Self::advance_to`], for live programs: while this camera cannot see the hair, wherever it may be, and the head is calm, hair
    /// is simulated in one step of four frames' length every fourth frame, and what is missing is made up for before it is seen
    /// again. Motion is not quite that of [`Self::advance_to`] then, so pictures that must be the same every time are made
    /// with that.
    ///
    /// # Errors
    ///
    /// As [`Self::advance_to`].
    pub fn advance_to_seen_by(
        &mut self,
        scene: &Scene,
        time: f32,
        camera: &Camera,
    ) -> Result<(), StageError> {
        self.advance(scene, f64::from(time), Some(camera))
    }

    /// To `time` (seconds); without a camera hair is seen.
    fn advance(
        &mut self,
        scene: &Scene,
        time: f64,
        camera: Option<&Camera>,
    ) -> Result<(), StageError> {
        if !self.of.as_ref().is_some_and(|of| of.moves_as(scene)) {
            self.dynamics = None;
            self.of = Some(scene.clone());
        }
        let (hair, script, look) = (scene.hair(), scene.script(), scene.look());
        let at_rest = hair.file.strands.points();
        self.points.resize(at_rest.len(), Vec3::ZERO);
        self.pose = script.head_at(time);
        if let Some(motion) = &hair.file.motion {
            motion.sample(time as f32, &mut self.points);
            return Ok(());
        }
        let section = &look.sections.dynamics;
        let is_simulated = Dynamics::moves(section, script);
        match &hair.shapes {
            // Without dynamics hair is where its keys have it.
            Some(shapes) if !is_simulated => {
                shapes.sample_smooth(script.within(time), &mut self.points);
            }
            _ => self.points.copy_from_slice(at_rest),
        }
        let (rotation, translation) = rigid(self.pose, hair.head);
        for point in &mut self.points {
            *point = (rotation * point.as_dvec3() + translation).as_vec3();
        }
        if !is_simulated {
            return Ok(());
        }
        let center = self.head(scene).center;
        let is_seen = camera.is_none_or(|camera| may_see(camera, center, hair.reach_m));
        let dynamics = match &mut self.dynamics {
            Some(dynamics) => dynamics,
            None => {
                let sizes: Vec<f32> = hair.infos.iter().map(|info| info.size).collect();
                self.dynamics.insert(Dynamics::new(
                    hair,
                    &sizes,
                    scene.neck().map(Neck::rest_mesh),
                    section,
                    script.hold,
                    look.sections.scene.fps,
                    look.seed,
                )?)
            }
        };
        dynamics.advance_to(time, script, is_seen, &mut self.points)
    }

    /// Adds the strands as they stand to a bake, at `time` (seconds).
    pub fn record(&self, time: f32, bake: &mut Bake) {
        bake.push(time, &self.points);
    }

    /// What the simulation did in its last step; nothing where nothing is simulated.
    #[must_use]
    pub fn simulated(&self) -> hair_sim::Stats {
        self.dynamics
            .as_ref()
            .map(Dynamics::stats)
            .unwrap_or_default()
    }

    /// How many steps the simulation has taken, long ones of hair off screen counted as one.
    #[must_use]
    pub fn steps_taken(&self) -> u64 {
        self.dynamics.as_ref().map_or(0, Dynamics::taken)
    }

    /// The head of the scene where it is now.
    #[must_use]
    pub fn head(&self, scene: &Scene) -> Head {
        let head = scene.head();
        let (rotation, translation) = rigid(self.pose, head);
        Head {
            center: (rotation * head.center.as_dvec3() + translation).as_vec3(),
            ..head
        }
    }

    pub(crate) fn pose(&self) -> HeadPose {
        self.pose
    }

    pub(crate) fn dynamics(&self) -> Option<&Dynamics> {
        self.dynamics.as_ref()
    }

    /// The points of the scene's strands, as they stand; at rest where no motion has begun.
    pub(crate) fn points<'a>(&'a self, scene: &'a Scene) -> &'a [Vec3] {
        let at_rest = scene.hair().file.strands.points();
        match &self.of {
            Some(of) if of.moves_as(scene) && self.points.len() == at_rest.len() => &self.points,
            _ => at_rest,
        }
    }
}
