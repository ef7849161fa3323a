//! Spring bones of VRM: what of a character swings, and what it cannot enter.

use std::collections::BTreeSet;

use glam::DVec3;

use super::document::Document;
use crate::rig::{Rig, SpringCollider, Springs};

/// What replaces a ball by a plane, or by a ball that hair stays in.
const EXTENDED: &str = "VRMC_springBone_extended_collider";

/// The spring bones of the file, whose nodes were read. What names no node, or isn't of a size, is told.
pub(super) fn read(document: &Document, rig: &Rig, notes: &mut Vec<String>) -> Springs {
    let is_node = |node: &usize| *node < rig.nodes.len();
    let mut roots = BTreeSet::new();
    let mut joints = BTreeSet::new();
    let mut colliders = Vec::new();
    let (mut broken, mut other, mut missing) = (0, 0, 0);

    if let Some(vrm) = &document.extensions.vrm0 {
        let groups = vrm.secondary_animation.bone_groups.iter();
        let bones = groups.flat_map(|group| &group.bones);
        // Below 0 there is none.
        for node in bones.filter_map(|&bone| usize::try_from(bone).ok()) {
            if is_node(&node) {
                roots.insert(node);
            } else {
                missing += 1;
            }
        }
        for group in &vrm.secondary_animation.collider_groups {
            let node = usize::try_from(group.node).ok().filter(is_node);
            for ball in &group.colliders {
                let place = DVec3::new(ball.offset.x, ball.offset.y, -ball.offset.z);
                match node.and_then(|node| SpringCollider::new(node, [place; 2], ball.radius)) {
                    Some(collider) => colliders.push(collider),
                    None => broken += 1,
                }
            }
        }
    }
    if let Some(own) = &document.extensions.spring_bone {
        let of_springs = own.springs.iter().flat_map(|spring| &spring.joints);
        for joint in of_springs {
            if is_node(&joint.node) {
                joints.insert(joint.node);
            } else {
                missing += 1;
            }
        }
        for own in &own.colliders {
            if own.extensions.contains_key(EXTENDED) {
                other += 1;
                continue;
            }
            let Some(shape) = own.shape.capsule.as_ref().or(own.shape.sphere.as_ref()) else {
                other += 1;
                continue;
            };
            let ends = [shape.offset, shape.tail.unwrap_or(shape.offset)].map(DVec3::from);
            let node = Some(own.node).filter(is_node);
            match node.and_then(|node| SpringCollider::new(node, ends, shape.radius)) {
                Some(collider) => colliders.push(collider),
                None => broken += 1,
            }
        }
    }
    // Of VRM 0.x all nodes below swing.
    for &node in &rig.order {
        let swings = rig.nodes[node]
            .parent
            .is_some_and(|parent| roots.contains(&parent));
        if swings || roots.contains(&node) {
            roots.insert(node);
            joints.insert(node);
        }
    }
    if missing > 0 {
        notes.push(format!(
            "spring bones: {missing} of their joints are no nodes of the file: what hangs on them doesn't swing"
        ));
    }
    if broken > 0 {
        notes.push(format!(
            "spring bones: {broken} colliders are left out, which have no node or no radius"
        ));
    }
    if other > 0 {
        notes.push(format!(
            "spring bones: {other} colliders are left out, which are neither balls nor capsules"
        ));
    }
    Springs {
        joints: joints.into_iter().collect(),
        colliders,
    }
}

#[cfg(test)]
mod tests {
    use super::super::from_bytes;
    use super::*;
    use serde_json::{Value, json};
    use std::path::Path;

    /// The springs of a head (node 1) on a body, from which two nodes hang, and what was told.
    fn springs(extensions: Value) -> (Springs, Vec<String>) {
        let file = json!({"asset": {"version": "2.0"}, "extensions": extensions, "nodes": [
            {"name": "body", "children": [1]}, {"name": "head", "children": [2]}, {"name": "tail", "children": [3]}, {"name": "end"},
        ]});
        let model = from_bytes(file.to_string().as_bytes(), Path::new("")).unwrap();
        (model.rig.unwrap().springs, model.notes)
    }

    const MISSING: &str = "spring bones: 1 of their joints are no nodes of the file: what hangs on them doesn't swing";

    #[test]
    fn vrm_0_swings_with_all_that_is_below() {
        let (springs, notes) = springs(json!({"VRM": {"secondaryAnimation": {
            "boneGroups": [{"bones": [2, -1, 77], "stiffiness": 2.5, "center": -1}],
            "colliderGroups": [
                {"node": 1, "colliders": [{"offset": {"x": 0.1, "y": 0.2, "z": 0.3}, "radius": 0.5}, {"radius": 0}]},
                {"node": 9, "colliders": [{"radius": 1}]},
            ],
        }}}));
        assert_eq!(springs.joints, [2, 3]);
        // z of Unity is the other way round.
        let ball = SpringCollider::new(1, [DVec3::new(0.1, 0.2, -0.3); 2], 0.5);
        assert_eq!(springs.colliders, Vec::from_iter(ball));
        assert_eq!(
            notes,
            [
                MISSING,
                "spring bones: 2 colliders are left out, which have no node or no radius"
            ]
        );
    }

    #[test]
    fn vrm_1_has_chains_and_capsules() {
        let (springs, notes) = springs(json!({"VRMC_springBone": {"specVersion": "1.0",
            "colliders": [
                {"node": 0, "shape": {"capsule": {"offset": [0, 1, 0], "radius": 0.1, "tail": [0, 2, 0]}}},
                {"node": 1, "shape": {"sphere": {"radius": 0.2}}},
                {"node": 1, "shape": {"sphere": {"radius": 0.2}}, "extensions": {"VRMC_springBone_extended_collider": {"shape": {"plane": {}}}}},
                {"node": 1},
            ],
            "springs": [{"joints": [{"node": 2, "stiffness": 1}, {"node": 55}]}],
        }}));
        assert_eq!(springs.joints, [2]);
        let ends = [DVec3::Y, 2.0 * DVec3::Y];
        let expected = [
            SpringCollider::new(0, ends, 0.1),
            SpringCollider::new(1, [DVec3::ZERO; 2], 0.2),
        ];
        assert_eq!(springs.colliders, expected.map(Option::unwrap));
        assert_eq!(
            notes,
            [
                MISSING,
                "spring bones: 2 colliders are left out, which are neither balls nor capsules"
            ]
        );
    }
}
