//! Samples of a tile that layers paint.

use super::shown::{NOTHING, Planes, TRIANGLE};
use super::tile::Target;
use super::{Frame, Worker};
use crate::painting::{Beside, gather};
use effects::Samples;
use effects::wgsl::Vec3;

/// A thread's memory for painting.
#[derive(Default)]
pub(super) struct Painter {
    /// For each painted layer the samples of the tile that show it: cell and lane, and what is beside them.
    layers: Vec<(Vec<[usize; 2]>, Vec<Beside>)>,
    samples: Samples,
    colors: Vec<Vec3<f32>>,
}

impl Worker {
    /// Gives the samples of painted layers the colours that their programs say. What isn't finite stays as it was.
    pub(super) fn paint(&mut self, frame: &Frame) {
        let painting = &frame.drawing.painting;
        let Self {
            shown,
            target,
            painter,
            ..
        } = self;
        let Some(shown) = shown.planes() else {
            return;
        };
        painter.find(frame, shown, target);
        for (layer, (places, points)) in painting.layers.iter().zip(&painter.layers) {
            if points.is_empty() {
                continue;
            }
            let (samples, colors) = (&mut painter.samples, &mut painter.colors);
            gather(&painting.joints, points, layer.reads(), samples);
            colors.clear();
            layer
                .program
                .paint(samples, 0..points.len(), layer.seed, colors);
            for ([cell, lane], color) in places.iter().zip(colors.iter()) {
                let color = color.to_array();
                if color.iter().all(|light| light.is_finite()) {
                    for (plane, light) in target.color.iter_mut().zip(color) {
                        plane[*cell][*lane] = light;
                    }
                }
            }
        }
    }
}

impl Painter {
    /// Finds the samples that show painted layers.
    fn find(&mut self, frame: &Frame, shown: &Planes, target: &Target) {
        let layers = &frame.drawing.painting.layers;
        self.layers.resize_with(layers.len(), Default::default);
        for (places, points) in &mut self.layers {
            places.clear();
            points.clear();
        }
        let segments = frame.parts.segments.list();
        for (cell, lanes) in shown.what.iter().enumerate() {
            for (lane, &what) in lanes.iter().enumerate() {
                if what == NOTHING || what & TRIANGLE != 0 {
                    continue;
                }
                let segment = &segments[what as usize];
                let Some(layer) = frame.layer_of(segment) else {
                    continue;
                };
                let Ok(painted) = layers.binary_search_by_key(&layer, |painted| painted.layer)
                else {
                    continue;
                };
                let [joint, next] = segment.joints();
                let (places, points) = &mut self.layers[painted];
                places.push([cell, lane]);
                points.push(Beside {
                    joint,
                    next,
                    way: shown.way[cell][lane],
                    v: shown.v[cell][lane],
                    w: shown.w[cell][lane],
                    color: [0, 1, 2].map(|i: usize| target.color[i][cell][lane]),
                });
            }
        }
    }
}
