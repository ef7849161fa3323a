//! What came of a golden picture.

use crate::picture::Difference;

/// What came of a case. The pictures lie in the folder of the report as `NAME.expected.png`,
/// `NAME.actual.png` and `NAME.difference.png`.
#[derive(Debug, PartialEq)]
pub enum Verdict {
    Same,
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
    /// One line for the maintainer.
    pub fn sentence(&self) -> String {
        match self {
            Self::Same => "ok".to_owned(),
            Self::New => "NEW: look at it, then `cargo xtask regress --bless`".to_owned(),
            Self::Differs { difference, cells } => {
                let Difference { pixels, largest } = difference;
                let steps = f32::from(*largest) / 257.0;
                let place = match &cells[..] {
                    [] => String::new(),
                    cells => format!(", in {}", cells.join(", ")),
                };
                format!("DIFFERS: {pixels} pixels, by {steps:.3}/255 at most{place}")
            }
            Self::Failed(reason) => format!("FAILED: {reason}"),
        }
    }
}
