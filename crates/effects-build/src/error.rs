//! What can be wrong with an effect's source.

/// Why an effect was not translated: `file:line:column: message`, in the author's own file.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct BuildError(pub(crate) String);
