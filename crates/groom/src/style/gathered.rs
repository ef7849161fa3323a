//! Hair gathered in a tie: tails, buns and braids.

use super::description::{Form, Zone};
use super::group::Member;
use super::hang::{Hanging, hang};
use super::ornament::Tie;
use super::scalp::Scalp;
use crate::random::Random;
use crate::shell::Shell;
use crate::trig::{sin_cos_degrees, sin_cos_turns};
use glam::Vec3;

/// Points of a clump wound into a bun.
const BUN_POINTS: usize = 14;
/// Points of one crossing of a braid's plaits, and most points of a plait.
const POINTS_A_CROSSING: f32 = 8.0;
const MOST_POINTS: usize = 160;
/// Share of a braid's length at which its end is tied; below it hangs a tuft.
const BRAID_END: f32 = 0.86;

/// One clump of gathered hair.
pub(super) struct Gathered<'a> {
    pub zone: &'a Zone,
    pub scalp: &'a Scalp,
    pub shell: &'a Shell,
    /// 1 on the character's left, -1 on its right.
    pub side: f32,
}

impl Gathered<'_> {
    /// The radius of a clump at its full size, 1/300 head heights.
    pub fn size(&self) -> f32 {
        let zone = self.zone;
        if let Some(size) = zone.size {
            return size;
        }
        let count = zone.count as f32;
        let share = match zone.form {
            // The clumps' sections fill the section of the whole.
            Form::Tail | Form::Rows => 1.0 / count.sqrt(),
            // They lie around the bun, seen from its top.
            Form::Bun => std::f32::consts::PI / count,
            // Three plaits of a third each, a little flattened against each other.
            Form::Braid => 0.62 / (count / 3.0).sqrt(),
        };
        zone.overlap * zone.fullness * share * 300.0
    }

    /// The direction of the tie from the middle of the head.
    fn outward(&self) -> Vec3 {
        self.scalp.direction(&self.zone.roots, 0.5, self.side)
    }

    /// The tie's middle.
    fn center(&self) -> Vec3 {
        self.shell.above(self.outward(), self.zone.root_lift)
    }

    /// The bands that hold this hair.
    pub fn ties(&self) -> Vec<Tie> {
        let zone = self.zone;
        if zone.tie <= 0.0 {
            return Vec::new();
        }
        vec![Tie {
            kind: zone.tie_kind,
            center: self.center(),
            axis: self.outward(),
            radius_m: zone.tie * self.shell.height(),
        }]
    }

    /// The points of clump `index` and how many of them stay with the head.
    pub fn clump(
        &self,
        index: u32,
        member: Option<Member>,
        length_scale: f32,
        random: &mut Random,
    ) -> (Vec<Vec3>, usize) {
        match self.zone.form {
            Form::Tail | Form::Rows => self.tail(index, member, length_scale, random),
            Form::Bun => {
                let points = self.bun(index, random);
                let count = points.len();
                (points, count)
            }
            Form::Braid => self.braid(index, length_scale, random),
        }
    }

    fn tail(
        &self,
        index: u32,
        member: Option<Member>,
        length_scale: f32,
        random: &mut Random,
    ) -> (Vec<Vec3>, usize) {
        let zone = self.zone;
        let own = 1.0 + zone.length_variation * random.around_zero();
        let length = zone.hang * member.map_or(own, |member| member.length * (0.7 + 0.3 * own));
        let section = section_place(index, zone.count);
        let tip_section = member.map_or(section, |_| {
            let groups = zone.groups.min(zone.count);
            let group = section_place(index % groups, groups);
            [0, 1].map(|i| section[i] + (group[i] - section[i]) * zone.gather)
        });
        // Inside the tie the clumps lie side by side.
        let outward = self.outward();
        let sideways = Vec3::Y.cross(outward).normalize_or(Vec3::X);
        let upwards = outward.cross(sideways);
        let in_tie = 0.6 * zone.tie * self.shell.height();
        let shift = (sideways * section[1] + upwards * section[0]) * in_tie;
        let root = self.shell.above(outward, 0.3 * zone.root_lift);
        let mut points = vec![root, self.center() + shift];
        let hanging = Hanging {
            length_m: length * length_scale * self.shell.height(),
            side: self.side,
            size: self.size(),
            section,
            tip_section,
            towards: Vec3::ZERO,
            // One swing for all: a tail is one mass.
            swing: 1.0,
        };
        hang(zone, &hanging, self.shell, random, &mut points);
        (points, 2)
    }

    /// A clump wound over a ball: from the scalp around it to its top.
    fn bun(&self, index: u32, random: &mut Random) -> Vec<Vec3> {
        let zone = self.zone;
        let outward = self.outward();
        let radius = zone.fullness * self.shell.height();
        let center = self
            .shell
            .above(outward, zone.root_lift + 0.75 * zone.fullness);
        let u = Vec3::Y.cross(outward).normalize_or(Vec3::X);
        let v = outward.cross(u);
        let first = (index as f32 + 0.3 * random.around_zero()) / zone.count as f32;
        let turns = 0.55 + 0.1 * random.around_zero();
        let higher = 1.0 + zone.lift_variation * random.around_zero();
        let point = |step: usize| {
            let t = step as f32 / (BUN_POINTS - 1) as f32;
            let (sin_polar, cos_polar) = sin_cos_degrees(150.0 - 142.0 * t);
            let (sin, cos) = sin_cos_turns((first + turns * t) * self.side);
            let around = u * cos + v * sin;
            let flattened = outward * (0.85 * cos_polar);
            center + (flattened + around * sin_polar) * (radius * higher)
        };
        (0..BUN_POINTS).map(point).collect()
    }

    /// A clump of one of three plaits that change places in turn.
    fn braid(&self, index: u32, length_scale: f32, random: &mut Random) -> (Vec<Vec3>, usize) {
        let zone = self.zone;
        let length_m = zone.hang * length_scale * self.shell.height();
        let crossings = zone.hang / zone.curl_length.max(1e-3);
        let count = ((crossings * POINTS_A_CROSSING).ceil() as usize).clamp(12, MOST_POINTS);
        let straight = Zone {
            curl: 0.0,
            fullness: 0.0,
            ..zone.clone()
        };
        let hanging = Hanging {
            length_m,
            side: self.side,
            size: self.size(),
            section: [0.0; 2],
            tip_section: [0.0; 2],
            towards: Vec3::ZERO,
            swing: 1.0,
        };
        let mut axis = vec![
            self.shell.above(self.outward(), 0.3 * zone.root_lift),
            self.center(),
        ];
        // All plaits hang along one line, whatever their clumps' seeds.
        let mut still = Random::new(0, &zone.name, 0);
        hang(&straight, &hanging, self.shell, &mut still, &mut axis);

        let plait = index % 3;
        let own = section_place(index / 3, zone.count.div_ceil(3));
        let away = self.outward().with_y(0.0).normalize_or(Vec3::Z);
        let sideways = Vec3::Y.cross(away);
        let full = zone.fullness * self.shell.height();
        let tuft = [random.around_zero(), random.around_zero()];
        let mut points = vec![axis[0]];
        for step in 0..count {
            let t = step as f32 / (count - 1) as f32;
            let (sin, _) = sin_cos_turns(crossings * t + plait as f32 / 3.0);
            let (sin_twice, _) = sin_cos_turns(2.0 * (crossings * t + plait as f32 / 3.0));
            let weave = sideways * (0.62 * sin) + away * (0.6 * sin_twice);
            let strand = sideways * (0.2 * own[0]) + away * (0.2 * own[1]);
            let offset = if t < BRAID_END {
                (weave + strand) * (1.0 - 0.45 * t)
            } else {
                let open = (t - BRAID_END) / (1.0 - BRAID_END);
                (weave * 0.2 + strand) * (1.0 - open)
                    + (sideways * tuft[0] + away * tuft[1]) * (0.6 * open)
            };
            let center = along_polyline(&axis[1..], t);
            let gap = 0.6 * self.size() / 300.0;
            points.push(self.shell.keep_out(center + offset * full, gap));
        }
        (points, 2)
    }
}

/// The place at share `t` (0 to 1) of a chain of points, by number of points.
fn along_polyline(points: &[Vec3], t: f32) -> Vec3 {
    let at = t.clamp(0.0, 1.0) * (points.len() - 1) as f32;
    let first = (at as usize).min(points.len().saturating_sub(2));
    let next = (first + 1).min(points.len() - 1);
    points[first].lerp(points[next], at - first as f32)
}

/// The place of a clump in a round section, evenly spread: Vogel's spiral.
fn section_place(index: u32, count: u32) -> [f32; 2] {
    /// The golden angle, in turns.
    const STEP: f32 = 0.381_966;
    let (sin, cos) = sin_cos_turns(STEP * (index % 4096) as f32);
    let radius = ((index as f32 + 0.5) / count as f32).sqrt();
    [cos * radius, sin * radius]
}
