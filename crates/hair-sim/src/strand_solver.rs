//! What every solver of strands can do.

use glam::{DQuat, DVec3};

use crate::{
    collision::shape::Collider,
    error::DynamicsError,
    solver::{Solver, State},
    stats::Stats,
    surroundings::{Roots, Surroundings},
};

/// A solver of strands: constants and scratch, apart from the state that it advances.
///
/// [`Solver`] is the one to use; those of the module `compare` are for comparison. What a scene may hold that a
/// solver leaves out, it says itself.
pub trait StrandSolver {
    /// All that decides what happens next.
    type State: Clone;

    /// Advances the strands by `dt` seconds.
    ///
    /// # Errors
    ///
    /// When the length of the step, the scene or the state is invalid. The state is unchanged then.
    fn step(
        &mut self,
        state: &mut Self::State,
        surroundings: &Surroundings,
        dt: f64,
    ) -> Result<Stats, DynamicsError>;

    /// Puts the roots elsewhere at once: shape and motion are carried along.
    ///
    /// # Errors
    ///
    /// When the poses or the state are invalid. The state is unchanged then.
    fn teleport(&self, state: &mut Self::State, to: Roots) -> Result<(), DynamicsError>;

    /// Takes note of how deep strands are in bodies as they lie in `state`: so deep they may stay there. The first `of_one_figure` are
    /// [parts of one figure](Surroundings::of_one_figure). Solvers that let none stay don't.
    ///
    /// # Errors
    ///
    /// When a body or the state is invalid. The state is unchanged then.
    fn settle(
        &self,
        _state: &mut Self::State,
        _colliders: &[Collider],
        _of_one_figure: usize,
    ) -> Result<(), DynamicsError> {
        Ok(())
    }

    /// The points of a strand in the world, root first, in m.
    ///
    /// # Panics
    ///
    /// When there is no such strand, or the state is of another solver.
    fn points(&self, state: &Self::State, strand: usize) -> impl ExactSizeIterator<Item = DVec3>;

    /// The frames of a strand's links in the world, root first: the third axis points along the link.
    ///
    /// # Panics
    ///
    /// As [`Self::points`].
    fn frames(&self, state: &Self::State, strand: usize) -> impl ExactSizeIterator<Item = DQuat>;
}

impl StrandSolver for Solver {
    type State = State;

    fn step(
        &mut self,
        state: &mut State,
        surroundings: &Surroundings,
        dt: f64,
    ) -> Result<Stats, DynamicsError> {
        Self::step(self, state, surroundings, dt)
    }

    fn teleport(&self, state: &mut State, to: Roots) -> Result<(), DynamicsError> {
        Self::teleport(self, state, to)
    }

    fn settle(
        &self,
        state: &mut State,
        colliders: &[Collider],
        of_one_figure: usize,
    ) -> Result<(), DynamicsError> {
        Self::settle(self, state, colliders, of_one_figure)
    }

    fn points(&self, state: &State, strand: usize) -> impl ExactSizeIterator<Item = DVec3> {
        Self::points(self, state, strand)
    }

    fn frames(&self, state: &State, strand: usize) -> impl ExactSizeIterator<Item = DQuat> {
        Self::frames(self, state, strand)
    }
}
