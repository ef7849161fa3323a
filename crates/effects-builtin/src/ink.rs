//! The ink line: an outline as a brush draws it.

effects::effect!("ink");

/// `hair.ink`: outlines around clumps, as [`Silhouette`](crate::Silhouette) draws them, whose width swells and thins: with the light, towards
/// root and tip, and as a hand trembles.
pub struct Ink;

/// As in the WGSL.
const FEW_GAP_STEPS: u32 = 3;
const GAP_STEPS: u32 = 5;
const FEW_UP_TO: f32 = 3.0;
const WIDEST: f32 = 150.0;

impl effects::StrokeEffect for Ink {
    type Program = Program;
    const ID: &'static str = "hair.ink";
    const DOC: &'static str =
        "outlines by a brush: bold in shadow, thin in light, tapered at both ends, trembling";
    const RANK: i32 = -100;
    const DEPTH_OFFSET: f32 = 0.05;

    fn instances(params: &Params) -> u32 {
        let steps = match params.gap_width {
            width if width > FEW_UP_TO => GAP_STEPS,
            width if width > 1.0 => FEW_GAP_STEPS,
            _ => 1,
        };
        effects::CLUMP_DISCS * steps
    }

    fn reach(params: &Params) -> effects::Reach {
        effects::Reach {
            clumps: 2.0,
            units: widest(params),
        }
    }

    fn beyond(params: &Params) -> Option<effects::Reach> {
        Some(effects::Reach {
            clumps: params.ratio,
            units: widest(params),
        })
    }

    fn extent(_: &Params, strand: &effects::StrandJoints) -> std::ops::Range<usize> {
        let instance = strand.instance % effects::CLUMP_DISCS;
        effects::StrandJoints {
            instance,
            ..strand.clone()
        }
        .clump_disc_extent()
    }
}

/// How wide a line may be, in the layer's unit.
fn widest(params: &Params) -> f32 {
    let by_light = params.light_width.max(1.0);
    let widest = params.width * params.gap_width.max(1.0) * by_light * (1.0 + params.wobble);
    widest.min(WIDEST)
}
