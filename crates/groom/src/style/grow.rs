//! From a style to strands on a head.

use super::description::{Form, Style, Taper, Zone};
use super::edit::{Drawn, Edit};
use super::gathered::Gathered;
use super::group::Groups;
use super::hang::cut_at;
use super::low_tie::{self, LowTie};
use super::ornament::{OrnamentMesh, Tie};
use super::row::{Row, Seat, size_class};
use super::undercoat::undercoat;
use crate::random::Random;
use crate::shell::Shell;
use glam::Vec3;
use hair_sim::Strands;

/// Ids of a zone's clumps begin at its number times this; those of the mirrored half in the middle.
/// The undercoat and hand-drawn clumps are zones 0 and 1.
const IDS_A_ZONE: u32 = 10_000;
/// Most clumps of one side of a zone.
pub const MOST_CLUMPS: u32 = IDS_A_ZONE / 2;
const UNDERCOAT: u32 = 0;
const DRAWN: u32 = 1;
const FIRST_ZONE: u32 = 2;
/// Size of the broad undercoat's clumps at the whorl, as a share of their full size.
const COAT_ROOT: f32 = 0.75;

/// Hair that was grown on a head.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grown {
    /// The clumps, each with its size and an id that only its zone's place in the list and its own
    /// number decide; ids increase.
    pub strands: Strands,
    /// How many of them, the first ones, are the undercoat's.
    pub undercoat: usize,
    /// How many points from its root each clump keeps on the head: pressed to the scalp, or gathered
    /// in a tie.
    pub held: Vec<u32>,
    /// How each clump begins and ends.
    pub tapers: Vec<Taper>,
    /// The ties of gathered hair.
    pub ties: Vec<Tie>,
    /// The ties of hair on its way down.
    pub low_ties: Vec<LowTie>,
    /// Ties and accessories as meshes, but for those that move with the hair.
    pub ornaments: Vec<OrnamentMesh>,
}

impl Grown {
    fn push(
        &mut self,
        zone: u32,
        number: u32,
        points: &[Vec3],
        held: usize,
        size: f32,
        taper: Taper,
    ) {
        let id = zone.wrapping_mul(IDS_A_ZONE).wrapping_add(number);
        // Points come from a shell of finite radii: refused is a clump that somebody drew without any, and draws nothing.
        if self.strands.push(id, points, Some(size)).is_ok() {
            self.held.push(held as u32);
            self.tapers.push(taper);
        }
    }
}

/// The zone, by its place in the style's list, of the clump of this id; none of undercoat and hand-drawn clumps.
#[must_use]
pub fn zone_of(id: u32) -> Option<usize> {
    (id / IDS_A_ZONE)
        .checked_sub(FIRST_ZONE)
        .map(|zone| zone as usize)
}

/// Grows a style on a head.
#[must_use]
pub fn grow(style: &Style, shell: &Shell) -> Grown {
    let mut grown = Grown::default();
    if style.undercoat {
        let coat = undercoat(&style.scalp, style.cap, style.coat, shell);
        // Broad clumps make the skull's dome where they meet: they are wide there, whatever the look says.
        let taper = Taper {
            root_size: (style.coat > 0).then_some(COAT_ROOT),
            shrink_start: None,
        };
        for (number, (points, size)) in (0..).zip(coat) {
            grown.push(UNDERCOAT, number, &points, points.len(), size, taper);
        }
        grown.undercoat = grown.strands.len();
    }
    for (half, side) in [(0, 1.0), (MOST_CLUMPS, -1.0)] {
        let is_there = |(_, drawn): &(u32, &Drawn)| half == 0 || drawn.mirror;
        for (number, drawn) in (0..).zip(&style.drawn).filter(is_there) {
            let points = drawn.points(side, shell);
            grown.push(
                DRAWN,
                half + number,
                &points,
                1,
                drawn.size,
                Taper::default(),
            );
        }
    }
    for (number, zone) in (FIRST_ZONE..).zip(&style.zones) {
        for (half, side) in [(0, 1.0), (MOST_CLUMPS, -1.0)] {
            if half == 0 || zone.mirror {
                let mut half = Half {
                    style,
                    shell,
                    zone,
                    number,
                    first: half,
                    side,
                    grown: &mut grown,
                };
                let before = half.grown.strands.len();
                match zone.form {
                    Form::Rows => half.rows(),
                    Form::Tail | Form::Bun | Form::Braid => half.gathered(),
                }
                let (strands, held) = (&mut grown.strands, &grown.held);
                let low_tie = low_tie::gather(zone, shell, strands, held, before);
                grown.low_ties.extend(low_tie);
            }
        }
    }
    grown.ornaments = grown.ties.iter().map(Tie::mesh).collect();
    for accessory in &style.accessories {
        grown.ornaments.push(accessory.mesh(1.0, shell));
        if accessory.mirror {
            grown.ornaments.push(accessory.mesh(-1.0, shell));
        }
    }
    grown
}

/// One side of a zone.
struct Half<'a> {
    style: &'a Style,
    shell: &'a Shell,
    zone: &'a Zone,
    number: u32,
    first: u32,
    side: f32,
    grown: &'a mut Grown,
}

impl Half<'_> {
    fn random(&self, clump: u32) -> Random {
        Random::new(self.style.seed, &self.zone.name, self.first + clump)
    }

    fn rows(&mut self) {
        let zone = self.zone;
        let in_row = zone.count.min(MOST_CLUMPS / zone.rows.max(1));
        for row_number in 0..zone.rows {
            let row = Row::new(zone, &self.style.scalp, self.shell, row_number, self.side);
            let first = row_number * in_row;
            let mut randoms: Vec<Random> = (0..in_row).map(|i| self.random(first + i)).collect();
            let seats = row.seats(&mut randoms);
            let groups = Groups::new(self.style.seed, zone, row_number, self.side);
            for ((clump, random), seat) in (first..).zip(&mut randoms).zip(seats) {
                let edit = self.edit(clump);
                let length = edit.map_or(1.0, |edit| edit.length);
                let seat = Seat {
                    // Joints of one row lie over the middle of the clumps of the next.
                    along: staggered(seat.along, row_number, in_row),
                    ..seat
                };
                let member = groups.member(seat.along);
                let (points, held) = row.clump(seat, member, length, random);
                self.push(clump, points, held, seat.size);
            }
        }
    }

    fn gathered(&mut self) {
        let zone = self.zone;
        let gathered = Gathered {
            zone,
            scalp: &self.style.scalp,
            shell: self.shell,
            side: self.side,
        };
        let size = gathered.size();
        let groups = Groups::new(self.style.seed, zone, 0, self.side);
        for clump in 0..zone.count.min(MOST_CLUMPS) {
            let mut random = self.random(clump);
            let class = size_class(zone.mixed_sizes, &mut random);
            let length = self.edit(clump).map_or(1.0, |edit| edit.length);
            let member = groups.of_gathered(clump);
            let (points, held) = gathered.clump(clump, member, length, &mut random);
            self.push(clump, points, held, size * class);
        }
        self.grown.ties.extend(gathered.ties());
    }

    fn edit(&self, clump: u32) -> Option<&Edit> {
        let is_meant = |edit: &&Edit| {
            edit.zone == self.zone.name && edit.clump == clump && edit.mirrored == (self.first > 0)
        };
        self.style.edits.iter().find(is_meant)
    }

    fn push(&mut self, clump: u32, mut points: Vec<Vec3>, held: usize, mut size: f32) {
        if let Some(edit) = self.edit(clump) {
            if edit.remove {
                return;
            }
            edit.apply(&mut points, self.shell);
            size *= edit.size;
        }
        let cut = self.zone.cut.filter(|_| self.zone.form != Form::Bun);
        if let Some(height) = cut {
            cut_at(height, self.shell, &mut points);
        }
        let held = held.min(points.len());
        let taper = self.zone.taper;
        self.grown
            .push(self.number, self.first + clump, &points, held, size, taper);
    }
}

/// A place along a row, moved by half a clump in every other row.
fn staggered(along: f32, row: u32, count: u32) -> f32 {
    let shift = if row % 2 == 1 {
        0.5 / count.max(1) as f32
    } else {
        0.0
    };
    (along + shift).min(1.0)
}
