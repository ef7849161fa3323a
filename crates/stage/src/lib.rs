//! A scene (hair, head, camera, light, style, time) to a frame: the only place where simulation meets
//! strokes.

mod head;
mod load;
mod preset;
mod scene;
mod style;

pub use preset::{CAMERA, HAIR, HEAD, LIGHT, PATH, Preset, SCENE, SECTIONS, VERSION};
pub use scene::{Files, Stage, StageError};
pub use style::ZONE;
