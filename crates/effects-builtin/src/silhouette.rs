//! The silhouette stroke (5.2): the base stroke enlarged, in the line's colour, shifted farther.

effects::effect!("silhouette");

/// `hair.silhouette`: outlines around clumps. The depth offset sets their density (Fig 5.7): large,
/// only the outer boundary; small, every clump.
pub struct Silhouette;

impl effects::StrokeEffect for Silhouette {
    type Program = Program;
    const ID: &'static str = "hair.silhouette";
    const DOC: &'static str = "outlines; a larger depth_offset leaves only the outer boundary";
    const RANK: i32 = -100;
    const DEPTH_OFFSET: f32 = 0.05;

    fn instances(_: &Params) -> u32 {
        effects::CLUMP_DISCS
    }

    fn reach(params: &Params) -> effects::Reach {
        effects::Reach {
            clumps: 2.0,
            units: params.width,
        }
    }

    fn beyond(params: &Params) -> Option<effects::Reach> {
        Some(effects::Reach {
            clumps: params.ratio,
            units: params.width,
        })
    }

    fn extent(_: &Params, strand: &effects::StrandJoints) -> std::ops::Range<usize> {
        strand.clump_disc_extent()
    }
}
