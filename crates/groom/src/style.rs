//! Hair styles: zones of clumps, grown on any head.

use crate::random::Random;
use crate::shell::{Place, Shell, direction};
use glam::Vec3;
use hair_sim::Strands;

/// Points of a clump on the head, and of what hangs from it.
const ON_HEAD: usize = 8;
const HANGING: usize = 9;
/// Ids of a zone's clumps begin at its number times this; those of the mirrored half in the middle.
const IDS_A_ZONE: u32 = 10_000;
/// Most clumps of one side of a zone.
pub const MOST_CLUMPS: u32 = IDS_A_ZONE / 2;
/// How near the skin a point may come, head heights.
const CLOSEST: f32 = 0.01;

/// A hair style.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Seed of all variations.
    pub seed: u32,
    /// The zones.
    pub zones: Vec<Zone>,
}

/// A row of clumps, or a tail.
///
/// A clump starts at its place on the line of roots, runs over the head to its place on the line of
/// tips, and hangs from there. Lengths are in head heights, angles in degrees, sizes in 1/300 of the
/// head's height.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    /// Its name; variations hang on it.
    pub name: String,
    /// Clumps on each side.
    pub count: u32,
    /// The line of roots: the clumps stand along it, evenly. One place for a tail.
    pub roots: Vec<Place>,
    /// The line that the clumps lead to; nothing to hang from the roots at once.
    pub tips: Vec<Place>,
    /// Also on the head's other side, with variations of its own.
    pub mirror: bool,
    /// Height above the skin where it is greatest.
    pub lift: f32,
    /// Height above the skin at the roots.
    pub root_lift: f32,
    /// Length that hangs.
    pub hang: f32,
    /// How soon hanging hair turns down: 0 keeps its way, 1 at once.
    pub weight: f32,
    /// Lean away from the head while it hangs; below 0 towards it.
    pub spread: f32,
    /// Turn of the tip away from the head; below 0 towards it.
    pub flick: f32,
    /// Radius of a tail where it is fullest; 0 is a row.
    pub fullness: f32,
    /// Radius of a clump at its full size.
    pub size: f32,
    /// How many clumps are of a middle or small size, 0 to 1.
    pub mixed_sizes: f32,
    /// How much places differ, degrees.
    pub scatter: f32,
    /// How much hanging lengths differ, 0 to 1.
    pub length_variation: f32,
}

/// Grows a style on a head.
///
/// Every clump has its size, and an id that only its zone's place in the list and its own number
/// decide.
#[must_use]
pub fn grow(style: &Style, shell: &Shell) -> Strands {
    let mut strands = Strands::new();
    for (number, zone) in (0u32..).zip(&style.zones) {
        let sides: &[bool] = if zone.mirror {
            &[false, true]
        } else {
            &[false]
        };
        for &is_mirrored in sides {
            for index in 0..zone.count.min(MOST_CLUMPS) {
                let half = u32::from(is_mirrored) * MOST_CLUMPS;
                let mut random = Random::new(style.seed, &zone.name, half + index);
                let (mut points, size) = clump(zone, index, shell, &mut random);
                if is_mirrored {
                    // On a head that is not quite even the clump still stands on its skin.
                    mirror(&mut points, shell);
                }
                let id = number.wrapping_mul(IDS_A_ZONE).wrapping_add(half + index);
                // Points come from a shell of finite radii, so none is refused.
                let _ = strands.push(id, &points, Some(size));
            }
        }
    }
    strands
}

/// One clump's points from root to tip, and its size.
fn clump(zone: &Zone, index: u32, shell: &Shell, random: &mut Random) -> (Vec<Vec3>, f32) {
    let along = if zone.count > 1 {
        index as f32 / (zone.count - 1) as f32
    } else {
        0.5
    };
    let scatter = |random: &mut Random, place: Place| Place {
        longitude: place.longitude + zone.scatter * random.around_zero(),
        latitude: place.latitude + zone.scatter * random.around_zero(),
    };
    let root = direction(scatter(random, on_line(&zone.roots, along)));
    let size = zone.size * size_class(zone, random);
    let length = zone.hang * (1.0 + zone.length_variation * random.around_zero());

    let mut points = Vec::with_capacity(ON_HEAD + HANGING);
    points.push(shell.above(root, zone.root_lift));
    if !zone.tips.is_empty() {
        let tip = direction(scatter(random, on_line(&zone.tips, along)));
        for step in 1..ON_HEAD {
            let t = step as f32 / (ON_HEAD - 1) as f32;
            let lift = zone.root_lift + (zone.lift - zone.root_lift) * arch(t);
            points.push(shell.above(root.lerp(tip, eased(t)), lift));
        }
    }
    if length > 0.0 {
        let place_in_tail = tail_place(index, zone.count);
        hang(
            zone,
            length * shell.height(),
            place_in_tail,
            shell,
            random,
            &mut points,
        );
    }
    (points, size)
}

/// Lets a clump hang on from its last point.
fn hang(
    zone: &Zone,
    length_m: f32,
    place_in_tail: [f32; 2],
    shell: &Shell,
    random: &mut Random,
    points: &mut Vec<Vec3>,
) {
    let start = points[points.len() - 1];
    let outward = shell.lift_of(start).1;
    let away = outward.with_y(0.0).normalize_or(Vec3::Z);
    let sideways = Vec3::Y.cross(away);
    let mut heading = match points.len() {
        1 => outward,
        n => (start - points[n - 2]).normalize_or(outward),
    };
    let down = (Vec3::NEG_Y + away * zone.spread).normalize_or(Vec3::NEG_Y);
    let sway = sideways * (0.12 * random.around_zero());
    let step_m = length_m / HANGING as f32;
    let mut axis = start;
    for step in 1..=HANGING {
        let t = step as f32 / HANGING as f32;
        heading = heading
            .lerp(down + sway * t, zone.weight)
            .normalize_or(down);
        let flicked = heading + away * (zone.flick * t * t);
        axis += flicked.normalize_or(heading) * step_m;
        // A tail swells below its tie and gathers towards its end.
        let swell = zone.fullness * shell.height() * (arch(t * 0.85) + 0.25 * t);
        let [out, side] = place_in_tail;
        axis = shell.keep_out(axis, CLOSEST);
        let point = axis + (away * out + sideways * side) * swell;
        let point = shell.keep_out(point, CLOSEST);
        points.push(point);
    }
}

/// The place of a tail's clump in its round section, evenly spread: Vogel's spiral.
fn tail_place(index: u32, count: u32) -> [f32; 2] {
    /// The golden angle in turns, as the rotation of one step: its cosine and sine.
    const STEP: [f32; 2] = [-0.737_368_9, 0.675_490_3];
    let mut turn = [1.0_f32, 0.0];
    for _ in 0..index {
        turn = [
            turn[0] * STEP[0] - turn[1] * STEP[1],
            turn[0] * STEP[1] + turn[1] * STEP[0],
        ];
    }
    let radius = ((index as f32 + 0.5) / count as f32).sqrt();
    turn.map(|x| x * radius)
}

/// Full, middle or small: a row of equals looks combed by a machine.
fn size_class(zone: &Zone, random: &mut Random) -> f32 {
    let (which, fine) = (random.unit(), 1.0 + 0.08 * random.around_zero());
    let class = if which >= zone.mixed_sizes {
        1.0
    } else if which >= 0.4 * zone.mixed_sizes {
        0.7
    } else {
        0.42
    };
    class * fine
}

/// The place at share `along` (0 to 1) of a line through these places.
fn on_line(line: &[Place], along: f32) -> Place {
    let at = along.clamp(0.0, 1.0) * (line.len() - 1) as f32;
    let first = (at as usize).min(line.len().saturating_sub(2));
    let (a, b) = (line[first], line[(first + 1).min(line.len() - 1)]);
    let t = at - first as f32;
    Place {
        longitude: a.longitude + (b.longitude - a.longitude) * t,
        latitude: a.latitude + (b.latitude - a.latitude) * t,
    }
}

/// 0 at both ends, 1 in the middle.
fn arch(t: f32) -> f32 {
    4.0 * t * (1.0 - t)
}

/// Slow at both ends.
fn eased(t: f32) -> f32 {
    t * t * (3.0 - 2.0 * t) * 0.5 + t * 0.5
}

/// The image across the middle of the head, kept out of the head there.
fn mirror(points: &mut [Vec3], shell: &Shell) {
    for point in points {
        point.x = 2.0 * shell.center().x - point.x;
        *point = shell.keep_out(*point, 0.0);
    }
}
