//! Shadows that hair casts: its own strokes once more, moved along the light.

use effects::wgsl::random;
use std::ops::Range;

effects::effect!("cast");

/// `hair.cast`: each clump's shape, moved along the light, drawn as a shadow on face, body and hair behind it.
pub struct Cast;

impl effects::StrokeEffect for Cast {
    type Program = Program;
    const ID: &'static str = "hair.cast";
    const DOC: &'static str = "the shadow that hair casts on face, body and hair behind it: its own shape, moved along the light";
    const RANK: i32 = 150;
    const ON_UNDERCOAT: bool = false;
    const CLIP: Option<&'static str> = Some("hair, head");
    const REACH: f32 = 0.05;
    const CASTS: bool = true;

    fn shadow_colors(_: &Params) -> &'static [&'static str] {
        &["color"]
    }

    fn instances(params: &Params) -> u32 {
        params.feathers
    }

    fn extent(params: &Params, strand: &effects::StrandJoints) -> Range<usize> {
        let joints = strand.joints;
        let end = match params.feathers {
            0 | 1 => f32::INFINITY,
            _ => 1.0 - params.raggedness * random(strand.seed, strand.instance),
        };
        strand.extent(|i| joints.light_on_screen[i].z > 0.0 && joints.u[i] < end)
    }

    fn reach(params: &Params) -> effects::Reach {
        effects::Reach {
            clumps: params.fullness,
            units: 300.0 * params.distance,
        }
    }
}
