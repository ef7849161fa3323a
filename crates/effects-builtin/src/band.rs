//! The band: a designed highlight across the hair.

use effects::StrandJoints;
use effects::wgsl::random;
use std::ops::Range;

effects::effect!("band");

/// `hair.band`: a zigzag of light across locks, drawn where a designer puts it and not where light would be mirrored, so that it stays
/// there while hair and head move.
pub struct Band;

impl effects::StrokeEffect for Band {
    type Program = Program;
    const ID: &'static str = "hair.band";
    const DOC: &'static str =
        "a band of light: at one height around the head, or at one distance from the roots";
    const RANK: i32 = 210;
    const ON_UNDERCOAT: bool = false;

    fn instances(params: &Params) -> u32 {
        if params.rim > 0.0 {
            2 * params.teeth
        } else {
            params.teeth
        }
    }

    fn extent(params: &Params, strand: &StrandJoints) -> Range<usize> {
        let StrandJoints { joints, seed, .. } = *strand;
        let is_nothing = params.thickness <= 0.0 || params.spread * params.fullness <= 0.0;
        if is_nothing || random(seed, 0) >= params.strand_share {
            return strand.range.start..strand.range.start;
        }
        // As far from its middle as any tooth of the strand reaches.
        let thickness = params.thickness;
        let longest = 1.0 + 0.5 * params.zigzag + 1.5 * params.tooth_variation;
        let units = if params.rim > 0.0 {
            params.rim / 300.0
        } else {
            0.0
        };
        let unit = |i: usize| joints.unit.get(i).copied().unwrap_or(1.0);
        let reach = |i: usize| {
            0.501 * thickness * longest + params.strand_variation + units * unit(i) + 1e-4
        };
        if params.along == Params::ALONG_LENGTH {
            return strand.extent(|i| {
                let from_root = joints.arc_length[i] / joints.head_height[i];
                from_root > params.start && (from_root - params.place).abs() < reach(i)
            });
        }
        // The band slides by how high the mirrored light is, which is at most half a head away.
        let slide = params.slide * (0.5 + params.place.abs());
        strand.extent(|i| (joints.rest_position[i].y - params.place).abs() < reach(i) + slide)
    }

    fn reach(params: &Params) -> effects::Reach {
        effects::Reach {
            clumps: 2.0 + params.fullness,
            units: params.rim,
        }
    }
}
