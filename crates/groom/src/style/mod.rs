//! Hair styles: zones of clumps, grown on any head.
//!
//! Lengths are in head heights, angles in degrees, sizes (radii of clumps) in 1/300 of the head's
//! height. "How drawn hair is built" in a drawing book: mass first, rows that overlap like roof tiles,
//! clumps in three sizes.

mod curves;
mod description;
mod edit;
mod gathered;
mod group;
mod grow;
mod hang;
mod line;
mod low_tie;
mod ornament;
mod row;
mod scalp;
mod undercoat;

pub use description::{Form, Style, Taper, Zone};
pub use edit::{Drawn, Edit};
pub use grow::{Grown, MOST_CLUMPS, grow, zone_of};
pub use line::Line;
pub use low_tie::LowTie;
pub use ornament::{Accessory, AccessoryKind, OrnamentMesh, Tie, TieKind};
pub use scalp::Scalp;
