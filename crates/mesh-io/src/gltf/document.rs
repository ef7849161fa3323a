//! What of a glTF file is read.
//!
//! Types of our own in place of a library's, whose getters panic where one part names another that is not there, and
//! which refuses files for what is wrong with parts that we don't read. Here each index is looked up by who uses it.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::Value;

use super::error::GltfError;
use crate::read::shown;
use crate::track::Interpolation;

/// A file's JSON.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    asset: Asset,
    #[serde(default)]
    pub extensions_required: Vec<String>,
    #[serde(default)]
    pub extensions: Extensions,
    pub scene: Option<usize>,
    #[serde(default)]
    pub scenes: Vec<Scene>,
    #[serde(default)]
    pub nodes: Vec<Node>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub skins: Vec<Skin>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub textures: Vec<Texture>,
    #[serde(default)]
    pub samplers: Vec<TextureSampler>,
    #[serde(default)]
    pub images: Vec<Image>,
    #[serde(default)]
    pub animations: Vec<Animation>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub buffer_views: Vec<View>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
}

#[derive(Deserialize)]
struct Asset {
    version: String,
}

#[derive(Deserialize)]
pub(super) struct Node {
    pub name: Option<String>,
    #[serde(default)]
    pub children: Vec<usize>,
    pub translation: Option<[f32; 3]>,
    pub rotation: Option<[f32; 4]>,
    pub scale: Option<[f32; 3]>,
    pub matrix: Option<[f32; 16]>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    #[serde(default)]
    pub weights: Vec<f32>,
}

#[derive(Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub nodes: Vec<usize>,
}

#[derive(Deserialize)]
pub(super) struct Mesh {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
    #[serde(default)]
    pub weights: Vec<f32>,
    /// Where programs put the names of morphs.
    #[serde(default)]
    pub extras: Value,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    pub attributes: BTreeMap<String, usize>,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    pub mode: Option<u32>,
    #[serde(default)]
    pub targets: Vec<BTreeMap<String, usize>>,
    #[serde(default)]
    pub extensions: BTreeMap<String, Value>,
    #[serde(default)]
    pub extras: Value,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Skin {
    pub inverse_bind_matrices: Option<usize>,
    pub joints: Vec<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub name: Option<String>,
    #[serde(default)]
    pub pbr_metallic_roughness: Pbr,
    #[serde(default)]
    pub alpha_mode: AlphaMode,
    pub alpha_cutoff: Option<f32>,
    #[serde(default)]
    pub double_sided: bool,
    #[serde(default)]
    pub extensions: MaterialExtensions,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Pbr {
    pub base_color_factor: Option<[f32; 4]>,
    pub base_color_texture: Option<TextureInfo>,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum AlphaMode {
    #[default]
    Opaque,
    Mask,
    Blend,
}

#[derive(Default, Deserialize)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "VRMC_materials_mtoon")]
    pub mtoon: Option<Mtoon>,
}

/// The toon material of VRM 1.0.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Mtoon {
    pub shade_color_factor: Option<[f32; 3]>,
    pub shade_multiply_texture: Option<TextureInfo>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
    pub index: usize,
    #[serde(default)]
    pub tex_coord: usize,
    #[serde(default)]
    pub extensions: TextureExtensions,
}

#[derive(Clone, Copy, Default, Deserialize)]
pub(super) struct TextureExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<TextureTransform>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureTransform {
    #[serde(default)]
    pub offset: [f32; 2],
    #[serde(default)]
    pub rotation: f32,
    #[serde(default = "ones")]
    pub scale: [f32; 2],
    pub tex_coord: Option<usize>,
}

fn ones() -> [f32; 2] {
    [1.0; 2]
}

#[derive(Deserialize)]
pub(super) struct Texture {
    pub source: Option<usize>,
    pub sampler: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureSampler {
    pub wrap_s: Option<u32>,
    pub wrap_t: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    pub name: Option<String>,
    pub uri: Option<String>,
    pub buffer_view: Option<usize>,
}

/// What the whole file has of VRM.
#[derive(Default, Deserialize)]
pub(super) struct Extensions {
    #[serde(rename = "VRM")]
    pub vrm0: Option<Vrm0>,
    #[serde(rename = "VRMC_vrm")]
    pub vrm1: Option<Vrm1>,
    #[serde(rename = "VRMC_springBone")]
    pub spring_bone: Option<SpringBone1>,
}

/// VRM 0.x, as far as it is read.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Vrm0 {
    #[serde(default)]
    pub humanoid: Humanoid0,
    #[serde(default)]
    pub material_properties: Vec<MaterialProperties>,
    #[serde(default)]
    pub secondary_animation: SecondaryAnimation,
}

/// Spring bones of VRM 0.x.
#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SecondaryAnimation {
    #[serde(default)]
    pub bone_groups: Vec<BoneGroup>,
    #[serde(default)]
    pub collider_groups: Vec<ColliderGroup>,
}

#[derive(Deserialize)]
pub(super) struct BoneGroup {
    /// Below 0 where there is none; with all nodes below.
    #[serde(default)]
    pub bones: Vec<i64>,
}

#[derive(Deserialize)]
pub(super) struct ColliderGroup {
    /// Below 0 where there is none.
    pub node: i64,
    #[serde(default)]
    pub colliders: Vec<Collider0>,
}

#[derive(Deserialize)]
pub(super) struct Collider0 {
    #[serde(default)]
    pub offset: Offset0,
    #[serde(default)]
    pub radius: f64,
}

/// A place in a node's space, but for z, which Unity has the other way round.
#[derive(Default, Deserialize)]
pub(super) struct Offset0 {
    #[serde(default)]
    pub x: f64,
    #[serde(default)]
    pub y: f64,
    #[serde(default)]
    pub z: f64,
}

/// Spring bones of VRM 1.0.
#[derive(Deserialize)]
pub(super) struct SpringBone1 {
    #[serde(default)]
    pub colliders: Vec<Collider1>,
    #[serde(default)]
    pub springs: Vec<Spring1>,
}

#[derive(Deserialize)]
pub(super) struct Collider1 {
    pub node: usize,
    #[serde(default)]
    pub shape: Shape1,
    /// What takes the place of `shape` for those who know it.
    #[serde(default)]
    pub extensions: BTreeMap<String, Value>,
}

#[derive(Default, Deserialize)]
pub(super) struct Shape1 {
    pub sphere: Option<Capsule1>,
    pub capsule: Option<Capsule1>,
}

#[derive(Deserialize)]
pub(super) struct Capsule1 {
    #[serde(default)]
    pub offset: [f64; 3],
    #[serde(default)]
    pub radius: f64,
    /// Its other end; a ball has none.
    pub tail: Option<[f64; 3]>,
}

#[derive(Deserialize)]
pub(super) struct Spring1 {
    #[serde(default)]
    pub joints: Vec<SpringJoint1>,
}

#[derive(Deserialize)]
pub(super) struct SpringJoint1 {
    pub node: usize,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Humanoid0 {
    #[serde(default)]
    pub human_bones: Vec<HumanBone0>,
}

#[derive(Deserialize)]
pub(super) struct HumanBone0 {
    pub bone: String,
    /// Below 0 where there is none.
    pub node: i64,
}

/// A material as Unity has it: colours as screens show them.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct MaterialProperties {
    #[serde(default)]
    pub shader: String,
    #[serde(default)]
    pub vector_properties: BTreeMap<String, Vec<f64>>,
    #[serde(default)]
    pub texture_properties: BTreeMap<String, i64>,
}

/// VRM 1.0, as far as it is read.
#[derive(Deserialize)]
pub(super) struct Vrm1 {
    #[serde(default)]
    pub humanoid: Humanoid1,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Humanoid1 {
    #[serde(default)]
    pub human_bones: BTreeMap<String, HumanBone1>,
}

#[derive(Deserialize)]
pub(super) struct HumanBone1 {
    pub node: usize,
}

#[derive(Deserialize)]
pub(super) struct Animation {
    pub name: Option<String>,
    pub channels: Vec<Channel>,
    pub samplers: Vec<Sampler>,
}

#[derive(Deserialize)]
pub(super) struct Channel {
    pub sampler: usize,
    pub target: Target,
}

#[derive(Deserialize)]
pub(super) struct Target {
    node: Option<usize>,
    path: String,
    #[serde(default)]
    extensions: TargetExtensions,
}

#[derive(Default, Deserialize)]
struct TargetExtensions {
    #[serde(rename = "KHR_animation_pointer")]
    pointer: Option<Pointer>,
}

#[derive(Deserialize)]
struct Pointer {
    pointer: String,
}

impl Target {
    /// The node that is moved and which of its properties; `None` where it is no node.
    pub fn node(&self) -> Option<(usize, &str)> {
        match &self.extensions.pointer {
            Some(Pointer { pointer }) => {
                let (node, property) = pointer.strip_prefix("/nodes/")?.split_once('/')?;
                Some((node.parse().ok()?, property))
            }
            None => Some((self.node?, &self.path)),
        }
    }
}

#[derive(Deserialize)]
pub(super) struct Sampler {
    pub input: usize,
    pub output: usize,
    #[serde(default)]
    pub interpolation: Interpolation,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: usize,
    #[serde(rename = "type")]
    pub dimensions: String,
    pub sparse: Option<Sparse>,
}

/// Elements that differ from the rest.
#[derive(Deserialize)]
pub(super) struct Sparse {
    pub count: usize,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: usize,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct View {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
    #[serde(default)]
    pub extensions: BTreeMap<String, Value>,
}

#[derive(Deserialize)]
pub(super) struct Buffer {
    pub uri: Option<String>,
}

impl Document {
    /// Whether nobody can read the file without this extension, as it says.
    pub fn requires(&self, extension: &str) -> bool {
        self.extensions_required.iter().any(|own| own == extension)
    }

    /// Reads a file's bytes: its JSON, and the binary part of a `.glb`.
    pub fn read(bytes: &[u8]) -> Result<(Self, Option<&[u8]>), GltfError> {
        let (json, binary) = match bytes.strip_prefix(b"glTF") {
            Some(_) => parts(bytes)?,
            None => (bytes, None),
        };
        let document: Self = serde_json::from_slice(json).map_err(not_json)?;
        match document.asset.version.split('.').next() {
            Some("2") => Ok((document, binary)),
            _ => Err(GltfError::Version(shown(&document.asset.version))),
        }
    }
}

fn not_json(error: serde_json::Error) -> GltfError {
    let (line, column) = (error.line(), error.column());
    let text = error.to_string();
    let what = text.strip_suffix(&format!(" at line {line} column {column}"));
    GltfError::Json {
        line,
        column,
        what: shown(what.unwrap_or(&text)),
    }
}

/// The JSON and the binary part of a `.glb`: chunks of a length, a kind and as many bytes.
fn parts(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), GltfError> {
    let broken = |at: usize, what| GltfError::Binary { at, what };
    let word = |at: usize| {
        let bytes = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    };
    match word(4) {
        Some(2) => {}
        Some(version) => return Err(GltfError::Version(version.to_string())),
        None => return Err(broken(4, "the file ends in its header")),
    }
    let whole = word(8).map(|length| length as usize);
    let Some(end) = whole.filter(|end| *end <= bytes.len()) else {
        return Err(broken(8, "the file is shorter than its header says"));
    };
    let mut chunks = Vec::new();
    let mut at = 12;
    while at < end {
        let (Some(length), Some(kind)) = (word(at), bytes.get(at + 4..at + 8)) else {
            return Err(broken(at, "the file ends in a chunk's header"));
        };
        let start = at + 8;
        let next = start.saturating_add(length as usize);
        let Some(chunk) = bytes.get(start..next) else {
            return Err(broken(at, "a chunk reaches beyond the end of the file"));
        };
        chunks.push((kind, chunk));
        at = next;
    }
    // Chunks of other kinds are for others.
    let binary = chunks.iter().skip(1).find(|(kind, _)| kind == b"BIN\0");
    match chunks.first() {
        Some((b"JSON", json)) => Ok((json, binary.map(|(_, binary)| *binary))),
        _ => Err(broken(12, "the first chunk is not JSON")),
    }
}
