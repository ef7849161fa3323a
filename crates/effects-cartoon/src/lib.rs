//! Effects that paint what strokes and meshes show, sample by sample: after Shin, Haller and Mukundan, "A Stylized Cartoon
//! Hair Renderer" (2006), and Barla, Thollot and Markosian, "X-Toon" (2006).
//!
//! ```
//! let mut registry = effects::Registry::new();
//! effects_cartoon::register(&mut registry)?;
//! let toon = registry.get("hair.toon").unwrap();
//! assert!(toon.paints().is_some());
//! # Ok::<(), effects::RegistryError>(())
//! ```

mod mesh_flat;
mod mesh_toon;
#[cfg(test)]
mod on_mesh;
mod toon;
mod zigzag;

pub use mesh_flat::MeshFlat;
pub use mesh_toon::MeshToon;
pub use toon::Toon;
pub use zigzag::Zigzag;

use effects::{Registry, RegistryError};

/// Registers all of them.
///
/// # Errors
///
/// When the registry already has an effect of the same id.
pub fn register(registry: &mut Registry) -> Result<(), RegistryError> {
    registry.register::<Toon>()?;
    registry.register::<Zigzag>()?;
    registry.register_mesh::<MeshFlat>()?;
    registry.register_mesh::<MeshToon>()
}
