//! Hair that hangs: from the rim of the head, or from a tie.

use super::curves::smooth;
use super::description::Zone;
use crate::random::Random;
use crate::shell::Shell;
use crate::trig::sin_cos_turns;
use glam::Vec3;

/// Points by which hair that hangs without curls is shaped; a style may have more on the way through them.
const POINTS: usize = 10;
/// Points of one turn of a curl, and most points of one clump.
const POINTS_A_TURN: f32 = 9.0;
const MOST_POINTS: usize = 160;
/// How near the skin a clump's middle line may come, in its radii: some of it lies against the skin.
const CLOSEST: f32 = 0.6;
/// How often hanging points are moved out of the body: each move may push others in.
const CLEARINGS: u32 = 4;
/// Points of what leads hair that is too short down to where it is cut.
const LED_DOWN: u32 = 4;
/// How near the skin hair may come on its way, head heights.
const CLEAR: f32 = 0.002;
/// Length in which hair of weight 1/2 turns half-way down, head heights.
const BEND: f32 = 0.12;

/// What a clump hangs by.
pub(super) struct Hanging {
    /// Length that hangs, metres.
    pub length_m: f32,
    /// 1 on the character's left, -1 on its right.
    pub side: f32,
    /// Radius at its full size, 1/300 head heights.
    pub size: f32,
    /// Its place in the section of gathered hair (outwards, sideways), within the unit circle.
    pub section: [f32; 2],
    /// The place in the section that its tip comes to.
    pub tip_section: [f32; 2],
    /// How far its tip is drawn to others of its group, metres.
    pub towards: Vec3,
    /// Its share of the zone's sideways leans.
    pub swing: f32,
}

/// Lets a clump hang on from its last point.
pub(super) fn hang(
    zone: &Zone,
    hanging: &Hanging,
    shell: &Shell,
    random: &mut Random,
    points: &mut Vec<Vec3>,
) {
    let (phase, sway) = (random.unit(), zone.sway * random.around_zero());
    if hanging.length_m <= 0.0 {
        return;
    }
    let first = points.len().saturating_sub(2);
    let hung = points.len() - 1;
    let axis = Axis::new(zone, hanging, shell, points, sway);
    let length = hanging.length_m / shell.height();
    let turns = if zone.curl > 0.0 {
        length / zone.curl_length.max(1e-3)
    } else {
        0.0
    };
    let count = (POINTS.max((turns * POINTS_A_TURN).ceil() as usize)).min(MOST_POINTS);
    for (step, (center, heading)) in axis.walk(count).into_iter().enumerate() {
        let t = (step + 1) as f32 / count as f32;
        // Waves of neighbours go together; curls are each clump's own.
        let turn = turns * t * hanging.side + phase * (1.0 - 0.85 * zone.curl_flatness);
        let (sin, cos) = sin_cos_turns(turn);
        let across = axis.sideways;
        let outwards = across.cross(heading).normalize_or(axis.away);
        let round = across * cos + outwards * (sin * (1.0 - zone.curl_flatness));
        let curl = round * (zone.curl * shell.height() * smooth(4.0 * t));
        let together = smooth(t);
        let place = |i: usize| {
            hanging.section[i] + (hanging.tip_section[i] - hanging.section[i]) * together
        };
        let [out, side] = [place(0), place(1)].map(|x| x * axis.fullness(t));
        let gathered = hanging.towards * together;
        let point = center + axis.away * out + axis.sideways * side + gathered + curl;
        points.push(shell.keep_out(point, axis.gap));
    }
    if turns <= 0.0 {
        smooth_corners(&mut points[first..]);
    }
    keep_clear(&mut points[hung..], shell);
    let wanted = (zone.points as usize).min(MOST_POINTS);
    if wanted > count {
        refine(points, hung, wanted);
        keep_clear(&mut points[hung..], shell);
    }
}

/// Puts so many points behind the one at `hung`, on Catmull and Rom's spline through those that are there: the shape stays.
fn refine(points: &mut Vec<Vec3>, hung: usize, wanted: usize) {
    let links = points.len() - 1 - hung;
    let on_path = |place: f32| {
        let link = (place as usize).min(links - 1);
        let (t, i) = (place - link as f32, hung + link);
        let [b, c] = [points[i], points[i + 1]];
        let a = i.checked_sub(1).map_or(b * 2.0 - c, |i| points[i]);
        let d = points.get(i + 2).copied().unwrap_or(c * 2.0 - b);
        let (from, to, way) = ((c - a) * 0.5, (d - b) * 0.5, c - b);
        b + (from + (way * 3.0 - from * 2.0 - to + (from + to - way * 2.0) * t) * t) * t
    };
    let fine: Vec<Vec3> = (1..=wanted)
        .map(|step| on_path(step as f32 / wanted as f32 * links as f32))
        .collect();
    points.truncate(hung + 1);
    points.extend(fine);
}

/// Moves hanging points out of the body, and those between which the way runs through it.
pub(super) fn keep_clear(points: &mut [Vec3], shell: &Shell) {
    for _ in 0..CLEARINGS {
        let mut has_moved = false;
        for i in 1..points.len() {
            let clear = shell.keep_out(points[i], CLEAR);
            has_moved |= clear != points[i];
            points[i] = clear;
            for t in [0.25, 0.5, 0.75] {
                let place = points[i - 1].lerp(points[i], t);
                let push = shell.keep_out(place, CLEAR) - place;
                has_moved |= push != Vec3::ZERO;
                // As little as moves the place by that much; what hair hangs from stays.
                let (before, here) = match i {
                    1 => (0.0, 1.0),
                    _ => {
                        let squared = (1.0 - t) * (1.0 - t) + t * t;
                        ((1.0 - t) / squared, t / squared)
                    }
                };
                points[i - 1] += push * before;
                points[i] += push * here;
            }
        }
        if !has_moved {
            return;
        }
    }
}

/// Ends a clump at a height: cut off there, or led straight down to it.
pub(super) fn cut_at(height: f32, shell: &Shell, points: &mut Vec<Vec3>) {
    let level = shell.center().y + height * shell.height();
    let is_below = |point: &Vec3| point.y < level;
    let Some(first) = points.iter().skip(1).position(is_below) else {
        let (hung, tip) = (points.len() - 1, points[points.len() - 1]);
        let end = tip.with_y(level.min(tip.y - 1e-3));
        points.extend((1..=LED_DOWN).map(|i| tip.lerp(end, i as f32 / LED_DOWN as f32)));
        keep_clear(&mut points[hung..], shell);
        return;
    };
    let [above, below] = [points[first], points[first + 1]];
    let t = (above.y - level) / (above.y - below.y).max(1e-6);
    points.truncate(first + 1);
    // A root below the level leaves a stub.
    points.push(above.lerp(below, t.clamp(0.1, 1.0)));
}

/// Rounds the corners where hair leaves the head, or was kept out of it.
fn smooth_corners(points: &mut [Vec3]) {
    let mut before = points[0];
    for i in 1..points.len() - 1 {
        let here = points[i];
        points[i] = 0.5 * here + 0.25 * (before + points[i + 1]);
        before = here;
    }
}

/// The middle line of hair that hangs.
struct Axis<'a> {
    zone: &'a Zone,
    shell: &'a Shell,
    start: Vec3,
    heading: Vec3,
    down: Vec3,
    away: Vec3,
    sideways: Vec3,
    sway: f32,
    /// Sideways leans of the zone: one that grows, and one that turns.
    sweep: f32,
    s_curve: f32,
    length_m: f32,
    /// How near the skin a point may come, head heights.
    gap: f32,
}

impl<'a> Axis<'a> {
    fn new(
        zone: &'a Zone,
        hanging: &Hanging,
        shell: &'a Shell,
        points: &[Vec3],
        sway: f32,
    ) -> Self {
        let start = points[points.len() - 1];
        let outward = shell.lift_of(start).1;
        let away = outward.with_y(0.0).normalize_or(Vec3::Z);
        let heading = match points.len() {
            1 => outward,
            n => (start - points[n - 2]).normalize_or(outward),
        };
        Self {
            zone,
            shell,
            start,
            heading,
            down: (Vec3::NEG_Y + away * zone.spread).normalize_or(Vec3::NEG_Y),
            away,
            sideways: Vec3::Y.cross(away),
            sway,
            sweep: zone.sweep * hanging.side * hanging.swing,
            s_curve: zone.s_curve * hanging.side * hanging.swing,
            length_m: hanging.length_m,
            gap: CLOSEST * hanging.size / 300.0,
        }
    }

    /// `count` places on the axis with their headings. Steps are shorter near the start, where it
    /// bends.
    fn walk(&self, count: usize) -> Vec<(Vec3, Vec3)> {
        let zone = self.zone;
        let (mut place, mut heading, mut before) = (self.start, self.heading, 0.0);
        let mut places = Vec::with_capacity(count);
        for step in 1..=count {
            let t = step as f32 / count as f32;
            let at = t * (0.5 + 0.5 * t);
            let length_m = (at - before) * self.length_m;
            before = at;
            let turn = zone.weight * length_m / self.shell.height();
            let turn = turn / (turn + (1.0 - zone.weight) * BEND).max(1e-6);
            let (_, turning) = sin_cos_turns(at);
            let lean = (self.sway + self.sweep) * at + self.s_curve * turning;
            let down = self.down + self.sideways * lean;
            heading = heading.lerp(down, turn).normalize_or(self.down);
            let flicked = heading + self.away * (zone.flick * at * at);
            let flicked = flicked.normalize_or(heading);
            place = self.shell.keep_out(place + flicked * length_m, self.gap);
            places.push((place, flicked));
        }
        places
    }

    /// Radius of gathered hair at share `t` of the points, metres: it bursts from the tie, is fullest
    /// at its `swell`, and gathers again.
    fn fullness(&self, t: f32) -> f32 {
        let at = t * (0.5 + 0.5 * t);
        let swell = self.zone.swell;
        let left = 1.0 - (at / swell).min(1.0);
        let burst = 1.0 - left * left;
        let gather = 1.0 - 0.6 * smooth((at - swell) / (1.0 - swell).max(1e-3));
        self.zone.fullness * self.shell.height() * (0.12 + 0.88 * burst) * gather
    }
}
