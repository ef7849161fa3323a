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

pub use bake::Bake;
pub use check::{check_motion, check_style};
pub use dynamics::{DynamicsSection, FeelChoice, ShapeChoice, SolverChoice};
pub use files::{Files, StageError};
pub use motion::MOTION_PARTS;
pub use part::FilePart;
pub use preset::{
    BrushChoice, CameraSection, ClumpSection, FixedTo, HairSection, HeadSection, HeadShape,
    LightKind, LightSection, MotionSection, OrderChoice, PathChoice, PathSection, Preset,
    SceneSection, Sections, TopSection, UpAxis, VERSION,
};
pub use scene::Stage;
pub use style::STYLE_PARTS;
