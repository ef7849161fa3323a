//! The reference picture held against what can be known without it.

mod areas;
mod drawings;
mod order;
mod textures;
