//! Extended position based dynamics of rods: particles and a quaternion a link.
//!
//! Rods of Kugelstadt and Schömer 2016, *Position and Orientation Based Cosserat Rods* (their constraints of stretch and
//! shear and of bending and twist), solved as Macklin et al. 2016, *XPBD*, say (algorithm 1): their compliance makes the
//! stiffness physical, and Gauss-Seidel sweeps leave an error that more sweeps or more steps lessen.

use super::apart::{self, Acting, Pull, Strand, on_the_way};
use crate::{
    error::DynamicsError,
    forces::wind::Blown,
    params::Params,
    pose::Pose,
    rest::RestStrand,
    stats::Stats,
    strand_solver::StrandSolver,
    strands::Strands,
    surroundings::{Roots, Surroundings},
};
use glam::{DQuat, DVec3, Vec3};

/// The inertia of a link's quaternion against turning, over mass x length^2 of the link. That of the particles is right
/// without it, so it is an error of second order in the length; less of it needs more sweeps.
const INERTIA: f64 = 1.0 / 3.0;

/// Strands as rods of particles and quaternions.
///
/// It knows stiffness, natural shape, drag (the same in all directions), goals, bodies with friction, gravity, wind and moving
/// roots. It doesn't know damping inside the hair, other hair ([`Solver::interact`](crate::Solver::interact)), sleep, and a safe
/// integrator: with few steps hair is softer than it should be, and sags.
#[derive(Clone, Debug)]
pub struct Xpbd {
    substeps: u32,
    sweeps: u32,
    /// The points of all strands.
    points: usize,
}

impl Xpbd {
    /// A solver for strands at rest of which each has its own parameters, by its index in `rest`, and their state. Each step is made
    /// of `substeps`, of `sweeps` over all constraints.
    ///
    /// Strands that cannot move, as those without length, follow their roots.
    ///
    /// # Errors
    ///
    /// When a parameter is out of its range.
    pub fn with(
        rest: &Strands,
        params: impl Fn(usize) -> Params,
        substeps: u32,
        sweeps: u32,
    ) -> Result<(Self, Vec<Rod>), DynamicsError> {
        let solver = Self {
            substeps: substeps.max(1),
            sweeps: sweeps.max(1),
            points: rest.points().len(),
        };
        Ok((solver, apart::strands(rest, params)?))
    }
}

impl StrandSolver for Xpbd {
    type State = Vec<Rod>;

    fn step(
        &mut self,
        state: &mut Vec<Rod>,
        surroundings: &Surroundings,
        dt: f64,
    ) -> Result<Stats, DynamicsError> {
        let (substeps, sweeps) = (self.substeps, self.sweeps);
        apart::step(state, surroundings, self.points, dt, |rod, head| {
            rod.step(surroundings, head, dt, substeps, sweeps)
        })
    }

    fn teleport(&self, state: &mut Vec<Rod>, to: Roots) -> Result<(), DynamicsError> {
        apart::teleport(state, to, self.points)
    }

    fn points(&self, state: &Vec<Rod>, strand: usize) -> impl ExactSizeIterator<Item = DVec3> {
        state[strand].points.iter().copied()
    }

    fn frames(&self, state: &Vec<Rod>, strand: usize) -> impl ExactSizeIterator<Item = DQuat> {
        state[strand].frames[1..].iter().copied()
    }
}

/// One strand, constants and motion.
#[derive(Clone, Debug)]
pub struct Rod {
    links: Vec<Link>,
    /// Inverse masses of the particles; 0 for the root. Masses are per linear density: a metre of strand has mass 1.
    lightness: Vec<f64>,
    /// Pull of the particles to their goals in 1/s^2, and the style's points.
    pulls: Vec<f64>,
    styled: Vec<DVec3>,
    drag: f64,
    /// The share of the wind that reaches it.
    wind: f64,
    thickness: f64,
    friction: f64,
    /// Of its points in the list of all strands'.
    first_point: usize,
    /// Whether it only follows its root.
    is_rigid: bool,
    /// Root and frame of the skin in style space, and where the head was.
    root: (DVec3, DQuat),
    head: Pose,
    /// Of the time and the wind since the start.
    blown: Blown,
    points: Vec<DVec3>,
    velocities: Vec<DVec3>,
    /// The frame of the skin, then of each link: the third axis points along the link.
    frames: Vec<DQuat>,
    /// Angular velocities in the world, in rad/s; of the skin too, though it is not read.
    spins: Vec<DVec3>,
    /// Places of the goals at the end of the step before; none yet at the start.
    goals: Vec<DVec3>,
    scratch: Scratch,
}

/// A link and the joint before it.
#[derive(Clone, Copy, Debug)]
struct Link {
    /// In m.
    length: f64,
    /// Inverse inertia of the components of its quaternion.
    lightness: f64,
    /// Stiffness of the joint against bending (first and second component) and twist: energy is half of it times
    /// the square of the vector part of the joint's quaternion less that of the natural one. Per linear density.
    stiffness: DVec3,
    natural: DQuat,
}

/// What a substep begins with, and its Lagrange multipliers.
#[derive(Clone, Debug)]
struct Scratch {
    points: Vec<DVec3>,
    frames: Vec<DQuat>,
    bend: Vec<DVec3>,
}

impl Rod {
    /// The strand through these points (style space, m) at rest.
    #[must_use]
    pub fn new(points: &[Vec3], params: &Params) -> Self {
        <Self as Strand>::new(points, params, 0)
    }

    /// Its points in the world, root first, in m.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Advances it by `dt` seconds, at whose end the head is at `head`, in `substeps` of `sweeps`.
    pub fn step(
        &mut self,
        surroundings: &Surroundings,
        head: Pose,
        dt: f64,
        substeps: u32,
        sweeps: u32,
    ) -> Stats {
        let before = self.head;
        if !head.is_rigid() {
            return Stats {
                set_aside: 1,
                ..Stats::default()
            };
        }
        if self.is_rigid {
            self.teleport(head);
            return Stats {
                set_aside: 1,
                ..Stats::default()
            };
        }
        // In the middle of the step.
        let gusts = surroundings.air_at(0.5, self.blown, dt);
        self.blown = surroundings.blown(1.0, self.blown, dt);
        let goals = self.goals_at(surroundings, head);
        let mut stats = Stats {
            strands: 1,
            wind: if gusts.blows && self.drag > 0.0 {
                self.links.len()
            } else {
                0
            },
            ..Stats::default()
        };
        let part = dt / f64::from(substeps);
        for substep in 1..=substeps {
            let share = f64::from(substep) / f64::from(substeps);
            let acting = Acting {
                gravity: surroundings.gravity,
                gusts: (gusts.blows).then_some(&gusts),
                colliders: surroundings.colliders,
                share,
            };
            let now = if substep == substeps {
                head
            } else {
                on_the_way(before, head, share)
            };
            self.predict(&acting, &goals, now, part, substeps);
            for sweep in 0..sweeps {
                self.sweep(sweep % 2 == 1, part);
                stats.contacts += self.keep_out(&acting);
            }
            self.find_velocities(part);
        }
        self.head = head;
        self.goals = goals;
        if !self.points.iter().all(|point| point.is_finite()) {
            // It has no safe integrator behind it.
            self.is_rigid = true;
            self.teleport_style(head);
        }
        stats
    }

    /// Where the goals are at the end of a step.
    fn goals_at(&self, surroundings: &Surroundings, head: Pose) -> Vec<DVec3> {
        let place = |i: usize| match surroundings.goal {
            Some(goal) => goal[self.first_point + i].as_dvec3(),
            None => self.styled[i],
        };
        let places = (0..self.points.len()).map(|i| head.to_world(place(i)));
        places.collect()
    }

    /// Moves all by its velocity; the root and the skin go where the head takes them.
    fn predict(&mut self, acting: &Acting, goals: &[DVec3], head: Pose, dt: f64, substeps: u32) {
        self.scratch.points.copy_from_slice(&self.points);
        self.scratch.frames.copy_from_slice(&self.frames);
        self.scratch.bend.fill(DVec3::ZERO);
        let goals_before = if self.goals.is_empty() {
            goals
        } else {
            &self.goals
        };
        let whole = dt * f64::from(substeps);
        for i in 1..self.points.len() {
            let (point, velocity) = (&mut self.points[i], &mut self.velocities[i]);
            let pull = Pull::new(
                self.pulls[i],
                goals_before[i],
                goals[i],
                acting.share,
                whole,
            );
            let air = acting.air(*point) * (self.drag * self.wind);
            let push = acting.gravity + air + pull.push(*point);
            // Implicit by itself.
            let slower = 1.0 + dt * self.drag + pull.slowing(dt);
            *velocity = (*velocity + push * dt) / slower;
            *point += *velocity * dt;
        }
        for (frame, spin) in self.frames.iter_mut().zip(&self.spins) {
            *frame = (*frame + pure(*spin) * *frame * (0.5 * dt)).normalize();
        }
        self.points[0] = head.to_world(self.root.0);
        self.frames[0] = head.rotation * self.root.1;
    }

    /// Goes over all constraints once, from the root or from the tip.
    fn sweep(&mut self, from_tip: bool, dt: f64) {
        let count = self.links.len();
        for k in 0..count {
            let k = if from_tip { count - 1 - k } else { k };
            self.project_stretch(k);
            self.project_bend(k, dt);
        }
    }

    /// Keeps the link `k` at its length and along its frame.
    fn project_stretch(&mut self, k: usize) {
        let Link {
            length, lightness, ..
        } = self.links[k];
        let along = self.frames[k + 1] * DVec3::Z;
        let error = (self.points[k + 1] - self.points[k]) / length - along;
        let (a, b) = (self.lightness[k], self.lightness[k + 1]);
        let weight = (a + b) / (length * length) + 4.0 * lightness;
        // Without compliance: hair doesn't stretch.
        let push = -error / weight;
        self.points[k] -= push * (a / length);
        self.points[k + 1] += push * (b / length);
        let frame = self.frames[k + 1];
        let turn = pure(push) * frame * pure(DVec3::Z) * (2.0 * lightness);
        self.frames[k + 1] = (frame + turn).normalize();
    }

    /// Pulls the turn of the joint before link `k` towards the natural one; before the first link is the skin.
    fn project_bend(&mut self, k: usize, dt: f64) {
        let link = self.links[k];
        let (before, after) = (self.frames[k], self.frames[k + 1]);
        let joint = before.conjugate() * after;
        // Of the two quaternions of a turn, the one nearer to the natural one.
        let sign = joint.dot(link.natural).signum();
        let error = pure_part(joint) * sign - pure_part(link.natural);
        let (a, b) = match k {
            0 => (0.0, link.lightness),
            _ => (self.links[k - 1].lightness, link.lightness),
        };
        let compliance = (link.stiffness * (dt * dt)).recip();
        let multiplier = self.scratch.bend[k];
        let push = -(error + compliance * multiplier) / (DVec3::splat(a + b) + compliance);
        self.scratch.bend[k] += push;
        let push = pure(push * sign);
        self.frames[k] = (before + after * push * -a).normalize();
        self.frames[k + 1] = (after + before * push * b).normalize();
    }

    /// Puts particles that are in a body on its skin, and holds them there by friction. Returns how many.
    fn keep_out(&mut self, acting: &Acting) -> usize {
        (1..self.points.len())
            .map(|i| {
                let before = self.scratch.points[i];
                acting.keep_out(&mut self.points[i], before, self.thickness, self.friction)
            })
            .sum()
    }

    fn find_velocities(&mut self, dt: f64) {
        for (i, velocity) in self.velocities.iter_mut().enumerate() {
            *velocity = (self.points[i] - self.scratch.points[i]) / dt;
            let turn = self.frames[i] * self.scratch.frames[i].conjugate();
            self.spins[i] = pure_part(turn) * (2.0 * turn.w.signum() / dt);
        }
    }

    /// Puts it into its style, at rest.
    fn teleport_style(&mut self, to: Pose) {
        for (point, styled) in self.points.iter_mut().zip(&self.styled) {
            *point = to.to_world(*styled);
        }
        self.velocities.fill(DVec3::ZERO);
        self.spins.fill(DVec3::ZERO);
        self.frames.fill(to.rotation * self.root.1);
        self.head = to;
    }

    /// Kinetic energy and that of weight and bending, per linear density, in m^3/s^2.
    #[must_use]
    pub fn energy(&self, gravity: DVec3) -> f64 {
        let mut energy = 0.0;
        for (k, link) in self.links.iter().enumerate() {
            let mass = 1.0 / self.lightness[k + 1];
            let moving = 0.5 * self.velocities[k + 1].length_squared();
            energy += mass * (moving - gravity.dot(self.points[k + 1]));
            energy += 0.5 / (4.0 * link.lightness) * self.spins[k + 1].length_squared();
            let joint = self.frames[k].conjugate() * self.frames[k + 1];
            let sign = joint.dot(link.natural).signum();
            let turn = pure_part(joint) * sign - pure_part(link.natural);
            energy += 0.5 * (link.stiffness * turn * turn).element_sum();
        }
        energy
    }
}

impl Strand for Rod {
    fn new(points: &[Vec3], params: &Params, first_point: usize) -> Self {
        let (rest, is_rigid) = match RestStrand::new(points, params) {
            Ok(rest) => (rest, false),
            Err(_) => (RestStrand::rigid(points), true),
        };
        let count = rest.links.len() + 1;
        let mut at = rest.root;
        let (mut styled, mut frames) = (vec![at], vec![rest.base]);
        for link in &rest.links {
            at += link.frame * DVec3::Z * link.length;
            styled.push(at);
            frames.push(link.frame);
        }
        let total: f64 = rest.links.iter().map(|link| link.length).sum();
        let links = rest.links.iter().map(|link| {
            // A link without length has no inertia of its own; it is as hard to turn as a thousandth of the strand.
            let length = link.length.max(1e-3 * total).max(1e-9);
            Link {
                length,
                // Energy 1/2 J |omega|^2 is 1/2 (4 J) |dq/dt|^2.
                lightness: 1.0 / (4.0 * INERTIA * length.powi(3)),
                // Half a joint's turn is the vector part, so 4 times what resists the turn.
                stiffness: DVec3::new(link.bend, link.bend, link.twist) * 4.0,
                natural: DQuat::from_xyzw(
                    0.5 * link.natural.x,
                    0.5 * link.natural.y,
                    0.5 * link.natural.z,
                    1.0,
                )
                .normalize(),
            }
        });
        let links: Vec<Link> = links.collect();
        let least_mass = 1e-3 * total / count as f64;
        let mut lightness = vec![0.0];
        let mut pulls = vec![0.0];
        for link in &rest.links {
            lightness.push(1.0 / link.mass.max(least_mass).max(1e-12));
            pulls.push(params.goal.at(link.end_at));
        }
        Self {
            scratch: Scratch {
                points: styled.clone(),
                frames: frames.clone(),
                bend: vec![DVec3::ZERO; links.len()],
            },
            links,
            lightness,
            pulls,
            drag: params.drag * params.drag_at.at(0.5),
            wind: params.wind.at(0.5),
            thickness: params.thickness,
            friction: params.friction,
            first_point,
            is_rigid,
            root: (rest.root, rest.base),
            head: Pose::IDENTITY,
            blown: Blown::default(),
            velocities: vec![DVec3::ZERO; count],
            spins: vec![DVec3::ZERO; count],
            goals: Vec::new(),
            points: styled.clone(),
            styled,
            frames,
        }
    }

    fn teleport(&mut self, to: Pose) {
        let from = self.head;
        let turn = to.rotation * from.rotation.conjugate();
        let carried = |point: DVec3| to.to_world(from.to_local(point));
        self.points
            .iter_mut()
            .for_each(|point| *point = carried(*point));
        self.goals
            .iter_mut()
            .for_each(|goal| *goal = carried(*goal));
        for v in self.velocities.iter_mut().chain(&mut self.spins) {
            *v = turn * *v;
        }
        for frame in &mut self.frames {
            *frame = (turn * *frame).normalize();
        }
        self.head = to;
    }
}

fn pure(v: DVec3) -> DQuat {
    DQuat::from_xyzw(v.x, v.y, v.z, 0.0)
}

fn pure_part(q: DQuat) -> DVec3 {
    DVec3::new(q.x, q.y, q.z)
}
