//! What frames have of an object's meshes: head, bodies, ties.

use crate::head;
use crate::head::layers::MeshLayers;
use crate::motion::ObjectMotion;
use crate::neck::{Neck, PosedHead};
use crate::object::Object;
use crate::posture::Posture;
use crate::reach::Sight;
use render::{Ball, Light, Surface};

/// An object's meshes in a frame. They know nothing of its hair's paths, which are made beside them.
pub(super) struct ObjectMeshes<'a> {
    pub object: &'a Object,
    /// Its place among the scene's.
    pub index: usize,
    pub motion: &'a ObjectMotion,
    pub sight: &'a Sight,
    /// Seen from the object.
    pub light: Light,
    pub layers: &'a MeshLayers<'a>,
}

/// What is seen of them.
pub(super) struct SeenMeshes {
    pub surfaces: Vec<Surface>,
    /// What hides hair, in the world.
    pub solid: Option<Ball>,
}

impl ObjectMeshes<'_> {
    /// Takes the head to its pose where something of it can be seen. It is made where it is first seen.
    pub fn pose(&self, posed: &mut Option<PosedHead>) {
        if let Some(neck) = self.object.neck().filter(|neck| self.may_see(neck)) {
            let posed = posed.get_or_insert_with(|| PosedHead::new(neck));
            posed.in_pose(neck, self.motion.head_pose());
        }
    }

    /// Whether something of a head can be seen.
    fn may_see(&self, neck: &Neck) -> bool {
        let paint = self.object.look().paint(self.object.hair().head);
        let (center, radius) = neck.ball(self.motion.head_pose());
        self.sight.may_see_ball(center, radius + paint.width_m)
    }

    /// Surfaces on the screen. `posed` is the head in its pose.
    pub fn seen(&self, posed: Option<&PosedHead>) -> SeenMeshes {
        let Self { object, sight, .. } = self;
        let SeenMeshes {
            mut surfaces,
            solid,
        } = self.head(posed);
        surfaces.extend(self.bodies());
        let hair = object.hair();
        let ties = hair.low_ties_at(self.motion.points(object), self.motion.head_pose());
        if !ties.triangles.is_empty() {
            let paint = object.look().paint(hair.head);
            let camera = sight.camera();
            surfaces.extend(head::worn(&ties, &paint, self.layers, camera, &self.light));
        }
        let placement = object.placement();
        let first_mesh = head::MESHES * self.index as u32;
        for surface in &mut surfaces {
            surface.mesh += first_mesh;
            if let Some(paint) = &mut surface.paint {
                placement.turn(&mut paint.normals);
            }
        }
        SeenMeshes { surfaces, solid }
    }

    /// The head's; none where nothing of the head can be seen.
    fn head(&self, posed: Option<&PosedHead>) -> SeenMeshes {
        const NOTHING: SeenMeshes = SeenMeshes {
            surfaces: Vec::new(),
            solid: None,
        };
        let Self { object, sight, .. } = self;
        let neck = object.neck().filter(|neck| self.may_see(neck));
        let (Some(neck), Some(posed)) = (neck, posed) else {
            return NOTHING;
        };
        let (head, look) = (object.hair().head, object.look());
        let (paint, pose) = (look.paint(head), self.motion.head_pose());
        let camera = sight.camera();
        let solid = match sight.shows_all() {
            true => None,
            false => neck.solid(pose, head, camera.eye(), camera.near_m()),
        };
        let model = posed.model();
        let (meshes, layers) = (look.meshes(), self.layers);
        SeenMeshes {
            surfaces: head::surfaces(model, &paint, meshes, layers, camera, &self.light),
            solid: solid.map(|ball| object.placement().ball(ball)),
        }
    }

    /// Those of bodies that are drawn.
    fn bodies(&self) -> Vec<Surface> {
        let Self { object, motion, .. } = self;
        let bodies = &object.script().bodies;
        if bodies.iter().all(|body| body.section.color.is_none()) {
            return Vec::new();
        }
        let head = object.hair().head;
        let paint = object.look().paint(head);
        let posture = Posture::of(
            motion.head_pose(),
            (head, object.pivot()),
            object.script(),
            motion.posed_s(),
        );
        let drawn = bodies.iter().filter_map(|body| {
            let (center, radius_m) = body.ball(motion.posed_s(), &posture);
            // Its corners are rounded to single precision.
            let radius_m = 1.0001 * radius_m as f32 + paint.width_m;
            if !self.sight.may_see_ball(center.as_vec3(), radius_m) {
                return None;
            }
            let mesh = body.drawn(motion.posed_s(), &posture)?;
            let camera = self.sight.camera();
            Some(head::painted(
                &mesh,
                &paint,
                self.layers,
                camera,
                &self.light,
            ))
        });
        drawn.flatten().collect()
    }
}
