//! The motion of a scene: where its heads are, and their hair.

use crate::bake::Bake;
use crate::dynamics::Dynamics;
use crate::files::StageError;
use crate::hand::{Driver, Hand};
use crate::neck::{Neck, rigid};
use crate::object::Object;
use crate::reach::may_see;
use crate::scene::{Scene, mean_head};
use crate::script::HeadPose;
use glam::Vec3;
use hair_sim::Stats;
use render::Head;
use stroke_path::Camera;

/// Where the heads of a scene are, and their hair: simulated, baked, or in its key shapes.
#[derive(Default)]
pub struct Motion {
    objects: Vec<ObjectMotion>,
    time_s: f32,
}

/// An object in motion, in its own coordinates: where its files have it.
#[derive(Default)]
pub(crate) struct ObjectMotion {
    pose: HeadPose,
    points: Vec<Vec3>,
    dynamics: Option<Dynamics>,
    /// What this is the motion of, and the scene's frames a second.
    of: Option<(Object, f32)>,
}

impl Motion {
    /// A motion that has not begun.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Moves heads and hair to `time` (seconds): hair that moves is simulated, in steps from the start. An object that
    /// moves in another way than the last one in its place begins anew.
    ///
    /// # Errors
    ///
    /// When the simulation refuses the scene's numbers.
    pub fn advance_to(&mut self, scene: &Scene, time: f32) -> Result<(), StageError> {
        self.advance(scene, f64::from(time), None, None)
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
        self.advance(scene, f64::from(time), Some(camera), None)
    }

    /// As [`Self::advance_to`], with a hand that moves all heads and blows beside the scene's scripts.
    ///
    /// # Errors
    ///
    /// As [`Self::advance_to`].
    pub fn advance_by_hand(
        &mut self,
        scene: &Scene,
        time: f32,
        hand: &Hand,
    ) -> Result<(), StageError> {
        self.advance(scene, f64::from(time), None, Some(hand))
    }

    /// To `time` (seconds); without a camera hair is seen.
    fn advance(
        &mut self,
        scene: &Scene,
        time: f64,
        camera: Option<&Camera>,
        hand: Option<&Hand>,
    ) -> Result<(), StageError> {
        let objects = scene.objects();
        self.time_s = time as f32;
        self.objects
            .resize_with(objects.len(), ObjectMotion::default);
        for (object, motion) in objects.iter().zip(&mut self.objects) {
            motion.advance(object, scene.fps(), time, camera, hand)?;
        }
        Ok(())
    }

    /// The time that it was last moved to, seconds.
    #[must_use]
    pub fn time_s(&self) -> f32 {
        self.time_s
    }

    /// Adds the strands of all objects as they stand to a bake, at `time` (seconds).
    pub fn record(&self, time: f32, bake: &mut Bake) {
        match &self.objects[..] {
            [one] => bake.push(time, &one.points),
            objects => {
                let points: Vec<&[Vec3]> = objects.iter().map(|o| &o.points[..]).collect();
                bake.push(time, &points.concat());
            }
        }
    }

    /// What the simulation did in its last step; nothing where nothing is simulated.
    #[must_use]
    pub fn simulated(&self) -> Stats {
        let dynamics = self.dynamics().map(Dynamics::stats);
        dynamics.fold(Stats::default(), Stats::plus)
    }

    /// How many steps the simulation has taken, long ones of hair off screen counted as one, and those of each object for themselves.
    #[must_use]
    pub fn steps_taken(&self) -> u64 {
        self.dynamics().map(Dynamics::taken).sum()
    }

    fn dynamics(&self) -> impl Iterator<Item = &Dynamics> {
        let objects = self.objects.iter();
        objects.filter_map(|object| object.dynamics.as_ref())
    }

    /// The head of the scene where it is now; of several the mean.
    #[must_use]
    pub fn head(&self, scene: &Scene) -> Head {
        let heads = scene.objects().iter().enumerate();
        mean_head(heads.map(|(index, object)| {
            let own = self.of(index, object).head(object);
            object.placement().head(own)
        }))
    }

    /// The motion of the object of that index; one that has not begun where what stood there moved in another way.
    pub(crate) fn of(&self, index: usize, object: &Object) -> &ObjectMotion {
        const STILL: &ObjectMotion = &ObjectMotion::new();
        let is_of = |motion: &&ObjectMotion| {
            let of = motion.of.as_ref();
            of.is_some_and(|(of, _)| of.moves_as(object))
        };
        self.objects.get(index).filter(is_of).unwrap_or(STILL)
    }
}

impl ObjectMotion {
    const fn new() -> Self {
        Self {
            pose: HeadPose::REST,
            points: Vec::new(),
            dynamics: None,
            of: None,
        }
    }

    fn advance(
        &mut self,
        object: &Object,
        fps: f32,
        time: f64,
        camera: Option<&Camera>,
        hand: Option<&Hand>,
    ) -> Result<(), StageError> {
        let is_same = |(of, at): &(Object, f32)| of.moves_as(object) && *at == fps;
        if !self.of.as_ref().is_some_and(is_same) {
            self.dynamics = None;
            self.of = Some((object.clone(), fps));
        }
        let (hair, script, look) = (object.hair(), object.script(), object.look());
        let driver = Driver { script, hand };
        let at_rest = hair.file.strands.points();
        self.points.resize(at_rest.len(), Vec3::ZERO);
        self.pose = driver.head_at(time);
        if let Some(motion) = &hair.file.motion {
            motion.sample(time as f32, &mut self.points);
            return Ok(());
        }
        let section = &look.sections.dynamics;
        let is_simulated = Dynamics::moves(section, driver);
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
            self.dynamics = None;
            return Ok(());
        }
        let center = object.placement().point(self.head(object).center);
        let is_seen = camera.is_none_or(|camera| may_see(camera, center, hair.reach_m));
        let dynamics = match &mut self.dynamics {
            Some(dynamics) => dynamics,
            None => {
                let sizes: Vec<f32> = hair.infos.iter().map(|info| info.size).collect();
                self.dynamics.insert(Dynamics::new(
                    hair,
                    &sizes,
                    object.neck().map(Neck::rest_mesh),
                    section,
                    script.hold,
                    fps,
                    look.seed,
                )?)
            }
        };
        dynamics.stand(object.placement());
        dynamics.advance_to(time, driver, is_seen, &mut self.points)
    }

    /// Its head where it is now.
    pub(crate) fn head(&self, object: &Object) -> Head {
        let head = object.hair().head;
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

    /// The points of the object's strands, as they stand; at rest where no motion of it has begun.
    pub(crate) fn points<'a>(&'a self, object: &'a Object) -> &'a [Vec3] {
        let at_rest = object.hair().file.strands.points();
        match self.points.len() == at_rest.len() {
            true => &self.points,
            false => at_rest,
        }
    }
}
