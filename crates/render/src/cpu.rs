//! The exact rasteriser: no driver, any number of samples, the same bits on any machine.
//!
//! A drawing is checked ([`DrawError`]) and taken apart into segments, some strands at a time in parallel, which are
//! sorted into bands of tile rows and these into tiles. Bands are drawn in parallel; every band sees its segments in the
//! same order, so threads can't change a bit. In a tile (see `tile`) come first the surfaces, then
//! strand after strand from the nearest on. Where a strand may show, its segments get their shapes (`segment`) and what they
//! cover (`rows`); then comes the strand's own order (`strand`), and cell by cell, eight samples at once, its depth
//! (`stroke`) against what is there, and the colour of what shows.
//! All of a band is compiled for several instruction sets (`instructions`); what is called there is
//! `inline(always)`, or it would be compiled without them.

mod bin;
mod evaluate;
mod instructions;
mod rows;
mod seen;
mod segment;
mod stamp;
mod strand;
mod stroke;
mod surface;
mod tile;

#[cfg(test)]
mod tests;

pub use crate::check::{DrawError, MAX_COORDINATE, MAX_SIZE};
pub use evaluate::Evaluator;
pub use stamp::Stamper;

use crate::check;
use crate::drawing::Drawing;
use crate::picture::Picture;
use crate::samples::{SampleCountError, sample_positions};
use bin::{Bins, cells};
use instructions::Instructions;
use rayon::prelude::*;
use segment::{Segments, Stroke};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use strand::{Part, StrandMasks, TileContext};
use surface::Triangle;
use tile::{Stack, Sums, Target};

/// Most threads of a rasteriser.
pub const MAX_THREADS: usize = 1024;

/// Why there is no rasteriser.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RasterizerError {
    /// No such number of samples.
    #[error(transparent)]
    Samples(#[from] SampleCountError),
    /// No such number of threads.
    #[error("{0} threads: 1 to {MAX_THREADS} are possible")]
    Threads(usize),
    /// The system gave no threads.
    #[error("threads could not be started")]
    Pool(#[from] rayon::ThreadPoolBuildError),
}

/// Draws [`Drawing`]s. Keeps its threads and its memory from picture to picture.
pub struct Rasterizer {
    /// Its own threads, or none where it draws on the caller's.
    pool: Option<rayon::ThreadPool>,
    /// In a pixel.
    samples: usize,
    stacks: Vec<Stack>,
    parts: Parts,
    instructions: Instructions,
    /// One for each thread, once it has drawn.
    workers: Vec<Mutex<Worker>>,
}

/// What the drawing is taken apart into.
#[derive(Default)]
struct Parts {
    segments: Segments,
    triangles: Vec<Triangle>,
    triangles_of_tiles: Bins,
}

impl Rasterizer {
    /// A rasteriser with that many samples in a pixel ([`sample_positions`]) and that many threads of its
    /// own. With `None` it draws on the caller's: those of the rayon pool that [`Self::draw`] is called
    /// in, so that a program needs one pool for all that it does.
    ///
    /// # Errors
    ///
    /// When there is no such number of samples or threads.
    pub fn new(samples: u32, threads: Option<usize>) -> Result<Self, RasterizerError> {
        let samples = sample_positions(samples)?;
        if let Some(threads) = threads.filter(|t| !(1..=MAX_THREADS).contains(t)) {
            return Err(RasterizerError::Threads(threads));
        }
        let own_pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = threads.map(own_pool).transpose()?;
        let available = Instructions::available();
        Ok(Self {
            pool,
            samples: samples.len(),
            stacks: Stack::of_pixel(&samples),
            instructions: *available.last().unwrap_or(&Instructions::Compiled),
            parts: Parts::default(),
            workers: Vec::new(),
        })
    }

    /// Draws a picture.
    ///
    /// A stroke of radius 0 covers nothing. Light beyond 0..1 is clamped for each sample.
    ///
    /// # Errors
    ///
    /// When the drawing is invalid (see [`DrawError`]); then nothing has been drawn.
    #[inline(never)] // a stage of a frame, which `cargo xtask bench count` finds by its name
    pub fn draw(&mut self, drawing: &Drawing) -> Result<Picture, DrawError> {
        let Self {
            pool,
            samples,
            stacks,
            parts,
            instructions,
            workers,
        } = self;
        let mut draw = || {
            check::check(drawing)?;
            let mut picture = empty_picture(drawing, *samples)?;
            let strokes = segment::strokes_in_order(drawing);
            let tile_height = tile::height(stacks);
            parts.collect(drawing, &strokes, tile_height);
            let frame = Frame {
                drawing,
                strokes: &strokes,
                parts,
                samples: *samples,
                stacks,
            };
            let threads = rayon::current_num_threads();
            workers.resize_with(threads, || Mutex::new(Worker::new()));
            let band_length = drawing.size[0] as usize * tile_height;
            picture
                .pixels
                .par_chunks_mut(band_length)
                .enumerate()
                .for_each(|(band, pixels)| {
                    let thread = rayon::current_thread_index().unwrap_or(0);
                    // Its planes are cleared before use, so a panic elsewhere can't harm them.
                    let mut worker = workers[thread]
                        .lock()
                        .unwrap_or_else(PoisonError::into_inner);
                    instructions.draw_band(&mut worker, &frame, band, pixels);
                });
            Ok(picture)
        };
        match pool {
            Some(pool) => pool.install(draw),
            None => draw(),
        }
    }
}

/// A picture in which nothing has been drawn.
fn empty_picture(drawing: &Drawing, samples: usize) -> Result<Picture, DrawError> {
    let [width, height] = drawing.size;
    let length = width as usize * height as usize;
    let mut pixels = Vec::new();
    pixels
        .try_reserve_exact(length)
        .map_err(|_| DrawError::Memory(width, height))?;
    pixels.resize(length, tile::empty_pixel(drawing.background, samples));
    Ok(Picture {
        width,
        height,
        pixels,
    })
}

impl Parts {
    fn collect(&mut self, drawing: &Drawing, strokes: &[Stroke], tile_height: usize) {
        self.segments.collect(drawing, strokes, tile_height);
        surface::collect(drawing, &mut self.triangles);
        let [width, height] = drawing.size.map(|side| side as usize);
        let (across, bands) = (width.div_ceil(tile::WIDTH), height.div_ceil(tile_height));
        let rows_of_tiles = |(triangle, i): (&Triangle, u32)| {
            let columns = cells(triangle.bounds.x, tile::WIDTH);
            let bands = cells(triangle.bounds.y, tile_height);
            bands.map(move |band| {
                (
                    i,
                    band * across + columns.start..band * across + columns.end,
                )
            })
        };
        let triangles = self.triangles.iter().zip(0..).flat_map(rows_of_tiles);
        self.triangles_of_tiles.fill(across * bands, triangles);
    }
}

/// Everything that is needed to draw a part of a picture.
struct Frame<'a> {
    drawing: &'a Drawing,
    strokes: &'a [Stroke],
    parts: &'a Parts,
    /// In a pixel.
    samples: usize,
    stacks: &'a [Stack],
}

/// A thread's own memory.
struct Worker {
    /// A band's segments and the tiles that each reaches.
    columns: Vec<(u32, Range<usize>)>,
    segments_of_tiles: Bins,
    target: Target,
    parts: Vec<Part>,
    strand: StrandMasks,
    sums: Sums,
}

impl Worker {
    fn new() -> Self {
        Self {
            columns: Vec::new(),
            segments_of_tiles: Bins::default(),
            target: Target::new(),
            parts: Vec::new(),
            strand: StrandMasks::new(),
            sums: Sums::new(),
        }
    }

    /// Draws a row of tiles into its pixels.
    #[inline(always)] // compiled for each set of `Instructions`
    fn draw_band(&mut self, frame: &Frame, band: usize, pixels: &mut [[f32; 4]]) {
        let width = frame.drawing.size[0] as usize;
        let tiles = width.div_ceil(tile::WIDTH);
        let Parts {
            segments,
            triangles_of_tiles,
            ..
        } = frame.parts;
        self.columns.clear();
        self.columns.extend(segments.of_band(band).map(|i| {
            let columns = segments.list()[i as usize].bounds.x;
            (i, cells(columns, tile::WIDTH))
        }));
        self.segments_of_tiles
            .fill(tiles, self.columns.iter().cloned());
        for tile in 0..tiles {
            let x = tile * tile::WIDTH;
            let triangles = triangles_of_tiles.bin(band * tiles + tile);
            if triangles.is_empty() && self.segments_of_tiles.bin(tile).is_empty() {
                continue;
            }
            self.draw_tile(
                frame,
                tile,
                triangles,
                [x, band * tile::height(frame.stacks)],
            );
            let end = (x + tile::WIDTH).min(width);
            for (row, pixels) in pixels.chunks_mut(width).enumerate() {
                self.sums.write(row, frame.samples, &mut pixels[x..end]);
            }
        }
    }

    /// Sums up the samples of the tile at `origin`.
    #[inline(always)]
    fn draw_tile(&mut self, frame: &Frame, tile: usize, triangles: &[u32], origin: [usize; 2]) {
        self.sums.clear(tile::height(frame.stacks));
        let background = frame.drawing.background;
        let segments_of_tile = self.segments_of_tiles.bin(tile);
        let mut scene = TileContext {
            drawing: frame.drawing,
            strokes: frame.strokes,
            segments: frame.parts.segments.list(),
            origin,
            stack: &frame.stacks[0],
        };
        scene.strands(segments_of_tile, &mut self.parts);
        for stack in frame.stacks {
            scene.stack = stack;
            self.target.clear(background);
            if !triangles.is_empty() {
                for &triangle in triangles {
                    let triangle = &frame.parts.triangles[triangle as usize];
                    triangle.draw(frame.drawing, origin, stack, &mut self.target);
                }
                self.target.finish_surfaces();
            }
            for part in &self.parts {
                self.strand
                    .draw(&scene, segments_of_tile, part, &mut self.target);
            }
            self.sums.add(&mut self.target, stack, background.is_some());
        }
    }
}
