//! A frame: everything that a backend needs to make strokes and draw them.

mod check;

pub use check::FrameError;
pub use effects::Light;

use crate::drawing::{Decal, Order, Surface};
use crate::edges::Edges;
use crate::features::Features;
use crate::mesh_paint::MeshLayer;
use effects::{InputSet, Layer, Reach, Varied, clump};
use glam::{Vec2, Vec3};
use std::ops::Range;
use stroke_path::{Brush, Camera, Paths};

/// What is the same for all joints of a strand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrandInfo {
    /// Stable id, which its variations hang on.
    pub id: u32,
    /// Mean of the strand's particles, metres (c_mean in Fig 5.4a).
    pub mean: Vec3,
    /// Full size of its clump, 1/300 of the head's height.
    pub size: f32,
    /// Its own size at the root and start of shrinking (x in 5.1), both 0 to 1, in place of the clump section's; below 0 the
    /// section's: [`NO_TAPER`].
    pub taper: Vec2,
    /// Its own colours at root and tip, linear, in place of the clump section's; below 0 the section's: [`NO_COLOR`].
    pub colors: [Vec3; 2],
    /// Its level, 0 the lowest: what is of a higher one lies on top.
    pub level: u32,
    /// How much nearer than it is the strand is ordered among strands, head heights; against surfaces it counts nothing.
    pub lift: f32,
    /// Which of its object's layers leave it out, a bit each: bit `i` for layer `i`. From the 33rd on all draw on it.
    pub left_out_by: u32,
}

impl StrandInfo {
    /// Whether a layer of its object leaves it out, by the layer's number there.
    #[must_use]
    pub fn is_left_out_by(&self, layer: usize) -> bool {
        layer_bit(layer) & self.left_out_by != 0
    }
}

/// The bit of a layer in [`StrandInfo::left_out_by`], none from the 33rd on.
pub(crate) fn layer_bit(layer: usize) -> u32 {
    u32::try_from(layer).map_or(0, |layer| 1_u32.checked_shl(layer).unwrap_or(0))
}

/// The colour of a strand that has none of its own.
pub const NO_COLOR: Vec3 = Vec3::NEG_ONE;

/// The taper of a strand that has none of its own.
pub const NO_TAPER: Vec2 = Vec2::NEG_ONE;

/// Where the head is, and the measure of all sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// Centre, metres (c_head).
    pub center: Vec3,
    /// Height in metres, above 0.
    pub height_m: f32,
}

impl Head {
    /// Metres in one unit of size, 1/300 of the head's height.
    #[must_use]
    pub fn unit_m(&self) -> f32 {
        self.height_m / 300.0
    }
}

/// Distance that effects are told for a light without a place, in head heights.
pub(crate) const FAR_LIGHT: f32 = 1e6;

/// One frame.
pub struct Frame<'a> {
    /// The eye.
    pub camera: &'a Camera,
    /// The strands' paths on the screen, object after object.
    pub paths: &'a Paths,
    /// What is known of each strand; `paths.runs[i].strand` is an index of this list.
    pub strands: &'a [StrandInfo],
    /// What is drawn along the paths.
    pub objects: Vec<Object<'a>>,
    /// The light.
    pub light: Light,
    /// Time of the scene in seconds, for effects that read it.
    pub time_s: f32,
    /// The material normal of each joint of `paths`; empty where neither a clump nor a layer reads it.
    pub material_normals: &'a [Vec3],
    /// Where the hair of each joint of `paths` is at rest, head heights from its head's centre, in the head's axes: x to its left, y up, z to
    /// the face; empty where neither a clump nor a layer reads it.
    pub rest_positions: &'a [Vec3],
    /// Unit vectors along the hair at each joint of `paths` at rest, in the same axes, or 0 where it is at rest nowhere; empty where neither a clump nor
    /// a layer reads it.
    pub rest_forwards: &'a [Vec3],
    /// How far each joint of `paths` is from the first and the last one of its strand, as [`from_ends`] says it; empty where neither a clump nor
    /// a layer reads it.
    pub from_ends: &'a [Vec2],
    /// How much of its path is there at each joint of `paths`, 0 or more: of those that effects made as they say it, of others 1; empty where
    /// neither a clump nor a layer reads it.
    pub path_weights: &'a [f32],
    /// How far along the marks of its layers' brushes each joint of `paths` is, head heights, where these stay on something else than the strand: as
    /// lines of surfaces begin elsewhere in each frame. Below 0, or empty, it is the strand's length up to there.
    pub marks: &'a [f32],
    /// The heads' surfaces on the screen.
    pub surfaces: Vec<Surface>,
    /// Layers that paint surfaces, which name them by their places here ([`Surface::paint`]).
    pub mesh_layers: Vec<MeshLayer<'a>>,
    /// What layers with `clip` ([`Layer::is_decal`]) are drawn on, in the order of the objects and of their layers.
    pub decals: Vec<Decal>,
    /// Linear colour behind everything, or a transparent picture.
    pub background: Option<[f32; 3]>,
    /// Which stroke a sample shows.
    pub order: Order,
    /// How much deeper than its middle a stroke's edge lies in [`Order::Rounded`], in metres, 0 or more.
    pub edge_depth_m: f32,
    /// What strokes are made of.
    pub brush: Brush,
    /// What samples tell beside their colour; a picture alone needs none of it.
    pub features: Features,
    /// How much normals of hair are those of a round tube, for [`Feature::Normal`](crate::Feature::Normal): 0 the clump's, 1 the
    /// tube's.
    pub roundness: f32,
    /// What is done with the samples of the whole picture, one after the other, before their means are taken.
    pub passes: Vec<Edges>,
}

impl Frame<'_> {
    /// What its samples tell: what is declared, and what its passes need.
    #[must_use]
    pub fn all_features(&self) -> Features {
        let of_passes = self.passes.iter().map(Edges::features);
        of_passes.fold(self.features, Features::union)
    }
}

/// A ball in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its middle, metres.
    pub center: Vec3,
    /// Metres, above 0.
    pub radius_m: f32,
}

/// How far a clump and its sides reach from its middle at most.
pub const CLUMP_REACH: Reach = Reach {
    clumps: 2.0,
    units: 0.0,
};

/// How far a layer's strokes reach as they are drawn: tips of half discs are moved on by what they are wider than their clumps.
#[must_use]
pub fn reach_of(layer: &Layer, brush: Brush) -> Reach {
    let Reach { clumps, units } = layer.program.reach();
    match brush {
        Brush::Circle => Reach { clumps, units },
        Brush::Semicircle => Reach {
            clumps: 2.0 * clumps,
            units: 2.0 * units,
        },
    }
}

/// The bias of lines on surfaces, what hides them being left out beforehand: no surface is before them, metres.
pub const ON_SURFACES: f32 = 1e9;

/// Hair on a head, or lines on a surface, and how they are drawn.
#[derive(Clone)]
pub struct Object<'a> {
    /// Its joints of the frame's paths: those of its strands, then those of paths that its effects made. They are whole runs, and
    /// those of an object follow those of the one before, from the paths' first joint to their last.
    pub joints: Range<usize>,
    /// The head.
    pub head: Head,
    /// A ball within the head, so that a surface of the frame covers each sight through it: strokes behind it aren't worked out.
    /// None where no such ball is known.
    pub solid: Option<Ball>,
    /// How much nearer its strands count against surfaces than they are, metres, beside their clumps' radii: 0 of hair, [`ON_SURFACES`] of lines
    /// that lie on surfaces.
    pub surface_bias_m: f32,
    /// Its preset's clump section.
    pub clump: &'a Varied<clump::Program>,
    /// Seed of its style's variations.
    pub seed: u32,
    /// The layers that are on, in its preset's order.
    pub layers: &'a [Layer],
    /// For each layer those of `joints` that it draws on, whole runs: the strands', or those of paths that its effect made.
    /// No joint is on two layers' own paths.
    pub layer_joints: &'a [Range<usize>],
}

impl Object<'_> {
    /// What its clump and its layers read of joints.
    pub(crate) fn inputs(&self) -> InputSet {
        let layers = self.layers.iter().map(|layer| layer.program.inputs());
        layers.fold(self.clump.inputs(), InputSet::union)
    }
}

/// For each joint how far it is from the first and to the last joint of its strand as they are seen, metres at its depth, in place of what
/// was there. Where the near plane cuts a strand in two, each part has its own ends.
pub fn from_ends(paths: &Paths, ends: &mut Vec<Vec2>) {
    let mut lengths = Vec::new();
    seen_lengths(paths, &mut lengths);
    ends.clear();
    ends.extend(lengths.iter().map(|&length| Vec2::new(length, 0.0)));
    for whole in paths.runs.chunk_by(|_, next| next.overlap > 0) {
        let joints = whole[0].joints.start..whole[whole.len() - 1].joints.end;
        let length = lengths[joints.end - 1];
        for end in &mut ends[joints] {
            end.y = (length - end.x).max(0.0);
        }
    }
}

/// For each joint the length of its run up to there as it is seen, metres at its depth, in place of what was there. Pieces of a
/// strand count on.
pub(crate) fn seen_lengths(paths: &Paths, lengths: &mut Vec<f32>) {
    lengths.clear();
    for run in &paths.runs {
        // What the piece before has too is as far.
        let mut length = match run.overlap {
            0 => 0.0,
            overlap => lengths[run.joints.start - overlap],
        };
        for i in run.joints.clone() {
            if i > run.joints.start {
                let scale = 0.5 * (paths.px_per_metre[i] + paths.px_per_metre[i - 1]);
                length += paths.center[i].distance(paths.center[i - 1]) / scale;
            }
            lengths.push(length);
        }
    }
}

/// Which pieces are the same strand, where shadows ask for it.
pub(crate) fn fill_same_strands(frame: &Frame, same_strands: &mut Vec<u32>) {
    same_strands.clear();
    if frame.decals.iter().any(|decal| decal.is_shadow) {
        for run in &frame.paths.runs {
            same_strands.resize(run.piece + 1, 0);
            same_strands[run.piece] = run.strand as u32;
        }
    }
}
