//! Setting single parameters from their texts, as `--set` gives them.

use super::error::suggestion;
use super::value::{parse_value, shown};
use crate::param::{Param, Values};
use crate::section::Section;

/// Why a parameter cannot be set.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SetError {
    /// There is none of that name; a sentence with the nearest right one.
    #[error("{0}")]
    Unknown(String),
    /// The text is not one of its values; a sentence with what would be.
    #[error("{0}")]
    Value(String),
}

/// Sets parameter `param` of a section called `what` from its text. A colour or text may lack its quotes.
///
/// # Errors
///
/// When there is no such parameter, or the text is not one of its values.
pub fn set_text(
    section: &mut dyn Section,
    what: &str,
    param: &str,
    text: &str,
) -> Result<(), SetError> {
    let table = section.table();
    let Some(index) = table.iter().position(|p| p.name == param) else {
        return Err(SetError::Unknown(unknown(param, table, what)));
    };
    let kind = &table[index].kind;
    let value = parse_value(text, kind)
        .or_else(|message| parse_value(&format!("\"{text}\""), kind).map_err(|_| message))
        .map_err(|message| SetError::Value(format!("{what}.{param}: {message}")))?;
    section.set(index, value);
    Ok(())
}

impl Values {
    /// [`set_text`] of these values.
    ///
    /// # Errors
    ///
    /// When there is no such parameter, or the text is not one of its values.
    pub fn set_text(&mut self, what: &str, param: &str, text: &str) -> Result<(), SetError> {
        set_text(self, what, param, text)
    }
}

/// The message for a name that the table of `what` lacks.
pub(super) fn unknown(name: &str, table: &[Param], what: &str) -> String {
    let hint = suggestion(name, table.iter().map(|p| p.name));
    let name = shown(name);
    if table.is_empty() {
        format!("{what} has no `{name}`; it has no parameters")
    } else {
        format!("{what} has no `{name}`{hint}")
    }
}
