//! The cel-shaded stroke (5.3): a feathered shadow, or a feathered lighter tone.

use effects::StrandJoints;
use effects::wgsl::{Scalar, random_signed};
use std::ops::Range;

effects::effect!("cel");

/// Grays this close to where a stroke ends are worked out: rounding decides there.
const NEAR: f32 = 1e-3;

/// `hair.cel`: strokes across the clump where it is dark (or light), which taper at the region's edge.
pub struct Cel;

impl effects::StrokeEffect for Cel {
    type Program = Program;
    const ID: &'static str = "hair.cel";
    const DOC: &'static str = "feathered shadow or light, by the gray of the clump";
    const RANK: i32 = 100;

    fn shadow_colors(params: &Params) -> &'static [&'static str] {
        match params.region {
            Params::REGION_LIGHTER => &[],
            _ => &["color"],
        }
    }

    fn instances(params: &Params) -> u32 {
        params.feathers
    }

    fn shortest(params: &Params) -> f32 {
        params.shortest
    }

    fn extent(params: &Params, strand: &StrandJoints) -> Range<usize> {
        let StrandJoints {
            joints,
            instance,
            seed,
            ..
        } = *strand;
        if params.fullness <= 0.0 {
            return strand.range.start..strand.range.start;
        }
        let shift = params.strand_variation * random_signed(seed, 0)
            + params.feather_variation * random_signed(seed, instance + 1);
        let [full, edge] =
            [params.full, params.threshold].map(|gray| (gray + shift).clamp(0.0, 1.0));
        let place = (2.0 * instance as f32 + 1.0) / params.feathers as f32 - 1.0;
        let roundness = params.roundness * place;
        // The stroke's gray is `along / sqrt(whole)`, or 0 where that is less.
        let gray = |i: usize| {
            let across = joints.forward[i].cross(joints.view_direction[i]);
            let normal = joints.normal[i] + across * Scalar(roundness);
            let whole = normal.dot(normal).0;
            (joints.light_direction[i].dot(normal).0, whole)
        };
        if params.region == Params::REGION_LIGHTER {
            let least = full.min(edge) - NEAR;
            return strand.extent(|i| {
                let (along, whole) = gray(i);
                least <= 0.0
                    || whole < NEAR
                    || (along > 0.0 && along * along >= least * least * whole)
            });
        }
        let most = full.max(edge) + NEAR;
        strand.extent(|i| {
            let (along, whole) = gray(i);
            whole < NEAR || along <= 0.0 || along * along <= most * most * whole
        })
    }

    fn reach(params: &Params) -> effects::Reach {
        // A row of strokes across the clump, or along its flat end.
        effects::Reach {
            clumps: 3.0 + params.fullness,
            units: 0.0,
        }
    }
}
