//! What can be wrong with a mesh or an eye.

use std::{error::Error, fmt};

/// Why a mesh, a field on it or an eye was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshError {
    /// A triangle names a vertex that there isn't.
    Index {
        /// The triangle's index.
        triangle: usize,
        /// The vertex that it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// More than 2^30 triangles or 2^32 - 1 vertices.
    TooLarge {
        /// How many triangles there are.
        triangles: usize,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A list that must have one entry a vertex hasn't.
    Count {
        /// What it lists.
        what: &'static str,
        /// How many entries there are.
        found: usize,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A number is NaN or infinite.
    NotFinite {
        /// What it belongs to.
        what: &'static str,
        /// The entry in its list; 0 for what is no list.
        index: usize,
    },
    /// A direction has no length.
    NoDirection,
    /// A length that must be positive and finite isn't.
    NotPositive {
        /// Whose it is.
        what: &'static str,
    },
    /// A length that may be 0 is below it, NaN or infinite.
    Negative {
        /// Whose it is.
        what: &'static str,
    },
    /// A line isn't one of this surface: its joints and segments don't fit together, or lie on triangles that there aren't.
    OtherLine {
        /// The line's index.
        line: usize,
    },
    /// A span isn't one of these lines: it is of one that there isn't, or goes beyond its ends.
    OtherSpan {
        /// The span's index.
        span: usize,
    },
    /// A tracker is given another mesh than in the frames before.
    OtherMesh {
        /// How many triangles it has.
        triangles: usize,
        /// How many that of the frames before has.
        triangles_before: usize,
        /// How many smooth vertices it has.
        vertices: usize,
        /// How many that of the frames before has.
        vertices_before: usize,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index {
                triangle,
                vertex,
                vertices,
            } => write!(
                f,
                "triangle {triangle} names vertex {vertex}, but there are {vertices} vertices"
            ),
            Self::TooLarge {
                triangles,
                vertices,
            } => write!(
                f,
                "{triangles} triangles on {vertices} vertices are too many: at most 2^30 and 2^32 - 1"
            ),
            Self::Count {
                what,
                found,
                vertices,
            } => write!(
                f,
                "there are {found} {what} for {vertices} vertices: there must be one each"
            ),
            Self::NotFinite { what, index } => write!(f, "{what} {index} is NaN or infinite"),
            Self::NoDirection => write!(f, "the direction towards the eye has no length"),
            Self::NotPositive { what } => write!(f, "{what} must be a positive, finite number"),
            Self::Negative { what } => write!(f, "{what} must be 0 or a positive, finite number"),
            Self::OtherLine { line } => write!(f, "line {line} isn't one of this surface"),
            Self::OtherSpan { span } => write!(f, "span {span} isn't one of these lines"),
            Self::OtherMesh {
                triangles,
                triangles_before,
                vertices,
                vertices_before,
            } => write!(
                f,
                "a mesh of {triangles} triangles and {vertices} smooth vertices isn't the one of the frames before, \
                 of {triangles_before} and {vertices_before}: another mesh needs a tracker of its own"
            ),
        }
    }
}

impl Error for MeshError {}
