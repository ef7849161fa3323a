//! The base stroke (5.1): the clump in its basic colour.

effects::effect!("base");

/// `hair.base`: draws the clump as the preset's `clump` section makes it.
pub struct Base;

impl effects::StrokeEffect for Base {
    type Program = Program;
    const ID: &'static str = "hair.base";
    const DOC: &'static str = "the hair itself: each strand's clump in its basic colour";
    const RANK: i32 = 0;
    const IS_CLUMP: bool = true;

    fn instances(_: &Params) -> u32 {
        effects::CLUMP_DISCS
    }

    fn reach(_: &Params) -> effects::Reach {
        effects::Reach {
            clumps: 2.0,
            units: 0.0,
        }
    }

    fn extent(_: &Params, strand: &effects::StrandJoints) -> std::ops::Range<usize> {
        strand.clump_disc_extent()
    }
}
