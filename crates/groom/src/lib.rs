//! Hair styles made by description, the bust they are tried on, and guides of dense grooms.
//!
//! [`bust`] is a stylised head with neck and shoulders, made by code, with a drawn face: metres, Y up,
//! the face towards +Z, 0.24 m from the chin at 1.38 m to the top at 1.62 m. [`grow`] grows a [`Style`]
//! on the [`Shell`] of that or any other head. [`Guides`] are the few strands that stand for a dense
//! groom.

mod bust;
mod face;
mod guides;
mod random;
mod ribbon;
mod shape;
mod shell;
mod solid;
mod style;
mod surface_nets;
mod trig;

pub use bust::{Bust, bust};
pub use face::{Ink, Patch};
pub use guides::Guides;
pub use shell::{Place, Shell, direction};
pub use style::{Drawn, Edit, Form, Grown, Line, MOST_CLUMPS, Ring, Scalp, Style, Tie, Zone, grow};
