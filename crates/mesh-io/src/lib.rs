//! Meshes from files into plain arrays: what surrounds hair, and what carries it.
//!
//! A head, a character with clothes and eyes, a surface of water for each frame: [`read_model`] reads OBJ with its materials, PLY, glTF
//! 2.0 and VRM into a [`Model`] of any number of [`Mesh`]es, with names, normals and places in textures of each corner, free numbers
//! (velocities, colours), and [`Material`]s. What moves a character ([`Rig`]: nodes, skins, morphs, animations) is sampled at any time
//! ([`Model::pose`], [`Model::shapes`]); [`Sequence`] finds numbered files; [`Welded`] is the shape alone. Nothing here draws, and
//! nothing knows of hair.
//!
//! ```
//! use mesh_io::{Sequence, read_model};
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("sail.0001.obj");
//! std::fs::write(&path, "o sail\nv 0 0 0\nv 1 0 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")?;
//!
//! let model = read_model(&path)?;
//! let sail = &model.meshes[0];
//! assert_eq!((sail.name.as_str(), sail.triangles.len()), ("sail", 1));
//! assert_eq!(sail.normals[0].z, 1.0);
//! // (0, 0) is the upper left corner of a picture.
//! assert_eq!(sail.uvs[2].y, 0.0);
//!
//! let sequence = Sequence::find(&path)?;
//! assert_eq!(sequence.frame_at(2.0, 24.0), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Files are hostile: counts are held against the bytes that there are, what a file names by number is looked up, and no file outside
//! of its folder is opened. [`read_bytes`] and [`read_text`] refuse what is no file of a sensible size.
//!
//! # Features
//!
//! - `gltf`, on by default: glTF 2.0 and VRM. Without it such files are refused by name.

mod beside;
mod file;
#[cfg(feature = "gltf")]
mod gltf;
#[cfg(not(feature = "gltf"))]
#[path = "without_gltf.rs"]
mod gltf;
mod model;
mod mtl;
pub mod obj;
pub mod ply;
mod polygon;
mod read;
mod rig;
mod sequence;
#[cfg_attr(
    not(any(feature = "gltf", test)),
    expect(dead_code, reason = "only glTF files have tracks")
)]
mod track;
mod welded;

pub use file::{FORMATS, MeshError, NamedFiles, is_model, model_of_bytes, named_files, read_model};
pub use gltf::BoneMotion;
#[cfg(feature = "gltf")]
pub use gltf::{GltfError, PartError, from_bytes as gltf_from_bytes};
pub use model::{Alpha, Attribute, Image, ImageSource, Material, Mesh, Model, Texture, Wrap};
pub use read::{
    MOST_OF_DATA, MOST_OF_TEXT, ReadError, decode_text, place_after, read_bytes, read_text, shown,
};
pub use rig::{Animation, Node, Pose, Rig, Shape, SpringCollider, Springs, Transform};
pub use sequence::{Sequence, SequenceError};
pub use welded::Welded;
