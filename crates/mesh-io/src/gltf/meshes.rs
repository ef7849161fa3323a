//! Meshes of a glTF file: each primitive of triangles, once for each node that it hangs on.

use std::collections::{BTreeMap, HashMap};

use glam::{DVec3, Vec2, Vec3};

use super::document::{Document, Primitive};
use super::error::{GltfError, PartError, in_quotes};
use super::materials::Materials;
use super::numbers::{Buffers, part};
use crate::model::{Attribute, Mesh};
use crate::read::shown;
use crate::rig::{Deform, Influences, Morph, Rig};

/// Primitives in fewer bytes. Files that don't require it have them a second time as they are.
const DRACO: &str = "KHR_draco_mesh_compression";

/// The meshes of the file's scene, and what moves them; meshes still lie in their nodes' spaces.
pub(super) fn read(
    document: &Document,
    rig: &Rig,
    materials: &Materials,
    buffers: &mut Buffers,
    notes: &mut Vec<String>,
) -> Result<(Vec<Mesh>, Vec<Deform>), GltfError> {
    let is_shown = shown_nodes(document, rig)?;
    let (mut meshes, mut deforms) = (Vec::new(), Vec::new());
    let mut left_out = 0;
    for (node, own) in document
        .nodes
        .iter()
        .enumerate()
        .filter(|(node, _)| is_shown[*node])
    {
        // Nodes were checked when the rig was read.
        let Some(number) = own.mesh else { continue };
        let mesh = &document.meshes[number];
        let name = mesh
            .name
            .clone()
            .or_else(|| own.name.clone())
            .unwrap_or_default();
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            let reader = Reader {
                document,
                primitive,
                joints: own.skin.map(|skin| rig.skins[skin].joints.len()),
                morph_names: morph_names([&mesh.extras, &primitive.extras]),
            };
            let read = reader
                .read(materials, buffers)
                .map_err(|source| GltfError::Primitive {
                    mesh: number,
                    name: shown(&name),
                    primitive: index,
                    source,
                })?;
            match read {
                Some(read) => {
                    let place = || {
                        format!(
                            "mesh {number}{}, primitive {index}",
                            in_quotes(&shown(&name))
                        )
                    };
                    if read.free > 0 {
                        notes.push(format!(
                            "{}: {} vertices have no weight, and go with the skin's first joint",
                            place(),
                            read.free
                        ));
                    }
                    notes.extend(read.unread.iter().map(|own| format!("{}: {own}", place())));
                    meshes.push(Mesh {
                        name: name.clone(),
                        ..read.mesh
                    });
                    deforms.push(Deform {
                        node,
                        skin: own.skin,
                        ..read.deform
                    });
                }
                None => left_out += 1,
            }
        }
    }
    if left_out > 0 {
        notes.push(format!(
            "{left_out} primitives of points, lines or no triangle are not drawn"
        ));
    }
    Ok((meshes, deforms))
}

/// The nodes of the file's scene; all of a file without scenes.
fn shown_nodes(document: &Document, rig: &Rig) -> Result<Vec<bool>, GltfError> {
    if document.scenes.is_empty() {
        return Ok(vec![true; document.nodes.len()]);
    }
    let index = document.scene.unwrap_or(0);
    let in_scene = |source| GltfError::Part {
        of: "scene",
        index,
        source,
    };
    let scene = part(&document.scenes, "scene", index).map_err(in_scene)?;
    let mut is_shown = vec![false; document.nodes.len()];
    for &root in &scene.nodes {
        part(&document.nodes, "node", root).map_err(in_scene)?;
        is_shown[root] = true;
    }
    for &node in &rig.order {
        is_shown[node] |= rig.nodes[node]
            .parent
            .is_some_and(|parent| is_shown[parent]);
    }
    Ok(is_shown)
}

/// The names of morphs, where programs put them: beside the mesh or its primitive.
fn morph_names(extras: [&serde_json::Value; 2]) -> Vec<String> {
    let names = extras
        .into_iter()
        .find_map(|extras| extras.get("targetNames")?.as_array());
    let name = |name: &serde_json::Value| name.as_str().unwrap_or_default().to_owned();
    names.into_iter().flatten().map(name).collect()
}

/// A primitive.
struct Read {
    mesh: Mesh,
    deform: Deform,
    /// How many of its vertices no joint moves although it has a skin.
    free: usize,
    /// Attributes that nothing needs and that can't be read, with why.
    unread: Vec<String>,
}

struct Reader<'a> {
    document: &'a Document,
    primitive: &'a Primitive,
    /// How many joints its skin has.
    joints: Option<usize>,
    morph_names: Vec<String>,
}

impl Reader<'_> {
    /// Reads it; `None` where there is no triangle.
    fn read(
        &self,
        materials: &Materials,
        buffers: &mut Buffers,
    ) -> Result<Option<Read>, PartError> {
        let primitive = self.primitive;
        let mode = primitive.mode.unwrap_or(4);
        if !(4..=6).contains(&mode) {
            return Ok(None);
        }
        if let Some(material) = primitive.material {
            part(&self.document.materials, "material", material)?;
        }
        let position = primitive
            .attributes
            .get("POSITION")
            .ok_or(PartError::Without("positions"))?;
        let accessor = part(&self.document.accessors, "accessor", *position)?;
        let is_needed = self.document.requires(DRACO) || accessor.buffer_view.is_none();
        if is_needed && primitive.extensions.contains_key(DRACO) {
            return Err(PartError::Packed(DRACO.to_owned()));
        }
        let positions = vectors(buffers.numbers::<3>(*position)?);
        let count = positions.len();
        if !positions.iter().all(|place| place.is_finite()) {
            return Err(PartError::NotFinite(*position));
        }
        let corners = match primitive.indices {
            Some(accessor) => buffers.indices(accessor)?,
            None => (0..count).collect(),
        };
        if corners.len() < 3 {
            return Ok(None);
        }
        let morphs = self.morphs(count, buffers)?;
        let triangles = triangles(mode, &corners, &positions, &morphs)?;
        if triangles.is_empty() {
            return Ok(None);
        }
        let kept = Kept::of(triangles);

        let material = primitive.material;
        let places = material
            .and_then(|material| materials.places.get(material))
            .copied()
            .unwrap_or_default();
        let set = format!("TEXCOORD_{}", places.set);
        let mut mesh = Mesh {
            positions: kept.pick(&positions),
            triangles: kept.triangles.clone(),
            material,
            ..Mesh::default()
        };
        if let Some(&accessor) = primitive.attributes.get("NORMAL") {
            let normals = vectors(self.list(buffers.numbers::<3>(accessor)?, "NORMAL", count)?);
            mesh.normals = kept.pick(&normals);
        }
        if let Some(&accessor) = primitive.attributes.get(&set) {
            let uvs = self.list(buffers.numbers::<2>(accessor)?, &set, count)?;
            let uv = |uv: &[f64; 2]| places.apply(Vec2::new(uv[0] as f32, uv[1] as f32));
            let finite = |uv: Vec2| if uv.is_finite() { uv } else { Vec2::ZERO };
            mesh.uvs = kept.pick(&uvs).iter().map(uv).map(finite).collect();
        }
        let is_free = |name: &str| {
            !(["POSITION", "NORMAL", "TANGENT", set.as_str()].contains(&name)
                || name.starts_with("JOINTS_")
                || name.starts_with("WEIGHTS_"))
        };
        let mut unread = Vec::new();
        for (name, &accessor) in primitive
            .attributes
            .iter()
            .filter(|(name, _)| is_free(name))
        {
            match self.attribute(name, accessor, count, &kept, buffers) {
                Ok(attribute) => mesh.attributes.push(attribute),
                Err(source) => unread.push(format!("its {} is not read: {source}", shown(name))),
            }
        }
        mesh.mend_normals();

        let (influences, free) = match self.joints {
            Some(joints) => self.influences(joints, count, &kept, buffers)?,
            None => Default::default(),
        };
        let deform = Deform {
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            influences,
            morphs: morphs.into_iter().map(|morph| kept.morph(morph)).collect(),
            ..Deform::default()
        };
        Ok(Some(Read {
            mesh,
            deform,
            free,
            unread,
        }))
    }

    /// A list with an element a vertex.
    fn list<T>(&self, list: Vec<T>, attribute: &str, count: usize) -> Result<Vec<T>, PartError> {
        if list.len() == count {
            return Ok(list);
        }
        Err(PartError::Length {
            attribute: shown(attribute),
            found: list.len(),
            wanted: count,
        })
    }

    /// Numbers of the file's own: `_VELOCITY`, times `velocity_scale` of what the primitive has beside, where it has.
    fn attribute(
        &self,
        name: &str,
        accessor: usize,
        count: usize,
        kept: &Kept,
        buffers: &mut Buffers,
    ) -> Result<Attribute, PartError> {
        let own = name.trim_start_matches('_').to_lowercase();
        let scale = self
            .primitive
            .extras
            .get(format!("{own}_scale"))
            .and_then(|scale| scale.as_f64());
        let scale = scale.filter(|scale| scale.is_finite()).unwrap_or(1.0);
        let width = buffers.width(accessor)?;
        let finite = |value: f64| {
            let value = (value * scale) as f32;
            if value.is_finite() { value } else { 0.0 }
        };
        fn flat<const N: usize>(list: Vec<[f64; N]>) -> Vec<Vec<f64>> {
            list.into_iter().map(|values| values.to_vec()).collect()
        }
        let values = match width {
            1 => flat(buffers.numbers::<1>(accessor)?),
            2 => flat(buffers.numbers::<2>(accessor)?),
            3 => flat(buffers.numbers::<3>(accessor)?),
            _ => flat(buffers.numbers::<4>(accessor)?),
        };
        let values = kept.pick(&self.list(values, name, count)?);
        Ok(Attribute {
            name: own,
            width,
            values: values.into_iter().flatten().map(finite).collect(),
        })
    }

    /// The eight joints that move each vertex most, with weights whose sum is 1, and how many vertices have none.
    fn influences(
        &self,
        joints: usize,
        count: usize,
        kept: &Kept,
        buffers: &mut Buffers,
    ) -> Result<(Vec<Influences>, usize), PartError> {
        let mut all: Vec<Vec<(u16, f32)>> = vec![Vec::new(); count];
        for set in 0.. {
            let names = [format!("JOINTS_{set}"), format!("WEIGHTS_{set}")];
            let [Some(&of_joints), Some(&of_weights)] =
                [&names[0], &names[1]].map(|name| self.primitive.attributes.get(name))
            else {
                break;
            };
            let own = self.list(buffers.whole::<4>(of_joints)?, &names[0], count)?;
            let weights = self.list(buffers.shares::<4>(of_weights)?, &names[1], count)?;
            for (vertex, (own, weights)) in own.into_iter().zip(weights).enumerate() {
                for (joint, weight) in own.into_iter().zip(weights) {
                    // What is moved by nothing may name anything.
                    if weight > 0.0 {
                        let found = u16::try_from(joint).ok().filter(|_| joint < joints);
                        let joint = found.ok_or(PartError::Joint {
                            vertex,
                            joint,
                            count: joints,
                        })?;
                        all[vertex].push((joint, weight as f32));
                    }
                }
            }
        }
        let most = |mut own: Vec<(u16, f32)>| {
            own.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            own.truncate(8);
            let sum: f32 = own.iter().map(|(_, weight)| weight).sum();
            // Without weights a vertex goes with the first joint, as with a skin that has one.
            let mut influences = [(0, 0.0); 8];
            influences[0].1 = 1.0;
            for (to, (joint, weight)) in influences.iter_mut().zip(own) {
                *to = (joint, weight / sum);
            }
            influences
        };
        let all = kept.pick(&all);
        let free = all.iter().filter(|own| own.is_empty()).count();
        Ok((all.into_iter().map(most).collect(), free))
    }

    /// What each morph does to all vertices.
    fn morphs(&self, count: usize, buffers: &mut Buffers) -> Result<Vec<Morph>, PartError> {
        let mut list = |target: &BTreeMap<String, usize>, name: &str| match target.get(name) {
            None => Ok(Vec::new()),
            Some(&accessor) => {
                let list = self.list(
                    buffers.numbers::<3>(accessor)?,
                    &format!("morph's {name}"),
                    count,
                )?;
                Ok(vectors(list))
            }
        };
        let mut morphs = Vec::new();
        for (number, target) in self.primitive.targets.iter().enumerate() {
            morphs.push(Morph {
                name: self
                    .morph_names
                    .get(number)
                    .cloned()
                    .unwrap_or_else(|| number.to_string()),
                positions: list(target, "POSITION")?,
                normals: list(target, "NORMAL")?,
            });
        }
        Ok(morphs)
    }
}

fn vectors(numbers: Vec<[f64; 3]>) -> Vec<Vec3> {
    numbers
        .into_iter()
        .map(|[x, y, z]| Vec3::new(x as f32, y as f32, z as f32))
        .collect()
}

/// The triangles of a list, strip or fan of corners; those that have no area, and that no morph gives one, are left out.
fn triangles(
    mode: u32,
    corners: &[usize],
    positions: &[Vec3],
    morphs: &[Morph],
) -> Result<Vec<[usize; 3]>, PartError> {
    let count = match mode {
        4 => corners.len() / 3,
        _ => corners.len().saturating_sub(2),
    };
    let mut triangles = Vec::new();
    for triangle in 0..count {
        let places = match mode {
            4 => [3 * triangle, 3 * triangle + 1, 3 * triangle + 2],
            // Each other one the other way round.
            5 => [
                triangle,
                triangle + 1 + triangle % 2,
                triangle + 2 - triangle % 2,
            ],
            _ => [triangle + 1, triangle + 2, 0],
        };
        let own = places.map(|place| corners[place]);
        if let Some(&vertex) = own.iter().find(|vertex| **vertex >= positions.len()) {
            return Err(PartError::Vertex {
                triangle,
                vertex,
                count: positions.len(),
            });
        }
        let has_area = |moves: &[Vec3]| {
            let by = |vertex: usize| moves.get(vertex).map_or(DVec3::ZERO, |by| by.as_dvec3());
            let [a, b, c] = own.map(|vertex| positions[vertex].as_dvec3() + by(vertex));
            (b - a).cross(c - a) != DVec3::ZERO
        };
        if has_area(&[]) || morphs.iter().any(|morph| has_area(&morph.positions)) {
            triangles.push(own);
        }
    }
    Ok(triangles)
}

/// The vertices that triangles use, in the order of their first use.
struct Kept {
    vertices: Vec<usize>,
    triangles: Vec<[u32; 3]>,
}

impl Kept {
    fn of(triangles: Vec<[usize; 3]>) -> Self {
        let mut places = HashMap::new();
        let mut vertices = Vec::new();
        let place = |vertex: usize| {
            *places.entry(vertex).or_insert_with(|| {
                vertices.push(vertex);
                vertices.len() as u32 - 1
            })
        };
        let mut place = place;
        let triangles = triangles
            .into_iter()
            .map(|triangle| triangle.map(&mut place))
            .collect();
        Self {
            vertices,
            triangles,
        }
    }

    /// What a morph does to these.
    fn morph(&self, morph: Morph) -> Morph {
        let pick = |moves: Vec<Vec3>| match moves.is_empty() {
            true => moves,
            false => self.pick(&moves),
        };
        Morph {
            positions: pick(morph.positions),
            normals: pick(morph.normals),
            name: morph.name,
        }
    }

    fn pick<T: Clone>(&self, list: &[T]) -> Vec<T> {
        self.vertices
            .iter()
            .map(|vertex| list[*vertex].clone())
            .collect()
    }
}
