//! Ties that gather hair on its way down: the points in a tie stay together, and move as one.
//!
//! Strands are solved one by one, so a step is tried without the ties first. Of where the tied points would come to the mean is what they come to
//! together, as a tie pulls them to each other and at nothing else; then the step is taken with each of them held to its place about that.

use super::running::Running;
use crate::hair::HairModel;
use glam::{DQuat, DVec3};
use groom::LowTie;
use hair_sim::{Anchor, Collider, Pose};

/// How strongly a point is held in its place, 1/s^2: 30 m/s^2 take it 0.15 mm away.
const STIFFNESS: f64 = 2e5;
/// A tie that would come less far away, m, stays where it is, so that hair can come to rest: half the radius of a hair.
const RESTS: f64 = 2e-5;
/// Where nothing that acts moves, a tie holds the better the longer: that grows with the time after so many seconds, up to so many times as far. Jammed hair would
/// else slip through it by some such way now and then for minutes.
const HOLDS: [f64; 2] = [4.0, 5.0];

/// The ties of simulated hair.
#[derive(Default)]
pub(super) struct Ties {
    ties: Vec<Simulated>,
    held: Held,
}

/// Where ties hold hair.
#[derive(Clone, Default)]
pub(super) struct Held {
    anchors: Vec<Anchor>,
    /// For how long nothing that acts has moved.
    calm_s: f64,
}

struct Simulated {
    members: Vec<Member>,
    /// At rest, on a head at rest.
    axis: DVec3,
}

/// A point in a tie: a strand of the solver, its point, and its place about the tie's middle at rest.
#[derive(Clone, Copy)]
struct Member {
    strand: usize,
    point: usize,
    offset: DVec3,
}

impl Ties {
    /// The ties of hair, of which the solver has these strands: of each its number in the hair and its first point there.
    pub fn new(hair: &HairModel, strands: &[(usize, usize)]) -> Self {
        let simulated = |tie: &LowTie| {
            let center = tie.center.as_dvec3();
            let member = |&(id, point): &(u32, usize)| {
                let own = |&(strand, _): &(usize, usize)| hair.infos[strand].id == id;
                let number = strands.iter().position(own)?;
                let (strand, first) = strands[number];
                Some(Member {
                    strand: number,
                    point: point.checked_sub(first)?,
                    offset: hair.file.strands.strand(strand)[point].as_dvec3() - center,
                })
            };
            let members: Vec<Member> = tie.members.iter().filter_map(member).collect();
            Simulated {
                axis: tie.axis.as_dvec3(),
                members,
            }
        };
        let ties = hair.low_ties.iter().map(simulated);
        Self {
            // One alone has nothing to be tied to.
            ties: ties.filter(|tie| tie.members.len() > 1).collect(),
            held: Held::default(),
        }
    }

    pub fn are_none(&self) -> bool {
        self.ties.is_empty()
    }

    /// Forgets where they were.
    pub fn restart(&mut self) {
        self.held = Held::default();
    }

    /// What holds the tied points in the next step.
    pub fn anchors(&self) -> &[Anchor] {
        &self.held.anchors
    }

    /// How they hold hair, for [`Self::put_back`].
    pub fn held(&self) -> Held {
        self.held.clone()
    }

    /// Has them as they were before it was looked ahead.
    pub fn put_back(&mut self, held: Held) {
        self.held = held;
    }

    /// Carries them along by this motion.
    pub fn carry(&mut self, way: Pose) {
        for place in self.held.anchors.iter_mut().flat_map(|own| &mut own.places) {
            *place = way.rotation * *place + way.translation;
        }
    }

    /// Ties stay where they are in the next step.
    pub fn stay(&mut self) {
        for anchor in &mut self.held.anchors {
            anchor.places[0] = anchor.places[1];
        }
    }

    /// Aims at where the strands come to in a step without ties, which they were moved ahead by. The head comes to this pose. For so many seconds, those of the
    /// step, nothing that acts moves; None where something does.
    pub fn aim(
        &mut self,
        ahead: &dyn Running,
        (head, colliders): (Pose, &[Collider]),
        calm: Option<f64>,
    ) {
        let Held {
            anchors: last,
            calm_s,
        } = &mut self.held;
        *calm_s = calm.map_or(0.0, |dt| *calm_s + dt);
        let mut anchors = Vec::with_capacity(last.len());
        for tie in &self.ties {
            let count = tie.members.len() as f64;
            let (mut center, mut way, mut rest) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
            for member in &tie.members {
                let points = ahead.points(member.strand);
                center += points[member.point];
                rest += member.offset;
                let after = (member.point + 1).min(points.len() - 1);
                way += (points[after] - points[member.point - 1]).normalize_or_zero();
            }
            let (mut center, rest) = (center / count, rest / count);
            // A tie is in no body: its hair, on both sides of a body, would else be pulled into that.
            for collider in colliders {
                let inside = -collider.distance(center);
                if inside > 0.0 {
                    center += collider.outwards(center) * inside;
                }
            }
            let turn = turn_of(tie.axis, way, head.rotation);
            for member in &tie.members {
                anchors.push(Anchor {
                    strand: member.strand,
                    point: member.point,
                    stiffness: STIFFNESS,
                    places: [center + turn * (member.offset - rest); 2],
                    follows: true,
                });
            }
        }
        let [after, most] = HOLDS;
        let rests = RESTS * (*calm_s / after).clamp(1.0, most);
        let rests = last.len() == anchors.len()
            && (last.iter().zip(&anchors)).all(|(last, next)| {
                last.places[1].distance_squared(next.places[1]) < rests * rests
            });
        if rests {
            self.stay();
            return;
        }
        for (next, last) in anchors.iter_mut().zip(&*last) {
            next.places[0] = last.places[1];
        }
        *last = anchors;
    }
}

/// How a tie has turned since rest, whose axis is that of the hair in it: with the head, and on with the hair.
pub(crate) fn turn_of(axis_at_rest: DVec3, axis: DVec3, head: DQuat) -> DQuat {
    let with_head = head * axis_at_rest;
    let axis = axis.try_normalize().unwrap_or(with_head);
    DQuat::from_rotation_arc(with_head, axis) * head
}
