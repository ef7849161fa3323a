//! A scene: objects, light and picture, which never change. What moves and what is drawn is kept apart from it.

use crate::bake;
use crate::files::{Files, StageError};
use crate::hair::HairModel;
use crate::head::HeadModel;
use crate::look::Look;
use crate::motion::held_time;
use crate::object::Object;
use crate::preset::{CameraSection, OrderChoice, Preset};
use glam::Vec3;
use render::{Brush, Head};
use std::sync::Arc;
use stroke_path::{Camera, OrbitView};

/// How near the eye strokes are cut, in head heights.
const NEAR: f32 = 0.05;

/// Objects in one light, for one picture. They are shared: a clone is cheap, and a scene with another part is one of which the
/// others are not made again.
///
/// ```
/// use hair_sim::Strands;
/// use stage::{Files, FrameMaker, HairModel, HeadModel, Look, Motion, Object, Preset, Scene, Sections};
///
/// // Strands of the program's own, in metres, Y up, the face towards +Z; here on the bust that comes with inkstrand.
/// let head = HeadModel::bust();
/// let mut strands = Strands::new();
/// for id in 0..8 {
///     let x = 0.02 * (id as f32 - 3.5);
///     let points = [[x, 1.68, 0.06], [1.4 * x, 1.66, 0.11], [1.6 * x, 1.58, 0.13]].map(glam::Vec3::from);
///     strands.push(id, &points, Some(9.0))?;
/// }
/// let hair = HairModel::new(strands, Some(&head))?;
///
/// // A look without a file: sections and layers.
/// let mut sections = Sections::default();
/// sections.scene.size = [320, 240];
/// let preset = Preset::new(1, sections.clone(), Vec::new()); // with effects in a list of layers, strokes are drawn
/// let girl = Object::new(hair, Some(head), Look::new(&preset, &Files::default())?)?;
///
/// // Two of her, who look at each other. Nothing is made twice.
/// let left = girl.placed(60.0, glam::Vec3::new(-0.2, 0.0, 0.0));
/// let right = girl.placed(-60.0, glam::Vec3::new(0.2, 0.0, 0.0));
/// let scene = Scene::new(vec![left, right], Look::new(&preset, &Files::default())?)?;
///
/// let mut motion = Motion::new();
/// let mut frames = FrameMaker::new();
/// motion.advance_to(&scene, 0.5)?;
/// let frame = frames.frame(&scene, &motion)?;
/// assert_eq!(frame.strands.len(), 16);
///
/// // Another look for the left one: hair and head aren't made again, and the other stays as she is.
/// sections.head.light = [0.2, 0.1, 0.05];
/// let tanned = Look::new(&Preset::new(1, sections, Vec::new()), &Files::default())?;
/// let other = scene.with_object(0, scene.objects()[0].with_look(tanned)?)?;
/// assert!(std::ptr::eq(scene.objects()[0].hair(), other.objects()[0].hair()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Scene {
    objects: Arc<[Object]>,
    /// Of which sections `scene`, `camera` and `light` are meant.
    look: Arc<Look>,
    /// From where it is seen. Values are as in presets; a camera is made of them for each frame.
    pub camera: CameraSection,
    /// Sentences for the user: what was guessed.
    notes: Arc<[String]>,
}

impl Scene {
    /// A scene of a program's own, without any file. Light, camera and picture are those of `look`; what else it says is of no account.
    ///
    /// # Errors
    ///
    /// When there is no object, objects have different brushes, or a layer needs another light.
    pub fn new(objects: Vec<Object>, look: Look) -> Result<Self, StageError> {
        Self::of(objects, Arc::new(look), Vec::new())
    }

    /// One head of hair in its own light.
    ///
    /// # Errors
    ///
    /// When no path can be made of the strands.
    pub fn of_one(
        hair: HairModel,
        head: Option<HeadModel>,
        look: Look,
    ) -> Result<Self, StageError> {
        let object = Object::new(hair, head, look)?;
        let look = object.shared_look().clone();
        Self::of(vec![object], look, Vec::new())
    }

    /// Reads the preset's files, or the presets of the objects that it names, and theirs.
    ///
    /// # Errors
    ///
    /// When hair, head, script or bake cannot be read, or a look contradicts itself.
    pub fn load(preset: &Preset, files: &Files) -> Result<Self, StageError> {
        let mut notes = Vec::new();
        if preset.sections.scene.order == OrderChoice::Scattered {
            notes.push("scene: order `scattered` is no more; `rounded` is drawn".to_owned());
        }
        let look = Arc::new(Look::new(preset, files)?);
        let objects = match &preset.objects[..] {
            [] => vec![Object::load(preset, files, look.clone(), &mut notes)?],
            _ => preset.load_objects(files, &mut notes)?,
        };
        Self::of(objects, look, notes)
    }

    fn of(objects: Vec<Object>, look: Arc<Look>, notes: Vec<String>) -> Result<Self, StageError> {
        let first = objects.first().ok_or(StageError::NoObject)?;
        let brush = first.look().brush();
        if objects.iter().any(|object| object.look().brush() != brush) {
            return Err(StageError::Brushes);
        }
        for object in &objects {
            look.lights(object.look())?;
        }
        Ok(Self {
            objects: objects.into(),
            camera: look.sections.camera.clone(),
            look,
            notes: notes.into(),
        })
    }

    /// The same with another look, and seen by that look's camera. Of one object that is its own too; where there are more, theirs
    /// stay, and light, camera and picture change.
    ///
    /// # Errors
    ///
    /// When no path of the look's kind can be made of the strands, or a layer needs another light.
    pub fn with_look(&self, look: Look) -> Result<Self, StageError> {
        let look = Arc::new(look);
        let objects = match &self.objects[..] {
            [one] => vec![one.in_look(look.clone())?],
            objects => objects.to_vec(),
        };
        Ok(Self {
            notes: self.notes.clone(),
            ..Self::of(objects, look, Vec::new())?
        })
    }

    /// The same with another object in place of one.
    ///
    /// # Errors
    ///
    /// As [`Self::new`], and when there is no object of that index.
    pub fn with_object(&self, index: usize, object: Object) -> Result<Self, StageError> {
        let mut objects = self.objects.to_vec();
        *objects.get_mut(index).ok_or(StageError::NoObject)? = object;
        Ok(Self {
            camera: self.camera.clone(),
            notes: self.notes.clone(),
            ..Self::of(objects, self.look.clone(), Vec::new())?
        })
    }

    /// What stands in it, one or more.
    #[must_use]
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The look whose light and picture it has.
    #[must_use]
    pub fn look(&self) -> &Look {
        &self.look
    }

    pub(crate) fn shared_look(&self) -> &Arc<Look> {
        &self.look
    }

    /// The number of all strands.
    #[must_use]
    pub fn strand_count(&self) -> usize {
        let hair = self.objects.iter().map(Object::hair);
        hair.map(HairModel::strand_count).sum()
    }

    /// The number of points of all strands.
    #[must_use]
    pub fn point_count(&self) -> usize {
        let hair = self.objects.iter().map(Object::hair);
        hair.map(|hair| hair.file.strands.points().len()).sum()
    }

    /// Where the head is while nothing moves, and how large; of several the mean.
    #[must_use]
    pub fn head(&self) -> Head {
        mean_head(self.objects.iter().map(Object::head))
    }

    /// Holds `time` (seconds), and that of the pose that is held then, against the bakes of the scene's hair.
    ///
    /// # Errors
    ///
    /// When one of them doesn't go as far.
    pub fn check_time(&self, time: f32) -> Result<(), StageError> {
        self.objects.iter().try_for_each(|object| {
            let motion = &object.look().sections.motion;
            let held = held_time(motion, self.fps(), f64::from(time)) as f32;
            bake::check_reaches(object.hair(), self.fps(), time, held)
        })
    }

    /// The length of the longest animation that moves a head, seconds; 0 without any.
    #[must_use]
    pub fn animation_s(&self) -> f32 {
        let below = (self.objects.iter()).filter_map(|object| object.script().below.as_ref());
        below
            .map(|below| below.length_s() as f32)
            .fold(0.0, f32::max)
    }

    /// Sentences for the user: what was guessed about the files.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// From which view depth on a camera should see this scene, metres.
    #[must_use]
    pub fn near_m(&self) -> f32 {
        NEAR * self.head().height_m
    }

    /// The scene's own camera.
    ///
    /// # Errors
    ///
    /// When its values make none.
    pub fn own_camera(&self) -> Result<Camera, StageError> {
        self.camera_of_size(self.look.sections.scene.size)
    }

    /// The scene's own camera, for a picture of another size (pixels).
    ///
    /// # Errors
    ///
    /// When its values make none.
    pub fn camera_of_size(&self, size_px: [u32; 2]) -> Result<Camera, StageError> {
        let (head, section) = (self.head(), &self.camera);
        let view = OrbitView {
            target: head.center + Vec3::from(section.target) * head.height_m,
            yaw_degrees: section.yaw,
            pitch_degrees: section.pitch,
            distance_m: section.distance * head.height_m,
            vertical_fov_degrees: section.fov,
        };
        Ok(Camera::orbit(view, size_px, self.near_m())?)
    }

    /// What all strokes are made of.
    pub(crate) fn brush(&self) -> Brush {
        let first = self.objects.first();
        first.map_or(Brush::default(), |object| object.look().brush())
    }

    /// Steps of the simulation a second, where a preset gives none.
    pub(crate) fn fps(&self) -> f32 {
        self.look.sections.scene.fps
    }
}

/// The mean of heads; that of one is itself.
pub(crate) fn mean_head(heads: impl ExactSizeIterator<Item = Head> + Clone) -> Head {
    let count = heads.len() as f32;
    Head {
        center: heads.clone().map(|head| head.center).sum::<Vec3>() / count,
        height_m: heads.map(|head| head.height_m).sum::<f32>() / count,
    }
}
