//! The highlight stroke (5.4): specular, by the light's distance, or as a ring.

use effects::StrandJoints;
use effects::wgsl::{random, random_signed};
use std::ops::Range;

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

    fn extent(params: &Params, strand: &StrandJoints) -> Range<usize> {
        let StrandJoints {
            joints,
            instance,
            seed,
            ..
        } = *strand;
        let mine = |draw: u32| random(seed, 3 * instance + draw);
        if random(seed, 1) >= params.strand_share || mine(3) >= params.feather_share {
            return strand.range.start..strand.range.start;
        }
        let shift = params.strand_variation * random_signed(seed, 0)
            + params.feather_variation * (2.0 * mine(2) - 1.0);
        let is_behind_start = |i: usize| joints.u[i] > params.start;
        if params.kind == Params::KIND_DISTANCE {
            let far = (params.far + shift).max(0.0);
            let full = (params.near + shift).max(0.0);
            let reach = far.max(full);
            return strand.extent(|i| is_behind_start(i) && joints.light_distance[i] <= reach);
        }
        // Where the tangent hangs on the normal too, the ring may be anywhere.
        if params.kind == Params::KIND_SPECULAR || params.shift != 0.0 {
            return strand.extent(is_behind_start);
        }
        // (1 - c^2)^n is at most 1 / (1 + n c^2), for the cosine c of the strand and the half way vector.
        let limit = (params.threshold + shift)
            .min(params.full + shift)
            .max(0.01);
        let steepness = 2.0 * params.exponent;
        strand.extent(|i| {
            let half_way = joints.light_direction[i] + joints.view_direction[i];
            let along = joints.forward[i].dot(half_way).0;
            let length = half_way.dot(half_way).0;
            let whole = joints.forward[i].dot(joints.forward[i]).0 * length;
            let is_dark =
                length > 1e-6 && limit * (whole + steepness * along * along) > 1.001 * whole;
            is_behind_start(i) && !is_dark
        })
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
