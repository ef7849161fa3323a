//! Pictures of which each sample tells what it shows: eight samples of each pixel at a time.

use super::tile;
use super::{DrawError, Frame, Output, Rasterizer, Worker, empty_picture, own_worker};
use crate::check;
use crate::drawing::Drawing;
use crate::edges::{EdgeChannel, Edges};
use crate::features::Features;
use crate::picture::Picture;
use crate::planes::{BandPlanes, SamplePlanes};
use rayon::prelude::*;
use std::sync::Mutex;

impl Rasterizer {
    /// Draws the samples of a picture, each with the features that the drawing declares: up to eight of every pixel at a time, which
    /// `take` is given, from the first to the last.
    ///
    /// They are those that [`Self::draw`] takes the means of. `planes` is working memory.
    ///
    /// # Errors
    ///
    /// When the drawing is invalid (see [`DrawError`]), or there isn't enough memory.
    pub fn draw_samples(
        &mut self,
        drawing: &Drawing,
        planes: &mut SamplePlanes,
        mut take: impl FnMut(&mut SamplePlanes) + Send,
    ) -> Result<(), DrawError> {
        self.give_samples(drawing, planes, &mut take)
    }

    /// [`Self::draw_samples`]. It is compiled once, with this crate: else the whole rasteriser would be in each crate that calls it, and as slow there as
    /// that one is built.
    fn give_samples(
        &mut self,
        drawing: &Drawing,
        planes: &mut SamplePlanes,
        take: &mut (dyn FnMut(&mut SamplePlanes) + Send),
    ) -> Result<(), DrawError> {
        self.frames.make(drawing, |frame, workers| {
            let runs_of_joints = runs_of_joints(drawing);
            let mut first = 0;
            for stack in frame.stacks {
                let of_stack = Frame {
                    stacks: std::slice::from_ref(stack),
                    runs_of_joints: &runs_of_joints,
                    ..frame
                };
                of_stack.make_room(planes, drawing.features.declared, first)?;
                first += planes.samples().len();
                of_stack.draw_bands(workers, planes);
                take(planes);
            }
            Ok(())
        })
    }
}

impl Rasterizer {
    /// Draws a picture whose passes go over all its samples before their means are taken.
    pub(super) fn draw_with_passes(&mut self, drawing: &Drawing) -> Result<Picture, DrawError> {
        let reads_colors = |pass: &Edges| pass.channel == EdgeChannel::Color;
        if self.frames.stacks.len() == 1 && !drawing.passes.iter().any(reads_colors) {
            return self.draw_under_lines(drawing);
        }
        check::check(drawing)?;
        let samples = self.frames.samples;
        let mut picture = empty_picture(drawing, samples)?;
        let mut planes = std::mem::take(&mut self.planes);
        let drawn = self.draw_samples(drawing, &mut planes, |planes| {
            for pass in &drawing.passes {
                pass.draw(planes, samples);
            }
            planes.add_to(&mut picture.pixels, samples);
        });
        self.planes = planes;
        drawn?;
        Ok(picture)
    }
}

impl Frame<'_> {
    /// Makes room for what the samples of its stack tell, before which a pixel has so many.
    fn make_room(
        &self,
        planes: &mut SamplePlanes,
        declared: Features,
        first: usize,
    ) -> Result<(), DrawError> {
        let stack = &self.stacks[0];
        let (count, band) = (stack.samples, tile::height(self.stacks));
        let size = self.drawing.size;
        let room = planes.make_room(size, declared, [first, count], band);
        room.ok_or(DrawError::Memory(size[0], size[1]))
    }

    /// Draws the samples of its stack into planes with room for them.
    fn draw_bands(&self, workers: &[Mutex<Worker>], planes: &mut SamplePlanes) {
        let (layout, count) = (planes.layout, planes.samples().len());
        let (width, band) = (self.drawing.size[0] as usize, tile::height(self.stacks));
        let [of_ids, of_numbers] = planes.of_band();
        let ids = planes.ids.par_chunks_mut(of_ids);
        let bands = ids.zip(planes.numbers.par_chunks_mut(of_numbers));
        let bands = bands.map(|(ids, numbers)| BandPlanes {
            width,
            layout,
            band,
            count,
            ids,
            numbers,
        });
        let bands = bands.enumerate().with_max_len(1);
        bands.for_each(|(band, planes)| {
            let mut worker = own_worker(workers);
            worker.draw_band(self, band, Output::Samples(planes));
        });
    }
}

/// For each joint of a checked drawing its run.
pub(super) fn runs_of_joints(drawing: &Drawing) -> Vec<u32> {
    let mut runs_of_joints = vec![0; drawing.clump.len()];
    for (run, number) in drawing.runs.iter().zip(0..) {
        runs_of_joints[run.joints.clone()].fill(number);
    }
    runs_of_joints
}

impl Worker {
    /// Draws the samples of a band.
    pub(super) fn draw_samples(&mut self, frame: &Frame, band: usize, mut planes: BandPlanes) {
        let [width, height] = frame.drawing.size.map(|side| side as usize);
        let tiles = width.div_ceil(tile::WIDTH);
        let top = band * tile::height(frame.stacks);
        // Tiles of nothing are written together, as rows as long as may be.
        let mut nothing = 0..0;
        for tile in 0..tiles {
            let left = tile * tile::WIDTH;
            let triangles = frame.parts.triangles_of_tiles.bin(band * tiles + tile);
            let segments = self.segments_of_tiles.segments(tile);
            let size = [(width - left).min(tile::WIDTH), height - top];
            if triangles.is_empty() && segments.is_empty() {
                nothing.end = left + size[0];
                continue;
            }
            planes.clear(nothing, height - top, frame.drawing.background);
            nothing = left + size[0]..left + size[0];
            self.draw_samples_of_tile(frame, tile, triangles, [left, top]);
            frame.instructions.run(
                #[inline(always)]
                || self.tell(frame, size, left, &mut planes),
            );
        }
        planes.clear(nothing, height - top, frame.drawing.background);
    }
}
