//! Which nodes are a humanoid's bones, where the file does not say: by the names that Mixamo, Unreal and Rigify give them, or VRM.

use std::collections::BTreeMap;

use crate::rig::Node;

/// Bones as VRM names them, and their other names; of one side those of the left, with `left` or `l` where the side is told.
const BONES: [(&str, &[&str]); 14] = [
    ("hips", &["pelvis"]),
    ("spine", &["spine01"]),
    ("chest", &["spine1", "spine02"]),
    ("upperChest", &["spine2", "spine03"]),
    ("neck", &["neck01"]),
    ("head", &[]),
    ("leftShoulder", &["shoulderl", "claviclel"]),
    ("leftUpperArm", &["leftarm", "upperarml"]),
    ("leftLowerArm", &["leftforearm", "lowerarml", "forearml"]),
    ("leftHand", &["handl"]),
    ("leftUpperLeg", &["leftupleg", "thighl"]),
    ("leftLowerLeg", &["leftleg", "calfl", "shinl"]),
    ("leftFoot", &["footl"]),
    ("leftToes", &["lefttoebase", "balll", "toel"]),
];
/// Bones of which each must be there below the one before it, on both sides, or the names are of something else.
const CHAINS: [[&str; 3]; 2] = [
    ["leftUpperArm", "leftLowerArm", "leftHand"],
    ["leftUpperLeg", "leftLowerLeg", "leftFoot"],
];

/// A humanoid's bones by the names of nodes; none where these are not a humanoid's.
pub(super) fn by_name(nodes: &[Node]) -> BTreeMap<String, usize> {
    let mut found = BTreeMap::new();
    for (number, node) in nodes.iter().enumerate() {
        let own = plain(node.name.as_deref().unwrap_or_default());
        let bone = BONES.iter().find_map(|(bone, others)| {
            let is_it = |name: &str| own == name;
            let is_left = is_it(&bone.to_lowercase()) || others.iter().any(|name| is_it(name));
            let is_right = bone.starts_with("left")
                && (is_it(&right(&bone.to_lowercase()))
                    || others.iter().any(|name| is_it(&right(name))));
            match (is_left, is_right) {
                (true, _) => Some((*bone).to_owned()),
                (_, true) => Some(right(bone)),
                _ => None,
            }
        });
        if let Some(bone) = bone {
            // Of two of one name the first is nearer to the root.
            found.entry(bone).or_insert(number);
        }
    }
    let is_below = |mut node: usize, above: usize| {
        // No more steps than there are nodes.
        for _ in 0..nodes.len() {
            match nodes[node].parent {
                Some(parent) if parent == above => return true,
                Some(parent) => node = parent,
                None => return false,
            }
        }
        false
    };
    let chains = CHAINS
        .iter()
        .flat_map(|chain| [chain.map(str::to_owned), chain.map(right)]);
    let is_humanoid = chains.into_iter().all(|chain| {
        let own = chain.each_ref().map(|bone| found.get(bone).copied());
        own.windows(2).all(|pair| match pair {
            [Some(above), Some(below)] => is_below(*below, *above),
            _ => false,
        })
    });
    if is_humanoid { found } else { BTreeMap::new() }
}

/// A name's letters and digits, small, without what is before a colon or `DEF-`.
fn plain(name: &str) -> String {
    let own = name.rsplit(':').next().unwrap_or_default();
    let own = own.strip_prefix("DEF-").unwrap_or(own);
    let own = own.chars().filter(|c| c.is_ascii_alphanumeric());
    own.map(|c| c.to_ascii_lowercase()).collect()
}

/// The other side's name.
fn right(name: &str) -> String {
    match (name.strip_prefix("left"), name.strip_suffix('l')) {
        (Some(rest), _) => format!("right{rest}"),
        (None, Some(rest)) => format!("{rest}r"),
        (None, None) => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Transform;

    /// Nodes in one chain for each list, below the first.
    fn nodes(chains: &[&[&str]]) -> Vec<Node> {
        let node = |name: &str, parent: Option<usize>| Node {
            name: Some(name.to_owned()),
            parent,
            rest: Transform::IDENTITY,
            weights: Vec::new(),
        };
        let mut nodes = vec![node("root", None)];
        for chain in chains {
            let mut parent = 0;
            for name in *chain {
                nodes.push(node(name, Some(parent)));
                parent = nodes.len() - 1;
            }
        }
        nodes
    }

    #[test]
    fn usual_names_are_known_and_others_are_not() {
        let mixamo = nodes(&[
            &[
                "mixamorig:Hips",
                "mixamorig:Spine",
                "mixamorig:Spine1",
                "mixamorig:Head",
            ],
            &[
                "mixamorig:LeftArm",
                "mixamorig:LeftForeArm",
                "mixamorig:LeftHand",
            ],
            &[
                "mixamorig:RightArm",
                "mixamorig:RightForeArm",
                "mixamorig:RightHand",
            ],
            &[
                "mixamorig:LeftUpLeg",
                "mixamorig:LeftLeg",
                "mixamorig:LeftFoot",
            ],
            &[
                "mixamorig:RightUpLeg",
                "mixamorig:RightLeg",
                "mixamorig:RightFoot",
            ],
        ]);
        let found = by_name(&mixamo);
        let of = |bone: &str| mixamo[found[bone]].name.clone().unwrap();
        assert_eq!(of("head"), "mixamorig:Head");
        assert_eq!(of("chest"), "mixamorig:Spine1");
        assert_eq!(of("leftLowerArm"), "mixamorig:LeftForeArm");
        assert_eq!(of("rightUpperLeg"), "mixamorig:RightUpLeg");
        assert_eq!(found.len(), 16);

        let [left, right] = ["L", "R"].map(|side| {
            ["upper_arm", "forearm", "hand", "thigh", "shin", "foot"]
                .map(|name| format!("DEF-{name}.{side}"))
        });
        let names = |own: &[String]| {
            own.iter()
                .map(|n| n.as_str().to_owned())
                .collect::<Vec<_>>()
        };
        let lists = [&left[..3], &left[3..], &right[..3], &right[3..]].map(names);
        let lists: Vec<Vec<&str>> = (lists.iter())
            .map(|list| list.iter().map(String::as_str).collect())
            .collect();
        let lists: Vec<&[&str]> = lists.iter().map(Vec::as_slice).collect();
        let rigify = nodes(&lists);
        let found = by_name(&rigify);
        assert_eq!(
            rigify[found["rightLowerLeg"]].name.as_deref(),
            Some("DEF-shin.R")
        );
        // One arm is no humanoid's, nor are bones beside each other.
        assert!(by_name(&nodes(&lists[..3])).is_empty());
        let flat: Vec<&[&str]> = lists.iter().flat_map(|list| list.chunks(1)).collect();
        assert!(by_name(&nodes(&flat)).is_empty());
    }
}
