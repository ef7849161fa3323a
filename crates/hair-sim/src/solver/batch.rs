//! Strands of about equal length side by side, and what the solver keeps of them.

use glam::DVec3;

use crate::{
    error::Reason,
    lanes::{LANES, Lane, Mask, Quat, Vec3},
    params::{Params, Profile},
    rest::RestStrand,
};

use super::link::{Link, Particle};

/// [`LANES`] strands and their constants. A shorter strand is continued by links without length, mass and force,
/// which add exactly nothing.
#[derive(Clone, Debug)]
pub(crate) struct Batch {
    /// The strand of each lane, by its index in the rest shape.
    pub strands: [Option<usize>; LANES],
    /// How many links each lane's strand has.
    pub counts: [usize; LANES],
    pub links: Vec<Link>,
    pub particles: Vec<Particle>,
    /// Damping inside the strand, in s.
    pub damping: Lane,
    pub drag_along: Lane,
    /// Strands that have drag; a goal.
    pub has_drag: Mask,
    pub has_goal: Mask,
    /// Whether the wind reaches all of all strands as it is.
    pub is_open: bool,
    /// In m.
    pub length: Lane,
    /// Mass times length from the root, in m^2: energy at most for a pull.
    pub lever: Lane,
    /// Distance kept from colliders, in m.
    pub thickness: Lane,
    pub friction: Lane,
    /// Pull in m/s^2 of particles that lie farther than so many metres from their goals.
    pub recall: Lane,
    pub recall_from: Lane,
    /// Half the thickness of the lock that a strand stands for, in m.
    pub lock_radius: Lane,
    /// Planes that may hold particles: one of bodies for each, and where hair meets hair one of other strands for each.
    pub planes: usize,
    /// Particles from the root in style space.
    pub styled: Vec<Vec3>,
    /// How much hair is between the root and particles, in m.
    pub along: Vec<Lane>,
    /// Root and skin frame in style space.
    pub root: Vec3,
    pub base: Quat,
    /// Lanes that hold a strand with links.
    pub used: Mask,
    /// Whether all its strands are straight by nature: see [`super::rods`].
    pub is_straight: bool,
}

impl Batch {
    pub(crate) fn new(members: &[(usize, &RestStrand, &Params)]) -> Self {
        let count = members.iter().map(|m| m.1.links.len()).max().unwrap_or(0);
        // So soft that what rounding leaves of its moments is lost in any number beside it.
        let soft = Lane::splat(1e-40);
        let link = Link {
            length: Lane::ZERO,
            bend: soft,
            twist: soft,
            natural: Vec3::ZERO,
            counts: Lane::ZERO,
        };
        let particle = Particle {
            mass: Lane::ZERO,
            drag: Lane::ZERO,
            goal: Lane::ZERO,
            wind: Lane::ONE,
        };
        let mask = |has: &dyn Fn(&Params) -> bool| {
            Mask::new(std::array::from_fn(|lane| {
                members.get(lane).is_some_and(|m| has(m.2))
            }))
        };
        let mut batch = Self {
            strands: [None; LANES],
            counts: [0; LANES],
            links: vec![link; count],
            particles: vec![particle; count],
            damping: Lane::ZERO,
            drag_along: Lane::ZERO,
            has_drag: mask(&|params| params.drag > 0.0),
            has_goal: mask(&|params| params.has_goal()),
            is_open: members.iter().all(|m| m.2.wind == Profile::constant(1.0)),
            length: Lane::ZERO,
            lever: Lane::ZERO,
            thickness: Lane::ZERO,
            friction: Lane::ZERO,
            recall: Lane::ZERO,
            recall_from: Lane::ONE,
            lock_radius: Lane::ZERO,
            planes: count,
            styled: vec![Vec3::ZERO; count],
            along: vec![Lane::ZERO; count],
            root: Vec3::ZERO,
            base: Quat::IDENTITY,
            used: Mask::NONE,
            is_straight: members.iter().all(|m| m.1.is_straight(m.2)),
        };
        for (lane, (index, rest, params)) in members.iter().enumerate() {
            batch.fill(lane, *index, rest, params);
        }
        batch.used = Mask::new(batch.counts.map(|count| count > 0));
        batch
    }

    fn fill(&mut self, lane: usize, index: usize, rest: &RestStrand, params: &Params) {
        self.strands[lane] = Some(index);
        self.counts[lane] = rest.links.len();
        self.damping[lane] = params.damping;
        self.drag_along[lane] = params.drag_along;
        self.thickness[lane] = params.thickness;
        self.friction[lane] = params.friction;
        self.recall[lane] = params.recall;
        self.recall_from[lane] = params.recall_from;
        self.lock_radius[lane] = params.lock_radius;
        self.root.set(lane, rest.root);
        self.base.set(lane, rest.base);
        let (mut y, mut along) = (DVec3::ZERO, 0.0);
        self.length[lane] = rest.links.iter().map(|link| link.length).sum();
        for (k, link) in rest.links.iter().enumerate() {
            y += link.frame * DVec3::Z * link.length;
            along += link.length;
            self.lever[lane] += link.mass * along;
            self.styled[k].set(lane, y);
            self.along[k][lane] = along;
            self.links[k].length[lane] = link.length;
            self.links[k].bend[lane] = link.bend;
            self.links[k].twist[lane] = link.twist;
            self.links[k].natural.set(lane, link.natural);
            self.links[k].counts[lane] = 1.0;
            self.particles[k].mass[lane] = link.mass;
            self.particles[k].drag[lane] = params.drag * params.drag_at.at(link.end_at);
            self.particles[k].wind[lane] = params.wind.at(link.end_at);
            self.particles[k].goal[lane] = params.goal.at(link.end_at);
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.links.len()
    }

    /// The particle that a plane holds.
    #[inline(always)]
    pub(crate) fn held_by(&self, plane: usize) -> usize {
        let (count, mut particle) = (self.count(), plane);
        while particle >= count {
            particle -= count;
        }
        particle
    }

    /// Whether a plane is a body's.
    #[inline(always)]
    pub(crate) fn is_of_body(&self, plane: usize) -> bool {
        plane < self.count() || plane >= self.planes
    }

    /// How many planes may hold particles, where bodies may give them a second one: those come last.
    pub(crate) fn planes_with_second(&self) -> usize {
        self.planes + self.count()
    }

    /// Whether a state with `count` frames will do: straight strands need none, and keep them as they are.
    pub(crate) fn does_with(&self, count: usize) -> bool {
        self.is_straight || count == self.count()
    }
}

/// Below this speed in m/s friction is viscous where a particle slides: how fast what should stick creeps at first.
pub(crate) const CREEP: f64 = 5e-4;

/// Stands for no pull: larger than any.
pub(crate) const NO_PULL: Vec3 = Vec3::new(
    Lane::splat(f64::MAX),
    Lane::splat(f64::MAX),
    Lane::splat(f64::MAX),
);

/// Everything of a batch that decides its future.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct BatchState {
    /// Particles from the root, in world axes: positions in m, velocities, accelerations.
    pub y: Vec<Vec3>,
    pub v: Vec<Vec3>,
    pub a: Vec<Vec3>,
    /// Material frames of the links, in world axes; none of straight strands, whose particles tell them.
    pub frames: Vec<Quat>,
    /// The turns of joints that damping held to in the last stage of the last step: the rate at its end is the turn less this over
    /// the stage's length.
    pub past: Vec<Vec3>,
    /// The root in the world, its velocity, and the skin's frame there.
    pub root: Vec3,
    pub root_velocity: Vec3,
    pub base: Quat,
    /// How far particles may be inside of bodies (0 or less, in m), and whether that has been found out.
    pub skin: Vec<Lane>,
    pub skin_known: bool,
    /// By how much particles are farther from bodies than they would be alone, for the sake of the links beside them, in m;
    /// empty where there are no bodies that links count for.
    pub lifts: Vec<Lane>,
    /// The pressure of planes on particles in m/s^2: of bodies, then those of other strands, where there may be any, and second ones
    /// of bodies, where there are any that links count for.
    pub press: Vec<Lane>,
    /// The speeds in m/s below which friction with them is viscous; 0 where the pressure is that of a blow, which is over.
    pub creep: Vec<Lane>,
    /// Where goals were, from the root; empty before the first step with goals.
    pub goal: Vec<Vec3>,
    /// For how long particles have moved by themselves, in s: see [`super::drive`]. Empty where nothing is recalled.
    pub alone: Vec<Lane>,
    /// How much of what particles could be recalled by they are, in the last step, 0 to 1. Empty where nothing is recalled.
    pub recalled: Vec<Lane>,
    /// For how long strands have moved by themselves while others pressed on them, or a body on those that are tied, in s: see [`super::unrest`].
    pub restless: Lane,
    /// Strands that anchors held in the last step.
    pub tied: [bool; LANES],
    /// For how long they have rocked on a body, in s.
    pub rocking: Lane,
    /// Where the tips were a step before, and their way in the step before that.
    pub tip_before: Vec3,
    pub tip_way: Vec3,
    /// The means of late of their velocity and their speed, in m/s.
    pub tip_drift: Vec3,
    pub tip_speed: Lane,
    /// For how long neither any roots nor anything that acts on strands have moved, in s.
    pub calm: Lane,
    /// Links to other strands that hold no more: one for every pair of the batch.
    pub broken: Vec<[bool; LANES]>,
    /// What pulled on the strands in the last step if nothing drove them in it (in m/s^2), and the most energy that they may
    /// have until something does: see [`super::energy`].
    pub pull: Vec3,
    pub ceiling: Lane,
    /// For how long strands have hardly moved, in s, and where their particles were when that began.
    pub quiet: Lane,
    pub quiet_at: Vec<Vec3>,
    /// The same for those that tremble.
    pub trembling: Lane,
    pub trembling_at: Vec<Vec3>,
    /// Strands whose accelerations are unknown: the next step starts by backward Euler.
    pub restart: [bool; LANES],
    /// Strands that do not move by themselves, and why.
    pub set_aside: [Option<Reason>; LANES],
}

impl BatchState {
    /// The style at rest.
    pub(crate) fn new(batch: &Batch, rests: &[Option<&RestStrand>; LANES]) -> Self {
        let count = batch.count();
        let mut state = Self {
            y: vec![Vec3::ZERO; count],
            v: vec![Vec3::ZERO; count],
            a: vec![Vec3::ZERO; count],
            frames: vec![Quat::IDENTITY; if batch.is_straight { 0 } else { count }],
            past: vec![Vec3::ZERO; count],
            root: batch.root,
            root_velocity: Vec3::ZERO,
            base: batch.base,
            skin: vec![Lane::ZERO; count],
            skin_known: false,
            lifts: Vec::new(),
            press: vec![Lane::ZERO; batch.planes],
            creep: vec![Lane::splat(CREEP); batch.planes],
            goal: Vec::new(),
            alone: Vec::new(),
            recalled: Vec::new(),
            calm: Lane::ZERO,
            restless: Lane::ZERO,
            tied: [false; LANES],
            rocking: Lane::ZERO,
            tip_before: Vec3::ZERO,
            tip_way: Vec3::ZERO,
            tip_drift: Vec3::ZERO,
            tip_speed: Lane::ZERO,
            broken: Vec::new(),
            pull: NO_PULL,
            ceiling: Lane::ZERO,
            quiet: Lane::ZERO,
            quiet_at: vec![Vec3::ZERO; count],
            trembling: Lane::ZERO,
            trembling_at: vec![Vec3::ZERO; count],
            restart: [true; LANES],
            set_aside: [None; LANES],
        };
        for (lane, rest) in rests.iter().enumerate() {
            let Some(rest) = rest else { continue };
            let mut y = DVec3::ZERO;
            let mut frame = rest.base;
            for k in 0..count {
                if let Some(link) = rest.links.get(k) {
                    frame = link.frame;
                    y += frame * DVec3::Z * link.length;
                }
                if let Some(frames) = state.frames.get_mut(k) {
                    frames.set(lane, frame);
                }
                state.y[k].set(lane, y);
            }
        }
        state.tip_before = state.y.last().copied().unwrap_or(Vec3::ZERO);
        state
    }
}

impl BatchState {
    /// Whether all lists are as long as a batch needs them, which what was read from a file may not be.
    pub(crate) fn has_lengths(&self, batch: &Batch) -> bool {
        let count = batch.count();
        let stays = [&self.quiet_at, &self.trembling_at];
        let vectors = [&self.y, &self.v, &self.a, &self.past, stays[0], stays[1]];
        let planes = [&self.press, &self.creep];
        vectors.iter().all(|list| list.len() == count)
            && self.skin.len() == count
            && (self.lifts.is_empty() || self.lifts.len() == count)
            && planes
                .iter()
                .all(|list| list.len() == batch.planes || list.len() == batch.planes_with_second())
            && self.press.len() == self.creep.len()
            && (self.goal.is_empty() || self.goal.len() == count)
            && [&self.alone, &self.recalled]
                .iter()
                .all(|list| list.is_empty() || list.len() == count)
    }

    /// The strands that are set aside.
    #[inline(always)]
    pub(crate) fn aside(&self) -> Mask {
        Mask::new(self.set_aside.map(|r| r.is_some()))
    }

    /// Makes room for so many planes.
    #[inline(always)]
    pub(crate) fn hold_planes(&mut self, planes: usize) {
        if self.press.len() != planes {
            self.press.resize(planes, Lane::ZERO);
            self.creep.resize(planes, Lane::splat(CREEP));
        }
    }

    /// Strands that were taken out of a body start anew.
    pub(crate) fn turned_out(&mut self, which: Mask) {
        self.restart = Mask::new(self.restart).or(which).bools();
        self.pull = Vec3::pick(which, NO_PULL, self.pull);
    }

    /// Carries shape and motion to another root and skin frame.
    pub(crate) fn teleport(&mut self, root: Vec3, base: Quat) {
        let turn = base.times(self.base.conjugate()).normalize();
        for frame in &mut self.frames {
            *frame = turn.times(*frame).normalize();
        }
        let [x, y, z] = turn.axes();
        let turned = |v: &mut Vec3| *v = x * v.x + y * v.y + z * v.z;
        self.y.iter_mut().for_each(turned);
        self.v.iter_mut().for_each(turned);
        self.a.iter_mut().for_each(turned);
        self.goal.iter_mut().for_each(turned);
        self.quiet_at.iter_mut().for_each(turned);
        self.trembling_at.iter_mut().for_each(turned);
        turned(&mut self.root_velocity);
        turned(&mut self.tip_before);
        turned(&mut self.tip_way);
        turned(&mut self.tip_drift);
        // The next step finds out anew what energy there is.
        self.pull = NO_PULL;
        self.root = root;
        self.base = base;
    }
}
