//! Pictures with lines of the whole picture, none of which asks for colours: means are taken as of any picture, and then once more of the pixels that lines are on.

use super::light::{Light, Lines, TileLight};
use super::ribbon::{Ribbon, Search, asked};
use super::samples::runs_of_joints;
use super::tile;
use super::{DrawError, Frame, Output, Rasterizer, Worker, own_worker, picture_for};
use crate::drawing::Drawing;
use crate::edges::{Beginnings, covered};
use crate::features::Features;
use crate::picture::Picture;
use rayon::prelude::*;
use std::sync::Mutex;

/// What a band is drawn into that lines are drawn over.
pub(super) struct BandUnderLines<'a> {
    search: &'a Search<'a>,
    pixels: &'a mut [[f32; 4]],
    tiles: &'a mut [TileLight],
    /// Its outermost rows.
    rims: &'a mut Ribbon,
    /// Of each pass where its lines begin.
    found: &'a mut [Beginnings],
}

impl Rasterizer {
    /// Draws a picture whose passes ask for no colours, where all samples of a pixel are drawn at once.
    pub(super) fn draw_under_lines(&mut self, drawing: &Drawing) -> Result<Picture, DrawError> {
        let Self {
            frames,
            light,
            rims,
            spare,
            ..
        } = self;
        frames.make(drawing, |frame, workers| {
            let (mut picture, to_fill) = picture_for(drawing, frame.samples, spare)?;
            let frame = Frame {
                runs_of_joints: &runs_of_joints(drawing),
                to_fill,
                ..frame
            };
            light.make_room(drawing, &frame.stacks[0])?;
            let found = frame.draw_and_find(workers, &mut picture, light, rims);
            let lines = frame.lines(&found);
            light.draw_lines(&lines, frame.samples, drawing.background, &mut picture);
            Ok(picture)
        })
    }
}

impl Frame<'_> {
    fn search(&self) -> Search<'_> {
        Search {
            passes: &self.drawing.passes,
            stack: &self.stacks[0],
            samples: self.samples,
            height: self.drawing.size[1] as usize,
            band: tile::height(self.stacks),
            has_one_hair: {
                let runs = &self.drawing.features.runs;
                runs.iter().all(|run| run.object == runs[0].object)
            },
        }
    }

    /// Draws all bands, and finds where the lines of each pass begin in them.
    fn draw_and_find(
        &self,
        workers: &[Mutex<Worker>],
        picture: &mut Picture,
        light: &mut Light,
        rims: &mut Vec<Ribbon>,
    ) -> Vec<Vec<Beginnings>> {
        let search = self.search();
        let bands = search.height.div_ceil(search.band);
        rims.resize_with(bands, Ribbon::default);
        let nothing = || -> Vec<Beginnings> {
            let passes = search.passes.iter();
            passes.map(|_| Beginnings::default()).collect()
        };
        let width = picture.width as usize;
        let pixels = picture.pixels.par_chunks_mut(width * search.band);
        let all = pixels.zip(light.bands()).zip(&mut *rims);
        let all = all.enumerate().with_max_len(1);
        let within = all.map(|(band, ((pixels, tiles), rims))| {
            let mut found = nothing();
            let output = BandUnderLines {
                search: &search,
                pixels,
                tiles,
                rims,
                found: &mut found,
            };
            own_worker(workers).draw_band(self, band, Output::UnderLines(output));
            found
        });
        let mut found: Vec<Vec<Beginnings>> = within.collect();
        let borders = rims.par_windows(2).enumerate();
        found.par_extend(borders.map(|(band, rims)| {
            let mut found = nothing();
            let mut worker = own_worker(workers);
            self.instructions.run(
                #[inline(always)]
                || {
                    let rims = [&rims[0], &rims[1]];
                    worker.finder.find_between(&search, rims, band, &mut found);
                },
            );
            found
        }));
        found
    }

    /// The lines of each pass that begin there.
    fn lines(&self, found: &[Vec<Beginnings>]) -> Vec<Lines> {
        let passes = self.drawing.passes.iter().enumerate();
        let lines = passes.map(|(number, pass)| {
            let samples = (0..self.samples).into_par_iter();
            let of_pass = || found.iter().map(|found| &found[number]);
            let set = samples.map(|sample| covered(of_pass(), sample, self.drawing.size));
            Lines {
                set: set.collect(),
                color: pass.color,
            }
        });
        lines.collect()
    }

    /// What the ribbons tell of it.
    fn asked(&self) -> Features {
        asked(&self.drawing.passes)
    }
}

impl Worker {
    /// Draws a band and finds its lines.
    pub(super) fn draw_under_lines(&mut self, frame: &Frame, band: usize, output: BandUnderLines) {
        let [width, height] = frame.drawing.size.map(|side| side as usize);
        let tiles = width.div_ceil(tile::WIDTH);
        let stack = &frame.stacks[0];
        let top = band * tile::height(frame.stacks);
        let height = (height - top).min(tile::height(frame.stacks));
        let mut ribbon = std::mem::take(&mut self.ribbon);
        ribbon.begin(frame.asked(), width, height, stack.of_pixel);
        for tile in 0..tiles {
            let left = tile * tile::WIDTH;
            let columns = left..(left + tile::WIDTH).min(width);
            let triangles = frame.parts.triangles_of_tiles.bin(band * tiles + tile);
            if triangles.is_empty() && self.segments_of_tiles.segments(tile).is_empty() {
                frame.fill(output.pixels, columns);
                continue;
            }
            self.draw_samples_of_tile(frame, tile, triangles, [left, top]);
            frame.instructions.run(
                #[inline(always)]
                || self.tell_ribbon(frame, &columns, &mut ribbon),
            );
            self.sums.clear(tile::height(frame.stacks));
            self.add_up(frame, stack);
            self.write_means(frame, output.pixels, columns);
            let is_opaque = frame.drawing.background.is_some();
            output.tiles[tile].keep(&mut self.target, is_opaque);
        }
        ribbon.finish();
        frame.instructions.run(
            #[inline(always)]
            || {
                (self.finder).find_in(output.search, &ribbon, band, output.found);
            },
        );
        ribbon.copy_rims(output.rims);
        self.ribbon = ribbon;
    }
}
