//! How hair feels: a preset's words and factors as physical numbers.

use super::section::{DynamicsSection, FeelChoice, ShapeChoice};
use hair_sim::{Material, Mutual, Natural, Params, Profile};
use render::Head;
use std::f64::consts::TAU;

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

/// How clumps act on each other on a head; nothing where they don't.
pub(crate) fn mutual(section: &DynamicsSection, head: Head) -> Option<Mutual> {
    let factor = |given: Option<f32>| f64::from(given.unwrap_or(1.0));
    let (links, volume) = (factor(section.links), factor(section.volume));
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

/// The solver's parameters, but for what a strand's size decides.
pub(crate) struct Feel {
    params: Params,
    /// Weight against stiffness.
    gamma: f64,
    /// The distance from the skin in metres, for a size of 1.
    distance: f64,
}

impl Feel {
    /// The section `dynamics` on a head; `hold` is in place of the word's where hair has key shapes.
    pub fn new(section: &DynamicsSection, head: Head, hold: Option<[f64; 3]>) -> Self {
        let word = section.feel.word();
        let hold = hold.unwrap_or(word.hold);
        let hold = hold.map(|pull| pull * f64::from(section.hold));
        let radius = f64::from(section.curl_radius) * f64::from(head.height_m);
        let climb = f64::from(section.curl_pitch) * f64::from(head.height_m) / TAU;
        let helix = radius * radius + climb * climb;
        let damping = f64::from(section.damping.unwrap_or(1.0));
        Self {
            params: Params {
                stiffness: ALONG,
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
                damping: (word.damping * damping).min(10.0),
                drag: word.drag * f64::from(section.drag),
                goal: Profile {
                    root: hold[0],
                    middle: hold[1],
                    tip: hold[2],
                },
                friction: f64::from(section.friction),
                ..Params::default()
            },
            gamma: word.gamma / f64::from(section.stiffness),
            distance: f64::from(section.distance) * f64::from(head.unit_m()),
        }
    }

    /// The parameters of a strand of this size (1/300 head heights) and length (metres).
    pub fn params(&self, size: f32, length_m: f64) -> Params {
        Params {
            material: Material::from_gamma(self.gamma, length_m.max(1e-4)),
            thickness: (self.distance * f64::from(size)).clamp(1e-4, 0.1),
            ..self.params
        }
    }
}
