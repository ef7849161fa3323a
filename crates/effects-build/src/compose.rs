//! The text that naga sees: the author's source first, so that lines and columns are the author's own,
//! then the declared inputs, then the prelude. WGSL does not care about order.

use crate::{BuildError, PRELUDE};
use std::fmt::Write as _;

/// Something a joint offers. What an effect does not declare is not there.
pub struct Input {
    /// The field's name in WGSL and in `effects::Joints`.
    pub name: &'static str,
    /// Its WGSL type.
    pub wgsl_type: &'static str,
    /// Whether it is there before the clump is worked out.
    pub before_clump: bool,
    /// Whether it is there for effects.
    pub for_effects: bool,
    /// What it is, with its unit.
    pub doc: &'static str,
}

const fn input(
    name: &'static str,
    wgsl_type: &'static str,
    before_clump: bool,
    for_effects: bool,
    doc: &'static str,
) -> Input {
    Input {
        name,
        wgsl_type,
        before_clump,
        for_effects,
        doc,
    }
}

/// All inputs, in the order in which they stand in `struct Inputs`.
#[rustfmt::skip]
pub const INPUTS: &[Input] = &[
    input("position", "vec3<f32>", true, true, "place in the world, metres"),
    input("forward", "vec3<f32>", true, true, "unit vector to the next joint; at the tip that of the joint before"),
    input("backward", "vec3<f32>", true, true, "unit vector to the joint before (B in 5.4); at the root that of the next joint"),
    input("u", "f32", true, true, "place along the strand, 0 at the root, 1 at the tip"),
    input("arc_length", "f32", true, true, "length of the strand up to here, metres"),
    input("strand", "u32", true, true, "the strand's stable id"),
    input("seed", "u32", true, true, "for `random`: a hash of style seed, layer name and strand"),
    input("strand_mean", "vec3<f32>", true, false, "mean of the strand's particles, metres (c_mean in 5.4)"),
    input("head_center", "vec3<f32>", true, false, "centre of the head, metres (c_head in 5.4)"),
    input("head_height", "f32", true, false, "height of the head, metres"),
    input("strand_size", "f32", true, false, "the strand's full size, 1/300 of the head's height"),
    input("light_direction", "vec3<f32>", true, true, "unit vector to the light"),
    input("light_distance", "f32", true, true, "distance to the light, head heights; 1e6 for a direction"),
    input("view_direction", "vec3<f32>", true, true, "unit vector to the eye"),
    input("across", "vec2<f32>", true, true, "unit vector across the path on the screen (x right, y down)"),
    input("material_normal", "vec3<f32>", true, true, "unit vector across the strand that turns as it twists, outwards at rest; cross(forward, it) is the binormal"),
    input("unit", "f32", false, true, "one unit of the layer's widths in 1/300 of the head's height: 1, or a pixel's size at 720 lines"),
    input("normal", "vec3<f32>", false, true, "the clump's unit normal (5.4)"),
    input("clump_radius", "f32", false, true, "the clump's radius, 1/300 of the head's height (5.3)"),
    input("clump_color", "vec3<f32>", false, true, "the clump's basic colour, linear"),
    input("clump_shift", "vec2<f32>", false, true, "how far the clump's strokes are moved on the screen (x right, y down), away from its outer end, 1/300 of the head's height; 0 but where a flat clump points to or from the eye"),
    input("gray", "f32", false, true, "max(light . normal, 0)"),
];

/// What the source is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Entry {
    /// `fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke`
    Effect,
    /// `fn clump(joint: Inputs, params: Params) -> Clump`
    Clump,
}

impl Entry {
    fn offers(self, input: &Input) -> bool {
        match self {
            Self::Effect => input.for_effects,
            Self::Clump => input.before_clump,
        }
    }
}

/// A composed source.
pub(crate) struct Source {
    /// The author's file, for messages.
    pub path: String,
    /// The author's text, then ours.
    pub text: String,
    /// The declared inputs, in the order of [`INPUTS`].
    pub inputs: Vec<&'static Input>,
}

pub(crate) fn compose(author: &str, path: &str, entry: Entry) -> Result<Source, BuildError> {
    let inputs = declared_inputs(author, path, entry)?;
    let mut text = String::from(author);
    text.push_str("\nstruct Inputs {\n");
    for input in &inputs {
        let _ = writeln!(text, "    {}: {},", input.name, input.wgsl_type);
    }
    text.push_str("}\n");
    text.push_str(PRELUDE);
    Ok(Source {
        path: path.to_owned(),
        text,
        inputs,
    })
}

/// The inputs named by the author's line `//! inputs: a, b`.
fn declared_inputs(
    author: &str,
    path: &str,
    entry: Entry,
) -> Result<Vec<&'static Input>, BuildError> {
    let declaration = author.lines().enumerate().find_map(|(number, line)| {
        let names = line
            .trim_start()
            .strip_prefix("//!")?
            .trim_start()
            .strip_prefix("inputs:")?;
        Some((number + 1, line, names))
    });
    let offered = || INPUTS.iter().filter(|input| entry.offers(input));
    let all_names = || {
        offered()
            .map(|input| input.name)
            .collect::<Vec<_>>()
            .join(", ")
    };
    let Some((line_number, line, names)) = declaration else {
        return Err(BuildError(format!(
            "{path}:1:1: the first line must declare what is read of a joint, such as \
             `//! inputs: clump_radius, clump_color`; there are: {}",
            all_names()
        )));
    };
    let names: Vec<&str> = names.split(',').map(str::trim).collect();
    for name in &names {
        if !offered().any(|input| input.name == *name) {
            let column = line.find(name).unwrap_or(0) + 1;
            return Err(BuildError(format!(
                "{path}:{line_number}:{column}: there is no input `{name}`; there are: {}",
                all_names()
            )));
        }
    }
    Ok(offered()
        .filter(|input| names.contains(&input.name))
        .collect())
}
