//! What can be wrong with a character.

/// Why a character gives no motion.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SkeletonError {
    /// It is not glTF.
    #[error("it is not glTF: {0}")]
    Gltf(#[from] gltf::Error),
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
    /// A track of the animation has mistakes.
    #[error("animation {animation}, channel {channel}: {source}")]
    Track {
        /// The animation's number.
        animation: usize,
        /// The channel's number.
        channel: usize,
        /// What is wrong.
        source: TrackError,
    },
}

/// What is wrong with a channel's numbers.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrackError {
    /// A buffer that cannot be read.
    #[error("buffer {buffer}: {why}")]
    Buffer {
        /// Its number.
        buffer: usize,
        /// Why.
        why: String,
    },
    /// Numbers of another kind.
    #[error("accessor {accessor} is not of {wanted} numbers an element")]
    Kind {
        /// Its number.
        accessor: usize,
        /// How many numbers an element must have.
        wanted: usize,
    },
    /// A sparse accessor, which this build doesn't read.
    #[error("accessor {0} is sparse, or has no buffer view")]
    Sparse(usize),
    /// An accessor that reaches beyond its buffer.
    #[error("accessor {0} reaches beyond its buffer")]
    Outside(usize),
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
