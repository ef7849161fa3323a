//! The motion of one bone of a character's animation: glTF 2.0 (.glb, .gltf) and what is built on it (.vrm).
//!
//! Only nodes and animations are read: a bone moves as its chain of parents does.

mod error;
mod numbers;
mod track;

pub use error::{SkeletonError, TrackError};
use glam::{DAffine3, DQuat, DVec3};
use gltf::animation::Property;
use gltf::{Animation, Document};
use numbers::Buffers;
use std::path::Path;
use track::Track;

/// The most names that a message lists.
const MOST_NAMES: usize = 8;

/// The motion of a bone against its rest.
#[derive(Clone, Debug, PartialEq)]
pub struct BoneMotion {
    /// From the outermost parent to the bone.
    chain: Vec<Joint>,
    /// Its turn and its place (m) where nothing moves it.
    rest: (DQuat, DVec3),
    /// In s.
    length: f64,
}

/// A node of the chain: its place in its parent's space, and what moves it.
#[derive(Clone, Debug, PartialEq)]
struct Joint {
    translation: DVec3,
    rotation: DQuat,
    scale: DVec3,
    translations: Option<Track<DVec3>>,
    rotations: Option<Track<DQuat>>,
    scales: Option<Track<DVec3>>,
}

impl BoneMotion {
    /// Reads the bone named `bone` of a file's bytes, in the animation of this name or number (0 first), or else in
    /// the first. The case of letters counts only where it tells bones apart. Files that the file names are in `folder`.
    ///
    /// # Errors
    ///
    /// When the bytes are not glTF, or have no such bone or animation.
    pub fn from_bytes(
        bytes: &[u8],
        folder: &Path,
        bone: &str,
        animation: Option<&str>,
    ) -> Result<Self, SkeletonError> {
        let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(bytes)?;
        let nodes = chain_to(&document, bone)?;
        let animation = find_animation(&document, animation)?;
        let mut motion = Self {
            chain: nodes.iter().map(Joint::at_rest).collect(),
            rest: (DQuat::IDENTITY, DVec3::ZERO),
            length: 0.0,
        };
        let mut buffers = Buffers::new(blob, folder);
        for (number, channel) in animation.channels().enumerate() {
            let target = channel.target();
            let moved = |node: &gltf::Node| node.index() == target.node().index();
            let Some(joint) = nodes.iter().position(moved) else {
                continue;
            };
            let joint = &mut motion.chain[joint];
            let sampler = channel.sampler();
            let length = match target.property() {
                Property::Translation => Track::read(&sampler, &mut buffers)
                    .map(|track| joint.translations.insert(track).length()),
                Property::Rotation => Track::read(&sampler, &mut buffers)
                    .map(|track| joint.rotations.insert(track).length()),
                Property::Scale => Track::read(&sampler, &mut buffers)
                    .map(|track| joint.scales.insert(track).length()),
                Property::MorphTargetWeights => Ok(0.0),
            };
            let length = length.map_err(|source| SkeletonError::Track {
                animation: animation.index(),
                channel: number,
                source,
            })?;
            motion.length = motion.length.max(length);
        }
        let (rotation, place) = motion.pose(Joint::resting);
        if !(rotation.is_finite() && place.is_finite()) {
            return Err(SkeletonError::Chain(bone.to_owned()));
        }
        motion.rest = (rotation, place);
        Ok(motion)
    }

    /// When the last key of all that moves the bone is, in s.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// How far the bone has turned at `time` (seconds) from its rest, and how far its place has moved (m): in
    /// the world, Y up. Before the first key and after the last it stays.
    #[must_use]
    pub fn at(&self, time: f64) -> (DQuat, DVec3) {
        let (rotation, place) = self.pose(|joint| joint.at(time));
        let (rest, rest_place) = self.rest;
        if rotation.is_finite() {
            (
                (rotation * rest.conjugate()).normalize(),
                place - rest_place,
            )
        } else {
            // A parent that is scaled to nothing.
            (DQuat::IDENTITY, DVec3::ZERO)
        }
    }

    /// The bone's turn and place in the world, its joints being so in their parents' spaces.
    fn pose(&self, local: impl Fn(&Joint) -> DAffine3) -> (DQuat, DVec3) {
        let world =
            (self.chain.iter()).fold(DAffine3::IDENTITY, |world, joint| world * local(joint));
        let (_, rotation, place) = world.to_scale_rotation_translation();
        (rotation.normalize(), place)
    }
}

impl Joint {
    fn at_rest(node: &gltf::Node) -> Self {
        let (translation, rotation, scale) = node.transform().decomposed();
        Self {
            translation: DVec3::from(translation.map(f64::from)),
            rotation: DQuat::from_array(rotation.map(f64::from)).normalize(),
            scale: DVec3::from(scale.map(f64::from)),
            translations: None,
            rotations: None,
            scales: None,
        }
    }

    fn resting(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }

    fn at(&self, time: f64) -> DAffine3 {
        let now = |track: &Option<Track<DVec3>>, rest| track.as_ref().map_or(rest, |t| t.at(time));
        DAffine3::from_scale_rotation_translation(
            now(&self.scales, self.scale),
            (self.rotations.as_ref()).map_or(self.rotation, |track| track.at(time)),
            now(&self.translations, self.translation),
        )
    }
}

/// The nodes from the outermost parent to the bone of this name.
fn chain_to<'a>(document: &'a Document, bone: &str) -> Result<Vec<gltf::Node<'a>>, SkeletonError> {
    let nodes: Vec<gltf::Node> = document.nodes().collect();
    let named =
        |is: &dyn Fn(&str) -> bool| nodes.iter().position(|node| node.name().is_some_and(is));
    let exact = named(&|name| name == bone);
    let Some(found) = exact.or_else(|| named(&|name| name.eq_ignore_ascii_case(bone))) else {
        let names = nodes.iter().filter_map(gltf::Node::name).map(str::to_owned);
        return Err(SkeletonError::Bone {
            wanted: bone.to_owned(),
            names: nearest(names.collect(), bone),
        });
    };
    let mut parents = vec![None; nodes.len()];
    for node in &nodes {
        for child in node.children() {
            parents[child.index()] = Some(node.index());
        }
    }
    let mut chain = vec![nodes[found].clone()];
    let mut next = parents[found];
    while let Some(parent) = next {
        if chain.len() > nodes.len() {
            return Err(SkeletonError::Chain(bone.to_owned()));
        }
        chain.push(nodes[parent].clone());
        next = parents[parent];
    }
    chain.reverse();
    Ok(chain)
}

fn find_animation<'a>(
    document: &'a Document,
    wanted: Option<&str>,
) -> Result<Animation<'a>, SkeletonError> {
    let animations: Vec<Animation> = document.animations().collect();
    let first = animations.first().ok_or(SkeletonError::NoAnimation)?;
    let Some(wanted) = wanted else {
        return Ok(first.clone());
    };
    let number = wanted.parse::<usize>().ok();
    let named = animations.iter().find(|a| a.name() == Some(wanted));
    let found = named.or_else(|| animations.get(number?));
    found.cloned().ok_or_else(|| {
        let name = |a: &Animation| {
            a.name()
                .map_or_else(|| a.index().to_string(), str::to_owned)
        };
        SkeletonError::Animation {
            wanted: wanted.to_owned(),
            names: nearest(animations.iter().map(name).collect(), wanted),
        }
    })
}

/// Some names, the nearest to `wanted` first.
fn nearest(mut names: Vec<String>, wanted: &str) -> Vec<String> {
    let wanted = wanted.to_lowercase();
    let far = |name: &String| -strsim::jaro_winkler(&name.to_lowercase(), &wanted);
    names.sort_by(|a, b| far(a).total_cmp(&far(b)).then_with(|| a.cmp(b)));
    names.truncate(MOST_NAMES);
    names
}

#[cfg(test)]
mod tests;
