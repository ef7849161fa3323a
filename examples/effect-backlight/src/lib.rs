//! Hair against the light: an effect for inkstrand from a crate of its own.
//!
//! The library needs the crates `effects` and, to be built, `effects-build`. `src/main.rs`, behind the feature
//! `program`, is the whole of inkstrand with this effect in it.

effects::effect!("backlight");

/// `example.backlight`: strokes of light along the rims of the hair, as of a lamp behind it.
pub struct Backlight;

impl effects::StrokeEffect for Backlight {
    type Program = Program;
    const ID: &'static str = "example.backlight";
    const DOC: &'static str =
        "light from behind: bright strokes where hair is seen at a grazing angle";
    /// Above the highlight, which it outshines.
    const RANK: i32 = 220;

    fn instances(params: &Params) -> u32 {
        params.feathers
    }

    fn shortest(params: &Params) -> f32 {
        params.shortest
    }
}
