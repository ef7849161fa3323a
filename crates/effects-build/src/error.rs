//! What can be wrong with an effect's source.

use crate::compose::Source;
use naga::Span;

/// Why an effect was not translated: `file:line:column: message`, in the author's own file.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct BuildError(pub(crate) String);

/// An error at a place of the composed text.
pub(crate) fn at(source: &Source, span: Span, message: impl std::fmt::Display) -> BuildError {
    let place = span.location(&source.text);
    BuildError(format!(
        "{}:{}:{}: {message}",
        source.path, place.line_number, place.line_position
    ))
}
