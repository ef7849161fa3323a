//! What can be wrong with an effect's source.

use crate::compose::Source;
use naga::Span;

/// Why an effect was not translated. The text names the author's file, line and column.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// naga refused the source; its own message, with the source line.
    #[error("{0}")]
    Naga(String),
    /// A rule of ours: `file:line:column: message`.
    #[error("{0}")]
    Message(String),
}

/// An error of ours at a place of the composed text.
pub(crate) fn at(source: &Source, span: Span, message: impl std::fmt::Display) -> BuildError {
    let place = span.location(&source.text);
    BuildError::Message(format!(
        "{}:{}:{}: {message}",
        source.path, place.line_number, place.line_position
    ))
}
