//! A strand at rest: its links, their frames, and the curvature that keeps it there.

use glam::{DQuat, DVec3};

use crate::{
    error::Reason,
    math::{cos, sin},
    params::{GRAVITY, Natural, Params},
};

/// Joints of less than this fraction of the mean length count as this long, so that a very short link does not
/// become a very stiff one.
const LEAST_JOINT: f64 = 0.01;

/// The cosine of half the largest angle between the styled directions of neighbouring links (170 degrees).
const LEAST_HALF_COSINE: f64 = 0.087;

/// A joint whose natural turn is less than this (radians) is straight.
const NATURALLY_STRAIGHT: f64 = 1e-12;

/// Where damping over the ratio of stiffnesses is more than this, in s, strands that are straight by nature twist too much to leave it out:
/// damping holds a strand to where it was bent in its frames, so that one that swings round is twisted. This much changes a strand of
/// Gamma 30 by half a percent of its length in half a second of nods in gusts, with the square of it
/// (`solver::straight::tests`).
const DAMPING_THAT_TWISTS: f64 = 0.008;

/// One strand as the solver sees it. Masses are per linear density: a metre of strand has mass 1.
#[derive(Clone, Debug)]
pub(crate) struct RestStrand {
    pub links: Vec<RestLink>,
    /// The root in style space, in m.
    pub root: DVec3,
    /// The frame that the skin gives to the root.
    pub base: DQuat,
}

/// A link and the joint at its root end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestLink {
    /// In m.
    pub length: f64,
    /// The share of mass of the particle at its tip end.
    pub mass: f64,
    /// EI / (rho S) over the joint's length, in m^3/s^2.
    pub bend: f64,
    /// GJ / (rho S) over the joint's length, in m^3/s^2.
    pub twist: f64,
    /// Natural turn of the joint, 2 tan(angle / 2) times its axis, in the frame of the link.
    pub natural: DVec3,
    /// The frame at rest in style space: the third axis points along the link.
    pub frame: DQuat,
    /// Its place between root and tip, by length: of the joint, and of the particle at its tip end.
    pub joint_at: f64,
    pub end_at: f64,
}

impl RestStrand {
    /// Builds the strand through `points` (style space, m). A link without length takes the direction of the one
    /// before it.
    pub(crate) fn new(points: &[glam::Vec3], params: &Params) -> Result<Self, Reason> {
        if let Some(point) = points.iter().position(|p| !p.is_finite()) {
            return Err(Reason::Rest(point));
        }
        let points: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
        let edges: Vec<DVec3> = points.windows(2).map(|w| w[1] - w[0]).collect();
        let lengths: Vec<f64> = edges.iter().map(|e| e.length()).collect();
        let total: f64 = lengths.iter().sum();
        if edges.is_empty() {
            return Ok(Self {
                links: Vec::new(),
                root: points[0],
                base: DQuat::IDENTITY,
            });
        }
        // Below a nanometre there is no direction left in coordinates of single precision.
        let shortest = 1e-9_f64.max(total * 1e-7);
        if total < 1e-9 {
            return Err(Reason::NoLength);
        }
        let first = lengths.iter().position(|&l| l > shortest);
        let Some(first) = first else {
            return Err(Reason::NoLength);
        };
        let mut direction = edges[first] / lengths[first];
        let mut frames = Vec::with_capacity(edges.len());
        let mut frame = from_axis(direction);
        for (k, (edge, length)) in edges.iter().zip(&lengths).enumerate() {
            if *length > shortest {
                let next = *edge / *length;
                let Some(turn) = least_turn(direction, next) else {
                    return Err(Reason::Folded(k));
                };
                frame = (turn * frame).normalize();
                direction = next;
            }
            frames.push(frame);
        }
        // The skin's frame: the curve of the first joint, continued backwards by half a link.
        let base = match frames.get(1) {
            Some(next) => {
                let bend = positive(frames[0].conjugate() * *next);
                let half = DQuat::from_xyzw(bend.x, bend.y, bend.z, bend.w + 1.0).normalize();
                (frames[0] * half.conjugate()).normalize()
            }
            None => frames[0],
        };
        let mut strand = Self {
            links: links(&lengths, total, &frames, params),
            root: points[0],
            base,
        };
        strand.set_natural(&points, params);
        Ok(strand)
    }

    /// A strand that cannot move: links that only keep its shape.
    pub(crate) fn rigid(points: &[glam::Vec3]) -> Self {
        let links = points
            .windows(2)
            .map(|w| {
                let edge = w[1].as_dvec3() - w[0].as_dvec3();
                let edge = if edge.is_finite() { edge } else { DVec3::ZERO };
                let length = edge.length();
                RestLink {
                    length,
                    mass: 0.0,
                    bend: 1e-40,
                    twist: 1e-40,
                    natural: DVec3::ZERO,
                    frame: if length > 0.0 {
                        from_axis(edge / length)
                    } else {
                        DQuat::IDENTITY
                    },
                    joint_at: 0.0,
                    end_at: 0.0,
                }
            })
            .collect();
        Self {
            links,
            root: if points[0].is_finite() {
                points[0].as_dvec3()
            } else {
                DVec3::ZERO
            },
            base: DQuat::IDENTITY,
        }
    }

    /// Whether nothing bends or twists it: by nature, to within what rounding makes of its frames, or by damping.
    pub(crate) fn is_straight(&self, params: &Params) -> bool {
        // Strands that are set aside have no mass: they keep whatever shape they have.
        let is_straight = |link: &RestLink| {
            link.length > 0.0
                && link.mass > 0.0
                && link.natural.length_squared() < NATURALLY_STRAIGHT.powi(2)
        };
        let twist_by_damping = params.damping / params.material.twist_ratio;
        twist_by_damping <= DAMPING_THAT_TWISTS && self.links.iter().all(is_straight)
    }

    fn set_natural(&mut self, points: &[DVec3], params: &Params) {
        let mut before = self.base;
        let mut styled = Vec::with_capacity(self.links.len());
        for link in &self.links {
            styled.push(turn(before, link.frame));
            before = link.frame;
        }
        match params.natural {
            // Its turns are but what single precision makes of a line: strands that are straight are simpler to solve.
            Natural::Styled if is_a_line(points) => {}
            Natural::Styled => {
                for (link, turn) in self.links.iter_mut().zip(styled) {
                    link.natural = turn;
                }
            }
            Natural::Balanced => self.balance(&styled),
            Natural::Curl { curvature, torsion } => {
                for link in &mut self.links {
                    let joint =
                        params.material.bending() * params.stiffness.at(link.joint_at) / link.bend;
                    link.natural = curl(DVec3::new(curvature * joint, 0.0, torsion * joint));
                }
            }
        }
    }

    /// The sag-free start: at every joint the rest of the strand weighs with the moment sum r x m g, and the
    /// natural turn is the styled one less moment over stiffness. One sweep from tip to root.
    fn balance(&mut self, styled: &[DVec3]) {
        let gravity = DVec3::new(0.0, -GRAVITY, 0.0);
        let (mut weight, mut moment) = (DVec3::ZERO, DVec3::ZERO);
        for (link, &u) in self.links.iter_mut().zip(styled).rev() {
            weight += gravity * link.mass;
            moment += (link.frame * DVec3::Z * link.length).cross(weight);
            // The joint's moment is G^T B (u - natural) in the link's frame, and it carries `moment`. Both ways
            // of writing G, with c = u / 2: G^T = 1 - [c] + c c^T, whose inverse is (1 + [c]) / (1 + c c).
            let c = u * 0.5;
            let m = link.frame.conjugate() * moment;
            let e = (m + c.cross(m)) / (1.0 + c.length_squared());
            link.natural = u + DVec3::new(-e.x / link.bend, -e.y / link.bend, -e.z / link.twist);
        }
    }
}

/// Whether points of single precision are as near to the line from the first to the last as rounding leaves them.
fn is_a_line(points: &[DVec3]) -> bool {
    let largest = points
        .iter()
        .fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    let rounding = f64::from(f32::EPSILON) * largest;
    let chord = points[points.len() - 1] - points[0];
    let is_near =
        |p: &DVec3| (*p - points[0]).cross(chord).length() <= 2.0 * rounding * chord.length();
    chord.length() > 0.0 && points.iter().all(is_near)
}

fn links(lengths: &[f64], total: f64, frames: &[DQuat], params: &Params) -> Vec<RestLink> {
    let n = lengths.len();
    let least = LEAST_JOINT * total / n as f64;
    let mut at = 0.0;
    (0..n)
        .map(|k| {
            // The root's joint stands for half a link: a clamp of second order.
            let joint = if k == 0 {
                lengths[0] * 0.5
            } else {
                (lengths[k - 1] + lengths[k]) * 0.5
            };
            let joint = joint.max(if k == 0 { 0.5 * least } else { least });
            let bending = params.material.bending() * params.stiffness.at(at / total) / joint;
            let after = lengths.get(k + 1).copied().unwrap_or(0.0);
            let joint_at = at / total;
            at += lengths[k];
            RestLink {
                length: lengths[k],
                mass: (lengths[k] + after) * 0.5,
                bend: bending,
                twist: bending * params.material.twist_ratio,
                natural: DVec3::ZERO,
                frame: frames[k],
                joint_at,
                end_at: at / total,
            }
        })
        .collect()
}

/// A frame whose third axis is `tangent`, its first as near to level as it can be.
pub(crate) fn from_axis(tangent: DVec3) -> DQuat {
    let across = if tangent.y.abs() < 0.9 {
        DVec3::Y
    } else {
        DVec3::X
    };
    let first = across.cross(tangent).normalize();
    DQuat::from_mat3(&glam::DMat3::from_cols(
        first,
        tangent.cross(first),
        tangent,
    ))
    .normalize()
}

/// The least rotation between unit vectors; `None` where they are all but opposite.
fn least_turn(from: DVec3, to: DVec3) -> Option<DQuat> {
    let w = 1.0 + from.dot(to);
    // w = 2 cos^2(angle / 2).
    if w < 2.0 * LEAST_HALF_COSINE * LEAST_HALF_COSINE {
        return None;
    }
    let v = from.cross(to);
    Some(DQuat::from_xyzw(v.x, v.y, v.z, w).normalize())
}

fn positive(q: DQuat) -> DQuat {
    if q.w < 0.0 { -q } else { q }
}

/// The turn of a joint, 2 tan(angle / 2) times its axis: the discrete curvature of Bergou et al. 2008, times length.
pub(crate) fn turn(before: DQuat, after: DQuat) -> DVec3 {
    let q = before.conjugate() * after;
    DVec3::new(q.x, q.y, q.z) * (2.0 / q.w)
}

/// The same of a rotation vector.
fn curl(rotation: DVec3) -> DVec3 {
    let angle = rotation.length();
    if angle < 1e-12 {
        return rotation;
    }
    // Near half a turn the tangent has no bound; such a curl is finer than its links.
    let half = (0.5 * angle).min(1.4);
    rotation * (2.0 * sin(half) / (cos(half) * angle))
}

#[cfg(test)]
mod properties;

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn bent() -> Vec<Vec3> {
        (0..12)
            .map(|i| {
                let s = i as f32 * 0.4;
                Vec3::new(0.03 * s.sin(), 0.02 * s, 0.03 * s.cos())
            })
            .collect()
    }

    #[test]
    fn frames_follow_the_links() {
        let points = bent();
        let strand = RestStrand::new(&points, &Params::default()).unwrap();
        for (link, w) in strand.links.iter().zip(points.windows(2)) {
            let along = (w[1].as_dvec3() - w[0].as_dvec3()).normalize();
            assert!((link.frame * DVec3::Z - along).length() < 1e-12);
        }
        let total: f64 = strand.links.iter().map(|l| l.mass).sum();
        let length: f64 = strand.links.iter().map(|l| l.length).sum();
        // The root's own half share hangs on the skin.
        assert!((total + 0.5 * strand.links[0].length - length).abs() < 1e-12);
    }

    #[test]
    fn points_that_are_one_are_refused_and_doubled_points_repaired() {
        let p = Params::default();
        let one = [Vec3::ONE; 4];
        assert_eq!(RestStrand::new(&one, &p).unwrap_err(), Reason::NoLength);
        let fold = [Vec3::ZERO, Vec3::X, Vec3::ZERO];
        assert_eq!(RestStrand::new(&fold, &p).unwrap_err(), Reason::Folded(1));
        let doubled = [Vec3::ZERO, Vec3::ZERO, Vec3::X, Vec3::X, Vec3::X * 2.0];
        let strand = RestStrand::new(&doubled, &p).unwrap();
        assert!(
            strand
                .links
                .iter()
                .all(|l| l.natural.is_finite() && l.frame.is_finite() && l.bend.is_finite())
        );
    }
}
