//! The motion of one bone of a character's animation.
//!
//! Only nodes and animations are read: a bone moves as its chain of parents does.

use super::document::{Animation, Document};
use super::error::GltfError;
use super::nodes::{bones, last_key, read_track, rest_of, target, turn};
use super::numbers::Buffers;
use crate::read::shown;
use crate::rig::{NodeTracks, Transform};
use glam::{DAffine3, DQuat, DVec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The most names that a message lists.
const MOST_NAMES: usize = 8;

/// The motion of a bone against its rest.
#[derive(Clone, Debug, PartialEq)]
pub struct BoneMotion {
    /// What the whole file is turned by.
    root: DAffine3,
    /// From the outermost parent to the bone.
    chain: Vec<ChainNode>,
    /// Its turn and its place (m) where nothing moves it.
    rest: (DQuat, DVec3),
    /// In s.
    length: f64,
}

/// A node of the chain: its place in its parent's space, and what moves it.
#[derive(Clone, Debug, PartialEq)]
struct ChainNode {
    rest: Transform,
    tracks: NodeTracks,
}

impl BoneMotion {
    /// Reads the bone named `bone`, by the file or else as VRM has it, of a file's bytes, in the animation of this name or number (0 first), or else in
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
    ) -> Result<Self, GltfError> {
        let (document, binary) = Document::read(bytes)?;
        let chain = chain_to(&document, bone)?;
        let (number, animation) = find_animation(&document, animation)?;
        let joints = chain.iter().map(|&node| ChainNode {
            rest: rest_of(&document.nodes[node]),
            tracks: NodeTracks::default(),
        });
        let mut motion = Self {
            root: turn(&document),
            chain: joints.collect(),
            rest: (DQuat::IDENTITY, DVec3::ZERO),
            length: 0.0,
        };
        let joints: HashMap<usize, usize> = chain.into_iter().zip(0..).collect();
        let mut buffers = Buffers::new(&document, binary, folder);
        for channel in 0..animation.channels.len() {
            let wrong = |source| GltfError::Track {
                animation: number,
                channel,
                source,
            };
            let target = target(&document, animation, channel).map_err(wrong)?;
            let Some((node, property, sampler)) = target else {
                continue;
            };
            // Also of what moves other bones and shapes, whose faults are theirs: all of an animation starts again at once.
            let until = last_key(sampler, &mut buffers).ok();
            let until = until.filter(|until| until.is_finite()).unwrap_or(0.0);
            motion.length = motion.length.max(until);
            let Some(&joint) = joints.get(&node) else {
                continue;
            };
            // Shapes of a face don't move its bones.
            let tracks = &mut motion.chain[joint].tracks;
            read_track(tracks, property, sampler, None, &mut buffers).map_err(wrong)?;
        }
        let (rotation, place) = motion.pose(|joint| joint.rest);
        if !(rotation.is_finite() && place.is_finite()) {
            return Err(GltfError::Chain(shown(bone)));
        }
        motion.rest = (rotation, place);
        Ok(motion)
    }

    /// The files, in `folder` or below, that hold the numbers of a file's animations, each once.
    ///
    /// # Errors
    ///
    /// When the bytes are not glTF.
    pub fn files_of_bytes(bytes: &[u8], folder: &Path) -> Result<Vec<PathBuf>, GltfError> {
        let (document, _) = Document::read(bytes)?;
        Ok(Buffers::files(&document, folder))
    }

    /// When the last key of the animation is, in s.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// How far the bone has turned at `time` (seconds) from its rest, and how far its place has moved (m): in
    /// the world, Y up. Before the first key and after the last it stays.
    #[must_use]
    pub fn at(&self, time: f64) -> (DQuat, DVec3) {
        let (rotation, place) = self.pose(|joint| joint.tracks.at(time, &joint.rest));
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
    fn pose(&self, local: impl Fn(&ChainNode) -> Transform) -> (DQuat, DVec3) {
        let world =
            (self.chain.iter()).fold(self.root, |world, joint| world * local(joint).affine());
        let (_, rotation, place) = world.to_scale_rotation_translation();
        (rotation.normalize(), place)
    }
}

/// The nodes from the outermost parent to the bone of this name.
fn chain_to(document: &Document, bone: &str) -> Result<Vec<usize>, GltfError> {
    let nodes = &document.nodes;
    let named = |is: &dyn Fn(&str) -> bool| {
        (nodes.iter()).position(|node| node.name.as_deref().is_some_and(is))
    };
    let exact = named(&|name| name == bone);
    let as_vrm = || {
        let mut own = bones(document).filter(|(name, node)| name == bone && *node < nodes.len());
        own.next().map(|(_, node)| node)
    };
    let alike = || named(&|name| name.eq_ignore_ascii_case(bone));
    let Some(found) = exact.or_else(as_vrm).or_else(alike) else {
        let names = nodes.iter().filter_map(|node| node.name.clone());
        return Err(GltfError::Bone {
            wanted: shown(bone),
            names: nearest(names.collect(), bone),
        });
    };
    let mut parents = vec![None; nodes.len()];
    for (node, parent) in nodes.iter().enumerate() {
        for &child in &parent.children {
            *parents.get_mut(child).ok_or(GltfError::Child {
                node,
                child,
                count: nodes.len(),
            })? = Some(node);
        }
    }
    let mut chain = vec![found];
    let mut next = parents[found];
    while let Some(parent) = next {
        if chain.len() > nodes.len() {
            return Err(GltfError::Chain(shown(bone)));
        }
        chain.push(parent);
        next = parents[parent];
    }
    chain.reverse();
    Ok(chain)
}

/// The animation of this name or number, or the first, with its number.
fn find_animation<'a>(
    document: &'a Document,
    wanted: Option<&str>,
) -> Result<(usize, &'a Animation), GltfError> {
    let animations = &document.animations;
    let first = animations.first().ok_or(GltfError::NoAnimation)?;
    let Some(wanted) = wanted else {
        return Ok((0, first));
    };
    let named = (animations.iter()).position(|a| a.name.as_deref() == Some(wanted));
    let number = named.or_else(|| wanted.parse().ok());
    let found = number.and_then(|number| Some((number, animations.get(number)?)));
    found.ok_or_else(|| {
        let names = animations.iter().enumerate();
        let names = names.map(|(number, a)| a.name.clone().unwrap_or(number.to_string()));
        GltfError::Animation {
            wanted: wanted.to_owned(),
            names: nearest(names.collect(), wanted),
        }
    })
}

/// Some names, the nearest to `wanted` first.
fn nearest(names: Vec<String>, wanted: &str) -> Vec<String> {
    let wanted = wanted.to_lowercase();
    let likeness = |name: &String| strsim::jaro_winkler(&name.to_lowercase(), &wanted);
    let mut names: Vec<(f64, String)> = names.into_iter().map(|n| (likeness(&n), n)).collect();
    names.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
    (names.iter().take(MOST_NAMES))
        .map(|(_, name)| shown(name))
        .collect()
}

#[cfg(test)]
#[path = "bone_tests.rs"]
mod tests;
