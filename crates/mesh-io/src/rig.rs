//! What moves a character's meshes: nodes, skins and morphs, and animations, sampled at any time.

use std::collections::BTreeMap;

use glam::{Affine3A, DAffine3, DQuat, DVec3, Mat3A, Vec3, Vec3A};

use crate::model::Model;
use crate::track::Track;

/// A place in a parent's space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// In m.
    pub translation: DVec3,
    /// A unit quaternion.
    pub rotation: DQuat,
    /// Along the three axes.
    pub scale: DVec3,
}

/// Nodes, skins and animations. Nodes have the numbers that the file gives them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rig {
    /// The nodes: bones, and what meshes hang on.
    pub nodes: Vec<Node>,
    /// The animations.
    pub animations: Vec<Animation>,
    /// Nodes of a humanoid's bones, by the names of VRM: `head`, `leftUpperArm`. VRM says them; of other files they are those that are called as Mixamo,
    /// Unreal or Rigify calls them, where arms and legs are all there.
    pub humanoid: BTreeMap<String, usize>,
    /// What swings, as VRM has it.
    pub springs: Springs,
    pub(crate) skins: Vec<Skin>,
    /// One a mesh of the model.
    pub(crate) deforms: Vec<Deform>,
    /// Nodes, each after its parent.
    pub(crate) order: Vec<usize>,
    /// What the whole is turned by.
    pub(crate) root: DAffine3,
}

/// What of a character swings (spring bones), and the bodies that it cannot enter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Springs {
    /// The nodes that swing, ascending.
    pub joints: Vec<usize>,
    /// Bodies that hang on nodes.
    pub colliders: Vec<SpringCollider>,
}

/// All that is within a radius of a line, in the space of a node; a ball where both ends are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringCollider {
    /// The node.
    pub node: usize,
    /// The line's ends in the node's space, finite.
    pub ends: [DVec3; 2],
    /// In the node's units, above 0 and finite.
    pub radius: f64,
}

impl SpringCollider {
    /// `None` where a number is not finite, or the radius not above 0.
    #[cfg_attr(not(feature = "gltf"), expect(dead_code, reason = "only VRM has them"))]
    pub(crate) fn new(node: usize, ends: [DVec3; 2], radius: f64) -> Option<Self> {
        let is_whole = ends.iter().all(|end| end.is_finite()) && radius.is_finite() && radius > 0.0;
        is_whole.then_some(Self { node, ends, radius })
    }
}

/// A bone, or what meshes hang on.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Its name, where it has one.
    pub name: Option<String>,
    /// The number of its parent.
    pub parent: Option<usize>,
    /// Where it is where nothing moves it.
    pub rest: Transform,
    /// How much of each morph its mesh has where nothing moves it.
    pub weights: Vec<f64>,
}

/// An animation.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// Its name, where it has one.
    pub name: Option<String>,
    /// When its last key is, in s.
    pub length: f64,
    /// What moves, by its node.
    pub(crate) tracks: BTreeMap<usize, NodeTracks>,
}

/// What moves a node.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct NodeTracks {
    pub translation: Option<Track<DVec3>>,
    pub rotation: Option<Track<DQuat>>,
    pub scale: Option<Track<DVec3>>,
    /// One a morph; empty where they don't move.
    pub weights: Vec<Track<f64>>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Skin {
    /// Nodes.
    pub joints: Vec<usize>,
    /// From the mesh's space into each joint's, as the mesh is bound.
    pub inverse: Vec<DAffine3>,
}

/// The joints that move a vertex, of its skin's list, with weights whose sum is 1.
pub(crate) type Influences = [(u16, f32); 8];

/// What moves a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Deform {
    pub node: usize,
    pub skin: Option<usize>,
    /// In the mesh's own space.
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    /// Of each vertex.
    pub influences: Vec<Influences>,
    pub morphs: Vec<Morph>,
}

/// How far a morph moves each vertex and its normal; empty is not at all.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Morph {
    pub name: String,
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
}

/// Where each node is in its parent's space, and how much of each morph its mesh has: made by [`Model::pose`], and free to change.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// One a node.
    pub nodes: Vec<Transform>,
    /// One list a node, of as many weights as the morphs of its mesh; those that lack are 0.
    pub weights: Vec<Vec<f64>>,
}

/// A mesh as it is moved.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// One a vertex of the mesh.
    pub positions: Vec<Vec3>,
    /// Unit normals, one a vertex.
    pub normals: Vec<Vec3>,
}

impl Transform {
    /// At the parent's place.
    pub const IDENTITY: Self = Self {
        translation: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
    };

    /// As an affine map.
    #[must_use]
    pub fn affine(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

impl NodeTracks {
    /// Where the node is at `time`, s; what does not move is at `rest`.
    pub fn at(&self, time: f64, rest: &Transform) -> Transform {
        let now = |track: &Option<Track<DVec3>>, rest| track.as_ref().map_or(rest, |t| t.at(time));
        Transform {
            translation: now(&self.translation, rest.translation),
            rotation: (self.rotation.as_ref()).map_or(rest.rotation, |track| track.at(time)),
            scale: now(&self.scale, rest.scale),
        }
    }
}

impl Rig {
    /// The numbers of all nodes, each after its parent's.
    #[must_use]
    pub fn parents_first(&self) -> &[usize] {
        &self.order
    }

    /// The number of the animation of this name, or of this number as a text, 0 first.
    #[must_use]
    pub fn animation(&self, wanted: &str) -> Option<usize> {
        let named = self
            .animations
            .iter()
            .position(|a| a.name.as_deref() == Some(wanted));
        named.or_else(|| {
            wanted
                .parse()
                .ok()
                .filter(|number| *number < self.animations.len())
        })
    }

    /// The node of this name: a bone of a humanoid as VRM names it, or else as the file does.
    #[must_use]
    pub fn node(&self, wanted: &str) -> Option<usize> {
        let named = || {
            self.nodes
                .iter()
                .position(|node| node.name.as_deref() == Some(wanted))
        };
        self.humanoid.get(wanted).copied().or_else(named)
    }

    /// Where nothing moves it.
    #[must_use]
    pub fn rest(&self) -> Pose {
        Pose {
            nodes: self.nodes.iter().map(|node| node.rest).collect(),
            weights: self.nodes.iter().map(|node| node.weights.clone()).collect(),
        }
    }

    /// The pose at `time` (s) of an animation by its number. Before its first key and after its last it stays.
    ///
    /// # Panics
    ///
    /// When there is no such animation.
    #[must_use]
    pub fn pose(&self, animation: usize, time: f64) -> Pose {
        let mut pose = self.rest();
        for (&node, tracks) in &self.animations[animation].tracks {
            pose.nodes[node] = tracks.at(time, &self.nodes[node].rest);
            if !tracks.weights.is_empty() {
                pose.weights[node] = tracks.weights.iter().map(|track| track.at(time)).collect();
            }
        }
        pose
    }

    /// From each node's space into the world.
    ///
    /// # Panics
    ///
    /// When the pose has not as many nodes.
    #[must_use]
    pub fn world(&self, pose: &Pose) -> Vec<DAffine3> {
        let mut world = vec![self.root; self.nodes.len()];
        for &node in &self.order {
            let parent = self.nodes[node]
                .parent
                .map_or(self.root, |parent| world[parent]);
            world[node] = parent * pose.nodes[node].affine();
        }
        world
    }

    /// Where the vertices of a mesh are, of nodes that are at `world`.
    fn shape(&self, deform: &Deform, world: &[DAffine3], weights: &[f64]) -> Shape {
        let mut shape = Shape {
            positions: deform.positions.clone(),
            normals: deform.normals.clone(),
        };
        for (morph, &weight) in deform.morphs.iter().zip(weights) {
            let weight = weight as f32;
            if weight == 0.0 || !weight.is_finite() {
                continue;
            }
            for (list, moves) in [
                (&mut shape.positions, &morph.positions),
                (&mut shape.normals, &morph.normals),
            ] {
                for (place, by) in list.iter_mut().zip(moves) {
                    *place += *by * weight;
                }
            }
        }

        match deform.skin.map(|skin| &self.skins[skin]) {
            Some(skin) if !deform.influences.is_empty() => {
                let joints = skin.joints.iter().zip(&skin.inverse);
                let moves: Vec<Affine3A> = joints
                    .map(|(joint, inverse)| single(world[*joint] * *inverse))
                    .collect();
                let vertices = shape.positions.iter_mut().zip(&mut shape.normals);
                for ((place, normal), influences) in vertices.zip(&deform.influences) {
                    move_vertex(&blend(&moves, influences), place, normal);
                }
            }
            _ => {
                let by = single(world[deform.node]);
                for (place, normal) in shape.positions.iter_mut().zip(&mut shape.normals) {
                    move_vertex(&by, place, normal);
                }
            }
        }
        shape
    }
}

impl Rig {
    /// Tells of a vertex of a mesh whether nodes that are at `world` mirror it, so that what was the outside of its triangles is the inside
    /// (glTF 2.0, 3.7.4).
    #[cfg_attr(
        not(feature = "gltf"),
        expect(dead_code, reason = "only glTF has nodes")
    )]
    pub(crate) fn mirrors<'a>(
        &'a self,
        deform: &'a Deform,
        world: &[DAffine3],
    ) -> impl Fn(usize) -> bool + use<'a> {
        let skin = deform.skin.map(|skin| &self.skins[skin]);
        let skin = skin.filter(|_| !deform.influences.is_empty());
        let by_node = world[deform.node].matrix3.determinant() < 0.0;
        let moves: Vec<Affine3A> = skin.map_or(Vec::new(), |skin| {
            let joints = skin.joints.iter().zip(&skin.inverse);
            joints
                .map(|(joint, inverse)| single(world[*joint] * *inverse))
                .collect()
        });
        // Between joints that don't mirror nothing does.
        let by_any = moves.iter().any(|by| by.matrix3.determinant() < 0.0);
        move |vertex| match skin {
            None => by_node,
            Some(_) => {
                by_any
                    && blend(&moves, &deform.influences[vertex])
                        .matrix3
                        .determinant()
                        < 0.0
            }
        }
    }
}

/// The mean of what the joints do to a vertex.
fn blend(moves: &[Affine3A], influences: &Influences) -> Affine3A {
    let mut sum = Affine3A::ZERO;
    // Those without a weight come last.
    for (joint, weight) in influences.iter().take_while(|(_, weight)| *weight > 0.0) {
        let by = &moves[usize::from(*joint)];
        sum.matrix3 += by.matrix3 * *weight;
        sum.translation += by.translation * *weight;
    }
    sum
}

fn move_vertex(by: &Affine3A, place: &mut Vec3, normal: &mut Vec3) {
    *place = by.transform_point3(*place);
    let way = normals_of(&by.matrix3) * Vec3A::from(*normal);
    *normal = Vec3::from(way).normalize_or_zero();
}

/// What takes normals where `by` takes places, but for their length: its cofactors, which needs no inverse.
fn normals_of(by: &Mat3A) -> Mat3A {
    let Mat3A {
        x_axis: x,
        y_axis: y,
        z_axis: z,
    } = *by;
    let cofactors = Mat3A::from_cols(y.cross(z), z.cross(x), x.cross(y));
    // Mirrored, outside is still outside.
    if x.cross(y).dot(z) < 0.0 {
        -cofactors
    } else {
        cofactors
    }
}

fn single(by: DAffine3) -> Affine3A {
    let [x, y, z, w] = [
        by.matrix3.x_axis,
        by.matrix3.y_axis,
        by.matrix3.z_axis,
        by.translation,
    ]
    .map(|v| Vec3A::from(v.as_vec3()));
    Affine3A {
        matrix3: Mat3A::from_cols(x, y, z),
        translation: w,
    }
}

impl Model {
    /// The pose at `time` (s) of the animation of this number; without one, at rest. `None` where the model has no rig, or no such
    /// animation.
    #[must_use]
    pub fn pose(&self, animation: Option<usize>, time: f64) -> Option<Pose> {
        let rig = self.rig.as_ref()?;
        match animation {
            None => Some(rig.rest()),
            Some(number) => (number < rig.animations.len()).then(|| rig.pose(number, time)),
        }
    }

    /// The meshes in a pose, one after the other. A vertex that the pose takes nowhere (NaN, infinity) stays where it is at rest. Of a
    /// model without a rig: as they are.
    ///
    /// # Panics
    ///
    /// When the pose has not as many nodes as the model's rig.
    #[must_use]
    pub fn shapes(&self, pose: &Pose) -> Vec<Shape> {
        let world = self.rig.as_ref().map(|rig| (rig, rig.world(pose)));
        let shape = |(number, mesh): (usize, &crate::Mesh)| {
            let mut shape = match &world {
                Some((rig, world)) => {
                    let deform = &rig.deforms[number];
                    let weights = pose
                        .weights
                        .get(deform.node)
                        .map_or(&[][..], |weights| weights);
                    rig.shape(deform, world, weights)
                }
                None => Shape {
                    positions: mesh.positions.clone(),
                    normals: mesh.normals.clone(),
                },
            };
            for (vertex, place) in shape.positions.iter_mut().enumerate() {
                if !place.is_finite() {
                    *place = mesh.positions.get(vertex).copied().unwrap_or_default();
                }
            }
            for (vertex, normal) in shape.normals.iter_mut().enumerate() {
                if !normal.is_finite() || *normal == Vec3::ZERO {
                    *normal = mesh.normals.get(vertex).copied().unwrap_or(Vec3::Y);
                }
            }
            shape
        };
        self.meshes.iter().enumerate().map(shape).collect()
    }

    /// The names of a mesh's morphs, in the order of a pose's weights.
    #[must_use]
    pub fn morphs(&self, mesh: usize) -> Vec<&str> {
        let deform = self.rig.as_ref().and_then(|rig| rig.deforms.get(mesh));
        let morphs = deform.map_or(&[][..], |deform| &deform.morphs);
        morphs.iter().map(|morph| morph.name.as_str()).collect()
    }

    /// The nodes that move a vertex of a mesh, with weights whose sum is 1; none of a model without a rig.
    ///
    /// # Panics
    ///
    /// When the mesh is of a skin and has no such vertex.
    pub fn influences(&self, mesh: usize, vertex: usize) -> impl Iterator<Item = (usize, f32)> {
        let rig = self.rig.as_ref();
        let deform = rig.and_then(|rig| Some((rig, rig.deforms.get(mesh)?)));
        let (own, skin, whole) = match deform {
            None => (&[][..], &[][..], None),
            Some((rig, deform)) => match deform.skin.map(|skin| &rig.skins[skin]) {
                Some(skin) if !deform.influences.is_empty() => {
                    (&deform.influences[vertex][..], &skin.joints[..], None)
                }
                _ => (&[][..], &[][..], Some((deform.node, 1.0))),
            },
        };
        let own = own.iter().take_while(|(_, weight)| *weight > 0.0);
        let own = own.map(|(joint, weight)| (skin[usize::from(*joint)], *weight));
        own.chain(whole)
    }

    /// The node that a mesh hangs on, whose weights of a pose are its morphs'.
    #[must_use]
    pub fn node_of(&self, mesh: usize) -> Option<usize> {
        let deform = self.rig.as_ref()?.deforms.get(mesh)?;
        Some(deform.node)
    }
}
