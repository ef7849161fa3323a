//! Our own solver behind this suite's trait.

use super::rods::{Rods, Simulation};
use crate::BenchError;
use glam::DVec3;
use hair_sim::{Pose, Roots, Solver, State, Strands, Surroundings};

/// `hair_sim` as the suite's rods ask for it.
#[derive(Clone)]
pub struct Own {
    solver: Solver,
    state: State,
}

impl Own {
    /// The strands at rest.
    ///
    /// # Errors
    ///
    /// When the solver refuses them.
    pub fn new(rods: &Rods) -> Result<Self, BenchError> {
        let mut strands = Strands::new();
        for strand in 0..rods.roots.len() {
            strands
                .push(strand as u32, &rods.points(strand), None)
                .map_err(|error| error.to_string())?;
        }
        let (solver, state) =
            Solver::new(&strands, &rods.params()).map_err(|error| error.to_string())?;
        Ok(Self { solver, state })
    }
}

impl Simulation for Own {
    fn step(&mut self, dt: f64, head: Pose) -> Result<(), BenchError> {
        let scene = Surroundings {
            roots: Roots::Head(head),
            ..Surroundings::default()
        };
        let stats = self.solver.step(&mut self.state, &scene, dt);
        stats.map(|_| ()).map_err(|error| error.to_string().into())
    }

    fn points(&self, strand: usize) -> Vec<DVec3> {
        self.solver.points(&self.state, strand).collect()
    }
}
