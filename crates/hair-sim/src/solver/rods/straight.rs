//! Strands that are straight by nature solve no twist.
//!
//! Where a round section has no natural bend, nothing twists the strand: frames that go from link to link by the least turn
//! (Bishop 1975) from the skin's are its material frames, and the directions of the links are all there is to find, two numbers each
//! in place of three. In the axes of such frames a joint's turn is a vector b in the plane across, which points where the
//! strand bends to and is 2 tan(angle / 2) long, and changes by
//!
//! ```text
//! db = 1 / cos^2(angle / 2) (f - p)
//! ```
//!
//! when the link before moves its direction by p and the link by f, in the axes of each. So a joint's spring couples the two by one
//! number in place of a matrix, and [`super::curled::sweep`]'s recursion, with the same energy and the same model of it, needs
//! about a third of the arithmetic.

use crate::{
    lanes::{Lane, Mask, Number, Quat, Sym3, Vec3, plane::Sym2, plane::Vec2, stored},
    solver::{
        batch::{Batch, BatchState},
        chain::{Chain, ShapeEnergy, chord},
        link::{Elastic, Link, Node},
        stage::{FreeMotion, Model},
    },
};

/// Scratch of a Newton step.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    acrosses: Vec<Across>,
    bends: Vec<Bend>,
    eliminations: Vec<Elimination>,
    /// How the links' directions are to move.
    moves: Vec<Vec3>,
}

impl Scratch {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            acrosses: vec![Across::ZERO; count],
            bends: vec![Bend::STRAIGHT; count],
            eliminations: vec![Elimination::ZERO; count],
            moves: vec![Vec3::ZERO; count],
        }
    }
}

/// The axes across a link of a frame without twist, in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Across<T = Lane> {
    pub first: Vec3<T>,
    pub second: Vec3<T>,
}
stored!(Across { first, second });

/// How a joint is bent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bend<T = Lane> {
    /// 2 tan(angle / 2), in the direction that the link has over that before it, in the axes of either.
    pub turn: Vec2<T>,
    /// 1 / cos^2(angle / 2).
    pub sharp: T,
}
stored!(Bend { turn, sharp });

impl Across {
    pub(crate) const ZERO: Self = Self {
        first: Vec3::ZERO,
        second: Vec3::ZERO,
    };
}

impl Bend {
    pub(crate) const STRAIGHT: Self = Self {
        turn: Vec2 {
            x: Lane::ZERO,
            y: Lane::ZERO,
        },
        sharp: Lane::ONE,
    };
}

/// From a link along `t` to one along `next`, by the least turn.
#[inline(always)]
fn onward<T: Number>(t: Vec3<T>, across: Across<T>, next: Vec3<T>) -> (Across<T>, Bend<T>) {
    let sharp = T::splat(2.0) / (t.dot(next) + T::splat(1.0));
    let turn = Vec2::new(
        across.first.dot(next) * sharp,
        across.second.dot(next) * sharp,
    );
    let middle = (t + next) * 0.5;
    let across = Across {
        first: across.first - middle.scale(turn.x),
        second: across.second - middle.scale(turn.y),
    };
    (across, Bend { turn, sharp })
}

/// Goes along the joints from the skin's frame `base` by the `tangent` of every link: its axes, and the joint's bend. Links that only
/// fill the batch go on as the one before.
#[inline(always)]
fn along<T: Number>(
    base: &Quat,
    links: &[Link],
    tangent: impl Fn(usize) -> Vec3<T>,
    mut joint: impl FnMut(usize, Across<T>, Bend<T>),
) {
    let [first, second, mut t] = base.load::<T>().axes();
    let mut across = Across { first, second };
    for (k, link) in links.iter().enumerate() {
        let is_link = T::splat(0.0).less(link.length.load());
        let next = Vec3::choose(is_link, tangent(k), t);
        let bend;
        (across, bend) = onward(t, across, next);
        t = next;
        joint(k, across, bend);
    }
}

/// The turn of every joint along its axis, in the frame of its link, by the links' tangents.
pub(crate) fn turns<T: Number>(base: &Quat, links: &[Link], tangents: &[Vec3], out: &mut [Vec3]) {
    T::run(
        #[inline(always)]
        move || {
            turns_by::<T>(
                base,
                links,
                #[inline(always)]
                |k| tangents[k].load(),
                out,
            );
        },
    );
}

/// The same by the particles.
pub(crate) fn turns_of<T: Number>(base: &Quat, links: &[Link], y: &[Vec3], out: &mut [Vec3]) {
    T::run(
        #[inline(always)]
        move || {
            turns_by::<T>(
                base,
                links,
                #[inline(always)]
                |k| direction(links, y, k),
                out,
            );
        },
    );
}

#[inline(always)]
fn turns_by<T: Number>(
    base: &Quat,
    links: &[Link],
    tangent: impl Fn(usize) -> Vec3<T>,
    out: &mut [Vec3],
) {
    along(
        base,
        links,
        tangent,
        #[inline(always)]
        |k, _, bend| {
            let zero = T::splat(0.0);
            out[k] = Vec3::new(-bend.turn.y, bend.turn.x, zero).store();
        },
    );
}

/// The direction of link `k` by the particles.
#[inline(always)]
fn direction<T: Number>(links: &[Link], y: &[Vec3], k: usize) -> Vec3<T> {
    chord(y, k).scale(T::splat(1.0) / links[k].length.load())
}

/// Lays a chain out by the `direction` of each link, which is told the one that it has.
#[inline(always)]
fn lay_out<T: Number>(
    links: &[Link],
    chain: &mut Chain,
    mut direction: impl FnMut(usize, Vec3<T>) -> Vec3<T>,
) {
    let count = links.len();
    let (ys, tangents) = (&mut chain.y[..count], &mut chain.tangents[..count]);
    let mut y = Vec3::zero();
    for k in 0..count {
        let next = direction(k, tangents[k].load());
        y += next.scale(links[k].length.load());
        ys[k] = y.store();
        tangents[k] = next.store();
    }
}

/// Points every link along the free motion from the particles `before`; one whose way is not clear goes on as `carry` takes it.
pub(crate) fn predict<T: Number>(
    links: &[Link],
    mut free: FreeMotion,
    carry: Quat,
    before: &[Vec3],
    chain: &mut Chain,
) {
    T::run(
        #[inline(always)]
        move || {
            let before = &before[..links.len()];
            let mut end = Vec3::<T>::zero();
            let mut next = Vec3::zero();
            lay_out(
                links,
                chain,
                #[inline(always)]
                |k, _| {
                    let place = free.place(k);
                    let way = place - end;
                    end = place;
                    let length = links[k].length.load::<T>();
                    let squared = way.length_squared();
                    let size = squared.sqrt();
                    let ahead = way.scale(T::splat(1.0) / size);
                    let chord = chord::<T>(before, k);
                    let is_clear = (length * length * T::splat(0.01)).less(squared);
                    let is_ahead = T::splat(0.0).less(chord.dot(way));
                    if T::all(is_clear) && T::all(is_ahead) {
                        next = ahead;
                        return next;
                    }
                    let carried = carry.load().rotate(chord.scale(T::splat(1.0) / length));
                    let is_on = (size * T::splat(-0.95)).less(carried.dot(way));
                    let turned = Vec3::choose(is_on, ahead, carried);
                    let turned = Vec3::choose(is_ahead, ahead, turned);
                    let turned = Vec3::choose(is_clear, turned, carried);
                    // What only fills the batch goes on as the link before.
                    next = Vec3::choose(T::splat(0.0).less(length), turned, next);
                    next
                },
            );
        },
    );
}

/// One Newton step, in which no link of the lanes in `which` turns by more than `most` (radians). Returns the largest turn that it
/// asks for, and the square of 1 / cos(angle / 2) of the sharpest joint.
pub(crate) fn newton<T: Number>(
    links: &[Link],
    model: &Model,
    chain: &mut Chain,
    scratch: &mut Scratch,
    most: f64,
    which: Mask,
) -> (Lane, Lane) {
    T::run(
        #[inline(always)]
        move || {
            bend_joints::<T>(model.base, links, chain, scratch);
            let sharpest = ascend::<T>(links, chain, model, scratch);
            let Scratch {
                acrosses,
                eliminations,
                moves,
                ..
            } = scratch;
            let largest = descend::<T>(links, acrosses, eliminations, moves);
            let scale = (Lane::splat(most) / largest).min(Lane::ONE);
            turn_links::<T>(links, chain, moves, scale, which);
            (largest, sharpest)
        },
    )
}

/// Makes the joints of a chain ready for [`ascend`].
#[inline(always)]
fn bend_joints<T: Number>(base: &Quat, links: &[Link], chain: &Chain, scratch: &mut Scratch) {
    let count = links.len();
    let tangents = &chain.tangents[..count];
    let (acrosses, bends) = (&mut scratch.acrosses[..count], &mut scratch.bends[..count]);
    along::<T>(
        base,
        links,
        #[inline(always)]
        |k| tangents[k].load(),
        #[inline(always)]
        |k, across, bend| {
            acrosses[k] = across.store();
            bends[k] = bend.store();
        },
    );
}

/// What the way back needs of a joint: f = before p - alone - shift x.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Elimination<T = Lane> {
    first: Vec3<T>,
    second: Vec3<T>,
    before: Sym2<T>,
    alone: Vec2<T>,
}
stored!(Elimination {
    first,
    second,
    before,
    alone
});

impl Elimination {
    pub(crate) const ZERO: Self = Self {
        first: Vec3::ZERO,
        second: Vec3::ZERO,
        before: Sym2 {
            xx: Lane::ZERO,
            yy: Lane::ZERO,
            xy: Lane::ZERO,
        },
        alone: Vec2 {
            x: Lane::ZERO,
            y: Lane::ZERO,
        },
    };
}

/// The quadratic of what lies beyond a joint, of its shift and of how the link before moves its direction; and the sum of forces there.
struct Beyond<T> {
    a: Sym3<T>,
    /// Columns.
    c: Across<T>,
    d: Sym2<T>,
    a_linear: Vec3<T>,
    d_linear: Vec2<T>,
    force: Vec3<T>,
}

/// From tip to root, as [`super::curled::sweep::ascend`]. Returns how sharp the sharpest joint is.
#[inline(always)]
fn ascend<T: Number>(links: &[Link], chain: &Chain, model: &Model, scratch: &mut Scratch) -> Lane {
    let count = links.len();
    let (y, tangents) = (&chain.y[..count], &chain.tangents[..count]);
    let (acrosses, bends) = (&scratch.acrosses[..count], &scratch.bends[..count]);
    let (nodes, past) = (&model.nodes[..count], &model.past[..count]);
    let out = &mut scratch.eliminations[..count];
    let damps = model.elastic.damping != Lane::ZERO;
    let elastic = model.elastic.load::<T>();
    let zero = Vec3::<T>::zero();
    let mut sharpest = T::splat(1.0);
    let mut spin = Spin {
        torque: T::splat(0.0),
        bend: Vec2::zero(),
    };
    let mut beyond = Beyond {
        a: Sym3::diagonal(T::splat(0.0)),
        c: Across {
            first: zero,
            second: zero,
        },
        d: Sym2::diagonal(T::splat(0.0)),
        a_linear: zero,
        d_linear: Vec2::zero(),
        force: zero,
    };
    for k in (0..count).rev() {
        let bend: Bend<T> = bends[k].load();
        // Links that only fill the batch have no say.
        let sharp = bend.sharp * links[k].counts.load();
        sharpest = T::choose(sharpest.less(sharp), sharp, sharpest);
        let past = if damps {
            let about_axis = past[k].load::<T>();
            Vec2::new(about_axis.y, -about_axis.x)
        } else {
            Vec2::zero()
        };
        let joint = JointMoment::new(bend, past, links[k].bend.load(), &elastic);
        if damps {
            let moment = spin.pass(bend.turn, past, joint.damping);
            beyond.d_linear = beyond.d_linear + moment;
        }
        let link = Directed {
            t: tangents[k].load(),
            across: acrosses[k].load(),
            length: links[k].length.load(),
        };
        let elimination;
        (beyond, elimination) = eliminate(beyond, y[k].load(), link, nodes[k].load(), joint);
        out[k] = elimination.store();
    }
    sharpest.store()
}

/// Moment on a joint, its stiffness, and stiffness against a change from the past, all times h^2.
struct JointMoment<T> {
    moment: Vec2<T>,
    stiffness: T,
    damping: T,
}

impl<T: Number> JointMoment<T> {
    #[inline(always)]
    fn new(bend: Bend<T>, past: Vec2<T>, stiffness: T, elastic: &Elastic<T>) -> Self {
        let stretch = elastic.damping + T::splat(1.0);
        let stiffness = stiffness * elastic.h2;
        let slope = stiffness * bend.sharp;
        let e = bend.turn.scale(stretch) - past.scale(elastic.damping);
        Self {
            moment: e.scale(slope),
            stiffness: slope * bend.sharp * stretch,
            damping: stiffness * elastic.damping,
        }
    }
}

/// What damping does to links by way of the frames. A link that moves across the plane in which its joints bend spins all frames
/// beyond it about their tangents, by half of b_y f_x - b_x f_y at either joint; and what a frame's spin does to the turn b of
/// a joint, damping resists, as it holds to where b was in the frame.
struct Spin<T> {
    /// Sum over the joints beyond.
    torque: T,
    /// The turn of the joint at the link's end.
    bend: Vec2<T>,
}

impl<T: Number> Spin<T> {
    /// The slope of the energy of damping in a link's direction by way of the frames beyond; then goes on to the link before, over the
    /// joint of `turn`, which damping with `stiffness` holds to `past`.
    #[inline(always)]
    fn pass(&mut self, turn: Vec2<T>, past: Vec2<T>, stiffness: T) -> Vec2<T> {
        let both = (turn + self.bend).scale(self.torque * T::splat(0.5));
        self.torque = self.torque + stiffness * (past.y * turn.x - past.x * turn.y);
        self.bend = turn;
        Vec2::new(both.y, -both.x)
    }
}

/// A link as the sweep sees it.
struct Directed<T> {
    t: Vec3<T>,
    across: Across<T>,
    length: T,
}

/// Adds a link with a particle at its end `y`, and eliminates its direction.
#[inline(always)]
fn eliminate<T: Number>(
    beyond: Beyond<T>,
    y: Vec3<T>,
    link: Directed<T>,
    node: Node<T>,
    joint: JointMoment<T>,
) -> (Beyond<T>, Elimination<T>) {
    // The particle at the link's end.
    let gradient = node.n.apply(y) - node.b;
    let a = beyond.a + node.n;
    let a_linear = beyond.a_linear + gradient;
    let force = beyond.force + gradient;

    // How the link's direction moves its end, and W = C + A U, which couples it to the joint's shift.
    let (u, v) = (
        link.across.first.scale(link.length),
        link.across.second.scale(link.length),
    );
    let c = beyond.c;
    let (wu, wv) = (c.first + a.apply(u), c.second + a.apply(v));
    // Tension stiffens the link against turning; compression is left out, which keeps the step downhill.
    let (zero, tension) = (T::splat(0.0), -(force.dot(link.t) * link.length));
    let tension = T::choose(tension.less(zero), zero, tension);
    let own = Sym2 {
        xx: u.dot(wu) + (u.dot(c.first) + (beyond.d.xx + tension)),
        yy: v.dot(wv) + (v.dot(c.second) + (beyond.d.yy + tension)),
        xy: u.dot(wv) + (v.dot(c.first) + beyond.d.xy),
    };
    let own_linear = beyond.d_linear + Vec2::new(u.dot(a_linear), v.dot(a_linear));

    // The joint's spring, between the link before and this one. Cofactors in place of the inverse: only the last product of each
    // result waits for the quotient.
    let JointMoment {
        moment, stiffness, ..
    } = joint;
    let cofactors = Sym2 {
        xx: own.yy + stiffness,
        yy: own.xx + stiffness,
        xy: -own.xy,
    };
    let share = T::splat(1.0) / (cofactors.xx * cofactors.yy - own.xy * own.xy);
    let first = wu.scale(cofactors.xx) + wv.scale(cofactors.xy);
    let second = wu.scale(cofactors.xy) + wv.scale(cofactors.yy);
    let alone = cofactors.apply(own_linear + moment);
    let passed_on = share * stiffness;

    let beyond = Beyond {
        a: Sym3 {
            xx: a.xx - (wu.x * first.x + wv.x * second.x) * share,
            yy: a.yy - (wu.y * first.y + wv.y * second.y) * share,
            zz: a.zz - (wu.z * first.z + wv.z * second.z) * share,
            xy: a.xy - (wu.x * first.y + wv.x * second.y) * share,
            xz: a.xz - (wu.x * first.z + wv.x * second.z) * share,
            yz: a.yz - (wu.y * first.z + wv.y * second.z) * share,
        },
        c: Across {
            first: first.scale(passed_on),
            second: second.scale(passed_on),
        },
        // stiffness - stiffness inverse stiffness, without the difference of large numbers; and so is the linear part.
        d: own.times(cofactors).scale(passed_on),
        a_linear: a_linear - (wu.scale(alone.x) + wv.scale(alone.y)).scale(share),
        d_linear: own_linear - own.apply(alone).scale(share),
        force,
    };
    let elimination = Elimination {
        first: first.scale(share),
        second: second.scale(share),
        before: cofactors.scale(passed_on),
        alone: alone.scale(share),
    };
    (beyond, elimination)
}

/// From root to tip: how every link's direction moves, in the world, into `moves`. Returns the largest.
#[inline(always)]
fn descend<T: Number>(
    links: &[Link],
    acrosses: &[Across],
    eliminations: &[Elimination],
    moves: &mut [Vec3],
) -> Lane {
    let count = links.len();
    let (acrosses, eliminations) = (&acrosses[..count], &eliminations[..count]);
    let moves = &mut moves[..count];
    let mut shift = Vec3::<T>::zero();
    let mut f = Vec2::<T>::zero();
    let mut largest = T::splat(0.0);
    for k in 0..count {
        let e: Elimination<T> = eliminations[k].load();
        let across: Across<T> = acrosses[k].load();
        let shifted = Vec2::new(e.first.dot(shift), e.second.dot(shift));
        f = e.before.apply(f) - (e.alone + shifted);
        let moved = across.first.scale(f.x) + across.second.scale(f.y);
        moves[k] = moved.store();
        shift += moved.scale(links[k].length.load());
        let squared = (f.x * f.x + f.y * f.y) * links[k].counts.load();
        // NaN stays: every link after it has it too.
        largest = T::choose(squared.less(largest), largest, squared);
    }
    largest.sqrt().store()
}

/// Turns the links of the lanes in `which` by `scale` times `moves`, and moves the particles along.
#[inline(always)]
fn turn_links<T: Number>(
    links: &[Link],
    chain: &mut Chain,
    moves: &[Vec3],
    scale: Lane,
    which: Mask,
) {
    let moves = &moves[..links.len()];
    let (scale, which) = (scale.load::<T>(), T::condition(&which));
    let one = T::splat(1.0);
    lay_out(
        links,
        chain,
        #[inline(always)]
        |k, tangent| {
            // The rotation whose Rodrigues vector is half of t x move: as `Quat::turned`.
            let half = moves[k].load().scale(scale) * 0.5;
            let s = half.length_squared();
            let turned = (tangent.scale(one - s) + half + half).scale(one / (one + s));
            Vec3::choose(which, turned, tangent)
        },
    );
}

/// The frames of the links through particles, carried along without twist from the skin's.
pub(crate) fn frames<T: Number>(base: &Quat, links: &[Link], y: &[Vec3], out: &mut [Quat]) {
    T::run(
        #[inline(always)]
        move || {
            let (y, out) = (&y[..links.len()], &mut out[..links.len()]);
            let mut frames = Frames::<T>::new(base);
            for (k, link) in links.iter().enumerate() {
                out[k] = frames.go_on(link, chord(y, k)).store();
            }
        },
    );
}

/// Frames along links, one after the other.
pub(crate) struct Frames<T> {
    /// Of the link before, and its third axis.
    frame: Quat<T>,
    t: Vec3<T>,
}

impl<T: Number> Frames<T> {
    /// From the skin's frame.
    #[inline(always)]
    pub(crate) fn new(base: &Quat) -> Self {
        let frame: Quat<T> = base.load();
        Self {
            frame,
            t: frame.tangent(),
        }
    }

    /// The frame of the next link, whose particles are `chord` apart.
    #[inline(always)]
    pub(crate) fn go_on(&mut self, link: &Link, chord: Vec3<T>) -> Quat<T> {
        let length = link.length.load();
        let next = chord.scale(T::splat(1.0) / length);
        let next = Vec3::choose(T::splat(0.0).less(length), next, self.t);
        let w = self.t.dot(next) + T::splat(1.0);
        // The length of this quaternion is sqrt(2 w).
        let s = T::splat(1.0) / (w + w).sqrt();
        let turn = Quat {
            v: self.t.cross(next).scale(s),
            w: w * s,
        };
        // Between links that are folded on each other there is no least turn.
        let is_turn = T::splat(1e-9).less(w);
        self.frame = Quat::choose(is_turn, turn.times(self.frame), self.frame);
        self.t = next;
        self.frame
    }
}

/// Of chains through these particles.
pub(crate) fn energy_of<T: Number>(
    batch: &Batch,
    base: &Quat,
    y: &[Vec3],
    pull: &Vec3,
) -> ShapeEnergy {
    T::run(
        #[inline(always)]
        move || {
            energy_by::<T>(
                batch,
                base,
                y,
                #[inline(always)]
                |k| direction(&batch.links, y, k),
                pull,
            )
        },
    )
}

/// Of a chain.
pub(crate) fn energy<T: Number>(
    batch: &Batch,
    base: &Quat,
    chain: &Chain,
    pull: &Vec3,
) -> ShapeEnergy {
    T::run(
        #[inline(always)]
        move || {
            energy_by::<T>(
                batch,
                base,
                &chain.y,
                #[inline(always)]
                |k| chain.tangents[k].load(),
                pull,
            )
        },
    )
}

#[inline(always)]
fn energy_by<T: Number>(
    batch: &Batch,
    base: &Quat,
    y: &[Vec3],
    tangent: impl Fn(usize) -> Vec3<T>,
    pull: &Vec3,
) -> ShapeEnergy {
    let (mut elastic, mut weight) = (T::splat(0.0), T::splat(0.0));
    let (mut before, pull) = (base.load::<T>().tangent(), pull.load::<T>());
    for (k, link) in batch.links.iter().enumerate() {
        let mass: T = batch.particles[k].mass.load();
        weight = weight - mass * y[k].load().dot(pull);
        // Of an angle between two unit vectors: the tangent of its half is their difference over their sum.
        let length = link.length.load::<T>();
        let t = Vec3::choose(T::splat(0.0).less(length), tangent(k), before);
        let (difference, sum) = (t - before, t + before);
        let tangent_squared = difference.length_squared() / sum.length_squared();
        elastic = elastic + link.bend.load::<T>() * tangent_squared * T::splat(2.0);
        before = t;
    }
    ShapeEnergy {
        elastic: elastic.store(),
        weight: weight.store(),
    }
}

/// Carries the lanes in `which` along with the skin.
pub(crate) fn carry(batch: &Batch, state: &mut BatchState, turn: Quat, which: Mask) {
    for y in &mut state.y[..batch.count()] {
        *y = Vec3::pick(which, turn.rotate(*y), *y);
    }
}

#[cfg(test)]
mod tests;
