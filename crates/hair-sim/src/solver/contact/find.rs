//! Finding the planes of a step: what comes near which body, and where.
//!
//! A particle's way against each body gives it at most one plane. A link may cut a body that neither of its ends touches: of each that passes one
//! by, the place that comes deepest has a way and a plane of its own.

use glam::{DMat3, DVec3};

use crate::{
    collision::shape::{Collider, Shape},
    lanes::{LANES, Lane, Mask, Number, Vec3},
};

use super::{
    super::{
        batch::{Batch, BatchState},
        chain::at_share,
        link::{Lever, Node},
        stage::GAMMA,
    },
    Contact, NEAR, Surface,
    path::{End, Path, Plane},
};

/// A link has a plane of its own where it is deeper in a body than both its ends by more than this, in m; and one that has pressed on a body
/// already, by more than the second.
const SAG: f64 = 3e-4;
const LEAST_SAG: f64 = 1.5e-4;

/// One that has pressed goes on to do so at the same place unless another is deeper by this, in m.
const HARDLY: f64 = 1e-4;

/// Below this speed, in m/s, a link is about to come to rest.
const SLOW: f64 = 0.1;

/// How near the ends of a link its own plane may be, as a share of it: there the particle's will do.
const END: f64 = 0.05;

/// A stage's answer that leaves a place deeper in a body than the first of these, in m, or holds it farther from all bodies than the second, has its
/// plane moved, so often at most; unless both ends of its link are nearer to where they were expected than the last.
const CUTS: f64 = 1.5e-4;
const HOVERS: f64 = 1e-3;
const MOST_MOVES: usize = 6;
const EXPECTED: f64 = 1e-3;
/// A plane that holds something too far from a body isn't turned farther than this, a cosine, at once.
const ALIKE: f64 = 0.3;

/// What is known of bodies while particles are gone through.
#[derive(Clone, Debug, Default)]
pub(crate) struct Finder {
    /// Of every body and strand: how the way of the last particle ends, and which it was.
    ends: Vec<[Option<(usize, End)>; LANES]>,
    /// Links that pass bodies by in this step, of which strands, and their ends as they are expected.
    passing: Vec<(usize, Mask, [Vec3; 2])>,
    /// How often planes of every strand were moved in the stage at hand.
    moves: [usize; LANES],
}

impl Finder {
    /// For batches of at most so many links in a row.
    pub(crate) fn new(count: usize) -> Self {
        Self {
            passing: Vec::with_capacity(count),
            ..Self::default()
        }
    }

    /// Whether no link passes a body by.
    pub(crate) fn is_clear(&self) -> bool {
        self.passing.is_empty()
    }

    /// Begins a stage.
    pub(crate) fn begin(&mut self) {
        self.moves = [0; LANES];
    }

    /// As where no body is.
    pub(crate) fn clear(&mut self) {
        self.passing.clear();
    }
}

/// The bodies of a step of `dt` seconds, and the roots at both its ends.
#[derive(Clone, Copy)]
pub(crate) struct Bodies<'a> {
    pub colliders: &'a [Collider<'a>],
    pub guards: &'a [Guard],
    pub before: Vec3,
    pub now: Vec3,
    pub dt: f64,
    /// Whether what acts is the same as in the last step, and does not move.
    pub calm: bool,
}

impl Bodies<'_> {
    /// A plane of a body as a strand's surface.
    fn surface(&self, lane: usize, collider: &Collider, plane: &Plane) -> Surface {
        let normal = collider.now.rotation * plane.normal;
        // A surface that deforms has come along its normal.
        let start = plane.at + plane.normal * collider.shape.change(plane.at);
        let (s0, s1) = (
            collider.before.to_world(start),
            collider.now.to_world(plane.at),
        );
        let (s0, s1) = (s0 - self.before.get(lane), s1 - self.now.get(lane));
        Surface {
            normal,
            mid: normal.dot(s0 + (s1 - s0) * GAMMA),
            end: normal.dot(s1),
            flow: (s1 - s0) / self.dt,
        }
    }
}

/// A ball around a body, and how the body moves in a step: what lies far off is known by this alone.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    center: DVec3,
    radius: f64,
    /// From where something was, as the body carries it along: `carry` times the place, and `shift`.
    carry: DMat3,
    shift: DVec3,
}

impl Guard {
    pub(crate) fn new(collider: &Collider) -> Self {
        let (center, radius) = collider.shape.ball();
        let (before, now) = (collider.before, collider.now);
        let carry = DMat3::from_quat(now.rotation) * DMat3::from_quat(before.rotation).transpose();
        Self {
            center: now.to_world(center),
            radius,
            carry,
            shift: now.translation - carry * before.translation,
        }
    }

    /// Whether particles that go from `from` to `to` and keep `keep` may come near the body. A little more than
    /// [`Path::against`] asks for, which has the last word.
    #[inline(always)]
    fn is_near<T: Number>(&self, from: Vec3<T>, to: Vec3<T>, keep: T) -> Mask {
        const MARGIN: f64 = 1e-6;
        let carried = Vec3::all(self.shift)
            + Vec3::all(self.carry.x_axis).scale(from.x)
            + Vec3::all(self.carry.y_axis).scale(from.y)
            + Vec3::all(self.carry.z_axis).scale(from.z);
        let way = (to - carried).length_squared().sqrt();
        let reach = way + keep + T::splat(self.radius + NEAR + MARGIN);
        let apart = (to - Vec3::all(self.center)).length_squared().sqrt();
        let (apart, reach) = (apart.store(), reach.store());
        // NaN is near.
        reach.lt(apart).not()
    }
}

/// How deep all particles and links of a strand may stay in bodies: as deep as the style has them, where it starts inside.
pub(crate) fn settle_in(batch: &Batch, state: &mut BatchState, colliders: &[Collider]) {
    let count = batch.count();
    for lane in 0..LANES {
        let depth = |at: DVec3| {
            let at = state.root.get(lane) + at;
            colliders
                .iter()
                .map(|c| c.shape.distance_before(c.before.to_local(at)) - batch.thickness[lane])
                .fold(0.0, f64::min)
        };
        let mut skins = [0.0, depth(DVec3::ZERO)];
        for k in 0..count {
            skins = [skins[1], depth(state.y[k].get(lane))];
            let between = [0.25, 0.5, 0.75]
                .map(|share| depth(at_share(&state.y, k, Lane::splat(share)).get(lane)));
            let on_link = between.into_iter().fold(skins[0].min(skins[1]), f64::min);
            state.skin[k][lane] = skins[1];
            state.skin[count + k][lane] = on_link;
        }
    }
}

/// Finds the planes of a step. Returns the number of particles and links that have one; the planes' places are added to `touched`.
pub(crate) fn detect<T: Number>(
    batch: &Batch,
    state: &BatchState,
    bodies: &Bodies,
    active: Mask,
    (contacts, touched, finder): (&mut [Contact], &mut Vec<usize>, &mut Finder),
) -> usize {
    let unknown = [None; LANES];
    finder.ends.clear();
    finder.ends.resize(bodies.colliders.len(), unknown);
    T::run(
        #[inline(always)]
        move || {
            let (mut found, count) = (0, batch.count());
            // What is unknown was a blow, which is over.
            let known = T::condition(&Mask::new(state.restart).not());
            let (dt, root) = (bodies.dt, bodies.now);
            // Of the particle before.
            let mut near_before = Mask::NONE;
            let mut before = [state.root, root];
            for k in 0..count {
                let y0 = state.y[k].load::<T>();
                let a = Vec3::choose(known, state.a[k].load(), Vec3::zero());
                let y1 = y0 + state.v[k].load() * dt + a * (0.5 * dt * dt);
                let (p0, p1) = (state.root.load() + y0, root.load() + y1);
                let keep = batch.thickness.load::<T>() + state.skin[k].load();
                // So far can a link go on from here that comes nearer to a body than both its ends.
                let half = batch.reaches[k].load::<T>();
                let mut near = Mask::NONE;
                for guard in bodies.guards {
                    near = near.or(guard.is_near(p0, p1, keep + half));
                }
                let near = near.and(active);
                let either = near.or(near_before);
                if !either.any() {
                    (before, near_before) = ([p0.store(), p1.store()], near);
                    continue;
                }
                let now = [p0.store(), p1.store()];
                let (particles, links) = contacts.split_at_mut(count);
                let step = Pair {
                    batch,
                    state,
                    bodies,
                    k,
                    near,
                    ends: [before, now],
                };
                found += step.find((&mut particles[k], &mut links[k]), either, touched, finder);
                (before, near_before) = (now, near);
            }
            found
        },
    )
}

/// A link and the particle at its end, for strands that are near bodies.
struct Pair<'a> {
    batch: &'a Batch,
    state: &'a BatchState,
    bodies: &'a Bodies<'a>,
    k: usize,
    /// The strands whose particle may be near a body.
    near: Mask,
    /// The ways of both the link's ends: before and now.
    ends: [[Vec3; 2]; 2],
}

impl Pair<'_> {
    /// Finds the planes of particle and link in the strands of `either`. Returns how many there are.
    fn find(
        &self,
        (particle, link): (&mut Contact, &mut Contact),
        either: Mask,
        touched: &mut Vec<usize>,
        finder: &mut Finder,
    ) -> usize {
        let (count, k) = (self.batch.count(), self.k);
        let (of_particle, of_link) = (k, count + k);
        particle.clear();
        link.clear();
        let (mut touches, mut cuts, mut passes) = (0, 0, Mask::NONE);
        for lane in 0..LANES {
            if !either.get(lane) || k >= self.batch.counts[lane] {
                continue;
            }
            let thickness = self.batch.thickness[lane];
            let [[a0, a1], [b0, b1]] = self.ends.map(|way| way.map(|at| at.get(lane)));
            let length = self.batch.links[k].length[lane];
            let dt = self.bodies.dt;
            let path = Path {
                from: b0,
                to: b1,
                keep: thickness + self.state.skin[of_particle][lane],
                dt,
                is_link: false,
            };
            let (mut own, mut its) = (None, None);
            for (collider, ends) in self.bodies.colliders.iter().zip(&mut finder.ends) {
                let end = End::new(collider, b0, b1);
                let start = match ends[lane] {
                    Some((last, end)) if last + 1 == k => end,
                    _ => End::new(collider, a0, a1),
                };
                ends[lane] = Some((k, end));
                if self.near.get(lane) {
                    keep_deepest(&mut own, collider, path.against(collider, &end));
                }
                // No place on the link is nearer to the body than this.
                let way = start.way.max(end.way);
                let least = 0.5 * (start.distance + end.distance - length) - thickness;
                if least > way + NEAR {
                    continue;
                }
                passes.set(lane, true);
                let presses = self.state.press[of_link][lane] > 0.0;
                // What comes to rest would press and bounce by turns: where nothing that acts changes, a slow link that has let go waits for a change.
                let has_pressed = self.state.shares[k][lane] > 0.0;
                if self.bodies.calm && has_pressed && !presses && way < SLOW * dt {
                    continue;
                }
                let sag = if presses { LEAST_SAG } else { SAG };
                let ends = [(start.at, start.distance), (end.at, end.distance)];
                let most = thickness + way + NEAR;
                let Some((mut share, deepest)) = deepest(&collider.shape, ends, sag, most) else {
                    continue;
                };
                // What presses at a place goes on to, while another is hardly deeper: a plane that went to and fro would make it tremble.
                let last = self.state.shares[k][lane];
                if presses && last != share {
                    let at = start.at.lerp(end.at, last);
                    if collider.shape.distance(at) < deepest + HARDLY {
                        share = last;
                    }
                }
                let path = Path {
                    from: a0.lerp(b0, share),
                    to: a1.lerp(b1, share),
                    keep: thickness + self.state.skin[of_link][lane],
                    dt,
                    is_link: true,
                };
                let end = End::new(collider, path.from, path.to);
                let plane = path.against(collider, &end);
                keep_deepest(&mut its, collider, plane.map(|plane| (share, plane)));
            }
            let known = (self.batch, self.state);
            if let Some((collider, plane)) = own {
                touches += 1;
                let surface = self.bodies.surface(lane, collider, &plane);
                particle.set(lane, &surface, known, (of_particle, k), 1.0);
            }
            if let Some((collider, (share, plane))) = its {
                cuts += 1;
                let surface = self.bodies.surface(lane, collider, &plane);
                link.set(lane, &surface, known, (of_link, k), share);
            }
        }
        if touches > 0 {
            touched.push(of_particle);
        }
        if cuts > 0 {
            touched.push(of_link);
        }
        if passes.any() {
            let expected = self.ends.map(|[_, now]| now);
            finder.passing.push((k, passes, expected));
        }
        touches + cuts
    }
}

/// What a stage has of particles, to move planes in.
pub(crate) struct Loaded<'a> {
    pub contacts: &'a mut [Contact],
    pub touched: &'a mut Vec<usize>,
    pub nodes: &'a mut [Node],
    pub levers: &'a mut [Lever],
    pub finder: &'a mut Finder,
    pub free_y: &'a [Vec3],
    /// Of the stage, in s.
    pub length: Lane,
}

impl Loaded<'_> {
    /// Lets a strand's place go that a plane holds.
    fn let_go(&mut self, batch: &Batch, plane: usize, lane: usize) {
        let (k, is_on_link) = batch.held_by(plane);
        if is_on_link {
            self.levers[k].let_go(lane);
        } else {
            let contact = &mut self.contacts[plane];
            let mut here = Mask::NONE;
            here.set(lane, true);
            // The same force the other way.
            let mass = -batch.particles[k].mass;
            let (level, node) = (contact.end, &mut self.nodes[k]);
            contact.hold(node, here, mass, level, self.length, self.free_y[k]);
        }
        self.contacts[plane].on[lane] = 0.0;
        self.contacts[plane].holds[lane] = 0.0;
    }

    /// Puts a plane before a place of a strand.
    fn put(&mut self, plane: usize, lane: usize, (share, surface): (f64, Surface)) {
        if !self.touched.contains(&plane) {
            self.contacts[plane].clear();
            self.touched.push(plane);
            // Which strands are beside this one decides nothing: a node's planes add up in one order.
            self.touched.sort_unstable();
        }
        self.contacts[plane].move_to(lane, &surface, share);
    }

    /// Whether a plane holds a strand.
    fn holds(&self, plane: usize, lane: usize) -> bool {
        let contact = &self.contacts[plane];
        contact.on[lane] * contact.holds[lane] > 0.0 && self.touched.contains(&plane)
    }
}

/// Moves the planes that the answer `y` of a step's last stage leaves deep in bodies or far above them, in the strands of `among`, to where the
/// answer is: what is drawn round a ridge touches it elsewhere than was expected, or was not expected there at all. Returns the strands where
/// any was moved.
pub(crate) fn move_planes(
    strands: (&Batch, &BatchState),
    bodies: &Bodies,
    y: &[Vec3],
    among: Mask,
    loaded: &mut Loaded,
) -> Mask {
    let may_move = Mask::new(loaded.finder.moves.map(|moves| moves < MOST_MOVES));
    let (count, among) = (strands.0.count(), among.and(may_move));
    let mut moved = Mask::NONE;
    for index in 0..loaded.finder.passing.len() {
        let (k, passes, expected) = loaded.finder.passing[index];
        let passes = passes.and(among);
        if !passes.any() {
            continue;
        }
        let ends_of = |y: &[Vec3], root: Vec3| {
            [0.0, 1.0].map(|share| at_share(y, k, Lane::splat(share)) + root)
        };
        let before = ends_of(&strands.1.y, bodies.before);
        let now = ends_of(y, bodies.now);
        for lane in (0..LANES).filter(|&lane| passes.get(lane)) {
            let [before, now, expected] =
                [&before, &now, &expected].map(|ends| ends.each_ref().map(|end| end.get(lane)));
            let is_as_expected =
                |end: usize| (now[end] - expected[end]).length_squared() < EXPECTED * EXPECTED;
            if !now[1].is_finite() || is_as_expected(0) && is_as_expected(1) {
                continue;
            }
            let answer = Answer {
                strands,
                bodies,
                place: (k, lane),
                before,
                now,
            };
            for plane in [k, count + k] {
                let share = match plane == k {
                    true => 1.0,
                    false => loaded.contacts[plane].share[lane],
                };
                let holds = loaded.holds(plane, lane);
                let above = match holds {
                    true => answer.above(plane, share),
                    false => 0.0,
                };
                let found = if holds && above > HOVERS {
                    // What a body has struck stays on its side of that.
                    let normal = loaded.contacts[plane].normal.get(lane);
                    let tangent = answer.tangent(plane, share);
                    tangent.filter(|(_, surface)| surface.normal.dot(normal) > ALIKE)
                } else if plane != k {
                    let way = (now[1] - before[1])
                        .length()
                        .max((now[0] - before[0]).length());
                    let waits = strands.1.shares[k][lane] > 0.0 && way < SLOW * bodies.dt;
                    match bodies.calm && waits && !holds {
                        true => None,
                        false => answer.link(),
                    }
                } else if holds && above > -CUTS {
                    None
                } else {
                    answer.particle()
                };
                let Some(found) = found else {
                    continue;
                };
                if holds {
                    loaded.let_go(strands.0, plane, lane);
                }
                loaded.put(plane, lane, found);
                moved.set(lane, true);
            }
        }
    }
    for lane in 0..LANES {
        loaded.finder.moves[lane] += usize::from(moved.get(lane));
    }
    moved
}

/// What a stage's answer says of a link of a strand and its particle: where its ends were when the step started, and where it has them.
struct Answer<'a> {
    strands: (&'a Batch, &'a BatchState),
    bodies: &'a Bodies<'a>,
    /// Number of the link, and lane.
    place: (usize, usize),
    before: [DVec3; 2],
    now: [DVec3; 2],
}

impl Answer<'_> {
    /// How far a share of the link is from the nearest body, or in the deepest, over what a plane keeps.
    fn above(&self, plane: usize, share: f64) -> f64 {
        let at = self.now[0].lerp(self.now[1], share);
        let colliders = self.bodies.colliders.iter();
        let least = colliders.map(|c| c.shape.distance(c.now.to_local(at)));
        least.fold(f64::INFINITY, f64::min) - self.keep(plane)
    }

    /// The plane of the body nearest to a share of the link, where that is nearest.
    fn tangent(&self, plane: usize, share: f64) -> Option<(f64, Surface)> {
        let at = self.now[0].lerp(self.now[1], share);
        let places = self.bodies.colliders.iter().map(|collider| {
            let at = collider.now.to_local(at);
            (collider, at, collider.shape.distance(at))
        });
        let (collider, at, distance) = places.min_by(|a, b| a.2.total_cmp(&b.2))?;
        let normal = collider.shape.normal(at);
        let depth = self.keep(plane) - distance;
        let plane = Plane {
            at: at + normal * depth,
            normal,
            depth,
        };
        Some((share, self.bodies.surface(self.place.1, collider, &plane)))
    }

    /// The plane that particle or link lacks, at a share of the link.
    fn particle(&self) -> Option<(f64, Surface)> {
        let (k, lane) = self.place;
        let keep = self.keep(k);
        let mut found = None;
        for collider in self.bodies.colliders {
            let end = End::new(collider, self.before[1], self.now[1]);
            if end.distance < keep - CUTS {
                keep_deepest(
                    &mut found,
                    collider,
                    self.path(1.0, keep).against(collider, &end),
                );
            }
        }
        let (collider, plane) = found?;
        Some((1.0, self.bodies.surface(lane, collider, &plane)))
    }

    fn link(&self) -> Option<(f64, Surface)> {
        let (k, lane) = self.place;
        let batch = self.strands.0;
        let keep = self.keep(batch.count() + k);
        let length = batch.links[k].length[lane];
        let mut found = None;
        for collider in self.bodies.colliders {
            let ends = self.now.map(|at| {
                let at = collider.now.to_local(at);
                (at, collider.shape.distance(at))
            });
            if 0.5 * (ends[0].1 + ends[1].1 - length) > keep - CUTS {
                continue;
            }
            let Some((share, _)) = deepest(&collider.shape, ends, LEAST_SAG, keep - CUTS) else {
                continue;
            };
            let path = self.path(share, keep);
            let end = End::new(collider, path.from, path.to);
            let plane = path.against(collider, &end);
            keep_deepest(&mut found, collider, plane.map(|plane| (share, plane)));
        }
        let (collider, (share, plane)) = found?;
        Some((share, self.bodies.surface(lane, collider, &plane)))
    }

    /// How far the place of a plane keeps from bodies.
    fn keep(&self, plane: usize) -> f64 {
        let (batch, state) = self.strands;
        batch.thickness[self.place.1] + state.skin[plane][self.place.1]
    }

    /// The way of a share of the link to the answer.
    fn path(&self, share: f64, keep: f64) -> Path {
        let at = |ends: [DVec3; 2]| ends[0].lerp(ends[1], share);
        Path {
            from: at(self.before),
            to: at(self.now),
            keep,
            dt: self.bodies.dt,
            is_link: share < 1.0,
        }
    }
}

/// A plane's depth behind a path's end.
trait Depth {
    fn depth(&self) -> f64;
}

impl Depth for Plane {
    fn depth(&self) -> f64 {
        self.depth
    }
}

impl Depth for (f64, Plane) {
    fn depth(&self) -> f64 {
        self.1.depth
    }
}

/// Of the planes of several bodies the one that the path's end is deepest behind.
fn keep_deepest<'a, 'b, P: Depth>(
    best: &mut Option<(&'b Collider<'a>, P)>,
    collider: &'b Collider<'a>,
    plane: Option<P>,
) {
    let Some(plane) = plane else { return };
    if best
        .as_ref()
        .is_none_or(|(_, best)| plane.depth() > best.depth())
    {
        *best = Some((collider, plane));
    }
}

/// The place between two, of which the distances from a body's surface are known, that is nearest to it or deepest in it: as a share of the
/// way from the first, with its distance. None where that is not deeper than both by `sag`, or farther than `most` (m).
///
/// By parabolas through three places: bodies are smooth against links.
fn deepest(
    shape: &Shape,
    [(from, start), (to, end)]: [(DVec3, f64); 2],
    sag: f64,
    most: f64,
) -> Option<(f64, f64)> {
    let distance = |share: f64| shape.distance(from.lerp(to, share));
    let least = start.min(end) - sag;
    let middle = (0.5, distance(0.5));
    let (share, expected) = lowest([(0.0, start), middle, (1.0, end)])?;
    // A parabola that is far above can't be that wrong.
    if expected > least + 0.5 * sag || !(END..=1.0 - END).contains(&share) {
        return None;
    }
    let mut best = (share, distance(share));
    if (best.1 - expected).abs() > 0.5 * sag {
        let three = if share < 0.5 {
            [(0.0, start), best, middle]
        } else {
            [middle, best, (1.0, end)]
        };
        let again = lowest(three).filter(|(share, _)| (END..=1.0 - END).contains(share));
        if let Some((share, _)) = again {
            let found = (share, distance(share));
            if found.1 < best.1 {
                best = found;
            }
        }
    }
    if middle.1 < best.1 {
        best = middle;
    }
    (best.1 < least && best.1 < most).then_some(best)
}

/// The lowest place and value of the parabola through three, where it has one.
fn lowest([(a, fa), (b, fb), (c, fc)]: [(f64, f64); 3]) -> Option<(f64, f64)> {
    let first = (fb - fa) / (b - a);
    let curve = ((fc - fb) / (c - b) - first) / (c - a);
    if curve.is_nan() || curve <= 0.0 {
        return None;
    }
    let at = 0.5 * (a + b - first / curve);
    let value = fa + (at - a) * (first + curve * (at - b));
    Some((at, value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::Pose;
    use glam::DQuat;

    #[test]
    fn a_ball_around_a_body_hides_nothing_that_the_body_meets() {
        let shape = Shape::Capsule {
            from: DVec3::new(-0.1, 0.0, 0.05),
            to: DVec3::new(0.2, 0.1, 0.0),
            radius: 0.05,
        };
        let collider = Collider {
            shape,
            before: Pose {
                rotation: DQuat::from_rotation_x(0.4),
                translation: DVec3::new(0.0, 0.3, 0.0),
            },
            now: Pose {
                rotation: DQuat::from_rotation_y(1.1),
                translation: DVec3::new(0.02, 0.25, 0.01),
            },
        };
        let guard = Guard::new(&collider);
        let (mut met, mut hidden) = (0, 0);
        for i in 0..20_000 {
            let spread = |k: i32| f64::from((i * 7919 + k * 104_729) % 1009) / 1009.0 - 0.5;
            let from = DVec3::new(spread(1), spread(2) + 0.3, spread(3));
            let to = from + DVec3::new(spread(4), spread(5), spread(6)) * 0.05;
            let path = Path {
                from,
                to,
                keep: 1e-3,
                dt: 0.01,
                is_link: false,
            };
            let keep = Lane::splat(path.keep);
            let near = guard.is_near(Vec3::splat(from), Vec3::splat(to), keep);
            let end = End::new(&collider, from, to);
            let meets = path.against(&collider, &end).is_some();
            assert!(near.get(0) || !meets, "{from} {to}");
            met += usize::from(meets);
            hidden += usize::from(!near.get(0));
        }
        assert!(met > 1000 && hidden > 1000, "{met} {hidden}");
    }

    #[test]
    fn the_deepest_place_between_two_is_found() {
        let ridge = Shape::Capsule {
            from: DVec3::NEG_Z,
            to: DVec3::Z,
            radius: 0.015,
        };
        let mut found = 0;
        for i in 0..4000 {
            let spread = |k: i32| f64::from((i * 7919 + k * 104_729) % 1009) / 1009.0 - 0.5;
            let from = DVec3::new(-0.015 + 0.02 * spread(1), 0.02 + 0.02 * spread(2), 0.0);
            let to = from + DVec3::new(0.03, 0.02 * spread(3), 0.02 * spread(4));
            let ends = [from, to].map(|at| (at, ridge.distance(at)));
            let exact = (0..=2000)
                .map(|i| ridge.distance(from.lerp(to, f64::from(i) / 2000.0)))
                .fold(f64::INFINITY, f64::min);
            let sags = ends[0].1.min(ends[1].1) - exact;
            match deepest(&ridge, ends, SAG, f64::INFINITY) {
                Some((share, distance)) => {
                    found += 1;
                    assert_eq!(distance, ridge.distance(from.lerp(to, share)));
                    assert!((distance - exact).abs() < 2e-4, "{distance} {exact}");
                }
                None => assert!(sags < 1.6 * SAG, "{sags}"),
            }
        }
        assert!(found > 1000, "{found}");
    }
}
