//! The text of a compute shader that runs an effect, or the clump, at every joint.

use super::layout::JointLayout;
use effects::{ParamKind, ProgramSource};
use std::fmt::Write as _;

const FRAME: &str = include_str!("../../../../shaders/gpu/frame.wgsl");
const JOINT: &str = include_str!("../../../../shaders/gpu/joint.wgsl");
const PRELUDE: &str = include_str!("../../../../shaders/prelude.wgsl");
const CLUMP_MAIN: &str = include_str!("../../../../shaders/gpu/clump_main.wgsl");
const STROKE_MAIN: &str = include_str!("../../../../shaders/gpu/stroke_main.wgsl");
const SMOOTH: &str = include_str!("../../../../shaders/gpu/smooth.wgsl");
const DRAWN: &str = include_str!("../../../../shaders/gpu/drawn.wgsl");
const BINS: &str = include_str!("../../../../shaders/gpu/bins.wgsl");
const SWEEP: &str = include_str!("../../../../shaders/gpu/sweep.wgsl");
const COMPOSE: &str = include_str!("../../../../shaders/gpu/compose.wgsl");
const COMPOSE_SAMPLES: &str = include_str!("../../../../shaders/gpu/compose_samples.wgsl");
const COMPOSE_MEAN: &str = include_str!("../../../../shaders/gpu/compose_mean.wgsl");
const SEGMENTS: &str = include_str!("../../../../shaders/gpu/segments.wgsl");
const SURFACES: &str = include_str!("../../../../shaders/gpu/surfaces.wgsl");
const STRANDS: &str = include_str!("../../../../shaders/gpu/strands.wgsl");
const TILES: &str = include_str!("../../../../shaders/gpu/tiles.wgsl");

/// Words before the parameters of a layer or a clump: `shaders/gpu/joint.wgsl` names them.
pub(super) const LAYER_WORDS: u32 = 13;

/// The clump's shader.
pub(super) fn clump(source: &ProgramSource, layout: &JointLayout) -> String {
    [
        source.wgsl,
        FRAME,
        &layout.constants(),
        JOINT,
        &gather(source, layout),
        CLUMP_MAIN,
    ]
    .join("\n")
}

/// A layer's shader.
pub(super) fn strokes(source: &ProgramSource, layout: &JointLayout) -> String {
    [
        source.wgsl,
        FRAME,
        &layout.constants(),
        JOINT,
        &gather(source, layout),
        STROKE_MAIN,
    ]
    .join("\n")
}

/// What smooths layers: entry points `find_gaps`, `close_gaps`, `find_specks` and `open_specks`, in that order.
pub(super) fn smooth(layout: &JointLayout) -> String {
    [PRELUDE, FRAME, &layout.constants(), JOINT, SMOOTH].join("\n")
}

/// What sorts into tiles.
pub(super) fn bins() -> String {
    [FRAME, DRAWN, BINS].join("\n")
}

/// What draws tiles in an order, given by its number in `tiles.wgsl`.
pub(super) fn tiles(order: u32) -> String {
    let order = format!("const ORDER: u32 = {order}u;\n");
    [
        &order, FRAME, DRAWN, SWEEP, SEGMENTS, SURFACES, STRANDS, TILES,
    ]
    .join("\n")
}

/// What puts a frame into a render pass with so many samples.
pub(super) fn compose(samples: u32) -> String {
    let show = if samples > 1 {
        COMPOSE_SAMPLES
    } else {
        COMPOSE_MEAN
    };
    [FRAME, COMPOSE, show].join("\n")
}

/// `gpu_inputs` and `gpu_params`: an effect's inputs and parameters at a joint.
fn gather(source: &ProgramSource, layout: &JointLayout) -> String {
    let inputs = source.inputs.iter().map(|input| layout.input(*input));
    let inputs: Vec<String> = inputs.collect();
    let mut text = format!(
        "fn gpu_inputs(joint: u32) -> Inputs {{\n    return Inputs({});\n}}\n",
        inputs.join(", ")
    );
    let mut at = LAYER_WORDS;
    let mut params = Vec::new();
    for (index, param) in source.params.iter().enumerate() {
        let words = match param.kind {
            ParamKind::Number { .. } if source.varying.contains(&index) => {
                params.push(format!(
                    "gpu_varied({LAYER_WORDS}u + gpu_words[{at}u], gpu_scalar(joint, GPU_AT_U), gpu_seed(joint))"
                ));
                1
            }
            ParamKind::Number { .. } => {
                params.push(format!("gpu_word({at}u)"));
                1
            }
            ParamKind::Integer { min, .. } if min < 0 => {
                params.push(format!("bitcast<i32>(gpu_words[{at}u])"));
                1
            }
            ParamKind::Integer { .. } | ParamKind::Choice { .. } | ParamKind::Texture { .. } => {
                params.push(format!("gpu_words[{at}u]"));
                1
            }
            ParamKind::Flag { .. } => {
                params.push(format!("gpu_words[{at}u] != 0u"));
                1
            }
            ParamKind::Pair { .. } => {
                params.push(vector(2, at));
                2
            }
            ParamKind::Color { .. } | ParamKind::Triple { .. } => {
                params.push(vector(3, at));
                3
            }
            ParamKind::OptionalColor { .. } => {
                params.push(vector(4, at));
                4
            }
            // Programs have none.
            ParamKind::Text | ParamKind::Size { .. } => 0,
        };
        at += words;
    }
    let _ = writeln!(
        text,
        "fn gpu_params(joint: u32) -> Params {{\n    return Params({});\n}}",
        params.join(", ")
    );
    text
}

fn vector(size: u32, at: u32) -> String {
    let words: Vec<String> = (at..at + size)
        .map(|at| format!("gpu_word({at}u)"))
        .collect();
    format!("vec{size}<f32>({})", words.join(", "))
}
