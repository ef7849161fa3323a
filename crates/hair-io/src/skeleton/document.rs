//! What of a glTF file is read: nodes, animations, and the accessors that they are in.
//!
//! Types of our own in place of a library's, whose getters panic where one part names another that is not there, and
//! which refuses files for what is wrong with parts that we don't read. Here each index is looked up by who uses it.

use super::error::SkeletonError;
use crate::read::shown;
use serde::Deserialize;
use serde::de::IgnoredAny;

/// A file's JSON.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    asset: Asset,
    #[serde(default)]
    pub nodes: Vec<Node>,
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

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum Interpolation {
    #[default]
    Linear,
    Step,
    CubicSpline,
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
    pub sparse: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct View {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
}

#[derive(Deserialize)]
pub(super) struct Buffer {
    pub uri: Option<String>,
}

impl Document {
    /// Reads a file's bytes: its JSON, and the binary part of a `.glb`.
    pub fn read(bytes: &[u8]) -> Result<(Self, Option<&[u8]>), SkeletonError> {
        let (json, binary) = match bytes.strip_prefix(b"glTF") {
            Some(_) => parts(bytes)?,
            None => (bytes, None),
        };
        let document: Self = serde_json::from_slice(json).map_err(not_json)?;
        match document.asset.version.split('.').next() {
            Some("2") => Ok((document, binary)),
            _ => Err(SkeletonError::Version(shown(&document.asset.version))),
        }
    }
}

fn not_json(error: serde_json::Error) -> SkeletonError {
    let (line, column) = (error.line(), error.column());
    let text = error.to_string();
    let what = text.strip_suffix(&format!(" at line {line} column {column}"));
    SkeletonError::Json {
        line,
        column,
        what: shown(what.unwrap_or(&text)),
    }
}

/// The JSON and the binary part of a `.glb`: chunks of a length, a kind and as many bytes.
fn parts(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), SkeletonError> {
    let broken = |at: usize, what| SkeletonError::Binary { at, what };
    let word = |at: usize| {
        let bytes = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    };
    match word(4) {
        Some(2) => {}
        Some(version) => return Err(SkeletonError::Version(version.to_string())),
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
