//! Limbs as bodies: capsules along a humanoid's bones, as thick as the skin around them.

use super::Body;
use glam::DVec3;
use hair_io::orient::Orientation;
use mesh_io::{Model, Rig};

/// The bones of limbs, and where their lines begin and end: at the joints of bones, or else where the skin ends. `left` stands for both sides.
const LIMBS: [(&str, &str, Option<&str>); 7] = [
    ("hips", "leftUpperLeg", Some("rightUpperLeg")),
    ("leftUpperArm", "leftUpperArm", Some("leftLowerArm")),
    ("leftLowerArm", "leftLowerArm", Some("leftHand")),
    ("leftHand", "leftHand", None),
    ("leftUpperLeg", "leftUpperLeg", Some("leftLowerLeg")),
    ("leftLowerLeg", "leftLowerLeg", Some("leftFoot")),
    ("leftFoot", "leftFoot", None),
];
/// Bones whose skin is no limb's.
const TORSO: [&str; 7] = [
    "spine",
    "chest",
    "upperChest",
    "neck",
    "head",
    "leftShoulder",
    "rightShoulder",
];
/// How much of a vertex a limb must move for it to be the limb's.
const MOST: f32 = 0.5;
/// The share of a limb's vertices that are no farther from its line than its radius: cuffs, folds, and what is bound to it by mistake stick out.
const WITHIN: f64 = 0.75;
/// Nothing is measured on fewer vertices.
const FEWEST: usize = 8;

/// The limbs of a skeleton.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Limbs {
    /// Of each node the limb that it is of.
    pub of_nodes: Vec<Option<usize>>,
    /// Of each limb its body, where it could be measured.
    pub bodies: Vec<Option<Body>>,
}

/// A limb of one side: its bone, and where its line begins and ends.
fn limbs() -> impl Iterator<Item = [Option<String>; 3]> {
    let sides = LIMBS.iter().flat_map(|(bone, from, to)| {
        let right = |name: &str| name.replacen("left", "right", 1);
        let left = [Some(*bone), Some(*from), *to].map(|name| name.map(str::to_owned));
        let other = bone
            .starts_with("left")
            .then(|| left.each_ref().map(|name| name.as_deref().map(right)));
        [Some(left), other]
    });
    sides.flatten()
}

impl Limbs {
    /// The limbs of a model that lies in our space by `orientation`, measured on triangles that are left: `is_gone` tells of each mesh and each of its triangles whether
    /// it isn't.
    pub fn new(model: &Model, rig: &Rig, orientation: &Orientation, is_gone: &[Vec<bool>]) -> Self {
        let bones: Vec<_> = limbs().collect();
        let node = |name: &Option<String>| rig.humanoid.get(name.as_deref()?).copied();
        let mut own = vec![None; rig.nodes.len()];
        for (limb, [bone, ..]) in bones.iter().enumerate() {
            if let Some(node) = node(bone) {
                own[node] = Some(Some(limb));
            }
        }
        for node in TORSO.iter().filter_map(|bone| rig.humanoid.get(*bone)) {
            own[*node] = Some(None);
        }
        // What swings is no skin.
        for joint in &rig.springs.joints {
            own[*joint] = Some(None);
        }
        let mut of_nodes = vec![None; rig.nodes.len()];
        for &node in rig.parents_first() {
            let above = || rig.nodes[node].parent.and_then(|parent| of_nodes[parent]);
            of_nodes[node] = own[node].unwrap_or_else(above);
        }

        let mut limbs = Self {
            of_nodes,
            bodies: vec![None; bones.len()],
        };
        let mut skin = vec![Vec::new(); bones.len()];
        for (index, mesh) in model.meshes.iter().enumerate() {
            let mut is_used = vec![false; mesh.positions.len()];
            let triangles = mesh.triangles.iter().zip(&is_gone[index]);
            for corner in triangles.filter(|(_, gone)| !**gone).flat_map(|(t, _)| t) {
                is_used[*corner as usize] = true;
            }
            for vertex in (0..is_used.len()).filter(|vertex| is_used[*vertex]) {
                if let Some(limb) = limbs.of_vertex(model, index, vertex) {
                    let place = orientation.apply(mesh.positions[vertex]).as_dvec3();
                    skin[limb].extend(place.is_finite().then_some(place));
                }
            }
        }
        let world = rig.world(&rig.rest());
        let joint = |name: &Option<String>| {
            let place = world[node(name)?].translation.as_vec3();
            Some(orientation.apply(place).as_dvec3())
        };
        for (limb, [bone, from, to]) in bones.iter().enumerate() {
            let measured = node(bone).and_then(|node| {
                let from = joint(from)?;
                let to = match to {
                    Some(_) => joint(to)?,
                    None => end(from, &skin[limb])?,
                };
                Some(Body {
                    node,
                    ends: [from, to],
                    radius: radius([from, to], &skin[limb])?,
                })
            });
            limbs.bodies[limb] = measured.filter(Body::is_whole);
        }
        limbs
    }

    /// The limb that moves most of a vertex.
    pub fn of_vertex(&self, model: &Model, mesh: usize, vertex: usize) -> Option<usize> {
        let mut moved = vec![0.0; self.bodies.len()];
        for (node, weight) in model.influences(mesh, vertex) {
            if let Some(limb) = self.of_nodes[node] {
                moved[limb] += weight;
            }
        }
        moved.iter().position(|weight| *weight > MOST)
    }
}

/// Where a limb ends that begins at `from`: as far away, towards the middle of its skin, as [`WITHIN`] of that is.
fn end(from: DVec3, skin: &[DVec3]) -> Option<DVec3> {
    let middle = skin.iter().sum::<DVec3>() / skin.len().max(1) as f64;
    let way = (middle - from).try_normalize()?;
    let along = quantile(skin.iter().map(|place| (*place - from).dot(way)))?;
    Some(from + way * along.max(0.0))
}

/// How far [`WITHIN`] of the skin beside a line is from it, in m at most.
fn radius([from, to]: [DVec3; 2], skin: &[DVec3]) -> Option<f64> {
    let way = to - from;
    let along = |place: &DVec3| (*place - from).dot(way) / way.length_squared();
    let beside = skin
        .iter()
        .filter(|place| (0.0..=1.0).contains(&along(place)));
    let distances = beside.map(|place| place.distance(from + way * along(place)));
    quantile(distances).filter(|radius| *radius > 0.0)
}

/// What [`WITHIN`] of the numbers are no greater than; nothing of fewer than [`FEWEST`].
fn quantile(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    let index = (WITHIN * numbers.len() as f64).ceil() as usize;
    (numbers.len() >= FEWEST).then(|| numbers[index - 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cuff_and_a_stray_vertex_make_no_arm_thick() {
        let ring = |x: f64, radius: f64| {
            (0..8).map(move |i| {
                let (sine, cosine) = (f64::from(i) * std::f64::consts::FRAC_PI_4).sin_cos();
                DVec3::new(x, radius * sine, radius * cosine)
            })
        };
        let line = [DVec3::ZERO, DVec3::X];
        let mut skin: Vec<DVec3> = (1..8)
            .flat_map(|i| ring(0.125 * f64::from(i), 0.04))
            .collect();
        let plain = radius(line, &skin).unwrap();
        assert!((plain - 0.04).abs() < 1e-12);
        skin.extend(ring(0.9, 0.09));
        skin.push(DVec3::new(0.5, 7.0, 0.0));
        // What lies beyond its ends is another's.
        skin.extend(ring(1.5, 0.2));
        assert_eq!(radius(line, &skin), Some(plain));
        let end = end(DVec3::ZERO, &skin[..56]).unwrap();
        assert!(
            (end.x - 0.75).abs() < 1e-12 && end.y.abs() + end.z.abs() < 1e-12,
            "{end}"
        );
        assert_eq!(radius(line, &skin[..7]), None);
        assert_eq!(radius([DVec3::ZERO; 2], &skin), None);
    }

    /// Of Godette, whose file has colliders on chest and head alone.
    #[test]
    #[allow(clippy::print_stderr, reason = "skipped tests say so")]
    fn godettes_limbs_are_as_thick_as_her_skin() {
        let Some(data) = std::env::var_os("INKSTRAND_DATA") else {
            return eprintln!("SKIPPED 1 test: INKSTRAND_DATA is not set");
        };
        let path = std::path::Path::new(&data).join("vrm/Godette_vrm_v4.vrm");
        let file = hair_io::read_head(&path, None, None).unwrap();
        let (model, rig) = (&file.model, file.model.rig.as_ref().unwrap());
        let none: Vec<_> = (model.meshes.iter())
            .map(|mesh| vec![false; mesh.triangles.len()])
            .collect();
        let found = Limbs::new(model, rig, &file.orientation, &none);
        let body = |wanted: &str| {
            let mut all = limbs().zip(&found.bodies);
            let (_, body) = all
                .find(|([bone, ..], _)| bone.as_deref() == Some(wanted))
                .unwrap();
            body.unwrap_or_else(|| panic!("{wanted} has no body"))
        };
        // Half of what her sleeves, arms, gloves, shorts and boots measure, m.
        for (bone, [least, most]) in [
            ("UpperArm", [0.03, 0.07]),
            ("LowerArm", [0.025, 0.045]),
            ("Hand", [0.02, 0.06]),
            ("UpperLeg", [0.05, 0.13]),
            ("LowerLeg", [0.04, 0.09]),
            ("Foot", [0.03, 0.09]),
        ] {
            let [left, right] = ["left", "right"].map(|side| body(&format!("{side}{bone}")));
            assert!((least..most).contains(&left.radius), "{bone}: {left:?}");
            assert!(
                (left.radius - right.radius).abs() < 2e-3,
                "{bone}: {left:?} {right:?}"
            );
            // Her left is to +X.
            assert!(
                left.ends[1].x > 0.0 && right.ends[1].x < 0.0,
                "{left:?} {right:?}"
            );
        }
        assert!(
            (0.08..0.25).contains(&body("hips").radius),
            "{:?}",
            body("hips")
        );
    }
}
