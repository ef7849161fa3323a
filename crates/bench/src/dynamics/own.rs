//! Our own solver behind this suite's trait.

use super::rods::{Rods, Simulation, TWIST_RATIO};
use glam::{DVec3, Vec3};
use hair_sim::{Material, Natural, Params, Pose, Roots, Scene, Solver, State, Strands};

/// `hair_sim` as the suite's rods ask for it: straight by nature, no damping but the drag.
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
    pub fn new(rods: &Rods) -> Result<Self, String> {
        let mut strands = Strands::new();
        for (id, (root, direction)) in rods.roots.iter().enumerate() {
            let points: Vec<Vec3> = (0..=rods.elements)
                .map(|i| (*root + *direction * (rods.element() * i as f64)).as_vec3())
                .collect();
            strands
                .push(id as u32, &points, None)
                .map_err(|error| error.to_string())?;
        }
        let params = Params {
            material: Material {
                twist_ratio: TWIST_RATIO,
                ..Material::from_gamma(rods.gamma, rods.length)
            },
            natural: Natural::Styled,
            damping: 0.0,
            drag: rods.drag,
            drag_along: 1.0,
            ..Params::default()
        };
        let (solver, state) = Solver::new(&strands, &params).map_err(|error| error.to_string())?;
        Ok(Self { solver, state })
    }
}

impl Simulation for Own {
    fn step(&mut self, dt: f64, head: Pose) -> Result<(), String> {
        let scene = Scene {
            roots: Roots::Head(head),
            ..Scene::default()
        };
        let stats = self.solver.step(&mut self.state, &scene, dt);
        stats.map(|_| ()).map_err(|error| error.to_string())
    }

    fn points(&self, strand: usize) -> Vec<DVec3> {
        self.solver.points(&self.state, strand).collect()
    }
}
