//! One Newton step of a whole strand in O(n): from tip to root and back.
//!
//! A stage of the integrator minimises, over the rotations of the links,
//!
//! ```text
//! sum over particles of  1/2 y . N y - b . y     +    h^2 sum over joints of  1/2 e . B e,
//! ```
//!
//! where y are the particles from the root, N and b gather mass and every force that acts on a particle
//! ([`Node`]), and e = u - natural is the joint's turn beyond its rest (u = 2 tan(angle / 2) times the axis). Links are rigid, so
//! a small turn f of link k moves its end by f x r. What lies beyond joint k is then a quadratic of the shift x of
//! the joint and the turn p of the link before:
//!
//! ```text
//! V(x, p) = 1/2 x . A x + x . C p + 1/2 p . D p + a . x + d . p
//! ```
//!
//! Adding a link and eliminating its turn gives the next such quadratic: this is the articulated-body recursion
//! (Featherstone 1983) in coordinates of rotation, with the joints' springs inside, as an implicit step needs them.
//!
//! What the joints add doesn't wait for the recursion, so it is made ready before ([`joints`]): that loop has nothing to
//! wait for, and the other less to do.

use crate::{
    lanes::{Lane, Mat3, Number, Quat, Sym3, Vec3, stored},
    solver::{
        chain::Chain,
        link::{Elastic, Link, Node},
        stage::Model,
    },
};

/// Moment on a joint and its stiffness, in world axes, both times h^2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointMoment<T = Lane> {
    moment: Vec3<T>,
    stiffness: Sym3<T>,
}
stored!(JointMoment { moment, stiffness });

impl<T: Number> JointMoment<T> {
    pub(crate) fn zero() -> Self {
        Self {
            moment: Vec3::zero(),
            stiffness: Sym3::diagonal(T::splat(0.0)),
        }
    }
}

/// What the way back needs of a joint: turn = before p - alone - shift x.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Elimination<T = Lane> {
    shift: Mat3<T>,
    before: Mat3<T>,
    alone: Vec3<T>,
}
stored!(Elimination {
    shift,
    before,
    alone
});

impl<T: Number> Elimination<T> {
    pub(crate) fn zero() -> Self {
        Self {
            shift: Mat3::zero(),
            before: Mat3::zero(),
            alone: Vec3::zero(),
        }
    }
}

/// The turn c = tan(angle / 2) times the axis, from frame to frame, in either frame.
#[inline(always)]
pub(crate) fn half_turn<T: Number>(before: Quat<T>, after: Quat<T>) -> Vec3<T> {
    let q = before.conjugate().times(after);
    q.v.scale(T::splat(1.0) / q.w)
}

/// Makes the joints ready. `past[k]` is the turn that damping holds to. Returns the square of 1 / cos(angle / 2) of the sharpest
/// joint: how much faster than its angle a joint's turn grows, which is 1 where it is straight and has no bound at half a
/// turn.
#[inline(always)]
pub(crate) fn joints<T: Number>(
    links: &[Link],
    model: &Model,
    chain: &Chain,
    out: &mut [JointMoment],
) -> Lane {
    let count = links.len();
    let (frames, tangents) = (&chain.frames[..count], &chain.tangents[..count]);
    let (past, out) = (&model.past[..count], &mut out[..count]);
    let mut sharpest = T::splat(1.0);
    for k in 0..count {
        let before = if k == 0 { model.base } else { &frames[k - 1] };
        let (joint, sharp): (JointMoment<T>, T) = joint(
            &links[k].load(),
            past[k].load(),
            before.load(),
            frames[k].load(),
            tangents[k].load(),
            &model.elastic.load(),
        );
        sharpest = T::choose(sharpest.less(sharp), sharp, sharpest);
        out[k] = joint.store();
    }
    sharpest.store()
}

/// Of the turn from `before` to `after`, whose third axis is `t`; and how sharp it is.
#[inline(always)]
fn joint<T: Number>(
    link: &Link<T>,
    past: Vec3<T>,
    before: Quat<T>,
    after: Quat<T>,
    t: Vec3<T>,
    elastic: &Elastic<T>,
) -> (JointMoment<T>, T) {
    let one = T::splat(1.0);
    let stretch = elastic.damping + one;
    let turn = after.times(before.conjugate());
    let c = turn.v.scale(one / turn.w);
    // u - natural + (u - past) damping, with u = 2 c.
    let rest = after.rotate(link.natural + past.scale(elastic.damping));
    let e = c.scale(stretch + stretch) - rest;
    let bend = link.bend * elastic.h2;
    let more = link.twist * elastic.h2 - bend;
    let e = e.scale(bend) + t.scale(more * e.dot(t));
    // du = G df with G = 1 + [c] + c c^T; the moment is G^T B e.
    let moment = e - c.cross(e) + c.scale(c.dot(e));
    // G^T B G = bend (1 + c c) (1 + c c^T) + (twist - bend) g g^T with g = G^T t.
    let g = c.scale(c.dot(t)) + t + t.cross(c);
    let sharp = c.length_squared() + one;
    let round = bend * sharp * stretch;
    let stiffness = Sym3::outer(round, c, round) + Sym3::outer(T::splat(0.0), g, more * stretch);
    (JointMoment { moment, stiffness }, sharp)
}

/// The quadratic of what lies beyond a joint (see the module), and the sum of forces there.
struct Beyond<T = Lane> {
    a: Sym3<T>,
    c_columns: Mat3<T>,
    d: Sym3<T>,
    a_linear: Vec3<T>,
    d_linear: Vec3<T>,
    force: Vec3<T>,
}

/// From tip to root: fills `out` with what [`descend`] needs. `chain.y[k]`, `chain.tangents[k]` and `nodes[k]` are of link k
/// and the particle at its end, `joints[k]` is at its start.
#[inline(always)]
pub(crate) fn ascend<T: Number>(
    links: &[Link],
    nodes: &[Node],
    chain: &Chain,
    joints: &[JointMoment],
    out: &mut [Elimination],
) {
    let count = links.len();
    let (y, tangents) = (&chain.y[..count], &chain.tangents[..count]);
    let (nodes, joints) = (&nodes[..count], &joints[..count]);
    let out = &mut out[..count];
    let mut beyond = Beyond {
        a: Sym3::<T>::diagonal(T::splat(0.0)),
        c_columns: Mat3::zero(),
        d: Sym3::diagonal(T::splat(0.0)),
        a_linear: Vec3::zero(),
        d_linear: Vec3::zero(),
        force: Vec3::zero(),
    };
    for k in (0..count).rev() {
        let t: Vec3<T> = tangents[k].load();
        let r = t.scale(links[k].length.load());
        let elimination;
        let (node, joint) = (nodes[k].load(), joints[k].load());
        (beyond, elimination) = eliminate(beyond, y[k].load(), t, r, node, joint);
        out[k] = elimination.store();
    }
}

/// Adds a link along `r` with a particle at its end `y`, and eliminates its turn.
#[inline(always)]
fn eliminate<T: Number>(
    beyond: Beyond<T>,
    y: Vec3<T>,
    t: Vec3<T>,
    r: Vec3<T>,
    node: Node<T>,
    joint: JointMoment<T>,
) -> (Beyond<T>, Elimination<T>) {
    // The particle at the link's end.
    let gradient = node.n.apply(y) - node.b;
    let a = beyond.a + node.n;
    let a_linear = beyond.a_linear + gradient;
    let force = beyond.force + gradient;

    // Its place is that of the joint plus f x r. Columns of W = C - A [r], which couples the joint's shift to the
    // link's turn:
    let c = beyond.c_columns;
    let w = c - a.rows().times_cross(r).transpose();
    let rw = Mat3(r.cross(w.0), r.cross(w.1), r.cross(w.2));
    let rc = Mat3(r.cross(c.0), r.cross(c.1), r.cross(c.2));
    // Tension stiffens the link against turning; compression is left out, which keeps the step downhill.
    let (zero, tension) = (T::splat(0.0), -force.dot(r));
    let tension = T::choose(tension.less(zero), zero, tension);
    let d = beyond.d;
    let own = Sym3 {
        xx: d.xx + rc.0.x + rw.0.x,
        yy: d.yy + rc.1.y + rw.1.y,
        zz: d.zz + rc.2.z + rw.2.z,
        xy: d.xy + rc.0.y + rw.1.x,
        xz: d.xz + rc.0.z + rw.2.x,
        yz: d.yz + rc.1.z + rw.2.y,
    } + Sym3::outer(tension, t, -tension);
    let own_linear = beyond.d_linear + r.cross(a_linear);

    // The joint's spring, between the link before and this one.
    let JointMoment { moment, stiffness } = joint;
    let inverse = (own + stiffness).inverse().rows();
    let shift = inverse.times(w); // of W^T, whose rows are W's columns
    let before = inverse.times(stiffness.rows());
    let alone = inverse.apply(own_linear + moment);

    let w = w.transpose();
    let beyond = Beyond {
        a: a - Sym3::upper_of_product(w, shift),
        c_columns: w.times(before).transpose(),
        d: Sym3::upper_of_product(own.rows(), before),
        a_linear: a_linear - w.apply(alone),
        // stiffness alone - moment, without the difference of large numbers.
        d_linear: own_linear - own.apply(alone),
        force,
    };
    let elimination = Elimination {
        shift,
        before,
        alone,
    };
    (beyond, elimination)
}

/// From root to tip: the turn of every link, in world axes, into `turns`. Returns the largest.
#[inline(always)]
pub(crate) fn descend<T: Number>(
    links: &[Link],
    tangents: &[Vec3],
    eliminations: &[Elimination],
    turns: &mut [Vec3],
) -> Lane {
    let count = links.len();
    let (tangents, eliminations) = (&tangents[..count], &eliminations[..count]);
    let turns = &mut turns[..count];
    let mut shift = Vec3::<T>::zero();
    let mut turn = Vec3::<T>::zero();
    let mut largest = T::splat(0.0);
    for k in 0..count {
        let e: Elimination<T> = eliminations[k].load();
        turn = e.before.apply(turn) - e.alone - e.shift.apply(shift);
        turns[k] = turn.store();
        shift += turn.cross(tangents[k].load().scale(links[k].length.load()));
        let squared = turn.length_squared() * links[k].counts.load();
        // NaN stays: every turn after it is NaN too.
        largest = T::choose(squared.less(largest), largest, squared);
    }
    largest.sqrt().store()
}

/// The energy that a stage minimises: it goes down in every step that is accepted.
pub(crate) fn potential(links: &[Link], model: &Model, chain: &Chain) -> Lane {
    let mut sum = Lane::ZERO;
    let mut before = *model.base;
    for (k, link) in links.iter().enumerate() {
        let (y, node) = (chain.y[k], &model.nodes[k]);
        sum += (node.n.apply(y) * 0.5 - node.b).dot(y);
        let c = half_turn(before, chain.frames[k]);
        let u = c + c;
        let (e, rate) = (u - link.natural, u - model.past[k]);
        let weigh = |v: Vec3| (v.x * v.x + v.y * v.y) * link.bend + v.z * v.z * link.twist;
        let elastic = &model.elastic;
        sum += (weigh(e) + weigh(rate) * elastic.damping) * elastic.h2 * 0.5;
        before = chain.frames[k];
    }
    sum
}

#[cfg(test)]
mod properties;
