//! The text of a compute shader that runs an effect, or the clump, at every joint.

use super::inputs::{mesh_sample_in_wgsl, sample_in_wgsl};
use super::layout::JointLayout;
use super::programs::{Tells, TilesKey};
use crate::drawing::Order;
use crate::features::{Feature, Features};
use effects::{PaintSource, ParamKind, ProgramSource, SampleInput};
use std::fmt::Write as _;

const FRAME: &str = include_str!("../../../../shaders/gpu/frame.wgsl");
const WORDS: &str = include_str!("../../../../shaders/gpu/words.wgsl");
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
const TOLD: &str = include_str!("../../../../shaders/gpu/told.wgsl");
const UNTOLD: &str = include_str!("../../../../shaders/gpu/untold.wgsl");
const IMAGE: &str = include_str!("../../../../shaders/gpu/image.wgsl");
const ATLAS: &str = include_str!("../../../../shaders/gpu/atlas.wgsl");
const TEXTURED: &str = include_str!("../../../../shaders/gpu/textured.wgsl");
const UNTEXTURED: &str = include_str!("../../../../shaders/gpu/untextured.wgsl");
const UNDER: &str = include_str!("../../../../shaders/gpu/under.wgsl");
const NO_UNDER: &str = include_str!("../../../../shaders/gpu/no_under.wgsl");
const BRUSHED: &str = include_str!("../../../../shaders/gpu/brushed.wgsl");
const UNBRUSHED: &str = include_str!("../../../../shaders/gpu/unbrushed.wgsl");
const DECALS: &str = include_str!("../../../../shaders/gpu/decals.wgsl");
const NO_DECALS: &str = include_str!("../../../../shaders/gpu/no_decals.wgsl");
const LOOKUP: &str = include_str!("../../../../shaders/gpu/lookup.wgsl");
const MESH_MAIN: &str = include_str!("../../../../shaders/gpu/mesh_main.wgsl");
const SHOWN: &str = include_str!("../../../../shaders/gpu/shown.wgsl");
const TELL: &str = include_str!("../../../../shaders/gpu/tell.wgsl");
const PAINT_MAIN: &str = include_str!("../../../../shaders/gpu/paint_main.wgsl");
const EDGES: &str = include_str!("../../../../shaders/gpu/edges.wgsl");
const MEAN: &str = include_str!("../../../../shaders/gpu/mean.wgsl");

/// Words before the parameters of a layer or a clump: `shaders/gpu/joint.wgsl` names them.
pub(super) const LAYER_WORDS: u32 = 16;
/// Of them the one that says where what paints a layer begins.
pub(super) const PAINT_WORD: usize = 13;

/// The clump's shader.
pub(super) fn clump(source: &ProgramSource, layout: &JointLayout) -> String {
    [
        source.wgsl,
        FRAME,
        &layout.constants(),
        WORDS,
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
        WORDS,
        JOINT,
        &gather(source, layout),
        STROKE_MAIN,
    ]
    .join("\n")
}

/// What smooths layers: entry points `find_gaps`, `close_gaps`, `find_specks` and `open_specks`, in that order.
pub(super) fn smooth(layout: &JointLayout) -> String {
    [PRELUDE, FRAME, &layout.constants(), WORDS, JOINT, SMOOTH].join("\n")
}

/// What sorts into tiles.
pub(super) fn bins() -> String {
    [FRAME, DRAWN, BINS].join("\n")
}

/// What draws tiles, made for that.
pub(super) fn tiles(key: TilesKey) -> String {
    // As `tiles.wgsl` numbers them.
    let order = match key.order {
        Order::Rounded => 0,
        Order::StrandFirst => 1,
        Order::Shifted => 2,
    };
    let order = format!("const ORDER: u32 = {order}u;\n");
    let (told, under, binding) = match key.tells {
        Tells::Nothing => (UNTOLD, NO_UNDER, 10),
        Tells::Shown => (TOLD, NO_UNDER, 11),
        Tells::Under => (TOLD, UNDER, 12),
    };
    let atlas = format!("@group(0) @binding({binding}) var atlas: texture_2d<f32>;\n");
    let pictures: &[&str] = match key.has_pictures() {
        true => &[PRELUDE, IMAGE, &atlas, ATLAS],
        false => &[],
    };
    let parts = [
        &[&order, told, under, FRAME, DRAWN][..],
        pictures,
        &[
            if key.textured { TEXTURED } else { UNTEXTURED },
            if key.brushed { BRUSHED } else { UNBRUSHED },
            SWEEP,
            SEGMENTS,
            SURFACES,
            STRANDS,
            if key.decals { DECALS } else { NO_DECALS },
            TILES,
        ],
    ];
    parts.concat().join("\n")
}

/// What paints a layer's samples.
pub(super) fn paint(source: &ProgramSource, paint: &PaintSource, layout: &JointLayout) -> String {
    [
        source.wgsl,
        FRAME,
        &layout.constants(),
        WORDS,
        JOINT,
        SHOWN,
        &params(source),
        &sample(paint, "GpuPoint", sample_in_wgsl),
        &images(paint.textures.len(), IMAGES_AT),
        IMAGE,
        LOOKUP,
        PAINT_MAIN,
    ]
    .join("\n")
}

/// What paints the samples of meshes.
pub(super) fn paint_meshes(source: &ProgramSource, paint: &PaintSource) -> String {
    [
        source.wgsl,
        FRAME,
        WORDS,
        &params(source),
        &sample(paint, "GpuSeen", mesh_sample_in_wgsl),
        &images(paint.textures.len(), MESH_IMAGES_AT),
        IMAGE,
        LOOKUP,
        MESH_MAIN,
    ]
    .join("\n")
}

/// What fills the planes of those features.
pub(super) fn tell(features: Features, layout: &JointLayout) -> String {
    [
        PRELUDE,
        FRAME,
        &layout.constants(),
        WORDS,
        JOINT,
        SHOWN,
        &planes(features),
        TELL,
    ]
    .join("\n")
}

/// What draws lines by the planes of those features: entry points `find`, `grow_along_rows` and `draw_along_columns`, in that order.
pub(super) fn edges(features: Features) -> String {
    [PRELUDE, FRAME, &planes(features), EDGES].join("\n")
}

/// What takes the means of samples: entry point `take_means`.
pub(super) fn mean() -> String {
    [FRAME, MEAN].join("\n")
}

/// Which plane each feature begins at, as WGSL constants: ids first, as [`SamplePlanes`](crate::SamplePlanes) has them.
fn planes(features: Features) -> String {
    let mut text = "const GPU_NO_PLANE: u32 = 0xffffffffu;\n".to_owned();
    let mut next = 0;
    for is_id in [true, false] {
        for feature in Feature::ALL.iter().filter(|f| f.is_id() == is_id) {
            let name = plane_name(*feature);
            if features.has(*feature) {
                let _ = writeln!(text, "const GPU_PLANE_{name}: u32 = {next}u;");
                next += feature.components();
            } else {
                let _ = writeln!(text, "const GPU_PLANE_{name}: u32 = GPU_NO_PLANE;");
            }
        }
    }
    text
}

fn plane_name(feature: Feature) -> &'static str {
    match feature {
        Feature::Object => "OBJECT",
        Feature::Strand => "STRAND",
        Feature::Piece => "PIECE",
        Feature::Layer => "LAYER",
        Feature::Level => "LEVEL",
        Feature::InvDepth => "INV_DEPTH",
        Feature::U => "U",
        Feature::S => "S",
        Feature::V => "V",
        Feature::W => "W",
        Feature::Pixels => "PIXELS",
        Feature::Normal => "NORMAL",
        Feature::Color => "COLOR",
    }
}

/// `gpu_sample`, what a program that paints reads of a sample, and `gpu_painted`, the sample's colour.
fn sample(paint: &PaintSource, point: &str, in_wgsl: fn(SampleInput) -> &'static str) -> String {
    let inputs: Vec<&str> = paint.inputs.iter().map(|input| in_wgsl(*input)).collect();
    let texel = match paint.places {
        true => "gpu_texel(place(at, params)), ",
        false => "",
    };
    format!(
        "fn gpu_sample(p: {point}, color: vec3<f32>) -> Sample {{\n    return Sample({});\n}}\n\
         fn gpu_painted(at: Sample, params: Params) -> vec3<f32> {{\n    return paint(at, {texel}params);\n}}\n",
        inputs.join(", ")
    )
}

/// First binding of images, of what paints strokes and of what paints meshes.
const IMAGES_AT: u32 = 8;
const MESH_IMAGES_AT: u32 = 9;

/// As many images as there are textures, from that binding on, and functions that take their number.
fn images(count: usize, first: u32) -> String {
    let mut text = format!("const GPU_TEXTURE_COUNT: u32 = {count}u;\n");
    let mut functions = [
        "fn gpu_image_levels(image: u32) -> u32 {\n    switch image {\n".to_owned(),
        "fn gpu_image_size(image: u32, level: u32) -> vec2<u32> {\n    switch image {\n".to_owned(),
        "fn gpu_image_texel(image: u32, level: u32, at: vec2<u32>) -> vec4<f32> {\n    switch image {\n"
            .to_owned(),
    ];
    for (image, binding) in (0..count).zip(first..) {
        let _ = writeln!(
            text,
            "@group(0) @binding({binding}) var gpu_image_{image}: texture_2d<f32>;"
        );
        let values = [
            format!("textureNumLevels(gpu_image_{image})"),
            format!("textureDimensions(gpu_image_{image}, level)"),
            format!("textureLoad(gpu_image_{image}, at, level)"),
        ];
        for (function, value) in functions.iter_mut().zip(values) {
            let _ = writeln!(function, "        case {image}u: {{ return {value}; }}");
        }
    }
    let none = ["1u", "vec2<u32>(1u)", "vec4<f32>(0.0)"];
    for (function, none) in functions.iter().zip(none) {
        let _ = write!(
            text,
            "{function}        default: {{ return {none}; }}\n    }}\n}}\n"
        );
    }
    text
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
    format!(
        "fn gpu_inputs(joint: u32) -> Inputs {{\n    return Inputs({});\n}}\n{}",
        inputs.join(", "),
        params(source)
    )
}

/// `gpu_params`: an effect's parameters at a place along a joint's strand.
fn params(source: &ProgramSource) -> String {
    let mut at = LAYER_WORDS;
    let mut params = Vec::new();
    for (index, param) in source.params.iter().enumerate() {
        let words = match param.kind {
            ParamKind::Number { .. } if source.varying.contains(&index) => {
                params.push(format!(
                    "gpu_varied({LAYER_WORDS}u + gpu_words[{at}u], u, gpu_seed(joint))"
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
    format!(
        "fn gpu_params(joint: u32, u: f32) -> Params {{\n    return Params({});\n}}\n",
        params.join(", ")
    )
}

fn vector(size: u32, at: u32) -> String {
    let words: Vec<String> = (at..at + size)
        .map(|at| format!("gpu_word({at}u)"))
        .collect();
    format!("vec{size}<f32>({})", words.join(", "))
}
