//! A scene (hair, head, camera, light, style, time) to a frame: the only place where simulation meets
//! strokes.

mod bake;
mod check;
mod dynamics;
mod files;
mod hair;
mod head;
mod load;
mod material;
mod motion;
mod neck;
mod part;
mod preset;
mod reach;
mod scalp;
mod scene;
mod script;
mod shapes;
mod style;
mod table;

pub use bake::Bake;
pub use check::{check_motion, check_style};
pub use dynamics::feel::DYNAMICS;
pub use files::{Files, StageError};
pub use motion::MOTION_PARTS;
pub use part::FilePart;
pub use preset::{CAMERA, HAIR, HEAD, LIGHT, MOTION, PATH, Preset, SCENE, SECTIONS, VERSION};
pub use scene::Stage;
pub use style::STYLE_PARTS;
