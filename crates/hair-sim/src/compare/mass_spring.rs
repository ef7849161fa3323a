//! Hair of masses and springs: Selle, Lentine and Fedkiw 2008, *A Mass Spring Model for Hair Simulation*.
//!
//! A straight strand has no triangles, so half way between its particles stand others aside of it. Of the
//! zigzag of both, each particle has a spring to the next (edge), to the one after it (bending) and to the third
//! (torsion): every four particles in a row are a tetrahedron, and its shortest altitude has a spring too, that keeps
//! it from collapsing. Springs are linear along the direction that they have when the step begins, so that a
//! step solves one linear system; here it is a band matrix, solved exactly. The step is Euler's implicit one:
//! the paper's middle point was tried here, and diverges on the falling strand at steps of 1/1536 s and longer.
//!
//! The paper's stiffnesses are free. Here the edges hold the strand's length and the others are set so
//! that a straight strand at rest, lightly loaded, bends as a rod of the given stiffness does.

use super::{
    apart::{self, Acting, Pull, Strand, on_the_way},
    truss::{HELD, Truss, bending_share, frame, zigzag},
};
use crate::{
    error::DynamicsError,
    forces::wind::Blown,
    params::{GRAVITY, Natural, Params},
    pose::Pose,
    rest::{RestLink, RestStrand},
    stats::Stats,
    strand_solver::StrandSolver,
    strands::Strands,
    surroundings::{Roots, Surroundings},
};
use glam::{DQuat, DVec3, Vec3};

/// Strands as trusses of springs.
///
/// It knows stiffness against bending, natural shape, drag (the same in all directions), goals, bodies with friction, gravity, wind and
/// moving roots. It doesn't know the stiffness against twist (that of its torsion springs is what bending leaves), damping
/// inside the hair, other hair ([`Solver::interact`](crate::Solver::interact)), sleep, and a safe integrator: Euler's steps
/// lose energy, heavy hair bends otherwise than rods do, so that a balanced style moves a little, and long steps stretch it.
#[derive(Clone, Debug)]
pub struct MassSpring {
    substeps: u32,
    /// The points of all strands.
    points: usize,
}

impl MassSpring {
    /// A solver for strands at rest of which each has its own parameters, by its index in `rest`, and their state. Each step is made
    /// of `substeps`.
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
    ) -> Result<(Self, Vec<Zigzag>), DynamicsError> {
        let solver = Self {
            substeps: substeps.max(1),
            points: rest.points().len(),
        };
        Ok((solver, apart::strands(rest, params)?))
    }
}

impl StrandSolver for MassSpring {
    type State = Vec<Zigzag>;

    fn step(
        &mut self,
        state: &mut Vec<Zigzag>,
        surroundings: &Surroundings,
        dt: f64,
    ) -> Result<Stats, DynamicsError> {
        let substeps = self.substeps;
        apart::step(state, surroundings, self.points, dt, |strand, head| {
            strand.step(surroundings, head, dt, substeps)
        })
    }

    fn teleport(&self, state: &mut Vec<Zigzag>, to: Roots) -> Result<(), DynamicsError> {
        apart::teleport(state, to, self.points)
    }

    fn points(&self, state: &Vec<Zigzag>, strand: usize) -> impl ExactSizeIterator<Item = DVec3> {
        state[strand].points()
    }

    fn frames(&self, state: &Vec<Zigzag>, strand: usize) -> impl ExactSizeIterator<Item = DQuat> {
        let strand = &state[strand];
        (0..strand.pulls.len()).map(|link| {
            if strand.is_rigid {
                // Its zigzag may be a point.
                strand.head.rotation * strand.rest_frames[link + 1]
            } else {
                frame(&strand.points, link + 1)
            }
        })
    }
}

/// One strand, constants and motion: particles in the order of the zigzag, of which every other one from the root on is the
/// strand's.
#[derive(Clone, Debug)]
pub struct Zigzag {
    truss: Truss,
    /// Pull of the strand's particles behind the root to their goals, in 1/s^2.
    pulls: Vec<f64>,
    drag: f64,
    /// The share of the wind that reaches it.
    wind: f64,
    thickness: f64,
    friction: f64,
    /// Of its points in the list of all strands'.
    first_point: usize,
    /// Whether it only follows its root.
    is_rigid: bool,
    /// In style space: all particles, and the frames of the skin and the links.
    styled: Vec<DVec3>,
    rest_frames: Vec<DQuat>,
    /// Where the head was.
    head: Pose,
    /// Of the time and the wind since the start.
    blown: Blown,
    points: Vec<DVec3>,
    velocities: Vec<DVec3>,
    /// Places of the goals at the end of the step before; none yet at the start.
    goals: Vec<DVec3>,
}

impl Zigzag {
    /// The strand through these points (style space, m) at rest.
    #[must_use]
    pub fn new(points: &[Vec3], params: &Params) -> Self {
        <Self as Strand>::new(points, params, 0)
    }

    /// Its points in the world, root first, in m.
    pub fn points(&self) -> impl ExactSizeIterator<Item = DVec3> {
        self.points.iter().skip(HELD - 1).step_by(2).copied()
    }

    /// Advances it by `dt` seconds, at whose end the head is at `head`, in `substeps`.
    pub fn step(
        &mut self,
        surroundings: &Surroundings,
        head: Pose,
        dt: f64,
        substeps: u32,
    ) -> Stats {
        let before = self.head;
        let set_aside = Stats {
            set_aside: 1,
            ..Stats::default()
        };
        if !head.is_rigid() {
            return set_aside;
        }
        if self.is_rigid {
            self.teleport(head);
            return set_aside;
        }
        // In the middle of the step.
        let gusts = surroundings.air_at(0.5, self.blown, dt);
        self.blown = surroundings.blown(1.0, self.blown, dt);
        let goals = self.goals_at(surroundings, head);
        let felt = gusts.blows && self.drag > 0.0;
        let mut stats = Stats {
            strands: 1,
            wind: if felt { self.pulls.len() } else { 0 },
            ..Stats::default()
        };
        for substep in 1..=substeps {
            let acting = Acting {
                gravity: surroundings.gravity,
                gusts: gusts.blows.then_some(&gusts),
                colliders: surroundings.colliders,
                share: f64::from(substep) / f64::from(substeps),
            };
            let now = if substep == substeps {
                head
            } else {
                on_the_way(before, head, acting.share)
            };
            stats.contacts += self.substep(&acting, &goals, now, dt, substeps);
        }
        self.head = head;
        self.goals = goals;
        if !self.points.iter().all(|point| point.is_finite()) {
            // It has no safe integrator behind it.
            self.is_rigid = true;
            self.put_into_style(head);
        }
        stats
    }

    /// Where the goals of the strand's particles are at the end of a step, root first.
    fn goals_at(&self, surroundings: &Surroundings, head: Pose) -> Vec<DVec3> {
        let place = |k: usize| match surroundings.goal {
            Some(goal) => goal[self.first_point + k].as_dvec3(),
            None => self.styled[2 * k + HELD - 1],
        };
        let places = (0..=self.pulls.len()).map(|k| head.to_world(place(k)));
        places.collect()
    }

    /// A step of Euler's, `whole` seconds over `substeps`. Returns how many particles met a body.
    fn substep(
        &mut self,
        acting: &Acting,
        goals: &[DVec3],
        head: Pose,
        whole: f64,
        substeps: u32,
    ) -> usize {
        let dt = whole / f64::from(substeps);
        for i in 0..HELD {
            let to = head.to_world(self.styled[i]);
            self.velocities[i] = (to - self.points[i]) / dt;
        }
        let goals_before = if self.goals.is_empty() {
            goals
        } else {
            &self.goals
        };
        let Self {
            truss,
            pulls,
            points,
            velocities,
            ..
        } = self;
        // A goal pulls at a particle of the strand with its own mass and that of those aside.
        let pull = |i: usize| {
            let k = i / 2 - 1;
            let is_pulled = i.is_multiple_of(2) && pulls[k - 1] > 0.0;
            is_pulled
                .then(|| Pull::new(pulls[k - 1], goals_before[k], goals[k], acting.share, whole))
        };
        let slow = 1.0 + self.drag * dt;
        let inertia = |i: usize, mass: f64| {
            let slowing = pull(i).map_or(0.0, |pull| 2.0 * pull.slowing(dt));
            mass * (slow + slowing)
        };
        let push = |i: usize, mass: f64| {
            let air = acting.air(points[i]) * (self.drag * self.wind);
            let pulled = pull(i).map_or(DVec3::ZERO, |pull| pull.push(points[i]) * 2.0);
            (velocities[i] + (acting.gravity + air + pulled) * dt) * mass
        };
        truss.begin(inertia, push);
        truss.add_springs(points, velocities, [dt * dt, dt]);
        match truss.solve() {
            Some(solution) => {
                for (velocity, solution) in velocities[HELD..].iter_mut().zip(solution) {
                    *velocity = solution;
                }
            }
            None => velocities.fill(DVec3::NAN),
        }
        let mut contacts = 0;
        for i in 0..points.len() {
            let before = points[i];
            points[i] = if i < HELD {
                head.to_world(self.styled[i])
            } else {
                before + velocities[i] * dt
            };
            let is_strand = i >= HELD && i.is_multiple_of(2);
            if is_strand {
                let met = acting.keep_out(&mut points[i], before, self.thickness, self.friction);
                if met > 0 {
                    velocities[i] = (points[i] - before) / dt;
                    contacts += met;
                }
            }
        }
        contacts
    }

    /// Puts it into its style, at rest.
    fn put_into_style(&mut self, to: Pose) {
        for (point, styled) in self.points.iter_mut().zip(&self.styled) {
            *point = to.to_world(*styled);
        }
        self.velocities.fill(DVec3::ZERO);
        self.head = to;
    }

    /// Kinetic energy and that of weight and springs without altitudes, per linear density, in m^3/s^2.
    #[must_use]
    pub fn energy(&self, gravity: DVec3) -> f64 {
        let free = HELD..self.points.len();
        let moving = free.map(|i| {
            let moving = 0.5 * self.velocities[i].length_squared();
            self.truss.masses[i] * (moving - gravity.dot(self.points[i]))
        });
        moving.sum::<f64>() + self.truss.energy(&self.points)
    }
}

/// The frames of skin and links of a strand whose joints have their natural turns.
fn natural_frames(rest: &RestStrand) -> Vec<DQuat> {
    let turned = |frame: &mut DQuat, link: &RestLink| {
        let half = 0.5 * link.natural;
        let turn = DQuat::from_xyzw(half.x, half.y, half.z, 1.0).normalize();
        *frame = (*frame * turn).normalize();
        Some(*frame)
    };
    let links = rest.links.iter().scan(rest.base, turned);
    std::iter::once(rest.base).chain(links).collect()
}

impl Strand for Zigzag {
    fn new(points: &[Vec3], params: &Params, first_point: usize) -> Self {
        let (rest, is_rigid) = match RestStrand::new(points, params) {
            Ok(rest) => (rest, false),
            Err(_) => (RestStrand::rigid(points), true),
        };
        let total: f64 = rest.links.iter().map(|link| link.length).sum();
        let count = rest.links.len();
        // A link without length would be an edge without direction.
        let least = if is_rigid {
            0.0
        } else {
            1e-3 * total / count.max(1) as f64
        };
        let lengths: Vec<f64> = rest
            .links
            .iter()
            .map(|link| link.length.max(least))
            .collect();
        let mut rest_frames = vec![rest.base];
        rest_frames.extend(rest.links.iter().map(|link| link.frame));
        let styled = zigzag(rest.root, &rest_frames, &lengths);
        let without_force = || match params.natural {
            Natural::Styled | Natural::Balanced => styled.clone(),
            Natural::Curl { .. } => zigzag(rest.root, &natural_frames(&rest), &lengths),
        };
        let bending = params.material.bending();
        let share = match count {
            0 => 1.0,
            _ => bending_share(count, total, bending * params.stiffness.at(0.5)),
        };
        let mut truss = Truss::new(
            &without_force(),
            &lengths,
            |u| bending * params.stiffness.at(u),
            share,
        );
        if params.natural == Natural::Balanced {
            truss.balance(&styled, DVec3::NEG_Y * GRAVITY);
        }
        let pulls = rest.links.iter().map(|link| params.goal.at(link.end_at));
        Self {
            truss,
            pulls: pulls.collect(),
            drag: params.drag * params.drag_at.at(0.5),
            wind: params.wind.at(0.5),
            thickness: params.thickness,
            friction: params.friction,
            first_point,
            is_rigid,
            head: Pose::IDENTITY,
            blown: Blown::default(),
            velocities: vec![DVec3::ZERO; styled.len()],
            goals: Vec::new(),
            points: styled.clone(),
            styled,
            rest_frames,
        }
    }

    fn teleport(&mut self, to: Pose) {
        let from = self.head;
        let turn = to.rotation * from.rotation.conjugate();
        for point in self.points.iter_mut().chain(&mut self.goals) {
            *point = to.to_world(from.to_local(*point));
        }
        for velocity in &mut self.velocities {
            *velocity = turn * *velocity;
        }
        self.head = to;
    }
}
