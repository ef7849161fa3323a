//! Merged highlights (Shin, Haller, Mukundan, section 3.4.2, Figs 13 to 16): what shines on neighbouring strands is joined to one strip around
//! the head.
//!
//! There, particles brighter than a threshold are averaged in groups, and the means of neighbours are linked: groups come and go from frame to
//! frame, and the strip jumps. Here each strand is linked to the same neighbour in every frame, means are weighted by how far the brightness is
//! above the threshold, and so is the strip's width: it grows from nothing. Where hair is dense the strands that are linked are means of those around
//! them, which are chosen once, by the hair at rest; and where a strip ends it runs out in a point.

use effects::wgsl::power;
use effects::{Grid, Hair, HairStrand, MadePaths};
use glam::Vec3;
use rayon::prelude::*;

mod locks;
mod merge;

use locks::Lock;

effects::effect!("zigzag");

/// `hair.zigzag`: strips of light from strand to strand.
pub struct Zigzag;

/// Places along a strand at which its brightness is looked at.
const PLACES: usize = 24;

/// Half the stretch over which a strand's direction is taken, in parts of its length: particles' links meet in corners.
const STRETCH: f32 = 0.06;

/// Half the stretch over which the lower highlight takes over from the upper one, in parts of the strand.
const BETWEEN: f32 = 0.1;

/// Points of a link.
const POINTS: usize = 7;

/// A highlight of less brightness than this is drawn to the middle of its strand: where it is must not jump as it vanishes.
const FAINT: f32 = 0.2;

/// The lesser end of a link has its full share in the link's width from here on.
const WHOLE: f32 = 0.25;

/// The last part of `longest` over which a link grows from nothing.
const FADE: f32 = 0.4;

/// How much longer than `shortest` a strip is when it is whole, in parts of that.
const LONGER: f32 = 0.25;

impl effects::StrokeEffect for Zigzag {
    type Program = Program;
    const ID: &'static str = "hair.zigzag";
    const DOC: &'static str =
        "highlights of neighbouring strands joined to one strip around the head";
    const RANK: i32 = 220;
    const OWN_PATHS: bool = true;
    const ON_UNDERCOAT: bool = false;
    const CLIP: Option<&'static str> = Some("hair");
    const REACH: f32 = 0.14;

    fn make_paths(params: &Params, hair: &Hair, _seed: u32, paths: &mut MadePaths) {
        // A strip is all on hair that the layer draws on: what lies beside neither takes part in it nor ends it.
        let drawn = hair.strands.iter().enumerate();
        let drawn = drawn.filter(|(_, strand)| strand.is_drawn);
        let (own, strands): (Vec<usize>, Vec<HairStrand>) = drawn.unzip();
        let hair = &Hair {
            strands: &strands,
            ..*hair
        };
        let groups = params.groups as usize;
        let within_m = params.merge * hair.head_height_m;
        let shining = |group: usize| {
            let mut shining: Vec<Highlight> = (hair.strands.par_iter())
                .map(|strand| Highlight::of(params, hair, strand, group, groups))
                .collect();
            if within_m > 0.0 {
                merge::onto_one_line(hair.strands, &mut shining, within_m);
            }
            shining
        };
        let linked = paths.once(|| Linked::of(hair, within_m));
        let (locks, next) = (&linked.locks, &linked.next);
        let strips: Vec<Strip> = (0..groups)
            .map(|group| Strip::of(params, hair, locks, next, &shining(group)))
            .collect();
        for (lock, next) in next.iter().enumerate() {
            let Some(next) = *next else {
                continue;
            };
            let index = locks[lock].strand;
            let strands = [lock, next].map(|lock| &hair.strands[locks[lock].strand]);
            for (group, strip) in strips.iter().enumerate() {
                let ends = [lock, next].map(|lock| (strip.shining[lock], strip.tapers[lock]));
                let link = link(params, hair, strands, ends, strip.shares[lock]);
                paths.push_weighted(own[index], group as u32, link);
            }
        }
    }

    fn extent(params: &Params, strand: &effects::StrandJoints) -> std::ops::Range<usize> {
        let joints = strand.joints;
        strand.extent(|i| joints.path_weight[i] > 0.0 && params.width > 0.0)
    }

    fn reach(params: &Params) -> effects::Reach {
        effects::Reach {
            clumps: 0.0,
            units: 0.5 * params.width,
        }
    }
}

/// What is linked, chosen by the hair at rest.
struct Linked {
    locks: Vec<Lock>,
    /// The lock that is next to each across the hair.
    next: Vec<Option<usize>>,
}

impl Linked {
    fn of(hair: &Hair, within_m: f32) -> Self {
        let locks = locks::of(hair, within_m);
        let neighbors = Neighbors::of(hair, &locks);
        let all = (0..locks.len()).into_par_iter();
        let next = all.map(|lock| neighbors.next_across(lock)).collect();
        Self { locks, next }
    }
}

/// Where a strand shines.
#[derive(Clone, Copy)]
struct Highlight {
    /// Its middle along the strand, 0 to 1.
    place: f32,
    /// How much there is, 0 to 1.
    amount: f32,
}

impl Highlight {
    /// The highlight `group` of so many.
    fn of(params: &Params, hair: &Hair, strand: &HairStrand, group: usize, groups: usize) -> Self {
        let start = params.start.min(1.0);
        let (mut sum, mut sum_of_squares, mut moment) = (0.0, 0.0, 0.0);
        for place in 0..PLACES {
            let u = start + (1.0 - start) * (place as f32 + 0.5) / PLACES as f32;
            let lower = smooth((u - params.split) / (2.0 * BETWEEN) + 0.5);
            let own = match (groups, group) {
                (1, _) => 1.0,
                (_, 0) => 1.0 - lower,
                _ => lower,
            };
            let range = (params.full - params.threshold).max(1e-3);
            let above = (brightness(params, hair, strand, u) - params.threshold) / range;
            let weight = own * above.clamp(0.0, 1.0);
            sum += weight;
            sum_of_squares += weight * weight;
            moment += weight * u;
        }
        let middle = 0.5 * (start + 1.0);
        Self {
            place: (moment + FAINT * middle) / (sum + FAINT),
            amount: sum_of_squares / (sum + FAINT),
        }
    }
}

/// The highlights of locks, and how they are linked.
struct Strip {
    shining: Vec<Highlight>,
    /// How much is left of each where the strip runs out: 1 within it, 0 where it ends.
    tapers: Vec<f32>,
    /// How much there is of the link from each lock to the next.
    shares: Vec<f32>,
}

impl Strip {
    /// Of locks with the next one of each around the head, by the highlights of all strands.
    fn of(
        params: &Params,
        hair: &Hair,
        locks: &[Lock],
        next: &[Option<usize>],
        of_strands: &[Highlight],
    ) -> Self {
        let shining: Vec<Highlight> = locks.iter().map(|lock| lock.mean(of_strands)).collect();
        let share_and_length = |(lock, next): (usize, &Option<usize>)| {
            let Some(next) = *next else {
                return (0.0, 0.0);
            };
            let ends = [lock, next].map(|lock| shining[lock]);
            let strands = [lock, next].map(|lock| &hair.strands[locks[lock].strand]);
            share_and_length_of_link(params, hair, strands, ends)
        };
        let (mut shares, lengths): (Vec<f32>, Vec<f32>) =
            next.iter().enumerate().map(share_and_length).unzip();
        // A strip runs out where it comes from none before or goes on to none.
        let mut from_before = vec![0.0_f32; locks.len()];
        for (next, share) in next.iter().zip(&shares) {
            if let Some(next) = *next {
                from_before[next] = from_before[next].max(*share);
            }
        }
        let ends = from_before.iter().zip(&shares);
        let tapers = ends.map(|(before, after)| before.min(*after)).collect();
        if params.shortest > 0.0 {
            let whole = lengths_of_strips(next, &shares, &lengths);
            for (share, length) in shares.iter_mut().zip(whole) {
                *share *= smooth((length / params.shortest - 1.0) / LONGER);
            }
        }
        Self {
            shining,
            tapers,
            shares,
        }
    }
}

/// How long the strip is that each link belongs to, by the links' lengths and how much there is of each: what hangs on a link of which there is
/// little counts little, so that no strip becomes longer at once.
fn lengths_of_strips(next: &[Option<usize>], shares: &[f32], lengths: &[f32]) -> Vec<f32> {
    let mut before = vec![0.0_f32; next.len()];
    let mut from_here_on = vec![0.0_f32; next.len()];
    for first in 0..next.len() {
        let (mut at, mut share, mut up_to_here) = (first, 1.0, 0.0);
        // No strip has more links than there are: one that goes all around ends there.
        for _ in 0..next.len() {
            let Some(to) = next[at].filter(|_| share > 0.0) else {
                break;
            };
            from_here_on[first] += share * lengths[at];
            up_to_here = shares[at] * (lengths[at] + up_to_here);
            before[to] = before[to].max(up_to_here);
            // Of the link itself all counts, of those after it what it leaves.
            share *= shares[to];
            at = to;
        }
    }
    before
        .iter()
        .zip(from_here_on)
        .map(|(before, after)| before + after)
        .collect()
}

/// How brightly a strand shines at `u` of its way.
fn brightness(params: &Params, hair: &Hair, strand: &HairStrand, u: f32) -> f32 {
    let point = strand.point(u);
    let (light, _) = hair.light.seen_from(point);
    let (along, normal) = along_and_normal(hair, strand, u);
    let facing = match params.kind {
        Params::KIND_BLINN => {
            let to_eye = (hair.eye - point).normalize_or(Vec3::Z);
            let half_way = (light + to_eye).normalize_or_zero();
            // None from behind.
            let lit = smooth(10.0 * light.dot(normal));
            lit * half_way.dot(normal)
        }
        _ => {
            let to_root = -along;
            let weighted = normal * params.weight + to_root * (1.0 - params.weight);
            light.dot(weighted.normalize_or(normal))
        }
    };
    power(facing.max(0.0), params.exponent)
}

/// The strand's direction to its tip.
fn along(strand: &HairStrand, u: f32) -> Vec3 {
    (strand.point(u + STRETCH) - strand.point(u - STRETCH)).normalize_or(Vec3::NEG_Y)
}

/// The strand's direction to its tip, and the normal away from the head across it.
fn along_and_normal(hair: &Hair, strand: &HairStrand, u: f32) -> (Vec3, Vec3) {
    let along = along(strand, u);
    let out = (strand.point(u) - hair.head_center).reject_from_normalized(along);
    (along, out.normalize_or(along.any_orthonormal_vector()))
}

/// Where a highlight on a strand is laid, at `place` of its way.
fn laid_on(params: &Params, hair: &Hair, strand: &HairStrand, place: f32) -> Vec3 {
    let (_, normal) = along_and_normal(hair, strand, place);
    let lift_m = params.lift * 0.5 * strand.size / 300.0 * hair.head_height_m;
    strand.point(place) + lift_m * normal
}

/// How much there is of a link from one strand's highlight to another's, and how long it is, head heights.
fn share_and_length_of_link(
    params: &Params,
    hair: &Hair,
    strands: [&HairStrand; 2],
    ends: [Highlight; 2],
) -> (f32, f32) {
    let [from, to] = [0, 1].map(|end| laid_on(params, hair, strands[end], ends[end].place));
    let length = from.distance(to) / hair.head_height_m;
    let near = ((params.longest - length) / (FADE * params.longest).max(1e-6)).clamp(0.0, 1.0);
    let lesser = ends[0].amount.min(ends[1].amount);
    let within_m = params.merge * hair.head_height_m;
    let on_one_line = match within_m > 0.0 {
        true => {
            let along = [0, 1].map(|end| along(strands[end], ends[end].place));
            merge::on_one_line(
                to - from,
                (along[0] + along[1]).normalize_or_zero(),
                within_m,
            )
        }
        false => 1.0,
    };
    let share = smooth(near) * smooth(lesser / WHOLE) * on_one_line;
    (share, length)
}

/// A link from one strand's highlight to another's of which there is so much, and of the two so much where the strip runs out: its points, and how much
/// of it is there at each. Where it is all of its strip it is a point at both ends, and whole in its middle.
fn link(
    params: &Params,
    hair: &Hair,
    strands: [&HairStrand; 2],
    [(a, taper_a), (b, taper_b)]: [(Highlight, f32); 2],
    share: f32,
) -> impl Iterator<Item = (Vec3, f32)> {
    let at = |end: usize, place: f32| laid_on(params, hair, strands[end], place);
    (0..POINTS)
        .map(move |i| {
            let t = i as f32 / (POINTS - 1) as f32;
            // Beside both strands all the way, so that it follows the hair's shape between them.
            let place = a.place + (b.place - a.place) * t;
            let point = at(0, place).lerp(at(1, place), t);
            let (from, to) = (a.amount * taper_a, b.amount * taper_b);
            let alone = (1.0 - taper_a) * (1.0 - taper_b) * 4.0 * t * (1.0 - t);
            let whole = a.amount + (b.amount - a.amount) * t;
            (point, share * (from + (to - from) * t + whole * alone))
        })
        .collect::<Vec<_>>()
        .into_iter()
}

/// Where a strand is at rest.
#[derive(Clone, Copy)]
struct Beside {
    /// At its root, and a third and two thirds of its way.
    points: [Vec3; 3],
}

impl Beside {
    fn of(strand: &HairStrand) -> Self {
        Self {
            points: [0.0, 0.35, 0.7].map(|u| strand.point_at_rest(u)),
        }
    }

    /// How far the other strand is from it where they are farthest apart, metres.
    fn farthest_m(&self, other: &Self) -> f32 {
        let pairs = self.points.iter().zip(&other.points);
        pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
    }
}

/// How much farther what lies before, behind, above or below a strand counts as its distance than what lies beside it: the next of its own row is its
/// neighbour, not one of a row under it.
const OFF_ROW: f32 = 3.0;

/// The strands that are linked, at rest.
struct Neighbors {
    all: Vec<Beside>,
    /// By their middles.
    grid: Grid,
    head_center: Vec3,
}

impl Neighbors {
    fn of(hair: &Hair, locks: &[Lock]) -> Self {
        let strands = locks.iter().map(|lock| &hair.strands[lock.strand]);
        let all: Vec<Beside> = strands.map(Beside::of).collect();
        let middles = all.iter().map(|strand| strand.points[1]).enumerate();
        // Some strands in each cube: a head's surface has about so many squares of this size.
        let edge_m = 6.0 * hair.head_height_m / (all.len() as f32).sqrt().max(1.0);
        Self {
            grid: Grid::new(middles, edge_m.max(1e-4)),
            all,
            head_center: hair.head_center_at_rest,
        }
    }

    /// The strand that is next to strand `index` across the hair, of hair that hangs counterclockwise around the head: the nearest of those that are more
    /// beside it than above, behind, or farther along it.
    fn next_across(&self, index: usize) -> Option<usize> {
        let own = &self.all[index];
        let middle = own.points[1] - self.head_center;
        let across = middle
            .cross(own.points[2] - own.points[0])
            .normalize_or(Vec3::X);
        let distance = |other: &Beside| -> f32 {
            let pairs = own.points.iter().zip(&other.points);
            let apart = |way: Vec3| {
                let beside = way.dot(across) * across;
                (beside + OFF_ROW * (way - beside)).length()
            };
            pairs.map(|(a, b)| apart(*b - *a)).sum()
        };
        let is_beside = |other: &Beside| {
            let way: Vec3 = (own.points.iter().zip(&other.points))
                .map(|(a, b)| *b - *a)
                .sum();
            2.0 * way.dot(across) > way.length() && way.length() > 0.0
        };
        let nearest = self.grid.nearest(own.points[1], 1, |other| {
            let beside = &self.all[other];
            (other != index && is_beside(beside)).then(|| distance(beside))
        });
        nearest.first().copied()
    }
}

/// 0 to 1 as `t` goes from 0 to 1, without corners.
fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use effects::{Light, Parameters as _, StrokeEffect as _, Values};

    #[test]
    fn it_conforms() {
        effects_testkit::assert_conforms::<Zigzag>();
    }

    /// Strands from the top of a head of 0.24 m down its sides, all around it.
    fn cap(count: usize) -> Vec<Vec<Vec3>> {
        let strand = |i: usize| {
            let angle = std::f32::consts::TAU * i as f32 / count as f32;
            let out = Vec3::new(angle.sin(), 0.0, angle.cos());
            let point = |k: usize| {
                let down = 0.15 + 0.14 * k as f32;
                0.12 * (down.cos() * Vec3::Y + down.sin() * out)
            };
            (0..11).map(point).collect()
        };
        (0..count).map(strand).collect()
    }

    fn params(set: &[(&str, &str)]) -> Params {
        let mut values = Values::defaults(Program::PARAMS);
        for (name, text) in set {
            values.set_text(Zigzag::ID, name, text).unwrap();
        }
        Program::params(&values)
    }

    /// Each path's points with their weights.
    fn made(strands: &[Vec<Vec3>], light: Vec3, set: &[(&str, &str)]) -> Vec<Vec<(Vec3, f32)>> {
        made_of(strands, |_| true, light, set)
            .into_iter()
            .map(|(_, path)| path)
            .collect()
    }

    /// The same where some strands are drawn alone, each with its strand.
    fn made_of(
        strands: &[Vec<Vec3>],
        is_drawn: impl Fn(u32) -> bool,
        light: Vec3,
        set: &[(&str, &str)],
    ) -> Vec<(usize, Vec<(Vec3, f32)>)> {
        let strands: Vec<HairStrand> = (0..)
            .zip(strands)
            .map(|(id, particles)| HairStrand {
                id,
                particles,
                at_rest: particles,
                size: 12.0,
                is_drawn: is_drawn(id),
            })
            .collect();
        let hair = Hair {
            strands: &strands,
            head_center: Vec3::ZERO,
            head_center_at_rest: Vec3::ZERO,
            head_height_m: 0.24,
            light: Light::Direction(light),
            eye: Vec3::new(0.0, 0.0, 1.5),
        };
        let mut paths = MadePaths::default();
        Zigzag::make_paths(&params(set), &hair, 1, &mut paths);
        assert_eq!(paths.fault(), None);
        let path = |path: effects::MadePath| {
            let weights = path.weights.iter().copied();
            let points = path.points.iter().copied().zip(weights);
            (path.strand, points.collect())
        };
        paths.iter().map(path).collect()
    }

    fn weights(paths: &[Vec<(Vec3, f32)>]) -> impl Iterator<Item = f32> {
        paths.iter().flatten().map(|(_, weight)| *weight)
    }

    const FROM_ABOVE: Vec3 = Vec3::new(0.0, 0.8, 0.6);

    /// Shin's Fig 14: strands shine, what shines is averaged, the means of neighbours are linked.
    #[test]
    fn what_shines_on_neighbours_is_linked() {
        let paths = made(&cap(24), FROM_ABOVE, &[]);
        assert_eq!(paths.len(), 24);
        // The side of the light has it, the other has none.
        for (i, path) in paths.iter().enumerate() {
            let toward = path.iter().all(|(point, _)| point.z > 0.085);
            let away = path.iter().all(|(point, _)| point.z < -0.08);
            let widest = path.iter().map(|(_, weight)| *weight).fold(0.0, f32::max);
            assert!(!toward || widest > 0.5, "{i}: {widest}");
            assert!(!away || widest == 0.0, "{i}: {widest}");
        }
        // Each ends where the next one begins, in place and width.
        let next = |path: &[(Vec3, f32)]| {
            let (end, _) = path[POINTS - 1];
            let distance = |other: &&Vec<(Vec3, f32)>| other[0].0.distance(end);
            let nearest = paths
                .iter()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)));
            nearest.map(|other| distance(&other)).unwrap()
        };
        assert!(paths.iter().all(|path| next(path) < 1e-5));
    }

    #[test]
    fn nothing_is_drawn_where_nothing_shines() {
        let dark = made(&cap(24), FROM_ABOVE, &[("threshold", "1"), ("full", "1")]);
        assert!(weights(&dark).all(|weight| weight == 0.0));
        let below = made(&cap(24), -Vec3::Y, &[]);
        assert!(weights(&below).all(|weight| weight == 0.0));
        // Everything shines: all strands are linked, whole.
        let all = made(
            &cap(24),
            FROM_ABOVE,
            &[("exponent", "1"), ("threshold", "0"), ("full", "0")],
        );
        assert!(weights(&all).filter(|weight| *weight > 0.9).count() > 24 * POINTS / 2);
        assert!(made(&cap(1), FROM_ABOVE, &[]).is_empty());
        assert!(made(&[], FROM_ABOVE, &[]).is_empty());
    }

    /// Of strands that the layer doesn't draw on it is as if they weren't there.
    #[test]
    fn a_strip_is_all_on_what_is_drawn() {
        let all = cap(24);
        let is_drawn = |strand: u32| !(3..9).contains(&strand);
        let own: Vec<usize> = (0..24).filter(|i| is_drawn(*i as u32)).collect();
        let some: Vec<Vec<Vec3>> = own.iter().map(|i| all[*i].clone()).collect();
        for merge in ["0", "0.1"] {
            let set = [("merge", merge)];
            let of_some = made_of(&some, |_| true, FROM_ABOVE, &set);
            let expected: Vec<_> = (of_some.into_iter())
                .map(|(strand, path)| (own[strand], path))
                .collect();
            assert!(expected.len() > 6);
            assert_eq!(made_of(&all, is_drawn, FROM_ABOVE, &set), expected);
        }
    }

    #[test]
    fn links_break_at_partings() {
        // Every strand but a wedge.
        let mut strands = cap(24);
        strands.drain(0..3);
        let whole = weights(&made(&cap(24), FROM_ABOVE, &[]))
            .filter(|w| *w > 0.0)
            .count();
        let parted = made(&strands, FROM_ABOVE, &[("longest", "0.2")]);
        let crosses = |path: &&Vec<(Vec3, f32)>| {
            path[0].0.x < 0.0 && path[POINTS - 1].0.x > 0.0 && path[0].0.z > 0.0
        };
        let across: Vec<_> = parted.iter().filter(crosses).collect();
        assert!(whole > 0 && !across.is_empty());
        // Beside the parting the strip goes on from strand to strand, and runs out in points.
        let is_there =
            |path: &&Vec<(Vec3, f32)>| path[1..POINTS - 1].iter().all(|(_, weight)| *weight > 0.0);
        let ends = |path: &Vec<(Vec3, f32)>| [0, POINTS - 1].map(|end| path[end].1);
        let linked: Vec<_> = parted.iter().filter(is_there).map(ends).collect();
        let points = linked.iter().flatten().filter(|weight| **weight == 0.0);
        assert!(linked.len() > 3 && points.count() == 4, "{linked:?}");
        assert!(
            across
                .iter()
                .all(|path| path.iter().all(|(_, weight)| *weight == 0.0))
        );
    }

    /// Where light falls on two locks alone, they have a strip: a point at both ends, and whole between.
    #[test]
    fn a_strip_of_one_link_is_there() {
        let made = made(&cap(24)[..2], FROM_ABOVE, &[]);
        let [link] = &made[..] else {
            panic!("{made:?}");
        };
        assert_eq!([link[0].1, link[POINTS - 1].1], [0.0; 2]);
        let widest = link.iter().map(|(_, weight)| *weight).fold(0.0, f32::max);
        assert!((0.3..=1.0).contains(&widest), "{widest}");
    }

    /// As the light goes down behind the head strips become shorter, and none is there that is shorter than an author says.
    #[test]
    fn no_strip_is_shorter_than_an_author_says() {
        let lights = |set: &[(&str, &str)]| {
            let lengths = (0..60).flat_map(|i| {
                let down = 0.05 * i as f32;
                let light = Vec3::new(0.0, down.cos(), down.sin());
                strips(&made(&cap(24), light, set))
            });
            lengths.fold(f32::INFINITY, f32::min)
        };
        assert!(lights(&[]) < 0.3, "{}", lights(&[]));
        let shortest = lights(&[("shortest", "0.6")]);
        assert!((0.6..2.0).contains(&shortest), "{shortest}");
    }

    /// How long each strip of links is that one sees, head heights: a tenth of the width and less is a hairline.
    fn strips(paths: &[Vec<(Vec3, f32)>]) -> Vec<f32> {
        let is_there = |path: &&Vec<(Vec3, f32)>| path.iter().any(|(_, weight)| *weight > 0.1);
        let there: Vec<_> = paths.iter().filter(is_there).collect();
        let goes_on =
            |from: &[(Vec3, f32)], to: &[(Vec3, f32)]| from[POINTS - 1].0.distance(to[0].0) < 1e-5;
        let is_first = |path: &&&Vec<(Vec3, f32)>| !there.iter().any(|other| goes_on(other, path));
        let length = |first: &&Vec<(Vec3, f32)>| {
            let next =
                |path: &&Vec<(Vec3, f32)>| there.iter().copied().find(|other| goes_on(path, other));
            let links = std::iter::successors(Some(*first), next).take(paths.len());
            let lengths = links.map(|path| path[0].0.distance(path[POINTS - 1].0));
            lengths.sum::<f32>() / 0.24
        };
        there.iter().filter(is_first).map(length).collect()
    }

    /// Eight strands for each one: means of those beside each other are linked, as few as without them.
    #[test]
    fn strands_of_dense_hair_stand_for_those_around_them() {
        let dense = made(&cap(240), FROM_ABOVE, &[("merge", "0.4")]);
        let shortest = (dense.iter())
            .map(|path| path[0].0.distance(path[POINTS - 1].0))
            .fold(f32::INFINITY, f32::min);
        assert!((12..40).contains(&dense.len()), "{}", dense.len());
        assert!(shortest > 0.01, "{shortest}");
    }

    /// A row under another one, nearer than the row's own neighbours: links stay within their rows.
    #[test]
    fn links_stay_within_their_rows() {
        let inner: Vec<Vec<Vec3>> = (cap(24).iter())
            .map(|strand| strand.iter().map(|point| 0.9 * *point).collect())
            .collect();
        let both: Vec<_> = cap(24).into_iter().chain(inner).collect();
        let paths = made(&both, FROM_ABOVE, &[("lift", "0")]);
        assert_eq!(paths.len(), 48);
        for path in &paths {
            let [from, to] = [0, POINTS - 1].map(|i| path[i].0.length());
            assert!((from - to).abs() < 1e-3, "{from}, {to}");
        }
    }

    /// As the light goes round nothing jumps: half of the step is about half of the change.
    #[test]
    fn it_grows_from_nothing_and_never_jumps() {
        let light = |degrees: f32| {
            let angle = degrees.to_radians();
            Vec3::new(0.6 * angle.sin(), 0.8, 0.6 * angle.cos())
        };
        for set in [
            ("groups", "1"),
            ("groups", "2"),
            ("merge", "0.6"),
            ("shortest", "0.4"),
        ] {
            let at = |degrees: f32| made(&cap(24), light(degrees), &[set]);
            let farthest = |step: f32| {
                let steps = (360.0 / step) as usize;
                let mut farthest = (0.0_f32, 0.0_f32);
                let mut before = at(0.0);
                for i in 1..=steps {
                    let now = at(step * i as f32);
                    for (a, b) in before.iter().flatten().zip(now.iter().flatten()) {
                        farthest.0 = farthest.0.max(a.0.distance(b.0));
                        farthest.1 = farthest.1.max((a.1 - b.1).abs());
                    }
                    before = now;
                }
                farthest
            };
            let (coarse, fine) = (farthest(1.0), farthest(0.5));
            assert!(
                coarse.0 > 1.7 * fine.0 && coarse.1 > 1.7 * fine.1,
                "{coarse:?}, {fine:?}"
            );
        }
    }
}
