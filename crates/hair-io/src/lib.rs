//! Hair and head files in, plain strands and meshes out: Y up, metres.
//!
//! [`read_hair`] and [`read_head`] choose the reader, settle axes and units ([`orient`]) and say what
//! they guessed. [`tfx`] and [`strands_ron`] are the formats of hair, those of heads are `mesh-io`'s; [`HeadFrame`] is where the head
//! is and how large, [`BoneMotion`] how a character's animation moves it. [`read_text`] and [`read_bytes`] refuse what is no
//! file of a sensible size, and [`WholeFile`] leaves no half-written one.
//!
//! ```
//! use hair_io::{HairOptions, HeadFrame, read_hair};
//!
//! let text = "(version: 1, strands: [(size: 14, points: [(0, 1.7, 0.1), (0, 1.6, 0.12)])])";
//! let path = std::env::temp_dir().join("one.strands.ron");
//! std::fs::write(&path, text)?;
//!
//! let hair = read_hair(&path, &HairOptions::default())?;
//! assert_eq!(hair.strands.len(), 1);
//! assert_eq!(hair.notes, ["hair: 1 strands, Y up, metres"]);
//! // Nothing says how large the head is: it is of the usual size.
//! let roots: Vec<_> = hair.strands.roots().collect();
//! assert_eq!(HeadFrame::find(None, &roots).height, 0.24);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! - `gltf`, on by default: heads of glTF 2.0 and VRM, and [`BoneMotion::read`]. Without it every character is refused.

mod error;
mod file;
mod format;
mod head;
pub mod mesh_hair;
mod nearest;
pub mod orient;
mod sphere;
pub mod strands_ron;
pub mod tfx;
mod whole_file;

pub use error::HairError;
pub use file::{
    HairFile, HairOptions, HeadFile, is_called_hair, read_hair, read_head, write_strands,
};
pub use format::is_hair_file;
pub use head::HeadFrame;
pub use mesh_io::{
    BoneMotion, MOST_OF_DATA, MOST_OF_TEXT, MeshError, ReadError, Welded as Mesh, decode_text,
    read_bytes, read_text,
};
pub use nearest::Nearest;
pub use whole_file::{
    NoParts, WholeFile, end_of_links, folder_of, named, remove_parts, try_to_write, write_whole,
};
