//! An effect that paints meshes.

use crate::effect::{Reach, StrandJoints, StrokeEffect};
use crate::program::{Parameters, Program};
use crate::samples::SampleInput;
use std::marker::PhantomData;
use std::ops::Range;

/// An effect that paints what meshes show, sample by sample, as its author writes it. Its WGSL begins with `//! mesh: color, normal` in place of
/// `//! inputs:`, and has `paint` without a `stroke`. [`Registry::register_mesh`](crate::Registry::register_mesh) takes it.
///
/// ```ignore
/// effects::effect!("ivory"); // src/ivory.wgsl, translated by build.rs
///
/// /// Skin as of ivory.
/// pub struct Ivory;
///
/// impl effects::MeshEffect for Ivory {
///     type Program = Program;
///     const ID: &'static str = "mine.ivory";
///     const DOC: &'static str = "skin as of ivory";
/// }
/// ```
pub trait MeshEffect: Send + Sync + 'static {
    /// The translated WGSL.
    type Program: Program;
    /// A stable id: `mesh.` for inkstrand's own, `vendor.` for others.
    const ID: &'static str;
    /// One line for people.
    const DOC: &'static str;

    /// Whether painting with these parameters makes use of something of a sample that the WGSL declares, so that it need not be worked
    /// out else.
    fn reads(params: &<Self::Program as Parameters>::Params, input: SampleInput) -> bool {
        let _ = (params, input);
        true
    }
}

/// An effect for meshes as one whose strokes have no size.
pub(crate) struct OnMeshes<E>(PhantomData<fn() -> E>);

impl<E: MeshEffect> StrokeEffect for OnMeshes<E> {
    type Program = E::Program;
    const ID: &'static str = E::ID;
    const DOC: &'static str = E::DOC;
    const RANK: i32 = 0;
    const IS_FOR_MESHES: bool = true;

    fn extent(_: &<Self::Program as Parameters>::Params, strand: &StrandJoints) -> Range<usize> {
        strand.range.start..strand.range.start
    }

    fn reach(_: &<Self::Program as Parameters>::Params) -> Reach {
        Reach {
            clumps: 0.0,
            units: 0.0,
        }
    }

    fn reads(params: &<Self::Program as Parameters>::Params, input: SampleInput) -> bool {
        E::reads(params, input)
    }
}
