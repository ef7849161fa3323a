//! Controls of single parameters. None owns a value: each shows what a document's text says at a place, and asks for an
//! [`Edit`](crate::edit::Edit) when its user changes it.
//!
//! Every control has a name for screen readers, that of its owner and its parameter: `hair.silhouette width`.

mod choice;
mod color;
mod curve;
mod form;
mod help;
mod icon;
mod note;
mod number;
mod row;
mod search;
mod text;
mod tuple;

pub use form::Form;
pub use search::Search;

pub(crate) use icon::{ICON, Icon, icon_button};
pub(crate) use number::{NumberField, drag_value};
pub(crate) use row::{Cells, Row, cell_text};
pub(crate) use text::text_line;

use effects::preset::edit::written;
use effects::{ParamKind, Value};

/// What the user of a control asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    /// This text in place of the value's.
    Text(String),
    /// What holds where the text says nothing.
    Default,
}

impl Asked {
    /// This value, as a parameter of that kind is written.
    pub fn value(value: &Value, kind: &ParamKind) -> Self {
        Self::Text(written(value, kind))
    }
}
