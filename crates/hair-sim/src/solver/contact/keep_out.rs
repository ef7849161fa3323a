//! Taking strands out of bodies at the end of a step.
//!
//! Planes are found from where particles go by themselves. What is thrown over a thin body, or drawn round it fast, goes elsewhere in one step, and
//! may be in it then, or behind it. So from root to tip every link that is turns out of it about its start.

use glam::{DQuat, DVec3};

use crate::{
    collision::shape::{Collider, LEADS_OUT},
    lanes::{LANES, Lane, Mask, Number},
};

use super::{
    super::batch::{Batch, BatchState},
    PUSH_OUT, WEDGED_OUT,
    find::{Bodies, Ways},
    guard::Guard,
    link::{CROSSES, lowest},
    path::Path,
};

/// A link that is deeper in a body than the first of these, in m, is turned until it is no deeper than the second, by so many turns at most.
const DEEP: f64 = 4e-4;
const OUT: f64 = 1e-4;
const MOST_TURNS: usize = 12;
/// After so many of them, each goes the shortest way out: what went in elsewhere may be out of its reach.
const BY_WAYS: usize = 4;

/// Strands whose particles are no farther than this, in m, from where they were expected are not looked at: their planes hold them.
const EXPECTED: f64 = 3e-4;

/// A place that is so near to its link's start, as a share of the link, moves as if it were there.
const LEAST_SHARE: f64 = 0.1;

/// A place outside of a body has passed through it where its normal has turned from that of the place where it went in, by this cosine.
const OTHER_SIDE: f64 = 0.0;

/// Turns links out of bodies, in the strands of `active`. Returns the strands where any was.
pub(crate) fn keep_out<T: Number>(
    batch: &Batch,
    state: &mut BatchState,
    bodies: &Bodies,
    ways: &mut Ways,
    active: Mask,
) -> Mask {
    let mut near = Mask::NONE;
    T::run(
        #[inline(always)]
        || {
            let expected = Lane::splat(EXPECTED * EXPECTED);
            for k in 0..batch.count() {
                let to = bodies.now.load::<T>() + state.y[k].load();
                let off = (to - ways.to[k].load())
                    .length_squared()
                    .store()
                    .gt(expected);
                ways.to[k] = to.store();
                ways.near[k] = Mask::NONE;
                if off.and(active).any() {
                    ways.near[k] = ways
                        .near::<T>(k, (batch, state), bodies, |_, _| ())
                        .and(off)
                        .and(active);
                    near = near.or(ways.near[k]);
                }
            }
        },
    );
    let mut turned = Mask::NONE;
    if near.any() {
        ways.look_at_roots::<T>(bodies);
    }
    for lane in (0..LANES).filter(|&lane| near.get(lane)) {
        turned.set(lane, strand(batch, state, bodies, ways, lane));
    }
    turned
}

/// The same of one strand.
fn strand(
    batch: &Batch,
    state: &mut BatchState,
    bodies: &Bodies,
    ways: &Ways,
    lane: usize,
) -> bool {
    let ways_of_bodies = bodies.guards.iter().map(Guard::way);
    let fastest = ways_of_bodies.fold(0.0, f64::max) / bodies.dt;
    let of_root = (bodies.now.get(lane) - bodies.before.get(lane)) / bodies.dt;
    let mut turned = false;
    let mut starts = [bodies.now.get(lane); 2];
    let mut start_before = bodies.before.get(lane);
    // Of the link before.
    let mut turn = DQuat::IDENTITY;
    // What only fills the batch goes with the tip, as a link without a length does: else which strands share a batch would count.
    for k in 0..batch.count() {
        let (end_before, end) = (ways.from[k].get(lane), ways.to[k].get(lane));
        let length = batch.links[k].length[lane];
        let old = end - starts[0];
        let mut link = Link {
            before: [start_before, end_before],
            now: [starts[1], end],
            keep: std::array::from_fn(|end| match (k, end) {
                (0, 0) => f64::NEG_INFINITY,
                _ => batch.thickness[lane] + state.skin[k + end - 1][lane],
            }),
            leads_out: std::array::from_fn(|end| match (k, end) {
                (0, 0) => 0.0,
                _ => LEADS_OUT * batch.along[k + end - 1][lane],
            }),
            length,
            most: (fastest + WEDGED_OUT) * bodies.dt,
            dt: bodies.dt,
        };
        let colliders = || ways.of_root(bodies.colliders, lane);
        (starts[0], start_before) = (end, end_before);
        if turned {
            // What comes after a link that was turned stays where it is, as far as it can.
            let way = (end - link.now[0]).normalize_or(old.normalize_or_zero());
            link.now[1] = link.now[0] + way * length;
        }
        let is_near = ways.near[k].get(lane) || k > 0 && ways.near[k - 1].get(lane);
        let is_link = k < batch.counts[lane];
        let gone = [0, 1].map(|end| link.now[end].distance(link.before[end]));
        link.most += gone[0].max(gone[1]);
        if is_link && (turned || is_near) && link.turn_out(colliders, bodies.of_figure()) {
            turned = true;
            // What lies on a body would fall into it again in the next step.
            let last = &mut state.lifts[k][lane];
            *last = last.max(link.above(colliders()));
        }
        starts[1] = link.now[1];
        if turned {
            let shift = link.now[1] - end;
            let (y, v) = (state.y[k].get(lane), state.v[k].get(lane));
            state.y[k].set(lane, y + shift);
            // What is put beside a body gains no speed in the world by it, over that of the fastest body.
            let (speed, moved) = (v + of_root, v + of_root + shift / bodies.dt);
            let most = speed.length().max(fastest);
            let moved = moved.clamp_length_max(most) - of_root;
            state.v[k].set(lane, moved);
            // A link without a length has no direction.
            let directions = [old, link.now[1] - link.now[0]].map(DVec3::try_normalize);
            if let [Some(old), Some(new)] = directions {
                turn = DQuat::from_rotation_arc(old, new);
            }
            if let Some(frames) = state.frames.get_mut(k) {
                frames.set(lane, (turn * frames.get(lane)).normalize());
            }
        }
    }
    turned
}

/// A link and the ways of its ends through the world.
struct Link {
    before: [DVec3; 2],
    now: [DVec3; 2],
    keep: [f64; 2],
    /// How much farther out of a body than the root of the strand they may have to be, in m.
    leads_out: [f64; 2],
    length: f64,
    /// How far its end may be moved from where the step left it, in m.
    most: f64,
    dt: f64,
}

impl Link {
    /// What an end keeps from a body in which the strand's root is so deep.
    fn keep_of(&self, end: usize, root: f64) -> f64 {
        self.keep[end].min(root + self.leads_out[end])
    }

    /// Turns it about its start out of all bodies, in which the strand's root is so deep each, but not into the first ones, the figure's, and its end by no more than `most`. Returns whether it was turned.
    fn turn_out<'a: 'b, 'b, I>(&mut self, colliders: impl Fn() -> I, of_figure: usize) -> bool
    where
        I: Iterator<Item = (&'b Collider<'a>, f64)>,
    {
        let end = self.now[1];
        for turn in 0..MOST_TURNS {
            let most = if turn == 0 { DEEP } else { OUT };
            let mut deepest = (most, 1.0, DVec3::ZERO);
            let mut of = 0;
            for (index, body) in colliders().enumerate() {
                let depth = deepest.0;
                if !body.0.shape.is_sampled() {
                    self.look(body, turn < BY_WAYS, &mut deepest);
                }
                if deepest.0 > depth {
                    of = index;
                }
            }
            let (depth, share, normal) = deepest;
            let depth = match normal == DVec3::ZERO {
                true => 0.0,
                false => {
                    let figure = colliders().take(of_figure).enumerate();
                    let others = figure
                        .filter(|(index, _)| *index != of)
                        .map(|(_, body)| body);
                    self.as_far_as(depth, (share, normal), others)
                }
            };
            if depth <= most {
                return turn > 0;
            }
            let to = self.now[1] + normal * (depth / share.max(LEAST_SHARE));
            // What went in goes back out as far, and what was in before is pushed out.
            let to = end + (to - end).clamp_length_max(self.most);
            self.now[1] = self.now[0] + (to - self.now[0]).normalize_or(normal) * self.length;
        }
        true
    }

    /// How far a place of it, which is so deep in a body, can go out of it before that or its end meets one of these.
    fn as_far_as<'a: 'b, 'b>(
        &self,
        depth: f64,
        (share, normal): (f64, DVec3),
        others: impl Iterator<Item = (&'b Collider<'a>, f64)>,
    ) -> f64 {
        let share = share.max(LEAST_SHARE);
        let places = [
            (1.0, self.now[0].lerp(self.now[1], share)),
            (share, self.now[1]),
        ];
        let mut least = depth;
        for (body, root) in others {
            for (per_end, at) in places {
                let room = per_end * (body.distance(at) - self.keep_of(1, root)).max(0.0);
                if room >= least {
                    continue;
                }
                let towards = -normal.dot(body.outwards(at));
                if towards > 0.0 {
                    least = least.min(room / towards);
                }
            }
        }
        least
    }

    /// How far its end is from bodies, over what it keeps, in m.
    fn above<'a: 'b, 'b>(&self, colliders: impl Iterator<Item = (&'b Collider<'a>, f64)>) -> f64 {
        let exact = colliders.filter(|(body, _)| !body.shape.is_sampled());
        let above = exact.map(|(body, root)| body.distance(self.now[1]) - self.keep_of(1, root));
        above.fold(f64::INFINITY, f64::min)
    }

    /// Takes the place that is deepest in a body for `deepest`, a depth, a share of the link and the way out, where it is deeper.
    fn look(
        &self,
        (collider, root): (&Collider, f64),
        by_ways: bool,
        deepest: &mut (f64, f64, DVec3),
    ) {
        let shape = &collider.shape;
        let keeps = [0, 1].map(|end| self.keep_of(end, root));
        let ends = self.now.map(|at| {
            let at = collider.now.to_local(at);
            (at, shape.distance(at))
        });
        let mut look = |share: f64, distance: f64| {
            let keep = if share == 1.0 {
                keeps[1]
            } else {
                keeps[0].min(keeps[1])
            };
            let [from, to] = [&self.before, &self.now].map(|[start, end]| start.lerp(*end, share));
            let path = Path {
                from,
                to,
                keep,
                push_out: PUSH_OUT,
                lift: 0.0,
                leads_out: self.leads_out[1],
                way_out: None,
                dt: self.dt,
            };
            let is_in = keep - distance > deepest.0;
            let way = (collider.now.to_local(to) - collider.before.to_local(from)).length();
            if !is_in && (way < CROSSES || distance - keep > way) {
                return;
            }
            let last = shape.normal(collider.now.to_local(to));
            if !by_ways {
                if is_in {
                    *deepest = (keep - distance, share, collider.now.rotation * last);
                }
                return;
            }
            let Some(plane) = path.met(collider) else {
                return;
            };
            if plane.depth > deepest.0 && (is_in || plane.normal.dot(last) < OTHER_SIDE) {
                *deepest = (plane.depth, share, collider.now.rotation * plane.normal);
            }
        };
        look(1.0, ends[1].1);
        if keeps[0].is_finite() && 0.5 * (ends[0].1 + ends[1].1 - self.length) < keeps[1] {
            let middle = shape.distance(ends[0].0.lerp(ends[1].0, 0.5));
            if let Some((share, least)) = lowest(shape, ends, middle, keeps[1]) {
                look(share, least);
            }
            look(0.5, middle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        collision::shape::Shape,
        params::{Natural, Params},
        pose::Pose,
        rest::RestStrand,
    };
    use glam::Vec3 as Point;

    /// Two strands that came down on a ridge, and into it: what lies beyond the tip of the shorter one stays at it, or the joint there would look
    /// sharp, and the strand would move otherwise than beside others.
    #[test]
    fn what_only_fills_a_batch_goes_with_the_tip() {
        let params = Params {
            natural: Natural::Styled,
            ..Params::default()
        };
        let rests = [9, 5].map(|links| {
            // Bent, so that they have frames.
            let place =
                |i: u8| Point::new(1e-4 * f32::from(i * i), 0.03, 0.02 * f32::from(i) - 0.1);
            let points: Vec<Point> = (0..=links).map(place).collect();
            RestStrand::new(&points, &params).unwrap()
        });
        let batch = Batch::new(&[(0, &rests[0], &params), (1, &rests[1], &params)]);
        let mut state = BatchState::new(&batch, &[Some(&rests[0]), Some(&rests[1]), None, None]);
        state.lifts = vec![Lane::ZERO; batch.count()];
        let ridge = Shape::Capsule {
            from: DVec3::NEG_X,
            to: DVec3::X,
            radius: 0.04,
        };
        let colliders = [Collider::fixed(ridge, Pose::IDENTITY)];
        let bodies = Bodies {
            colliders: &colliders,
            of_one_figure: 0,
            guards: &colliders.each_ref().map(Guard::new),
            before: state.root,
            now: state.root,
            dt: 1.0 / 60.0,
        };
        let mut ways = Ways::new(batch.count());
        for k in 0..batch.count() {
            for lane in 0..LANES {
                let above = state.root.get(lane) + state.y[k].get(lane) + 0.03 * DVec3::Y;
                ways.from[k].set(lane, above);
                ways.to[k].set(lane, above);
            }
        }
        let before = state.clone();
        let turned = keep_out::<Lane>(&batch, &mut state, &bodies, &mut ways, batch.used);
        assert_eq!(turned, batch.used);
        let tip = batch.counts[1] - 1;
        assert!((state.y[tip].get(1) - before.y[tip].get(1)).length() > 5e-3);
        assert_ne!(state.frames[tip].get(1), before.frames[tip].get(1));
        for k in tip + 1..batch.count() {
            assert_eq!(state.y[k].get(1), state.y[tip].get(1));
            assert_eq!(state.v[k].get(1), state.v[tip].get(1));
            assert_eq!(state.frames[k].get(1), state.frames[tip].get(1));
        }
    }
}
