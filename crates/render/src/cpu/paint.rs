//! Samples of a tile that layers paint: gathered cell by cell into blocks, which their programs paint.

use super::mixed::{Mixed, SLOTS};
use super::shown::{Planes, TRIANGLE};
use super::tile::{LANES, LaneMask, StoreMask, Target, any, bits, select};
use super::{Frame, Worker};
use crate::painting::PaintedLayer;
use effects::Vectors;

/// A thread's memory for painting: a block of samples for each painted layer.
#[derive(Default)]
pub(super) struct Painter(Vec<Block>);

/// Samples that show one layer.
struct Block {
    /// The cells that they are of, and which samples of these.
    cells: Vec<(usize, LaneMask)>,
    mixed: Box<Mixed>,
}

impl Worker {
    /// Gives the samples of painted layers the colours that their programs say. What isn't finite stays as it was.
    #[inline(always)] // compiled for each set of `Instructions`
    pub(super) fn paint(&mut self, frame: &Frame) {
        let Some(shown) = self.shown.planes() else {
            return;
        };
        let (target, blocks) = (&mut self.target, &mut self.painter.0);
        let layers = &frame.drawing.painting.layers;
        blocks.resize_with(layers.len(), || Block {
            cells: Vec::new(),
            mixed: Box::new(Mixed::new()),
        });
        // They are empty, but where a program panicked.
        for block in blocks.iter_mut().filter(|block| !block.cells.is_empty()) {
            block.cells.clear();
            block.mixed.clear();
        }
        let segments = frame.parts.segments.list();
        for (cell, shows) in shown.what.iter().enumerate() {
            let mut left = bits(&strokes(shows));
            while left != 0 {
                let index = shows[left.trailing_zeros() as usize];
                let lanes = those_that_show(shows, index);
                left &= !bits(&lanes);
                let segment = &segments[index as usize];
                let Some(number) = frame.parts.painted_layer_of(segment) else {
                    continue;
                };
                let block = &mut blocks[number];
                if block.cells.last().is_none_or(|(last, _)| *last != cell) {
                    if block.cells.len() == SLOTS {
                        block.paint(frame, &layers[number], target);
                    }
                    block.begin(cell, shown, target);
                }
                let way = &shown.way[cell];
                block.add(frame, segment.joints(), way, &lanes);
            }
        }
        for (block, layer) in blocks.iter_mut().zip(layers) {
            block.paint(frame, layer, target);
        }
    }
}

/// The lanes that show strokes.
#[inline(always)]
fn strokes(shows: &[u32; LANES]) -> LaneMask {
    let mut lanes = *shows;
    for k in 0..LANES {
        lanes[k] = select(shows[k] < TRIANGLE, u32::MAX, 0);
    }
    lanes
}

/// The lanes that show this.
#[inline(always)]
fn those_that_show(shows: &[u32; LANES], index: u32) -> LaneMask {
    let mut lanes = *shows;
    for k in 0..LANES {
        lanes[k] = select(shows[k] == index, u32::MAX, 0);
    }
    lanes
}

impl Block {
    /// Begins with a cell.
    #[inline(always)]
    fn begin(&mut self, cell: usize, shown: &Planes, target: &Target) {
        let slot = self.cells.len();
        self.cells.push((cell, [0; LANES]));
        let samples = &mut self.mixed.samples;
        let [red, green, blue] = &target.color;
        for (numbers, plane) in [
            (&mut samples.color.x, red),
            (&mut samples.color.y, green),
            (&mut samples.color.z, blue),
            (&mut samples.v, &shown.v),
            (&mut samples.w, &shown.w),
        ] {
            numbers[slot * LANES..][..LANES].copy_from_slice(&plane[cell]);
        }
    }

    /// Adds samples of the last cell, which lie on the way from a joint to the next.
    #[inline(always)]
    fn add(&mut self, frame: &Frame, joints: [usize; 2], way: &[f32; LANES], lanes: &LaneMask) {
        let slot = self.cells.len() - 1;
        let (_, samples) = &mut self.cells[slot];
        let is_first = !any(samples);
        let rows = &frame.parts.joint_rows;
        let lanes = StoreMask::new(lanes);
        lanes.add_to(samples);
        match is_first {
            true => (self.mixed).mix::<true>(slot, rows, joints, way, &lanes),
            false => (self.mixed).mix::<false>(slot, rows, joints, way, &lanes),
        }
    }

    /// Paints the samples that were gathered, and begins anew.
    #[inline(always)]
    fn paint(&mut self, frame: &Frame, layer: &PaintedLayer, target: &mut Target) {
        if self.cells.is_empty() {
            return;
        }
        let joints = &frame.drawing.painting.joints;
        let rows = &frame.parts.joint_rows;
        self.mixed.finish(rows, joints, layer.read);
        let mut colors = Vectors::NOTHING;
        let program = &layer.program;
        program.paint_block(&self.mixed.samples, layer.seed, &mut colors);
        let colors = [colors.x, colors.y, colors.z];
        for (slot, (cell, samples)) in self.cells.drain(..).enumerate() {
            let [red, green, blue] = colors.each_ref().map(|numbers| {
                let mut lanes = [0.0; LANES];
                lanes.copy_from_slice(&numbers[slot * LANES..][..LANES]);
                lanes
            });
            let mut finite = samples;
            for k in 0..LANES {
                let is_finite = red[k].is_finite() & green[k].is_finite() & blue[k].is_finite();
                finite[k] &= select(is_finite, u32::MAX, 0);
            }
            let finite = StoreMask::new(&finite);
            for (plane, color) in target.color.iter_mut().zip([red, green, blue]) {
                finite.store(&color, &mut plane[cell]);
            }
        }
    }
}
