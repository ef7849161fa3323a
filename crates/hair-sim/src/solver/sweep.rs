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

use crate::lanes::{Lane, Mat3, Quat, Sym3, Vec3};

use super::batch::Link;

/// The quadratic model of what acts on one particle: its gradient at y is N y - b.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub n: Sym3,
    pub b: Vec3,
}

impl Node {
    pub(crate) const ZERO: Self = Self {
        n: Sym3::ZERO,
        b: Vec3::ZERO,
    };

    #[inline(always)]
    pub(crate) fn gradient(&self, y: Vec3) -> Vec3 {
        self.n.apply(y) - self.b
    }
}

/// What the way back needs of a joint: turn = q p - s - t x.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Elimination {
    shift: Mat3,
    before: Mat3,
    alone: Vec3,
}

impl Elimination {
    pub(crate) const ZERO: Self = Self {
        shift: Mat3::ZERO,
        before: Mat3::ZERO,
        alone: Vec3::ZERO,
    };
}

/// How joints resist in a stage.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Elastic {
    /// The square of the stage's length in s.
    pub h2: Lane,
    /// Time of damping over the time from `past` to the stage's end.
    pub damping: Lane,
}

/// The turn c = tan(angle / 2) times the axis, from frame to frame, in either frame.
#[inline(always)]
pub(crate) fn half_turn(before: Quat, after: Quat) -> Vec3 {
    let q = before.conjugate().times(after);
    q.v * q.w.recip()
}

/// Moment on the joint and its stiffness in world axes, both times h^2.
#[inline(always)]
fn joint(link: &Link, c: Vec3, past: Vec3, after: Quat, elastic: &Elastic) -> (Vec3, Sym3) {
    let u = c + c;
    let e = u - link.natural + (u - past) * elastic.damping;
    let (bend, twist) = (link.bend * elastic.h2, link.twist * elastic.h2);
    let e = Vec3::new(e.x * bend, e.y * bend, e.z * twist);
    // du = G df with G = 1 + [c] + c c^T; the moment is G^T B e.
    let moment = e - c.cross(e) + c * c.dot(e);
    // G^T B G = bend (1 + c c) (1 + c c^T) + (twist - bend) g g^T, g the last row of G.
    let g = Vec3::new(c.x * c.z - c.y, c.y * c.z + c.x, Lane::ONE + c.z * c.z);
    let stretch = elastic.damping + Lane::ONE;
    let round = bend * (c.length_squared() + 1.0) * stretch;
    let [ax, ay, az] = after.axes();
    let axes = Mat3(ax, ay, az);
    let stiffness = Sym3::diagonal(round)
        + Sym3::outer(axes.combine(c), round)
        + Sym3::outer(axes.combine(g), (twist - bend) * stretch);
    (axes.combine(moment), stiffness)
}

/// From tip to root: fills `out` with what [`descend`] needs. `y[k]`, `frames[k]` and `nodes[k]` are of link k
/// and the particle at its end; `past[k]` is the turn that damping holds to.
#[inline(always)]
pub(crate) fn ascend(
    links: &[Link],
    pose: Pose,
    nodes: &[Node],
    past: &[Vec3],
    elastic: &Elastic,
    out: &mut [Elimination],
) {
    let count = links.len();
    let (y, frames) = (&pose.y[..count], &pose.frames[..count]);
    let (nodes, past, out) = (&nodes[..count], &past[..count], &mut out[..count]);
    let mut a = Sym3::ZERO;
    let mut c_columns = [Vec3::ZERO; 3];
    let mut d = Sym3::ZERO;
    let mut a_linear = Vec3::ZERO;
    let mut d_linear = Vec3::ZERO;
    let mut force = Vec3::ZERO;
    for k in (0..count).rev() {
        let link = &links[k];
        // The particle at the link's end.
        let gradient = nodes[k].gradient(y[k]);
        a += nodes[k].n;
        a_linear += gradient;
        force += gradient;

        // Its place is that of the joint plus f x r.
        let after = frames[k];
        let t = after.tangent();
        let r = t * link.length;
        let arows = a.rows();
        // Columns of W = C - A [r], which couples the joint's shift to the link's turn.
        let ar = arows.times_cross(r).columns();
        let w = [
            c_columns[0] - ar[0],
            c_columns[1] - ar[1],
            c_columns[2] - ar[2],
        ];
        let rw = [r.cross(w[0]), r.cross(w[1]), r.cross(w[2])];
        let rc = [
            r.cross(c_columns[0]),
            r.cross(c_columns[1]),
            r.cross(c_columns[2]),
        ];
        // Tension stiffens the link against turning; compression is left out, which keeps the step downhill.
        let tension = (-force.dot(r)).max(Lane::ZERO);
        let own = Sym3 {
            xx: d.xx + rw[0].x + rc[0].x,
            yy: d.yy + rw[1].y + rc[1].y,
            zz: d.zz + rw[2].z + rc[2].z,
            xy: d.xy + rw[1].x + rc[0].y,
            xz: d.xz + rw[2].x + rc[0].z,
            yz: d.yz + rw[2].y + rc[1].z,
        } + Sym3::diagonal(tension)
            - Sym3::outer(t, tension);
        let own_linear = d_linear + r.cross(a_linear);

        // The joint's spring, between the link before and this one.
        let before = if k == 0 { pose.base } else { frames[k - 1] };
        let half = half_turn(before, after);
        let (moment, stiffness) = joint(link, half, past[k], after, elastic);
        let inverse = (own + stiffness).inverse().rows();
        let w_rows = Mat3(w[0], w[1], w[2]); // W^T
        let shift = inverse.times(w_rows);
        let before = inverse.times(stiffness.rows());
        let alone = inverse.apply(own_linear + moment);
        out[k] = Elimination {
            shift,
            before,
            alone,
        };

        let w_matrix = w_rows.transpose();
        a = a - Sym3::upper_of_product(w_matrix, shift);
        c_columns = w_matrix.times(before).columns();
        d = Sym3::upper_of_product(own.rows(), before);
        a_linear = a_linear - w_matrix.apply(alone);
        d_linear = stiffness.apply(alone) - moment;
    }
}

/// A strand's shape: particles from the root, frames of links, and the frame of the skin.
#[derive(Clone, Copy)]
pub(crate) struct Pose<'a> {
    pub base: Quat,
    pub y: &'a [Vec3],
    pub frames: &'a [Quat],
}

/// From root to tip: the turn of every link, in world axes, into `turns`. Returns the square of the largest.
#[inline(always)]
pub(crate) fn descend(
    links: &[Link],
    frames: &[Quat],
    eliminations: &[Elimination],
    turns: &mut [Vec3],
) -> Lane {
    let count = links.len();
    let (frames, eliminations, turns) = (
        &frames[..count],
        &eliminations[..count],
        &mut turns[..count],
    );
    let mut shift = Vec3::ZERO;
    let mut turn = Vec3::ZERO;
    let mut largest = Lane::ZERO;
    for k in 0..count {
        let e = &eliminations[k];
        turn = e.before.apply(turn) - e.alone - e.shift.apply(shift);
        turns[k] = turn;
        largest = largest.max(turn.length_squared() * links[k].counts);
        shift += turn.cross(frames[k].tangent() * links[k].length);
    }
    largest
}

/// The energy that a stage minimises, for a pose: it goes down in every step that is accepted.
pub(crate) fn potential(
    links: &[Link],
    pose: Pose,
    nodes: &[Node],
    past: &[Vec3],
    elastic: &Elastic,
) -> Lane {
    let mut sum = Lane::ZERO;
    let mut before = pose.base;
    for (k, link) in links.iter().enumerate() {
        let y = pose.y[k];
        sum += (nodes[k].n.apply(y) * 0.5 - nodes[k].b).dot(y);
        let c = half_turn(before, pose.frames[k]);
        let u = c + c;
        let (e, rate) = (u - link.natural, u - past[k]);
        let weigh = |v: Vec3| (v.x * v.x + v.y * v.y) * link.bend + v.z * v.z * link.twist;
        sum += (weigh(e) + weigh(rate) * elastic.damping) * elastic.h2 * 0.5;
        before = pose.frames[k];
    }
    sum
}

#[cfg(test)]
mod properties;
