//! The motion of a scene: where its heads are, and their hair.

use crate::bake::Bake;
use crate::closed::{Closed, Return, move_by, off_head, put_on_head};
use crate::dynamics::{Dynamics, Seen};
use crate::files::StageError;
use crate::hand::{Driver, Hand};
use crate::object::Object;
use crate::preset::{HeldChoice, MotionSection};
use crate::reach::may_see;
use crate::scene::{Scene, mean_head};
use crate::script::HeadPose;
use glam::Vec3;
use hair_sim::Stats;
use render::Head;
use stroke_path::Camera;

/// A head that is no higher than this in the picture, in pixels, is seen small: its hair moves by a pixel or two in a step.
const SMALL_PX: f32 = 32.0;

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
    /// The script's own time of the pose, seconds.
    posed_s: f64,
    points: Vec<Vec3>,
    dynamics: Option<Dynamics>,
    /// In place of dynamics where the script goes round.
    closed: Option<Closed>,
    /// Of hair that is baked, and held: what keeps it out of bodies, and simulates nothing.
    of_bake: Option<Dynamics>,
    /// Whether the points are those of the loop.
    is_looped: bool,
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
    /// again. Of a head that is less than 32 pixels high it is one step in place of two, and hair is shown where it last came to on the head where that is now. Motion is not quite that of [`Self::advance_to`] then, so pictures that must be the same every time are made
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
        // What hangs on time alone is held with the rest.
        let held = held_time(&scene.look().sections.motion, scene.fps(), reached);
        self.time_s = match scene.look().sections.motion.held {
            HeldChoice::All => held as f32,
            HeldChoice::Hair => reached as f32,
        };
        Ok(reached == time)
    }

    /// The time that it was last moved to, seconds: that of the pose, where poses are held.
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

    /// The points of all strands of the object of that index as they stand, one strand after the other, metres, where its files have it; none
    /// where the scene has no such object.
    #[must_use]
    pub fn points<'a>(&'a self, scene: &'a Scene, index: usize) -> &'a [Vec3] {
        let object = scene.objects().get(index);
        object.map_or(&[], |object| self.of(index, object).points(object))
    }

    /// How well hair whose script goes round came back to where it was, of each object that has such.
    pub fn returns(&self) -> impl Iterator<Item = Return> {
        let closed = self
            .objects
            .iter()
            .filter_map(|object| object.closed.as_ref());
        closed.filter_map(Closed::came_back)
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
            posed_s: 0.0,
            points: Vec::new(),
            dynamics: None,
            closed: None,
            of_bake: None,
            is_looped: false,
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
            self.closed = None;
            self.of_bake = None;
            self.of = Some((object.clone(), fps));
        } else if let Some((of, _)) = &mut self.of
            && of.placement() != object.placement()
        {
            // Winds blow in the world, and a loop is made once for all; what is simulated goes on.
            if !object.script().winds.is_empty() {
                self.closed = None;
            }
            *of = object.clone();
        }
        let script = object.script();
        let driver = Driver { script, hand };
        let section = &object.look().sections.motion;
        let held = held_time(section, fps, time);
        let reached = self.pose_at(object, fps, (held, driver), camera, goes_on)?;
        if section.held == HeldChoice::Hair && held != time {
            off_head(object, self.pose, &mut self.points);
            self.pose(driver, time);
            move_by(object, self.pose, &mut self.points);
            // Shoulders and other bodies stay where they are, or go elsewhere.
            if object.hair().bake.is_some() && self.of_bake.is_none() {
                self.of_bake = Self::of_bake(object, fps, driver)?;
            }
            let looped = self.closed.as_ref().filter(|_| self.is_looped);
            let dynamics = looped.map(Closed::dynamics).or(self.of_bake.as_ref());
            if let Some(dynamics) = dynamics.or(self.dynamics.as_ref()) {
                dynamics.keep_out(driver, time, &mut self.points);
            }
        }
        Ok(match reached == held {
            true => time,
            false => reached,
        })
    }

    /// Moves head and hair to where a driver has them at a time (seconds), or as far as they come.
    fn pose_at(
        &mut self,
        object: &Object,
        fps: f32,
        (time, driver): (f64, Driver),
        camera: Option<&Camera>,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<f64, StageError> {
        let hair = object.hair();
        self.is_looped = false;
        self.pose(driver, time);
        self.points
            .resize(hair.file.strands.points().len(), Vec3::ZERO);
        if let Some(motion) = &hair.file.motion {
            motion.sample(time as f32, &mut self.points);
            return Ok(time);
        }
        let has_hair = !hair.file.strands.is_empty();
        if !has_hair || !Dynamics::moves(&object.look().sections.dynamics, driver) {
            self.dynamics = None;
            self.place(object, driver, time);
            return Ok(time);
        }
        let is_by_hand = driver.hand.is_some_and(|hand| !hand.is_idle());
        if let Some(period) = driver.script.period
            && driver.script.closes
            && !is_by_hand
        {
            let mut closed = match self.closed.take() {
                Some(closed) => closed,
                None => {
                    let mut dynamics = Self::dynamics_of(object, fps)?;
                    dynamics.stand(object.placement());
                    Closed::new(object, dynamics, period, fps)?
                }
            };
            self.place(object, driver, time);
            let is_closed = closed.close(object, driver, goes_on)?;
            if is_closed {
                closed.sample(object, self.pose, time, &mut self.points);
            }
            self.is_looped = is_closed;
            self.closed = Some(closed);
            // Before all that is shown, as none of it is there.
            return Ok(if is_closed { time } else { time.min(0.0) - 1.0 });
        }
        let center = object.placement().point(self.head(object).center);
        let seen = match camera {
            None => Seen::Well,
            Some(camera) if !may_see(camera, center, hair.reach_m) => Seen::Not,
            Some(camera) => {
                let depth_m = camera.depth(center).max(camera.near_m());
                let height_px = camera.px_per_metre(depth_m) * hair.head.height_m;
                match height_px < SMALL_PX {
                    true => Seen::Small,
                    false => Seen::Well,
                }
            }
        };
        let mut dynamics = match self.dynamics.take() {
            Some(dynamics) => dynamics,
            None => Self::dynamics_of(object, fps)?,
        };
        dynamics.stand(object.placement());
        let reached = dynamics.advance_to(time, driver, seen, goes_on)?;
        match dynamics.on_head() {
            None => self.place(object, driver, reached),
            Some(points) => {
                self.pose(driver, reached);
                put_on_head(object, self.pose, points, &mut self.points);
            }
        }
        dynamics.write(driver, reached, &mut self.points);
        self.dynamics = Some(dynamics);
        Ok(reached)
    }

    fn dynamics_of(object: &Object, fps: f32) -> Result<Dynamics, StageError> {
        let (hair, look) = (object.hair(), object.look());
        let sizes: Vec<f32> = hair.infos.iter().map(|info| info.size).collect();
        Dynamics::new(
            hair,
            &sizes,
            object.bodies().clone(),
            &look.sections.dynamics,
            object.script().hold,
            fps,
            look.seed,
        )
    }

    /// What moved hair that is baked, as it begins; nothing where nothing moves it.
    fn of_bake(object: &Object, fps: f32, driver: Driver) -> Result<Option<Dynamics>, StageError> {
        if !Dynamics::moves(&object.look().sections.dynamics, driver) {
            return Ok(None);
        }
        let mut dynamics = Self::dynamics_of(object, fps)?;
        dynamics.begin(driver)?;
        Ok(Some(dynamics))
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
        self.pose(driver, time);
        move_by(object, self.pose, &mut self.points);
    }

    /// Takes on the pose at `time` (seconds).
    fn pose(&mut self, driver: Driver, time: f64) {
        self.pose = driver.head_at(time);
        self.posed_s = driver.script.within(time);
    }

    /// Its head where it is now.
    pub(crate) fn head(&self, object: &Object) -> Head {
        let head = object.hair().head;
        let (rotation, translation) = object.rigid(self.pose);
        Head {
            center: (rotation * head.center.as_dvec3() + translation).as_vec3(),
            ..head
        }
    }

    pub(crate) fn head_pose(&self) -> HeadPose {
        self.pose
    }

    /// The script's own time of the head's pose, seconds.
    pub(crate) fn posed_s(&self) -> f64 {
        self.posed_s
    }

    pub(crate) fn dynamics(&self) -> Option<&Dynamics> {
        self.dynamics.as_ref()
    }

    /// Whether what is shown tells how links have turned by its points alone: it is of a loop, or held while the head moves.
    pub(crate) fn has_points_alone(&self, object: &Object) -> bool {
        let section = &object.look().sections.motion;
        self.is_looped || (section.on > 1 && section.held == HeldChoice::Hair)
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

/// The time (seconds) of the frame whose pose is shown at `time`, in a scene of so many frames a second.
pub(crate) fn held_time(section: &MotionSection, fps: f32, time: f64) -> f64 {
    if section.on <= 1 {
        return time;
    }
    let (fps, on) = (f64::from(fps), f64::from(section.on));
    // What a time in single precision can tell from a frame's is no earlier one.
    let slack = time.abs() * f64::from(f32::EPSILON) * fps + 1e-6;
    let frame = ((time * fps + slack) / on).floor() * on;
    time_of_frame(frame, fps).min(time)
}

/// The time of a frame, in seconds, as precise as programs ask for it: what is worked out from a time in double precision may be another picture.
pub(crate) fn time_of_frame(frame: f64, fps: f64) -> f64 {
    f64::from(frame as f32 / fps as f32)
}
