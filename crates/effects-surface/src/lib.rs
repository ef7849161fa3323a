//! Effects that draw the lines of surfaces, where these turn away from the eye, have an edge or end: after Kalnins et al., "WYSIWYG NPR"
//! (2002), and its authors' later work. A line is a strand of its own, whose joints lie on the surface.
//!
//! ```
//! let mut registry = effects::Registry::new();
//! effects_surface::register(&mut registry)?;
//! assert!(registry.get("line.ink").unwrap().is_for_lines());
//! # Ok::<(), effects::RegistryError>(())
//! ```

mod line_chalk;
mod line_ink;

pub use line_chalk::LineChalk;
pub use line_ink::LineInk;

use effects::{Registry, RegistryError};

/// Registers all of them.
///
/// # Errors
///
/// When the registry already has an effect of the same id.
pub fn register(registry: &mut Registry) -> Result<(), RegistryError> {
    registry.register::<LineChalk>()?;
    registry.register::<LineInk>()
}
