//! The rasterisers held against the reference picture (crate `reference`), which shares no code with them.

mod agreement;
#[cfg(feature = "gpu")]
mod card;
mod drawings;
mod exact;
mod features;
mod portrait;
mod sphere;
mod stamping;
mod textures;
