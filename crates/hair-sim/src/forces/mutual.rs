//! Hair and hair: links that hold neighbours together and break, and repulsion that keeps volume.
//!
//! After Chang et al. 2002, *A practical model for hair mutual interactions*: guide strands far apart from each other stand
//! for the hair between them, so what they do to each other is sparse. Every strand has a few neighbours by root; every
//! second particle of it is paired with the particle of a neighbour that is nearest at rest. A pair keeps its distance at rest from
//! below (repulsion), and, where it began close enough, its offset in the frame of the strand (a static link), until
//! it is pulled too far apart. The other strand is where its own motion would take it, so that strands stay
//! independent within a step.
//!
//! A pair acts on the strand that it belongs to, not on the other one, whose own nearest may be others: a strand beside a dense bundle is held by it, and
//! hardly holds it. So the momentum of both together isn't kept.

use glam::DVec3;

use crate::lanes::{LANES, Lane, Mask, Number, Vec3};

use super::springs::Spring;

/// How strands act on each other.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Mutual {
    /// Neighbours of a strand, 0 to 16.
    pub neighbours: usize,
    /// Stiffness of links in 1/s^2, 0 to 1e6. In a step of `dt` seconds they are no stiffer than `1 / (neighbours * dt^2)`: 900 of four neighbours at 1/60 s.
    pub link: f64,
    /// Pairs closer than this at rest are linked, in m, 0 to 10.
    pub reach: f64,
    /// A link breaks when its length has changed by this, in m, 0 to 10.
    pub break_at: f64,
    /// Whether a broken link holds again once it is back within a tenth of that.
    pub mends: bool,
    /// Stiffness of repulsion in 1/s^2, 0 to 1e6. In a step it is no stiffer than four times what links are.
    pub repulsion: f64,
    /// Repulsion keeps pairs this far apart, or as far as at rest, whichever is less; in m, 0 to 10.
    pub distance: f64,
}

impl Default for Mutual {
    fn default() -> Self {
        Self {
            neighbours: 4,
            link: 40.0,
            reach: 0.02,
            break_at: 0.02,
            mends: true,
            repulsion: 400.0,
            distance: 0.01,
        }
    }
}

impl Mutual {
    /// The first number that is out of its range, as (name, value, least, most).
    pub(crate) fn out_of_range(&self) -> Option<(&'static str, f64, f64, f64)> {
        [
            ("neighbours", self.neighbours as f64, 0.0, 16.0),
            ("link", self.link, 0.0, 1e6),
            ("reach", self.reach, 0.0, 10.0),
            ("break_at", self.break_at, 0.0, 10.0),
            ("repulsion", self.repulsion, 0.0, 1e6),
            ("distance", self.distance, 0.0, 10.0),
        ]
        .into_iter()
        .find(|(_, value, least, most)| !(least..=most).contains(&value))
    }
}

/// All links of a particle together, and all that push it off, are at most so stiff, over the square of the step. A partner is where its own motion would take it: what
/// is much faster than a step overshoots it, and both swing against each other more and more, links from between 1 and 2 on, what
/// only pushes from some 70 on.
const STIFFEST_LINKS: f64 = 1.0;
const STIFFEST_REPULSION: f64 = 4.0;

impl Mutual {
    /// The share of a particle's own acceleration that its partners are expected to have in a step of `dt` seconds. All of it
    /// where springs of this stiffness (1/s^2) are slow beside the step, so that strands that move together don't hold each other
    /// back, with an error of second order; nothing where they are fast: two strands that swing against each other would go on to do
    /// so more and more.
    fn alike(&self, stiffness: f64, dt: f64) -> f64 {
        1.0 / (1.0 + self.neighbours as f64 * stiffness * dt * dt)
    }
}

/// A particle of every strand of a batch, and its partner.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    /// The particle's place on the strand.
    pub at: usize,
    /// The partner's index in the list of all particles.
    pub other: [u32; LANES],
    /// Where there is a partner.
    pub on: Mask,
    /// Where the pair is linked.
    pub linked: Mask,
    /// From the particle to its partner at rest, in the frame of the particle's link, and its length.
    pub offset: Vec3,
    pub length: Lane,
}

/// Where a particle is at the start of a step, and where it goes by itself.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Course {
    pub before: DVec3,
    pub now: DVec3,
}

/// What a batch's pairs did in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counts {
    pub links: usize,
    pub repulsions: usize,
    /// The strands that any of them pulls or pushes.
    pub acts_on: Mask,
}

impl Counts {
    const NONE: Self = Self {
        links: 0,
        repulsions: 0,
        acts_on: Mask::NONE,
    };
}

/// The start and end of a step of one batch, for [`act`].
pub(crate) struct Own<'a> {
    /// Particles from the root, and frames, at the start.
    pub y: &'a [Vec3],
    /// Their accelerations, where they are known.
    pub a: &'a [Vec3],
    pub known: Mask,
    pub frames: &'a [crate::lanes::Quat],
    pub root_before: Vec3,
    pub root_now: Vec3,
    pub gamma: f64,
    pub dt: f64,
}

/// The springs of a particle to its partners, all of which it has the same acceleration from.
struct Pulls<T> {
    /// Sums of stiffness in 1/s^2 and of damping rate in 1/s, and of both times the share of acceleration that a partner has.
    stiffness: T,
    rate: T,
    shared_stiffness: T,
    shared_rate: T,
    /// Sums of stiffness times place at the start, and times way in the step; of rate times way.
    before: Vec3<T>,
    way: Vec3<T>,
    rate_way: Vec3<T>,
}

impl<T: Number> Pulls<T> {
    #[inline(always)]
    fn none() -> Self {
        let (zero, nowhere) = (T::splat(0.0), Vec3::zero());
        Self {
            stiffness: zero,
            rate: zero,
            shared_stiffness: zero,
            shared_rate: zero,
            before: nowhere,
            way: nowhere,
            rate_way: nowhere,
        }
    }

    /// Adds springs of a kind in the strands of `here` to places that go some `way` from `to` in the step.
    #[inline(always)]
    fn add(&mut self, kind: &Kind, here: Mask, to: Vec3<T>, way: Vec3<T>) {
        let (here, zero) = (T::condition(&here), T::splat(0.0));
        let stiffness = T::choose(here, T::splat(kind.stiffness), zero);
        let rate = T::choose(here, T::splat(kind.rate), zero);
        let alike = T::splat(kind.alike);
        self.stiffness = self.stiffness + stiffness;
        self.rate = self.rate + rate;
        self.shared_stiffness = self.shared_stiffness + stiffness * alike;
        self.shared_rate = self.shared_rate + rate * alike;
        self.before += to.scale(stiffness);
        self.way += way.scale(stiffness);
        self.rate_way += way.scale(rate);
    }

    /// As [`Spring::pull`] one after the other.
    #[inline(always)]
    fn add_to(self, spring: &mut Spring, a: Vec3<T>, gamma: f64, dt: f64) {
        let (square, flow) = (0.5 * dt * dt, self.rate_way * (1.0 / dt));
        let more = Spring {
            stiffness: self.stiffness,
            rate: self.rate,
            mid: self.before
                + self.way * gamma
                + a.scale(self.shared_stiffness) * (square * gamma * gamma),
            end: self.before + self.way + a.scale(self.shared_stiffness) * square,
            flow_mid: flow + a.scale(self.shared_rate) * (dt * gamma),
            flow_end: flow + a.scale(self.shared_rate) * dt,
        };
        spring.add(more);
    }
}

/// A kind of spring between strands: its stiffness in 1/s^2, its damping rate in 1/s, and the share of a particle's own
/// acceleration that its partner is expected to have.
struct Kind {
    stiffness: f64,
    rate: f64,
    alike: f64,
}

impl Kind {
    fn new(mutual: &Mutual, stiffness: f64, stiffest: f64, dt: f64) -> Self {
        let most = stiffest / (mutual.neighbours.max(1) as f64 * dt * dt);
        let stiffness = stiffness.min(most);
        Self {
            stiffness,
            rate: 2.0 * stiffness.sqrt(),
            alike: mutual.alike(stiffness, dt),
        }
    }
}

/// Adds the pairs of a batch, in the order of their particles, to its springs. `broken` are the links that hold no more.
pub(crate) fn act<T: Number>(
    mutual: &Mutual,
    (pairs, courses): (&[Pair], &[Course]),
    own: &Own,
    broken: &mut [[bool; LANES]],
    springs: &mut [Spring],
) -> Counts {
    T::run(
        #[inline(always)]
        move || {
            let mut counts = Counts::NONE;
            let link = Kind::new(mutual, mutual.link, STIFFEST_LINKS, own.dt);
            let repulsion = Kind::new(mutual, mutual.repulsion, STIFFEST_REPULSION, own.dt);
            let (root_before, root_now) = (own.root_before.load::<T>(), own.root_now.load::<T>());
            let mut left = broken;
            for pairs in pairs.chunk_by(|one, next| one.at == next.at) {
                let broken;
                (broken, left) = left.split_at_mut(pairs.len());
                let at = pairs[0].at;
                let y = own.y[at].load::<T>();
                let frame = own.frames[at].load::<T>();
                let mut pulls = Pulls::none();
                for (pair, broken) in pairs.iter().zip(broken) {
                    let others = pair.other.map(|other| &courses[other as usize]);
                    let before = gather(|lane| &others[lane].before) - root_before;
                    let way = gather(|lane| &others[lane].now) - root_now - before;
                    let apart = before - y;
                    let size = apart.length_squared().sqrt();
                    let length = size.store();

                    let holds = pair.linked.and(still_holds(mutual, pair, length, broken));
                    let keep = pair.length.min(Lane::splat(mutual.distance));
                    let close = pair.on.and(length.lt(keep * 0.999));
                    counts.links += holds.count();
                    counts.repulsions += close.count();
                    counts.acts_on = counts.acts_on.or(holds).or(close);
                    if holds.any() {
                        let to = before - frame.rotate(pair.offset.load());
                        pulls.add(&link, holds, to, way);
                    }
                    if close.any() {
                        // Away along the line between them; strands in one place stay together.
                        let least = Lane::splat(1e-9);
                        let away = (keep / length.max(least)).min(Lane::splat(10.0));
                        let pushes = close.and(length.gt(least));
                        let to = before - apart.scale(away.load());
                        pulls.add(&repulsion, pushes, to, way);
                    }
                }
                let a = own.a[at].load::<T>();
                let a = Vec3::choose(T::condition(&own.known), a, Vec3::zero());
                pulls.add_to(&mut springs[at], a, own.gamma, own.dt);
            }
            counts
        },
    )
}

/// Whether the links of a pair, which are `length` long, hold; `broken` are those that do not.
#[inline(always)]
fn still_holds(mutual: &Mutual, pair: &Pair, length: Lane, broken: &mut [bool; LANES]) -> Mask {
    let stretch = (length - pair.length).max(pair.length - length);
    let torn = stretch.gt(Lane::splat(mutual.break_at));
    if *broken == [false; LANES] && !torn.any() {
        return Mask::NONE.not();
    }
    let back = stretch.lt(Lane::splat(0.1 * mutual.break_at));
    let mended = if mutual.mends { back } else { Mask::NONE };
    let gone = Mask::new(*broken).or(torn).and(mended.not());
    *broken = gone.and(pair.linked).bools();
    gone.not()
}

/// The vectors of the batch's strands side by side.
#[inline(always)]
fn gather<'a, T: Number>(of: impl Fn(usize) -> &'a DVec3) -> Vec3<T> {
    let lanes = |coordinate: fn(&DVec3) -> f64| {
        Lane(std::array::from_fn(|lane| coordinate(of(lane)))).load()
    };
    Vec3::new(lanes(|v| v.x), lanes(|v| v.y), lanes(|v| v.z))
}
