//! The sections of presets: their parameters.

use super::VERSION;
use crate::dynamics::feel::DYNAMICS;
use crate::table::{choice, color, number, param};
use effects::{Param, ParamKind, Parameters, clump};

/// The section `hair`.
pub const HAIR: &[Param] = &[
    param(
        "file",
        "Strands to draw, relative to the preset: .tfx, .strands.ron or .style.ron.",
        ParamKind::Text,
    ),
    param(
        "guides",
        "How many strands to keep, those that stand best for all; 0 keeps all.",
        ParamKind::Integer {
            min: 0,
            max: 1_000_000,
            default: 0,
        },
    ),
    param(
        "bake",
        "Motion of this hair that `inkstrand simulate` has written, relative to the preset.",
        ParamKind::Text,
    ),
    choice("up", "The file's upward axis.", &["guess", "y", "z"], 0),
    number(
        "scale",
        "Metres in one unit of the file; 0 guesses.",
        "m",
        0.0..=1e4,
        0.0,
    ),
    number(
        "size",
        "Clump size of strands that bring none; 0 takes it from the spacing of the roots.",
        "1/300 head height",
        0.0..=300.0,
        0.0,
    ),
];

/// The section `head`.
pub const HEAD: &[Param] = &[
    param(
        "file",
        "The head, relative to the preset: .obj.",
        ParamKind::Text,
    ),
    choice(
        "shape",
        "The head where no file is named: none, or the bust that comes with inkstrand.",
        &["none", "bust"],
        0,
    ),
    choice("up", "The file's upward axis.", &["guess", "y", "z"], 0),
    number(
        "scale",
        "Metres in one unit of the file; 0 guesses.",
        "m",
        0.0..=1e4,
        0.0,
    ),
    color("light", "Colour of the lit side.", "F8DCC8"),
    color(
        "shadow",
        "Colour of the side away from the light.",
        "E3B49C",
    ),
    color("line", "Colour of the outline.", "6B4438"),
    color("iris", "Colour of the bust's eyes.", "3A9CA6"),
    color(
        "iris_shadow",
        "Colour of the pupils and of the irises under the lids.",
        "1B4F5C",
    ),
    color("tie", "Colour of ties in the hair.", "F0F0F5"),
    color(
        "tie_shadow",
        "Colour of ties away from the light.",
        "B8B8CC",
    ),
    number(
        "scalp",
        "How far around roots the head has the hair's basic colour, so that gaps between clumps are no bald spots; 0 is nowhere. Hair styles that have an undercoat don't need it.",
        "head heights",
        0.0..=1.0,
        0.05,
    ),
    number(
        "width",
        "Width of the outline; 0 is none.",
        "1/300 head height",
        0.0..=50.0,
        1.6,
    ),
    number(
        "threshold",
        "Where light turns to shadow: the cosine to the light.",
        "",
        -1.0..=1.0,
        0.1,
    ),
];

/// The section `scene`.
pub const SCENE: &[Param] = &[
    param(
        "size",
        "Width and height of the picture.",
        ParamKind::Size {
            min: 1,
            max: 16_384,
            default: [960, 720],
        },
    ),
    param(
        "samples",
        "Samples a pixel.",
        ParamKind::Integer {
            min: 1,
            max: 256,
            default: 16,
        },
    ),
    param(
        "background",
        "Colour behind everything, or none for a transparent picture.",
        ParamKind::OptionalColor {
            default: Some("FFFFFF"),
        },
    ),
    number("fps", "Frames a second.", "1/s", 1.0..=1000.0, 24.0),
    choice(
        "order",
        "Within a strand by rank, then by depth, of round clumps or of flat ones; or every stroke by its shifted depth. `scattered`, as older presets say, is drawn as `rounded`.",
        &["rounded", "scattered", "strand_first", "shifted"],
        0,
    ),
    number(
        "edge_depth",
        "How much deeper than its middle a round clump's edge lies.",
        "head heights",
        0.0..=1.0,
        0.02,
    ),
];

/// The section `camera`.
pub const CAMERA: &[Param] = &[
    number(
        "yaw",
        "0 looks at the face; positive moves to the viewer's right.",
        "degrees",
        -360.0..=360.0,
        0.0,
    ),
    number(
        "pitch",
        "Positive looks from above.",
        "degrees",
        -90.0..=90.0,
        0.0,
    ),
    number(
        "distance",
        "From the target to the eye.",
        "head heights",
        0.01..=1000.0,
        4.48,
    ),
    number(
        "fov",
        "Vertical field of view.",
        "degrees",
        1.0..=150.0,
        30.0,
    ),
    Param {
        name: "target",
        doc: "What the camera looks at, from the head's centre.",
        unit: "head heights",
        kind: ParamKind::Triple {
            min: -1000.0,
            max: 1000.0,
            default: [0.0; 3],
        },
    },
];

/// The section `light`.
pub const LIGHT: &[Param] = &[
    choice(
        "kind",
        "A light from far away, or one at a place.",
        &["direction", "point"],
        0,
    ),
    choice(
        "fixed_to",
        "What the light turns with.",
        &["world", "camera"],
        0,
    ),
    number(
        "yaw",
        "0 shines at the face; positive comes from the viewer's right.",
        "degrees",
        -360.0..=360.0,
        35.0,
    ),
    number(
        "pitch",
        "Positive shines from above.",
        "degrees",
        -90.0..=90.0,
        40.0,
    ),
    number(
        "distance",
        "A point light's distance from the head's centre.",
        "head heights",
        0.01..=1000.0,
        3.0,
    ),
];

/// The section `motion`.
pub const MOTION: &[Param] = &[
    param(
        "file",
        "How head, wind and hair move, relative to the preset: .motion.ron.",
        ParamKind::Text,
    ),
    param(
        "gltf",
        "A character whose animation moves the head, relative to the preset: .glb, .gltf or .vrm. The \
         script's moves come on top.",
        ParamKind::Text,
    ),
    param(
        "bone",
        "The character's bone that the head follows; \"head\" without it.",
        ParamKind::Text,
    ),
    param(
        "animation",
        "The character's animation, by its name or its number, 0 first; the first without it.",
        ParamKind::Text,
    ),
    choice(
        "repeat",
        "Whether the character's animation starts again at its end.",
        &["false", "true"],
        0,
    ),
];

/// The section `path`.
pub const PATH: &[Param] = &[
    choice(
        "kind",
        "How particles are joined.",
        &["linear", "catmull_rom"],
        1,
    ),
    param(
        "subdivision",
        "Joints from one particle to the next.",
        ParamKind::Integer {
            min: 1,
            max: 64,
            default: 4,
        },
    ),
    choice(
        "brush",
        "What is put down along a path: a circle, which ends round, or the half of it behind its centre, which ends flat.",
        &["circle", "semicircle"],
        0,
    ),
];

/// A preset's sections by name, with what each is about. `clump` and `layers` come from effects.
pub const SECTIONS: &[(&str, &str, &[Param])] = &[
    ("hair", "Which strands are drawn.", HAIR),
    ("head", "The head under the hair, and its colours.", HEAD),
    (
        "scene",
        "The picture: size, samples, background, frame rate.",
        SCENE,
    ),
    ("camera", "From where it is seen.", CAMERA),
    ("light", "Where the light comes from.", LIGHT),
    ("motion", "How head, wind and hair move.", MOTION),
    (
        "dynamics",
        "How hair swings, bends and returns to its style.",
        DYNAMICS,
    ),
    ("path", "How a strand becomes a stroke's path.", PATH),
    (
        "clump",
        "What all layers share of a strand: size, normal, basic colour.",
        clump::Program::PARAMS,
    ),
];

/// What stands in a preset beside its sections and layers.
pub const TOP: &[Param] = &[
    param(
        "version",
        "Version of the preset's format.",
        ParamKind::Integer {
            min: 1,
            max: VERSION,
            default: VERSION,
        },
    ),
    param(
        "seed",
        "Seed of all variations.",
        ParamKind::Integer {
            min: 0,
            max: i32::MAX,
            default: 1,
        },
    ),
];
