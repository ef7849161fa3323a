//! The cel-shaded stroke (5.3): a feathered shadow, or a feathered lighter tone.

effects::effect!("cel");

/// `hair.cel`: strokes across the clump where it is dark (or light), which taper at the region's edge.
pub struct Cel;

impl effects::StrokeEffect for Cel {
    type Program = Program;
    const ID: &'static str = "hair.cel";
    const DOC: &'static str = "feathered shadow or light, by the gray of the clump";
    const RANK: i32 = 100;

    fn instances(params: &Params) -> u32 {
        params.feathers
    }

    fn shortest(params: &Params) -> f32 {
        params.shortest
    }

    fn extent(params: &Params, strand: &effects::StrandJoints) -> std::ops::Range<usize> {
        match params.fullness > 0.0 {
            true => strand.range.clone(),
            false => strand.range.start..strand.range.start,
        }
    }

    fn reach(params: &Params) -> effects::Reach {
        // A row of strokes across the clump, or along its flat end.
        effects::Reach {
            clumps: 3.0 + params.fullness,
            units: 0.0,
        }
    }
}
