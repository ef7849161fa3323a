//! Rows of clumps over the head, laid like roof tiles.

use super::curves::{arch, eased, smooth};
use super::description::Zone;
use super::group::Member;
use super::hang::{Hanging, hang};
use super::line::Line;
use super::scalp::Scalp;
use crate::random::Random;
use crate::shell::{Shell, between};
use crate::trig::sin_cos_degrees;
use glam::Vec3;

/// Points of a clump from its root to the line of tips.
const ON_HEAD: usize = 8;
/// Share of the way over the head where a clump is widest, and a row's length is measured.
const WIDEST: f32 = 0.4;
/// How much lower the last row of a zone lies than the first, as a share of its lift.
const TILE: f32 = 0.5;
/// How much of their way together clumps that hang go on the head, before they hang.
const GATHERED_ON_HEAD: f32 = 0.4;
/// The least share of its way that a clump goes over the head, where a group makes it shorter.
const SHORTEST: f32 = 0.05;
/// How near the skin the roots of lower rows lie, head heights.
const ROOT_OF_TILE: f32 = 0.012;

/// What every clump of a row shares.
pub(super) struct Row<'a> {
    zone: &'a Zone,
    scalp: &'a Scalp,
    shell: &'a Shell,
    /// Share of the way to the tips at which this row starts.
    start: f32,
    /// 1 on the character's left, -1 on its right.
    side: f32,
}

/// A clump before it has points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seat {
    /// Its place along the row, 0 to 1.
    pub along: f32,
    /// Its radius, 1/300 head heights.
    pub size: f32,
}

impl<'a> Row<'a> {
    pub fn new(zone: &'a Zone, scalp: &'a Scalp, shell: &'a Shell, number: u32, side: f32) -> Self {
        Self {
            zone,
            scalp,
            shell,
            start: number as f32 / zone.rows.max(1) as f32,
            side,
        }
    }

    /// Seats for the clumps of the row: a bigger one takes more of it.
    pub fn seats(&self, randoms: &mut [Random]) -> Vec<Seat> {
        let classes: Vec<f32> = randoms
            .iter_mut()
            .map(|random| size_class(self.zone.mixed_sizes, random))
            .collect();
        let total: f32 = classes.iter().sum();
        let size = self.zone.size.unwrap_or_else(|| {
            0.5 * self.zone.overlap * self.length() * 300.0 / total.max(f32::MIN_POSITIVE)
        });
        let mut taken = 0.0;
        let seats = classes.iter().map(|class| {
            taken += class;
            Seat {
                along: (taken - 0.5 * class) / total,
                size: size * class,
            }
        });
        seats.collect()
    }

    /// The length of the row where its clumps are widest, head heights.
    fn length(&self) -> f32 {
        const PIECES: u32 = 32;
        let point = |piece: u32| {
            let along = piece as f32 / PIECES as f32;
            let ends = self.ends(along);
            let t = self.start + (1.0 - self.start) * WIDEST;
            self.shell.above(self.way(ends, t), self.lift(t, 1.0))
        };
        let length: f32 = (0..PIECES)
            .map(|piece| (point(piece + 1) - point(piece)).length())
            .sum();
        length / self.shell.height()
    }

    /// The points of a clump, from its root to its tip, and how many of them stay with the head.
    pub fn clump(
        &self,
        seat: Seat,
        member: Option<Member>,
        length_scale: f32,
        random: &mut Random,
    ) -> (Vec<Vec3>, usize) {
        let zone = self.zone;
        let higher = 1.0 + zone.lift_variation * random.around_zero();
        let [root, tip] = self.ends(seat.along);
        let scatter = |random: &mut Random, way: Vec3| {
            let (east, north) = (way.cross(Vec3::Y), way.cross(Vec3::X));
            let moved = east * random.around_zero() + north * random.around_zero();
            (way + moved * zone.scatter.to_radians()).normalize_or(way)
        };
        let ends = [scatter(random, root), scatter(random, tip)];
        let own = match member {
            Some(member) => member.length,
            None => 1.0 + zone.length_variation * random.around_zero(),
        };
        let length = zone.hang * own;
        let hangs = zone.hang > 0.0;
        let (ends, towards) = match member {
            Some(member) => self.gathered(ends, seat, member, hangs),
            None => (ends, Vec3::ZERO),
        };
        // Hair that only lies on the head ends sooner where it is shorter.
        let end = match member {
            Some(_) if !hangs => (own * length_scale).clamp(SHORTEST, 1.0),
            _ => 1.0,
        };

        let mut points = Vec::with_capacity(3 * ON_HEAD);
        if zone.tips.is_some() {
            for step in 0..ON_HEAD {
                let t = end * step as f32 / (ON_HEAD - 1) as f32;
                let t = self.start + (1.0 - self.start) * t;
                points.push(self.shell.above(self.way(ends, t), self.lift(t, higher)));
            }
        } else {
            points.push(self.shell.above(ends[0], zone.root_lift));
        }
        let held = 1 + (self.held() * (points.len() - 1) as f32).round() as usize;
        let hanging = Hanging {
            length_m: length * length_scale * self.shell.height(),
            side: self.side,
            size: seat.size,
            section: [0.0; 2],
            tip_section: [0.0; 2],
            towards,
            swing: member.map_or(1.0, |member| member.swing),
        };
        hang(zone, &hanging, self.shell, random, &mut points);
        (points, held)
    }

    /// The ends of a clump's way over the head, drawn to the middle of its group, and how far its tip is drawn on while it hangs,
    /// metres.
    fn gathered(
        &self,
        [root, tip]: [Vec3; 2],
        seat: Seat,
        member: Member,
        hangs: bool,
    ) -> ([Vec3; 2], Vec3) {
        let at = |share: f32| {
            let along = seat.along + (member.middle - seat.along) * self.zone.gather * share;
            self.ends(along)[1]
        };
        let share = match &self.zone.tips {
            None => 0.0,
            Some(_) if hangs => GATHERED_ON_HEAD,
            Some(_) => 1.0,
        };
        let (own, on_head) = (at(0.0), at(share));
        let ends = [root, (tip + on_head - own).normalize_or(tip)];
        let above = |way: Vec3| self.shell.above(way, self.zone.tip_lift);
        (ends, above(at(1.0)) - above(on_head))
    }

    /// Share of the way over the head that stays with it: all where it leads to one place, as a tie.
    fn held(&self) -> f32 {
        match &self.zone.tips {
            Some(Line::Through(places)) if places.len() == 1 => 1.0,
            _ => self.zone.held.clamp(0.0, 1.0),
        }
    }

    /// Directions of a clump's root on the line of roots and of its end on the line of tips.
    fn ends(&self, along: f32) -> [Vec3; 2] {
        let zone = self.zone;
        let root = self.scalp.direction(&zone.roots, along, self.side);
        let Some(tips) = &zone.tips else {
            return [root; 2];
        };
        let tip = self.scalp.direction(tips, along, self.side);
        let towards_tip = (tip - root * root.dot(tip)).normalize_or_zero();
        let (sin, cos) = sin_cos_degrees(-zone.across);
        [root * cos + towards_tip * sin, tip]
    }

    /// The direction at share `t` of the way over the head.
    fn way(&self, [root, tip]: [Vec3; 2], t: f32) -> Vec3 {
        let straight = between(root, tip, eased(t));
        let sideways = root.cross(tip).normalize_or_zero() * self.side;
        let (sin, _) = sin_cos_degrees(self.zone.bow);
        straight + sideways * (sin * arch(t))
    }

    /// Height above the skin at share `t` of the way, head heights.
    fn lift(&self, t: f32, higher: f32) -> f32 {
        let zone = self.zone;
        let lift = zone.lift * higher * (1.0 - TILE * self.start);
        let (root_lift, own) = if self.start > 0.0 {
            (
                ROOT_OF_TILE,
                (t - self.start) / (1.0 - self.start).max(1e-6),
            )
        } else {
            (zone.root_lift, t)
        };
        if own < 0.5 {
            root_lift + (lift - root_lift) * smooth(2.0 * own)
        } else {
            lift + (zone.tip_lift * higher - lift) * smooth(2.0 * own - 1.0)
        }
    }
}

/// Full, middle or small: a row of equals looks combed by a machine.
pub(super) fn size_class(mixed_sizes: f32, random: &mut Random) -> f32 {
    let (which, fine) = (random.unit(), 1.0 + 0.08 * random.around_zero());
    let class = if which >= mixed_sizes {
        1.0
    } else if which >= 0.4 * mixed_sizes {
        0.7
    } else {
        0.42
    };
    class * fine
}
