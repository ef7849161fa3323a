//! What came of a golden picture.

use super::agree::Agreement;
use crate::picture::Difference;

/// What came of a case. The pictures lie in the folder of the report as `NAME.expected.png`,
/// `NAME.actual.png` and `NAME.difference.png`.
#[derive(Debug, PartialEq)]
pub enum Verdict {
    Same,
    /// Another backend's picture that agrees with the golden one.
    Agrees(Agreement),
    /// Another backend's picture that doesn't, and in which cells of a sheet.
    Disagrees(Agreement, Vec<String>),
    /// No golden picture yet.
    New,
    Differs {
        difference: Difference,
        /// The names of a sheet's cells that differ.
        cells: Vec<String>,
    },
    /// No picture, or one that can't be compared; the reason.
    Failed(String),
}

impl Verdict {
    /// True where nothing is wrong.
    pub fn is_good(&self) -> bool {
        matches!(self, Self::Same | Self::Agrees(_))
    }

    /// One line for the maintainer.
    pub fn sentence(&self) -> String {
        match self {
            Self::Same => "ok".to_owned(),
            Self::Agrees(agreement) => format!("ok, {}", agreement.sentence()),
            Self::Disagrees(agreement, cells) => {
                format!("DISAGREES: {}{}", agreement.sentence(), in_cells(cells))
            }
            Self::New => "NEW: look at it, then `cargo xtask regress --bless`".to_owned(),
            Self::Differs { difference, cells } => {
                let Difference { pixels, largest } = difference;
                let steps = f32::from(*largest) / 257.0;
                let place = in_cells(cells);
                format!("DIFFERS: {pixels} pixels, by {steps:.3}/255 at most{place}")
            }
            Self::Failed(reason) => format!("FAILED: {reason}"),
        }
    }
}

fn in_cells(cells: &[String]) -> String {
    match cells {
        [] => String::new(),
        cells => format!(", in {}", cells.join(", ")),
    }
}
