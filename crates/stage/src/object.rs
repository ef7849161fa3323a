//! An object of a scene: hair on a head, how it moves, how it is drawn, and where it stands.

use crate::bake;
use crate::closed;
use crate::dynamics::Bodies;
use crate::files::{Files, StageError};
use crate::hair::HairModel;
use crate::head::{self, HeadModel};
use crate::heads::SharedBodies;
use crate::hem::{self, Beside};
use crate::lines;
use crate::load::{self, ReadHead};
use crate::look::Look;
use crate::neck::{Neck, pivot, rigid};
use crate::once::once;
use crate::placement::Placement;
use crate::preset::Preset;
use crate::script::{self, HeadPose, MotionScript};
use crate::zones;
use glam::{DQuat, DVec3, Vec3};
use rayon::prelude::*;
use render::{Brush, Head, StrandInfo};
use std::sync::Arc;
use stroke_path::{Coarseness, Cut, Detail};

/// How far the pieces of a strand that curls go on beyond where they meet, in parts of its full radius.
const OVERLAP: f32 = 3.0;

/// Hair on a head, with a look. Its parts are shared: a clone is cheap, and an object with another part is one of which
/// the others are not made again.
#[derive(Clone)]
pub struct Object {
    hair: Arc<HairModel>,
    /// The head as it was given, and as it stands under this hair.
    bare_head: Option<Arc<HeadModel>>,
    neck: Option<Arc<Neck>>,
    script: Arc<MotionScript>,
    /// The look as it was given, and as it is on this hair.
    given_look: Arc<Look>,
    look: Arc<Look>,
    /// What hair cannot enter, once it moves.
    bodies: SharedBodies,
    /// What each strand's path is like.
    shapes: Arc<Vec<PathShape>>,
    placement: Placement,
}

/// What a strand's path is like, by the strand at rest.
pub(crate) struct PathShape {
    /// Where it is cut.
    pub cuts: Vec<Cut>,
    /// Which of its joints a picture needs.
    pub detail: Detail,
    /// The strands beside it along the hem that it ends at, where its brush ends flat.
    pub hem: Option<Beside>,
}

impl Object {
    /// An object of a program's own, without any file, where its head and hair are. Its head is still; hair may fall.
    ///
    /// # Errors
    ///
    /// When no path can be made of the strands.
    pub fn new(hair: HairModel, head: Option<HeadModel>, look: Look) -> Result<Self, StageError> {
        let look = Arc::new(look);
        Self::of(hair, head, look, MotionScript::default())
    }

    /// Reads the preset's files. What is guessed about them is noted.
    pub(crate) fn load(
        preset: &Preset,
        files: &Files,
        look: Arc<Look>,
        notes: &mut Vec<String>,
    ) -> Result<Self, StageError> {
        let ReadHead {
            model: head,
            hair: own_hair,
            orientation,
        } = load::head(preset, files, notes)?;
        let mut hair = match own_hair {
            Some(own) => own,
            None => load::hair(preset, files, head.as_ref(), notes)?,
        };
        let script = script::load(preset, files, &mut hair, head.as_ref(), &orientation)?;
        notes.extend(script.below.as_ref().and_then(script::Below::jump_note));
        notes.extend(script.bodies.iter().flat_map(|body| body.notes()));
        hair.choose_guides(&preset.sections.hair);
        hair.move_out_of_bodies(&script, &preset.sections.dynamics);
        bake::load(preset, files, &mut hair, notes)?;
        notes.extend(hair.still_note());
        if !script.is_still() {
            notes.extend(hair.idle_notes(&preset.sections.dynamics));
        }
        if let Some(period) = script.period.filter(|_| script.closes)
            && hair.bake.is_none()
        {
            notes.extend(closed::notes(period, preset.sections.scene.fps));
        }
        if hair.has_own_colors() {
            notes.extend(look.shades_note());
        }
        let is_on_other = preset.is_on_other_hair(files);
        zones::check(&preset.layers, (&hair, &look), is_on_other, notes)?;
        let (wears_ties, is_given) = (!hair.ornaments.is_empty(), files.head.is_some());
        head::layers::check(&preset.layers, head.as_ref(), wears_ties, is_given, notes)?;
        let (listed, layers) = (&preset.lines, &preset.layers);
        lines::check(listed, layers, head.as_ref(), wears_ties, is_given, notes)?;
        let mut object = Self::of(hair, head, look, script)?;
        if let Some(head) = &object.bare_head {
            object.bodies = files.heads.bodies(head.clone(), object.hair.head);
        }
        Ok(object)
    }

    fn of(
        hair: HairModel,
        head: Option<HeadModel>,
        look: Arc<Look>,
        script: MotionScript,
    ) -> Result<Self, StageError> {
        let head = head.map(Arc::new);
        let given_look = look;
        let look = on_hair(&given_look, &hair);
        Ok(Self {
            neck: head
                .as_deref()
                .map(|head| Arc::new(neck(head, &hair, &look))),
            shapes: Arc::new(shapes(&hair, &look)?),
            bare_head: head,
            hair: Arc::new(hair),
            script: Arc::new(script),
            bodies: SharedBodies::default(),
            given_look,
            look,
            placement: Placement::default(),
        })
    }

    /// The same hair and head with another look.
    ///
    /// # Errors
    ///
    /// When no path of the look's kind can be made of the strands.
    pub fn with_look(&self, look: Look) -> Result<Self, StageError> {
        self.in_look(Arc::new(look))
    }

    pub(crate) fn in_look(&self, look: Arc<Look>) -> Result<Self, StageError> {
        let given_look = look;
        let look = on_hair(&given_look, &self.hair);
        let mut object = self.clone();
        if look.path() != self.look.path() || look.brush() != self.look.brush() {
            object.shapes = Arc::new(shapes(&self.hair, &look)?);
        }
        if look.sections.head.scalp != self.look.sections.head.scalp {
            let bare = self.bare_head.as_deref();
            object.neck = bare.map(|head| Arc::new(neck(head, &self.hair, &look)));
        }
        object.given_look = given_look;
        object.look = look;
        Ok(object)
    }

    /// Other hair on the same head, in the same look.
    ///
    /// # Errors
    ///
    /// When no path can be made of the strands.
    pub fn with_hair(&self, hair: HairModel) -> Result<Self, StageError> {
        let bare = self.bare_head.as_deref();
        let look = on_hair(&self.given_look, &hair);
        Ok(Self {
            shapes: Arc::new(shapes(&hair, &look)?),
            neck: bare.map(|head| Arc::new(neck(head, &hair, &look))),
            look,
            script: match self.script.skeleton() {
                Some(_) => Arc::new(self.script.with_hair(&hair)),
                None => self.script.clone(),
            },
            bodies: match hair.head == self.hair.head {
                true => self.bodies.clone(),
                false => SharedBodies::default(),
            },
            hair: Arc::new(hair),
            ..self.clone()
        })
    }

    /// The same, turned by degrees to its left about the world's upward axis through 0, and then moved by `shift_m` (metres). Head and
    /// hair move as they did in front of it, and go on where the place changes; winds blow as they did in the world.
    #[must_use]
    pub fn placed(&self, turn_degrees: f32, shift_m: Vec3) -> Self {
        Self {
            placement: Placement::new(turn_degrees, shift_m),
            ..self.clone()
        }
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

    /// Where its head is in the scene while nothing moves, and how large.
    #[must_use]
    pub fn head(&self) -> Head {
        self.placement.head(self.hair.head)
    }

    pub(crate) fn shared_look(&self) -> &Arc<Look> {
        &self.look
    }

    pub(crate) fn script(&self) -> &MotionScript {
        &self.script
    }

    /// What its head turns about.
    pub(crate) fn pivot(&self) -> Vec3 {
        match &self.neck {
            Some(neck) => neck.pivot(),
            None => pivot(self.hair.head),
        }
    }

    /// The rigid motion of what is fixed to its head, in this pose: `rotation * p + translation`, where its files have it.
    pub(crate) fn rigid(&self, pose: HeadPose) -> (DQuat, DVec3) {
        rigid(pose, self.hair.head, self.pivot())
    }

    /// The head as it was given.
    pub(crate) fn bare_head(&self) -> Option<&HeadModel> {
        self.bare_head.as_deref()
    }

    /// What hair cannot enter, made when it is first asked for.
    pub(crate) fn bodies(&self) -> &Arc<Bodies> {
        once(&self.bodies, || {
            let mesh = self.bare_head().map(HeadModel::body_mesh);
            Arc::new(Bodies::new(mesh, self.hair.head))
        })
    }

    pub(crate) fn neck(&self) -> Option<&Neck> {
        self.neck.as_deref()
    }

    pub(crate) fn shapes(&self) -> &[PathShape] {
        &self.shapes
    }

    pub(crate) fn placement(&self) -> Placement {
        self.placement
    }

    /// Whether both have the same hair on the same head, not only alike ones.
    pub(crate) fn has_hair_and_head_of(&self, other: &Self) -> bool {
        let same_head = match (&self.neck, &other.neck) {
            (Some(own), Some(others)) => Arc::ptr_eq(own, others),
            (own, others) => own.is_none() && others.is_none(),
        };
        same_head && Arc::ptr_eq(&self.hair, &other.hair)
    }

    /// Whether both are drawn alike where they have moved alike: they share all parts, and stand in one place.
    pub(crate) fn is_drawn_as(&self, other: &Self) -> bool {
        self.has_hair_and_head_of(other)
            && Arc::ptr_eq(&self.look, &other.look)
            && Arc::ptr_eq(&self.shapes, &other.shapes)
            && self.placement == other.placement
    }

    /// Whether hair moves alike in both: the same hair on the same head, with the same script and dynamics.
    pub(crate) fn moves_as(&self, other: &Self) -> bool {
        let (own, others) = (&self.look, &other.look);
        self.has_hair_and_head_of(other)
            && Arc::ptr_eq(&self.script, &other.script)
            && own.seed == others.seed
            && own.sections.dynamics == others.sections.dynamics
    }
}

/// The head with what the hair wears, and with what of it has hair told from what has none.
fn neck(head: &HeadModel, hair: &HairModel, look: &Look) -> Neck {
    let mut model = head.clone();
    model.add_ornaments(&hair.ornaments);
    let reach = look.sections.head.scalp;
    // A style's own coat lies there.
    if reach > 0.0 && hair.undercoat == 0 {
        model.find_scalp(&hair.all_roots, reach * hair.head.height_m);
    }
    Neck::new(model, hair.head)
}

/// A look as it is on this hair.
fn on_hair(look: &Arc<Look>, hair: &HairModel) -> Arc<Look> {
    let in_shades = match hair.has_own_colors() {
        true => look.in_shades_of_hair(),
        false => None,
    };
    in_shades.map_or_else(|| look.clone(), Arc::new)
}

fn shapes(hair: &HairModel, look: &Look) -> Result<Vec<PathShape>, StageError> {
    let coarseness = coarseness(hair);
    let shape = |(i, info): (usize, &StrandInfo)| {
        let overlap_m = OVERLAP * info.size * hair.head.unit_m();
        let rest = hair.file.strands.strand(i);
        let cuts = stroke_path::cuts(rest, look.path(), overlap_m)?;
        let hem = match look.brush() {
            Brush::Circle => None,
            Brush::Semicircle => hem::beside(hair, i),
        };
        let detail = match hem {
            None => Detail::of(rest, look.path(), &cuts, coarseness)?,
            Some(_) => Detail::of(&hem::bent(rest), look.path(), &cuts, coarseness)?,
        };
        Ok(PathShape { cuts, detail, hem })
    };
    hair.infos.par_iter().enumerate().map(shape).collect()
}

/// From how many clumps over each other on, spread on the head, hair is dense.
const DENSE: f32 = 11.0;

/// From so many strands on nobody tells one from the other.
const MANY: f32 = 4000.0;

/// How many times as far apart joints of dense hair may be, and how many times as wrong the paths of many strands, at most.
const COARSEST: f32 = 2.0;

/// How coarse the paths of hair may be: where many strands lie over each other what one's strokes do between joints makes less of a
/// difference, and where there are thousands so does where one of them is.
fn coarseness(hair: &HairModel) -> Coarseness {
    let strands = hair.file.strands.iter().zip(&hair.infos);
    let areas = strands.map(|(points, info)| {
        let links = points.windows(2).map(|link| link[0].distance(link[1]));
        2.0 * info.size * hair.head.unit_m() * links.sum::<f32>()
    });
    let head = std::f32::consts::PI * hair.head.height_m.powi(2);
    let layers = areas.sum::<f32>() / head;
    let many = hair.infos.len() as f32 / MANY;
    Coarseness {
        apart: (layers / DENSE).max(many).clamp(1.0, COARSEST),
        error: many.clamp(1.0, COARSEST),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::together::scene;

    #[test]
    fn what_hair_cannot_enter_is_made_once_for_a_head() {
        let scene = scene("pixie", "head-turn");
        let object = &scene.objects()[0];
        let bodies = object.bodies();
        let mut lighter = Look::clone(object.look());
        lighter.sections.dynamics.gravity *= 0.5;
        let other_hair = || {
            let head = object.bare_head.as_deref();
            HairModel::new(object.hair().file.strands.clone(), head).unwrap()
        };
        let same = [
            object.placed(30.0, Vec3::X),
            object.with_look(lighter).unwrap(),
            object.with_hair(other_hair()).unwrap(),
        ];
        for same in same {
            assert!(Arc::ptr_eq(same.bodies(), bodies));
        }
        let mut larger = other_hair();
        larger.head.height_m *= 1.5;
        let larger = object.with_hair(larger).unwrap();
        assert!(!Arc::ptr_eq(larger.bodies(), bodies));
    }

    /// As a live program loads it after each edit, with the same heads in its files.
    #[test]
    fn a_scene_that_is_loaded_again_keeps_hair_out_by_what_was_made() {
        let registry = effects::Registry::new();
        let text = r#"(version: 1, head: (shape: figure), hair: (file: "styles/pixie.style.ron"), layers: [])"#;
        let preset = Preset::parse("look.ron", text, &registry).unwrap();
        let presets = concat!(env!("CARGO_MANIFEST_DIR"), "/../../presets");
        let load = |files: &Files| {
            let look = Arc::new(Look::new(&preset, files).unwrap());
            Object::load(&preset, files, look, &mut Vec::new()).unwrap()
        };
        let files = Files {
            preset_folder: presets.into(),
            ..Files::default()
        };
        let first = load(&files);
        let again = load(&files.clone());
        assert!(Arc::ptr_eq(first.bodies(), again.bodies()));
        let other = Files {
            preset_folder: presets.into(),
            ..Files::default()
        };
        assert!(!Arc::ptr_eq(first.bodies(), load(&other).bodies()));
    }
}
