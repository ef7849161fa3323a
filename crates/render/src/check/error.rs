//! What can be wrong with a drawing.

use super::{MAX_COORDINATE, MAX_PLACE, MAX_SIZE};
use crate::drawing::Disc;
use crate::features::Feature;
use std::ops::Range;

/// Why a drawing can't be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawError {
    /// A picture has from 1 to [`MAX_SIZE`] pixels a side.
    #[error("the picture's size is {0} x {1}: each side must be 1 to {MAX_SIZE} pixels")]
    Size(u32, u32),
    /// The finished picture doesn't fit.
    #[error("not enough memory for a picture of {0} x {1}")]
    Memory(u32, u32),
    /// The background is not a colour.
    #[error("the background's colour is not finite")]
    Background,
    /// Edges lie a finite length deeper, 0 or more.
    #[error("edge_depth_m is {0}, not a finite number of 0 or more")]
    EdgeDepth(f32),
    /// A run has no joint, or some that the drawing doesn't have.
    #[error(
        "run {run}: its joints are {start}..{end}, which is not a piece of the drawing's {joints}"
    )]
    RunJoints {
        /// Index of the run.
        run: usize,
        /// Its first joint.
        start: usize,
        /// One beyond its last.
        end: usize,
        /// How many the drawing has.
        joints: usize,
    },
    /// Some runs share joints.
    #[error("the runs have {runs} joints in all, the drawing has {joints}: runs share joints")]
    SharedJoints {
        /// Sum of the runs' joints.
        runs: usize,
        /// How many the drawing has.
        joints: usize,
    },
    /// Runs are sorted by the ids of their strands.
    #[error("run {run} of strand {strand} comes after strand {before}: ids must not decrease")]
    RunOrder {
        /// Index of the run.
        run: usize,
        /// Its strand's id.
        strand: u32,
        /// The strand of the run before.
        before: u32,
    },
    /// A layer draws on joints that the drawing doesn't have, or on a part of a run.
    #[error(
        "layer \"{layer}\": it draws on the joints {start}..{end}, which are no whole runs of the drawing's {joints}"
    )]
    LayerJoints {
        /// The layer's name.
        layer: String,
        /// The first joint that it draws on.
        start: usize,
        /// One beyond the last.
        end: usize,
        /// How many the drawing has.
        joints: usize,
    },
    /// A layer's lists don't fit its joints and instances.
    #[error(
        "layer \"{layer}\": {discs} discs and {colors} colours for {instances} instances of {joints} joints"
    )]
    LayerLength {
        /// The layer's name.
        layer: String,
        /// Length of its list of discs.
        discs: usize,
        /// Length of its list of colours.
        colors: usize,
        /// Its strokes per run.
        instances: usize,
        /// The joints that it draws on.
        joints: usize,
    },
    /// A stretch lies on joints or discs that there aren't, or before the end of the one before.
    #[error(
        "{of}, stroke {instance}: the joints {start}..{end} with discs from {first} on are no stretch of joints {} to {} with {discs} discs, behind the one before",
        joints.start, joints.end
    )]
    Stretch {
        /// The layer, or the clump's sides.
        of: String,
        /// Which of its strokes.
        instance: usize,
        /// The first joint of the stretch.
        start: usize,
        /// One beyond the last.
        end: usize,
        /// Where its first disc lies.
        first: usize,
        /// The joints that the strokes may be on.
        joints: Range<usize>,
        /// How many discs there are.
        discs: usize,
    },
    /// A layer has stretches for other strokes than its own.
    #[error("{of}: there are stretches for {lists} strokes, of {instances}")]
    StretchLists {
        /// The layer, or the clump's sides.
        of: String,
        /// For how many strokes there are stretches.
        lists: usize,
        /// How many strokes there are.
        instances: usize,
    },
    /// There are sides of the clump for other joints than the drawing's.
    #[error(
        "there are {discs} discs at the clump's sides: there must be none, or two a joint ({joints} joints)"
    )]
    Sides {
        /// How many there are.
        discs: usize,
        /// The drawing's joints.
        joints: usize,
    },
    /// A disc of the clump is invalid.
    #[error("clump, joint {joint}: {disc:?} is invalid: {DISC_RULE}")]
    ClumpDisc {
        /// Index of the joint.
        joint: usize,
        /// As it was given.
        disc: Disc,
    },
    /// A disc of a layer is invalid.
    #[error(
        "layer \"{layer}\", instance {instance}, joint {joint}: {disc:?} is invalid: {DISC_RULE}"
    )]
    LayerDisc {
        /// The layer's name.
        layer: String,
        /// Which of its strokes.
        instance: usize,
        /// Index of the joint.
        joint: usize,
        /// As it was given.
        disc: Disc,
    },
    /// A colour of a layer is not finite.
    #[error("layer \"{layer}\", instance {instance}, joint {joint}: the colour is not finite")]
    LayerColor {
        /// The layer's name.
        layer: String,
        /// Which of its strokes.
        instance: usize,
        /// Index of the joint.
        joint: usize,
    },
    /// A margin is not finite.
    #[error("surface {surface}: margin_m is {margin_m}, not a finite number")]
    Margin {
        /// The surface's index.
        surface: usize,
        /// As it was given, metres.
        margin_m: f32,
    },
    /// A colour of a surface is not finite.
    #[error("surface {surface}: a colour is not finite")]
    SurfaceColor {
        /// Index of the surface.
        surface: usize,
    },
    /// A corner is not finite, or too far away.
    #[error(
        "surface {surface}, vertex {vertex}: its numbers must be finite, its position at most {MAX_COORDINATE} pixels away"
    )]
    Vertex {
        /// Index of the surface.
        surface: usize,
        /// Index of the vertex.
        vertex: usize,
    },
    /// A triangle's corner doesn't exist.
    #[error(
        "surface {surface}, triangle {triangle}: there is no vertex {vertex}, only {vertices} vertices"
    )]
    TriangleIndex {
        /// Index of the surface.
        surface: usize,
        /// Index of the triangle.
        triangle: usize,
        /// The index that is too large.
        vertex: u32,
        /// How many the surface has.
        vertices: usize,
    },
    /// A textured surface has a place for each vertex.
    #[error(
        "surface {surface}: its texture has {found} places, where there are {vertices} vertices"
    )]
    TexturePlaces {
        /// Index of the surface.
        surface: usize,
        /// How many there are.
        found: usize,
        /// How many there should be.
        vertices: usize,
    },
    /// A place in a texture is not finite, or too far away.
    #[error(
        "surface {surface}, vertex {vertex}: its place in the texture must be finite, at most {MAX_PLACE} pictures away"
    )]
    TexturePlace {
        /// Index of the surface.
        surface: usize,
        /// Index of the vertex.
        vertex: usize,
    },
    /// A share is from 0 to 1.
    #[error("surface {surface}: its texture is cut at a coverage of {share}, not 0 to 1")]
    Cut {
        /// Index of the surface.
        surface: usize,
        /// As it was given.
        share: f32,
    },
    /// A pass needs a feature that isn't declared.
    #[error("a pass needs the feature {0:?}, which is not declared")]
    Undeclared(Feature),
    /// A list that a declared feature needs has another length.
    #[error("features: the list `{list}` has {length} entries, where there are {needed}")]
    FeatureList {
        /// Which list.
        list: &'static str,
        /// Its length.
        length: usize,
        /// How many joints or runs there are.
        needed: usize,
    },
    /// A decal is of a layer that isn't there, not behind the one before or painted, or its reach is no length.
    #[error(
        "decals: layer {0} is not there, not behind the one before or painted, or its reach is not a finite number of 0 or more"
    )]
    Decal(usize),
    /// A layer is to be painted that isn't there, or not behind the one before.
    #[error("painting: layer {0} is not there, or not behind the one before")]
    PaintedLayer(usize),
    /// A list that painted layers need has another length.
    #[error("painting: the list `{list}` has {length} entries, where there are {needed} joints")]
    PaintingList {
        /// Which list.
        list: &'static str,
        /// Its length.
        length: usize,
        /// How many joints there are.
        needed: usize,
    },
    /// A layer has a brush that isn't there, or not behind the one before.
    #[error("brushwork: layer {0} is not there, or not behind the one before")]
    BrushedLayer(usize),
    /// Where joints are along their strands is said of too few or too many, or of one by a number that is none.
    #[error(
        "brushwork: {found} of the {joints} joints say where along their strands they are: s, whole and pixels must be finite numbers of 0 or more"
    )]
    AlongStrands {
        /// How many do.
        found: usize,
        /// How many joints there are.
        joints: usize,
    },
    /// A layer for meshes has no head, or is seen through hair by no share from 0 to 1, or nothing says what sees it.
    #[error("mesh painting: layer {0} needs a head, an eye, and a share from 0 to 1")]
    MeshLayer(usize),
    /// A surface is painted by a layer that isn't there.
    #[error("surface {surface} is painted by mesh layer {layer}, and there are {layers}")]
    SurfaceLayer {
        /// Index of the surface.
        surface: usize,
        /// Its layer.
        layer: u32,
        /// How many there are.
        layers: usize,
    },
    /// What paints a surface is told too much or too little of its vertices.
    #[error(
        "surface {surface}: for each of its {vertices} vertices there must be a unit normal to paint it, and a share of shadow from 0 to 1 or none at all"
    )]
    SurfacePaint {
        /// Index of the surface.
        surface: usize,
        /// How many vertices it has.
        vertices: usize,
    },
    /// Only so many triangles can be numbered.
    #[error("{0} triangles are more than can be drawn")]
    TriangleCount(usize),
}

const DISC_RULE: &str =
    "its numbers must be finite, its radius 0 or more, its place and radius at most 1e9 pixels";
