//! A scene: hair, head, script and look, which never change. What moves and what is drawn is kept apart from it.

use crate::bake;
use crate::files::{Files, StageError};
use crate::hair::HairModel;
use crate::head::HeadModel;
use crate::load;
use crate::look::Look;
use crate::neck::Neck;
use crate::preset::{CameraSection, OrderChoice, Preset};
use crate::script::{self, MotionScript};
use glam::Vec3;
use render::{Head, StrandInfo};
use std::sync::Arc;
use stroke_path::{Camera, Cut, OrbitView};

/// How near the eye strokes are cut, in head heights.
const NEAR: f32 = 0.05;

/// How far the pieces of a strand that curls go on beyond where they meet, in parts of its full radius.
const OVERLAP: f32 = 3.0;

/// Hair on a head, with a look. Its parts are shared: a clone is cheap, and a scene with another part is one of which
/// the others are not made again.
///
/// ```
/// use hair_sim::Strands;
/// use stage::{FrameMaker, HairModel, HeadModel, Look, Motion, Preset, Scene, Sections};
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
/// let registry = effects::Registry::new(); // with effects in it, strokes are drawn
/// let mut sections = Sections::default();
/// sections.scene.size = [320, 240];
/// let look = Look::new(&Preset::new(1, sections.clone(), Vec::new()))?;
/// let scene = Scene::new(hair, Some(head), look)?;
///
/// let mut motion = Motion::new();
/// let mut frames = FrameMaker::new();
/// motion.advance_to(&scene, 0.5)?;
/// let frame = frames.frame(&scene, &motion)?;
/// assert_eq!(frame.strands.len(), 8);
///
/// // Another look for the same hair and head, which aren't made again.
/// sections.head.light = [0.2, 0.1, 0.05];
/// let darker = scene.with_look(Look::new(&Preset::new(1, sections, Vec::new()))?)?;
/// assert!(std::ptr::eq(scene.hair(), darker.hair()));
/// # let _ = registry;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Scene {
    hair: Arc<HairModel>,
    /// The head as it was given, and as it stands under this hair.
    bare_head: Option<Arc<HeadModel>>,
    neck: Option<Arc<Neck>>,
    script: Arc<MotionScript>,
    look: Arc<Look>,
    /// Where each strand's path is cut.
    cuts: Arc<Vec<Vec<Cut>>>,
    /// From where it is seen. Values are as in presets; a camera is made of them for each frame.
    pub camera: CameraSection,
    /// Sentences for the user: what was guessed.
    notes: Arc<[String]>,
}

impl Scene {
    /// A scene of a program's own, without any file. Its head is still; hair may fall.
    ///
    /// # Errors
    ///
    /// When no path can be made of the strands.
    pub fn new(hair: HairModel, head: Option<HeadModel>, look: Look) -> Result<Self, StageError> {
        Self::of(hair, head, look, MotionScript::default(), Vec::new())
    }

    /// Reads the preset's files.
    ///
    /// # Errors
    ///
    /// When hair, head, script or bake cannot be read, or the look contradicts itself.
    pub fn load(preset: &Preset, files: &Files) -> Result<Self, StageError> {
        let mut notes = Vec::new();
        if preset.sections.scene.order == OrderChoice::Scattered {
            notes.push("scene: order `scattered` is no more; `rounded` is drawn".to_owned());
        }
        let head = load::head(preset, files, &mut notes)?;
        let mesh = head.as_ref().map(|model| &model.mesh);
        let mut hair = load::hair(preset, files, mesh, &mut notes)?;
        let script = script::load(preset, files, &mut hair, mesh)?;
        hair.choose_guides(&preset.sections.hair);
        if let Some(motion) = bake::load(preset, files, &hair, &mut notes)? {
            hair.file.motion = Some(motion);
        }
        Self::of(hair, head, Look::new(preset)?, script, notes)
    }

    fn of(
        hair: HairModel,
        head: Option<HeadModel>,
        look: Look,
        script: MotionScript,
        notes: Vec<String>,
    ) -> Result<Self, StageError> {
        let head = head.map(Arc::new);
        Ok(Self {
            neck: head
                .as_deref()
                .map(|head| Arc::new(neck(head, &hair, &look))),
            cuts: Arc::new(cuts(&hair, &look)?),
            camera: look.sections.camera.clone(),
            bare_head: head,
            hair: Arc::new(hair),
            script: Arc::new(script),
            look: Arc::new(look),
            notes: notes.into(),
        })
    }

    /// The same hair and head with another look, seen by that look's camera.
    ///
    /// # Errors
    ///
    /// When no path of the look's kind can be made of the strands.
    pub fn with_look(&self, look: Look) -> Result<Self, StageError> {
        let mut scene = self.clone();
        if look.path() != self.look.path() {
            scene.cuts = Arc::new(cuts(&self.hair, &look)?);
        }
        if look.sections.head.scalp != self.look.sections.head.scalp {
            let bare = self.bare_head.as_deref();
            scene.neck = bare.map(|head| Arc::new(neck(head, &self.hair, &look)));
        }
        scene.camera = look.sections.camera.clone();
        scene.look = Arc::new(look);
        Ok(scene)
    }

    /// Other hair on the same head, in the same look.
    ///
    /// # Errors
    ///
    /// When no path can be made of the strands.
    pub fn with_hair(&self, hair: HairModel) -> Result<Self, StageError> {
        let bare = self.bare_head.as_deref();
        Ok(Self {
            cuts: Arc::new(cuts(&hair, &self.look)?),
            neck: bare.map(|head| Arc::new(neck(head, &hair, &self.look))),
            hair: Arc::new(hair),
            ..self.clone()
        })
    }

    /// The hair.
    #[must_use]
    pub fn hair(&self) -> &HairModel {
        &self.hair
    }

    /// The look.
    #[must_use]
    pub fn look(&self) -> &Look {
        &self.look
    }

    /// Where the head is while nothing moves, and how large.
    #[must_use]
    pub fn head(&self) -> Head {
        self.hair.head
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
        let (head, section) = (self.head(), &self.camera);
        let view = OrbitView {
            target: head.center + Vec3::from(section.target) * head.height_m,
            yaw_degrees: section.yaw,
            pitch_degrees: section.pitch,
            distance_m: section.distance * head.height_m,
            vertical_fov_degrees: section.fov,
        };
        let size = self.look.sections.scene.size;
        Ok(Camera::orbit(view, size, self.near_m())?)
    }

    pub(crate) fn script(&self) -> &MotionScript {
        &self.script
    }

    pub(crate) fn neck(&self) -> Option<&Neck> {
        self.neck.as_deref()
    }

    pub(crate) fn cuts(&self) -> &[Vec<Cut>] {
        &self.cuts
    }

    /// Whether both have the same hair on the same head, not only alike ones.
    pub(crate) fn has_hair_and_head_of(&self, other: &Self) -> bool {
        let same_head = match (&self.neck, &other.neck) {
            (Some(own), Some(others)) => Arc::ptr_eq(own, others),
            (own, others) => own.is_none() && others.is_none(),
        };
        same_head && Arc::ptr_eq(&self.hair, &other.hair)
    }

    /// Whether hair moves alike in both: the same hair on the same head, with the same script and dynamics.
    pub(crate) fn moves_as(&self, other: &Self) -> bool {
        let of_look = |scene: &Self| {
            let sections = &scene.look.sections;
            (
                sections.scene.fps,
                scene.look.seed,
                sections.dynamics.clone(),
            )
        };
        self.has_hair_and_head_of(other)
            && Arc::ptr_eq(&self.script, &other.script)
            && of_look(self) == of_look(other)
    }
}

/// The head with the hair's bands in it, and with what of it has hair told from what has none.
fn neck(head: &HeadModel, hair: &HairModel, look: &Look) -> Neck {
    let mut model = head.clone();
    model.add_ties(&hair.ties);
    let reach = look.sections.head.scalp;
    // A style's own coat lies there.
    if reach > 0.0 && hair.undercoat == 0 {
        model.find_scalp(&hair.all_roots, reach * hair.head.height_m);
    }
    Neck::new(model, hair.head)
}

fn cuts(hair: &HairModel, look: &Look) -> Result<Vec<Vec<Cut>>, StageError> {
    let cut = |(i, info): (usize, &StrandInfo)| {
        let overlap_m = OVERLAP * info.size * hair.head.unit_m();
        stroke_path::cuts(hair.file.strands.strand(i), look.path(), overlap_m)
    };
    let strands = hair.infos.iter().enumerate();
    Ok(strands.map(cut).collect::<Result<_, _>>()?)
}
