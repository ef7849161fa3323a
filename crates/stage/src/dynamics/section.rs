//! The section `dynamics`, and what its solver can't do.

use effects::{Variation, choices, section};

choices! {
    /// What moves the hair.
    pub enum SolverChoice {
        /// Elastic rods.
        Rods = "rods",
        /// Rods by position based dynamics.
        Xpbd = "xpbd",
        /// Trusses of springs.
        MassSpring = "mass_spring",
        /// Nothing: hair turns with the head.
        None = "none",
    }
}

choices! {
    /// What hair is like.
    pub enum FeelChoice {
        /// It hangs.
        Limp = "limp",
        /// It swings, and comes to rest.
        Soft = "soft",
        /// It swings long.
        Springy = "springy",
        /// It keeps its style.
        Stiff = "stiff",
        /// It all but stands.
        Gel = "gel",
    }
}

choices! {
    /// What shape hair returns to.
    pub enum ShapeChoice {
        /// Its style, against gravity.
        Styled = "styled",
        /// Its style, pulled down by gravity.
        Sagging = "sagging",
        /// A curl.
        Curl = "curl",
        /// A straight line.
        Straight = "straight",
    }
}

section! {
    /// How hair swings, bends and returns to its style.
    pub struct DynamicsSection {
        /// rods: strands bend and twist as elastic rods; for comparison, slower, and without damping, links,
        /// volume, locks, recall and low ties, xpbd: softer rods by position based dynamics, and mass_spring: trusses of springs;
        /// none: hair turns with the head.
        solver: SolverChoice = SolverChoice::Rods.or_another(),
        /// What the hair is like; the factors below change it.
        feel: FeelChoice = FeelChoice::Soft.or_another(),
        /// Factor on the stiffness against bending and twisting. What varies along a strand is taken at its root, half way and its tip, with a
        /// quadratic between.
        stiffness: Variation = varying(1.0, 0.001..=1000.0),
        /// Factor on how soon swinging dies down in the hair itself. With `links` or `volume` it never takes longer than at about a tenth.
        damping: Option<f32> = number(1.0, 0.0..=100.0).optional(),
        /// Factor on the drag of the air, and so on the pull of the wind.
        drag: Variation = varying(1.0, 0.0..=100.0),
        /// Factor on the pull back to the style, or to the script's `shapes`.
        hold: Variation = varying(1.0, 0.0..=100.0),
        /// Pull on hair that has come to lie far from its style, as over the other side of a shoulder, in its weights; 0 leaves it there.
        recall: f32 = number(0.0, 0.0..=100.0),
        /// How far hair may lie from its style before it is recalled; at twice that it is pulled in full.
        recall_from: f32 = number(0.15, 0.001..=10.0).unit("head heights"),
        /// Share of the wind's speed that reaches the hair.
        wind: Variation = varying(1.0, 0.0..=10.0),
        /// Factor on the links that hold neighbouring clumps together until they are pulled apart; 0 has none.
        links: Option<f32> = number(1.0, 0.0..=100.0).optional(),
        /// Factor on how clumps keep each other at a distance; 0: they pass through each other.
        volume: Option<f32> = number(1.0, 0.0..=100.0).optional(),
        /// How far the middle lines of clumps that are apart at rest stay from each other, in their radii, so that they don't pass through each
        /// other, but no farther than half as far as at rest; 0: they pass. It takes the simulation one and a half times to 1.7 times its time.
        locks: f32 = number(0.0, 0.0..=2.0),
        /// Factor on gravity.
        gravity: f32 = number(1.0, -10.0..=10.0),
        /// Friction on head and shoulders.
        friction: f32 = number(0.3, 0.0..=10.0),
        /// How far a clump's middle line stays from the skin, in its radii.
        distance: f32 = number(0.5, 0.0..=2.0),
        /// What shape hair returns to: styled holds the style against gravity, sagging lets gravity pull it
        /// down, curl winds it by curl_radius and curl_pitch, straight has no curl at all, and is the fastest for limp and springy
        /// hair with damping of 0.5 or less.
        shape: ShapeChoice = ShapeChoice::Styled.or_another(),
        /// Radius of the curls of shape: curl.
        curl_radius: f32 = number(0.05, 0.001..=10.0).unit("head heights"),
        /// How far one turn of a curl climbs; below 0 it winds the other way.
        curl_pitch: f32 = number(0.2, -10.0..=10.0).unit("head heights"),
        /// Time of a step of the simulation, 0.00001 or more; 0 is a frame's, or a part of it where hair swings too fast or
        /// too long to be followed in one.
        step: f32 = number(0.0, 0.0..=0.1).unit("s"),
        /// Steps within a step, of solver: xpbd, where fewer make hair softer, and of mass_spring, where fewer
        /// make it swing less; 0 is 64 of xpbd's and 4 of mass_spring's.
        substeps: u32 = whole(0, 0..=1000),
        /// Time that is simulated before the first frame.
        warm_up: f32 = number(0.0, 0.0..=600.0).unit("s"),
        /// Most strands that are simulated; the others are carried by those near them.
        guides: u32 = whole(600, 1..=100_000),
    }
}

/// The shortest step, in s: that of the documentation above.
const SHORTEST_STEP: f32 = 1e-5;

impl DynamicsSection {
    /// Steps within a step, of solvers that take some: `own` where the preset doesn't say.
    #[cfg(feature = "compare")]
    pub(super) fn substeps_or(&self, own: u32) -> u32 {
        match self.substeps {
            0 => own,
            given => given,
        }
    }

    /// What the preset asks for that its solver cannot do: a parameter, and why.
    pub(crate) fn unsupported(&self) -> Option<(&'static str, String)> {
        if self.step > 0.0 && self.step < SHORTEST_STEP {
            let message = format!(
                "step: expected 0, which is a frame's, or a number from {SHORTEST_STEP} to 0.1, found `{}`",
                self.step
            );
            return Some(("step", message));
        }
        match self.solver {
            SolverChoice::Xpbd | SolverChoice::MassSpring if cfg!(not(feature = "compare")) => {
                let solver = self.solver.name();
                Some((
                    "solver",
                    format!(
                        "solver: {solver} is for comparison, and this program was built without it (feature `compare`); take rods"
                    ),
                ))
            }
            SolverChoice::Xpbd | SolverChoice::MassSpring => {
                let asked = [
                    ("damping", self.damping),
                    ("links", self.links),
                    ("volume", self.volume),
                    ("locks", Some(self.locks)),
                    ("recall", Some(self.recall)),
                ];
                let is_asked = |factor: Option<f32>| factor.is_some_and(|factor| factor > 0.0);
                let (name, _) = asked.into_iter().find(|(_, factor)| is_asked(*factor))?;
                let solver = self.solver.name();
                Some((
                    name,
                    format!(
                        "{name}: solver: {solver} has none; leave it out, or take solver: rods"
                    ),
                ))
            }
            SolverChoice::Rods if self.substeps != 0 => Some((
                "substeps",
                "substeps: solver: rods takes a step as one; leave it out, or set `step`"
                    .to_owned(),
            )),
            SolverChoice::Rods | SolverChoice::None => None,
        }
    }
}
