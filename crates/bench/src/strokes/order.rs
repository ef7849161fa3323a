//! The order in which a painter lays strokes over each other.

use render::{Drawing, Run};
use std::ops::Range;

/// A piece of a stroke: one instance of a layer along a stretch of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Index of the layer.
    pub layer: usize,
    /// Which of the layer's strokes.
    pub instance: usize,
    /// The places of its discs and colours in its layer's lists.
    pub places: Range<usize>,
}

/// All pieces of a drawing, the one that lies lowest first: strands from the far one to the near one
/// by the mean inverse depth of their clumps (the lower id lies over its equals), in a strand its
/// strokes by rank, layer and instance.
#[must_use]
pub fn painters_order(drawing: &Drawing) -> Vec<Piece> {
    let mut strands: Vec<(f64, &[Run])> = drawing
        .runs
        .chunk_by(|a, b| a.strand == b.strand)
        .map(|runs| (mean_inv_depth(drawing, runs), runs))
        .rev()
        .collect();
    strands.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut layers: Vec<usize> = (0..drawing.layers.len()).collect();
    layers.sort_by_key(|&layer| drawing.layers[layer].rank);

    let mut pieces = Vec::new();
    for (_, runs) in strands {
        for &layer in &layers {
            let strokes = &drawing.layers[layer];
            for instance in 0..strokes.instances {
                let on = |run: &Run| strokes.on(instance, &run.joints);
                pieces.extend(runs.iter().flat_map(on).map(|stretch| Piece {
                    layer,
                    instance,
                    places: stretch.places(),
                }));
            }
        }
    }
    pieces
}

fn mean_inv_depth(drawing: &Drawing, runs: &[Run]) -> f64 {
    let discs = runs
        .iter()
        .flat_map(|run| &drawing.clump[run.joints.clone()]);
    let (sum, count) = discs.fold((0.0, 0.0), |(sum, count), disc| {
        (sum + f64::from(disc.inv_depth), count + 1.0)
    });
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;
    use render::{Disc, LayerStrokes, Stretches};

    #[test]
    fn far_strands_first_then_by_rank_layer_and_instance() {
        // Strands 3, 5 and 9 of two joints each; strand 5 in two runs of one joint. The second is the
        // farthest; the first and the last are as near.
        let depths = [2.0, 2.0, 0.5, 1.5, 1.0, 3.0];
        let discs: Vec<Disc> = depths
            .map(|inv_depth| Disc {
                center: Vec2::ZERO,
                radius: 1.0,
                inv_depth,
                inv_depth_biased: inv_depth,
            })
            .to_vec();
        let layer = |rank, instances| LayerStrokes {
            name: String::new(),
            joints: 0..6,
            rank,
            instances,
            stretches: Stretches::Everywhere,
            discs: discs.repeat(instances),
            colors: vec![[0.0; 3]; 6 * instances],
        };
        let run = |strand, joints| Run { strand, joints };
        let drawing = Drawing {
            runs: vec![run(3, 0..2), run(5, 2..3), run(5, 3..4), run(9, 4..6)],
            clump: discs.clone(),
            layers: vec![layer(1, 2), layer(0, 1), layer(1, 1), layer(-1, 1)],
            ..Drawing::default()
        };
        let pieces = painters_order(&drawing);
        let strokes = [(3, 0), (1, 0), (0, 0), (0, 1), (2, 0)];
        let mut expected = Vec::new();
        // Strand 9's mean of 2 is strand 3's too.
        let far_to_near = [1..3, 3..4, 0..1].map(|runs| &drawing.runs[runs]);
        for runs in far_to_near {
            for (layer, instance) in strokes {
                let of_layer = 6 * instance;
                expected.extend(runs.iter().map(|run| Piece {
                    layer,
                    instance,
                    places: of_layer + run.joints.start..of_layer + run.joints.end,
                }));
            }
        }
        assert_eq!(pieces, expected);
    }
}
