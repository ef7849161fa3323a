//! The motion of a scene: where its heads are, and their hair.

use crate::bake::Bake;
use crate::dynamics::Dynamics;
use crate::files::StageError;
use crate::hand::{Driver, Hand};
use crate::neck::rigid;
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
    #[inline(never)] // a stage of a frame, which `cargo xtask bench count` finds by its name
    pub fn advance_to(&mut self, scene: &Scene, time: f32) -> Result<(), StageError> {
        self.advance(scene, f64::from(time), None, None, &mut || true)?;
        Ok(())
    }

    /// As [`Self::advance_to`], for live programs: while this camera cannot see the hair, wherever it may be, and the head is calm, hair
    /// is simulated in one step in place of four (of a frame each, or of a part of one where frames are long), and what is missing is made up for before it is seen
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
        self.advance(scene, f64::from(time), Some(camera), None, &mut || true)?;
        Ok(())
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
        self.advance_by_hand_while(scene, time, hand, || true)?;
        Ok(())
    }

    /// As [`Self::advance_by_hand`], for live programs whose scene may become another one: for as long as `goes_on` says so, which is
    /// asked before each step of the simulation. Where it ends early, each object is where it came to, at a time before, and the next
    /// call goes on from there. Whether all came to `time`.
    ///
    /// # Errors
    ///
    /// As [`Self::advance_to`].
    pub fn advance_by_hand_while(
        &mut self,
        scene: &Scene,
        time: f32,
        hand: &Hand,
        mut goes_on: impl FnMut() -> bool,
    ) -> Result<bool, StageError> {
        self.advance(scene, f64::from(time), None, Some(hand), &mut goes_on)
    }

    /// To `time` (seconds); without a camera hair is seen. Whether all objects came there.
    fn advance(
        &mut self,
        scene: &Scene,
        time: f64,
        camera: Option<&Camera>,
        hand: Option<&Hand>,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<bool, StageError> {
        let objects = scene.objects();
        self.objects
            .resize_with(objects.len(), ObjectMotion::default);
        let mut reached = time;
        for (object, motion) in objects.iter().zip(&mut self.objects) {
            let came_to = motion.advance(object, scene.fps(), time, camera, hand, goes_on)?;
            reached = reached.min(came_to);
        }
        self.time_s = reached as f32;
        Ok(reached == time)
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

    /// The time that it came to, seconds.
    fn advance(
        &mut self,
        object: &Object,
        fps: f32,
        time: f64,
        camera: Option<&Camera>,
        hand: Option<&Hand>,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<f64, StageError> {
        let is_same = |(of, at): &(Object, f32)| of.moves_as(object) && *at == fps;
        if !self.of.as_ref().is_some_and(is_same) {
            self.dynamics = None;
            self.of = Some((object.clone(), fps));
        }
        let (hair, script) = (object.hair(), object.script());
        let driver = Driver { script, hand };
        self.pose = driver.head_at(time);
        self.points
            .resize(hair.file.strands.points().len(), Vec3::ZERO);
        if let Some(motion) = &hair.file.motion {
            motion.sample(time as f32, &mut self.points);
            return Ok(time);
        }
        if !Dynamics::moves(&object.look().sections.dynamics, driver) {
            self.dynamics = None;
            self.place(object, driver, time);
            return Ok(time);
        }
        let center = object.placement().point(self.head(object).center);
        let is_seen = camera.is_none_or(|camera| may_see(camera, center, hair.reach_m));
        let mut dynamics = match self.dynamics.take() {
            Some(dynamics) => dynamics,
            None => Self::dynamics_of(object, fps)?,
        };
        dynamics.stand(object.placement());
        let reached = dynamics.advance_to(time, driver, is_seen, goes_on)?;
        self.place(object, driver, reached);
        dynamics.write(driver, &mut self.points);
        self.dynamics = Some(dynamics);
        Ok(reached)
    }

    fn dynamics_of(object: &Object, fps: f32) -> Result<Dynamics, StageError> {
        let (hair, look) = (object.hair(), object.look());
        let sizes: Vec<f32> = hair.infos.iter().map(|info| info.size).collect();
        Dynamics::new(
            hair,
            &sizes,
            object.bare_mesh(),
            &look.sections.dynamics,
            object.script().hold,
            fps,
            look.seed,
        )
    }

    /// Puts the head, and hair that the head holds, where they are at `time` (seconds).
    fn place(&mut self, object: &Object, driver: Driver, time: f64) {
        let hair = object.hair();
        let is_simulated = Dynamics::moves(&object.look().sections.dynamics, driver);
        match &hair.shapes {
            // Without dynamics hair is where its keys have it.
            Some(shapes) if !is_simulated => {
                shapes.sample_smooth(driver.script.within(time), &mut self.points);
            }
            _ => self.points.copy_from_slice(hair.file.strands.points()),
        }
        self.pose = driver.head_at(time);
        let (rotation, translation) = rigid(self.pose, hair.head);
        for point in &mut self.points {
            *point = (rotation * point.as_dvec3() + translation).as_vec3();
        }
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
