//! Layers whose strokes leave some of what they reach bare: their brushes, and where along its strand each joint is.

use crate::frame::{Frame, Object};
use effects::{BrushTexture, StrandBrush, layer_seed, strand_seed};
use std::sync::Arc;

/// What brushes leave of strokes. By default there are none, and strokes are whole.
///
/// A sample that a stroke reaches is covered where the brush's coverage at its place exceeds the part ([`scatter`](crate::scatter)) that the strand
/// has in that sample, of pictures with one sample a pixel one half. Its place is that of the axis point that gives its colour to the first of the pixel's
/// samples, of four that follow each other, which the stroke reaches: a brush is blurred over a pixel, so that it is as good as the place of each, and looked up a
/// quarter as often. What isn't covered is as if the stroke weren't there: it shows what is beneath, and hides nothing. But strokes of ranks below 0 stay outlines: they don't show within the
/// clump where one that is clipped to it is left bare, but in [`Order::Shifted`](crate::Order::Shifted), where each stroke is by itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Brushwork {
    /// The layers, by rising index.
    pub layers: Vec<BrushedLayer>,
    /// Parallel to [`Drawing::clump`](crate::Drawing::clump); empty without layers.
    pub joints: Vec<AlongStrand>,
}

/// A layer that has a brush.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushedLayer {
    /// Its index in [`Drawing::layers`](crate::Drawing::layers).
    pub layer: usize,
    /// What the brush leaves.
    pub brush: Arc<BrushTexture>,
    /// The layer's seed.
    pub seed: u32,
}

/// Where along its strand a joint is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AlongStrand {
    /// Length of the strand up to there, head heights.
    pub s: f32,
    /// Length of the whole strand, head heights.
    pub whole: f32,
    /// Pixels that a head's height takes there.
    pub pixels: f32,
    /// The strand's stable id.
    pub strand: u32,
}

impl AlongStrand {
    /// Whether its numbers are finite, and its lengths 0 or more.
    pub(crate) fn is_valid(&self) -> bool {
        let is_length = |number: f32| (0.0..=f32::MAX).contains(&number);
        is_length(self.s) && is_length(self.whole) && is_length(self.pixels)
    }
}

impl BrushedLayer {
    /// The seed of one of the layer's strokes on a strand.
    #[inline]
    pub(crate) fn stroke_seed(&self, instance: usize, strand: u32) -> u32 {
        strand_seed(self.seed.wrapping_add(instance as u32), strand)
    }

    /// What of the brush a stroke of that seed has.
    #[inline]
    pub(crate) fn of_stroke(&self, seed: u32) -> StrandBrush<'_> {
        self.brush.of_strand(seed)
    }
}

impl Brushwork {
    /// Whether all strokes are whole.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    /// A layer's brush, if it has one.
    #[must_use]
    pub fn of_layer(&self, layer: usize) -> Option<&BrushedLayer> {
        self.layers.iter().find(|brushed| brushed.layer == layer)
    }

    /// Takes on what a checked frame says, in place of what was there.
    pub(crate) fn fill(&mut self, frame: &Frame) {
        self.layers.clear();
        self.joints.clear();
        let layers = frame.objects.iter().flat_map(|object| {
            let layers = object.layers.iter();
            layers.map(|layer| (layer, object.seed))
        });
        for (index, (layer, seed)) in layers.enumerate() {
            if let Some(brush) = &layer.brush {
                self.layers.push(BrushedLayer {
                    layer: index,
                    brush: brush.clone(),
                    seed: layer_seed(seed, &layer.name),
                });
            }
        }
        if !self.is_empty() {
            self.fill_joints(frame);
        }
    }

    fn fill_joints(&mut self, frame: &Frame) {
        let paths = frame.paths;
        let (runs, mut objects) = (&paths.runs, frame.objects.iter());
        let mut object: Option<&Object> = objects.next();
        self.joints.resize(paths.len(), AlongStrand::default());
        let mut first = 0;
        while first < runs.len() {
            // Of one path are runs along which `u` goes on rising, whether the near plane cut it or it is in pieces.
            let strand = runs[first].strand;
            let mut end = first + 1;
            let u_at = |joint: usize| paths.u[joint];
            while runs.get(end).is_some_and(|run| {
                let before = &runs[end - 1];
                let goes_on = u_at(run.joints.end - 1) > u_at(before.joints.end - 1);
                run.strand == strand && (run.overlap > 0 || goes_on && u_at(run.joints.start) > 0.0)
            }) {
                end += 1;
            }
            let last = runs[end - 1].joints.end - 1;
            while object.is_some_and(|object| object.joints.end <= last) {
                object = objects.next();
            }
            let height_m = object.map_or(1.0, |object| object.head.height_m);
            // Of a strand whose tip isn't seen about as long as it must be.
            let whole = match paths.u[last] {
                u if u > 0.0 => paths.arc_length[last] / u.min(1.0),
                _ => paths.arc_length[last],
            };
            for run in &runs[first..end] {
                for joint in run.joints.clone() {
                    self.joints[joint] = AlongStrand {
                        s: match frame.marks.get(joint) {
                            Some(mark) if *mark >= 0.0 => *mark,
                            _ => paths.arc_length[joint] / height_m,
                        },
                        whole: whole / height_m,
                        pixels: paths.px_per_metre[joint] * height_m,
                        strand: frame.strands[strand].id,
                    };
                }
            }
            first = end;
        }
    }
}
