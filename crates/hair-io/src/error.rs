//! Errors that name the file.

use std::io;
use std::path::{Path, PathBuf};

use crate::strands_ron::StrandsRonError;
use crate::tfx::TfxError;
use mesh_io::{MeshError, ReadError};

/// Why a hair or head file could not be read or written. Every message names the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HairError {
    /// It cannot be read at all.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// It cannot be written.
    #[error("{source}")]
    Write {
        /// The file.
        path: PathBuf,
        /// Why; it begins with the file's name.
        source: io::Error,
    },
    /// A format that is not read.
    #[error("{}: {found} is not a format that this build reads; it reads {reads}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What the file seems to be.
        found: String,
        /// What can be read.
        reads: &'static str,
    },
    /// A TressFX file with errors.
    #[error("{}: {source}", path.display())]
    Tfx {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        source: TfxError,
    },
    /// A strands file with errors.
    #[error("{}", in_strands(path, source))]
    StrandsRon {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        source: StrandsRonError,
    },
    /// A head, or a character, that can't be read.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A file without a triangle, which is no head.
    #[error("{}: it has no triangle with an area", .0.display())]
    NoTriangles(
        /// The file.
        PathBuf,
    ),
    /// A scale that is not above 0 and finite, or with which positions are not finite.
    #[error(
        "{}: the scale {scale} m a unit is not above 0, or too large for the positions",
        path.display()
    )]
    Scale {
        /// The file.
        path: PathBuf,
        /// Metres a unit.
        scale: f32,
    },
}

/// `file:line:column: what`, which editors jump to.
fn in_strands(path: &Path, error: &StrandsRonError) -> String {
    let path = path.display();
    match error {
        StrandsRonError::At {
            line,
            column,
            problem,
        } => format!("{path}:{line}:{column}: {problem}"),
        other => format!("{path}: {other}"),
    }
}
