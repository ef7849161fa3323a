//! What the suite looks at in motion: looks, and a few strands made by code.

use super::animation::{Animation, Kind, TICKS, Tick};
use super::looks::{Look, MOTIONS, looks, sintel};
use super::strands::Strands;
use crate::BenchError;
use render::Order;
use std::ops::Range;
use std::path::Path;

/// An order and its name.
pub type NamedOrder = (&'static str, Order);

/// Every order of strokes, with its name in presets. One more is one more line.
pub const ORDERS: [NamedOrder; 3] = [
    ("rounded", Order::Rounded),
    ("strand_first", Order::StrandFirst),
    ("shifted", Order::Shifted),
];

/// The looks of a quick run in motion: the most outlines, and the sharpest contrast.
const QUICK: [&str; 4] = [
    "manga-ink-orbit",
    "twin-tails-orbit",
    "twin-tails-shake",
    "twin-tails-wind",
];

/// Pictures are half as wide and high as the presets': 480 x 360.
pub const PART: u32 = 2;

/// Something that is looked at, and when.
pub struct Subject {
    /// In the table: look and motion.
    pub name: String,
    /// Whose figures are held to something, and to what.
    pub kind: Kind,
    /// When it is looked at.
    pub windows: Vec<Range<Tick>>,
    /// What moves.
    pub animation: Box<dyn Animation>,
    /// The look that it is, if it is one.
    pub look: Option<Look>,
    /// What it is drawn in.
    pub orders: Vec<NamedOrder>,
}

impl Subject {
    /// The name of its look.
    #[must_use]
    pub fn look_name(&self) -> Option<&String> {
        self.look.as_ref().map(|look| &look.name)
    }
}

/// The scenes whose names hold `only`. Where it must be quick: less time, in the order of presets and the source's
/// alone, and, of all scenes, a few looks.
///
/// # Errors
///
/// When a look cannot be read.
pub fn scenes(
    root: &Path,
    data: Option<&Path>,
    quick: bool,
    only: &str,
) -> Result<Vec<Subject>, BenchError> {
    let mut scenes = Vec::new();
    let mut orders = ORDERS.to_vec();
    if quick {
        orders.retain(|(_, order)| [Order::default(), Order::Shifted].contains(order));
    }
    let wanted = |name: &str| name.contains(only);
    let start: Vec<_> = std::iter::once(0..TICKS / if quick { 8 } else { 2 }).collect();
    for (name, kind, open) in Strands::ALL {
        if wanted(name) {
            scenes.push(Subject {
                name: name.to_owned(),
                kind,
                windows: start.clone(),
                animation: Box::new(open()?),
                look: None,
                orders: orders.clone(),
            });
        }
    }
    let mut all = looks(root)?;
    all.extend(data.map(|data| sintel(root, data)));
    for look in all.clone() {
        all.extend(look.with_passes()?);
    }
    for look in all {
        for motion in MOTIONS {
            let name = format!("{}-{}", look.name, motion.name());
            let is_quick = !only.is_empty() || QUICK.contains(&name.as_str());
            if wanted(&name) && (!quick || is_quick) {
                scenes.push(Subject {
                    name,
                    kind: look.kind(),
                    windows: motion.windows(quick),
                    animation: Box::new(look.open(Some(motion), PART)?),
                    look: Some(look.clone()),
                    orders: orders.clone(),
                });
            }
        }
    }
    Ok(scenes)
}
