//! Hair that is modelled as triangles, as characters of games have it, as strands.
//!
//! Such hair is many closed tubes, ribbons and balls, each a lock. [`islands`] tells them apart, [`locks`] finds where the middle of each
//! runs and how wide it is there, and [`Lock::strands`] lays strands of a width that can be drawn into it: one along a narrow lock, some side by side in a
//! ribbon, a ring of them under the surface of what is thick. Shells around the skull are no locks. Plain arrays in, plain arrays out:
//! metres, in any axes.
//!
//! The middle is that of level sets of the distance from the root along the surface (Verroust, Lazarus: "Extracting Skeletal Curves from
//! 3D Scattered Data", 2000), and then, as these are slanted near the ends, of the distance along the line so found.
//!
//! ```
//! use glam::Vec3;
//! use hair_io::mesh_hair::{MeshHair, locks};
//!
//! // A ribbon of 20 cm, 2 cm wide, that hangs from the top of a head.
//! let place = |row: u32, x: f32| Vec3::new(x, 1.7 - 0.02 * row as f32, 0.1);
//! let positions: Vec<Vec3> = (0..=10).flat_map(|row| [place(row, -0.01), place(row, 0.01)]).collect();
//! let triangles: Vec<[u32; 3]> = (0..10).flat_map(|row| [[0, 2, 1], [1, 2, 3]].map(|t| t.map(|i| 2 * row + i))).collect();
//! let groups = vec![Some(0); triangles.len()];
//! let hair = MeshHair { positions: &positions, triangles: &triangles, groups: &groups, depths: &[] };
//!
//! let found = locks(&hair, Vec3::new(0.0, 1.65, 0.0), 0.015);
//! let strands = found.locks[0].strands(0.02);
//! assert_eq!(strands.len(), 1);
//! assert!(strands[0].points[0].distance(Vec3::new(0.0, 1.7, 0.1)) < 1e-3);
//! assert!((strands[0].half_widths[5] - 0.01).abs() < 1e-3);
//! ```

mod bundle;
mod distance;
mod islands;
mod section;

#[cfg(test)]
mod tests;

pub use bundle::LockStrand;
pub use islands::islands;

use distance::{Surface, along_line, range};
use glam::{DMat3, DVec3, Vec3};
use section::Section;

/// The least moment of the directions from the skull's middle to an island, of which an island is a shell around the skull: all ways it spreads as far as a
/// cap of 37 degrees from its middle to its rim. Of half a ball's shell it is 1/3, of a lock, whatever its length, near 0.
const SHELL: f64 = 0.09;
/// A lock that is shorter than this many half widths is a ball or a tuft, whose root is its place nearest to the skull.
const TUFT: f64 = 3.0;
/// Links of a lock's line.
const FEWEST_LINKS: usize = 4;
const MOST_LINKS: usize = 32;
/// What is left out of a line at its ends, in half widths, each time that it is found again.
const TRIMS: [f64; 5] = [2.5, 1.5, 1.0, 0.6, 0.3];
/// How far below what it was cut off from a lock begins, so that its root isn't seen, in links.
const UNDER: f64 = 1.0;
/// Of depths that differ by less, neither end is the root.
const SAME_DEPTH: f32 = 0.25;

/// Triangles of which some are hair.
#[derive(Clone, Copy, Debug)]
pub struct MeshHair<'a> {
    /// Positions, in metres. Triangles with a corner that is not finite are no hair.
    pub positions: &'a [Vec3],
    /// Three indices into `positions`; a triangle with another index is no hair.
    pub triangles: &'a [[u32; 3]],
    /// One a triangle: `None` where it is no hair; triangles of two groups are two islands, even where they touch.
    pub groups: &'a [Option<u32>],
    /// One a position: how far from the head along the skeleton what moves it is, 0 on the head. Empty where nobody knows.
    pub depths: &'a [f32],
}

/// What hair is made of.
#[derive(Clone, Debug, Default)]
pub struct Locks {
    /// The locks, by their first triangle.
    pub locks: Vec<Lock>,
    /// How many islands are shells around the skull, which are no locks.
    pub shells: usize,
}

/// An island: its triangles and the line that it follows.
#[derive(Clone, Debug)]
pub struct Lock {
    /// Indices of its triangles, ascending.
    pub triangles: Vec<usize>,
    /// Whether it was not cut off other triangles.
    is_whole: bool,
    /// From root to tip, two or more.
    sections: Vec<Section>,
}

/// The locks of hair around a skull whose middle is at `skull`, with lines of links of about `link_m` metres. An island without a length
/// is none.
#[must_use]
pub fn locks(hair: &MeshHair, skull: Vec3, link_m: f32) -> Locks {
    let skull = skull.as_dvec3();
    let mut found = Locks::default();
    let borders = islands::borders(hair);
    for triangles in islands::grouped(hair) {
        let surface = Surface::new(hair, &triangles, &borders);
        if is_shell(&surface, skull) {
            found.shells += 1;
            continue;
        }
        if let Some(mut sections) = sections(&surface, skull, f64::from(link_m)) {
            if !surface.rim.is_empty() {
                let hidden = sections[0].under(skull, UNDER * f64::from(link_m));
                sections.insert(0, hidden);
                section::measure(&mut sections);
            }
            found.locks.push(Lock {
                triangles,
                is_whole: surface.rim.is_empty(),
                sections,
            });
        }
    }
    found
}

/// Whether an island lies around the skull as a cap does.
fn is_shell(surface: &Surface, skull: DVec3) -> bool {
    // What was cut off something hangs there.
    if !surface.rim.is_empty() {
        return false;
    }
    let (mut moments, mut whole) = (DMat3::ZERO, 0.0);
    for [a, b, c] in surface.corners() {
        let area = (b - a).cross(c - a).length();
        let way = ((a + b + c) / 3.0 - skull).normalize_or_zero();
        moments += DMat3::from_cols(way * way.x, way * way.y, way * way.z) * area;
        whole += area;
    }
    // The least one is greater where these are positive definite (Sylvester).
    let rest = moments - DMat3::from_diagonal(DVec3::splat(SHELL * whole));
    let upper = rest.x_axis.x * rest.y_axis.y - rest.x_axis.y * rest.y_axis.x;
    rest.x_axis.x > 0.0 && upper > 0.0 && rest.determinant() > 0.0
}

/// The sections of an island from root to tip; nothing where it has no length.
fn sections(surface: &Surface, skull: DVec3, link_m: f64) -> Option<Vec<Section>> {
    if let Some(along) = from_rim(surface) {
        return along.sections(surface, link_m);
    }
    let root = root(surface, skull);
    let found = Along::Surface(surface.distances(&[root])).sections(surface, link_m)?;
    if !is_tuft(&found) {
        return Some(found);
    }
    let away = |vertex: &usize| surface.places[*vertex].distance(skull);
    let all = 0..surface.places.len();
    let root = all.min_by(|a, b| away(a).total_cmp(&away(b)))?;
    Along::Surface(surface.distances(&[root])).sections(surface, link_m)
}

fn is_tuft(sections: &[Section]) -> bool {
    let widest = sections.iter().map(|own| own.half_width);
    section::length(sections) < TUFT * widest.fold(0.0, f64::max)
}

impl Lock {
    /// Whether it was cut off other triangles. Its strands begin a link below these then, and come out at their second point.
    #[must_use]
    pub fn is_cut_off(&self) -> bool {
        !self.is_whole
    }

    /// Whether it is a ball or a tuft, shorter than one and a half of its widths, as buns are; never of what was cut off a cap.
    #[must_use]
    pub fn is_tuft(&self) -> bool {
        self.is_whole && is_tuft(&self.sections)
    }
}

/// How far each place of an island is from its root.
enum Along {
    /// Along the surface: level sets are slanted where it is wide.
    Surface(Vec<f64>),
    /// Between two rows of places.
    Between(Vec<f64>),
}

/// How far each place is from where the island was cut off; nothing where it was not. Of what is short and wide, such as bangs, whose sides may have
/// been cut too, it is how far it is between the cut's half that is away from the rest, and the rest's that is away from the cut.
fn from_rim(surface: &Surface) -> Option<Along> {
    let count = |of: usize| of.max(1) as f64;
    if surface.rim.is_empty() {
        return None;
    }
    let places = &surface.places;
    let middle =
        surface.rim.iter().map(|own| places[*own]).sum::<DVec3>() / count(surface.rim.len());
    let wide = surface
        .rim
        .iter()
        .map(|own| places[*own].distance(middle))
        .fold(0.0, f64::max);
    let along = surface.distances(&surface.rim);
    let length = along[surface.farthest(&along)];
    if length > 2.0 * wide {
        return Some(Along::Surface(along));
    }
    let free: Vec<usize> = (0..places.len())
        .filter(|place| surface.rim.binary_search(place).is_err())
        .collect();
    let way = free.iter().map(|own| places[*own]).sum::<DVec3>() / count(free.len()) - middle;
    let is_first_half = |place: &usize| (places[*place] - middle).dot(way) < 0.5 * way.dot(way);
    let root: Vec<usize> = surface.rim.iter().copied().filter(is_first_half).collect();
    let tip: Vec<usize> = free
        .into_iter()
        .filter(|place| !is_first_half(place))
        .collect();
    if root.is_empty() || tip.is_empty() {
        return Some(Along::Surface(along));
    }
    let [from_root, from_tip] = [&root, &tip].map(|of| surface.distances(of));
    let share = from_root
        .iter()
        .zip(&from_tip)
        .map(|(root, tip)| root / (root + tip));
    Some(Along::Between(
        share.map(|share| share * way.length()).collect(),
    ))
}

/// The place at the root of an island of its own: one of the two that are farthest from each other.
fn root(surface: &Surface, skull: DVec3) -> usize {
    let one = surface.farthest(&surface.distances(&[0]));
    let other = surface.farthest(&surface.distances(&[one]));
    let depth = |vertex: usize| surface.depths.get(vertex).copied().unwrap_or(0.0);
    let is_root = match depth(one) - depth(other) {
        differ if differ.abs() > SAME_DEPTH => differ < 0.0,
        _ => surface.places[one].distance(skull) <= surface.places[other].distance(skull),
    };
    if is_root { one } else { other }
}

impl Along {
    /// The sections from root to tip; nothing where the island has no length.
    fn sections(self, surface: &Surface, link_m: f64) -> Option<Vec<Section>> {
        let (mut along, trims) = match self {
            Self::Surface(along) => (along, &TRIMS[..]),
            Self::Between(along) => (along, &[][..]),
        };
        let (low, high) = range(&along);
        let length = high - low;
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        let links = (length / link_m).round() as usize;
        let links = links.clamp(FEWEST_LINKS, MOST_LINKS);
        // Each time the levels stand straighter on the line.
        for &trim in trims {
            let line = section::middles(surface, &along, links, trim)?;
            along = along_line(&surface.places, &along, &line)?;
        }
        section::sections(surface, &along, links)
    }
}
