//! Hair as an engraver cuts it: an effect for inkstrand that paints, from a crate of its own.
//!
//! The library needs the crates `effects` and, to be built, `effects-build`. `src/main.rs`, behind the feature
//! `program`, is the whole of inkstrand with this effect in it.

effects::effect!("engraving");

/// `example.engraving`: draws the clump as `hair.base` does, and cuts lines into it that are wide where little light falls.
pub struct Engraving;

impl effects::StrokeEffect for Engraving {
    type Program = Program;
    const ID: &'static str = "example.engraving";
    const DOC: &'static str = "the hair itself in lines around each lock, wider where it is dark";
    const RANK: i32 = 0;

    fn instances(_: &Params) -> u32 {
        effects::CLUMP_DISCS
    }

    fn extent(_: &Params, strand: &effects::StrandJoints) -> std::ops::Range<usize> {
        strand.clump_disc_extent()
    }
}
