//! Finding the planes of a step, from where particles go by themselves.

use glam::DVec3;

use crate::{
    collision::shape::{Collider, LEADS_OUT, Shape},
    lanes::{LANES, Lane, Mask, Number, Vec3},
};

use super::{
    super::{
        batch::{Batch, BatchState},
        stage::GAMMA,
    },
    Contact, PUSH_OUT, Surface, WEDGED_OUT,
    guard::Guard,
    link::{Lack, SLOW, lowest},
    path::{Path, Plane},
};

/// What keeps a slow particle off for its links' sake stays what it is while they are no deeper in a body than the first of these, and no farther
/// from it than the second, in m: where it followed how they lie at once, a strand that rocks on a body would do so for ever.
const CUTS: f64 = 2.5e-4;
const CLEAR: f64 = 5e-4;

/// What grows under a mesh is under it for as long as no particle from the root on is farther out of it than this, in m: what sways out of a hat comes back.
const WORN_LOOSELY: f64 = 1e-2;

/// The ways of a batch's particles through the world in a step, as far as planes were found by them.
#[derive(Clone, Debug)]
pub(crate) struct Ways {
    pub(super) from: Vec<Vec3>,
    pub(super) to: Vec<Vec3>,
    /// The strands whose particle, or the link after it, may come near a body.
    pub(super) near: Vec<Mask>,
    /// The strands of which a particle or a link may come near each body.
    meets: Vec<Mask>,
    /// How far the strands' roots are from the surface of each body that they are in when the step ends, in m; infinity of the others.
    roots: Vec<Lane>,
    /// How many particles from the root on are in each mesh of its own when the step starts, where the root is.
    under: Vec<[usize; LANES]>,
    /// Of each mesh of its own the particle that was looked at last, where that is in it when the step starts.
    inside: Vec<[Option<Inside>; LANES]>,
}

/// A particle that is in a mesh when a step starts.
#[derive(Clone, Copy, Debug)]
struct Inside {
    particle: usize,
    /// Its place and its way out, in the mesh's space.
    at: DVec3,
    way_out: DVec3,
    /// Whether that isn't the shortest.
    is_past_middle: bool,
}

impl Inside {
    /// Whether the next particle is in the same wall of a mesh: the link between them is in it, too, and where it passes the wall's middle it is deeper than half of its length. The two
    /// legs of a clamp are no wall, nor are both faces of a board over whose edge hair hangs.
    fn is_in_one_wall_with(&self, next: DVec3, shape: &Shape) -> bool {
        let deep = match self.is_past_middle {
            true => 0.0,
            false => 0.5 * self.at.distance(next),
        };
        let places = [(0.5, deep), (0.25, 0.0), (0.75, 0.0)];
        (places.into_iter()).all(|(t, deep)| -shape.distance(self.at.lerp(next, t)) > deep)
    }
}

impl Ways {
    /// For batches of at most so many particles in a row.
    pub(crate) fn new(count: usize) -> Self {
        Self {
            from: vec![Vec3::ZERO; count],
            to: vec![Vec3::ZERO; count],
            near: vec![Mask::NONE; count],
            meets: Vec::new(),
            roots: Vec::new(),
            under: Vec::new(),
            inside: Vec::new(),
        }
    }

    /// Takes note of which bodies roots are in.
    #[inline(always)]
    pub(super) fn look_at_roots<T: Number>(&mut self, bodies: &Bodies) {
        let bodies_of = bodies.guards.iter().zip(bodies.colliders);
        let depths = bodies_of.map(|(guard, body)| guard.depths::<T>(bodies.now, &body.shape));
        self.roots.clear();
        self.roots.extend(depths);
    }

    /// Takes note of what is under meshes, as hair is under a hat: it isn't pushed through it. What is of the figure, whose skin roots are in, keeps hair out of all of it.
    fn look_under(&mut self, batch: &Batch, bodies: &Bodies, lanes: Mask) {
        self.under.clear();
        for (index, body) in bodies.colliders.iter().enumerate() {
            let may_be_worn = may_be_worn(index, body, bodies.of_one_figure);
            let lanes = lanes.and(self.meets[index]);
            self.under.push(std::array::from_fn(|lane| {
                let holds = |at: DVec3, up_to: f64| at_start(body, at).1 < up_to;
                if !may_be_worn || !lanes.get(lane) || !holds(bodies.before.get(lane), 0.0) {
                    return 0;
                }
                let mut own = self.from[..batch.counts[lane]].iter();
                let first_out = own.position(|from| !holds(from.get(lane), WORN_LOOSELY));
                first_out.unwrap_or(batch.counts[lane])
            }));
        }
    }

    /// Bodies with how deep the root of a strand is in each.
    #[inline(always)]
    pub(super) fn of_root<'a, 'b>(
        &self,
        colliders: &'b [Collider<'a>],
        lane: usize,
    ) -> impl Iterator<Item = (&'b Collider<'a>, f64)> {
        colliders
            .iter()
            .zip(&self.roots)
            .map(move |(body, roots)| (body, roots[lane]))
    }

    /// The same of the bodies that a strand may meet, by their numbers, and not of those that only others in its batch may: else which strands share a batch would count.
    fn met<'a, 'b>(
        &self,
        colliders: &'b [Collider<'a>],
        lane: usize,
    ) -> impl Iterator<Item = (usize, (&'b Collider<'a>, f64))> {
        self.of_root(colliders, lane)
            .enumerate()
            .filter(move |(body, _)| self.meets[*body].get(lane))
    }
}

/// The bodies of a step of `dt` seconds, and the roots at both its ends.
#[derive(Clone, Copy)]
pub(crate) struct Bodies<'a> {
    pub colliders: &'a [Collider<'a>],
    /// As [`Surroundings`](crate::Surroundings) has it.
    pub of_one_figure: usize,
    pub guards: &'a [Guard],
    pub before: Vec3,
    pub now: Vec3,
    pub dt: f64,
}

impl Bodies<'_> {
    /// Whether there are any that links between particles count for.
    #[inline]
    pub(crate) fn have_links(&self) -> bool {
        self.guards.iter().any(|guard| guard.has_links)
    }

    /// How many bodies, the first ones, are the figure's.
    pub(super) fn of_figure(&self) -> usize {
        self.of_one_figure.max(1)
    }

    /// Whether two of them may press hair between them.
    #[inline]
    pub(crate) fn may_wedge(&self) -> bool {
        self.have_links() || self.guards.len() > self.of_figure()
    }

    /// How fast what is found in a body is put out of it where two of them may press hair between them, in m/s.
    fn push_out(&self, index: usize) -> f64 {
        WEDGED_OUT.max(self.guards[index].way() / self.dt)
    }

    /// A plane of a body as a strand's surface.
    #[inline(always)]
    fn surface(&self, lane: usize, collider: &Collider, plane: &Plane) -> Surface {
        let (before, now) = (collider.before, collider.now);
        let normal = now.rotation * plane.normal;
        let s0 = before.to_world(plane.at - plane.normal * collider.grown(plane.at));
        let s1 = now.to_world(plane.at);
        let (s0, s1) = (s0 - self.before.get(lane), s1 - self.now.get(lane));
        Surface {
            normal,
            start: normal.dot(s0),
            mid: normal.dot(s0 + (s1 - s0) * GAMMA),
            end: normal.dot(s1),
            flow: (s1 - s0) / self.dt,
        }
    }
}

/// Whether a body is a mesh that hair may grow under: none of the figure's, whose skin roots are in.
fn may_be_worn(index: usize, body: &Collider, of_one_figure: usize) -> bool {
    index >= of_one_figure.max(1) && body.shape.is_sampled()
}

/// A place in a body's space when the step starts, and its distance.
fn at_start(body: &Collider, at: DVec3) -> (DVec3, f64) {
    let to = body.before.to_local(at);
    (to, body.at_start().distance(to))
}

/// The depth at which every particle of a strand may stay: that of the style, where it or a link beside it starts inside a body, but one that it grows under.
pub(crate) fn settle_in(
    batch: &Batch,
    state: &mut BatchState,
    colliders: &[Collider],
    of_one_figure: usize,
) {
    for lane in 0..LANES {
        let root = state.root.get(lane);
        let worn = colliders.iter().enumerate().map(|(index, body)| {
            may_be_worn(index, body, of_one_figure) && at_start(body, root).1 < 0.0
        });
        let mut is_under: Vec<bool> = worn.collect();
        let mut before = None;
        for k in 0..batch.count() {
            let at = root + state.y[k].get(lane);
            let (mut own, mut between) = (0.0_f64, 0.0_f64);
            for (collider, is_under) in colliders.iter().zip(&mut is_under) {
                let (shape, (to, distance)) = (collider.at_start(), at_start(collider, at));
                *is_under &= distance < WORN_LOOSELY;
                if *is_under {
                    continue;
                }
                own = own.min(distance - batch.thickness[lane]);
                // The root's link is as deep as the root is.
                let is_link = k < batch.counts[lane] && !shape.is_sampled();
                if let Some(before) = before.filter(|_| is_link) {
                    let from = collider.before.to_local(before);
                    let ends = [(from, shape.distance(from)), (to, distance)];
                    let middle = shape.distance(from.lerp(to, 0.5));
                    if let Some((_, lowest)) = lowest(shape, ends, middle, f64::INFINITY) {
                        between = between.min(lowest - batch.thickness[lane]);
                    }
                }
            }
            state.skin[k][lane] = own.min(between);
            if k > 0 {
                let last = &mut state.skin[k - 1][lane];
                *last = last.min(between);
            }
            before = Some(at);
        }
    }
}

/// Finds the planes of a step. Returns the number of particles that have one, whose places on the strands are added to `touched`, the strands that are between two
/// bodies, and those that are near one that links count for.
pub(crate) fn detect<T: Number>(
    (batch, state): (&Batch, &BatchState),
    bodies: &Bodies,
    active: Mask,
    planes: Planes,
    lifts: &mut Vec<Lane>,
) -> (usize, [[bool; LANES]; 2]) {
    if bodies.may_wedge() {
        lifts.resize(batch.count(), Lane::ZERO);
        let mut near = [Near::default(); LANES];
        let found =
            detect_with_links::<T>((batch, state), bodies, active, planes, (lifts, &mut near));
        let between = near.map(|own| own.others && own.wedges);
        (found, [between, near.map(|own| own.links_count)])
    } else {
        lifts.clear();
        let found = detect_alone::<T>((batch, state), bodies, active, planes);
        (found, [[false; LANES]; 2])
    }
}

/// Which bodies have planes for a strand.
#[derive(Clone, Copy, Default)]
struct Near {
    first: Option<usize>,
    /// Whether there are others than the first, any that isn't of the figure, and any that links count for.
    others: bool,
    wedges: bool,
    links_count: bool,
}

impl Near {
    fn note(&mut self, body: usize, bodies: &Bodies) {
        self.others |= *self.first.get_or_insert(body) != body;
        self.wedges |= body >= bodies.of_one_figure;
        self.links_count |= bodies.guards[body].has_links;
    }
}

/// Where the planes of a step are put: by particle, which of them have one, and what they were found by.
pub(crate) struct Planes<'a> {
    pub contacts: &'a mut [Contact],
    pub touched: &'a mut Vec<usize>,
    pub ways: &'a mut Ways,
}

/// Puts a plane before particle `k` of a strand, in a row of planes. Those of a row come one after the other.
#[inline(always)]
fn put(
    contacts: &mut [Contact],
    touched: &mut Vec<usize>,
    (row, k, lane): (usize, usize, usize),
    surface: &Surface,
    of: (&Batch, &BatchState),
) {
    let slot = row + k;
    let contact = &mut contacts[slot];
    if touched.last() != Some(&slot) {
        contact.clear();
        touched.push(slot);
    }
    contact.set(lane, surface, of, (slot, k));
}

/// A particle's places in the world at both ends of a step, as it goes by itself; what its acceleration is isn't always known.
#[inline(always)]
fn way<T: Number>(
    k: usize,
    state: &BatchState,
    bodies: &Bodies,
    known: T::Condition,
) -> [Vec3<T>; 2] {
    let y0 = state.y[k].load::<T>();
    let a = Vec3::choose(known, state.a[k].load(), Vec3::zero());
    let y1 = y0 + state.v[k].load() * bodies.dt + a * (0.5 * bodies.dt * bodies.dt);
    [bodies.before.load() + y0, bodies.now.load() + y1]
}

/// [`detect`] where links don't count.
fn detect_alone<T: Number>(
    (batch, state): (&Batch, &BatchState),
    bodies: &Bodies,
    active: Mask,
    planes: Planes,
) -> usize {
    T::run(
        #[inline(always)]
        move || {
            let Planes {
                contacts, touched, ..
            } = planes;
            let mut found = 0;
            // What is unknown was a blow, which is over.
            let known = T::condition(&Mask::new(state.restart).not());
            for k in 0..batch.count() {
                let [from, to] = way::<T>(k, state, bodies, known);
                let keep = batch.thickness.load::<T>() + state.skin[k].load();
                let mut near = Mask::NONE;
                for (guard, collider) in bodies.guards.iter().zip(bodies.colliders) {
                    near = near.or(guard.is_near_to(&collider.shape, from, to, keep));
                }
                let near = near.and(active);
                if !near.any() {
                    continue;
                }
                let (from, to, keep) = (from.store(), to.store(), keep.store());
                for lane in 0..LANES {
                    if !near.get(lane) || k >= batch.counts[lane] {
                        continue;
                    }
                    let path = Path {
                        from: from.get(lane),
                        to: to.get(lane),
                        keep: keep[lane],
                        push_out: PUSH_OUT,
                        lift: 0.0,
                        leads_out: f64::INFINITY,
                        way_out: None,
                        dt: bodies.dt,
                    };
                    let Some((collider, plane)) = path.first(bodies.colliders) else {
                        continue;
                    };
                    found += 1;
                    // Recalled hair has to leave a shoulder by the speed that it is pushed out with.
                    let surface = Surface {
                        start: f64::NEG_INFINITY,
                        ..bodies.surface(lane, collider, &plane)
                    };
                    put(contacts, touched, (0, k, lane), &surface, (batch, state));
                }
            }
            found
        },
    )
}

/// [`detect`] where links count; `lifts` are by how much particles are farther from bodies for their sake.
fn detect_with_links<T: Number>(
    (batch, state): (&Batch, &BatchState),
    bodies: &Bodies,
    active: Mask,
    planes: Planes,
    (lifts, bodies_near): (&mut [Lane], &mut [Near; LANES]),
) -> usize {
    T::run(
        #[inline(always)]
        move || {
            let Planes {
                contacts,
                touched,
                ways,
            } = planes;
            // What is unknown was a blow, which is over.
            let known = T::condition(&Mask::new(state.restart).not());
            let count = batch.count();
            let mut any = Mask::NONE;
            let mut meets = std::mem::take(&mut ways.meets);
            meets.clear();
            meets.resize(bodies.guards.len(), Mask::NONE);
            for k in 0..count {
                let [from, to] = way::<T>(k, state, bodies, known);
                (ways.from[k], ways.to[k]) = (from.store(), to.store());
                let own = active.and(Mask::new(batch.counts.map(|count| k < count)));
                let note = |body: usize, near: Mask| meets[body] = meets[body].or(near.and(own));
                let near = ways.near::<T>(k, (batch, state), bodies, note).and(active);
                ways.near[k] = near;
                any = any.or(near);
            }
            ways.meets = meets;
            if !any.any() {
                for lift in lifts {
                    *lift = active.pick(Lane::ZERO, *lift);
                }
                return 0;
            }
            ways.look_at_roots::<T>(bodies);
            ways.look_under(batch, bodies, any);
            let mut inside = std::mem::take(&mut ways.inside);
            inside.clear();
            inside.resize(bodies.colliders.len(), [None; LANES]);
            let looked = Looked {
                batch,
                state,
                bodies,
                ways,
            };
            let mut found = 0;
            let mut before = [None; LANES];
            for k in 0..count {
                let near = ways.near[k];
                let after_near = ways.near.get(k + 1).filter(|_| k + 1 < count);
                let link_near = near.or(after_near.copied().unwrap_or(Mask::NONE));
                lifts[k] = active.and(near.not()).pick(Lane::ZERO, lifts[k]);
                let mut seconds = [const { None }; LANES];
                for lane in 0..LANES {
                    let last = before[lane].take();
                    if !link_near.get(lane) || k >= batch.counts[lane] {
                        continue;
                    }
                    let after = looked.link(k + 1, lane);
                    before[lane] = after;
                    if !near.get(lane) {
                        continue;
                    }
                    let lift = &mut lifts[k][lane];
                    let of = (lift, &mut bodies_near[lane], &mut inside[..]);
                    let [surface, second] = looked.particle(k, lane, [last, after], of);
                    let Some(surface) = surface else { continue };
                    found += 1;
                    put(contacts, touched, (0, k, lane), &surface, (batch, state));
                    seconds[lane] = second;
                }
                for (lane, second) in seconds.iter().enumerate() {
                    if let Some(surface) = second {
                        let at = (batch.planes, k, lane);
                        put(contacts, touched, at, surface, (batch, state));
                    }
                }
            }
            ways.inside = inside;
            found
        },
    )
}

impl Ways {
    /// The strands whose particle `k`, or a link beside it, may come near a body; `note` is told of each body which.
    #[inline(always)]
    pub(super) fn near<T: Number>(
        &self,
        k: usize,
        (batch, state): (&Batch, &BatchState),
        bodies: &Bodies,
        mut note: impl FnMut(usize, Mask),
    ) -> Mask {
        // No place of a link is farther from the nearer of its ends.
        let next = batch
            .links
            .get(k + 1)
            .map_or(T::splat(0.0), |link| link.length.load::<T>());
        let own = batch.links[k].length.load::<T>();
        let longer = T::choose(own.less(next), next, own);
        let keep = batch.thickness.load::<T>() + state.skin[k].load();
        let half = longer * T::splat(0.5);
        let (from, to) = (self.from[k].load::<T>(), self.to[k].load());
        let mut near = Mask::NONE;
        for (body, guard) in bodies.guards.iter().enumerate() {
            let keep = if guard.has_links { keep + half } else { keep };
            let own = guard.is_near(from, to, keep);
            note(body, own);
            near = near.or(own);
        }
        near
    }
}

/// Where strands go that are looked at.
struct Looked<'a> {
    batch: &'a Batch,
    state: &'a BatchState,
    bodies: &'a Bodies<'a>,
    ways: &'a Ways,
}

impl Looked<'_> {
    fn path(&self, k: usize, lane: usize) -> Path {
        Path {
            from: self.ways.from[k].get(lane),
            to: self.ways.to[k].get(lane),
            keep: self.batch.thickness[lane] + self.state.skin[k][lane],
            push_out: WEDGED_OUT,
            lift: 0.0,
            leads_out: LEADS_OUT * self.batch.along[k][lane],
            way_out: None,
            dt: self.bodies.dt,
        }
    }

    /// What link `k` lacks; nothing where there is none, or it is the root's.
    fn link(&self, k: usize, lane: usize) -> Option<Lack> {
        if k == 0 || k >= self.batch.counts[lane] {
            return None;
        }
        let ends = [self.path(k - 1, lane), self.path(k, lane)];
        let colliders = self.ways.met(self.bodies.colliders, lane);
        Lack::deepest(colliders, ends, self.batch.links[k].length[lane])
    }

    /// The way by which particle `k`, whose plane of a mesh of its own is known, leaves the mesh in place of the shortest one: that of the particle before it. Beyond the middle of a wall the shortest
    /// way leads out on the other side, and a strand that a wall came over would hang in it for good, pulled to both sides. What may be in the mesh takes no other way.
    fn way_out(k: usize, path: &Path, body: &Collider, last: &mut Option<Inside>) -> Option<DVec3> {
        let before = last.take().filter(|before| before.particle + 1 == k);
        let (at, distance) = at_start(body, path.from);
        if distance >= 0.0 || path.keep < 0.0 {
            return None;
        }
        let shape = body.at_start();
        let shortest = shape.normal(at);
        let taken = before.filter(|before| {
            before.way_out.dot(shortest) < 0.0 && before.is_in_one_wall_with(at, shape)
        });
        *last = Some(Inside {
            particle: k,
            at,
            way_out: taken.map_or(shortest, |before| before.way_out),
            is_past_middle: taken.is_some(),
        });
        taken.map(|before| before.way_out)
    }

    /// The planes of particle `k`, between links that lack this, where `last_lift` is by how much it was farther from a body than it would be alone, `near` the bodies that have any, and `inside` the
    /// last particle in each mesh: that which it is deepest behind, and the one of another body. Held by one alone, what lies between two bodies would be thrown from one to the other for ever. Another body's gives way to the figure's.
    fn particle(
        &self,
        k: usize,
        lane: usize,
        links: [Option<Lack>; 2],
        (last_lift, near, inside): (&mut f64, &mut Near, &mut [[Option<Inside>; LANES]]),
    ) -> [Option<Surface>; 2] {
        let path = self.path(k, lane);
        let [mut best, mut second]: [Option<(usize, Plane)>; 2] = [None, None];
        let (mut need, mut depth, mut of) = (0.0, f64::NEG_INFINITY, 0);
        for (lack, end) in links.iter().zip([1, 0]) {
            let Some(lack) = lack else { continue };
            if lack.lifts[end] > need {
                (need, of) = (lack.lifts[end], lack.body);
            }
            depth = depth.max(lack.depth);
        }
        let is_slow = (path.to - path.from).length() < SLOW * path.dt;
        let (cuts, clear) = if is_slow { (CUTS, CLEAR) } else { (0.0, 0.0) };
        if depth > cuts {
            *last_lift = if is_slow { last_lift.max(need) } else { need };
        } else if depth < -clear {
            *last_lift = last_lift.min(need);
        }
        for (index, (collider, root)) in self.ways.met(self.bodies.colliders, lane) {
            if k < self.ways.under[index][lane] {
                continue;
            }
            let lift = if index == of { *last_lift } else { 0.0 };
            let path = Path {
                push_out: self.bodies.push_out(index),
                ..path.led_out(root)
            };
            let lifted = Path {
                keep: path.keep + lift,
                lift,
                ..path
            };
            let crossed = links
                .iter()
                .flatten()
                .filter_map(|lack| lack.plane(index, &path, collider));
            let mut own = lifted.against(collider);
            if own.is_some() && may_be_worn(index, collider, self.bodies.of_one_figure) {
                let way_out = Self::way_out(k, &path, collider, &mut inside[index][lane]);
                if way_out.is_some() {
                    own = Path { way_out, ..lifted }.against(collider);
                }
            }
            let planes = crossed.chain(own);
            let Some(plane) = planes.reduce(|a, b| if b.depth > a.depth { b } else { a }) else {
                continue;
            };
            near.note(index, self.bodies);
            let is_deeper = |than: &Option<(_, Plane)>| {
                than.as_ref().is_none_or(|(_, b)| plane.depth > b.depth)
            };
            if is_deeper(&best) {
                second = best.replace((index, plane));
            } else if is_deeper(&second) {
                second = Some((index, plane));
            }
        }
        let bodies = self.bodies;
        let is_of_figure = [&best, &second].map(|found| {
            found
                .as_ref()
                .is_some_and(|(index, _)| *index < bodies.of_figure())
        });
        let mut surfaces = [best, second].map(|found| {
            found.map(|(index, plane)| bodies.surface(lane, &bodies.colliders[index], &plane))
        });
        if let [Some(best), Some(second)] = &mut surfaces {
            let y = path.from - bodies.before.get(lane);
            match is_of_figure {
                [true, false] => second.give_way(best, y),
                [false, true] => best.give_way(second, y),
                _ => {}
            }
        }
        surfaces
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SignedDistance, collision::blocks::blocks};
    use glam::Vec3 as Point;

    #[test]
    fn a_wall_is_told_from_a_board_and_a_clamp() {
        let block = |from: f32, to: f32| [Point::new(from, -0.1, -0.1), Point::new(to, 0.1, 0.1)];
        let grid = |corners: &[[Point; 2]]| {
            let (points, triangles) = blocks(corners);
            SignedDistance::new(&points, &triangles, 0.002).unwrap()
        };
        let (wall, board) = (grid(&[block(-0.03, 0.03)]), grid(&[block(-0.004, 0.004)]));
        let clamp = grid(&[block(-0.04, -0.005), block(0.005, 0.04)]);
        let is_one = |grid: &SignedDistance, from: [f64; 2], to: [f64; 2], is_past_middle| {
            let [at, next] = [from, to].map(|[x, y]| DVec3::new(x, y, 0.0));
            let inside = Inside {
                particle: 0,
                at,
                way_out: DVec3::NEG_X,
                is_past_middle,
            };
            inside.is_in_one_wall_with(next, &Shape::Grid(grid))
        };
        assert!(is_one(&wall, [-0.005, 0.0], [0.005, 0.0], false));
        // Along its other face, once what comes before is past its middle.
        assert!(is_one(&wall, [0.025, 0.0], [0.027, 0.01], true));
        assert!(!is_one(&wall, [0.025, 0.0], [0.027, 0.01], false));
        assert!(!is_one(&board, [-0.0035, 0.08], [0.0035, 0.099], false));
        for is_past_middle in [false, true] {
            assert!(!is_one(
                &clamp,
                [-0.0065, 0.0],
                [0.0065, 0.01],
                is_past_middle
            ));
        }
    }
}
