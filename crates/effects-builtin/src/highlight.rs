//! The highlight stroke (5.4): specular, by the light's distance, or as a ring.

effects::effect!("highlight");

/// `hair.highlight`: a few whole strokes where the hair shines.
pub struct Highlight;

impl effects::StrokeEffect for Highlight {
    type Program = Program;
    const ID: &'static str = "hair.highlight";
    const DOC: &'static str = "feathered highlights: specular, by the light's distance, or a ring";
    const RANK: i32 = 200;
    const ON_UNDERCOAT: bool = false;

    fn instances(params: &Params) -> u32 {
        params.feathers
    }

    fn shortest(params: &Params) -> f32 {
        params.shortest
    }

    fn needs_point_light(params: &Params) -> bool {
        params.kind == Params::KIND_DISTANCE
    }

    fn reach(params: &Params) -> effects::Reach {
        effects::Reach {
            clumps: 2.0 + params.fullness,
            units: 0.0,
        }
    }
}
