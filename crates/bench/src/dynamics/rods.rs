//! What every solver of this suite is given, and what it must do.

use crate::BenchError;
use glam::{DVec3, Vec3};
use hair_sim::{Material, Natural, Params, Pose};
use rayon::prelude::*;

/// Standard gravity in m/s^2, along -Y.
pub const GRAVITY: f64 = 9.81;
/// Stiffness against twisting over that against bending: of a round section, and hair's default.
pub const TWIST_RATIO: f64 = 2.0 / 3.0;

/// Straight strands of one kind that grow from a head. Masses are per linear density: a metre of strand has mass 1.
#[derive(Clone, Debug)]
pub struct Rods {
    /// The root of every strand in m and the unit direction in which it is clamped.
    pub roots: Vec<(DVec3, DVec3)>,
    /// Elements of a strand.
    pub elements: usize,
    /// In m.
    pub length: f64,
    /// Weight against bending stiffness, rho g S L^3 / (E I).
    pub gamma: f64,
    /// Drag of the air in 1/s, the same in all directions.
    pub drag: f64,
    /// Natural curvature in 1/m, for our own solver.
    pub curvature: f64,
}

/// A curvature in 1/m that nothing shows but that our solver looks for the twist of all that is not straight by nature.
pub const NEARLY_STRAIGHT: f64 = 1e-6;

impl Rods {
    /// `count` strands like one along +X, 0.3 m long, undamped: the drop of Romero et al. 2021.
    #[must_use]
    pub fn level(count: usize, elements: usize, gamma: f64) -> Self {
        Self {
            roots: vec![(DVec3::ZERO, DVec3::X); count],
            elements,
            length: 0.3,
            gamma,
            drag: 0.0,
            curvature: 0.0,
        }
    }

    /// The length of an element in m.
    #[must_use]
    pub fn element(&self) -> f64 {
        self.length / self.elements as f64
    }

    /// Bending stiffness over mass per length, EI / (rho S), in m^4/s^2.
    #[must_use]
    pub fn bending(&self) -> f64 {
        GRAVITY * self.length.powi(3) / self.gamma
    }

    /// The points of a strand at rest.
    #[must_use]
    pub fn points(&self, strand: usize) -> Vec<Vec3> {
        let (root, direction) = self.roots[strand];
        (0..=self.elements)
            .map(|i| (root + direction * (self.element() * i as f64)).as_vec3())
            .collect()
    }

    /// As `hair_sim` has them: no damping but the drag.
    #[must_use]
    pub fn params(&self) -> Params {
        Params {
            material: Material {
                twist_ratio: TWIST_RATIO,
                ..Material::from_gamma(self.gamma, self.length)
            },
            natural: if self.curvature == 0.0 {
                Natural::Styled
            } else {
                Natural::Curl {
                    curvature: self.curvature,
                    torsion: 0.0,
                }
            },
            damping: 0.0,
            drag: self.drag,
            drag_along: 1.0,
            ..Params::default()
        }
    }

    /// A unit vector across `direction`, the same one every time.
    #[must_use]
    pub fn across(direction: DVec3) -> DVec3 {
        direction.any_orthonormal_vector()
    }
}

/// Strands in motion, whatever solves them.
pub trait Simulation: Send {
    /// Advances all strands by `dt` seconds, at whose end the head is at `head`.
    ///
    /// # Errors
    ///
    /// What the solver says of a step that it refuses.
    fn step(&mut self, dt: f64, head: Pose) -> Result<(), BenchError>;

    /// The points of a strand in the world, root first, in m.
    fn points(&self, strand: usize) -> Vec<DVec3>;
}

/// One strand of a solver for comparison.
pub trait Strand: Send {
    /// Advances the strand by `dt` seconds, at whose end the head is at `head`.
    fn step(&mut self, dt: f64, head: Pose);

    /// Its points in the world, root first, in m.
    fn points(&self) -> Vec<DVec3>;
}

/// Strands that don't meet, a task each.
#[derive(Clone, Debug)]
pub struct Apart<S>(pub Vec<S>);

impl<S: Strand> Simulation for Apart<S> {
    fn step(&mut self, dt: f64, head: Pose) -> Result<(), BenchError> {
        match &mut self.0[..] {
            [one] => one.step(dt, head),
            many => many
                .par_iter_mut()
                .with_min_len(4)
                .for_each(|strand| strand.step(dt, head)),
        }
        Ok(())
    }

    fn points(&self, strand: usize) -> Vec<DVec3> {
        self.0[strand].points()
    }
}

impl Simulation for Box<dyn Simulation> {
    fn step(&mut self, dt: f64, head: Pose) -> Result<(), BenchError> {
        (**self).step(dt, head)
    }

    fn points(&self, strand: usize) -> Vec<DVec3> {
        (**self).points(strand)
    }
}
