//! What a rasteriser draws: strokes and surfaces on the screen, already projected.
//!
//! The screen is in pixels, x to the right and y down, (0, 0) at the picture's upper left corner;
//! pixel (i, j) covers i..i+1 by j..j+1. Depths are given as their inverse, 1/metres along the view
//! axis, because that is what runs linearly along a projected segment; larger is nearer.
//! Colours are linear light, red, green, blue.

use crate::brushwork::Brushwork;
use crate::edges::Edges;
use crate::features::DrawnFeatures;
use crate::mesh_paint::{MeshPainting, SurfacePaint};
use crate::painting::Painting;
use effects::Image;
use glam::Vec2;
use std::ops::Range;
use std::sync::Arc;
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

/// Neighbouring joints on which a stroke is drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// The joints of the drawing, at least one.
    pub joints: Range<usize>,
    /// Where the first one's disc lies in the list of discs; the others' follow.
    pub first: usize,
}

/// Where the strokes of a list of discs are drawn.
///
/// Most strokes cover a small part of their strands. Lists without the rest take less time and memory, and make the same
/// picture: between two joints that both have no size nothing is drawn.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Stretches {
    /// On all joints: one disc a joint for the first stroke, then those of the next.
    #[default]
    Everywhere,
    /// For each stroke where it is drawn, by rising joints. A stretch ends with its run, or with a joint at which the stroke has
    /// tapered to nothing; it may go on from run to run, as a stroke of each.
    Within(Vec<Vec<Stretch>>),
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
    /// Where they are drawn, and so which disc is whose.
    pub stretches: Stretches,
    /// Those of all stretches; where strokes are drawn everywhere, `discs[instance * joints.len() + joint - joints.start]`.
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

/// A picture on a surface. Its four samples of a pixel that a triangle has together (all that there are, with fewer) are looked up once, in
/// the middle of all four, and no farther than the triangle's corners.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceTexture {
    /// The picture: the surface's two colours are multiplied by it.
    pub image: Arc<Image>,
    /// Whether the picture repeats beyond its edges, which else are continued.
    pub repeats: bool,
    /// For each vertex its place in the picture, 0 to 1 from left to right and from top to bottom. In the world they run linearly.
    pub places: Vec<Vec2>,
    /// What the picture's coverage means.
    pub coverage: Coverage,
}

/// What coverage means, 0 to 1: a sample shows the surface or it doesn't.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Coverage {
    /// Nothing: the surface is whole.
    #[default]
    Ignored,
    /// There is nothing where it is below this.
    Cut(f32),
    /// It is the share of a pixel's samples that show the surface.
    Share,
}

/// Triangles in two flat tones, drawn from both sides.
#[derive(Debug, Default, PartialEq)]
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
    /// The mesh that it is part of, for [`Feature::Object`](crate::Feature::Object): several surfaces may be one thing.
    pub mesh: u32,
    /// Linear colour where the tone is 0 or more.
    pub light: [f32; 3],
    /// Linear colour where the tone is below 0.
    pub shadow: [f32; 3],
    /// A picture on it; without one it is of those colours everywhere.
    pub texture: Option<SurfaceTexture>,
    /// What paints its samples; without it they are of those colours by the tone.
    pub paint: Option<SurfacePaint>,
    /// What it is to decals, a bit for each mark: it is drawn on by those that have one of them ([`Decal::marks`]).
    pub marks: u32,
}

/// A layer whose strokes are drawn on what is seen without them, and nowhere else.
///
/// They are no part of the order of strokes. A segment of such a stroke fits a sample that it covers where what is seen there, had the drawing
/// no decals, is one of those that it is drawn on, and lies at most [`shown_reach`] of `reach_m` before or behind the segment's axis point of least
/// distance over radius. Of those that fit the highest stroke (by rank, layer, instance) gives its colour, of these the lowest strand, then the
/// segment whose axis point is the nearest. What samples tell beside their colour stays that of what is drawn on.
#[derive(Clone, Debug, PartialEq)]
pub struct Decal {
    /// Its index in [`Drawing::layers`].
    pub layer: usize,
    /// Whether it is drawn on hair.
    pub on_hair: bool,
    /// The surfaces that it is drawn on: those that have one of these marks.
    pub marks: u32,
    /// Metres, 0 or more. Half as far and nearer every sample shows it, beyond none.
    pub reach_m: f32,
    /// Whether its strokes are shadows. All of `reach_m` counts in every sample of these: they fit surfaces that are at most `reach_m` before them, or any way behind, and hair of other strands
    /// that is more than `reach_m` behind them, but not its outlines (strokes of negative rank), which keep their ink. A surface shows its own colour in shadow there; a painted one lies in shadow whatever the
    /// light.
    pub is_shadow: bool,
}

/// The part of a decal's reach within which a sample shows it: half of it in the first of a pixel's samples, and more in each of the others, so that a
/// stroke that moves out of reach fades where an edge in depth would make it jump. 0.75 where a pixel has one sample.
#[must_use]
pub fn shown_reach(sample: u32, samples: u32) -> f32 {
    let part = if samples == 1 {
        0.5
    } else {
        scatter(0, sample)
    };
    0.5 + 0.5 * part
}

impl Decal {
    /// Whether it is drawn on a surface.
    #[must_use]
    pub fn is_on(&self, surface: &Surface) -> bool {
        self.marks & surface.marks != 0
    }
}

impl Clone for Surface {
    fn clone(&self) -> Self {
        let mut surface = Self::default();
        surface.clone_from(self);
        surface
    }

    /// In the memory that there is: frames come one after the other.
    fn clone_from(&mut self, source: &Self) {
        let Self {
            vertices,
            triangles,
            margin_m,
            mesh,
            marks,
            light,
            shadow,
            texture,
            paint,
        } = source;
        self.vertices.clone_from(vertices);
        self.triangles.clone_from(triangles);
        (self.margin_m, self.mesh, self.marks) = (*margin_m, *mesh, *marks);
        (self.light, self.shadow) = (*light, *shadow);
        match (&mut self.texture, texture) {
            (Some(own), Some(texture)) => {
                own.image.clone_from(&texture.image);
                (own.repeats, own.coverage) = (texture.repeats, texture.coverage);
                own.places.clone_from(&texture.places);
            }
            (own, texture) => own.clone_from(texture),
        }
        match (&mut self.paint, paint) {
            (Some(own), Some(paint)) => {
                own.layer = paint.layer;
                own.normals.clone_from(&paint.normals);
                own.occlusion.clone_from(&paint.occlusion);
            }
            (own, paint) => own.clone_from(paint),
        }
    }
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

impl Stretch {
    /// Where the discs lie in their list.
    #[must_use]
    pub fn places(&self) -> Range<usize> {
        self.first..self.first + self.joints.len()
    }
}

impl Stretches {
    /// The parts of stroke `instance` that lie on the joints of `run`, by rising joints. The list has the discs of the joints `all`.
    pub fn on(
        &self,
        instance: usize,
        all: &Range<usize>,
        run: &Range<usize>,
    ) -> impl Iterator<Item = Stretch> + use<'_> {
        let (whole, within) = match self {
            Self::Everywhere => {
                let is_drawn = all.start <= run.start && run.end <= all.end;
                let whole = is_drawn.then(|| Stretch {
                    joints: all.clone(),
                    first: instance * all.len(),
                });
                (whole, &[][..])
            }
            Self::Within(stretches) => {
                let of_stroke = stretches.get(instance).map_or(&[][..], |list| &list[..]);
                let first = of_stroke.partition_point(|stretch| stretch.joints.end <= run.start);
                (None, &of_stroke[first..])
            }
        };
        let run = run.clone();
        let parts = whole.into_iter().chain(within.iter().cloned());
        parts
            .take_while(move |stretch| stretch.joints.start < run.end)
            .map(move |Stretch { joints, first }| {
                let start = joints.start.max(run.start);
                Stretch {
                    first: first + start - joints.start,
                    joints: start..joints.end.min(run.end),
                }
            })
    }
}

impl LayerStrokes {
    /// The parts of one stroke that lie on the joints of `run`, by rising joints; nothing where the layer doesn't draw there.
    pub fn on(
        &self,
        instance: usize,
        run: &Range<usize>,
    ) -> impl Iterator<Item = Stretch> + use<'_> {
        self.stretches.on(instance, &self.joints, run)
    }
}

impl Drawing {
    /// What a layer is as a decal, if it is one.
    #[must_use]
    pub fn decal(&self, layer: usize) -> Option<&Decal> {
        self.decals.iter().find(|decal| decal.layer == layer)
    }

    /// A number that pieces of one strand have in common, by the number of one of them ([`Run::strand`]).
    #[inline]
    #[must_use]
    pub fn whole_strand(&self, strand: u32) -> u32 {
        let whole = self.same_strands.get(strand as usize);
        whole.copied().unwrap_or(strand)
    }

    /// The parts of one of the clump's sides, 0 or 1, that lie on the joints of `run`, by rising joints.
    pub fn side_on(
        &self,
        side: usize,
        run: &Range<usize>,
    ) -> impl Iterator<Item = Stretch> + use<'_> {
        let joints = if self.sides.is_empty() {
            0
        } else {
            self.clump.len()
        };
        self.side_stretches.on(side, &(0..joints), run)
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
    /// What the clump has to both sides where it is flat (`effects::wgsl::clump_disc`): discs of the one, then of the other; empty
    /// where no clump has any.
    pub sides: Vec<Disc>,
    /// Where the two sides are drawn.
    pub side_stretches: Stretches,
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
    /// What samples tell beside their colour.
    pub features: DrawnFeatures,
    /// Layers that are decals, by rising index.
    pub decals: Vec<Decal>,
    /// For each strand's number, of runs, which others are the same strand: those of an equal number here. Empty where each is its own. A strand
    /// casts no shadow on itself.
    pub same_strands: Vec<u32>,
    /// Layers that have a brush.
    pub brushwork: Brushwork,
    /// Layers whose samples are painted.
    pub painting: Painting,
    /// Layers that paint surfaces.
    pub mesh_painting: MeshPainting,
    /// What is done with the samples of the whole picture, one after the other, before their means are taken. What they need is to be
    /// declared by the features.
    pub passes: Vec<Edges>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_cut_at_the_ends_of_a_run() {
        let stretch = |joints, first| Stretch { joints, first };
        let all = 10..30;
        let everywhere = Stretches::Everywhere;
        let on = |list: &Stretches, instance, run| -> Vec<Stretch> {
            list.on(instance, &all, &run).collect()
        };
        assert_eq!(on(&everywhere, 1, 12..15), [stretch(12..15, 22)]);
        assert_eq!(on(&everywhere, 0, 5..9), [], "not drawn there");
        let within = Stretches::Within(vec![
            vec![],
            vec![stretch(10..14, 7), stretch(16..17, 11), stretch(20..25, 12)],
        ]);
        assert_eq!(on(&within, 0, 10..30), []);
        assert_eq!(on(&within, 2, 10..30), []);
        assert_eq!(
            on(&within, 1, 12..22),
            [stretch(12..14, 9), stretch(16..17, 11), stretch(20..22, 12)]
        );
        assert_eq!(on(&within, 1, 14..16), []);
        assert_eq!(on(&within, 1, 24..30), [stretch(24..25, 16)]);
    }

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
