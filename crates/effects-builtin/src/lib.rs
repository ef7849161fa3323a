//! The stroke effects that inkstrand ships, each one `.rs` beside its `.wgsl`: a program registers them, and presets name them
//! by their ids.
//!
//! ```
//! let mut registry = effects::Registry::new();
//! effects_builtin::register(&mut registry)?;
//! let ids: Vec<_> = registry.iter().map(|effect| effect.id()).collect();
//! assert_eq!(ids, ["hair.band", "hair.base", "hair.cast", "hair.cel", "hair.fine", "hair.highlight", "hair.ink", "hair.silhouette"]);
//! # Ok::<(), effects::RegistryError>(())
//! ```

mod band;
mod base;
mod cast;
mod cel;
mod fine;
mod highlight;
mod ink;
mod silhouette;

pub use band::Band;
pub use base::Base;
pub use cast::Cast;
pub use cel::Cel;
pub use fine::Fine;
pub use highlight::Highlight;
pub use ink::Ink;
pub use silhouette::Silhouette;

use effects::{Registry, RegistryError};

/// Registers all of them.
///
/// # Errors
///
/// When the registry already has an effect of the same id.
pub fn register(registry: &mut Registry) -> Result<(), RegistryError> {
    registry.register::<Silhouette>()?;
    registry.register::<Ink>()?;
    registry.register::<Base>()?;
    registry.register::<Cel>()?;
    registry.register::<Cast>()?;
    registry.register::<Highlight>()?;
    registry.register::<Band>()?;
    registry.register::<Fine>()
}
