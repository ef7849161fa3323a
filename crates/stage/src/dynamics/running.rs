//! A solver with its strands, whichever it is.

use glam::{DQuat, DVec3};
use hair_sim::{DynamicsError, Roots, Scene, Stats, StrandSolver};

/// Strands in motion.
pub(super) trait Running: Send {
    /// Puts all back to the start, on roots there.
    fn restart(&mut self, roots: Roots) -> Result<(), DynamicsError>;
    /// Advances by `dt` seconds.
    fn step(&mut self, scene: &Scene, dt: f64) -> Result<Stats, DynamicsError>;
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
}

impl<S: StrandSolver> Run<S> {
    pub fn new((solver, state): (S, S::State)) -> Self {
        Self {
            solver,
            start: state.clone(),
            state,
        }
    }
}

impl<S: StrandSolver + Send> Running for Run<S>
where
    S::State: Send,
{
    fn restart(&mut self, roots: Roots) -> Result<(), DynamicsError> {
        self.state.clone_from(&self.start);
        self.solver.teleport(&mut self.state, roots)
    }

    fn step(&mut self, scene: &Scene, dt: f64) -> Result<Stats, DynamicsError> {
        self.solver.step(&mut self.state, scene, dt)
    }

    fn points(&self, strand: usize) -> Vec<DVec3> {
        self.solver.points(&self.state, strand)
    }

    fn turns(&self, strand: usize) -> Vec<DQuat> {
        let rest = self.solver.frames(&self.start, strand).into_iter();
        let now = self.solver.frames(&self.state, strand).into_iter();
        now.zip(rest)
            .map(|(now, rest)| now * rest.inverse())
            .collect()
    }
}
