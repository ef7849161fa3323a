//! Where shaders find what a joint offers.

use crate::frame::Frame;
use effects::{Input, SampleInput};
use glam::{Vec2, Vec3};

/// Where shaders find an input.
pub(super) enum InputSource {
    /// In the joint's record, into which a list of the frame goes.
    Numbers(List<f32>),
    Pairs(List<Vec2>),
    Triples(List<Vec3>),
    /// An expression of `joint`, its index.
    Wgsl(&'static str),
}

/// A list with an entry for each joint.
type List<T> = for<'a> fn(&Frame<'a>) -> &'a [T];

impl InputSource {
    pub(super) fn of(input: Input) -> Self {
        use InputSource::{Numbers, Pairs, Triples, Wgsl};
        match input {
            Input::Position => Triples(|frame| &frame.paths.position),
            Input::Forward => Triples(|frame| &frame.paths.forward),
            Input::Backward => Triples(|frame| &frame.paths.backward),
            Input::U => Numbers(|frame| &frame.paths.u),
            Input::ArcLength => Numbers(|frame| &frame.paths.arc_length),
            Input::Across => Pairs(|frame| &frame.paths.across),
            Input::MaterialNormal => Triples(|frame| frame.material_normals),
            Input::RestPosition => Triples(|frame| frame.rest_positions),
            Input::RestForward => Triples(|frame| frame.rest_forwards),
            Input::FromEnds => Pairs(|frame| frame.from_ends),
            Input::PathWeight => Numbers(|frame| frame.path_weights),
            Input::Strand => Wgsl("gpu_of_strand(joint, 0u)"),
            Input::Seed => Wgsl("gpu_seed(joint)"),
            Input::StrandMean => Wgsl("gpu_strand_mean(joint)"),
            Input::StrandSize => Wgsl("bitcast<f32>(gpu_of_strand(joint, 4u))"),
            Input::StrandTaper => Wgsl("gpu_strand_taper(joint)"),
            Input::StrandColor => Wgsl("gpu_strand_color(joint, 8u)"),
            Input::StrandTipColor => Wgsl("gpu_strand_color(joint, 11u)"),
            Input::HeadCenter => Wgsl("gpu_head_center()"),
            Input::HeadHeight => Wgsl("gpu_word(GPU_HEAD_HEIGHT)"),
            Input::LightDirection => Wgsl("gpu_light_direction(joint)"),
            Input::LightDistance => Wgsl("gpu_light_distance(joint)"),
            Input::LightOnScreen => Wgsl("gpu_light_on_screen(joint)"),
            Input::Depth => Wgsl("gpu_depth(joint)"),
            Input::Time => Wgsl("gpu_frame.time_s"),
            Input::ViewDirection => Wgsl("gpu_view_direction(joint)"),
            Input::Unit => Wgsl("gpu_unit(joint)"),
            Input::Normal => Wgsl("gpu_clumps[joint].normal"),
            Input::ClumpRadius => Wgsl("gpu_clumps[joint].radius"),
            Input::ClumpColor => Wgsl("gpu_clumps[joint].color"),
            Input::ClumpShift => Wgsl("gpu_clumps[joint].shift"),
            Input::Gray => Wgsl("gpu_clumps[joint].gray"),
        }
    }

    /// How many words it takes in a joint's record.
    pub(super) fn words(&self) -> u32 {
        match self {
            Self::Numbers(_) => 1,
            Self::Pairs(_) => 2,
            Self::Triples(_) => 3,
            Self::Wgsl(_) => 0,
        }
    }

    /// Adds the words of joint `joint` of the frame's list to a record.
    pub(super) fn push(&self, frame: &Frame, joint: usize, push: &mut impl FnMut(&[u32])) {
        match self {
            Self::Numbers(list) => push(&[list(frame)[joint].to_bits()]),
            Self::Pairs(list) => push(&list(frame)[joint].to_array().map(f32::to_bits)),
            Self::Triples(list) => push(&list(frame)[joint].to_array().map(f32::to_bits)),
            Self::Wgsl(_) => {}
        }
    }

    /// The input in WGSL, for a record that has its words at the constant `place`; 0 for one that has not, as
    /// nobody has worked it out.
    pub(super) fn in_wgsl(&self, place: Option<&str>) -> String {
        match (self, place) {
            (Self::Wgsl(text), _) => (*text).to_owned(),
            (Self::Numbers(_), Some(place)) => format!("gpu_scalar(joint, {place})"),
            (Self::Pairs(_), Some(place)) => format!("gpu_vec2(joint, {place})"),
            (Self::Triples(_), Some(place)) => format!("gpu_vec3(joint, {place})"),
            (Self::Numbers(_), None) => "0.0".to_owned(),
            (Self::Pairs(_), None) => "vec2<f32>(0.0)".to_owned(),
            (Self::Triples(_), None) => "vec3<f32>(0.0)".to_owned(),
        }
    }
}

/// What a painted sample offers, as an expression of WGSL of `p`, a point beside it, and `color`, that of its stroke.
pub(super) fn sample_in_wgsl(input: SampleInput) -> &'static str {
    match input {
        SampleInput::Color => "color",
        SampleInput::Position => "gpu_vec3_at(p, GPU_AT_POSITION)",
        SampleInput::Forward => {
            "gpu_unit_between(p, gpu_vec3(p.joint, GPU_AT_FORWARD), gpu_vec3(p.next, GPU_AT_FORWARD))"
        }
        SampleInput::Normal => {
            "gpu_unit_between(p, gpu_clumps[p.joint].normal, gpu_clumps[p.next].normal)"
        }
        SampleInput::Tube => "gpu_tube(p)",
        SampleInput::U => "gpu_scalar_at(p, GPU_AT_U)",
        SampleInput::S => "gpu_scalar_at(p, GPU_AT_ARC_LENGTH) / gpu_word(GPU_HEAD_HEIGHT)",
        SampleInput::V => "p.v",
        SampleInput::W => "p.w",
        SampleInput::Strand => "gpu_of_strand(p.joint, 0u)",
        SampleInput::Seed => "gpu_seed(p.joint)",
        SampleInput::Level => "gpu_of_strand(p.joint, GPU_STRAND_LEVEL)",
        SampleInput::Depth => "gpu_between(p, gpu_depth(p.joint), gpu_depth(p.next))",
        SampleInput::HeadDepth => "bitcast<f32>(gpu_paint_word(GPU_HEAD_DEPTH))",
        SampleInput::LightDirection => {
            "gpu_unit_between(p, gpu_light_direction(p.joint), gpu_light_direction(p.next))"
        }
        SampleInput::LightDistance => {
            "gpu_between(p, gpu_light_distance(p.joint), gpu_light_distance(p.next))"
        }
        SampleInput::ViewDirection => {
            "gpu_unit_between(p, gpu_view_direction(p.joint), gpu_view_direction(p.next))"
        }
        SampleInput::Pixels => "gpu_scalar_at(p, GPU_AT_PX_PER_METRE) * gpu_word(GPU_HEAD_HEIGHT)",
        SampleInput::Time => "gpu_frame.time_s",
        // Of meshes.
        SampleInput::ShadeColor => "vec3<f32>(0.0)",
        SampleInput::Occlusion => "0.0",
    }
}

/// What a sample of a mesh offers, as an expression of WGSL of `p`, what is seen there.
pub(super) fn mesh_sample_in_wgsl(input: SampleInput) -> &'static str {
    match input {
        SampleInput::Color => "p.color",
        SampleInput::ShadeColor => "p.shade_color",
        SampleInput::Position => "p.position",
        SampleInput::Normal => "p.normal",
        SampleInput::Occlusion => "p.occlusion",
        SampleInput::Depth => "p.depth_m / gpu_word(GPU_HEAD_HEIGHT)",
        SampleInput::HeadDepth => "bitcast<f32>(gpu_paint_word(GPU_HEAD_DEPTH))",
        SampleInput::LightDirection => "gpu_mesh_light_direction(p)",
        SampleInput::LightDistance => "gpu_mesh_light_distance(p)",
        SampleInput::ViewDirection => {
            "unit_or(gpu_frame.eye - p.position, vec3<f32>(0.0, 0.0, 1.0))"
        }
        SampleInput::Pixels => "gpu_mesh.focal_px / p.depth_m * gpu_word(GPU_HEAD_HEIGHT)",
        SampleInput::Time => "gpu_frame.time_s",
        // Of hair: the checks of effects for meshes refuse them.
        SampleInput::Seed | SampleInput::Strand | SampleInput::Level => "0u",
        SampleInput::Forward | SampleInput::Tube => "vec3<f32>(0.0)",
        SampleInput::U | SampleInput::S | SampleInput::V | SampleInput::W => "0.0",
    }
}
