//! What can be wrong with a glTF file.

use std::path::PathBuf;

use crate::read::ReadError;

/// Meshes lie no farther from the origin, m: single precision knows metres there no more.
pub(super) const MOST_M: f32 = 1e8;

/// Why a glTF file gives no meshes, or no motion.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GltfError {
    /// Its JSON is not that of glTF.
    #[error("it is not glTF: JSON, line {line}, column {column}: {what}")]
    Json {
        /// The line of the JSON, 1 first.
        line: usize,
        /// The column of it.
        column: usize,
        /// What is wrong there.
        what: String,
    },
    /// A `.glb` whose parts don't fit.
    #[error("it is not glTF: byte {at}: {what}")]
    Binary {
        /// Bytes before the place.
        at: usize,
        /// What is wrong there.
        what: &'static str,
    },
    /// A version other than 2.
    #[error("it is of glTF's version {0}, version 2 is read")]
    Version(String),
    /// There is no such bone.
    #[error("there is no bone `{wanted}`; the nearest names are: {}", .names.join(", "))]
    Bone {
        /// The name as it was given.
        wanted: String,
        /// Names that there are, the nearest first.
        names: Vec<String>,
    },
    /// The file has no animations.
    #[error("there is no animation in it")]
    NoAnimation,
    /// There is no such animation.
    #[error("there is no animation `{wanted}`; the nearest names are: {}", .names.join(", "))]
    Animation {
        /// The name or number as it was given.
        wanted: String,
        /// Names that there are, the nearest first; numbers of those without.
        names: Vec<String>,
    },
    /// No animation can be read from the chain of its parents.
    #[error("the bone `{0}` is its own parent, or of no size")]
    Chain(String),
    /// A node has a child that is not there.
    #[error("node {node} has the child {child}, and there are {count} nodes, 0 first")]
    Child {
        /// The parent's number.
        node: usize,
        /// The child's number as the file gives it.
        child: usize,
        /// How many nodes there are.
        count: usize,
    },
    /// A node has two parents, or is its own.
    #[error("node {0} is below two nodes, or below itself")]
    Tree(
        /// Its number.
        usize,
    ),
    /// A node whose place is infinite.
    #[error("node {0} is at a place that is not finite")]
    Place(
        /// Its number.
        usize,
    ),
    /// A mesh whose nodes or joints put it out of the world.
    #[error("mesh{} lies farther than {MOST_M} m away where its nodes and joints put it at rest", in_quotes(.0))]
    Far(
        /// Its name; may be empty.
        String,
    ),
    /// Something names a part that is not there, or another of a kind that it can't be.
    #[error("{of} {index}: {source}")]
    Part {
        /// What names it, such as `node`.
        of: &'static str,
        /// Its number.
        index: usize,
        /// What is wrong.
        source: PartError,
    },
    /// A part of a mesh has mistakes.
    #[error("mesh {mesh}{}, primitive {primitive}: {source}", in_quotes(.name))]
    Primitive {
        /// The mesh's number.
        mesh: usize,
        /// Its name; may be empty.
        name: String,
        /// The number of its part.
        primitive: usize,
        /// What is wrong.
        source: PartError,
    },
    /// A track of the animation has mistakes.
    #[error("animation {animation}, channel {channel}: {source}")]
    Track {
        /// The animation's number.
        animation: usize,
        /// The channel's number.
        channel: usize,
        /// What is wrong.
        source: PartError,
    },
}

pub(super) fn in_quotes(name: &str) -> String {
    match name {
        "" => String::new(),
        name => format!(" `{name}`"),
    }
}

/// What is wrong with a part of a glTF file: a channel, a primitive, a skin.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PartError {
    /// A part of the file that is not there.
    #[error("it needs {part} {index}, and there are {count}, 0 first")]
    Missing {
        /// What the part is, such as `accessor`.
        part: &'static str,
        /// Its number as the file gives it.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// Two channels move the same.
    #[error("the {0} of its node is moved by another channel too")]
    Twice(&'static str),
    /// A buffer whose numbers cannot be had.
    #[error("buffer {buffer}: {why}")]
    Buffer {
        /// Its number.
        buffer: usize,
        /// Why.
        why: String,
    },
    /// A picture that cannot be had.
    #[error("image {image}: {why}")]
    Image {
        /// Its number.
        image: usize,
        /// Why.
        why: String,
    },
    /// A buffer's file that cannot be read.
    #[error("buffer {buffer}: {source}")]
    File {
        /// Its number.
        buffer: usize,
        /// Why.
        source: ReadError,
    },
    /// A buffer's file that is not beside the character, or below.
    #[error("buffer {buffer}: `{uri}` is not in the folder of the file that names it, {}", folder.display())]
    Elsewhere {
        /// Its number.
        buffer: usize,
        /// What the file names.
        uri: String,
        /// The folder that files must be in.
        folder: PathBuf,
    },
    /// Numbers of another kind.
    #[error("accessor {accessor} is not of {wanted} numbers an element")]
    Kind {
        /// Its number.
        accessor: usize,
        /// How many numbers an element must have.
        wanted: usize,
    },
    /// Whole numbers where parts of a whole are meant.
    #[error("accessor {0} is of whole numbers that are not `normalized`")]
    NotNormalized(usize),
    /// Indices of another kind.
    #[error("accessor {0} is not of whole numbers that could be indices")]
    NotIndices(usize),
    /// A sparse accessor that names an element that it doesn't have.
    #[error("accessor {accessor} is sparse, and has no element {element}")]
    Sparse {
        /// Its number.
        accessor: usize,
        /// The element's number.
        element: usize,
    },
    /// Data that only an extension can unpack.
    #[error("it is packed by {0}, which this build doesn't read: export without compression")]
    Packed(String),
    /// A primitive without what it must have.
    #[error("it has no {0}")]
    Without(&'static str),
    /// An attribute of another length than the positions.
    #[error("its {attribute} has {found} elements, and there are {wanted} vertices")]
    Length {
        /// The attribute.
        attribute: String,
        /// How many it has.
        found: usize,
        /// How many it must have.
        wanted: usize,
    },
    /// An index of a vertex that is not there.
    #[error("triangle {triangle} has vertex {vertex}, and there are {count}, 0 first")]
    Vertex {
        /// The triangle's number.
        triangle: usize,
        /// The vertex's number as the file gives it.
        vertex: usize,
        /// How many there are.
        count: usize,
    },
    /// A joint that the skin doesn't have.
    #[error("vertex {vertex} is moved by joint {joint}, and its skin has {count}, 0 first")]
    Joint {
        /// The vertex.
        vertex: usize,
        /// The joint's number as the file gives it.
        joint: usize,
        /// How many there are.
        count: usize,
    },
    /// A skin with fewer matrices than joints.
    #[error("it has {joints} joints and {matrices} inverse bind matrices")]
    Matrices {
        /// Joints.
        joints: usize,
        /// Matrices.
        matrices: usize,
    },
    /// An accessor that reaches beyond its buffer.
    #[error("accessor {0} reaches beyond its buffer")]
    Outside(usize),
    /// A buffer view that reaches beyond its buffer.
    #[error("buffer view {0} reaches beyond its buffer")]
    View(usize),
    /// An accessor that shares so many numbers with others that they would fill the memory.
    #[error("accessor {0} is one too many: the file's accessors share more numbers than are read")]
    TooMany(usize),
    /// NaN or infinity.
    #[error("accessor {0} has numbers that are not finite")]
    NotFinite(usize),
    /// Times that don't increase, or not as many values.
    #[error("it has {keys} keys and {values} values, and times that must increase")]
    Keys {
        /// Times.
        keys: usize,
        /// Values; three a key where it is cubic.
        values: usize,
    },
}
