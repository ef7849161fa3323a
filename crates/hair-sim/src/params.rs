//! What a strand is made of, in physical units.

use std::f64::consts::TAU;

/// Standard gravity in m/s^2, the default of [`Surroundings`](crate::Surroundings) and the measure in [`Material::from_gamma`].
pub const GRAVITY: f64 = 9.81;

/// For how long a swing is followed by [`Params::longest_step`], in s, and after how many times of its decay it is over.
const SWINGS: f64 = 2.0;
const FADES: f64 = 1.5;
/// What goes to and fro less often until then doesn't swing.
const CYCLES: f64 = 2.0;
/// The part of a cycle that it may lag by then: large swings lag twice as far, and lose a tenth.
const LAG: f64 = 0.045;

/// In steps beyond the longest, in s, hair that touches hair and bodies at once may tremble for ever; what needs steps below the shortest is hardly seen to swing.
const LONGEST_STEP: f64 = 1.0 / 48.0;
const SHORTEST_STEP: f64 = 1.0 / 144.0;

/// The section and substance of a strand.
///
/// Only two combinations matter to a strand that hangs by itself: the bending stiffness over the mass
/// per length, `E r^2 / (4 rho)` in m^4/s^2, and [`Self::twist_ratio`].
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// Young's modulus E in Pa, 1e-3 to 1e20. Hair: 3.9e9.
    pub young: f64,
    /// Stiffness against twisting over that against bending, GJ / EI: 1e-3 to 1e3. A round section of
    /// Poisson ratio 0.5 has 2/3.
    pub twist_ratio: f64,
    /// Density rho in kg/m^3, 1 to 1e5. Hair: 1300.
    pub density: f64,
    /// Radius r of the section in m, 1e-7 to 0.1. One hair: 4e-5; a strand that stands for a clump
    /// behaves as its hairs together, so it keeps their radius.
    pub radius: f64,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            young: 3.9e9,
            twist_ratio: 2.0 / 3.0,
            density: 1300.0,
            radius: 4e-5,
        }
    }
}

impl Material {
    /// Bending stiffness over mass per length, EI / (rho S), in m^4/s^2.
    #[must_use]
    pub fn bending(&self) -> f64 {
        self.young * self.radius * self.radius / (4.0 * self.density)
    }

    /// The material of which a strand of `length` metres has the given Gamma = rho g S L^3 / (E I), its weight
    /// against its stiffness: below 1 a bristle, about 10 short hair, 100 and more long hair.
    #[must_use]
    pub fn from_gamma(gamma: f64, length: f64) -> Self {
        let default = Self::default();
        let bending = GRAVITY * length * length * length / gamma;
        Self {
            young: 4.0 * default.density * bending / (default.radius * default.radius),
            ..default
        }
    }
}

/// A number that varies along a strand as the quadratic through three values.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Profile {
    /// At the root.
    pub root: f64,
    /// Half way.
    pub middle: f64,
    /// At the tip.
    pub tip: f64,
}

impl Profile {
    /// The same all along.
    #[must_use]
    pub const fn constant(value: f64) -> Self {
        Self {
            root: value,
            middle: value,
            tip: value,
        }
    }

    /// At `u` of the strand's length, 0 at the root to 1 at the tip; where the quadratic is below the
    /// least of its three values, that value.
    #[must_use]
    pub fn at(&self, u: f64) -> f64 {
        let linear = -3.0 * self.root + 4.0 * self.middle - self.tip;
        let square = 2.0 * self.root - 4.0 * self.middle + 2.0 * self.tip;
        let least = self.root.min(self.middle).min(self.tip);
        (self.root + u * (linear + u * square)).max(least)
    }
}

/// The shape that a strand would have by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Natural {
    /// The shape as it was styled, which gravity holds in balance: the style does not sag when the simulation
    /// starts. The moments that gravity makes are taken out of the rest curvature (Derouet-Jourdan et al.
    /// 2010, *Stable inverse dynamic curves*).
    #[default]
    Balanced,
    /// The shape as it was styled, without gravity: it sags.
    Styled,
    /// A helix of this curvature and torsion, whatever the styled shape is.
    Curl {
        /// Curvature in 1/m, 0 to 1e4: 1 / the radius of a flat curl.
        curvature: f64,
        /// Torsion in 1/m, -1e4 to 1e4: how fast the curl climbs.
        torsion: f64,
    },
}

/// Everything that decides how a strand moves.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Params {
    /// Substance and section.
    pub material: Material,
    /// A factor on the stiffness along the strand, 1e-9 to 1e9.
    pub stiffness: Profile,
    /// The rest shape.
    pub natural: Natural,
    /// Damping inside the strand in s, 0 to 10: the time in which bending relaxes by itself (Kelvin and
    /// Voigt). 0.005 takes the ringing out of short hair; 0 is undamped.
    pub damping: f64,
    /// Drag of the air across the strand in 1/s, 0 to 1e4: the rate at which a strand takes on the wind's speed.
    pub drag: f64,
    /// A factor on the drag along the strand, 0 to 1e4.
    pub drag_at: Profile,
    /// The share of the wind's speed that reaches it along the strand, 0 to 1e3: the rest is kept off by hair around it.
    pub wind: Profile,
    /// Drag along the strand over that across it, 0 to 1. A slender cylinder has 0.5.
    pub drag_along: f64,
    /// Pull of every particle towards its place in the goal shape, in 1/s^2, 0 to 1e9: acceleration per
    /// metre. It is damped critically.
    pub goal: Profile,
    /// Pull of every particle that has come to lie far from its place in the goal shape, such as on the other side of a shoulder, in m/s^2, 0 to 1e4, whatever
    /// the distance. It goes up and over what lies between, is damped, critically where it pulls in full, and fades where hair moves against the shape, and where air
    /// blows: what swings or streams is hardly pulled. What it pulls slides: friction counts for
    /// less, and for nothing where the pull is 30 m/s^2. What can't get back and doesn't rest gives up: a particle is recalled in full for 1.5 s of motion
    /// while its place, the air and all bodies hardly move, and no more after 4 s. What is recalled passes through locks.
    pub recall: f64,
    /// How far from its place a particle may lie without being recalled, in m, 1e-6 to 1e3; at twice that it is pulled in full.
    pub recall_from: f64,
    /// The distance in m that a strand keeps from colliders, 0 to 0.1.
    pub thickness: f64,
    /// Coulomb's coefficient of friction, 0 to 10.
    pub friction: f64,
    /// Half the thickness in m of the lock that a strand stands for, 0 to 0.1. Locks that are apart at rest don't pass through each other,
    /// but keep both radii between their strands; 0: they do. So does what is recalled, and a neighbour that has got onto the wrong side, but for strands with
    /// anchors. Where they jam, a strand that moves for 2 s while nothing else does begins to stick to the head, and comes to rest.
    pub lock_radius: f64,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            material: Material::default(),
            stiffness: Profile::constant(1.0),
            natural: Natural::Balanced,
            damping: 0.005,
            drag: 2.0,
            drag_at: Profile::constant(1.0),
            wind: Profile::constant(1.0),
            drag_along: 0.5,
            goal: Profile::constant(0.0),
            recall: 0.0,
            recall_from: 0.05,
            thickness: 1e-3,
            friction: 0.3,
            lock_radius: 0.0,
        }
    }
}

impl Params {
    pub(crate) fn has_goal(&self) -> bool {
        let Profile { root, middle, tip } = self.goal;
        [root, middle, tip, self.recall]
            .iter()
            .any(|pull| *pull > 0.0)
    }

    /// The longest step in s, 1/144 to 1/48, in which a strand of `length` metres, above 0, swings as in fine ones where gravity is
    /// `gravity` m/s^2: in two seconds, or as long as it swings at all, its first mode lags by no more than a twentieth of a cycle,
    /// unless that needs less than 1/144 s, as of stiff undamped hair shorter than some 0.1 m.
    ///
    /// That hangs on frequency and damping alone: TR-BDF2 lags by 0.04 radians times the cube of the angle that a mode goes through in a
    /// step. Its amplitude is off by less.
    ///
    /// # Panics
    ///
    /// When the length is not above 0, or a number not finite.
    #[must_use]
    pub fn longest_step(&self, length: f64, gravity: f64) -> f64 {
        assert!(
            length > 0.0 && length.is_finite() && gravity.is_finite(),
            "a strand of {length} m, gravity of {gravity} m/s^2"
        );
        // Of a strand that is clamped and hangs: Euler's beam and Bernoulli's chain, together within 2 % at any Gamma. The stiffness counts
        // where the mode bends, near the root; a goal where it moves, near the tip.
        let bending = self.material.bending() * self.stiffness.at(0.3);
        let bends = 12.36 * bending / length.powi(4);
        let goal = self.goal.at(0.8);
        let frequency = (1.53 * gravity.abs() / length + bends + goal).sqrt();
        let decay = 0.5 * (self.drag * self.drag_at.at(0.8) + self.damping * bends) + goal.sqrt();
        let swings = SWINGS.min(FADES / decay);
        if swings * frequency < CYCLES * TAU {
            return LONGEST_STEP;
        }
        let lag = LAG * TAU;
        let step = (lag / (0.0404 * frequency.powi(3) * swings)).sqrt();
        step.clamp(SHORTEST_STEP, LONGEST_STEP)
    }

    /// The first number that is out of its range, as (name, value, least, most).
    pub(crate) fn out_of_range(&self) -> Option<(&'static str, f64, f64, f64)> {
        let m = &self.material;
        let (curvature, torsion) = match self.natural {
            Natural::Curl { curvature, torsion } => (curvature, torsion),
            Natural::Balanced | Natural::Styled => (0.0, 0.0),
        };
        let profile = |p: &Profile, least, most| {
            [p.root, p.middle, p.tip]
                .into_iter()
                .find(|v| !(least..=most).contains(v))
                .unwrap_or(least)
        };
        [
            ("young", m.young, 1e-3, 1e20),
            ("twist_ratio", m.twist_ratio, 1e-3, 1e3),
            ("density", m.density, 1.0, 1e5),
            ("radius", m.radius, 1e-7, 0.1),
            ("stiffness", profile(&self.stiffness, 1e-9, 1e9), 1e-9, 1e9),
            ("curvature", curvature, 0.0, 1e4),
            ("torsion", torsion, -1e4, 1e4),
            ("damping", self.damping, 0.0, 10.0),
            ("drag", self.drag, 0.0, 1e4),
            ("drag_at", profile(&self.drag_at, 0.0, 1e4), 0.0, 1e4),
            ("wind", profile(&self.wind, 0.0, 1e3), 0.0, 1e3),
            ("drag_along", self.drag_along, 0.0, 1.0),
            ("goal", profile(&self.goal, 0.0, 1e9), 0.0, 1e9),
            ("recall", self.recall, 0.0, 1e4),
            ("recall_from", self.recall_from, 1e-6, 1e3),
            ("thickness", self.thickness, 0.0, 0.1),
            ("friction", self.friction, 0.0, 10.0),
            ("lock_radius", self.lock_radius, 0.0, 0.1),
        ]
        .into_iter()
        .find(|(_, value, least, most)| !(least..=most).contains(&value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_passes_through_its_values_and_not_below_them() {
        let p = Profile {
            root: 1.0,
            middle: 0.2,
            tip: 0.1,
        };
        assert_eq!(p.at(0.0), 1.0);
        assert!((p.at(0.5) - 0.2).abs() < 1e-15);
        assert!((p.at(1.0) - 0.1).abs() < 1e-15);
        assert!((0..=100).all(|i| p.at(f64::from(i) / 100.0) >= 0.1));
    }

    #[test]
    fn gamma_is_weight_against_stiffness() {
        let material = Material::from_gamma(10.0, 0.3);
        let gamma = GRAVITY * 0.3_f64.powi(3) / material.bending();
        assert!((gamma - 10.0).abs() < 1e-12);
        // A hair of 25 cm, radius 40 um: about 128 by its weight.
        let hair = GRAVITY * 0.25_f64.powi(3) / Material::default().bending();
        assert!((120.0..135.0).contains(&hair), "{hair}");
    }

    #[test]
    fn what_is_out_of_range_is_named() {
        let bad = Params {
            recall_from: 0.0,
            ..Params::default()
        };
        assert_eq!(bad.out_of_range().unwrap().0, "recall_from");
        assert_eq!(Params::default().out_of_range(), None);
        let bad = Params {
            damping: f64::NAN,
            ..Params::default()
        };
        assert_eq!(bad.out_of_range().unwrap().0, "damping");
        let bad = Params {
            goal: Profile {
                root: 0.0,
                middle: -1.0,
                tip: 0.0,
            },
            ..Params::default()
        };
        assert_eq!(bad.out_of_range().unwrap().1, -1.0);
    }
}
