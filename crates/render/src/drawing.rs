//! What a rasteriser draws: strokes and surfaces on the screen, already projected.
//!
//! The screen is in pixels, x to the right and y down, (0, 0) at the picture's upper left corner;
//! pixel (i, j) covers i..i+1 by j..j+1. Depths are given as their inverse, 1/metres along the view
//! axis, because that is what runs linearly along a projected segment; larger is nearer.
//! Colours are linear light, red, green, blue.

use glam::Vec2;
use std::ops::Range;
pub use stroke_path::Brush;

/// One disc of a stroke, at a joint of its path.
///
/// Between two joints of a run, `center`, `radius` and both inverse depths run linearly: the stroke
/// is the union of all those discs, or of their halves behind the centres ([`Drawing::brush`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Centre on the screen, in pixels.
    pub center: Vec2,
    /// Radius in pixels, 0 or more.
    pub radius: f32,
    /// 1 / view depth (1/m), the stroke's depth offset applied: the order among strands.
    pub inv_depth: f32,
    /// 1 / (view depth less the clump's radius) (1/m): the order against surfaces, so that the scalp
    /// does not eat the hair that lies on it.
    pub inv_depth_biased: f32,
}

/// A connected part of one strand's path. A strand that passes through the near plane has several.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The strand's number, or of a strand that curls its piece's: what is ordered as one. All runs of a number are
    /// neighbours, and numbers never decrease.
    pub strand: u32,
    /// The joints, as a range of every per-joint list of the [`Drawing`]. One joint alone is a disc.
    pub joints: Range<usize>,
}

/// The strokes of one layer: `instances` strokes for each run that it draws on.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerStrokes {
    /// The layer's name, for messages.
    pub name: String,
    /// The joints of the drawing that it draws on, whole runs.
    pub joints: Range<usize>,
    /// Drawing order within a strand, low first; 0 is the base stroke's. Below 0 a stroke shows
    /// outside the clump; from 0 on it is clipped to the clump.
    pub rank: i32,
    /// Strokes per run (feathers); a later one lies over an earlier one.
    pub instances: usize,
    /// `discs[instance * joints.len() + joint - joints.start]`.
    pub discs: Vec<Disc>,
    /// Linear colours, parallel to `discs`; linear between joints.
    pub colors: Vec<[f32; 3]>,
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceVertex {
    /// On the screen, in pixels.
    pub position: Vec2,
    /// 1 / view depth (1/m).
    pub inv_depth: f32,
    /// The two-tone shading value times `inv_depth`: where its interpolation is 0 or more the
    /// surface is lit. Divided by depth so that it runs linearly on the screen; only its sign counts.
    pub tone: f32,
}

/// Triangles in two flat tones, drawn from both sides.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Corners.
    pub vertices: Vec<SurfaceVertex>,
    /// Indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// How much nearer than the surface a stroke must be to show before it, in metres, whatever its
    /// own bias; below 0, how much farther it may be. 0: the stroke's biased depth counts.
    ///
    /// For the head's inside, seen through an opening (an eye's, the neck's), on whose other side hair
    /// grows, and for its outline, which hair behind it must not eat.
    pub margin_m: f32,
    /// Linear colour where the tone is 0 or more.
    pub light: [f32; 3],
    /// Linear colour where the tone is below 0.
    pub shadow: [f32; 3],
}

/// Which stroke a sample shows where several cover it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// As [`StrandFirst`](Self::StrandFirst), with strokes that are round: at a sample whose distance from
    /// the axis is the part r of the radius there, a stroke lies [`Drawing::edge_depth_m`] times r^2
    /// deeper than its middle, outside of the clump times r^8.
    #[default]
    Rounded,
    /// First within a strand by rank, then among strands and surfaces by depth.
    ///
    /// Within the strand's clump the highest rank that covers the sample gives the colour (the later
    /// layer among equals, then the later instance) at the clump's depth; outside the clump only
    /// ranks below 0 show, each at its own depth. Then a strand whose biased depth lies behind a
    /// surface (or that breaks its [`Surface::margin_m`]) is dropped, and the nearest strand that is left
    /// wins (the lower number among equals). Light beyond 0 to 1 is cut in each sample.
    StrandFirst,
    /// The source's plain shift: every stroke by its own depth against every other (5.2). Among
    /// equal depths the higher rank, the later layer, the later instance, then the lower number.
    Shifted,
}

impl Order {
    /// Every order, the default first.
    pub const ALL: [Self; 3] = [Self::Rounded, Self::StrandFirst, Self::Shifted];
}

/// A strand's part, from 0 to 1, in a sample, by the strand's number and the sample's: the samples of a pixel
/// share the range evenly, and every strand in an order of its own.
#[must_use]
pub fn scatter(strand: u32, sample: u32) -> f32 {
    let mixed = (strand ^ (strand >> 16)).wrapping_mul(0x45D9_F3B5);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x2C1B_3C6D);
    // Steps of the golden section spread any number of samples evenly.
    let place = mixed.wrapping_add(sample.wrapping_mul(0x9E37_79B9));
    (place >> 8) as f32 / (1 << 24) as f32
}

impl LayerStrokes {
    /// Where the lists hold one stroke of joints that it draws on; nothing where it doesn't draw on them.
    #[must_use]
    pub fn places(&self, instance: usize, joints: &Range<usize>) -> Option<Range<usize>> {
        let is_drawn = self.joints.start <= joints.start && joints.end <= self.joints.end;
        let first = instance * self.joints.len();
        let place = |joint: usize| first + joint - self.joints.start;
        is_drawn.then(|| place(joints.start)..place(joints.end))
    }
}

/// Everything on the screen, ready to be drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The pieces of all strands, sorted by their strands' numbers.
    pub runs: Vec<Run>,
    /// The clump of each strand: one disc a joint.
    pub clump: Vec<Disc>,
    /// What the clump has to both sides where it is flat (`effects::wgsl::clump_disc`): one disc a joint for the one, then for the
    /// other; empty where no clump has any.
    pub sides: Vec<Disc>,
    /// The strokes, in the order of the objects and of their presets' layers.
    pub layers: Vec<LayerStrokes>,
    /// The heads and their outlines.
    pub surfaces: Vec<Surface>,
    /// Linear colour behind everything, or a transparent picture.
    pub background: Option<[f32; 3]>,
    /// Which stroke a sample shows.
    pub order: Order,
    /// How much deeper than its middle a stroke's edge lies in [`Order::Rounded`], in metres, 0 or more.
    pub edge_depth_m: f32,
    /// What strokes are made of.
    pub brush: Brush,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_samples_of_a_pixel_share_the_range_evenly() {
        for (strand, samples) in [(0, 4), (7, 4), (7, 16), (90_000, 64), (u32::MAX, 256)] {
            let mut parts: Vec<f32> = (0..samples).map(|s| scatter(strand, s)).collect();
            parts.sort_by(f32::total_cmp);
            assert!(parts[0] >= 0.0 && parts[samples as usize - 1] < 1.0);
            // Around the circle, whose end is its start.
            let next = parts.iter().skip(1).copied().chain([parts[0] + 1.0]);
            let gaps = parts.iter().zip(next).map(|(part, next)| next - part);
            let widest = gaps.fold(0.0, f32::max);
            assert!(
                widest < 2.0 / samples as f32,
                "{strand}, {samples}: {widest}"
            );
        }
    }

    #[test]
    fn strands_have_parts_of_their_own() {
        let mut parts: Vec<f32> = (0..1000).map(|strand| scatter(strand, 0)).collect();
        let mean = parts.iter().sum::<f32>() / 1000.0;
        assert!((mean - 0.5).abs() < 0.03, "{mean}");
        parts.sort_by(f32::total_cmp);
        parts.dedup();
        assert_eq!(parts.len(), 1000);
    }
}
