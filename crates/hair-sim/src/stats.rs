//! What happened in a step.

/// What happened in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Strands that were stepped.
    pub strands: usize,
    /// Newton iterations of all strands; two a strand is the least.
    pub iterations: usize,
    /// Strands that took the safe integrator in this step.
    pub fallbacks: usize,
    /// Strands that are set aside: see [`Solver::faults`](crate::Solver::faults).
    pub set_aside: usize,
    /// Particles that were near a body or touched it.
    pub contacts: usize,
    /// Particles that were near a lock which is apart from theirs at rest, or touched it.
    pub meetings: usize,
    /// Particles that felt wind.
    pub wind: usize,
    /// Links between strands that held.
    pub links: usize,
    /// Particles that another strand pushed away.
    pub repulsions: usize,
    /// Strands that rest, and cost nothing.
    pub asleep: usize,
}

impl Stats {
    /// What happened in two simulations together.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            strands: self.strands + other.strands,
            iterations: self.iterations + other.iterations,
            fallbacks: self.fallbacks + other.fallbacks,
            set_aside: self.set_aside + other.set_aside,
            contacts: self.contacts + other.contacts,
            meetings: self.meetings + other.meetings,
            wind: self.wind + other.wind,
            links: self.links + other.links,
            repulsions: self.repulsions + other.repulsions,
            asleep: self.asleep + other.asleep,
        }
    }
}
