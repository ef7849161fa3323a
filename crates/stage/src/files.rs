//! What the caller gives a scene beside the preset, and why there is none.

use std::path::PathBuf;

/// Files that the caller gives in place of the preset's.
#[derive(Clone, Debug, Default)]
pub struct Files {
    /// The folder that the preset's own file names are relative to.
    pub preset_folder: PathBuf,
    /// Hair, relative to the current folder.
    pub hair: Option<PathBuf>,
    /// Head, relative to the current folder.
    pub head: Option<PathBuf>,
    /// Baked motion of the hair, relative to the current folder.
    pub bake: Option<PathBuf>,
    /// A motion script, relative to the current folder.
    pub motion: Option<PathBuf>,
}

/// Why there is no frame.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StageError {
    /// The hair or head could not be read.
    #[error(transparent)]
    File(#[from] hair_io::HairError),
    /// Neither the preset nor the caller names strands.
    #[error(
        "the preset names no hair: give one with --hair FILE, or hair: (file: \"...\") in the preset"
    )]
    NoHair,
    /// A style grows on a head.
    #[error("{}: a style needs a head to grow on: --head FILE, or head: (shape: bust) in the preset", .0.display())]
    NoHead(PathBuf),
    /// A style or motion script cannot be read.
    #[error(transparent)]
    Read(#[from] hair_io::ReadError),
    /// A style or motion script has mistakes.
    #[error(transparent)]
    Mistakes(#[from] effects::preset::PresetErrors),
    /// A strand cannot be simulated.
    #[error("dynamics: {0}")]
    Strand(#[from] hair_sim::StrandError),
    /// The simulation refuses its parameters or a step.
    #[error("dynamics: {0}")]
    Dynamics(#[from] hair_sim::DynamicsError),
    /// The solver cannot do what the preset asks of it.
    #[error("dynamics: {0}")]
    Unsupported(String),
    /// A layer measures the distance to the light.
    #[error(
        "layer `{0}` goes by the distance to the light, and this light has no place: \
         light: (kind: point, distance: ...)"
    )]
    NoPointLight(String),
    /// A section has a value that it doesn't take.
    #[error("{section}.{error}")]
    Section {
        /// The section.
        section: &'static str,
        /// Which value, and what it may be.
        error: effects::section::OutOfRange,
    },
    /// Two strands of a program's own have this id.
    #[error("two strands have the id {0}")]
    SameId(u32),
    /// A file is no bake of the scene's hair.
    #[error("{}: it is not a bake of this hair: {what}", path.display())]
    OtherHair {
        /// The file.
        path: PathBuf,
        /// Where it differs.
        what: String,
    },
    /// Frames that make no motion.
    #[error("bake: {0}")]
    Bake(hair_sim::MotionError),
    /// Key shapes that make no motion.
    #[error("shapes: {0}")]
    Shapes(hair_sim::MotionError),
    /// The camera cannot look like that.
    #[error(transparent)]
    Camera(#[from] stroke_path::CameraError),
    /// The paths cannot be made.
    #[error(transparent)]
    Path(#[from] stroke_path::PathError),
}
