//! What frames have of an object's meshes: head, bodies, ties.

use super::ball_around;
use crate::head;
use crate::head::layers::MeshLayers;
use crate::motion::ObjectMotion;
use crate::neck::PosedHead;
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
    /// Surfaces on the screen. `posed` is the head in its last pose, made where it is first seen.
    pub fn seen(&self, posed: &mut Option<PosedHead>) -> SeenMeshes {
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
    fn head(&self, posed: &mut Option<PosedHead>) -> SeenMeshes {
        const NOTHING: SeenMeshes = SeenMeshes {
            surfaces: Vec::new(),
            solid: None,
        };
        let Self { object, sight, .. } = self;
        let Some(neck) = object.neck() else {
            return NOTHING;
        };
        let (head, look) = (object.hair().head, object.look());
        let (paint, pose) = (look.paint(head), self.motion.head_pose());
        let camera = sight.camera();
        let (center, radius) = neck.ball(pose);
        if !sight.may_see_ball(center, radius + paint.width_m) {
            return NOTHING;
        }
        let solid = match sight.shows_all() {
            true => None,
            false => neck.solid(pose, head, camera.eye(), camera.near_m()),
        };
        let posed = posed.get_or_insert_with(|| PosedHead::new(neck));
        let model = posed.in_pose(neck, pose);
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
            let mesh = body.drawn(motion.posed_s(), &posture)?;
            let (center, radius_m) = ball_around(&mesh.positions);
            let is_seen = self.sight.may_see_ball(center, radius_m + paint.width_m);
            let camera = self.sight.camera();
            is_seen.then(|| head::painted(&mesh, &paint, self.layers, camera, &self.light))
        });
        drawn.flatten().collect()
    }
}
