//! A character's own hair: which triangles of its file are hair, and the strands that they become.

use crate::files::StageError;
use crate::hair::HairModel;
use crate::head::HeadModel;
use crate::names::{Names, meant_name};
use crate::painted::{MeshNames, PaintedMesh, shown};
use crate::preset::HairSection;
use glam::{Vec2, Vec3};
use hair_io::mesh_hair::{Lock, LockStrand, MeshHair, islands, locks};
use hair_io::orient::Orientation;
use hair_io::{HairFile, HeadFrame, Mesh, is_called_hair};
use hair_sim::Strands;
use mesh_io::{Model, Rig};
use render::NO_COLOR;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::OnceLock;

/// What meshes, materials and bones of hair are called.
const HAIR: &str = "hair";
/// The widest strands where the preset says nothing, in 1/300 head heights.
const WIDEST: f32 = 14.0;
/// Links of strands, in head heights.
const LINK: f32 = 0.06;
/// How much of a corner, or of an island, bones of hair must move for it to be hair.
const MOST: f32 = 0.5;
/// A bone of this length in m ends where the next one would begin.
const LONG_BONE_M: f32 = 0.2;
/// Where along a strand its two colours are looked up, in parts of it.
const COLORS_AT: [f32; 2] = [0.15, 0.85];

/// Hair that was found in a character.
pub(crate) struct OwnHair {
    /// For each mesh of the model and each of its triangles, whether it became a strand.
    pub is_hair: Vec<Vec<bool>>,
    /// The same of what hair lies on: shells around the skull, and the rest of pieces that hair was cut off.
    is_cap: Vec<Vec<bool>>,
    locks: Vec<OwnLock>,
    notes: Vec<String>,
}

struct OwnLock {
    /// Which mesh of the model it is of.
    mesh: usize,
    lock: Lock,
}

/// A character's bones, as far as they move hair.
struct Bones {
    /// Of each node the outermost spring bone on the way to the head, where it is a spring bone of hair.
    chains: Vec<Option<u32>>,
    /// The same where it is one whose meshes stay; nothing where no such bone is named.
    kept: Option<Vec<Option<u32>>>,
    /// Of each node how many spring bones are on the way to the head, and where it is at rest; nothing where it is none.
    springs: Vec<Option<(f32, Vec3)>>,
}

/// The spring bones on the way from a node to the head, itself one of them.
#[derive(Clone, Copy, Default)]
struct Way {
    count: u32,
    outermost: Option<u32>,
    /// Whether one is called hair, is named as hair, or as what stays.
    is_called_hair: bool,
    is_wanted: bool,
    is_kept: bool,
}

/// The hair of a model that lies in our space by `orientation`: what the section names, else the meshes and materials that are called hair, else what
/// spring bones on the head move. `hidden` tells of each mesh and each of its triangles whether it is hidden. Nothing where there is none.
///
/// # Errors
///
/// When the section names what isn't in the file.
pub(crate) fn find(
    model: &Model,
    path: &Path,
    orientation: &Orientation,
    section: &HairSection,
    hidden: &[Vec<bool>],
) -> Result<Option<OwnHair>, StageError> {
    let [wanted, kept] =
        [&section.meshes, &section.keep].map(|names| Names(names.as_deref().unwrap_or_default()));
    check(&wanted, model, path)?;
    check(&kept, model, path)?;
    let bones = model
        .rig
        .as_ref()
        .map(|rig| Bones::new(rig, &wanted, &kept));
    let is_named = |mesh: &mesh_io::Mesh| match wanted.is_empty() {
        true => is_called_hair(model, mesh),
        false => MeshNames(wanted).have(model, mesh),
    };
    let is_kept = |mesh: &mesh_io::Mesh| MeshNames(kept).have(model, mesh);
    let by_name = shown(hidden)
        .map(|index| &model.meshes[index])
        .any(|mesh| is_named(mesh) && !is_kept(mesh));
    let mut hair = OwnHair {
        is_hair: model
            .meshes
            .iter()
            .map(|mesh| vec![false; mesh.triangles.len()])
            .collect(),
        is_cap: Vec::new(),
        locks: Vec::new(),
        notes: Vec::new(),
    };
    let mut groups: Vec<Vec<Option<u32>>> = model
        .meshes
        .iter()
        .enumerate()
        .map(|(index, mesh)| match &bones {
            _ if is_kept(mesh) => vec![None; mesh.triangles.len()],
            Some(Bones {
                kept: Some(kept), ..
            }) if is_named(mesh) => {
                let stay = groups(kept, model, index);
                stay.iter()
                    .map(|kept| kept.is_none().then_some(0))
                    .collect()
            }
            _ if is_named(mesh) => vec![Some(0); mesh.triangles.len()],
            // What is named is all that is meant, but for bones that are named too.
            Some(bones) if !by_name || !wanted.is_empty() => groups(&bones.chains, model, index),
            _ => vec![None; mesh.triangles.len()],
        })
        .collect();
    for (groups, hidden) in groups.iter_mut().zip(hidden) {
        for (group, _) in groups.iter_mut().zip(hidden).filter(|(_, hidden)| **hidden) {
            *group = None;
        }
    }
    if groups.iter().flatten().all(Option::is_none) {
        return Ok(None);
    }

    let frame = skull(model, orientation, &groups, hidden);
    let mut shells = 0;
    for (index, (mesh, groups)) in model.meshes.iter().zip(&groups).enumerate() {
        if groups.iter().all(Option::is_none) {
            continue;
        }
        let positions: Vec<Vec3> = mesh
            .positions
            .iter()
            .map(|p| orientation.apply(*p))
            .collect();
        let depths = match &bones {
            Some(bones) => bones.depths_of(model, index),
            None => Vec::new(),
        };
        let found = locks(
            &MeshHair {
                positions: &positions,
                triangles: &mesh.triangles,
                groups,
                depths: &depths,
            },
            frame.center,
            LINK * frame.height,
        );
        shells += found.shells;
        for lock in found.locks {
            for &triangle in &lock.triangles {
                hair.is_hair[index][triangle] = true;
            }
            hair.locks.push(OwnLock { mesh: index, lock });
        }
    }
    let caps = (model.meshes.iter().zip(&groups)).zip(hair.is_hair.iter().zip(hidden));
    hair.is_cap = caps
        .map(|((mesh, groups), (is_hair, hidden))| {
            let cap = cap_of(mesh, groups, is_hair).into_iter().zip(hidden);
            cap.map(|(is_cap, hidden)| is_cap && !hidden).collect()
        })
        .collect();
    if shells > 0 {
        hair.notes
            .push(format!("hair: {shells} shells around the head stay meshes"));
    }
    Ok((!hair.locks.is_empty()).then_some(hair))
}

/// Which triangles of a mesh hair lies on, by which were taken for hair and which became strands.
fn cap_of(mesh: &mesh_io::Mesh, groups: &[Option<u32>], is_hair: &[bool]) -> Vec<bool> {
    if !is_hair.contains(&true) {
        return groups.iter().map(Option::is_some).collect();
    }
    let islands = islands(&mesh.positions, &mesh.triangles);
    let with_hair: BTreeSet<usize> = (islands.iter().zip(is_hair))
        .filter_map(|(island, is_hair)| is_hair.then_some(*island))
        .collect();
    let triangles = groups.iter().zip(&islands).zip(is_hair);
    triangles
        .map(|((group, island), is_hair)| {
            !is_hair && (group.is_some() || with_hair.contains(island))
        })
        .collect()
}

/// Where the head under the hair is.
fn skull(
    model: &Model,
    orientation: &Orientation,
    groups: &[Vec<Option<u32>>],
    hidden: &[Vec<bool>],
) -> HeadFrame {
    let meshes = model.meshes.iter().zip(groups.iter().zip(hidden));
    let corners = meshes.flat_map(|(mesh, (groups, hidden))| {
        let all = mesh.corners().zip(groups.iter().zip(hidden));
        all.filter(|(_, (group, hidden))| group.is_none() && !**hidden)
            .map(|(corners, _)| corners.map(|p| orientation.apply(p)))
    });
    let shape = Mesh::from_corners(corners);
    match shape.triangles.is_empty() {
        false => HeadFrame::find(Some(&shape), &[]),
        true => {
            let all = model.meshes.iter().flat_map(mesh_io::Mesh::corners);
            let all = Mesh::from_corners(all.map(|t| t.map(|p| orientation.apply(p))));
            HeadFrame::find(Some(&all), &[])
        }
    }
}

impl OwnHair {
    /// Takes the hair's triangles and those that are hidden from meshes that are painted, whole ones of the model; those that hair is of, as they were.
    pub(crate) fn take_away(
        &self,
        hidden: &[Vec<bool>],
        painted: &mut Vec<PaintedMesh>,
    ) -> BTreeMap<usize, PaintedMesh> {
        let mut whole = BTreeMap::new();
        let mut caps = Vec::new();
        for mesh in painted.iter_mut() {
            let index = mesh.index;
            let (is_hair, is_cap) = (&self.is_hair[index], &self.is_cap[index]);
            if is_hair.contains(&true) {
                whole.insert(index, mesh.clone());
            }
            if is_cap.contains(&true) {
                let mut cap = mesh.clone();
                cap.take_away(&is_cap.iter().map(|is_cap| !is_cap).collect::<Vec<_>>());
                cap.is_cap = true;
                caps.push(cap);
            }
            let is_gone = (is_hair.iter().zip(is_cap)).zip(&hidden[index]);
            let is_gone: Vec<bool> = is_gone
                .map(|((hair, cap), hidden)| *hair || *cap || *hidden)
                .collect();
            mesh.take_away(&is_gone);
        }
        painted.append(&mut caps);
        painted.retain(|mesh| !mesh.triangles.is_empty());
        whole
    }

    /// As hair on its head. It has the colours of `painted`, one a mesh of the model that is painted, where there is one.
    pub(crate) fn into_hair(
        self,
        head: &HeadModel,
        section: &HairSection,
        painted: &BTreeMap<usize, PaintedMesh>,
    ) -> Result<HairModel, StageError> {
        let frame = head.frame(&[]);
        let widest = if section.size > 0.0 {
            section.size
        } else {
            WIDEST
        };
        let mut strands = Strands::new();
        let (mut tapers, mut colors, mut held) = (Vec::new(), Vec::new(), Vec::new());
        for OwnLock { mesh, lock } in &self.locks {
            for strand in lock.strands(widest * frame.unit_m()) {
                let (half_width_m, taper) = taper_of(&strand.half_widths);
                let id = strands.len() as u32;
                strands.push(id, &strand.points, Some(half_width_m / frame.unit_m()))?;
                tapers.push(taper);
                let points = strand.points.len() as u32;
                held.push(match (lock.is_tuft(), lock.is_cut_off()) {
                    // A bun whose strands swung by themselves would come apart.
                    (true, _) => points,
                    // It hangs from the rim of what it was cut off. There that would push it this way and that.
                    (false, true) => points.min(2),
                    (false, false) => 1,
                });
                colors.push(match painted.get(mesh) {
                    Some(painted) => colors_of(painted, &lock.triangles, &strand),
                    None => [NO_COLOR; 2],
                });
            }
        }
        let mut notes = vec![format!(
            "hair: {} strands in {} locks of the character's own",
            strands.len(),
            self.locks.len()
        )];
        notes.extend(self.notes);
        Ok(HairModel {
            all_roots: strands.roots().collect(),
            held,
            tapers,
            own_colors: colors,
            infos: Vec::new(),
            undercoat: 0,
            shapes: None,
            bake: None,
            zone_names: Vec::new(),
            zone_cuts: Vec::new(),
            zone_dynamics: Vec::new(),
            zone_colors: Vec::new(),
            ornaments: Vec::new(),
            low_ties: Vec::new(),
            head: frame,
            reach_m: 0.0,
            ranks: OnceLock::new(),
            file: HairFile {
                strands,
                motion: None,
                notes,
            },
        })
    }
}

/// A strand's greatest half width, and the taper that goes on from it as the others do: the root's share, and where it begins to shrink to nothing.
fn taper_of(half_widths: &[f32]) -> (f32, Vec2) {
    let greatest = half_widths.iter().copied().fold(0.0, f32::max);
    let share = |of: f32| if greatest > 0.0 { of / greatest } else { 1.0 };
    let last = half_widths.len().saturating_sub(1).max(1) as f32;
    let off = |start: f32| {
        let shape = |u: f32| {
            if u < start || start >= 1.0 {
                1.0
            } else {
                (1.0 - u) / (1.0 - start)
            }
        };
        let each = half_widths.iter().enumerate();
        // What is narrow at the root is the root's taper.
        let peak = half_widths
            .iter()
            .position(|own| *own == greatest)
            .unwrap_or(0);
        each.skip(peak)
            .map(|(i, own)| (shape(i as f32 / last) - share(*own)).powi(2))
            .sum::<f32>()
    };
    let starts = (0..=20).map(|step| 0.05 * step as f32);
    let start = starts
        .min_by(|a, b| off(*a).total_cmp(&off(*b)))
        .unwrap_or(1.0);
    let root = half_widths.first().map_or(1.0, |root| share(*root));
    (greatest, Vec2::new(root, start))
}

/// The colours of a mesh where a strand's root and tip are nearest to these triangles of it.
fn colors_of(painted: &PaintedMesh, triangles: &[usize], strand: &LockStrand) -> [Vec3; 2] {
    COLORS_AT.map(|share| {
        let last = strand.points.len() - 1;
        let place = strand.points[(share * last as f32).round() as usize];
        let distance = |triangle: &usize| {
            let (near, _) = nearest_on(painted, *triangle, place);
            near.distance_squared(place)
        };
        let nearest = triangles
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let Some((&nearest, color)) = nearest.zip(painted.paint.color) else {
            return NO_COLOR;
        };
        let (_, weights) = nearest_on(painted, nearest, place);
        let texel = painted.paint.picture.as_ref().map_or([1.0; 4], |picture| {
            let corners = painted.triangles[nearest].map(|i| painted.places[i as usize]);
            let at = corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z;
            picture.image.at(at.to_array(), 0.0, picture.repeats)
        });
        Vec3::from(color) * Vec3::new(texel[0], texel[1], texel[2])
    })
}

/// The place of a triangle that is nearest to another, and its weights of the corners (Ericson, "Real-Time Collision Detection", 2005, 5.1.5).
fn nearest_on(mesh: &PaintedMesh, triangle: usize, place: Vec3) -> (Vec3, Vec3) {
    let [a, b, c] = mesh.triangles[triangle].map(|i| mesh.positions[i as usize]);
    let edge = |from: Vec3, to: Vec3| {
        let way = to - from;
        ((place - from).dot(way) / way.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0)
    };
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let squared = normal.length_squared().max(f32::MIN_POSITIVE);
    let inner = Vec3::new(
        (c - b).cross(place - b).dot(normal),
        (a - c).cross(place - c).dot(normal),
        (b - a).cross(place - a).dot(normal),
    ) / squared;
    let weights = if inner.min_element() >= 0.0 {
        inner
    } else {
        let (s, t, r) = (edge(a, b), edge(b, c), edge(c, a));
        let sides = [
            Vec3::new(1.0 - s, s, 0.0),
            Vec3::new(0.0, 1.0 - t, t),
            Vec3::new(r, 0.0, 1.0 - r),
        ];
        let away = |w: &Vec3| (a * w.x + b * w.y + c * w.z).distance_squared(place);
        sides
            .into_iter()
            .min_by(|a, b| away(a).total_cmp(&away(b)))
            .unwrap_or(Vec3::X)
    };
    (a * weights.x + b * weights.y + c * weights.z, weights)
}

fn says_hair(name: &str) -> bool {
    name.to_ascii_lowercase().contains(HAIR)
}

/// The name that is called hair, of a mesh or its material, of the first one in a head's shape: what isn't in `no_shape`, which tells of each triangle.
pub(crate) fn in_shape<'m>(model: &'m Model, no_shape: &[Vec<bool>]) -> Option<&'m str> {
    let names = |index: usize| crate::painted::names_of(model, &model.meshes[index]);
    shown(no_shape).flat_map(names).find(|name| says_hair(name))
}

/// The names of the spring bones of a model.
fn bone_names(model: &Model) -> impl Iterator<Item = &str> {
    let rig = model.rig.iter();
    rig.flat_map(|rig| {
        let joints = rig.springs.joints.iter();
        joints.filter_map(|joint| rig.nodes[*joint].name.as_deref())
    })
}

/// That each name is one of a mesh, a material or a spring bone.
fn check(names: &Names, model: &Model, path: &Path) -> Result<(), StageError> {
    let all = || {
        let meshes = model.meshes.iter();
        let meshes = meshes.flat_map(|mesh| crate::painted::names_of(model, mesh));
        meshes.chain(bone_names(model))
    };
    match names.unknown(all) {
        None => Ok(()),
        Some(name) => Err(StageError::NoMeshOrBone {
            path: path.to_owned(),
            hint: meant_name(name, all()),
            name: name.to_owned(),
        }),
    }
}

impl Bones {
    fn new(rig: &Rig, wanted: &Names, kept: &Names) -> Self {
        let count = rig.nodes.len();
        let mut is_spring = vec![false; count];
        for &joint in &rig.springs.joints {
            is_spring[joint] = true;
        }
        let head = rig.node("head");
        // Of each node; nothing where it isn't on the head.
        let mut ways: Vec<Option<Way>> = vec![None; count];
        for &node in rig.parents_first() {
            let Some(parent) = rig.nodes[node].parent else {
                continue;
            };
            let up = match head == Some(parent) {
                true => Some(Way::default()),
                false => ways[parent],
            };
            let name = rig.nodes[node].name.as_deref().unwrap_or_default();
            ways[node] = up.map(|up| match is_spring[node] {
                true => Way {
                    count: up.count + 1,
                    outermost: up.outermost.or(Some(node as u32)),
                    is_called_hair: up.is_called_hair || says_hair(name),
                    is_wanted: up.is_wanted || wanted.have(name),
                    is_kept: up.is_kept || kept.have(name),
                },
                false => up,
            });
        }
        let springs = || {
            let joints = rig.springs.joints.iter();
            joints.filter_map(|&joint| Some((joint, ways[joint]?)))
        };
        let any_called_hair = springs().any(|(_, way)| way.is_called_hair && !way.is_kept);
        let is_hair = |way: &Way| match wanted.is_empty() {
            true => !any_called_hair || way.is_called_hair,
            false => way.is_wanted,
        };
        let chains_of = |is_meant: &dyn Fn(&Way) -> bool| {
            let mut chains = vec![None; count];
            for (joint, way) in springs().filter(|(_, way)| is_meant(way)) {
                chains[joint] = way.outermost;
            }
            chains
        };
        let world = rig.world(&rig.rest());
        let mut places = vec![None; count];
        for (joint, way) in springs() {
            places[joint] = Some((way.count as f32, world[joint].translation.as_vec3()));
        }
        Self {
            chains: chains_of(&|way| is_hair(way) && !way.is_kept),
            kept: springs()
                .any(|(_, way)| way.is_kept)
                .then(|| chains_of(&|way| way.is_kept)),
            springs: places,
        }
    }

    /// How deep in the skeleton each vertex of a mesh hangs: by its bones, and how far it is from them.
    fn depths_of(&self, model: &Model, mesh: usize) -> Vec<f32> {
        let vertices = 0..model.meshes[mesh].positions.len();
        let depth = |vertex| {
            let own = model.influences(mesh, vertex);
            let place = model.meshes[mesh].positions[vertex];
            let depth = |(node, weight): (usize, f32)| {
                let (bones, joint) = self.springs[node]?;
                Some(weight * (bones + (joint.distance(place) / LONG_BONE_M).min(1.0)))
            };
            own.filter_map(depth).sum()
        };
        vertices.map(depth).collect()
    }
}

/// The chain that moves each triangle of a mesh: all of an island that chains move for the most part; else the triangles that one moves for the
/// most part, and those beside them as far as it moves their corners. A vertex that was painted by mistake moves none for the most part.
pub(crate) fn groups(chains: &[Option<u32>], model: &Model, index: usize) -> Vec<Option<u32>> {
    let mesh = &model.meshes[index];
    let vertices = 0..mesh.positions.len();
    let corners: Vec<BTreeMap<u32, f32>> = vertices
        .map(|vertex| {
            let mut weights = BTreeMap::new();
            for (node, weight) in model.influences(index, vertex) {
                if let Some(chain) = chains[node] {
                    *weights.entry(chain).or_insert(0.0) += weight;
                }
            }
            weights
        })
        .collect();
    // Of each triangle the weights of its corners, and whether one is moved by them.
    let weights = |triangle: &[u32; 3]| {
        let mut sum: BTreeMap<u32, f32> = BTreeMap::new();
        for (chain, weight) in triangle.iter().flat_map(|i| &corners[*i as usize]) {
            *sum.entry(*chain).or_default() += weight / 3.0;
        }
        sum
    };
    let most = |sum: &BTreeMap<u32, f32>| {
        let most = sum
            .iter()
            .max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(a.0)));
        most.map(|(chain, _)| *chain)
    };
    let islands = islands(&mesh.positions, &mesh.triangles);
    let mut of_islands: BTreeMap<usize, (f32, BTreeMap<u32, f32>)> = BTreeMap::new();
    for (triangle, island) in mesh.triangles.iter().zip(&islands) {
        let (count, sum) = of_islands.entry(*island).or_default();
        *count += 1.0;
        for (chain, weight) in weights(triangle) {
            *sum.entry(chain).or_default() += weight;
        }
    }
    let place = |corner: u32| mesh.positions[corner as usize].to_array().map(f32::to_bits);
    let moved = |corner: u32, chain: u32| corners[corner as usize].get(&chain) >= Some(&MOST);
    let mut moved_places = BTreeSet::new();
    for triangle in &mesh.triangles {
        let sum = weights(triangle);
        if let Some(chain) = most(&sum).filter(|chain| sum[chain] >= MOST) {
            let own = triangle.iter().filter(|corner| moved(**corner, chain));
            moved_places.extend(own.map(|corner| (chain, place(*corner))));
        }
    }
    let group = |(triangle, island): (&[u32; 3], &usize)| {
        let (count, sum) = &of_islands[island];
        if sum.values().sum::<f32>() > MOST * count {
            return most(sum);
        }
        let chain = most(&weights(triangle))?;
        let is_beside =
            |corner: &u32| moved(*corner, chain) && moved_places.contains(&(chain, place(*corner)));
        triangle.iter().any(is_beside).then_some(chain)
    };
    mesh.triangles.iter().zip(&islands).map(group).collect()
}
