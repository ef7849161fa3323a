//! Nodes, skins and animations of a glTF file.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DAffine3, DMat4, DQuat, DVec3};

use super::document::{self, Animation, Document, Sampler};
use super::error::{GltfError, PartError};
use super::numbers::{Buffers, part};
use crate::read::shown;
use crate::rig::{self, NodeTracks, Rig, Skin, Transform};
use crate::track::{Track, Value};

/// All nodes, skins and animations; meshes are read later.
pub(super) fn read(document: &Document, buffers: &mut Buffers) -> Result<Rig, GltfError> {
    let parents = parents(document)?;
    let order = order(document, &parents)?;
    let mut nodes = Vec::with_capacity(document.nodes.len());
    for (number, (node, parent)) in document.nodes.iter().zip(parents).enumerate() {
        let rest = rest_of(node);
        if !(rest.translation.is_finite() && rest.scale.is_finite()) {
            return Err(GltfError::Place(number));
        }
        let in_node = |source| GltfError::Part {
            of: "node",
            index: number,
            source,
        };
        let mesh = node
            .mesh
            .map(|mesh| part(&document.meshes, "mesh", mesh))
            .transpose()
            .map_err(in_node)?;
        node.skin
            .map(|skin| part(&document.skins, "skin", skin))
            .transpose()
            .map_err(in_node)?;
        let weights = match (&node.weights[..], mesh) {
            ([], Some(mesh)) => &mesh.weights[..],
            (own, _) => own,
        };
        let finite = |weight: &f32| {
            if weight.is_finite() {
                f64::from(*weight)
            } else {
                0.0
            }
        };
        nodes.push(rig::Node {
            name: node.name.clone(),
            parent,
            rest,
            weights: weights.iter().map(finite).collect(),
        });
    }

    let mut rig = Rig {
        nodes,
        order,
        root: turn(document),
        ..Rig::default()
    };
    rig.humanoid = match (&document.extensions.vrm0, &document.extensions.vrm1) {
        (None, None) => super::humanoid::by_name(&rig.nodes),
        _ => humanoid(document),
    };
    for (number, skin) in document.skins.iter().enumerate() {
        let skin = read_skin(document, skin, buffers);
        rig.skins.push(skin.map_err(|source| GltfError::Part {
            of: "skin",
            index: number,
            source,
        })?);
    }
    for (number, animation) in document.animations.iter().enumerate() {
        let mut tracks = BTreeMap::<usize, NodeTracks>::new();
        let mut length = 0.0f64;
        for channel in 0..animation.channels.len() {
            let wrong = |source| GltfError::Track {
                animation: number,
                channel,
                source,
            };
            let target = target(document, animation, channel).map_err(wrong)?;
            let Some((node, property, sampler)) = target else {
                continue;
            };
            let mesh = document.nodes[node]
                .mesh
                .and_then(|mesh| document.meshes.get(mesh));
            let morphs = mesh
                .and_then(|mesh| mesh.primitives.first())
                .map_or(0, |own| own.targets.len());
            let own = tracks.entry(node).or_default();
            let until = read_track(own, property, sampler, Some(morphs), buffers).map_err(wrong)?;
            length = length.max(until);
        }
        let name = animation.name.clone();
        rig.animations.push(rig::Animation {
            name,
            length,
            tracks,
        });
    }
    Ok(rig)
}

/// Where a node is where nothing moves it. What has no size has no turn either.
pub(super) fn rest_of(node: &document::Node) -> Transform {
    if let Some(matrix) = node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        let (scale, rotation, translation) = parts_of(matrix);
        let is_whole = scale.is_finite() && rotation.is_finite() && rotation.length_squared() > 0.0;
        return Transform {
            translation,
            rotation: if is_whole {
                rotation.normalize()
            } else {
                DQuat::IDENTITY
            },
            scale: if is_whole { scale } else { DVec3::ZERO },
        };
    }
    let vector = |values: Option<[f32; 3]>, default| {
        values.map_or(default, |v| DVec3::from(v.map(f64::from)))
    };
    let rotation = node
        .rotation
        .map_or(DQuat::IDENTITY, |r| DQuat::from_array(r.map(f64::from)));
    Transform {
        translation: vector(node.translation, DVec3::ZERO),
        rotation: if rotation.is_finite() {
            rotation.whole()
        } else {
            DQuat::IDENTITY
        },
        scale: vector(node.scale, DVec3::ONE),
    }
}

/// Scale, turn and place of a matrix. What it makes flat along one of its own axes has a turn all the same.
fn parts_of(mut matrix: DMat4) -> (DVec3, DQuat, DVec3) {
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate());
    let flat = axes.map(|axis| axis == DVec3::ZERO);
    let Some(axis) = flat.iter().position(|is_flat| *is_flat) else {
        return matrix.to_scale_rotation_translation();
    };
    let across = axes[(axis + 1) % 3].cross(axes[(axis + 2) % 3]);
    *matrix.col_mut(axis) = across.normalize_or_zero().extend(0.0);
    let (mut scale, rotation, translation) = matrix.to_scale_rotation_translation();
    scale[axis] = 0.0;
    (scale, rotation, translation)
}

/// The parent of each node.
fn parents(document: &Document) -> Result<Vec<Option<usize>>, GltfError> {
    let count = document.nodes.len();
    let mut parents = vec![None; count];
    for (node, parent) in document.nodes.iter().enumerate() {
        for &child in &parent.children {
            let place = parents
                .get_mut(child)
                .ok_or(GltfError::Child { node, child, count })?;
            if place.is_some_and(|other| other != node) {
                return Err(GltfError::Tree(child));
            }
            *place = Some(node);
        }
    }
    Ok(parents)
}

/// Nodes, each after its parent.
fn order(document: &Document, parents: &[Option<usize>]) -> Result<Vec<usize>, GltfError> {
    let mut order: Vec<usize> = (0..parents.len())
        .filter(|node| parents[*node].is_none())
        .collect();
    let mut is_there = vec![false; parents.len()];
    order.iter().for_each(|node| is_there[*node] = true);
    let mut next = 0;
    while next < order.len() {
        for &child in &document.nodes[order[next]].children {
            if !is_there[child] {
                is_there[child] = true;
                order.push(child);
            }
        }
        next += 1;
    }
    // Who isn't below a root goes round.
    match is_there.iter().position(|is_there| !is_there) {
        Some(node) => Err(GltfError::Tree(node)),
        None => Ok(order),
    }
}

/// The nodes of a humanoid's bones, as VRM says them.
fn humanoid(document: &Document) -> BTreeMap<String, usize> {
    let is_there = |(_, node): &(String, usize)| *node < document.nodes.len();
    bones(document).filter(is_there).collect()
}

/// What to tell of a humanoid's bones whose nodes the file hasn't.
pub(super) fn missing_bones(document: &Document) -> impl Iterator<Item = String> {
    let nodes = document.nodes.len();
    bones(document)
        .filter(move |(_, node)| *node >= nodes)
        .map(move |(bone, node)| {
            let bone = shown(&bone);
            format!("humanoid: `{bone}` is node {node}, and the file has {nodes}: the character has no such bone")
        })
}

/// Bones and the numbers that VRM says are those of their nodes.
pub(super) fn bones(document: &Document) -> impl Iterator<Item = (String, usize)> {
    let vrm0 = document
        .extensions
        .vrm0
        .iter()
        .flat_map(|vrm| &vrm.humanoid.human_bones);
    let vrm0 = vrm0.filter_map(|own| Some((own.bone.clone(), usize::try_from(own.node).ok()?)));
    let vrm1 = document
        .extensions
        .vrm1
        .iter()
        .flat_map(|vrm| &vrm.humanoid.human_bones);
    let vrm1 = vrm1.map(|(bone, own)| (bone.clone(), own.node));
    vrm0.chain(vrm1)
}

/// Characters of VRM 0.x face -Z.
pub(super) fn turn(document: &Document) -> DAffine3 {
    match document.extensions.vrm0 {
        Some(_) => DAffine3::from_scale(DVec3::new(-1.0, 1.0, -1.0)),
        None => DAffine3::IDENTITY,
    }
}

fn read_skin(
    document: &Document,
    skin: &document::Skin,
    buffers: &mut Buffers,
) -> Result<Skin, PartError> {
    if skin.joints.is_empty() {
        return Err(PartError::Without("joints"));
    }
    for &joint in &skin.joints {
        part(&document.nodes, "node", joint)?;
    }
    let inverse = match skin.inverse_bind_matrices {
        None => vec![DAffine3::IDENTITY; skin.joints.len()],
        Some(accessor) => {
            let matrices = buffers.numbers::<16>(accessor)?;
            let affine = |m: &[f64; 16]| DAffine3::from_mat4(DMat4::from_cols_array(m));
            matrices.iter().map(affine).collect()
        }
    };
    if inverse.len() < skin.joints.len() {
        return Err(PartError::Matrices {
            joints: skin.joints.len(),
            matrices: inverse.len(),
        });
    }
    Ok(Skin {
        joints: skin.joints.clone(),
        inverse,
    })
}

/// What of a node an animation can move.
#[derive(Clone, Copy)]
pub(super) enum Property {
    Translation,
    Rotation,
    Scale,
    Weights,
}

impl Property {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "translation" => Self::Translation,
            "rotation" => Self::Rotation,
            "scale" => Self::Scale,
            "weights" => Self::Weights,
            _ => return None,
        })
    }
}

/// What to tell of what animations move and stays as it is, as extensions say it of nodes, each once.
pub(super) fn unmoved(document: &Document) -> impl Iterator<Item = String> {
    let channels = document.animations.iter().flat_map(|own| &own.channels);
    let properties = channels.filter_map(|channel| Some(channel.target.node()?.1));
    let unknown: BTreeSet<&str> = properties
        .filter(|name| Property::named(name).is_none())
        .collect();
    unknown.into_iter().map(|name| {
        let name = shown(name);
        format!("an animation moves `{name}` of nodes, which stays as it is")
    })
}

/// What a channel moves: node, property, and how; `None` where it is no node, or nothing of it that is known.
pub(super) fn target<'a>(
    document: &Document,
    animation: &'a Animation,
    channel: usize,
) -> Result<Option<(usize, Property, &'a Sampler)>, PartError> {
    let channel = &animation.channels[channel];
    let of_node = channel.target.node();
    let Some((node, property)) =
        of_node.and_then(|(node, name)| Some((node, Property::named(name)?)))
    else {
        return Ok(None);
    };
    part(&document.nodes, "node", node)?;
    let sampler = part(&animation.samplers, "sampler", channel.sampler)?;
    Ok(Some((node, property, sampler)))
}

/// Reads what moves a property of a node, whose mesh has so many morphs; none where these are not read. When its last key is, in s.
pub(super) fn read_track(
    tracks: &mut NodeTracks,
    property: Property,
    sampler: &Sampler,
    morphs: Option<usize>,
    buffers: &mut Buffers,
) -> Result<f64, PartError> {
    match (property, morphs) {
        (Property::Translation, _) => put(&mut tracks.translation, "translation", || {
            vectors(sampler, buffers)
        }),
        (Property::Rotation, _) => {
            put(&mut tracks.rotation, "rotation", || turns(sampler, buffers))
        }
        (Property::Scale, _) => put(&mut tracks.scale, "scale", || vectors(sampler, buffers)),
        (Property::Weights, None | Some(0)) => Ok(0.0),
        (Property::Weights, Some(morphs)) => {
            if !tracks.weights.is_empty() {
                return Err(PartError::Twice("weights"));
            }
            tracks.weights = weights(sampler, morphs, buffers)?;
            Ok(tracks.weights[0].length())
        }
    }
}

/// Puts a track in its place, where there is none yet. When its last key is, in s.
fn put<T: Value>(
    place: &mut Option<Track<T>>,
    property: &'static str,
    read: impl FnOnce() -> Result<Track<T>, PartError>,
) -> Result<f64, PartError> {
    if place.is_some() {
        return Err(PartError::Twice(property));
    }
    Ok(place.insert(read()?).length())
}

/// When the last key of a sampler is, in s.
pub(super) fn last_key(sampler: &Sampler, buffers: &mut Buffers) -> Result<f64, PartError> {
    Ok(times(sampler, buffers)?.into_iter().fold(0.0, f64::max))
}

fn times(sampler: &Sampler, buffers: &mut Buffers) -> Result<Vec<f64>, PartError> {
    let times = buffers.shares::<1>(sampler.input)?;
    Ok(times.into_iter().map(|[time]| time).collect())
}

fn track<T: Value>(
    sampler: &Sampler,
    times: Vec<f64>,
    values: Vec<T>,
) -> Result<Track<T>, PartError> {
    let wrong = PartError::Keys {
        keys: times.len(),
        values: values.len(),
    };
    Track::new(times, values, sampler.interpolation).ok_or(wrong)
}

fn vectors(sampler: &Sampler, buffers: &mut Buffers) -> Result<Track<DVec3>, PartError> {
    let times = times(sampler, buffers)?;
    let values = buffers.shares::<3>(sampler.output)?;
    track(
        sampler,
        times,
        values.into_iter().map(DVec3::from).collect(),
    )
}

fn turns(sampler: &Sampler, buffers: &mut Buffers) -> Result<Track<DQuat>, PartError> {
    let times = times(sampler, buffers)?;
    let values = buffers.shares::<4>(sampler.output)?;
    track(
        sampler,
        times,
        values.into_iter().map(DQuat::from_array).collect(),
    )
}

/// One track a morph: a key's weights lie one after the other, of cubics all slopes before, all values, all slopes after.
fn weights(
    sampler: &Sampler,
    morphs: usize,
    buffers: &mut Buffers,
) -> Result<Vec<Track<f64>>, PartError> {
    let times = times(sampler, buffers)?;
    let values = buffers.shares::<1>(sampler.output)?;
    let rows = times.len().saturating_mul(sampler.interpolation.values());
    if rows.checked_mul(morphs) != Some(values.len()) {
        return Err(PartError::Keys {
            keys: times.len(),
            values: values.len(),
        });
    }
    let of = |morph: usize| {
        let own = (0..rows)
            .map(|row| values[row * morphs + morph][0])
            .collect();
        track(sampler, times.clone(), own)
    };
    (0..morphs).map(of).collect()
}
