//! A scene (hair, head, camera, light, style, time) to a frame: the only place where simulation meets
//! strokes.

mod bake;
mod bodies;
mod check;
mod closed;
mod dynamics;
mod files;
mod frame_maker;
mod hair;
mod hand;
mod head;
mod heads;
mod hem;
mod kept;
mod levels;
mod lids;
mod lines;
mod load;
mod look;
mod material;
mod meant;
mod merged;
mod mesh_hair;
mod motion;
mod names;
mod neck;
mod numbered;
mod object;
mod once;
mod painted;
mod part;
mod pictures;
mod placement;
mod posture;
mod preset;
mod reach;
mod scalp;
mod scene;
mod script;
mod shapes;
mod skeleton;
mod solid;
mod stage;
mod style;
mod textures;
mod things;
mod zones;

pub use bake::{Bake, is_bake};
pub use bodies::{BODIES, BodyKeySection, BodyOn, BodySection, BodyShape, NamedBody};
pub use check::{check_hair, check_mesh, check_motion, check_style, is_hair_file, is_mesh_file};
pub use closed::Return;
pub use dynamics::{DynamicsSection, FeelChoice, ShapeChoice, SolverChoice};
pub use files::{Files, StageError, no_file};
pub use frame_maker::FrameMaker;
pub use groom::{Blush, Dress, Expression, Eyes, Face, Figure};
pub use hair::HairModel;
pub use hand::Hand;
pub use head::HeadModel;
pub use heads::Heads;
pub use look::Look;
pub use motion::Motion;
pub use object::Object;
pub use part::FilePart;
pub use preset::{
    AlphaChoice, BlushChoice, BrushChoice, CameraSection, ClumpSection, DressChoice, EdgesChoice,
    ExpressionChoice, EyesChoice, FixedTo, HairFrom, HairSection, HeadColors, HeadSection,
    HeadShape, HeldChoice, LINES, LightKind, LightSection, LineSection, MESHES, MeshSection,
    MotionSection, NamedLines, NamedMesh, NamedObject, ObjectSection, OrderChoice, PASSES,
    PassSection, PathChoice, PathSection, Preset, SceneSection, Sections, ThingChoice, TopSection,
    UpAxis, VERSION,
};
pub use scene::Scene;
pub use script::MOTION_PARTS;
pub use stage::Stage;
pub use style::STYLE_PARTS;
pub use textures::Textures;
pub use things::thing_mesh;
