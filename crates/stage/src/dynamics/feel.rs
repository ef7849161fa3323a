//! How hair feels: a preset's words and factors as physical numbers.

use crate::table::{choice, number, param};
use effects::{Param, ParamKind, Values};
use hair_sim::{Material, Mutual, Natural, Params, Profile};
use render::Head;
use std::f64::consts::TAU;

/// Steps within a step of the solvers that take some, where the preset says nothing.
const XPBD_SUBSTEPS: u32 = 64;
const MASS_SPRING_SUBSTEPS: u32 = 4;

/// The section `dynamics`.
pub const DYNAMICS: &[Param] = &[
    choice(
        "solver",
        "rods: strands bend and twist as elastic rods; for comparison, slower, and without damping, links \
         and volume, xpbd: softer rods by position based dynamics, and mass_spring: trusses of springs; \
         none: hair turns with the head.",
        &["rods", "xpbd", "mass_spring", "none"],
        0,
    ),
    choice(
        "feel",
        "What the hair is like; the factors below change it.",
        &["limp", "soft", "springy", "stiff", "gel"],
        1,
    ),
    number(
        "stiffness",
        "Factor on the stiffness against bending and twisting.",
        "",
        0.001..=1000.0,
        1.0,
    ),
    number(
        "damping",
        "Factor on how soon swinging dies down in the hair itself.",
        "",
        0.0..=100.0,
        1.0,
    ),
    number(
        "drag",
        "Factor on the drag of the air, and so on the pull of the wind.",
        "",
        0.0..=100.0,
        1.0,
    ),
    number(
        "hold",
        "Factor on the pull back to the style, or to the script's `shapes`.",
        "",
        0.0..=100.0,
        1.0,
    ),
    number(
        "links",
        "Factor on the links that hold neighbouring clumps together until they are pulled apart; 0 has none.",
        "",
        0.0..=100.0,
        1.0,
    ),
    number(
        "volume",
        "Factor on how clumps keep each other at a distance; 0: they pass through each other.",
        "",
        0.0..=100.0,
        1.0,
    ),
    number("gravity", "Factor on gravity.", "", -10.0..=10.0, 1.0),
    number(
        "friction",
        "Friction on head and shoulders.",
        "",
        0.0..=10.0,
        0.3,
    ),
    number(
        "distance",
        "How far a clump's middle line stays from the skin, in its radii.",
        "",
        0.0..=2.0,
        0.5,
    ),
    choice(
        "shape",
        "What shape hair returns to: styled holds the style against gravity, sagging lets gravity pull it \
         down, curl winds it by curl_radius and curl_pitch, straight has no curl at all, and is the fastest for limp and springy \
         hair with damping of 0.5 or less.",
        &["styled", "sagging", "curl", "straight"],
        0,
    ),
    number(
        "curl_radius",
        "Radius of the curls of shape: curl.",
        "head heights",
        0.001..=10.0,
        0.05,
    ),
    number(
        "curl_pitch",
        "How far one turn of a curl climbs; below 0 it winds the other way.",
        "head heights",
        -10.0..=10.0,
        0.2,
    ),
    number(
        "step",
        "Time of a step of the simulation; 0 is a frame's.",
        "s",
        0.0..=0.1,
        0.0,
    ),
    param(
        "substeps",
        "Steps within a step, of solver: xpbd, where fewer make hair softer, and of mass_spring, where fewer \
         make it swing less; 0 is 64 of xpbd's and 4 of mass_spring's.",
        ParamKind::Integer {
            min: 0,
            max: 1000,
            default: 0,
        },
    ),
    number(
        "warm_up",
        "Time that is simulated before the first frame.",
        "s",
        0.0..=600.0,
        0.0,
    ),
    param(
        "guides",
        "Most strands that are simulated; the others are carried by those near them.",
        ParamKind::Integer {
            min: 1,
            max: 100_000,
            default: 600,
        },
    ),
];

/// What moves the hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SolverKind {
    Rods,
    /// With so many steps within a step.
    Xpbd(u32),
    MassSpring(u32),
    None,
}

impl SolverKind {
    /// The preset's choice.
    pub fn of(values: &Values) -> Self {
        let substeps = |own: u32| match values.integer("substeps").unsigned_abs() {
            0 => own,
            given => given,
        };
        match values.choice("solver") {
            0 => Self::Rods,
            1 => Self::Xpbd(substeps(XPBD_SUBSTEPS)),
            2 => Self::MassSpring(substeps(MASS_SPRING_SUBSTEPS)),
            _ => Self::None,
        }
    }
}

/// What the preset says of dynamics that its solver cannot do: a parameter, and why.
pub(crate) fn unsupported(values: &Values) -> Option<(&'static str, String)> {
    let asks = |name: &&str| values.is_given(name) && values.number(name) > 0.0;
    match SolverKind::of(values) {
        solver @ (SolverKind::Xpbd(_) | SolverKind::MassSpring(_)) => {
            let name = ["damping", "links", "volume"].into_iter().find(asks)?;
            let solver = match solver {
                SolverKind::Xpbd(_) => "xpbd",
                _ => "mass_spring",
            };
            Some((
                name,
                format!("{name}: solver: {solver} has none; leave it out, or take solver: rods"),
            ))
        }
        SolverKind::Rods if values.integer("substeps") != 0 => Some((
            "substeps",
            "substeps: solver: rods takes a step as one; leave it out, or set `step`".to_owned(),
        )),
        SolverKind::Rods | SolverKind::None => None,
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

const WORDS: [Word; 5] = [
    // limp
    Word {
        gamma: 150.0,
        damping: 0.01,
        drag: 1.0,
        hold: [10.0, 0.0, 0.0],
    },
    // soft
    Word {
        gamma: 25.0,
        damping: 0.02,
        drag: 1.6,
        hold: [40.0, 4.0, 0.0],
    },
    // springy
    Word {
        gamma: 8.0,
        damping: 0.01,
        drag: 1.6,
        hold: [80.0, 25.0, 8.0],
    },
    // stiff
    Word {
        gamma: 1.5,
        damping: 0.03,
        drag: 2.0,
        hold: [250.0, 120.0, 60.0],
    },
    // gel
    Word {
        gamma: 0.1,
        damping: 0.05,
        drag: 2.5,
        hold: [4000.0, 3000.0, 2000.0],
    },
];

/// How clumps hold and push each other: lengths in head heights, stiffness in 1/s^2.
const NEIGHBOURS: usize = 4;
const LINK: f64 = 40.0;
const REACH: f64 = 0.12;
const BREAK_AT: f64 = 0.1;
const REPULSION: f64 = 200.0;
const APART: f64 = 0.06;

/// How clumps act on each other on a head; nothing where they don't.
pub(crate) fn mutual(values: &Values, head: Head) -> Option<Mutual> {
    let number = |name| f64::from(values.number(name));
    let (links, volume) = (number("links"), number("volume"));
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
    pub fn new(values: &Values, head: Head, hold: Option<[f64; 3]>) -> Self {
        let number = |name| f64::from(values.number(name));
        let word = &WORDS[values.choice("feel") as usize];
        let hold = hold.unwrap_or(word.hold).map(|pull| pull * number("hold"));
        let radius = number("curl_radius") * f64::from(head.height_m);
        let climb = number("curl_pitch") * f64::from(head.height_m) / TAU;
        let helix = radius * radius + climb * climb;
        Self {
            params: Params {
                stiffness: ALONG,
                natural: match values.choice("shape") {
                    0 => Natural::Balanced,
                    1 => Natural::Styled,
                    2 => Natural::Curl {
                        curvature: radius / helix,
                        torsion: climb / helix,
                    },
                    _ => Natural::Curl {
                        curvature: 0.0,
                        torsion: 0.0,
                    },
                },
                damping: (word.damping * number("damping")).min(10.0),
                drag: word.drag * number("drag"),
                goal: Profile {
                    root: hold[0],
                    middle: hold[1],
                    tip: hold[2],
                },
                friction: number("friction"),
                ..Params::default()
            },
            gamma: word.gamma / number("stiffness"),
            distance: number("distance") * f64::from(head.unit_m()),
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
