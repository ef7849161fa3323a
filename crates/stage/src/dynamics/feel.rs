//! How hair feels: a preset's words and factors as physical numbers.

use super::section::{DynamicsSection, FeelChoice, ShapeChoice};
use effects::{Variation, layer_seed, strand_seed};
use hair_sim::{GRAVITY, Material, Mutual, Natural, Params, Profile};
use render::Head;
use std::f64::consts::TAU;

/// How the hair of a zone moves, beside what the look says of all hair.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ZoneDynamics {
    /// In place of the look's.
    pub feel: Option<FeelChoice>,
    /// Factors on the look's.
    pub stiffness: Variation,
    pub damping: f32,
    pub drag: Variation,
    pub hold: Variation,
    pub recall: f32,
    pub wind: Variation,
    pub locks: f32,
}

impl Default for ZoneDynamics {
    fn default() -> Self {
        let same = || Variation::constant(1.0);
        Self {
            feel: None,
            stiffness: same(),
            damping: 1.0,
            drag: same(),
            hold: same(),
            recall: 1.0,
            wind: same(),
            locks: 1.0,
        }
    }
}

impl ZoneDynamics {
    /// Its factors, by name, on what the look doesn't have unless it says so, and hasn't.
    pub fn idle(&self, look: &DynamicsSection) -> impl Iterator<Item = &'static str> {
        let factors = [
            ("recall", self.recall, look.recall),
            ("locks", self.locks, look.locks),
        ];
        // A factor of 0 says that its hair has none, whatever the look.
        let is_idle =
            |(_, own, of_look): &(_, f32, f32)| *of_look == 0.0 && ![0.0, 1.0].contains(own);
        factors.into_iter().filter(is_idle).map(|(name, ..)| name)
    }
}

/// What a word means.
///
/// Stiffness is told by the weight of the hair against it, Gamma = rho g S L^3 / (E I), so that short and
/// long clumps of a style are alike: a drawn clump holds its arch, as no single hair of its length would.
struct Word {
    gamma: f64,
    /// Damping in the hair, s.
    damping: f64,
    /// Drag of the air, 1/s.
    drag: f64,
    /// Pull back to the style at root, middle and tip, 1/s^2.
    hold: [f64; 3],
}

/// Stiffness at root, middle and tip, as factors: a clump is thickest near its root.
const ALONG: Profile = Profile {
    root: 6.0,
    middle: 1.0,
    tip: 0.4,
};

impl FeelChoice {
    fn word(self) -> Word {
        match self {
            Self::Limp => Word {
                gamma: 150.0,
                damping: 0.01,
                drag: 1.0,
                hold: [10.0, 0.0, 0.0],
            },
            Self::Soft => Word {
                gamma: 25.0,
                damping: 0.02,
                drag: 1.6,
                hold: [40.0, 4.0, 0.0],
            },
            Self::Springy => Word {
                gamma: 8.0,
                damping: 0.01,
                drag: 1.6,
                hold: [80.0, 25.0, 8.0],
            },
            Self::Stiff => Word {
                gamma: 1.5,
                damping: 0.03,
                drag: 2.0,
                hold: [250.0, 120.0, 60.0],
            },
            Self::Gel => Word {
                gamma: 0.1,
                damping: 0.05,
                drag: 2.5,
                hold: [4000.0, 3000.0, 2000.0],
            },
        }
    }
}

/// How clumps hold and push each other: lengths in head heights, stiffness in 1/s^2.
const NEIGHBOURS: usize = 4;
const LINK: f64 = 40.0;
const REACH: f64 = 0.12;
const BREAK_AT: f64 = 0.1;
const REPULSION: f64 = 200.0;
const APART: f64 = 0.06;

fn links_and_volume(section: &DynamicsSection) -> [f64; 2] {
    [section.links, section.volume].map(|given| f64::from(given.unwrap_or(1.0)))
}

/// How clumps act on each other on a head; nothing where they don't.
pub(crate) fn mutual(section: &DynamicsSection, head: Head) -> Option<Mutual> {
    let [links, volume] = links_and_volume(section);
    let height_m = f64::from(head.height_m);
    (links > 0.0 || volume > 0.0).then_some(Mutual {
        neighbours: NEIGHBOURS,
        link: LINK * links,
        reach: REACH * height_m,
        break_at: BREAK_AT * height_m,
        mends: true,
        repulsion: REPULSION * volume,
        distance: APART * height_m,
    })
}

/// The solver's parameters, but for what a strand's size and zone decide.
pub(crate) struct Feel {
    params: Params,
    section: DynamicsSection,
    /// The pull to key shapes, in place of the word's.
    hold: Option<[f64; 3]>,
    /// The distance from the skin in metres, for a size of 1.
    distance: f64,
    /// The radius in metres by which locks keep apart, for a size of 1.
    lock_radius: f64,
    seed: u32,
}

/// A strand whose parameters are asked for.
#[derive(Clone, Copy)]
pub(crate) struct Strand<'a> {
    pub id: u32,
    /// In 1/300 head heights.
    pub size: f32,
    pub length_m: f64,
    pub zone: Option<&'a ZoneDynamics>,
}

impl Feel {
    /// The section `dynamics` on a head; `hold` is in place of the word's where hair has key shapes. What varies from strand to strand
    /// hangs on the seed.
    pub fn new(section: &DynamicsSection, head: Head, hold: Option<[f64; 3]>, seed: u32) -> Self {
        let radius = f64::from(section.curl_radius) * f64::from(head.height_m);
        let climb = f64::from(section.curl_pitch) * f64::from(head.height_m) / TAU;
        let helix = radius * radius + climb * climb;
        Self {
            params: Params {
                natural: match section.shape {
                    ShapeChoice::Styled => Natural::Balanced,
                    ShapeChoice::Sagging => Natural::Styled,
                    ShapeChoice::Curl => Natural::Curl {
                        curvature: radius / helix,
                        torsion: climb / helix,
                    },
                    ShapeChoice::Straight => Natural::Curl {
                        curvature: 0.0,
                        torsion: 0.0,
                    },
                },
                friction: f64::from(section.friction),
                recall: f64::from(section.recall) * GRAVITY,
                recall_from: f64::from(section.recall_from) * f64::from(head.height_m),
                ..Params::default()
            },
            hold,
            distance: f64::from(section.distance) * f64::from(head.unit_m()),
            lock_radius: f64::from(section.locks) * f64::from(head.unit_m()),
            section: section.clone(),
            seed,
        }
    }

    /// The parameters of a strand.
    pub fn params(&self, strand: Strand) -> Params {
        let own = |name: &str| strand_seed(layer_seed(self.seed, name), strand.id);
        let section = &self.section;
        let zone = |of: fn(&ZoneDynamics) -> &Variation| strand.zone.map(of);
        let stiffness = Factor::new(&section.stiffness, own("dynamics.stiffness"))
            .times(zone(|zone| &zone.stiffness), own("zones.stiffness"));
        let drag = Factor::new(&section.drag, own("dynamics.drag"))
            .times(zone(|zone| &zone.drag), own("zones.drag"));
        let hold = Factor::new(&section.hold, own("dynamics.hold"))
            .times(zone(|zone| &zone.hold), own("zones.hold"));
        let wind = Factor::new(&section.wind, own("dynamics.wind"))
            .times(zone(|zone| &zone.wind), own("zones.wind"));
        let number =
            |of: fn(&ZoneDynamics) -> f32| strand.zone.map_or(1.0, |zone| f64::from(of(zone)));
        let damping = f64::from(section.damping.unwrap_or(1.0)) * number(|zone| zone.damping);
        let least_damping = match links_and_volume(section) {
            [0.0, 0.0] => 0.0,
            _ => LEAST_DAMPING,
        };
        let feel = strand.zone.and_then(|zone| zone.feel);
        let word = feel.unwrap_or(section.feel).word();
        let [root, middle, tip] = self.hold.unwrap_or(word.hold);
        let gamma = word.gamma / stiffness.whole.max(LEAST_STIFFNESS);
        Params {
            material: Material::from_gamma(gamma, strand.length_m.clamp(1e-4, LONGEST_M)),
            stiffness: stiffness.along(ALONG, LEAST_STIFFNESS),
            damping: (word.damping * damping).clamp(least_damping, 10.0),
            drag: word.drag * drag.whole,
            drag_at: drag.along(Profile::constant(1.0), 0.0),
            wind: wind.all_along(Profile::constant(1.0)),
            goal: hold.all_along(Profile { root, middle, tip }),
            recall: (self.params.recall * number(|zone| zone.recall)).min(1e4),
            thickness: (self.distance * f64::from(strand.size)).clamp(1e-4, 0.1),
            lock_radius: (self.lock_radius * f64::from(strand.size) * number(|zone| zone.locks))
                .min(0.1),
            ..self.params
        }
    }
}

/// The longest hair that is as stiff for its length as its feel says, m: what is longer has hardly the unit that it should have, and the stiffness
/// that it would need is no number to solve for.
const LONGEST_M: f64 = 20.0;

/// The least damping of hair that holds and pushes each other, s. What a strand does to another it isn't done in return, and in undamped hair at rest that made locks
/// swing more and more, or for ever: 1 ms is too little for `long-pink`.
const LEAST_DAMPING: f64 = 2e-3;

/// The least factor on a stiffness: one that differs from strand to strand may come to nothing.
const LEAST_STIFFNESS: f64 = 0.001;

/// A factor of one strand: of all of it, and on top of that at root, middle and tip.
struct Factor {
    whole: f64,
    at: [f64; 3],
}

impl Factor {
    fn new(variation: &Variation, seed: u32) -> Self {
        match variation.as_constant() {
            Some(value) => Self {
                whole: f64::from(value),
                at: [1.0; 3],
            },
            None => Self {
                whole: 1.0,
                at: values(variation, seed),
            },
        }
    }

    /// The same times that of a zone.
    fn times(mut self, zone: Option<&Variation>, seed: u32) -> Self {
        if let Some(zone) = zone {
            for (own, zone) in self.at.iter_mut().zip(values(zone, seed)) {
                *own *= zone;
            }
        }
        self
    }

    /// A profile times what is along the strand.
    fn along(&self, profile: Profile, least: f64) -> Profile {
        let [root, middle, tip] = self.at.map(|factor| factor.max(least));
        Profile {
            root: profile.root * root,
            middle: profile.middle * middle,
            tip: profile.tip * tip,
        }
    }

    /// A profile times all of the factor.
    fn all_along(&self, profile: Profile) -> Profile {
        let whole = Profile {
            root: profile.root * self.whole,
            middle: profile.middle * self.whole,
            tip: profile.tip * self.whole,
        };
        self.along(whole, 0.0)
    }
}

/// A variation at root, middle and tip of the strand with this seed.
fn values(variation: &Variation, seed: u32) -> [f64; 3] {
    // From -1 to 1.
    let own = f64::from(seed) / f64::from(u32::MAX) * 2.0 - 1.0;
    let factor = 1.0 + f64::from(variation.vary) * own;
    [0.0, 0.5, 1.0].map(|u| f64::from(variation.at(u)) * factor)
}
