//! Hair in motion: the simulated part of a scene.
//!
//! What a style holds on the head moves with it; the rest of each strand is simulated from there. Of
//! many strands some are guides, and carry the others.

mod air;
mod bodies;
mod carried;
mod feel;
#[cfg(test)]
mod kept_out;
#[cfg(test)]
mod ponytail;
mod running;
mod seam;
mod section;
mod ties;
#[cfg(test)]
pub(crate) mod together;

pub use section::{DynamicsSection, FeelChoice, ShapeChoice, SolverChoice};

use crate::bodies::{Followed, Gap, clear, followed, gaps};
use crate::files::StageError;
use crate::hair::HairModel;
use crate::hand::Driver;
use crate::neck::{pivot, rigid};
use crate::placement::Placement;
use crate::posture::Posture;
use crate::script::HeadPose;
use crate::skeleton::after;
use bodies::GAP_M;
pub(crate) use bodies::{Bodies, BodyMesh, Reach};
use carried::Carried;
pub(crate) use feel::ZoneDynamics;
use feel::{Feel, Strand};
use glam::{DVec3, Vec3};
#[cfg(feature = "compare")]
use hair_sim::compare::{MassSpring, Xpbd};
use hair_sim::{
    Acceleration, Collider, DynamicsError, GRAVITY, Params, Placed, PointCache, Pose, Roots,
    Solver, Stats, Strands, Surroundings, Wind,
};
use rayon::prelude::*;
use render::Head;
use running::{Run, Running};
use seam::{Seams, way};
use std::ops::Range;
use std::sync::Arc;
use ties::Ties;
pub(crate) use ties::turn_of;

/// Steps within a step of the solvers that take some, where the preset says nothing.
#[cfg(feature = "compare")]
const XPBD_SUBSTEPS: u32 = 64;
#[cfg(feature = "compare")]
const MASS_SPRING_SUBSTEPS: u32 = 4;

/// The shortest step in s that is worth one of its own.
const SHORTEST_STEP: f64 = 2e-6;
/// Parts of a second that times are told in: as fine as needed for the shortest step's accelerations.
const MOMENTS: f64 = (1_u64 << 44) as f64;
/// So many steps of hair that is not seen are taken as one, and of hair that is seen small,
const UNSEEN_STEPS: i64 = 4;
const SMALL_STEPS: i64 = 2;
/// while the head's acceleration is below this, in m/s^2: a long step through a turn of the head would throw hair about.
const CALM: f64 = 2.0;

/// Where a simulated strand's points go.
struct Part {
    /// The points of the scene that it moves: all behind those that the head holds.
    points: Range<usize>,
    /// Its first point of the solver's.
    strand: usize,
}

/// How hair is seen by a live program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Seen {
    /// Wholly off the picture.
    Not,
    /// So small that nobody sees where it is to a step.
    Small,
    /// As it is.
    Well,
}

/// Whether strands are moved, or it is looked where they would come to.
#[derive(Clone, Copy)]
enum Drives {
    Step,
    Look,
}

/// The solver with its strands, and the time it has come to.
pub(crate) struct Dynamics {
    strands: Box<dyn Running>,
    guides: Vec<Part>,
    /// The shapes that pull at all points of the scene; where they have these at a time, and the guides' points.
    shapes: Option<PointCache>,
    shape: Vec<Vec3>,
    goal: Vec<Vec3>,
    carried: Carried,
    /// The points of the scene that stay with the head: those of no guide, and of carried strands but their roots.
    on_head: Vec<usize>,
    /// How far the links of the scene's points are kept from bodies: no farther than they were at the start.
    gaps: Vec<Gap>,
    ties: Ties,
    /// Whether all strands slept in the last step. What is looked at between two steps doesn't count.
    is_asleep: bool,
    /// Where the head jumps.
    seams: Seams,
    bodies: Arc<Bodies>,
    /// How far all of this hair comes.
    reach: Reach,
    head: Head,
    placement: Placement,
    gravity: DVec3,
    seed: u64,
    /// Seconds of one step.
    step: f64,
    /// Steps before the time 0.
    warm_up: i64,
    /// Steps done since the start.
    done: i64,
    /// The time of what is shown, seconds.
    shown: f64,
    /// How many more were wanted at the last time, when the hair was not seen.
    owed: i64,
    /// Steps taken, long ones as one.
    taken: u64,
    stats: Stats,
}

/// The solver that the section asks for, with strands of these parameters.
fn simulated(
    section: &DynamicsSection,
    head: Head,
    strands: &Strands,
    params: impl Fn(usize) -> Params,
) -> Result<Box<dyn Running>, DynamicsError> {
    #[cfg(feature = "compare")]
    match section.solver {
        SolverChoice::Xpbd => {
            let substeps = section.substeps_or(XPBD_SUBSTEPS);
            let xpbd = Xpbd::with(strands, params, substeps, 1)?;
            return Ok(Box::new(Run::new(xpbd, strands.len())));
        }
        SolverChoice::MassSpring => {
            let substeps = section.substeps_or(MASS_SPRING_SUBSTEPS);
            let springs = MassSpring::with(strands, params, substeps)?;
            return Ok(Box::new(Run::new(springs, strands.len())));
        }
        SolverChoice::Rods | SolverChoice::None => {}
    }
    let (mut solver, mut state) = Solver::with(strands, params)?;
    if let Some(mutual) = feel::mutual(section, head) {
        solver.interact(&mut state, &mutual)?;
    }
    Ok(Box::new(Run::new((solver, state), strands.len())))
}

/// The time of a frame, or a part of it that is at most `longest` s.
fn part_of_frame(frame: f64, longest: f64) -> f64 {
    // What a frame's time in single precision can tell from the longest is no reason for another step.
    let parts = (frame / longest - 1e-6).ceil().max(1.0);
    frame / parts
}

impl Dynamics {
    /// The dynamics of hair whose strands have these sizes (1/300 head heights), among these bodies. `hold` is
    /// the pull to its key shapes, where it has some.
    ///
    /// # Errors
    ///
    /// When a parameter is out of the solver's range.
    pub fn new(
        hair: &HairModel,
        sizes: &[f32],
        bodies: Arc<Bodies>,
        section: &DynamicsSection,
        hold: [f64; 3],
        fps: f32,
        seed: u32,
    ) -> Result<Self, StageError> {
        let hold = hair.shapes.as_ref().map(|_| hold);
        let feel = Feel::new(section, hair.head, hold, seed);
        let all = &hair.file.strands;
        let mut free = Strands::new();
        let mut parts = Vec::new();
        for strand in 0..all.len() {
            let range = all.point_range(strand);
            let points = range.start + hair.held(strand) - 1..range.end;
            // A strand that the head holds to its tip has nothing to simulate.
            if points.len() > 1 {
                free.push(strand as u32, &all.points()[points.clone()], None)?;
                parts.push(points);
            }
        }
        let (guides, carried) = carried::choose(&free, &parts, section.guides);
        let chosen = free.select(&guides);
        let length_m = |i: usize| {
            let links = chosen.strand(i).windows(2);
            f64::from(links.map(|link| link[0].distance(link[1])).sum::<f32>())
        };
        let params = |i: usize| {
            let strand = chosen.id(i) as usize;
            let id = hair.infos[strand].id;
            feel.params(Strand {
                id,
                size: sizes[strand],
                length_m: length_m(i),
                zone: hair.zone_dynamics(id),
            })
        };
        let strands = simulated(section, hair.head, &chosen, params)?;
        let gravity = GRAVITY * f64::from(section.gravity);
        let step = match f64::from(section.step) {
            0.0 => {
                let longest = (0..chosen.len())
                    .map(|i| params(i).longest_step(length_m(i).max(1e-4), gravity))
                    .fold(f64::INFINITY, f64::min);
                part_of_frame(1.0 / f64::from(fps), longest)
            }
            step => step,
        };
        let guides = (0..).zip(&guides).map(|(strand, &part)| Part {
            points: parts[part].clone(),
            strand,
        });
        let guides: Vec<Part> = guides.collect();
        let first_of = |part: &Part| {
            let strand = chosen.id(part.strand) as usize;
            (strand, part.points.start - all.point_range(strand).start)
        };
        let mut moves = vec![false; all.points().len()];
        let own = guides.iter().map(|part| part.points.clone());
        for range in own.chain(carried.ranges().iter().map(|r| r.start + 1..r.end)) {
            moves[range].fill(true);
        }
        let ties = Ties::new(hair, &guides.iter().map(first_of).collect::<Vec<_>>());
        if !ties.are_none() && section.solver != SolverChoice::Rods {
            let solver = section.solver.name();
            let message = format!(
                "solver: {solver} has no ties that move with the hair, as zones have with `low_tie`; take rods"
            );
            let section = "dynamics";
            return Err(StageError::Unsupported { section, message });
        }
        Ok(Self {
            on_head: (0..moves.len()).filter(|&point| !moves[point]).collect(),
            gaps: Vec::new(),
            bodies,
            reach: Reach::of((0..all.len()).map(|strand| all.strand(strand)), hair.head),
            ties,
            is_asleep: false,
            seams: Seams::default(),
            shapes: hair.shapes.clone(),
            shape: all.points().to_vec(),
            goal: Vec::new(),
            carried,
            guides,
            strands,
            head: hair.head,
            placement: Placement::default(),
            gravity: DVec3::new(0.0, -gravity, 0.0),
            seed: u64::from(seed),
            warm_up: (f64::from(section.warm_up) / step).round() as i64,
            step,
            done: 0,
            shown: f64::NEG_INFINITY,
            owed: 0,
            taken: 0,
            stats: Stats::default(),
        })
    }

    /// Takes on where the head stands in the world: winds come from there.
    pub fn stand(&mut self, placement: Placement) {
        self.placement = placement;
    }

    /// What happened in the last step.
    pub fn stats(&self) -> Stats {
        self.stats
    }

    /// Whether hair moves in a scene: a script drives it, or it is not at rest by itself.
    pub fn moves(section: &DynamicsSection, driver: Driver) -> bool {
        let is_at_rest = section.shape == ShapeChoice::Styled && section.gravity == 1.0;
        section.solver != SolverChoice::None && !(driver.is_still() && is_at_rest)
    }

    /// How many steps have been taken, long ones counted as one.
    pub fn taken(&self) -> u64 {
        self.taken
    }

    /// Steps towards `time` (seconds) of a driver for as long as `goes_on` says so, and answers to which time it came: where that is
    /// before `time`, the next call goes on from there. A time between two steps is come to by a shorter step of its own, from which
    /// nothing goes on: the motion is the same whatever times are looked at. Hair that is not seen, or seen small, comes after in long steps; as soon as
    /// it is seen well, one step takes it to where it should be.
    ///
    /// # Errors
    ///
    /// When the solver refuses the scene.
    pub fn advance_to(
        &mut self,
        time: f64,
        driver: Driver,
        seen: Seen,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<f64, StageError> {
        // What the time's own precision, single, can tell from a whole step.
        let slack = time.abs() * f64::from(f32::EPSILON) + SHORTEST_STEP;
        let wanted = ((time + slack) / self.step).floor() as i64 + self.warm_up;
        let wanted = wanted.max(0);
        if wanted < self.done || self.done == 0 {
            self.begin(driver)?;
        }
        let mut goes_on_to = |done: i64| done < wanted && goes_on();
        let is_seen = seen == Seen::Well;
        if is_seen {
            let owed = self.owed.min(wanted - self.done);
            if owed > 0 {
                self.step(owed, driver)?;
            }
            self.owed = 0;
            while goes_on_to(self.done) {
                self.step(1, driver)?;
            }
        } else {
            let steps = match seen {
                Seen::Not => UNSEEN_STEPS,
                Seen::Small | Seen::Well => SMALL_STEPS,
            };
            while goes_on_to(self.done) {
                let is_calm = self.is_calm(driver);
                if is_calm && wanted - self.done < steps {
                    break;
                }
                self.step(if is_calm { steps } else { 1 }, driver)?;
            }
            self.owed = wanted - self.done;
        }
        self.strands.look_back();
        let mut shown = self.time_of(self.done);
        let is_there = !is_seen || self.done == wanted;
        if is_seen && is_there && time > shown + slack {
            shown = time;
            let ahead = time - self.time_of(self.done);
            let ties = self.ties.held();
            self.stats = self.drive((time, ahead), driver, Drives::Look)?;
            self.ties.put_back(ties);
        }
        self.shown = shown;
        Ok(if is_there { time } else { shown })
    }

    /// Puts all hair where it is at the start.
    ///
    /// # Errors
    ///
    /// When the solver refuses the scene.
    pub fn begin(&mut self, driver: Driver) -> Result<(), StageError> {
        self.done = 0;
        self.owed = 0;
        self.seams = Seams::of(driver.script);
        let start = self.time_of(0);
        let first = self.pose_at(start, driver);
        let styled = self.styled(driver);
        let colliders = (self.bodies).within(self.reach, driver.script, [start; 2], [&styled; 2]);
        let of_figure = self.of_figure();
        (self.strands).restart((styled.head, &colliders, of_figure), first)?;
        self.ties.restart();
        self.is_asleep = false;
        self.gaps = self.gaps_at_start((styled.head, first), &colliders);
        Ok(())
    }

    /// The points that [`Self::write`] leaves where the head has them; None at the start: all of them.
    pub fn on_head(&self) -> Option<&[usize]> {
        (!self.is_at_start()).then_some(&self.on_head[..])
    }

    /// Writes where it came to into the points of what moves; those of the others are where the head has them. Hair that comes after is on the head
    /// where that is at `time` (seconds).
    pub fn write(&self, driver: Driver, time: f64, points: &mut [Vec3]) {
        if self.is_at_start() {
            // All hair is where the head's pose has put it.
            return;
        }
        let posture = self.posture_at(self.shown, driver);
        let bodies = self.bodies_at(self.shown, &posture, driver);
        let start = || followed(&bodies, self.of_figure());
        let keep_out = |bodies: &mut Vec<Followed>, first: usize, points: &mut [Vec3]| {
            let gap = |i| self.gaps[first + i];
            clear(points, 1, bodies, GAP_M, gap);
        };
        let own = carried::parts_of(points, self.guides.iter().map(|part| &part.points));
        let guides: Vec<(&Part, &mut [Vec3])> = self.guides.iter().zip(own).collect();
        (guides.into_par_iter()).for_each_init(start, |bodies, (part, points)| {
            self.write_guide(part, points);
            keep_out(bodies, part.points.start, points);
        });
        let turns = |strand| self.strands.turns(strand);
        self.carried.carry(points, turns, (start, keep_out));
        if self.owed > 0 {
            self.carry_on(driver, time, points);
        }
    }

    /// Moves strands out of bodies as these are at `time` (seconds), as [`Self::write`] does, once it has begun. The points of those that were moved.
    pub fn keep_out(&self, driver: Driver, time: f64, points: &mut [Vec3]) -> Vec<Range<usize>> {
        let posture = self.posture_at(time, driver);
        let bodies = self.bodies_at(time, &posture, driver);
        let mut bodies = followed(&bodies, self.of_figure());
        let parts = self.guides.iter().map(|part| &part.points);
        let parts = parts.chain(self.carried.ranges()).filter(|range| {
            let gap = |i| self.gaps[range.start + i];
            clear(&mut points[(*range).clone()], 1, &mut bodies, GAP_M, gap)
        });
        parts.cloned().collect()
    }

    /// Writes the points of a guide as its solver has them.
    fn write_guide(&self, part: &Part, points: &mut [Vec3]) {
        for (point, moved) in points.iter_mut().zip(self.strands.points(part.strand)) {
            *point = moved.as_vec3();
        }
    }

    /// How the figure stands where hair is as it is styled: at rest, or where a skeleton has it at the start.
    fn styled<'s>(&self, driver: Driver<'s>) -> Posture<'s> {
        let (start, script) = (self.time_of(0), driver.script);
        if script.skeleton().is_some() {
            return self.posture_at(start, driver);
        }
        let head = (self.head, pivot(self.head));
        Posture::of(HeadPose::REST, head, script, script.within(start))
    }

    /// How near to bodies hair is at the start, but on a head as it is styled there.
    fn gaps_at_start(&self, (styled, first): (Pose, Pose), colliders: &[Collider]) -> Vec<Gap> {
        let bodies: Vec<Placed> = colliders.iter().map(Placed::new).collect();
        let back = way([first, styled]);
        let mut points = vec![Vec3::ZERO; self.shape.len()];
        for part in &self.guides {
            let own = &mut points[part.points.clone()];
            for (point, at) in own.iter_mut().zip(self.strands.points(part.strand)) {
                *point = (back.rotation * at + back.translation).as_vec3();
            }
        }
        self.carried.at_rest(styled, &mut points);
        let parts = self.guides.iter().map(|part| &part.points);
        let parts: Vec<&Range<usize>> = parts.chain(self.carried.ranges()).collect();
        let found: Vec<Vec<Gap>> = (parts.par_iter())
            .map(|range| {
                gaps(
                    &points[(*range).clone()],
                    (&bodies, self.of_figure()),
                    GAP_M,
                )
            })
            .collect();
        let mut all = vec![[GAP_M; 4]; points.len()];
        for (range, found) in parts.iter().zip(found) {
            all[(*range).clone()].copy_from_slice(&found);
        }
        all
    }

    /// How many bodies, the first ones, the solver takes for the figure's.
    fn of_figure(&self) -> usize {
        self.bodies.of_figure().max(1)
    }

    /// The bodies within reach at a time (seconds), at which the figure stands so.
    fn bodies_at<'a>(
        &'a self,
        time: f64,
        posture: &Posture<'a>,
        driver: Driver<'a>,
    ) -> Vec<Placed<'a>> {
        let colliders = (self.bodies).within(self.reach, driver.script, [time; 2], [posture; 2]);
        colliders.iter().map(Placed::new).collect()
    }

    /// Moves what is shown on with the head, to `time` (seconds).
    fn carry_on(&self, driver: Driver, time: f64, points: &mut [Vec3]) {
        let on = way([self.shown, time].map(|time| self.pose_at(time, driver)));
        let parts = self.guides.iter().map(|part| &part.points);
        for range in parts.chain(self.carried.ranges()) {
            for point in &mut points[range.clone()] {
                *point = (on.rotation * point.as_dvec3() + on.translation).as_vec3();
            }
        }
    }

    /// Whether what is shown is the start.
    fn is_at_start(&self) -> bool {
        self.shown <= self.time_of(0)
    }

    /// Whether the head's motion is even from the last step to the end of a long one.
    fn is_calm(&self, driver: Driver) -> bool {
        let height_m = f64::from(self.head.height_m);
        let places = |by: i64| {
            let steps = self.done + by;
            let [time, here] = [steps, self.done].map(|steps| self.time_of(steps));
            let pose = self.pose_beside(time, here, driver);
            let center = self.head.center.as_dvec3();
            [DVec3::X, DVec3::Z]
                .map(|side| pose.rotation * (center + side * height_m) + pose.translation)
        };
        let places: [[DVec3; 2]; UNSEEN_STEPS as usize + 2] =
            std::array::from_fn(|i| places(i as i64 - 1));
        places.windows(3).all(|places| {
            let [before, now, after] = [places[0], places[1], places[2]];
            (0..2).all(|i| {
                let bend = before[i] + after[i] - 2.0 * now[i];
                bend.length() <= CALM * self.step * self.step
            })
        })
    }

    /// Takes so many steps as one.
    fn step(&mut self, steps: i64, driver: Driver) -> Result<(), StageError> {
        let end = self.time_of(self.done + steps);
        // Not the difference of two times, whose last bits hang on when it is.
        let dt = steps as f64 * self.step;
        self.stats = self.drive((end, dt), driver, Drives::Step)?;
        self.done += steps;
        self.taken += 1;
        Ok(())
    }

    /// Turns the normals of the links that move from those at rest, both in the list of the scene's points.
    pub fn turn_normals(&self, rest: &[Vec3], normals: &mut [Vec3]) {
        if self.is_at_start() {
            return;
        }
        for part in &self.guides {
            let mut last = part.points.start;
            for (link, turn) in part.points.clone().zip(self.strands.turns(part.strand)) {
                normals[link] = turn.as_quat() * rest[link];
                last = link;
            }
            normals[part.points.end - 1] = normals[last];
        }
        let turns = |strand| self.strands.turns(strand);
        self.carried.turn(rest, normals, turns);
    }

    /// Takes a step of `dt` seconds from the last one to `end`, or looks there.
    fn drive(
        &mut self,
        (end, dt): (f64, f64),
        driver: Driver,
        drives: Drives,
    ) -> Result<Stats, StageError> {
        let begin = self.time_of(self.done);
        let postures = [begin, end].map(|time| self.posture_at(time, driver));
        let now = postures[1].head;
        let seam = self.seam([begin, end], driver);
        let from = (seam.as_ref()).map(|seam| after(postures[0].head, seam.way()));
        let before = from.unwrap_or(postures[0].head);
        let [wind_before, wind] = [begin, end].map(|time| {
            let (steady, gust) = driver.wind_at(time);
            Wind {
                steady: self.placement.own_direction(steady),
                gust,
                size: 2.0 * f64::from(self.head.height_m),
                seed: self.seed,
                period: air::period(driver.script),
            }
        });
        let mut streams = air::streams(driver, &self.placement, self.head, [begin, end]);
        self.aim(driver.script.within(end));
        // Over whole steps, so that what jumps in a script is felt whole, however it lies between the steps.
        let accelerations = [(begin, before), (end, now)].map(|(time, pose)| {
            let [earlier, later] =
                [-self.step, self.step].map(|by| self.pose_beside(time + by, end, driver));
            Acceleration::between([earlier, pose, later], self.step)
        });
        let both = [0, 1].map(|i| &postures[i]);
        let near = (self.bodies).near(self.reach, driver.script, [begin, end], both);
        let mut colliders = (self.bodies).colliders(driver.script, [begin, end], both, &near);
        if let Some(seam) = &seam {
            self.carry_over(seam, driver, &near, (&mut colliders, &mut streams));
            self.ties.carry(seam.way());
        }
        let scene = Surroundings {
            roots: Roots::Head(now),
            acceleration: Some(accelerations),
            gravity: self.gravity,
            wind,
            wind_before: Some(wind_before),
            streams: &streams,
            colliders: &colliders,
            of_one_figure: self.bodies.of_figure(),
            goal: self.shapes.as_ref().map(|_| &self.goal[..]),
            anchors: &[],
        };
        if !self.ties.are_none() {
            // What sleeps stays in its ties, until its head moves.
            if self.is_asleep && before == now {
                self.ties.stay();
            } else {
                self.strands.look_ahead(from, &scene, dt)?;
                let calm = before == now && scene.is_calm() && scene.goal.is_none();
                let calm = calm.then_some(dt);
                self.ties.aim(&*self.strands, (now, &colliders), calm);
            }
        }
        let scene = Surroundings {
            anchors: self.ties.anchors(),
            ..scene
        };
        Ok(match drives {
            Drives::Step => {
                let stats = self.strands.step(from, &scene, dt)?;
                self.is_asleep = stats.strands == 0 && stats.asleep > 0;
                stats
            }
            Drives::Look => self.strands.look_ahead(from, &scene, dt)?,
        })
    }

    /// Takes the goals of the script's own `time` from the key shapes.
    fn aim(&mut self, time: f64) {
        let Some(shapes) = &self.shapes else { return };
        shapes.sample_smooth(time, &mut self.shape);
        self.goal.clear();
        let parts = self.guides.iter().map(|part| part.points.clone());
        self.goal
            .extend(parts.flatten().map(|point| self.shape[point]));
    }

    /// The script's time after a number of steps.
    fn time_of(&self, steps: i64) -> f64 {
        // In fractions that periods are added to without rounding: what sticks or slips hangs on the last bit.
        ((steps - self.warm_up) as f64 * self.step * MOMENTS).round() / MOMENTS
    }

    fn pose_at(&self, time: f64, driver: Driver) -> Pose {
        let (rotation, translation) = rigid(driver.head_at(time), self.head, pivot(self.head));
        Pose {
            rotation,
            translation,
        }
    }

    /// Where all that hair is kept out of is.
    fn posture_at<'s>(&self, time: f64, driver: Driver<'s>) -> Posture<'s> {
        let script = driver.script;
        let head = (self.head, pivot(self.head));
        Posture::of(driver.head_at(time), head, script, script.within(time))
    }
}
