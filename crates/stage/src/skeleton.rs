//! A character that moves by its own skeleton: its file's animation poses bones and meshes.

mod limbs;

use crate::files::StageError;
use crate::neck::pivot;
use crate::painted::PaintedMesh;
use crate::preset::MotionSection;
use crate::script::come_round;
use effects::preset::suggestion;
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use hair_io::orient::Orientation;
use hair_sim::{Collider, Pose, Shape};
use limbs::Limbs;
use mesh_io::{Model, Rig};
use render::Head;
use std::path::Path;
use std::sync::Arc;

/// At so many times of an animation the head's bone is looked at when it is read.
const LOOKED_AT: u32 = 64;
/// Hair that begins so deep in a collider in m, or deeper, is not kept out of it.
const INSIDE_M: f64 = 0.005;
/// A limb that hair is in at rest is so much thinner that it no longer is, down to this part of it.
const THINNEST: f64 = 0.5;

/// A character's model, and the animation that moves it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Skeleton {
    model: Arc<Model>,
    orientation: Orientation,
    /// From the model's space into ours, and back.
    to_ours: [DAffine3; 2],
    animation: usize,
    /// Seconds.
    length: f64,
    repeats: bool,
    /// The node that hair is on, and the one that shoulders are on.
    head: usize,
    chest: Option<usize>,
    /// From each node's space into the world, and back, where nothing moves it.
    rest: Vec<[DAffine3; 2]>,
    limbs: Limbs,
    bodies: Vec<Body>,
}

/// A collider of the file's or a limb, as it lies at rest, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Body {
    node: usize,
    ends: [DVec3; 2],
    radius: f64,
}

impl Body {
    fn is_whole(&self) -> bool {
        self.ends.iter().all(|end| end.is_finite()) && self.radius.is_finite()
    }

    /// How far hair is from its line, in m.
    fn room(&self, hair: &[Vec3]) -> f64 {
        let [from, to] = self.ends;
        let way = to - from;
        let away = |point: &Vec3| {
            let point = point.as_dvec3();
            let along = (point - from).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
            point.distance(from + way * along.clamp(0.0, 1.0))
        };
        hair.iter().map(away).fold(f64::INFINITY, f64::min)
    }
}

/// Where bones have come to since rest, in the world.
#[derive(Clone, Debug)]
pub(crate) struct Bones<'s> {
    skeleton: &'s Skeleton,
    world: Vec<DAffine3>,
}

impl Skeleton {
    /// The skeleton of a model that lies in our space by `orientation`, and the animation that the section names. `is_gone` tells of each mesh and each of
    /// its triangles whether it is not drawn.
    ///
    /// # Errors
    ///
    /// When there is no such bone or animation, or it takes the head nowhere.
    pub fn new(
        model: Arc<Model>,
        path: &Path,
        orientation: &Orientation,
        section: &MotionSection,
        is_gone: &[Vec<bool>],
    ) -> Result<Self, StageError> {
        let wrong = |message: String| StageError::Skeleton {
            path: path.to_owned(),
            message,
        };
        let rig = model.rig.as_ref();
        let rig = rig.ok_or_else(|| wrong("it has no bones".to_owned()))?;
        let animation = animation_of(rig, section.animation.as_deref()).map_err(wrong)?;
        let bone = section.bone.as_deref().unwrap_or("head");
        let head = node_of(rig, bone).map_err(wrong)?;
        let chest = ["upperChest", "chest", "spine"];
        let chest = chest
            .iter()
            .find_map(|name| rig.humanoid.get(*name).copied());
        let rest = rig.world(&rig.rest());
        let skeleton = Self {
            to_ours: both(affine_of(orientation)),
            orientation: *orientation,
            animation,
            length: rig.animations[animation].length,
            repeats: section.repeat,
            head,
            chest,
            rest: rest.into_iter().map(both).collect(),
            limbs: Limbs::new(&model, rig, orientation, is_gone),
            bodies: Vec::new(),
            model: model.clone(),
        };
        for step in 0..=LOOKED_AT {
            let time = skeleton.length * f64::from(step) / f64::from(LOOKED_AT);
            if skeleton.at(time).motion_or_none(head).is_none() {
                return Err(wrong(format!(
                    "its animation takes the bone `{bone}` nowhere at {time:.3} s: a number is not finite, or the bone has no size"
                )));
            }
        }
        Ok(skeleton)
    }

    /// The same with the colliders of its spring bones, but for those on the head, whose shape hair is kept out of, and those that hair is in at rest; and
    /// with the limbs that have none.
    pub fn with_bodies(mut self, hair: &[Vec3]) -> Self {
        let Some(rig) = &self.model.rig else {
            return self;
        };
        let mut on_head = vec![false; rig.nodes.len()];
        for &node in rig.parents_first() {
            let parent = rig.nodes[node].parent;
            on_head[node] = node == self.head || parent.is_some_and(|parent| on_head[parent]);
        }
        let body = |own: &mesh_io::SpringCollider| {
            let to_ours = self.to_ours[0] * self.rest[own.node][0];
            let axes = to_ours.matrix3;
            let size = (axes.x_axis.length() + axes.y_axis.length() + axes.z_axis.length()) / 3.0;
            Body {
                node: own.node,
                ends: own.ends.map(|end| to_ours.transform_point3(end)),
                radius: own.radius * size,
            }
        };
        let colliders = rig.springs.colliders.iter();
        let mut bodies: Vec<Body> = colliders
            .filter(|own| !on_head[own.node])
            .map(body)
            .filter(|body| body.is_whole() && body.room(hair) >= body.radius - INSIDE_M)
            .collect();
        let limb_of = |body: &Body| self.limbs.of_nodes[body.node];
        let covered: Vec<_> = bodies.iter().filter_map(limb_of).collect();
        let limbs = self.limbs.bodies.iter().enumerate();
        bodies.extend(limbs.filter_map(|(limb, body)| {
            let body = (*body).filter(|_| !covered.contains(&limb))?;
            let radius = body.radius.min(body.room(hair));
            (radius >= THINNEST * body.radius).then_some(Body { radius, ..body })
        }));
        self.bodies = bodies;
        self
    }

    /// Of each mesh and each of its triangles whether it is on a limb that is a body of its own.
    pub fn on_limbs(&self) -> Vec<Vec<bool>> {
        let mut has_body: Vec<bool> = self.limbs.bodies.iter().map(Option::is_some).collect();
        let rig = self.model.rig.iter();
        for own in rig.flat_map(|rig| &rig.springs.colliders) {
            if let Some(limb) = self.limbs.of_nodes[own.node] {
                has_body[limb] = true;
            }
        }
        let meshes = self.model.meshes.iter().enumerate();
        let on_limbs = meshes.map(|(index, mesh)| {
            let is_on = |vertex: usize| {
                let limb = self.limbs.of_vertex(&self.model, index, vertex);
                limb.is_some_and(|limb| has_body[limb])
            };
            let is_on: Vec<bool> = (0..mesh.positions.len()).map(is_on).collect();
            let corners = |triangle: &[u32; 3]| triangle.map(|corner| is_on[corner as usize]);
            let most = |on: [bool; 3]| on.into_iter().filter(|on| *on).count() >= 2;
            mesh.triangles
                .iter()
                .map(|own| most(corners(own)))
                .collect()
        });
        on_limbs.collect()
    }

    /// How long its animation is, seconds.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Whether its animation starts again at its end.
    pub fn repeats(&self) -> bool {
        self.repeats
    }

    /// The animation's own time at `time`, seconds: before its start and after its end it stays.
    pub fn within(&self, time: f64) -> f64 {
        match self.repeats && self.length > 0.0 {
            true => come_round(time, self.length),
            false => time.clamp(0.0, self.length),
        }
    }

    /// Its bones at `time` (seconds).
    pub fn at(&self, time: f64) -> Bones<'_> {
        let rig = self.model.rig.as_ref();
        let world = rig.map(|rig| rig.world(&rig.pose(self.animation, self.within(time))));
        Bones {
            skeleton: self,
            world: world.unwrap_or_default(),
        }
    }

    /// How the head turns about its neck at `time` (seconds), and how far that moves it in m.
    pub fn head_at(&self, time: f64, head: Head) -> (DQuat, DVec3) {
        self.at(time).head(head)
    }

    /// Puts the meshes of its file where they are at `time` (seconds).
    pub fn put(&self, time: f64, painted: &mut [PaintedMesh]) {
        let Some(pose) = self.model.pose(Some(self.animation), self.within(time)) else {
            return;
        };
        let shapes = self.model.shapes(&pose);
        let own = painted.iter_mut().filter(|mesh| mesh.section.is_none());
        for mesh in own {
            let shape = &shapes[mesh.index];
            let outwards = if mesh.is_turned { -1.0 } else { 1.0 };
            // What lost triangles lost vertices.
            for i in 0..mesh.positions.len() {
                let vertex = mesh.vertex(i);
                mesh.positions[i] = self.orientation.apply(shape.positions[vertex]);
                mesh.normals[i] = outwards * self.orientation.up.to_y_up(shape.normals[vertex]);
            }
        }
    }
}

impl Bones<'_> {
    /// Whether all of them are where those of another time are, within 0.1 mm.
    pub fn is_alike(&self, other: &Self) -> bool {
        let [to_ours, _] = self.skeleton.to_ours;
        let pairs = self.world.iter().zip(&other.world);
        pairs
            .into_iter()
            .all(|(one, other)| (to_ours * *one).abs_diff_eq(to_ours * *other, 1e-4))
    }

    /// How a node has moved since rest; as at rest where it is nowhere.
    fn motion(&self, node: usize) -> Pose {
        self.motion_or_none(node).unwrap_or(Pose::IDENTITY)
    }

    fn motion_or_none(&self, node: usize) -> Option<Pose> {
        let [to_ours, from_ours] = self.skeleton.to_ours;
        let [_, to_rest] = self.skeleton.rest.get(node)?;
        let now = to_ours * *self.world.get(node)? * *to_rest * from_ours;
        let (_, rotation, _) = now.to_scale_rotation_translation();
        // Where it has a size of its own, what it holds stays as large.
        let at = self.skeleton.place_of(node);
        let translation = now.transform_point3(at) - rotation * at;
        let is_whole =
            rotation.is_finite() && translation.is_finite() && rotation.length_squared() > 0.5;
        is_whole.then(|| Pose {
            rotation: rotation.normalize(),
            translation,
        })
    }

    /// How the head turns about its neck, and how far that moves it in m.
    pub fn head(&self, head: Head) -> (DQuat, DVec3) {
        let pose = self.motion(self.skeleton.head);
        let pivot = pivot(head).as_dvec3();
        (
            pose.rotation,
            pose.rotation * pivot + pose.translation - pivot,
        )
    }

    /// How the shoulders have moved since rest.
    pub fn shoulders(&self) -> Pose {
        self.skeleton
            .chest
            .map_or(Pose::IDENTITY, |chest| self.motion(chest))
    }
}

impl Skeleton {
    /// Where a node is at rest, in our space.
    fn place_of(&self, node: usize) -> DVec3 {
        (self.to_ours[0] * self.rest[node][0]).translation
    }

    /// The bodies in a step, whose bones move from one time's to another's, each moved as a whole by a pose on top.
    pub fn colliders(&self, bones: [&Bones; 2], on_top: [Pose; 2]) -> Vec<Collider<'_>> {
        let collider = |body: &Body| {
            let [before, now] = [0, 1].map(|i| after(bones[i].motion(body.node), on_top[i]));
            let [from, to] = body.ends;
            let radius = body.radius;
            let shape = match from == to {
                true => Shape::Sphere {
                    center: from,
                    radius,
                },
                false => Shape::Capsule { from, to, radius },
            };
            Collider {
                shape,
                before,
                now,
                was: None,
            }
        };
        self.bodies.iter().map(collider).collect()
    }
}

/// One motion, and then another.
pub(crate) fn after(first: Pose, then: Pose) -> Pose {
    Pose {
        rotation: then.rotation * first.rotation,
        translation: then.rotation * first.translation + then.translation,
    }
}

fn both(map: DAffine3) -> [DAffine3; 2] {
    [map, map.inverse()]
}

fn affine_of(orientation: &Orientation) -> DAffine3 {
    let turned =
        |axis: Vec3| orientation.up.to_y_up(axis).as_dvec3() * f64::from(orientation.scale);
    DAffine3 {
        matrix3: DMat3::from_cols(turned(Vec3::X), turned(Vec3::Y), turned(Vec3::Z)),
        translation: orientation.offset.as_dvec3(),
    }
}

fn animation_of(rig: &Rig, wanted: Option<&str>) -> Result<usize, String> {
    let names = || rig.animations.iter().filter_map(|own| own.name.as_deref());
    match (rig.animations.len(), wanted) {
        (0, _) => Err("it has no animation".to_owned()),
        (_, None) => Ok(0),
        (count, Some(wanted)) => rig.animation(wanted).ok_or_else(|| {
            let hint = suggestion(wanted, names());
            format!("none of its {count} animations is called `{wanted}`{hint}")
        }),
    }
}

fn node_of(rig: &Rig, wanted: &str) -> Result<usize, String> {
    let names = || rig.nodes.iter().filter_map(|node| node.name.as_deref());
    let alike = || {
        let is_it = |node: &mesh_io::Node| {
            node.name
                .as_deref()
                .is_some_and(|n| n.eq_ignore_ascii_case(wanted))
        };
        rig.nodes.iter().position(is_it)
    };
    rig.node(wanted).or_else(alike).ok_or_else(|| {
        let hint = suggestion(wanted, names());
        format!("it has no bone called `{wanted}`{hint}: `motion.bone` says which one the head is")
    })
}
