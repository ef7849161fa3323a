//! Hair and head files in, plain strands and meshes out: Y up, metres.
//!
//! [`read_hair`] and [`read_head`] choose the reader, settle axes and units ([`orient`]) and say what
//! they guessed. [`tfx`], [`strands_ron`] and [`obj`] are the formats; [`HeadFrame`] is where the head
//! is and how large, [`BoneMotion`] how a character's animation moves it.

mod file;
mod head;
mod mesh;
mod nearest;
pub mod obj;
pub mod orient;
mod skeleton;
mod sphere;
pub mod strands_ron;
pub mod tfx;

pub use file::{HairError, HairFile, HairOptions, HeadFile, read_hair, read_head, write_strands};
pub use head::HeadFrame;
pub use mesh::Mesh;
pub use skeleton::{BoneMotion, SkeletonError, TrackError};
