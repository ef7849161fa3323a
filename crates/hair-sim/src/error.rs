//! What can be wrong with strands, parameters, states and scenes.

/// Why there is no solver, or no step.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DynamicsError {
    /// A parameter has a range.
    #[error("strand {id}: {name} is {value}, and must be from {least} to {most}")]
    Parameter {
        /// The strand's id.
        id: u32,
        /// The parameter.
        name: &'static str,
        /// As it was given.
        value: f64,
        /// The least.
        least: f64,
        /// The most.
        most: f64,
    },
    /// A step takes time.
    #[error("a step of {0} s: it must be from 1e-6 to 10 s")]
    Step(f64),
    /// Numbers of the scene are finite, rotations and axes of unit length, radii no less than 0.
    #[error("the scene's {0} is not finite, or its rotation, axis or radius invalid")]
    Surroundings(&'static str),
    /// An anchor's stiffness has a range.
    #[error("anchor {anchor}: its stiffness is {stiffness}, and must be from 0 to 1e9 1/s^2")]
    Anchor {
        /// Its place in the list.
        anchor: usize,
        /// As it was given.
        stiffness: f64,
    },
    /// A number of [`Mutual`](crate::Mutual) has a range.
    #[error("{name} is {value}, and must be from {least} to {most}")]
    Mutual {
        /// Its name.
        name: &'static str,
        /// As it was given.
        value: f64,
        /// The least.
        least: f64,
        /// The most.
        most: f64,
    },
    /// There is one pose for every strand.
    #[error("{found} poses for {expected} strands")]
    Poses {
        /// How many there are.
        found: usize,
        /// How many strands there are.
        expected: usize,
    },
    /// There is one goal for every point.
    #[error("goals for {found} points; the strands have {expected}")]
    Goal {
        /// How many there are.
        found: usize,
        /// How many points there are.
        expected: usize,
    },
    /// Strands that act on each other are told apart.
    #[error("two strands have the id {0}: strands that act on each other need ids of their own")]
    SameId(u32),
    /// A state belongs to the strands that it was made with.
    #[error("the state is not of these strands and their parameters")]
    State,
}

/// A strand that is set aside: it follows its root without a motion of its own.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("strand {id} is set aside: {reason}")]
pub struct Fault {
    /// The strand's id.
    pub id: u32,
    /// Why.
    pub reason: Reason,
}

/// Why a strand is set aside.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, serde::Serialize, serde::Deserialize,
)]
#[non_exhaustive]
pub enum Reason {
    /// A point of its rest shape (from the root, 0 first) is not finite.
    #[error("point {0} at rest is not finite")]
    Rest(usize),
    /// All its points are one.
    #[error("it has no length")]
    NoLength,
    /// It turns by more than 170 degrees at a point (from the root, 0 first).
    #[error("it folds back on itself at point {0}")]
    Folded(usize),
    /// The pose of its root was not finite, or its rotation not a unit quaternion.
    #[error("the pose of its root is not finite, or its rotation is not a unit quaternion")]
    Root,
    /// A goal was not finite.
    #[error("a goal of its points is not finite")]
    Goal,
    /// It had no finite motion.
    #[error("it had no finite motion")]
    PointCache,
}
