//! A solver with its strands, whichever it is.

use glam::{DQuat, DVec3};
use hair_sim::{Collider, DynamicsError, Pose, Roots, Stats, StrandSolver, Surroundings};
use std::sync::OnceLock;

/// Strands in motion.
pub(super) trait Running: Send + Sync {
    /// Puts all back to the start, on a head in the pose `first`. As deep as hair is in bodies where the head and these are as it is `styled`, it may stay.
    /// Of these bodies so many, the first ones, are the figure's.
    fn restart(
        &mut self,
        styled: (Pose, &[Collider], usize),
        first: Pose,
    ) -> Result<(), DynamicsError>;
    /// Advances by `dt` seconds, on a head that is first put into the pose `from` at once, where there is one: strands are carried along.
    fn step(
        &mut self,
        from: Option<Pose>,
        scene: &Surroundings,
        dt: f64,
    ) -> Result<Stats, DynamicsError>;
    /// Shows where such a step would bring the strands, until the next step goes on from where they are.
    fn look_ahead(
        &mut self,
        from: Option<Pose>,
        scene: &Surroundings,
        dt: f64,
    ) -> Result<Stats, DynamicsError>;
    /// Shows the strands where they are.
    fn look_back(&mut self);
    /// The points of a strand, m.
    fn points(&self, strand: usize) -> Vec<DVec3>;
    /// How the links of a strand have turned since the start.
    fn turns(&self, strand: usize) -> Vec<DQuat>;
}

/// A solver, its state, and that of the start.
pub(super) struct Run<S: StrandSolver> {
    solver: S,
    state: S::State,
    start: S::State,
    /// The inverse frames of each strand's links at the start, where they were asked for.
    back: Vec<OnceLock<Vec<DQuat>>>,
    /// A state ahead of `state`, and whether it is what is shown.
    ahead: S::State,
    is_ahead: bool,
}

impl<S: StrandSolver> Run<S> {
    /// Of so many strands.
    pub fn new((solver, state): (S, S::State), count: usize) -> Self {
        Self {
            solver,
            start: state.clone(),
            back: vec![OnceLock::new(); count],
            ahead: state.clone(),
            is_ahead: false,
            state,
        }
    }

    fn shown(&self) -> &S::State {
        if self.is_ahead {
            &self.ahead
        } else {
            &self.state
        }
    }
}

impl<S: StrandSolver + Send + Sync> Running for Run<S>
where
    S::State: Send + Sync,
{
    fn restart(
        &mut self,
        (styled, colliders, of_figure): (Pose, &[Collider], usize),
        first: Pose,
    ) -> Result<(), DynamicsError> {
        self.is_ahead = false;
        self.state.clone_from(&self.start);
        (self.solver).teleport(&mut self.state, Roots::Head(styled))?;
        self.solver.settle(&mut self.state, colliders, of_figure)?;
        if first == styled {
            return Ok(());
        }
        self.solver.teleport(&mut self.state, Roots::Head(first))
    }

    fn step(
        &mut self,
        from: Option<Pose>,
        scene: &Surroundings,
        dt: f64,
    ) -> Result<Stats, DynamicsError> {
        self.is_ahead = false;
        if let Some(from) = from {
            (self.solver).teleport(&mut self.state, Roots::Head(from))?;
        }
        self.solver.step(&mut self.state, scene, dt)
    }

    fn look_ahead(
        &mut self,
        from: Option<Pose>,
        scene: &Surroundings,
        dt: f64,
    ) -> Result<Stats, DynamicsError> {
        self.is_ahead = true;
        self.ahead.clone_from(&self.state);
        if let Some(from) = from {
            (self.solver).teleport(&mut self.ahead, Roots::Head(from))?;
        }
        self.solver.step(&mut self.ahead, scene, dt)
    }

    fn look_back(&mut self) {
        self.is_ahead = false;
    }

    fn points(&self, strand: usize) -> Vec<DVec3> {
        self.solver.points(self.shown(), strand).collect()
    }

    fn turns(&self, strand: usize) -> Vec<DQuat> {
        let back = self.back[strand].get_or_init(|| {
            let rest = self.solver.frames(&self.start, strand);
            rest.map(|frame| frame.inverse()).collect()
        });
        let now = self.solver.frames(self.shown(), strand);
        now.zip(back).map(|(now, back)| now * *back).collect()
    }
}
