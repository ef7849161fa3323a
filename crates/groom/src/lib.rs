//! Hair styles made by description, the bust they are tried on, and guides of dense grooms.
//!
//! [`bust`] is a stylised head with neck and shoulders, made by code, with a drawn face: metres, Y up,
//! the face towards +Z, 0.24 m from the chin at 1.38 m to the top at 1.62 m. [`grow`] grows a [`Style`]
//! on the [`Shell`] of that or any other head. A [`Figure`] has the bust's skull, and a face, a body and a
//! dress to choose. [`Guides`] are the few strands that stand for a dense groom.
//!
//! ```
//! use groom::{Drawn, Place, Scalp, Shell, Style, bust, grow};
//!
//! let bust = bust();
//! let shell = Shell::new(&bust.positions, &bust.normals, &bust.triangles, glam::Vec3::new(0.0, 1.5, 0.0), 0.24);
//! // One clump on each side, drawn by hand, over a flat coat that covers the scalp.
//! let place = |longitude, latitude| Place { longitude, latitude };
//! let lock = Drawn {
//!     points: vec![(place(40.0, 60.0), 0.02), (place(60.0, 20.0), 0.1), (place(65.0, -30.0), 0.1)],
//!     size: 12.0,
//!     mirror: true,
//! };
//! let style = Style {
//!     seed: 1,
//!     scalp: Scalp::default(),
//!     undercoat: true,
//!     cap: 0.02,
//!     coat: 24,
//!     zones: Vec::new(), // rows, tails, buns and braids
//!     edits: Vec::new(),
//!     drawn: vec![lock],
//!     accessories: Vec::new(),
//! };
//! let hair = grow(&style, &shell);
//! assert_eq!(hair.strands.len(), hair.undercoat + 2);
//! ```

mod bust;
mod cut;
mod face;
mod figure;
mod guides;
mod nearest;
mod random;
mod ribbon;
mod shape;
mod shell;
mod solid;
mod style;
mod surface_nets;
mod trig;

pub use bust::{Bust, bust};
pub use face::{FacePart, Ink, Patch};
pub use figure::{Blush, Cloth, Dress, Expression, Eyes, Face, Figure};
pub use guides::Guides;
pub use shell::{Place, Shell, direction};
pub use style::{
    Accessory, AccessoryKind, Drawn, Edit, Form, Grown, Line, LowTie, MOST_CLUMPS, OrnamentMesh,
    Scalp, Style, Taper, Tie, TieKind, Zone, grow, zone_of,
};
